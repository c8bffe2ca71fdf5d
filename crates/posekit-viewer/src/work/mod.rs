//! Work that leaves the window: files that are written, dialogs, the clipboard, the disk watched.

pub mod autosave;
#[cfg(not(target_arch = "wasm32"))]
pub mod dialog;
pub mod export;
pub mod files;
#[cfg(not(target_arch = "wasm32"))]
pub mod watch;
