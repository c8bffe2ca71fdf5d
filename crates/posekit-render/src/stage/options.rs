//! What the stage can be asked for.

use posekit::skeleton::JointId;

use crate::camera::{Camera, Projection, View};
use crate::grid::LengthUnit;
use crate::scene::Background;
use crate::theme::Theme;

/// How skeletons are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum SkeletonStyle {
    /// A body of simple rigid shapes fitted to the bones.
    #[default]
    Body,
    /// Tapered round bones with joint balls.
    Bones,
    /// Octahedral bones, as animation packages draw them.
    Octahedra,
    /// Plain lines.
    Lines,
}

/// Whether the axes of joints are drawn over the style.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum AxesShown {
    /// None.
    #[default]
    None,
    /// X red, Y green, Z blue at every joint.
    Joints,
}

/// Where several actors stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Arrangement {
    /// Where their files say: overlaid, for before and after.
    #[default]
    AsRecorded,
    /// Next to one another, each starting on its own spot of a common floor.
    SideBySide,
}

/// Whether the camera goes along.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Follow {
    /// It goes along when the actors go so far that they would be small otherwise.
    #[default]
    Far,
    /// It stays and sees the whole motion.
    Never,
    /// It goes along with the root.
    Root,
}

/// Where the picture is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraChoice {
    /// A named view of the first actor, framed.
    View(View),
    /// Any direction, framed. The yaw counts from where the first actor faces.
    Around {
        /// Radians from the facing.
        yaw_rad: f32,
        /// Radians over the horizon.
        pitch_rad: f32,
        /// Lens or parallel rays.
        projection: Projection,
    },
    /// A camera of the caller's, as it is.
    Fixed(Camera),
}

/// The paths that joints leave behind.
#[derive(Clone, Debug, PartialEq)]
pub struct Trails {
    /// Whose.
    pub joints: Vec<JointId>,
    /// How far back they go, seconds.
    pub seconds: f64,
}

/// Earlier and later poses, shown faintly: onion skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ghosts {
    /// Frames from one to the next; at least 1.
    pub every_frames: usize,
    /// How many behind.
    pub before: usize,
    /// How many ahead.
    pub after: usize,
}

/// A pose of an actor's motion that stands beside the figure, shown faintly: that of a neighbouring key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeyGhost {
    /// Its time in the motion, seconds.
    pub time_secs: f64,
    /// On which side of the time shown it is.
    pub side: GhostSide,
    /// How far off it is among those of its side: 0 for the nearest, below 1.
    pub distance: f32,
}

/// On which side of the time shown a ghost is. Each has a colour of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GhostSide {
    /// It is over.
    Before,
    /// It is to come.
    After,
}

/// Which joints carry their name.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum Labels {
    /// None.
    #[default]
    None,
    /// All that can turn.
    All,
    /// These.
    Of(Vec<JointId>),
}

/// What the stage is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct StageOptions {
    /// How skeletons are drawn.
    pub style: SkeletonStyle,
    /// The axes of joints.
    pub axes: AxesShown,
    /// The colours of the room.
    pub theme: Theme,
    /// Instead of the theme's background.
    pub background: Option<Background>,
    /// Where the picture is taken from.
    pub camera: CameraChoice,
    /// Whether the camera goes along.
    pub follow: Follow,
    /// Where several actors stand.
    pub arrangement: Arrangement,
    /// Paths of joints of each actor.
    pub trails: Option<Trails>,
    /// Onion skin.
    pub ghosts: Option<Ghosts>,
    /// Names of joints.
    pub labels: Labels,
    /// What the files' lengths are, for the grid's caption.
    pub unit: LengthUnit,
}

impl Default for StageOptions {
    fn default() -> Self {
        Self {
            style: SkeletonStyle::default(),
            axes: AxesShown::default(),
            theme: Theme::light(),
            background: None,
            camera: CameraChoice::View(View::ThreeQuarter),
            follow: Follow::default(),
            arrangement: Arrangement::default(),
            trails: None,
            ghosts: None,
            labels: Labels::default(),
            unit: LengthUnit::default(),
        }
    }
}
