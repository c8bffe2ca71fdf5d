//! Two bones, in closed form: shoulder and elbow, hip and knee.
//!
//! The middle joint opens until the chain is as long as the target is far (law of cosines), the upper joint
//! turns the chain to the target, and the chain swivels about the line between them so that the middle
//! joint is on the side of its pole (Tolani, Goswami and Badler 2000, "Real-Time Inverse Kinematics
//! Techniques for Anthropomorphic Limbs", Graphical Models 62(5), doi:10.1006/gmod.2000.0528). No angle is
//! computed: cosines give directions, and directions give quaternions.
//!
//! **Softness.** A chain that comes to its full length stops with a jerk (a knee pops). With a softness `s`
//! its last `s` of reach is eased into, never quite reached: `d' = L (1 - s e^(-(d - (1-s) L) / (s L)))`
//! (Nicholas 2009, "Soft IK").
//!
//! **Guarantees and degenerate inputs.** Out of reach the chain is stretched straight towards the target, or
//! folded as far as its lengths allow. A straight chain bends in the plane of the pole if there is one, else
//! about an axis perpendicular to it that depends on nothing but its direction. Bones without length, and
//! targets at the upper joint, give finite turns.
//!
//! **Cost.** Seven square roots and three divisions; no trigonometry unless softness is asked for.

use glam::{DQuat, DVec3};

use super::limit::JointLimit;
use super::linkage::Linkage;
use super::problem::{IkProblem, TraceDetail};
use super::solve::Progress;
use super::trace::TraceIteration;
use super::turn::{NEAR_NOTHING, perpendicular, shortened, shortest_turn, shortest_turn_and_roll};
use super::workspace::IkWorkspace;
use crate::pose::LocalPose;
use crate::rotation::exp;
use crate::skeleton::{JointId, Skeleton};

/// How the two-bone solver is set.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct TwoBoneConfig {
    /// The two joints that turn, the upper one first. `None` for the first two of each chain that turn
    /// and lie apart. Everything else keeps its local rotation, but for an effector that is oriented.
    pub joints: Option<[JointId; 2]>,
    /// The share of the chain's length, from 0 to 1, that is eased into as it stretches.
    pub softness: f64,
}

/// Where the two bones are and what they should do. Any space, any length unit; all in one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBone {
    /// The upper joint.
    pub upper: DVec3,
    /// The middle joint.
    pub middle: DVec3,
    /// The end of the second bone.
    pub end: DVec3,
    /// Where the end should be.
    pub target: DVec3,
    /// The point on whose side the middle joint should be; `None` leaves the plane as it is.
    pub pole: Option<DVec3>,
    /// The share of the length that is eased into, from 0 to 1.
    pub softness: f64,
}

/// How both joints turn, in the same space: each turn is applied to the joint's orientation from the left,
/// the middle joint's first, then the upper one's to both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBoneTurns {
    /// The upper joint's turn, which carries the middle one along.
    pub upper: DQuat,
    /// The middle joint's turn before that.
    pub middle: DQuat,
}

impl TwoBone {
    /// Sum of the squares of both bones' lengths.
    fn length_sq(&self) -> f64 {
        self.upper.distance_squared(self.middle) + self.middle.distance_squared(self.end)
    }
}

/// Solves two bones. See the module's documentation.
#[inline]
pub fn two_bone(bones: &TwoBone) -> TwoBoneTurns {
    let &TwoBone { upper, target, .. } = bones;
    let (middle, end) = opened(bones).unwrap_or_else(|| opened_carefully(bones));
    let to_target = target - upper;
    let rolled = bones.pole.and_then(|pole| {
        let to_middle = bones.middle - upper;
        shortest_turn_and_roll(end, to_target, to_middle, pole - upper)
    });
    TwoBoneTurns {
        upper: rolled.unwrap_or_else(|| reached_carefully(bones, end)),
        middle,
    }
}

