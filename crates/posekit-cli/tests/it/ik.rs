//! `posekit ik` as a user runs it.

use crate::harness::{Folder, json};

/// The rows of a BVH file, number by number, as text.
fn rows(text: &str) -> Vec<Vec<String>> {
    let rows = text
        .lines()
        .skip_while(|line| !line.starts_with("Frame Time:"));
    rows.skip(1)
        .map(|row| row.split_whitespace().map(str::to_owned).collect())
        .collect()
}

/// The places of values that differ, as frame and column.
fn changes(before: &str, after: &str) -> Vec<(usize, usize)> {
    let (before, after) = (rows(before), rows(after));
    assert_eq!(before.len(), after.len());
    let mut places = Vec::new();
    for (frame, (a, b)) in before.iter().zip(&after).enumerate() {
        assert_eq!(a.len(), b.len());
        places.extend((0..a.len()).filter(|&i| a[i] != b[i]).map(|i| (frame, i)));
    }
    places
}

/// A folder with the walk that posekit makes, written once so that its numbers are those of a file.
fn folder_with_walk() -> Folder {
    let folder = Folder::with_arm();
    folder.succeed(&["sample", "walk", "-o", "walk.bvh"]);
    folder
}

#[test]
fn only_the_chain_in_the_chosen_frames_changes() {
    let folder = Folder::with_arm();
    let end = ["--end", "elbow_end", "--target", "8,21,30"];
    let said = folder.succeed(
        &[
            &["ik", "arm.bvh", "--frames", "1", "-o", "out.bvh"],
            &end[..],
        ]
        .concat(),
    );
    assert!(
        said.contains("\nreached") && said.contains("elbow_end"),
        "{said}"
    );
    let places = changes(&folder.read("arm.bvh"), &folder.read("out.bvh"));
    // The root is held: only the elbow's three angles turn, and only in frame 1.
    assert!(!places.is_empty(), "{said}");
    assert!(
        places
            .iter()
            .all(|&(frame, column)| frame == 1 && column >= 6),
        "{places:?}"
    );
}

#[test]
fn a_hand_is_lifted_throughout_and_everything_else_keeps_its_digits() {
    let folder = folder_with_walk();
    let args = [
        "ik",
        "walk.bvh",
        "--end",
        "LeftHand",
        "--start",
        "LeftUpperArm",
        "--offset",
        "0.02,0.05,0.02",
    ];
    let names = folder.succeed(&["info", "walk.bvh", "--json"]);
    let names = json(&names);
    let joints = names["joints"].as_array().unwrap();
    let has = |name: &str| joints.iter().any(|joint| joint["name"] == name);
    assert!(
        has("LeftHand") && has("LeftUpperArm"),
        "the sample's names: {names}"
    );
    for solver in ["lm", "dls", "ccd", "fabrik"] {
        let more = [
            "--solver",
            solver,
            "--json",
            "-o",
            "out.bvh",
            "--iterations",
            "300",
        ];
        let summary = json(&folder.succeed(&[&args[..], &more].concat()));
        assert_eq!(summary["reached"], true, "{solver} {summary}");
        let places = changes(&folder.read("walk.bvh"), &folder.read("out.bvh"));
        assert_eq!(summary["values_changed"], places.len());
        assert!(!places.is_empty());
        // Columns that change belong to joints of the chain.
        let mut column = 0;
        for joint in joints {
            let count = joint["channels"].as_array().unwrap().len();
            let name = joint["name"].as_str().unwrap();
            let moved = places
                .iter()
                .any(|&(_, at)| (column..column + count).contains(&at));
            let is_on_chain = ["LeftUpperArm", "LeftLowerArm"].contains(&name);
            assert_eq!(moved, is_on_chain, "{solver}: {name}");
            column += count;
        }
        let step = &summary["largest_step"];
        let (now, before) = (
            step["now"].as_f64().unwrap(),
            step["before"].as_f64().unwrap(),
        );
        assert!(
            now < 3.0 * before + 3.0,
            "{solver}: {now} degrees in a frame, {before} before"
        );
    }
}

