//! A dense motion as few keys, within a stated error.
//!
//! **Method.** Each joint's curve is walked from its first frame: the next key is the farthest frame to
//! which one segment stays within the joint's own tolerance at every frame in between (a greedy choice,
//! found by doubling and halving). Keys have the motion's values, cubic ones its slopes (central
//! differences). A joint's tolerance is the least of the stated angle and of the angle that would move its
//! farthest descendant by a share of the stated distance. How large that share may be depends on how the
//! errors of a chain add up, and is found by trying: the whole motion is posed again, every joint's
//! position compared in world space, and the share halved or doubled towards the largest that holds.
//!
//! **Guarantees.** At every frame of the motion the local rotation of every joint is within the stated
//! angle and its global position within the stated distance: that is measured on what is returned, not
//! inferred. Where no share holds, every frame becomes a key.
//!
//! **Cost.** Some tens of evaluations of each joint-frame; `docs/performance.md` has figures. Memory: a second
//! motion, the curve of one joint in `f64`, and the keys: all of them for [`reduce`], a number for each and those of one
//! joint for [`KeyedFrames`].

mod fit;
mod measure;

use std::fmt;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::animation::Animation;
use super::key::Interpolation;
use super::track::Track;
use super::track_error::TrackError;
use crate::motion::Motion;
use crate::range::{LONGEST_LENGTH, LONGEST_SECS, are_lengths};
use crate::skeleton::JointId;

pub use measure::KeyError;

/// The least angle that can be asked for, in degrees: what the `f32` of a motion resolves, some times over.
pub const LEAST_ANGLE_DEG: f64 = 1e-3;

/// The least distance that can be asked for, in skeleton heights, for the same reason.
pub const LEAST_DISTANCE_HEIGHTS: f64 = 1e-5;

/// How far keys may be from the motion that they stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReduceConfig {
    /// The largest angle between a joint's local rotations, in degrees; at least [`LEAST_ANGLE_DEG`].
    pub angle_deg: f64,
    /// The largest distance between a joint's global positions, in heights of the skeleton; at least
    /// [`LEAST_DISTANCE_HEIGHTS`].
    pub distance_heights: f64,
    /// How keys go on: [`Interpolation::Cubic`] needs fewest; [`Interpolation::Linear`] is slerp.
    pub interpolation: Interpolation,
}

impl Default for ReduceConfig {
    /// A degree and a hundredth of the height, 1.7 cm of a person: no eye sees the difference.
    fn default() -> Self {
        Self {
            angle_deg: 1.0,
            distance_heights: 0.01,
            interpolation: Interpolation::Cubic,
        }
    }
}

/// Why a motion was not reduced.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReduceError {
    /// There is nothing to key.
    #[error("the motion has no frames")]
    NoFrames,
    /// Frames have no times of their own.
    #[error("the motion has no frame time: all frames are at one time")]
    NoFrameTime,
    /// The last frame is later than keys can be.
    #[error("the motion lasts {duration_secs:e} s; keys are within {LONGEST_SECS:e} s")]
    TooLong {
        /// The time of the last frame, in seconds.
        duration_secs: f64,
    },
    /// Numbers that no key has.
    #[error(transparent)]
    Track(#[from] TrackError),
    /// More frames than can be numbered.
    #[error("the motion has {frames} frames, more than can be reduced")]
    TooManyFrames {
        /// How many it has.
        frames: usize,
    },
    /// A rotation is not finite, or a translation not within [`LONGEST_LENGTH`].
    #[error(
        "the motion has a rotation that is not finite at frame {frame}, or a place not within {LONGEST_LENGTH:e}"
    )]
    OutOfRange {
        /// The frame.
        frame: usize,
    },
    /// The angle asked for is not a number, or too small.
    #[error("the angle is {angle_deg} degrees; it must be at least {LEAST_ANGLE_DEG}")]
    AngleTooSmall {
        /// What was asked for, in degrees.
        angle_deg: f64,
    },
    /// The distance asked for is not a number, or too small.
    #[error(
        "the distance is {distance_heights} heights; it must be at least {LEAST_DISTANCE_HEIGHTS}"
    )]
    DistanceTooSmall {
        /// What was asked for, in heights of the skeleton.
        distance_heights: f64,
    },
    /// Only linear and cubic keys can be fitted.
    #[error("keys are reduced to linear or cubic ones")]
    NoSuchFit,
}

/// Keys that stand for a motion, and how well.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// The keys, at times of frames; the first frame is at 0 s.
    pub animation: Animation,
    /// The largest errors at any frame.
    pub error: KeyError,
}

/// Reduces a motion to keys.
///
/// A joint whose rotation or translation never leaves its tolerance gets one key; one that stays at rest
/// gets none.
///
/// # Errors
/// [`ReduceError`] when the motion has no frames, no frame time or numbers beyond the
/// [`range`](crate::range), or the config asks for less than `f32` resolves.
pub fn reduce(motion: &Motion, config: &ReduceConfig) -> Result<Reduction, ReduceError> {
    let keys = KeyedFrames::of(motion, config)?;
    Ok(Reduction {
        animation: keys.animation()?,
        error: keys.error(),
    })
}

/// What [`reduce`] finds, as little as it can be: which frames get a key. Tracks are made of it one at a time, so
/// that the keys of a long motion, each some hundred bytes, need not be there at once.
pub struct KeyedFrames<'a> {
    curves: fit::Curves<'a>,
    keys: fit::FrameKeys,
    way: Interpolation,
    error: KeyError,
}

