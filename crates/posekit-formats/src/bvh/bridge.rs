//! Values that are not numbers, and bridges over them.
//!
//! `nan`, `inf` and their like stand in files where a marker was lost or a program divided by zero. They
//! are no motion, so [`read`](super::read()) refuses them; [`read_with_gaps`](super::read_with_gaps) says
//! where they are instead, and [`bridge_gaps`] fills them on request from the frames on both sides:
//! rotations by spherical linear interpolation (Shoemake, "Animating rotation with quaternion curves",
//! SIGGRAPH 1985), the short way, positions in a straight line. At the beginning and the end of a file the
//! nearest frame is held. A joint whose rotation lacks one angle lacks the rotation: all its angles are
//! bridged, and are those closest to the frame before.

use posekit::check::FrameRange;
use posekit::motion::Channel;
use posekit::rotation::slerp;

use super::edit::columns::{rotation_columns, rotation_of};
use super::edit::resample::{angles_at, mix, near_angle, set_angles, whole_order};
use super::{Bvh, Change, ChangeCode};

/// A value that is no number, or none that a motion can be made of
/// ([`Bvh::values_out_of_range`](super::Bvh::values_out_of_range)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Gap {
    /// Its frame, counted from 0.
    pub frame: usize,
    /// Its column in the frame's row.
    pub column: usize,
}

/// The values of one joint that are not numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointGaps {
    /// The joint's index.
    pub joint: usize,
    /// The runs of frames in which at least one value is none, in order; not empty.
    pub runs: Vec<FrameRange>,
    /// How many values are none.
    pub count: usize,
}

/// Why a gap was not bridged. The document is as it was before.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GapError {
    /// A gap is longer than was allowed.
    #[error("the gap of {joint} in {frames} is longer than {most} frames")]
    TooLong {
        /// The joint's name.
        joint: String,
        /// Where the gap is.
        frames: FrameRange,
        /// How many frames a gap may have.
        most: usize,
    },
    /// A channel has no number in any frame.
    #[error(
        "{joint} has a channel that is not a number in any frame, so there is nothing to bridge from"
    )]
    NothingThere {
        /// The joint's name.
        joint: String,
    },
}

/// The gaps by joint, in the order of the joints. `gaps` are sorted, as
/// [`read_with_gaps`](super::read_with_gaps) gives them.
pub fn gaps_by_joint(bvh: &Bvh, gaps: &[Gap]) -> Vec<JointGaps> {
    let starts = bvh.column_starts();
    let mut by_joint: Vec<JointGaps> = (0..bvh.joints.len())
        .map(|joint| JointGaps {
            joint,
            runs: Vec::new(),
            count: 0,
        })
        .collect();
    for gap in gaps {
        if let Some(of_joint) = by_joint.get_mut(joint_of(&starts, gap.column)) {
            of_joint.count += 1;
            add_frame(&mut of_joint.runs, gap.frame);
        }
    }
    by_joint.retain(|of_joint| of_joint.count > 0);
    by_joint
}

/// The joint that a column belongs to: the last that begins at or before it, as those without columns begin
/// where the next does.
fn joint_of(starts: &[usize], column: usize) -> usize {
    starts
        .partition_point(|&start| start <= column)
        .saturating_sub(1)
}

/// Adds a frame, not before the last one, to runs of frames.
fn add_frame(runs: &mut Vec<FrameRange>, frame: usize) {
    match runs.last_mut() {
        Some(run) if run.last == frame || run.last + 1 == frame => run.last = frame,
        _ => runs.push(FrameRange::single(frame)),
    }
}

/// Columns of a joint that are bridged together.
enum Group {
    /// A position channel.
    Position(usize),
    /// The rotation channels.
    Rotation,
}

