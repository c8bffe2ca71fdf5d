//! The three coordinate axes.

use glam::DVec3;

/// A coordinate axis, about which an elementary rotation turns or along which a position moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis, which points up.
    Y,
    /// The third axis.
    Z,
}

impl Axis {
    /// The three axes in their natural order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// 0 for X, 1 for Y, 2 for Z.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The unit vector along this axis.
    pub const fn unit(self) -> DVec3 {
        match self {
            Self::X => DVec3::X,
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }

    /// `X`, `Y` or `Z`.
    pub const fn letter(self) -> char {
        match self {
            Self::X => 'X',
            Self::Y => 'Y',
            Self::Z => 'Z',
        }
    }
}
