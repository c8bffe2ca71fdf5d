//! The runs: every chain, target, solver and number of iterations.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::Instant;

use posekit::ik::{IkProblem, IkReport, IkWorkspace, solve};
use posekit::pose::LocalPose;
use posekit::rotation::angle_between;

use super::setup::Study;
use super::targets::Target;
use crate::failure::Failure;
use crate::jobs;
use crate::progress::Progress;

/// One of all combinations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    /// Index of the chain.
    pub(super) chain: usize,
    /// Index of the target in the chain's list.
    pub(super) target: usize,
    /// Index of the solver.
    pub(super) method: usize,
    /// Index of the number of iterations.
    pub(super) count: usize,
}

/// What came of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// What was run.
    pub(super) cell: Cell,
    /// How far the end stayed from the target.
    pub(super) residual: f64,
    /// By how much more than it has to: the residual without what the target is out of reach.
    pub(super) miss: f64,
    /// How many iterations were made before the solver stopped.
    pub(super) iterations: u32,
    /// How much all joints turned together, from the start pose.
    pub(super) motion_rad: f64,
    /// How long it took.
    pub(super) secs: f64,
}

/// How a solver came to a target when it may stop there: within the tolerance of the chain, with the most
/// iterations that were asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// How many iterations it took; none if it did not get there, or the target is out of reach.
    pub(super) iterations: Option<u32>,
    /// How much all joints turned together, from the start pose.
    pub(super) motion_rad: f64,
    /// How long it took.
    pub(super) secs: f64,
}

/// All runs: chains, in them targets, in them solvers, in them counts.
#[derive(Debug)]
pub(super) struct Results {
    runs: Vec<Run>,
    /// For each chain, in it each target, in it each solver.
    arrivals: Vec<Arrival>,
    /// Where each chain's runs start.
    starts: Vec<usize>,
    per_target: usize,
    per_method: usize,
}

impl Results {
    /// All runs, in order.
    pub(super) fn all(&self) -> &[Run] {
        &self.runs
    }

    /// The run of a cell.
    pub(super) fn run(&self, cell: Cell) -> &Run {
        let index = self.starts[cell.chain]
            + cell.target * self.per_target
            + cell.method * self.per_method
            + cell.count;
        &self.runs[index]
    }

    /// How a solver came to a target.
    pub(super) fn arrival(&self, chain: usize, target: usize, method: usize) -> &Arrival {
        let methods = self.per_target / self.per_method;
        let before = self.starts[chain] / self.per_method;
        &self.arrivals[before + target * methods + method]
    }

    /// The runs of a chain, a solver and a count for those targets that are wanted.
    pub(super) fn over_targets<'a>(
        &'a self,
        study: &'a Study,
        (chain, method, count): (usize, usize, usize),
        is_wanted: impl Fn(&Target) -> bool + 'a,
    ) -> impl Iterator<Item = &'a Run> + 'a {
        let targets = study.targets[chain].iter().enumerate();
        targets
            .filter(move |(_, target)| is_wanted(target))
            .map(move |(target, _)| {
                self.run(Cell {
                    chain,
                    target,
                    method,
                    count,
                })
            })
    }
}

/// Runs everything, a target on each core at a time.
pub(super) fn run(study: &Study, workers: NonZeroUsize, quiet: bool) -> Result<Results, Failure> {
    let places: Vec<(usize, usize)> = study
        .targets
        .iter()
        .enumerate()
        .flat_map(|(chain, list)| (0..list.len()).map(move |target| (chain, target)))
        .collect();
    let per_method = study.counts.len();
    let per_target = study.methods.len() * per_method;
    let mut starts = Vec::new();
    let mut before = 0;
    for list in &study.targets {
        starts.push(before);
        before += list.len() * per_target;
    }
    let progress = Progress::steps(places.len(), "targets", quiet);
    let mut runs = Vec::with_capacity(before);
    let mut arrivals = Vec::with_capacity(before / per_method.max(1));
    let mut has_failed = false;
    jobs::in_order(
        places.len(),
        workers,
        |index| of_target(study, places[index].0, places[index].1),
        |_, worked| {
            progress.advance("");
            match worked {
                Ok((of_one, arrived)) => {
                    runs.extend(of_one);
                    arrivals.extend(arrived);
                    ControlFlow::Continue(())
                }
                Err(_panic) => {
                    has_failed = true;
                    ControlFlow::Break(())
                }
            }
        },
    );
    if has_failed {
        return Err(Failure::new("an internal error, which is a bug in posekit")
            .in_file(&study.input)
            .try_next("please report it with this file"));
    }
    Ok(Results {
        runs,
        arrivals,
        starts,
        per_target,
        per_method,
    })
}

