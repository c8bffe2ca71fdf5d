//! Reading: files become clips away from the window, with progress, and can be stopped.

#[cfg(not(target_arch = "wasm32"))]
mod disk;
mod job;
#[cfg(target_arch = "wasm32")]
mod page;
pub mod scene;
mod thread;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

use egui::ColorImage;
use posekit::check::Finding;

use crate::state::animate::{Authored, Start, start};
use crate::state::arm::Robot;
use crate::state::clip::Clip;
use crate::state::interpolation::clip::{FillJob, Filled};
use crate::state::session::ClipId;
use crate::state::text::FileText;
use crate::work::autosave::Kept;

pub use job::read_clip;
#[cfg(target_arch = "wasm32")]
pub(crate) use page::{listing_of, name_at};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use thread::start as in_background;

/// What is to be read.
#[derive(Clone, Debug)]
pub enum Input {
    /// A file on this machine; on a page, the address of one of the page's own origin.
    Path(PathBuf),
    /// Bytes that are here already, and what they are called.
    Bytes {
        /// The name.
        name: String,
        /// The bytes.
        bytes: Arc<[u8]>,
    },
    /// A clip of our own, by its name.
    Sample(String),
    /// A scene that has no folder, and the files that came with it: those that it names are its own,
    /// the others are opened beside it.
    Together {
        /// The scene.
        scene: Box<Self>,
        /// What came with it.
        others: Vec<Self>,
    },
    /// A scene that was kept when the program ended without saving it.
    Kept(Box<Kept>),
    /// A file that was given to the browser.
    #[cfg(target_arch = "wasm32")]
    Browser(web_sys::File),
}

/// Inputs as they are read: a scene without a folder takes the files that came with it along.
#[must_use]
pub fn together(inputs: Vec<Input>) -> Vec<Input> {
    let needs_others = |input: &Input| {
        let is_placed = cfg!(not(target_arch = "wasm32")) && matches!(input, Input::Path(_));
        !is_placed
            && !matches!(input, Input::Sample(_) | Input::Kept(_))
            && scene::is_scene(&job::name_of(input))
    };
    let (scenes, others): (Vec<_>, Vec<_>) = inputs.into_iter().partition(needs_others);
    let goes_along = |input: &Input| match input {
        Input::Bytes { .. } => true,
        #[cfg(target_arch = "wasm32")]
        Input::Browser(_) => true,
        _ => false,
    };
    let (along, others): (Vec<_>, Vec<_>) = if scenes.is_empty() {
        (Vec::new(), others)
    } else {
        others.into_iter().partition(goes_along)
    };
    let scenes = scenes.into_iter().map(|scene| Input::Together {
        scene: Box::new(scene),
        others: along.clone(),
    });
    scenes.chain(others).collect()
}

/// What becomes of a clip when it was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// It came with others of one group: the first of them that is read becomes the active one, the others
    /// join it, in the order in which they were given.
    Group {
        /// The group's number.
        group: u32,
        /// Its place among those that were given.
        rank: usize,
    },
    /// It joins those on the stage.
    Beside,
    /// It takes the place of its older version.
    Replace(ClipId),
}

/// A reading, among all that were started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct JobId(u64);

/// What was done.
#[derive(Debug)]
pub enum Event {
    /// The first frames of a large file were read; the rest follows as [`Event::Read`], or
    /// [`Event::GivenUp`].
    Begun {
        /// By which reading.
        job: JobId,
        /// What it is read for.
        purpose: Purpose,
        /// The clip, as far as it goes.
        clip: Box<Clip>,
        /// Its preview picture.
        thumbnail: Box<ColorImage>,
    },
    /// A reading ended without a clip.
    GivenUp {
        /// Which.
        job: JobId,
        /// Why, for people; `None` when it was stopped by them.
        message: Option<String>,
    },
    /// A clip was read.
    Read {
        /// By which reading.
        job: JobId,
        /// What it was read for.
        purpose: Purpose,
        /// The clip.
        clip: Box<Clip>,
        /// Its keys, if it is a scene.
        authored: Option<Box<Authored>>,
        /// Its preview picture.
        thumbnail: Box<ColorImage>,
    },
    /// A robot was read.
    Robot {
        /// What it was read for.
        purpose: Purpose,
        /// It.
        robot: Box<Robot>,
    },
    /// A file of poses was read.
    Poses {
        /// Its name.
        name: String,
        /// The poses.
        poses: Vec<posekit_formats::poses::SavedPose>,
    },
    /// A clip's frames were filled in by a method; `None` where nothing can be kept.
    FilledIn(Option<Box<Filled>>),
    /// Something could not be done.
    Failed {
        /// What, and why, for people.
        message: String,
    },
    /// A clip was checked.
    Checked {
        /// Which.
        clip: ClipId,
        /// What was found.
        findings: Vec<Finding>,
    },
    /// A clip became an authored one, or could not.
    Authored {
        /// Which.
        clip: ClipId,
        /// Its scene, or why there is none, for people.
        started: Box<Result<Authored, String>>,
    },
    /// The file of a clip has changed on disk.
    Changed {
        /// Which.
        clip: ClipId,
    },
    /// Files came in another way.
    Chosen(Chosen),
    /// A dialog of the system was answered, or there was none.
    #[cfg(not(target_arch = "wasm32"))]
    Answered {
        /// What it was for.
        wanted: Box<crate::work::dialog::Wanted>,
        /// The answer.
        answer: crate::work::dialog::Answer,
    },
    /// Something was written.
    Written {
        /// What, for people.
        message: String,
    },
    /// A file of a folder was looked at.
    Summary(Box<Summary>),
    /// All files of a folder were looked at.
    FolderDone,
    /// The text of a file can be shown.
    Text(Arc<FileText>),
}

