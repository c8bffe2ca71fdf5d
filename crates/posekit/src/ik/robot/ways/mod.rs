//! All the ways in which a robot can reach one target.
//!
//! A six-axis arm has up to eight: shoulder left or right, elbow up or down, wrist flipped or not. They are found in
//! closed form where the arm has one, told by its geometry and not by its name: the last three axes meet in a point
//! (Pieper 1968), or the second, third and fourth are parallel and the last two meet (Universal Robots; Hawkins 2013).
//! Any other robot is searched from many starts. Ways differ modulo whole turns: an axis that may turn further than
//! once does not make the same posture another way.
//!
//! **Guarantees.** Every way is within the ranges of all that moves the effector, and reaches the target, by forward
//! kinematics; what does not move the effector stays as it is. No two are equal modulo turns. In closed form none is
//! missing, away from singularities. A search may miss one.
//!
//! **Degenerate inputs.** Where the target leaves a robot free to move, or an arm is singular, there is no end of
//! ways; a few of them are given, and [`Ways::is_endless`] says so.

mod closed_form;
mod trig;

use super::dexterity::{Dexterity, Task, jacobian};
use super::{RobotConfig, RobotWorkspace, solve_robot};
use crate::ik::IkTarget;
use crate::ik::random::Random;
use crate::mechanism::{Frame, Freedom, Mechanism, ValueRange};
use crate::skeleton::JointId;
use closed_form::{Arm, Axis, Kind};
use core::f64::consts::{PI, TAU};
use trig::wrapped;

/// How [`ways_to`] is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaysConfig {
    /// When the target counts as reached.
    pub robot: RobotConfig,
    /// How many starts a search makes.
    pub searches: u32,
    /// Two ways are one when no value differs by more than this, modulo turns: radians or the unit of length.
    pub apart: f64,
    /// The most ways that are given where there is no end of them.
    pub most_of_endless: usize,
}

impl Default for WaysConfig {
    /// 400 starts, a hundredth of a radian, eight ways out of endlessly many.
    fn default() -> Self {
        Self {
            robot: RobotConfig {
                max_attempts: 1,
                ..RobotConfig::default()
            },
            searches: 400,
            apart: 1e-2,
            most_of_endless: 8,
        }
    }
}

/// How the ways to a target were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WaysMethod {
    /// In closed form: the last three axes meet in a point.
    SphericalWrist,
    /// In closed form: the second, third and fourth axis are parallel, and the last two meet.
    ThreeParallelAxes,
    /// From many starts.
    Search,
}

/// The ways to a target.
#[derive(Clone, Debug, PartialEq)]
pub struct Ways {
    /// Values of the whole mechanism, the nearest to those given first. Empty where the target is not reached.
    pub ways: Vec<Vec<f64>>,
    /// How they were found.
    pub method: WaysMethod,
    /// Whether these are some of endlessly many.
    pub is_endless: bool,
}

/// Where there is no end of ways, those that are given differ by so much: enough to be seen.
const APART_OF_ENDLESS: f64 = 0.4;

/// A value outside its range by this much is at its end: rounding.
const AT_END: f64 = 1e-9;

/// Singular values below this share of the largest are rounding.
const NO_MOTION: f64 = 1e-7;

/// Finds all ways to a target. `values` are where the robot stands: values that do not move the effector stay, and
/// of equal ones modulo turns the nearest is given.
///
/// # Panics
/// If there are not as many values as the mechanism has, or the target names a joint that it has not.
pub fn ways_to(
    mechanism: &Mechanism,
    values: &[f64],
    target: &IkTarget,
    config: &WaysConfig,
) -> Ways {
    let mut search = Search {
        mechanism,
        values,
        target,
        config,
        ranges: mechanism.value_ranges(),
        turns: turning_values(mechanism),
        moves: moving_values(mechanism, target.effector),
        workspace: RobotWorkspace::new(),
        found: Vec::new(),
    };
    let (method, is_searched) = match closed_form(mechanism, values, target) {
        Some((arm, indices, goal)) => {
            let now = indices.map(|index| values[index]);
            for angles in arm.solve(goal, now) {
                let mut way = values.to_vec();
                for (index, angle) in indices.into_iter().zip(angles) {
                    way[index] = angle;
                }
                search.take(way, config.apart);
            }
            let method = match arm.kind() {
                Kind::SphericalWrist => WaysMethod::SphericalWrist,
                Kind::ThreeParallel => WaysMethod::ThreeParallelAxes,
            };
            (method, false)
        }
        None => (WaysMethod::Search, true),
    };
    if is_searched {
        search.run();
    }
    let is_endless = search.is_endless();
    let mut ways = search.found;
    let turns = turning_values(mechanism);
    ways.sort_by(|a, b| {
        let far = |way: &[f64]| gap(&turns, way, values);
        far(a).total_cmp(&far(b))
    });
    if is_endless {
        ways.truncate(config.most_of_endless);
    }
    Ways {
        ways,
        method,
        is_endless,
    }
}

