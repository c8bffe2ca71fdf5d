//! Levenberg-Marquardt.

use super::Iterations;
use super::model::{Model, Taken};
use super::system::System;

/// How Levenberg-Marquardt is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevenbergMarquardtConfig {
    /// The damping of the first iteration, as a multiple of the residual's square. Larger is slower and
    /// calmer far from the target.
    pub damping: f64,
    /// The most that a joint turns in one iteration, radians (or slides, in length units).
    pub max_step: f64,
    /// The share of the longest chain's length that a radian of missing orientation counts as much as.
    pub radian_share: f64,
}

impl Default for LevenbergMarquardtConfig {
    fn default() -> Self {
        Self {
            damping: 0.1,
            max_step: 1.0,
            radian_share: 0.3,
        }
    }
}

/// What the damping is at least, as a share of the Jacobian's own size: keeps the system solvable where
/// joints cannot move an effector in some direction.
const LEAST_DAMPING: f64 = 1e-13;

/// The multiple of the residual's square that the damping never exceeds: the step is then along the
/// gradient and shorter than rounding.
const MOST_DAMPING: f64 = 1e12;

/// Good steps lessen the damping to no less than a fifth (Nielsen has a third; the residual's square, which
/// multiplies it, lessens it as well).
const LEAST_FACTOR: f64 = 0.2;

/// A step shorter than this moves nothing that a pose could hold.
const AT_REST: f64 = 1e-11;

/// When iterations end without having reached the targets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience {
    /// The most iterations; every trial counts, those too that are taken back.
    pub(crate) most: u32,
    /// An iteration that gains less than this share of the residual's square is slow, if it also moves no
    /// joint by more than `slow_step`.
    pub(crate) slow_gain: f64,
    /// See `slow_gain`.
    pub(crate) slow_step: f64,
    /// So many slow iterations in a row have come to rest short of the target.
    pub(crate) slow_in_row: u32,
}

impl Patience {
    /// That of one who has nowhere else to start from.
    pub(crate) fn of_figure(most: u32) -> Self {
        Self {
            most,
            slow_gain: 1e-7,
            slow_step: 1e-4,
            slow_in_row: 1,
        }
    }

    /// That of one of many starts of a figure.
    pub(crate) fn of_start(most: u32) -> Self {
        Self {
            most,
            slow_gain: 1e-3,
            slow_step: f64::INFINITY,
            slow_in_row: 3,
        }
    }
}

/// How often a figure that stands still short of its targets is bent.
const MOST_NUDGES: usize = 2;

/// The damping's factor as it changes.
struct Damping {
    factor: f64,
    /// What a failure multiplies it by; grows with failures in a row.
    growth: f64,
}

impl Damping {
    fn of(factor: f64) -> Self {
        Self {
            factor,
            growth: 2.0,
        }
    }

    /// After a step whose gain was this share of what was foretold.
    fn lessen(&mut self, ratio: f64) {
        let cube = (2.0 * ratio - 1.0) * (2.0 * ratio - 1.0) * (2.0 * ratio - 1.0);
        self.factor *= (1.0 - cube).clamp(LEAST_FACTOR, 2.0);
        self.growth = 2.0;
    }

    fn grow(&mut self) {
        self.factor *= self.growth;
        self.growth *= 2.0;
    }
}

/// Minimises what is missing until all targets are reached, nothing moves any more, or patience is at its
/// end.
pub(crate) fn minimize<M: Model>(
    model: &mut M,
    system: &mut System,
    config: &LevenbergMarquardtConfig,
    patience: &Patience,
) -> Iterations {
    let mut made = Iterations::default();
    let mut damping = Damping::of(config.damping);
    let (mut nudges, mut slow) = (0, 0);
    let mut least = f64::INFINITY;
    model.find_residual(system);
    let mut cost = system.cost();
    while made.count < patience.most && !model.is_reached() {
        // After a step that was taken back, too: limits that it met are bounds of the next one.
        model.linearize(system);
        let floor = LEAST_DAMPING * system.trace() + f64::MIN_POSITIVE;
        let is_solved = system.solve(damping.factor * cost + floor);
        system.shorten_step(config.max_step);
        let length = if is_solved {
            system.largest_step()
        } else {
            0.0
        };
        // Not `>`: a step that is not a number is none.
        let moves = length > AT_REST;
        let is_stuck = is_solved && !moves || damping.factor > MOST_DAMPING;
        if is_stuck {
            made.is_settled = true;
            if !model.is_short() || nudges == MOST_NUDGES {
                break;
            }
            let before = cost;
            if !try_nudge(model, system, &mut cost, nudges) {
                break;
            }
            // All other steps lead downhill: the best state so far is one that was bent, or the last.
            if before < least {
                least = before;
                model.keep_saved();
            }
            nudges += 1;
            made.count += 1;
            made.is_settled = false;
            damping = Damping::of(config.damping);
            continue;
        }
        made.count += 1;
        if !is_solved {
            model.record(Taken::Nothing);
            damping.grow();
            continue;
        }
        let foretold = system.predicted_gain();
        model.save();
        model.advance(&system.step);
        let linear = std::mem::take(&mut system.residual);
        model.find_residual(system);
        let next = system.cost();
        if next <= cost || model.is_reached() {
            model.record(Taken::Step);
            let gain = cost - next;
            damping.lessen(if foretold > 0.0 { gain / foretold } else { 0.5 });
            let is_slow = gain <= patience.slow_gain * cost && length <= patience.slow_step;
            slow = if is_slow { slow + 1 } else { 0 };
            cost = next;
            if slow >= patience.slow_in_row && !model.is_reached() {
                made.is_settled = true;
                break;
            }
        } else {
            model.restore();
            model.record(Taken::Nothing);
            system.residual = linear;
            damping.grow();
        }
    }
    if cost > least && !model.is_reached() {
        model.restore_kept();
        model.record(Taken::Nothing);
    }
    made
}

/// Leaves a pose in which no step helps; whether it could.
fn try_nudge<M: Model>(model: &mut M, system: &mut System, cost: &mut f64, time: usize) -> bool {
    model.save();
    if !model.nudge(time) {
        return false;
    }
    model.record(Taken::Nothing);
    model.find_residual(system);
    *cost = system.cost();
    true
}
