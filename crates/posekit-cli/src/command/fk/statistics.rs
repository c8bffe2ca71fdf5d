//! What a joint does over a motion, in a few numbers.

use glam::Vec3;
use posekit::skeleton::JointId;
use posekit_formats::arrays::MotionArrays;

/// A joint's way through the world over the selected frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JointTravel {
    /// Position at the first frame.
    pub(super) first: Vec3,
    /// Position at the last frame.
    pub(super) last: Vec3,
    /// Lowest coordinates.
    pub(super) low: Vec3,
    /// Highest coordinates.
    pub(super) high: Vec3,
    /// Length of the way, in the file's unit.
    pub(super) path_length: f64,
    /// Highest speed from one selected frame to the next, in the file's unit a second; `None` where
    /// no time passes.
    pub(super) top_speed: Option<f64>,
}

impl JointTravel {
    /// The way of a joint. There is at least one frame.
    pub(super) fn of(arrays: &MotionArrays<'_>, joint: JointId) -> Self {
        let position = |frame: usize| arrays.motion.position(frame, joint);
        let first = arrays.frames.first().map_or(Vec3::ZERO, |&f| position(f));
        let mut travel = Self {
            first,
            last: first,
            low: first,
            high: first,
            path_length: 0.0,
            top_speed: None,
        };
        // By frames, not by seconds: a division for each step would cost as much as all else.
        let mut farthest_in_a_frame = f64::NEG_INFINITY;
        let frames = arrays.frames.iter().skip(1);
        for (pair, &frame) in arrays.numbers().windows(2).zip(frames) {
            let place = position(frame);
            let distance = f64::from(place.distance(travel.last));
            travel.last = place;
            travel.low = travel.low.min(place);
            travel.high = travel.high.max(place);
            travel.path_length += distance;
            let per_frame = match pair[1].abs_diff(pair[0]) {
                0 => continue,
                1 => distance,
                frames => distance / frame_number(frames),
            };
            farthest_in_a_frame = farthest_in_a_frame.max(per_frame);
        }
        let frame_time_secs = arrays.motion.frame_time_secs();
        travel.top_speed = (frame_time_secs > 0.0 && farthest_in_a_frame >= 0.0)
            .then(|| farthest_in_a_frame / frame_time_secs);
        travel
    }
}

#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
fn frame_number(frame: usize) -> f64 {
    frame as f64
}
