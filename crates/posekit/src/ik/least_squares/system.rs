//! A linearised problem of inverse kinematics: residual, Jacobian, and steps that make the residual less.
//!
//! The Jacobian is kept by columns, and of each column only the rows of effectors that the degree of
//! freedom moves: an arm's joint costs nothing for the feet. There are far fewer rows than columns as a
//! rule, so steps are solved for in the space of rows: `(J P J^T + l I) y = e`, `step = P J^T y` with `P`
//! the degrees' own weights and `l` the damping.

use glam::DVec3;

use super::cholesky;

/// Three rows of one column.
#[derive(Clone, Copy, Debug)]
struct Entry {
    row: u32,
    value: DVec3,
}

/// One degree of freedom.
#[derive(Clone, Copy, Debug)]
struct Column {
    first_entry: u32,
    /// How willingly it moves: 1 less the stiffness.
    weight: f64,
    /// The least step that its limits leave, not above zero.
    lower: f64,
    /// The largest step that its limits leave, not below zero.
    upper: f64,
    /// The step that it would like to take as far as no target minds.
    wish: f64,
}

impl Column {
    #[inline]
    fn bounded(&self, step: f64) -> f64 {
        step.max(self.lower).min(self.upper)
    }
}

/// What bounds a degree of freedom and what it would like.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Degree {
    /// How willingly it moves, above 0 and up to 1.
    pub(crate) weight: f64,
    /// The least step, not above zero.
    pub(crate) lower: f64,
    /// The largest step, not below zero.
    pub(crate) upper: f64,
    /// The step that it would like to take as far as no target minds.
    pub(crate) wish: f64,
}

impl Degree {
    /// A degree without bounds and wishes.
    pub(crate) fn free(weight: f64) -> Self {
        Self {
            weight,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            wish: 0.0,
        }
    }
}

/// How often bounds that a step would leave are fixed and the step solved for again.
const MOST_PASSES: usize = 6;

/// Residual and Jacobian, and memory for steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct System {
    /// What is missing, in the order of rows: targets less effectors, weighted.
    pub(crate) residual: Vec<f64>,
    columns: Vec<Column>,
    entries: Vec<Entry>,
    /// The step that was solved for, by degree of freedom.
    pub(crate) step: Vec<f64>,
    /// `J * step`: by how much the residual shrinks, as far as the linearisation is right.
    pub(crate) gain: Vec<f64>,
    is_fixed: Vec<bool>,
    matrix: Vec<f64>,
    multipliers: Vec<f64>,
}

impl System {
    /// Forgets all columns; the residual stays.
    pub(crate) fn clear_columns(&mut self) {
        self.columns.clear();
        self.entries.clear();
    }

    /// Adds a degree of freedom; its entries follow.
    #[inline]
    pub(crate) fn push_degree(&mut self, degree: Degree) {
        self.columns.push(Column {
            first_entry: index(self.entries.len()),
            weight: degree.weight,
            lower: degree.lower,
            upper: degree.upper,
            wish: degree.wish,
        });
    }

    /// Adds three rows to the last degree of freedom.
    #[inline]
    pub(crate) fn push_entry(&mut self, row: usize, value: DVec3) {
        let row = index(row);
        self.entries.push(Entry { row, value });
    }

    /// How many degrees of freedom there are.
    pub(crate) fn degree_count(&self) -> usize {
        self.columns.len()
    }

    /// How many rows there are.
    pub(crate) fn row_count(&self) -> usize {
        self.residual.len()
    }

    /// The square of the residual's length.
    pub(crate) fn cost(&self) -> f64 {
        self.residual.iter().map(|part| part * part).sum()
    }

    /// The sum of all entries' squares: the trace of `J P J^T`.
    pub(crate) fn trace(&self) -> f64 {
        let columns = 0..self.columns.len();
        columns
            .map(|column| {
                let entries = self.entries_of(column).iter();
                let sum: f64 = entries.map(|entry| entry.value.length_squared()).sum();
                self.columns[column].weight * sum
            })
            .sum()
    }

