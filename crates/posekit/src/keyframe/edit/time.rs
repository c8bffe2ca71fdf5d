//! Keys of one track: put in, moved, scaled, copied, pasted, taken out.

use crate::keyframe::key::{Interpolation, Keyframe, Tangents};
use crate::keyframe::track::Track;
use crate::keyframe::track_error::TrackError;
use crate::keyframe::value::KeyValue;

/// Keys this close to each other are at one time: a tenth of a millisecond, far less than a frame of
/// any camera.
pub const SAME_TIME_SECS: f64 = 1e-4;

/// Why an edit was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The keys that the edit makes are no track.
    #[error(transparent)]
    Track(#[from] TrackError),
    /// Keys can be spread or squeezed, not turned round or put on top of each other.
    #[error("keys are scaled by a finite factor greater than 0, not {factor}")]
    BadFactor {
        /// The factor.
        factor: f64,
    },
}

/// The track with a key put in, in place of one at its time.
///
/// # Errors
/// [`EditError::Track`] when the key's numbers are no key's.
pub fn insert_key<V: KeyValue>(track: &Track<V>, key: Keyframe<V>) -> Result<Track<V>, EditError> {
    merged(track, track.keys().to_vec(), vec![key])
}

/// A key on the curve at a time: its value there, and on cubic segments its slope, so that putting it
/// in changes a curve of numbers or vectors with tangents set by hand nowhere, and other curves little.
pub fn key_on_curve<V: KeyValue>(track: &Track<V>, time_secs: f64) -> Keyframe<V> {
    /// Half the span of the difference quotient: the square root of what an `f64` resolves, about.
    const STEP_SECS: f64 = 1e-6;
    let value = track.sample(time_secs);
    let interpolation = match track.key_before(time_secs) {
        Some(index) => track.keys()[index].interpolation,
        None => track.keys()[0].interpolation,
    };
    let tangents = if interpolation == Interpolation::Cubic {
        let [before, after] = [-STEP_SECS, STEP_SECS].map(|step| track.sample(time_secs + step));
        Tangents::Aligned(value.tangent(V::velocity(before, after, 2.0 * STEP_SECS)))
    } else {
        Tangents::Auto
    };
    Keyframe {
        time_secs,
        value,
        interpolation,
        tangents,
    }
}

/// The track with a key put onto its curve, which moves as little as can be ([`key_on_curve`]): where handles
/// are free in time, and on curves of numbers and vectors with slopes set by hand, not at all. The exception:
/// where the two handles of a segment reach past each other in time, one of the parts may need a handle that
/// reaches past its neighbour, which is shortened, and the curve moves a little.
///
/// # Errors
/// [`EditError::Track`] when the time is not finite.
pub fn insert_on_curve<V: KeyValue>(
    track: &Track<V>,
    time_secs: f64,
) -> Result<Track<V>, EditError> {
    let is_there = |at: &f64| (at - time_secs).abs() <= SAME_TIME_SECS;
    if !track.times_secs().iter().any(is_there)
        && let Some((start, keys)) = track.cut_at(time_secs)
    {
        return replace_keys(track, &[start, start + 1], keys.to_vec());
    }
    insert_key(track, key_on_curve(track, time_secs))
}

/// The track with the selected keys moved in time. A key that they land on is replaced; they may pass
/// others.
///
/// # Errors
/// [`EditError::Track`] when a time is not finite any more.
pub fn move_keys<V: KeyValue>(
    track: &Track<V>,
    selected: &[usize],
    by_secs: f64,
) -> Result<Track<V>, EditError> {
    let (mut chosen, kept) = divided(track, selected);
    for key in &mut chosen {
        key.time_secs += by_secs;
    }
    merged(track, kept, chosen)
}

/// The track with the times of the selected keys scaled about a pivot. Slopes set by hand are scaled
/// with them, so that the curve between the keys keeps its shape.
///
/// # Errors
/// [`EditError::BadFactor`] when the factor is not finite and positive; [`EditError::Track`] as
/// [`move_keys`].
pub fn scale_keys<V: KeyValue>(
    track: &Track<V>,
    selected: &[usize],
    pivot_secs: f64,
    factor: f64,
) -> Result<Track<V>, EditError> {
    if !(factor.is_finite() && factor > 0.0) {
        return Err(EditError::BadFactor { factor });
    }
    let (mut chosen, kept) = divided(track, selected);
    for key in &mut chosen {
        key.time_secs = pivot_secs + (key.time_secs - pivot_secs) * factor;
        key.tangents = match key.tangents {
            Tangents::Handles {
                mut incoming,
                mut outgoing,
                pair,
            } => {
                for handle in [&mut incoming, &mut outgoing] {
                    handle.secs = handle.secs.scaled(factor);
                }
                Tangents::Handles {
                    incoming,
                    outgoing,
                    pair,
                }
            }
            tangents => with_tangents(tangents, |tangent| tangent.scaled(1.0 / factor)),
        };
    }
    merged(track, kept, chosen)
}

