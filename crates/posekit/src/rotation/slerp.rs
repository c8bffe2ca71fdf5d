//! Interpolation between two orientations: spherical linear ([`slerp`]) and normalised linear
//! ([`nlerp`]).
//!
//! **Space and units.** Orientations in any one space; the parameter `t` is 0 at the first and 1 at the
//! second. It is not clamped: [`slerp`] goes on turning at the same speed outside of `[0, 1]`.
//!
//! **Method.** Slerp after Shoemake (1985, "Animating Rotation with Quaternion Curves", SIGGRAPH,
//! doi:10.1145/325334.325242): constant angular speed along the great arc. The arc's angle comes from
//! `atan2` of the chord and the sum, not from an arccosine, so near and far pairs are equally accurate.
//! [`slerp_matrix`] is the same path written with matrices, `R1 * exp(t * log(R1^T * R2))`.
//! Nlerp walks the chord and normalises: same path, same ends and middle, uneven speed (slow at the
//! ends). How far it strays from slerp, in degrees of rotation: 0.01 for orientations 20 degrees apart,
//! 0.11 for 45, 0.92 for 90, 8.15 for 180.
//!
//! **Guarantees and degenerate inputs.**
//! - All take the **short way**: the sign of a quaternion has no meaning and is undone first.
//! - Orientations exactly half a turn apart (to within `1e-15` in the dot product) have two shortest
//!   ways. The one taken turns about the axis, in the first orientation's own space, whose first
//!   nonzero component is positive: the same that [`log`](super::log) picks, so the matrix and the
//!   quaternion form agree there as well, and the signs of the inputs do not matter. Swapping the two
//!   orientations may then go the other way round; anywhere else `slerp(a, b, t)` and
//!   `slerp(b, a, 1 - t)` are the same orientation.
//! - Inputs must be unit quaternions; outputs are unit to rounding.
//!
//! **Cost.** Slerp: one `atan2`, three sines; in single precision a polynomial of degree 5, and beyond
//! 60 degrees of rotation one of degree 7, a square root and a division. Nlerp: one square root.
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use posekit::rotation::{angle_between, slerp};
//!
//! let a = DQuat::from_rotation_y(0.2);
//! let b = -DQuat::from_rotation_y(1.0); // the sign makes no difference
//! let q = slerp(a, b, 0.25);
//! assert!(angle_between(q, DQuat::from_rotation_y(0.4)) < 1e-15);
//! ```

use glam::{DMat3, DQuat, Quat, Vec4};

use super::exp_log::{HALF_TURN_SHARE, exp_matrix, log_matrix, shorter_sign};
use super::matrix::RotationMatrixError;

/// Below this arc the weights of slerp and of a straight line differ by less than `arc^2 / 6`, under
/// half a unit in the last place of an `f64`.
const SMALL_ARC: f64 = 1e-8;

/// As [`SMALL_ARC`], for `f32`.
const SMALL_ARC_F32: f32 = 2e-4;

/// One less the cosine of 30 degrees, the arc of 60 degrees of rotation.
const NEAR_VERSINE: f32 = 0.133_974_6;

/// As the `f64` rule for half a turn, for `f32`: a few units of rounding.
const HALF_TURN_SHARE_F32: f32 = 5e-7;

/// From `start` to `end` the short way at constant angular speed.
pub fn slerp(start: DQuat, end: DQuat, t: f64) -> DQuat {
    let end = on_short_side(start, end);
    // |end - start| and |end + start| are twice the sine and cosine of half the arc.
    let arc = 2.0 * libm::atan2((end - start).length(), (end + start).length());
    if arc < SMALL_ARC {
        return (start * (1.0 - t) + end * t).normalize();
    }
    let inv_sin = 1.0 / libm::sin(arc);
    let start_weight = libm::sin((1.0 - t) * arc) * inv_sin;
    let end_weight = libm::sin(t * arc) * inv_sin;
    start * start_weight + end * end_weight
}

/// From `start` to `end` the short way along the chord, normalised: cheaper than [`slerp`], on the same
/// path, at uneven speed. `t` should be within `[0, 1]`.
pub fn nlerp(start: DQuat, end: DQuat, t: f64) -> DQuat {
    let end = on_short_side(start, end);
    (start * (1.0 - t) + end * t).normalize()
}

/// [`slerp`] in single precision, for poses: within `6e-7` rad of it for unit inputs and `t` in
/// `[0, 1]`, where it needs no trigonometry, and only a polynomial for orientations within 60 degrees
/// of each other, as neighbouring frames are.
#[inline]
pub fn slerp_f32(start: Quat, end: Quat, t: f32) -> Quat {
    let dot = start.dot(end);
    let versine = 1.0 - dot.abs();
    if versine <= NEAR_VERSINE && (0.0..=1.0).contains(&t) {
        let [start_weight, end_weight] = series_weights(&NEAR_TERMS, versine, t);
        return start * start_weight + end * end_weight.copysign(dot);
    }
    slerp_f32_far(start, end, t)
}

