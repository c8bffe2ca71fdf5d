//! The library: the clips that are open, and those of a folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use egui::{Color32, Rect, RichText, ScrollArea, Ui, pos2, vec2};
use posekit_render::theme::CharacterColors;

use super::{Asked, Request, elide, row, tip};
use crate::command::Command;
use crate::icons::{self, Icon, icon_button, sized_icon};
use crate::load::{Job, SummaryNumbers};
use crate::picture::Texture;
use crate::state::clip::Source;
use crate::state::library::{Entry, EntryState, Library};
use crate::state::names;
use crate::state::session::{ClipId, OpenClip, Session};
use crate::theme::{GAP, Palette};

/// What stands between the numbers of a clip.
const PART: &str = "  \u{b7}  ";

/// Height of a row with a preview picture.
const CLIP_ROW: f32 = 52.0;

/// A clip of the folder, as the library shows it.
#[derive(Clone, Debug)]
pub struct Preview {
    /// Its numbers.
    pub numbers: SummaryNumbers,
    /// Its picture.
    pub picture: Texture,
}

/// Shows the library.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    library: &mut Library<Preview>,
    pictures: &BTreeMap<ClipId, Texture>,
    jobs: &[Job],
    asked: &mut Asked,
) {
    row::heading(ui, "Clips", |ui| {
        // A page sees no folders.
        let folder = tip("Open a folder", Command::OpenFolder);
        if cfg!(not(target_arch = "wasm32")) && icon_button(ui, Icon::Folder, &folder).clicked() {
            asked.command(Command::OpenFolder);
        }
        if icon_button(ui, Icon::File, &tip("Open files", Command::Open)).clicked() {
            asked.command(Command::Open);
        }
    });
    search(ui, &mut library.filter, "Filter clips");
    ui.add_space(GAP);
    ScrollArea::vertical()
        .id_salt("clips")
        .min_scrolled_height(CLIP_ROW)
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            for job in jobs {
                reading(ui, job);
            }
            let branches = branches_of_open(session, library);
            for (open, branches) in session
                .clips()
                .iter()
                .zip(&branches)
                .filter(|(open, _)| library.passes(&open.clip.name))
            {
                let row = open_clip(ui, session, (open, branches), pictures.get(&open.id), asked);
                if session.active_id() == Some(open.id) {
                    bring_into_sight(ui, open.id, row);
                }
            }
            if session.clips().is_empty() && jobs.is_empty() {
                row::empty_note(ui, "Nothing is open. Drop a BVH file here.");
            }
            folder(ui, session, library, asked);
        });
}

/// Where the name of each open clip goes another way than those of the other open ones, and than those of the
/// folder that it is in: one of two that are alike may be open, and the other listed below.
fn branches_of_open(session: &Session, library: &Library<Preview>) -> Vec<Vec<usize>> {
    let names: Vec<&str> = session
        .clips()
        .iter()
        .map(|it| it.clip.name.as_str())
        .collect();
    let mut branches = names::branches(&names);
    for (name, branches) in names.iter().zip(&mut branches) {
        if let Some(entry) = library.entries.iter().find(|entry| entry.name == *name) {
            branches.extend_from_slice(&entry.branches);
            branches.sort_unstable();
            branches.dedup();
        }
    }
    branches
}

/// Brings the row of a clip that has become the active one into sight. Rows come and go while clips are read: it is
/// brought there until it was seen, or the wheel is turned.
fn bring_into_sight(ui: &Ui, active: ClipId, row: Rect) {
    let id = ui.scope_id().with("active clip");
    let seen: Option<ClipId> = ui.data(|data| data.get_temp(id));
    if seen == Some(active) {
        return;
    }
    let is_in_sight = ui.clip_rect().y_range().contains(row.center().y);
    if is_in_sight || ui.input(|i| i.smooth_scroll_delta != egui::Vec2::ZERO) {
        ui.data_mut(|data| data.insert_temp(id, active));
    }
    ui.scroll_to_rect(row, None);
}

