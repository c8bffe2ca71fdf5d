//! The arm lab: a robot in the middle, its joints at the left, what its tip does at the right, and the
//! mathematics below.

mod below;
mod formula;
mod jacobian;
mod joints;
mod matrices;
mod numbers;
mod strip;
mod view;

use egui::{CentralPanel, Frame, Margin, Rect, Ui};
use posekit::skeleton::JointId;

use super::Asked;
use super::sides::{Side, Sides, within};
use crate::picture::painter::Painter;
use crate::state::arm::ArmLab;
use crate::state::arm::factors::Detail;
use crate::state::display::Look;

/// What is shown below the view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Table {
    /// The planar arm's formula; the matrices for other robots.
    #[default]
    Formula,
    /// The factors of the map from the tip to the world.
    Matrices,
    /// The Jacobian.
    Jacobian,
    /// Nothing: more room for the view.
    Closed,
}

/// What the lab's panels remember.
#[derive(Clone, Copy, Debug, Default)]
pub struct LabPanel {
    /// What is shown below the view.
    pub table: Table,
    /// How finely the product is told.
    pub detail: Detail,
    /// The joint whose slider the pointer is over.
    pub pointed: Option<JointId>,
}

/// Shows the lab in all the room there is. Returns where the view is, and where the room under its tools begins.
pub fn show(
    ui: &mut Ui,
    (lab, panel, painter): (&mut ArmLab, &mut LabPanel, &mut Painter),
    (sides, look): (Sides, Look),
    asked: &mut Asked,
) -> (Rect, f32) {
    let before = lab.version();
    let ground = Frame::NONE.fill(ui.visuals().panel_fill);
    let side = ground.inner_margin(Margin::symmetric(10, 6));
    if sides.left {
        sides
            .panel(Side::Left, "lab joints", (230.0, 272.0), ui)
            .frame(side)
            .show(ui, |ui| {
                within(ui, |ui| joints::show(ui, lab, panel, asked))
            });
    }
    if sides.right {
        sides
            .panel(Side::Right, "lab numbers", (240.0, 292.0), ui)
            .frame(side)
            .show(ui, |ui| within(ui, |ui| numbers::show(ui, lab)));
    }
    if !sides.is_under_view() {
        below::show(ui, lab, panel);
    }
    let shown = CentralPanel::no_frame().show(ui, |ui| {
        let rect = ui.available_rect_before_wrap();
        let free = view::show(ui, (&mut *lab, *panel, painter), look, asked);
        (rect, free)
    });
    // What was shown before it changed is shown again as it is now.
    if lab.version() != before {
        ui.ctx().request_repaint();
    }
    shown.inner
}
