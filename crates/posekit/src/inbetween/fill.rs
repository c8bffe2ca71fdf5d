//! Filling in the frames between kept ones of a motion.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::between::{Between, Ends};
use super::method::Method;
use crate::keyframe::{Extrapolation, Interpolation, Keyframe, Track};
use crate::motion::Motion;
use crate::skeleton::JointId;

/// Which frames of a motion are kept, and where they come to stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FillPlan {
    kept: Vec<usize>,
    places: Vec<usize>,
    frame_count: usize,
}

/// Why frames cannot be kept so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FillConfigError {
    /// There is no frame to keep.
    #[error("there is no frame to keep")]
    NoFrames,
    /// Every none-th frame means nothing.
    #[error("the number of frames from one to the next must be at least 1")]
    NoSpacing,
    /// The motion does not have a frame.
    #[error("there is no frame {frame}: the motion has {frame_count}")]
    NoSuchFrame {
        /// The frame.
        frame: usize,
        /// How many frames the motion has.
        frame_count: usize,
    },
    /// So many frames that they cannot be counted.
    #[error("{kept} frames {spacing} apart are too many")]
    TooMany {
        /// How many are kept.
        kept: usize,
        /// How far apart they were to be.
        spacing: usize,
    },
}

/// More frames than this are a mistake in the spacing.
const MOST_FRAMES: usize = 10_000_000;

impl FillPlan {
    /// Keeps every n-th frame from the first on, and the last one.
    ///
    /// # Errors
    /// [`FillConfigError`] when the motion has no frames or `n` is 0.
    pub fn every(n: usize, frame_count: usize) -> Result<Self, FillConfigError> {
        if n == 0 {
            return Err(FillConfigError::NoSpacing);
        }
        let last = frame_count
            .checked_sub(1)
            .ok_or(FillConfigError::NoFrames)?;
        Self::at((0..frame_count).step_by(n).chain([last]), frame_count)
    }

    /// Keeps these frames, in order and each once. Frames before the first and after the last of them
    /// are those again.
    ///
    /// # Errors
    /// [`FillConfigError`] when there is none, or one is not the motion's.
    pub fn at(
        frames: impl IntoIterator<Item = usize>,
        frame_count: usize,
    ) -> Result<Self, FillConfigError> {
        let mut kept: Vec<usize> = frames.into_iter().collect();
        kept.sort_unstable();
        kept.dedup();
        match kept.last() {
            None => Err(FillConfigError::NoFrames),
            Some(&frame) if frame >= frame_count => {
                Err(FillConfigError::NoSuchFrame { frame, frame_count })
            }
            Some(_) => Ok(Self {
                places: kept.clone(),
                kept,
                frame_count,
            }),
        }
    }

    /// The same frames, each so many after the one before: a retiming of the motion between them.
    ///
    /// # Errors
    /// [`FillConfigError`] when the spacing is 0, or the result would have more than ten million frames.
    pub fn spaced(self, spacing: usize) -> Result<Self, FillConfigError> {
        if spacing == 0 {
            return Err(FillConfigError::NoSpacing);
        }
        let gaps = self.kept.len() - 1;
        let frames = gaps
            .checked_mul(spacing)
            .filter(|&frames| frames < MOST_FRAMES);
        let frames = frames.ok_or(FillConfigError::TooMany {
            kept: self.kept.len(),
            spacing,
        })?;
        Ok(Self {
            places: (0..=gaps).map(|gap| gap * spacing).collect(),
            frame_count: frames + 1,
            ..self
        })
    }

    /// The kept frames.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// The frames, as the result counts them, that are filled in between kept ones.
    pub fn filled(&self) -> Vec<usize> {
        let gaps = self.places.windows(2);
        gaps.flat_map(|gap| gap[0] + 1..gap[1]).collect()
    }
}

