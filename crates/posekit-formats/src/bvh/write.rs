//! The writer: a document to text that every reader takes.

use std::io;

use posekit::motion::{Channel, Motion};
use posekit::rotation::EulerOrder;

use super::decimal::Decimals;
use super::from_motion::Rows;
use super::{Bvh, BvhJoint, EndName, InvalidBvh};

/// How the text looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// How lines end.
    pub line_ending: LineEnding,
    /// How the hierarchy is indented.
    pub indent: Indent,
}

/// How lines end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineEnding {
    /// LF, as on Unix.
    #[default]
    Lf,
    /// CR and LF, as on Windows.
    CrLf,
}

/// What a level of the hierarchy is indented with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Indent {
    /// A tab, as most files have.
    #[default]
    Tab,
    /// This many spaces.
    Spaces(u8),
}

/// How many bytes gather before they are handed to the output.
const BUFFER_BYTES: usize = 1 << 16;

/// Deeper joints are indented no further: the blanks of a chain of thousands would outweigh all else many times.
const MOST_INDENTS: usize = 64;

/// Writes a document with the default options.
///
/// Numbers are the shortest that read back as the same value, in plain decimal notation, since many
/// readers do not take exponents; only beyond 10^±20 there is one. A joint without channels gets
/// `CHANNELS 0`, as many readers want the line. An End Site has its name where and how the file that it came
/// from had it ([`EndName`]). Joints that are not in depth-first order are written in
/// it, as the format demands, and their columns with them. Bytes that would end a name or begin a
/// comment are replaced by `_`.
///
/// # Panics
///
/// When the document is not valid: see [`Bvh::validate`]. One that [`read`](super::read()) gave always is.
pub fn write(bvh: &Bvh) -> Vec<u8> {
    let mut text = Vec::new();
    let result = write_to(bvh, WriteOptions::default(), &mut text);
    assert!(result.is_ok(), "an invalid document: {:?}", bvh.validate());
    text
}

/// Writes a document as [`write()`] does, to any output and with options.
///
/// # Errors
///
/// Those of the output, and [`io::ErrorKind::InvalidInput`] with the [`InvalidBvh`](super::InvalidBvh)
/// inside when the document is not valid; nothing is written then.
pub fn write_to(bvh: &Bvh, options: WriteOptions, mut output: impl io::Write) -> io::Result<()> {
    let (mut text, columns) = begin(bvh, options)?;
    if let Some(motion) = &bvh.motion {
        text.motion_head(motion.frame_count, motion.frame_time_secs);
        write_rows(
            &mut text,
            &columns,
            &motion.values,
            motion.frame_count,
            &mut output,
        )?;
    }
    output.write_all(&text.bytes)?;
    output.flush()
}

