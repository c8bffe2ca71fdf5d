//! Symmetric pairs, with the naming styles of the real files in `../shared/data` (typed here as
//! hierarchies: readers live on another floor) and with figures whose names tell nothing.

use glam::Vec3;
use posekit::skeleton::{JointId, PairEvidence, Skeleton, SkeletonBuilder};

/// A skeleton from `(name, parent name, x, y, z)`; a name `End Site` makes one.
fn skeleton(joints: &[(&str, &str, f32, f32, f32)]) -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    let mut ids: Vec<(String, JointId)> = Vec::new();
    for &(name, parent, x, y, z) in joints {
        let parent = ids.iter().rev().find(|(known, _)| known == parent);
        let parent = parent.map(|&(_, id)| id);
        let at = Vec3::new(x, y, z);
        let id = match parent {
            Some(parent) if name == "End Site" => builder.end_site(name, parent, at),
            _ => builder.joint(name, parent, at),
        };
        ids.push((name.to_owned(), id));
    }
    builder.build().expect("a valid skeleton")
}

fn names(skeleton: &Skeleton) -> Vec<(&str, &str, PairEvidence)> {
    let pairs = skeleton.symmetric_pairs().iter();
    pairs
        .map(|pair| {
            (
                skeleton.name(pair.left),
                skeleton.name(pair.right),
                pair.found_by,
            )
        })
        .collect()
}

/// The skeleton of `course/` and `games105/`.
const COURSE: &[(&str, &str, f32, f32, f32)] = &[
    ("RootJoint", "", 0.0, 0.0, 0.0),
    ("lHip", "RootJoint", 0.1, -0.051, 0.0),
    ("lKnee", "lHip", 0.0, -0.41, 0.0),
    ("lAnkle", "lKnee", 0.0, -0.39, 0.0),
    ("lToeJoint", "lAnkle", 0.0, -0.05, 0.13),
    ("End Site", "lToeJoint", 0.01, 0.002, 0.06),
    ("pelvis_lowerback", "RootJoint", 0.0, 0.0936, 0.0),
    ("lowerback_torso", "pelvis_lowerback", 0.0, 0.1, 0.0),
    ("lTorso_Clavicle", "lowerback_torso", 0.001, 0.1575, 0.0),
    ("lShoulder", "lTorso_Clavicle", 0.1176, 0.0, 0.0),
    ("lElbow", "lShoulder", 0.245, 0.0, 0.0),
    ("End Site", "lElbow", 0.24, 0.0, 0.0),
    ("rTorso_Clavicle", "lowerback_torso", -0.001, 0.1575, 0.0),
    ("rShoulder", "rTorso_Clavicle", -0.1176, 0.0, 0.0),
    ("rElbow", "rShoulder", -0.245, 0.0, 0.0),
    ("End Site", "rElbow", -0.24, 0.0, 0.0),
    ("torso_head", "lowerback_torso", 0.0, 0.28, 0.0),
    ("End Site", "torso_head", 0.0, 0.19, 0.0),
    ("rHip", "RootJoint", -0.1, -0.051, 0.0),
    ("rKnee", "rHip", 0.0, -0.41, 0.0),
    ("rAnkle", "rKnee", 0.0, -0.39, 0.0),
    ("rToeJoint", "rAnkle", 0.0, -0.05, 0.13),
    ("End Site", "rToeJoint", -0.01, 0.002, 0.06),
];

#[test]
fn the_course_skeleton_pairs_by_name_geometry_and_below() {
    let skeleton = skeleton(COURSE);
    let pairs = names(&skeleton);
    use PairEvidence::{Name, NameAndGeometry, Topology};
    let expected = [
        ("lHip", "rHip", NameAndGeometry),
        ("lKnee", "rKnee", NameAndGeometry),
        ("lAnkle", "rAnkle", NameAndGeometry),
        ("lToeJoint", "rToeJoint", NameAndGeometry),
        ("End Site", "End Site", Topology),
        // 2 mm apart on a figure of 1.3 m: too near to the middle for the rest pose to tell.
        ("lTorso_Clavicle", "rTorso_Clavicle", Name),
        ("lShoulder", "rShoulder", NameAndGeometry),
        ("lElbow", "rElbow", NameAndGeometry),
        ("End Site", "End Site", Topology),
    ];
    assert_eq!(pairs, expected);
}

