//! Rows and headings, the same in every panel.

use egui::{Align, Color32, Layout, Rect, Response, RichText, Sense, Ui, Vec2, vec2};

use super::{Asked, tip};
use crate::command::Command;
use crate::icons::{Icon, sized_icon};
use crate::theme::{GAP, Palette};

/// A heading over a part of a panel, with room for buttons at its right.
pub fn heading(ui: &mut Ui, text: &str, buttons: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        ui.set_min_height(28.0);
        let palette = Palette::in_ui(ui);
        ui.label(RichText::new(text).strong().size(12.5).color(palette.text));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            buttons(ui);
        });
    });
}

/// A row that can be clicked: its ground shows whether it is chosen. What is in it is painted by
/// the caller into the rectangle that comes back.
pub fn row(ui: &mut Ui, height: f32, chosen: bool, name: &str) -> (Rect, Response) {
    let size = vec2(ui.available_width(), height);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, chosen, name));
    let palette = Palette::in_ui(ui);
    let fill = if chosen {
        palette.accent_soft
    } else if response.hovered() {
        palette.hover
    } else {
        Color32::TRANSPARENT
    };
    ui.painter().rect_filled(rect, 6.0, fill);
    if response.has_focus() {
        let edge = egui::Stroke::new(1.5, palette.accent);
        ui.painter()
            .rect_stroke(rect, 6.0, edge, egui::StrokeKind::Inside);
    }
    (rect, response)
}

/// One line of text that ends in an ellipsis where there is no more room.
pub fn text_in(ui: &Ui, rect: Rect, text: RichText, color: Color32) {
    let mut job = egui::WidgetText::from(text.color(color)).into_layout_job(
        ui.style(),
        egui::FontSelection::Default,
        Align::Center,
    );
    let mut job = std::sync::Arc::unwrap_or_clone(std::mem::take(&mut job));
    job.wrap = egui::text::TextWrapping::truncate_at_width(rect.width());
    let galley = ui.painter().layout_job(job);
    let at = egui::pos2(rect.left(), rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, color);
}

/// A quiet sentence where there is nothing else to show.
pub fn empty_note(ui: &mut Ui, text: &str) {
    ui.add_space(GAP);
    let palette = Palette::in_ui(ui);
    ui.label(RichText::new(text).color(palette.quiet));
    ui.add_space(GAP);
}

/// A hairline between two parts of a panel.
pub fn divider(ui: &mut Ui) {
    ui.add_space(GAP);
    let (rect, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), 1.0), Sense::hover());
    ui.painter().rect_filled(rect, 0.0, Palette::in_ui(ui).line);
    ui.add_space(GAP);
}

/// One of several, each a command, its name, and what it does: beside each other in one well, or in a list that
/// opens where `room` is less than they need.
pub fn segments(
    ui: &mut Ui,
    room: f32,
    chosen: Command,
    options: &[(Command, &str, String)],
    asked: &mut Asked,
) {
    let named: Vec<(&str, &str)> = options
        .iter()
        .map(|(_, name, says)| (*name, says.as_str()))
        .collect();
    let now = options.iter().position(|(command, ..)| *command == chosen);
    if let Some(index) = one_of(ui, "segments", room, now, &named) {
        asked.command(options[index].0);
    }
}

/// One of several, each a name and what it says: beside each other in one well, or in a list that opens where
/// `room` is less than they need. Which of them was clicked.
pub fn one_of(
    ui: &mut Ui,
    salt: &str,
    room: f32,
    chosen: Option<usize>,
    options: &[(&str, &str)],
) -> Option<usize> {
    let mut clicked = None;
    if width_of(ui, options.iter().map(|(name, _)| *name)) <= room {
        // What is laid out from the right has the last one first.
        let is_from_right = ui.layout().prefer_right_to_left();
        well(ui, |ui| {
            for place in 0..options.len() {
                let index = if is_from_right {
                    options.len() - 1 - place
                } else {
                    place
                };
                let (name, says) = options[index];
                let segment = segment(ui, name, chosen == Some(index));
                if segment.on_hover_text(says).clicked() {
                    clicked = Some(index);
                }
            }
        });
        return clicked;
    }
    let name = chosen.map_or("", |index| options[index].0);
    // The longest of them, and the sign that there are others.
    let names = options.iter().map(|(name, _)| text_width(ui, name));
    let width = names.fold(0.0, f32::max) + 10.0 * GAP;
    egui::ComboBox::from_id_salt(salt)
        .selected_text(name)
        .width(width.min(room - 2.0 * GAP).max(40.0))
        .truncate()
        .show_ui(ui, |ui| {
            for (index, (name, says)) in options.iter().enumerate() {
                let mut label = ui.selectable_label(chosen == Some(index), *name);
                if !says.is_empty() {
                    label = label.on_hover_text(*says);
                }
                if label.clicked() {
                    clicked = Some(index);
                }
            }
        });
    clicked
}

/// The width that segments take with these names, in their well.
#[must_use]
pub fn width_of<'a>(ui: &Ui, names: impl Iterator<Item = &'a str>) -> f32 {
    const BETWEEN: f32 = 2.0;
    const WELL: f32 = 4.0;
    let widths = names.map(|name| text_width(ui, name) + SEGMENT_MARGINS + BETWEEN);
    widths.sum::<f32>() - BETWEEN + WELL
}

