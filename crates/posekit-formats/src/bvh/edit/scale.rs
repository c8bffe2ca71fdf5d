//! Another length unit.

use posekit::motion::Channel;

use super::EditError;
use crate::bvh::Bvh;

/// Multiplies every length, the OFFSETs and the position channels, by `factor`. Angles stay.
///
/// A factor that is one over a whole number divides by that number instead: `0.01` makes `0.939241`
/// of `93.9241` and not `0.9392410000000001`.
///
/// # Errors
/// When the factor is not a number above zero, or a length would not be finite.
pub fn scale(bvh: &mut Bvh, factor: f64) -> Result<(), EditError> {
    if !(factor.is_finite() && factor > 0.0) {
        return Err(EditError::BadScale { factor });
    }
    let divisor = (1.0 / factor).round();
    let divides = divisor >= 2.0 && ((1.0 / divisor) - factor).abs() <= f64::EPSILON * factor;
    let scaled = |length: f64| {
        if divides {
            length / divisor
        } else {
            length * factor
        }
    };
    let is_length: Vec<bool> = bvh
        .joints
        .iter()
        .flat_map(|joint| &joint.channels)
        .map(|channel| matches!(channel, Channel::Position(_)))
        .collect();
    let offsets = bvh.joints.iter().flat_map(|joint| joint.offset);
    let positions = bvh.rows().flat_map(|row| {
        let values = row.iter().zip(&is_length);
        values.filter(|(_, is)| **is).map(|(value, _)| *value)
    });
    let beyond = |length: &f64| !scaled(*length).is_finite();
    if let Some(length) = offsets.chain(positions).find(beyond) {
        return Err(EditError::TooLarge { factor, length });
    }
    for joint in &mut bvh.joints {
        joint.offset = joint.offset.map(scaled);
    }
    if let Some(motion) = bvh.motion.as_mut().filter(|_| !is_length.is_empty()) {
        for row in motion.values.chunks_exact_mut(is_length.len()) {
            for (value, _) in row.iter_mut().zip(&is_length).filter(|(_, is)| **is) {
                *value = scaled(*value);
            }
        }
    }
    Ok(())
}
