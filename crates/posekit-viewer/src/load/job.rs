//! The work itself: bytes to clips, clips to summaries. Where the bytes come from is the business of
//! `disk` and `page`.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
#[cfg(not(target_arch = "wasm32"))]
use std::sync::atomic::{AtomicU64, Ordering};

#[cfg(not(target_arch = "wasm32"))]
use posekit_formats::bvh::PIECE_BYTES;
use posekit_formats::bvh::{self, Bvh, Extent, ReadOptions};
use posekit_formats::poses::{self, SavedPose, is_poses_name};
use posekit_formats::report::{Import, ReadError, ReadErrorKind};

use super::scene::{ReadScene, read_scene};
use super::{Chosen, Event, Input, JobId, Outbox, Progress, Purpose, SummaryNumbers};
use crate::picture::thumbnail::thumbnail;
use crate::picture::to_color_image;
use crate::state::animate::Authored;
use crate::state::arm::Robot;
use crate::state::clip::{Clip, Source};

/// A file this small has no progress to show.
pub(super) const SMALL_BYTES: u64 = 4 << 20;

/// As much of a large file is shown before the rest is read: some hundred frames, read in a few
/// hundredths of a second.
const BEGINNING_BYTES: usize = 1 << 20;

/// The text of files up to this size is kept, to be shown.
const MOST_TEXT_BYTES: usize = if cfg!(target_arch = "wasm32") {
    128 << 20
} else {
    512 << 20
};

/// What a file holds.
pub(super) enum Opened {
    Clip(Box<Clip>),
    Scene(Box<ReadScene>),
    Robot(Box<Robot>),
    Poses(String, Vec<SavedPose>),
}

/// Whether a file says that it is a robot's: by its name, or because it is XML, which motions are not.
fn is_robot(name: &str, bytes: &[u8]) -> bool {
    let has_name = Path::new(name)
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"));
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    has_name || text.trim_ascii_start().first() == Some(&b'<')
}

/// Why a file is not opened that neither is called as a motion nor begins as one: it is no use to be told where in
/// a picture the motion was expected.
fn told_of_kind(stop: Stop, name: &str, bytes: &[u8]) -> Stop {
    let ending = Path::new(name).extension();
    let has_name = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("bvh"));
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let begins = text.trim_ascii_start().get(..BEGINNING.len());
    let has_beginning = begins.is_some_and(|begins| begins.eq_ignore_ascii_case(BEGINNING));
    match stop {
        Stop::Failed(_) if !has_name && !has_beginning => Stop::Failed(format!(
            "{name} is no motion that is read here. Opened are BVH files (.bvh), scenes (.posekit.toml), robots \
             (.urdf) and saved poses (.poses.toml); other programs, such as Blender, save motions of other kinds as \
             BVH."
        )),
        stop => stop,
    }
}

/// The first word of a BVH file.
const BEGINNING: &[u8] = b"HIERARCHY";

/// Why a clip was not read.
pub(super) enum Stop {
    Cancelled,
    Failed(String),
}

pub(super) fn name_of(input: &Input) -> String {
    match input {
        #[cfg(target_arch = "wasm32")]
        Input::Path(address) => super::page::name_at(address),
        #[cfg(not(target_arch = "wasm32"))]
        Input::Path(path) => {
            let name = path.file_name().unwrap_or(path.as_os_str());
            name.to_string_lossy().into_owned()
        }
        Input::Bytes { name, .. } => name.clone(),
        Input::Sample(name) => format!("sample {name}"),
        Input::Together { scene, .. } => name_of(scene),
        Input::Kept(kept) => kept.name.clone(),
        #[cfg(target_arch = "wasm32")]
        Input::Browser(file) => file.name(),
    }
}

/// A reading that is going on, seen from where it runs.
#[derive(Debug)]
pub(super) struct Reading {
    pub(super) job: JobId,
    /// What is read, for people.
    pub(super) name: String,
    pub(super) purpose: Purpose,
    pub(super) progress: Arc<Progress>,
    pub(super) outbox: Outbox,
}

impl Reading {
    /// Hands in what became of it.
    pub(super) fn hand_in(&self, outcome: Result<Opened, Stop>) {
        let job = self.job;
        // Who has stopped it has no use for what came of it.
        let outcome = match self.progress.is_cancelled() {
            true => Err(Stop::Cancelled),
            false => outcome,
        };
        match outcome {
            Ok(Opened::Robot(robot)) => {
                let purpose = self.purpose;
                self.outbox.send(Event::Robot { purpose, robot });
            }
            Ok(Opened::Poses(name, poses)) => {
                self.outbox.send(Event::Poses { name, poses });
            }
            Ok(Opened::Clip(clip)) => self.hand_in_clip(clip, None),
            Ok(Opened::Scene(read)) => {
                let (clip, authored) = *read;
                self.hand_in_clip(Box::new(clip), Some(Box::new(authored)));
            }
            Err(stop) => {
                let message = match stop {
                    Stop::Failed(message) => Some(message),
                    Stop::Cancelled => None,
                };
                self.outbox.send(Event::GivenUp { job, message });
            }
        }
        // The job ends only after its outcome is on its way: a window between the two would show
        // neither the job nor its clip. The second waking takes the job's row away.
        self.progress.finish();
        self.outbox.wake();
    }

