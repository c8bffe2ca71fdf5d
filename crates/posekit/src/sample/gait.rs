//! Whole-body gait: a pelvis that rides over two rolling feet, a trunk that turns against it, and
//! arms that swing against the legs.
//!
//! The method is kinematic, as in Boulic, Magnenat-Thalmann and Thalmann, "A global human walking
//! model with real-time kinematic personification" (The Visual Computer 6, 1990) and Bruderlin and
//! Calvert, "Goal-directed, dynamic animation of human walking" (SIGGRAPH 1989): the determinants
//! of gait (Saunders, Inman and Eberhart 1953; Inman, Ralston and Todd, "Human Walking", 1981) as
//! low harmonics of the gait cycle, the stance foot pinned to the floor, and the legs solved from
//! hip and ankle in closed form. Unlike theirs, the joint angles of the legs are a result, not an
//! input: that is what keeps the feet from sliding.
//!
//! Phase 0 is the left heel strike; the right foot is half a cycle behind. The cycle lasts a whole
//! number of frames, so that the last frame repeats the first one a few strides further on.

use glam::{DQuat, DVec3};

use super::curve::cos_turns;
use super::foot::{FootPath, FootStyle};
use super::humanoid::{Figure, HIPS, motion_of};
use super::leg;
use super::posture::{ArmPose, Bearing, turn_trunk};
use crate::motion::{FrameTime, Motion};

/// A value that swings about its mean once or twice a cycle, in degrees or metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swing {
    pub(super) mean: f64,
    pub(super) amplitude: f64,
    /// Phase at which it is highest.
    pub(super) peak: f64,
}

impl Swing {
    pub(super) const fn new(mean: f64, amplitude: f64, peak: f64) -> Self {
        Self {
            mean,
            amplitude,
            peak,
        }
    }

    fn once(&self, phase: f64) -> f64 {
        self.mean + self.amplitude * cos_turns(phase - self.peak)
    }

    fn twice(&self, phase: f64) -> f64 {
        self.mean + self.amplitude * cos_turns(2.0 * (phase - self.peak))
    }
}

/// All that tells one gait from another. Angles in degrees, lengths in metres; a phase of the
/// pelvis, the trunk and the left arm is counted from the left heel strike.
#[derive(Clone, Debug)]
pub(super) struct GaitStyle {
    pub(super) stride: f64,
    pub(super) frames_per_cycle: u32,
    pub(super) cycles: u32,
    pub(super) foot: FootStyle,
    /// How far to the left of the middle the left heel comes down.
    pub(super) heel_side: f64,
    /// How far ahead of the pelvis the heel comes down.
    pub(super) heel_ahead: f64,
    /// The least that the knees ever bend.
    pub(super) least_knee_deg: f64,
    /// Height of the pelvis about its mean; its `mean` is not used.
    pub(super) pelvis_rise: Swing,
    /// Sideways towards the left.
    pub(super) pelvis_sway: Swing,
    /// Forward about the uniform way.
    pub(super) pelvis_surge: Swing,
    /// Left hip forward.
    pub(super) pelvis_yaw: Swing,
    /// Left hip up.
    pub(super) pelvis_list: Swing,
    /// Leaning forward.
    pub(super) pelvis_tilt: Swing,
    /// Left shoulder forward, in the world.
    pub(super) chest_yaw: Swing,
    /// Left shoulder up, in the world.
    pub(super) chest_list: Swing,
    /// Leaning forward, in the world.
    pub(super) chest_lean: Swing,
    /// Nodding, in the world.
    pub(super) head_nod: Swing,
    pub(super) arm: ArmStyle,
}

/// How the arms swing.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArmStyle {
    /// Upper arm forward.
    pub(super) shoulder: Swing,
    /// Away from the body.
    pub(super) abduction: Swing,
    /// Turned inwards about the upper arm.
    pub(super) inward: Swing,
    pub(super) elbow: Swing,
    /// Hand bent towards the palm.
    pub(super) wrist: Swing,
    /// Shoulder girdle forward.
    pub(super) girdle: Swing,
}

/// Frames a second of all samples.
pub(super) const FRAMES_PER_SEC: f64 = 60.0;

