//! What a key can hold: a number, a vector or an orientation, and the arithmetic of each between two
//! keys.
//!
//! **Method.** Cubic segments are Hermite polynomials; for orientations they run in the four
//! components of the quaternion and are normalised, which is the definition of `CUBICSPLINE` in glTF
//! 2.0 (Khronos 2017, appendix C). Squad is Shoemake's (1987, "Quaternion calculus and fast
//! animation", SIGGRAPH course notes 10), its inner points chosen from the angular velocity at the key
//! so that the velocity is continuous where keys are not evenly spaced, too. For numbers and vectors
//! the same construction is the cubic of Catmull and Rom (1974).

use glam::{DQuat, DVec3};

use crate::range::LONGEST_LENGTH;
use crate::rotation::{exp, log, slerp};

/// How far from 1 the length of a key's quaternion may be: that of four decimals, written by hand.
const UNIT_TOLERANCE: f64 = 1e-3;

/// How much steeper than the flatter neighbour an automatic tangent may be. A cubic whose end slopes
/// are within three times its chord's does not leave the range of its ends (Fritsch and Carlson 1980,
/// "Monotone Piecewise Cubic Interpolation", doi:10.1137/0717021).
const STEEPEST: f64 = 3.0;

/// The most that a squad's velocity at a key may turn over the longer of its two segments. Evenly spaced
/// keys never ask for more; next to a short segment a long one would, and its inner point would lie more
/// than half a turn away, where there is no telling which way to it is meant.
const MOST_SQUAD_TURN_RAD: f64 = std::f64::consts::PI;

/// What a key can hold: `f64`, [`DVec3`] or [`DQuat`], the last an orientation.
pub trait KeyValue: Value {}

impl KeyValue for f64 {}
impl KeyValue for DVec3 {}
impl KeyValue for DQuat {}

/// How long a handle counts as at least when its slope is asked for, in seconds: straight up it has none.
pub(crate) const LEAST_HANDLE_SECS: f64 = 1e-6;

/// What is wrong with a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ValueFault {
    /// A component is larger than [`LONGEST_LENGTH`], or not a number.
    OutOfRange,
    /// The quaternion is not of unit length.
    NotUnit(f64),
}

/// The two velocities that meet at a key and the seconds that each lasts.
#[derive(Clone, Copy, Debug)]
pub struct Meeting<T> {
    /// Velocity of the straight way from the key before.
    pub before: T,
    /// Seconds since the key before.
    pub secs_before: f64,
    /// Velocity of the straight way to the key after.
    pub after: T,
    /// Seconds until the key after.
    pub secs_after: f64,
}

