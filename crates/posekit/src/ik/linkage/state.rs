//! Where all pivots are, to go back to.

use glam::{DQuat, DVec3};

use super::Linkage;

/// The state of a linkage. Memory is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct State {
    pub(crate) turns: Vec<DQuat>,
    pub(crate) positions: Vec<DVec3>,
    slides: Vec<f64>,
    shifts: Vec<DVec3>,
}

impl State {
    /// Remembers where the linkage is now.
    pub(crate) fn store(&mut self, linkage: &Linkage) {
        self.turns.clone_from(&linkage.turns);
        self.positions.clone_from(&linkage.positions);
        self.slides.clone_from(&linkage.slides);
        self.shifts.clone_from(&linkage.shifts);
    }
}

impl Linkage {
    /// Goes back to a state that was stored.
    pub(crate) fn recall(&mut self, state: &State) {
        self.turns.clone_from(&state.turns);
        self.positions.clone_from(&state.positions);
        self.slides.clone_from(&state.slides);
        self.shifts.clone_from(&state.shifts);
    }
}
