//! Aim: one joint turns so that a point of its link, or of what it carries, looks at the target.
//!
//! The effector's direction from the joint is brought to that of the target by the least turn; a pole then
//! settles the turn about that line (Unreal and ozz-animation call this an aim or look-at constraint). It is
//! one step of cyclic coordinate descent.
//!
//! The target counts as reached when the direction is right, however far away it is; the residual's
//! distance is that of the effector's point all the same.
//!
//! **Guarantees and degenerate inputs.** A target at the joint gives no direction and no turn; one right
//! behind is half a turn away, about an axis that depends on nothing but the direction of aim.

use glam::{DQuat, DVec3};

use super::linkage::Linkage;
use super::problem::{IkProblem, TraceDetail};
use super::solve::Progress;
use super::trace::TraceIteration;
use super::turn::{shortest_turn, shortest_turn_and_roll};
use super::workspace::IkWorkspace;
use crate::pose::LocalPose;
use crate::skeleton::Skeleton;

/// How a joint is aimed. Any space, any length unit; all in one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The joint.
    pub joint: DVec3,
    /// The direction that is aimed, such as where a face looks. Any length.
    pub forward: DVec3,
    /// What it is aimed at.
    pub target: DVec3,
    /// A direction of the joint's link, such as the top of a head, and the one in which it should be as
    /// nearly as aiming allows.
    pub up: Option<[DVec3; 2]>,
}

/// The turn that aims, to be applied to the joint's orientation from the left.
#[inline]
pub fn aim(aim: &Aim) -> DQuat {
    let to_target = aim.target - aim.joint;
    match aim.up {
        None => shortest_turn(aim.forward, to_target).unwrap_or(DQuat::IDENTITY),
        Some([up, wanted]) => shortest_turn_and_roll(aim.forward, to_target, up, wanted)
            .unwrap_or_else(|| aim_carefully(aim.forward, to_target, up, wanted)),
    }
}

/// The turn and the roll one after the other, each where there is one.
#[cold]
fn aim_carefully(forward: DVec3, to_target: DVec3, up: DVec3, wanted: DVec3) -> DQuat {
    let Some(turn) = shortest_turn(forward, to_target) else {
        return DQuat::IDENTITY;
    };
    let line_sq = to_target.length_squared();
    let aside = |v: DVec3| v - to_target * (v.dot(to_target) / line_sq);
    let (from, to) = (aside(turn * up), aside(wanted));
    let size_sq = from.length_squared() * to.length_squared();
    if size_sq <= 1e-24 * up.length_squared() * wanted.length_squared() {
        return turn;
    }
    if from.dot(to) < -0.999_999 * size_sq.sqrt() {
        return DQuat::from_vec4((to_target / line_sq.sqrt()).extend(0.0)) * turn;
    }
    shortest_turn(from, to).map_or(turn, |roll| roll * turn)
}

/// Aims the last joint of each chain that turns and is apart from its effector.
pub(crate) fn run(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    workspace: &mut IkWorkspace,
) -> Progress {
    let linkage = &mut workspace.linkage;
    linkage.enforce_limits();
    let mut record = TraceIteration::default();
    let is_traced = problem.trace == TraceDetail::Updates;
    for (index, target) in problem.targets.iter().enumerate() {
        let Some(k) = aiming_pivot(linkage, index) else {
            continue;
        };
        let before = linkage.effector_position(index);
        let turn = aim(&Aim {
            joint: linkage.positions[k],
            forward: before - linkage.positions[k],
            target: target.position_in_world,
            up: None,
        });
        let start = linkage.turns[k];
        linkage.set_turn(k, turn * start);
        if is_traced {
            let made = linkage.turns[k] * start.conjugate();
            let points = [
                before,
                linkage.effector_position(index),
                target.position_in_world,
            ];
            record
                .updates
                .push(linkage.trace_turn(k, index, made, points, pose));
        }
    }
    let record = is_traced.then_some(record);
    Progress::in_closed_form(linkage, skeleton, pose, problem, record)
}

/// The pivot that aims: the first on the effector's way that turns and lies apart from it.
fn aiming_pivot(linkage: &Linkage, index: usize) -> Option<usize> {
    let end = linkage.effector_position(index);
    let path = linkage.path(index).iter().map(|&k| k as usize);
    path.into_iter()
        .find(|&k| linkage.pivots[k].turns && linkage.positions[k].distance_squared(end) > 0.0)
}

/// Whether every effector looks at its target, within the tolerance.
pub(crate) fn is_aimed(linkage: &Linkage, problem: &IkProblem) -> bool {
    problem.targets.iter().enumerate().all(|(index, target)| {
        let Some(k) = aiming_pivot(linkage, index) else {
            return false;
        };
        let at = linkage.positions[k];
        let (a, b) = (
            linkage.effector_position(index) - at,
            target.position_in_world - at,
        );
        let angle_rad = libm::atan2(a.cross(b).length(), a.dot(b));
        b != DVec3::ZERO && angle_rad <= problem.stop.orientation_tolerance_rad
    })
}
