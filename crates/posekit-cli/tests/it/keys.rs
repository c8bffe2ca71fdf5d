//! `posekit keys`, `inbetween` and `slerp`, and scene files where motions go.

use std::path::Path;
use std::process::Command;

use crate::harness::{Folder, real_data};

const SCENE: &str = r#"format = "posekit scene"
version = 1
range_secs = [1, 2]
frames_per_sec = 10
skeleton = { file = "arm.bvh" }

[[track]]
joint = "elbow"
property = "rotation"
euler_deg = "ZXY"
keys = [
  { at = 1, value = [0, 0, 0], curve = "linear" },
  { at = 2, value = [90, 0, 0] },
]

[[camera]]
name = "close"
position = [0, 1, 9]
target = [0, 1, 0]
vertical_fov_deg = { keys = [{ at = 1, value = 20, curve = "linear" }, { at = 2, value = 60 }] }
"#;

/// The arm's elbow from 0 to some degrees in a second, about Z.
fn spin(folder: &Folder, degrees: &str, mode: &str) {
    let scene = SCENE
        .replace("value = [90, 0, 0]", &format!("value = [{degrees}, 0, 0]"))
        .replace("\"ZXY\"\n", &format!("\"ZXY\"\n{mode}"));
    folder.write("spin.posekit.toml", scene);
}

#[test]
fn euler_keys_turn_as_far_as_they_say_when_baked_and_posed() {
    let folder = Folder::with_arm();
    for (degrees, at_a_quarter) in [("360", 90.0), ("270", 67.5), ("720", 180.0)] {
        spin(&folder, degrees, "");
        folder.succeed(&[
            "keys",
            "bake",
            "spin.posekit.toml",
            "-o",
            "out.bvh",
            "--fps",
            "4",
        ]);
        let text = folder.read("out.bvh");
        let frames: Vec<&str> = text.lines().rev().take(5).collect();
        let numbers: Vec<f64> = frames[3]
            .split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect();
        let z = numbers[numbers.len() - 3];
        let off = (z - at_a_quarter + 180.0_f64).rem_euclid(360.0) - 180.0;
        assert!(off.abs() < 1e-3, "{degrees}: {z}");
        let fk = folder.run(&["fk", "spin.posekit.toml", "-o", "out.csv"]);
        assert_eq!((fk.code, fk.stderr.contains("warning")), (Some(0), false));
    }
}

#[test]
fn a_turn_that_quaternions_lose_is_told_with_its_place() {
    let folder = Folder::with_arm();
    spin(&folder, "270", "mode = \"quaternion\"\n");
    let commands: [&[&str]; 3] = [
        &["keys", "bake", "spin.posekit.toml", "-o", "out.bvh"],
        &["fk", "spin.posekit.toml", "-o", "out.csv"],
        &["convert", "spin.posekit.toml", "other.bvh"],
    ];
    for args in commands {
        let ran = folder.run(args);
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        let place =
            "warning: spin.posekit.toml:14:21: track[0].keys[1].value: quaternions go 90.0 degrees";
        assert!(ran.stderr.contains(place), "{args:?}: {}", ran.stderr);
        assert_eq!(
            ran.stderr.matches("quaternions go").count(),
            1,
            "once: {}",
            ran.stderr
        );
    }
    spin(&folder, "90", "mode = \"quaternion\"\n");
    let ran = folder.run(commands[0]);
    assert!(!ran.stderr.contains("warning"), "{}", ran.stderr);
}

fn folder() -> Folder {
    let folder = Folder::with_arm();
    folder.write("bend.posekit.toml", SCENE);
    folder
}

