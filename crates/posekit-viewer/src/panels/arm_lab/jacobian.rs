//! The Jacobian: a column for each value, how the tip moves and how it turns.

use egui::{Grid, RichText, ScrollArea, Ui};
use glam::DVec3;

use crate::state::arm::ArmLab;
use crate::state::readout::fixed;
use crate::theme::{CURVES, GAP, Palette};

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &ArmLab) {
    let Some(bench) = lab.bench() else { return };
    let mobility = bench.mobility();
    let palette = Palette::in_ui(ui);
    let robot = bench.robot();
    ScrollArea::both()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
            Grid::new("jacobian")
                .spacing([6.0 * GAP, 1.5 * GAP])
                .min_row_height(17.0)
                .show(ui, |ui| {
                    ui.label("");
                    for (index, kind) in robot.values.iter().enumerate() {
                        let name = robot.joint_name(kind.joint);
                        let text = RichText::new(format!("t{}", index + 1)).strong();
                        ui.label(text.color(palette.accent)).on_hover_text(name);
                    }
                    ui.end_row();
                    for (name, says, of) in ROWS {
                        let hue = CURVES[of % 3];
                        let tint = palette.text.lerp_to_gamma(hue, 0.45);
                        ui.label(RichText::new(name).monospace().color(tint))
                            .on_hover_text(says);
                        for column in &mobility.jacobian.columns {
                            let value = component(*column, of);
                            let text = format!("{:>7}", fixed(value, 3));
                            ui.label(RichText::new(text).monospace().color(tint));
                        }
                        ui.end_row();
                    }
                });
            ui.add_space(GAP);
            let says = "The tip's velocity v = J dt, its angular velocity w below. Where columns depend on \
                        each other the arm is singular.";
            ui.label(RichText::new(says).small().color(palette.quiet));
        });
}

/// Names of the rows, what they say, and which component they are.
const ROWS: [(&str, &str, usize); 6] = [
    ("v x", "How fast the tip goes along the world's X", 0),
    ("v y", "How fast the tip goes along the world's Y, up", 1),
    ("v z", "How fast the tip goes along the world's Z", 2),
    ("w x", "How fast it turns about the world's X", 3),
    ("w y", "How fast it turns about the world's Y", 4),
    ("w z", "How fast it turns about the world's Z", 5),
];

fn component((moved, turned): (DVec3, DVec3), index: usize) -> f64 {
    match index {
        0..=2 => moved[index],
        _ => turned[index - 3],
    }
}
