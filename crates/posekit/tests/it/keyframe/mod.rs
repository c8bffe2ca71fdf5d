//! Tracks against SciPy and the glTF specification (`tests/golden/make_keyframe.py`), their laws, and
//! what editing does.

mod animations;
mod editing;
mod euler;
mod golden_curves;
mod laws;
mod reduction;
mod sampler;

use glam::DQuat;
use posekit::keyframe::{Extrapolation, Interpolation, KeyValue, Keyframe, Track};

/// A track that holds beyond its keys.
fn track<V: KeyValue>(times: &[f64], values: &[V], interpolation: Interpolation) -> Track<V> {
    let keys = times.iter().zip(values);
    let keys = keys.map(|(&time, &value)| Keyframe::new(time, value, interpolation));
    Track::new(keys.collect(), Extrapolation::Hold).expect("keys of a track")
}

fn quats(values: &[[f64; 4]]) -> Vec<DQuat> {
    values
        .iter()
        .map(|&value| DQuat::from_array(value))
        .collect()
}
