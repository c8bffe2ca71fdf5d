//! Options that say how motion files are read, given with something else: there they would change nothing, and
//! nothing that was asked for is left undone without a word.

use posekit::figure::UpAxis;

use crate::failure::Failure;
use crate::inputs::{Input, Source};
use crate::positions::PositionsArgs;
use crate::scene_file;

/// Whether an input is a scene.
pub(crate) fn is_scene(input: &Input) -> bool {
    matches!(&input.source, Source::File(path) if scene_file::is_scene(path))
}

/// What the user said of how files are read.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Said {
    positions: bool,
    up: bool,
}

impl Said {
    /// Of a command that has `--positions`.
    pub(crate) fn of(positions: PositionsArgs) -> Self {
        Self {
            positions: positions.is_given(),
            up: false,
        }
    }

    /// Of one that has `--up` besides.
    pub(crate) fn and_up(self, up: Option<UpAxis>) -> Self {
        Self {
            up: up.is_some(),
            ..self
        }
    }

    /// Fails for a scene: its world has Y up, and its files are played as they are read when nobody says otherwise,
    /// here and in the window.
    pub(crate) fn refuse_scene(self, input: &Input) -> Result<(), Failure> {
        if !is_scene(input) {
            return Ok(());
        }
        let (option, why, instead) = if self.positions {
            (
                "--positions",
                "which plays its files with positions in place of OFFSETs",
                "make a file with such positions first, and name that in the scene: \
                 posekit convert IN.bvh OUT.bvh --positions HOW",
            )
        } else if self.up {
            (
                "--up",
                "whose world has Y up",
                "turn its motion file first, and name that in the scene: posekit convert IN.bvh OUT.bvh --up y",
            )
        } else {
            return Ok(());
        };
        let what = format!("{option} is for motion files, and this is a scene, {why}");
        Err(Failure::usage(what)
            .try_next(instead)
            .in_file(&input.name()))
    }

    /// Fails for a robot, whose file says all that.
    pub(crate) fn refuse_robot(self, name: &str) -> Result<(), Failure> {
        let option = match (self.positions, self.up) {
            (true, _) => "--positions",
            (false, true) => "--up",
            (false, false) => return Ok(()),
        };
        let what = format!("{option} is for motion files, and this is a robot");
        Err(Failure::usage(what).in_file(name))
    }
}
