//! Small files that failed for users, from `../shared/cases` and `../shared/more`; without those folders
//! the tests say so and pass.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::harness::{ARM, Folder};

/// A file of the shared folder; nothing, with a word, where there is no such folder.
fn shared(path: &str) -> Option<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let path: PathBuf = root.join(path);
    if !path.is_file() {
        eprintln!("{} is missing: skipped", path.display());
        return None;
    }
    Some(path.to_str().unwrap().to_owned())
}

fn findings(folder: &Folder, args: &[&str]) -> Vec<Value> {
    let ran = folder.run(&[&["check", "--json"], args].concat());
    let object: Value = serde_json::from_str(ran.stdout.trim()).unwrap();
    object["findings"].as_array().unwrap().clone()
}

fn codes(findings: &[Value]) -> Vec<&str> {
    findings
        .iter()
        .map(|it| it["code"].as_str().unwrap())
        .collect()
}

/// What was said of a figure that nobody recorded.
const BLAMED: [&str; 5] = [
    "offset-unlike-motion",
    "rest-pose-unlike-motion",
    "nonzero-root-offset",
    "floor-not-at-zero",
    "bone-length-changes",
];

#[test]
fn position_channels_that_are_not_positions_are_one_finding_that_names_the_option() {
    let folder = Folder::with_arm();
    for (name, joints, option) in [
        (
            "zero_positions.bvh",
            &["Spine", "Head", "LegL", "LegR"][..],
            "others=ignore",
        ),
        ("relative_root.bvh", &["Hips"], "root=add"),
    ] {
        let Some(path) = shared(&format!("cases/{name}")) else {
            return;
        };
        let found = findings(&folder, &[&path]);
        let about: Vec<&Value> = found
            .iter()
            .filter(|it| it["code"] == "positions-relative-to-offset")
            .collect();
        let [finding] = about.as_slice() else {
            panic!("{name}: {:?}", codes(&found));
        };
        let message = finding["message"].as_str().unwrap();
        assert!(
            message.contains(&format!("--positions {option}")),
            "{message}"
        );
        assert_eq!(finding["joints"], serde_json::json!(joints));
        for code in BLAMED {
            assert!(!codes(&found).contains(&code), "{name}: {code}");
        }
        // Who does as it says is not told again.
        let again = findings(&folder, &[&path, "--positions", option]);
        for code in [
            "positions-relative-to-offset",
            "floor-not-at-zero",
            "offset-unlike-motion",
        ] {
            assert!(!codes(&again).contains(&code), "{name}: {code}");
        }
        let info = folder.succeed(&["info", &path]);
        assert!(info.contains(&format!("--positions {option}")), "{info}");
    }
    // Files whose channels are places are left in peace.
    for name in [
        "six_dof.bvh",
        "flat_rest.bvh",
        "crawl.bvh",
        "zero_offsets.bvh",
        "ape.bvh",
    ] {
        let path = shared(&format!("cases/{name}")).unwrap();
        let found = findings(&folder, &[&path]);
        assert!(
            !codes(&found).contains(&"positions-relative-to-offset"),
            "{name}"
        );
    }
}

/// The places of joints in the first frame.
fn places(folder: &Folder, args: &[&str]) -> Vec<[f64; 3]> {
    let text = folder.succeed(
        &[
            &["fk", "-o", "-", "--format", "json", "--frames", "0"],
            args,
        ]
        .concat(),
    );
    let object: Value = serde_json::from_str(&text).unwrap();
    let frame = object["positions"][0].as_array().unwrap();
    let place = |place: &Value| [0, 1, 2].map(|axis| place[axis].as_f64().unwrap());
    frame.iter().map(place).collect()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|axis| (a[axis] - b[axis]).powi(2))
        .sum::<f64>()
        .sqrt()
}

