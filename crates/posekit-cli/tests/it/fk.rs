use crate::harness::{ARM, Folder};

#[test]
fn without_a_file_it_takes_its_own_clip_and_says_so() {
    let ran = Folder::with_arm().run(&["fk"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    assert!(ran.stderr.contains("sample:walk"), "{}", ran.stderr);
    assert!(
        ran.stdout.starts_with("sample:walk  25 joints"),
        "{}",
        ran.stdout
    );
    assert!(
        ran.stdout.lines().any(|line| line.starts_with("LeftFoot ")),
        "{}",
        ran.stdout
    );
}

#[test]
fn the_summary_gives_places_bounds_path_and_speed() {
    let text = Folder::with_arm().succeed(&["fk", "arm.bvh"]);
    let row = text
        .lines()
        .find(|line| line.starts_with("base_end"))
        .unwrap_or_default();
    assert!(row.is_empty(), "the end site hangs from the elbow: {text}");
    let row = text
        .lines()
        .find(|line| line.starts_with("elbow_end"))
        .unwrap();
    // Straight up at first, at last up to the side and then up again: (8.125, 21, 30).
    let cells: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(
        cells[1..7],
        ["10.00", "23.00", "30.00", "8.12", "21.00", "30.00"]
    );
    // The longer way is the first, from (10, 23) to (7, 20) in half a second.
    assert_eq!(cells.last(), Some(&"8.49"));
    assert!(!text.contains('\u{1b}'), "no colours in a pipe");
}

#[test]
fn csv_has_a_row_a_frame_and_named_columns() {
    let folder = Folder::with_arm();
    folder.succeed(&["fk", "arm.bvh", "-o", "arm.csv", "--joints", "elbow"]);
    let text = folder.read("arm.csv");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "frame,time,elbow.px,elbow.py,elbow.pz,elbow.qx,elbow.qy,elbow.qz,elbow.qw"
    );
    assert_eq!(lines.len(), 4);
    let cells: Vec<f64> = lines[2]
        .split(',')
        .map(|cell| cell.parse().unwrap())
        .collect();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let wanted = [1.0, 0.5, 8.0, 20.0, 30.0, 0.0, 0.0, half, half];
    for (cell, wanted) in cells.iter().zip(wanted) {
        assert!((cell - wanted).abs() < 1e-5, "{}", lines[2]);
    }
}

#[test]
fn json_to_standard_output_is_for_other_programs() {
    let text = Folder::with_arm().succeed(&[
        "fk",
        "arm.bvh",
        "-o",
        "-",
        "--format",
        "json",
        "--frames",
        "1",
        "--point",
        "elbow,0,0.5,0",
    ]);
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        value["joint_names"],
        serde_json::json!(["base", "elbow", "elbow_end"])
    );
    assert_eq!(value["parents"], serde_json::json!([-1, 0, 1]));
    assert_eq!(value["frames"], serde_json::json!([1]));
    assert_eq!(value["point_joints"], serde_json::json!(["elbow"]));
    let x = value["points"][0][0][0].as_f64().unwrap();
    assert!((x - 7.5).abs() < 1e-5, "{text}");
}

#[test]
fn the_root_offset_is_replaced_or_added() {
    let folder = Folder::with_arm();
    let y = |how: &str| -> f64 {
        let args = [
            "fk",
            "arm.bvh",
            "-o",
            "-",
            "--format",
            "csv",
            "--root-offset",
            how,
        ];
        let text = folder.succeed(&args);
        text.lines()
            .nth(1)
            .unwrap()
            .split(',')
            .nth(3)
            .unwrap()
            .parse()
            .unwrap()
    };
    assert_eq!((y("replace"), y("add")), (20.0, 21.0));
}

#[test]
fn the_rest_pose_is_made_by_the_offsets_alone() {
    let folder = Folder::with_arm();
    folder.write("still.bvh", ARM.split("MOTION").next().unwrap());
    let args = [
        "fk",
        "still.bvh",
        "--rest",
        "-o",
        "-",
        "--format",
        "csv",
        "--joints",
        "elbow",
    ];
    let text = folder.succeed(&args);
    assert!(
        text.lines().nth(1).unwrap().starts_with("0,0,0,3,0,"),
        "{text}"
    );
    let error = folder.fail(1, &["fk", "still.bvh"]);
    assert_eq!(
        error,
        "error: still.bvh: has no frames; --rest gives its rest pose\n"
    );
}

#[test]
fn standard_input_is_read_to_its_end() {
    let folder = Folder::with_arm();
    let args = ["fk", "-", "-o", "-", "--format", "csv"];
    let from_input = folder.run_with_input(&args, ARM.as_bytes());
    assert_eq!(from_input.code, Some(0), "{}", from_input.stderr);
    let from_file = folder.succeed(&["fk", "arm.bvh", "-o", "-", "--format", "csv"]);
    assert_eq!(from_input.stdout, from_file);
}

#[test]
fn a_folder_is_mirrored_whatever_the_number_of_jobs() {
    let folder = Folder::with_arm();
    for name in ["takes/a.bvh", "takes/sub/b.BVH", "takes/sub/deep/c.bvh"] {
        folder.write(name, ARM);
    }
    for jobs in ["1", "3"] {
        let out = format!("out{jobs}");
        folder.succeed(&["fk", "takes", "-o", &out, "--jobs", jobs]);
        let out_path = |name: &str| folder.path().join(&out).join(name);
        let bytes = std::fs::read(out_path("a.npz")).unwrap();
        for name in ["sub/b.npz", "sub/deep/c.npz"] {
            assert_eq!(std::fs::read(out_path(name)).unwrap(), bytes, "{name}");
        }
    }
    folder.succeed(&[
        "fk",
        "takes/**/*.bvh",
        "-o",
        "p/{dir}/{stem}_fk.csv",
        "--format",
        "csv",
    ]);
    assert!(folder.exists("p/a_fk.csv") && folder.exists("p/sub/deep/c_fk.csv"));
}
