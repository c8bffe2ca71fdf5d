//! All ways to one target: each gets there, within all ranges, no two are equal modulo turns, and there are as many as
//! a dense search finds.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use glam::DVec3;
use posekit::ik::robot::{
    RobotConfig, RobotWorkspace, Ways, WaysConfig, WaysMethod, solve_robot, ways_to,
};
use posekit::ik::{IkOutcome, IkTarget};
use posekit::mechanism::Mechanism;
use posekit::rotation::angle_between;
use posekit::skeleton::JointId;
use posekit_formats::urdf::{self, UpAxis};

/// The Denavit-Hartenberg parameters (d, a, alpha) that Universal Robots publishes for the UR5.
const UR5: [[f64; 3]; 6] = [
    [0.089_159, 0.0, PI / 2.0],
    [0.0, -0.425, 0.0],
    [0.0, -0.392_25, 0.0],
    [0.109_15, 0.0, PI / 2.0],
    [0.094_65, 0.0, -PI / 2.0],
    [0.0823, 0.0, 0.0],
];

/// An arm of Denavit-Hartenberg rows: row `i` is where joint `i + 1` is mounted, the last one the tool.
fn of_rows(rows: &[[f64; 3]; 6], limit: f64) -> (Mechanism, JointId) {
    let mut text = String::from("<robot name='dh'><link name='l0'/>");
    for (index, [d, a, alpha]) in std::iter::once(&[0.0; 3]).chain(rows).enumerate() {
        let (parent, child) = (index, index + 1);
        let moves = match index < 6 {
            true => "type='revolute'",
            false => "type='fixed'",
        };
        let _ = write!(
            text,
            "<link name='l{child}'/><joint name='j{child}' {moves}><parent link='l{parent}'/><child link='l{child}'/>\
             <origin xyz='{a} 0 {d}' rpy='{alpha} 0 0'/><axis xyz='0 0 1'/>\
             <limit lower='-{limit}' upper='{limit}' effort='1' velocity='1'/></joint>"
        );
    }
    text += "</robot>";
    let document = urdf::read(text.as_bytes()).unwrap().document;
    let robot = document.to_robot(UpAxis::Z).unwrap();
    let tool = document.joint_of_link("l7").unwrap();
    (robot, tool)
}

fn sample(name: &str) -> (Mechanism, JointId) {
    let text = urdf::sample::by_name(name).unwrap();
    let document = urdf::read(text.as_bytes()).unwrap().document;
    let tip = if name == "planar2" { "tip" } else { "tool" };
    let tip = document.joint_of_link(tip).unwrap();
    (document.to_robot(UpAxis::Y).unwrap(), tip)
}

/// Numbers from 0 to 1, the same every time (Knuth's MMIX generator).
fn shares(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
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

/// The largest difference modulo turns.
fn gap(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| {
        let off = (a - b).rem_euclid(TAU);
        off.min(TAU - off)
    });
    differences.fold(0.0, f64::max)
}

fn target_of(robot: &Mechanism, tip: JointId, values: &[f64]) -> IkTarget {
    let goal = robot.global_frames(values)[tip.index()];
    IkTarget::position(tip, goal.position).with_orientation(goal.orientation)
}

fn assert_ways(robot: &Mechanism, target: &IkTarget, found: &Ways) {
    for (index, way) in found.ways.iter().enumerate() {
        let reached = robot.global_frames(way)[target.effector.index()];
        let off = reached.position.distance(target.position_in_world);
        assert!(off < 2e-6, "way {index} is off by {off}");
        if let Some(wanted) = target.orientation_in_world {
            assert!(angle_between(reached.orientation, wanted) < 2e-6);
        }
        let ranges = robot.value_ranges();
        assert!(
            ranges
                .iter()
                .zip(way)
                .all(|(range, &value)| range.contains(value))
        );
        for other in &found.ways[..index] {
            assert!(gap(other, way) > 1e-2, "{other:?} and {way:?} are one");
        }
    }
}

