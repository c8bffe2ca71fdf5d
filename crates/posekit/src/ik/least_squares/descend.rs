//! The solvers that take every step as it comes: transpose, damped and selectively damped least squares.

use core::f64::consts::FRAC_PI_4;

use super::Iterations;
use super::model::{Model, Taken};
use super::svd::Svd;
use super::system::System;

/// Which way the Jacobian transpose goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum DescentDirection {
    /// Along the gradient, as published: to and fro across valleys, so that several targets take
    /// thousands of iterations.
    Steepest,
    /// Along directions that do not undo each other (Polak and Ribiere 1969): the same cost an iteration and
    /// a fraction of the iterations.
    #[default]
    Conjugate,
}

/// How the Jacobian transpose is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JacobianTransposeConfig {
    /// Which way each iteration goes.
    pub direction: DescentDirection,
    /// The most that a joint turns in one iteration, radians (or slides, in length units).
    pub max_step: f64,
    /// The share of the longest chain's length that a radian of missing orientation counts as much as.
    pub radian_share: f64,
}

impl Default for JacobianTransposeConfig {
    fn default() -> Self {
        Self {
            direction: DescentDirection::default(),
            max_step: FRAC_PI_4,
            radian_share: 0.3,
        }
    }
}

/// How damped least squares is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DampedLeastSquaresConfig {
    /// The damping `d` where nothing is missing, in lengths of the longest chain a radian. Less is faster
    /// near the target.
    pub damping: f64,
    /// The most of a residual that one iteration goes for, in lengths of the longest chain (Buss 2004).
    pub max_residual: f64,
    /// The most that a joint turns in one iteration, radians (or slides, in length units).
    pub max_step: f64,
    /// The share of the longest chain's length that a radian of missing orientation counts as much as.
    pub radian_share: f64,
}

impl Default for DampedLeastSquaresConfig {
    fn default() -> Self {
        Self {
            damping: 0.1,
            max_residual: 0.5,
            max_step: FRAC_PI_4,
            radian_share: 0.3,
        }
    }
}

/// How selectively damped least squares is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectivelyDampedConfig {
    /// The most that a joint turns in one iteration: the `gamma_max` of Buss and Kim, radians (or length
    /// units, for slides).
    pub max_step: f64,
    /// The most of a residual that one iteration goes for, in lengths of the longest chain.
    pub max_residual: f64,
    /// The share of the longest chain's length that a radian of missing orientation counts as much as.
    pub radian_share: f64,
}

impl Default for SelectivelyDampedConfig {
    fn default() -> Self {
        Self {
            max_step: FRAC_PI_4,
            max_residual: 0.5,
            radian_share: 0.3,
        }
    }
}

/// A step shorter than this moves nothing that a pose could hold.
const AT_REST: f64 = 1e-11;

/// How often a figure that stands still short of its targets is bent.
const MOST_NUDGES: usize = 6;

/// How many iterations in a row that do not better the best residual mean that no more will.
const MOST_WITHOUT_GAIN: u32 = 24;

/// The gradient and the direction of the iteration before.
#[derive(Clone, Debug, Default)]
pub(crate) struct Way {
    gradient: Vec<f64>,
    direction: Vec<f64>,
}

impl Way {
    /// Adds to a gradient what makes it conjugate to the direction before, and remembers both.
    fn make_conjugate(&mut self, step: &mut [f64]) {
        let is_same = self.gradient.len() == step.len();
        let (mut change, mut square) = (0.0, 0.0);
        if is_same {
            for (new, old) in step.iter().zip(&self.gradient) {
                change += new * (new - old);
                square += old * old;
            }
        }
        self.gradient.clear();
        self.gradient.extend_from_slice(step);
        // Where the directions lost their meaning it starts again along the gradient.
        let share = if square > 0.0 {
            (change / square).max(0.0)
        } else {
            0.0
        };
        let mut along = 0.0;
        if share > 0.0 && share.is_finite() {
            for (step, old) in step.iter_mut().zip(&self.direction) {
                along += *step * (*step + share * old);
                *step += share * old;
            }
        }
        if along < 0.0 {
            step.copy_from_slice(&self.gradient);
        }
        self.direction.clear();
        self.direction.extend_from_slice(step);
    }
}

/// The Jacobian transpose.
pub(crate) fn transpose<M: Model>(
    model: &mut M,
    system: &mut System,
    way: &mut Way,
    config: &JacobianTransposeConfig,
    most: u32,
) -> Iterations {
    way.gradient.clear();
    way.direction.clear();
    iterate(model, system, most, |system| {
        system.step_along_gradient();
        if config.direction == DescentDirection::Conjugate {
            way.make_conjugate(&mut system.step);
        }
        system.fit_step_length();
        system.shorten_step(config.max_step);
        true
    })
}

/// Damped least squares.
pub(crate) fn damped<M: Model>(
    model: &mut M,
    system: &mut System,
    config: &DampedLeastSquaresConfig,
    most: u32,
) -> Iterations {
    let least = (config.damping * config.damping).max(1e-12);
    iterate(model, system, most, |system| {
        clamp_residual(system, config.max_residual);
        // Without the residual's part an arm that is stretched to a target out of reach would tremble: the
        // joints' effect vanishes there, and their steps grow with the residual over the damping.
        let damping = least + system.cost().sqrt();
        let is_solved = system.solve(damping);
        system.shorten_step(config.max_step);
        is_solved
    })
}

