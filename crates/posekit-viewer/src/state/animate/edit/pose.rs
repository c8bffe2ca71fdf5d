//! Keys of poses: of some joints, of the whole figure, of what differs from what was there.

use std::sync::Arc;

use posekit::keyframe::edit::{
    KeyPoseConfig, KeyedJoints, SAME_TIME_SECS, breakdown_pose, key_pose,
};
use posekit::keyframe::{Animation, Extrapolation, Interpolation, Keyframe, Track};
use posekit::pose::LocalPose;
use posekit::skeleton::JointId;

use super::super::{Authored, KeyId, Lane, TrackValue};
use super::Edit;

/// Two directions of a quaternion's components this close are the same: what `f32` resolves.
const SAME: f32 = 1e-6;

/// Keys of a pose on some joints at a time: their rotation, and the translation of those that move.
/// `None` when the pose holds a number that is not finite.
#[must_use]
pub fn keys_of_pose(
    authored: &Authored,
    joints: &[JointId],
    pose: &LocalPose,
    time_secs: f64,
    interpolation: Interpolation,
) -> Option<Edit> {
    let lanes: Vec<Lane> = joints
        .iter()
        .flat_map(|&joint| {
            let moves = is_moved(authored, joint, pose);
            let translation = moves.then_some(Lane::Translation(joint));
            [Some(Lane::Rotation(joint)), translation]
        })
        .flatten()
        .collect();
    keys_on_lanes(authored, &lanes, pose, time_secs, interpolation)
}

/// Keys on those joints whose transform in `pose` is another than in `before`, and only of what
/// differs.
#[must_use]
pub fn keys_of_change(
    authored: &Authored,
    (before, pose): (&LocalPose, &LocalPose),
    time_secs: f64,
    interpolation: Interpolation,
) -> Option<Edit> {
    let lanes = changed_lanes(authored, before, pose);
    keys_on_lanes(authored, &lanes, pose, time_secs, interpolation)
}

/// The joints whose transform in `pose` is another than in `before`.
#[must_use]
pub fn changed_joints(authored: &Authored, before: &LocalPose, pose: &LocalPose) -> Vec<JointId> {
    let lanes = changed_lanes(authored, before, pose);
    let mut joints: Vec<JointId> = lanes
        .into_iter()
        .filter_map(|lane| match lane {
            Lane::Rotation(joint) | Lane::Translation(joint) => Some(joint),
            _ => None,
        })
        .collect();
    joints.dedup();
    joints
}

fn changed_lanes(authored: &Authored, before: &LocalPose, pose: &LocalPose) -> Vec<Lane> {
    let mut lanes = Vec::new();
    for joint in authored.skeleton().joints() {
        let j = joint.index();
        let (a, b) = (before.rotations[j], pose.rotations[j]);
        // A quaternion and its opposite are one rotation.
        if (a.dot(b).abs() - 1.0).abs() > SAME {
            lanes.push(Lane::Rotation(joint));
        }
        if before.translations[j] != pose.translations[j] {
            lanes.push(Lane::Translation(joint));
        }
    }
    lanes
}

/// Whether a joint's place is keyed with its rotation: that of a root, where there are keys of it
/// already, and where the pose moves it away from where it would be.
fn is_moved(authored: &Authored, joint: JointId, pose: &LocalPose) -> bool {
    let skeleton = authored.skeleton();
    let is_root = skeleton.parent(joint).is_none();
    let there = pose.translations[joint.index()];
    let away =
        there.distance(skeleton.rest_translation(joint)) > SAME * skeleton.height().max(SAME);
    let layered = !authored.scene().motions.is_empty();
    is_root || authored.animation().translation(joint).is_some() || (away && !layered)
}

fn keys_on_lanes(
    authored: &Authored,
    lanes: &[Lane],
    pose: &LocalPose,
    time_secs: f64,
    interpolation: Interpolation,
) -> Option<Edit> {
    let animation = authored.animation();
    let config = KeyPoseConfig {
        time_secs,
        what: KeyedJoints::RotationAndPlace,
        interpolation,
        beyond: Extrapolation::Hold,
    };
    let mut edit = Edit::default();
    for &lane in lanes {
        // Each lane by itself: what is keyed of a joint may be its place alone.
        let value = match lane {
            Lane::Rotation(joint) => {
                let alone = KeyPoseConfig {
                    what: KeyedJoints::Rotation,
                    ..config
                };
                let keyed = key_pose(animation, [joint], pose, &alone).ok()?;
                keyed.rotation(joint).cloned().map(TrackValue::from)
            }
            Lane::Translation(joint) => {
                // One key makes it a joint that moves; that key is replaced.
                let moving = with_place(animation, joint, pose, &config)?;
                let keyed = key_pose(&moving, [joint], pose, &config).ok()?;
                let track = keyed.translation(joint).map(Arc::clone);
                track.map(|track| TrackValue::Vector(Arc::unwrap_or_clone(track)))
            }
            _ => None,
        };
        let Some(value) = value else { continue };
        let times = value.as_track();
        let at = |time: &f64| (time - time_secs).abs() <= SAME_TIME_SECS;
        if let Some(index) = times.times_secs().iter().position(at) {
            edit.selection.insert(KeyId { lane, index });
        }
        edit.changes.push((lane, Some(value)));
    }
    Some(edit)
}

fn with_place(
    animation: &Animation,
    joint: JointId,
    pose: &LocalPose,
    config: &KeyPoseConfig,
) -> Option<Animation> {
    if animation.translation(joint).is_some() {
        return Some(animation.clone());
    }
    let value = pose.translations[joint.index()].as_dvec3();
    let key = Keyframe::new(config.time_secs, value, config.interpolation);
    let track = Track::new(vec![key], config.beyond).ok()?;
    Some(animation.clone().with_translation(joint, Some(track)))
}

/// Keys at a time, with `joints` a share of the way from their keys before to their keys after: the
/// in-between that an animator slides. Joints without keys are left out.
#[must_use]
pub fn breakdown(
    authored: &Authored,
    joints: &[JointId],
    time_secs: f64,
    share: f64,
    interpolation: Interpolation,
) -> Option<Edit> {
    let animation = authored.animation();
    let pose = breakdown_pose(animation, joints.iter().copied(), time_secs, share);
    let lanes: Vec<Lane> = joints
        .iter()
        .flat_map(|&joint| [Lane::Rotation(joint), Lane::Translation(joint)])
        .filter(|lane| authored.track(*lane).is_some())
        .collect();
    keys_on_lanes(authored, &lanes, &pose, time_secs, interpolation)
}
