//! How a file's numbers are read: which axis is up, and what position channels do with OFFSETs.

use egui::{ComboBox, RichText, Ui};
use posekit::figure::UpAxis;
use posekit::motion::PositionPolicy;

use super::row;
use crate::state::clip::{Clip, Source};
use crate::state::session::Session;
use crate::theme::Palette;

/// Shows it for a clip of a file; what we make ourselves needs no reading.
pub fn show(ui: &mut Ui, session: &mut Session, clip: &Clip) {
    let Some(id) = session.active_id() else {
        return;
    };
    if !matches!(clip.source, Source::File(_) | Source::Bytes) || session.authored().is_some() {
        return;
    }
    row::divider(ui);
    row::heading(ui, "Read as", |_| {});
    let mut reading = clip.reading;
    let is_edited = session.is_edited(id);
    ui.add_enabled_ui(!is_edited, |ui| {
        row::line(ui, "Up", |ui| {
            ComboBox::from_id_salt("up axis")
                .selected_text(reading.up.to_string())
                .show_ui(ui, |ui| {
                    for up in UpAxis::ALL {
                        ui.selectable_value(&mut reading.up, up, up.to_string());
                    }
                })
                .response
                .on_hover_text(
                    "The axis of the file that points up; the view stands the figure on Y",
                );
        });
        policy(ui, "Root", &mut reading.positions.root);
        policy(ui, "Others", &mut reading.positions.others);
    });
    if is_edited {
        let text = "Save or undo the edits to read the file in another way.";
        let quiet = Palette::in_ui(ui).quiet;
        ui.label(RichText::new(text).small().color(quiet));
    }
    if reading != clip.reading {
        session.set_reading(id, reading);
    }
}

/// What position channels of some joints do with the OFFSETs.
fn policy(ui: &mut Ui, label: &str, chosen: &mut PositionPolicy) {
    row::line(ui, label, |ui| {
        ComboBox::from_id_salt(label)
            .selected_text(name(*chosen))
            .show_ui(ui, |ui| {
                for policy in [
                    PositionPolicy::Replace,
                    PositionPolicy::Add,
                    PositionPolicy::Ignore,
                ] {
                    ui.selectable_value(chosen, policy, name(policy));
                }
            })
            .response
            .on_hover_text("What position channels do with the OFFSET of their joint");
    });
}

fn name(policy: PositionPolicy) -> &'static str {
    match policy {
        PositionPolicy::Replace => "replace the OFFSET",
        PositionPolicy::Add => "are added to it",
        PositionPolicy::Ignore => "are ignored",
    }
}
