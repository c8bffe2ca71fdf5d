//! Which joints are a figure's legs, arms, trunk and head.
//!
//! A humanoid is recognised from its shape in a reference pose and, where they help, from its joint
//! names: two legs that meet in the pelvis, a trunk that rises from there to a head, two arms that
//! leave the trunk. Within a leg or an arm the two longest bones are thigh and shin, upper arm and
//! forearm, whatever their names: "shoulder" is a collar bone to some and an upper arm to others.

use glam::{Quat, Vec3};

use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton};

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// The figure's own left.
    Left,
    /// The figure's own right.
    Right,
}

/// A leg or an arm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limb {
    /// Whose side.
    pub side: Side,
    /// Joints between the trunk and the upper bone: collar bones, hip joints of no length.
    pub root: Vec<JointId>,
    /// Where the upper bone starts: hip or shoulder.
    pub upper: JointId,
    /// Knee or elbow.
    pub middle: JointId,
    /// Ankle or wrist.
    pub lower: JointId,
    /// The joint of the toes, if there is one with a length before it; for an arm the longest
    /// finger's.
    pub tip: Option<JointId>,
    /// The last joint of the limb.
    pub end: JointId,
}

/// The parts of a humanoid.
#[derive(Clone, Debug, PartialEq)]
pub struct Anatomy {
    /// Where the legs meet.
    pub pelvis: JointId,
    /// From the pelvis (excluded) to the joint before the head (included).
    pub trunk: Vec<JointId>,
    /// How many of `trunk` lie below the neck; the last of those carries the shoulders.
    pub spine_count: usize,
    /// The head's joint.
    pub head: JointId,
    /// Left and right leg.
    pub legs: [Limb; 2],
    /// Left and right arm; a figure may have none.
    pub arms: Option<[Limb; 2]>,
    /// The figure's directions in the reference pose, world space: its left, up and forward.
    pub left: Vec3,
    /// Up along the trunk, made perpendicular to `left`.
    pub up: Vec3,
    /// Where it faces.
    pub forward: Vec3,
}

impl Anatomy {
    /// Finds the parts in a skeleton, `None` if it is no humanoid.
    ///
    /// # Panics
    /// If the pose does not have as many joints as the skeleton.
    #[must_use]
    pub fn find(skeleton: &Skeleton, reference: &GlobalPose) -> Option<Self> {
        assert_eq!(
            reference.joint_count(),
            skeleton.joint_count(),
            "a pose of this skeleton"
        );
        let tree = Tree {
            skeleton,
            pose: reference,
        };
        let leaves = tree.leaves();
        let legs = tree.leg_leaves(&leaves)?;
        let pelvis = tree.meeting(legs[0], legs[1])?;
        let head_leaf = tree.head_leaf(&leaves, pelvis, legs)?;
        let rising = tree.path(pelvis, head_leaf);
        let head_at = tree.head_index(&rising)?;
        let (trunk, head) = (rising[..head_at].to_vec(), rising[head_at]);
        let legs = [
            tree.limb(&tree.path(pelvis, legs[0]), Side::Left)?,
            tree.limb(&tree.path(pelvis, legs[1]), Side::Right)?,
        ];
        if tree.has_more_legs(&leaves, &legs) {
            return None;
        }
        let arms = tree.arms(&leaves, pelvis, &trunk, head);
        let on_all_fours = arms
            .as_ref()
            .is_some_and(|arms| tree.on_all_fours(&legs, arms));
        if on_all_fours && tree.lies(pelvis, head) {
            return None;
        }
        let spine_count = arms
            .as_ref()
            .map_or(trunk.len(), |arms| tree.spine_count(&trunk, arms));
        let (left, up, forward) = tree.directions(pelvis, head, &legs)?;
        Some(Self {
            pelvis,
            trunk,
            spine_count,
            head,
            legs,
            arms,
            left,
            up,
            forward,
        })
    }

    /// Whether the figure stands upright in the pose: head over pelvis over feet.
    #[must_use]
    pub fn stands(&self, pose: &GlobalPose) -> bool {
        let at = |joint: JointId| pose.positions[joint.index()];
        let trunk = at(self.head) - at(self.pelvis);
        let upright = |v: Vec3| v.y > 0.75 * v.length();
        upright(trunk)
            && self
                .legs
                .iter()
                .all(|leg| upright(at(leg.upper) - at(leg.lower)))
    }
}

/// The turn about Y that takes +Z to the horizontal direction nearest to `forward`.
pub(crate) fn facing(forward: Vec3) -> Quat {
    let yaw = libm::atan2f(forward.x, forward.z);
    let (sin, cos) = libm::sincosf(yaw * 0.5);
    Quat::from_xyzw(0.0, sin, 0.0, cos)
}

