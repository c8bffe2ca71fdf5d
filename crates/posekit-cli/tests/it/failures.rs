//! What goes wrong, in one line each.

use std::process::Stdio;

use crate::harness::{ARM, Folder};

#[test]
fn a_file_that_cannot_be_read_gets_its_line() {
    let folder = Folder::with_arm();
    folder.write("empty.bvh", "");
    folder.write("binary.bvh", b"JPEG\x02\x00\x00\x00");
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
    for (typed, meant) in [("Elbow", "elbow"), ("elbwo", "elbow"), ("bas", "base")] {
        let error = folder.fail(1, &["fk", "arm.bvh", "--joints", typed]);
        let wanted =
            format!("error: arm.bvh: no joint is called '{typed}'; did you mean '{meant}'\n");
        assert_eq!(error, wanted);
    }
    for args in [
        &["convert", "arm.bvh", "out.bvh", "--rename", "elbwo=knee"][..],
        &["ik", "arm.bvh", "--end", "elbwo", "--offset", "0,0,0"],
    ] {
        let error = folder.fail(1, args);
        assert!(error.contains("did you mean 'elbow'"), "{args:?}: {error}");
    }
    let error = folder.fail(2, &["fk", "sample:wakl"]);
    assert!(error.contains("did you mean sample:walk"), "{error}");
    let error = folder.fail(2, &["check", "arm.bvh", "--deny", "euler-flips"]);
    assert!(error.contains("did you mean 'euler-flip'"), "{error}");
    folder.fail(2, &["fk", "arm.bvh", "--frames", "5..2"]);
    folder.fail(2, &["fk", "arm.bvh", "--point", "elbow"]);
}

#[test]
fn a_range_past_the_end_is_a_note() {
    let folder = Folder::with_arm();
    let note = "goes past the end, so it stops there: the frames are 0..3";
    for args in [
        &["fk", "arm.bvh", "--frames", "1..99"][..],
        &["convert", "arm.bvh", "out.bvh", "--trim", "1..99"],
        &[
            "ik",
            "arm.bvh",
            "--end",
            "elbow_end",
            "--offset",
            "0,-0.1,0",
            "--frames",
            "1..99",
        ],
        &["inbetween", "arm.bvh", "--at", "0..99:2"],
        &[
            "render",
            "arm.bvh",
            "--renderer",
            "cpu",
            "--size",
            "32x32",
            "--frames",
            "1..99",
            "-o",
            "a.gif",
        ],
    ] {
        let ran = folder.run(args);
        assert_eq!(ran.code, Some(0), "{args:?}: {}", ran.stderr);
        assert!(
            ran.stderr.contains("note: ") && ran.stderr.contains(note),
            "{args:?}: {}",
            ran.stderr
        );
        let quiet = folder.run(&[args, &["--quiet"]].concat());
        assert_eq!(quiet.stderr, "", "{args:?}");
    }
    let whole = folder.run(&["fk", "arm.bvh", "--frames", "0..3"]);
    assert_eq!(whole.stderr, "");
}

#[test]
fn output_for_programs_has_a_line_for_every_file() {
    let folder = Folder::with_arm();
    folder.write("bad.bvh", "not a motion");
    for command in ["info", "check", "fix"] {
        let mut args = vec![
            command, "--json", "bad.bvh", "arm.bvh", "none.bvh", "x*.bvh",
        ];
        if command == "fix" {
            args.push("--dry-run");
        }
        let ran = folder.run(&args);
        assert_eq!(ran.code, Some(1), "{command}");
        let lines: Vec<serde_json::Value> = ran
            .stdout
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        let files: Vec<&str> = lines
            .iter()
            .filter_map(|line| line["file"].as_str())
            .collect();
        // What a name stands for is settled first.
        assert_eq!(
            files,
            ["x*.bvh", "bad.bvh", "arm.bvh", "none.bvh"],
            "{command}"
        );
        assert_eq!(lines[3]["error"], "none.bvh: no such file", "{command}");
        assert!(lines[2]["error"].is_null(), "{command}");
    }
    let ran = folder.run(&[
        "ik", "bad.bvh", "--json", "--end", "elbow", "--offset", "0,0,0",
    ]);
    let line: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!((ran.code, &line["file"]), (Some(1), &"bad.bvh".into()));
    assert!(
        line["error"].as_str().unwrap().starts_with("bad.bvh:1:"),
        "{line}"
    );
}

#[test]
fn a_name_that_promises_something_else_is_not_written() {
    let folder = Folder::with_arm();
    folder.write(
        "scene.posekit.toml",
        folder.succeed(&["keys", "reduce", "arm.bvh", "-o", "-"]),
    );
    for args in [
        &["convert", "arm.bvh", "y.txt"][..],
        &["fix", "arm.bvh", "-o", "y.txt"],
        &[
            "ik",
            "arm.bvh",
            "--end",
            "elbow_end",
            "--offset",
            "0,0,0",
            "-o",
            "y.txt",
        ],
        &["keys", "bake", "scene.posekit.toml", "-o", "y.txt"],
        &["keys", "reduce", "arm.bvh", "-o", "y.txt"],
        &["inbetween", "arm.bvh", "--keep", "2", "-o", "y.txt"],
        &["sample", "walk", "-o", "y.txt"],
        &["sample", "arm6", "-o", "y.txt"],
    ] {
        let error = folder.fail(2, args);
        assert!(
            error.contains("does not write .txt files; name it ."),
            "{args:?}: {error}"
        );
        assert!(!folder.exists("y.txt"), "{args:?}");
    }
    folder.succeed(&["convert", "arm.bvh", "y.txt", "--format", "bvh"]);
    assert!(folder.read("y.txt").starts_with("HIERARCHY"));
}

#[test]
fn graphics_libraries_do_not_complain_where_nothing_is_shown() {
    let folder = Folder::with_arm();
    for args in [
        &[
            "render", "arm.bvh", "-o", "a.png", "--size", "32x32", "--quiet",
        ][..],
        &[
            "render",
            "arm.bvh",
            "-o",
            "b.png",
            "--size",
            "32x32",
            "--renderer",
            "cpu",
            "--quiet",
        ],
    ] {
        let mut command = folder.command();
        for name in [
            "XDG_RUNTIME_DIR",
            "NODEVICE_SELECT",
            "MESA_VK_DEVICE_SELECT",
            "DRI_PRIME",
        ] {
            command.env_remove(name);
        }
        let output = command.args(args).stdin(Stdio::null()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{args:?}");
    }
    assert_eq!(folder.names(), ["a.png", "arm.bvh", "b.png"]);
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
