//! Whole motions: the lanes give what single poses give, in every frame of every block.

use std::sync::Arc;

use glam::{Quat, Vec3};
use posekit::motion::{FrameTime, Motion};
use posekit::pose::LocalPose;
use posekit::skeleton::JointId;
use proptest::prelude::*;

use crate::figures::{
    ORIENTATION_TOLERANCE_RAD, POSITION_TOLERANCE, angle_rad, any_motion, any_vector, hand_drawn,
};

proptest! {
    #[test]
    fn the_batch_agrees_with_single_poses(motion in any_motion(), point in any_vector()) {
        let skeleton = motion.skeleton();
        let batch = motion.to_global();
        prop_assert_eq!(batch.frame_count(), motion.frame_count());
        prop_assert_eq!(batch.frame_time_secs(), motion.frame_time_secs());
        for frame in 0..motion.frame_count() {
            let single = motion.pose(frame).to_global(skeleton);
            for joint in skeleton.joints() {
                let apart = single.positions[joint.index()].distance(batch.position(frame, joint));
                prop_assert!(apart < POSITION_TOLERANCE, "{} apart", apart);
                let orientation = batch.orientation(frame, joint);
                let angle = angle_rad(single.orientations[joint.index()], orientation);
                prop_assert!(angle < ORIENTATION_TOLERANCE_RAD, "{} rad", angle);
                let followed = batch.transform_point(frame, joint, point);
                let expected = single.transform_point(joint, point);
                prop_assert!(followed.distance(expected) < POSITION_TOLERANCE);
            }
            let pose = batch.pose(frame);
            let positions: Vec<Vec3> =
                skeleton.joints().map(|joint| batch.position(frame, joint)).collect();
            prop_assert_eq!(pose.positions, positions);
        }
    }

    /// A frame's result does not depend on the frames beside it or on its place in a block.
    #[test]
    fn a_frame_is_the_same_to_the_bit_wherever_it_stands(motion in any_motion(), shift in 1_usize..9) {
        let poses: Vec<LocalPose> = (0..motion.frame_count()).map(|frame| motion.pose(frame)).collect();
        let later: Vec<LocalPose> = std::iter::repeat_n(LocalPose::rest(motion.skeleton()), shift)
            .chain(poses)
            .collect();
        let translated = motion.translated_joints().to_vec();
        let later = Motion::from_poses(Arc::clone(motion.skeleton()), FrameTime::of_fps(20), translated, &later);
        let (here, there) = (motion.to_global(), later.to_global());
        for frame in 0..motion.frame_count() {
            prop_assert_eq!(here.pose(frame), there.pose(frame + shift));
        }
    }

    /// Memory that held another motion gives the same as fresh memory.
    #[test]
    fn a_global_motion_can_be_used_again(first in any_motion(), second in any_motion()) {
        let mut used = first.to_global();
        used.update(&second);
        let fresh = second.to_global();
        prop_assert_eq!(used.frame_count(), fresh.frame_count());
        prop_assert_eq!(used.bounds(), fresh.bounds());
        for frame in 0..fresh.frame_count() {
            prop_assert_eq!(used.pose(frame), fresh.pose(frame));
        }
    }

    /// What is set is read back; joints without a track stay at rest.
    #[test]
    fn poses_are_kept(motion in any_motion()) {
        let skeleton = motion.skeleton();
        for frame in 0..motion.frame_count() {
            let pose = motion.pose(frame);
            for joint in skeleton.joints() {
                prop_assert_eq!(pose.rotations[joint.index()], motion.rotation(frame, joint));
                prop_assert_eq!(pose.translations[joint.index()], motion.translation(frame, joint));
                if skeleton.is_end_site(joint) {
                    prop_assert_eq!(motion.rotation(frame, joint), skeleton.rest_rotation(joint));
                }
                if !motion.translated_joints().contains(&joint) {
                    prop_assert_eq!(motion.translation(frame, joint), skeleton.rest_translation(joint));
                }
            }
        }
    }

    #[test]
    fn bounds_hold_every_frame(motion in any_motion()) {
        let global = motion.to_global();
        let (low, high) = global.bounds();
        let all = (0..motion.frame_count()).flat_map(|frame| global.pose(frame).positions);
        let expected = all.fold(None, |bounds: Option<(Vec3, Vec3)>, p| {
            Some(bounds.map_or((p, p), |(low, high)| (low.min(p), high.max(p))))
        });
        prop_assert_eq!((low, high), expected.unwrap_or_default());
    }
}

#[test]
fn a_motion_without_frames_is_no_trouble() {
    let motion = Motion::at_rest(Arc::new(hand_drawn()), 0, FrameTime::of_fps(25), []);
    let global = motion.to_global();
    assert_eq!((motion.frame_count(), motion.duration_secs()), (0, 0.0));
    assert_eq!(
        (global.frame_count(), global.bounds()),
        (0, (Vec3::ZERO, Vec3::ZERO))
    );
    assert_eq!(motion.sample(3.0), LocalPose::rest(motion.skeleton()));
}

#[test]
#[should_panic(expected = "frame 3 of 3")]
fn a_frame_in_the_unused_part_of_a_block_is_out_of_range() {
    let motion = Motion::at_rest(Arc::new(hand_drawn()), 3, FrameTime::of_fps(25), []);
    motion.to_global().position(3, JointId::new(0));
}

#[test]
fn setting_one_joint_of_one_frame_leaves_the_rest() {
    let (hips, leg) = (JointId::new(0), JointId::new(4));
    let mut motion = Motion::at_rest(Arc::new(hand_drawn()), 11, FrameTime::of_fps(25), [hips]);
    let turn = Quat::from_rotation_x(0.5);
    motion.set_rotation(9, leg, turn);
    motion.set_translation(9, hips, Vec3::ONE);
    let rest = LocalPose::rest(motion.skeleton());
    for frame in (0..11).filter(|&frame| frame != 9) {
        assert_eq!(motion.pose(frame), rest, "frame {frame}");
    }
    let mut expected = rest;
    expected.rotations[4] = turn;
    expected.translations[0] = Vec3::ONE;
    assert_eq!(motion.pose(9), expected);
}
