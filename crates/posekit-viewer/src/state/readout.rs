//! The inspector's numbers: one joint at one time.

use glam::{DQuat, DVec3, Quat, Vec3};
use posekit::motion::Channel;
use posekit::pose::LocalPose;
use posekit::rotation::{Axis, EulerOrder, log};
use posekit::skeleton::JointId;

use super::clip::{Clip, index_to_f64};

/// The order in which angles are shown where no file says one: the usual one of BVH files.
const DEFAULT_ORDER: [Axis; 3] = [Axis::Z, Axis::X, Axis::Y];

/// A rotation in three ways.
#[derive(Clone, Debug, PartialEq)]
pub struct RotationReadout {
    /// Angles in the order of [`Readout::order`], degrees.
    pub euler_deg: Vec<f64>,
    /// x, y, z, w.
    pub quaternion: [f32; 4],
    /// Axis times angle, degrees.
    pub vector_deg: DVec3,
}

/// What the inspector says of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Readout {
    /// The order of the Euler angles, such as `ZXY`.
    pub order: String,
    /// Against the parent.
    pub local: RotationReadout,
    /// In the world.
    pub global: RotationReadout,
    /// Position in the world.
    pub position: Vec3,
    /// Position in the parent's space.
    pub translation: Vec3,
    /// Speed in the world, the file's length unit a second; `None` where time does not run.
    pub speed: Option<f64>,
    /// How fast the joint turns in the world, degrees a second.
    pub turn_deg_per_sec: Option<f64>,
    /// Height over the floor.
    pub height: f32,
    /// The joint's channels and their values as the file has them at the nearest frame.
    pub channels: Vec<(Channel, f64)>,
}

/// The inspector's numbers of a joint at a time, over a floor at `floor`.
///
/// # Panics
/// If the joint is not one of the clip's.
#[must_use]
pub fn readout(clip: &Clip, joint: JointId, time_secs: f64, floor: f32) -> Readout {
    let pose = clip.local_pose(time_secs);
    readout_of(clip, joint, (time_secs, &pose), floor)
}

/// As [`readout`], of a figure that is held in a pose at that time.
///
/// # Panics
/// If the joint is not one of the clip's, or the pose not one of its skeleton.
#[must_use]
pub fn readout_of(
    clip: &Clip,
    joint: JointId,
    (time_secs, local_pose): (f64, &LocalPose),
    floor: f32,
) -> Readout {
    let numbers = Readout {
        channels: channel_values(clip, joint, time_secs),
        ..readout_of_pose(clip, joint, local_pose, floor)
    };
    let file_angles: Vec<f64> = numbers
        .channels
        .iter()
        .filter(|(channel, _)| matches!(channel, Channel::Rotation(_)))
        .map(|&(_, value)| value)
        .collect();
    let local_rotation = local_pose.rotations[joint.index()];
    Readout {
        local: rotation_readout(local_rotation, &axes_of(clip, joint), &file_angles),
        speed: speed(clip, joint, time_secs),
        turn_deg_per_sec: turn_speed(clip, joint, time_secs),
        ..numbers
    }
}

/// As [`readout`], of a pose that is at no time of the motion, such as the rest pose: nothing moves, and the file has no
/// values for it.
///
/// # Panics
/// If the joint is not one of the clip's, or the pose not one of its skeleton.
#[must_use]
pub fn readout_of_pose(clip: &Clip, joint: JointId, local_pose: &LocalPose, floor: f32) -> Readout {
    let axes = axes_of(clip, joint);
    let global_pose = local_pose.to_global(clip.skeleton());
    let position = global_pose.positions[joint.index()];
    Readout {
        order: axes.iter().map(|axis| axis_letter(*axis)).collect(),
        local: rotation_readout(local_pose.rotations[joint.index()], &axes, &[]),
        global: rotation_readout(global_pose.orientations[joint.index()], &axes, &[]),
        position,
        translation: local_pose.translations[joint.index()],
        speed: None,
        turn_deg_per_sec: None,
        height: position.y - floor,
        channels: Vec::new(),
    }
}

