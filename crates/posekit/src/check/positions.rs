//! Position channels that are not positions: differences from the OFFSET, or nothing at all.
//!
//! Read as places, the first put a figure under the floor or its joints beside their bones, and the second
//! put every joint on its parent. Both make all other checks speak of a figure that nobody recorded, so
//! they are looked for first.

use glam::Vec3;

use super::figure::{Figure, figure, sample_frames};
use super::statistics::median;
use super::{Finding, FindingCode, Severity, Unit};
use crate::motion::{FrameTime, GlobalMotion, Motion, PositionPolicies, PositionPolicy};
use crate::pose::{GlobalPose, forward_kinematics};
use crate::rotation::Axis;
use crate::skeleton::{JointId, Skeleton};

/// Up to this share of its OFFSET a translation is zero: the rounding of files with four digits or more.
const ZERO_SHARE: f64 = 1e-4;

/// Joints whose translations are zero are reported when their OFFSETs make at least this share of all bone
/// length: shorter ones change no figure that anybody sees.
const LEAST_BONE_SHARE: f64 = 0.01;

/// Translations shorter than this share of the OFFSETs, all together, are differences from them: bones
/// that shrink to a third are no squash and stretch.
const DIFFERENCE_SHARE: f64 = 0.3;

/// Above this mean cosine between translations and OFFSETs the two point the same way, so that they are the
/// same bones in two units and no differences.
const SAME_DIRECTION_COS: f64 = 0.9;

/// How far from the floor the lowest joint of a figure may be that stands on it, as a share of its
/// height: a jump's median frame, or a thick sole.
const ON_FLOOR_HEIGHTS: f64 = 0.1;

/// How far under the floor it must be without the OFFSET, as a share of the height. A pelvis at rest is
/// half the height up.
const UNDER_FLOOR_HEIGHTS: f64 = 0.25;

/// How many joints a message names before it counts the rest.
const NAMES_SHOWN: usize = 4;

/// What position channels turn out to mean.
#[derive(Clone, Debug, PartialEq)]
pub struct RelativePositions {
    /// The policies under which the figure is whole and stands.
    pub policies: PositionPolicies,
    /// Whether the root's policy is another one.
    pub concerns_root: bool,
    /// What is wrong with the channels, in a sentence without a capital and a full stop.
    pub what: String,
    /// The policies that differ from those of before, as the command takes them: `root=add,others=ignore`.
    pub option: String,
    /// The same as a finding.
    pub finding: Finding,
}

impl RelativePositions {
    /// What is wrong and what to do, for a command that does not do it by itself.
    pub fn advice(&self) -> String {
        format!(
            "{}; --positions {} reads it correctly",
            self.what, self.option
        )
    }
}

/// Looks whether position channels that were read as places are none.
///
/// `motion` is the motion under `policies`; only joints whose policy is [`PositionPolicy::Replace`] are
/// looked at. `read_again` gives the same motion under other policies; it is asked for at most once.
/// `None` for a motion without frames, and for one whose channels are places.
///
/// Cost: forward kinematics of at most 64 frames, and what `read_again` takes where something is found.
pub fn relative_positions(
    motion: &Motion,
    policies: PositionPolicies,
    read_again: impl FnOnce(PositionPolicies) -> Motion,
) -> Option<RelativePositions> {
    if motion.frame_count() == 0 {
        return None;
    }
    let others = (policies.others == PositionPolicy::Replace)
        .then(|| relative_bones(motion))
        .flatten();
    let with_others = PositionPolicies {
        others: others
            .as_ref()
            .map_or(policies.others, |found| found.policy),
        ..policies
    };
    let again = others.is_some().then(|| read_again(with_others));
    let whole = again.as_ref().unwrap_or(motion);
    let figure = figure(whole, &few_frames(whole));
    let root = (policies.root == PositionPolicy::Replace)
        .then(|| relative_root(whole, &figure))
        .flatten();
    let policies = PositionPolicies {
        root: root.as_ref().map_or(policies.root, |_| PositionPolicy::Add),
        ..with_others
    };
    let found: Vec<&Found> = root.iter().chain(&others).collect();
    let largest = found
        .iter()
        .max_by(|a, b| a.distance.total_cmp(&b.distance))?;
    let mut joints: Vec<JointId> = found.iter().flat_map(|it| it.joints.clone()).collect();
    joints.sort_unstable();
    let option: Vec<String> = root
        .iter()
        .map(|it| format!("root={}", name(it.policy)))
        .chain(
            others
                .iter()
                .map(|it| format!("others={}", name(it.policy))),
        )
        .collect();
    let what: Vec<&str> = found.iter().map(|it| it.what.as_str()).collect();
    let (what, option) = (what.join("; "), option.join(","));
    let height = figure.height;
    Some(RelativePositions {
        policies,
        concerns_root: root.is_some(),
        finding: Finding {
            code: FindingCode::PositionsRelativeToOffset,
            severity: Severity::Warning,
            joints,
            frames: None,
            value: largest.distance,
            unit: Unit::FileUnits,
            share_of_height: (height > 0.0).then(|| largest.distance / height),
            message: format!(
                "{what}; --positions {option} reads it correctly, and all other findings are for that reading"
            ),
        },
        what,
        option,
    })
}

