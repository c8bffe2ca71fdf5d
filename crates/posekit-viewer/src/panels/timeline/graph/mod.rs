//! The graph editor: channels of keyed properties as curves over time, their keys and handles.

mod fields;
mod keys;
mod list;
mod menus;
mod paint;
mod plane;
mod pointer;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use egui::{Rect, Sense, Ui, UiBuilder, pos2};

use crate::command::KeysCommand;
use crate::panels::Asked;
use crate::panels::timeline::axis::{self, Axis, TimeView};
use crate::state::animate::Lane;
use crate::state::animate::channel::{Channels, Sampled};
use crate::state::animate::graph::{ChannelId, DotId, Graph};
use crate::state::session::Session;
use crate::theme::GAP;
use plane::{Plane, ValueView};
use pointer::Pointing;

/// Width of the list of channels.
const LIST_WIDTH: f32 = 190.0;

/// Width of the numbers of the selected key.
const FIELDS_WIDTH: f32 = 172.0;

/// Under this width the numbers of the selected key are left out.
const FIELDS_LEAST: f32 = 760.0;

/// Points from one place of a drawn curve to the next.
const CURVE_STEP: f32 = 1.5;

/// Room left of the plot for the labels of values.
const LABELS_WIDTH: f32 = 46.0;

/// What the graph editor remembers.
#[derive(Debug, Default)]
pub struct GraphPanel {
    graph: Graph,
    values: Option<ValueView>,
    /// What was seen when the values were taken into view last.
    fitted: BTreeSet<ChannelId>,
    lines: BTreeMap<Lane, Line>,
    pointing: Option<Pointing>,
    asked: Vec<KeysCommand>,
    /// Where the menu of the right button is, while it is open.
    menu: Option<egui::Pos2>,
    /// The button that is down has let go of something: it asks for nothing more.
    press_is_spent: bool,
    /// Of the number that is dragged.
    field_gesture: Option<crate::state::edit::Gesture>,
    plane: Option<Plane>,
}

/// A lane's curves as they were drawn last.
#[derive(Clone, Debug)]
struct Line {
    channels: Arc<Channels>,
    span_secs: [f64; 2],
    sampled: Arc<Sampled>,
}

impl GraphPanel {
    /// What is shown, to look at.
    #[must_use]
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Where a dot is on the screen, once it was shown.
    #[must_use]
    pub fn dot_on_screen(&self, dot: DotId) -> Option<egui::Pos2> {
        Some(self.plane?.pos(self.graph.place(dot)?))
    }

    /// Where a handle is on the screen, once it was shown.
    #[must_use]
    pub fn handle_on_screen(
        &self,
        handle: crate::state::animate::graph::HandleId,
    ) -> Option<egui::Pos2> {
        Some(self.plane?.pos(self.graph.handle_place(handle)?))
    }

    /// Where the plot is on the screen, once it was shown.
    #[must_use]
    pub fn plot_rect(&self) -> Option<Rect> {
        self.plane.map(|plane| plane.rect)
    }

    /// A lane's curves over a span, made anew only when either has changed.
    fn sampled(&mut self, lane: Lane, channels: &Arc<Channels>, plane: &Plane) -> Arc<Sampled> {
        let span_secs = plane.axis.seen_secs();
        if let Some(line) = self.lines.get(&lane)
            && Arc::ptr_eq(&line.channels, channels)
            && line.span_secs == span_secs
        {
            return Arc::clone(&line.sampled);
        }
        let step = plane.axis.secs_of(CURVE_STEP);
        let sampled = Arc::new(channels.sampled(span_secs, step));
        let line = Line {
            channels: Arc::clone(channels),
            span_secs,
            sampled: Arc::clone(&sampled),
        };
        self.lines.insert(lane, line);
        sampled
    }

    /// Takes all values that are seen into view when other channels are seen than before.
    fn fit_new(&mut self) {
        let seen: BTreeSet<ChannelId> = self.graph.seen().map(|(id, _)| id).collect();
        if (self.values.is_none() || seen != self.fitted) && !seen.is_empty() {
            self.fit_values(self.graph.dots().collect());
            self.fitted = seen;
        }
    }

