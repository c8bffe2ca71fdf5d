//! The inspector: the selected joint's numbers, and the findings.

use std::sync::Arc;

use egui::{RichText, ScrollArea, Ui, vec2};
use posekit::check::{Finding, Severity};

use super::transport::severity_color;
use super::{Asked, Request, edit, ik, reading, row, scene, things, tip};
use crate::command::Command;
use crate::icons::{self, Icon, icon_button};
use crate::state::clip::Clip;
use crate::state::mode::Mode;
use crate::state::readout::{Readout, RotationReadout, fixed, readout_of, readout_of_pose};
use crate::state::session::{Handles, Session};
use crate::theme::{CURVES, GAP, Palette};

/// Whether the checks are still at work on the active clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checking {
    /// They are.
    Running,
    /// They are done.
    Done,
}

/// Shows the inspector.
pub fn show(ui: &mut Ui, session: &mut Session, checking: Checking, asked: &mut Asked) {
    let Some(clip) = session.active_clip().map(Arc::clone) else {
        row::heading(ui, "Inspector", |_| {});
        row::empty_note(ui, "Open a clip to see its numbers.");
        return;
    };
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(GAP, GAP);
            if session.handles() == Handles::Targets {
                ik::show(ui, session, asked);
                row::divider(ui);
            }
            if session.shows_things() {
                things::show(ui, session);
                row::divider(ui);
            }
            if session.authored().is_some() {
                scene::show(ui, session, asked);
                row::divider(ui);
            } else if matches!(session.mode(), Mode::Pose | Mode::Ik) {
                edit::show(ui, session, asked);
                row::divider(ui);
            }
            joint(ui, session, &clip, asked);
            row::divider(ui);
            findings(ui, &clip, checking, asked);
            if !clip.report.is_empty() {
                row::divider(ui);
                report(ui, &clip);
            }
            reading::show(ui, session, &clip);
        });
}

fn joint(ui: &mut Ui, session: &Session, clip: &Clip, asked: &mut Asked) {
    let Some(joint) = session
        .selected()
        .filter(|j| j.index() < clip.skeleton().joint_count())
    else {
        row::heading(ui, "Joint", |_| {});
        row::empty_note(
            ui,
            "Click a bone, or a name in the tree, to see where the joint is and how it turns.",
        );
        return;
    };
    let skeleton = clip.skeleton();
    row::heading(ui, skeleton.unique_name(joint), |ui| {
        if icon_button(ui, Icon::Frame, &tip("Frame it", Command::FrameSelected)).clicked() {
            asked.command(Command::FrameSelected);
        }
    });
    let palette = Palette::in_ui(ui);
    let parent = skeleton
        .parent(joint)
        .map(|parent| skeleton.unique_name(parent));
    let place = match parent {
        Some(parent) => format!(
            "below {parent}, {} from it",
            number(skeleton.bone_length(joint).into())
        ),
        None => "the root".to_owned(),
    };
    ui.label(RichText::new(place).small().color(palette.quiet));
    let floor = session.stage().ground_height();
    let numbers = if let Some(rest) = session.rest_pose_shown() {
        ui.label(
            RichText::new("in the rest pose")
                .small()
                .color(palette.accent),
        );
        readout_of_pose(clip, joint, &rest, floor)
    } else if let Some(pose) = session.shown_local_pose() {
        let time_secs = session.transport.time_secs();
        readout_of(clip, joint, (time_secs, &pose), floor)
    } else {
        return;
    };
    ui.add_space(GAP);
    rotation(ui, "Local rotation", &numbers, &numbers.local);
    rotation(ui, "Global rotation", &numbers, &numbers.global);
    motion(ui, &numbers);
    if !numbers.channels.is_empty() {
        channels(ui, &numbers);
    }
}

fn rotation(ui: &mut Ui, title: &str, numbers: &Readout, rotation: &RotationReadout) {
    part(ui, title);
    let letters: Vec<char> = numbers.order.chars().collect();
    let label = format!("Euler {}", numbers.order);
    let angles: Vec<(String, f64)> = letters
        .iter()
        .zip(&rotation.euler_deg)
        .map(|(letter, &angle)| (letter.to_string(), angle))
        .collect();
    values(
        ui,
        &label,
        "Degrees, in the order of the file's channels",
        &angles,
        2,
    );
    let names = ["x", "y", "z", "w"];
    let quaternion: Vec<_> = names
        .iter()
        .zip(rotation.quaternion)
        .map(|(name, value)| ((*name).to_owned(), f64::from(value)))
        .collect();
    values(ui, "Quaternion", "x, y, z, w", &quaternion, 3);
    let vector = rotation.vector_deg;
    let vector = [("x", vector.x), ("y", vector.y), ("z", vector.z)]
        .map(|(name, value)| (name.to_owned(), value));
    values(
        ui,
        "Vector",
        "Rotation vector: axis times angle, degrees",
        &vector,
        2,
    );
}

