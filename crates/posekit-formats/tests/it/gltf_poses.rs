//! The joints of glTF files stand where NumPy puts them (`tests/golden/make_gltf_poses.py`): whole matrices with
//! all scales multiplied down from the scene's roots, and samplers read as the specification's appendix C says.

use std::path::{Path, PathBuf};

use glam::DVec3;
use posekit::pose::{GlobalPose, LocalPose};
use posekit_formats::gltf::{self, Gltf};
use serde_json::Value;

/// Of the rest pose's height: the references are rounded to a millionth of a metre, and poses are `f32`.
const TOLERANCE_HEIGHTS: f32 = 1e-5;

/// As that, where scales that are off by rounding are animated, too: they are left out.
const ANIMATED_TOLERANCE_HEIGHTS: f32 = 1e-4;

fn golden() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn shared(folder: &str) -> PathBuf {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    shared.join(folder)
}

fn rigs() -> PathBuf {
    shared("data/rigs")
}

fn check(file: &str, document: &Gltf, pose: &GlobalPose, wanted: &Value, tolerance: f32) {
    let skeleton = &document.skeleton;
    let wanted = wanted.as_object().unwrap();
    for (name, position) in wanted {
        let joint = skeleton
            .find(name)
            .unwrap_or_else(|| panic!("{file} has {name}"));
        let number = |axis: usize| position[axis].as_f64().unwrap();
        let there = DVec3::new(number(0), number(1), number(2)).as_vec3();
        let off = there.distance(pose.positions[joint.index()]) / skeleton.height();
        assert!(off < tolerance, "{file}: {name} is off by {off} heights");
    }
}

#[test]
fn joints_are_where_numpy_puts_them() {
    let text = std::fs::read_to_string(golden().join("gltf_poses.json")).unwrap();
    let wanted: Value = serde_json::from_str(&text).unwrap();
    for (file, poses) in wanted.as_object().unwrap() {
        let folder = match file.as_str() {
            "spline.gltf" | "sparse.gltf" => golden(),
            _ if file.ends_with(".gltf") => shared("cases"),
            _ => rigs(),
        };
        let Ok(bytes) = std::fs::read(folder.join(file)) else {
            eprintln!("skipped: {file} is not there");
            continue;
        };
        let import = gltf::read(&bytes).unwrap();
        let repair = import.report.first_repair();
        assert!(repair.is_none(), "{file}: {repair:?}");
        let document = import.document;
        let rest = LocalPose::rest(&document.skeleton).to_global(&document.skeleton);
        check(file, &document, &rest, &poses["rest"], TOLERANCE_HEIGHTS);
        for sample in poses["samples"].as_array().unwrap() {
            let name = sample["animation"].as_str().unwrap();
            let animation = document.animation(name).unwrap();
            let pose = animation
                .tracks
                .sample(sample["time_secs"].as_f64().unwrap());
            let pose = pose.to_global(&document.skeleton);
            let wanted = &sample["positions"];
            check(file, &document, &pose, wanted, ANIMATED_TOLERANCE_HEIGHTS);
        }
    }
}

#[test]
fn nodes_between_joints_are_joints_and_those_above_are_not() {
    let bytes = std::fs::read(golden().join("spline.gltf")).unwrap();
    let import = gltf::read(&bytes).unwrap();
    let skeleton = import.document.skeleton;
    let names: Vec<&str> = skeleton
        .joints()
        .map(|joint| skeleton.name(joint))
        .collect();
    assert_eq!(names, ["hip", "upper", "fore", "between", "tip"]);
    let parents: Vec<_> = skeleton
        .parents()
        .iter()
        .map(|p| p.map(|p| p.index()))
        .collect();
    assert_eq!(parents, [None, Some(0), Some(1), Some(2), Some(3)]);
}

#[test]
fn an_animation_is_baked_from_zero_to_its_last_key_at_the_rate_of_its_keys() {
    let bytes = std::fs::read(golden().join("spline.gltf")).unwrap();
    let document = gltf::read(&bytes).unwrap().document;
    let animation = &document.animations[0];
    assert_eq!(animation.frames_per_sec(), 30.0);
    let motion = animation.bake(20.0).unwrap();
    assert_eq!(motion.frame_count(), 31);
    for frame in [0, 7, 30] {
        let wanted = animation.tracks.sample(frame as f64 / 20.0);
        assert_eq!(motion.pose(frame).rotations, wanted.rotations);
    }
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e12] {
        assert!(animation.bake(rate).is_err(), "{rate}");
    }
}

#[test]
fn an_animation_starts_with_its_first_key() {
    let bytes = std::fs::read(golden().join("sparse.gltf")).unwrap();
    let import = gltf::read(&bytes).unwrap();
    let told: Vec<_> = import
        .report
        .warnings
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        told,
        [
            "animations[0]: the first key of `sparse` is at 0.0417 s; it starts there [late-first-key]"
        ]
    );
    let animation = &import.document.animations[0];
    assert_eq!(animation.frames_per_sec(), 24.0);
    let motion = animation.bake(24.0).unwrap();
    assert_eq!(motion.frame_count(), 5);
    let wanted = animation.tracks.sample(3.0 / 24.0);
    let found = motion.pose(2);
    for (found, wanted) in found.rotations.iter().zip(&wanted.rotations) {
        assert!(found.dot(*wanted).abs() > 0.999_999_9, "{found} {wanted}");
    }
}

#[test]
fn animations_are_chosen_by_name() {
    let bytes = std::fs::read(golden().join("spline.gltf")).unwrap();
    let document = gltf::read(&bytes).unwrap().document;
    let first = document.motion(None).unwrap();
    assert_eq!(first.frame_count(), 46);
    let named = document.motion(Some("all kinds")).unwrap();
    assert_eq!(named.pose(20), first.pose(20));
    let error = document.motion(Some("walk")).unwrap_err().to_string();
    assert_eq!(error, "there is no animation `walk`; there is `all kinds`");
    let still = Gltf {
        animations: Vec::new(),
        ..document
    };
    assert_eq!(still.motion(None).unwrap().frame_count(), 1);
    assert_eq!(
        gltf::file_and_animation("a/k.glb#Walk #2"),
        ("a/k.glb", Some("Walk #2"))
    );
    assert_eq!(
        gltf::file_and_animation("take #3.bvh"),
        ("take #3.bvh", None)
    );
    assert!(
        gltf::is_gltf_name("A.GLB") && gltf::is_gltf_name("b.gltf") && !gltf::is_gltf_name("glb")
    );
}

#[test]
fn every_real_animation_is_read_whole() {
    for (file, count, joints) in [("knight.glb", 76, 41), ("fox-animations.glb", 14, 49)] {
        let Ok(bytes) = std::fs::read(rigs().join(file)) else {
            eprintln!("skipped: {file} is not there");
            continue;
        };
        let document = gltf::read(&bytes).unwrap().document;
        assert_eq!(document.skeleton.joint_count(), joints);
        assert_eq!(document.animations.len(), count);
        for animation in &document.animations {
            let motion = animation.bake(animation.frames_per_sec()).unwrap();
            assert!(motion.frame_count() > 0, "{}", animation.name);
            let moved = animation.tracks.rotations().count();
            assert!(moved > 0, "{} turns nothing", animation.name);
        }
    }
}
