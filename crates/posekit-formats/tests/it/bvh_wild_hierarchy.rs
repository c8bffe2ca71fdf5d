//! Hierarchies as the wild writes them, each with the reason it is read as it is.

use crate::bvh_text::{HEAD, assert_at, assert_codes, import, values_with, with_rows};
use posekit::motion::Channel::{self, Position, Rotation};
use posekit::motion::PositionPolicy;
use posekit::rotation::Axis::{X, Y, Z};
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{self, EndName};
use posekit_formats::report::WarningCode as Code;

/// One joint with the given inside of its braces, and no motion.
fn one_joint(inside: &str) -> String {
    format!("HIERARCHY\nROOT a\n{{\n{inside}\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\n")
}

fn channels(inside: &str) -> Vec<Channel> {
    import(one_joint(inside)).document.joints[0]
        .channels
        .clone()
}

/// Exporters disagree on the case of every keyword, and no two keywords differ in case alone.
#[test]
fn keywords_in_any_case() {
    let rows = "1 2 3 4\n";
    let sound = import(with_rows(1, rows));
    for text in [
        with_rows(1, rows).to_uppercase(),
        with_rows(1, rows).to_lowercase(),
    ] {
        let import = import(&text);
        assert_codes(&import, &[]);
        assert_eq!(import.document.motion, sound.document.motion);
        assert_eq!(
            import.document.joints[0].channels,
            sound.document.joints[0].channels
        );
    }
    assert_eq!(
        channels("OFFSET 0 0 0\nCHANNELS 2 XPOSITION XPosition"),
        [Position(X); 2]
    );
    assert_eq!(
        channels("OFFSET 0 0 0\nCHANNELS 1 zRotation"),
        [Rotation(Z)]
    );
}

/// The order of CHANNELS is the order of the values, and any order is somebody's.
#[test]
fn any_channel_order_and_count() {
    assert_eq!(
        channels("OFFSET 0 0 0\nCHANNELS 4 Yrotation Zposition Xrotation Xposition"),
        [Rotation(Y), Position(Z), Rotation(X), Position(X)]
    );
    assert_eq!(channels("OFFSET 0 0 0\nCHANNELS 0"), []);
    assert_eq!(
        channels("OFFSET 0 0 0\nCHANNELS 1 Yposition"),
        [Position(Y)]
    );
    assert_codes(
        &import(one_joint("OFFSET 0 0 0\nCHANNELS 0")),
        &[Code::MissingMotion],
    );
}

/// Different joints may have different orders and six channels each; columns follow the joints.
#[test]
fn different_orders_in_one_file() {
    let import = import(
        "HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 6 Zrotation Xrotation Yrotation Xposition Yposition Zposition
         JOINT b { OFFSET 0 1 0 CHANNELS 6 Xposition Yposition Zposition Xrotation Yrotation Zrotation
         JOINT c { OFFSET 0 1 0 CHANNELS 1 Yrotation End Site { OFFSET 0 1 0 } } } }
         MOTION Frames: 1 Frame Time: 1 1 2 3 4 5 6 7 8 9 10 11 12 13",
    );
    assert_codes(&import, &[]);
    let bvh = import.document;
    assert_eq!(bvh.joint_columns(1), 6..12);
    assert_eq!(bvh.column_starts(), [0, 6, 12, 13, 13]);
    assert_eq!(bvh.joints[1].channels[3], Rotation(X));
    assert_eq!(bvh.row(0)[bvh.joint_columns(2)], [13.0]);
}

/// The list is what the columns are made of; the number before it is often left wrong by hand edits.
#[test]
fn a_channel_count_that_disagrees_with_its_list() {
    let import = import(one_joint(
        "OFFSET 0 0 0\nCHANNELS 6 Zrotation Xrotation Yrotation",
    ));
    assert_eq!(import.document.joints[0].channels.len(), 3);
    assert_at(
        &import,
        Code::ChannelCountMismatch,
        5,
        1,
        "says 6 and lists 3",
    );
    assert_eq!(channels("OFFSET 0 0 0\nCHANNELS Zrotation"), [Rotation(Z)]);
}

/// A repeated channel has a column like any other: dropping it would shift all that follow.
#[test]
fn a_channel_listed_twice() {
    let import = import(one_joint("OFFSET 0 0 0\nCHANNELS 2 Zrotation Zrotation"));
    assert_eq!(import.document.joints[0].channels, [Rotation(Z); 2]);
    assert_at(&import, Code::DuplicateChannel, 5, 22, "twice");
}

