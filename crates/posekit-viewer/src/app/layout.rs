//! Where the panels stand.

use egui::{CentralPanel, Color32, Frame, Key, Margin, Panel, Rect, RichText, Ui, Vec2};
use posekit::rotation::Axis;

use super::Viewer;
use super::poses::Left;
use crate::command::{self, Command, Place};
use crate::load::Job;
use crate::panels::inspector::Checking;
use crate::panels::sides::{Room, Side, Sides, within};
use crate::panels::{Asked, curves, export, help, inspector, joints, library, notices, row};
use crate::panels::{text, top_bar, transport, view};
use crate::state::mode::Mode;
use crate::theme::{self, Palette};

/// Beside a text the figure has at least this width, and the text that one.
const VIEW_LEAST: f32 = 240.0;
const TEXT_LEAST: f32 = 240.0;

/// What is below the view is never lower than this.
pub(super) const LOWEST_BELOW: f32 = 120.0;

/// What is above it is never lower than this: the view, and the view with a side beside it.
const VIEW_LOWEST: f32 = 130.0;
const SIDE_LOWEST: f32 = 190.0;

/// The clips and the joints stand over each other where there is this much room, and take turns otherwise.
const CLIPS_AND_JOINTS: f32 = 400.0;

/// The joint tree is never lower than this.
const JOINTS_LEAST: f32 = 230.0;

impl Viewer {
    /// Takes the keys that were pressed, unless somebody is typing.
    pub(super) fn take_keys(&mut self, ui: &mut Ui, asked: &mut Asked) {
        let busy = self.help_open
            || self.messages_open
            || self.is_asking()
            || self.is_choosing()
            || !matches!(self.export, export::ExportWindow::Closed);
        // The key that ends typing takes the focus away before anything is shown; it is the field's all the same.
        let ends_typing = self.was_typing && ui.input(|i| i.key_pressed(Key::Escape));
        if ui.ctx().text_edit_focused() || ends_typing {
            return;
        }
        if busy {
            // Windows over the view have the keys; the list closes with the key that opened it.
            let closes = |command| command == Command::ToggleHelp;
            let pressed = ui.input_mut(|i| command::pressed_of(i, Place::Anywhere, closes));
            asked.commands.extend(pressed);
            return;
        }
        if egui::Popup::is_any_open(ui.ctx()) && ui.input(|i| i.key_pressed(Key::Escape)) {
            // It closes the menu or list that is open, and nothing else.
            return;
        }
        if self.take_keys_in_lab(ui) || self.take_keys_in_interpolation(ui) {
            return;
        }
        if self.take_keys_of_timeline(ui) || self.take_keys_of_poses(ui) {
            return;
        }
        if self.session.is_dragging() {
            self.take_keys_of_drag(ui);
            return;
        }
        self.take_clipboard_keys(ui, asked);
        let place = self.place_of_keys(ui);
        asked
            .commands
            .extend(ui.input_mut(|i| command::pressed(i, place)));
        if ui.input_mut(|i| i.consume_key(egui::Modifiers::NONE, egui::Key::Escape))
            && !self.session.stop_stepping()
        {
            asked.command(Command::Deselect);
        }
    }

    /// While a handle is held there is one key: the one that lets it go without effect. What is in hand is
    /// kept with another, and held to an axis by its name.
    fn take_keys_of_drag(&mut self, ui: &Ui) {
        let pressed = |key| ui.input_mut(|i| i.consume_key(egui::Modifiers::NONE, key));
        if pressed(Key::Escape) {
            self.session.cancel_drag();
        }
        if !self.session.is_in_hand() {
            return;
        }
        if pressed(Key::Enter) {
            self.session.drop_handle();
        }
        for (key, axis) in [(Key::X, Axis::X), (Key::Y, Axis::Y), (Key::Z, Axis::Z)] {
            if pressed(key) {
                self.session.hold_to_axis(axis);
            }
        }
    }

