//! The command as a user runs it: the built binary, files, exit code, standard output and error.

#![allow(missing_docs, reason = "a test binary has no documentation of its own")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "helpers of tests fail and skip as tests do"
)]

mod bounds;
mod check;
mod conventions;
mod convert;
mod failures;
mod fix;
mod fk;
mod floors;
mod gltf_scenes;
mod guard;
mod harness;
mod ik;
mod ik_figures;
mod ik_study;
mod info;
#[path = "../../../posekit-render/tests/it/inside.rs"]
mod inside;
mod keys;
mod manuals;
mod numbers;
mod numpy;
mod reading;
mod real_files;
mod reference;
mod render;
mod robots;
#[cfg(unix)]
mod serve;
#[cfg(feature = "window")]
mod shots;
mod terminal;
mod whole_files;
mod wild_files;
