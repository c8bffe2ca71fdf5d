//! The dope sheet: when keys are, a row for each joint, camera, light and prop, and one for all.
//!
//! A mark is all keys of its row at one time. Clicks select marks, drags move them, a drag from where
//! there is none selects in a box; keys of the keyboard let marks follow the pointer without a button.

mod hold;
mod paint;
pub mod rows;

use std::collections::BTreeSet;

use egui::{CursorIcon, PointerButton, Pos2, Rect, Response, Sense, Ui, pos2, vec2};
use posekit::skeleton::JointId;

use super::Room;
use super::axis::{Axis, TimeView, paint_ground};
use super::menu::name_of;
use crate::command::KeysCommand;
use crate::state::animate::edit::keys::{added, deleted};
use crate::state::animate::{Authored, KeyId, Owner};
use crate::state::session::{ClipId, Session};
use crate::theme::Palette;
use hold::{BoxSelect, Held, Until, Verb};
use paint::{ROW_HEIGHT, index_to_f32};
use rows::{Kind, Row, rows};

/// How near the pointer must be to a mark, points.
const REACH: f32 = 7.0;

/// A press that moves less than this is a click, points.
const CLICK: f32 = 3.0;

/// Width of the scroll bar.
const BAR: f32 = 9.0;

/// What the rows were made of.
#[derive(Clone, Debug, PartialEq)]
struct Made {
    clip: Option<ClipId>,
    revision: u64,
    selected: Vec<JointId>,
    open: BTreeSet<Owner>,
}

/// What the dope sheet remembers from picture to picture.
#[derive(Debug, Default)]
pub struct Dope {
    open: BTreeSet<Owner>,
    scroll: f32,
    rows: Vec<Row>,
    made: Option<Made>,
    held: Option<Held>,
    boxed: Option<BoxSelect>,
    /// The next press starts a box wherever it is.
    wants_box: bool,
    /// Where the button went down, and the time of the mark there.
    pressed: Option<(Pos2, Option<f64>)>,
    /// Where the pointer was over the marks last, and the axis then.
    seen: Option<(Pos2, Axis)>,
}

