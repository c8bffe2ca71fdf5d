//! What a joint's name says: which part of a body it is.
//!
//! Files name joints after the joint (`lKnee`) or after the bone that starts there (`LeftShin`,
//! `calf_l`), with prefixes, sides and numbers around it. A name is cut into words, sides are
//! dropped, and the term that ends last decides: `LeftHandIndex1` is a finger, `torso_head` a head.

/// A part of a body that a name may mean; the joint is where the part begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Pelvis,
    Spine,
    Neck,
    Head,
    Face,
    Collar,
    /// A collar bone to some, an upper arm to others.
    Shoulder,
    UpperArm,
    /// An upper arm, mostly, beside a `ForeArm`.
    Arm,
    Forearm,
    Wrist,
    Hand,
    Finger,
    /// A thigh to most, a joint of its own before it to CMU.
    Hip,
    HipJoint,
    Thigh,
    /// A shin below an `UpLeg`, a thigh above a `Knee`.
    Leg,
    Shin,
    Ankle,
    Foot,
    Toe,
}

impl Part {
    pub(super) const fn is_leg(self) -> bool {
        matches!(
            self,
            Self::Hip
                | Self::HipJoint
                | Self::Thigh
                | Self::Leg
                | Self::Shin
                | Self::Ankle
                | Self::Foot
                | Self::Toe
        )
    }

    pub(super) const fn is_arm(self) -> bool {
        matches!(
            self,
            Self::Collar
                | Self::Shoulder
                | Self::UpperArm
                | Self::Arm
                | Self::Forearm
                | Self::Wrist
                | Self::Hand
                | Self::Finger
        )
    }
}

/// What a name says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Reading {
    /// The part, if the name has a word for one.
    pub(super) part: Option<Part>,
    /// It only marks where a part ends: `HeadTop_End`, `Toe0Nub`.
    pub(super) is_end: bool,
    /// It shares a bone's turn about its length: `thigh_twist_01_l`, `LeftArmRoll`.
    pub(super) is_twist: bool,
    /// It steers a rig and is no bone: `ik_foot_l`, `kneeIK.l`.
    pub(super) is_control: bool,
}

impl Reading {
    /// The part, of a joint that is a bone of the body.
    pub(super) fn bone(self) -> Option<Part> {
        self.part.filter(|_| !self.is_end && !self.is_control)
    }
}

/// Terms that count wherever they stand in a name, words run together.
const TERMS: &[(&str, Part)] = &[
    ("pelvis", Part::Pelvis),
    ("hips", Part::Pelvis),
    ("hip", Part::Hip),
    ("hipjoint", Part::HipJoint),
    ("buttock", Part::HipJoint),
    ("spine", Part::Spine),
    ("chest", Part::Spine),
    ("torso", Part::Spine),
    ("thorax", Part::Spine),
    ("abdomen", Part::Spine),
    ("lowerback", Part::Spine),
    ("upperback", Part::Spine),
    ("lumbar", Part::Spine),
    ("waist", Part::Spine),
    ("belly", Part::Spine),
    ("neck", Part::Neck),
    ("head", Part::Head),
    ("skull", Part::Head),
    ("eye", Part::Face),
    ("jaw", Part::Face),
    ("tongue", Part::Face),
    ("teeth", Part::Face),
    ("hair", Part::Face),
    ("cheek", Part::Face),
    ("nose", Part::Face),
    ("clavicle", Part::Collar),
    ("collar", Part::Collar),
    ("shoulder", Part::Shoulder),
    ("shldr", Part::Shoulder),
    ("upperarm", Part::UpperArm),
    ("uparm", Part::UpperArm),
    ("uarm", Part::UpperArm),
    ("armupper", Part::UpperArm),
    ("humerus", Part::UpperArm),
    ("arm", Part::Arm),
    ("forearm", Part::Forearm),
    ("farm", Part::Forearm),
    ("lowerarm", Part::Forearm),
    ("lowarm", Part::Forearm),
    ("loarm", Part::Forearm),
    ("armlower", Part::Forearm),
    ("elbow", Part::Forearm),
    ("radius", Part::Forearm),
    ("ulna", Part::Forearm),
    ("wrist", Part::Wrist),
    ("hand", Part::Hand),
    ("thumb", Part::Finger),
    ("index", Part::Finger),
    ("pinky", Part::Finger),
    ("finger", Part::Finger),
    ("knuckle", Part::Finger),
    ("carpal", Part::Finger),
    ("palm", Part::Finger),
    ("thigh", Part::Thigh),
    ("upleg", Part::Thigh),
    ("upperleg", Part::Thigh),
    ("legupper", Part::Thigh),
    ("femur", Part::Thigh),
    ("leg", Part::Leg),
    ("shin", Part::Shin),
    ("shank", Part::Shin),
    ("calf", Part::Shin),
    ("knee", Part::Shin),
    ("lowerleg", Part::Shin),
    ("lowleg", Part::Shin),
    ("loleg", Part::Shin),
    ("leglower", Part::Shin),
    ("tibia", Part::Shin),
    ("ankle", Part::Ankle),
    ("foot", Part::Foot),
    ("feet", Part::Foot),
    ("toe", Part::Toe),
    ("heel", Part::Toe),
    ("metatarsal", Part::Toe),
    ("footindex", Part::Toe),
    // As MikuMikuDance has them.
    ("下半身", Part::Pelvis),
    ("腰", Part::Pelvis),
    ("上半身", Part::Spine),
    ("首", Part::Neck),
    ("頭", Part::Head),
    ("目", Part::Face),
    ("肩", Part::Collar),
    ("腕", Part::UpperArm),
    ("ひじ", Part::Forearm),
    ("手首", Part::Wrist),
    ("指", Part::Finger),
    ("足", Part::Thigh),
    ("ひざ", Part::Shin),
    ("足首", Part::Ankle),
    ("つま先", Part::Toe),
];

