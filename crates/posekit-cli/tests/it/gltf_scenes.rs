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
        known.contains("there is no animation `walk`; there is `all kinds`"),
        "{known}"
    );
    assert!(error("rig.gltf#", "gone.glb#").contains("gone.glb"));
    folder.write("broken.glb", "glTF\u{1}\0\0\0");
    let broken = error("rig.gltf\" }", "broken.glb\" }");
    assert!(broken.contains("version 1"), "{broken}");
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
