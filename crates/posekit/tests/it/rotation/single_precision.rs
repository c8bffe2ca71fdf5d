//! Single precision slerp against the double precision one, which SciPy's numbers check.

use glam::{DQuat, DVec3, Quat};
use posekit::rotation::{angle_between, exp, slerp, slerp_f32};

use super::single;

/// As documented.
const TOLERANCE_RAD: f64 = 6e-7;

/// Multiples of irrational numbers fill a cube evenly.
fn even(index: u32) -> DVec3 {
    let index = f64::from(index);
    DVec3::new(
        index * 0.819_172_5,
        index * 0.671_043_6,
        index * 0.549_700_5,
    )
    .fract()
        * 2.0
        - 1.0
}

/// Angle from the exact way, for the very numbers that single precision was given.
fn error_rad(start: Quat, end: Quat, t: f32) -> f64 {
    let exact = slerp(
        start.as_dquat().normalize(),
        end.as_dquat().normalize(),
        f64::from(t),
    );
    let found = slerp_f32(start, end, t);
    assert!((found.length() - 1.0).abs() < 5e-7, "{}", found.length());
    angle_between(found.as_dquat().normalize(), exact)
}

fn pair(index: u32, angle_rad: f64) -> (Quat, Quat) {
    let start = exp(even(index) * 3.0);
    let end: DQuat = start * exp(even(index + 77).normalize() * angle_rad);
    let sign = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    (start.as_quat(), end.as_quat() * sign)
}

#[test]
fn slerp_f32_is_within_its_documented_error() {
    let mut worst = 0.0_f64;
    for angle_deg in (0..1800).map(|tenths| f64::from(tenths) * 0.1) {
        for index in 0..40 {
            let (start, end) = pair(index + 1, angle_deg.to_radians());
            for t in 0..=10 {
                let t = single(f64::from(t) * 0.1);
                let error = error_rad(start, end, t);
                assert!(
                    error < TOLERANCE_RAD,
                    "{error:e} at {t} of {angle_deg} degrees"
                );
                worst = worst.max(error);
            }
        }
    }
    assert!(
        worst > 1e-8,
        "an error this small means that nothing was compared: {worst:e}"
    );
}

#[test]
fn slerp_f32_has_no_step_where_its_method_changes() {
    for index in 1..200 {
        for offset in -50..=50 {
            let angle_rad = 60_f64.to_radians() + f64::from(offset) * 1e-6;
            let (start, end) = pair(index, angle_rad);
            for t in [0.01, 0.3, 0.499_999_97, 0.5, 0.500_000_06, 0.77, 0.99] {
                let error = error_rad(start, end, t);
                assert!(error < TOLERANCE_RAD, "{error:e} at {t} of {angle_rad}");
            }
        }
    }
}

#[test]
fn slerp_f32_keeps_its_ends_and_goes_on_beyond_them() {
    for index in 1..500 {
        let (start, end) = pair(index, f64::from(index) * 0.006);
        for (t, expected) in [(0.0, start), (1.0, end)] {
            let found = slerp_f32(start, end, t);
            assert!(angle_between(found.as_dquat(), expected.as_dquat()) < 2e-7);
        }
        for t in [-0.7, 1.6] {
            assert!(error_rad(start, end, t) < 3e-6);
        }
    }
    assert!(slerp_f32(Quat::NAN, Quat::IDENTITY, 0.5).is_nan());
}
