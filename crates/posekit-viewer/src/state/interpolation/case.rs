//! The orientations that are compared: a row of keys as Euler angles, and which two of them are looked at.
//!
//! Angles are what is kept, so that what is typed stays as it was typed and the command line that is
//! copied makes the same orientations to the last bit. A turn of 300 degrees is not one of -60: the
//! quaternions differ in sign, which the method `rawslerp` shows.

use glam::DQuat;
use posekit::inbetween::{Ends, Method, Preset};
use posekit::rotation::EulerOrder;

/// Keys there may be.
pub const MOST_KEYS: usize = 12;

/// Angles reach so far to either side, degrees.
pub const WIDEST_DEG: f64 = 720.0;

/// Two turns are all that a quaternion tells apart.
const OF_QUATERNION_DEG: f64 = 720.0;

/// The orders that angles can be given in: every one that can make every rotation.
pub const ORDERS: [&str; 12] = [
    "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ",
];

/// Orientations that show something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabPreset {
    /// One that `posekit slerp` has, too.
    OfCommand(Preset),
    /// Angles that go around more than once, which orientations do not tell.
    WholeTurns,
}

impl From<Preset> for LabPreset {
    fn from(preset: Preset) -> Self {
        Self::OfCommand(preset)
    }
}

/// The angles of [`LabPreset::WholeTurns`], in the order `YXZ`: leaning, so that the turn is seen.
const WHOLE_TURNS_DEG: [[f64; 3]; 4] = [
    [0.0, 20.0, 0.0],
    [360.0, 20.0, 0.0],
    [-360.0, 20.0, 0.0],
    [-90.0, 20.0, 0.0],
];

impl LabPreset {
    /// All of them, in the order in which they are offered.
    pub fn all() -> impl Iterator<Item = Self> {
        Preset::ALL
            .into_iter()
            .map(Self::OfCommand)
            .chain([Self::WholeTurns])
    }

    /// The name shown.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::OfCommand(preset) => preset.title(),
            Self::WholeTurns => "Once around, twice back",
        }
    }

    /// What to look for in it.
    #[must_use]
    pub fn says(self) -> &'static str {
        match self {
            Self::OfCommand(preset) => preset.says(),
            Self::WholeTurns => {
                "The angle about Y goes 0, 360, -360, -90: once around, twice back, three quarters on. The \
                 curves do just that. Orientations know no whole turns: all other ways stand still twice \
                 and then go a quarter turn, the other way."
            }
        }
    }
}

/// The keys, and which two of them are looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    order: EulerOrder,
    keys_deg: Vec<[f64; 3]>,
    gap: usize,
    preset: Option<LabPreset>,
}

impl Default for Case {
    fn default() -> Self {
        Self::of_preset(Preset::Quarter)
    }
}

impl Case {
    /// The orientations of a preset, in the order of angles in which they are easiest to read.
    #[must_use]
    pub fn of_preset(preset: impl Into<LabPreset>) -> Self {
        let preset = match preset.into() {
            LabPreset::OfCommand(preset) => preset,
            LabPreset::WholeTurns => {
                return Self {
                    order: EulerOrder::YXZ,
                    keys_deg: WHOLE_TURNS_DEG.to_vec(),
                    gap: 0,
                    preset: Some(LabPreset::WholeTurns),
                };
            }
        };
        let order = preset.order();
        let mut previous = [0.0; 3];
        let keys_deg = preset
            .keys()
            .into_iter()
            .map(|key| {
                previous = angles_deg(order, key, previous);
                previous
            })
            .collect();
        Self {
            order,
            keys_deg,
            gap: preset.gap(),
            preset: Some(preset.into()),
        }
    }

    /// The preset that it is, until it is changed.
    #[must_use]
    pub fn preset(&self) -> Option<LabPreset> {
        self.preset
    }

    /// The order of the angles.
    #[must_use]
    pub fn order(&self) -> EulerOrder {
        self.order
    }

    /// The angles of every key, degrees.
    #[must_use]
    pub fn keys_deg(&self) -> &[[f64; 3]] {
        &self.keys_deg
    }

    /// How many ways there are from key to key.
    #[must_use]
    pub fn gap_count(&self) -> usize {
        self.keys_deg.len() - 1
    }

