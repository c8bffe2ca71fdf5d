//! What a dope sheet does to selected keys: in time, and in how they go on.

use std::collections::{BTreeMap, BTreeSet};

use posekit::keyframe::edit::{
    SAME_TIME_SECS, delete_keys, insert_key, key_on_curve, move_keys, scale_keys,
};
use posekit::keyframe::{Extrapolation, Interpolation, KeyValue, Keyframe, Track};

use super::super::{Authored, KeyId, Lane, LaneTrack, LaneValue, TrackValue};
use super::Edit;

/// Does the same with a track of any kind; the outcome is an option of a track of that kind.
macro_rules! with_track {
    ($value:expr, $track:ident => $does:expr) => {
        match $value {
            LaneTrack::Number($track) => $does.map(TrackValue::Number),
            LaneTrack::Vector($track) => $does.map(TrackValue::Vector),
            LaneTrack::Orientation($track) => $does.map(TrackValue::Orientation),
            LaneTrack::Euler(euler) => {
                let $track = euler.angles_deg();
                $does.map(|angles| TrackValue::Euler(euler.with_angles_deg(angles)))
            }
        }
    };
}

/// Selected keys by their lanes: the places among the keys of each, in rising order.
#[must_use]
pub fn by_lane(selection: &BTreeSet<KeyId>) -> BTreeMap<Lane, Vec<usize>> {
    let mut lanes: BTreeMap<Lane, Vec<usize>> = BTreeMap::new();
    for key in selection {
        lanes.entry(key.lane).or_default().push(key.index);
    }
    lanes
}

/// The keys of a track that are at certain times.
pub(super) fn keys_at(lane: Lane, track: &LaneTrack<'_>, times: &[f64]) -> Vec<KeyId> {
    let is_one = |at: &f64| times.iter().any(|time| (at - time).abs() <= SAME_TIME_SECS);
    let numbered = track.times_secs().iter().enumerate();
    numbered
        .filter(|(_, at)| is_one(at))
        .map(|(index, _)| KeyId { lane, index })
        .collect()
}

/// The times of some of a track's keys.
fn times_of(track: &LaneTrack<'_>, indices: &[usize]) -> Vec<f64> {
    let times = track.times_secs();
    let of = |index: &usize| times.get(*index).copied();
    indices.iter().filter_map(of).collect()
}

