//! Readers and writers: bytes to posekit's types and back, a module per format.
//!
//! Every reader takes a byte slice and never a path, never panics, never hangs, and never takes
//! memory out of proportion to its input. What can be read is read; every liberty taken is a warning
//! with its place ([`report`]).

pub mod arrays;
pub mod bvh;
pub mod csv;
pub mod gltf;
pub mod json;
pub mod memory;
pub mod npz;
mod number_text;
pub mod poses;
pub mod report;
pub mod scene;
pub mod system;
pub mod urdf;
mod warning_code;
pub mod ways;

/// Runs the examples of `docs/library.md` as doctests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/library.md")]
#[derive(Debug)]
pub struct LibraryPage;

/// Runs the examples of `docs/robots.md` as doctests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/robots.md")]
#[derive(Debug)]
pub struct RobotsPage;
