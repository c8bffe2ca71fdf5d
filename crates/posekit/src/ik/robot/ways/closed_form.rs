//! Six hinges in a row whose angles have a closed form.
//!
//! Told by lines: every axis as a line in the world with all angles at zero, as products of exponentials have it
//! (Murray, Li and Sastry 1994, "A Mathematical Introduction to Robotic Manipulation", section 3.3, whose
//! subproblems are the steps here), so that it does not matter in which frames a file describes the arm.

use glam::{DMat2, DQuat, DVec2, DVec3};

use super::trig::{TwoCircles, circle, linear, turn_onto, wrapped};
use crate::mechanism::Frame;
use crate::rotation::exp;

/// How far from parallel axes may be, and how far from meeting, of an arm of size one: a file's digits.
const EXACT: f64 = 1e-6;

/// A hinge's axis where all values are zero: a line in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) direction: DVec3,
    pub(super) point: DVec3,
}

impl Axis {
    fn turn(&self, angle: f64) -> DQuat {
        exp(self.direction * angle)
    }

    fn carry(&self, angle: f64, point: DVec3) -> DVec3 {
        self.point + self.turn(angle) * (point - self.point)
    }

    fn is_parallel(&self, other: &Self) -> bool {
        self.direction.cross(other.direction).length() < EXACT
    }

    /// Where it comes nearest to another line, and how near; `None` for parallel ones.
    fn meeting(&self, other: &Self) -> Option<(DVec3, f64)> {
        let normal = self.direction.cross(other.direction);
        let square = normal.length_squared();
        if square < EXACT * EXACT {
            return None;
        }
        let between = other.point - self.point;
        let along = between.cross(other.direction).dot(normal) / square;
        let gap = between.dot(normal).abs() / square.sqrt();
        Some((self.point + self.direction * along, gap))
    }
}

/// A six-axis arm that has a closed form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm {
    axes: [Axis; 6],
    kind: Kind,
    /// Where the last axes meet, with all values at zero.
    wrist: DVec3,
    /// The tip with all values at zero.
    tip: Frame,
}

/// What makes the closed form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The last three axes meet in a point.
    SphericalWrist,
    /// The second, third and fourth are parallel, and the last two meet.
    ThreeParallel,
}

impl Arm {
    /// The arm of these axes, from the base on, if it has a closed form.
    pub(super) fn of(axes: [Axis; 6], tip: Frame) -> Option<Self> {
        let size = axes.iter().map(|axis| axis.point.distance(tip.position));
        let size = size.fold(0.0, f64::max);
        let near = EXACT * size;
        let [_, second, third, fourth, fifth, sixth] = axes;
        let (wrist, gap) = fifth.meeting(&sixth)?;
        if gap > near {
            return None;
        }
        let off_fourth = (wrist - fourth.point).cross(fourth.direction).length();
        let kind = if off_fourth <= near {
            Kind::SphericalWrist
        } else if second.is_parallel(&third) && third.is_parallel(&fourth) {
            Kind::ThreeParallel
        } else {
            return None;
        };
        Some(Self {
            axes,
            kind,
            wrist,
            tip,
        })
    }

    pub(super) fn kind(&self) -> Kind {
        self.kind
    }

    /// All angles that bring the tip to a frame, at most eight, each within half a turn. Where the arm is singular
    /// there is no end of them, and the axis that may stand anywhere stands as in `now`.
    pub(super) fn solve(&self, goal: Frame, now: [f64; 6]) -> Vec<[f64; 6]> {
        // What carries the arm's last link from its place at zero to the goal.
        let turn = goal.orientation * self.tip.orientation.inverse();
        let carried = goal.position + turn * (self.wrist - self.tip.position);
        match self.kind {
            Kind::SphericalWrist => self.wrist_last(turn, carried, now),
            Kind::ThreeParallel => self.parallels_last(turn, carried, now),
        }
    }

