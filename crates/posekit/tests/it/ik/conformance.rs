//! The suite that every solver runs.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::ik::{
    Base, IkOutcome, IkProblem, IkTarget, Interval, JointLimit, JointLimits, Movable, Pole,
    PreferredPose, RestPull, StartJoint, TraceDetail,
};
use posekit::pose::LocalPose;
use posekit::rotation::{EulerOrder, angle_between};
use posekit::skeleton::{JointId, Skeleton};
use proptest::prelude::*;

use super::figures::{body, joint, solvers, straight_chain};
use super::suite::{place, solve_checked};
use crate::figures::{any_posed_skeleton, any_rotation, any_vector};

/// The problem of a straight chain's end, with the first joint that turns as its start.
fn problem_of_chain(skeleton: &Skeleton, joints: &[JointId], target: DVec3) -> IkProblem {
    let chain = skeleton.chain(joints[1], joints[joints.len() - 1]).unwrap();
    IkProblem::for_chain(skeleton, &chain, target)
}

/// Directions that are spread about evenly, none of them along an axis.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    // Points on a Fibonacci spiral over the sphere.
    (0..count).map(move |i| {
        let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = (2.399_963_2 * f64::from(i)).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        DVec3::new(radius * cos, y, radius * sin)
    })
}

#[test]
fn targets_within_reach_are_reached() {
    let (skeleton, joints) = straight_chain(5);
    for named in solvers() {
        for direction in directions(20) {
            for distance in [1.0, 2.5, 4.0] {
                let mut problem = problem_of_chain(&skeleton, &joints, direction * distance);
                problem.stop.max_iterations = 400;
                let mut pose = LocalPose::rest(&skeleton);
                let report =
                    solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
                assert_eq!(
                    report.outcome,
                    IkOutcome::Reached,
                    "{} {direction}",
                    named.name
                );
            }
        }
    }
}

#[test]
fn targets_beyond_reach_stretch_the_chain_and_say_by_how_much() {
    let (skeleton, joints) = straight_chain(4);
    for named in solvers() {
        for direction in directions(12) {
            let mut problem = problem_of_chain(&skeleton, &joints, direction * 6.0);
            problem.stop.max_iterations = 2000;
            let mut pose = LocalPose::rest(&skeleton);
            let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
            let IkOutcome::OutOfReach { by } = report.outcome else {
                panic!("{}: {:?}", named.name, report.outcome);
            };
            assert!((by - 2.0).abs() < 1e-9, "{}: {by}", named.name);
            let left = report.residuals[0].distance;
            assert!((2.0 - 1e-9..2.02).contains(&left), "{}: {left}", named.name);
        }
    }
}

#[test]
fn a_long_bone_cannot_fold_to_its_base() {
    let (skeleton, joints) = straight_chain(1);
    for named in solvers() {
        let problem = problem_of_chain(&skeleton, &joints, DVec3::new(0.0, 0.4, 0.0));
        let mut pose = LocalPose::rest(&skeleton);
        let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
        let IkOutcome::OutOfReach { by } = report.outcome else {
            panic!("{}: {:?}", named.name, report.outcome);
        };
        assert!((by - 0.6).abs() < 1e-9 && (report.residuals[0].distance - 0.6).abs() < 1e-6);
    }
}

#[test]
fn a_target_straight_along_the_chain_or_behind_it_is_reached() {
    let (skeleton, joints) = straight_chain(3);
    let places = [
        DVec3::X * 1.7,
        DVec3::X * -1.7,
        DVec3::X * -2.9,
        DVec3::X * 1e-3,
    ];
    for named in solvers() {
        for target in places {
            let mut problem = problem_of_chain(&skeleton, &joints, target);
            problem.stop.max_iterations = 500;
            problem.stop.position_tolerance = 1e-3;
            let mut pose = LocalPose::rest(&skeleton);
            let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
            assert_eq!(
                report.outcome,
                IkOutcome::Reached,
                "{} {target}",
                named.name
            );
        }
    }
}

