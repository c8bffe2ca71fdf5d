//! The path of joints between two joints.

use super::{JointId, Skeleton};
use crate::pose::LocalPose;

/// The path of joints between two joints of one skeleton.
///
/// It climbs from the start joint to the common ancestor of both ends and goes down the other limb
/// to the end joint. When one end is an ancestor of the other, one of the two parts is that joint
/// alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    joints: Vec<JointId>,
    top: usize,
}

impl Chain {
    pub(super) fn between(skeleton: &Skeleton, start: JointId, end: JointId) -> Option<Self> {
        let mut up = vec![start];
        up.extend(skeleton.ancestors(start));
        let mut down = vec![end];
        down.extend(skeleton.ancestors(end));
        if up.last() != down.last() {
            return None;
        }
        // Both lists end at the root: what they share at the end is above the common ancestor.
        let shared = up
            .iter()
            .rev()
            .zip(down.iter().rev())
            .take_while(|(a, b)| a == b)
            .count();
        up.truncate(up.len() - shared + 1);
        down.truncate(down.len() - shared);
        let top = up.len() - 1;
        up.extend(down.into_iter().rev());
        Some(Self { joints: up, top })
    }

    /// The joints from start to end, both included.
    pub fn joints(&self) -> &[JointId] {
        &self.joints
    }

    /// The joint where the chain starts.
    pub fn start(&self) -> JointId {
        self.joints[0]
    }

    /// The joint where the chain ends.
    pub fn end(&self) -> JointId {
        self.joints[self.joints.len() - 1]
    }

    /// The common ancestor of both ends: the joint of the chain that is closest to the root.
    pub fn top(&self) -> JointId {
        self.joints[self.top]
    }

    /// The part that climbs, from the start to the common ancestor, both included.
    pub fn climbing(&self) -> &[JointId] {
        &self.joints[..=self.top]
    }

    /// The part that goes down, from the common ancestor to the end, both included.
    pub fn descending(&self) -> &[JointId] {
        &self.joints[self.top..]
    }

    /// Sum of the rest lengths of the chain's bones, in the file's unit: how far the end can get
    /// from the start with every joint free.
    pub fn rest_length(&self, skeleton: &Skeleton) -> f32 {
        let bones = self.joints.iter().filter(|&&joint| joint != self.top());
        bones.map(|&joint| skeleton.bone_length(joint)).sum()
    }

    /// The same sum with the lengths that the bones have in a pose: of a skeleton whose OFFSETs are all zero
    /// only the motion says how long they are.
    ///
    /// # Panics
    /// If the pose has fewer joints than the chain's skeleton.
    pub fn length_in(&self, pose: &LocalPose) -> f32 {
        let bones = self.joints.iter().filter(|&&joint| joint != self.top());
        bones
            .map(|joint| pose.translations[joint.index()].length())
            .sum()
    }
}
