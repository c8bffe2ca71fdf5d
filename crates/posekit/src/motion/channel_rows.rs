//! Rows of channel values, as motion files hold them, and the motion they make.

use std::sync::Arc;

use glam::{Quat, Vec3};

use super::{Channel, ChannelLayout, FrameTime, Motion, PositionPolicies, PositionPolicy, Tracks};
use crate::lanes::{self, Kernel, LANES, QuatLanes, Register, Vec3Lanes};
use crate::range::LONGEST_LENGTH;
use crate::rotation::Axis;
use crate::rotation::sincos_lanes::{repeat_last_row, row_starts, set_quats_from_rows_deg};
use crate::skeleton::{JointId, Skeleton};

/// A value of a channel row that no motion is made of: a place farther away than posekit works with, or an angle
/// of so many turns that its digits no longer say where in a turn it is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{} of joint `{joint_name}` is {value:?} at frame {frame}, which is not within {LONGEST_LENGTH:e}",
    channel.name()
)]
pub struct ChannelValueError {
    /// The frame, counted from 0.
    pub frame: usize,
    /// The column of the row.
    pub column: usize,
    /// The joint whose channel it is.
    pub joint: JointId,
    /// The joint's unique name.
    pub joint_name: String,
    /// The channel.
    pub channel: Channel,
    /// The value.
    pub value: f64,
}

impl Motion {
    /// The motion that rows of channel values make: angles in degrees, positions in the file's
    /// unit.
    ///
    /// `rows` holds one row after the other, each with a value for every column of `layout`; values
    /// after the last whole row are not used. Angles are reduced in `f64`, so that values of many
    /// turns keep their precision. Joints whose layout has a position channel get a translation
    /// track; coordinates without a channel stay at the OFFSET.
    ///
    /// # Errors
    /// [`ChannelValueError`] with the first value that is not within [`LONGEST_LENGTH`], or not a number.
    ///
    /// # Panics
    /// If the layout names a joint that the skeleton does not have.
    pub fn from_channel_rows(
        skeleton: Arc<Skeleton>,
        frame_time: FrameTime,
        layout: &ChannelLayout,
        rows: &[f64],
        policies: impl Into<PositionPolicies>,
    ) -> Result<Self, ChannelValueError> {
        let mut motion = Self::at_rest(skeleton, 0, frame_time, []);
        motion.set_channel_rows(frame_time, layout, rows, policies)?;
        Ok(motion)
    }

    /// Makes this motion of the same skeleton what
    /// [`from_channel_rows`](Self::from_channel_rows) would make it, in the memory that is there
    /// already where it suffices: for rows that are edited and looked at again, and for many files
    /// of one skeleton.
    ///
    /// # Errors
    /// As [`from_channel_rows`](Self::from_channel_rows); the motion is what it was.
    ///
    /// # Panics
    /// As [`from_channel_rows`](Self::from_channel_rows).
    pub fn set_channel_rows(
        &mut self,
        frame_time: FrameTime,
        layout: &ChannelLayout,
        rows: &[f64],
        policies: impl Into<PositionPolicies>,
    ) -> Result<(), ChannelValueError> {
        let frame_count = rows.len().checked_div(layout.column_count()).unwrap_or(0);
        let rows = &rows[..frame_count * layout.column_count()];
        if let Some(at) = first_out_of_range(rows) {
            return Err(self.channel_value_error(layout, rows, at));
        }
        self.set_channel_rows_by(frame_time, layout, rows, policies.into(), |kernel| {
            lanes::run(kernel);
        });
        Ok(())
    }

    fn channel_value_error(
        &self,
        layout: &ChannelLayout,
        rows: &[f64],
        at: usize,
    ) -> ChannelValueError {
        let (frame, column) = (at / layout.column_count(), at % layout.column_count());
        let (joint, channel) = layout.columns()[column];
        ChannelValueError {
            frame,
            column,
            joint,
            joint_name: self.skeleton.unique_name(joint).to_owned(),
            channel,
            value: rows[at],
        }
    }

