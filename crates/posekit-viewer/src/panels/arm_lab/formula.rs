//! The planar arm's formula, forwards and backwards, with its numbers.

use egui::{Button, RichText, ScrollArea, Ui};

use crate::state::arm::two_link::{Elbow, TwoLinkReadout};
use crate::state::arm::{ArmLab, Bench};
use crate::state::readout::fixed;
use crate::theme::{GAP, Palette};

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &mut ArmLab) {
    let Some(read) = lab.bench().and_then(Bench::two_link) else {
        return;
    };
    let mut taken = None;
    ScrollArea::both()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            // A line of a formula stays one: it is scrolled to where it has no room.
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 9.0 * GAP;
                ui.vertical(|ui| forwards(ui, &read));
                ui.vertical(|ui| taken = backwards(ui, &read));
            });
        });
    if let Some(elbow) = taken {
        lab.work(|bench| bench.take_elbow(elbow.angles));
    }
}

/// Angles to the tip.
fn forwards(ui: &mut Ui, read: &TwoLinkReadout) {
    title(ui, "Forwards: from the angles to the tip");
    for lines in [&read.x, &read.y] {
        written(ui, lines);
        ui.add_space(2.0 * GAP);
    }
}

/// A formula and what follows from it: each line below the first begins where its equals sign is.
fn written(ui: &mut Ui, lines: &[String]) {
    let palette = Palette::in_ui(ui);
    let Some((first, rest)) = lines.split_first() else {
        return;
    };
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.label(
        RichText::new(first)
            .monospace()
            .strong()
            .color(palette.text),
    );
    let indent = first.find('=').unwrap_or(2);
    for (index, line) in rest.iter().enumerate() {
        let is_last = index + 1 == rest.len();
        let color = if is_last {
            palette.accent
        } else {
            palette.quiet
        };
        let text = format!("{}{line}", " ".repeat(indent));
        let text = RichText::new(text).monospace().color(color);
        ui.label(if is_last { text.strong() } else { text });
    }
}

/// The tip, or its target, to the angles: both ways.
fn backwards(ui: &mut Ui, read: &TwoLinkReadout) -> Option<Elbow> {
    let palette = Palette::in_ui(ui);
    let at = format!(
        "Backwards: from x = {}, y = {} to the angles",
        fixed(read.target.x, 3),
        fixed(read.target.y, 3)
    );
    title(ui, &at);
    written(ui, &read.bend);
    ui.add_space(GAP);
    if !read.lift.is_empty() {
        written(ui, &read.lift);
    }
    ui.add_space(GAP);
    if let Some(beyond) = read.beyond {
        let text = format!(
            "Out of reach by {} m: there is no solution.",
            fixed(beyond, 3)
        );
        ui.label(RichText::new(text).color(palette.warning));
    }
    let mut taken = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0 * GAP;
        for (index, elbow) in read.elbows.iter().enumerate() {
            let [t1, t2] = elbow.angles.map(f64::to_degrees);
            let name = match (read.elbows.len(), index) {
                (1, _) => "Stretched or folded",
                (_, 0) => "Elbow right",
                _ => "Elbow left",
            };
            let text = format!(
                "{name}:  t1 = {}\u{b0}  t2 = {}\u{b0}",
                fixed(t1, 1),
                fixed(t2, 1)
            );
            let button = Button::selectable(elbow.is_taken, RichText::new(text));
            let response = ui.add_enabled(elbow.is_allowed, button);
            let response = response
                .on_hover_text("Stand so")
                .on_disabled_hover_text("Outside the ranges of the joints");
            if response.clicked() && !elbow.is_taken {
                taken = Some(*elbow);
            }
        }
    });
    taken
}

fn title(ui: &mut Ui, text: &str) {
    let quiet = Palette::in_ui(ui).quiet;
    ui.label(RichText::new(text).small().strong().color(quiet));
    ui.add_space(GAP);
}
