//! Mechanisms: a skeleton whose joints each move in few ways, said by few numbers.
//!
//! A motion-captured figure's joints turn freely; a robot's turn about one axis, or slide along one. A
//! [`Mechanism`] is a [`Skeleton`] and, for each joint, its [`Freedom`], the range of its value and the
//! joint that it follows, if any. [`Mechanism::local_pose`] turns *values* (generalised coordinates) into
//! a [`LocalPose`](crate::pose::LocalPose), from where on robots and figures go the same way; [`Mechanism::values_of`] goes back.
//!
//! Space and units: values are radians and the skeleton's length unit. Axes are in the joint's own frame
//! at rest, so that a joint's transform in its parent's space is its rest transform times its motion.
//! Rest transforms are kept in `f64` here: a solver that is asked for a micrometre needs them, though
//! poses are `f32`.
//!
//! The values of all joints make one list, in topological order of their joints; a fixed joint and one
//! that follows another have none. [`Freedom`] says how many each has.
//!
//! ```
//! use glam::{DVec3, Vec3};
//! use posekit::mechanism::{Freedom, Mechanism};
//! use posekit::skeleton::SkeletonBuilder;
//!
//! let mut builder = SkeletonBuilder::new();
//! let base = builder.joint("base", None, Vec3::ZERO);
//! let elbow = builder.joint("elbow", Some(base), Vec3::X);
//! builder.end_site("tip", elbow, Vec3::X);
//! let about_z = Freedom::Hinge { axis: DVec3::Z };
//! let arm = Mechanism::of(builder.build()?, [about_z, about_z, Freedom::Fixed])?;
//! let quarter = core::f64::consts::FRAC_PI_2;
//! let frames = arm.global_frames(&[quarter, -quarter]);
//! assert!((frames[2].position - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod build;
mod kinematics;

use std::sync::Arc;

use glam::{DQuat, DVec3};

pub use build::MechanismError;

use crate::skeleton::{JointId, Skeleton};

/// The ways in which a joint may move from its rest transform, and the numbers that say how far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Freedom {
    /// Not at all: no values.
    #[default]
    Fixed,
    /// It turns about an axis: one angle.
    Hinge {
        /// The unit axis in the joint's frame.
        axis: DVec3,
    },
    /// It slides along an axis: one length.
    Slide {
        /// The unit axis in the joint's frame.
        axis: DVec3,
    },
    /// It slides in a plane and turns about its normal: two lengths along the plane's own X and Y, then
    /// an angle. The plane's axes are those of the joint, turned the shortest way so that Z is the normal.
    Planar {
        /// The unit normal in the joint's frame.
        normal: DVec3,
    },
    /// It turns every way: a rotation vector, three numbers.
    Ball,
    /// It moves and turns every way: a translation, then a rotation vector, six numbers.
    Free,
}

impl Freedom {
    /// How many numbers say where such a joint stands.
    pub const fn value_count(self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Hinge { .. } | Self::Slide { .. } => 1,
            Self::Planar { .. } | Self::Ball => 3,
            Self::Free => 6,
        }
    }
}

/// The values that a hinge or a slide may take, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// The least value; minus infinity for none.
    pub lower: f64,
    /// The largest value, not below `lower`; infinity for none.
    pub upper: f64,
}

impl ValueRange {
    /// No bounds.
    pub const FREE: Self = Self {
        lower: f64::NEG_INFINITY,
        upper: f64::INFINITY,
    };

    /// The value in the range that is nearest to this one.
    pub fn clamp(self, value: f64) -> f64 {
        value.max(self.lower).min(self.upper)
    }

    /// Whether the range has this value.
    pub fn contains(self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Whether it has both bounds.
    pub fn is_bounded(self) -> bool {
        self.lower.is_finite() && self.upper.is_finite()
    }
}

/// A joint's value follows another's: `value = multiplier * other + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// The joint that is followed; it has one value of its own.
    pub joint: JointId,
    /// How far this one goes for one unit of the other.
    pub multiplier: f64,
    /// Where it is when the other is at zero.
    pub offset: f64,
}

