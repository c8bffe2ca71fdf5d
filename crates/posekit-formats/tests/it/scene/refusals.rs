//! What is wrong with a file, and where.

use posekit_formats::scene::{self, SceneProblemKind as Kind};

use super::{NOD, changed};

/// The first problem's kind, line, path and a part of its message.
#[track_caller]
fn assert_refused(from: &str, to: &str, kind: Kind, line: usize, path: &str, says: &str) {
    let error = changed(from, to).expect_err("refused");
    let first = &error.problems[0];
    assert_eq!((first.kind, first.location.line), (kind, line), "{error}");
    assert_eq!(first.path, path, "{error}");
    assert!(first.message.contains(says), "{error}");
}

#[test]
fn a_newer_file_is_refused_by_its_number_alone() {
    let newer = NOD.replace("version = 1", "version = 7\nnew_field = 3");
    let error = scene::read(newer.as_bytes()).unwrap_err();
    assert_eq!(error.problems.len(), 1);
    assert_eq!(error.problems[0].kind, Kind::NewerVersion);
    assert!(error.to_string().contains("version 7"), "{error}");
    assert!(error.to_string().contains("reads up to 2"), "{error}");
}

#[test]
fn problems_have_a_place() {
    assert_refused(
        "\"posekit scene\"",
        "\"film\"",
        Kind::NotAScene,
        2,
        "format",
        "`\"film\"`",
    );
    assert_refused(
        "version = 1",
        "version = 0",
        Kind::WrongValue,
        3,
        "version",
        "from 1 on",
    );
    assert_refused(
        "title = ",
        "heading = ",
        Kind::UnknownField,
        4,
        "",
        "`heading`",
    );
    assert_refused(
        "= [0, 2.5]",
        "= [3, 2.5]",
        Kind::WrongValue,
        5,
        "range_secs",
        "a list of 2",
    );
    assert_refused(
        "= 24",
        "= 0",
        Kind::WrongValue,
        6,
        "frames_per_sec",
        "over 0",
    );
    assert_refused(
        "= [0, 2.5]",
        "= [0, 1e9]",
        Kind::Inconsistent,
        1,
        "",
        "frames",
    );
    let head = "skeleton.joints[1].parent";
    assert_refused(
        "parent = \"Body\"",
        "parent = \"Bod\"",
        Kind::WrongValue,
        11,
        head,
        "`\"Bod\"`",
    );
    assert_refused(
        "slope = [0, 0, 1]",
        "slope = \"sleek\"",
        Kind::WrongValue,
        26,
        "track[0].keys[1].slope",
        "\"smooth\"",
    );
    assert_refused(
        "\"ZXY\"",
        "\"ZX\"",
        Kind::WrongValue,
        32,
        "track[1].euler_deg",
        "three axes",
    );
    assert_refused(
        "[0, 35, 370]",
        "[0, 35]",
        Kind::WrongValue,
        37,
        "track[1].keys[1].value",
        "three angles",
    );
    assert_refused(
        "at = 0.75",
        "at = 0.25",
        Kind::Inconsistent,
        35,
        "track[1].keys",
        "key 2",
    );
    assert_refused(
        "at = 0.75",
        "on = 0.75",
        Kind::Missing,
        38,
        "track[1].keys[2]",
        "`at`",
    );
    assert_refused(
        ", slope_out = [0.5, 0, 0, 0]",
        "",
        Kind::Inconsistent,
        39,
        "track[1].keys[3]",
        "slope_out",
    );
    let fov = "camera[0].vertical_fov_deg";
    assert_refused(
        "_deg = 35",
        "_deg = nan",
        Kind::WrongValue,
        46,
        fov,
        "a number or a table",
    );
    assert_refused(
        "shape = \"box\"\n",
        "",
        Kind::Missing,
        58,
        "prop[0]",
        "`shape`",
    );
}

#[test]
fn all_problems_are_told_in_the_order_of_the_text() {
    let text = NOD
        .replace("title", "heading")
        .replace("shape", "shap")
        .replace("= 24", "= -1");
    let error = scene::read(text.as_bytes()).unwrap_err();
    let lines: Vec<usize> = error
        .problems
        .iter()
        .map(|problem| problem.location.line)
        .collect();
    assert_eq!(lines, [4, 6, 58, 60]);
    assert!(
        error.to_string().ends_with("(and 3 more problems)"),
        "{error}"
    );
}

#[test]
fn what_is_no_toml_has_a_place_too() {
    let error = changed("version = 1", "version = ").unwrap_err();
    assert_eq!(
        (error.problems[0].kind, error.problems[0].location.line),
        (Kind::Syntax, 3)
    );
    for bytes in [b"\xff\xfe".as_slice(), b"", b"=", b"[[", b"a = 1\nversion"] {
        let error = scene::read(bytes).unwrap_err();
        assert!(!error.problems.is_empty());
    }
}

#[test]
fn a_thousand_problems_are_counted() {
    let mut text = String::from("format = \"posekit scene\"\nversion = 1\n");
    for number in 0..1000 {
        text += &format!("wrong{number} = 1\n");
    }
    let error = scene::read(text.as_bytes()).unwrap_err();
    assert_eq!(error.problems.len() + error.more, 1001);
    assert!(error.problems.len() < 50);
}
