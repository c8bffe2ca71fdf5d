//! Cholesky decomposition of small symmetric positive definite matrices, in place.

/// Solves `matrix * x = right` for a symmetric positive definite matrix of `size` rows, of which the lower
/// triangle is given, row by row at a stride of `size`. The triangle is overwritten with the factor and
/// `right` with the solution. `false`, with both in no useful state, when the matrix is not positive
/// definite within rounding.
pub(crate) fn solve_in_place(matrix: &mut [f64], size: usize, right: &mut [f64]) -> bool {
    let matrix = &mut matrix[..size * size];
    let right = &mut right[..size];
    for row in 0..size {
        let (above, current) = matrix.split_at_mut(row * size);
        for column in 0..row {
            let other = &above[column * size..=column * size + column];
            let dot: f64 = dot(&current[..column], &other[..column]);
            // The diagonal holds reciprocals, so that dividing is multiplying.
            current[column] = (current[column] - dot) * other[column];
        }
        let rest = current[row] - dot(&current[..row], &current[..row]);
        // Not `<=`: what is not a number is not positive either.
        if !(rest > 0.0 && rest < f64::INFINITY) {
            return false;
        }
        let reciprocal = 1.0 / rest.sqrt();
        let known = dot(&current[..row], &right[..row]);
        current[row] = reciprocal;
        right[row] = (right[row] - known) * reciprocal;
    }
    for row in (0..size).rev() {
        let mut known = 0.0;
        for below in row + 1..size {
            known += matrix[below * size + row] * right[below];
        }
        right[row] = (right[row] - known) * matrix[row * size + row];
    }
    true
}

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_are_solved() {
        for size in 1..20_usize {
            let wanted: Vec<f64> = (0..size).map(|i| (i as f64 * 1.7).sin()).collect();
            let entry = |row: usize, column: usize| {
                let base = ((row * 7 + column * 7) as f64).cos() * 0.1;
                if row == column { 3.0 + base } else { base }
            };
            let mut matrix = vec![f64::NAN; size * size];
            let mut right = vec![0.0; size];
            for row in 0..size {
                for column in 0..size {
                    if column <= row {
                        matrix[row * size + column] = entry(row, column);
                    }
                    right[row] += entry(row, column) * wanted[column];
                }
            }
            assert!(solve_in_place(&mut matrix, size, &mut right));
            for (a, b) in wanted.iter().zip(&right) {
                assert!((a - b).abs() < 1e-12, "size {size}");
            }
        }
    }

    #[test]
    fn matrices_that_are_not_positive_definite_are_refused() {
        for matrix in [
            [0.0, 0.0, 0.0, 1.0],
            [1.0, 0.0, 2.0, 1.0],
            [f64::NAN, 0.0, 0.0, 1.0],
            [f64::INFINITY, 0.0, 0.0, 1.0],
        ] {
            assert!(!solve_in_place(&mut matrix.clone(), 2, &mut [1.0, 1.0]));
        }
        assert!(solve_in_place(&mut [], 0, &mut []));
    }
}