/// What many starts of the solver find, told apart here.
fn searched(robot: &Mechanism, target: &IkTarget, starts: usize) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    let mut share = shares(7);
    let mut workspace = RobotWorkspace::new();
    let config = RobotConfig {
        max_attempts: 1,
        ..RobotConfig::default()
    };
    for _ in 0..starts {
        let mut values = random_values(robot, &mut share);
        let report = solve_robot(robot, &mut values, &[*target], &config, &mut workspace);
        if report.outcome.is_reached() && found.iter().all(|known| gap(known, &values) > 1e-2) {
            found.push(values);
        }
    }
    found
}

/// At targets made by random values, the values themselves are among the ways.
fn check_closed_form(robot: &Mechanism, tip: JointId, method: WaysMethod, targets: usize) -> usize {
    let mut share = shares(11);
    let mut most = 0;
    let start = vec![0.0; robot.value_count()];
    for _ in 0..targets {
        let values = random_values(robot, &mut share);
        let target = target_of(robot, tip, &values);
        let found = ways_to(robot, &start, &target, &WaysConfig::default());
        assert_eq!(found.method, method);
        assert!(!found.is_endless);
        assert_ways(robot, &target, &found);
        let is_there = |way: &Vec<f64>| gap(way, &values) < 1e-4;
        assert!(found.ways.iter().any(is_there), "{values:?} {found:?}");
        most = most.max(found.ways.len());
    }
    most
}

#[test]
fn a_spherical_wrist_is_solved_in_closed_form() {
    let (robot, tool) = sample("arm6");
    let most = check_closed_form(&robot, tool, WaysMethod::SphericalWrist, 200);
    assert!(most <= 8 && most > 2, "{most}");
    // Without ranges all eight are there: this one is well inside the reach.
    let mut rows = [[0.0; 3]; 6];
    let puma = [
        [0.0, 0.0, -PI / 2.0],
        [0.149_09, 0.4318, 0.0],
        [0.0, -0.020_32, PI / 2.0],
        [0.433_07, 0.0, -PI / 2.0],
        [0.0, 0.0, PI / 2.0],
        [0.056_25, 0.0, 0.0],
    ];
    rows.copy_from_slice(&puma);
    let (robot, tool) = of_rows(&rows, PI);
    let most = check_closed_form(&robot, tool, WaysMethod::SphericalWrist, 100);
    assert_eq!(most, 8);
}

/// Offsets at the shoulder and a skew second axis: the quartic's full case.
#[test]
fn a_spherical_wrist_behind_any_three_hinges_is_solved_in_closed_form() {
    let rows = [
        [0.3, 0.11, 1.1],
        [0.12, 0.4, 0.6],
        [0.05, 0.07, PI / 2.0],
        [0.37, 0.0, -PI / 2.0],
        [0.0, 0.0, PI / 2.0],
        [0.1, 0.0, 0.0],
    ];
    let (robot, tool) = of_rows(&rows, PI);
    let most = check_closed_form(&robot, tool, WaysMethod::SphericalWrist, 100);
    assert!(most == 4 || most == 8, "{most}");
}

#[test]
fn three_parallel_axes_are_solved_in_closed_form() {
    let (robot, tool) = of_rows(&UR5, TAU);
    let most = check_closed_form(&robot, tool, WaysMethod::ThreeParallelAxes, 200);
    assert_eq!(most, 8, "ranges of two turns make no further ways");
}

#[test]
fn there_are_as_many_ways_as_a_dense_search_finds() {
    let arms = [sample("arm6"), of_rows(&UR5, TAU)];
    for (robot, tool) in arms {
        let mut share = shares(3);
        for _ in 0..3 {
            let values = random_values(&robot, &mut share);
            let target = target_of(&robot, tool, &values);
            let found = ways_to(&robot, &values, &target, &WaysConfig::default());
            let dense = searched(&robot, &target, 800);
            assert_eq!(found.ways.len(), dense.len(), "{found:?} {dense:?}");
            for way in &dense {
                assert!(found.ways.iter().any(|known| gap(known, way) < 1e-2));
            }
            assert!(gap(&found.ways[0], &values) < 1e-4, "the nearest is first");
        }
    }
}

