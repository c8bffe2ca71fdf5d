//! Motions brought within their limits.

use core::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};

use super::{Interval, JointLimit};
use crate::rotation::{EulerOrder, exp, log, swing_twist};

/// How far outside a range an angle may be through rounding alone, in radians.
const ROUNDING_RAD: f64 = 1e-12;

impl JointLimit {
    /// Whether the joint turns at all.
    pub fn turns(&self) -> bool {
        !matches!(self, Self::Slide { .. } | Self::Fixed)
    }

    /// The rotation within the limits that takes the place of `motion`, a rotation from the joint's rest
    /// orientation. One within them is returned as it is; sliding and fixed joints do not turn, and for
    /// them this is the identity.
    pub fn project(&self, motion: DQuat) -> DQuat {
        match *self {
            Self::Free => motion,
            Self::Slide { .. } | Self::Fixed => DQuat::IDENTITY,
            Self::Euler { order, angles_rad } => project_euler(motion, order, &angles_rad),
            Self::Cone {
                axis,
                swing_max_rad,
                twist_rad,
            } => project_cone(motion, axis, swing_max_rad, twist_rad),
            Self::Hinge { axis, angle_rad } => project_hinge(motion, axis, angle_rad),
        }
    }

    /// Whether `motion`, a rotation from the rest orientation, is within the limits, give or take
    /// `tolerance_rad`.
    pub fn allows(&self, motion: DQuat, tolerance_rad: f64) -> bool {
        crate::rotation::angle_between(self.project(motion), motion) <= tolerance_rad
    }
}

/// The angle in the range that is nearest to `angle_rad` on the circle.
pub(crate) fn clamp_angle(angle_rad: f64, range_rad: Interval) -> f64 {
    if range_rad.contains(angle_rad) || range_rad.max - range_rad.min >= TAU {
        return angle_rad;
    }
    let middle = range_rad.middle();
    // Between half a turn before the middle of the range and half a turn after it, the nearer end is
    // the nearer one on the circle, too.
    let turn_count = ((middle - angle_rad) / TAU).round();
    let near_middle = if turn_count.is_finite() {
        angle_rad + turn_count * TAU
    } else {
        angle_rad
    };
    range_rad.clamp(near_middle)
}

fn project_euler(motion: DQuat, order: EulerOrder, ranges_rad: &[Interval; 3]) -> DQuat {
    let found = within(motion, order, ranges_rad);
    if found.is_within {
        motion
    } else {
        order.to_quat(found.angles_rad)
    }
}

/// Angles of a motion within ranges.
struct WithinRanges {
    angles_rad: [f64; 3],
    /// How far angles were moved to get there, in all.
    moved_rad: f64,
    /// Whether they make the motion that was asked for.
    is_within: bool,
}

/// The angles within the ranges that are nearest to those of a motion. Of the two triples that make it the one
/// that is moved less counts: one within the ranges is found even if the other lies nearer to their middle.
fn within(motion: DQuat, order: EulerOrder, ranges_rad: &[Interval; 3]) -> WithinRanges {
    let middle = ranges_rad.map(Interval::middle);
    let euler = order.from_quat_near(motion, middle);
    let clamped = |angles_rad: [f64; 3]| {
        let mut found = WithinRanges {
            angles_rad,
            moved_rad: 0.0,
            is_within: euler.residual_rad <= ROUNDING_RAD,
        };
        let pairs = found.angles_rad.iter_mut().zip(ranges_rad);
        for (angle, range) in pairs.take(order.axes().len()) {
            let nearest = clamp_angle(*angle, *range);
            // On the circle: the end of a range may be a turn away.
            let moved = libm::remainder(nearest - *angle, TAU).abs();
            found.is_within &= moved <= ROUNDING_RAD;
            found.moved_rad += moved;
            *angle = nearest;
        }
        found
    };
    let first = clamped(euler.angles_rad);
    let [a, b, c] = euler.angles_rad;
    let other = match order.axes() {
        _ if first.is_within || !order.is_complete() => return first,
        [outer, _, inner] if outer == inner => [a + PI, -b, c + PI],
        _ => [a + PI, PI - b, c + PI],
    };
    let other = clamped(other);
    if other.moved_rad < first.moved_rad {
        other
    } else {
        first
    }
}

fn project_cone(motion: DQuat, axis: DVec3, swing_max_rad: f64, twist_rad: Interval) -> DQuat {
    let parts = swing_twist(motion, axis);
    let twist_angle_rad = clamp_angle(parts.twist_angle_rad, twist_rad);
    let swing = log(parts.swing);
    let swing_angle_rad = swing.length();
    let is_swing_within = swing_angle_rad <= swing_max_rad + ROUNDING_RAD;
    let moved_rad = libm::remainder(twist_angle_rad - parts.twist_angle_rad, TAU).abs();
    if is_swing_within && moved_rad <= ROUNDING_RAD {
        return motion;
    }
    let swing = if is_swing_within {
        parts.swing
    } else {
        exp(swing * (swing_max_rad / swing_angle_rad))
    };
    (swing * exp(axis * twist_angle_rad)).normalize()
}

fn project_hinge(motion: DQuat, axis: DVec3, range_rad: Interval) -> DQuat {
    let parts = swing_twist(motion, axis);
    let angle_rad = clamp_angle(parts.twist_angle_rad, range_rad);
    let swing_angle_rad = 2.0 * libm::asin(parts.swing.xyz().length().min(1.0)).min(PI);
    let moved_rad = libm::remainder(angle_rad - parts.twist_angle_rad, TAU).abs();
    if moved_rad <= ROUNDING_RAD && swing_angle_rad <= ROUNDING_RAD {
        return motion;
    }
    exp(axis * angle_rad)
}

impl JointLimit {
    /// The angles within the ranges that make the motion, or one as near to it as projecting leads to.
    pub(crate) fn euler_angles(
        motion: DQuat,
        order: EulerOrder,
        ranges_rad: &[Interval; 3],
    ) -> [f64; 3] {
        within(motion, order, ranges_rad).angles_rad
    }

    /// Whether a motion within the limits is at an end of them, within `tolerance_rad`: it could go no
    /// further at least one way. A hinge is so only at the ends of its range.
    pub(crate) fn is_at_end(&self, motion: DQuat, tolerance_rad: f64) -> bool {
        let is_at = |angle_rad: f64, range: Interval| {
            range.max - range.min < TAU
                && (angle_rad <= range.min + tolerance_rad
                    || angle_rad >= range.max - tolerance_rad)
        };
        match *self {
            Self::Free | Self::Fixed | Self::Slide { .. } => false,
            Self::Euler { order, angles_rad } => {
                let angles = Self::euler_angles(motion, order, &angles_rad);
                let count = order.axes().len();
                (0..count).any(|i| is_at(angles[i], angles_rad[i]))
            }
            Self::Cone {
                axis,
                swing_max_rad,
                twist_rad,
            } => {
                let parts = swing_twist(motion, axis);
                log(parts.swing).length() >= swing_max_rad - tolerance_rad
                    || is_at(parts.twist_angle_rad, twist_rad)
            }
            Self::Hinge { axis, angle_rad } => {
                let angle = swing_twist(motion, axis).twist_angle_rad;
                let turn_count = ((angle_rad.middle() - angle) / TAU).round();
                is_at(angle + turn_count * TAU, angle_rad)
            }
        }
    }
}
