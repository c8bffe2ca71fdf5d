//! What is known of each joint before parts of a body are looked for.

use glam::Vec3;

use crate::pose::GlobalPose;
use crate::skeleton::{JointId, Skeleton};

use super::name::{Part, Reading, read};
use super::side::sides;

/// What is known of each joint.
pub(super) struct Tree<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) pose: &'a GlobalPose,
    pub(super) readings: Vec<Reading>,
    pub(super) depths: Vec<u32>,
    /// The longest way down from each joint, through what may be a body's bones.
    pub(super) reach: Vec<f32>,
    /// The child that it begins with.
    pub(super) main_child: Vec<Option<JointId>>,
    /// The longest way down of all.
    pub(super) longest: f32,
}

impl<'a> Tree<'a> {
    pub(super) fn new(skeleton: &'a Skeleton, pose: &'a GlobalPose) -> Self {
        let sides = sides(skeleton);
        let mut has_side: Vec<bool> = sides.iter().map(Option::is_some).collect();
        for pair in skeleton.symmetric_pairs() {
            has_side[pair.left.index()] = true;
            has_side[pair.right.index()] = true;
        }
        let count = skeleton.joint_count();
        let mut readings: Vec<Reading> = Vec::with_capacity(count);
        let mut depths: Vec<u32> = Vec::with_capacity(count);
        for joint in skeleton.joints() {
            let reading = read(skeleton.name(joint), has_side[joint.index()]);
            readings.push(reading);
            let parent = skeleton.parent(joint);
            depths.push(parent.map_or(0, |parent| depths[parent.index()] + 1));
        }
        let mut tree = Self {
            skeleton,
            pose,
            readings,
            depths,
            reach: vec![0.0; count],
            main_child: vec![None; count],
            longest: 0.0,
        };
        tree.measure();
        tree
    }

    fn measure(&mut self) {
        for joint in self.skeleton.joints().rev() {
            let reading = self.readings[joint.index()];
            self.longest = self.longest.max(self.reach[joint.index()]);
            let Some(parent) = self.skeleton.parent(joint) else {
                continue;
            };
            if reading.is_control || reading.part == Some(Part::Face) {
                continue;
            }
            let is_side_branch = reading.is_twist && self.main_child[joint.index()].is_none();
            let length = self.reach[joint.index()] + self.length(joint);
            let best = self.main_child[parent.index()];
            let is_better = best.is_none() || length >= self.reach[parent.index()];
            if is_better && !(is_side_branch && best.is_some()) {
                self.reach[parent.index()] = length;
                self.main_child[parent.index()] = Some(joint);
            }
        }
    }

    pub(super) fn at(&self, joint: JointId) -> Vec3 {
        self.pose.positions[joint.index()]
    }

    /// From the joint's parent to it.
    pub(super) fn length(&self, joint: JointId) -> f32 {
        let parent = self.skeleton.parent(joint);
        parent.map_or(0.0, |parent| self.at(parent).distance(self.at(joint)))
    }

    pub(super) fn part(&self, joint: JointId) -> Option<Part> {
        self.readings[joint.index()].bone()
    }

    /// The joint and what the longest way down from it leads through.
    pub(super) fn main_path(&self, joint: JointId) -> impl Iterator<Item = JointId> + '_ {
        std::iter::successors(Some(joint), |&at| self.main_child[at.index()])
    }

    /// The lowest joint above both, or one of them.
    pub(super) fn meeting(&self, a: JointId, b: JointId) -> Option<JointId> {
        let (mut a, mut b) = (a, b);
        while a != b {
            if self.depths[a.index()] >= self.depths[b.index()] {
                a = self.skeleton.parent(a)?;
            } else {
                b = self.skeleton.parent(b)?;
            }
        }
        Some(a)
    }

    /// From `top` (excluded) down to `joint` (included).
    pub(super) fn path_down(&self, top: JointId, joint: JointId) -> Vec<JointId> {
        let mut path: Vec<JointId> = std::iter::once(joint)
            .chain(self.skeleton.ancestors(joint))
            .take_while(|&j| j != top)
            .collect();
        path.reverse();
        path
    }
}
