//! Scene files, and the motion files that they name.

use std::fmt;
use std::fs;
use std::path::{Component, Path};
use std::sync::Arc;

use posekit::motion::{Motion, PositionPolicy};
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{self, Bvh};
use posekit_formats::gltf;
use posekit_formats::scene::{self, Scene, Shot};

use crate::failure::{Failure, one_line};
use crate::sample::Sample;

/// What a clip of our own starts with in a scene.
const SAMPLE_PREFIX: &str = "sample:";

/// Whether a file of this name is a scene.
pub(crate) fn is_scene(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(scene::is_scene_name)
}

/// Reads a scene file.
pub(crate) fn read(path: &Path) -> Result<Scene, Failure> {
    let bytes = fs::read(path).map_err(|error| Failure::cannot_read(path, &error))?;
    scene::read(&bytes).map_err(|error| {
        let name = path.display();
        let Some(first) = error.problems.first() else {
            return Failure::new(format!("{name}: {error}"));
        };
        let (line, column) = (first.location.line, first.location.column);
        let place = if first.path.is_empty() {
            String::new()
        } else {
            format!("{}: ", first.path)
        };
        let more = match error.problems.len() + error.more - 1 {
            0 => String::new(),
            1 => " (and 1 more problem)".to_owned(),
            more => format!(" (and {more} more problems)"),
        };
        let text = format!("{name}:{line}:{column}: {place}{}{more}", first.message);
        Failure::new(one_line(&text))
    })
}

/// Puts a scene together with the files that it names, which stand beside it.
pub(crate) fn shot(path: &Path, scene: &Scene) -> Result<Shot, Failure> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let load = |named: &str| motion(folder, named).map_err(Told);
    Shot::new(scene, load).map_err(|error| {
        Failure::new(one_line(&error.to_string())).in_file(&path.display().to_string())
    })
}

/// The scene of a file as the document that all commands work on: baked at its own rate.
pub(crate) fn document(path: &Path) -> Result<Bvh, Failure> {
    let shot = shot(path, &read(path)?)?;
    Ok(Bvh::from_motion(&shot.bake(None), EulerOrder::ZXY))
}

/// A scene of our own, which names no files, baked at its own rate.
pub(crate) fn bake_text(text: &str) -> Result<Motion, Failure> {
    let could_not = |error: &dyn fmt::Display| Failure::new(one_line(&error.to_string()));
    let scene = scene::read(text.as_bytes()).map_err(|error| could_not(&error))?;
    let none = |path: &str| Err(Told(format!("{path} is not there")));
    let shot = Shot::new(&scene, none).map_err(|error| could_not(&error))?;
    Ok(shot.bake(None))
}

fn motion(folder: &Path, named: &str) -> Result<Arc<Motion>, String> {
    if let Some(sample) = named.strip_prefix(SAMPLE_PREFIX) {
        let sample = Sample::named(sample).ok_or("there is no such sample")?;
        return sample
            .motion()
            .map(Arc::new)
            .map_err(|error| error.to_string());
    }
    let (file, animation) = gltf::file_and_animation(named);
    let path = folder.join(file);
    if gltf::is_gltf_name(file) {
        return gltf_motion(&path, animation).map(Arc::new);
    }
    if is_scene(&path) {
        return Err("a scene cannot play another scene; bake it to a .bvh first".to_owned());
    }
    let bytes = fs::read(&path).map_err(|error| Failure::cannot_read(&path, &error).to_string())?;
    let import = bvh::read(&bytes).map_err(|error| error.to_string())?;
    let motion = import.document.to_motion(PositionPolicy::Replace);
    motion.map(Arc::new).map_err(|error| error.to_string())
}

/// An animation of a glTF file. Buffers that it names lie beside it, in its folder or one below.
fn gltf_motion(path: &Path, animation: Option<&str>) -> Result<Motion, String> {
    let bytes = fs::read(path).map_err(|error| Failure::cannot_read(path, &error).to_string())?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let fetch = |name: &str| {
        let is_below = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        let is_beside = Path::new(name).components().all(is_below);
        is_beside.then(|| fs::read(folder.join(name)).ok())?
    };
    let import = gltf::read_with(&bytes, fetch).map_err(|error| error.to_string())?;
    let motion = import.document.motion(animation);
    motion.map_err(|error| error.to_string())
}

/// A message as the error that the library carries.
#[derive(Debug)]
struct Told(String);

impl fmt::Display for Told {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Told {}