/// The motion with the frames between kept ones filled in, each joint by its own method: rotations by
/// the method, translations straight, or through the keys around where the method is squad.
///
/// Euler angles run on from key to key: those of a key are the ones nearest to the key before it.
///
/// # Panics
/// If the plan was made for a motion with more frames.
pub fn fill(motion: &Motion, plan: &FillPlan, method: impl Fn(JointId) -> Method) -> Motion {
    let skeleton = Arc::clone(motion.skeleton());
    let moving = motion.translated_joints().iter().copied();
    let step = motion.frame_time();
    let mut filled = Motion::at_rest(skeleton, plan.frame_count, step, moving);
    for &joint in motion.rotated_joints() {
        let keys: Vec<DQuat> = plan
            .kept
            .iter()
            .map(|&frame| motion.rotation(frame, joint).as_dquat().normalize())
            .collect();
        let curve = Rotations::new(&keys, &plan.places, method(joint));
        for frame in 0..plan.frame_count {
            let value = plan.value_at(frame, &keys, |gap, t| curve.at(gap, t, frame));
            filled.set_rotation(frame, joint, value.as_quat());
        }
    }
    for &joint in motion.translated_joints() {
        let keys: Vec<DVec3> = plan
            .kept
            .iter()
            .map(|&frame| motion.translation(frame, joint).as_dvec3())
            .collect();
        let through = (method(joint) == Method::Squad)
            .then(|| track(&keys, &plan.places))
            .flatten();
        for frame in 0..plan.frame_count {
            let value = plan.value_at(frame, &keys, |gap, t| match &through {
                Some(track) => track.sample(to_f64(frame)),
                None => keys[gap].lerp(keys[gap + 1], t),
            });
            filled.set_translation(frame, joint, value.as_vec3());
        }
    }
    filled
}

impl FillPlan {
    /// A key's own value, or what `between` says of a gap and the share of it that has gone by.
    fn value_at<V: Copy>(
        &self,
        frame: usize,
        keys: &[V],
        between: impl FnOnce(usize, f64) -> V,
    ) -> V {
        let after = self.places.partition_point(|&place| place <= frame);
        let Some(gap) = after.checked_sub(1) else {
            return keys[0];
        };
        if after == keys.len() || self.places[gap] == frame {
            return keys[gap];
        }
        let [start, end] = [self.places[gap], self.places[after]];
        between(gap, to_f64(frame - start) / to_f64(end - start))
    }
}

/// A joint's rotations between its keys.
enum Rotations {
    /// Gap by gap.
    Gaps(Vec<Between>),
    /// One curve, over the places of the keys.
    Through(Track<DQuat>),
}

impl Rotations {
    fn new(keys: &[DQuat], places: &[usize], method: Method) -> Self {
        if let Method::Squad = method
            && let Some(track) = track(keys, places)
        {
            return Self::Through(track);
        }
        if let Method::Euler(order) = method {
            let mut previous = [0.0; 3];
            let angles: Vec<[f64; 3]> = keys
                .iter()
                .map(|&key| {
                    previous = order.from_quat_near(key, previous).angles_rad;
                    previous
                })
                .collect();
            let gaps = angles.windows(2);
            return Self::Gaps(
                gaps.map(|gap| Between::euler(order, gap[0], gap[1]))
                    .collect(),
            );
        }
        let gaps = keys.windows(2);
        Self::Gaps(
            gaps.map(|gap| Between::new(method, &Ends::new(gap[0], gap[1])))
                .collect(),
        )
    }

    fn at(&self, gap: usize, t: f64, frame: usize) -> DQuat {
        match self {
            Self::Gaps(gaps) => gaps[gap].rotation_at(t),
            Self::Through(track) => track.sample(to_f64(frame)),
        }
    }
}

/// A squad through values, a second to a frame; `None` where a value is no key's.
fn track<V: crate::keyframe::KeyValue>(values: &[V], places: &[usize]) -> Option<Track<V>> {
    let keys = values.iter().zip(places);
    let keys =
        keys.map(|(&value, &place)| Keyframe::new(to_f64(place), value, Interpolation::Squad));
    Track::new(keys.collect(), Extrapolation::Hold).ok()
}

#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
fn to_f64(index: usize) -> f64 {
    index as f64
}
