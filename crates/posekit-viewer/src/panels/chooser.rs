//! The window's own file chooser: a field for a name or a path, and what is in the folder.

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{
    Align, Button, Event, EventFilter, Key, Layout, Rect, RichText, ScrollArea, TextEdit, Ui, pos2,
    vec2,
};

use super::{elide, row};
use crate::icons::{self, Icon, icon_button};
use crate::state::chooser::{Chooser, Goal, Question, folder_text, home};
use crate::theme::{GAP, Palette};
use std::path::PathBuf;

/// Height of a row: a fingertip's.
const ROW_HEIGHT: f32 = 28.0;

/// Width that the chooser takes where there is room.
const WIDTH: f32 = 560.0;

/// What became of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shown {
    /// It is open still.
    Open,
    /// These were chosen.
    Chosen(Vec<PathBuf>),
    /// Nothing was.
    Cancelled,
}

/// Shows the chooser.
pub fn show(ctx: &egui::Context, chooser: &mut Chooser) -> Shown {
    let mut shown = Shown::Open;
    let screen = ctx.content_rect();
    let modal = egui::Modal::new(egui::Id::unique("chooser"));
    let modal = modal.frame(super::modal_frame(ctx)).show(ctx, |ui| {
        ui.set_width((screen.width() - 64.0).clamp(180.0, WIDTH));
        take_focus(ui, chooser);
        let key = take_key(ui);
        heading(ui, chooser, &mut shown);
        place(ui, chooser);
        field(ui, chooser);
        let chosen = key.and_then(|key| act_on(ui, chooser, key));
        // A question takes its room from the list: if it grew the window, all of that would move up a little later,
        // and the answer be gone from under the pointer.
        let top = ui.cursor().top();
        let chosen = chosen.or(told(ui, chooser));
        let taken = ui.cursor().top() - top;
        ui.add_space(GAP);
        let is_pointing = matches!(key, Some(Stroke::Up | Stroke::Down));
        let chosen = chosen.or(list(ui, chooser, (screen.height(), taken), is_pointing));
        ui.add_space(2.0 * GAP);
        if let Some(chosen) = chosen.or(buttons(ui, chooser, &mut shown)) {
            shown = Shown::Chosen(chosen);
        }
    });
    if shown == Shown::Open && modal.should_close() {
        shown = Shown::Cancelled;
    }
    shown
}

fn field_id() -> egui::Id {
    egui::Id::unique("chooser field")
}

/// A key that is the chooser's while its field is typed into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stroke {
    Down,
    Up,
    Above,
    Tick,
    Complete,
    Enter,
}

impl Stroke {
    fn of(event: &Event) -> Option<Self> {
        let Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } = event
        else {
            return None;
        };
        match key {
            Key::ArrowUp if modifiers.alt => Some(Self::Above),
            Key::Space if modifiers.command => Some(Self::Tick),
            _ if modifiers.alt || modifiers.command => None,
            Key::ArrowUp => Some(Self::Up),
            Key::ArrowDown => Some(Self::Down),
            Key::Tab => Some(Self::Complete),
            Key::Enter => Some(Self::Enter),
            _ => None,
        }
    }
}

/// Under this name egui remembers what was typed after a key of the chooser.
const WAITING: &str = "chooser typed";

/// Takes the first of the chooser's keys. Where pictures are slow, a name and the Enter after it come in one frame:
/// what was typed before the key is the field's first, what was typed after it waits for the next frame.
fn take_key(ui: &Ui) -> Option<Stroke> {
    let waiting = egui::Id::unique(WAITING);
    let before: Option<Vec<Event>> = ui.data_mut(|data| data.remove_temp(waiting));
    if !ui.memory(|memory| memory.has_focus(field_id())) {
        return None;
    }
    let is_typed = |event: &Event| {
        matches!(
            event,
            Event::Text(_) | Event::Key { .. } | Event::Paste(_) | Event::Cut | Event::Copy
        )
    };
    let (key, later) = ui.input_mut(|i| {
        let mut events = before.unwrap_or_default();
        events.append(&mut i.events);
        let first = events.iter().enumerate();
        let first = first.filter_map(|(at, event)| Some((at, Stroke::of(event)?)));
        let first = first.min_by_key(|(at, _)| *at);
        let mut later = Vec::new();
        if let Some((at, _)) = first {
            let (typed, other) = events.split_off(at + 1).into_iter().partition(is_typed);
            later = typed;
            events.pop();
            events.extend::<Vec<Event>>(other);
        }
        i.events = events;
        (first.map(|(_, key)| key), later)
    });
    if !later.is_empty() {
        ui.data_mut(|data| data.insert_temp(waiting, later));
        ui.ctx().request_repaint();
    }
    key
}

