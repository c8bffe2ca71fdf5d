//! Rows of numbers: where their values gather, and the fast parsers for plain stretches.
//!
//! A plain stretch is numbers of digits with at most a minus, a point and an exponent, blanks and line
//! ends between them. At anything else a fast parser stops, before the token it is not sure of.

mod exact;
mod portable;
#[cfg(target_arch = "x86_64")]
#[path = "avx2.rs"]
mod wide_lanes;

use super::RowParser;
use super::scan::Comma;
use crate::memory::prefer_large_pages;
use posekit::range::LONGEST_LENGTH;

/// What line ends mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lines {
    /// Nothing: rows may be wrapped or share a line.
    Ignored,
    /// A line with a whole row's values is a row, and what hangs before it is damaged.
    Kept,
}

/// Where rows begin, as values come one by one.
#[derive(Debug, Default)]
struct Starts {
    /// Of each row its first value's place.
    of_rows: Vec<usize>,
    /// Of the line its first value's place.
    of_line: Option<usize>,
}

/// The values as they come, and what was odd about the lines they came in.
#[derive(Debug)]
pub(super) struct Rows {
    pub(super) values: Vec<f64>,
    pub(super) channel_count: usize,
    lines: Lines,
    /// How many values there were when the line began.
    line_start: usize,
    /// How many lines have values, but not one row of them; where the first of them and the last end.
    pub(super) odd_lines: usize,
    pub(super) odd_line_at: Option<usize>,
    last_odd_line_at: usize,
    /// How many values there were at the last line end that was also a row's.
    in_step: usize,
    /// How many lines have the values of one row, and whether such a line began within a row.
    whole_lines: usize,
    out_of_step: bool,
    /// Where the lines end whose values were dropped.
    pub(super) damaged_at: Vec<usize>,
    /// Where rows begin, if that is wanted.
    starts: Option<Starts>,
    /// How many values have been looked at, and whether one of them was beyond the range of motions.
    ranged: usize,
    is_out_of_range: bool,
    /// How many tokens the wide parser still lets pass before it tries again.
    #[cfg(target_arch = "x86_64")]
    patience: u32,
}

impl Rows {
    pub(super) fn new(channel_count: usize, values_expected: usize, lines: Lines) -> Self {
        let mut values = Vec::with_capacity(values_expected);
        prefer_large_pages(&mut values);
        Self {
            values,
            channel_count,
            lines,
            line_start: 0,
            odd_lines: 0,
            odd_line_at: None,
            last_odd_line_at: 0,
            in_step: 0,
            whole_lines: 0,
            out_of_step: false,
            damaged_at: Vec::new(),
            starts: None,
            ranged: 0,
            is_out_of_range: false,
            #[cfg(target_arch = "x86_64")]
            patience: 0,
        }
    }

    /// Rows of which every line had the values of one, all within the range: as reading them leaves it.
    pub(super) fn of_whole_lines(channel_count: usize, values: Vec<f64>) -> Self {
        Self {
            ranged: values.len(),
            line_start: values.len(),
            in_step: values.len(),
            whole_lines: values.len() / channel_count,
            values,
            ..Self::new(channel_count, 0, Lines::Ignored)
        }
    }

    /// Whether every line that has values has those of one row.
    pub(super) fn are_all_whole_lines(&self) -> bool {
        self.odd_lines == 0
            && self.line_start == self.values.len()
            && self.values.len() == self.whole_lines * self.channel_count
    }

    /// Notes where rows begin from here on. Values then come by [`push_from`](Self::push_from).
    pub(super) fn keep_starts(&mut self) {
        self.starts = Some(Starts::default());
    }

    /// Where the whole rows begin, if that was wanted.
    pub(super) fn take_starts(&mut self) -> Vec<usize> {
        let starts = self.starts.take().unwrap_or_default();
        let mut starts = starts.of_rows;
        starts.truncate(self.values.len() / self.channel_count);
        starts
    }

    /// What line ends mean.
    pub(super) fn lines(&self) -> Lines {
        self.lines
    }

    /// Forgets everything, to read the same rows again, line ends with a meaning of their own.
    pub(super) fn restart(&mut self, lines: Lines) {
        let mut values = std::mem::take(&mut self.values);
        values.clear();
        let starts = self.starts.take().map(|_| Starts::default());
        *self = Self {
            values,
            starts,
            ..Self::new(self.channel_count, 0, lines)
        };
    }

