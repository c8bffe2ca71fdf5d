//! Pairs of orientations that show something.

use clap::ValueEnum;
use glam::{DQuat, DVec3};
use posekit::inbetween::Ends;
use posekit::rotation::{EulerOrder, exp};

/// A pair of orientations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Preset {
    /// A small turn at the lock of XYZ, about the axis that is lost
    Gimbal,
    /// A large one
    GimbalFar,
    /// A quarter turn about an axis askew
    Quarter,
    /// Nearly half a turn
    HalfTurn,
    /// Quaternions of opposite sign
    LongWay,
}

impl Preset {
    pub(super) fn ends(self) -> Ends {
        // A degree short of the lock the first and the last axis are nearly one, X; Y is the second.
        let pitched = EulerOrder::XYZ.to_quat([0.0, f64::to_radians(89.0), 0.0]);
        let at_the_lock = |angle_deg: f64| {
            let turn = exp(DVec3::Z * f64::to_radians(angle_deg));
            Ends::new(pitched, turn * pitched)
        };
        let askew =
            |angle_deg: f64| exp(DVec3::new(1.0, 2.0, 2.0) / 3.0 * f64::to_radians(angle_deg));
        match self {
            Self::Gimbal => at_the_lock(40.0),
            Self::GimbalFar => at_the_lock(120.0),
            Self::Quarter => Ends::new(DQuat::IDENTITY, askew(90.0)),
            Self::HalfTurn => Ends::new(DQuat::IDENTITY, askew(179.0)),
            Self::LongWay => Ends::new(DQuat::IDENTITY, -askew(60.0)),
        }
    }
}
