//! Tests of the library through its public face.

#![allow(missing_docs, reason = "a test binary has no documentation of its own")]
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod body;
mod figures;
mod ik;
mod inbetween;
mod keyframe;
mod kinematics;
mod robot;
mod rotation;
mod sample;
mod skeleton;
mod symmetry;
