//! Work that leaves the window: files that are written, dialogs, the clipboard, the disk watched.

pub mod autosave;
pub mod export;
pub mod files;
#[cfg(not(target_arch = "wasm32"))]
pub mod watch;
