//! Angles that satisfy one or two equations in their sines and cosines.

use core::f64::consts::{PI, TAU};

use glam::{DMat2, DVec2, DVec3};

/// Of quantities near one, what counts as nothing: far above rounding, far below what a robot is made to.
pub(super) const NOTHING: f64 = 1e-9;

/// Samples of a turn when roots are looked for. There are four at most; two nearer than this are found by the turning
/// point between them.
const SAMPLES: u32 = 360;

/// An angle within half a turn of zero.
pub(super) fn wrapped(angle: f64) -> f64 {
    angle - TAU * libm::round(angle / TAU)
}

/// A point that is turned about an axis through the origin, as `along + cos * c + sin * s`.
pub(super) fn circle(axis: DVec3, point: DVec3) -> [DVec3; 3] {
    let along = axis * axis.dot(point);
    [along, point - along, axis.cross(point)]
}

/// The angle about an axis that brings one vector as near to another as it can; `None` where one of them is along
/// the axis, so that every angle does.
pub(super) fn turn_onto(axis: DVec3, from: DVec3, to: DVec3) -> Option<f64> {
    let [_, cos, sin] = circle(axis, from);
    let to = to - axis * axis.dot(to);
    let size = cos.length() * to.length();
    (size > NOTHING * NOTHING).then(|| libm::atan2(sin.dot(to), cos.dot(to)))
}

/// The angles where `cos * c + sin * s = sum`: none, two (equal ones where they meet), or `None` where all do.
pub(super) fn linear(cos: f64, sin: f64, sum: f64) -> Option<Vec<f64>> {
    let size = libm::hypot(cos, sin);
    if size < NOTHING {
        return (sum.abs() >= NOTHING).then(Vec::new);
    }
    let share = sum / size;
    if share.abs() > 1.0 + 1e-7 {
        return Some(Vec::new());
    }
    let (middle, half) = (libm::atan2(sin, cos), libm::acos(share.clamp(-1.0, 1.0)));
    Some(vec![wrapped(middle + half), wrapped(middle - half)])
}

/// Two circles' equations: `left * (cos a, sin a) + constant = right * (cos b, sin b)`, rows one equation each.
#[derive(Clone, Copy, Debug)]
pub(super) struct TwoCircles {
    pub(super) left: DMat2,
    pub(super) constant: DVec2,
    pub(super) right: DMat2,
}

impl TwoCircles {
    /// All pairs of angles `(a, b)`, at most four; `None` where there is no end of them.
    ///
    /// What Pieper (1968, "The Kinematics of Manipulators under Computer Control", Stanford) makes a quartic of: one
    /// angle's sine and cosine are eliminated, and the other's satisfy an equation of the second degree.
    pub(super) fn solve(&self) -> Option<Vec<[f64; 2]>> {
        let scale = self
            .left
            .to_cols_array()
            .into_iter()
            .chain(self.right.to_cols_array());
        let scale = scale.fold(0.0, |most: f64, number| most.max(number.abs()));
        if scale < NOTHING {
            return (self.constant.length() >= NOTHING).then(Vec::new);
        }
        let is_regular = |m: DMat2| m.determinant().abs() > 1e-6 * scale * scale;
        if is_regular(self.left) {
            return Some(self.eliminated());
        }
        if is_regular(self.right) {
            let swapped = Self {
                left: self.right,
                constant: -self.constant,
                right: self.left,
            };
            let pairs = swapped.eliminated().into_iter();
            return Some(pairs.map(|[b, a]| [a, b]).collect());
        }
        // Each side is of rank one: a combination of the equations has one angle alone, and the other one follows.
        let (rows_left, rows_right) = (self.left.transpose(), self.right.transpose());
        let combine = |without: DMat2| {
            let [first, second] = [without.x_axis, without.y_axis];
            let larger = if first.length() >= second.length() {
                first
            } else {
                second
            };
            let size = larger.length();
            match size > 1e-6 * scale {
                // The rows are multiples of one direction.
                true => DVec2::new(second.dot(larger), -first.dot(larger)) / (size * size),
                false => DVec2::X,
            }
        };
        let weights = combine(rows_left);
        let of_b = rows_right * weights;
        let bs = linear(of_b.x, of_b.y, weights.dot(self.constant))?;
        // The other combination has the first angle in it as strongly as it can be.
        let weights = DVec2::new(-weights.y, weights.x);
        let of_a = rows_left * weights;
        let mut pairs = Vec::new();
        for b in bs {
            let (sin, cos) = libm::sincos(b);
            let sum = weights.dot(self.right * DVec2::new(cos, sin) - self.constant);
            let found = linear(of_a.x, of_a.y, sum)?;
            pairs.extend(found.into_iter().map(|a| [a, b]));
        }
        Some(pairs)
    }

