//! Questions about what is in no file: before it is closed, and after a run that ended without saving.

use egui::{Button, RichText};

use crate::theme::{GAP, Palette};

/// What was answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Nothing yet.
    None,
    /// Save, or open what was kept.
    Yes,
    /// Let it go.
    No,
    /// Leave everything as it is.
    Later,
}

/// Asks what becomes of scenes that are not saved and are about to be closed.
pub fn ask_to_save(ctx: &egui::Context, names: &[String]) -> Answer {
    let title = match names {
        [name] => format!("Save {name} before it is closed?"),
        names => format!("Save {} scenes before they are closed?", names.len()),
    };
    ask(
        ctx,
        (&title, "Its last changes are in no file."),
        names,
        ["Save", "Do not save", "Cancel"],
    )
}

/// Asks whether scenes are opened again that a run has left which ended without saving them.
pub fn ask_to_recover(ctx: &egui::Context, names: &[String]) -> Answer {
    ask(
        ctx,
        (
            "posekit ended without saving",
            "What you had changed was kept. Open it again?",
        ),
        names,
        ["Open again", "Throw away", "Ask again later"],
    )
}

fn ask(
    ctx: &egui::Context,
    (title, says): (&str, &str),
    names: &[String],
    answers: [&str; 3],
) -> Answer {
    let mut answer = Answer::None;
    let modal = egui::Modal::new(egui::Id::unique("unsaved"));
    let shown = modal.frame(super::modal_frame(ctx)).show(ctx, |ui| {
        ui.set_width((ctx.content_rect().width() - 48.0).clamp(160.0, 380.0));
        ui.heading(title);
        ui.add_space(GAP);
        let palette = Palette::in_ui(ui);
        ui.label(RichText::new(says).color(palette.quiet));
        ui.add_space(GAP);
        for name in names.iter().take(8) {
            ui.label(RichText::new(format!("\u{2022}  {name}")));
        }
        ui.add_space(3.0 * GAP);
        ui.horizontal_wrapped(|ui| {
            let [yes, no, later] = answers;
            let yes = Button::new(RichText::new(yes).color(palette.accent).strong());
            if ui.add(yes).clicked() {
                answer = Answer::Yes;
            }
            if ui.button(no).clicked() {
                answer = Answer::No;
            }
            if ui.button(later).clicked() {
                answer = Answer::Later;
            }
        });
    });
    if answer == Answer::None && shown.should_close() {
        answer = Answer::Later;
    }
    answer
}
