//! The pose that a body is fitted in.

use glam::{Quat, Vec3};

use posekit::body::Anatomy;
use posekit::motion::Motion;
use posekit::pose::{GlobalPose, LocalPose};
use posekit::skeleton::{JointId, Skeleton};

/// How many frames of a motion are looked at.
const SAMPLES: usize = 96;

/// A neutral standing pose of a motion's skeleton, facing +Z as well as is known.
///
/// It is the rest pose where that is a posture, with the bone lengths of the motion where it moves
/// joints. Many files have a rest pose that means nothing (all bones along one axis, no lengths): for
/// those it is the mean orientation of every joint over the motion, each frame turned to face the
/// same way, feet only while they are near the ground.
#[must_use]
pub(super) fn reference_pose(motion: &Motion, anatomy: Option<&Anatomy>) -> GlobalPose {
    let skeleton = motion.skeleton();
    let rest = GlobalPose::rest(skeleton);
    if motion.frame_count() == 0 {
        return rest;
    }
    let is_posture = |pose: &GlobalPose| anatomy.is_some_and(|anatomy| anatomy.stands(pose));
    let first = motion.pose(0);
    if !differs(&first.translations, skeleton.rest_translations()) {
        if anatomy.is_none() || is_posture(&rest) {
            return rest;
        }
    } else {
        let mut local = LocalPose::rest(skeleton);
        local.translations = first.translations;
        let pose = local.to_global(skeleton);
        if is_posture(&pose) {
            return pose;
        }
    }
    mean_pose(motion, anatomy)
}

/// Whether joints under the roots lie elsewhere in a motion than at rest.
fn differs(translations: &[Vec3], rest: &[Vec3]) -> bool {
    let scale = rest.iter().map(|t| t.length()).fold(0.0, f32::max);
    // The first joint is a root, whose place says nothing about the body.
    translations
        .iter()
        .zip(rest)
        .skip(1)
        .any(|(a, b)| a.distance(*b) > 1e-3 * scale)
}

fn mean_pose(motion: &Motion, anatomy: Option<&Anatomy>) -> GlobalPose {
    let skeleton = motion.skeleton();
    let frames = motion.frame_count();
    let count = frames.min(SAMPLES);
    let poses: Vec<GlobalPose> = (0..count)
        .map(|i| motion.pose(i * frames / count).to_global(skeleton))
        .map(|pose| faced(anatomy, pose))
        .collect();
    let mut mean = poses[0].clone();
    for joint in skeleton.joints() {
        let index = joint.index();
        let limit = stance_limit(&poses, joint, skeleton);
        let kept = poses.iter().filter(|pose| pose.positions[index].y <= limit);
        mean.orientations[index] = mean_orientation(kept.map(|pose| pose.orientations[index]));
    }
    let local = motion.pose(0);
    for joint in skeleton.joints() {
        if let Some(parent) = skeleton.parent(joint) {
            let offset = mean.orientations[parent.index()] * local.translations[joint.index()];
            mean.positions[joint.index()] = mean.positions[parent.index()] + offset;
        }
    }
    mean
}

/// The pose turned about the vertical so that the figure faces +Z.
fn faced(anatomy: Option<&Anatomy>, mut pose: GlobalPose) -> GlobalPose {
    let axes = anatomy.and_then(|anatomy| anatomy.axes(&pose));
    let forward = axes.map_or(Vec3::Z, |axes| axes.forward);
    let turn = facing(forward).conjugate();
    for (position, orientation) in pose.positions.iter_mut().zip(&mut pose.orientations) {
        *position = turn * *position;
        *orientation = turn * *orientation;
    }
    pose
}

/// The turn about Y that takes +Z to the horizontal direction nearest to `forward`.
fn facing(forward: Vec3) -> Quat {
    let yaw = libm::atan2f(forward.x, forward.z);
    let (sin, cos) = libm::sincosf(yaw * 0.5);
    Quat::from_xyzw(0.0, sin, 0.0, cos)
}

/// The height up to which a joint's frames count: for what comes near the ground only the lowest
/// third, where a foot stands flat.
fn stance_limit(poses: &[GlobalPose], joint: JointId, skeleton: &Skeleton) -> f32 {
    let index = joint.index();
    let mut heights: Vec<f32> = poses.iter().map(|p| p.positions[index].y).collect();
    heights.sort_by(f32::total_cmp);
    let floor = poses
        .iter()
        .flat_map(|p| p.positions.iter().map(|q| q.y))
        .fold(f32::INFINITY, f32::min);
    let near_ground = heights[0] - floor < 0.08 * skeleton.height();
    if near_ground {
        heights[heights.len() / 3]
    } else {
        f32::INFINITY
    }
}

/// The mean of orientations that are not far from one another (the chordal mean of their
/// quaternions, which does for fitting a body).
fn mean_orientation(orientations: impl Iterator<Item = Quat>) -> Quat {
    let mut sum = glam::Vec4::ZERO;
    for q in orientations {
        let v = glam::Vec4::from(q);
        sum += if sum.dot(v) < 0.0 { -v } else { v };
    }
    let length = sum.length();
    if length > 1e-6 {
        Quat::from_vec4(sum / length)
    } else {
        Quat::IDENTITY
    }
}
