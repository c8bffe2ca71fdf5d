//! The symmetric pairs of a skeleton: which joint is the left one of which right one.
//!
//! Names are asked first, because riggers name sides in a handful of ways and the names survive
//! whatever the rest pose looks like (a BVH whose OFFSETs lie along the bones has no mirror plane
//! at all). Joints that names leave open are paired by what hangs below a pair, and then by the
//! rest pose: two branches of one joint that are each other's mirror image.
//!
//! Which one is the left: the one whose name says so; where names say nothing, the one that is on
//! the left of a figure that faces +Z with Y up, which is +X (-Z where the mirror plane shows that
//! it faces +X instead; +Y for a figure that stands along Z and faces +X).
//!
//! A skeleton without symmetry, such as a robot arm, has no pairs; that is not an error. Cost: n log n
//! for n joints, however they hang together.

mod likeness;
mod mirror_image;
mod side_in_name;

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use super::{JointId, Skeleton};
use crate::pose::GlobalPose;
use mirror_image::MirrorPlane;
use side_in_name::{Side, Strength};

/// How a [`SymmetricPair`] was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum PairEvidence {
    /// By names alone: the two joints do not mirror each other in the rest pose.
    Name,
    /// By names, and the rest pose agrees: they lie as mirror images.
    NameAndGeometry,
    /// The only child left of one joint of a pair and the only child left of the other one, such
    /// as the End Sites of two hands.
    Topology,
    /// By mirror-image branches of the rest pose.
    Geometry,
}

/// Two joints that mirror each other, a left one and a right one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SymmetricPair {
    /// The joint on the figure's own left.
    pub left: JointId,
    /// Its mirror image.
    pub right: JointId,
    /// What says that they are a pair.
    pub found_by: PairEvidence,
}

impl Skeleton {
    /// The left and right joints that mirror each other, in the topological order of the left ones.
    /// A joint is in one pair at most; joints of the trunk are in none.
    ///
    /// ```
    /// use glam::Vec3;
    /// use posekit::skeleton::SkeletonBuilder;
    ///
    /// let mut builder = SkeletonBuilder::new();
    /// let hips = builder.joint("Hips", None, Vec3::ZERO);
    /// let left = builder.joint("LeftUpLeg", Some(hips), Vec3::new(0.1, -0.1, 0.0));
    /// let right = builder.joint("RightUpLeg", Some(hips), Vec3::new(-0.1, -0.1, 0.0));
    /// let skeleton = builder.build()?;
    /// let pairs = skeleton.symmetric_pairs();
    /// assert_eq!(pairs.len(), 1);
    /// assert_eq!((pairs[0].left, pairs[0].right), (left, right));
    /// # Ok::<(), posekit::skeleton::SkeletonError>(())
    /// ```
    ///
    /// They are looked for once, and kept.
    pub fn symmetric_pairs(&self) -> &[SymmetricPair] {
        self.known_pairs.0.get_or_init(|| found_pairs(self).into())
    }
}

/// The pairs of a skeleton, once they were looked for: what is up, which joint is a knee and how a pose is mirrored
/// all ask for them. They follow from the rest of the skeleton, and are no part of what makes two equal.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownPairs(OnceLock<Arc<[SymmetricPair]>>);

impl PartialEq for KnownPairs {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

fn found_pairs(skeleton: &Skeleton) -> Vec<SymmetricPair> {
    let rest = GlobalPose::rest(skeleton);
    let mut pairing = Pairing::new(skeleton);
    pairing.pair_by_name();
    pairing.grade_by_geometry(&rest);
    pairing.pair_below_pairs();
    pairing.pair_by_geometry(&rest);
    pairing.pairs.sort_by_key(|pair| pair.left);
    pairing.pairs
}

/// The pairs found so far.
struct Pairing<'a> {
    skeleton: &'a Skeleton,
    depths: Vec<usize>,
    /// For each joint the numbers, in depth-first order, of itself and of the first joint that is no longer
    /// below it.
    below: Vec<(usize, usize)>,
    paired: Vec<bool>,
    pairs: Vec<SymmetricPair>,
}

impl<'a> Pairing<'a> {
    fn new(skeleton: &'a Skeleton) -> Self {
        let mut depths: Vec<usize> = Vec::with_capacity(skeleton.joint_count());
        for parent in skeleton.parents() {
            depths.push(parent.map_or(0, |parent| depths[parent.index()] + 1));
        }
        let mut below = vec![(0, 0); skeleton.joint_count()];
        let in_depth_first_order = skeleton.roots().flat_map(|root| skeleton.subtree(root));
        for (number, joint) in in_depth_first_order.enumerate() {
            below[joint.index()] = (number, number + 1);
        }
        for (child, parent) in skeleton.parents().iter().enumerate().rev() {
            if let Some(parent) = parent {
                let end = below[child].1;
                let own = &mut below[parent.index()].1;
                *own = (*own).max(end);
            }
        }
        Self {
            skeleton,
            depths,
            below,
            paired: vec![false; skeleton.joint_count()],
            pairs: Vec::new(),
        }
    }

