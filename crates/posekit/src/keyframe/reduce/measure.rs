//! How far keys are from the motion that they stand for.

use glam::Vec3;

use crate::keyframe::animation::{Animation, BakeConfig};
use crate::motion::Motion;
use crate::rotation::angle_between;
use crate::skeleton::JointId;

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
        Truth::of(motion).error_of(animation)
    }
}

/// A motion and its global positions, computed once.
pub(super) struct Truth<'a> {
    motion: &'a Motion,
    /// Frame after frame.
    positions: Vec<Vec3>,
    height: f64,
}

impl<'a> Truth<'a> {
    pub(super) fn of(motion: &'a Motion) -> Self {
        let height = f64::from(motion.skeleton().height());
        Self {
            motion,
            positions: positions(motion),
            // Joints that all coincide have no height; then the unit is the file's.
            height: if height > 0.0 { height } else { 1.0 },
        }
    }

    pub(super) fn error_of(&self, animation: &Animation) -> KeyError {
        let motion = self.motion;
        let baked = animation.bake(&BakeConfig {
            start_secs: 0.0,
            frame_time_secs: motion.frame_time_secs(),
            frame_count: motion.frame_count(),
        });
        let distances = self.positions.iter().zip(positions(&baked));
        let farthest = distances.fold(0.0_f32, |most, (a, b)| most.max(a.distance_squared(b)));
        let mut widest_rad = 0.0_f64;
        for &joint in motion.rotated_joints() {
            for frame in 0..motion.frame_count() {
                let [a, b] = [motion, &baked].map(|motion| motion.rotation(frame, joint));
                // Files hold rotations to a few digits; only their directions are compared.
                let [a, b] = [a, b].map(|q| q.as_dquat().normalize());
                widest_rad = widest_rad.max(angle_between(a, b));
            }
        }
        KeyError {
            angle_deg: widest_rad.to_degrees(),
            distance_heights: f64::from(farthest).sqrt() / self.height,
        }
    }
}

fn positions(motion: &Motion) -> Vec<Vec3> {
    let global = motion.to_global();
    let joints: Vec<JointId> = motion.skeleton().joints().collect();
    let frames = 0..motion.frame_count();
    frames
        .flat_map(|frame| joints.iter().map(move |&joint| (frame, joint)))
        .map(|(frame, joint)| global.position(frame, joint))
        .collect()
}
