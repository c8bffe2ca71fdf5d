//! Scene files, and the motion files that they name.

use std::cell::Cell;
use std::path::Path;

use posekit::motion::Motion;
use posekit::range::LONGEST_LENGTH;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::Bvh;
use posekit_formats::gltf;
use posekit_formats::report::{Import, ImportReport};
use posekit_formats::scene::{self, MotionFileError, Scene, SceneError, Shot, ShotError};

use crate::bytes;
use crate::console;
use crate::failure::{Failure, one_line};
use crate::inputs::STDIN;
use crate::kind;
use crate::output::Guard;
use crate::select::FrameSelection;
use crate::similar;
use crate::text::{counted, grouped};

/// Whether a file of this name is a scene.
pub(crate) fn is_scene(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(scene::is_scene_name)
}

/// A scene of standard input, which `-` stands for; files that it names are sought in the folder at hand.
fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == STDIN
}

/// What messages call a scene.
pub(crate) fn name_of(path: &Path) -> String {
    match is_stdin(path) {
        true => "standard input".to_owned(),
        false => path.display().to_string(),
    }
}

fn bytes_of(path: &Path, guard: &Guard) -> Result<Vec<u8>, Failure> {
    match is_stdin(path) {
        true => bytes::of_stdin(guard),
        false => bytes::of_file(path, guard),
    }
}

/// Reads a scene file, and warns of what in it will not come out as it may have been meant.
pub(crate) fn read(path: &Path, guard: &Guard) -> Result<Scene, Failure> {
    let bytes = bytes_of(path, guard)?;
    let name = name_of(path);
    let (scene, warnings) = scene::read_with_warnings(&bytes).map_err(|error| {
        if let Some(failure) = kind::not_a_scene(&name, &bytes) {
            return failure;
        }
        let mut lines = error.lines_in_file(&name).into_iter();
        Failure::new(lines.next().unwrap_or_default()).and(lines)
    })?;
    for warning in &warnings {
        console::warning(&one_line(&warning.in_file(&name)));
    }
    Ok(scene)
}

/// Makes the files that a scene names known to the guard, and the buffers that those name, before they are read for
/// their work. What is wrong with them is said then.
pub(crate) fn note_files(path: &Path, guard: &Guard) -> Result<(), Failure> {
    let Ok(scene) = scene::read(&bytes::of_file(path, guard).unwrap_or_default()) else {
        return Ok(());
    };
    let files = Beside::new(path, guard);
    for named in scene.files() {
        let _ = scene::import_of(named, scene.role_of(named), |named| files.bytes(named));
    }
    files.refused()
}

/// Puts a scene together with the files that it names, which stand beside it, and says what their readers noticed.
pub(crate) fn shot(path: &Path, scene: &Scene, guard: &Guard) -> Result<Import<Shot>, Failure> {
    let files = Beside::new(path, guard);
    let mut report = ImportReport::default();
    let load = |named: &str| {
        let import = scene::import_of(named, scene.role_of(named), |named| files.bytes(named))?;
        let (file, _) = gltf::file_and_animation(named);
        report.take_in(file, import.report);
        Ok::<_, MotionFileError>(import.document)
    };
    let shot = Shot::new(scene, load);
    files.refused()?;
    let document = shot.map_err(|error| unfit(path, scene, error))?;
    for remark in document.remarks() {
        console::warning(&format!("{}: {remark}", name_of(path)));
    }
    Ok(Import { document, report })
}

/// Why a scene and its files do not go together, with the joint's name that may have been meant.
fn unfit(path: &Path, scene: &Scene, error: ShotError<MotionFileError>) -> Failure {
    let name = name_of(path);
    match error {
        ShotError::Scene(SceneError::NoSuchJoint { joint, joints }) => {
            let unknown = |joint: &str| !joints.iter().any(|known| known == joint);
            let mut missing: Vec<(usize, &str)> = Vec::new();
            for (index, track) in scene.tracks.iter().enumerate() {
                if unknown(&track.joint) {
                    missing.push((index, &track.joint));
                }
            }
            let lines = missing.into_iter().map(|(index, joint)| {
                let meant = similar::nearest(joint, joints.iter().map(String::as_str));
                let meant =
                    meant.map_or_else(String::new, |meant| format!("; did you mean '{meant}'"));
                format!("{name}: track[{index}].joint: the skeleton has no joint '{joint}'{meant}")
            });
            let mut lines = lines.collect::<Vec<_>>().into_iter();
            let first = lines.next();
            let first =
                first.unwrap_or_else(|| format!("{name}: the skeleton has no joint '{joint}'"));
            Failure::new(first).and(lines)
        }
        other => Failure::new(one_line(&other.to_string())).in_file(&name),
    }
}