impl Dope {
    /// Whether keys follow the pointer, or the next press is taken.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.held.is_some() || self.boxed.is_some() || self.wants_box
    }

    /// Lets what follows the pointer be where it is.
    pub fn confirm(&mut self) {
        self.held = None;
        self.boxed = None;
        self.wants_box = false;
    }

    /// Gives up what follows the pointer.
    pub fn cancel(&mut self, session: &mut Session) {
        if let Some(held) = self.held.take() {
            held.cancel(session);
        }
        if let Some(boxed) = self.boxed.take() {
            session.author(|authored| authored.select(boxed.kept));
        }
        self.wants_box = false;
        self.pressed = None;
    }

    /// Opens or closes the rows under a row.
    pub fn toggle_open(&mut self, owner: Owner) {
        if !self.open.remove(&owner) {
            self.open.insert(owner);
        }
    }

    /// The rows as they were shown last.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Does what a command asks, if it is one about the dope sheet alone. False for others.
    pub fn run(&mut self, command: KeysCommand, session: &mut Session) -> bool {
        let verb = match command {
            KeysCommand::Move => Verb::Move,
            KeysCommand::Duplicate => Verb::Duplicate,
            KeysCommand::Scale => Verb::Scale {
                pivot_secs: session.scene_secs(),
            },
            KeysCommand::BoxSelect => {
                self.cancel(session);
                self.wants_box = true;
                return true;
            }
            KeysCommand::Delete => {
                session.author(|authored| {
                    let keys = authored.selection().clone();
                    let edit = deleted(authored, &keys);
                    if !edit.is_empty() {
                        let name = format!("Delete {}", super::counted(keys.len()));
                        authored.set_tracks(&name, None, edit.changes, edit.selection);
                    }
                });
                return true;
            }
            _ => return false,
        };
        self.cancel(session);
        if let Some((at, axis)) = self.seen {
            self.held = Held::take(session, (verb, Until::Click), &axis, (at, None));
            if let Some(held) = &mut self.held {
                held.follow(session, &axis, at, false);
            }
        }
        true
    }

    fn update(&mut self, session: &Session) {
        let Some(authored) = session.authored() else {
            return;
        };
        let made = Made {
            clip: session.active_id(),
            revision: authored.revision(),
            selected: session.selection().to_vec(),
            open: self.open.clone(),
        };
        if self.made.as_ref() != Some(&made) {
            self.rows = rows(authored, &made.selected, &made.open);
            self.made = Some(made);
        }
    }

    fn top_of(&self, room: &Room, index: usize) -> f32 {
        room.body.top() + index_to_f32(index) * ROW_HEIGHT - self.scroll
    }

    /// The row at a height. The first one stays at the top.
    fn row_at(&self, room: &Room, y: f32) -> Option<usize> {
        if y < room.body.top() || y > room.body.bottom() {
            return None;
        }
        if y < room.body.top() + ROW_HEIGHT {
            return (!self.rows.is_empty()).then_some(0);
        }
        (1..self.rows.len()).find(|&index| {
            let top = self.top_of(room, index);
            (top..top + ROW_HEIGHT).contains(&y)
        })
    }

    /// The mark at a place: its row, and which one of that.
    fn mark_at(&self, room: &Room, at: Pos2) -> Option<(usize, usize)> {
        let row = self.row_at(room, at.y)?;
        let away = |secs: f64| (room.axis.x(secs) - at.x).abs();
        let marks = self.rows[row].marks.iter().enumerate();
        let near = marks.filter(|(_, mark)| away(mark.secs) <= REACH);
        let nearest = near.min_by(|a, b| away(a.1.secs).total_cmp(&away(b.1.secs)));
        nearest.map(|(mark, _)| (row, mark))
    }

    fn keys_in(&self, room: &Room, rect: Rect) -> BTreeSet<KeyId> {
        let times = [rect.left(), rect.right()].map(|x| room.axis.secs_at(x));
        let mut keys = BTreeSet::new();
        for (index, row) in self.rows.iter().enumerate() {
            let top = if index == 0 {
                room.body.top()
            } else {
                self.top_of(room, index)
            };
            let middle = top + ROW_HEIGHT / 2.0;
            if !(rect.top()..=rect.bottom()).contains(&middle) {
                continue;
            }
            let inside = row
                .marks
                .iter()
                .filter(|mark| (times[0]..=times[1]).contains(&mark.secs));
            keys.extend(inside.flat_map(|mark| mark.keys.iter().copied()));
        }
        keys
    }
}

/// Shows the sheet.
pub fn show(ui: &mut Ui, room: &Room, session: &mut Session, dope: &mut Dope, time: &mut TimeView) {
    dope.update(session);
    scroll(ui, room, dope);
    let body = Rect::from_min_max(room.body.min, room.body.max - vec2(BAR, 0.0));
    let response = ui.interact(body, ui.scope_id().with("dope"), Sense::click_and_drag());
    let label = "Dope sheet: click and drag keys, drag a box to select";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Group, true, label));
    if let Some(at) = response.hover_pos() {
        dope.seen = Some((at, room.axis));
    }
    time.interact(ui, &response, &room.axis);
    if response.dragged_by(PointerButton::Middle) {
        dope.scroll -= response.drag_delta().y;
    }
    interact(ui, room, &response, session, dope);
    dope.update(session);
    names(ui, room, session, dope);
    paint_sheet(ui, room, &response, session, dope);
}

/// Lets the pointer have its way with the marks.
fn interact(ui: &Ui, room: &Room, response: &Response, session: &mut Session, dope: &mut Dope) {
    let (pointer, is_down, pressed, cancels) = ui.input(|i| {
        let p = &i.pointer;
        let cancels = p.secondary_pressed();
        (
            p.latest_pos(),
            p.primary_down(),
            p.primary_pressed(),
            cancels,
        )
    });
    let Some(pointer) = pointer else {
        return;
    };
    let (shift, is_free) = ui.input(|i| {
        let m = i.modifiers;
        (m.shift, m.ctrl || m.command)
    });
    if dope.is_busy() && cancels {
        dope.cancel(session);
        return;
    }
    if let Some(held) = &mut dope.held {
        held.follow(session, &room.axis, pointer, is_free);
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        let is_over = match held.until {
            Until::Release => !is_down,
            Until::Click => pressed,
        };
        if is_over {
            dope.held = None;
        }
        return;
    }
    if let Some(boxed) = &dope.boxed {
        let mut keys = dope.keys_in(room, boxed.rect(pointer));
        keys.extend(boxed.kept.iter().copied());
        session.author(|authored| authored.select(keys));
        if !is_down {
            dope.boxed = None;
        }
        return;
    }
    // A quick click goes down and up within one picture.
    let begins = pressed && (response.is_pointer_button_down_on() || response.clicked());
    if begins {
        press(room, pointer, shift, session, dope);
    }
    if let Some((from, anchor)) = dope.pressed
        && (is_down || response.drag_stopped())
        && from.distance(pointer) > CLICK
    {
        begin_drag(room, (from, anchor), shift, session, dope);
        ui.ctx().request_repaint();
    }
    if !is_down {
        let was_pressed = dope.pressed.take().is_some();
        if response.double_clicked() {
            add_key(room, pointer, session, dope);
        } else if was_pressed && response.clicked() && !shift {
            click(room, pointer, session, dope);
        }
    }
}

