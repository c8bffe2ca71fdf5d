//! Bones that change their length, OFFSETs that the motion does not use, and a rest pose that is no
//! pose of the figure.

use glam::Vec3;

use super::figure::sample_frames;
use super::statistics::median;
use super::{CheckConfig, Figure, Finding, FindingCode, FrameRange, Severity, Unit};
use crate::motion::{GlobalMotion, Motion};
use crate::pose::GlobalPose;
use crate::skeleton::JointId;

/// A rest pose is judged when the figure has at least this many free ends: an arm that rests
/// stretched out is no mistake.
const FREE_ENDS_MIN: usize = 3;

/// From this share of all bone length along one axis on, the message says so.
const ONE_AXIS_SHARE: f64 = 0.9;

pub(super) fn check(
    motion: &Motion,
    global: &GlobalMotion,
    figure: &Figure,
    config: &CheckConfig,
    findings: &mut Vec<Finding>,
) {
    if figure.height <= 0.0 {
        return;
    }
    let bones = translated_bones(motion, figure);
    findings.extend(
        bones
            .iter()
            .filter_map(|&joint| changing_bone(motion, figure, joint, config)),
    );
    findings.extend(offsets_unlike_motion(motion, figure, &bones, config));
    findings.extend(root_offset_unlike_motion(motion, figure, config));
    findings.extend(rest_pose_unlike_motion(global, figure, config));
}

/// The joints with position channels that are the end of a bone: those below the joint that carries
/// the figure. That one and the ones above it move freely.
fn translated_bones(motion: &Motion, figure: &Figure) -> Vec<JointId> {
    let skeleton = motion.skeleton();
    let translated = motion.translated_joints().iter().copied();
    translated
        .filter(|&joint| {
            skeleton
                .ancestors(joint)
                .any(|ancestor| ancestor == figure.root)
        })
        .collect()
}

fn changing_bone(
    motion: &Motion,
    figure: &Figure,
    joint: JointId,
    config: &CheckConfig,
) -> Option<Finding> {
    let lengths: Vec<f64> = (0..motion.frame_count())
        .map(|frame| f64::from(motion.translation(frame, joint).length()))
        .collect();
    let usual = median(&mut lengths.clone());
    let tolerance = (config.bone_change * usual).max(config.bone_change_heights * figure.height);
    let differs = |length: &f64| (length - usual).abs() > tolerance;
    let first = lengths.iter().position(differs)?;
    let last = lengths.iter().rposition(differs)?;
    let count = lengths.iter().filter(|length| differs(length)).count();
    let change = lengths
        .iter()
        .map(|length| (length - usual).abs())
        .fold(0.0, f64::max);
    let skeleton = motion.skeleton();
    let parent = skeleton
        .parent(joint)
        .map_or("", |parent| skeleton.unique_name(parent));
    let relative = if usual > 0.0 {
        format!(" ({:.1} per cent)", 100.0 * change / usual)
    } else {
        String::new()
    };
    Some(Finding {
        code: FindingCode::BoneLengthChanges,
        severity: Severity::Warning,
        joints: vec![joint],
        frames: Some(FrameRange { first, last }),
        value: change,
        unit: Unit::FileUnits,
        share_of_height: Some(change / figure.height),
        message: format!(
            "the bone from {parent} to {} is usually {usual:.4} file units long and changes by up to \
             {change:.4}{relative}, in {count} frames",
            skeleton.unique_name(joint)
        ),
    })
}

fn median_translation(motion: &Motion, joint: JointId) -> Vec3 {
    let samples: Vec<Vec3> = sample_frames(motion.frame_count())
        .map(|frame| motion.translation(frame, joint))
        .collect();
    let coordinate = |axis: usize| {
        let mut values: Vec<f32> = samples.iter().map(|sample| sample[axis]).collect();
        let middle = values.len() / 2;
        *values.select_nth_unstable_by(middle, f32::total_cmp).1
    };
    Vec3::new(coordinate(0), coordinate(1), coordinate(2))
}

fn offsets_unlike_motion(
    motion: &Motion,
    figure: &Figure,
    bones: &[JointId],
    config: &CheckConfig,
) -> Option<Finding> {
    let skeleton = motion.skeleton();
    let difference = |joint: JointId| {
        f64::from(median_translation(motion, joint).distance(skeleton.rest_translation(joint)))
    };
    let limit = config.offset_heights * figure.height;
    let unlike: Vec<(JointId, f64)> = bones
        .iter()
        .map(|&joint| (joint, difference(joint)))
        .filter(|(_, difference)| *difference > limit)
        .collect();
    let &(worst, distance) = unlike.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Finding {
        code: FindingCode::OffsetUnlikeMotion,
        severity: Severity::Warning,
        joints: unlike.iter().map(|(joint, _)| *joint).collect(),
        frames: None,
        value: distance,
        unit: Unit::FileUnits,
        share_of_height: Some(distance / figure.height),
        message: format!(
            "{} joints are never where their OFFSET says, {} by {distance:.4} file units: a program that reads only OFFSETs draws another figure",
            unlike.len(),
            skeleton.unique_name(worst)
        ),
    })
}

