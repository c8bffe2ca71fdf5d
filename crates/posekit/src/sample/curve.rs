//! Curves over time: a clamped cubic spline, harmonics, the minimum-jerk step, and elementary
//! rotations made with `libm`, so that every platform writes the same bytes.

use glam::{DQuat, DVec3};

/// A function through given points with continuous first and second derivatives (the clamped cubic
/// spline; de Boor, "A Practical Guide to Splines", 1978, ch. IV). Outside its points it goes on
/// along its end slopes.
#[derive(Clone, Debug)]
pub(super) struct Spline {
    /// Place, value and slope of each knot.
    knots: Vec<[f64; 3]>,
}

impl Spline {
    /// A spline through `(place, value)` points, in rising order of place, with the slopes that it
    /// has at its ends.
    pub(super) fn clamped(points: &[(f64, f64)], start_slope: f64, end_slope: f64) -> Self {
        debug_assert!(points.len() >= 2 && points.windows(2).all(|pair| pair[0].0 < pair[1].0));
        let count = points.len();
        let mut slopes = vec![0.0; count];
        slopes[0] = start_slope;
        slopes[count - 1] = end_slope;
        // Thomas algorithm on the rows that make the second derivative continuous at each inner
        // knot; `upper` is the eliminated diagonal above.
        let mut upper = vec![0.0; count];
        for at in 1..count - 1 {
            let before = points[at].0 - points[at - 1].0;
            let after = points[at + 1].0 - points[at].0;
            let rise_before = (points[at].1 - points[at - 1].1) / before;
            let rise_after = (points[at + 1].1 - points[at].1) / after;
            let pivot = 2.0 * (before + after) - after * upper[at - 1];
            upper[at] = before / pivot;
            let target = 3.0 * (after * rise_before + before * rise_after);
            slopes[at] = (target - after * slopes[at - 1]) / pivot;
        }
        for at in (1..count - 1).rev() {
            slopes[at] -= upper[at] * slopes[at + 1];
        }
        let knots = points.iter().zip(slopes);
        Self {
            knots: knots.map(|(&(x, y), slope)| [x, y, slope]).collect(),
        }
    }

    /// The value at a place.
    pub(super) fn at(&self, place: f64) -> f64 {
        let last = self.knots.len() - 1;
        let [first_place, first, first_slope] = self.knots[0];
        let [last_place, end, end_slope] = self.knots[last];
        if place <= first_place {
            return first + first_slope * (place - first_place);
        }
        if place >= last_place {
            return end + end_slope * (place - last_place);
        }
        let after = self.knots.partition_point(|knot| knot[0] <= place);
        let [x0, y0, slope0] = self.knots[after - 1];
        let [x1, y1, slope1] = self.knots[after];
        let width = x1 - x0;
        let t = (place - x0) / width;
        let s = 1.0 - t;
        y0 * s * s * (1.0 + 2.0 * t)
            + y1 * t * t * (1.0 + 2.0 * s)
            + width * t * s * (slope0 * s - slope1 * t)
    }
}

/// `cos(2 pi turns)`.
pub(super) fn cos_turns(turns: f64) -> f64 {
    libm::cos(turns * std::f64::consts::TAU)
}

/// `sin(2 pi turns)`.
pub(super) fn sin_turns(turns: f64) -> f64 {
    libm::sin(turns * std::f64::consts::TAU)
}

/// From 0 at `from` to 1 at `to` with no velocity and no acceleration at either end, as a hand
/// moves between two places (Flash and Hogan 1985, "The coordination of arm movements").
pub(super) fn minimum_jerk(from: f64, to: f64, at: f64) -> f64 {
    let t = ((at - from) / (to - from)).clamp(0.0, 1.0);
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

/// Rotation about X.
pub(super) fn about_x(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle_rad * 0.5);
    DQuat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// Rotation about Y.
pub(super) fn about_y(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle_rad * 0.5);
    DQuat::from_xyzw(0.0, sin, 0.0, cos)
}

/// Rotation about Z.
pub(super) fn about_z(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle_rad * 0.5);
    DQuat::from_xyzw(0.0, 0.0, sin, cos)
}

/// The orientation whose X and Y axes are given, at right angles and of unit length. It is made
/// with square roots only.
pub(super) fn from_axes(x: DVec3, y: DVec3) -> DQuat {
    let z = x.cross(y);
    // Shepperd 1978: divide by the largest component.
    let squares = [
        1.0 + x.x + y.y + z.z,
        1.0 + x.x - y.y - z.z,
        1.0 - x.x + y.y - z.z,
        1.0 - x.x - y.y + z.z,
    ];
    let largest = (1..4).fold(0, |best, at| {
        if squares[at] > squares[best] {
            at
        } else {
            best
        }
    });
    let half = libm::sqrt(squares[largest]);
    let scale = 1.0 / half;
    let (wx, wy, wz) = (y.z - z.y, z.x - x.z, x.y - y.x);
    let (xy, xz, yz) = (x.y + y.x, z.x + x.z, y.z + z.y);
    let parts = match largest {
        0 => [wx * scale, wy * scale, wz * scale, half],
        1 => [half, xy * scale, xz * scale, wx * scale],
        2 => [xy * scale, half, yz * scale, wy * scale],
        _ => [xz * scale, yz * scale, half, wz * scale],
    };
    DQuat::from_array(parts.map(|part| part * 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spline_meets_its_points_and_slopes_and_bends_without_a_kink() {
        let points = [(0.0, 1.0), (0.3, -2.0), (0.5, 0.0), (1.0, 4.0)];
        let spline = Spline::clamped(&points, 3.0, -1.0);
        for (x, y) in points {
            assert!((spline.at(x) - y).abs() < 1e-12);
        }
        let h = 1e-4;
        let slope = |x: f64| (spline.at(x + h) - spline.at(x - h)) / (2.0 * h);
        assert!((slope(-1.0) - 3.0).abs() < 1e-6 && (slope(2.0) + 1.0).abs() < 1e-6);
        let bend = |x: f64| (slope(x + h) - slope(x - h)) / (2.0 * h);
        for (x, _) in &points[1..3] {
            assert!((bend(x - 0.001) - bend(x + 0.001)).abs() < 2.0);
        }
    }

    #[test]
    fn a_spline_agrees_with_scipy() {
        // scipy.interpolate.CubicSpline([0, .3, .5, 1], [1, -2, 0, 4],
        //     bc_type=((1, 3.0), (1, -1.0)))([.1, .4, .8]), SciPy 1.x.
        let points = [(0.0, 1.0), (0.3, -2.0), (0.5, 0.0), (1.0, 4.0)];
        let spline = Spline::clamped(&points, 3.0, -1.0);
        let expected = [0.4024888888888887, -1.4287999999999994, 3.38592];
        for (x, y) in [0.1, 0.4, 0.8].into_iter().zip(expected) {
            assert!(
                (spline.at(x) - y).abs() < 1e-9,
                "{} at {x}, not {y}",
                spline.at(x)
            );
        }
    }

    #[test]
    fn axes_make_the_rotation_that_has_them() {
        for (a, b, c) in [
            (0.3, -0.4, 2.0),
            (3.1, 0.1, 0.0),
            (0.0, 3.1, 0.2),
            (0.1, 0.0, 3.1),
        ] {
            let q = about_x(a) * about_y(b) * about_z(c);
            let again = from_axes(q * DVec3::X, q * DVec3::Y);
            assert!(again.dot(q).abs() > 1.0 - 1e-12, "{a} {b} {c}");
        }
    }
}
