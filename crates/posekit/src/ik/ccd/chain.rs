//! One chain of free joints and one position: the loop without anything that it does not need.
//!
//! A joint's turn puts the effector on the line to the target, as far from the joint as it was. That place
//! takes no rotation to find, so that one joint need not wait for the quaternion of the one before it.

use glam::{DQuat, DVec3};

use super::{AT_REST, MOST_NUDGES, Scratch, SweepOrder, nudges};
use crate::ik::linkage::{Linkage, State};
use crate::ik::problem::IkProblem;
use crate::ik::solve::{Progress, is_short};
use crate::ik::turn::shortest_turn_inline;

/// Runs the loop on a chain.
pub(super) fn run(
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    problem: &IkProblem,
    order: SweepOrder,
) -> Progress {
    let target = problem.targets[0].position_in_world;
    let tolerance_sq = problem.stop.position_tolerance * problem.stop.position_tolerance;
    let mut progress = Progress::default();
    let mut left_sq = linkage.effector_position(0).distance_squared(target);
    let mut nudge_count = 0;
    scratch.next.store(linkage);
    while progress.iterations < problem.stop.max_iterations && left_sq > tolerance_sq {
        // Into other memory than it reads: a sweep that did not come nearer is thus not made.
        let largest_sq = sweep(
            linkage,
            &mut scratch.next,
            &mut scratch.added,
            order,
            target,
        );
        progress.iterations += 1;
        let now_sq = swap(linkage, &mut scratch.next, target);
        let gains = now_sq < left_sq;
        if gains {
            left_sq = now_sq;
        } else {
            swap(linkage, &mut scratch.next, target);
        }
        let is_still = largest_sq <= AT_REST * AT_REST;
        if (gains && !is_still) || left_sq <= tolerance_sq {
            continue;
        }
        let is_stuck = is_short(linkage, problem);
        if gains && !is_stuck {
            continue;
        }
        if !is_stuck
            || nudge_count == MOST_NUDGES
            || !escape(linkage, scratch, order, target, &mut left_sq)
        {
            progress.is_settled = true;
            break;
        }
        nudge_count += 1;
    }
    progress
}

/// Bends a chain that is stuck and sweeps once from there, if that brings it nearer; whether it does.
fn escape(
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    order: SweepOrder,
    target: DVec3,
    left_sq: &mut f64,
) -> bool {
    scratch.best.store(linkage);
    for (angle_rad, way) in nudges() {
        if !linkage.nudge(angle_rad, way) {
            break;
        }
        sweep(
            linkage,
            &mut scratch.next,
            &mut scratch.added,
            order,
            target,
        );
        let now_sq = swap(linkage, &mut scratch.next, target);
        if now_sq < *left_sq {
            *left_sq = now_sq;
            return true;
        }
        linkage.recall(&scratch.best);
    }
    false
}

/// Makes the other state the linkage's; the square of how far the effector is from the target there.
fn swap(linkage: &mut Linkage, other: &mut State, target: DVec3) -> f64 {
    core::mem::swap(&mut linkage.turns, &mut other.turns);
    core::mem::swap(&mut linkage.positions, &mut other.positions);
    linkage.effector_position(0).distance_squared(target)
}

/// One pass over all joints, from the linkage's state into `next`; the square of the largest turn.
fn sweep(
    linkage: &Linkage,
    next: &mut State,
    added: &mut [DQuat],
    order: SweepOrder,
    target: DVec3,
) -> f64 {
    let effector = linkage.effector_position(0);
    match order {
        SweepOrder::TipToBase => tip_to_base(linkage, next, added, effector, target),
        SweepOrder::BaseToTip => base_to_tip(linkage, next, effector, target),
    }
}

/// The turn of a joint and where it brings the effector; `None` where there is no direction.
#[inline(always)]
fn turn(pivot: DVec3, effector: DVec3, target: DVec3) -> Option<(DQuat, DVec3)> {
    let (a, b) = (effector - pivot, target - pivot);
    let turn = shortest_turn_inline(a, b)?;
    let share = (a.length_squared() / b.length_squared()).sqrt();
    Some((turn, pivot + b * share))
}

fn tip_to_base(
    linkage: &Linkage,
    next: &mut State,
    added: &mut [DQuat],
    effector: DVec3,
    target: DVec3,
) -> f64 {
    let count = linkage.pivots.len();
    let (positions, turns) = (&linkage.positions[..count], &linkage.turns[..count]);
    let (pivots, added) = (&linkage.pivots[..count], &mut added[..count]);
    let mut effector = effector;
    let mut largest_sq = 0.0_f64;
    for k in (0..count).rev() {
        added[k] = match turn(positions[k], effector, target) {
            Some((turn, moved)) => {
                effector = moved;
                largest_sq = largest_sq.max(4.0 * turn.xyz().length_squared());
                turn
            }
            None => DQuat::IDENTITY,
        };
    }
    let (positions, turned) = (&mut next.positions[..count], &mut next.turns[..count]);
    let mut carried = DQuat::IDENTITY;
    let mut position = linkage.positions[0];
    for k in 0..count {
        positions[k] = position;
        carried *= added[k];
        turned[k] = carried * turns[k];
        if let Some(next) = pivots.get(k + 1) {
            position += turned[k] * next.offset;
        }
    }
    largest_sq
}

fn base_to_tip(linkage: &Linkage, next: &mut State, effector: DVec3, target: DVec3) -> f64 {
    let count = linkage.pivots.len();
    let turns = &linkage.turns[..count];
    let pivots = &linkage.pivots[..count];
    let (positions, turned) = (&mut next.positions[..count], &mut next.turns[..count]);
    let mut effector = effector;
    let mut largest_sq = 0.0_f64;
    let mut carried = DQuat::IDENTITY;
    let mut position = linkage.positions[0];
    for k in 0..count {
        positions[k] = position;
        if let Some((turn, moved)) = turn(position, effector, target) {
            effector = moved;
            largest_sq = largest_sq.max(4.0 * turn.xyz().length_squared());
            carried = turn * carried;
        }
        turned[k] = carried * turns[k];
        if let Some(next) = pivots.get(k + 1) {
            position += turned[k] * next.offset;
        }
    }
    largest_sq
}
