//! The bar over the keys: which view, how poses are keyed, and what is done to the selected keys.

use egui::containers::menu::MenuButton;
use egui::{Align, Button, Layout, RichText, Slider, Ui};
use posekit::skeleton::JointId;

use super::super::{Asked, row, tip};
use super::menu::{Menu, name_of};
use super::{Tab, Timeline, menu};
use crate::command::{Command, KeysCommand};
use crate::state::animate::Authored;
use crate::state::animate::edit::pose::breakdown;
use crate::state::edit::Gesture;
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// The bar is one line where there is this much room, two where there is that much, and three otherwise.
const ONE_LINE: f32 = 860.0;
const TWO_LINES: f32 = 520.0;

/// In less height than this several lines would leave nothing for keys.
const LOW: f32 = 200.0;

/// How far beyond its neighbours a pose can be slid, percent.
const OVERSHOOT: std::ops::RangeInclusive<f64> = -50.0..=150.0;

/// What the bar remembers: the slide that is going on.
#[derive(Debug, Default)]
pub(super) struct Bar {
    slide: Option<(Gesture, f64)>,
}

/// Shows the bar.
pub(super) fn show(ui: &mut Ui, session: &mut Session, timeline: &mut Timeline, asked: &mut Asked) {
    let room = ui.available_width();
    let line = |ui: &mut Ui, contents: &mut dyn FnMut(&mut Ui)| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            contents(ui);
        });
    };
    if room < ONE_LINE && ui.available_height() < LOW {
        // Keys have the room; the bar is one line that is scrolled.
        egui::ScrollArea::horizontal()
            .id_salt("bar")
            .show(ui, |ui| {
                line(ui, &mut |ui| {
                    tabs(ui, timeline);
                    keying(ui, session, asked);
                    switches(ui, session, asked);
                    ways(ui, session, asked);
                    slide(ui, session, &mut timeline.bar);
                });
            });
    } else if room >= ONE_LINE {
        line(ui, &mut |ui| {
            tabs(ui, timeline);
            ui.add_space(2.0 * GAP);
            keying(ui, session, asked);
            switches(ui, session, asked);
            ui.add_space(2.0 * GAP);
            slide(ui, session, &mut timeline.bar);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ways(ui, session, asked);
            });
        });
    } else if room >= TWO_LINES {
        line(ui, &mut |ui| {
            tabs(ui, timeline);
            ui.add_space(2.0 * GAP);
            keying(ui, session, asked);
            switches(ui, session, asked);
        });
        line(ui, &mut |ui| {
            slide(ui, session, &mut timeline.bar);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ways(ui, session, asked);
            });
        });
    } else {
        line(ui, &mut |ui| {
            tabs(ui, timeline);
            switches(ui, session, asked);
        });
        line(ui, &mut |ui| {
            keying(ui, session, asked);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ways(ui, session, asked);
            });
        });
        line(ui, &mut |ui| slide(ui, session, &mut timeline.bar));
    }
    ui.add_space(GAP);
}

fn tabs(ui: &mut Ui, timeline: &mut Timeline) {
    for tab in Tab::ALL {
        if row::segment(ui, tab.name(), timeline.tab == tab).clicked() {
            timeline.tab = tab;
        }
    }
}

fn keying(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let accent = Palette::in_ui(ui).accent;
    let name = RichText::new("Key");
    let name = if session.has_pending_pose() {
        name.color(accent).strong()
    } else {
        name
    };
    for (name, says, command) in [
        (
            name,
            "Key the selected joints, and those that were posed",
            Command::InsertKeys,
        ),
        (
            RichText::new("Key all"),
            "Key the whole pose",
            Command::KeyWholePose,
        ),
    ] {
        let button = ui.add(Button::new(name));
        if button.on_hover_text(tip(says, command)).clicked() {
            asked.command(command);
        }
    }
}

/// What a changed pose becomes, and how it is changed.
fn switches(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let settings = session.animate();
    for (name, says, on, command) in [
        (
            "Auto-key",
            "A changed pose becomes keys at once",
            settings.auto_key,
            Command::ToggleAutoKey,
        ),
        (
            "Use IK",
            "Drag hands and feet to targets; otherwise joints are turned by rings",
            settings.uses_ik,
            Command::ToggleUseIk,
        ),
    ] {
        let button = Button::selectable(on, name);
        if ui.add(button).on_hover_text(tip(says, command)).clicked() {
            asked.command(command);
        }
    }
}

