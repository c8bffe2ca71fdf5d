//! Several targets, limits, orientations: points and rotations together, in every pass.

use glam::{DMat3, DQuat, DVec3};

use super::Figure;
use super::points::at_length;
use crate::ik::limit::JointLimit;
use crate::ik::linkage::{Linkage, NONE, State};
use crate::ik::problem::IkProblem;
use crate::ik::solve::{Progress, is_reached, is_short, miss};
use crate::ik::trace::{TraceIteration, TraceUpdate};
use crate::ik::turn::{WAYS, shortened, shortest_turn, swivel};
use crate::rotation::{log, matrix_from_quat, nearest_rotation, quat_from_matrix};

/// How much the present orientation of a link counts beside its points where several of them ask for
/// different ones: enough to settle the twist that points on one line leave open.
const KEEP_SHARE: f64 = 1e-3;

/// By how much joints are bent when all stands still: a little in each way, then more.
const NUDGES_RAD: [f64; 2] = [0.05, 0.8];

/// How often they are.
const MOST_NUDGES: usize = WAYS * NUDGES_RAD.len();

/// Memory that is used again.
#[derive(Clone, Debug, Default)]
pub(in crate::ik) struct Scratch {
    /// Points of a simple chain.
    pub(super) points: Vec<DVec3>,
    /// Where an iteration leads them, and where they are bent.
    pub(super) spare: [Vec<DVec3>; 2],
    /// Lengths of its bones.
    pub(super) lengths: Vec<f64>,
    /// By pivot: sum of the places that what lies beyond asks for, and of their weights.
    wanted: Vec<(DVec3, f64)>,
    /// By pivot: where the inward pass puts it.
    inward: Vec<DVec3>,
    /// By pivot: the weight of all targets beyond it.
    weights: Vec<f64>,
    /// By pivot: its turn before the iteration.
    before: Vec<DQuat>,
    /// The best pose so far.
    best: State,
}

/// Runs FABRIK on a tree.
pub(super) fn run(
    figure: &Figure<'_>,
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    mut progress: Progress,
) -> Progress {
    let problem = figure.problem;
    linkage.enforce_limits();
    weigh(linkage, problem, scratch);
    let mut best = miss(linkage, problem);
    scratch.best.store(linkage);
    let (mut at_rest, mut nudges) = (0, 0);
    // Whether the pose is not the one that the last iteration led to.
    let mut is_bent = false;
    let mut last = best;
    let rest = figure.config.rest_share * problem.stop.position_tolerance.max(f64::MIN_POSITIVE);
    while progress.iterations < problem.stop.max_iterations && !is_reached(linkage, problem) {
        if let Some(pull) = &figure.pull {
            pull.draw(linkage, progress.iterations);
        }
        is_bent = false;
        linkage.float(problem);
        scratch.before.clear();
        scratch.before.extend_from_slice(&linkage.turns);
        inward(linkage, problem, scratch);
        let mut record = progress.trace.is_some().then(TraceIteration::default);
        outward(figure, linkage, scratch, record.as_mut());
        slide(linkage, problem);
        swivel(linkage, problem);
        progress.iterations += 1;
        progress.record(linkage, figure.skeleton, figure.pose, problem, record);
        let now = miss(linkage, problem);
        let gains = now < best;
        if gains {
            best = now;
            scratch.best.store(linkage);
        }
        let has_rested = (last.sqrt() - now.sqrt()).abs() <= rest;
        at_rest = if has_rested { at_rest + 1 } else { 0 };
        last = now;
        let is_stuck = is_short(linkage, problem);
        if at_rest >= 3 && (is_stuck || !gains) {
            // From the best pose: the way before may have led off.
            if is_stuck && nudges < MOST_NUDGES {
                linkage.recall(&scratch.best);
                is_bent = true;
            }
            if !is_stuck
                || nudges == MOST_NUDGES
                || !linkage.nudge(NUDGES_RAD[nudges / WAYS], nudges % WAYS)
            {
                progress.is_settled = true;
                break;
            }
            nudges += 1;
            at_rest = 0;
            let bent = miss(linkage, problem);
            if bent < best {
                best = bent;
                scratch.best.store(linkage);
            }
        }
    }
    if !is_reached(linkage, problem) && miss(linkage, problem) > best {
        linkage.recall(&scratch.best);
        is_bent = true;
    }
    if is_bent {
        let record = progress.trace.is_some().then(TraceIteration::default);
        progress.record(linkage, figure.skeleton, figure.pose, problem, record);
    }
    progress
}

/// Sums the weights of the targets beyond each pivot.
fn weigh(linkage: &Linkage, problem: &IkProblem, scratch: &mut Scratch) {
    let count = linkage.pivots.len();
    scratch.weights.clear();
    scratch.weights.resize(count, 0.0);
    for (index, target) in problem.targets.iter().enumerate() {
        for &k in linkage.path(index) {
            scratch.weights[k as usize] += target.position_weight;
        }
    }
}

