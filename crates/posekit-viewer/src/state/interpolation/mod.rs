//! The interpolation lab: ways between orientations side by side, and the same ways on a real clip.
//!
//! It has keys that are set by angles or by hand, a clock of its own that runs along the way between them,
//! and what every method makes of them. It knows no widget and no window. Angles are degrees in the lists and
//! on the screen, as in `posekit slerp`.

pub mod body;
pub mod case;
pub mod clip;
pub mod colors;
pub mod kind;
pub mod layout;
pub mod playback;
pub mod scene;
pub mod ways;

use std::collections::{BTreeMap, BTreeSet};

use egui::{Pos2, Vec2};
use glam::{DQuat, DVec3};
use posekit::inbetween::{Method, Preset};
use posekit::rotation::{Axis, EulerOrder};
use posekit_render::camera::{Camera, View};
use posekit_render::scene::Scene;

use crate::gizmo::{Drag, Gizmo, Handle, Placement, Snap, Tool, Viewport};
use crate::state::camera::ViewCamera;
use crate::state::display::Look;
use crate::state::mode::{Space, TURN_STEP_DEG};
use case::LabPreset;
use kind::{LostTurn, lost_turn};

pub use case::Case;
pub use clip::ClipLab;
pub use kind::Kind;
pub use layout::Layout;
pub use playback::Playback;
pub use ways::{Now, Span, Way};

/// What is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Page {
    /// Two orientations, or a row of keys.
    #[default]
    Orientations,
    /// A real clip of which only some frames are kept.
    Clip,
}

/// How the methods are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Picture {
    /// A body each.
    #[default]
    SideBySide,
    /// All bodies in one place.
    Overlaid,
    /// The paths of an axis' tip on the sphere of directions.
    Sphere,
}

impl Picture {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 3] = [Self::SideBySide, Self::Overlaid, Self::Sphere];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SideBySide => "Side by side",
            Self::Overlaid => "Overlaid",
            Self::Sphere => "Sphere",
        }
    }

    /// What it shows.
    #[must_use]
    pub const fn says(self) -> &'static str {
        match self {
            Self::SideBySide => "A body for each method, all at the same share of the way",
            Self::Overlaid => "All bodies in one place, each in its method's colour",
            Self::Sphere => "The path of the tip of one of the body's axes",
        }
    }
}

/// Methods that are shown first: one of each kind.
const FIRST_SHOWN: [Method; 8] = [
    Method::Slerp,
    Method::Nlerp,
    Method::RawLerp,
    Method::Matrix,
    Method::RotationVector,
    Method::Euler(EulerOrder::XYZ),
    Method::Euler(EulerOrder::ZXY),
    Method::Squad,
];

/// So many steps can be taken back.
const MOST_STEPS: usize = 1000;

/// A ring that is held with the pointer.
#[derive(Clone, Debug)]
struct Held {
    drag: Drag,
    end: usize,
    before: Case,
}

/// The lab.
#[derive(Debug)]
pub struct InterpolationLab {
    case: Case,
    undo: Vec<Case>,
    redo: Vec<Case>,
    shown: BTreeSet<Kind>,
    span: Span,
    picture: Picture,
    tip: Axis,
    page: Page,
    space: Space,
    snaps: bool,
    held: Option<Held>,
    ways: BTreeMap<Kind, Way>,
    view_size: Vec2,
    /// How much of the view its tools take at the top, points.
    tools_height: f32,
    version: u64,
    /// The lab's clock.
    pub playback: Playback,
    /// Where the bodies are looked at from.
    pub camera: ViewCamera,
    /// The comparison on a clip.
    pub clip: ClipLab,
}

impl Default for InterpolationLab {
    fn default() -> Self {
        let mut camera = ViewCamera::default();
        // Bodies side by side are seen from one direction only with parallel rays.
        camera.toggle_projection();
        Self {
            case: Case::default(),
            undo: Vec::new(),
            redo: Vec::new(),
            shown: FIRST_SHOWN.map(Kind::Between).into_iter().collect(),
            span: Span::default(),
            picture: Picture::default(),
            tip: Axis::Z,
            page: Page::default(),
            space: Space::World,
            snaps: false,
            held: None,
            ways: BTreeMap::new(),
            view_size: Vec2::new(800.0, 500.0),
            tools_height: 40.0,
            version: 0,
            playback: Playback::default(),
            camera,
            clip: ClipLab::default(),
        }
    }
}