/// Both lists promise columns.
#[test]
fn channels_given_twice() {
    let import = import(one_joint(
        "OFFSET 0 0 0\nCHANNELS 1 Zrotation\nCHANNELS 1 Xrotation",
    ));
    assert_eq!(
        import.document.joints[0].channels,
        [Rotation(Z), Rotation(X)]
    );
    assert_at(&import, Code::RepeatedChannels, 6, 1, "added");
}

/// A fixed joint is a joint; a leaf without End Site has a position, if no length.
#[test]
fn joints_without_channels_or_end_site() {
    let import = import("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nJOINT b\n{\nOFFSET 0 1 0\n}\n}\n");
    assert_codes(
        &import,
        &[
            Code::MissingChannels,
            Code::MissingEndSite,
            Code::MissingMotion,
        ],
    );
    assert_at(&import, Code::MissingEndSite, 5, 1, "`b`");
    assert_eq!(import.document.channel_count(), 0);
}

/// Zero is where a joint without OFFSET can only be.
#[test]
fn a_joint_without_offset_or_with_two() {
    let none = import(one_joint("CHANNELS 1 Zrotation"));
    assert_at(&none, Code::MissingOffset, 2, 1, "zero");
    assert_eq!(none.document.joints[0].offset, [0.0; 3]);
    let two = import(one_joint(
        "OFFSET 1 1 1\nOFFSET 0 2 0\nCHANNELS 1 Zrotation",
    ));
    assert_at(&two, Code::ExtraOffset, 5, 1, "last");
    assert_eq!(two.document.joints[0].offset, [0.0, 2.0, 0.0]);
    let long = import(one_joint("OFFSET 1 2 3 4 -5\nCHANNELS 1 Zrotation"));
    assert_at(&long, Code::ExtraOffset, 4, 14, "first three");
    assert_eq!(long.document.joints[0].offset, [1.0, 2.0, 3.0]);
}

/// Braces on the same line, tabs, CRLF and one-line files: layout never meant anything.
#[test]
fn layout_does_not_matter() {
    let sound = import(with_rows(2, "1 2 3 4\n5 6 7 8\n"));
    let text = with_rows(2, "1 2 3 4\n5 6 7 8\n");
    let variants = [
        text.replace("\n{", " {"),
        text.replace("\n  {", "{")
            .replace("\n{", "{")
            .replace("\n    {", "{"),
        text.replace("  ", "\t"),
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.trim_end().to_string(),
        text.replace(' ', "  \t "),
        text.replace('\n', "\n\n"),
    ];
    for variant in variants {
        let import = import(&variant);
        assert_codes(&import, &[]);
        assert_eq!(import.document, sound.document, "{variant:?}");
    }
}

/// On one line the rows are on one line too, which is worth a note and nothing more.
#[test]
fn a_file_of_one_line() {
    let sound = import(with_rows(2, "1 2 3 4\n5 6 7 8\n"));
    let import = import(with_rows(2, "1 2 3 4\n5 6 7 8\n").replace('\n', " "));
    assert_codes(&import, &[Code::WrappedRows]);
    assert_eq!(import.document, sound.document);
}

/// Windows editors put a byte order mark before anything they save as UTF-8.
#[test]
fn a_byte_order_mark() {
    let import = import(format!("\u{feff}{}", with_rows(1, "1 2 3 4")));
    assert_codes(&import, &[Code::ByteOrderMark]);
    assert_eq!(import.document.frame_count(), 1);
}

/// Names are bytes: whatever is between the keyword and the line's end or brace.
#[test]
fn names_with_anything_in_them() {
    let names: [&[u8]; 9] = [
        b"mixamorig:Hips",
        b"Bip01 L Thigh",
        b"a.b-c_d",
        "\u{9aa8}\u{76d6}".as_bytes(),
        b"caf\xe9",
        b"#1",
        b"arm#2",
        b"//",
        b"MOTION",
    ];
    for name in names {
        let sound = one_joint("OFFSET 0 0 0\nCHANNELS 0");
        let mut text = b"HIERARCHY\nROOT  ".to_vec();
        text.extend_from_slice(name);
        text.extend_from_slice(&sound.as_bytes()["HIERARCHY\nROOT a".len()..]);
        let first = bvh::read(&text).unwrap();
        assert_eq!(first.document.joints[0].name, name);
        assert_eq!(first.document.joints[1].name, [name, b"_end"].concat());
        let non_utf8 = std::str::from_utf8(name).is_err();
        assert_eq!(first.report.has(Code::NonUtf8Name), non_utf8);
        let second = bvh::read(&bvh::write(&first.document)).unwrap();
        assert_eq!(first.document, second.document);
    }
}