#[test]
fn chains_of_no_length_and_targets_at_joints_come_out_finite() {
    let (skeleton, joints) = straight_chain(3);
    let at_base = problem_of_chain(&skeleton, &joints, DVec3::ZERO);
    let at_joint = problem_of_chain(&skeleton, &joints, DVec3::X);
    let at_end = problem_of_chain(&skeleton, &joints, DVec3::X * 3.0);
    let itself = skeleton.chain(joints[2], joints[2]).unwrap();
    let alone = IkProblem::for_chain(&skeleton, &itself, DVec3::Y);
    let nothing = IkProblem::new(Base::Root, Movable::Paths, Vec::new(), 1.0);
    let tiny = problem_of_chain(&skeleton, &joints, DVec3::X * 1e-300);
    let huge = problem_of_chain(&skeleton, &joints, DVec3::X * 1e300);
    for named in solvers() {
        for problem in [&at_base, &at_joint, &at_end, &alone, &nothing, &tiny, &huge] {
            let mut pose = LocalPose::rest(&skeleton);
            solve_checked(&skeleton, &mut pose, problem, named.name, &named.solver);
        }
        let mut pose = LocalPose::rest(&skeleton);
        let report = solve_checked(&skeleton, &mut pose, &at_end, named.name, &named.solver);
        assert_eq!((report.outcome, report.iterations), (IkOutcome::Reached, 0));
        assert_eq!(pose, LocalPose::rest(&skeleton), "{}", named.name);
    }
}

#[test]
fn a_target_that_is_no_place_is_refused_and_nothing_moves() {
    let (skeleton, joints) = straight_chain(3);
    let mut problem = problem_of_chain(&skeleton, &joints, DVec3::new(1.0, f64::NAN, 0.0));
    for named in solvers() {
        let mut pose = LocalPose::rest(&skeleton);
        let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
        assert_eq!(report.outcome, IkOutcome::InvalidTarget { target: 0 });
        assert_eq!(pose, LocalPose::rest(&skeleton));
    }
    problem.targets[0] = IkTarget::position(joints[4], DVec3::Y)
        .with_orientation(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0));
    assert!(!problem.targets[0].is_valid());
}

#[test]
fn from_foot_to_hand_the_foot_stays_and_the_root_moves() {
    let skeleton = body();
    for start in ["LeftToe", "RightAnkle", "LeftKnee"] {
        for named in solvers() {
            let ends = [joint(&skeleton, start), joint(&skeleton, "LeftHand")];
            let chain = skeleton.chain(ends[0], ends[1]).unwrap();
            let mut problem = IkProblem::for_chain(&skeleton, &chain, DVec3::new(0.5, 0.9, 0.6));
            problem.stop.max_iterations = 300;
            let mut pose = LocalPose::rest(&skeleton);
            let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
            assert_eq!(report.outcome, IkOutcome::Reached, "{} {start}", named.name);
            let root = pose.translations[0].as_dvec3();
            assert!(
                root.distance(DVec3::new(0.0, 0.95, 0.0)) > 0.01,
                "the root moved"
            );
            // What hangs from the base keeps still, and the other limbs go with the hips.
            if start == "RightAnkle" {
                let toe = joint(&skeleton, "RightToe");
                let before = place(&skeleton, &LocalPose::rest(&skeleton), toe);
                let after = place(&skeleton, &pose, toe);
                assert!(before.0.distance(after.0) < 1e-6);
                assert!(angle_between(before.1, after.1) < 1e-6);
            }
        }
    }
}

#[test]
fn an_orientation_is_reached_with_the_position() {
    let skeleton = body();
    let chain = skeleton.chain(
        joint(&skeleton, "LeftShoulder"),
        joint(&skeleton, "LeftWrist"),
    );
    let chain = chain.unwrap();
    let wanted = DQuat::from_rotation_y(0.9) * DQuat::from_rotation_x(-0.5);
    let targets = [
        IkTarget::position(chain.end(), DVec3::new(0.45, 1.3, 0.25)),
        IkTarget::position(chain.end(), DVec3::new(0.5, 1.3, 0.25)).with_point(DVec3::X * 0.1),
    ];
    for named in solvers() {
        for target in targets {
            let target = target.with_orientation(wanted);
            let mut problem = IkProblem::for_target(&skeleton, &chain, StartJoint::Turns, target);
            problem.stop.max_iterations = 300;
            let mut pose = LocalPose::rest(&skeleton);
            let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
            assert_eq!(
                report.outcome,
                IkOutcome::Reached,
                "{} {report:?}",
                named.name
            );
        }
    }
}