/// The in-between: a pose so far along between its neighbouring keys. All of a drag is one step.
fn slide(ui: &mut Ui, session: &mut Session, bar: &mut Bar) {
    let mut percent = bar.slide.map_or(50.0, |(_, percent)| percent);
    ui.label(RichText::new("In-between").color(Palette::in_ui(ui).quiet));
    ui.spacing_mut().slider_width = 96.0;
    let slider = Slider::new(&mut percent, OVERSHOOT)
        .suffix(" %")
        .fixed_decimals(0)
        .clamping(egui::SliderClamping::Always);
    let response = ui.add(slider).on_hover_text(
        "Keys at the playhead, so far along between the keys before and after it: of the selected \
         joints, or of all",
    );
    if response.changed() {
        // A field that is typed in is a gesture of its own.
        let gesture = match bar.slide {
            Some((gesture, _)) => Some(gesture),
            None => session.author(Authored::gesture),
        };
        if let Some(gesture) = gesture {
            session.transport.pause();
            put_between(session, gesture, percent / 100.0);
            bar.slide = Some((gesture, percent));
        }
    }
    if !response.dragged() && !response.has_focus() {
        bar.slide = None;
    }
}

fn put_between(session: &mut Session, gesture: Gesture, share: f64) {
    let mut joints: Vec<JointId> = session.selection().to_vec();
    let interpolation = session.animate().interpolation;
    session.author(|authored| {
        authored.give_up(gesture);
        if joints.is_empty() {
            joints = authored.skeleton().joints().collect();
        }
        let at = authored.snapped(authored.now_secs());
        let edit = breakdown(authored, &joints, at, share, interpolation);
        if let Some(edit) = edit.filter(|edit| !edit.is_empty()) {
            authored.set_tracks(
                "Key an in-between",
                Some(gesture),
                edit.changes,
                edit.selection,
            );
        }
    });
}

/// How keys go on, and what else is done to them.
fn ways(ui: &mut Ui, session: &mut Session, asked: &mut Asked) {
    let keys = |command| Command::Keys(command);
    for (name, menu, says, command) in [
        (
            "Beyond".to_owned(),
            Menu::Extrapolation,
            "What happens before the first and after the last key",
            KeysCommand::Extrapolation,
        ),
        (
            format!("Curve: {}", name_of(session.animate().interpolation)),
            Menu::Interpolation,
            "How keys go on to the next one",
            KeysCommand::Interpolation,
        ),
    ] {
        let (response, _) = MenuButton::new(name).ui(ui, |ui| {
            if menu::show(ui, menu, session) {
                ui.close();
            }
        });
        response.on_hover_text(tip(says, keys(command)));
    }
    let count = session
        .authored()
        .map_or(0, |authored| authored.selection().len());
    let name = match count {
        0 => "Keys".to_owned(),
        count => super::counted(count),
    };
    let (response, _) = MenuButton::new(name).ui(ui, |ui| {
        ui.set_width(210.0);
        ui.menu_button("Rotation mode", |ui| {
            if menu::show(ui, Menu::Mode, session) {
                ui.close();
            }
        });
        for (says, command, needs_some) in [
            ("Copy", KeysCommand::Copy, true),
            ("Paste at the playhead", KeysCommand::Paste, false),
            ("Paste left for right", KeysCommand::PasteMirrored, false),
            ("Mirror left and right", KeysCommand::Mirror, true),
            ("Duplicate", KeysCommand::Duplicate, true),
            ("Delete", KeysCommand::Delete, true),
            ("Select all", KeysCommand::SelectAll, false),
            ("All keys into view", KeysCommand::ViewAll, false),
        ] {
            let command = keys(command);
            let shortcut = crate::command::shortcut_of(command, cfg!(target_os = "macos"));
            let quiet = Palette::in_ui(ui).quiet;
            let shortcut = RichText::new(shortcut.unwrap_or_default())
                .small()
                .color(quiet);
            let button = Button::new(says)
                .frame_when_inactive(false)
                .shortcut_text(shortcut);
            if ui.add_enabled(count > 0 || !needs_some, button).clicked() {
                asked.command(command);
                ui.close();
            }
        }
    });
    response.on_hover_text("What can be done to the selected keys");
}
