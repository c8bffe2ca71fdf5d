//! The one entry to all solvers, and what they share: checking a problem, judging a result.

use super::aim;
use super::ccd::{self, CcdConfig};
use super::fabrik::{self, FabrikConfig};
use super::least_squares::{
    self, DampedLeastSquaresConfig, JacobianTransposeConfig, LevenbergMarquardtConfig,
    SelectivelyDampedConfig,
};
use super::linkage::{self, Linkage, NONE};
use super::problem::IkProblem;
use super::report::{IkOutcome, IkReport};
use super::target::IkTarget;
use super::trace::{IkTrace, TraceIteration};
use super::turn::swivel;
use super::two_bone::{self, TwoBoneConfig};
use super::workspace::IkWorkspace;
use crate::pose::LocalPose;
use crate::skeleton::Skeleton;

/// How near an end of its range a joint counts as being at it, in radians or length units.
const AT_LIMIT: f64 = 1e-6;

/// An orientation that is this near has been reached as far as a rest is concerned, whatever the tolerance.
const REST_RAD: f64 = 1e-6;

/// Which solver, and how it is set.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Solver {
    /// Cyclic coordinate descent.
    Ccd(CcdConfig),
    /// Forward and backward reaching.
    Fabrik(FabrikConfig),
    /// Two joints in closed form.
    TwoBone(TwoBoneConfig),
    /// One joint that looks at the target, in closed form.
    Aim,
    /// The transpose of the Jacobian: many cheap iterations.
    JacobianTranspose(JacobianTransposeConfig),
    /// Damped least squares.
    DampedLeastSquares(DampedLeastSquaresConfig),
    /// Selectively damped least squares.
    SelectivelyDamped(SelectivelyDampedConfig),
    /// Levenberg-Marquardt: few iterations, and the one for several targets.
    LevenbergMarquardt(LevenbergMarquardtConfig),
}

/// How far a solver came.
#[derive(Clone, Debug, Default)]
pub(crate) struct Progress {
    /// How many iterations it made.
    pub(crate) iterations: u32,
    /// Whether it came to rest: more iterations would change nothing.
    pub(crate) is_settled: bool,
    /// Whether it tried other starts, none of which reached the targets if the result does not.
    pub(crate) has_searched: bool,
    /// What was recorded.
    pub(crate) trace: Option<IkTrace>,
}

impl Progress {
    /// Completes the record of an iteration, if there is one, with where it led, and adds it to the trace.
    pub(crate) fn record(
        &mut self,
        linkage: &Linkage,
        skeleton: &Skeleton,
        pose: &LocalPose,
        problem: &IkProblem,
        record: Option<TraceIteration>,
    ) {
        if let (Some(trace), Some(mut record)) = (&mut self.trace, record) {
            linkage.end_iteration(pose, skeleton, problem, &mut record);
            trace.iterations.push(record);
        }
    }

    /// The end of a solver in closed form: chains swivel to their poles, and it rests after its one
    /// iteration. `record` is what was recorded of it, if anything was asked for.
    pub(crate) fn in_closed_form(
        linkage: &mut Linkage,
        skeleton: &Skeleton,
        pose: &LocalPose,
        problem: &IkProblem,
        record: Option<TraceIteration>,
    ) -> Self {
        swivel(linkage, problem);
        let trace = record.map(|mut record| {
            linkage.end_iteration(pose, skeleton, problem, &mut record);
            IkTrace {
                iterations: vec![record],
            }
        });
        Self {
            iterations: 1,
            is_settled: true,
            has_searched: false,
            trace,
        }
    }
}