impl InterpolationLab {
    /// The orientations.
    #[must_use]
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// Changes the orientations. What is dragged with the pointer is one step: see
    /// [`begin_step`](Self::begin_step).
    pub fn change(&mut self, change: impl FnOnce(&mut Case)) {
        let before = self.case.clone();
        change(&mut self.case);
        if self.case != before {
            self.changed();
        }
    }

    fn changed(&mut self) {
        self.ways.clear();
        self.version += 1;
        if self.case.gap_count() == 1 {
            self.span = Span::Pair;
        }
        self.playback.set_length(self.span.length(&self.case));
    }

    /// Puts the orientations of a preset in; all keys are looked at where there are many.
    pub fn take_preset(&mut self, preset: impl Into<LabPreset>) {
        let preset = preset.into();
        self.cancel_drag();
        self.begin_step();
        self.case = Case::of_preset(preset);
        self.span = if self.case.gap_count() > 1 {
            Span::AllKeys
        } else {
            Span::Pair
        };
        match preset {
            LabPreset::OfCommand(Preset::LongWay) => {
                self.shown.insert(Method::RawSlerp.into());
            }
            LabPreset::WholeTurns => {
                self.shown.insert(Kind::Curves);
            }
            LabPreset::OfCommand(_) => {}
        }
        self.changed();
    }

    /// Remembers the orientations, as a step that can be taken back.
    pub fn begin_step(&mut self) {
        if self.undo.last() == Some(&self.case) {
            return;
        }
        self.undo.push(self.case.clone());
        if self.undo.len() > MOST_STEPS {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Whether there is a step to take back, and one to take again.
    #[must_use]
    pub fn can_undo_redo(&self) -> (bool, bool) {
        let has_undo = self.undo.iter().any(|before| *before != self.case);
        (has_undo, !self.redo.is_empty())
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        self.cancel_drag();
        while let Some(before) = self.undo.pop() {
            // A step that was begun and changed nothing is none.
            if before != self.case {
                let now = std::mem::replace(&mut self.case, before);
                self.redo.push(now);
                self.changed();
                return;
            }
        }
    }

    /// Takes a step again that was taken back.
    pub fn redo(&mut self) {
        self.cancel_drag();
        if let Some(case) = self.redo.pop() {
            let now = std::mem::replace(&mut self.case, case);
            self.undo.push(now);
            self.changed();
        }
    }

    /// How much of the keys is looked at.
    #[must_use]
    pub fn span(&self) -> Span {
        self.span
    }

    /// Chooses how much of the keys is looked at.
    pub fn set_span(&mut self, span: Span) {
        if self.span != span {
            self.span = span;
            self.changed();
        }
    }

    /// What is shown, in the order of [`Kind::all`].
    pub fn shown(&self) -> impl Iterator<Item = Kind> + '_ {
        Kind::all().filter(|kind| self.shown.contains(kind))
    }

    /// Whether a method, or curves, are shown.
    #[must_use]
    pub fn is_shown(&self, kind: impl Into<Kind>) -> bool {
        self.shown.contains(&kind.into())
    }

    /// Shows a method, or curves, or no longer.
    pub fn set_shown(&mut self, kind: impl Into<Kind>, is_shown: bool) {
        let kind = kind.into();
        let has_changed = match is_shown {
            true => self.shown.insert(kind),
            false => self.shown.remove(&kind),
        };
        self.version += u64::from(has_changed);
    }

    /// How the methods are shown.
    #[must_use]
    pub fn picture(&self) -> Picture {
        self.picture
    }

    /// Chooses how the methods are shown.
    pub fn set_picture(&mut self, picture: Picture) {
        self.version += u64::from(self.picture != picture);
        self.picture = picture;
    }

    /// The axis of the body whose tip's path is drawn.
    #[must_use]
    pub fn tip(&self) -> Axis {
        self.tip
    }

    /// Chooses the axis whose tip's path is drawn.
    pub fn set_tip(&mut self, tip: Axis) {
        self.version += u64::from(self.tip != tip);
        self.tip = tip;
    }

    /// The direction of that axis in the body.
    #[must_use]
    pub fn tip_in_body(&self) -> DVec3 {
        self.tip.unit()
    }

    /// What is compared.
    #[must_use]
    pub fn page(&self) -> Page {
        self.page
    }

    /// Chooses what is compared.
    pub fn set_page(&mut self, page: Page) {
        self.cancel_drag();
        self.page = page;
    }

    /// How the rings' axes lie: as the world's, or as the body's.
    #[must_use]
    pub fn space(&self) -> Space {
        self.space
    }

    /// Chooses how the rings' axes lie.
    pub fn set_space(&mut self, space: Space) {
        self.space = space;
    }

    /// Whether the rings go in steps without Ctrl.
    #[must_use]
    pub fn snaps(&self) -> bool {
        self.snaps
    }

    /// Sets whether the rings go in steps.
    pub fn set_snaps(&mut self, snaps: bool) {
        self.snaps = snaps;
    }

    /// The steps that the rings go in.
    #[must_use]
    pub fn snap(&self) -> Snap {
        Snap {
            length: 1.0,
            angle_rad: TURN_STEP_DEG.to_radians(),
        }
    }

    /// A number that changes whenever what is seen does, the clock and the camera aside.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Works out the ways of all methods that are not known yet: some milliseconds.
    pub fn measure(&mut self) {
        let (case, span) = (&self.case, self.span);
        for kind in Kind::all() {
            self.ways
                .entry(kind)
                .or_insert_with(|| Way::new(kind, case, span));
        }
    }

    /// A method's way, once it was measured.
    #[must_use]
    pub fn way(&self, kind: impl Into<Kind>) -> Option<&Way> {
        self.ways.get(&kind.into())
    }

    /// The ways of what is shown, in the order of [`Kind::all`].
    pub fn ways(&self) -> impl Iterator<Item = &Way> + '_ {
        self.shown().filter_map(|kind| self.ways.get(&kind))
    }