#[test]
fn offsets_stay_where_position_channels_are_added_or_ignored() {
    let folder = Folder::with_arm();
    let Some(path) = shared("cases/zero_positions.bvh") else {
        return;
    };
    // Lengths of the OFFSETs (0, 11, -1) and (0, 52, 1.5), by hand.
    let (spine, head) = (122.0_f64.sqrt(), (52.0_f64 * 52.0 + 2.25).sqrt());
    for how in ["add", "ignore", "others=add", "root=replace,others=ignore"] {
        let places = places(&folder, &[&path, "--positions", how]);
        assert!(distance(places[0], [31.0, 90.0, -14.0]) < 1e-4, "{how}");
        assert!(
            (distance(places[0], places[1]) - spine).abs() < 1e-4,
            "{how}"
        );
        assert!(
            (distance(places[1], places[2]) - head).abs() < 1e-4,
            "{how}"
        );
    }
    let collapsed = places(&folder, &[&path]);
    assert!(distance(collapsed[0], collapsed[1]) < 1e-6);
    folder.succeed(&["convert", &path, "whole.bvh", "--positions", "ignore"]);
    let settled = places(&folder, &["whole.bvh"]);
    let meant = places(&folder, &[&path, "--positions", "ignore"]);
    for (a, b) in settled.iter().zip(&meant) {
        assert!(distance(*a, *b) < 1e-4);
    }
    let error = folder.fail(2, &["fk", &path, "--positions", "feet=add"]);
    assert!(error.contains("root=add,others=ignore"), "{error}");
    // The option that came before.
    let lifted = places(&folder, &["arm.bvh", "--root-offset", "add"]);
    assert!(distance(lifted[0], [10.0, 21.0, 30.0]) < 1e-5);
}

#[test]
fn a_crawl_is_no_climb() {
    let folder = Folder::with_arm();
    let Some(path) = shared("cases/crawl.bvh") else {
        return;
    };
    let info = folder.succeed(&["info", &path]);
    let up = info.lines().find(|line| line.starts_with("  up")).unwrap();
    assert!(
        up.contains(" Y, likely") && !info.contains("convert"),
        "{info}"
    );
    let facts: Value = serde_json::from_str(&folder.succeed(&["info", "--json", &path])).unwrap();
    assert_eq!(
        (facts["up"].as_str(), facts["up_sureness"].as_str()),
        (Some("y"), Some("likely"))
    );
}

#[test]
fn a_figure_on_z_is_stood_up_with_a_word() {
    let folder = Folder::with_arm();
    let Some(path) = shared("more/makehuman/walk1.bvh") else {
        return;
    };
    let facts: Value = serde_json::from_str(&folder.succeed(&["info", "--json", &path])).unwrap();
    assert_eq!(facts["up"], "z");
    let draw = |more: &[&str], out: &str| {
        let args = [
            "render",
            &path,
            "-o",
            out,
            "--size",
            "64x48",
            "--renderer",
            "cpu",
        ];
        let ran = folder.run(&[&args, more].concat());
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        (ran.stderr, std::fs::read(folder.path().join(out)).unwrap())
    };
    let (said, stood) = draw(&[], "auto.png");
    assert!(said.contains("Z is up") && said.contains("--up"), "{said}");
    let (said, asked) = draw(&["--up", "z"], "z.png");
    assert!(!said.contains("is up"), "{said}");
    assert_eq!(stood, asked);
    let (_, lying) = draw(&["--up", "y"], "y.png");
    assert_ne!(stood, lying);
}

#[test]
fn joints_whose_places_tremble_lose_their_position_channels() {
    let folder = Folder::with_arm();
    for name in ["zero_offsets.bvh", "zero_offsets_noise.bvh"] {
        let Some(path) = shared(&format!("cases/{name}")) else {
            return;
        };
        let ran = folder.run(&["convert", &path, "three.bvh", "--channels", "3"]);
        assert_eq!(
            (ran.code, ran.stderr.contains("kept")),
            (Some(0), false),
            "{}",
            ran.stderr
        );
        let text = folder.read("three.bvh");
        assert_eq!(text.matches("CHANNELS 3").count(), 4, "{text}");
        let head = places(&folder, &["three.bvh"])[2];
        assert!(distance(head, places(&folder, &[&path])[2]) < 1e-4);
    }
}

