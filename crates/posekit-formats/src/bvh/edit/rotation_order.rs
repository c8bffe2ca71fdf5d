//! The same rotations in another Euler order.

use posekit::motion::Channel;
use posekit::rotation::{Axis, EulerOrder};

use super::EditError;
use super::columns::{lay_out, rotation_columns, rotation_of, starts};
use crate::bvh::{Bvh, BvhJoint};

/// Expresses every joint's rotation in `order`, the order in which its channels are then listed.
///
/// A joint whose rotation channels stand in that order already, or are some of its axes in that
/// order (a knee with one channel, say), stays as it is to the bit. Others get three rotation
/// channels where their first one was. Angles are those closest to the frame before.
///
/// # Errors
/// When the order does not name each axis once.
pub fn set_rotation_order(bvh: &mut Bvh, order: EulerOrder) -> Result<(), EditError> {
    let mut axes: Vec<Axis> = order.axes().to_vec();
    axes.sort();
    if axes != Axis::ALL {
        return Err(EditError::IncompleteOrder);
    }
    set_rotation_order_of(bvh, order, |_| true);
    Ok(())
}

/// As [`set_rotation_order`] with an order that names each axis once, of some joints.
pub(in crate::bvh) fn set_rotation_order_of(
    bvh: &mut Bvh,
    order: EulerOrder,
    is_meant: impl Fn(&BvhJoint) -> bool,
) {
    let old_starts = bvh.column_starts();
    let channels: Vec<Vec<Channel>> = bvh
        .joints
        .iter()
        .map(|joint| {
            if is_meant(joint) {
                reordered(&joint.channels, order)
            } else {
                joint.channels.clone()
            }
        })
        .collect();
    let new_starts = starts(&channels);
    let mut joints = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        let changes = channels[index] != joint.channels;
        joints.push(JointColumns {
            old_start: old_starts[index],
            new_start: new_starts[index],
            plain: plain_columns(&joint.channels, &channels[index], changes),
            old_turns: rotation_columns(&joint.channels, old_starts[index]),
            new_turns: rotation_columns(&channels[index], new_starts[index]),
            changes,
            previous_rad: [0.0; 3],
        });
    }
    lay_out(bvh, channels, |old, new| {
        for joint in &mut joints {
            joint.fill(order, old, new);
        }
    });
}

struct JointColumns {
    old_start: usize,
    new_start: usize,
    /// Places within the joint, old and new, of the channels whose numbers stay.
    plain: Vec<(usize, usize)>,
    old_turns: Vec<(usize, Axis)>,
    new_turns: Vec<(usize, Axis)>,
    changes: bool,
    previous_rad: [f64; 3],
}

impl JointColumns {
    fn fill(&mut self, order: EulerOrder, old: &[f64], new: &mut [f64]) {
        for &(from, to) in &self.plain {
            new[self.new_start + to] = old[self.old_start + from];
        }
        if !self.changes {
            return;
        }
        let rotation = rotation_of(old, &self.old_turns);
        self.previous_rad = order.from_quat_near(rotation, self.previous_rad).angles_rad;
        for (&(column, _), angle) in self.new_turns.iter().zip(self.previous_rad) {
            new[column] = angle.to_degrees();
        }
    }
}

fn reordered(channels: &[Channel], order: EulerOrder) -> Vec<Channel> {
    let axes: Vec<Axis> = rotation_columns(channels, 0)
        .into_iter()
        .map(|(_, axis)| axis)
        .collect();
    if is_subsequence(&axes, order.axes()) {
        return channels.to_vec();
    }
    let mut placed = false;
    let mut result = Vec::with_capacity(channels.len() + 2);
    for channel in channels {
        match channel {
            Channel::Position(_) => result.push(*channel),
            Channel::Rotation(_) if !placed => {
                result.extend(order.axes().iter().map(|&axis| Channel::Rotation(axis)));
                placed = true;
            }
            Channel::Rotation(_) => {}
        }
    }
    result
}

fn is_subsequence(axes: &[Axis], order: &[Axis]) -> bool {
    let mut rest = order.iter();
    axes.iter().all(|axis| rest.any(|other| other == axis))
}

/// The channels whose numbers stay: all of an unchanged joint, the positions of a changed one.
fn plain_columns(old: &[Channel], new: &[Channel], changes: bool) -> Vec<(usize, usize)> {
    if !changes {
        return (0..old.len()).map(|place| (place, place)).collect();
    }
    let positions = |channels: &[Channel]| -> Vec<usize> {
        let places = channels.iter().enumerate();
        places
            .filter(|(_, c)| matches!(c, Channel::Position(_)))
            .map(|(place, _)| place)
            .collect()
    };
    positions(old).into_iter().zip(positions(new)).collect()
}
