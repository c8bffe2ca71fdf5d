//! Angles of orientations over time, and how fast each of them changes.
//!
//! **Method.** For `R = R1(a1) R2(a2) R3(a3)` about the axes `u1, u2, u3` of an order, the angular velocity in
//! body coordinates is `w = (R2 R3)^-1 u1 a1' + R3^-1 u2 a2' + u3 a3'`: a linear map of the rates, whose
//! determinant is the cosine of the middle angle (for an order whose first and last axis are one, its sine).
//! In gimbal lock it is zero, and there are no rates.

use glam::{DMat3, DQuat, DVec3};
use posekit::rotation::{Axis, EulerOrder};

use super::parts::Parts;

/// Rates are given where the determinant is at least this: nearer to gimbal lock than three degrees they are
/// twenty times as large as what turns, and say nothing.
const LEAST_DETERMINANT: f64 = 0.05;

/// An order that can show every orientation: the one given if it can, otherwise its axes and then those
/// that it lacks.
pub(super) fn complete(order: EulerOrder) -> EulerOrder {
    if order.is_complete() {
        return order;
    }
    let mut axes: Vec<Axis> = Vec::with_capacity(3);
    for axis in order.axes().iter().copied().chain(Axis::ALL) {
        if !axes.contains(&axis) {
            axes.push(axis);
        }
    }
    EulerOrder::new(&axes).unwrap_or(EulerOrder::ZXY)
}

/// The angles of an orientation in degrees that lie nearest to others.
pub(super) fn angles_near_deg(order: EulerOrder, rotation: DQuat, near_deg: Parts) -> Parts {
    let near = near_deg.map(f64::to_radians);
    let angles = order.from_quat_near(rotation, near);
    angles.angles_rad.map(f64::to_degrees)
}

/// The columns of the map from the angles' rates to the angular velocity in body coordinates.
fn axes_in_body(order: EulerOrder, angles_deg: Parts) -> DMat3 {
    let [first, second, third]: [Axis; 3] = order.axes().try_into().unwrap_or(Axis::ALL);
    let turn = |axis: Axis, degrees: f64| {
        let order = EulerOrder::new(&[axis]).unwrap_or(EulerOrder::NONE);
        order.to_quat([degrees.to_radians(), 0.0, 0.0])
    };
    let last = turn(third, angles_deg[2]);
    let last_two = turn(second, angles_deg[1]) * last;
    DMat3::from_cols(
        last_two.conjugate() * first.unit(),
        last.conjugate() * second.unit(),
        third.unit(),
    )
}

/// The rates of the angles, degrees per second, at an angular velocity in body coordinates, radians per
/// second. `None` next to gimbal lock.
pub(super) fn rates_deg_per_sec(
    order: EulerOrder,
    angles_deg: Parts,
    in_body: DVec3,
) -> Option<Parts> {
    let axes = axes_in_body(order, angles_deg);
    if axes.determinant().abs() < LEAST_DETERMINANT {
        return None;
    }
    let rates = axes.inverse() * in_body;
    Some(rates.to_array().map(f64::to_degrees))
}

/// The angular velocity in body coordinates, radians per second, at which the angles have these rates in
/// degrees per second.
pub(super) fn angular_velocity(order: EulerOrder, angles_deg: Parts, rates: Parts) -> DVec3 {
    axes_in_body(order, angles_deg) * DVec3::from_array(rates.map(f64::to_radians))
}
