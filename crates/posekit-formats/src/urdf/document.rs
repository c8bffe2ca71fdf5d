//! The URDF document: what a file says, in the file's own axes and units.

/// A robot: links, and the joints that connect them to a tree.
///
/// Values are kept as the file gave them: metres and radians, Z up as a rule, `f64`. What is kept is
/// what says where things are, how they move and how they look, and what links weigh; their inertia, collision shapes,
/// transmissions and the extensions of simulators are not.
///
/// Invariants that [`read`](super::read()) guarantees: the joints make one tree of all links, with
/// [`root`](Self::root) as its root; names are unique among links and among joints; every number is
/// finite; no joint mimics itself, however indirectly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Urdf {
    /// The robot's name.
    pub name: String,
    /// The rigid pieces, in the file's order.
    pub links: Vec<UrdfLink>,
    /// The connections, in the file's order.
    pub joints: Vec<UrdfJoint>,
    /// The index of the one link that is no joint's child.
    pub root: usize,
}

/// A rigid piece. Its frame is that of the joint which it hangs from.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfLink {
    /// Its name, unique among links.
    pub name: String,
    /// What is seen of it.
    pub visuals: Vec<UrdfVisual>,
    /// Its mass in kilograms, as its `<inertial>` says; `None` without one.
    pub mass_kg: Option<f64>,
}

/// A connection between two links.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfJoint {
    /// Its name, unique among joints.
    pub name: String,
    /// How it moves.
    pub kind: UrdfJointKind,
    /// The index of the link that it is mounted on.
    pub parent: usize,
    /// The index of the link that it carries.
    pub child: usize,
    /// Where it is in the parent link's frame, at rest.
    pub origin: UrdfOrigin,
    /// The unit axis in the joint's own frame that it turns about or slides along; of a planar joint
    /// the normal of its plane.
    pub axis: [f64; 3],
    /// How far and how fast it goes; a revolute or prismatic joint should have it.
    pub limit: Option<UrdfLimit>,
    /// The joint that it follows.
    pub mimic: Option<UrdfMimic>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum UrdfJointKind {
    /// Turns about its axis within limits.
    Revolute,
    /// Turns about its axis without end.
    Continuous,
    /// Slides along its axis within limits.
    Prismatic,
    /// Does not move.
    Fixed,
    /// Moves and turns in all six ways.
    Floating,
    /// Slides in the plane perpendicular to its axis and turns about it.
    Planar,
}

impl UrdfJointKind {
    /// All kinds.
    pub const ALL: [Self; 6] = [
        Self::Revolute,
        Self::Continuous,
        Self::Prismatic,
        Self::Fixed,
        Self::Floating,
        Self::Planar,
    ];

    /// The word in the file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Continuous => "continuous",
            Self::Prismatic => "prismatic",
            Self::Fixed => "fixed",
            Self::Floating => "floating",
            Self::Planar => "planar",
        }
    }

    /// How many numbers say where it stands.
    pub const fn value_count(self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Revolute | Self::Continuous | Self::Prismatic => 1,
            Self::Planar => 3,
            Self::Floating => 6,
        }
    }
}

/// A frame in another one: a place, and turns about the fixed axes X, then Y, then Z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UrdfOrigin {
    /// Metres.
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw in radians: the rotation is `Rz(yaw) * Ry(pitch) * Rx(roll)`.
    pub rpy: [f64; 3],
}

/// How far, how strongly and how fast a joint goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UrdfLimit {
    /// The least value in radians or metres.
    pub lower: f64,
    /// The largest value in radians or metres, not less than `lower`.
    pub upper: f64,
    /// The largest torque or force in newton metres or newtons, if the file gives it.
    pub effort: Option<f64>,
    /// The largest speed in radians or metres per second, if the file gives it.
    pub velocity: Option<f64>,
}

/// `value = multiplier * value of the other joint + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UrdfMimic {
    /// The index of the joint that is followed.
    pub joint: usize,
    /// How far this one goes for one radian or metre of the other.
    pub multiplier: f64,
    /// Where it is when the other is at zero.
    pub offset: f64,
}

/// A shape that is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfVisual {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Where it is in the link's frame.
    pub origin: UrdfOrigin,
    /// What it is.
    pub shape: UrdfShape,
    /// Red, green, blue and opacity from 0 to 1, if the file gives a colour.
    pub color: Option<[f64; 4]>,
    /// The file name of the texture as the file gives it, if it has one.
    pub texture: Option<String>,
}

/// The geometry of a [`UrdfVisual`]. Lengths are metres.
#[derive(Clone, Debug, PartialEq)]
pub enum UrdfShape {
    /// A box around the origin.
    Box {
        /// Its whole length along X, Y and Z.
        size: [f64; 3],
    },
    /// A cylinder around the origin, along Z.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its whole length.
        length: f64,
    },
    /// A ball around the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A mesh in another file.
    Mesh {
        /// Where it is, as the file says it: often `package://...`.
        filename: String,
        /// Factors along X, Y and Z.
        scale: [f64; 3],
    },
}
