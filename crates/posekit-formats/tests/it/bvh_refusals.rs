//! What cannot be read, and the one error that says so.

use std::ops::ControlFlow;

use crate::bvh_text::{HEAD, assert_refused, place, with_rows};
use posekit_formats::bvh::{self, MAX_DEPTH, MAX_NAME_BYTES, ReadOptions};
use posekit_formats::report::ReadErrorKind as Kind;

#[test]
fn empty_files() {
    assert_refused(
        "",
        Kind::Empty,
        "line 1, column 1: expected HIERARCHY, found an empty file",
    );
    let message = "line 1, column 1: expected HIERARCHY, found nothing but blanks";
    assert_refused("  \r\n\t\n", Kind::Empty, message);
}

#[test]
fn binary_files() {
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    let message = "line 3, column 1: expected text, found a NUL byte: the file is binary";
    assert_refused(png, Kind::NotText, message);
    let utf16 = b"\xff\xfeH\0I\0";
    let message = "line 1, column 1: expected ASCII or UTF-8 text, found UTF-16 text";
    assert_refused(utf16, Kind::NotText, message);
    let gzip = b"\x1f\x8b\x08\xff\xfe\xfd";
    assert_eq!(bvh::read(gzip).unwrap_err().kind, Kind::Unexpected);
}

/// A NUL byte in a name is refused wherever it stands; as padding after the last row it does no harm.
#[test]
fn names_with_nul_bytes() {
    let blanks = " ".repeat(80);
    let text = HEAD.replacen("ROOT Hips", &format!("ROOT {blanks}Hi\0ps"), 1);
    let error = bvh::read(text.as_bytes()).unwrap_err();
    assert_eq!(error.kind, Kind::NotText, "{error}");
    assert!(error.found.contains("NUL"), "{error}");
}

#[test]
fn other_text() {
    let message = "line 1, column 1: expected HIERARCHY, found `solid`";
    assert_refused("solid cube", Kind::Unexpected, message);
    let message = "line 2, column 1: expected ROOT, found `MOTION`";
    assert_refused("HIERARCHY\nMOTION\n", Kind::Unexpected, message);
    let message = "line 1, column 10: expected ROOT, found the end of the file";
    assert_refused("HIERARCHY", Kind::Unexpected, message);
}

#[test]
fn numbers_that_are_none() {
    for special in [
        "nan",
        "NaN",
        "-nan(ind)",
        "inf",
        "-Infinity",
        "1.#QNAN",
        "-1.#IND",
        "1e999",
    ] {
        let text = with_rows(2, &format!("1 2 3 4\n5 {special} 7 8\n"));
        let error = bvh::read(text.as_bytes()).unwrap_err();
        assert_eq!(error.kind, Kind::NotFinite, "{error}");
        assert_eq!(place(&error), (20, 3));
        assert!(error.found.contains(special), "{error}");
    }
}

/// BVH has no quaternions; programs that write them all the same do so in one of these ways.
#[test]
fn quaternion_channels_are_refused_by_that_name() {
    for word in [
        "Wrotation",
        "WROTATION",
        "Quaternion",
        "quat",
        "Qx",
        "qw",
        "Xquaternion",
        "Qzrotation",
    ] {
        let text = HEAD.replacen("Zrotation", word, 1);
        let error = bvh::read(text.as_bytes()).unwrap_err();
        assert_eq!(error.kind, Kind::UnknownChannel);
        let found = format!("the quaternion channel `{word}`, which BVH does not have");
        assert_eq!(error.found, found, "{error}");
    }
    for (name, line, column) in [("quat_channels.bvh", 5, 73), ("quat_word.bvh", 5, 43)] {
        let Some(text) = crate::cases::bytes(name) else {
            return;
        };
        let error = bvh::read(&text).unwrap_err();
        assert!(error.found.contains("quaternion"), "{error}");
        let location = error.place.location().expect("a place in a text");
        assert_eq!((location.line, location.column), (line, column));
    }
    let text = HEAD.replacen("Zrotation", "Twist", 1);
    let error = bvh::read(text.as_bytes()).unwrap_err();
    assert_eq!(error.found, "`Twist`");
}

#[test]
fn text_where_a_number_belongs() {
    for word in [
        "x", "0x10", "1.2.3", "--5", "-", ".", "1e", "1e+", "1_000", "12abc", "}", "1\u{a0}2",
    ] {
        let text = with_rows(2, &format!("1 2 3 4\n5 {word} 7 8\n"));
        let message = format!("line 20, column 3: expected a number, found `{word}`");
        assert_refused(text, Kind::Unexpected, &message);
    }
    let text = HEAD.replace("OFFSET 0 5.5 0", "OFFSET 0 5.5");
    let message = "line 9, column 5: expected a number of OFFSET, found `CHANNELS`";
    assert_refused(text, Kind::Unexpected, message);
    let text = format!("{HEAD}Frames: many\n");
    let message = "line 17, column 9: expected the number of frames, found `many`";
    assert_refused(text, Kind::Unexpected, message);
    let message = "line 17, column 7: expected `Time` after `Frame`, found `Rate:`";
    assert_refused(format!("{HEAD}Frame Rate: 30\n"), Kind::Unexpected, message);
}