/// An exporter's empty name still marks a joint.
#[test]
fn a_joint_without_name() {
    let import =
        import("HIERARCHY\nROOT\n{\nOFFSET 0 0 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 1 0\n}\n}");
    assert_at(&import, Code::MissingName, 2, 1, "without a name");
    assert_eq!(import.document.joints[0].name, b"");
}

/// The document keeps what the file said; the skeleton tells duplicates apart.
#[test]
fn duplicate_names() {
    let import = import(
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT a\n{\nOFFSET 0 1 0\nCHANNELS 0\n\
         End Site\n{\nOFFSET 0 1 0\n}\n}\n}",
    );
    assert_at(&import, Code::DuplicateName, 6, 1, "`a` of joint 0");
    assert_eq!(import.document.joints[1].name, b"a");
}

/// Programs differ on whether a root's OFFSET adds to its position channels, so the reader keeps both.
#[test]
fn a_root_offset_that_is_not_zero() {
    let import = import(one_joint("OFFSET 1 2 3\nCHANNELS 1 Xposition"));
    assert_at(&import, Code::NonzeroRootOffset, 2, 1, "1 2 3");
    assert_eq!(import.document.joints[0].offset, [1.0, 2.0, 3.0]);
    let without_position = import_codes("OFFSET 1 2 3\nCHANNELS 1 Xrotation");
    assert_eq!(without_position, [Code::MissingMotion]);
}

fn import_codes(inside: &str) -> Vec<Code> {
    import(one_joint(inside))
        .report
        .warnings
        .iter()
        .map(|warning| warning.code)
        .collect()
}

/// Exporters that do not know a bone's length write zero: nothing is wrong with the joint.
#[test]
fn a_zero_length_end_site() {
    let text = HEAD.replace("OFFSET 0 2 0", "OFFSET 0 -0.0 0");
    let import = import(text.replace("MOTION\n", ""));
    assert_at(&import, Code::ZeroLengthEndSite, 10, 5, "`Chest_end`");
}

/// With channels its values are in the rows; with children it is their parent. So it is a joint.
#[test]
fn an_end_site_with_channels_or_children() {
    let text = HEAD.replace("OFFSET 0 2 0", "OFFSET 0 2 0\nCHANNELS 1 Yrotation");
    let with_channels = import(format!("{text}Frames: 1\nFrame Time: 1\n1 2 3 4 5\n"));
    assert_codes(
        &with_channels,
        &[Code::EndSiteAsJoint, Code::MissingEndSite],
    );
    assert!(!with_channels.document.joints[2].is_end_site);
    assert_eq!(with_channels.document.row(0).len(), 5);
    let text = HEAD.replace(
        "OFFSET 0 2 0",
        "OFFSET 0 2 0\nJOINT tip { OFFSET 0 1 0 CHANNELS 0 }",
    );
    let with_child = import(text.replace("MOTION\n", ""));
    assert!(with_child.report.has(Code::EndSiteAsJoint));
    assert_eq!(with_child.document.joints[3].parent, Some(2));
    assert_eq!(with_child.document.joints[2].name, b"Chest_end");
}

/// `End` can only begin an End Site, whatever follows it.
#[test]
fn an_end_site_with_a_name_of_its_own() {
    let import = import(
        HEAD.replace("End Site", "End effector")
            .replace("MOTION\n", ""),
    );
    assert_at(&import, Code::EndSiteWords, 10, 5, "`effector`");
    assert!(import.document.joints[2].is_end_site);
}

fn end_of(ending: &str) -> bvh::BvhJoint {
    let import = import(HEAD.replace("End Site", ending).replace("MOTION\n", ""));
    let end = import.document.joints[2].clone();
    let written = bvh::write(&import.document);
    assert_eq!(bvh::read(&written).unwrap().document, import.document);
    end
}

/// Two programs give End Sites names, each in its own way: they are read and written again.
#[test]
fn the_name_of_an_end_site_is_kept() {
    for (ending, name, end_name) in [
        ("End Site", "Chest_end", EndName::Implied),
        ("End Site # a comment", "Chest_end", EndName::Implied),
        ("End Site #name:", "Chest_end", EndName::Implied),
        ("End Site #name: TailTip", "TailTip", EndName::Comment),
        (
            "end site # Name : Tail #2 tip ",
            "Tail #2 tip",
            EndName::Comment,
        ),
        ("End Site TailTip", "TailTip", EndName::Word),
        ("End Site Tail tip // the last", "Tail tip", EndName::Word),
    ] {
        let end = end_of(ending);
        assert_eq!(
            (end.name().as_ref(), end.end_name),
            (name, end_name),
            "{ending}"
        );
        assert!(end.is_end_site);
    }
    let noted = import(
        HEAD.replace("End Site", "End Site #name: Tip")
            .replace("MOTION\n", ""),
    );
    assert_codes(&noted, &[Code::MissingMotion]);
}

