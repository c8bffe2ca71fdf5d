//! Integration tests of the viewer.

#![allow(missing_docs, reason = "a test binary has no documentation of its own")]
#![allow(clippy::print_stderr, reason = "a test that is skipped says so")]

mod animate;
mod arm_lab;
mod authoring;
mod clips;
mod comparing;
mod dialogs;
mod editing;
mod fits;
mod graph;
mod hand;
mod interpolation;
mod limbs;
mod lists;
mod numbers;
mod pictures;
mod poses;
mod reading;
mod reading_as;
mod real_files;
mod recordings;
mod saving;
mod scenes;
mod status;
mod text;
mod things;
mod time_line;
mod whole_turns;
mod window;
