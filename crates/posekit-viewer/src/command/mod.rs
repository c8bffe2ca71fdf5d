//! Commands: everything that a key, a button or a menu can ask for, and the keys that ask for it.
//!
//! Keys are Blender's where it has one. egui does not tell the number pad from the number row, so
//! both work, on laptops too.

mod animating;
mod apply;
mod bindings;
mod list;

use egui::{Key, KeyboardShortcut, Modifiers};
use posekit_render::camera::View;

pub use animating::{ANIMATE_BINDINGS, KeysCommand, TIMELINE_BINDINGS};
pub use apply::{apply, apply_to_camera};
pub use bindings::BINDINGS;
pub use list::{Line, found, lines};

use crate::gizmo::Tool;
use crate::state::mode::Mode;
use crate::state::session::{Act, Hold};

/// Something the user can ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Start or stop.
    TogglePlay,
    /// Stop, and one frame on.
    NextFrame,
    /// Stop, and one frame back.
    PreviousFrame,
    /// Stop, and ten frames on.
    TenFramesOn,
    /// Stop, and ten frames back.
    TenFramesBack,
    /// To the first frame of the range.
    GoToStart,
    /// To the last frame of the range.
    GoToEnd,
    /// To the next finding.
    NextFinding,
    /// To the finding before.
    PreviousFinding,
    /// The range starts here.
    RangeStart,
    /// The range ends here.
    RangeEnd,
    /// The range is the whole clip.
    ClearRange,
    /// Loop, or stop at the end.
    ToggleLoop,
    /// Play faster.
    Faster,
    /// Play slower.
    Slower,
    /// Look from a named side.
    Look(View),
    /// Look from the other side.
    LookBehind,
    /// A lens, or parallel rays.
    ToggleProjection,
    /// Turn the view left.
    TurnLeft,
    /// Turn the view right.
    TurnRight,
    /// Turn the view up.
    TurnUp,
    /// Turn the view down.
    TurnDown,
    /// The selected joint into the picture.
    FrameSelected,
    /// Everything into the picture.
    FrameAll,
    /// Go along with the figure, or stay.
    ToggleFollow,
    /// Nearer.
    ZoomIn,
    /// Farther.
    ZoomOut,
    /// The rest pose, or the motion.
    ToggleRest,
    /// The next drawing style.
    NextStyle,
    /// Names of joints.
    ToggleLabels,
    /// Axes of joints.
    ToggleAxes,
    /// Trails.
    ToggleTrails,
    /// Ghosts.
    ToggleGhosts,
    /// Side by side, or overlaid.
    ToggleCompare,
    /// The parent of the selected joint.
    SelectParent,
    /// The first child of the selected joint.
    SelectChild,
    /// Nothing is selected.
    Deselect,
    /// The left side: clips and joints.
    ToggleLeft,
    /// The right side: the inspector.
    ToggleRight,
    /// The curves.
    ToggleCurves,
    /// The text of the file.
    ToggleText,
    /// Light or dark.
    ToggleLook,
    /// Ask for a file.
    Open,
    /// Ask for a folder.
    OpenFolder,
    /// The picture to the clipboard.
    CopyPicture,
    /// The picture into a file.
    SavePicture,
    /// The range into a BVH file.
    SaveRange,
    /// The range into a video.
    ExportVideo,
    /// This list.
    ToggleHelp,
    /// All messages.
    ShowMessages,
    /// The window is for something else.
    Mode(Mode),
    /// The gizmo has other handles.
    Tool(Tool),
    /// What is selected follows the pointer: moved, or turned.
    TakeInHand(Act),
    /// The gizmo's axes lie otherwise.
    NextSpace,
    /// The gizmo goes in steps, or freely.
    ToggleSnap,
    /// Undo the last edit.
    Undo,
    /// Do the last edit again that was undone.
    Redo,
    /// The edited pose is kept for good.
    KeepPose,
    /// The edited pose is taken back.
    ResetPose,
    /// The view looks through a camera of the scene, or no longer.
    LookThrough,
    /// A camera of the scene takes the place of the view.
    CameraToView,
    /// What is picked is taken out of the scene.
    DeleteThing,
    /// Joints are held where they are, or no longer.
    TogglePin(Hold),
    /// The figure is brought to the target once more.
    Solve,
    /// The target goes back to where the effector is.
    ForgetTarget,
    /// One step along the solver's way; the first shows it.
    StepSolver,
    /// One step back along the solver's way.
    StepSolverBack,
    /// Keys of the pose shown, on the selected joints.
    InsertKeys,
    /// Keys of the pose shown, on all joints.
    KeyWholePose,
    /// Changed poses become keys at once, or not.
    ToggleAutoKey,
    /// The animation mode brings joints to targets, or turns them.
    ToggleUseIk,
    /// Something about the keys in the timeline.
    Keys(KeysCommand),
    /// The scene into its file.
    SaveScene,
    /// The scene into another file.
    SaveSceneAs,
}

impl Command {
    /// Whether it means the same on the stage and in the labs.
    #[must_use]
    pub const fn is_of_every_mode(self) -> bool {
        matches!(
            self,
            Self::Mode(_)
                | Self::ToggleLook
                | Self::ToggleLeft
                | Self::ToggleRight
                | Self::ToggleHelp
                | Self::ShowMessages
                | Self::Open
                | Self::OpenFolder
                | Self::CopyPicture
        )
    }
}

