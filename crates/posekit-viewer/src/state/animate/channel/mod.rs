//! A track as the curves of a graph editor: scalar channels over time, their keys and handles, and edits of
//! them.
//!
//! **Units.** Times are seconds. A number and the components of a vector are what they are; an orientation
//! has three angles in degrees, in a chosen order of axes, that go on from key to key without jumping back
//! after half a turn. Slopes are the channel's unit per second.
//!
//! Euler curves are what they look like. An orientation of quaternions is one value and not three: between keys
//! it takes the short way whatever its angles are, so the curve of one angle may bend when another's key is
//! moved, and a key more than half a turn from the one before it is reached the other way round.

mod edit;
mod euler;
mod parts;
mod sampled;
#[cfg(test)]
mod tests;
mod walk;

use glam::{DQuat, DVec3};
use posekit::keyframe::{Interpolation, Track, lost_turn};
use posekit::rotation::{Axis, EulerOrder};

use super::{LaneTrack, TrackValue};
pub use edit::{
    Dot, Edited, Scaling, TangentKind, drag_handle, drag_handle_to, insert_on_curve, move_dots,
    scale_dots, set_tangents,
};
use parts::{InParts, Parts};
pub use sampled::Sampled;
use walk::Walk;

/// A side of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The segment that ends at it.
    Incoming,
    /// The segment that starts at it.
    Outgoing,
}

impl Side {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Incoming, Self::Outgoing];

    /// -1 before the key, 1 after it.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Incoming => -1.0,
            Self::Outgoing => 1.0,
        }
    }

    /// Its place in a pair of both.
    #[must_use]
    pub const fn index(self) -> usize {
        match self {
            Self::Incoming => 0,
            Self::Outgoing => 1,
        }
    }
}

impl From<Track<f64>> for TrackValue {
    fn from(track: Track<f64>) -> Self {
        Self::Number(track)
    }
}

impl From<Track<DVec3>> for TrackValue {
    fn from(track: Track<DVec3>) -> Self {
        Self::Vector(track)
    }
}

impl From<Track<DQuat>> for TrackValue {
    fn from(track: Track<DQuat>) -> Self {
        Self::Orientation(track)
    }
}

/// Does the same for a track of any kind; Euler curves count as vectors.
macro_rules! with_track {
    ($value:expr, $track:ident => $body:expr) => {
        match $value {
            $crate::state::animate::TrackValue::Number($track) => $body,
            $crate::state::animate::TrackValue::Vector($track) => $body,
            $crate::state::animate::TrackValue::Orientation($track) => $body,
            $crate::state::animate::TrackValue::Euler(euler) => {
                let $track = euler.angles_deg();
                $body
            }
        }
    };
}
use with_track;

/// A track and its channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Channels {
    track: TrackValue,
    order: EulerOrder,
    /// Of an orientation.
    walk: Option<Walk>,
}

impl Channels {
    /// The channels of a track. Angles are those of `order`, or where it lacks an axis of an order with
    /// that axis added; the first key's are those nearest to `near_deg`.
    #[must_use]
    pub fn of(track: TrackValue, order: EulerOrder, near_deg: [f64; 3]) -> Self {
        let order = euler::complete(order);
        let walk = match &track {
            TrackValue::Orientation(track) => Some(Walk::along(track, order, near_deg)),
            TrackValue::Number(_) | TrackValue::Vector(_) | TrackValue::Euler(_) => None,
        };
        let order = match &track {
            TrackValue::Euler(track) => track.order(),
            _ => order,
        };
        Self { track, order, walk }
    }

    /// Whether these are the channels of a track in an order of angles.
    #[must_use]
    pub fn is_of(&self, track: LaneTrack<'_>, order: EulerOrder) -> bool {
        let is_own = matches!(self.track, TrackValue::Euler(_));
        (is_own || self.order == euler::complete(order)) && self.track.as_track() == track
    }

    /// The track.
    #[must_use]
    pub fn track(&self) -> &TrackValue {
        &self.track
    }

    /// How many channels there are: 1 or 3.
    #[must_use]
    pub fn count(&self) -> usize {
        match self.track {
            TrackValue::Number(_) => f64::COUNT,
            TrackValue::Vector(_) => DVec3::COUNT,
            TrackValue::Orientation(_) => DQuat::COUNT,
            TrackValue::Euler(_) => DVec3::COUNT,
        }
    }

    /// Which axis a channel is about; `None` for a number.
    #[must_use]
    pub fn axis(&self, channel: usize) -> Option<Axis> {
        match self.track {
            TrackValue::Number(_) => None,
            TrackValue::Vector(_) => Axis::ALL.get(channel).copied(),
            TrackValue::Orientation(_) | TrackValue::Euler(_) => {
                self.order.axes().get(channel).copied()
            }
        }
    }

    /// Whether the channels are curves of their own, and not what an orientation happens to be in angles.
    #[must_use]
    pub fn are_curves(&self) -> bool {
        !matches!(self.track, TrackValue::Orientation(_))
    }

    /// Whether the channels are angles in degrees.
    #[must_use]
    pub fn are_angles(&self) -> bool {
        matches!(
            self.track,
            TrackValue::Orientation(_) | TrackValue::Euler(_)
        )
    }

    /// The times of the keys in seconds, in rising order.
    #[must_use]
    pub fn times_secs(&self) -> &[f64] {
        with_track!(&self.track, track => track.times_secs())
    }

