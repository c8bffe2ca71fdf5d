//! Bodies of figures that are no humanoids, and the skin of one that is.

use std::sync::Arc;

use glam::Vec3;

use posekit::body::{Anatomy, NoAnatomy};
use posekit::motion::{FrameTime, Motion};
use posekit::pose::GlobalPose;
use posekit::sample::{ArmConfig, arm};
use posekit::skeleton::{Skeleton, SkeletonBuilder};
use posekit_render::character::{Proportions, body_mesh};

use crate::figures::{person, waving};

/// The axes that the sample's documentation states.
#[test]
fn a_robot_arm_has_the_axes_it_was_built_with() {
    let motion = arm(&ArmConfig::default()).unwrap();
    let skeleton = motion.skeleton();
    let hinges = Proportions::of(&motion).hinges;
    let expected = [
        ("Base", None),
        ("Waist", Some(Vec3::Y)),
        ("Shoulder", Some(Vec3::X)),
        ("Elbow", Some(Vec3::X)),
        ("ForearmRoll", Some(Vec3::Y)),
        ("Wrist", Some(Vec3::X)),
        ("ToolRoll", Some(Vec3::Y)),
    ];
    for (name, axis) in expected {
        let found = hinges[skeleton.find(name).unwrap().index()];
        match (found, axis) {
            (None, None) => {}
            (Some(found), Some(axis)) => assert!(found.dot(axis).abs() > 0.999, "{name} {found}"),
            // The arm happens to need no forearm roll to reach its places.
            (None, Some(_)) if name == "ForearmRoll" => {}
            (found, _) => panic!("{name}: {found:?}"),
        }
    }
}

#[test]
fn a_robot_arm_stays_above_its_floor() {
    let motion = arm(&ArmConfig::default()).unwrap();
    let proportions = Proportions::of(&motion);
    let mesh = body_mesh(motion.skeleton(), &proportions);
    let rest = GlobalPose::rest(motion.skeleton());
    let base = mesh.vertices.iter().filter(|v| v.joint == 0);
    let lowest = base
        .map(|v| {
            rest.transform_point(motion.skeleton().find("Base").unwrap(), v.position)
                .y
        })
        .fold(f32::INFINITY, f32::min);
    assert!(lowest.abs() < 1e-4, "{lowest}");
}

/// Four legs under a level spine, moved by a root on the floor, with the names that `limb` gives.
fn four_legged(limb: impl Fn(&str, &str) -> [String; 3]) -> Skeleton {
    let mut b = SkeletonBuilder::new();
    let root = b.joint("Mover", None, Vec3::ZERO);
    let hips = b.joint("Hips", Some(root), Vec3::new(0.0, 0.6, -0.4));
    let spine = b.joint("Spine", Some(hips), Vec3::new(0.0, 0.0, 0.4));
    let chest = b.joint("Chest", Some(spine), Vec3::new(0.0, 0.0, 0.4));
    let head = b.joint("Head", Some(chest), Vec3::new(0.0, 0.2, 0.25));
    b.end_site("HeadEnd", head, Vec3::new(0.0, 0.0, 0.2));
    for (end, at) in [("Front", chest), ("Back", hips)] {
        for (side, x) in [("Left", 0.12), ("Right", -0.12)] {
            let [upper, lower, foot] = limb(end, side);
            let upper = b.joint(upper, Some(at), Vec3::new(x, 0.0, 0.0));
            let lower = b.joint(lower, Some(upper), Vec3::new(0.0, -0.3, 0.02));
            let foot = b.joint(foot, Some(lower), Vec3::new(0.0, -0.28, -0.02));
            b.end_site(format!("{end}{side}End"), foot, Vec3::new(0.0, -0.02, 0.06));
        }
    }
    b.build().unwrap()
}

#[test]
fn four_legs_make_no_humanoid_whatever_they_are_called() {
    let legs = four_legged(|end, side| {
        ["UpperLeg", "LowerLeg", "Foot"].map(|part| format!("{side}{end}{part}"))
    });
    // As motion capture of dogs is often named: by a human's template.
    let arms = four_legged(|end, side| {
        let parts = match end {
            "Front" => ["Arm", "ForeArm", "Hand"],
            _ => ["UpLeg", "Leg", "Foot"],
        };
        parts.map(|part| format!("{side}{part}"))
    });
    for (skeleton, why) in [(legs, NoAnatomy::ManyLimbs), (arms, NoAnatomy::FourLegs)] {
        let rest = GlobalPose::rest(&skeleton);
        assert_eq!(Anatomy::find(&skeleton, &rest), Err(why));
        let mesh = body_mesh(&skeleton, &Proportions::at_rest(&skeleton));
        for joint in skeleton.joints() {
            let carries = mesh
                .vertices
                .iter()
                .any(|v| v.joint as usize == joint.index());
            // The root only moves the figure: nothing hangs between it and the hips.
            let is_bone = skeleton.parent(joint).is_some() && !skeleton.is_end_site(joint);
            assert_eq!(carries, is_bone, "{}", skeleton.name(joint));
        }
    }
}

