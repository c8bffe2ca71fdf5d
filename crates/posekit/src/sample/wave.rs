//! Standing and waving a hand.

use glam::DVec3;

use super::SampleError;
use super::curve::{cos_turns, minimum_jerk, sin_turns};
use super::foot::FootPose;
use super::gait::FRAMES_PER_SEC;
use super::humanoid::{ANKLE_HEIGHT, Figure, HIPS, mirror_point, mirror_rotation, motion_of};
use super::leg;
use super::posture::{ArmPose, Bearing, turn_trunk};
use crate::motion::Motion;

/// What a wave of the hand is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveConfig {
    /// How often the hand goes out and back, 1 to 100.
    pub waves: u32,
    /// How often in a second, 0.8 to 3.
    pub waves_per_sec: f64,
    /// The hand that waves.
    pub hand: WavingHand,
}

/// A hand to wave with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WavingHand {
    /// The left one.
    Left,
    /// The right one.
    #[default]
    Right,
}

impl Default for WaveConfig {
    fn default() -> Self {
        Self {
            waves: 4,
            waves_per_sec: 1.7,
            hand: WavingHand::Right,
        }
    }
}

/// Seconds of standing before the arm goes up.
const BEFORE_SECS: f64 = 0.5;
/// Seconds that the arm takes to go up.
const RAISE_SECS: f64 = 1.0;
/// Seconds that it takes to come down; a relaxed arm falls slower than it is raised.
const LOWER_SECS: f64 = 1.2;
/// Seconds of standing afterwards.
const AFTER_SECS: f64 = 0.8;
/// Seconds of a breath at rest, about 15 a minute; stretched so that whole breaths fit the clip.
const BREATH_SECS: f64 = 4.0;
/// How far the hand lags behind the forearm, in seconds.
const HAND_LAG_SECS: f64 = 0.05;

/// [`humanoid`](super::humanoid) stands, shifts its weight, raises an arm, waves and lowers it
/// again, at 60 frames a second, facing +Z. The last frame is the first one.
///
/// Every part of the way is a minimum-jerk movement (Flash and Hogan 1985); upper arm, elbow and
/// hand set off one after the other, and the hand drags behind the forearm.
///
/// # Errors
/// [`SampleError::OutOfRange`] when a value lies outside the range that its field states.
pub fn wave(config: &WaveConfig) -> Result<Motion, SampleError> {
    let waves = super::whole_in_range("waves", config.waves, 1, 100)?;
    let rate = super::in_range("waves_per_sec", config.waves_per_sec, 0.8, 3.0)?;
    let timing = Timing::new(f64::from(waves) / rate, rate);
    let figures: Vec<Figure> = (0..=timing.frame_count)
        .map(|frame| timing.figure(f64::from(frame) / FRAMES_PER_SEC))
        .map(|figure| match config.hand {
            WavingHand::Left => figure,
            WavingHand::Right => mirrored(&figure),
        })
        .collect();
    Ok(motion_of(&figures))
}

/// When things happen, in seconds from the first frame.
struct Timing {
    raise_at: f64,
    wave_at: f64,
    lower_at: f64,
    rate: f64,
    frame_count: u32,
    end_at: f64,
    breath_secs: f64,
}

