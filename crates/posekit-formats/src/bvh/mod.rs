//! BVH (Biovision hierarchy): a skeleton and frames of joint channels, as text.
//!
//! [`read()`] turns bytes into a [`Bvh`], the document: values in degrees and in the file's length unit,
//! channels in the file's order, names byte for byte. [`write()`] turns it back. Read, written and read
//! again, a document is the same to the bit.
//!
//! The format was never standardised (Meredith and Maddock, "Motion Capture File Formats Explained",
//! University of Sheffield, 2001, is the usual description), and files in the wild differ from each other
//! in every way they can. The reader takes what makes sense, and says so in the report: one
//! [`WarningCode`](crate::report::WarningCode) for every kind of liberty. What makes no sense is one
//! [`ReadError`](crate::report::ReadError) with a line and a column.
//!
//! Limits: [`MAX_DEPTH`], [`MAX_JOINTS`], [`MAX_NAME_BYTES`]. The reader does not recurse, and reserves
//! room for values only as far as the remaining bytes could hold them.
//!
//! ```
//! let text = b"HIERARCHY ROOT hip { OFFSET 0 0 0 CHANNELS 1 Yrotation End Site { OFFSET 0 1 0 } }
//! MOTION Frames: 2 Frame Time: 0.5
//! 10
//! 20.5
//! ";
//! let import = posekit_formats::bvh::read(text)?;
//! let bvh = import.document;
//! assert_eq!(bvh.joints[1].name(), "hip_end");
//! assert_eq!(bvh.row(1), [20.5]);
//! # Ok::<(), posekit_formats::report::ReadError>(())
//! ```

mod bridge;
mod check;
mod convert;
mod decimal;
mod document;
pub mod edit;
pub mod elsewhere;
mod fix;
mod from_motion;
mod read;
mod write;

pub use bridge::{Gap, GapError, JointGaps, bridge_gaps, gaps_by_joint};
pub use check::{CheckAs, CheckEntry, Checked, check, check_with_gaps, reader_entries};
pub use convert::MotionError;
pub use document::{Bvh, BvhJoint, BvhMotion, EndName, InvalidBvh};
pub use fix::{Change, ChangeCode, FixConfig, Fixed, NameRepair, fix, unwrap_flips};
pub use read::{
    Extent, MAX_DEPTH, MAX_JOINTS, MAX_NAME_BYTES, PIECE_BYTES, PROGRESS_BYTES, Piece, Places,
    ReadOptions, RowParser, locate, read, read_in_pieces, read_with, read_with_gaps,
};
pub use write::{Indent, LineEnding, WriteOptions, write, write_motion_to, write_to};
