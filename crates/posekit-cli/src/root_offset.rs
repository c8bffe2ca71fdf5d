//! The option `--root-offset`, of all commands that pose a figure.

use clap::ValueEnum;
use posekit::motion::PositionPolicy;

/// What a root's position channels do with its OFFSET.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RootOffset {
    /// They are added, as the original description of BVH has it
    Add,
    /// They replace it, as Blender reads files
    Replace,
}

impl RootOffset {
    /// The same for the library.
    pub(crate) fn policy(self) -> PositionPolicy {
        match self {
            Self::Add => PositionPolicy::AddToRootOffset,
            Self::Replace => PositionPolicy::Replace,
        }
    }
}
