//! The pose library in the window: where it is kept, its files, its keys.

use egui::Ui;
use posekit_formats::poses::{EXTENSION, SavedPose};

use super::Viewer;
use crate::panels::pose_library::{self, PoseRequest};
use crate::panels::row;
use crate::state::animate::pose_library::PoseLibrary;
use crate::state::notices::NoticeKind;
use crate::theme::GAP;
use crate::work::files::{self, Parcel};

/// Under this name the poses are kept.
const POSES_KEY: &str = "posekit poses";

/// Under this name a kept text stays that could not be read, so that nothing is lost.
const UNREADABLE_KEY: &str = "posekit poses, not read";

/// What the left side shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Left {
    Clips,
    Joints,
    ClipsAndJoints,
    Poses,
}

impl Viewer {
    /// Takes in the poses that were kept.
    pub(super) fn take_kept_poses(&mut self, storage: &dyn eframe::Storage) {
        let Some(text) = storage.get_string(POSES_KEY) else {
            return;
        };
        match PoseLibrary::read(text.as_bytes()) {
            Ok(library) => self.poses = library,
            Err(error) => {
                let message = format!("the saved poses could not be read: {error}");
                self.notices.add(NoticeKind::Failure, message, 0.0);
                self.unreadable_poses = Some(text);
            }
        }
    }

    /// Keeps the poses.
    pub(super) fn keep_poses(&self, storage: &mut dyn eframe::Storage) {
        if let Some(text) = &self.unreadable_poses {
            storage.set_string(UNREADABLE_KEY, text.clone());
        }
        if let Ok(text) = String::from_utf8(self.poses.write()) {
            storage.set_string(POSES_KEY, text);
        }
    }

    /// Adds the poses of a file to the library.
    pub(super) fn take_poses(&mut self, name: &str, poses: Vec<SavedPose>, now: f64) {
        let text = match self.poses.merge(poses) {
            0 => format!("{name} holds no pose that is not there already"),
            1 => format!("1 pose was added from {name}"),
            count => format!("{count} poses were added from {name}"),
        };
        self.layout.poses = true;
        self.notices.add(NoticeKind::Done, text, now);
    }

    /// While a pose is blended in there is one key: the one that gives it up. True when it was looked for.
    pub(super) fn take_keys_of_poses(&mut self, ui: &mut Ui) -> bool {
        if !self.pose_panel.is_blending() {
            return false;
        }
        if ui.input_mut(|i| i.consume_key(egui::Modifiers::NONE, egui::Key::Escape)) {
            self.pose_panel.cancel(&mut self.session);
        }
        true
    }

    /// Offers what the left side shows: poses where they are edited, and in a low window the clips and the joints
    /// one after the other.
    pub(super) fn choose_left(&mut self, ui: &mut Ui, is_low: bool) -> Left {
        let mut offered = vec![if is_low {
            (
                Left::Clips,
                ("Clips", "The clips that are open, and those of the folder"),
            )
        } else {
            (
                Left::ClipsAndJoints,
                ("Clips", "The clips that are open, and the joints"),
            )
        }];
        if is_low {
            offered.push((Left::Joints, ("Joints", "The joints of the active clip")));
        }
        if self.session.mode().edits() {
            offered.push((Left::Poses, ("Poses", "The poses that are kept")));
        }
        let place_of = |wanted: Left| offered.iter().position(|(left, _)| *left == wanted);
        let wanted = match (self.layout.poses, self.shows_joints) {
            (true, _) => Left::Poses,
            (false, true) => Left::Joints,
            (false, false) => offered[0].0,
        };
        let now = place_of(wanted).unwrap_or(0);
        if offered.len() > 1 {
            let options: Vec<(&str, &str)> = offered.iter().map(|(_, option)| *option).collect();
            let room = ui.available_width();
            if let Some(index) = row::one_of(ui, "left", room, Some(now), &options) {
                self.layout.poses = offered[index].0 == Left::Poses;
                self.shows_joints = offered[index].0 == Left::Joints;
            }
            ui.add_space(GAP);
        }
        offered[now].0
    }

    /// Shows the pose library.
    pub(super) fn show_poses(&mut self, ui: &mut Ui) {
        let asked =
            pose_library::show(ui, &mut self.session, &mut self.poses, &mut self.pose_panel);
        match asked {
            Some(PoseRequest::Open) => self.ask_for_files(),
            Some(PoseRequest::Save) => self.save_poses(ui.ctx()),
            None => {}
        }
    }

    fn save_poses(&mut self, ctx: &egui::Context) {
        let name = self.session.active_clip().map(|clip| clip.name.clone());
        let stem = name.map_or("poses".to_owned(), |name| files::stem_of(&name));
        let parcel = Parcel {
            name: format!("{stem}.{EXTENSION}"),
            kind: "Poses",
            extension: EXTENSION,
            bytes: self.poses.write().into(),
        };
        self.hand_over(ctx, Ok(parcel));
    }

    /// The pose library, to look at.
    #[must_use]
    pub fn poses(&self) -> &PoseLibrary {
        &self.poses
    }
}
