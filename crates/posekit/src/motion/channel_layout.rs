//! What the columns of channel rows mean, as motion files say it.

use super::Channel;
use crate::skeleton::JointId;

/// What the columns of a channel row mean.
///
/// A joint's rotation channels are multiplied in the order in which they are listed; they need not
/// stand side by side.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChannelLayout {
    columns: Vec<(JointId, Channel)>,
}

impl ChannelLayout {
    /// A layout from the joint and the channel of each column.
    pub fn new(columns: impl IntoIterator<Item = (JointId, Channel)>) -> Self {
        Self {
            columns: columns.into_iter().collect(),
        }
    }

    /// Number of values in a row.
    pub fn column_count(&self) -> usize {
        self.columns.len()
    }

    /// The joint and the channel of each column.
    pub fn columns(&self) -> &[(JointId, Channel)] {
        &self.columns
    }
}

/// What a joint's position channels do with its OFFSET, where that is not zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PositionPolicy {
    /// They replace it, coordinate by coordinate, as Blender and BVHView read them.
    #[default]
    Replace,
    /// They are added to it, as the original BVH description has it for roots.
    Add,
    /// They count for nothing: the joint stays at its OFFSET.
    Ignore,
}

/// What position channels do with the OFFSETs of a skeleton: a root's say where the figure is, those
/// of other joints how long its bones are, and programs that write the one in one way write the
/// other in another.
///
/// One [`PositionPolicy`] is that of all joints:
///
/// ```
/// use posekit::motion::{PositionPolicies, PositionPolicy};
///
/// let policies: PositionPolicies = PositionPolicy::Add.into();
/// assert_eq!(policies.root, policies.others);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PositionPolicies {
    /// For joints without a parent.
    pub root: PositionPolicy,
    /// For all others.
    pub others: PositionPolicy,
}

impl PositionPolicies {
    /// That of a joint with this parent.
    pub fn of_joint_below<T>(self, parent: Option<T>) -> PositionPolicy {
        match parent {
            None => self.root,
            Some(_) => self.others,
        }
    }
}

impl From<PositionPolicy> for PositionPolicies {
    fn from(policy: PositionPolicy) -> Self {
        Self {
            root: policy,
            others: policy,
        }
    }
}
