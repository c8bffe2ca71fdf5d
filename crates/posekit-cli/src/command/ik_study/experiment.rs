//! The runs: every chain, target, solver and number of iterations.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::Instant;

use posekit::ik::{IkWorkspace, solve};
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

/// All runs: chains, in them targets, in them solvers, in them counts.
#[derive(Debug)]
pub(super) struct Results {
    runs: Vec<Run>,
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
    let mut has_failed = false;
    jobs::in_order(
        places.len(),
        workers,
        |index| of_target(study, places[index].0, places[index].1),
        |_, worked| {
            progress.advance("");
            match worked {
                Ok(of_one) => {
                    runs.extend(of_one);
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
        starts,
        per_target,
        per_method,
    })
}

fn of_target(study: &Study, chain: usize, target: usize) -> Vec<Run> {
    let mut workspace = IkWorkspace::new();
    let mut pose = study.start.clone();
    let mut runs = Vec::new();
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
    }
    runs
}

fn run_cell(study: &Study, cell: Cell, pose: &mut LocalPose, workspace: &mut IkWorkspace) -> Run {
    let chain = &study.chains[cell.chain];
    let target = &study.targets[cell.chain][cell.target];
    let problem = chain.problem(target.place, study.counts[cell.count]);
    let solver = study.methods[cell.method].solver(chain);
    pose.clone_from(&study.start);
    let clock = Instant::now();
    let report = solve(&study.skeleton, pose, &problem, &solver, workspace);
    let secs = clock.elapsed().as_secs_f64();
    let turned = workspace.moved().iter().map(|moved| {
        let before = study.start.rotations[moved.joint.index()];
        angle_between(before.as_dquat().normalize(), moved.rotation)
    });
    let residual = report.largest_distance();
    Run {
        cell,
        residual,
        miss: (residual - target.beyond).max(0.0),
        iterations: report.iterations,
        motion_rad: turned.sum(),
        secs,
    }
}

/// The pose that a run left.
pub(super) fn pose_of(study: &Study, cell: Cell) -> LocalPose {
    let mut pose = study.start.clone();
    run_cell(study, cell, &mut pose, &mut IkWorkspace::new());
    pose
}
