//! Which joints are a figure's legs, arms, trunk and head.

use glam::Vec3;

use crate::motion::Motion;
use crate::pose::{GlobalPose, LocalPose};
use crate::skeleton::{JointId, Skeleton};

use super::find;
use super::side::Side;

/// A leg or an arm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limb {
    /// Whose side.
    pub side: Side,
    /// Joints between the trunk and the upper bone: collar bones, extra hip joints.
    pub root: Vec<JointId>,
    /// Where the upper bone starts: hip or shoulder.
    pub upper: JointId,
    /// Knee or elbow.
    pub middle: JointId,
    /// Ankle or wrist.
    pub lower: JointId,
    /// The joint of the toes, if there is one with a length before it; for an arm the longest
    /// finger's.
    pub tip: Option<JointId>,
    /// The last joint of the limb.
    pub end: JointId,
}

/// How sure a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Certainty {
    /// Names, or lengths and angles alone, say so; the other says nothing or something else.
    Likely,
    /// Names say so, and lengths and angles agree.
    Sure,
}

/// Why a skeleton is not drawn and handled as a person's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum NoAnatomy {
    /// Nothing in it looks like two legs.
    #[error("no pair of legs was found")]
    NoLegs,
    /// It has more limbs than a person.
    #[error("it has more limbs than a person")]
    ManyLimbs,
    /// It stands on four legs.
    #[error("it stands on four legs")]
    FourLegs,
    /// It is named like a person, but its trunk is in pieces: no joint joins legs, arms and head.
    #[error("legs, arms and head hang from different roots")]
    InPieces,
    /// It has legs, but what leads from them to a head was not found.
    #[error("legs were found, but no head")]
    NoHead,
    /// Names and lengths contradict each other.
    #[error("the names of its joints do not match the lengths of its bones")]
    Contradiction,
}

impl NoAnatomy {
    /// Whether the skeleton may well be a person's that was not understood, rather than an
    /// animal, a machine or something else that is none.
    pub const fn is_doubt(self) -> bool {
        matches!(self, Self::InPieces | Self::NoHead | Self::Contradiction)
    }
}

/// The parts of a humanoid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Anatomy {
    /// Where the legs meet.
    pub pelvis: JointId,
    /// From the pelvis (excluded) to the joint before the head (included). It climbs first where the
    /// hierarchy does not begin at the pelvis.
    pub trunk: Vec<JointId>,
    /// How many of `trunk` lie above the pelvis in the hierarchy: the bone from such a joint leads
    /// down to the joint before it.
    pub climbed_count: usize,
    /// How many of `trunk` lie below the neck; the last of those (or the pelvis) carries the
    /// shoulders.
    pub spine_count: usize,
    /// The head's joint.
    pub head: JointId,
    /// Left and right leg.
    pub legs: [Limb; 2],
    /// Left and right arm; a figure may have none.
    pub arms: Option<[Limb; 2]>,
    /// How sure all of it is.
    pub certainty: Certainty,
}

/// The directions of a figure in one pose, world space: unit length, perpendicular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyAxes {
    /// The figure's own left.
    pub left: Vec3,
    /// Up along the trunk, made perpendicular to `left`.
    pub up: Vec3,
    /// Where it faces.
    pub forward: Vec3,
}

impl Anatomy {
    /// Finds the parts in a skeleton. `pose` says how long the bones are (where position channels
    /// replace OFFSETs the skeleton does not know) and, where names say nothing, what lies where.
    ///
    /// Cost: n log n in the number of joints.
    ///
    /// # Errors
    /// Why it is no humanoid, or why that is in doubt.
    ///
    /// # Panics
    /// If the pose does not have as many joints as the skeleton.
    pub fn find(skeleton: &Skeleton, pose: &GlobalPose) -> Result<Self, NoAnatomy> {
        assert_eq!(
            pose.joint_count(),
            skeleton.joint_count(),
            "a pose of this skeleton"
        );
        find::anatomy(skeleton, pose)
    }

