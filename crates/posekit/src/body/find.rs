//! Finds the parts of a body: pairs of limbs first, which of them are legs and arms, then what leads
//! from the legs over the shoulders to the head.

use std::collections::BTreeSet;

use crate::pose::GlobalPose;
use crate::skeleton::{JointId, PairEvidence, Skeleton};

use super::anatomy::{Anatomy, Certainty, Limb, NoAnatomy};
use super::limb::{Bend, Kind, STOPS_MAX, Stop, best_bend};
use super::name::Part;
use super::side::Side;
use super::tree::Tree;
use super::twins::twins;

/// So many pairs of limbs are looked at, the likeliest first.
const PAIRS_MAX: usize = 24;

/// A limb is at least this share of the longest one's length.
const LIMB_SHARE: f32 = 0.2;

/// A named leg of this share of the legs' length is a leg too many.
const EXTRA_LEG_SHARE: f32 = 0.4;

/// Unnamed limbs of this share of the longest one's length that are neither arms nor legs make a
/// spider.
const EXTRA_LIMB_SHARE: f32 = 0.6;

/// From this score on a bend that has no names is believed.
const SHAPE_SCORE_MIN: f32 = 2.0;

/// The share of a leg, foot and all, that a skull measures at least.
const SKULL_SHARE: f32 = 0.15;

/// So many joints called heads are looked at.
const HEADS_MAX: usize = 64;

pub(super) fn anatomy(skeleton: &Skeleton, pose: &GlobalPose) -> Result<Anatomy, NoAnatomy> {
    if !pose.positions.iter().all(|p| p.is_finite()) {
        return Err(NoAnatomy::NoLegs);
    }
    let tree = Tree::new(skeleton, pose);
    let pairs = tree.limb_pairs();
    let (legs, arms) = tree.legs_and_arms(&pairs)?;
    tree.check_count(&pairs, legs, arms)?;
    tree.assemble(legs, arms)
}

/// Two limbs that belong together.
struct LimbPair {
    /// The joint above both.
    hub: JointId,
    /// From below the hub to the ends, left first.
    paths: [Vec<JointId>; 2],
    length: f32,
    has_sides: bool,
    leg_names: usize,
    arm_names: usize,
    as_leg: Option<Fit>,
    as_arm: Option<Fit>,
}

/// What leads from the pelvis to the head.
struct Rise {
    /// From the pelvis to before the head.
    trunk: Vec<JointId>,
    /// How many of it are above the pelvis.
    climbed_count: usize,
    head: JointId,
    head_is_named: bool,
}

/// How a pair of limbs bends, if it is one of legs or one of arms.
#[derive(Clone, Copy)]
struct Fit {
    bends: [Bend; 2],
    /// The mean of both sides.
    score: f32,
    /// Names alone did not decide: lengths and angles say the same.
    shape_agrees: bool,
    named_count: usize,
}