/// How many there are, not their millions of numbers.
impl fmt::Debug for KeyedFrames<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("KeyedFrames")
            .field("keys", &self.key_count())
            .field("error", &self.error)
            .finish_non_exhaustive()
    }
}

impl<'a> KeyedFrames<'a> {
    /// The frames of a motion that get a key.
    ///
    /// # Errors
    /// As [`reduce`].
    pub fn of(motion: &'a Motion, config: &ReduceConfig) -> Result<Self, ReduceError> {
        /// How often the share is halved in search of one that holds, and how often the gap between one that
        /// holds and one that does not is halved.
        const ATTEMPTS: [u32; 2] = [8, 4];
        check(motion, config)?;
        let curves = fit::Curves::of(motion);
        let limit = KeyError {
            angle_deg: config.angle_deg,
            distance_heights: config.distance_heights,
        };
        let mut baked = motion.clone();
        let mut attempt = |share: f64| {
            let keys = curves.fitted(config, share, &mut baked)?;
            let error = measure::between(motion, &baked);
            Ok::<_, TrackError>(error.is_within(&limit).then_some((keys, error)))
        };
        let (mut share, mut best) = (1.0, attempt(1.0)?);
        for _ in 0..ATTEMPTS[0] {
            if best.is_some() {
                break;
            }
            share *= 0.5;
            best = attempt(share)?;
        }
        let Some(mut best) = best else {
            let keys = curves.every_frame(&mut baked)?;
            let error = measure::between(motion, &baked);
            return Ok(Self {
                curves,
                keys,
                way: Interpolation::Linear,
                error,
            });
        };
        let (mut holds, mut fails) = (share, 2.0 * share);
        for _ in 0..ATTEMPTS[1] {
            let middle = 0.5 * (holds + fails);
            match attempt(middle)? {
                Some(better) => {
                    holds = middle;
                    // A larger share may happen to need more keys.
                    if better.0.count() <= best.0.count() {
                        best = better;
                    }
                }
                None => fails = middle,
            }
        }
        let (keys, error) = best;
        Ok(Self {
            curves,
            keys,
            way: config.interpolation,
            error,
        })
    }

    /// How many keys there are.
    pub fn key_count(&self) -> usize {
        self.keys.count()
    }

    /// The largest errors at any frame.
    pub fn error(&self) -> KeyError {
        self.error
    }

    /// The track of a joint's rotation, made now; `None` where it has no keys.
    ///
    /// # Errors
    /// [`TrackError`] as [`reduce`].
    pub fn rotation(&self, joint: JointId) -> Option<Result<Track<DQuat>, TrackError>> {
        self.curves.rotation_track(&self.keys, joint, self.way)
    }

    /// The track of a joint's translation, made now; `None` where it has no keys.
    ///
    /// # Errors
    /// [`TrackError`] as [`reduce`].
    pub fn translation(&self, joint: JointId) -> Option<Result<Track<DVec3>, TrackError>> {
        self.curves.translation_track(&self.keys, joint, self.way)
    }

    /// All tracks.
    fn animation(&self) -> Result<Animation, TrackError> {
        let skeleton = self.curves.skeleton();
        let mut animation = Animation::new(Arc::clone(skeleton));
        for joint in skeleton.joints() {
            if let Some(track) = self.rotation(joint).transpose()? {
                animation = animation.with_rotation(joint, Some(track));
            }
            if let Some(track) = self.translation(joint).transpose()? {
                animation = animation.with_translation(joint, Some(track));
            }
        }
        Ok(animation)
    }
}

fn check(motion: &Motion, config: &ReduceConfig) -> Result<(), ReduceError> {
    if motion.frame_count() == 0 {
        return Err(ReduceError::NoFrames);
    }
    if motion.frame_time().is_none() {
        return Err(ReduceError::NoFrameTime);
    }
    let duration_secs = motion.duration_secs();
    if duration_secs > LONGEST_SECS {
        return Err(ReduceError::TooLong { duration_secs });
    }
    if u32::try_from(motion.frame_count()).is_err() {
        let frames = motion.frame_count();
        return Err(ReduceError::TooManyFrames { frames });
    }
    let ReduceConfig {
        angle_deg,
        distance_heights,
        interpolation,
    } = *config;
    if angle_deg.is_nan() || angle_deg < LEAST_ANGLE_DEG {
        return Err(ReduceError::AngleTooSmall { angle_deg });
    }
    if distance_heights.is_nan() || distance_heights < LEAST_DISTANCE_HEIGHTS {
        return Err(ReduceError::DistanceTooSmall { distance_heights });
    }
    if !matches!(interpolation, Interpolation::Linear | Interpolation::Cubic) {
        return Err(ReduceError::NoSuchFit);
    }
    for frame in 0..motion.frame_count() {
        let mut turning = motion.rotated_joints().iter();
        let mut moving = motion.translated_joints().iter();
        let is_in_range = turning.all(|&joint| motion.rotation(frame, joint).is_finite())
            && moving.all(|&joint| {
                let place = motion.translation(frame, joint).to_array();
                are_lengths(place.map(f64::from))
            });
        if !is_in_range {
            return Err(ReduceError::OutOfRange { frame });
        }
    }
    Ok(())
}
