//! Keys of many joints at once: keying a pose, and poses between neighbouring keys.

use glam::{DQuat, DVec3};

use super::time::{EditError, SAME_TIME_SECS, insert_key};
use crate::keyframe::animation::Animation;
use crate::keyframe::euler::{RotationTrack, quat_of_deg};
use crate::keyframe::extrapolation::Extrapolation;
use crate::keyframe::key::{Interpolation, Keyframe};
use crate::keyframe::track::Track;
use crate::keyframe::value::KeyValue;
use crate::pose::LocalPose;
use crate::skeleton::JointId;

/// Which tracks of a joint are keyed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum KeyedJoints {
    /// Its rotation alone.
    Rotation,
    /// Its rotation, and its translation where it is a root or has a translation track.
    RotationAndPlace,
}

/// How a pose is keyed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeyPoseConfig {
    /// When, in seconds.
    pub time_secs: f64,
    /// Which tracks get a key.
    pub what: KeyedJoints,
    /// How the new keys go on. A key that replaces one keeps that one's way and tangent kind.
    pub interpolation: Interpolation,
    /// How tracks that this key starts go on beyond their keys.
    pub beyond: Extrapolation,
}

/// The animation with a key of `pose` on each of `joints`. End Sites have no rotation to key.
///
/// # Errors
/// [`EditError::Track`] when the time or the pose holds a number that is not finite.
///
/// # Panics
/// If a joint is out of range or the pose has not as many joints as the skeleton.
pub fn key_pose(
    animation: &Animation,
    joints: impl IntoIterator<Item = JointId>,
    pose: &LocalPose,
    config: &KeyPoseConfig,
) -> Result<Animation, EditError> {
    let skeleton = animation.skeleton();
    assert_eq!(
        pose.joint_count(),
        skeleton.joint_count(),
        "a pose of this skeleton"
    );
    let mut keyed = animation.clone();
    for joint in joints {
        if !skeleton.is_end_site(joint) {
            let value = pose.rotations[joint.index()].as_dquat().normalize();
            let track = with_rotation_key(animation.rotation(joint), value, config)?;
            keyed = keyed.with_rotation(joint, Some(track));
        }
        let moves = skeleton.parent(joint).is_none() || animation.translation(joint).is_some();
        if moves && config.what == KeyedJoints::RotationAndPlace {
            let value = pose.translations[joint.index()].as_dvec3();
            let track = with_key(
                animation.translation(joint).map(AsRef::as_ref),
                value,
                config,
            )?;
            keyed = keyed.with_translation(joint, Some(track));
        }
    }
    Ok(keyed)
}

/// A key of a rotation in the mode of its track; without a track, of quaternions. Euler curves get the angles
/// that lie nearest to what they are at that time.
fn with_rotation_key(
    track: Option<&RotationTrack>,
    value: DQuat,
    config: &KeyPoseConfig,
) -> Result<RotationTrack, EditError> {
    if let Some(RotationTrack::Euler(euler)) = track {
        let angles = euler.angles_near_deg(value, config.time_secs);
        let keyed = with_key(Some(euler.angles_deg()), angles, config)?;
        return Ok(euler.with_angles_deg(keyed).into());
    }
    let quaternions = track.and_then(RotationTrack::as_quaternion);
    Ok(with_key(quaternions.map(AsRef::as_ref), value, config)?.into())
}

fn with_key<V: KeyValue>(
    track: Option<&Track<V>>,
    value: V,
    config: &KeyPoseConfig,
) -> Result<Track<V>, EditError> {
    let mut key = Keyframe::new(config.time_secs, value, config.interpolation);
    let Some(track) = track else {
        return Ok(Track::new(vec![key], config.beyond)?);
    };
    let replaced = track
        .keys()
        .iter()
        .find(|other| (other.time_secs - key.time_secs).abs() <= SAME_TIME_SECS);
    if let Some(replaced) = replaced {
        key.interpolation = replaced.interpolation;
        key.tangents = super::time::carried_tangents(replaced, value);
    }
    insert_key(track, key)
}

/// The value a share of the way from the key before a time to the key after it, whatever the curve
/// does in between: 0 for the one before, 1 for the one after, beyond them for an exaggeration. Keys
/// at the time itself do not count, so that the value can be found again for a key that is there.
///
/// Beyond the first or last key it is that key's value.
pub fn breakdown_value<V: KeyValue>(track: &Track<V>, time_secs: f64, share: f64) -> V {
    let keys = track.keys();
    let before = keys
        .iter()
        .rev()
        .find(|key| key.time_secs < time_secs - SAME_TIME_SECS);
    let after = keys
        .iter()
        .find(|key| key.time_secs > time_secs + SAME_TIME_SECS);
    match (before, after) {
        (Some(before), Some(after)) => {
            V::straight(before.value.normalized(), after.value.normalized(), share)
        }
        (Some(only), None) | (None, Some(only)) => only.value.normalized(),
        (None, None) => track.sample(time_secs),
    }
}

/// The animation's pose at a time, with `joints` a share of the way between their neighbouring keys
/// ([`breakdown_value`]): the in-between that an animator slides, then keys with [`key_pose`].
///
/// # Panics
/// If a joint is out of range.
pub fn breakdown_pose(
    animation: &Animation,
    joints: impl IntoIterator<Item = JointId>,
    time_secs: f64,
    share: f64,
) -> LocalPose {
    let mut pose = animation.sample(time_secs);
    for joint in joints {
        if let Some(track) = animation.rotation(joint) {
            let value = match track {
                RotationTrack::Quaternion(track) => breakdown_value(track, time_secs, share),
                RotationTrack::Euler(euler) => {
                    let angles = breakdown_value(euler.angles_deg(), time_secs, share);
                    quat_of_deg(euler.order(), angles)
                }
            };
            pose.rotations[joint.index()] = value.as_quat();
        }
        if let Some(track) = animation.translation(joint) {
            let value: DVec3 = breakdown_value(track, time_secs, share);
            pose.translations[joint.index()] = value.as_vec3();
        }
    }
    pose
}

/// `base` with `joints` moved a share of the way to `target`: how a pose of a library is applied by
/// percentage. Rotations go the short way at an even pace, translations straight.
///
/// # Panics
/// If the poses differ in their number of joints, or a joint is out of range.
pub fn blend_poses(
    base: &LocalPose,
    target: &LocalPose,
    joints: impl IntoIterator<Item = JointId>,
    share: f64,
) -> LocalPose {
    assert_eq!(
        base.joint_count(),
        target.joint_count(),
        "poses of one skeleton"
    );
    let mut pose = base.clone();
    for index in joints.into_iter().map(JointId::index) {
        let [from, to] = [base, target].map(|pose| pose.rotations[index].as_dquat().normalize());
        pose.rotations[index] = crate::rotation::slerp(from, to, share).as_quat();
        let [from, to] = [base, target].map(|pose| pose.translations[index].as_dvec3());
        pose.translations[index] = from.lerp(to, share).as_vec3();
    }
    pose
}
