//! Scene files whose skeleton and motions come from glTF files.

use std::path::Path;

use crate::harness::{Folder, real_data};

const SCENE: &str = r#"format = "posekit scene"
version = 1
range_secs = [0, 1.5]
frames_per_sec = 10
skeleton = { file = "rig.gltf" }

[[motion]]
file = "rig.gltf#all kinds"
"#;

fn golden() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../posekit-formats/tests/golden")
}

fn folder() -> Folder {
    let folder = Folder::with_arm();
    let rig = std::fs::read(golden().join("spline.gltf")).unwrap();
    folder.write("rig.gltf", rig);
    folder.write("rig.posekit.toml", SCENE);
    folder
}

#[test]
fn a_gltf_animation_plays_in_a_scene() {
    let folder = folder();
    let text = folder.succeed(&["info", "--tree", "rig.posekit.toml"]);
    assert!(
        text.contains("16 at 10 fps") && text.contains("between"),
        "{text}"
    );
    let text = folder.succeed(&["keys", "print", "rig.posekit.toml"]);
    assert!(text.contains("0 keys on 0 tracks"), "{text}");
    folder.succeed(&["fk", "rig.posekit.toml", "-o", "at.csv", "--joints", "tip"]);
    let text = folder.read("at.csv");
    // At 0.4 s a key is reached, so that sampling the animation at its own rate does not blur it. NumPy's place of
    // the joint (`make_gltf_poses.py`).
    let golden = std::fs::read_to_string(golden().join("gltf_poses.json")).unwrap();
    let golden: serde_json::Value = serde_json::from_str(&golden).unwrap();
    let samples = golden["spline.gltf"]["samples"].as_array().unwrap();
    let at_key = samples
        .iter()
        .find(|sample| sample["time_secs"] == 0.4)
        .unwrap();
    let wanted = at_key["positions"]["tip"].as_array().unwrap();
    let row = text.lines().nth(5).unwrap();
    let row: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
    let place = &row[2..5];
    for (ours, wanted) in place.iter().zip(wanted) {
        let wanted = wanted.as_f64().unwrap();
        assert!((ours - wanted).abs() < 1e-4, "{place:?} {at_key}");
    }
    let picture = [
        "-o",
        "rig.png",
        "--renderer",
        "cpu",
        "--size",
        "64x48",
        "--frames",
        "4",
    ];
    folder.succeed(&[&["render", "rig.posekit.toml"], &picture[..]].concat());
}

#[test]
fn what_a_gltf_file_has_not_is_told() {
    let folder = folder();
    let error = |from: &str, to: &str| {
        folder.write("bad.posekit.toml", SCENE.replace(from, to));
        folder.fail(1, &["info", "bad.posekit.toml"])
    };
    let known = error("#all kinds", "#walk");
    assert!(
        known
            .contains("rig.gltf#walk: animations: expected an animation `walk`, found `all kinds`"),
        "{known}"
    );
    assert!(error("rig.gltf#", "gone.glb#").contains("gone.glb"));
    folder.write("broken.glb", "glTF\u{1}\0\0\0");
    let broken = error("rig.gltf\" }", "broken.glb\" }");
    assert!(broken.contains("version 1"), "{broken}");
}

/// The scene of one of the small inputs of `../shared/cases`, with its files.
fn case(folder: &Folder, name: &str) -> Option<String> {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases");
    for ending in ["gltf", "posekit.toml"] {
        let file = format!("{name}.{ending}");
        let Ok(bytes) = std::fs::read(cases.join(&file)) else {
            eprintln!("skipped: {file} is not there");
            return None;
        };
        folder.write(&file, bytes);
    }
    Some(format!("{name}.posekit.toml"))
}

/// Where a joint is in a frame of a scene, and what was said on standard error.
fn place(folder: &Folder, scene: &str, joint: &str, frame: usize) -> ([f64; 3], String) {
    let ran = folder.run(&["fk", scene, "-o", "at.csv", "--joints", joint]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let text = folder.read("at.csv");
    let row = text.lines().nth(frame + 1).unwrap();
    let row: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
    ([row[2], row[3], row[4]], ran.stderr)
}

fn assert_at(found: [f64; 3], wanted: [f64; 3]) {
    let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-4, "{found:?} {wanted:?}");
}

/// The places are NumPy's (`make_gltf_poses.py`), at the scenes' four frames a second.
#[test]
fn scenes_sample_the_curves_of_gltf_files() {
    let golden = std::fs::read_to_string(golden().join("gltf_poses.json")).unwrap();
    let golden: serde_json::Value = serde_json::from_str(&golden).unwrap();
    let folder = Folder::with_arm();
    // Case, joint, and frames with the times of the golden samples; `Late` is not what step_keys plays first.
    for (name, joint, frames) in [
        (
            "cubic_rotation",
            "Ball",
            &[(0, 0.0), (2, 0.5), (4, 1.0)][..],
        ),
        (
            "cubic_sign",
            "Ball",
            &[(0, 0.0), (1, 0.25), (2, 0.5), (4, 1.0)],
        ),
        ("mirror_scale", "TipR", &[(0, 0.0), (2, 0.5), (4, 1.0)]),
        (
            "mixamo_like",
            "mixamorig:LeftLeg",
            &[(0, 0.0), (1, 0.25), (4, 1.0)],
        ),
        ("step_keys", "Ball", &[(0, 0.0), (1, 0.25)]),
    ] {
        let Some(scene) = case(&folder, name) else {
            return;
        };
        let samples = golden[format!("{name}.gltf")]["samples"]
            .as_array()
            .unwrap();
        for &(frame, time) in frames {
            let at_time = |sample: &&serde_json::Value| sample["time_secs"] == time;
            let sample = samples.iter().find(at_time).unwrap();
            let wanted = &sample["positions"][joint];
            let wanted = [0, 1, 2].map(|axis| wanted[axis].as_f64().unwrap());
            assert_at(place(&folder, &scene, joint, frame).0, wanted);
        }
    }
    assert_at(
        place(&folder, "cubic_sign.posekit.toml", "Ball", 2).0,
        [-1.0, -0.732_051, 0.0],
    );
    let text = folder.read("step_keys.posekit.toml");
    let late = "[[motion]]\nfile = \"step_keys.gltf#Late\"";
    folder.write(
        "late.posekit.toml",
        text.replace("[[motion]]\nfile = \"step_keys.gltf\"", late),
    );
    assert_at(
        place(&folder, "late.posekit.toml", "Ball", 0).0,
        [2.0, 1.0, 0.0],
    );
    assert_at(
        place(&folder, "late.posekit.toml", "Ball", 4).0,
        [0.0, 3.0, 0.0],
    );
    let told = folder.succeed(&["info", "late.posekit.toml"]);
    assert!(
        told.contains("note, step_keys.gltf: animations[1]: "),
        "{told}"
    );
    assert!(
        told.contains("is at 2.0000 s; it starts there [late-first-key]"),
        "{told}"
    );
}

