//! A foot over a gait cycle: planted, rolled over heel, sole, ball and toes, and swung forward.
//!
//! While it is planted nothing of it slides: the foot turns about the heel until the sole is down
//! (heel rocker), lies still, and turns about the ball and then the tip of the toes (forefoot
//! rocker; Perry, "Gait Analysis", 1992). Between toe-off and heel strike the ankle follows a
//! smooth path that leaves and arrives with the velocity of the rolling foot.
//!
//! Everything is the left foot's. A phase counts gait cycles; a heel strike is at every whole
//! number.

use glam::{DQuat, DVec3};

use super::curve::{Spline, about_x, about_y};
use super::humanoid::{ANKLE_HEIGHT, BALL_FORWARD, BALL_HEIGHT, HEEL_BACK, TIP_HEIGHT, TOE_LENGTH};

/// Where a left foot is.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootPose {
    /// The ankle in world space, metres.
    pub(super) ankle: DVec3,
    /// Where the foot points, radians about Y; positive turns the toes outwards.
    pub(super) yaw: f64,
    /// The foot against the floor, radians; positive lifts the toes.
    pub(super) pitch: f64,
    /// The toes against the floor, radians; positive lifts them.
    pub(super) toe_pitch: f64,
}

impl FootPose {
    /// The foot's orientation in world space.
    pub(super) fn orientation(&self) -> DQuat {
        about_y(self.yaw) * about_x(-self.pitch)
    }
}

/// How a foot rolls and swings, whatever the size of the step.
#[derive(Clone, Debug)]
pub(super) struct FootStyle {
    /// Phase at which the sole is down.
    pub(super) flat_from: f64,
    /// Phase at which the heel rises.
    pub(super) flat_to: f64,
    /// Phase at which the toes begin to rise from the floor.
    pub(super) toes_flat_to: f64,
    /// Phase of toe-off.
    pub(super) toe_off: f64,
    /// Foot pitch in degrees at phases between `flat_to` and `1 + flat_from`, toe-off and heel
    /// strike (phase 1) among them.
    pub(super) pitch: Vec<(f64, f64)>,
    /// Pitch of the toes in degrees at phases between `toes_flat_to` and `1 + flat_from`.
    pub(super) toe_pitch: Vec<(f64, f64)>,
    /// The ankle's way in the swing: part of the swing's time, part of the way forward.
    pub(super) swing_forward: Vec<(f64, f64)>,
    /// Part of the swing's time, height of the ankle in metres.
    pub(super) swing_height: Vec<(f64, f64)>,
    /// Where the foot points, degrees outwards.
    pub(super) toe_out_deg: f64,
}

/// The path of a left foot that steps forward by a stride each cycle.
#[derive(Clone, Debug)]
pub(super) struct FootPath {
    flat_from: f64,
    toe_off: f64,
    stride: f64,
    /// The heel's place at the heel strike of phase 0; it is on the floor.
    heel: DVec3,
    yaw: f64,
    pitch: Spline,
    toe_pitch: Spline,
    swing: [Spline; 3],
}

impl FootPath {
    /// The path that a style makes with this stride, in metres, when the heel strikes at `heel` at
    /// phase 0.
    pub(super) fn new(style: &FootStyle, stride: f64, heel: DVec3) -> Self {
        let roll = |from: f64, angles: &[(f64, f64)]| {
            let mut points = vec![(from, 0.0)];
            points.extend(angles.iter().map(|&(at, deg)| (at, deg.to_radians())));
            points.push((1.0 + style.flat_from, 0.0));
            Spline::clamped(&points, 0.0, 0.0)
        };
        let still = Spline::clamped(&[(0.0, 0.0), (1.0, 0.0)], 0.0, 0.0);
        let mut path = Self {
            flat_from: style.flat_from,
            toe_off: style.toe_off,
            stride,
            heel,
            yaw: style.toe_out_deg.to_radians(),
            pitch: roll(style.flat_to, &style.pitch),
            toe_pitch: roll(style.toes_flat_to, &style.toe_pitch),
            swing: [still.clone(), still.clone(), still],
        };
        path.swing = path.swing_splines(style);
        path
    }

    /// The ankle between toe-off and heel strike, each coordinate over the part of the swing's
    /// time, with the rolling foot's velocity at both ends.
    fn swing_splines(&self, style: &FootStyle) -> [Spline; 3] {
        const STEP: f64 = 1e-5;
        let ahead = DVec3::new(0.0, 0.0, self.stride);
        let (start, end) = (self.planted(self.toe_off), self.planted(0.0) + ahead);
        let swing_phase = 1.0 - self.toe_off;
        let start_slope = (start - self.planted(self.toe_off - STEP)) * (swing_phase / STEP);
        let end_slope = (self.planted(STEP) - self.planted(0.0)) * (swing_phase / STEP);
        let spline = |axis: usize, inner: Vec<(f64, f64)>| {
            let mut points = vec![(0.0, start[axis])];
            points.extend(inner);
            points.push((1.0, end[axis]));
            Spline::clamped(&points, start_slope[axis], end_slope[axis])
        };
        let forward = style.swing_forward.iter();
        let forward = forward.map(|&(at, part)| (at, start.z + part * (end.z - start.z)));
        [
            spline(0, Vec::new()),
            spline(1, style.swing_height.clone()),
            spline(2, forward.collect()),
        ]
    }

    /// The foot at a phase, which may lie in any cycle.
    pub(super) fn at(&self, phase: f64) -> FootPose {
        let cycle = libm::floor(phase);
        let phase = phase - cycle;
        let ankle = if phase < self.toe_off {
            self.planted(phase)
        } else {
            let part = (phase - self.toe_off) / (1.0 - self.toe_off);
            DVec3::from_array([0, 1, 2].map(|axis: usize| self.swing[axis].at(part)))
        };
        FootPose {
            ankle: ankle + DVec3::new(0.0, 0.0, cycle * self.stride),
            yaw: self.yaw,
            pitch: self.roll(&self.pitch, phase),
            toe_pitch: self.roll(&self.toe_pitch, phase),
        }
    }

    /// An angle at a phase from 0 to 1; the heel rocker stands at the end of the spline.
    fn roll(&self, angles: &Spline, phase: f64) -> f64 {
        angles.at(if phase < self.flat_from {
            phase + 1.0
        } else {
            phase
        })
    }

    /// The ankle while the foot of phase 0 is on the floor.
    fn planted(&self, phase: f64) -> DVec3 {
        let pitch = self.roll(&self.pitch, phase);
        let (turn, foot_turn) = (about_y(self.yaw), about_x(-pitch));
        if phase < self.flat_from {
            return self.heel + turn * (foot_turn * DVec3::new(0.0, ANKLE_HEIGHT, HEEL_BACK));
        }
        let toe_turn = about_x(-self.roll(&self.toe_pitch, phase));
        let sole = HEEL_BACK + BALL_FORWARD + TOE_LENGTH;
        let tip = DVec3::new(0.0, TIP_HEIGHT, sole);
        let ball_from_tip = DVec3::new(0.0, BALL_HEIGHT - TIP_HEIGHT, -TOE_LENGTH);
        let ankle_from_ball = DVec3::new(0.0, ANKLE_HEIGHT - BALL_HEIGHT, -BALL_FORWARD);
        self.heel + turn * (tip + toe_turn * ball_from_tip + foot_turn * ankle_from_ball)
    }
}