/// Files that came otherwise than by a dialog of the system.
#[derive(Clone, Debug)]
pub enum Chosen {
    /// Files to open.
    Inputs(Vec<Input>),
    /// Files that join those on the stage.
    Beside(Vec<Input>),
}

/// The clips that a server offers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listing {
    /// What they are called together.
    pub folder: String,
    /// Each with its name.
    pub clips: Vec<(Listed, String)>,
    /// What the server has and does not list, for people.
    pub shortage: Option<String>,
}

/// A file that can be looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Where it is; on a page, its address.
    pub path: PathBuf,
    /// Its size, where the list says it.
    pub bytes: Option<u64>,
}

impl From<PathBuf> for Listed {
    fn from(path: PathBuf) -> Self {
        Self { path, bytes: None }
    }
}

/// What the library says of a file that is not open.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The file.
    pub path: PathBuf,
    /// Frames, or why there are none.
    pub outcome: Result<SummaryNumbers, String>,
}

/// The numbers of a clip in the library.
#[derive(Clone, Debug)]
pub struct SummaryNumbers {
    /// How long it is.
    pub duration_secs: f64,
    /// Frames a second.
    pub fps: f64,
    /// How many joints its skeleton has.
    pub joint_count: usize,
    /// Its preview picture.
    pub thumbnail: ColorImage,
}

/// A reading that is going on.
#[derive(Clone, Debug)]
pub struct Job {
    /// Which reading it is.
    pub id: JobId,
    /// What is read.
    pub name: String,
    /// How far it is.
    pub progress: Arc<Progress>,
}

/// How far a reading is, seen from both sides.
#[derive(Debug, Default)]
pub struct Progress {
    done: AtomicU64,
    total: AtomicU64,
    cancelled: AtomicBool,
    finished: AtomicBool,
}

impl Progress {
    /// How much is done, 0 to 1; `None` while nobody knows.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a share of 0 to 1, for a bar on the screen"
    )]
    pub fn fraction(&self) -> Option<f32> {
        let total = self.total.load(Ordering::Relaxed);
        let done = self.done.load(Ordering::Relaxed);
        (total > 0).then(|| (done as f64 / total as f64).min(1.0) as f32)
    }

    /// Asks it to stop.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Whether it is over.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.finished.load(Ordering::Acquire)
    }

    /// Tells how much there is to do.
    pub fn set_total(&self, total: u64) {
        self.total.store(total, Ordering::Relaxed);
    }

    /// Tells how much is done.
    pub fn set_done(&self, done: u64) {
        self.done.store(done, Ordering::Relaxed);
    }

    /// Tells that it is over. What was handed in before is seen by whoever sees this.
    pub fn finish(&self) {
        self.finished.store(true, Ordering::Release);
    }
}

/// Where work hands in what it did.
#[derive(Clone, Debug)]
pub struct Outbox {
    events: Sender<Event>,
    ctx: egui::Context,
}

impl Outbox {
    /// Hands in an event and wakes the window. False when nobody listens any more.
    pub fn send(&self, event: Event) -> bool {
        let sent = self.events.send(event).is_ok();
        self.ctx.request_repaint();
        sent
    }

    /// Wakes the window to show progress.
    pub fn wake(&self) {
        self.ctx.request_repaint();
    }
}

/// Reads away from the window.
#[derive(Debug)]
pub struct Loader {
    outbox: Outbox,
    inbox: Receiver<Event>,
    jobs: Vec<Job>,
    jobs_started: u64,
    /// Readings that were stopped, of which nothing more is wanted.
    stopped: BTreeSet<JobId>,
    folder: Option<Arc<Progress>>,
}

