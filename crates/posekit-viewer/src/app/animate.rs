//! The animation mode in the window: the timeline, and what commands mean in it.

use std::sync::Arc;

use egui::{Event, Frame, Key, Margin, Modifiers, Panel, Ui};

use super::Viewer;
use super::layout::LOWEST_BELOW;
use crate::command::{Command, KeysCommand, Place};
use crate::panels::{Asked, timeline};
use crate::state::animate::{self, Authored, Start};
use crate::state::clip::Source;
use crate::state::mode::Mode;
use crate::state::notices::NoticeKind;
use crate::state::session::ClipId;

impl Viewer {
    /// Shows the timeline over the transport, while motion is authored.
    pub(super) fn show_timeline(&mut self, ui: &mut Ui, asked: &mut Asked) {
        if self.session.mode() != Mode::Animate {
            self.timeline.hide();
            return;
        }
        let most = self.room_below(ui).max(LOWEST_BELOW);
        Panel::bottom("timeline")
            .frame(
                Frame::NONE
                    .fill(ui.visuals().panel_fill)
                    .inner_margin(Margin::symmetric(8, 6)),
            )
            .resizable(true)
            .default_size(246.0)
            .size_range(LOWEST_BELOW..=most)
            .show(ui, |ui| {
                timeline::show(ui, &mut self.session, &mut self.timeline, asked);
            });
    }

    /// While keys follow the pointer there are two keys: the one that lets them be where they are, and the
    /// one that gives that up. True when they were looked for.
    pub(super) fn take_keys_of_timeline(&mut self, ui: &mut Ui) -> bool {
        if !self.timeline.is_busy() {
            return false;
        }
        let pressed = |ui: &mut Ui, key| ui.input_mut(|i| i.consume_key(Modifiers::NONE, key));
        if pressed(ui, Key::Escape) {
            self.timeline.cancel(&mut self.session);
        } else if pressed(ui, Key::Enter) {
            self.timeline.confirm();
        }
        ui.input_mut(|i| self.timeline.take_lock_keys(i));
        true
    }

    /// Where keys are pressed.
    pub(super) fn place_of_keys(&self, ui: &Ui) -> Place {
        if self.session.mode().is_lab() || self.session.authored().is_none() {
            return Place::Anywhere;
        }
        let pointer = ui.input(|i| i.pointer.hover_pos());
        let rect = self.timeline.rect();
        let is_over = rect
            .zip(pointer)
            .is_some_and(|(rect, at)| rect.contains(at));
        if is_over {
            Place::Timeline
        } else {
            Place::Animate
        }
    }

    /// The system says of copying and pasting that they were asked for, not which keys were pressed.
    pub(super) fn take_clipboard_keys(&self, ui: &Ui, asked: &mut Asked) {
        let is_over = self.place_of_keys(ui) == Place::Timeline;
        let (copies, pastes, shift) = ui.input(|i| {
            let copies = i.events.iter().any(|e| matches!(e, Event::Copy));
            let pastes = i.events.iter().any(|e| matches!(e, Event::Paste(_)));
            (copies, pastes, i.modifiers.shift)
        });
        match (copies, pastes, is_over) {
            (true, _, true) => asked.command(Command::Keys(KeysCommand::Copy)),
            (true, _, false) => asked.command(Command::CopyPicture),
            (_, true, true) if shift => asked.command(Command::Keys(KeysCommand::PasteMirrored)),
            (_, true, true) => asked.command(Command::Keys(KeysCommand::Paste)),
            _ => {}
        }
    }

    /// Does what a command means while motion is authored. False for one that means the same
    /// everywhere.
    pub(super) fn run_in_animate(&mut self, ctx: &egui::Context, command: Command) -> bool {
        match command {
            Command::Keys(keys) => {
                if let Some(text) = self.timeline.run(keys, &mut self.session) {
                    ctx.copy_text(text);
                }
            }
            Command::SaveScene => self.save_scene(ctx, false),
            Command::SaveSceneAs => self.save_scene(ctx, true),
            _ => return false,
        }
        true
    }

    /// Makes the active clip an authored one.
    pub(super) fn start_authoring(&mut self, ctx: &egui::Context, start: Start) {
        let (Some(id), Some(clip)) = (self.session.active_id(), self.session.active_clip()) else {
            return;
        };
        let clip = Arc::clone(clip);
        let time = self.session.transport.time_secs();
        let is_edited = self.session.is_edited(id);
        if matches!(start, Start::Reduced(_)) {
            // A long motion takes a while.
            self.timeline.set_waiting(true);
            self.loader.reduce(id, clip, start);
        } else {
            let started = animate::start(&clip, start, time, is_edited);
            self.take_authored(id, started, ctx.input(|i| i.time));
        }
    }

    /// A clip became an authored one, or could not.
    pub(super) fn take_authored(
        &mut self,
        id: ClipId,
        started: Result<Authored, String>,
        now: f64,
    ) {
        self.timeline.set_waiting(false);
        match started {
            Ok(authored) => {
                self.session.put_authored(id, authored);
                let name = self.scene_name(id);
                self.session.rename(id, name, Source::Scene(None));
                self.watch_files();
            }
            Err(why) => self.notices.add(NoticeKind::Failure, why, now),
        }
    }
}
