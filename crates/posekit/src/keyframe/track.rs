//! One animated property: keys in rising order of time, and its value at any time.

use glam::{DQuat, DVec3};

use super::extrapolation::{Extrapolation, Place};
use super::key::{Handle, HandlePair, Interpolation, Keyframe, Tangents};
use super::track_error::{TrackError, check};
use super::value::{KeyValue, Meeting};

/// A key as the curve uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot<V> {
    /// The value, of an orientation at unit length and on the short side of the key before it.
    pub(super) value: V,
    /// At the end of the segment before: the change over that segment (cubic), or the inner point
    /// (squad).
    pub(super) incoming: V,
    /// The same at the start of the segment after.
    pub(super) outgoing: V,
}

/// The way from a key to the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment<V> {
    pub(super) interpolation: Interpolation,
    pub(super) from: Knot<V>,
    pub(super) to: Knot<V>,
    pub(super) secs: f64,
    /// How far the handles of a cubic reach in time, as shares of the way, where not a third each.
    pub(super) reaches: Option<[V; 2]>,
}

impl<V: KeyValue> Segment<V> {
    /// The value a share of the way along, 0 to 1.
    pub(super) fn at(&self, t: f64) -> V {
        let Self { from, to, .. } = self;
        match self.interpolation {
            Interpolation::Step => from.value,
            Interpolation::Linear => V::straight(from.value, to.value, t),
            Interpolation::Cubic => match self.reaches {
                None => V::hermite(from.value, from.outgoing, to.value, to.incoming, t),
                Some(reaches) => {
                    let slopes = [from.outgoing, to.incoming];
                    V::bezier([from.value, to.value], slopes, reaches, t)
                }
            },
            Interpolation::Squad => V::squad(from.value, from.outgoing, to.value, to.incoming, t),
        }
    }
}

/// One animated property: at least one key, in rising order of time.
///
/// Between two keys the value follows the first one's [`Interpolation`]; before the first and after
/// the last one it follows the [`Extrapolation`]s. Orientations take the short way from each key to
/// the next whatever the signs of their quaternions: the signs are put right over the whole track once,
/// tangents with them. [`with_signs_as_given`](Self::with_signs_as_given) makes one that does not.
///
/// A track is a value: editing makes a new one (see [`edit`](super::edit)).
///
/// Cost: a binary search over the keys and one segment, in `f64`. A whole keyed skeleton is sampled
/// faster by a [`PoseSampler`](super::PoseSampler).
///
/// ```
/// use posekit::keyframe::{Extrapolation, Interpolation, Keyframe, Track};
///
/// let keys = [(0.0, 1.0), (2.0, 5.0)].map(|(t, v)| Keyframe::new(t, v, Interpolation::Linear));
/// let track = Track::new(keys.to_vec(), Extrapolation::Hold)?;
/// assert_eq!(track.sample(0.5), 2.0);
/// assert_eq!(track.sample(9.0), 5.0);
/// # Ok::<(), posekit::keyframe::TrackError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Track<V: KeyValue> {
    keys: Vec<Keyframe<V>>,
    before: Extrapolation,
    after: Extrapolation,
    signs: Signs,
    times: Vec<f64>,
    knots: Vec<Knot<V>>,
}

/// Which of the two quaternions of an orientation a curve goes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Signs {
    /// The one on the short side of the key before.
    Short,
    /// The one that the key has.
    Given,
}

impl<V: KeyValue> Track<V> {
    /// A track of these keys that goes on in one way before its first and after its last key.
    ///
    /// # Errors
    /// [`TrackError`] when there is no key, a number is beyond the [`range`](crate::range) of what posekit works
    /// with, times do not rise or a quaternion is not of unit length.
    pub fn new(keys: Vec<Keyframe<V>>, beyond: Extrapolation) -> Result<Self, TrackError> {
        Self::with_ends(keys, beyond, beyond)
    }

