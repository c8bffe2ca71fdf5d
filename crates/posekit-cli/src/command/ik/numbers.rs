//! Numbers as they are written on the command line.

use std::str::FromStr;

use glam::{DQuat, DVec3};
use posekit::rotation::EulerOrder;

/// Three numbers with commas between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vector(pub(super) DVec3);

impl FromStr for Vector {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match list(text).as_deref() {
            Some(&[x, y, z]) => Ok(Self(DVec3::new(x, y, z))),
            _ => Err("expected three numbers, such as 0.5,1.2,0".to_owned()),
        }
    }
}

/// How an effector should be turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Orientation {
    /// As it was in each frame.
    Hold,
    /// As the joint is that it follows.
    Follow,
    /// So, in the world.
    Fixed(DQuat),
}

impl FromStr for Orientation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "hold" => return Ok(Self::Hold),
            "follow" => return Ok(Self::Follow),
            _ => {}
        }
        let (order, numbers) = match text.split_once(':') {
            Some((order, numbers)) => (
                order
                    .parse::<EulerOrder>()
                    .map_err(|error| error.to_string())?,
                numbers,
            ),
            None => (EulerOrder::XYZ, text),
        };
        match list(numbers).as_deref() {
            Some(&[first, second, third]) if order.axes().len() == 3 => {
                let angles_rad = [first, second, third].map(f64::to_radians);
                Ok(Self::Fixed(order.to_quat(angles_rad)))
            }
            Some(&[x, y, z, w]) if !text.contains(':') => {
                let rotation = DQuat::from_xyzw(x, y, z, w);
                if rotation.length() > 1e-6 {
                    Ok(Self::Fixed(rotation.normalize()))
                } else {
                    Err("a quaternion of length zero is not an orientation".to_owned())
                }
            }
            _ => Err(
                "expected hold, follow, three angles in degrees (0,90,0 for XYZ, or ZXY:10,20,30) or \
                 a quaternion x,y,z,w"
                    .to_owned(),
            ),
        }
    }
}

/// Finite numbers with commas between them, or `None`.
pub(super) fn list(text: &str) -> Option<Vec<f64>> {
    text.split(',')
        .map(|number| number.trim().parse().ok().filter(|n: &f64| n.is_finite()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use posekit::rotation::angle_between;

    #[test]
    fn orientations_are_words_angles_or_quaternions() {
        assert_eq!("hold".parse(), Ok(Orientation::Hold));
        let quarter = DQuat::from_rotation_y(core::f64::consts::FRAC_PI_2);
        for text in ["0,90,0", "ZXY:0,0,90", "0,1,0,1"] {
            let Ok(Orientation::Fixed(rotation)) = text.parse() else {
                panic!("{text}");
            };
            assert!(angle_between(rotation, quarter) < 1e-12, "{text}");
        }
        for text in [
            "",
            "1,2",
            "ABC:1,2,3",
            "ZX:1,2",
            "0,0,0,0",
            "1,2,nan",
            "ZXY:0,0,0,1",
        ] {
            assert!(text.parse::<Orientation>().is_err(), "{text}");
        }
    }
}
