//! One chain of free joints and one position: the loop without anything that it does not need.
//!
//! A joint's turn puts the effector on the line to the target, as far from the joint as it was. That place
//! takes no rotation to find, so that one joint need not wait for the quaternion of the one before it.

use glam::{DQuat, DVec3};

use super::{AT_REST, CcdConfig, MOST_NUDGES, NUDGE_RAD, SweepOrder};
use crate::ik::linkage::Linkage;
use crate::ik::problem::IkProblem;
use crate::ik::solve::Progress;
use crate::ik::turn::shortest_turn;

/// Runs the loop on a chain.
pub(super) fn run(
    linkage: &mut Linkage,
    added: &mut [DQuat],
    problem: &IkProblem,
    config: &CcdConfig,
) -> Progress {
    let target = problem.targets[0].position_in_world;
    let tolerance_sq = problem.stop.position_tolerance * problem.stop.position_tolerance;
    let mut progress = Progress::default();
    let mut effector = linkage.effector_position(0);
    let mut nudges = 0;
    while progress.iterations < problem.stop.max_iterations
        && effector.distance_squared(target) > tolerance_sq
    {
        let largest_sq = match config.order {
            SweepOrder::TipToBase => tip_to_base(linkage, added, effector, target),
            SweepOrder::BaseToTip => base_to_tip(linkage, effector, target),
        };
        effector = linkage.effector_position(0);
        progress.iterations += 1;
        if largest_sq <= AT_REST * AT_REST && effector.distance_squared(target) > tolerance_sq {
            if nudges == MOST_NUDGES || !linkage.nudge(NUDGE_RAD) {
                progress.is_settled = true;
                break;
            }
            effector = linkage.effector_position(0);
            nudges += 1;
        }
    }
    progress
}

/// The turn of a joint and where it brings the effector; `None` where there is no direction.
#[inline(always)]
fn turn(pivot: DVec3, effector: DVec3, target: DVec3) -> Option<(DQuat, DVec3)> {
    let (a, b) = (effector - pivot, target - pivot);
    let turn = shortest_turn(a, b)?;
    let share = (a.length_squared() / b.length_squared()).sqrt();
    Some((turn, pivot + b * share))
}

fn tip_to_base(linkage: &mut Linkage, added: &mut [DQuat], effector: DVec3, target: DVec3) -> f64 {
    let count = linkage.pivots.len();
    let (positions, turns) = (&mut linkage.positions[..count], &mut linkage.turns[..count]);
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
    let mut carried = DQuat::IDENTITY;
    let mut position = positions[0];
    for k in 0..count {
        positions[k] = position;
        carried *= added[k];
        turns[k] = carried * turns[k];
        if let Some(next) = pivots.get(k + 1) {
            position += turns[k] * next.offset;
        }
    }
    largest_sq
}

fn base_to_tip(linkage: &mut Linkage, effector: DVec3, target: DVec3) -> f64 {
    let count = linkage.pivots.len();
    let (positions, turns) = (&mut linkage.positions[..count], &mut linkage.turns[..count]);
    let pivots = &linkage.pivots[..count];
    let mut effector = effector;
    let mut largest_sq = 0.0_f64;
    let mut carried = DQuat::IDENTITY;
    let mut position = positions[0];
    for k in 0..count {
        positions[k] = position;
        if let Some((turn, moved)) = turn(position, effector, target) {
            effector = moved;
            largest_sq = largest_sq.max(4.0 * turn.xyz().length_squared());
            carried = turn * carried;
        }
        turns[k] = carried * turns[k];
        if let Some(next) = pivots.get(k + 1) {
            position += turns[k] * next.offset;
        }
    }
    largest_sq
}
