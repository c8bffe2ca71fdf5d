//! The time axis that the dope sheet and the graph editor share: what of time is seen, the ruler with
//! the playhead, and the ends of the scene's range.

use egui::{
    Align2, CursorIcon, FontId, PointerButton, Rect, Response, Sense, Stroke, Ui, pos2, vec2,
};

use posekit::keyframe::edit::SAME_TIME_SECS;

use crate::panels::transport::clock_text;
use crate::state::animate::Authored;
use crate::state::edit::Gesture;
use crate::state::session::Session;
use crate::theme::Palette;

/// Height of the ruler.
pub const RULER_HEIGHT: f32 = 24.0;

/// Room beside the ends of the range when all of it is taken into view, points.
const MARGIN: f32 = 18.0;

/// How much of the wheel, in points, makes things twice as large.
const POINTS_PER_DOUBLING: f32 = 220.0;

/// How many points a frame may take at most, and how many hours a point.
const SECS_PER_POINT: std::ops::RangeInclusive<f64> = 2e-5..=10.0;

/// How near the pointer must be to an end of the range, points.
const HANDLE_REACH: f32 = 6.0;

/// What of time is seen. It stays from picture to picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimeView {
    /// The time at the left edge, seconds of the scene, and the seconds of a point; `None` while all of
    /// the range is taken into view.
    seen: Option<(f64, f64)>,
    held: Option<Held>,
    /// Where the playhead was when it was looked at last.
    playhead_secs: Option<f64>,
}

/// What is dragged on the ruler.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Held {
    Playhead,
    /// An end of the range, 0 or 1, and the gesture that drags it.
    End(usize, Gesture),
}

/// Where times are on the screen, in one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The room that keys are drawn in.
    pub rect: Rect,
    start_secs: f64,
    secs_per_point: f64,
    /// The scene's range, seconds.
    pub range_secs: [f64; 2],
    /// The time between two frames, seconds.
    pub frame_secs: f64,
}

impl TimeView {
    /// The axis in a rectangle.
    #[must_use]
    pub fn axis(&self, rect: Rect, authored: &Authored) -> Axis {
        let range_secs = authored.scene().range_secs;
        let frame_secs = authored.frame_secs();
        let (start_secs, secs_per_point) = self
            .seen
            .unwrap_or_else(|| fitted(range_secs, rect.width(), frame_secs));
        Axis {
            rect,
            start_secs,
            secs_per_point,
            range_secs,
            frame_secs,
        }
    }

    /// Takes all of the scene's range into view, from now on.
    pub fn fit_range(&mut self) {
        self.seen = None;
    }

    /// Takes a stretch of time into view.
    pub fn fit(&mut self, secs: [f64; 2], axis: &Axis) {
        self.seen = Some(fitted(secs, axis.rect.width(), axis.frame_secs));
    }

    /// Takes the scene's range, the playhead, and keys beyond them into view.
    pub fn fit_all(&mut self, keys: Option<[f64; 2]>, playhead_secs: f64, axis: &Axis) {
        let [start, end] = axis.range_secs;
        let [first, last] = keys.unwrap_or(axis.range_secs);
        let low = start.min(first).min(playhead_secs);
        let high = end.max(last).max(playhead_secs);
        if (low - start).abs() <= SAME_TIME_SECS && (high - end).abs() <= SAME_TIME_SECS {
            // As long as nothing else is asked for, the range stays in view however it is dragged.
            self.fit_range();
        } else {
            self.fit([low, high], axis);
        }
    }

    /// Brings the playhead into view where it has jumped out of it. What moves under it while it plays
    /// does not drag the view along.
    pub fn follow_playhead(&mut self, axis: &Axis, session: &Session) {
        let now = session.scene_secs();
        let before = self.playhead_secs.replace(now);
        let has_jumped = before.is_some_and(|before| (before - now).abs() > SAME_TIME_SECS);
        if !has_jumped || session.transport.is_playing() || self.held.is_some() {
            return;
        }
        let [left, right] = axis.seen_secs();
        let margin = axis.secs_of(MARGIN).min(0.5 * (right - left));
        let out = if now < left {
            now - margin - left
        } else if now > right {
            now + margin - right
        } else {
            return;
        };
        self.seen = Some((left + out, axis.secs_per_point));
    }

