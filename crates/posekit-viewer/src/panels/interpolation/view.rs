//! The lab's view: start and end with their rings, and what the methods make of the way.

use std::sync::Arc;

use egui::text::{LayoutJob, TextWrapping};
use egui::{Color32, FontId, Galley, Painter as Canvas, Rect, Response, Sense, Ui, pos2, vec2};
use posekit::inbetween::Method;

use super::super::Asked;
use super::super::view::pixels_of;
use super::{color, strip};
use crate::gizmo::{self, Handle, Snap, Viewport};
use crate::picture::painter::{Painter, Place, Subject};
use crate::state::display::Look;
use crate::state::interpolation::colors::hex_of;
use crate::state::interpolation::{InterpolationLab, Kind, Layout, Picture, layout};
use crate::state::readout::fixed;
use crate::theme::Palette;

/// Less room than this beside an end, points, has no place for rings.
const RINGS_ROOM: f32 = 130.0;

/// Shows it in all the room there is. Where the room under the tools begins.
pub(super) fn show(
    ui: &mut Ui,
    (lab, painter): (&mut InterpolationLab, &mut Painter),
    look: Look,
    asked: &mut Asked,
) -> f32 {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let label = "View of the orientations: drag the rings of start and end, drag elsewhere to look from another side";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label));
    if rect.width() < 2.0 || rect.height() < 2.0 {
        return rect.top();
    }
    lab.set_view_size(rect.size());
    let (hovered, is_held) = interact(ui, &response, lab);
    if !is_held {
        turn_camera(ui, &response, lab);
    }
    draw(ui, rect, lab, painter, look);
    let canvas = ui.painter().with_clip_rect(rect);
    captions(ui, &canvas, rect, lab);
    rings(ui, &canvas, rect, (lab, hovered));
    let bottom = strip::show(ui, rect, lab, asked);
    // In how many lines the tools are is known once they were shown.
    lab.set_tools_height(bottom - rect.top());
    bottom
}

/// Everything is always in the picture: a drag turns it, and there is nothing to move or to come nearer to.
fn turn_camera(ui: &Ui, response: &Response, lab: &mut InterpolationLab) {
    let drag = response.drag_delta() / response.rect.height();
    if response.dragged() && drag != egui::Vec2::ZERO {
        lab.camera.turn(drag.x, drag.y);
        ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
    }
}

fn draw(ui: &Ui, rect: Rect, lab: &InterpolationLab, painter: &mut Painter, look: Look) {
    let subject = Subject {
        place: Place::Orientations,
        version: (lab.version() << 1) | u64::from(look == Look::Dark),
        time_secs: lab.playback.share(),
        camera: lab.view_camera(),
        moves: lab.playback.is_playing(),
        scene: &|| lab.scene(look),
        poses: &Vec::new,
    };
    painter.update_with(ui.ctx(), &subject, pixels_of(ui, rect));
    painter.draw(ui, rect, Place::Orientations);
}

/// Lets the pointer have its way with the rings: what is under it, and whether one is held.
fn interact(
    ui: &Ui,
    response: &Response,
    lab: &mut InterpolationLab,
) -> (Option<(usize, Handle)>, bool) {
    let viewport = Viewport::new(lab.view_camera(), response.rect);
    if lab.is_dragging() {
        drag(ui, lab, &viewport);
        return (None, true);
    }
    if !has_rings(&lab.layout()) {
        return (None, false);
    }
    let shapes = [0, 1].map(|end| gizmo::shapes(&lab.gizmo(end), &viewport));
    let pick = |place| {
        let picked = shapes.iter().enumerate();
        let mut picked =
            picked.filter_map(|(end, shapes)| Some((end, gizmo::pick(shapes, place)?)));
        picked.next()
    };
    let pressed = ui.input(|i| i.pointer.primary_pressed() && !i.modifiers.shift);
    if pressed && response.is_pointer_button_down_on() {
        let place = ui.input(|i| i.pointer.press_origin());
        let taken = place.and_then(|place| pick(place).map(|taken| (taken, place)));
        if let Some(((end, handle), place)) = taken
            && lab.grab(end, handle, place, &viewport)
        {
            drag(ui, lab, &viewport);
            return (None, true);
        }
    }
    let free = response.hovered() && !response.dragged();
    let pointer = ui.input(|i| i.pointer.hover_pos()).filter(|_| free);
    let hovered = pointer.and_then(pick);
    if hovered.is_some() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    }
    (hovered, false)
}

