//! The gizmo in the view: the pointer takes a handle, drags it, lets it go.

use egui::{Pos2, Rect, Response, Ui};

use crate::gizmo::{self, Handle, Snap, Viewport};
use crate::picture::painter::Shot;
use crate::state::session::Session;
use crate::theme::Palette;

/// What the pointer has to do with the gizmo.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pointed {
    /// The handle under the pointer.
    pub(super) hovered: Option<Handle>,
    /// Whether a handle is held, or was until now.
    pub(super) is_held: bool,
}

impl Pointed {
    /// Whether the pointer is the gizmo's, so that it means nothing to what is behind.
    pub(super) fn has_pointer(self) -> bool {
        self.is_held || self.hovered.is_some()
    }
}

/// Lets the pointer have its way with the gizmo.
pub(super) fn interact(ui: &Ui, response: &Response, session: &mut Session) -> Pointed {
    let viewport = Viewport::new(session.view_camera(), response.rect);
    if !session.is_dragging() {
        let pointer = ui.input(|i| i.pointer.latest_pos());
        session.begin_in_hand(pointer, &viewport);
    }
    if session.is_dragging() {
        return drag(ui, session, &viewport);
    }
    let Some(gizmo) = session.gizmo() else {
        return Pointed::default();
    };
    let shapes = gizmo::shapes(&gizmo, &viewport);
    let pressed = ui.input(|i| i.pointer.primary_pressed() && !i.modifiers.shift);
    if pressed && response.is_pointer_button_down_on() {
        let place: Option<Pos2> = ui.input(|i| i.pointer.press_origin());
        let handle = place.and_then(|place| gizmo::pick(&shapes, place).map(|h| (h, place)));
        if let Some((handle, place)) = handle
            && session.grab(handle, place, &viewport)
        {
            return drag(ui, session, &viewport);
        }
    }
    let free = response.hovered() && !response.dragged();
    let pointer = ui.input(|i| i.pointer.hover_pos()).filter(|_| free);
    let hovered = pointer.and_then(|place| gizmo::pick(&shapes, place));
    if hovered.is_some() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    }
    Pointed {
        hovered,
        is_held: false,
    }
}

fn drag(ui: &Ui, session: &mut Session, viewport: &Viewport) -> Pointed {
    let snap = snap(ui, session);
    let (place, fingers) = ui.input(|i| (i.pointer.latest_pos(), i.multi_touch().is_some()));
    // What is in hand is let go with a click; a handle, with the button that took it.
    let (ends, is_given_up) = ui.input(|i| match session.is_in_hand() {
        true => (i.pointer.primary_released(), i.pointer.secondary_released()),
        false => (!i.pointer.primary_down(), false),
    });
    if fingers || is_given_up {
        session.cancel_drag();
    }
    session.follow_axis(viewport);
    if let Some(place) = place {
        session.drag_to(place, viewport, snap);
    }
    if ends {
        session.drop_handle();
    }
    ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
    Pointed {
        hovered: None,
        is_held: true,
    }
}

/// Steps with Ctrl, or without it when they are switched on.
fn snap(ui: &Ui, session: &Session) -> Option<Snap> {
    let turned_over = ui.input(|i| i.modifiers.ctrl || i.modifiers.command);
    (session.tools().snaps != turned_over).then(|| session.snap())
}

/// Paints the gizmo over the picture.
pub(super) fn paint(ui: &Ui, rect: Rect, session: &Session, (pointed, shot): (&Pointed, &Shot)) {
    let Some(gizmo) = session.gizmo() else {
        return;
    };
    if session.transport.is_playing() {
        return;
    }
    let viewport = Viewport::new(shot.camera, rect);
    let canvas = ui.painter().with_clip_rect(rect);
    let palette = Palette::in_ui(ui);
    let held = (pointed.hovered, session.drag());
    gizmo::draw(&canvas, &gizmo, &viewport, held, &palette);
}