#[test]
fn both_hands_and_the_head_reach_their_targets_together() {
    let skeleton = body();
    let hand = |name: &str, at: DVec3| IkTarget::position(joint(&skeleton, name), at);
    let targets = vec![
        hand("LeftHand", DVec3::new(0.35, 1.2, 0.45)),
        hand("RightHand", DVec3::new(-0.2, 1.5, 0.5)),
        hand("HeadEnd", DVec3::new(0.05, 1.65, 0.12)),
    ];
    for base in [Base::Root, Base::Joint(joint(&skeleton, "LeftToe"))] {
        for named in solvers() {
            let mut problem = IkProblem::new(base, Movable::Paths, targets.clone(), 1.7);
            problem.stop.max_iterations = 1000;
            problem.stop.position_tolerance = 2e-3;
            let mut pose = LocalPose::rest(&skeleton);
            let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
            assert_eq!(
                report.outcome,
                IkOutcome::Reached,
                "{} {report:?}",
                named.name
            );
        }
    }
}

#[test]
fn a_free_figure_is_carried_to_its_targets() {
    let skeleton = body();
    let far = DVec3::new(2.0, 0.3, -1.0);
    let targets: Vec<IkTarget> = ["LeftHand", "RightHand", "LeftToe", "RightToe", "HeadEnd"]
        .into_iter()
        .map(|name| {
            let effector = joint(&skeleton, name);
            let at = place(&skeleton, &LocalPose::rest(&skeleton), effector).0;
            IkTarget::position(effector, at + far)
        })
        .collect();
    let problem = IkProblem::for_whole_body(&skeleton, targets);
    for named in solvers() {
        let mut pose = LocalPose::rest(&skeleton);
        let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
        assert_eq!(
            report.outcome,
            IkOutcome::Reached,
            "{} {report:?}",
            named.name
        );
    }
}

/// A target that goes round steadily: no joint may jump. The measure of coherence is the largest turn of
/// any joint from one step to the next, and it stays in proportion to the way of the target.
#[test]
fn a_target_that_moves_a_little_moves_the_pose_a_little() {
    let skeleton = body();
    let chain = skeleton.chain(
        joint(&skeleton, "LeftShoulder"),
        joint(&skeleton, "LeftHand"),
    );
    let chain = chain.unwrap();
    for named in solvers() {
        let mut pose = LocalPose::rest(&skeleton);
        let mut last: Option<LocalPose> = None;
        let mut largest_rad = 0.0_f64;
        let steps = 400;
        for step in 0..steps {
            let angle = std::f64::consts::TAU * f64::from(step) / f64::from(steps);
            let at = DVec3::new(0.5, 1.4 + 0.25 * angle.cos(), 0.15 + 0.25 * angle.sin());
            let mut problem = IkProblem::for_chain(&skeleton, &chain, at);
            problem.stop.max_iterations = 200;
            let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
            assert_eq!(report.outcome, IkOutcome::Reached, "{}", named.name);
            if let Some(last) = &last {
                for (a, b) in last.rotations.iter().zip(&pose.rotations) {
                    largest_rad = largest_rad.max(angle_between(a.as_dquat(), b.as_dquat()));
                }
            }
            last = Some(pose.clone());
        }
        // The target goes 4 mm a step at a reach of 0.68: 6 mrad. A flip would be a radian or more.
        assert!(
            largest_rad < 0.1,
            "{}: {largest_rad} rad in one step",
            named.name
        );
    }
}