/// The arithmetic between keys. Not part of the public face: the trait cannot be named outside.
pub trait Value: Copy + PartialEq + std::fmt::Debug + Send + Sync + 'static {
    /// A change per second; of an orientation the angular velocity in body coordinates.
    type Velocity: Copy + Default + PartialEq + std::fmt::Debug;

    /// What is wrong with it as a key's value, if anything.
    fn fault(self) -> Option<ValueFault>;

    /// Whether no component is larger than this, whatever its sign; NaN is.
    fn is_within(self, most: f64) -> bool;

    /// As it is used: an orientation at unit length.
    fn normalized(self) -> Self;

    /// Whether the sign must change for the short way from `previous`.
    fn is_far_side(self, previous: Self) -> bool;

    /// Times a number.
    fn scaled(self, factor: f64) -> Self;

    /// Component by component.
    fn sum(self, other: Self) -> Self;

    /// The constant velocity of the straight way.
    fn velocity(from: Self, to: Self, secs: f64) -> Self::Velocity;

    /// The velocity at a key on a parabola through its neighbours (Catmull and Rom for evenly spaced
    /// keys).
    fn smooth_velocity(meeting: Meeting<Self::Velocity>) -> Self::Velocity;

    /// The same, made flat at extrema and no steeper than keeps the curve within its keys.
    fn clamped_velocity(meeting: Meeting<Self::Velocity>) -> Self::Velocity;

    /// The derivative at a value that has a velocity.
    fn tangent(self, velocity: Self::Velocity) -> Self;

    /// The straight way at an even pace.
    fn straight(from: Self, to: Self, t: f64) -> Self;

    /// The cubic with the given derivatives over the whole way (per unit of `t`).
    fn hermite(from: Self, from_slope: Self, to: Self, to_slope: Self, t: f64) -> Self;

    /// Whether its segments may be Bezier curves in time and value, component by component.
    const HAS_HANDLES: bool;

    /// Whether no component is below zero.
    fn is_no_less_than_zero(self) -> bool;

    /// A handle shortened along its direction to at most `most_secs`: its time as a share of that, and its
    /// value.
    fn within(secs: Self, value: Self, most_secs: f64) -> (Self, Self);

    /// The slope of a handle.
    fn slope_of_handle(secs: Self, value: Self) -> Self;

    /// The Bezier curve whose handles lie `reaches` of the way in time from either end, at a share of that
    /// time. The slopes are three times the handles' values.
    fn bezier(ends: [Self; 2], slopes: [Self; 2], reaches: [Self; 2], t: f64) -> Self;

    /// A reach of a third, in every component.
    fn third() -> Self;

    /// A Bezier curve cut in two at a share of its time: its value there, and the four handles of both parts in
    /// the order of time, as shares of the whole time and values seen from their keys.
    fn cut_bezier(
        ends: [Self; 2],
        slopes: [Self; 2],
        reaches: [Self; 2],
        t: f64,
    ) -> (Self, [(Self, Self); 4]);

    /// [`smooth_velocity`](Self::smooth_velocity), kept within what a squad can do.
    fn squad_velocity(meeting: Meeting<Self::Velocity>) -> Self::Velocity {
        Self::smooth_velocity(meeting)
    }

    /// What [`squad`](Self::squad) wants at both ends, given the change at each end over the way.
    fn squad_controls(from: Self, to: Self, changes: [Self::Velocity; 2], secs: f64) -> [Self; 2];

    /// The quadrangle's curve.
    fn squad(from: Self, from_control: Self, to: Self, to_control: Self, t: f64) -> Self;

    /// Moved by so many times the way from `first` to `last`.
    fn shifted(self, first: Self, last: Self, times: f64) -> Self;

    /// A derivative of a value, after that value was moved by the way from `first` to `last`.
    fn slope_shifted(self, first: Self, last: Self) -> Self;
}

/// The weights of a cubic Hermite segment: start value, start slope, end value, end slope.
pub(crate) fn hermite_weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [
        s * s * (1.0 + 2.0 * t),
        t * s * s,
        t * t * (1.0 + 2.0 * s),
        -t * t * s,
    ]
}

/// Where along a Bezier curve a time is: the parameter at which the cubic with the times 0, `from`,
/// 1 - `to` and 1 has the value `time`, all in [0, 1]; then it rises throughout, and there is one.
///
/// Newton's steps, halving where one leaves the bracket: to the last digits.
pub(crate) fn bezier_parameter(from: f64, to: f64, time: f64) -> f64 {
    /// Halving alone reaches the last digit of an `f64` in as many steps.
    const MOST_STEPS: usize = 64;
    // Handles a third of the way along: time is the parameter.
    let third = 1.0 / 3.0;
    if !(0.0..1.0).contains(&time) || (from == third && to == third) {
        return time.clamp(0.0, 1.0);
    }
    let end = 1.0 - to;
    let [mut low, mut high] = [0.0, 1.0];
    let mut at = time;
    for _ in 0..MOST_STEPS {
        let s = 1.0 - at;
        let off = 3.0 * at * s * (s * from + at * end) + at * at * at - time;
        if off == 0.0 {
            return at;
        }
        if off > 0.0 {
            high = at;
        } else {
            low = at;
        }
        let slope = 3.0 * (s * s * from + 2.0 * s * at * (end - from) + at * at * (1.0 - end));
        let newton = at - off / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            low + (high - low) * 0.5
        };
        if next == at {
            return at;
        }
        at = next;
    }
    at
}

