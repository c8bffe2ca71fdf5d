//! The lab's view: the robot, and what the pointer does with its tip.

use egui::{Painter as Canvas, Rect, Response, Sense, Shape, Stroke, Ui, vec2};
use glam::{DVec3, Vec3};
use posekit::mechanism::Freedom;
use posekit::skeleton::JointId;

use super::super::Asked;
use super::super::view::{move_camera, pixels_of};
use super::{LabPanel, strip};
use crate::gizmo::{self, Handle, Snap, Viewport};
use crate::picture::painter::{Painter, Place, Subject};
use crate::state::arm::bench::Bench;
use crate::state::arm::mobility::{Hardest, Singularity};
use crate::state::arm::{ArmLab, single};
use crate::state::display::Look;
use crate::theme::{CURVES, Palette};

/// A gap between tip and target of fewer points is not drawn.
const SEEN_GAP: f32 = 3.0;

/// Shows it in all the room there is. Where the room under the tools begins.
pub(super) fn show(
    ui: &mut Ui,
    (lab, panel, painter): (&mut ArmLab, LabPanel, &mut Painter),
    look: Look,
    asked: &mut Asked,
) -> f32 {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let label = "View of the robot: drag to turn, drag the tip's handles to move it";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label));
    if rect.width() < 2.0 || rect.height() < 2.0 {
        return rect.top();
    }
    lab.set_aspect(rect.width() / rect.height());
    let (hovered, is_held) = interact(ui, &response, lab);
    if !is_held {
        let size = lab.size();
        move_camera(ui, &response, &mut lab.camera, size);
        if response.double_clicked() {
            lab.reframe();
        }
    }
    draw(ui, rect, lab, painter, look);
    if let Some(bench) = lab.bench() {
        let marks = Marks {
            canvas: ui.painter().with_clip_rect(rect),
            viewport: Viewport::new(lab.view_camera(), rect),
            palette: Palette::in_ui(ui),
            size: lab.size(),
        };
        marks.paint(bench, panel.pointed);
        let held = (hovered, bench.drag());
        gizmo::draw(
            &marks.canvas,
            &bench.gizmo(),
            &marks.viewport,
            held,
            &marks.palette,
        );
    }
    strip::show(ui, rect, lab, asked)
}

fn draw(ui: &Ui, rect: Rect, lab: &ArmLab, painter: &mut Painter, look: Look) {
    let subject = Subject {
        place: Place::Bench,
        version: (lab.version() << 1) | u64::from(look == Look::Dark),
        time_secs: 0.0,
        camera: lab.view_camera(),
        moves: false,
        scene: &|| lab.scene(look),
        poses: &Vec::new,
    };
    painter.update_with(ui.ctx(), &subject, pixels_of(ui, rect));
    painter.draw(ui, rect, Place::Bench);
}

/// Lets the pointer have its way with the gizmo: the handle under it, and whether one is held.
fn interact(ui: &Ui, response: &Response, lab: &mut ArmLab) -> (Option<Handle>, bool) {
    let viewport = Viewport::new(lab.view_camera(), response.rect);
    let Some(bench) = lab.bench() else {
        return (None, false);
    };
    if bench.is_dragging() {
        drag(ui, lab, &viewport);
        return (None, true);
    }
    let shapes = gizmo::shapes(&bench.gizmo(), &viewport);
    let pressed = ui.input(|i| i.pointer.primary_pressed() && !i.modifiers.shift);
    if pressed && response.is_pointer_button_down_on() {
        let place = ui.input(|i| i.pointer.press_origin());
        let taken = place.and_then(|place| gizmo::pick(&shapes, place).map(|h| (h, place)));
        if let Some((handle, place)) = taken
            && lab.work(|bench| bench.grab(handle, place, &viewport)) == Some(true)
        {
            drag(ui, lab, &viewport);
            return (None, true);
        }
    }
    let free = response.hovered() && !response.dragged();
    let pointer = ui.input(|i| i.pointer.hover_pos()).filter(|_| free);
    let hovered = pointer.and_then(|place| gizmo::pick(&shapes, place));
    if hovered.is_some() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    }
    (hovered, false)
}

fn drag(ui: &Ui, lab: &mut ArmLab, viewport: &Viewport) {
    let snap = snap(ui, lab);
    let (place, is_down, fingers) = ui.input(|i| {
        let is_down = i.pointer.primary_down();
        (i.pointer.latest_pos(), is_down, i.multi_touch().is_some())
    });
    lab.work_if(|bench| {
        if fingers {
            return bench.cancel_drag();
        }
        let has_moved = place.is_some_and(|place| bench.drag_to(place, viewport, snap));
        if !is_down {
            bench.drop_handle();
        }
        has_moved || !is_down
    });
    ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
}

