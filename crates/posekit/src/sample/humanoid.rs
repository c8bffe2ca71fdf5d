//! The figure that walks, runs and waves: 25 joints, 20 that move and 5 End Sites, in metres.
//!
//! Y up, facing +Z, arms stretched sideways at rest (a T-pose) with the palms down. Lengths are
//! those of a person of 1.75 m by the body segment table of Drillis and Contini (1966), as printed
//! in Winter, "Biomechanics and Motor Control of Human Movement" (4th ed. 2009, fig. 4.1). The
//! root's OFFSET is zero, so that readers which add it to the root's position and readers which
//! replace it by the position see the same motion.

use std::sync::Arc;

use glam::{DQuat, DVec3, Vec3};

use super::gait::FRAME_TIME;
use crate::motion::Motion;
use crate::pose::LocalPose;
use crate::skeleton::{JointId, Skeleton, SkeletonBuilder};

/// From the hip joint to the knee.
pub(super) const THIGH: f64 = 0.429;
/// From the knee to the ankle.
pub(super) const SHANK: f64 = 0.431;
/// The ankle above the sole.
pub(super) const ANKLE_HEIGHT: f64 = 0.075;
/// From the ankle forward to the ball of the foot, where the toes bend.
pub(super) const BALL_FORWARD: f64 = 0.135;
/// The joint of the toes above the sole.
pub(super) const BALL_HEIGHT: f64 = 0.02;
/// From the ball to the tip of the toes.
pub(super) const TOE_LENGTH: f64 = 0.065;
/// From the ankle back to the heel.
pub(super) const HEEL_BACK: f64 = 0.055;
/// The tip of the toes above the sole.
pub(super) const TIP_HEIGHT: f64 = 0.008;
/// From the pelvis's joint to a hip joint: sideways and down.
pub(super) const HIP_SIDE: f64 = 0.088;
/// See [`HIP_SIDE`].
pub(super) const HIP_DOWN: f64 = 0.06;

/// Number of joints, End Sites included.
pub(super) const JOINT_COUNT: usize = 25;

/// The joints of a leg or an arm that move, from the trunk outwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limb(pub(super) [usize; 4]);

pub(super) const HIPS: usize = 0;
pub(super) const LEFT_LEG: Limb = Limb([1, 2, 3, 4]);
pub(super) const RIGHT_LEG: Limb = Limb([6, 7, 8, 9]);
pub(super) const SPINE: usize = 11;
pub(super) const CHEST: usize = 12;
pub(super) const LEFT_ARM: Limb = Limb([13, 14, 15, 16]);
pub(super) const RIGHT_ARM: Limb = Limb([18, 19, 20, 21]);
pub(super) const HEAD: usize = 23;

