//! Cyclic coordinate descent.
//!
//! One joint after another turns so that the effector comes as near to the target as that joint alone can
//! bring it: by the angle between the vector a from the joint to the effector and the vector b from the
//! joint to the target, about their cross product (Wang and Chen 1991, "A Combined Optimization Method for
//! Solving the Inverse Kinematics Problem of Mechanical Manipulators", IEEE Trans. Robotics and Automation
//! 7(4), doi:10.1109/70.86079; Lander 1998, "Making Kine More Flexible", Game Developer 5(3)). The turn
//! carries everything beyond the joint along as one rigid piece.
//!
//! **Deviations and extensions.** A joint with several effectors beyond it takes the one turn that brings all
//! of them nearest, by their weights, about the axis of steepest descent of the sum of squares; a hinge
//! takes the best turn about its own axis. Limits, stiffness and the bounded step are applied to each turn as it is
//! made (Welman 1993). Sliding joints slide by the part of the miss that lies along their axis. An
//! effector whose own joint may turn and whose target has an orientation takes that orientation first, and
//! the rest of the chain brings it to its place. A floating root is carried by the mean of what is missing before each sweep. Where the loop stands still with the target straight along
//! a stretched chain, which no published form gets out of, every joint is bent a little, once or twice.
//!
//! **Guarantees and degenerate inputs.** Where positions alone are asked for, with limits or without, the sum of
//! squared distances never grows, from update to update and from iteration to iteration; with poles, a pull or
//! orientations the best of all iterations is kept, so that more iterations never leave more. A chain is bent only
//! where it stands still farther from its target than [`StopRule`](crate::ik::StopRule) allows a chain at rest,
//! and only if that brings it nearer. A target at a joint, or an effector at a joint, has no direction
//! from it: that joint stays. Vectors opposite to each other are half a turn apart about an axis that is
//! perpendicular to a and chosen by a's smallest coordinate. All output is finite.
//!
//! **Cost.** One square root of each pair of vectors, one to normalise, and two quaternion products for
//! every joint and iteration: the positions of all joints are computed once per iteration, not once per
//! joint, since a sweep from the tip has not moved the joints that it has yet to come to.

mod chain;

use glam::{DQuat, DVec3};

use crate::ik::limit::JointLimit;
use crate::ik::linkage::{Goal, Linkage, NONE, State};
use crate::ik::problem::{Base, IkProblem, TraceDetail};
use crate::ik::pull::Pull;
use crate::ik::solve::{Progress, is_reached, is_short, miss};
use crate::ik::trace::{IkTrace, TraceIteration, TraceUpdate};
use crate::ik::turn::{WAYS, perpendicular, shortened, shortest_turn, swivel};
use crate::ik::workspace::IkWorkspace;
use crate::pose::LocalPose;
use crate::rotation::log;
use crate::skeleton::Skeleton;

/// The order in which a sweep takes the joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SweepOrder {
    /// From the effector to the base, as published: fingers before shoulders.
    #[default]
    TipToBase,
    /// From the base to the effector: large turns at the base first.
    BaseToTip,
}

/// How CCD is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CcdConfig {
    /// The order of a sweep.
    pub order: SweepOrder,
    /// The most that a joint turns in one update; infinite for no bound. A bound spreads the motion over
    /// the chain, at the price of more iterations.
    pub max_step_rad: f64,
}

impl Default for CcdConfig {
    fn default() -> Self {
        Self {
            order: SweepOrder::TipToBase,
            max_step_rad: f64::INFINITY,
        }
    }
}

/// A sweep in which no joint turned by more than this, in radians, or slid by more, in length units, has
/// come to rest.
const AT_REST: f64 = 1e-10;

/// Vectors whose lengths multiply to less than this have no directions that would mean anything.
const SMALLEST: f64 = 1e-30;

/// How often a chain is bent that stands still short of its target.
const MOST_NUDGES: u32 = 8;

/// By how much each joint of it is bent, in this order and in all ways until a sweep from there comes nearer than
/// the chain stood: enough to get away from a singular pose, little enough not to be seen in the result, at
/// first.
const NUDGES_RAD: [f64; 4] = [0.05, 0.01, 0.25, 1.0];

/// All sizes and ways.
fn nudges() -> impl Iterator<Item = (f64, usize)> {
    NUDGES_RAD
        .into_iter()
        .flat_map(|angle_rad| (0..WAYS).map(move |way| (angle_rad, way)))
}

