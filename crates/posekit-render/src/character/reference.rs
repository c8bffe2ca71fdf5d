//! The pose that a body is fitted in.

use glam::{Quat, Vec3};

use posekit::motion::Motion;
use posekit::pose::{GlobalPose, LocalPose};
use posekit::skeleton::{JointId, Skeleton};

use super::anatomy::{Anatomy, facing};

/// How many frames of a motion are looked at.
const SAMPLES: usize = 96;

/// A neutral standing pose of a motion's skeleton, facing +Z as well as is known.
///
/// It is the rest pose where that stands upright. Many files have a rest pose that means nothing
/// (all bones along one axis, no lengths): for those it is the mean orientation of every joint over
/// the motion, each frame turned to face the same way, feet only while they are near the ground.
/// Bone lengths are the motion's where it moves joints, the skeleton's elsewhere.
#[must_use]
pub(super) fn reference_pose(motion: &Motion) -> GlobalPose {
    let skeleton = motion.skeleton();
    let rest = GlobalPose::rest(skeleton);
    if motion.frame_count() == 0 {
        return rest;
    }
    let first = motion.pose(0);
    let moved = differs(&first.translations, skeleton.rest_translations());
    if !moved && Anatomy::find(skeleton, &rest).is_none_or(|a| a.stands(&rest)) {
        return rest;
    }
    if let Some(standing) = standing_rest(motion, skeleton) {
        return standing;
    }
    mean_pose(motion, skeleton)
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

/// The rest rotations with the motion's bone lengths, if that stands.
fn standing_rest(motion: &Motion, skeleton: &Skeleton) -> Option<GlobalPose> {
    let mut local = LocalPose::rest(skeleton);
    local
        .translations
        .copy_from_slice(&motion.pose(0).translations);
    let pose = local.to_global(skeleton);
    Anatomy::find(skeleton, &pose)
        .filter(|a| a.stands(&pose))
        .map(|_| pose)
}

fn mean_pose(motion: &Motion, skeleton: &Skeleton) -> GlobalPose {
    let frames = motion.frame_count();
    let count = frames.min(SAMPLES);
    let poses: Vec<GlobalPose> = (0..count)
        .map(|i| motion.pose(i * frames / count).to_global(skeleton))
        .map(|pose| faced(skeleton, pose))
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
fn faced(skeleton: &Skeleton, mut pose: GlobalPose) -> GlobalPose {
    let forward = Anatomy::find(skeleton, &pose).map_or(Vec3::Z, |a| a.forward);
    let turn = facing(forward).conjugate();
    for (position, orientation) in pose.positions.iter_mut().zip(&mut pose.orientations) {
        *position = turn * *position;
        *orientation = turn * *orientation;
    }
    pose
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
