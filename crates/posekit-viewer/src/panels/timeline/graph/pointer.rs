//! The pointer in the graph: what is under it, what it drags, how it moves the view.

use std::collections::BTreeSet;

use egui::{Modifiers, PointerButton, Pos2, Rect, Response, Ui};

use super::GraphPanel;
use super::plane::{Plane, ValueView};
use crate::panels::timeline::axis::TimeView;
use crate::state::animate::channel::Side;
use crate::state::animate::graph::{ChannelId, DotId, Graph, HandleId, HoldKind};
use crate::state::session::Session;

/// How near the pointer must be to take something, points.
const REACH: f32 = 8.0;

/// A turn of the wheel by this many points makes things twice as large.
const POINTS_PER_DOUBLING: f32 = 240.0;

/// The nearest that the pointer may come to the pivot of scaling, points.
const LEAST_DISTANCE: f32 = 4.0;

/// Along what dots are moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lock {
    /// In time alone.
    Time,
    /// In value alone.
    Value,
}

/// What the pointer does.
#[derive(Clone, Copy, Debug)]
pub(super) enum Task {
    /// It moves, scales or drags what the graph holds.
    Hold {
        /// The time that goes from frame to frame.
        reference_secs: f64,
        /// From the pointer's seconds and value to the handle's.
        handle_offset: [f64; 2],
        /// Whether it follows without a button, until one is pressed.
        is_modal: bool,
    },
    /// It draws a box around what will be selected.
    Box,
}

/// The pointer at work.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pointing {
    pub(super) task: Task,
    pub(super) from: Pos2,
    pub(super) lock: Option<Lock>,
}

impl Pointing {
    /// What is held goes along with the pointer until a button is pressed.
    pub(super) fn modal(graph: &Graph, plane: &Plane, from: Pos2) -> Self {
        let times = graph
            .selected()
            .into_iter()
            .filter_map(|dot| graph.place(dot));
        let first = times.map(|place| place[0]).fold(f64::INFINITY, f64::min);
        let reference_secs = if first.is_finite() {
            first
        } else {
            plane.secs(from.x)
        };
        Self {
            task: Task::Hold {
                reference_secs,
                handle_offset: [0.0; 2],
                is_modal: true,
            },
            from,
            lock: None,
        }
    }

    /// Whether something is held.
    pub(super) fn holds(&self) -> bool {
        matches!(self.task, Task::Hold { .. })
    }

    /// Locks the movement to an axis; the same axis again frees it.
    pub(super) fn toggle(&mut self, lock: Lock) {
        self.lock = (self.lock != Some(lock)).then_some(lock);
    }

    fn is_modal(&self) -> bool {
        matches!(self.task, Task::Hold { is_modal: true, .. })
    }
}

impl GraphPanel {
    pub(super) fn drop_held(&mut self) {
        self.graph.let_go();
        self.pointing = None;
    }
}

/// Zooms with the wheel, moves with the middle or the right button.
pub(super) fn move_view(
    ui: &Ui,
    response: &Response,
    panel: &mut GraphPanel,
    view: &mut TimeView,
    plane: &Plane,
) {
    let values = panel.values.get_or_insert(ValueView::of([-1.0, 1.0]));
    let drags =
        response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary);
    if drags {
        let by = response.drag_delta();
        view.pan(&plane.axis, -by.x);
        values.middle += f64::from(by.y) * plane.value_per_point();
        ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
    }
    let Some(pointer) = response.hover_pos() else {
        return;
    };
    let (scroll, zoom, modifiers) =
        ui.input(|i| (i.smooth_scroll_delta(), i.zoom_delta(), i.modifiers));
    // With Ctrl the wheel arrives as a zoom, with Shift as a scroll to the side.
    let in_value = if modifiers.shift {
        scroll.x + scroll.y
    } else {
        POINTS_PER_DOUBLING * libm::log2f(zoom)
    };
    if in_value != 0.0 {
        let factor = libm::exp2f(-in_value / POINTS_PER_DOUBLING);
        values.zoom(plane.value(pointer.y), f64::from(factor));
    }
    if !modifiers.shift && scroll.y != 0.0 {
        let factor = libm::exp2f(scroll.y / POINTS_PER_DOUBLING);
        view.zoom(&plane.axis, pointer.x, factor);
    }
    if !modifiers.shift && scroll.x != 0.0 {
        view.pan(&plane.axis, -scroll.x);
    }
}

