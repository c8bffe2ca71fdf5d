//! Branches of the rest pose that are each other's mirror image.

use std::cell::Cell;

use glam::Vec3;

use super::SymmetricPair;
use super::likeness::{Shape, Sisters, likenesses};
use crate::pose::GlobalPose;
use crate::skeleton::{JointId, Skeleton};

/// How far a joint may be from its mirror image, as a part of the figure's largest extent. Real
/// people's limbs differ by a few percent of their length (CMU subjects' legs by 4 %).
const TOLERANCE: f32 = 0.04;

/// How far two branches must be apart, as a part of the largest extent, to be called sides:
/// branches that coincide mirror each other across any plane.
const LEAST_SEPARATION: f32 = 0.005;

/// How many comparisons of two joints are made at most before the search gives up being thorough: far more than
/// any figure needs, and a moment's work.
const THOROUGH_COMPARISONS: usize = 4_000_000;

/// How many are made for a branch after that; and, for each joint and each doubling of their number, before.
const COMPARISONS_EACH: usize = 64;

/// How many comparisons are made for so many joints before the search gives up being thorough: all with all up to a
/// thousand, and from there on as n log n.
fn thorough_comparisons(joint_count: usize) -> usize {
    let doublings = joint_count.max(1).ilog2() as usize + 1;
    let budget = COMPARISONS_EACH.saturating_mul(joint_count);
    budget.saturating_mul(doublings).min(THOROUGH_COMPARISONS)
}

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
///
/// A branch is paired with its last sister that mirrors it. Cost: n log n comparisons, as long as few
/// branches that are no copies of each other lie within the tolerance of one place; where
/// more than a thousand do, some pairs may be missed.
pub(super) fn branches(
    skeleton: &Skeleton,
    rest: &GlobalPose,
    plane: &MirrorPlane,
    taken: &[bool],
) -> Vec<(JointId, JointId)> {
    let search = Search::new(skeleton, rest);
    search.branches(plane, taken)
}

struct Search<'a> {
    skeleton: &'a Skeleton,
    rest: &'a GlobalPose,
    sizes: Vec<usize>,
    likenesses: Vec<u32>,
    /// Comparisons of two joints so far, and joints that were put in order to be found by place.
    comparisons: Cell<usize>,
    thorough: usize,
}

impl<'a> Search<'a> {
    fn new(skeleton: &'a Skeleton, rest: &'a GlobalPose) -> Self {
        let mut sizes = vec![1_usize; skeleton.joint_count()];
        for (child, parent) in skeleton.parents().iter().enumerate().rev() {
            if let Some(parent) = parent {
                sizes[parent.index()] += sizes[child];
            }
        }
        Self {
            skeleton,
            rest,
            sizes,
            likenesses: likenesses(skeleton),
            comparisons: Cell::new(0),
            thorough: thorough_comparisons(skeleton.joint_count()),
        }
    }

    fn branches(&self, plane: &MirrorPlane, taken: &[bool]) -> Vec<(JointId, JointId)> {
        let mut found = Vec::new();
        // Where everything coincides, or lies beyond all numbers, nothing is apart.
        if !(plane.tolerance > 0.0 && plane.tolerance.is_finite()) {
            return found;
        }
        let mut free: Vec<bool> = taken.iter().map(|&taken| !taken).collect();
        for (child, parent) in self.skeleton.parents().iter().enumerate().rev() {
            if let Some(parent) = parent {
                free[parent.index()] &= free[child];
            }
        }
        for parent in self.skeleton.joints() {
            let plane = plane.through(self.position(parent));
            let mut open: Vec<JointId> = self.skeleton.children(parent).to_vec();
            open.retain(|child| free[child.index()]);
            if open.len() < 2 {
                continue;
            }
            let mut sisters = self.sisters(&open, &plane, true);
            while let Some(branch) = open.pop() {
                if !free[branch.index()] {
                    continue;
                }
                let (likeness, shape) = (self.likeness(branch), self.shape(branch));
                // The last of all is the last of its likeness.
                sisters.take(likeness, shape);
                let image = plane.image(self.position(branch));
                let start = self.comparisons.get();
                let partner = sisters
                    .near(shape, image)
                    .take_while(|_| self.may_go_on(start))
                    .find_map(|(other, _)| {
                        Some((other, self.mirror_images(other, branch, &plane)?))
                    });
                let Some((other, pairs)) = partner else {
                    // Nor has any copy of this branch a partner.
                    continue;
                };
                sisters.take(self.likeness(other), shape);
                let joints = self.skeleton.subtree(branch);
                for joint in joints.chain(self.skeleton.subtree(other)) {
                    free[joint.index()] = false;
                }
                found.extend(pairs);
            }
        }
        found
    }

