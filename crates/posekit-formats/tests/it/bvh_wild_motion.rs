//! Motions as the wild writes them, each with the reason it is read as it is.

use crate::bvh_text::{HEAD, assert_at, assert_codes, import, values_with, with_rows};
use posekit::check::{CheckConfig, Severity};
use posekit::motion::PositionPolicy;
use posekit_formats::bvh::{self, ChangeCode, CheckEntry, FixConfig, ReadOptions, RowParser};
use posekit_formats::report::{ImportReport, WarningCode as Code};
use std::ops::ControlFlow;

const EIGHT: [f64; 8] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];

/// Every exporter spaces the two lines in its own way, and some exchange them.
#[test]
fn frames_and_frame_time_with_any_spacing() {
    let headers = [
        "Frames:2\nFrame Time:.5\n",
        "Frames :2\nFrame Time :0.5\n",
        "Frames:\t2\nFrame\tTime:\t0.5\n",
        "FRAMES: 2\nFRAME TIME: 5E-1\n",
        "Frames 2\nFrameTime: 0.5\n",
        "Frame Time: 0.5\nFrames: 2\n",
        "Frames: 2 Frame Time: 0.5\n",
        "  Frames:   2.0  \r\n  Frame   Time:   +0.5  \r\n",
    ];
    for header in headers {
        let import = import(format!("{HEAD}{header}1 2 3 4\n5 6 7 8\n"));
        assert_codes(&import, &[]);
        let motion = import.document.motion.unwrap();
        assert_eq!(
            (motion.frame_count, motion.frame_time_secs),
            (2, 0.5),
            "{header:?}"
        );
        assert_eq!(motion.values, EIGHT);
    }
}

/// What C's `printf`, Fortran and hands write; all exact.
#[test]
fn numbers_in_every_notation() {
    let rows = ".0083333 1.2E-05 -.5e+1 +7.\n-0 0000.10 1e22 123456789012345678901234567890\n";
    let values = values_with(with_rows(2, rows), &[Code::ValueOutOfRange]);
    assert_eq!(
        values,
        [
            0.0083333,
            1.2e-5,
            -5.0,
            7.0,
            -0.0,
            0.1,
            1e22,
            1.2345678901234568e29
        ]
    );
    assert!(values[4].is_sign_negative());
}

/// Rows are counted in values, so wrapped rows and rows that share a line are the same rows.
#[test]
fn wrapped_rows_and_several_on_a_line() {
    for rows in [
        "1 2\n3 4\n5 6\n7 8\n",
        "1 2 3 4 5 6 7 8\n",
        "1\n2 3\n4 5 6\n7 8",
        "1 2 3 4\n5 6\n7 8\n",
    ] {
        assert_eq!(values_with(with_rows(2, rows), &[Code::WrappedRows]), EIGHT);
    }
    let import = import(with_rows(2, "1 2 3 4 5\n6 7 8"));
    assert_at(&import, Code::WrappedRows, 19, 10, "4 values");
}

/// `%8.4f` glues numbers when one fills its field; a sign can only begin a number.
#[test]
fn glued_numbers() {
    let rows = "0.0-7.5 3 4\n1e-05-2+3-4e+1\n";
    let values = values_with(with_rows(2, rows), &[Code::GluedNumbers]);
    assert_eq!(values, [0.0, -7.5, 3.0, 4.0, 1e-5, -2.0, 3.0, -40.0]);
    let import = import(with_rows(2, rows));
    assert_at(&import, Code::GluedNumbers, 19, 4, "split");
    assert_eq!(import.report.count(Code::GluedNumbers), 4);
}

/// Ten thousand glued numbers are one fact, not ten thousand lines.
#[test]
fn repeats_are_counted() {
    let import = import(with_rows(10_000, &"1-2 3 4\n".repeat(10_000)));
    assert_eq!(import.report.count(Code::GluedNumbers), 10_000);
    assert!(import.report.warnings.len() < 20);
}

