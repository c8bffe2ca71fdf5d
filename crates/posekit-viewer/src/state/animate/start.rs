//! How a clip becomes an authored one.

use std::sync::Arc;

use posekit::keyframe::edit::{KeyPoseConfig, KeyedJoints, key_pose};
use posekit::keyframe::{Animation, Extrapolation, Interpolation, ReduceConfig, reduce};
use posekit::motion::Motion;
use posekit::pose::LocalPose;
use posekit_formats::scene::{MotionLayer, SAMPLE_PREFIX, Scene, SkeletonSource};

use super::{Authored, Files};
use crate::state::clip::{Clip, Reading, Source, rest_motion};

/// What an authored clip starts with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// The rest pose as its first key, standing where the figure stands.
    Rest,
    /// The pose shown as its first key.
    Pose,
    /// The clip's motion, over which keys are set.
    OverMotion,
    /// Keys that make the clip's motion again, to within a tolerance.
    Reduced(ReduceConfig),
}

/// The frame rate of a clip that has none.
const FRAMES_PER_SEC: f64 = 30.0;

/// Where nothing says how long it lasts, seconds.
const SECS: f64 = 4.0;

/// An authored clip of a clip, shown at a time. `is_edited` where its motion is not its file's.
///
/// # Errors
/// For people: the motion cannot be reduced, or it is in no file that a scene could name.
pub fn start(
    clip: &Clip,
    start: Start,
    time_secs: f64,
    is_edited: bool,
) -> Result<Authored, String> {
    let motion = &clip.motion;
    let mut files = Files::new();
    let named = file_name(clip);
    let mut scene = Scene::new(skeleton_source(clip, named.as_deref()));
    if let SkeletonSource::File(name) = &scene.skeleton {
        files.insert(name.clone(), Arc::clone(motion).into());
    }
    scene.title = stem(&clip.name).to_owned();
    let rate = clip.fps();
    let duration = motion.duration_secs();
    scene.frames_per_sec = if rate > 0.0 { rate } else { FRAMES_PER_SEC };
    let is_long = rate > 0.0 && duration > 0.0;
    scene.range_secs = [0.0, if is_long { duration } else { SECS }];
    match start {
        Start::Rest => {
            let rest = rest_motion(motion, time_secs, glam::Vec3::ZERO).pose(0);
            scene.set_animation(&first_key(motion, &rest)?, None);
        }
        Start::Pose => {
            let pose = clip.local_pose(time_secs);
            scene.set_animation(&first_key(motion, &pose)?, None);
        }
        Start::OverMotion if is_edited => {
            return Err(
                "the edits of this clip are in no file: save it as BVH first, or reduce it to keys"
                    .to_owned(),
            );
        }
        Start::OverMotion => {
            let file = named.unwrap_or_else(|| clip.name.clone());
            files.insert(file.clone(), Arc::clone(motion).into());
            scene.motions.push(MotionLayer {
                file,
                start_secs: 0.0,
                clip_secs: None,
            });
        }
        Start::Reduced(config) => {
            let reduction = reduce(motion, &config).map_err(|error| error.to_string())?;
            scene.set_animation(&reduction.animation, None);
        }
    }
    let authored = Authored::new(scene, files).map_err(|error| error.to_string())?;
    Ok(authored.with_orders(clip.orders()))
}

/// All of a pose as keys at the start.
fn first_key(motion: &Motion, pose: &LocalPose) -> Result<Animation, String> {
    let skeleton = motion.skeleton();
    let config = KeyPoseConfig {
        time_secs: 0.0,
        what: KeyedJoints::RotationAndPlace,
        interpolation: Interpolation::Cubic,
        beyond: Extrapolation::Hold,
    };
    let mut pose = pose.clone();
    for rotation in &mut pose.rotations {
        if !rotation.is_finite() || rotation.length_squared() < 0.5 {
            *rotation = glam::Quat::IDENTITY;
        }
    }
    let animation = Animation::new(Arc::clone(skeleton));
    key_pose(&animation, skeleton.joints(), &pose, &config).map_err(|error| error.to_string())
}

/// What a scene calls the file of a clip: `None` for one that is in no file it could name.
fn file_name(clip: &Clip) -> Option<String> {
    match &clip.source {
        // A scene has no word for another way of reading a file.
        Source::File(_) if clip.reading != Reading::default() => None,
        // On a page the path is an address, with signs for blanks: the file is called as the clip is.
        Source::File(_) if cfg!(target_arch = "wasm32") => Some(clip.name.clone()),
        Source::File(path) => super::place::absolute(path).to_str().map(str::to_owned),
        Source::Sample(name) => Some(format!("{SAMPLE_PREFIX}{name}")),
        Source::Bytes | Source::Made | Source::Scene(_) => None,
    }
}

/// The file, where there is one that can be read again; otherwise the joints themselves. On a page only
/// clips of our own can be.
fn skeleton_source(clip: &Clip, named: Option<&str>) -> SkeletonSource {
    let is_file = matches!(clip.source, Source::File(_));
    match named {
        Some(name) if !(is_file && cfg!(target_arch = "wasm32")) => {
            SkeletonSource::File(name.to_owned())
        }
        _ => SkeletonSource::inline(clip.skeleton()),
    }
}

/// A clip's name without its extension.
fn stem(name: &str) -> &str {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    if stem.is_empty() { name } else { stem }
}
