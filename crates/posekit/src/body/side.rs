//! Sides of the body.

use crate::skeleton::{JointId, Skeleton};

use super::name::{without_namespace, words};

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

/// The side that a joint's name says: `LeftArm`, `l_arm`, `Arm.L`, `lHip`, `RThumb`.
pub fn side_of_name(name: &str) -> Option<Side> {
    let name = without_namespace(name);
    let words = words(name);
    let side_of = |word: &str| match word {
        "left" | "l" => Some(Side::Left),
        "right" | "r" => Some(Side::Right),
        _ => None,
    };
    let glued = |word: &String| {
        [("left", Side::Left), ("right", Side::Right)]
            .into_iter()
            .find(|(side, _)| word.starts_with(side) || word.ends_with(side))
            .map(|(_, side)| side)
    };
    let plain = words.iter().find_map(|word| side_of(word));
    plain.or_else(|| words.iter().find_map(glued))
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
            "RIBS",
            "",
        ] {
            assert_eq!(side_of_name(name), None, "{name}");
        }
    }
}
