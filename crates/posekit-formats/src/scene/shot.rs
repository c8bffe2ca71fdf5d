//! A scene together with the files that it names: a pose at every time.

use std::sync::Arc;

use posekit::keyframe::{Animation, BakeConfig};
use posekit::motion::{FrameTime, Motion};
use posekit::pose::LocalPose;
use posekit::skeleton::{JointId, Skeleton, SkeletonError};

use super::document::{MotionLayer, Scene, SceneError, SkeletonSource};
use super::file_motion::FileMotion;

/// A part of a file may be said to end so much later than the file does, without a remark.
const OVERHANG_SECS: f64 = 0.1;

/// What can be posed and baked of a scene.
#[derive(Clone, Debug)]
pub struct Shot {
    skeleton: Arc<Skeleton>,
    animation: Animation,
    layers: Vec<Layer>,
    range_secs: [f64; 2],
    frame_time: FrameTime,
    remarks: Vec<String>,
}

/// A motion that plays on the scene's skeleton.
#[derive(Clone, Debug)]
struct Layer {
    start_secs: f64,
    clip_secs: [f64; 2],
    motion: FileMotion,
    /// Pairs of a joint of the motion and the scene's joint of its name.
    joints: Vec<(JointId, JointId)>,
}

/// Why a scene and its files do not make a shot; `E` is what went wrong with a file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShotError<E: std::error::Error + 'static> {
    /// A file could not be had.
    #[error("{path}: {error}")]
    File {
        /// The path as the scene names it.
        path: String,
        /// What went wrong.
        error: E,
    },
    /// The scene does not fit its skeleton.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl Shot {
    /// Puts a scene together. `load` gives what a file that the scene names plays; it is asked once for each.
    ///
    /// # Errors
    /// [`ShotError`] when a file cannot be had, the scene's joints are no skeleton, or a joint that is
    /// keyed does not exist.
    pub fn new<M: Into<FileMotion>, E: std::error::Error + 'static>(
        scene: &Scene,
        mut load: impl FnMut(&str) -> Result<M, E>,
    ) -> Result<Self, ShotError<E>> {
        let mut motions: Vec<(&str, FileMotion)> = Vec::new();
        for path in scene.files() {
            let motion = load(path).map_err(|error| ShotError::File {
                path: path.to_owned(),
                error,
            })?;
            motions.push((path, motion.into()));
        }
        let motion = |path: &str| {
            motions
                .iter()
                .find(|(name, _)| *name == path)
                .map(|(_, m)| m)
        };
        let skeleton = match &scene.skeleton {
            SkeletonSource::File(path) => motion(path).map(|motion| Arc::clone(motion.skeleton())),
            inline @ SkeletonSource::Inline(_) => {
                let built = inline
                    .inline_skeleton()
                    .transpose()
                    .map_err(SceneError::from)?;
                built.map(Arc::new)
            }
        };
        let skeleton = skeleton.ok_or(SceneError::from(SkeletonError::Empty))?;
        let animation = scene.animation(&skeleton)?;
        let mut layers: Vec<Layer> = Vec::new();
        let mut remarks = Vec::new();
        for (index, said) in scene.motions.iter().enumerate() {
            let Some(motion) = motion(&said.file) else {
                continue;
            };
            let layer = Layer::new(said, motion, &skeleton);
            let remark = layer.remark(said, scene.range_secs[1]);
            remarks.extend(remark.map(|text| format!("motion[{index}], {}: {text}", said.file)));
            layers.push(layer);
        }
        layers.sort_by(|a, b| a.start_secs.total_cmp(&b.start_secs));
        Ok(Self {
            skeleton,
            animation,
            layers,
            range_secs: scene.range_secs,
            frame_time: FrameTime::of_rate(scene.frames_per_sec).unwrap_or(FrameTime::NONE),
            remarks,
        })
    }

    /// The skeleton that moves.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// What will not come out as it may have been meant: motions that move nothing, for people, a line each.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// The keyed joints.
    pub fn animation(&self) -> &Animation {
        &self.animation
    }

    /// Fills `pose` with the pose at a time in seconds: the layer that plays, under the keyed joints.
    pub fn sample_into(&self, time_secs: f64, pose: &mut LocalPose) {
        pose.clone_from(&LocalPose::rest(&self.skeleton));
        let playing = self
            .layers
            .iter()
            .rev()
            .find(|layer| layer.start_secs <= time_secs);
        if let Some(layer) = playing.or(self.layers.first()) {
            layer.sample_into(time_secs, pose);
        }
        for (joint, track) in self.animation.rotations() {
            pose.rotations[joint.index()] = track.sample(time_secs).as_quat();
        }
        for (joint, track) in self.animation.translations() {
            pose.translations[joint.index()] = track.sample(time_secs).as_vec3();
        }
    }

    /// The motion of the scene's time range at its own frame time, or at another: its start alone where a scene that was
    /// made by hand has a rate that cannot be.
    ///
    /// Its translated joints are the roots and those that a motion or a key moves.
    ///
    /// It takes memory for each frame and joint: see [`frame_count`](Self::frame_count), and
    /// [`bake_frames`](Self::bake_frames) for a part.
    pub fn bake(&self, frame_time: Option<FrameTime>) -> Motion {
        self.bake_frames(frame_time, 0..self.frame_count(frame_time))
    }

    /// How many frames [`bake`](Self::bake) makes.
    pub fn frame_count(&self, frame_time: Option<FrameTime>) -> usize {
        self.config(frame_time).frame_count
    }

    /// Some of the frames that [`bake`](Self::bake) makes, in the order of their numbers here: the same poses. Frames
    /// past its end go on beyond the scene's range.
    pub fn bake_frames(
        &self,
        frame_time: Option<FrameTime>,
        frames: impl ExactSizeIterator<Item = usize>,
    ) -> Motion {
        let config = self.config(frame_time);
        let mut moving: Vec<JointId> = self.skeleton.roots().collect();
        moving.extend(self.animation.translations().map(|(joint, _)| joint));
        for layer in &self.layers {
            let theirs = layer.joints.iter();
            let theirs = theirs.filter(|(from, _)| layer.motion.translates(*from));
            moving.extend(theirs.map(|&(_, to)| to));
        }
        let skeleton = Arc::clone(&self.skeleton);
        let step = config.frame_time.secs();
        let mut motion = Motion::at_rest(skeleton, frames.len(), config.frame_time, moving);
        let mut pose = LocalPose::rest(&self.skeleton);
        for (place, frame) in frames.enumerate() {
            let count = u32::try_from(frame).unwrap_or(u32::MAX);
            self.sample_into(config.start_secs + f64::from(count) * step, &mut pose);
            motion.set_pose(place, &pose);
        }
        motion
    }

    fn config(&self, frame_time: Option<FrameTime>) -> BakeConfig {
        BakeConfig::of_range(self.range_secs, frame_time.unwrap_or(self.frame_time))
    }
}