fn drag(ui: &Ui, lab: &mut InterpolationLab, viewport: &Viewport) {
    let turned_over = ui.input(|i| i.modifiers.ctrl || i.modifiers.command);
    let snap: Option<Snap> = (lab.snaps() != turned_over).then(|| lab.snap());
    let (place, is_down, fingers) = ui.input(|i| {
        let is_down = i.pointer.primary_down();
        (i.pointer.latest_pos(), is_down, i.multi_touch().is_some())
    });
    if fingers {
        lab.cancel_drag();
        return;
    }
    if let Some(place) = place {
        lab.drag_to(place, viewport, snap);
    }
    if !is_down {
        lab.drop_handle();
    }
    ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
}

fn has_rings(layout: &Layout) -> bool {
    let end = layout.ends[0];
    end.width().min(end.height()) >= RINGS_ROOM
}

fn rings(
    ui: &Ui,
    canvas: &Canvas,
    rect: Rect,
    (lab, hovered): (&InterpolationLab, Option<(usize, Handle)>),
) {
    if !has_rings(&lab.layout()) {
        return;
    }
    let viewport = Viewport::new(lab.view_camera(), rect);
    let palette = Palette::in_ui(ui);
    for end in [0, 1] {
        let hovered = hovered
            .filter(|(over, _)| *over == end)
            .map(|(_, handle)| handle);
        let held = lab
            .drag()
            .filter(|(held, _)| *held == end)
            .map(|(_, drag)| drag);
        gizmo::draw(
            canvas,
            &lab.gizmo(end),
            &viewport,
            (hovered, held),
            &palette,
        );
    }
}

fn captions(ui: &Ui, canvas: &Canvas, rect: Rect, lab: &InterpolationLab) {
    let palette = Palette::in_ui(ui);
    let layout = lab.layout();
    for (end, name) in layout.ends.iter().zip(["Start", "End"]) {
        let place = rect.min + end.left_top().to_vec2() + vec2(2.0, 4.0);
        let font = FontId::proportional(14.0);
        canvas.text(place, egui::Align2::LEFT_TOP, name, font, palette.text);
    }
    match lab.picture() {
        Picture::SideBySide => {
            for (kind, cell) in lab.shown().zip(&layout.cells) {
                let cell = cell.translate(rect.min.to_vec2());
                // Where a cell is hardly higher than its caption the list at the side has the names.
                if cell.height() < layout::CAPTION {
                    continue;
                }
                let middle = pos2(cell.center().x, cell.bottom() - layout::CAPTION);
                caption(canvas, middle, cell.width(), (lab, kind), &palette);
            }
        }
        Picture::Overlaid => legend(canvas, rect, lab, &palette),
        Picture::Sphere => {
            tips(canvas, rect, lab, &palette);
            legend(canvas, rect, lab, &palette);
        }
    }
}

/// In less room than this a name would be a letter or two: the colour alone says which it is, as in the list.
const NAME_ROOM: f32 = 46.0;

/// A text that ends in an ellipsis where its room ends.
fn within(canvas: &Canvas, text: String, font: FontId, ink: Color32, room: f32) -> Arc<Galley> {
    let mut job = LayoutJob::simple_singleline(text, font, ink);
    job.wrap = TextWrapping::truncate_at_width(room.max(1.0));
    canvas.layout_job(job)
}

