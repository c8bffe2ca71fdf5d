//! From quaternions to Euler curves and back.
//!
//! **Method.** Neither kind of curve can be the other exactly, but for turns about one axis. Each segment is
//! tried as a straight one and as a cubic with the slopes that the original has at its ends; where neither stays
//! within the tolerance, a key is put half way and both halves are tried again. Keys of the original stay
//! where they are, and are hit exactly. The error is measured at [`PLACES`] - 1 places between neighbouring
//! keys.
//!
//! **Guarantees.** [`Converted::greatest_error_rad`] says how far the new curve is from the old one between the
//! first and the last key: no more than the tolerance, unless keys would come closer than
//! [`ConvertConfig::least_secs`] (next to gimbal lock, and for spins of many turns a second). Beyond the keys,
//! a cycle with offset turns in the parent's space for quaternions and adds angles for Euler curves: these
//! agree for turns about one axis alone.

use glam::{DQuat, DVec3};

use super::euler::{EulerTrack, angles_near_deg, quat_of_deg};
use super::extrapolation::Extrapolation;
use super::key::{Interpolation, Keyframe, Tangents};
use super::track::Track;
use super::track_error::TrackError;
use super::value::KeyValue;
use crate::rotation::{EulerOrder, angle_between};

/// In how many parts a segment is gone along when its error is measured.
const PLACES: u32 = 24;

/// How far between two places a slope is taken from, as a share of the segment: the error is its square.
const SLOPE_SHARE: f64 = 1e-4;

/// How often a segment is halved at most.
const MOST_HALVINGS: u32 = 12;

/// How near a conversion must come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvertConfig {
    /// The greatest angle between the old and the new rotation at any time, in radians.
    pub tolerance_rad: f64,
    /// No key is added closer than this to another, in seconds, even where the tolerance is missed.
    pub least_secs: f64,
}

impl Default for ConvertConfig {
    /// A tenth of a degree, which is not seen, and a millisecond.
    fn default() -> Self {
        Self {
            tolerance_rad: 0.1_f64.to_radians(),
            least_secs: 1e-3,
        }
    }
}

/// A converted track, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Converted<T> {
    /// The track.
    pub track: T,
    /// How many keys it has more than the original.
    pub added_keys: usize,
    /// The greatest angle between the two, in radians, where it was measured.
    pub greatest_error_rad: f64,
}

/// Euler curves of a track of quaternions. The first key has the angles nearest to `near_deg`; from there on
/// they go on without jumps.
///
/// # Errors
/// [`TrackError`] when the slopes of a curve are too steep for a number.
///
/// # Panics
/// If the order cannot make every rotation ([`EulerOrder::is_complete`]).
pub fn to_euler(
    track: &Track<DQuat>,
    order: EulerOrder,
    near_deg: DVec3,
    config: &ConvertConfig,
) -> Result<Converted<EulerTrack>, TrackError> {
    let source = Source {
        times_secs: track.times_secs(),
        ways: track.keys().iter().map(|key| key.interpolation).collect(),
        beyond: [track.before(), track.after()],
    };
    euler_of_curve(&source, |time| track.sample(time), order, near_deg, config)
}

/// A track of quaternions of Euler curves. Between two keys a quaternion cannot turn further than half a turn:
/// keys are added where the curves do.
///
/// # Errors
/// [`TrackError`] when the slopes of a curve are too steep for a number.
pub fn to_quaternion(
    track: &EulerTrack,
    config: &ConvertConfig,
) -> Result<Converted<Track<DQuat>>, TrackError> {
    let angles = track.angles_deg();
    let source = Source {
        times_secs: angles.times_secs(),
        ways: angles.keys().iter().map(|key| key.interpolation).collect(),
        beyond: [angles.before(), angles.after()],
    };
    let first = track.sample(angles.start_secs());
    converted(
        &source,
        first,
        |time, _| track.sample(time),
        |value| value,
        MOST_TURN_RAD,
        config,
    )
}

/// A turn that quaternions do not make between two keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostTurn {
    /// How far they turn instead, the short way, in degrees: at most 180.
    pub short_deg: f64,
    /// How far the angle turns that turns farthest, in degrees.
    pub widest_deg: f64,
}