#[test]
fn a_trace_tells_the_way_and_does_not_change_it() {
    let skeleton = body();
    let chain = skeleton
        .chain(joint(&skeleton, "Hips"), joint(&skeleton, "LeftHand"))
        .unwrap();
    let mut problem = IkProblem::for_chain(&skeleton, &chain, DVec3::new(0.3, 1.2, 0.5));
    problem.stop.max_iterations = 6;
    problem.stop.position_tolerance = 0.0;
    for named in solvers() {
        let mut plain = LocalPose::rest(&skeleton);
        problem.trace = TraceDetail::None;
        let report = solve_checked(&skeleton, &mut plain, &problem, named.name, &named.solver);
        assert!(report.trace.is_none());
        let mut traced = LocalPose::rest(&skeleton);
        problem.trace = TraceDetail::Updates;
        let report = solve_checked(&skeleton, &mut traced, &problem, named.name, &named.solver);
        let trace = report.trace.unwrap();
        assert_eq!(trace.iterations.len(), 6, "{}", named.name);
        for (a, b) in plain.rotations.iter().zip(&traced.rotations) {
            let apart = angle_between(a.as_dquat(), b.as_dquat());
            assert!(apart < 1e-5, "{}: {apart} rad", named.name);
        }
        // Played on the pose it starts from, the trace leads to the pose that was left.
        let last = trace.iterations.last().unwrap();
        assert_eq!(last.residuals, report.residuals);
        let mut played = LocalPose::rest(&skeleton);
        for moved in &last.pose {
            played.rotations[moved.joint.index()] = moved.rotation.as_quat().normalize();
        }
        assert_eq!(played, traced, "{}", named.name);
        for iteration in &trace.iterations {
            for update in &iteration.updates {
                // The angle is that from a to b, and the axis lies across both.
                let (a, b) = (update.to_effector, update.to_target);
                let angle = a.angle_between(b);
                if named.name == "ccd" {
                    assert!((update.amount - angle).abs() < 1e-6, "{}", named.name);
                    let arrived = update.pivot_in_world + b.normalize() * a.length();
                    assert!(arrived.distance(update.effector_in_world) < 1e-9);
                }
                let across = update.axis_in_world.dot(a).abs() + update.axis_in_world.dot(b).abs();
                assert!(named.name != "ccd" || across < 1e-6);
            }
        }
    }
}

#[test]
fn a_pole_draws_the_elbow_to_its_side_and_a_pull_keeps_the_pose() {
    let skeleton = body();
    let elbow = joint(&skeleton, "LeftElbow");
    let chain = skeleton.chain(
        joint(&skeleton, "LeftShoulder"),
        joint(&skeleton, "LeftHand"),
    );
    let chain = chain.unwrap();
    let at = DVec3::new(0.5, 1.4, 0.25);
    for named in solvers() {
        for side in [DVec3::Y * 5.0, DVec3::Y * -5.0] {
            let mut problem = IkProblem::for_chain(&skeleton, &chain, at);
            problem.poles.push(Pole {
                joint: elbow,
                point_in_world: side,
                weight: 1.0,
            });
            problem.stop.max_iterations = 300;
            let mut pose = LocalPose::rest(&skeleton);
            let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
            assert_eq!(report.outcome, IkOutcome::Reached, "{}", named.name);
            let shoulder = place(&skeleton, &pose, chain.start()).0;
            let line = (at - shoulder).normalize();
            let aside = |point: DVec3| (point - shoulder).reject_from_normalized(line).normalize();
            let elbow_aside = aside(place(&skeleton, &pose, elbow).0);
            let agreement = elbow_aside.dot(aside(side));
            assert!(agreement > 0.99, "{}: {agreement}", named.name);
        }
        let mut problem = IkProblem::for_chain(&skeleton, &chain, at);
        problem.rest_pull = Some(RestPull {
            strength: 0.3,
            toward: PreferredPose::Rest,
        });
        problem.stop.max_iterations = 300;
        let mut pose = LocalPose::rest(&skeleton);
        let report = solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
        assert_eq!(report.outcome, IkOutcome::Reached, "{}", named.name);
    }
}