/// The width of a button's text.
fn text_width(ui: &Ui, text: &str) -> f32 {
    let font = egui::TextStyle::Button.resolve(ui.style());
    let galley = ui
        .painter()
        .layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER);
    galley.size().x
}

/// A group of controls: what it is shown with, and the width of a whole line.
pub type Group<C> = fn(&mut Ui, f32, &mut C);

/// Groups of controls beside each other, in as many lines as they need.
///
/// How wide they are is known once they were shown: where that is not as it was the picture is made again.
pub fn lines<C>(ui: &mut Ui, context: &mut C, groups: &[Group<C>]) {
    let id = ui.scope_id().with("lines of groups");
    let room = ui.available_width();
    let before: Vec<f32> = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let width = |index: usize| before.get(index).copied().unwrap_or(0.0);
    let mut widths = Vec::with_capacity(groups.len());
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = GAP;
        while widths.len() < groups.len() {
            let first = widths.len();
            let mut end = first + 1;
            let mut taken = width(first);
            while end < groups.len() && taken + GAP + width(end) <= room {
                taken += GAP + width(end);
                end += 1;
            }
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = GAP;
                for group in &groups[first..end] {
                    let shown = ui.horizontal(|ui| group(ui, room, context));
                    widths.push(shown.response.rect.width());
                }
            });
        }
    });
    let is_same = widths.len() == before.len()
        && widths.iter().zip(&before).all(|(a, b)| (a - b).abs() < 0.5);
    if !is_same {
        ui.data_mut(|data| data.insert_temp(id, widths));
        ui.ctx().request_discard("controls change lines");
    }
}

/// The well that segments lie in.
pub fn well(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let well = egui::Frame::NONE
        .fill(Palette::in_ui(ui).sunken)
        .corner_radius(7.0)
        .inner_margin(egui::Margin::same(2));
    well.show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            contents(ui);
        });
    });
}

/// A step that can be undone or done again: whether there is one, and its name where it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// There is none.
    None,
    /// There is one.
    Unnamed,
    /// There is one of this name.
    Named(String),
}

impl From<bool> for Step {
    fn from(is_there: bool) -> Self {
        if is_there { Self::Unnamed } else { Self::None }
    }
}

impl From<Option<String>> for Step {
    fn from(name: Option<String>) -> Self {
        name.map_or(Self::None, Self::Named)
    }
}

/// The buttons of undo and redo.
pub fn undo_buttons(ui: &mut Ui, (undo, redo): (Step, Step), height: f32, asked: &mut Asked) {
    for (icon, step, verb, command) in [
        (Icon::Undo, undo, "Undo", Command::Undo),
        (Icon::Redo, redo, "Redo", Command::Redo),
    ] {
        ui.add_enabled_ui(step != Step::None, |ui| {
            let says = match &step {
                Step::Named(name) => tip(&format!("{verb}: {name}"), command),
                Step::None | Step::Unnamed => tip(verb, command),
            };
            let height = height.max(ui.spacing().interact_size.y);
            if sized_icon(ui, icon, &says, false, vec2(height.max(26.0), height)).clicked() {
                asked.command(command);
            }
        });
    }
}

/// Whether a list of so many lines has its place in a plot of some height.
#[must_use]
pub fn legend_fits(lines: usize, height: f32) -> bool {
    const LINE: f32 = 23.0;
    // Numbers along the axis, and around the list.
    const AROUND: f32 = 44.0;
    lines as f32 * LINE + AROUND <= height
}

/// What a segment has beside its name.
const SEGMENT_MARGINS: f32 = 5.0 * GAP;

/// One of several beside each other.
pub fn segment(ui: &mut Ui, name: &str, chosen: bool) -> Response {
    let height = ui.spacing().interact_size.y - 2.0;
    let palette = Palette::in_ui(ui);
    let font = egui::TextStyle::Button.resolve(ui.style());
    let color = if chosen { palette.accent } else { palette.text };
    let galley = ui.painter().layout_no_wrap(name.to_owned(), font, color);
    let size = vec2(galley.size().x + SEGMENT_MARGINS, height);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response
        .widget_info(|| egui::WidgetInfo::selected(egui::Role::RadioButton, true, chosen, name));
    if chosen {
        ui.painter().rect_filled(rect, 5.0, palette.raised);
        let edge = egui::Stroke::new(1.0, palette.line);
        ui.painter()
            .rect_stroke(rect, 5.0, edge, egui::StrokeKind::Inside);
    } else if response.hovered() {
        ui.painter().rect_filled(rect, 5.0, palette.hover);
    }
    if response.has_focus() {
        let edge = egui::Stroke::new(1.5, palette.accent);
        ui.painter()
            .rect_stroke(rect, 5.0, edge, egui::StrokeKind::Inside);
    }
    let at = rect.center() - galley.size() / 2.0;
    ui.painter().galley(at, galley, color);
    response
}

/// A name at the left, something to be set at the right.
pub fn line<T>(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui) -> T) -> T {
    const NAME_WIDTH: f32 = 72.0;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let (rect, _) = ui.allocate_exact_size(vec2(NAME_WIDTH, 20.0), Sense::hover());
        text_in(ui, rect, RichText::new(name), Palette::in_ui(ui).quiet);
        contents(ui)
    })
    .inner
}