/// A field to type a filter into.
pub fn search(ui: &mut Ui, filter: &mut String, hint: &str) -> egui::Response {
    let palette = Palette::in_ui(ui);
    let edit = egui::TextEdit::singleline(filter)
        .hint_text(RichText::new(hint).color(palette.quiet))
        .align(egui::Align2::LEFT_CENTER)
        .desired_width(f32::INFINITY)
        .margin(egui::Margin {
            left: 28,
            right: 24,
            top: 4,
            bottom: 4,
        });
    let response = ui.add(edit);
    let rect = response.rect;
    let glass = Rect::from_center_size(pos2(rect.left() + 15.0, rect.center().y), vec2(13.0, 13.0));
    icons::draw(ui.painter(), Icon::Search, glass, palette.quiet);
    if !filter.is_empty() {
        let place =
            Rect::from_center_size(pos2(rect.right() - 13.0, rect.center().y), vec2(20.0, 20.0));
        let mut over = ui.new_child(egui::UiBuilder::new().max_rect(place));
        if sized_icon(&mut over, Icon::Close, "Show all", false, place.size()).clicked() {
            filter.clear();
            // Another word is typed next, and without the focus its letters would be keys of the window.
            response.request_focus();
        }
    }
    // The key takes the focus away before anything is shown.
    if response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Escape)) {
        filter.clear();
    }
    response
}

/// A file that is being read.
fn reading(ui: &mut Ui, job: &Job) {
    let palette = Palette::in_ui(ui);
    let room = vec2(ui.available_width(), CLIP_ROW);
    // From the right, so that what is left for the name is known, and the panel does not grow.
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    ui.allocate_ui_with_layout(room, layout, |ui| {
        if icon_button(ui, Icon::Close, "Stop reading").clicked() {
            job.progress.cancel();
        }
        ui.vertical(|ui| {
            ui.add_space(2.0 * GAP);
            ui.add(egui::Label::new(format!("Reading {}", job.name)).truncate());
            let bar = egui::ProgressBar::new(job.progress.fraction().unwrap_or(0.0));
            ui.add(bar.desired_height(6.0).fill(palette.accent));
        });
    });
}

/// A clip that is open; where its row is.
fn open_clip(
    ui: &mut Ui,
    session: &Session,
    (open, branches): (&OpenClip, &[usize]),
    picture: Option<&Texture>,
    asked: &mut Asked,
) -> Rect {
    let chosen = session.active_id() == Some(open.id);
    let clip = &open.clip;
    let (rect, response) = row::row(ui, CLIP_ROW, chosen, &clip.name);
    let last = if session.is_edited(open.id) {
        "edited".to_owned()
    } else {
        format!("{} joints", clip.skeleton().joint_count())
    };
    let numbers = format!(
        "{}  \u{b7}  {} fps  \u{b7}  {last}",
        duration_text(clip.motion.duration_secs()),
        fps_text(clip.fps()),
    );
    let swatch = open.shown.then(|| color_of(open.color));
    let texts = Texts {
        name: &clip.name,
        branches,
        below: &numbers,
        picture,
        swatch,
    };
    let is_pointed_at = response.hovered() || response.contains_pointer();
    let buttons = buttons_of(open, chosen, is_pointed_at);
    paint_clip(ui, rect, &texts, room_for(buttons.len()));
    for (slot, (icon, says, on, request)) in buttons.into_iter().enumerate() {
        if row_button(ui, rect, slot, (icon, says, on), open.id).clicked() {
            asked.requests.push(request);
        }
    }
    let response = if clip.report.is_empty() {
        response.on_hover_text(&clip.name)
    } else {
        response.on_hover_text(format!("{}\n{}", clip.name, report_text(clip)))
    };
    if response.clicked() {
        let adds = ui.input(|i| i.modifiers.shift || i.modifiers.command);
        asked.requests.push(if adds {
            Request::SetShown(open.id, !open.shown)
        } else {
            Request::Activate(open.id)
        });
    }
    rect
}

