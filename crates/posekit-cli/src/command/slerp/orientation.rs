//! Orientations as words of the command line.

use glam::DQuat;
use posekit::rotation::EulerOrder;

use crate::failure::Failure;

/// Three angles in degrees, or a quaternion of any length but none.
pub(super) fn read(text: &str, order: EulerOrder) -> Result<DQuat, Failure> {
    let wrong = || {
        Failure::usage(format!("'{text}' is not an orientation"))
            .try_next("write three angles in degrees, such as 10,0,-45, or a quaternion x,y,z,w")
    };
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| {
            part.trim()
                .parse()
                .ok()
                .filter(|number: &f64| number.is_finite())
        })
        .collect::<Option<_>>()
        .ok_or_else(wrong)?;
    match numbers[..] {
        [a, b, c] => Ok(order.to_quat([a, b, c].map(f64::to_radians))),
        [x, y, z, w] => {
            let quat = DQuat::from_xyzw(x, y, z, w);
            let length = quat.length();
            if length > 0.0 && length.is_finite() {
                Ok(quat * (1.0 / length))
            } else {
                Err(wrong())
            }
        }
        _ => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_and_quaternions_are_read() {
        let angles = read("0, 90,0", EulerOrder::XYZ).unwrap();
        let quat = read("0,2,0,2", EulerOrder::XYZ).unwrap();
        assert!(angles.dot(quat).abs() > 1.0 - 1e-12);
        for wrong in [
            "",
            "1",
            "1,2",
            "0,0,0,0",
            "a,b,c",
            "1,2,3,4,5",
            "nan,0,0",
            "1e308,1e308,0,0",
        ] {
            assert!(read(wrong, EulerOrder::XYZ).is_err(), "{wrong}");
        }
    }
}