    /// Shows all panels and the view.
    pub(super) fn show_panels(&mut self, ui: &mut Ui, asked: &mut Asked) {
        self.sides = Sides::of(self.layout, ui.available_size());
        self.fit_fingers(ui);
        let sides = self.sides;
        let panel = Frame::NONE.fill(ui.visuals().panel_fill);
        Panel::top("top")
            .frame(panel.inner_margin(Margin::symmetric(8, 4)))
            .exact_size(ui.spacing().interact_size.y + 16.0)
            .show(ui, |ui| top_bar::show(ui, &mut self.session, sides, asked));
        if self.session.mode() == Mode::Lab {
            self.show_lab(ui, asked);
            return;
        }
        if self.session.mode() == Mode::Interpolation {
            self.show_interpolation(ui, asked);
            return;
        }
        Panel::bottom("transport")
            .frame(panel.inner_margin(Margin::symmetric(8, 2)))
            .resizable(false)
            .show(ui, |ui| {
                self.places.time_line = transport::show(ui, &mut self.session, asked);
            });
        // Where there is room for one thing it is the side.
        self.has_room_below = !sides.is_under_view() && self.room_below(ui) >= LOWEST_BELOW;
        if self.has_room_below {
            self.show_timeline(ui, asked);
        } else {
            self.timeline.hide();
        }
        let is_narrow = sides.room != Room::Wide;
        let has_text_below = self.layout.text && is_narrow;
        let text_least = if has_text_below { LOWEST_BELOW } else { 0.0 };
        let most = self.room_below(ui) - text_least;
        if self.layout.curves && self.has_room_below && most >= LOWEST_BELOW {
            Panel::bottom("curves")
                .frame(panel.inner_margin(Margin::symmetric(8, 6)))
                .resizable(true)
                .default_size(190.0)
                .size_range(LOWEST_BELOW..=most.min(480.0))
                .show(ui, |ui| {
                    curves::show(ui, &mut self.session, &mut self.curves);
                    // A panel that is not full becomes as small as what is in it, and its edge cannot be dragged.
                    ui.take_available_space();
                });
        }
        self.places.text = text::TextPlaces::NONE;
        let most = self.room_below(ui);
        if has_text_below && self.has_room_below && most >= LOWEST_BELOW {
            Panel::bottom("text below")
                .frame(panel.inner_margin(Margin::symmetric(8, 6)))
                .resizable(true)
                .default_size(220.0)
                .size_range(LOWEST_BELOW..=most.min(480.0))
                .show(ui, |ui| self.show_text(ui, asked));
        }
        if sides.left {
            sides
                .panel(Side::Left, "left", (180.0, 256.0), ui)
                .frame(panel.inner_margin(Margin::symmetric(8, 6)))
                .show(ui, |ui| within(ui, |ui| self.show_left(ui, asked)));
        }
        if sides.right {
            sides
                .panel(Side::Right, "right", (240.0, 292.0), ui)
                .frame(panel.inner_margin(Margin::symmetric(10, 6)))
                .show(ui, |ui| {
                    let id = self.session.active_id();
                    let checking = match id.is_some_and(|id| self.checking.contains(&id)) {
                        true => Checking::Running,
                        false => Checking::Done,
                    };
                    within(ui, |ui| {
                        inspector::show(ui, &mut self.session, checking, asked)
                    });
                });
        }
        if self.layout.text && !is_narrow {
            let most = (ui.available_width() - VIEW_LEAST).max(TEXT_LEAST);
            Panel::right("text")
                .frame(panel.inner_margin(Margin::symmetric(8, 6)))
                .resizable(true)
                .default_size(420.0)
                .size_range(TEXT_LEAST..=most)
                .show(ui, |ui| self.show_text(ui, asked));
        }
        CentralPanel::no_frame().show(ui, |ui| {
            let rect = ui.available_rect_before_wrap();
            self.places.view = rect;
            let below = if self.has_room_below {
                view::Below::Mode
            } else {
                view::Below::Side
            };
            let free = view::show(ui, &mut self.session, &mut self.painter, below, asked);
            self.show_over_view(ui, (rect, free), asked);
        });
    }

    /// How high what is below the view may be.
    pub(super) fn room_below(&self, ui: &Ui) -> f32 {
        let has_side = self.sides.left || self.sides.right;
        let above = if has_side { SIDE_LOWEST } else { VIEW_LOWEST };
        ui.available_height() - above
    }

    /// Shows the text of the active clip's file, which is made ready when it is not.
    fn show_text(&mut self, ui: &mut Ui, asked: &mut Asked) {
        if let Some(bytes) = self.text.wants(&self.session) {
            self.loader.lay_out(bytes);
        }
        self.places.text = text::show(ui, &mut self.session, &mut self.text, asked);
    }

    /// On a screen that is touched, and in a window as upright as a phone, what is pressed is as large as a
    /// fingertip.
    fn fit_fingers(&self, ui: &mut Ui) {
        let is_touched = ui.input(|i| i.has_touch_screen());
        let row = if is_touched || self.sides.room == Room::Upright {
            theme::FINGER
        } else {
            theme::ROW
        };
        if (ui.spacing().interact_size.y - row).abs() > 0.1 {
            ui.ctx().all_styles_mut(|style| theme::set_row(style, row));
            theme::set_row(ui.style_mut(), row);
        }
    }

    fn show_left(&mut self, ui: &mut Ui, asked: &mut Asked) {
        let is_low = ui.available_height() < CLIPS_AND_JOINTS;
        match self.choose_left(ui, is_low) {
            Left::Poses => self.show_poses(ui),
            Left::Clips => self.show_clips(ui, asked),
            Left::Joints => drop(joints::show(ui, &mut self.session, &mut self.tree)),
            Left::ClipsAndJoints => {
                let least = JOINTS_LEAST.min(0.5 * ui.available_height());
                Panel::bottom("joints")
                    .frame(Frame::NONE)
                    .resizable(true)
                    .default_size(330.0)
                    .size_range(least..=(ui.available_height() - 160.0).max(least))
                    .show(ui, |ui| {
                        ui.add_space(4.0);
                        joints::show(ui, &mut self.session, &mut self.tree);
                    });
                CentralPanel::no_frame().show(ui, |ui| self.show_clips(ui, asked));
            }
        }
    }