impl Timing {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a config in range lasts some minutes at most"
    )]
    fn new(waving_secs: f64, rate: f64) -> Self {
        // The arm starts to wave before it is all the way up, and to fall before it has stopped.
        let wave_at = BEFORE_SECS + 0.8 * RAISE_SECS;
        let lower_at = wave_at + waving_secs;
        let end_at = lower_at + LOWER_SECS + AFTER_SECS;
        let frame_count = libm::ceil(end_at * FRAMES_PER_SEC) as u32;
        let end_at = f64::from(frame_count) / FRAMES_PER_SEC;
        Self {
            raise_at: BEFORE_SECS,
            wave_at,
            lower_at,
            rate,
            frame_count,
            end_at,
            breath_secs: end_at / libm::round(end_at / BREATH_SECS).max(1.0),
        }
    }

    /// 0 with the arm down and 1 with it up, of a part that sets off `delay` seconds late, takes
    /// `pace` of the whole time, and comes down as late.
    fn raised(&self, time: f64, delay: f64, pace: f64) -> f64 {
        let up_at = self.raise_at + delay;
        let down_at = self.lower_at + delay;
        minimum_jerk(up_at, up_at + RAISE_SECS * pace, time)
            - minimum_jerk(down_at, down_at + LOWER_SECS * pace, time)
    }

    /// How much of the wave is on, 0 to 1.
    fn waving(&self, time: f64) -> f64 {
        let ramp = 0.4;
        minimum_jerk(self.wave_at - 0.2, self.wave_at - 0.2 + ramp, time)
            - minimum_jerk(self.lower_at - 0.25, self.lower_at - 0.25 + ramp, time)
    }

    /// The figure waving its left hand.
    fn figure(&self, time: f64) -> Figure {
        let breath = -cos_turns(time / self.breath_secs);
        // A whole number of slow sways: nobody stands like a post.
        let idle = sin_turns(time / self.end_at);
        let shift = self.raised(time, -0.25, 1.3);
        let hips = DVec3::new(
            0.006 * idle - 0.028 * shift,
            STANDING_HEIGHT - 0.003 * shift,
            0.004 * idle,
        );
        let mut figure = Figure::new(hips);
        let pelvis = Bearing {
            yaw: 1.5 * shift,
            list: -2.2 * shift - 0.4 * idle,
            lean: 2.0,
        };
        figure.rotations[HIPS] = pelvis.rotation();
        let beat = self.waving(time) * sin_turns(self.rate * (time - self.wave_at) - 0.1);
        let chest = Bearing {
            yaw: 2.0 * shift,
            list: 3.5 * shift + 0.6 * beat,
            lean: 1.5 - 0.7 * breath - 1.0 * shift,
        };
        let head = Bearing {
            yaw: 1.0 * idle,
            list: -4.0 * self.raised(time, 0.1, 1.0) + 0.3 * beat,
            lean: 3.0 - 3.0 * self.raised(time, 0.0, 1.0),
        };
        turn_trunk(&mut figure, chest.rotation(), head.rotation());
        leg::reach_feet(&mut figure, &STANDING_FOOT, &STANDING_FOOT);
        self.waving_arm(time, breath).turn_left(&mut figure);
        hanging_arm(breath, shift).turn_right(&mut figure);
        figure
    }

    fn waving_arm(&self, time: f64, breath: f64) -> ArmPose {
        let upper = self.raised(time, 0.0, 1.0);
        let turned = self.raised(time, 0.08, 0.9);
        let bent = self.raised(time, -0.08, 0.8);
        let opened = self.raised(time, 0.15, 0.9);
        let on = self.waving(time);
        let turns = self.rate * (time - self.wave_at);
        let lead = on * sin_turns(turns + 0.06);
        let swing = on * sin_turns(turns);
        let drag = on * cos_turns(turns - self.rate * HAND_LAG_SECS);
        let rest = hanging_arm(breath, 0.0);
        let between = |from: f64, to: f64, part: f64| from + (to - from) * part;
        ArmPose {
            flexion: between(rest.flexion, 20.0, upper),
            abduction: between(rest.abduction, 60.0, upper) + 3.0 * lead,
            inward: between(rest.inward, -74.0, turned) + 5.0 * lead,
            elbow: between(rest.elbow, 107.0, bent) - 19.0 * swing,
            wrist: between(rest.wrist, -8.0, opened),
            deviation: between(rest.deviation, 0.0, opened) + 13.0 * drag,
            girdle_forward: between(rest.girdle_forward, 3.0, upper),
            girdle_up: between(rest.girdle_up, 7.0, upper) + 0.8 * lead,
        }
    }
}

/// The pelvis's height with the knees nearly straight.
const STANDING_HEIGHT: f64 = 0.990;

/// Where the left foot stands.
const STANDING_FOOT: FootPose = FootPose {
    ankle: DVec3::new(0.105, ANKLE_HEIGHT, -0.02),
    yaw: 0.16,
    pitch: 0.0,
    toe_pitch: 0.0,
};

/// An arm that hangs at the side of a standing figure.
fn hanging_arm(breath: f64, shift: f64) -> ArmPose {
    ArmPose {
        flexion: 2.0 - 0.5 * breath + 2.0 * shift,
        abduction: 8.0 + 0.4 * breath + 2.5 * shift,
        inward: 18.0,
        elbow: 16.0 + 1.0 * breath,
        wrist: 8.0,
        deviation: 0.0,
        girdle_forward: 1.0,
        girdle_up: -1.5 + 1.2 * breath,
    }
}

fn mirrored(figure: &Figure) -> Figure {
    let mut mirror = Figure::new(mirror_point(figure.hips));
    for (joint, &rotation) in figure.rotations.iter().enumerate() {
        mirror.rotations[super::humanoid::other_side(joint)] = mirror_rotation(rotation);
    }
    mirror
}