#[test]
fn a_person_is_found_in_any_pose() {
    let motion = waving(1.0);
    let skeleton = motion.skeleton();
    for frame in 0..motion.frame_count() {
        let pose = motion.pose(frame).to_global(skeleton);
        assert!(Anatomy::find(skeleton, &pose).is_ok(), "{frame}");
    }
}

/// The trunk is one skin: its triangles join the rings of the hips to those of the chest.
#[test]
fn the_trunk_has_no_seam() {
    let skeleton = Arc::new(person(1.0));
    let motion = Motion::at_rest(Arc::clone(&skeleton), 1, FrameTime::of_fps(1), []);
    let mesh = body_mesh(&skeleton, &Proportions::of(&motion));
    let (hips, chest) = (
        skeleton.find("hips").unwrap().index(),
        skeleton.find("chest").unwrap().index(),
    );
    let joints = |t: &[u32; 3]| t.map(|i| mesh.vertices[i as usize].joint as usize);
    let joining = mesh
        .triangles
        .iter()
        .map(joints)
        .filter(|j| j.contains(&hips) && j.contains(&chest))
        .count();
    // A band of two triangles for every slice.
    assert_eq!(joining, 2 * 26);
}

/// A figure for games: a large trunk on short legs, whose thighs are a third of it.
#[test]
fn the_trunk_of_a_short_legged_figure_ends_above_the_middle_of_its_thighs() {
    let mut b = SkeletonBuilder::new();
    let hips = b.joint("Hips", None, Vec3::new(0.0, 0.45, 0.0));
    for (side, x) in [("Left", 0.12), ("Right", -0.12)] {
        let thigh = b.joint(format!("{side}UpLeg"), Some(hips), Vec3::new(x, 0.0, 0.0));
        let knee = b.joint(
            format!("{side}Leg"),
            Some(thigh),
            Vec3::new(0.0, -0.2, 0.01),
        );
        let foot = b.joint(
            format!("{side}Foot"),
            Some(knee),
            Vec3::new(0.0, -0.2, -0.01),
        );
        b.end_site(format!("{side}Toe"), foot, Vec3::new(0.0, -0.04, 0.1));
    }
    let spine = b.joint("Spine", Some(hips), Vec3::new(0.0, 0.25, 0.0));
    let chest = b.joint("Chest", Some(spine), Vec3::new(0.0, 0.25, 0.0));
    for (side, x) in [("Left", 1.0), ("Right", -1.0)] {
        let arm = b.joint(
            format!("{side}Arm"),
            Some(chest),
            Vec3::new(0.2 * x, 0.1, 0.0),
        );
        let elbow = b.joint(
            format!("{side}ForeArm"),
            Some(arm),
            Vec3::new(0.2 * x, 0.0, 0.0),
        );
        let hand = b.joint(
            format!("{side}Hand"),
            Some(elbow),
            Vec3::new(0.2 * x, 0.0, 0.0),
        );
        b.end_site(
            format!("{side}HandEnd"),
            hand,
            Vec3::new(0.08 * x, 0.0, 0.0),
        );
    }
    let head = b.joint("Head", Some(chest), Vec3::new(0.0, 0.2, 0.0));
    b.end_site("HeadEnd", head, Vec3::new(0.0, 0.2, 0.0));
    let skeleton = b.build().unwrap();
    let mesh = body_mesh(&skeleton, &Proportions::at_rest(&skeleton));
    let rest = GlobalPose::rest(&skeleton);
    let of_hips = mesh.vertices.iter().filter(|v| v.joint == 0);
    let lowest = of_hips
        .map(|v| rest.transform_point(hips, v.position).y)
        .fold(f32::INFINITY, f32::min);
    assert!(lowest > 0.35 && lowest < 0.45, "{lowest}");
}
