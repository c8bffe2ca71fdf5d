//! How fast BVH text becomes numbers, as ratios to references measured in the same run: bare loops over
//! the numbers with the standard library's parser and with `fast-float2`, and the `bvh_anim` crate.
//!
//! `cargo bench -p posekit-formats --bench bvh_read [SECONDS]`. Needs `shared/data` beside the workspace,
//! and says so without it. One core; MB are 10^6 bytes of the file.
#![allow(clippy::print_stdout, reason = "a bench says that it was skipped")]
#![allow(
    clippy::unwrap_used,
    reason = "a bench that fails should panic where it fails"
)]

#[path = "../../../benches/harness.rs"]
mod harness;

use std::hint::black_box;
use std::ops::ControlFlow;
use std::path::Path;

use harness::{Table, Unit, time_asked};
use posekit_formats::bvh::{self, PIECE_BYTES, Piece, ReadOptions, RowParser};

/// The size of the large file, in bytes.
const LARGE: usize = 100_000_000;

fn main() {
    let file = "../../../shared/data/bandai/dataset-1_dance-short_normal_001.bvh";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let Ok(small) = std::fs::read(&path) else {
        println!("skipped: there is no {}", path.display());
        return;
    };
    let large = enlarge(&small);
    measure("dance-short_normal_001.bvh", &small);
    measure("100 MB of its rows", &large);
}

/// A file of the same rows again and again, with the right frame count.
fn enlarge(small: &[u8]) -> Vec<u8> {
    let text = std::str::from_utf8(small).unwrap();
    let (head, rest) = text.split_once("Frames:").unwrap();
    let mut lines = rest.splitn(3, '\n');
    let frames: usize = lines.next().unwrap().trim().parse().unwrap();
    let time = lines.next().unwrap();
    let rows = lines.next().unwrap();
    let copies = LARGE / rows.len();
    format!(
        "{head}Frames: {}\n{time}\n{}",
        frames * copies,
        rows.repeat(copies)
    )
    .into_bytes()
}

fn read(bytes: &[u8], row_parser: RowParser) -> usize {
    let options = ReadOptions {
        row_parser,
        ..ReadOptions::default()
    };
    let import = bvh::read_with(bytes, options, |_| ControlFlow::Continue(())).unwrap();
    import.document.frame_count()
}

/// As the command reads a large file.
fn read_in_pieces(bytes: &[u8], threads: usize) -> usize {
    let go_on = |_| ControlFlow::Continue(());
    let import = bvh::read_in_pieces(
        bytes,
        ReadOptions::default(),
        PIECE_BYTES,
        go_on,
        |pieces| {
            let share = pieces.len().div_ceil(threads).max(1);
            std::thread::scope(|scope| {
                for part in pieces.chunks_mut(share) {
                    scope.spawn(|| part.iter_mut().for_each(Piece::work));
                }
            });
        },
    );
    import.unwrap().document.frame_count()
}

/// Splits the rows at blanks and parses every word into a vector that is large enough from the start.
fn bare_loop(bytes: &[u8], parse: fn(&str) -> f64) -> usize {
    let text = std::str::from_utf8(bytes).unwrap();
    let at = text.find("Frame Time:").unwrap() + "Frame Time:".len();
    let mut values = Vec::with_capacity(bytes.len() / 6);
    values.extend(text[at..].split_ascii_whitespace().map(parse));
    black_box(&values).len()
}

fn measure(what: &str, bytes: &[u8]) {
    let size = bytes.len();
    let title = format!("{what}: {:.1} MB", size as f64 / 1e6);
    let mut table = Table::new(title, Unit::MegabytesPerSecond);
    table.job("posekit", size, || {
        black_box(read(black_box(bytes), RowParser::Fastest));
    });
    table.job("posekit, portable", size, || {
        black_box(read(black_box(bytes), RowParser::Portable));
    });
    table.job("posekit, careful", size, || {
        black_box(read(black_box(bytes), RowParser::Careful));
    });
    for threads in [1, 2, 4] {
        table.threaded_job(
            format!("posekit, in pieces on {threads} threads, wall clock"),
            size,
            move || {
                black_box(read_in_pieces(black_box(bytes), threads));
            },
        );
    }
    table.reference("std parse, bare loop", size, || {
        black_box(bare_loop(black_box(bytes), |word| word.parse().unwrap()));
    });
    table.reference("fast-float2, bare loop", size, || {
        black_box(bare_loop(black_box(bytes), |word| {
            fast_float2::parse(word).unwrap()
        }));
    });
    table.reference("bvh_anim 0.4, the crate", size, || {
        black_box(bvh_anim::from_bytes(black_box(bytes)).unwrap());
    });
    table.job("memchr over line ends", size, || {
        black_box(memchr::memchr_iter(b'\n', black_box(bytes)).count());
    });
    table.measure(7 * time_asked());
}
