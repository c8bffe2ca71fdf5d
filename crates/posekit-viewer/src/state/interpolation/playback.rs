//! The lab's clock: the share of the way, and how it runs.

use crate::state::transport::AtEnd;

/// Seconds that a way may take.
pub const SECS_RANGE: std::ops::RangeInclusive<f64> = 0.25..=20.0;

/// The share of the way, and how it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Playback {
    share: f64,
    length: f64,
    is_playing: bool,
    /// Seconds for a way from key to key.
    pub secs: f64,
    /// What happens at the end.
    pub at_end: AtEnd,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            share: 0.5,
            length: 1.0,
            is_playing: false,
            secs: 3.0,
            at_end: AtEnd::Loop,
        }
    }
}

impl Playback {
    /// Where it is: ways from the first key looked at.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// How many ways there are.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Goes somewhere.
    pub fn set_share(&mut self, share: f64) {
        if share.is_finite() {
            self.share = share.clamp(0.0, self.length);
        }
    }

    /// There are more ways, or fewer.
    pub fn set_length(&mut self, length: f64) {
        if length.is_finite() && length > 0.0 {
            self.length = length;
            self.share = self.share.min(length);
        }
    }

    /// Whether it runs.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.is_playing
    }

    /// Starts or stops; at the end it starts anew.
    pub fn toggle(&mut self) {
        self.is_playing = !self.is_playing;
        if self.is_playing && self.share >= self.length {
            self.share = 0.0;
        }
    }

    /// Stops.
    pub fn pause(&mut self) {
        self.is_playing = false;
    }

    /// So much time has passed.
    pub fn advance(&mut self, passed_secs: f64) {
        if !self.is_playing || !passed_secs.is_finite() {
            return;
        }
        let next = self.share
            + passed_secs.max(0.0) / self.secs.clamp(*SECS_RANGE.start(), *SECS_RANGE.end());
        if next < self.length {
            self.share = next;
        } else if self.at_end == AtEnd::Loop {
            self.share = next % self.length;
        } else {
            self.share = self.length;
            self.is_playing = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_loops_or_stops() {
        let mut clock = Playback {
            secs: 2.0,
            ..Playback::default()
        };
        clock.set_share(0.75);
        clock.toggle();
        clock.advance(1.0);
        assert!((clock.share() - 0.25).abs() < 1e-12 && clock.is_playing());
        clock.at_end = AtEnd::Stop;
        clock.advance(5.0);
        assert!(clock.share() == 1.0 && !clock.is_playing());
        clock.toggle();
        assert!(clock.share() == 0.0);
        clock.set_length(4.0);
        clock.set_share(3.5);
        clock.set_length(1.0);
        assert!(clock.share() == 1.0);
        clock.set_share(f64::NAN);
        assert!(clock.share() == 1.0);
    }
}