    /// The key that is the start; the one after it is the end.
    #[must_use]
    pub fn gap(&self) -> usize {
        self.gap
    }

    /// A key's orientation.
    #[must_use]
    pub fn rotation(&self, key: usize) -> DQuat {
        self.order.to_quat(self.keys_deg[key].map(f64::to_radians))
    }

    /// Two keys, and those around them.
    #[must_use]
    pub fn ends(&self, gap: usize) -> Ends {
        let after = gap + 2;
        Ends {
            before: gap.checked_sub(1).map(|before| self.rotation(before)),
            after: (after < self.keys_deg.len()).then(|| self.rotation(after)),
            ..Ends::new(self.rotation(gap), self.rotation(gap + 1))
        }
    }

    /// Sets an angle of a key, degrees; what is not a number is not taken.
    pub fn set_angle(&mut self, key: usize, axis: usize, angle_deg: f64) {
        if angle_deg.is_finite() {
            self.keys_deg[key][axis] = angle_deg.clamp(-WIDEST_DEG, WIDEST_DEG);
            self.preset = None;
        }
    }

    /// Turns a key so; its angles are those nearest to what they were.
    pub fn set_rotation(&mut self, key: usize, rotation: DQuat) {
        let before = self.keys_deg[key].map(f64::to_radians);
        let near = self.order.from_quat_near(rotation, before).angles_rad;
        // A whole turn that was asked for stays asked for, as far as angles reach.
        let near = near.map(|angle| rounded(angle.to_degrees()));
        let reaches = near.iter().all(|angle| angle.abs() <= WIDEST_DEG);
        self.keys_deg[key] = if reaches { near } else { near.map(within) };
        self.preset = None;
    }

    /// Gives the angles in another order. The orientations stay, and so do their signs.
    pub fn set_order(&mut self, order: EulerOrder) {
        if !order.is_complete() || order == self.order {
            return;
        }
        let rotations: Vec<DQuat> = (0..self.keys_deg.len())
            .map(|key| self.rotation(key))
            .collect();
        self.order = order;
        let mut previous = [0.0; 3];
        for (angles, rotation) in self.keys_deg.iter_mut().zip(rotations) {
            previous = angles_deg(order, rotation, previous);
            *angles = previous;
        }
    }

    /// Looks at the way from a key to the next one.
    pub fn set_gap(&mut self, gap: usize) {
        self.gap = gap.min(self.gap_count() - 1);
    }

    /// Puts a key after the end: the way goes on as far again. Does nothing when there are many.
    pub fn add_key(&mut self) {
        if self.keys_deg.len() >= MOST_KEYS {
            return;
        }
        let [start, end] = [self.gap, self.gap + 1].map(|key| self.rotation(key));
        let on = posekit::rotation::slerp(start, end, 2.0);
        let key = angles_deg(self.order, on, self.keys_deg[self.gap + 1]).map(rounded);
        self.keys_deg.insert(self.gap + 2, key);
        self.preset = None;
    }

    /// Takes a key away; two stay.
    pub fn remove_key(&mut self, key: usize) {
        if self.keys_deg.len() > 2 && key < self.keys_deg.len() {
            self.keys_deg.remove(key);
            let gap = if key <= self.gap {
                self.gap.saturating_sub(1)
            } else {
                self.gap
            };
            self.set_gap(gap);
            self.preset = None;
        }
    }

    /// Start and end change places.
    pub fn swap(&mut self) {
        self.keys_deg.swap(self.gap, self.gap + 1);
        self.preset = None;
    }

    /// The command that shows the same.
    #[must_use]
    pub fn command(&self, methods: &[Method], steps: usize) -> String {
        let key = |index: usize| {
            let [a, b, c] = self.keys_deg[index];
            format!("{a},{b},{c}")
        };
        let mut line = format!(
            "posekit slerp {} {} --order {}",
            key(self.gap),
            key(self.gap + 1),
            self.order
        );
        if let Some(before) = self.gap.checked_sub(1) {
            line.push_str(&format!(" --before {}", key(before)));
        }
        if self.gap + 2 < self.keys_deg.len() {
            line.push_str(&format!(" --after {}", key(self.gap + 2)));
        }
        let words: Vec<String> = methods.iter().map(ToString::to_string).collect();
        if !words.is_empty() {
            line.push_str(&format!(" --method {}", words.join(",")));
        }
        line.push_str(&format!(" --steps {steps}"));
        line
    }
}

