//! Numbers that results would not be finite of: times and rates that nothing can be divided by, and lengths beyond
//! single precision. They are refused with their place, and no file that a command wrote holds one.

use crate::harness::{ARM, Folder};

/// The arm with another frame time.
fn arm_at(frame_time: &str) -> String {
    ARM.replace("Frame Time: 0.5", &format!("Frame Time: {frame_time}"))
}

#[test]
fn options_refuse_rates_and_times_beyond_the_range() {
    let folder = Folder::with_arm();
    for secs in ["5e-324", "1e-10", "1e10", "1e308", "0", "nan", "inf"] {
        for args in [
            &["convert", "arm.bvh", "-o", "out.bvh", "--frame-time"][..],
            &["fix", "arm.bvh", "-o", "out.bvh", "--frame-time"],
        ] {
            let ran = folder.run(&[args, &[secs]].concat());
            assert!(ran.code != Some(0), "{args:?} {secs}");
            assert!(
                ran.stderr.contains("outside 1e-9 to 1e9 s"),
                "{}",
                ran.stderr
            );
        }
    }
    folder.succeed(&["keys", "reduce", "arm.bvh", "-o", "arm.posekit.toml"]);
    for rate in ["1e-320", "1e-10", "1e300", "0", "nan"] {
        for args in [
            &["convert", "arm.bvh", "-o", "out.bvh", "--fps"][..],
            &["keys", "bake", "arm.posekit.toml", "-o", "out.bvh", "--fps"],
        ] {
            let ran = folder.run(&[args, &[rate]].concat());
            assert!(ran.code != Some(0), "{args:?} {rate}");
            assert!(ran.stderr.contains("outside 1e-9 to 1e9"), "{}", ran.stderr);
        }
        let args = ["render", "arm.bvh", "-o", "out.gif", "--fps", rate];
        assert!(folder.fail(2, &args).contains("from 1e-9 to 50"));
    }
    assert!(!folder.exists("out.bvh") && !folder.exists("out.gif"));
}

#[test]
fn a_frame_time_that_nothing_can_be_divided_by_counts_as_none() {
    let folder = Folder::with_arm();
    for time in ["5e-324", "1e-300", "1e300"] {
        folder.write("odd.bvh", arm_at(time));
        // All frames at one time are an error of their own.
        let found = folder.run(&["check", "odd.bvh"]).stdout;
        assert!(found.contains("bad-frame-time"), "{found}");
        assert!(found.contains("line 18, column 13"), "{found}");
        let info = folder.succeed(&["info", "odd.bvh"]);
        assert!(info.contains(&format!("frame time of {time} s")), "{info}");
        let csv = folder.succeed(&["fk", "odd.bvh", "-o", "-", "--format", "csv"]);
        let times: Vec<&str> = csv
            .lines()
            .skip(1)
            .filter_map(|row| row.split(',').nth(1))
            .collect();
        assert_eq!(times, ["0", "0", "0"]);
        folder.succeed(&[
            "convert",
            "odd.bvh",
            "-o",
            "right.bvh",
            "--frame-time",
            "0.5",
        ]);
        assert!(folder.read("right.bvh").contains("Frame Time: 0.5"));
        let refused = folder.fail(1, &["keys", "reduce", "odd.bvh", "-o", "odd.posekit.toml"]);
        assert!(refused.contains("no frame time"), "{refused}");
    }
}

