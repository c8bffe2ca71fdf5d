//! The animated numbers of a joint, as motion files list them.

use crate::rotation::Axis;

/// One animated number of one joint: a coordinate of its translation in parent space, or one
/// elementary rotation of the sequence that makes its local rotation.
///
/// The order in which a joint lists its rotation channels is the order in which the elementary
/// rotations are multiplied, left to right: `Zrotation Xrotation Yrotation` means
/// `R = Rz * Rx * Ry` with column vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// A coordinate of the joint's translation in parent space, in the file's length unit.
    Position(Axis),
    /// An elementary rotation about one of the joint's own axes.
    Rotation(Axis),
}

impl Channel {
    /// The name that BVH files give it, such as `Xposition`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Position(Axis::X) => "Xposition",
            Self::Position(Axis::Y) => "Yposition",
            Self::Position(Axis::Z) => "Zposition",
            Self::Rotation(Axis::X) => "Xrotation",
            Self::Rotation(Axis::Y) => "Yrotation",
            Self::Rotation(Axis::Z) => "Zrotation",
        }
    }
}
