//! Dialogs of the system that ask for files, each on a thread of its own, and how it is told that there are
//! none.
//!
//! `rfd` asks the desktop portal and then `zenity`, and says nothing of both in what it returns: without
//! either it is as if the dialog had been cancelled at once. That it could not ask is in its log alone, so
//! that is where it is looked for. A portal that is there and fails, and a `zenity` that finds no display,
//! say nothing at all; but they do so sooner than anybody closes a dialog.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::files::Parcel;
use crate::load::{Event, Outbox};
use crate::state::chooser::Goal;
use crate::state::session::ClipId;

/// Nobody sees a dialog, and cancels it, within this.
const SOONEST_CANCEL: Duration = Duration::from_millis(200);

/// What `rfd` logs failures of its last resort under: the portal's own, after which it tries another, are
/// those of a module below.
const RFD_TARGET: &str = "rfd::backend::xdg_desktop_portal";

/// What a dialog is for.
#[derive(Clone, Debug)]
pub enum Wanted {
    /// Files are opened.
    Files,
    /// A folder is listed.
    Folder,
    /// A video is exported.
    Video {
        /// The name proposed.
        name: String,
        /// How its name ends.
        ending: &'static str,
    },
    /// The scene of a clip is saved.
    Scene {
        /// The clip.
        clip: ClipId,
        /// The name proposed.
        name: String,
    },
    /// A file is written.
    File(Parcel),
}

impl Wanted {
    /// What is chosen.
    #[must_use]
    pub const fn goal(&self) -> Goal {
        match self {
            Self::Files => Goal::OpenFiles,
            Self::Folder => Goal::OpenFolder,
            Self::Video { .. } | Self::Scene { .. } | Self::File(_) => Goal::SaveFile,
        }
    }

    /// The heading.
    #[must_use]
    pub const fn title(&self) -> &'static str {
        match self {
            Self::Files => "Open files",
            Self::Folder => "Open a folder of motion files",
            Self::Video { .. } => "Export a video",
            Self::Scene { .. } => "Save the scene",
            Self::File(_) => "Save",
        }
    }

    /// The name proposed.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Files | Self::Folder => "",
            Self::Video { name, .. } | Self::Scene { name, .. } => name,
            Self::File(parcel) => &parcel.name,
        }
    }

    /// How names of the files meant end; what is saved gets the first.
    #[must_use]
    pub fn endings(&self) -> Vec<&'static str> {
        use posekit_formats::{poses, scene};
        match self {
            Self::Files => vec!["bvh", scene::EXTENSION, poses::EXTENSION, "toml", "urdf"],
            Self::Folder => Vec::new(),
            Self::Video { ending, .. } => vec![ending],
            Self::Scene { .. } => vec![scene::EXTENSION],
            Self::File(parcel) => vec![parcel.extension],
        }
    }

    /// What kind of files is meant.
    const fn kind(&self) -> &'static str {
        match self {
            Self::Files | Self::Folder => "Motion, scenes, poses and robots",
            Self::Video { .. } => "Video",
            Self::Scene { .. } => "posekit scene",
            Self::File(parcel) => parcel.kind,
        }
    }
}

/// What a dialog has answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// These were chosen.
    Chosen(Vec<PathBuf>),
    /// Nothing was.
    Cancelled,
    /// It could not be asked: the system has no dialogs here.
    NoDialog,
}

/// The dialogs of the system, or what stands for them in a test.
#[derive(Clone, Copy)]
pub struct SystemDialogs(fn(&Wanted, Option<&Path>) -> Answer);

impl SystemDialogs {
    /// What answers instead of the system: what is wanted, and the folder to start in.
    #[must_use]
    pub const fn of(answers: fn(&Wanted, Option<&Path>) -> Answer) -> Self {
        Self(answers)
    }

    /// Asks, on a thread of its own; the answer comes as an event.
    pub fn ask(self, outbox: &Outbox, wanted: Wanted, folder: Option<PathBuf>) {
        let failed = (outbox.clone(), wanted.clone());
        let outbox = outbox.clone();
        let ask = move || {
            let answer = (self.0)(&wanted, folder.as_deref());
            let wanted = Box::new(wanted);
            outbox.send(Event::Answered { wanted, answer });
        };
        let thread = std::thread::Builder::new().name("dialog".into());
        if thread.spawn(ask).is_err() {
            let (outbox, wanted) = failed;
            let wanted = Box::new(wanted);
            let answer = Answer::NoDialog;
            outbox.send(Event::Answered { wanted, answer });
        }
    }
}

impl Default for SystemDialogs {
    fn default() -> Self {
        Self(ask_system)
    }
}

impl std::fmt::Debug for SystemDialogs {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("SystemDialogs")
    }
}

