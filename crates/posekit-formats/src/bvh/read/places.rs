//! Where in a file's bytes that stands which was read of it: the lines of joints, the rows of frames, the
//! values of channels.

use std::ops::{ControlFlow, Range};

use super::motion::Wanted;
use super::scan::{Comma, Scanner};
use super::{ReadOptions, RowParser, number, read_document};
use crate::report::ReadError;

/// Where the parts of a document stand in the bytes that it was read from, as byte offsets.
///
/// The places are those of the very values that [`read()`](super::read()) gives: where rows are wrapped, share a
/// line, or were dropped because they are damaged, too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Places {
    /// Of each joint of the document, its own lines: from its keyword to the end of its CHANNELS, or of
    /// its OFFSET where it has no channels. The joints below it are not among them.
    pub joints: Vec<Range<usize>>,
    /// Of each frame, the first byte of its first value. They rise.
    pub rows: Vec<usize>,
    channel_count: usize,
    comma: Comma,
}

/// Finds the places of everything in a file that can be read. It reads the whole file with the careful
/// parser: about a third as fast as [`read()`](super::read()). Eight bytes a frame are kept.
///
/// ```
/// use posekit_formats::bvh::locate;
///
/// let text = b"HIERARCHY ROOT hip { OFFSET 0 0 0 CHANNELS 2 Xrotation Yrotation End Site { OFFSET 0 1 0 } }
/// MOTION Frames: 2 Frame Time: 0.5
/// 1 2
/// 3 4.5
/// ";
/// let places = locate(text)?;
/// assert_eq!(&text[places.joints[0].clone()][..8], b"ROOT hip");
/// let values = places.values_of_row(text, 1);
/// assert_eq!(&text[values[1].clone()], b"4.5");
/// assert_eq!(places.frame_at(values[1].start), Some(1));
/// # Ok::<(), posekit_formats::report::ReadError>(())
/// ```
///
/// # Errors
///
/// As [`read()`](super::read()).
pub fn locate(bytes: &[u8]) -> Result<Places, ReadError> {
    let options = ReadOptions {
        row_parser: RowParser::Careful,
        ..ReadOptions::default()
    };
    let mut rows = Vec::new();
    let wanted = Wanted {
        starts: Some(&mut rows),
        ..Wanted::default()
    };
    let mut progress = |_| ControlFlow::Continue(());
    let read = read_document(bytes, options, &mut progress, wanted)?;
    let joints = &read.import.document.joints;
    Ok(Places {
        channel_count: joints.iter().map(|joint| joint.channels.len()).sum(),
        joints: read.texts,
        rows,
        comma: read.comma,
    })
}

impl Places {
    /// The frame whose row a byte belongs to: the last that begins there or before. `None` before the first
    /// row.
    #[must_use]
    pub fn frame_at(&self, at: usize) -> Option<usize> {
        self.rows
            .partition_point(|&start| start <= at)
            .checked_sub(1)
    }

