//! The rules hold together, documents keep their motion, and the guide's table is this one.

use std::path::Path;

use posekit::motion::PositionPolicy;

use super::*;
use crate::bvh::{read, write};

/// A file with `body` in place of its hierarchy and one row for every number of `rows`.
fn file(body: &str, channels: usize, frames: usize) -> String {
    let mut text = format!("HIERARCHY\n{body}MOTION\nFrames: {frames}\nFrame Time: 0.04\n");
    for frame in 0..frames {
        let row: Vec<String> = (0..channels)
            .map(|column| format!("{}", ((frame * 7 + column * 13) % 31) as f64 - 11.5))
            .collect();
        text += &row.join(" ");
        text += "\n";
    }
    text
}

fn joint(keyword: &str, name: &str, offset: &str, channels: &str, inside: &str) -> String {
    let count = channels.split_whitespace().count();
    format!("{keyword} {name}\n{{\nOFFSET {offset}\nCHANNELS {count} {channels}\n{inside}}}\n")
}

const END: &str = "End Site\n{\nOFFSET 0 1 0\n}\n";
const XYZ: &str = "Xposition Yposition Zposition";
const ZXY: &str = "Zrotation Xrotation Yrotation";

/// A root and a joint below it.
fn two(root: (&str, &str, &str), below: (&str, &str, &str)) -> String {
    let inside = joint("JOINT", below.0, below.1, below.2, END);
    let body = joint("ROOT", root.0, root.1, root.2, &inside);
    let columns = [root.2, below.2].join(" ");
    file(&body, columns.split_whitespace().count(), 5)
}

/// A file for every peculiarity that a document can have.
fn peculiar_files() -> Vec<(Peculiarity, String)> {
    let six = &format!("{XYZ} {ZXY}");
    let hip = ("Hips", "0 0 0", six.as_str());
    let plain = two(hip, ("Knee", "0 1 0", ZXY));
    let below = |channels: &str| two(hip, ("Knee", "0 1 0", channels));
    let named = |name: &str| two(hip, (name, "0 1 0", ZXY));
    let two_roots = {
        let one = joint("ROOT", "Hips", "0 0 0", six, END);
        let other = joint("ROOT", "Ball", "1 0 0", six, END);
        file(&format!("{one}{other}"), 12, 3)
    };
    vec![
        (
            P::RootOffset,
            two(("Hips", "0 3 1", six), ("Knee", "0 1 0", ZXY)),
        ),
        (P::JointPositionsAndOffset, below(six)),
        (P::JointPositions, two(hip, ("Knee", "0 0 0", six))),
        (
            P::SomePositionsAndOffset,
            two(
                ("Hips", "0 3 1", &format!("Yposition {ZXY}")),
                ("Knee", "0 1 0", ZXY),
            ),
        ),
        (
            P::PositionsWithoutSixChannels,
            two(
                ("Hips", "0 0 0", &format!("{XYZ} Yrotation")),
                ("Knee", "0 1 0", ZXY),
            ),
        ),
        (
            P::RootPositionsNotXyz,
            two(
                (
                    "Hips",
                    "0 0 0",
                    &format!("Zposition Xposition Yposition {ZXY}"),
                ),
                ("Knee", "0 1 0", ZXY),
            ),
        ),
        (P::NoRotations, below("")),
        (P::FewRotations, below("Xrotation")),
        (P::OddRotations, below("Zrotation Xrotation Zrotation")),
        (
            P::OddRotations,
            two(
                (
                    "Hips",
                    "0 0 0",
                    &format!("Xposition Yposition {ZXY} Zrotation"),
                ),
                ("Knee", "0 1 0", ZXY),
            ),
        ),
        (P::BlankInName, named("Left Arm")),
        (
            P::SameFirstWord,
            two(("Left Hip", "0 0 0", six), ("Left Knee", "0 1 0", ZXY)),
        ),
        (P::DuplicateName, named("Hips")),
        (P::PathInName, named("mixamorig:Knee")),
        (P::PathInName, named("Knee.bones")),
        (P::BracketInName, named("Knee[0]")),
        (P::LongName, named(&"k".repeat(70))),
        (P::SeveralRoots, two_roots),
        (
            P::NoFrames,
            plain.split("MOTION").next().unwrap().to_owned(),
        ),
        (
            P::NoFrames,
            format!(
                "{}MOTION\nFrames: 0\nFrame Time: 0.04\n",
                plain.split("MOTION").next().unwrap()
            ),
        ),
        (P::NoFrameTime, plain.replace("0.04", "0")),
        (
            P::TooManyFramesAnnounced,
            plain.replace("Frames: 5", "Frames: 9"),
        ),
        (
            P::TooFewFramesAnnounced,
            plain.replace("Frames: 5", "Frames: 4"),
        ),
        (P::ChannelCapitals, plain.replace("Xposition", "XPOSITION")),
        (P::KeywordSpelling, plain.replace("Frames: ", "Frames:")),
        (P::Layout, plain.replace("Hips\n{", "Hips {")),
        (P::EndSiteName, plain.replace("End Site", "End Site Toe")),
        (P::OtherEnd, plain.replace("End Site", "End Toe")),
        (P::WrappedRows, plain.replacen("-11.5 1.5", "-11.5\n1.5", 1)),
        (P::ByteOrderMark, format!("\u{feff}{plain}")),
        (P::Repaired, plain.replace("MOTION", "# by hand\nMOTION")),
    ]
}

