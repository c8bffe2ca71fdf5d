//! Levenberg-Marquardt from more than one start.
//!
//! A solver that goes downhill ends in the valley that it starts in: a limb stretched in front of its limit, a
//! range that would have to be crossed the other way round. Where the first way ends short of the targets, the
//! figure starts again from other poses within its limits, near ones and far ones, and the best of all is left
//! (as for robots: Beeson and Ames 2015, "TRAC-IK: An Open-Source Library for Improved Solving of Generic Inverse
//! Kinematics"). The poses come from a fixed seed: the same problem has the same solution.
//!
//! Another start replaces the pose only where that is worth a jump: it reaches the targets, or, with one place to
//! reach, comes nearer by more than a two-hundredth and more than the tolerance. Targets that contradict each other
//! leave the figure where the first way ended.

use super::figure::{Figure, FigureParts};
use super::levenberg::{LevenbergMarquardtConfig, Patience, minimize};
use super::model::{Model, Taken};
use super::system::System;
use super::{Iterations, Memory};
use crate::ik::limit::{Interval, JointLimit};
use crate::ik::linkage::{Linkage, State};
use crate::ik::problem::IkProblem;
use crate::ik::random::Random;
use crate::ik::workspace::IkWorkspace;
use crate::pose::LocalPose;
use crate::skeleton::Skeleton;

/// The most starts of a small figure, the first one included.
const MOST_STARTS: usize = 48;

/// Larger ones, with more joints and targets, get fewer: so many joints are started in all, each counted for
/// every target.
const STARTED_JOINTS: usize = 480;

/// But at least so many starts.
const FEWEST_STARTS: usize = 6;

/// So many iterations of the first way are enough: one that has not arrived then is as good as at rest.
const ENOUGH: u32 = 100;

/// The most iterations from another start: most that arrive do so in ten. Not fewer where the problem says so, or
/// more iterations could lead to another pose that is farther away.
const ITERATIONS: u32 = 40;

/// How far other starts lie from the best pose, as shares of the way to random ones: in turn.
const SHARES: [f64; 4] = [0.3, 1.0, 0.6, 1.0];

/// The most iterations that go on with the best start.
const POLISHING_ITERATIONS: u32 = 100;

/// The share of the residual that another start has to save to be worth a jump.
const WORTH_SHARE: f64 = 0.005;

/// Minimises from where the figure is and, if that comes to rest short of the targets, from other poses.
pub(super) fn minimize_anywhere(
    model: &mut Figure<'_>,
    system: &mut System,
    config: &LevenbergMarquardtConfig,
    most: u32,
) -> Iterations {
    let mut made = minimize(
        model,
        system,
        config,
        &Patience::of_figure(most.min(ENOUGH)),
    );
    let is_over = made.is_settled || made.count >= ENOUGH;
    if is_over && model.is_short() && !model.is_plainly_out_of_reach() {
        made.count += search(model, system, config);
        made.is_settled = true;
        made.has_searched = true;
    } else if !made.is_settled && most > ENOUGH {
        let last = minimize(model, system, config, &Patience::of_figure(most - ENOUGH));
        made.count += last.count;
        made.is_settled = last.is_settled;
    }
    made
}

/// Minimises from other poses and leaves the best, which may be the present one; how many iterations that took.
fn search(model: &mut Figure<'_>, system: &mut System, config: &LevenbergMarquardtConfig) -> u32 {
    let starts = (STARTED_JOINTS / model.size().max(1)).clamp(FEWEST_STARTS, MOST_STARTS);
    let patience = Patience::of_start(ITERATIONS);
    let least_gain = model.least_gain();
    let mut random = Random::seeded(0);
    let mut count = 0;
    let mut best = residual(model, system);
    let mut is_polished = true;
    model.store_best();
    model.be_exact();
    for start in 1..starts {
        // The first goes on from where the figure rests.
        if start > 1 {
            model.scatter(&mut random, SHARES[start % SHARES.len()]);
            model.record(Taken::Nothing);
            count += 1;
        }
        count += minimize(model, system, config, &patience).count;
        if !model.is_short() {
            // Goes on to the last digit, if no tolerance ends that sooner.
            let patience = Patience::of_figure(POLISHING_ITERATIONS);
            return count + minimize(model, system, config, &patience).count;
        }
        let now = residual(model, system);
        let is_nearer = now < best * (1.0 - WORTH_SHARE) && now < best - least_gain;
        if is_nearer && model.is_for_one_place() {
            best = now;
            model.store_best();
            is_polished = false;
        }
        model.recall_best();
    }
    model.record(Taken::Nothing);
    if !is_polished {
        let patience = Patience::of_figure(POLISHING_ITERATIONS);
        count += minimize(model, system, config, &patience).count;
    }
    count
}

fn residual(model: &Figure<'_>, system: &mut System) -> f64 {
    model.find_residual(system);
    system.cost().sqrt()
}

/// Whether limits keep a figure that rests short of its targets from reaching them: no start within the limits
/// reaches them (where `has_searched` says that this is known already, none is tried), and without limits they are
/// reached. The linkage of the workspace, which holds the figure, is left as it is.
pub(crate) fn are_limits_in_the_way(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    has_searched: bool,
    workspace: &mut IkWorkspace,
) -> bool {
    let IkWorkspace {
        linkage,
        least_squares: memory,
        ..
    } = workspace;
    let mut home = State::default();
    home.store(linkage);
    let is_elsewhere = !has_searched && reaches(skeleton, pose, problem, linkage, memory);
    linkage.recall(&home);
    if is_elsewhere {
        return false;
    }
    let limits: Vec<JointLimit> = linkage.pivots.iter().map(|pivot| pivot.limit).collect();
    for pivot in &mut linkage.pivots {
        pivot.limit = match pivot.limit {
            JointLimit::Slide { axis, .. } => JointLimit::Slide {
                axis,
                distance: Interval::ALL,
            },
            JointLimit::Fixed => JointLimit::Fixed,
            _ => JointLimit::Free,
        };
    }
    let is_free = reaches(skeleton, pose, problem, linkage, memory);
    for (pivot, limit) in linkage.pivots.iter_mut().zip(limits) {
        pivot.limit = limit;
    }
    linkage.recall(&home);
    is_free
}

/// Whether the figure reaches its targets from any start.
fn reaches(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    linkage: &mut Linkage,
    memory: &mut Memory,
) -> bool {
    let config = LevenbergMarquardtConfig::default();
    let parts = FigureParts {
        skeleton,
        start: pose,
        problem,
        linkage,
        memory: &mut memory.figure,
    };
    let mut model = Figure::new(parts, config.radian_share).untraced();
    minimize_anywhere(&mut model, &mut memory.system, &config, ENOUGH);
    !model.is_short()
}
