//! The MOTION section: the header, then rows of numbers until they end.

use std::ops::ControlFlow;

use super::motion_header::{self, MotionHeader};
use super::pieces::{self, Piece};
use super::rows::{self, Lines, Rows};
use super::scan::{Scanner, is_blank};
use super::{Extent, PROGRESS_BYTES, ReadOptions, RowParser, number};
use crate::bvh::{BvhMotion, Gap};
use crate::report::{ReadError, ReadErrorKind, WarningCode};
use posekit::range::LONGEST_LENGTH;

/// What is wanted of the rows beside their values.
#[derive(Default)]
pub(super) struct Wanted<'w> {
    /// Values that are not numbers; without it they are an error.
    pub(super) gaps: Option<&'w mut Vec<Gap>>,
    /// Where the rows begin. Only the careful parser says.
    pub(super) starts: Option<&'w mut Vec<usize>>,
    /// The size of pieces in which the rows are read first, and who reads them.
    pub(super) pieces: Option<(usize, &'w mut RunPieces<'w>)>,
}

/// Who has pieces worked on.
pub(super) type RunPieces<'r> = dyn FnMut(&mut [Piece<'_>]) + 'r;

/// Reads the section; the scanner stands after MOTION.
pub(super) fn read(
    scanner: &mut Scanner<'_>,
    channel_count: usize,
    options: ReadOptions,
    progress: &mut dyn FnMut(usize) -> ControlFlow<()>,
    wanted: Wanted<'_>,
) -> Result<BvhMotion, ReadError> {
    let mut header = motion_header::read(scanner)?;
    if options.extent == Extent::Beginning {
        header.frame_count = None;
    }
    let values_expected = room_for_rows(scanner, &header, channel_count)?;
    let frame_time_secs = header.frame_time_secs;
    if channel_count == 0 {
        return Ok(read_no_rows(scanner, &header));
    }
    let before = (scanner.pos, scanner.comma, scanner.reporter.clone());
    let rows = match wanted.pieces {
        Some((piece_bytes, run)) => {
            pieces::read(scanner, channel_count, options.row_parser, piece_bytes, run)
        }
        None => Rows::new(channel_count, values_expected, Lines::Ignored),
    };
    let mut walk = RowWalk {
        rows,
        promised: header.frame_count.map(|frames| frames * channel_count),
        parser: options.row_parser,
        keeps_gaps: wanted.gaps.is_some(),
        notes_out_of_range: false,
        progress,
    };
    if wanted.starts.is_some() {
        debug_assert_eq!(options.row_parser, RowParser::Careful);
        walk.rows.keep_starts();
    }
    walk.read(scanner)?;
    if walk.rows.is_out_of_step() && walk.promised != Some(walk.rows.values.len()) {
        (scanner.pos, scanner.comma, scanner.reporter) = before.clone();
        walk.rows.restart(Lines::Kept);
        walk.read(scanner)?;
    }
    if walk.rows.has_out_of_range() {
        // Once more, with the place of each: that takes time, and is hardly ever needed.
        (scanner.pos, scanner.comma, scanner.reporter) = before;
        walk.parser = RowParser::Careful;
        walk.notes_out_of_range = true;
        walk.rows.restart(walk.rows.lines());
        walk.read(scanner)?;
    }
    if let Some(starts) = wanted.starts {
        *starts = walk.rows.take_starts();
    }
    let mut values = finish(scanner, walk.rows, &header);
    if let Some(gaps) = wanted.gaps {
        take_gaps(&mut values, channel_count, gaps);
    }
    Ok(BvhMotion {
        frame_time_secs,
        frame_count: values.len() / channel_count,
        values,
    })
}

/// How many values to reserve room for: as many as the header promises, but no more than the remaining
/// bytes could hold, each value being a digit and a blank at least.
///
/// Fails when the promise is beyond that by more than a row.
fn room_for_rows(
    scanner: &mut Scanner<'_>,
    header: &MotionHeader,
    channel_count: usize,
) -> Result<usize, ReadError> {
    let remaining = scanner.bytes.len() - header.ends_at;
    let most_values = remaining / 2 + 1;
    let most_frames = most_values.checked_div(channel_count).unwrap_or(remaining);
    let Some(frames) = header.frame_count else {
        return Ok(0);
    };
    if frames <= most_frames + 1 {
        return Ok(most_values.min(frames * channel_count));
    }
    let kind = ReadErrorKind::ImpossibleFrameCount;
    let expected = format!("at most {most_frames} frames, what the file could hold");
    let found = format!("`Frames: {frames}`");
    Err(scanner.error(kind, header.frame_count_at, expected, found))
}

/// The motion of a hierarchy without channels: frames without values.
fn read_no_rows(scanner: &mut Scanner<'_>, header: &MotionHeader) -> BvhMotion {
    scanner.skip_blanks();
    note_trailing_text(scanner);
    BvhMotion {
        frame_time_secs: header.frame_time_secs,
        frame_count: header.frame_count.unwrap_or(0),
        values: Vec::new(),
    }
}

/// A walk over the rows, from the first to whatever ends them.
pub(super) struct RowWalk<'p> {
    pub(super) rows: Rows,
    /// How many values the header promises.
    pub(super) promised: Option<usize>,
    pub(super) parser: RowParser,
    /// Whether a value that is no number is a gap, NaN until the rows are whole.
    pub(super) keeps_gaps: bool,
    /// Whether values beyond the range are noted, each with its place; the parser is the careful one then.
    pub(super) notes_out_of_range: bool,
    pub(super) progress: &'p mut dyn FnMut(usize) -> ControlFlow<()>,
}

