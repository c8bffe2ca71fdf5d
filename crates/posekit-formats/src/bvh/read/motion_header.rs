//! `Frames:` and `Frame Time:`, in either order and with any spacing.

use super::number;
use super::scan::Scanner;
use crate::report::{ReadError, WarningCode};
use posekit::motion::FrameTime;

/// The frame time when the file gives none: 30 frames a second, what the first BVH files had.
const DEFAULT_FRAME_TIME_SECS: f64 = 1.0 / 30.0;

/// What the lines between MOTION and the rows say.
#[derive(Debug)]
pub(super) struct MotionHeader {
    /// The announced number of frames, if it makes sense.
    pub(super) frame_count: Option<usize>,
    /// Where it stands.
    pub(super) frame_count_at: usize,
    pub(super) frame_time_secs: f64,
    /// Where the header's last number ends.
    pub(super) ends_at: usize,
}

/// Reads the header; the scanner stands after MOTION and is left before the rows.
pub(super) fn read(scanner: &mut Scanner<'_>) -> Result<MotionHeader, ReadError> {
    let motion_at = scanner.pos;
    let mut frames: Option<(usize, Option<usize>)> = None;
    let mut frame_time = None;
    let mut ends_at = motion_at;
    loop {
        if scanner.take_keyword("Frames") {
            frames = Some(read_frame_count(scanner)?);
        } else if scanner.take_keyword("FrameTime") {
            frame_time = Some(read_frame_time(scanner)?);
        } else if scanner.take_keyword("Frame") {
            if !scanner.take_keyword("Time") {
                return Err(scanner.unexpected("`Time` after `Frame`"));
            }
            frame_time = Some(read_frame_time(scanner)?);
        } else {
            break;
        }
        ends_at = scanner.pos;
    }
    if frames.is_none() {
        scanner.warn(WarningCode::MissingFrameCount, motion_at, || {
            "MOTION without `Frames:`, the rows are counted".into()
        });
    }
    if frame_time.is_none() {
        scanner.warn(WarningCode::MissingFrameTime, motion_at, || {
            "MOTION without `Frame Time:`, 1/30 s is used".into()
        });
    }
    let (frame_count_at, frame_count) = frames.unwrap_or((motion_at, None));
    let frame_time_secs = frame_time.unwrap_or(DEFAULT_FRAME_TIME_SECS);
    Ok(MotionHeader {
        frame_count,
        frame_count_at,
        frame_time_secs,
        ends_at,
    })
}

fn skip_colon(scanner: &mut Scanner<'_>) {
    scanner.skip_blanks();
    if scanner.peek() == Some(b':') {
        scanner.pos += 1;
        scanner.skip_blanks();
    }
}

/// The frame count and where it stands; no count when it is negative or not whole.
fn read_frame_count(scanner: &mut Scanner<'_>) -> Result<(usize, Option<usize>), ReadError> {
    skip_colon(scanner);
    let at = scanner.pos;
    let number = number::read(scanner, "the number of frames")?;
    let count = whole(number);
    if count.is_none() {
        scanner.warn(WarningCode::MissingFrameCount, at, || {
            format!("{number} is no possible number of frames, the rows are counted")
        });
    }
    Ok((at, count))
}

fn read_frame_time(scanner: &mut Scanner<'_>) -> Result<f64, ReadError> {
    skip_colon(scanner);
    let at = scanner.pos;
    let secs = number::read(scanner, "the frame time in seconds")?;
    if let Err(error) = FrameTime::new(secs) {
        scanner.warn(WarningCode::BadFrameTime, at, || {
            format!("{error}; it is kept as the file says, and all frames count as at one time")
        });
    }
    Ok(secs)
}

/// The number as a count, if it is one. Counts that no file could hold are cut short to one that no
/// file could hold either.
fn whole(number: f64) -> Option<usize> {
    const HUGE: f64 = (1_u64 << 53) as f64;
    if number < 0.0 || number.fract() != 0.0 {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "between 0 and 2^53")]
    #[expect(clippy::cast_sign_loss, reason = "between 0 and 2^53")]
    let count = number.min(HUGE) as u64;
    Some(usize::try_from(count).unwrap_or(usize::MAX))
}
