//! What a builder takes and refuses, names, lengths and the height.

use glam::{Quat, Vec3};
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder, SkeletonError};

use crate::figures::hand_drawn;

fn ids(indices: &[usize]) -> Vec<JointId> {
    indices.iter().copied().map(JointId::new).collect()
}

#[test]
fn a_skeleton_has_a_joint() {
    assert_eq!(SkeletonBuilder::new().build(), Err(SkeletonError::Empty));
}

#[test]
fn a_parent_comes_before_its_children() {
    for parent in [0, 1, 7] {
        let mut builder = SkeletonBuilder::new();
        builder.joint("a", Some(JointId::new(parent)), Vec3::ZERO);
        builder.joint("b", None, Vec3::ZERO);
        let expected = SkeletonError::ParentNotBefore {
            joint: 0,
            name: "a".into(),
            parent,
        };
        assert_eq!(builder.build(), Err(expected));
    }
}

#[test]
fn an_end_site_ends_its_limb() {
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("root", None, Vec3::ZERO);
    let end = builder.end_site("end", root, Vec3::Y);
    builder.joint("beyond", Some(end), Vec3::Y);
    let expected = SkeletonError::EndSiteWithChild {
        joint: 1,
        name: "end".into(),
        child: 2,
    };
    assert_eq!(builder.build(), Err(expected));
}

#[test]
fn rest_transforms_are_finite_rotations() {
    let refusal = |translation, rotation| {
        let mut builder = SkeletonBuilder::new();
        builder.oriented_joint("a", None, translation, rotation);
        builder.build().unwrap_err()
    };
    let not_finite = SkeletonError::NotFinite {
        joint: 0,
        name: "a".into(),
    };
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(
            refusal(Vec3::new(0.0, bad, 0.0), Quat::IDENTITY),
            not_finite
        );
        assert_eq!(
            refusal(Vec3::ZERO, Quat::from_xyzw(0.0, 0.0, bad, 1.0)),
            not_finite
        );
    }
    for length in [0.0, 0.99, 1.01, 2.0] {
        let error = refusal(Vec3::ZERO, Quat::from_xyzw(0.0, 0.0, 0.0, length));
        assert_eq!(
            error,
            SkeletonError::NotUnit {
                joint: 0,
                name: "a".into(),
                length
            }
        );
    }
    // Six digits in a file leave a rotation this far from unit length.
    let mut builder = SkeletonBuilder::new();
    let rounded = Quat::from_xyzw(0.270_598, 0.270_598, 0.653_281, 0.653_281);
    builder.oriented_joint("a", None, Vec3::ZERO, rounded);
    assert_eq!(
        builder.build().unwrap().rest_rotation(JointId::new(0)),
        rounded
    );
}

fn named(names: &[&str]) -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    for name in names {
        builder.joint(*name, None, Vec3::ZERO);
    }
    builder.build().unwrap()
}

#[test]
fn shared_names_are_told_apart_and_kept() {
    // The file has a joint called `Spine.001` of its own: the second `Spine` must not take its name.
    let names = ["Spine", "Spine", "Spine.001", "Spine", "", ""];
    let skeleton = named(&names);
    let unique: Vec<&str> = skeleton
        .joints()
        .map(|joint| skeleton.unique_name(joint))
        .collect();
    assert_eq!(
        unique,
        ["Spine", "Spine.002", "Spine.001", "Spine.003", "", ".001"]
    );
    for (joint, name) in skeleton.joints().zip(names) {
        assert_eq!(skeleton.name(joint), name);
        assert_eq!(skeleton.find(skeleton.unique_name(joint)), Some(joint));
    }
    assert_eq!(skeleton.find("spine"), None);
}

#[test]
fn ten_thousand_joints_of_one_name_are_told_apart_in_no_time() {
    let skeleton = named(&vec!["Finger"; 10_000]);
    assert_eq!(skeleton.unique_name(JointId::new(9_999)), "Finger.9999");
}

#[test]
fn the_hand_drawn_figure_is_what_its_drawing_says() {
    let skeleton = hand_drawn();
    assert_eq!(skeleton.joint_count(), 10);
    assert_eq!(skeleton.roots().collect::<Vec<_>>(), ids(&[0, 8]));
    assert_eq!(skeleton.children(JointId::new(0)), ids(&[1, 4, 6]));
    assert!(skeleton.children(JointId::new(3)).is_empty());
    let end_sites = skeleton
        .joints()
        .filter(|&joint| skeleton.is_end_site(joint));
    assert_eq!(end_sites.collect::<Vec<_>>(), ids(&[3]));
    assert_eq!(skeleton.parent(JointId::new(7)), Some(JointId::new(6)));
    assert_eq!(skeleton.parent(JointId::new(8)), None);
}

#[test]
fn bones_are_as_long_as_their_offsets() {
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("root", None, Vec3::new(5.0, 5.0, 5.0));
    let joint = builder.joint("joint", Some(root), Vec3::new(3.0, 0.0, 4.0));
    let end = builder.end_site("end", joint, Vec3::ZERO);
    let skeleton = builder.build().unwrap();
    assert_eq!(
        [root, joint, end].map(|joint| skeleton.bone_length(joint)),
        [0.0, 5.0, 0.0]
    );
}

/// A skeleton of one root at the origin with its ends there.
fn with_ends(ends: &[Vec3]) -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("root", None, Vec3::ZERO);
    for (index, &end) in ends.iter().enumerate() {
        builder.end_site(format!("end {index}"), root, end);
    }
    builder.build().unwrap()
}

#[test]
fn height_is_along_y_where_the_figure_stands() {
    // From foot to crown, not from the origin.
    let standing = with_ends(&[Vec3::new(0.3, -0.9, 0.0), Vec3::new(0.0, 0.8, 0.0)]);
    assert_eq!(standing.height(), 1.7);
    // Arms a little wider than the figure is tall.
    let t_pose = with_ends(&[
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(-1.0, 0.0, 0.0),
        Vec3::Y * 1.5,
    ]);
    assert_eq!(t_pose.height(), 1.5);
    // All bones along X, as files have them whose joints' axes lie along the bones.
    let lying = with_ends(&[Vec3::new(90.0, 1.0, 0.0), Vec3::new(-80.0, 0.0, 2.0)]);
    assert_eq!(lying.height(), 170.0);
    assert_eq!(with_ends(&[]).height(), 0.0);
}

#[test]
fn height_uses_rest_rotations() {
    let mut builder = SkeletonBuilder::new();
    let quarter = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let root = builder.oriented_joint("root", None, Vec3::ZERO, quarter);
    builder.end_site("end", root, Vec3::X * 2.0);
    let skeleton = builder.build().unwrap();
    assert!((skeleton.height() - 2.0).abs() < 1e-6);
}