/// How one joint of a mechanism moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MechanismJoint {
    /// Its rotation in its parent's space at rest; a unit quaternion.
    pub rest_rotation: DQuat,
    /// Its translation in its parent's space at rest.
    pub rest_translation: DVec3,
    /// The ways in which it moves from there.
    pub freedom: Freedom,
    /// The values that a hinge or slide may take; [`ValueRange::FREE`] for other joints.
    pub range: ValueRange,
    /// The joint that it follows, for a hinge or slide without a value of its own.
    pub follows: Option<Follow>,
}

/// A frame in world space: where a joint is and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its place.
    pub position: DVec3,
    /// Its orientation, a unit quaternion.
    pub orientation: DQuat,
}

impl Frame {
    /// The world's own frame.
    pub const IDENTITY: Self = Self {
        position: DVec3::ZERO,
        orientation: DQuat::IDENTITY,
    };
}

/// A skeleton and how each of its joints moves. Checked once; immutable.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    skeleton: Arc<Skeleton>,
    joints: Vec<MechanismJoint>,
    /// Joint `j`'s own values are `values[first_values[j]..first_values[j + 1]]`.
    first_values: Vec<u32>,
    /// For a joint that follows another: the value that it depends on in the end, and how.
    followed_values: Vec<Option<FollowedValue>>,
}

/// A follower's value as a function of one of the mechanism's own values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FollowedValue {
    /// The index among the mechanism's values.
    pub(crate) index: usize,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

impl Mechanism {
    /// The skeleton.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// How every joint moves, in topological order.
    pub fn joints(&self) -> &[MechanismJoint] {
        &self.joints
    }

    /// How a joint moves.
    pub fn joint(&self, joint: JointId) -> &MechanismJoint {
        &self.joints[joint.index()]
    }

    /// How many numbers say where the mechanism stands: its degrees of freedom.
    pub fn value_count(&self) -> usize {
        self.first_values[self.joints.len()] as usize
    }

    /// Where a joint's own values stand in the list of all; empty for a joint without any.
    pub fn values_of_joint(&self, joint: JointId) -> std::ops::Range<usize> {
        let first = self.first_values[joint.index()] as usize;
        first..self.first_values[joint.index() + 1] as usize
    }

    /// The joints that have values of their own, in the order of the values.
    pub fn moving_joints(&self) -> impl Iterator<Item = JointId> + '_ {
        let joints = self.skeleton.joints();
        joints.filter(|&joint| !self.values_of_joint(joint).is_empty())
    }

    /// The range of every value; [`ValueRange::FREE`] for those of planar, ball and free joints.
    ///
    /// A joint that others follow is held to what their ranges leave of its own, as far as that is not
    /// nothing.
    pub fn value_ranges(&self) -> Vec<ValueRange> {
        let mut ranges = vec![ValueRange::FREE; self.value_count()];
        for joint in self.skeleton.joints() {
            let values = self.values_of_joint(joint);
            if values.len() == 1 {
                ranges[values.start] = self.joint(joint).range;
            }
        }
        for (joint, followed) in self.joints.iter().zip(&self.followed_values) {
            if let Some(followed) = followed {
                narrow(&mut ranges[followed.index], joint.range, *followed);
            }
        }
        ranges
    }

    pub(crate) fn followed_value(&self, joint: JointId) -> Option<FollowedValue> {
        self.followed_values[joint.index()]
    }
}

/// Cuts from a followed value's range what would take its follower out of its own.
fn narrow(range: &mut ValueRange, follower: ValueRange, followed: FollowedValue) {
    if followed.multiplier == 0.0 {
        return;
    }
    let bounds = [follower.lower, follower.upper]
        .map(|bound| (bound - followed.offset) / followed.multiplier);
    let lower = range.lower.max(bounds[0].min(bounds[1]));
    let upper = range.upper.min(bounds[0].max(bounds[1]));
    if lower <= upper {
        *range = ValueRange { lower, upper };
    }
}
