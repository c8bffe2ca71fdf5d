//! The transport: what time it is in the clip, and how time runs.

use super::clip::{index_to_f64, nearest_index};

/// The slowest and the fastest that a clip is played.
pub const SPEED_RANGE: std::ops::RangeInclusive<f64> = 0.1..=4.0;

/// The speeds that the slower and faster keys step through.
pub const SPEED_STEPS: [f64; 8] = [0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 4.0];

/// What happens when playing reaches the range's end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum AtEnd {
    /// Start again.
    #[default]
    Loop,
    /// Stand still on the last frame.
    Stop,
}

/// The clip's clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Transport {
    /// Seconds since the first frame.
    time_secs: f64,
    playing: bool,
    speed: f64,
    /// What happens at the end.
    pub at_end: AtEnd,
    frame_count: usize,
    frame_time_secs: f64,
    /// First and last frame played.
    range: (usize, usize),
}

impl Default for Transport {
    fn default() -> Self {
        Self {
            time_secs: 0.0,
            playing: false,
            speed: 1.0,
            at_end: AtEnd::Loop,
            frame_count: 0,
            frame_time_secs: 0.0,
            range: (0, 0),
        }
    }
}

impl Transport {
    /// Makes it run over another clip: time goes to the first frame, the range to all of it.
    pub fn load(&mut self, frame_count: usize, frame_time_secs: f64) {
        self.frame_count = frame_count;
        self.frame_time_secs = frame_time_secs.max(0.0);
        self.range = (0, self.last_frame());
        self.time_secs = 0.0;
        self.playing &= self.can_play();
    }

    /// Makes it run over another version of the same clip: time and range stay where they can.
    pub fn reload(&mut self, frame_count: usize, frame_time_secs: f64) {
        let (time_secs, range) = (self.time_secs, self.range);
        let was_whole = range == (0, self.last_frame());
        self.load(frame_count, frame_time_secs);
        if !was_whole {
            self.set_range(range.0, range.1);
        }
        self.set_time_secs(time_secs);
    }

    /// Seconds since the first frame.
    #[must_use]
    pub fn time_secs(&self) -> f64 {
        self.time_secs
    }

    /// The frame nearest to the time.
    #[must_use]
    pub fn frame(&self) -> usize {
        if self.frame_time_secs <= 0.0 {
            return 0;
        }
        nearest_index(self.time_secs / self.frame_time_secs, self.last_frame())
    }

