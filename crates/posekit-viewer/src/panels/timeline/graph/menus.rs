//! Menus of the graph: how keys go on, their tangents, and all of it under the right button.

use egui::{Popup, PopupKind, Pos2, Response, Ui};
use posekit::keyframe::{Extrapolation, Interpolation};

use super::GraphPanel;
use crate::state::animate::channel::{Side, TangentKind};
use crate::state::session::Session;
use crate::theme::Palette;

/// Which menu is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MenuKind {
    Interpolation,
    Tangents,
    All,
}

/// A menu at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Menu {
    kind: MenuKind,
    at: Pos2,
}

impl Menu {
    pub(super) fn at(kind: MenuKind, at: Pos2) -> Self {
        Self { kind, at }
    }
}

/// The ways on, in the order in which they are offered.
pub(super) const INTERPOLATIONS: [(Interpolation, &str, &str); 4] = [
    (Interpolation::Step, "Step", "Keeps its value, then jumps"),
    (
        Interpolation::Linear,
        "Linear",
        "Straight; orientations by slerp",
    ),
    (Interpolation::Cubic, "Cubic", "A curve with tangents"),
    (
        Interpolation::Squad,
        "Squad",
        "A smooth curve through the keys, without tangents",
    ),
];

/// The ways beyond the ends, in the order in which they are offered.
const BEYOND: [(Extrapolation, &str); 4] = [
    (Extrapolation::Hold, "Hold"),
    (Extrapolation::Cycle, "Cycle"),
    (Extrapolation::CycleWithOffset, "Cycle with offset"),
    (Extrapolation::PingPong, "Ping-pong"),
];

/// What kinds of tangents are, for people.
pub(super) fn says(kind: TangentKind) -> &'static str {
    match kind {
        TangentKind::Auto => "Smooth, and never beyond the values of the keys",
        TangentKind::Smooth => "Smooth, whatever the values between come to",
        TangentKind::Flat => "Level at the key",
        TangentKind::Aligned => "Set by hand, one slope for both sides",
        TangentKind::Broken => "Set by hand, a slope for each side",
    }
}

/// Shows the menu that is open, and opens that of the right button.
pub(super) fn show(ui: &Ui, response: &Response, session: &mut Session, panel: &mut GraphPanel) {
    if response.secondary_clicked()
        && !panel.press_is_spent
        && let Some(at) = response.interact_pointer_pos()
    {
        panel.menu = Some(Menu::at(MenuKind::All, at));
    }
    let Some(menu) = panel.menu else {
        return;
    };
    let mut open = true;
    let popup = Popup::new(
        response.id.with("menu"),
        ui.ctx().clone(),
        menu.at,
        response.layer_id,
    );
    popup
        .kind(PopupKind::Menu)
        .open_bool(&mut open)
        .accessible_name("Keys")
        .show(|ui| {
            ui.set_min_width(150.0);
            if panel.graph.selected().is_empty() {
                let quiet = Palette::in_ui(ui).quiet;
                ui.label(egui::RichText::new("No key is selected").color(quiet));
                return;
            }
            match menu.kind {
                MenuKind::Interpolation => interpolations(ui, session, panel),
                MenuKind::Tangents => tangents(ui, session, panel),
                MenuKind::All => all(ui, session, panel),
            }
        });
    if !open {
        panel.menu = None;
    }
}

fn title(ui: &mut Ui, text: &str) {
    let quiet = Palette::in_ui(ui).quiet;
    ui.label(egui::RichText::new(text).small().color(quiet));
}

fn interpolations(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel) {
    title(ui, "Goes on");
    for (interpolation, name, says) in INTERPOLATIONS {
        if ui.button(name).on_hover_text(says).clicked() {
            panel.graph.set_interpolation(session, interpolation);
        }
    }
}

fn tangents(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel) {
    title(ui, "Tangents");
    for kind in TangentKind::ALL {
        if ui.button(kind.name()).on_hover_text(says(kind)).clicked() {
            panel.graph.set_tangents(session, kind);
        }
    }
}

fn all(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel) {
    ui.menu_button("Goes on  (T)", |ui| interpolations(ui, session, panel));
    ui.menu_button("Tangents  (V)", |ui| tangents(ui, session, panel));
    ui.menu_button("Before the first key", |ui| {
        beyond(ui, session, panel, Side::Incoming);
    });
    ui.menu_button("After the last key", |ui| {
        beyond(ui, session, panel, Side::Outgoing);
    });
    ui.separator();
    if ui.button("Delete  (X)").clicked() {
        panel.graph.delete(session);
    }
}

fn beyond(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel, side: Side) {
    for (way, name) in BEYOND {
        if ui.button(name).clicked() {
            panel.graph.set_beyond(session, side, way);
        }
    }
}
