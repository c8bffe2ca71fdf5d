//! The side that a joint's name says, and the name without it.
//!
//! A name may be read in more than one way (`Lower_L`): the side is believed only when a joint
//! exists that differs in it alone, so `lowerback`, `Lumbar` and `Root` belong to no side unless
//! something is called `rowerback`, `Rumbar` or `Loot`.

/// Left or right, as the figure itself would say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    Left = 0,
    Right = 1,
}

/// How plainly a name says its side, the plainest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Strength {
    /// A word of its own: `LeftUpLeg`, `arm_right`, `Right Shoulder`.
    Word,
    /// A letter of its own: `L_Hip`, `hand.l`, `Bip01 R Thigh`, `lHip`, `RThumb`, `FootL`.
    Letter,
    /// A word at the start or the end of another one: `leftarm`, `footright`, `左足`.
    GluedWord,
    /// A letter at the start of a word: `lfemur`, `RHUMERUS`. Acclaim files write sides like this.
    GluedLetter,
}

impl Strength {
    pub(super) const ALL: [Self; 4] =
        [Self::Word, Self::Letter, Self::GluedWord, Self::GluedLetter];
}

/// Stands in a stem for the side that was taken out; no name contains it by accident.
const SIDE_MARK: char = '\u{0}';

/// All readings of a name at one strength: the side, and the stem that the other side shares.
/// Stems are in lower case, because files mix `leftArm` and `RightArm`.
pub(super) fn readings(name: &str, strength: Strength) -> Vec<(Side, String)> {
    let words = words(name);
    let found = words.iter().filter_map(|&(start, end)| {
        let (side, from, to) = side_of_word(&name[start..end], strength)?;
        Some((side, stem(name, start + from, start + to)))
    });
    found.collect()
}

/// The side in a word at this strength, and the bytes of the word that say it.
fn side_of_word(word: &str, strength: Strength) -> Option<(Side, usize, usize)> {
    let lower = word.to_ascii_lowercase();
    let sides = [
        (Side::Left, "left", "l"),
        (Side::Right, "right", "r"),
        (Side::Left, "左", "左"),
        (Side::Right, "右", "右"),
    ];
    sides.into_iter().find_map(|(side, long, short)| {
        let (from, to) = match strength {
            Strength::Word => (lower == long).then_some((0, long.len())),
            Strength::Letter => (lower == short).then_some((0, short.len())),
            Strength::GluedWord if lower.len() <= long.len() => None,
            Strength::GluedWord if lower.starts_with(long) => Some((0, long.len())),
            Strength::GluedWord => lower
                .ends_with(long)
                .then_some((lower.len() - long.len(), lower.len())),
            Strength::GluedLetter => {
                (lower.len() > short.len() && lower.starts_with(short)).then_some((0, short.len()))
            }
        }?;
        Some((side, from, to))
    })
}

fn stem(name: &str, from: usize, to: usize) -> String {
    let mut stem = name[..from].to_lowercase();
    stem.push(SIDE_MARK);
    stem.push_str(&name[to..].to_lowercase());
    stem
}

/// The words of a name as byte ranges: cut at everything that is not a letter, before a capital
/// that follows a small letter (`lHip`), and before the last of several capitals that a small
/// letter follows (`LHipJoint`).
fn words(name: &str) -> Vec<(usize, usize)> {
    let letters: Vec<(usize, char)> = name.char_indices().collect();
    let mut words = Vec::new();
    let mut start = None;
    for (place, &(at, letter)) in letters.iter().enumerate() {
        if !letter.is_alphabetic() {
            words.extend(start.take().map(|start| (start, at)));
            continue;
        }
        let before = place.checked_sub(1).map(|place| letters[place].1);
        let after = letters.get(place + 1).map(|&(_, letter)| letter);
        let after_small = before.is_some_and(char::is_lowercase);
        let before_small = after.is_some_and(char::is_lowercase);
        let after_capital = before.is_some_and(char::is_uppercase);
        let begins = letter.is_uppercase() && (after_small || (after_capital && before_small));
        if begins {
            words.extend(start.take().map(|start| (start, at)));
        }
        start.get_or_insert(at);
    }
    words.extend(start.map(|start| (start, name.len())));
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(name: &str) -> Vec<&str> {
        words(name).iter().map(|&(a, b)| &name[a..b]).collect()
    }

    #[test]
    fn names_are_cut_into_words() {
        assert_eq!(split("lHip"), ["l", "Hip"]);
        assert_eq!(split("LHipJoint"), ["L", "Hip", "Joint"]);
        assert_eq!(
            split("mixamorig:LeftUpLeg1"),
            ["mixamorig", "Left", "Up", "Leg"]
        );
        assert_eq!(split("DEF-upper_arm.L.001"), ["DEF", "upper", "arm", "L"]);
        assert_eq!(split("Bip01 R Thigh"), ["Bip", "R", "Thigh"]);
        assert_eq!(split("LHIP"), ["LHIP"]);
        assert_eq!(split("côtéGauche"), ["côté", "Gauche"]);
        assert!(split("").is_empty());
    }

    #[test]
    fn both_sides_of_a_name_share_a_stem() {
        let pairs = [
            ("LeftUpLeg", "RightUpLeg", Strength::Word),
            ("leg_left", "LEG_RIGHT", Strength::Word),
            ("UpperLeg_L", "UpperLeg_R", Strength::Letter),
            ("lTorso_Clavicle", "rTorso_Clavicle", Strength::Letter),
            ("L Thigh", "R Thigh", Strength::Letter),
            ("handslot.l", "handslot.r", Strength::Letter),
            ("ring_04_leaf_l", "ring_04_leaf_r", Strength::Letter),
            ("leftfoot", "rightfoot", Strength::GluedWord),
            ("armleft", "armright", Strength::GluedWord),
            ("左足", "右足", Strength::GluedWord),
            ("lfemur", "rfemur", Strength::GluedLetter),
        ];
        for (left, right, strength) in pairs {
            let (lefts, rights) = (readings(left, strength), readings(right, strength));
            assert_eq!(lefts.len(), 1, "{left}");
            assert_eq!((lefts[0].0, rights[0].0), (Side::Left, Side::Right));
            assert_eq!(lefts[0].1, rights[0].1, "{left} and {right}");
        }
    }

    #[test]
    fn a_trunk_name_says_no_side_plainly() {
        for name in [
            "lowerback",
            "Lumbar",
            "Root",
            "pelvis_lowerback",
            "Ribs",
            "torso_head",
        ] {
            assert!(readings(name, Strength::Word).is_empty(), "{name}");
            assert!(readings(name, Strength::Letter).is_empty(), "{name}");
            assert!(readings(name, Strength::GluedWord).is_empty(), "{name}");
        }
    }
}
