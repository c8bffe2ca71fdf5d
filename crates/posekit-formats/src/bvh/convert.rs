//! From a BVH document to a skeleton and its motion.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use posekit::motion::{Channel, ChannelLayout, Motion, PositionPolicies};
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder, SkeletonError};

use super::{Bvh, BvhJoint};

impl Bvh {
    /// The skeleton that the HIERARCHY section describes: a joint for every joint of the document,
    /// in the same order, with the OFFSETs as rest translations.
    ///
    /// # Errors
    /// If the document has no joint, a parent does not come before its child, or an OFFSET is beyond
    /// the range of `f32`. A document from [`read`](super::read()) has only the last of these.
    pub fn to_skeleton(&self) -> Result<Skeleton, SkeletonError> {
        let mut builder = SkeletonBuilder::new();
        for joint in &self.joints {
            let name = joint.name().into_owned();
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
    /// A frame time that is not positive counts as zero: every frame is at the same time.
    ///
    /// # Errors
    /// As [`to_skeleton`](Self::to_skeleton).
    pub fn to_motion(
        &self,
        policies: impl Into<PositionPolicies>,
    ) -> Result<Motion, SkeletonError> {
        let skeleton = Arc::new(self.to_skeleton()?);
        let layout = self.channel_layout();
        let (frame_time_secs, values) =
            self.motion.as_ref().map_or((0.0, [].as_slice()), |motion| {
                (motion.frame_time_secs, &motion.values)
            });
        let frame_time_secs = frame_time_secs.max(0.0);
        Ok(Motion::from_channel_rows(
            skeleton,
            frame_time_secs,
            &layout,
            values,
            policies,
        ))
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
