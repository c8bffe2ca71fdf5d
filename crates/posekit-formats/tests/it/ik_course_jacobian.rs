//! What the solvers that linearise leave on the skeleton of the course, against NumPy
//! (`tools/ik_jacobian_reference.py`, whose output stands here). `docs/ik.md` has the table.

use std::path::Path;

use glam::DVec3;
use posekit::ik::{
    DampedLeastSquaresConfig, DescentDirection, IkProblem, IkTarget, IkWorkspace,
    JacobianTransposeConfig, LevenbergMarquardtConfig, SelectivelyDampedConfig, Solver, StartJoint,
    solve,
};
use posekit::pose::LocalPose;
use posekit::skeleton::Skeleton;
use posekit_formats::bvh;

/// The target of the course's example.
const TARGET: DVec3 = DVec3::new(0.5, 0.75, 0.5);

fn skeleton() -> Option<Skeleton> {
    let path = "../../../shared/data/course/motion_walking.bvh";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    match std::fs::read(&path) {
        Ok(bytes) => Some(bvh::read(&bytes).unwrap().document.to_skeleton().unwrap()),
        Err(error) => {
            eprintln!("skipped: {}: {error}", path.display());
            None
        }
    }
}

/// What is left after so many iterations on `RootJoint` to `lWrist_end`, the figure standing at rest.
fn left(skeleton: &Skeleton, solver: &Solver, iterations: u32) -> f64 {
    let joint = |name: &str| skeleton.find(name).unwrap();
    let chain = skeleton.chain(joint("RootJoint"), joint("lWrist_end"));
    let chain = chain.unwrap();
    let target = IkTarget::position(chain.end(), TARGET);
    let mut problem = IkProblem::for_target(skeleton, &chain, StartJoint::Held, target);
    problem.stop.position_tolerance = 0.0;
    problem.stop.max_iterations = iterations;
    let mut pose = LocalPose::rest(skeleton);
    pose.translations[0].y = 0.931_395;
    let mut workspace = IkWorkspace::new();
    let report = solve(skeleton, &mut pose, &problem, solver, &mut workspace);
    let end = pose.to_global(skeleton).positions[chain.end().index()].as_dvec3();
    assert!((end.distance(TARGET) - report.residuals[0].distance).abs() < 1e-6);
    report.residuals[0].distance
}

#[test]
fn solvers_leave_what_numpy_leaves() {
    let Some(skeleton) = skeleton() else { return };
    let transpose = |direction| {
        Solver::JacobianTranspose(JacobianTransposeConfig {
            direction,
            ..JacobianTransposeConfig::default()
        })
    };
    let expected = [
        (
            transpose(DescentDirection::Steepest),
            [1.254_793_785e-1, 9.557_047_525e-2, 4.758_096_132e-2],
        ),
        (
            transpose(DescentDirection::Conjugate),
            [1.254_793_785e-1, 2.885_718_604e-3, 1.031e-9],
        ),
        (
            Solver::DampedLeastSquares(DampedLeastSquaresConfig::default()),
            [4.069_346_010e-1, 3.392_452_101e-2, 2.152e-12],
        ),
        (
            Solver::SelectivelyDamped(SelectivelyDampedConfig::default()),
            [3.249_379_638e-1, 7.391_899_807e-5, 0.0],
        ),
        (
            Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default()),
            [2.526_296_784e-1, 5.214_722e-10, 0.0],
        ),
    ];
    for (solver, expected) in expected {
        for (iterations, expected) in [1, 5, 20].into_iter().zip(expected) {
            let ours = left(&skeleton, &solver, iterations);
            // Offsets are stored as f32: single precision of the way so far, or nothing that counts.
            let slack = 1e-6 * expected + 3e-7 * f64::from(iterations > 1);
            let slack = if expected < 1e-6 {
                1e-9 + expected
            } else {
                slack
            };
            assert!(
                (ours - expected).abs() <= slack,
                "{solver:?} {iterations}: {ours} for {expected}"
            );
        }
    }
}