#[test]
fn an_unclosed_brace() {
    let text = with_rows(1, "1 2 3 4\n").replace("}\nMOTION", "MOTION");
    let message =
        "line 15, column 1: expected `}` to close the joint `Hips` of line 2, found `MOTION`";
    assert_refused(text, Kind::UnclosedBrace, message);
    let message = "line 2, column 16: expected `}` to close the joint `a` of line 2, found the end of the file";
    assert_refused(
        "HIERARCHY\nROOT a { OFFSET ".replace("OFFSET ", "      "),
        Kind::UnclosedBrace,
        message,
    );
}

#[test]
fn a_missing_brace() {
    let text = HEAD.replace("ROOT Hips\n{", "ROOT Hips\n");
    let message = "line 4, column 3: expected `{`, found `OFFSET`";
    assert_refused(text, Kind::Unexpected, message);
}

#[test]
fn an_unknown_channel() {
    for name in ["Xrotatoin", "Urotation", "Xscale", "rotation", "X"] {
        let text = HEAD.replace("CHANNELS 1 Xrotation", &format!("CHANNELS 1 {name}"));
        let message = format!(
            "line 9, column 16: expected a channel name such as `Xrotation`, found `{name}`"
        );
        assert_refused(text, Kind::UnknownChannel, &message);
    }
}

#[test]
fn an_unknown_keyword() {
    let text = HEAD.replace("OFFSET 0 5.5 0", "OFFSETS 0 5.5 0");
    let message =
        "line 8, column 5: expected OFFSET, CHANNELS, JOINT, End Site or `}`, found `OFFSETS`";
    assert_refused(text, Kind::Unexpected, message);
}

/// Were room made for what is promised, these would need petabytes.
#[test]
fn a_frame_count_beyond_the_file() {
    for count in ["4000000000", "99999999999999999999", "1e300"] {
        let text = format!("{HEAD}Frames: {count}\nFrame Time: 0.1\n1 2 3 4\n");
        let error = bvh::read(text.as_bytes()).unwrap_err();
        assert_eq!(error.kind, Kind::ImpossibleFrameCount);
        assert_eq!(place(&error), (17, 9));
        assert!(error.expected.contains("at most 1 frames"), "{error}");
    }
}

#[test]
fn nesting_ten_thousand_deep() {
    let text = format!("HIERARCHY\nROOT a{{{}", "JOINT a{\n".repeat(10_000));
    let error = bvh::read(text.as_bytes()).unwrap_err();
    assert_eq!(error.kind, Kind::LimitExceeded);
    assert_eq!(place(&error).0, MAX_DEPTH + 1);
    let deep = MAX_DEPTH - 1;
    let text = format!(
        "HIERARCHY ROOT a{{{}{}}}",
        "JOINT a{".repeat(deep),
        "}".repeat(deep)
    );
    assert_eq!(
        bvh::read(text.as_bytes()).unwrap().document.joints.len(),
        MAX_DEPTH
    );
}

#[test]
fn too_many_joints_and_too_long_names() {
    let text = format!("HIERARCHY ROOT a{{{}}}", "JOINT a{}".repeat(100_001));
    assert_eq!(
        bvh::read(text.as_bytes()).unwrap_err().kind,
        Kind::LimitExceeded
    );
    let text = format!("HIERARCHY ROOT {} {{}}", "a".repeat(MAX_NAME_BYTES + 1));
    let message = "line 1, column 15: expected a name of at most 256 bytes, found one of 257 bytes";
    assert_refused(text, Kind::LimitExceeded, message);
}

/// The callback sees rising positions about every MiB, and stops the reader at once.
#[test]
fn progress_and_cancelling() {
    let text = with_rows(400_000, &"1 2 3 4\n".repeat(400_000));
    let mut calls = Vec::new();
    let whole = bvh::read_with(text.as_bytes(), ReadOptions::default(), |done| {
        calls.push(done);
        ControlFlow::Continue(())
    });
    assert_eq!(whole.unwrap().document.frame_count(), 400_000);
    assert!(calls.is_sorted() && calls.len() >= 3, "{calls:?}");
    assert_eq!(calls.last(), Some(&text.len()));
    let error = bvh::read_with(text.as_bytes(), ReadOptions::default(), |done| {
        if done > 2_000_000 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let error = error.unwrap_err();
    assert_eq!(error.kind, Kind::Cancelled);
    assert!(place(&error).0 < 400_000);
}