/// Memory that is used again.
#[derive(Clone, Debug, Default)]
pub(in crate::ik) struct Scratch {
    /// By pivot: what an iteration adds to its turn.
    added: Vec<DQuat>,
    /// One for each target.
    approaches: Vec<Approach>,
    /// The best pose so far.
    best: State,
    /// Where a sweep leads.
    next: State,
}

/// What is solved.
struct Figure<'a> {
    skeleton: &'a Skeleton,
    pose: &'a LocalPose,
    problem: &'a IkProblem,
    config: &'a CcdConfig,
    pull: Option<Pull<'a>>,
}

/// Runs CCD on the linkage of the workspace.
pub(crate) fn run(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    config: &CcdConfig,
    workspace: &mut IkWorkspace,
) -> Progress {
    let figure = Figure {
        skeleton,
        pose,
        problem,
        config,
        pull: Pull::new(skeleton, pose, problem),
    };
    let IkWorkspace {
        linkage,
        ccd: scratch,
        ..
    } = workspace;
    scratch.added.clear();
    scratch.added.resize(linkage.pivots.len(), DQuat::IDENTITY);
    linkage.enforce_limits();
    let is_plain = figure.pull.is_none()
        && problem.trace == TraceDetail::None
        && config.max_step_rad.is_infinite();
    if is_plain && linkage.is_free_chain(problem) {
        return chain::run(linkage, scratch, problem, config.order);
    }
    run_figure(&figure, linkage, scratch)
}

impl Figure<'_> {
    /// Whether no update can lead away from the targets: nothing but positions is asked for.
    fn descends(&self) -> bool {
        let targets = &self.problem.targets;
        self.pull.is_none()
            && self.problem.poles.is_empty()
            && targets.iter().all(|one| one.orientation_in_world.is_none())
    }
}

fn run_figure(figure: &Figure<'_>, linkage: &mut Linkage, scratch: &mut Scratch) -> Progress {
    let problem = figure.problem;
    let mut progress = Progress {
        trace: (problem.trace == TraceDetail::Updates).then(IkTrace::default),
        ..Progress::default()
    };
    let descends = figure.descends();
    let mut nudge_count = 0;
    let mut best = miss(linkage, problem);
    scratch.best.store(linkage);
    while progress.iterations < problem.stop.max_iterations && !is_reached(linkage, problem) {
        let mut record = progress.trace.is_some().then(TraceIteration::default);
        if let Some(pull) = &figure.pull {
            pull.draw(linkage, progress.iterations);
        }
        let is_still = sweep(figure, linkage, scratch, record.as_mut()) <= AT_REST;
        progress.iterations += 1;
        let now = miss(linkage, problem);
        let gains = now < best;
        if gains {
            best = now;
            scratch.best.store(linkage);
        } else if descends {
            // By rounding: it has come as near as numbers allow, or is stuck.
            linkage.recall(&scratch.best);
            record = record.map(|_| TraceIteration::default());
        }
        let is_stuck = is_short(linkage, problem);
        let is_at_rest = if descends {
            !gains || (is_still && is_stuck)
        } else {
            is_still && (!gains || is_stuck)
        };
        if is_at_rest && !is_reached(linkage, problem) {
            progress.is_settled = nudge_count == MOST_NUDGES
                || !is_stuck
                || !escape(figure, linkage, scratch, &mut best, record.as_mut());
            nudge_count += 1;
        }
        progress.record(linkage, figure.skeleton, figure.pose, problem, record);
        if progress.is_settled {
            break;
        }
    }
    if !is_reached(linkage, problem) && miss(linkage, problem) > best {
        linkage.recall(&scratch.best);
        let record = progress.trace.is_some().then(TraceIteration::default);
        progress.record(linkage, figure.skeleton, figure.pose, problem, record);
    }
    progress
}

