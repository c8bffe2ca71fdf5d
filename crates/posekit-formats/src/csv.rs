//! Motion in world space as comma-separated values, for spreadsheets and data frames.
//!
//! One row a frame: `frame,time`, then for every joint `NAME.px,NAME.py,NAME.pz` (position) and
//! `NAME.qx,NAME.qy,NAME.qz,NAME.qw` (orientation), then for every attached point
//! `NAME#0.px,NAME#0.py,NAME#0.pz`. `time` is in seconds from frame 0. Names are quoted where they
//! hold a comma, a quote or a line end (RFC 4180). Numbers are the shortest that read back the same;
//! lines end in a line feed.

use std::io::{self, Write};

use crate::arrays::MotionArrays;
use crate::number_text::NumberText;

/// Writes a motion in world space, a row a frame.
///
/// # Errors
/// When `out` cannot be written, or a number is not finite.
///
/// # Panics
/// If a joint or a frame is not one of the motion's.
pub fn write(arrays: &MotionArrays<'_>, out: &mut impl Write) -> io::Result<()> {
    out.write_all(header(arrays).as_bytes())?;
    let mut text = NumberText::default();
    let mut row = Vec::new();
    for (&frame, &number) in arrays.frames.iter().zip(arrays.numbers()) {
        row.clear();
        row.extend_from_slice(number.to_string().as_bytes());
        row.push(b',');
        row.extend_from_slice(text.of(arrays.time_secs(number)).as_bytes());
        let mut push = |values: &[f32]| {
            for &value in values {
                row.push(b',');
                row.extend_from_slice(text.of(value).as_bytes());
            }
        };
        for &joint in arrays.joints {
            push(&arrays.position(frame, joint)?);
            push(&arrays.orientation(frame, joint)?);
        }
        for point in arrays.points {
            push(&arrays.point(frame, point)?);
        }
        row.push(b'\n');
        out.write_all(&row)?;
    }
    Ok(())
}

fn header(arrays: &MotionArrays<'_>) -> String {
    let mut line = String::from("frame,time");
    let mut column = |name: &str, suffix: &str| {
        line.push(',');
        line.push_str(&quoted(&format!("{name}.{suffix}")));
    };
    for name in arrays.joint_names() {
        ["px", "py", "pz", "qx", "qy", "qz", "qw"]
            .iter()
            .for_each(|suffix| column(name, suffix));
    }
    for index in 0..arrays.points.len() {
        let name = arrays.point_name(index);
        ["px", "py", "pz"]
            .iter()
            .for_each(|suffix| column(&name, suffix));
    }
    line.push('\n');
    line
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