    /// [`set_channel_rows`](Self::set_channel_rows) on registers of the caller's choice.
    pub(super) fn set_channel_rows_by(
        &mut self,
        frame_time: FrameTime,
        layout: &ChannelLayout,
        rows: &[f64],
        policies: PositionPolicies,
        run: impl FnOnce(FillBlocks<'_>),
    ) {
        let column_count = layout.column_count();
        let positioned = layout
            .columns()
            .iter()
            .filter(|(_, channel)| matches!(channel, Channel::Position(_)))
            .filter(|(joint, _)| {
                policies.of_joint_below(self.skeleton.parent(*joint)) != PositionPolicy::Ignore
            })
            .map(|&(joint, _)| joint);
        self.translated = Tracks::new(self.skeleton.joint_count(), positioned);
        self.frame_count = rows.len().checked_div(column_count).unwrap_or(0);
        self.frame_time = frame_time;
        let (rotation_steps, translation_steps) = steps(self, layout, policies);
        let block_count = self.block_count();
        make_room(&mut self.rotations, block_count * rotation_steps.len());
        make_room(
            &mut self.translations,
            block_count * translation_steps.len(),
        );
        run(FillBlocks {
            rows: &rows[..self.frame_count * column_count],
            column_count,
            rotation_steps: &rotation_steps,
            translation_steps: &translation_steps,
            rotations: &mut self.rotations,
            translations: &mut self.translations,
        });
    }
}

/// The place of the first value that no motion is made of.
fn first_out_of_range(rows: &[f64]) -> Option<usize> {
    /// Values that are looked at together, without a branch between them.
    const TOGETHER: usize = 1024;
    let is_in_range = |value: &f64| value.abs() <= LONGEST_LENGTH;
    let chunk = rows.chunks(TOGETHER).position(|chunk| {
        !chunk
            .iter()
            .fold(true, |all, value| all & is_in_range(value))
    })?;
    let start = chunk * TOGETHER;
    let within = rows[start..].iter().position(|value| !is_in_range(value));
    within.map(|at| start + at)
}

/// Cuts what is too long and reserves what is missing; [`FillBlocks`] appends it block by block.
fn make_room<T>(lanes: &mut Vec<T>, len: usize) {
    lanes.truncate(len);
    lanes.reserve_exact(len - lanes.len());
}

/// What fills one rotation track in every block.
#[derive(Clone, Debug)]
enum RotationStep {
    /// No channels: the rest rotation.
    Rest(Quat),
    /// Channels side by side, the first in this column.
    Adjacent { axes: Vec<Axis>, first: usize },
    /// Channels with others in between.
    Scattered {
        axes: Vec<Axis>,
        columns: Vec<usize>,
    },
}

/// What fills one translation track in every block.
#[derive(Clone, Debug)]
struct TranslationStep {
    rest: Vec3,
    channels: Vec<PositionChannel>,
}

#[derive(Clone, Copy, Debug)]
struct PositionChannel {
    column: usize,
    axis: Axis,
    /// Added to the channel's value.
    base: f64,
}

/// A step for every rotation track and every translation track of a motion.
fn steps(
    motion: &Motion,
    layout: &ChannelLayout,
    policies: PositionPolicies,
) -> (Vec<RotationStep>, Vec<TranslationStep>) {
    let joints = columns_by_joint(&motion.skeleton, layout);
    let rotated = motion.rotated.joints.iter();
    let translated = motion.translated.joints.iter();
    let rotation_step =
        |&joint: &JointId| rotation_step(&motion.skeleton, joint, &joints[joint.index()]);
    let translation_step = |&joint: &JointId| {
        let policy = policies.of_joint_below(motion.skeleton.parent(joint));
        translation_step(&motion.skeleton, joint, &joints[joint.index()], policy)
    };
    (
        rotated.map(rotation_step).collect(),
        translated.map(translation_step).collect(),
    )
}

/// Where one joint's channels are in a row, rotations in the order of their multiplication.
#[derive(Clone, Debug, Default)]
struct JointColumns {
    rotations: Vec<(usize, Axis)>,
    positions: Vec<(usize, Axis)>,
}

fn columns_by_joint(skeleton: &Skeleton, layout: &ChannelLayout) -> Vec<JointColumns> {
    let mut joints = vec![JointColumns::default(); skeleton.joint_count()];
    for (column, &(joint, channel)) in layout.columns().iter().enumerate() {
        let columns = &mut joints[joint.index()];
        match channel {
            Channel::Rotation(axis) => columns.rotations.push((column, axis)),
            Channel::Position(axis) => columns.positions.push((column, axis)),
        }
    }
    joints
}

fn rotation_step(skeleton: &Skeleton, joint: JointId, columns: &JointColumns) -> RotationStep {
    let (columns, axes): (Vec<usize>, Vec<Axis>) = columns.rotations.iter().copied().unzip();
    match columns.first() {
        None => RotationStep::Rest(skeleton.rest_rotation(joint)),
        Some(&first)
            if (first..)
                .zip(&columns)
                .all(|(next, &column)| next == column) =>
        {
            RotationStep::Adjacent { axes, first }
        }
        Some(_) => RotationStep::Scattered { axes, columns },
    }
}

fn translation_step(
    skeleton: &Skeleton,
    joint: JointId,
    columns: &JointColumns,
    policy: PositionPolicy,
) -> TranslationStep {
    let rest = skeleton.rest_translation(joint);
    let base = match policy {
        PositionPolicy::Add => rest,
        PositionPolicy::Replace | PositionPolicy::Ignore => Vec3::ZERO,
    };
    let channel = |&(column, axis): &(usize, Axis)| PositionChannel {
        column,
        axis,
        base: f64::from(base[axis.index()]),
    };
    TranslationStep {
        rest,
        channels: columns.positions.iter().map(channel).collect(),
    }
}

/// The rotations and translations of all blocks, from rows.
pub(super) struct FillBlocks<'a> {
    /// Whole rows.
    rows: &'a [f64],
    column_count: usize,
    rotation_steps: &'a [RotationStep],
    translation_steps: &'a [TranslationStep],
    /// Block after block; grow to what the rows need.
    rotations: &'a mut Vec<QuatLanes>,
    translations: &'a mut Vec<Vec3Lanes>,
}

