//! A keyed skeleton: tracks of its joints' rotations and translations, and baking to a motion.

use std::sync::Arc;

use glam::DVec3;

use super::euler::RotationTrack;
use super::track::Track;
use super::value::KeyValue;
use crate::motion::{FrameTime, Motion};
use crate::pose::LocalPose;
use crate::skeleton::{JointId, Skeleton};

/// Tracks of a skeleton's joints. A joint without a track keeps its rest transform.
///
/// Rotations and translations are in the parent's space, translations in the file's unit and in place
/// of the rest translation. Tracks are shared: a changed copy costs a pointer for each joint, so that
/// an undo history can keep every state.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    skeleton: Arc<Skeleton>,
    rotations: Vec<Option<RotationTrack>>,
    translations: Vec<Option<Arc<Track<DVec3>>>>,
}

/// What is baked of an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeConfig {
    /// The time of the first frame, in seconds.
    pub start_secs: f64,
    /// Time between two frames.
    pub frame_time: FrameTime,
    /// How many frames; they may be 0.
    pub frame_count: usize,
}

impl BakeConfig {
    /// The frames of a time range, both ends included where the range is a whole number of frames (to
    /// within a thousandth of a frame).
    ///
    /// A range that ends before it starts has no frames. Without a [frame time](FrameTime::NONE) the start alone
    /// is one.
    pub fn of_range([start_secs, end_secs]: [f64; 2], frame_time: FrameTime) -> Self {
        /// How much of a frame may be missing at the end: times of text are rounded.
        const SLACK: f64 = 1e-3;
        let frames = frame_time.frames_per_sec().map_or(0.0, |rate| {
            // A range without end and one of no times have no number of frames.
            (end_secs - start_secs) * rate
        });
        Self {
            start_secs,
            frame_time,
            frame_count: whole_frames(frames + SLACK),
        }
    }
}

/// One more than a number of frames rounded down; 0 for less than none, and for NaN.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, and more frames than memory are refused by the allocation"
)]
fn whole_frames(frames: f64) -> usize {
    if frames >= 0.0 {
        (frames as usize).saturating_add(1)
    } else {
        0
    }
}

impl Animation {
    /// No tracks: the rest pose.
    pub fn new(skeleton: Arc<Skeleton>) -> Self {
        let joint_count = skeleton.joint_count();
        Self {
            skeleton,
            rotations: vec![None; joint_count],
            translations: vec![None; joint_count],
        }
    }

    /// The skeleton that moves.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// The track of a joint's rotation: quaternions, or Euler curves.
    ///
    /// # Panics
    /// If the joint is out of range.
    pub fn rotation(&self, joint: JointId) -> Option<&RotationTrack> {
        self.rotations[joint.index()].as_ref()
    }

    /// The track of a joint's translation.
    ///
    /// # Panics
    /// If the joint is out of range.
    pub fn translation(&self, joint: JointId) -> Option<&Arc<Track<DVec3>>> {
        self.translations[joint.index()].as_ref()
    }

    /// The same with another track, or none, for a joint's rotation. An End Site does not turn: a track
    /// for one is left out.
    ///
    /// # Panics
    /// If the joint is out of range.
    #[must_use]
    pub fn with_rotation(
        mut self,
        joint: JointId,
        track: Option<impl Into<RotationTrack>>,
    ) -> Self {
        let track = track.filter(|_| !self.skeleton.is_end_site(joint));
        self.rotations[joint.index()] = track.map(Into::into);
        self
    }

    /// The same with another track, or none, for a joint's translation.
    ///
    /// # Panics
    /// If the joint is out of range.
    #[must_use]
    pub fn with_translation(
        mut self,
        joint: JointId,
        track: Option<impl Into<Arc<Track<DVec3>>>>,
    ) -> Self {
        self.translations[joint.index()] = track.map(Into::into);
        self
    }

