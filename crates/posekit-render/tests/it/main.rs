//! The renderer as its users call it: scenes in, pictures and films out.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests fail by panicking and say what they skipped"
)]

mod bodies;
mod conventions;
mod cpu_pictures;
mod figures;
mod films;
#[cfg(feature = "gpu")]
mod gpu_pictures;
mod inside;
mod stages;
mod surroundings;
