//! Robots from URDF files stand where Pinocchio says (`tests/golden/make_urdf_fk.py`), in `f64` and as
//! poses; the turn to Y up is the one that is documented.

use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3, Vec3};
use posekit::mechanism::Mechanism;
use posekit::rotation::angle_between;
use posekit_formats::urdf::{self, UpAxis, Urdf};
use serde_json::Value;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn document(file: &str) -> Urdf {
    let name = file.trim_end_matches(".urdf");
    let text = match urdf::sample::by_name(name) {
        Some(text) => text.to_owned(),
        None => std::fs::read_to_string(folder().join(file)).unwrap(),
    };
    urdf::read(text.as_bytes()).unwrap().document
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|number| number.as_f64().unwrap())
        .collect()
}

/// The mechanism's own values in its order, from values by joint name.
fn values(robot: &Mechanism, by_name: &Value) -> Vec<f64> {
    robot
        .moving_joints()
        .flat_map(|joint| numbers(&by_name[robot.skeleton().name(joint)]))
        .collect()
}

/// Calls `check` with every row of the golden file.
fn for_every_row(mut check: impl FnMut(&Urdf, &Value)) {
    let text = std::fs::read_to_string(folder().join("urdf_fk.json")).unwrap();
    let golden: Value = serde_json::from_str(&text).unwrap();
    let files = golden["files"].as_array().unwrap();
    assert_eq!(files.len(), 4);
    for file in files {
        let document = document(file["file"].as_str().unwrap());
        let rows = file["rows"].as_array().unwrap();
        assert_eq!(rows.len(), 5);
        for row in rows {
            check(&document, row);
        }
    }
}

#[test]
fn links_stand_where_pinocchio_says() {
    let mut compared = 0;
    for_every_row(|document, row| {
        let robot = document.to_robot(UpAxis::Z).unwrap();
        let values = values(&robot, &row["values"]);
        let frames = robot.global_frames(&values);
        let pose = robot.local_pose(&values).to_global(robot.skeleton());
        let links = document.links_from_root();
        assert_eq!(links.len(), document.links.len());
        for (joint, &link) in links.iter().enumerate() {
            let expected = numbers(&row["links"][&document.links[link].name]);
            let position = DVec3::from_slice(&expected[..3]);
            let orientation = DQuat::from_slice(&expected[3..]).normalize();
            let name = &document.links[link].name;
            assert!(
                (frames[joint].position - position).length() < 1e-11,
                "{name}"
            );
            let angle = angle_between(frames[joint].orientation, orientation);
            assert!(angle < 1e-11, "{name}");
            let error = pose.positions[joint].as_dvec3() - position;
            assert!(error.length() < 2e-6, "{name}, as a pose");
            compared += 1;
        }
    });
    assert_eq!(compared, 5 * (9 + 4 + 8 + 9));
}

#[test]
fn standing_upright_carries_x_to_z_and_z_to_y() {
    let carried =
        [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| UpAxis::Y.world_from_file().as_quat() * axis);
    assert_eq!(carried, [Vec3::Z, Vec3::X, Vec3::Y]);
    for_every_row(|document, row| {
        let (lying, standing) = (
            document.to_robot(UpAxis::Z).unwrap(),
            document.to_robot(UpAxis::Y).unwrap(),
        );
        let values = values(&lying, &row["values"]);
        let pairs = lying.global_frames(&values).into_iter();
        for (z_up, y_up) in pairs.zip(standing.global_frames(&values)) {
            let DVec3 { x, y, z } = z_up.position;
            assert!((y_up.position - DVec3::new(y, z, x)).length() < 1e-14);
        }
    });
}

#[test]
fn values_come_back_from_poses() {
    for_every_row(|document, row| {
        let robot = document.to_robot(UpAxis::Y).unwrap();
        // Angles come back within half a turn of zero.
        let values: Vec<f64> = values(&robot, &row["values"])
            .into_iter()
            .map(|value| value.clamp(-3.0, 3.0))
            .collect();
        let back = robot.values_of(&robot.local_pose(&values));
        assert_eq!(values.len(), back.len());
        for (a, b) in values.iter().zip(&back) {
            assert!((a - b).abs() < 1e-6, "{values:?} {back:?}");
        }
    });
}

#[test]
fn ranges_are_those_of_the_file_and_of_followers() {
    let document = document("all_joint_kinds.urdf");
    let robot = document.to_robot(UpAxis::Y).unwrap();
    let of = |name: &str| {
        let joint = robot.skeleton().find(name).unwrap();
        robot.value_ranges()[robot.values_of_joint(joint).start]
    };
    assert_eq!((of("grip").lower, of("grip").upper), (0.0, 0.05));
    // `spin` is 2 lift - 0.1 and stays within 1.5, which leaves more than lift's own range.
    assert_eq!((of("lift").lower, of("lift").upper), (-0.5, 0.5));
    assert!(!of("turn").is_bounded());
    let follower = robot.skeleton().find("oppose").unwrap();
    assert!(robot.values_of_joint(follower).is_empty());
}

#[test]
fn the_planar_arm_is_the_formula_of_the_lectures() {
    let robot = document("planar2.urdf").to_robot(UpAxis::Z).unwrap();
    let (l1, l2): (f64, f64) = (0.5, 0.4);
    for (t1, t2) in [(0.0_f64, 0.0_f64), (0.3, 0.9), (-2.0, 1.1), (3.0, -2.7)] {
        let tip = robot.global_frames(&[t1, t2])[3].position;
        let x = l1 * (t1).cos() + l2 * (t1 + t2).cos();
        let y = l1 * (t1).sin() + l2 * (t1 + t2).sin();
        assert!((tip - DVec3::new(x, 0.0, 0.6 + y)).length() < 1e-15);
    }
}
