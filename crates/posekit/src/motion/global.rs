//! Forward kinematics of a whole motion.

use std::fmt;
use std::sync::Arc;

use glam::{Quat, Vec3};

use super::{FrameTime, Motion};
use crate::lanes::{
    self, Kernel, LANES, QuatLanes, QuatRegisters, Register, Vec3Lanes, Vec3Registers,
};
use crate::pose::GlobalPose;
use crate::skeleton::{JointId, Skeleton};

/// World-space positions and orientations of every joint in every frame of a [`Motion`].
#[derive(Clone)]
pub struct GlobalMotion {
    skeleton: Arc<Skeleton>,
    frame_count: usize,
    frame_time: FrameTime,
    /// Block after block, all joints.
    transforms: Vec<TransformLanes>,
}

/// How large it is, not its millions of numbers.
impl fmt::Debug for GlobalMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GlobalMotion")
            .field("joints", &self.skeleton.joint_count())
            .field("frames", &self.frame_count)
            .field("frame_time_secs", &self.frame_time.secs())
            .finish_non_exhaustive()
    }
}

/// Eight frames of one joint in the world. Position and orientation of a parent are always used
/// together, so they lie together.
#[derive(Clone, Copy, Debug)]
struct TransformLanes {
    position: Vec3Lanes,
    orientation: QuatLanes,
}

impl TransformLanes {
    const IDENTITY: Self = Self {
        position: Vec3Lanes::ZERO,
        orientation: QuatLanes::IDENTITY,
    };
}

/// How a joint gets its global transform; resolved once a motion, not once a block.
#[derive(Clone, Copy, Debug)]
struct Step {
    parent: Option<usize>,
    rotation: Rotation,
    translation: Translation,
}

/// Where a joint's local rotation comes from.
#[derive(Clone, Copy, Debug)]
enum Rotation {
    Track(usize),
    Rest(Quat),
    /// The rest rotation is the identity: there is nothing to multiply.
    Identity,
}

/// Where a joint's local translation comes from.
#[derive(Clone, Copy, Debug)]
enum Translation {
    Track(usize),
    Rest(Vec3),
}

impl GlobalMotion {
    pub(super) fn of(motion: &Motion) -> Self {
        let mut global = Self {
            skeleton: Arc::clone(motion.skeleton()),
            frame_count: 0,
            frame_time: FrameTime::NONE,
            transforms: Vec::new(),
        };
        global.update(motion);
        global
    }

    /// Computes everything anew, of another motion or of the same after a change, in the memory
    /// that is there already where it suffices.
    pub fn update(&mut self, motion: &Motion) {
        self.update_by(motion, |kernel| lanes::run(kernel));
    }

    /// [`update`](Self::update) on registers of the caller's choice.
    pub(super) fn update_by(&mut self, motion: &Motion, run: impl FnOnce(FillBlocks<'_>)) {
        let skeleton = motion.skeleton();
        let joint_count = skeleton.joint_count();
        let steps: Vec<Step> = skeleton.joints().map(|joint| step(motion, joint)).collect();
        let transform_count = motion.block_count() * joint_count;
        self.transforms.truncate(transform_count);
        let missing = transform_count - self.transforms.len();
        self.transforms.reserve_exact(missing);
        run(FillBlocks {
            motion,
            steps: &steps,
            transforms: &mut self.transforms,
        });
        self.skeleton = Arc::clone(skeleton);
        self.frame_count = motion.frame_count();
        self.frame_time = motion.frame_time();
    }

    /// The skeleton that moves.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// Number of frames.
    pub fn frame_count(&self) -> usize {
        self.frame_count
    }

    /// Time between two frames, in seconds; 0 when all frames are at one time.
    pub fn frame_time_secs(&self) -> f64 {
        self.frame_time.secs()
    }

    /// A joint's position in the world at a frame.
    ///
    /// # Panics
    /// If the frame or the joint is out of range.
    #[inline]
    pub fn position(&self, frame: usize, joint: JointId) -> Vec3 {
        self.transform(frame, joint).position.lane(frame % LANES)
    }

    /// A joint's orientation in the world at a frame.
    ///
    /// # Panics
    /// If the frame or the joint is out of range.
    #[inline]
    pub fn orientation(&self, frame: usize, joint: JointId) -> Quat {
        self.transform(frame, joint).orientation.lane(frame % LANES)
    }

    /// Where a point attached to a joint's link is in the world at a frame.
    ///
    /// # Panics
    /// If the frame or the joint is out of range.
    pub fn transform_point(&self, frame: usize, joint: JointId, point_in_joint: Vec3) -> Vec3 {
        self.position(frame, joint) + self.orientation(frame, joint) * point_in_joint
    }

    /// The global pose of one frame.
    ///
    /// # Panics
    /// If the frame is out of range.
    pub fn pose(&self, frame: usize) -> GlobalPose {
        let mut pose = GlobalPose::default();
        self.pose_into(frame, &mut pose);
        pose
    }

    /// Fills `pose` with the global pose of one frame, without allocating when it fits already.
    ///
    /// # Panics
    /// If the frame is out of range.
    pub fn pose_into(&self, frame: usize, pose: &mut GlobalPose) {
        let joint_count = self.skeleton.joint_count();
        let lane = frame % LANES;
        self.check_frame(frame);
        let block = &self.transforms[frame / LANES * joint_count..][..joint_count];
        pose.positions.clear();
        pose.positions
            .extend(block.iter().map(|transform| transform.position.lane(lane)));
        pose.orientations.clear();
        pose.orientations.extend(
            block
                .iter()
                .map(|transform| transform.orientation.lane(lane)),
        );
    }

    /// The lowest and the highest coordinates of all joints over all frames. Both zero for a
    /// motion without frames.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let mut bounds: Option<(Vec3, Vec3)> = None;
        for frame in 0..self.frame_count {
            for joint in self.skeleton.joints() {
                let p = self.position(frame, joint);
                bounds = Some(bounds.map_or((p, p), |(low, high)| (low.min(p), high.max(p))));
            }
        }
        bounds.unwrap_or((Vec3::ZERO, Vec3::ZERO))
    }

