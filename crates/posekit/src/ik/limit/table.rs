//! The limits of all joints of a skeleton.

use glam::DVec3;

use super::{Interval, JointLimit};
use crate::skeleton::JointId;

/// The limit and the stiffness of every joint of one skeleton; joints that were given none are free.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct JointLimits {
    /// By joint index; joints beyond the end are free.
    joints: Vec<(JointLimit, f64)>,
}

/// Why a limit makes no sense.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum JointLimitError {
    /// The axis is zero or not finite.
    #[error("the axis {axis} has no direction")]
    NoDirection {
        /// The axis that was given.
        axis: DVec3,
    },
    /// A range ends before it starts, or an end is not a number.
    #[error("the range from {min} to {max} is empty")]
    EmptyRange {
        /// Its least value.
        min: f64,
        /// Its greatest value.
        max: f64,
    },
    /// The swing of a cone is not an angle from 0 to pi.
    #[error("a swing of {swing_max_rad} rad is not within 0 to pi")]
    Swing {
        /// The swing that was given.
        swing_max_rad: f64,
    },
    /// A stiffness is not within 0 to 1.
    #[error("a stiffness of {stiffness} is not within 0 to 1")]
    Stiffness {
        /// The stiffness that was given.
        stiffness: f64,
    },
}

impl JointLimits {
    /// The joint's limit.
    pub fn limit(&self, joint: JointId) -> JointLimit {
        self.joints
            .get(joint.index())
            .map_or(JointLimit::Free, |entry| entry.0)
    }

    /// How much of its motion the joint withholds: 0 moves freely, 1 not at all.
    pub fn stiffness(&self, joint: JointId) -> f64 {
        self.joints.get(joint.index()).map_or(0.0, |entry| entry.1)
    }

    /// Whether no joint has a limit or is stiff.
    pub fn is_free(&self) -> bool {
        self.joints
            .iter()
            .all(|entry| *entry == (JointLimit::Free, 0.0))
    }

    /// Sets a joint's limit. An axis is brought to unit length.
    ///
    /// # Errors
    /// If an axis has no direction, a range is empty or a swing is no angle; the table is as before.
    pub fn set_limit(&mut self, joint: JointId, limit: JointLimit) -> Result<(), JointLimitError> {
        let limit = checked(limit)?;
        self.entry(joint).0 = limit;
        Ok(())
    }

    /// Sets a joint's stiffness, from 0 (moves freely) to 1 (does not move).
    ///
    /// # Errors
    /// If the stiffness is not within 0 to 1; the table is as before.
    pub fn set_stiffness(&mut self, joint: JointId, stiffness: f64) -> Result<(), JointLimitError> {
        if !(0.0..=1.0).contains(&stiffness) {
            return Err(JointLimitError::Stiffness { stiffness });
        }
        self.entry(joint).1 = stiffness;
        Ok(())
    }

    fn entry(&mut self, joint: JointId) -> &mut (JointLimit, f64) {
        let needed = joint.index() + 1;
        if self.joints.len() < needed {
            self.joints.resize(needed, (JointLimit::Free, 0.0));
        }
        &mut self.joints[joint.index()]
    }
}

fn checked(limit: JointLimit) -> Result<JointLimit, JointLimitError> {
    match limit {
        JointLimit::Free | JointLimit::Fixed => {}
        JointLimit::Euler { order, angles_rad } => {
            for range in &angles_rad[..order.axes().len()] {
                check_range(*range)?;
            }
        }
        JointLimit::Cone {
            axis,
            swing_max_rad,
            twist_rad,
        } => {
            check_range(twist_rad)?;
            if !(0.0..=core::f64::consts::PI).contains(&swing_max_rad) {
                return Err(JointLimitError::Swing { swing_max_rad });
            }
            return Ok(JointLimit::Cone {
                axis: direction(axis)?,
                swing_max_rad,
                twist_rad,
            });
        }
        JointLimit::Hinge { axis, angle_rad } => {
            check_range(angle_rad)?;
            return Ok(JointLimit::Hinge {
                axis: direction(axis)?,
                angle_rad,
            });
        }
        JointLimit::Slide { axis, distance } => {
            check_range(distance)?;
            return Ok(JointLimit::Slide {
                axis: direction(axis)?,
                distance,
            });
        }
    }
    Ok(limit)
}

fn check_range(range: Interval) -> Result<(), JointLimitError> {
    let Interval { min, max } = range;
    let is_bound = |end: f64, nowhere: f64| !end.is_nan() && end != nowhere;
    if min <= max && is_bound(min, f64::INFINITY) && is_bound(max, f64::NEG_INFINITY) {
        Ok(())
    } else {
        Err(JointLimitError::EmptyRange { min, max })
    }
}

fn direction(axis: DVec3) -> Result<DVec3, JointLimitError> {
    axis.try_normalize()
        .ok_or(JointLimitError::NoDirection { axis })
}