/// The time between two of them.
pub(super) const FRAME_TIME: FrameTime = FrameTime::of_fps(60);

/// The motion of a gait: `cycles` whole cycles, and the first frame once more at the end.
pub(super) fn motion(style: &GaitStyle) -> Motion {
    let gait = Gait::new(style);
    let frames = 0..=style.frames_per_cycle * style.cycles;
    let figures: Vec<Figure> = frames
        .map(|frame| gait.figure(f64::from(frame) / f64::from(style.frames_per_cycle)))
        .collect();
    motion_of(&figures)
}

struct Gait<'a> {
    style: &'a GaitStyle,
    foot: FootPath,
    /// Height of the pelvis, as low as the feet's reach asks for.
    pelvis_height: f64,
}

impl<'a> Gait<'a> {
    fn new(style: &'a GaitStyle) -> Self {
        let heel = DVec3::new(style.heel_side, 0.0, style.heel_ahead);
        let mut gait = Self {
            style,
            foot: FootPath::new(&style.foot, style.stride, heel),
            pelvis_height: 0.0,
        };
        gait.pelvis_height = gait.highest_pelvis();
        gait
    }

    /// The highest mean height from which both feet are in reach throughout, the knees bent as
    /// much as they have to be.
    fn highest_pelvis(&self) -> f64 {
        const SAMPLES: u32 = 256;
        let reach = leg::leg_length(self.style.least_knee_deg.to_radians());
        let phases = (0..SAMPLES).map(|sample| f64::from(sample) / f64::from(SAMPLES));
        phases
            .map(|phase| {
                let (at, turn) = self.pelvis(phase);
                let hip = at + turn * leg::hip_in_pelvis();
                let ankle = self.foot.at(phase).ankle;
                let level = DVec3::new(hip.x - ankle.x, 0.0, hip.z - ankle.z).length_squared();
                ankle.y + libm::sqrt((reach * reach - level).max(0.0)) - hip.y
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// Place and orientation of the pelvis, its height over the mean.
    fn pelvis(&self, phase: f64) -> (DVec3, DQuat) {
        let style = self.style;
        let at = DVec3::new(
            style.pelvis_sway.once(phase),
            self.pelvis_height + style.pelvis_rise.twice(phase),
            style.stride * phase + style.pelvis_surge.twice(phase),
        );
        let turn = Bearing {
            yaw: style.pelvis_yaw.once(phase),
            list: style.pelvis_list.once(phase),
            lean: style.pelvis_tilt.twice(phase),
        };
        (at, turn.rotation())
    }

    fn figure(&self, phase: f64) -> Figure {
        let style = self.style;
        let (at, pelvis) = self.pelvis(phase);
        let mut figure = Figure::new(at);
        figure.rotations[HIPS] = pelvis;
        let chest = Bearing {
            yaw: style.chest_yaw.once(phase),
            list: style.chest_list.once(phase),
            lean: style.chest_lean.twice(phase),
        };
        let head = Bearing {
            // Eyes stay on the way ahead: only a little of the chest's turn reaches the head.
            yaw: 0.15 * chest.yaw,
            list: 0.0,
            lean: style.head_nod.twice(phase),
        };
        turn_trunk(&mut figure, chest.rotation(), head.rotation());
        let half_stride = DVec3::new(0.0, 0.0, 0.5 * style.stride);
        let left = self.foot.at(phase);
        let mut right = self.foot.at(phase + 0.5);
        right.ankle -= half_stride;
        leg::reach_feet(&mut figure, &left, &right);
        style.arm.at(phase).turn_left(&mut figure);
        style.arm.at(phase + 0.5).turn_right(&mut figure);
        figure
    }
}

impl ArmStyle {
    /// The left arm at a phase; the right one is half a cycle behind.
    fn at(&self, phase: f64) -> ArmPose {
        ArmPose {
            flexion: self.shoulder.once(phase),
            abduction: self.abduction.once(phase),
            inward: self.inward.once(phase),
            elbow: self.elbow.once(phase),
            wrist: self.wrist.once(phase),
            deviation: 0.0,
            girdle_forward: self.girdle.once(phase),
            girdle_up: 0.0,
        }
    }
}