struct Tree<'a> {
    skeleton: &'a Skeleton,
    pose: &'a GlobalPose,
}

const LEG_WORDS: &[&str] = &[
    "leg", "thigh", "knee", "shin", "calf", "ankle", "foot", "toe", "hip",
];
const ARM_WORDS: &[&str] = &[
    "arm", "elbow", "wrist", "hand", "shoulder", "clavicle", "collar", "finger", "thumb", "index",
    "palm",
];
const MIDDLE_WORDS: &[&str] = &[
    "elbow",
    "forearm",
    "fore_arm",
    "lowerarm",
    "lower_arm",
    "knee",
    "shin",
    "calf",
    "lowerleg",
];
/// "hip" is in "hips".
const NO_LIMB_WORDS: &[&str] = &["hips", "pelvis", "spine"];
const HEAD_WORDS: &[&str] = &["head", "skull"];
const NECK_WORDS: &[&str] = &["neck"];

impl Tree<'_> {
    fn at(&self, joint: JointId) -> Vec3 {
        self.pose.positions[joint.index()]
    }

    fn named(&self, joint: JointId, words: &[&str]) -> bool {
        let name = self.skeleton.name(joint).to_ascii_lowercase();
        words.iter().any(|word| name.contains(word))
    }

    fn leaves(&self) -> Vec<JointId> {
        self.skeleton
            .joints()
            .filter(|&j| self.skeleton.children(j).is_empty())
            .collect()
    }

    /// The joints above `joint`, itself first, up to the root.
    fn climb(&self, joint: JointId) -> Vec<JointId> {
        std::iter::once(joint)
            .chain(self.skeleton.ancestors(joint))
            .collect()
    }

    /// From `top` (excluded) down to `leaf` (included).
    fn path(&self, top: JointId, leaf: JointId) -> Vec<JointId> {
        let mut path: Vec<_> = self
            .climb(leaf)
            .into_iter()
            .take_while(|&j| j != top)
            .collect();
        path.reverse();
        path
    }

    /// The lowest joint above both.
    fn meeting(&self, a: JointId, b: JointId) -> Option<JointId> {
        let above = self.climb(a);
        self.climb(b).into_iter().find(|j| above.contains(j))
    }

    /// The unbranched joints above a leaf say best what it belongs to.
    fn leaf_is(&self, leaf: JointId, words: &[&str]) -> bool {
        self.climb(leaf)
            .into_iter()
            .take(4)
            .filter(|&j| !self.skeleton.is_end_site(j))
            .any(|j| self.named(j, words) && !self.named(j, &["spine", "hips", "pelvis"]))
    }

    /// The longest leg of either side, left first.
    fn leg_leaves(&self, leaves: &[JointId]) -> Option<[JointId; 2]> {
        let mut named: Vec<JointId> = leaves
            .iter()
            .copied()
            .filter(|&leaf| self.leaf_is(leaf, LEG_WORDS) && !self.leaf_is(leaf, ARM_WORDS))
            .collect();
        if named.len() < 2 {
            named = leaves.to_vec();
        }
        let lowest = |a: &&JointId, b: &&JointId| self.at(**a).y.total_cmp(&self.at(**b).y);
        let with_side = |side: Side| {
            named
                .iter()
                .copied()
                .filter(|&leaf| self.side(leaf) == Some(side))
                .max_by(|&a, &b| self.climbed_length(a).total_cmp(&self.climbed_length(b)))
        };
        if let (Some(left), Some(right)) = (with_side(Side::Left), with_side(Side::Right)) {
            return Some([left, right]);
        }
        // No sides in the names: the two lowest leaves, if they are apart.
        let first = *named.iter().min_by(lowest)?;
        let second = *named
            .iter()
            .filter(|&&leaf| self.meeting(leaf, first) != self.skeleton.parent(first))
            .min_by(lowest)?;
        let is_left = self.at(first).x >= self.at(second).x;
        Some(if is_left {
            [first, second]
        } else {
            [second, first]
        })
    }

    fn climbed_length(&self, leaf: JointId) -> f32 {
        let path = self.climb(leaf);
        path.windows(2)
            .map(|pair| self.at(pair[0]).distance(self.at(pair[1])))
            .sum()
    }

    /// The side that the names of a leaf and the joints above it say.
    fn side(&self, leaf: JointId) -> Option<Side> {
        side_of_joint(self.skeleton, leaf)
    }

    fn head_leaf(
        &self,
        leaves: &[JointId],
        pelvis: JointId,
        legs: [JointId; 2],
    ) -> Option<JointId> {
        let under_pelvis = |leaf: JointId| {
            self.climb(leaf).contains(&pelvis)
                && legs
                    .iter()
                    .all(|&leg| self.meeting(leaf, leg) == Some(pelvis))
        };
        let candidates: Vec<JointId> = leaves
            .iter()
            .copied()
            .filter(|&leaf| under_pelvis(leaf))
            .collect();
        let named = candidates
            .iter()
            .copied()
            .filter(|&leaf| self.leaf_is(leaf, HEAD_WORDS));
        let highest = |a: &JointId, b: &JointId| self.at(*a).y.total_cmp(&self.at(*b).y);
        named.max_by(highest).or_else(|| {
            let middle = candidates
                .iter()
                .copied()
                .filter(|&leaf| self.side(leaf).is_none());
            middle.max_by(highest)
        })
    }

    /// Where on the way up from the pelvis the head's joint is.
    fn head_index(&self, rising: &[JointId]) -> Option<usize> {
        let named = rising
            .iter()
            .position(|&j| self.named(j, HEAD_WORDS) && !self.skeleton.is_end_site(j));
        // Without a name: the last joint that can turn.
        named
            .or_else(|| rising.iter().rposition(|&j| !self.skeleton.is_end_site(j)))
            .filter(|&index| index > 0)
    }

    fn limb(&self, path: &[JointId], side: Side) -> Option<Limb> {
        let length = |i: usize| self.at(path[i]).distance(self.at(path[i - 1]));
        // Thigh and shin: neighbours, up to joints of no length, with the largest sum.
        let solid: Vec<usize> = (1..path.len()).filter(|&i| length(i) > 0.0).collect();
        // The joint in their middle has a name of its own in most files.
        let named = (solid
            .iter()
            .skip(1)
            .position(|&i| self.named(path[i - 1], MIDDLE_WORDS)))
        .map(|at| [solid[at], solid[at + 1]]);
        // A fourth bone is a collar bone, which can be as long as a forearm but comes first.
        let skip = usize::from(solid.len() >= 4);
        let longest = solid[skip..].windows(2).max_by(|a, b| {
            let shorter = |w: &[usize]| length(w[0]).min(length(w[1]));
            shorter(a).total_cmp(&shorter(b))
        });
        let best = named.or_else(|| longest.map(|w| [w[0], w[1]]))?;
        let (upper, middle, lower) = (best[0] - 1, best[1] - 1, best[1]);
        let least = 0.08 * length(best[1]);
        let tip = (lower + 1..path.len())
            .find(|&i| self.at(path[i]).distance(self.at(path[lower])) > least);
        Some(Limb {
            side,
            root: path[..upper].to_vec(),
            upper: path[upper],
            middle: path[middle],
            lower: path[lower],
            tip: tip.map(|i| path[i]),
            end: *path.last()?,
        })
    }

    /// Whether limbs of some length besides the two legs are called legs: no humanoid.
    fn has_more_legs(&self, leaves: &[JointId], legs: &[Limb; 2]) -> bool {
        let starts = legs
            .each_ref()
            .map(|leg| *leg.root.first().unwrap_or(&leg.upper));
        let shortest = legs
            .iter()
            .map(|leg| {
                let (hip, knee) = (self.at(leg.upper), self.at(leg.middle));
                hip.distance(knee) + knee.distance(self.at(leg.lower))
            })
            .fold(f32::INFINITY, f32::min);
        leaves.iter().any(|&leaf| {
            let climb = self.climb(leaf);
            let named: Vec<JointId> = climb
                .iter()
                .copied()
                .filter(|&j| self.named(j, LEG_WORDS) && !self.named(j, NO_LIMB_WORDS))
                .collect();
            let length: f32 = named
                .windows(2)
                .map(|pair| self.at(pair[0]).distance(self.at(pair[1])))
                .sum();
            let is_own = climb.iter().any(|j| starts.contains(j));
            !is_own && named.len() >= 3 && length > 0.4 * shortest
        })
    }

    /// Whether the hands are about as low as the feet.
    fn on_all_fours(&self, legs: &[Limb; 2], arms: &[Limb; 2]) -> bool {
        let lowest = |limbs: &[Limb; 2]| {
            let ends = limbs.iter().map(|limb| self.at(limb.end).y);
            ends.fold(f32::INFINITY, f32::min)
        };
        let height = self.at(legs[0].upper).y - lowest(legs);
        lowest(arms) - lowest(legs) < 0.2 * height
    }

    /// Whether the trunk is nearer to the horizontal than to the vertical.
    fn lies(&self, pelvis: JointId, head: JointId) -> bool {
        let trunk = self.at(head) - self.at(pelvis);
        trunk.y < 0.6 * trunk.length()
    }

    /// The longest path down from the trunk on either side.
    fn arms(
        &self,
        leaves: &[JointId],
        pelvis: JointId,
        trunk: &[JointId],
        head: JointId,
    ) -> Option<[Limb; 2]> {
        let branch = |leaf: JointId| {
            let path = self.climb(leaf);
            let at = path.iter().position(|j| trunk.contains(j))?;
            let inside = path[..at].contains(&head) || at == 0 || path[at] == pelvis;
            (!inside).then(|| path[at])
        };
        let long_enough = |path: &[JointId]| path.len() >= 3;
        let of_side = |side: Side| {
            leaves
                .iter()
                .copied()
                .filter(|&leaf| self.side(leaf) == Some(side))
                .filter_map(|leaf| Some(self.path(branch(leaf)?, leaf)))
                .filter(|path| long_enough(path))
                .max_by(|a, b| {
                    let length = |p: &[JointId]| {
                        p.windows(2)
                            .map(|w| self.at(w[0]).distance(self.at(w[1])))
                            .sum::<f32>()
                    };
                    length(a).total_cmp(&length(b))
                })
        };
        let (left, right) = (of_side(Side::Left)?, of_side(Side::Right)?);
        Some([
            self.limb(&left, Side::Left)?,
            self.limb(&right, Side::Right)?,
        ])
    }

    /// How many joints of the trunk are below the neck.
    fn spine_count(&self, trunk: &[JointId], arms: &[Limb; 2]) -> usize {
        let carrier = arms[0]
            .root
            .first()
            .or(Some(&arms[0].upper))
            .and_then(|&first| self.skeleton.parent(first));
        let by_arms = carrier
            .and_then(|c| trunk.iter().position(|&j| j == c))
            .map(|i| i + 1);
        let by_name = trunk.iter().position(|&j| self.named(j, NECK_WORDS));
        by_arms
            .or(by_name)
            .unwrap_or(trunk.len())
            .clamp(1, trunk.len())
    }

    fn directions(
        &self,
        pelvis: JointId,
        head: JointId,
        legs: &[Limb; 2],
    ) -> Option<(Vec3, Vec3, Vec3)> {
        let left = (self.at(legs[0].upper) - self.at(legs[1].upper)).try_normalize()?;
        let rise = self.at(head) - self.at(pelvis);
        let up = (rise - left * rise.dot(left)).try_normalize()?;
        Some((left, up, left.cross(up)))
    }
}

