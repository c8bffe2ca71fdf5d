//! What goes wrong, in one line each.

use std::process::Stdio;

use crate::harness::{ARM, Folder};

#[test]
fn a_file_that_cannot_be_read_gets_its_line() {
    let folder = Folder::with_arm();
    folder.write("empty.bvh", "");
    folder.write("binary.bvh", b"glTF\x02\x00\x00\x00");
    folder.write("cut.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n");
    folder.write("nothing/readme.txt", "");
    for (name, wanted) in [
        ("missing.bvh", "error: missing.bvh: no such file\n"),
        (
            "empty.bvh",
            "error: empty.bvh:1:1: expected HIERARCHY, found an empty file\n",
        ),
        (
            "binary.bvh",
            "error: binary.bvh:1:6: expected text, found a NUL byte",
        ),
        ("cut.bvh", "error: cut.bvh:"),
        (
            "nothing",
            "error: nothing: no .bvh file in this folder or below it\n",
        ),
        ("x*.bvh", "error: no file matches 'x*.bvh'\n"),
    ] {
        for command in ["info", "fk"] {
            let error = folder.fail(1, &[command, name]);
            assert!(error.starts_with(wanted), "{command} {name}: {error}");
            assert_eq!(error.lines().count(), 1, "{error}");
            assert!(!error.trim_end().ends_with('.'), "{error}");
        }
    }
}

#[test]
fn a_bad_file_among_good_ones_is_named_at_the_end() {
    let folder = Folder::with_arm();
    folder.write("in/a.bvh", ARM);
    folder.write("in/b.bvh", "not a motion");
    folder.write("in/c.bvh", ARM);
    let error = folder.fail(1, &["fk", "in", "-o", "out"]);
    let last = error.lines().last().unwrap();
    let name = std::path::Path::new("in").join("b.bvh");
    assert_eq!(last, format!("error: 1 of 3 failed: {}", name.display()));
    assert!(folder.exists("out/a.npz") && folder.exists("out/c.npz"));
    assert!(!folder.exists("out/b.npz"));
}

#[test]
fn a_repair_is_a_warning_and_with_strict_an_error() {
    let folder = Folder::with_arm();
    folder.write("off.bvh", ARM.replace("Frames: 3", "Frames: 4"));
    let ran = folder.run(&["fk", "off.bvh", "-o", "off.npz"]);
    assert_eq!(ran.code, Some(0));
    assert!(
        ran.stderr.starts_with("warning: off.bvh:"),
        "{}",
        ran.stderr
    );
    assert!(
        ran.stderr.contains("[frame-count-mismatch]"),
        "{}",
        ran.stderr
    );
    assert_eq!(
        folder
            .run(&["fk", "off.bvh", "-o", "off.npz", "--quiet"])
            .stderr,
        ""
    );
    let error = folder.fail(1, &["fk", "off.bvh", "--strict"]);
    assert!(error.contains("[frame-count-mismatch]"), "{error}");
}

#[test]
fn an_output_that_makes_no_sense_is_wrong_usage() {
    let folder = Folder::with_arm();
    folder.write("in/a.bvh", ARM);
    for (args, wanted) in [
        (&["fk", "in", "-o", "out.npz"][..], "is one file"),
        (
            &["fk", "arm.bvh", "-o", "out.xyz"],
            "no format writes .xyz files",
        ),
        (&["fk", "arm.bvh", "-o", "-"], "give --format"),
        (&["fk", "arm.bvh", "-o", "x.csv", "--compress"], "only .npz"),
        (&["convert", "arm.bvh", "arm.bvh"], "would be overwritten"),
        (
            &["fk", "sample:fly"],
            "the samples are walk, run, wave, arm",
        ),
    ] {
        let error = folder.fail(2, args);
        assert!(error.contains(wanted), "{args:?}: {error}");
    }
    assert_eq!(folder.names(), ["arm.bvh", "in/a.bvh"]);
    assert_eq!(folder.read("arm.bvh"), ARM);
}

#[test]
fn frames_and_joints_that_are_not_there_say_what_is() {
    let folder = Folder::with_arm();
    let error = folder.fail(1, &["fk", "arm.bvh", "--frames", "9"]);
    assert_eq!(
        error,
        "error: arm.bvh: frame 9 is past the end; the frames are 0..3\n"
    );
    let error = folder.fail(1, &["fk", "arm.bvh", "--joints", "Elbow"]);
    assert_eq!(
        error,
        "error: arm.bvh: no joint is called 'Elbow'; did you mean 'elbow'\n"
    );
    folder.fail(2, &["fk", "arm.bvh", "--frames", "5..2"]);
    folder.fail(2, &["fk", "arm.bvh", "--point", "elbow"]);
}

#[test]
fn a_closed_pipe_is_no_error() {
    let folder = Folder::with_arm();
    for args in [
        &["info", "--tree", "sample:walk"][..],
        &["fk", "sample:walk"],
        &["man"],
    ] {
        let mut command = folder.command();
        command
            .args(args)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{args:?}");
    }
}
