//! Checks: what is suspicious in a motion.
//!
//! [`check_motion`] looks at a [`Motion`] and its forward kinematics, [`check_channels`] at the rows of
//! channel values that a file holds. Both return [`Finding`]s: a code, a severity, joints and frames,
//! a number and a sentence. A check finds things; it repairs nothing.
//!
//! Feet are those of [`body`](crate::body); of a foot the joint is named that a finding is about, the
//! lowest one or the one that stands, not the ankle. Lengths are judged against the figure's height ([`Figure::height`]), speeds against the frame time,
//! and steps against the steps around them by median and median absolute deviation, so that the same
//! thresholds ([`CheckConfig`]) serve metres and centimetres, 30 and 240 frames a second, walks and
//! dances. Y is up. Frames count from 0.
//!
//! Guarantees: any motion is checked without panic, those of no frames and of a single joint too; the
//! same motion gives the same findings, in the same order. Cost: about as much as reading the
//! motion from a file; see `docs/performance.md`.
//!
//! ```
//! use std::sync::Arc;
//! use glam::{Quat, Vec3};
//! use posekit::check::{CheckConfig, FindingCode, check_motion};
//! use posekit::motion::{FrameTime, Motion};
//! use posekit::skeleton::SkeletonBuilder;
//!
//! let mut builder = SkeletonBuilder::new();
//! let shoulder = builder.joint("Shoulder", None, Vec3::ZERO);
//! builder.end_site("Hand", shoulder, Vec3::X);
//! let mut motion = Motion::at_rest(Arc::new(builder.build()?), 40, FrameTime::of_fps(30), []);
//! for frame in 0..40 {
//!     let glitch = if frame == 20 { 1.5 } else { 0.0 };
//!     motion.set_rotation(frame, shoulder, Quat::from_rotation_z(0.01 * frame as f32 + glitch));
//! }
//! let findings = check_motion(&motion, &motion.to_global(), &CheckConfig::default());
//! assert_eq!(findings.len(), 1);
//! assert_eq!(findings[0].code, FindingCode::RotationSpike);
//! assert_eq!(findings[0].frames.map(|frames| frames.first), Some(20));
//! # Ok::<(), posekit::skeleton::SkeletonError>(())
//! ```

mod breaks;
mod channels;
pub mod config;
mod contact;
mod continuity;
mod euler_branch;
mod figure;
mod finding;
mod floor;
mod gait;
mod positions;
mod proportions;
mod sliding;
mod statistics;
mod stillness;
mod timing;

pub use channels::check_channels;
pub use config::CheckConfig;
pub use contact::{Contact, FloorContacts, floor_contacts};
pub use euler_branch::{EulerBranch, EulerStep, EulerTracker};
pub use figure::{Figure, figure};
pub use finding::{Finding, FindingCode, FrameRange, Severity, Unit, sort_findings};
pub use positions::{RelativePositions, relative_positions};

use crate::motion::{GlobalMotion, Motion};

/// Everything suspicious in a motion, sorted as [`sort_findings`] does.
///
/// `global` is the motion's forward kinematics, [`Motion::to_global`].
///
/// # Panics
/// If `global` has another number of frames or joints than `motion`.
pub fn check_motion(motion: &Motion, global: &GlobalMotion, config: &CheckConfig) -> Vec<Finding> {
    assert_eq!(
        motion.frame_count(),
        global.frame_count(),
        "the same frames"
    );
    assert_eq!(
        motion.skeleton().joint_count(),
        global.skeleton().joint_count(),
        "the same joints"
    );
    let mut findings = Vec::new();
    if motion.frame_count() == 0 {
        return findings;
    }
    let figure = figure(motion, global);
    timing::check_frame_time(motion, config, &mut findings);
    stillness::check(motion, &figure, config, &mut findings);
    continuity::check(motion, global, &figure, config, &mut findings);
    proportions::check(motion, global, &figure, config, &mut findings);
    let contacts = floor_contacts(global, &figure, config);
    if let Some(contacts) = &contacts {
        floor::check(contacts, &figure, global, config, &mut findings);
        sliding::check(contacts, &figure, motion, config, &mut findings);
        timing::check_playback(global, &figure, contacts, config, &mut findings);
    }
    sort_findings(&mut findings);
    findings
}

/// A number of frames that a positive number stands for, rounded down.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast from float to integer saturates, and what is negative or no number becomes 0"
)]
fn whole(number: f64) -> usize {
    number as usize
}

/// A number of frames that a positive number stands for, rounded up.
fn whole_up(number: f64) -> usize {
    whole(number.ceil())
}