/// A button of a row: what it shows, says, whether it is on, and what it asks for.
type RowButton = (Icon, &'static str, bool, Request);

/// What a file's row offers beside being opened.
const SHOW_TEXT: &str = "Show the text of the file";
const DOWNLOAD: &str = "Download the file as it is";

/// The buttons of an open clip, from the right: all of them where the pointer is, and without it the eye of
/// one that is compared.
fn buttons_of(open: &OpenClip, chosen: bool, is_pointed_at: bool) -> Vec<RowButton> {
    let mut buttons = Vec::new();
    if is_pointed_at || (open.shown && !chosen) {
        buttons.push((Icon::Close, "Close", false, Request::Close(open.id)));
    }
    if !chosen && (is_pointed_at || open.shown) {
        let (icon, says) = if open.shown {
            (Icon::Eye, "Take it off the stage")
        } else {
            (
                Icon::EyeOff,
                "Compare: put it on the stage beside the active clip",
            )
        };
        let request = Request::SetShown(open.id, !open.shown);
        buttons.push((icon, says, open.shown, request));
    }
    if is_pointed_at && open.clip.text.is_some() {
        buttons.push((Icon::Text, SHOW_TEXT, false, Request::ShowText(open.id)));
    }
    if is_pointed_at
        && cfg!(target_arch = "wasm32")
        && let Source::File(address) = &open.clip.source
    {
        let request = Request::Download(address.clone());
        buttons.push((Icon::Download, DOWNLOAD, false, request));
    }
    buttons
}

/// The room that a row's buttons take from its name.
fn room_for(buttons: usize) -> f32 {
    let buttons = u8::try_from(buttons).unwrap_or(u8::MAX);
    f32::from(buttons) * BUTTON_STEP
}

/// From one button of a row to the next.
const BUTTON_STEP: f32 = 26.0;

/// A button in a row, counted from the right.
fn row_button(
    ui: &mut Ui,
    rect: Rect,
    slot: usize,
    (icon, says, on): (Icon, &str, bool),
    id: impl std::hash::Hash + Copy + std::fmt::Debug,
) -> egui::Response {
    let size = vec2(24.0, 24.0);
    let center = pos2(rect.right() - 16.0 - room_for(slot), rect.center().y);
    let place = Rect::from_center_size(center, size);
    let builder = egui::UiBuilder::new().max_rect(place).id_salt((id, says));
    let mut button = ui.new_child(builder);
    sized_icon(&mut button, icon, says, on, size)
}

fn report_text(clip: &crate::state::clip::Clip) -> String {
    const LISTED: usize = 6;
    let warnings = &clip.report.warnings;
    let mut lines: Vec<String> = warnings
        .iter()
        .take(LISTED)
        .map(|warning| warning.to_string())
        .collect();
    if warnings.len() > LISTED {
        lines.push(format!("and {} more", warnings.len() - LISTED));
    }
    lines.join("\n")
}

/// What a clip's row shows.
struct Texts<'a> {
    name: &'a str,
    /// Where it goes another way than the names beside it, in bytes.
    branches: &'a [usize],
    below: &'a str,
    picture: Option<&'a Texture>,
    swatch: Option<Color32>,
}

fn paint_clip(ui: &Ui, rect: Rect, texts: &Texts<'_>, room_for_buttons: f32) {
    let palette = Palette::in_ui(ui);
    let picture_rect =
        Rect::from_center_size(pos2(rect.left() + 28.0, rect.center().y), vec2(44.0, 44.0));
    ui.painter().rect_filled(picture_rect, 5.0, palette.sunken);
    if let Some(picture) = texts.picture {
        egui::Image::new((picture.id(), picture_rect.size()))
            .corner_radius(5)
            .paint_at(ui, picture_rect);
    }
    let left = picture_rect.right() + 2.0 * GAP;
    let right = rect.right() - GAP - room_for_buttons;
    let line = |top: f32, bottom: f32| {
        Rect::from_min_max(
            pos2(left, rect.top() + top),
            pos2(right.max(left), rect.top() + bottom),
        )
    };
    let place = line(7.0, 27.0);
    let font = egui::TextStyle::Body.resolve(ui.style());
    let name = elide::name_within(ui, texts.name, texts.branches, &font, place.width());
    row::text_in(ui, place, RichText::new(name), palette.text);
    let place = line(26.0, 46.0);
    let small = egui::TextStyle::Small.resolve(ui.style());
    let below = elide::parts_within(ui, texts.below, PART, &small, place.width());
    let below = RichText::new(below).small();
    row::text_in(ui, place, below, palette.quiet);
    if let Some(color) = texts.swatch {
        let bar = Rect::from_min_size(
            pos2(rect.left() + 1.0, rect.top() + 10.0),
            vec2(3.0, rect.height() - 20.0),
        );
        ui.painter().rect_filled(bar, 2.0, color);
    }
}

