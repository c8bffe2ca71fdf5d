//! The text of the active clip's file, beside the figure: read only, with the row of the frame that is shown
//! and the values of the selected joints marked.
//!
//! Only lines that are seen are laid out.

use std::ops::Range;
use std::sync::Arc;

use egui::{Align, Color32, Rect, ScrollArea, Sense, Ui, pos2, vec2};

use super::{Asked, row, tip};
use crate::command::Command;
use crate::icons::{Icon, icon_button};
use crate::state::clip::{Clip, Source};
use crate::state::session::{ClipId, Session};
use crate::state::text::{FileText, Line, columns_of};
use crate::theme::{GAP, Palette};

/// Between the numbers of lines and their text.
const GUTTER_GAP: f32 = 10.0;

/// More lines than a tall screen shows are never laid out.
const MOST_LINES: usize = 400;

/// What the panel remembers.
#[derive(Clone, Debug, Default)]
pub struct TextPanel {
    /// The text that is ready.
    ready: Option<Arc<FileText>>,
    /// The bytes of the text that is being made ready.
    awaited: Option<Arc<Vec<u8>>>,
    /// What was followed last.
    followed: Option<Followed>,
}

/// What the panel goes along with.
#[derive(Clone, Debug, PartialEq)]
struct Followed {
    clip: ClipId,
    frame: usize,
    selection: Vec<posekit::skeleton::JointId>,
}

impl TextPanel {
    /// The bytes whose text is to be made ready, if it is not.
    pub fn wants(&mut self, session: &Session) -> Option<Arc<Vec<u8>>> {
        let bytes = session.active_clip()?.text.clone()?;
        let is_awaited = self
            .awaited
            .as_ref()
            .is_some_and(|awaited| Arc::ptr_eq(awaited, &bytes));
        if is_awaited || self.ready_for(&bytes).is_some() {
            return None;
        }
        self.awaited = Some(Arc::clone(&bytes));
        Some(bytes)
    }

    /// Takes in a text that was made ready.
    pub fn take(&mut self, text: Arc<FileText>) {
        // One that nobody waits for any more goes.
        if let Some(awaited) = self.awaited.take_if(|awaited| text.is_of(awaited)) {
            drop(awaited);
            self.ready = Some(text);
            self.followed = None;
        }
    }

    /// Whether a text is being made ready.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        self.awaited.is_some()
    }

    fn ready_for(&self, bytes: &Arc<Vec<u8>>) -> Option<&Arc<FileText>> {
        self.ready.as_ref().filter(|text| text.is_of(bytes))
    }

    /// What is seen of the active clip's file: the line of the frame's row and the number of lines, both
    /// counted from 1.
    #[must_use]
    pub fn status(&self, session: &Session) -> String {
        let Some(bytes) = session.active_clip().and_then(|clip| clip.text.as_ref()) else {
            return "none".to_owned();
        };
        let Some(text) = self.ready_for(bytes) else {
            return "reading".to_owned();
        };
        let row = text.row(session.transport.frame());
        let line = row.map_or(0, |row| text.line_at(row.start) + 1);
        format!("{line} of {}", text.line_count())
    }
}

/// Where parts of the panel are, in points; nothing where there is no such part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextPlaces {
    /// The lines.
    pub lines: Rect,
    /// The line in which the row of the frame begins, as far as it is seen.
    pub row: Rect,
}

impl TextPlaces {
    /// Where there is no text.
    pub const NONE: Self = Self {
        lines: Rect::NOTHING,
        row: Rect::NOTHING,
    };
}

