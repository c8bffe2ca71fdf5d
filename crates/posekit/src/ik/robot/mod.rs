//! Inverse kinematics of robots: values of a [`Mechanism`]'s joints that bring links to targets.
//!
//! The same problem as for figures, told in the robot's own numbers: angles and lengths in `f64` instead of
//! a pose, ranges that hold exactly, joints that follow others. [`solve_robot`] minimises with
//! Levenberg-Marquardt ([`LevenbergMarquardtConfig`]) from the values that it is given, and, where that ends
//! in a local minimum or in front of a limit, again from random ones: a way into another branch of the
//! robot's solutions (as TRAC-IK does: Beeson and Ames 2015, "TRAC-IK: An Open-Source Library for Improved
//! Solving of Generic Inverse Kinematics").
//!
//! [`jacobian`], [`Dexterity`] and [`range_margins`] say how well a robot can move from where it stands;
//! [`TwoLink`] is the planar arm of the textbooks, solved in closed form; [`ways_to`] finds all ways to one target.
//!
//! Space and units: targets are in the world, as everywhere; for a robot from a URDF file that is the world
//! of its [`Mechanism`], Y up or not. Radians, and the mechanism's unit of length.
//!
//! Cost: 10 to 30 iterations for a random pose, of one or two microseconds each; nothing is allocated once the
//! workspace has grown but the ranges and the report.

mod dexterity;
mod tree;
mod two_link;
mod ways;

use super::least_squares::{LevenbergMarquardtConfig, Model, Patience, System, minimize};
use super::problem::StopRule;
use super::random::Random;
use super::report::{IkOutcome, IkResidual};
use super::target::IkTarget;
use crate::mechanism::Mechanism;
use crate::skeleton::JointId;
use tree::{RobotModel, Tree};

pub use dexterity::{Dexterity, RangeMargin, Task, TipJacobian, jacobian, range_margins};
pub use two_link::{TwoLink, TwoLinkSolutions};
pub use ways::{Ways, WaysConfig, WaysMethod, ways_to};

/// How [`solve_robot`] is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotConfig {
    /// When a target counts as reached, and the most iterations of one attempt. Where none reaches the
    /// targets, some hundred more bring the best one as near as it gets.
    pub stop: StopRule,
    /// How often it may start, at least once: from the values given, then from random ones.
    pub max_attempts: u32,
    /// What the random values are made from; the same seed gives the same solution.
    pub seed: u64,
    /// The solver itself.
    pub levenberg: LevenbergMarquardtConfig,
}

impl Default for RobotConfig {
    /// To a micrometre (where the unit is the metre) and a microradian, with up to 200 attempts.
    fn default() -> Self {
        Self {
            stop: StopRule {
                position_tolerance: 1e-6,
                rest_tolerance: 1e-6,
                orientation_tolerance_rad: 1e-6,
                max_iterations: 40,
            },
            max_attempts: 200,
            seed: 0,
            levenberg: LevenbergMarquardtConfig::default(),
        }
    }
}

/// What came of [`solve_robot`].
#[derive(Clone, Debug, PartialEq)]
pub struct RobotReport {
    /// Why it stopped. Never [`OutOfReach`](IkOutcome::OutOfReach), which is not known of a robot:
    /// it [`Stalled`](IkOutcome::Stalled).
    pub outcome: IkOutcome,
    /// How many iterations were made in all attempts.
    pub iterations: u32,
    /// How many attempts were made; 1 when the first one, from the values given, reached the targets.
    pub attempts: u32,
    /// How far each effector is from its target with the values that were left.
    pub residuals: Vec<IkResidual>,
    /// The joints whose own values are at an end of their ranges.
    pub joints_at_limit: Vec<JointId>,
}

/// Memory of [`solve_robot`], which may be used again for any robot and any targets.
#[derive(Clone, Debug, Default)]
pub struct RobotWorkspace {
    system: System,
    tree: Tree,
    best: Vec<f64>,
}

impl RobotWorkspace {
    /// A workspace that has not been used yet.
    pub fn new() -> Self {
        Self::default()
    }
}

/// How near an end of its range a value counts as being at it.
const AT_LIMIT: f64 = 1e-9;

/// An attempt is given up when so many iterations in a row gain less than a share of the residual's square:
/// starting again finds a solution sooner than waiting for a local minimum to settle.
const ATTEMPT_SLOW_IN_ROW: u32 = 3;
/// See [`ATTEMPT_SLOW_IN_ROW`].
const ATTEMPT_SLOW_GAIN: f64 = 0.03;

/// How many iterations go on with the best attempt where none reached the targets.
const POLISHING_ITERATIONS: u32 = 300;

