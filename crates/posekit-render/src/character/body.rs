//! A body of simple rigid shapes, fitted to a skeleton.
//!
//! A humanoid becomes an artist's mannequin: rounded blocks for the trunk, turned limbs with dark
//! joint balls, feet with soles, a head with a visor that shows where it faces. Proportions are
//! anthropometric (Drillis and Contini 1966, as Winter 2009 prints them), hung on the joints
//! where they are. Any other skeleton becomes links.

use posekit::skeleton::{JointId, Skeleton};

use crate::mesh::{MaterialId, Mesh, Shape};

use super::anatomy::{Anatomy, Side, side_of_joint};
use super::fitter::{Fitter, SEGMENTS};
use super::limbs::{add_arms, add_legs, has_fingers};
use super::links::links;
use super::proportions::Proportions;
use super::trunk::add_trunk;

/// A body for a skeleton of the given proportions.
///
/// # Panics
/// If the proportions are another skeleton's.
#[must_use]
pub fn body_mesh(skeleton: &Skeleton, proportions: &Proportions) -> Mesh {
    match Anatomy::find(skeleton, &proportions.reference) {
        Some(anatomy) => humanoid(skeleton, proportions, &anatomy),
        None => links(skeleton, proportions),
    }
}

fn humanoid(skeleton: &Skeleton, proportions: &Proportions, anatomy: &Anatomy) -> Mesh {
    let stature = proportions.stature;
    let mut fitter = Fitter::new(&proportions.reference);
    add_trunk(&mut fitter, anatomy, stature);
    add_legs(&mut fitter, anatomy, stature);
    add_arms(&mut fitter, skeleton, anatomy, stature);
    for joint in rest_of_body(skeleton, anatomy) {
        if proportions.loose[joint.index()] {
            continue;
        }
        add_extra(&mut fitter, skeleton, joint, stature);
    }
    fitter.finish()
}

/// The joints whose bone the mannequin's parts do not cover: fingers, tails, weapons.
fn rest_of_body(skeleton: &Skeleton, anatomy: &Anatomy) -> Vec<JointId> {
    let covered_below: Vec<JointId> = {
        let hands = anatomy.arms.iter().flatten().map(|arm| arm.lower);
        hands
            .filter(|&hand| !has_fingers(skeleton, hand))
            .chain(anatomy.legs.iter().map(|leg| leg.lower))
            .chain(std::iter::once(anatomy.head))
            .collect()
    };
    let limbs = anatomy.legs.iter().chain(anatomy.arms.iter().flatten());
    let mut covered: Vec<JointId> = limbs
        .flat_map(|limb| {
            limb.root
                .iter()
                .copied()
                .chain([limb.upper, limb.middle, limb.lower])
        })
        .chain(anatomy.trunk.iter().copied())
        .chain([anatomy.head, anatomy.pelvis])
        .collect();
    covered.extend(skeleton.ancestors(anatomy.pelvis));
    skeleton
        .joints()
        .filter(|&joint| {
            let hidden = skeleton
                .ancestors(joint)
                .any(|above| covered_below.contains(&above));
            !hidden && !covered.contains(&joint)
        })
        .collect()
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
