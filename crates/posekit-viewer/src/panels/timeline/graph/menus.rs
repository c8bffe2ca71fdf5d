//! The menu of the graph under the right button.

use egui::{Popup, PopupKind, Response, Ui};

use super::GraphPanel;
use crate::command::{Command, KeysCommand};
use crate::panels::Asked;
use crate::panels::timeline::menu::{self, Menu};
use crate::state::session::Session;

/// Shows the menu while it is open, and opens it. It is one of egui's own list of what is open, so that Esc is
/// known to be its key.
pub(super) fn show(
    ui: &Ui,
    response: &Response,
    session: &mut Session,
    panel: &mut GraphPanel,
    asked: &mut Asked,
) {
    let id = response.id.with("menu");
    if response.secondary_clicked() && !panel.press_is_spent {
        panel.menu = response.interact_pointer_pos();
        Popup::open_id(ui.ctx(), id);
    }
    let Some(at) = panel.menu else {
        return;
    };
    Popup::new(id, ui.ctx().clone(), at, response.layer_id)
        .kind(PopupKind::Menu)
        .open_memory(None)
        .accessible_name("Keys")
        .show(|ui| {
            ui.set_min_width(150.0);
            for (name, menu) in [
                ("Curve  (T)", Menu::Interpolation),
                ("Tangents  (V)", Menu::Tangents),
                ("Beyond  (Shift+E)", Menu::Extrapolation),
                ("Rotation mode", Menu::Mode),
            ] {
                ui.menu_button(name, |ui| {
                    if menu::show(ui, menu, session) {
                        ui.close();
                    }
                });
            }
            ui.separator();
            for (name, command) in [
                ("Delete  (X)", KeysCommand::Delete),
                ("Select all  (A)", KeysCommand::SelectAll),
                ("View selected  (.)", KeysCommand::ViewSelected),
                ("View all  (Home)", KeysCommand::ViewAll),
            ] {
                if ui.button(name).clicked() {
                    asked.command(Command::Keys(command));
                }
            }
        });
    if !Popup::is_id_open(ui.ctx(), id) {
        panel.menu = None;
    }
}