/// The turn of an effector's own link that its target's orientation asks for, if it can be given.
fn oriented(linkage: &Linkage, problem: &IkProblem, index: usize) -> Option<DQuat> {
    let effector = &linkage.effectors[index];
    let wanted = problem.targets[index].orientation_in_world?;
    effector
        .is_own_pivot
        .then(|| wanted.normalize() * effector.orientation_start.conjugate())
}

/// From the targets to the base: where each pivot should be so that what lies beyond it fits.
fn inward(linkage: &mut Linkage, problem: &IkProblem, scratch: &mut Scratch) {
    let count = linkage.pivots.len();
    scratch.wanted.clear();
    scratch.wanted.resize(count, (DVec3::ZERO, 0.0));
    scratch.inward.clone_from(&linkage.positions);
    for (index, target) in problem.targets.iter().enumerate() {
        let effector = linkage.effectors[index];
        if effector.pivot == NONE || target.position_weight == 0.0 {
            continue;
        }
        let k = effector.pivot as usize;
        let goal = target.position_in_world;
        let wanted = match oriented(linkage, problem, index) {
            Some(turn) => {
                let turn = shortened(linkage.turns[k], turn, linkage.pivots[k].give);
                linkage.turns[k] = turn;
                goal - turn * effector.offset
            }
            None if !linkage.pivots[k].turns => goal - linkage.turns[k] * effector.offset,
            None => {
                let back = at_length(linkage.positions[k] - goal, effector.offset.length());
                if let Some(turn) = shortest_turn(linkage.turns[k] * effector.offset, -back) {
                    linkage.turns[k] = turn * linkage.turns[k];
                }
                goal + back
            }
        };
        let sum = &mut scratch.wanted[k];
        sum.0 += wanted * target.position_weight;
        sum.1 += target.position_weight;
    }
    for k in (0..count).rev() {
        let (sum, weight) = scratch.wanted[k];
        if weight <= 0.0 {
            continue;
        }
        let position = sum / weight;
        scratch.inward[k] = position;
        let pivot = linkage.pivots[k];
        if pivot.parent == NONE {
            continue;
        }
        let parent = pivot.parent as usize;
        let inner = inward_turn(linkage, k, position);
        let wanted = position
            - inner * pivot.offset
            - linkage.turns[k] * (pivot.slide_axis * linkage.slides[k]);
        linkage.turns[parent] = inner;
        let sum = &mut scratch.wanted[parent];
        sum.0 += wanted * scratch.weights[k];
        sum.1 += scratch.weights[k];
    }
}

/// How the link inside pivot `k` is turned when its outer end is at `position` and its inner one as near
/// as it can be to where it was, within the limits of joint `k`.
fn inward_turn(linkage: &Linkage, k: usize, position: DVec3) -> DQuat {
    let pivot = &linkage.pivots[k];
    let parent = pivot.parent as usize;
    let inner = linkage.turns[parent];
    if !linkage.pivots[parent].turns {
        return inner;
    }
    let to_pivot = position - linkage.positions[parent];
    let inner = match shortest_turn(inner * pivot.offset, to_pivot) {
        Some(turn) => turn * inner,
        None => inner,
    };
    if !pivot.turns || matches!(pivot.limit, JointLimit::Free) {
        return inner;
    }
    let motion = pivot.motion(inner, linkage.turns[k]);
    let allowed = pivot.limit.project(motion);
    if allowed == motion {
        inner
    } else {
        pivot.inner_turn_of_motion(linkage.turns[k], allowed)
    }
}

/// From the base to the effectors: every pivot placed by the link before it, every link turned to where
/// its points should be, within limits.
fn outward(
    figure: &Figure<'_>,
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    mut record: Option<&mut TraceIteration>,
) {
    let problem = figure.problem;
    let count = linkage.pivots.len();
    for k in 0..count {
        let pivot = linkage.pivots[k];
        let inner = linkage.inner_turn(k);
        let inner_before = match pivot.parent {
            NONE => DQuat::IDENTITY,
            parent => scratch.before[parent as usize],
        };
        let carried = inner * inner_before.conjugate() * scratch.before[k];
        linkage.turns[k] = carried;
        let attached = match pivot.parent {
            NONE => pivot.offset,
            parent => {
                let parent = parent as usize;
                linkage.positions[parent] + linkage.turns[parent] * pivot.offset
            }
        };
        if pivot.is_afloat {
            linkage.shifts[k] = scratch.inward[k] - attached;
        }
        linkage.positions[k] =
            attached + linkage.shifts[k] + carried * (pivot.slide_axis * linkage.slides[k]);
        if !pivot.turns {
            continue;
        }
        let wanted = wanted_turn(linkage, problem, scratch, k);
        let given = shortened(carried, wanted, pivot.give);
        linkage.turns[k] = linkage.limited_turn(k, given);
        if let Some(record) = &mut record {
            let turn = linkage.turns[k] * carried.conjugate();
            record.updates.push(update(figure, linkage, k, turn));
        }
    }
}

