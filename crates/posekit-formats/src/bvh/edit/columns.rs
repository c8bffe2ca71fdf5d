//! Where a joint's channels are in a row, and rows laid out anew.

use posekit::motion::Channel;
use posekit::rotation::{Axis, compose_elementary};

use crate::bvh::Bvh;

/// The columns of a joint's rotation channels, in order.
pub(in crate::bvh) fn rotation_columns(
    channels: &[Channel],
    first_column: usize,
) -> Vec<(usize, Axis)> {
    let columns = channels
        .iter()
        .enumerate()
        .filter_map(|(place, channel)| match channel {
            Channel::Rotation(axis) => Some((first_column + place, *axis)),
            Channel::Position(_) => None,
        });
    columns.collect()
}

/// The rotation that a row's columns make.
pub(in crate::bvh) fn rotation_of(row: &[f64], columns: &[(usize, Axis)]) -> glam::DQuat {
    compose_elementary(
        columns
            .iter()
            .map(|&(column, axis)| (axis, row[column].to_radians())),
    )
}

/// Gives the joints other channels. `fill` makes each new row from the old one; it is called frame
/// after frame.
pub(in crate::bvh) fn lay_out(
    bvh: &mut Bvh,
    channels_of_joint: Vec<Vec<Channel>>,
    mut fill: impl FnMut(&[f64], &mut [f64]),
) {
    let new_width: usize = channels_of_joint.iter().map(Vec::len).sum();
    if bvh.motion.is_some() {
        let mut values = vec![0.0; bvh.frame_count() * new_width];
        if new_width > 0 {
            for (old, new) in bvh.rows().zip(values.chunks_exact_mut(new_width)) {
                fill(old, new);
            }
        }
        if let Some(motion) = &mut bvh.motion {
            motion.values = values;
        }
    }
    for (joint, channels) in bvh.joints.iter_mut().zip(channels_of_joint) {
        joint.channels = channels;
    }
}

/// The first column of every joint for these channels.
pub(super) fn starts(channels_of_joint: &[Vec<Channel>]) -> Vec<usize> {
    let mut next = 0;
    channels_of_joint
        .iter()
        .map(|channels| {
            let start = next;
            next += channels.len();
            start
        })
        .collect()
}
