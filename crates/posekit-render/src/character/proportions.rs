//! What a body is fitted to: a neutral pose, the stature, which joints fly free.

use glam::Vec3;

use posekit::motion::Motion;
use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton};

use super::anatomy::Anatomy;
use super::hinges::hinge_axes;
use super::reference::reference_pose;

/// Hip to ankle over stature (Winter 2009, figure 4.1: 0.530 less 0.039, with the hip's centre a
/// little lower than the trochanter's tip).
const LEG_PER_STATURE: f32 = 0.475;

/// A bone whose ends move apart by more than this share of the stature is no bone.
const LOOSE: f32 = 0.03;
/// Frames that are looked at for loose bones.
const SAMPLES: usize = 48;

/// What a body is fitted to.
#[derive(Clone, Debug)]
pub struct Proportions {
    /// A neutral standing pose, as far as the motion shows one.
    pub reference: GlobalPose,
    /// The figure's height in the file's unit: from the legs of a humanoid, else the reference
    /// pose's largest extent. Positive.
    pub stature: f32,
    /// Joints that move against their parent by more than a bone would: nothing is drawn between
    /// the two. Mostly the hips under a reference point that stays on the floor.
    pub loose: Vec<bool>,
    /// The unit axis of every joint that turns about one only, in the joint's space; `None` for one
    /// that turns freely or stands still.
    pub hinges: Vec<Option<Vec3>>,
}

impl Proportions {
    /// Those of a motion's skeleton.
    #[must_use]
    pub fn of(motion: &Motion) -> Self {
        let reference = reference_pose(motion);
        let stature = stature(motion.skeleton(), &reference);
        let loose = loose_joints(motion, stature);
        Self {
            reference,
            stature,
            loose,
            hinges: hinge_axes(motion),
        }
    }

    /// Those of a skeleton in its rest pose.
    #[must_use]
    pub fn at_rest(skeleton: &Skeleton) -> Self {
        let reference = GlobalPose::rest(skeleton);
        let stature = stature(skeleton, &reference);
        Self {
            reference,
            stature,
            loose: vec![false; skeleton.joint_count()],
            hinges: vec![None; skeleton.joint_count()],
        }
    }

    /// Whether a joint belongs to the figure: it is no point above a loose joint.
    #[must_use]
    pub fn is_part(&self, skeleton: &Skeleton, joint: JointId) -> bool {
        let above_loose = skeleton
            .subtree(joint)
            .any(|j| j != joint && self.loose[j.index()]);
        !above_loose
    }

    /// The bone from a joint's parent to it, in the parent's space; zero where there is none.
    pub(super) fn bones(&self, skeleton: &Skeleton) -> Vec<Vec3> {
        let mut bones = self.reference.to_local(skeleton).translations;
        for (bone, &is_loose) in bones.iter_mut().zip(&self.loose) {
            if is_loose {
                *bone = Vec3::ZERO;
            }
        }
        bones
    }
}

fn stature(skeleton: &Skeleton, reference: &GlobalPose) -> f32 {
    let (low, high) = reference.bounds();
    let extent = (high - low).max_element();
    let at = |joint: JointId| reference.positions[joint.index()];
    let by_legs = Anatomy::find(skeleton, reference).map(|anatomy| {
        let length = anatomy
            .legs
            .iter()
            .map(|leg| {
                at(leg.upper).distance(at(leg.middle)) + at(leg.middle).distance(at(leg.lower))
            })
            .sum::<f32>();
        length * 0.5 / LEG_PER_STATURE
    });
    let stature = by_legs.unwrap_or(extent);
    if stature.is_finite() && stature > 0.0 {
        stature
    } else {
        1.0
    }
}

fn loose_joints(motion: &Motion, stature: f32) -> Vec<bool> {
    let skeleton = motion.skeleton();
    let mut loose = vec![false; skeleton.joint_count()];
    let frames = motion.frame_count();
    let count = frames.min(SAMPLES);
    for &joint in motion.translated_joints() {
        if skeleton.parent(joint).is_none() || count == 0 {
            continue;
        }
        let first = motion.translation(0, joint);
        loose[joint.index()] = (0..count)
            .map(|i| motion.translation(i * frames / count, joint))
            .any(|t| t.distance(first) > LOOSE * stature);
    }
    loose
}