/// A press selects what is under it, so that it can be dragged at once.
fn press(room: &Room, at: Pos2, shift: bool, session: &mut Session, dope: &mut Dope) {
    if dope.wants_box {
        dope.wants_box = false;
        dope.boxed = Some(box_from(at, shift, session));
        return;
    }
    if let Some(pivot_secs) = grip_at(room, at, session) {
        let scale = (Verb::Scale { pivot_secs }, Until::Release);
        dope.held = Held::take(session, scale, &room.axis, (at, None));
        return;
    }
    let Some((row, mark)) = dope.mark_at(room, at) else {
        dope.pressed = Some((at, None));
        return;
    };
    let mark = &dope.rows[row].marks[mark];
    dope.pressed = Some((at, Some(mark.secs)));
    let keys: BTreeSet<KeyId> = mark.keys.iter().copied().collect();
    session.author(|authored| {
        let mut selected = authored.selection().clone();
        let all = keys.is_subset(&selected);
        if shift && all {
            selected.retain(|key| !keys.contains(key));
        } else if shift {
            selected.extend(keys);
        } else if !all {
            selected = keys;
        }
        authored.select(selected);
    });
}

fn begin_drag(
    room: &Room,
    (from, anchor): (Pos2, Option<f64>),
    shift: bool,
    session: &mut Session,
    dope: &mut Dope,
) {
    dope.pressed = None;
    match anchor {
        Some(_) => {
            let verb = (Verb::Move, Until::Release);
            dope.held = Held::take(session, verb, &room.axis, (from, anchor));
        }
        None => dope.boxed = Some(box_from(from, shift, session)),
    }
}

fn box_from(from: Pos2, adds: bool, session: &Session) -> BoxSelect {
    let selected = session.authored().map(Authored::selection);
    let kept = selected.filter(|_| adds).cloned().unwrap_or_default();
    BoxSelect { from, kept }
}

/// A click that was no drag: what is under it is selected alone.
fn click(room: &Room, at: Pos2, session: &mut Session, dope: &Dope) {
    let mark = dope.mark_at(room, at);
    let keys = mark.map(|(row, mark)| dope.rows[row].marks[mark].keys.clone());
    let keys = keys.unwrap_or_default().into_iter().collect();
    session.author(|authored| authored.select(keys));
}

/// A key on each property that the row under the pointer has keyed; of a joint that has none, on its
/// rotation.
fn add_key(room: &Room, at: Pos2, session: &mut Session, dope: &Dope) {
    if dope.mark_at(room, at).is_some() {
        return;
    }
    let Some(row) = dope.row_at(room, at.y).map(|row| &dope.rows[row]) else {
        return;
    };
    let time = room.axis.snapped(room.axis.secs_at(at.x));
    let interpolation = session.animate().interpolation;
    let name = format!("Key {}", row.name);
    session.author(|authored| {
        let mut lanes = row.lanes(authored);
        let is_lane = matches!(row.kind, Kind::Lane(_));
        lanes.retain(|lane| is_lane || authored.track(*lane).is_some());
        if let (true, Kind::Owner(owner)) = (lanes.is_empty(), row.kind) {
            lanes = owner.lanes().into_iter().take(1).collect();
        }
        if let Some(edit) = added(authored, &lanes, time, interpolation) {
            authored.set_tracks(&name, None, edit.changes, edit.selection);
        }
    });
}

