//! What the geometric solvers cost on the course's chain from `RootJoint` to `lWrist_end`.
//!
//! `cargo bench -p posekit-formats --bench ik [SECONDS]`. Needs `shared/data` beside the workspace, and says
//! so without it. One core. Here, and not in the library, since it reads a file.
#![allow(clippy::print_stdout, reason = "a bench says that it was skipped")]
#![allow(
    clippy::unwrap_used,
    reason = "a bench that fails should panic where it fails"
)]

#[path = "../../../benches/harness.rs"]
mod harness;

use std::hint::black_box;
use std::path::Path;

use glam::DVec3;
use harness::{Table, Unit, time_asked};
use posekit::ik::{
    Aim, CcdConfig, FabrikConfig, IkProblem, IkTarget, IkWorkspace, Solver, StartJoint, SweepOrder,
    TwoBone, TwoBoneConfig, aim, fabrik_points, solve, two_bone,
};
use posekit::pose::LocalPose;
use posekit::skeleton::{Chain, Skeleton};
use posekit_formats::bvh;

/// The course's target, and where its viewer has the root.
const TARGET: DVec3 = DVec3::new(0.5, 0.75, 0.5);
const ROOT_HEIGHT: f32 = 0.931_395;

fn main() {
    let file = "../../../shared/data/course/motion_walking.bvh";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let Ok(bytes) = std::fs::read(&path) else {
        println!("skipped: there is no {}", path.display());
        return;
    };
    let skeleton = bvh::read(&bytes).unwrap().document.to_skeleton().unwrap();
    loops(&skeleton);
    closed_forms(&skeleton);
}

fn chain(skeleton: &Skeleton, start: &str, end: &str) -> Chain {
    let joint = |name: &str| skeleton.find(name).unwrap();
    skeleton.chain(joint(start), joint(end)).unwrap()
}

fn standing(skeleton: &Skeleton) -> LocalPose {
    let mut pose = LocalPose::rest(skeleton);
    pose.translations[0].y = ROOT_HEIGHT;
    pose
}

fn problem(skeleton: &Skeleton, chain: &Chain, start: StartJoint) -> IkProblem {
    let target = IkTarget::position(chain.end(), TARGET);
    IkProblem::for_target(skeleton, chain, start, target)
}

/// Adds a job that solves the problem from the standing rest pose, again and again.
fn add<'a>(
    table: &mut Table<'a>,
    name: &str,
    skeleton: &'a Skeleton,
    problem: IkProblem,
    solver: Solver,
) {
    let start = standing(skeleton);
    let mut pose = start.clone();
    let mut workspace = IkWorkspace::new();
    let report = solve(skeleton, &mut pose, &problem, &solver, &mut workspace);
    let (left, iterations) = (report.largest_distance(), report.iterations);
    let name = format!("{name}, {iterations} it, {left:.1e} left");
    table.job(name, 1, move || {
        pose.rotations.copy_from_slice(&start.rotations);
        black_box(solve(
            skeleton,
            &mut pose,
            &problem,
            &solver,
            &mut workspace,
        ));
    });
}

