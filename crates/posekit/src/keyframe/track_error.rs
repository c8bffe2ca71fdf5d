//! Which keys make a track, and why others do not.

use super::key::{Keyframe, Tangents};
use super::value::{KeyValue, ValueFault};
use crate::range::{LONGEST_LENGTH, LONGEST_SECS, SHORTEST_SECS};

/// The steepest slope: from one end of the lengths to the other in the shortest time, and as much again, since slopes
/// at keys may be steeper than those between them.
const STEEPEST: f64 = 4.0 * LONGEST_LENGTH / SHORTEST_SECS;

/// The least time between two keys. Times are rounded: keys that are the shortest time apart may miss it.
const LEAST_GAP_SECS: f64 = 0.5 * SHORTEST_SECS;

/// Why keys do not make a track. Indices count the keys from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrackError {
    /// There is no key.
    #[error("a track needs at least one key")]
    Empty,
    /// A time is farther from 0 than [`LONGEST_SECS`], or not a number.
    #[error("the time of key {index} is not within {LONGEST_SECS:e} s of 0")]
    TimeOutOfRange {
        /// Index of the key.
        index: usize,
    },
    /// A key does not come after the one before it, or as good as at the same time (within half of [`SHORTEST_SECS`]).
    #[error(
        "keys must come in the order of their times, {LEAST_GAP_SECS:e} s or more apart: key {index} is at {time_secs:?} s, the one before it at {previous_secs:?} s"
    )]
    NotAscending {
        /// Index of the key.
        index: usize,
        /// Its time in seconds.
        time_secs: f64,
        /// The time of the key before it, in seconds.
        previous_secs: f64,
    },
    /// A value has a component that is larger than [`LONGEST_LENGTH`], or not a number.
    #[error("the value of key {index} is not within {LONGEST_LENGTH:e}")]
    ValueOutOfRange {
        /// Index of the key.
        index: usize,
    },
    /// The quaternion of an orientation is not of unit length, to within 0.001.
    #[error("the quaternion of key {index} is not of unit length ({length})")]
    NotUnit {
        /// Index of the key.
        index: usize,
        /// The quaternion's length.
        length: f64,
    },
    /// A slope is steeper than the longest length in the shortest time, a handle longer than the longest of either, or
    /// one of them not a number.
    #[error(
        "a tangent of key {index} is not within {STEEPEST:e} a second, or longer than keys can be apart"
    )]
    TangentOutOfRange {
        /// Index of the key.
        index: usize,
    },
    /// A handle reaches to the wrong side of its key.
    #[error("a handle of key {index} reaches less than 0 s from it")]
    HandleBackwards {
        /// Index of the key.
        index: usize,
    },
    /// The four components of a quaternion have no handles of their own; Euler curves have.
    #[error("key {index} has handles in time, which quaternions cannot have: use Euler curves")]
    HandlesOfQuaternion {
        /// Index of the key.
        index: usize,
    },
}

impl TrackError {
    /// The index of the key that is at fault; `None` when there is none at all.
    pub fn key(&self) -> Option<usize> {
        match *self {
            Self::Empty => None,
            Self::TimeOutOfRange { index }
            | Self::NotAscending { index, .. }
            | Self::ValueOutOfRange { index }
            | Self::NotUnit { index, .. }
            | Self::TangentOutOfRange { index }
            | Self::HandleBackwards { index }
            | Self::HandlesOfQuaternion { index } => Some(index),
        }
    }
}

/// Whether keys make a track, and if not, why.
pub(super) fn check<V: KeyValue>(keys: &[Keyframe<V>]) -> Result<(), TrackError> {
    if keys.is_empty() {
        return Err(TrackError::Empty);
    }
    let mut previous: Option<f64> = None;
    for (index, key) in keys.iter().enumerate() {
        let time_secs = key.time_secs;
        // NaN is within nothing.
        if time_secs.is_nan() || time_secs.abs() > LONGEST_SECS {
            return Err(TrackError::TimeOutOfRange { index });
        }
        let is_too_early = |previous: &f64| time_secs - previous < LEAST_GAP_SECS;
        if let Some(previous_secs) = previous.filter(is_too_early) {
            return Err(TrackError::NotAscending {
                index,
                time_secs,
                previous_secs,
            });
        }
        previous = Some(time_secs);
        match key.value.fault() {
            None => {}
            Some(ValueFault::OutOfRange) => return Err(TrackError::ValueOutOfRange { index }),
            Some(ValueFault::NotUnit(length)) => return Err(TrackError::NotUnit { index, length }),
        }
        let tangents_are_in_range = match key.tangents {
            Tangents::Aligned(tangent) => tangent.is_within(STEEPEST),
            Tangents::Broken { incoming, outgoing } => {
                incoming.is_within(STEEPEST) && outgoing.is_within(STEEPEST)
            }
            Tangents::Handles {
                incoming, outgoing, ..
            } => {
                if !V::HAS_HANDLES {
                    return Err(TrackError::HandlesOfQuaternion { index });
                }
                let both = [incoming, outgoing];
                let in_range = both.iter().all(|it| {
                    it.secs.is_within(LONGEST_SECS) && it.value.is_within(LONGEST_LENGTH)
                });
                if in_range && !both.iter().all(|it| it.secs.is_no_less_than_zero()) {
                    return Err(TrackError::HandleBackwards { index });
                }
                in_range
            }
            Tangents::Auto | Tangents::Smooth | Tangents::Flat => true,
        };
        if !tangents_are_in_range {
            return Err(TrackError::TangentOutOfRange { index });
        }
    }
    Ok(())
}
