//! Before a clip is authored: how it becomes so.

use egui::{Button, DragValue, RichText, Ui};
use posekit::keyframe::{LEAST_ANGLE_DEG, LEAST_DISTANCE_HEIGHTS, ReduceConfig};

use super::super::{Asked, Request, row};
use crate::state::animate::Start;
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// What a choice does stands beside it where there is this much room, and otherwise below it.
const BESIDE: f32 = 620.0;

/// What is set before a clip is reduced to keys.
#[derive(Debug, Default)]
pub(super) struct Begin {
    reduce: ReduceConfig,
}

/// Shows the choice.
pub(super) fn show(ui: &mut Ui, session: &Session, begin: &mut Begin, asked: &mut Asked) {
    let Some(clip) = session.active_clip() else {
        row::empty_note(ui, "Open a clip, or a scene, to animate its skeleton.");
        return;
    };
    let palette = Palette::in_ui(ui);
    ui.add_space(GAP);
    ui.label(RichText::new("Animate").strong());
    let text = format!(
        "Make keys for the skeleton of {}. The file itself stays as it is.",
        clip.name
    );
    ui.label(RichText::new(text).color(palette.quiet));
    ui.add_space(2.0 * GAP);
    let mut choice = |ui: &mut Ui, name: &str, says: &str, start: Start| {
        let height = ui.spacing().interact_size.y.max(26.0);
        let says = egui::Label::new(RichText::new(says).color(palette.quiet)).wrap();
        let mut button = |ui: &mut Ui| {
            let button = ui.add_sized([210.0, height], Button::new(name));
            if button.clicked() {
                asked.requests.push(Request::Author(start));
            }
        };
        if ui.available_width() < BESIDE {
            button(ui);
            ui.add(says);
        } else {
            ui.horizontal(|ui| {
                button(ui);
                ui.add(says);
            });
        }
    };
    choice(
        ui,
        "Blank, from the rest pose",
        "One key of the rest pose at the start; the motion is left out",
        Start::Rest,
    );
    choice(
        ui,
        "Blank, from this pose",
        "One key of the pose shown at the start; the motion is left out",
        Start::Pose,
    );
    choice(
        ui,
        "Over the motion",
        "The clip goes on playing; keys take its place joint by joint",
        Start::OverMotion,
    );
    choice(
        ui,
        "Reduce to keys",
        "The same motion from few keys, to within",
        Start::Reduced(begin.reduce),
    );
    ui.horizontal(|ui| {
        if ui.available_width() >= BESIDE {
            ui.add_space(210.0 + 2.0 * GAP);
        }
        let config = &mut begin.reduce;
        ui.add(
            DragValue::new(&mut config.angle_deg)
                .speed(0.05)
                .range(LEAST_ANGLE_DEG..=90.0)
                .max_decimals(3)
                .suffix("\u{b0}"),
        )
        .on_hover_text("The largest difference of a joint's rotation");
        let mut percent = 100.0 * config.distance_heights;
        ui.add(
            DragValue::new(&mut percent)
                .speed(0.02)
                .range(100.0 * LEAST_DISTANCE_HEIGHTS..=100.0)
                .max_decimals(3)
                .suffix(" % of the height"),
        )
        .on_hover_text("The largest difference of a joint's place, in heights of the skeleton");
        config.distance_heights = percent / 100.0;
    });
}
