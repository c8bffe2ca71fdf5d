//! How files are read: which axis is up when feet and floor are looked for, and options that a scene or a robot
//! has no use for.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::harness::Folder;

const SCENE: &str = "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 1]\nframes_per_sec = 10\n\
                     [skeleton]\nfile = \"arm.bvh\"\n[[motion]]\nfile = \"arm.bvh\"\n";

/// A walk whose floor is as far below zero as a child is tall, with a foot that goes through it.
fn sunken_walk(folder: &Folder) {
    folder.succeed(&["sample", "walk", "-o", "walk.bvh", "--quiet"]);
    let text = folder.read("walk.bvh");
    let (head, rows) = text.split_at(text.find("Frame Time").unwrap());
    let y = head
        .split_once("CHANNELS")
        .unwrap()
        .1
        .split_whitespace()
        .skip(1)
        .position(|word| word == "Yposition")
        .unwrap();
    let mut lines = rows.lines();
    let mut sunken = format!("{head}{}\n", lines.next().unwrap());
    for (frame, line) in lines.enumerate() {
        let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        let deeper = if (20..24).contains(&frame) { 0.2 } else { 0.0 };
        let height: f64 = words[y].parse().unwrap();
        words[y] = format!("{:.6}", height - 0.9 - deeper);
        sunken += &(words.join(" ") + "\n");
    }
    folder.write("sunken.bvh", sunken);
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// Code, joints and frames of what was found, and how large it is beside the figure.
fn found(object: &Value) -> BTreeSet<String> {
    let findings = object["findings"].as_array().unwrap();
    let is_of_motion = |finding: &&Value| finding["code"] != "euler-flip";
    let text = |finding: &Value| {
        let share = finding["share_of_height"].as_f64().unwrap_or(0.0);
        format!(
            "{} {} {} {share:.3}",
            finding["code"], finding["joints"], finding["frames"]
        )
    };
    findings.iter().filter(is_of_motion).map(text).collect()
}

#[test]
fn a_check_finds_the_floor_whichever_axis_is_up() {
    let folder = Folder::with_arm();
    sunken_walk(&folder);
    let of = |args: &[&str]| json(&folder.run(&[&["check", "--json"], args].concat()).stdout);
    let upright = of(&["sunken.bvh"]);
    assert_eq!(upright["up"], "y");
    let wanted = found(&upright);
    for code in ["floor-not-at-zero", "foot-below-floor"] {
        let is_there = |text: &String| text.contains(code);
        assert!(wanted.iter().any(is_there), "{code}: {wanted:?}");
    }
    for up in ["z", "x", "-z"] {
        let name = format!("up{up}.bvh");
        folder.succeed(&[
            "convert",
            "sunken.bvh",
            &name,
            &format!("--up={up}"),
            "--quiet",
        ]);
        let turned = of(&[&name]);
        assert_eq!(turned["up"], up);
        assert_eq!(turned["up_sureness"], "sure");
        assert_eq!(found(&turned), wanted, "{up}");
        // What was taken is said to people as well.
        let text = folder.run(&["check", &name]).stdout;
        assert!(
            text.contains("is up, because the rest pose stands along it"),
            "{text}"
        );
        // And whoever knows better says so.
        let lying = of(&[&name, "--up=y"]);
        assert_eq!(
            (&lying["up"], &lying["up_sureness"]),
            (&"y".into(), &"said".into())
        );
        assert_ne!(found(&lying), wanted, "{up}");
    }
    let text = folder.run(&["check", "sunken.bvh"]).stdout;
    assert!(!text.contains("--up"), "{text}");
}

/// Every command that has `--positions`, with what it needs besides; `view` is among them where there is a window.
const WITH_POSITIONS: [&str; 9] = [
    "check {}",
    "convert {} out.bvh",
    "fk {}",
    "ik {} --end elbow --target 0,1,0",
    "ik-study {} -o out.html",
    "inbetween {} --keep 2",
    "info {}",
    "keys reduce {} -o out.posekit.toml",
    "render {} -o out.png --size 32x32",
];

#[test]
fn what_a_scene_has_no_use_for_is_refused_and_not_ignored() {
    let folder = Folder::with_arm();
    folder.write("shot.posekit.toml", SCENE);
    let refused = |line: &str, option: &[&str], file: &str| {
        let args: Vec<&str> = line
            .split(' ')
            .map(|word| if word == "{}" { file } else { word })
            .collect();
        let ran = folder.run(&[&args[..], option].concat());
        assert_ne!(ran.code, Some(0), "{args:?} {option:?}: {}", ran.stdout);
        assert!(
            ran.stderr.contains(option[0]) && ran.stderr.contains(file),
            "{args:?} {option:?}: {}",
            ran.stderr
        );
        ran.stderr
    };
    for line in WITH_POSITIONS {
        let error = refused(line, &["--positions", "root=add"], "shot.posekit.toml");
        assert!(error.contains("is a scene"), "{line}: {error}");
    }
    for line in ["check {}", "render {} -o out.png --size 32x32"] {
        let error = refused(line, &["--up", "z"], "shot.posekit.toml");
        assert!(error.contains("is a scene"), "{line}: {error}");
    }
    // A scene beside a clip, too.
    let line = "render arm.bvh -o out.png --size 32x32 --overlay {}";
    for option in [["--up", "z"], ["--positions", "add"]] {
        refused(line, &option, "shot.posekit.toml");
    }
    assert!(
        !folder.names().iter().any(|name| name.starts_with("out")),
        "{:?}",
        folder.names()
    );
    // A robot has neither.
    folder.succeed(&["sample", "arm6", "-o", "arm6.urdf", "--quiet"]);
    for line in ["check {}", "info {}"] {
        let error = refused(line, &["--positions", "add"], "arm6.urdf");
        assert!(error.contains("is a robot"), "{line}: {error}");
    }
}

#[test]
fn every_command_that_reads_positions_as_it_is_told_is_in_the_list_above() {
    let folder = Folder::with_arm();
    let commands = [
        "check",
        "convert",
        "fix",
        "fk",
        "ik",
        "ik-study",
        "inbetween",
        "info",
        "keys bake",
        "keys print",
        "keys reduce",
        "render",
        "slerp",
    ];
    for command in commands {
        let words: Vec<&str> = command.split(' ').chain(["--help"]).collect();
        let has_option = folder.succeed(&words).contains("--positions");
        let is_listed = WITH_POSITIONS
            .iter()
            .any(|line| line.starts_with(&format!("{command} {{}}")));
        assert_eq!(has_option, is_listed, "{command}");
    }
}

/// A scene is played with Y up, whatever the rest pose of its figure says: so it is checked, and so it is drawn
/// beside others.
#[test]
fn the_world_of_a_scene_has_y_up() {
    let folder = Folder::with_arm();
    folder.succeed(&["sample", "walk", "-o", "walk.bvh", "--quiet"]);
    folder.succeed(&["convert", "walk.bvh", "zup.bvh", "--up", "z", "--quiet"]);
    folder.write("shot.posekit.toml", SCENE.replace("arm.bvh", "zup.bvh"));
    let checked = json(&folder.run(&["check", "--json", "shot.posekit.toml"]).stdout);
    assert_eq!(checked["up"], "y");
    let line =
        "render shot.posekit.toml -o a.png --overlay shot.posekit.toml --renderer cpu --size 64x64";
    let ran = folder.run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    assert!(
        !ran.stderr.contains("turned to stand on it"),
        "{}",
        ran.stderr
    );
}

/// Where a result cannot go is said before anything is read: reading and reducing may take minutes.
#[test]
fn an_output_that_cannot_be_is_refused_before_the_input_is_read() {
    let folder = Folder::with_arm();
    folder.write("broken.posekit.toml", "not a scene");
    folder.write("broken.bvh", "HIERARCHY\nnothing");
    let error = folder.fail(
        2,
        &[
            "keys",
            "reduce",
            "broken.posekit.toml",
            "-o",
            "broken.posekit.toml",
        ],
    );
    assert!(error.contains("would be overwritten"), "{error}");
    for line in [
        "convert broken.bvh broken.bvh",
        "fix broken.bvh -o broken.bvh",
        "ik broken.bvh --end elbow --target 0,1,0 -o broken.bvh",
        "inbetween broken.bvh --keep 2 -o broken.bvh",
    ] {
        let args: Vec<&str> = line.split(' ').collect();
        let error = folder.fail(2, &args);
        assert!(error.contains("would be overwritten"), "{line}: {error}");
    }
}
