//! Laws that rotations obey whatever the numbers are, as property tests.

use std::f64::consts::PI;

use glam::{DMat3, DQuat, DVec3};
use posekit::rotation::{
    Axis, EulerOrder, RotationMatrixError, angle_between, angular_velocity_in_body,
    angular_velocity_in_world, exp, exp_matrix, log, matrix_from_quat, nearest_rotation, nlerp,
    nlerp_f32, quat_from_matrix, slerp, slerp_f32, slerp_matrix, swing_twist,
};
use proptest::prelude::*;

fn orientation() -> impl Strategy<Value = DQuat> {
    prop::array::uniform4(-1.0..1.0_f64)
        .prop_filter("no direction", |c| {
            c.iter().map(|x| x * x).sum::<f64>() > 1e-3
        })
        .prop_map(|c| DQuat::from_array(c).normalize())
}

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0_f64).prop_map(move |c| DVec3::from_array(c) * size)
}

fn any_order() -> impl Strategy<Value = EulerOrder> {
    prop::collection::vec(prop::sample::select(&Axis::ALL[..]), 0..=3)
        .prop_map(|axes| EulerOrder::new(&axes).expect("at most three axes"))
}

fn complete_order() -> impl Strategy<Value = EulerOrder> {
    any_order().prop_filter("incomplete", EulerOrder::is_complete)
}

fn angles() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-10.0..10.0_f64)
}

