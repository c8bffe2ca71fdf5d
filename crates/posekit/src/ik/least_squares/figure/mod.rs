//! A figure as the solvers of least squares see it: the pivots of a [`Linkage`] as degrees of freedom.
//!
//! A ball joint has three degrees, the rotation vector of a turn in the world; a hinge one, its angle; a
//! slide one, its length; a root that is afloat three more for its place. A ball joint at its limit has its
//! three axes turned so that the first one points out of the limit; its step is then bounded at zero.

mod exact;
mod memory;
mod scatter;
mod wish;

use glam::{DMat3, DQuat, DVec3};

pub(crate) use memory::FigureMemory;

use super::model::{Model, Taken};
use super::system::{Degree, System};
use crate::ik::limit::{Interval, JointLimit};
use crate::ik::linkage::{Linkage, NONE};
use crate::ik::problem::{IkProblem, TraceDetail};
use crate::ik::pull::Pull;
use crate::ik::solve::{is_out_of_reach, is_reached, is_short, rest_distance};
use crate::ik::trace::{IkTrace, TraceIteration, TraceUpdate};
use crate::ik::turn::perpendicular;
use crate::pose::LocalPose;
use crate::rotation::{exp, log};
use crate::skeleton::Skeleton;

/// By how much each joint is bent to leave a pose in which none can do anything on its own.
const NUDGE_RAD: f64 = 0.05;

/// A ball joint that its limits turned back by less than this was within them but for rounding.
const HELD_RAD: f64 = 1e-10;

/// A step out of a limit of less than this is none: the joint stays at its limit.
const STILL_RAD: f64 = 1e-12;

/// A figure with its problem.
pub(crate) struct Figure<'a> {
    skeleton: &'a Skeleton,
    start: &'a LocalPose,
    problem: &'a IkProblem,
    linkage: &'a mut Linkage,
    memory: &'a mut FigureMemory,
    pull: Option<Pull<'a>>,
    /// The share of the way to the preferred pose that joints would like to go; it fades.
    pull_share: f64,
    trace: Option<IkTrace>,
}

/// What a figure is made of.
pub(crate) struct FigureParts<'a> {
    pub(crate) skeleton: &'a Skeleton,
    pub(crate) start: &'a LocalPose,
    pub(crate) problem: &'a IkProblem,
    pub(crate) linkage: &'a mut Linkage,
    pub(crate) memory: &'a mut FigureMemory,
}

impl<'a> Figure<'a> {
    /// Brings the linkage within its limits and measures it. `radian_share` is the share of the longest
    /// chain that a radian of residual counts as much as.
    pub(crate) fn new(parts: FigureParts<'a>, radian_share: f64) -> Self {
        let FigureParts {
            skeleton,
            start,
            problem,
            linkage,
            memory,
        } = parts;
        linkage.enforce_limits();
        memory.prepare(linkage, problem, 1.0 / reach(linkage), radian_share);
        let mut figure = Self {
            skeleton,
            start,
            problem,
            linkage,
            memory,
            pull: Pull::new(skeleton, start, problem),
            pull_share: 0.0,
            trace: (problem.trace == TraceDetail::Updates).then(IkTrace::default),
        };
        figure.begin_anew();
        figure
    }

    /// The same without a record of its way.
    pub(super) fn untraced(mut self) -> Self {
        self.trace = None;
        self
    }

    /// How many joints are moved, each counted once for every target.
    pub(super) fn size(&self) -> usize {
        self.linkage.pivots.len() * self.problem.targets.len()
    }

    /// Whether no pose can come nearer to the targets than a stretched or folded one does, which every start
    /// leads to.
    pub(super) fn is_plainly_out_of_reach(&self) -> bool {
        let is_free = |limit: JointLimit| matches!(limit, JointLimit::Free);
        is_out_of_reach(self.linkage, self.problem)
            && self.problem.targets.len() == 1
            && self.linkage.pivots.iter().all(|pivot| is_free(pivot.limit))
    }

    /// Whether one position is all that is asked for.
    pub(super) fn is_for_one_place(&self) -> bool {
        matches!(self.problem.targets.as_slice(), [one] if one.orientation_in_world.is_none())
    }

    /// By how much two residuals have to differ to count, in the residual's own measure.
    pub(super) fn least_gain(&self) -> f64 {
        rest_distance(self.problem) / reach(self.linkage)
    }

    /// The recorded way.
    pub(crate) fn into_trace(self) -> Option<IkTrace> {
        self.trace
    }

