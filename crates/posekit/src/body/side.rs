//! Sides of the body.

use crate::skeleton::{JointId, Skeleton};

use super::name::{is_vertebra, without_namespace, words};

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// The figure's own left.
    Left,
    /// The figure's own right.
    Right,
}

impl Side {
    /// Both, left first: the order of everything that comes in pairs.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];
}

/// The side that a joint's name says, or the nearest name above it that says one.
///
/// Cost: a climb to the root at worst; [`sides`] answers for all joints at once.
pub fn side_of_joint(skeleton: &Skeleton, joint: JointId) -> Option<Side> {
    std::iter::once(joint)
        .chain(skeleton.ancestors(joint))
        .find_map(|above| side_of_name(skeleton.name(above)))
}

/// The side of every joint, by names as [`side_of_joint`].
pub fn sides(skeleton: &Skeleton) -> Vec<Option<Side>> {
    let mut sides: Vec<Option<Side>> = Vec::with_capacity(skeleton.joint_count());
    for joint in skeleton.joints() {
        let above = skeleton.parent(joint).and_then(|p| sides[p.index()]);
        sides.push(side_of_name(skeleton.name(joint)).or(above));
    }
    sides
}

/// The side that a joint's name says: `LeftArm`, `l_arm`, `Arm.L`, `lHip`, `RThumb`, `LUArm`, `左腕`.
pub fn side_of_name(name: &str) -> Option<Side> {
    let name = without_namespace(name);
    if is_vertebra(name) {
        return None;
    }
    let words = words(name);
    let side_of = |word: &str| match word {
        "left" | "l" | "左" => Some(Side::Left),
        "right" | "r" | "右" => Some(Side::Right),
        _ => None,
    };
    let glued = |word: &String| {
        [
            ("left", Side::Left),
            ("right", Side::Right),
            ("左", Side::Left),
            ("右", Side::Right),
        ]
        .into_iter()
        .find(|(side, _)| word.starts_with(side) || word.ends_with(side))
        .map(|(_, side)| side)
    };
    let plain = words.iter().find_map(|word| side_of(word));
    plain
        .or_else(|| words.iter().find_map(glued))
        .or_else(|| side_of_initials(name))
}

/// Two initials before a word, `LUArm` and `RFArm`: the side, then upper or lower, fore or hind.
fn side_of_initials(name: &str) -> Option<Side> {
    let mut letters = name.chars();
    let side = match letters.next()? {
        'L' => Side::Left,
        'R' => Side::Right,
        _ => return None,
    };
    let is_initial = letters.next().is_some_and(|c| "ULFBH".contains(c));
    let is_word = letters.next().is_some_and(char::is_uppercase)
        && letters.next().is_some_and(char::is_lowercase);
    (is_initial && is_word).then_some(side)
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
            "leftfoot",
            "J_Bip_L_Hand",
            "footLeft",
            "LUArm",
            "左足首",
        ] {
            assert_eq!(side_of_name(name), Some(Side::Left), "{name}");
        }
        for name in [
            "RightUpLeg",
            "rTorso_Clavicle",
            "RHipJoint",
            "Foot.R",
            "Bip01 R Thigh",
            "RFArm",
            "右ひじ",
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
            "RIBS",
            "L5",
            "LODMesh",
            "",
        ] {
            assert_eq!(side_of_name(name), None, "{name}");
        }
    }
}
