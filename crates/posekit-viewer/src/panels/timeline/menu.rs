//! How keys go on: between them, and beyond the first and the last.

use std::collections::BTreeSet;

use egui::Ui;
use posekit::keyframe::{Extrapolation, Interpolation};

use crate::state::animate::channel::TangentKind;
use crate::state::animate::edit::keys::{extrapolated, interpolated};
use crate::state::animate::edit::mode::{RotationMode, with_mode};
use crate::state::animate::edit::tangents::with_tangents;
use crate::state::animate::{Authored, Lane, Owner};
use crate::state::session::Session;

/// The interpolations, in the order in which they are offered.
pub(super) const INTERPOLATIONS: [Interpolation; 4] = [
    Interpolation::Step,
    Interpolation::Linear,
    Interpolation::Cubic,
    Interpolation::Squad,
];

/// The extrapolations, in the order in which they are offered.
pub(super) const EXTRAPOLATIONS: [Extrapolation; 4] = [
    Extrapolation::Hold,
    Extrapolation::Cycle,
    Extrapolation::CycleWithOffset,
    Extrapolation::PingPong,
];

/// What an interpolation is called.
#[must_use]
pub(super) fn name_of(way: Interpolation) -> &'static str {
    match way {
        Interpolation::Step => "step",
        Interpolation::Linear => "linear",
        Interpolation::Squad => "squad",
        _ => "cubic",
    }
}

/// What an extrapolation is called.
#[must_use]
pub(super) fn beyond_name(beyond: Extrapolation) -> &'static str {
    match beyond {
        Extrapolation::Cycle => "cycle",
        Extrapolation::CycleWithOffset => "cycle with offset",
        Extrapolation::PingPong => "ping-pong",
        _ => "hold",
    }
}

/// A menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Menu {
    /// Of interpolations.
    Interpolation,
    /// Of tangents.
    Tangents,
    /// Of extrapolations.
    Extrapolation,
    /// Of the modes of rotations.
    Mode,
}

/// Shows a menu's lines. True when something was chosen.
pub(super) fn show(ui: &mut Ui, menu: Menu, session: &mut Session) -> bool {
    match menu {
        Menu::Interpolation => interpolation(ui, session),
        Menu::Tangents => tangents(ui, session),
        Menu::Extrapolation => extrapolation(ui, session),
        Menu::Mode => mode(ui, session),
    }
}

fn mode(ui: &mut Ui, session: &mut Session) -> bool {
    ui.set_width(190.0);
    let lanes = lanes_meant(session);
    let Some(authored) = session.authored() else {
        return false;
    };
    let modes: Vec<RotationMode> = lanes
        .iter()
        .filter(|lane| matches!(lane, Lane::Rotation(_)))
        .filter_map(|lane| RotationMode::of(authored.track(*lane)?))
        .collect();
    let title = match modes.len() {
        0 => "No keyed rotation is meant".to_owned(),
        1 => "1 rotation is keyed as".to_owned(),
        count => format!("{count} rotations are keyed as"),
    };
    ui.label(egui::RichText::new(title).small().weak());
    for mode in RotationMode::all() {
        let says = match mode {
            RotationMode::Quaternion => {
                "The short way from key to key: no gimbal lock, no turn over 180\u{b0}"
            }
            RotationMode::Euler(_) => {
                "Three curves of angles, that turn as far and as often as they say"
            }
        };
        let is_now = !modes.is_empty() && modes.iter().all(|now| *now == mode);
        let button = egui::Button::selectable(is_now, mode.name());
        let button = ui.add_enabled(!modes.is_empty(), button);
        if button.on_hover_text(says).clicked() {
            set_mode(session, mode);
            return true;
        }
    }
    false
}

/// The rotations that are meant, keyed in another mode.
pub(super) fn set_mode(session: &mut Session, mode: RotationMode) {
    let lanes = lanes_meant(session);
    let changed = session.author(|authored| {
        let changed = with_mode(authored, lanes, mode)?;
        let name = format!("Key rotations as {}", mode.name());
        let edit = changed.edit;
        authored.set_tracks(&name, None, edit.changes, edit.selection);
        Some(changed.says)
    });
    if let Some(says) = changed.flatten() {
        session.tell(says);
    }
}

fn interpolation(ui: &mut Ui, session: &mut Session) -> bool {
    ui.set_width(170.0);
    let count = session
        .authored()
        .map_or(0, |authored| authored.selection().len());
    let title = match count {
        0 => "New keys go on".to_owned(),
        count => format!("{} and new ones go on", super::counted(count)),
    };
    ui.label(egui::RichText::new(title).small().weak());
    let now = session.animate().interpolation;
    for way in INTERPOLATIONS {
        let says = match way {
            Interpolation::Step => "Keep the value and jump at the next key",
            Interpolation::Linear => "Straight on at an even pace; slerp for quaternions",
            Interpolation::Squad => "A smooth curve through the keys, without tangents",
            _ => "A smooth curve with tangents",
        };
        let chosen = ui
            .selectable_label(now == way, name_of(way))
            .on_hover_text(says);
        if chosen.clicked() {
            set_interpolation(session, way);
            return true;
        }
    }
    false
}