#[test]
fn keys_are_listed_and_baked() {
    let folder = folder();
    let text = folder.succeed(&["keys", "print", "bend.posekit.toml"]);
    assert!(
        text.contains("4 keys on 2 tracks, 1 s to 2 s at 10 frames a second"),
        "{text}"
    );
    assert!(
        text.contains("elbow") && text.contains("camera close"),
        "{text}"
    );
    let csv = folder.succeed(&["keys", "print", "bend.posekit.toml", "--csv"]);
    assert!(
        csv.contains("\"elbow\",rotation ZXY deg,1,linear,0,0,0"),
        "{csv}"
    );
    folder.succeed(&["keys", "bake", "bend.posekit.toml", "-o", "out.bvh"]);
    let text = folder.read("out.bvh");
    assert!(
        text.contains("Frames: 11") && text.contains("Frame Time: 0.1"),
        "{text}"
    );
    let last = text.lines().last().unwrap();
    assert!(last.ends_with("90 0 0"), "{last}");
    folder.succeed(&[
        "keys",
        "bake",
        "bend.posekit.toml",
        "-o",
        "slow.bvh",
        "--fps",
        "2",
    ]);
    assert!(folder.read("slow.bvh").contains("Frames: 3"));
    let error = folder.fail(
        2,
        &[
            "keys",
            "bake",
            "bend.posekit.toml",
            "-o",
            "x.bvh",
            "--fps",
            "0",
        ],
    );
    assert!(error.contains("--fps"), "{error}");
}

#[test]
fn scenes_go_wherever_motions_go() {
    let folder = folder();
    let text = folder.succeed(&["info", "bend.posekit.toml"]);
    assert!(text.contains("11 at 10 fps"), "{text}");
    folder.succeed(&["fk", "bend.posekit.toml", "-o", "places.csv"]);
    assert!(folder.read("places.csv").lines().count() > 11);
    folder.succeed(&["convert", "bend.posekit.toml", "half.bvh", "--fps", "5"]);
    assert!(folder.read("half.bvh").contains("Frames: 6"));
}

#[test]
fn a_scenes_camera_takes_the_picture() {
    let folder = folder();
    let render = |out: &str, more: &[&str]| {
        let mut args = vec![
            "render",
            "bend.posekit.toml",
            "-o",
            out,
            "--renderer",
            "cpu",
        ];
        args.extend(["--size", "64x48"]);
        args.extend(more);
        folder.succeed(&args);
        std::fs::read(folder.path().join(out)).unwrap()
    };
    let first = render("first.png", &["--frames", "0"]);
    let last = render("last.png", &["--frames", "10"]);
    let framed = render(
        "framed.png",
        &["--frames", "0", "--camera", "three-quarter"],
    );
    assert_ne!(first, last, "the lens widens");
    assert_ne!(first, framed, "--camera goes before the scene's own");
}

#[test]
fn scenes_that_do_not_work_say_where() {
    let folder = folder();
    let error = |name: &str, text: &str| {
        folder.write(name, text);
        folder.fail(1, &["info", name])
    };
    let newer = error(
        "newer.posekit.toml",
        &SCENE.replace("version = 1", "version = 3"),
    );
    assert!(
        newer.contains("newer.posekit.toml:2:11: version: "),
        "{newer}"
    );
    assert!(newer.contains("a newer posekit can open it"), "{newer}");
    let typo = error("typo.posekit.toml", &SCENE.replace("curve", "curv"));
    assert!(typo.contains("typo.posekit.toml:12:"), "{typo}");
    let gone = error("gone.posekit.toml", &SCENE.replace("arm.bvh", "leg.bvh"));
    assert!(gone.contains("leg.bvh: no such file"), "{gone}");
    let joint = error(
        "joint.posekit.toml",
        &SCENE.replace("\"elbow\"", "\"knee\""),
    );
    assert!(joint.contains("no joint 'knee'"), "{joint}");
}

