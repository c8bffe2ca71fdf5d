//! `posekit check` as a user runs it: exit codes, what it says, and the fields of its JSON.

use serde_json::Value;

use crate::harness::{ARM, Folder};

/// The arm over and over, with an Euler flip of the elbow for ten frames in the middle.
pub(crate) fn flipping_arm() -> String {
    let head = ARM.split("Frames:").next().unwrap();
    let mut text = format!("{head}Frames: 60\nFrame Time: 0.02\n");
    for frame in 0..60 {
        let turn = if (25..35).contains(&frame) { 360 } else { 0 };
        text += &format!("0 20 0 {frame} 0 0 0 0 {}\n", turn - frame);
    }
    text
}

/// The lines of a report that are about findings.
fn findings(report: &str) -> Vec<&str> {
    report
        .lines()
        .filter(|line| line.starts_with("  "))
        .collect()
}

fn json_lines(text: &str) -> Vec<Value> {
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn a_clean_file_has_nothing_suspicious() {
    let folder = Folder::with_arm();
    let report = folder.succeed(&["check", "sample:walk", "--min", "warning"]);
    assert_eq!(report.lines().next(), Some("sample:walk: 1 info"));
    assert!(findings(&report).is_empty(), "{report}");
}

#[test]
fn our_own_samples_have_no_warnings() {
    let folder = Folder::with_arm();
    for sample in ["walk", "run", "wave", "arm"] {
        let report = folder.succeed(&["check", &format!("sample:{sample}")]);
        let serious = findings(&report)
            .into_iter()
            .filter(|line| !line.trim_start().starts_with("info"));
        assert_eq!(serious.count(), 0, "{report}");
    }
}

#[test]
fn findings_stand_with_the_worst_first_and_say_what_to_do_next() {
    let folder = Folder::with_arm();
    let still = flipping_arm().replace("Frame Time: 0.02", "Frame Time: 0");
    folder.write("bad.bvh", still);
    let ran = folder.run(&["check", "bad.bvh"]);
    assert_eq!(ran.code, Some(1));
    assert_eq!(
        ran.stderr,
        "error: bad.bvh: not accepted because of the findings above\n"
    );
    let severities: Vec<&str> = findings(&ran.stdout)
        .iter()
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    let wanted = ["error", "warning", "info", "info", "info", "info"];
    assert_eq!(severities, wanted, "{}", ran.stdout);
    let heading = ran.stdout.lines().next();
    assert_eq!(heading, Some("bad.bvh: 1 error, 1 warning, 4 infos"));
    assert!(ran.stdout.contains("docs/check/CODE.md"), "{}", ran.stdout);
    assert!(
        ran.stdout.contains("posekit fix 'bad.bvh' -o fixed.bvh"),
        "{}",
        ran.stdout
    );
    let columns: Vec<Option<usize>> = findings(&ran.stdout)
        .iter()
        .map(|line| line.find("frames 25 to 35"))
        .collect();
    assert!(columns.contains(&Some(11)), "{}", ran.stdout);
}

#[test]
fn several_files_have_a_summary() {
    let folder = Folder::with_arm();
    folder.write("in/clean.bvh", ARM.replace("Time: 0.5", "Time: 0.04"));
    folder.write("in/flip.bvh", flipping_arm());
    let warned = ["check", "in", "--min", "warning", "--warn", "euler-flip"];
    let report = folder.succeed(&warned);
    let summary: Vec<&str> = report
        .lines()
        .skip_while(|line| !line.starts_with("2 files checked:"))
        .collect();
    assert!(
        summary[0].ends_with("; 1 with warnings or errors"),
        "{report}"
    );
    let flips = summary[2].split_whitespace().collect::<Vec<_>>().join(" ");
    let flip = std::path::Path::new("in").join("flip.bvh");
    let wanted = format!(
        "warning euler-flip 1 1 2 times in {}, frames 25 to 35",
        flip.display()
    );
    assert_eq!(flips, wanted, "{report}");
    let alone = folder.succeed(&["check", "in", "--summary", "--warn", "euler-flip"]);
    assert_eq!(alone.lines().next(), Some(summary[0]));
    assert!(!alone.contains("nothing suspicious"), "{alone}");
    assert!(!alone.contains("docs/check"), "{alone}");
    // Flips are information unless asked for, and only files with something worse are listed.
    let report = folder.succeed(&["check", "in"]);
    assert!(report.contains("; 0 with warnings or errors"), "{report}");
    assert!(!report.contains("flip.bvh: "), "{report}");
    let report = folder.succeed(&["check", "in", "--min", "info"]);
    assert!(report.contains("flip.bvh: "), "{report}");
    let quiet = folder.succeed(&["check", "in", "--min", "warning", "--quiet"]);
    assert!(!quiet.contains("files checked"), "{quiet}");
}

#[test]
fn a_code_that_is_denied_fails() {
    let folder = Folder::with_arm();
    folder.write("flip.bvh", flipping_arm());
    folder.succeed(&["check", "flip.bvh"]);
    folder.succeed(&["check", "flip.bvh", "--deny", "teleport"]);
    let error = folder.fail(1, &["check", "flip.bvh", "arm.bvh", "--deny", "euler-flip"]);
    assert_eq!(
        error,
        "error: flip.bvh: not accepted because of the findings above\n"
    );
    let error = folder.fail(2, &["check", "flip.bvh", "--deny", "no-such-code"]);
    assert!(error.contains("docs/check/README.md"), "{error}");
}

#[test]
fn what_cannot_be_read_fails_and_the_others_are_checked() {
    let folder = Folder::with_arm();
    folder.write("in/a.bvh", ARM);
    folder.write("in/b.bvh", "not a motion");
    let ran = folder.run(&["check", "in"]);
    assert_eq!(ran.code, Some(1));
    assert!(ran.stdout.contains("a.bvh: "), "{}", ran.stdout);
    assert!(ran.stderr.contains("1 of 2 failed"), "{}", ran.stderr);
}

#[test]
fn json_has_the_fields_of_the_guide() {
    let folder = Folder::with_arm();
    folder.write(
        "flip.bvh",
        flipping_arm().replace("Frames: 60", "Frames: 61"),
    );
    let lines = json_lines(&folder.succeed(&["check", "--json", "flip.bvh", "arm.bvh"]));
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0]["file"], "flip.bvh");
    let findings = lines[0]["findings"].as_array().unwrap();
    for finding in findings {
        let mut fields: Vec<&str> = finding
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        fields.sort_unstable();
        assert_eq!(
            fields,
            [
                "code",
                "column",
                "file",
                "frames",
                "joints",
                "line",
                "message",
                "page",
                "place",
                "severity",
                "share_of_height",
                "unit",
                "value"
            ]
        );
    }
    let of_code = |code: &str| {
        let found = findings.iter().find(|finding| finding["code"] == code);
        found.unwrap_or_else(|| panic!("{code}: {findings:#?}"))
    };
    let flip = of_code("euler-flip");
    assert_eq!(flip["severity"], "info");
    assert_eq!(flip["joints"], serde_json::json!(["elbow"]));
    assert_eq!(
        flip["frames"],
        serde_json::json!({ "first": 25, "last": 35 })
    );
    assert_eq!(flip["unit"], "occurrences");
    assert_eq!(flip["page"], "docs/check/euler-flip.md");
    assert!(flip["line"].is_null());
    let count = of_code("frame-count-mismatch");
    assert_eq!(count["line"], 17);
    assert!(count["frames"].is_null());
}

