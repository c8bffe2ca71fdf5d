//! One frame: local and global poses, and forward kinematics between them.
//!
//! A [`LocalPose`] holds each joint's transform in its parent's space, a [`GlobalPose`] in world
//! space. Forward kinematics walks the joints in topological order:
//! `Q_child = Q_parent * R_child`, `P_child = P_parent + Q_parent * L_child`, so that a point at `p`
//! in the space of the last joint of a chain stands at `J0 L1 J1 L2 ... p` in world space (Parent,
//! "Computer Animation", 3rd ed. 2012, ch. 5).
//!
//! Units: lengths in the file's unit, unit quaternions. Cost: one quaternion product and one
//! rotated vector a joint; nothing is allocated where a pose is passed in to be filled.

use glam::{Quat, Vec3, Vec4, Vec4Swizzles};

use crate::rotation::slerp_f32;
use crate::skeleton::{JointId, Skeleton};

/// Each joint's transform in its parent's space, in topological order.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalPose {
    /// Rotation of each joint in its parent's space.
    pub rotations: Vec<Quat>,
    /// Translation of each joint in its parent's space; a root's is its place in the world.
    pub translations: Vec<Vec3>,
}

impl LocalPose {
    /// The rest pose, made of the rest transforms alone.
    pub fn rest(skeleton: &Skeleton) -> Self {
        Self {
            rotations: skeleton.rest_rotations().to_vec(),
            translations: skeleton.rest_translations().to_vec(),
        }
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.rotations.len()
    }

    /// Makes this pose the one between `from` (t = 0) and `to` (t = 1): rotations by slerp the
    /// short way, translations linearly.
    ///
    /// # Panics
    /// If the poses differ in their number of joints.
    pub fn set_interpolated(&mut self, from: &Self, to: &Self, t: f32) {
        assert_eq!(
            from.joint_count(),
            to.joint_count(),
            "poses of one skeleton"
        );
        self.rotations.clear();
        self.rotations.extend(
            from.rotations
                .iter()
                .zip(&to.rotations)
                .map(|(a, b)| slerp_f32(*a, *b, t)),
        );
        self.translations.clear();
        self.translations.extend(
            from.translations
                .iter()
                .zip(&to.translations)
                .map(|(a, b)| a.lerp(*b, t)),
        );
    }

    /// Forward kinematics: where every joint is in the world.
    ///
    /// # Panics
    /// If the pose has not as many joints as the skeleton.
    pub fn to_global(&self, skeleton: &Skeleton) -> GlobalPose {
        let mut global = GlobalPose::default();
        forward_kinematics(skeleton, self, &mut global);
        global
    }
}

/// Each joint's transform in world space, in topological order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GlobalPose {
    /// Position of each joint in the world.
    pub positions: Vec<Vec3>,
    /// Orientation of each joint in the world.
    pub orientations: Vec<Quat>,
}

impl GlobalPose {
    /// The rest pose of a skeleton in world space.
    pub fn rest(skeleton: &Skeleton) -> Self {
        LocalPose::rest(skeleton).to_global(skeleton)
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.positions.len()
    }

    /// Where a point attached to a joint's link is in the world: the map `J0 L1 J1 L2 ...` applied
    /// to `point_in_joint`.
    pub fn transform_point(&self, joint: JointId, point_in_joint: Vec3) -> Vec3 {
        self.positions[joint.index()] + self.orientations[joint.index()] * point_in_joint
    }

    /// Where a point in the world is in a joint's space: the inverse of
    /// [`transform_point`](Self::transform_point).
    pub fn inverse_transform_point(&self, joint: JointId, point_in_world: Vec3) -> Vec3 {
        let from_joint = point_in_world - self.positions[joint.index()];
        self.orientations[joint.index()].inverse() * from_joint
    }

    /// The lowest and the highest coordinates of all joints. Both zero for a pose without joints.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let Some(&first) = self.positions.first() else {
            return (Vec3::ZERO, Vec3::ZERO);
        };
        self.positions
            .iter()
            .fold((first, first), |(low, high), &p| (low.min(p), high.max(p)))
    }

    /// The local pose that forward kinematics turns into this one.
    ///
    /// # Panics
    /// If the pose has not as many joints as the skeleton.
    pub fn to_local(&self, skeleton: &Skeleton) -> LocalPose {
        assert_eq!(
            self.joint_count(),
            skeleton.joint_count(),
            "a pose of this skeleton"
        );
        let mut local = LocalPose::rest(skeleton);
        for joint in skeleton.joints() {
            let index = joint.index();
            let (rotation, translation) = match skeleton.parent(joint) {
                None => (self.orientations[index], self.positions[index]),
                Some(parent) => (
                    self.orientations[parent.index()].inverse() * self.orientations[index],
                    self.inverse_transform_point(parent, self.positions[index]),
                ),
            };
            local.rotations[index] = rotation;
            local.translations[index] = translation;
        }
        local
    }
}

/// Computes every joint's world transform into `global`, which is resized to fit and can be used
/// again for the next pose without allocating.
///
/// # Panics
/// If the pose has not as many joints as the skeleton.
pub fn forward_kinematics(skeleton: &Skeleton, local: &LocalPose, global: &mut GlobalPose) {
    let joint_count = skeleton.joint_count();
    assert_eq!(
        local.rotations.len(),
        joint_count,
        "a rotation for every joint of the skeleton"
    );
    assert_eq!(
        local.translations.len(),
        joint_count,
        "a translation for every joint"
    );
    global.positions.resize(joint_count, Vec3::ZERO);
    global.orientations.resize(joint_count, Quat::IDENTITY);
    // Four slices of one length: an index is compared with it once.
    let positions = &mut global.positions[..joint_count];
    let orientations = &mut global.orientations[..joint_count];
    let translations = &local.translations[..joint_count];
    let rotations = &local.rotations[..joint_count];
    for root in skeleton.roots() {
        positions[root.index()] = translations[root.index()];
        orientations[root.index()] = rotations[root.index()];
    }
    for link in skeleton.links_by_depth() {
        let (parent, child) = (link.parent.index(), link.child.index());
        let turn = Vec4::from(orientations[parent]);
        let turned = rotate(turn, translations[child].extend(0.0));
        positions[child] = positions[parent] + turned.truncate();
        orientations[child] = Quat::from_vec4(product(turn, rotations[child].into()));
    }
}

/// Rotates a vector: `v + 2 w (u x v) + 2 u x (u x v)` with `u` the quaternion's vector part. The
/// operations and their order are those of the batch path, and so are the bits; the last component
/// means nothing.
#[inline(always)]
fn rotate(q: Vec4, v: Vec4) -> Vec4 {
    let (next, last) = (q.yzxy(), q.zxyz());
    let t = next * v.zxyz() - last * v.yzxy();
    let t = t + t;
    v + q.wwww() * t + (next * t.zxyz() - last * t.yzxy())
}

/// The quaternion product, operation for operation that of the batch path. Written so that three
/// components share all signs and only the last needs changing, which is cheaper than the product in
/// glam.
#[inline(always)]
fn product(a: Vec4, b: Vec4) -> Vec4 {
    let sum = a.xyzx() * b.wwwx() + a.yzxy() * b.zxyy();
    a.wwww() * b + sum * Vec4::new(1.0, 1.0, 1.0, -1.0) - a.zxyz() * b.yzxz()
}