    /// Whether a key of quaternions, one of whose angles is brought to a value, will be reached another way than
    /// its angles say: from the key before it, or from it to the key after.
    #[must_use]
    pub fn loses_turn(&self, dot: Dot, value: f64) -> bool {
        let count = self.times_secs().len();
        if self.are_curves() || dot.key >= count {
            return false;
        }
        let mut asked = DVec3::from_array(self.at_key(dot.key));
        asked[dot.channel] = value;
        let neighbours = [dot.key.checked_sub(1), Some(dot.key + 1)];
        let mut neighbours = neighbours.into_iter().flatten().filter(|key| *key < count);
        neighbours.any(|key| {
            let there = DVec3::from_array(self.at_key(key));
            lost_turn(self.order, there, asked).is_some()
        })
    }

    /// How the segment that starts at a key is filled.
    ///
    /// # Panics
    /// If there is no such key.
    #[must_use]
    pub fn interpolation(&self, key: usize) -> Interpolation {
        with_track!(&self.track, track => track.keys()[key].interpolation)
    }

    /// What kind of tangents a key has.
    ///
    /// # Panics
    /// If there is no such key.
    #[must_use]
    pub fn tangent_kind(&self, key: usize) -> TangentKind {
        with_track!(&self.track, track => TangentKind::of(&track.keys()[key].tangents))
    }

    /// The channels' values at a key; what the track has no channel for is zero.
    ///
    /// # Panics
    /// If there is no such key.
    #[must_use]
    pub fn at_key(&self, key: usize) -> [f64; 3] {
        match (&self.track, &self.walk) {
            (_, Some(walk)) => walk.at_key(key),
            (TrackValue::Number(track), None) => self.parts(track.keys()[key].value),
            (TrackValue::Vector(track), None) => self.parts(track.keys()[key].value),
            (TrackValue::Orientation(track), None) => self.parts(track.keys()[key].value),
            (TrackValue::Euler(track), None) => self.parts(track.angles_deg().keys()[key].value),
        }
    }

    /// The channels' values at a time in seconds.
    #[must_use]
    pub fn at(&self, time_secs: f64) -> [f64; 3] {
        match (&self.track, &self.walk) {
            (TrackValue::Orientation(track), Some(walk)) => walk.at(track, self.order, time_secs),
            (TrackValue::Orientation(track), None) => self.parts(track.sample(time_secs)),
            (TrackValue::Number(track), _) => self.parts(track.sample(time_secs)),
            (TrackValue::Vector(track), _) => self.parts(track.sample(time_secs)),
            (TrackValue::Euler(track), _) => self.parts(track.angles_deg().sample(time_secs)),
        }
    }

    fn parts<V: InParts>(&self, value: V) -> Parts {
        value.parts(self.order, [0.0; 3])
    }

    /// The channels' slopes at a key, on the segment that ends there and on the one that starts there, were
    /// both cubic. `None` next to gimbal lock, where angles have none.
    ///
    /// # Panics
    /// If there is no such key.
    #[must_use]
    pub fn slopes(&self, key: usize) -> Option<[[f64; 3]; 2]> {
        with_track!(&self.track, track => self.slopes_of(track, key))
    }

    fn slopes_of<V: InParts>(&self, track: &Track<V>, key: usize) -> Option<[Parts; 2]> {
        let value = track.keys()[key].value;
        let parts = self.at_key(key);
        let [incoming, outgoing] = track.tangents_at(key);
        Some([
            value.slopes(incoming, parts, self.order)?,
            value.slopes(outgoing, parts, self.order)?,
        ])
    }

    /// The seconds of the segment on a side of a key, if it is cubic.
    fn cubic_secs(&self, key: usize, side: Side) -> Option<f64> {
        let times = self.times_secs();
        let (from, to) = match side {
            Side::Incoming => (key.checked_sub(1)?, key),
            Side::Outgoing => (key, key + 1),
        };
        let secs = times.get(to)? - times[from];
        (self.interpolation(from) == Interpolation::Cubic).then_some(secs)
    }

    /// Where a key's handle lies, seconds and value, as the curve uses it. That of quaternions is a third of the
    /// way to the neighbour in time, on the slope; others may lie anywhere on their side of the key, up to the
    /// neighbour. `None` where there is no cubic segment, and of quaternions next to gimbal lock.
    ///
    /// # Panics
    /// If there is no such key.
    #[must_use]
    pub fn handle(&self, key: usize, channel: usize, side: Side) -> Option<[f64; 2]> {
        let [secs, rise] = self.handle_parts(key, side)?;
        Some([
            self.times_secs()[key] + side.sign() * secs[channel],
            self.at_key(key)[channel] + rise[channel],
        ])
    }

    /// How far the channels' handles on a side of a key reach in time, and how far they rise.
    fn handle_parts(&self, key: usize, side: Side) -> Option<[Parts; 2]> {
        let index = side.index();
        match &self.track {
            TrackValue::Number(track) => {
                let handle = track.handles_at(key)[index]?;
                Some([self.parts(handle.secs), self.parts(handle.value)])
            }
            TrackValue::Vector(track) => {
                let handle = track.handles_at(key)[index]?;
                Some([self.parts(handle.secs), self.parts(handle.value)])
            }
            TrackValue::Euler(track) => {
                let handle = track.angles_deg().handles_at(key)[index]?;
                Some([self.parts(handle.secs), self.parts(handle.value)])
            }
            TrackValue::Orientation(_) => {
                let secs = self.cubic_secs(key, side)? / 3.0;
                let slopes = self.slopes(key)?[index];
                Some([[secs; 3], slopes.map(|slope| slope * side.sign() * secs)])
            }
        }
    }

    /// The channels over a span of seconds, for drawing: about every `step_secs`, at every key, and on
    /// both sides of every jump.
    #[must_use]
    pub fn sampled(&self, span_secs: [f64; 2], step_secs: f64) -> Sampled {
        Sampled::of(self, span_secs, step_secs)
    }
}
