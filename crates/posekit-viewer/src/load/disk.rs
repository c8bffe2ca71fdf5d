//! The files of this machine.

use std::io::Read as _;
use std::path::Path;

use posekit_formats::system::in_words;

use super::job::{self, Opened, Reading, SMALL_BYTES, Stop};
use super::scene::{among, is_scene, read_scene};
use super::{Event, Input, Listed, Outbox, Progress, Summary, SummaryNumbers};
use crate::state::clip::Source;

/// How much of a file is read at once: little enough to be stopped between.
const PIECE_BYTES: usize = 4 << 20;

/// Files larger than this are not opened just to make a library's preview.
const PREVIEW_LIMIT_BYTES: u64 = 64 << 20;

/// Reads a clip and hands it in.
pub(super) fn read(reading: &Reading, input: &Input) {
    reading.hand_in(read_input(reading, input));
    if let Input::Together { scene, others } = input
        && let Ok(bytes) = bytes_of(scene)
    {
        reading.open_others(&bytes, others);
    }
}

fn read_input(reading: &Reading, input: &Input) -> Result<Opened, Stop> {
    let name = job::name_of(input);
    match input {
        Input::Path(path) => {
            let bytes = read_file(reading, path, &name)?;
            if is_scene(&name) {
                return open_scene(&name, Some(path), &bytes, file_bytes);
            }
            reading.open(&name, Source::File(path.clone()), bytes)
        }
        Input::Sample(sample) => reading.open_sample(sample),
        Input::Together { scene, others } => {
            let bytes = bytes_of(scene)?;
            let mut files = Vec::new();
            for other in others {
                files.push((job::name_of(other), bytes_of(other)?));
            }
            open_scene(&name, None, &bytes, among(&files))
        }
        Input::Kept(kept) => kept
            .open(file_bytes)
            .map(|read| Opened::Scene(Box::new(read)))
            .map_err(Stop::Failed),
        Input::Bytes { bytes, .. } if is_scene(&name) => open_scene(&name, None, bytes, among(&[])),
        Input::Bytes { bytes, .. } => {
            reading.show_beginning(&name, &Source::Bytes, bytes);
            reading.open(&name, Source::Bytes, bytes.to_vec())
        }
    }
}

fn open_scene(
    name: &str,
    path: Option<&Path>,
    bytes: &[u8],
    bytes_of: impl Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<Opened, Stop> {
    read_scene((name, path), bytes, bytes_of)
        .map(|read| Opened::Scene(Box::new(read)))
        .map_err(Stop::Failed)
}

/// The bytes of a file that a scene names.
pub(super) fn file_bytes(path: &str) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| plain(&error))
}

/// The bytes of a small input.
fn bytes_of(input: &Input) -> Result<Vec<u8>, Stop> {
    match input {
        Input::Bytes { bytes, .. } => Ok(bytes.to_vec()),
        Input::Path(path) => {
            let failed = |error| Stop::Failed(format!("{}: {}", path.display(), plain(&error)));
            std::fs::read(path).map_err(failed)
        }
        other => {
            let name = job::name_of(other);
            Err(Stop::Failed(format!("{name}: it goes with no scene")))
        }
    }
}

/// Reads a file piece by piece: the first half of the progress.
fn read_file(reading: &Reading, path: &Path, name: &str) -> Result<Vec<u8>, Stop> {
    let failed =
        |error: std::io::Error| Stop::Failed(format!("{}: {}", path.display(), plain(&error)));
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(Stop::Failed(format!(
            "{}: is a folder, not a file",
            path.display()
        )));
    }
    let mut file = std::fs::File::open(path).map_err(failed)?;
    let length = metadata.len();
    reading.progress.set_total(2 * length);
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or(0).min(1 << 31));
    loop {
        if reading.progress.is_cancelled() {
            return Err(Stop::Cancelled);
        }
        let before = bytes.len();
        let piece = file
            .by_ref()
            .take(PIECE_BYTES as u64)
            .read_to_end(&mut bytes);
        piece.map_err(failed)?;
        if bytes.len() == before {
            return Ok(bytes);
        }
        reading.progress.set_done(bytes.len() as u64);
        if length > SMALL_BYTES {
            if before == 0 {
                reading.show_beginning(name, &Source::File(path.to_owned()), &bytes);
            }
            reading.outbox.wake();
        }
    }
}

/// Why a file cannot be read, for people.
fn plain(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "reading it is not permitted".to_owned(),
        _ => in_words(error),
    }
}

/// Looks at files one after the other.
pub(super) fn look_at(files: &[Listed], progress: &Progress, outbox: &Outbox) {
    for Listed { path, .. } in files {
        if progress.is_cancelled() {
            return;
        }
        let summary = Summary {
            path: path.clone(),
            outcome: summarize(path),
        };
        if progress.is_cancelled() || !outbox.send(Event::Summary(Box::new(summary))) {
            return;
        }
    }
    progress.finish();
    outbox.send(Event::FolderDone);
}

fn summarize(path: &Path) -> Result<SummaryNumbers, String> {
    let metadata = std::fs::metadata(path).map_err(|error| plain(&error))?;
    if metadata.len() > PREVIEW_LIMIT_BYTES {
        return Err(format!(
            "{} MB: opened only when asked",
            metadata.len() >> 20
        ));
    }
    let bytes = std::fs::read(path).map_err(|error| plain(&error))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if is_scene(&name) {
        let (clip, _) = read_scene((&name, Some(path)), &bytes, file_bytes)?;
        return Ok(job::numbers_of(&clip));
    }
    job::summarize(&bytes)
}
