//! Files in and out: dialogs, and what is written.

use std::sync::Arc;

use posekit_formats::bvh::{self, Bvh};
use posekit_render::image::Image;

use crate::state::clip::Clip;

/// A file to be written: its bytes, and what it is.
#[derive(Clone, Debug)]
pub struct Parcel {
    /// The name proposed.
    pub name: String,
    /// What kind of file it is, for the dialog.
    pub kind: &'static str,
    /// The extension, without the dot.
    pub extension: &'static str,
    /// The bytes.
    pub bytes: Arc<[u8]>,
}

/// The document of a stretch of a clip: what the file said, to the digit, and fewer frames.
#[must_use]
pub fn range_document(clip: &Clip, (first, last): (usize, usize)) -> Bvh {
    let mut document = (*clip.document).clone();
    let channel_count = document.channel_count();
    if let Some(motion) = &mut document.motion
        && motion.frame_count > 0
    {
        let last = last.min(motion.frame_count - 1);
        let first = first.min(last);
        motion.values = motion.values[first * channel_count..(last + 1) * channel_count].to_vec();
        motion.frame_count = last - first + 1;
    }
    document
}

/// The range as a BVH file.
///
/// # Errors
/// If the document cannot be written, for people.
pub fn range_parcel(clip: &Clip, range: (usize, usize)) -> Result<Parcel, String> {
    let document = range_document(clip, range);
    document.validate().map_err(|problem| problem.to_string())?;
    let last = clip.frame_count().saturating_sub(1);
    // The time line may be longer: that of another clip beside this one.
    let range = (range.0.min(last), range.1.min(last));
    let whole = range == (0, last);
    let stem = stem_of(&clip.name);
    let name = if whole {
        format!("{stem}.bvh")
    } else {
        format!("{stem}_{}-{}.bvh", range.0, range.1)
    };
    let bytes = bvh::write(&document).into();
    Ok(Parcel {
        name,
        kind: "BVH motion",
        extension: "bvh",
        bytes,
    })
}

/// The picture as a PNG file.
///
/// # Errors
/// If it cannot be encoded, for people.
pub fn picture_parcel(image: &Image, clip_name: &str, frame: usize) -> Result<Parcel, String> {
    let mut bytes = Vec::new();
    posekit_render::output::write_png(image, &mut bytes).map_err(|error| error.to_string())?;
    let name = format!("{}_{frame}.png", stem_of(clip_name));
    Ok(Parcel {
        name,
        kind: "PNG picture",
        extension: "png",
        bytes: bytes.into(),
    })
}

/// A clip's name without its extension, fit for a file name.
#[must_use]
pub fn stem_of(name: &str) -> String {
    let stem = name
        .strip_suffix(".bvh")
        .or(name.strip_suffix(".BVH"))
        .unwrap_or(name);
    let fit = |c: char| {
        if c.is_alphanumeric() || "-_.+".contains(c) {
            c
        } else {
            '_'
        }
    };
    let stem: String = stem.chars().map(fit).collect();
    if stem.is_empty() {
        "clip".to_owned()
    } else {
        stem
    }
}

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::{
    ask_for_files, ask_for_folder, ask_for_scene_path, ask_for_video_path, hand_over, write_beside,
};

#[cfg(not(target_arch = "wasm32"))]
mod desktop {
    //! Dialogs of the system, each on a thread of its own.

    use std::io::Write;
    use std::path::Path;

    use super::Parcel;
    use crate::load::{Chosen, Event, Input, Outbox};
    use crate::state::session::ClipId;

    /// Asks for files to open.
    pub fn ask_for_files(outbox: &Outbox) {
        in_thread(outbox, |outbox| {
            let dialog = rfd::FileDialog::new()
                .set_title("Open motion files")
                .add_filter(
                    "Motion, scenes and robots",
                    &["bvh", "BVH", "posekit.toml", "toml", "urdf", "URDF"],
                );
            if let Some(paths) = dialog.pick_files() {
                let inputs = paths.into_iter().map(Input::Path).collect();
                outbox.send(Event::Chosen(Chosen::Inputs(inputs)));
            }
        });
    }

    /// Asks for a folder to list.
    pub fn ask_for_folder(outbox: &Outbox) {
        in_thread(outbox, |outbox| {
            let dialog = rfd::FileDialog::new().set_title("Open a folder of motion files");
            if let Some(folder) = dialog.pick_folder() {
                outbox.send(Event::Chosen(Chosen::Folder(folder)));
            }
        });
    }

    /// Asks where a video goes.
    pub fn ask_for_video_path(outbox: &Outbox, name: String, extension: &'static str) {
        in_thread(outbox, move |outbox| {
            let dialog = rfd::FileDialog::new()
                .set_title("Export a video")
                .set_file_name(name)
                .add_filter("Video", &[extension]);
            if let Some(path) = dialog.save_file() {
                outbox.send(Event::Chosen(Chosen::VideoPath(path)));
            }
        });
    }

    /// Asks where the scene of a clip goes.
    pub fn ask_for_scene_path(outbox: &Outbox, clip: ClipId, name: String) {
        in_thread(outbox, move |outbox| {
            let dialog = rfd::FileDialog::new()
                .set_title("Save the scene")
                .set_file_name(name)
                .add_filter("posekit scene", &["posekit.toml", "toml"]);
            let path = dialog.save_file();
            outbox.send(Event::Chosen(Chosen::ScenePath(clip, path)));
        });
    }

    /// Asks where a file goes, and writes it.
    pub fn hand_over(outbox: &Outbox, parcel: Parcel) {
        in_thread(outbox, move |outbox| {
            let dialog = rfd::FileDialog::new()
                .set_title("Save")
                .set_file_name(&parcel.name)
                .add_filter(parcel.kind, &[parcel.extension]);
            let Some(path) = dialog.save_file() else {
                return;
            };
            let written = write_beside(&path, |file| file.write_all(&parcel.bytes));
            outbox.send(match written {
                Ok(()) => Event::Written {
                    message: format!("Saved {}", path.display()),
                },
                Err(error) => Event::Failed {
                    message: format!("{}: {error}", path.display()),
                },
            });
        });
    }

    fn in_thread(outbox: &Outbox, ask: impl FnOnce(Outbox) + Send + 'static) {
        let outbox = outbox.clone();
        let for_failure = outbox.clone();
        let thread = std::thread::Builder::new().name("dialog".into());
        if thread.spawn(move || ask(outbox)).is_err() {
            let message = "no dialog could be opened".to_owned();
            for_failure.send(Event::Failed { message });
        }
    }

    /// Writes a file beside its place and renames it into it: a failure leaves the old one whole.
    ///
    /// # Errors
    /// Those of the file system, and of `write`.
    pub fn write_beside<E: From<std::io::Error>>(
        path: &Path,
        write: impl FnOnce(&mut std::io::BufWriter<std::fs::File>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.tmp", std::process::id()));
        let beside = path.with_file_name(name);
        let outcome = std::fs::File::create(&beside)
            .map_err(E::from)
            .and_then(|file| {
                let mut file = std::io::BufWriter::new(file);
                write(&mut file)?;
                file.flush().map_err(E::from)
            });
        let outcome = outcome.and_then(|()| std::fs::rename(&beside, path).map_err(E::from));
        if outcome.is_err() {
            // What is left of it is of no use; that it cannot be removed either is no news.
            drop(std::fs::remove_file(&beside));
        }
        outcome
    }
}
