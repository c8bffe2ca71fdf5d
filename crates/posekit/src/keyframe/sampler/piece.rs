//! Curves as pieces of one kind: cubic polynomials in four components, in `f32`.

use glam::{DQuat, DVec3, DVec4, Vec4};

use crate::keyframe::key::Interpolation;
use crate::keyframe::track::{Segment, Track};
use crate::keyframe::value::{KeyValue, hermite_weights};

/// How far a piece may be from the curve on the sphere that it stands for: about what `f32` resolves.
const TOLERANCE_RAD: f64 = 3e-7;

/// The most pieces that a segment is cut into; a turn of 180 degrees needs 8, a squad through
/// very uneven keys the most.
const MOST_PIECES: u32 = 512;

/// `c0 + c1 t + c2 t^2 + c3 t^3`, `t` the seconds since its start times `per_sec`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    coefficients: [Vec4; 4],
    /// When it starts, in seconds.
    pub(super) start_secs: f64,
    per_sec: f32,
}

impl Piece {
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "poses are f32")]
    pub(super) fn at(&self, time_secs: f64) -> Vec4 {
        let [c0, c1, c2, c3] = self.coefficients;
        let t = Vec4::splat((time_secs - self.start_secs) as f32 * self.per_sec);
        c0 + t * (c1 + t * (c2 + t * c3))
    }

    pub(super) fn constant(start_secs: f64, value: DVec4) -> Self {
        Self {
            start_secs,
            coefficients: [value.as_vec4(), Vec4::ZERO, Vec4::ZERO, Vec4::ZERO],
            per_sec: 0.0,
        }
    }

    #[allow(clippy::cast_possible_truncation, reason = "poses are f32")]
    fn hermite(start_secs: f64, ends: [DVec4; 4], secs: f64) -> Self {
        let [from, from_slope, to, to_slope] = ends;
        let way = to - from;
        Self {
            start_secs,
            coefficients: [
                from,
                from_slope,
                way * 3.0 - from_slope * 2.0 - to_slope,
                from_slope + to_slope - way * 2.0,
            ]
            .map(|c| c.as_vec4()),
            per_sec: (1.0 / secs) as f32,
        }
    }
}

/// Values that pieces are made for.
pub(super) trait Compiled: KeyValue {
    /// Whether straight ways and squads are curves in the components, which cubics only come near.
    const IS_CURVED: bool;

    /// Its components, those that it lacks zero.
    fn components(self) -> DVec4;
}

impl Compiled for DVec3 {
    const IS_CURVED: bool = false;

    fn components(self) -> DVec4 {
        self.extend(0.0)
    }
}

impl Compiled for DQuat {
    const IS_CURVED: bool = true;

    fn components(self) -> DVec4 {
        self.into()
    }
}

/// The pieces of a track in rising order of time; the last one starts at the last key and keeps its value.
pub(super) fn pieces<V: Compiled>(track: &Track<V>) -> Vec<Piece> {
    let times = track.times_secs();
    let mut all = Vec::with_capacity(times.len());
    for (start, &time) in times[..times.len() - 1].iter().enumerate() {
        add_segment(&mut all, time, &track.segment(start));
    }
    all.push(Piece::constant(
        track.end_secs(),
        track.ends()[1].components(),
    ));
    all
}

fn add_segment<V: Compiled>(all: &mut Vec<Piece>, start_secs: f64, segment: &Segment<V>) {
    let Segment { from, to, secs, .. } = *segment;
    let [value, end] = [from.value, to.value].map(V::components);
    let cubic = [
        value,
        from.outgoing.components(),
        end,
        to.incoming.components(),
    ];
    match segment.interpolation {
        Interpolation::Step => all.push(Piece::constant(start_secs, value)),
        Interpolation::Cubic => add_tamed(all, start_secs, cubic, secs),
        Interpolation::Squad if !V::IS_CURVED => add_tamed(all, start_secs, cubic, secs),
        Interpolation::Linear if !V::IS_CURVED => {
            let straight = [value, end - value, end, end - value];
            all.push(Piece::hermite(start_secs, straight, secs));
        }
        Interpolation::Linear | Interpolation::Squad => {
            let curve = |t| segment.at(t).components();
            for (t, step, ends) in cut(&curve) {
                all.push(Piece::hermite(start_secs + t * secs, ends, secs * step));
            }
        }
    }
}

