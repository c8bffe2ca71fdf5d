//! Rotations as Euler curves in the file, and what is said where quaternions cannot hold them.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use posekit::keyframe::{
    Extrapolation, Handle, HandlePair, Interpolation, Keyframe, Tangents, Track,
};
use posekit::motion::Motion;
use posekit_formats::scene::{
    self, JointValues, MotionFileError, Scene, SceneProblemKind as Kind, Shot,
};

use super::{NOD, nod};

/// A mill whose sails turn once in four seconds.
const MILL: &str = r#"format = "posekit scene"
version = 2
range_secs = [0, 4]

[skeleton]
joints = [
  { name = "Mast", translation = [0, 2, 0] },
  { name = "Sails", parent = "Mast", translation = [0, 0, 0.3] },
  { name = "Tip", parent = "Sails", translation = [1.5, 0, 0], end_site = true },
]

[[track]]
joint = "Sails"
property = "rotation"
euler_deg = "XYZ"
keys = [
  { at = 0, value = [0, 0, 0], curve = "linear" },
  { at = 4, value = [0, 0, 360], curve = "linear" },
]
"#;

fn shot(scene: &Scene) -> Shot {
    let none = |_: &str| -> Result<Arc<Motion>, MotionFileError> {
        Err(MotionFileError("no file is named".to_owned()))
    };
    Shot::new(scene, none).expect("a shot")
}

/// Where the tip stands at a time, seen from the hub.
fn tip(scene: &Scene, time_secs: f64) -> Vec3 {
    let shot = shot(scene);
    let mut pose = posekit::pose::LocalPose::rest(shot.skeleton());
    shot.sample_into(time_secs, &mut pose);
    let global = pose.to_global(shot.skeleton());
    global.positions[2] - global.positions[1]
}

#[test]
fn the_spins_of_the_cases_turn_as_the_curve_says() {
    let folder = Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/cases"
    ));
    for (name, degrees) in [("spin", 360.0), ("spin270", 270.0), ("spin720", 720.0)] {
        let Ok(bytes) = std::fs::read(folder.join(format!("{name}.posekit.toml"))) else {
            eprintln!("../shared/cases is missing: its spins are not tested");
            return;
        };
        let scene = scene::read(&bytes).unwrap();
        for quarter in 0..=4_u8 {
            let turned = f64::from(quarter) / 4.0 * degrees;
            let (sin, cos) = turned.to_radians().sin_cos();
            let expected = (DVec3::new(cos, sin, 0.0) * 1.5).as_vec3();
            let found = tip(&scene, f64::from(quarter));
            assert!(
                (found - expected).length() < 1e-5,
                "{name} at {quarter} s: {found}"
            );
        }
        // Baked, frame 30 of 30 a second is the first quarter.
        let motion = shot(&scene).bake(None);
        let turn = motion.rotation(30, motion.rotated_joints()[1]).as_dquat();
        let half = (degrees / 8.0).to_radians();
        assert!(
            (turn
                .dot(glam::DQuat::from_xyzw(0.0, 0.0, half.sin(), half.cos()))
                .abs()
                - 1.0)
                .abs()
                < 1e-6
        );
    }
}

#[test]
fn euler_keys_are_curves_unless_the_file_says_quaternion() {
    for version in ["version = 1", "version = 2"] {
        let text = MILL.replace("version = 2", version);
        let scene = scene::read(text.as_bytes()).unwrap();
        assert!(
            (tip(&scene, 1.0) - Vec3::Y * 1.5).length() < 1e-6,
            "{version}"
        );
        let said = text.replace("\"XYZ\"\n", "\"XYZ\"\nmode = \"euler\"\n");
        assert_eq!(scene::read(said.as_bytes()).unwrap(), scene);
    }
    let still = MILL.replace("\"XYZ\"\n", "\"XYZ\"\nmode = \"quaternion\"\n");
    let (scene, warnings) = scene::read_with_warnings(still.as_bytes()).unwrap();
    assert!((tip(&scene, 1.0) - Vec3::X * 1.5).length() < 1e-6);
    let [warning] = warnings.as_slice() else {
        panic!("one warning: {warnings:?}");
    };
    assert_eq!((warning.kind, warning.location.line), (Kind::LostTurn, 19));
    let text = warning.in_file("mill.posekit.toml");
    assert!(
        text.starts_with(
            "mill.posekit.toml:19:21: track[0].keys[1].value: quaternions go 0.0 degrees"
        ),
        "{text}"
    );
}

#[test]
fn a_warning_is_for_what_is_lost_alone() {
    let quaternion = MILL.replace("\"XYZ\"\n", "\"XYZ\"\nmode = \"quaternion\"\n");
    let warnings = |turn: &str| {
        let text = quaternion.replace("360", turn);
        scene::read_with_warnings(text.as_bytes()).unwrap().1.len()
    };
    let lost = ["181", "-181", "270", "360", "450", "540", "720", "-1000"];
    assert_eq!(lost.map(warnings), [1; 8]);
    assert_eq!(["0", "90", "180", "-180", "179.9"].map(warnings), [0; 5]);
    let (_, none) = scene::read_with_warnings(MILL.as_bytes()).unwrap();
    assert!(none.is_empty(), "curves hold all of it");
}