/// The turn of pivot `k`'s link that brings its points nearest to where they should be.
fn wanted_turn(linkage: &Linkage, problem: &IkProblem, scratch: &Scratch, k: usize) -> DQuat {
    let now = linkage.turns[k];
    let at = linkage.positions[k];
    let mut only = None;
    let (mut count, mut fit, mut size) = (0, DMat3::ZERO, 0.0);
    let mut add = |offset: DVec3, wanted: DVec3, weight: f64| {
        count += 1;
        only = Some((offset, wanted - at));
        let wanted = at_length(wanted - at, offset.length());
        size += weight * offset.length_squared();
        fit += outer(wanted * weight, offset);
    };
    for next in k + 1..linkage.pivots.len() {
        let pivot = &linkage.pivots[next];
        if pivot.parent as usize == k && scratch.weights[next] > 0.0 {
            add(pivot.offset, scratch.inward[next], scratch.weights[next]);
        }
    }
    for (index, target) in problem.targets.iter().enumerate() {
        if linkage.effectors[index].pivot as usize != k {
            continue;
        }
        if let Some(turn) = oriented(linkage, problem, index) {
            return turn;
        }
        if target.position_weight > 0.0 {
            let offset = linkage.effectors[index].offset;
            add(offset, target.position_in_world, target.position_weight);
        }
    }
    match (count, only) {
        (1, Some((offset, wanted))) => match shortest_turn(now * offset, wanted) {
            Some(turn) => turn * now,
            None => now,
        },
        (2.., _) => {
            let kept = matrix_from_quat(now) * (KEEP_SHARE * size);
            nearest_rotation(&(fit + kept))
                .and_then(|rotation| quat_from_matrix(&rotation))
                .unwrap_or(now)
        }
        _ => now,
    }
}

/// The outer product of two vectors.
fn outer(column: DVec3, row: DVec3) -> DMat3 {
    DMat3::from_cols(column * row.x, column * row.y, column * row.z)
}

/// Slides every sliding joint by what is missing along its axis.
fn slide(linkage: &mut Linkage, problem: &IkProblem) {
    for (index, target) in problem.targets.iter().enumerate() {
        for step in linkage.effectors[index].path_start..linkage.effectors[index].path_end {
            let k = linkage.paths[step] as usize;
            let pivot = linkage.pivots[k];
            let JointLimit::Slide { distance, .. } = pivot.limit else {
                continue;
            };
            let missing = target.position_in_world - linkage.effector_position(index);
            let axis = linkage.turns[k] * pivot.slide_axis;
            let wanted = linkage.slides[k] + missing.dot(axis) * pivot.give;
            linkage.slides[k] = distance.clamp(pivot.slid_at_start + wanted) - pivot.slid_at_start;
            linkage.place();
        }
    }
}

/// A joint's update, as it is recorded: with the first target beyond the joint.
fn update(figure: &Figure<'_>, linkage: &Linkage, k: usize, turn: DQuat) -> TraceUpdate {
    let targets = 0..figure.problem.targets.len();
    let id = u32::try_from(k).unwrap_or(NONE);
    let is_beyond = |index: &usize| linkage.path(*index).contains(&id);
    let target = targets.into_iter().find(is_beyond).unwrap_or(0);
    let goal = figure.problem.targets[target].position_in_world;
    let pivot_in_world = linkage.positions[k];
    // What lies beyond is not placed yet: where it would be if it were carried along as it was.
    let mut ahead = DVec3::ZERO;
    let path = linkage.path(target);
    let place = path.iter().position(|&p| p == id).unwrap_or(0);
    for &next in &path[place + 1..] {
        ahead += linkage.turns[linkage.pivots[next as usize].parent as usize]
            * linkage.pivots[next as usize].offset;
    }
    if let Some(&last) = path.last() {
        ahead += linkage.turns[last as usize] * linkage.effectors[target].offset;
    }
    let vector = log(turn);
    let effector_in_world = pivot_in_world + ahead;
    TraceUpdate {
        joint: linkage.pivots[k].joint,
        target,
        pivot_in_world,
        to_effector: turn.conjugate() * ahead,
        to_target: goal - pivot_in_world,
        axis_in_world: vector.normalize_or_zero(),
        amount: vector.length(),
        effector_in_world,
        distance: effector_in_world.distance(goal),
        moved: linkage.moved_joint(k, figure.pose),
    }
}
