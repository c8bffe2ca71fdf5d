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
    run_ccd_to(skeleton, (start, root), TARGET, iterations, order)
}

fn run_ccd_to(
    skeleton: &Skeleton,
    (start, root): (&str, DVec3),
    target_in_world: DVec3,
    iterations: u32,
    order: SweepOrder,
) -> IkReport {
    let joint = |name: &str| skeleton.find(name).unwrap();
    let chain = skeleton.chain(joint(start), joint("lWrist_end")).unwrap();
    let target = IkTarget::position(chain.end(), target_in_world);
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
    assert!((end.distance(target_in_world) - report.residuals[0].distance).abs() < 1e-6);
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

/// Ever more iterations on a target that CCD reaches to the last digit: it goes on as NumPy does, and what it
/// has reached it keeps. `tools/ik_reference.py FILE --target 0.4,1.5,0.3 --root 0,0.931395,0 --iterations 100`
/// leaves these after 1, 5, 10, 16 and 18 iterations, 1.4e-14 after 20, and 2.7e-16 from 25 on.
#[test]
fn ccd_that_has_arrived_stays_as_in_numpy() {
    let Some(skeleton) = skeleton() else { return };
    let shelf = DVec3::new(0.4, 1.5, 0.3);
    let run = |iterations, order| {
        run_ccd_to(
            &skeleton,
            ("RootJoint", ROOT_STANDING),
            shelf,
            iterations,
            order,
        )
        .largest_distance()
    };
    let expected = [
        (1, 1.195_085_576_6e-1),
        (5, 1.622_093_178e-4),
        (10, 7.142_508_502e-8),
        (16, 6.682_572_882e-12),
        (18, 3.033_951_293e-13),
    ];
    for (iterations, left) in expected {
        let ours = run(iterations, SweepOrder::TipToBase);
        // Offsets and the root's place are stored as f32, which changes the rate a little.
        assert!(
            (ours - left).abs() < 1e-4 * left + 1e-14,
            "{iterations}: {ours} for {left}"
        );
    }
    let mut last = f64::INFINITY;
    for iterations in 1..=100 {
        let ours = run(iterations, SweepOrder::TipToBase);
        assert!(ours <= last, "{iterations}: {ours} after {last}");
        last = ours;
        assert!(iterations < 20 || ours < 2e-14, "{iterations}: {ours}");
    }
    // From the base it is slower: 8.334_549_568e-5 after 20, 8.266_064_691e-11 after 50.
    let from_base = run(50, SweepOrder::BaseToTip);
    assert!((from_base - 8.266e-11).abs() < 1e-13, "{from_base}");
}
