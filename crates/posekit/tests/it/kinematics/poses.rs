//! Forward kinematics of one pose, against the matrix chain in double precision.

use glam::{DMat4, DVec3, Quat, Vec3};
use posekit::pose::{GlobalPose, LocalPose, forward_kinematics};
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};
use proptest::prelude::*;

use crate::figures::{
    ORIENTATION_TOLERANCE_RAD, POSITION_TOLERANCE, angle_rad, any_pose, any_posed_skeleton,
    any_skeleton, any_vector,
};

/// `T = J0 L1 J1 L2 ...`: the translations and rotations from the root to a joint as 4 by 4 matrices
/// in double precision, multiplied from the root on.
fn matrix_chain(skeleton: &Skeleton, pose: &LocalPose, joint: JointId) -> DMat4 {
    let mut path: Vec<JointId> = skeleton.ancestors(joint).collect();
    path.reverse();
    path.push(joint);
    let matrices = path.into_iter().flat_map(|joint| {
        let translation = pose.translations[joint.index()].as_dvec3();
        let rotation = pose.rotations[joint.index()].as_dquat().normalize();
        [
            DMat4::from_translation(translation),
            DMat4::from_quat(rotation),
        ]
    });
    matrices.fold(DMat4::IDENTITY, |product, matrix| product * matrix)
}

fn near(a: Vec3, b: DVec3) -> bool {
    a.as_dvec3().distance(b) < f64::from(POSITION_TOLERANCE)
}

proptest! {
    #[test]
    fn agrees_with_the_matrix_chain((skeleton, pose) in any_posed_skeleton(), point in any_vector()) {
        let global = pose.to_global(&skeleton);
        prop_assert_eq!(global.joint_count(), skeleton.joint_count());
        for joint in skeleton.joints() {
            let matrix = matrix_chain(&skeleton, &pose, joint);
            prop_assert!(near(global.positions[joint.index()], matrix.w_axis.truncate()));
            let (_, orientation, _) = matrix.to_scale_rotation_translation();
            let orientation = orientation.as_quat();
            let angle = angle_rad(global.orientations[joint.index()], orientation);
            prop_assert!(angle < ORIENTATION_TOLERANCE_RAD, "{} rad", angle);
            // Any point that is attached to the link goes with it.
            let in_world = global.transform_point(joint, point);
            prop_assert!(near(in_world, matrix.transform_point3(point.as_dvec3())));
            let back = global.inverse_transform_point(joint, in_world);
            prop_assert!(near(back, point.as_dvec3()));
        }
    }

    #[test]
    fn a_bone_keeps_its_length((skeleton, pose) in any_posed_skeleton()) {
        let global = pose.to_global(&skeleton);
        for joint in skeleton.joints() {
            if let Some(parent) = skeleton.parent(joint) {
                let apart = global.positions[joint.index()].distance(global.positions[parent.index()]);
                let length = pose.translations[joint.index()].length();
                prop_assert!((apart - length).abs() < POSITION_TOLERANCE);
            }
        }
    }

    #[test]
    fn local_and_global_convert_back_and_forth((skeleton, pose) in any_posed_skeleton()) {
        let back = pose.to_global(&skeleton).to_local(&skeleton);
        for joint in skeleton.joints() {
            let index = joint.index();
            prop_assert!(back.translations[index].distance(pose.translations[index]) < POSITION_TOLERANCE);
            let angle = angle_rad(back.rotations[index], pose.rotations[index]);
            prop_assert!(angle < ORIENTATION_TOLERANCE_RAD, "{} rad", angle);
        }
    }

    /// What turns a joint moves its subtree as one rigid piece and nothing else.
    #[test]
    fn turning_a_joint_moves_its_subtree_only(
        (skeleton, pose) in any_posed_skeleton(),
        joint: usize,
        turn in crate::figures::any_rotation(),
    ) {
        let joint = JointId::new(joint % skeleton.joint_count());
        let before = pose.to_global(&skeleton);
        let mut turned = pose;
        turned.rotations[joint.index()] *= turn;
        let after = turned.to_global(&skeleton);
        let subtree: Vec<JointId> = skeleton.subtree(joint).collect();
        for other in skeleton.joints() {
            let index = other.index();
            if subtree.contains(&other) {
                let seen = |global: &GlobalPose| {
                    global.inverse_transform_point(joint, global.positions[index])
                };
                prop_assert!(seen(&before).distance(seen(&after)) < POSITION_TOLERANCE);
            } else {
                prop_assert_eq!(before.positions[index], after.positions[index]);
                prop_assert_eq!(before.orientations[index], after.orientations[index]);
            }
        }
    }

    /// Memory that held another figure's pose gives the same as fresh memory, to the bit.
    #[test]
    fn memory_can_be_used_again(
        (skeleton, pose) in any_posed_skeleton(),
        other in any_skeleton().prop_flat_map(|other| {
            let pose = any_pose(other.joint_count());
            (Just(other), pose)
        }),
    ) {
        let mut used = other.1.to_global(&other.0);
        forward_kinematics(&skeleton, &pose, &mut used);
        prop_assert_eq!(used, pose.to_global(&skeleton));
    }

    #[test]
    fn bounds_hold_every_joint_and_touch_some((skeleton, pose) in any_posed_skeleton()) {
        let global = pose.to_global(&skeleton);
        let (low, high) = global.bounds();
        for axis in 0..3 {
            let coordinates = || global.positions.iter().map(|position| position[axis]);
            prop_assert_eq!(coordinates().fold(f32::INFINITY, f32::min), low[axis]);
            prop_assert_eq!(coordinates().fold(f32::NEG_INFINITY, f32::max), high[axis]);
        }
    }
}

