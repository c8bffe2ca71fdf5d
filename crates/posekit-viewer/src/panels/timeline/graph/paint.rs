//! Drawing the graph: grid, curves, dots, handles, the time shown, what is under the pointer.

use egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Response, Shape, Stroke, StrokeKind, Ui, pos2,
    vec2,
};

use super::GraphPanel;
use super::plane::{Plane, number_text, round_step};
use super::pointer::{Lock, Task, curve_at, dot_at, handle_at, handles};
use crate::panels::timeline::axis::paint_ground;
use crate::state::animate::Lane;
use crate::state::animate::channel::{Channels, Sampled};
use crate::state::animate::graph::{ChannelId, HoldKind};
use crate::state::session::Session;
use crate::theme::{CURVES, Palette};

/// Radius of a key's dot.
const DOT: f32 = 4.0;

/// Radius of a handle's.
const HANDLE: f32 = 3.0;

/// Of what is not selected while something else is.
const FAINT: f32 = 0.4;

/// The unit of a lane's values.
pub(super) const fn unit_of(lane: Lane) -> &'static str {
    match lane {
        Lane::Rotation(_) | Lane::PropRotation(_) | Lane::CameraFov(_) => "\u{b0}",
        _ => "",
    }
}

/// The name of a channel.
pub(super) fn channel_name(lane: Lane, curves: &Channels, channel: usize) -> &'static str {
    const AXES: [&str; 3] = ["X", "Y", "Z"];
    const COLOURS: [&str; 3] = ["Red", "Green", "Blue"];
    match (lane, curves.axis(channel)) {
        (Lane::LightColor(_), _) => COLOURS[channel],
        (_, Some(axis)) => AXES[axis.index()],
        (_, None) => "",
    }
}

/// The colour of a channel: its axis's.
pub(super) fn channel_color(curves: &Channels, channel: usize) -> Color32 {
    CURVES[curves.axis(channel).map_or(3, |axis| axis.index())]
}

/// What is said where there is nothing to be seen.
pub(super) fn empty(ui: &Ui, rect: Rect) {
    let palette = Palette::in_ui(ui);
    ui.painter().rect_filled(rect, 4.0, palette.sunken);
    ui.painter().text(
        rect.center(),
        Align2::CENTER_CENTER,
        "Select what is keyed, or keys in the dope sheet, to see its curves",
        FontId::proportional(13.0),
        palette.quiet,
    );
}

/// Draws everything.
pub(super) fn show(
    ui: &Ui,
    response: &Response,
    session: &Session,
    panel: &mut GraphPanel,
    plane: &Plane,
) {
    let palette = Palette::in_ui(ui);
    let canvas = ui.painter().with_clip_rect(plane.rect);
    canvas.rect_filled(plane.rect, 0.0, palette.panel);
    paint_ground(ui, &plane.axis, session);
    grid(ui, &canvas, panel, plane, &palette);
    let lanes: Vec<Lane> = panel.graph.curves().keys().copied().collect();
    let selected = panel.graph.selected();
    for lane in lanes {
        let Some(curves) = panel.graph.curves().get(&lane).cloned() else {
            continue;
        };
        let sampled = panel.sampled(lane, &curves, plane);
        let is_faint = !selected.is_empty() && selected.iter().all(|dot| dot.lane != lane);
        for channel in panel.graph.seen_channels(lane) {
            let color = channel_color(&curves, channel);
            let color = if is_faint {
                color.gamma_multiply(FAINT)
            } else {
                color
            };
            curve(&canvas, plane, &sampled, channel, color);
        }
    }
    dots(&canvas, panel, plane, &palette);
    boxes(ui, &canvas, panel, plane, &palette);
    readout(ui, response, &canvas, session, panel, plane);
}

/// Lines of round values, with what they are.
fn grid(ui: &Ui, canvas: &Painter, panel: &GraphPanel, plane: &Plane, palette: &Palette) {
    let rect = plane.rect;
    let ticks = plane.value_ticks();
    let step = match ticks.as_slice() {
        [first, second, ..] => second - first,
        _ => round_step(plane.values.span),
    };
    let unit = common_unit(panel);
    for value in ticks {
        let y = plane.y(value);
        let is_zero = value.abs() < step * 1e-6;
        let width = if is_zero { 1.6 } else { 1.0 };
        let stroke = Stroke::new(width, palette.line);
        canvas.line_segment([pos2(rect.left(), y), pos2(rect.right(), y)], stroke);
        // Half a label above the plot would lie in the ruler.
        if y > rect.top() + 4.0 && y < rect.bottom() - 4.0 {
            ui.painter().text(
                pos2(rect.left() - 6.0, y),
                Align2::RIGHT_CENTER,
                format!("{}{unit}", number_text(value, step)),
                FontId::proportional(11.0),
                palette.quiet,
            );
        }
    }
}

/// The unit of all that is seen; none where they differ.
fn common_unit(panel: &GraphPanel) -> &'static str {
    let mut units = panel.graph.seen().map(|(id, _)| unit_of(id.lane));
    let first = units.next().unwrap_or("");
    if units.all(|unit| unit == first) {
        first
    } else {
        ""
    }
}