/// Writes a motion that comes in pieces, one after the other, as [`write_to`] writes the document that
/// [`Bvh::from_motion`] makes of it whole: a motion of any length in the memory of one piece.
///
/// `head` is of the same skeleton, frame time and translated joints, and need not have frames. There is at least one
/// frame in each piece, and `frame_count` of them in all.
///
/// # Errors
///
/// Those of [`write_to`], and [`io::ErrorKind::InvalidInput`] when the pieces have not `frame_count` frames; what was
/// written until then is no whole file.
pub fn write_motion_to(
    head: &Motion,
    frame_count: usize,
    pieces: impl IntoIterator<Item = Motion>,
    order: EulerOrder,
    options: WriteOptions,
    mut output: impl io::Write,
) -> io::Result<()> {
    let mut rows = Rows::of(head, |_| order);
    let document = Bvh {
        joints: rows.joints(),
        motion: None,
    };
    let (mut text, columns) = begin(&document, options)?;
    text.motion_head(frame_count, head.frame_time_secs());
    let mut values = Vec::new();
    let mut written = 0;
    for piece in pieces {
        values.clear();
        rows.append(&piece, &mut values);
        if !values.iter().all(|value| value.is_finite()) {
            let problem = InvalidBvh::NotFinite;
            return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
        }
        write_rows(
            &mut text,
            &columns,
            &values,
            piece.frame_count(),
            &mut output,
        )?;
        written += piece.frame_count();
    }
    if written != frame_count {
        let what = format!("{written} frames came of a motion of {frame_count}");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    output.write_all(&text.bytes)?;
    output.flush()
}

/// The hierarchy as text, and the columns of a row in the order in which they are written.
fn begin(bvh: &Bvh, options: WriteOptions) -> io::Result<(Text, Vec<usize>)> {
    bvh.validate()
        .map_err(|problem| io::Error::new(io::ErrorKind::InvalidInput, problem))?;
    let order = depth_first_order(&bvh.joints);
    let mut text = Text {
        bytes: Vec::new(),
        line_ending: match options.line_ending {
            LineEnding::Lf => b"\n",
            LineEnding::CrLf => b"\r\n",
        },
        indent: match options.indent {
            Indent::Tab => b"\t".to_vec(),
            Indent::Spaces(count) => vec![b' '; count.into()],
        },
        decimals: Decimals::new(),
    };
    write_hierarchy(&mut text, &bvh.joints, &order);
    let columns = columns_in_order(bvh, &order);
    Ok((text, columns))
}

/// The text so far, and its style.
struct Text {
    bytes: Vec<u8>,
    line_ending: &'static [u8],
    indent: Vec<u8>,
    decimals: Decimals,
}

impl Text {
    fn begin_line(&mut self, depth: usize) {
        for _ in 0..depth.min(MOST_INDENTS) {
            self.bytes.extend_from_slice(&self.indent);
        }
    }

    fn end_line(&mut self) {
        self.bytes.extend_from_slice(self.line_ending);
    }

    fn line(&mut self, depth: usize, content: &[u8]) {
        self.begin_line(depth);
        self.bytes.extend_from_slice(content);
        self.end_line();
    }

    fn motion_head(&mut self, frame_count: usize, frame_time_secs: f64) {
        self.line(0, b"MOTION");
        self.line(0, format!("Frames: {frame_count}").as_bytes());
        self.bytes.extend_from_slice(b"Frame Time: ");
        self.number(frame_time_secs);
        self.end_line();
    }

    fn number(&mut self, value: f64) {
        self.decimals.append(&mut self.bytes, value);
    }
}

/// The joints as the file lists them: each followed by its descendants, siblings in their order.
fn depth_first_order(joints: &[BvhJoint]) -> Vec<usize> {
    let mut children = vec![Vec::new(); joints.len()];
    let mut pending = Vec::new();
    for (index, joint) in joints.iter().enumerate().rev() {
        match joint.parent {
            Some(parent) => children[parent].push(index),
            None => pending.push(index),
        }
    }
    let mut order = Vec::with_capacity(joints.len());
    while let Some(joint) = pending.pop() {
        order.push(joint);
        pending.append(&mut children[joint]);
    }
    order
}

fn write_hierarchy(text: &mut Text, joints: &[BvhJoint], order: &[usize]) {
    text.line(0, b"HIERARCHY");
    let mut open: Vec<usize> = Vec::new();
    for &index in order {
        let joint = &joints[index];
        while open.last().copied() != joint.parent && !open.is_empty() {
            open.pop();
            text.line(open.len(), b"}");
        }
        write_joint(text, joint, open.len());
        open.push(index);
    }
    while open.pop().is_some() {
        text.line(open.len(), b"}");
    }
}

/// Writes a joint's opening, OFFSET and CHANNELS; its closing brace comes after its children.
fn write_joint(text: &mut Text, joint: &BvhJoint, depth: usize) {
    text.begin_line(depth);
    match (joint.is_end_site, joint.parent) {
        (true, _) => text.bytes.extend_from_slice(b"End Site"),
        (false, None) => text.bytes.extend_from_slice(b"ROOT "),
        (false, Some(_)) => text.bytes.extend_from_slice(b"JOINT "),
    }
    match joint.end_name {
        _ if !joint.is_end_site => append_name(&mut text.bytes, &joint.name),
        EndName::Implied => {}
        EndName::Comment => {
            text.bytes.extend_from_slice(b" #name: ");
            append_in_comment(&mut text.bytes, &joint.name);
        }
        EndName::Word => append_word(&mut text.bytes, &joint.name),
    }
    text.end_line();
    text.line(depth, b"{");
    text.begin_line(depth + 1);
    text.bytes.extend_from_slice(b"OFFSET");
    for coordinate in joint.offset {
        text.bytes.push(b' ');
        text.number(coordinate);
    }
    text.end_line();
    if !joint.is_end_site {
        text.begin_line(depth + 1);
        text.bytes
            .extend_from_slice(format!("CHANNELS {}", joint.channels.len()).as_bytes());
        for name in joint.channels.iter().copied().map(Channel::name) {
            text.bytes.push(b' ');
            text.bytes.extend_from_slice(name.as_bytes());
        }
        text.end_line();
    }
}

/// Appends a name so that it reads back: a name that was read is not changed.
fn append_name(bytes: &mut Vec<u8>, name: &[u8]) {
    let name = name.trim_ascii();
    for (at, &byte) in name.iter().enumerate() {
        let after_blank = at > 0 && matches!(name[at - 1], b' ' | b'\t' | 0x0b | 0x0c);
        let begins_comment = byte == b'#' || name[at..].starts_with(b"//");
        let ends_name = matches!(byte, b'{' | b'\n' | b'\r');
        bytes.push(if ends_name || (after_blank && begins_comment) {
            b'_'
        } else {
            byte
        });
    }
}

/// Appends the name of an End Site behind a blank, where a comment could begin at once.
fn append_word(bytes: &mut Vec<u8>, name: &[u8]) {
    bytes.push(b' ');
    let start = bytes.len();
    append_name(bytes, name);
    if bytes[start..].starts_with(b"#") || bytes[start..].starts_with(b"//") {
        bytes[start] = b'_';
    }
}

/// Appends a name that a comment holds: only a brace and a line's end would cut it short.
fn append_in_comment(bytes: &mut Vec<u8>, name: &[u8]) {
    let ends_name = |byte| matches!(byte, b'{' | b'\n' | b'\r');
    let name = name.trim_ascii().iter();
    bytes.extend(name.map(|&byte| if ends_name(byte) { b'_' } else { byte }));
}

fn write_rows(
    text: &mut Text,
    columns: &[usize],
    values: &[f64],
    frame_count: usize,
    output: &mut impl io::Write,
) -> io::Result<()> {
    for frame in 0..frame_count {
        let row = &values[frame * columns.len()..(frame + 1) * columns.len()];
        for (place, &column) in columns.iter().enumerate() {
            if place > 0 {
                text.bytes.push(b' ');
            }
            text.number(row[column]);
        }
        text.end_line();
        if text.bytes.len() >= BUFFER_BYTES {
            output.write_all(&text.bytes)?;
            text.bytes.clear();
        }
    }
    Ok(())
}

/// The columns of a row in the order in which the joints are written.
fn columns_in_order(bvh: &Bvh, order: &[usize]) -> Vec<usize> {
    let starts = bvh.column_starts();
    order
        .iter()
        .flat_map(|&joint| starts[joint]..starts[joint + 1])
        .collect()
}