impl RowWalk<'_> {
    pub(super) fn read(&mut self, scanner: &mut Scanner<'_>) -> Result<(), ReadError> {
        let mut next_call = scanner.pos.saturating_add(PROGRESS_BYTES);
        loop {
            let pos = scanner.pos;
            scanner.pos = rows::read_plain(
                &mut self.rows,
                scanner.bytes,
                pos,
                next_call,
                scanner.comma,
                self.parser,
            );
            if scanner.pos >= next_call {
                self.call_progress(scanner)?;
                next_call = scanner.pos.saturating_add(PROGRESS_BYTES);
            }
            self.skip_blanks(scanner);
            if scanner.peek().is_none() {
                break;
            }
            let at = scanner.pos;
            match number::read(scanner, "a number") {
                Ok(value) => {
                    if self.notes_out_of_range && value.abs() > LONGEST_LENGTH {
                        warn_out_of_range(scanner, at, value);
                    }
                    let left = scanner.bytes.len() - scanner.pos;
                    self.rows.push_from(at, value, left);
                }
                Err(_) if self.has_all_rows() => {
                    note_trailing_text(scanner);
                    break;
                }
                Err(error) if self.keeps_gaps && error.kind == ReadErrorKind::NotFinite => {
                    number::skip(scanner);
                    let left = scanner.bytes.len() - scanner.pos;
                    self.rows.push_from(at, f64::NAN, left);
                }
                Err(error) => return Err(error),
            }
        }
        self.rows.end_line(scanner.pos);
        self.call_progress(scanner)
    }

    fn call_progress(&mut self, scanner: &mut Scanner<'_>) -> Result<(), ReadError> {
        let at = scanner.pos;
        match (self.progress)(at) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => {
                let kind = ReadErrorKind::Cancelled;
                Err(scanner.error(kind, at, "to read on", "a request to stop"))
            }
        }
    }

    /// Whether every promised row has been read, so that what follows may be anything.
    fn has_all_rows(&self) -> bool {
        let dropped = self.rows.damaged_at.len() * self.rows.channel_count;
        self.promised
            .is_some_and(|promised| self.rows.values.len() + dropped >= promised)
    }

    /// Moves to the next number, telling the rows about line ends on the way.
    fn skip_blanks(&mut self, scanner: &mut Scanner<'_>) {
        while let Some(byte) = scanner.peek() {
            if byte == b'\n'
                || (byte == b'\r' && !scanner.bytes[scanner.pos..].starts_with(b"\r\n"))
            {
                self.rows.end_line(scanner.pos);
                scanner.pos += 1;
            } else if is_blank(byte) {
                scanner.pos += 1;
            } else if !scanner.skip_separator(byte) {
                return;
            }
        }
    }
}

/// Where the values are NaN, and 0 in their place.
fn take_gaps(values: &mut [f64], channel_count: usize, gaps: &mut Vec<Gap>) {
    for (place, value) in values.iter_mut().enumerate() {
        if value.is_nan() {
            *value = 0.0;
            gaps.push(Gap {
                frame: place / channel_count,
                column: place % channel_count,
            });
        }
    }
}

/// Says that a value is beyond the range of what motions are made of.
pub(super) fn warn_out_of_range(scanner: &mut Scanner<'_>, at: usize, value: f64) {
    scanner.warn(WarningCode::ValueOutOfRange, at, || {
        format!(
            "a value of {value:?}, which is not within {LONGEST_LENGTH:e}, kept as the file says: too large for a motion"
        )
    });
}

fn note_trailing_text(scanner: &mut Scanner<'_>) {
    if scanner.peek().is_some() {
        let at = scanner.pos;
        let found = scanner.describe_here();
        scanner.warn(WarningCode::TrailingText, at, || {
            format!("{found} after the last row, ignored with all that follows")
        });
    }
}

/// Says what was odd about the rows, drops a partial last one, and gives the values.
fn finish(scanner: &mut Scanner<'_>, rows: Rows, header: &MotionHeader) -> Vec<f64> {
    let channels = rows.channel_count;
    for &at in &rows.damaged_at {
        scanner.warn(WarningCode::DamagedRow, at, || {
            format!(
                "values that do not make up a row of {channels}, dropped to keep the others in step"
            )
        });
    }
    let mut values = rows.values;
    let over = values.len() % channels;
    if over > 0 {
        let at = scanner.pos;
        scanner.warn(WarningCode::PartialLastRow, at, || {
            format!("a last row of {over} values instead of {channels}, dropped")
        });
        values.truncate(values.len() - over);
    }
    if let (Some(at), true) = (
        rows.odd_line_at,
        rows.odd_lines > rows.damaged_at.len() + usize::from(over > 0),
    ) {
        scanner.warn(WarningCode::WrappedRows, at, || {
            format!("a line that does not hold {channels} values, line ends are ignored")
        });
    }
    let frames = values.len() / channels;
    if header
        .frame_count
        .is_some_and(|promised| promised != frames)
    {
        let promised = header.frame_count.unwrap_or(0);
        scanner.warn(
            WarningCode::FrameCountMismatch,
            header.frame_count_at,
            || {
                format!(
                    "`Frames:` says {promised} and {frames} whole rows are there, those are used"
                )
            },
        );
    }
    // Room that a wrong promise took and nothing filled goes back.
    values.shrink_to_fit();
    values
}
