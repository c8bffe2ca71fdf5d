//! One chain of free joints and one position: points first, rotations once at the end.

use glam::{DQuat, DVec3};

use super::points::at_length;
use super::{Figure, Scratch};
use crate::ik::linkage::{Linkage, NONE};
use crate::ik::solve::{Progress, rest_distance};
use crate::ik::trace::TraceIteration;
use crate::ik::turn::{perpendicular, shortest_turn_inline};

/// By how much the points of a chain are bent that stands still, as a share of its reach: in this order until
/// an iteration from there comes nearer than the chain stood.
const NUDGE_SHARES: [f64; 3] = [0.01, 0.002, 0.1];

/// How often it is bent.
const MOST_NUDGES: u32 = 8;

/// Runs FABRIK on the chain.
pub(super) fn run(
    figure: &Figure<'_>,
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    mut progress: Progress,
) -> Progress {
    let Scratch {
        points,
        spare,
        lengths,
        ..
    } = scratch;
    points.clear();
    points.extend_from_slice(&linkage.positions);
    points.push(linkage.effector_position(0));
    lengths.clear();
    lengths.extend(
        linkage.pivots[1..]
            .iter()
            .map(|pivot| pivot.offset.length()),
    );
    lengths.push(linkage.effectors[0].offset.length());
    let target = figure.problem.targets[0].position_in_world;
    let mut reach = Reach::new(points, lengths, target, figure);
    while !reach.is_over(&progress) {
        let is_settled = reach.iterate(points, spare, lengths);
        progress.iterations += 1;
        if let Some(trace) = &mut progress.trace {
            let mut record = TraceIteration::default();
            record_turns(figure, linkage, points, &mut record);
            linkage.end_iteration(figure.pose, figure.skeleton, figure.problem, &mut record);
            trace.iterations.push(record);
        }
        if is_settled {
            progress.is_settled = true;
            break;
        }
    }
    if progress.iterations > 0 {
        recover(linkage, points);
    }
    progress
}

/// How far the loop has come.
struct Reach {
    base: DVec3,
    target: DVec3,
    /// Length of the stretched chain.
    length: f64,
    tolerance_sq: f64,
    /// The square of the distance beyond which a chain at rest is stuck.
    stuck_sq: f64,
    most: u32,
    /// An improvement by less than this is none.
    rest: f64,
    left_sq: f64,
    at_rest: u32,
    nudges: u32,
}

impl Reach {
    fn new(points: &[DVec3], lengths: &[f64], target: DVec3, figure: &Figure<'_>) -> Self {
        let stop = &figure.problem.stop;
        Self {
            base: points[0],
            target,
            length: lengths.iter().sum(),
            tolerance_sq: stop.position_tolerance * stop.position_tolerance,
            stuck_sq: rest_distance(figure.problem) * rest_distance(figure.problem),
            most: stop.max_iterations,
            rest: figure.config.rest_share * stop.position_tolerance,
            left_sq: points[points.len() - 1].distance_squared(target),
            at_rest: 0,
            nudges: 0,
        }
    }

    fn is_over(&self, progress: &Progress) -> bool {
        self.left_sq <= self.tolerance_sq || progress.iterations >= self.most
    }

    /// One pass inward and one outward, if that comes nearer. Whether the points have come to rest.
    fn iterate(
        &mut self,
        points: &mut Vec<DVec3>,
        spare: &mut [Vec<DVec3>; 2],
        lengths: &[f64],
    ) -> bool {
        let last = points.len() - 1;
        let to_target = self.target - self.base;
        if to_target.length_squared() >= self.length * self.length {
            let direction = to_target.normalize_or_zero();
            for i in 0..last {
                points[i + 1] = points[i] + direction * lengths[i];
            }
            self.left_sq = points[last].distance_squared(self.target);
            return self.left_sq > self.tolerance_sq;
        }
        let now_sq = self.pass(points, &mut spare[0], lengths);
        let has_rested = self.left_sq.sqrt() - now_sq.sqrt() <= self.rest;
        let gains = now_sq < self.left_sq;
        if gains {
            core::mem::swap(points, &mut spare[0]);
            self.left_sq = now_sq;
        }
        self.at_rest = if has_rested { self.at_rest + 1 } else { 0 };
        if self.left_sq <= self.tolerance_sq || (gains && self.at_rest < 3) {
            return false;
        }
        if self.left_sq <= self.stuck_sq {
            return !gains;
        }
        if self.nudges == MOST_NUDGES {
            return true;
        }
        self.nudges += 1;
        self.at_rest = 0;
        !self.escape(points, spare, lengths)
    }