/// What numbers and vectors have in common: sums and multiples.
macro_rules! linear_ways {
    () => {
        fn tangent(self, velocity: Self) -> Self {
            velocity
        }

        fn straight(from: Self, to: Self, t: f64) -> Self {
            from * (1.0 - t) + to * t
        }

        fn hermite(from: Self, from_slope: Self, to: Self, to_slope: Self, t: f64) -> Self {
            let [a, b, c, d] = hermite_weights(t);
            from * a + from_slope * b + to * c + to_slope * d
        }

        fn squad_controls(_from: Self, _to: Self, changes: [Self; 2], secs: f64) -> [Self; 2] {
            changes.map(|velocity| velocity * secs)
        }

        fn squad(from: Self, from_control: Self, to: Self, to_control: Self, t: f64) -> Self {
            Self::hermite(from, from_control, to, to_control, t)
        }

        fn shifted(self, first: Self, last: Self, times: f64) -> Self {
            self + (last - first) * times
        }

        fn slope_shifted(self, _first: Self, _last: Self) -> Self {
            self
        }

        const HAS_HANDLES: bool = true;
    };
}

impl Value for f64 {
    type Velocity = Self;

    fn fault(self) -> Option<ValueFault> {
        (!self.is_within(LONGEST_LENGTH)).then_some(ValueFault::OutOfRange)
    }

    fn is_within(self, most: f64) -> bool {
        self.abs() <= most
    }

    fn normalized(self) -> Self {
        self
    }

    fn is_far_side(self, _previous: Self) -> bool {
        false
    }

    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    fn sum(self, other: Self) -> Self {
        self + other
    }

    fn velocity(from: Self, to: Self, secs: f64) -> Self {
        (to - from) / secs
    }

    fn smooth_velocity(meeting: Meeting<Self>) -> Self {
        let Meeting {
            before,
            secs_before,
            after,
            secs_after,
        } = meeting;
        (secs_before * after + secs_after * before) / (secs_before + secs_after)
    }

    fn clamped_velocity(meeting: Meeting<Self>) -> Self {
        let (before, after) = (meeting.before, meeting.after);
        if before * after <= 0.0 {
            return 0.0;
        }
        let steepest = STEEPEST * before.abs().min(after.abs());
        Self::smooth_velocity(meeting).clamp(-steepest, steepest)
    }

    fn is_no_less_than_zero(self) -> bool {
        self >= 0.0
    }

    fn within(secs: Self, value: Self, most_secs: f64) -> (Self, Self) {
        if secs > most_secs {
            (1.0, value * (most_secs / secs))
        } else {
            (secs / most_secs, value)
        }
    }

    fn slope_of_handle(secs: Self, value: Self) -> Self {
        value / secs.max(LEAST_HANDLE_SECS)
    }

    fn bezier(ends: [Self; 2], slopes: [Self; 2], reaches: [Self; 2], t: f64) -> Self {
        let along = bezier_parameter(reaches[0], reaches[1], t);
        Self::hermite(ends[0], slopes[0], ends[1], slopes[1], along)
    }

    fn third() -> Self {
        1.0 / 3.0
    }

    /// De Casteljau's construction, in time and in value.
    fn cut_bezier(
        ends: [Self; 2],
        slopes: [Self; 2],
        reaches: [Self; 2],
        t: f64,
    ) -> (Self, [(Self, Self); 4]) {
        let along = bezier_parameter(reaches[0], reaches[1], t);
        let mixed = |a: Self, b: Self| a + (b - a) * along;
        let cut = |points: [Self; 4]| {
            let [a, b, c] = [0, 1, 2].map(|i| mixed(points[i], points[i + 1]));
            let [d, e] = [mixed(a, b), mixed(b, c)];
            ([a, d, e, c], mixed(d, e))
        };
        let third = 1.0 / 3.0;
        let heights = [
            ends[0],
            ends[0] + slopes[0] * third,
            ends[1] - slopes[1] * third,
            ends[1],
        ];
        let (times, at) = cut([0.0, reaches[0], 1.0 - reaches[1], 1.0]);
        let (values, value) = cut(heights);
        let keys = [(0.0, ends[0]), (at, value), (at, value), (1.0, ends[1])];
        let handle = |i: usize| ((times[i] - keys[i].0).abs(), values[i] - keys[i].1);
        (value, [0, 1, 2, 3].map(handle))
    }

    linear_ways!();
}

impl Value for DVec3 {
    type Velocity = Self;