/// A group of keys in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Time.
    Playback,
    /// The camera.
    View,
    /// What is shown.
    Figure,
    /// Modes, and editing poses.
    Edit,
    /// While motion is authored.
    Animate,
    /// While the pointer is over the timeline.
    Timeline,
    /// Windows and files.
    Window,
    /// In the arm lab, where a key does something else there.
    ArmLab,
    /// In the interpolation lab, where a key does something else there.
    InterpolationLab,
    /// While a file is chosen in the window.
    Chooser,
}

impl Group {
    /// All groups, in the order of the list.
    pub const ALL: [Self; 10] = [
        Self::Playback,
        Self::View,
        Self::Figure,
        Self::Edit,
        Self::Animate,
        Self::Timeline,
        Self::Window,
        Self::ArmLab,
        Self::InterpolationLab,
        Self::Chooser,
    ];

    /// Its heading.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Playback => "Playback",
            Self::View => "View",
            Self::Figure => "Figure",
            Self::Edit => "Modes and editing",
            Self::Animate => "Animated clips",
            Self::Timeline => "Pointer over the timeline",
            Self::Window => "Window and files",
            Self::ArmLab => "Arm lab",
            Self::InterpolationLab => "Interpolation lab",
            Self::Chooser => "Choosing files in the window",
        }
    }

    /// Whether its keys are those of authored motion alone.
    const fn is_of_animation(self) -> bool {
        matches!(self, Self::Animate | Self::Timeline)
    }
}

/// A key and what it asks for.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// What it asks for.
    pub command: Command,
    /// The key.
    pub key: Key,
    /// What is held with it.
    pub modifiers: Modifiers,
    /// Where it stands in the list.
    pub group: Group,
    /// What it does, for the list; empty for a second key of the same command.
    pub says: &'static str,
}

impl Binding {
    /// The key as the list shows it.
    #[must_use]
    pub fn shortcut_text(&self, mac: bool) -> String {
        let names = if mac {
            egui::ModifierNames::SYMBOLS
        } else {
            egui::ModifierNames::NAMES
        };
        let key = match self.key {
            Key::Questionmark => return "?".to_owned(),
            key => key,
        };
        let text = KeyboardShortcut::new(self.modifiers, key).format(&names, mac);
        // A key is named as it is written on it.
        let written = [
            ("ArrowRight", "\u{2192}"),
            ("ArrowLeft", "\u{2190}"),
            ("ArrowUp", "\u{2191}"),
            ("ArrowDown", "\u{2193}"),
            ("OpenBracket", "["),
            ("CloseBracket", "]"),
            ("Period", "."),
            ("Plus", "+"),
            ("Minus", "-"),
            ("Equals", "="),
            ("Slash", "/"),
        ];
        let named = |text: String, (name, sign): (&str, &str)| text.replace(name, sign);
        written.into_iter().fold(text, named)
    }
}

/// The first key of a command, as a tooltip shows it.
#[must_use]
pub fn shortcut_of(command: Command, mac: bool) -> Option<String> {
    let all = [BINDINGS, ANIMATE_BINDINGS, TIMELINE_BINDINGS];
    let mut bindings = all.into_iter().flatten();
    let binding = bindings.find(|binding| binding.command == command)?;
    Some(binding.shortcut_text(mac))
}

/// Whether keys are named as on a Mac.
#[must_use]
pub const fn is_mac() -> bool {
    cfg!(target_os = "macos")
}

/// Where keys are pressed: the same key may mean something else there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Place {
    /// Where it means what the list says first.
    #[default]
    Anywhere,
    /// While motion is authored.
    Animate,
    /// While motion is authored, with the pointer over the timeline.
    Timeline,
}

impl Place {
    /// All places.
    pub const ALL: [Self; 3] = [Self::Anywhere, Self::Animate, Self::Timeline];

    /// The keys that are looked for, in that order.
    fn bindings(self) -> impl Iterator<Item = &'static Binding> {
        let own: [&[Binding]; 2] = match self {
            Self::Anywhere => [&[], &[]],
            Self::Animate => [&[], ANIMATE_BINDINGS],
            Self::Timeline => [TIMELINE_BINDINGS, ANIMATE_BINDINGS],
        };
        own.into_iter().flatten().chain(BINDINGS)
    }
}

/// The commands whose keys were pressed just now, in the order in which they were; the keys are taken.
#[must_use]
pub fn pressed(input: &mut egui::InputState, place: Place) -> Vec<Command> {
    pressed_of(input, place, |_| true)
}

/// As [`pressed`], of those commands that are wanted; the keys of the others are left to whoever comes next.
#[must_use]
pub fn pressed_of(
    input: &mut egui::InputState,
    place: Place,
    is_wanted: impl Fn(Command) -> bool,
) -> Vec<Command> {
    let mut commands = Vec::new();
    input.events.retain(|event| {
        let egui::Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } = event
        else {
            return true;
        };
        // What was held when the key went down: by now it may be let go again.
        let asked = place.bindings().find(|b| b.is_meant(*key, *modifiers));
        let asked = asked.filter(|binding| is_wanted(binding.command));
        commands.extend(asked.map(|binding| binding.command));
        asked.is_none()
    });
    commands
}

impl Binding {
    /// Whether a key with what was held beside it is this one.
    fn is_meant(&self, key: Key, held: Modifiers) -> bool {
        // Where the character itself needs shift on some keyboards, shift says nothing.
        let typed_with_shift = matches!(self.key, Key::Plus | Key::Questionmark);
        self.key == key
            && (typed_with_shift || held.shift == self.modifiers.shift)
            && held.alt == self.modifiers.alt
            && held.command == self.modifiers.command
    }
}
