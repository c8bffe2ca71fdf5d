//! The figures: the truth, and what methods filled in.

use egui::{FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

use super::super::super::Asked;
use super::super::super::view::{move_camera, pixels_of};
use super::super::{color, strip};
use crate::gizmo::Viewport;
use crate::picture::painter::{Painter, Place, Subject};
use crate::state::display::Look;
use crate::state::interpolation::colors::{TRUTH, hex_of_fill};
use crate::state::interpolation::{ClipLab, InterpolationLab};
use crate::theme::Palette;

/// Shows it in all the room there is. Where the room under the tools begins.
pub(in super::super) fn show(
    ui: &mut Ui,
    (lab, painter): (&mut InterpolationLab, &mut Painter),
    look: Look,
    asked: &mut Asked,
) -> f32 {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let label = "View of the clip as it was and as it was filled in: drag to turn";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label));
    if rect.width() < 2.0 || rect.height() < 2.0 {
        return rect.top();
    }
    let clip = &mut lab.clip;
    clip.set_aspect(rect.width() / rect.height());
    let size = clip.stage().stature();
    move_camera(ui, &response, &mut clip.camera, size);
    if response.double_clicked() {
        clip.reframe();
    }
    draw(ui, rect, clip, painter, look);
    marks(ui, rect, clip);
    strip::show(ui, rect, lab, asked)
}

fn draw(ui: &Ui, rect: Rect, clip: &ClipLab, painter: &mut Painter, look: Look) {
    let subject = Subject {
        place: Place::FilledClip,
        version: (clip.version() << 1) | u64::from(look == Look::Dark),
        time_secs: clip.transport.time_secs(),
        camera: clip.view_camera(),
        moves: clip.transport.is_playing(),
        scene: &|| clip.scene(),
        poses: &Vec::new,
    };
    painter.update_with(ui.ctx(), &subject, pixels_of(ui, rect));
    painter.draw(ui, rect, Place::FilledClip);
}

/// The joint that is marked, on every figure, and the figures' names.
fn marks(ui: &Ui, rect: Rect, clip: &ClipLab) {
    let canvas = ui.painter().with_clip_rect(rect);
    let palette = Palette::in_ui(ui);
    let viewport = Viewport::new(clip.view_camera(), rect);
    let time = clip.transport.time_secs();
    let stage = clip.stage();
    if let Some(joint) = clip.marked() {
        for (actor, &place) in stage.actors().iter().zip(stage.places()) {
            let pose = actor.shown_pose(time);
            let here = pose.positions.get(joint.index()).map(|&at| at + place);
            if let Some(here) = here.and_then(|here| viewport.project(here)) {
                canvas.circle_stroke(here, 9.0, Stroke::new(4.0, palette.raised));
                canvas.circle_stroke(here, 9.0, Stroke::new(2.0, palette.accent));
            }
        }
    }
    let mut row = rect.bottom() - 10.0;
    let font = FontId::proportional(12.0);
    for method in clip.on_stage().into_iter().rev() {
        let (name, hex) = match method {
            None => ("truth".to_owned(), TRUTH),
            Some(method) => (method.to_string(), hex_of_fill(method)),
        };
        let galley = canvas.layout_no_wrap(name, font.clone(), palette.text);
        row -= galley.size().y + 1.0;
        let right = rect.right() - 12.0;
        let at = pos2(right - galley.size().x, row);
        let dot = at + vec2(-8.0, 0.5 * galley.size().y);
        canvas.galley(at, galley, palette.text);
        canvas.circle_filled(dot, 4.0, color(hex));
    }
}