/// A table of limits of all kinds.
pub(super) fn any_limits(joint_count: usize) -> impl Strategy<Value = JointLimits> {
    let span =
        (-2.0..0.5_f64, 0.0..2.0_f64).prop_map(|(min, length)| Interval::new(min, min + length));
    let axis =
        || any_vector().prop_map(|v| (v.as_dvec3() + DVec3::splat(1e-3)).normalize_or(DVec3::X));
    let order = prop_oneof![
        Just(EulerOrder::ZXY),
        Just(EulerOrder::XYZ),
        Just(EulerOrder::YXZ)
    ];
    let limit = prop_oneof![
        3 => Just(JointLimit::Free),
        1 => Just(JointLimit::Fixed),
        2 => (order, [span.clone(), span.clone(), span.clone()])
            .prop_map(|(order, angles_rad)| JointLimit::Euler { order, angles_rad }),
        2 => (axis(), 0.0..3.0_f64, span.clone()).prop_map(|(axis, swing_max_rad, twist_rad)| {
            JointLimit::Cone { axis, swing_max_rad, twist_rad }
        }),
        2 => (axis(), span.clone()).prop_map(|(axis, angle_rad)| JointLimit::Hinge { axis, angle_rad }),
        1 => (axis(), span).prop_map(|(axis, distance)| JointLimit::Slide { axis, distance }),
    ];
    let stiffness = prop_oneof![3 => Just(0.0), 1 => 0.0..=1.0_f64];
    proptest::collection::vec((limit, stiffness), joint_count).prop_map(|entries| {
        let mut limits = JointLimits::default();
        for (index, (limit, stiffness)) in entries.into_iter().enumerate() {
            let joint = JointId::new(index);
            limits.set_limit(joint, limit).unwrap();
            limits.set_stiffness(joint, stiffness).unwrap();
        }
        limits
    })
}

fn any_target(joint_count: usize) -> impl Strategy<Value = IkTarget> {
    let orientation = prop::option::of(any_rotation());
    let point = prop_oneof![2 => Just(None), 1 => any_vector().prop_map(Some)];
    (
        0..joint_count,
        any_vector(),
        orientation,
        point,
        0.1..2.0_f64,
    )
        .prop_map(|(effector, at, orientation, point, weight)| IkTarget {
            effector: JointId::new(effector),
            point_in_effector: point.map_or(DVec3::ZERO, |point| point.as_dvec3()),
            position_in_world: at.as_dvec3() * 2.0,
            orientation_in_world: orientation.map(|rotation| rotation.as_dquat()),
            position_weight: weight,
            orientation_weight: 1.0,
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// Whatever the figure, the pose, the base and the targets: all that is promised holds.
    #[test]
    fn random_figures_with_random_limits(
        ((skeleton, pose), limits, targets, base, root_is_free) in any_posed_skeleton()
            .prop_flat_map(|(skeleton, pose)| {
                let count = skeleton.joint_count();
                let targets = proptest::collection::vec(any_target(count), 1..4);
                let limits = any_limits(count);
                (Just((skeleton, pose)), limits, targets, prop::option::of(0..count), any::<bool>())
            }),
        has_limits: bool,
    ) {
        let base = match (base, root_is_free) {
            (Some(joint), _) => Base::Joint(JointId::new(joint)),
            (None, true) => Base::Free,
            (None, false) => Base::Root,
        };
        let mut problem = IkProblem::new(base, Movable::Paths, targets, 5.0);
        problem.stop.max_iterations = 12;
        if has_limits {
            problem.limits = Arc::new(limits);
        }
        for named in solvers() {
            let mut pose = pose.clone();
            // A slide starts where its axis and rest put it: off-axis translations are no pose of it.
            for joint in skeleton.joints() {
                if matches!(problem.limits.limit(joint), JointLimit::Slide { .. }) {
                    pose.translations[joint.index()] = skeleton.rest_translation(joint);
                }
            }
            solve_checked(&skeleton, &mut pose, &problem, named.name, &named.solver);
        }
    }
}
