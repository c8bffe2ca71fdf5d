//! The timeline: what is authored, over time. The dope sheet shows when keys are, the graph editor how
//! values go between them.

pub mod axis;
mod bar;
mod begin;

use egui::{Rect, Ui};

use super::Asked;
use crate::command::KeysCommand;
use crate::state::session::Session;
use axis::TimeView;

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
    /// Both, in the order in which they are offered.
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

/// What the timeline remembers from picture to picture.
#[derive(Debug, Default)]
pub struct Timeline {
    /// Which view of keys is shown.
    pub tab: Tab,
    /// What of time is seen, in both views.
    pub time: TimeView,
    begin: begin::Begin,
    bar: bar::Bar,
    /// Where it was in the last picture.
    rect: Option<Rect>,
}

impl Timeline {
    /// Where it was in the last picture: keys that are pressed with the pointer there are about keys of
    /// the animation.
    #[must_use]
    pub fn rect(&self) -> Option<Rect> {
        self.rect
    }

    /// The window has no timeline now.
    pub fn hide(&mut self) {
        self.rect = None;
    }

    /// Whether a key or a playhead follows the pointer, so that Esc and clicks are about that.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        false
    }

    /// Does what a command asks of the keys.
    pub fn run(&mut self, command: KeysCommand, session: &mut Session) {
        let _ = (command, session);
    }
}

/// Shows the timeline in all the room that is left.
pub fn show(ui: &mut Ui, session: &mut Session, timeline: &mut Timeline, asked: &mut Asked) {
    timeline.rect = Some(ui.max_rect());
    if session.authored().is_none() {
        begin::show(ui, session, &mut timeline.begin, asked);
        return;
    }
    bar::show(ui, session, timeline, asked);
    let rect = ui.available_rect_before_wrap();
    let Some(axis) = session
        .authored()
        .map(|authored| timeline.time.axis(rect, authored))
    else {
        return;
    };
    let (ruler, _) = rect.split_top_bottom_at_y(rect.top() + axis::RULER_HEIGHT);
    axis::ruler(ui, &mut timeline.time, &axis, ruler, session);
    axis::paint_ground(ui, &axis, session);
}
