//! Files that other people made.

use std::path::Path;

use posekit::motion::{Motion, PositionPolicy};
use posekit_formats::bvh;

use crate::harness::{Folder, REAL_FILES, real_data};
use crate::inside::assert_fits;

#[test]
fn every_real_file_is_described_posed_and_converted() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    for name in REAL_FILES.lines() {
        let bytes =
            std::fs::read(data.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        folder.write(&format!("data/{name}"), bytes);
    }
    let files = REAL_FILES.lines().count();
    let described = folder.succeed(&["info", "--json", "data"]);
    assert_eq!(described.lines().count(), files);
    folder.succeed(&["fk", "data", "-o", "arrays", "--frames", "0..20", "--quiet"]);
    folder.succeed(&["convert", "data", "again", "--quiet"]);
    for name in REAL_FILES.lines() {
        let arrays = format!("arrays/{}", name.replace(".bvh", ".npz"));
        assert!(folder.exists(&arrays), "{arrays}");
        assert!(folder.exists(&format!("again/{name}")), "again/{name}");
    }
}

#[test]
fn conversions_leave_the_joints_of_a_real_file_where_they_were() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    for name in [
        "bandai/dataset-1_kick_normal_001.bvh",
        "course/motion_walking.bvh",
    ] {
        let original = data.join(name);
        let original = original.to_str().unwrap();
        let csv = |file: &str| -> Vec<f64> {
            let text = folder.succeed(&["fk", file, "-o", "-", "--format", "csv"]);
            let rows = text.lines().skip(1);
            // Positions alone: an orientation and its opposite are the same.
            let cells = rows.flat_map(|row| row.split(',').skip(2).enumerate());
            cells
                .filter(|(at, _)| at % 7 < 3)
                .map(|(_, cell)| cell.parse().unwrap())
                .collect()
        };
        let before = csv(original);
        let largest = before
            .iter()
            .fold(0.0f64, |most, value| most.max(value.abs()));
        for change in [["--order", "XYZ"], ["--channels", "3"], ["--channels", "6"]] {
            folder.succeed(&[
                "convert",
                original,
                "changed.bvh",
                change[0],
                change[1],
                "--quiet",
            ]);
            let after = csv("changed.bvh");
            assert_eq!(before.len(), after.len());
            let gap = before
                .iter()
                .zip(&after)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(
                gap < 1e-5 * largest,
                "{name} {change:?}: {gap} of {largest}"
            );
        }
    }
}

/// The first file of every skeleton of `../shared` that is a person's.
const PEOPLE: [&str; 12] = [
    "data/bandai/dataset-1_run_normal_001.bvh",
    "data/bandai/dataset-1_dance-short_normal_001.bvh",
    "data/bandai/dataset-2_walk-turn-left_normal_001.bvh",
    "data/cmu/01_01.bvh",
    "data/cmu/cmu_12_01_walk.bvh",
    "data/course/motion_walking.bvh",
    "data/course/push.bvh",
    "data/games105/walk_and_turn_left.bvh",
    "more/games105/mixamo_names.bvh",
    "more/games105/walk_forward.bvh",
    "more/makehuman/walk1.bvh",
    "cases/ape.bvh",
];

fn motion_of(path: &Path) -> Motion {
    let bytes = std::fs::read(path).unwrap();
    let import = bvh::read(&bytes).unwrap();
    import.document.to_motion(PositionPolicy::Replace).unwrap()
}

#[test]
fn bones_of_real_people_lie_inside_their_parts() {
    let Some(data) = real_data() else { return };
    let shared = data.parent().unwrap();
    for name in PEOPLE {
        let path = shared.join(name);
        if !path.exists() {
            println!("skipped: no {}", path.display());
            continue;
        }
        assert_fits(name, &motion_of(&path));
    }
}

/// `lAnkle` is never below +0.0416, `lToeJoint_end` goes to -0.0627 (forward kinematics in NumPy).
#[test]
fn the_joint_below_the_floor_is_named() {
    let Some(data) = real_data() else { return };
    let path = data.join("games105/walk_and_turn_left.bvh");
    let folder = Folder::with_arm();
    let text = folder
        .run(&["check", "--json", path.to_str().unwrap()])
        .stdout;
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let findings = report["findings"].as_array().unwrap().iter();
    let dips: Vec<_> = findings
        .filter(|finding| finding["code"] == "foot-below-floor")
        .collect();
    assert!(!dips.is_empty());
    for dip in dips {
        let name = dip["joints"][0].as_str().unwrap();
        assert!(name.ends_with("ToeJoint_end"), "{dip}");
    }
}
