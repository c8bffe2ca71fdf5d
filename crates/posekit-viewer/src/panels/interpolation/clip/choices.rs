//! The left side: every which frame is kept, and which methods fill in the others.

use egui::{Button, ProgressBar, Rect, RichText, ScrollArea, Sense, Slider, Ui, pos2, vec2};
use posekit::inbetween::FillMethod;

use super::super::super::row;
use super::super::color;
use super::super::methods::{says, swatch};
use crate::icons::{Icon, sized_icon};
use crate::state::clip::index_to_f64;
use crate::state::interpolation::clip::{EVERY_RANGE, offered};
use crate::state::interpolation::colors::{TRUTH, hex_of_fill};
use crate::state::interpolation::{ClipLab, InterpolationLab};
use crate::theme::{GAP, Palette};

/// Height of a row.
const ROW: f32 = 25.0;

/// Shows it.
pub(in super::super) fn show(ui: &mut Ui, lab: &mut InterpolationLab) {
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| all(ui, &mut lab.clip));
}

fn all(ui: &mut Ui, lab: &mut ClipLab) {
    row::heading(ui, "Clip", |_| {});
    let quiet = Palette::in_ui(ui).quiet;
    let Some(clip) = lab.clip() else {
        row::empty_note(ui, "Open a clip to compare methods on it.");
        return;
    };
    ui.add(egui::Label::new(RichText::new(&clip.name)).truncate());
    let summary = match lab.plan() {
        Some(plan) => format!(
            "{} of {} frames kept, {} filled in and compared",
            plan.kept().len(),
            clip.frame_count(),
            plan.filled().len()
        ),
        None => "It has no frames.".to_owned(),
    };
    row::divider(ui);
    every(ui, lab);
    ui.label(RichText::new(summary).small().color(quiet));
    progress(ui, lab);
    row::divider(ui);
    row::heading(ui, "Methods", |_| {});
    let note = "Tick what is compared; the eye shows its figure.";
    ui.label(RichText::new(note).small().color(quiet));
    ui.spacing_mut().item_spacing.y = 0.0;
    truth(ui, lab);
    for method in offered() {
        method_row(ui, lab, method);
    }
    ui.add_space(2.0 * GAP);
    copy(ui, lab);
}

fn every(ui: &mut Ui, lab: &mut ClipLab) {
    let mut every = lab.every();
    ui.label("Keep every n-th frame");
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 62.0).max(40.0);
        let slider = Slider::new(&mut every, EVERY_RANGE).logarithmic(true);
        let response = ui.add(slider);
        response.widget_info(|| {
            egui::WidgetInfo::slider(true, index_to_f64(every), "Keep every n-th frame")
        });
    });
    lab.set_every(every);
}

fn progress(ui: &mut Ui, lab: &mut ClipLab) {
    let height = 22.0;
    match lab.progress() {
        Some(share) => {
            ui.horizontal(|ui| {
                let bar = ProgressBar::new(share)
                    .desired_width((ui.available_width() - 70.0).max(40.0))
                    .desired_height(12.0);
                ui.add(bar);
                if ui
                    .add(Button::new(RichText::new("Cancel").small()))
                    .clicked()
                {
                    lab.cancel();
                }
            });
        }
        None if lab.is_given_up() => {
            ui.horizontal(|ui| {
                ui.set_height(height);
                let says = "Fill in what is missing";
                let button = Button::new(RichText::new("Go on").small());
                if ui.add(button).on_hover_text(says).clicked() {
                    lab.resume();
                }
            });
        }
        None => {
            // Nothing jumps when there is something to show.
            ui.allocate_exact_size(vec2(1.0, height), Sense::hover());
        }
    }
}

fn truth(ui: &mut Ui, lab: &mut ClipLab) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    swatch(ui, rect, color(TRUTH), true);
    let palette = Palette::in_ui(ui);
    let name = Rect::from_min_max(rect.min + vec2(24.0, 0.0), rect.max - vec2(30.0, 0.0));
    row::text_in(ui, name, RichText::new("truth"), palette.text);
    let mut is_seen = lab.sees_truth();
    if eye(ui, rect, "truth", &mut is_seen) {
        lab.set_sees_truth(is_seen);
    }
}

fn method_row(ui: &mut Ui, lab: &mut ClipLab, method: FillMethod) {
    let palette = Palette::in_ui(ui);
    let is_chosen = lab.is_chosen(method);
    let word = method.to_string();
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let tick = Rect::from_min_max(rect.min, pos2(rect.right() - 30.0, rect.bottom()));
    let response = ui.interact(tick, ui.scope_id().with(("fill", &word)), Sense::click());
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_chosen, word.clone())
    });
    if response.hovered() {
        ui.painter().rect_filled(tick, 5.0, palette.hover);
    }
    swatch(ui, rect, color(hex_of_fill(method)), is_chosen);
    let ink = if is_chosen {
        palette.text
    } else {
        palette.quiet
    };
    let name = Rect::from_min_max(rect.min + vec2(24.0, 0.0), tick.max);
    row::text_in(ui, name, RichText::new(&word), ink);
    let about = match method {
        FillMethod::OwnEuler => "Euler angles, each joint's in the order of the file's channels",
        FillMethod::Same(method) => says(method),
    };
    if response.on_hover_text(about).clicked() {
        lab.set_chosen(method, !is_chosen);
    }
    if is_chosen {
        let mut is_seen = lab.is_seen(method);
        if eye(ui, rect, &word, &mut is_seen) {
            lab.set_seen(method, is_seen);
        }
    }
}

/// The eye at the end of a row. True when it was clicked.
fn eye(ui: &mut Ui, row: Rect, name: &str, is_seen: &mut bool) -> bool {
    let place = Rect::from_center_size(pos2(row.right() - 15.0, row.center().y), vec2(26.0, 22.0));
    let builder = egui::UiBuilder::new().max_rect(place);
    let clicked = ui
        .scope_builder(builder, |ui| {
            let (icon, says) = match *is_seen {
                true => (Icon::Eye, format!("Hide the figure: {name}")),
                false => (Icon::EyeOff, format!("Show the figure: {name}")),
            };
            sized_icon(ui, icon, &says, false, vec2(26.0, 22.0)).clicked()
        })
        .inner;
    if clicked {
        *is_seen = !*is_seen;
    }
    clicked
}

fn copy(ui: &mut Ui, lab: &ClipLab) {
    if let Some(command) = lab.command()
        && ui.button("Copy command").on_hover_text(&command).clicked()
    {
        ui.copy_text(command);
    }
}