/// The colour that stands for a figure.
#[must_use]
pub fn color_of(index: usize) -> Color32 {
    let colors = CharacterColors::of(index);
    let color = if index == 0 { colors.left } else { colors.base };
    let [r, g, b] = color.to_srgb_bytes();
    Color32::from_rgb(r, g, b)
}

fn folder(ui: &mut Ui, session: &Session, library: &mut Library<Preview>, asked: &mut Asked) {
    let Some(folder) = &library.folder else {
        return;
    };
    let name = folder
        .file_name()
        .unwrap_or(folder.as_os_str())
        .to_string_lossy()
        .into_owned();
    row::divider(ui);
    let room = ui.available_width() - 80.0;
    let font = egui::FontId::proportional(12.5);
    let shown = elide::name_within(ui, &name, &[], &font, room);
    row::heading(ui, &shown, |ui| {
        if icon_button(ui, Icon::Close, "Close the folder").clicked() {
            asked.requests.push(Request::CloseFolder);
        }
        let count = library.entries.len();
        let unknown = library.unknown_count();
        let text = if unknown > 0 {
            format!("{} of {count}", count - unknown)
        } else {
            count.to_string()
        };
        ui.label(RichText::new(text).small().color(Palette::in_ui(ui).quiet));
    });
    let is_open = |path: &PathBuf| {
        session
            .clips()
            .iter()
            .any(|open| matches!(&open.clip.source, Source::File(file) if file == path))
    };
    if let Some(shortage) = &library.shortage {
        let warning = Palette::in_ui(ui).warning;
        ui.add(egui::Label::new(RichText::new(shortage).small().color(warning)).wrap());
        ui.add_space(GAP);
    }
    let groups = library.groups(|entry| !is_open(&entry.path));
    if groups.is_empty() {
        let says = if library.entries.is_empty() {
            "There is no clip in it."
        } else if library.filter.trim().is_empty() {
            "All its clips are open."
        } else {
            "No clip here passes the filter."
        };
        row::empty_note(ui, says);
    }
    let has_folders = groups.iter().any(|(group, _)| !group.is_empty());
    let mut toggled = None;
    for (group, entries) in groups {
        if has_folders && !group.is_empty() {
            let is_open = library.is_open(group);
            if group_row(ui, group, entries.len(), is_open).clicked() {
                toggled = Some(group.to_owned());
            }
            if !is_open {
                continue;
            }
        }
        for entry in entries {
            listed(ui, entry, asked);
        }
    }
    if let Some(group) = toggled {
        library.toggle(&group);
    }
}

/// The heading of a folder in the folder: its files can be put away.
fn group_row(ui: &mut Ui, group: &str, count: usize, is_open: bool) -> egui::Response {
    const HEIGHT: f32 = 28.0;
    let (rect, mut response) = row::row(ui, HEIGHT, false, group);
    let palette = Palette::in_ui(ui);
    let sign = Rect::from_center_size(pos2(rect.left() + 12.0, rect.center().y), vec2(12.0, 12.0));
    let mut painted = response.clone();
    painted.rect = sign;
    egui::collapsing_header::paint_default_icon(ui, if is_open { 1.0 } else { 0.0 }, &painted);
    let count = ui.painter().layout_no_wrap(
        count.to_string(),
        egui::TextStyle::Small.resolve(ui.style()),
        palette.quiet,
    );
    let right = rect.right() - GAP - count.size().x;
    let at = pos2(right, rect.center().y - count.size().y / 2.0);
    ui.painter().galley(at, count, palette.quiet);
    let room = Rect::from_min_max(
        pos2(rect.left() + 24.0, rect.top()),
        pos2(right - GAP, rect.bottom()),
    );
    let font = egui::TextStyle::Body.resolve(ui.style());
    let text = elide::path_within(ui, group, &font, room.width());
    row::text_in(ui, room, RichText::new(text).strong(), palette.text);
    response = response.on_hover_text(if is_open {
        format!("{group}: put its clips away")
    } else {
        format!("{group}: show its clips")
    });
    response
}