/// The angles of a quaternion, near to others, that make the quaternion with its sign.
fn angles_deg(order: EulerOrder, rotation: DQuat, near_deg: [f64; 3]) -> [f64; 3] {
    let near = order.from_quat_near(rotation, near_deg.map(f64::to_radians));
    let mut angles = near.angles_rad.map(|angle| settled(angle.to_degrees()));
    if order.to_quat(angles.map(f64::to_radians)).dot(rotation) < 0.0 {
        // A whole turn on any of the three changes the sign: the one that leaves the smallest angles.
        let turned = (0..3).map(|axis| {
            let mut turned = angles;
            turned[axis] -= 360.0_f64.copysign(turned[axis]);
            turned
        });
        let size = |angles: &[f64; 3]| angles.iter().map(|angle| angle * angle).sum::<f64>();
        angles = turned
            .min_by(|a, b| size(a).total_cmp(&size(b)))
            .unwrap_or(angles);
    }
    angles.map(within)
}

/// What is a round number but for rounding is that number.
fn settled(angle_deg: f64) -> f64 {
    let round = (angle_deg * 1e6).round() / 1e6;
    if (angle_deg - round).abs() < 1e-9 {
        round + 0.0
    } else {
        angle_deg
    }
}

/// What a hand turned needs no more than four decimals.
fn rounded(angle_deg: f64) -> f64 {
    (angle_deg * 1e4).round() / 1e4 + 0.0
}

/// Two whole turns more or less are the same quaternion.
fn within(angle_deg: f64) -> f64 {
    angle_deg - OF_QUATERNION_DEG * (angle_deg / OF_QUATERNION_DEG).round()
}

#[cfg(test)]
mod tests {
    use posekit::rotation::angle_between;

    use super::*;

    #[test]
    fn presets_are_those_of_the_command_signs_and_all() {
        for preset in Preset::ALL {
            let case = Case::of_preset(preset);
            let (ours, theirs) = (case.ends(case.gap()), preset.ends());
            for (ours, theirs) in [(ours.start, theirs.start), (ours.end, theirs.end)] {
                assert!(angle_between(ours, theirs) < 1e-8, "{preset}");
                assert!(ours.dot(theirs) > 0.0, "{preset}: the sign counts");
            }
            assert_eq!(ours.before.is_some(), theirs.before.is_some());
            assert_eq!(ours.after.is_some(), theirs.after.is_some());
            for angles in case.keys_deg() {
                assert!(
                    angles.iter().all(|angle| angle.abs() <= WIDEST_DEG),
                    "{preset}"
                );
            }
        }
    }

    #[test]
    fn another_order_is_the_same_orientations() {
        for preset in Preset::ALL {
            let first = Case::of_preset(preset);
            let mut case = first.clone();
            for word in ORDERS {
                case.set_order(word.parse().expect("an order"));
                for key in 0..first.keys_deg().len() {
                    let (a, b) = (case.rotation(key), first.rotation(key));
                    assert!(
                        angle_between(a, b) < 1e-7 && a.dot(b) > 0.0,
                        "{preset} {word} {key}"
                    );
                }
            }
        }
    }

    #[test]
    fn keys_come_and_go_and_two_stay() {
        let mut case = Case::of_preset(Preset::Lecture);
        case.add_key();
        // A quarter turn goes on to half a turn.
        assert_eq!(case.keys_deg()[2], [0.0, 0.0, 180.0]);
        assert_eq!((case.gap(), case.gap_count()), (0, 2));
        case.set_gap(7);
        assert_eq!(case.gap(), 1);
        case.remove_key(0);
        assert_eq!((case.gap(), case.gap_count()), (0, 1));
        case.remove_key(0);
        assert_eq!(case.gap_count(), 1, "two stay");
        for _ in 0..40 {
            case.add_key();
        }
        assert_eq!(case.keys_deg().len(), MOST_KEYS);
    }

    #[test]
    fn what_is_no_number_is_not_taken() {
        let mut case = Case::default();
        let before = case.clone();
        case.set_angle(0, 1, f64::NAN);
        assert_eq!(case, before);
        case.set_angle(0, 1, 1e9);
        assert_eq!(case.keys_deg()[0][1], WIDEST_DEG);
    }
}