fn motion(ui: &mut Ui, numbers: &Readout) {
    part(ui, "Position and speed");
    let named = |v: glam::Vec3| {
        [("x", v.x), ("y", v.y), ("z", v.z)].map(|(name, value)| (name.to_owned(), value.into()))
    };
    values(
        ui,
        "World",
        "Position in the world, the file's unit",
        &named(numbers.position),
        3,
    );
    let local = named(numbers.translation);
    values(
        ui,
        "Local",
        "Position in the parent's space, the file's unit",
        &local,
        3,
    );
    let height = f64::from(numbers.height);
    single(
        ui,
        "Over floor",
        "Distance to the ground, the file's unit",
        Some(height),
        "",
    );
    single(
        ui,
        "Speed",
        "In the world, the file's unit a second",
        numbers.speed,
        "/s",
    );
    single(
        ui,
        "Turns",
        "In the world",
        numbers.turn_deg_per_sec,
        "\u{b0}/s",
    );
}

fn channels(ui: &mut Ui, numbers: &Readout) {
    part(ui, "Channels in the file");
    for (channel, value) in &numbers.channels {
        line(
            ui,
            channel.name(),
            "As the file has it at this frame",
            |ui| {
                ui.label(RichText::new(number(*value)).monospace());
            },
        );
    }
}

pub(super) fn part(ui: &mut Ui, title: &str) {
    ui.add_space(GAP);
    ui.label(
        RichText::new(title)
            .small()
            .strong()
            .color(Palette::in_ui(ui).quiet),
    );
}

/// A name at the left, something at the right.
pub(super) fn line(ui: &mut Ui, name: &str, says: &str, contents: impl FnOnce(&mut Ui)) {
    const NAME_WIDTH: f32 = 72.0;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0 * GAP;
        let size = vec2(NAME_WIDTH, 18.0);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
        row::text_in(ui, rect, RichText::new(name), Palette::in_ui(ui).quiet);
        response.on_hover_text(says);
        contents(ui);
    });
}

/// Named numbers beside each other: the name of each is a coloured letter.
pub(super) fn values(ui: &mut Ui, name: &str, says: &str, values: &[(String, f64)], digits: usize) {
    line(ui, name, says, |ui| {
        let count = values.len().max(1);
        let gap = if count > 3 { GAP } else { 2.0 * GAP };
        ui.spacing_mut().item_spacing.x = gap;
        let room = ui.available_width() - gap * (count as f32 - 1.0);
        let width = (room / count as f32).max(30.0);
        for (letter, value) in values {
            let size = vec2(width, 18.0);
            let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
            let text = fixed(*value, digits);
            row::text_in(
                ui,
                rect,
                RichText::new(&text)
                    .monospace()
                    .size(if count > 3 { 11.0 } else { 12.0 }),
                letter_color(letter, ui),
            );
            response.on_hover_text(format!("{letter}: {value}"));
        }
    });
}

fn letter_color(letter: &str, ui: &Ui) -> egui::Color32 {
    let palette = Palette::in_ui(ui);
    let hue = match letter {
        "x" | "X" => CURVES[0],
        "y" | "Y" => CURVES[1],
        "z" | "Z" => CURVES[2],
        _ => return palette.text,
    };
    // Enough of the text's colour to be read easily, enough of the axis to be told apart.
    palette.text.lerp_to_gamma(hue, 0.45)
}

fn single(ui: &mut Ui, name: &str, says: &str, value: Option<f64>, unit: &str) {
    line(ui, name, says, |ui| {
        let text = value.map_or("\u{2013}".to_owned(), |value| {
            format!("{}{unit}", number(value))
        });
        ui.label(RichText::new(text).monospace());
    });
}

/// A number with about five digits that matter.
#[must_use]
pub fn number(value: f64) -> String {
    let digits = match value.abs() {
        size if size >= 1000.0 => 0,
        size if size >= 100.0 => 1,
        size if size >= 10.0 => 2,
        _ => 3,
    };
    fixed(value, digits)
}

