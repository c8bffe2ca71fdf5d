//! The timeline: what is authored, over time. The dope sheet shows when keys are, the graph editor how
//! values go between them.

pub mod axis;
mod bar;
mod begin;
pub mod dope;
pub mod graph;
mod menu;

use egui::{Pos2, Rect, Ui, pos2};
use posekit::keyframe::edit::SAME_TIME_SECS;

use super::Asked;
use crate::command::KeysCommand;
use crate::state::animate::edit::clipboard::{Clipboard, mirrored};
use crate::state::animate::{Authored, KeyId, Owner};
use crate::state::session::Session;
use crate::theme::{GAP, Palette};
use axis::{Axis, RULER_HEIGHT, TimeView};
use dope::Dope;
use graph::GraphPanel;
use menu::Menu;

/// Width of the column of names.
const NAMES_WIDTH: f32 = 176.0;

/// What the timeline shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// When keys are.
    #[default]
    DopeSheet,
    /// How values go between keys.
    Graph,
}

impl Tab {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 2] = [Self::DopeSheet, Self::Graph];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::DopeSheet => "Dope sheet",
            Self::Graph => "Graph",
        }
    }
}

/// Where a view of keys is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// The column of names.
    pub names: Rect,
    /// Where keys are.
    pub body: Rect,
    /// Where times are in it.
    pub axis: Axis,
}

/// What the timeline remembers from picture to picture.
#[derive(Debug, Default)]
pub struct Timeline {
    /// Which view of keys is shown.
    pub tab: Tab,
    /// What of time is seen, in all views.
    pub time: TimeView,
    /// The dope sheet.
    pub dope: Dope,
    clipboard: Clipboard,
    begin: begin::Begin,
    bar: bar::Bar,
    graph: GraphPanel,
    menu: Option<(Menu, Pos2)>,
    /// Where it was in the last picture, and its axis.
    rect: Option<Rect>,
    axis: Option<Axis>,
    pointer: Option<Pos2>,
    is_waiting: bool,
}

impl Timeline {
    /// Where it was in the last picture: keys that are pressed with the pointer there are about keys of
    /// the animation.
    #[must_use]
    pub fn rect(&self) -> Option<Rect> {
        self.rect
    }

    /// Its axis in the last picture of the dope sheet.
    #[must_use]
    pub fn axis(&self) -> Option<Axis> {
        self.axis
    }

    /// Tells whether a clip is about to get its keys.
    pub fn set_waiting(&mut self, is_waiting: bool) {
        self.is_waiting = is_waiting;
    }

    /// Whether a clip is about to get its keys.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        self.is_waiting
    }

    /// The window has no timeline now.
    pub fn hide(&mut self) {
        self.rect = None;
        self.menu = None;
        self.dope.confirm();
        self.graph.confirm();
    }

    /// Whether something follows the pointer or is open, so that Esc and Enter are about that.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.menu.is_some() || self.dope.is_busy() || self.graph.is_busy()
    }

    /// Esc: gives up what follows the pointer, closes what is open.
    pub fn cancel(&mut self, session: &mut Session) {
        if self.menu.take().is_none() {
            self.dope.cancel(session);
            self.graph.cancel(session);
        }
    }

    /// Takes the keys that say along which axis keys of the graph follow the pointer.
    pub fn take_lock_keys(&mut self, input: &mut egui::InputState) {
        if self.graph.is_busy() {
            self.graph.take_lock_keys(input);
        }
    }

    /// The graph editor, to look at.
    #[must_use]
    pub fn graph(&self) -> &GraphPanel {
        &self.graph
    }

    /// Enter: lets what follows the pointer be where it is.
    pub fn confirm(&mut self) {
        self.menu = None;
        self.dope.confirm();
        self.graph.confirm();
    }

    /// Does what a command asks of the keys. What is to be put into the system's clipboard, so that it
    /// knows that there is something to paste.
    pub fn run(&mut self, command: KeysCommand, session: &mut Session) -> Option<String> {
        if self.tab == Tab::Graph && self.graph.run(command) {
            return None;
        }
        match command {
            KeysCommand::SelectAll => {
                session.author(|authored| {
                    let all = all_keys(authored).collect();
                    authored.select(all);
                });
            }
            KeysCommand::SelectNone => {
                session.author(|authored| authored.select([].into()));
            }
            KeysCommand::Copy => return self.copy(session),
            KeysCommand::Paste => self.paste(session, "Paste", false),
            KeysCommand::PasteMirrored => self.paste(session, "Paste left for right", true),
            KeysCommand::Mirror => mirror(session),
            KeysCommand::Interpolation => self.open(Menu::Interpolation),
            KeysCommand::Tangents => self.open(Menu::Tangents),
            KeysCommand::Extrapolation => self.open(Menu::Extrapolation),
            KeysCommand::ViewAll => self.view(session, false),
            KeysCommand::ViewSelected => self.view(session, true),
            KeysCommand::NextKey => go_to_key(session, true),
            KeysCommand::PreviousKey => go_to_key(session, false),
            command => {
                self.dope.run(command, session);
            }
        }
        None
    }

    fn open(&mut self, menu: Menu) {
        self.menu = self.pointer.map(|at| (menu, at));
    }

    fn copy(&mut self, session: &Session) -> Option<String> {
        let authored = session.authored()?;
        let copied = Clipboard::of(authored, authored.selection());
        if copied.is_empty() {
            return None;
        }
        let text = format!("posekit: {}", counted(copied.len()));
        self.clipboard = copied;
        Some(text)
    }

    fn paste(&self, session: &mut Session, verb: &str, left_for_right: bool) {
        session.author(|authored| {
            let at = authored.snapped(authored.now_secs());
            let edit = self.clipboard.paste(authored, at, left_for_right);
            if let Some(edit) = edit {
                let name = format!("{verb}: {}", counted(edit.selection.len()));
                authored.set_tracks(&name, None, edit.changes, edit.selection);
            }
        });
    }

    fn view(&mut self, session: &Session, selected: bool) {
        let (Some(authored), Some(axis)) = (session.authored(), self.axis) else {
            return;
        };
        let chosen: Vec<KeyId> = if selected {
            authored.selection().iter().copied().collect()
        } else {
            all_keys(authored).collect()
        };
        let times = chosen.into_iter().filter_map(|key| authored.time_of(key));
        let span = times
            .map(|time| [time, time])
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        match span.filter(|_| selected) {
            Some(span) => self.time.fit(span, &axis),
            None => self.time.fit_all(span, session.scene_secs(), &axis),
        }
    }
}

