//! What the checks need to know of a figure before they look at its motion: the joint that carries
//! it, how tall it is, and where its feet are.

use crate::motion::{GlobalMotion, Motion};
use crate::skeleton::{JointId, Skeleton};

use super::statistics::median;

/// How many frames a property of the whole motion is measured on, spread evenly.
const SAMPLES: usize = 64;

/// A standing figure's height over the longest path between two of its free ends (fingertip to toe
/// in a humanoid): 0.71, 0.70 and 0.64 for three common capture skeletons. The path does not depend
/// on the pose, and files whose OFFSETs are no pose have it too.
const HEIGHT_OVER_LONGEST_PATH: f64 = 0.7;

/// Feet that were not found by name are the free ends that stay within this share of the figure's
/// height above the lowest one.
const LOWEST_ENDS_HEIGHTS: f64 = 0.12;

/// ... and are at least this share of the height below the joint that carries the figure.
const FEET_BELOW_ROOT_HEIGHTS: f64 = 0.25;

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

/// One foot: the joints that may touch the floor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Foot {
    /// From the ankle to the toes' ends, in topological order; not empty.
    pub joints: Vec<JointId>,
}

impl Foot {
    /// The joint that the foot begins with.
    pub fn base(&self) -> JointId {
        self.joints[0]
    }
}

/// Finds the figure of a motion. `global` is the motion's forward kinematics.
pub fn figure(motion: &Motion, global: &GlobalMotion) -> Figure {
    let skeleton = motion.skeleton();
    let root = carrying_joint(skeleton);
    let height = HEIGHT_OVER_LONGEST_PATH * longest_path(motion);
    let mut figure = Figure {
        root,
        height,
        feet: Vec::new(),
    };
    if height > 0.0 && motion.frame_count() > 0 {
        figure.feet = feet_by_name(skeleton);
        if !stand_low(&figure, global) {
            figure.feet = feet_by_geometry(&figure, global);
        }
    }
    figure
}

/// Some frames of a motion, spread evenly.
pub(super) fn sample_frames(frame_count: usize) -> impl Iterator<Item = usize> {
    let count = frame_count.min(SAMPLES);
    (0..count).map(move |sample| sample * frame_count / count)
}

fn carrying_joint(skeleton: &Skeleton) -> JointId {
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

/// The joints whose names say foot, with all that hangs from them.
fn feet_by_name(skeleton: &Skeleton) -> Vec<Foot> {
    let named: Vec<bool> = skeleton
        .joints()
        .map(|joint| !skeleton.is_end_site(joint) && says_foot(skeleton.name(joint)))
        .collect();
    skeleton
        .joints()
        .filter(|joint| named[joint.index()])
        .filter(|&joint| {
            !skeleton
                .ancestors(joint)
                .any(|ancestor| named[ancestor.index()])
        })
        .map(|joint| Foot {
            joints: skeleton.subtree(joint).collect(),
        })
        .collect()
}

fn says_foot(name: &str) -> bool {
    const FOOT_WORDS: [&str; 4] = ["foot", "ankle", "toe", "heel"];
    /// Joints of rigs that steer a foot and are none.
    const CONTROL_WORDS: [&str; 5] = ["ik", "target", "ctrl", "control", "pole"];
    let lower = name.to_lowercase();
    let is_control = lower
        .split(|c: char| !c.is_alphanumeric())
        .any(|word| CONTROL_WORDS.contains(&word));
    !is_control && FOOT_WORDS.iter().any(|word| lower.contains(word))
}

/// Whether the feet are the lower part of the figure, most of the time.
fn stand_low(figure: &Figure, global: &GlobalMotion) -> bool {
    !figure.feet.is_empty()
        && figure.feet.iter().all(|foot| {
            median_drop(figure, global, foot.base()) > FEET_BELOW_ROOT_HEIGHTS * figure.height
        })
}

/// How far a joint is below the one that carries the figure, in the median.
fn median_drop(figure: &Figure, global: &GlobalMotion, joint: JointId) -> f64 {
    let drop = |frame| global.position(frame, figure.root).y - global.position(frame, joint).y;
    let mut drops: Vec<f64> = sample_frames(global.frame_count())
        .map(|frame| f64::from(drop(frame)))
        .collect();
    median(&mut drops)
}

/// The lowest free ends, with the joint before them.
fn feet_by_geometry(figure: &Figure, global: &GlobalMotion) -> Vec<Foot> {
    let skeleton = global.skeleton();
    let ends: Vec<(JointId, f64)> = skeleton
        .subtree(figure.root)
        .filter(|&joint| skeleton.children(joint).is_empty())
        .map(|joint| (joint, median_drop(figure, global, joint)))
        .collect();
    let lowest = ends.iter().map(|end| end.1).fold(0.0, f64::max);
    let enough =
        (lowest - LOWEST_ENDS_HEIGHTS * figure.height).max(FEET_BELOW_ROOT_HEIGHTS * figure.height);
    let mut bases: Vec<JointId> = ends
        .iter()
        .filter(|end| end.1 > enough)
        .map(|end| foot_base(skeleton, end.0))
        .collect();
    bases.sort_unstable();
    bases.dedup();
    bases
        .into_iter()
        .map(|joint| Foot {
            joints: skeleton.subtree(joint).collect(),
        })
        .collect()
}

/// The joint that a free end's last link hangs from, past an End Site; the end itself when that
/// joint belongs to several limbs.
fn foot_base(skeleton: &Skeleton, end: JointId) -> JointId {
    match skeleton.parent(end) {
        Some(parent)
            if skeleton.children(parent).len() == 1 && skeleton.parent(parent).is_some() =>
        {
            parent
        }
        _ => end,
    }
}