impl Layer {
    fn new(layer: &MotionLayer, motion: &FileMotion, skeleton: &Skeleton) -> Self {
        let theirs = motion.skeleton();
        let matched = theirs.joints().filter_map(|joint| {
            let ours = skeleton.find(theirs.unique_name(joint))?;
            Some((joint, ours))
        });
        Self {
            start_secs: layer.start_secs,
            clip_secs: layer.clip_secs.unwrap_or_else(|| motion.range_secs()),
            joints: matched.collect(),
            motion: motion.clone(),
        }
    }

    /// Why nothing is seen of it, or less than was asked for. It was `said` so in a scene that ends at a time.
    fn remark(&self, said: &MotionLayer, scene_end_secs: f64) -> Option<String> {
        if self.joints.is_empty() {
            return Some(
                "no joint of it has the name of a joint of the skeleton: it moves nothing"
                    .to_owned(),
            );
        }
        if self.start_secs > scene_end_secs {
            return Some(format!(
                "it starts at {} s, after the scene's end at {scene_end_secs} s",
                self.start_secs
            ));
        }
        let [_, last] = self.motion.range_secs();
        let [from, to] = said.clip_secs?;
        if from > last {
            return Some(format!(
                "it has nothing from {from} s on, and stands still: it ends at {last:.3} s"
            ));
        }
        // To within a frame: times are written with few decimals.
        (to > last + OVERHANG_SECS)
            .then(|| format!("it ends at {last:.3} s, and its last pose stays until {to} s"))
    }

    fn sample_into(&self, time_secs: f64, pose: &mut LocalPose) {
        let [from, to] = self.clip_secs;
        let theirs = self
            .motion
            .sample((from + (time_secs - self.start_secs).max(0.0)).min(to));
        for &(from, to) in &self.joints {
            pose.rotations[to.index()] = theirs.rotations[from.index()];
            pose.translations[to.index()] = theirs.translations[from.index()];
        }
    }
}
