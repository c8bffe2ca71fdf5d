//! Motion of our own: clips made by procedure, so that nothing has to be fetched to see something
//! move.
//!
//! [`walk`], [`run`] and [`wave`] move [`humanoid`], a person of 1.75 m with 25 joints; [`arm`]
//! moves a robot arm of six axes. All are in metres, Y up, at 60 frames a second, and the same to
//! the bit on every platform: there is no randomness, and angles are turned with `libm`. What a
//! clip is like is a config struct whose defaults are what [`by_name`] gives.

mod arm;
mod curve;
mod foot;
mod gait;
mod humanoid;
mod leg;
mod posture;
mod run;
mod walk;
mod wave;

use gait::FRAMES_PER_SEC;

use crate::motion::Motion;

pub use arm::{ArmConfig, arm, robot_arm};
pub use humanoid::humanoid;
pub use run::{RunConfig, run};
pub use walk::{WalkConfig, walk};
pub use wave::{WaveConfig, WavingHand, wave};

/// The samples by name, each with what it shows.
pub const NAMES: [(&str, &str); 4] = [
    ("walk", "a person walks at 1.3 m/s, four whole gait cycles"),
    ("run", "a person runs at 3 m/s, six whole gait cycles"),
    ("wave", "a person stands, raises the right arm and waves"),
    (
        "arm",
        "a six-axis robot arm picks things up and puts them down",
    ),
];

/// The sample of one of the [`NAMES`], with its default config.
///
/// ```
/// let motion = posekit::sample::by_name("walk").expect("a sample");
/// assert_eq!(motion.skeleton().joint_count(), 25);
/// assert!(posekit::sample::by_name("flight").is_none());
/// ```
pub fn by_name(name: &str) -> Option<Motion> {
    match name {
        "walk" => walk(&WalkConfig::default()).ok(),
        "run" => run(&RunConfig::default()).ok(),
        "wave" => wave(&WaveConfig::default()).ok(),
        "arm" => arm(&ArmConfig::default()).ok(),
        _ => None,
    }
}

/// Why a sample could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SampleError {
    /// A value of a config lies outside its range, or is not a number.
    #[error("`{field}` is {value}; it must be from {low} to {high}")]
    OutOfRange {
        /// The field of the config, or what several fields make together.
        field: &'static str,
        /// What it holds.
        value: f64,
        /// Smallest value that it may hold.
        low: f64,
        /// Largest value that it may hold.
        high: f64,
    },
}

fn in_range(field: &'static str, value: f64, low: f64, high: f64) -> Result<f64, SampleError> {
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    Err(SampleError::OutOfRange {
        field,
        value,
        low,
        high,
    })
}

fn whole_in_range(
    field: &'static str,
    value: u32,
    low: u32,
    high: u32,
) -> Result<u32, SampleError> {
    in_range(field, f64::from(value), f64::from(low), f64::from(high))?;
    Ok(value)
}

/// Frames in a gait cycle of two steps, to the nearest whole number, at a cadence in range.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cadence in range gives tens of frames"
)]
fn frames_per_cycle(steps_per_minute: f64) -> u32 {
    libm::round(120.0 / steps_per_minute * FRAMES_PER_SEC) as u32
}