    fn hand_in_clip(&self, clip: Box<Clip>, authored: Option<Box<Authored>>) {
        let thumbnail = Box::new(to_color_image(&thumbnail(&clip)));
        self.outbox.send(Event::Read {
            job: self.job,
            purpose: self.purpose,
            clip,
            authored,
            thumbnail,
        });
    }

    /// Opens what came with a scene and is not named by it.
    pub(super) fn open_others(&self, scene: &[u8], others: &[Input]) {
        let named = posekit_formats::scene::read(scene).map_or_else(
            |_told_elsewhere| Vec::new(),
            |scene| scene.files().into_iter().map(str::to_owned).collect(),
        );
        let is_named = |input: &Input| {
            let name = name_of(input);
            named
                .iter()
                .any(|file: &String| file.rsplit(['/', '\\']).next() == Some(name.as_str()))
        };
        let rest: Vec<Input> = others
            .iter()
            .filter(|input| !is_named(input))
            .cloned()
            .collect();
        if !rest.is_empty() {
            self.outbox.send(Event::Chosen(Chosen::Beside(rest)));
        }
    }

    /// A clip of our own; the walk that is keyed by hand is a scene.
    pub(super) fn open_sample(&self, sample: &str) -> Result<Opened, Stop> {
        use posekit_formats::scene::{AUTHORED_WALK, AUTHORED_WALK_NAME, EXTENSION};
        if sample == AUTHORED_WALK_NAME {
            let name = format!("{sample}.{EXTENSION}");
            let none = |_: &str| Err("it is not there".to_owned());
            return read_scene((&name, None), AUTHORED_WALK.as_bytes(), none)
                .map(|read| Opened::Scene(Box::new(read)))
                .map_err(Stop::Failed);
        }
        let clip = Clip::of_sample(format!("{sample}.bvh"), sample);
        clip.map(|clip| Opened::Clip(Box::new(clip)))
            .ok_or_else(|| Stop::Failed(format!("there is no sample '{sample}'")))
    }

    /// Hands in the first frames of a large file, so that there is something to see while the rest
    /// is read. Where they make no clip, the whole file will tell why.
    pub(super) fn show_beginning(&self, name: &str, source: &Source, bytes: &[u8]) {
        // A file that is read again is on the screen already.
        let replaces = matches!(self.purpose, Purpose::Replace(_));
        if replaces || (bytes.len() as u64) < SMALL_BYTES {
            return;
        }
        let Some(clip) = beginning(name, source, bytes) else {
            return;
        };
        let thumbnail = Box::new(to_color_image(&thumbnail(&clip)));
        self.outbox.send(Event::Begun {
            job: self.job,
            purpose: self.purpose,
            clip: Box::new(clip),
            thumbnail,
        });
    }

    /// What the bytes of a file hold: a robot, or a clip as [`clip_of`](Self::clip_of) reads it.
    pub(super) fn open(&self, name: &str, source: Source, bytes: Vec<u8>) -> Result<Opened, Stop> {
        if is_poses_name(name) {
            let poses = poses::read(&bytes).map_err(|error| Stop::Failed(error.in_file(name)))?;
            return Ok(Opened::Poses(name.to_owned(), poses));
        }
        if is_robot(name, &bytes) {
            let robot =
                Robot::read(name, &bytes).map_err(|why| Stop::Failed(format!("{name}: {why}")))?;
            return Ok(Opened::Robot(Box::new(robot)));
        }
        let clip = self.clip_of(name, source, &bytes);
        let mut clip = clip.map_err(|stop| told_of_kind(stop, name, &bytes))?;
        if bytes.len() <= MOST_TEXT_BYTES {
            clip.text = Some(Arc::new(bytes));
        }
        Ok(Opened::Clip(Box::new(clip)))
    }