    /// A track that goes on in one way before its first key and in another after its last.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_ends(
        keys: Vec<Keyframe<V>>,
        before: Extrapolation,
        after: Extrapolation,
    ) -> Result<Self, TrackError> {
        Self::build(keys, [before, after], Signs::Short)
    }

    /// A track of orientations whose quaternions keep their signs, as `CUBICSPLINE` in glTF 2.0 has it: a cubic goes
    /// from key to key as the signs and the tangents say, if need be the long way. (Straight ways are the short ones
    /// even so.) For numbers and vectors it is [`new`](Self::new).
    ///
    /// The signs are kept as long as the track is; one that [`edit`](super::edit) makes of it goes the short ways.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_signs_as_given(
        keys: Vec<Keyframe<V>>,
        beyond: Extrapolation,
    ) -> Result<Self, TrackError> {
        Self::build(keys, [beyond; 2], Signs::Given)
    }

    fn build(
        keys: Vec<Keyframe<V>>,
        [before, after]: [Extrapolation; 2],
        signs: Signs,
    ) -> Result<Self, TrackError> {
        check(&keys)?;
        let times = keys.iter().map(|key| key.time_secs).collect();
        let mut track = Self {
            knots: knots_without_controls(&keys, signs),
            keys,
            before,
            after,
            signs,
            times,
        };
        for start in 0..track.keys.len() - 1 {
            let (outgoing, incoming) = track.segment_controls(start);
            track.knots[start].outgoing = outgoing;
            track.knots[start + 1].incoming = incoming;
        }
        Ok(track)
    }

    /// A track of one key: a property that keeps its value.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn constant(value: V) -> Result<Self, TrackError> {
        let key = Keyframe::new(0.0, value, Interpolation::Linear);
        Self::new(vec![key], Extrapolation::Hold)
    }

    /// The keys, as they were given.
    pub fn keys(&self) -> &[Keyframe<V>] {
        &self.keys
    }

    /// How it goes on before its first key.
    pub fn before(&self) -> Extrapolation {
        self.before
    }

    /// How it goes on after its last key.
    pub fn after(&self) -> Extrapolation {
        self.after
    }

    /// The times of the keys in seconds, in rising order.
    pub fn times_secs(&self) -> &[f64] {
        &self.times
    }

    /// The time of the first key in seconds.
    pub fn start_secs(&self) -> f64 {
        self.times[0]
    }

    /// The time of the last key in seconds.
    pub fn end_secs(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Which time between its keys a time takes its value from.
    pub fn place(&self, time_secs: f64) -> Place {
        Place::of(
            time_secs,
            [self.start_secs(), self.end_secs()],
            [self.before, self.after],
        )
    }

    /// The value at a time in seconds; NaN counts as the time of the first key.
    pub fn sample(&self, time_secs: f64) -> V {
        let place = self.place(time_secs);
        let value = self.within(place.time_secs);
        if place.shifts == 0.0 {
            return value;
        }
        let [first, last] = self.ends();
        value.shifted(first, last, place.shifts)
    }

    /// The derivative at a key, per second, on the segment that ends there and on the one that starts
    /// there: what a graph editor draws handles from. Of an orientation it is that of the quaternion
    /// `key.value`, whose sign it fits. A handle straight up counts as a microsecond long.
    ///
    /// # Panics
    /// If there is no such key.
    pub fn tangents_at(&self, index: usize) -> [V; 2] {
        let velocity = |side| self.side_tangent(index, side);
        let sign = self.sign(index);
        [velocity(Side::Incoming), velocity(Side::Outgoing)].map(|tangent| tangent.scaled(sign))
    }

    /// The index of the last key at or before a time, `None` before the first.
    pub fn key_before(&self, time_secs: f64) -> Option<usize> {
        self.times
            .partition_point(|&at| at <= time_secs)
            .checked_sub(1)
    }

    /// The index of the first key after a time, `None` from the last one on.
    pub fn key_after(&self, time_secs: f64) -> Option<usize> {
        let index = self.times.partition_point(|&at| at <= time_secs);
        (index < self.times.len()).then_some(index)
    }

    /// The value at a time between the first and the last key.
    fn within(&self, time_secs: f64) -> V {
        let last = self.times.len() - 1;
        let at = self.times.partition_point(|&at| at <= time_secs);
        if at == 0 || at > last {
            return self.knots[if at == 0 { 0 } else { last }].value;
        }
        let segment = self.segment(at - 1);
        segment.at((time_secs - self.times[at - 1]) / segment.secs)
    }

    /// The segment that starts at a key that is not the last.
    pub(super) fn segment(&self, start: usize) -> Segment<V> {
        Segment {
            interpolation: self.keys[start].interpolation,
            from: self.knots[start],
            to: self.knots[start + 1],
            secs: self.times[start + 1] - self.times[start],
            reaches: self.reaches(start),
        }
    }

    /// How far the handles of a segment reach in time, as shares of it; `None` for a third each.
    fn reaches(&self, start: usize) -> Option<[V; 2]> {
        let [from, to] = [&self.keys[start], &self.keys[start + 1]];
        let own = [
            handle_of(&from.tangents, Side::Outgoing),
            handle_of(&to.tangents, Side::Incoming),
        ];
        if from.interpolation != Interpolation::Cubic || own == [None; 2] {
            return None;
        }
        let secs = self.times[start + 1] - self.times[start];
        Some(
            own.map(|handle| {
                handle.map_or_else(V::third, |it| V::within(it.secs, it.value, secs).0)
            }),
        )
    }

    /// Whether a cubic segment has handles that are free in time.
    pub(super) fn has_handles(&self) -> bool {
        (0..self.keys.len() - 1).any(|start| self.reaches(start).is_some())
    }

    /// A key on the curve at a time inside a segment whose handles are free in time, and what it makes of the
    /// keys at both ends, the first of which has the given index: the curve stays where it is. `None` on other
    /// segments.
    pub(super) fn cut_at(&self, time_secs: f64) -> Option<(usize, [Keyframe<V>; 3])> {
        let start = self.key_before(time_secs)?;
        self.key_after(time_secs)?;
        let segment = self.segment(start);
        let reaches = segment.reaches?;
        let Segment { from, to, secs, .. } = segment;
        let share = (time_secs - self.times[start]) / secs;
        let slopes = [from.outgoing, to.incoming];
        let (value, handles) = V::cut_bezier([from.value, to.value], slopes, reaches, share);
        let [first, before, after, last] = handles.map(|(share, value)| Handle {
            secs: share.scaled(secs),
            value,
        });
        let [mut one, mut two] = [self.keys[start], self.keys[start + 1]];
        let none = Handle {
            secs: V::third().scaled(0.0),
            value: V::third().scaled(0.0),
        };
        one.tangents = Tangents::Handles {
            incoming: self.handles_at(start)[0].unwrap_or(none),
            outgoing: first,
            pair: pair_of(&one.tangents),
        };
        two.tangents = Tangents::Handles {
            incoming: last,
            outgoing: self.handles_at(start + 1)[1].unwrap_or(none),
            pair: pair_of(&two.tangents),
        };
        let middle = Keyframe {
            time_secs,
            value,
            interpolation: Interpolation::Cubic,
            tangents: Tangents::Handles {
                incoming: before,
                outgoing: after,
                pair: HandlePair::Aligned,
            },
        };
        Some((start, [one, middle, two]))
    }

    /// The handle on one side of a key as the curve uses it: where it lies, seen from the key, seconds
    /// away from it and value. `None` where that side is not a cubic segment, or the values are
    /// orientations.
    ///
    /// # Panics
    /// If there is no such key.
    pub fn handles_at(&self, index: usize) -> [Option<Handle<V>>; 2] {
        [Side::Incoming, Side::Outgoing].map(|side| {
            let start = match side {
                Side::Incoming => index.checked_sub(1)?,
                Side::Outgoing => index,
            };
            let end = self.times.get(start + 1)?;
            let secs = end - self.times[start];
            if !V::HAS_HANDLES || self.keys[start].interpolation != Interpolation::Cubic {
                return None;
            }
            let shares = self.reaches(start).unwrap_or_else(|| [V::third(); 2]);
            let (share, change) = match side {
                Side::Incoming => (shares[1], self.knots[index].incoming.scaled(-1.0)),
                Side::Outgoing => (shares[0], self.knots[index].outgoing),
            };
            Some(Handle {
                secs: share.scaled(secs),
                value: change.scaled(1.0 / 3.0),
            })
        })
    }

    /// The values of the first and the last key, as the curve uses them.
    pub(super) fn ends(&self) -> [V; 2] {
        [0, self.knots.len() - 1].map(|index| self.knots[index].value)
    }

    /// What the segment that starts at a key needs at its two ends.
    fn segment_controls(&self, start: usize) -> (V, V) {
        let secs = self.times[start + 1] - self.times[start];
        match self.keys[start].interpolation {
            Interpolation::Step | Interpolation::Linear => {
                (self.knots[start].value, self.knots[start + 1].value)
            }
            Interpolation::Cubic => (
                self.change(start, Side::Outgoing, secs),
                self.change(start + 1, Side::Incoming, secs),
            ),
            Interpolation::Squad => {
                let velocities = [start, start + 1].map(|index| {
                    let meeting = self.meeting(index);
                    meeting.map_or_else(|only| only, V::squad_velocity)
                });
                let (from, to) = (self.knots[start].value, self.knots[start + 1].value);
                let [outgoing, incoming] = V::squad_controls(from, to, velocities, secs);
                (outgoing, incoming)
            }
        }
    }

    /// What the tangent on one side of a key would change over a cubic segment: three times as much as its
    /// handle does.
    fn change(&self, index: usize, side: Side, secs: f64) -> V {
        match handle_of(&self.keys[index].tangents, side) {
            Some(handle) => {
                let (_, value) = V::within(handle.secs, handle.value, secs);
                value.scaled(match side {
                    Side::Incoming => -3.0,
                    Side::Outgoing => 3.0,
                })
            }
            None => self.side_tangent(index, side).scaled(secs),
        }
    }

    /// The derivative per second of the knot's value on one side of a key, as its tangents say.
    fn side_tangent(&self, index: usize, side: Side) -> V {
        let value = self.knots[index].value;
        let velocity = match (self.keys[index].tangents, self.meeting(index)) {
            (Tangents::Aligned(tangent), _) => return tangent.scaled(self.sign(index)),
            (Tangents::Broken { incoming, outgoing }, _) => {
                let tangent = match side {
                    Side::Incoming => incoming,
                    Side::Outgoing => outgoing,
                };
                return tangent.scaled(self.sign(index));
            }
            (
                Tangents::Handles {
                    incoming, outgoing, ..
                },
                _,
            ) => {
                return match side {
                    Side::Incoming => {
                        V::slope_of_handle(incoming.secs, incoming.value).scaled(-1.0)
                    }
                    Side::Outgoing => V::slope_of_handle(outgoing.secs, outgoing.value),
                };
            }
            (Tangents::Auto, Ok(meeting)) => V::clamped_velocity(meeting),
            (Tangents::Smooth, Ok(meeting)) => V::smooth_velocity(meeting),
            (Tangents::Smooth, Err(only)) => only,
            (Tangents::Auto, Err(_)) | (Tangents::Flat, _) => V::Velocity::default(),
        };
        value.tangent(velocity)
    }

    /// The velocities that meet at a key; at an end of a track that does not cycle the only one there
    /// is. A track that cycles is joined end to start.
    fn meeting(&self, index: usize) -> Result<Meeting<V::Velocity>, V::Velocity> {
        let last = self.keys.len() - 1;
        if last == 0 {
            return Err(V::Velocity::default());
        }
        let before = match index {
            0 if self.before.cycles() => Some(last - 1),
            0 => None,
            _ => Some(index - 1),
        };
        let after = match index {
            _ if index < last => Some(index),
            _ if self.after.cycles() => Some(0),
            _ => None,
        };
        match (before, after) {
            (Some(before), Some(after)) => {
                let (before, secs_before) = self.segment_velocity(before);
                let (after, secs_after) = self.segment_velocity(after);
                Ok(Meeting {
                    before,
                    secs_before,
                    after,
                    secs_after,
                })
            }
            (Some(only), None) | (None, Some(only)) => Err(self.segment_velocity(only).0),
            (None, None) => Err(V::Velocity::default()),
        }
    }

    fn segment_velocity(&self, start: usize) -> (V::Velocity, f64) {
        let secs = self.times[start + 1] - self.times[start];
        let (from, to) = (self.knots[start].value, self.knots[start + 1].value);
        (V::velocity(from, to, secs), secs)
    }

    /// -1 where the short way turned the sign of a key's quaternion, and its tangents with it.
    fn sign(&self, index: usize) -> f64 {
        if self.knots[index].value.is_far_side(self.keys[index].value) {
            -1.0
        } else {
            1.0
        }
    }
}