    /// Whether the file keeps a row to a line, mostly, and yet whole rows stand where the count of values
    /// says that a row is half done.
    pub(super) fn is_out_of_step(&self) -> bool {
        self.out_of_step && self.whole_lines > self.odd_lines
    }

    /// Adds a value; `bytes_left` bounds how many more may come.
    fn push(&mut self, value: f64, bytes_left: usize) {
        self.reserve(1, bytes_left);
        self.values.push(value);
    }

    /// Adds a value that begins at a byte offset.
    pub(super) fn push_from(&mut self, at: usize, value: f64, bytes_left: usize) {
        if let Some(starts) = &mut self.starts {
            starts.of_line.get_or_insert(at);
            if self.values.len().is_multiple_of(self.channel_count) {
                starts.of_rows.push(at);
            }
        }
        self.push(value, bytes_left);
    }

    /// Looks at the values that have come since it was last called: while they are still in the core's own cache that
    /// costs next to nothing, and a walk over all of them at the end would cost a twelfth of reading them.
    #[inline(always)]
    fn note_range(&mut self) {
        let new = &self.values[self.ranged..];
        self.is_out_of_range |= new
            .iter()
            .fold(false, |any, value| any | (value.abs() > LONGEST_LENGTH));
        self.ranged = self.values.len();
    }

    /// Whether there is a value that no motion is made of. One that is not a number is a gap.
    pub(super) fn has_out_of_range(&mut self) -> bool {
        self.note_range();
        self.is_out_of_range
    }

    /// Makes room. Beyond what the header promised, room grows by an eighth at a time, and never beyond
    /// what the rest of the file could hold, so that memory stays in proportion.
    pub(super) fn reserve(&mut self, additional: usize, bytes_left: usize) {
        if self.values.capacity() - self.values.len() < additional {
            let growth = (self.values.len() / 8 + 1024).min(bytes_left / 2 + 1);
            self.values.reserve_exact(growth.max(additional));
            prefer_large_pages(&mut self.values);
        }
    }

    /// Notes the end of a line, at a byte offset.
    pub(super) fn end_line(&mut self, at: usize) {
        let in_line = self.values.len() - self.line_start;
        if in_line == self.channel_count {
            let hanging = self.line_start % self.channel_count;
            if hanging > 0 && self.lines == Lines::Kept {
                self.note_range();
                self.values.drain(self.in_step..self.line_start);
                self.ranged = self.values.len();
                if let Some(starts) = &mut self.starts {
                    starts.of_rows.truncate(self.in_step / self.channel_count);
                    starts.of_rows.extend(starts.of_line);
                }
                self.damaged_at.push(self.last_odd_line_at);
            }
            self.whole_lines += 1;
            self.out_of_step |= hanging > 0;
        } else if in_line > 0 {
            self.odd_lines += 1;
            self.odd_line_at.get_or_insert(at);
            self.last_odd_line_at = at;
        }
        if let Some(starts) = &mut self.starts {
            starts.of_line = None;
        }
        self.line_start = self.values.len();
        if self.line_start.is_multiple_of(self.channel_count) {
            self.in_step = self.line_start;
        }
    }
}

/// About how many values are looked at together for their range.
const RANGED_TOGETHER: usize = 1024;

/// Reads plain numbers from `pos` on, until about `limit`, the end, or a token that is not plain. Gives
/// the position it stopped at, which is before a token or among blanks.
pub(super) fn read_plain(
    rows: &mut Rows,
    bytes: &[u8],
    pos: usize,
    limit: usize,
    comma: Comma,
    parser: RowParser,
) -> usize {
    let pos = match parser {
        RowParser::Careful => return pos,
        RowParser::Portable => pos,
        RowParser::Fastest => wide_lanes::read_plain(rows, bytes, pos, limit, comma),
    };
    let pos = portable::read_plain(rows, bytes, pos, limit, comma);
    if rows.values.len() - rows.ranged >= RANGED_TOGETHER {
        rows.note_range();
    }
    pos
}

#[cfg(not(target_arch = "x86_64"))]
mod wide_lanes {
    //! No such machine: the portable parser does it all.

    pub(super) fn read_plain(
        _: &mut super::Rows,
        _: &[u8],
        pos: usize,
        _: usize,
        _: super::Comma,
    ) -> usize {
        pos
    }
}
