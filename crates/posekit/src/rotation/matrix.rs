//! Rotation matrices: to and from quaternions, and the rotation nearest to a matrix.
//!
//! **Space and units.** Column vectors; the matrix maps child (body) coordinates to parent coordinates,
//! so its columns are the child's axes in parent coordinates. No units.
//!
//! **Method.** [`nearest_rotation`] is the orthogonal factor of the polar decomposition, the rotation
//! with the least Frobenius distance, by scaled Newton iteration (Higham 1986, "Computing the Polar
//! Decomposition - with Applications", SIAM J. Sci. Stat. Comput. 7(4), doi:10.1137/0907079). It is
//! preferred to Gram-Schmidt because it treats the three axes alike. Quaternions from matrices follow
//! Shepperd (1978, "Quaternion from Rotation Matrix", J. Guidance and Control 1(3),
//! doi:10.2514/3.55767b): the largest of the four components is found first and the others divided by
//! it, so nothing is lost near half a turn.
//!
//! **Guarantees and degenerate inputs.**
//! - A matrix that is already a rotation to rounding is not changed by more than rounding.
//! - Scale is taken out, uniform or not: only the rotation is left. Shear is shared evenly.
//! - A matrix that mirrors (determinant not positive) has no nearest rotation that means anything, a
//!   singular one none that is unique, a non-finite one none at all: these are errors.
//!
//! **Cost.** Four to nine 3 by 3 inversions for the nearest rotation, none when the matrix is
//! orthogonal to `1e-15`.
//!
//! ```
//! use glam::{DMat3, DQuat};
//! use posekit::rotation::{angle_between, quat_from_matrix};
//!
//! let q = DQuat::from_rotation_x(0.7);
//! let scaled = DMat3::from_quat(q) * 2.5;
//! assert!(angle_between(quat_from_matrix(&scaled)?, q) < 1e-14);
//! # Ok::<(), posekit::rotation::RotationMatrixError>(())
//! ```

use glam::{DMat3, DQuat, DVec3};

/// How far `M^T M` may be from the identity, in its largest entry, for `M` to be taken as it is: a few
/// units of rounding of a product of two rotation matrices.
const ORTHOGONAL_TOLERANCE: f64 = 2e-15;

/// The determinant of the matrix scaled to columns of unit root mean square below which it counts as
/// singular: the nearest rotation would then hang on entries that rounding made.
const SINGULAR_DETERMINANT: f64 = 1e-12;

/// More than the scaled iteration needs for the most ill-conditioned matrix that passes the test above.
const MAX_ITERATIONS: usize = 40;

/// Why a matrix has no rotation that could stand for it.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RotationMatrixError {
    /// An entry is NaN or infinite.
    #[error("the matrix has an entry that is not finite")]
    NotFinite,
    /// The determinant is negative: the matrix mirrors.
    #[error("the matrix mirrors: its determinant is {determinant}")]
    Improper {
        /// The determinant of the matrix after division by its size.
        determinant: f64,
    },
    /// The columns are linearly dependent, or nearly.
    #[error("the matrix is singular: its determinant is {determinant}")]
    Singular {
        /// The determinant of the matrix after division by its size.
        determinant: f64,
    },
}

/// The rotation matrix of a quaternion of any length but zero.
pub fn matrix_from_quat(rotation: DQuat) -> DMat3 {
    let DQuat { x, y, z, w } = rotation;
    let s = 2.0 / rotation.length_squared();
    DMat3::from_cols(
        DVec3::new(
            1.0 - s * (y * y + z * z),
            s * (x * y + w * z),
            s * (x * z - w * y),
        ),
        DVec3::new(
            s * (x * y - w * z),
            1.0 - s * (x * x + z * z),
            s * (y * z + w * x),
        ),
        DVec3::new(
            s * (x * z + w * y),
            s * (y * z - w * x),
            1.0 - s * (x * x + y * y),
        ),
    )
}