    /// Where pivot `k`'s hinge axis is in the world: its angle grows when the outer link turns about it.
    fn hinge_axis(&self, k: usize, axis: DVec3) -> DVec3 {
        let pivot = &self.linkage.pivots[k];
        let inner = self.linkage.inner_turn(k) * pivot.inner_start;
        if pivot.climbs {
            -(inner * axis)
        } else {
            inner * (pivot.rest * axis)
        }
    }

    /// Adds a degree of freedom by which pivot `k`'s outer link turns about an axis in the world.
    fn push_turn(&mut self, system: &mut System, k: usize, axis: DVec3, degree: Degree) {
        self.memory.axes.push(axis);
        system.push_degree(degree);
        let pivot = self.linkage.positions[k];
        for slot in self.memory.effectors_beyond(k) {
            let effector = self.memory.beyond[slot] as usize;
            let rows = &self.memory.rows[effector];
            if let Some((row, factor)) = rows.position {
                let arm = self.linkage.effector_position(effector) - pivot;
                system.push_entry(row, axis.cross(arm) * factor);
            }
            if let Some((row, factor, _)) = rows.orientation {
                system.push_entry(row, axis * factor);
            }
        }
    }

    /// Adds a degree of freedom by which all that is beyond pivot `k` slides along an axis in the world.
    fn push_slide(&mut self, system: &mut System, k: usize, axis: DVec3, degree: Degree) {
        self.memory.axes.push(axis);
        system.push_degree(degree);
        for slot in self.memory.effectors_beyond(k) {
            let effector = self.memory.beyond[slot] as usize;
            if let Some((row, factor)) = self.memory.rows[effector].position {
                system.push_entry(row, axis * factor);
            }
        }
    }

    /// The three axes of a ball joint in the world and the bounds of each.
    fn push_ball(&mut self, system: &mut System, k: usize, wish: DVec3) {
        let give = self.linkage.pivots[k].give;
        let normal = self.memory.normals[k];
        let (axes, upper) = if normal == DVec3::ZERO {
            (DMat3::IDENTITY, f64::INFINITY)
        } else {
            let normal = self.linkage.inner_turn(k) * normal;
            let side = perpendicular(normal);
            (DMat3::from_cols(normal, side, normal.cross(side)), 0.0)
        };
        for (index, axis) in [axes.x_axis, axes.y_axis, axes.z_axis]
            .into_iter()
            .enumerate()
        {
            let upper = if index == 0 { upper } else { f64::INFINITY };
            let degree = Degree {
                upper,
                wish: wish.dot(axis) * give,
                ..Degree::free(give)
            };
            self.push_turn(system, k, axis, degree);
        }
    }

    /// Turns a ball joint; how its outer link turned in all.
    fn turn_ball(&mut self, k: usize, carried: DQuat, step: &[f64]) -> DQuat {
        let first = self.memory.first_degrees[k] as usize + self.shift_count(k);
        let axes = &self.memory.axes[first..first + 3];
        let vector = axes[0] * step[first] + axes[1] * step[first + 1] + axes[2] * step[first + 2];
        let moved = carried * small_turn(vector);
        if matches!(self.linkage.pivots[k].limit, JointLimit::Free) {
            return moved;
        }
        let before = self.linkage.turns[k];
        let wanted = moved * before;
        let allowed = self.linkage.limited_turn(k, wanted);
        let held = log(wanted * allowed.conjugate());
        let length = held.length();
        if length > HELD_RAD {
            let carried_back = self.linkage.inner_turn(k).conjugate();
            self.memory.normals[k] = carried_back * (held / length);
        } else if step[first] < -STILL_RAD {
            self.memory.normals[k] = DVec3::ZERO;
        }
        allowed * before.conjugate()
    }

    fn turn_hinge(&mut self, k: usize, axis: DVec3, range: Interval, step: f64) -> DQuat {
        let mut angle = self.memory.values[k][0] + step;
        if is_bounded(range) {
            angle = range.clamp(angle);
        }
        self.memory.values[k][0] = angle;
        let before = self.linkage.turns[k];
        let pivot = &self.linkage.pivots[k];
        let turn = pivot.turn_of_motion(self.linkage.inner_turn(k), exp(axis * angle));
        turn * before.conjugate()
    }

    fn shift_count(&self, k: usize) -> usize {
        if self.linkage.pivots[k].is_afloat {
            3
        } else {
            0
        }
    }
}

