//! Picking: which bone is under the pointer.

use glam::{Vec2, Vec3};
use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton};
use posekit_render::camera::Camera;

/// How near to a bone's middle line the pointer must be, in points.
const BONE_REACH: f32 = 12.0;

/// A joint's ball is taken before the bones that meet in it.
const JOINT_REACH: f32 = 7.0;

/// The joint whose bone, or ball, is under a point of the picture.
///
/// A bone belongs to the joint that turns it, its upper end. Of several in reach the nearest to the
/// pointer is taken, and of equals the one in front.
#[must_use]
pub fn pick(
    skeleton: &Skeleton,
    pose: &GlobalPose,
    camera: &Camera,
    size: (u32, u32),
    point: Vec2,
) -> Option<(JointId, f32)> {
    let project = |p: &Vec3| camera.project(*p, size);
    let screen: Vec<Option<Vec3>> = pose.positions.iter().map(project).collect();
    let mut best: Option<(JointId, f32)> = None;
    let mut offer = |joint: JointId, distance: f32| {
        if best.is_none_or(|(_, nearest)| distance < nearest) {
            best = Some((joint, distance));
        }
    };
    for joint in skeleton.joints() {
        let Some(here) = screen[joint.index()] else {
            continue;
        };
        let ball = here.truncate().distance(point);
        if ball <= JOINT_REACH && !skeleton.is_end_site(joint) {
            // Nearer than any bone in reach, the more the nearer its middle.
            offer(joint, ball - JOINT_REACH);
        }
        let Some(parent) = skeleton.parent(joint) else {
            continue;
        };
        let Some(there) = screen[parent.index()] else {
            continue;
        };
        let distance = distance_to_segment(point, there.truncate(), here.truncate());
        if distance <= BONE_REACH {
            let nearness = 1e-3 * (here.z + there.z) / (here.z + there.z + 1.0);
            offer(parent, distance + nearness);
        }
    }
    best
}

/// How near to a joint's dot the pointer must be to drag it, in points.
const DOT_REACH: f32 = 17.0;

/// The joint, End Sites included, that is to be dragged at a point of the picture: the one whose
/// place is nearest within reach, or else the lower end of the bone that is there.
#[must_use]
pub fn pick_effector(
    skeleton: &Skeleton,
    pose: &GlobalPose,
    camera: &Camera,
    size: (u32, u32),
    point: Vec2,
) -> Option<(JointId, f32)> {
    let project = |p: &Vec3| camera.project(*p, size);
    let screen: Vec<Option<Vec3>> = pose.positions.iter().map(project).collect();
    let joints = skeleton.joints();
    let on_joint = joints.filter_map(|joint| {
        let here = screen[joint.index()]?;
        let distance = here.truncate().distance(point);
        // Of joints that coincide the one nearest to the root is dragged: a hand, not its thumb.
        let depth = 1e-3 * index_to_f32(joint.index());
        (distance <= DOT_REACH).then_some((joint, distance - DOT_REACH + depth))
    });
    let nearest = on_joint.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.or_else(|| {
        let bones = skeleton.joints().filter_map(|joint| {
            let (here, parent) = (screen[joint.index()]?, skeleton.parent(joint)?);
            let there = screen[parent.index()]?;
            let distance = distance_to_segment(point, there.truncate(), here.truncate());
            (distance <= BONE_REACH).then_some((joint, distance))
        });
        bones.min_by(|a, b| a.1.total_cmp(&b.1))
    })
}

#[expect(clippy::cast_precision_loss, reason = "joints are few")]
fn index_to_f32(index: usize) -> f32 {
    index as f32
}

/// Distance from a point to a line segment.
#[must_use]
pub fn distance_to_segment(point: Vec2, start: Vec2, end: Vec2) -> f32 {
    let along = end - start;
    let length_squared = along.length_squared();
    if length_squared <= f32::MIN_POSITIVE {
        return point.distance(start);
    }
    let t = ((point - start).dot(along) / length_squared).clamp(0.0, 1.0);
    point.distance(start + along * t)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use posekit::skeleton::SkeletonBuilder;
    use posekit_render::camera::{Orbit, Projection};

    use super::*;

    /// A root at the origin, an elbow one to the right and an end two to the right.
    fn arm() -> (Skeleton, GlobalPose, Camera) {
        let mut builder = SkeletonBuilder::new();
        let shoulder = builder.joint("Shoulder", None, Vec3::ZERO);
        let elbow = builder.joint("Elbow", Some(shoulder), Vec3::X);
        builder.end_site("Hand", elbow, Vec3::X);
        let skeleton = builder.build().expect("a valid skeleton");
        let pose = GlobalPose::rest(&skeleton);
        let projection = Projection::Orthographic { height: 4.0 };
        let orbit = Orbit {
            target: Vec3::ZERO,
            yaw_rad: 0.0,
            pitch_rad: 0.0,
            distance: 9.0,
            projection,
        };
        (skeleton, pose, orbit.camera())
    }

    fn picked(x: f32, y: f32) -> Option<usize> {
        let (skeleton, pose, camera) = arm();
        pick(&skeleton, &pose, &camera, (800, 400), Vec2::new(x, y)).map(|(j, _)| j.index())
    }

    #[test]
    fn a_bone_belongs_to_the_joint_that_turns_it() {
        // 100 pixels a unit; the root is in the middle of 800 x 400.
        assert_eq!(picked(450.0, 205.0), Some(0));
        assert_eq!(picked(550.0, 195.0), Some(1));
        assert_eq!(
            picked(597.0, 200.0),
            Some(1),
            "an End Site itself is not picked"
        );
    }

    #[test]
    fn a_ball_is_taken_before_the_bone_that_ends_in_it() {
        assert_eq!(picked(497.0, 200.0), Some(1));
        assert_eq!(picked(403.0, 200.0), Some(0));
    }

    #[test]
    fn the_end_of_a_limb_is_dragged_and_a_bone_by_its_lower_end() {
        let dragged = |x: f32, y: f32| {
            let (skeleton, pose, camera) = arm();
            pick_effector(&skeleton, &pose, &camera, (800, 400), Vec2::new(x, y))
                .map(|(joint, _)| joint.index())
        };
        assert_eq!(dragged(600.0, 203.0), Some(2), "an End Site can be dragged");
        assert_eq!(dragged(550.0, 200.0), Some(2));
        assert_eq!(dragged(501.0, 200.0), Some(1));
        assert_eq!(dragged(400.0, 200.0), Some(0));
        assert_eq!(dragged(615.0, 200.0), Some(2), "dots have some room around");
        assert_eq!(dragged(550.0, 230.0), None);
    }

    #[test]
    fn nothing_is_far_from_everything() {
        assert_eq!(picked(450.0, 230.0), None);
        assert_eq!(picked(100.0, 200.0), None);
    }
}
