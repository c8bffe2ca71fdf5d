//! The posekit window: open motion files and see the character move.
//!
//! One program, on the desktop ([`run_native`]) and in a web page. The state ([`state`]) knows no
//! widget, panels ([`panels`]) show it and say what is asked ([`command`]), reading ([`load`]) and
//! drawing ([`picture`]) happen away from the window, which therefore never waits.

pub mod app;
pub mod command;
pub mod gizmo;
pub mod icons;
pub mod load;
#[cfg(not(target_arch = "wasm32"))]
mod native;
pub mod panels;
pub mod picture;
pub mod state;
pub mod theme;
#[cfg(target_arch = "wasm32")]
pub mod web;
pub mod work;

pub use app::{Viewer, ViewerOptions};
#[cfg(not(target_arch = "wasm32"))]
pub use native::{WindowError, run_native};
