//! Mechanisms: what is refused, and values of ball, planar and free joints.

use glam::{DQuat, DVec3, Vec3};
use posekit::ik::IkTarget;
use posekit::ik::robot::{RobotConfig, RobotWorkspace, solve_robot};
use posekit::mechanism::{Follow, Freedom, Mechanism, MechanismError, MechanismJoint, ValueRange};
use posekit::rotation::angle_between;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};

fn rope(count: usize) -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    let mut last = builder.joint("0", None, Vec3::ZERO);
    for index in 1..count {
        last = builder.joint(index.to_string(), Some(last), Vec3::X);
    }
    builder.build().unwrap()
}

fn joint(freedom: Freedom) -> MechanismJoint {
    MechanismJoint {
        rest_rotation: DQuat::IDENTITY,
        rest_translation: DVec3::X,
        freedom,
        range: ValueRange::FREE,
        follows: None,
    }
}

fn following(joint: MechanismJoint, other: usize) -> MechanismJoint {
    MechanismJoint {
        follows: Some(Follow {
            joint: JointId::new(other),
            multiplier: 2.0,
            offset: 0.5,
        }),
        ..joint
    }
}

const HINGE: Freedom = Freedom::Hinge { axis: DVec3::Z };

#[test]
fn nonsense_is_refused() {
    let refused = |joints: Vec<MechanismJoint>| Mechanism::new(rope(2), joints).unwrap_err();
    let good = joint(HINGE);
    assert!(matches!(
        refused(vec![good]),
        MechanismError::JointCount {
            expected: 2,
            given: 1
        }
    ));
    let bad = [
        MechanismJoint {
            rest_translation: DVec3::NAN,
            ..good
        },
        MechanismJoint {
            rest_rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0),
            ..good
        },
        joint(Freedom::Slide { axis: DVec3::ZERO }),
        joint(Freedom::Planar {
            normal: DVec3::splat(f64::INFINITY),
        }),
        MechanismJoint {
            range: ValueRange {
                lower: 1.0,
                upper: 0.0,
            },
            ..good
        },
        MechanismJoint {
            range: ValueRange {
                lower: f64::NAN,
                upper: 0.0,
            },
            ..good
        },
    ];
    for bad in bad {
        assert!(matches!(
            refused(vec![good, bad]),
            MechanismError::Value { joint: 1, .. }
        ));
    }
    for pair in [
        [good, following(good, 1)],
        [following(good, 1), following(good, 0)],
        [good, following(good, 7)],
        [joint(Freedom::Ball), following(good, 0)],
    ] {
        assert!(matches!(
            refused(pair.to_vec()),
            MechanismError::Follow { .. }
        ));
    }
}

#[test]
fn followers_of_followers_go_as_their_lines_say() {
    let joints = vec![
        following(joint(HINGE), 1),
        following(joint(HINGE), 2),
        joint(HINGE),
    ];
    let mechanism = Mechanism::new(rope(3), joints).unwrap();
    assert_eq!(mechanism.value_count(), 1);
    let frames = mechanism.global_frames(&[0.1]);
    // 0.1, then 2 * 0.1 + 0.5 = 0.7, then 2 * 0.7 + 0.5 = 1.9.
    let turns = [1.9, 1.9 + 0.7, 1.9 + 0.7 + 0.1];
    for (frame, turn) in frames.iter().zip(turns) {
        let expected = DQuat::from_rotation_z(turn);
        assert!(angle_between(frame.orientation, expected) < 1e-12);
    }
}

#[test]
fn ranges_of_followers_narrow_the_followed() {
    let range = |lower, upper| ValueRange { lower, upper };
    let mut follower = following(joint(HINGE), 0);
    follower.range = range(-0.5, 1.5);
    let mut followed = joint(HINGE);
    followed.range = range(-9.0, 0.25);
    let mechanism = Mechanism::new(rope(2), vec![followed, follower]).unwrap();
    // 2 v + 0.5 within -0.5 and 1.5: v within -0.5 and 0.5, and not above 0.25.
    assert_eq!(mechanism.value_ranges(), [range(-0.5, 0.25)]);
}

