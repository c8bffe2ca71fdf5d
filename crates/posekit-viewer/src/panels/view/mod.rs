//! The view: the picture, and what the pointer does in it.

mod handles;
mod limbs;
mod strip;
mod things;

use egui::{Align2, Color32, FontId, PointerButton, Pos2, Rect, Response, Sense, Stroke, Ui};
use glam::{Vec2, Vec3};
use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton};
use posekit_render::camera::Camera;

use super::Asked;
use crate::command::Command;
use crate::picture::painter::{Painter, Place, Shot};
use crate::state::animate::Owner;
use crate::state::camera::ViewCamera;
use crate::state::pick::{pick, pick_effector};
use crate::state::session::{ClipId, Handles, Session};
use crate::state::things::Picked;
use crate::theme::Palette;

/// A turn of the wheel by this many points makes things twice as near.
const POINTS_PER_DOUBLING: f32 = 360.0;

/// What the pointer is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Hovered {
    /// The figure's clip.
    clip: ClipId,
    /// The joint whose bone it is.
    joint: JointId,
}

/// What is below the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Below {
    /// The mode's own panel, if it has one.
    Mode,
    /// A side, which takes its place.
    Side,
}

/// Shows the view in all the room there is. Returns where the room under its tools begins.
pub fn show(
    ui: &mut Ui,
    session: &mut Session,
    painter: &mut Painter,
    below: Below,
    asked: &mut Asked,
) -> f32 {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let label = "View of the figure: drag to turn, click a bone to select it";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label));
    if rect.width() < 2.0 || rect.height() < 2.0 {
        return rect.top();
    }
    session.set_aspect(rect.width() / rect.height());
    let gizmo = handles::interact(ui, &response, session);
    if !gizmo.is_held {
        let size = session.stage().stature();
        let before = session.camera.clone();
        move_camera(ui, &response, &mut session.camera, size);
        if session.looks_through().is_some() && session.camera != before {
            session.camera = before;
            session.leave_camera();
        }
    }
    painter.update(ui.ctx(), session, pixels_of(ui, rect));
    let mut hovered = None;
    let mut thing = None;
    if let (false, Some(shot)) = (gizmo.has_pointer(), painter.shot()) {
        hovered = find_hovered(ui, &response, session, painter);
        thing = things::hovered(ui, &response, session, &shot.camera);
    }
    // A symbol is over the figure; a prop may be behind it.
    let is_symbol = |picked: &Picked| !matches!(picked.owner, Owner::Prop(_));
    match thing {
        Some(picked) if is_symbol(&picked) => hovered = None,
        Some(_) if hovered.is_some() => thing = None,
        _ => {}
    }
    if !gizmo.is_held {
        match thing {
            Some(_) if response.double_clicked() => {
                crate::command::apply(Command::FrameSelected, session);
            }
            Some(picked) if response.clicked() => session.pick(Some(picked)),
            _ => click(ui, &response, session, hovered),
        }
    }
    paint(ui, rect, session, painter, hovered);
    if let Some(shot) = painter.shot() {
        things::paint(ui, rect, session, (shot, thing));
        limbs::paint(ui, rect, session, shot);
        handles::paint(ui, rect, session, (&gizmo, shot));
    }
    strip::show(ui, (rect, below), session, asked)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a window's size in pixels is small and positive"
)]
pub(super) fn pixels_of(ui: &Ui, rect: Rect) -> (u32, u32) {
    let size = rect.size() * ui.ctx().pixels_per_point();
    (size.x.round() as u32, size.y.round() as u32)
}

/// Turn with the left or the middle button, move with the right one or with shift, zoom with the
/// wheel, a pinch, or the middle button and ctrl; `size` is that of what is looked at.
pub(super) fn move_camera(ui: &Ui, response: &Response, camera: &mut ViewCamera, size: f32) {
    let height = response.rect.height();
    let drag = response.drag_delta() / height;
    let modifiers = ui.input(|i| i.modifiers);
    let fingers = ui.input(|i| i.multi_touch());
    if let Some(fingers) = fingers {
        let shift = fingers.translation_delta / height;
        camera.pan(shift.x, shift.y);
        camera.zoom(1.0 / fingers.zoom_delta, size);
    } else if response.dragged() && drag != egui::Vec2::ZERO {
        let middle = response.dragged_by(PointerButton::Middle);
        if response.dragged_by(PointerButton::Secondary) || modifiers.shift {
            camera.pan(drag.x, drag.y);
        } else if middle && modifiers.ctrl {
            camera.zoom(libm::exp2f(drag.y * 2.0), size);
        } else {
            camera.turn(drag.x, drag.y);
        }
    }
    if response.dragged() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
    }
    if response.hovered() && fingers.is_none() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        if scroll != 0.0 {
            camera.zoom(libm::exp2f(-scroll / POINTS_PER_DOUBLING), size);
        }
        if (pinch - 1.0).abs() > 1e-4 {
            camera.zoom(1.0 / pinch, size);
        }
    }
}

fn find_hovered(
    ui: &Ui,
    response: &Response,
    session: &Session,
    painter: &Painter,
) -> Option<Hovered> {
    let shot = painter.shot()?;
    if response.dragged() || !response.hovered() {
        return None;
    }
    let pointer = ui.input(|i| i.pointer.hover_pos())?;
    let point = pointer - response.rect.min;
    let size = points_of(response.rect);
    let candidates = shot.poses.iter().filter_map(|(id, pose)| {
        let open = session.clips().iter().find(|open| open.id == *id)?;
        let skeleton = open.clip.skeleton();
        if skeleton.joint_count() != pose.joint_count() {
            return None;
        }
        let pick = match session.handles() {
            Handles::Targets => pick_effector,
            Handles::None | Handles::Joints => pick,
        };
        let (joint, distance) = pick(
            skeleton,
            pose,
            &shot.camera,
            size,
            Vec2::new(point.x, point.y),
        )?;
        Some((Hovered { clip: *id, joint }, distance))
    });
    candidates
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(hovered, _)| hovered)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a window's size in points is small and positive"
)]
fn points_of(rect: Rect) -> (u32, u32) {
    ((rect.width() as u32).max(1), (rect.height() as u32).max(1))
}

