//! Another frame rate.

use posekit::motion::{Channel, FrameTime};
use posekit::rotation::{Axis, EulerOrder, slerp};

use super::EditError;
use super::columns::{rotation_columns, rotation_of};
use crate::bvh::Bvh;

/// A rate this close to a whole number is that number: a file that writes 1/60 s as `0.0166667` means
/// 60 frames a second.
const WHOLE_RATE_TOLERANCE: f64 = 1e-4;

/// A new frame this close to an old one, in frames, is the old one.
const SAME_FRAME_TOLERANCE: f64 = 1e-6;

/// More values than this are refused: 32 GiB.
const MAX_VALUES: f64 = (1u64 << 32) as f64;

/// Gives the motion `fps` frames a second over the same time, from its first frame.
///
/// A new frame that falls on an old one is that one, to the bit. Between two frames a joint with
/// three rotation channels is turned by slerp, the short way, and its angles are those closest to
/// the frame before; positions, and rotations of joints with other than three distinct axes, go
/// linearly, angles the short way round.
///
/// # Errors
/// When there is no motion, it has no frame time, or the rate is none that frames can have, or makes more of them
/// than fit in memory.
pub fn resample(bvh: &mut Bvh, fps: f64) -> Result<(), EditError> {
    let motion = bvh.motion.as_ref().ok_or(EditError::NoMotion)?;
    let new = FrameTime::of_rate(fps)?;
    let old_fps = rate(motion.frame_time()).ok_or(EditError::NoFrameTime)?;
    if rate(new) == Some(old_fps) {
        return Ok(());
    }
    let step = old_fps / fps;
    let width = bvh.channel_count();
    let Some(last) = motion.frame_count.checked_sub(1) else {
        return set_frames(bvh, new, 0, Vec::new());
    };
    let new_last = (as_f64(last) / step + SAME_FRAME_TOLERANCE).floor();
    if (new_last + 1.0) * as_f64(width.max(1)) > MAX_VALUES {
        return Err(EditError::TooManyFrames { fps });
    }
    let frame_count = as_count(new_last) + 1;
    let mut sampler = Sampler::new(bvh);
    let places = (0..frame_count).map(|frame| (as_f64(frame) * step).min(as_f64(last)));
    let on_old_frames = places.clone().all(is_whole);
    let mut values = Vec::with_capacity(frame_count * width);
    for place in places {
        if is_whole(place) {
            let row = bvh.row(as_count(place.round()));
            if on_old_frames {
                values.extend_from_slice(row)
            } else {
                sampler.copy(row, &mut values)
            }
        } else {
            let frame = as_count(place.floor());
            sampler.between(
                bvh.row(frame),
                bvh.row(frame + 1),
                place.fract(),
                &mut values,
            );
        }
    }
    set_frames(bvh, new, frame_count, values)
}

fn set_frames(
    bvh: &mut Bvh,
    frame_time: FrameTime,
    frame_count: usize,
    values: Vec<f64>,
) -> Result<(), EditError> {
    let motion = bvh.motion.as_mut().ok_or(EditError::NoMotion)?;
    motion.frame_time_secs = frame_time.secs();
    motion.frame_count = frame_count;
    motion.values = values;
    Ok(())
}

/// Frames a second, whole where the file means a whole number.
fn rate(frame_time: FrameTime) -> Option<f64> {
    let fps = frame_time.frames_per_sec()?;
    let whole = fps.round();
    Some(
        if whole >= 1.0 && ((fps - whole) / whole).abs() <= WHOLE_RATE_TOLERANCE {
            whole
        } else {
            fps
        },
    )
}

fn is_whole(place: f64) -> bool {
    (place - place.round()).abs() <= SAME_FRAME_TOLERANCE
}

#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
fn as_f64(count: usize) -> f64 {
    count as f64
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a frame number, checked to be in range"
)]
fn as_count(whole: f64) -> usize {
    whole as usize
}

/// How one joint's or one coordinate's numbers go from one frame to the next.
enum Path {
    /// Three rotation channels about three axes: by slerp.
    Turn {
        columns: Vec<(usize, Axis)>,
        order: EulerOrder,
    },
    /// One angle: linearly, the short way round.
    Angle(usize),
    /// One length: linearly.
    Length(usize),
}

