//! The numbers of the selected key.

use egui::{DragValue, Response, RichText, ScrollArea, Ui};

use super::{GraphPanel, paint};
use crate::panels::row;
use crate::panels::timeline::menu::{
    INTERPOLATIONS, name_of, set_interpolation, set_tangents, tangents_say,
};
use crate::state::animate::channel::{Side, TangentKind};
use crate::state::animate::graph::{DotId, HandleId, Step};
use crate::state::edit::Gesture;
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// Shows the numbers.
pub(super) fn show(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel) {
    ScrollArea::vertical()
        .id_salt("key")
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 3.0;
            let dots: Vec<DotId> = panel.graph.selected().into_iter().collect();
            let Some(first) = dots.first() else {
                let quiet = Palette::in_ui(ui).quiet;
                ui.label(RichText::new("No key is selected").color(quiet));
                return;
            };
            if dots.iter().all(|dot| dot.key() == first.key()) {
                one_key(ui, session, panel, &dots);
            } else {
                let keys: std::collections::BTreeSet<_> =
                    dots.iter().map(|dot| dot.key()).collect();
                ui.label(format!("{} keys", keys.len()));
            }
            ways(ui, session, panel, *first);
        });
}

fn one_key(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel, dots: &[DotId]) {
    let first = dots[0];
    frame(ui, session, panel, first);
    for &dot in dots {
        value(ui, session, panel, dot);
    }
    if let [only] = dots {
        for side in Side::BOTH {
            slope(ui, session, panel, HandleId { at: *only, side });
        }
    }
}

fn frame(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel, dot: DotId) {
    let (Some([secs, value]), Some(authored)) = (panel.graph.place(dot), session.authored()) else {
        return;
    };
    let (start, frame_secs) = (authored.scene().range_secs[0], authored.frame_secs());
    let mut frame = (secs - start) / frame_secs;
    let response = row::line(ui, "Frame", |ui| {
        let field = DragValue::new(&mut frame)
            .speed(0.1)
            .max_decimals(2)
            .update_while_editing(false);
        ui.add(field).on_hover_text(format!("{secs:.4} s"))
    });
    if response.changed() {
        let gesture = gesture(session, panel, &response);
        let place = [start + frame * frame_secs, value];
        panel
            .graph
            .set_dot(session, ("Move key", gesture), dot, place);
    }
}

fn value(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel, dot: DotId) {
    let Some([secs, mut value]) = panel.graph.place(dot) else {
        return;
    };
    let Some(curves) = panel.graph.curves().get(&dot.lane) else {
        return;
    };
    let name = match paint::channel_name(dot.lane, curves, dot.dot.channel) {
        "" => "Value",
        name => name,
    };
    let unit = paint::unit_of(dot.lane);
    let speed = panel.values.map_or(0.1, |values| values.span * 0.002);
    let response = row::line(ui, name, |ui| number(ui, &mut value, unit, speed));
    if response.changed() {
        let gesture = gesture(session, panel, &response);
        let step: Step<'_> = ("Change key", gesture);
        panel.graph.set_dot(session, step, dot, [secs, value]);
    }
}

fn slope(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel, handle: HandleId) {
    if panel.graph.handle_place(handle).is_none() {
        return;
    }
    let slopes = panel
        .graph
        .curves()
        .get(&handle.at.lane)
        .and_then(|curves| curves.slopes(handle.at.dot.key));
    let Some(slopes) = slopes else {
        return;
    };
    let mut slope = slopes[handle.side.index()][handle.at.dot.channel];
    let name = match handle.side {
        Side::Incoming => "Slope in",
        Side::Outgoing => "Slope out",
    };
    let unit = format!("{}/s", paint::unit_of(handle.at.lane));
    let speed = panel.values.map_or(0.1, |values| values.span * 0.01);
    let response = row::line(ui, name, |ui| number(ui, &mut slope, &unit, speed));
    if response.changed() {
        let gesture = gesture(session, panel, &response);
        panel
            .graph
            .set_slope(session, ("Change slope", gesture), handle, slope);
    }
}

fn number(ui: &mut Ui, value: &mut f64, unit: &str, speed: f64) -> Response {
    let field = DragValue::new(value)
        .speed(speed)
        .max_decimals(3)
        .suffix(unit)
        .update_while_editing(false);
    ui.add(field)
}

/// All that happens while a number is dragged is one gesture; one that is typed is a step of its own.
fn gesture(session: &mut Session, panel: &mut GraphPanel, response: &Response) -> Option<Gesture> {
    if !response.dragged() {
        panel.field_gesture = None;
        return None;
    }
    if response.drag_started() || panel.field_gesture.is_none() {
        panel.field_gesture = session.author(|authored| authored.gesture());
    }
    panel.field_gesture
}

/// How the selected keys go on, and their tangents, as those of the first are.
fn ways(ui: &mut Ui, session: &mut Session, panel: &GraphPanel, first: DotId) {
    let Some(curves) = panel.graph.curves().get(&first.lane).cloned() else {
        return;
    };
    let key = first.dot.key;
    if key >= curves.times_secs().len() {
        return;
    }
    ui.add_space(GAP);
    let now = curves.interpolation(key);
    row::line(ui, "Curve", |ui| {
        egui::ComboBox::from_id_salt("curve")
            .width(84.0)
            .selected_text(name_of(now))
            .show_ui(ui, |ui| {
                for way in INTERPOLATIONS {
                    if ui.selectable_label(now == way, name_of(way)).clicked() {
                        set_interpolation(session, way);
                    }
                }
            });
    });
    let kind = curves.tangent_kind(key);
    row::line(ui, "Tangents", |ui| {
        egui::ComboBox::from_id_salt("tangents")
            .width(84.0)
            .selected_text(kind.name())
            .show_ui(ui, |ui| {
                for other in TangentKind::ALL {
                    let row = ui.selectable_label(kind == other, other.name());
                    if row.on_hover_text(tangents_say(other)).clicked() {
                        set_tangents(session, other);
                    }
                }
            });
    });
}
