//! The transport bar: play, step, scrub, speed, range.

use egui::{
    Align, Align2, Color32, CornerRadius, CursorIcon, FontId, Layout, Rect, Response, Sense,
    Stroke, Ui, Vec2, pos2, vec2,
};
use posekit::check::Severity;

use crate::command::Command;
use crate::icons::{Icon, icon_button, toggle_icon};
use crate::panels::{Asked, stay_open, tip};
use crate::state::clip::{index_to_f64, nearest_index};
use crate::state::mode::Mode;
use crate::state::session::Session;
use crate::state::transport::{AtEnd, SPEED_RANGE, SPEED_STEPS, Transport};
use crate::theme::{GAP, Palette};

/// Height of the time line.
const LINE_HEIGHT: f32 = 34.0;

/// Where less than this is left, as on a phone, the clock shows the time alone.
const CLOCK_ROOM: f32 = 420.0;

/// Under this width, that of an upright phone, the buttons have a line of their own.
const TWO_LINES: f32 = 440.0;

/// What the range's fields take.
const RANGE_ROOM: f32 = 150.0;

/// How near the pointer must be to a handle of the range, points.
const HANDLE_REACH: f32 = 6.0;

/// Shows the transport: the time line above, the buttons below. Returns where the frames are on the
/// time line.
pub fn show(ui: &mut Ui, session: &mut Session, asked: &mut Asked) -> Rect {
    ui.add_space(GAP);
    // While motion is authored the timeline's ruler is the time line.
    let is_elsewhere = session.mode() == Mode::Animate && session.authored().is_some();
    let track = if is_elsewhere {
        Rect::ZERO
    } else {
        let track = time_line(ui, session);
        ui.add_space(GAP);
        track
    };
    let is_narrow = ui.available_width() < TWO_LINES;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        buttons(ui, session, asked);
        if is_narrow {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                curves_button(ui, asked);
            });
            return;
        }
        ui.add_space(2.0 * GAP);
        clock(ui, &session.transport);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            curves_button(ui, asked);
            speed(ui, &mut session.transport);
            if ui.available_width() >= RANGE_ROOM {
                range(ui, &mut session.transport);
            }
        });
    });
    if is_narrow {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            clock(ui, &session.transport);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                speed(ui, &mut session.transport);
                range(ui, &mut session.transport);
            });
        });
    }
    ui.add_space(GAP);
    track
}

fn curves_button(ui: &mut Ui, asked: &mut Asked) {
    let says = tip("Curves", Command::ToggleCurves);
    if toggle_icon(ui, Icon::Curves, &says, asked.curves_open).clicked() {
        asked.command(Command::ToggleCurves);
    }
}

fn buttons(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let playing = session.transport.is_playing();
    let play = if playing {
        (Icon::Pause, "Pause", Command::TogglePlay)
    } else {
        (Icon::Play, "Play", Command::TogglePlay)
    };
    for (icon, says, command) in [
        (Icon::ToStart, "To the start", Command::GoToStart),
        (
            Icon::PreviousFrame,
            "Previous frame",
            Command::PreviousFrame,
        ),
        play,
        (Icon::NextFrame, "Next frame", Command::NextFrame),
        (Icon::ToEnd, "To the end", Command::GoToEnd),
    ] {
        if icon_button(ui, icon, &tip(says, command)).clicked() {
            asked.command(command);
        }
    }
    let loops = session.transport.at_end == AtEnd::Loop;
    let says = if loops { "Loops" } else { "Stops at the end" };
    let icon = if loops { Icon::Loop } else { Icon::Once };
    if toggle_icon(ui, icon, &tip(says, Command::ToggleLoop), loops).clicked() {
        asked.command(Command::ToggleLoop);
    }
}

