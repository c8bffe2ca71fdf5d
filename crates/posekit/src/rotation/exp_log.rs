//! The exponential and the logarithm of rotations.
//!
//! A *rotation vector* points along the axis of a rotation and is as long as its angle. [`exp`] turns
//! it into a rotation, [`log`] finds the shortest one of a rotation.
//!
//! **Space and units.** Radians. The vector lives in the space that the rotation maps from, which for
//! a rotation vector is also the one it maps to: the axis does not move.
//!
//! **Method.** Rodrigues' formula, and the half-angle form of it for quaternions (Grassia 1998,
//! "Practical Parameterization of Rotations Using the Exponential Map", J. Graphics Tools 3(3),
//! doi:10.1080/10867651.1998.10487493). The logarithm takes its angle from `atan2` of both parts of
//! the quaternion, which unlike the arccosine is accurate everywhere; a matrix is first turned into a
//! quaternion, so that no difference of nearly equal entries is ever divided by a small sine.
//!
//! **Guarantees and degenerate inputs.**
//! - `log` is accurate to a few units in the last place at every angle, tiny ones down to the
//!   subnormal range and those near pi included. Its length is within `[0, pi]`.
//! - `q` and `-q` have the same logarithm. The quaternion's length does not matter. That of a zero
//!   quaternion is zero.
//! - At exactly half a turn (within rounding, see [`log`]) both `v` and `-v` are logarithms: the one
//!   whose first component that is not zero is positive is chosen, whatever the quaternion's sign.
//! - Non-finite input gives non-finite output.
//!
//! **Cost.** One sine and cosine for `exp`, one `atan2` and two square roots for `log`.
//!
//! ```
//! use glam::DVec3;
//! use posekit::rotation::{exp, log};
//!
//! let quarter_turn_about_y = DVec3::new(0.0, core::f64::consts::FRAC_PI_2, 0.0);
//! let q = exp(quarter_turn_about_y);
//! assert!((q * DVec3::Z - DVec3::X).length() < 1e-15);
//! assert!((log(-q) - quarter_turn_about_y).length() < 1e-15);
//! ```

use glam::{DMat3, DQuat, DVec3};

use super::matrix::{RotationMatrixError, quat_from_matrix};

/// Below this angle the quadratic term of every series here is under half a unit in the last place
/// (`1e-8` squared, over six), so the first term is the correctly rounded value. Above it the closed
/// forms lose nothing: `sin(x) / x` is well conditioned for every `x` that is not zero. Only where
/// `x * x` underflows do they fail, which this also covers.
const SMALL_ANGLE: f64 = 1e-8;

/// How small a share of the norm the scalar part (the cosine of half the angle) may be for the
/// rotation to count as half a turn. Rounding in a product of unit quaternions leaves a few units of
/// `1e-16`; which sign that leaves must not choose the axis.
pub(super) const HALF_TURN_SHARE: f64 = 1e-15;

/// The rotation by `rotation_vector`, as a unit quaternion with the scalar part `cos(angle / 2)`.
pub fn exp(rotation_vector: DVec3) -> DQuat {
    let angle_rad = rotation_vector.length();
    let (sin_half, cos_half) = libm::sincos(0.5 * angle_rad);
    let scale = if angle_rad < SMALL_ANGLE {
        0.5
    } else {
        sin_half / angle_rad
    };
    DQuat::from_vec4((rotation_vector * scale).extend(cos_half))
}

/// The rotation by `rotation_vector`, as a matrix: `I + sin(a)/a K + (1 - cos(a))/a^2 K^2` with `K`
/// the cross product matrix of the vector (Rodrigues).
pub fn exp_matrix(rotation_vector: DVec3) -> DMat3 {
    let angle_rad = rotation_vector.length();
    let (linear, quadratic) = if angle_rad < SMALL_ANGLE {
        (1.0, 0.5)
    } else {
        // 1 - cos(a) = 2 sin(a/2)^2, without the cancellation.
        let sinc_half = libm::sin(0.5 * angle_rad) / angle_rad;
        (
            libm::sin(angle_rad) / angle_rad,
            2.0 * sinc_half * sinc_half,
        )
    };
    let DVec3 { x, y, z } = rotation_vector;
    let cross = DMat3::from_cols(
        DVec3::new(0.0, z, -y),
        DVec3::new(-z, 0.0, x),
        DVec3::new(y, -x, 0.0),
    );
    // K^2 = v v^T - |v|^2 I.
    let cross_sq = DMat3::from_cols(
        DVec3::new(-(y * y + z * z), x * y, x * z),
        DVec3::new(x * y, -(x * x + z * z), y * z),
        DVec3::new(x * z, y * z, -(x * x + y * y)),
    );
    DMat3::IDENTITY + cross * linear + cross_sq * quadratic
}

/// The shortest rotation vector of `rotation`, with length in `[0, pi]`.
///
/// Where the scalar part is below `1e-15` of the norm the rotation counts as half a turn, and the sign
/// of its axis is fixed as the module's documentation says.
pub fn log(rotation: DQuat) -> DVec3 {
    let short = shorter_sign(rotation);
    let vector = short.xyz();
    let sin_half = vector.length();
    let scale = if sin_half < SMALL_ANGLE * short.w {
        2.0 / short.w
    } else if sin_half > 0.0 {
        2.0 * libm::atan2(sin_half, short.w) / sin_half
    } else {
        // The zero quaternion is no rotation; none at all is the calmest answer.
        0.0
    };
    vector * scale
}

/// The shortest rotation vector of the rotation nearest to `matrix` (see
/// [`quat_from_matrix`]).
///
/// # Errors
///
/// Those of [`quat_from_matrix`]: the matrix is not finite, mirrors, or is singular.
pub fn log_matrix(matrix: &DMat3) -> Result<DVec3, RotationMatrixError> {
    quat_from_matrix(matrix).map(log)
}

/// Of `q` and `-q`, the one whose scalar part is not negative (the shorter way round); at half a turn
/// the one whose first vector component of any size is positive, with a scalar part of `+0`.
pub(super) fn shorter_sign(q: DQuat) -> DQuat {
    let vector = q.xyz();
    let size = vector.abs().max_element();
    if q.w.abs() > HALF_TURN_SHARE * size {
        return if q.w < 0.0 { -q } else { q };
    }
    // Components this far below the largest are rounding noise, and their sign is no one's choice.
    let noise = 8.0 * HALF_TURN_SHARE * size;
    let leading = vector
        .to_array()
        .into_iter()
        .find(|c| c.abs() > noise)
        .unwrap_or(0.0);
    let vector = if leading < 0.0 { -vector } else { vector };
    DQuat::from_vec4(vector.extend(q.w * 0.0 + 0.0))
}
