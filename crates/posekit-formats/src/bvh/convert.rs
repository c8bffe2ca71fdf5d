//! From a BVH document to a skeleton and its motion.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use posekit::motion::{Channel, ChannelLayout, ChannelValueError, Motion, PositionPolicies};
use posekit::range::LONGEST_LENGTH;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder, SkeletonError};

use super::{Bvh, BvhJoint};

/// Why no motion can be made of a document.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// The joints are no skeleton.
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
    /// A value of the rows is beyond the range.
    #[error(transparent)]
    Value(#[from] ChannelValueError),
}

impl Bvh {
    /// The skeleton that the HIERARCHY section describes: a joint for every joint of the document,
    /// in the same order, with the OFFSETs as rest translations.
    ///
    /// # Errors
    /// If the document has no joint, a parent does not come before its child, or an OFFSET is not within
    /// [`LONGEST_LENGTH`]. A document from [`read`](super::read()) has only the last of these.
    pub fn to_skeleton(&self) -> Result<Skeleton, SkeletonError> {
        let mut builder = SkeletonBuilder::new();
        for (index, joint) in self.joints.iter().enumerate() {
            let name = joint.name().into_owned();
            if let Some(&value) = joint.offset.iter().find(|it| it.abs() > LONGEST_LENGTH) {
                // The file's number: `f32` may have none for it.
                return Err(SkeletonError::TooFar {
                    joint: index,
                    name,
                    value,
                });
            }
            let offset = DVec3::from_array(joint.offset).as_vec3();
            match joint.parent.map(JointId::new) {
                Some(parent) if joint.is_end_site => builder.end_site(name, parent, offset),
                parent => builder.joint(name, parent, offset),
            };
        }
        builder.build()
    }

    /// What the columns of a row of channel values mean.
    pub fn channel_layout(&self) -> ChannelLayout {
        let columns = self.joints.iter().enumerate();
        ChannelLayout::new(columns.flat_map(|(index, joint)| {
            joint
                .channels
                .iter()
                .map(move |&channel| (JointId::new(index), channel))
        }))
    }

    /// The skeleton and its motion; a document without a MOTION section gives a motion without
    /// frames.
    ///
    /// A frame time that cannot be right counts as none: every frame is at the same time.
    ///
    /// # Errors
    /// [`MotionError`] as [`to_skeleton`](Self::to_skeleton) and [`Motion::from_channel_rows`].
    pub fn to_motion(&self, policies: impl Into<PositionPolicies>) -> Result<Motion, MotionError> {
        let skeleton = Arc::new(self.to_skeleton()?);
        let layout = self.channel_layout();
        let motion = self.motion.as_ref();
        let values = motion.map_or([].as_slice(), |motion| &motion.values);
        let frame_time = self.frame_time();
        let motion = Motion::from_channel_rows(skeleton, frame_time, &layout, values, policies)?;
        Ok(motion)
    }

    /// The joints for which the [`PositionPolicies`] matter: they have position channels and an OFFSET
    /// that is not zero.
    pub fn joints_with_offset_and_position(&self) -> impl Iterator<Item = usize> + '_ {
        let matters = |joint: &BvhJoint| {
            let moves = |channel: &Channel| matches!(channel, Channel::Position(_));
            joint.channels.iter().any(moves)
                && Vec3::ZERO != DVec3::from_array(joint.offset).as_vec3()
        };
        let joints = self.joints.iter().enumerate();
        joints
            .filter(move |(_, joint)| matters(joint))
            .map(|(index, _)| index)
    }
}
