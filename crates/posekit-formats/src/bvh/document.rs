//! The BVH document: what a file says, without interpretation.

use super::Gap;
use std::borrow::Cow;
use std::ops::Range;

use posekit::motion::{Channel, FrameTime};
use posekit::range::LONGEST_LENGTH;
use posekit::rotation::EulerOrder;

/// A BVH file: a hierarchy of joints and, usually, frames of channel values.
///
/// Values are kept as the file gave them: degrees, the file's own length unit, `f64`. What is kept is
/// everything that carries meaning; layout (indentation, line ends, how many zeros a number has) and
/// comments are not.
///
/// Invariants that [`read`](super::read()) guarantees and [`Bvh::validate`] checks: every parent comes
/// before its children, the motion has one value per frame and channel, every number is finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    /// The joints in the file's order, which is depth first; End Sites are joints too.
    pub joints: Vec<BvhJoint>,
    /// The frames, or `None` when the file is a skeleton alone.
    pub motion: Option<BvhMotion>,
}

/// A ROOT, JOINT or End Site.
#[derive(Clone, Debug, PartialEq)]
pub struct BvhJoint {
    /// The name as the file gave it, byte for byte, without blanks around it. An End Site without a
    /// name of its own has its parent's with `_end` added; see [`BvhJoint::end_name`].
    pub name: Vec<u8>,
    /// The index of the parent in [`Bvh::joints`], less than the joint's own; `None` for a ROOT.
    pub parent: Option<usize>,
    /// The OFFSET from the parent in the parent's space, in the file's length unit.
    pub offset: [f64; 3],
    /// The channels in the order the file lists them, any number of them.
    pub channels: Vec<Channel>,
    /// Whether the file calls it an End Site. An End Site has no channels and no children.
    pub is_end_site: bool,
    /// Where an End Site's name comes from; [`EndName::Implied`] for all other joints.
    pub end_name: EndName,
}

/// Where the name of an End Site comes from, and how it is written.
///
/// The format has no name for an End Site. Some programs write one all the same, and a program that
/// does not know it reads past it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EndName {
    /// The file says none: it is the parent's name with `_end` added, and is not written.
    #[default]
    Implied,
    /// In a comment, as `End Site #name: LeftToeTip`.
    Comment,
    /// After the keyword, as `End Site LeftToeTip`.
    Word,
}

/// The MOTION section.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BvhMotion {
    /// Seconds from one frame to the next, as the file says; it may be zero, negative or so small that nothing
    /// can be divided by it, if that is what the file says. [`frame_time`](Self::frame_time) is what can be
    /// computed with.
    pub frame_time_secs: f64,
    /// How many frames there are.
    pub frame_count: usize,
    /// The channel values, one frame after another: in a frame the joints' channels follow each other in
    /// the order of [`Bvh::joints`]. Rotations are in degrees, positions in the file's length unit.
    pub values: Vec<f64>,
}

impl BvhMotion {
    /// The time between two frames; [none](FrameTime::NONE) where the file says one that cannot be.
    pub fn frame_time(&self) -> FrameTime {
        FrameTime::or_none(self.frame_time_secs)
    }
}

/// Why a [`Bvh`] cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidBvh {
    /// There is no joint.
    #[error("there is no joint")]
    NoJoints,
    /// A joint's parent does not come before it.
    #[error("the parent of joint {joint} does not come before it")]
    ParentNotBefore {
        /// The joint's index.
        joint: usize,
    },
    /// An End Site is a root, has channels or has children.
    #[error("the End Site {joint} is a root, has channels or has children")]
    EndSiteNotAnEnd {
        /// The End Site's index.
        joint: usize,
    },
    /// The values are not frames times channels.
    #[error("{values} values do not make {frames} frames of {channels} channels")]
    ValueCount {
        /// How many values there are.
        values: usize,
        /// The frame count.
        frames: usize,
        /// The channels per frame.
        channels: usize,
    },
    /// An offset, a value or the frame time is NaN or infinite.
    #[error("a number is NaN or infinite")]
    NotFinite,
}

/// The name of an End Site that has none of its own.
pub(super) fn implied_end_name(parent_name: &[u8]) -> Vec<u8> {
    let mut name = parent_name.to_vec();
    if name.len() + IMPLIED_ENDING.len() <= super::MAX_NAME_BYTES {
        name.extend_from_slice(IMPLIED_ENDING);
    }
    name
}

/// What is added to a joint's name to call the End Site below it.
const IMPLIED_ENDING: &[u8] = b"_end";

impl BvhJoint {
    /// The name as text; bytes that are not UTF-8 show as the replacement character.
    pub fn name(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.name)
    }
}

impl Bvh {
    /// How many values a frame has: the channels of all joints.
    pub fn channel_count(&self) -> usize {
        self.joints.iter().map(|joint| joint.channels.len()).sum()
    }

