//! The interpolation lab in the window: what is shown of it, and what commands mean in it.

use egui::{Key, Modifiers, Ui};

use super::Viewer;
use crate::command::{Command, apply_to_camera};
use crate::panels::{Asked, interpolation};
use crate::state::display::Compare;
use crate::state::interpolation::playback::SECS_RANGE;
use crate::state::interpolation::{InterpolationLab, Page, Picture};
use crate::state::mode::{Mode, Space};
use crate::state::transport::AtEnd;
use crate::work::files;

/// One step of the keys along the way, and a large one.
const STEP: f64 = 0.01;
const LARGE_STEP: f64 = 0.1;

/// Faster and slower go by this factor.
const PACE: f64 = 1.5;

impl Viewer {
    /// Shows the lab in all the room that is left.
    pub(super) fn show_interpolation(&mut self, ui: &mut Ui, asked: &mut Asked) {
        let sides = self.sides;
        let look = self.session.look();
        if self.interpolation.page() == Page::Clip {
            let active = self.session.active_id().zip(self.session.active_clip());
            self.interpolation.clip.follow(active);
            if let Some(job) = self.interpolation.clip.next_job() {
                self.loader.fill_in(job);
            }
        }
        let parts = (
            &mut self.interpolation,
            &mut self.interpolation_panel,
            &mut self.painter,
        );
        let (view, free) = interpolation::show(ui, parts, (sides, look), asked);
        self.show_over_view(ui, (view, free), asked);
    }

    /// Moves the lab's clock by what passed. False while it stands.
    pub(super) fn tick_interpolation(&mut self, passed_secs: f64) {
        let lab = &mut self.interpolation;
        match lab.page() {
            Page::Orientations => lab.playback.advance(passed_secs),
            Page::Clip => {
                lab.clip.transport.advance(passed_secs);
            }
        }
    }

    /// Whether something runs in the lab.
    pub(super) fn plays_in_interpolation(&self) -> bool {
        let lab = &self.interpolation;
        self.session.mode() == Mode::Interpolation
            && match lab.page() {
                Page::Orientations => lab.playback.is_playing(),
                Page::Clip => lab.clip.transport.is_playing(),
            }
    }

    /// While a ring is held in the lab there is one key: the one that lets it go. True when it was looked
    /// for.
    pub(super) fn take_keys_in_interpolation(&mut self, ui: &mut Ui) -> bool {
        let is_held =
            self.session.mode() == Mode::Interpolation && self.interpolation.is_dragging();
        if is_held && ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)) {
            self.interpolation.cancel_drag();
        }
        is_held
    }

    /// Does what a command means in the lab. False elsewhere, and for commands that mean the same
    /// everywhere.
    pub(super) fn run_in_interpolation(&mut self, ctx: &egui::Context, command: Command) -> bool {
        if self.session.mode() != Mode::Interpolation {
            return false;
        }
        match command {
            command if command.is_of_every_mode() => return false,
            Command::SavePicture => self.save_interpolation_picture(ctx),
            Command::ToggleCurves => {
                let panel = &mut self.interpolation_panel;
                panel.is_closed = !panel.is_closed;
            }
            command => {
                let lab = &mut self.interpolation;
                match lab.page() {
                    Page::Orientations => {
                        look_at_bodies(lab, command);
                        run_the_way(lab, command);
                        edit_case(lab, command);
                    }
                    Page::Clip => run_the_clip(lab, command),
                }
            }
        }
        true
    }

    fn save_interpolation_picture(&mut self, ctx: &egui::Context) {
        let stem = "interpolation";
        let parcel = files::picture_parcel(&self.picture(), stem, 0).map(|parcel| files::Parcel {
            name: format!("{stem}.png"),
            ..parcel
        });
        self.hand_over(ctx, parcel);
    }
}

fn look_at_bodies(lab: &mut InterpolationLab, command: Command) {
    match command {
        Command::Look(view) => lab.look_from(view),
        // Everything is in the picture always, seen with parallel rays.
        Command::ToggleProjection | Command::ZoomIn | Command::ZoomOut => {}
        command => {
            apply_to_camera(command, &mut lab.camera, 1.0);
        }
    }
}

fn run_the_way(lab: &mut InterpolationLab, command: Command) {
    let clock = &mut lab.playback;
    let go = |step: f64, share: f64| ((share + step) * 1e4).round() / 1e4;
    let share = clock.share();
    match command {
        Command::TogglePlay => return clock.toggle(),
        Command::ToggleLoop => {
            clock.at_end = match clock.at_end {
                AtEnd::Loop => AtEnd::Stop,
                AtEnd::Stop => AtEnd::Loop,
            };
            return;
        }
        Command::Faster => {
            clock.secs = (clock.secs / PACE).max(*SECS_RANGE.start());
            return;
        }
        Command::Slower => {
            clock.secs = (clock.secs * PACE).min(*SECS_RANGE.end());
            return;
        }
        Command::NextFrame => clock.set_share(go(STEP, share)),
        Command::PreviousFrame => clock.set_share(go(-STEP, share)),
        Command::TenFramesOn => clock.set_share(go(LARGE_STEP, share)),
        Command::TenFramesBack => clock.set_share(go(-LARGE_STEP, share)),
        Command::GoToStart => clock.set_share(0.0),
        Command::GoToEnd => clock.set_share(clock.length()),
        _ => return,
    }
    clock.pause();
}

fn edit_case(lab: &mut InterpolationLab, command: Command) {
    match command {
        Command::Undo => lab.undo(),
        Command::Redo => lab.redo(),
        Command::ToggleSnap => lab.set_snaps(!lab.snaps()),
        Command::NextSpace => lab.set_space(match lab.space() {
            Space::Local => Space::World,
            Space::Parent | Space::World => Space::Local,
        }),
        Command::ToggleCompare => lab.set_picture(match lab.picture() {
            Picture::SideBySide => Picture::Overlaid,
            Picture::Overlaid => Picture::Sphere,
            Picture::Sphere => Picture::SideBySide,
        }),
        _ => {}
    }
}

fn run_the_clip(lab: &mut InterpolationLab, command: Command) {
    let clip = &mut lab.clip;
    let size = clip.stage().stature();
    match command {
        Command::TogglePlay => clip.transport.toggle_play(),
        Command::NextFrame => clip.transport.step(1),
        Command::PreviousFrame => clip.transport.step(-1),
        Command::TenFramesOn => clip.transport.step(10),
        Command::TenFramesBack => clip.transport.step(-10),
        Command::GoToStart => clip.transport.go_to_frame(0),
        Command::GoToEnd => {
            clip.transport.pause();
            clip.transport.go_to_frame(clip.transport.last_frame());
        }
        Command::ToggleLoop => {
            clip.transport.at_end = match clip.transport.at_end {
                AtEnd::Loop => AtEnd::Stop,
                AtEnd::Stop => AtEnd::Loop,
            }
        }
        Command::Faster => clip.transport.faster(),
        Command::Slower => clip.transport.slower(),
        Command::Look(view) => clip.look_from(view),
        Command::FrameAll | Command::FrameSelected => clip.reframe(),
        Command::ToggleCompare => clip.set_arrangement(match clip.arrangement() {
            Compare::SideBySide => Compare::Overlaid,
            Compare::Overlaid => Compare::SideBySide,
        }),
        command => {
            apply_to_camera(command, &mut clip.camera, size);
        }
    }
}