/// Bends a chain that is stuck and sweeps once from there; whether it is worth going on from where that led.
fn escape(
    figure: &Figure<'_>,
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    best: &mut f64,
    mut record: Option<&mut TraceIteration>,
) -> bool {
    for (angle_rad, way) in nudges() {
        if !linkage.nudge(angle_rad, way) {
            return false;
        }
        if let Some(record) = &mut record {
            record.updates.clear();
        }
        sweep(figure, linkage, scratch, record.as_deref_mut());
        let now = miss(linkage, figure.problem);
        if now < *best {
            *best = now;
            scratch.best.store(linkage);
            return true;
        }
        if !figure.descends() {
            return true;
        }
        linkage.recall(&scratch.best);
    }
    if let Some(record) = record {
        record.updates.clear();
    }
    false
}

/// One pass over all joints; the largest turn, in radians, or slide.
fn sweep(
    figure: &Figure<'_>,
    linkage: &mut Linkage,
    scratch: &mut Scratch,
    record: Option<&mut TraceIteration>,
) -> f64 {
    let mut sweep = Sweep {
        linkage,
        added: &mut scratch.added,
        approaches: &mut scratch.approaches,
        problem: figure.problem,
        config: figure.config,
        largest_sq: 0.0,
    };
    sweep.run(figure.pose, record);
    let largest = sweep.largest_sq.sqrt();
    swivel(linkage, figure.problem);
    largest
}

/// One effector on its way to its target during a sweep.
#[derive(Clone, Copy, Debug)]
pub(in crate::ik) struct Approach {
    goal: Goal,
    /// Where the point is that is brought to its place, and that place.
    at: DVec3,
    to: DVec3,
    weight: f64,
    /// Where in the linkage's paths the next pivot of this effector is, and how many are left.
    next: usize,
    left: usize,
    /// Whether the joint whose turn it is moves this effector.
    is_moved: bool,
}

/// One pass over all joints.
struct Sweep<'a> {
    linkage: &'a mut Linkage,
    added: &'a mut [DQuat],
    approaches: &'a mut Vec<Approach>,
    problem: &'a IkProblem,
    config: &'a CcdConfig,
    /// Square of the largest turn in radians, or slide.
    largest_sq: f64,
}