#[test]
fn a_prefix_goes_and_names_of_end_sites_stay() {
    let folder = Folder::with_arm();
    let (Some(prefixed), Some(named)) =
        (shared("cases/prefixed.bvh"), shared("cases/named_end.bvh"))
    else {
        return;
    };
    folder.succeed(&[
        "convert",
        &prefixed,
        "plain.bvh",
        "--rename",
        "mixamorig:*=*",
    ]);
    let plain = folder.read("plain.bvh");
    assert!(
        !plain.contains("mixamorig") && plain.contains("ROOT Hips"),
        "{plain}"
    );
    let error = folder.fail(
        2,
        &["convert", &prefixed, "x.bvh", "--rename", "mixamorig:*=*_*"],
    );
    assert!(error.contains("more asterisks"), "{error}");
    folder.succeed(&["convert", &named, "named.bvh"]);
    assert!(
        folder
            .read("named.bvh")
            .contains("End Site #name: Foot_L_Nub")
    );
    let info = folder.succeed(&["info", "--tree", &named]);
    assert!(
        info.contains("named TailTip, Foot_L_Nub") && info.contains("TailTip (end)"),
        "{info}"
    );
}

#[test]
fn a_frame_time_is_set() {
    let folder = Folder::with_arm();
    folder.succeed(&["convert", "arm.bvh", "fast.bvh", "--frame-time", "0.01"]);
    assert!(folder.read("fast.bvh").contains("Frame Time: 0.01\n"));
    for secs in ["0", "-1", "nan"] {
        let set = format!("--frame-time={secs}");
        let error = folder.fail(2, &["convert", "arm.bvh", "x.bvh", &set]);
        assert!(error.contains("frame time"), "{error}");
    }
    folder.write("still.bvh", ARM.replace("Frame Time: 0.5", "Frame Time: 0"));
    let ran = folder.run(&["fix", "still.bvh", "--dry-run"]);
    assert!(
        ran.stderr.contains("--frame-time sets another"),
        "{}",
        ran.stderr
    );
    folder.succeed(&[
        "fix",
        "still.bvh",
        "-o",
        "moving.bvh",
        "--frame-time",
        "0.02",
    ]);
    assert!(folder.read("moving.bvh").contains("Frame Time: 0.02\n"));
}

