//! Poses between frames.

use std::sync::Arc;

use glam::{Quat, Vec3};
use posekit::motion::{FrameTime, Motion};
use posekit::pose::LocalPose;
use posekit::skeleton::JointId;
use proptest::prelude::*;

use crate::figures::{angle_rad, any_motion, hand_drawn};

const FRAME_TIME: FrameTime = FrameTime::of_fps(4);

/// Hips turn by a quarter and move by one unit from each of three frames to the next.
fn turning() -> Motion {
    let hips = JointId::new(0);
    let mut motion = Motion::at_rest(Arc::new(hand_drawn()), 3, FRAME_TIME, [hips]);
    for (frame, turns) in [0.0_f32, 1.0, 2.0].into_iter().enumerate() {
        let quarter = std::f32::consts::FRAC_PI_2;
        motion.set_rotation(frame, hips, Quat::from_rotation_y(quarter * turns));
        motion.set_translation(frame, hips, Vec3::X * turns);
    }
    motion
}

#[test]
fn halfway_is_half_the_turn_and_half_the_way() {
    let motion = turning();
    for (time_secs, turns) in [
        (0.125, 0.5_f32),
        (0.25, 1.0),
        (0.3125, 1.25),
        (0.4375, 1.75),
    ] {
        let pose = motion.sample(time_secs);
        let expected = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2 * turns);
        assert!(
            angle_rad(pose.rotations[0], expected) < 1e-6,
            "{time_secs} s"
        );
        assert!(
            pose.translations[0].distance(Vec3::X * turns) < 1e-6,
            "{time_secs} s"
        );
    }
}

#[test]
fn the_ends_hold() {
    let motion = turning();
    let last = 2.0 * FRAME_TIME.secs();
    assert_eq!(motion.duration_secs(), last);
    for time_secs in [-1e300, -1.0, -0.0, 0.0, f64::NEG_INFINITY, f64::NAN] {
        assert_eq!(motion.sample(time_secs), motion.pose(0), "{time_secs} s");
    }
    for time_secs in [last, last + 1e-9, 1e300, f64::INFINITY] {
        assert_eq!(motion.sample(time_secs), motion.pose(2), "{time_secs} s");
    }
}

#[test]
fn without_time_between_frames_the_first_holds() {
    let mut motion = Motion::at_rest(Arc::new(hand_drawn()), 2, FrameTime::NONE, []);
    motion.set_rotation(1, JointId::new(0), Quat::from_rotation_y(1.0));
    assert_eq!(motion.sample(0.0), motion.pose(0));
    assert_eq!(motion.sample(5.0), motion.pose(0));
}

#[test]
fn the_sign_of_a_quaternion_makes_no_difference() {
    let hips = JointId::new(0);
    let mut motion = Motion::at_rest(Arc::new(hand_drawn()), 2, FrameTime::of_fps(1), []);
    motion.set_rotation(0, hips, Quat::from_rotation_y(0.2));
    motion.set_rotation(1, hips, -Quat::from_rotation_y(0.6));
    let halfway = motion.sample(0.5).rotations[0];
    assert!(angle_rad(halfway, Quat::from_rotation_y(0.4)) < 1e-6);
}

proptest! {
    #[test]
    fn at_a_frame_it_is_that_frame(motion in any_motion(), frame: prop::sample::Index) {
        prop_assume!(motion.frame_count() > 0);
        let frame = frame.index(motion.frame_count());
        #[allow(clippy::cast_precision_loss, reason = "a small number")]
        let pose = motion.sample(frame as f64 * motion.frame_time_secs());
        let expected = motion.pose(frame);
        for joint in motion.skeleton().joints() {
            // The quotient of time and frame time may fall a rounding beside the frame.
            let angle = angle_rad(pose.rotations[joint.index()], expected.rotations[joint.index()]);
            prop_assert!(angle < 1e-5, "{} rad", angle);
            let apart = pose.translations[joint.index()].distance(expected.translations[joint.index()]);
            prop_assert!(apart < 1e-5, "{} apart", apart);
        }
    }

    /// Sampling is interpolating the two poses beside; rotations stay of unit length.
    #[test]
    fn between_frames_it_is_their_interpolation(motion in any_motion(), place in 0.0_f64..1.0) {
        prop_assume!(motion.frame_count() > 1);
        #[allow(clippy::cast_precision_loss, reason = "a small number")]
        let place = place * (motion.frame_count() - 1) as f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
        let (frame, t) = (place as usize, place.fract() as f32);
        let mut expected = LocalPose::rest(motion.skeleton());
        expected.set_interpolated(&motion.pose(frame), &motion.pose(frame + 1), t);
        let pose = motion.sample(place * motion.frame_time_secs());
        for joint in motion.skeleton().joints() {
            let (a, b) = (pose.rotations[joint.index()], expected.rotations[joint.index()]);
            prop_assert!((a.length() - 1.0).abs() < 1e-5);
            prop_assert!(angle_rad(a, b) < 1e-4, "{} rad", angle_rad(a, b));
            let (a, b) = (pose.translations[joint.index()], expected.translations[joint.index()]);
            prop_assert!(a.distance(b) < 1e-4);
        }
    }
}