/// A group of joints whose channels are not positions.
struct Found {
    joints: Vec<JointId>,
    /// How they are to be read.
    policy: PositionPolicy,
    /// The farthest that a joint is off, in the file's unit.
    distance: f64,
    what: String,
}

fn name(policy: PositionPolicy) -> &'static str {
    match policy {
        PositionPolicy::Replace => "replace",
        PositionPolicy::Add => "add",
        PositionPolicy::Ignore => "ignore",
    }
}

/// A joint with position channels and an OFFSET, below the one that carries the figure.
struct Bone {
    joint: JointId,
    offset: Vec3,
    /// The median length of its translations.
    length: f64,
    /// The greatest length of its translations.
    longest: f64,
    /// The mean of translations times OFFSET.
    along: f64,
}

/// The joints below the one that carries the figure whose channels are zero, or differences.
fn relative_bones(motion: &Motion) -> Option<Found> {
    let skeleton = motion.skeleton();
    let carrying = super::figure::carrying_joint(skeleton);
    let bones: Vec<Bone> = motion
        .translated_joints()
        .iter()
        .filter(|&&joint| skeleton.ancestors(joint).any(|above| above == carrying))
        .filter(|&&joint| skeleton.bone_length(joint) > 0.0)
        .map(|&joint| bone(motion, joint))
        .collect();
    let offset_length = |bone: &Bone| f64::from(bone.offset.length());
    let all: f64 = skeleton
        .joints()
        .filter(|&joint| skeleton.parent(joint).is_some())
        .map(|joint| f64::from(skeleton.bone_length(joint)))
        .sum();
    let is_zero = |bone: &&Bone| bone.longest <= ZERO_SHARE * offset_length(bone);
    let zero: Vec<&Bone> = bones.iter().filter(is_zero).collect();
    let zero_length: f64 = zero.iter().map(|bone| offset_length(bone)).sum();
    let offsets: f64 = bones.iter().map(offset_length).sum();
    let lengths: f64 = bones.iter().map(|bone| bone.length).sum();
    let along: f64 = bones.iter().map(|bone| bone.along).sum();
    let products: f64 = bones
        .iter()
        .map(|bone| bone.length * offset_length(bone))
        .sum();
    let are_differences = offsets > LEAST_BONE_SHARE * all
        && lengths < DIFFERENCE_SHARE * offsets
        && along < SAME_DIRECTION_COS * products;
    let farthest = |bones: &[&Bone]| {
        bones
            .iter()
            .map(|bone| offset_length(bone))
            .fold(0.0, f64::max)
    };
    if zero.len() < bones.len() && are_differences {
        let bones: Vec<&Bone> = bones.iter().collect();
        let joints: Vec<JointId> = bones.iter().map(|bone| bone.joint).collect();
        return Some(Found {
            policy: PositionPolicy::Add,
            distance: farthest(&bones),
            what: format!(
                "the position channels of {} are differences from the OFFSET, not positions",
                names(skeleton, &joints)
            ),
            joints,
        });
    }
    if zero_length <= LEAST_BONE_SHARE * all {
        return None;
    }
    let joints: Vec<JointId> = zero.iter().map(|bone| bone.joint).collect();
    Some(Found {
        policy: PositionPolicy::Ignore,
        distance: farthest(&zero),
        what: format!(
            "the position channels of {} are zero throughout, which would put each joint at its parent",
            names(skeleton, &joints)
        ),
        joints,
    })
}

