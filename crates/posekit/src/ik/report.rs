//! What came of a problem.

use super::trace::IkTrace;
use crate::skeleton::JointId;

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum IkOutcome {
    /// Every target was reached within the tolerances.
    Reached,
    /// A target lies beyond the chain's reach, or nearer to its base than it can fold; the pose comes as
    /// near as the solver brought it.
    OutOfReach {
        /// How far the target that is farthest out of reach is beyond it, in the file's unit.
        by: f64,
    },
    /// The targets were not reached in the iterations that were allowed, and more may help.
    IterationLimit,
    /// The solver came to rest short of the targets with joints at their limits
    /// ([`IkReport::joints_at_limit`]), and the limits are to blame: starts from other poses within them did
    /// not reach the targets either, and without limits they are reached.
    LimitsInTheWay,
    /// The solver came to rest short of the targets with no limit to blame: a pose from which every
    /// small step leads away, though another solver or another start may get there, or targets that
    /// contradict each other.
    Stalled,
    /// A target holds a number that is not finite or no rotation; the pose was left as it was.
    InvalidTarget {
        /// Index of the first such target.
        target: usize,
    },
}

impl IkOutcome {
    /// Whether every target was reached.
    pub fn is_reached(self) -> bool {
        self == Self::Reached
    }
}

/// How far an effector is from its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IkResidual {
    /// Distance between the effector's point and its target, in the file's unit.
    pub distance: f64,
    /// Angle between the effector's orientation and its target's; 0 where none was asked for.
    pub angle_rad: f64,
}

/// What came of a problem: missing a target is an outcome, not an error.
#[derive(Clone, Debug, PartialEq)]
pub struct IkReport {
    /// Why the solver stopped.
    pub outcome: IkOutcome,
    /// How many iterations were made, from all starts together if a solver tried several.
    pub iterations: u32,
    /// How far each effector is from its target in the pose that was left, in the order of the targets.
    /// Empty if a target was invalid.
    pub residuals: Vec<IkResidual>,
    /// The joints that are at a limit in the pose that was left, from the base on.
    pub joints_at_limit: Vec<JointId>,
    /// The way there, if it was asked for.
    pub trace: Option<IkTrace>,
}

impl IkReport {
    /// The largest distance between an effector and its target, in the file's unit; 0 without targets.
    pub fn largest_distance(&self) -> f64 {
        self.residuals
            .iter()
            .map(|residual| residual.distance)
            .fold(0.0, f64::max)
    }

    /// The largest angle between an effector's orientation and its target's.
    pub fn largest_angle_rad(&self) -> f64 {
        self.residuals
            .iter()
            .map(|residual| residual.angle_rad)
            .fold(0.0, f64::max)
    }
}
