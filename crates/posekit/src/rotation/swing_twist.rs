//! Swing and twist: a rotation split into a turn about a given axis and a turn of that axis.
//!
//! `rotation = swing * twist`: first the twist about the axis, then the swing, whose own axis is
//! perpendicular to the given one. Joint limits and the drawing of bone roll use it.
//!
//! **Space and units.** The axis is in the space that the rotation maps from (a bone's direction in the
//! joint's own space, say). Radians.
//!
//! **Method.** The projection of the quaternion onto the plane of its scalar part and the axis
//! (Dobrowolski 2015, "Swing-twist decomposition in Clifford algebra", arXiv:1506.05481). The same
//! twist serves for the other order, `rotation = twist * swing'` with `swing' = twist^-1 * rotation`.
//!
//! **Guarantees and degenerate inputs.**
//! - The twist angle is within `[-pi, pi]`, the swing within `[0, pi]`; the swing's scalar part is not
//!   negative, and neither is the twist's. The twist is the turn about the axis that is nearest to the
//!   rotation.
//! - A swing of half a turn reverses the axis, and then every twist serves (with another swing): the
//!   projection vanishes. Within `1e-12` of that the twist is the identity and
//!   [`SwingTwist::is_degenerate`] is set. Close to it the twist is ill-conditioned: its error is about
//!   `1e-16` divided by the distance.
//! - The axis need not be of unit length; a zero or non-finite one gives no twist and is reported as
//!   degenerate. The rotation may be any multiple of a unit quaternion except zero.
//!
//! **Cost.** Three square roots and one `atan2`.
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use posekit::rotation::swing_twist;
//!
//! let rotation = DQuat::from_rotation_z(0.4) * DQuat::from_rotation_y(1.2);
//! let parts = swing_twist(rotation, DVec3::Y);
//! assert!((parts.twist_angle_rad - 1.2).abs() < 1e-15);
//! assert!((parts.swing * parts.twist).abs_diff_eq(rotation, 1e-15));
//! ```

use glam::{DQuat, DVec3};

/// Below this share of the quaternion's norm the projection is noise, four digits above rounding.
const DEGENERATE_SHARE: f64 = 1e-12;

/// The parts of a rotation: `rotation = swing * twist` up to sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwingTwist {
    /// The turn of the axis, about an axis perpendicular to it.
    pub swing: DQuat,
    /// The turn about the axis.
    pub twist: DQuat,
    /// The twist's angle about the axis in radians, right-handed, within `[-pi, pi]`.
    pub twist_angle_rad: f64,
    /// Whether the twist was undefined and the identity was put in its place.
    pub is_degenerate: bool,
}

/// Splits `rotation` into a twist about `axis` and the swing that follows it.
pub fn swing_twist(rotation: DQuat, axis: DVec3) -> SwingTwist {
    let norm = rotation.length();
    let unit_axis = axis.try_normalize().unwrap_or(DVec3::ZERO);
    let unit = rotation * (1.0 / norm);
    let unit = if unit.w < 0.0 { -unit } else { unit };
    let along = unit.xyz().dot(unit_axis);
    let projection = libm::hypot(along, unit.w);
    if unit_axis == DVec3::ZERO || projection <= DEGENERATE_SHARE {
        return SwingTwist {
            swing: unit,
            twist: DQuat::IDENTITY,
            twist_angle_rad: 0.0,
            is_degenerate: true,
        };
    }
    let twist = DQuat::from_vec4((unit_axis * along).extend(unit.w) / projection);
    SwingTwist {
        swing: unit * twist.conjugate(),
        twist,
        twist_angle_rad: 2.0 * libm::atan2(along, unit.w),
        is_degenerate: false,
    }
}