/// Fails where a joint of a baked scene is so far away that what is computed of it may not be finite: keys are not,
/// but curves between them and cycles beyond them may be. `number_of` makes the scene's frame of the motion's.
pub(crate) fn refuse_too_far(
    motion: &Motion,
    number_of: impl Fn(usize) -> usize,
) -> Result<(), Failure> {
    let Some((place, joint)) = motion.first_out_of_range() else {
        return Ok(());
    };
    let frame = number_of(place);
    let name = motion.skeleton().unique_name(joint);
    let why = format!(
        "the keys put joint '{name}' at frame {frame} farther away than {LONGEST_LENGTH:e}, too far for a motion"
    );
    Err(Failure::new(why).try_next("check its slopes, and what it does beyond its keys"))
}

/// The scene of a file as the document that all commands work on: baked at its own rate.
pub(crate) fn document(path: &Path, guard: &Guard) -> Result<Import<Bvh>, Failure> {
    Ok(part(path, Asked::All, guard)?.0)
}

/// Which frames of a scene are asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Asked<'a> {
    /// All of them.
    All,
    /// Some.
    Frames(&'a FrameSelection),
    /// None: the skeleton.
    Nothing,
}

/// What of a scene was baked.
#[derive(Debug)]
pub(crate) struct Part {
    /// The numbers of the frames.
    pub(crate) numbers: Vec<usize>,
    /// How many frames the whole scene has.
    pub(crate) frame_count: usize,
}

/// As [`document`], with the frames that are asked for and no others.
pub(crate) fn part(
    path: &Path,
    asked: Asked<'_>,
    guard: &Guard,
) -> Result<(Import<Bvh>, Part), Failure> {
    let Import {
        document: shot,
        report,
    } = shot(path, &read(path, guard)?, guard)?;
    let in_file = |failure: Failure| failure.in_file(&path.display().to_string());
    let frame_count = shot.frame_count(None);
    let asked_count = match asked {
        Asked::All => frame_count,
        Asked::Frames(selection) => selection.count(frame_count),
        Asked::Nothing => 0,
    };
    refuse_large(&shot, asked_count).map_err(in_file)?;
    let numbers = match asked {
        Asked::All => (0..frame_count).collect(),
        Asked::Frames(selection) => selection.frames(frame_count).map_err(in_file)?,
        Asked::Nothing => Vec::new(),
    };
    let motion = shot.bake_frames(None, numbers.iter().copied());
    refuse_too_far(&motion, |place| numbers[place]).map_err(in_file)?;
    let document = Bvh::from_motion(&motion, EulerOrder::ZXY);
    let part = Part {
        numbers,
        frame_count,
    };
    Ok((Import { document, report }, part))
}

/// How many joints are posed at once, one for each joint and frame: a person of sixty joints for forty minutes at 120
/// frames a second. Whatever works on them takes about a hundred bytes for each.
const MOST_POSED: usize = 1 << 24;

/// Whether so many frames of a scene can be had at once.
pub(crate) fn fits(shot: &Shot, frame_count: usize) -> bool {
    frame_count.saturating_mul(shot.skeleton().joint_count()) <= MOST_POSED
}

/// Refuses more frames of a scene than can be had at once.
pub(crate) fn refuse_large(shot: &Shot, frame_count: usize) -> Result<(), Failure> {
    if fits(shot, frame_count) {
        return Ok(());
    }
    let what = format!(
        "{} of {} are too many at once: frames times joints may be at most {}",
        counted(frame_count, "frame"),
        counted(shot.skeleton().joint_count(), "joint"),
        grouped(MOST_POSED)
    );
    Err(Failure::new(what).try_next(
        "take a part with --frames, lower frames_per_sec or shorten range_secs in the scene, or turn it into a motion file first with posekit keys bake",
    ))
}

/// The files beside a scene.
struct Beside<'a> {
    folder: &'a Path,
    guard: &'a Guard,
    /// The first that must not be read, since it would be overwritten. A reader may do without a file that is
    /// missing, and must not do without this one.
    refused: Cell<Option<Failure>>,
}

impl<'a> Beside<'a> {
    fn new(scene: &'a Path, guard: &'a Guard) -> Self {
        Self {
            folder: scene.parent().unwrap_or(Path::new("")),
            guard,
            refused: Cell::new(None),
        }
    }

    /// The bytes of a file that the scene, or a file of it, names.
    fn bytes(&self, named: &str) -> Result<Vec<u8>, String> {
        let path = self.folder.join(named);
        bytes::of_file(&path, self.guard).map_err(|failure| {
            // Whoever asked says the name, as the scene has it.
            let text = failure.to_string();
            let of_path = format!("{}: ", path.display());
            let text = text.strip_prefix(&of_path).unwrap_or(&text).to_owned();
            if let failure @ Failure::Usage(_) = failure {
                let first = self.refused.take().unwrap_or(failure);
                self.refused.set(Some(first));
            }
            text
        })
    }

    fn refused(&self) -> Result<(), Failure> {
        self.refused.take().map_or(Ok(()), Err)
    }
}