    /// Finds the parts in the skeleton of a motion: in its rest pose with the bone lengths of its
    /// first frame, or, where that tells nothing or is no posture, in one of its frames.
    ///
    /// # Errors
    /// As [`Anatomy::find`].
    pub fn of_motion(motion: &Motion) -> Result<Self, NoAnatomy> {
        let skeleton = motion.skeleton();
        let frame_count = motion.frame_count();
        let mut local = LocalPose::rest(skeleton);
        if frame_count > 0 {
            local.translations = motion.pose(0).translations;
        }
        let rest = local.to_global(skeleton);
        let at_rest = Self::find(skeleton, &rest);
        let is_settled = match &at_rest {
            // Without names a rest pose that is no posture does not tell left from right.
            Ok(anatomy) => anatomy.certainty == Certainty::Sure || anatomy.stands(&rest),
            Err(reason) => matches!(reason, NoAnatomy::FourLegs | NoAnatomy::ManyLimbs),
        };
        if is_settled {
            return at_rest;
        }
        let in_frames = [0, frame_count / 2]
            .into_iter()
            .filter(|&frame| frame < frame_count)
            .map(|frame| motion.pose(frame).to_global(skeleton))
            .filter_map(|pose| Some((Self::find(skeleton, &pose).ok()?, pose)))
            .find(|(anatomy, pose)| at_rest.is_err() || anatomy.stands(pose));
        in_frames.map_or(at_rest, |(anatomy, _)| Ok(anatomy))
    }

    /// The figure's directions in a pose of its skeleton; `None` where its hips or its trunk have no
    /// extent.
    pub fn axes(&self, pose: &GlobalPose) -> Option<BodyAxes> {
        let at = |joint: JointId| pose.positions[joint.index()];
        let [left_leg, right_leg] = &self.legs;
        let left = (at(left_leg.upper) - at(right_leg.upper)).try_normalize()?;
        let rise = at(self.head) - at(self.pelvis);
        let up = (rise - left * rise.dot(left)).try_normalize()?;
        let forward = left.cross(up);
        Some(BodyAxes { left, up, forward })
    }

    /// Whether the figure stretches itself in the pose, as somebody who stands: its legs lead away
    /// from its trunk. Which way is up does not matter.
    pub fn stands(&self, pose: &GlobalPose) -> bool {
        let at = |joint: JointId| pose.positions[joint.index()];
        let [left_leg, right_leg] = &self.legs;
        let hips = (at(left_leg.upper) + at(right_leg.upper)) * 0.5;
        let trunk = (at(self.head) - hips).normalize_or_zero();
        let spine_is_straight = self
            .trunk
            .iter()
            .chain([&self.head])
            .fold((hips, true), |(before, is_straight), &joint| {
                let rise = (at(joint) - before).dot(trunk);
                let is_rising = rise > -1e-3 * (at(self.head) - hips).length();
                (at(joint), is_straight && is_rising)
            })
            .1;
        let leads_away =
            |from: Vec3, to: Vec3| (to - from).normalize_or_zero().dot(trunk) < -STRETCHED;
        spine_is_straight
            && self.legs.iter().all(|leg| {
                leads_away(at(leg.upper), at(leg.lower))
                    && leads_away(at(leg.middle), at(leg.lower))
            })
    }

    /// Left and right leg, then left and right arm.
    pub fn limbs(&self) -> impl Iterator<Item = &Limb> {
        self.legs.iter().chain(self.arms.iter().flatten())
    }

    /// Where the limb starts that a joint bends with: hip or shoulder, for the middle joint, the
    /// ankle or wrist, and what lies between; `None` for all else, fingers and toes too.
    pub fn limb_start(&self, skeleton: &Skeleton, joint: JointId) -> Option<JointId> {
        let limb = self.limbs().find(|limb| {
            std::iter::once(limb.lower)
                .chain(skeleton.ancestors(limb.lower))
                .take_while(|&above| above != limb.upper)
                .any(|above| above == joint)
        });
        limb.map(|limb| limb.upper)
    }

    /// The joint that the shoulders and the neck hang from.
    pub fn chest(&self) -> JointId {
        match self.spine_count.checked_sub(1) {
            Some(last) => self.trunk[last],
            None => self.pelvis,
        }
    }

    /// Where the neck begins: the first joint above the one that carries the shoulders; the head
    /// where no joint lies between.
    pub fn neck(&self) -> JointId {
        self.trunk
            .get(self.spine_count)
            .copied()
            .unwrap_or(self.head)
    }
}

/// Cosine up to which a leg leads away from a trunk.
const STRETCHED: f32 = 0.75;