#[test]
fn geometry_finds_the_same_pairs_when_names_tell_nothing() {
    let unnamed: Vec<String> = (0..COURSE.len())
        .map(|index| format!("joint{index}"))
        .collect();
    let named = skeleton(COURSE);
    let mut builder = SkeletonBuilder::new();
    for joint in named.joints() {
        let (name, at) = (
            unnamed[joint.index()].as_str(),
            named.rest_translation(joint),
        );
        match named.parent(joint) {
            Some(parent) if named.is_end_site(joint) => builder.end_site(name, parent, at),
            parent => builder.joint(name, parent, at),
        };
    }
    let anonymous = builder.build().expect("valid");
    let sides = |skeleton: &Skeleton| -> Vec<(JointId, JointId)> {
        let pairs = skeleton.symmetric_pairs();
        pairs.iter().map(|pair| (pair.left, pair.right)).collect()
    };
    assert_eq!(sides(&named), sides(&anonymous));
    let by_geometry = anonymous.symmetric_pairs();
    assert!(
        by_geometry
            .iter()
            .all(|pair| pair.found_by == PairEvidence::Geometry)
    );
}

/// Up, landmarks and mirrored poses all ask for the pairs, and of a wide hierarchy the search takes long: it is made
/// once for a skeleton and its clones.
#[test]
fn pairs_are_looked_for_once() {
    let skeleton = skeleton(COURSE);
    let found = skeleton.symmetric_pairs();
    assert!(!found.is_empty());
    assert!(std::ptr::eq(found, skeleton.symmetric_pairs()));
    let clone = skeleton.clone();
    assert!(std::ptr::eq(found, clone.symmetric_pairs()));
    assert_eq!(clone, skeleton);
}

#[test]
fn names_win_where_the_rest_pose_lies_along_the_bones() {
    // The OFFSETs of `bandai/`: every limb points along +X or -X at rest.
    let skeleton = skeleton(&[
        ("joint_Root", "", 0.0, 0.0, 0.0),
        ("Hips", "joint_Root", 0.0, 93.9, -3.0),
        ("Spine", "Hips", 15.7, 0.0, 0.0),
        ("UpperLeg_L", "Hips", -2.2, -6.5, 0.0),
        ("LowerLeg_L", "UpperLeg_L", 39.1, 0.0, 0.0),
        ("Foot_L", "LowerLeg_L", 41.0, 0.0, 0.0),
        ("UpperLeg_R", "Hips", -2.2, 6.5, 0.0),
        ("LowerLeg_R", "UpperLeg_R", -39.1, 0.0, 0.0),
        ("Foot_R", "LowerLeg_R", -41.0, 0.0, 0.0),
    ]);
    let pairs = names(&skeleton);
    let joints: Vec<_> = pairs
        .iter()
        .map(|&(left, right, _)| (left, right))
        .collect();
    let expected = [
        ("UpperLeg_L", "UpperLeg_R"),
        ("LowerLeg_L", "LowerLeg_R"),
        ("Foot_L", "Foot_R"),
    ];
    assert_eq!(joints, expected);
}

