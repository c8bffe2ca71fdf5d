//! Our own robot arms: their Jacobians are Pinocchio's (`tests/golden/make_urdf_fk.py`), and what the solver
//! finds for random reachable poses brings the tool there, by forward kinematics, within all ranges.

use std::f64::consts::PI;

use glam::DVec3;
use posekit::ik::IkTarget;
use posekit::ik::robot::{
    Dexterity, RobotConfig, RobotWorkspace, Task, jacobian, range_margins, solve_robot,
};
use posekit::mechanism::Mechanism;
use posekit::rotation::angle_between;
use posekit::skeleton::JointId;
use posekit_formats::urdf::{self, UpAxis};
use serde_json::Value;

fn arm(name: &str, up: UpAxis) -> (Mechanism, JointId) {
    let text = urdf::sample::by_name(name).unwrap();
    let document = urdf::read(text.as_bytes()).unwrap().document;
    let robot = document.to_robot(up).unwrap();
    let tool = document.joint_of_link(if name == "planar2" { "tip" } else { "tool" });
    let tool = tool.unwrap();
    (robot, tool)
}

/// Numbers from 0 to 1, the same every time (Knuth's MMIX generator).
fn shares() -> impl FnMut() -> f64 {
    let mut state = 20_240_601_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 32).unwrap()) / f64::from(u32::MAX)
    }
}

fn random_values(robot: &Mechanism, mut share: impl FnMut() -> f64) -> Vec<f64> {
    let ranges = robot.value_ranges();
    let ends = ranges.iter().map(|r| (r.lower.max(-PI), r.upper.min(PI)));
    ends.map(|(low, high)| low + (high - low) * share())
        .collect()
}

#[test]
fn random_reachable_poses_are_reached_within_all_ranges() {
    for name in ["arm6", "arm7"] {
        let (robot, tool) = arm(name, UpAxis::Y);
        let mut share = shares();
        let mut workspace = RobotWorkspace::new();
        let start = vec![0.0; robot.value_count()];
        for _ in 0..500 {
            let goal = robot.global_frames(&random_values(&robot, &mut share))[tool.index()];
            let target = IkTarget::position(tool, goal.position).with_orientation(goal.orientation);
            let mut values = start.clone();
            let config = RobotConfig::default();
            let report = solve_robot(&robot, &mut values, &[target], &config, &mut workspace);
            assert!(report.outcome.is_reached(), "{name} {report:?}");
            let reached = robot.global_frames(&values)[tool.index()];
            assert!(
                reached.position.distance(goal.position) <= 1.001e-6,
                "{name}"
            );
            assert!(angle_between(reached.orientation, goal.orientation) <= 1.001e-6);
            let ranges = robot.value_ranges();
            assert!(
                ranges
                    .iter()
                    .zip(&values)
                    .all(|(range, value)| range.contains(*value))
            );
            assert!(
                (report.residuals[0].distance - reached.position.distance(goal.position)).abs()
                    < 1e-12
            );
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_values_and_another_one_may_not() {
    let (robot, tool) = arm("arm6", UpAxis::Y);
    let mut share = shares();
    let (mut differs, mut restarted) = (false, false);
    for _ in 0..40 {
        let goal = robot.global_frames(&random_values(&robot, &mut share))[tool.index()];
        let target = IkTarget::position(tool, goal.position).with_orientation(goal.orientation);
        let run = |seed: u64| {
            let config = RobotConfig {
                seed,
                ..RobotConfig::default()
            };
            let mut values = vec![0.0; 6];
            let report = solve_robot(
                &robot,
                &mut values,
                &[target],
                &config,
                &mut RobotWorkspace::new(),
            );
            (values, report)
        };
        let (first, report) = run(1);
        assert_eq!((first.clone(), report.clone()), run(1));
        restarted |= report.attempts > 1;
        differs |= first != run(2).0;
    }
    assert!(restarted && differs);
}

#[test]
fn what_cannot_be_reached_is_said_and_the_nearest_is_left() {
    let (robot, tool) = arm("arm7", UpAxis::Y);
    let far = IkTarget::position(tool, DVec3::new(0.0, 0.36, 5.0));
    let config = RobotConfig {
        max_attempts: 8,
        ..RobotConfig::default()
    };
    let mut values = vec![0.1; 7];
    let report = solve_robot(
        &robot,
        &mut values,
        &[far],
        &config,
        &mut RobotWorkspace::new(),
    );
    assert!(!report.outcome.is_reached());
    assert_eq!(report.attempts, 8);
    // Stretched from the shoulder, 0.946 m, and 5 m away.
    let left = report.residuals[0].distance;
    assert!((left - (5.0 - 0.946)).abs() < 1e-3, "{left}");
    let nowhere = IkTarget::position(tool, DVec3::new(f64::NAN, 0.0, 0.0));
    let before = values.clone();
    let report = solve_robot(
        &robot,
        &mut values,
        &[nowhere],
        &config,
        &mut RobotWorkspace::new(),
    );
    assert!(!report.outcome.is_reached());
    assert_eq!((report.iterations, &values), (0, &before));
}

fn numbers(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().unwrap().iter();
    numbers.map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn jacobians_and_singular_values_are_pinocchios() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/urdf_fk.json");
    let golden: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut compared = 0;
    for file in golden["files"].as_array().unwrap() {
        let name = file["file"].as_str().unwrap().trim_end_matches(".urdf");
        if urdf::sample::by_name(name).is_none() {
            continue;
        }
        let (robot, tool) = arm(name, UpAxis::Z);
        for row in file["rows"].as_array().unwrap() {
            let values: Vec<f64> = robot
                .moving_joints()
                .flat_map(|joint| numbers(&row["values"][robot.skeleton().name(joint)]))
                .collect();
            let ours = jacobian(&robot, &values, tool, DVec3::ZERO);
            for (joint, column) in robot.moving_joints().zip(&ours.columns) {
                let expected = numbers(&row["jacobian"][robot.skeleton().name(joint)]);
                let slid = DVec3::from_slice(&expected[..3]);
                let turned = DVec3::from_slice(&expected[3..]);
                assert!((column.0 - slid).length() < 1e-10, "{name}");
                assert!((column.1 - turned).length() < 1e-10, "{name}");
            }
            let task = Task::Pose { radian_length: 0.5 };
            let dexterity = Dexterity::of(&ours, task);
            let expected = numbers(&row["singular_values"]);
            for (a, b) in dexterity.singular_values.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-9, "{name} {dexterity:?} {expected:?}");
            }
            compared += 1;
        }
    }
    assert_eq!(compared, 15);
}

/// Every kind of joint, and followers, by central differences of the forward kinematics.
#[test]
fn jacobians_are_the_slopes_of_forward_kinematics() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/all_joint_kinds.urdf"
    );
    let document = urdf::read(&std::fs::read(path).unwrap()).unwrap().document;
    let robot = document.to_robot(UpAxis::Y).unwrap();
    let mut share = shares();
    let point = DVec3::new(0.1, -0.2, 0.3);
    for tip in robot.skeleton().joints() {
        // Rotation vectors at zero: there their slopes are turns about the axes.
        let mut values: Vec<f64> = (0..robot.value_count()).map(|_| share() - 0.5).collect();
        let float = robot.values_of_joint(robot.skeleton().find("float").unwrap());
        values[float][3..].fill(0.0);
        let ours = jacobian(&robot, &values, tip, point);
        for (index, column) in ours.columns.iter().enumerate() {
            let step = 1e-5;
            let at = |by: f64| {
                let mut values = values.clone();
                values[index] += by;
                let frame = robot.global_frames(&values)[tip.index()];
                (
                    frame.position + frame.orientation * point,
                    frame.orientation,
                )
            };
            let ((a, from), (b, to)) = (at(-step), at(step));
            let slid = (b - a) / (2.0 * step);
            let turned = posekit::rotation::log(to * from.conjugate()) / (2.0 * step);
            assert!((slid - column.0).length() < 1e-8, "{index}");
            assert!((turned - column.1).length() < 1e-8, "{index}");
        }
    }
}

