//! How far keys are from the motion that they stand for.

use std::sync::Arc;

use crate::keyframe::animation::{Animation, BakeConfig, index_to_f64};
use crate::motion::Motion;
use crate::rotation::angle_between;

/// The largest differences between a motion and the keys that stand for it, over all frames and joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KeyError {
    /// Between local rotations, in degrees.
    pub angle_deg: f64,
    /// Between global positions, in heights of the skeleton.
    pub distance_heights: f64,
}

impl KeyError {
    /// Whether neither is larger.
    pub fn is_within(&self, limit: &Self) -> bool {
        self.angle_deg <= limit.angle_deg && self.distance_heights <= limit.distance_heights
    }

    /// How far an animation is from a motion of the same skeleton at the motion's frames, its frame 0 at
    /// 0 s.
    ///
    /// # Panics
    /// If the skeletons differ in their number of joints.
    pub fn between(motion: &Motion, animation: &Animation) -> Self {
        assert_eq!(
            motion.skeleton().joint_count(),
            animation.skeleton().joint_count(),
            "an animation of the motion's skeleton"
        );
        let mut measure = Measure::of(motion);
        let mut first = 0;
        while first < motion.frame_count() {
            let frame_count = BLOCK.min(motion.frame_count() - first);
            let baked = animation.bake(&BakeConfig {
                start_secs: index_to_f64(first) * motion.frame_time_secs(),
                frame_time: motion.frame_time(),
                frame_count,
            });
            measure.add(motion, first, &baked, 0, frame_count);
            first += frame_count;
        }
        measure.error()
    }
}

/// How far a motion is from another one of the same joints and frames.
pub(super) fn between(motion: &Motion, other: &Motion) -> KeyError {
    let mut measure = Measure::of(motion);
    let mut first = 0;
    while first < motion.frame_count() {
        let count = BLOCK.min(motion.frame_count() - first);
        measure.add(motion, first, other, first, count);
        first += count;
    }
    measure.error()
}

/// How many frames are posed at a time: enough for the lanes of forward kinematics, few enough that their global
/// transforms take little memory.
const BLOCK: usize = 512;

/// The largest differences so far.
struct Measure {
    widest_rad: f64,
    farthest_squared: f32,
    height: f64,
}

impl Measure {
    fn of(motion: &Motion) -> Self {
        let height = f64::from(motion.skeleton().height());
        Self {
            widest_rad: 0.0,
            farthest_squared: 0.0,
            // Joints that all coincide have no height; then the unit is the file's.
            height: if height > 0.0 { height } else { 1.0 },
        }
    }

    /// Looks at some frames of a motion, and as many of another one.
    fn add(
        &mut self,
        motion: &Motion,
        first: usize,
        other: &Motion,
        other_first: usize,
        count: usize,
    ) {
        for &joint in motion.rotated_joints() {
            for frame in 0..count {
                let a = motion.rotation(first + frame, joint);
                let b = other.rotation(other_first + frame, joint);
                // Files hold rotations to a few digits; only their directions are compared.
                let [a, b] = [a, b].map(|q| q.as_dquat().normalize());
                self.widest_rad = self.widest_rad.max(angle_between(a, b));
            }
        }
        let [a, b] = [(motion, first), (other, other_first)]
            .map(|(motion, first)| part(motion, first, count).to_global());
        for joint in motion.skeleton().joints() {
            for frame in 0..count {
                let apart = a
                    .position(frame, joint)
                    .distance_squared(b.position(frame, joint));
                self.farthest_squared = self.farthest_squared.max(apart);
            }
        }
    }

    fn error(&self) -> KeyError {
        KeyError {
            angle_deg: self.widest_rad.to_degrees(),
            distance_heights: f64::from(self.farthest_squared).sqrt() / self.height,
        }
    }
}

/// Some frames of a motion.
fn part(motion: &Motion, first: usize, count: usize) -> Motion {
    let skeleton = Arc::clone(motion.skeleton());
    let moving = motion.translated_joints().iter().copied();
    let mut part = Motion::at_rest(skeleton, count, motion.frame_time(), moving);
    for &joint in motion.rotated_joints() {
        for frame in 0..count {
            part.set_rotation(frame, joint, motion.rotation(first + frame, joint));
        }
    }
    for &joint in motion.translated_joints() {
        for frame in 0..count {
            part.set_translation(frame, joint, motion.translation(first + frame, joint));
        }
    }
    part
}
