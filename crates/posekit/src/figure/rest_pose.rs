//! What kind of pose a rest pose is.
//!
//! Arms and legs are found without names: of the symmetric pairs of free ends, the legs are the pair
//! whose limbs part closest to the root and the arms the pair whose limbs part farthest from it,
//! limbs shorter than a fifth of the longest (eyes, ears, toes of a paw) left aside. Up is the axis
//! that leads from the feet to where the arms part. A skeleton without two such pairs, such as a
//! robot arm, has no posture to name.

use glam::Vec3;

use crate::pose::GlobalPose;
use crate::rotation::Axis;
use crate::skeleton::{JointId, Skeleton};

/// How far from horizontal arms may point in a T-pose, in degrees of elevation.
const T_POSE_DEG: f32 = 20.0;
/// Arms that point down more steeply than this hang.
const HANGING_DEG: f32 = 65.0;
/// The least cosine between a leg and straight down for a figure that stands on it.
const STANDING_COS: f32 = 0.8;
/// Limbs shorter than this share of the longest are no arms or legs.
const LIMB_SHARE: f32 = 0.2;

/// What a rest pose looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestPose {
    /// Its kind.
    pub kind: RestPoseKind,
    /// The axis that points up and whether it is the axis's positive end, where that can be told.
    pub up: Option<(Axis, bool)>,
    /// The axis that the figure faces and whether it is its positive end, where that can be told.
    pub facing: Option<(Axis, bool)>,
}

/// The kind of a rest pose.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RestPoseKind {
    /// Every joint is in the same place: the file has no OFFSETs that mean something.
    Collapsed,
    /// A figure that stands on straight legs.
    Standing(ArmPosture),
    /// Arms and legs as no one stands: often a skeleton whose OFFSETs lie along the bones, with the
    /// posture in the motion.
    NotStanding,
    /// No pair of arms and pair of legs was found.
    NoLimbPairs,
}

/// How the arms of a standing figure point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ArmPosture {
    /// Sideways: a T-pose.
    Sideways,
    /// Sideways and down: an A-pose.
    SidewaysDown,
    /// Down.
    Hanging,
    /// Up.
    Up,
    /// Forward or backward.
    Forward,
}

/// A pair of limbs: where they part, and the left and the right one from there to their ends.
#[derive(Clone, Copy)]
pub(super) struct LimbPair {
    pub(super) parting_joint: JointId,
    /// The ends of the left and the right limb.
    pub(super) ends: [JointId; 2],
    parting_depth: usize,
    parting: Vec3,
    left: Vec3,
    right: Vec3,
    left_end: Vec3,
    right_end: Vec3,
}

impl RestPose {
    /// Looks at a skeleton's rest pose.
    pub fn of(skeleton: &Skeleton) -> Self {
        let unknown = |kind| Self {
            kind,
            up: None,
            facing: None,
        };
        let rest = GlobalPose::rest(skeleton);
        let (low, high) = rest.bounds();
        let size = (high - low).max_element();
        if size.is_nan() || size <= 0.0 {
            return unknown(RestPoseKind::Collapsed);
        }
        let Some((legs, arms)) = legs_and_arms(skeleton, &rest) else {
            return unknown(RestPoseKind::NoLimbPairs);
        };
        let feet = 0.5 * (legs.left_end + legs.right_end);
        let up_axis = nearest_axis(arms.parting - feet);
        let up = direction(up_axis);
        let left = (arms.left_end - arms.right_end).reject_from(up);
        let facing = nearest_axis(left.cross(up));
        let stands = [legs.left, legs.right]
            .iter()
            .all(|leg| leg.normalize_or_zero().dot(up) <= -STANDING_COS);
        let kind = if stands {
            RestPoseKind::Standing(arm_posture(&arms, up, left))
        } else {
            RestPoseKind::NotStanding
        };
        let facing = (left.length() > LIMB_SHARE * size * 0.5).then_some(facing);
        Self {
            kind,
            up: Some(up_axis),
            facing,
        }
    }
}

fn arm_posture(arms: &LimbPair, up: Vec3, left: Vec3) -> ArmPosture {
    let sideways = left.normalize_or_zero();
    let (left, right) = (
        arms.left.normalize_or_zero(),
        arms.right.normalize_or_zero(),
    );
    let elevation_deg = libm::asinf((0.5 * (left + right)).dot(up).clamp(-1.0, 1.0)).to_degrees();
    let outward = 0.5 * (left.dot(sideways) - right.dot(sideways));
    let forward = (0.5 * (left + right)).reject_from(up).length();
    if elevation_deg <= -HANGING_DEG {
        ArmPosture::Hanging
    } else if elevation_deg >= HANGING_DEG {
        ArmPosture::Up
    } else if forward > outward {
        ArmPosture::Forward
    } else if elevation_deg < -T_POSE_DEG {
        ArmPosture::SidewaysDown
    } else if elevation_deg > T_POSE_DEG {
        ArmPosture::Up
    } else {
        ArmPosture::Sideways
    }
}

