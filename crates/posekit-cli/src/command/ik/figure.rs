//! The figure that is worked on: its document, its motion, and what is written back.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::ik::MovedJoint;
use posekit::motion::{FrameTime, Motion, PositionPolicies, PositionPolicy};
use posekit::pose::LocalPose;
use posekit::rotation::{Axis, angle_between};
use posekit::skeleton::Skeleton;
use posekit_formats::bvh::edit::{self, EditError};
use posekit_formats::bvh::{Bvh, BvhMotion};

use super::IkArgs;
use crate::failure::Failure;
use crate::load::Loaded;

/// A rotation that differs by no more than this is the one that was there: single precision, in which
/// poses are kept, cannot tell them apart, and so the file's digits stay.
const SAME_RAD: f64 = 3e-7;

/// As [`SAME_RAD`] for places, as a share of their distance from the origin.
const SAME_SHARE: f64 = 2e-7;

/// The figure.
#[derive(Debug)]
pub(super) struct Figure {
    /// The document that is changed.
    pub(super) bvh: Bvh,
    /// As it was, to count what changed.
    before: Vec<f64>,
    /// Its joints, in the document's order.
    pub(super) skeleton: Arc<Skeleton>,
    /// Its motion as it was.
    pub(super) motion: Motion,
    /// How position channels are read.
    pub(super) policies: PositionPolicies,
}

impl Figure {
    /// The figure of a file.
    pub(super) fn new(args: &IkArgs, loaded: Loaded) -> Result<Self, Failure> {
        let policies = args.positions.policies();
        let mut loaded = loaded;
        if args.rest {
            put_at_rest(&mut loaded.bvh, policies, args.root.map(|root| root.0));
        }
        let motion = loaded.motion(policies)?;
        if motion.frame_count() == 0 {
            return Err(Failure::new("has no frames").try_next("--rest works on its rest pose"));
        }
        let bvh = loaded.bvh;
        Ok(Self {
            before: values(&bvh).to_vec(),
            skeleton: Arc::clone(motion.skeleton()),
            bvh,
            motion,
            policies,
        })
    }

    /// Seconds from one frame to the next.
    pub(super) fn frame_time_secs(&self) -> f64 {
        self.motion.frame_time_secs()
    }

    /// Writes joints that a solver moved in a frame into the document; those that came out as they were
    /// keep their digits. Angles are those closest to `near_frame`'s.
    pub(super) fn write(
        &mut self,
        frame: usize,
        near_frame: usize,
        was: &LocalPose,
        moved: &[MovedJoint],
    ) -> Result<(), Failure> {
        for joint in moved {
            let index = joint.joint.index();
            let rotation = was.rotations[index].as_dquat().normalize();
            if angle_between(rotation, joint.rotation) > SAME_RAD {
                self.turn(index, frame, joint.rotation, near_frame)?;
            }
            let translation = was.translations[index].as_dvec3();
            let moved_by = translation.distance(joint.translation);
            if moved_by > SAME_SHARE * (1.0 + translation.length()) {
                edit::set_translation(
                    &mut self.bvh,
                    index,
                    frame,
                    joint.translation,
                    self.policies,
                )
                .map_err(refused)?;
            }
        }
        Ok(())
    }

    fn turn(
        &mut self,
        joint: usize,
        frame: usize,
        rotation: DQuat,
        near_frame: usize,
    ) -> Result<(), Failure> {
        edit::set_rotation(&mut self.bvh, joint, frame, rotation, near_frame).map_err(refused)?;
        Ok(())
    }

    /// How many values differ from what the file had.
    pub(super) fn changed_count(&self) -> usize {
        let pairs = self.before.iter().zip(values(&self.bvh));
        pairs.filter(|(a, b)| a != b).count()
    }
}

fn values(bvh: &Bvh) -> &[f64] {
    bvh.motion.as_ref().map_or(&[], |motion| &motion.values)
}

fn refused(error: EditError) -> Failure {
    let text = error.to_string();
    match error {
        EditError::CannotMove { .. } => Failure::new(text)
            .try_next("posekit convert --channels 6 gives every joint all channels"),
        _ => Failure::new(text),
    }
}

/// Makes the motion one frame of the rest pose, with the first root where it is wanted. An axis for which that
/// root has no position channel that counts keeps its place by its OFFSET.
fn put_at_rest(bvh: &mut Bvh, policies: PositionPolicies, root: Option<DVec3>) {
    use posekit::motion::Channel;
    if let (Some(place), Some(first)) = (root, bvh.joints.first_mut()) {
        for (axis, at) in Axis::ALL.into_iter().zip(place.to_array()) {
            let is_ignored = policies.root == PositionPolicy::Ignore;
            if is_ignored || !first.channels.contains(&Channel::Position(axis)) {
                first.offset[axis.index()] = at;
            }
        }
    }
    let mut values = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        let is_added = policies.of_joint_below(joint.parent) == PositionPolicy::Add;
        let place = root.filter(|_| index == 0);
        values.extend(joint.channels.iter().map(|channel| match channel {
            Channel::Position(axis) => {
                let offset = joint.offset[axis.index()];
                let at = place.map_or(offset, |place| place[axis.index()]);
                if is_added { at - offset } else { at }
            }
            Channel::Rotation(_) => 0.0,
        }));
    }
    let frame_time_secs = match bvh.frame_time() {
        FrameTime::NONE => FrameTime::of_fps(30).secs(),
        frame_time => frame_time.secs(),
    };
    bvh.motion = Some(BvhMotion {
        frame_time_secs,
        frame_count: 1,
        values,
    });
}