    fn show_clips(&mut self, ui: &mut Ui, asked: &mut Asked) {
        library::show(
            ui,
            &self.session,
            &mut self.library,
            &self.pictures,
            self.loader.jobs(),
            asked,
        );
    }

    /// Shows what lies over the view; `free` is where the room under its tools begins.
    pub(super) fn show_over_view(&mut self, ui: &Ui, (rect, free): (Rect, f32), asked: &mut Asked) {
        let below_tools = rect.with_min_y(free.min(rect.bottom()));
        if notices::show(ui, below_tools, &mut self.notices, asked) {
            asked.command(Command::ShowMessages);
        }
        let hovering = ui.input(|i| !i.raw.hovered_files.is_empty());
        let palette = Palette::in_ui(ui);
        if hovering {
            let room = rect.shrink(16.0);
            let painter = ui.painter();
            painter.rect_filled(room, 12.0, palette.accent_soft.gamma_multiply(0.85));
            let edge = egui::Stroke::new(2.0, palette.accent);
            painter.rect_stroke(room, 12.0, edge, egui::StrokeKind::Inside);
            let text = RichText::new("Drop to open").size(20.0);
            let place = Rect::from_center_size(room.center(), Vec2::new(130.0, 30.0));
            row::text_in(ui, place, text, palette.text);
        }
        let is_stage = !self.session.mode().is_lab();
        if is_stage
            && self.session.clips().is_empty()
            && let Some(job) = self.loader.jobs().first()
        {
            show_reading(ui, rect, job);
        }
        if is_stage && self.session.clips().is_empty() && self.loader.jobs().is_empty() && !hovering
        {
            let text = "Drop a BVH file or a scene here, or open one with Ctrl+O";
            let font = egui::FontId::proportional(15.0);
            let room = (rect.width() - 32.0).max(60.0);
            let mut job = egui::text::LayoutJob::simple(text.to_owned(), font, palette.quiet, room);
            job.halign = egui::Align::Center;
            let galley = ui.painter().layout_job(job);
            let at = rect.center() - Vec2::new(0.0, galley.size().y / 2.0);
            ui.painter().galley(at, galley, palette.quiet);
        }
    }

    /// Whether a file is asked for in the window.
    fn is_choosing(&self) -> bool {
        #[cfg(not(target_arch = "wasm32"))]
        return self.dialogs.is_asking();
        #[cfg(target_arch = "wasm32")]
        false
    }

    /// Shows the windows over everything. True when one of them has changed by that.
    pub(super) fn show_windows(&mut self, ctx: &egui::Context, asked: &mut Asked) -> bool {
        self.show_questions(ctx);
        #[cfg(not(target_arch = "wasm32"))]
        let was_chosen = self.show_chooser(ctx);
        #[cfg(target_arch = "wasm32")]
        let was_chosen = false;
        let help_was_open = self.help_open;
        if self.help_open {
            self.help_open = help::show(ctx, &mut self.help_search, asked);
        }
        if self.messages_open {
            self.messages_open = notices::show_all(ctx, &self.notices);
        }
        let (first, last) = self.session.transport.range();
        let cameras = self.camera_names();
        self.follow_export_size();
        let answer = export::show(ctx, &mut self.export, last - first + 1, &cameras);
        match answer {
            export::Answer::None => {}
            export::Answer::Start => self.ask_where_to_export(),
            export::Answer::Cancel => {
                if let export::ExportWindow::Running(running) = &self.export {
                    running.cancel();
                }
                self.export = export::ExportWindow::Closed;
            }
        }
        if let export::ExportWindow::Running(running) = &self.export
            && running.is_finished()
        {
            self.export = export::ExportWindow::Closed;
            return true;
        }
        was_chosen || answer != export::Answer::None || self.help_open != help_was_open
    }
}

/// What is being read, where there is nothing else to see, and a way to give it up.
fn show_reading(ui: &Ui, rect: Rect, job: &Job) {
    let middle = egui::Area::new(egui::Id::unique("reading"))
        .pivot(egui::Align2::CENTER_CENTER)
        .constrain_to(rect)
        .fixed_pos(rect.center());
    middle.show(ui.ctx(), |ui| {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(format!("Reading {}\u{2026}", job.name));
            if ui.button("Give up").clicked() {
                job.progress.cancel();
            }
        });
    });
}

/// What the window is cleared with, before anything is drawn.
#[must_use]
pub(super) fn clear_color(visuals: &egui::Visuals) -> [f32; 4] {
    Color32::to_normalized_gamma_f32(visuals.panel_fill)
}