/// [`slerp_f32`] for any arc and any `t`. The series serves half the arc: the way to the middle or
/// the way from it, the middle being `(start + end) / (2 cos(arc / 2))`.
#[inline(never)]
fn slerp_f32_far(start: Quat, end: Quat, t: f32) -> Quat {
    let dot = start.dot(end).abs();
    let end = on_short_side_f32(start, end);
    if !(dot <= 1.0 && (0.0..=1.0).contains(&t)) {
        return slerp_f32_with_trigonometry(start, end, t);
    }
    let cos_half = ((1.0 + dot) * 0.5).sqrt();
    let (near, far, share) = if t < 0.5 {
        (start, end, 2.0 * t)
    } else {
        (end, start, 2.0 - 2.0 * t)
    };
    let [near_weight, middle_weight] = series_weights(&FAR_TERMS, 1.0 - cos_half, share);
    let far_weight = middle_weight * (0.5 / cos_half);
    near * (near_weight + far_weight) + far * far_weight
}

/// [`slerp_f32`] for any `t`; `end` is on the side of `start`.
fn slerp_f32_with_trigonometry(start: Quat, end: Quat, t: f32) -> Quat {
    let arc = 2.0 * libm::atan2f((end - start).length(), (end + start).length());
    if arc < SMALL_ARC_F32 {
        return (start * (1.0 - t) + end * t).normalize();
    }
    let inv_sin = 1.0 / libm::sinf(arc);
    let start_weight = libm::sinf((1.0 - t) * arc) * inv_sin;
    let end_weight = libm::sinf(t * arc) * inv_sin;
    start * start_weight + end * end_weight
}

/// `sin((1 - t) arc) / sin(arc)` and `sin(t arc) / sin(arc)` as power series in the versine,
/// `1 - cos(arc)` (Eberly 2011, "A Fast and Accurate Algorithm for Computing SLERP", J. Graphics, GPU
/// and Game Tools 15(3), doi:10.1080/2151237X.2011.610255): the sum over n of
/// `s * f_1 * ... * f_n * versine^n` with `f_i = (i^2 - s^2) / (i (2 i + 1))`. His has its last term
/// scaled so that it serves all arcs with an error of `2e-5`; these are cut off where what is left out
/// is below `2.5e-8`.
#[inline(always)]
fn series_weights<const N: usize>(terms: &[Term; N], versine: f32, t: f32) -> [f32; 2] {
    // Both weights side by side, in the first two of four lanes.
    let share = Vec4::new(1.0 - t, t, 0.0, 0.0);
    let square = share * share;
    // The coefficients depend on `t` alone: over a pose they are computed once.
    let mut coefficients = [share; N];
    let mut product = share;
    for (coefficient, term) in coefficients.iter_mut().zip(terms) {
        product *= Vec4::splat(term.constant) - square * Vec4::splat(term.per_square);
        *coefficient = product;
    }
    let y = Vec4::splat(versine);
    let mut sum = coefficients[N - 1];
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = coefficient + y * sum;
    }
    let weights = share + y * sum;
    [weights.x, weights.y]
}

/// A factor of the series, `constant - per_square * s^2`.
struct Term {
    constant: f32,
    per_square: f32,
}

/// What is left out of the series up to [`NEAR_VERSINE`] is below `0.0021 * versine^6`, `1.2e-8`.
const NEAR_TERMS: [Term; 5] = terms();

/// Half an arc is at most 45 degrees, its versine 0.293, and what is left out is below
/// `0.00046 * versine^8`, `2.5e-8`.
const FAR_TERMS: [Term; 7] = terms();

/// The factors from `i = 1` on.
const fn terms<const N: usize>() -> [Term; N] {
    let mut terms = [const {
        Term {
            constant: 0.0,
            per_square: 0.0,
        }
    }; N];
    let (mut at, mut i) = (0, 1.0);
    while at < N {
        terms[at] = Term {
            constant: i / (2.0 * i + 1.0),
            per_square: 1.0 / (i * (2.0 * i + 1.0)),
        };
        at += 1;
        i += 1.0;
    }
    terms
}

/// [`nlerp`] in single precision, for poses.
pub fn nlerp_f32(start: Quat, end: Quat, t: f32) -> Quat {
    let end = on_short_side_f32(start, end);
    (start * (1.0 - t) + end * t).normalize()
}

/// `start * exp(t * log(start^T * end))`: the same path as [`slerp`], for matrices.
///
/// # Errors
///
/// When `start^T * end` is not near a rotation, as
/// [`quat_from_matrix`](super::quat_from_matrix) says.
pub fn slerp_matrix(start: &DMat3, end: &DMat3, t: f64) -> Result<DMat3, RotationMatrixError> {
    let turn = log_matrix(&(start.transpose() * *end))?;
    Ok(*start * exp_matrix(turn * t))
}

/// The sign of `end` that lies on `start`'s side of the sphere, the tie broken by [`shorter_sign`].
fn on_short_side(start: DQuat, end: DQuat) -> DQuat {
    let dot = start.dot(end);
    if dot.abs() > HALF_TURN_SHARE {
        return if dot < 0.0 { -end } else { end };
    }
    let relative = start.conjugate() * end;
    let picked = shorter_sign(DQuat::from_vec4(relative.xyz().extend(0.0)));
    if picked.xyz().dot(relative.xyz()) < 0.0 {
        -end
    } else {
        end
    }
}

/// [`on_short_side`] in single precision.
fn on_short_side_f32(start: Quat, end: Quat) -> Quat {
    let dot = start.dot(end);
    if dot.abs() > HALF_TURN_SHARE_F32 {
        return if dot < 0.0 { -end } else { end };
    }
    let relative = (start.conjugate() * end).xyz();
    let noise = 8.0 * HALF_TURN_SHARE_F32;
    let leading = relative
        .to_array()
        .into_iter()
        .find(|c| c.abs() > noise)
        .unwrap_or(0.0);
    if leading < 0.0 { -end } else { end }
}