/// The first and the last time that is selected, where they differ.
fn selected_span(authored: &Authored) -> Option<[f64; 2]> {
    let times = authored
        .selection()
        .iter()
        .filter_map(|key| authored.time_of(*key));
    let span = times
        .map(|time| [time, time])
        .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    (span[1] - span[0] > 1e-6).then_some(span)
}

fn grips(room: &Room, session: &Session) -> Option<[Pos2; 2]> {
    let span = selected_span(session.authored()?)?;
    let y = room.body.top() + ROW_HEIGHT / 2.0;
    Some(span.map(|secs| pos2(room.axis.x(secs), y)))
}

/// The time about which the grip under the pointer scales: that of the other one.
fn grip_at(room: &Room, at: Pos2, session: &Session) -> Option<f64> {
    let places = grips(room, session)?;
    let span = selected_span(session.authored()?)?;
    let near = |place: Pos2, side: f32| {
        let grip = place + vec2(side * 9.0, 0.0);
        (at.x - grip.x).abs() <= 3.5 && (at.y - grip.y).abs() <= ROW_HEIGHT / 2.0
    };
    match [near(places[0], -1.0), near(places[1], 1.0)] {
        [true, _] => Some(span[1]),
        [_, true] => Some(span[0]),
        _ => None,
    }
}

/// The rows that do not fit are reached with the wheel over the names, or the bar at the right.
fn scroll(ui: &Ui, room: &Room, dope: &mut Dope) {
    let whole = index_to_f32(dope.rows.len()) * ROW_HEIGHT;
    let most = (whole - room.body.height()).max(0.0);
    let over_names = ui.rect_contains_pointer(room.names);
    if over_names {
        dope.scroll -= ui.input(|i| i.smooth_scroll_delta().y);
    }
    dope.scroll = dope.scroll.clamp(0.0, most);
    if most <= 0.0 {
        return;
    }
    let bar = Rect::from_min_max(
        pos2(room.body.right() - BAR, room.body.top() + ROW_HEIGHT),
        room.body.max,
    );
    let response = ui.interact(bar, ui.scope_id().with("scroll"), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::new(egui::Role::ScrollBar));
    let share = bar.height() / whole.max(1.0);
    if response.dragged() {
        dope.scroll = (dope.scroll + response.drag_delta().y / share).clamp(0.0, most);
    }
    let length = (bar.height() * room.body.height() / whole).max(18.0);
    let top = bar.top() + (bar.height() - length) * dope.scroll / most;
    let thumb = Rect::from_min_size(pos2(bar.left() + 2.0, top), vec2(BAR - 4.0, length));
    let palette = Palette::in_ui(ui);
    let strong = if response.hovered() || response.dragged() {
        0.8
    } else {
        0.4
    };
    ui.painter()
        .rect_filled(thumb, 3.0, palette.quiet.gamma_multiply(strong));
}

/// The rows that are in view, with their rectangles over a column. The first is at the top always.
fn in_view(dope: &Dope, room: &Room, column: Rect) -> Vec<(usize, Rect, Rect)> {
    let below = Rect::from_min_max(
        pos2(column.left(), room.body.top() + ROW_HEIGHT),
        column.max,
    );
    let rows = dope.rows.iter().enumerate();
    let placed = rows.filter_map(|(index, _)| {
        let top = if index == 0 {
            room.body.top()
        } else {
            dope.top_of(room, index)
        };
        let rect = Rect::from_min_size(pos2(column.left(), top), vec2(column.width(), ROW_HEIGHT));
        let clip = if index == 0 { rect } else { below };
        rect.intersects(clip).then_some((index, rect, clip))
    });
    placed.collect()
}