/// A curve: solid between its keys, dashed beyond them.
fn curve(canvas: &Painter, plane: &Plane, sampled: &Sampled, channel: usize, color: Color32) {
    let points: Vec<Pos2> = sampled
        .times_secs
        .iter()
        .zip(&sampled.values)
        .map(|(&secs, values)| plane.pos([secs, values[channel]]))
        .collect();
    let within = sampled.within.clone();
    let dashed = Stroke::new(1.2, color.gamma_multiply(0.75));
    // The parts meet at the first and the last key.
    let before = &points[..(within.start + 1).min(points.len())];
    let after = &points[within.end.saturating_sub(1)..];
    for part in [before, after] {
        if part.len() > 1 {
            canvas.extend(Shape::dashed_line(part, dashed, 5.0, 4.0));
        }
    }
    let solid = &points[within];
    if solid.len() > 1 {
        canvas.add(Shape::line(solid.to_vec(), Stroke::new(1.7, color)));
    }
}

fn dots(canvas: &Painter, panel: &GraphPanel, plane: &Plane, palette: &Palette) {
    let graph = &panel.graph;
    let color_of = |id: ChannelId| {
        let curves = graph.curves().get(&id.lane);
        curves.map_or(palette.text, |curves| channel_color(curves, id.channel))
    };
    for handle in handles(graph) {
        let (Some(from), Some(to)) = (graph.place(handle.at), graph.handle_place(handle)) else {
            continue;
        };
        let color = color_of(handle.at.channel());
        let (from, to) = (plane.pos(from), plane.pos(to));
        canvas.line_segment([from, to], Stroke::new(1.2, color.gamma_multiply(0.8)));
        let held = panel.graph.held().map(|held| held.kind());
        let fill = if held == Some(HoldKind::Handle(handle)) {
            palette.accent
        } else {
            color
        };
        canvas.circle_filled(to, HANDLE, fill);
    }
    let on_screen = plane.rect.expand(DOT);
    for dot in graph.dots() {
        let Some(place) = graph.place(dot).map(|place| plane.pos(place)) else {
            continue;
        };
        if !on_screen.contains(place) {
            continue;
        }
        let color = color_of(dot.channel());
        if graph.is_selected(dot) {
            canvas.circle(place, DOT + 1.0, color, Stroke::new(2.0, palette.text));
        } else {
            canvas.circle(place, DOT - 0.5, palette.raised, Stroke::new(1.5, color));
        }
    }
}

/// The box that is drawn, the line that movement is locked to, the pivot of scaling.
fn boxes(ui: &Ui, canvas: &Painter, panel: &GraphPanel, plane: &Plane, palette: &Palette) {
    let Some(pointing) = panel.pointing else {
        return;
    };
    let pointer = ui.input(|i| i.pointer.latest_pos());
    if let (Task::Box, Some(pointer)) = (pointing.task, pointer) {
        let area = Rect::from_two_pos(pointing.from, pointer);
        let fill = palette.accent.gamma_multiply(0.12);
        let edge = Stroke::new(1.0, palette.accent);
        canvas.rect(area, 0.0, fill, edge, StrokeKind::Inside);
    }
    let line = Stroke::new(1.0, palette.accent.gamma_multiply(0.7));
    match pointing.lock {
        Some(Lock::Time) => {
            let y = pointing.from.y;
            canvas.line_segment(
                [pos2(plane.rect.left(), y), pos2(plane.rect.right(), y)],
                line,
            );
        }
        Some(Lock::Value) => {
            let x = pointing.from.x;
            canvas.line_segment(
                [pos2(x, plane.rect.top()), pos2(x, plane.rect.bottom())],
                line,
            );
        }
        None => {}
    }
    if let Some(HoldKind::Scale { pivot }) = panel.graph.held().map(|held| held.kind()) {
        let pivot = plane.pos(pivot);
        for arm in [vec2(6.0, 0.0), vec2(0.0, 6.0)] {
            canvas.line_segment([pivot - arm, pivot + arm], Stroke::new(1.5, palette.text));
        }
    }
}

/// What stands at the pointer: frame, time and value, and the curve or key that it is on.
fn readout(
    ui: &Ui,
    response: &Response,
    canvas: &Painter,
    session: &Session,
    panel: &GraphPanel,
    plane: &Plane,
) {
    let Some(authored) = session.authored() else {
        return;
    };
    let holds = panel.pointing.is_some_and(|pointing| pointing.holds());
    let Some(pointer) = response
        .hover_pos()
        .or_else(|| ui.input(|i| i.pointer.latest_pos()).filter(|_| holds))
    else {
        return;
    };
    let graph = &panel.graph;
    let is_on_something =
        handle_at(graph, plane, pointer).is_some() || dot_at(graph, plane, pointer).is_some();
    if is_on_something && !holds {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    }
    let fineness = round_step(plane.value_per_point());
    let secs = plane.secs(pointer.x);
    let frame = plane.axis.frame(secs);
    let mut text = format!(
        "frame {frame}  \u{b7}  {} s  \u{b7}  {}{}",
        number_text(secs, 0.01),
        number_text(plane.value(pointer.y), fineness),
        common_unit(panel),
    );
    if let Some(id) = curve_at(graph, plane, pointer)
        && let Some(curves) = graph.curves().get(&id.lane)
    {
        let lane = id.lane.label(authored.scene(), authored.skeleton());
        let name = channel_name(id.lane, curves, id.channel);
        let value = number_text(curves.at(secs)[id.channel], 0.01);
        text = format!("{lane} {name}  {value}{}   {text}", unit_of(id.lane));
    }
    let palette = Palette::in_ui(ui);
    let galley = canvas.layout_no_wrap(text, FontId::proportional(11.5), palette.text);
    let corner = plane.rect.right_top() + vec2(-8.0, 6.0);
    let place = Align2::RIGHT_TOP.anchor_size(corner, galley.size());
    canvas.rect_filled(
        place.expand2(vec2(5.0, 2.0)),
        4.0,
        palette.raised.gamma_multiply(0.9),
    );
    canvas.galley(place.min, galley, palette.text);
}
