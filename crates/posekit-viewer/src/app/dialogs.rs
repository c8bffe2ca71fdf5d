//! Asking for files: by the system's dialogs, by the window's own chooser where there are none or where it is
//! liked better, and what is done with the answers.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use super::Viewer;
use crate::load::Input;
use crate::panels::chooser::{self, Shown};
use crate::state::animate::place;
use crate::state::chooser::{Ask, Chooser, Goal, home, with_ending};
use crate::state::clip::Source;
use crate::work::dialog::{self, Answer, SystemDialogs, Wanted};

/// Why it is the window that asks.
const NO_DIALOGS: &str = "This system offers no file dialog (no desktop portal, no zenity), so posekit asks \
                          here.";
const ANOTHER_IS_OPEN: &str =
    "A file dialog of the system is still open, perhaps behind this window.";
const NAME_IS_TAKEN: &str = "The name was completed by its ending.";

/// What is asked for.
#[derive(Debug, Default)]
pub(super) struct Dialogs {
    system: SystemDialogs,
    /// Files are asked for in the window, although the system may have dialogs.
    pub(super) asks_in_window: bool,
    /// The system was found to have none.
    are_missing: bool,
    /// How many dialogs of the system are open.
    open_count: usize,
    /// What is asked for after what is asked for now.
    queue: VecDeque<Wanted>,
    chooser: Option<(Wanted, Chooser)>,
    /// The folder in which a file was chosen last.
    pub(super) folder: Option<PathBuf>,
}

impl Dialogs {
    pub(super) fn new(
        system: SystemDialogs,
        asks_in_window: bool,
        folder: Option<PathBuf>,
    ) -> Self {
        Self {
            system,
            asks_in_window,
            folder,
            ..Self::default()
        }
    }

    /// Whether the window asks.
    pub(super) fn is_asking(&self) -> bool {
        self.chooser.is_some()
    }

    /// Asks for nothing more.
    pub(super) fn close(&mut self) {
        self.chooser = None;
        self.queue.clear();
    }
}

impl Viewer {
    /// The window's own file chooser, while it is open.
    #[must_use]
    pub fn chooser(&self) -> Option<&Chooser> {
        self.dialogs.chooser.as_ref().map(|(_, chooser)| chooser)
    }

    /// Asks for files, one after the other.
    pub(super) fn ask_for(&mut self, wanted: Wanted) {
        let is_busy = self.dialogs.open_count > 0;
        if self.dialogs.is_asking() || (is_busy && self.closes_after_saving()) {
            self.dialogs.queue.push_back(wanted);
        } else if self.dialogs.asks_in_window {
            self.open_chooser(wanted, None);
        } else if self.dialogs.are_missing {
            self.open_chooser(wanted, Some(NO_DIALOGS));
        } else if is_busy {
            self.open_chooser(wanted, Some(ANOTHER_IS_OPEN));
        } else {
            self.dialogs.open_count += 1;
            let folder = self.first_folder(&wanted);
            let system = self.dialogs.system;
            system.ask(self.loader.outbox(), wanted, Some(folder));
        }
    }

    fn open_chooser(&mut self, wanted: Wanted, says: Option<&'static str>) {
        let chooser = Chooser::new(self.question_of(&wanted, says));
        self.dialogs.chooser = Some((wanted, chooser));
    }

    fn question_of(&self, wanted: &Wanted, says: Option<&'static str>) -> Ask {
        let clips = self.session.clips().iter();
        let open_files = clips.filter_map(|open| match &open.clip.source {
            Source::File(path) | Source::Scene(Some(path)) => Some(place::absolute(path)),
            _ => None,
        });
        Ask {
            title: wanted.title(),
            goal: wanted.goal(),
            endings: wanted.endings(),
            name: wanted.name().to_owned(),
            folder: self.first_folder(wanted),
            says,
            open_files: open_files.collect(),
        }
    }

