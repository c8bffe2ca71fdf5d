//! What the solvers that linearise cost: a chain of the course's skeleton, a whole body with five targets,
//! and robot arms.
//!
//! `cargo bench -p posekit-formats --bench ik_jacobian [SECONDS] [URDF:TIP ...]`. Needs `shared/data` beside
//! the workspace, and says so without it; URDF files with the name of their tip link are measured beside
//! our own. One core. Here, and not in the library, since it reads files.
#![allow(clippy::print_stdout, reason = "a bench says that it was skipped")]
#![allow(
    clippy::unwrap_used,
    reason = "a bench that fails should panic where it fails"
)]

#[path = "../../../benches/harness.rs"]
mod harness;

use std::f64::consts::PI;
use std::hint::black_box;
use std::path::Path;

use glam::DVec3;
use harness::{Table, Unit, time_asked};
use posekit::ik::robot::{RobotConfig, RobotWorkspace, solve_robot};
use posekit::ik::{
    CcdConfig, DampedLeastSquaresConfig, IkProblem, IkTarget, IkWorkspace, Interval,
    JacobianTransposeConfig, JointLimit, JointLimits, LevenbergMarquardtConfig,
    SelectivelyDampedConfig, Solver, StartJoint, solve,
};
use posekit::mechanism::ValueRange;
use posekit::motion::{Motion, PositionPolicy};
use posekit::pose::LocalPose;
use posekit::skeleton::Skeleton;
use posekit_formats::bvh;
use posekit_formats::urdf::{self, UpAxis};

/// The solvers, the slow ones with as many iterations as they need.
fn solvers() -> [(&'static str, Solver); 4] {
    [
        (
            "Levenberg-Marquardt",
            Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default()),
        ),
        (
            "damped least squares",
            Solver::DampedLeastSquares(DampedLeastSquaresConfig::default()),
        ),
        (
            "selectively damped",
            Solver::SelectivelyDamped(SelectivelyDampedConfig::default()),
        ),
        (
            "Jacobian transpose",
            Solver::JacobianTranspose(JacobianTransposeConfig::default()),
        ),
    ]
}

fn main() {
    let file = "../../../shared/data/course/motion_walking.bvh";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    match std::fs::read(&path) {
        Ok(bytes) => {
            let document = bvh::read(&bytes).unwrap().document;
            let motion = document.to_motion(PositionPolicy::default()).unwrap();
            one_chain(motion.skeleton());
            whole_body(&motion);
        }
        Err(_) => println!("skipped: there is no {}", path.display()),
    }
    for name in ["arm6", "arm7"] {
        let text = urdf::sample::by_name(name).unwrap();
        robot(name, text.as_bytes(), "tool");
    }
    for argument in std::env::args().skip(1) {
        if let Some((file, tip)) = argument.rsplit_once(':') {
            robot(file, &std::fs::read(file).unwrap(), tip);
        }
    }
}

/// Random reachable poses of a robot's tip, position and orientation, each from the middle of the ranges.
fn robot(name: &str, bytes: &[u8], tip: &str) {
    const POSES: usize = 10_000;
    let document = urdf::read(bytes).unwrap().document;
    let robot = document.to_robot(UpAxis::Y).unwrap();
    let tip = document.joint_of_link(tip).unwrap();
    let ranges = robot.value_ranges();
    let ends = |range: &ValueRange| (range.lower.max(-PI), range.upper.min(PI));
    let middle: Vec<f64> = ranges
        .iter()
        .map(ends)
        .map(|(a, b)| 0.5 * (a + b))
        .collect();
    let mut random = 1_u64;
    let targets: Vec<IkTarget> = (0..POSES)
        .map(|_| {
            let values: Vec<f64> = ranges
                .iter()
                .map(|range| {
                    random = random
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    let share = (random >> 11) as f64 / (1_u64 << 53) as f64;
                    let (low, high) = ends(range);
                    low + (high - low) * share
                })
                .collect();
            let frame = robot.global_frames(&values)[tip.index()];
            IkTarget::position(tip, frame.position).with_orientation(frame.orientation)
        })
        .collect();
    let config = RobotConfig::default();
    let mut workspace = RobotWorkspace::new();
    let mut run = |count: usize| {
        let (mut solved, mut attempts, mut iterations, mut worst) = (0, 0, 0, 0);
        for target in &targets[..count] {
            let mut values = middle.clone();
            let targets = std::slice::from_ref(target);
            let report = solve_robot(&robot, &mut values, targets, &config, &mut workspace);
            solved += usize::from(report.outcome.is_reached());
            attempts += report.attempts;
            iterations += report.iterations;
            worst = worst.max(report.attempts);
        }
        (solved, attempts, iterations, worst)
    };
    let (solved, attempts, iterations, worst) = run(POSES);
    let per = |count: u32| f64::from(count) / POSES as f64;
    println!(
        "\n{name}: {solved} of {POSES} solved, {:.2} attempts (at most {worst}), {:.1} iterations",
        per(attempts),
        per(iterations)
    );
    let mut table = Table::new(
        format!("{name}, random poses to 1e-6"),
        Unit::NanosecondsPer("pose"),
    );
    table.job("from the middle of the ranges", POSES, move || {
        black_box(run(POSES));
    });
    table.measure(time_asked());
}