#[test]
fn the_worst_of_a_code_comes_first_and_information_takes_one_line() {
    let folder = Folder::with_arm();
    // Two joints that flip, the elbow once more often.
    let mut text = flipping_arm().replace("0 20 0 40 0 0", "0 20 0 400 0 0");
    text = text.replace("0 20 0 50 0 0", "0 20 0 410 0 0");
    folder.write("flip.bvh", &text);
    let report = folder.succeed(&["check", "flip.bvh", "--warn", "euler-flip"]);
    let flips: Vec<&str> = report
        .lines()
        .filter(|line| line.contains("[euler-flip]"))
        .collect();
    assert_eq!(flips.len(), 2, "{report}");
    assert!(flips[0].contains("base: "), "{report}");
    assert!(flips[1].contains("elbow: "), "{report}");
    let json = folder.succeed(&["check", "flip.bvh", "--summary", "--json"]);
    let summary = &json_lines(&json)[0];
    assert_eq!(summary["files"], 1);
    let flips = summary["codes"].as_array().unwrap();
    let flips = flips
        .iter()
        .find(|code| code["code"] == "euler-flip")
        .unwrap();
    assert_eq!(
        (&flips["findings"], &flips["worst"]["value"]),
        (&2.into(), &4.0.into())
    );
    assert_eq!(flips["worst"]["file"], "flip.bvh");
}

