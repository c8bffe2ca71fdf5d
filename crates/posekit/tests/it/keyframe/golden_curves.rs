//! Curves between keys against SciPy's and the glTF specification's numbers.

use glam::{DQuat, DVec3};
use posekit::keyframe::{Extrapolation, Interpolation, Keyframe, Tangents, Track};
use posekit::rotation::angle_between;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::{quats, track};

pub(super) fn golden<T: DeserializeOwned>(section: &str) -> Vec<T> {
    let text = include_str!("../../golden/keyframe.json");
    let mut all: serde_json::Value = serde_json::from_str(text).expect("the golden file is JSON");
    let cases: Vec<T> =
        serde_json::from_value(all[section].take()).expect("the section has the expected form");
    assert!(!cases.is_empty(), "no cases in {section}");
    cases
}

#[derive(Deserialize)]
struct Orientations {
    times: Vec<f64>,
    values: Vec<[f64; 4]>,
    #[serde(default)]
    incoming: Vec<[f64; 4]>,
    #[serde(default)]
    outgoing: Vec<[f64; 4]>,
    at: Vec<f64>,
    expected: Vec<[f64; 4]>,
}

impl Orientations {
    #[track_caller]
    fn compare(&self, track: &Track<DQuat>, tolerance_rad: f64) {
        for (&time, expected) in self.at.iter().zip(quats(&self.expected)) {
            let found = track.sample(time);
            let angle = angle_between(found, expected);
            assert!(
                angle < tolerance_rad,
                "{angle:e} rad from {expected} at {time} s"
            );
            assert!((found.length() - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn linear_orientations_are_scipys_slerp_over_the_whole_track() {
    for case in golden::<Orientations>("slerp") {
        let track = track(&case.times, &quats(&case.values), Interpolation::Linear);
        case.compare(&track, 1e-12);
    }
}

#[test]
fn cubic_orientations_are_gltfs_cubicspline_whatever_the_signs() {
    for case in golden::<Orientations>("cubic_spline") {
        let [values, incoming, outgoing] =
            [&case.values, &case.incoming, &case.outgoing].map(|values| quats(values));
        let keys = (0..values.len()).map(|index| Keyframe {
            time_secs: case.times[index],
            value: values[index],
            interpolation: Interpolation::Cubic,
            tangents: Tangents::Broken {
                incoming: incoming[index],
                outgoing: outgoing[index],
            },
        });
        let track = Track::new(keys.collect(), Extrapolation::Hold).unwrap();
        // Curves through random tangents pass near zero, where the normalisation magnifies rounding.
        case.compare(&track, 1e-11);
        for index in 0..values.len() {
            let [before, after] = track.tangents_at(index);
            assert!((before - incoming[index]).length() < 1e-12);
            assert!((after - outgoing[index]).length() < 1e-12);
        }
    }
}

#[test]
fn squad_is_shoemakes() {
    for case in golden::<Orientations>("squad") {
        let track = track(&case.times, &quats(&case.values), Interpolation::Squad);
        case.compare(&track, 1e-12);
    }
}

#[derive(Deserialize)]
struct Vectors {
    times: Vec<f64>,
    values: Vec<[f64; 3]>,
    slopes: Vec<[f64; 3]>,
    at: Vec<f64>,
    expected: Vec<[f64; 3]>,
}

#[test]
fn cubic_vectors_are_scipys_hermite_spline() {
    for case in golden::<Vectors>("hermite") {
        let keys = (0..case.times.len()).map(|index| Keyframe {
            time_secs: case.times[index],
            value: DVec3::from_array(case.values[index]),
            interpolation: Interpolation::Cubic,
            tangents: Tangents::Aligned(DVec3::from_array(case.slopes[index])),
        });
        let track = Track::new(keys.collect(), Extrapolation::Hold).unwrap();
        for (&time, &expected) in case.at.iter().zip(&case.expected) {
            let found = track.sample(time);
            assert!(
                (found - DVec3::from_array(expected)).length() < 1e-12,
                "at {time} s"
            );
        }
    }
}

#[derive(Deserialize)]
struct Numbers {
    times: Vec<f64>,
    values: Vec<f64>,
    at: Vec<f64>,
    expected: Vec<f64>,
}

#[test]
fn smooth_numbers_lie_on_the_parabolas_slopes() {
    for case in golden::<Numbers>("catmull_rom") {
        let by_squad = track(&case.times, &case.values, Interpolation::Squad);
        let keys = case
            .times
            .iter()
            .zip(&case.values)
            .map(|(&time, &value)| Keyframe {
                tangents: Tangents::Smooth,
                ..Keyframe::new(time, value, Interpolation::Cubic)
            });
        let by_tangents = Track::new(keys.collect(), Extrapolation::Hold).unwrap();
        for (&time, &expected) in case.at.iter().zip(&case.expected) {
            assert!((by_squad.sample(time) - expected).abs() < 1e-11);
            assert!((by_tangents.sample(time) - expected).abs() < 1e-11);
        }
    }
}