    /// Pieper (1968): the place of the wrist gives the first three angles, the orientation the others.
    fn wrist_last(&self, turn: DQuat, wrist: DVec3, now: [f64; 6]) -> Vec<[f64; 6]> {
        let [first, second, third, fourth, fifth, sixth] = &self.axes;
        let size = (self.wrist - second.point).length() + (wrist - second.point).length();
        if size == 0.0 {
            return Vec::new();
        }
        // The goal, brought back about the first axis, and the wrist, carried about the third, are on one circle about
        // the second: as far along it, and as far from a point of it.
        let [along_1, cos_1, sin_1] = circle(first.direction, wrist - first.point);
        // Back is the other way round.
        let (sin_1, back_1) = (-sin_1, first.point + along_1 - second.point);
        let [along_3, cos_3, sin_3] = circle(third.direction, self.wrist - third.point);
        let forth_3 = third.point + along_3 - second.point;
        let axis = second.direction;
        let square =
            |middle: DVec3, radius: DVec3| middle.length_squared() + radius.length_squared();
        let circles = TwoCircles {
            left: DMat2::from_cols(
                DVec2::new(
                    axis.dot(cos_1) / size,
                    2.0 * back_1.dot(cos_1) / (size * size),
                ),
                DVec2::new(
                    axis.dot(sin_1) / size,
                    2.0 * back_1.dot(sin_1) / (size * size),
                ),
            ),
            constant: DVec2::new(
                axis.dot(back_1 - forth_3) / size,
                (square(back_1, cos_1) - square(forth_3, cos_3)) / (size * size),
            ),
            right: DMat2::from_cols(
                DVec2::new(
                    axis.dot(cos_3) / size,
                    2.0 * forth_3.dot(cos_3) / (size * size),
                ),
                DVec2::new(
                    axis.dot(sin_3) / size,
                    2.0 * forth_3.dot(sin_3) / (size * size),
                ),
            ),
        };
        // Where the wrist is over the first axis, that one may stand anywhere.
        let pairs = circles.solve().unwrap_or_else(|| vec![[now[0], now[2]]]);
        let mut all = Vec::new();
        for [q1, q3] in pairs {
            let from = third.carry(q3, self.wrist) - second.point;
            let to = first.carry(-q1, wrist) - second.point;
            let q2 = turn_onto(axis, from, to).unwrap_or(now[1]);
            let before = first.turn(q1) * second.turn(q2) * third.turn(q3);
            let rest = before.inverse() * turn;
            // Turned by the fifth angle, the sixth axis comes as near to the fourth as it must.
            let last = sixth.direction;
            let [along, cos, sin] = circle(fifth.direction, last);
            let aim = fourth.direction;
            let sum = aim.dot(rest * last - along);
            for q5 in linear(aim.dot(cos), aim.dot(sin), sum).unwrap_or_else(|| vec![now[4]]) {
                let bent = fifth.turn(q5);
                let q4 = match is_along(bent * last, aim) {
                    true => now[3],
                    false => turn_onto(aim, bent * last, rest * last).unwrap_or(now[3]),
                };
                let left = (fourth.turn(q4) * bent).inverse() * rest;
                all.push([q1, q2, q3, q4, q5, angle_about(left, last)]);
            }
        }
        all
    }

    /// As Hawkins (2013, "Analytic Inverse Kinematics for the Universal Robots UR-5/UR-10 Arms", Georgia Tech): what
    /// the three parallel axes cannot change gives the first and the fifth angle.
    fn parallels_last(&self, turn: DQuat, wrist: DVec3, now: [f64; 6]) -> Vec<[f64; 6]> {
        let [first, second, third, fourth, fifth, sixth] = &self.axes;
        let (axis, last) = (second.direction, sixth.direction);
        let size = (wrist - first.point).length().max(f64::MIN_POSITIVE);
        let mut all = Vec::new();
        // The wrist is as far along the parallel axes as at zero.
        let [along, cos, sin] = circle(first.direction, wrist - first.point);
        let sum = axis.dot(self.wrist - first.point - along);
        let q1s = linear(axis.dot(cos) / size, -axis.dot(sin) / size, sum / size);
        for q1 in q1s.unwrap_or_else(|| vec![now[0]]) {
            let back = first.turn(-q1);
            let rest = back * turn;
            let [along, cos, sin] = circle(fifth.direction, last);
            let sum = axis.dot(rest * last - along);
            let q5s = linear(axis.dot(cos), axis.dot(sin), sum);
            for q5 in q5s.unwrap_or_else(|| vec![now[4]]) {
                // Seen from the last link the parallel axes lie where the fifth and sixth angle put them.
                let seen = fifth.turn(-q5) * axis;
                let q6 = match is_along(seen, last) {
                    true => now[5],
                    false => turn_onto(-last, seen, rest.inverse() * axis).unwrap_or(now[5]),
                };
                // What the parallel axes do together: a turn about their direction, and a place.
                let ends = fifth.turn(q5) * sixth.turn(q6);
                let three = rest * ends.inverse();
                let sum_angle = angle_about(three, axis);
                let wrist_now = first.point + back * (wrist - first.point);
                let place = wrist_now + three * (fourth.point - self.wrist);
                // A point of the fourth axis is brought there by the second and third.
                let [along, cos, sin] = circle(third.direction, fourth.point - third.point);
                let middle = third.point + along - second.point;
                let flat = |v: DVec3| v - axis * axis.dot(v);
                let wanted = flat(place - second.point).length_squared();
                let (middle, cos, sin) = (flat(middle), flat(cos), flat(sin));
                let scale = size * size;
                let sum = wanted - middle.length_squared() - cos.length_squared();
                let q3s = linear(
                    2.0 * middle.dot(cos) / scale,
                    2.0 * middle.dot(sin) / scale,
                    sum / scale,
                );
                for q3 in q3s.unwrap_or_else(|| vec![now[2]]) {
                    let from = third.carry(q3, fourth.point) - second.point;
                    let q2 = turn_onto(axis, from, place - second.point).unwrap_or(now[1]);
                    // Parallel axes may point against each other.
                    let same = |other: &Axis| other.direction.dot(axis).signum();
                    let q4 = (sum_angle - q2 - same(third) * q3) * same(fourth);
                    all.push([q1, q2, q3, wrapped(q4), q5, q6]);
                }
            }
        }
        all
    }
}

/// Whether two directions are one line.
fn is_along(a: DVec3, b: DVec3) -> bool {
    a.cross(b).length() < EXACT
}

/// The angle of a rotation about an axis that it turns about.
fn angle_about(rotation: DQuat, axis: DVec3) -> f64 {
    wrapped(2.0 * libm::atan2(rotation.xyz().dot(axis), rotation.w))
}
