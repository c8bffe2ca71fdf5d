//! The list of all keys.

use egui::{Grid, RichText, Ui};

use crate::command::{ANIMATE_BINDINGS, BINDINGS, Binding, Group, TIMELINE_BINDINGS};
use crate::theme::{GAP, Palette};

/// The groups, with their titles.
const GROUPS: [(Group, &str); 7] = [
    (Group::Playback, "Playback"),
    (Group::View, "View"),
    (Group::Figure, "Figure"),
    (Group::Window, "Window and files"),
    (Group::Edit, "Modes and editing"),
    (Group::Animate, "Animated clips"),
    (Group::Timeline, "Pointer over the timeline"),
];

/// What the mouse does.
const MOUSE: [(&str, &str); 11] = [
    ("Drag", "Turn"),
    ("Right drag, shift drag", "Move"),
    ("Wheel, pinch", "Zoom"),
    ("Click a bone", "Select its joint"),
    ("Shift click", "Select several"),
    ("Double click", "Frame it"),
    ("Shift click a clip", "Compare it"),
    ("Drop a file", "Open it"),
    ("Ctrl while dragging", "In steps, or freely"),
    ("Esc while dragging", "Let it go"),
    ("Drag a robot's tip", "Its joints follow"),
];

/// Shows the list in a window of its own. False when it was closed.
pub fn show(ctx: &egui::Context) -> bool {
    let mut open = true;
    let modal = egui::Modal::new(egui::Id::unique("help"));
    let modal = modal.frame(super::modal_frame(ctx)).show(ctx, |ui| {
        ui.horizontal(|ui| {
            ui.heading("Keys and mouse");
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if crate::icons::icon_button(ui, crate::icons::Icon::Close, "Close  (Esc)")
                    .clicked()
                {
                    open = false;
                }
            });
        });
        ui.add_space(2.0 * GAP);
        let room = (ctx.content_rect().height() - 120.0).max(160.0);
        let area = egui::ScrollArea::vertical()
            .max_height(room)
            .min_scrolled_height(room);
        area.show(ui, |ui| {
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 8.0 * GAP;
                // Side by side as far as a laptop's screen goes.
                for [first, second] in [[0, 5], [1, 6], [2, 3]] {
                    ui.vertical(|ui| {
                        keys(ui, &GROUPS[first..=first]);
                        keys(ui, &GROUPS[second..=second]);
                    });
                }
                ui.vertical(|ui| {
                    keys(ui, &GROUPS[4..5]);
                    mouse(ui);
                });
            });
        });
    });
    open && !modal.should_close()
}

/// All keys, wherever they are pressed.
fn all() -> impl Iterator<Item = &'static Binding> {
    let tables = [BINDINGS, ANIMATE_BINDINGS, TIMELINE_BINDINGS];
    tables.into_iter().flatten()
}

fn keys(ui: &mut Ui, groups: &[(Group, &str)]) {
    for (group, title) in groups {
        heading(ui, title);
        Grid::new(title)
            .num_columns(2)
            .spacing([3.0 * GAP, GAP])
            .min_row_height(20.0)
            .show(ui, |ui| {
                let listed = all().filter(|b| b.group == *group && !b.says.is_empty());
                for binding in listed {
                    let keys: Vec<String> = all()
                        .filter(|other| other.command == binding.command)
                        .map(|other| other.shortcut_text(cfg!(target_os = "macos")))
                        .take(2)
                        .collect();
                    pair(ui, &keys.join(", "), binding.says);
                }
            });
        ui.add_space(3.0 * GAP);
    }
}

fn mouse(ui: &mut Ui) {
    heading(ui, "Mouse");
    Grid::new("mouse")
        .num_columns(2)
        .spacing([3.0 * GAP, GAP])
        .min_row_height(20.0)
        .show(ui, |ui| {
            for (what, does) in MOUSE {
                pair(ui, what, does);
            }
        });
}

fn heading(ui: &mut Ui, title: &str) {
    ui.label(
        RichText::new(title)
            .small()
            .strong()
            .color(Palette::in_ui(ui).quiet),
    );
    ui.add_space(GAP);
}

fn pair(ui: &mut Ui, keys: &str, says: &str) {
    ui.label(
        RichText::new(keys)
            .size(12.5)
            .color(Palette::in_ui(ui).accent),
    );
    ui.label(says);
    ui.end_row();
}