/// Name, parent and rest translation in metres of every joint; a name ending in `End` is an End
/// Site.
fn joints() -> [(&'static str, Option<usize>, [f64; 3]); JOINT_COUNT] {
    let ball = [0.0, BALL_HEIGHT - ANKLE_HEIGHT, BALL_FORWARD];
    let tip = [0.0, TIP_HEIGHT - BALL_HEIGHT, TOE_LENGTH];
    [
        ("Hips", None, [0.0, 0.0, 0.0]),
        ("LeftUpperLeg", Some(0), [HIP_SIDE, -HIP_DOWN, 0.0]),
        ("LeftLowerLeg", Some(1), [0.0, -THIGH, 0.0]),
        ("LeftFoot", Some(2), [0.0, -SHANK, 0.0]),
        ("LeftToes", Some(3), ball),
        ("LeftToes_end", Some(4), tip),
        ("RightUpperLeg", Some(0), [-HIP_SIDE, -HIP_DOWN, 0.0]),
        ("RightLowerLeg", Some(6), [0.0, -THIGH, 0.0]),
        ("RightFoot", Some(7), [0.0, -SHANK, 0.0]),
        ("RightToes", Some(8), ball),
        ("RightToes_end", Some(9), tip),
        ("Spine", Some(0), [0.0, 0.095, -0.012]),
        ("Chest", Some(11), [0.0, 0.155, -0.01]),
        ("LeftShoulder", Some(12), [0.035, 0.215, 0.012]),
        ("LeftUpperArm", Some(13), [0.15, -0.012, -0.012]),
        ("LeftLowerArm", Some(14), [0.29, 0.0, 0.0]),
        ("LeftHand", Some(15), [0.255, 0.0, 0.0]),
        ("LeftHand_end", Some(16), [0.18, 0.0, 0.0]),
        ("RightShoulder", Some(12), [-0.035, 0.215, 0.012]),
        ("RightUpperArm", Some(18), [-0.15, -0.012, -0.012]),
        ("RightLowerArm", Some(19), [-0.29, 0.0, 0.0]),
        ("RightHand", Some(20), [-0.255, 0.0, 0.0]),
        ("RightHand_end", Some(21), [-0.18, 0.0, 0.0]),
        ("Head", Some(12), [0.0, 0.29, 0.012]),
        ("Head_end", Some(23), [0.0, 0.215, 0.015]),
    ]
}

/// The skeleton of [`walk`](super::walk), [`run`](super::run) and [`wave`](super::wave): 25 joints
/// in metres, Y up, facing +Z, a T-pose at rest, standing with its hips at the origin.
#[allow(
    clippy::missing_panics_doc,
    reason = "built from constants; a test builds it"
)]
pub fn humanoid() -> Arc<Skeleton> {
    let mut builder = SkeletonBuilder::new();
    for (name, parent, [x, y, z]) in joints() {
        let at = DVec3::new(x, y, z).as_vec3();
        match parent.map(JointId::new) {
            Some(parent) if name.ends_with("_end") => builder.end_site(name, parent, at),
            parent => builder.joint(name, parent, at),
        };
    }
    Arc::new(builder.build().expect("the table above is a skeleton"))
}

/// One frame of the figure: the pelvis's place in the world, metres, and every joint's local
/// rotation.
#[derive(Clone, Debug)]
pub(super) struct Figure {
    pub(super) hips: DVec3,
    pub(super) rotations: [DQuat; JOINT_COUNT],
}

impl Figure {
    pub(super) fn new(hips: DVec3) -> Self {
        Self {
            hips,
            rotations: [DQuat::IDENTITY; JOINT_COUNT],
        }
    }
}

/// The mirror image of a point across the plane between left and right.
pub(super) fn mirror_point(point: DVec3) -> DVec3 {
    DVec3::new(-point.x, point.y, point.z)
}

/// The mirror image of a rotation across the plane between left and right.
pub(super) fn mirror_rotation(rotation: DQuat) -> DQuat {
    DQuat::from_xyzw(rotation.x, -rotation.y, -rotation.z, rotation.w)
}

/// The motion of figures, one a frame.
pub(super) fn motion_of(figures: &[Figure]) -> Motion {
    let skeleton = humanoid();
    let poses: Vec<LocalPose> = figures
        .iter()
        .map(|figure| {
            let mut pose = LocalPose::rest(&skeleton);
            pose.rotations = figure.rotations.map(|q| q.normalize().as_quat()).to_vec();
            pose.translations[HIPS] = figure.hips.as_vec3();
            pose
        })
        .collect();
    let hips = [JointId::new(HIPS)];
    debug_assert_eq!(skeleton.rest_translation(hips[0]), Vec3::ZERO);
    Motion::from_poses(skeleton, FRAME_TIME, hips, &poses)
}

/// The joint on the other side, or the same one when it belongs to the trunk.
pub(super) fn other_side(joint: usize) -> usize {
    match joint {
        1..=5 | 13..=17 => joint + 5,
        6..=10 | 18..=22 => joint - 5,
        trunk => trunk,
    }
}