/// The selected keys, and keys to come, go on in another way.
pub(super) fn set_interpolation(session: &mut Session, way: Interpolation) {
    let mut settings = session.animate();
    settings.interpolation = way;
    session.set_animate(settings);
    session.author(|authored| {
        let keys = authored.selection().clone();
        let edit = interpolated(authored, &keys, way).filter(|edit| !edit.is_empty());
        if let Some(edit) = edit {
            let name = format!("Make {} {}", super::counted(keys.len()), name_of(way));
            authored.set_tracks(&name, None, edit.changes, edit.selection);
        }
    });
}

fn tangents(ui: &mut Ui, session: &mut Session) -> bool {
    ui.set_width(170.0);
    let count = session
        .authored()
        .map_or(0, |authored| authored.selection().len());
    let title = match count {
        0 => "No key is selected".to_owned(),
        count => format!("Tangents of {}", super::counted(count)),
    };
    ui.label(egui::RichText::new(title).small().weak());
    for kind in TangentKind::ALL {
        let button = egui::Button::selectable(false, kind.name());
        let button = ui.add_enabled(count > 0, button);
        if button.on_hover_text(tangents_say(kind)).clicked() {
            set_tangents(session, kind);
            return true;
        }
    }
    false
}

/// What a kind of tangents is, for people.
pub(super) fn tangents_say(kind: TangentKind) -> &'static str {
    match kind {
        TangentKind::Auto => "Smooth, and never beyond the values of the keys",
        TangentKind::Smooth => "Smooth, whatever the values in between come to",
        TangentKind::Flat => "Level at the key",
        TangentKind::Aligned => "Set by hand, both handles in one line",
        TangentKind::Broken => "Set by hand, each handle by itself",
    }
}

/// Chooses the tangents of the selected keys.
pub(super) fn set_tangents(session: &mut Session, kind: TangentKind) {
    session.author(|authored| {
        let keys = authored.selection().clone();
        if let Some(edit) = with_tangents(authored, &keys, kind).filter(|edit| !edit.is_empty()) {
            let name = format!("Make tangents {}", kind.name());
            authored.set_tracks(&name, None, edit.changes, edit.selection);
        }
    });
}

fn extrapolation(ui: &mut Ui, session: &mut Session) -> bool {
    ui.set_width(250.0);
    let lanes = lanes_meant(session);
    let title = match lanes.len() {
        1 => "1 track, beyond its keys".to_owned(),
        count => format!("{count} tracks, beyond their keys"),
    };
    ui.label(egui::RichText::new(title).small().weak());
    let mut chosen = None;
    egui::Grid::new("beyond").num_columns(4).show(ui, |ui| {
        for beyond in EXTRAPOLATIONS {
            ui.label(beyond_name(beyond));
            for (name, ends) in [
                ("both", [Some(beyond); 2]),
                ("before", [Some(beyond), None]),
                ("after", [None, Some(beyond)]),
            ] {
                let button = ui.button(name);
                let label = format!("{} {name}", beyond_name(beyond));
                button.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::Button, true, label.clone())
                });
                if button.clicked() {
                    chosen = Some((beyond, ends));
                }
            }
            ui.end_row();
        }
    });
    if let Some((beyond, ends)) = chosen {
        let name = format!("Go on beyond the keys: {}", beyond_name(beyond));
        session.author(|authored| {
            let edit = extrapolated(authored, &lanes, ends);
            authored.set_tracks(&name, None, edit.changes, edit.selection);
        });
    }
    chosen.is_some()
}

/// The lanes that something about whole tracks is for: those of the selected keys, else those of the
/// selected joints, else all that are keyed.
fn lanes_meant(session: &Session) -> BTreeSet<Lane> {
    let Some(authored) = session.authored() else {
        return BTreeSet::new();
    };
    let of_keys: BTreeSet<Lane> = authored.selection().iter().map(|key| key.lane).collect();
    if !of_keys.is_empty() {
        return of_keys;
    }
    let keyed = |lane: &Lane| authored.track(*lane).is_some();
    let joints = session.selection().iter().copied().map(Owner::Joint);
    let of_joints: BTreeSet<Lane> = joints.flat_map(Owner::lanes).filter(keyed).collect();
    if !of_joints.is_empty() {
        return of_joints;
    }
    Authored::lanes(authored)
        .into_iter()
        .filter(keyed)
        .collect()
}