/// Terms that are words of their own; inside other words they mean nothing.
const WHOLE_WORDS: &[(&str, Part)] = &[
    ("back", Part::Spine),
    ("ribs", Part::Spine),
    ("ear", Part::Face),
    ("brow", Part::Face),
    ("middle", Part::Finger),
    ("mid", Part::Finger),
    ("ring", Part::Finger),
    ("little", Part::Finger),
    ("ball", Part::Toe),
];

const END_WORDS: &[&str] = &["end", "nub", "tip", "site", "leaf"];
const TWIST_WORDS: &[&str] = &["twist", "roll", "腕捩", "手捩"];
const CONTROL_WORDS: &[&str] = &[
    "ik", "ｉｋ", "target", "ctrl", "control", "pole", "slot", "mch", "org", "socket", "armature",
];

/// Reads a name; `has_side` says whether the joint belongs to a side of the body.
pub(super) fn read(name: &str, has_side: bool) -> Reading {
    let name = without_namespace(name);
    let mut compact = String::new();
    let mut reading = Reading::default();
    let mut found: Option<(usize, usize, Part)> = None;
    let mut consider = |end: usize, length: usize, part: Part| {
        if found.is_none_or(|(e, l, _)| (end, length) > (e, l)) {
            found = Some((end, length, part));
        }
    };
    for word in words(name) {
        let word = without_side(&word).to_owned();
        compact.push_str(&word);
        reading.is_end |= END_WORDS.contains(&word.as_str());
        reading.is_twist |= TWIST_WORDS.contains(&word.as_str());
        reading.is_control |= CONTROL_WORDS.contains(&word.as_str());
        for &(term, part) in WHOLE_WORDS {
            if word == term {
                consider(compact.len(), term.len(), part);
            }
        }
    }
    for &(term, part) in TERMS {
        if let Some(start) = compact.rfind(term) {
            consider(start + term.len(), term.len(), part);
        }
    }
    if found.is_none() && is_vertebra(name) {
        reading.part = Some(Part::Spine);
        return reading;
    }
    reading.part = found.map(|(_, _, part)| part).and_then(|part| match part {
        Part::Hip if !has_side => Some(Part::Pelvis),
        // `SpineMiddle` is no finger, `ring` alone no hand's.
        Part::Finger | Part::Toe if !has_side => None,
        part => Some(part),
    });
    reading
}

/// Longer names are read from their end.
const NAME_LENGTH_MAX: usize = 96;

/// The name without what stands before the last colon or bar: `mixamorig:Hips`, `Armature|Hips`.
pub(super) fn without_namespace(name: &str) -> &str {
    let name = name.rsplit([':', '|']).next().unwrap_or(name);
    let from_end = name.char_indices().rev().nth(NAME_LENGTH_MAX);
    from_end.map_or(name, |(at, _)| &name[at..])
}

/// Whether a name is a letter and a number, as vertebrae are called: `L5`, `T12`. On the spine `L` is
/// no left.
pub(super) fn is_vertebra(name: &str) -> bool {
    let digits = name.strip_prefix(['C', 'T', 'L', 'S', 'R']);
    digits.is_some_and(|digits| {
        (1..=2).contains(&digits.len()) && digits.bytes().all(|digit| digit.is_ascii_digit())
    })
}

