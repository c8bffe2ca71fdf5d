//! What lies over the lab's views: which page, how it is shown, how the rings lie.

use egui::{Align, Button, Frame, Layout, Margin, Rect, Stroke, Ui, UiBuilder, vec2};
use posekit::rotation::Axis;

use super::super::{Asked, row, tip};
use crate::command::Command;
use crate::state::display::Compare;
use crate::state::interpolation::{InterpolationLab, Page, Picture};
use crate::state::mode::{Space, TURN_STEP_DEG};
use crate::theme::{GAP, Palette};

/// Under these widths the strip leaves out what keys do as well, and the list of keys with a click.
const SNAP_ROOM: f32 = 760.0;
const UNDO_ROOM: f32 = 560.0;

/// Under this width the cards stand under each other.
const NARROW: f32 = 480.0;

/// Shows it.
pub(super) fn show(ui: &mut Ui, rect: Rect, lab: &mut InterpolationLab, asked: &mut Asked) {
    let room = rect.shrink2(vec2(10.0, 6.0));
    if room.width() < 160.0 || room.height() < 60.0 {
        return;
    }
    let builder = UiBuilder::new()
        .max_rect(room)
        .layout(if room.width() < NARROW {
            Layout::top_down(Align::Min)
        } else {
            Layout::left_to_right(Align::Min)
        });
    ui.scope_builder(builder, |ui| {
        ui.spacing_mut().item_spacing = vec2(2.0 * GAP, GAP);
        card(ui, |ui| pages(ui, lab));
        match lab.page() {
            Page::Orientations => {
                card(ui, |ui| pictures(ui, lab));
                if room.width() >= UNDO_ROOM {
                    card(ui, |ui| {
                        let (undo, redo) = lab.can_undo_redo();
                        row::undo_buttons(ui, (undo.into(), redo.into()), 22.0, asked);
                        if room.width() >= SNAP_ROOM {
                            rings(ui, lab, asked);
                        }
                    });
                }
            }
            Page::Clip => card(ui, |ui| arrangements(ui, lab)),
        }
    });
}

fn card(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let palette = Palette::in_ui(ui);
    let card = Frame::NONE
        .fill(palette.raised.gamma_multiply(0.94))
        .stroke(Stroke::new(1.0, palette.line))
        .corner_radius(9.0)
        .inner_margin(Margin::same(3));
    card.show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            contents(ui);
        });
    });
}

fn pages(ui: &mut Ui, lab: &mut InterpolationLab) {
    for (page, name, says) in [
        (
            Page::Orientations,
            "Orientations",
            "The ways between orientations of your own",
        ),
        (
            Page::Clip,
            "On a clip",
            "Keep some frames of the active clip, fill in the others by each method, and compare",
        ),
    ] {
        if row::segment(ui, name, lab.page() == page)
            .on_hover_text(says)
            .clicked()
        {
            lab.set_page(page);
        }
    }
}

fn pictures(ui: &mut Ui, lab: &mut InterpolationLab) {
    for picture in Picture::ALL {
        let response = row::segment(ui, picture.name(), lab.picture() == picture);
        if response.on_hover_text(picture.says()).clicked() {
            lab.set_picture(picture);
        }
    }
    if lab.picture() == Picture::Sphere {
        ui.add_space(GAP);
        for (axis, says) in [
            (Axis::X, "The path of the tip of the red axis"),
            (Axis::Y, "The path of the tip of the green axis"),
            (
                Axis::Z,
                "The path of the tip of the blue axis, where the nose points",
            ),
        ] {
            let response = row::segment(ui, &axis.letter().to_string(), lab.tip() == axis);
            if response.on_hover_text(says).clicked() {
                lab.set_tip(axis);
            }
        }
    }
}

fn rings(ui: &mut Ui, lab: &mut InterpolationLab, asked: &mut Asked) {
    for (space, name, says) in [
        (Space::World, "World", "The rings' axes are the world's"),
        (Space::Local, "Local", "The rings' axes are the body's"),
    ] {
        if row::segment(ui, name, lab.space() == space)
            .on_hover_text(says)
            .clicked()
        {
            lab.set_space(space);
        }
    }
    let says = format!("Turn in steps of {TURN_STEP_DEG}\u{b0}; Ctrl does the other");
    let button = Button::selectable(lab.snaps(), "Snap");
    let says = tip(&says, Command::ToggleSnap);
    if ui.add(button).on_hover_text(says).clicked() {
        asked.command(Command::ToggleSnap);
    }
}

fn arrangements(ui: &mut Ui, lab: &mut InterpolationLab) {
    for (arrangement, name, says) in [
        (
            Compare::SideBySide,
            "Side by side",
            "The figures next to one another",
        ),
        (
            Compare::Overlaid,
            "Overlaid",
            "All figures where the clip says",
        ),
    ] {
        let response = row::segment(ui, name, lab.clip.arrangement() == arrangement);
        if response.on_hover_text(says).clicked() {
            lab.clip.set_arrangement(arrangement);
        }
    }
}
