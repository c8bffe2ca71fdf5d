//! What the names of files in a scene mean, and how a scene's own problems are told.

use std::fmt;
use std::sync::Arc;

use posekit::motion::{Motion, PositionPolicy};

use super::{AUTHORED_WALK, SceneReadError, Shot, is_scene_name, read};
use crate::bvh;

/// What the name of a clip of our own starts with in a scene.
pub const SAMPLE_PREFIX: &str = "sample:";

/// The name, after [`SAMPLE_PREFIX`], of the walk that is [`AUTHORED_WALK`].
pub const AUTHORED_WALK_NAME: &str = "keyed-walk";

/// Why a motion that a scene names could not be had, for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MotionFileError(pub String);

impl fmt::Display for MotionFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for MotionFileError {}

/// The motion that a scene means by a name: a clip of our own, or that of the BVH file whose bytes
/// `bytes_of` gives. It is what [`Shot::new`] wants to be told.
///
/// # Errors
/// [`MotionFileError`] when there is no such sample, the file cannot be had, or it holds no motion.
pub fn motion_of(
    named: &str,
    bytes_of: impl FnOnce(&str) -> Result<Vec<u8>, String>,
) -> Result<Arc<Motion>, MotionFileError> {
    if let Some(sample) = named.strip_prefix(SAMPLE_PREFIX) {
        let motion = sample_motion(sample);
        return motion
            .map(Arc::new)
            .ok_or_else(|| MotionFileError("there is no such sample".to_owned()));
    }
    if is_scene_name(named) {
        let why = "a scene cannot play another scene; bake it to a .bvh first";
        return Err(MotionFileError(why.to_owned()));
    }
    let bytes = bytes_of(named).map_err(MotionFileError)?;
    let refused = |error: &dyn fmt::Display| MotionFileError(error.to_string());
    let import = bvh::read(&bytes).map_err(|error| refused(&error))?;
    let motion = import.document.to_motion(PositionPolicy::Replace);
    motion.map(Arc::new).map_err(|error| refused(&error))
}

/// A clip of our own by its name, the authored walk among them.
fn sample_motion(name: &str) -> Option<Motion> {
    if name != AUTHORED_WALK_NAME {
        return posekit::sample::by_name(name);
    }
    let scene = read(AUTHORED_WALK.as_bytes()).ok()?;
    let none = |_: &str| Err(MotionFileError(String::new()));
    Some(Shot::new(&scene, none).ok()?.bake(None))
}

impl SceneReadError {
    /// `NAME:12:5: track[2].joint: the message`, which editors and terminals make a link of.
    pub fn in_file(&self, name: &str) -> String {
        let Some(first) = self.problems.first() else {
            return format!("{name}: {self}");
        };
        let (line, column) = (first.location.line, first.location.column);
        let place = if first.path.is_empty() {
            String::new()
        } else {
            format!("{}: ", first.path)
        };
        let more = match self.problems.len() + self.more - 1 {
            0 => String::new(),
            1 => " (and 1 more problem)".to_owned(),
            more => format!(" (and {more} more problems)"),
        };
        format!("{name}:{line}:{column}: {place}{}{more}", first.message)
    }
}
