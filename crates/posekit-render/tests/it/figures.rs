//! Figures that tests draw.

use std::sync::Arc;

use glam::{Quat, Vec3};

use posekit::motion::{FrameTime, Motion};
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};
use posekit_render::stage::{Actor, SkeletonStyle, Stage, StageOptions};
use posekit_render::theme::CharacterColors;

/// Somebody 1.7 long, in lengths of `unit` metres, arms held out.
pub(crate) fn person(unit: f32) -> Skeleton {
    let s = 1.0 / unit;
    let mut b = SkeletonBuilder::new();
    let v = |x: f32, y: f32, z: f32| Vec3::new(x, y, z) * s;
    let hips = b.joint("hips", None, v(0.0, 0.95, 0.0));
    for (side, x) in [("left", 1.0), ("right", -1.0)] {
        let hip = b.joint(format!("{side}Hip"), Some(hips), v(0.1 * x, -0.05, 0.0));
        let knee = b.joint(format!("{side}Knee"), Some(hip), v(0.0, -0.41, 0.0));
        let ankle = b.joint(format!("{side}Ankle"), Some(knee), v(0.0, -0.39, 0.0));
        let toe = b.joint(format!("{side}Toe"), Some(ankle), v(0.0, -0.05, 0.13));
        b.end_site(format!("{side}ToeEnd"), toe, v(0.0, 0.0, 0.06));
    }
    let chest = b.joint("chest", Some(hips), v(0.0, 0.25, 0.0));
    let head = b.joint("head", Some(chest), v(0.0, 0.27, 0.0));
    b.end_site("headEnd", head, v(0.0, 0.2, 0.0));
    for (side, x) in [("left", 1.0), ("right", -1.0)] {
        let shoulder = b.joint(
            format!("{side}Shoulder"),
            Some(chest),
            v(0.16 * x, 0.18, 0.0),
        );
        let elbow = b.joint(
            format!("{side}Elbow"),
            Some(shoulder),
            v(0.25 * x, 0.0, 0.0),
        );
        let wrist = b.joint(format!("{side}Wrist"), Some(elbow), v(0.24 * x, 0.0, 0.0));
        b.end_site(format!("{side}HandEnd"), wrist, v(0.1 * x, 0.0, 0.0));
    }
    b.build().unwrap()
}

/// A second of the person raising and lowering the left arm, 30 frames.
pub(crate) fn waving(unit: f32) -> Arc<Motion> {
    let skeleton = Arc::new(person(unit));
    let arm = skeleton.find("leftShoulder").unwrap();
    let mut motion = Motion::at_rest(skeleton, 30, FrameTime::of_fps(30), [JointId::new(0)]);
    for frame in 0..30 {
        let angle = 1.2 * libm::sinf(frame as f32 * std::f32::consts::TAU / 29.0);
        motion.set_rotation(frame, arm, Quat::from_axis_angle(Vec3::Z, angle));
    }
    Arc::new(motion)
}

pub(crate) fn stage_of(motion: Arc<Motion>, options: StageOptions) -> Stage {
    let actor = Actor::new(motion, options.style, CharacterColors::of(0));
    Stage::new(vec![actor], options)
}

pub(crate) const STYLES: [SkeletonStyle; 4] = [
    SkeletonStyle::Body,
    SkeletonStyle::Bones,
    SkeletonStyle::Octahedra,
    SkeletonStyle::Lines,
];
