//! Keyed skeletons: keying poses, breakdowns, mirroring, baking.

use std::sync::Arc;

use glam::{DQuat, DVec3, Quat, Vec3};
use posekit::keyframe::edit::{
    KeyPoseConfig, KeyedJoints, blend_poses, breakdown_pose, key_pose, mirror_animation,
    mirror_axis, mirror_pose,
};
use posekit::keyframe::{Animation, BakeConfig, Extrapolation, Interpolation, Track};
use posekit::motion::FrameTime;
use posekit::pose::{GlobalPose, LocalPose};
use posekit::rotation::Axis;
use posekit::sample;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};

use super::track;

fn at(time_secs: f64) -> KeyPoseConfig {
    KeyPoseConfig {
        time_secs,
        what: KeyedJoints::RotationAndPlace,
        interpolation: Interpolation::Linear,
        beyond: Extrapolation::Hold,
    }
}

/// The walk's poses at frames 0 and 20 as keys at 0 s and 1 s.
fn two_poses() -> (Animation, [LocalPose; 2]) {
    let walk = sample::by_name("walk").unwrap();
    let poses = [0, 20].map(|frame| walk.pose(frame));
    let mut animation = Animation::new(Arc::clone(walk.skeleton()));
    for (time, pose) in [0.0, 1.0].into_iter().zip(&poses) {
        animation = key_pose(&animation, walk.skeleton().joints(), pose, &at(time)).unwrap();
    }
    (animation, poses)
}

fn assert_same(a: &LocalPose, b: &LocalPose, tolerance: f32) {
    for index in 0..a.joint_count() {
        let turned = a.rotations[index].dot(b.rotations[index]).abs();
        assert!(turned > 1.0 - tolerance, "joint {index}: {turned}");
        let apart = (a.translations[index] - b.translations[index]).length();
        assert!(apart < tolerance, "joint {index}: {apart}");
    }
}

#[test]
fn keyed_poses_come_back_and_blend_between() {
    let (animation, poses) = two_poses();
    let skeleton = Arc::clone(animation.skeleton());
    let turning = skeleton
        .joints()
        .filter(|&joint| !skeleton.is_end_site(joint))
        .count();
    assert_eq!(animation.key_count(), 2 * (turning + 1));
    assert_eq!(animation.range_secs(), Some([0.0, 1.0]));
    assert_eq!(animation.key_times_secs(skeleton.joints()), [0.0, 1.0]);
    assert_same(&animation.sample(-1.0), &poses[0], 1e-6);
    assert_same(&animation.sample(1.0), &poses[1], 1e-6);
    let half = blend_poses(&poses[0], &poses[1], skeleton.joints(), 0.5);
    assert_same(&animation.sample(0.5), &half, 1e-6);
    let shifted = breakdown_pose(&animation, skeleton.joints(), 0.5, 0.2);
    assert_same(
        &shifted,
        &blend_poses(&poses[0], &poses[1], skeleton.joints(), 0.2),
        1e-6,
    );
    let keyed = key_pose(&animation, skeleton.joints(), &shifted, &at(0.5)).unwrap();
    // The key that is there now does not count as its own neighbour.
    let again = breakdown_pose(&keyed, skeleton.joints(), 0.5, 0.2);
    assert_same(&again, &shifted, 1e-6);
}

#[test]
fn a_bake_has_the_frames_of_its_range_and_rate() {
    let (animation, _) = two_poses();
    let config = BakeConfig::of_range([0.0, 1.0], FrameTime::of_fps(30));
    assert_eq!(config.frame_count, 31);
    let motion = animation.bake(&config);
    assert_eq!(motion.frame_count(), 31);
    for frame in [0, 7, 30] {
        let time = config.start_secs + frame as f64 / 30.0;
        assert_same(&motion.pose(frame), &animation.sample(time), 1e-6);
    }
    assert_eq!(
        BakeConfig::of_range([0.0, 0.99], FrameTime::of_fps(30)).frame_count,
        30
    );
    assert_eq!(
        BakeConfig::of_range([1.0, 0.0], FrameTime::of_fps(30)).frame_count,
        0
    );
    assert_eq!(
        BakeConfig::of_range([0.0, f64::NAN], FrameTime::of_fps(30)).frame_count,
        0
    );
    assert_eq!(
        BakeConfig::of_range([0.0, 1.0], FrameTime::NONE).frame_count,
        1
    );
}

#[test]
fn a_mirrored_pose_has_its_left_joints_where_the_right_ones_were() {
    let walk = sample::by_name("walk").unwrap();
    let skeleton = walk.skeleton();
    assert_eq!(mirror_axis(skeleton), Axis::X);
    let early = walk.pose(4);
    let image = mirror_pose(skeleton, Axis::X, &early);
    let twice = mirror_pose(skeleton, Axis::X, &image);
    assert_same(&twice, &early, 1e-6);
    let [early, image] = [&early, &image].map(|pose| {
        let mut global = GlobalPose::rest(skeleton);
        posekit::pose::forward_kinematics(skeleton, pose, &mut global);
        global
    });
    for pair in skeleton.symmetric_pairs() {
        let [left, right] = [pair.left.index(), pair.right.index()];
        let expected = early.positions[left] * Vec3::new(-1.0, 1.0, 1.0);
        assert!((image.positions[right] - expected).length() < 1e-5);
    }
}

/// Two arms whose bones' axes lie differently: turned rest rotations on one side alone.
fn crooked() -> Arc<Skeleton> {
    let mut builder = SkeletonBuilder::new();
    let hips = builder.joint("Hips", None, Vec3::Y);
    let turn = Quat::from_rotation_z(0.9) * Quat::from_rotation_x(0.4);
    let left = builder.oriented_joint("LeftArm", Some(hips), Vec3::X, turn);
    builder.end_site("LeftHand", left, turn.inverse() * Vec3::X);
    let right = builder.joint("RightArm", Some(hips), Vec3::NEG_X);
    builder.end_site("RightHand", right, Vec3::NEG_X);
    Arc::new(builder.build().unwrap())
}

#[test]
fn mirroring_does_not_mind_how_the_bones_axes_lie() {
    let skeleton = crooked();
    let [left, right] = ["LeftArm", "RightArm"].map(|name| skeleton.find(name).unwrap());
    let rest = skeleton.rest_rotation(left).as_dquat();
    let swing = [DQuat::from_rotation_y(0.5), DQuat::from_rotation_z(-0.8)];
    let values = swing.map(|turn| turn * rest);
    let animation = Animation::new(Arc::clone(&skeleton))
        .with_rotation(
            left,
            Some(track(&[0.0, 1.0], &values, Interpolation::Cubic)),
        )
        .with_translation(
            JointId::new(0),
            Some(Track::constant(DVec3::new(0.3, 1.0, 0.2)).unwrap()),
        );
    let image = mirror_animation(&animation, mirror_axis(&skeleton), 2.0).unwrap();
    assert!(image.rotation(left).is_none());
    assert_eq!(image.rotation(right).unwrap().times_secs(), [2.0, 3.0]);
    for time in [0.0, 0.3, 1.0] {
        let [a, b] = [animation.sample(time), image.sample(time + 2.0)].map(|pose| {
            let mut global = GlobalPose::rest(&skeleton);
            posekit::pose::forward_kinematics(&skeleton, &pose, &mut global);
            global
        });
        let hand = |name: &str| skeleton.find(name).unwrap().index();
        let expected = a.positions[hand("LeftHand")] * Vec3::new(-1.0, 1.0, 1.0);
        assert!((b.positions[hand("RightHand")] - expected).length() < 1e-5);
    }
}
