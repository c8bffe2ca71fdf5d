//! Values to transforms and back.

use glam::{DQuat, DVec3};

use super::{Frame, Freedom, Mechanism};
use crate::pose::LocalPose;
use crate::rotation::{exp, log, swing_twist};
use crate::skeleton::JointId;

/// A joint's motion in its own frame at rest.
#[derive(Clone, Copy, Debug)]
struct Motion {
    rotation: DQuat,
    translation: DVec3,
}

impl Motion {
    const NONE: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };
}

/// The motion that a joint's values say; there are as many as its freedom has.
#[inline]
fn joint_motion(freedom: Freedom, values: &[f64]) -> Motion {
    match (freedom, values) {
        (Freedom::Hinge { axis }, &[angle]) => Motion {
            rotation: turn(axis, angle),
            ..Motion::NONE
        },
        (Freedom::Slide { axis }, &[length]) => Motion {
            translation: axis * length,
            ..Motion::NONE
        },
        (Freedom::Planar { normal }, &[x, y, angle]) => Motion {
            rotation: turn(normal, angle),
            translation: plane_from_z(normal) * DVec3::new(x, y, 0.0),
        },
        (Freedom::Ball, &[x, y, z]) => Motion {
            rotation: exp(DVec3::new(x, y, z)),
            ..Motion::NONE
        },
        (Freedom::Free, &[x, y, z, rx, ry, rz]) => Motion {
            rotation: exp(DVec3::new(rx, ry, rz)),
            translation: DVec3::new(x, y, z),
        },
        _ => Motion::NONE,
    }
}

/// The turn by an angle about a unit axis.
#[inline]
fn turn(axis: DVec3, angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_vec4((axis * sin).extend(cos))
}

/// The shortest rotation that carries Z to a plane's normal.
fn plane_from_z(normal: DVec3) -> DQuat {
    DQuat::from_rotation_arc(DVec3::Z, normal)
}

impl Mechanism {
    /// Where the joints are in the world, in topological order, computed in `f64`.
    ///
    /// # Panics
    /// If there are not as many values as the mechanism has.
    pub fn global_frames(&self, values: &[f64]) -> Vec<Frame> {
        let mut frames = Vec::new();
        self.set_global_frames(values, &mut frames);
        frames
    }

    /// [`global_frames`](Self::global_frames) into a list that is used again.
    ///
    /// # Panics
    /// If there are not as many values as the mechanism has.
    pub fn set_global_frames(&self, values: &[f64], frames: &mut Vec<Frame>) {
        assert_eq!(
            values.len(),
            self.value_count(),
            "all values of the mechanism"
        );
        frames.clear();
        for joint in self.skeleton().joints() {
            let (rotation, translation) = self.local_transform(joint, values);
            let parent = match self.skeleton().parent(joint) {
                Some(parent) => frames[parent.index()],
                None => Frame::IDENTITY,
            };
            frames.push(Frame {
                position: parent.position + parent.orientation * translation,
                // Normalised, so that a rope of thousand joints does not drift from a rotation.
                orientation: (parent.orientation * rotation).normalize(),
            });
        }
    }

    /// The pose that the values say.
    ///
    /// # Panics
    /// If there are not as many values as the mechanism has.
    pub fn local_pose(&self, values: &[f64]) -> LocalPose {
        let mut pose = LocalPose::rest(self.skeleton());
        self.set_local_pose(values, &mut pose);
        pose
    }

    /// [`local_pose`](Self::local_pose) into a pose that is used again.
    ///
    /// # Panics
    /// If there are not as many values as the mechanism has, or the pose is of another skeleton.
    pub fn set_local_pose(&self, values: &[f64], pose: &mut LocalPose) {
        assert_eq!(
            values.len(),
            self.value_count(),
            "all values of the mechanism"
        );
        assert_eq!(
            pose.joint_count(),
            self.joints().len(),
            "a pose of this skeleton"
        );
        for joint in self.skeleton().joints() {
            let (rotation, translation) = self.local_transform(joint, values);
            pose.rotations[joint.index()] = rotation.as_quat();
            pose.translations[joint.index()] = translation.as_vec3();
        }
    }

    /// The values nearest to a pose: of a hinge the twist about its axis, of a slide the length along
    /// it; what else the pose does at such a joint is left out. A joint that follows another is not
    /// asked. Angles are within half a turn of zero; ranges are not looked at.
    ///
    /// # Panics
    /// If the pose is of another skeleton.
    pub fn values_of(&self, pose: &LocalPose) -> Vec<f64> {
        assert_eq!(
            pose.joint_count(),
            self.joints().len(),
            "a pose of this skeleton"
        );
        let mut values = Vec::with_capacity(self.value_count());
        for joint in self.moving_joints() {
            let described = self.joint(joint);
            let unrest = described.rest_rotation.conjugate();
            let rotation = unrest * pose.rotations[joint.index()].as_dquat();
            let translation =
                unrest * (pose.translations[joint.index()].as_dvec3() - described.rest_translation);
            match described.freedom {
                Freedom::Fixed => {}
                Freedom::Hinge { axis } => values.push(swing_twist(rotation, axis).twist_angle_rad),
                Freedom::Slide { axis } => values.push(translation.dot(axis)),
                Freedom::Planar { normal } => {
                    let in_plane = plane_from_z(normal).conjugate() * translation;
                    let angle = swing_twist(rotation, normal).twist_angle_rad;
                    values.extend([in_plane.x, in_plane.y, angle]);
                }
                Freedom::Ball => values.extend(log(rotation).to_array()),
                Freedom::Free => {
                    values.extend(translation.to_array());
                    values.extend(log(rotation).to_array());
                }
            }
        }
        values
    }

    /// A joint's rotation and translation in its parent's space.
    fn local_transform(&self, joint: JointId, values: &[f64]) -> (DQuat, DVec3) {
        let described = self.joint(joint);
        let motion = match self.followed_value(joint) {
            Some(followed) => {
                let value = followed.multiplier * values[followed.index] + followed.offset;
                joint_motion(described.freedom, &[value])
            }
            None => joint_motion(described.freedom, &values[self.values_of_joint(joint)]),
        };
        (
            described.rest_rotation * motion.rotation,
            described.rest_translation + described.rest_rotation * motion.translation,
        )
    }
}