struct Sampler {
    paths: Vec<Path>,
    /// The row before, for angles that continue it.
    previous: Option<Vec<f64>>,
}

impl Sampler {
    fn new(bvh: &Bvh) -> Self {
        let starts = bvh.column_starts();
        let mut paths = Vec::new();
        for (joint, &start) in bvh.joints.iter().zip(&starts) {
            for (place, channel) in joint.channels.iter().enumerate() {
                if matches!(channel, Channel::Position(_)) {
                    paths.push(Path::Length(start + place));
                }
            }
            let columns = rotation_columns(&joint.channels, start);
            match whole_order(&columns) {
                Some(order) => paths.push(Path::Turn { columns, order }),
                None => paths.extend(columns.iter().map(|&(column, _)| Path::Angle(column))),
            }
        }
        Self {
            paths,
            previous: None,
        }
    }

    /// An old row, its angles moved by whole turns to continue the row before.
    fn copy(&mut self, row: &[f64], values: &mut Vec<f64>) {
        let mut new = row.to_vec();
        if let Some(previous) = &self.previous {
            for path in &self.paths {
                match path {
                    Path::Turn { columns, order } => {
                        let angles = angles_at(row, columns);
                        let before = angles_at(previous, columns);
                        let near = order.closest_equivalent_deg(angles, before);
                        set_angles(&mut new, columns, near);
                    }
                    Path::Angle(column) => {
                        new[*column] = near_angle(row[*column], previous[*column]);
                    }
                    Path::Length(_) => {}
                }
            }
        }
        self.push(new, values);
    }

    fn between(&mut self, from: &[f64], to: &[f64], t: f64, values: &mut Vec<f64>) {
        let mut new = from.to_vec();
        let previous = self.previous.as_deref().unwrap_or(from);
        for path in &self.paths {
            match path {
                Path::Turn { columns, order } => {
                    let before = angles_at(previous, columns);
                    let (a, b) = (angles_at(from, columns), angles_at(to, columns));
                    let near = if a == b {
                        // Nothing turns: the file's own digits.
                        order.closest_equivalent_deg(a, before)
                    } else {
                        let (from, to) = (rotation_of(from, columns), rotation_of(to, columns));
                        let rotation = slerp(from, to, t);
                        let near = order.from_quat_near(rotation, before.map(f64::to_radians));
                        near.angles_rad.map(f64::to_degrees)
                    };
                    set_angles(&mut new, columns, near);
                }
                Path::Angle(column) => {
                    let (a, b) = (from[*column], near_angle(to[*column], from[*column]));
                    new[*column] = near_angle(mix(a, b, t), previous[*column]);
                }
                Path::Length(column) => new[*column] = mix(from[*column], to[*column], t),
            }
        }
        self.push(new, values);
    }

    fn push(&mut self, row: Vec<f64>, values: &mut Vec<f64>) {
        values.extend_from_slice(&row);
        self.previous = Some(row);
    }
}

/// The order of rotation columns that name each axis once.
pub(in crate::bvh) fn whole_order(columns: &[(usize, Axis)]) -> Option<EulerOrder> {
    let axes: Vec<Axis> = columns.iter().map(|&(_, axis)| axis).collect();
    let all = Axis::ALL.iter().all(|axis| axes.contains(axis));
    if axes.len() == 3 && all {
        EulerOrder::new(&axes).ok()
    } else {
        None
    }
}

pub(in crate::bvh) fn angles_at(row: &[f64], columns: &[(usize, Axis)]) -> [f64; 3] {
    [0, 1, 2].map(|place| row[columns[place].0])
}

pub(in crate::bvh) fn set_angles(row: &mut [f64], columns: &[(usize, Axis)], angles: [f64; 3]) {
    for (&(column, _), angle) in columns.iter().zip(angles) {
        row[column] = angle;
    }
}

/// `angle` moved by full turns to the one nearest to `other`, in degrees.
pub(in crate::bvh) fn near_angle(angle: f64, other: f64) -> f64 {
    let turns = ((other - angle) / 360.0).round();
    if turns == 0.0 {
        angle
    } else {
        angle + turns * 360.0
    }
}

pub(in crate::bvh) fn mix(from: f64, to: f64, t: f64) -> f64 {
    if from == to {
        from
    } else {
        from + (to - from) * t
    }
}
