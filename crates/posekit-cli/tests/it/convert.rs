use crate::harness::Folder;

/// The rows of a BVH file.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let rows = text
        .lines()
        .skip_while(|line| !line.starts_with("Frame Time:"))
        .skip(1);
    rows.map(|row| {
        row.split_whitespace()
            .map(|cell| cell.parse().unwrap())
            .collect()
    })
    .collect()
}

#[test]
fn the_output_is_the_last_name_or_what_o_says_with_options_anywhere() {
    let folder = Folder::with_arm();
    for args in [
        &["convert", "arm.bvh", "a.bvh", "--scale", "2"][..],
        &["convert", "arm.bvh", "--scale", "2", "a.bvh"],
        &["convert", "--scale", "2", "arm.bvh", "a.bvh"],
        &["convert", "arm.bvh", "--scale", "2", "-o", "a.bvh"],
        &["convert", "-o", "a.bvh", "--scale", "2", "arm.bvh"],
        &["convert", "--output", "a.bvh", "arm.bvh", "--scale", "2"],
    ] {
        let ran = folder.run(args);
        assert_eq!(
            ran.stderr, "note: wrote a.bvh: 3 frames of 3 joints\n",
            "{args:?}"
        );
        assert!(folder.read("a.bvh").contains("OFFSET 0 4 0"), "{args:?}");
        std::fs::remove_file(folder.path().join("a.bvh")).unwrap();
    }
    let error = folder.fail(2, &["convert", "arm.bvh", "--scale", "2"]);
    assert!(error.contains("the output is missing"), "{error}");
    folder.write("in/b.bvh", crate::harness::ARM);
    folder.succeed(&["convert", "arm.bvh", "--scale", "2", "in", "out"]);
    assert!(folder.exists("out/arm.bvh") && folder.exists("out/b.bvh"));
}

#[test]
fn without_options_every_number_stays() {
    let folder = Folder::with_arm();
    folder.succeed(&["convert", "arm.bvh", "same.bvh"]);
    assert_eq!(
        rows(&folder.read("same.bvh")),
        rows(&folder.read("arm.bvh"))
    );
    folder.succeed(&["convert", "same.bvh", "again.bvh"]);
    assert_eq!(folder.read("again.bvh"), folder.read("same.bvh"));
}

#[test]
fn a_higher_rate_turns_by_slerp_and_keeps_old_frames() {
    let folder = Folder::with_arm();
    folder.succeed(&["convert", "arm.bvh", "fast.bvh", "--fps", "4"]);
    let text = folder.read("fast.bvh");
    assert!(text.contains("Frame Time: 0.25"), "{text}");
    let (fast, old) = (rows(&text), rows(&folder.read("arm.bvh")));
    assert_eq!(fast.len(), 5);
    for frame in 0..3 {
        assert_eq!(fast[2 * frame], old[frame]);
    }
    assert!(
        (fast[1][3] - 45.0).abs() < 1e-9 && (fast[3][6] + 45.0).abs() < 1e-9,
        "{text}"
    );
    assert_eq!(fast[3][0], 10.0625);
}

#[test]
fn a_trim_is_by_frame_or_by_time() {
    let folder = Folder::with_arm();
    for range in ["1..", "1..3", "0.5s..2s"] {
        folder.succeed(&["convert", "arm.bvh", "part.bvh", "--trim", range]);
        assert_eq!(
            rows(&folder.read("part.bvh")),
            rows(&folder.read("arm.bvh"))[1..],
            "{range}"
        );
    }
    let error = folder.fail(1, &["convert", "arm.bvh", "part.bvh", "--trim", "7..9"]);
    assert!(
        error.contains("arm.bvh: there are no frames 7..9 among 3"),
        "{error}"
    );
}

#[test]
fn scale_and_names_touch_what_they_name() {
    let folder = Folder::with_arm();
    let args = [
        "convert",
        "arm.bvh",
        "s.bvh",
        "--scale",
        "0.01",
        "--rename",
        "elbow=joint 2",
    ];
    folder.succeed(&args);
    let text = folder.read("s.bvh");
    assert!(
        text.contains("OFFSET 0 0.02 0") && text.contains("JOINT joint 2"),
        "{text}"
    );
    assert_eq!(
        rows(&text)[2],
        [0.10125, 0.2, 0.3, 90.0, 0.0, 0.0, -90.0, 0.0, 0.0]
    );
}

