//! The interpolation lab: start and end with what every method makes of the way between them, keys at the
//! left, methods at the right, curves below; and the same methods on a real clip.

mod clip;
mod keys;
mod methods;
mod plots;
mod strip;
mod time;
mod view;

use egui::{CentralPanel, Color32, Frame, Margin, Panel, Rect, Ui};

use super::Asked;
use super::sides::{Side, Sides, within};
use crate::picture::painter::Painter;
use crate::state::display::Look;
use crate::state::interpolation::{InterpolationLab, Page};

pub use plots::Quantity;

/// What the lab's panels remember.
#[derive(Clone, Copy, Debug)]
pub struct InterpolationPanel {
    /// What the curves below the view are of, left and right.
    pub plots: [Quantity; 2],
    /// The curves are closed: more room for the view.
    pub is_closed: bool,
}

impl Default for InterpolationPanel {
    fn default() -> Self {
        Self {
            plots: [Quantity::Speed, Quantity::Deviation],
            is_closed: false,
        }
    }
}

/// A colour of the lab's lists and curves.
fn color(hex: u32) -> Color32 {
    let [_, r, g, b] = hex.to_be_bytes();
    Color32::from_rgb(r, g, b)
}

/// Shows the lab in all the room there is. Returns where the view is, and where the room under its tools begins.
pub fn show(
    ui: &mut Ui,
    (lab, panel, painter): (&mut InterpolationLab, &mut InterpolationPanel, &mut Painter),
    (sides, look): (Sides, Look),
    asked: &mut Asked,
) -> (Rect, f32) {
    let page = lab.page();
    let before = (lab.version(), lab.clip.version());
    let ground = Frame::NONE.fill(ui.visuals().panel_fill);
    let side = ground.inner_margin(Margin::symmetric(10, 6));
    lab.measure();
    lab.clip.set_look(look);
    if sides.left {
        sides
            .panel(Side::Left, "interpolation left", (240.0, 268.0), ui)
            .frame(side)
            .show(ui, |ui| {
                within(ui, |ui| match page {
                    Page::Orientations => keys::show(ui, lab),
                    Page::Clip => clip::choices::show(ui, lab),
                });
            });
    }
    if sides.right {
        sides
            .panel(Side::Right, "interpolation right", (250.0, 300.0), ui)
            .frame(side)
            .show(ui, |ui| {
                within(ui, |ui| match page {
                    Page::Orientations => methods::show(ui, lab),
                    Page::Clip => clip::errors::show(ui, lab),
                });
            });
    }
    if !sides.is_under_view() {
        plots::show_below(ui, lab, panel, !sides.right);
    }
    Panel::bottom("interpolation time")
        .frame(ground.inner_margin(Margin::symmetric(10, 4)))
        .resizable(false)
        .exact_size(ui.spacing().interact_size.y.max(28.0) + 10.0)
        .show(ui, |ui| time::show(ui, lab, asked));
    // What was set above is measured before it is shown.
    lab.measure();
    let shown = CentralPanel::no_frame().show(ui, |ui| {
        let rect = ui.available_rect_before_wrap();
        let free = match page {
            Page::Orientations => view::show(ui, (&mut *lab, painter), look, asked),
            Page::Clip => clip::view::show(ui, (&mut *lab, painter), look, asked),
        };
        (rect, free)
    });
    if (lab.version(), lab.clip.version()) != before {
        ui.ctx().request_repaint();
    }
    shown.inner
}
