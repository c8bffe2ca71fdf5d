//! Which axis points up.

use posekit::motion::{Channel, PositionPolicy};
use posekit::pose::GlobalPose;
use posekit::rotation::Axis;

use super::columns::{lay_out, starts};
use crate::bvh::Bvh;

/// The axis that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UpAxis {
    /// Y, as in Maya, MotionBuilder and most BVH files.
    Y,
    /// Z, as in Blender, 3ds Max and robotics.
    Z,
}

/// How much taller than wide a figure must be for its up axis to be clear.
const CLEARLY_TALLER: f32 = 1.15;

/// The axis along which the figure stands: of Y and Z the one with the clearly larger
/// [extent](posekit::figure::body_extent) (at rest, where there are no frames). `None` when neither
/// is, as for a figure that lies down or an arm of a robot.
pub fn guess_up_axis(bvh: &Bvh) -> Option<UpAxis> {
    let motion = bvh.to_motion(PositionPolicy::Replace).ok()?;
    let extent = posekit::figure::body_extent(&motion).unwrap_or_else(|| {
        let (low, high) = GlobalPose::rest(motion.skeleton()).bounds();
        high - low
    });
    if extent.y > CLEARLY_TALLER * extent.z {
        Some(UpAxis::Y)
    } else if extent.z > CLEARLY_TALLER * extent.y {
        Some(UpAxis::Z)
    } else {
        None
    }
}

/// Turns the world a quarter about X so that the axis `from` becomes the axis `to`: the rest pose and
/// the motion stand along the new axis.
///
/// Nothing is computed. The turn maps axes to axes, so OFFSETs swap coordinates, channels change
/// their axis, and some change their sign; every number keeps its digits. Position channels stay in
/// the order of axes in which the file lists them. The rotation order changes with the axes (ZXY
/// becomes YXZ); [`set_rotation_order`](super::set_rotation_order) brings another one.
pub fn turn_up(bvh: &mut Bvh, from: UpAxis, to: UpAxis) {
    let turn = match (from, to) {
        (UpAxis::Y, UpAxis::Z) => QuarterTurn { negated: Axis::Z },
        (UpAxis::Z, UpAxis::Y) => QuarterTurn { negated: Axis::Y },
        _ => return,
    };
    for joint in &mut bvh.joints {
        let [x, y, z] = joint.offset;
        joint.offset = [x, turn.signed(Axis::Z, z), turn.signed(Axis::Y, y)];
    }
    let old_starts = bvh.column_starts();
    let channels: Vec<Vec<Channel>> = bvh
        .joints
        .iter()
        .map(|joint| turn.channels(&joint.channels))
        .collect();
    let new_starts = starts(&channels);
    // For each new column, the old one it comes from and whether its sign changes.
    let mut sources = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        debug_assert_eq!(
            new_starts[index],
            sources.len(),
            "turning keeps the number of channels"
        );
        let mut is_taken = vec![false; joint.channels.len()];
        for &channel in &channels[index] {
            let place = joint
                .channels
                .iter()
                .enumerate()
                .position(|(place, &old)| !is_taken[place] && turn.channel(old) == channel)
                .unwrap_or_default();
            is_taken[place] = true;
            sources.push((
                old_starts[index] + place,
                turn.negates(joint.channels[place]),
            ));
        }
    }
    lay_out(bvh, channels, |old, new| {
        for (value, &(column, is_negated)) in new.iter_mut().zip(&sources) {
            // 0 - x and not -x: no zero becomes "-0".
            *value = if is_negated {
                0.0 - old[column]
            } else {
                old[column]
            };
        }
    });
}

/// A quarter turn about X, which swaps Y and Z and negates one of them on the way.
#[derive(Clone, Copy)]
struct QuarterTurn {
    negated: Axis,
}

impl QuarterTurn {
    fn axis(self, axis: Axis) -> Axis {
        match axis {
            Axis::X => Axis::X,
            Axis::Y => Axis::Z,
            Axis::Z => Axis::Y,
        }
    }

    fn signed(self, axis: Axis, value: f64) -> f64 {
        if axis == self.negated {
            0.0 - value
        } else {
            value
        }
    }

    fn channel(self, channel: Channel) -> Channel {
        match channel {
            Channel::Position(axis) => Channel::Position(self.axis(axis)),
            Channel::Rotation(axis) => Channel::Rotation(self.axis(axis)),
        }
    }

    fn negates(self, channel: Channel) -> bool {
        let (Channel::Position(axis) | Channel::Rotation(axis)) = channel;
        axis == self.negated
    }

    /// The new channels: rotations in place, positions in the order of axes that the file had.
    fn channels(self, old: &[Channel]) -> Vec<Channel> {
        let turned: Vec<Channel> = old.iter().map(|&channel| self.channel(channel)).collect();
        let positions: Vec<Channel> = old
            .iter()
            .copied()
            .filter(|channel| turned.contains(channel))
            .collect();
        let is_position = |channel: &Channel| matches!(channel, Channel::Position(_));
        let mut in_file_order = positions.into_iter().filter(is_position);
        let same_set = old
            .iter()
            .filter(|c| is_position(c))
            .all(|c| turned.contains(c));
        turned
            .iter()
            .map(|&channel| match channel {
                Channel::Position(_) if same_set => in_file_order.next().unwrap_or(channel),
                _ => channel,
            })
            .collect()
    }
}