#[test]
fn a_reduced_motion_bakes_back_within_the_error() {
    let folder = folder();
    let note = folder.run(&["keys", "reduce", "sample:walk", "-o", "walk.posekit.toml"]);
    assert_eq!(note.code, Some(0), "{}", note.stderr);
    assert!(
        note.stderr.contains("keys") && note.stderr.contains('%'),
        "{}",
        note.stderr
    );
    folder.succeed(&["keys", "bake", "walk.posekit.toml", "-o", "again.bvh"]);
    folder.succeed(&["sample", "walk", "-o", "walk.bvh"]);
    let [a, b] = ["walk.bvh", "again.bvh"].map(|name| {
        let text = folder.succeed(&["fk", name, "-o", "-", "--format", "json"]);
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        numbers(&value["positions"])
    });
    assert_eq!(a.len(), b.len());
    let apart = a
        .iter()
        .zip(&b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(apart < 0.01 * 1.75, "{apart} m");
    let error = folder.fail(
        1,
        &["keys", "reduce", "sample:walk", "-o", "-", "--angle", "0"],
    );
    assert!(error.contains("at least 0.001"), "{error}");
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    match value {
        serde_json::Value::Array(items) => items.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().unwrap()],
    }
}

#[test]
fn in_betweens_are_compared_and_written() {
    let folder = folder();
    let args = [
        "inbetween",
        "sample:walk",
        "--keep",
        "10",
        "--method",
        "slerp,euler,squad",
    ];
    let text = folder.succeed(&args);
    assert!(
        text.contains("28 of 262 frames kept") || text.contains("frames kept"),
        "{text}"
    );
    let mut with_report = args.to_vec();
    with_report.extend(["--report=out/walk10", "-o", "filled.bvh"]);
    folder.succeed(&with_report);
    let html = folder.read("out/walk10.html");
    assert!(html.starts_with("<!doctype html>") && html.contains("<svg") && !html.contains("http"));
    assert!(folder.read("out/walk10.md").contains("| squad |"));
    let csv = folder.read("out/walk10.csv");
    assert!(csv.lines().count() > 60, "{csv}");
    assert!(folder.read("filled.bvh").starts_with("HIERARCHY"));
    folder.succeed(&[
        "inbetween",
        "sample:walk",
        "--at",
        "0,20,40",
        "--frames",
        "50",
        "-o",
        "slow.bvh",
    ]);
    assert!(folder.read("slow.bvh").contains("Frames: 101"));
    folder.fail(2, &["inbetween", "sample:walk"]);
    folder.fail(2, &["inbetween", "sample:walk", "--keep", "0"]);
    folder.fail(
        2,
        &[
            "inbetween",
            "sample:walk",
            "--keep",
            "5",
            "--method",
            "slurp",
        ],
    );
}

