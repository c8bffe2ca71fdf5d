//! A track as the curves of a graph editor: scalar channels over time, their keys and handles, and edits of
//! them.
//!
//! **Units.** Times are seconds. A number and the components of a vector are what they are; an orientation
//! has three angles in degrees, in a chosen order of axes, that go on from key to key without jumping back
//! after half a turn. Slopes are the channel's unit per second.
//!
//! An orientation is one value and not three: between keys it takes the short way whatever its angles are, so
//! the curve of one angle may bend when another's key is moved, and a key more than half a turn from the one
//! before it is reached the other way round.

mod edit;
mod euler;
mod parts;
mod sampled;
#[cfg(test)]
mod tests;
mod walk;

use glam::{DQuat, DVec3};
use posekit::keyframe::{Interpolation, Track};
use posekit::rotation::{Axis, EulerOrder};

use super::{LaneTrack, TrackValue};
pub use edit::{
    Dot, Edited, Scaling, TangentKind, drag_handle, insert_on_curve, move_dots, scale_dots,
    set_tangents,
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

/// Does the same for a track of any kind.
macro_rules! with_track {
    ($value:expr, $track:ident => $body:expr) => {
        match $value {
            $crate::state::animate::TrackValue::Number($track) => $body,
            $crate::state::animate::TrackValue::Vector($track) => $body,
            $crate::state::animate::TrackValue::Orientation($track) => $body,
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
            TrackValue::Number(_) | TrackValue::Vector(_) => None,
        };
        Self { track, order, walk }
    }

    /// Whether these are the channels of a track in an order of angles.
    #[must_use]
    pub fn is_of(&self, track: LaneTrack<'_>, order: EulerOrder) -> bool {
        self.order == euler::complete(order) && self.track.as_track() == track
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
        }
    }

    /// Which axis a channel is about; `None` for a number.
    #[must_use]
    pub fn axis(&self, channel: usize) -> Option<Axis> {
        match self.track {
            TrackValue::Number(_) => None,
            TrackValue::Vector(_) => Axis::ALL.get(channel).copied(),
            TrackValue::Orientation(_) => self.order.axes().get(channel).copied(),
        }
    }

    /// Whether the channels are angles in degrees.
    #[must_use]
    pub fn are_angles(&self) -> bool {
        self.walk.is_some()
    }

    /// The times of the keys in seconds, in rising order.
    #[must_use]
    pub fn times_secs(&self) -> &[f64] {
        with_track!(&self.track, track => track.times_secs())
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

    /// Where a key's handle lies, seconds and value: a third of the way to the neighbour in time, on the
    /// slope. `None` where there is no cubic segment, and next to gimbal lock.
    ///
    /// # Panics
    /// If there is no such key.
    #[must_use]
    pub fn handle(&self, key: usize, channel: usize, side: Side) -> Option<[f64; 2]> {
        let reach = side.sign() * self.handle_secs(key, side)?;
        let slope = self.slopes(key)?[side.index()][channel];
        Some([
            self.times_secs()[key] + reach,
            self.at_key(key)[channel] + slope * reach,
        ])
    }

    /// How far in time a key's handle reaches.
    fn handle_secs(&self, key: usize, side: Side) -> Option<f64> {
        Some(self.cubic_secs(key, side)? / 3.0)
    }

    /// The slope that brings a key's handle to a value.
    #[must_use]
    pub fn slope_to(&self, key: usize, channel: usize, side: Side, value: f64) -> Option<f64> {
        let reach = side.sign() * self.handle_secs(key, side)?;
        Some((value - self.at_key(key)[channel]) / reach)
    }

    /// The channels over a span of seconds, for drawing: about every `step_secs`, at every key, and on
    /// both sides of every jump.
    #[must_use]
    pub fn sampled(&self, span_secs: [f64; 2], step_secs: f64) -> Sampled {
        Sampled::of(self, span_secs, step_secs)
    }
}
