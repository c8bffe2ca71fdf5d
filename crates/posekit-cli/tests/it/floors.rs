//! Arrows never run up: each crate uses only the floors below it, and the ground floor only what is on
//! its list. `ARCHITECTURE.md` has the drawing.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// What each of our crates may stand on, its own name first.
const FLOORS: &[(&str, &[&str])] = &[
    ("posekit", &[]),
    ("posekit-formats", &["posekit"]),
    ("posekit-rig", &["posekit"]),
    ("posekit-render", &["posekit"]),
    (
        "posekit-viewer",
        &[
            "posekit",
            "posekit-formats",
            "posekit-rig",
            "posekit-render",
        ],
    ),
    (
        "posekit-cli",
        &[
            "posekit",
            "posekit-formats",
            "posekit-rig",
            "posekit-render",
            "posekit-viewer",
        ],
    ),
    // Build tasks of the project itself; nothing stands on it and it stands on nothing of ours.
    ("xtask", &[]),
];

/// Everything the library may import from elsewhere.
const GROUND_FLOOR_IMPORTS: &[&str] = &["glam", "libm", "thiserror", "wide"];

/// What stays out of the crates below the window: a format reader that pulls in a user interface, or
/// a renderer that knows one, would be an arrow that runs up through somebody else's crate.
const NOT_BELOW_THE_WINDOW: &[&str] = &["egui", "eframe", "clap", "rayon", "indicatif"];

#[test]
fn arrows_never_run_up() {
    let ours: BTreeSet<&str> = FLOORS.iter().map(|(name, _)| *name).collect();
    for (name, dependencies) in dependencies_by_package() {
        let below = FLOORS
            .iter()
            .find(|(floor, _)| *floor == name)
            .unwrap_or_else(|| {
                panic!("{name} has no floor: add it to FLOORS and to ARCHITECTURE.md")
            })
            .1;
        for dependency in dependencies
            .iter()
            .filter(|name| ours.contains(name.as_str()))
        {
            assert!(
                below.contains(&dependency.as_str()),
                "{name} uses {dependency}, which does not stand below it"
            );
        }
    }
}

#[test]
fn the_ground_floor_imports_only_what_is_on_its_list() {
    let dependencies = &dependencies_by_package()["posekit"];
    let listed: BTreeSet<String> = GROUND_FLOOR_IMPORTS
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(dependencies, &listed);
}

#[test]
fn the_lower_floors_know_no_window_and_no_command() {
    let packages = dependencies_by_package();
    for name in ["posekit", "posekit-formats", "posekit-rig"] {
        let Some(dependencies) = packages.get(name) else {
            continue;
        };
        for stranger in NOT_BELOW_THE_WINDOW {
            assert!(
                !dependencies.contains(*stranger),
                "{name} imports {stranger}"
            );
        }
    }
}

/// The normal (not development, not build) dependencies of every package of the workspace.
fn dependencies_by_package() -> BTreeMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--no-deps",
            "--format-version",
            "1",
            "--offline",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let metadata: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
    let packages = metadata["packages"].as_array().expect("a list of packages");
    packages
        .iter()
        .map(|package| {
            let dependencies = package["dependencies"]
                .as_array()
                .expect("a list of dependencies");
            let normal = dependencies
                .iter()
                .filter(|dependency| dependency["kind"].is_null());
            let names = normal.map(|dependency| text(&dependency["name"]));
            (text(&package["name"]), names.collect())
        })
        .collect()
}

fn text(value: &serde_json::Value) -> String {
    value.as_str().expect("a string").to_owned()
}
