//! What is wrong with a file, and where.

use glam::DVec3;
use posekit::keyframe::{KeyedCamera, KeyedTransform, Property};
use posekit_formats::scene::{self, Camera, Prop, Scene, SceneProblemKind as Kind};

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
        "`[3, 2.5]`",
    );
    assert_refused(
        "= 24",
        "= 0",
        Kind::WrongValue,
        6,
        "frames_per_sec",
        "from 1e-9 to 10000",
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
        38,
        "track[1].keys[2]",
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

/// Times, rates and lengths that results would not be finite of are refused where they stand.
#[test]
fn numbers_beyond_the_range_have_a_place() {
    let scene = |range: &str, rate: &str, joint: &str, keys: &str| {
        format!(
            "format = \"posekit scene\"\nversion = 2\nrange_secs = {range}\nframes_per_sec = {rate}\n[skeleton]\n\
             joints = [ {{ name = \"a\", translation = {joint} }} ]\n[[track]]\njoint = \"a\"\n\
             property = \"translation\"\nafter = \"cycle with offset\"\nkeys = [\n{keys}\n]\n"
        )
    };
    let good = (
        "[0, 1]",
        "30",
        "[0, 0, 0]",
        "{ at = 0, value = [0, 0, 0] }, { at = 1, value = [1, 0, 0] }",
    );
    let read = |range, rate, joint, keys| scene::read(scene(range, rate, joint, keys).as_bytes());
    assert!(read(good.0, good.1, good.2, good.3).is_ok());
    let key = |at: &str, value: &str| {
        format!("{{ at = 0, value = [0, 0, 0] }},\n{{ at = {at}, value = [{value}, 0, 0] }}")
    };
    let (early, far, late) = (key("1e-300", "1"), key("1", "1e39"), key("1e10", "1"));
    let steep = good
        .3
        .replace("at = 1, value", "at = 1, slope = [1e300, 0, 0], value");
    for (range, rate, joint, keys, line, path) in [
        ("[0, 1e300]", good.1, good.2, good.3, 3, "range_secs"),
        (good.0, "1e-320", good.2, good.3, 4, "frames_per_sec"),
        (good.0, "1e300", good.2, good.3, 4, "frames_per_sec"),
        (
            good.0,
            good.1,
            "[0, 1e39, 0]",
            good.3,
            6,
            "skeleton.joints[0].translation",
        ),
        (
            good.0,
            good.1,
            good.2,
            early.as_str(),
            13,
            "track[0].keys[1]",
        ),
        (good.0, good.1, good.2, far.as_str(), 13, "track[0].keys[1]"),
        (
            good.0,
            good.1,
            good.2,
            late.as_str(),
            13,
            "track[0].keys[1]",
        ),
        (
            good.0,
            good.1,
            good.2,
            steep.as_str(),
            12,
            "track[0].keys[1]",
        ),
    ] {
        let error = read(range, rate, joint, keys).expect_err(path);
        let first = &error.problems[0];
        assert_eq!(
            (first.location.line, first.path.as_str()),
            (line, path),
            "{error}"
        );
    }
}

#[test]
fn a_scene_that_would_not_be_read_is_not_written() {
    let good = scene::read(NOD.as_bytes()).unwrap();
    let broken = |change: &dyn Fn(&mut Scene)| {
        let mut scene = good.clone();
        change(&mut scene);
        scene::write(&scene).is_err()
    };
    assert!(!broken(&|_| {}));
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        assert!(broken(&|scene| scene.range_secs[1] = bad));
        assert!(broken(&|scene| scene.frames_per_sec = bad));
        assert!(broken(&|scene| {
            scene.cameras.push(Camera {
                name: String::new(),
                view: KeyedCamera {
                    vertical_fov_deg: Property::Fixed(bad),
                    ..KeyedCamera::default()
                },
            });
        }));
        assert!(broken(&|scene| {
            scene.props.push(Prop {
                name: String::new(),
                shape: "box".to_owned(),
                transform: KeyedTransform {
                    scale: Property::Fixed(DVec3::splat(bad)),
                    ..KeyedTransform::default()
                },
            });
        }));
    }
    assert!(broken(&|scene| scene.frames_per_sec = 1e-320));
}

/// The inputs that users sent.
#[test]
fn cases_are_refused_with_a_place() {
    for (name, place) in [
        ("scene_fps_denormal.posekit.toml", ":4:18: frames_per_sec: "),
        ("scene_cycle_tiny_period.posekit.toml", ": track[0].keys["),
    ] {
        let Some(bytes) = crate::cases::bytes(name) else {
            return;
        };
        let error = scene::read(&bytes).expect_err(name).in_file(name);
        assert!(error.contains(place), "{error}");
    }
}

#[test]
fn values_that_are_drawn_as_others_are_warned_of() {
    let text = "format = \"posekit scene\"\nversion = 2\nskeleton = { file = \"a.bvh\" }\n\
                [[camera]]\nname = \"a\"\nvertical_fov_deg = 200\n[[camera]]\nname = \"a\"\n\
                [[light]]\nstrength = -1\ncolor = [255, 200, 0]\n\
                [[light]]\nstrength = 3\ncolor = [2, 1, 0]\n";
    let (_, warnings) = scene::read_with_warnings(text.as_bytes()).unwrap();
    let found: Vec<(usize, &str)> = warnings
        .iter()
        .map(|warning| (warning.location.line, warning.path.as_str()))
        .collect();
    assert_eq!(
        found,
        [
            (6, "camera[0].vertical_fov_deg"),
            (8, "camera[1].name"),
            (10, "light[0].strength"),
            (11, "light[0].color"),
        ]
    );
    assert!(warnings[0].message.contains("drawn as 170 degrees"));
}