/// Time and frame, in figures that do not dance.
fn clock(ui: &mut Ui, transport: &Transport) {
    let palette = Palette::in_ui(ui);
    let seconds = clock_text(transport.time_secs());
    let whole = clock_text(transport.duration_secs());
    let frame = transport.frame();
    let last = transport.last_frame();
    let time = egui::RichText::new(seconds)
        .monospace()
        .size(14.0)
        .color(palette.text);
    let rest = format!("/ {whole}");
    ui.label(time);
    if ui.available_width() < CLOCK_ROOM {
        return;
    }
    ui.label(egui::RichText::new(rest).monospace().color(palette.quiet));
    ui.add_space(2.0 * GAP);
    ui.label(egui::RichText::new("frame").color(palette.quiet));
    let width = last.max(1).ilog10() as usize + 1;
    ui.label(
        egui::RichText::new(format!("{frame:>width$}"))
            .monospace()
            .size(14.0),
    );
    ui.label(
        egui::RichText::new(format!("/ {last}"))
            .monospace()
            .color(palette.quiet),
    );
}

/// Seconds as `m:ss.hh`.
#[must_use]
pub fn clock_text(secs: f64) -> String {
    let hundredths = nearest_index(secs.max(0.0) * 100.0, usize::MAX);
    let (minutes, rest) = (hundredths / 6000, hundredths % 6000);
    format!("{minutes}:{:02}.{:02}", rest / 100, rest % 100)
}

fn speed(ui: &mut Ui, transport: &mut Transport) {
    let mut speed = transport.speed();
    let text = speed_text(speed);
    let button = egui::Button::new(egui::RichText::new(text).monospace());
    let (response, _) =
        stay_open(egui::containers::menu::MenuButton::from_button(button)).ui(ui, |ui| {
            ui.set_width(180.0);
            ui.label(egui::RichText::new("Speed").small().weak());
            let slider = egui::Slider::new(&mut speed, SPEED_RANGE)
                .logarithmic(true)
                .custom_formatter(|speed, _| speed_text(speed))
                .custom_parser(|text| text.trim_end_matches(['x', '\u{d7}']).trim().parse().ok());
            ui.add(slider);
            ui.horizontal_wrapped(|ui| {
                for step in SPEED_STEPS {
                    let chosen = (step - speed).abs() < 1e-6;
                    if ui.selectable_label(chosen, speed_text(step)).clicked() {
                        speed = step;
                    }
                }
            });
        });
    response.on_hover_text("Speed: [ slower, ] faster");
    if (speed - transport.speed()).abs() > 1e-9 {
        transport.set_speed(speed);
    }
}

/// A speed as people say it.
#[must_use]
pub fn speed_text(speed: f64) -> String {
    let text = format!("{speed:.2}");
    format!("{}\u{d7}", text.trim_end_matches('0').trim_end_matches('.'))
}

fn range(ui: &mut Ui, transport: &mut Transport) {
    let (first, last) = transport.range();
    if transport.is_range_limited() {
        let says = "The whole clip again (Alt+P)";
        if icon_button(ui, Icon::Close, says).clicked() {
            transport.clear_range();
        }
    }
    let text = format!("{first} \u{2013} {last}");
    let palette = Palette::in_ui(ui);
    let color = if transport.is_range_limited() {
        palette.accent
    } else {
        palette.quiet
    };
    ui.label(egui::RichText::new(text).monospace().color(color))
        .on_hover_text(
            "The frames that play, loop and are saved: drag the ends of the bar, or press I and O",
        );
    ui.label(egui::RichText::new("range").color(palette.quiet));
}

/// The time line, with its range, the findings, and the frame shown. Returns where the frames are.
fn time_line(ui: &mut Ui, session: &mut Session) -> Rect {
    let size = vec2(ui.available_width(), LINE_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let last = session.transport.last_frame();
    let frame = session.transport.frame();
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::slider(true, index_to_f64(frame), "Time line");
        info.enabled = last > 0;
        info
    });
    let line = Line { rect, last };
    scrub(ui, &response, &line, session);
    paint(ui, &response, &line, session);
    line.track()
}

/// Where frames are on the screen.
struct Line {
    rect: Rect,
    last: usize,
}

