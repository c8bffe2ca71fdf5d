//! The lab's view: start and end with their rings, and what the methods make of the way.

use egui::{Color32, FontId, Painter as Canvas, Rect, Response, Sense, Ui, pos2, vec2};
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

/// Shows it in all the room there is.
pub(super) fn show(
    ui: &mut Ui,
    (lab, painter): (&mut InterpolationLab, &mut Painter),
    look: Look,
    asked: &mut Asked,
) {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let label = "View of the orientations: drag the rings of start and end, drag elsewhere to look from another side";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label));
    if rect.width() < 2.0 || rect.height() < 2.0 {
        return;
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
    strip::show(ui, rect, lab, asked);
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
    let canvas = ui.painter().with_clip_rect(rect);
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    match painter.texture() {
        Some(texture) if painter.shows(Place::Orientations) => {
            canvas.image(texture, rect, whole, Color32::WHITE);
        }
        _ => {
            canvas.rect_filled(rect, 0.0, Palette::in_ui(ui).sunken);
        }
    }
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
                let middle = pos2(cell.center().x, cell.bottom() - layout::CAPTION);
                caption(canvas, middle, cell.width(), (lab, kind), &palette);
            }
        }
        Picture::Overlaid => legend(canvas, rect, lab, &palette),
        Picture::Sphere => {
            legend(canvas, rect, lab, &palette);
            tips(canvas, rect, lab, &palette);
        }
    }
}

/// A method's name and its numbers now, under its body.
fn caption(
    canvas: &Canvas,
    top: egui::Pos2,
    width: f32,
    (lab, kind): (&InterpolationLab, Kind),
    palette: &Palette,
) {
    let name = FontId::proportional(13.0);
    let hue = color(hex_of(kind));
    let word = kind.name(lab.case().order());
    let galley = canvas.layout_no_wrap(word, name, palette.text);
    let dot = 8.0;
    let left = top.x - 0.5 * (galley.size().x + dot + 4.0);
    let row = top.y + 0.5 * galley.size().y;
    canvas.circle_filled(pos2(left + 0.5 * dot, row), 0.5 * dot, hue);
    canvas.galley(pos2(left + dot + 4.0, top.y), galley, palette.text);
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
    let small = FontId::proportional(11.0);
    let place = pos2(top.x, top.y + 15.0);
    let is_no_rotation = !kind.makes_rotations() && (now.blend.determinant() - 1.0).abs() > 5e-3;
    let ink = if is_no_rotation {
        palette.warning
    } else {
        palette.quiet
    };
    canvas.text(place, egui::Align2::CENTER_TOP, text, small, ink);
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
    let mut row = rect.bottom() - 10.0;
    let shown: Vec<Kind> = lab.shown().collect();
    for kind in shown.into_iter().rev() {
        let word = kind.name(lab.case().order());
        let galley = canvas.layout_no_wrap(word, font.clone(), palette.text);
        row -= galley.size().y + 1.0;
        let right = rect.right() - 12.0;
        canvas.galley(
            pos2(right - galley.size().x, row),
            galley.clone(),
            palette.text,
        );
        let dot = pos2(right - galley.size().x - 8.0, row + 0.5 * galley.size().y);
        canvas.circle_filled(dot, 4.0, color(hex_of(kind)));
    }
}