impl Model for Figure<'_> {
    fn find_residual(&self, system: &mut System) {
        system.residual.clear();
        system.residual.resize(self.memory.row_count, 0.0);
        for (effector, rows) in self.memory.rows.iter().enumerate() {
            if let Some((row, factor)) = rows.position {
                let target = self.problem.targets[effector].position_in_world;
                let missing = (target - self.linkage.effector_position(effector)) * factor;
                system.residual[row..row + 3].copy_from_slice(&missing.to_array());
            }
            if let Some((row, factor, wanted)) = rows.orientation {
                let now = self.linkage.effector_orientation(effector);
                let missing = log(wanted * now.conjugate()) * factor;
                system.residual[row..row + 3].copy_from_slice(&missing.to_array());
            }
        }
    }

    fn linearize(&mut self, system: &mut System) {
        system.clear_columns();
        self.memory.axes.clear();
        self.memory.first_degrees.clear();
        let has_wishes = self.has_wishes();
        for k in 0..self.linkage.pivots.len() {
            let first = u32::try_from(system.degree_count()).unwrap_or(u32::MAX);
            self.memory.first_degrees.push(first);
            let pivot = &self.linkage.pivots[k];
            let (give, limit, turns) = (pivot.give, pivot.limit, pivot.turns);
            if pivot.is_afloat {
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    self.push_slide(system, k, axis, Degree::free(1.0));
                }
            }
            match limit {
                JointLimit::Hinge { axis, angle_rad } if turns => {
                    let axis = self.hinge_axis(k, axis);
                    let mut degree = bounded_degree(give, angle_rad, self.memory.values[k][0]);
                    if !is_bounded(angle_rad) {
                        degree = Degree::free(give);
                    }
                    if has_wishes {
                        degree.wish = self.wish(k).dot(axis) * give;
                    }
                    self.push_turn(system, k, axis, degree);
                }
                JointLimit::Slide { distance, .. } if give > 0.0 => {
                    let pivot = &self.linkage.pivots[k];
                    let axis = self.linkage.turns[k] * pivot.slide_axis;
                    let slid = pivot.slid_at_start + self.linkage.slides[k];
                    self.push_slide(system, k, axis, bounded_degree(give, distance, slid));
                }
                _ if turns => {
                    let wish = if has_wishes {
                        self.wish(k)
                    } else {
                        DVec3::ZERO
                    };
                    if !self.memory.is_exact || !self.push_exact(system, k, wish) {
                        self.push_ball(system, k, wish);
                    }
                }
                _ => {}
            }
        }
    }

    fn advance(&mut self, step: &[f64]) {
        for k in 0..self.linkage.pivots.len() {
            let pivot = &self.linkage.pivots[k];
            let carried = match pivot.parent {
                NONE => DQuat::IDENTITY,
                parent => self.memory.moves[parent as usize],
            };
            let first = self.memory.first_degrees[k] as usize;
            let own = first + self.shift_count(k);
            if pivot.is_afloat {
                self.linkage.shifts[k] += DVec3::from_slice(&step[first..first + 3]);
            }
            let (limit, turns) = (pivot.limit, pivot.turns);
            let moved = match limit {
                JointLimit::Hinge { axis, angle_rad } if turns => {
                    self.turn_hinge(k, axis, angle_rad, step[own])
                }
                JointLimit::Slide { distance, .. } if pivot.give > 0.0 => {
                    let start = pivot.slid_at_start;
                    let slid = start + self.linkage.slides[k] + step[own];
                    self.linkage.slides[k] = distance.clamp(slid) - start;
                    carried
                }
                _ if turns => match self.turn_exact(k, &step[own..]) {
                    Some(turn) => turn,
                    None => self.turn_ball(k, carried, step),
                },
                _ => carried,
            };
            self.memory.moves[k] = moved;
            // Turns are taken back by their conjugates above: a length that is not 1 would double its error
            // with every step.
            self.linkage.turns[k] = (moved * self.linkage.turns[k]).normalize();
        }
        self.linkage.place();
        self.fade_wishes();
    }

    fn save(&mut self) {
        self.memory.save(self.linkage);
    }

    fn restore(&mut self) {
        self.memory.restore(self.linkage);
    }

    fn is_reached(&self) -> bool {
        is_reached(self.linkage, self.problem) && self.poles_are_met()
    }

    fn is_short(&self) -> bool {
        is_short(self.linkage, self.problem)
    }

    fn keep_saved(&mut self) {
        self.memory.keep_saved();
    }

    fn restore_kept(&mut self) {
        self.memory.restore_kept(self.linkage);
    }

    fn nudge(&mut self, time: usize) -> bool {
        if is_out_of_reach(self.linkage, self.problem) || !self.linkage.nudge(NUDGE_RAD, time) {
            return false;
        }
        self.measure();
        true
    }

    fn record(&mut self, taken: Taken) {
        if self.trace.is_none() {
            return;
        }
        let mut record = TraceIteration::default();
        let moved = match taken {
            Taken::Step => self.linkage.pivots.len(),
            Taken::Nothing => 0,
        };
        for k in 0..moved {
            record.updates.extend(self.update_of(k));
        }
        self.linkage
            .list_moved(self.start, self.skeleton, &mut record.pose);
        let targets = self.problem.targets.iter().enumerate();
        record.residuals = targets
            .map(|(index, target)| self.linkage.residual(index, target))
            .collect();
        if let Some(trace) = &mut self.trace {
            trace.iterations.push(record);
        }
    }
}