/// What is lost where quaternions go from some Euler angles to others, both in degrees: nothing where the short
/// way is the one that the angles go.
///
/// The angles are followed on the sphere of quaternions, where a turn over 180 degrees ends on the far side of
/// where it began. A whole turn of an angle or more is lost in any case.
pub fn lost_turn(order: EulerOrder, from_deg: DVec3, to_deg: DVec3) -> Option<LostTurn> {
    /// Half a turn ends in between; rounding puts it on either side.
    const FAR: f64 = -1e-9;
    let [from, to] = [from_deg, to_deg].map(|angles| quat_of_deg(order, angles));
    let widest_deg = (to_deg - from_deg).abs().max_element();
    (widest_deg >= 360.0 || from.dot(to) < FAR).then(|| LostTurn {
        short_deg: angle_between(from, to).to_degrees(),
        widest_deg,
    })
}

/// When a curve has keys, and how it goes on from each and beyond them.
pub(super) struct Source<'a> {
    pub(super) times_secs: &'a [f64],
    pub(super) ways: Vec<Interpolation>,
    pub(super) beyond: [Extrapolation; 2],
}

/// Euler curves of any curve of rotations with keys at some times.
pub(super) fn euler_of_curve(
    source: &Source<'_>,
    rotation: impl Fn(f64) -> DQuat,
    order: EulerOrder,
    near_deg: DVec3,
    config: &ConvertConfig,
) -> Result<Converted<EulerTrack>, TrackError> {
    assert!(order.is_complete(), "an order of three axes");
    let angles = |time, near| angles_near_deg(order, rotation(time), near);
    let first = angles(source.times_secs[0], near_deg);
    let back = |angles| quat_of_deg(order, angles);
    let found = converted(source, first, angles, back, f64::INFINITY, config)?;
    let track = EulerTrack::new(order, found.track);
    Ok(Converted {
        track: track.expect("the order is complete"),
        added_keys: found.added_keys,
        greatest_error_rad: found.greatest_error_rad,
    })
}

/// A stretch of the new curve.
#[derive(Clone, Copy)]
struct Piece<V> {
    way: Interpolation,
    from: (f64, V),
    to: (f64, V),
    /// At its start and at its end.
    slopes: [V; 2],
    error_rad: f64,
}

impl<V: KeyValue> Piece<V> {
    /// The piece by itself: what is sampled here is what the whole track will do there.
    fn track(&self) -> Result<Track<V>, TrackError> {
        let key = |(time_secs, value): (f64, V), slope: V| Keyframe {
            time_secs,
            value,
            interpolation: self.way,
            tangents: match self.way {
                Interpolation::Cubic => Tangents::Aligned(slope),
                _ => Tangents::Auto,
            },
        };
        let keys = vec![key(self.from, self.slopes[0]), key(self.to, self.slopes[1])];
        Track::new(keys, Extrapolation::Hold)
    }
}

/// How far quaternions turn from key to key at most: at half a turn the last digits would choose the way.
const MOST_TURN_RAD: f64 = 170.0 / 180.0 * core::f64::consts::PI;

/// `value_at` gives the value at a time that goes on from one near there; `rotation_of` what it stands for.
/// A piece turns by no more than `most_turn_rad` from end to end.
fn converted<V: KeyValue>(
    source: &Source<'_>,
    first: V,
    value_at: impl Fn(f64, V) -> V,
    rotation_of: impl Fn(V) -> DQuat,
    most_turn_rad: f64,
    config: &ConvertConfig,
) -> Result<Converted<Track<V>>, TrackError> {
    let mut pieces: Vec<Piece<V>> = Vec::new();
    let mut now = first;
    for (index, span) in source.times_secs.windows(2).enumerate() {
        if source.ways[index] == Interpolation::Step {
            let end = value_at(span[1], now);
            pieces.push(Piece {
                way: Interpolation::Step,
                from: (span[0], now),
                to: (span[1], end),
                slopes: [now, end],
                error_rad: 0.0,
            });
            now = end;
            continue;
        }
        // Halves wait on a stack, the earlier one on top.
        let mut waiting = vec![([span[0], span[1]], MOST_HALVINGS)];
        while let Some((span, halvings)) = waiting.pop() {
            let best = best_piece(span, now, &value_at, &rotation_of)?;
            let middle = span[0] + (span[1] - span[0]) * 0.5;
            let is_divisible = halvings > 0
                && middle > span[0]
                && middle < span[1]
                && span[1] - span[0] >= 2.0 * config.least_secs;
            let turn_rad = angle_between(rotation_of(best.from.1), rotation_of(best.to.1));
            let is_rough = best.error_rad > config.tolerance_rad || turn_rad > most_turn_rad;
            if is_rough && is_divisible {
                waiting.push(([middle, span[1]], halvings - 1));
                waiting.push(([span[0], middle], halvings - 1));
                continue;
            }
            now = best.to.1;
            pieces.push(best);
        }
    }
    let last = *source.times_secs.last().unwrap_or(&0.0);
    let last_way = source.ways.last().copied().unwrap_or_default();
    let mut keys = Vec::with_capacity(pieces.len() + 1);
    for (index, piece) in pieces.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| &pieces[before]);
        keys.push(key_between(before, Some(piece), piece.from, piece.way));
    }
    keys.push(key_between(pieces.last(), None, (last, now), last_way));
    let [before, after] = source.beyond;
    Ok(Converted {
        added_keys: keys.len() - source.times_secs.len(),
        greatest_error_rad: pieces.iter().fold(0.0, |most, it| it.error_rad.max(most)),
        track: Track::with_ends(keys, before, after)?,
    })
}