/// The side that a joint's name says, or the nearest name above it that says one.
pub(crate) fn side_of_joint(skeleton: &Skeleton, joint: JointId) -> Option<Side> {
    std::iter::once(joint)
        .chain(skeleton.ancestors(joint))
        .find_map(|above| side_of_name(skeleton.name(above)))
}

/// The side that a joint's name says: `LeftArm`, `l_arm`, `Arm.L`, `lHip`, `RThumb`.
pub(crate) fn side_of_name(name: &str) -> Option<Side> {
    let name = name.rsplit(':').next().unwrap_or(name);
    let lower = name.to_ascii_lowercase();
    if lower.contains("left") {
        return Some(Side::Left);
    }
    if lower.contains("right") {
        return Some(Side::Right);
    }
    let side_of_letter = |letter: char| match letter.to_ascii_lowercase() {
        'l' => Some(Side::Left),
        'r' => Some(Side::Right),
        _ => None,
    };
    let words = name.split(|c: char| !c.is_alphanumeric());
    let single = words
        .filter(|word| word.len() == 1)
        .find_map(|word| side_of_letter(word.chars().next()?));
    single.or_else(|| {
        // A lone letter before a capital: lHip, RThumb.
        let mut letters = name.chars();
        let (first, second) = (letters.next()?, letters.next()?);
        second
            .is_uppercase()
            .then(|| side_of_letter(first))
            .flatten()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_read_from_the_names_people_use() {
        for name in [
            "LeftArm",
            "lHip",
            "LThumb",
            "Hand_L",
            "arm.l",
            "mixamorig:LeftFoot",
            "l_toe",
        ] {
            assert_eq!(side_of_name(name), Some(Side::Left), "{name}");
        }
        for name in [
            "RightUpLeg",
            "rTorso_Clavicle",
            "RHipJoint",
            "Foot.R",
            "Bip01 R Thigh",
        ] {
            assert_eq!(side_of_name(name), Some(Side::Right), "{name}");
        }
        for name in [
            "Hips",
            "Spine",
            "RootJoint",
            "LowerBack",
            "Neck1",
            "Head",
            "root",
            "",
        ] {
            assert_eq!(side_of_name(name), None, "{name}");
        }
    }
}