/// `tools/inbetween_reference.py`: every method written anew with NumPy and SciPy.
#[test]
fn in_betweens_are_those_of_scipy() {
    let has_scipy = Command::new("python3")
        .args(["-c", "import numpy, scipy"])
        .output();
    if !has_scipy.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: no python3 with NumPy and SciPy");
        return;
    }
    let folder = folder();
    folder.succeed(&["sample", "run", "-o", "run.bvh"]);
    let mut files = vec![folder.path().join("run.bvh")];
    if let Some(data) = real_data() {
        files.push(data.join("course/motion_walking.bvh"));
        files.push(data.join("cmu/cmu_12_01_walk.bvh"));
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tools/inbetween_reference.py");
    for file in files {
        let name = file.to_str().unwrap();
        folder.succeed(&[
            "inbetween",
            name,
            "--keep",
            "10",
            "--method",
            "slerp,nlerp,lerp,matrix,rotvec,euler,euler:ZYX,squad",
            "--report=compared",
        ]);
        let output = Command::new("python3")
            .arg(&script)
            .args([name, "compared.csv", "--keep", "10"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name}: {said}{errors}");
    }
}

#[test]
fn ways_between_orientations_are_tabled() {
    let folder = folder();
    let text = folder.succeed(&["slerp", "0,0,0", "90,45,0", "--steps", "4"]);
    for wanted in [
        "How far from slerp",
        "How fast it turns",
        "Determinant",
        "Shear",
        "euler:ZXY",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    let csv = folder.succeed(&[
        "slerp",
        "--preset",
        "half-turn",
        "--method",
        "matrix",
        "--csv",
    ]);
    let middle: Vec<&str> = csv.lines().nth(6).unwrap().split(',').collect();
    // Half-way through 179 degrees the determinant is cos(89.5 degrees)^2.
    let determinant: f64 = middle[8].parse().unwrap();
    assert!(
        (determinant - 89.5_f64.to_radians().cos().powi(2)).abs() < 1e-9,
        "{csv}"
    );
    folder.succeed(&[
        "slerp", "--preset", "gimbal", "--before", "0,0,-5", "--method", "squad",
    ]);
    folder.fail(2, &["slerp", "0,0,0"]);
    folder.fail(2, &["slerp", "0,0,0", "here"]);
    folder.fail(2, &["slerp", "--preset", "gimbal", "--order", "XYX2"]);
}

/// Lights and props of a scene are in its pictures, its cameras are chosen by name, and what cannot be
/// drawn is said.
#[test]
fn lights_props_and_cameras_of_a_scene_make_its_picture() {
    let folder = folder();
    let more = "\n[[camera]]\nname = \"top\"\nposition = [0, 9, 1]\ntarget = [0, 1, 0]\n";
    let light = "\n[[light]]\nname = \"red\"\ncolor = [1, 0, 0]\n";
    let prop = |shape: &str| {
        format!("\n[[prop]]\nname = \"thing\"\nshape = \"{shape}\"\ntranslation = [1, 1, 0]\n")
    };
    let picture = |text: String, more: &[&str]| {
        folder.write("set.posekit.toml", text);
        let mut args = vec!["render", "set.posekit.toml", "-o", "set.png"];
        args.extend(["--renderer", "cpu", "--size", "64x48"]);
        args.extend(more);
        let ran = folder.run(&args);
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        let bytes = std::fs::read(folder.path().join("set.png")).unwrap();
        (bytes, ran.stderr)
    };
    let scene = |parts: &[&str]| [&[SCENE, more], parts].concat().concat();
    let pictures = [
        picture(scene(&[]), &[]),
        picture(scene(&[light]), &[]),
        picture(scene(&[&prop("box")]), &[]),
        picture(scene(&[&prop("sphere")]), &[]),
        picture(scene(&[]), &["--camera", "top"]),
    ];
    for (a, (one, said)) in pictures.iter().enumerate() {
        assert!(!said.contains("warning"), "{said}");
        for (b, (other, _)) in pictures.iter().enumerate() {
            assert!(a == b || one != other, "{a} and {b} are the same picture");
        }
    }
    // `top` is a camera of the scene, and a view where it is not.
    let (named, _) = picture(SCENE.to_owned(), &["--camera", "top"]);
    assert_ne!(named, pictures[4].0);
    let (as_box, said) = picture(scene(&[&prop("chair.obj")]), &[]);
    assert_eq!(as_box, pictures[2].0);
    assert!(
        said.contains("prop 'thing'") && said.contains("chair.obj"),
        "{said}"
    );
    let error = folder.fail(
        2,
        &[
            "render",
            "set.posekit.toml",
            "-o",
            "x.png",
            "--camera",
            "moon",
        ],
    );
    assert!(error.contains("close, top"), "{error}");
}

#[test]
fn all_that_is_wrong_with_a_scene_is_said_a_line_each() {
    let folder = Folder::with_arm();
    let scene = SCENE
        .replace("property = \"rotation\"", "property = \"turn\"")
        .replace("position =", "place =")
        .replace("= 10", "= 0");
    folder.write("bad.posekit.toml", scene);
    let error = folder.fail(1, &["keys", "print", "bad.posekit.toml"]);
    let places: Vec<&str> = error
        .lines()
        .filter_map(|line| line.strip_prefix("error: bad.posekit.toml:"))
        .filter_map(|line| line.split(':').next())
        .collect();
    assert_eq!(places, ["4", "9", "18"], "{error}");
    let ran = folder.run(&["info", "--json", "bad.posekit.toml"]);
    let line: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
    let told = line["error"].as_str().unwrap();
    assert!(
        told.contains("frames_per_sec") && told.contains("unknown field `place`"),
        "{told}"
    );
}

#[test]
fn joints_that_a_skeleton_lacks_are_named_with_those_that_were_meant() {
    let folder = Folder::with_arm();
    folder.write("a.posekit.toml", SCENE.replace("\"elbow\"", "\"elbwo\""));
    assert_eq!(
        folder.fail(1, &["info", "a.posekit.toml"]),
        "error: a.posekit.toml: track[0].joint: the skeleton has no joint 'elbwo'; did you mean 'elbow'\n"
    );
    folder.write("b.posekit.toml", SCENE.replace("arm.bvh", "arn.bvh"));
    assert_eq!(
        folder.fail(1, &["info", "b.posekit.toml"]),
        "error: b.posekit.toml: arn.bvh: no such file\n"
    );
    folder.write("c.posekit.toml", SCENE.replace("arm.bvh", "sample:wlk"));
    let error = folder.fail(1, &["info", "c.posekit.toml"]);
    assert!(error.contains("the samples are walk, run"), "{error}");
}

#[test]
fn a_motion_that_moves_nothing_is_warned_of_unless_that_is_to_be_quiet() {
    let folder = Folder::with_arm();
    let scene = SCENE.replace(
        "[[track]]",
        "[[motion]]\nfile = \"sample:walk\"\n\n[[track]]",
    );
    folder.write("a.posekit.toml", scene);
    let ran = folder.run(&["info", "a.posekit.toml"]);
    let wanted = "warning: a.posekit.toml: motion[0], sample:walk: no joint of it has the name";
    assert!(ran.stderr.contains(wanted), "{}", ran.stderr);
    for args in [
        &["info", "a.posekit.toml", "--quiet"][..],
        &["fk", "a.posekit.toml", "-q"],
    ] {
        assert_eq!(folder.run(args).stderr, "");
    }
}

#[test]
fn a_scene_comes_from_standard_input_too() {
    let folder = Folder::with_arm();
    folder.write("a.posekit.toml", SCENE);
    let from_file = folder.succeed(&["keys", "print", "a.posekit.toml"]);
    let piped = folder.run_with_input(&["keys", "print", "-"], SCENE.as_bytes());
    assert!(piped.stderr.is_empty(), "{}", piped.stderr);
    let after_title = |text: &str| text.lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(after_title(&piped.stdout), after_title(&from_file));
    assert!(piped.stdout.starts_with("standard input\n"));
    folder.succeed(&["keys", "bake", "a.posekit.toml", "-o", "a.bvh"]);
    let baked = folder.run_with_input(&["keys", "bake", "-", "-o", "b.bvh"], SCENE.as_bytes());
    assert_eq!(
        folder.read("a.bvh"),
        folder.read("b.bvh"),
        "{}",
        baked.stderr
    );
    let info = folder.run_with_input(&["info", "-"], SCENE.as_bytes());
    assert!(
        info.stderr.contains("standard input: is a scene"),
        "{}",
        info.stderr
    );
}

#[test]
fn a_report_has_a_name_of_its_own_and_nothing_to_fill_in_is_no_comparison() {
    let folder = Folder::with_arm();
    folder.succeed(&[
        "inbetween",
        "sample:arm",
        "--keep",
        "30",
        "--report",
        "--method",
        "slerp",
    ]);
    assert!(folder.exists("arm-inbetween.html"));
    for args in [
        &["inbetween", "sample:arm", "--keep", "1"][..],
        &["inbetween", "sample:arm", "--at", "5"],
    ] {
        let error = folder.fail(2, args);
        assert!(error.contains("nothing to fill in"), "{error}");
    }
    let error = folder.fail(2, &["inbetween", "sample:arm"]);
    assert!(error.contains("--keep N, or --at FRAMES"), "{error}");
    let error = folder.fail(2, &["inbetween", "sample:arm", "--keep", "0"]);
    assert!(error.contains("from 1 on"), "{error}");
}