fn bone(motion: &Motion, joint: JointId) -> Bone {
    let offset = motion.skeleton().rest_translation(joint);
    let places: Vec<Vec3> = sample_frames(motion.frame_count())
        .map(|frame| motion.translation(frame, joint))
        .collect();
    let mut lengths: Vec<f64> = places.iter().map(|it| f64::from(it.length())).collect();
    let sum: f64 = places.iter().map(|it| f64::from(it.dot(offset))).sum();
    Bone {
        joint,
        offset,
        longest: lengths.iter().copied().fold(0.0, f64::max),
        along: sum / places.len() as f64,
        length: median(&mut lengths),
    }
}

/// A root that stands on the floor if its OFFSET is added, and far below it if not.
fn relative_root(motion: &Motion, figure: &Figure) -> Option<Found> {
    let skeleton = motion.skeleton();
    let root = skeleton
        .ancestors(figure.root)
        .last()
        .unwrap_or(figure.root);
    let offset = skeleton.rest_translation(root);
    if figure.height <= 0.0 || motion.translated_joints().binary_search(&root).is_err() {
        return None;
    }
    // Whichever axis points up: a figure's OFFSET from the floor is mostly along it.
    let axis = Axis::ALL
        .into_iter()
        .max_by(|a, b| offset[a.index()].abs().total_cmp(&offset[b.index()].abs()))?;
    let up = offset[axis.index()].signum();
    let rise = f64::from(offset[axis.index()].abs());
    let below = |pose: &GlobalPose| {
        let heights = skeleton
            .subtree(root)
            .map(|joint| f64::from(up * pose.positions[joint.index()][axis.index()]));
        heights.fold(f64::INFINITY, f64::min)
    };
    let mut local = motion.sample(0.0);
    let mut global = GlobalPose::default();
    let mut lowest: Vec<f64> = sample_frames(motion.frame_count())
        .map(|frame| {
            motion.pose_into(frame, &mut local);
            forward_kinematics(skeleton, &local, &mut global);
            below(&global)
        })
        .collect();
    let lowest = median(&mut lowest);
    let stands = (lowest + rise).abs() <= ON_FLOOR_HEIGHTS * figure.height;
    let sinks = lowest <= -UNDER_FLOOR_HEIGHTS * figure.height;
    (stands && sinks).then(|| Found {
        joints: vec![root],
        policy: PositionPolicy::Add,
        distance: rise,
        what: format!(
            "the position channels of {} are relative to its OFFSET: the figure stands on the floor if they \
             are added to it, and {:.4} file units below if not",
            skeleton.unique_name(root),
            -lowest
        ),
    })
}

/// Forward kinematics of some frames of a motion, spread evenly.
fn few_frames(motion: &Motion) -> GlobalMotion {
    let poses: Vec<_> = sample_frames(motion.frame_count())
        .map(|frame| motion.pose(frame))
        .collect();
    let translated = motion.translated_joints().to_vec();
    let skeleton = std::sync::Arc::clone(motion.skeleton());
    Motion::from_poses(skeleton, FrameTime::NONE, translated, &poses).to_global()
}

/// The first few names, and how many more there are.
fn names(skeleton: &Skeleton, joints: &[JointId]) -> String {
    let shown = joints.iter().take(NAMES_SHOWN);
    let shown: Vec<&str> = shown.map(|&joint| skeleton.unique_name(joint)).collect();
    match joints.len().saturating_sub(NAMES_SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more joints", shown.join(", ")),
    }
}