struct Search<'a> {
    mechanism: &'a Mechanism,
    values: &'a [f64],
    target: &'a IkTarget,
    config: &'a WaysConfig,
    ranges: Vec<ValueRange>,
    turns: Vec<bool>,
    /// By value: whether the effector depends on it.
    moves: Vec<bool>,
    workspace: RobotWorkspace,
    found: Vec<Vec<f64>>,
}

impl Search<'_> {
    /// From where the robot stands, and from random places.
    fn run(&mut self) {
        let mut random = Random::seeded(self.config.robot.seed);
        self.take(self.values.to_vec(), self.config.apart);
        // What is endless is so everywhere but at singularities.
        let mut is_endless = false;
        for start in 0..self.config.searches {
            if start == 0 || self.found.len() == 1 {
                is_endless = self.is_endless();
            }
            if is_endless && self.found.len() >= self.config.most_of_endless {
                return;
            }
            let apart = match is_endless {
                true => APART_OF_ENDLESS,
                false => self.config.apart,
            };
            let spread = |range: &ValueRange, now: f64| {
                let lower = if range.lower.is_finite() {
                    range.lower
                } else {
                    now - PI
                };
                let upper = if range.upper.is_finite() {
                    range.upper
                } else {
                    now + PI
                };
                [lower, upper.max(lower)]
            };
            let ranges = self.ranges.iter().zip(self.values).zip(&self.moves);
            let start = ranges.map(|((range, &now), &moves)| {
                let [lower, upper] = spread(range, now);
                match moves {
                    true => random.between(lower, upper),
                    false => now,
                }
            });
            let start = start.collect();
            self.take(start, apart);
        }
    }

    /// Takes a way from near which the target is reached, unless it is known.
    fn take(&mut self, mut way: Vec<f64>, apart: f64) {
        if !self.bring_within(&mut way) {
            return;
        }
        let target = std::slice::from_ref(self.target);
        let config = RobotConfig {
            max_attempts: 1,
            ..self.config.robot
        };
        let workspace = &mut self.workspace;
        let report = solve_robot(self.mechanism, &mut way, target, &config, workspace);
        if !report.outcome.is_reached() || !self.bring_within(&mut way) {
            return;
        }
        let is_known = |known: &Vec<f64>| gap(&self.turns, known, &way) <= apart;
        if !self.found.iter().any(is_known) {
            self.found.push(way);
        }
    }

    /// Turns every value that the effector depends on by whole turns into its range, to the place nearest to where
    /// the robot stands. False where that is not possible.
    fn bring_within(&self, way: &mut [f64]) -> bool {
        let kinds = self.turns.iter().zip(&self.moves);
        let ranges = self.ranges.iter().zip(kinds).zip(self.values);
        way.iter_mut()
            .zip(ranges)
            .filter(|(_, ((_, (_, moves)), _))| **moves)
            .all(|(value, ((range, (&turns, _)), &now))| {
                let mut near = *value;
                if turns {
                    near = now + wrapped(*value - now);
                    if near < range.lower - AT_END {
                        near += TAU * ((range.lower - AT_END - near) / TAU).ceil();
                    } else if near > range.upper + AT_END {
                        near -= TAU * ((near - range.upper - AT_END) / TAU).ceil();
                    }
                }
                *value = range.clamp(near);
                (near - *value).abs() <= 2.0 * AT_END
            })
    }

    /// Whether the effector stays while values move, at every way that was found.
    fn is_endless(&self) -> bool {
        let task = match self.target.orientation_in_world {
            Some(_) => Task::Pose { radian_length: 1.0 },
            None => Task::Position,
        };
        let (effector, point) = (self.target.effector, self.target.point_in_effector);
        let is_free = |way: &Vec<f64>| {
            let jacobian = jacobian(self.mechanism, way, effector, point);
            let columns = jacobian.columns.iter();
            let moving = columns.filter(|(slid, turned)| {
                *slid != glam::DVec3::ZERO || *turned != glam::DVec3::ZERO
            });
            let moving = moving.count();
            let sizes = Dexterity::of(&jacobian, task).singular_values;
            let least = NO_MOTION * sizes.first().copied().unwrap_or(0.0);
            moving > sizes.iter().filter(|&&size| size > least).count()
        };
        !self.found.is_empty() && self.found.iter().all(is_free)
    }
}