fn of_target(study: &Study, chain: usize, target: usize) -> (Vec<Run>, Vec<Arrival>) {
    let mut workspace = IkWorkspace::new();
    let mut pose = study.start.clone();
    let (mut runs, mut arrivals) = (Vec::new(), Vec::new());
    for method in 0..study.methods.len() {
        for count in 0..study.counts.len() {
            let cell = Cell {
                chain,
                target,
                method,
                count,
            };
            if count == 0 {
                // Once for the caches, so that the first is not slower than the others.
                run_cell(study, cell, &mut pose, &mut workspace);
            }
            runs.push(run_cell(study, cell, &mut pose, &mut workspace));
        }
        let cell = Cell {
            chain,
            target,
            method,
            count: study.counts.len() - 1,
        };
        arrivals.push(arrive(study, cell, &mut pose, &mut workspace));
    }
    (runs, arrivals)
}

fn run_cell(study: &Study, cell: Cell, pose: &mut LocalPose, workspace: &mut IkWorkspace) -> Run {
    let (chain, target) = (&study.chains[cell.chain], study.target(cell));
    let problem = chain.problem(target.place, study.counts[cell.count]);
    let (report, secs) = run_problem(study, cell, &problem, pose, workspace);
    let residual = report.largest_distance();
    Run {
        cell,
        residual,
        miss: (residual - target.beyond).max(0.0),
        iterations: report.iterations,
        motion_rad: motion_rad(study, workspace),
        secs,
    }
}

fn arrive(study: &Study, cell: Cell, pose: &mut LocalPose, workspace: &mut IkWorkspace) -> Arrival {
    let (chain, target) = (&study.chains[cell.chain], study.target(cell));
    let mut problem = chain.problem(target.place, study.counts[cell.count]);
    problem.stop.position_tolerance = chain.tolerance;
    let (report, secs) = run_problem(study, cell, &problem, pose, workspace);
    let has_arrived = !target.is_out_of_reach() && report.largest_distance() <= chain.tolerance;
    Arrival {
        iterations: has_arrived.then_some(report.iterations),
        motion_rad: motion_rad(study, workspace),
        secs,
    }
}

fn run_problem(
    study: &Study,
    cell: Cell,
    problem: &IkProblem,
    pose: &mut LocalPose,
    workspace: &mut IkWorkspace,
) -> (IkReport, f64) {
    let solver = study.methods[cell.method].solver(&study.chains[cell.chain]);
    pose.clone_from(&study.start);
    let clock = Instant::now();
    let report = solve(&study.skeleton, pose, problem, &solver, workspace);
    (report, clock.elapsed().as_secs_f64())
}

/// How much all joints of the last solution turned together, from the start pose.
fn motion_rad(study: &Study, workspace: &IkWorkspace) -> f64 {
    let turned = workspace.moved().iter().map(|moved| {
        let before = study.start.rotations[moved.joint.index()];
        angle_between(before.as_dquat().normalize(), moved.rotation)
    });
    turned.sum()
}

/// The pose that a run left.
pub(super) fn pose_of(study: &Study, cell: Cell) -> LocalPose {
    let mut pose = study.start.clone();
    run_cell(study, cell, &mut pose, &mut IkWorkspace::new());
    pose
}