/// Selectively damped least squares.
pub(crate) fn selectively_damped<M: Model>(
    model: &mut M,
    system: &mut System,
    svd: &mut Svd,
    config: &SelectivelyDampedConfig,
    most: u32,
) -> Iterations {
    iterate(model, system, most, |system| {
        clamp_residual(system, config.max_residual);
        select(system, svd, config.max_step);
        true
    })
}

/// Shortens each target's residual to `most`; far targets are then approached straight on.
fn clamp_residual(system: &mut System, most: f64) {
    for part in system.residual.chunks_exact_mut(3) {
        let length = part.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > most {
            for x in part {
                *x *= most / length;
            }
        }
    }
}

/// Takes steps until all targets are reached, nothing moves, nothing gets better, or `most` are taken; the best
/// state that they led to is left.
fn iterate<M: Model>(
    model: &mut M,
    system: &mut System,
    most: u32,
    mut solve: impl FnMut(&mut System) -> bool,
) -> Iterations {
    let mut made = Iterations::default();
    let (mut nudges, mut without_gain) = (0, 0);
    let mut best = f64::INFINITY;
    let mut least = Least::default();
    while made.count < most && !model.is_reached() {
        model.find_residual(system);
        let cost = system.cost();
        least.note(model, cost);
        // A millionth part better is better.
        if cost < best * (1.0 - 1e-6) {
            best = cost;
            without_gain = 0;
        } else {
            without_gain += 1;
        }
        model.linearize(system);
        let moves = solve(system) && system.largest_step() > AT_REST;
        if !moves || without_gain > MOST_WITHOUT_GAIN {
            model.save();
            if !model.is_short() || nudges == MOST_NUDGES || !model.nudge(nudges) {
                made.is_settled = true;
                break;
            }
            model.record(Taken::Nothing);
            nudges += 1;
            made.count += 1;
            (best, without_gain) = (f64::INFINITY, 0);
            continue;
        }
        model.save();
        model.advance(&system.step);
        model.record(Taken::Step);
        made.count += 1;
    }
    if !model.is_reached() {
        model.find_residual(system);
        least.leave(model, system.cost());
    }
    made
}

/// The least cost so far and the state that has it, which is copied only when a step leads away from it.
#[derive(Debug)]
struct Least {
    cost: f64,
    is_kept: bool,
}

impl Default for Least {
    fn default() -> Self {
        Self {
            cost: f64::INFINITY,
            is_kept: false,
        }
    }
}

impl Least {
    /// Notes the cost of the present state; the one before it is the model's saved one.
    fn note<M: Model>(&mut self, model: &mut M, cost: f64) {
        if cost < self.cost {
            *self = Self {
                cost,
                is_kept: false,
            };
        } else if !self.is_kept && self.cost.is_finite() {
            model.keep_saved();
            self.is_kept = true;
        }
    }

    /// Goes back to the best state if the present one, of this cost, is worse.
    fn leave<M: Model>(mut self, model: &mut M, cost: f64) {
        self.note(model, cost);
        if self.is_kept && cost > self.cost {
            model.restore_kept();
            model.record(Taken::Nothing);
        }
    }
}

/// The step of Buss and Kim (2005): along each right singular vector as far as their bound `gamma`, which
/// is small where a small motion of effectors asks for a large one of joints.
fn select(system: &mut System, svd: &mut Svd, most: f64) {
    let (rows, degrees) = (system.row_count(), system.degree_count());
    svd.start(rows, degrees);
    let matrix = svd.matrix_mut();
    // `J sqrt(P)`: stiff joints count as ones that have less effect.
    system.for_every_entry(|degree, row, value| {
        let value = value * system.weight(degree).sqrt();
        matrix[row * degrees + degree] = value.x;
        matrix[(row + 1) * degrees + degree] = value.y;
        matrix[(row + 2) * degrees + degree] = value.z;
    });
    svd.decompose();
    let mut step = std::mem::take(&mut system.step);
    step.clear();
    step.resize(degrees, 0.0);
    let largest = (0..svd.count()).map(|i| svd.value(i)).fold(0.0, f64::max);
    for index in 0..svd.count() {
        let value = svd.value(index);
        // Also where nothing moves at all and both are zero.
        if value <= 1e-12 * largest || value.is_nan() {
            continue;
        }
        let left = svd.left(index);
        let along: f64 = left.iter().zip(&system.residual).map(|(u, e)| u * e).sum();
        // N: how far a step along this direction carries the effectors.
        let carried: f64 = left.chunks_exact(3).map(length).sum();
        // M: how far it would if all joints' effects added up.
        let mut added_up = 0.0;
        system.for_every_entry(|degree, _, entry| {
            let right = svd.scaled_right(index)[degree] / value;
            added_up += right.abs() * entry.length();
        });
        added_up /= value;
        let bound = (carried / added_up).min(1.0) * most;
        let scale = along / (value * value);
        let right = svd.scaled_right(index);
        let reach = right.iter().fold(0.0_f64, |most, x| most.max(x.abs())) * scale.abs();
        let scale = if reach > bound {
            scale * bound / reach
        } else {
            scale
        };
        for (step, right) in step.iter_mut().zip(right) {
            *step += scale * right;
        }
    }
    for (degree, step) in step.iter_mut().enumerate() {
        *step *= system.weight(degree).sqrt();
    }
    system.step = step;
    system.bound_step();
    system.shorten_step(most);
}

fn length(part: &[f64]) -> f64 {
    part.iter().map(|x| x * x).sum::<f64>().sqrt()
}
