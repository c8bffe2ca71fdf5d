//! What each solver does alone: the closed forms, and FABRIK on bare points.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::ik::{
    Aim, IkOutcome, IkProblem, IkTarget, Interval, JointLimit, JointLimits, Pole, Solver,
    StartJoint, TwoBone, TwoBoneConfig, aim, fabrik_points, two_bone,
};
use posekit::pose::LocalPose;
use proptest::prelude::*;

use super::figures::{body, joint};
use super::suite::{place, solve_checked};
use crate::figures::any_vector;

fn bones_after(bones: &TwoBone) -> [DVec3; 2] {
    let turns = two_bone(bones);
    let end = bones.middle + turns.middle * (bones.end - bones.middle);
    let turned = |point: DVec3| bones.upper + turns.upper * (point - bones.upper);
    [turned(bones.middle), turned(end)]
}

proptest! {
    /// The end comes to the target or as near as the lengths allow, whatever the bones and the pole.
    #[test]
    fn two_bones_reach_as_far_as_they_can(
        points in [any_vector(), any_vector(), any_vector(), any_vector()],
        pole in prop::option::of(any_vector()),
    ) {
        let [upper, middle, end, target] = points.map(|point| point.as_dvec3());
        let pole = pole.map(|pole| pole.as_dvec3());
        let bones = TwoBone { upper, middle, end, target, pole, softness: 0.0 };
        let [new_middle, new_end] = bones_after(&bones);
        let (first, second) = (upper.distance(middle), middle.distance(end));
        prop_assert!((upper.distance(new_middle) - first).abs() < 1e-9);
        prop_assert!((new_middle.distance(new_end) - second).abs() < 1e-9);
        let distance = upper.distance(target);
        let nearest = distance.clamp((first - second).abs(), first + second);
        prop_assert!((new_end.distance(target) - (distance - nearest).abs()).abs() < 1e-6);
        if let Some(pole) = pole {
            let line = (target - upper).normalize_or_zero();
            let aside = |point: DVec3| (point - upper).reject_from_normalized(line);
            let (is, wanted) = (aside(new_middle), aside(pole));
            if is.length() > 1e-3 && wanted.length() > 1e-3 && line != DVec3::ZERO {
                prop_assert!(is.normalize().dot(wanted.normalize()) > 1.0 - 1e-6);
            }
        }
    }

    #[test]
    fn aiming_points_forward_at_the_target_and_up_up(
        points in [any_vector(), any_vector(), any_vector(), any_vector(), any_vector()],
    ) {
        let [joint, forward, target, up, wanted] = points.map(|point| point.as_dvec3());
        prop_assume!(forward.length() > 1e-2 && joint.distance(target) > 1e-2);
        let turn = aim(&Aim { joint, forward, target, up: Some([up, wanted]) });
        let line = (target - joint).normalize();
        prop_assert!((turn * forward).normalize().dot(line) > 1.0 - 1e-9);
        let aside = |v: DVec3| v.reject_from_normalized(line);
        let (is, should) = (aside(turn * up), aside(wanted));
        if is.length() > 1e-2 && should.length() > 1e-2 {
            prop_assert!(is.normalize().dot(should.normalize()) > 1.0 - 1e-6);
        }
    }

    /// Bare points: ends where they should be, bones as long as they were.
    #[test]
    fn points_reach_or_stretch(
        mut points in proptest::collection::vec(any_vector().prop_map(|v| v.as_dvec3()), 3..9),
        target in any_vector().prop_map(|v| v.as_dvec3()),
    ) {
        let before = points.clone();
        let mut lengths = vec![0.0; points.len() - 1];
        let (left, iterations) = fabrik_points(&mut points, &mut lengths, target, 1e-6, 100);
        prop_assert!(iterations <= 100);
        prop_assert_eq!(points[0], before[0]);
        prop_assert!((points[points.len() - 1].distance(target) - left).abs() < 1e-12);
        for (pair, length) in points.windows(2).zip(&lengths) {
            prop_assert!((pair[0].distance(pair[1]) - length).abs() < 1e-9);
        }
        let reach: f64 = lengths.iter().sum();
        let beyond = before[0].distance(target) - reach;
        if beyond > 0.0 {
            prop_assert!((left - beyond).abs() < 1e-9);
        }
    }
}

#[test]
fn degenerate_bones_give_finite_turns() {
    let places = [
        DVec3::ZERO,
        DVec3::X,
        DVec3::X * 2.0,
        -DVec3::X,
        DVec3::Y * 1e-200,
    ];
    for upper in places {
        for middle in places {
            for end in places {
                for target in places {
                    for pole in [None, Some(DVec3::X), Some(DVec3::Y)] {
                        let bones = TwoBone {
                            upper,
                            middle,
                            end,
                            target,
                            pole,
                            softness: 0.1,
                        };
                        let turns = two_bone(&bones);
                        assert!(
                            turns.upper.is_finite() && turns.middle.is_finite(),
                            "{bones:?}"
                        );
                        assert!(turns.upper.is_normalized() && turns.middle.is_normalized());
                    }
                }
            }
        }
    }
}