fn loops(skeleton: &Skeleton) {
    let arm = chain(skeleton, "RootJoint", "lWrist_end");
    let mut table = Table::new("RootJoint to lWrist_end", Unit::NanosecondsPer("solve"));
    let global = standing(skeleton).to_global(skeleton);
    let points: Vec<DVec3> = arm
        .joints()
        .iter()
        .skip(1)
        .map(|joint| global.positions[joint.index()].as_dvec3())
        .collect();
    let reach: f64 = points
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .sum();
    let mut lengths = vec![0.0; points.len() - 1];
    add_peer(&mut table, &points, reach);
    let mut moving = points.clone();
    table.reference("FABRIK on points to 1e-4 of reach", 1, move || {
        moving.copy_from_slice(&points);
        black_box(fabrik_points(
            &mut moving,
            &mut lengths,
            TARGET,
            1e-4 * reach,
            100,
        ));
    });
    let mut to_tolerance = problem(skeleton, &arm, StartJoint::Held);
    to_tolerance.stop.position_tolerance = 1e-4 * reach;
    let fabrik = Solver::Fabrik(FabrikConfig::default());
    add(
        &mut table,
        "FABRIK, the same with rotations",
        skeleton,
        to_tolerance,
        fabrik,
    );
    let mut twenty = problem(skeleton, &arm, StartJoint::Held);
    twenty.stop.position_tolerance = 0.0;
    twenty.stop.max_iterations = 20;
    for (name, order) in [
        ("CCD", SweepOrder::TipToBase),
        ("CCD from the base", SweepOrder::BaseToTip),
    ] {
        let ccd = Solver::Ccd(CcdConfig {
            order,
            ..CcdConfig::default()
        });
        add(&mut table, name, skeleton, twenty.clone(), ccd);
    }
    let mut none = twenty;
    none.stop.max_iterations = 0;
    let ccd = Solver::Ccd(CcdConfig::default());
    add(
        &mut table,
        "no iteration: what a call costs",
        skeleton,
        none,
        ccd,
    );
    table.measure(time_asked());
}

/// Adds the crate `rebirth-ik` 0.1 on the same points, in its `f32`, with the bones' lengths measured beforehand.
fn add_peer(table: &mut Table<'_>, points: &[DVec3], reach: f64) {
    let narrow = |v: DVec3| {
        let v = v.as_vec3();
        rebirth_ik::Vec3::new(v.x, v.y, v.z)
    };
    let points: Vec<rebirth_ik::Vec3> = points.iter().copied().map(narrow).collect();
    let mut lengths = vec![0.0; points.len() - 1];
    rebirth_ik::segment_lengths(&points, &mut lengths);
    #[expect(clippy::cast_possible_truncation, reason = "the peer counts in f32")]
    let tolerance = (1e-4 * reach) as f32;
    let mut moving = points.clone();
    table.reference("rebirth-ik on points to 1e-4 of reach, f32", 1, move || {
        moving.copy_from_slice(&points);
        black_box(rebirth_ik::solve_chain(
            &mut moving,
            &lengths,
            narrow(black_box(TARGET)),
            100,
            tolerance,
        ));
    });
}

fn closed_forms(skeleton: &Skeleton) {
    let mut table = Table::new("in closed form", Unit::NanosecondsPer("solve"));
    let bones = TwoBone {
        upper: DVec3::new(0.12, 1.28, 0.0),
        middle: DVec3::new(0.36, 1.28, 0.01),
        end: DVec3::new(0.60, 1.28, 0.0),
        target: DVec3::new(0.4, 1.1, 0.25),
        pole: None,
        softness: 0.0,
    };
    table.reference("two bones", 1, move || {
        black_box(two_bone(black_box(&bones)));
    });
    let with_pole = TwoBone {
        pole: Some(DVec3::new(0.3, 0.0, -1.0)),
        ..bones
    };
    table.job("two bones and a pole", 1, move || {
        black_box(two_bone(black_box(&with_pole)));
    });
    let look = Aim {
        joint: DVec3::new(0.0, 1.5, 0.0),
        forward: DVec3::Z,
        target: DVec3::new(1.0, 1.2, 2.0),
        up: None,
    };
    table.job("aim", 1, move || {
        black_box(aim(black_box(&look)));
    });
    let upright = Aim {
        up: Some([DVec3::Y, DVec3::Y]),
        ..look
    };
    table.job("aim, with a direction that stays up", 1, move || {
        black_box(aim(black_box(&upright)));
    });
    let limb = chain(skeleton, "lShoulder", "lWrist");
    let solver = Solver::TwoBone(TwoBoneConfig::default());
    let whole = problem(skeleton, &limb, StartJoint::Turns);
    add(&mut table, "two bones of a figure", skeleton, whole, solver);
    table.measure(time_asked());
}