#[test]
fn other_robots_are_searched() {
    // Parallel axes, but the last two do not meet: no closed form here.
    let mut rows = UR5;
    rows[4][1] = 0.03;
    let (robot, tool) = of_rows(&rows, PI);
    let values = [0.3, -1.1, 1.3, -0.4, 0.9, 0.2];
    let target = target_of(&robot, tool, &values);
    let found = ways_to(&robot, &values, &target, &WaysConfig::default());
    assert_eq!(found.method, WaysMethod::Search);
    assert!(!found.is_endless && found.ways.len() > 1);
    assert_ways(&robot, &target, &found);

    let (robot, tip) = sample("planar2");
    let place = robot.global_frames(&[0.4, 0.9])[tip.index()].position;
    let target = IkTarget::position(tip, place);
    let found = ways_to(&robot, &[0.4, 0.9], &target, &WaysConfig::default());
    assert!(!found.is_endless);
    assert_eq!(found.ways.len(), 2, "elbow on either side");
    assert_ways(&robot, &target, &found);
}

#[test]
fn a_redundant_arm_has_no_end_of_ways() {
    let (robot, tool) = sample("arm7");
    let values = [0.2, 0.5, -0.3, -1.2, 0.4, 0.8, 0.1];
    let target = target_of(&robot, tool, &values);
    let found = ways_to(&robot, &values, &target, &WaysConfig::default());
    assert!(found.is_endless);
    assert_eq!(found.ways.len(), WaysConfig::default().most_of_endless);
    assert_ways(&robot, &target, &found);
}

#[test]
fn what_is_out_of_reach_has_no_way() {
    for (robot, tool) in [sample("arm6"), of_rows(&UR5, TAU)] {
        let mut target = target_of(&robot, tool, &[0.1; 6]);
        target.position_in_world *= 20.0;
        let found = ways_to(&robot, &[0.0; 6], &target, &WaysConfig::default());
        assert!(found.ways.is_empty() && !found.is_endless);
        target.position_in_world.x = f64::NAN;
        let found = ways_to(&robot, &[0.0; 6], &target, &WaysConfig::default());
        assert!(found.ways.is_empty());
    }
}

#[test]
fn singular_arms_give_ways_that_reach() {
    // A stretched wrist, and the tool over the first axis.
    let (robot, tool) = sample("arm6");
    for values in [[0.3, -0.8, 0.9, 0.4, 0.0, 0.2], [0.0; 6]] {
        let target = target_of(&robot, tool, &values);
        let found = ways_to(&robot, &values, &target, &WaysConfig::default());
        assert!(!found.ways.is_empty());
        assert_ways(&robot, &target, &found);
    }
}

/// Hinges one after the other, a metre between them, that turn about Z by `ranges`; the tip a metre behind the last.
fn chain(text: &mut String, name: &str, ranges: &[(f64, f64)]) {
    let mut parent = "body".to_owned();
    for (index, (lower, upper)) in ranges.iter().enumerate() {
        let child = format!("{name}{index}");
        let away = f64::from(u8::from(index > 0));
        let _ = write!(
            text,
            "<link name='{child}'/><joint name='{child}' type='revolute'><parent link='{parent}'/><child link='{child}'/>\
             <origin xyz='{away} 0 0'/><axis xyz='0 0 1'/><limit lower='{lower}' upper='{upper}' effort='1' \
             velocity='1'/></joint>"
        );
        parent = child;
    }
    let _ = write!(
        text,
        "<link name='{name}tip'/><joint name='{name}tip' type='fixed'><parent link='{parent}'/>\
         <child link='{name}tip'/><origin xyz='1 0 0'/></joint>"
    );
}