/// The key between two pieces, with their slopes where they are cubics.
fn key_between<V: KeyValue>(
    before: Option<&Piece<V>>,
    after: Option<&Piece<V>>,
    (time_secs, value): (f64, V),
    interpolation: Interpolation,
) -> Keyframe<V> {
    let is_cubic = |piece: &&Piece<V>| piece.way == Interpolation::Cubic;
    let incoming = before.filter(is_cubic).map(|piece| piece.slopes[1]);
    let outgoing = after.filter(is_cubic).map(|piece| piece.slopes[0]);
    let tangents = match (incoming, outgoing) {
        (None, None) => Tangents::Auto,
        (Some(incoming), Some(outgoing)) => Tangents::Broken { incoming, outgoing },
        (Some(only), None) | (None, Some(only)) => Tangents::Aligned(only),
    };
    Keyframe {
        time_secs,
        value,
        interpolation,
        tangents,
    }
}

/// The straight piece over a span if it is as near as the cubic one, or near to the last digits.
fn best_piece<V: KeyValue>(
    span: [f64; 2],
    from: V,
    value_at: &impl Fn(f64, V) -> V,
    rotation_of: &impl Fn(V) -> DQuat,
) -> Result<Piece<V>, TrackError> {
    /// A straight line this near is meant.
    const STRAIGHT_RAD: f64 = 1e-9;
    let secs = span[1] - span[0];
    let at = |share: f64| span[0] + secs * share;
    let mut values = vec![from];
    for place in 1..=PLACES {
        let share = f64::from(place) / f64::from(PLACES);
        let time = if place == PLACES { span[1] } else { at(share) };
        values.push(value_at(time, values[values.len() - 1]));
    }
    let to = values[values.len() - 1];
    // The slope of the parabola through three places, from the end inwards.
    let slope = |end: V, one: V, two: V| {
        let rise = V::sum(V::sum(one.scaled(4.0), two.scaled(-1.0)), end.scaled(-3.0));
        rise.scaled(0.5 / (SLOPE_SHARE * secs))
    };
    let slopes = [
        slope(
            from,
            value_at(at(SLOPE_SHARE), from),
            value_at(at(2.0 * SLOPE_SHARE), from),
        ),
        slope(
            to,
            value_at(at(1.0 - SLOPE_SHARE), to),
            value_at(at(1.0 - 2.0 * SLOPE_SHARE), to),
        )
        .scaled(-1.0),
    ];
    let measured = |way| {
        let mut piece = Piece {
            way,
            from: (span[0], from),
            to: (span[1], to),
            slopes,
            error_rad: 0.0,
        };
        let track = piece.track()?;
        for (place, value) in (0..PLACES).zip(&values).skip(1) {
            let found = track.sample(at(f64::from(place) / f64::from(PLACES)));
            let error = angle_between(rotation_of(found), rotation_of(*value));
            // NaN is as far as can be.
            piece.error_rad = if error <= piece.error_rad {
                piece.error_rad
            } else {
                error
            };
        }
        Ok(piece)
    };
    let straight: Piece<V> = measured(Interpolation::Linear)?;
    if straight.error_rad <= STRAIGHT_RAD {
        return Ok(straight);
    }
    let cubic = measured(Interpolation::Cubic)?;
    Ok(if straight.error_rad <= cubic.error_rad {
        straight
    } else {
        cubic
    })
}
