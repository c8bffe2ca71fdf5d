//! Angles that go on from key to key: where they turn past half a turn they do not jump.

use glam::DQuat;
use posekit::keyframe::{Interpolation, Track, angular_velocity_of_tangent};
use posekit::rotation::{EulerOrder, angle_between};

use super::euler::angles_near_deg;
use super::parts::Parts;
use crate::state::clip::{index_to_f64, nearest_index};

/// A stretch in which the orientation turns by this, or a little more where the curve bends: small against
/// the half turn from which on there is no telling which way the angles went.
const STRETCH_RAD: f64 = 0.2;

/// The most stretches of a segment, for tangents that turn many times.
const MOST_STRETCHES: usize = 64;

/// The angles of a track, in degrees, at its keys and at places between them, each the nearest to those before.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Walk {
    /// Of each segment, from its first key to its last.
    segments: Vec<Vec<Parts>>,
    /// At the last key.
    last: Parts,
}

impl Walk {
    /// Goes along a track; the first key's angles are those nearest to `near`.
    pub(super) fn along(track: &Track<DQuat>, order: EulerOrder, near: Parts) -> Self {
        let mut angles = angles_near_deg(order, track.sample(track.start_secs()), near);
        let mut segments = Vec::with_capacity(track.keys().len() - 1);
        for start in 0..track.keys().len() - 1 {
            let places = stretches(track, start);
            let [from, to] = [start, start + 1].map(|key| track.times_secs()[key]);
            let mut segment = vec![angles];
            for place in 1..=places {
                let time = if place == places {
                    to
                } else {
                    from + (to - from) * share(place, places)
                };
                angles = angles_near_deg(order, track.sample(time), angles);
                segment.push(angles);
            }
            segments.push(segment);
        }
        Self {
            segments,
            last: angles,
        }
    }

    /// The angles at a key.
    pub(super) fn at_key(&self, index: usize) -> Parts {
        self.segments.get(index).map_or(self.last, |nodes| nodes[0])
    }

    /// The angles at a time in seconds.
    pub(super) fn at(&self, track: &Track<DQuat>, order: EulerOrder, time_secs: f64) -> Parts {
        let place = track.place(time_secs);
        let mut guess = self.guess(track, place.time_secs);
        if place.shifts != 0.0 {
            let [first, last] = [self.at_key(0), self.last];
            for part in 0..3 {
                guess[part] += (last[part] - first[part]) * place.shifts;
            }
        }
        angles_near_deg(order, track.sample(time_secs), guess)
    }

    /// The angles near a time between the keys.
    fn guess(&self, track: &Track<DQuat>, time_secs: f64) -> Parts {
        let start = track.key_before(time_secs).unwrap_or(0);
        let Some(nodes) = self.segments.get(start) else {
            return self.last;
        };
        if track.keys()[start].interpolation == Interpolation::Step {
            return nodes[0];
        }
        let times = track.times_secs();
        let along = (time_secs - times[start]) / (times[start + 1] - times[start]);
        let along = along.clamp(0.0, 1.0) * index_to_f64(nodes.len() - 1);
        let before = nearest_index(along.floor(), nodes.len() - 2);
        let rest = along - index_to_f64(before);
        std::array::from_fn(|part| {
            nodes[before][part] * (1.0 - rest) + nodes[before + 1][part] * rest
        })
    }
}

fn share(place: usize, places: usize) -> f64 {
    index_to_f64(place) / index_to_f64(places)
}

/// In how many stretches a segment is gone along.
fn stretches(track: &Track<DQuat>, start: usize) -> usize {
    let [from, to] = [start, start + 1].map(|key| &track.keys()[key]);
    if from.interpolation == Interpolation::Step {
        return 1;
    }
    let secs = to.time_secs - from.time_secs;
    let turned = angle_between(from.value.normalize(), to.value.normalize());
    let by_slope = |key: usize, side: usize| {
        let tangent = track.tangents_at(key)[side];
        angular_velocity_of_tangent(track.keys()[key].value, tangent).length() * secs
    };
    let turned = match from.interpolation {
        Interpolation::Cubic => turned.max(by_slope(start, 1)).max(by_slope(start + 1, 0)),
        _ => turned,
    };
    let wanted = (turned / STRETCH_RAD).ceil();
    nearest_index(wanted, MOST_STRETCHES - 2) + 2
}
