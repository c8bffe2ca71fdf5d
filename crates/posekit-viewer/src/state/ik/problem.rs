//! From what is asked in the window to a problem of the library.

use std::sync::Arc;

use posekit::body::Anatomy;
use posekit::ik::{Base, IkProblem, IkTarget, JointLimits, Movable, StartJoint, TraceDetail};
use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::bvh::Bvh;
use posekit_formats::bvh::edit::joint_limit;

use super::{Goals, IkSettings, Pin, Start, Target};
use crate::state::edit::freedom;

/// What a problem is made of.
#[derive(Clone, Copy, Debug)]
pub struct ProblemParts<'a> {
    /// The skeleton.
    pub skeleton: &'a Skeleton,
    /// The document, whose channels say which way joints can turn.
    pub document: &'a Bvh,
    /// Where the effector should be.
    pub target: &'a Target,
    /// Whether it should be turned so, too.
    pub is_oriented: bool,
    /// The pins, where they are at this frame.
    pub pins: &'a [Pin],
    /// How it is solved.
    pub settings: &'a IkSettings,
    /// The joint limits.
    pub limits: &'a Arc<JointLimits>,
}

/// Where the limb of a joint starts: a person's arm at the shoulder and leg at the hip, for what hangs
/// no farther out than the wrist or ankle; else the highest joint over it that has no sibling limb
/// between. `None` for a root, which is no limb's.
#[must_use]
pub fn auto_start(skeleton: &Skeleton, effector: JointId) -> Option<JointId> {
    let anatomy = Anatomy::find(skeleton, &GlobalPose::rest(skeleton)).ok();
    let limb_start = anatomy.and_then(|anatomy| anatomy.limb_start(skeleton, effector));
    if limb_start.is_some() {
        return limb_start;
    }
    let mut start = skeleton.parent(effector)?;
    while let Some(above) = skeleton
        .parent(start)
        .filter(|&above| !forks(skeleton, above))
    {
        start = above;
    }
    Some(start)
}

/// The joints from the start to the effector, both included; empty where the whole figure moves or
/// there is no way between them.
///
/// A limb that would start at a root right over the effector has no joint that may turn: a pelvis under
/// a reference point is dragged with the whole figure.
#[must_use]
pub fn chain_joints(skeleton: &Skeleton, effector: JointId, start: Start) -> Vec<JointId> {
    let start = match start {
        Start::Limb => auto_start(skeleton, effector).filter(|&top| {
            skeleton.parent(top).is_some() || skeleton.parent(effector) != Some(top)
        }),
        Start::Joint(joint) => Some(joint).filter(|joint| joint.index() < skeleton.joint_count()),
        Start::Body => None,
    };
    let chain = start
        .filter(|&start| start != effector)
        .and_then(|start| skeleton.chain(start, effector));
    chain.map_or_else(Vec::new, |chain| chain.joints().to_vec())
}

/// The problem, and the length that its residuals are shares of.
#[must_use]
pub fn problem(parts: &ProblemParts<'_>) -> (IkProblem, f32) {
    let skeleton = parts.skeleton;
    let effector = parts.target.joint;
    let mut target = IkTarget::position(effector, parts.target.position.as_dvec3());
    if parts.is_oriented {
        target = target.with_orientation(parts.target.orientation.as_dquat().normalize());
    }
    let pins = parts.pins.iter().filter(|pin| pin.joint != effector);
    let pins: Vec<IkTarget> = pins.map(pin_target).collect();
    let joints = chain_joints(skeleton, effector, parts.settings.start);
    let chain = match (joints.first(), joints.last()) {
        (Some(&start), Some(&end)) => skeleton.chain(start, end),
        _ => None,
    };
    let (mut problem, reach) = match chain {
        Some(chain) => {
            let start = StartJoint::suited_to(skeleton, &chain);
            let mut problem = IkProblem::for_target(skeleton, &chain, start, target);
            add_limbs_of_pins(skeleton, &mut problem, &pins);
            (problem, chain.rest_length(skeleton))
        }
        None => {
            // Hips that are dragged keep facing where they do: the limbs give.
            if is_trunk(skeleton, effector) {
                let orientation = parts.target.orientation.as_dquat().normalize();
                target = target.with_orientation(orientation);
            }
            let problem = IkProblem::for_whole_body(skeleton, vec![target]);
            (problem, skeleton.height())
        }
    };
    problem.targets.extend(pins);
    let root_moves = skeleton
        .roots()
        .all(|root| freedom(parts.document, root).moves);
    if !root_moves {
        // The file has nowhere to write a root that moves.
        problem.base = Base::Root;
    }
    problem.limits = Arc::clone(parts.limits);
    problem.stop.position_tolerance = parts.settings.tolerance * f64::from(reach);
    problem.stop.max_iterations = parts.settings.iterations;
    problem.trace = TraceDetail::None;
    (problem, reach)
}

