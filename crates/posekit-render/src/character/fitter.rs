//! Shapes placed in the reference pose and handed to the joints that carry them.

use glam::{Mat3, Vec3};

use posekit::body::{Anatomy, BodyAxes};
use posekit::pose::GlobalPose;
use posekit::skeleton::JointId;

use crate::mesh::{LoftRing, MaterialId, Mesh, Shape, Vertex};

use super::bones::add_contact;

/// Slices of limbs and joint balls.
pub(super) const SEGMENTS: usize = 18;
/// Slices of the trunk, the head and other large parts.
pub(super) const LARGE_SEGMENTS: usize = 26;

/// A humanoid that is fitted.
#[derive(Clone, Copy)]
pub(super) struct Mannequin<'a> {
    /// Its landmarks.
    pub(super) anatomy: &'a Anatomy,
    /// Its directions in the reference pose.
    pub(super) axes: BodyAxes,
    /// Its height, in the file's unit.
    pub(super) stature: f32,
}

/// Builds a mesh out of shapes that are described in the world space of a reference pose.
pub(super) struct Fitter<'a> {
    pose: &'a GlobalPose,
    mesh: Mesh,
}

impl<'a> Fitter<'a> {
    pub(super) fn new(pose: &'a GlobalPose) -> Self {
        Self {
            pose,
            mesh: Mesh::default(),
        }
    }

    pub(super) fn finish(self) -> Mesh {
        self.mesh
    }

    /// A joint's position.
    pub(super) fn at(&self, joint: JointId) -> Vec3 {
        self.pose.positions[joint.index()]
    }

    /// Adds a shape in world space that `joint` will carry.
    pub(super) fn add(&mut self, joint: JointId, shape: Shape, material: MaterialId) {
        let index = joint.index();
        let to_joint = Mat3::from_quat(self.pose.orientations[index]).transpose();
        let offset = -(to_joint * self.pose.positions[index]);
        self.mesh
            .add(&shape.mapped(to_joint, offset), index, material);
    }

    /// Adds a shape in world space whose vertices ride on joints of their own, one for each: a skin
    /// over bones that bend a little.
    pub(super) fn add_over(&mut self, joints: &[JointId], shape: &Shape, material: MaterialId) {
        let base = u32::try_from(self.mesh.vertices.len()).unwrap_or(u32::MAX);
        let points = shape.positions.iter().zip(&shape.normals).zip(joints);
        for ((&position, &normal), &joint) in points {
            let to_joint = self.pose.orientations[joint.index()].conjugate();
            self.mesh.vertices.push(Vertex {
                position: self.pose.inverse_transform_point(joint, position),
                normal: to_joint * normal,
                joint: u32::try_from(joint.index()).unwrap_or(u32::MAX),
                material,
            });
        }
        let triangles = shape.triangles.iter();
        self.mesh
            .triangles
            .extend(triangles.map(|t| t.map(|i| i + base)));
    }

    /// Adds a ball for the dark under the body.
    pub(super) fn contact(&mut self, joint: JointId, center: Vec3, radius: f32) {
        let center = self.pose.inverse_transform_point(joint, center);
        add_contact(&mut self.mesh, joint.index(), center, radius);
    }

    /// A ball at a joint.
    pub(super) fn ball(&mut self, joint: JointId, radius: f32, material: MaterialId) {
        let center = self.at(joint);
        self.add(joint, Shape::ball(center, radius, SEGMENTS), material);
    }

    /// A round limb whose radius follows `radii` from `start` to `end`.
    pub(super) fn turned(
        &mut self,
        joint: JointId,
        (start, end): (Vec3, Vec3),
        radii: &[f32],
        material: MaterialId,
    ) {
        self.add(joint, Shape::turned(start, end, radii, SEGMENTS), material);
        let spans = radii.len().max(2) - 1;
        for (i, &radius) in radii.iter().enumerate() {
            self.contact(joint, start.lerp(end, i as f32 / spans as f32), radius);
        }
    }
}

/// How many rings a rounded end has.
pub(super) const DOME: usize = 4;

/// Rings with rounded ends: before the first and after the last, domes of the given depths.
pub(super) fn domed(rings: &[LoftRing], start_depth: f32, end_depth: f32) -> Vec<LoftRing> {
    let (Some(first), Some(last)) = (rings.first(), rings.last()) else {
        return Vec::new();
    };
    let axis = (last.center - first.center).normalize_or(Vec3::Y);
    let dome = |ring: &LoftRing, direction: Vec3, depth: f32, step: usize| {
        let (sin, cos) =
            libm::sincosf(std::f32::consts::FRAC_PI_2 * step as f32 / (DOME as f32 + 0.4));
        LoftRing {
            center: ring.center + direction * (depth * sin),
            half_side: ring.half_side * cos,
            half_front: ring.half_front * cos,
        }
    };
    let before = (1..=DOME).rev().map(|i| dome(first, -axis, start_depth, i));
    let after = (1..=DOME).map(|i| dome(last, axis, end_depth, i));
    before.chain(rings.iter().copied()).chain(after).collect()
}

/// The value of a curve through (position, value) knots, smooth between them (Catmull-Rom on
/// uneven knots, which does not overshoot much on the gentle curves used here).
pub(super) fn curve(knots: &[(f32, f32)], at: f32) -> f32 {
    let Some(next) = knots.iter().position(|k| k.0 > at) else {
        return knots.last().map_or(0.0, |k| k.1);
    };
    if next == 0 {
        return knots[0].1;
    }
    let (a, b) = (knots[next - 1], knots[next]);
    let slope = |i: usize| {
        let (p, q) = (
            knots[i.saturating_sub(1)],
            knots[(i + 1).min(knots.len() - 1)],
        );
        (q.1 - p.1) / (q.0 - p.0)
    };
    let width = b.0 - a.0;
    let t = (at - a.0) / width;
    let (t2, t3) = (t * t, t * t * t);
    a.1 * (2.0 * t3 - 3.0 * t2 + 1.0)
        + b.1 * (3.0 * t2 - 2.0 * t3)
        + width * (slope(next - 1) * (t3 - 2.0 * t2 + t) + slope(next) * (t3 - t2))
}
