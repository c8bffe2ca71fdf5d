//! The keys of the animation mode: everywhere in it, and with the pointer over the timeline.

use egui::{Key, Modifiers};

use super::bindings::bind;
use super::{Binding, Command, Group};

const NONE: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;
const ALT: Modifiers = Modifiers::ALT;
const CTRL_ALT: Modifiers = Modifiers::COMMAND.plus(Modifiers::ALT);
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// What can be asked of the keys in the timeline: of those that are selected, where nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeysCommand {
    /// They follow the pointer in time.
    Move,
    /// Their times follow the pointer, nearer to the playhead or farther from it.
    Scale,
    /// All are selected.
    SelectAll,
    /// None is.
    SelectNone,
    /// The next drag selects what is in a box, wherever it starts.
    BoxSelect,
    /// They are taken out.
    Delete,
    /// Copies of them follow the pointer.
    Duplicate,
    /// They are kept for pasting.
    Copy,
    /// What was copied is put in at the playhead.
    Paste,
    /// What was copied is put in at the playhead, left for right.
    PasteMirrored,
    /// They change sides.
    Mirror,
    /// The menu of interpolations is opened.
    Interpolation,
    /// The menu of tangents is opened.
    Tangents,
    /// The menu of extrapolations is opened.
    Extrapolation,
    /// All keys into view.
    ViewAll,
    /// The selected keys into view.
    ViewSelected,
    /// The playhead goes to the next key.
    NextKey,
    /// The playhead goes to the key before.
    PreviousKey,
}

const fn keys(command: KeysCommand, modifiers: Modifiers, key: Key, says: &'static str) -> Binding {
    bind(
        Command::Keys(command),
        modifiers,
        key,
        Group::Timeline,
        says,
    )
}

/// Keys that mean something else while motion is authored, or only then.
pub const ANIMATE_BINDINGS: &[Binding] = &[
    bind(
        Command::InsertKeys,
        NONE,
        Key::I,
        Group::Animate,
        "Key the selected joints",
    ),
    bind(
        Command::KeyWholePose,
        SHIFT,
        Key::I,
        Group::Animate,
        "Key the whole pose",
    ),
    bind(
        Command::LookThrough,
        NONE,
        Key::Num0,
        Group::Animate,
        "Look through the camera",
    ),
    bind(
        Command::CameraToView,
        CTRL_ALT,
        Key::Num0,
        Group::Animate,
        "Camera to view",
    ),
    bind(
        Command::DeleteThing,
        NONE,
        Key::Delete,
        Group::Animate,
        "Delete the camera, light or prop",
    ),
    bind(
        Command::Keys(KeysCommand::NextKey),
        NONE,
        Key::ArrowUp,
        Group::Animate,
        "Next key",
    ),
    bind(
        Command::Keys(KeysCommand::PreviousKey),
        NONE,
        Key::ArrowDown,
        Group::Animate,
        "Previous key",
    ),
    bind(
        Command::SaveScene,
        CTRL,
        Key::S,
        Group::Animate,
        "Save the scene",
    ),
    bind(
        Command::SaveSceneAs,
        CTRL_SHIFT,
        Key::S,
        Group::Animate,
        "Save the scene as\u{2026}",
    ),
];

/// Keys that mean something else while the pointer is over the timeline.
pub const TIMELINE_BINDINGS: &[Binding] = &[
    keys(KeysCommand::Move, NONE, Key::G, "Move in time"),
    keys(KeysCommand::Scale, NONE, Key::S, "Scale about the playhead"),
    keys(KeysCommand::SelectAll, NONE, Key::A, "Select all keys"),
    keys(KeysCommand::SelectNone, ALT, Key::A, "Select no key"),
    keys(KeysCommand::BoxSelect, NONE, Key::B, "Select in a box"),
    keys(KeysCommand::Delete, NONE, Key::X, "Delete"),
    keys(KeysCommand::Delete, NONE, Key::Delete, ""),
    keys(KeysCommand::Duplicate, SHIFT, Key::D, "Duplicate"),
    keys(KeysCommand::Copy, CTRL, Key::C, "Copy"),
    keys(KeysCommand::Paste, CTRL, Key::V, "Paste at the playhead"),
    keys(
        KeysCommand::PasteMirrored,
        CTRL_SHIFT,
        Key::V,
        "Paste left for right",
    ),
    keys(KeysCommand::Mirror, CTRL, Key::M, "Mirror left and right"),
    keys(KeysCommand::Interpolation, NONE, Key::T, "Interpolation"),
    keys(KeysCommand::Tangents, NONE, Key::V, "Tangents"),
    keys(KeysCommand::Extrapolation, SHIFT, Key::E, "Extrapolation"),
    keys(KeysCommand::ViewAll, NONE, Key::F, "All keys into view"),
    keys(KeysCommand::ViewAll, NONE, Key::Home, ""),
    keys(
        KeysCommand::ViewSelected,
        NONE,
        Key::Period,
        "Selected keys into view",
    ),
];
