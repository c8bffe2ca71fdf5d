//! Motion: a skeleton's poses over time, and forward kinematics of all frames at once.
//!
//! A [`Motion`] is frames x joints of local rotations, and translations for those joints that have
//! them, at a uniform frame time. Joints without a track of their own keep their rest transform.
//!
//! Layout: frames lie in blocks of eight, one block after the other; in a block each animated joint
//! has its eight rotations as `xxxxxxxx yyyyyyyy zzzzzzzz wwwwwwww`. Forward kinematics then does
//! one joint of eight frames with each instruction, and a block of a hundred joints stays in the
//! first cache.

mod channel;
mod channel_layout;
mod channel_rows;
mod frame_time;
mod global;
#[cfg(test)]
mod same_bits;
mod scaled;
mod turned;

use std::fmt;
use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::lanes::{LANES, QuatLanes, Vec3Lanes};
use crate::pose::LocalPose;
use crate::range::are_lengths;
use crate::rotation::slerp_f32;
use crate::skeleton::{JointId, Skeleton};

pub use channel::Channel;
pub use channel_layout::{ChannelLayout, PositionPolicies, PositionPolicy};
pub use channel_rows::ChannelValueError;
pub use frame_time::{FrameTime, FrameTimeError};
pub use global::GlobalMotion;

/// Marks a joint that has no track of a kind.
const NO_TRACK: u32 = u32::MAX;

/// Time-varying data of a skeleton: frames x joints of local transforms, at a uniform frame time.
#[derive(Clone)]
pub struct Motion {
    skeleton: Arc<Skeleton>,
    frame_count: usize,
    frame_time: FrameTime,
    rotated: Tracks,
    translated: Tracks,
    /// Block after block, the rotations of the rotated joints.
    rotations: Vec<QuatLanes>,
    /// Block after block, the translations of the translated joints.
    translations: Vec<Vec3Lanes>,
}

/// Which joints have a track of one kind, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Tracks {
    joints: Vec<JointId>,
    slot_of_joint: Vec<u32>,
}

impl Tracks {
    fn new(joint_count: usize, joints: impl IntoIterator<Item = JointId>) -> Self {
        let mut joints: Vec<JointId> = joints.into_iter().collect();
        joints.sort_unstable();
        joints.dedup();
        let mut slot_of_joint = vec![NO_TRACK; joint_count];
        for (slot, joint) in (0..).zip(&joints) {
            slot_of_joint[joint.index()] = slot;
        }
        Self {
            joints,
            slot_of_joint,
        }
    }

    fn len(&self) -> usize {
        self.joints.len()
    }

    fn slot(&self, joint: JointId) -> Option<usize> {
        let slot = self.slot_of_joint[joint.index()];
        (slot != NO_TRACK).then_some(slot as usize)
    }
}

/// How large it is, not its millions of numbers.
impl fmt::Debug for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Motion")
            .field("joints", &self.skeleton.joint_count())
            .field("frames", &self.frame_count)
            .field("frame_time_secs", &self.frame_time.secs())
            .field("rotated", &self.rotated.len())
            .field("translated", &self.translated.len())
            .finish_non_exhaustive()
    }
}

impl Motion {
    /// A motion in which every frame is the rest pose. Every joint but the End Sites can turn; the
    /// joints of `translated` can move in their parent's space too.
    ///
    /// A motion of a single frame keeps its frame time for the file it may be written to.
    ///
    /// # Panics
    /// If a joint is not one of the skeleton's.
    pub fn at_rest(
        skeleton: Arc<Skeleton>,
        frame_count: usize,
        frame_time: FrameTime,
        translated: impl IntoIterator<Item = JointId>,
    ) -> Self {
        let joint_count = skeleton.joint_count();
        let moving = skeleton
            .joints()
            .filter(|&joint| !skeleton.is_end_site(joint));
        let rotated = Tracks::new(joint_count, moving);
        let translated = Tracks::new(joint_count, translated);
        let rest_rotations = rotated.joints.iter();
        let rest_rotations: Vec<QuatLanes> = rest_rotations
            .map(|&joint| QuatLanes::splat(skeleton.rest_rotation(joint)))
            .collect();
        let rest_translations = translated.joints.iter();
        let rest_translations: Vec<Vec3Lanes> = rest_translations
            .map(|&joint| Vec3Lanes::splat(skeleton.rest_translation(joint)))
            .collect();
        let block_count = frame_count.div_ceil(LANES);
        Self {
            rotations: rest_rotations.repeat(block_count),
            translations: rest_translations.repeat(block_count),
            skeleton,
            frame_count,
            frame_time,
            rotated,
            translated,
        }
    }