    /// How many frames the clip has.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.frame_count
    }

    /// The last frame, 0 for a clip without frames.
    #[must_use]
    pub fn last_frame(&self) -> usize {
        self.frame_count.saturating_sub(1)
    }

    /// The time of the last frame.
    #[must_use]
    pub fn duration_secs(&self) -> f64 {
        self.secs_of(self.last_frame())
    }

    /// The time of a frame.
    #[must_use]
    pub fn secs_of(&self, frame: usize) -> f64 {
        index_to_f64(frame) * self.frame_time_secs
    }

    /// First and last frame played.
    #[must_use]
    pub fn range(&self) -> (usize, usize) {
        self.range
    }

    /// Whether the range is less than the whole clip.
    #[must_use]
    pub fn is_range_limited(&self) -> bool {
        self.range != (0, self.last_frame())
    }

    /// Whether time is running.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// How fast time runs.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Sets how fast time runs, within [`SPEED_RANGE`].
    pub fn set_speed(&mut self, speed: f64) {
        if speed.is_finite() {
            self.speed = speed.clamp(*SPEED_RANGE.start(), *SPEED_RANGE.end());
        }
    }

    /// The next of [`SPEED_STEPS`].
    pub fn faster(&mut self) {
        let next = SPEED_STEPS.iter().find(|&&step| step > self.speed + 1e-9);
        self.speed = next.copied().unwrap_or(self.speed);
    }

    /// The one of [`SPEED_STEPS`] before.
    pub fn slower(&mut self) {
        let next = SPEED_STEPS
            .iter()
            .rev()
            .find(|&&step| step < self.speed - 1e-9);
        self.speed = next.copied().unwrap_or(self.speed);
    }

    /// Starts or stops. At the end of the range playing starts at its beginning again.
    pub fn toggle_play(&mut self) {
        if self.playing {
            self.pause();
        } else {
            self.play();
        }
    }

    /// Starts.
    pub fn play(&mut self) {
        self.playing = self.can_play();
        let frame = self.frame();
        if self.playing && (frame >= self.range.1 || frame < self.range.0) {
            self.time_secs = self.secs_of(self.range.0);
        }
    }

    /// Stops, on the nearest frame.
    pub fn pause(&mut self) {
        if self.playing {
            self.playing = false;
            self.go_to_frame(self.frame());
        }
    }

    /// Goes to a frame of the clip.
    pub fn go_to_frame(&mut self, frame: usize) {
        self.time_secs = self.secs_of(frame.min(self.last_frame()));
    }

    /// Goes to a time within the clip.
    pub fn set_time_secs(&mut self, time_secs: f64) {
        if time_secs.is_finite() {
            self.time_secs = time_secs.clamp(0.0, self.duration_secs());
        }
    }

    /// Stops and goes some frames on, or back; past an end of the range it goes on at the other.
    pub fn step(&mut self, frames: isize) {
        self.pause();
        let (first, last) = self.range;
        let length = last - first + 1;
        let frame = self.frame().clamp(first, last) - first;
        let there = frame.checked_add_signed(frames).map(|there| there % length);
        let backward = frames.unsigned_abs() % length;
        let there = there.unwrap_or((frame + length - backward) % length);
        self.go_to_frame(first + there);
    }

    /// Makes `first..=last` what is played, in whichever order they are given.
    pub fn set_range(&mut self, first: usize, last: usize) {
        let (first, last) = (first.min(last), first.max(last));
        self.range = (first.min(self.last_frame()), last.min(self.last_frame()));
    }

    /// The range starts at the frame shown.
    pub fn set_range_start_here(&mut self) {
        let frame = self.frame();
        self.set_range(frame, self.range.1.max(frame));
    }

    /// The range ends at the frame shown.
    pub fn set_range_end_here(&mut self) {
        let frame = self.frame();
        self.set_range(self.range.0.min(frame), frame);
    }

    /// The whole clip is played.
    pub fn clear_range(&mut self) {
        self.range = (0, self.last_frame());
    }

    /// Lets real time pass. True when the time shown has changed.
    pub fn advance(&mut self, real_secs: f64) -> bool {
        if !self.playing || !real_secs.is_finite() || real_secs <= 0.0 {
            return false;
        }
        let (start, end) = (self.secs_of(self.range.0), self.secs_of(self.range.1));
        let time = self.time_secs + real_secs * self.speed;
        if time < end {
            self.time_secs = time.max(start);
        } else if self.at_end == AtEnd::Loop && end > start {
            self.time_secs = start + (time - end) % (end - start);
        } else {
            self.time_secs = end;
            self.playing = false;
        }
        true
    }

    fn can_play(&self) -> bool {
        self.frame_count > 1 && self.frame_time_secs > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transport() -> Transport {
        let mut transport = Transport::default();
        transport.load(101, 0.1);
        transport
    }

    #[test]
    fn time_runs_at_the_speed_and_loops() {
        let mut t = transport();
        t.play();
        t.set_speed(2.0);
        assert!(t.advance(1.0));
        assert!((t.time_secs() - 2.0).abs() < 1e-9);
        t.advance(4.5);
        assert!((t.time_secs() - 1.0).abs() < 1e-9, "{}", t.time_secs());
        assert!(t.is_playing());
    }

    #[test]
    fn without_loop_it_stops_on_the_last_frame_and_play_starts_over() {
        let mut t = transport();
        t.at_end = AtEnd::Stop;
        t.play();
        t.advance(99.0);
        assert_eq!((t.frame(), t.is_playing()), (100, false));
        t.play();
        assert_eq!((t.frame(), t.is_playing()), (0, true));
    }

    #[test]
    fn pausing_lands_on_a_frame() {
        let mut t = transport();
        t.play();
        t.advance(0.56);
        t.pause();
        assert!((t.time_secs() - 0.6).abs() < 1e-9);
    }

    #[test]
    fn stepping_wraps_within_the_range() {
        let mut t = transport();
        t.set_range(20, 10);
        t.go_to_frame(20);
        t.step(1);
        assert_eq!(t.frame(), 10);
        t.step(-1);
        assert_eq!(t.frame(), 20);
        t.step(-25);
        assert_eq!(t.frame(), 17);
        t.go_to_frame(50);
        t.step(-1);
        assert_eq!(t.frame(), 19);
    }

    #[test]
    fn a_range_end_before_its_start_moves_both() {
        let mut t = transport();
        t.set_range(40, 60);
        t.go_to_frame(30);
        t.set_range_end_here();
        assert_eq!(t.range(), (30, 30));
        t.go_to_frame(80);
        t.set_range_start_here();
        assert_eq!(t.range(), (80, 80));
        t.clear_range();
        assert!(!t.is_range_limited());
    }

    #[test]
    fn clips_of_nothing_do_not_play() {
        for (count, frame_time) in [(0, 0.1), (1, 0.1), (5, 0.0), (5, -1.0)] {
            let mut t = Transport::default();
            t.load(count, frame_time);
            t.play();
            t.step(3);
            t.step(-7);
            assert!(!t.is_playing() && !t.advance(1.0));
            assert!(t.time_secs() == 0.0);
        }
    }

    #[test]
    fn speed_keeps_its_bounds() {
        let mut t = transport();
        t.set_speed(100.0);
        assert!((t.speed() - 4.0).abs() < 1e-9);
        t.faster();
        assert!((t.speed() - 4.0).abs() < 1e-9);
        t.set_speed(0.3);
        t.slower();
        assert!((t.speed() - 0.25).abs() < 1e-9);
        t.set_speed(f64::NAN);
        assert!((t.speed() - 0.25).abs() < 1e-9);
    }

    #[test]
    fn a_longer_version_of_the_clip_keeps_time_and_range() {
        let mut t = transport();
        t.set_range(10, 20);
        t.go_to_frame(15);
        t.reload(50, 0.1);
        assert_eq!((t.frame(), t.range()), (15, (10, 20)));
        t.reload(12, 0.1);
        assert_eq!((t.frame(), t.range()), (11, (10, 11)));
    }
}