    /// With a `left` that can be inverted.
    fn eliminated(&self) -> Vec<[f64; 2]> {
        let inverse = self.left.inverse();
        let (turned, shift) = (inverse * self.right, inverse * self.constant);
        let at = |b: f64| {
            let (sin, cos) = libm::sincos(b);
            turned * DVec2::new(cos, sin) - shift
        };
        let excess = |b: f64| at(b).length_squared() - 1.0;
        let slope = |b: f64| {
            let (sin, cos) = libm::sincos(b);
            2.0 * at(b).dot(turned * DVec2::new(-sin, cos))
        };
        let roots = roots(excess, slope);
        let pair = |b: f64| {
            let first = at(b);
            [libm::atan2(first.y, first.x), b]
        };
        roots.into_iter().map(pair).collect()
    }
}

/// The roots of a smooth function over a turn, those included that only touch zero.
fn roots(value: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> Vec<f64> {
    let step = TAU / f64::from(SAMPLES);
    let mut roots = Vec::new();
    for sample in 0..SAMPLES {
        let (from, to) = (
            -PI + f64::from(sample) * step,
            -PI + f64::from(sample + 1) * step,
        );
        let mut ends = vec![from];
        if slope(from) * slope(to) < 0.0 {
            ends.push(bisected(&slope, from, to));
        }
        ends.push(to);
        for pair in ends.windows(2) {
            let [low, high] = [value(pair[0]), value(pair[1])];
            if low == 0.0 {
                roots.push(pair[0]);
            } else if low * high < 0.0 {
                roots.push(bisected(&value, pair[0], pair[1]));
            }
        }
        // Two roots in one, or as good as: later steps decide whether the robot gets there.
        if let [_, turning, _] = ends[..]
            && value(turning).abs() < 1e-6
        {
            roots.push(turning);
        }
    }
    roots
}

/// Where a function that differs in sign at two places is zero.
fn bisected(function: &impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let is_negative = function(from) < 0.0;
    // 60 halvings of a degree are below the last digit.
    for _ in 0..60 {
        let middle = 0.5 * (from + to);
        if (function(middle) < 0.0) == is_negative {
            from = middle;
        } else {
            to = middle;
        }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_angle_is_found_both_ways() {
        let mut found = linear(0.6, -0.8, 0.5).expect("not all");
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), 2);
        for angle in found {
            assert!((0.6 * angle.cos() - 0.8 * angle.sin() - 0.5).abs() < 1e-12);
        }
        assert_eq!(linear(0.6, 0.8, 1.1), Some(Vec::new()));
        assert_eq!(linear(0.0, 0.0, 0.0), None);
        assert_eq!(linear(0.0, 0.0, 1.0), Some(Vec::new()));
    }

    #[test]
    fn pairs_of_angles_satisfy_both_equations_whatever_the_ranks() {
        let (a, b) = (0.7_f64, -2.1_f64);
        let u = |angle: f64| DVec2::new(angle.cos(), angle.sin());
        let full = DMat2::from_cols_array(&[1.0, 0.3, -0.2, 0.9]);
        let other = DMat2::from_cols_array(&[0.5, -1.1, 0.8, 0.2]);
        let rank_one = DMat2::from_cols_array(&[1.0, 0.5, 2.0, 1.0]);
        let row = DMat2::from_cols_array(&[0.0, 1.0, 0.0, -0.4]);
        for (left, right) in [
            (full, other),
            (full, rank_one),
            (rank_one, full),
            (rank_one, row),
            (row, rank_one),
        ] {
            let constant = right * u(b) - left * u(a);
            let circles = TwoCircles {
                left,
                constant,
                right,
            };
            let pairs = circles.solve().expect("a finite number");
            let is_found = |pair: &[f64; 2]| {
                wrapped(pair[0] - a).abs() < 1e-6 && wrapped(pair[1] - b).abs() < 1e-6
            };
            assert!(pairs.iter().any(is_found), "{left} {right}: {pairs:?}");
            assert!(pairs.len() <= 4);
            for [a, b] in pairs {
                let off = left * u(a) + constant - right * u(b);
                assert!(off.length() < 1e-6, "{left} {right}: {off}");
            }
        }
    }
}
