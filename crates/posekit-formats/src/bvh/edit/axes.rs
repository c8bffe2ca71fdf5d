//! Which axis points up.

use posekit::figure::{UpAxis, UpGuess};
use posekit::motion::{Channel, PositionPolicies};
use posekit::rotation::Axis;

use super::columns::{lay_out, starts};
use crate::bvh::Bvh;

/// The axis along which the figure stands, and what says so: see [`posekit::figure::guess_up`]. `None`
/// where nothing tells, as for a figure that lies down or an arm of a robot.
pub fn guess_up_axis(bvh: &Bvh) -> Option<UpGuess> {
    let motion = bvh.to_motion(PositionPolicies::default()).ok()?;
    posekit::figure::guess_up(&motion)
}

/// Turns the world so that the axis `from` becomes the axis `to`: the rest pose and the motion stand along
/// the new axis. It is a quarter turn about the axis that is neither, or a half turn where the two are ends
/// of one axis.
///
/// Nothing is computed. The turn maps axes to axes, so OFFSETs swap coordinates, channels change
/// their axis, and some change their sign; every number keeps its digits. Position channels stay in
/// the order of axes in which the file lists them. The rotation order changes with the axes (ZXY
/// becomes YXZ); [`set_rotation_order`](super::set_rotation_order) brings another one.
pub fn turn_up(bvh: &mut Bvh, from: UpAxis, to: UpAxis) {
    if from == to {
        return;
    }
    let turn = AxisTurn::new(from, to);
    for joint in &mut bvh.joints {
        let old = joint.offset;
        for axis in Axis::ALL {
            joint.offset[turn.axis(axis).index()] = turn.signed(axis, old[axis.index()]);
        }
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

/// A turn that maps axes to axes.
#[derive(Clone, Copy)]
struct AxisTurn {
    /// What becomes of each axis, and whether its coordinate changes its sign.
    images: [(Axis, bool); 3],
}

impl AxisTurn {
    fn new(from: UpAxis, to: UpAxis) -> Self {
        let mut images = Axis::ALL.map(|axis| (axis, false));
        let (old, new) = (from.axis(), to.axis());
        let flips = from.is_positive() != to.is_positive();
        if old == new {
            // A half turn negates another axis too.
            let other = if old == Axis::Y { Axis::Z } else { Axis::Y };
            images[old.index()].1 = true;
            images[other.index()].1 = true;
        } else {
            images[old.index()] = (new, flips);
            images[new.index()] = (old, !flips);
        }
        Self { images }
    }

    fn axis(self, axis: Axis) -> Axis {
        self.images[axis.index()].0
    }

    /// A coordinate along an axis, as it is along the axis that it becomes.
    fn signed(self, axis: Axis, value: f64) -> f64 {
        if self.images[axis.index()].1 {
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
        self.images[axis.index()].1
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
