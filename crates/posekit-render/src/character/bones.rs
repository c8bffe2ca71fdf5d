//! Skeletons drawn as what they are: tapered bones with joint balls, and the axes of joints.

use glam::Vec3;

use posekit::body::{Side, side_of_joint};
use posekit::skeleton::Skeleton;

use super::proportions::Proportions;
use crate::mesh::{ContactBall, MaterialId, Mesh, Shape};

/// Slices of round bones.
const SEGMENTS: usize = 14;

/// More joints than this are drawn as bones: a body has hundreds of corners for each, and nobody has so many.
pub const MOST_BODY_JOINTS: usize = 2000;

/// Slices where there are more joints than a body has: thousands of them are too small to be seen as round, and their
/// corners would fill the memory.
const COARSE_SEGMENTS: usize = 5;

/// How many slices round parts have, `usual` ones unless there are very many joints.
fn segments(skeleton: &Skeleton, usual: usize) -> usize {
    match skeleton.joint_count() > MOST_BODY_JOINTS {
        true => COARSE_SEGMENTS,
        false => usual,
    }
}

/// A mesh of tapered round bones with a ball at every joint.
///
/// # Panics
/// If the proportions are another skeleton's.
#[must_use]
pub fn bone_mesh(skeleton: &Skeleton, proportions: &Proportions) -> Mesh {
    let translations = proportions.bones(skeleton);
    let scale = proportions.stature;
    let segments = segments(skeleton, SEGMENTS);
    let mut mesh = Mesh::default();
    let least = scale * 0.0045;
    let ball_of = |length: f32| (length * 0.085).clamp(least, scale * 0.016);
    for joint in skeleton.joints() {
        let index = joint.index();
        let longest = skeleton
            .children(joint)
            .iter()
            .map(|child| translations[child.index()].length())
            .fold(0.0, f32::max);
        let own = translations[index].length();
        // A short bone after a long one shall not lose its joint.
        let radius = ball_of(longest.max(own * 0.6));
        if own > scale * 1e-3 || longest > scale * 1e-3 {
            mesh.add(
                &Shape::ball(Vec3::ZERO, radius, segments),
                index,
                MaterialId::Accent,
            );
            add_contact(&mut mesh, index, Vec3::ZERO, radius);
        }
        for child in skeleton.children(joint) {
            let end = translations[child.index()];
            let length = end.length();
            if length <= scale * 1e-3 {
                continue;
            }
            let thick = ball_of(length) * 0.95;
            let waist = end * 0.16;
            mesh.add(
                &Shape::tapered_capsule(waist, thick, end, thick * 0.38, segments),
                index,
                MaterialId::Base,
            );
            mesh.add(
                &Shape::tapered_capsule(Vec3::ZERO, thick * 0.45, waist, thick, segments),
                index,
                MaterialId::Base,
            );
            add_contact(&mut mesh, index, end * 0.5, thick);
        }
    }
    mesh
}

pub(super) fn add_contact(mesh: &mut Mesh, joint: usize, center: Vec3, radius: f32) {
    let joint = u32::try_from(joint).unwrap_or(u32::MAX);
    mesh.contact_balls.push(ContactBall {
        joint,
        center,
        radius,
    });
}

/// A mesh of octahedral bones with small joint balls.
///
/// # Panics
/// If the proportions are another skeleton's.
#[must_use]
pub fn octahedron_mesh(skeleton: &Skeleton, proportions: &Proportions) -> Mesh {
    let translations = proportions.bones(skeleton);
    let scale = proportions.stature;
    let segments = segments(skeleton, SEGMENTS);
    let mut mesh = Mesh::default();
    for joint in skeleton
        .joints()
        .filter(|&j| proportions.is_part(skeleton, j))
    {
        let index = joint.index();
        let mut radius = scale * 0.004;
        for child in skeleton.children(joint) {
            let end = translations[child.index()];
            let length = end.length();
            if length <= scale * 1e-3 {
                continue;
            }
            let half_width = (length * 0.11).clamp(scale * 0.004, scale * 0.024);
            let material = match side_of_joint(skeleton, *child) {
                Some(Side::Left) => MaterialId::Left,
                Some(Side::Right) => MaterialId::Right,
                None => MaterialId::Base,
            };
            mesh.add(
                &Shape::octahedron(Vec3::ZERO, end, half_width),
                index,
                material,
            );
            add_contact(&mut mesh, index, end * 0.5, half_width);
            radius = radius.max(half_width * 0.42);
        }
        mesh.add(
            &Shape::ball(Vec3::ZERO, radius, segments),
            index,
            MaterialId::Accent,
        );
        add_contact(&mut mesh, index, Vec3::ZERO, radius);
    }
    mesh
}

/// A mesh of three thin arrows at every joint that can turn: its X, Y and Z axis.
///
/// # Panics
/// If the proportions are another skeleton's.
#[must_use]
pub fn axes_mesh(skeleton: &Skeleton, proportions: &Proportions) -> Mesh {
    let translations = proportions.bones(skeleton);
    let scale = proportions.stature;
    let segments = segments(skeleton, 8);
    let axes = [
        (Vec3::X, MaterialId::AxisX),
        (Vec3::Y, MaterialId::AxisY),
        (Vec3::Z, MaterialId::AxisZ),
    ];
    let mut mesh = Mesh::default();
    for joint in skeleton.joints().filter(|&j| !skeleton.is_end_site(j)) {
        let longest = skeleton
            .children(joint)
            .iter()
            .map(|child| translations[child.index()].length())
            .fold(0.0, f32::max);
        let length = (longest * 0.4).clamp(scale * 0.03, scale * 0.075);
        let radius = scale * 0.0032;
        for (axis, material) in axes {
            let shape =
                Shape::tapered_capsule(Vec3::ZERO, radius, axis * length, radius * 0.5, segments);
            mesh.add(&shape, joint.index(), material);
        }
    }
    mesh
}
