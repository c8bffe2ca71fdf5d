//! The planar arm of two links, in closed form.

use core::f64::consts::PI;

use glam::DVec2;

/// A planar arm: an upper link from the origin, and a forelink from the elbow.
///
/// `x = l1 cos t1 + l2 cos(t1 + t2)`, `y = l1 sin t1 + l2 sin(t1 + t2)`.
///
/// ```
/// use glam::DVec2;
/// use posekit::ik::robot::{TwoLink, TwoLinkSolutions};
///
/// let arm = TwoLink { upper: 0.5, fore: 0.4 };
/// let target = DVec2::new(0.3, 0.6);
/// let TwoLinkSolutions::Two(both) = arm.solve(target) else { panic!() };
/// for [t1, t2] in both {
///     assert!(arm.tip(t1, t2).distance(target) < 1e-15);
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoLink {
    /// Length of the link from the origin to the elbow, not negative.
    pub upper: f64,
    /// Length of the link from the elbow to the tip, not negative.
    pub fore: f64,
}

/// The angles `[t1, t2]` that bring the tip to a target, in radians within half a turn of zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TwoLinkSolutions {
    /// One with the elbow to the right of the line to the target (`t2` positive), one with it to the left.
    Two([[f64; 2]; 2]),
    /// The arm is stretched or folded: one solution, at a singularity.
    One([f64; 2]),
    /// The target is the origin and the links are equally long: `t2` is half a turn and `t1` any angle.
    AnyDirection,
    /// The target cannot be reached; `nearest` comes as near as possible.
    OutOfReach {
        /// How far the target is beyond what the tip can reach, or nearer than it can fold.
        by: f64,
        /// The angles that come nearest.
        nearest: [f64; 2],
    },
}

/// Sines of the elbow's angle below this are rounding: both solutions are one.
const STRAIGHT: f64 = 1e-8;

impl TwoLink {
    /// Where the elbow is.
    pub fn elbow(&self, t1: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(t1);
        DVec2::new(cos, sin) * self.upper
    }

    /// Where the tip is.
    pub fn tip(&self, t1: f64, t2: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(t1 + t2);
        self.elbow(t1) + DVec2::new(cos, sin) * self.fore
    }

    /// Yoshikawa's manipulability, `l1 l2 |sin t2|`: the determinant of the Jacobian but for its sign.
    pub fn manipulability(&self, t2: f64) -> f64 {
        self.upper * self.fore * libm::sin(t2).abs()
    }

    /// All ways to reach a target: the cosine law gives the elbow, its two signs both solutions.
    pub fn solve(&self, target: DVec2) -> TwoLinkSolutions {
        let (upper, fore) = (self.upper, self.fore);
        let distance = target.length();
        let direction = libm::atan2(target.y, target.x);
        let (farthest, nearest) = (upper + fore, (upper - fore).abs());
        let size = farthest.max(f64::MIN_POSITIVE);
        let slack = 1e-14 * size;
        if distance > farthest + slack {
            return TwoLinkSolutions::OutOfReach {
                by: distance - farthest,
                nearest: [direction, 0.0],
            };
        }
        if distance < nearest - slack {
            return TwoLinkSolutions::OutOfReach {
                by: nearest - distance,
                nearest: self.folded(direction),
            };
        }
        if distance <= slack {
            return TwoLinkSolutions::AnyDirection;
        }
        let square = distance * distance - upper * upper - fore * fore;
        let cos = (square / (2.0 * upper * fore)).clamp(-1.0, 1.0);
        // A link without a length leaves the angle of the other as the only one that counts.
        if !cos.is_finite() {
            return TwoLinkSolutions::One([direction, 0.0]);
        }
        let t2 = libm::acos(cos);
        if libm::sin(t2) < STRAIGHT {
            let t = if cos > 0.0 {
                [direction, 0.0]
            } else {
                self.folded(direction)
            };
            return TwoLinkSolutions::One(t);
        }
        let [right, left] = [t2, -t2].map(|t2| {
            let (sin, cos) = libm::sincos(t2);
            let inner = libm::atan2(fore * sin, upper + fore * cos);
            [wrapped(direction - inner), t2]
        });
        TwoLinkSolutions::Two([right, left])
    }

    /// The folded arm whose tip is as near the origin as it gets, on the side of `direction`.
    fn folded(&self, direction: f64) -> [f64; 2] {
        let is_upper_longer = self.upper >= self.fore;
        let t1 = if is_upper_longer {
            direction
        } else {
            direction + PI
        };
        [wrapped(t1), PI]
    }
}

fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - (angle_rad / (2.0 * PI)).round() * (2.0 * PI)
}