/// The keys' values at unit length, each with the sign that it is to have.
fn knots_without_controls<V: KeyValue>(keys: &[Keyframe<V>], signs: Signs) -> Vec<Knot<V>> {
    let mut knots: Vec<Knot<V>> = Vec::with_capacity(keys.len());
    for key in keys {
        let given = key.value.normalized();
        let previous = knots.last().map(|knot| knot.value);
        let value = match previous.filter(|_| signs == Signs::Short) {
            Some(previous) if given.is_far_side(previous) => given.scaled(-1.0),
            _ => given,
        };
        knots.push(Knot {
            value,
            incoming: value,
            outgoing: value,
        });
    }
    knots
}

#[derive(Clone, Copy)]
enum Side {
    Incoming,
    Outgoing,
}

/// Whether both sides of a key go on in one line.
fn pair_of<V>(tangents: &Tangents<V>) -> HandlePair {
    match tangents {
        Tangents::Handles { pair, .. } => *pair,
        Tangents::Broken { .. } => HandlePair::Broken,
        _ => HandlePair::Aligned,
    }
}

/// The handle on a side of a key, where it has one that is free in time.
fn handle_of<V: KeyValue>(tangents: &Tangents<V>, side: Side) -> Option<Handle<V>> {
    match (tangents, side) {
        (Tangents::Handles { incoming, .. }, Side::Incoming) => Some(*incoming),
        (Tangents::Handles { outgoing, .. }, Side::Outgoing) => Some(*outgoing),
        _ => None,
    }
}

/// The derivative of a unit quaternion that turns with an angular velocity in body coordinates, in
/// radians per second: what a [`Tangents`] of an orientation holds.
pub fn tangent_of_angular_velocity(orientation: DQuat, in_body_rad_per_sec: DVec3) -> DQuat {
    orientation * DQuat::from_vec4((in_body_rad_per_sec * 0.5).extend(0.0))
}

/// The angular velocity in body coordinates, radians per second, of a quaternion with a derivative.
/// The part of the derivative along the quaternion changes its length alone and is left out.
pub fn angular_velocity_of_tangent(orientation: DQuat, tangent: DQuat) -> DVec3 {
    (orientation.conjugate() * tangent).xyz() * (2.0 / orientation.length_squared())
}
