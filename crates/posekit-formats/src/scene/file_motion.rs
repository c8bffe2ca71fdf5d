//! What a file that a scene names plays.

use std::sync::Arc;

use posekit::keyframe::Animation;
use posekit::motion::Motion;
use posekit::pose::LocalPose;
use posekit::skeleton::{JointId, Skeleton};

/// What a file plays: frames, or keys, which are sampled from their own curves at any rate.
///
/// Times are the file's own, in seconds.
#[derive(Clone, Debug)]
pub enum FileMotion {
    /// The frames of a motion file, the first at 0.
    Frames(Arc<Motion>),
    /// The keys of a glTF file.
    Keys(Arc<Animation>),
}

impl From<Arc<Motion>> for FileMotion {
    fn from(motion: Arc<Motion>) -> Self {
        Self::Frames(motion)
    }
}

impl FileMotion {
    /// The skeleton that it moves.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        match self {
            Self::Frames(motion) => motion.skeleton(),
            Self::Keys(animation) => animation.skeleton(),
        }
    }

    /// From when to when it plays: from its first frame or key to its last.
    pub fn range_secs(&self) -> [f64; 2] {
        match self {
            Self::Frames(motion) => [0.0, motion.duration_secs()],
            Self::Keys(animation) => animation.range_secs().unwrap_or_default(),
        }
    }

    /// The pose at a time.
    pub fn sample(&self, time_secs: f64) -> LocalPose {
        match self {
            Self::Frames(motion) => motion.sample(time_secs),
            Self::Keys(animation) => animation.sample(time_secs),
        }
    }

    /// Whether it moves a joint in its parent's space, and does not only turn it.
    pub fn translates(&self, joint: JointId) -> bool {
        match self {
            Self::Frames(motion) => motion.translated_joints().binary_search(&joint).is_ok(),
            Self::Keys(animation) => animation.translation(joint).is_some(),
        }
    }
}
