//! The reader: the hierarchy, then the rows.
//!
//! One careful scanner ([`scan`]) decides what every byte means. Plain stretches of the rows, which are
//! nearly all of a file, go through a fast parser ([`rows`]) that gives up at the first byte it is not
//! sure of and lets the scanner take over there; both give the same values and warnings, which a
//! property test holds them to.

mod hierarchy;
mod motion;
mod motion_header;
mod number;
mod pieces;
mod places;
mod rows;
mod scan;

use std::ops::{ControlFlow, Range};

use super::{Bvh, Gap};
use crate::report::{Import, ReadError, ReadErrorKind};
use motion::Wanted;
pub use pieces::{PIECE_BYTES, Piece};
pub use places::{Places, locate};
use scan::{Comma, Scanner};

/// How deep joints may be nested. A rope or a tail of a few hundred joints fits with room to spare.
pub const MAX_DEPTH: usize = 1024;

/// How many joints a file may have, End Sites included: far more than a crowd in one file, and it keeps
/// the memory for joints small whatever the bytes say.
pub const MAX_JOINTS: usize = 100_000;

/// How long a joint's name may be, in bytes.
pub const MAX_NAME_BYTES: usize = 256;

/// About how many bytes are read between two calls of the progress function.
pub const PROGRESS_BYTES: usize = 1 << 20;

/// How a file is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Which parser reads plain rows.
    pub row_parser: RowParser,
    /// How much of the file the bytes are.
    pub extent: Extent,
}

/// How much of a file is there to be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extent {
    /// All of it.
    #[default]
    Whole,
    /// Its beginning, to the end of some line: the frames that are there are read, and that the header
    /// promises more is no fault.
    Beginning,
}

/// Which code reads plain rows of numbers. All give the same values and warnings: this is for measuring
/// one against the other, and for proving it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum RowParser {
    /// The fastest that this machine has.
    #[default]
    Fastest,
    /// Eight bytes at a time in ordinary integers; runs anywhere.
    Portable,
    /// The scanner alone, a number at a time.
    Careful,
}

/// Reads a BVH file from its bytes.
///
/// # Errors
///
/// When the bytes make no sense as BVH, with the place, what was expected and what was found. Anything
/// that still makes sense is read, and noted in the report.
pub fn read(bytes: &[u8]) -> Result<Import<Bvh>, ReadError> {
    read_with(bytes, ReadOptions::default(), |_| ControlFlow::Continue(()))
}

/// Reads a BVH file and calls `progress` about every [`PROGRESS_BYTES`] with the number of bytes done.
///
/// # Errors
///
/// As [`read()`], and [`ReadErrorKind::Cancelled`] when `progress` says [`ControlFlow::Break`].
pub fn read_with(
    bytes: &[u8],
    options: ReadOptions,
    mut progress: impl FnMut(usize) -> ControlFlow<()>,
) -> Result<Import<Bvh>, ReadError> {
    let read = read_document(bytes, options, &mut progress, Wanted::default())?;
    Ok(read.import)
}