fn click(ui: &Ui, response: &Response, session: &mut Session, hovered: Option<Hovered>) {
    if response.double_clicked() {
        crate::command::apply(Command::FrameSelected, session);
    } else if response.clicked() {
        let adds = ui.input(|i| i.modifiers.shift || i.modifiers.command);
        match hovered {
            Some(hovered) => {
                session.activate_among(hovered.clip);
                if adds {
                    session.toggle_selected(hovered.joint);
                } else {
                    session.select(Some(hovered.joint));
                }
            }
            None if !adds => session.select(None),
            None => {}
        }
    }
}

fn paint(ui: &Ui, rect: Rect, session: &Session, painter: &Painter, hovered: Option<Hovered>) {
    painter.draw(ui, rect, Place::Stage);
    let canvas = ui.painter().with_clip_rect(rect);
    let Some(shot) = painter.shot() else { return };
    let overlay = Overlay {
        canvas: &canvas,
        rect,
        shot,
        palette: Palette::in_ui(ui),
    };
    if let Some(active) = session.active_id() {
        for &joint in session.selection() {
            overlay.mark(session, active, joint, overlay.palette.accent, 3.0);
        }
        // Where the gizmo is there is no room for a name; the inspector has it.
        if let Some(joint) = session.selected().filter(|_| session.gizmo().is_none()) {
            overlay.name(session, active, joint);
        }
    }
    if let Some(hovered) = hovered {
        let color = overlay.palette.accent.gamma_multiply(0.75);
        overlay.mark(session, hovered.clip, hovered.joint, color, 2.0);
        overlay.name(session, hovered.clip, hovered.joint);
    }
}

/// What is drawn over the picture.
struct Overlay<'a> {
    canvas: &'a egui::Painter,
    rect: Rect,
    shot: &'a Shot,
    palette: Palette,
}

impl Overlay<'_> {
    fn find<'s>(&self, session: &'s Session, clip: ClipId) -> Option<(&'s Skeleton, &GlobalPose)> {
        let open = session.clips().iter().find(|open| open.id == clip)?;
        let (_, pose) = self.shot.poses.iter().find(|(id, _)| *id == clip)?;
        let skeleton: &Skeleton = open.clip.skeleton();
        (skeleton.joint_count() == pose.joint_count()).then_some((skeleton, pose))
    }

    fn mark(&self, session: &Session, clip: ClipId, joint: JointId, color: Color32, width: f32) {
        let Some((skeleton, pose)) = self.find(session, clip) else {
            return;
        };
        if joint.index() >= skeleton.joint_count() {
            return;
        }
        let Some(here) = self.project(pose.positions[joint.index()]) else {
            return;
        };
        for child in skeleton.children(joint) {
            if let Some(there) = self.project(pose.positions[child.index()]) {
                self.canvas
                    .line_segment([here, there], Stroke::new(width, color));
            }
        }
        self.canvas.circle_filled(here, width + 1.5, color);
        self.canvas
            .circle_stroke(here, width + 3.5, Stroke::new(1.2, color));
    }

    fn name(&self, session: &Session, clip: ClipId, joint: JointId) {
        let Some((skeleton, pose)) = self.find(session, clip) else {
            return;
        };
        if joint.index() >= skeleton.joint_count() {
            return;
        }
        let Some(here) = self.project(pose.positions[joint.index()]) else {
            return;
        };
        let text = skeleton.unique_name(joint).to_owned();
        let font = FontId::proportional(13.0);
        let galley = self.canvas.layout_no_wrap(text, font, self.palette.text);
        let at = here + egui::vec2(12.0, -10.0 - galley.size().y);
        let card = Align2::LEFT_TOP
            .anchor_size(at, galley.size())
            .expand2(egui::vec2(7.0, 4.0));
        let card = card.translate(self.keep_inside(card));
        self.canvas.rect(
            card,
            5.0,
            self.palette.raised.gamma_multiply(0.94),
            Stroke::new(1.0, self.palette.line),
            egui::StrokeKind::Outside,
        );
        self.canvas
            .galley(card.min + egui::vec2(7.0, 4.0), galley, self.palette.text);
    }

    fn keep_inside(&self, card: Rect) -> egui::Vec2 {
        let room = self.rect.shrink(6.0);
        let x = (room.right() - card.right()).min(0.0) + (room.left() - card.left()).max(0.0);
        let y = (room.bottom() - card.bottom()).min(0.0) + (room.top() - card.top()).max(0.0);
        egui::vec2(x, y)
    }

    fn project(&self, point: Vec3) -> Option<Pos2> {
        project(&self.shot.camera, point, self.rect)
    }
}

/// Where a point of the stage is on the screen.
#[must_use]
pub fn project(camera: &Camera, point: Vec3, rect: Rect) -> Option<Pos2> {
    /// Fine enough to place a point within a fraction of a screen point.
    const FINE: f32 = 8.0;
    let size = points_of(Rect::from_min_size(Pos2::ZERO, rect.size() * FINE));
    let p = camera.project(point, size)?;
    Some(rect.min + egui::vec2(p.x, p.y) / FINE)
}