#[test]
fn the_named_end_sites_of_a_real_exporter_are_written_again() {
    let Some(text) = crate::cases::bytes("named_end.bvh") else {
        return;
    };
    let document = bvh::read(&text).unwrap().document;
    let written = String::from_utf8(bvh::write(&document)).unwrap();
    for name in ["TailTip", "Foot_L_Nub"] {
        assert!(document.joints.iter().any(|joint| joint.name() == name));
        assert!(
            written.contains(&format!("\t\tEnd Site #name: {name}\n")),
            "{written}"
        );
    }
    // What is made from the motion has them too: scenes are baked so.
    let motion = document.to_motion(PositionPolicy::default()).unwrap();
    let made = bvh::Bvh::from_motion(&motion, EulerOrder::ZXY);
    assert_eq!(
        made.joints
            .iter()
            .map(|joint| &joint.name)
            .collect::<Vec<_>>(),
        document
            .joints
            .iter()
            .map(|joint| &joint.name)
            .collect::<Vec<_>>(),
    );
    assert_eq!(made.joints[2].end_name, EndName::Comment);
}

/// Several skeletons in one file, their columns one after another.
#[test]
fn several_roots() {
    let second =
        "ROOT other { OFFSET 0 0 0 CHANNELS 1 Yrotation End Site { OFFSET 0 1 0 } }\nMOTION\n";
    let import = import(HEAD.replace("MOTION\n", second) + "Frames: 1\nFrame Time: 1\n1 2 3 4 5\n");
    assert_at(&import, Code::SeveralRoots, 16, 1, "another root");
    assert_eq!(import.document.joints[3].parent, None);
    assert_eq!(
        import.document.row(0)[import.document.joint_columns(3)],
        [5.0]
    );
    let again = bvh::read(&bvh::write(&import.document)).unwrap();
    assert_eq!(again.document, import.document);
}

/// Where a joint stands says what it is.
#[test]
fn root_and_joint_exchanged() {
    let inside = import(HEAD.replace("JOINT", "ROOT").replace("MOTION\n", ""));
    assert_at(&inside, Code::MisplacedJoint, 6, 3, "child");
    assert_eq!(inside.document.joints[1].parent, Some(0));
    let outside = import(HEAD.replace("ROOT", "JOINT").replace("MOTION\n", ""));
    assert_at(&outside, Code::MisplacedJoint, 2, 1, "root");
    assert_eq!(outside.document.joints[0].parent, None);
}

/// A brace too many closes nothing, so nothing is lost by ignoring it.
#[test]
fn a_closing_brace_too_many() {
    let text = with_rows(1, "1 2 3 4\n").replace("}\nMOTION", "}\n}\nMOTION");
    assert_at(&import(&text), Code::ExtraClosingBrace, 16, 1, "ignored");
    assert_eq!(
        values_with(&text, &[Code::ExtraClosingBrace]),
        [1.0, 2.0, 3.0, 4.0]
    );
}

/// ROOT says enough.
#[test]
fn no_hierarchy_keyword() {
    let text = with_rows(1, "1 2 3 4\n").replace("HIERARCHY\n", "");
    assert_at(&import(&text), Code::MissingHierarchy, 1, 1, "ROOT");
}

/// A skeleton alone is a skeleton.
#[test]
fn no_motion_at_all() {
    let import = import(HEAD.replace("MOTION\n", ""));
    assert_codes(&import, &[Code::MissingMotion]);
    assert_eq!(import.document.motion, None);
    assert_eq!(import.document.frame_count(), 0);
}

/// Comments are no part of the format, but hands put them there.
#[test]
fn comments() {
    let text = format!("# made by hand\n{}", with_rows(1, "1 2 3 4 // done\n"))
        .replace("ROOT Hips", "ROOT Hips # the hip")
        .replace("OFFSET 0 5.5 0", "OFFSET 0 5.5 0; up");
    let import = import(&text);
    assert_codes(&import, &[Code::CommentSkipped]);
    assert_eq!(import.report.count(Code::CommentSkipped), 4);
    assert_at(&import, Code::CommentSkipped, 1, 1, "`# made by hand`");
    assert_eq!(import.document.joints[0].name, b"Hips");
    assert_eq!(import.document.row(0), [1.0, 2.0, 3.0, 4.0]);
}
