//! What a figure's solver remembers between iterations, in memory that is used again.

use glam::{DQuat, DVec3};

use crate::ik::linkage::{Linkage, State};
use crate::ik::problem::IkProblem;

/// The rows of an effector in the system.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rows {
    /// The first of three rows for its place, and the factor that makes them.
    pub(super) position: Option<(usize, f64)>,
    /// The first of three rows for its orientation, the factor, and what is wanted.
    pub(super) orientation: Option<(usize, f64, DQuat)>,
}

/// The state of a figure.
#[derive(Clone, Debug, Default)]
pub(super) struct Snapshot {
    pub(super) linkage: State,
    values: Vec<[f64; 3]>,
}

/// See the module.
#[derive(Clone, Debug, Default)]
pub(crate) struct FigureMemory {
    /// By pivot: the angle of a hinge, first; or what [`exact`](super::exact) goes through.
    pub(super) values: Vec<[f64; 3]>,
    /// Whether ball joints with limits go through coordinates whose bounds the limits are.
    pub(super) is_exact: bool,
    /// By pivot: the direction in which a ball joint's limit was met last, as a turn of the outer link,
    /// unit length, in the world at the start, carried by the inner link; zero for none.
    pub(super) normals: Vec<DVec3>,
    /// By pivot: its first degree of freedom.
    pub(super) first_degrees: Vec<u32>,
    /// By degree of freedom: its axis in the world.
    pub(super) axes: Vec<DVec3>,
    /// By pivot: how its outer link turned in the last step.
    pub(super) moves: Vec<DQuat>,
    /// By effector.
    pub(super) rows: Vec<Rows>,
    pub(super) row_count: usize,
    /// The effectors beyond pivot `k` are `beyond[beyond_starts[k]..beyond_starts[k + 1]]`.
    pub(super) beyond_starts: Vec<u32>,
    pub(super) beyond: Vec<u32>,
    pub(super) saved: Snapshot,
    /// A state that may be gone back to at the end.
    kept: Snapshot,
    /// The best pose of all starts.
    best: State,
}

impl FigureMemory {
    /// Makes room for a linkage and lays out rows.
    pub(super) fn prepare(
        &mut self,
        linkage: &Linkage,
        problem: &IkProblem,
        per_length: f64,
        per_radian: f64,
    ) {
        let count = linkage.pivots.len();
        self.values.clear();
        self.values.resize(count, [0.0; 3]);
        self.is_exact = false;
        self.normals.clear();
        self.normals.resize(count, DVec3::ZERO);
        self.moves.clear();
        self.moves.resize(count, DQuat::IDENTITY);
        self.rows.clear();
        self.row_count = 0;
        for target in &problem.targets {
            let mut rows = Rows::default();
            if target.position_weight > 0.0 {
                rows.position = Some((self.row_count, per_length * target.position_weight.sqrt()));
                self.row_count += 3;
            }
            if let Some(wanted) = target.orientation_in_world
                && target.orientation_weight > 0.0
            {
                let factor = per_radian * target.orientation_weight.sqrt();
                rows.orientation = Some((self.row_count, factor, wanted.normalize()));
                self.row_count += 3;
            }
            self.rows.push(rows);
        }
        self.find_beyond(linkage);
    }

    fn find_beyond(&mut self, linkage: &Linkage) {
        let count = linkage.pivots.len();
        self.beyond_starts.clear();
        self.beyond_starts.resize(count + 1, 0);
        for &pivot in &linkage.paths {
            self.beyond_starts[pivot as usize + 1] += 1;
        }
        for k in 0..count {
            self.beyond_starts[k + 1] += self.beyond_starts[k];
        }
        self.beyond.clear();
        self.beyond.resize(linkage.paths.len(), 0);
        // Filled from the back, so that the effectors of each pivot come out in ascending order and the
        // starts are starts again at the end.
        for effector in (0..linkage.effectors.len()).rev() {
            for &pivot in linkage.path(effector) {
                let slot = &mut self.beyond_starts[pivot as usize + 1];
                *slot -= 1;
                self.beyond[*slot as usize] = u32::try_from(effector).unwrap_or(u32::MAX);
            }
        }
        // Each entry now holds where its list begins, one place too far on.
        self.beyond_starts.remove(0);
        self.beyond_starts
            .push(u32::try_from(linkage.paths.len()).unwrap_or(u32::MAX));
    }

    /// The effectors that a pivot moves, in ascending order.
    pub(super) fn effectors_beyond(&self, k: usize) -> std::ops::Range<usize> {
        self.beyond_starts[k] as usize..self.beyond_starts[k + 1] as usize
    }

    pub(super) fn save(&mut self, linkage: &Linkage) {
        let Self { saved, values, .. } = self;
        saved.linkage.store(linkage);
        saved.values.clone_from(values);
    }

    pub(super) fn restore(&mut self, linkage: &mut Linkage) {
        let Self { saved, values, .. } = self;
        linkage.recall(&saved.linkage);
        values.clone_from(&saved.values);
    }

    pub(super) fn keep_saved(&mut self) {
        core::mem::swap(&mut self.kept, &mut self.saved);
    }

    pub(super) fn restore_kept(&mut self, linkage: &mut Linkage) {
        let Self { kept, values, .. } = self;
        linkage.recall(&kept.linkage);
        values.clone_from(&kept.values);
    }

    pub(super) fn store_best(&mut self, linkage: &Linkage) {
        self.best.store(linkage);
    }

    pub(super) fn recall_best(&self, linkage: &mut Linkage) {
        linkage.recall(&self.best);
    }
}
