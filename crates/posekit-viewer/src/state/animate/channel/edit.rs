//! Edits of channels: a new track from an old one.
//!
//! Whatever is edited of one channel of a key leaves that key's other channels as they were, values and
//! slopes; tangents that are chosen from the neighbours follow them.

use std::collections::{BTreeMap, BTreeSet};

use posekit::keyframe::edit::{self, EditError, SAME_TIME_SECS, replace_keys};
use posekit::keyframe::{Handle, HandlePair, Keyframe, Tangents, Track};
use posekit::rotation::EulerOrder;

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
            Tangents::Handles { pair, .. } => match pair {
                HandlePair::Aligned => Self::Aligned,
                HandlePair::Broken => Self::Broken,
            },
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

impl Edited {
    /// What was done to the angles of Euler curves is Euler curves again.
    fn of_kind(mut self, before: &TrackValue) -> Self {
        if let (TrackValue::Euler(euler), TrackValue::Vector(angles)) = (before, &self.track) {
            self.track = TrackValue::Euler(euler.with_angles_deg(angles.clone()));
        }
        self
    }
}

/// A key as a graph has it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct GraphKey {
    time_secs: f64,
    parts: Parts,
    /// On both sides; `None` next to gimbal lock.
    slopes: Option<[Parts; 2]>,
    /// Factors that handles which are free in time are stretched by, in time and in value.
    stretch: (f64, Parts),
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
        key.stretch = (time, factors);
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
        if let Tangents::Handles { pair, .. } = key.tangents {
            let reach = channels
                .handle_parts(dot.key, side)
                .map_or(0.0, |[secs, _]| secs[dot.channel]);
            let to = [reach, slope * side.sign() * reach];
            key.tangents = handles_with(channels, track, (dot, side, pair), to);
            return put(track, BTreeMap::from([(dot.key, key)]))
                .map(|edited| edited.of_kind(channels.track()));
        }
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
    .map(|edited| edited.of_kind(channels.track()))
}

/// Brings a channel's handle on one side of a key to a place, seconds and value. It stays on its side of the key
/// and does not pass the neighbouring one, so that time never runs back. The handle of an aligned key on the
/// other side turns along and keeps its length in time. A handle that only rises or falls stays a third of the
/// way along, as those of quaternions always do.
///
/// # Errors
/// [`EditError::Track`] when a number is not finite.
pub fn drag_handle_to(
    channels: &Channels,
    dot: Dot,
    side: Side,
    [secs, value]: [f64; 2],
) -> Result<Edited, EditError> {
    /// The two handles of an aligned key are at least this share of their segments long: straight up there is no
    /// line for the other one to lie on.
    const LEAST_SHARE: f64 = 0.01;
    /// A handle moved by less than this share of its segment stays where it is in time.
    const SAME_SHARE: f64 = 1e-6;
    let (Some(whole), Some([reaches, _])) = (
        channels.cubic_secs(dot.key, side),
        channels.handle_parts(dot.key, side),
    ) else {
        return change(channels, &BTreeMap::new(), |_, _| {});
    };
    let rise = value - channels.at_key(dot.key)[dot.channel];
    let kind = channels.tangent_kind(dot.key);
    let least = if kind == TangentKind::Broken {
        0.0
    } else {
        LEAST_SHARE * whole
    };
    let wanted = (side.sign() * (secs - channels.times_secs()[dot.key])).clamp(least, whole);
    let stays = (wanted - reaches[dot.channel]).abs() <= SAME_SHARE * whole;
    let is_free = with_track!(channels.track(), track => {
        matches!(track.keys()[dot.key].tangents, Tangents::Handles { .. })
    });
    if !channels.are_curves() || (stays && !is_free) {
        let reach = side.sign() * reaches[dot.channel];
        return drag_handle(channels, dot, side, rise / reach);
    }
    let pair = match kind {
        TangentKind::Broken => HandlePair::Broken,
        _ => HandlePair::Aligned,
    };
    with_track!(channels.track(), track => {
        let mut key = track.keys()[dot.key];
        key.tangents = handles_with(channels, track, (dot, side, pair), [wanted, rise]);
        put(track, BTreeMap::from([(dot.key, key)]))
    })
    .map(|edited| edited.of_kind(channels.track()))
}