#[test]
fn other_programs_are_judged_file_by_file() {
    let folder = Folder::with_arm();
    let report = folder.succeed(&[
        "check",
        "sample:walk",
        "--for",
        "three,blender,bvhio,assimp",
    ]);
    assert_eq!(report.lines().count(), 4, "{report}");
    assert!(
        report
            .lines()
            .all(|line| line.ends_with("reads it correctly")),
        "{report}"
    );
    // The arm's root has an OFFSET and position channels.
    let ran = folder.run(&["check", "arm.bvh", "--for", "three"]);
    assert_eq!(ran.code, Some(1));
    assert_eq!(
        ran.stderr,
        "error: arm.bvh in three.js: not read correctly, see above\n"
    );
    assert!(
        ran.stdout
            .contains("adds the OFFSET to the position channels (base)"),
        "{}",
        ran.stdout
    );
    assert!(
        ran.stdout
            .contains("posekit convert --for three sets the OFFSET of base to zero"),
        "{}",
        ran.stdout
    );
    folder.succeed(&["convert", "arm.bvh", "three.bvh", "--for", "three"]);
    folder.succeed(&["check", "three.bvh", "--for", "three"]);
    let positions =
        |name: &str| folder.succeed(&["fk", name, "-o", "-", "--format", "csv", "--quiet"]);
    assert_eq!(positions("arm.bvh"), positions("three.bvh"));
    let ran = folder.run(&[
        "check",
        "--json",
        "arm.bvh",
        "missing.bvh",
        "--for",
        "three",
    ]);
    let lines = json_lines(&ran.stdout);
    assert_eq!(lines[0]["readings"][0]["effect"], "misread");
    assert_eq!(lines[1]["error"], "missing.bvh: no such file");
    folder.fail(2, &["check", "arm.bvh", "--for", "maya"]);
}

#[test]
fn root_offset_says_where_the_figure_is() {
    // A figure with feet whose root OFFSET lifts it off the floor if it is added.
    let folder = Folder::with_arm();
    folder.succeed(&["sample", "walk", "-o", "walk.bvh"]);
    let text = folder.read("walk.bvh");
    let at = text.find("OFFSET").unwrap();
    let end = at + text[at..].find('\n').unwrap();
    let lifted = format!("{}OFFSET 0 100 0{}", &text[..at], &text[end..]);
    folder.write("lifted.bvh", lifted);
    let has_floor = |args: &[&str]| {
        let lines = json_lines(&folder.succeed(args));
        let findings = lines[0]["findings"].as_array().unwrap();
        findings
            .iter()
            .any(|finding| finding["code"] == "floor-not-at-zero")
    };
    assert!(!has_floor(&["check", "--json", "lifted.bvh"]));
    assert!(has_floor(&[
        "check",
        "--json",
        "lifted.bvh",
        "--root-offset",
        "add"
    ]));
    folder.fail(2, &["check", "lifted.bvh", "--root-offset", "maybe"]);
}

#[test]
fn open_ends_are_one_finding() {
    let folder = Folder::with_arm();
    let open = "JOINT hand { OFFSET 1 0 0 CHANNELS 0 End Site { OFFSET 0 0 0 } }";
    let two = format!("{open}\n{}\nEnd Site", open.replace("hand", "thumb"));
    folder.write("open.bvh", ARM.replace("End Site", &two));
    let lines = json_lines(&folder.succeed(&["check", "--json", "open.bvh"]));
    let findings = lines[0]["findings"].as_array().unwrap();
    let ends: Vec<&Value> = findings
        .iter()
        .filter(|finding| finding["code"] == "zero-length-end-site")
        .collect();
    assert_eq!(ends.len(), 1, "{findings:#?}");
    assert_eq!(ends[0]["joints"], serde_json::json!(["hand", "thumb"]));
    assert_eq!(ends[0]["value"], 2.0);
}

#[test]
fn the_table_says_which_axis_was_taken_as_up_where_it_is_not_plain_y() {
    let folder = Folder::with_arm();
    folder.succeed(&["convert", "sample:walk", "in/y.bvh", "--quiet"]);
    for (name, end) in [("a", "1s"), ("b", "2s")] {
        let (file, range) = (format!("in/{name}.bvh"), format!("0s..{end}"));
        folder.succeed(&[
            "convert",
            "sample:walk",
            &file,
            "--up",
            "z",
            "--trim",
            &range,
            "--quiet",
        ]);
    }
    let first = std::path::Path::new("in").join("a.bvh");
    let line = format!(
        "Z is taken as up in 2 files ({} and 1 more); --up chooses another axis",
        first.display()
    );
    for args in [&["check", "in"][..], &["check", "in", "--summary"]] {
        let report = folder.succeed(args);
        assert!(report.lines().any(|it| it == line), "{report}");
    }
    let alone = folder.succeed(&["check", "in/y.bvh", "--summary"]);
    assert!(!alone.contains("as up"), "{alone}");
    let said = folder.succeed(&["check", "in/a.bvh", "--summary", "--up", "z"]);
    assert!(
        said.contains("Z is taken as up in in/a.bvh, as --up says\n"),
        "{said}"
    );
    let json = folder.succeed(&["check", "in", "--summary", "--json"]);
    let up = &json_lines(&json)[0]["up"];
    assert_eq!((&up["y"], &up["z"]), (&1.into(), &2.into()));
}
