//! What the names of files in a scene mean, and how a scene's own problems are told.

use std::fmt;
use std::sync::Arc;

use posekit::keyframe::Animation;
use posekit::motion::{Motion, PositionPolicy};

use super::{
    AUTHORED_WALK, FileMotion, FileRole, SceneProblem, SceneReadError, Shot, is_scene_name, read,
};
use crate::gltf::Wanted;
use crate::report::{Import, ImportReport};
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

/// What a scene means by a name: a clip of our own, the motion of a BVH file, or an animation of a glTF file
/// (`knight.glb#Idle`, the first one without a name), with what its reader noticed. `bytes_of` gives the bytes of a file
/// by its name as the scene has it, without the animation's. The document is what [`Shot::new`] wants to be told;
/// of a glTF file whose [role](super::Scene::role_of) is that of the skeleton no animation is read.
///
/// # Errors
/// [`MotionFileError`] when there is no such sample, the file cannot be had, or it holds no motion.
pub fn import_of(
    named: &str,
    role: FileRole,
    bytes_of: impl Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<Import<FileMotion>, MotionFileError> {
    if let Some(sample) = named.strip_prefix(SAMPLE_PREFIX) {
        let motion = sample_motion(sample);
        let motion = motion.ok_or_else(|| {
            let names = posekit::sample::NAMES.map(|(name, _)| name).join(", ");
            let why =
                format!("there is no such sample; the samples are {names}, {AUTHORED_WALK_NAME}");
            MotionFileError(why)
        })?;
        return Ok(Import {
            document: FileMotion::Frames(Arc::new(motion)),
            report: ImportReport::default(),
        });
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
        let wanted = match (animation, role) {
            (Some(name), _) => Wanted::Named(name),
            (None, FileRole::Motion) => Wanted::First,
            (None, FileRole::Skeleton) => Wanted::Skeleton,
        };
        let import = gltf::read_wanted(&bytes, wanted, beside).map_err(|error| refused(&error))?;
        let gltf = import.document;
        let played = gltf.animations.into_iter().next();
        let tracks = played.map_or_else(|| Animation::new(gltf.skeleton), |played| played.tracks);
        return Ok(Import {
            document: FileMotion::Keys(Arc::new(tracks)),
            report: import.report,
        });
    }
    let import = bvh::read(&bytes).map_err(|error| refused(&error))?;
    let motion = import.document.to_motion(PositionPolicy::Replace);
    let motion = motion.map_err(|error| refused(&error))?;
    Ok(Import {
        document: FileMotion::Frames(Arc::new(motion)),
        report: import.report,
    })
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

/// A clip of our own by its name, [`AUTHORED_WALK_NAME`] among them; `None` where there is no such clip.
pub fn sample_motion(name: &str) -> Option<Motion> {
    if name != AUTHORED_WALK_NAME {
        return posekit::sample::by_name(name);
    }
    let scene = read(AUTHORED_WALK.as_bytes()).ok()?;
    let none = |_: &str| Err::<FileMotion, _>(MotionFileError(String::new()));
    Some(Shot::new(&scene, none).ok()?.bake(None))
}

impl SceneReadError {
    /// All that is wrong, a line each as [`SceneProblem::in_file`] has it; the last one counts those that were not kept.
    pub fn lines_in_file(&self, name: &str) -> Vec<String> {
        let lines = self.problems.iter().map(|problem| problem.in_file(name));
        let more = (self.more > 0).then(|| match self.more {
            1 => format!("{name}: 1 more problem"),
            more => format!("{name}: {more} more problems"),
        });
        lines.chain(more).collect()
    }

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