/// Followers, slides, a planar joint and targets for two links at once: the solver drives values that move
/// several joints.
#[test]
fn followers_and_joints_of_all_kinds_are_solved() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/all_joint_kinds.urdf"
    );
    let document = urdf::read(&std::fs::read(path).unwrap()).unwrap().document;
    let robot = document.to_robot(UpAxis::Y).unwrap();
    let joint = |name: &str| robot.skeleton().find(name).unwrap();
    let mut share = shares();
    let mut solved = 0;
    for _ in 0..100 {
        let goal: Vec<f64> = robot
            .value_ranges()
            .iter()
            .map(|range| {
                let (low, high) = (range.lower.max(-1.0), range.upper.min(1.0));
                low + (high - low) * share()
            })
            .collect();
        let frames = robot.global_frames(&goal);
        let targets = ["grip", "oppose", "float"].map(|name| {
            let frame = &frames[joint(name).index()];
            IkTarget::position(joint(name), frame.position).with_orientation(frame.orientation)
        });
        let mut values = vec![0.0; robot.value_count()];
        let config = RobotConfig::default();
        let report = solve_robot(
            &robot,
            &mut values,
            &targets,
            &config,
            &mut RobotWorkspace::new(),
        );
        solved += usize::from(report.outcome.is_reached());
        let reached = robot.global_frames(&values);
        for (target, residual) in targets.iter().zip(&report.residuals) {
            let distance = reached[target.effector.index()]
                .position
                .distance(target.position_in_world);
            assert!((distance - residual.distance).abs() < 1e-9);
        }
    }
    assert_eq!(solved, 100);
}

#[test]
fn manipulability_of_the_planar_arm_is_the_textbooks() {
    let (robot, tip) = arm("planar2", UpAxis::Z);
    for (t1, t2) in [(0.3_f64, 0.9_f64), (-2.0, 2.5), (1.0, -0.01), (0.5, 0.0)] {
        let jacobian = jacobian(&robot, &[t1, t2], tip, DVec3::ZERO);
        // The plane stands upright: its normal is the file's -Y.
        let task = Task::PositionInPlane {
            normal: DVec3::NEG_Y,
        };
        let dexterity = Dexterity::of(&jacobian, task);
        let expected = 0.5 * 0.4 * t2.sin().abs();
        assert!((dexterity.manipulability() - expected).abs() < 1e-15);
        if t2 == 0.0 {
            assert!(dexterity.isotropy() < 1e-15 && dexterity.condition() > 1e15);
        }
    }
}

#[test]
fn margins_say_what_is_left_of_ranges() {
    let (robot, _) = arm("arm7", UpAxis::Y);
    let mut values = vec![0.0; 7];
    let limit = 120.0_f64.to_radians();
    values[1] = limit;
    values[3] = -0.5 * limit;
    let margins = range_margins(&robot, &values);
    assert_eq!(margins.len(), 7);
    assert!((margins[0].share - 1.0).abs() < 1e-9);
    assert!(margins[1].share.abs() < 1e-9 && margins[1].to_upper.abs() < 1e-9);
    assert!((margins[3].share - 0.5).abs() < 1e-9);
    assert!((margins[3].to_lower - 0.5 * limit).abs() < 1e-9);
}