/// The largest difference of two lists of values, modulo turns of those that turn.
fn gap(turns: &[bool], a: &[f64], b: &[f64]) -> f64 {
    let differences = a
        .iter()
        .zip(b)
        .zip(turns)
        .map(|((a, b), &turns)| match turns {
            true => wrapped(a - b).abs(),
            false => (a - b).abs(),
        });
    differences.fold(0.0, f64::max)
}

/// For each value whether a whole turn of it changes nothing: that of a hinge which no other joint follows.
fn turning_values(mechanism: &Mechanism) -> Vec<bool> {
    let mut turns = vec![false; mechanism.value_count()];
    for joint in mechanism.moving_joints() {
        if matches!(mechanism.joint(joint).freedom, Freedom::Hinge { .. }) {
            turns[mechanism.values_of_joint(joint).start] = true;
        }
    }
    for joint in mechanism.skeleton().joints() {
        if let Some(followed) = mechanism.followed_value(joint) {
            turns[followed.index] = false;
        }
    }
    turns
}

/// For each value whether the effector depends on it: those of the joints on the way to the root, and those that these
/// follow.
fn moving_values(mechanism: &Mechanism, effector: JointId) -> Vec<bool> {
    let mut moves = vec![false; mechanism.value_count()];
    let above = mechanism.skeleton().ancestors(effector);
    for joint in std::iter::once(effector).chain(above) {
        match mechanism.followed_value(joint) {
            Some(followed) => moves[followed.index] = true,
            None => moves[mechanism.values_of_joint(joint)].fill(true),
        }
    }
    moves
}

/// The arm that moves the effector, if it has a closed form: its values, and where its tip is to be.
fn closed_form(
    mechanism: &Mechanism,
    values: &[f64],
    target: &IkTarget,
) -> Option<(Arm, [usize; 6], Frame)> {
    let orientation = target.orientation_in_world.filter(|_| target.is_valid())?;
    let skeleton = mechanism.skeleton();
    let movers = std::iter::once(target.effector).chain(skeleton.ancestors(target.effector));
    let mut hinges: Vec<JointId> = movers
        .filter(|&joint| mechanism.joint(joint).freedom != Freedom::Fixed)
        .collect();
    hinges.reverse();
    let hinges: [JointId; 6] = hinges.try_into().ok()?;
    let mut at_zero = values.to_vec();
    let mut indices = [0; 6];
    for (index, &hinge) in indices.iter_mut().zip(&hinges) {
        let own = mechanism.values_of_joint(hinge);
        if own.len() != 1 {
            return None;
        }
        *index = own.start;
        at_zero[own.start] = 0.0;
    }
    let frames = mechanism.global_frames(&at_zero);
    let mut axes = Vec::with_capacity(6);
    for hinge in hinges {
        let Freedom::Hinge { axis } = mechanism.joint(hinge).freedom else {
            return None;
        };
        let frame = &frames[hinge.index()];
        axes.push(Axis {
            direction: (frame.orientation * axis).normalize(),
            point: frame.position,
        });
    }
    let tip = frames[target.effector.index()];
    let tip = Frame {
        position: tip.position + tip.orientation * target.point_in_effector,
        ..tip
    };
    let goal = Frame {
        position: target.position_in_world,
        orientation: orientation.normalize(),
    };
    Some((Arm::of(axes.try_into().ok()?, tip)?, indices, goal))
}
