//! A solver's way, one joint's update after another: each is shown before it is made.

use posekit::ik::{IkProblem, IkReport, IkWorkspace, Solver, TraceDetail, TraceUpdate, solve};
use posekit::pose::LocalPose;
use posekit::skeleton::Skeleton;

/// A recorded solver run, and the step that is shown.
#[derive(Clone, Debug)]
pub struct Stepper {
    problem: IkProblem,
    start: LocalPose,
    report: IkReport,
    /// For every update the iteration it belongs to and its index in it.
    updates: Vec<(usize, usize)>,
    /// How many updates are made.
    made: usize,
}

impl Stepper {
    /// Solves a problem and records every step.
    #[must_use]
    pub fn new(
        skeleton: &Skeleton,
        start: LocalPose,
        problem: &IkProblem,
        solver: &Solver,
        workspace: &mut IkWorkspace,
    ) -> Self {
        let problem = IkProblem {
            trace: TraceDetail::Updates,
            ..problem.clone()
        };
        let mut end = start.clone();
        let report = solve(skeleton, &mut end, &problem, solver, workspace);
        let iterations = report.trace.iter().flat_map(|trace| &trace.iterations);
        let updates = iterations
            .enumerate()
            .flat_map(|(i, iteration)| (0..iteration.updates.len()).map(move |u| (i, u)))
            .collect();
        Self {
            problem,
            start,
            report,
            updates,
            made: 0,
        }
    }

    /// The problem.
    #[must_use]
    pub fn problem(&self) -> &IkProblem {
        &self.problem
    }

    /// The final result.
    #[must_use]
    pub fn report(&self) -> &IkReport {
        &self.report
    }

    /// How many updates are made, and how many there are.
    #[must_use]
    pub fn progress(&self) -> (usize, usize) {
        (self.made, self.updates.len())
    }

    /// The iteration that the next update belongs to, from 0, and how many there are.
    #[must_use]
    pub fn iteration(&self) -> (usize, usize) {
        let count = self.updates.last().map_or(0, |last| last.0 + 1);
        let now = self.updates.get(self.made).map_or(count, |at| at.0);
        (now, count)
    }

    /// The update that comes next.
    #[must_use]
    pub fn next(&self) -> Option<&TraceUpdate> {
        self.update(self.made)
    }

    fn update(&self, index: usize) -> Option<&TraceUpdate> {
        let &(iteration, update) = self.updates.get(index)?;
        let trace = self.report.trace.as_ref()?;
        trace.iterations.get(iteration)?.updates.get(update)
    }

    /// Goes to the state after this many updates.
    pub fn go_to(&mut self, made: usize) {
        self.made = made.min(self.updates.len());
    }

    /// Goes forward or back by some updates.
    pub fn step(&mut self, by: isize) {
        self.go_to(self.made.saturating_add_signed(by));
    }

    /// Goes to the beginning of the next iteration, or of this one and then of the one before.
    pub fn step_iteration(&mut self, forward: std::cmp::Ordering) {
        let starts = self.updates.iter().enumerate();
        let mut starts = starts.filter(|(_, at)| at.1 == 0).map(|(index, _)| index);
        let to = match forward {
            std::cmp::Ordering::Less => starts.rfind(|&index| index < self.made),
            _ => starts.find(|&index| index > self.made),
        };
        let end = self.updates.len();
        self.made = to.unwrap_or(match forward {
            std::cmp::Ordering::Less => 0,
            _ => end,
        });
    }

    /// The distance of the effector of the next update from its target now, in the file's unit; after
    /// the last that of the first target.
    #[must_use]
    pub fn distance(&self) -> Option<f64> {
        match self.next() {
            Some(next) => Some(next.to_effector.distance(next.to_target)),
            None => self
                .report
                .residuals
                .first()
                .map(|residual| residual.distance),
        }
    }

    /// The pose after this many updates.
    #[must_use]
    pub fn pose(&self, skeleton: &Skeleton) -> LocalPose {
        let mut pose = self.start.clone();
        let Some(trace) = &self.report.trace else {
            return pose;
        };
        let (iteration, _) = match self.updates.get(self.made) {
            Some(&at) => at,
            None => (trace.iterations.len(), 0),
        };
        // The pose after the iterations that are whole, then the updates of the one that is not.
        if let Some(whole) = iteration.checked_sub(1)
            && let Some(whole) = trace.iterations.get(whole)
        {
            for moved in &whole.pose {
                put(&mut pose, moved);
            }
        }
        let begun = self.updates[..self.made]
            .iter()
            .enumerate()
            .filter(|(_, at)| at.0 == iteration);
        let mut is_begun = false;
        for (index, _) in begun {
            if let Some(update) = self.update(index) {
                put(&mut pose, &update.moved);
                is_begun = true;
            }
        }
        if is_begun && let posekit::ik::Base::Joint(base) = self.problem.base {
            keep_in_place(skeleton, &self.start, &mut pose, base);
        }
        pose
    }
}

fn put(pose: &mut LocalPose, moved: &posekit::ik::MovedJoint) {
    let index = moved.joint.index();
    pose.rotations[index] = moved.rotation.as_quat().normalize();
    pose.translations[index] = moved.translation.as_vec3();
}

/// Carries the figure so that its base is where it was: local rotations alone do not say that.
fn keep_in_place(
    skeleton: &Skeleton,
    start: &LocalPose,
    pose: &mut LocalPose,
    base: posekit::skeleton::JointId,
) {
    let before = start.to_global(skeleton);
    let now = pose.to_global(skeleton);
    let of = |global: &posekit::pose::GlobalPose| {
        (
            global.positions[base.index()],
            global.orientations[base.index()],
        )
    };
    let ((place, orientation), (place_now, orientation_now)) = (of(&before), of(&now));
    let turn = (orientation * orientation_now.inverse()).normalize();
    let root = skeleton.ancestors(base).last().unwrap_or(base);
    let index = root.index();
    pose.translations[index] = place + turn * (pose.translations[index] - place_now);
    pose.rotations[index] = (turn * pose.rotations[index]).normalize();
}