impl Line {
    fn track(&self) -> Rect {
        let inner = self.rect.shrink2(vec2(10.0, 0.0));
        Rect::from_min_max(
            pos2(inner.left(), inner.bottom() - 13.0),
            inner.right_bottom(),
        )
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "a share of 0 to 1 of a width on the screen"
    )]
    fn x(&self, frame: f64) -> f32 {
        let track = self.track();
        let share = if self.last > 0 {
            frame / index_to_f64(self.last)
        } else {
            0.0
        };
        track.left() + track.width() * share as f32
    }

    fn frame(&self, x: f32) -> usize {
        let track = self.track();
        let share = f64::from((x - track.left()) / track.width().max(1.0));
        nearest_index(share * index_to_f64(self.last), self.last)
    }
}

/// What a drag on the time line moves.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Grip {
    Time,
    First,
    Last,
}

fn scrub(ui: &Ui, response: &Response, line: &Line, session: &mut Session) {
    let Some(pointer) = response.interact_pointer_pos().or(response.hover_pos()) else {
        return;
    };
    let id = response.id.with("grip");
    let (first, last) = session.transport.range();
    let near = |frame: usize| (pointer.x - line.x(index_to_f64(frame))).abs() <= HANDLE_REACH;
    let in_track = pointer.y >= line.track().top();
    let under = match (in_track && near(first), in_track && near(last)) {
        (true, false) => Grip::First,
        (false, true) => Grip::Last,
        // Both ends at one place: the one that can move that way is taken.
        (true, true) if first > 0 && pointer.x < line.x(index_to_f64(first)) => Grip::First,
        (true, true) => Grip::Last,
        _ => Grip::Time,
    };
    if under != Grip::Time {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    if response.drag_started() {
        ui.data_mut(|data| data.insert_temp(id, under as u8));
    }
    // A press or a last move and the release may come within one picture.
    let drags = response.dragged() || response.drag_stopped();
    if !response.is_pointer_button_down_on() && !drags && !response.clicked() {
        return;
    }
    let grip = ui.data(|data| data.get_temp::<u8>(id));
    let frame = line.frame(pointer.x);
    let transport = &mut session.transport;
    match grip.filter(|_| drags) {
        Some(grip) if grip == Grip::First as u8 => transport.set_range(frame.min(last), last),
        Some(grip) if grip == Grip::Last as u8 => transport.set_range(first, frame.max(first)),
        _ if under == Grip::Time || drags => {
            transport.pause();
            transport.go_to_frame(frame);
        }
        _ => {}
    }
}

fn paint(ui: &Ui, response: &Response, line: &Line, session: &Session) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let track = line.track();
    painter.rect_filled(track, 4.0, palette.sunken);
    let (first, last) = session.transport.range();
    let span = Rect::from_min_max(
        pos2(line.x(index_to_f64(first)), track.top()),
        pos2(line.x(index_to_f64(last)), track.bottom()),
    );
    painter.rect_filled(span, 4.0, palette.accent_soft);
    for x in [span.left(), span.right()] {
        let handle = Rect::from_center_size(pos2(x, track.center().y), vec2(5.0, track.height()));
        painter.rect_filled(
            handle,
            CornerRadius::same(2),
            palette.accent.gamma_multiply(0.65),
        );
    }
    ticks(ui, line, session, &palette);
    marks(ui, line, session, &palette);
    let now = session.transport.time_secs();
    let duration = session.transport.duration_secs();
    let share = if duration > 0.0 { now / duration } else { 0.0 };
    let x = line.x(share * index_to_f64(line.last));
    painter.line_segment(
        [pos2(x, line.rect.top() + 6.0), pos2(x, track.bottom())],
        Stroke::new(1.6, palette.accent),
    );
    let knob = [
        pos2(x - 6.0, line.rect.top()),
        pos2(x + 6.0, line.rect.top()),
        pos2(x + 6.0, line.rect.top() + 7.0),
        pos2(x, line.rect.top() + 13.0),
        pos2(x - 6.0, line.rect.top() + 7.0),
    ];
    painter.add(egui::Shape::convex_polygon(
        knob.to_vec(),
        palette.accent,
        Stroke::NONE,
    ));
    if let Some(pointer) = response.hover_pos().filter(|_| line.last > 0) {
        let frame = line.frame(pointer.x);
        let x = line.x(index_to_f64(frame));
        painter.line_segment(
            [pos2(x, track.top()), pos2(x, track.bottom())],
            Stroke::new(1.0, palette.quiet),
        );
        let secs = clock_text(session.transport.secs_of(frame));
        response
            .clone()
            .on_hover_text_at_pointer(format!("frame {frame}  \u{b7}  {secs}"));
    }
}