/// The middle joint's turn, and where the end is after it, seen from the upper joint. `None` where the bones are nearly
/// in one line, or the turn is nearly half a turn: then the plane is to be chosen, and digits are lost.
///
/// Cosine and sine of the angle between the bones, now and as it should be, are kept times the product of both lengths:
/// no direction is computed.
#[inline]
fn opened(bones: &TwoBone) -> Option<(DQuat, DVec3)> {
    let &TwoBone {
        upper, middle, end, ..
    } = bones;
    let (to_upper, to_end) = (upper - middle, end - middle);
    let (upper_sq, end_sq) = (to_upper.length_squared(), to_end.length_squared());
    let product_sq = upper_sq * end_sq;
    let axis = to_upper.cross(to_end);
    let axis_sq = axis.length_squared();
    // Not `<`: products that overflowed to NaN are no plane either.
    if !(axis_sq > NEAR_LINE * product_sq && product_sq > 1e-60 && product_sq < 1e60) {
        return None;
    }
    let product = product_sq.sqrt();
    let now_cosine = to_upper.dot(to_end);
    let now_sine = axis_sq.sqrt();
    let cosine = 0.5 * (upper_sq + end_sq - wanted_distance_sq(bones));
    let cosine = cosine.clamp(-product, product);
    let sine = (product_sq - cosine * cosine).max(0.0).sqrt();
    // One plus the cosine of the turn, and its sine: twice the product of those of half the turn.
    let turn_cosine = product_sq + cosine * now_cosine + sine * now_sine;
    let turn_sine = sine * now_cosine - cosine * now_sine;
    if turn_cosine <= NEAR_NOTHING * product_sq {
        return None;
    }
    let norm = now_sine * product * (2.0 * turn_cosine).sqrt();
    let over_norm = 1.0 / norm;
    let turn = DQuat::from_vec4(
        (axis * (turn_sine * over_norm)).extend(now_sine * turn_cosine * over_norm),
    );
    let over_plane = 1.0 / (upper_sq * now_sine);
    let end = to_upper * (cosine * now_sine * over_plane - 1.0)
        + axis.cross(to_upper) * (sine * over_plane);
    Some((turn, end))
}

/// As [`opened`], for all bones.
#[cold]
fn opened_carefully(bones: &TwoBone) -> (DQuat, DVec3) {
    let &TwoBone {
        upper, middle, end, ..
    } = bones;
    let to_end = end - middle;
    let axis = bend_axis(bones);
    let distance = wanted_distance_sq(bones).sqrt();
    let turn = open(upper - middle, to_end, axis, distance);
    (turn, middle + turn * to_end - upper)
}

/// The upper joint's turn, and the swivel after it where there is a pole.
fn reached_carefully(bones: &TwoBone, end: DVec3) -> DQuat {
    let &TwoBone { upper, middle, .. } = bones;
    let to_target = bones.target - upper;
    let turn = shortest_turn(end, to_target).unwrap_or(DQuat::IDENTITY);
    let line_sq = to_target.length_squared();
    let Some(pole) = bones.pole.filter(|_| line_sq > 0.0) else {
        return turn;
    };
    let aside = |v: DVec3| v - to_target * (v.dot(to_target) / line_sq);
    let from = aside(turn * (middle - upper));
    let to = aside(pole - upper);
    // Both lie across the line, so that the shortest turn between them is about it; where they are
    // opposite it must be told so.
    let swivel = if from.dot(to) < -0.999_999 * (from.length() * to.length()) {
        Some(DQuat::from_vec4((to_target / line_sq.sqrt()).extend(0.0)))
    } else {
        shortest_turn(from, to)
    };
    match swivel {
        Some(swivel) if from.length_squared() > 1e-18 * line_sq => swivel * turn,
        _ => turn,
    }
}

/// Bones are in one line when the square of the sine of their angle is below this.
const IN_LINE: f64 = 1e-16;

/// And nearly so below this: their plane is known to fewer digits the nearer they are.
const NEAR_LINE: f64 = 1e-8;

