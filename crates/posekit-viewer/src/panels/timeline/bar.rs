//! The bar over the keys: which view, how poses are keyed, and what is done to the selected keys.

use egui::{Button, RichText, Ui};

use super::super::{Asked, row, tip};
use super::{Tab, Timeline};
use crate::command::Command;
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// What the bar remembers.
#[derive(Debug, Default)]
pub(super) struct Bar {}

/// Shows the bar.
pub(super) fn show(ui: &mut Ui, session: &mut Session, timeline: &mut Timeline, asked: &mut Asked) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for tab in Tab::ALL {
            if row::segment(ui, tab.name(), timeline.tab == tab).clicked() {
                timeline.tab = tab;
            }
        }
        ui.add_space(2.0 * GAP);
        keying(ui, session, asked);
    });
    ui.add_space(GAP);
}

fn keying(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let settings = session.animate();
    let accent = Palette::in_ui(ui).accent;
    let name = RichText::new("Key");
    let name = if session.has_pending_pose() {
        name.color(accent)
    } else {
        name
    };
    let says = "Key the selected joints, and those that were posed";
    if ui
        .add(Button::new(name))
        .on_hover_text(tip(says, Command::InsertKeys))
        .clicked()
    {
        asked.command(Command::InsertKeys);
    }
    if ui
        .add(Button::new("Key all"))
        .on_hover_text(tip("Key the whole pose", Command::KeyWholePose))
        .clicked()
    {
        asked.command(Command::KeyWholePose);
    }
    for (name, says, on, command) in [
        (
            "Auto-key",
            "A changed pose becomes keys at once",
            settings.auto_key,
            Command::ToggleAutoKey,
        ),
        (
            "IK",
            "Drag hands and feet to targets; otherwise joints are turned by rings",
            settings.uses_ik,
            Command::ToggleUseIk,
        ),
    ] {
        let button = Button::selectable(on, name);
        if ui.add(button).on_hover_text(tip(says, command)).clicked() {
            asked.command(command);
        }
    }
}
