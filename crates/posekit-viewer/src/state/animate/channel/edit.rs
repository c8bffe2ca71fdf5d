//! Edits of channels: a new track from an old one.
//!
//! Whatever is edited of one channel of a key leaves that key's other channels as they were, values and
//! slopes; tangents that are chosen from the neighbours follow them.

use std::collections::{BTreeMap, BTreeSet};

use posekit::keyframe::edit::{EditError, SAME_TIME_SECS, key_on_curve, replace_keys};
use posekit::keyframe::{Keyframe, Tangents, Track};

use super::parts::{InParts, Parts};
use super::{Channels, Side, with_track};
use crate::state::animate::TrackValue;

/// A key of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dot {
    /// The key's index.
    pub key: usize,
    /// Which of the channels.
    pub channel: usize,
}

/// How a key's tangents are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TangentKind {
    /// From the neighbours, within their range.
    Auto,
    /// From the neighbours.
    Smooth,
    /// No change.
    Flat,
    /// By hand, one slope for both sides.
    Aligned,
    /// By hand, a slope for each side.
    Broken,
}

impl TangentKind {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 5] = [
        Self::Auto,
        Self::Smooth,
        Self::Flat,
        Self::Aligned,
        Self::Broken,
    ];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "Auto",
            Self::Smooth => "Smooth",
            Self::Flat => "Flat",
            Self::Aligned => "Aligned",
            Self::Broken => "Broken",
        }
    }

    /// The kind of some tangents.
    pub(super) fn of<V>(tangents: &Tangents<V>) -> Self {
        match tangents {
            Tangents::Smooth => Self::Smooth,
            Tangents::Flat => Self::Flat,
            Tangents::Aligned(_) => Self::Aligned,
            Tangents::Broken { .. } => Self::Broken,
            _ => Self::Auto,
        }
    }
}

/// How times and values are scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    /// What stays, seconds and value.
    pub pivot: [f64; 2],
    /// Factor of times, greater than 0.
    pub time: f64,
    /// Factor of values; negative ones turn the curve over.
    pub value: f64,
}

/// What an edit has made.
#[derive(Clone, Debug, PartialEq)]
pub struct Edited {
    /// The track.
    pub track: TrackValue,
    /// From the old index of each key that is still there to its new one.
    pub keys: BTreeMap<usize, usize>,
}

/// A key as a graph has it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct GraphKey {
    time_secs: f64,
    parts: Parts,
    /// On both sides; `None` next to gimbal lock.
    slopes: Option<[Parts; 2]>,
}

/// Moves dots: their keys in time, and their channels' values.
///
/// # Errors
/// [`EditError::Track`] when a number is not finite any more.
pub fn move_dots(
    channels: &Channels,
    dots: &[Dot],
    by_secs: f64,
    by_value: f64,
) -> Result<Edited, EditError> {
    change(channels, &by_key(dots), |chosen, key| {
        key.time_secs += by_secs;
        for &channel in chosen {
            key.parts[channel] += by_value;
        }
    })
}

/// Scales the times of dots' keys and their channels' values about a pivot. Slopes that are set by hand
/// are scaled with them, so that curves keep their shape.
///
/// # Errors
/// [`EditError::BadFactor`] when the factor of times is not finite and positive, or that of values not finite.
pub fn scale_dots(
    channels: &Channels,
    dots: &[Dot],
    scaling: Scaling,
) -> Result<Edited, EditError> {
    let Scaling { pivot, time, value } = scaling;
    if !(time.is_finite() && time > 0.0) {
        return Err(EditError::BadFactor { factor: time });
    }
    if !value.is_finite() {
        return Err(EditError::BadFactor { factor: value });
    }
    change(channels, &by_key(dots), |chosen, key| {
        key.time_secs = pivot[0] + (key.time_secs - pivot[0]) * time;
        let mut factors = [1.0; 3];
        for &channel in chosen {
            key.parts[channel] = pivot[1] + (key.parts[channel] - pivot[1]) * value;
            factors[channel] = value;
        }
        if let Some(slopes) = &mut key.slopes {
            for side in slopes {
                *side = std::array::from_fn(|part| side[part] * factors[part] / time);
            }
        }
    })
}

/// Gives a channel's handle on one side of a key a slope. Broken tangents change on that side alone; all
/// others become [`TangentKind::Aligned`]. Next to gimbal lock, where there are no handles, nothing changes.
///
/// # Errors
/// [`EditError::Track`] when the slope is not finite.
pub fn drag_handle(
    channels: &Channels,
    dot: Dot,
    side: Side,
    slope: f64,
) -> Result<Edited, EditError> {
    let Some(mut slopes) = channels.slopes(dot.key) else {
        return change(channels, &BTreeMap::new(), |_, _| {});
    };
    slopes[side.index()][dot.channel] = slope;
    with_track!(channels.track(), track => {
        let mut key = track.keys()[dot.key];
        let now = track.tangents_at(dot.key);
        let parts = channels.at_key(dot.key);
        let on = |side: Side| {
            let index = side.index();
            key.value.derivative(slopes[index], parts, channels.order, now[index])
        };
        key.tangents = match (key.tangents, side) {
            (Tangents::Broken { outgoing, .. }, Side::Incoming) => Tangents::Broken {
                incoming: on(side),
                outgoing,
            },
            (Tangents::Broken { incoming, .. }, Side::Outgoing) => Tangents::Broken {
                incoming,
                outgoing: on(side),
            },
            _ => Tangents::Aligned(on(side)),
        };
        put(track, BTreeMap::from([(dot.key, key)]))
    })
}