/// Shows the text. Gives where it is.
pub fn show(
    ui: &mut Ui,
    session: &mut Session,
    panel: &mut TextPanel,
    asked: &mut Asked,
) -> TextPlaces {
    let clip = session.active_clip().cloned();
    let name = clip.as_ref().map_or("Text", |clip| &clip.name);
    row::heading(ui, name, |ui| {
        if icon_button(ui, Icon::Close, &tip("Close the text", Command::ToggleText)).clicked() {
            asked.command(Command::ToggleText);
        }
    });
    let (Some(id), Some(clip)) = (session.active_id(), clip) else {
        row::empty_note(ui, "Open a clip to see the text of its file.");
        return TextPlaces::NONE;
    };
    let Some(bytes) = &clip.text else {
        row::empty_note(ui, why_none(&clip));
        return TextPlaces::NONE;
    };
    let Some(text) = panel.ready_for(bytes).cloned() else {
        row::empty_note(ui, "Reading the text\u{2026}");
        return TextPlaces::NONE;
    };
    if session.is_edited(id) {
        row::empty_note(ui, "The file as it is: edits are not in it.");
    }
    let follows = Followed {
        clip: id,
        frame: session.transport.frame(),
        selection: session.selection().to_vec(),
    };
    let page = Page::new(ui, &text, &clip, &follows);
    let (place, clicked) = page.show(
        ui,
        session.transport.is_playing(),
        panel.followed.as_ref(),
        &follows,
    );
    panel.followed = Some(follows);
    if let Some(frame) = clicked {
        session.transport.pause();
        session.transport.go_to_frame(frame);
    }
    place
}

fn why_none(clip: &Clip) -> &'static str {
    match clip.source {
        Source::File(_) | Source::Bytes => {
            "There is no text here: the file is still being read, or too large for it."
        }
        Source::Scene(_) => "A scene has no frames in its file: its clip is made of keys.",
        Source::Sample(_) | Source::Made => "This clip is in no file.",
    }
}

/// A text in the panel.
struct Page<'a> {
    text: &'a FileText,
    /// The row of the frame that is shown.
    row: Option<Range<usize>>,
    /// The own lines of the selected joints.
    joints: Vec<Range<usize>>,
    /// The columns of the selected joints.
    columns: Vec<Range<usize>>,
    font: egui::FontId,
    /// The size of a character with the space below it.
    cell: egui::Vec2,
    /// The width of the numbers.
    gutter: f32,
    palette: Palette,
}

impl<'a> Page<'a> {
    fn new(ui: &Ui, text: &'a FileText, clip: &Clip, follows: &Followed) -> Self {
        let font = egui::TextStyle::Monospace.resolve(ui.style());
        let (width, height) =
            ui.fonts_mut(|fonts| (fonts.glyph_width(&font, '0'), fonts.row_height(&font)));
        let digits = text.line_count().to_string().len();
        let selection = &follows.selection;
        Self {
            text,
            row: text.row(follows.frame),
            joints: selection
                .iter()
                .filter_map(|&joint| text.joint(joint))
                .collect(),
            columns: selection
                .iter()
                .map(|&joint| columns_of(&clip.document, joint))
                .collect(),
            cell: vec2(width, (height + 3.0).round()),
            gutter: float(digits) * width + GUTTER_GAP,
            font,
            palette: Palette::in_ui(ui),
        }
    }

