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
//! **Animations** are tracks of the joints' rotations and translations: `STEP`, `LINEAR` (slerp for
//! rotations) and `CUBICSPLINE` as appendix C of the specification defines them, but that a rotation always
//! takes the short way from key to key. Before its first key and after its last a joint stands still. They
//! have no frame rate; [`GltfAnimation::bake`] samples them at any.
//!
//! **Guarantees.** No bytes make the reader panic, and it takes memory in proportion to their number
//! ([`MAX_KEYS_PER_BYTE`]). What can be read is read and every liberty is a warning, placed by line and
//! column of the JSON, which in a `.glb` counts from the start of its first chunk.

mod accessor;
mod animation;
mod container;
mod json_place;
mod nodes;
mod tracks;

use std::sync::Arc;

use gltf::json::{Root, deserialize};
use posekit::keyframe::Animation;
use posekit::skeleton::Skeleton;

use crate::report::{Import, ReadError, ReadErrorKind, Reporter, quote};
pub use animation::{BakeError, MAX_BAKED_JOINTS, file_and_animation};
use json_place::{Step, place_of};
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
/// [`ReadError`] when it is no glTF 2.0, its nodes make no tree, or there are none.
pub fn read(bytes: &[u8]) -> Result<Import<Gltf>, ReadError> {
    read_with(bytes, |_| None)
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
    let container = container::open(bytes)?;
    let mut notes = Notes {
        json: container.json,
        reporter: Reporter::new(container.json),
    };
    let root: Root = deserialize::from_slice(container.json)
        .map_err(|error| container::not_gltf(container.json, &error))?;
    if !root.asset.version.starts_with("2.") {
        let found = quote(root.asset.version.as_bytes());
        let path = [Step::Key("asset"), Step::Key("version")];
        return Err(notes.error(ReadErrorKind::Unexpected, &path, "version 2.0", found));
    }
    let rig = nodes::rig(&root, &mut notes)?;
    let buffers = container::Buffers::new(container.binary, fetch);
    let animations = tracks::animations(&root, &rig, buffers, (bytes.len(), &mut notes))?;
    let document = Gltf {
        skeleton: rig.skeleton,
        animations,
    };
    Ok(Import {
        document,
        report: notes.reporter.finish(),
    })
}

/// Where the parts of the reader put what they notice.
struct Notes<'a> {
    json: &'a [u8],
    reporter: Reporter<'a>,
}

impl Notes<'_> {
    fn warn(
        &mut self,
        code: crate::report::WarningCode,
        path: &[Step<'_>],
        message: impl FnOnce() -> String,
    ) {
        let json = self.json;
        self.reporter
            .warn_where(code, || place_of(json, path), message);
    }

    fn error(
        &mut self,
        kind: ReadErrorKind,
        path: &[Step<'_>],
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        let at = place_of(self.json, path);
        self.reporter.error(kind, at, expected, found)
    }
}