    /// Where files are looked for first: where the scene is that is saved again, where a file was chosen last,
    /// where the active clip comes from, where the program was started.
    fn first_folder(&self, wanted: &Wanted) -> PathBuf {
        let scene = match wanted {
            Wanted::Scene { clip, .. } => self.session.authored_of(*clip).and_then(|a| a.path()),
            _ => None,
        };
        let active = self.session.active_clip().map(|clip| &clip.source);
        let active = match active {
            Some(Source::File(path) | Source::Scene(Some(path))) => Some(path.as_path()),
            _ => None,
        };
        let folder_of = |path: &Path| place::absolute(path).parent().map(Path::to_owned);
        let chosen = self.dialogs.folder.clone();
        let folders = [
            scene.and_then(folder_of),
            chosen,
            active.and_then(folder_of),
            std::env::current_dir().ok(),
            home(),
        ];
        let mut folders = folders.into_iter().flatten();
        folders
            .find(|folder| folder.is_dir())
            .unwrap_or_else(|| PathBuf::from("/"))
    }

    /// A dialog of the system was answered, or there is none.
    pub(super) fn take_system_answer(
        &mut self,
        ctx: &egui::Context,
        wanted: Wanted,
        answer: Answer,
    ) {
        self.dialogs.open_count = self.dialogs.open_count.saturating_sub(1);
        match answer {
            Answer::NoDialog => {
                self.dialogs.are_missing = true;
                if self.dialogs.is_asking() {
                    self.dialogs.queue.push_back(wanted);
                } else {
                    self.open_chooser(wanted, Some(NO_DIALOGS));
                }
            }
            Answer::Cancelled => self.take_nothing(&wanted),
            Answer::Chosen(paths) => self.take_paths_of_system(ctx, wanted, paths),
        }
        self.ask_for_next();
    }

    /// The system has asked whether what is there is replaced, but of the name as it was typed: the ending
    /// that it gets may make it that of another file.
    fn take_paths_of_system(&mut self, ctx: &egui::Context, wanted: Wanted, paths: Vec<PathBuf>) {
        if wanted.goal() == Goal::SaveFile
            && let [path] = paths.as_slice()
        {
            let whole = with_ending(place::absolute(path), &wanted.endings());
            if whole != place::absolute(path) && whole.exists() && !self.dialogs.is_asking() {
                let mut chooser = Chooser::new(self.question_of(&wanted, Some(NAME_IS_TAKEN)));
                match chooser.ask_about(&whole) {
                    Some(paths) => self.take_paths(ctx, wanted, paths),
                    None => self.dialogs.chooser = Some((wanted, chooser)),
                }
                return;
            }
            self.take_paths(ctx, wanted, vec![whole]);
            return;
        }
        self.take_paths(ctx, wanted, paths);
    }

    /// Nothing was chosen.
    fn take_nothing(&mut self, wanted: &Wanted) {
        if matches!(wanted, Wanted::Scene { .. }) {
            // Who gives up saving one scene before the window closes gives up closing it.
            self.give_up_saving();
            self.dialogs.queue.clear();
        }
    }

    /// Does with files what they were wanted for.
    fn take_paths(&mut self, ctx: &egui::Context, wanted: Wanted, mut paths: Vec<PathBuf>) {
        let Some(first) = paths.first() else { return };
        self.dialogs.folder = match wanted {
            Wanted::Folder => Some(first.clone()),
            _ => first.parent().map(Path::to_owned),
        };
        match wanted {
            Wanted::Files => self.open_inputs(paths.into_iter().map(Input::Path).collect()),
            Wanted::Folder => self.list_folder(ctx, paths.remove(0)),
            Wanted::Video { .. } => self.export_to(paths.remove(0)),
            Wanted::Scene { clip, .. } => self.save_scene_to(ctx, clip, paths.remove(0)),
            Wanted::File(parcel) => dialog::write(self.loader.outbox(), parcel, paths.remove(0)),
        }
    }

    fn ask_for_next(&mut self) {
        if self.dialogs.open_count == 0
            && !self.dialogs.is_asking()
            && let Some(next) = self.dialogs.queue.pop_front()
        {
            self.ask_for(next);
        }
    }

    /// Shows the window's own chooser. True when it was answered.
    pub(super) fn show_chooser(&mut self, ctx: &egui::Context) -> bool {
        let Some((_, chooser)) = &mut self.dialogs.chooser else {
            return false;
        };
        let shown = chooser::show(ctx, chooser);
        if shown == Shown::Open {
            return false;
        }
        if let Some((wanted, _)) = self.dialogs.chooser.take() {
            match shown {
                Shown::Chosen(paths) => self.take_paths(ctx, wanted, paths),
                Shown::Cancelled | Shown::Open => self.take_nothing(&wanted),
            }
        }
        self.ask_for_next();
        true
    }
}