#[test]
fn ball_planar_and_free_joints_have_values_that_come_back() {
    let normal = DVec3::new(0.0, 0.6, 0.8);
    let freedoms = [
        Freedom::Free,
        Freedom::Planar { normal },
        Freedom::Ball,
        Freedom::Slide { axis: DVec3::Y },
    ];
    let mechanism = Mechanism::of(rope(4), freedoms).unwrap();
    assert_eq!(mechanism.value_count(), 6 + 3 + 3 + 1);
    let values = [
        0.1, -0.2, 0.3, 0.4, -0.5, 0.6, 1.0, 2.0, -0.7, 0.8, 0.9, -1.0, 0.25,
    ];
    let back = mechanism.values_of(&mechanism.local_pose(&values));
    for (a, b) in values.iter().zip(&back) {
        assert!((a - b).abs() < 2e-6, "{back:?}");
    }
    // A planar joint stays in its plane.
    let frames = mechanism.global_frames(&values);
    let moved = frames[0].orientation.conjugate() * (frames[1].position - frames[0].position);
    assert!((moved - DVec3::X).dot(normal).abs() < 1e-12);
}

#[test]
fn a_figure_is_a_mechanism_and_its_poses_come_back() {
    let skeleton = posekit::sample::robot_arm();
    let figure = Mechanism::of_figure(skeleton.clone());
    let mut pose = posekit::pose::LocalPose::rest(&skeleton);
    for (index, rotation) in pose.rotations.iter_mut().enumerate().take(7) {
        *rotation = glam::Quat::from_rotation_y(0.2 * index as f32);
    }
    let back = figure.local_pose(&figure.values_of(&pose));
    for (a, b) in pose.rotations.iter().zip(&back.rotations) {
        assert!(a.angle_between(*b) < 1e-3);
    }
}

#[test]
fn free_and_ball_joints_are_solved() {
    let freedoms = [Freedom::Free, Freedom::Ball, Freedom::Ball];
    let mechanism = Mechanism::of(rope(3), freedoms).unwrap();
    let tip = JointId::new(2);
    let orientation = DQuat::from_rotation_y(2.0) * DQuat::from_rotation_x(1.0);
    let target = IkTarget::position(tip, DVec3::new(3.0, 4.0, -5.0))
        .with_orientation(orientation)
        .with_point(DVec3::new(0.0, 0.5, 0.0));
    let mut values = vec![0.0; mechanism.value_count()];
    let config = RobotConfig::default();
    let mut workspace = RobotWorkspace::new();
    let report = solve_robot(&mechanism, &mut values, &[target], &config, &mut workspace);
    assert!(report.outcome.is_reached(), "{report:?}");
    let frame = mechanism.global_frames(&values)[2];
    let point = frame.position + frame.orientation * DVec3::new(0.0, 0.5, 0.0);
    assert!(point.distance(target.position_in_world) < 2e-6);
    assert!(angle_between(frame.orientation, orientation) < 2e-6);
}

#[test]
fn no_targets_and_no_freedom_are_no_trouble() {
    let mechanism = Mechanism::of(rope(2), [HINGE]).unwrap();
    let mut values = [0.3];
    let config = RobotConfig::default();
    let mut workspace = RobotWorkspace::new();
    let report = solve_robot(&mechanism, &mut values, &[], &config, &mut workspace);
    assert!(report.outcome.is_reached() && values == [0.3]);
    let stiff = Mechanism::of(rope(2), []).unwrap();
    let target = IkTarget::position(JointId::new(1), DVec3::Y);
    let report = solve_robot(&stiff, &mut [], &[target], &config, &mut workspace);
    assert!(!report.outcome.is_reached());
    assert!((report.residuals[0].distance - 2.0_f64.sqrt()).abs() < 1e-12);
}