/// Solves a problem with the figure in `pose`, which is both where the solver starts (a warm start, if it
/// is the pose of the frame before) and where it leaves the result. Joints that the problem does not
/// move keep their local transforms to the bit.
///
/// # Panics
/// If the pose has not as many joints as the skeleton, or the problem names a joint that the skeleton has
/// not.
pub fn solve(
    skeleton: &Skeleton,
    pose: &mut LocalPose,
    problem: &IkProblem,
    solver: &Solver,
    workspace: &mut IkWorkspace,
) -> IkReport {
    workspace.moved.clear();
    let invalid = problem.targets.iter().position(|target| !target.is_valid());
    if let Some(target) = invalid {
        return IkReport {
            outcome: IkOutcome::InvalidTarget { target },
            iterations: 0,
            residuals: Vec::new(),
            joints_at_limit: Vec::new(),
            trace: None,
        };
    }
    linkage::build(&mut workspace.linkage, skeleton, pose, problem);
    let progress = match solver {
        Solver::Ccd(config) => ccd::run(skeleton, pose, problem, config, workspace),
        Solver::Fabrik(config) => fabrik::run(skeleton, pose, problem, config, workspace),
        Solver::TwoBone(config) => two_bone::run(skeleton, pose, problem, config, workspace),
        Solver::Aim => aim::run(skeleton, pose, problem, workspace),
        Solver::JacobianTranspose(_)
        | Solver::DampedLeastSquares(_)
        | Solver::SelectivelyDamped(_)
        | Solver::LevenbergMarquardt(_) => {
            least_squares::run(skeleton, pose, problem, solver, workspace)
        }
    };
    write(skeleton, pose, workspace);
    let outcome = if *solver == Solver::Aim && aim::is_aimed(&workspace.linkage, problem) {
        IkOutcome::Reached
    } else {
        judge(skeleton, pose, problem, &progress, workspace)
    };
    report(&workspace.linkage, problem, outcome, progress)
}

/// Writes what moved to the pose.
fn write(skeleton: &Skeleton, pose: &mut LocalPose, workspace: &mut IkWorkspace) {
    let IkWorkspace { linkage, moved, .. } = workspace;
    linkage.list_moved(pose, skeleton, moved);
    for joint in moved.iter() {
        let index = joint.joint.index();
        pose.rotations[index] = joint.rotation.as_quat().normalize();
        pose.translations[index] = joint.translation.as_vec3();
    }
}

fn report(
    linkage: &Linkage,
    problem: &IkProblem,
    outcome: IkOutcome,
    progress: Progress,
) -> IkReport {
    let targets = problem.targets.iter().enumerate();
    let mut joints_at_limit = Vec::new();
    linkage.list_at_limit(AT_LIMIT, &mut joints_at_limit);
    IkReport {
        outcome,
        iterations: progress.iterations,
        residuals: targets
            .map(|(index, target)| linkage.residual(index, target))
            .collect(),
        joints_at_limit,
        trace: progress.trace,
    }
}

/// Whether every effector is within the tolerances of its target.
pub(crate) fn is_reached(linkage: &Linkage, problem: &IkProblem) -> bool {
    let stop = &problem.stop;
    is_within(
        linkage,
        problem,
        stop.position_tolerance,
        stop.orientation_tolerance_rad,
    )
}

/// Whether a solver that rests here is stuck, and did not simply come as near as numbers allow.
pub(crate) fn is_short(linkage: &Linkage, problem: &IkProblem) -> bool {
    let stop = &problem.stop;
    let angle_rad = stop.orientation_tolerance_rad.max(REST_RAD);
    !is_within(linkage, problem, rest_distance(problem), angle_rad)
}

/// The distance from which on a solver at rest is stuck.
pub(crate) fn rest_distance(problem: &IkProblem) -> f64 {
    if problem.stop.position_tolerance > 0.0 {
        problem.stop.position_tolerance
    } else {
        problem.stop.rest_tolerance
    }
}

