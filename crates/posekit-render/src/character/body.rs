//! A body of simple rigid shapes, fitted to a skeleton.
//!
//! A humanoid becomes an artist's mannequin: rounded blocks for the trunk, turned limbs with dark
//! joint balls, feet with soles, a head with a visor that shows where it faces. Proportions are
//! anthropometric (Drillis and Contini 1966, as Winter 2009 prints them), hung on the joints
//! where they are. A skeleton that may be a person's but was not understood is drawn as bones, any
//! other one as links.

use posekit::body::{Anatomy, Side, side_of_joint};
use posekit::skeleton::{JointId, Skeleton};

use crate::mesh::{MaterialId, Mesh, Shape};

use super::bones::{MOST_BODY_JOINTS, bone_mesh};
use super::fitter::{Fitter, Mannequin, SEGMENTS};
use super::limbs::{add_arms, add_legs, has_fingers};
use super::links::links;
use super::proportions::Proportions;
use super::trunk::add_trunk;

/// A body for a skeleton of the given proportions; of more than [`MOST_BODY_JOINTS`] joints its bones.
///
/// # Panics
/// If the proportions are another skeleton's.
#[must_use]
pub fn body_mesh(skeleton: &Skeleton, proportions: &Proportions) -> Mesh {
    if skeleton.joint_count() > MOST_BODY_JOINTS {
        return bone_mesh(skeleton, proportions);
    }
    match &proportions.anatomy {
        Ok(anatomy) => match anatomy.axes(&proportions.reference) {
            Some(axes) => humanoid(
                skeleton,
                proportions,
                Mannequin {
                    anatomy,
                    axes,
                    stature: proportions.stature,
                },
            ),
            None => bone_mesh(skeleton, proportions),
        },
        Err(reason) if reason.is_doubt() => bone_mesh(skeleton, proportions),
        Err(_) => links(skeleton, proportions),
    }
}

fn humanoid(skeleton: &Skeleton, proportions: &Proportions, figure: Mannequin<'_>) -> Mesh {
    let mut fitter = Fitter::new(&proportions.reference);
    add_trunk(&mut fitter, skeleton, &figure);
    add_legs(&mut fitter, &figure);
    add_arms(&mut fitter, skeleton, &figure);
    for joint in rest_of_body(skeleton, figure.anatomy) {
        if proportions.loose[joint.index()] {
            continue;
        }
        add_extra(&mut fitter, skeleton, joint, figure.stature);
    }
    fitter.finish()
}

/// The joints whose bone the mannequin's parts do not cover: fingers, tails, weapons.
fn rest_of_body(skeleton: &Skeleton, anatomy: &Anatomy) -> Vec<JointId> {
    let mut covered = vec![false; skeleton.joint_count()];
    let mut cover = |joint: JointId| covered[joint.index()] = true;
    for limb in anatomy.limbs() {
        let parent = skeleton.parent(limb.root.first().copied().unwrap_or(limb.upper));
        // From the trunk to the ankle or wrist, twist joints on the way included.
        std::iter::once(limb.lower)
            .chain(skeleton.ancestors(limb.lower))
            .take_while(|&joint| Some(joint) != parent)
            .for_each(&mut cover);
    }
    anatomy.trunk.iter().copied().for_each(&mut cover);
    std::iter::once(anatomy.head)
        .chain(skeleton.ancestors(anatomy.head))
        .chain([anatomy.pelvis])
        .chain(skeleton.ancestors(anatomy.pelvis))
        .for_each(&mut cover);
    // Feet, heads and hands without fingers cover what hangs from them.
    let mut hides = vec![false; skeleton.joint_count()];
    let hands = anatomy.arms.iter().flatten().map(|arm| arm.lower);
    let whole = hands
        .filter(|&hand| !has_fingers(skeleton, hand))
        .chain(anatomy.legs.iter().map(|leg| leg.lower))
        .chain([anatomy.head]);
    whole.for_each(|joint| hides[joint.index()] = true);
    for joint in skeleton.joints() {
        let is_hidden = skeleton
            .parent(joint)
            .is_some_and(|parent| hides[parent.index()]);
        hides[joint.index()] |= is_hidden;
        covered[joint.index()] |= is_hidden;
    }
    let hangs = hangs_from_body(skeleton, anatomy);
    skeleton
        .joints()
        .filter(|joint| !covered[joint.index()] && hangs[joint.index()])
        .collect()
}

/// Which joints are below one of the body. What hangs beside it, from a root on the floor, moves a rig
/// (targets for hands and feet) and is no flesh.
fn hangs_from_body(skeleton: &Skeleton, anatomy: &Anatomy) -> Vec<bool> {
    let mut hangs = vec![false; skeleton.joint_count()];
    std::iter::once(anatomy.pelvis)
        .chain(anatomy.trunk.iter().copied())
        .chain([anatomy.head])
        .chain(anatomy.limbs().map(|limb| limb.upper))
        .for_each(|joint| hangs[joint.index()] = true);
    for joint in skeleton.joints() {
        let parent = skeleton.parent(joint);
        hangs[joint.index()] |= parent.is_some_and(|parent| hangs[parent.index()]);
    }
    hangs
}

fn add_extra(fitter: &mut Fitter<'_>, skeleton: &Skeleton, joint: JointId, stature: f32) {
    let Some(parent) = skeleton.parent(joint) else {
        return;
    };
    let (from, to) = (fitter.at(parent), fitter.at(joint));
    let length = from.distance(to);
    if length < 0.004 * stature {
        return;
    }
    let radius = (length * 0.2).clamp(0.0055 * stature, 0.012 * stature);
    let material = side_material(skeleton, joint);
    let shape = Shape::tapered_capsule(from, radius, to, radius * 0.85, SEGMENTS / 2);
    fitter.add(parent, shape, material);
}

pub(super) fn side_material(skeleton: &Skeleton, joint: JointId) -> MaterialId {
    match side_of_joint(skeleton, joint) {
        Some(Side::Left) => MaterialId::Left,
        Some(Side::Right) => MaterialId::Right,
        None => MaterialId::Base,
    }
}