/// The arm with other numbers in its first row, or another first OFFSET.
fn beyond() -> [(&'static str, String); 4] {
    let row = "10 20 30 0 0 0 0 0 0";
    let with_row = |first: &str| ARM.replace(row, first);
    [
        ("root", with_row("1e39 20 30 0 0 0 0 0 0")),
        ("alternates", with_row("-1e100 1e100 30 0 0 0 0 0 0")),
        ("angle", with_row("10 20 30 0 0 0 1e300 0 0")),
        ("offset", ARM.replace("OFFSET 0 2 0", "OFFSET 0 1e300 0")),
    ]
}

#[test]
fn no_command_writes_what_is_no_number() {
    let folder = Folder::with_arm();
    for (name, text) in beyond() {
        folder.write("odd.bvh", text);
        let (elbow, target) = ("elbow", "0,1,0");
        for args in [
            &["fk", "odd.bvh", "-o", "out.npz"][..],
            &["fk", "odd.bvh", "-o", "out.csv"],
            &["fk", "odd.bvh", "-o", "out.json"],
            &["fk", "odd.bvh"],
            &["info", "odd.bvh"],
            &["info", "--json", "odd.bvh"],
            &["render", "odd.bvh", "-o", "out.png"],
            &["keys", "reduce", "odd.bvh", "-o", "out.posekit.toml"],
            &[
                "ik",
                "odd.bvh",
                "-o",
                "out.bvh",
                "--end",
                "elbow_end",
                "--target",
                target,
            ],
        ] {
            let ran = folder.run(args);
            assert_eq!(
                ran.code,
                Some(1),
                "{name} {args:?}: {}{}",
                ran.stdout,
                ran.stderr
            );
            let says = &ran.stderr;
            assert!(
                says.contains("not within 1e12") || says.contains("1e12"),
                "{args:?}: {says}"
            );
            assert!(
                says.contains("base") || says.contains(elbow),
                "{args:?}: {says}"
            );
        }
        assert_eq!(folder.names(), ["arm.bvh", "odd.bvh"], "{name}");
        folder.fail(1, &["check", "odd.bvh"]);
        let found = folder.run(&["check", "--json", "odd.bvh"]).stdout;
        let object: serde_json::Value = serde_json::from_str(&found).unwrap();
        let findings = object["findings"].as_array().unwrap();
        let beyond: Vec<_> = findings
            .iter()
            .filter(|it| it["code"] == "value-out-of-range")
            .collect();
        assert_eq!(beyond.len(), 1, "{found}");
        assert_eq!(beyond[0]["severity"], "error");
        assert!(
            beyond[0]["line"].is_u64() && beyond[0]["column"].is_u64(),
            "{found}"
        );
        let fixed = folder.run(&["fix", "odd.bvh", "-o", "-"]);
        assert_eq!(fixed.code, Some(0), "{}", fixed.stderr);
        assert!(fixed.stderr.contains("value-kept"), "{}", fixed.stderr);
        // The document keeps the file's numbers, which are finite.
        let again = folder.succeed(&["convert", "odd.bvh", "-o", "-"]);
        assert!(
            !again.contains("inf") && !again.to_lowercase().contains("nan"),
            "{again}"
        );
    }
    // What lies beside the values that are too large is enough to fill them.
    folder.write("odd.bvh", &beyond()[0].1);
    folder.succeed(&[
        "fix",
        "odd.bvh",
        "-o",
        "whole.bvh",
        "--bridge-gaps",
        "--max-gap",
        "1",
    ]);
    folder.succeed(&["fk", "whole.bvh", "-o", "whole.csv"]);
    assert!(!folder.read("whole.csv").contains("inf"));
}

#[test]
fn a_curve_that_leaves_the_range_between_its_keys_is_refused() {
    let folder = Folder::with_arm();
    folder.write(
        "steep.posekit.toml",
        "format = \"posekit scene\"\nversion = 2\nrange_secs = [0, 1]\nframes_per_sec = 10\n[skeleton]\n\
         joints = [ { name = \"a\", translation = [0, 0, 0] }, { name = \"e\", parent = \"a\", translation = [0, 1, 0], end_site = true } ]\n\
         [[track]]\njoint = \"a\"\nproperty = \"translation\"\n\
         keys = [ { at = 0, value = [0, 0, 0], slope = [1e20, 0, 0] }, { at = 1, value = [1, 0, 0] } ]\n",
    );
    for args in [
        &["keys", "bake", "steep.posekit.toml", "-o", "out.bvh"][..],
        &["fk", "steep.posekit.toml", "-o", "out.csv"],
        &["render", "steep.posekit.toml", "-o", "out.png"],
    ] {
        let says = folder.fail(1, args);
        assert!(
            says.contains("joint 'a' at frame 1 farther away than 1e12"),
            "{says}"
        );
    }
    assert!(!folder.exists("out.bvh") && !folder.exists("out.csv"));
}
