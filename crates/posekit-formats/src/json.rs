//! Motion in world space as JSON, for web pages and scripts without NumPy.
//!
//! One object with the names and shapes of the `.npz` archive (see [`npz::write`](crate::npz::write)),
//! arrays as nested lists:
//!
//! ```json
//! {
//! "frame_time": 0.5,
//! "joint_names": ["Hips", "Head"],
//! "parents": [-1, 0],
//! "frames": [0, 1],
//! "positions": [
//! [[0.0,1.0,0.0],[0.0,1.7,0.0]],
//! [[0.0,1.0,0.5],[0.0,1.7,0.5]]
//! ],
//! "orientations": [
//! [[0.0,0.0,0.0,1.0],[0.0,0.0,0.0,1.0]],
//! [[0.0,0.0,0.0,1.0],[0.0,0.0,0.0,1.0]]
//! ]
//! }
//! ```
//!
//! A frame is a line. Numbers are the shortest that read back the same.

use std::io::{self, Write};

use posekit::skeleton::JointId;

use crate::arrays::{AttachedPoint, MotionArrays};
use crate::number_text::NumberText;

/// Writes a motion in world space as one JSON object.
///
/// # Errors
/// When `out` cannot be written, or a number is not finite.
///
/// # Panics
/// If a joint or a frame is not one of the motion's.
pub fn write(arrays: &MotionArrays<'_>, out: &mut impl Write) -> io::Result<()> {
    let motion = arrays.motion;
    let mut text = NumberText::default();
    writeln!(
        out,
        "{{\n\"frame_time\": {},",
        text.of_json(motion.frame_time_secs())
    )?;
    writeln!(
        out,
        "\"joint_names\": {},",
        list(arrays.joint_names().iter().map(|n| quoted(n)))
    )?;
    let parents = arrays.parents();
    let parents = parents
        .iter()
        .map(|parent| parent.map_or("-1".to_owned(), |p| p.to_string()));
    writeln!(out, "\"parents\": {},", list(parents))?;
    writeln!(
        out,
        "\"frames\": {},",
        list(arrays.numbers().iter().map(usize::to_string))
    )?;
    let mut frames = FrameWriter {
        frames: arrays.frames,
        text,
        line: Vec::new(),
        out,
    };
    frames.write("positions", arrays.joints, |frame, joint: &JointId| {
        arrays.position(frame, *joint)
    })?;
    writeln!(frames.out, ",")?;
    frames.write("orientations", arrays.joints, |frame, joint: &JointId| {
        arrays.orientation(frame, *joint)
    })?;
    if !arrays.points.is_empty() {
        let skeleton = motion.skeleton();
        let joints = arrays
            .points
            .iter()
            .map(|point| quoted(skeleton.unique_name(point.joint)));
        writeln!(frames.out, ",\n\"point_joints\": {},", list(joints))?;
        let text = &mut frames.text;
        let offsets = arrays.points.iter().map(|point| {
            let coordinates = point.point_in_joint.to_array();
            list(
                coordinates
                    .map(|value| text.of_json(value).to_owned())
                    .into_iter(),
            )
        });
        let offsets = list(offsets);
        writeln!(frames.out, "\"point_offsets\": {offsets},")?;
        frames.write("points", arrays.points, |frame, point: &AttachedPoint| {
            arrays.point(frame, point)
        })?;
    }
    writeln!(out, "\n}}")
}

/// Writes arrays of shape (F, N, D), a line a frame.
struct FrameWriter<'a, W> {
    frames: &'a [usize],
    text: NumberText,
    line: Vec<u8>,
    out: &'a mut W,
}

impl<W: Write> FrameWriter<'_, W> {
    fn write<T, const D: usize>(
        &mut self,
        name: &str,
        items: &[T],
        value: impl Fn(usize, &T) -> io::Result<[f32; D]>,
    ) -> io::Result<()> {
        write!(self.out, "\"{name}\": [")?;
        for (row, &frame) in self.frames.iter().enumerate() {
            self.line.clear();
            self.line
                .extend_from_slice(if row == 0 { b"\n[" } else { b",\n[" });
            for (place, item) in items.iter().enumerate() {
                self.line
                    .extend_from_slice(if place == 0 { b"[" } else { b",[" });
                for (axis, number) in value(frame, item)?.into_iter().enumerate() {
                    if axis > 0 {
                        self.line.push(b',');
                    }
                    self.line
                        .extend_from_slice(self.text.of_json(number).as_bytes());
                }
                self.line.push(b']');
            }
            self.line.push(b']');
            self.out.write_all(&self.line)?;
        }
        write!(self.out, "\n]")
    }
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

/// A JSON string (RFC 8259, section 7).
fn quoted(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for letter in text.chars() {
        match letter {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            letter if u32::from(letter) < 0x20 => {
                quoted.push_str(&format!("\\u{:04x}", u32::from(letter)));
            }
            letter => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}