fn all_keys(authored: &Authored) -> impl Iterator<Item = KeyId> {
    authored.lanes().into_iter().flat_map(|lane| {
        let count = authored.track(lane).map_or(0, |track| track.key_count());
        (0..count).map(move |index| KeyId { lane, index })
    })
}

fn mirror(session: &mut Session) {
    session.author(|authored| {
        let keys = authored.selection().clone();
        if let Some(edit) = mirrored(authored, &keys) {
            let name = format!("Mirror {}", counted(keys.len()));
            authored.set_tracks(&name, None, edit.changes, edit.selection);
        }
    });
}

/// Shows the time of the nearest key on one side of the playhead: of the selected joints, where there
/// are any with keys, otherwise of everything.
fn go_to_key(session: &mut Session, forward: bool) {
    let Some(authored) = session.authored() else {
        return;
    };
    let now = session.scene_secs();
    let joints = session.selection().iter().copied().map(Owner::Joint);
    let mut lanes: Vec<_> = joints
        .flat_map(Owner::lanes)
        .filter(|lane| authored.track(*lane).is_some())
        .collect();
    if lanes.is_empty() {
        lanes = authored.lanes();
    }
    let tracks = lanes.into_iter().filter_map(|lane| authored.track(lane));
    let times = tracks.flat_map(|track| track.times_secs().to_vec());
    let there = if forward {
        let after = times.filter(|time| *time > now + SAME_TIME_SECS);
        after.reduce(f64::min)
    } else {
        let before = times.filter(|time| *time < now - SAME_TIME_SECS);
        before.reduce(f64::max)
    };
    if let Some(there) = there {
        session.go_to_scene_secs(there);
    }
}

/// So many keys, in words.
fn counted(count: usize) -> String {
    match count {
        1 => "1 key".to_owned(),
        count => format!("{count} keys"),
    }
}

/// Shows the timeline in all the room that is left.
pub fn show(ui: &mut Ui, session: &mut Session, timeline: &mut Timeline, asked: &mut Asked) {
    timeline.rect = Some(ui.max_rect());
    if timeline.is_waiting {
        ui.add_space(GAP);
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label("Reducing the motion to keys\u{2026}");
        });
        ui.take_available_space();
        return;
    }
    if session.authored().is_none() {
        egui::ScrollArea::vertical()
            .auto_shrink([false, false])
            .show(ui, |ui| {
                begin::show(ui, session, &mut timeline.begin, asked)
            });
        return;
    }
    bar::show(ui, session, timeline, asked);
    let rect = ui.available_rect_before_wrap();
    // All of it is the panel's, or it would shrink to its bar.
    ui.allocate_rect(rect, egui::Sense::hover());
    let pointer = ui.input(|i| i.pointer.hover_pos());
    let is_here = |at: &Pos2| timeline.rect.is_some_and(|rect| rect.contains(*at));
    timeline.pointer = pointer.filter(is_here).or(timeline.pointer);
    match timeline.tab {
        Tab::DopeSheet => show_dope(ui, rect, session, timeline),
        Tab::Graph => {
            let (panel, time) = (&mut timeline.graph, &mut timeline.time);
            graph::show(ui, rect, session, panel, time, asked);
        }
    }
    show_menu(ui, session, timeline);
}

fn show_dope(ui: &mut Ui, rect: Rect, session: &mut Session, timeline: &mut Timeline) {
    let names_width = NAMES_WIDTH.min(0.35 * rect.width());
    let (names, keys) = rect.split_left_right_at_x(rect.left() + names_width);
    let (ruler, body) = keys.split_top_bottom_at_y(rect.top() + RULER_HEIGHT);
    let names = Rect::from_min_max(pos2(names.left(), body.top()), names.max);
    let Some(axis) = session
        .authored()
        .map(|authored| timeline.time.axis(body, authored))
    else {
        return;
    };
    timeline.axis = Some(axis);
    timeline.time.follow_playhead(&axis, session);
    axis::ruler(ui, &mut timeline.time, &axis, ruler, session);
    let room = Room { names, body, axis };
    ui.painter()
        .rect_filled(body, 0.0, Palette::in_ui(ui).panel);
    dope::show(ui, &room, session, &mut timeline.dope, &mut timeline.time);
}

/// The menu that a key has opened, where the pointer was.
fn show_menu(ui: &Ui, session: &mut Session, timeline: &mut Timeline) {
    let Some((menu, at)) = timeline.menu else {
        return;
    };
    let area = egui::Area::new(ui.scope_id().with("keys menu"))
        .order(egui::Order::Foreground)
        .constrain(true)
        .pivot(egui::Align2::LEFT_BOTTOM)
        .fixed_pos(at);
    let shown = area.show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style())
            .show(ui, |ui| menu::show(ui, menu, session))
            .inner
    });
    if shown.inner || shown.response.clicked_elsewhere() {
        timeline.menu = None;
    }
}