#[test]
fn what_the_reader_of_a_named_file_noticed_reaches_every_command() {
    let folder = folder();
    let text = std::fs::read_to_string(golden().join("spline.gltf")).unwrap();
    let (start, _) = text.split_once("\"data:").unwrap();
    let (_, end) = text
        .split_once("\"data:")
        .unwrap()
        .1
        .split_once('"')
        .unwrap();
    folder.write("rig.gltf", format!("{start}\"gone.bin\"{end}"));
    let told = "rig.gltf: buffers[0]: buffer 0 (`gone.bin`) is missing; its contents were left out";
    let info = folder.succeed(&["info", "rig.posekit.toml"]);
    assert!(
        info.contains(&format!("warning, {told} [missing-buffer]")),
        "{info}"
    );
    let check = folder.succeed(&["check", "rig.posekit.toml"]);
    assert!(
        check.contains("missing-buffer") && check.contains("rig.gltf, buffers[0]"),
        "{check}"
    );
    assert!(
        !check.contains("posekit fix"),
        "it cannot mend another file: {check}"
    );
    folder.fail(
        1,
        &["check", "rig.posekit.toml", "--deny", "missing-buffer"],
    );
    let warning = format!("rig.posekit.toml: {told} [missing-buffer]");
    let render = [
        "render",
        "rig.posekit.toml",
        "--renderer",
        "cpu",
        "--size",
        "16x16",
        "-o",
        "a.png",
    ];
    for args in [
        &["fk", "rig.posekit.toml", "-o", "a.csv"][..],
        &["keys", "bake", "rig.posekit.toml", "-o", "a.bvh"],
        &["convert", "rig.posekit.toml", "-o", "b.bvh"],
        &render,
    ] {
        let ran = folder.run(args);
        assert_eq!(ran.code, Some(0), "{args:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(&warning), "{args:?}: {}", ran.stderr);
        let strict = [args, &["--strict"]].concat();
        assert!(
            folder.fail(1, &strict).contains("missing-buffer"),
            "{args:?}"
        );
    }
    let json = folder.succeed(&["check", "--json", "rig.posekit.toml"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let found = json["findings"].as_array().unwrap();
    let found = found
        .iter()
        .find(|finding| finding["code"] == "missing-buffer")
        .unwrap();
    assert_eq!(found["file"], "rig.gltf");
    assert_eq!(found["place"], "buffers[0]");
    assert!(found["line"].is_null());
}

#[test]
fn the_reader_of_a_named_bvh_file_is_heard_too() {
    let folder = Folder::with_arm();
    folder.write(
        "short.bvh",
        folder.read("arm.bvh").replace("Frames: 3", "Frames: 2"),
    );
    let scene = "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 1]\nskeleton = { file = \"short.bvh\" }\n";
    folder.write("s.posekit.toml", scene);
    let info = folder.succeed(&["info", "s.posekit.toml"]);
    assert!(info.contains("warning, short.bvh:17:"), "{info}");
    assert!(info.contains("[frame-count-mismatch]"), "{info}");
}

#[test]
fn a_required_extension_is_refused_by_its_name() {
    let folder = folder();
    let text = std::fs::read_to_string(golden().join("spline.gltf")).unwrap();
    let asks = "{\"extensionsRequired\": [\"EXT_meshopt_compression\"],";
    folder.write("rig.gltf", text.replacen('{', asks, 1));
    let error = folder.fail(1, &["info", "rig.posekit.toml"]);
    assert!(error.contains("extensionsRequired[0]"), "{error}");
    assert!(error.contains("EXT_meshopt_compression"), "{error}");
}

#[test]
fn a_real_rig_plays_two_animations_one_after_the_other() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    let Ok(knight) = std::fs::read(data.join("rigs/knight.glb")) else {
        return;
    };
    folder.write("knight.glb", knight);
    let scene = r#"format = "posekit scene"
version = 1
range_secs = [0, 2]
skeleton = { file = "knight.glb" }
motion = [
  { file = "knight.glb#Walking_A" },
  { file = "knight.glb#1H_Melee_Attack_Chop", start_secs = 1 },
]
"#;
    folder.write("knight.posekit.toml", scene);
    let text = folder.succeed(&["info", "knight.posekit.toml"]);
    assert!(text.contains("61 at 30 fps"), "{text}");
    folder.succeed(&["keys", "bake", "knight.posekit.toml", "-o", "knight.bvh"]);
    assert!(folder.read("knight.bvh").contains("Frames: 61"));
}
