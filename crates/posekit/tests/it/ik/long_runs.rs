//! Many iterations with limits: rounding must not add up.

use std::sync::Arc;

use glam::DVec3;
use posekit::ik::{IkProblem, IkTarget, Interval, JointLimit, JointLimits};
use posekit::pose::LocalPose;

use super::figures::{body, joint, solvers};
use super::suite::{place, solve_checked};

/// A free figure with hinges for elbows and knees and cones elsewhere, both hands drawn where they cannot
/// both be: no solver may stop early because it arrived, and none may leave anything that is not a pose.
#[test]
fn two_thousand_iterations_leave_a_pose() {
    let skeleton = body();
    let mut limits = JointLimits::default();
    for id in skeleton.joints() {
        let name = skeleton.name(id);
        let limit = if name.ends_with("Knee") || name.ends_with("Elbow") {
            JointLimit::Hinge {
                axis: DVec3::X,
                angle_rad: Interval::new(-0.1, 2.5),
            }
        } else {
            JointLimit::Cone {
                axis: DVec3::Y,
                swing_max_rad: 1.2,
                twist_rad: Interval::symmetric(0.7),
            }
        };
        limits.set_limit(id, limit).unwrap();
    }
    let places = [
        ("LeftHand", DVec3::new(-1.0, 2.0, 0.5)),
        ("RightHand", DVec3::new(2.0, 0.2, -0.8)),
        ("LeftToe", DVec3::new(0.1, 0.0, 0.1)),
        ("RightToe", DVec3::new(-0.1, 0.3, -0.4)),
    ];
    let targets = places.map(|(name, at)| IkTarget::position(joint(&skeleton, name), at));
    let mut problem = IkProblem::for_whole_body(&skeleton, targets.to_vec());
    problem.limits = Arc::new(limits);
    problem.stop.max_iterations = 2000;
    for named in solvers() {
        let mut pose = LocalPose::rest(&skeleton);
        let before = places.map(|(name, at)| {
            place(&skeleton, &pose, joint(&skeleton, name))
                .0
                .distance(at)
        });
        let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
        let total: f64 = report
            .residuals
            .iter()
            .map(|residual| residual.distance)
            .sum();
        assert!(
            total < before.iter().sum::<f64>(),
            "{}: {report:?}",
            named.name
        );
    }
}