fn add_tamed(all: &mut Vec<Piece>, start_secs: f64, cubic: [DVec4; 4], secs: f64) {
    for (t, step, ends) in tamed(cubic) {
        all.push(Piece::hermite(start_secs + t * secs, ends, secs * step));
    }
}

/// A cubic in pieces, with where each starts and how long it is: one, unless its slopes are so steep that
/// large terms cancel each other in `f32`.
fn tamed(cubic: [DVec4; 4]) -> Vec<(f64, f64, [DVec4; 4])> {
    /// Slopes up to here cost a bit or two of the value's digits.
    const STEEP: f64 = 2.0;
    let size = cubic[0].length().max(cubic[2].length());
    let steepest = cubic[1].length().max(cubic[3].length());
    let mut count = 1;
    while count < MOST_PIECES && steepest > STEEP * size * f64::from(count) {
        count *= 2;
    }
    let step = 1.0 / f64::from(count);
    let slope_at = |t: f64| {
        let [from, from_slope, to, to_slope] = cubic;
        let s = 1.0 - t;
        (to - from) * (6.0 * t * s)
            + from_slope * (s * (s - 2.0 * t))
            + to_slope * (t * (t - 2.0 * s))
    };
    let part = |t: f64| {
        let [start, end] = [t, t + step];
        let [from, to] = [start, end].map(|t| hermite_at(cubic, t));
        let [from_slope, to_slope] = [start, end].map(|t| slope_at(t) * step);
        (t, step, [from, from_slope, to, to_slope])
    };
    (0..count)
        .map(|piece| part(f64::from(piece) * step))
        .collect()
}

/// A curve over 0 to 1 as cubics, with where each starts and how long it is: as few equal ones as come
/// near enough.
fn cut(curve: &impl Fn(f64) -> DVec4) -> Vec<(f64, f64, [DVec4; 4])> {
    let mut count = 1;
    loop {
        let step = 1.0 / f64::from(count);
        let starts = (0..count).map(|piece| f64::from(piece) * step);
        let cubics: Vec<_> = starts
            .map(|t| (t, step, hermite_ends(curve, t, step)))
            .collect();
        let is_near = |&(t, step, ends): &(f64, f64, [DVec4; 4])| {
            [0.2, 0.35, 0.5, 0.65, 0.8].iter().all(|&share| {
                let found = hermite_at(ends, share).normalize_or_zero();
                2.0 * (found - curve(t + share * step)).length() <= TOLERANCE_RAD
            })
        };
        if count >= MOST_PIECES || cubics.iter().all(is_near) {
            return cubics;
        }
        count *= 2;
    }
}

/// Values and derivatives at the ends of a part of a curve, per unit of that part.
fn hermite_ends(curve: &impl Fn(f64) -> DVec4, start: f64, step: f64) -> [DVec4; 4] {
    /// Half the span of the difference quotient: its error is the square of it, rounding a
    /// ten-thousandth of a millionth over it.
    const NEAR: f64 = 1e-5;
    let end = start + step;
    let slope = |t: f64| (curve(t + NEAR) - curve(t - NEAR)) * (step / (2.0 * NEAR));
    [curve(start), slope(start), curve(end), slope(end)]
}

fn hermite_at([from, from_slope, to, to_slope]: [DVec4; 4], t: f64) -> DVec4 {
    let [a, b, c, d] = hermite_weights(t);
    from * a + from_slope * b + to * c + to_slope * d
}
