//! Some of the frames, and how fast they follow each other.

use std::ops::Range;

use super::EditError;
use crate::bvh::Bvh;
use posekit::motion::FrameTime;

/// Keeps the frames `range`, counted from 0; a range that goes past the end stops there.
///
/// # Errors
/// When there is no motion, or no frame in the range.
pub fn trim(bvh: &mut Bvh, range: Range<usize>) -> Result<(), EditError> {
    let width = bvh.channel_count();
    let motion = bvh.motion.as_mut().ok_or(EditError::NoMotion)?;
    let (start, end) = (range.start, range.end.min(motion.frame_count));
    if start >= end {
        let frame_count = motion.frame_count;
        return Err(EditError::EmptyTrim {
            start,
            end: range.end,
            frame_count,
        });
    }
    motion.values.truncate(end * width);
    motion.values.drain(..start * width);
    motion.frame_count = end - start;
    Ok(())
}

/// Plays the same frames at another speed: only the frame time changes, and no value.
///
/// # Errors
/// When there is no motion, or the time is none that frames can have ([`FrameTime`]).
pub fn set_frame_time(bvh: &mut Bvh, frame_time_secs: f64) -> Result<(), EditError> {
    let motion = bvh.motion.as_mut().ok_or(EditError::NoMotion)?;
    motion.frame_time_secs = FrameTime::new(frame_time_secs)?.secs();
    Ok(())
}