    /// Takes the values of dots, and of the curves between them, into view.
    fn fit_values(&mut self, dots: Vec<DotId>) {
        let Some([times, values]) = self.graph.extent(dots.iter().copied()) else {
            return;
        };
        let channels: BTreeSet<ChannelId> = dots.iter().map(|dot| dot.channel()).collect();
        let mut extent = values;
        for id in channels {
            let Some(curves) = self.graph.curves().get(&id.lane) else {
                continue;
            };
            let step = ((times[1] - times[0]) / 400.0).max(1e-4);
            if let Some([low, high]) = curves.sampled(times, step).extent(id.channel) {
                extent = [extent[0].min(low), extent[1].max(high)];
            }
        }
        self.values = Some(ValueView::of(extent));
    }

    /// Takes the range, the playhead and all keys into view.
    fn view_all(&mut self, time: &mut TimeView, axis: &Axis, playhead_secs: f64) {
        let dots: BTreeSet<DotId> = self.graph.dots().collect();
        let extent = self.graph.extent(dots.iter().copied());
        time.fit_all(extent.map(|[times, _]| times), playhead_secs, axis);
        if extent.is_some() {
            self.fit_values(dots.into_iter().collect());
        }
    }

    /// Takes what is selected into view, or everything where nothing is.
    fn view_selected(&mut self, time: &mut TimeView, axis: &Axis, playhead_secs: f64) {
        let selected = self.graph.selected();
        let Some([times, _]) = self.graph.extent(selected.iter().copied()) else {
            self.view_all(time, axis, playhead_secs);
            return;
        };
        time.fit(times, axis);
        self.fit_values(selected.into_iter().collect());
    }
}

/// Shows the graph editor of the active clip's scene in a rectangle.
pub fn show(
    ui: &mut Ui,
    whole: Rect,
    session: &mut Session,
    panel: &mut GraphPanel,
    time: &mut TimeView,
    asked: &mut Asked,
) {
    panel.graph.update(session);
    panel.fit_new();
    let list = Rect::from_min_max(whole.min, pos2(whole.left() + LIST_WIDTH, whole.bottom()));
    let has_fields = whole.width() >= FIELDS_LEAST;
    let right = if has_fields {
        whole.right() - FIELDS_WIDTH - 2.0 * GAP
    } else {
        whole.right()
    };
    let plot = Rect::from_min_max(
        pos2(list.right() + GAP + LABELS_WIDTH, whole.top()),
        pos2(right, whole.bottom()),
    );
    in_rect(ui, list, |ui| list::show(ui, session, panel));
    if has_fields {
        let fields = Rect::from_min_max(pos2(right + 2.0 * GAP, whole.top()), whole.max);
        in_rect(ui, fields, |ui| fields::show(ui, session, panel));
    }
    show_plot(ui, plot, session, panel, (time, asked));
}

fn in_rect(ui: &mut Ui, rect: Rect, contents: impl FnOnce(&mut Ui)) {
    let mut inner = ui.new_child(UiBuilder::new().max_rect(rect));
    inner.set_clip_rect(rect.intersect(ui.clip_rect()));
    contents(&mut inner);
}

fn show_plot(
    ui: &mut Ui,
    whole: Rect,
    session: &mut Session,
    panel: &mut GraphPanel,
    (time, asked): (&mut TimeView, &mut Asked),
) {
    let (ruler, rect) = whole.split_top_bottom_at_y(whole.top() + axis::RULER_HEIGHT);
    let plane_now = |session: &Session, panel: &GraphPanel, time: &TimeView| {
        Some(Plane {
            rect,
            axis: time.axis(rect, session.authored()?),
            values: panel.values.unwrap_or(ValueView::of([-1.0, 1.0])),
        })
    };
    let Some(plane) = plane_now(session, panel, time) else {
        return;
    };
    time.follow_playhead(&plane.axis, session);
    axis::ruler(ui, time, &plane.axis, ruler, session);
    let response = ui.interact(rect, ui.scope_id().with("graph"), Sense::click_and_drag());
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::new(egui::Role::GraphicsDocument);
        info.label = Some("Curves of keys".to_owned());
        info
    });
    if panel.graph.curves().is_empty() {
        panel.plane = Some(plane);
        panel.asked.clear();
        paint::empty(ui, rect);
        return;
    }
    pointer::move_view(ui, &response, panel, time, &plane);
    for command in std::mem::take(&mut panel.asked) {
        keys::run(ui, command, session, panel, time, &plane);
    }
    let Some(plane) = plane_now(session, panel, time) else {
        return;
    };
    pointer::follow(ui, &response, session, panel, &plane);
    panel.plane = Some(plane);
    paint::show(ui, &response, session, panel, &plane);
    menus::show(ui, &response, session, panel, asked);
}
