//! What the window is for at the moment: looking, posing, or bringing limbs to targets.

use serde::{Deserialize, Serialize};

use super::session::Handles;
use crate::gizmo::Tool;

/// A mode of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// Looking only.
    #[default]
    View,
    /// Joints are turned by hand.
    Pose,
    /// Limbs are brought to targets.
    Ik,
    /// Motion is authored with keys.
    Animate,
    /// Robot arms on a bench of their own.
    Lab,
    /// Ways between orientations, side by side.
    Interpolation,
}

impl Mode {
    /// All modes, in the order in which they are offered.
    pub const ALL: [Self; 6] = [
        Self::View,
        Self::Pose,
        Self::Ik,
        Self::Animate,
        Self::Lab,
        Self::Interpolation,
    ];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::View => "View",
            Self::Pose => "Pose",
            Self::Ik => "IK",
            Self::Animate => "Animate",
            Self::Lab => "Arm lab",
            Self::Interpolation => "Interpolation lab",
        }
    }

    /// What it is for.
    #[must_use]
    pub const fn says(self) -> &'static str {
        match self {
            Self::View => "Look at the motion",
            Self::Pose => "Turn joints by hand",
            Self::Ik => "Drag hands and feet; the body follows",
            Self::Animate => "Make motion with keys: poses, and curves between them",
            Self::Lab => "Robot arms: joints, tips, and the numbers behind them",
            Self::Interpolation => "The ways between orientations, and why slerp is the right one",
        }
    }

    /// What the pointer does in it, for the line under the view.
    #[must_use]
    pub const fn hint(self) -> &'static str {
        match self {
            Self::View | Self::Lab | Self::Interpolation => "",
            Self::Pose | Self::Animate => "Click a bone, drag its rings, or R and the pointer",
            Self::Ik => "Click a dot, drag its arrows, or G and the pointer",
        }
    }

    /// Whether it is a room of its own, in which the clips are not on the stage.
    #[must_use]
    pub const fn is_lab(self) -> bool {
        matches!(self, Self::Lab | Self::Interpolation)
    }

    /// Whether poses of clips are changed in it.
    #[must_use]
    pub const fn edits(self) -> bool {
        matches!(self, Self::Pose | Self::Ik | Self::Animate)
    }
}

/// How the gizmo's axes lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Space {
    /// As the joint's own.
    #[default]
    Local,
    /// As its parent's.
    Parent,
    /// As the world's.
    World,
}

impl Space {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 3] = [Self::Local, Self::Parent, Self::World];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Local => "Local",
            Self::Parent => "Parent",
            Self::World => "World",
        }
    }

    /// The one after it.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::Local => Self::Parent,
            Self::Parent => Self::World,
            Self::World => Self::Local,
        }
    }
}

/// How the gizmo is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ToolSettings {
    /// Which handles it has on a joint that both turns and moves.
    pub tool: Tool,
    /// Which handles it has on a target: those that turn ask for an orientation, too.
    pub ik_tool: Tool,
    /// How its axes lie on a joint.
    pub space: Space,
    /// How its axes lie on a target.
    pub ik_space: Space,
    /// Whether it goes in steps without Ctrl, and freely with it.
    pub snaps: bool,
}

impl ToolSettings {
    /// How the gizmo's axes lie on what the pointer takes.
    pub fn space_with(&mut self, handles: Handles) -> &mut Space {
        match handles {
            Handles::Targets => &mut self.ik_space,
            Handles::None | Handles::Joints => &mut self.space,
        }
    }
}

impl Default for ToolSettings {
    fn default() -> Self {
        Self {
            tool: Tool::Turn,
            ik_tool: Tool::Move,
            space: Space::Local,
            ik_space: Space::World,
            snaps: false,
        }
    }
}

/// Step of turns, degrees.
pub const TURN_STEP_DEG: f32 = 15.0;

/// A round step of movements for a figure of height `stature`: a thirty-sixth of it or a little more.
#[must_use]
pub fn move_step(stature: f32) -> f32 {
    let wanted = stature / 36.0;
    if !wanted.is_finite() || wanted <= 0.0 {
        return 0.01;
    }
    let power = libm::powf(10.0, libm::log10f(wanted).floor());
    let round = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|factor| factor * power >= wanted);
    round.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_in_every_unit() {
        for (stature, step) in [(1.7, 0.05), (170.0, 5.0), (67.0, 2.0), (0.0, 0.01)] {
            assert!((move_step(stature) - step).abs() < 1e-4 * step, "{stature}");
        }
    }
}
