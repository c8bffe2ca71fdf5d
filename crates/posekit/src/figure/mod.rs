//! What a skeleton's shape says about the figure: which length unit its file probably uses, what kind
//! of pose its rest pose is, and which axis points up.
//!
//! All are guesses from lengths and directions. They never change a number; they are for messages,
//! and for asking instead of assuming.

mod extent;
mod rest_pose;
mod unit;
mod up;

use extent::frames_looked_at;
pub use extent::{body_extent, body_joints};
pub use rest_pose::{ArmPosture, RestPose, RestPoseKind};
pub use unit::{LengthUnit, STATURE_RANGE_METRES, guess_unit};
pub use up::{NotAnAxis, UpAxis, UpEvidence, UpGuess, UpTaken, guess_up, take_up};