/// Chooses the tangents of keys. Those set by hand begin as what they were; sides that become aligned meet
/// half way.
///
/// # Errors
/// None that a valid track can give.
pub fn set_tangents(
    track: &TrackValue,
    keys: &BTreeSet<usize>,
    kind: TangentKind,
) -> Result<Edited, EditError> {
    with_track!(track, track => change_keys(track, keys, |index, key| {
        let [incoming, outgoing] = track.tangents_at(index);
        key.tangents = match kind {
            TangentKind::Auto => Tangents::Auto,
            TangentKind::Smooth => Tangents::Smooth,
            TangentKind::Flat => Tangents::Flat,
            TangentKind::Aligned => Tangents::Aligned(incoming.mean(outgoing)),
            TangentKind::Broken => Tangents::Broken { incoming, outgoing },
        };
    }))
}

/// Puts a key onto the curve, which moves as little as can be.
///
/// # Errors
/// [`EditError::Track`] when the time is not finite.
pub fn insert_on_curve(track: &TrackValue, time_secs: f64) -> Result<Edited, EditError> {
    with_track!(track, track => {
        let with_key = replace_keys(track, &[], vec![key_on_curve(track, time_secs)])?;
        Ok(found_again(track, with_key, &BTreeMap::new()))
    })
}

/// The channels of each key's dots.
fn by_key(dots: &[Dot]) -> BTreeMap<usize, BTreeSet<usize>> {
    let mut keys: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for dot in dots {
        keys.entry(dot.key).or_default().insert(dot.channel);
    }
    keys
}

/// Changes keys as a graph has them.
fn change(
    channels: &Channels,
    keys: &BTreeMap<usize, BTreeSet<usize>>,
    change: impl Fn(&BTreeSet<usize>, &mut GraphKey),
) -> Result<Edited, EditError> {
    with_track!(channels.track(), track => {
        let mut changed = BTreeMap::new();
        for (&index, chosen) in keys.iter().filter(|(index, _)| **index < track.keys().len()) {
            let before = GraphKey {
                time_secs: track.times_secs()[index],
                parts: channels.at_key(index),
                slopes: channels.slopes(index),
            };
            let mut after = before;
            change(chosen, &mut after);
            changed.insert(index, key_of(channels, track, index, &before, &after));
        }
        put(track, changed)
    })
}

/// The key that a graph's key stands for. What did not change is kept to the last digit.
fn key_of<V: InParts>(
    channels: &Channels,
    track: &Track<V>,
    index: usize,
    before: &GraphKey,
    after: &GraphKey,
) -> Keyframe<V> {
    let key = track.keys()[index];
    let value = if after.parts == before.parts {
        key.value
    } else {
        V::of_parts(after.parts, channels.order)
    };
    let tangent = |tangent: V, side: Side| {
        if after.parts == before.parts && after.slopes == before.slopes {
            return tangent;
        }
        let carried = key.value.carried(tangent, value);
        match after.slopes {
            Some(slopes) => {
                let slopes = slopes[side.index()];
                value.derivative(slopes, after.parts, channels.order, carried)
            }
            None => carried,
        }
    };
    Keyframe {
        time_secs: after.time_secs,
        value,
        tangents: match key.tangents {
            Tangents::Aligned(one) => Tangents::Aligned(tangent(one, Side::Outgoing)),
            Tangents::Broken { incoming, outgoing } => Tangents::Broken {
                incoming: tangent(incoming, Side::Incoming),
                outgoing: tangent(outgoing, Side::Outgoing),
            },
            by_neighbours => by_neighbours,
        },
        ..key
    }
}

fn change_keys<V: InParts>(
    track: &Track<V>,
    keys: &BTreeSet<usize>,
    change: impl Fn(usize, &mut Keyframe<V>),
) -> Result<Edited, EditError>
where
    TrackValue: From<Track<V>>,
{
    let numbered = track.keys().iter().copied().enumerate();
    let chosen = numbered.filter(|(index, _)| keys.contains(index));
    let changed = chosen.map(|(index, mut key)| {
        change(index, &mut key);
        (index, key)
    });
    put(track, changed.collect())
}

/// The track with keys in place of those that they were made of.
fn put<V: InParts>(
    track: &Track<V>,
    changed: BTreeMap<usize, Keyframe<V>>,
) -> Result<Edited, EditError>
where
    TrackValue: From<Track<V>>,
{
    let selected: Vec<usize> = changed.keys().copied().collect();
    let edited = replace_keys(track, &selected, changed.values().copied().collect())?;
    Ok(found_again(track, edited, &changed))
}

/// An edited track, and where the keys of the old one have gone.
fn found_again<V: InParts>(
    track: &Track<V>,
    edited: Track<V>,
    changed: &BTreeMap<usize, Keyframe<V>>,
) -> Edited
where
    TrackValue: From<Track<V>>,
{
    let replaced = |time: f64| {
        let same = |key: &Keyframe<V>| (key.time_secs - time).abs() <= SAME_TIME_SECS;
        changed.values().any(same)
    };
    let place_of = |time: f64| {
        let times = edited.times_secs();
        times.binary_search_by(|at| at.total_cmp(&time)).ok()
    };
    let mut keys = BTreeMap::new();
    for (index, &time) in track.times_secs().iter().enumerate() {
        let now = match changed.get(&index) {
            Some(key) => place_of(key.time_secs),
            None if replaced(time) => None,
            None => place_of(time),
        };
        keys.extend(now.map(|now| (index, now)));
    }
    Edited {
        track: edited.into(),
        keys,
    }
}
