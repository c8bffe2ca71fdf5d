//! What a joint can do: limits, and how stiff it is.
//!
//! **Space.** A joint's local rotation is `rest * motion`; limits are about the motion, in the joint's own
//! rest frame. For a BVH, whose rest rotations are the identity, that is the local rotation itself; for a
//! URDF the rest transform is the joint's `origin` and the motion is what its `axis` and its position make.
//! Angles are radians and right-handed, distances in the file's unit.
//!
//! **Method.** A motion outside its limits is replaced by one within them ([`JointLimit::project`]): cones
//! by clamping swing and twist apart (Grassia 1998; Wilhelms and Van Gelder 2001, "Fast and Easy
//! Reach-Cone Joint Limits", J. Graphics Tools 6(2)), Euler ranges by clamping each angle of the solution
//! that has to be moved least, hinges by their twist.
//!
//! **Guarantees.** Projecting twice is the same as once, up to rounding. A motion within its limits is
//! returned as it is, to the bit. Nothing panics; a zero quaternion gives the rest position.

mod project;
mod sample;
mod table;

use glam::DVec3;

use crate::rotation::EulerOrder;

pub(crate) use project::clamp_angle;
pub use table::{JointLimitError, JointLimits};

/// All values from `min` to `max`, both included. `max` is not below `min`; infinite ends are no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least value.
    pub min: f64,
    /// The greatest value.
    pub max: f64,
}

impl Interval {
    /// No limit.
    pub const ALL: Self = Self {
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
    };

    /// From `min` to `max`.
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    /// From `-most` to `most`.
    pub const fn symmetric(most: f64) -> Self {
        Self {
            min: -most,
            max: most,
        }
    }

    /// Whether the value lies within.
    pub fn contains(self, value: f64) -> bool {
        self.min <= value && value <= self.max
    }

    /// The value, or the end that is nearer to it.
    pub fn clamp(self, value: f64) -> f64 {
        value.max(self.min).min(self.max)
    }

    /// Halfway between the ends; the finite end, or 0, where there is no such value.
    pub fn middle(self) -> f64 {
        match (self.min.is_finite(), self.max.is_finite()) {
            (true, true) => 0.5 * (self.min + self.max),
            (true, false) => self.min.max(0.0),
            (false, true) => self.max.min(0.0),
            (false, false) => 0.0,
        }
    }
}

/// What motion a joint allows, from its rest transform.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum JointLimit {
    /// A ball joint that turns any way.
    #[default]
    Free,
    /// A ball joint with a range for each of its Euler angles.
    Euler {
        /// The order of the angles, as the file's channels have it.
        order: EulerOrder,
        /// The range of each angle, in the order's sequence; entries beyond its axes mean nothing.
        angles_rad: [Interval; 3],
    },
    /// A ball joint whose bone stays within a cone: the twist about `axis` first, then the swing of it.
    Cone {
        /// The bone's direction at rest, of unit length.
        axis: DVec3,
        /// How far the axis may swing, from 0 to pi.
        swing_max_rad: f64,
        /// How far the joint may turn about the axis.
        twist_rad: Interval,
    },
    /// A joint that turns about one axis: an elbow, a URDF `revolute` or `continuous` joint.
    Hinge {
        /// The axis, of unit length.
        axis: DVec3,
        /// How far it may turn; a range of a full turn or more is no limit.
        angle_rad: Interval,
    },
    /// A joint that slides along one axis and does not turn: a URDF `prismatic` joint.
    Slide {
        /// The axis, of unit length.
        axis: DVec3,
        /// How far it may slide.
        distance: Interval,
    },
    /// A joint that does not move: it keeps whatever transform the pose gives it.
    Fixed,
}
