//! Rotations in three dimensions: Euler angles, quaternions, matrices and rotation vectors, the ways
//! between them, and what is done with them.
//!
//! A rotation maps child (body) coordinates to parent coordinates; an orientation is the rotation from
//! body to world. Angles are radians and right-handed, vectors are columns, quaternions are x, y, z, w.
//! `q` and `-q` are the same rotation everywhere here. All of it is `f64` with trigonometry from `libm`,
//! so results do not depend on the platform; what poses need often exists in `f32` beside it.
//!
//! | from \ to | quaternion | matrix | rotation vector | Euler angles |
//! | --- | --- | --- | --- | --- |
//! | quaternion | | [`matrix_from_quat`] | [`log`] | [`EulerOrder::from_quat`] |
//! | matrix | [`quat_from_matrix`] | [`nearest_rotation`] | [`log_matrix`] | through a quaternion |
//! | rotation vector | [`exp`] | [`exp_matrix`] | | through a quaternion |
//! | Euler angles | [`EulerOrder::to_quat`] | through a quaternion | through a quaternion | [`EulerOrder::closest_equivalent_rad`] |

mod angular_velocity;
mod axis;
mod euler;
mod exp_log;
mod matrix;
pub(crate) mod sincos_lanes;
mod slerp;
mod swing_twist;

pub use angular_velocity::{angle_between, angular_velocity_in_body, angular_velocity_in_world};
pub use axis::Axis;
pub use euler::{EulerAngles, EulerOrder, EulerOrderError, compose_elementary};
pub use exp_log::{exp, exp_matrix, log, log_matrix};
pub use matrix::{RotationMatrixError, matrix_from_quat, nearest_rotation, quat_from_matrix};
pub use sincos_lanes::quats_from_euler_rows_deg;
pub use slerp::{nlerp, nlerp_f32, slerp, slerp_f32, slerp_matrix};
pub use swing_twist::{SwingTwist, swing_twist};