/// A body with two arms, and the tip of the first.
fn two_arms(first: &[(f64, f64)], second: &[(f64, f64)]) -> (Mechanism, JointId) {
    let mut text = String::from("<robot name='two'><link name='body'/>");
    chain(&mut text, "a", first);
    chain(&mut text, "b", second);
    text += "</robot>";
    let document = urdf::read(text.as_bytes()).unwrap().document;
    let tip = document.joint_of_link("atip").unwrap();
    (document.to_robot(UpAxis::Z).unwrap(), tip)
}

#[test]
fn what_does_not_move_the_tip_stays() {
    // The second arm could go anywhere, and is outside its range besides.
    let (robot, tip) = two_arms(&[(-3.0, 3.0); 3], &[(-2.0, 2.0), (0.5, 1.0)]);
    let values = [0.4, 0.5, -0.3, 0.7, 0.2];
    let goal = robot.global_frames(&values)[tip.index()];
    let posed = IkTarget::position(tip, goal.position).with_orientation(goal.orientation);
    for (target, least) in [(IkTarget::position(tip, goal.position), 4), (posed, 2)] {
        let found = ways_to(&robot, &values, &target, &WaysConfig::default());
        assert!(found.ways.len() >= least, "{}", found.ways.len());
        for way in &found.ways {
            let off = robot.global_frames(way)[tip.index()]
                .position
                .distance(goal.position);
            assert!(off < 2e-6, "{off}");
            assert_eq!(way[3..], values[3..], "{way:?}");
        }
    }
}

#[test]
fn limits_are_blamed_only_where_they_are_in_the_way() {
    let outcome_of = |ranges: &[(f64, f64)], others: &[(f64, f64)], place, attempts| {
        let (robot, tip) = two_arms(ranges, others);
        let mut values: Vec<f64> = robot.value_ranges().iter().map(|r| r.clamp(0.3)).collect();
        let target = IkTarget::position(tip, place);
        let config = RobotConfig {
            max_attempts: attempts,
            ..RobotConfig::default()
        };
        let workspace = &mut RobotWorkspace::new();
        solve_robot(&robot, &mut values, &[target], &config, workspace).outcome
    };
    let far = DVec3::new(2.5, 1.0, 0.0);
    let near = DVec3::new(0.2, 0.4, 0.0);
    for attempts in [1, 40] {
        let of = |ranges: &[(f64, f64)], others: &[(f64, f64)], place| {
            outcome_of(ranges, others, place, attempts)
        };
        // Out of reach, with the other arm at an end of its range, and with the elbow as straight as it may be.
        let ends_at_03 = [(0.3, 0.6)];
        assert_eq!(of(&[(-3.0, 3.0); 2], &ends_at_03, far), IkOutcome::Stalled);
        let nearly_straight = [(-3.0, 3.0), (0.05, 3.0)];
        assert_eq!(of(&nearly_straight, &ends_at_03, far), IkOutcome::Stalled);
        // The elbow does not bend far enough.
        let stiff = [(-3.0, 3.0), (-0.5, 0.5)];
        assert_eq!(of(&stiff, &ends_at_03, near), IkOutcome::LimitsInTheWay);
        // It bends one way only, and the arm gets there that way.
        let bends = [(-3.0, 3.0), (0.0, 3.0)];
        assert_eq!(of(&bends, &ends_at_03, near), IkOutcome::Reached);
    }
    // The shoulder stands at the wrong end: another start gets there within the ranges.
    let (robot, tip) = two_arms(&[(-3.1, 3.1), (-0.1, 0.1)], &[]);
    let place = DVec3::new(-1.9979, 0.07, 0.0);
    let mut values = vec![-3.1, 0.0];
    let config = RobotConfig {
        max_attempts: 1,
        ..RobotConfig::default()
    };
    let target = [IkTarget::position(tip, place)];
    let workspace = &mut RobotWorkspace::new();
    let report = solve_robot(&robot, &mut values, &target, &config, workspace);
    assert_ne!(report.outcome, IkOutcome::LimitsInTheWay, "{report:?}");
}