/// A German or French locale writes decimals with a comma, and then in the whole file.
#[test]
fn decimal_commas() {
    let text = with_rows(2, "0,5 -1,25 3 4,0\n5e-1 6,5E+1 ,5 8\n")
        .replace("OFFSET 0 5.5 0", "OFFSET 0,0 5,5 0,0")
        .replace("Frame Time: 0.1", "Frame Time: 0,0333333");
    // A comma with no digit before it could separate as well: both readings are written down here.
    let import = import(text.replace(" ,5 ", " 0,5 "));
    assert_codes(&import, &[Code::DecimalComma]);
    assert_at(&import, Code::DecimalComma, 8, 13, "whole file");
    assert_eq!(import.document.joints[1].offset, [0.0, 5.5, 0.0]);
    let motion = import.document.motion.unwrap();
    assert_eq!(motion.frame_time_secs, 0.0333333);
    assert_eq!(motion.values, [0.5, -1.25, 3.0, 4.0, 0.5, 65.0, 0.5, 8.0]);
}

/// A spreadsheet's commas separate: a comma after a decimal point, before a blank or two in one word.
#[test]
fn commas_that_separate() {
    for rows in [
        "1.0,2.0,3.0,4.0\n5.0,6.0,7.0,8.0\n",
        "1, 2, 3, 4\n5, 6, 7, 8\n",
        "1,2,3,4\n5,6,7,8\n",
    ] {
        let import = import(with_rows(2, rows));
        assert_codes(&import, &[Code::CommaSeparator]);
        assert_eq!(import.document.motion.unwrap().values, EIGHT, "{rows}");
    }
}

/// Counters that start at zero, and recordings stopped between frames: what is there is used.
#[test]
fn frames_off_by_a_row_either_way() {
    for frames in [1, 3] {
        let import = import(with_rows(frames, "1 2 3 4\n5 6 7 8\n"));
        assert_codes(&import, &[Code::FrameCountMismatch]);
        assert_at(&import, Code::FrameCountMismatch, 17, 9, "2 whole rows");
        assert_eq!(import.document.frame_count(), 2);
        assert_eq!(import.document.row(1), [5.0, 6.0, 7.0, 8.0]);
    }
}

/// Half a frame cannot be shown.
#[test]
fn a_partial_last_row() {
    let import = import(with_rows(3, "1 2 3 4\n5 6 7 8\n9 10"));
    assert_codes(&import, &[Code::PartialLastRow, Code::FrameCountMismatch]);
    assert_at(
        &import,
        Code::PartialLastRow,
        21,
        5,
        "2 values instead of 4",
    );
    assert_eq!(import.document.motion.unwrap().values, EIGHT);
}

/// A row that lost or gained a value would shift every later one: it goes, they stay.
#[test]
fn a_damaged_row_among_whole_ones() {
    for damaged in ["9 9 9", "9 9 9 9 9"] {
        let import = import(with_rows(3, &format!("1 2 3 4\n{damaged}\n5 6 7 8\n")));
        assert_codes(&import, &[Code::DamagedRow, Code::FrameCountMismatch]);
        assert_at(&import, Code::DamagedRow, 20, damaged.len() + 1, "dropped");
        assert_eq!(import.document.motion.unwrap().values, EIGHT);
    }
}

/// No frames is a motion of no frames, not a file without motion.
#[test]
fn zero_frames() {
    let import = import(with_rows(0, ""));
    assert_codes(&import, &[]);
    assert_eq!(import.document.motion.as_ref().unwrap().frame_count, 0);
    assert_eq!(bvh::read(&bvh::write(&import.document)).unwrap(), import);
}

/// Frames without channels are still frames: the count is all there is of them.
#[test]
fn frames_without_channels() {
    let import = import(
        "HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 0 End Site { OFFSET 0 1 0 } }
         MOTION Frames: 3 Frame Time: 0.1\n\n\n\n",
    );
    assert_codes(&import, &[]);
    assert_eq!(import.document.frame_count(), 3);
    assert!(import.document.row(2).is_empty());
    let again = bvh::read(&bvh::write(&import.document)).unwrap();
    assert_eq!(again.document, import.document);
}

/// After the last promised row anything may follow: signatures, notes, a second file.
#[test]
fn text_after_the_last_row() {
    for trailing in ["}\n", "END OF FILE\n", "nan nan\n", "\0\0\0", "\u{1a}"] {
        let import = import(with_rows(2, &format!("1 2 3 4\n5 6 7 8\n{trailing}")));
        assert_codes(&import, &[Code::TrailingText]);
        assert_at(&import, Code::TrailingText, 21, 1, "ignored");
        assert_eq!(import.document.motion.unwrap().values, EIGHT);
    }
}

