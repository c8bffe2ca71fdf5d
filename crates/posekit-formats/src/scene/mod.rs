//! Scenes: authored motion in a text file, `NAME.posekit.toml`.
//!
//! A scene says which skeleton moves, which motions play on it and when, which joints are keyed how,
//! and what cameras, lights and objects there are. [`read()`] and [`write()`] turn bytes into a [`Scene`]
//! and back; [`Shot`] puts a scene and the files that it names together, so that there is a pose, a
//! camera and a light at every time. `docs/keyframes.md` describes the file field by field.
//!
//! **Space and units.** Seconds; the skeleton's length unit; quaternions x, y, z, w in the parent's
//! space; degrees where a name ends in `_deg` or a track names an Euler order.
//!
//! **Guarantees.**
//! - What is written reads back as the same scene, to the bit, and writes as the same bytes. A rotation
//!   that was given as Euler angles keeps them, as long as the key is not changed.
//! - One key is one line, and nothing depends on when or where the file is written, so that a version
//!   control system shows what was changed.
//! - A file of a newer [`VERSION`] is refused by its number before anything else in it is looked at; files
//!   of older ones are read.
//! - Rotation keys that are Euler angles are **Euler curves**, in files of every version, unless the track
//!   says `mode = "quaternion"`: somebody who writes 0 and then 360 means a turn. (In version 1 a slope set by
//!   hand was one of four numbers, which quaternions alone have: such a track stays one of quaternions.)
//! - All problems of a file are found at once, each with line, column and path. A name that the format
//!   does not have is a problem: it is more likely a typing error than a wish.
//!
//! The file is TOML 1.0 and memory is in proportion to its length.

mod document;
mod file_motion;
mod files;
pub(crate) mod read;
mod shot;
mod write;

pub use document::{
    Camera, EulerNotation, FileRole, InlineJoint, JointTrack, JointValues, Light, MotionLayer,
    Prop, Scene, SceneError, SceneWriteError, SkeletonSource, check,
};
pub use file_motion::FileMotion;
pub use files::{AUTHORED_WALK_NAME, MotionFileError, SAMPLE_PREFIX, import_of, sample_motion};
pub use read::{SceneProblem, SceneProblemKind, SceneReadError, read, read_with_warnings};
pub use shot::{Shot, ShotError};
pub(crate) use write::quoted;
pub use write::{WriteError, write, write_with_tracks};

/// What the file says of itself in `format`.
pub const FORMAT: &str = "posekit scene";

/// The version of the format that is written, and the newest that is read.
///
/// 2 has Euler curves, `mode`, and handles that are free in time.
pub const VERSION: u32 = 2;

/// How a scene's file name ends.
pub const EXTENSION: &str = "posekit.toml";

/// A walk of a person of 25 joints in metres, authored in this format: eight poses a cycle, a few more keys
/// for the legs, and a camera beside. The text of its file.
pub const AUTHORED_WALK: &str = include_str!("walk.posekit.toml");

/// Whether a file of this name is a scene: whether it ends in `.posekit.toml`, in any case of letters.
pub fn is_scene_name(name: &str) -> bool {
    let ending = format!(".{EXTENSION}");
    let bytes = name.as_bytes();
    bytes.len() >= ending.len()
        && bytes[bytes.len() - ending.len()..].eq_ignore_ascii_case(ending.as_bytes())
}
