//! Where in a limb the three joints are that bend it: by names, lengths and angles together.
//!
//! Every choice of three joints along the limb gets a score. Names count most, where they say
//! something. Lengths: the two bones are about as long as each other, make most of the limb, and what
//! lies before and after is shorter than they are (a collar bone, an extra hip joint, a hand, a foot).
//! Angles: the limb is fairly straight at the middle joint in most poses, and joints skipped within a
//! bone lie on it. Proportions: Drillis and Contini (1966), as printed in Winter, "Biomechanics and
//! Motor Control of Human Movement" (2009, fig. 4.1).

use glam::Vec3;

use super::name::{Part, Reading};

/// A leg or an arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Leg,
    Arm,
}

/// A joint of a limb, as far as choosing goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    pub(super) at: Vec3,
    pub(super) reading: Reading,
    pub(super) is_end_site: bool,
}

/// Three joints of a limb, by their place along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    pub(super) upper: usize,
    pub(super) middle: usize,
    pub(super) lower: usize,
    /// How well they fit: up to about 4 by lengths and angles, up to about 13 with names.
    pub(super) score: f32,
    /// How many of the three have names that fit.
    pub(super) named_count: usize,
}

impl Bend {
    pub(super) fn is_same_place(&self, other: &Self) -> bool {
        [self.upper, self.middle, self.lower] == [other.upper, other.middle, other.lower]
    }
}

/// No limb has more joints than this; what follows is not looked at.
pub(super) const STOPS_MAX: usize = 24;

/// What the two bones' share of the limb's length counts.
const SHARE_WEIGHT: f32 = 4.0;
/// Logarithm of the ratio of the two bones' lengths up to which nothing is odd: 1 to 1.35.
const RATIO_FREE: f32 = 0.3;
const RATIO_WEIGHT: f32 = 1.5;
/// What follows may be this share of the lower bone: a foot is 0.62 of a shin, a hand 0.74 of a forearm.
const REST_FREE: f32 = 0.75;
/// What comes before may be this share of the upper bone: a collar bone is 0.7 of an upper arm.
const BEFORE_FREE: f32 = 0.9;
const OUTSIDE_WEIGHT: f32 = 2.0;
const OUTSIDE_MAX: f32 = 2.5;
/// What a straight limb counts more than one bent by a right angle.
const STRAIGHT_WEIGHT: f32 = 0.5;
/// What a joint within a bone costs that is no twist joint.
const SKIPPED: f32 = 0.8;
/// ... and by how much it turns the bone aside (1 minus the cosine).
const ASIDE_WEIGHT: f32 = 6.0;
/// A bone shorter than this share of the limb is no thigh and no forearm.
const LEAST_SHARE: f32 = 0.1;
/// Joints nearer to each other than this share of the limb are in one place.
const SAME_PLACE: f32 = 1e-3;

/// The three joints that fit best. `before` is where the limb hangs from. With `by_names` false names
/// count nothing.
pub(super) fn best_bend(before: Vec3, stops: &[Stop], kind: Kind, by_names: bool) -> Option<Bend> {
    let stops = &stops[..stops.len().min(STOPS_MAX)];
    let limb = Measured::new(before, stops)?;
    let mut best: Option<Bend> = None;
    for upper in 0..stops.len() {
        for middle in upper + 1..stops.len() {
            for lower in middle + 1..stops.len() {
                let bend = limb.bend([upper, middle, lower], kind, by_names);
                if let Some(bend) = bend
                    && best.as_ref().is_none_or(|best| bend.score > best.score)
                {
                    best = Some(bend);
                }
            }
        }
    }
    best
}

struct Measured<'a> {
    before: Vec3,
    stops: &'a [Stop],
    /// Way from the first stop to each.
    way: Vec<f32>,
}

impl<'a> Measured<'a> {
    fn new(before: Vec3, stops: &'a [Stop]) -> Option<Self> {
        let mut way = vec![0.0; stops.len()];
        for i in 1..stops.len() {
            way[i] = way[i - 1] + stops[i].at.distance(stops[i - 1].at);
        }
        let total = way.last().copied()?;
        (total.is_finite() && total > 0.0).then_some(Self { before, stops, way })
    }

    fn total(&self) -> f32 {
        self.way[self.way.len() - 1]
    }