impl Figure<'_> {
    /// Remembers the present pose as the best of all starts.
    pub(super) fn store_best(&mut self) {
        self.memory.store_best(self.linkage);
    }

    /// Goes back to the best of all starts.
    pub(super) fn recall_best(&mut self) {
        self.memory.recall_best(self.linkage);
        self.begin_anew();
    }

    /// What pivot `k` did in the last step, for the first effector that it moves.
    fn update_of(&self, k: usize) -> Option<TraceUpdate> {
        let slot = self.memory.effectors_beyond(k).next()?;
        let target = self.memory.beyond[slot] as usize;
        let (linkage, saved) = (&*self.linkage, &self.memory.saved.linkage);
        let pivot = &linkage.pivots[k];
        let effector = &linkage.effectors[target];
        let holder = effector.pivot as usize;
        let before = saved.positions[holder] + saved.turns[holder] * effector.offset;
        let goal = self.problem.targets[target].position_in_world;
        let carried = match pivot.parent {
            NONE => DQuat::IDENTITY,
            parent => self.memory.moves[parent as usize],
        };
        let vector = log(carried.conjugate() * self.memory.moves[k]);
        let after = linkage.effector_position(target);
        let (axis_in_world, amount) = if pivot.turns {
            (vector.normalize_or_zero(), vector.length())
        } else {
            let slid = linkage.positions[k] - saved.positions[k];
            let axis = linkage.turns[k] * pivot.slide_axis;
            (axis, slid.dot(axis))
        };
        Some(TraceUpdate {
            joint: pivot.joint,
            target,
            pivot_in_world: saved.positions[k],
            to_effector: before - saved.positions[k],
            to_target: goal - saved.positions[k],
            axis_in_world,
            amount,
            effector_in_world: after,
            distance: after.distance(goal),
            moved: linkage.moved_joint(k, self.start),
        })
    }
}

/// Whether a hinge's range is one: a full turn or more is no limit.
fn is_bounded(range_rad: Interval) -> bool {
    range_rad.max - range_rad.min < core::f64::consts::TAU
}

/// A degree of freedom whose value stays within a range; rounding may have left it a little outside.
fn bounded_degree(weight: f64, range: Interval, value: f64) -> Degree {
    Degree {
        lower: (range.min - value).min(0.0),
        upper: (range.max - value).max(0.0),
        ..Degree::free(weight)
    }
}

/// The rotation whose rotation vector is nearly this one: the same axis, and an angle of
/// `2 atan(length / 2)`. It differs in third order, costs no trigonometry, and shortens long steps.
fn small_turn(vector: DVec3) -> DQuat {
    let half = vector * 0.5;
    let scale = 1.0 / (1.0 + half.length_squared()).sqrt();
    DQuat::from_vec4(half.extend(1.0) * scale)
}

/// The length of the longest chain from base to effector; 1 where all have none.
fn reach(linkage: &Linkage) -> f64 {
    let mut longest = 0.0_f64;
    for (index, effector) in linkage.effectors.iter().enumerate() {
        let links = linkage.path(index).iter().skip(1);
        let links: f64 = links
            .map(|&k| linkage.pivots[k as usize].offset.length())
            .sum();
        longest = longest.max(links + effector.offset.length());
    }
    if longest > 0.0 && longest.is_finite() {
        longest
    } else {
        1.0
    }
}
