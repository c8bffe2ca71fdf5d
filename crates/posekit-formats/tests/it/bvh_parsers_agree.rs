//! The fast row parsers and the careful scanner say the same of everything: values to the bit, warnings
//! with their places, errors. Real files, generated rows, and both with random damage.

use std::ops::ControlFlow;

use crate::bvh_real_files::{bits, files};
use crate::bvh_text::with_rows;
use posekit_formats::bvh::{self, Bvh, Piece, ReadOptions, RowParser};
use posekit_formats::report::{Import, ReadError, WarningCode};
use proptest::prelude::*;

fn read(bytes: &[u8], row_parser: RowParser) -> Result<Import<Bvh>, ReadError> {
    bvh::read_with(
        bytes,
        ReadOptions {
            row_parser,
            ..ReadOptions::default()
        },
        |_| ControlFlow::Continue(()),
    )
}

/// Who works on pieces, and how long those are.
#[derive(Clone, Copy, Debug)]
enum Work {
    /// The last first.
    Backwards(usize),
    /// Every third is left out the second time.
    Some(usize),
    /// All on two threads.
    Threads(usize),
    /// None.
    Nobody(usize),
}

fn read_in_pieces(bytes: &[u8], work: Work) -> Result<Import<Bvh>, ReadError> {
    let (Work::Backwards(piece_bytes)
    | Work::Some(piece_bytes)
    | Work::Threads(piece_bytes)
    | Work::Nobody(piece_bytes)) = work;
    let mut calls = 0;
    bvh::read_in_pieces(
        bytes,
        ReadOptions::default(),
        piece_bytes,
        |_| ControlFlow::Continue(()),
        |pieces| {
            calls += 1;
            match work {
                Work::Backwards(_) => pieces.iter_mut().rev().for_each(Piece::work),
                Work::Some(_) => {
                    for (index, piece) in pieces.iter_mut().enumerate() {
                        if calls == 1 || index % 3 != 2 {
                            piece.work();
                        }
                    }
                }
                Work::Threads(_) => std::thread::scope(|threads| {
                    let half = pieces.len().div_ceil(2).max(1);
                    for part in pieces.chunks_mut(half) {
                        threads.spawn(|| part.iter_mut().for_each(Piece::work));
                    }
                }),
                Work::Nobody(_) => {}
            }
        },
    )
}

/// Checks that all parsers agree, and with reading in pieces of a few bytes to many; gives what they agree on.
fn agreed(bytes: &[u8]) -> Result<Import<Bvh>, ReadError> {
    let careful = read(bytes, RowParser::Careful);
    let same =
        |how: &dyn std::fmt::Debug, fast: Result<Import<Bvh>, ReadError>| match (&careful, &fast) {
            (Ok(careful), Ok(fast)) => {
                assert!(bits(&careful.document) == bits(&fast.document), "{how:?}");
                assert_eq!(careful.report, fast.report, "{how:?}");
            }
            (Err(careful), Err(fast)) => assert_eq!(careful, fast, "{how:?}"),
            _ => panic!("{how:?} gives {fast:?}, the scanner {careful:?}"),
        };
    for parser in [RowParser::Portable, RowParser::Fastest] {
        same(&parser, read(bytes, parser));
    }
    for work in [
        Work::Backwards(0),
        Work::Backwards(50),
        Work::Some(300),
        Work::Threads(4000),
        Work::Nobody(100),
    ] {
        // Pieces of a few bytes of a file of megabytes are of no use to anybody.
        if bytes.len() < 100_000 || matches!(work, Work::Threads(_)) {
            same(&work, read_in_pieces(bytes, work));
        }
    }
    careful
}

#[test]
fn on_real_files() {
    for path in files() {
        agreed(&std::fs::read(path).unwrap()).unwrap();
    }
}

/// A number as some program might write it.
fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => (-200.0..200.0_f64, 0..8_usize).prop_map(|(x, digits)| format!("{x:.digits$}")),
        2 => any::<f64>().prop_filter("finite", |x| x.is_finite()).prop_map(|x| format!("{x:e}")),
        1 => any::<f64>().prop_filter("finite", |x| x.is_finite()).prop_map(|x| format!("{x}")),
        2 => "-?[0-9]{1,20}",
        2 => "-?[0-9]{0,9}\\.[0-9]{1,20}",
        2 => "[-+]?[0-9]{1,4}\\.[0-9]{0,7}[eE][-+]?[0-9]{1,2}",
        1 => "-?0\\.0{0,20}[0-9]{0,20}",
        1 => Just("9007199254740993".to_string()),
        1 => Just("-0".to_string()),
    ]
}

/// What stands between numbers: mostly one blank.
fn separator() -> impl Strategy<Value = &'static str> {
    prop_oneof![
        20 => Just(" "),
        4 => Just("\n"),
        2 => Just("\r\n"),
        2 => Just("  "),
        1 => Just("\t"),
        1 => Just(" \n \n"),
    ]
}

