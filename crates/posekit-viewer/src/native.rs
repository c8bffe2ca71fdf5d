//! The window on a desktop.

use crate::app::{Viewer, ViewerOptions};

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WindowError {
    /// The system gave no window, or no graphics for it.
    #[error("no window could be opened: {0}")]
    NoWindow(String),
}

/// Opens the window and stays until it is closed.
///
/// # Errors
/// When the system gives no window: there is no display, or no graphics driver at all.
pub fn run_native(options: ViewerOptions) -> Result<(), WindowError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("posekit")
        .with_app_id("posekit")
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([360.0, 320.0])
        .with_drag_and_drop(true);
    let native = eframe::NativeOptions {
        viewport,
        ..eframe::NativeOptions::default()
    };
    let create: eframe::AppCreator<'_> =
        Box::new(move |context| Ok(Box::new(Viewer::of_window(context, options))));
    eframe::run_native("posekit", native, create)
        .map_err(|error| WindowError::NoWindow(error.to_string()))
}