#[test]
fn six_channels_and_back_is_the_same_file() {
    let folder = Folder::with_arm();
    folder.succeed(&["convert", "arm.bvh", "same.bvh"]);
    folder.succeed(&["convert", "arm.bvh", "six.bvh", "--channels", "6"]);
    assert_eq!(rows(&folder.read("six.bvh"))[0].len(), 12);
    folder.succeed(&["convert", "six.bvh", "three.bvh", "--channels", "3"]);
    assert_eq!(folder.read("three.bvh"), folder.read("same.bvh"));
}

#[test]
fn up_and_order_move_joints_where_they_should_be() {
    let folder = Folder::with_arm();
    let args = [
        "convert",
        "sample:walk",
        "z.bvh",
        "--up",
        "z",
        "--order",
        "XYZ",
        "--from-up",
        "y",
    ];
    folder.succeed(&args);
    let frames = "0..200:40";
    let csv = |name: &str| -> Vec<Vec<f64>> {
        let args = ["fk", name, "-o", "-", "--format", "csv", "--frames", frames];
        let text = folder.succeed(&args);
        let rows = text.lines().skip(1);
        rows.map(|row| {
            row.split(',')
                .skip(2)
                .map(|cell| cell.parse().unwrap())
                .collect()
        })
        .collect()
    };
    for (y_up, z_up) in csv("sample:walk").iter().zip(csv("z.bvh")) {
        for (a, b) in y_up.chunks(7).zip(z_up.chunks(7)) {
            let gap = (a[0] - b[0]).abs() + (a[1] - b[2]).abs() + (a[2] + b[1]).abs();
            assert!(gap < 1e-4, "{a:?} {b:?}");
        }
    }
    // Turning back is exact: axes and signs change, never a digit.
    folder.succeed(&["convert", "sample:walk", "a.bvh"]);
    folder.succeed(&["convert", "a.bvh", "b.bvh", "--up", "z"]);
    folder.succeed(&["convert", "b.bvh", "c.bvh", "--up", "y"]);
    assert_eq!(folder.read("c.bvh"), folder.read("a.bvh"));
}

#[test]
fn joints_follow_another_files_order() {
    let folder = Folder::with_arm();
    let two = |first: &str, second: &str, row: &str| {
        let joint = |name: &str| {
            format!(
                "JOINT {name} {{ OFFSET 1 0 0 CHANNELS 1 Xrotation End Site {{ OFFSET 0 1 0 }} }}"
            )
        };
        format!(
            "HIERARCHY ROOT r {{ OFFSET 0 0 0 CHANNELS 1 Yrotation {} {} }}\nMOTION\nFrames: 1\n\
             Frame Time: 0.1\n{row}\n",
            joint(first),
            joint(second)
        )
    };
    folder.write("lr.bvh", two("left", "right", "1 2 3"));
    folder.write("rl.bvh", two("right", "left", "7 8 9"));
    folder.succeed(&["convert", "lr.bvh", "out.bvh", "--reorder-like", "rl.bvh"]);
    assert_eq!(rows(&folder.read("out.bvh")), [[1.0, 3.0, 2.0]]);
    let error = folder.fail(
        1,
        &["convert", "arm.bvh", "out.bvh", "--reorder-like", "rl.bvh"],
    );
    assert!(
        error.contains("is not under the same parent in both files"),
        "{error}"
    );
}

#[test]
fn options_that_make_no_sense_are_wrong_usage() {
    let folder = Folder::with_arm();
    for option in [
        ["--scale", "0"],
        ["--order", "XX"],
        ["--order", "XQ"],
        ["--trim", "x"],
    ] {
        let args = ["convert", "arm.bvh", "out.bvh", option[0], option[1]];
        folder.fail(2, &args);
    }
    assert_eq!(folder.names(), ["arm.bvh"]);
}

#[test]
fn a_name_that_another_joint_has_is_not_given_again() {
    let folder = Folder::with_arm();
    folder.succeed(&["sample", "walk", "-o", "walk.bvh"]);
    let rename = [
        "convert",
        "walk.bvh",
        "out.bvh",
        "--rename",
        "LeftHand=RightHand",
    ];
    assert_eq!(
        folder.fail(1, &rename),
        "error: walk.bvh: two joints would be called 'RightHand'\n"
    );
    assert!(!folder.exists("out.bvh"));
    let error = folder.fail(1, &["fk", "walk.bvh", "--joints", "*Paw"]);
    assert!(error.contains("no joint's name matches '*Paw'"), "{error}");
}