#[test]
fn a_pose_without_joints_has_bounds_at_zero() {
    assert_eq!(GlobalPose::default().bounds(), (Vec3::ZERO, Vec3::ZERO));
}

/// A planar arm as in any textbook: x = l1 cos a + l2 cos(a + b), y likewise with sines.
#[test]
fn a_planar_arm_reaches_where_the_textbook_says() {
    let (upper, lower) = (0.3, 0.25);
    let mut builder = SkeletonBuilder::new();
    let shoulder = builder.joint("Shoulder", None, Vec3::ZERO);
    let elbow = builder.joint("Elbow", Some(shoulder), Vec3::X * upper);
    let hand = builder.end_site("Hand", elbow, Vec3::X * lower);
    let skeleton = builder.build().unwrap();
    for (a, b) in [(0.0_f32, 0.0_f32), (0.4, 1.1), (-2.0, 2.5), (3.0, -0.1)] {
        let mut pose = LocalPose::rest(&skeleton);
        pose.rotations[shoulder.index()] = Quat::from_rotation_z(a);
        pose.rotations[elbow.index()] = Quat::from_rotation_z(b);
        let at = pose.to_global(&skeleton).positions[hand.index()];
        let expected = Vec3::new(
            upper * a.cos() + lower * (a + b).cos(),
            upper * a.sin() + lower * (a + b).sin(),
            0.0,
        );
        assert!(at.distance(expected) < 1e-6, "{at} for {expected}");
    }
}

#[test]
fn the_rest_pose_is_the_sum_of_offsets_where_nothing_is_turned() {
    let skeleton = crate::figures::hand_drawn();
    let rest = GlobalPose::rest(&skeleton);
    for joint in skeleton.joints() {
        let above: Vec3 = skeleton
            .ancestors(joint)
            .map(|j| skeleton.rest_translation(j))
            .sum();
        let expected = above + skeleton.rest_translation(joint);
        assert!(rest.positions[joint.index()].distance(expected) < 1e-6);
        assert_eq!(rest.orientations[joint.index()], Quat::IDENTITY);
    }
}
