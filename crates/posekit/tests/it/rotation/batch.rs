//! The eight-lane conversion from Euler rows against the scalar one, which SciPy's numbers check.

use glam::Quat;
use posekit::rotation::{Axis, angle_between, compose_elementary, quats_from_euler_rows_deg};

/// Twice the error that the module documents for one sine or cosine, for each of up to three factors,
/// and the rounding of the result.
const TOLERANCE_RAD: f64 = 1.5e-6;

fn scalar(axes: &[Axis], row_deg: &[f64]) -> glam::DQuat {
    compose_elementary(
        axes.iter()
            .copied()
            .zip(row_deg.iter().map(|angle| angle.to_radians())),
    )
}

/// Every sequence of up to four axes.
fn sequences() -> Vec<Vec<Axis>> {
    let mut all = vec![Vec::new()];
    let mut longest = all.clone();
    for _ in 0..4 {
        longest = longest
            .iter()
            .flat_map(|axes| Axis::ALL.map(|axis| [axes.as_slice(), &[axis]].concat()))
            .collect();
        all.extend(longest.iter().cloned());
    }
    all
}

/// Angles over several turns, unrelated to each other.
fn angle_deg(index: usize) -> f64 {
    ((index * 7919) % 20011) as f64 * 0.1 - 1000.0
}

#[test]
fn every_sequence_and_every_remainder_agrees_with_the_scalar_product() {
    for axes in sequences() {
        for count in [0, 1, 7, 8, 9, 24, 29] {
            let rows: Vec<f64> = (0..count * axes.len())
                .map(|i| angle_deg(i + count))
                .collect();
            let mut rotations = vec![Quat::NAN; count];
            quats_from_euler_rows_deg(&axes, &rows, &mut rotations);
            for (frame, rotation) in rotations.iter().enumerate() {
                let row = &rows[frame * axes.len()..][..axes.len()];
                let angle = angle_between(rotation.as_dquat().normalize(), scalar(&axes, row));
                assert!(angle < TOLERANCE_RAD, "{axes:?} {row:?}: {angle:e}");
                assert!((rotation.length() - 1.0).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn sine_and_cosine_are_within_the_documented_error() {
    // One channel about X gives sine and cosine of half the angle themselves.
    let count = 400_000;
    for span_deg in [360.0, 3600.0, 360.0 * 1e6] {
        // Multiples of the golden ratio fill the span evenly and meet no special angle.
        let rows: Vec<f64> = (0..count)
            .map(|i| ((f64::from(i) * 0.618_033_988_749_894_9).fract() - 0.5) * span_deg)
            .collect();
        let mut rotations = vec![Quat::IDENTITY; rows.len()];
        quats_from_euler_rows_deg(&[Axis::X], &rows, &mut rotations);
        let mut worst = 0.0_f64;
        for (&angle, rotation) in rows.iter().zip(&rotations) {
            let (sin, cos) = libm::sincos((angle % 720.0).to_radians() * 0.5);
            let sign = if sin * f64::from(rotation.x) + cos * f64::from(rotation.w) < 0.0 {
                -1.0
            } else {
                1.0
            };
            worst = worst.max((sign * sin - f64::from(rotation.x)).abs());
            worst = worst.max((sign * cos - f64::from(rotation.w)).abs());
        }
        assert!(worst < 1.7e-7, "{worst:e} over {span_deg} degrees");
        assert!(
            worst > 1e-8,
            "an error this small means that nothing was compared: {worst:e}"
        );
    }
}

#[test]
fn exact_angles_and_bad_ones() {
    let mut rotations = [Quat::IDENTITY; 3];
    quats_from_euler_rows_deg(&[Axis::Z], &[0.0, 360.0, -7200.0], &mut rotations);
    assert_eq!(rotations, [Quat::IDENTITY; 3]);
    quats_from_euler_rows_deg(&[Axis::Z], &[f64::NAN, f64::INFINITY, 90.0], &mut rotations);
    assert!(rotations[0].is_nan() && rotations[1].is_nan());
    assert!(rotations[2].is_finite());
}

#[test]
#[should_panic(expected = "expected 3 angles for each of 2 rotations")]
fn a_wrong_row_count_panics() {
    quats_from_euler_rows_deg(&Axis::ALL, &[0.0; 5], &mut [Quat::IDENTITY; 2]);
}
