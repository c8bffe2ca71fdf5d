//! Random motions within limits, for solvers that start again elsewhere.

use core::f64::consts::{PI, TAU};

use glam::DQuat;

use super::{Interval, JointLimit};
use crate::ik::random::Random;
use crate::ik::turn::perpendicular;
use crate::rotation::exp;

impl JointLimit {
    /// A motion that the limits allow; each is about as likely as any other. The identity for joints that do
    /// not turn.
    pub(crate) fn sample(&self, random: &mut Random) -> DQuat {
        match *self {
            Self::Free => random.orientation(),
            Self::Slide { .. } | Self::Fixed => DQuat::IDENTITY,
            Self::Hinge { axis, angle_rad } => exp(axis * any_angle(angle_rad, random)),
            Self::Euler { order, angles_rad } => {
                let angles = angles_rad.map(|range| any_angle(range, random));
                self.project(order.to_quat(angles))
            }
            Self::Cone {
                axis,
                swing_max_rad,
                twist_rad,
            } => {
                // By the root, swings cover the cone's area evenly.
                let swing_rad = swing_max_rad * random.between(0.0, 1.0).sqrt();
                let side = exp(axis * random.between(-PI, PI)) * perpendicular(axis);
                exp(side * swing_rad) * exp(axis * any_angle(twist_rad, random))
            }
        }
    }
}

/// An angle of the range; any where the range is none.
fn any_angle(range_rad: Interval, random: &mut Random) -> f64 {
    if range_rad.max - range_rad.min < TAU {
        random.between(range_rad.min, range_rad.max)
    } else {
        random.between(-PI, PI)
    }
}
