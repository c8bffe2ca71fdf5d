//! How far a moving figure reaches along each axis, without the joints that only say where it is.

use glam::Vec3;

use crate::motion::Motion;
use crate::pose::{GlobalPose, forward_kinematics};
use crate::skeleton::JointId;

/// How many frames are looked at, spread over the motion.
const FRAMES_LOOKED_AT: usize = 64;

/// How far a root's only child may move from it, as a share of the length of all bones, while the
/// two still belong to one body. Breathing and squashing stay below, walking away does not.
const LEAST_DRIFT: f32 = 0.05;

/// The joints that make the body, in topological order.
///
/// Left out is a reference root: a root whose only child moves away from it, as the `joint_Root` of
/// Bandai-Namco's files and the root-motion joints of game rigs, which stay on the ground or at the
/// origin while the body walks off. A motion without frames has no reference roots.
pub fn body_joints(motion: &Motion) -> Vec<JointId> {
    let skeleton = motion.skeleton();
    let bones: f32 = skeleton
        .joints()
        .map(|joint| skeleton.bone_length(joint))
        .sum();
    let is_reference = |root: JointId| match skeleton.children(root) {
        [child] if motion.translated_joints().contains(child) => {
            drift(motion, *child) > LEAST_DRIFT * bones
        }
        _ => false,
    };
    // A file may have as many roots as joints: each is asked once.
    skeleton
        .joints()
        .filter(|&joint| skeleton.parent(joint).is_some() || !is_reference(joint))
        .collect()
}

/// The box, in world space and the file's unit, that the body's joints fill: its sides along X, Y and
/// Z, each the middle one of the frames. `None` for a motion without frames.
///
/// Cost: forward kinematics of at most 64 frames.
pub fn body_extent(motion: &Motion) -> Option<Vec3> {
    let joints = body_joints(motion);
    let mut local = motion.sample(0.0);
    let mut global = GlobalPose::default();
    let mut extents = Vec::new();
    for frame in frames_looked_at(motion) {
        motion.pose_into(frame, &mut local);
        forward_kinematics(motion.skeleton(), &local, &mut global);
        let places = joints.iter().map(|joint| global.positions[joint.index()]);
        let (low, high) = places.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        extents.push(high - low);
    }
    let middle = |axis: usize| {
        let mut sides: Vec<f32> = extents.iter().map(|extent| extent[axis]).collect();
        sides.sort_by(f32::total_cmp);
        sides[sides.len() / 2]
    };
    (!extents.is_empty()).then(|| Vec3::new(middle(0), middle(1), middle(2)))
}

/// The diagonal of the box that a joint's local translation fills.
fn drift(motion: &Motion, joint: JointId) -> f32 {
    let places = frames_looked_at(motion).map(|frame| motion.translation(frame, joint));
    places
        .fold(None, |bounds, p| {
            let (low, high): (Vec3, Vec3) = bounds.unwrap_or((p, p));
            Some((low.min(p), high.max(p)))
        })
        .map_or(0.0, |(low, high)| low.distance(high))
}

pub(super) fn frames_looked_at(motion: &Motion) -> impl Iterator<Item = usize> + use<> {
    let step = motion.frame_count().div_ceil(FRAMES_LOOKED_AT).max(1);
    (0..motion.frame_count()).step_by(step)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::motion::FrameTime;
    use crate::skeleton::SkeletonBuilder;

    /// A body two high on a root that stays at the origin while the body walks off along Z.
    fn walks_off(steps: f32) -> Motion {
        let mut builder = SkeletonBuilder::new();
        let root = builder.joint("reference", None, Vec3::ZERO);
        let hips = builder.joint("hips", Some(root), Vec3::Y);
        builder.joint("head", Some(hips), Vec3::Y);
        builder.joint("foot", Some(hips), Vec3::NEG_Y);
        let skeleton = Arc::new(builder.build().unwrap());
        let mut motion = Motion::at_rest(skeleton, 10, FrameTime::of_fps(10), [hips]);
        for frame in 0_u8..10 {
            let place = Vec3::new(0.0, 1.0, 5.0 + f32::from(frame) * steps);
            motion.set_translation(frame.into(), hips, place);
        }
        motion
    }

    #[test]
    fn a_root_that_the_body_walks_away_from_is_not_part_of_it() {
        let motion = walks_off(1.0);
        assert_eq!(body_joints(&motion).len(), 3);
        assert_eq!(body_extent(&motion), Some(Vec3::new(0.0, 2.0, 0.0)));
    }

    #[test]
    fn a_root_that_stays_with_the_body_is_part_of_it() {
        assert_eq!(body_joints(&walks_off(0.001)).len(), 4);
    }

    #[test]
    fn without_frames_there_is_no_extent() {
        let skeleton = Arc::clone(walks_off(1.0).skeleton());
        assert_eq!(
            body_extent(&Motion::at_rest(skeleton, 0, FrameTime::of_fps(10), [])),
            None
        );
    }
}
