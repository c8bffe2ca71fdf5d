//! Key reduction: the stated error is never exceeded, measured here by other means than in the library.

use std::sync::Arc;

use glam::{DVec3, Quat, Vec3};
use posekit::keyframe::{Animation, Interpolation, ReduceConfig, ReduceError, reduce};
use posekit::motion::{FrameTime, Motion};
use posekit::pose::{GlobalPose, LocalPose, forward_kinematics};
use posekit::rotation::{angle_between, exp};
use posekit::sample;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};
use proptest::collection::vec;
use proptest::prelude::*;

/// The largest angle in degrees and distance in heights, pose by pose.
fn errors(motion: &Motion, animation: &Animation) -> (f64, f64) {
    let skeleton = motion.skeleton();
    let height = f64::from(skeleton.height());
    let (mut angle, mut distance) = (0.0_f64, 0.0_f64);
    for frame in 0..motion.frame_count() {
        let truth = motion.pose(frame);
        let keyed = animation.sample(frame as f64 * motion.frame_time_secs());
        for (a, b) in truth.rotations.iter().zip(&keyed.rotations) {
            let [a, b] = [a, b].map(|q| q.as_dquat().normalize());
            angle = angle.max(angle_between(a, b).to_degrees());
        }
        let [a, b] = [truth, keyed].map(|pose: LocalPose| {
            let mut global = GlobalPose::rest(skeleton);
            forward_kinematics(skeleton, &pose, &mut global);
            global.positions
        });
        for (a, b) in a.iter().zip(b) {
            distance = distance.max(f64::from(a.distance(b)) / height);
        }
    }
    (angle, distance)
}

fn snake() -> Arc<Skeleton> {
    let mut builder = SkeletonBuilder::new();
    let mut parent = builder.joint("root", None, Vec3::ZERO);
    for number in 0..5 {
        parent = builder.joint(format!("link{number}"), Some(parent), Vec3::Y);
    }
    builder.end_site("end", parent, Vec3::Y);
    Arc::new(builder.build().unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// Random walks: as unlike real motion as can be, jumps included.
    #[test]
    fn the_error_is_never_exceeded(
        turns in vec(([-1.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0], [-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0]), 1..400),
        roughness in 0.001_f64..1.0,
        angle_deg in 0.002_f64..20.0,
        distance_heights in 0.00002_f64..0.2,
        linear in prop::bool::ANY,
    ) {
        let skeleton = snake();
        let frames = turns.len().div_ceil(6);
        let mut motion = Motion::at_rest(Arc::clone(&skeleton), frames, FrameTime::of_fps(30), [JointId::new(0)]);
        let mut state = [Quat::IDENTITY; 6];
        let mut place = Vec3::ZERO;
        for (index, (turn, step)) in turns.iter().enumerate() {
            let (frame, joint) = (index / 6, index % 6);
            state[joint] *= exp(DVec3::from_array(*turn) * roughness).as_quat();
            place += (Vec3::from_array(*step).as_dvec3() * roughness).as_vec3();
            motion.set_rotation(frame, JointId::new(joint), state[joint].normalize());
            motion.set_translation(frame, JointId::new(0), place);
        }
        let interpolation = if linear { Interpolation::Linear } else { Interpolation::Cubic };
        let config = ReduceConfig { angle_deg, distance_heights, interpolation };
        let reduction = reduce(&motion, &config).unwrap();
        let (angle, distance) = errors(&motion, &reduction.animation);
        prop_assert!(angle <= angle_deg, "{angle} of {angle_deg} degrees");
        prop_assert!(distance <= distance_heights, "{distance} of {distance_heights} heights");
        prop_assert!((reduction.error.angle_deg - angle).abs() < 1e-6);
        prop_assert!((reduction.error.distance_heights - distance).abs() < 1e-6);
        prop_assert!(reduction.animation.key_count() <= frames * 7);
    }
}

#[test]
fn a_walk_needs_few_keys() {
    let walk = sample::by_name("walk").unwrap();
    let dense = walk.frame_count() * (walk.rotated_joints().len() + 1);
    let mut previous = dense;
    for (angle_deg, distance_heights, most_of_dense) in
        [(0.1, 0.001, 0.25), (1.0, 0.01, 0.10), (5.0, 0.03, 0.06)]
    {
        let config = ReduceConfig {
            angle_deg,
            distance_heights,
            ..ReduceConfig::default()
        };
        let reduction = reduce(&walk, &config).unwrap();
        let (angle, distance) = errors(&walk, &reduction.animation);
        assert!(angle <= angle_deg && distance <= distance_heights);
        let keys = reduction.animation.key_count();
        assert!(
            (keys as f64) < most_of_dense * dense as f64,
            "{keys} of {dense} keys"
        );
        assert!(keys < previous);
        previous = keys;
    }
}

#[test]
fn what_does_not_move_needs_one_key_or_none() {
    let skeleton = snake();
    let mut motion = Motion::at_rest(
        Arc::clone(&skeleton),
        50,
        FrameTime::of_fps(10),
        [JointId::new(0)],
    );
    for frame in 0..50 {
        motion.set_rotation(frame, JointId::new(2), Quat::from_rotation_x(0.5));
    }
    let reduction = reduce(&motion, &ReduceConfig::default()).unwrap();
    assert_eq!(reduction.animation.key_count(), 1);
    assert!(reduction.animation.rotation(JointId::new(2)).is_some());
    assert!(reduction.error.angle_deg < 1e-4);
}

#[test]
fn what_cannot_be_reduced_says_why() {
    let walk = sample::by_name("walk").unwrap();
    let with = |change: fn(&mut ReduceConfig)| {
        let mut config = ReduceConfig::default();
        change(&mut config);
        reduce(&walk, &config).unwrap_err()
    };
    assert!(matches!(
        with(|c| c.angle_deg = 0.0),
        ReduceError::AngleTooSmall { .. }
    ));
    assert!(matches!(
        with(|c| c.angle_deg = f64::NAN),
        ReduceError::AngleTooSmall { .. }
    ));
    assert!(matches!(
        with(|c| c.distance_heights = -1.0),
        ReduceError::DistanceTooSmall { .. }
    ));
    assert_eq!(
        with(|c| c.interpolation = Interpolation::Step),
        ReduceError::NoSuchFit
    );
    let none = Motion::at_rest(snake(), 0, FrameTime::of_fps(10), []);
    assert_eq!(
        reduce(&none, &ReduceConfig::default()),
        Err(ReduceError::NoFrames)
    );
    let still = Motion::at_rest(snake(), 3, FrameTime::NONE, []);
    assert_eq!(
        reduce(&still, &ReduceConfig::default()),
        Err(ReduceError::NoFrameTime)
    );
    let mut broken = Motion::at_rest(snake(), 3, FrameTime::of_fps(10), []);
    broken.set_rotation(2, JointId::new(1), Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0));
    assert_eq!(
        reduce(&broken, &ReduceConfig::default()),
        Err(ReduceError::OutOfRange { frame: 2 })
    );
}
