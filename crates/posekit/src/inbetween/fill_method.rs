//! How a whole figure is filled in.

use std::fmt;
use std::str::FromStr;

use super::method::{Method, MethodError};
use crate::rotation::EulerOrder;
use crate::skeleton::JointId;

/// One method for all joints, or the Euler angles that each joint's own channels have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FillMethod {
    /// The same for all joints.
    Same(Method),
    /// Euler angles, each joint's in the order of its channels.
    OwnEuler,
}

impl FillMethod {
    /// What is compared when nothing else is asked for.
    pub const USUAL: [Self; 6] = [
        Self::Same(Method::Slerp),
        Self::Same(Method::Nlerp),
        Self::Same(Method::Matrix),
        Self::Same(Method::RotationVector),
        Self::OwnEuler,
        Self::Same(Method::Squad),
    ];

    /// The method for a joint. `orders` are the joints' own; one that cannot make every rotation stands for
    /// itself all the same, as what its channels hold is all that it can turn.
    #[must_use]
    pub fn of(self, joint: JointId, orders: &[EulerOrder]) -> Method {
        match self {
            Self::Same(method) => method,
            Self::OwnEuler => {
                let order = orders.get(joint.index());
                Method::Euler(order.copied().unwrap_or(EulerOrder::ZXY))
            }
        }
    }
}

impl FromStr for FillMethod {
    type Err = MethodError;

    /// `euler` alone is each joint's own.
    fn from_str(word: &str) -> Result<Self, MethodError> {
        if word == "euler" {
            return Ok(Self::OwnEuler);
        }
        word.parse().map(Self::Same)
    }
}

impl fmt::Display for FillMethod {
    /// The word that [`FromStr`] reads.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same(method) => method.fmt(f),
            Self::OwnEuler => f.write_str("euler"),
        }
    }
}
