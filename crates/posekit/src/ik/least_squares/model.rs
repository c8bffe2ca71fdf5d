//! What the solvers of this module ask of a thing that moves.

use super::system::System;

/// What came of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Taken {
    /// Its step was taken.
    Step,
    /// It was a trial, and the state is as before.
    Nothing,
}

/// A figure or a robot in a state that steps change.
pub(crate) trait Model {
    /// Writes what is missing to the system's residual.
    fn find_residual(&self, system: &mut System);

    /// Writes the Jacobian at the current state, with bounds and wishes, to the system.
    fn linearize(&mut self, system: &mut System);

    /// Moves by a step, one number for each degree of freedom in the order of
    /// [`linearize`](Self::linearize), and keeps within all limits.
    fn advance(&mut self, step: &[f64]);

    /// Remembers the state.
    fn save(&mut self);

    /// Goes back to the state that was remembered.
    fn restore(&mut self);

    /// Whether every target is reached within the tolerances.
    fn is_reached(&self) -> bool;

    /// Whether a state of rest is farther from the targets than one that has arrived may be.
    fn is_short(&self) -> bool;

    /// Keeps the state that was remembered, to go back to it at the end.
    fn keep_saved(&mut self);

    /// Goes back to the state that was kept.
    fn restore_kept(&mut self);

    /// Leaves a state in which every small step is useless, though the targets may be in reach; whether it
    /// could. The first time, the second and so on in another way.
    fn nudge(&mut self, time: usize) -> bool;

    /// Called after each iteration, with the state before it remembered.
    fn record(&mut self, taken: Taken);
}
