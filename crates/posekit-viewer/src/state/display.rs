//! What is shown of a figure, and how.

use posekit_render::stage::{Arrangement, Follow, SkeletonStyle};
use serde::{Deserialize, Serialize};

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Look {
    /// Dark text on light grounds.
    #[default]
    Light,
    /// Light text on dark grounds.
    Dark,
}

/// How skeletons are drawn, in a form that settings can keep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Style {
    /// A body fitted to the bones.
    #[default]
    Body,
    /// Tapered bones and joint balls.
    Bones,
    /// Octahedra.
    Octahedra,
    /// Plain lines.
    Lines,
}

/// Which pose is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PoseShown {
    /// The motion's.
    #[default]
    Motion,
    /// The skeleton at rest.
    Rest,
}

/// Where several figures stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Compare {
    /// Next to one another.
    #[default]
    SideBySide,
    /// Where their files say.
    Overlaid,
}

/// Whether the camera goes along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum FollowMode {
    /// When the figure goes far.
    #[default]
    Auto,
    /// Always.
    On,
    /// Never.
    Off,
}

/// How far trails go back, seconds.
pub const TRAIL_SECS_RANGE: std::ops::RangeInclusive<f64> = 0.2..=10.0;

/// What is shown, and how. All of it is remembered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Display {
    /// How skeletons are drawn.
    pub style: Style,
    /// The axes of all joints.
    pub axes: bool,
    /// The names of all joints.
    pub labels: bool,
    /// The paths of the selected joints, or of hands and feet where none is selected.
    pub trails: bool,
    /// How far back they go, seconds.
    pub trail_secs: f64,
    /// Earlier and later poses, shown faintly.
    pub ghosts: bool,
    /// Frames from one ghost to the next.
    pub ghost_every_frames: usize,
    /// In the animation mode ghosts stand at the neighbouring keys instead.
    pub ghosts_at_keys: bool,
    /// At how many keys before and after the time shown.
    pub ghost_keys: usize,
    /// Where several figures stand.
    pub compare: Compare,
    /// Whether the camera goes along.
    pub follow: FollowMode,
}

impl Default for Display {
    fn default() -> Self {
        Self {
            style: Style::default(),
            axes: false,
            labels: false,
            trails: false,
            trail_secs: 1.5,
            ghosts: false,
            ghost_every_frames: 15,
            ghosts_at_keys: true,
            ghost_keys: 2,
            compare: Compare::default(),
            follow: FollowMode::default(),
        }
    }
}

impl Style {
    /// All styles, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Body, Self::Bones, Self::Octahedra, Self::Lines];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Body => "Body",
            Self::Bones => "Bones",
            Self::Octahedra => "Octahedra",
            Self::Lines => "Lines",
        }
    }

    /// The one after it.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::Body => Self::Bones,
            Self::Bones => Self::Octahedra,
            Self::Octahedra => Self::Lines,
            Self::Lines => Self::Body,
        }
    }

    /// The renderer's name for it.
    #[must_use]
    pub const fn to_render(self) -> SkeletonStyle {
        match self {
            Self::Body => SkeletonStyle::Body,
            Self::Bones => SkeletonStyle::Bones,
            Self::Octahedra => SkeletonStyle::Octahedra,
            Self::Lines => SkeletonStyle::Lines,
        }
    }
}

impl Compare {
    /// The renderer's name for it.
    #[must_use]
    pub const fn to_render(self) -> Arrangement {
        match self {
            Self::SideBySide => Arrangement::SideBySide,
            Self::Overlaid => Arrangement::AsRecorded,
        }
    }
}

impl FollowMode {
    /// The renderer's name for it.
    #[must_use]
    pub const fn to_render(self) -> Follow {
        match self {
            Self::Auto => Follow::Far,
            Self::On => Follow::Root,
            Self::Off => Follow::Never,
        }
    }
}