/// Rows can be counted, and 30 frames a second is the format's first habit.
#[test]
fn header_lines_that_are_missing_or_make_no_sense() {
    let no_count = import(format!("{HEAD}Frame Time: 0.1\n1 2 3 4\n5 6 7 8\n"));
    assert_codes(&no_count, &[Code::MissingFrameCount]);
    assert_eq!(no_count.document.frame_count(), 2);
    for count in ["-1", "1.5"] {
        let import = import(format!("{HEAD}Frames: {count}\nFrame Time: 0.1\n1 2 3 4\n"));
        assert_codes(&import, &[Code::MissingFrameCount]);
        assert_at(&import, Code::MissingFrameCount, 17, 9, count);
    }
    let no_time = import(format!("{HEAD}Frames: 1\n1 2 3 4\n"));
    assert_codes(&no_time, &[Code::MissingFrameTime]);
    assert_eq!(no_time.document.motion.unwrap().frame_time_secs, 1.0 / 30.0);
}

/// The document says what the file says; whoever plays it needs a time that passes.
#[test]
fn a_frame_time_that_does_not_pass() {
    for time in ["0", "-0.1", "5e-324", "1e-10", "1e10", "1e300"] {
        let import = import(format!("{HEAD}Frames: 1\nFrame Time: {time}\n1 2 3 4\n"));
        assert_at(&import, Code::BadFrameTime, 18, 13, "kept");
        assert_eq!(
            import.document.motion.unwrap().frame_time_secs,
            time.parse::<f64>().unwrap()
        );
    }
}

/// Whoever plays it has one that can be divided by, or none.
#[test]
fn a_frame_time_that_cannot_be_is_none() {
    for (time, secs) in [("5e-324", 0.0), ("-1", 0.0), ("1e10", 0.0), ("1e-9", 1e-9)] {
        let import = import(format!("{HEAD}Frames: 1\nFrame Time: {time}\n1 2 3 4\n"));
        let motion = import.document.to_motion(PositionPolicy::Replace).unwrap();
        assert_eq!(motion.frame_time_secs(), secs);
        let found = bvh::check(
            &import.document,
            &import.report,
            PositionPolicy::Replace,
            &CheckConfig::default(),
        );
        let place = found
            .unwrap()
            .into_iter()
            .find(|it| it.code == "bad-frame-time");
        let place = place.map(|it| it.place.unwrap().to_string());
        let wanted = (secs == 0.0).then(|| "line 18, column 13".to_owned());
        assert_eq!(place, wanted);
    }
}

/// Values that no motion can be made of are kept, and every one of them is told with its place, whatever
/// parser meets it.
#[test]
fn values_beyond_the_range_have_places() {
    let head = HEAD.replace("0 5.5 0", "0 1e300 -2e12");
    let text = format!("{head}Frames: 2\nFrame Time: 0.1\n1 2 3 -1e39\n5 1000000000001 7 1e12\n");
    for row_parser in [RowParser::Fastest, RowParser::Portable, RowParser::Careful] {
        let options = ReadOptions {
            row_parser,
            ..ReadOptions::default()
        };
        let import =
            bvh::read_with(text.as_bytes(), options, |_| ControlFlow::Continue(())).unwrap();
        assert_codes(&import, &[Code::ValueOutOfRange]);
        let places = import.report.warnings.iter().map(|it| it.place.to_string());
        assert_eq!(
            places.collect::<Vec<_>>(),
            [
                "line 8, column 14",
                "line 8, column 20",
                "line 19, column 7",
                "line 20, column 3"
            ]
        );
        let motion = import.document.motion.as_ref().unwrap();
        assert_eq!(motion.values[3], -1e39);
        let gaps = import.document.values_out_of_range();
        let gaps: Vec<_> = gaps.iter().map(|gap| (gap.frame, gap.column)).collect();
        assert_eq!(gaps, [(0, 3), (1, 1)]);
        let error = import
            .document
            .to_motion(PositionPolicy::Replace)
            .unwrap_err();
        assert!(
            error.to_string().contains("`Chest` has an offset of 1e300"),
            "{error}"
        );
    }
}