#[test]
fn softness_eases_into_full_length() {
    let mut last = 0.0;
    for step in 0..60 {
        let x = 1.0 + 0.04 * f64::from(step);
        let bones = TwoBone {
            upper: DVec3::ZERO,
            middle: DVec3::new(0.7, 0.7, 0.0).normalize(),
            end: DVec3::new(0.7, 0.7, 0.0).normalize() + DVec3::new(0.7, -0.7, 0.0).normalize(),
            target: DVec3::X * x,
            pole: None,
            softness: 0.2,
        };
        let [_, end] = bones_after(&bones);
        let reached = end.length();
        assert!(
            reached > last && reached < 2.0,
            "{x}: {reached} after {last}"
        );
        assert!(
            x > 1.6 || (reached - x).abs() < 1e-9,
            "not eased before its share"
        );
        last = reached;
    }
}

#[test]
fn a_leg_with_a_hinge_for_a_knee_reaches_in_one_step_and_bends_the_right_way() {
    let skeleton = body();
    let knee = joint(&skeleton, "LeftKnee");
    let chain = skeleton
        .chain(joint(&skeleton, "LeftHip"), joint(&skeleton, "LeftAnkle"))
        .unwrap();
    let mut limits = JointLimits::default();
    let bends_back = JointLimit::Hinge {
        axis: DVec3::X,
        angle_rad: Interval::new(0.0, 2.6),
    };
    limits.set_limit(knee, bends_back).unwrap();
    let limits = Arc::new(limits);
    for at in [
        DVec3::new(0.1, 0.3, 0.1),
        DVec3::new(0.3, 0.4, -0.2),
        DVec3::new(-0.1, 0.5, 0.4),
    ] {
        let mut problem = IkProblem::for_chain(&skeleton, &chain, at);
        problem.limits = Arc::clone(&limits);
        problem.stop.position_tolerance = 1e-6;
        let mut pose = LocalPose::rest(&skeleton);
        let solver = Solver::TwoBone(TwoBoneConfig::default());
        let report = solve_checked(&skeleton, &mut pose, &problem, "two-bone", &solver);
        assert_eq!(
            (report.outcome, report.iterations),
            (IkOutcome::Reached, 1),
            "{report:?}"
        );
        let hip = place(&skeleton, &pose, chain.start());
        // The shin folds to the back of the thigh: seen from the thigh, the ankle is behind its line.
        let ankle = hip.1.conjugate() * (place(&skeleton, &pose, chain.end()).0 - hip.0);
        assert!(ankle.z < 0.0, "{ankle}");
    }
}

#[test]
fn two_bones_take_poles_orientations_and_far_targets() {
    let skeleton = body();
    let chain = skeleton.chain(
        joint(&skeleton, "LeftShoulder"),
        joint(&skeleton, "LeftWrist"),
    );
    let chain = chain.unwrap();
    let solver = Solver::TwoBone(TwoBoneConfig::default());
    let target = IkTarget::position(chain.end(), DVec3::new(0.4, 1.3, 0.3));
    let target = target.with_orientation(DQuat::from_rotation_z(1.0));
    let mut problem = IkProblem::for_target(&skeleton, &chain, StartJoint::Turns, target);
    problem.poles.push(Pole {
        joint: joint(&skeleton, "LeftElbow"),
        point_in_world: DVec3::new(0.4, -5.0, 0.3),
        weight: 1.0,
    });
    let mut pose = LocalPose::rest(&skeleton);
    let report = solve_checked(&skeleton, &mut pose, &problem, "two-bone", &solver);
    assert_eq!(report.outcome, IkOutcome::Reached, "{report:?}");
    let elbow = place(&skeleton, &pose, joint(&skeleton, "LeftElbow")).0;
    assert!(elbow.y < 1.3, "the elbow hangs: {elbow}");

    let far = DVec3::new(3.0, 1.45, 0.0);
    let problem = IkProblem::for_chain(&skeleton, &chain, far);
    let mut pose = LocalPose::rest(&skeleton);
    let report = solve_checked(&skeleton, &mut pose, &problem, "two-bone", &solver);
    let IkOutcome::OutOfReach { by } = report.outcome else {
        panic!("{report:?}");
    };
    assert!((report.residuals[0].distance - by).abs() < 1e-9);
}

#[test]
fn a_head_turns_to_what_it_looks_at() {
    let skeleton = body();
    let head = joint(&skeleton, "Head");
    let chain = skeleton.chain(head, head).unwrap();
    // The face looks along Z: a point before it is aimed.
    let at = DVec3::new(2.0, 1.0, 3.0);
    let target = IkTarget::position(head, at).with_point(DVec3::Z);
    let problem = IkProblem::for_target(&skeleton, &chain, StartJoint::Turns, target);
    let mut pose = LocalPose::rest(&skeleton);
    let report = solve_checked(&skeleton, &mut pose, &problem, "aim", &Solver::Aim);
    assert_eq!(report.outcome, IkOutcome::Reached, "{report:?}");
    let (position, orientation) = place(&skeleton, &pose, head);
    assert!((orientation * DVec3::Z).dot((at - position).normalize()) > 1.0 - 1e-9);
}