/// The axis about which the middle joint opens as the angle between its bones grows: across their plane.
fn bend_axis(bones: &TwoBone) -> DVec3 {
    let &TwoBone {
        upper, middle, end, ..
    } = bones;
    let (to_upper, to_end) = (upper - middle, end - middle);
    let normal = to_upper.cross(to_end);
    let size_sq = to_upper.length_squared() * to_end.length_squared();
    if normal.length_squared() > IN_LINE * size_sq {
        return normal.normalize_or_zero();
    }
    let along = if to_end == DVec3::ZERO {
        to_upper
    } else {
        to_end
    };
    if let Some(pole) = bones.pole {
        // Opening away from the pole keeps the middle joint on its side.
        let normal = (pole - middle).cross(along);
        if normal.length_squared()
            > IN_LINE * along.length_squared() * (pole - middle).length_squared()
        {
            return normal.normalize_or_zero();
        }
    }
    perpendicular(along)
}

/// How far from the upper joint the end should be, squared.
#[inline]
fn wanted_distance_sq(bones: &TwoBone) -> f64 {
    if bones.softness <= 0.0 {
        bones.upper.distance_squared(bones.target)
    } else {
        let distance = wanted_distance(bones);
        distance * distance
    }
}

/// How far from the upper joint the end should be.
fn wanted_distance(bones: &TwoBone) -> f64 {
    let distance = bones.upper.distance(bones.target);
    let softness = bones.softness.clamp(0.0, 1.0);
    if softness == 0.0 {
        return distance;
    }
    let length = bones.upper.distance(bones.middle) + bones.middle.distance(bones.end);
    let eased = softness * length;
    let hard = length - eased;
    if distance <= hard || eased <= 0.0 {
        distance
    } else {
        hard + eased * (1.0 - libm::exp(-(distance - hard) / eased))
    }
}

/// The turn about `axis` of the second bone after which its end is `distance` from the upper joint, as far
/// as the bones' lengths allow.
fn open(to_upper: DVec3, to_end: DVec3, axis: DVec3, distance: f64) -> DQuat {
    let (upper_sq, end_sq) = (to_upper.length_squared(), to_end.length_squared());
    let product = (upper_sq * end_sq).sqrt();
    if product <= 0.0 {
        return DQuat::IDENTITY;
    }
    let cosine = ((upper_sq + end_sq - distance * distance) / (2.0 * product)).clamp(-1.0, 1.0);
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let along = to_upper / upper_sq.sqrt();
    let across = axis.cross(along);
    let wanted = along * cosine + across * sine;
    let now_cosine = to_end.dot(along);
    let now_sine = to_end.dot(across);
    // Both directions lie in one plane: half of the angle between them, about the axis.
    let size = (now_cosine * now_cosine + now_sine * now_sine).sqrt();
    let turn_cosine = to_end.dot(wanted) / size;
    let turn_sine = (now_cosine * sine - now_sine * cosine) / size;
    if turn_cosine <= -1.0 + 1e-15 {
        return DQuat::from_vec4(axis.extend(0.0));
    }
    let (half_sine, half_cosine) = (turn_sine, 1.0 + turn_cosine);
    let norm = (half_sine * half_sine + half_cosine * half_cosine).sqrt();
    DQuat::from_vec4((axis * (half_sine / norm)).extend(half_cosine / norm))
}

/// Runs the two-bone solver for each target on the linkage of the workspace.
pub(crate) fn run(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    config: &TwoBoneConfig,
    workspace: &mut IkWorkspace,
) -> Progress {
    let linkage = &mut workspace.linkage;
    linkage.enforce_limits();
    let mut record = TraceIteration::default();
    let is_traced = problem.trace == TraceDetail::Updates;
    for index in 0..problem.targets.len() {
        reach(
            linkage,
            problem,
            config,
            index,
            is_traced.then_some((&mut record, pose)),
        );
    }
    let record = is_traced.then_some(record);
    Progress::in_closed_form(linkage, skeleton, pose, problem, record)
}