fn act_on(ui: &Ui, chooser: &mut Chooser, key: Stroke) -> Option<Vec<PathBuf>> {
    let mut chosen = None;
    match key {
        Stroke::Down => chooser.point(true),
        Stroke::Up => chooser.point(false),
        Stroke::Above => chooser.go_up(),
        Stroke::Tick => chooser.tick_pointed(),
        Stroke::Complete => chooser.complete(),
        Stroke::Enter => chosen = chooser.enter(),
    }
    if matches!(key, Stroke::Complete | Stroke::Enter) {
        cursor_to_end(ui, chooser);
    }
    // What stands above the field was drawn before.
    ui.ctx().request_repaint();
    chosen
}

fn cursor_to_end(ui: &Ui, chooser: &Chooser) {
    select(
        ui,
        chooser.text.chars().count(),
        chooser.text.chars().count(),
    );
}

/// Selects characters of the field.
fn select(ui: &Ui, from: usize, to: usize) {
    if let Some(mut state) = TextEdit::load_state(ui.ctx(), field_id()) {
        let range = CCursorRange::two(CCursor::new(from), CCursor::new(to));
        state.cursor.set_char_range(Some(range));
        state.store(ui.ctx(), field_id());
    }
}

fn heading(ui: &mut Ui, chooser: &Chooser, shown: &mut Shown) {
    ui.horizontal(|ui| {
        ui.heading(chooser.ask().title);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if icon_button(ui, Icon::Close, "Cancel  (Esc)").clicked() {
                *shown = Shown::Cancelled;
            }
        });
    });
    if let Some(says) = chooser.ask().says {
        ui.label(RichText::new(says).color(Palette::in_ui(ui).quiet));
    }
    ui.add_space(GAP);
}

/// The folder, and the ways out of it.
fn place(ui: &mut Ui, chooser: &mut Chooser) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let has_above = chooser.folder().parent().is_some();
        let up = ui.add_enabled(has_above, Button::new("Up"));
        if up
            .on_hover_text("The folder above  (Alt+\u{2191})")
            .clicked()
        {
            chooser.go_up();
        }
        if let Some(home) = home()
            && ui
                .button("Home")
                .on_hover_text("Your home folder")
                .clicked()
        {
            chooser.go_to(&home);
        }
        let whole = folder_text(chooser.folder());
        let font = egui::TextStyle::Body.resolve(ui.style());
        let text = elide::path_within(ui, &whole, &font, ui.available_width() - GAP);
        let label = ui.label(RichText::new(text).color(Palette::in_ui(ui).quiet));
        label.on_hover_text(whole);
    });
    ui.add_space(GAP);
}

fn field(ui: &mut Ui, chooser: &mut Chooser) {
    let (name, hint) = match chooser.ask().goal {
        Goal::OpenFiles => ("File", "A name or a path; Tab completes it"),
        Goal::OpenFolder => ("Folder", "A name or a path; empty for the folder listed"),
        Goal::SaveFile => ("Save as", "A name or a path"),
    };
    ui.horizontal(|ui| {
        let label = ui.label(name);
        let quiet = Palette::in_ui(ui).quiet;
        let edit = TextEdit::singleline(&mut chooser.text)
            .id(field_id())
            .hint_text(RichText::new(hint).color(quiet))
            .desired_width(f32::INFINITY)
            .event_filter(EventFilter {
                tab: true,
                horizontal_arrows: true,
                vertical_arrows: true,
                escape: false,
            });
        let field = ui.add(edit).labelled_by(label.id);
        if field.changed() {
            let typed = chooser.text.clone();
            chooser.follow_text();
            if typed != chooser.text {
                cursor_to_end(ui, chooser);
            }
        }
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
    });
}

/// It is typed into at once, from its first frame on; of a name that is proposed all but its ending is typed over.
fn take_focus(ui: &Ui, chooser: &mut Chooser) {
    if !chooser.take_is_new() {
        return;
    }
    ui.memory_mut(|memory| memory.request_focus(field_id()));
    ui.data_mut(|data| data.remove_temp::<Vec<Event>>(egui::Id::unique(WAITING)));
    let ending = chooser.ask().endings.first().map_or(0, |it| it.len() + 1);
    let length = chooser.text.chars().count();
    TextEdit::store_state(ui.ctx(), field_id(), TextEditState::default());
    select(ui, 0, length.saturating_sub(ending));
}

/// What is wrong, and what is to be answered.
fn told(ui: &mut Ui, chooser: &mut Chooser) -> Option<Vec<PathBuf>> {
    let palette = Palette::in_ui(ui);
    if let Some(problem) = chooser.problem() {
        ui.label(RichText::new(problem).color(palette.error));
    }
    let (says, yes, no) = match chooser.question()? {
        Question::Replace { path, is_open } => {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let says = if *is_open {
                format!("{name} is there already, and open in this window. Replace it?")
            } else {
                format!("{name} is there already. Replace it?")
            };
            (says, "Replace", "Keep it")
        }
        Question::MakeFolder(folder) => {
            let says = format!("There is no folder {}. Make it?", folder.display());
            (says, "Make the folder", "Do not")
        }
    };
    ui.label(RichText::new(says).color(palette.warning));
    let mut answer = None;
    ui.horizontal(|ui| {
        if ui.button(yes).clicked() {
            answer = Some(true);
        }
        if ui.button(no).clicked() {
            answer = Some(false);
        }
    });
    match answer {
        Some(true) => return chooser.agree(),
        Some(false) => chooser.decline(),
        None => {}
    }
    None
}