/// A rotation of a quarter turn with a frame lost in the middle, and a root that goes 3 along X.
#[test]
fn values_that_are_no_numbers_are_found_and_bridged() {
    let folder = Folder::with_arm();
    let rows = "10 20 30 0 0 0 0 0 0\n\
                nan 20 30 nan 0 0 0 0 0\n\
                12 20 30 60 0 -nan(ind) 0 1.#QNAN 0\n\
                13 20 30 90 0 0 0 0 0\n\
                13 20 30 90 0 0 0 0 inf\n";
    let head = &ARM[..ARM.find("10 20 30").unwrap()];
    folder.write("lost.bvh", head.replace("Frames: 3", "Frames: 5") + rows);
    let error = folder.fail(1, &["fk", "lost.bvh"]);
    assert!(
        error.contains("lost.bvh:20:1: expected a number, found `nan`"),
        "{error}"
    );
    assert!(error.contains("posekit fix --bridge-gaps"), "{error}");
    let error = folder.fail(1, &["fix", "lost.bvh", "-o", "whole.bvh"]);
    assert!(
        error.contains("lost.bvh:20:1") && !folder.exists("whole.bvh"),
        "{error}"
    );
    let found = findings(&folder, &["lost.bvh"]);
    let lost: Vec<&Value> = found
        .iter()
        .filter(|it| it["code"] == "not-finite")
        .collect();
    assert_eq!(lost.len(), 2, "{found:?}");
    // What is not a number is not out of range as well.
    let is_too_large = |it: &Value| it["code"] == "value-out-of-range";
    assert!(!found.iter().any(is_too_large), "{found:?}");
    assert_eq!(lost[0]["joints"], serde_json::json!(["base"]));
    assert_eq!(
        lost[0]["frames"],
        serde_json::json!({"first": 1, "last": 2})
    );
    assert_eq!(
        lost[1]["frames"],
        serde_json::json!({"first": 2, "last": 4})
    );
    assert_eq!(folder.run(&["check", "lost.bvh"]).code, Some(1));
    let error = folder.fail(
        1,
        &[
            "fix",
            "lost.bvh",
            "-o",
            "x.bvh",
            "--bridge-gaps",
            "--max-gap",
            "0.5",
        ],
    );
    assert!(
        error.contains("frames 1 to 2") && error.contains("--max-gap"),
        "{error}"
    );
    let args = [
        "fix",
        "lost.bvh",
        "-o",
        "whole.bvh",
        "--bridge-gaps",
        "--max-gap",
        "1",
    ];
    folder.succeed(&args);
    let text = folder.read("whole.bvh");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip_while(|line| !line.starts_with("Frame Time:"))
        .skip(1)
        .map(|row| row.split(' ').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    // A quarter turn about Z in three steps is 30 degrees a step; X of the root is halfway.
    assert!(
        (rows[1][3] - 30.0).abs() < 1e-9 && (rows[2][3] - 60.0).abs() < 1e-9,
        "{text}"
    );
    assert_eq!((rows[1][0], rows[2][0]), (11.0, 12.0));
    // The last frame holds, and what was there stays.
    assert_eq!(rows[4][6..], rows[3][6..]);
    assert_eq!(rows[3][..6], [13.0, 20.0, 30.0, 90.0, 0.0, 0.0]);
    folder.succeed(&["fk", "whole.bvh"]);
    folder.write(
        "none.bvh",
        ARM.replace("10.125", "nan")
            .replace("10 20 30", "nan 20 30"),
    );
    let error = folder.fail(1, &["fix", "none.bvh", "-o", "x.bvh", "--bridge-gaps"]);
    assert!(error.contains("nothing to bridge from"), "{error}");
    folder.write("offset.bvh", ARM.replace("OFFSET 0 2 0", "OFFSET 0 nan 0"));
    let error = folder.fail(1, &["fix", "offset.bvh", "-o", "x.bvh", "--bridge-gaps"]);
    assert!(error.contains("offset.bvh:8:14"), "{error}");
}

/// The hand of a figure whose OFFSETs are all zero is taken to a place that it can reach; how near is near
/// enough is told from its bones in the motion.
#[test]
fn inverse_kinematics_works_without_offsets() {
    let folder = Folder::with_arm();
    let Some(path) = shared("cases/zero_offsets.bvh") else {
        return;
    };
    // The head turned by 0.2 rad about Z around the spine: a place that it can reach for certain.
    let at_first = places(&folder, &[&path]);
    let (spine, head) = (at_first[1], at_first[2]);
    let (sin, cos) = 0.2_f64.sin_cos();
    let (x, y) = (head[0] - spine[0], head[1] - spine[1]);
    let target = format!(
        "{},{},{}",
        spine[0] + cos * x - sin * y,
        spine[1] + sin * x + cos * y,
        head[2]
    );
    let args = [
        "ik", &path, "--frames", "0", "--start", "Hips", "--end", "Head", "--target", &target,
        "--json",
    ];
    let ran = folder.run(&args);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let report: Value = serde_json::from_str(ran.stdout.lines().next().unwrap()).unwrap();
    assert_eq!(report["reached"], true, "{report}");
}
