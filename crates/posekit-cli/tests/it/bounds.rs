//! A little input does not take much memory: what is too much is refused, and what is asked for is made alone.

use crate::harness::{ARM, Folder};

/// Ten million frames in a few lines: far more than is baked at once.
const ENDLESS: &str = "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 100000]\nframes_per_sec = 100\n\
    [skeleton]\njoints = [ { name = \"a\", translation = [0, 0, 0] }, \
    { name = \"b\", parent = \"a\", translation = [0, 1, 0] }, \
    { name = \"e\", parent = \"b\", translation = [0, 1, 0], end_site = true } ]\n\
    [[track]]\njoint = \"a\"\nproperty = \"translation\"\n\
    keys = [ { at = 0, value = [0, 1, 0], curve = \"linear\" }, { at = 100000, value = [100000, 1, 0] } ]\n";

/// The same for two seconds.
fn short() -> String {
    ENDLESS.replace("range_secs = [0, 100000]", "range_secs = [0, 2]")
}

#[test]
fn a_scene_of_millions_of_frames_is_refused_where_all_of_them_would_be_held() {
    let folder = Folder::with_arm();
    folder.write("long.posekit.toml", ENDLESS);
    for args in [
        "info long.posekit.toml",
        "check long.posekit.toml",
        "fk long.posekit.toml",
        "fk long.posekit.toml -o out.csv",
        "fk long.posekit.toml -o out.csv --frames 5..",
        "convert long.posekit.toml out.bvh",
        "ik long.posekit.toml --end e --offset 0,0,0",
        "render long.posekit.toml -o out.mp4",
        "render long.posekit.toml -o out.png --contact-sheet 3",
        "inbetween long.posekit.toml --keep 10",
    ] {
        let words: Vec<&str> = args.split(' ').collect();
        let error = folder.fail(1, &words);
        assert!(
            error.contains("frames of 3 joints are too many at once") && error.contains("--frames"),
            "{args}: {error}"
        );
    }
    assert_eq!(folder.names(), ["arm.bvh", "long.posekit.toml"]);
}

#[test]
fn the_frames_that_are_asked_for_are_those_of_the_whole_scene() {
    let folder = Folder::with_arm();
    folder.write("long.posekit.toml", ENDLESS);
    folder.write("short.posekit.toml", short());
    let table = |name: &str, frames: &str| {
        let args = ["fk", name, "-o", "-", "--format", "csv", "--frames", frames];
        folder.succeed(&args)
    };
    // The root goes one unit a second: at frame 150 it is at 1.5, at 1.5 s.
    let rows = table("long.posekit.toml", "150,9999900");
    let cells: Vec<Vec<&str>> = rows
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect())
        .collect();
    assert_eq!(cells[0][..3], ["150", "1.5", "1.5"], "{rows}");
    assert_eq!(cells[1][..3], ["9999900", "99999", "99999"], "{rows}");
    for frames in ["0", "7..20:3", "5,2", "190.."] {
        let whole: Vec<String> = folder
            .succeed(&["fk", "short.posekit.toml", "-o", "-", "--format", "csv"])
            .lines()
            .map(str::to_owned)
            .collect();
        let part = table("short.posekit.toml", frames);
        for row in part.lines() {
            assert!(whole.iter().any(|it| it == row), "{frames}: {row}");
        }
    }
    let text = folder.succeed(&[
        "fk",
        "long.posekit.toml",
        "-o",
        "-",
        "--format",
        "json",
        "--frames",
        "300..302",
    ]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["frames"], serde_json::json!([300, 301]));
    assert_eq!(json["positions"].as_array().unwrap().len(), 2);
    let summary = folder.succeed(&["fk", "long.posekit.toml", "--frames", "100..301:100"]);
    assert!(
        summary.contains("3 joints, 3 frames") && summary.contains("2 s"),
        "{summary}"
    );
    folder.succeed(&["fk", "long.posekit.toml", "--rest"]);
    let error = folder.fail(1, &["fk", "long.posekit.toml", "--frames", "10000001"]);
    assert!(
        error.contains("past the end; the frames are 0..10000001"),
        "{error}"
    );
}

#[test]
fn a_picture_of_a_scene_too_long_to_bake_is_of_its_frame() {
    let folder = Folder::with_arm();
    folder.write("long.posekit.toml", ENDLESS);
    let draw = |frames: &[&str]| {
        let args = [
            "render",
            "long.posekit.toml",
            "-o",
            "out.png",
            "--size",
            "64x48",
            "--renderer",
            "cpu",
        ];
        let ran = folder.run(&[&args[..], frames].concat());
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        ran.stderr
    };
    let said = draw(&["--frames", "9999900"]);
    assert!(said.contains("9999900..9999901"), "{said}");
    assert!(draw(&[]).contains("5000000..5000001"));
    draw(&["--rest"]);
}

