//! The time between two frames, checked once.

use std::fmt;

use crate::range::{LONGEST_SECS, SHORTEST_SECS};

/// The time between two frames of a motion: from [`SHORTEST_SECS`] to [`LONGEST_SECS`], or
/// [none](Self::NONE), when all frames are at one time.
///
/// A file or a person may give any number. What is a frame time can be divided by: its rate is finite, and so is
/// the duration of every motion that fits into memory.
///
/// ```
/// use posekit::motion::FrameTime;
///
/// let film = FrameTime::of_fps(24);
/// assert_eq!(film.frames_per_sec(), Some(24.0));
/// assert!(FrameTime::new(5e-324).is_err());
/// assert!(FrameTime::of_rate(f64::INFINITY).is_err());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct FrameTime(f64);

/// Why a number is no frame time.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameTimeError {
    /// The time is outside the range, or not a number.
    #[error(
        "a frame time of {} s is outside {SHORTEST_SECS:e} to {LONGEST_SECS:e} s",
        Short(*secs)
    )]
    Time {
        /// The time, in seconds.
        secs: f64,
    },
    /// The rate is outside the range, or not a number.
    #[error(
        "a rate of {} frames a second is outside {:e} to {:e}",
        Short(*frames_per_sec), 1.0 / LONGEST_SECS, (1.0 / SHORTEST_SECS).round()
    )]
    Rate {
        /// Frames a second.
        frames_per_sec: f64,
    },
}

/// A number without the hundreds of zeros that very large and very small ones have.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-4..1e7).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

impl FrameTime {
    /// All frames are at one time.
    pub const NONE: Self = Self(0.0);

    /// A time in seconds.
    ///
    /// # Errors
    /// [`FrameTimeError::Time`] when it is outside the range; zero is.
    pub const fn new(secs: f64) -> Result<Self, FrameTimeError> {
        if secs >= SHORTEST_SECS && secs <= LONGEST_SECS {
            Ok(Self(secs))
        } else {
            Err(FrameTimeError::Time { secs })
        }
    }

    /// The time of a rate in frames a second.
    ///
    /// # Errors
    /// [`FrameTimeError::Rate`] when the time is outside the range.
    pub const fn of_rate(frames_per_sec: f64) -> Result<Self, FrameTimeError> {
        match Self::new(1.0 / frames_per_sec) {
            Ok(time) => Ok(time),
            Err(_) => Err(FrameTimeError::Rate { frames_per_sec }),
        }
    }

    /// The time of a whole number of frames a second; [`NONE`](Self::NONE) for 0.
    pub const fn of_fps(frames_per_sec: u16) -> Self {
        match frames_per_sec {
            0 => Self::NONE,
            // At least 1.5e-5 s, and at most one second. Casts are the only conversion in a constant.
            rate => Self(1.0 / rate as f64),
        }
    }

    /// A time in seconds; [`NONE`](Self::NONE) for one outside the range.
    pub const fn or_none(secs: f64) -> Self {
        match Self::new(secs) {
            Ok(time) => time,
            Err(_) => Self::NONE,
        }
    }

    /// In seconds; 0 for [`NONE`](Self::NONE).
    pub const fn secs(self) -> f64 {
        self.0
    }

    /// Frames a second; `None` when all frames are at one time.
    pub fn frames_per_sec(self) -> Option<f64> {
        (self != Self::NONE).then(|| 1.0 / self.0)
    }

    /// Whether all frames are at one time.
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_a_frame_time_can_be_divided_by() {
        for secs in [SHORTEST_SECS, 1.0 / 60.0, LONGEST_SECS] {
            let rate = FrameTime::new(secs).unwrap().frames_per_sec().unwrap();
            assert!(rate.is_finite() && rate > 0.0);
        }
        let nearly = [
            0.0,
            -0.0,
            -0.01,
            5e-324,
            f64::MIN_POSITIVE,
            SHORTEST_SECS.next_down(),
            LONGEST_SECS.next_up(),
            f64::MAX,
            f64::INFINITY,
            f64::NAN,
        ];
        for secs in nearly {
            let error = FrameTime::new(secs).unwrap_err();
            assert!(error.to_string().len() < 80, "{error}");
            assert!(FrameTime::or_none(secs).is_none());
        }
        for rate in [0.0, -30.0, 1e-320, 1e10, f64::MAX, f64::INFINITY, f64::NAN] {
            assert!(FrameTime::of_rate(rate).is_err(), "{rate:e}");
        }
        assert_eq!(FrameTime::of_fps(0), FrameTime::NONE);
        assert_eq!(FrameTime::NONE.frames_per_sec(), None);
    }

    #[test]
    fn a_refusal_names_the_number_and_the_range() {
        let text = FrameTime::new(5e-324).unwrap_err().to_string();
        assert_eq!(text, "a frame time of 5e-324 s is outside 1e-9 to 1e9 s");
        let text = FrameTime::of_rate(-30.0).unwrap_err().to_string();
        assert_eq!(text, "a rate of -30 frames a second is outside 1e-9 to 1e9");
    }
}