    /// Where a method is now, or the curves.
    #[must_use]
    pub fn now(&self, kind: impl Into<Kind>) -> Now {
        let place = self.span.place(&self.case, self.playback.share());
        ways::now(kind.into(), &self.case, place)
    }

    /// What was asked for in the keys that are looked at and no orientation can hold, gap by gap.
    pub fn lost_turns(&self) -> impl Iterator<Item = LostTurn> + '_ {
        let gaps = match self.span {
            Span::Pair => self.case.gap()..self.case.gap() + 1,
            Span::AllKeys => 0..self.case.gap_count(),
        };
        gaps.filter_map(|gap| lost_turn(&self.case, gap))
    }

    /// The keys whose bodies can be turned: the start and the end.
    #[must_use]
    pub fn ends(&self) -> [usize; 2] {
        [self.case.gap(), self.case.gap() + 1]
    }

    /// Tells the size of the view, points.
    pub fn set_view_size(&mut self, size: Vec2) {
        if size.x >= 2.0 && size.y >= 2.0 && self.view_size != size {
            self.view_size = size;
            self.version += 1;
        }
    }

    /// Tells how much of the view its tools take at the top, points.
    pub fn set_tools_height(&mut self, height: f32) {
        if (self.tools_height - height).abs() > 0.5 {
            self.tools_height = height;
            self.version += 1;
        }
    }

    /// Where things are in the view.
    #[must_use]
    pub fn layout(&self) -> Layout {
        let count = self.shown.len();
        Layout::new(self.view_size, self.tools_height, count, self.picture)
    }

    /// The camera now.
    #[must_use]
    pub fn view_camera(&self) -> Camera {
        self.camera.still().camera()
    }

    /// Looks from a named side.
    pub fn look_from(&mut self, view: View) {
        let (yaw_rad, pitch_rad) = view.yaw_pitch_rad(0.0);
        let around = [glam::Vec3::ZERO, glam::Vec3::Y];
        self.camera
            .frame_points(&around, (yaw_rad, pitch_rad), 1.0, 1.0);
    }

    /// The scene now.
    #[must_use]
    pub fn scene(&self, look: Look) -> Scene {
        scene::scene(self, look)
    }

    /// Where the tip of an end's axis is on the sphere of directions, in the scene: 0 is the start, 1 the end.
    #[must_use]
    pub fn tip_on_sphere(&self, end: usize) -> glam::Vec3 {
        scene::tip_on_sphere(self, end)
    }

    /// The rings of an end's body: 0 is the start, 1 the end.
    #[must_use]
    pub fn gizmo(&self, end: usize) -> Gizmo {
        if let Some(held) = self.held.as_ref().filter(|held| held.end == end) {
            return *held.drag.gizmo();
        }
        let layout = self.layout();
        let turned = self.case.rotation(self.ends()[end]);
        Gizmo {
            position: layout.world(&self.view_camera(), layout.ends[end].center()),
            axes: match self.space {
                Space::Local => turned.as_quat(),
                Space::Parent | Space::World => glam::Quat::IDENTITY,
            },
            tool: Tool::Turn,
        }
    }

    /// Whether a ring is held.
    #[must_use]
    pub fn is_dragging(&self) -> bool {
        self.held.is_some()
    }

    /// The drag of the ring that is held, and whose it is.
    #[must_use]
    pub fn drag(&self) -> Option<(usize, &Drag)> {
        self.held.as_ref().map(|held| (held.end, &held.drag))
    }

    /// Takes a ring of an end's body. False when it cannot be taken in this view.
    pub fn grab(&mut self, end: usize, handle: Handle, pointer: Pos2, viewport: &Viewport) -> bool {
        let gizmo = self.gizmo(end);
        let start = Placement {
            position: gizmo.position,
            orientation: self.case.rotation(self.ends()[end]).as_quat(),
        };
        let Some(drag) = Drag::begin(gizmo, handle, start, pointer, viewport) else {
            return false;
        };
        self.held = Some(Held {
            drag,
            end,
            before: self.case.clone(),
        });
        true
    }

    /// Follows the pointer with the ring that is held. True when that turned something.
    pub fn drag_to(&mut self, pointer: Pos2, viewport: &Viewport, snap: Option<Snap>) -> bool {
        let Some(mut held) = self.held.take() else {
            return false;
        };
        let before = held.drag.placement();
        let placement = held.drag.update(pointer, viewport, snap);
        let has_moved = placement != before;
        if has_moved {
            let key = self.ends()[held.end];
            // The turn alone comes from the screen; what it turns keeps its digits.
            let start = held.before.rotation(key);
            let from = start.as_quat();
            let turn: DQuat = (placement.orientation * from.conjugate())
                .as_dquat()
                .normalize();
            self.change(|case| case.set_rotation(key, turn * start));
        }
        self.held = Some(held);
        has_moved
    }

    /// Lets the ring go: what it did is a step.
    pub fn drop_handle(&mut self) {
        if let Some(held) = self.held.take()
            && held.before != self.case
        {
            let now = std::mem::replace(&mut self.case, held.before);
            self.begin_step();
            self.case = now;
        }
    }

    /// Lets the ring go without effect. True when one was held.
    pub fn cancel_drag(&mut self) -> bool {
        let Some(held) = self.held.take() else {
            return false;
        };
        self.case = held.before;
        self.changed();
        true
    }

    /// The command that shows the same.
    #[must_use]
    pub fn command(&self) -> String {
        let methods: Vec<Method> = self.shown().filter_map(Kind::method).collect();
        self.case.command(&methods, ways::STEPS)
    }

    /// The numbers of the shown methods between start and end, as `posekit slerp --csv` prints them.
    #[must_use]
    pub fn numbers(&self) -> String {
        let methods: Vec<Method> = self.shown().filter_map(Kind::method).collect();
        posekit_formats::ways::csv(&self.case.ends(self.case.gap()), &methods, ways::STEPS)
    }
}