#[test]
fn a_slope_of_four_numbers_keeps_a_track_of_version_1_in_quaternions() {
    assert!(matches!(
        nod().tracks[1].values,
        JointValues::Rotation { .. }
    ));
    let newer = NOD.replace("version = 1", "version = 2");
    let error = scene::read(newer.as_bytes()).unwrap_err();
    assert!(error.to_string().contains("degrees per second"), "{error}");
    let said = newer.replace("\"ZXY\"\n", "\"ZXY\"\nmode = \"quaternion\"\n");
    assert_eq!(scene::read(said.as_bytes()).unwrap(), nod());
}

#[test]
fn handles_are_read_written_and_refused() {
    let handles =
        "handle_in = [[-0.1, 0], [0, -2], [-1, 0.5]], handle_out = [[0.1, 0], [0, 2], [9, -4.5]]";
    let text = MILL.replacen("curve = \"linear\"", handles, 1);
    let scene = scene::read(text.as_bytes()).unwrap();
    let JointValues::EulerRotation(curves) = &scene.tracks[0].values else {
        panic!("Euler curves");
    };
    let expected = Tangents::Handles {
        incoming: Handle {
            secs: DVec3::new(0.1, 0.0, 1.0),
            value: DVec3::new(0.0, -2.0, 0.5),
        },
        outgoing: Handle {
            secs: DVec3::new(0.1, 0.0, 9.0),
            value: DVec3::new(0.0, 2.0, -4.5),
        },
        pair: HandlePair::Aligned,
    };
    assert_eq!(curves.angles_deg().keys()[0].tangents, expected);
    let written = String::from_utf8(scene::write(&scene).unwrap()).unwrap();
    assert!(written.contains("version = 2\n"), "{written}");
    assert!(written.contains("euler_deg = \"XYZ\"\nkeys"), "{written}");
    assert_eq!(scene::read(written.as_bytes()).unwrap(), scene);
    let refused = |keys: &str, says: &str| {
        let text = MILL.replacen("curve = \"linear\"", keys, 1);
        let error = scene::read(text.as_bytes()).expect_err(keys);
        assert!(error.to_string().contains(says), "{error}");
    };
    refused(
        "handle_in = [[0, 0], [0, 0], [0, 0]]",
        "both of `handle_in`",
    );
    refused(
        "handle_in = [0, 0, 0], handle_out = [0, 0, 0]",
        "three handles",
    );
    refused(&format!("{handles}, slope = \"flat\""), "not both");
    refused(&handles.replace("-0.1", "0.1"), "less than 0 s");
    refused(&format!("{handles}, handles = \"bent\""), "\"broken\"");
    refused("slope = [0, 0, 0, 1]", "degrees per second");
}

#[test]
fn modes_that_make_no_sense_are_refused() {
    let refused = |text: &str, says: &str| {
        let error = scene::read(text.as_bytes()).expect_err(says);
        assert!(error.to_string().contains(says), "{error}");
    };
    refused(
        &MILL.replace("\"XYZ\"\n", "\"XYZ\"\nmode = \"slerp\"\n"),
        "\"quaternion\"",
    );
    let plain = MILL
        .replace("euler_deg = \"XYZ\"\n", "mode = \"euler\"\n")
        .replace("[0, 0, 0], c", "[0, 0, 0, 1], c")
        .replace("[0, 0, 360]", "[0, 0, 0, 1]");
    refused(&plain, "`euler_deg`");
    let quaternions = plain.replace("\"euler\"", "\"quaternion\"");
    assert!(scene::read(quaternions.as_bytes()).is_ok());
    refused(
        &quaternions.replacen(
            "curve = \"linear\"",
            "handle_in = [0, 0], handle_out = [0, 0]",
            1,
        ),
        "quaternions have no handles",
    );
    let moved = NOD.replace(
        "property = \"translation\"",
        "property = \"translation\"\nmode = \"euler\"",
    );
    refused(&moved, "no mode of rotation");
}

#[test]
fn an_animation_keeps_its_modes_in_a_scene() {
    let mill = scene::read(MILL.as_bytes()).unwrap();
    let skeleton = Arc::new(mill.skeleton.inline_skeleton().unwrap().unwrap());
    let animation = mill.animation(&skeleton).unwrap();
    let mut same = mill.clone();
    same.set_animation(&animation, None);
    assert_eq!(same, mill);
    let mut new = Scene::new(mill.skeleton.clone());
    new.set_animation(&animation, None);
    assert_eq!(new.tracks, mill.tracks);
    // A joint whose mode was changed: written in the order that it had.
    let key = Keyframe::new(0.0, glam::DQuat::from_rotation_z(0.5), Interpolation::Cubic);
    let track = Track::new(vec![key], Extrapolation::Hold).unwrap();
    let sails = skeleton.find("Sails").unwrap();
    same.set_animation(&animation.with_rotation(sails, Some(track)), None);
    let text = String::from_utf8(scene::write(&same).unwrap()).unwrap();
    assert!(
        text.contains("euler_deg = \"XYZ\"\nmode = \"quaternion\"\n"),
        "{text}"
    );
}