    /// The order of each joint's rotation channels; of a joint with more than three of them, ZXY.
    pub fn rotation_orders(&self) -> Vec<EulerOrder> {
        let order = |joint: &BvhJoint| {
            let axes: Vec<_> = joint
                .channels
                .iter()
                .filter_map(|channel| match channel {
                    Channel::Rotation(axis) => Some(*axis),
                    Channel::Position(_) => None,
                })
                .collect();
            EulerOrder::new(&axes).unwrap_or(EulerOrder::ZXY)
        };
        self.joints.iter().map(order).collect()
    }

    /// The time between two frames; [none](FrameTime::NONE) without motion, or where the file says one that
    /// cannot be.
    pub fn frame_time(&self) -> FrameTime {
        let motion = self.motion.as_ref();
        motion.map_or(FrameTime::NONE, BvhMotion::frame_time)
    }

    /// The values of the rows of which no motion can be made, since they are not within [`LONGEST_LENGTH`], in order;
    /// by frame and column.
    pub fn values_out_of_range(&self) -> Vec<Gap> {
        let mut found = Vec::new();
        for (frame, row) in self.rows().enumerate() {
            // Whole rows at once: there is hardly ever one.
            let is_in_range = |value: &f64| value.abs() <= LONGEST_LENGTH;
            if !row.iter().fold(true, |all, value| all & is_in_range(value)) {
                let beyond = row
                    .iter()
                    .enumerate()
                    .filter(|(_, value)| !is_in_range(value));
                found.extend(beyond.map(|(column, _)| Gap { frame, column }));
            }
        }
        found
    }

    /// How many frames there are; 0 without motion.
    pub fn frame_count(&self) -> usize {
        self.motion.as_ref().map_or(0, |motion| motion.frame_count)
    }

    /// The values of a frame, one per channel.
    ///
    /// # Panics
    ///
    /// When there is no such frame.
    pub fn row(&self, frame: usize) -> &[f64] {
        assert!(
            frame < self.frame_count(),
            "frame {frame} of {}",
            self.frame_count()
        );
        let channels = self.channel_count();
        let values = self
            .motion
            .as_ref()
            .map_or(&[][..], |motion| &motion.values);
        &values[frame * channels..(frame + 1) * channels]
    }

    /// The frames' rows, first to last. With no channels, as many empty rows as there are frames.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        let channels = self.channel_count();
        let values = self
            .motion
            .as_ref()
            .map_or(&[][..], |motion| &motion.values);
        (0..self.frame_count()).map(move |frame| &values[frame * channels..(frame + 1) * channels])
    }

    /// Which columns of a row are a joint's, in the order of its channels.
    ///
    /// Costs a walk over the joints before it; [`Bvh::column_starts`] gives all at once.
    ///
    /// # Panics
    ///
    /// When there is no such joint.
    pub fn joint_columns(&self, joint: usize) -> Range<usize> {
        let start = self.joints[..joint]
            .iter()
            .map(|before| before.channels.len())
            .sum();
        start..start + self.joints[joint].channels.len()
    }

    /// The first column of every joint, and the number of columns at the end: joint `j` has the columns
    /// `starts[j]..starts[j + 1]`.
    pub fn column_starts(&self) -> Vec<usize> {
        let mut starts = Vec::with_capacity(self.joints.len() + 1);
        let mut next = 0;
        starts.push(next);
        for joint in &self.joints {
            next += joint.channels.len();
            starts.push(next);
        }
        starts
    }

    /// Checks the invariants that a document made or changed by hand could break.
    ///
    /// # Errors
    ///
    /// The first that does not hold.
    pub fn validate(&self) -> Result<(), InvalidBvh> {
        if self.joints.is_empty() {
            return Err(InvalidBvh::NoJoints);
        }
        for (index, joint) in self.joints.iter().enumerate() {
            match joint.parent {
                Some(parent) if parent >= index => {
                    return Err(InvalidBvh::ParentNotBefore { joint: index });
                }
                Some(parent) if self.joints[parent].is_end_site => {
                    return Err(InvalidBvh::EndSiteNotAnEnd { joint: parent });
                }
                _ => {}
            }
            if joint.is_end_site && (joint.parent.is_none() || !joint.channels.is_empty()) {
                return Err(InvalidBvh::EndSiteNotAnEnd { joint: index });
            }
            if !joint.offset.iter().all(|number| number.is_finite()) {
                return Err(InvalidBvh::NotFinite);
            }
        }
        self.motion
            .as_ref()
            .map_or(Ok(()), |motion| self.validate_motion(motion))
    }

    fn validate_motion(&self, motion: &BvhMotion) -> Result<(), InvalidBvh> {
        let channels = self.channel_count();
        if motion.frame_count.checked_mul(channels) != Some(motion.values.len()) {
            return Err(InvalidBvh::ValueCount {
                values: motion.values.len(),
                frames: motion.frame_count,
                channels,
            });
        }
        let all_finite = motion.values.iter().all(|value| value.is_finite());
        if all_finite && motion.frame_time_secs.is_finite() {
            Ok(())
        } else {
            Err(InvalidBvh::NotFinite)
        }
    }
}