/// Follows the pointer with what it holds; begins and ends drags, boxes and clicks.
pub(super) fn follow(
    ui: &Ui,
    response: &Response,
    session: &mut Session,
    panel: &mut GraphPanel,
    plane: &Plane,
) {
    let modifiers = ui.input(|i| i.modifiers);
    if ui.input(|i| i.pointer.any_pressed()) {
        panel.press_is_spent = false;
    }
    if panel.pointing.is_some_and(|pointing| pointing.is_modal()) {
        follow_modal(ui, session, panel, plane, modifiers);
        return;
    }
    if panel.press_is_spent {
        return;
    }
    if response.drag_started_by(PointerButton::Primary)
        && let Some(origin) = ui.input(|i| i.pointer.press_origin())
    {
        panel.pointing = Some(begin(session, panel, plane, origin, modifiers));
    }
    let Some(pointer) = ui.input(|i| i.pointer.latest_pos()) else {
        return;
    };
    if let Some(pointing) = panel.pointing {
        // The last move and the release may come within one picture.
        if let Task::Hold { .. } = pointing.task {
            apply(session, panel, plane, pointing, pointer, modifiers);
        }
        if response.drag_stopped_by(PointerButton::Primary) {
            if let Task::Box = pointing.task {
                select_in_box(session, panel, plane, (pointing.from, pointer), modifiers);
            }
            panel.drop_held();
        }
        return;
    }
    if response.double_clicked() {
        insert(session, panel, plane, pointer);
    } else if response.clicked() {
        click(session, panel, plane, pointer, modifiers);
    }
}

/// Follows without a button: any button ends it, the right one without effect.
fn follow_modal(
    ui: &Ui,
    session: &mut Session,
    panel: &mut GraphPanel,
    plane: &Plane,
    modifiers: Modifiers,
) {
    let (pointer, primary, secondary) = ui.input(|i| {
        (
            i.pointer.latest_pos(),
            i.pointer.primary_pressed(),
            i.pointer.secondary_pressed(),
        )
    });
    panel.press_is_spent = primary || secondary;
    if secondary {
        panel.cancel(session);
        return;
    }
    if let (Some(pointer), Some(pointing)) = (pointer, panel.pointing) {
        apply(session, panel, plane, pointing, pointer, modifiers);
    }
    if primary {
        panel.drop_held();
    }
    ui.ctx().set_cursor_icon(egui::CursorIcon::Move);
}

/// What a drag from a place does.
fn begin(
    session: &mut Session,
    panel: &mut GraphPanel,
    plane: &Plane,
    origin: Pos2,
    modifiers: Modifiers,
) -> Pointing {
    let boxed = Pointing {
        task: Task::Box,
        from: origin,
        lock: None,
    };
    let held = |reference_secs: f64, handle_offset: [f64; 2]| Pointing {
        task: Task::Hold {
            reference_secs,
            handle_offset,
            is_modal: false,
        },
        from: origin,
        lock: None,
    };
    if let Some(handle) = handle_at(&panel.graph, plane, origin) {
        let [secs, value] = panel.graph.handle_place(handle).unwrap_or_default();
        if panel.graph.take_handle(session, handle) {
            let offset = [secs - plane.secs(origin.x), value - plane.value(origin.y)];
            return held(0.0, offset);
        }
    }
    let Some(dot) = dot_at(&panel.graph, plane, origin) else {
        return boxed;
    };
    if !panel.graph.is_selected(dot) {
        let mut dots = BTreeSet::from([dot]);
        if modifiers.shift || modifiers.command {
            dots.extend(panel.graph.selected());
        }
        panel.graph.select(session, dots);
    }
    let secs = panel.graph.place(dot).map_or(0.0, |place| place[0]);
    if panel.graph.take_dots(session) {
        return held(secs, [0.0; 2]);
    }
    boxed
}

/// Brings what is held to where the pointer is.
fn apply(
    session: &mut Session,
    panel: &mut GraphPanel,
    plane: &Plane,
    pointing: Pointing,
    pointer: Pos2,
    modifiers: Modifiers,
) {
    let Task::Hold {
        reference_secs,
        handle_offset,
        ..
    } = pointing.task
    else {
        return;
    };
    let Some(kind) = panel.graph.held().map(|held| held.kind()) else {
        return;
    };
    let lock = pointing
        .lock
        .or_else(|| lock_by_shift(pointing.from, pointer, modifiers));
    match kind {
        HoldKind::Move => {
            let mut by_secs = plane.secs(pointer.x) - plane.secs(pointing.from.x);
            if !modifiers.command {
                by_secs = plane.axis.snapped(reference_secs + by_secs) - reference_secs;
            }
            let by_value = plane.value(pointer.y) - plane.value(pointing.from.y);
            let by = match lock {
                Some(Lock::Time) => [by_secs, 0.0],
                Some(Lock::Value) => [0.0, by_value],
                None => [by_secs, by_value],
            };
            panel.graph.move_held(session, by);
        }
        HoldKind::Scale { pivot } => {
            let pivot = plane.pos(pivot);
            let [from, to] = [pointing.from, pointer]
                .map(|place| f64::from((place - pivot).length().max(LEAST_DISTANCE)));
            let factor = to / from;
            let factors = match lock {
                Some(Lock::Time) => [factor, 1.0],
                Some(Lock::Value) => [1.0, factor],
                None => [factor; 2],
            };
            panel.graph.scale_held(session, factors);
        }
        HoldKind::Handle(_) => {
            let from = [plane.secs(pointing.from.x), plane.value(pointing.from.y)];
            let mut to = [plane.secs(pointer.x), plane.value(pointer.y)];
            match lock {
                Some(Lock::Time) => to[1] = from[1],
                Some(Lock::Value) => to[0] = from[0],
                None => {}
            }
            let place = [to[0] + handle_offset[0], to[1] + handle_offset[1]];
            panel.graph.drag_held_handle(session, place);
        }
    }
}

