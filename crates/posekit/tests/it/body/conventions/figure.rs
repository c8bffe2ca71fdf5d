//! A figure built as a convention lays it out, and a motion of it.

use std::sync::Arc;

use glam::{Quat, Vec3};
use posekit::motion::{FrameTime, Motion};
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};

use super::Convention;

/// Where the motion stands, strides and crouches.
pub(crate) const STANDING: usize = 0;
pub(crate) const STRIDING: usize = 7;
pub(crate) const CROUCHING: usize = 15;
const FRAMES: usize = CROUCHING + 1;

/// A joint of a figure that stands.
struct Built {
    name: String,
    parent: Option<usize>,
    offset: Vec3,
    is_end: bool,
}

/// The joints so far.
#[derive(Default)]
struct Joints(Vec<Built>);

impl Joints {
    fn add(&mut self, name: String, parent: Option<usize>, offset: [f32; 3]) -> usize {
        let is_end = name.ends_with("_end");
        self.0.push(Built {
            name,
            parent,
            offset: Vec3::from(offset),
            is_end,
        });
        self.0.len() - 1
    }

    fn find(&self, name: &str) -> usize {
        let found = self.0.iter().position(|joint| joint.name == name);
        found.unwrap_or_else(|| panic!("no joint {name}"))
    }
}

impl Convention {
    fn joints(&self) -> Vec<Built> {
        let mut joints = Joints::default();
        let mut last = None;
        for &(name, offset) in self.above.iter().chain(self.trunk) {
            last = Some(joints.add(name.to_owned(), last, offset));
        }
        for &(parent, (name, offset)) in self.beside {
            let parent = joints.find(parent);
            joints.add(name.to_owned(), Some(parent), offset);
        }
        let [pelvis, chest, _] = self.trunk();
        for side in [0, 1] {
            self.add_limb(&mut joints, side, pelvis, self.leg);
            let hand = self.add_limb(&mut joints, side, chest, self.arm);
            self.add_fingers(&mut joints, side, hand);
            for &(parent, (pattern, offset)) in self.beside_limbs {
                let parent = joints.find(&self.name(parent, side));
                joints.add(
                    self.name(pattern, side),
                    Some(parent),
                    mirrored(offset, side),
                );
            }
        }
        joints.0
    }

