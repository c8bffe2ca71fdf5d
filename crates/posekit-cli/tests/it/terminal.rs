//! Names from files on a terminal: shown, and not obeyed. What programs read is exact.

use std::process::Stdio;

use crate::harness::{ARM, Folder};

/// An escape sequence that the command itself never writes, a title, a direction mark, a line separator, a C1
/// control, and a mark of no width.
const NASTY: [(&str, &str); 2] = [
    ("base", "base\u{1b}[35mroot\u{1b}]0;title\u{7}"),
    ("elbow", "el\u{202e}b\u{2028}o\u{9b}31m\u{feff}w"),
];

fn nasty(text: &str) -> String {
    let mut text = text.to_owned();
    for (name, nasty) in NASTY {
        text = text.replace(name, nasty);
    }
    text
}

/// Runs with colours, as on a terminal, and gives both streams.
fn shown(folder: &Folder, args: &[&str]) -> String {
    let mut command = folder.command();
    command.args(["--color", "always"]).args(args);
    let output = command.stdin(Stdio::null()).output().unwrap();
    let text = [output.stdout, output.stderr].concat();
    String::from_utf8(text).unwrap()
}

/// What is left when the styles of the command's own are taken away.
fn without_styles(text: &str) -> String {
    let mut text = text.to_owned();
    for style in [
        "0", "1", "2", "31", "33", "36", "1;31", "1;33", "1;36", "32", "1;32", "4",
    ] {
        text = text.replace(&format!("\u{1b}[{style}m"), "");
    }
    text
}

fn assert_harmless(folder: &Folder, args: &[&str]) {
    let text = shown(folder, args);
    let text = without_styles(&text);
    let marks = ['\u{202e}', '\u{2028}', '\u{feff}'];
    let bad: Vec<char> = text
        .chars()
        .filter(|&c| marks.contains(&c) || c.is_control() && c != '\n')
        .collect();
    assert!(bad.is_empty(), "{args:?}: {bad:?} in {text}");
}

#[test]
fn names_do_not_move_the_cursor_or_turn_the_text() {
    let folder = Folder::with_arm();
    // Something to warn of, with a name in it: a second joint of the same name, and a frame count.
    let text = nasty(ARM).replace("Frames: 3", "Frames: 4");
    let file = "a\u{202e}b\u{1b}[35m.bvh";
    folder.write(file, &text);
    folder.write("plain.bvh", &text);
    let scene = folder.succeed(&["keys", "reduce", file, "-o", "-", "--quiet"]);
    folder.write("s\u{202e}.posekit.toml", scene);
    folder.write(
        "bad.posekit.toml",
        "format = \"posekit scene\"\nversion = 1\n\"a\u{202e}b\" = 1\n",
    );
    folder.write("lost.posekit.toml", "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 1]\nframes_per_sec = 2\n[skeleton]\nfile = \"no\u{202e}.bvh\"\n");
    folder.write("bad.json", "{\"x\u{202e}\": {\"no\u{202e}\": true}}");
    let robot = "<robot name=\"r\u{202e}\"><link name=\"a\u{202e}\"/><link name=\"b\u{1b}[35m\"/>\
                 <joint name=\"j\u{202e}\" type=\"revolute\"><parent link=\"a\u{202e}\"/>\
                 <child link=\"b\u{1b}[35m\"/></joint></robot>";
    folder.write("r\u{202e}.urdf", robot.replace('\u{1b}', "\u{200f}"));
    let end = "base";
    let end = nasty(end);
    for args in [
        &["info", file][..],
        &["info", "--tree", file],
        &["info", "--tree", file, "plain.bvh"],
        &["info", "--tree", "r\u{202e}.urdf"],
        &["check", file],
        &["check", "r\u{202e}.urdf"],
        &["check", file, "plain.bvh"],
        &["check", file, "--for", "blender,three,bvhio,assimp"],
        &["fk", file],
        &["fk", file, "plain.bvh"],
        &["fk", file, "--joints", "nobody"],
        &["fk", file, "-o", "o\u{202e}.csv"],
        &["fix", "--dry-run", file],
        &["fix", file, "-o", "f\u{202e}.bvh"],
        &["convert", file, "c\u{202e}.bvh"],
        &["convert", file, "c\u{202e}.bvh", "--rename", "nobody=x"],
        &["convert", "plain.bvh", file, "-o", "out/"],
        &["ik", file, "--end", "nobody", "--offset", "0,1,0"],
        &["ik", file, "--end", &end, "--offset", "0,1,0"],
        &[
            "ik", file, "--end", &end, "--offset", "0,1,0", "--limits", "bad.json",
        ],
        &["inbetween", file, "--keep", "2"],
        &["inbetween", file, "--keep", "2", "-o", "i\u{202e}.bvh"],
        &["keys", "print", "s\u{202e}.posekit.toml"],
        &["keys", "print", "bad.posekit.toml"],
        &[
            "keys",
            "bake",
            "s\u{202e}.posekit.toml",
            "-o",
            "b\u{202e}.bvh",
        ],
        &["keys", "bake", "lost.posekit.toml", "-o", "b.bvh"],
        &["keys", "reduce", file, "-o", "k\u{202e}.posekit.toml"],
        &[
            "render",
            file,
            "-o",
            "p\u{202e}.png",
            "--size",
            "16x16",
            "--renderer",
            "cpu",
        ],
        &["info", "none\u{202e}.bvh"],
        &["info", "none\u{202e}*.bvh"],
        &["info", "plain.bvh", "none\u{202e}.bvh"],
    ] {
        assert_harmless(&folder, args);
    }
}