    /// The clip in the bytes of its file: the second half of the progress. `name` is for messages and
    /// the list.
    fn clip_of(&self, name: &str, source: Source, bytes: &[u8]) -> Result<Clip, Stop> {
        let failed = |why: String| Stop::Failed(format!("{name}: {why}"));
        let length = bytes.len() as u64;
        let is_large = length > SMALL_BYTES;
        self.progress.set_total(2 * length);
        let step = |done: usize| {
            self.progress.set_done(length + done as u64);
            if is_large {
                self.outbox.wake();
            }
            if self.progress.is_cancelled() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let import = self.read_bvh(bytes, step).map_err(|error| {
            if error.kind == ReadErrorKind::Cancelled {
                Stop::Cancelled
            } else {
                failed(error.to_string())
            }
        })?;
        Clip::from_bvh(name, source, import).map_err(|error| failed(error.to_string()))
    }
}

/// A reading that ends without an outcome would be waited for without an end.
impl Drop for Reading {
    fn drop(&mut self) {
        if !self.progress.is_finished() {
            let why = format!("{}: the reader failed; please report the file", self.name);
            self.hand_in(Err(Stop::Failed(why)));
        }
    }
}

/// Reads BVH; a large file on all cores, where there are threads.
#[cfg(not(target_arch = "wasm32"))]
impl Reading {
    fn read_bvh(
        &self,
        bytes: &[u8],
        step: impl FnMut(usize) -> ControlFlow<()>,
    ) -> Result<Import<Bvh>, ReadError> {
        let hands = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let options = ReadOptions::default();
        if bytes.len() as u64 <= SMALL_BYTES || hands == 1 {
            return bvh::read_with(bytes, options, step);
        }
        let (length, done) = (bytes.len() as u64, AtomicU64::new(0));
        bvh::read_in_pieces(bytes, options, PIECE_BYTES, step, |pieces| {
            let share = pieces.len().div_ceil(hands).max(1);
            std::thread::scope(|threads| {
                for part in pieces.chunks_mut(share) {
                    let work = || {
                        for piece in part {
                            // What is left out is asked about when it is read after the others.
                            if self.progress.is_cancelled() {
                                return;
                            }
                            piece.work();
                            // Each piece is worked on twice.
                            let half = piece.byte_count() as u64 / 2;
                            let done = done.fetch_add(half, Ordering::Relaxed) + half;
                            self.progress.set_done(length + done);
                        }
                        self.outbox.wake();
                    };
                    // Where no thread can be had, the pieces are read after the others.
                    drop(std::thread::Builder::new().spawn_scoped(threads, work));
                }
            });
        })
    }
}

/// Reads BVH; a page has one thread.
#[cfg(target_arch = "wasm32")]
impl Reading {
    fn read_bvh(
        &self,
        bytes: &[u8],
        step: impl FnMut(usize) -> ControlFlow<()>,
    ) -> Result<Import<Bvh>, ReadError> {
        bvh::read_with(bytes, ReadOptions::default(), step)
    }
}

/// The clip of a file's first [`BEGINNING_BYTES`], if there is a whole frame in them.
fn beginning(name: &str, source: &Source, bytes: &[u8]) -> Option<Clip> {
    let head = &bytes[..bytes.len().min(BEGINNING_BYTES)];
    let whole_lines = head.iter().rposition(|byte| *byte == b'\n')?;
    let options = ReadOptions {
        extent: Extent::Beginning,
        ..ReadOptions::default()
    };
    let import =
        bvh::read_with(&head[..whole_lines], options, |_| ControlFlow::Continue(())).ok()?;
    let clip = Clip::from_bvh(name, source.clone(), import).ok()?;
    (clip.frame_count() > 0).then_some(clip)
}

/// Reads a clip at once, without progress: for tests and for small things.
///
/// # Errors
/// What is wrong with the bytes, for people.
pub fn read_clip(name: &str, bytes: &[u8]) -> Result<Clip, String> {
    let import = bvh::read(bytes).map_err(|error| format!("{name}: {error}"))?;
    let clip = Clip::from_bvh(name, Source::Bytes, import);
    let mut clip = clip.map_err(|error| format!("{name}: {error}"))?;
    clip.text = Some(Arc::new(bytes.to_vec()));
    Ok(clip)
}

/// What the library says of a clip in these bytes.
///
/// # Errors
/// What is wrong with the bytes, for people.
pub(super) fn summarize(bytes: &[u8]) -> Result<SummaryNumbers, String> {
    if is_robot("", bytes) {
        return Err("a robot, for the arm lab".to_owned());
    }
    let import = bvh::read(bytes).map_err(|error| error.to_string())?;
    let clip = Clip::from_bvh("", Source::Bytes, import).map_err(|error| error.to_string())?;
    Ok(numbers_of(&clip))
}

/// What the library says of a clip.
pub(super) fn numbers_of(clip: &Clip) -> SummaryNumbers {
    SummaryNumbers {
        duration_secs: clip.motion.duration_secs(),
        fps: clip.fps(),
        joint_count: clip.skeleton().joint_count(),
        thumbnail: to_color_image(&thumbnail(clip)),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    /// As when the reader's thread panics.
    #[test]
    fn a_reading_that_breaks_off_is_told_and_over() {
        let (events, inbox) = channel();
        let progress = Arc::new(Progress::default());
        let reading = Reading {
            job: JobId(3),
            name: "odd.bvh".to_owned(),
            purpose: Purpose::Beside,
            progress: Arc::clone(&progress),
            outbox: Outbox {
                events,
                ctx: egui::Context::default(),
            },
        };
        drop(reading);
        let event = inbox.try_recv().expect("it is told");
        let Event::GivenUp { job, message } = event else {
            panic!("{event:?}");
        };
        assert_eq!(job, JobId(3));
        assert!(message.is_some_and(|text| text.starts_with("odd.bvh: ")));
        assert!(progress.is_finished());
    }
}