impl Tree<'_> {
    /// The pairs of limbs: of joints that mirror each other by name or place, or of branches that are
    /// as long bone by bone, those that hang from no other such joint.
    fn limb_pairs(&self) -> Vec<LimbPair> {
        let symmetric = self.skeleton.symmetric_pairs();
        let mut taken = vec![false; self.skeleton.joint_count()];
        for pair in symmetric {
            taken[pair.left.index()] = true;
            taken[pair.right.index()] = true;
        }
        let is_free = |joint: JointId| {
            let parent = self.skeleton.parent(joint);
            parent.is_none_or(|parent| !taken[parent.index()])
        };
        let mut tops: Vec<([JointId; 2], bool)> = symmetric
            .iter()
            .filter(|pair| is_free(pair.left) && is_free(pair.right))
            .map(|pair| {
                let by_name = matches!(
                    pair.found_by,
                    PairEvidence::Name | PairEvidence::NameAndGeometry
                );
                ([pair.left, pair.right], by_name)
            })
            .collect();
        let least = LIMB_SHARE * self.longest;
        tops.extend(
            twins(self, &taken, least)
                .into_iter()
                .map(|pair| (pair, false)),
        );
        let length = |tops: &[JointId; 2]| {
            let [a, b] = tops.map(|top| self.reach[top.index()] + self.length(top));
            a.min(b)
        };
        let names = |tops: &[JointId; 2]| {
            self.main_path(tops[0])
                .take(STOPS_MAX)
                .filter(|&joint| self.part(joint).is_some_and(|p| p.is_leg() || p.is_arm()))
                .count()
                .min(3)
        };
        let mut ranked: Vec<(usize, f32, [JointId; 2], bool)> = tops
            .into_iter()
            .map(|(tops, has_sides)| (names(&tops), length(&tops), tops, has_sides))
            .filter(|&(_, length, ..)| length >= least && length > 0.0)
            .collect();
        ranked.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)));
        ranked
            .into_iter()
            .take(PAIRS_MAX)
            .filter_map(|(_, length, tops, has_sides)| self.limb_pair(tops, length, has_sides))
            .collect()
    }

    fn limb_pair(&self, tops: [JointId; 2], length: f32, has_sides: bool) -> Option<LimbPair> {
        let hub = self.meeting(tops[0], tops[1])?;
        if tops.contains(&hub) {
            return None;
        }
        let paths = tops.map(|top| {
            let mut path = self.path_down(hub, top);
            path.extend(self.main_path(top).skip(1).take(STOPS_MAX));
            path
        });
        let count = |is_part: fn(Part) -> bool| {
            let named = |path: &Vec<JointId>| {
                path.iter()
                    .filter(|&&joint| self.part(joint).is_some_and(is_part))
                    .count()
            };
            named(&paths[0]).min(named(&paths[1]))
        };
        Some(LimbPair {
            hub,
            length,
            has_sides,
            leg_names: count(Part::is_leg),
            arm_names: count(Part::is_arm),
            as_leg: self.fit(hub, &paths, Kind::Leg),
            as_arm: self.fit(hub, &paths, Kind::Arm),
            paths,
        })
    }

    fn stops(&self, path: &[JointId]) -> Vec<Stop> {
        path.iter()
            .take(STOPS_MAX)
            .map(|&joint| Stop {
                at: self.at(joint),
                reading: self.readings[joint.index()],
                is_end_site: self.skeleton.is_end_site(joint),
            })
            .collect()
    }

    fn fit(&self, hub: JointId, paths: &[Vec<JointId>; 2], kind: Kind) -> Option<Fit> {
        let before = self.at(hub);
        let stops = paths.each_ref().map(|path| self.stops(path));
        let bend = |side: usize, by_names| best_bend(before, &stops[side], kind, by_names);
        let bends = [bend(0, true)?, bend(1, true)?];
        let by_shape = [bend(0, false)?, bend(1, false)?];
        let shape_agrees = bends.iter().zip(&by_shape).all(|(a, b)| a.is_same_place(b));
        Some(Fit {
            bends,
            score: 0.5 * (bends[0].score + bends[1].score),
            shape_agrees,
            named_count: bends[0].named_count.min(bends[1].named_count),
        })
    }

    /// The pair that is legs, and the pair that is arms, if one is.
    fn legs_and_arms<'p>(
        &self,
        pairs: &'p [LimbPair],
    ) -> Result<(&'p LimbPair, Option<&'p LimbPair>), NoAnatomy> {
        let leg_like = |pair: &LimbPair| {
            let is_named = pair.leg_names > pair.arm_names;
            let is_nameless = pair.leg_names + pair.arm_names == 0;
            pair.as_leg
                .is_some_and(|fit| is_named || is_nameless && fit.score >= SHAPE_SCORE_MIN)
        };
        let arm_like = |pair: &LimbPair| {
            let is_named = pair.arm_names > pair.leg_names;
            let is_nameless = pair.leg_names + pair.arm_names == 0;
            pair.as_arm
                .is_some_and(|fit| is_named || is_nameless && fit.score >= SHAPE_SCORE_MIN)
        };
        let score = |fit: Option<Fit>| fit.map_or(f32::MIN, |fit| fit.score);
        let mut best: Option<(f32, &LimbPair, Option<&LimbPair>)> = None;
        let mut consider = |score: f32, legs: &'p LimbPair, arms: Option<&'p LimbPair>| {
            if best.is_none_or(|(so_far, ..)| score > so_far) {
                best = Some((score, legs, arms));
            }
        };
        for (l, legs) in pairs.iter().enumerate().filter(|(_, p)| leg_like(p)) {
            // Legs alone need names to be called legs.
            if legs.leg_names > 0 {
                consider(score(legs.as_leg), legs, None);
            }
            for (a, arms) in pairs.iter().enumerate().filter(|(_, p)| arm_like(p)) {
                if a != l {
                    let both = score(legs.as_leg) + score(arms.as_arm);
                    consider(both + self.placing(legs, arms), legs, Some(arms));
                }
            }
        }
        best.map(|(_, legs, arms)| (legs, arms))
            .ok_or(NoAnatomy::NoLegs)
    }

    /// What speaks for one pair being the legs and another one the arms, by where they are.
    fn placing(&self, legs: &LimbPair, arms: &LimbPair) -> f32 {
        let toward =
            |is_so: bool, is_not: bool| f32::from(u8::from(is_so)) - f32::from(u8::from(is_not));
        let depth = |pair: &LimbPair| self.depths[pair.hub.index()];
        let height = |pair: &LimbPair| {
            let ends = pair.paths.iter().filter_map(|path| path.last());
            ends.map(|&end| self.at(end).y).sum::<f32>() * 0.5
        };
        let by_root = toward(depth(legs) < depth(arms), depth(legs) > depth(arms));
        let apart = 0.1 * self.longest;
        let lower = height(arms) - height(legs);
        let by_height = toward(lower > apart, lower < -apart);
        let longer = legs.length / arms.length;
        let by_length = toward(longer > 1.1, longer < 0.9);
        by_root + 0.7 * by_height + 0.5 * by_length
    }

    /// Refuses what has more limbs than a person.
    fn check_count(
        &self,
        pairs: &[LimbPair],
        legs: &LimbPair,
        arms: Option<&LimbPair>,
    ) -> Result<(), NoAnatomy> {
        let is_same = |a: &LimbPair, b: &LimbPair| a.paths == b.paths;
        let [upper, _, lower] = self.landmarks(legs, Kind::Leg)?[0];
        let leg_length = self.at(upper).distance(self.at(lower));
        let is_named = legs.leg_names > 0;
        for pair in pairs {
            if is_same(pair, legs) || arms.is_some_and(|arms| is_same(pair, arms)) {
                continue;
            }
            let is_leg = pair.leg_names >= 3
                && pair.leg_names > pair.arm_names
                && pair.length > EXTRA_LEG_SHARE * leg_length;
            let is_limb =
                !is_named && pair.length > EXTRA_LIMB_SHARE * legs.length && pair.as_leg.is_some();
            let copies = pair.paths[0]
                .iter()
                .any(|&joint| self.at(joint).distance(self.at(lower)) < 0.05 * leg_length);
            if (is_leg || is_limb) && !copies {
                return Err(NoAnatomy::ManyLimbs);
            }
        }
        Ok(())
    }

    /// Upper, middle and lower joint of both limbs.
    fn landmarks(&self, pair: &LimbPair, kind: Kind) -> Result<[[JointId; 3]; 2], NoAnatomy> {
        let fit = match kind {
            Kind::Leg => pair.as_leg,
            Kind::Arm => pair.as_arm,
        };
        let fit = fit.ok_or(NoAnatomy::Contradiction)?;
        let of = |side: usize| {
            let bend = fit.bends[side];
            [bend.upper, bend.middle, bend.lower].map(|at| pair.paths[side][at])
        };
        Ok([of(0), of(1)])
    }

    fn assemble(&self, legs: &LimbPair, arms: Option<&LimbPair>) -> Result<Anatomy, NoAnatomy> {
        let pelvis = legs.hub;
        let Rise {
            trunk,
            climbed_count,
            head,
            head_is_named,
        } = self.rise(pelvis, legs, arms)?;
        let spine_count = self.spine_count(pelvis, &trunk, arms);
        let arms = match (arms, spine_count) {
            (Some(arms), Some(_)) => Some(arms),
            _ => None,
        };
        let spine_count = spine_count.unwrap_or_else(|| {
            let neck = trunk
                .iter()
                .position(|&joint| self.part(joint) == Some(Part::Neck));
            neck.unwrap_or(trunk.len())
        });
        let mut anatomy = Anatomy {
            pelvis,
            trunk,
            climbed_count,
            spine_count,
            head,
            legs: self.limbs(legs, Kind::Leg)?,
            arms: arms.map(|arms| self.limbs(arms, Kind::Arm)).transpose()?,
            certainty: self.certainty(legs, arms, head_is_named),
        };
        self.check_shape(&anatomy)?;
        self.put_sides_right(
            &mut anatomy,
            legs.has_sides,
            arms.is_none_or(|a| a.has_sides),
        );
        Ok(anatomy)
    }

    /// What leads from the pelvis to the head.
    fn rise(
        &self,
        pelvis: JointId,
        legs: &LimbPair,
        arms: Option<&LimbPair>,
    ) -> Result<Rise, NoAnatomy> {
        let above: BTreeSet<JointId> = std::iter::once(pelvis)
            .chain(self.skeleton.ancestors(pelvis))
            .collect();
        let inside: BTreeSet<JointId> = [Some(legs), arms]
            .into_iter()
            .flatten()
            .flat_map(|pair| pair.paths.iter().flatten().copied())
            .collect();
        let is_in_limb = |joint: JointId| {
            // Limbs are short; what hangs deeper than they are long is none of theirs.
            std::iter::once(joint)
                .chain(self.skeleton.ancestors(joint))
                .take(2 * STOPS_MAX)
                .any(|j| inside.contains(&j))
        };
        let named = self
            .skeleton
            .joints()
            .filter(|&joint| self.part(joint) == Some(Part::Head))
            .filter(|&joint| !self.skeleton.is_end_site(joint))
            .take(HEADS_MAX)
            .filter(|&joint| !above.contains(&joint) && !is_in_limb(joint))
            .min_by_key(|&joint| (self.depths[joint.index()], joint));
        let head_is_named = named.is_some();
        let head = named
            .or_else(|| {
                let hub = arms.map_or(pelvis, |arms| arms.hub);
                self.unnamed_head(hub, &inside, legs.length)
            })
            .ok_or(NoAnatomy::NoHead)?;
        let top = self.meeting(pelvis, head).ok_or(NoAnatomy::InPieces)?;
        let mut trunk: Vec<JointId> = Vec::new();
        if top != pelvis {
            let climb = self.skeleton.ancestors(pelvis);
            trunk.extend(climb.take_while(|&j| j != top));
            trunk.push(top);
            // A joint that only holds spine and pelvis together, at one place or from below as the
            // centre of a figure does, is none of the spine's.
            let from_pelvis = self.at(top) - self.at(pelvis);
            let is_near = from_pelvis.length() < 0.1 * legs.length;
            let is_below = from_pelvis.dot(self.at(head) - self.at(pelvis)) < 0.0;
            if trunk.len() == 1 && (is_near || is_below && self.part(top).is_none()) {
                trunk.clear();
            }
        }
        let climbed_count = trunk.len();
        let down = self.path_down(top, head);
        trunk.extend(down.iter().take(down.len().saturating_sub(1)));
        Ok(Rise {
            trunk,
            climbed_count,
            head,
            head_is_named,
        })
    }

    /// The last joint that turns on the longest way from the shoulders that is in no limb.
    fn unnamed_head(
        &self,
        hub: JointId,
        inside: &BTreeSet<JointId>,
        leg_length: f32,
    ) -> Option<JointId> {
        let first = self
            .skeleton
            .children(hub)
            .iter()
            .copied()
            .filter(|child| !inside.contains(child))
            .filter(|&child| !self.readings[child.index()].is_control)
            .max_by(|&a, &b| {
                let length = |j: JointId| self.reach[j.index()] + self.length(j);
                length(a).total_cmp(&length(b))
            })?;
        let path: Vec<JointId> = self.main_path(first).take(STOPS_MAX).collect();
        if path.len() == STOPS_MAX {
            return None;
        }
        let turning: Vec<JointId> = path
            .iter()
            .copied()
            .filter(|&j| !self.skeleton.is_end_site(j) && !self.readings[j.index()].is_end)
            .collect();
        let &last = turning.last()?;
        let before = turning.len().checked_sub(2).map(|at| turning[at]);
        // A last bone as long as a skull, and longer than the one before, ends in the crown.
        let length = self.length(last);
        let is_crown = length > SKULL_SHARE * leg_length
            && before.is_some_and(|before| length > 1.5 * self.length(before));
        if is_crown { before } else { Some(last) }
    }

    /// How many joints of the trunk are below the neck; `None` where the arms hang from something
    /// that is no part of the trunk.
    fn spine_count(
        &self,
        pelvis: JointId,
        trunk: &[JointId],
        arms: Option<&LimbPair>,
    ) -> Option<usize> {
        let hub = arms?.hub;
        let place = |joint: JointId| {
            if joint == pelvis {
                return Some(0);
            }
            trunk.iter().position(|&j| j == joint).map(|at| at + 1)
        };
        // The arms may hang from a joint beside the spine.
        let beside = std::iter::once(hub)
            .chain(self.skeleton.ancestors(hub))
            .take(STOPS_MAX)
            .find_map(place)?;
        // Arms that leave the spine below its last joint.
        let more = trunk[beside..]
            .iter()
            .take_while(|&&joint| self.part(joint) == Some(Part::Spine))
            .count();
        Some(beside + more)
    }

    fn limbs(&self, pair: &LimbPair, kind: Kind) -> Result<[Limb; 2], NoAnatomy> {
        let landmarks = self.landmarks(pair, kind)?;
        let limb = |side: Side| {
            let path = &pair.paths[side as usize];
            let [upper, middle, lower] = landmarks[side as usize];
            let place = |joint: JointId| path.iter().position(|&j| j == joint).unwrap_or(0);
            let least = 0.08 * self.at(middle).distance(self.at(lower));
            let tip = path[place(lower) + 1..]
                .iter()
                .copied()
                .find(|&j| self.at(j).distance(self.at(lower)) > least);
            Limb {
                side,
                root: path[..place(upper)].to_vec(),
                upper,
                middle,
                lower,
                tip,
                end: path.last().copied().unwrap_or(lower),
            }
        };
        Ok(Side::BOTH.map(limb))
    }

    fn certainty(
        &self,
        legs: &LimbPair,
        arms: Option<&LimbPair>,
        head_is_named: bool,
    ) -> Certainty {
        let is_sure =
            |fit: Option<Fit>| fit.is_some_and(|fit| fit.named_count == 3 && fit.shape_agrees);
        let is_sure =
            head_is_named && is_sure(legs.as_leg) && arms.is_none_or(|arms| is_sure(arms.as_arm));
        if is_sure {
            Certainty::Sure
        } else {
            Certainty::Likely
        }
    }
}