    fn push(&mut self, left: JointId, right: JointId, found_by: PairEvidence) {
        self.paired[left.index()] = true;
        self.paired[right.index()] = true;
        self.pairs.push(SymmetricPair {
            left,
            right,
            found_by,
        });
    }

    /// Pairs joints whose names differ in the side alone, the surest way of writing a side first.
    fn pair_by_name(&mut self) {
        for strength in Strength::ALL {
            let mut by_stem: BTreeMap<String, [Vec<JointId>; 2]> = BTreeMap::new();
            for joint in self.skeleton.joints() {
                if self.paired[joint.index()] {
                    continue;
                }
                for (side, stem) in side_in_name::readings(self.skeleton.name(joint), strength) {
                    by_stem.entry(stem).or_default()[side as usize].push(joint);
                }
            }
            for lefts_and_rights in by_stem.values() {
                self.pair_same_stem(lefts_and_rights, strength);
            }
        }
    }

    /// Joints that share a stem are paired in their order; where one side has more of them than
    /// the other, nothing tells which belong together.
    fn pair_same_stem(&mut self, sides: &[Vec<JointId>; 2], strength: Strength) {
        let [lefts, rights] = sides;
        debug_assert!(Side::Left as usize == 0 && Side::Right as usize == 1);
        if lefts.len() != rights.len() {
            return;
        }
        for (&left, &right) in lefts.iter().zip(rights) {
            let free = !self.paired[left.index()] && !self.paired[right.index()];
            if free && self.can_be_pair(left, right, strength) {
                self.push(left, right, PairEvidence::Name);
            }
        }
    }

    /// Whether the hierarchy lets two joints be sides of each other: neither hangs from the other,
    /// and where the name says little, both are as far from the root.
    fn can_be_pair(&self, left: JointId, right: JointId, strength: Strength) -> bool {
        let [left_depth, right_depth] = [left, right].map(|joint| self.depths[joint.index()]);
        if left_depth == right_depth {
            return true;
        }
        let (upper, lower) = if left_depth < right_depth {
            (left, right)
        } else {
            (right, left)
        };
        strength != Strength::GluedLetter && !self.hangs_from(lower, upper)
    }

    fn hangs_from(&self, lower: JointId, upper: JointId) -> bool {
        let (first, end) = self.below[upper.index()];
        (first..end).contains(&self.below[lower.index()].0)
    }

    /// Marks the pairs by name whose rest positions mirror each other.
    fn grade_by_geometry(&mut self, rest: &GlobalPose) {
        let Some(plane) = MirrorPlane::of_pairs(&self.pairs, rest) else {
            return;
        };
        for pair in &mut self.pairs {
            let [left, right] = [pair.left, pair.right].map(|joint| rest.positions[joint.index()]);
            if plane.mirrors(left, right) {
                pair.found_by = PairEvidence::NameAndGeometry;
            }
        }
    }

    /// Pairs the only open child of a left joint with the only open child of its right one, and so
    /// on down.
    fn pair_below_pairs(&mut self) {
        let mut next = 0;
        while let Some(&pair) = self.pairs.get(next) {
            next += 1;
            let [left, right] = [pair.left, pair.right].map(|joint| self.only_open_child(joint));
            if let (Some(left), Some(right)) = (left, right) {
                self.push(left, right, PairEvidence::Topology);
            }
        }
    }

    fn only_open_child(&self, joint: JointId) -> Option<JointId> {
        let children = self.skeleton.children(joint).iter().copied();
        let mut open = children.filter(|child| !self.paired[child.index()]);
        let first = open.next();
        if open.next().is_some() { None } else { first }
    }

    /// Pairs mirror-image branches of the rest pose that hold no pair yet.
    fn pair_by_geometry(&mut self, rest: &GlobalPose) {
        let found = match MirrorPlane::of_pairs(&self.pairs, rest) {
            Some(plane) => mirror_image::branches(self.skeleton, rest, &plane, &self.paired),
            None => MirrorPlane::candidates(rest)
                .iter()
                .map(|plane| mirror_image::branches(self.skeleton, rest, plane, &self.paired))
                .reduce(
                    |best, next| {
                        if next.len() > best.len() { next } else { best }
                    },
                )
                .unwrap_or_default(),
        };
        for (left, right) in found {
            self.push(left, right, PairEvidence::Geometry);
        }
    }
}