/// The files and folders; `taken` is the height that a question above has of it. Where the arrows go, it follows.
fn list(
    ui: &mut Ui,
    chooser: &mut Chooser,
    (screen_height, taken): (f32, f32),
    is_pointing: bool,
) -> Option<Vec<PathBuf>> {
    /// What stands above and below the list, the frame included.
    const AROUND: f32 = 260.0;
    let height = (screen_height - AROUND).clamp(2.0 * ROW_HEIGHT, 12.0 * ROW_HEIGHT);
    let height = (height - taken).max(ROW_HEIGHT);
    let mut clicked = None;
    let mut opened = false;
    let count = chooser.row_count();
    let font = egui::TextStyle::Body.resolve(ui.style());
    egui::Frame::NONE
        .fill(Palette::in_ui(ui).panel)
        .corner_radius(6)
        .show(ui, |ui| {
            let mut area = ScrollArea::vertical()
                .id_salt("chooser rows")
                .auto_shrink([false, false])
                .max_height(height)
                .min_scrolled_height(height);
            ui.spacing_mut().item_spacing.y = 0.0;
            if let Some(pointed) = chooser.pointed()
                && is_pointing
            {
                area = area.vertical_scroll_offset(offset_for(pointed, height));
            }
            // One row stands for none: it says so.
            area.show_rows(ui, ROW_HEIGHT, count.max(1), |ui, rows| {
                if count == 0 {
                    ui.horizontal(|ui| {
                        ui.add_space(GAP);
                        ui.label(RichText::new("Nothing here").color(Palette::in_ui(ui).quiet));
                    });
                }
                for index in rows {
                    let Some(item) = chooser.row(index) else {
                        continue;
                    };
                    let is_ticked = chooser.is_ticked(&item.path);
                    let chosen = chooser.pointed() == Some(index) || is_ticked;
                    let (rect, response) = row::row(ui, ROW_HEIGHT, chosen, &item.name);
                    let palette = Palette::in_ui(ui);
                    let icon = Rect::from_center_size(
                        pos2(rect.left() + 16.0, rect.center().y),
                        vec2(15.0, 15.0),
                    );
                    let (picture, color) = match item.is_file {
                        true => (Icon::File, palette.quiet),
                        false => (Icon::Folder, palette.accent),
                    };
                    icons::draw(ui.painter(), picture, icon, color);
                    let room = rect.with_min_x(rect.left() + 32.0).shrink2(vec2(4.0, 0.0));
                    let name =
                        elide::name_within(ui, &item.name, &item.branches, &font, room.width());
                    let is_whole = name == item.name;
                    row::text_in(ui, room, RichText::new(name), palette.text);
                    let response = if is_whole {
                        response
                    } else {
                        response.on_hover_text(&item.name)
                    };
                    if response.clicked() {
                        let modifiers = ui.input(|i| i.modifiers);
                        clicked = Some((index, modifiers.command || modifiers.shift));
                    }
                    opened |= response.double_clicked() && item.is_file;
                }
            });
        });
    let (index, ticks) = clicked?;
    chooser.click(index, ticks);
    if opened && !ticks {
        return chooser.enter();
    }
    // The field is typed into again.
    ui.memory_mut(|memory| memory.request_focus(field_id()));
    cursor_to_end(ui, chooser);
    None
}

/// How far the list is scrolled so that a row is in the middle of it.
fn offset_for(row: usize, height: f32) -> f32 {
    let above = ROW_HEIGHT * row as f32;
    (above - height / 2.0 + ROW_HEIGHT / 2.0).max(0.0)
}

fn buttons(ui: &mut Ui, chooser: &mut Chooser, shown: &mut Shown) -> Option<Vec<PathBuf>> {
    let count = chooser.ticked_count();
    let accept = match chooser.ask().goal {
        Goal::OpenFiles if count > 0 => format!("Open {count}"),
        Goal::OpenFiles => "Open".to_owned(),
        Goal::OpenFolder => "Open this folder".to_owned(),
        Goal::SaveFile => "Save".to_owned(),
    };
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        let palette = Palette::in_ui(ui);
        let accept = Button::new(RichText::new(accept).color(palette.accent).strong());
        if ui.add(accept).clicked() {
            chosen = chooser.enter();
        }
        if ui.button("Cancel").clicked() {
            *shown = Shown::Cancelled;
        }
        if chooser.ask().goal != Goal::OpenFolder {
            let mut all = chooser.shows_all();
            if ui.checkbox(&mut all, "All files").changed() {
                chooser.set_shows_all(all);
            }
        }
        if chooser.ask().goal == Goal::OpenFiles {
            let says = "Ctrl click for several";
            ui.label(RichText::new(says).small().color(palette.quiet));
        }
    });
    chosen
}
