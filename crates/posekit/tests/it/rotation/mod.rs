//! Rotations against SciPy's `Rotation` (`tests/golden/make_rotation.py`) and against their own laws.

mod batch;
mod golden_euler;
mod golden_paths;
mod laws;
mod single_precision;

use glam::{DMat3, DQuat, DVec3};
use posekit::rotation::angle_between;
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// What SciPy's numbers are expected to agree to: both sides round at about `1e-16`, a few times over.
const TIGHT: f64 = 1e-12;

/// The cases of one section of the golden file.
fn golden<T: DeserializeOwned>(section: &str) -> Vec<T> {
    let text = include_str!("../../golden/rotation.json");
    let mut all: serde_json::Value = serde_json::from_str(text).expect("the golden file is JSON");
    let cases: Vec<T> =
        serde_json::from_value(all[section].take()).expect("the section has the expected form");
    assert!(!cases.is_empty(), "no cases in {section}");
    cases
}

#[derive(Clone, Copy, Deserialize)]
struct GoldenQuat([f64; 4]);

#[derive(Clone, Copy, Deserialize)]
struct GoldenMatrix([[f64; 3]; 3]);

impl GoldenQuat {
    fn get(self) -> DQuat {
        DQuat::from_array(self.0)
    }
}

impl GoldenMatrix {
    /// Rows in the file, columns in glam.
    fn get(self) -> DMat3 {
        DMat3::from_cols_array_2d(&self.0).transpose()
    }
}

#[track_caller]
fn assert_same_rotation(found: DQuat, expected: DQuat, tolerance_rad: f64) {
    let angle = angle_between(found, expected);
    assert!(
        angle <= tolerance_rad,
        "{found} is {angle:e} rad from {expected}"
    );
}

#[track_caller]
fn assert_close(found: DVec3, expected: DVec3, tolerance: f64) {
    let distance = (found - expected).length();
    assert!(
        distance <= tolerance,
        "{found} is {distance:e} from {expected}"
    );
}

#[track_caller]
fn assert_close_matrix(found: &DMat3, expected: &DMat3, tolerance: f64) {
    assert!(
        found.abs_diff_eq(*expected, tolerance),
        "{found} is not {expected}"
    );
}

/// The first three values of a slice, zeros where it is shorter.
fn padded(values: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0))
}

/// The nearest single precision number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
fn single(value: f64) -> f32 {
    value as f32
}
