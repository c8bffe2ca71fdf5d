//! The angle between two orientations, and the angular velocity that leads from one to the other.
//!
//! **Space and units.** An orientation maps body coordinates to world coordinates. Angular velocity is
//! radians per second along the axis of turning, given in world or in body coordinates: the two are
//! related by either orientation, `in_world = from * in_body = to * in_body`, since turning about an
//! axis does not move it. Time is seconds.
//!
//! **Method.** The constant angular velocity of the short way: the logarithm of the relative rotation
//! over the duration (Shuster 1993; Grassia 1998). The world form uses `to * from^-1`, the body form
//! `from^-1 * to`. As a difference quotient it stands for the middle of the interval.
//!
//! **Guarantees and degenerate inputs.**
//! - [`angle_between`] is accurate to rounding at every angle, zero and pi included, where an arccosine
//!   would lose half the digits.
//! - Signs of the quaternions do not matter. Turns of more than pi cannot be told from shorter ones.
//! - Orientations half a turn apart have two answers of opposite sign; [`log`]'s rule picks one, in the
//!   space that is asked for.
//! - A duration of zero gives infinite or NaN components, as the division says. A negative one gives
//!   the velocity of the way back.
//!
//! **Cost.** One quaternion product and one [`log`].
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use posekit::rotation::angular_velocity_in_world;
//!
//! let (from, to) = (DQuat::from_rotation_y(0.1), DQuat::from_rotation_y(0.3));
//! let velocity = angular_velocity_in_world(from, to, 0.1);
//! assert!((velocity - DVec3::new(0.0, 2.0, 0.0)).length() < 1e-14);
//! ```

use glam::{DQuat, DVec3};

use super::exp_log::log;

/// The angle in `[0, pi]` of the rotation between two orientations (unit quaternions).
pub fn angle_between(a: DQuat, b: DQuat) -> f64 {
    let relative = a.conjugate() * b;
    2.0 * libm::atan2(relative.xyz().length(), relative.w.abs())
}

/// The angular velocity, in world coordinates and radians per second, that turns `from` into `to` in
/// `duration_secs`: `exp(velocity * duration_secs) * from = to`.
pub fn angular_velocity_in_world(from: DQuat, to: DQuat, duration_secs: f64) -> DVec3 {
    log(to * from.conjugate()) / duration_secs
}

/// The angular velocity, in body coordinates and radians per second, that turns `from` into `to` in
/// `duration_secs`: `from * exp(velocity * duration_secs) = to`.
pub fn angular_velocity_in_body(from: DQuat, to: DQuat, duration_secs: f64) -> DVec3 {
    log(from.conjugate() * to) / duration_secs
}