/// An OFFSET of the joint that carries the figure, or of one above it, far from where that joint ever
/// is. An OFFSET of zero says nothing about a place and is not reported.
fn root_offset_unlike_motion(
    motion: &Motion,
    figure: &Figure,
    config: &CheckConfig,
) -> Option<Finding> {
    let skeleton = motion.skeleton();
    let free = std::iter::once(figure.root).chain(skeleton.ancestors(figure.root));
    let mut distances = free
        .filter(|joint| motion.translated_joints().binary_search(joint).is_ok())
        .filter(|&joint| skeleton.rest_translation(joint) != Vec3::ZERO)
        .map(|joint| (joint, distance_to_way(motion, joint)));
    let (joint, distance) =
        distances.find(|(_, distance)| *distance > config.root_offset_heights * figure.height)?;
    let share = distance / figure.height;
    Some(Finding {
        code: FindingCode::OffsetUnlikeMotion,
        severity: Severity::Info,
        joints: vec![joint],
        frames: None,
        value: distance,
        unit: Unit::FileUnits,
        share_of_height: Some(share),
        message: format!(
            "the OFFSET of {} is {distance:.4} file units ({share:.1} times the height) away from all \
             places where its position channels put it: the rest pose is not where the motion is",
            skeleton.unique_name(joint)
        ),
    })
}

/// How far a joint's OFFSET is from the box around its translations.
fn distance_to_way(motion: &Motion, joint: JointId) -> f64 {
    let mut low = Vec3::INFINITY;
    let mut high = Vec3::NEG_INFINITY;
    for frame in 0..motion.frame_count() {
        let place = motion.translation(frame, joint);
        low = low.min(place);
        high = high.max(place);
    }
    let offset = motion.skeleton().rest_translation(joint);
    f64::from(offset.distance(offset.clamp(low, high)))
}

/// Compares how steep each bone is at rest and, on the mean over some frames, in the motion. Headings
/// do not matter, so a figure that turns around is still itself.
fn rest_pose_unlike_motion(
    global: &GlobalMotion,
    figure: &Figure,
    config: &CheckConfig,
) -> Option<Finding> {
    let skeleton = global.skeleton();
    let subtree = skeleton.subtree(figure.root);
    let bones: Vec<(JointId, JointId)> = subtree
        .filter(|&joint| joint != figure.root)
        .filter_map(|joint| Some((skeleton.parent(joint)?, joint)))
        .collect();
    let free_ends = bones
        .iter()
        .filter(|bone| skeleton.children(bone.1).is_empty())
        .count();
    if free_ends < FREE_ENDS_MIN {
        return None;
    }
    let rest = GlobalPose::rest(skeleton);
    let mut length_sum = 0.0;
    let mut angle_sum = 0.0;
    let mut along = [0.0_f64; 3];
    for &(parent, joint) in &bones {
        let bone = rest.positions[joint.index()] - rest.positions[parent.index()];
        let length = f64::from(bone.length());
        let difference_deg = mean_steepness_deg(global, parent, joint) - steepness_deg(bone);
        length_sum += length;
        angle_sum += length * difference_deg.abs();
        for (sum, part) in along.iter_mut().zip(bone.to_array()) {
            *sum += f64::from(part.abs());
        }
    }
    if length_sum <= 0.0 || angle_sum <= config.rest_pose_deg * length_sum {
        return None;
    }
    let angle_deg = angle_sum / length_sum;
    let axis = (0..3).find(|&axis| along[axis] >= ONE_AXIS_SHARE * length_sum);
    let reason = axis.map_or(String::new(), |axis| {
        let letter = ["X", "Y", "Z"][axis];
        format!(": nearly all OFFSETs run along {letter}, which is a bone convention and no pose")
    });
    Some(Finding {
        code: FindingCode::RestPoseUnlikeMotion,
        severity: Severity::Info,
        joints: Vec::new(),
        frames: None,
        value: angle_deg,
        unit: Unit::Degrees,
        share_of_height: None,
        message: format!(
            "bones stand {angle_deg:.0} degrees steeper or flatter at rest than in the motion, on average{reason}"
        ),
    })
}

fn mean_steepness_deg(global: &GlobalMotion, parent: JointId, joint: JointId) -> f64 {
    let mut sum = 0.0;
    let mut count = 0.0;
    for frame in sample_frames(global.frame_count()) {
        sum += steepness_deg(global.position(frame, joint) - global.position(frame, parent));
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The angle of a bone above the horizontal, in degrees; 0 for one without length.
fn steepness_deg(bone: Vec3) -> f64 {
    let bone = bone.as_dvec3();
    libm::atan2(bone.y, libm::sqrt(bone.x * bone.x + bone.z * bone.z)).to_degrees()
}