/// The track with the selected keys taken out and others put in, in any order. One that lands on a key
/// that stays replaces it: what an edit of many keys at once is made of.
///
/// # Errors
/// [`EditError::Track`] when a key's numbers are no key's, or two of those put in are at one time.
pub fn replace_keys<V: KeyValue>(
    track: &Track<V>,
    selected: &[usize],
    put: Vec<Keyframe<V>>,
) -> Result<Track<V>, EditError> {
    let (_, kept) = divided(track, selected);
    merged(track, kept, put)
}

/// The track without the selected keys; `None` when none is left.
pub fn delete_keys<V: KeyValue>(track: &Track<V>, selected: &[usize]) -> Option<Track<V>> {
    let (_, kept) = divided(track, selected);
    Track::with_ends(kept, track.before(), track.after()).ok()
}

/// The selected keys, their times counted from `origin_secs`.
pub fn copy_keys<V: KeyValue>(
    track: &Track<V>,
    selected: &[usize],
    origin_secs: f64,
) -> Vec<Keyframe<V>> {
    let (mut chosen, _) = divided(track, selected);
    for key in &mut chosen {
        key.time_secs -= origin_secs;
    }
    chosen
}

/// What values pasted keys have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PasteValues {
    /// Those that were copied.
    #[default]
    AsCopied,
    /// Moved so that the first of them lies on the curve that it is pasted into: a step is copied, not
    /// a place. Orientations are turned in the parent's space.
    OntoCurve,
}

/// The track with copied keys put in at a time, in place of those between the first and the last of
/// them. Without copied keys it is the same track.
///
/// # Errors
/// [`EditError::Track`] when the keys are not in rising order of time, or hold numbers that no key has.
pub fn paste_keys<V: KeyValue>(
    track: &Track<V>,
    copied: &[Keyframe<V>],
    at_secs: f64,
    values: PasteValues,
) -> Result<Track<V>, EditError> {
    let [Some(first), Some(last)] = [copied.first(), copied.last()] else {
        return Ok(track.clone());
    };
    let mut pasted = copied.to_vec();
    for key in &mut pasted {
        key.time_secs += at_secs;
    }
    if values == PasteValues::OntoCurve {
        let there = track.sample(at_secs + first.time_secs);
        let from = first.value.normalized();
        for key in &mut pasted {
            // A shift by the way from `from` to `there`; a slope turns with its value.
            key.tangents = with_tangents(key.tangents, |slope| slope.slope_shifted(from, there));
            key.value = key.value.shifted(from, there, 1.0);
        }
    }
    let [start, end] = [first, last].map(|key| key.time_secs + at_secs);
    let outside = |key: &Keyframe<V>| {
        key.time_secs < start - SAME_TIME_SECS || key.time_secs > end + SAME_TIME_SECS
    };
    let kept = track.keys().iter().copied().filter(outside).collect();
    merged(track, kept, pasted)
}

/// Slopes changed. Handles stay: numbers and vectors, which alone have them, keep their slopes when they are
/// moved.
fn with_tangents<V>(tangents: Tangents<V>, change: impl Fn(V) -> V) -> Tangents<V> {
    match tangents {
        Tangents::Aligned(tangent) => Tangents::Aligned(change(tangent)),
        Tangents::Broken { incoming, outgoing } => Tangents::Broken {
            incoming: change(incoming),
            outgoing: change(outgoing),
        },
        by_neighbours => by_neighbours,
    }
}

/// The selected keys and the others, both in order.
fn divided<V: KeyValue>(
    track: &Track<V>,
    selected: &[usize],
) -> (Vec<Keyframe<V>>, Vec<Keyframe<V>>) {
    let numbered = track.keys().iter().copied().enumerate();
    let (chosen, kept): (Vec<_>, Vec<_>) =
        numbered.partition(|(index, _)| selected.contains(index));
    let plain = |keys: Vec<(usize, Keyframe<V>)>| keys.into_iter().map(|(_, key)| key).collect();
    (plain(chosen), plain(kept))
}

/// The track of `kept` and `put` keys, where a put one replaces a kept one at its time.
fn merged<V: KeyValue>(
    track: &Track<V>,
    mut kept: Vec<Keyframe<V>>,
    put: Vec<Keyframe<V>>,
) -> Result<Track<V>, EditError> {
    kept.retain(|key| {
        put.iter()
            .all(|other| (key.time_secs - other.time_secs).abs() > SAME_TIME_SECS)
    });
    kept.extend(put);
    kept.sort_by(|a, b| a.time_secs.total_cmp(&b.time_secs));
    Ok(Track::with_ends(kept, track.before(), track.after())?)
}

/// The tangents of a key whose value is replaced: those from neighbours stay so; slopes set by hand
/// stay what they are, turned with an orientation.
pub(super) fn carried_tangents<V: KeyValue>(replaced: &Keyframe<V>, value: V) -> Tangents<V> {
    let from = replaced.value.normalized();
    with_tangents(replaced.tangents, |slope| slope.slope_shifted(from, value))
}