/// The unit quaternion of the rotation nearest to `matrix`, with a scalar part that is not negative.
///
/// # Errors
///
/// Those of [`nearest_rotation`].
pub fn quat_from_matrix(matrix: &DMat3) -> Result<DQuat, RotationMatrixError> {
    nearest_rotation(matrix).map(|rotation| quat_from_orthogonal(&rotation))
}

/// The rotation matrix with the least sum of squared differences to `matrix` divided by its size.
///
/// # Errors
///
/// [`RotationMatrixError`] when the matrix is not finite, mirrors, or is singular.
pub fn nearest_rotation(matrix: &DMat3) -> Result<DMat3, RotationMatrixError> {
    if !matrix.is_finite() {
        return Err(RotationMatrixError::NotFinite);
    }
    if is_orthogonal(matrix) && matrix.determinant() > 0.0 {
        return Ok(*matrix);
    }
    let mut current = scaled_to_unit(matrix);
    let determinant = current.determinant();
    if determinant.abs() < SINGULAR_DETERMINANT {
        return Err(RotationMatrixError::Singular { determinant });
    }
    if determinant < 0.0 {
        return Err(RotationMatrixError::Improper { determinant });
    }
    for _ in 0..MAX_ITERATIONS {
        let inverse_transpose = current.inverse().transpose();
        // Higham's scale factor brings the singular values towards 1 and is 1 once they are near.
        let scale = (frobenius_norm(&inverse_transpose) / frobenius_norm(&current)).sqrt();
        let next = (current * scale + inverse_transpose * (1.0 / scale)) * 0.5;
        let change = frobenius_norm(&(next - current));
        current = next;
        // Convergence is quadratic: after a step this small the next one is below rounding.
        if change < 1e-9 {
            break;
        }
    }
    // One unscaled step settles the last bits.
    Ok((current + current.inverse().transpose()) * 0.5)
}

/// Shepperd's method for a matrix that is a rotation to rounding.
fn quat_from_orthogonal(m: &DMat3) -> DQuat {
    let [[m00, m10, m20], [m01, m11, m21], [m02, m12, m22]] = m.to_cols_array_2d();
    let trace = m00 + m11 + m22;
    let largest = trace.max(m00).max(m11).max(m22);
    let q = if largest == trace {
        DQuat::from_xyzw(m21 - m12, m02 - m20, m10 - m01, 1.0 + trace)
    } else if largest == m00 {
        DQuat::from_xyzw(1.0 + m00 - m11 - m22, m01 + m10, m02 + m20, m21 - m12)
    } else if largest == m11 {
        DQuat::from_xyzw(m01 + m10, 1.0 - m00 + m11 - m22, m12 + m21, m02 - m20)
    } else {
        DQuat::from_xyzw(m02 + m20, m12 + m21, 1.0 - m00 - m11 + m22, m10 - m01)
    };
    let q = q.normalize();
    if q.w < 0.0 { -q } else { q }
}

fn is_orthogonal(m: &DMat3) -> bool {
    let gram = m.transpose() * *m - DMat3::IDENTITY;
    gram.to_cols_array()
        .iter()
        .all(|entry| entry.abs() <= ORTHOGONAL_TOLERANCE)
}

/// The matrix over its root mean square column length; a zero matrix stays zero. The largest entry is
/// divided out first, so that squares neither overflow nor underflow.
fn scaled_to_unit(m: &DMat3) -> DMat3 {
    let largest = m
        .to_cols_array()
        .iter()
        .fold(0.0_f64, |size, entry| size.max(entry.abs()));
    if largest == 0.0 {
        return *m;
    }
    // Two divisions, as the reciprocal of a subnormal number overflows.
    let bounded = DMat3::from_cols_array(&m.to_cols_array().map(|entry| entry / largest));
    bounded * (3.0_f64.sqrt() / frobenius_norm(&bounded))
}

fn frobenius_norm(m: &DMat3) -> f64 {
    m.to_cols_array()
        .iter()
        .map(|entry| entry * entry)
        .sum::<f64>()
        .sqrt()
}