/// A clip of the folder that is not open.
fn listed(ui: &mut Ui, entry: &Entry<Preview>, asked: &mut Asked) {
    // Rows that are scrolled away are not worth their text.
    let next = ui.next_widget_position();
    let place = Rect::from_min_size(next, vec2(ui.available_width(), CLIP_ROW));
    if !ui.is_rect_visible(place) {
        ui.allocate_exact_size(place.size(), egui::Sense::hover());
        return;
    }
    let (rect, response) = row::row(ui, CLIP_ROW, false, &entry.name);
    let (below, picture) = match &entry.state {
        EntryState::Unknown => ("\u{2026}".to_owned(), None),
        EntryState::Ready(preview) => (
            format!(
                "{}  \u{b7}  {} fps  \u{b7}  {} joints",
                duration_text(preview.numbers.duration_secs),
                fps_text(preview.numbers.fps),
                preview.numbers.joint_count
            ),
            Some(&preview.picture),
        ),
        EntryState::Refused(why) => (why.clone(), None),
    };
    let texts = Texts {
        name: &entry.name,
        branches: &entry.branches,
        below: &below,
        picture,
        swatch: None,
    };
    let is_pointed_at = response.hovered() || response.contains_pointer();
    let buttons = buttons_of_listed(&entry.path, is_pointed_at);
    paint_clip(ui, rect, &texts, room_for(buttons.len()));
    for (slot, (icon, says, on, request)) in buttons.into_iter().enumerate() {
        if row_button(ui, rect, slot, (icon, says, on), &entry.path).clicked() {
            asked.requests.push(request);
        }
    }
    // On a page the path is an address, with signs for blanks.
    let whole = if cfg!(target_arch = "wasm32") {
        entry.name.clone()
    } else {
        entry.path.display().to_string()
    };
    let response = match &entry.state {
        EntryState::Refused(why) => response.on_hover_text(format!("{whole}\n{why}")),
        EntryState::Unknown | EntryState::Ready(_) => response.on_hover_text(whole),
    };
    if response.clicked() {
        let beside = ui.input(|i| i.modifiers.shift || i.modifiers.command);
        asked
            .requests
            .push(Request::OpenPath(entry.path.clone(), beside));
    }
}

/// The buttons of a file that is listed, from the right: a page always offers to save it.
fn buttons_of_listed(path: &Path, is_pointed_at: bool) -> Vec<RowButton> {
    let mut buttons = Vec::new();
    if cfg!(target_arch = "wasm32") {
        let request = Request::Download(path.to_owned());
        buttons.push((Icon::Download, DOWNLOAD, false, request));
    }
    if is_pointed_at {
        let request = Request::ShowTextOf(path.to_owned());
        buttons.push((Icon::Text, SHOW_TEXT, false, request));
    }
    buttons
}

/// A duration as people say it.
#[must_use]
pub fn duration_text(secs: f64) -> String {
    if secs < 60.0 {
        format!("{secs:.1} s")
    } else {
        super::transport::clock_text(secs)
    }
}

/// A frame rate with as many digits as it has.
#[must_use]
pub fn fps_text(fps: f64) -> String {
    let rounded = (fps * 100.0).round() / 100.0;
    if (fps - fps.round()).abs() < 0.02 {
        format!("{fps:.0}")
    } else {
        format!("{rounded}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_rates_have_only_the_digits_they_need() {
        assert_eq!(fps_text(1.0 / 0.008_333_3), "120");
        assert_eq!(fps_text(29.97), "29.97");
        assert_eq!(fps_text(0.0), "0");
    }
}
