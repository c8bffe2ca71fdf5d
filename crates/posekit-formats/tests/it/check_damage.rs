//! Ways to damage a clip, each by a given amount.

use posekit_formats::bvh::Bvh;

use crate::check_clip::{Clip, position_columns, rotation_columns};

/// Angles of one joint that are wrong by so many degrees, for some frames from the middle on.
pub(crate) fn rotation_spike(clip: &Clip, degrees: f64, frame_count: usize) -> Bvh {
    let column = rotation_columns(&clip.bvh, clip.free_joint)[1];
    let frames = clip.middle()..clip.middle() + frame_count;
    clip.changed(|frame, row| {
        if frames.contains(&frame) {
            row[column] += degrees;
        }
    })
}

/// Angles of one joint that are wrong by so many degrees, from the middle to the end.
pub(crate) fn rotation_jump(clip: &Clip, degrees: f64) -> Bvh {
    rotation_spike(clip, degrees, clip.frame_count())
}

/// The figure somewhere else by a share of its height, from the middle to the end.
pub(crate) fn teleport(clip: &Clip, heights: f64) -> Bvh {
    position_spike(clip, heights, clip.frame_count())
}

/// The figure somewhere else by a share of its height, for some frames from the middle on.
pub(crate) fn position_spike(clip: &Clip, heights: f64, frame_count: usize) -> Bvh {
    let frames = clip.middle()..clip.middle() + frame_count;
    let along_axis = heights * clip.height * 0.5_f64.sqrt();
    clip.changed(|frame, row| {
        if frames.contains(&frame) {
            row[clip.root_columns[0]] += along_axis;
            row[clip.root_columns[2]] -= along_axis;
        }
    })
}

/// The middle frame repeated for so many seconds.
pub(crate) fn freeze(clip: &Clip, secs: f64) -> Bvh {
    let (at, columns) = (clip.middle(), clip.bvh.channel_count());
    let row = clip.bvh.row(at).to_vec();
    let repeats = clip.frames_in(secs);
    let mut frozen = clip.bvh.clone();
    let motion = frozen.motion.as_mut().unwrap();
    motion
        .values
        .splice(at * columns..at * columns, row.repeat(repeats));
    motion.frame_count += repeats;
    frozen
}

/// The whole figure drifting along an axis (0 or 2), in heights a second.
pub(crate) fn drift(clip: &Clip, axis: usize, heights_per_sec: f64) -> Bvh {
    let per_frame = heights_per_sec * clip.height * clip.frame_time_secs();
    clip.changed(|frame, row| row[clip.root_columns[axis]] += per_frame * frame as f64)
}

/// The figure on the spot: its path along the floor is taken off, smoothed over two steps so that
/// it still sways. `None` for a figure that goes less far than its height.
pub(crate) fn on_the_spot(clip: &Clip) -> Option<Bvh> {
    let axes = [clip.root_columns[0], clip.root_columns[2]];
    let frame_count = clip.frame_count();
    let path = |column: usize| -> Vec<f64> {
        (0..frame_count)
            .map(|frame| clip.bvh.row(frame)[column])
            .collect()
    };
    let paths = axes.map(path);
    let way = |path: &[f64]| path[frame_count - 1] - path[0];
    if way(&paths[0]).hypot(way(&paths[1])) < clip.height {
        return None;
    }
    let half = clip.frames_in(0.6);
    let smooth = |path: &[f64], frame: usize| {
        let last = frame_count - 1;
        let around = (frame..=frame + 2 * half).map(|at| path[at.saturating_sub(half).min(last)]);
        around.sum::<f64>() / (2 * half + 1) as f64
    };
    Some(clip.changed(|frame, row| {
        for (&column, path) in axes.iter().zip(&paths) {
            row[column] -= smooth(path, frame);
        }
    }))
}

/// The figure sinking by a share of its height for about a second in the middle, and rising again.
pub(crate) fn sink(clip: &Clip, heights: f64) -> Bvh {
    let (at, ramp) = (clip.middle(), clip.frames_in(0.25));
    clip.changed(|frame, row| {
        let share = plateau(frame, at - 2 * ramp.min(at / 2), at + 2 * ramp, ramp);
        row[clip.root_columns[1]] -= heights * clip.height * share;
    })
}

/// A bone longer by a factor for 20 frames; `None` where bones have no position channels.
pub(crate) fn stretch(clip: &Clip, factor: f64) -> Option<Bvh> {
    let columns = position_columns(&clip.bvh, clip.free_joint)?;
    let frames = clip.middle()..clip.middle() + 20;
    Some(clip.changed(|frame, row| {
        if frames.contains(&frame) {
            for column in columns {
                row[column] *= factor;
            }
        }
    }))
}

/// The same frames, played so many times too fast.
pub(crate) fn played(clip: &Clip, times_too_fast: f64) -> Bvh {
    let mut odd = clip.bvh.clone();
    odd.motion.as_mut().unwrap().frame_time_secs /= times_too_fast;
    odd
}

/// 0 outside a run of frames, 1 inside, with smooth ramps of the given length at both ends.
fn plateau(frame: usize, first: usize, last: usize, ramp: usize) -> f64 {
    let smooth = |t: f64| {
        let t = t.clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let rise = (frame as f64 - first as f64) / ramp as f64;
    let fall = (last as f64 - frame as f64) / ramp as f64;
    smooth(rise) * smooth(fall)
}