    /// Zoom with the wheel or a pinch about the pointer; move with the middle button, with shift and the
    /// wheel, or with a sideways wheel. `response` is that of what lies under the axis.
    pub fn interact(&mut self, ui: &Ui, response: &Response, axis: &Axis) {
        if response.dragged_by(PointerButton::Middle) {
            self.pan(axis, -response.drag_delta().x);
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        if !response.contains_pointer() {
            return;
        }
        let (scroll, pinch, shift, pointer) = ui.input(|i| {
            let scroll = i.smooth_scroll_delta();
            (
                scroll,
                i.zoom_delta(),
                i.modifiers.shift,
                i.pointer.hover_pos(),
            )
        });
        if shift || scroll.x != 0.0 {
            self.pan(axis, -(scroll.x + if shift { scroll.y } else { 0.0 }));
            return;
        }
        let factor = libm::exp2f(scroll.y / POINTS_PER_DOUBLING) * pinch;
        if let Some(pointer) = pointer
            && (factor - 1.0).abs() > 1e-4
        {
            self.zoom(axis, pointer.x, factor);
        }
    }

    /// Moves what is seen.
    pub fn pan(&mut self, axis: &Axis, points: f32) {
        if points != 0.0 {
            let start = axis.start_secs + f64::from(points) * axis.secs_per_point;
            self.seen = Some((start, axis.secs_per_point));
        }
    }

    /// Makes everything larger by a factor; what is at `x` stays there.
    pub fn zoom(&mut self, axis: &Axis, x: f32, factor: f32) {
        let [low, high] = [*SECS_PER_POINT.start(), *SECS_PER_POINT.end()];
        let secs_per_point = (axis.secs_per_point / f64::from(factor)).clamp(low, high);
        let start = axis.secs_at(x) - f64::from(x - axis.rect.left()) * secs_per_point;
        self.seen = Some((start, secs_per_point));
    }
}

/// Left edge and seconds of a point with which a stretch of time fills a width.
fn fitted([start, end]: [f64; 2], width: f32, frame_secs: f64) -> (f64, f64) {
    let room = f64::from((width - 2.0 * MARGIN).max(20.0));
    // A stretch of nothing is shown with some frames around it.
    let span = (end - start).max(4.0 * frame_secs);
    let secs_per_point = (span / room).clamp(*SECS_PER_POINT.start(), *SECS_PER_POINT.end());
    let middle = 0.5 * (start + end);
    let left = middle - 0.5 * (room + 2.0 * f64::from(MARGIN)) * secs_per_point;
    (left, secs_per_point)
}

impl Axis {
    /// Where a time is.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a place on the screen; far outside it any place does"
    )]
    pub fn x(&self, secs: f64) -> f32 {
        let points = (secs - self.start_secs) / self.secs_per_point;
        self.rect.left() + points.clamp(-1e6, 1e6) as f32
    }

    /// What time is at a place.
    #[must_use]
    pub fn secs_at(&self, x: f32) -> f64 {
        self.start_secs + f64::from(x - self.rect.left()) * self.secs_per_point
    }

    /// Seconds of a distance on the screen.
    #[must_use]
    pub fn secs_of(&self, points: f32) -> f64 {
        f64::from(points) * self.secs_per_point
    }

    /// The frame's time nearest to a time.
    #[must_use]
    pub fn snapped(&self, secs: f64) -> f64 {
        let frames = ((secs - self.range_secs[0]) / self.frame_secs).round();
        self.range_secs[0] + frames * self.frame_secs
    }

    /// The frame nearest to a time, counted from the start of the range; it may be negative.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a float cast saturates; no scene has that many frames"
    )]
    pub fn frame(&self, secs: f64) -> i64 {
        ((secs - self.range_secs[0]) / self.frame_secs).round() as i64
    }

    /// The times at both edges.
    #[must_use]
    pub fn seen_secs(&self) -> [f64; 2] {
        [
            self.secs_at(self.rect.left()),
            self.secs_at(self.rect.right()),
        ]
    }

    /// The times and numbers of frames that get a mark: as many as fit without crowding.
    #[must_use]
    pub fn marks(&self) -> Vec<(f64, i64)> {
        const ROOM: f32 = 56.0;
        let least = self.secs_of(ROOM) / self.frame_secs;
        let step = round_step(least);
        let [first, last] = self.seen_secs().map(|secs| self.frame(secs));
        let mut frame = first.div_euclid(step) * step;
        let mut marks = Vec::new();
        while frame <= last && marks.len() < 400 {
            marks.push((self.range_secs[0] + whole(frame) * self.frame_secs, frame));
            frame += step;
        }
        marks
    }
}

/// A number of frames that people count in, at least so many.
#[allow(
    clippy::cast_possible_truncation,
    reason = "a float cast saturates; the step is large enough then"
)]
fn round_step(least: f64) -> i64 {
    let mut power = 1_i64;
    loop {
        for factor in [1, 2, 5] {
            let step = power.saturating_mul(factor);
            if whole(step) >= least || step >= i64::MAX / 20 {
                return step;
            }
        }
        power *= 10;
    }
}

