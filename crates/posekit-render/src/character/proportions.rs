//! What a body is fitted to: a neutral pose, the stature, which joints fly free.

use glam::Vec3;

use posekit::body::{Anatomy, Limb, NoAnatomy};
use posekit::motion::Motion;
use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton};

use super::hinges::hinge_axes;
use super::reference::reference_pose;

/// Hip to ankle over stature (Winter 2009, figure 4.1: 0.530 less 0.039, with the hip's centre a
/// little lower than the trochanter's tip).
const LEG_PER_STATURE: f32 = 0.475;

/// Hip to shoulder, level with each other, over stature (same figure: 0.818 less 0.530, from the
/// same hip's centre).
const TRUNK_PER_STATURE: f32 = 0.304;

/// Up to this share the two ways to measure a figure are one.
const USUAL: f32 = 0.12;

/// A bone whose ends move apart by more than this share of the stature is no bone.
const LOOSE: f32 = 0.03;
/// Frames that are looked at for loose bones.
const SAMPLES: usize = 48;

/// What a body is fitted to.
#[derive(Clone, Debug)]
pub struct Proportions {
    /// Which joints are a humanoid's landmarks, or why it is none or in doubt.
    pub anatomy: Result<Anatomy, NoAnatomy>,
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
        let anatomy = Anatomy::of_motion(motion);
        let reference = reference_pose(motion, anatomy.as_ref().ok());
        let stature = stature(anatomy.as_ref().ok(), &reference);
        let loose = loose_joints(motion, stature);
        Self {
            anatomy,
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
        let anatomy = Anatomy::find(skeleton, &reference);
        let stature = stature(anatomy.as_ref().ok(), &reference);
        Self {
            anatomy,
            reference,
            stature,
            loose: vec![false; skeleton.joint_count()],
            hinges: vec![None; skeleton.joint_count()],
        }
    }

    /// Why a body cannot be fitted although the skeleton may be a person's.
    #[must_use]
    pub fn doubt(&self) -> Option<NoAnatomy> {
        let reason = self.anatomy.as_ref().err().copied();
        reason.filter(|reason| reason.is_doubt())
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

fn stature(anatomy: Option<&Anatomy>, reference: &GlobalPose) -> f32 {
    let (low, high) = reference.bounds();
    let extent = (high - low).max_element();
    let stature = anatomy.map_or(extent, |anatomy| standing_height(anatomy, reference));
    if stature.is_finite() && stature > 0.0 {
        stature
    } else {
        1.0
    }
}

/// How tall a humanoid would stand: by its legs alone, as long as legs and trunk are a person's;
/// else by both.
fn standing_height(anatomy: &Anatomy, reference: &GlobalPose) -> f32 {
    let at = |joint: JointId| reference.positions[joint.index()];
    let length = |leg: &Limb| {
        at(leg.upper).distance(at(leg.middle)) + at(leg.middle).distance(at(leg.lower))
    };
    let [left, right] = &anatomy.legs;
    let legs = (length(left) + length(right)) * 0.5;
    let hips = (at(left.upper) + at(right.upper)) * 0.5;
    let shoulders = anatomy
        .arms
        .as_ref()
        .map(|[left, right]| (at(left.upper) + at(right.upper)) * 0.5);
    let trunk = shoulders.map_or(TRUNK_PER_STATURE * legs / LEG_PER_STATURE, |shoulders| {
        hips.distance(shoulders)
    });
    let by_legs = legs / LEG_PER_STATURE;
    let by_both = (legs + trunk) / (LEG_PER_STATURE + TRUNK_PER_STATURE);
    if (by_both / by_legs - 1.0).abs() < USUAL {
        by_legs
    } else {
        by_both
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
