//! The arm lab in the window: what is shown of it, and what commands mean in it.

use egui::{Key, Modifiers, Ui};
use posekit_render::scene::Scene;

use super::Viewer;
use crate::command::{Command, apply_to_camera};
use crate::gizmo::Tool;
use crate::load::Purpose;
use crate::panels::{Asked, arm_lab};
use crate::state::arm::Robot;
use crate::state::interpolation::Page;
use crate::state::mode::{Mode, Space};
use crate::state::notices::NoticeKind;
use crate::state::session::Act;
use crate::work::files;

impl Viewer {
    /// Shows the lab in all the room that is left.
    pub(super) fn show_lab(&mut self, ui: &mut Ui, asked: &mut Asked) {
        self.lab.fill();
        let sides = self.sides;
        let look = self.session.look();
        let parts = (&mut self.lab, &mut self.lab_panel, &mut self.painter);
        let (view, free) = arm_lab::show(ui, parts, (sides, look), asked);
        self.show_over_view(ui, (view, free), asked);
    }

    /// Puts a robot that was read on the bench, and goes there. Of several that were given together the first stands
    /// there, whichever is read first.
    pub(super) fn take_robot(&mut self, purpose: Purpose, robot: Robot, now: f64) {
        if let Some(note) = robot.note.clone() {
            self.notices.add(NoticeKind::Done, note, now);
        }
        if let Some(repair) = robot.report.first_repair() {
            let text = format!("{} was repaired while it was read: {repair}", robot.name);
            self.notices.add(NoticeKind::Done, text, now);
        }
        let place = match purpose {
            Purpose::Group { group, rank } => Some((group, rank)),
            Purpose::Beside | Purpose::Replace(_) => None,
        };
        let is_behind = self.benched.zip(place).is_some_and(|(benched, place)| {
            let (group, rank) = benched;
            group == place.0 && rank < place.1
        });
        if is_behind {
            self.lab.keep(robot);
            return;
        }
        self.benched = place;
        self.lab.open(robot);
        self.session.set_mode(Mode::Lab);
    }

    /// What is seen: the stage, or what is in a lab.
    pub(super) fn seen(&self) -> Scene {
        match self.session.mode() {
            Mode::Lab => self.lab.scene(self.session.look()),
            Mode::Interpolation => match self.interpolation.page() {
                Page::Orientations => self.interpolation.scene(self.session.look()),
                Page::Clip => self.interpolation.clip.scene(),
            },
            _ => self.session.picture(),
        }
    }

    /// While a handle is held in the lab there is one key: the one that lets it go. True when it was
    /// looked for.
    pub(super) fn take_keys_in_lab(&mut self, ui: &mut Ui) -> bool {
        let is_held = self.session.mode() == Mode::Lab
            && self.lab.bench().is_some_and(|bench| bench.is_dragging());
        if is_held && ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)) {
            self.lab.work(|bench| bench.cancel_drag());
        }
        is_held
    }

    /// Does what a command means in the lab. False elsewhere, and for commands that mean the same
    /// everywhere.
    pub(super) fn run_in_lab(&mut self, ctx: &egui::Context, command: Command) -> bool {
        if self.session.mode() != Mode::Lab {
            return false;
        }
        match command {
            command if command.is_of_every_mode() => return false,
            Command::SavePicture => self.save_lab_picture(ctx),
            Command::ToggleSnap => self.lab.set_snaps(!self.lab.snaps()),
            Command::ToggleAxes => {
                let mut shown = self.lab.shown();
                shown.frames = !shown.frames;
                self.lab.set_shown(shown);
            }
            Command::ToggleLabels => {
                let mut shown = self.lab.shown();
                shown.names = !shown.names;
                self.lab.set_shown(shown);
            }
            command => {
                let is_view = self.look_in_lab(command);
                if !is_view {
                    self.work_in_lab(command);
                }
            }
        }
        true
    }

    fn look_in_lab(&mut self, command: Command) -> bool {
        let size = self.lab.size();
        match command {
            Command::Look(view) => self.lab.look_from(view),
            Command::FrameAll | Command::FrameSelected => self.lab.reframe(),
            _ => return apply_to_camera(command, &mut self.lab.camera, size),
        }
        true
    }

    fn work_in_lab(&mut self, command: Command) {
        self.lab.work(|bench| match command {
            Command::Undo => bench.undo(),
            Command::Redo => bench.redo(),
            Command::Tool(tool) => bench.set_tool(if tool.turns() {
                Tool::MoveAndTurn
            } else {
                Tool::Move
            }),
            Command::TakeInHand(act) => bench.set_tool(match act {
                Act::Turn => Tool::MoveAndTurn,
                Act::Move => Tool::Move,
            }),
            Command::NextSpace => bench.set_space(match bench.space() {
                Space::Local => Space::World,
                Space::Parent | Space::World => Space::Local,
            }),
            Command::Solve => drop(bench.take_next_way()),
            Command::ForgetTarget | Command::Deselect => bench.forget_target(),
            Command::ResetPose | Command::ToggleRest => bench.go_home(),
            // Time, clips and figures are on the stage, not here.
            _ => {}
        });
    }

    fn save_lab_picture(&mut self, ctx: &egui::Context) {
        let Some(name) = self.lab.bench().map(|bench| bench.robot().name.clone()) else {
            return;
        };
        let stem = name.strip_suffix(".urdf").unwrap_or(&name);
        let parcel = files::picture_parcel(&self.picture(), stem, 0).map(|parcel| files::Parcel {
            name: format!("{}.png", files::stem_of(stem)),
            ..parcel
        });
        self.hand_over(ctx, parcel);
    }
}
