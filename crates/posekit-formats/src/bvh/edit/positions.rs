//! Position channels that every program reads alike.

use posekit::motion::{Channel, PositionPolicies, PositionPolicy};

use crate::bvh::Bvh;

/// Decimals that sums are rounded to: a file's own digits come out of them without the noise of binary
/// fractions, and no length is told to a billionth.
const DECIMALS_KEPT: f64 = 1e9;

/// Writes into the position channels the places that they mean under `policies`, so that read as
/// places, as most programs read them, they make the same motion: channels that are added get the
/// OFFSET added, those that are ignored hold it. OFFSETs stay, and so does what is replaced anyway.
pub fn settle_positions(bvh: &mut Bvh, policies: impl Into<PositionPolicies>) {
    let policies = policies.into();
    let mut changes: Vec<(usize, PositionPolicy, f64)> = Vec::new();
    let mut column = 0;
    for joint in &bvh.joints {
        let policy = policies.of_joint_below(joint.parent);
        for &channel in &joint.channels {
            if let Channel::Position(axis) = channel
                && policy != PositionPolicy::Replace
            {
                changes.push((column, policy, joint.offset[axis.index()]));
            }
            column += 1;
        }
    }
    let Some(motion) = bvh.motion.as_mut().filter(|_| !changes.is_empty()) else {
        return;
    };
    for row in motion.values.chunks_exact_mut(column) {
        for &(column, policy, offset) in &changes {
            row[column] = match policy {
                PositionPolicy::Replace => row[column],
                PositionPolicy::Add => sum(row[column], offset),
                PositionPolicy::Ignore => offset,
            };
        }
    }
}

/// The sum, without the digits that only binary fractions have; never `-0`.
fn sum(value: f64, offset: f64) -> f64 {
    let sum = value + offset;
    let scaled = sum * DECIMALS_KEPT;
    if value == 0.0 || offset == 0.0 || scaled.abs() >= (1_u64 << 53) as f64 {
        return sum + 0.0;
    }
    scaled.round() / DECIMALS_KEPT + 0.0
}