    #[inline]
    fn transform(&self, frame: usize, joint: JointId) -> &TransformLanes {
        self.check_frame(frame);
        let joint_count = self.skeleton.joint_count();
        assert!(
            joint.index() < joint_count,
            "joint {} of {joint_count}",
            joint.index()
        );
        &self.transforms[frame / LANES * joint_count + joint.index()]
    }

    #[inline]
    fn check_frame(&self, frame: usize) {
        assert!(
            frame < self.frame_count,
            "frame {frame} of {}",
            self.frame_count
        );
    }
}

fn step(motion: &Motion, joint: JointId) -> Step {
    let skeleton = motion.skeleton();
    let rest_rotation = skeleton.rest_rotation(joint);
    let rotation = match motion.rotated.slot(joint) {
        Some(slot) => Rotation::Track(slot),
        None if rest_rotation == Quat::IDENTITY => Rotation::Identity,
        None => Rotation::Rest(rest_rotation),
    };
    let rest_translation = Translation::Rest(skeleton.rest_translation(joint));
    let translation = motion
        .translated
        .slot(joint)
        .map_or(rest_translation, Translation::Track);
    Step {
        parent: skeleton.parent(joint).map(JointId::index),
        rotation,
        translation,
    }
}

/// Forward kinematics of all blocks.
pub(super) struct FillBlocks<'a> {
    motion: &'a Motion,
    steps: &'a [Step],
    /// Block after block, all joints; grows to what the motion needs.
    transforms: &'a mut Vec<TransformLanes>,
}

impl Kernel for FillBlocks<'_> {
    #[inline(always)]
    fn run<R: Register>(self) {
        let joint_count = self.steps.len();
        for block in 0..self.motion.block_count() {
            let (start, end) = (block * joint_count, (block + 1) * joint_count);
            // New memory is touched a block at a time, so that it is in the first cache when the
            // block is computed.
            if self.transforms.len() < end {
                self.transforms.resize(end, TransformLanes::IDENTITY);
            }
            let transforms = &mut self.transforms[start..end];
            fill_block::<R>(self.motion, self.steps, block, transforms);
        }
    }
}

/// Computes the global transforms of eight frames, joint after joint.
#[inline(always)]
fn fill_block<R: Register>(
    motion: &Motion,
    steps: &[Step],
    block: usize,
    transforms: &mut [TransformLanes],
) {
    let rotations = motion.rotation_block(block);
    let translations = motion.translation_block(block);
    for (index, step) in steps.iter().enumerate() {
        let (done, rest) = transforms.split_at_mut(index);
        let parent = step.parent.map(|parent| &done[parent]);
        let transform = &mut rest[0];
        for part in 0..R::PARTS {
            let translation = match step.translation {
                Translation::Track(slot) => Vec3Registers::<R>::load(&translations[slot], part),
                Translation::Rest(rest) => Vec3Registers::splat(rest),
            };
            match parent {
                None => {
                    translation.store(&mut transform.position, part);
                    local_rotation::<R>(step, rotations, part)
                        .store(&mut transform.orientation, part);
                }
                Some(parent) => {
                    let turn = QuatRegisters::load(&parent.orientation, part);
                    Vec3Registers::load(&parent.position, part)
                        .add(turn.rotate(translation))
                        .store(&mut transform.position, part);
                    // The rotation is fetched only now: before, it would not fit in the registers.
                    let orientation = match step.rotation {
                        Rotation::Identity => turn,
                        Rotation::Track(_) | Rotation::Rest(_) => {
                            turn.mul(local_rotation(step, rotations, part))
                        }
                    };
                    orientation.store(&mut transform.orientation, part);
                }
            }
        }
    }
}

#[inline(always)]
fn local_rotation<R: Register>(
    step: &Step,
    rotations: &[QuatLanes],
    part: usize,
) -> QuatRegisters<R> {
    match step.rotation {
        Rotation::Track(slot) => QuatRegisters::load(&rotations[slot], part),
        Rotation::Rest(rest) => QuatRegisters::splat(rest),
        Rotation::Identity => QuatRegisters::splat(Quat::IDENTITY),
    }
}
