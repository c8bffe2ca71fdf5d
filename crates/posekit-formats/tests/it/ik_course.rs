//! Inverse kinematics on the skeleton of the course: rigid CCD against a NumPy loop that shares nothing
//! with it but the definition (`tools/ik_reference.py`, whose output stands here).

use std::path::Path;

use glam::{DVec3, Vec3};
use posekit::ik::{
    CcdConfig, IkProblem, IkReport, IkTarget, IkWorkspace, Solver, StartJoint, SweepOrder, solve,
};
use posekit::pose::LocalPose;
use posekit::skeleton::Skeleton;
use posekit_formats::bvh;

/// The target of the course's example.
const TARGET: DVec3 = DVec3::new(0.5, 0.75, 0.5);

/// Where the root stands in the pose that the course's viewer starts with. The file's rest pose has it
/// at the origin.
const ROOT_STANDING: DVec3 = DVec3::new(0.0, 0.931395, 0.0);

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

fn run_ccd(
    skeleton: &Skeleton,
    start: &str,
    root: DVec3,
    iterations: u32,
    order: SweepOrder,
) -> IkReport {
    let joint = |name: &str| skeleton.find(name).unwrap();
    let chain = skeleton.chain(joint(start), joint("lWrist_end")).unwrap();
    let target = IkTarget::position(chain.end(), TARGET);
    let mut problem = IkProblem::for_target(skeleton, &chain, StartJoint::Held, target);
    problem.stop.position_tolerance = 0.0;
    problem.stop.max_iterations = iterations;
    let mut pose = LocalPose::rest(skeleton);
    pose.translations[0] = root.as_vec3();
    let solver = Solver::Ccd(CcdConfig {
        order,
        ..CcdConfig::default()
    });
    let report = solve(
        skeleton,
        &mut pose,
        &problem,
        &solver,
        &mut IkWorkspace::new(),
    );
    let global = pose.to_global(skeleton);
    let end = global.positions[chain.end().index()].as_dvec3();
    assert!((end.distance(TARGET) - report.residuals[0].distance).abs() < 1e-6);
    let foot = global.positions[chain.start().index()];
    let foot_before = {
        let mut rest = LocalPose::rest(skeleton);
        rest.translations[0] = root.as_vec3();
        rest.to_global(skeleton).positions[chain.start().index()]
    };
    assert!(foot.distance(foot_before) < Vec3::splat(1e-6).length());
    report
}

#[test]
fn rigid_ccd_leaves_what_numpy_leaves() {
    let Some(skeleton) = skeleton() else { return };
    // Start joint, root, order, and what is left after 1, 5 and 20 iterations.
    let expected = [
        (
            "RootJoint",
            ROOT_STANDING,
            SweepOrder::TipToBase,
            [4.176_057_519e-1, 1.177_949_369e-1, 2.785_796_824e-2],
        ),
        (
            "RootJoint",
            ROOT_STANDING,
            SweepOrder::BaseToTip,
            [4.961_721_792e-3, 3.324_869_743e-3, 7.251_111_962e-4],
        ),
        (
            "lToeJoint_end",
            ROOT_STANDING,
            SweepOrder::TipToBase,
            [2.291_302_392e-1, 1.604_028e-7, 0.0],
        ),
        (
            "RootJoint",
            DVec3::ZERO,
            SweepOrder::TipToBase,
            [3.467_268_939e-1, 1.342_794_331e-1, 6.842_383_405e-2],
        ),
    ];
    for (start, root, order, left) in expected {
        for (iterations, left) in [1, 5, 20].into_iter().zip(left) {
            let report = run_ccd(&skeleton, start, root, iterations, order);
            let ours = report.residuals[0].distance;
            // Offsets are stored as f32, and a planted foot is reached through a long chain of them.
            assert!(
                (ours - left).abs() < 3e-7,
                "{start} {order:?} {iterations}: {ours} for {left}"
            );
        }
    }
}
