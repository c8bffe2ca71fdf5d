//! The feet of a figure: what may stand on the floor.

use crate::motion::{GlobalMotion, Motion};
use crate::skeleton::{JointId, Skeleton};

use super::anatomy::Anatomy;
use super::name::{Part, read};

/// How many frames are looked at, spread evenly.
const SAMPLES: usize = 64;

/// Feet that were not found by name are the free ends that stay within this share of the figure's
/// height above the lowest one.
const LOWEST_ENDS_HEIGHTS: f64 = 0.12;

/// ... and are at least this share of the height below the joint that carries the figure.
const FEET_BELOW_ROOT_HEIGHTS: f64 = 0.25;

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

    /// The foot's joint that is lowest in a frame; the first of several.
    pub fn lowest(&self, global: &GlobalMotion, frame: usize) -> JointId {
        let height = |joint: &JointId| global.position(frame, *joint).y;
        let lowest = self
            .joints
            .iter()
            .min_by(|a, b| height(a).total_cmp(&height(b)));
        lowest.copied().unwrap_or(self.base())
    }

    fn from_base(skeleton: &Skeleton, base: JointId) -> Self {
        Self {
            joints: skeleton.subtree(base).collect(),
        }
    }
}

/// The feet of a motion's figure, in topological order; empty when it has none.
///
/// A humanoid's are what hangs from its ankles. Of others they are the joints whose names say foot or,
/// where those are not low, the lowest free ends. `root` is the joint that carries the figure, `height`
/// how tall it stands in the file's unit, `global` the motion's forward kinematics.
pub fn feet(motion: &Motion, global: &GlobalMotion, root: JointId, height: f64) -> Vec<Foot> {
    let skeleton = motion.skeleton();
    let ankles = Anatomy::of_motion(motion)
        .map(|anatomy| anatomy.legs.map(|leg| leg.lower))
        .ok();
    let figure = Figure {
        global,
        root,
        height,
    };
    let mut bases: Vec<JointId> = match ankles {
        Some(ankles) => ankles.to_vec(),
        None => named_bases(skeleton),
    };
    if !figure.stand_low(&bases) {
        bases = figure.lowest_bases();
    }
    bases.sort_unstable();
    bases
        .into_iter()
        .map(|base| Foot::from_base(skeleton, base))
        .collect()
}

/// The highest joints whose names say foot.
fn named_bases(skeleton: &Skeleton) -> Vec<JointId> {
    let mut in_foot = vec![false; skeleton.joint_count()];
    let mut bases = Vec::new();
    for joint in skeleton.joints() {
        let is_foot = || {
            let part = read(skeleton.name(joint), true).bone();
            matches!(part, Some(Part::Foot | Part::Ankle | Part::Toe))
        };
        let is_below = skeleton
            .parent(joint)
            .is_some_and(|parent| in_foot[parent.index()]);
        let is_base = !is_below && !skeleton.is_end_site(joint) && is_foot();
        in_foot[joint.index()] = is_below || is_base;
        if is_base {
            bases.push(joint);
        }
    }
    bases
}

/// What is known of the figure.
struct Figure<'a> {
    global: &'a GlobalMotion,
    root: JointId,
    height: f64,
}

impl Figure<'_> {
    /// Whether the feet are the lower part of the figure, most of the time.
    fn stand_low(&self, bases: &[JointId]) -> bool {
        !bases.is_empty()
            && bases
                .iter()
                .all(|&base| self.median_drop(base) > FEET_BELOW_ROOT_HEIGHTS * self.height)
    }

    /// How far a joint is below the one that carries the figure, in the median.
    fn median_drop(&self, joint: JointId) -> f64 {
        let frames = self.global.frame_count();
        let count = frames.min(SAMPLES);
        let height = |frame, joint| f64::from(self.global.position(frame, joint).y);
        let mut drops: Vec<f64> = (0..count)
            .map(|sample| sample * frames / count)
            .map(|frame| height(frame, self.root) - height(frame, joint))
            .collect();
        if drops.is_empty() {
            return 0.0;
        }
        let middle = drops.len() / 2;
        *drops.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Where the lowest free ends begin.
    fn lowest_bases(&self) -> Vec<JointId> {
        let skeleton = self.global.skeleton();
        let ends: Vec<(JointId, f64)> = skeleton
            .subtree(self.root)
            .filter(|&joint| skeleton.children(joint).is_empty())
            .map(|joint| (joint, self.median_drop(joint)))
            .collect();
        let lowest = ends.iter().map(|end| end.1).fold(0.0, f64::max);
        let enough =
            (lowest - LOWEST_ENDS_HEIGHTS * self.height).max(FEET_BELOW_ROOT_HEIGHTS * self.height);
        let mut bases: Vec<JointId> = ends
            .iter()
            .filter(|end| end.1 > enough)
            .map(|end| foot_base(skeleton, end.0))
            .collect();
        bases.sort_unstable();
        bases.dedup();
        bases
    }
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