    /// Solves for the step with the least `|e - J step|^2 + damping * |step - wish|^2` (each degree's part
    /// divided by its weight) that keeps within the bounds, as far as fixing bounds one after the other
    /// finds it. `false` when rounding left no solution; a larger damping has one.
    pub(crate) fn solve(&mut self, damping: f64) -> bool {
        let (rows, degrees) = (self.row_count(), self.degree_count());
        self.is_fixed.clear();
        self.is_fixed.resize(degrees, false);
        self.step.clear();
        self.step.extend(
            self.columns
                .iter()
                .map(|column| column.bounded(column.wish)),
        );
        self.matrix.resize(rows * rows, 0.0);
        for _ in 0..MOST_PASSES {
            self.start_multipliers();
            self.fill_matrix(damping);
            if !cholesky::solve_in_place(&mut self.matrix, rows, &mut self.multipliers) {
                return false;
            }
            if !self.take_step() {
                break;
            }
        }
        for (step, column) in self.step.iter_mut().zip(&self.columns) {
            *step = column.bounded(*step);
        }
        self.find_gain();
        true
    }

    /// The direction of steepest descent, `P J^T e`, as the step.
    pub(crate) fn step_along_gradient(&mut self) {
        self.multipliers.clear();
        self.multipliers.extend_from_slice(&self.residual);
        self.step.clear();
        for column in 0..self.columns.len() {
            let along = self.columns[column].weight * self.dot(column);
            self.step.push(along);
        }
    }

    /// Makes the step as long as is best along it, `a = (e . J step) / |J step|^2`, adds the wishes and keeps
    /// within the bounds.
    pub(crate) fn fit_step_length(&mut self) {
        self.find_gain();
        let (mut along, mut square) = (0.0, 0.0);
        for (gain, residual) in self.gain.iter().zip(&self.residual) {
            along += gain * residual;
            square += gain * gain;
        }
        let length = if square > 0.0 { along / square } else { 0.0 };
        for step in &mut self.step {
            *step *= length;
        }
        self.bound_step();
    }

    /// Calls `visit` with degree, row and value of every entry of the Jacobian.
    pub(crate) fn for_every_entry(&self, mut visit: impl FnMut(usize, usize, DVec3)) {
        for column in 0..self.columns.len() {
            for entry in self.entries_of(column) {
                visit(column, entry.row as usize, entry.value);
            }
        }
    }

    /// How willingly a degree of freedom moves.
    pub(crate) fn weight(&self, degree: usize) -> f64 {
        self.columns[degree].weight
    }

    /// Cuts the step down to the bounds, adds the wishes, and finds what it gains.
    pub(crate) fn bound_step(&mut self) {
        for (step, column) in self.step.iter_mut().zip(&self.columns) {
            *step = column.bounded(*step + column.wish);
        }
        self.find_gain();
    }

    /// The part of the step's largest component that is at most `most`, and the whole step scaled by it.
    pub(crate) fn shorten_step(&mut self, most: f64) {
        let largest = self.largest_step();
        if largest > most {
            let share = most / largest;
            for part in self.step.iter_mut().chain(&mut self.gain) {
                *part *= share;
            }
        }
    }

    /// The largest component of the step.
    pub(crate) fn largest_step(&self) -> f64 {
        self.step
            .iter()
            .fold(0.0, |most, step| most.max(step.abs()))
    }

    /// By how much the cost shrinks with the step, as far as the linearisation is right.
    pub(crate) fn predicted_gain(&self) -> f64 {
        let pairs = self.gain.iter().zip(&self.residual);
        pairs.map(|(gain, rest)| gain * (2.0 * rest - gain)).sum()
    }

    #[inline]
    fn entries_of(&self, column: usize) -> &[Entry] {
        let end = match self.columns.get(column + 1) {
            Some(next) => next.first_entry as usize,
            None => self.entries.len(),
        };
        &self.entries[self.columns[column].first_entry as usize..end]
    }

