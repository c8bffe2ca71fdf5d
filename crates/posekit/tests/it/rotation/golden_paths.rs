//! Exp and log, slerp, swing-twist, angular velocity and nearest matrices against SciPy and NumPy.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use posekit::rotation::{
    angle_between, angular_velocity_in_body, angular_velocity_in_world, exp, exp_matrix, log,
    log_matrix, matrix_from_quat, nearest_rotation, quat_from_matrix, slerp, slerp_f32,
    slerp_matrix, swing_twist,
};
use serde::Deserialize;

use super::{
    GoldenMatrix, GoldenQuat, TIGHT, assert_close, assert_close_matrix, assert_same_rotation,
    golden, single,
};

#[derive(Deserialize)]
struct ExpLog {
    vector: [f64; 3],
    quat: GoldenQuat,
    matrix: GoldenMatrix,
}

#[test]
fn exp_and_log_agree_with_scipy_from_tiny_angles_to_pi() {
    for case in golden::<ExpLog>("exp_log") {
        let vector = DVec3::from_array(case.vector);
        let relative = 1e-14 * vector.length();
        let quat = exp(vector);
        assert!((quat.xyz() - case.quat.get().xyz()).length() <= relative);
        assert_same_rotation(quat, case.quat.get(), TIGHT);
        assert_close(log(quat), vector, relative);
        assert_close(log(case.quat.get()), vector, relative);
        assert_close(log(-case.quat.get() * 3.0), vector, relative);
        assert_close_matrix(&exp_matrix(vector), &case.matrix.get(), 1e-15);
        // A matrix holds an angle below 1e-16 only in its sine terms, and all others to 1e-16.
        assert_close(log_matrix(&case.matrix.get()).unwrap(), vector, 1e-14);
    }
}

#[test]
fn the_log_of_half_a_turn_is_chosen_by_the_axis() {
    for axis in [
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::new(0.6, -0.8, 0.0),
        DVec3::new(0.0, 0.6, -0.8),
    ] {
        let half_turn = DQuat::from_vec4(axis.extend(0.0));
        for noise in [0.0, -0.0, 1e-16, -1e-16] {
            let noisy = DQuat::from_vec4(axis.extend(noise));
            assert_close(log(noisy), axis * PI, 1e-14);
            assert_close(log(-noisy), axis * PI, 1e-14);
        }
        assert_close(
            log_matrix(&matrix_from_quat(half_turn)).unwrap(),
            axis * PI,
            1e-14,
        );
    }
    assert_eq!(log(DQuat::IDENTITY), DVec3::ZERO);
    assert_eq!(log(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)), DVec3::ZERO);
    assert_eq!(exp(DVec3::ZERO), DQuat::IDENTITY);
}

#[derive(Deserialize)]
struct SlerpCase {
    kind: String,
    start: GoldenQuat,
    end: GoldenQuat,
    times: Vec<f64>,
    path: Vec<GoldenQuat>,
}

#[test]
fn slerp_agrees_with_scipy_long_way_pairs_included() {
    let mut long_ways = 0;
    for case in golden::<SlerpCase>("slerp") {
        let (start, end) = (case.start.get(), case.end.get());
        if case.kind == "long way" {
            assert!(start.dot(end) < 0.0);
            long_ways += 1;
        }
        let (start_matrix, end_matrix) = (matrix_from_quat(start), matrix_from_quat(end));
        for (&t, expected) in case.times.iter().zip(&case.path) {
            // Half a turn less 1e-3 magnifies rounding a thousand times, here and in SciPy.
            assert_same_rotation(slerp(start, end, t), expected.get(), TIGHT);
            let by_matrix = slerp_matrix(&start_matrix, &end_matrix, t).unwrap();
            assert_close_matrix(&by_matrix, &matrix_from_quat(expected.get()), TIGHT);
            let in_f32 = slerp_f32(start.as_quat(), end.as_quat(), single(t));
            assert_same_rotation(in_f32.as_dquat().normalize(), expected.get(), 1e-3);
            if case.kind != "nearly half a turn" {
                assert_same_rotation(in_f32.as_dquat().normalize(), expected.get(), 2e-6);
            }
        }
    }
    assert!(long_ways > 0);
}

#[derive(Deserialize)]
struct SwingTwistCase {
    axis: [f64; 3],
    quat: GoldenQuat,
    swing: GoldenQuat,
    twist: GoldenQuat,
    twist_angle: f64,
}

#[test]
fn swing_and_twist_are_the_parts_it_was_made_from() {
    for case in golden::<SwingTwistCase>("swing_twist") {
        let axis = DVec3::from_array(case.axis);
        for rotation in [case.quat.get(), -case.quat.get()] {
            for axis in [axis, axis * 7.0] {
                let parts = swing_twist(rotation, axis);
                assert!(!parts.is_degenerate);
                assert_same_rotation(parts.swing, case.swing.get(), TIGHT);
                assert_same_rotation(parts.twist, case.twist.get(), TIGHT);
                assert!((parts.twist_angle_rad - case.twist_angle).abs() < TIGHT);
                assert!(parts.swing.xyz().dot(axis).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn a_swing_of_half_a_turn_has_no_twist() {
    let parts = swing_twist(
        DQuat::from_rotation_x(PI) * DQuat::from_rotation_y(0.8),
        DVec3::Y,
    );
    assert!(parts.is_degenerate);
    assert_eq!(parts.twist, DQuat::IDENTITY);
    assert!(swing_twist(DQuat::IDENTITY, DVec3::ZERO).is_degenerate);
}

#[derive(Deserialize)]
struct AngularVelocityCase {
    from: GoldenQuat,
    to: GoldenQuat,
    duration: f64,
    in_world: [f64; 3],
    in_body: [f64; 3],
    angle: f64,
}

#[test]
fn angular_velocity_agrees_with_scipy_in_world_and_in_body() {
    for case in golden::<AngularVelocityCase>("angular_velocity") {
        let (from, to, duration) = (case.from.get(), case.to.get(), case.duration);
        let tolerance = TIGHT / duration;
        let in_world = angular_velocity_in_world(from, to, duration);
        assert_close(in_world, DVec3::from_array(case.in_world), tolerance);
        let in_body = angular_velocity_in_body(from, to, duration);
        assert_close(in_body, DVec3::from_array(case.in_body), tolerance);
        assert_close(from * in_body, in_world, tolerance);
        assert!((angle_between(from, to) - case.angle).abs() < TIGHT);
    }
}

#[derive(Deserialize)]
struct NearestMatrix {
    matrix: GoldenMatrix,
    nearest: GoldenMatrix,
}

#[test]
fn the_nearest_rotation_is_numpys_polar_factor() {
    for case in golden::<NearestMatrix>("nearest_matrix") {
        let nearest = nearest_rotation(&case.matrix.get()).unwrap();
        assert_close_matrix(&nearest, &case.nearest.get(), 1e-13);
        let quat = quat_from_matrix(&case.matrix.get()).unwrap();
        assert_close_matrix(&matrix_from_quat(quat), &case.nearest.get(), 1e-13);
    }
}