/// A frame number as a factor.
#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
fn whole(frame: i64) -> f64 {
    frame as f64
}

/// Shows the ruler over the axis' room: frame numbers, the scene's range, the playhead. The pointer
/// drags the playhead and the ends of the range; a double click shows all of the range.
pub fn ruler(ui: &mut Ui, view: &mut TimeView, axis: &Axis, rect: Rect, session: &mut Session) {
    let id = ui.scope_id().with("ruler");
    let response = ui.interact(rect, id, Sense::click_and_drag());
    let label = "Ruler: drag to move the playhead, drag the ends of the range";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, label));
    drag(ui, view, axis, &response, session);
    view.interact(ui, &response, axis);
    if response.double_clicked() {
        view.fit_range();
    }
    paint(ui, axis, rect, session, &response);
}

fn drag(ui: &Ui, view: &mut TimeView, axis: &Axis, response: &Response, session: &mut Session) {
    let pointer = response.interact_pointer_pos().or(response.hover_pos());
    let Some(pointer) = pointer else {
        return;
    };
    let near = |end: usize| (pointer.x - axis.x(axis.range_secs[end])).abs() <= HANDLE_REACH;
    let under = (near(1).then_some(1)).or(near(0).then_some(0));
    // The handles are in the lower half; the playhead is taken above them.
    let under = under.filter(|_| pointer.y > response.rect.center().y);
    if under.is_some() || matches!(view.held, Some(Held::End(..))) {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    // A quick click goes down and up within one picture.
    let is_taken = response.is_pointer_button_down_on() || response.clicked();
    if is_taken && ui.input(|i| i.pointer.primary_pressed()) {
        // While an end is dragged the view does not follow it, or it would run away from the pointer.
        if under.is_some() {
            view.seen = Some((axis.start_secs, axis.secs_per_point));
        }
        view.held = match under {
            Some(end) => session
                .author(Authored::gesture)
                .map(|gesture| Held::End(end, gesture)),
            None => Some(Held::Playhead),
        };
    }
    let free = ui.input(|i| i.modifiers.ctrl || i.modifiers.command);
    let at = axis.secs_at(pointer.x);
    let time = if free { at } else { axis.snapped(at) };
    match view.held {
        Some(Held::Playhead) => session.go_to_scene_secs(time),
        Some(Held::End(end, gesture)) => set_end(session, end, time, axis.frame_secs, gesture),
        None => {}
    }
    if !ui.input(|i| i.pointer.primary_down()) {
        view.held = None;
    }
}

fn set_end(session: &mut Session, end: usize, time: f64, frame_secs: f64, gesture: Gesture) {
    let name = if end == 0 {
        "Set the start of the range"
    } else {
        "Set the end of the range"
    };
    session.author(|authored| {
        let mut range = authored.scene().range_secs;
        // At least two frames, or there is nothing to play.
        range[end] = if end == 0 {
            time.min(range[1] - frame_secs)
        } else {
            time.max(range[0] + frame_secs)
        };
        // A range alone cannot fail to fit.
        drop(authored.edit_scene(name, Some(gesture), |scene| scene.range_secs = range));
    });
}

fn paint(ui: &Ui, axis: &Axis, rect: Rect, session: &Session, response: &Response) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, 0.0, palette.sunken);
    let [start, end] = axis.range_secs.map(|secs| axis.x(secs));
    let band = Rect::from_min_max(pos2(start, rect.bottom() - 6.0), pos2(end, rect.bottom()));
    painter.rect_filled(band, 2.0, palette.accent_soft);
    for x in [start, end] {
        let handle = Rect::from_center_size(pos2(x, band.center().y - 2.0), vec2(5.0, 11.0));
        painter.rect_filled(handle, 2.0, palette.accent.gamma_multiply(0.7));
    }
    let now = session.scene_secs();
    let text = axis.frame(now).to_string();
    let galley = painter.layout_no_wrap(text, FontId::proportional(11.0), palette.panel);
    let flag = Rect::from_center_size(
        pos2(axis.x(now), rect.top() + 8.0),
        galley.size() + vec2(10.0, 2.0),
    );
    let font = FontId::proportional(10.5);
    for (secs, frame) in axis.marks() {
        let x = axis.x(secs);
        let foot = rect.bottom() - 6.0;
        painter.line_segment(
            [pos2(x, foot - 4.0), pos2(x, foot)],
            Stroke::new(1.0, palette.quiet),
        );
        let number = painter.layout_no_wrap(frame.to_string(), font.clone(), palette.quiet);
        let place = Align2::CENTER_TOP.anchor_size(pos2(x, rect.top() + 1.0), number.size());
        // Under the playhead's flag, which has the number, and at the ends only half of it would be seen.
        let is_whole =
            rect.x_range().contains(place.left()) && rect.x_range().contains(place.right());
        if is_whole && !place.expand(2.0).intersects(flag) {
            painter.galley(place.min, number, palette.quiet);
        }
    }
    painter.rect_filled(flag, 4.0, palette.accent);
    painter.galley(flag.center() - galley.size() / 2.0, galley, palette.panel);
    if let Some(pointer) = response.hover_pos().filter(|_| !response.dragged()) {
        let secs = axis.secs_at(pointer.x);
        let text = format!(
            "frame {}  \u{b7}  {}",
            axis.frame(secs),
            clock_text(secs - axis.range_secs[0])
        );
        response.clone().on_hover_text_at_pointer(text);
    }
}

