//! Whether what was found has the shape of a person, and which of its sides is the left.

use glam::Vec3;

use crate::skeleton::JointId;

use super::anatomy::{Anatomy, Limb, NoAnatomy};
use super::side::Side;
use super::tree::Tree;

/// How far left and right may differ in length: twice what CMU's subjects do and a little more.
const SIDES_RATIO_MAX: f32 = 1.4;

/// A thigh and a shin, or an upper arm and a forearm, of a humanoid differ in length by no more.
const BONES_RATIO_MAX: f32 = 3.5;

/// Shorter than this share of a leg is no trunk, longer than the other no person's.
const TRUNK_SHARES: (f32, f32) = (0.15, 4.0);

/// Limbs that point this nearly the same way, as a cosine, across the trunk carry an animal.
const FOUR_LEGS_COS: f32 = 0.75;
const LEVEL_COS: f32 = 0.55;

impl Tree<'_> {
    /// Refuses lengths that no person has, whatever the names say.
    pub(super) fn check_shape(&self, anatomy: &Anatomy) -> Result<(), NoAnatomy> {
        let at = |joint: JointId| self.at(joint);
        let bones = |limb: &Limb| {
            [
                at(limb.upper).distance(at(limb.middle)),
                at(limb.middle).distance(at(limb.lower)),
            ]
        };
        let ratio = |a: f32, b: f32| a.max(b) / a.min(b);
        let mut is_odd = false;
        for pair in std::iter::once(&anatomy.legs).chain(&anatomy.arms) {
            let [left, right] = pair.each_ref().map(bones);
            is_odd |= ratio(left[0] + left[1], right[0] + right[1]) > SIDES_RATIO_MAX;
            is_odd |= [left, right]
                .iter()
                .any(|&[a, b]| ratio(a, b) > BONES_RATIO_MAX);
        }
        let leg: f32 = bones(&anatomy.legs[0]).iter().sum();
        let [left_leg, right_leg] = &anatomy.legs;
        let hips = (at(left_leg.upper) + at(right_leg.upper)) * 0.5;
        let stations = anatomy.trunk.iter().chain([&anatomy.head]);
        let trunk = stations
            .fold((hips, 0.0), |(before, length), &joint| {
                (at(joint), length + before.distance(at(joint)))
            })
            .1;
        let (shortest, longest) = TRUNK_SHARES;
        is_odd |= !(shortest * leg..=longest * leg).contains(&trunk);
        if is_odd {
            return Err(NoAnatomy::Contradiction);
        }
        if self.has_four_legs(anatomy, hips) {
            return Err(NoAnatomy::FourLegs);
        }
        Ok(())
    }

    /// Whether arms and legs point the same way and the trunk lies across them.
    fn has_four_legs(&self, anatomy: &Anatomy, hips: Vec3) -> bool {
        let Some(arms) = &anatomy.arms else {
            return false;
        };
        let way = |limb: &Limb| (self.at(limb.lower) - self.at(limb.upper)).normalize_or_zero();
        let down = anatomy
            .legs
            .iter()
            .map(way)
            .sum::<Vec3>()
            .normalize_or_zero();
        let shoulders = (self.at(arms[0].upper) + self.at(arms[1].upper)) * 0.5;
        let trunk = (shoulders - hips).normalize_or_zero();
        let lies = trunk.dot(down).abs() < LEVEL_COS;
        lies && anatomy
            .legs
            .iter()
            .chain(arms)
            .all(|limb| way(limb).dot(down) > FOUR_LEGS_COS)
    }

    /// Where names give no sides, the side that the toes and the trunk make the left.
    pub(super) fn put_sides_right(
        &self,
        anatomy: &mut Anatomy,
        legs_have_sides: bool,
        arms_have_sides: bool,
    ) {
        if legs_have_sides && arms_have_sides {
            return;
        }
        let Some(axes) = anatomy.axes(self.pose) else {
            return;
        };
        let swap = |limbs: &mut [Limb; 2]| {
            limbs.swap(0, 1);
            for (limb, side) in limbs.iter_mut().zip(Side::BOTH) {
                limb.side = side;
            }
        };
        let mut left = axes.left;
        if !legs_have_sides {
            let toes: Vec3 = anatomy
                .legs
                .iter()
                .filter_map(|leg| Some(self.at(leg.tip?) - self.at(leg.lower)))
                .sum();
            // The toes point forward: if that is behind, left is right.
            if toes.dot(axes.forward) < 0.0 {
                swap(&mut anatomy.legs);
                left = -left;
            }
        }
        if let Some(arms) = anatomy.arms.as_mut().filter(|_| !arms_have_sides) {
            let across = self.at(arms[0].upper) - self.at(arms[1].upper);
            if across.dot(left) < 0.0 {
                swap(arms);
            }
        }
    }
}