    /// A column times the multipliers.
    #[inline]
    fn dot(&self, column: usize) -> f64 {
        let mut sum = 0.0;
        for entry in self.entries_of(column) {
            let at = entry.row as usize;
            let part = DVec3::from_slice(&self.multipliers[at..at + 3]);
            sum += entry.value.dot(part);
        }
        sum
    }

    /// The residual that is left after wishes and fixed steps, as the right side.
    fn start_multipliers(&mut self) {
        self.multipliers.clear();
        self.multipliers.extend_from_slice(&self.residual);
        for column in 0..self.columns.len() {
            let step = match self.is_fixed[column] {
                true => self.step[column],
                false => self.columns[column].wish,
            };
            if step == 0.0 {
                continue;
            }
            for slot in self.columns[column].first_entry as usize..self.end_of(column) {
                let Entry { row, value } = self.entries[slot];
                let at = row as usize;
                self.multipliers[at] -= value.x * step;
                self.multipliers[at + 1] -= value.y * step;
                self.multipliers[at + 2] -= value.z * step;
            }
        }
    }

    fn end_of(&self, column: usize) -> usize {
        match self.columns.get(column + 1) {
            Some(next) => next.first_entry as usize,
            None => self.entries.len(),
        }
    }

    /// `J P J^T + damping I` of the degrees that are not fixed, its lower triangle.
    fn fill_matrix(&mut self, damping: f64) {
        let rows = self.row_count();
        self.matrix.fill(0.0);
        for row in 0..rows {
            self.matrix[row * rows + row] = damping;
        }
        for column in 0..self.columns.len() {
            if self.is_fixed[column] {
                continue;
            }
            let weight = self.columns[column].weight;
            let first = self.columns[column].first_entry as usize;
            let end = self.end_of(column);
            for later in first..end {
                let Entry { row, value } = self.entries[later];
                let scaled = value * weight;
                let at = row as usize * rows;
                for earlier in first..later {
                    let Entry { row, value } = self.entries[earlier];
                    let at = at + row as usize;
                    add_scaled(&mut self.matrix[at..at + 3], value, scaled.x);
                    add_scaled(&mut self.matrix[at + rows..at + rows + 3], value, scaled.y);
                    add_scaled(
                        &mut self.matrix[at + 2 * rows..at + 2 * rows + 3],
                        value,
                        scaled.z,
                    );
                }
                let at = at + row as usize;
                self.matrix[at] += scaled.x * value.x;
                self.matrix[at + rows] += scaled.y * value.x;
                self.matrix[at + rows + 1] += scaled.y * value.y;
                self.matrix[at + 2 * rows] += scaled.z * value.x;
                self.matrix[at + 2 * rows + 1] += scaled.z * value.y;
                self.matrix[at + 2 * rows + 2] += scaled.z * value.z;
            }
        }
    }

    /// Finds the step of every degree that is not fixed and fixes those that would leave their bounds;
    /// whether there are any.
    fn take_step(&mut self) -> bool {
        let mut has_fixed = false;
        for column in 0..self.columns.len() {
            if self.is_fixed[column] {
                continue;
            }
            let Column {
                weight,
                lower,
                upper,
                wish,
                ..
            } = self.columns[column];
            let step = wish + weight * self.dot(column);
            if step < lower || step > upper {
                self.is_fixed[column] = true;
                has_fixed = true;
                self.step[column] = self.columns[column].bounded(step);
            } else {
                self.step[column] = step;
            }
        }
        has_fixed
    }

    /// `J * step`.
    fn find_gain(&mut self) {
        self.gain.clear();
        self.gain.resize(self.residual.len(), 0.0);
        for column in 0..self.columns.len() {
            let step = self.step[column];
            for slot in self.columns[column].first_entry as usize..self.end_of(column) {
                let Entry { row, value } = self.entries[slot];
                let at = row as usize;
                self.gain[at] += value.x * step;
                self.gain[at + 1] += value.y * step;
                self.gain[at + 2] += value.z * step;
            }
        }
    }
}

#[inline]
fn add_scaled(row: &mut [f64], value: DVec3, scale: f64) {
    row[0] += value.x * scale;
    row[1] += value.y * scale;
    row[2] += value.z * scale;
}

fn index(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}
