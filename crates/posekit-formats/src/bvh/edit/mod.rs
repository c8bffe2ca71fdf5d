//! Changes to a [`Bvh`](super::Bvh) document: each touches what it names and leaves every other number as it
//! was, to the bit.
//!
//! All of them leave a document that [`Bvh::validate`](super::Bvh::validate) accepts if it was one before. They work on the
//! document and not on a motion, because a motion's quaternions would bring every angle back as a
//! different number.
//!
//! Angles that have to be found anew (a new rotation order, frames between frames) are those closest
//! to the frame before, so that curves stay free of flips.

mod axes;
mod channel_set;
pub(super) mod columns;
mod frames;
mod joint_order;
mod joint_transform;
mod positions;
pub(super) mod resample;
pub(super) mod rotation_order;
mod scale;
#[cfg(test)]
mod tests;

pub use axes::{guess_up_axis, turn_up};
pub use channel_set::{ChannelSet, KeptTranslation, set_channels};
pub use frames::{set_frame_time, trim};
pub use joint_order::{rename, reorder_like};
pub use joint_transform::{joint_limit, set_rotation, set_translation};
pub use positions::settle_positions;
pub use resample::resample;
pub use rotation_order::set_rotation_order;
pub use scale::scale;

use posekit::motion::FrameTimeError;

/// Why a document could not be changed as asked. The document is as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// A factor is zero, negative or not finite.
    #[error("a scale must be a number above zero, and this is {factor}")]
    BadScale {
        /// The factor.
        factor: f64,
    },
    /// A factor carries a length beyond the numbers that there are.
    #[error(
        "a scale of {factor:?} makes the length {length:?} larger than {:e}, the largest number that there is",
        f64::MAX
    )]
    TooLarge {
        /// The factor.
        factor: f64,
        /// The length as it was.
        length: f64,
    },
    /// A rate asks for more frames than fit in memory.
    #[error(
        "cannot make {fps:?} frames a second of this motion: there would be more than fit in memory"
    )]
    TooManyFrames {
        /// The rate that was asked for.
        fps: f64,
    },
    /// A time or a rate that was asked for is none that frames can have.
    #[error(transparent)]
    FrameTime(#[from] FrameTimeError),
    /// The motion has no frame time to tell its rate from.
    #[error(
        "the file has no usable frame time, so its frame rate is unknown: set one with --frame-time"
    )]
    NoFrameTime,
    /// The document has no motion.
    #[error("has no motion")]
    NoMotion,
    /// A range of frames has no frame in it.
    #[error("there are no frames {start}..{end} among {frame_count}")]
    EmptyTrim {
        /// First frame.
        start: usize,
        /// The frame after the last.
        end: usize,
        /// How many frames the motion has.
        frame_count: usize,
    },
    /// No joint has this name.
    #[error("no joint is called '{name}'")]
    NoSuchJoint {
        /// The name.
        name: String,
    },
    /// A name that the format cannot hold.
    #[error(
        "'{name}' cannot be a joint's name: a name has no line ends, no braces and 1 to 256 bytes"
    )]
    BadName {
        /// The name.
        name: String,
    },
    /// A new name has more stars than the pattern of the old one.
    #[error("'{to}' has more asterisks than '{from}'")]
    TooManyStars {
        /// The pattern of the old name.
        from: String,
        /// The new name.
        to: String,
    },
    /// Two documents that should have the same joints do not.
    #[error("joint '{name}' is not under the same parent in both files")]
    DifferentJoints {
        /// A joint that one has and the other has not, or that hangs elsewhere.
        name: String,
    },
    /// Joints share a name, so it does not say which is meant.
    #[error("two joints are called '{name}'")]
    AmbiguousJoint {
        /// The name.
        name: String,
    },
    /// Two joints that have names of their own would share one.
    #[error("two joints would be called '{name}'")]
    MergedNames {
        /// The name.
        name: String,
    },
    /// A joint cannot be given the transform.
    #[error("joint '{name}' cannot be moved: it has {what}")]
    CannotMove {
        /// The joint's name.
        name: String,
        /// What it has or lacks.
        what: &'static str,
    },
    /// A rotation order that does not name each axis once.
    #[error("a rotation order names X, Y and Z once each, such as ZXY")]
    IncompleteOrder,
}