/// The words of a name in lower case: cut at all that is no letter, before a capital after a small
/// letter, and before the last of several capitals that a small letter follows. Letters that are neither,
/// as in Japanese, end before a capital.
pub(super) fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = vec![String::new()];
    for (place, &letter) in letters.iter().enumerate() {
        if !letter.is_alphabetic() {
            words.push(String::new());
            continue;
        }
        let before = place.checked_sub(1).map(|place| letters[place]);
        let is_before_small = letters
            .get(place + 1)
            .is_some_and(|next| next.is_lowercase());
        let after_small = before.is_some_and(char::is_lowercase);
        let after_capital = before.is_some_and(char::is_uppercase);
        let after_uncased =
            before.is_some_and(|c| c.is_alphabetic() && !c.is_lowercase() && !c.is_uppercase());
        if letter.is_uppercase()
            && (after_small || after_uncased || (after_capital && is_before_small))
        {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut() {
            word.extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// A word without the side at its start or end; empty where it is nothing but a side.
fn without_side(word: &str) -> &str {
    if matches!(word, "l" | "r" | "left" | "right") {
        return "";
    }
    ["left", "right", "左", "右"]
        .iter()
        .fold(word, |word, side| {
            let word = word.strip_prefix(side).unwrap_or(word);
            word.strip_suffix(side).unwrap_or(word)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_of_many_programs_are_read() {
        let sided = [
            ("mixamorig:LeftUpLeg", Part::Thigh),
            ("Character1_LeftLeg", Part::Leg),
            ("lHip", Part::Hip),
            ("LHipJoint", Part::HipJoint),
            ("lfemur", Part::Thigh),
            ("Bip01 L Thigh", Part::Thigh),
            ("Bip01 L Calf", Part::Shin),
            ("thigh_l", Part::Thigh),
            ("ball_l", Part::Toe),
            ("UpperLeg_L", Part::Thigh),
            ("leftLowerLeg", Part::Shin),
            ("DEF-shin.L.001", Part::Shin),
            ("lThighBend", Part::Thigh),
            ("m_avg_L_Ankle", Part::Ankle),
            ("lTorso_Clavicle", Part::Collar),
            ("J_Bip_L_UpperArm", Part::UpperArm),
            ("DEF-upper_arm.L", Part::UpperArm),
            ("LeftForeArm", Part::Forearm),
            ("lShldrBend", Part::Shoulder),
            ("LoArm_L", Part::Forearm),
            ("RightHandIndex1", Part::Finger),
            ("ring_01_l", Part::Finger),
            ("lradius", Part::Forearm),
            ("LeftToeBase", Part::Toe),
            ("left_foot_index", Part::Toe),
            ("lButtock", Part::HipJoint),
            ("LUArm", Part::UpperArm),
            ("LFArm", Part::Forearm),
            ("左腕", Part::UpperArm),
            ("左手首", Part::Wrist),
            ("右足", Part::Thigh),
            ("右足首", Part::Ankle),
        ];
        for (name, part) in sided {
            assert_eq!(read(name, true).bone(), Some(part), "{name}");
        }
        let middle = [
            ("hip", Some(Part::Pelvis)),
            ("Bip01 Pelvis", Some(Part::Pelvis)),
            ("torso_head", Some(Part::Head)),
            ("pelvis_lowerback", Some(Part::Spine)),
            ("JointChest", Some(Part::Spine)),
            ("upperneck", Some(Part::Neck)),
            ("L5", Some(Part::Spine)),
            ("T12", Some(Part::Spine)),
            ("上半身2", Some(Part::Spine)),
            ("頭", Some(Part::Head)),
            ("センター", None),
            ("joint_Root", None),
            ("Bone.017", None),
            ("string", None),
            ("", None),
        ];
        for (name, part) in middle {
            assert_eq!(read(name, false).bone(), part, "{name}");
        }
    }

    #[test]
    fn ends_twists_and_controls_are_told_apart() {
        assert!(read("HeadTop_End", false).is_end);
        assert!(read("Bip01 L Toe0Nub", true).is_end);
        assert!(read("upperarm_twist_01_l", true).is_twist);
        assert!(read("LeftForeArmRoll", true).is_twist);
        assert!(read("ik_foot_l", true).is_control);
        assert!(read("kneeIK.l", true).is_control);
        assert!(read("左足ＩＫ", true).is_control);
        assert_eq!(read("MCH-foot.L", true).bone(), None);
    }
}