fn reach(
    linkage: &mut Linkage,
    problem: &IkProblem,
    config: &TwoBoneConfig,
    index: usize,
    mut record: Option<(&mut TraceIteration, &LocalPose)>,
) {
    let target = &problem.targets[index];
    let goal = linkage.orient(index, target);
    let Some([upper, middle]) = pair(linkage, config, index, goal.is_oriented()) else {
        return;
    };
    let pole = problem
        .poles
        .iter()
        .find(|pole| pole.joint == linkage.pivots[middle].joint);
    let bones = TwoBone {
        upper: linkage.positions[upper],
        middle: linkage.positions[middle],
        end: linkage.goal_point(index, goal),
        target: linkage.goal_position(index, target, goal),
        pole: pole
            .filter(|pole| pole.weight > 0.0)
            .map(|pole| pole.point_in_world),
        softness: config.softness,
    };
    let mut turns = two_bone(&bones);
    let middle_pivot = &linkage.pivots[middle];
    let is_free = matches!(middle_pivot.limit, JointLimit::Free) && middle_pivot.give >= 1.0;
    if let Some(axis) = middle_pivot.hinge_axis(linkage.inner_turn(middle)) {
        turns.middle = hinge_turn(linkage, middle, &bones, axis);
    }
    for (k, turn) in [(middle, turns.middle), (upper, turns.upper)] {
        let before = linkage.goal_point(index, goal);
        let wanted = linkage.goal_position(index, target, goal);
        let turn = if k == upper && !is_free {
            // The middle joint may have gone another way.
            shortest_turn(before - bones.upper, wanted - bones.upper).unwrap_or(DQuat::IDENTITY)
        } else {
            turn
        };
        let start = linkage.turns[k];
        let turn = shortened(start, turn * start, linkage.pivots[k].give);
        linkage.set_turn(k, turn);
        if let Some((record, pose)) = &mut record {
            let made = linkage.turns[k] * start.conjugate();
            let after = linkage.goal_point(index, goal);
            let update = linkage.trace_turn(k, index, made, [before, after, wanted], pose);
            record.updates.push(update);
        }
    }
    if goal.is_oriented() {
        linkage.orient(index, target);
    }
}

/// The turn of a hinge, of the two that bring the end to the distance of the target, that its limits
/// change least; of those the smaller one.
fn hinge_turn(linkage: &Linkage, middle: usize, bones: &TwoBone, axis: DVec3) -> DQuat {
    let (to_upper, to_end) = (bones.upper - bones.middle, bones.end - bones.middle);
    let distance = wanted_distance(bones);
    let (along_upper, along_end) = (to_upper.dot(axis), to_end.dot(axis));
    let (across_upper, across_end) = (to_upper - axis * along_upper, to_end - axis * along_end);
    let size = across_upper.length() * across_end.length();
    if size <= 0.0 {
        return DQuat::IDENTITY;
    }
    let product = 0.5 * (bones.length_sq() - distance * distance) - along_upper * along_end;
    let opened_rad = libm::acos((product / size).clamp(-1.0, 1.0));
    let across = across_upper.cross(across_end).dot(axis);
    let now_rad = libm::atan2(across, across_upper.dot(across_end));
    let start = linkage.turns[middle];
    let miss = |turn: DQuat| {
        let given = linkage.limited_turn(middle, turn * start) * start.conjugate();
        let end = bones.middle + given * to_end;
        // The second term only decides between two that serve alike.
        let effort = 1e-9 * (1.0 - given.w.abs()) * distance.max(to_end.length());
        (end.distance(bones.upper) - distance).abs() + effort
    };
    let turns = [opened_rad, -opened_rad].map(|angle_rad| exp(axis * (angle_rad - now_rad)));
    if miss(turns[1]) < miss(turns[0]) {
        turns[1]
    } else {
        turns[0]
    }
}

/// The two pivots that turn.
fn pair(
    linkage: &Linkage,
    config: &TwoBoneConfig,
    index: usize,
    is_oriented: bool,
) -> Option<[usize; 2]> {
    let path = linkage.path(index);
    let path = &path[..path.len() - usize::from(is_oriented)];
    let mut turning = path
        .iter()
        .map(|&k| k as usize)
        .filter(|&k| linkage.pivots[k].turns);
    if let Some([upper, middle]) = config.joints {
        let find = |joint| turning.clone().find(|&k| linkage.pivots[k].joint == joint);
        return Some([find(upper)?, find(middle)?]);
    }
    let upper = turning.next()?;
    let at = linkage.positions[upper];
    let middle = turning.find(|&k| linkage.positions[k].distance_squared(at) > 0.0)?;
    Some([upper, middle])
}