    /// A motion of given poses, in order.
    ///
    /// # Panics
    /// As [`at_rest`](Self::at_rest), and if a pose has not as many joints as the skeleton.
    pub fn from_poses(
        skeleton: Arc<Skeleton>,
        frame_time: FrameTime,
        translated: impl IntoIterator<Item = JointId>,
        poses: &[LocalPose],
    ) -> Self {
        let mut motion = Self::at_rest(skeleton, poses.len(), frame_time, translated);
        for (frame, pose) in poses.iter().enumerate() {
            motion.set_pose(frame, pose);
        }
        motion
    }

    /// The skeleton that moves.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// Number of frames; it may be 0.
    pub fn frame_count(&self) -> usize {
        self.frame_count
    }

    /// Time between two frames.
    pub fn frame_time(&self) -> FrameTime {
        self.frame_time
    }

    /// Time between two frames, in seconds; 0 when all frames are at one time.
    pub fn frame_time_secs(&self) -> f64 {
        self.frame_time.secs()
    }

    /// The time of the last frame, in seconds; the first is at 0.
    pub fn duration_secs(&self) -> f64 {
        index_to_f64(self.frame_count.saturating_sub(1)) * self.frame_time_secs()
    }

    /// The joints whose translation is animated, in topological order.
    pub fn translated_joints(&self) -> &[JointId] {
        &self.translated.joints
    }

    /// The joints whose rotation is animated, in topological order.
    pub fn rotated_joints(&self) -> &[JointId] {
        &self.rotated.joints
    }

    /// A joint's local rotation at a frame.
    ///
    /// # Panics
    /// If the frame or the joint is out of range.
    pub fn rotation(&self, frame: usize, joint: JointId) -> Quat {
        self.check_frame(frame);
        match self.rotated.slot(joint) {
            Some(slot) => self.rotation_block(frame / LANES)[slot].lane(frame % LANES),
            None => self.skeleton.rest_rotation(joint),
        }
    }

    /// A joint's local translation at a frame, in the file's unit.
    ///
    /// # Panics
    /// If the frame or the joint is out of range.
    pub fn translation(&self, frame: usize, joint: JointId) -> Vec3 {
        self.check_frame(frame);
        match self.translated.slot(joint) {
            Some(slot) => self.translation_block(frame / LANES)[slot].lane(frame % LANES),
            None => self.skeleton.rest_translation(joint),
        }
    }

    /// Sets a joint's local rotation at a frame.
    ///
    /// # Panics
    /// If the frame or the joint is out of range, or the joint is an End Site.
    pub fn set_rotation(&mut self, frame: usize, joint: JointId, rotation: Quat) {
        self.check_frame(frame);
        let slot = self.rotated.slot(joint).expect("an End Site does not turn");
        let at = frame / LANES * self.rotated.len() + slot;
        self.rotations[at].set_lane(frame % LANES, rotation);
    }

    /// Sets a joint's local translation at a frame.
    ///
    /// # Panics
    /// If the frame is out of range or the joint is not a translated one.
    pub fn set_translation(&mut self, frame: usize, joint: JointId, translation: Vec3) {
        self.check_frame(frame);
        let slot = self
            .translated
            .slot(joint)
            .expect("the joint has a translation track");
        let at = frame / LANES * self.translated.len() + slot;
        self.translations[at].set_lane(frame % LANES, translation);
    }

    /// Sets all of a frame from a pose. What the pose says of a joint without a track is not kept.
    ///
    /// # Panics
    /// If the frame is out of range or the pose has not as many joints as the skeleton.
    pub fn set_pose(&mut self, frame: usize, pose: &LocalPose) {
        self.check_frame(frame);
        assert_eq!(
            pose.joint_count(),
            self.skeleton.joint_count(),
            "a pose of this skeleton"
        );
        let (block, lane) = (frame / LANES, frame % LANES);
        let rotations = &mut self.rotations[block * self.rotated.len()..];
        for (joint, lanes) in self.rotated.joints.iter().zip(rotations) {
            lanes.set_lane(lane, pose.rotations[joint.index()]);
        }
        let translations = &mut self.translations[block * self.translated.len()..];
        for (joint, lanes) in self.translated.joints.iter().zip(translations) {
            lanes.set_lane(lane, pose.translations[joint.index()]);
        }
    }

    /// The first frame at which a joint's translation is not within
    /// [`LONGEST_LENGTH`](crate::range::LONGEST_LENGTH), and the joint: there what is computed of the motion may not
    /// be finite. Rows of channels and keys are held against that when they are read; what lies between keys and
    /// beyond them may be farther away.
    pub fn first_out_of_range(&self) -> Option<(usize, JointId)> {
        let translated = self.translated.len();
        if translated == 0 {
            return None;
        }
        let is_in_range = |lanes: &Vec3Lanes| {
            let parts = [lanes.x, lanes.y, lanes.z];
            let parts = parts.iter().flat_map(|part| part.0);
            are_lengths(parts.map(f64::from))
        };
        let at = self.translations.iter().position(|it| !is_in_range(it))?;
        let first = at / translated * LANES;
        (first..self.frame_count.min(first + LANES)).find_map(|frame| {
            let joints = self.translated.joints.iter();
            let is_beyond = |joint: &JointId| {
                !are_lengths(self.translation(frame, *joint).to_array().map(f64::from))
            };
            Some((frame, joints.copied().find(is_beyond)?))
        })
    }

