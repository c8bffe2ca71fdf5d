//! Animations by name, and at a frame rate.

use std::sync::Arc;

use posekit::keyframe::BakeConfig;
use posekit::motion::Motion;

use super::{Gltf, GltfAnimation};

/// An animation is baked to at most this many frames times joints: a gigabyte of rotations.
pub const MAX_BAKED_JOINTS: usize = 1 << 26;

/// Rates that animations are often made at, the likeliest first.
const RATES: [f64; 6] = [30.0, 24.0, 25.0, 60.0, 50.0, 120.0];

/// The rate of an animation whose keys keep to none of [`RATES`].
const OTHER_RATE: f64 = 60.0;

/// How far from a frame a key may be, in frames: times are rounded.
const OFF_FRAME: f64 = 0.01;

/// Why an animation was not baked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The file has no animation of this name.
    #[error("there is no animation `{name}`; there is {known}")]
    NoAnimation {
        /// The name.
        name: String,
        /// Those that there are, for people.
        known: String,
    },
    /// The rate is not a positive number.
    #[error("{frames_per_sec} frames a second are no rate")]
    NoRate {
        /// The rate.
        frames_per_sec: f64,
    },
    /// It would take more than [`MAX_BAKED_JOINTS`].
    #[error("{duration_secs} s at {frames_per_sec} frames a second are too long a motion")]
    TooLong {
        /// The duration in seconds.
        duration_secs: f64,
        /// The rate.
        frames_per_sec: f64,
    },
}

/// A name such as `knight.glb#Walking_A` as the file's and the animation's; all of it is the file's where there is
/// no `#` after the name of a glTF file.
pub fn file_and_animation(name: &str) -> (&str, Option<&str>) {
    match name.split_once('#') {
        Some((file, animation)) if super::is_gltf_name(file) => (file, Some(animation)),
        _ => (name, None),
    }
}

impl Gltf {
    /// The animation of this name as a motion at its own [rate](GltfAnimation::frames_per_sec); without a name
    /// the first one, or a frame of the rest pose where there is none.
    ///
    /// # Errors
    /// [`BakeError`] when there is no such animation, or it would be too long.
    pub fn motion(&self, animation: Option<&str>) -> Result<Motion, BakeError> {
        let chosen = match animation {
            Some(name) => Some(self.animation(name).ok_or_else(|| BakeError::NoAnimation {
                name: name.to_owned(),
                known: self.known_animations(),
            })?),
            None => self.animations.first(),
        };
        match chosen {
            Some(chosen) => chosen.bake(chosen.frames_per_sec()),
            None => {
                let skeleton = Arc::clone(&self.skeleton);
                let roots: Vec<_> = skeleton.roots().collect();
                Ok(Motion::at_rest(skeleton, 1, 1.0 / RATES[0], roots))
            }
        }
    }

    fn known_animations(&self) -> String {
        /// More names than this are no help in one line.
        const LISTED: usize = 8;
        let names: Vec<String> = self
            .animations
            .iter()
            .take(LISTED)
            .map(|animation| format!("`{}`", animation.name))
            .collect();
        match self.animations.len() {
            0 => "none".to_owned(),
            count if count > LISTED => format!("{} and {} more", names.join(", "), count - LISTED),
            _ => names.join(", "),
        }
    }
}

impl GltfAnimation {
    /// When its last key is, in seconds; it starts at 0.
    pub fn duration_secs(&self) -> f64 {
        let range = self.tracks.range_secs();
        range.map_or(0.0, |[_, end]| end.max(0.0))
    }

    /// The frame rate that its keys keep to, of those that are usual, or 60 where they keep to none. The file
    /// itself has none.
    pub fn frames_per_sec(&self) -> f64 {
        let times = self.tracks.key_times_secs(self.tracks.skeleton().joints());
        let keeps = |rate: &f64| {
            times
                .iter()
                .all(|time| (time * rate - (time * rate).round()).abs() <= OFF_FRAME)
        };
        RATES.into_iter().find(keeps).unwrap_or(OTHER_RATE)
    }

    /// The motion from 0 to the last key, both ends included, at a rate.
    ///
    /// # Errors
    /// [`BakeError`] when there is no such rate, or the motion would be too long.
    pub fn bake(&self, frames_per_sec: f64) -> Result<Motion, BakeError> {
        if !frames_per_sec.is_finite() || frames_per_sec <= 0.0 {
            return Err(BakeError::NoRate { frames_per_sec });
        }
        let duration_secs = self.duration_secs();
        let config = BakeConfig::of_range([0.0, duration_secs], frames_per_sec);
        let joint_count = self.tracks.skeleton().joint_count();
        match config.frame_count.checked_mul(joint_count) {
            Some(size) if size <= MAX_BAKED_JOINTS => Ok(self.tracks.bake(&config)),
            _ => Err(BakeError::TooLong {
                duration_secs,
                frames_per_sec,
            }),
        }
    }
}
