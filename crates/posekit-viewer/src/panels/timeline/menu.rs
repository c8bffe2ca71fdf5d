//! How keys go on: between them, and beyond the first and the last.

use std::collections::BTreeSet;

use egui::Ui;
use posekit::keyframe::{Extrapolation, Interpolation};

use crate::state::animate::edit::keys::{extrapolated, interpolated};
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
    /// Of extrapolations.
    Extrapolation,
}

/// Shows a menu's lines. True when something was chosen.
pub(super) fn show(ui: &mut Ui, menu: Menu, session: &mut Session) -> bool {
    match menu {
        Menu::Interpolation => interpolation(ui, session),
        Menu::Extrapolation => extrapolation(ui, session),
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
            Interpolation::Linear => "Straight on at an even pace; slerp for rotations",
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