/// Draws what lies behind keys: the scene's range, a line for each mark, and the playhead.
pub fn paint_ground(ui: &Ui, axis: &Axis, session: &Session) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter().with_clip_rect(axis.rect);
    let [start, end] = axis.range_secs.map(|secs| axis.x(secs));
    let outside = palette.sunken.gamma_multiply(0.8);
    let (left, right) = (axis.rect.left(), axis.rect.right());
    for (from, to) in [(left, start.min(right)), (end.max(left), right)] {
        if to > from {
            let shade = Rect::from_x_y_ranges(from..=to, axis.rect.y_range());
            painter.rect_filled(shade, 0.0, outside);
        }
    }
    for (secs, _) in axis.marks() {
        painter.vline(
            axis.x(secs),
            axis.rect.y_range(),
            Stroke::new(1.0, palette.line.gamma_multiply(0.6)),
        );
    }
    painter.vline(
        axis.x(session.scene_secs()),
        axis.rect.y_range(),
        Stroke::new(1.4, palette.accent),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(view: &TimeView) -> Axis {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(800.0, 200.0));
        let (start_secs, secs_per_point) = view
            .seen
            .unwrap_or_else(|| fitted([1.0, 3.0], rect.width(), 0.1));
        Axis {
            rect,
            start_secs,
            secs_per_point,
            range_secs: [1.0, 3.0],
            frame_secs: 0.1,
        }
    }

    #[test]
    fn places_and_times_are_each_others_inverse_at_every_zoom() {
        let mut view = TimeView::default();
        for (x, factor) in [(300.0, 1.7), (850.0, 0.2), (120.0, 30.0)] {
            let before = axis(&view);
            let fixed = before.secs_at(x);
            view.zoom(&before, x, factor);
            let after = axis(&view);
            assert!((after.secs_at(x) - fixed).abs() < 1e-6, "{x} stays");
            for secs in after.seen_secs() {
                assert!((after.secs_at(after.x(secs)) - secs).abs() < 1e-3 * factor as f64 + 1e-4);
            }
        }
    }

    #[test]
    fn all_of_the_range_is_in_view_at_first() {
        let axis = axis(&TimeView::default());
        let [start, end] = axis.seen_secs();
        assert!(start < 1.0 && end > 3.0 && end - start < 2.2);
        assert_eq!(
            (axis.frame(1.04), axis.frame(0.9), axis.frame(3.0)),
            (0, -1, 20)
        );
        assert!((axis.snapped(1.26) - 1.3).abs() < 1e-9);
    }

    #[test]
    fn all_is_never_less_than_the_range_and_the_playhead() {
        let mut view = TimeView::default();
        let one_key = Some([1.0, 1.0]);
        view.fit_all(one_key, 2.0, &axis(&view));
        assert_eq!(view, TimeView::default());
        for (keys, now) in [(Some([0.5, 1.5]), 2.0), (None, 0.5), (one_key, 0.5)] {
            view.fit_all(keys, now, &axis(&view));
            let [start, end] = axis(&view).seen_secs();
            assert!(
                start < 0.5 && end > 3.0 && end - start < 2.8,
                "{start} {end}"
            );
        }
    }

    #[test]
    fn marks_are_round_and_not_crowded() {
        let mut view = TimeView::default();
        for factor in [1.0, 0.01, 40.0] {
            let before = axis(&view);
            view.zoom(&before, 400.0, factor);
            let axis = axis(&view);
            let marks = axis.marks();
            assert!(!marks.is_empty());
            for pair in marks.windows(2) {
                let apart = axis.x(pair[1].0) - axis.x(pair[0].0);
                assert!(apart >= 55.0, "{apart}");
            }
        }
    }
}