    /// Both passes, from the points into other memory; the square of what is left there.
    fn pass(&self, points: &[DVec3], next: &mut Vec<DVec3>, lengths: &[f64]) -> f64 {
        let last = points.len() - 1;
        next.resize(points.len(), DVec3::ZERO);
        next[last] = self.target;
        for i in (0..last).rev() {
            next[i] = next[i + 1] + at_length(points[i] - next[i + 1], lengths[i]);
        }
        next[0] = self.base;
        for i in 0..last {
            next[i + 1] = next[i] + at_length(next[i + 1] - next[i], lengths[i]);
        }
        next[last].distance_squared(self.target)
    }

    /// Bends a chain that is stuck and iterates once from there, if that brings it nearer; whether it does.
    fn escape(
        &mut self,
        points: &mut Vec<DVec3>,
        [next, bent]: &mut [Vec<DVec3>; 2],
        lengths: &[f64],
    ) -> bool {
        let line = self.target - self.base;
        for share in NUDGE_SHARES {
            let side = perpendicular(line) * (share * self.length);
            bent.clone_from(points);
            nudge(bent, side);
            let now_sq = self.pass(bent, next, lengths);
            if now_sq < self.left_sq {
                self.left_sq = now_sq;
                core::mem::swap(points, next);
                return true;
            }
        }
        false
    }
}

/// Recovers the turns that an iteration led to and records them.
fn record_turns(
    figure: &Figure<'_>,
    linkage: &mut Linkage,
    points: &[DVec3],
    record: &mut TraceIteration,
) {
    let before = (linkage.turns.clone(), linkage.positions.clone());
    let end_before = linkage.effector_position(0);
    recover(linkage, points);
    let end = linkage.effector_position(0);
    for k in 0..linkage.pivots.len() {
        let carried = linkage.inner_turn(k)
            * match linkage.pivots[k].parent {
                NONE => DQuat::IDENTITY,
                parent => before.0[parent as usize].conjugate(),
            };
        let turn = linkage.turns[k] * (carried * before.0[k]).conjugate();
        // Where the effector was as seen from the joint, had the joints inside carried it along.
        let was = linkage.positions[k] + carried * (end_before - before.1[k]);
        let points = [was, end, figure.problem.targets[0].position_in_world];
        record
            .updates
            .push(linkage.trace_turn(k, 0, turn, points, figure.pose));
    }
}

/// Moves inner points to the side, one way and the other in turn.
fn nudge(points: &mut [DVec3], side: DVec3) {
    let last = points.len() - 1;
    for (i, point) in points[1..last].iter_mut().enumerate() {
        *point += if i % 2 == 0 { side } else { -side };
    }
}

/// Turns each joint so that the next point is where FABRIK put it.
fn recover(linkage: &mut Linkage, points: &[DVec3]) {
    let count = linkage.pivots.len();
    let mut inner = DQuat::IDENTITY;
    let mut position = linkage.positions[0];
    for k in 0..count {
        let offset = match linkage.pivots.get(k + 1) {
            Some(next) => next.offset,
            None => linkage.effectors[0].offset,
        };
        debug_assert!(linkage.pivots[k].parent == NONE || k > 0, "a chain");
        linkage.positions[k] = position;
        let carried = inner * offset;
        // Towards the point itself rather than along the difference of two points: rounding does not
        // add up along the chain.
        if let Some(turn) = shortest_turn_inline(carried, points[k + 1] - position) {
            inner = turn * inner;
        }
        linkage.turns[k] = inner;
        position += inner * offset;
    }
}
