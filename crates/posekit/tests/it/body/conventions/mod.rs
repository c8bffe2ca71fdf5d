//! Figures as many programs lay them out: their joints' names, their proportions, their rest poses.
//!
//! Names and lengths are those of published skeletons (CMU `01_01`, Mixamo, Bandai-Namco, LAFAN1, suits of
//! Rokoko, Xsens, Perception Neuron, SMPL's mean shape, the VRM humanoid) to a centimetre or so; the child
//! has the proportions of a four-year-old, the ape long arms on high shoulders. Every figure is described
//! as it stands with its arms out, Y up, facing +Z; `is_flat` then lays each bone along its parent's X at
//! rest, as files do that keep the posture in their motion.

mod capture;
mod characters;
pub(crate) mod figure;
mod games;
mod posers;
mod proportions;
mod suits;

type Joint = (&'static str, [f32; 3]);

/// A way to lay out a figure. In names `%` stands for the side as a word and `#` for its letter.
#[derive(Clone, Copy)]
pub(crate) struct Convention {
    pub(crate) label: &'static str,
    /// The words for left and right, then the letters.
    sides: [[&'static str; 2]; 2],
    /// Joints above the pelvis.
    above: &'static [Joint],
    /// From the pelvis to the crown; a name ending in `_end` is an End Site.
    trunk: &'static [Joint],
    head: &'static str,
    /// The joint of the trunk that the collar bones hang from.
    chest: &'static str,
    /// What the legs hang from, where it is not the first joint of the trunk.
    legs_on: &'static str,
    leg: &'static [Joint],
    /// What the arms hang from, where it is not the chest.
    arms_on: &'static str,
    arm: &'static [Joint],
    /// Hip, knee, ankle, shoulder, elbow, wrist.
    landmarks: [&'static str; 6],
    /// Chains of so many joints on the hand.
    fingers: (usize, usize, &'static str),
    is_flat: bool,
    /// Joints that are no part of trunk or limbs, below others of the trunk or of each other.
    beside: &'static [(&'static str, Joint)],
    /// The same on both sides, below joints of the limbs too.
    beside_limbs: &'static [(&'static str, Joint)],
}

const PLAIN: Convention = Convention {
    label: "",
    sides: WORDS,
    above: &[],
    trunk: &[],
    head: "",
    chest: "",
    legs_on: "",
    leg: &[],
    arms_on: "",
    arm: &[],
    landmarks: [""; 6],
    fingers: (0, 0, ""),
    is_flat: false,
    beside: &[],
    beside_limbs: &[],
};

const WORDS: [[&str; 2]; 2] = [["Left", "Right"], ["L", "R"]];
const SMALL: [[&str; 2]; 2] = [["left", "right"], ["l", "r"]];

/// The twelve that are drawn side by side.
pub(crate) fn conventions() -> Vec<Convention> {
    [
        capture::capture(),
        suits::suits(),
        characters::characters(),
        proportions::proportions(),
    ]
    .concat()
}

/// All of them, rarer ones too.
pub(crate) fn all_conventions() -> Vec<Convention> {
    [conventions(), games::games(), posers::posers()].concat()
}

impl Convention {
    /// The name of a joint on a side, 0 left and 1 right.
    pub(crate) fn name(&self, pattern: &str, side: usize) -> String {
        pattern
            .replace('%', self.sides[0][side])
            .replace('#', self.sides[1][side])
    }

    /// Names of hip, knee, ankle, shoulder, elbow, wrist on a side.
    pub(crate) fn landmarks(&self, side: usize) -> [String; 6] {
        self.landmarks.map(|pattern| self.name(pattern, side))
    }

    /// The names of pelvis, chest and head.
    pub(crate) fn trunk(&self) -> [&'static str; 3] {
        let or =
            |name: &'static str, usual: &'static str| if name.is_empty() { usual } else { name };
        [
            or(self.legs_on, self.trunk[0].0),
            or(self.arms_on, self.chest),
            self.head,
        ]
    }
}
