//! FABRIK: forward and backward reaching.
//!
//! The chain's points are moved, not its angles: from the target inward, each point to where its bone puts
//! it on the line to where it was; then from the base outward in the same way (Aristidou and Lasenby 2011,
//! "FABRIK: A fast, iterative solver for the Inverse Kinematics problem", Graphical Models 73(5),
//! doi:10.1016/j.gmod.2011.05.003). Joint rotations are recovered from the points.
//!
//! **Extensions.** Several targets on a tree: where chains meet, the place that each of them asks for is
//! averaged by the weights of the targets beyond, and the link there takes the rotation that fits all of
//! them best. Joint limits of all kinds, in both passes: each link's rotation is recovered as the pass
//! reaches it, brought within the limits of the joint, and the next point follows from that (Aristidou,
//! Chrysanthou and Lasenby 2016, "Extending FABRIK with model constraints", Computer Animation and Virtual
//! Worlds 27(1), doi:10.1002/cav.1609). Orientation targets, as in that paper, hold the last link as it
//! should be turned. Sliding joints slide by what is missing along their axis after each iteration.
//!
//! **Rotations.** A joint's link is turned from where its parent's turn carries it, by the least angle that
//! brings its next point in place: there is no twist that was not there before.
//!
//! **Guarantees and degenerate inputs.** A single chain without limits is stretched straight to a target
//! out of reach in one step; within reach no iteration leads away from the target, since a point moves no
//! farther in a pass than the one before it did. With limits or several targets a pass may lead away: the best
//! of all iterations is kept, so that more of them never leave more. Where nothing moves short of the target (a
//! target straight along the chain) every joint is bent a little, now and again; never where the chain has
//! arrived. Points that coincide stay together.
//!
//! **Cost.** A square root and a division for each bone and pass; with limits, the recovery of a rotation as
//! well.

mod chain;
mod points;
mod tree;

use super::problem::{IkProblem, TraceDetail};
use super::pull::Pull;
use super::solve::Progress;
use super::trace::IkTrace;
use super::workspace::IkWorkspace;
use crate::pose::LocalPose;
use crate::skeleton::Skeleton;

pub use points::fabrik_points;
pub(super) use tree::Scratch;

/// How FABRIK is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FabrikConfig {
    /// An iteration that brings the effectors nearer by less than this share of the tolerance has come to
    /// rest, three times in a row.
    pub rest_share: f64,
}

impl Default for FabrikConfig {
    fn default() -> Self {
        Self { rest_share: 1e-3 }
    }
}

/// What is solved.
struct Figure<'a> {
    skeleton: &'a Skeleton,
    pose: &'a LocalPose,
    problem: &'a IkProblem,
    config: &'a FabrikConfig,
    pull: Option<Pull<'a>>,
}

/// Runs FABRIK on the linkage of the workspace.
pub(crate) fn run(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    config: &FabrikConfig,
    workspace: &mut IkWorkspace,
) -> Progress {
    let progress = Progress {
        trace: (problem.trace == TraceDetail::Updates).then(IkTrace::default),
        ..Progress::default()
    };
    let pull = Pull::new(skeleton, pose, problem);
    let IkWorkspace {
        linkage, fabrik, ..
    } = workspace;
    if pull.is_none() && linkage.is_free_chain(problem) {
        return chain::run(
            &Figure {
                skeleton,
                pose,
                problem,
                config,
                pull,
            },
            linkage,
            fabrik,
            progress,
        );
    }
    let figure = Figure {
        skeleton,
        pose,
        problem,
        config,
        pull,
    };
    tree::run(&figure, linkage, fabrik, progress)
}
