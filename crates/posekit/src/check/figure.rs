//! What the checks need to know of a figure before they look at its motion: the joint that carries
//! it, how tall it is, and where its feet are.

use crate::body::{Foot, feet};
use crate::motion::{GlobalMotion, Motion};
use crate::skeleton::{JointId, Skeleton};

use super::statistics::median;

/// How many frames a property of the whole motion is measured on, spread evenly.
const SAMPLES: usize = 64;

/// A standing figure's height over the longest path between two of its free ends (fingertip to toe
/// in a humanoid): 0.71, 0.70 and 0.64 for three common capture skeletons. The path does not depend
/// on the pose, and files whose OFFSETs are no pose have it too.
const HEIGHT_OVER_LONGEST_PATH: f64 = 0.7;

/// What is known of the figure of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The joint that carries the figure: the first one below the first root that branches, or that
    /// root where nothing branches.
    pub root: JointId,
    /// An estimate of how tall it stands, in the file's unit, from the length of its limbs; 0 for a
    /// skeleton whose joints all coincide.
    pub height: f64,
    /// Its feet, in topological order; empty when it has none.
    pub feet: Vec<Foot>,
}

/// Finds the figure of a motion. `global` is the motion's forward kinematics.
pub fn figure(motion: &Motion, global: &GlobalMotion) -> Figure {
    let skeleton = motion.skeleton();
    let root = carrying_joint(skeleton);
    let height = HEIGHT_OVER_LONGEST_PATH * longest_path(motion);
    let feet = if height > 0.0 && motion.frame_count() > 0 {
        feet(motion, global, root, height)
    } else {
        Vec::new()
    };
    Figure { root, height, feet }
}

/// Some frames of a motion, spread evenly.
pub(super) fn sample_frames(frame_count: usize) -> impl Iterator<Item = usize> {
    let count = frame_count.min(SAMPLES);
    (0..count).map(move |sample| sample * frame_count / count)
}

pub(super) fn carrying_joint(skeleton: &Skeleton) -> JointId {
    let root = JointId::new(0);
    let mut joint = root;
    loop {
        match skeleton.children(joint) {
            [only] => joint = *only,
            [] => return root,
            _ => return joint,
        }
    }
}

/// The longest path between two free ends of the figure, with the median lengths that its bones have
/// in the motion; the longest limb where nothing branches. A bone above the first branch is on no
/// such path.
fn longest_path(motion: &Motion) -> f64 {
    let skeleton = motion.skeleton();
    let mut limb_below = vec![0.0_f64; skeleton.joint_count()];
    let mut longest_pair = 0.0_f64;
    for joint in skeleton.joints().rev() {
        let mut best = (0.0_f64, 0.0_f64);
        for &child in skeleton.children(joint) {
            let limb = limb_below[child.index()] + median_length(motion, child);
            if limb > best.0 {
                best = (limb, best.0);
            } else if limb > best.1 {
                best.1 = limb;
            }
        }
        limb_below[joint.index()] = best.0;
        if skeleton.children(joint).len() > 1 {
            longest_pair = longest_pair.max(best.0 + best.1);
        }
    }
    if longest_pair > 0.0 {
        longest_pair
    } else {
        limb_below.iter().copied().fold(0.0, f64::max)
    }
}

fn median_length(motion: &Motion, joint: JointId) -> f64 {
    if motion.frame_count() == 0 || motion.translated_joints().binary_search(&joint).is_err() {
        return f64::from(motion.skeleton().bone_length(joint));
    }
    let mut lengths: Vec<f64> = sample_frames(motion.frame_count())
        .map(|frame| f64::from(motion.translation(frame, joint).length()))
        .collect();
    median(&mut lengths)
}
