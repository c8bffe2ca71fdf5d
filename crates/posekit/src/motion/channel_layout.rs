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

/// What position channels do with the OFFSET of their joint, where it is not zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PositionPolicy {
    /// They replace it, coordinate by coordinate, as Blender and BVHView read them.
    #[default]
    Replace,
    /// A root's are added to its OFFSET, as the original BVH description has it; other joints'
    /// replace theirs.
    AddToRootOffset,
}