/// Reads a BVH file as [`read_with`] does, to the bit, with most of the work in pieces that may be done on several
/// threads.
///
/// `run` is called twice, each time with the pieces of the rows, `piece_bytes` long or a little more; it calls
/// [`Piece::work`] once on each, in any order, on any thread. Where it leaves pieces out, to stop for instance,
/// they are read after it, and `progress` is called as ever. [`PIECE_BYTES`] is a good length. From the first
/// piece on in which something about the rows is odd, the file is read by this thread alone.
///
/// ```
/// use posekit_formats::bvh::{self, PIECE_BYTES, ReadOptions};
/// use std::ops::ControlFlow;
///
/// # let text = b"HIERARCHY ROOT hip { OFFSET 0 0 0 CHANNELS 1 Yrotation End Site { OFFSET 0 1 0 } }
/// # MOTION Frames: 2 Frame Time: 0.5
/// # 10
/// # 20.5
/// # ";
/// let import = bvh::read_in_pieces(
///     text,
///     ReadOptions::default(),
///     PIECE_BYTES,
///     |_| ControlFlow::Continue(()),
///     |pieces| {
///         let half = pieces.len().div_ceil(2).max(1);
///         std::thread::scope(|threads| {
///             for part in pieces.chunks_mut(half) {
///                 threads.spawn(|| part.iter_mut().for_each(|piece| piece.work()));
///             }
///         });
///     },
/// )?;
/// assert_eq!(import.document, bvh::read(text)?.document);
/// # Ok::<(), posekit_formats::report::ReadError>(())
/// ```
///
/// # Errors
///
/// As [`read_with`].
pub fn read_in_pieces(
    bytes: &[u8],
    options: ReadOptions,
    piece_bytes: usize,
    mut progress: impl FnMut(usize) -> ControlFlow<()>,
    mut run: impl FnMut(&mut [Piece<'_>]),
) -> Result<Import<Bvh>, ReadError> {
    let wanted = Wanted {
        pieces: Some((piece_bytes, &mut run)),
        ..Wanted::default()
    };
    let read = read_document(bytes, options, &mut progress, wanted)?;
    Ok(read.import)
}

/// Reads a BVH file in which values of the rows may not be numbers (`nan`, `inf`, `-nan(ind)`, `1.#QNAN`, or
/// beyond a double), and says where: the gaps, by frame and column. The document holds 0 in their place, which
/// means nothing; [`bridge_gaps`](crate::bvh::bridge_gaps) makes a motion of it.
///
/// # Errors
///
/// As [`read()`], but for those values.
pub fn read_with_gaps(bytes: &[u8]) -> Result<(Import<Bvh>, Vec<Gap>), ReadError> {
    let mut gaps = Vec::new();
    let mut progress = |_| ControlFlow::Continue(());
    let wanted = Wanted {
        gaps: Some(&mut gaps),
        ..Wanted::default()
    };
    let read = read_document(bytes, ReadOptions::default(), &mut progress, wanted)?;
    Ok((read.import, gaps))
}

/// What was read.
struct Read {
    import: Import<Bvh>,
    /// Where the joints' own lines stand.
    texts: Vec<Range<usize>>,
    /// What commas mean.
    comma: Comma,
}

fn read_document(
    bytes: &[u8],
    options: ReadOptions,
    progress: &mut dyn FnMut(usize) -> ControlFlow<()>,
    wanted: Wanted<'_>,
) -> Result<Read, ReadError> {
    let mut scanner = Scanner::new(bytes);
    check_is_text(&mut scanner)?;
    let hierarchy = hierarchy::read(&mut scanner)?;
    let channel_count = hierarchy
        .joints
        .iter()
        .map(|joint| joint.channels.len())
        .sum();
    let motion = if hierarchy.has_motion {
        Some(motion::read(
            &mut scanner,
            channel_count,
            options,
            progress,
            wanted,
        )?)
    } else {
        None
    };
    let document = Bvh {
        joints: hierarchy.joints,
        motion,
    };
    Ok(Read {
        texts: hierarchy.texts,
        comma: scanner.comma,
        import: Import {
            document,
            report: scanner.finish(),
        },
    })
}

/// Refuses what is not text at all before it gives a puzzling message about a keyword.
fn check_is_text(scanner: &mut Scanner<'_>) -> Result<(), ReadError> {
    /// A binary file shows itself at once; later on, a NUL may be padding after the last row.
    const LOOKED_AT: usize = 64;
    let bytes = scanner.bytes;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let found = "UTF-16 text";
        return Err(scanner.error(ReadErrorKind::NotText, 0, "ASCII or UTF-8 text", found));
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        let found = if bytes.is_empty() {
            "an empty file"
        } else {
            "nothing but blanks"
        };
        return Err(scanner.error(ReadErrorKind::Empty, 0, "HIERARCHY", found));
    }
    let head = &bytes[..bytes.len().min(LOOKED_AT)];
    if let Some(at) = head.iter().position(|&byte| byte == 0) {
        let found = "a NUL byte: the file is binary";
        return Err(scanner.error(ReadErrorKind::NotText, at, "text", found));
    }
    scanner.skip_byte_order_mark();
    Ok(())
}
