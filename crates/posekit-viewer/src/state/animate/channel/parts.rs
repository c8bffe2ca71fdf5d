//! Values and slopes of keys as the scalars that a graph shows, and back.

use glam::{DQuat, DVec3};
use posekit::keyframe::{KeyValue, angular_velocity_of_tangent, tangent_of_angular_velocity};
use posekit::rotation::EulerOrder;

use super::euler;

/// Up to three scalars: all that a value has. Those of an orientation are its angles in degrees, in the
/// order's sequence; what a value has not is zero.
pub(super) type Parts = [f64; 3];

/// What can be shown as scalars.
pub(super) trait InParts: KeyValue {
    /// How many it has.
    const COUNT: usize;

    /// The scalars; of an orientation the angles nearest to `near`.
    fn parts(self, order: EulerOrder, near: Parts) -> Parts;

    /// The value of scalars.
    fn of_parts(parts: Parts, order: EulerOrder) -> Self;

    /// The slopes of the scalars where the value has a derivative; `None` where they are not defined.
    fn slopes(self, derivative: Self, parts: Parts, order: EulerOrder) -> Option<Parts>;

    /// The derivative of a value whose scalars have these slopes. `before` is the derivative that it had:
    /// what scalars do not tell is kept.
    fn derivative(self, slopes: Parts, parts: Parts, order: EulerOrder, before: Self) -> Self;

    /// A derivative of `self` as one of another value: an orientation's turns along with it.
    fn carried(self, derivative: Self, to: Self) -> Self;

    /// Half way between two derivatives.
    fn mean(self, other: Self) -> Self;

    /// Scalar by scalar, by its place among them. Not for orientations, whose scalars are not their own.
    fn in_parts(value: Self, change: impl Fn(usize, f64) -> f64) -> Self;
}

impl InParts for f64 {
    const COUNT: usize = 1;

    fn parts(self, _order: EulerOrder, _near: Parts) -> Parts {
        [self, 0.0, 0.0]
    }

    fn in_parts(value: Self, change: impl Fn(usize, Self) -> Self) -> Self {
        change(0, value)
    }

    fn of_parts(parts: Parts, _order: EulerOrder) -> Self {
        parts[0]
    }

    fn slopes(self, derivative: Self, _parts: Parts, _order: EulerOrder) -> Option<Parts> {
        Some([derivative, 0.0, 0.0])
    }

    fn derivative(self, slopes: Parts, _parts: Parts, _order: EulerOrder, _before: Self) -> Self {
        slopes[0]
    }

    fn carried(self, derivative: Self, _to: Self) -> Self {
        derivative
    }

    fn mean(self, other: Self) -> Self {
        (self + other) * 0.5
    }
}

impl InParts for DVec3 {
    const COUNT: usize = 3;

    fn parts(self, _order: EulerOrder, _near: Parts) -> Parts {
        self.to_array()
    }

    fn in_parts(value: Self, change: impl Fn(usize, f64) -> f64) -> Self {
        Self::from_array(std::array::from_fn(|part| change(part, value[part])))
    }

    fn of_parts(parts: Parts, _order: EulerOrder) -> Self {
        Self::from_array(parts)
    }

    fn slopes(self, derivative: Self, _parts: Parts, _order: EulerOrder) -> Option<Parts> {
        Some(derivative.to_array())
    }

    fn derivative(self, slopes: Parts, _parts: Parts, _order: EulerOrder, _before: Self) -> Self {
        Self::from_array(slopes)
    }

    fn carried(self, derivative: Self, _to: Self) -> Self {
        derivative
    }

    fn mean(self, other: Self) -> Self {
        (self + other) * 0.5
    }
}

impl InParts for DQuat {
    const COUNT: usize = 3;

    fn in_parts(value: Self, _change: impl Fn(usize, f64) -> f64) -> Self {
        value
    }

    fn parts(self, order: EulerOrder, near: Parts) -> Parts {
        euler::angles_near_deg(order, self, near)
    }

    fn of_parts(parts: Parts, order: EulerOrder) -> Self {
        order.to_quat(parts.map(f64::to_radians))
    }

    fn slopes(self, derivative: Self, parts: Parts, order: EulerOrder) -> Option<Parts> {
        let in_body = angular_velocity_of_tangent(self, derivative);
        euler::rates_deg_per_sec(order, parts, in_body)
    }

    fn derivative(self, slopes: Parts, parts: Parts, order: EulerOrder, before: Self) -> Self {
        let in_body = euler::angular_velocity(order, parts, slopes);
        // The part along the quaternion turns nothing at the key, yet has its effect between keys.
        let along = self.dot(before) / self.length_squared();
        tangent_of_angular_velocity(self, in_body) + self * along
    }

    fn carried(self, derivative: Self, to: Self) -> Self {
        to * (self.conjugate() * derivative) * (1.0 / self.length_squared())
    }

    fn mean(self, other: Self) -> Self {
        (self + other) * 0.5
    }
}
