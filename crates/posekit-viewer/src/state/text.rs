//! The text of a clip's file: its lines, and where in them that stands which is seen.
//!
//! The bytes are those that the clip was read from, shared with it. Nothing here copies them: an index
//! has the place of every few lines, and of each frame's row.

use std::ops::Range;
use std::sync::Arc;

use posekit::skeleton::JointId;
use posekit_formats::bvh::{self, Bvh, Places};

/// Between two lines whose places are kept.
const STRIDE: usize = 16;

/// A tab goes to the next column that is a multiple of this.
const TAB: usize = 4;

/// In lines longer than this, in bytes, a byte is a column: characters are not counted from the start.
const COUNTED: usize = 1 << 16;

/// A file's text.
#[derive(Clone, Debug)]
pub struct FileText {
    bytes: Arc<Vec<u8>>,
    /// Where every few lines begins.
    starts: Vec<usize>,
    line_count: usize,
    /// The longest line, in bytes.
    longest: usize,
    /// Where joints and frames stand; nothing where the text makes no document.
    places: Option<Places>,
}

impl FileText {
    /// The text of these bytes. It takes the time of reading them.
    #[must_use]
    pub fn new(bytes: Arc<Vec<u8>>) -> Self {
        let mut starts = vec![0];
        let mut line_count = 1;
        let mut longest = 0;
        let mut start = 0;
        while let Some(next) = next_line(&bytes, start) {
            longest = longest.max(next - start);
            start = next;
            if line_count % STRIDE == 0 {
                starts.push(start);
            }
            line_count += 1;
        }
        longest = longest.max(bytes.len() - start);
        Self {
            places: bvh::locate(&bytes).ok(),
            bytes,
            starts,
            line_count,
            longest,
        }
    }

    /// Whether it is the text of these very bytes.
    #[must_use]
    pub fn is_of(&self, bytes: &Arc<Vec<u8>>) -> bool {
        Arc::ptr_eq(&self.bytes, bytes)
    }

    /// How many lines there are, an empty one after the last line end included.
    #[must_use]
    pub fn line_count(&self) -> usize {
        self.line_count
    }

    /// About how many columns the longest line has: no fewer than it has, if it has few tabs.
    #[must_use]
    pub fn column_count(&self) -> usize {
        self.longest.saturating_add(8 * TAB)
    }

    /// The lines of a range, each with where it stands, without its line end.
    pub fn lines(&self, lines: Range<usize>) -> impl Iterator<Item = Line<'_>> {
        let first = lines.start.min(self.line_count);
        let mark = (first / STRIDE).min(self.starts.len() - 1);
        let mut start = Some(self.starts[mark]);
        let mut number = mark * STRIDE;
        std::iter::from_fn(move || {
            let from = start?;
            start = next_line(&self.bytes, from);
            let end = start.unwrap_or(self.bytes.len());
            number += 1;
            let text = &self.bytes[from..end];
            let text = text.strip_suffix(b"\n").unwrap_or(text);
            let text = text.strip_suffix(b"\r").unwrap_or(text);
            Some(Line {
                number: number - 1,
                at: from,
                text,
            })
        })
        .skip(first - mark * STRIDE)
        .take(lines.end.saturating_sub(first))
    }

    /// The line that a byte stands in.
    #[must_use]
    pub fn line_at(&self, at: usize) -> usize {
        let mark = self.starts.partition_point(|&start| start <= at) - 1;
        let mut line = mark * STRIDE;
        let mut start = self.starts[mark];
        while let Some(next) = next_line(&self.bytes, start).filter(|&next| next <= at) {
            line += 1;
            start = next;
        }
        line
    }

    /// How many frames have a row.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.places.as_ref().map_or(0, |places| places.rows.len())
    }

    /// The frame whose row stands at a byte; nothing before the rows.
    #[must_use]
    pub fn frame_at(&self, at: usize) -> Option<usize> {
        self.places.as_ref()?.frame_at(at)
    }

    /// Where a frame's row stands: from its first value to its last.
    #[must_use]
    pub fn row(&self, frame: usize) -> Option<Range<usize>> {
        let values = self.places.as_ref()?.values_of_row(&self.bytes, frame);
        Some(values.first()?.start..values.last()?.end)
    }

    /// Where a joint's own lines stand in the hierarchy.
    #[must_use]
    pub fn joint(&self, joint: JointId) -> Option<Range<usize>> {
        self.places.as_ref()?.joints.get(joint.index()).cloned()
    }

    /// Where the values of some columns stand in the rows that begin or go on in a range of bytes.
    #[must_use]
    pub fn values(&self, bytes: Range<usize>, columns: &[Range<usize>]) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        let Some(places) = self.places.as_ref().filter(|_| !columns.is_empty()) else {
            return found;
        };
        let first = places.frame_at(bytes.start).unwrap_or(0);
        for frame in first..places.rows.len() {
            if places.rows[frame] >= bytes.end {
                break;
            }
            let values = places.values_of_row(&self.bytes, frame);
            for columns in columns {
                let of_joint = values.get(columns.clone()).unwrap_or_default();
                if let (Some(first), Some(last)) = (of_joint.first(), of_joint.last()) {
                    found.push(first.start..last.end);
                }
            }
        }
        found
    }
}

