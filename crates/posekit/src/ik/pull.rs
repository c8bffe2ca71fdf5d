//! Joints drawn back to a pose that is preferred.

use glam::DQuat;

use super::linkage::Linkage;
use super::problem::{IkProblem, PreferredPose};
use super::turn::shortened;
use crate::pose::LocalPose;
use crate::skeleton::{JointId, Skeleton};

/// How much weaker the pull is in each iteration than in the one before: half after three.
const FADING: f64 = 0.8;

/// The pull of a problem.
pub(crate) struct Pull<'a> {
    strength: f64,
    pose: &'a LocalPose,
    skeleton: &'a Skeleton,
    is_to_rest: bool,
}

impl<'a> Pull<'a> {
    /// The pull that a problem asks for, if it does.
    pub(crate) fn new(
        skeleton: &'a Skeleton,
        start: &'a LocalPose,
        problem: &'a IkProblem,
    ) -> Option<Self> {
        let pull = problem.rest_pull.as_ref()?;
        let strength = pull.strength.clamp(0.0, 1.0);
        let pose = match &pull.toward {
            PreferredPose::Pose(pose) => pose,
            PreferredPose::Rest | PreferredPose::Start => start,
        };
        (strength > 0.0).then_some(Self {
            strength,
            pose,
            skeleton,
            is_to_rest: pull.toward == PreferredPose::Rest,
        })
    }

    /// The local rotation that a joint is drawn to.
    pub(crate) fn preferred(&self, joint: JointId) -> DQuat {
        let rotation = if self.is_to_rest {
            self.skeleton.rest_rotation(joint)
        } else {
            self.pose.rotations[joint.index()]
        };
        rotation.as_dquat().normalize()
    }

    /// Draws all joints their share of the way, as much as is left of the pull in this iteration.
    pub(crate) fn draw(&self, linkage: &mut Linkage, iteration: u32) {
        let share = self.strength * libm::pow(FADING, f64::from(iteration));
        if share < 1e-6 {
            return;
        }
        for k in 0..linkage.pivots.len() {
            let pivot = linkage.pivots[k];
            if !pivot.turns {
                continue;
            }
            let motion = pivot.rest.conjugate() * self.preferred(pivot.joint);
            let turn = pivot.turn_of_motion(linkage.inner_turn(k), motion);
            let drawn = shortened(linkage.turns[k], turn, share);
            linkage.set_turn(k, drawn);
        }
    }
}
