//! One chain of free joints and one position: points first, rotations once at the end.

use glam::{DQuat, DVec3};

use super::points::at_length;
use super::{Figure, Scratch};
use crate::ik::linkage::{Linkage, NONE};
use crate::ik::solve::Progress;
use crate::ik::trace::TraceIteration;
use crate::ik::turn::shortest_turn;

/// By how much the points of a chain are bent that stands still, as a share of its reach.
const NUDGE_SHARE: f64 = 0.01;

/// Runs FABRIK on the chain.
pub(super) fn run(
    figure: &Figure<'_>,
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    mut progress: Progress,
) -> Progress {
    let Scratch {
        points, lengths, ..
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
        let is_settled = reach.iterate(points, lengths);
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

    /// One pass inward and one outward. Whether the points have come to rest.
    fn iterate(&mut self, points: &mut [DVec3], lengths: &[f64]) -> bool {
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
        points[last] = self.target;
        for i in (0..last).rev() {
            points[i] = points[i + 1] + at_length(points[i] - points[i + 1], lengths[i]);
        }
        points[0] = self.base;
        for i in 0..last {
            points[i + 1] = points[i] + at_length(points[i + 1] - points[i], lengths[i]);
        }
        let now_sq = points[last].distance_squared(self.target);
        let has_rested = self.left_sq.sqrt() - now_sq.sqrt() <= self.rest;
        self.at_rest = if has_rested { self.at_rest + 1 } else { 0 };
        self.left_sq = now_sq;
        if self.at_rest < 3 || now_sq <= self.tolerance_sq {
            return false;
        }
        if self.nudges == 2 {
            return true;
        }
        self.nudges += 1;
        self.at_rest = 0;
        nudge(points, self.length, to_target);
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

/// Moves inner points to the side of the line, one way and the other in turn.
fn nudge(points: &mut [DVec3], reach: f64, line: DVec3) {
    let side = crate::ik::turn::perpendicular(line) * (NUDGE_SHARE * reach);
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
        if let Some(turn) = shortest_turn(carried, points[k + 1] - position) {
            inner = turn * inner;
        }
        linkage.turns[k] = inner;
        position += inner * offset;
    }
}