/// The column of names: clicks select joints and open rows.
fn names(ui: &mut Ui, room: &Room, session: &mut Session, dope: &mut Dope) {
    let palette = Palette::in_ui(ui);
    let mut opened = None;
    for (index, rect, clip) in in_view(dope, room, room.names) {
        let row = &dope.rows[index];
        let joint = joint_of(row.kind);
        let is_selected = joint.is_some_and(|joint| session.selection().contains(&joint));
        let painter = ui.painter().with_clip_rect(clip.intersect(room.names));
        paint::ground(&painter, rect, row, is_selected, &palette);
        paint::name(&painter, rect, row, is_selected, &palette);
        let id = ui.scope_id().with(("row", index));
        let response = ui.interact(rect.intersect(clip), id, Sense::click());
        let label = match row.kind {
            Kind::Lane(lane) => session.authored().map_or_else(String::new, |authored| {
                format!(
                    "Keys of {}",
                    lane.label(authored.scene(), authored.skeleton())
                )
            }),
            _ => format!("Keys of {}", row.name),
        };
        response.widget_info(|| {
            egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, &label)
        });
        if !response.clicked() {
            continue;
        }
        let on_triangle = response
            .interact_pointer_pos()
            .is_some_and(|at| at.x < rect.left() + 28.0);
        match (row.kind, joint) {
            (Kind::Owner(owner), None) => opened = Some(owner),
            (Kind::Owner(owner), Some(_)) if on_triangle => opened = Some(owner),
            (_, Some(joint)) if ui.input(|i| i.modifiers.shift) => session.toggle_selected(joint),
            (_, Some(joint)) => session.select(Some(joint)),
            _ => {}
        }
    }
    if let Some(owner) = opened {
        dope.toggle_open(owner);
    }
}

fn joint_of(kind: Kind) -> Option<JointId> {
    let owner = match kind {
        Kind::Summary => return None,
        Kind::Owner(owner) => owner,
        Kind::Lane(lane) => lane.owner(),
    };
    match owner {
        Owner::Joint(joint) => Some(joint),
        _ => None,
    }
}

fn paint_sheet(ui: &Ui, room: &Room, response: &Response, session: &Session, dope: &Dope) {
    let Some(authored) = session.authored() else {
        return;
    };
    let palette = Palette::in_ui(ui);
    let painter = ui.painter().with_clip_rect(room.body);
    let pointer = response.hover_pos().filter(|_| !dope.is_busy());
    let hovered = pointer.and_then(|at| dope.mark_at(room, at));
    let column = Rect::from_min_max(room.body.min, room.body.max - vec2(BAR, 0.0));
    let placed = in_view(dope, room, column);
    for (index, rect, clip) in &placed {
        let row = &dope.rows[*index];
        let joint = joint_of(row.kind);
        let is_selected = joint.is_some_and(|joint| session.selection().contains(&joint));
        let painter = painter.with_clip_rect(clip.intersect(room.body));
        paint::ground(&painter, *rect, row, is_selected, &palette);
    }
    paint_ground(ui, &room.axis, session);
    for (index, rect, clip) in &placed {
        let row = &dope.rows[*index];
        let painter = painter.with_clip_rect(clip.expand2(vec2(0.0, 2.0)).intersect(room.body));
        let on_row = hovered
            .filter(|(row, _)| row == index)
            .map(|(_, mark)| mark);
        let look = (authored.selection(), on_row);
        paint::marks(&painter, &room.axis, (rect.center().y, row), look, &palette);
    }
    if let Some(places) = grips(room, session) {
        paint::grips(&painter, places, &palette);
    }
    let to = ui.input(|i| i.pointer.latest_pos());
    if let (Some(boxed), Some(to)) = (&dope.boxed, to) {
        paint::selecting_box(&painter, boxed.rect(to), &palette);
    }
    let text = match &dope.held {
        Some(held) if held.until == Until::Click => {
            "Click or Enter: here  \u{b7}  Esc: give up  \u{b7}  Ctrl: between frames"
        }
        _ if dope.wants_box => "Drag a box  \u{b7}  Esc: give up",
        _ => "",
    };
    if !text.is_empty() {
        paint::hint(&painter, room.body, text, &palette);
    }
    if let Some((row, mark)) = hovered {
        tooltip(ui, room, response, &dope.rows[row].marks[mark]);
    }
}

fn tooltip(ui: &Ui, room: &Room, response: &Response, mark: &rows::Mark) {
    ui.ctx().set_cursor_icon(CursorIcon::PointingHand);
    let way = mark.interpolation.map_or("various", name_of);
    let text = format!(
        "frame {}  \u{b7}  {}  \u{b7}  {way}",
        room.axis.frame(mark.secs),
        super::counted(mark.keys.len())
    );
    response.clone().on_hover_text_at_pointer(text);
}
