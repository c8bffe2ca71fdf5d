//! The panels of the window. They show the state and say what is asked; what is done about it is
//! the application's.

pub mod arm_lab;
#[cfg(not(target_arch = "wasm32"))]
pub mod chooser;
pub mod curves;
pub mod edit;
pub mod elide;
pub mod export;
pub mod help;
pub mod ik;
pub mod inspector;
pub mod interpolation;
pub mod joints;
pub mod library;
pub mod notices;
pub mod pose_library;
pub mod reading;
pub mod row;
pub mod scene;
pub mod sides;
pub mod text;
pub mod things;
pub mod timeline;
pub mod top_bar;
pub mod transport;
pub mod unsaved;
pub mod view;

use std::path::PathBuf;

use crate::command::{Command, shortcut_of};
use crate::state::animate::Start;
use crate::state::session::ClipId;

/// Something asked for that is about a certain clip or file.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// A clip becomes the active one.
    Activate(ClipId),
    /// A clip goes onto the stage beside the active one, or off it.
    SetShown(ClipId, bool),
    /// A clip is closed.
    Close(ClipId),
    /// A file is opened; beside the active clip or alone.
    OpenPath(PathBuf, bool),
    /// The text of an open clip's file is shown.
    ShowText(ClipId),
    /// A file is opened, and its text shown.
    ShowTextOf(PathBuf),
    /// A file of the server is saved as it is.
    Download(PathBuf),
    /// The folder is not listed any more.
    CloseFolder,
    /// The active clip's finding of that place in the list is shown.
    ShowFinding(usize),
    /// A clip whose file has changed is read again.
    Reload(ClipId),
    /// The active clip becomes an authored one.
    Author(Start),
    /// Files are asked for in the window, or by the system.
    #[cfg(not(target_arch = "wasm32"))]
    AskInWindow(bool),
}

/// What panels ask for while they are shown.
#[derive(Debug, Default)]
pub struct Asked {
    /// Commands, in the order in which they were asked for.
    pub commands: Vec<Command>,
    /// Requests, in the order in which they were made.
    pub requests: Vec<Request>,
    /// Whether the curves are open, for the button that opens them.
    pub curves_open: bool,
    /// Whether files are asked for in the window, for the menu that chooses it.
    pub asks_in_window: bool,
}

impl Asked {
    /// Asks for a command.
    pub fn command(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Whether nothing was asked for.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.commands.is_empty() && self.requests.is_empty()
    }
}

/// What a button's tooltip says: what it does, and its key.
#[must_use]
pub fn tip(says: &str, command: Command) -> String {
    match shortcut_of(command, cfg!(target_os = "macos")) {
        Some(keys) => format!("{says}  ({keys})"),
        None => says.to_owned(),
    }
}

/// A menu that stays open while things are set in it.
#[must_use]
pub fn stay_open(
    menu: egui::containers::menu::MenuButton<'_>,
) -> egui::containers::menu::MenuButton<'_> {
    let config = egui::containers::menu::MenuConfig::default()
        .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    menu.config(config)
}

/// The frame of a window over everything.
pub fn modal_frame(ctx: &egui::Context) -> egui::Frame {
    // On a phone the contents need the room.
    let margin = if ctx.content_rect().width() < 600.0 {
        12
    } else {
        24
    };
    egui::Frame::window(&ctx.global_style()).inner_margin(egui::Margin::same(margin))
}