impl Kernel for FillBlocks<'_> {
    #[inline(always)]
    fn run<R: Register>(self) {
        if self.rows.is_empty() {
            return;
        }
        let column_count = self.column_count;
        let mut scratch = Vec::new();
        let row_blocks = self.rows.chunks(LANES * column_count);
        for (block, mut rows) in row_blocks.enumerate() {
            let padded;
            if rows.len() < LANES * column_count {
                padded = repeat_last_row(rows, column_count);
                rows = &padded;
            }
            let rotations = block_of(
                self.rotations,
                block,
                self.rotation_steps.len(),
                QuatLanes::IDENTITY,
            );
            for (step, quats) in self.rotation_steps.iter().zip(rotations) {
                fill_rotation::<R>(step, rows, column_count, &mut scratch, quats);
            }
            let translations = block_of(
                self.translations,
                block,
                self.translation_steps.len(),
                Vec3Lanes::ZERO,
            );
            for (step, vectors) in self.translation_steps.iter().zip(translations) {
                fill_translation::<R>(step, rows, column_count, vectors);
            }
        }
    }
}

/// The memory of one block. Where it is new it is touched now, so that it is in the first cache when
/// it is filled.
#[inline(always)]
fn block_of<T: Copy>(lanes: &mut Vec<T>, block: usize, len: usize, initial: T) -> &mut [T] {
    let (start, end) = (block * len, (block + 1) * len);
    if lanes.len() < end {
        lanes.resize(end, initial);
    }
    &mut lanes[start..end]
}

#[inline(always)]
fn fill_rotation<R: Register>(
    step: &RotationStep,
    rows: &[f64],
    column_count: usize,
    scratch: &mut Vec<f64>,
    quats: &mut QuatLanes,
) {
    let (axes, rows, stride) = match step {
        RotationStep::Rest(rest) => {
            *quats = QuatLanes::splat(*rest);
            return;
        }
        RotationStep::Adjacent { axes, first } => (axes, &rows[*first..], column_count),
        RotationStep::Scattered { axes, columns } => {
            copy_columns(rows, column_count, columns, scratch);
            (axes, scratch.as_slice(), columns.len())
        }
    };
    set_quats_from_rows_deg::<R>(axes, rows, stride, quats);
}

/// Seldom, and worth a copy: position channels stand between the rotation channels.
fn copy_columns(rows: &[f64], column_count: usize, columns: &[usize], to: &mut Vec<f64>) {
    to.clear();
    for row in rows.chunks_exact(column_count) {
        to.extend(columns.iter().map(|&column| row[column]));
    }
}

#[inline(always)]
fn fill_translation<R: Register>(
    step: &TranslationStep,
    rows: &[f64],
    column_count: usize,
    vectors: &mut Vec3Lanes,
) {
    *vectors = Vec3Lanes::splat(step.rest);
    for channel in &step.channels {
        let rows = row_starts(&rows[channel.column..], column_count);
        let coordinate = vectors.coordinate_mut(channel.axis);
        for part in 0..R::PARTS {
            R::sums::<1>(&rows, 0, part, channel.base).store(coordinate, part);
        }
    }
}
