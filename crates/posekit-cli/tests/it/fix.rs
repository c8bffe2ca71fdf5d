//! `posekit fix` as a user runs it: what it writes, what it says, and what it never touches.

use serde_json::Value;

use crate::check::flipping_arm;
use crate::harness::{ARM, Folder};

#[test]
fn a_flip_is_unwrapped_into_a_new_file() {
    let folder = Folder::with_arm();
    folder.write("flip.bvh", flipping_arm());
    let ran = folder.run(&["fix", "flip.bvh", "-o", "fixed.bvh"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (Some(0), ""));
    let mut lines = ran.stderr.lines();
    assert_eq!(
        lines.next(),
        Some("flip.bvh: 1 change, written to fixed.bvh")
    );
    let change = lines.next().unwrap();
    assert!(
        change.contains("elbow unwrapped") && change.ends_with("[flips-unwrapped]"),
        "{change}"
    );
    assert_eq!(folder.read("flip.bvh"), flipping_arm());
    folder.succeed(&["check", "fixed.bvh", "--deny", "euler-flip"]);
    let again = folder.run(&["fix", "fixed.bvh", "--dry-run"]);
    assert_eq!(again.stderr, "fixed.bvh: nothing to repair\n");
}

#[test]
fn a_dry_run_writes_nothing() {
    let folder = Folder::with_arm();
    folder.write("flip.bvh", flipping_arm());
    let ran = folder.run(&["fix", "flip.bvh", "--dry-run"]);
    assert_eq!(ran.code, Some(0));
    assert!(
        ran.stderr.starts_with("flip.bvh: 1 change\n"),
        "{}",
        ran.stderr
    );
    assert_eq!(folder.names(), ["arm.bvh", "flip.bvh"]);
    assert_eq!(folder.read("flip.bvh"), flipping_arm());
}

#[test]
fn an_input_is_never_written_to() {
    let folder = Folder::with_arm();
    folder.write("flip.bvh", flipping_arm());
    let error = folder.fail(2, &["fix", "flip.bvh", "-o", "flip.bvh"]);
    assert!(error.contains("would be overwritten"), "{error}");
    folder.write("in/flip.bvh", flipping_arm());
    let error = folder.fail(2, &["fix", "in", "-o", "in"]);
    assert!(error.contains("would be overwritten"), "{error}");
    for name in ["flip.bvh", "in/flip.bvh"] {
        assert_eq!(folder.read(name), flipping_arm());
    }
}

#[test]
fn usage_that_makes_no_sense_is_refused() {
    let folder = Folder::with_arm();
    for args in [
        &["fix", "arm.bvh"][..],
        &["fix", "arm.bvh", "--dry-run", "-o", "x.bvh"],
        &["fix", "arm.bvh", "--json", "-o", "-"],
        &["fix", "-o", "x.bvh"],
    ] {
        folder.fail(2, args);
    }
    folder.fail(1, &["fix", "missing.bvh", "-o", "x.bvh"]);
    assert_eq!(folder.names(), ["arm.bvh"]);
}

#[test]
fn what_the_reader_put_right_is_written_right() {
    let folder = Folder::with_arm();
    let wrong = ARM.replace("Frames: 3", "Frames: 4").replace('\n', "\r\n");
    folder.write("wrong.bvh", &wrong);
    let ran = folder.run(&["fix", "wrong.bvh", "-o", "-"]);
    assert_eq!(ran.code, Some(0));
    assert!(ran.stdout.contains("Frames: 3\n"), "{}", ran.stdout);
    assert!(!ran.stdout.contains('\r'));
    for code in ["[written-right]", "[line-ends]"] {
        assert!(ran.stderr.contains(code), "{}", ran.stderr);
    }
    assert_eq!(folder.read("wrong.bvh"), wrong);
}

#[test]
fn blanks_in_names_become_underscores_on_request() {
    let folder = Folder::with_arm();
    folder.write("blank.bvh", ARM.replace("elbow", "left elbow"));
    let kept = folder.run(&["fix", "blank.bvh", "-o", "-"]);
    assert!(kept.stdout.contains("JOINT left elbow"), "{}", kept.stdout);
    let renamed = folder.run(&["fix", "blank.bvh", "--names", "-o", "-"]);
    assert!(
        renamed.stdout.contains("JOINT left_elbow"),
        "{}",
        renamed.stdout
    );
    assert!(
        renamed
            .stderr
            .contains("`left elbow` renamed to `left_elbow`"),
        "{}",
        renamed.stderr
    );
}

#[test]
fn json_has_an_object_for_each_file() {
    let folder = Folder::with_arm();
    folder.write("in/clean.bvh", ARM);
    folder.write("in/flip.bvh", flipping_arm());
    let ran = folder.run(&["fix", "--json", "in", "-o", "out"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let lines: Vec<Value> = ran
        .stdout
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0]["changes"], serde_json::json!([]));
    let change = &lines[1]["changes"][0];
    assert_eq!(change["code"], "flips-unwrapped");
    assert_eq!(change["joint"], "elbow");
    assert_eq!(
        change["frames"],
        serde_json::json!({ "first": 25, "last": 34 })
    );
    assert!(change["count"].as_u64().unwrap() >= 10, "{change}");
    assert!(change["message"].is_string() && change["line"].is_null());
    assert!(folder.exists("out/clean.bvh") && folder.exists("out/flip.bvh"));
    let written = lines[1]["written"].as_str().unwrap().replace('\\', "/");
    assert_eq!(written, "out/flip.bvh");
    let dry = folder.succeed(&["fix", "--json", "--dry-run", "in/flip.bvh"]);
    let dry: Value = serde_json::from_str(&dry).unwrap();
    assert!(dry["written"].is_null());
}
