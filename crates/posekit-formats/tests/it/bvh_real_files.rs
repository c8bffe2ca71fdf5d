//! Real BVH files, read and written. They are in `shared/data` beside the workspace; without them these
//! tests say so and pass.

use std::path::{Path, PathBuf};

use posekit_formats::bvh::{self, Bvh, LineEnding, WriteOptions};

/// The files that the tests use, by name: tables and thresholds are of these, and more data may be put beside
/// them.
const NAMES: &str = include_str!("../real_files.txt");

/// The real files in order of path; empty when there is no such folder.
pub(crate) fn files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !folder.is_dir() {
        eprintln!("skipped: {} is missing", folder.display());
        return Vec::new();
    }
    NAMES.lines().map(|name| folder.join(name)).collect()
}

#[test]
fn the_files_that_are_named_are_there() {
    let missing: Vec<_> = files().into_iter().filter(|path| !path.is_file()).collect();
    assert!(missing.is_empty(), "{missing:#?}");
}

/// All that a document says, with floats as bits so that -0 differs from 0.
pub(crate) fn bits(bvh: &Bvh) -> (String, Vec<u64>) {
    let mut numbers: Vec<u64> = Vec::new();
    let mut text = String::new();
    for joint in &bvh.joints {
        text += &format!(
            "{:?} {:?} {:?} {}\n",
            joint.name, joint.parent, joint.channels, joint.is_end_site
        );
        numbers.extend(joint.offset.map(f64::to_bits));
    }
    if let Some(motion) = &bvh.motion {
        text += &format!("{} frames", motion.frame_count);
        numbers.push(motion.frame_time_secs.to_bits());
        numbers.extend(motion.values.iter().map(|value| value.to_bits()));
    }
    (text, numbers)
}

#[test]
fn read_write_read_is_identical_to_the_bit() {
    for path in files() {
        let first = bvh::read(&std::fs::read(&path).unwrap()).unwrap();
        let written = bvh::write(&first.document);
        let second = bvh::read(&written).unwrap();
        assert_eq!(
            bits(&first.document),
            bits(&second.document),
            "{}",
            path.display()
        );
        assert_eq!(written, bvh::write(&second.document), "{}", path.display());
        let mut crlf = Vec::new();
        let options = WriteOptions {
            line_ending: LineEnding::CrLf,
            ..WriteOptions::default()
        };
        bvh::write_to(&first.document, options, &mut crlf).unwrap();
        let third = bvh::read(&crlf).unwrap();
        assert_eq!(
            bits(&first.document),
            bits(&third.document),
            "{}",
            path.display()
        );
    }
}

/// The reference is the standard library's own parser over the words after the header's lines.
#[test]
fn every_value_is_what_the_standard_library_reads() {
    for path in files() {
        let bytes = std::fs::read(&path).unwrap();
        let text = std::str::from_utf8(&bytes).unwrap();
        let rows = text.split("Frame Time:").nth(1).unwrap();
        let mut numbers = rows
            .split_ascii_whitespace()
            .map(|word| word.parse::<f64>().unwrap());
        let motion = bvh::read(&bytes).unwrap().document.motion.unwrap();
        assert_eq!(
            numbers.next(),
            Some(motion.frame_time_secs),
            "{}",
            path.display()
        );
        let expected: Vec<u64> = numbers.map(f64::to_bits).collect();
        let actual: Vec<u64> = motion.values.iter().map(|value| value.to_bits()).collect();
        assert_eq!(actual, expected, "{}", path.display());
    }
}

/// Frame and joint counts as `grep` finds them in the files.
#[test]
fn known_files_have_their_known_shape() {
    let known = [
        ("bandai/dataset-1_dance-short_normal_001.bvh", 1901, 132),
        ("cmu/01_01.bvh", 2752, 96),
        ("course/push.bvh", 200, 63),
    ];
    for path in files() {
        let bvh = bvh::read(&std::fs::read(&path).unwrap()).unwrap().document;
        if let Some((_, frames, channels)) = known.iter().find(|(name, ..)| path.ends_with(name)) {
            assert_eq!(
                (bvh.frame_count(), bvh.channel_count()),
                (*frames, *channels)
            );
        }
    }
}

#[test]
fn real_files_need_no_repair() {
    for path in files() {
        let report = bvh::read(&std::fs::read(&path).unwrap()).unwrap().report;
        assert_eq!(report.first_repair(), None, "{}", path.display());
    }
}