/// `RootJoint` to `lWrist_end` from the standing rest pose to (0.5, 0.75, 0.5), to 1e-6.
fn one_chain(skeleton: &Skeleton) {
    let joint = |name: &str| skeleton.find(name).unwrap();
    let chain = skeleton
        .chain(joint("RootJoint"), joint("lWrist_end"))
        .unwrap();
    let target = IkTarget::position(chain.end(), DVec3::new(0.5, 0.75, 0.5));
    let mut problem = IkProblem::for_target(skeleton, &chain, StartJoint::Held, target);
    problem.stop.position_tolerance = 1e-6;
    problem.stop.max_iterations = 2000;
    let mut start = LocalPose::rest(skeleton);
    start.translations[0].y = 0.931_395;
    let mut table = Table::new("one chain to 1e-6", Unit::NanosecondsPer("solve"));
    let mut twenty = problem.clone();
    twenty.stop.position_tolerance = 0.0;
    twenty.stop.max_iterations = 20;
    let mut workspace = IkWorkspace::new();
    let (mut pose, from) = (start.clone(), start.clone());
    let ccd = Solver::Ccd(CcdConfig::default());
    table.reference("20 iterations of CCD", 1, move || {
        pose.rotations.copy_from_slice(&from.rotations);
        black_box(solve(skeleton, &mut pose, &twenty, &ccd, &mut workspace));
    });
    for (name, solver) in solvers() {
        let mut workspace = IkWorkspace::new();
        let mut pose = start.clone();
        let report = solve(skeleton, &mut pose, &problem, &solver, &mut workspace);
        let left = report.residuals[0].distance;
        let name = format!("{name}, {} iterations, {left:.1e} left", report.iterations);
        let (problem, start) = (&problem, &start);
        table.job(name, 1, move || {
            pose.rotations.copy_from_slice(&start.rotations);
            black_box(solve(skeleton, &mut pose, problem, &solver, &mut workspace));
        });
    }
    table.measure(time_asked());
}

/// Hands, feet and head of the walk, brought within limits, each frame started from the solution of the
/// one before: five targets with weights, knees as hinges, cones elsewhere. Every third frame of the
/// walk, so that there is something to do.
fn whole_body(motion: &Motion) {
    let skeleton = motion.skeleton();
    let joint = |name: &str| skeleton.find(name).unwrap();
    let names = [
        "lWrist_end",
        "rWrist_end",
        "lToeJoint",
        "rToeJoint",
        "torso_head",
    ];
    let weights = [1.0, 1.0, 4.0, 4.0, 0.5];
    let limits = limits(skeleton);
    let frames: Vec<Vec<IkTarget>> = (0..motion.frame_count())
        .step_by(3)
        .map(|frame| {
            let mut pose = motion.pose(frame);
            for id in skeleton.joints() {
                let rotation = &mut pose.rotations[id.index()];
                *rotation = limits
                    .limit(id)
                    .project(rotation.as_dquat().normalize())
                    .as_quat();
            }
            let global = pose.to_global(skeleton);
            let place = |name: &str| global.positions[joint(name).index()].as_dvec3();
            names
                .iter()
                .zip(weights)
                .map(|(name, weight)| {
                    IkTarget::position(joint(name), place(name)).with_weight(weight)
                })
                .collect()
        })
        .collect();
    let mut problem = IkProblem::for_whole_body(skeleton, frames[0].clone());
    problem.limits = limits.into();
    let mut table = Table::new(
        "whole body, five targets, every third frame of the walk, to 1e-3 of the height",
        Unit::NanosecondsPer("frame"),
    );
    for (name, solver) in solvers().into_iter().take(3) {
        let mut workspace = IkWorkspace::new();
        let mut problem = problem.clone();
        let mut run = {
            let frames = &frames;
            move || {
                let mut pose = motion.pose(0);
                let (mut reached, mut iterations) = (0_usize, 0);
                for targets in frames {
                    problem.targets.clone_from(targets);
                    let report = solve(skeleton, &mut pose, &problem, &solver, &mut workspace);
                    reached += usize::from(report.outcome.is_reached());
                    iterations += report.iterations as usize;
                }
                (reached, iterations)
            }
        };
        let (reached, iterations) = run();
        let count = frames.len();
        let name = format!(
            "{name}, {reached} of {count} reached, {:.1} iterations",
            iterations as f64 / count as f64
        );
        table.job(name, count, move || {
            black_box(run());
        });
    }
    table.measure(time_asked());
}

/// Elbows and knees turn about one axis within a range, other joints within cones.
fn limits(skeleton: &Skeleton) -> JointLimits {
    let mut limits = JointLimits::default();
    for id in skeleton.joints() {
        let name = skeleton.name(id);
        let axis = skeleton
            .children(id)
            .first()
            .map_or(DVec3::Y, |&child| {
                skeleton.rest_translation(child).as_dvec3()
            })
            .normalize_or(DVec3::Y);
        let limit = if skeleton.parent(id).is_none() || skeleton.is_end_site(id) {
            JointLimit::Free
        } else if name.contains("Elbow") {
            JointLimit::Cone {
                axis,
                swing_max_rad: 2.5,
                twist_rad: Interval::symmetric(1.5),
            }
        } else if name.contains("Knee") {
            let angle_rad = Interval::new(-0.1, 2.6);
            let axis = DVec3::X;
            JointLimit::Hinge { axis, angle_rad }
        } else {
            JointLimit::Cone {
                axis,
                swing_max_rad: 1.6,
                twist_rad: Interval::symmetric(1.2),
            }
        };
        limits.set_limit(id, limit).unwrap();
    }
    limits
}
