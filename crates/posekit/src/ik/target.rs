//! What an end effector is to reach.

use glam::{DQuat, DVec3};

use crate::skeleton::JointId;

/// Where a joint, or a point that is attached to its link, should be, and how it should be turned.
///
/// World space, the file's length unit, radians. An effector that is an End Site has no rotation of its
/// own: its orientation is its parent's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IkTarget {
    /// The joint that is to get there.
    pub effector: JointId,
    /// The point of the effector's link that is to be at `position_in_world`, in the effector's own
    /// space. Zero for the joint itself; the grip of a tool otherwise.
    pub point_in_effector: DVec3,
    /// Where the point should be. A target with a component that is not finite is not solved.
    pub position_in_world: DVec3,
    /// How the effector should be turned (from its own space to the world); `None` leaves it open.
    /// Need not be of unit length.
    pub orientation_in_world: Option<DQuat>,
    /// How much a miss in position counts beside the other targets; 0 for a target that asks for an
    /// orientation only. Solvers that take one target after the other use the larger one last.
    pub position_weight: f64,
    /// How much a miss in orientation counts beside the other orientations. What a radian counts
    /// against a unit of length is the solver's configuration.
    pub orientation_weight: f64,
}

impl IkTarget {
    /// A target for the joint itself: a position, no orientation, weight 1.
    pub fn position(effector: JointId, position_in_world: DVec3) -> Self {
        Self {
            effector,
            point_in_effector: DVec3::ZERO,
            position_in_world,
            orientation_in_world: None,
            position_weight: 1.0,
            orientation_weight: 1.0,
        }
    }

    /// The same target with an orientation to reach as well.
    #[must_use]
    pub fn with_orientation(mut self, orientation_in_world: DQuat) -> Self {
        self.orientation_in_world = Some(orientation_in_world);
        self
    }

    /// The same target for a point of the effector's link instead of the joint.
    #[must_use]
    pub fn with_point(mut self, point_in_effector: DVec3) -> Self {
        self.point_in_effector = point_in_effector;
        self
    }

    /// The same target with both weights set to `weight`.
    #[must_use]
    pub fn with_weight(mut self, weight: f64) -> Self {
        self.position_weight = weight;
        self.orientation_weight = weight;
        self
    }

    /// Whether all numbers are finite (squares of lengths too) and the orientation, if there is one, is a rotation.
    pub fn is_valid(&self) -> bool {
        let rotation_is_valid = self.orientation_in_world.is_none_or(|rotation| {
            let norm = rotation.length();
            norm.is_finite() && norm > 0.0
        });
        let weights = [self.position_weight, self.orientation_weight];
        self.position_in_world.length_squared().is_finite()
            && self.point_in_effector.length_squared().is_finite()
            && rotation_is_valid
            && weights
                .iter()
                .all(|weight| *weight >= 0.0 && weight.is_finite())
    }
}

/// Which way a chain should bend: a joint of it, such as an elbow or a knee, is drawn to the side of
/// the line from the chain's base to its effector on which a point lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// The joint that is drawn.
    pub joint: JointId,
    /// The point that it is drawn towards, in the world. One on the line from base to effector draws
    /// nowhere.
    pub point_in_world: DVec3,
    /// How much of the turn about that line is made in each iteration, from 0 to 1.
    pub weight: f64,
}