/// The columns of a joint in the rows of a document.
#[must_use]
pub fn columns_of(document: &Bvh, joint: JointId) -> Range<usize> {
    let joints = &document.joints;
    let count = |upto: usize| -> usize {
        let before = joints.iter().take(upto);
        before.map(|joint| joint.channels.len()).sum()
    };
    count(joint.index())..count(joint.index() + 1)
}

/// Where the line after the one that begins at `start` begins; nothing after the last one. Lines end with
/// LF, CR LF or a lone CR.
fn next_line(bytes: &[u8], start: usize) -> Option<usize> {
    let end = start + memchr::memchr2(b'\n', b'\r', &bytes[start..])?;
    let is_pair = bytes[end..].starts_with(b"\r\n");
    Some(end + if is_pair { 2 } else { 1 })
}

/// A line of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line<'a> {
    /// Counted from 0.
    pub number: usize,
    /// The place of its first byte.
    pub at: usize,
    /// Its bytes.
    pub text: &'a [u8],
}

impl Line<'_> {
    /// The part of it between two columns, as it is shown, and the column at which that begins.
    #[must_use]
    pub fn part(&self, columns: Range<usize>) -> (String, usize) {
        if self.text.len() > COUNTED {
            let from = columns.start.min(self.text.len());
            let to = columns.end.clamp(from, self.text.len());
            let shown = |&byte: &u8| {
                if byte.is_ascii_graphic() {
                    char::from(byte)
                } else {
                    ' '
                }
            };
            return (self.text[from..to].iter().map(shown).collect(), from);
        }
        let mut shown = String::new();
        let mut begins = None;
        self.walk(|column, width, c, _| {
            if column >= columns.end {
                return false;
            }
            if column >= columns.start {
                begins.get_or_insert(column);
                match c {
                    '\t' => shown.extend(std::iter::repeat_n(' ', width)),
                    c if c.is_control() => shown.push('\u{b7}'),
                    c => shown.push(c),
                }
            }
            true
        });
        (shown, begins.unwrap_or(columns.start))
    }

    /// The column at which a byte stands; the end of the line for bytes after it.
    #[must_use]
    pub fn column_of(&self, at: usize) -> usize {
        let inside = at.saturating_sub(self.at).min(self.text.len());
        if self.text.len() > COUNTED {
            return inside;
        }
        let mut found = 0;
        self.walk(|column, width, _, byte| {
            if byte < inside {
                found = column + width;
            }
            byte < inside
        });
        found
    }

    /// The byte that stands at a column; the end of the line after it.
    #[must_use]
    pub fn byte_at(&self, column: usize) -> usize {
        if self.text.len() > COUNTED {
            return self.at + column.min(self.text.len());
        }
        let mut found = self.text.len();
        self.walk(|begins, width, _, byte| {
            if column < begins + width {
                found = byte;
                return false;
            }
            true
        });
        self.at + found
    }

    /// Every character with its column, how many columns it has, and its byte, for as long as `step` says.
    fn walk(&self, mut step: impl FnMut(usize, usize, char, usize) -> bool) {
        let (mut column, mut byte) = (0, 0);
        for chunk in self.text.utf8_chunks() {
            let valid = chunk.valid().chars().map(|c| (c, c.len_utf8()));
            // What is no UTF-8 shows as one sign each.
            let invalid = chunk.invalid().iter().map(|_| ('\u{fffd}', 1));
            for (c, length) in valid.chain(invalid) {
                let width = if c == '\t' { TAB - column % TAB } else { 1 };
                if !step(column, width, c, byte) {
                    return;
                }
                column += width;
                byte += length;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(bytes: &[u8]) -> FileText {
        FileText::new(Arc::new(bytes.to_vec()))
    }

    #[test]
    fn lines_are_those_of_an_editor() {
        for (bytes, lines) in [
            (&b""[..], &[""][..]),
            (b"a", &["a"]),
            (b"a\n", &["a", ""]),
            (b"a\r\nb\rc\n\nd", &["a", "b", "c", "", "d"]),
        ] {
            let text = text(bytes);
            let found: Vec<_> = text
                .lines(0..99)
                .map(|line| String::from_utf8_lossy(line.text))
                .collect();
            assert_eq!(found, lines);
            assert_eq!(text.line_count(), lines.len());
        }
    }

    #[test]
    fn a_line_is_found_by_number_and_by_byte() {
        let bytes: String = (0..1000).map(|line| format!("{line}\n")).collect();
        let text = text(bytes.as_bytes());
        for first in [0, 1, 15, 16, 17, 500, 999] {
            let line = text.lines(first..first + 1).next().unwrap();
            assert_eq!(
                (line.number, line.text),
                (first, first.to_string().as_bytes())
            );
            assert_eq!(text.line_at(line.at), first);
            assert_eq!(text.line_at(line.at + line.text.len()), first);
        }
        assert_eq!(text.lines(990..1010).count(), 11);
        assert_eq!(text.lines(5000..5010).count(), 0);
    }

    #[test]
    fn columns_count_what_is_seen() {
        let line = Line {
            number: 0,
            at: 100,
            text: "\ta\u{e9}b\t\u{1}c\u{ff}".as_bytes(),
        };
        let (shown, from) = line.part(0..100);
        assert_eq!((shown.as_str(), from), ("    a\u{e9}b \u{b7}c\u{ff}", 0));
        assert_eq!(line.part(5..8), ("\u{e9}b ".to_owned(), 5));
        for (byte, column) in [
            (0, 0),
            (1, 4),
            (2, 5),
            (4, 6),
            (5, 7),
            (6, 8),
            (7, 9),
            (500, 11),
        ] {
            assert_eq!(line.column_of(100 + byte), column, "{byte}");
        }
        for (column, byte) in [
            (0, 0),
            (3, 0),
            (4, 1),
            (5, 2),
            (6, 4),
            (7, 5),
            (8, 6),
            (99, 10),
        ] {
            assert_eq!(line.byte_at(column), 100 + byte, "{column}");
        }
        let broken = Line {
            number: 0,
            at: 0,
            text: b"a\xff\xfeb",
        };
        assert_eq!(broken.part(0..9).0, "a\u{fffd}\u{fffd}b");
    }

    #[test]
    fn a_line_of_megabytes_is_cut_not_walked() {
        let long = vec![b'7'; 4 << 20];
        let line = Line {
            number: 0,
            at: 0,
            text: &long,
        };
        assert_eq!(
            line.part(3_000_000..3_000_004),
            ("7777".to_owned(), 3_000_000)
        );
        assert_eq!(line.column_of(2_000_000), 2_000_000);
        assert_eq!(line.byte_at(9 << 20), long.len());
    }

    #[test]
    fn frames_joints_and_columns_stand_where_they_are_shown() {
        let file = "HIERARCHY\nROOT hip\n{\n  OFFSET 0 0 0\n  CHANNELS 3 Xposition Yposition Zposition\n  JOINT knee\n  {\n    \
                    OFFSET 0 1 0\n    CHANNELS 2 Zrotation Xrotation\n    End Site\n    {\n      OFFSET 0 1 0\n    }\n  }\n}\n\
                    MOTION\nFrames: 2\nFrame Time: 0.5\n1 2 3 4 5\n6 7 8\n9 10\n";
        let text = text(file.as_bytes());
        let document = bvh::read(file.as_bytes()).unwrap().document;
        let knee = JointId::new(1);
        assert_eq!(columns_of(&document, knee), 3..5);
        assert_eq!(text.frame_count(), 2);
        let row = text.row(1).unwrap();
        assert_eq!(&file[row.clone()], "6 7 8\n9 10");
        assert_eq!((text.line_at(row.start), text.line_at(row.end)), (19, 20));
        assert_eq!(text.frame_at(row.end), Some(1));
        assert_eq!(text.frame_at(0), None);
        assert!(file[text.joint(knee).unwrap()].starts_with("JOINT knee"));
        let shown: Vec<_> = text
            .values(0..file.len(), std::slice::from_ref(&(3..5)))
            .into_iter()
            .map(|place| &file[place])
            .collect();
        assert_eq!(shown, ["4 5", "9 10"]);
        assert_eq!(text.values(row, std::slice::from_ref(&(0..1))).len(), 1);
    }
}