impl Sweep<'_> {
    fn run(&mut self, pose: &LocalPose, mut record: Option<&mut TraceIteration>) {
        let tip_first = self.config.order == SweepOrder::TipToBase;
        // The root goes first: limbs would stretch for what it can bring about on its own.
        let carried = self.linkage.float(self.problem);
        self.largest_sq = self.largest_sq.max(carried * carried);
        self.approach(tip_first);
        let count = self.linkage.pivots.len();
        for step in 0..count {
            let k = if tip_first { count - 1 - step } else { step };
            self.find_moved(k, tip_first);
            self.update(k, pose, record.as_deref_mut());
            if !tip_first {
                // The joints beyond have to be in place before their turn comes.
                self.carry();
                if self.linkage.pivots[k].is_afloat {
                    self.float();
                }
            }
        }
        if tip_first {
            self.carry();
            self.float();
        }
        for (index, target) in self.problem.targets.iter().enumerate() {
            if self.approaches[index].goal.is_oriented() {
                self.linkage.orient(index, target);
            }
        }
    }

    /// Carries roots that float to where their turn was meant for.
    fn float(&mut self) {
        if self.problem.base == Base::Free {
            self.linkage.float(self.problem);
            for (index, approach) in self.approaches.iter_mut().enumerate() {
                approach.at = self.linkage.goal_point(index, approach.goal);
            }
        }
    }

    /// Gives effectors their orientations and finds what is to be brought where.
    fn approach(&mut self, tip_first: bool) {
        self.approaches.clear();
        for (index, target) in self.problem.targets.iter().enumerate() {
            let goal = self.linkage.orient(index, target);
            let path = self.linkage.goal_path(index, goal);
            self.approaches.push(Approach {
                goal,
                at: DVec3::ZERO,
                to: self.linkage.goal_position(index, target, goal),
                weight: target.position_weight,
                next: if tip_first {
                    path.end.max(1) - 1
                } else {
                    path.start
                },
                left: path.len(),
                is_moved: false,
            });
        }
        for (index, approach) in self.approaches.iter_mut().enumerate() {
            approach.at = self.linkage.goal_point(index, approach.goal);
        }
    }

    /// Marks the effectors that lie beyond pivot `k`. Pivots come in the order of every path, so each
    /// path is followed by one step at most.
    fn find_moved(&mut self, k: usize, tip_first: bool) {
        for approach in self.approaches.iter_mut() {
            let is_on_path = approach.left > 0 && self.linkage.paths[approach.next] as usize == k;
            approach.is_moved = is_on_path && approach.weight > 0.0;
            if is_on_path {
                approach.left -= 1;
                approach.next = if tip_first {
                    approach.next.max(1) - 1
                } else {
                    approach.next + 1
                };
            }
        }
    }

    /// Turns or slides one joint.
    fn update(&mut self, k: usize, pose: &LocalPose, record: Option<&mut TraceIteration>) {
        if !self.linkage.pivots[k].turns {
            self.slide(k, pose, record);
            return;
        }
        let pivot = self.linkage.positions[k];
        let Some(turn) = self.wanted_turn(k, pivot) else {
            return;
        };
        let turn = self.bounded(k, turn);
        if self.leads_away(k, pivot, turn) {
            return;
        }
        self.added[k] = turn;
        self.largest_sq = self.largest_sq.max(4.0 * turn.xyz().length_squared());
        let before = record.is_some().then(|| self.first_moved());
        for approach in self
            .approaches
            .iter_mut()
            .filter(|approach| approach.is_moved)
        {
            approach.at = pivot + turn * (approach.at - pivot);
        }
        if let (Some(record), Some(Some((index, before)))) = (record, before) {
            let points = [before, self.approaches[index].at, self.approaches[index].to];
            record
                .updates
                .push(self.trace_update(k, index, points, pose));
        }
    }

    /// The turn of pivot `k` after which the effectors beyond it are as near to their places as they can
    /// get by turning about its axis, if it is a hinge; about the axis of steepest descent otherwise,
    /// which for a single effector is the best there is.
    fn wanted_turn(&self, k: usize, pivot: DVec3) -> Option<DQuat> {
        let linkage = &*self.linkage;
        let moved = || self.approaches.iter().filter(|approach| approach.is_moved);
        let hinge_axis = linkage.pivots[k].hinge_axis(linkage.inner_turn(k));
        let mut effectors = moved();
        let first = effectors.next()?;
        if hinge_axis.is_none() && effectors.next().is_none() {
            return shortest_turn(first.at - pivot, first.to - pivot);
        }
        // A floating root is carried after it turned: only how the points lie about their middle counts.
        let (mut a_middle, mut b_middle) = (pivot, pivot);
        if linkage.pivots[k].is_afloat {
            let total: f64 = moved().map(|approach| approach.weight).sum();
            let mean = |place: fn(&Approach) -> DVec3| {
                moved().map(|one| place(one) * one.weight).sum::<DVec3>() / total
            };
            (a_middle, b_middle) = (mean(|one| one.at), mean(|one| one.to));
        }
        let arms = || moved().map(move |one| (one.at - a_middle, one.to - b_middle, one.weight));
        let moment: DVec3 = arms().map(|(a, b, weight)| a.cross(b) * weight).sum();
        let size: f64 = arms()
            .map(|(a, b, weight)| weight * (a.length_squared() * b.length_squared()).sqrt())
            .sum();
        if !(size > SMALLEST && size.is_finite()) {
            return None;
        }
        let axis = match hinge_axis {
            Some(axis) => axis,
            None if moment.length_squared() > 1e-30 * size * size => moment.normalize(),
            None => perpendicular(first.at - a_middle),
        };
        let sine = moment.dot(axis);
        let cosine: f64 = arms()
            .map(|(a, b, weight)| weight * (a.dot(b) - a.dot(axis) * b.dot(axis)))
            .sum();
        let norm = libm::hypot(sine, cosine);
        if norm <= 1e-15 * size {
            return None;
        }
        // Half of the angle, from its sine and cosine.
        let half = DQuat::from_vec4((axis * sine).extend(norm + cosine));
        if cosine < 0.0 && half.length_squared() <= 1e-28 * norm * norm {
            return Some(DQuat::from_vec4(axis.extend(0.0)));
        }
        Some(half.normalize())
    }

    /// The part of a turn that step, stiffness and limits allow.
    fn bounded(&self, k: usize, turn: DQuat) -> DQuat {
        let pivot = &self.linkage.pivots[k];
        let mut turn = turn;
        if pivot.give < 1.0 {
            turn = shortened(DQuat::IDENTITY, turn, pivot.give);
        }
        if self.config.max_step_rad.is_finite() {
            let angle_rad = log(turn).length();
            if angle_rad > self.config.max_step_rad {
                let share = self.config.max_step_rad.max(0.0) / angle_rad;
                turn = shortened(DQuat::IDENTITY, turn, share);
            }
        }
        if matches!(pivot.limit, JointLimit::Free) {
            return turn;
        }
        let now = self.linkage.turns[k];
        // Made unit: a length that is not 1 would double its error with every iteration.
        (self.linkage.limited_turn(k, turn * now) * now.conjugate()).normalize()
    }

    /// Whether a turn that the limits of a ball joint changed is worse than none: the nearest rotation within
    /// them is nearest by angle, not for the effectors.
    fn leads_away(&self, k: usize, pivot: DVec3, turn: DQuat) -> bool {
        let joint = &self.linkage.pivots[k];
        if !matches!(
            joint.limit,
            JointLimit::Euler { .. } | JointLimit::Cone { .. }
        ) || joint.is_afloat
        {
            return false;
        }
        let moved = self.approaches.iter().filter(|one| one.is_moved);
        let gain: f64 = moved
            .map(|one| {
                let after = pivot + turn * (one.at - pivot);
                let missed = one.at.distance_squared(one.to) - after.distance_squared(one.to);
                one.weight * missed
            })
            .sum();
        gain < 0.0
    }

    /// Slides a joint by the mean of what is missing along its axis.
    fn slide(&mut self, k: usize, pose: &LocalPose, record: Option<&mut TraceIteration>) {
        let linkage = &mut *self.linkage;
        let pivot = &linkage.pivots[k];
        let JointLimit::Slide { distance, .. } = pivot.limit else {
            return;
        };
        let axis = linkage.turns[k] * pivot.slide_axis;
        let moved = || self.approaches.iter().filter(|approach| approach.is_moved);
        let total: f64 = moved().map(|approach| approach.weight).sum();
        if total <= 0.0 {
            return;
        }
        let missing = moved().map(|one| (one.to - one.at).dot(axis) * one.weight);
        let wanted = linkage.slides[k] + pivot.give * missing.sum::<f64>() / total;
        let slid = distance.clamp(pivot.slid_at_start + wanted) - pivot.slid_at_start;
        let by = slid - linkage.slides[k];
        linkage.slides[k] = slid;
        self.largest_sq = self.largest_sq.max(by * by);
        let before = self.first_moved();
        for approach in self
            .approaches
            .iter_mut()
            .filter(|approach| approach.is_moved)
        {
            approach.at += axis * by;
        }
        if let (Some(record), Some((index, before))) = (record, before) {
            let points = [before, self.approaches[index].at, self.approaches[index].to];
            let mut update = self.trace_update(k, index, points, pose);
            (update.axis_in_world, update.amount) = (axis, by);
            record.updates.push(update);
        }
    }

    fn first_moved(&self) -> Option<(usize, DVec3)> {
        let mut approaches = self.approaches.iter().enumerate();
        let found = approaches.find(|(_, approach)| approach.is_moved);
        found.map(|(index, approach)| (index, approach.at))
    }

    /// Carries the turns that were added to each joint on to everything beyond it, and clears them.
    fn carry(&mut self) {
        let Linkage { pivots, turns, .. } = &mut *self.linkage;
        for k in 0..pivots.len() {
            let own = self.added[k];
            let carried = match pivots[k].parent {
                NONE => own,
                parent => self.added[parent as usize] * own,
            };
            self.added[k] = carried;
            turns[k] = carried * turns[k];
        }
        self.added.fill(DQuat::IDENTITY);
        self.linkage.place();
        for (index, approach) in self.approaches.iter_mut().enumerate() {
            approach.at = self.linkage.goal_point(index, approach.goal);
        }
    }

    /// An update that has been made and not yet carried on, as it is recorded.
    fn trace_update(
        &self,
        k: usize,
        index: usize,
        points: [DVec3; 3],
        pose: &LocalPose,
    ) -> TraceUpdate {
        let linkage = &*self.linkage;
        let pivot = &linkage.pivots[k];
        let turn = self.added[k];
        let mut update = linkage.trace_turn(k, index, turn, points, pose);
        if pivot.turns {
            let rotation = pivot.local_rotation(linkage.inner_turn(k), turn * linkage.turns[k]);
            update.moved.rotation = rotation.normalize();
        }
        update
    }
}