#[test]
fn what_programs_read_is_exact() {
    let folder = Folder::with_arm();
    folder.write("n.bvh", nasty(ARM));
    let [base, elbow] = [nasty("base"), nasty("elbow")];
    let line = folder.succeed(&["info", "--json", "n.bvh"]);
    let json: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert_eq!(json["joints"][0]["name"], base.as_str());
    assert_eq!(json["joints"][1]["name"], elbow.as_str());
    let csv = folder.succeed(&["fk", "n.bvh", "-o", "-", "--format", "csv"]);
    assert!(csv.contains(&format!(",{base}.px,")), "{csv}");
    let scene = folder.succeed(&["keys", "reduce", "n.bvh", "-o", "-"]);
    folder.write("n.posekit.toml", scene);
    let keys = folder.succeed(&["keys", "print", "--csv", "n.posekit.toml"]);
    assert!(keys.contains(&format!("\"{base}\",rotation")), "{keys}");
    let line = folder.succeed(&["ik", "n.bvh", "--end", &base, "--offset", "0,1,0", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert_eq!(json["ends"][0], base.as_str());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said_in_one_line_and_with_exit_1() {
    let folder = Folder::with_arm();
    let full = || {
        std::fs::File::options()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    for args in [
        &["--help"][..],
        &["fk", "--help"],
        &["help", "render"],
        &["--version"],
        &["info", "arm.bvh"],
        &["man"],
        &["completions", "bash"],
        &["slerp", "--preset", "gimbal"],
        &["fk", "sample:walk", "-o", "-", "--format", "npz"],
        &["convert", "arm.bvh", "-"],
    ] {
        let mut command = folder.command();
        let output = command
            .args(args)
            .stdin(Stdio::null())
            .stdout(full())
            .output()
            .unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{args:?}: {error}");
        assert_eq!(
            error, "error: cannot write to standard output: the disk is full\n",
            "{args:?}"
        );
    }
    folder.succeed(&[
        "convert",
        "sample:walk",
        "long.bvh",
        "--fps",
        "2000",
        "--quiet",
    ]);
    for args in [
        &["fk", "long.bvh", "-o", "/dev/full", "--format", "npz"][..],
        &[
            "fk",
            "long.bvh",
            "-o",
            "/dev/full",
            "--format",
            "npz",
            "--compress",
        ],
        &["convert", "long.bvh", "/dev/full", "--format", "bvh"],
        &[
            "render",
            "arm.bvh",
            "-o",
            "/dev/full",
            "--format",
            "png",
            "--size",
            "64x36",
            "--renderer",
            "cpu",
        ],
        &[
            "render",
            "arm.bvh",
            "-o",
            "/dev/full",
            "--format",
            "gif",
            "--size",
            "64x36",
            "--renderer",
            "cpu",
        ],
    ] {
        let error = folder.fail(1, args);
        assert_eq!(
            error, "error: /dev/full: cannot write: the disk is full\n",
            "{args:?}"
        );
    }
}

/// What a command says about a value that it cannot take.
fn refusal(folder: &Folder, args: &[&str]) -> String {
    let error = folder.fail(2, args);
    error.lines().next().unwrap_or_default().to_owned()
}

#[test]
fn a_negative_number_is_a_value_and_not_an_option_that_nobody_meant() {
    let folder = Folder::with_arm();
    for (args, wanted) in [
        (
            &["convert", "arm.bvh", "o.bvh", "--fps", "-1"][..],
            "a rate of -1 frames a second is outside",
        ),
        (
            &["convert", "arm.bvh", "o.bvh", "--scale", "-2"],
            "a scale must be a number above zero, and this is -2",
        ),
        (
            &["convert", "arm.bvh", "o.bvh", "--trim", "-1..5"],
            "'-1' is neither a frame number nor a time",
        ),
        (
            &["fk", "arm.bvh", "--frames", "-1"],
            "'-1' is not a frame number",
        ),
        (&["fk", "arm.bvh", "-j", "-1"], "expected a whole number"),
        (
            &[
                "keys",
                "bake",
                "a.posekit.toml",
                "-o",
                "o.bvh",
                "--fps",
                "-1",
            ],
            "a rate of -1 frames a second is outside",
        ),
    ] {
        let error = refusal(&folder, args);
        assert!(error.contains(wanted), "{args:?}: {error}");
    }
}

#[test]
fn what_is_no_number_is_refused_in_plain_words() {
    let folder = Folder::with_arm();
    for (args, wanted) in [
        (
            &["convert", "arm.bvh", "o.bvh", "--fps", "abc"][..],
            "error: invalid value 'abc' for '--fps <RATE>': expected a number",
        ),
        (
            &["ik-study", "arm.bvh", "--iterations", "few"],
            "error: invalid value 'few' for '--iterations <COUNTS>': expected a whole number, without a sign",
        ),
        (
            &["ik-study", "arm.bvh", "--root", "home=0,1,0"],
            "error: invalid value 'home=0,1,0' for '--root <X,Y,Z>': expected three numbers, such as 0,0.93,0",
        ),
        (
            &[
                "ik-study", "arm.bvh", "--target", "a=1,1,1", "--target", "a=2,1,1",
            ],
            "error: two targets are called 'a'",
        ),
        (
            &["ik", "arm.bvh", "--end", "elbow", "--follow", "arm.bvh"],
            "error: expected a file and a joint, such as other.bvh:LeftHand",
        ),
    ] {
        assert_eq!(refusal(&folder, args), wanted);
    }
    let error = folder.fail(
        2,
        &["ik", "arm.bvh", "--end", "elbow", "--follow", "arm.bvh"],
    );
    assert!(!error.contains("Usage: posekit [OPTIONS]"), "{error}");
}

#[test]
fn a_file_of_another_kind_is_called_by_it() {
    let folder = Folder::with_arm();
    folder.succeed(&["sample", "planar2", "-o", "arm.urdf"]);
    folder.succeed(&["keys", "reduce", "arm.bvh", "-o", "a.posekit.toml"]);
    folder.write("a.toml", folder.read("a.posekit.toml"));
    folder.write("rig.glb", "glTF\u{2}\0\0\0");
    for (args, wanted) in [
        (
            &["fk", "arm.urdf"][..],
            "arm.urdf: is a robot (URDF), not a motion; posekit info, check and view take robots",
        ),
        (&["info", "rig.glb"], "rig.glb: is glTF"),
        (&["check", "rig.glb"], "rig.glb: is glTF"),
        (&["info", "a.toml"], "a.toml: is a scene"),
        (
            &["keys", "print", "arm.bvh"],
            "arm.bvh: is a motion (BVH), not a scene; posekit keys reduce makes a scene of a motion",
        ),
        (
            &["keys", "bake", "arm.urdf", "-o", "o.bvh"],
            "is a robot (URDF)",
        ),
    ] {
        let error = folder.fail(1, args);
        assert!(error.contains(wanted), "{args:?}: {error}");
    }
    let robot = folder.fail(2, &["info", "sample:arm6"]);
    assert!(robot.contains("sample:arm6 is a robot"), "{robot}");
}