impl Loader {
    /// A loader that wakes `ctx` when something was done.
    #[must_use]
    pub fn new(ctx: &egui::Context) -> Self {
        let (events, inbox) = channel();
        let outbox = Outbox {
            events,
            ctx: ctx.clone(),
        };
        Self {
            outbox,
            inbox,
            jobs: Vec::new(),
            jobs_started: 0,
            stopped: BTreeSet::new(),
            folder: None,
        }
    }

    /// Starts reading a clip.
    pub fn read(&mut self, input: Input, purpose: Purpose) {
        let name = job::name_of(&input);
        let progress = Arc::new(Progress::default());
        let id = JobId(self.jobs_started);
        self.jobs_started += 1;
        self.jobs.push(Job {
            id,
            name,
            progress: Arc::clone(&progress),
        });
        let reading = job::Reading {
            job: id,
            name: job::name_of(&input),
            purpose,
            progress,
            outbox: self.outbox.clone(),
        };
        #[cfg(not(target_arch = "wasm32"))]
        thread::start(move || disk::read(&reading, &input));
        #[cfg(target_arch = "wasm32")]
        page::read(reading, input);
    }

    /// Starts checking a clip.
    pub fn check(&mut self, id: ClipId, clip: Arc<Clip>) {
        let outbox = self.outbox.clone();
        thread::start(move || {
            let findings = crate::state::clip::check(&clip);
            outbox.send(Event::Checked { clip: id, findings });
        });
    }

    /// Starts filling in a clip's frames by a method.
    pub fn fill_in(&mut self, job: FillJob) {
        let outbox = self.outbox.clone();
        thread::start(move || {
            outbox.send(Event::FilledIn(job.run().map(Box::new)));
        });
    }

    /// Starts reducing a clip to keys.
    pub fn reduce(&mut self, id: ClipId, clip: Arc<Clip>, how: Start) {
        let outbox = self.outbox.clone();
        thread::start(move || {
            let started = Box::new(start(&clip, how, 0.0, false));
            outbox.send(Event::Authored { clip: id, started });
        });
    }

    /// Starts making a file's text ready to be shown.
    pub fn lay_out(&mut self, bytes: Arc<Vec<u8>>) {
        let outbox = self.outbox.clone();
        thread::start(move || {
            outbox.send(Event::Text(Arc::new(FileText::new(bytes))));
        });
    }

    /// Starts looking at the files of a folder; one that was being looked at is given up.
    pub fn look_at(&mut self, files: Vec<Listed>) {
        self.forget_folder();
        let progress = Arc::new(Progress::default());
        self.folder = Some(Arc::clone(&progress));
        let outbox = self.outbox.clone();
        #[cfg(not(target_arch = "wasm32"))]
        thread::start(move || disk::look_at(&files, &progress, &outbox));
        #[cfg(target_arch = "wasm32")]
        page::look_at(files, progress, outbox);
    }

    /// Stops looking at a folder.
    pub fn forget_folder(&mut self) {
        if let Some(before) = self.folder.take() {
            before.cancel();
        }
    }

    /// What is being read.
    #[must_use]
    pub fn jobs(&self) -> &[Job] {
        &self.jobs
    }

    /// Whether a folder is being looked at.
    #[must_use]
    pub fn is_looking(&self) -> bool {
        self.folder.is_some()
    }

    /// Where work that others start hands in what it did.
    #[must_use]
    pub fn outbox(&self) -> &Outbox {
        &self.outbox
    }

    /// What was done since the last time.
    pub fn take_events(&mut self) -> Vec<Event> {
        let mut events = Vec::new();
        // A reading that was stopped is over at once: it may be waiting for a disk or a pipe, and see late
        // that it was stopped.
        self.jobs.retain(|job| {
            let is_over = job.progress.is_finished();
            let is_stopped = job.progress.is_cancelled() && !is_over;
            if is_stopped {
                self.stopped.insert(job.id);
                let (job, message) = (job.id, None);
                events.push(Event::GivenUp { job, message });
            }
            !is_over && !is_stopped
        });
        let is_wanted = |event: &Event| match event {
            Event::Begun { job, .. } | Event::Read { job, .. } | Event::GivenUp { job, .. } => {
                !self.stopped.contains(job)
            }
            _ => true,
        };
        events.extend(self.inbox.try_iter().filter(is_wanted));
        if events
            .iter()
            .any(|event| matches!(event, Event::FolderDone))
        {
            self.folder = None;
        }
        events
    }
}