    /// The joints whose rotation has a track, with it, in topological order.
    pub fn rotations(&self) -> impl Iterator<Item = (JointId, &RotationTrack)> {
        present(&self.rotations)
    }

    /// The joints whose translation has a track, with it, in topological order.
    pub fn translations(&self) -> impl Iterator<Item = (JointId, &Arc<Track<DVec3>>)> {
        present(&self.translations)
    }

    /// How many keys there are.
    pub fn key_count(&self) -> usize {
        let turning: usize = self.rotations().map(|(_, track)| track.key_count()).sum();
        let moving: usize = self
            .translations()
            .map(|(_, track)| track.keys().len())
            .sum();
        turning + moving
    }

    /// The times at which some track of these joints has a key, in rising order without repetition:
    /// the columns of a dope sheet.
    pub fn key_times_secs(&self, joints: impl IntoIterator<Item = JointId>) -> Vec<f64> {
        let mut times = Vec::new();
        for joint in joints {
            times.extend(
                self.rotation(joint)
                    .iter()
                    .flat_map(|track| track.times_secs()),
            );
            times.extend(
                self.translation(joint)
                    .iter()
                    .flat_map(|track| track.times_secs()),
            );
        }
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The times of the first and the last key of all tracks, in seconds; `None` without tracks.
    pub fn range_secs(&self) -> Option<[f64; 2]> {
        let turning = self.rotations().map(|(_, track)| track.range_secs());
        let moving = self.translations().map(|(_, track)| range(track));
        turning
            .chain(moving)
            .reduce(|[start, end], [from, to]| [start.min(from), end.max(to)])
    }

    /// Fills `pose` with the pose at a time in seconds, without allocating when it fits already.
    pub fn sample_into(&self, time_secs: f64, pose: &mut LocalPose) {
        pose.rotations.clear();
        pose.rotations
            .extend_from_slice(self.skeleton.rest_rotations());
        pose.translations.clear();
        pose.translations
            .extend_from_slice(self.skeleton.rest_translations());
        for (joint, track) in self.rotations() {
            pose.rotations[joint.index()] = track.sample(time_secs).as_quat();
        }
        for (joint, track) in self.translations() {
            pose.translations[joint.index()] = track.sample(time_secs).as_vec3();
        }
    }

    /// The pose at a time in seconds.
    pub fn sample(&self, time_secs: f64) -> LocalPose {
        let mut pose = LocalPose::rest(&self.skeleton);
        self.sample_into(time_secs, &mut pose);
        pose
    }

    /// The motion at a uniform rate. Its translated joints are those with a translation track, and the
    /// roots; its frame 0 is at the start of the range.
    pub fn bake(&self, config: &BakeConfig) -> Motion {
        let mut moving: Vec<JointId> = self.skeleton.roots().collect();
        moving.extend(self.translations().map(|(joint, _)| joint));
        let frames = config.frame_count;
        let skeleton = Arc::clone(&self.skeleton);
        let mut motion = Motion::at_rest(skeleton, frames, config.frame_time, moving);
        let time = |frame| config.start_secs + index_to_f64(frame) * config.frame_time.secs();
        for (joint, track) in self.rotations() {
            for frame in 0..frames {
                motion.set_rotation(frame, joint, track.sample(time(frame)).as_quat());
            }
        }
        for (joint, track) in self.translations() {
            for frame in 0..frames {
                motion.set_translation(frame, joint, track.sample(time(frame)).as_vec3());
            }
        }
        motion
    }
}

fn present<T>(tracks: &[Option<T>]) -> impl Iterator<Item = (JointId, &T)> {
    let numbered = tracks.iter().enumerate();
    numbered.filter_map(|(index, track)| Some((JointId::new(index), track.as_ref()?)))
}

fn range<V: KeyValue>(track: &Track<V>) -> [f64; 2] {
    [track.start_secs(), track.end_secs()]
}

/// A frame number as a factor of time. Exact below 2^53.
#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
pub(super) fn index_to_f64(index: usize) -> f64 {
    index as f64
}