    fn bend(&self, [i, j, k]: [usize; 3], kind: Kind, by_names: bool) -> Option<Bend> {
        let at = |index: usize| self.stops[index].at;
        let (upper, lower) = (at(j) - at(i), at(k) - at(j));
        let (a, b) = (upper.length(), lower.length());
        let total = self.total();
        if a.min(b) < LEAST_SHARE * total {
            return None;
        }
        let mut score = SHARE_WEIGHT * (a + b) / total;
        score -= RATIO_WEIGHT * (libm::logf(a / b).abs() - RATIO_FREE).max(0.0);
        let outside = |length: f32, bone: f32, free: f32| {
            (OUTSIDE_WEIGHT * (length / bone - free).max(0.0)).min(OUTSIDE_MAX)
        };
        score -= outside(total - self.way[k], b, REST_FREE);
        let above = match i.checked_sub(1) {
            Some(above) => at(above),
            None => self.before,
        };
        score -= outside(at(i).distance(above), a, BEFORE_FREE);
        score += STRAIGHT_WEIGHT * upper.dot(lower) / (a * b);
        score -= self.skipped(i, j, by_names) + self.skipped(j, k, by_names);
        score -= self.misplaced([i, j, k]);
        let mut named_count = 0;
        if by_names {
            for (role, index) in [i, j, k].into_iter().enumerate() {
                let stop = &self.stops[index];
                if stop.is_end_site {
                    // Its name is its parent's.
                    continue;
                }
                let fit = name_fit(stop.reading, kind, role);
                score += fit;
                named_count += usize::from(fit >= 1.0);
            }
        }
        Some(Bend {
            upper: i,
            middle: j,
            lower: k,
            score,
            named_count,
        })
    }

    /// What the joints within a bone cost.
    fn skipped(&self, from: usize, to: usize, by_names: bool) -> f32 {
        let at = |index: usize| self.stops[index].at;
        let bone = at(to) - at(from);
        (from + 1..to)
            .map(|within| {
                let reading = self.stops[within].reading;
                let is_segment = by_names
                    && (reading.is_twist
                        || reading.part.is_some() && reading.part == self.stops[from].reading.part);
                let is_coincident = [from, to]
                    .iter()
                    .any(|&end| at(within).distance(at(end)) < SAME_PLACE * self.total());
                let way = at(within) - at(from);
                let aside = if is_coincident {
                    0.0
                } else {
                    1.0 - way.dot(bone) / (way.length() * bone.length()).max(f32::MIN_POSITIVE)
                };
                let cost = if is_segment || is_coincident {
                    0.02
                } else {
                    SKIPPED
                };
                cost + ASIDE_WEIGHT * aside
            })
            .sum()
    }

    /// Of joints in one place the last one turns the bone below, and the first one ends the bone above.
    /// An End Site turns nothing.
    fn misplaced(&self, [i, j, k]: [usize; 3]) -> f32 {
        let together = |a: usize, b: usize| {
            self.stops
                .get(b)
                .is_some_and(|b| self.stops[a].at.distance(b.at) < SAME_PLACE * self.total())
        };
        let turns = [i, j].iter().filter(|&&at| together(at, at + 1)).count();
        let ends = usize::from(together(k - 1, k));
        let sites = [i, j]
            .iter()
            .filter(|&&at| self.stops[at].is_end_site)
            .count();
        let no_hand = f32::from(u8::from(self.stops[k].is_end_site)) * 0.5;
        0.1 * (turns + ends) as f32 + 4.0 * sites as f32 + no_hand
    }
}

/// How well a name fits a joint's role: 0 the upper one, 1 the middle one, 2 the lower one.
fn name_fit(reading: Reading, kind: Kind, role: usize) -> f32 {
    if reading.is_control {
        return -2.0;
    }
    let Some(part) = reading.part else {
        return if reading.is_end || reading.is_twist {
            -1.0
        } else {
            0.0
        };
    };
    let fits: [f32; 3] = match (kind, part) {
        (Kind::Leg, Part::Pelvis) => [-1.0, -4.0, -4.0],
        (Kind::Leg, Part::HipJoint) => [0.5, -3.0, -4.0],
        (Kind::Leg, Part::Hip) => [2.0, -3.0, -4.0],
        (Kind::Leg, Part::Thigh) => [3.0, -2.0, -4.0],
        (Kind::Leg, Part::Leg) => [2.0, 2.0, -1.0],
        (Kind::Leg, Part::Shin) => [-3.0, 3.0, -3.0],
        (Kind::Leg, Part::Ankle) => [-4.0, -4.0, 3.2],
        (Kind::Leg, Part::Foot) => [-4.0, -4.0, 3.0],
        (Kind::Leg, Part::Toe) => [-4.0, -4.0, -3.0],
        (Kind::Arm, Part::Collar) => [-2.0, -3.0, -4.0],
        (Kind::Arm, Part::Shoulder) => [2.0, -2.0, -4.0],
        (Kind::Arm, Part::UpperArm) => [3.0, -2.0, -4.0],
        (Kind::Arm, Part::Arm) => [2.8, 1.0, -2.0],
        (Kind::Arm, Part::Forearm) => [-3.0, 3.0, -3.0],
        (Kind::Arm, Part::Wrist) => [-4.0, -4.0, 3.2],
        (Kind::Arm, Part::Hand) => [-4.0, -4.0, 3.0],
        (Kind::Arm, Part::Finger) => [-4.0, -4.0, -3.0],
        _ => [-4.0, -4.0, -4.0],
    };
    let marks = f32::from(u8::from(reading.is_end)) + f32::from(u8::from(reading.is_twist));
    fits[role] - 1.5 * marks
}
