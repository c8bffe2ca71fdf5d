//! What the names of files in a scene mean, and how a scene's own problems are told.

use std::fmt;
use std::sync::Arc;

use posekit::motion::{Motion, PositionPolicy};

use super::{AUTHORED_WALK, SceneProblem, SceneReadError, Shot, is_scene_name, read};
use crate::{bvh, gltf};

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

/// The motion that a scene means by a name: a clip of our own, that of a BVH file, or an animation of a
/// glTF file (`knight.glb#Idle`, the first one without a name). `bytes_of` gives the bytes of a file by its
/// name as the scene has it, without the animation's. It is what [`Shot::new`] wants to be told.
///
/// # Errors
/// [`MotionFileError`] when there is no such sample, the file cannot be had, or it holds no motion.
pub fn motion_of(
    named: &str,
    bytes_of: impl Fn(&str) -> Result<Vec<u8>, String>,
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
    let (file, animation) = gltf::file_and_animation(named);
    let bytes = bytes_of(file).map_err(MotionFileError)?;
    let refused = |error: &dyn fmt::Display| MotionFileError(error.to_string());
    if gltf::is_gltf_name(file) {
        let beside = |name: &str| bytes_of(&name_beside(file, name)?).ok();
        let import = gltf::read_with(&bytes, beside).map_err(|error| refused(&error))?;
        let motion = import.document.motion(animation);
        return motion.map(Arc::new).map_err(|error| refused(&error));
    }
    let import = bvh::read(&bytes).map_err(|error| refused(&error))?;
    let motion = import.document.to_motion(PositionPolicy::Replace);
    motion.map(Arc::new).map_err(|error| refused(&error))
}

/// The name of a buffer that a glTF file names, as the scene would have it; `None` unless it lies beside
/// that file or in a folder below.
fn name_beside(file: &str, buffer: &str) -> Option<String> {
    let is_below = |part: &str| !matches!(part, "" | "..") && !part.contains(['\\', ':']);
    if !buffer.split('/').all(is_below) {
        return None;
    }
    let folder = file.rfind(['/', '\\']).map_or("", |end| &file[..=end]);
    Some(format!("{folder}{buffer}"))
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
        let more = match self.problems.len() + self.more - 1 {
            0 => String::new(),
            1 => " (and 1 more problem)".to_owned(),
            more => format!(" (and {more} more problems)"),
        };
        format!("{}{more}", first.in_file(name))
    }
}

impl SceneProblem {
    /// `NAME:12:5: track[2].joint: the message`, which editors and terminals make a link of.
    pub fn in_file(&self, name: &str) -> String {
        let (line, column) = (self.location.line, self.location.column);
        let place = if self.path.is_empty() {
            String::new()
        } else {
            format!("{}: ", self.path)
        };
        format!("{name}:{line}:{column}: {place}{}", self.message)
    }
}

#[cfg(test)]
mod tests {
    use super::name_beside;

    #[test]
    fn buffers_are_fetched_from_beside_their_file_and_from_nowhere_else() {
        let is = |file, buffer, wanted: Option<&str>| {
            assert_eq!(name_beside(file, buffer).as_deref(), wanted, "{buffer}");
        };
        is("rig.gltf", "rig.bin", Some("rig.bin"));
        is("a/rig.gltf", "data/rig.bin", Some("a/data/rig.bin"));
        is("C:\\a\\rig.gltf", "rig.bin", Some("C:\\a\\rig.bin"));
        for outside in [
            "../rig.bin",
            "/etc/passwd",
            "a/../../b",
            "c:/b",
            "..\\b",
            "",
        ] {
            is("a/rig.gltf", outside, None);
        }
    }
}