/// The decimal comma that the rows decide is noted although they are read twice.
#[test]
fn rows_that_are_read_twice_keep_their_warnings() {
    let import = import(with_rows(1, "1,5 2 3 1e39\n"));
    assert_codes(&import, &[Code::DecimalComma, Code::ValueOutOfRange]);
    assert_eq!(import.document.row(0)[0], 1.5);
}

/// A check finds them, by joint, frame and place, and checks the rest of the file.
#[test]
fn a_check_takes_values_beyond_the_range() {
    let row = |frame: usize, x: f64| format!("{x} 2 3 {}\n", frame as f64);
    let rows: String = (0..40)
        .map(|f| row(f, if f == 7 || f == 9 { 1e39 } else { 0.5 }))
        .collect();
    let import = import(with_rows(40, &rows));
    let policy = PositionPolicy::Replace;
    let error = import.document.to_motion(policy).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("Xposition of joint `Hips` is 1e39 at frame 7"),
        "{error}"
    );
    let config = CheckConfig::default();
    let found = bvh::check(&import.document, &import.report, policy, &config).unwrap();
    let [beyond] = found
        .iter()
        .filter(|it| it.code == "value-out-of-range")
        .collect::<Vec<_>>()[..]
    else {
        panic!("{found:?}");
    };
    assert_eq!(beyond.severity, Severity::Error);
    assert_eq!(beyond.joints, ["Hips"]);
    assert_eq!(beyond.frames.map(|it| (it.first, it.last)), Some((7, 9)));
    assert_eq!(
        beyond.place.as_ref().unwrap().to_string(),
        "line 26, column 1"
    );
    assert_eq!(beyond.value, 2.0);
    let finite = |it: &CheckEntry| it.value.is_finite() && !it.message.contains("inf");
    assert!(found.iter().all(finite), "{found:?}");
    // Without a report there is no place, and the finding is there all the same.
    let found = bvh::check(&import.document, &ImportReport::default(), policy, &config).unwrap();
    assert!(
        found
            .iter()
            .any(|it| it.code == "value-out-of-range" && it.frames.is_some())
    );
}

/// A repair keeps them and says so, or fills them where that is asked for.
#[test]
fn a_repair_keeps_values_beyond_the_range() {
    let text = with_rows(3, "1 2 3 4\n1e39 2 3 4\n3 2 3 4\n");
    let mut import = import(&text);
    let config = FixConfig::default();
    let fixed = bvh::fix(text.as_bytes(), &import, &config).unwrap();
    let codes: Vec<_> = fixed.changes.iter().map(|change| change.code).collect();
    assert_eq!(codes, [ChangeCode::ValueKept]);
    assert_eq!(fixed.document, import.document);
    let gaps = import.document.values_out_of_range();
    bvh::bridge_gaps(&mut import.document, &gaps, 1).unwrap();
    assert_eq!(import.document.row(1), [2.0, 2.0, 3.0, 4.0]);
    let fixed = bvh::fix(text.as_bytes(), &import, &config).unwrap();
    assert_eq!(fixed.changes, []);
}

/// Room for values is what the rows need, or what the bytes could hold: eight bytes for every two.
#[test]
fn memory_stays_in_proportion() {
    for (frames, rows) in [(1000, 1000), (1001, 1000), (10, 5000), (0, 5000)] {
        let text = with_rows(frames, &"1 2 3 4\n".repeat(rows));
        let values = import(&text).document.motion.unwrap().values;
        assert_eq!(values.len(), 4 * rows);
        assert_eq!(values.capacity(), values.len());
        assert!(values.capacity() * 8 <= 4 * text.len());
    }
}

/// Several values of one line are one line to look at.
#[test]
fn a_line_is_named_once_among_those_alike() {
    let large = b"HIERARCHY\nROOT arm\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n\
        OFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n1e39 1e39 1e39\n1e39 1e39 0\n";
    let import = posekit_formats::bvh::read(large).unwrap();
    let entries = posekit_formats::bvh::reader_entries(&import.report);
    assert_eq!(entries.len(), 1);
    let message = &entries[0].message;
    assert!(
        message.ends_with("(and 4 more like it, lines 14, 15)"),
        "{message}"
    );
}