pub(super) fn legs_and_arms(
    skeleton: &Skeleton,
    rest: &GlobalPose,
) -> Option<(LimbPair, LimbPair)> {
    let mut depths: Vec<usize> = Vec::with_capacity(skeleton.joint_count());
    for parent in skeleton.parents() {
        depths.push(parent.map_or(0, |parent| depths[parent.index()] + 1));
    }
    let mut limbs: Vec<LimbPair> = skeleton
        .symmetric_pairs()
        .iter()
        .filter(|pair| {
            [pair.left, pair.right]
                .iter()
                .all(|&j| skeleton.children(j).is_empty())
        })
        .filter_map(|pair| limb_pair(skeleton, &depths, rest, [pair.left, pair.right]))
        .collect();
    let longest = limbs
        .iter()
        .map(|limb| limb.left.length())
        .fold(0.0, f32::max);
    limbs.retain(|limb| limb.left.length() > LIMB_SHARE * longest);
    let longest_first = |a: &&LimbPair, b: &&LimbPair| a.left.length().total_cmp(&b.left.length());
    let nearest = limbs.iter().map(|limb| limb.parting_depth).min()?;
    let farthest = limbs.iter().map(|limb| limb.parting_depth).max()?;
    let at = |depth: usize| {
        limbs
            .iter()
            .filter(|limb| limb.parting_depth == depth)
            .max_by(longest_first)
            .copied()
    };
    if nearest == farthest {
        return None;
    }
    at(nearest).zip(at(farthest))
}

fn limb_pair(
    skeleton: &Skeleton,
    depths: &[usize],
    rest: &GlobalPose,
    [left, right]: [JointId; 2],
) -> Option<LimbPair> {
    // The first joints below the parting: from there on the two limbs are apart. Only the limbs are walked,
    // and not the way down to the root.
    let [mut left_start, mut right_start] = [left, right];
    while skeleton.parent(left_start) != skeleton.parent(right_start) {
        let climbing = if depths[left_start.index()] >= depths[right_start.index()] {
            &mut left_start
        } else {
            &mut right_start
        };
        *climbing = skeleton.parent(*climbing)?;
    }
    if left_start == right_start {
        return None;
    }
    let parting = skeleton.parent(left_start)?;
    let place = |joint: JointId| rest.positions[joint.index()];
    Some(LimbPair {
        parting_joint: parting,
        ends: [left, right],
        parting_depth: depths[parting.index()],
        parting: place(parting),
        left: place(left) - place(left_start),
        right: place(right) - place(right_start),
        left_end: place(left),
        right_end: place(right),
    })
}

fn nearest_axis(v: Vec3) -> (Axis, bool) {
    let axis = Axis::ALL
        .into_iter()
        .max_by(|a, b| v[a.index()].abs().total_cmp(&v[b.index()].abs()))
        .unwrap_or(Axis::Y);
    (axis, v[axis.index()] >= 0.0)
}

fn direction((axis, is_positive): (Axis, bool)) -> Vec3 {
    let unit = axis.unit().as_vec3();
    if is_positive { unit } else { -unit }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::SkeletonBuilder;

    /// A figure of sticks, its arms and legs in the given directions (of the left side).
    fn figure(arm: Vec3, leg: Vec3) -> Skeleton {
        let mut builder = SkeletonBuilder::new();
        let hips = builder.joint("Hips", None, Vec3::Y);
        let chest = builder.joint("Chest", Some(hips), Vec3::new(0.0, 0.5, 0.0));
        builder.end_site("Head", chest, Vec3::new(0.0, 0.4, 0.0));
        for (side, mirror) in [("Left", Vec3::ONE), ("Right", Vec3::new(-1.0, 1.0, 1.0))] {
            let joint = |builder: &mut SkeletonBuilder, part: &str, parent, offset: Vec3| {
                builder.joint(format!("{side}{part}"), Some(parent), offset * mirror)
            };
            let shoulder = joint(&mut builder, "Arm", chest, Vec3::new(0.15, 0.0, 0.0));
            joint(&mut builder, "Hand", shoulder, arm * 0.6);
            let hip = joint(&mut builder, "UpLeg", hips, Vec3::new(0.1, 0.0, 0.0));
            joint(&mut builder, "Foot", hip, leg * 0.9);
        }
        builder.build().unwrap()
    }

    #[test]
    fn postures_are_told_apart() {
        let down_and_out = Vec3::new(1.0, -1.0, 0.0).normalize();
        for (arm, posture) in [
            (Vec3::X, ArmPosture::Sideways),
            (down_and_out, ArmPosture::SidewaysDown),
            (Vec3::NEG_Y, ArmPosture::Hanging),
            (Vec3::Y, ArmPosture::Up),
            (Vec3::Z, ArmPosture::Forward),
        ] {
            let rest = RestPose::of(&figure(arm, Vec3::NEG_Y));
            assert_eq!(rest.kind, RestPoseKind::Standing(posture));
            assert_eq!(rest.up, Some((Axis::Y, true)));
            assert_eq!(rest.facing, Some((Axis::Z, true)));
        }
    }

    #[test]
    fn what_does_not_stand_or_has_no_limbs_says_so() {
        assert_eq!(
            RestPose::of(&figure(Vec3::X, Vec3::X)).kind,
            RestPoseKind::NotStanding
        );
        let mut builder = SkeletonBuilder::new();
        let base = builder.joint("base", None, Vec3::ZERO);
        let single = builder.clone().build().unwrap();
        assert_eq!(RestPose::of(&single).kind, RestPoseKind::Collapsed);
        builder.end_site("tip", base, Vec3::Y);
        assert_eq!(
            RestPose::of(&builder.build().unwrap()).kind,
            RestPoseKind::NoLimbPairs
        );
    }
}