    /// Whether there is time for another comparison in a search that began after `start` of them.
    fn may_go_on(&self, start: usize) -> bool {
        let done = self.comparisons.get();
        done < self.thorough || done - start < COMPARISONS_EACH
    }

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
            let of_a = self.skeleton.children(a);
            let mut open = self.sisters(self.skeleton.children(b), plane, false);
            for &child in of_a {
                let (shape, start) = (self.shape(child), self.comparisons.get());
                let image = plane.image(self.position(child));
                let (_, other) = open
                    .near(shape, image)
                    .take_while(|_| self.may_go_on(start))
                    .filter(|&(other, _)| self.corresponds(child, other, plane))
                    .map(|(other, _)| (self.distance_to_image(child, other, plane), other))
                    .min_by(|(p, _), (q, _)| p.total_cmp(q))?;
                open.take(self.likeness(other), shape);
                pairs.push((child, other));
            }
        }
        let apart =
            |&(a, b): &(JointId, JointId)| (self.position(a) - self.position(b)).dot(plane.normal);
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
        self.comparisons.set(self.comparisons.get() + 1);
        self.shape(a) == self.shape(b) && self.distance_to_image(a, b, plane) <= plane.tolerance
    }

    fn distance_to_image(&self, a: JointId, b: JointId, plane: &MirrorPlane) -> f32 {
        plane.image(self.position(a)).distance(self.position(b))
    }

    fn sisters(&self, list: &[JointId], plane: &MirrorPlane, takes_last: bool) -> Sisters<'_> {
        // Each has to be put in its cell, whatever is compared then.
        self.comparisons.set(self.comparisons.get() + list.len());
        let shape = |joint| self.shape(joint);
        Sisters::new(
            list,
            &self.likenesses,
            shape,
            self.rest,
            plane.tolerance,
            takes_last,
        )
    }

    fn shape(&self, joint: JointId) -> Shape {
        (
            self.sizes[joint.index()],
            self.skeleton.children(joint).len(),
            self.skeleton.is_end_site(joint),
        )
    }

    fn likeness(&self, joint: JointId) -> u32 {
        self.likenesses[joint.index()]
    }

    fn position(&self, joint: JointId) -> Vec3 {
        self.rest.positions[joint.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::SkeletonBuilder;

    const X_PLANE: fn(&GlobalPose) -> MirrorPlane = |rest| MirrorPlane::new(Vec3::X, 0.0, rest);

    /// Every branch compared with every sister, as the words above say it and with no thought of cost.
    fn plainly(search: &Search<'_>, plane: &MirrorPlane) -> Vec<(JointId, JointId)> {
        let skeleton = search.skeleton;
        let mut free = vec![true; skeleton.joint_count()];
        let mut found = Vec::new();
        for parent in skeleton.joints() {
            let plane = plane.through(search.position(parent));
            let mut open: Vec<JointId> = skeleton.children(parent).to_vec();
            open.retain(|child| free[child.index()]);
            while let Some(branch) = open.pop() {
                let partner = open.iter().enumerate().rev().find_map(|(place, &other)| {
                    Some((place, images_plainly(search, other, branch, &plane)?))
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

    fn images_plainly(
        search: &Search<'_>,
        a: JointId,
        b: JointId,
        plane: &MirrorPlane,
    ) -> Option<Vec<(JointId, JointId)>> {
        let mut pairs = vec![(a, b)];
        if !search.corresponds(a, b, plane) {
            return None;
        }
        let mut next = 0;
        while let Some(&(a, b)) = pairs.get(next) {
            next += 1;
            let mut open = search.skeleton.children(b).to_vec();
            for &child in search.skeleton.children(a) {
                let far = |other| search.distance_to_image(child, other, plane);
                let images = open.iter().enumerate();
                let (place, _) = images
                    .filter(|&(_, &other)| search.corresponds(child, other, plane))
                    .min_by(|&(_, &p), &(_, &q)| far(p).total_cmp(&far(q)))?;
                pairs.push((child, open.remove(place)));
            }
        }
        let apart = |(a, b)| (search.position(a) - search.position(b)).dot(plane.normal);
        let widest = pairs.iter().map(|&pair| apart(pair));
        let widest = widest.max_by(|p, q| p.abs().total_cmp(&q.abs()))?;
        if widest.abs() <= plane.separation {
            return None;
        }
        let in_order = |(a, b)| if widest < 0.0 { (b, a) } else { (a, b) };
        Some(pairs.into_iter().map(in_order).collect())
    }

    /// Numbers without order, the same each time (Marsaglia 2003, xorshift).
    fn numbers(seed: u32) -> impl FnMut(u32) -> u32 {
        let mut state = seed;
        move |below| {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            state % below
        }
    }

    #[test]
    fn the_answers_are_those_of_comparing_every_two_sisters() {
        for seed in 1..400 {
            let mut number = numbers(seed);
            let mut builder = SkeletonBuilder::new();
            let mut joints = vec![builder.joint("", None, Vec3::ZERO)];
            // Few places, so that many joints are images, many coincide, and many nearly are and do.
            let grain = [0.01, 0.03, 0.3][seed as usize % 3];
            for _ in 0..number(60) {
                let parent = joints[number(u32::try_from(joints.len()).unwrap()) as usize];
                let offset = [0; 3].map(|_| number(5) as f32 - 2.0);
                let nudge = number(3) as f32 * grain;
                let offset = Vec3::from_array(offset) + Vec3::splat(nudge);
                joints.push(builder.joint("", Some(parent), offset));
            }
            let skeleton = builder.build().unwrap();
            let rest = GlobalPose::rest(&skeleton);
            let (search, plane) = (Search::new(&skeleton, &rest), X_PLANE(&rest));
            let found = search.branches(&plane, &vec![false; skeleton.joint_count()]);
            assert_eq!(found, plainly(&search, &plane), "seed {seed}");
        }
    }

    /// Comparisons for that many branches with one joint below each.
    fn comparisons(count: u32, place: impl Fn(u32) -> Vec3) -> (usize, usize) {
        let mut builder = SkeletonBuilder::new();
        let root = builder.joint("", None, Vec3::ZERO);
        for branch in 0..count {
            let joint = builder.joint("", Some(root), place(branch));
            builder.end_site("", joint, Vec3::Y);
        }
        let skeleton = builder.build().unwrap();
        let rest = GlobalPose::rest(&skeleton);
        let (search, plane) = (Search::new(&skeleton, &rest), X_PLANE(&rest));
        let found = search.branches(&plane, &vec![false; skeleton.joint_count()]);
        (search.comparisons.get(), found.len())
    }

    #[test]
    fn branches_in_one_place_are_compared_once() {
        // As in files that were made to be slow.
        let (done, found) = comparisons(20_000, |_| Vec3::Y);
        assert!(found == 0 && done <= 5 * 20_000, "{done}");
    }

    #[test]
    fn only_those_near_the_image_are_compared() {
        // Along the plane's normal, and over a cylinder, evenly (turns and heights by irrational steps). A
        // twenty-fifth of the extent is near: all with all would be fifty million.
        let in_a_row = |branch: u32| Vec3::X * (branch as f32 - 5000.0);
        let scattered = |branch: u32| {
            let turn = branch as f32 * 2.399_963;
            let height = (branch as f32 * 0.754_877_7).fract() - 0.5;
            Vec3::new(libm::cosf(turn), height, libm::sinf(turn))
        };
        for place in [in_a_row as fn(u32) -> Vec3, scattered] {
            let (done, found) = comparisons(10_000, place);
            assert!(found > 9_000 && done < 2_000_000, "{done}, {found}");
        }
    }

    #[test]
    fn even_the_worst_crowd_is_bounded() {
        // All different, all within the tolerance of one place, none apart from any other.
        let crowd = |branch: u32| Vec3::new(0.0, 1.0 + branch as f32 * 1e-7, 0.0);
        let mut before = 0;
        for count in [2_000, 4_000, 8_000, 16_000] {
            let (done, found) = comparisons(count, crowd);
            assert!(found == 0, "{found}");
            // Twice as many take little more than twice the work.
            assert!(
                before == 0 || 10 * done <= 25 * before,
                "{count}: {before}, {done}"
            );
            before = done;
        }
    }

    #[test]
    fn branches_of_many_joints_are_bounded_as_well() {
        // Each has forty joints side by side, none has the same two, and all are near one place: putting them in
        // order counts too.
        let work = |count: u32| {
            let mut builder = SkeletonBuilder::new();
            let root = builder.joint("", None, Vec3::ZERO);
            for branch in 0..count {
                let nudge = branch as f32 * 1e-7;
                let joint = builder.joint("", Some(root), Vec3::new(0.0, 1.0 + nudge, 0.0));
                for twig in 0..40 {
                    let place = Vec3::new(0.0, 1.0, nudge + twig as f32 * 1e-6);
                    builder.end_site("", joint, place);
                }
            }
            let skeleton = builder.build().unwrap();
            let rest = GlobalPose::rest(&skeleton);
            let (search, plane) = (Search::new(&skeleton, &rest), X_PLANE(&rest));
            let found = search.branches(&plane, &vec![false; skeleton.joint_count()]);
            assert!(found.is_empty());
            search.comparisons.get()
        };
        let [few, many] = [200, 800].map(work);
        assert!(many <= 10 * few, "{few}, {many}");
    }
}