    fn fault(self) -> Option<ValueFault> {
        (!self.is_within(LONGEST_LENGTH)).then_some(ValueFault::OutOfRange)
    }

    fn is_within(self, most: f64) -> bool {
        self.to_array().into_iter().all(|part| part.abs() <= most)
    }

    fn normalized(self) -> Self {
        self
    }

    fn is_far_side(self, _previous: Self) -> bool {
        false
    }

    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    fn sum(self, other: Self) -> Self {
        self + other
    }

    fn velocity(from: Self, to: Self, secs: f64) -> Self {
        (to - from) / secs
    }

    fn smooth_velocity(meeting: Meeting<Self>) -> Self {
        per_component(meeting, f64::smooth_velocity)
    }

    fn clamped_velocity(meeting: Meeting<Self>) -> Self {
        per_component(meeting, f64::clamped_velocity)
    }

    fn is_no_less_than_zero(self) -> bool {
        self.cmpge(Self::ZERO).all()
    }

    fn within(secs: Self, value: Self, most_secs: f64) -> (Self, Self) {
        let axes = [0, 1, 2].map(|axis| f64::within(secs[axis], value[axis], most_secs));
        (
            Self::from_array(axes.map(|(share, _)| share)),
            Self::from_array(axes.map(|(_, value)| value)),
        )
    }

    fn slope_of_handle(secs: Self, value: Self) -> Self {
        let axis = |axis: usize| f64::slope_of_handle(secs[axis], value[axis]);
        Self::from_array([0, 1, 2].map(axis))
    }

    fn bezier(ends: [Self; 2], slopes: [Self; 2], reaches: [Self; 2], t: f64) -> Self {
        let of = |pair: [Self; 2], axis: usize| pair.map(|vector| vector[axis]);
        let axis = |axis| f64::bezier(of(ends, axis), of(slopes, axis), of(reaches, axis), t);
        Self::from_array([0, 1, 2].map(axis))
    }

    fn third() -> Self {
        Self::splat(1.0 / 3.0)
    }

    fn cut_bezier(
        ends: [Self; 2],
        slopes: [Self; 2],
        reaches: [Self; 2],
        t: f64,
    ) -> (Self, [(Self, Self); 4]) {
        let of = |pair: [Self; 2], axis: usize| pair.map(|vector| vector[axis]);
        let cuts = [0, 1, 2]
            .map(|axis| f64::cut_bezier(of(ends, axis), of(slopes, axis), of(reaches, axis), t));
        let handle = |i: usize| {
            let secs = Self::from_array(cuts.map(|(_, handles)| handles[i].0));
            let value = Self::from_array(cuts.map(|(_, handles)| handles[i].1));
            (secs, value)
        };
        let value = Self::from_array(cuts.map(|(value, _)| value));
        (value, [0, 1, 2, 3].map(handle))
    }

    linear_ways!();
}

/// Slerp between the quaternions as they are, not the short way between the rotations: the two curves
/// that a squad mixes may lie more than half a turn apart in the middle, and must not jump there.
fn along_arc(from: DQuat, to: DQuat, t: f64) -> DQuat {
    let arc = 2.0 * libm::atan2((to - from).length(), (to + from).length());
    let sin = libm::sin(arc);
    // Antipodes, and neighbours: the chord is the arc, or as good as any.
    if sin < 1e-8 {
        return (from * (1.0 - t) + to * t).normalize();
    }
    (from * libm::sin((1.0 - t) * arc) + to * libm::sin(t * arc)) * (1.0 / sin)
}

fn per_component(meeting: Meeting<DVec3>, rule: fn(Meeting<f64>) -> f64) -> DVec3 {
    let (before, after) = (meeting.before.to_array(), meeting.after.to_array());
    DVec3::from_array(std::array::from_fn(|axis| {
        rule(Meeting {
            before: before[axis],
            secs_before: meeting.secs_before,
            after: after[axis],
            secs_after: meeting.secs_after,
        })
    }))
}

impl Value for DQuat {
    type Velocity = DVec3;

    fn fault(self) -> Option<ValueFault> {
        if !self.is_within(LONGEST_LENGTH) {
            return Some(ValueFault::OutOfRange);
        }
        let length = self.length();
        ((length - 1.0).abs() > UNIT_TOLERANCE).then_some(ValueFault::NotUnit(length))
    }

