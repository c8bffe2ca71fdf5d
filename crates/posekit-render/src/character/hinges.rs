//! Joints that turn about one axis only, as a machine's do.

use glam::Vec3;

use posekit::motion::Motion;
use posekit::skeleton::JointId;

/// Frames that are looked at.
const SAMPLES: usize = 48;

/// Sine of half the angle below which a joint counts as still: 2 degrees.
const STILL: f32 = 0.0175;

/// How far the axis may wander: this share of the half angle's sine, and a little for rounding.
const WANDER: f32 = 0.03;
const ROUNDING: f32 = 0.002;

/// For every joint of a motion the unit axis, in the joint's space, about which alone it turns;
/// `None` for one that stands still or turns about more than one.
pub(super) fn hinge_axes(motion: &Motion) -> Vec<Option<Vec3>> {
    let skeleton = motion.skeleton();
    skeleton.joints().map(|j| hinge_axis(motion, j)).collect()
}

fn hinge_axis(motion: &Motion, joint: JointId) -> Option<Vec3> {
    let frames = motion.frame_count();
    if frames < 2 {
        return None;
    }
    let count = frames.min(SAMPLES);
    let first = motion.rotation(0, joint).conjugate();
    // The vector part of a unit quaternion: the axis times the sine of half the angle.
    let turns: Vec<Vec3> = (1..count)
        .map(|i| {
            let turn = first * motion.rotation(i * (frames - 1) / (count - 1), joint);
            Vec3::new(turn.x, turn.y, turn.z)
        })
        .collect();
    let widest = turns
        .iter()
        .copied()
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
    let reach = widest.length();
    if reach.is_nan() || reach < STILL {
        return None;
    }
    let axis = widest / reach;
    let limit = WANDER * reach + ROUNDING;
    turns
        .iter()
        .all(|turn| turn.reject_from_normalized(axis).length() <= limit)
        .then_some(axis)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Quat;
    use posekit::motion::FrameTime;
    use posekit::skeleton::SkeletonBuilder;

    use super::*;

    #[test]
    fn finds_the_axis_of_a_hinge_and_none_of_a_ball_joint() {
        let mut b = SkeletonBuilder::new();
        let root = b.joint("root", None, Vec3::ZERO);
        let hinge = b.joint("hinge", Some(root), Vec3::Y);
        let ball = b.joint("ball", Some(hinge), Vec3::Y);
        let skeleton = Arc::new(b.build().unwrap());
        let mut motion = Motion::at_rest(skeleton, 20, FrameTime::of_fps(10), []);
        let axis = Vec3::new(0.6, 0.0, 0.8);
        for frame in 0..20 {
            let t = frame as f32 / 19.0;
            // A hinge keeps its axis under a fixed turn of its mount.
            let mount = Quat::from_rotation_x(0.7);
            motion.set_rotation(frame, hinge, mount * Quat::from_axis_angle(axis, 2.0 * t));
            let both = Quat::from_rotation_x(t) * Quat::from_rotation_z(t * t);
            motion.set_rotation(frame, ball, both);
        }
        let axes = hinge_axes(&motion);
        assert_eq!(axes[0], None);
        assert!(axes[1].unwrap().dot(axis).abs() > 0.9999);
        assert_eq!(axes[2], None);
    }
}