/// Frame numbers along the line, as many as fit without crowding.
fn ticks(ui: &Ui, line: &Line, session: &Session, palette: &Palette) {
    const ROOM: f64 = 64.0;
    if line.last == 0 {
        return;
    }
    let width = f64::from(line.track().width());
    let wanted = index_to_f64(line.last) * ROOM / width.max(1.0);
    let step = round_step(wanted);
    let now = line.x(index_to_f64(session.transport.frame()));
    for frame in (0..=line.last).step_by(step) {
        let x = line.x(index_to_f64(frame));
        let top = line.track().top();
        ui.painter().line_segment(
            [pos2(x, top - 4.0), pos2(x, top)],
            Stroke::new(1.0, palette.line),
        );
        if (x - now).abs() > 16.0 {
            let font = FontId::proportional(10.5);
            let text = frame.to_string();
            let at = pos2(x, top - 4.0);
            ui.painter()
                .text(at, Align2::CENTER_BOTTOM, text, font, palette.quiet);
        }
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not under `wanted`.
fn round_step(wanted: f64) -> usize {
    let mut power = 1usize;
    loop {
        for digit in [1, 2, 5] {
            let step = power.saturating_mul(digit);
            if index_to_f64(step) >= wanted || step == usize::MAX {
                return step;
            }
        }
        power = power.saturating_mul(10);
    }
}

/// Where the findings are.
fn marks(ui: &Ui, line: &Line, session: &Session, palette: &Palette) {
    let Some(clip) = session.active_clip() else {
        return;
    };
    for finding in &clip.findings {
        let Some(frames) = finding.frames else {
            continue;
        };
        let color = severity_color(finding.severity, palette);
        let left = line.x(index_to_f64(frames.first));
        let right = line.x(index_to_f64(frames.last)).max(left + 2.0);
        let track = line.track();
        let mark = Rect::from_min_max(
            pos2(left, track.bottom() - 4.0),
            pos2(right, track.bottom() - 1.0),
        );
        ui.painter().rect_filled(mark, 1.0, color);
    }
}

/// The colour of a severity.
#[must_use]
pub fn severity_color(severity: Severity, palette: &Palette) -> Color32 {
    match severity {
        Severity::Info => palette.quiet,
        Severity::Warning => palette.warning,
        Severity::Error => palette.error,
    }
}

/// The size that the transport takes at least.
#[must_use]
pub const fn minimum_size() -> Vec2 {
    Vec2::new(560.0, 76.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_speeds_are_said_shortly() {
        assert_eq!(clock_text(0.0), "0:00.00");
        assert_eq!(clock_text(61.239), "1:01.24");
        assert_eq!(clock_text(59.999), "1:00.00");
        assert_eq!(speed_text(1.0), "1\u{d7}");
        assert_eq!(speed_text(0.25), "0.25\u{d7}");
    }

    #[test]
    fn steps_are_round_and_large_enough() {
        assert_eq!(
            [0.1, 1.5, 3.0, 7.0, 120.0].map(round_step),
            [1, 2, 5, 10, 200]
        );
    }

    #[test]
    fn frames_and_places_on_the_line_agree() {
        let rect = Rect::from_min_size(pos2(100.0, 0.0), vec2(500.0, LINE_HEIGHT));
        let line = Line { rect, last: 181 };
        for frame in [0, 1, 90, 181] {
            assert_eq!(line.frame(line.x(index_to_f64(frame))), frame);
        }
        assert_eq!(line.frame(-1e9), 0);
        assert_eq!(line.frame(1e9), 181);
    }
}