/// A method's name and its numbers now, under its body, in the width of its cell.
fn caption(
    canvas: &Canvas,
    top: egui::Pos2,
    width: f32,
    (lab, kind): (&InterpolationLab, Kind),
    palette: &Palette,
) {
    const DOT: f32 = 8.0;
    const AFTER_DOT: f32 = 4.0;
    let font = FontId::proportional(13.0);
    let hue = color(hex_of(kind));
    let word = kind.name(lab.case().order());
    let room = width - 2.0 * AFTER_DOT;
    if room < NAME_ROOM {
        canvas.circle_filled(pos2(top.x, top.y + DOT), 0.5 * DOT, hue);
        return;
    }
    let name = within(canvas, word, font, palette.text, room - DOT - AFTER_DOT);
    let left = top.x - 0.5 * (name.size().x + DOT + AFTER_DOT);
    let row = top.y + 0.5 * name.size().y;
    canvas.circle_filled(pos2(left + 0.5 * DOT, row), 0.5 * DOT, hue);
    canvas.galley(pos2(left + DOT + AFTER_DOT, top.y), name, palette.text);
    let now = lab.now(kind);
    let text = if kind.makes_rotations() {
        if kind == Kind::Between(Method::Slerp) {
            return;
        }
        let off = fixed(now.deviation_deg, 1);
        if width > 84.0 {
            format!("{off}\u{b0} from slerp")
        } else {
            format!("{off}\u{b0}")
        }
    } else {
        let det = fixed(now.blend.determinant(), 2);
        let shear = now.blend.shear_deg();
        if width > 110.0 && shear.is_finite() {
            format!("det {det}, shear {}\u{b0}", fixed(shear, 0))
        } else {
            format!("det {det}")
        }
    };
    let is_no_rotation = !kind.makes_rotations() && (now.blend.determinant() - 1.0).abs() > 5e-3;
    let ink = if is_no_rotation {
        palette.warning
    } else {
        palette.quiet
    };
    let small = FontId::proportional(11.0);
    let numbers = within(canvas, text, small, ink, room);
    let place = pos2(top.x - 0.5 * numbers.size().x, top.y + 15.0);
    canvas.galley(place, numbers, ink);
}

/// The names of the start's and the end's tip on the sphere.
fn tips(canvas: &Canvas, rect: Rect, lab: &InterpolationLab, palette: &Palette) {
    let viewport = Viewport::new(lab.view_camera(), rect);
    for (end, name) in ["start", "end"].into_iter().enumerate() {
        let Some(place) = viewport.project(lab.tip_on_sphere(end)) else {
            continue;
        };
        let font = FontId::proportional(12.0);
        let galley = canvas.layout_no_wrap(name.to_owned(), font, palette.text);
        let at = place + vec2(-0.5 * galley.size().x, 8.0);
        let plate = Rect::from_min_size(at, galley.size()).expand2(vec2(4.0, 1.0));
        canvas.rect_filled(plate, 4.0, palette.raised.gamma_multiply(0.8));
        canvas.galley(at, galley, palette.text);
    }
}

/// The names of the methods in their colours, where all are in one place.
fn legend(canvas: &Canvas, rect: Rect, lab: &InterpolationLab, palette: &Palette) {
    let font = FontId::proportional(12.0);
    let names: Vec<(Kind, Arc<Galley>)> = lab
        .shown()
        .map(|kind| {
            let word = kind.name(lab.case().order());
            (
                kind,
                canvas.layout_no_wrap(word, font.clone(), palette.text),
            )
        })
        .collect();
    let size = names.iter().fold(vec2(0.0, 0.0), |size, (_, name)| {
        vec2(size.x.max(name.size().x), size.y + name.size().y + 1.0)
    });
    // What goes about in the view goes under it.
    let corner = rect.right_bottom() - vec2(12.0, 10.0);
    let plate = Rect::from_min_max(corner - size - vec2(16.0, 0.0), corner).expand(4.0);
    canvas.rect_filled(plate, 4.0, palette.raised.gamma_multiply(0.8));
    let mut row = corner.y;
    for (kind, name) in names.into_iter().rev() {
        row -= name.size().y + 1.0;
        let at = pos2(corner.x - name.size().x, row);
        let dot = at + vec2(-8.0, 0.5 * name.size().y);
        canvas.galley(at, name, palette.text);
        canvas.circle_filled(dot, 4.0, color(hex_of(kind)));
    }
}