    /// Where each value of a frame's row stands, in the order of the channels. `bytes` are those that were
    /// located; with others, or for a frame that there is not, what comes back means nothing, and may be
    /// fewer values.
    #[must_use]
    pub fn values_of_row(&self, bytes: &[u8], frame: usize) -> Vec<Range<usize>> {
        let Some(&start) = self.rows.get(frame) else {
            return Vec::new();
        };
        // Nothing is looked at beyond the next row, nor any place before this one.
        let end = self.rows.get(frame + 1).copied().unwrap_or(bytes.len());
        let Some(text) = bytes.get(start..end.max(start)) else {
            return Vec::new();
        };
        let mut scanner = Scanner::new(text);
        scanner.comma = self.comma;
        let mut values = Vec::with_capacity(self.channel_count.min(text.len()));
        while values.len() < self.channel_count {
            scanner.skip_blanks();
            let from = scanner.pos;
            if number::read(&mut scanner, "a number").is_err() {
                break;
            }
            values.push(start + from..start + scanner.pos);
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::read;

    const HEAD: &str = "HIERARCHY
ROOT hip
{
  OFFSET 0 0 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  JOINT knee {
    OFFSET 0 -1 0 CHANNELS 1 Xrotation
    End Site { OFFSET 0 -1 0 }
  }
}
MOTION
Frames: 1
Frame Time: 0.1
";

    /// Every value that is read stands where the places say.
    fn assert_found(rows: &str) -> Places {
        let text = format!("{HEAD}{rows}");
        let bytes = text.as_bytes();
        let document = read(bytes).unwrap().document;
        let places = locate(bytes).unwrap();
        let motion = document.motion.unwrap();
        assert_eq!(places.rows.len(), motion.frame_count, "{rows}");
        for (frame, row) in motion.values.chunks(4).enumerate() {
            let values = places.values_of_row(bytes, frame);
            assert_eq!(values.len(), 4, "{rows}");
            for (value, place) in row.iter().zip(&values) {
                let written: f64 = text[place.clone()].replace(',', ".").parse().unwrap();
                assert_eq!(written, *value, "{rows}");
                assert_eq!(places.frame_at(place.start), Some(frame));
            }
        }
        places
    }

    #[test]
    fn values_stand_where_they_are_said_to() {
        for rows in [
            "1 2 3 4\n5 6 7 8\n9 10 11 12\n",
            "1 2 3 4\r\n5 6 7 8\r\n9 10 11 12",
            "1 2 3 4\r5 6 7 8\r9 10 11 12\r",
            "\t1.5\t-2e1\t.5  4.\n\n\n5 6 7 8\n   9 10 11 12\n",
            "1 2\n3 4\n5 6\n7 8\n9 10\n11 12\n",
            "1 2 3 4 5 6 7 8 9 10 11 12\n",
            "1-2-3+4\n5 6 7 8\n9 10 11 12\n",
            "1 2 3 4 # one\n// two\n5 6 7 8\n9, 10, 11, 12\n",
            "1,5 2,5 3,5 4,5\n5,5 6,5 7,5 8,5\n9 10 11 12\n",
            "1 2 3 4\n5 6 7 8\n9 10 11 12\n1 2\n",
            "1 2 3 4\n",
            "",
        ] {
            assert_found(rows);
        }
    }

    #[test]
    fn a_damaged_row_is_no_frame() {
        // The second line has lost a value, so that it is dropped and the others keep their step.
        let places = assert_found("1 2 3 4\n5 6 7\n9 10 11 12\n13 14 15 16\n17 18 19 20\n");
        let text = format!("{HEAD}1 2 3 4\n5 6 7\n9 10 11 12\n");
        let third_line = text.find("9 10").unwrap();
        assert_eq!(places.rows[1], third_line);
    }

    #[test]
    fn joints_have_their_own_lines() {
        let text = format!("{HEAD}1 2 3 4\n");
        let places = locate(text.as_bytes()).unwrap();
        let own: Vec<&str> = places
            .joints
            .iter()
            .map(|joint| &text[joint.clone()])
            .collect();
        assert!(
            own[0].starts_with("ROOT hip") && own[0].ends_with("Zrotation Xrotation Yrotation")
        );
        assert!(own[1].starts_with("JOINT knee") && own[1].ends_with("CHANNELS 1 Xrotation"));
        assert_eq!(own[2], "End Site { OFFSET 0 -1 0");
    }

    #[test]
    fn bytes_that_were_not_located_give_no_panic() {
        let text = format!("{HEAD}1 2 3 4\n5 6 7 8\n");
        let places = locate(text.as_bytes()).unwrap();
        for length in 0..text.len() {
            for frame in 0..3 {
                let _ = places.values_of_row(&text.as_bytes()[..length], frame);
            }
        }
        assert!(locate(b"nonsense").is_err());
    }
}
