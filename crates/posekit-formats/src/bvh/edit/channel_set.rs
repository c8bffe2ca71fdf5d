//! Rotations alone, or position and rotation on every joint.

use posekit::motion::Channel;
use posekit::rotation::Axis;

use super::columns::{lay_out, starts};
use crate::bvh::Bvh;

/// Which channels joints have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ChannelSet {
    /// Rotation channels; position channels on roots only, as most programs write BVH.
    RotationsAndMovingRoots,
    /// Three position and three rotation channels on every joint.
    PositionsAndRotations,
}

/// A joint that kept its position channels because it truly moves in its parent's space.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptTranslation {
    /// The joint's index.
    pub joint: usize,
    /// How far its translation goes from the first frame's, along the axis where that is most, in
    /// the file's unit.
    pub range: f64,
}

/// Up to this share of the figure's size a translation that changes counts as constant: the
/// rounding of files with five or six digits, not a motion.
const CONSTANT_SHARE: f64 = 1e-4;

/// Gives every joint these channels and leaves the motion as it is.
///
/// Where position channels go, the OFFSET takes the translation that they held. A joint whose
/// translation changes by more than a ten-thousandth of the figure's size cannot do without them:
/// it keeps them and is in the result. Channels that come hold the OFFSET, or a rotation of zero
/// after the others.
pub fn set_channels(bvh: &mut Bvh, set: ChannelSet) -> Vec<KeptTranslation> {
    match set {
        ChannelSet::RotationsAndMovingRoots => drop_positions(bvh),
        ChannelSet::PositionsAndRotations => {
            complete(bvh);
            Vec::new()
        }
    }
}

fn is_position(channel: Channel) -> bool {
    matches!(channel, Channel::Position(_))
}

fn drop_positions(bvh: &mut Bvh) -> Vec<KeptTranslation> {
    let old_starts = bvh.column_starts();
    let tolerance = CONSTANT_SHARE * size(bvh, &old_starts);
    let mut kept = Vec::new();
    let mut channels: Vec<Vec<Channel>> = Vec::with_capacity(bvh.joints.len());
    let mut offsets = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        let has_positions = joint.channels.iter().any(|&channel| is_position(channel));
        if joint.parent.is_none() || !has_positions {
            channels.push(joint.channels.clone());
            continue;
        }
        let range = translation_range(bvh, index, old_starts[index]);
        if range > tolerance {
            kept.push(KeptTranslation {
                joint: index,
                range,
            });
            channels.push(joint.channels.clone());
            continue;
        }
        offsets.push((index, first_translation(bvh, index, old_starts[index])));
        channels.push(
            joint
                .channels
                .iter()
                .copied()
                .filter(|&c| !is_position(c))
                .collect(),
        );
    }
    let mut columns = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        let keeps_all = channels[index].len() == joint.channels.len();
        for (place, &channel) in joint.channels.iter().enumerate() {
            if keeps_all || !is_position(channel) {
                columns.push(old_starts[index] + place);
            }
        }
    }
    lay_out(bvh, channels, |old, new| {
        for (value, &column) in new.iter_mut().zip(&columns) {
            *value = old[column];
        }
    });
    for (index, offset) in offsets {
        bvh.joints[index].offset = offset;
    }
    kept
}

/// The largest extent of the figure with all rotations zero: of its OFFSETs, or of the places that the first
/// frame gives the joints below the roots where that is larger. OFFSETs may all be zero while the
/// channels hold the figure.
fn size(bvh: &Bvh, starts: &[usize]) -> f64 {
    let at_rest = extent(bvh, |joint| bvh.joints[joint].offset);
    let in_frame = extent(bvh, |joint| match bvh.joints[joint].parent {
        Some(_) => first_translation(bvh, joint, starts[joint]),
        None => [0.0; 3],
    });
    at_rest.max(in_frame)
}

/// The longest side of the box around all joints whose translations these are.
fn extent(bvh: &Bvh, translation: impl Fn(usize) -> [f64; 3]) -> f64 {
    let mut places: Vec<[f64; 3]> = Vec::with_capacity(bvh.joints.len());
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (index, joint) in bvh.joints.iter().enumerate() {
        let base = joint.parent.map_or([0.0; 3], |parent| places[parent]);
        let own = translation(index);
        let place = [0, 1, 2].map(|axis| base[axis] + own[axis]);
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
        places.push(place);
    }
    (0..3)
        .map(|axis| high[axis] - low[axis])
        .fold(0.0, f64::max)
}

fn translation_range(bvh: &Bvh, joint: usize, start: usize) -> f64 {
    let channels = &bvh.joints[joint].channels;
    let columns = (0..channels.len()).filter(|&place| is_position(channels[place]));
    let range = |column: usize| {
        let first = bvh.rows().next().map_or(0.0, |row| row[column]);
        bvh.rows()
            .map(|row| (row[column] - first).abs())
            .fold(0.0, f64::max)
    };
    columns
        .map(|place| range(start + place))
        .fold(0.0, f64::max)
}

fn first_translation(bvh: &Bvh, joint: usize, start: usize) -> [f64; 3] {
    let mut translation = bvh.joints[joint].offset;
    if let Some(row) = bvh.rows().next() {
        for (place, channel) in bvh.joints[joint].channels.iter().enumerate() {
            if let Channel::Position(axis) = channel {
                translation[axis.index()] = row[start + place];
            }
        }
    }
    translation
}

/// Where a new column's number comes from.
enum Source {
    Column(usize),
    Constant(f64),
}

fn complete(bvh: &mut Bvh) {
    let old_starts = bvh.column_starts();
    let mut channels = Vec::with_capacity(bvh.joints.len());
    let mut sources = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        if joint.is_end_site {
            channels.push(Vec::new());
            continue;
        }
        let mut list = Vec::new();
        let missing = |channel: Channel| !joint.channels.contains(&channel);
        for axis in Axis::ALL
            .into_iter()
            .filter(|&axis| missing(Channel::Position(axis)))
        {
            list.push(Channel::Position(axis));
            sources.push(Source::Constant(joint.offset[axis.index()]));
        }
        for (place, &channel) in joint.channels.iter().enumerate() {
            list.push(channel);
            sources.push(Source::Column(old_starts[index] + place));
        }
        for axis in Axis::ALL
            .into_iter()
            .filter(|&axis| missing(Channel::Rotation(axis)))
        {
            list.push(Channel::Rotation(axis));
            sources.push(Source::Constant(0.0));
        }
        channels.push(list);
    }
    debug_assert_eq!(
        starts(&channels)
            .last()
            .map(|start| start + channels.last().map_or(0, Vec::len)),
        Some(sources.len()),
        "a source for every column"
    );
    lay_out(bvh, channels, |old, new| {
        for (value, source) in new.iter_mut().zip(&sources) {
            *value = match source {
                Source::Column(column) => old[*column],
                Source::Constant(number) => *number,
            };
        }
    });
}
