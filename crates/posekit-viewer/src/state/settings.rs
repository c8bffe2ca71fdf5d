//! What is remembered from one start to the next.

use serde::{Deserialize, Serialize};

use super::display::{Display, Look};
use super::transport::AtEnd;

/// What is remembered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Light or dark.
    pub look: Look,
    /// What is shown of figures.
    pub display: Display,
    /// What happens at a clip's end.
    pub at_end: AtEnd,
    /// Which parts of the window are open.
    pub layout: WindowLayout,
    /// The folder of the library.
    pub folder: Option<std::path::PathBuf>,
    /// The folder in which a file was chosen last.
    pub files_in: Option<std::path::PathBuf>,
    /// Files are asked for in the window, although the system may have dialogs.
    pub asks_in_window: bool,
}

/// Which parts of the window are open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct WindowLayout {
    /// Clips and joints.
    pub left: bool,
    /// The inspector.
    pub right: bool,
    /// The curves.
    pub curves: bool,
    /// The text of the file.
    pub text: bool,
    /// At the left the poses instead of the clips, where poses are edited.
    pub poses: bool,
}

impl Default for WindowLayout {
    fn default() -> Self {
        Self {
            left: true,
            right: true,
            curves: false,
            text: false,
            poses: false,
        }
    }
}
