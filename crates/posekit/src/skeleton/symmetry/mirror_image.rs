//! Branches of the rest pose that are each other's mirror image.

use glam::Vec3;

use super::SymmetricPair;
use crate::pose::GlobalPose;
use crate::skeleton::{JointId, Skeleton};

/// How far a joint may be from its mirror image, as a part of the figure's largest extent. Real
/// people's limbs differ by a few percent of their length (CMU subjects' legs by 4 %).
const TOLERANCE: f32 = 0.04;

/// How far two branches must be apart, as a part of the largest extent, to be called sides:
/// branches that coincide mirror each other across any plane.
const LEAST_SEPARATION: f32 = 0.005;

/// A plane that may divide the figure in a left and a right half.
#[derive(Clone, Copy, Debug)]
pub(super) struct MirrorPlane {
    /// Unit normal in world space, towards the left.
    normal: Vec3,
    /// The plane's place along the normal, in the file's unit.
    offset: f32,
    /// Largest distance that still counts as the same place, in the file's unit.
    tolerance: f32,
    /// Smallest distance between two sides, in the file's unit.
    separation: f32,
}

impl MirrorPlane {
    fn new(normal: Vec3, offset: f32, rest: &GlobalPose) -> Self {
        let extent = extent(rest).max_element();
        Self {
            normal,
            offset,
            tolerance: extent * TOLERANCE,
            separation: extent * LEAST_SEPARATION,
        }
    }

    /// The plane between the joints of known pairs; `None` when there are none or they coincide.
    pub(super) fn of_pairs(pairs: &[SymmetricPair], rest: &GlobalPose) -> Option<Self> {
        let ends = |pair: &SymmetricPair| {
            [pair.left, pair.right].map(|joint| rest.positions[joint.index()])
        };
        let across: Vec3 = pairs
            .iter()
            .map(ends)
            .map(|[left, right]| left - right)
            .sum();
        let normal = across.try_normalize()?;
        let middles = pairs
            .iter()
            .map(ends)
            .map(|[left, right]| (left + right).dot(normal) * 0.5);
        let (sum, count) = middles.fold((0.0_f32, 0.0_f32), |(s, n), m| (s + m, n + 1.0));
        Some(Self::new(normal, sum / count, rest))
    }

    /// The planes worth trying when nothing is known, the likeliest first: the figure faces +Z, or
    /// +X, or (when it is longest along Z) stands along Z and faces +X.
    pub(super) fn candidates(rest: &GlobalPose) -> Vec<Self> {
        let extent = extent(rest);
        let mut normals = vec![Vec3::X, Vec3::NEG_Z];
        if extent.z > extent.y && extent.z >= extent.x {
            normals = vec![Vec3::X, Vec3::Y];
        }
        normals
            .into_iter()
            .map(|normal| Self::new(normal, 0.0, rest))
            .collect()
    }

    /// Whether two points are mirror images of each other, on two sides of the plane.
    pub(super) fn mirrors(&self, left: Vec3, right: Vec3) -> bool {
        let image = left - 2.0 * (left.dot(self.normal) - self.offset) * self.normal;
        image.distance(right) <= self.tolerance && (left - right).dot(self.normal) > self.separation
    }

    /// The same plane moved through a point.
    fn through(&self, point: Vec3) -> Self {
        Self {
            offset: point.dot(self.normal),
            ..*self
        }
    }

    fn image(&self, point: Vec3) -> Vec3 {
        point - 2.0 * (point.dot(self.normal) - self.offset) * self.normal
    }
}

fn extent(rest: &GlobalPose) -> Vec3 {
    let (low, high) = rest.bounds();
    high - low
}

/// The pairs of joints of all sibling branches that mirror each other across the plane moved
/// through their common parent, the left joint first. Branches with a joint in `taken` are left
/// alone.
pub(super) fn branches(
    skeleton: &Skeleton,
    rest: &GlobalPose,
    plane: &MirrorPlane,
    taken: &[bool],
) -> Vec<(JointId, JointId)> {
    let mut sizes = vec![1_usize; skeleton.joint_count()];
    let mut free: Vec<bool> = taken.iter().map(|&taken| !taken).collect();
    for (child, parent) in skeleton.parents().iter().enumerate().rev() {
        if let Some(parent) = parent {
            sizes[parent.index()] += sizes[child];
            free[parent.index()] &= free[child];
        }
    }
    let search = Search {
        skeleton,
        rest,
        sizes: &sizes,
    };
    let mut found = Vec::new();
    for parent in skeleton.joints() {
        let plane = plane.through(rest.positions[parent.index()]);
        let mut open: Vec<JointId> = skeleton.children(parent).to_vec();
        open.retain(|child| free[child.index()]);
        while let Some(branch) = open.pop() {
            let partner = open.iter().enumerate().rev().find_map(|(place, &other)| {
                Some((place, search.mirror_images(other, branch, &plane)?))
            });
            if let Some((place, pairs)) = partner {
                let other = open.remove(place);
                for joint in skeleton.subtree(branch).chain(skeleton.subtree(other)) {
                    free[joint.index()] = false;
                }
                found.extend(pairs);
            }
        }
    }
    found
}

struct Search<'a> {
    skeleton: &'a Skeleton,
    rest: &'a GlobalPose,
    sizes: &'a [usize],
}

impl Search<'_> {
    /// The corresponding joints of two branches, left ones first, when the branches are mirror
    /// images: the same shape, every joint at the image of the other, and somewhere apart.
    fn mirror_images(
        &self,
        a: JointId,
        b: JointId,
        plane: &MirrorPlane,
    ) -> Option<Vec<(JointId, JointId)>> {
        if !self.corresponds(a, b, plane) {
            return None;
        }
        let mut pairs = vec![(a, b)];
        let mut next = 0;
        while let Some(&(a, b)) = pairs.get(next) {
            next += 1;
            let mut open = self.skeleton.children(b).to_vec();
            for &child in self.skeleton.children(a) {
                let images = open.iter().enumerate();
                let place = images
                    .filter(|&(_, &other)| self.corresponds(child, other, plane))
                    .min_by(|&(_, &p), &(_, &q)| {
                        let far = |other| self.distance_to_image(child, other, plane);
                        far(p).total_cmp(&far(q))
                    })?
                    .0;
                pairs.push((child, open.remove(place)));
            }
        }
        let apart = |&(a, b): &(JointId, JointId)| {
            (self.rest.positions[a.index()] - self.rest.positions[b.index()]).dot(plane.normal)
        };
        let widest = pairs
            .iter()
            .map(apart)
            .max_by(|p, q| p.abs().total_cmp(&q.abs()))?;
        if widest.abs() <= plane.separation {
            return None;
        }
        if widest < 0.0 {
            pairs.iter_mut().for_each(|(a, b)| std::mem::swap(a, b));
        }
        Some(pairs)
    }

    fn corresponds(&self, a: JointId, b: JointId, plane: &MirrorPlane) -> bool {
        self.sizes[a.index()] == self.sizes[b.index()]
            && self.skeleton.children(a).len() == self.skeleton.children(b).len()
            && self.skeleton.is_end_site(a) == self.skeleton.is_end_site(b)
            && self.distance_to_image(a, b, plane) <= plane.tolerance
    }

    fn distance_to_image(&self, a: JointId, b: JointId, plane: &MirrorPlane) -> f32 {
        let [a, b] = [a, b].map(|joint| self.rest.positions[joint.index()]);
        plane.image(a).distance(b)
    }
}
