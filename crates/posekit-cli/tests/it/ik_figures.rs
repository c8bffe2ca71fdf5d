//! The figures of `posekit ik` beside those of others: forward kinematics in NumPy and SciPy, and the guide's table.

use std::path::Path;
use std::process::Command;

use crate::harness::{Folder, json, real_data};

/// The residuals that the summary says are those that a parser and forward kinematics of their own, in
/// NumPy and SciPy, find in the file that was written.
#[test]
fn numpy_finds_the_residuals_that_the_summary_says() {
    let Some(data) = real_data() else { return };
    let has_scipy = Command::new("python3")
        .args(["-c", "import numpy, scipy"])
        .output();
    if !has_scipy.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: there is no python3 with NumPy and SciPy");
        return;
    }
    let folder = Folder::with_arm();
    let walk = data.join("course/motion_walking.bvh");
    let walk = walk.to_str().unwrap();
    let cases: [&[&str]; 5] = [
        &[
            "--start",
            "RootJoint",
            "--end",
            "lWrist_end",
            "--target",
            "0.5,0.75,0.9",
            "--solver",
            "ccd",
            "--iterations",
            "5",
        ],
        &[
            "--start",
            "lToeJoint_end",
            "--end",
            "lWrist_end",
            "--offset",
            "0.1,0.2,0.1",
            "--solver",
            "fabrik",
        ],
        &[
            "--end",
            "rWrist",
            "--start",
            "rShoulder",
            "--offset",
            "0,0.1,0.1",
            "--orient",
            "hold",
            "--solver",
            "two-bone",
        ],
        &[
            "--end",
            "lWrist_end",
            "--offset",
            "0,0.1,0.1",
            "--end",
            "rWrist_end",
            "--offset",
            "0,0.2,0",
            "--end",
            "torso_head_end",
            "--offset",
            "0,-0.05,0.05",
        ],
        &[
            "--end",
            "lWrist",
            "--start",
            "lShoulder",
            "--point",
            "0.1,0,0",
            "--offset",
            "0,0.05,0",
            "--solver",
            "dls",
        ],
    ];
    for case in cases {
        let summary = folder.succeed(&[&["ik", walk, "-o", "out.bvh", "--json"], case].concat());
        folder.write("summary.json", &summary);
        let mut ends = Vec::new();
        for pair in case.windows(2) {
            match pair[0] {
                "--end" => ends.push(format!("{},0,0,0", pair[1])),
                "--point" => {
                    let end = ends.pop().unwrap();
                    ends.push(format!("{},{}", end.split(',').next().unwrap(), pair[1]));
                }
                _ => {}
            }
        }
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tools/ik_check.py");
        let output = Command::new("python3")
            .arg(script)
            .args(["out.bvh", "summary.json"])
            .args(&ends)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said =
            String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{case:?}: {said}");
        println!("{}", said.trim());
    }
}

/// The table of `docs/ik.md`, which `tools/ik_reference.py` and `tools/ik_jacobian_reference.py` (NumPy) made, comes
/// out of the command line that stands above it there. Reads `course/motion_walking.bvh`.
#[test]
fn the_guides_residuals_come_out_of_the_command() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    let file = data.join("course/motion_walking.bvh");
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/ik.md");
    let guide = std::fs::read_to_string(guide).unwrap();
    let rows: [(&str, &[&str]); 8] = [
        ("CCD", &["ccd"]),
        ("CCD, from the base", &["ccd", "--order", "base"]),
        ("FABRIK", &["fabrik"]),
        ("Jacobian transpose, steepest descent", &["steepest"]),
        (
            "Jacobian transpose, conjugate directions (the default)",
            &["transpose"],
        ),
        ("damped least squares", &["dls"]),
        ("selectively damped least squares", &["sdls"]),
        ("Levenberg-Marquardt", &["lm"]),
    ];
    for (name, solver) in rows {
        let row = guide
            .lines()
            .find(|line| line.starts_with(&format!("| {name} |")));
        let cells: Vec<f64> = row
            .unwrap_or_else(|| panic!("{name}"))
            .split('|')
            .filter_map(|cell| cell.trim().parse().ok())
            .collect();
        assert_eq!(cells.len(), 3, "{name}");
        for (iterations, written) in ["1", "5", "20"].into_iter().zip(cells) {
            let fixed = [
                "ik",
                file.to_str().unwrap(),
                "--rest",
                "--root",
                "0,0.931395,0",
                "--start",
                "RootJoint",
                "--end",
                "lWrist_end",
                "--target",
                "0.5,0.75,0.5",
                "--tolerance",
                "0",
                "--json",
                "--quiet",
                "--iterations",
                iterations,
                "--solver",
            ];
            let summary = json(&folder.succeed(&[&fixed, solver].concat()));
            let left = summary["worst"]["distance"].as_f64().unwrap();
            let is_same = if written > 1e-6 {
                (left - written).abs() < 6e-4 * written
            } else {
                left < 2.0 * written + 1e-12
            };
            assert!(is_same, "{name} {iterations}: {left:e}, not {written:e}");
        }
    }
}