    fn is_within(self, most: f64) -> bool {
        self.to_array().into_iter().all(|part| part.abs() <= most)
    }

    fn normalized(self) -> Self {
        self.normalize()
    }

    fn is_far_side(self, previous: Self) -> bool {
        self.dot(previous) < 0.0
    }

    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    fn sum(self, other: Self) -> Self {
        self + other
    }

    fn velocity(from: Self, to: Self, secs: f64) -> DVec3 {
        log(from.conjugate() * to) / secs
    }

    fn smooth_velocity(meeting: Meeting<DVec3>) -> DVec3 {
        DVec3::smooth_velocity(meeting)
    }

    /// Per component it would depend on how the bone's axes lie, so the rule of numbers is applied to
    /// lengths: the cosine between the two velocities takes the place of the question whether they
    /// have one sign.
    fn clamped_velocity(meeting: Meeting<DVec3>) -> DVec3 {
        let (before, after) = (meeting.before, meeting.after);
        let (slow, fast) = (before.length(), after.length());
        let along = before.dot(after);
        if along <= 0.0 {
            return DVec3::ZERO;
        }
        let steepest = STEEPEST * slow.min(fast) * (along / (slow * fast)).min(1.0);
        DVec3::smooth_velocity(meeting).clamp_length_max(steepest)
    }

    fn tangent(self, velocity: DVec3) -> Self {
        self * Self::from_vec4((velocity * 0.5).extend(0.0))
    }

    fn straight(from: Self, to: Self, t: f64) -> Self {
        slerp(from, to, t)
    }

    fn hermite(from: Self, from_slope: Self, to: Self, to_slope: Self, t: f64) -> Self {
        let [a, b, c, d] = hermite_weights(t);
        let sum = from * a + from_slope * b + to * c + to_slope * d;
        // Tangents can be chosen so that the curve passes through zero; no direction is right there.
        let length = sum.length();
        if length > f64::MIN_POSITIVE {
            sum * (1.0 / length)
        } else {
            from
        }
    }

    fn squad_velocity(meeting: Meeting<DVec3>) -> DVec3 {
        let longest = meeting.secs_before.max(meeting.secs_after);
        DVec3::smooth_velocity(meeting).clamp_length_max(MOST_SQUAD_TURN_RAD / longest)
    }

    fn squad_controls(from: Self, to: Self, changes: [DVec3; 2], secs: f64) -> [Self; 2] {
        let way = log(from.conjugate() * to);
        [
            from * exp((changes[0] * secs - way) * 0.5),
            to * exp((way - changes[1] * secs) * 0.5),
        ]
    }

    fn squad(from: Self, from_control: Self, to: Self, to_control: Self, t: f64) -> Self {
        let outer = along_arc(from, to, t);
        let inner = along_arc(from_control, to_control, t);
        along_arc(outer, inner, 2.0 * t * (1.0 - t))
    }

    fn shifted(self, first: Self, last: Self, times: f64) -> Self {
        exp(log(last * first.conjugate()) * times) * self
    }

    fn slope_shifted(self, first: Self, last: Self) -> Self {
        self.shifted(first, last, 1.0)
    }

    // The four components are one value: they have no times of their own. A track refuses such handles.
    const HAS_HANDLES: bool = false;

    fn is_no_less_than_zero(self) -> bool {
        false
    }

    fn within(_secs: Self, value: Self, _most_secs: f64) -> (Self, Self) {
        (Self::third(), value)
    }

    fn slope_of_handle(_secs: Self, value: Self) -> Self {
        value
    }

    fn bezier(ends: [Self; 2], slopes: [Self; 2], _reaches: [Self; 2], t: f64) -> Self {
        Self::hermite(ends[0], slopes[0], ends[1], slopes[1], t)
    }

    fn third() -> Self {
        Self::IDENTITY
    }

    fn cut_bezier(
        ends: [Self; 2],
        slopes: [Self; 2],
        _reaches: [Self; 2],
        t: f64,
    ) -> (Self, [(Self, Self); 4]) {
        let value = Self::hermite(ends[0], slopes[0], ends[1], slopes[1], t);
        (value, [(Self::third(), value); 4])
    }
}
