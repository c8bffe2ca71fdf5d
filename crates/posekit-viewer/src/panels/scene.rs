//! What is authored: the scene's part of the inspector.

use egui::{Button, RichText, Ui};
use posekit_formats::scene::SkeletonSource;

use super::{Asked, row, tip};
use crate::command::Command;
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// Shows it.
pub fn show(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let Some(authored) = session.authored() else {
        return;
    };
    let palette = Palette::in_ui(ui);
    row::heading(ui, "Scene", |_| {});
    let scene = authored.scene();
    let says = |ui: &mut Ui, name: &str, text: String| {
        row::line(ui, name, |ui| {
            ui.add(egui::Label::new(RichText::new(text).color(palette.text)).truncate());
        });
    };
    let file = match authored.path().and_then(|path| path.file_name()) {
        Some(name) => name.to_string_lossy().into_owned(),
        None => "none yet".to_owned(),
    };
    let mark = if authored.is_dirty() {
        ", not saved"
    } else {
        ""
    };
    says(ui, "File", format!("{file}{mark}"));
    let skeleton = match &scene.skeleton {
        SkeletonSource::File(name) => last_part(name),
        SkeletonSource::Inline(joints) => format!("in the scene, {} joints", joints.len()),
    };
    says(ui, "Skeleton", skeleton);
    for layer in &scene.motions {
        says(ui, "Plays", last_part(&layer.file));
    }
    let [start, end] = scene.range_secs;
    let range = format!(
        "{start:.2} s to {end:.2} s, {:.4} fps",
        scene.frames_per_sec
    );
    says(ui, "Range", trimmed(&range));
    says(ui, "Keys", authored.key_count().to_string());
    ui.add_space(GAP);
    ui.horizontal(|ui| {
        for (name, says, command) in [
            ("Save", "Into the scene's file", Command::SaveScene),
            ("Save as\u{2026}", "Into another file", Command::SaveSceneAs),
        ] {
            let button = ui.add(Button::new(name));
            if button.on_hover_text(tip(says, command)).clicked() {
                asked.command(command);
            }
        }
    });
}

fn last_part(name: &str) -> String {
    name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned()
}

/// A rate without zeros that say nothing.
fn trimmed(text: &str) -> String {
    let rest = text.strip_suffix(" fps").unwrap_or(text);
    format!("{} fps", rest.trim_end_matches('0').trim_end_matches('.'))
}