/// Asks the system, and waits for what is answered.
#[must_use]
pub fn ask_system(wanted: &Wanted, folder: Option<&Path>) -> Answer {
    Failures::listen();
    FAILURES.set(0);
    let start = Instant::now();
    let mut dialog = rfd::FileDialog::new().set_title(wanted.title());
    if let Some(folder) = folder {
        dialog = dialog.set_directory(folder);
    }
    if !wanted.name().is_empty() {
        dialog = dialog.set_file_name(wanted.name());
    }
    let endings = filter_endings(&wanted.endings());
    if !endings.is_empty() {
        dialog = dialog.add_filter(wanted.kind(), &endings);
    }
    let chosen = match wanted.goal() {
        Goal::OpenFiles => dialog.pick_files(),
        Goal::OpenFolder => dialog.pick_folder().map(|path| vec![path]),
        Goal::SaveFile => dialog.save_file().map(|path| vec![path]),
    };
    let chosen: Vec<PathBuf> = chosen.unwrap_or_default();
    // `zenity` that was cancelled names an empty path.
    let chosen: Vec<PathBuf> = chosen
        .into_iter()
        .filter(|path| !path.as_os_str().is_empty())
        .collect();
    if !chosen.is_empty() {
        return Answer::Chosen(chosen);
    }
    let may_lack = cfg!(not(any(target_os = "windows", target_os = "macos")));
    if may_lack && (FAILURES.get() > 0 || start.elapsed() < SOONEST_CANCEL) {
        Answer::NoDialog
    } else {
        Answer::Cancelled
    }
}

/// Endings as systems filter by: the last part of each, in both cases of letters.
fn filter_endings(endings: &[&str]) -> Vec<String> {
    let mut filters = Vec::new();
    for ending in endings {
        let last = ending.rsplit('.').next().unwrap_or(ending);
        for filter in [last.to_lowercase(), last.to_uppercase()] {
            if !filters.contains(&filter) {
                filters.push(filter);
            }
        }
    }
    filters
}

thread_local! {
    /// How often the dialogs of the system have failed on this thread.
    static FAILURES: Cell<u32> = const { Cell::new(0) };
}

/// Listens to what `rfd` logs, and to nothing else.
struct Failures;

impl Failures {
    fn listen() {
        // A program that logs itself keeps its logger; dialogs that fail are then told by their haste alone.
        if log::set_logger(&Self).is_ok() {
            log::set_max_level(log::LevelFilter::Error);
        }
    }
}

impl log::Log for Failures {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() == log::Level::Error && metadata.target() == RFD_TARGET
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            FAILURES.set(FAILURES.get() + 1);
        }
    }

    fn flush(&self) {}
}

/// Writes a file to the place that was chosen for it, away from the window.
pub fn write(outbox: &Outbox, parcel: Parcel, path: PathBuf) {
    let bytes = Arc::clone(&parcel.bytes);
    let outbox = outbox.clone();
    let write = move || {
        let put =
            |file: &mut std::io::BufWriter<std::fs::File>| std::io::Write::write_all(file, &bytes);
        let written: std::io::Result<()> = super::files::write_beside(&path, put);
        outbox.send(match written {
            Ok(()) => Event::Written {
                message: format!("Saved {}", path.display()),
            },
            Err(error) => {
                let why = posekit_formats::system::in_words(&error);
                Event::Failed {
                    message: format!("{}: not saved: {why}", path.display()),
                }
            }
        });
    };
    crate::load::in_background(write);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_are_heard_where_they_are_the_last_resorts() {
        let record = |target: &str, level| {
            let metadata = log::Metadata::builder().target(target).level(level).build();
            log::Log::enabled(&Failures, &metadata)
        };
        assert!(record(RFD_TARGET, log::Level::Error));
        assert!(!record(RFD_TARGET, log::Level::Warn));
        // After the portal `zenity` is tried, and may be cancelled.
        let portal = format!("{RFD_TARGET}::portal");
        assert!(!record(&portal, log::Level::Error));
    }

    #[test]
    fn filters_are_what_systems_understand() {
        assert_eq!(filter_endings(&["bvh"]), ["bvh", "BVH"]);
        let scene = filter_endings(&Wanted::Files.endings());
        assert!(
            scene.iter().all(|filter| !filter.contains('.')),
            "{scene:?}"
        );
    }

    /// Run by the test below in a process of its own.
    #[test]
    #[ignore = "asks the system for a dialog"]
    fn asks_the_system() {
        for wanted in [Wanted::Files, Wanted::Folder] {
            assert_eq!(ask_system(&wanted, None), Answer::NoDialog);
        }
        let name = "a.gif".to_owned();
        let ending = "gif";
        let video = Wanted::Video { name, ending };
        assert_eq!(ask_system(&video, None), Answer::NoDialog);
    }

    /// The real dialogs, where there can be none: no bus for the portal, no folder with `zenity`, no display.
    #[cfg(target_os = "linux")]
    #[test]
    fn without_portal_and_zenity_it_is_told_that_there_is_no_dialog() {
        let program = std::env::current_exe().expect("this program");
        let run = std::process::Command::new(program)
            .args([
                "--exact",
                "work::dialog::tests::asks_the_system",
                "--ignored",
            ])
            .env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent/bus")
            .env("XDG_RUNTIME_DIR", "/nonexistent")
            .env("PATH", "/nonexistent")
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .output()
            .expect("it runs");
        let said = String::from_utf8_lossy(&run.stdout);
        assert!(run.status.success(), "{said}");
        assert!(said.contains("1 passed"), "{said}");
    }
}