fn is_within(linkage: &Linkage, problem: &IkProblem, distance: f64, angle_rad: f64) -> bool {
    problem.targets.iter().enumerate().all(|(index, target)| {
        let residual = linkage.residual(index, target);
        let is_near = target.position_weight == 0.0 || residual.distance <= distance;
        let is_aligned = target.orientation_weight == 0.0 || residual.angle_rad <= angle_rad;
        is_near && is_aligned
    })
}

/// By how much all targets are missed: the sum of squares of distances and, where orientations are asked
/// for, of angles, by weights. A radian counts as many tolerances as it holds.
pub(crate) fn miss(linkage: &Linkage, problem: &IkProblem) -> f64 {
    let per_rad = rest_distance(problem) / problem.stop.orientation_tolerance_rad.max(REST_RAD);
    let targets = problem.targets.iter().enumerate();
    targets
        .map(|(index, target)| {
            let residual = linkage.residual(index, target);
            let turned = per_rad * residual.angle_rad;
            target.position_weight * (residual.distance * residual.distance)
                + target.orientation_weight * (turned * turned)
        })
        .sum()
}

/// How far the target that is farthest out of reach lies beyond what its effector could get to if all
/// joints turned freely; 0 if all are within.
fn most_out_of_reach(linkage: &Linkage, problem: &IkProblem) -> f64 {
    let targets = problem.targets.iter().enumerate();
    targets
        .filter(|(_, target)| target.position_weight > 0.0)
        .map(|(index, target)| out_of_reach_by(linkage, index, target))
        .fold(0.0, f64::max)
}

/// Whether a target lies beyond its chain's reach by more than the tolerance.
pub(crate) fn is_out_of_reach(linkage: &Linkage, problem: &IkProblem) -> bool {
    most_out_of_reach(linkage, problem) > problem.stop.position_tolerance
}

fn judge(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    progress: &Progress,
    workspace: &mut IkWorkspace,
) -> IkOutcome {
    let linkage = &workspace.linkage;
    if is_reached(linkage, problem) {
        return IkOutcome::Reached;
    }
    let beyond = most_out_of_reach(linkage, problem);
    if beyond > problem.stop.position_tolerance {
        return IkOutcome::OutOfReach { by: beyond };
    }
    if !progress.is_settled {
        return IkOutcome::IterationLimit;
    }
    let mut at_limit = Vec::new();
    linkage.list_at_limit(AT_LIMIT, &mut at_limit);
    let has_searched = progress.has_searched;
    let are_in_the_way = !at_limit.is_empty()
        && is_short(linkage, problem)
        && least_squares::are_limits_in_the_way(skeleton, pose, problem, has_searched, workspace);
    if are_in_the_way {
        IkOutcome::LimitsInTheWay
    } else {
        IkOutcome::Stalled
    }
}

/// How far a target lies outside of what an effector could get to if all its joints turned freely: beyond
/// the stretched chain, or nearer to the base than its longest link lets it fold. 0 within.
fn out_of_reach_by(linkage: &Linkage, index: usize, target: &IkTarget) -> f64 {
    let effector = &linkage.effectors[index];
    let path = linkage.path(index);
    let Some(&first) = path.first() else {
        return effector.offset.distance(target.position_in_world);
    };
    let pivots = path.iter().map(|&pivot| &linkage.pivots[pivot as usize]);
    let is_bounded = |pivot: &linkage::Pivot| pivot.turns && !pivot.is_afloat;
    if !pivots.clone().all(is_bounded) {
        return 0.0;
    }
    let links = pivots
        .filter(|pivot| pivot.parent != NONE)
        .map(|pivot| pivot.offset.length());
    let (mut stretched, mut longest) = (0.0_f64, 0.0_f64);
    for length in links.chain(core::iter::once(effector.offset.length())) {
        stretched += length;
        longest = longest.max(length);
    }
    let folded = (2.0 * longest - stretched).max(0.0);
    let base = linkage.pivots[first as usize].position_start;
    let distance = base.distance(target.position_in_world);
    (distance - stretched).max(folded - distance).max(0.0)
}