/// The same, and what is odd.
fn odd_piece() -> impl Strategy<Value = String> {
    prop_oneof![
        60 => number(),
        1 => "[-+.,eE0-9# ;/\\r\\n\\t\u{b}x\u{e9}]{1,6}",
        1 => Just("\r".to_string()),
        1 => Just("1,5".to_string()),
        1 => Just("2.0-3.5".to_string()),
        1 => "[0-9]{60,200}",
    ]
}

fn rows(piece: impl Strategy<Value = String>) -> impl Strategy<Value = String> {
    prop::collection::vec((piece, separator()), 0..600).prop_map(|pieces| {
        pieces
            .into_iter()
            .map(|(piece, after)| piece + after)
            .collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Sound numbers are also what the standard library makes of them.
    #[test]
    fn on_sound_rows(rows in rows(number())) {
        let count = rows.split_ascii_whitespace().count();
        let rows = rows + &" 0".repeat(count.next_multiple_of(4) - count);
        let expected: Vec<u64> =
            rows.split_ascii_whitespace().map(|word| word.parse::<f64>().unwrap().to_bits()).collect();
        let import = agreed(with_rows(expected.len() / 4, &rows).as_bytes());
        let motion = import.unwrap().document.motion.unwrap();
        let values: Vec<u64> = motion.values.iter().map(|value| value.to_bits()).collect();
        prop_assert!(values == expected);
    }

    #[test]
    fn on_odd_rows(rows in rows(odd_piece()), frames in 0..160_usize) {
        let _ = agreed(with_rows(frames, &rows).as_bytes());
    }

    /// A value beyond the range is found wherever it stands, though the values are looked at while they come.
    #[test]
    fn on_a_value_beyond_the_range(
        at in 0..8000_usize,
        frames in 1500..2000_usize,
        value in prop::sample::select(vec!["1e13", "-1000000000001", "2000000000000.5", "1e300"]),
    ) {
        let at = at % (4 * frames);
        let mut words = vec!["0.25"; 4 * frames];
        words[at] = value;
        let rows: String = words.chunks(4).map(|row| row.join(" ") + "\n").collect();
        let import = agreed(with_rows(frames, &rows).as_bytes()).unwrap();
        let codes: Vec<WarningCode> = import.report.warnings.iter().map(|it| it.code).collect();
        prop_assert_eq!(codes, [WarningCode::ValueOutOfRange]);
        let gaps = import.document.values_out_of_range();
        let gaps: Vec<_> = gaps.iter().map(|gap| (gap.frame, gap.column)).collect();
        prop_assert_eq!(gaps, [(at / 4, at % 4)]);
    }

    /// Bytes of a sound file are changed, taken out and put in.
    #[test]
    fn on_damaged_files(
        rows in rows(number()),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3_u8), 1..6),
    ) {
        let mut bytes = with_rows(rows.split_ascii_whitespace().count() / 4, &rows).into_bytes();
        for (place, byte, how) in damage {
            let at = place.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte & 0x7f),
                _ => { bytes.remove(at); }
            }
        }
        if let Ok(import) = agreed(&bytes) {
            let again = bvh::read(&bvh::write(&import.document)).unwrap();
            prop_assert!(bits(&import.document) == bits(&again.document));
        }
    }
}

/// Pieces are taken only if nothing about them is odd, and all of a sound file is.
#[test]
fn a_sound_file_is_read_in_pieces_to_its_last_line() {
    let rows: String = (0..5000)
        .map(|frame| format!("{frame} -0.5 {frame}.25 1e-3\n"))
        .collect();
    let text = with_rows(5000, &rows);
    let (mut bytes_in_pieces, mut calls) = (0, 0);
    let import = bvh::read_in_pieces(
        text.as_bytes(),
        ReadOptions::default(),
        1000,
        |_| ControlFlow::Continue(()),
        |pieces| {
            calls += 1;
            bytes_in_pieces = pieces.iter().map(Piece::byte_count).sum();
            pieces.iter_mut().for_each(Piece::work);
        },
    )
    .unwrap();
    assert_eq!((calls, bytes_in_pieces), (2, rows.len()));
    let whole = bvh::read(text.as_bytes()).unwrap();
    assert!(bits(&import.document) == bits(&whole.document));
}

#[test]
fn a_beginning_is_read_without_complaint() {
    let rows: String = (0..200).map(|frame| format!("{frame} 0 0\n")).collect();
    let text = format!(
        "HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n\
         End Site\n{{\nOFFSET 0 1 0\n}}\n}}\nMOTION\nFrames: 1000000\nFrame Time: 0.1\n{rows}"
    );
    let options = ReadOptions {
        extent: bvh::Extent::Beginning,
        ..ReadOptions::default()
    };
    let go_on = |_| std::ops::ControlFlow::Continue(());
    let import = bvh::read_with(text.as_bytes(), options, go_on).expect("a beginning");
    assert!(import.report.is_empty(), "{:?}", import.report);
    let motion = import.document.motion.expect("frames");
    assert_eq!((motion.frame_count, motion.values[3 * 199]), (200, 199.0));
    assert!(
        bvh::read(text.as_bytes()).is_err(),
        "as a whole file it is impossible"
    );
}
