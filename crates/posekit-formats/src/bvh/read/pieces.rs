//! The rows of a large file in pieces that are read beside each other.
//!
//! The rows are cut after line ends. A piece is taken when every line in it has the values of one row and
//! nothing about it is odd; then the values of the pieces, one after the other, are what reading from the
//! first to the last gives, and so is everything that the reader knows after them. From the first piece
//! that is not so, and for what follows the last line end, the file is read on as if it had never been cut.

use std::ops::{ControlFlow, Range};

use super::RowParser;
use super::motion::RowWalk;
use super::rows::{Lines, Rows};
use super::scan::{Comma, Scanner};
use crate::memory::prefer_large_pages;

/// A good size for pieces, in bytes: its text and its values stay in a core's own cache.
pub const PIECE_BYTES: usize = 1 << 18;

/// A piece of a file's rows: something to do, on any thread, in any order.
#[derive(Debug)]
pub struct Piece<'a> {
    bytes: &'a [u8],
    place: Range<usize>,
    channel_count: usize,
    comma: Comma,
    parser: RowParser,
    /// How many lines end in it, once they were counted.
    lines: Option<usize>,
    /// Where its values go.
    values: &'a mut [f64],
    is_read: bool,
}

impl Piece<'_> {
    /// How many bytes of the file it is.
    #[must_use]
    pub fn byte_count(&self) -> usize {
        self.place.len()
    }

    /// Does the next part of the work on it: the first time its lines are counted, the second time its values
    /// are read.
    pub fn work(&mut self) {
        if self.lines.is_none() {
            let lines = memchr::memchr_iter(b'\n', &self.bytes[self.place.clone()]).count();
            self.lines = Some(lines);
        } else if !self.values.is_empty() {
            self.is_read = self.read().is_some();
        }
    }

    /// How many values it has if it has a row in each line and no more than its bytes could hold.
    fn value_count(&self) -> Option<usize> {
        let count = self.lines?.checked_mul(self.channel_count)?;
        (count <= self.place.len() / 2 + 1).then_some(count)
    }

    /// Reads its values, if there is nothing odd about them.
    fn read(&mut self) -> Option<()> {
        let mut scanner = Scanner::new(&self.bytes[..self.place.end]);
        scanner.pos = self.place.start;
        scanner.comma = self.comma;
        let mut walk = RowWalk {
            rows: Rows::new(self.channel_count, self.values.len(), Lines::Ignored),
            promised: None,
            parser: self.parser,
            keeps_gaps: false,
            notes_out_of_range: false,
            progress: &mut |_| ControlFlow::Continue(()),
        };
        walk.read(&mut scanner).ok()?;
        let rows = &mut walk.rows;
        let is_plain = scanner.comma == self.comma
            && !rows.has_out_of_range()
            && rows.are_all_whole_lines()
            && rows.values.len() == self.values.len();
        if !is_plain || !scanner.finish().is_empty() {
            return None;
        }
        self.values.copy_from_slice(&rows.values);
        Some(())
    }
}