use Peculiarity as P;

#[test]
fn a_plain_file_is_read_right_everywhere() {
    let six = &format!("{XYZ} {ZXY}");
    let text = two(("Hips", "0 0 0", six), ("Knee", "0 1 0", ZXY));
    let import = read(text.as_bytes()).unwrap();
    for program in Program::ALL {
        assert_eq!(judge(program, text.as_bytes(), &import), [], "{program:?}");
        let mut adapted = import.document.clone();
        assert_eq!(adapt(&mut adapted, program), Ok(Vec::new()), "{program:?}");
        assert_eq!(adapted, import.document);
    }
}

#[test]
fn each_peculiarity_is_found_and_what_is_adapted_is_read_right() {
    for (wanted, text) in peculiar_files() {
        let import = read(text.as_bytes()).unwrap();
        let found = peculiarity::find(text.as_bytes(), &import);
        assert!(
            found.iter().any(|found| found.peculiarity == wanted),
            "{wanted:?}: {found:?}\n{text}"
        );
        for program in Program::ALL {
            let mut adapted = import.document.clone();
            match adapt(&mut adapted, program) {
                Ok(_) => assert_read_right(program, &adapted, &format!("{wanted:?}")),
                Err(_) => assert_eq!(adapted, import.document, "as it was"),
            }
            assert_same_places(
                &import.document,
                &adapted,
                &format!("{wanted:?} for {program:?}"),
            );
        }
    }
}

fn assert_read_right(program: Program, adapted: &Bvh, of: &str) {
    let bytes = write(adapted);
    let import = read(&bytes).unwrap();
    let left = judge(program, &bytes, &import);
    let serious = left
        .iter()
        .filter(|remark| remark.rule.effect > Effect::Renamed);
    assert_eq!(serious.count(), 0, "{of} for {program:?}: {left:?}");
}

/// Every joint of `before` is where it was in every frame of `after`, which may have a root more in front.
fn assert_same_places(before: &Bvh, after: &Bvh, of: &str) {
    let more = after.joints.len() - before.joints.len();
    let places = |bvh: &Bvh| bvh.to_motion(PositionPolicy::Replace).unwrap().to_global();
    let (old, new) = (places(before), places(after));
    for frame in 0..old.frame_count() {
        for joint in old.skeleton().joints() {
            let moved = posekit::skeleton::JointId::new(joint.index() + more);
            let away = old
                .position(frame, joint)
                .distance(new.position(frame, moved));
            assert!(away < 1e-4, "{of}: joint {} is {away} away", joint.index());
        }
    }
}

#[test]
fn what_a_program_cannot_hold_is_said() {
    let six = &format!("{XYZ} {ZXY}");
    let text = two(("Hips", "0 0 0", six), ("Knee", "0 1 0", six));
    let mut bvh = read(text.as_bytes()).unwrap().document;
    let obstacle = adapt(&mut bvh, Program::Pybvh).unwrap_err();
    assert!(obstacle.to_string().contains("'Knee' moves"), "{obstacle}");
}

#[test]
fn every_rule_is_the_only_one_of_its_kind_and_every_peculiarity_has_one() {
    for (index, rule) in RULES.iter().enumerate() {
        let same =
            |other: &Rule| (other.program, other.peculiarity) == (rule.program, rule.peculiarity);
        assert!(!RULES[..index].iter().any(same), "{rule:?}");
    }
    for peculiarity in Peculiarity::ALL {
        assert!(
            RULES.iter().any(|rule| rule.peculiarity == *peculiarity),
            "{peculiarity:?}"
        );
    }
}

/// The table of the guide, as Markdown.
fn table() -> String {
    let mut lines = vec!["| in the file |".to_owned(), "| --- |".to_owned()];
    for program in Program::ALL {
        lines[0] += &format!(" {} {} |", program.title(), program.version());
        lines[1] += " --- |";
    }
    for &peculiarity in Peculiarity::ALL {
        let mut line = format!("| {} |", peculiarity.title());
        for program in Program::ALL {
            let applies = |rule: &&Rule| (rule.program, rule.peculiarity) == (program, peculiarity);
            let cell = RULES.iter().find(applies).map_or(String::new(), |rule| {
                format!(" **{}**: {}", rule.effect.name(), rule.what)
            });
            line += &format!("{cell} |");
        }
        lines.push(line);
    }
    lines.join("\n")
}

#[test]
fn the_guide_has_this_table() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/conventions-elsewhere.md");
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains(&table()), "the table should be\n{}", table());
}
