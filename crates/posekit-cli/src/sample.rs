//! The clips that the program makes itself, by name.

use posekit::motion::Motion;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::Bvh;
use posekit_formats::scene::{self, AUTHORED_WALK};

use crate::failure::Failure;

/// A clip of our own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sample {
    /// A humanoid walks.
    Walk,
    /// A humanoid runs.
    Run,
    /// A humanoid waves.
    Wave,
    /// A robot arm moves.
    Arm,
    /// A humanoid walks, as keyed by hand in a scene file.
    KeyedWalk,
}

impl Sample {
    /// All of them, in the order they are listed in.
    pub(crate) const ALL: [Self; 5] = [
        Self::Walk,
        Self::Run,
        Self::Wave,
        Self::Arm,
        Self::KeyedWalk,
    ];

    /// The name on the command line.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Wave => "wave",
            Self::Arm => "arm",
            Self::KeyedWalk => scene::AUTHORED_WALK_NAME,
        }
    }

    /// The clip.
    pub(crate) fn document(self) -> Result<Bvh, Failure> {
        Ok(Bvh::from_motion(&self.motion()?, EulerOrder::ZXY))
    }

    /// The clip's motion.
    pub(crate) fn motion(self) -> Result<Motion, Failure> {
        let motion = scene::sample_motion(self.name());
        motion.ok_or_else(|| Failure::new(format!("there is no sample {}", self.name())))
    }

    /// The text of the scene file that the clip is authored in, if it is.
    pub(crate) fn scene(self) -> Option<&'static str> {
        (self == Self::KeyedWalk).then_some(AUTHORED_WALK)
    }

    /// The clip of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sample| sample.name() == name)
    }
}