/// With Shift it goes along the axis that the pointer has gone farther along.
fn lock_by_shift(from: Pos2, to: Pos2, modifiers: Modifiers) -> Option<Lock> {
    let way = to - from;
    modifiers.shift.then_some(if way.x.abs() >= way.y.abs() {
        Lock::Time
    } else {
        Lock::Value
    })
}

fn select_in_box(
    session: &mut Session,
    panel: &mut GraphPanel,
    plane: &Plane,
    (from, to): (Pos2, Pos2),
    modifiers: Modifiers,
) {
    let area = Rect::from_two_pos(from, to);
    let inside = panel.graph.dots().filter(|dot| {
        let place = panel.graph.place(*dot);
        place.is_some_and(|place| area.contains(plane.pos(place)))
    });
    let mut dots: BTreeSet<DotId> = inside.collect();
    if modifiers.shift || modifiers.command {
        dots.extend(panel.graph.selected());
    }
    panel.graph.select(session, dots);
}

/// A click selects what is under it.
fn click(
    session: &mut Session,
    panel: &mut GraphPanel,
    plane: &Plane,
    pointer: Pos2,
    modifiers: Modifiers,
) {
    let adds = modifiers.shift || modifiers.command;
    let mut dots = if adds {
        panel.graph.selected()
    } else {
        BTreeSet::new()
    };
    match dot_at(&panel.graph, plane, pointer) {
        Some(dot) if adds && dots.contains(&dot) => {
            dots.remove(&dot);
        }
        Some(dot) => {
            dots.insert(dot);
        }
        None => {}
    }
    panel.graph.select(session, dots);
}

/// A double click on a curve puts a key there.
fn insert(session: &mut Session, panel: &mut GraphPanel, plane: &Plane, pointer: Pos2) {
    if dot_at(&panel.graph, plane, pointer).is_some() {
        return;
    }
    let secs = plane.axis.snapped(plane.secs(pointer.x));
    if let Some(channel) = curve_at(&panel.graph, plane, pointer) {
        panel.graph.insert_key(session, channel, secs);
    }
}

/// The nearest thing within reach.
fn nearest<T>(things: impl Iterator<Item = (T, Pos2)>, pointer: Pos2) -> Option<T> {
    things
        .map(|(thing, place)| (thing, place.distance(pointer)))
        .filter(|(_, distance)| *distance <= REACH)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(thing, _)| thing)
}

/// The dot under the pointer. Of those at one place a selected one is taken.
pub(super) fn dot_at(graph: &Graph, plane: &Plane, pointer: Pos2) -> Option<DotId> {
    let placed = |dot: DotId| Some((dot, plane.pos(graph.place(dot)?)));
    let selected = nearest(graph.selected().into_iter().filter_map(placed), pointer);
    selected.or_else(|| nearest(graph.dots().filter_map(placed), pointer))
}

/// The handle under the pointer: those of selected dots are shown.
pub(super) fn handle_at(graph: &Graph, plane: &Plane, pointer: Pos2) -> Option<HandleId> {
    nearest(
        handles(graph).filter_map(|id| Some((id, plane.pos(graph.handle_place(id)?)))),
        pointer,
    )
}

/// The handles that are shown.
pub(super) fn handles(graph: &Graph) -> impl Iterator<Item = HandleId> {
    let selected = graph.selected().into_iter();
    selected.flat_map(|at| Side::BOTH.map(|side| HandleId { at, side }))
}

/// The curve under the pointer.
pub(super) fn curve_at(graph: &Graph, plane: &Plane, pointer: Pos2) -> Option<ChannelId> {
    let secs = plane.secs(pointer.x);
    let mut values = std::collections::BTreeMap::new();
    let distances = graph.seen().map(|(id, channels)| {
        let values = values.entry(id.lane).or_insert_with(|| channels.at(secs));
        (id, (plane.y(values[id.channel]) - pointer.y).abs())
    });
    distances
        .filter(|(_, distance)| *distance <= REACH)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(id, _)| id)
}