proptest! {
    #[test]
    fn euler_angles_rebuild_the_rotation(order in complete_order(), q in orientation()) {
        let euler = order.from_quat(q);
        let tolerance = if euler.gimbal_lock { 4e-12 } else { 1e-14 };
        prop_assert!(angle_between(order.to_quat(euler.angles_rad), q) < tolerance);
        prop_assert!(euler.angles_rad.iter().all(|a| a.abs() <= PI));
        prop_assert_eq!(euler.residual_rad, 0.0);
        let opposite = order.from_quat(-q);
        prop_assert!(angle_between(order.to_quat(opposite.angles_rad), q) < tolerance);
    }

    #[test]
    fn what_an_order_made_it_reads_back(order in any_order(), angles in angles()) {
        let q = order.to_quat(angles);
        let euler = order.from_quat(q);
        // The residual's sine comes from a difference of squares' roots: the root of rounding.
        prop_assert!(euler.residual_rad < 1e-7);
        prop_assert!(angle_between(order.to_quat(euler.angles_rad), q) < 4e-12);
    }

    #[test]
    fn the_residual_is_the_angle_left_and_no_neighbour_is_nearer(
        order in any_order(), q in orientation(), step in prop::array::uniform3(-0.1..0.1_f64),
    ) {
        let euler = order.from_quat(q);
        let left = angle_between(order.to_quat(euler.angles_rad), q);
        prop_assert!((left - euler.residual_rad).abs() < 1e-11);
        let moved: [f64; 3] = std::array::from_fn(|i| euler.angles_rad[i] + step[i]);
        prop_assert!(angle_between(order.to_quat(moved), q) >= left - 1e-11);
    }

    #[test]
    fn equivalent_angles_make_the_same_rotation_and_are_near(
        order in any_order(), angles in angles(), previous in angles(),
    ) {
        let found = order.closest_equivalent_rad(angles, previous);
        prop_assert!(angle_between(order.to_quat(found), order.to_quat(angles)) < 1e-13);
        for i in 0..order.axes().len() {
            prop_assert!((found[i] - previous[i]).abs() <= PI + 1e-12);
        }
    }

    #[test]
    fn a_smooth_motion_has_smooth_angles(
        order in complete_order(), q in orientation(), axis in vector(1.0),
    ) {
        // Away from the lock, the angles must follow small steps of the rotation with small steps.
        let mut previous = order.from_quat(q).angles_rad;
        for step in 1..200 {
            let now = exp(axis * (0.01 * f64::from(step))) * q;
            let euler = order.from_quat_near(now, previous);
            prop_assert!(angle_between(order.to_quat(euler.angles_rad), now) < 4e-12);
            let middle = euler.angles_rad[1];
            let proper = order.axes()[0] == order.axes()[2];
            let clearance = if proper { middle.sin().abs() } else { middle.cos().abs() };
            let moved = (0..3).map(|i| (euler.angles_rad[i] - previous[i]).abs()).fold(0.0, f64::max);
            prop_assert!(clearance < 0.2 || moved < 0.2, "{previous:?} {euler:?}");
            previous = euler.angles_rad;
        }
    }

    #[test]
    fn exp_of_log_is_the_rotation(q in orientation()) {
        prop_assert!(angle_between(exp(log(q)), q) < 1e-14);
        prop_assert!((log(q) - log(-q)).length() == 0.0);
        prop_assert!(log(q).length() <= PI);
    }

    #[test]
    fn log_of_exp_is_the_vector(direction in vector(1.0), exponent in -300..0_i32) {
        let v = direction * 1.8 * 10_f64.powi(exponent);
        prop_assume!(v.length() < PI);
        prop_assert!((log(exp(v)) - v).length() <= 1e-14 * v.length());
        let m = exp_matrix(v);
        prop_assert!(m.abs_diff_eq(matrix_from_quat(exp(v)), 1e-15));
    }

    #[test]
    fn matrix_and_quaternion_are_each_others_inverse(q in orientation()) {
        let m = matrix_from_quat(q);
        prop_assert!(angle_between(quat_from_matrix(&m).unwrap(), q) < 1e-14);
        prop_assert!(matrix_from_quat(q * 5.0).abs_diff_eq(m, 1e-15));
        prop_assert!((m * DVec3::X - q * DVec3::X).length() < 1e-15);
    }

    #[test]
    fn any_matrix_gives_a_rotation_or_a_reason(
        entries in prop::array::uniform9(-1.0..1.0_f64), exponent in -300..300_i32,
    ) {
        let matrix = DMat3::from_cols_array(&entries.map(|e| e * 10_f64.powi(exponent)));
        match nearest_rotation(&matrix) {
            Ok(rotation) => {
                let gram = rotation.transpose() * rotation;
                prop_assert!(gram.abs_diff_eq(DMat3::IDENTITY, 1e-14));
                prop_assert!(rotation.determinant() > 0.0);
                // The polar factor is the one that leaves a symmetric rest.
                let rest = rotation.transpose() * DMat3::from_cols_array(&entries);
                prop_assert!(rest.abs_diff_eq(rest.transpose(), 1e-12));
            }
            Err(RotationMatrixError::Improper { determinant }) => prop_assert!(determinant < 0.0),
            Err(reason) => {
                let is_singular = matches!(reason, RotationMatrixError::Singular { .. });
                prop_assert!(is_singular && DMat3::from_cols_array(&entries).determinant().abs() < 1e-9);
            }
        }
    }

    #[test]
    fn slerp_has_constant_speed_and_is_symmetric(
        a in orientation(), b in orientation(), t in 0.0..1.0_f64,
    ) {
        let whole = angle_between(a, b);
        prop_assume!(whole < PI - 1e-3);
        let q = slerp(a, b, t);
        prop_assert!((q.length() - 1.0).abs() < 1e-12);
        prop_assert!((angle_between(a, q) - t * whole).abs() < 1e-11);
        prop_assert!((angle_between(q, b) - (1.0 - t) * whole).abs() < 1e-11);
        prop_assert!(angle_between(q, slerp(b, a, 1.0 - t)) < 1e-11);
        prop_assert!(angle_between(q, slerp(-a, b, t)) < 1e-11);
        let by_matrix = slerp_matrix(&matrix_from_quat(a), &matrix_from_quat(b), t).unwrap();
        prop_assert!(by_matrix.abs_diff_eq(matrix_from_quat(q), 1e-11));
    }

    #[test]
    fn slerp_and_nlerp_share_ends_middle_and_path(
        a in orientation(), b in orientation(), t in 0.0..1.0_f64,
    ) {
        prop_assume!(angle_between(a, b) < PI - 1e-3);
        for t in [0.0, 0.5, 1.0] {
            prop_assert!(angle_between(slerp(a, b, t), nlerp(a, b, t)) < 1e-11);
        }
        let straight = nlerp(a, b, t);
        // On the path: the angles to both ends add up to the whole.
        let sum = angle_between(a, straight) + angle_between(straight, b);
        prop_assert!((sum - angle_between(a, b)).abs() < 1e-7);
        prop_assert!(angle_between(slerp(a, b, t), straight) <= 8.2_f64.to_radians());
        let single = nlerp_f32(a.as_quat(), b.as_quat(), super::single(t)).as_dquat().normalize();
        prop_assert!(angle_between(single, straight) < 1e-3);
    }

    #[test]
    fn half_a_turn_apart_the_way_does_not_hang_on_signs(
        a in orientation(), axis in vector(1.0), t in 0.0..1.0_f64,
    ) {
        prop_assume!(axis.length() > 0.1);
        let b = a * DQuat::from_vec4(axis.normalize().extend(0.0));
        let q = slerp(a, b, t);
        for (start, end) in [(-a, b), (a, -b), (-a, -b)] {
            prop_assert!(angle_between(slerp(start, end, t), q) < 1e-12);
        }
        prop_assert!(angle_between(a * exp(log(a.conjugate() * b) * t), q) < 1e-12);
        let (a32, b32) = (a.as_quat(), b.as_quat());
        let flipped = slerp_f32(a32, -b32, 0.5).as_dquat().normalize();
        prop_assert!(angle_between(flipped, slerp_f32(a32, b32, 0.5).as_dquat().normalize()) < 1e-5);
    }

    #[test]
    fn swing_times_twist_is_the_rotation(q in orientation(), axis in vector(3.0)) {
        prop_assume!(axis.length() > 1e-3);
        let parts = swing_twist(q, axis);
        prop_assert!(angle_between(parts.swing * parts.twist, q) < 1e-14);
        let unit = axis.normalize();
        // The swing alone moves the axis, the twist leaves it.
        prop_assert!((parts.twist * unit - unit).length() < 1e-14);
        prop_assert!((parts.swing * unit - q * unit).length() < 1e-14);
        prop_assert!(parts.swing.w >= 0.0 && parts.twist.w >= 0.0);
        prop_assert!(parts.twist_angle_rad.abs() <= PI);
        // The twist is the nearest turn about the axis.
        for step in [-0.01, 0.01] {
            let other = exp(unit * (parts.twist_angle_rad + step));
            prop_assert!(angle_between(other, q) >= angle_between(parts.twist, q) - 1e-12);
        }
    }

    #[test]
    fn angular_velocity_leads_from_one_to_the_other(
        from in orientation(), to in orientation(), duration in 1e-3..10.0_f64,
    ) {
        let in_world = angular_velocity_in_world(from, to, duration);
        let in_body = angular_velocity_in_body(from, to, duration);
        prop_assert!(angle_between(exp(in_world * duration) * from, to) < 1e-13);
        prop_assert!(angle_between(from * exp(in_body * duration), to) < 1e-13);
        prop_assert!((in_world.length() * duration - angle_between(from, to)).abs() < 1e-13);
    }
}
