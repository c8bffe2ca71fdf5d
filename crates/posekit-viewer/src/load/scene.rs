//! Scenes: their text, and the files that it names, as a clip with its keys.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{self, Extent, ReadOptions};
use posekit_formats::gltf::file_and_animation;
use posekit_formats::report::ImportReport;
use posekit_formats::scene::{self, SAMPLE_PREFIX, SkeletonSource, import_of};

use crate::state::animate::{Authored, Files, place};
use crate::state::clip::{Clip, Source};

/// Hierarchies are no longer.
const HEAD_BYTES: usize = 1 << 20;

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
    let (authored, report) = authored_of(name, scene, bytes_of)?;
    let authored = authored.in_file(path.clone());
    let mut clip = Clip::from_motion(name, authored.bake());
    clip.source = Source::Scene(path);
    clip.report = report;
    Ok((clip, authored))
}

/// A scene and its files, which are told by where they are, and what the readers of the files noticed.
///
/// # Errors
/// What is wrong, for people.
pub fn authored_of(
    name: &str,
    scene: posekit_formats::scene::Scene,
    bytes_of: impl Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<(Authored, ImportReport), String> {
    let mut files = Files::new();
    let mut report = ImportReport::default();
    for named in scene.files() {
        let import = import_of(named, scene.role_of(named), |file| bytes_of(file))
            .map_err(|error| format!("{name}: {named}: {error}"))?;
        files.insert(named.to_owned(), import.document);
        let (file, _) = file_and_animation(named);
        // Files of an open scene go by their whole path.
        let shown = file.rsplit(['/', '\\']).next().unwrap_or(file);
        report.take_in(shown, import.report);
    }
    let orders = match &scene.skeleton {
        SkeletonSource::File(file) if file.starts_with(SAMPLE_PREFIX) => BTreeMap::new(),
        SkeletonSource::File(file) => bytes_of(file).map_or_else(|_| BTreeMap::new(), orders_in),
        SkeletonSource::Inline(_) => BTreeMap::new(),
    };
    let authored = Authored::new(scene, files).map_err(|error| format!("{name}: {error}"))?;
    Ok((authored.with_orders(orders), report))
}

/// The order in which a BVH file tells the angles of each joint; none for other files.
fn orders_in(bytes: Vec<u8>) -> BTreeMap<String, EulerOrder> {
    let options = ReadOptions {
        extent: Extent::Beginning,
        ..ReadOptions::default()
    };
    let head = &bytes[..bytes.len().min(HEAD_BYTES)];
    let import = bvh::read_with(head, options, |_| ControlFlow::Continue(()));
    let Ok(clip) = import.map(|import| Clip::from_bvh("", Source::Bytes, import)) else {
        return BTreeMap::new();
    };
    clip.map_or_else(|_| BTreeMap::new(), |clip| clip.orders())
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