#[test]
fn a_planted_foot_stays_and_the_root_moves() {
    let folder = folder_with_walk();
    let args = [
        "ik",
        "walk.bvh",
        "--start",
        "LeftFoot",
        "--end",
        "RightHand",
        "--offset",
        "0,0.1,0.1",
    ];
    let summary = json(&folder.succeed(&[&args[..], &["--json", "-o", "out.bvh"]].concat()));
    assert_eq!(summary["reached"], true, "{summary}");
    let places = |file: &str| {
        let text = folder.succeed(&[
            "fk",
            file,
            "-o",
            "-",
            "--format",
            "json",
            "--joints",
            "LeftFoot,Hips",
        ]);
        json(&text)["positions"].clone()
    };
    let (before, after) = (places("walk.bvh"), places("out.bvh"));
    let mut hips_moved = 0.0_f64;
    for (a, b) in before
        .as_array()
        .unwrap()
        .iter()
        .zip(after.as_array().unwrap())
    {
        let far = |joint: usize| {
            (0..3)
                .map(|i| (a[joint][i].as_f64().unwrap() - b[joint][i].as_f64().unwrap()).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        hips_moved = hips_moved.max(far(0));
        assert!(far(1) < 1e-4, "the foot moved by {}", far(1));
    }
    assert!(hips_moved > 1e-3);
}

#[test]
fn paths_other_motions_and_several_targets_are_followed() {
    let folder = folder_with_walk();
    folder.write("way.csv", "frame,x,y,z\n0,0.3,1.2,0.3\n4,0.3,1.3,0.3\n");
    let arm = [
        "ik",
        "walk.bvh",
        "--end",
        "LeftHand",
        "--start",
        "LeftUpperArm",
    ];
    let run = |more: &[&str]| json(&folder.succeed(&[&arm[..], more, &["--json"]].concat()));
    let summary = run(&["--path", "way.csv", "--frames", "0..6"]);
    let target = |summary: &serde_json::Value, frame: usize, axis: usize| {
        summary["frames"][frame]["targets"][0]["target"][axis]
            .as_f64()
            .unwrap()
    };
    assert!(
        (target(&summary, 2, 1) - 1.25).abs() < 1e-12
            && (target(&summary, 5, 1) - 1.3).abs() < 1e-12
    );
    let other = run(&["--follow", "sample:run:LeftHand", "--frames", "0..3"]);
    let itself = run(&[
        "--follow",
        ":LeftHand",
        "--orient",
        "follow",
        "--frames",
        "0..3",
    ]);
    assert!((target(&other, 0, 1) - target(&itself, 0, 1)).abs() > 1e-3);
    assert_eq!(itself["reached"], true);
    assert_eq!(
        itself["values_changed"], 0,
        "a joint that is where it should be is left alone"
    );
    let both = folder.succeed(&[
        "ik",
        "walk.bvh",
        "--free-root",
        "--end",
        "LeftFoot",
        "--end",
        "RightFoot",
        "--end",
        "Hips",
        "--offset",
        "0,-0.05,0",
        "--tolerance",
        "0.002",
        "--json",
        "-o",
        "low.bvh",
    ]);
    let both = json(&both);
    assert_eq!(both["reached"], true, "{both}");
    assert_eq!(both["ends"].as_array().unwrap().len(), 3);
}

#[test]
fn limits_of_a_file_are_kept_and_named() {
    let folder = folder_with_walk();
    folder.write(
        "limits.json",
        r#"{"*LowerArm": {"hinge": {"axis": [0, 1, 0], "range": [-10, 10]}}, "LeftUpperArm": {"stiffness": 0.2}}"#,
    );
    let args = [
        "ik",
        "walk.bvh",
        "--end",
        "LeftHand",
        "--start",
        "LeftUpperArm",
        "--target",
        "0.1,1.2,0.2",
        "--frames",
        "0",
        "--limits",
        "limits.json",
        "--json",
    ];
    let summary = json(&folder.succeed(&args));
    let at_limit = summary["frames"][0]["joints_at_limit"].as_array().unwrap();
    assert!(
        at_limit.iter().any(|name| name == "LeftLowerArm"),
        "{summary}"
    );
    folder.write(
        "bad.json",
        r#"{"LeftUpperArm": {"hinge": {"axis": [0, 0, 0], "range": [0, 1]}}}"#,
    );
    let mut bad = args;
    bad[11] = "bad.json";
    let error = folder.fail(1, &bad);
    assert!(
        error.contains("bad.json") && error.contains("LeftUpperArm"),
        "{error}"
    );
    folder.write("bad.json", "{\"LeftUpperArm\": {\"twist\": 3}");
    assert!(folder.fail(1, &bad).contains("bad.json"));
}

#[test]
fn knees_bend_as_they_do_in_the_motion() {
    let folder = folder_with_walk();
    let range = |file: &str, column: usize| {
        let values = rows(&folder.read(file));
        let values = values.iter().map(|row| row[column].parse::<f64>().unwrap());
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    let args = "ik walk.bvh --free-root --within-motion=20 --end LeftFoot --orient hold --end RightFoot --orient hold \
                --end Hips --offset 0,-0.06,0 -o low.bvh --json";
    let args: Vec<&str> = args.split_whitespace().collect();
    let summary = json(&folder.succeed(&args));
    assert!(
        summary["worst"]["distance"].as_f64().unwrap() < 0.02,
        "{}",
        summary["worst"]
    );
    let text = folder.read("walk.bvh");
    let columns: usize = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("CHANNELS "))
        .map(|line| line.split(' ').next().unwrap().parse::<usize>().unwrap())
        .sum();
    for column in 6..columns {
        let ((least, most), (low, high)) = (range("walk.bvh", column), range("low.bvh", column));
        assert!(
            low >= least - 20.01 && high <= most + 20.01,
            "column {column}: {low} to {high}"
        );
    }
}

#[test]
fn a_trace_has_every_update_of_every_iteration() {
    let folder = folder_with_walk();
    let args = [
        "ik",
        "walk.bvh",
        "--rest",
        "--end",
        "LeftHand",
        "--target",
        "0.4,1.2,0.3",
        "--solver",
        "ccd",
        "--iterations",
        "3",
        "--tolerance",
        "0",
        "--trace",
    ];
    folder.succeed(&[&args[..], &["way.csv"]].concat());
    let table = folder.read("way.csv");
    let columns = table.lines().next().unwrap().split(',').count();
    assert!(
        table.lines().all(|line| line.split(',').count() == columns),
        "{table}"
    );
    folder.succeed(&[&args[..], &["way.json"]].concat());
    let trace = json(&folder.read("way.json"));
    let iterations = trace["frames"][0]["iterations"].as_array().unwrap();
    assert_eq!(iterations.len(), 3);
    let updates: usize = iterations
        .iter()
        .map(|i| i["updates"].as_array().unwrap().len())
        .sum();
    assert_eq!(updates, table.lines().count() - 1);
    assert!(
        folder
            .fail(2, &[&args[..], &["way.txt"]].concat())
            .contains(".json or .csv")
    );
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = Folder::with_arm();
    let refused = [
        (2, vec!["ik", "arm.bvh"]),
        (
            2,
            vec!["ik", "arm.bvh", "--end", "elbow_end", "--target", "1,2"],
        ),
        (
            2,
            vec![
                "ik",
                "arm.bvh",
                "--end",
                "elbow_end",
                "--target",
                "1,2,3",
                "--offset",
                "0,0,0",
            ],
        ),
        (
            2,
            vec!["ik", "arm.bvh", "--end", "elbow_end", "--orient", "follow"],
        ),
        (
            2,
            vec!["ik", "arm.bvh", "--end", "elbow_end", "--softness", "3"],
        ),
        (
            1,
            vec!["ik", "arm.bvh", "--end", "hand", "--target", "1,2,3"],
        ),
        (
            1,
            vec![
                "ik",
                "arm.bvh",
                "--end",
                "elbow_end",
                "--path",
                "nowhere.csv",
            ],
        ),
        (1, vec!["ik", "nowhere.bvh", "--end", "elbow_end"]),
    ];
    for (code, args) in refused {
        let error = folder.fail(code, &args);
        assert!(!error.is_empty(), "{args:?}");
    }
    assert_eq!(folder.names(), ["arm.bvh"]);
}

#[test]
fn the_rest_pose_stands_where_it_is_told_to() {
    let folder = Folder::with_arm();
    let text = folder.read("arm.bvh");
    let turning_only = text
        .replace("CHANNELS 6 Xposition Yposition Zposition", "CHANNELS 3")
        .replace("10 20 30 ", "")
        .replace("10.125 20 30 ", "");
    folder.write("still.bvh", turning_only);
    for (file, more) in [
        ("arm.bvh", &[][..]),
        ("arm.bvh", &["--root-offset", "add"]),
        ("still.bvh", &[]),
    ] {
        let args = [
            "ik",
            file,
            "--rest",
            "--root",
            "-1,2,3",
            "--end",
            "elbow_end",
        ];
        let aim = ["--target", "0,5,3", "-o", "out.bvh", "--json", "--quiet"];
        let summary = json(&folder.succeed(&[&args[..], &aim, more].concat()));
        // The elbow is at (-1, 4, 3) and its end one unit away from it; the target is a square's diagonal away.
        let left = summary["worst"]["distance"].as_f64().unwrap();
        assert!(
            (left - (2.0_f64.sqrt() - 1.0)).abs() < 1e-6,
            "{file}: {left}"
        );
        let fk = ["fk", "out.bvh", "-o", "-", "--format", "json"];
        let places = json(&folder.succeed(&[&fk[..], more].concat()));
        let root = &places["positions"][0][0];
        assert_eq!(*root, serde_json::json!([-1, 2, 3]), "{file}");
    }
    let end = ["--end", "elbow_end"];
    let error = folder.fail(
        2,
        &[&["ik", "arm.bvh", "--root", "0,0,0"], &end[..]].concat(),
    );
    assert!(error.contains("--rest"), "{error}");
}

#[test]
fn two_bones_are_the_joints_that_are_named() {
    let folder = folder_with_walk();
    let bend = |joints: &str| {
        let args = ["ik", "walk.bvh", "--end", "LeftHand", "--frames", "0"];
        let how = ["--start", "Hips", "--solver", "two-bone"];
        let more = [
            "--offset",
            "0,0.02,0",
            "--two-bone-joints",
            joints,
            "--json",
        ];
        [&args[..], &how, &more].concat().join(" ")
    };
    let run = |joints: &str| {
        let command = bend(joints);
        folder.run(&command.split(' ').collect::<Vec<_>>())
    };
    let arm = json(&run("LeftUpperArm,LeftLowerArm").stdout);
    assert_eq!(arm["reached"], true, "{arm}");
    assert_eq!(
        arm["values_changed"], 4,
        "a shoulder and an elbow of one axis: {arm}"
    );
    let spine = json(&run("Spine,LeftLowerArm").stdout);
    assert_eq!(spine["values_changed"], 6, "with a spine of three: {spine}");
    for wrong in ["LeftLowerArm,LeftUpperArm", "RightUpperArm,RightLowerArm"] {
        let ran = run(wrong);
        assert_eq!(ran.code, Some(2), "{wrong}");
        assert!(
            ran.stderr.contains("do not follow each other"),
            "{}",
            ran.stderr
        );
    }
    let ran = run("LeftUpperArm");
    assert!(ran.code == Some(2) && ran.stderr.contains("two joints"));
}
