//! The edited pose: which frames it reaches, kept or taken back.

use egui::{Button, RichText, Slider, Ui};

use super::{Asked, row, tip};
use crate::command::Command;
use crate::state::edit::{Blend, Gesture, Reach};
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// The longest fall-off that is offered, frames.
const LONGEST_FALLOFF: usize = 240;

/// Shows the part of the inspector that is about the edit.
pub fn show(ui: &mut Ui, session: &mut Session, asked: &mut Asked) {
    row::heading(ui, "Edit", |_| {});
    let palette = Palette::in_ui(ui);
    let says = summary(session);
    ui.label(RichText::new(says).small().color(palette.quiet));
    ui.add_space(GAP);
    spread(ui, session);
    ui.add_space(GAP);
    let has_draft = session.edits().is_some_and(|edits| edits.draft().is_some());
    ui.horizontal(|ui| {
        ui.add_enabled_ui(has_draft, |ui| {
            for (name, says, command) in [
                (
                    "Keep",
                    "Keep it; what comes next is another edit",
                    Command::KeepPose,
                ),
                (
                    "Reset",
                    "Give the frames back the poses they had",
                    Command::ResetPose,
                ),
            ] {
                if ui
                    .add(Button::new(name))
                    .on_hover_text(tip(says, command))
                    .clicked()
                {
                    asked.command(command);
                }
            }
        });
    });
}

/// What is edited, in a few words.
fn summary(session: &Session) -> String {
    let Some(edits) = session.edits() else {
        return "Nothing is edited yet".to_owned();
    };
    let Some(draft) = edits.draft() else {
        return match edits.undo_count() {
            0 => "Nothing is edited yet".to_owned(),
            1 => "One edit was made".to_owned(),
            count => format!("{count} edits were made"),
        };
    };
    let joints = match edits.changed_joints().len() {
        1 => "1 joint".to_owned(),
        count => format!("{count} joints"),
    };
    let frames = session.transport.frame_count();
    match draft.spread.frames(draft.frame, frames) {
        (first, last) if first == last => format!("{joints} at frame {first}"),
        (first, last) => format!(
            "{joints} at frame {}, over {first}\u{2013}{last}",
            draft.frame
        ),
    }
}

/// How the edit reaches the frames around. Dragging a slider is one step of the history.
fn spread(ui: &mut Ui, session: &mut Session) {
    let before = session.spread();
    let mut spread = before;
    let range = session.transport.range();
    row::line(ui, "Reaches", |ui| {
        let is_stretch = matches!(spread.reach, Reach::Stretch(..));
        if ui
            .selectable_label(!is_stretch, "This frame")
            .on_hover_text("Full effect at the edited frame only")
            .clicked()
        {
            spread.reach = Reach::Frame;
        }
        if ui
            .selectable_label(is_stretch, "Play range")
            .on_hover_text("Full effect in all of the range that is played: set it with I and O")
            .clicked()
        {
            spread.reach = Reach::Stretch(range.0, range.1);
        }
    });
    let slider = row::line(ui, "Fall-off", |ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 60.0).max(60.0);
        let most = session.transport.last_frame().clamp(1, LONGEST_FALLOFF);
        ui.add(
            Slider::new(&mut spread.falloff_frames, 0..=most).clamping(egui::SliderClamping::Never),
        )
        .on_hover_text(
            "Frames on both sides over which the edit fades, by a raised cosine: \
                 with none it is a key at this frame, and pops",
        )
    });
    row::line(ui, "Others get", |ui| {
        ui.selectable_value(&mut spread.blend, Blend::Change, "The change")
            .on_hover_text("The same turn on top of their own motion");
        ui.selectable_value(&mut spread.blend, Blend::Pose, "The pose")
            .on_hover_text("This very pose: what moves is held");
    });
    if spread != before {
        let gesture = gesture_of(ui, session, slider.dragged());
        if let Some(gesture) = gesture {
            session.set_spread(spread, gesture);
        }
    }
}

/// All that happens while a slider is dragged is one gesture; a click is one of its own.
fn gesture_of(ui: &Ui, session: &mut Session, is_dragged: bool) -> Option<Gesture> {
    let id = egui::Id::unique("spread gesture");
    let started = ui.input(|i| i.pointer.primary_pressed());
    let running: Option<Gesture> = ui.data(|data| data.get_temp(id));
    if let (Some(gesture), true, false) = (running, is_dragged, started) {
        return Some(gesture);
    }
    let gesture = session.new_gesture()?;
    ui.data_mut(|data| data.insert_temp(id, gesture));
    Some(gesture)
}
