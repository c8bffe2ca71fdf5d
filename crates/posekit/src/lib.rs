//! Skeletal character animation from motion data.
//!
//! posekit is the library under the `posekit` command and viewer: skeletons, rotations, poses,
//! motion and forward kinematics. It is pure: it opens no files, reads no clock, starts no threads
//! and logs nothing. Readers and writers of file formats live in `posekit-formats`.
//!
//! The way of the data is one street: a file's document becomes a [`skeleton::Skeleton`] and a
//! [`motion::Motion`]; a motion gives a [`pose::LocalPose`] at a time; forward kinematics makes it a
//! [`pose::GlobalPose`], or a whole [`motion::GlobalMotion`] at once.
//!
//! Conventions, all of them doctested in `CONVENTIONS.md`: right-handed, Y up, radians, seconds,
//! column vectors, quaternions as x, y, z, w; `Q_child = Q_parent * R_child` and
//! `P_child = P_parent + Q_parent * L_child`. Lengths are in the file's unit.

pub mod body;
pub mod check;

pub mod figure;
pub mod ik;
pub mod inbetween;
pub mod keyframe;
mod lanes;
pub mod mechanism;
pub mod motion;
pub mod pose;
pub mod range;
pub mod rotation;
pub mod sample;
pub mod skeleton;

/// Runs the examples of `CONVENTIONS.md` as doctests.
#[cfg(doctest)]
#[doc = include_str!("../../../CONVENTIONS.md")]
#[derive(Debug)]
pub struct Conventions;