    /// Shows it. Gives where it is, and the frame whose row was clicked.
    fn show(
        &self,
        ui: &mut Ui,
        plays: bool,
        before: Option<&Followed>,
        now: &Followed,
    ) -> (TextPlaces, Option<usize>) {
        let size = vec2(
            self.gutter + float(self.text.column_count()) * self.cell.x,
            float(self.text.line_count()) * self.cell.y,
        );
        let mut area = ScrollArea::both()
            .id_salt("text")
            .auto_shrink([false, false]);
        let height = ui.available_height();
        let row_top = self
            .row
            .as_ref()
            .map(|row| float(self.text.line_at(row.start)) * self.cell.y);
        // A row that goes by while the clip plays stays in the middle.
        if let Some(top) = row_top.filter(|_| plays) {
            area = area.vertical_scroll_offset((top - height / 2.0).max(0.0));
        }
        let shown = area.show_viewport(ui, |ui, viewport| {
            let (place, response) = ui.allocate_exact_size(size, Sense::click());
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Label, true, "The file's text")
            });
            self.paint(ui, place.min, viewport);
            self.follow(ui, place.min, before, now, plays);
            let row = row_top.map(|top| {
                let left = place.left() + viewport.left();
                let line = pos2(left, place.top() + top);
                Rect::from_min_size(line, vec2(viewport.width(), self.cell.y))
            });
            let at = response.interact_pointer_pos();
            let at = at.filter(|_| response.clicked());
            (row, at.and_then(|at| self.frame_at(at - place.min)))
        });
        let (row, clicked) = shown.inner;
        let row = row.filter(|row| shown.inner_rect.contains_rect(*row));
        let places = TextPlaces {
            lines: shown.inner_rect,
            row: row.unwrap_or(Rect::NOTHING),
        };
        (places, clicked)
    }

    /// Brings what has changed into the panel, if it is not there: the frame's row, or the lines of the joint
    /// that was selected.
    fn follow(
        &self,
        ui: &Ui,
        origin: egui::Pos2,
        before: Option<&Followed>,
        now: &Followed,
        plays: bool,
    ) {
        let is_new = before.is_none_or(|before| before.clip != now.clip);
        let joint_changed = before.is_some_and(|before| before.selection != now.selection);
        let frame_changed = is_new || before.is_some_and(|before| before.frame != now.frame);
        if joint_changed && self.shows_rows(ui, origin) {
            self.bring_columns(ui, origin);
        }
        let target = if frame_changed && !plays {
            self.row.as_ref()
        } else if joint_changed && !plays && !self.shows_rows(ui, origin) {
            self.joints.last()
        } else {
            None
        };
        let Some(target) = target else {
            return;
        };
        let top = origin.y + float(self.text.line_at(target.start)) * self.cell.y;
        let clip = ui.clip_rect();
        let line = Rect::from_min_size(pos2(clip.left(), top), vec2(1.0, self.cell.y));
        if !clip.contains_rect(line) {
            // As wide as the panel, so that nothing moves to the side.
            let place = Rect::from_x_y_ranges(clip.x_range(), line.y_range());
            ui.scroll_to_rect(place, Some(Align::Center));
        }
    }

    /// Moves the text to the side until the columns of the joint that was selected last are seen.
    fn bring_columns(&self, ui: &Ui, origin: egui::Pos2) {
        let row = self.row.as_ref().map(|row| row.start..row.start + 1);
        let values = row.map(|row| self.text.values(row, &self.columns));
        let Some(value) = values.as_ref().and_then(|values| values.last()) else {
            return;
        };
        let line = self.text.line_at(value.start);
        let Some(line) = self.text.lines(line..line + 1).next() else {
            return;
        };
        let x = |byte: usize| origin.x + float(line.column_of(byte)) * self.cell.x;
        // The numbers of the lines lie over what is at the left.
        let across = x(value.start)..=x(value.end) + self.gutter;
        let clip = ui.clip_rect();
        if !clip.x_range().contains(*across.start()) || !clip.x_range().contains(*across.end()) {
            ui.scroll_to_rect(Rect::from_x_y_ranges(across, clip.y_range()), None);
        }
    }

    /// Whether rows of frames are seen, in which the columns of a joint are marked.
    fn shows_rows(&self, ui: &Ui, origin: egui::Pos2) -> bool {
        let bottom = ui.clip_rect().bottom() - origin.y;
        let line = self.line_under(bottom).min(self.text.line_count() - 1);
        let last = self.text.lines(line..line + 1).next();
        last.is_some_and(|line| self.text.frame_at(line.at).is_some())
    }

    fn line_under(&self, y: f32) -> usize {
        whole(y / self.cell.y)
    }

    /// The frame whose row stands at a place of the text.
    fn frame_at(&self, at: egui::Vec2) -> Option<usize> {
        let line = self.line_under(at.y);
        let line = self.text.lines(line..line + 1).next()?;
        let column = whole((at.x - self.gutter).max(0.0) / self.cell.x);
        let byte = line.byte_at(column);
        // Beside a row it is that row, not the end of the one before.
        let first = line
            .text
            .iter()
            .position(|byte| !byte.is_ascii_whitespace())?;
        self.text.frame_at(byte.max(line.at + first))
    }

    fn paint(&self, ui: &Ui, origin: egui::Pos2, viewport: Rect) {
        let first = self.line_under(viewport.top());
        let count = whole(viewport.height() / self.cell.y) + 2;
        let lines: Vec<Line<'_>> = self
            .text
            .lines(first..first + count.min(MOST_LINES))
            .collect();
        let (Some(top), Some(bottom)) = (lines.first(), lines.last()) else {
            return;
        };
        let seen = top.at..bottom.at + bottom.text.len() + 1;
        let values = self.text.values(seen, &self.columns);
        let left = whole((viewport.left() - self.gutter).max(0.0) / self.cell.x);
        let columns = left..left + whole(viewport.width() / self.cell.x) + 2;
        for line in &lines {
            self.paint_line(ui, origin, line, &columns, &values);
        }
        // The numbers stay where they are when the text is moved to the side.
        let gutter = Rect::from_min_size(
            pos2(origin.x + viewport.left(), origin.y + viewport.top()),
            vec2(self.gutter - GUTTER_GAP / 2.0, viewport.height()),
        );
        ui.painter().rect_filled(gutter, 0.0, self.palette.panel);
        for line in &lines {
            let is_marked = self.row.as_ref().is_some_and(|row| touches(line, row));
            let color = if is_marked {
                self.palette.accent
            } else {
                self.palette.quiet
            };
            let at = pos2(
                gutter.right() - GAP,
                self.top_of(origin, line) + self.cell.y / 2.0,
            );
            let number = (line.number + 1).to_string();
            ui.painter().text(
                at,
                egui::Align2::RIGHT_CENTER,
                number,
                self.font.clone(),
                color,
            );
        }
    }

    fn top_of(&self, origin: egui::Pos2, line: &Line<'_>) -> f32 {
        origin.y + float(line.number) * self.cell.y
    }

    fn paint_line(
        &self,
        ui: &Ui,
        origin: egui::Pos2,
        line: &Line<'_>,
        columns: &Range<usize>,
        values: &[Range<usize>],
    ) {
        let top = self.top_of(origin, line);
        let x = |column: usize| origin.x + self.gutter + float(column) * self.cell.x;
        let mark = |place: &Range<usize>, color: Color32| {
            if !touches(line, place) {
                return;
            }
            let from = line
                .column_of(place.start)
                .clamp(columns.start, columns.end);
            let to = line.column_of(place.end).clamp(columns.start, columns.end);
            if from < to {
                let rect =
                    Rect::from_x_y_ranges(x(from) - 1.0..=x(to) + 1.0, top..=top + self.cell.y);
                ui.painter().rect_filled(rect, 2.0, color);
            }
        };
        if let Some(row) = &self.row {
            mark(row, self.palette.accent_soft);
        }
        for joint in &self.joints {
            mark(joint, self.palette.sunken);
        }
        let is_current = |value: &&Range<usize>| {
            let row = self.row.as_ref();
            row.is_some_and(|row| row.start <= value.start && value.end <= row.end)
        };
        for value in values.iter().filter(|value| !is_current(value)) {
            mark(value, self.palette.sunken);
        }
        for value in values.iter().filter(is_current) {
            mark(value, self.palette.accent.gamma_multiply(0.35));
        }
        let (shown, from) = line.part(columns.clone());
        if !shown.is_empty() {
            let at = pos2(x(from), top + self.cell.y / 2.0);
            ui.painter().text(
                at,
                egui::Align2::LEFT_CENTER,
                shown,
                self.font.clone(),
                self.palette.text,
            );
        }
    }
}

/// Whether something stands in a line, or goes through it.
fn touches(line: &Line<'_>, place: &Range<usize>) -> bool {
    place.start <= line.at + line.text.len() && line.at < place.end
}

/// A count of lines or columns as a length. A screen is exact to a pixel up to a million lines.
#[expect(clippy::cast_precision_loss, reason = "lengths on a screen")]
fn float(count: usize) -> f32 {
    count as f32
}

/// The whole steps in a length.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast from float to integer saturates, and negative lengths become 0"
)]
fn whole(length: f32) -> usize {
    length as usize
}
