//! Euler orders against SciPy.

use std::f64::consts::{FRAC_PI_2, PI};

use posekit::rotation::{EulerOrder, matrix_from_quat, quat_from_matrix};
use serde::Deserialize;

use super::padded;
use super::{GoldenMatrix, GoldenQuat, TIGHT, assert_close_matrix, assert_same_rotation, golden};

#[derive(Deserialize)]
struct Complete {
    order: String,
    angles: [f64; 3],
    quat: GoldenQuat,
    matrix: GoldenMatrix,
    scipy_angles: [f64; 3],
}

#[test]
fn complete_orders_agree_with_scipy_both_ways() {
    let mut orders = std::collections::BTreeSet::new();
    for case in golden::<Complete>("euler") {
        let order: EulerOrder = case.order.parse().unwrap();
        assert!(order.is_complete());
        orders.insert(order);
        let quat = order.to_quat(case.angles);
        assert_same_rotation(quat, case.quat.get(), TIGHT);
        assert_close_matrix(&matrix_from_quat(quat), &case.matrix.get(), TIGHT);
        assert_same_rotation(quat_from_matrix(&case.matrix.get()).unwrap(), quat, TIGHT);
        let euler = order.from_quat(case.quat.get());
        assert!(!euler.gimbal_lock);
        for i in 0..3 {
            // 0.01 rad from the lock the split loses two digits.
            assert!(
                (euler.angles_rad[i] - case.angles[i]).abs() < TIGHT,
                "{order} {euler:?}"
            );
            assert!((euler.angles_rad[i] - case.scipy_angles[i]).abs() < TIGHT);
        }
    }
    assert_eq!(orders.len(), 12);
}

#[derive(Deserialize)]
struct Gimbal {
    order: String,
    angles: [f64; 3],
    distance: f64,
    quat: GoldenQuat,
}

#[test]
fn gimbal_lock_keeps_the_rotation_and_is_flagged() {
    let mut flagged = 0;
    for case in golden::<Gimbal>("gimbal") {
        let order: EulerOrder = case.order.parse().unwrap();
        let euler = order.from_quat(case.quat.get());
        assert_same_rotation(order.to_quat(euler.angles_rad), case.quat.get(), 4e-12);
        assert!((euler.angles_rad[1] - case.angles[1]).abs() < TIGHT.max(4.0 * f64::EPSILON));
        if case.distance <= 1e-14 {
            assert!(euler.gimbal_lock, "{order} at {}", case.distance);
            assert_eq!(euler.angles_rad[2].abs(), 0.0);
            flagged += 1;
        }
        if case.distance >= 1e-11 {
            assert!(!euler.gimbal_lock, "{order} at {}", case.distance);
            // The documented conditioning, with a factor for the few roundings involved.
            let error = (euler.angles_rad[0] - case.angles[0]).abs();
            assert!(
                error.min((error - 2.0 * PI).abs()) < 2e-15 / case.distance,
                "{order} {error:e}"
            );
        }
    }
    assert_eq!(flagged, 12 * 2 * 2);
}

#[test]
fn in_gimbal_lock_the_split_follows_the_previous_angles() {
    for case in golden::<Gimbal>("gimbal") {
        if case.distance > 0.0 {
            continue;
        }
        let order: EulerOrder = case.order.parse().unwrap();
        let previous = [case.angles[0] + 0.01, case.angles[1], case.angles[2] + 0.02];
        let euler = order.from_quat_near(case.quat.get(), previous);
        assert!(euler.gimbal_lock);
        assert_same_rotation(order.to_quat(euler.angles_rad), case.quat.get(), 4e-12);
        for (found, previous) in euler.angles_rad.iter().zip(previous) {
            assert!((found - previous).abs() < 0.021, "{order} {euler:?}");
        }
    }
}

#[derive(Deserialize)]
struct Incomplete {
    order: String,
    angles: Vec<f64>,
    quat: GoldenQuat,
}