    /// The pose at a frame.
    ///
    /// # Panics
    /// If the frame is out of range.
    pub fn pose(&self, frame: usize) -> LocalPose {
        let mut pose = LocalPose::rest(&self.skeleton);
        self.pose_into(frame, &mut pose);
        pose
    }

    /// Fills `pose` with the pose at a frame, without allocating when it fits already.
    ///
    /// # Panics
    /// If the frame is out of range.
    pub fn pose_into(&self, frame: usize, pose: &mut LocalPose) {
        self.check_frame(frame);
        self.reset_to_rest(pose);
        let (block, lane) = (frame / LANES, frame % LANES);
        for (joint, lanes) in self.rotated.joints.iter().zip(self.rotation_block(block)) {
            pose.rotations[joint.index()] = lanes.lane(lane);
        }
        for (joint, lanes) in self
            .translated
            .joints
            .iter()
            .zip(self.translation_block(block))
        {
            pose.translations[joint.index()] = lanes.lane(lane);
        }
    }

    /// Fills `pose` with the pose at a time: between two frames, rotations by slerp the short way
    /// and translations linearly. Before the first frame and after the last one that frame holds;
    /// a motion without frames gives the rest pose.
    pub fn sample_into(&self, time_secs: f64, pose: &mut LocalPose) {
        let Some(last) = self.frame_count.checked_sub(1) else {
            self.reset_to_rest(pose);
            return;
        };
        let (frame, t) = self.frame_at(time_secs);
        self.pose_into(frame, pose);
        if t <= 0.0 || frame == last {
            return;
        }
        let (block, lane) = ((frame + 1) / LANES, (frame + 1) % LANES);
        for (joint, lanes) in self.rotated.joints.iter().zip(self.rotation_block(block)) {
            let rotation = &mut pose.rotations[joint.index()];
            *rotation = slerp_f32(*rotation, lanes.lane(lane), t);
        }
        for (joint, lanes) in self
            .translated
            .joints
            .iter()
            .zip(self.translation_block(block))
        {
            let translation = &mut pose.translations[joint.index()];
            *translation = translation.lerp(lanes.lane(lane), t);
        }
    }

    /// The pose at a time; see [`sample_into`](Self::sample_into).
    pub fn sample(&self, time_secs: f64) -> LocalPose {
        let mut pose = LocalPose::rest(&self.skeleton);
        self.sample_into(time_secs, &mut pose);
        pose
    }

    /// Forward kinematics of every frame.
    ///
    /// Cost: about a nanosecond a joint-frame on one core; see `docs/performance.md`.
    pub fn to_global(&self) -> GlobalMotion {
        GlobalMotion::of(self)
    }

    /// The frame at or before a time and how far it is to the next one, 0 to 1. The motion has a
    /// frame.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the frames; a fraction fits f32"
    )]
    fn frame_at(&self, time_secs: f64) -> (usize, f32) {
        let last = self.frame_count - 1;
        if self.frame_time.is_none() || time_secs.is_nan() {
            return (0, 0.0);
        }
        let place = (time_secs / self.frame_time_secs()).clamp(0.0, index_to_f64(last));
        let frame = (place as usize).min(last);
        (frame, (place - index_to_f64(frame)) as f32)
    }

    fn reset_to_rest(&self, pose: &mut LocalPose) {
        pose.rotations.clear();
        pose.rotations
            .extend_from_slice(self.skeleton.rest_rotations());
        pose.translations.clear();
        pose.translations
            .extend_from_slice(self.skeleton.rest_translations());
    }

    fn check_frame(&self, frame: usize) {
        assert!(
            frame < self.frame_count,
            "frame {frame} of {}",
            self.frame_count
        );
    }

    fn block_count(&self) -> usize {
        self.frame_count.div_ceil(LANES)
    }

    fn rotation_block(&self, block: usize) -> &[QuatLanes] {
        &self.rotations[block * self.rotated.len()..][..self.rotated.len()]
    }

    fn translation_block(&self, block: usize) -> &[Vec3Lanes] {
        &self.translations[block * self.translated.len()..][..self.translated.len()]
    }
}

/// A frame number as a factor of time. Exact below 2^53.
#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
fn index_to_f64(index: usize) -> f64 {
    index as f64
}
