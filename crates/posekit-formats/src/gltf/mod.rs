//! glTF 2.0: the skeleton of a rigged model, and its animations.
//!
//! [`read()`] takes the bytes of a `.glb`, or of a `.gltf` whose buffers are in it; [`read_with()`] asks for
//! the buffers that lie in files beside a `.gltf`. Read are the nodes and what moves them: meshes,
//! materials, cameras and the weights of morph targets are left alone, and so is whatever only they need.
//!
//! **Which nodes.** The joints of the first skin, and the nodes that stand between two of them. Where there
//! is no skin, all nodes of the scene that the file names as its first. The joints are in the order in which
//! a walk from parent to child meets them, children as the file lists them.
//!
//! **Space and units.** glTF's own, which are ours: right-handed, Y up, metres, seconds, quaternions x, y, z, w
//! (Khronos, glTF 2.0 specification, 2021, section 3.4). What stands above a root (an `Armature` that is
//! turned, say) is part of the root's transform, at rest and in every key.
//!
//! **Scale.** A [`Skeleton`] has none. The scales of nodes are multiplied into the translations below them,
//! so that every joint is where the file puts it at rest, whatever the scales are. Where a scale is the same
//! along all axes that stays true while the joints turn; where it is not, or is animated, it does not, and
//! the report says so.
//!
//! **Animations** are tracks of the joints' rotations and translations: `STEP`, `LINEAR` (slerp the short way for
//! rotations) and `CUBICSPLINE` as appendix C of the specification defines them, the last with the signs that the
//! file gives its quaternions. Before its first key and after its last a joint stands still. They have no frame rate;
//! [`GltfAnimation::bake`] samples them at any, from the first key of all on.
//!
//! **Accessors** may be sparse, or have no view at all, and numbers may be integers that stand for shares of one.
//!
//! **Extensions** that a file only uses are passed over. One that it requires must be among
//! [`HARMLESS_EXTENSIONS`] or start as one of [`HARMLESS_EXTENSION_PREFIXES`], or the file is refused by its name.
//!
//! **Guarantees.** No bytes make the reader panic, and it takes memory in proportion to their number
//! ([`MAX_KEYS_PER_BYTE`]). What can be read is read and every liberty is a warning, placed by the way to the
//! value in the JSON (`animations[0].channels[2]`).

mod accessor;
mod animation;
mod container;
mod extensions;
mod json_path;
mod nodes;
mod tracks;

use std::sync::Arc;

use gltf::json::{Root, deserialize};
use posekit::keyframe::Animation;
use posekit::skeleton::Skeleton;

use crate::report::{Gathered, Import, Place, ReadError, ReadErrorKind, quote};
pub use animation::{BakeError, MAX_BAKED_JOINTS, file_and_animation};
pub use extensions::{HARMLESS_EXTENSION_PREFIXES, HARMLESS_EXTENSIONS};
use json_path::{Step, path_text};
pub use tracks::MAX_KEYS_PER_BYTE;

/// The skeleton of a file, and how it can move.
#[derive(Clone, Debug)]
pub struct Gltf {
    /// The skeleton; its rest pose is that of the nodes.
    pub skeleton: Arc<Skeleton>,
    /// The animations, in the order of the file, those that do not move the skeleton included.
    pub animations: Vec<GltfAnimation>,
}

impl Gltf {
    /// The animation of this name.
    pub fn animation(&self, name: &str) -> Option<&GltfAnimation> {
        self.animations
            .iter()
            .find(|animation| animation.name == name)
    }
}

/// One animation of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfAnimation {
    /// Its name; `animation N` where the file has none, N counted from 0.
    pub name: String,
    /// The tracks of the joints that it moves.
    pub tracks: Animation,
}

/// Whether a file of this name is glTF: whether it ends in `.glb` or `.gltf`, in any case of letters.
pub fn is_gltf_name(name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    ["glb", "gltf"]
        .iter()
        .any(|known| ending.eq_ignore_ascii_case(known))
}

/// Reads a file that is whole in itself. Buffers in files beside it count as missing.
///
/// # Errors
/// [`ReadError`] when it is not glTF 2.0, requires an extension that is not read, its nodes are not a tree, or there are
/// none.
pub fn read(bytes: &[u8]) -> Result<Import<Gltf>, ReadError> {
    read_with(bytes, |_| None)
}

/// Which animations of a file are read. What is wrong with the others is not told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted<'a> {
    /// All of them.
    All,
    /// None: the skeleton alone.
    Skeleton,
    /// The first one, if there is any.
    First,
    /// The first one of this name.
    Named(&'a str),
}

/// Reads a file. `fetch` gives the bytes of a buffer by its address, relative to the file and decoded, if they
/// can be had; it is asked only for what the animations need.
///
/// # Errors
/// As [`read()`].
pub fn read_with(
    bytes: &[u8],
    fetch: impl FnMut(&str) -> Option<Vec<u8>>,
) -> Result<Import<Gltf>, ReadError> {
    read_wanted(bytes, Wanted::All, fetch)
}

/// As [`read_with()`], some of the animations only.
///
/// # Errors
/// As [`read()`], or [`ReadErrorKind::UnknownName`] when there is no animation of the wanted name.
pub fn read_wanted(
    bytes: &[u8],
    wanted: Wanted<'_>,
    fetch: impl FnMut(&str) -> Option<Vec<u8>>,
) -> Result<Import<Gltf>, ReadError> {
    let container = container::open(bytes)?;
    let mut notes = Notes {
        gathered: Gathered::new(),
    };
    let root: Root = deserialize::from_slice(container.json)
        .map_err(|error| container::not_gltf(&container, &error))?;
    if !root.asset.version.starts_with("2.") {
        let found = quote(root.asset.version.as_bytes());
        let path = [Step::Key("asset"), Step::Key("version")];
        return Err(notes.error(ReadErrorKind::Unexpected, &path, "version 2.0", found));
    }
    extensions::check(&root, &notes)?;
    let rig = nodes::rig(&root, &mut notes)?;
    let buffers = container::Buffers::new(container.binary, fetch);
    let wanted = animation::indices(&root, wanted, &notes)?;
    let animations = tracks::animations(&root, &rig, wanted, buffers, (bytes.len(), &mut notes))?;
    let document = Gltf {
        skeleton: rig.skeleton,
        animations,
    };
    Ok(Import {
        document,
        report: notes.gathered.finish(),
    })
}

/// Where the parts of the reader put what they notice.
struct Notes {
    gathered: Gathered,
}

impl Notes {
    fn warn(
        &mut self,
        code: crate::report::WarningCode,
        path: &[Step<'_>],
        message: impl FnOnce() -> String,
    ) {
        let place = || Place::Json(path_text(path));
        self.gathered.add(code, place, message);
    }

    fn error(
        &self,
        kind: ReadErrorKind,
        path: &[Step<'_>],
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        ReadError {
            kind,
            place: Place::Json(path_text(path)),
            expected: expected.into(),
            found: found.into(),
        }
    }
}
