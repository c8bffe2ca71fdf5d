//! What lies over the lab's views: which page, how it is shown, how the rings lie.

use egui::{Align, Button, Frame, Layout, Margin, Rect, Stroke, Ui, UiBuilder, vec2};
use posekit::rotation::Axis;

use super::super::{Asked, row, tip};
use crate::command::Command;
use crate::state::display::Compare;
use crate::state::interpolation::{InterpolationLab, Page, Picture};
use crate::state::mode::{Space, TURN_STEP_DEG};
use crate::theme::Palette;

/// Under these widths the strip leaves out what keys do as well, and the list of keys with a click.
const SNAP_ROOM: f32 = 760.0;
const UNDO_ROOM: f32 = 560.0;

/// Shows it. Where it ends.
pub(super) fn show(ui: &mut Ui, rect: Rect, lab: &mut InterpolationLab, asked: &mut Asked) -> f32 {
    let room = rect.shrink2(vec2(10.0, 6.0));
    if room.width() < 120.0 || room.height() < 60.0 {
        return rect.top();
    }
    let builder = UiBuilder::new()
        .max_rect(room)
        .layout(Layout::left_to_right(Align::Min));
    let shown = ui.scope_builder(builder, |ui| {
        type Context<'a> = (&'a mut InterpolationLab, &'a mut Asked);
        let groups: [row::Group<Context<'_>>; 4] = [
            |ui, room, (lab, _)| card(ui, |ui| pages(ui, room, lab)),
            |ui, room, (lab, _)| {
                card(ui, |ui| match lab.page() {
                    Page::Orientations => pictures(ui, room, lab),
                    Page::Clip => arrangements(ui, room, lab),
                });
            },
            |ui, _, (lab, _)| {
                if lab.page() == Page::Orientations && lab.picture() == Picture::Sphere {
                    card(ui, |ui| tips(ui, lab));
                }
            },
            |ui, room, (lab, asked)| {
                if lab.page() == Page::Orientations && room >= UNDO_ROOM {
                    card(ui, |ui| {
                        let (undo, redo) = lab.can_undo_redo();
                        row::undo_buttons(ui, (undo.into(), redo.into()), 22.0, asked);
                        if room >= SNAP_ROOM {
                            rings(ui, lab, asked);
                        }
                    });
                }
            },
        ];
        row::lines(ui, &mut (lab, asked), &groups);
        ui.min_rect()
    });
    shown.inner.bottom()
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

/// What a card takes beside what is in it.
const CARD: f32 = 8.0;

fn pages(ui: &mut Ui, room: f32, lab: &mut InterpolationLab) {
    let pages = [Page::Orientations, Page::Clip];
    let options = [
        ("Orientations", "The ways between orientations of your own"),
        (
            "On a clip",
            "Keep some frames of the active clip, fill in the others by each method, and compare",
        ),
    ];
    let now = pages.iter().position(|page| *page == lab.page());
    if let Some(index) = row::one_of(ui, "page", room - CARD, now, &options) {
        lab.set_page(pages[index]);
    }
}

fn pictures(ui: &mut Ui, room: f32, lab: &mut InterpolationLab) {
    let options = Picture::ALL.map(|picture| (picture.name(), picture.says()));
    let mut pictures = Picture::ALL.iter();
    let now = pictures.position(|picture| *picture == lab.picture());
    if let Some(index) = row::one_of(ui, "picture", room - CARD, now, &options) {
        lab.set_picture(Picture::ALL[index]);
    }
}

/// Whose path is drawn on the sphere.
fn tips(ui: &mut Ui, lab: &mut InterpolationLab) {
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

fn arrangements(ui: &mut Ui, room: f32, lab: &mut InterpolationLab) {
    let arrangements = [Compare::SideBySide, Compare::Overlaid];
    let options = [
        ("Side by side", "The figures next to one another"),
        ("Overlaid", "All figures where the clip says"),
    ];
    let mut known = arrangements.iter();
    let now = known.position(|arrangement| *arrangement == lab.clip.arrangement());
    if let Some(index) = row::one_of(ui, "arrangement", room - CARD, now, &options) {
        lab.clip.set_arrangement(arrangements[index]);
    }
}
