//! More iterations: never worse, and CCD never farther away from one to the next.

use std::sync::Arc;

use glam::DVec3;
use posekit::ik::{
    Base, IkProblem, IkReport, IkTarget, IkWorkspace, JointLimit, JointLimits, Movable, Solver,
    TraceDetail, solve,
};
use posekit::pose::LocalPose;
use posekit::skeleton::{JointId, Skeleton};
use proptest::prelude::*;

use super::conformance::any_limits;
use super::figures::{body, joint, solvers, straight_chain};
use crate::figures::{any_posed_skeleton, any_vector};

/// What rounding may add to a residual, as a share of the figure's size.
const ROUNDING: f64 = 1e-13;

/// The sum of squared distances by the targets' weights: what solvers make less.
fn missed(problem: &IkProblem, residuals: &[posekit::ik::IkResidual]) -> f64 {
    let pairs = problem.targets.iter().zip(residuals);
    pairs
        .map(|(target, left)| target.position_weight * left.distance * left.distance)
        .sum::<f64>()
        .sqrt()
}

fn run(skeleton: &Skeleton, start: &LocalPose, problem: &IkProblem, solver: &Solver) -> IkReport {
    let mut pose = start.clone();
    solve(
        skeleton,
        &mut pose,
        problem,
        solver,
        &mut IkWorkspace::new(),
    )
}

/// Runs the problem with ever more iterations and compares neighbours; and reads CCD's own record.
fn assert_descends(skeleton: &Skeleton, start: &LocalPose, problem: &IkProblem, counts: &[u32]) {
    let size: f64 = start
        .translations
        .iter()
        .map(|one| f64::from(one.length()))
        .sum();
    let rounding = ROUNDING * (1.0 + size);
    for named in solvers() {
        let mut problem = problem.clone();
        let mut last = f64::INFINITY;
        for &count in counts {
            problem.stop.max_iterations = count;
            let report = run(skeleton, start, &problem, &named.solver);
            let now = missed(&problem, &report.residuals);
            assert!(
                now <= last + rounding,
                "{}: {now} after {count} iterations, {last} before",
                named.name
            );
            last = now;
        }
        if !named.name.starts_with("ccd") {
            continue;
        }
        problem.trace = TraceDetail::Updates;
        let trace = run(skeleton, start, &problem, &named.solver).trace.unwrap();
        let mut last = f64::INFINITY;
        for (index, iteration) in trace.iterations.iter().enumerate() {
            let now = missed(&problem, &iteration.residuals);
            assert!(
                now <= last + rounding,
                "{}: {now} in iteration {index}, {last} before",
                named.name
            );
            last = now;
        }
    }
}

fn any_places(joint_count: usize) -> impl Strategy<Value = Vec<IkTarget>> {
    let target = (0..joint_count, any_vector(), 0.1..2.0_f64).prop_map(|(effector, at, weight)| {
        IkTarget::position(JointId::new(effector), at.as_dvec3() * 2.0).with_weight(weight)
    });
    proptest::collection::vec(target, 1..4)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    /// Random figures, poses, bases, limits and places.
    #[test]
    fn more_iterations_leave_no_more(
        ((skeleton, pose), limits, targets, base, root_is_free) in any_posed_skeleton()
            .prop_flat_map(|(skeleton, pose)| {
                let count = skeleton.joint_count();
                let base = prop::option::of(0..count);
                (Just((skeleton, pose)), any_limits(count), any_places(count), base, any::<bool>())
            }),
        has_limits: bool,
        has_one: bool,
        tolerance in prop_oneof![Just(0.0), Just(1e-3)],
    ) {
        let base = match (base, root_is_free) {
            (Some(joint), _) => Base::Joint(JointId::new(joint)),
            (None, true) => Base::Free,
            (None, false) => Base::Root,
        };
        let mut targets = targets;
        if has_one {
            targets.truncate(1);
        }
        let mut problem = IkProblem::new(base, Movable::Paths, targets, 5.0);
        problem.stop.position_tolerance = tolerance;
        if has_limits {
            problem.limits = Arc::new(limits);
        }
        let mut pose = pose;
        for joint in skeleton.joints() {
            if matches!(problem.limits.limit(joint), JointLimit::Slide { .. }) {
                pose.translations[joint.index()] = skeleton.rest_translation(joint);
            }
        }
        assert_descends(&skeleton, &pose, &problem, &[0, 1, 2, 3, 5, 8, 13, 21, 40]);
    }
}

/// Chains at rest on their targets stay there, whatever the number of iterations; straight ones that point at
/// theirs get away first.
#[test]
fn a_chain_that_has_arrived_stays() {
    let counts: Vec<u32> = (0..60).chain([80, 120, 200, 400]).collect();
    let (skeleton, joints) = straight_chain(4);
    let chain = skeleton.chain(joints[1], joints[joints.len() - 1]).unwrap();
    let rest = LocalPose::rest(&skeleton);
    for at in [
        DVec3::new(1.0, 2.0, 0.5),
        DVec3::new(0.2, -0.1, 3.1),
        DVec3::X * 1.7,
        DVec3::X * 3.999,
        DVec3::X * -2.4,
        DVec3::X * 6.0,
    ] {
        let mut problem = IkProblem::for_chain(&skeleton, &chain, at);
        problem.stop.position_tolerance = 0.0;
        assert_descends(&skeleton, &rest, &problem, &counts);
    }
    let skeleton = body();
    let rest = LocalPose::rest(&skeleton);
    let ends = [joint(&skeleton, "RightToe"), joint(&skeleton, "LeftHand")];
    for start in [ends[0], joint(&skeleton, "Hips")] {
        let chain = skeleton.chain(start, ends[1]).unwrap();
        for at in [DVec3::new(0.4, 1.5, 0.3), DVec3::new(0.1, 0.6, 0.4)] {
            let mut problem = IkProblem::for_chain(&skeleton, &chain, at);
            problem.stop.position_tolerance = 0.0;
            problem.limits = Arc::new(JointLimits::default());
            assert_descends(&skeleton, &rest, &problem, &counts);
            problem.stop.max_iterations = 400;
            for named in solvers()
                .into_iter()
                .filter(|one| one.name != "ccd from the base")
            {
                let left = run(&skeleton, &rest, &problem, &named.solver).largest_distance();
                assert!(left < 1e-9, "{}: {left}", named.name);
            }
        }
    }
}
