//! What is to be brought where: an effector's point, or its joint once that has its orientation.

use glam::{DQuat, DVec3};

use super::{Linkage, NONE};
use crate::ik::limit::JointLimit;
use crate::ik::problem::{Base, IkProblem};
use crate::ik::target::IkTarget;
use crate::ik::trace::{TraceIteration, TraceUpdate};
use crate::ik::turn::shortened;
use crate::pose::LocalPose;
use crate::rotation::log;
use crate::skeleton::Skeleton;

/// What of an effector is brought to its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Goal {
    /// Its point.
    Point,
    /// Its joint, which has taken the orientation of the target and keeps it: the last pivot of the way
    /// is out of the game.
    OrientedJoint,
}

impl Goal {
    /// Whether the effector's own joint was oriented.
    pub(crate) fn is_oriented(self) -> bool {
        self == Self::OrientedJoint
    }
}

impl Linkage {
    /// Gives an effector that has a joint of its own the orientation that its target asks for, as far as
    /// limits allow, and says what is then to be brought to its place. Nothing but that joint's turn is
    /// changed.
    pub(crate) fn orient(&mut self, index: usize, target: &IkTarget) -> Goal {
        let effector = self.effectors[index];
        let Some(wanted) = target
            .orientation_in_world
            .filter(|_| effector.is_own_pivot && target.orientation_weight > 0.0)
        else {
            return Goal::Point;
        };
        let k = effector.pivot as usize;
        let turn = wanted.normalize() * effector.orientation_start.conjugate();
        let turn = shortened(self.turns[k], turn, self.pivots[k].give);
        self.set_turn(k, turn);
        Goal::OrientedJoint
    }

    /// Where the point is that is brought to its place.
    pub(crate) fn goal_point(&self, index: usize, goal: Goal) -> DVec3 {
        match goal {
            Goal::Point => self.effector_position(index),
            Goal::OrientedJoint => self.positions[self.effectors[index].pivot as usize],
        }
    }

    /// The place to which it is brought.
    pub(crate) fn goal_position(&self, index: usize, target: &IkTarget, goal: Goal) -> DVec3 {
        let effector = &self.effectors[index];
        match goal {
            Goal::Point => target.position_in_world,
            Goal::OrientedJoint => {
                target.position_in_world - self.turns[effector.pivot as usize] * effector.offset
            }
        }
    }

    /// The pivots that bring it there, from the base on.
    pub(crate) fn goal_path(&self, index: usize, goal: Goal) -> core::ops::Range<usize> {
        let effector = &self.effectors[index];
        if effector.pivot == NONE {
            return effector.path_start..effector.path_start;
        }
        effector.path_start..effector.path_end - usize::from(goal.is_oriented())
    }

    /// A turn that pivot `k` has just made, as it is recorded. The points in the world are those of the
    /// effector before and after it, and the goal.
    pub(crate) fn trace_turn(
        &self,
        k: usize,
        target: usize,
        turn: DQuat,
        [before, after, goal]: [DVec3; 3],
        start: &LocalPose,
    ) -> TraceUpdate {
        let vector = log(turn);
        let pivot_in_world = self.positions[k];
        TraceUpdate {
            joint: self.pivots[k].joint,
            target,
            pivot_in_world,
            to_effector: before - pivot_in_world,
            to_target: goal - pivot_in_world,
            axis_in_world: vector.normalize_or_zero(),
            amount: vector.length(),
            effector_in_world: after,
            distance: after.distance(goal),
            moved: self.moved_joint(k, start),
        }
    }

    /// Completes the record of an iteration with the pose and the residuals that it led to.
    pub(crate) fn end_iteration(
        &self,
        start: &LocalPose,
        skeleton: &Skeleton,
        problem: &IkProblem,
        record: &mut TraceIteration,
    ) {
        self.list_moved(start, skeleton, &mut record.pose);
        let targets = problem.targets.iter().enumerate();
        record.residuals = targets
            .map(|(index, target)| self.residual(index, target))
            .collect();
    }

    /// Carries each floating root by the mean of what its effectors miss, by their weights; the longest
    /// way that one was carried.
    pub(crate) fn float(&mut self, problem: &IkProblem) -> f64 {
        let mut longest = 0.0_f64;
        if problem.base != Base::Free {
            return longest;
        }
        for k in 0..self.pivots.len() {
            let (mut missing, mut total) = (DVec3::ZERO, 0.0);
            for (index, target) in problem.targets.iter().enumerate() {
                let first = self.path(index).first().map(|&first| first as usize);
                if self.pivots[k].is_afloat && first == Some(k) {
                    let at = self.effector_position(index);
                    missing += (target.position_in_world - at) * target.position_weight;
                    total += target.position_weight;
                }
            }
            if total > 0.0 {
                let by = missing / total;
                self.shifts[k] += by;
                longest = longest.max(by.length());
            }
        }
        self.place();
        longest
    }

    /// Whether this is one chain of joints that turn freely, with a position to reach and no pole: the
    /// case for which solvers have shorter ways.
    pub(crate) fn is_free_chain(&self, problem: &IkProblem) -> bool {
        let [target] = problem.targets.as_slice() else {
            return false;
        };
        target.orientation_in_world.is_none()
            && target.position_weight > 0.0
            && problem.poles.is_empty()
            && !self.pivots.is_empty()
            && self.pivots.iter().all(|pivot| {
                pivot.turns
                    && !pivot.is_afloat
                    && pivot.give >= 1.0
                    && matches!(pivot.limit, JointLimit::Free)
            })
    }
}
