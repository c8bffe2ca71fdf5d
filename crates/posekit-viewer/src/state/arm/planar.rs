//! The planar arm of two links, recognised in a mechanism: what the textbooks' formula is about.
//!
//! `x = l1 cos t1 + l2 cos(t1 + t2)`, `y = l1 sin t1 + l2 sin(t1 + t2)`, in the plane across the two
//! axes, from the first axis, x along the upper link when `t1` is zero.

use glam::{DQuat, DVec2, DVec3};
use posekit::ik::robot::{TwoLink, TwoLinkSolutions};
use posekit::mechanism::{Freedom, Mechanism};
use posekit::skeleton::JointId;

/// Axes and links count as lying in one plane when they miss it by less than this share of their
/// length.
const STRAIGHT: f64 = 1e-6;

/// A planar arm of two links, and where its plane is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarArm {
    /// The lengths.
    pub links: TwoLink,
    /// Where the plane's origin is, on the first axis, world space.
    pub origin: DVec3,
    /// World from the plane: x along the upper link when `t1` is zero, z the axis that angles turn
    /// about.
    pub axes: DQuat,
    /// The indices of `t1` and `t2` among the mechanism's values.
    pub values: [usize; 2],
    /// The elbow.
    pub elbow: JointId,
    /// The tip.
    pub tip: JointId,
}

impl PlanarArm {
    /// The planar arm that a mechanism is, if it has two hinges with parallel axes, both with values of
    /// their own, and is stretched when they are zero.
    #[must_use]
    pub fn find(mechanism: &Mechanism, tip: JointId) -> Option<Self> {
        if mechanism.value_count() != 2 {
            return None;
        }
        let skeleton = mechanism.skeleton();
        let moving: Vec<JointId> = mechanism.moving_joints().collect();
        let &[shoulder, elbow] = moving.as_slice() else {
            return None;
        };
        let carries = |joint: JointId, below: JointId| {
            skeleton.ancestors(below).any(|ancestor| ancestor == joint)
        };
        let is_chain = carries(shoulder, elbow) && (elbow == tip || carries(elbow, tip));
        let follows = mechanism
            .joints()
            .iter()
            .any(|joint| joint.follows.is_some());
        if !is_chain || follows {
            return None;
        }
        let frames = mechanism.global_frames(&[0.0, 0.0]);
        let axis = |joint: JointId| match mechanism.joint(joint).freedom {
            Freedom::Hinge { axis } => Some(frames[joint.index()].orientation * axis),
            _ => None,
        };
        let (first, second) = (axis(shoulder)?, axis(elbow)?);
        let place = |joint: JointId| frames[joint.index()].position;
        let upper = place(elbow) - place(shoulder);
        let fore = place(tip) - place(elbow);
        let across = |v: DVec3| v - first * v.dot(first);
        let (upper, fore) = (across(upper), across(fore));
        let links = TwoLink {
            upper: upper.length(),
            fore: fore.length(),
        };
        let size = links.upper.min(links.fore);
        let is_parallel = first.dot(second) > 1.0 - STRAIGHT;
        let is_stretched = upper.cross(fore).length() <= STRAIGHT * links.upper * links.fore
            && upper.dot(fore) > 0.0;
        if !is_parallel || !is_stretched || size <= 0.0 || !size.is_finite() {
            return None;
        }
        let x = upper / links.upper;
        let axes = DQuat::from_mat3(&glam::DMat3::from_cols(x, first.cross(x), first));
        Some(Self {
            links,
            origin: place(shoulder),
            axes: axes.normalize(),
            values: [
                mechanism.values_of_joint(shoulder).start,
                mechanism.values_of_joint(elbow).start,
            ],
            elbow,
            tip,
        })
    }

    /// The unit normal of the plane, world space.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.axes * DVec3::Z
    }

    /// A point of the world in the plane.
    #[must_use]
    pub fn in_plane(&self, point_in_world: DVec3) -> DVec2 {
        let local = self.axes.inverse() * (point_in_world - self.origin);
        local.truncate()
    }

    /// A point of the plane in the world.
    #[must_use]
    pub fn in_world(&self, point: DVec2) -> DVec3 {
        self.origin + self.axes * point.extend(0.0)
    }

    /// `[t1, t2]` of the mechanism's values.
    #[must_use]
    pub fn angles(&self, values: &[f64]) -> [f64; 2] {
        self.values.map(|index| values[index])
    }

    /// Both ways to reach a target in the plane.
    #[must_use]
    pub fn solve(&self, target_in_world: DVec3) -> TwoLinkSolutions {
        self.links.solve(self.in_plane(target_in_world))
    }

    /// The least distance from the first axis that the tip gets to when the elbow's angle stays within
    /// `upper` of zero on both sides.
    #[must_use]
    pub fn inner_radius(&self, largest_bend_rad: f64) -> f64 {
        self.links
            .tip(0.0, largest_bend_rad.min(core::f64::consts::PI))
            .length()
    }
}