/// The rows from where a scanner stands, as far as they could be read in pieces; the scanner is left after
/// them. `run` is called twice with pieces, and has [`Piece::work`] called once on each.
pub(super) fn read(
    scanner: &mut Scanner<'_>,
    channel_count: usize,
    parser: RowParser,
    piece_bytes: usize,
    run: &mut dyn FnMut(&mut [Piece<'_>]),
) -> Rows {
    let mut pieces = cut(scanner, channel_count, parser, piece_bytes);
    run(&mut pieces);
    // Where a piece was not counted, or cannot be plain, the others are of no use.
    let counts: Vec<usize> = pieces.iter().map_while(Piece::value_count).collect();
    pieces.truncate(counts.len());
    let counted: usize = counts.iter().sum();
    let ends_at = pieces.last().map_or(scanner.pos, |piece| piece.place.end);
    // Room for what follows, so that a last row does not have all the others moved.
    let room = ((scanner.bytes.len() - ends_at) / 2 + 1).min(channel_count);
    let mut values = vec![0.0; counted + room];
    prefer_large_pages(&mut values);
    let mut left = values.as_mut_slice();
    for (piece, &count) in pieces.iter_mut().zip(&counts) {
        let (own, others) = left.split_at_mut(count);
        piece.values = own;
        left = others;
    }
    run(&mut pieces);
    let taken = pieces.iter().take_while(|piece| piece.is_read).count();
    let ends_at = taken
        .checked_sub(1)
        .map_or(scanner.pos, |last| pieces[last].place.end);
    drop(pieces);
    values.truncate(counts[..taken].iter().sum());
    scanner.pos = ends_at;
    Rows::of_whole_lines(channel_count, values)
}

/// The pieces of the rows up to the last line end.
fn cut<'a>(
    scanner: &Scanner<'a>,
    channel_count: usize,
    parser: RowParser,
    piece_bytes: usize,
) -> Vec<Piece<'a>> {
    let bytes = scanner.bytes;
    let mut pieces = Vec::with_capacity(bytes.len() / piece_bytes.max(1) / 2 + 1);
    let mut start = scanner.pos;
    while start < bytes.len() {
        let search = (start + piece_bytes).min(bytes.len());
        let end = match memchr::memchr(b'\n', &bytes[search..]) {
            Some(length) => search + length + 1,
            None => match memchr::memrchr(b'\n', &bytes[start..]) {
                Some(length) => start + length + 1,
                None => break,
            },
        };
        pieces.push(Piece {
            bytes,
            place: start..end,
            channel_count,
            comma: scanner.comma,
            parser,
            lines: None,
            values: &mut [],
            is_read: false,
        });
        start = end;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many bytes of these rows of two values are taken from pieces of a line or two.
    fn taken(rows: &str) -> usize {
        let mut scanner = Scanner::new(rows.as_bytes());
        let mut run = |pieces: &mut [Piece<'_>]| pieces.iter_mut().for_each(Piece::work);
        let rows = read(&mut scanner, 2, RowParser::Fastest, 6, &mut run);
        assert!(rows.are_all_whole_lines());
        scanner.pos
    }

    #[test]
    fn pieces_are_taken_up_to_the_first_that_is_odd() {
        let sound = "1 2\n3 4\n5 6\n7 8\n";
        assert_eq!(taken(sound), sound.len());
        let spelled = "1 2\r\n-3 4e1\r\n+5 .6\r\n";
        assert_eq!(taken(spelled), spelled.len());
        // What follows the last line end is nobody's piece.
        assert_eq!(taken("1 2\n3 4\n5 6\n7 8\n9 10"), sound.len());
        for odd in [
            "1 2\n3 4\n5 # 6\n7 8\n",
            "1 2\n3 4\n\n7 8\n9 10\n",
            "1 2\n3 4\n5 6 7\n8\n",
            "1 2\n3 4\n5-6\n7 8\n",
            "1 2\n3 4\n5,6\n7 8\n",
            "1 2\n3 4\n5 x\n7 8\n",
            "1 2\n3 4\n5\r6\n7 8\n",
            "1 2\n3 4\n5 nan\n7 8\n",
        ] {
            assert_eq!(taken(odd), 8, "{odd:?}");
        }
        assert_eq!((taken(""), taken("1 2"), taken("\n\n")), (0, 0, 0));
    }

    #[test]
    fn memory_is_not_asked_for_beyond_what_the_bytes_hold() {
        let lines = "\n".repeat(10_000);
        let mut scanner = Scanner::new(lines.as_bytes());
        let mut run = |pieces: &mut [Piece<'_>]| pieces.iter_mut().for_each(Piece::work);
        let rows = read(&mut scanner, 100_000, RowParser::Fastest, 100, &mut run);
        assert!(rows.values.capacity() <= lines.len());
    }
}