#[test]
fn keys_are_baked_a_piece_at_a_time_to_the_same_file() {
    let folder = Folder::with_arm();
    // Some pieces: 131,072 joints at once are 43,690 frames.
    let scene = ENDLESS.replace("range_secs = [0, 100000]", "range_secs = [0, 1000]");
    folder.write("some.posekit.toml", scene);
    folder.succeed(&["keys", "bake", "some.posekit.toml", "-o", "some.bvh"]);
    folder.succeed(&["convert", "some.posekit.toml", "whole.bvh"]);
    assert_eq!(folder.read("some.bvh"), folder.read("whole.bvh"));
    assert!(folder.read("some.bvh").contains("Frames: 100001\n"));
}

/// So many chains of so many joints, one below the other.
fn chains(count: usize, joints: usize) -> String {
    let mut text =
        "HIERARCHY\nROOT root\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
            .to_owned();
    for chain in 0..count {
        for joint in 1..=joints {
            text += &format!("JOINT c{chain}j{joint}\n{{\nOFFSET 0.1 0.1 {chain}\nCHANNELS 0\n");
        }
        text += "End Site\n{\nOFFSET 0 0.1 0\n}\n";
        text += &"}\n".repeat(joints);
    }
    text + "}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n"
}

/// A robot of so many links, one on the other.
fn robot(links: usize) -> String {
    let mut text = "<robot name=\"long\"><link name=\"l0\"/>".to_owned();
    for link in 1..links {
        let on = link - 1;
        text += &format!(
            "<link name=\"l{link}\"/><joint name=\"j{link}\" type=\"fixed\"><parent link=\"l{on}\"/><child link=\"l{link}\"/></joint>"
        );
    }
    text + "</robot>"
}

#[test]
fn the_tree_of_a_long_chain_and_its_text_are_as_long_as_the_chain() {
    let folder = Folder::with_arm();
    folder.write("long.urdf", robot(5000));
    let text = folder.succeed(&["info", "--tree", "long.urdf"]);
    assert!(text.len() < 5000 * 400, "{} bytes", text.len());
    assert!(text.contains("level 4999 l4999"), "no last link");
    assert!(text.contains("levels go down to 4999; those below 64 are not indented further"));
    folder.write("deep.bvh", chains(1, 1000));
    let text = folder.succeed(&["info", "--tree", "deep.bvh"]);
    assert!(text.len() < 1000 * 400, "{} bytes", text.len());
    assert!(text.contains("level 1000 c0j1000"), "no last joint");
    folder.succeed(&["convert", "deep.bvh", "again.bvh"]);
    let written = folder.read("again.bvh");
    assert!(written.len() < 1000 * 400, "{} bytes", written.len());
    let shallow = folder.succeed(&["info", "--tree", "arm.bvh"]);
    assert!(!shallow.contains("level "), "{shallow}");
}

#[test]
fn a_body_of_thousands_of_joints_is_drawn_as_bones() {
    let folder = Folder::with_arm();
    folder.write("many.bvh", chains(3, 700));
    let args = [
        "render",
        "many.bvh",
        "-o",
        "out.png",
        "--size",
        "64x48",
        "--renderer",
        "cpu",
    ];
    let ran = folder.run(&args);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let said = "drawn as bones, not as a body: it has more than 2,000 joints";
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
    let quiet = folder.run(&[&args[..], &["--style", "bones"]].concat());
    assert!(!quiet.stderr.contains("2,000 joints"), "{}", quiet.stderr);
}

#[cfg(target_os = "linux")]
#[test]
fn what_has_no_end_is_not_read_for_ever() {
    let folder = Folder::with_arm();
    let error = folder.fail(1, &["info", "/dev/zero"]);
    assert!(error.contains("/dev/zero: no end after 1 GiB"), "{error}");
    // A file of holes takes no room on the disk.
    let file = std::fs::File::create(folder.path().join("holes.bvh")).unwrap();
    file.set_len((4 << 30) + 1).unwrap();
    let error = folder.fail(1, &["info", "holes.bvh"]);
    assert!(error.contains("holes.bvh: is larger than 4 GiB"), "{error}");
}

#[test]
fn a_motion_file_is_read_whole_as_before() {
    let folder = Folder::with_arm();
    let ran = folder.run_with_input(&["info", "-"], ARM.as_bytes());
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
}
