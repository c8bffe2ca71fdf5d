//! Singular values of small matrices by one-sided Jacobi rotations.
//!
//! Rows are turned in pairs until all are perpendicular (Hestenes 1958, "Inversion of Matrices by
//! Biorthogonalization and Related Results"; de Rijk 1989). Unlike the eigenvalues of the matrix times its
//! transpose, this keeps small singular values to full precision.

/// Sweeps over all pairs; quadratic convergence needs about six for matrices of this size.
const MOST_SWEEPS: usize = 30;

/// Rows whose cosine is below this are perpendicular.
const PERPENDICULAR: f64 = 1e-15;

/// The singular value decomposition of a matrix with few rows: `matrix = U * S * V^T`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Svd {
    rows: usize,
    columns: usize,
    /// `S * V^T`, row by row.
    turned: Vec<f64>,
    /// `U^T`, row by row: row `i` belongs to singular value `i`.
    left: Vec<f64>,
    /// Singular values, in no order.
    values: Vec<f64>,
}

impl Svd {
    /// Room for a matrix of zeros, to be filled through [`matrix_mut`](Self::matrix_mut).
    pub(crate) fn start(&mut self, rows: usize, columns: usize) {
        self.rows = rows;
        self.columns = columns;
        self.turned.clear();
        self.turned.resize(rows * columns, 0.0);
        self.left.clear();
        self.left.resize(rows * rows, 0.0);
        for row in 0..rows {
            self.left[row * rows + row] = 1.0;
        }
        self.values.clear();
    }

    /// The matrix, row by row, before [`decompose`](Self::decompose).
    pub(crate) fn matrix_mut(&mut self) -> &mut [f64] {
        &mut self.turned
    }

    /// Decomposes the matrix.
    pub(crate) fn decompose(&mut self) {
        for _ in 0..MOST_SWEEPS {
            let mut has_turned = false;
            for first in 0..self.rows {
                for second in first + 1..self.rows {
                    has_turned |= self.make_perpendicular(first, second);
                }
            }
            if !has_turned {
                break;
            }
        }
        for row in 0..self.rows {
            let row = self.row(row);
            let norm = dot(row, row).sqrt();
            self.values.push(norm);
        }
    }

    /// How many singular values there are.
    pub(crate) fn count(&self) -> usize {
        self.values.len()
    }

    /// A singular value; they are in no order.
    pub(crate) fn value(&self, index: usize) -> f64 {
        self.values[index]
    }

    /// The left singular vector of a value.
    pub(crate) fn left(&self, index: usize) -> &[f64] {
        &self.left[index * self.rows..(index + 1) * self.rows]
    }

    /// The right singular vector of a value times that value.
    pub(crate) fn scaled_right(&self, index: usize) -> &[f64] {
        self.row(index)
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.turned[row * self.columns..(row + 1) * self.columns]
    }

    /// Turns two rows against each other; whether they needed it.
    fn make_perpendicular(&mut self, first: usize, second: usize) -> bool {
        let (a, b) = (self.row(first), self.row(second));
        let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
        if ab.abs() <= PERPENDICULAR * (aa * bb).sqrt() || !ab.is_finite() {
            return false;
        }
        let cotangent = (bb - aa) / (2.0 * ab);
        let tangent = cotangent.signum() / (cotangent.abs() + (1.0 + cotangent * cotangent).sqrt());
        let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
        let sine = cosine * tangent;
        turn(&mut self.turned, self.columns, first, second, cosine, sine);
        turn(&mut self.left, self.rows, first, second, cosine, sine);
        true
    }
}

fn turn(matrix: &mut [f64], width: usize, first: usize, second: usize, cosine: f64, sine: f64) {
    let (upper, lower) = matrix.split_at_mut(second * width);
    let first = &mut upper[first * width..(first + 1) * width];
    for (a, b) in first.iter_mut().zip(&mut lower[..width]) {
        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_are_those_of_numpy() {
        // numpy.linalg.svd([[1, 2, 3], [4, 5, 6]]), and a matrix of rank one.
        let cases = [
            (
                [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
                [9.508_032_000_695_724, 0.772_869_635_673_485],
            ),
            ([1.0, 2.0, 2.0, 2.0, 4.0, 4.0], [6.708_203_932_499_369, 0.0]),
        ];
        for (matrix, expected) in cases {
            let mut svd = Svd::default();
            svd.start(2, 3);
            svd.matrix_mut().copy_from_slice(&matrix);
            svd.decompose();
            let mut values = [svd.value(0), svd.value(1)];
            values.sort_by(|a, b| b.total_cmp(a));
            for (a, b) in values.iter().zip(expected) {
                assert!((a - b).abs() < 1e-14, "{values:?}");
            }
            for (index, entry) in matrix.iter().enumerate() {
                let rebuilt: f64 = (0..2)
                    .map(|i| svd.left(i)[index / 3] * svd.scaled_right(i)[index % 3])
                    .sum();
                assert!((rebuilt - entry).abs() < 1e-14);
            }
        }
    }
}
