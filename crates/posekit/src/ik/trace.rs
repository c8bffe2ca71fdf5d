//! The way of a solver, step by step: enough to draw it as textbooks do and to play it again.

use glam::{DQuat, DVec3};

use super::report::IkResidual;
use crate::skeleton::JointId;

/// Every iteration of a solver, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IkTrace {
    /// The iterations. Where a solver went back at the end to the best pose that it had found, one more
    /// without updates.
    pub iterations: Vec<TraceIteration>,
}

/// One iteration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TraceIteration {
    /// What was done to joints, in the order in which it was done. Solvers that move all joints at once
    /// list each that moved.
    pub updates: Vec<TraceUpdate>,
    /// The pose after the iteration: the transforms of all joints that the problem may move.
    pub pose: Vec<MovedJoint>,
    /// How far each effector was from its target after the iteration.
    pub residuals: Vec<IkResidual>,
}

/// One joint's turn (or slide), seen in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceUpdate {
    /// The joint that moved.
    pub joint: JointId,
    /// Index of the target for which it did.
    pub target: usize,
    /// Where the joint was when it moved.
    pub pivot_in_world: DVec3,
    /// The vector a, from the joint to the effector, before the update.
    pub to_effector: DVec3,
    /// The vector b, from the joint to the target.
    pub to_target: DVec3,
    /// The axis of the turn, of unit length, in the world: the direction of `a x b` unless limits,
    /// stiffness or the solver changed it. Zero where nothing turned. For a slide its direction.
    pub axis_in_world: DVec3,
    /// The angle of the turn; for a slide its distance, in the file's unit.
    pub amount: f64,
    /// Where the effector's point was after the update.
    pub effector_in_world: DVec3,
    /// Its distance from the target then, in the file's unit.
    pub distance: f64,
    /// The joint's local transform after the update.
    pub moved: MovedJoint,
}

/// The local transform of a joint that a solver may move, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedJoint {
    /// The joint.
    pub joint: JointId,
    /// Its rotation in its parent's space, of unit length.
    pub rotation: DQuat,
    /// Its translation in its parent's space, in the file's unit.
    pub translation: DVec3,
}