    /// Adds a limb and returns its last joint.
    fn add_limb(
        &self,
        joints: &mut Joints,
        side: usize,
        from: &str,
        limb: &[(&'static str, [f32; 3])],
    ) -> usize {
        let mut last = joints.find(from);
        for &(pattern, offset) in limb {
            last = joints.add(self.name(pattern, side), Some(last), mirrored(offset, side));
        }
        last
    }

    fn add_fingers(&self, joints: &mut Joints, side: usize, hand: usize) {
        let (count, length, pattern) = self.fingers;
        let forearm = self.arm[3].1[0];
        let kinds = ["Thumb", "Index", "Middle", "Ring", "Pinky"];
        for (finger, kind) in kinds.iter().enumerate().take(count) {
            let apart = 0.08 * forearm * (2.0 - finger as f32);
            let mut parent = hand;
            for bone in 0..length {
                let long = if bone == 0 { 0.33 } else { 0.12 } * forearm;
                let offset = [long, 0.0, if bone == 0 { apart } else { 0.0 }];
                let name = self.name(pattern, side);
                let name = format!("{name}{kind}{}", bone + 1);
                parent = joints.add(name, Some(parent), mirrored(offset, side));
            }
        }
    }

    /// The figure in a motion: it stands, strides with its arms down, knees and elbows bent, its trunk
    /// turned, and crouches.
    pub(crate) fn motion(&self) -> Motion {
        self.motion_named(|joint| joint.to_owned())
    }

    /// The same with every joint's name replaced.
    pub(crate) fn motion_named(&self, rename: impl Fn(&str) -> String) -> Motion {
        let joints = self.joints();
        let standing = self.orientations(&joints);
        let mut builder = SkeletonBuilder::new();
        for joint in &joints {
            let parent_turn = joint.parent.map_or(Quat::IDENTITY, |p| standing[p]);
            let offset = parent_turn.conjugate() * joint.offset;
            let parent = joint.parent.map(JointId::new);
            match parent {
                Some(parent) if joint.is_end => {
                    builder.end_site(rename(&joint.name), parent, offset)
                }
                parent => builder.joint(rename(&joint.name), parent, offset),
            };
        }
        let skeleton: Arc<Skeleton> = Arc::new(builder.build().unwrap());
        let root = JointId::new(0);
        let mut motion = Motion::at_rest(skeleton, FRAMES, FrameTime::of_fps(10), [root]);
        let legs: Vec<usize> = [0, 1]
            .into_iter()
            .flat_map(|side| self.leg.iter().map(move |(name, _)| self.name(name, side)))
            .filter_map(|name| joints.iter().position(|joint| joint.name == name))
            .collect();
        let lowest = |motion: &Motion, frame: usize| {
            let pose = motion.pose(frame).to_global(motion.skeleton());
            let heights = legs.iter().map(|&joint| pose.positions[joint].y);
            heights.fold(f32::INFINITY, f32::min)
        };
        for frame in 0..FRAMES {
            motion.set_translation(frame, root, joints[0].offset);
            for (index, joint) in joints.iter().enumerate().filter(|(_, j)| !j.is_end) {
                let parent_turn = joint.parent.map_or(Quat::IDENTITY, |p| standing[p]);
                let turn = self.turn(&joint.name, frame);
                let local = parent_turn.conjugate() * turn * standing[index];
                motion.set_rotation(frame, JointId::new(index), local);
            }
            let sunk = lowest(&motion, STANDING) - lowest(&motion, frame);
            motion.set_translation(frame, root, joints[0].offset + Vec3::Y * sunk);
        }
        motion
    }

    /// World orientation of every joint in the standing posture: none, or X along the bone.
    fn orientations(&self, joints: &[Built]) -> Vec<Quat> {
        let along = |index: usize| {
            let child = joints.iter().find(|j| j.parent == Some(index));
            let bone = child.map_or(joints[index].offset, |child| child.offset);
            bone.try_normalize()
        };
        let turn = |index: usize| match along(index) {
            Some(bone) if self.is_flat => Quat::from_rotation_arc(Vec3::X, bone),
            _ => Quat::IDENTITY,
        };
        (0..joints.len()).map(turn).collect()
    }

    /// How a joint turns in a frame, in the world's axes of the standing posture.
    fn turn(&self, name: &str, frame: usize) -> Quat {
        let stride = frame.min(STRIDING) as f32 / STRIDING as f32;
        let crouch = frame.saturating_sub(STRIDING) as f32 / (CROUCHING - STRIDING) as f32;
        let stride = stride * (1.0 - crouch);
        let about_x = Quat::from_rotation_x;
        if name == self.trunk()[1] {
            return Quat::from_rotation_y(0.3 * stride) * about_x(0.5 * crouch);
        }
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let [hip, knee, ankle, shoulder, elbow, _] = self.landmarks(side);
            let turn = match name {
                _ if name == hip => about_x(-0.6 * sign * stride - 1.7 * crouch),
                _ if name == knee => about_x(0.7 * stride + 2.1 * crouch),
                _ if name == ankle => about_x(-0.4 * crouch),
                _ if name == shoulder => {
                    about_x(0.5 * sign * stride - 0.9 * crouch)
                        * Quat::from_rotation_z(-1.2 * sign * (stride + crouch))
                }
                _ if name == elbow => Quat::from_rotation_y(-0.6 * sign * (stride + crouch)),
                _ => continue,
            };
            return turn;
        }
        Quat::IDENTITY
    }
}

fn mirrored([x, y, z]: [f32; 3], side: usize) -> [f32; 3] {
    [if side == 0 { x } else { -x }, y, z]
}