#[test]
fn both_ways_of_the_cmu_skeleton_to_write_a_side_are_read() {
    let skeleton = skeleton(&[
        ("Hips", "", 0.0, 0.0, 0.0),
        ("LHipJoint", "Hips", 0.0, 0.0, 0.0),
        ("LeftUpLeg", "LHipJoint", 1.36, -1.79, 0.84),
        ("LeftLeg", "LeftUpLeg", 2.45, -6.73, 0.0),
        ("RHipJoint", "Hips", 0.0, 0.0, 0.0),
        ("RightUpLeg", "RHipJoint", -1.31, -1.79, 0.84),
        ("RightLeg", "RightUpLeg", -2.54, -6.99, 0.0),
        ("LowerBack", "Hips", 0.0, 1.0, 0.0),
        ("LThumb", "LowerBack", 0.585, 0.0, 0.585),
        ("RThumb", "LowerBack", -0.51, 0.0, 0.51),
    ]);
    let joints: Vec<_> = names(&skeleton).iter().map(|&(l, r, _)| (l, r)).collect();
    let expected = [
        ("LHipJoint", "RHipJoint"),
        ("LeftUpLeg", "RightUpLeg"),
        ("LeftLeg", "RightLeg"),
        ("LThumb", "RThumb"),
    ];
    assert_eq!(joints, expected);
}

#[test]
fn every_style_of_rig_pairs_its_arms() {
    let styles = [
        ("upperarm.l", "upperarm.r"),
        ("thumb_04_leaf_l", "thumb_04_leaf_r"),
        ("Front_Leg_Upper_L", "Front_Leg_Upper_R"),
        ("mixamorig:LeftArm", "mixamorig:RightArm"),
        ("Bip01 L UpperArm", "Bip01 R UpperArm"),
        ("L_Shoulder", "R_Shoulder"),
        ("J_Bip_L_UpperArm", "J_Bip_R_UpperArm"),
        ("lhumerus", "rhumerus"),
        ("leftArm", "RightArm"),
        ("arm-left", "arm-right"),
    ];
    for (left, right) in styles {
        let skeleton = skeleton(&[
            ("Root", "", 0.0, 0.0, 0.0),
            (right, "Root", -0.2, 0.5, 0.0),
            ("Lumbar", "Root", 0.0, 0.2, 0.0),
            (left, "Root", 0.2, 0.5, 0.0),
        ]);
        assert_eq!(
            names(&skeleton),
            [(left, right, PairEvidence::NameAndGeometry)]
        );
    }
}

#[test]
fn a_joint_and_its_ancestor_are_no_pair_whatever_they_are_called() {
    let skeleton = skeleton(&[
        ("lump", "", 0.0, 0.0, 0.0),
        ("rump", "lump", 0.0, 1.0, 0.0),
        ("LeftEnd", "rump", 0.0, 1.0, 0.0),
        ("RightEnd", "LeftEnd", 0.0, 1.0, 0.0),
    ]);
    assert!(names(&skeleton).is_empty());
}

#[test]
fn a_skeleton_without_symmetry_has_no_pairs() {
    let arm = skeleton(&[
        ("Base", "", 0.0, 0.0, 0.0),
        ("Shoulder", "Base", 0.0, 0.3, 0.0),
        ("Elbow", "Shoulder", 0.0, 0.5, 0.0),
        ("Wrist", "Elbow", 0.4, 0.0, 0.0),
        ("End Site", "Wrist", 0.1, 0.0, 0.0),
    ]);
    assert!(names(&arm).is_empty());
    let lopsided = skeleton(&[
        ("Base", "", 0.0, 0.0, 0.0),
        ("One", "Base", 0.5, 0.0, 0.0),
        ("Two", "Base", -0.2, 0.4, 0.0),
    ]);
    assert!(names(&lopsided).is_empty());
    let coincident = skeleton(&[
        ("Base", "", 0.0, 0.0, 0.0),
        ("One", "Base", 0.0, 0.0, 0.0),
        ("Two", "Base", 0.0, 0.0, 0.0),
    ]);
    assert!(names(&coincident).is_empty());
}

#[test]
fn a_very_deep_hierarchy_is_walked_without_recursion() {
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("Root", None, Vec3::ZERO);
    for side in [1.0_f32, -1.0] {
        let mut tip = root;
        for _ in 0..50_000 {
            tip = builder.joint("link", Some(tip), Vec3::new(side * 0.01, -0.01, 0.0));
        }
    }
    let skeleton = builder.build().expect("valid");
    assert_eq!(skeleton.symmetric_pairs().len(), 50_000);
}
