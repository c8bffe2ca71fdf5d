//! The ways from one orientation to another, by name.

use std::fmt;
use std::str::FromStr;

use crate::rotation::{EulerOrder, EulerOrderError};

/// A way from one orientation to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Method {
    /// `R1 exp(t log(R1^T R2))`: constant speed along the shortest way.
    Slerp,
    /// Slerp between the quaternions as they are given: the long way round where they lie more than half a
    /// turn apart, which is where the sign of one of them differs.
    RawSlerp,
    /// The chord between the quaternions, normalised.
    Nlerp,
    /// The chord between the quaternions, used as it is: it scales.
    RawLerp,
    /// The nine elements of the rotation matrix: no rotation in between.
    Matrix,
    /// The three components of the rotation vector.
    RotationVector,
    /// The angles of an order of axes.
    Euler(EulerOrder),
    /// Shoemake's curve through the keys before and after as well, which does not stop or bend at keys.
    Squad,
}

/// Why a word names no [`Method`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MethodError {
    /// Nobody knows it.
    #[error(
        "`{word}` is not a method; the methods are slerp, rawslerp, nlerp, lerp, matrix, rotvec, squad, and euler: with an order, such as euler:ZXY"
    )]
    Unknown {
        /// The word.
        word: String,
    },
    /// The order of axes is none.
    #[error(transparent)]
    Order(#[from] EulerOrderError),
    /// The order of axes cannot make every rotation.
    #[error(
        "`{order}` cannot make every rotation: it takes three axes, with no two neighbours equal"
    )]
    IncompleteOrder {
        /// The order.
        order: String,
    },
}

impl Method {
    /// Whether what it makes in between is a rotation; the others are measured on the nearest one.
    #[must_use]
    pub const fn makes_rotations(self) -> bool {
        !matches!(self, Self::RawLerp | Self::Matrix)
    }

    /// One of each, the Euler angles in the six orders of three different axes.
    pub const ALL: [Self; 13] = [
        Self::Slerp,
        Self::RawSlerp,
        Self::Nlerp,
        Self::RawLerp,
        Self::Matrix,
        Self::RotationVector,
        Self::Euler(EulerOrder::XYZ),
        Self::Euler(EulerOrder::XZY),
        Self::Euler(EulerOrder::YXZ),
        Self::Euler(EulerOrder::YZX),
        Self::Euler(EulerOrder::ZXY),
        Self::Euler(EulerOrder::ZYX),
        Self::Squad,
    ];
}

impl fmt::Display for Method {
    /// The word that [`FromStr`] reads.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slerp => f.write_str("slerp"),
            Self::RawSlerp => f.write_str("rawslerp"),
            Self::Nlerp => f.write_str("nlerp"),
            Self::RawLerp => f.write_str("lerp"),
            Self::Matrix => f.write_str("matrix"),
            Self::RotationVector => f.write_str("rotvec"),
            Self::Euler(order) => write!(f, "euler:{order}"),
            Self::Squad => f.write_str("squad"),
        }
    }
}

impl FromStr for Method {
    type Err = MethodError;

    fn from_str(word: &str) -> Result<Self, MethodError> {
        if let Some(order) = word.strip_prefix("euler:") {
            let order: EulerOrder = order.parse()?;
            if !order.is_complete() {
                return Err(MethodError::IncompleteOrder {
                    order: order.to_string(),
                });
            }
            return Ok(Self::Euler(order));
        }
        let known = Self::ALL
            .into_iter()
            .find(|method| method.to_string() == word);
        known.ok_or_else(|| MethodError::Unknown {
            word: word.to_owned(),
        })
    }
}