/// Finds values that bring links of a robot to their targets, starting from `values`, and leaves the best
/// that it found there. Values that no target depends on stay as they are; those outside their ranges are
/// brought within them first.
///
/// # Panics
/// If there are not as many values as the mechanism has, or a target names a joint that it has not.
pub fn solve_robot(
    mechanism: &Mechanism,
    values: &mut [f64],
    targets: &[IkTarget],
    config: &RobotConfig,
    workspace: &mut RobotWorkspace,
) -> RobotReport {
    let RobotWorkspace { system, tree, best } = workspace;
    tree.compile(mechanism, targets);
    let invalid = targets.iter().position(|target| !target.is_valid());
    let mut model = RobotModel::new(tree, targets, config.stop, config.levenberg.radian_share);
    model.set_values(values);
    let mut random = Random::seeded(config.seed);
    let (mut iterations, mut attempts) = (0, 0);
    let mut least = f64::INFINITY;
    let mut outcome = match invalid {
        Some(target) => IkOutcome::InvalidTarget { target },
        None => IkOutcome::Stalled,
    };
    while invalid.is_none() && attempts < config.max_attempts.max(1) {
        if attempts > 0 {
            model.randomize(&mut random);
        }
        attempts += 1;
        let patience = Patience {
            most: config.stop.max_iterations,
            slow_gain: ATTEMPT_SLOW_GAIN,
            slow_step: f64::INFINITY,
            slow_in_row: ATTEMPT_SLOW_IN_ROW,
        };
        iterations += minimize(&mut model, system, &config.levenberg, &patience).count;
        let is_reached = model.is_reached();
        model.find_residual(system);
        let cost = system.cost();
        if is_reached || cost < least {
            least = cost;
            best.clear();
            best.extend_from_slice(values);
            model.write_values(best);
        }
        if is_reached {
            outcome = IkOutcome::Reached;
            break;
        }
    }
    if invalid.is_none() {
        values.copy_from_slice(best);
        model.set_values(values);
        if !outcome.is_reached() {
            // Attempts are given up early; the best one is worth going on with.
            let patience = Patience::of_figure(POLISHING_ITERATIONS);
            let made = minimize(&mut model, system, &config.levenberg, &patience);
            iterations += made.count;
            model.write_values(values);
            model.set_values(values);
            outcome = match (model.is_reached(), made.is_settled) {
                (true, _) => IkOutcome::Reached,
                (false, true) => IkOutcome::Stalled,
                (false, false) => IkOutcome::IterationLimit,
            };
        }
    }
    let residuals = model.residuals();
    if outcome == IkOutcome::Stalled && are_limits_in_the_way(&mut model, values, system, config) {
        outcome = IkOutcome::LimitsInTheWay;
    }
    RobotReport {
        outcome,
        iterations,
        attempts,
        residuals,
        joints_at_limit: joints_at_limit(mechanism, values),
    }
}

/// How many starts say whether ranges are in the way, within them and without them each.
const STARTS_TO_BLAME: u32 = 20;

/// Whether the ranges are what keeps a robot, which came to rest at `values`, from its targets: without them some start
/// reaches the targets, and within them none does. What the robot does not need for its targets may be at an end of its
/// range for all that.
fn are_limits_in_the_way(
    model: &mut RobotModel<'_>,
    values: &[f64],
    system: &mut System,
    config: &RobotConfig,
) -> bool {
    if !model.is_at_limit(AT_LIMIT) {
        return false;
    }
    let mut random = Random::seeded(config.seed);
    let patience = Patience {
        most: config.stop.max_iterations,
        slow_gain: ATTEMPT_SLOW_GAIN,
        slow_step: f64::INFINITY,
        slow_in_row: ATTEMPT_SLOW_IN_ROW,
    };
    // Where it was searched long enough, it is known that no start within the ranges gets there.
    let is_searched = config.max_attempts >= STARTS_TO_BLAME;
    let mut is_reached_from_somewhere = |model: &mut RobotModel<'_>| {
        (0..STARTS_TO_BLAME).any(|_| {
            minimize(model, system, &config.levenberg, &patience);
            let is_reached = model.is_reached();
            if !is_reached {
                model.randomize(&mut random);
            }
            is_reached
        })
    };
    if !is_searched && is_reached_from_somewhere(model) {
        return false;
    }
    model.forget_ranges();
    model.set_values(values);
    is_reached_from_somewhere(model)
}

fn joints_at_limit(mechanism: &Mechanism, values: &[f64]) -> Vec<JointId> {
    let margins = range_margins(mechanism, values).into_iter();
    margins
        .filter(|margin| margin.to_lower.min(margin.to_upper) <= AT_LIMIT)
        .map(|margin| margin.joint)
        .collect()
}
