//! Scene files, and the motion files that they name.

use std::fs;
use std::path::Path;

use posekit::motion::Motion;
use posekit::range::LONGEST_LENGTH;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::Bvh;
use posekit_formats::gltf;
use posekit_formats::report::{Import, ImportReport};
use posekit_formats::scene::{self, MotionFileError, Scene, Shot};

use crate::console;
use crate::failure::{Failure, one_line};

/// Whether a file of this name is a scene.
pub(crate) fn is_scene(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(scene::is_scene_name)
}

/// Reads a scene file, and warns of what in it will not come out as it may have been meant.
pub(crate) fn read(path: &Path) -> Result<Scene, Failure> {
    let bytes = fs::read(path).map_err(|error| Failure::cannot_read(path, &error))?;
    let name = path.display().to_string();
    let (scene, warnings) = scene::read_with_warnings(&bytes)
        .map_err(|error| Failure::new(one_line(&error.in_file(&name))))?;
    for warning in &warnings {
        console::warning(&one_line(&warning.in_file(&name)));
    }
    Ok(scene)
}

/// Puts a scene together with the files that it names, which stand beside it, and says what their readers noticed.
pub(crate) fn shot(path: &Path, scene: &Scene) -> Result<Import<Shot>, Failure> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut report = ImportReport::default();
    let load = |named: &str| {
        let import = scene::import_of(named, scene.role_of(named), |named| {
            let path = folder.join(named);
            fs::read(&path).map_err(|error| Failure::cannot_read(&path, &error).to_string())
        })?;
        let (file, _) = gltf::file_and_animation(named);
        report.take_in(file, import.report);
        Ok::<_, MotionFileError>(import.document)
    };
    let document = Shot::new(scene, load).map_err(|error| {
        Failure::new(one_line(&error.to_string())).in_file(&path.display().to_string())
    })?;
    Ok(Import { document, report })
}

/// Fails where a joint of a baked scene is so far away that what is computed of it may not be finite: keys are not,
/// but curves between them and cycles beyond them may be.
pub(crate) fn refuse_too_far(motion: &Motion) -> Result<(), Failure> {
    let Some((frame, joint)) = motion.first_out_of_range() else {
        return Ok(());
    };
    let name = motion.skeleton().unique_name(joint);
    let why = format!(
        "the keys put joint '{name}' at frame {frame} farther away than {LONGEST_LENGTH:e}, of which no motion can be made"
    );
    Err(Failure::new(why).try_next("look at its slopes, and at what it does beyond its keys"))
}

/// The scene of a file as the document that all commands work on: baked at its own rate.
pub(crate) fn document(path: &Path) -> Result<Import<Bvh>, Failure> {
    let Import { document, report } = shot(path, &read(path)?)?;
    let motion = document.bake(None);
    refuse_too_far(&motion).map_err(|failure| failure.in_file(&path.display().to_string()))?;
    let document = Bvh::from_motion(&motion, EulerOrder::ZXY);
    Ok(Import { document, report })
}