fn axes_of(clip: &Clip, joint: JointId) -> Vec<Axis> {
    clip.rotation_axes(joint)
        .unwrap_or_else(|| DEFAULT_ORDER.to_vec())
}

/// The letter of an axis.
#[must_use]
pub const fn axis_letter(axis: Axis) -> char {
    match axis {
        Axis::X => 'X',
        Axis::Y => 'Y',
        Axis::Z => 'Z',
    }
}

/// `file_angles` are the angles that the file has nearby: of the many that mean the same rotation,
/// those nearest to them are shown.
fn rotation_readout(rotation: Quat, axes: &[Axis], file_angles: &[f64]) -> RotationReadout {
    let rotation = rotation.normalize();
    let quat = DQuat::from_xyzw(
        rotation.x.into(),
        rotation.y.into(),
        rotation.z.into(),
        rotation.w.into(),
    );
    let order = EulerOrder::new(axes)
        .ok()
        .filter(|order| order.is_complete());
    let order = order.or_else(|| EulerOrder::new(&DEFAULT_ORDER).ok());
    let euler_deg = order.map_or_else(Vec::new, |order| {
        let mut near = [0.0; 3];
        for (near, angle) in near.iter_mut().zip(file_angles) {
            *near = angle.to_radians();
        }
        let angles = if file_angles.len() == 3 {
            order.from_quat_near(quat, near)
        } else {
            order.from_quat(quat)
        };
        angles
            .angles_rad
            .iter()
            .map(|angle| angle.to_degrees())
            .collect()
    });
    RotationReadout {
        euler_deg,
        quaternion: rotation.to_array(),
        vector_deg: log(quat) * (180.0 / std::f64::consts::PI),
    }
}

/// A joint's channels with the values of the nearest frame.
#[must_use]
pub fn channel_values(clip: &Clip, joint: JointId, time_secs: f64) -> Vec<(Channel, f64)> {
    let document = &clip.document;
    let frame = clip.frame_at(time_secs);
    if frame >= document.frame_count() {
        return Vec::new();
    }
    let columns = document.joint_columns(joint.index());
    let values = &document.row(frame)[columns];
    document.joints[joint.index()]
        .channels
        .iter()
        .copied()
        .zip(values.iter().copied())
        .collect()
}

/// The frames around a time between which speeds are measured, and the time between them.
fn around(clip: &Clip, time_secs: f64) -> Option<(usize, usize, f64)> {
    let frame = clip.frame_at(time_secs);
    let last = clip.frame_count().checked_sub(1)?;
    let (before, after) = (frame.saturating_sub(1), (frame + 1).min(last));
    let secs = index_to_f64(after - before) * clip.motion.frame_time_secs();
    (secs > 0.0).then_some((before, after, secs))
}

/// A joint's speed in the world at the nearest frame, by central differences.
#[must_use]
pub fn speed(clip: &Clip, joint: JointId, time_secs: f64) -> Option<f64> {
    let (before, after, secs) = around(clip, time_secs)?;
    let way = clip.global.position(after, joint) - clip.global.position(before, joint);
    Some(f64::from(way.length()) / secs)
}

/// How fast a joint turns in the world at the nearest frame, degrees a second.
#[must_use]
pub fn turn_speed(clip: &Clip, joint: JointId, time_secs: f64) -> Option<f64> {
    let (before, after, secs) = around(clip, time_secs)?;
    let from = clip.global.orientation(before, joint);
    let to = clip.global.orientation(after, joint);
    Some(f64::from(from.angle_between(to)).to_degrees() / secs)
}

/// A number with a fixed count of decimals, and never a minus zero.
#[must_use]
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text
        .trim_start_matches('-')
        .chars()
        .all(|c| c == '0' || c == '.')
    {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}