fn findings(ui: &mut Ui, clip: &Clip, checking: Checking, asked: &mut Asked) {
    let palette = Palette::in_ui(ui);
    let count = clip.findings.len();
    row::heading(ui, "Findings", |ui| {
        if checking == Checking::Done {
            ui.label(
                RichText::new(count.to_string())
                    .small()
                    .color(palette.quiet),
            );
        } else {
            ui.label(
                RichText::new("checking\u{2026}")
                    .small()
                    .color(palette.quiet),
            );
        }
    });
    if count == 0 && checking == Checking::Done {
        row::empty_note(ui, "Nothing suspicious was found.");
    }
    for (index, finding) in clip.findings.iter().enumerate() {
        if finding_row(ui, clip, finding, index).clicked() {
            asked.requests.push(Request::ShowFinding(index));
        }
    }
}

fn finding_row(ui: &mut Ui, clip: &Clip, finding: &Finding, index: usize) -> egui::Response {
    const HEIGHT: f32 = 40.0;
    let palette = Palette::in_ui(ui);
    let (rect, response) = ui
        .push_id(index, |ui| row::row(ui, HEIGHT, false, &finding.message))
        .inner;
    let color = severity_color(finding.severity, &palette);
    let dot = egui::pos2(rect.left() + 11.0, rect.top() + 13.0);
    if finding.severity == Severity::Info {
        ui.painter()
            .circle_stroke(dot, 4.0, egui::Stroke::new(1.5, color));
    } else {
        let icon = egui::Rect::from_center_size(dot, vec2(13.0, 13.0));
        icons::draw(ui.painter(), Icon::Warning, icon, color);
    }
    let text = |top: f32| {
        egui::Rect::from_min_max(
            egui::pos2(rect.left() + 24.0, rect.top() + top),
            egui::pos2(rect.right() - GAP, rect.top() + top + 18.0),
        )
    };
    row::text_in(
        ui,
        text(3.0),
        RichText::new(headline(finding)),
        palette.text,
    );
    let place = place_of(clip, finding);
    row::text_in(ui, text(20.0), RichText::new(place).small(), palette.quiet);
    let summary = finding.code.summary();
    response.on_hover_text(format!(
        "{}\n\n{summary}\n[{}]",
        finding.message, finding.code
    ))
}

/// The code as words: `foot-sliding` is "Foot sliding".
fn headline(finding: &Finding) -> String {
    let words = finding.code.code().replace('-', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

fn place_of(clip: &Clip, finding: &Finding) -> String {
    let frames = match finding.frames {
        None => "the whole clip".to_owned(),
        Some(frames) => frames.to_string(),
    };
    let names: Vec<&str> = finding
        .joints
        .iter()
        .filter(|joint| joint.index() < clip.skeleton().joint_count())
        .map(|&joint| clip.skeleton().unique_name(joint))
        .collect();
    match names.as_slice() {
        [] => frames,
        [one] => format!("{frames}  \u{b7}  {one}"),
        [first, rest @ ..] => format!("{frames}  \u{b7}  {first} and {} more", rest.len()),
    }
}

/// What the reader noticed.
fn report(ui: &mut Ui, clip: &Clip) {
    let palette = Palette::in_ui(ui);
    row::heading(ui, "Noticed while reading", |ui| {
        let count: usize = clip
            .report
            .warnings
            .iter()
            .map(|warning| warning.count)
            .sum();
        ui.label(
            RichText::new(count.to_string())
                .small()
                .color(palette.quiet),
        );
    });
    for warning in &clip.report.warnings {
        let place = match &warning.file {
            Some(file) => format!("{file}, {}", warning.place),
            None => warning.place.to_string(),
        };
        ui.label(RichText::new(place).small().color(palette.quiet));
        let times = if warning.count > 1 {
            format!(" ({} times)", warning.count)
        } else {
            String::new()
        };
        ui.add(egui::Label::new(format!("{}{times}", warning.message)).wrap());
        ui.add_space(GAP);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_about_five_digits_and_no_minus_zero() {
        assert_eq!(number(1234.56), "1235");
        assert_eq!(number(-0.000_01), "0.000");
        assert_eq!(number(-12.345), "-12.35");
        assert_eq!(fixed(-0.004, 2), "0.00");
        assert_eq!(fixed(f64::NAN, 2), "NaN");
    }
}
