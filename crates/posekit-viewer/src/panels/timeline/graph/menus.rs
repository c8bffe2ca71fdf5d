//! The menu of the graph under the right button.

use egui::{Popup, PopupKind, Pos2, Response, Ui};

use super::GraphPanel;
use crate::command::{Command, KeysCommand};
use crate::panels::Asked;
use crate::panels::timeline::menu::{self, Menu};
use crate::state::session::Session;

/// Shows the menu while it is open, and opens it.
pub(super) fn show(
    ui: &Ui,
    response: &Response,
    session: &mut Session,
    panel: &mut GraphPanel,
    asked: &mut Asked,
) {
    if response.secondary_clicked() && !panel.press_is_spent {
        panel.menu = response.interact_pointer_pos();
    }
    let Some(at) = panel.menu else {
        return;
    };
    if !show_at(ui, response, at, session, asked) {
        panel.menu = None;
    }
}

/// False when it is closed.
fn show_at(
    ui: &Ui,
    response: &Response,
    at: Pos2,
    session: &mut Session,
    asked: &mut Asked,
) -> bool {
    let mut open = true;
    let (id, layer) = (response.id.with("menu"), response.layer_id);
    Popup::new(id, ui.ctx().clone(), at, layer)
        .kind(PopupKind::Menu)
        .open_bool(&mut open)
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
    open
}