/// Whether several limbs hang from a joint, or the whole figure does.
fn is_trunk(skeleton: &Skeleton, joint: JointId) -> bool {
    skeleton.parent(joint).is_none() || forks(skeleton, joint)
}

/// Whether several limbs hang from a joint.
fn forks(skeleton: &Skeleton, joint: JointId) -> bool {
    let children = skeleton.children(joint).iter();
    let limbs = children.filter(|&&child| !skeleton.is_end_site(child));
    limbs.count() > 1
}

fn pin_target(pin: &Pin) -> IkTarget {
    let target = IkTarget::position(pin.joint, pin.position.as_dvec3());
    match pin.orientation {
        Some(orientation) => target.with_orientation(orientation.as_dquat().normalize()),
        None => target,
    }
}

/// A pinned joint can only stay where it is if its own limb is free to move.
fn add_limbs_of_pins(skeleton: &Skeleton, problem: &mut IkProblem, pins: &[IkTarget]) {
    let Movable::Joints(movable) = &mut problem.movable else {
        return;
    };
    for pin in pins {
        for joint in chain_joints(skeleton, pin.effector, Start::Limb) {
            let is_end = joint == pin.effector && pin.orientation_in_world.is_none();
            if !is_end && !movable.contains(&joint) {
                movable.push(joint);
            }
        }
    }
}

/// Joints turn as far as their channels can say.
#[must_use]
pub fn channel_limits(document: &Bvh) -> JointLimits {
    let mut limits = JointLimits::default();
    for (index, joint) in document.joints.iter().enumerate() {
        if !joint.is_end_site {
            // Without a limit it is free: what its channels cannot say is not written.
            limits
                .set_limit(JointId::new(index), joint_limit(joint))
                .ok();
        }
    }
    limits
}

/// The ankles and the wrists of a figure that looks like a human's.
#[must_use]
pub fn feet_and_hands(
    skeleton: &Skeleton,
    pose: &GlobalPose,
) -> Option<([JointId; 2], Option<[JointId; 2]>)> {
    let anatomy = Anatomy::find(skeleton, &GlobalPose::rest(skeleton))
        .or_else(|_| Anatomy::find(skeleton, pose))
        .ok()?;
    let feet = [anatomy.legs[0].lower, anatomy.legs[1].lower];
    let hands = anatomy.arms.map(|arms| [arms[0].lower, arms[1].lower]);
    Some((feet, hands))
}

impl Goals {
    /// What is held at a frame, where it is held there: pins that were set at another frame hold
    /// their joints where `pose` has them.
    #[must_use]
    pub fn pins_at(&self, frame: usize, pose: &GlobalPose) -> Vec<Pin> {
        let pins = self.pins.iter().copied();
        let pins = pins.filter(|pin| pin.joint.index() < pose.joint_count());
        pins.map(|pin| {
            if pin.frame == frame {
                pin
            } else {
                Pin {
                    frame,
                    position: pose.positions[pin.joint.index()],
                    orientation: pin
                        .orientation
                        .map(|_| pose.orientations[pin.joint.index()]),
                    ..pin
                }
            }
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use posekit::skeleton::SkeletonBuilder;

    use super::*;

    #[test]
    fn a_limb_starts_below_the_fork() {
        let mut builder = SkeletonBuilder::new();
        let hips = builder.joint("Hips", None, Vec3::ZERO);
        let spine = builder.joint("Spine", Some(hips), Vec3::Y);
        let leg = builder.joint("Leg", Some(hips), -Vec3::Y);
        let foot = builder.end_site("Foot", leg, -Vec3::Y);
        let collar = builder.joint("Collar", Some(spine), Vec3::X);
        let neck = builder.joint("Neck", Some(spine), Vec3::Y);
        let arm = builder.joint("Arm", Some(collar), Vec3::X);
        let hand = builder.end_site("Hand", arm, Vec3::X);
        let skeleton = builder.build().expect("a valid skeleton");
        assert_eq!(auto_start(&skeleton, hand), Some(collar));
        assert_eq!(auto_start(&skeleton, foot), Some(leg));
        assert_eq!(auto_start(&skeleton, neck), Some(spine));
        assert_eq!(auto_start(&skeleton, hips), None);
        let chain = chain_joints(&skeleton, hand, Start::Limb);
        assert_eq!(chain, vec![collar, arm, hand]);
        let over = chain_joints(&skeleton, hand, Start::Joint(foot));
        assert_eq!(over, vec![foot, leg, hips, spine, collar, arm, hand]);
        assert!(chain_joints(&skeleton, hand, Start::Body).is_empty());
        assert!(
            chain_joints(&skeleton, spine, Start::Limb).is_empty(),
            "nothing would turn"
        );
        assert!(chain_joints(&skeleton, hand, Start::Joint(hand)).is_empty());
    }
}
