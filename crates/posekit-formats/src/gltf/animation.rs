//! Animations by name, and at a frame rate.

use std::ops::Range;
use std::sync::Arc;

use gltf::json::Root;
use posekit::keyframe::BakeConfig;
use posekit::motion::{FrameTime, FrameTimeError, Motion};
use posekit::range::LONGEST_LENGTH;

use super::json_path::Step;
use super::{Gltf, GltfAnimation, Notes, Wanted};
use crate::report::{ReadError, ReadErrorKind, quote};

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
    /// The rate is none that frames can have.
    #[error(transparent)]
    Rate(#[from] FrameTimeError),
    /// A joint is so far away, between keys, that no motion can be made of it.
    #[error(
        "joint `{joint}` is too far away at frame {frame}: it is not within {LONGEST_LENGTH:e}"
    )]
    TooFar {
        /// The joint's unique name.
        joint: String,
        /// The frame.
        frame: usize,
    },
    /// It would take more than [`MAX_BAKED_JOINTS`].
    #[error("{duration_secs} s at {frames_per_sec} frames a second is too long a motion")]
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
                Ok(Motion::at_rest(skeleton, 1, FrameTime::of_fps(30), roots))
            }
        }
    }

    fn known_animations(&self) -> String {
        known(self.animations.iter().map(|a| a.name.as_str()))
    }
}

/// Names in one line.
fn known<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    /// More names than this are no help in one line.
    const LISTED: usize = 8;
    let count = names.len();
    let names: Vec<String> = names.take(LISTED).map(|n| quote(n.as_bytes())).collect();
    match count {
        0 => "none".to_owned(),
        count if count > LISTED => format!("{} and {} more", names.join(", "), count - LISTED),
        _ => names.join(", "),
    }
}

/// The name that an animation of a file goes by.
pub(super) fn name_of(root: &Root, index: usize) -> String {
    let said = root.animations[index].name.as_deref();
    said.filter(|name| !name.is_empty())
        .map_or_else(|| format!("animation {index}"), str::to_owned)
}

/// Which animations of a file those are that are wanted.
pub(super) fn indices(
    root: &Root,
    wanted: Wanted<'_>,
    notes: &Notes,
) -> Result<Range<usize>, ReadError> {
    let count = root.animations.len();
    match wanted {
        Wanted::All => Ok(0..count),
        Wanted::Skeleton => Ok(0..0),
        Wanted::First => Ok(0..count.min(1)),
        Wanted::Named(name) => {
            let found = (0..count).find(|&index| name_of(root, index) == name);
            let index = found.ok_or_else(|| {
                let names: Vec<String> = (0..count).map(|index| name_of(root, index)).collect();
                notes.error(
                    ReadErrorKind::UnknownName,
                    &[Step::Key("animations")],
                    format!("an animation {}", quote(name.as_bytes())),
                    known(names.iter().map(String::as_str)),
                )
            })?;
            Ok(index..index + 1)
        }
    }
}

impl GltfAnimation {
    /// When its first and its last key are, in seconds; twice 0 where there is none.
    pub fn range_secs(&self) -> [f64; 2] {
        self.tracks.range_secs().unwrap_or_default()
    }

    /// From its first key to its last, in seconds.
    pub fn duration_secs(&self) -> f64 {
        let [start, end] = self.range_secs();
        end - start
    }

    /// The frame rate that its keys keep to, counted from the first, of those that are usual, or 60 where they keep to
    /// none. The file itself has none.
    pub fn frames_per_sec(&self) -> f64 {
        let [start, _] = self.range_secs();
        let times = self.tracks.key_times_secs(self.tracks.skeleton().joints());
        let keeps = |rate: &f64| {
            times.iter().all(|time| {
                let frame = (time - start) * rate;
                (frame - frame.round()).abs() <= OFF_FRAME
            })
        };
        RATES.into_iter().find(keeps).unwrap_or(OTHER_RATE)
    }

    /// The motion from the first key to the last, both ends included, at a rate.
    ///
    /// # Errors
    /// [`BakeError`] when there is no such rate, or the motion would be too long.
    pub fn bake(&self, frames_per_sec: f64) -> Result<Motion, BakeError> {
        let frame_time = FrameTime::of_rate(frames_per_sec)?;
        let duration_secs = self.duration_secs();
        let config = BakeConfig::of_range(self.range_secs(), frame_time);
        let joint_count = self.tracks.skeleton().joint_count();
        match config.frame_count.checked_mul(joint_count) {
            Some(size) if size <= MAX_BAKED_JOINTS => {
                let motion = self.tracks.bake(&config);
                match motion.first_out_of_range() {
                    None => Ok(motion),
                    Some((frame, joint)) => Err(BakeError::TooFar {
                        joint: motion.skeleton().unique_name(joint).to_owned(),
                        frame,
                    }),
                }
            }
            _ => Err(BakeError::TooLong {
                duration_secs,
                frames_per_sec,
            }),
        }
    }
}
