//! Scenes: their text, and the files that it names, as a clip with its keys.

use std::path::Path;

use posekit_formats::scene::{self, motion_of};

use crate::state::animate::{Authored, Files, place};
use crate::state::clip::{Clip, Source};

/// A scene that was read: the clip that it bakes to, and its keys.
pub type ReadScene = (Clip, Authored);

/// Whether a file of this name is a scene.
#[must_use]
pub fn is_scene(name: &str) -> bool {
    scene::is_scene_name(name)
}

/// Reads a scene. `path` is where it is, if that is somewhere: files are looked for from there.
/// `bytes_of` gives the bytes of a file as the scene names it, or by its path.
///
/// # Errors
/// What is wrong, for people, with the place in the text.
pub fn read_scene(
    (name, path): (&str, Option<&Path>),
    bytes: &[u8],
    bytes_of: impl Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<ReadScene, String> {
    let read = scene::read(bytes).map_err(|error| error.in_file(name))?;
    let path = path.map(place::absolute);
    let scene = match path.as_deref().and_then(Path::parent) {
        Some(folder) => place::opened(&read, folder),
        None => read,
    };
    let authored = authored_of(name, scene, bytes_of)?.in_file(path.clone());
    let mut clip = Clip::from_motion(name, authored.bake());
    clip.source = Source::Scene(path);
    Ok((clip, authored))
}

/// A scene and its files, which are told by where they are.
///
/// # Errors
/// What is wrong, for people.
pub fn authored_of(
    name: &str,
    scene: posekit_formats::scene::Scene,
    bytes_of: impl Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<Authored, String> {
    let mut files = Files::new();
    for file in scene.files() {
        let motion = motion_of(file, |file| bytes_of(file))
            .map_err(|error| format!("{name}: {file}: {error}"))?;
        files.insert(file.to_owned(), motion);
    }
    Authored::new(scene, files).map_err(|error| format!("{name}: {error}"))
}

/// The bytes of a file among some that came together, known by their names alone.
pub(super) fn among<'a>(
    files: &'a [(String, Vec<u8>)],
) -> impl Fn(&str) -> Result<Vec<u8>, String> + 'a {
    move |wanted| {
        let last = wanted.rsplit(['/', '\\']).next().unwrap_or(wanted);
        let found = files.iter().find(|(name, _)| name == last);
        found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| {
            "it is not there: a scene without a folder is opened together with the files it names"
                .to_owned()
        })
    }
}