/// Changes the tracks of selected keys one by one; `new_time` says where a selected key is afterwards.
fn edited(
    authored: &Authored,
    selection: &BTreeSet<KeyId>,
    change: impl Fn(LaneTrack<'_>, &[usize]) -> Option<TrackValue>,
    new_time: impl Fn(f64) -> f64,
) -> Option<Edit> {
    let mut edit = Edit::default();
    for (lane, indices) in by_lane(selection) {
        let Some(track) = authored.track(lane) else {
            continue;
        };
        let value = change(track, &indices)?;
        let times: Vec<f64> = times_of(&track, &indices)
            .into_iter()
            .map(&new_time)
            .collect();
        edit.selection
            .extend(keys_at(lane, &value.as_track(), &times));
        edit.changes.push((lane, Some(value)));
    }
    Some(edit)
}

/// The keys moved in time. Keys that they land on are replaced. `None` when a time is not finite.
#[must_use]
pub fn moved(authored: &Authored, selection: &BTreeSet<KeyId>, by_secs: f64) -> Option<Edit> {
    edited(
        authored,
        selection,
        |track, indices| with_track!(track, t => move_keys(t, indices, by_secs).ok()),
        |time| time + by_secs,
    )
}

/// The times of the keys scaled about a time. With `snaps` each lands on the nearest frame. `None` when
/// the factor is not a positive number.
#[must_use]
pub fn scaled(
    authored: &Authored,
    selection: &BTreeSet<KeyId>,
    (pivot_secs, factor): (f64, f64),
    snaps: bool,
) -> Option<Edit> {
    let place = |time: f64| {
        let there = pivot_secs + (time - pivot_secs) * factor;
        if snaps {
            authored.snapped(there)
        } else {
            there
        }
    };
    edited(
        authored,
        selection,
        |track, indices| {
            let times = times_of(&track, indices);
            with_track!(track, t => {
                scale_keys(t, indices, pivot_secs, factor).ok().and_then(|scaled| {
                    let exact: Vec<f64> = times
                        .iter()
                        .map(|time| pivot_secs + (time - pivot_secs) * factor)
                        .collect();
                    if snaps { retimed(&scaled, &exact, |at| authored.snapped(at)) } else { Some(scaled) }
                })
            })
        },
        place,
    )
}

/// The track with the keys at some times put at others; a later one replaces an earlier one there.
fn retimed<V: KeyValue>(
    track: &Track<V>,
    times: &[f64],
    place: impl Fn(f64) -> f64,
) -> Option<Track<V>> {
    let is_one = |at: f64| times.iter().any(|time| (at - time).abs() <= SAME_TIME_SECS);
    let (chosen, kept): (Vec<Keyframe<V>>, Vec<Keyframe<V>>) = track
        .keys()
        .iter()
        .copied()
        .partition(|key| is_one(key.time_secs));
    let placed = chosen.into_iter().map(|key| Keyframe {
        time_secs: place(key.time_secs),
        ..key
    });
    with_keys(track, kept, placed)
}

/// The track of `kept` and `put` keys, where one that is put later replaces what is at its time.
fn with_keys<V: KeyValue>(
    track: &Track<V>,
    mut kept: Vec<Keyframe<V>>,
    put: impl IntoIterator<Item = Keyframe<V>>,
) -> Option<Track<V>> {
    for key in put {
        kept.retain(|other| (other.time_secs - key.time_secs).abs() > SAME_TIME_SECS);
        kept.push(key);
    }
    kept.sort_by(|a, b| a.time_secs.total_cmp(&b.time_secs));
    Track::with_ends(kept, track.before(), track.after()).ok()
}

/// Copies of the keys, moved in time; the keys themselves stay. The copies are selected.
#[must_use]
pub fn duplicated(authored: &Authored, selection: &BTreeSet<KeyId>, by_secs: f64) -> Option<Edit> {
    edited(
        authored,
        selection,
        |track, indices| {
            with_track!(track, t => {
                let copies = indices.iter().filter_map(|&index| t.keys().get(index)).map(|key| Keyframe {
                    time_secs: key.time_secs + by_secs,
                    ..*key
                });
                let copies: Vec<_> = copies.collect();
                with_keys(t, t.keys().to_vec(), copies)
            })
        },
        |time| time + by_secs,
    )
}

/// The keys taken out. A property without keys is no longer keyed.
#[must_use]
pub fn deleted(authored: &Authored, selection: &BTreeSet<KeyId>) -> Edit {
    let change = |(lane, indices): (Lane, Vec<usize>)| {
        let track = authored.track(lane)?;
        let left = with_track!(track, t => delete_keys(t, &indices));
        Some((lane, left))
    };
    Edit {
        changes: by_lane(selection).into_iter().filter_map(change).collect(),
        selection: BTreeSet::new(),
    }
}

/// The keys going on in another way.
#[must_use]
pub fn interpolated(
    authored: &Authored,
    selection: &BTreeSet<KeyId>,
    way: Interpolation,
) -> Option<Edit> {
    edited(
        authored,
        selection,
        |track, indices| {
            with_track!(track, t => {
                let mut keys = t.keys().to_vec();
                for &index in indices {
                    if let Some(key) = keys.get_mut(index) {
                        key.interpolation = way;
                    }
                }
                Track::with_ends(keys, t.before(), t.after()).ok()
            })
        },
        |time| time,
    )
}

/// Lanes going on in another way before their first key, after their last, or both. Keys stay
/// selected.
#[must_use]
pub fn extrapolated(
    authored: &Authored,
    lanes: &BTreeSet<Lane>,
    [before, after]: [Option<Extrapolation>; 2],
) -> Edit {
    let change = |lane: &Lane| {
        let track = authored.track(*lane)?;
        let changed = with_track!(track, t => Track::with_ends(
            t.keys().to_vec(),
            before.unwrap_or(t.before()),
            after.unwrap_or(t.after()),
        ).ok())?;
        Some((*lane, Some(changed)))
    };
    Edit {
        changes: lanes.iter().filter_map(change).collect(),
        selection: authored.selection().clone(),
    }
}

/// A key of what a lane is at a time: on its curve, or its first.
#[must_use]
pub fn added(
    authored: &Authored,
    lanes: &[Lane],
    time_secs: f64,
    interpolation: Interpolation,
) -> Option<Edit> {
    let mut edit = Edit::default();
    for &lane in lanes {
        let value = match authored.track(lane) {
            Some(track) => with_track!(track, t => insert_key(t, key_on_curve(t, time_secs)).ok())?,
            None => first_key(
                authored.value_at(lane, time_secs)?,
                time_secs,
                interpolation,
            )?,
        };
        edit.selection
            .extend(keys_at(lane, &value.as_track(), &[time_secs]));
        edit.changes.push((lane, Some(value)));
    }
    Some(edit)
}

fn first_key(value: LaneValue, time_secs: f64, way: Interpolation) -> Option<TrackValue> {
    fn track<V: KeyValue>(time_secs: f64, value: V, way: Interpolation) -> Option<Track<V>> {
        let key = Keyframe::new(time_secs, value, way);
        Track::new(vec![key], Extrapolation::Hold).ok()
    }
    match value {
        LaneValue::Number(value) => track(time_secs, value, way).map(TrackValue::Number),
        LaneValue::Vector(value) => track(time_secs, value, way).map(TrackValue::Vector),
        LaneValue::Orientation(value) => {
            track(time_secs, value.normalize(), way).map(TrackValue::Orientation)
        }
    }
}