/// Fills gaps of at most `most_frames` frames, and says what was filled, joint by joint.
///
/// Rotations turn the short way at constant speed (Shoemake, "Animating rotation with quaternion curves", SIGGRAPH
/// 1985), positions move in a straight line; at the beginning and the end the nearest frame is held.
///
/// # Errors
/// When a gap is longer, or there is no frame to start from; nothing is filled then.
pub fn bridge_gaps(
    bvh: &mut Bvh,
    gaps: &[Gap],
    most_frames: usize,
) -> Result<Vec<Change>, GapError> {
    let starts = bvh.column_starts();
    let frame_count = bvh.frame_count();
    let mut gaps_of = vec![Vec::new(); bvh.joints.len()];
    for gap in gaps {
        if let Some(of_joint) = gaps_of.get_mut(joint_of(&starts, gap.column)) {
            of_joint.push(*gap);
        }
    }
    let mut bridges: Vec<(usize, Group, FrameRange)> = Vec::new();
    let mut changes = Vec::new();
    for of_joint in gaps_by_joint(bvh, gaps) {
        let index = of_joint.joint;
        let (joint, start) = (&bvh.joints[index], starts[index]);
        let name = || joint.name().into_owned();
        let mut runs_of: Vec<(Group, Vec<FrameRange>)> = vec![(Group::Rotation, Vec::new())];
        for (column, channel) in (start..).zip(&joint.channels) {
            if matches!(channel, Channel::Position(_)) {
                runs_of.push((Group::Position(column), Vec::new()));
            }
        }
        for gap in &gaps_of[index] {
            let of_gap = runs_of.iter_mut().find(|(group, _)| match group {
                Group::Position(column) => *column == gap.column,
                Group::Rotation => {
                    matches!(joint.channels[gap.column - start], Channel::Rotation(_))
                }
            });
            if let Some((_, runs)) = of_gap {
                add_frame(runs, gap.frame);
            }
        }
        for (group, runs) in runs_of {
            for run in runs {
                let length = run.last - run.first + 1;
                if length == frame_count {
                    return Err(GapError::NothingThere { joint: name() });
                }
                if length > most_frames {
                    let (joint, frames, most) = (name(), run, most_frames);
                    return Err(GapError::TooLong {
                        joint,
                        frames,
                        most,
                    });
                }
                let group = match &group {
                    Group::Position(column) => Group::Position(*column),
                    Group::Rotation => Group::Rotation,
                };
                bridges.push((index, group, run));
            }
        }
        changes.push(change(&name(), &of_joint));
    }
    for (joint, group, run) in bridges {
        bridge(bvh, joint, starts[joint], &group, run);
    }
    Ok(changes)
}

fn change(name: &str, gaps: &JointGaps) -> Change {
    let frames = match (gaps.runs.first(), gaps.runs.last()) {
        (Some(first), Some(last)) => Some(FrameRange {
            first: first.first,
            last: last.last,
        }),
        _ => None,
    };
    let values = if gaps.count == 1 { "value" } else { "values" };
    Change {
        code: ChangeCode::GapBridged,
        joint: Some(name.to_owned()),
        frames,
        location: None,
        count: gaps.count,
        message: format!(
            "{} {values} of {name} that were not numbers bridged, in {}",
            gaps.count,
            in_words(&gaps.runs)
        ),
    }
}

/// How many runs of frames a message lists.
const RUNS_LISTED: usize = 4;

/// `frame 3, frames 7 to 9`, the first few of them.
pub(super) fn in_words(runs: &[FrameRange]) -> String {
    let listed: Vec<String> = runs
        .iter()
        .take(RUNS_LISTED)
        .map(FrameRange::to_string)
        .collect();
    match runs.len().saturating_sub(RUNS_LISTED) {
        0 => listed.join(", "),
        more => format!("{} and {more} more runs", listed.join(", ")),
    }
}

/// Fills a run of frames, beyond which there is a frame on at least one side.
fn bridge(bvh: &mut Bvh, joint: usize, start: usize, group: &Group, run: FrameRange) {
    let width = bvh.channel_count();
    let rotations = rotation_columns(&bvh.joints[joint].channels, start);
    let order = whole_order(&rotations);
    let before = run.first.checked_sub(1);
    let after = Some(run.last + 1).filter(|&frame| frame < bvh.frame_count());
    let (Some(from), Some(to)) = (before.or(after), after.or(before)) else {
        return;
    };
    let (from_row, to_row) = (bvh.row(from).to_vec(), bvh.row(to).to_vec());
    let mut previous = from_row.clone();
    let Some(motion) = &mut bvh.motion else {
        return;
    };
    let steps = (run.last + 2 - run.first) as f64;
    for frame in run.first..=run.last {
        let row = &mut motion.values[frame * width..(frame + 1) * width];
        // Where one side is missing both are the same row, and every t gives it.
        let t = (frame + 1 - run.first) as f64 / steps;
        match (group, order) {
            (Group::Position(column), _) => {
                row[*column] = mix(from_row[*column], to_row[*column], t)
            }
            (Group::Rotation, Some(order)) => {
                let (a, b) = (
                    rotation_of(&from_row, &rotations),
                    rotation_of(&to_row, &rotations),
                );
                let near = angles_at(&previous, &rotations);
                let angles = if from == to {
                    near
                } else {
                    order
                        .from_quat_near(slerp(a, b, t), near.map(f64::to_radians))
                        .angles_rad
                        .map(in_round_degrees)
                };
                set_angles(row, &rotations, angles);
            }
            (Group::Rotation, None) => {
                for &(column, _) in &rotations {
                    let (a, b) = (
                        from_row[column],
                        near_angle(to_row[column], from_row[column]),
                    );
                    row[column] = mix(a, b, t);
                }
            }
        }
        previous.copy_from_slice(row);
    }
}

/// Degrees to nine decimals, so that a third of 30 is written as 10; no negative zero.
fn in_round_degrees(angle_rad: f64) -> f64 {
    const UNITS: f64 = 1e9;
    (angle_rad.to_degrees() * UNITS).round() / UNITS + 0.0
}