/// All handles of a key as they are, but for that of one channel on one side; the one of an aligned pair on the
/// other side lies on its line.
fn handles_with<V: InParts>(
    channels: &Channels,
    track: &Track<V>,
    (dot, side, pair): (Dot, Side, HandlePair),
    [secs, rise]: [f64; 2],
) -> Tangents<V> {
    let key = &track.keys()[dot.key];
    let own = match key.tangents {
        Tangents::Handles {
            incoming, outgoing, ..
        } => Some([incoming, outgoing]),
        _ => None,
    };
    let slopes = track.tangents_at(dot.key);
    let sides = Side::BOTH.map(|here| {
        let index = here.index();
        // Where no cubic segment shows it, a handle is what it was, or as long as the other one.
        let there = track.handles_at(dot.key)[index].or(own.map(|own| own[index]));
        let mut handle = there.unwrap_or_else(|| Handle {
            secs: V::in_parts(slopes[index], |_, _| secs),
            value: V::in_parts(slopes[index], |_, slope| slope * here.sign() * secs),
        });
        if here == side {
            handle.secs = V::in_parts(
                handle.secs,
                |part, was| {
                    if part == dot.channel { secs } else { was }
                },
            );
            handle.value = V::in_parts(
                handle.value,
                |part, was| {
                    if part == dot.channel { rise } else { was }
                },
            );
        } else if pair == HandlePair::Aligned && secs > 0.0 {
            let lengths = handle.secs.parts(channels.order, [0.0; 3]);
            handle.value = V::in_parts(handle.value, |part, was| {
                if part == dot.channel {
                    -rise / secs * lengths[part]
                } else {
                    was
                }
            });
        }
        handle
    });
    let [incoming, outgoing] = sides;
    Tangents::Handles {
        incoming,
        outgoing,
        pair,
    }
}

/// The two handles of a key on one line in every channel: the mean of their slopes, each as long in time as it
/// was.
fn aligned<V: InParts>(incoming: Handle<V>, outgoing: Handle<V>) -> [Handle<V>; 2] {
    /// What a handle straight up counts as, in seconds.
    const LEAST_SECS: f64 = 1e-6;
    let order = EulerOrder::XYZ;
    let parts = |value: V| value.parts(order, [0.0; 3]);
    let (secs_in, secs_out) = (parts(incoming.secs), parts(outgoing.secs));
    let (rise_in, rise_out) = (parts(incoming.value), parts(outgoing.value));
    let slopes: Parts = std::array::from_fn(|part| {
        let slope_in = -rise_in[part] / secs_in[part].max(LEAST_SECS);
        let slope_out = rise_out[part] / secs_out[part].max(LEAST_SECS);
        // One that is not there says nothing.
        match (secs_in[part] > 0.0, secs_out[part] > 0.0) {
            (true, false) => slope_in,
            (false, true) => slope_out,
            _ => 0.5 * (slope_in + slope_out),
        }
    });
    let turned = |handle: Handle<V>, sign: f64, secs: Parts| Handle {
        value: V::in_parts(handle.value, |part, _| sign * slopes[part] * secs[part]),
        ..handle
    };
    [
        turned(incoming, -1.0, secs_in),
        turned(outgoing, 1.0, secs_out),
    ]
}

/// Chooses the tangents of keys. Those set by hand begin as what they were; sides that become aligned meet
/// half way.
///
/// # Errors
/// None that a valid track can give.
pub fn set_tangents(
    value: &TrackValue,
    keys: &BTreeSet<usize>,
    kind: TangentKind,
) -> Result<Edited, EditError> {
    with_track!(value, track => change_keys(track, keys, |index, key| {
        let [incoming, outgoing] = track.tangents_at(index);
        key.tangents = match kind {
            TangentKind::Auto => Tangents::Auto,
            TangentKind::Smooth => Tangents::Smooth,
            TangentKind::Flat => Tangents::Flat,
            TangentKind::Aligned => match key.tangents {
                Tangents::Handles {
                    incoming, outgoing, ..
                } => {
                    let [incoming, outgoing] = aligned(incoming, outgoing);
                    Tangents::Handles {
                        incoming,
                        outgoing,
                        pair: HandlePair::Aligned,
                    }
                }
                _ => Tangents::Aligned(incoming.mean(outgoing)),
            },
            TangentKind::Broken => match key.tangents {
                Tangents::Handles {
                    incoming, outgoing, ..
                } => Tangents::Handles {
                    incoming,
                    outgoing,
                    pair: HandlePair::Broken,
                },
                _ => Tangents::Broken { incoming, outgoing },
            },
        };
    }))
    .map(|edited| edited.of_kind(value))
}

/// Puts a key onto the curve, which moves as little as can be.
///
/// # Errors
/// [`EditError::Track`] when the time is not finite.
pub fn insert_on_curve(value: &TrackValue, time_secs: f64) -> Result<Edited, EditError> {
    let edited: Result<Edited, EditError> = with_track!(value, track => {
        let with_key = edit::insert_on_curve(track, time_secs)?;
        Ok(found_again(track, with_key, &BTreeMap::new()))
    });
    edited.map(|edited| edited.of_kind(value))
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
                stretch: (1.0, [1.0; 3]),
            };
            let mut after = before;
            change(chosen, &mut after);
            changed.insert(index, key_of(channels, track, index, &before, &after));
        }
        put(track, changed)
    })
    .map(|edited: Edited| edited.of_kind(channels.track()))
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
            Tangents::Handles {
                incoming,
                outgoing,
                pair,
            } => {
                let (time, values) = after.stretch;
                let stretched = |handle: Handle<V>| Handle {
                    secs: V::in_parts(handle.secs, |_, secs| secs * time),
                    value: V::in_parts(handle.value, |part, rise| rise * values[part]),
                };
                Tangents::Handles {
                    incoming: stretched(incoming),
                    outgoing: stretched(outgoing),
                    pair,
                }
            }
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