/// Steps with Ctrl, or without it when they are switched on.
fn snap(ui: &Ui, lab: &ArmLab) -> Option<Snap> {
    let turned_over = ui.input(|i| i.modifiers.ctrl || i.modifiers.command);
    let snap = lab.bench().map(Bench::snap)?;
    (lab.snaps() != turned_over).then_some(snap)
}

/// What is drawn over the picture.
struct Marks {
    canvas: Canvas,
    viewport: Viewport,
    palette: Palette,
    size: f32,
}

impl Marks {
    fn paint(&self, bench: &Bench, pointed: Option<JointId>) {
        if let Some(joint) = pointed {
            self.axis(bench, joint);
        }
        self.lost(bench);
        self.missing(bench);
        if bench.planar().is_some() {
            self.angles(bench);
        }
    }

    fn line(&self, from: Vec3, to: Vec3, stroke: Stroke) {
        let (Some(a), Some(b)) = (self.viewport.project(from), self.viewport.project(to)) else {
            return;
        };
        let rim = Stroke::new(stroke.width + 2.4, self.palette.raised.gamma_multiply(0.7));
        self.canvas.line_segment([a, b], rim);
        self.canvas.line_segment([a, b], stroke);
    }

    /// The axis of the joint whose slider the pointer is over.
    fn axis(&self, bench: &Bench, joint: JointId) {
        let axis = match bench.robot().mechanism.joint(joint).freedom {
            Freedom::Hinge { axis } | Freedom::Slide { axis } => axis,
            _ => return,
        };
        let frame = bench.frames()[joint.index()];
        let along = (frame.orientation * axis).as_vec3() * (0.35 * self.size);
        let middle = frame.position.as_vec3();
        let stroke = Stroke::new(2.6, CURVES[4]);
        self.line(middle - along, middle + along, stroke);
        if let Some(place) = self.viewport.project(middle) {
            self.canvas
                .circle(place, 4.5, CURVES[4], Stroke::new(1.5, self.palette.raised));
        }
    }

    /// The way of moving that is lost or hard, near a singularity.
    fn lost(&self, bench: &Bench) {
        let mobility = bench.mobility();
        let color = match mobility.singularity {
            Singularity::Far => return,
            Singularity::Near => self.palette.warning,
            Singularity::At => self.palette.error,
        };
        let middle = bench.tip_frame().position.as_vec3();
        let direction = match mobility.hardest {
            Some(Hardest::Move(direction) | Hardest::Turn(direction)) => direction.as_vec3(),
            None => return,
        };
        let reach = direction * (0.3 * self.size);
        self.line(middle - reach, middle + reach, Stroke::new(2.6, color));
    }

    /// What is missing between the tip and its target.
    fn missing(&self, bench: &Bench) {
        let Some(target) = bench.target() else { return };
        let tip = bench.tip_frame().position.as_vec3();
        let ends = [tip, target.position.as_vec3()].map(|point| self.viewport.project(point));
        let [Some(here), Some(there)] = ends else {
            return;
        };
        if here.distance(there) > SEEN_GAP {
            let line = Stroke::new(1.8, self.palette.error);
            self.canvas
                .extend(Shape::dashed_line(&[here, there], line, 5.0, 4.0));
            self.canvas.circle_stroke(here, 5.0, line);
        }
    }

    /// The angles of a planar arm as arcs at its joints, with their names.
    fn angles(&self, bench: &Bench) {
        let Some(arm) = bench.planar() else { return };
        let [t1, t2] = arm.angles(bench.values());
        let normal = arm.normal().as_vec3();
        let elbow = arm.in_world(arm.links.elbow(t1));
        let along = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            (arm.axes * DVec3::new(cos, sin, 0.0)).as_vec3()
        };
        for (middle, from, angle, name) in [(arm.origin, 0.0, t1, "t1"), (elbow, t1, t2, "t2")] {
            let middle = middle.as_vec3();
            let radius = 0.16 * single(arm.links.upper);
            let sector = gizmo::Sector {
                middle,
                axis: normal,
                from: along(from) * radius,
                angle_rad: single(angle),
            };
            self.line(
                middle,
                middle + along(from) * (1.6 * radius),
                Stroke::new(1.2, self.palette.quiet),
            );
            sector.draw(&self.canvas, &self.viewport, CURVES[3]);
            let half = along(from + 0.5 * angle) * (1.9 * radius);
            if let Some(place) = self.viewport.project(middle + half) {
                self.name(place, name);
            }
        }
    }

    fn name(&self, place: egui::Pos2, name: &str) {
        let font = egui::FontId::proportional(14.0);
        let galley = self
            .canvas
            .layout_no_wrap(name.to_owned(), font, self.palette.text);
        let card = Rect::from_center_size(place, galley.size() + vec2(10.0, 3.0));
        self.canvas
            .rect_filled(card, 5.0, self.palette.raised.gamma_multiply(0.85));
        let at = place - galley.size() / 2.0;
        self.canvas.galley(at, galley, self.palette.text);
    }
}