#[test]
fn incomplete_orders_agree_with_scipy() {
    for case in golden::<Incomplete>("incomplete") {
        let order: EulerOrder = case.order.parse().unwrap();
        assert!(!order.is_complete());
        let angles = padded(&case.angles);
        assert_same_rotation(order.to_quat(angles), case.quat.get(), TIGHT);
        let euler = order.from_quat(case.quat.get());
        assert!(
            euler.residual_rad < 1e-7,
            "residual {:e}",
            euler.residual_rad
        );
        let near = order.from_quat_near(case.quat.get(), angles);
        for i in 0..3 {
            assert!(
                (near.angles_rad[i] - angles[i]).abs() < TIGHT,
                "{order} {near:?} {angles:?}"
            );
        }
    }
}

#[derive(Deserialize)]
struct Nearest {
    order: String,
    quat: GoldenQuat,
    residual: f64,
}

#[test]
fn incomplete_orders_find_the_nearest_rotation() {
    for case in golden::<Nearest>("nearest") {
        let order: EulerOrder = case.order.parse().unwrap();
        let euler = order.from_quat(case.quat.get());
        // SciPy's minimiser is good to about the square root of its precision.
        assert!(
            (euler.residual_rad - case.residual).abs() < 1e-6,
            "{order} {euler:?}"
        );
        assert_same_rotation(
            order.to_quat(euler.angles_rad),
            case.quat.get(),
            euler.residual_rad + TIGHT,
        );
    }
}

#[test]
fn repeated_neighbours_are_one_turn() {
    for (text, reduced) in [("XX", "X"), ("XXY", "XY"), ("XYY", "XY"), ("ZZZ", "Z")] {
        let order: EulerOrder = text.parse().unwrap();
        let reduced: EulerOrder = reduced.parse().unwrap();
        assert!(!order.is_complete());
        let target = EulerOrder::XYZ.to_quat([0.4, -0.9, 1.3]);
        let (found, expected) = (order.from_quat(target), reduced.from_quat(target));
        assert_same_rotation(
            order.to_quat(found.angles_rad),
            reduced.to_quat(expected.angles_rad),
            TIGHT,
        );
        assert_eq!(
            found.residual_rad.to_bits(),
            expected.residual_rad.to_bits()
        );
    }
}

#[test]
fn two_axes_in_lock_leave_a_half_turn_unreached() {
    // Half a turn about Z is as far from every Rx * Ry as can be in one pair of half angles.
    let order: EulerOrder = "XY".parse().unwrap();
    let target = EulerOrder::XYZ.to_quat([0.3, 0.0, FRAC_PI_2]);
    let euler = order.from_quat(target);
    assert_same_rotation(
        order.to_quat(euler.angles_rad),
        target,
        euler.residual_rad + TIGHT,
    );
    assert!(euler.gimbal_lock);
    assert!((euler.residual_rad - FRAC_PI_2).abs() < TIGHT);
}

#[test]
fn the_degree_form_moves_whole_half_turns_only() {
    let order = EulerOrder::ZXY;
    assert_eq!(
        order.closest_equivalent_deg([-179.3, 10.25, 5.0], [179.9, 10.0, 5.0]),
        [-179.3 + 360.0, 10.25, 5.0]
    );
    // The mirror solution: 180 away on the outer axes, the middle reflected.
    assert_eq!(
        order.closest_equivalent_deg([10.0, 89.0, 20.0], [190.5, 91.0, 199.0]),
        [190.0, 91.0, 200.0]
    );
    let kept = [12.345678, -4.2, 33.0];
    assert_eq!(order.closest_equivalent_deg(kept, [0.0; 3]), kept);
    // No nearest angle to what is no number.
    assert_eq!(
        order.closest_equivalent_deg(kept, [f64::NAN, 0.0, f64::INFINITY]),
        kept
    );
}

#[test]
fn orders_are_read_and_printed() {
    for text in ["", "Z", "XY", "ZXY", "XYX", "YYX"] {
        let order: EulerOrder = text.parse().unwrap();
        assert_eq!(order.to_string(), text);
        assert_eq!(text.to_lowercase().parse::<EulerOrder>().unwrap(), order);
        assert_eq!(EulerOrder::new(order.axes()).unwrap(), order);
    }
    let refusal = |text: &str| text.parse::<EulerOrder>().unwrap_err().to_string();
    assert_eq!(refusal("XYZX"), "expected at most 3 rotation axes, found 4");
    assert_eq!(
        refusal("XQZ"),
        "expected X, Y or Z as letter 2 of a rotation order, found 'Q'"
    );
}
