//! Cameras, lights and props in the session: which one is picked, setting and keying them, looking
//! through a camera.
//!
//! As with poses: with auto-key a new value becomes a key at once. Without it a property that is not
//! keyed takes the value for good, and one that is keyed shows it until it is keyed or another time is
//! shown.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use egui::Pos2;
use glam::{DVec3, Quat, Vec3};
use posekit::keyframe::edit::SAME_TIME_SECS;
use posekit_formats::scene::Scene;
use posekit_render::camera::{Camera, Projection};
use posekit_render::stage::{LIGHT_FULL_AT, Surroundings, keyed_camera};

use super::{Handles, Session};
use crate::gizmo::{Drag, Gizmo, Handle, Placement, Snap, Tool, Viewport};
use crate::state::animate::{KeyId, Lane, LaneValue, Owner};
use crate::state::edit::Gesture;
use crate::state::mode::{Mode, Space};
use crate::state::things::{
    self, Kind, Part, Picked, Symbol, exists, keyed, set_fixed, unkeyed, with_values,
};

/// The shape of a shot's picture, unless something else is said.
const FRAME_ASPECT: f32 = 16.0 / 9.0;

/// How much of the view the frame of a camera fills.
const FRAME_SHARE: f32 = 0.92;

/// The side of a new prop, in statures.
const PROP_SIDE: f32 = 0.3;

/// Where in the view a new light is, in thousandths from the left and from the top.
const LIGHT_IN_VIEW: (f32, f32) = (250.0, 220.0);

/// All of a session that is about cameras, lights and props.
#[derive(Debug)]
pub(super) struct Things {
    picked: Option<Picked>,
    pending: Option<PendingValues>,
    held: Option<Held>,
    looks_through: Option<usize>,
    frame_aspect: f32,
}

impl Default for Things {
    fn default() -> Self {
        Self {
            picked: None,
            pending: None,
            held: None,
            looks_through: None,
            frame_aspect: FRAME_ASPECT,
        }
    }
}

/// Values that were set and are not keyed yet.
#[derive(Clone, Debug)]
struct PendingValues {
    time_secs: f64,
    values: BTreeMap<Lane, LaneValue>,
}

/// A thing that is held by a handle of the gizmo.
#[derive(Clone, Debug)]
struct Held {
    drag: Drag,
    picked: Picked,
    /// What was set before, to fall back to.
    before: Option<PendingValues>,
}

/// What of a property is keyed, as its key button shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyState {
    /// It has no keys.
    Unkeyed,
    /// It has keys, none at the time shown.
    Keyed,
    /// It has a key at the time shown.
    KeyHere,
    /// It was set to a value that is not keyed.
    Changed,
}

impl Session {
    /// The camera, light or prop that is picked.
    #[must_use]
    pub fn picked(&self) -> Option<Picked> {
        let picked = self.things.picked.filter(|_| self.shows_things())?;
        exists(self.authored()?.scene(), picked.owner).then_some(picked)
    }

    /// Picks a camera, light or prop; joints are deselected. `None` picks nothing.
    pub fn pick(&mut self, picked: Option<Picked>) {
        self.stop_editing();
        if picked.is_some() {
            self.select(None);
        }
        self.things.picked = picked;
    }

    /// Something else is selected.
    pub(super) fn forget_picked(&mut self) {
        self.things.picked = None;
    }

    /// Whether cameras and lights are drawn on the stage, and can be picked.
    #[must_use]
    pub fn shows_things(&self) -> bool {
        self.mode() == Mode::Animate && self.authored().is_some()
    }

    /// The scene of the active clip with values that are not keyed yet.
    #[must_use]
    pub fn scene_shown(&self) -> Option<Cow<'_, Scene>> {
        let scene = self.authored()?.scene();
        let Some(pending) = &self.things.pending else {
            return Some(Cow::Borrowed(scene));
        };
        let values = pending.values.iter().map(|(lane, value)| (*lane, *value));
        Some(Cow::Owned(with_values(scene, values)))
    }

    /// Cameras, lights and props as they stand now.
    #[must_use]
    pub fn symbols(&self) -> Vec<Symbol> {
        let Some(scene) = self.scene_shown().filter(|_| self.shows_things()) else {
            return Vec::new();
        };
        things::symbols(&scene, self.scene_secs(), self.stage.stature())
    }

    /// What a property is now: set and not keyed, or as the scene says.
    #[must_use]
    pub fn value_of(&self, lane: Lane) -> Option<LaneValue> {
        let pending = self.things.pending.as_ref();
        let set = pending.and_then(|pending| pending.values.get(&lane));
        match set {
            Some(value) => Some(*value),
            None => self.authored()?.value_at(lane, self.scene_secs()),
        }
    }

    /// What of a property is keyed.
    #[must_use]
    pub fn key_state(&self, lane: Lane) -> KeyState {
        let pending = self.things.pending.as_ref();
        if pending.is_some_and(|pending| pending.values.contains_key(&lane)) {
            return KeyState::Changed;
        }
        let Some(track) = self.authored().and_then(|authored| authored.track(lane)) else {
            return KeyState::Unkeyed;
        };
        match index_at(track.times_secs(), self.key_time()) {
            Some(_) => KeyState::KeyHere,
            None => KeyState::Keyed,
        }
    }

    /// Whether something was set that is not keyed.
    #[must_use]
    pub fn has_pending_values(&self) -> bool {
        self.things.pending.is_some()
    }

    /// Sets properties, as keys or for good; see the module. All of one `gesture` is one step.
    pub fn set_values(
        &mut self,
        name: &str,
        values: &[(Lane, LaneValue)],
        gesture: Option<Gesture>,
    ) {
        self.transport.pause();
        let is_new = |(lane, value): &&(Lane, LaneValue)| self.value_of(*lane) != Some(*value);
        let values: Vec<(Lane, LaneValue)> = values.iter().filter(is_new).copied().collect();
        if values.is_empty() {
            return;
        }
        if self.animate().auto_key {
            self.put_keys(name, &values, gesture);
            return;
        }
        let is_keyed = |lane: Lane| self.authored().is_some_and(|it| it.track(lane).is_some());
        let (keyed, fixed): (Vec<_>, Vec<_>) =
            values.into_iter().partition(|(lane, _)| is_keyed(*lane));
        if !fixed.is_empty() {
            self.author(|authored| {
                let set = |scene: &mut Scene| {
                    for (lane, value) in fixed {
                        set_fixed(scene, lane, value);
                    }
                };
                // Values of cameras, lights and props always fit.
                let _ = authored.edit_scene(name, gesture, set);
            });
        }
        if !keyed.is_empty() {
            self.hold_values(keyed);
        }
    }

    /// Shows values that are not keyed.
    fn hold_values(&mut self, values: Vec<(Lane, LaneValue)>) {
        let time_secs = self.transport.time_secs();
        let pending = self.things.pending.get_or_insert_with(|| PendingValues {
            time_secs,
            values: BTreeMap::new(),
        });
        pending.values.extend(values);
        self.surround();
    }

    /// Keys at the time shown.
    fn put_keys(&mut self, name: &str, values: &[(Lane, LaneValue)], gesture: Option<Gesture>) {
        let time_secs = self.key_time();
        let interpolation = self.animate().interpolation;
        self.author(|authored| {
            let mut changes = Vec::new();
            let mut selection = BTreeSet::new();
            for &(lane, value) in values {
                let made = keyed(authored.track(lane), value, time_secs, interpolation);
                let Some(track) = made else { continue };
                let index = index_at(track.as_track().times_secs(), time_secs);
                selection.extend(index.map(|index| KeyId { lane, index }));
                changes.push((lane, Some(track)));
            }
            authored.set_tracks(name, gesture, changes, selection);
        });
        if let Some(pending) = &mut self.things.pending {
            for (lane, _) in values {
                pending.values.remove(lane);
            }
            if pending.values.is_empty() {
                self.things.pending = None;
            }
        }
        self.surround();
    }

    /// Keys a property as it is shown, or takes the key at the time shown away.
    pub fn toggle_key(&mut self, lane: Lane) {
        self.transport.pause();
        let what = lane.property().to_lowercase();
        if self.key_state(lane) != KeyState::KeyHere {
            if let Some(value) = self.value_of(lane) {
                self.put_keys(&format!("Key {what}"), &[(lane, value)], None);
            }
            return;
        }
        let time_secs = self.key_time();
        self.author(|authored| {
            let Some(track) = authored.track(lane) else {
                return;
            };
            let index = index_at(track.times_secs(), time_secs);
            let Some(rest) = index.map(|index| unkeyed(track, index)) else {
                return;
            };
            let name = format!("Delete the key of {what}");
            authored.set_tracks(&name, None, vec![(lane, rest)], BTreeSet::new());
        });
    }

    /// Keys what is picked: what was set, else what is keyed already, else all of it. How many
    /// properties got a key; `None` when nothing is picked.
    pub(super) fn key_picked(&mut self) -> Option<usize> {
        let owner = self.picked()?.owner;
        let lanes = owner.lanes();
        let of_state = |states: &[KeyState]| -> Vec<Lane> {
            let has = |lane: &Lane| states.contains(&self.key_state(*lane));
            lanes.iter().copied().filter(has).collect()
        };
        let changed = of_state(&[KeyState::Changed]);
        let keyed = of_state(&[KeyState::Keyed, KeyState::KeyHere]);
        let chosen = [changed, keyed, lanes.clone()]
            .into_iter()
            .find(|lanes| !lanes.is_empty())?;
        let value = |lane: Lane| Some((lane, self.value_of(lane)?));
        let values: Vec<(Lane, LaneValue)> = chosen.into_iter().filter_map(value).collect();
        let authored = self.authored()?;
        let name = owner.name(authored.scene(), authored.skeleton());
        self.put_keys(&format!("Key {}", name.to_lowercase()), &values, None);
        Some(values.len())
    }

    /// Gives values up that are not keyed. True when there were any.
    pub(super) fn drop_pending_values(&mut self) -> bool {
        let had = self.things.pending.take().is_some();
        if had {
            self.surround();
        }
        had
    }

    /// Values that are not keyed are gone when another time is shown.
    pub(super) fn follow_time_of_values(&mut self) {
        let now = self.transport.time_secs();
        let pending = self.things.pending.as_ref();
        if pending.is_some_and(|pending| (pending.time_secs - now).abs() > 1e-9) {
            self.drop_pending_values();
        }
    }

    /// Another clip is the active one, or its scene is gone.
    pub(super) fn forget_things(&mut self) {
        self.things = Things {
            frame_aspect: self.things.frame_aspect,
            ..Things::default()
        };
        self.surround();
    }

    /// Puts the lights and props of the active clip around the stage, as they are now.
    pub(super) fn surround(&mut self) {
        let surroundings = self
            .scene_shown()
            .map_or_else(Surroundings::default, |scene| things::surroundings(&scene));
        self.stage.set_surroundings(surroundings);
        self.stage_version += 1;
    }

    /// Adds a thing and picks it: a camera where the view is, a light over the viewer's left shoulder, a
    /// prop on the floor beside the figure.
    pub fn add_thing(&mut self, what: NewThing) {
        self.transport.pause();
        let kind = self.new_thing(what);
        let name = format!("Add a {}", what.name().to_lowercase());
        let added = self.author(|authored| {
            let mut owner = None;
            let _ =
                authored.edit_scene(&name, None, |scene| owner = Some(things::add(scene, kind)));
            owner
        });
        if let Some(owner) = added.flatten() {
            self.pick(Some(Picked::body(owner)));
        }
    }

    fn new_thing(&self, what: NewThing) -> Kind {
        let view = self.view_camera();
        let stature = self.stage.stature();
        let floor = self.stage.ground_height();
        let focus = view.target;
        match what {
            NewThing::Camera => Kind::Camera {
                position: tidy(view.eye),
                target: tidy(focus),
                fov_deg: rounded(match view.projection {
                    Projection::Perspective { vertical_fov_rad } => vertical_fov_rad.to_degrees(),
                    Projection::Orthographic { .. } => 40.0,
                }),
            },
            NewThing::Light => {
                // In sight, at the upper left, nearer than the figure.
                let (origin, direction) = view.ray(LIGHT_IN_VIEW, (1000, 1000));
                let depth = 0.75 * view.eye.distance(focus);
                let position = round(origin + direction * depth, stature);
                let full_at = f64::from(LIGHT_FULL_AT * stature);
                let strength = (position.distance(focus.as_dvec3()) / full_at).powi(2);
                Kind::Light {
                    position,
                    strength: (strength.clamp(0.05, 100.0) * 100.0).round() / 100.0,
                }
            }
            NewThing::Box | NewThing::Sphere => {
                let side = PROP_SIDE * stature;
                let (right, _, _) = view.axes();
                let mut at = focus + right * (0.6 * stature);
                at.y = floor + 0.5 * side;
                let (at, side) = (tidy(at), tidy(Vec3::splat(side)).x);
                match what {
                    NewThing::Sphere => Kind::Sphere { at, side },
                    _ => Kind::Box { at, side },
                }
            }
        }
    }

    /// Takes a thing out of the scene.
    pub fn remove_thing(&mut self, owner: Owner) {
        self.stop_editing();
        self.drop_pending_values();
        let Some(name) = self.name_of(owner) else {
            return;
        };
        self.things.looks_through = match (owner, self.things.looks_through) {
            (Owner::Camera(gone), Some(index)) if gone == index => None,
            (Owner::Camera(gone), Some(index)) if gone < index => Some(index - 1),
            (_, looks_through) => looks_through,
        };
        self.things.picked = None;
        self.author(|authored| {
            let name = format!("Delete {}", name.to_lowercase());
            let _ = authored.edit_scene(&name, None, |scene| things::remove(scene, owner));
            // The lanes of those after it are others now.
            authored.select(BTreeSet::new());
        });
    }

    /// Gives a thing another name.
    pub fn rename_thing(&mut self, owner: Owner, name: &str) {
        self.author(|authored| {
            let step = format!("Rename to {name}");
            let _ = authored.edit_scene(&step, None, |scene| things::rename(scene, owner, name));
        });
    }

    /// What a thing is called, with its kind; `None` where there is no such thing.
    #[must_use]
    pub fn name_of(&self, owner: Owner) -> Option<String> {
        let authored = self.authored()?;
        let scene = authored.scene();
        exists(scene, owner).then(|| owner.name(scene, authored.skeleton()))
    }

    // --- The gizmo on a thing ---

    /// The gizmo of what is picked.
    pub(super) fn thing_gizmo(&self) -> Option<Gizmo> {
        let picked = self.picked().filter(|_| self.handles() != Handles::None)?;
        let placement = self.placement_of(picked)?;
        let is_prop = matches!(picked.owner, Owner::Prop(_));
        let is_local = *self.tools().space_with(Handles::Joints) == Space::Local;
        Some(Gizmo {
            position: placement.position,
            axes: if is_prop && is_local {
                placement.orientation
            } else {
                Quat::IDENTITY
            },
            tool: if is_prop {
                Tool::MoveAndTurn
            } else {
                Tool::Move
            },
        })
    }

    /// Where what is picked stands.
    pub(super) fn picked_place(&self) -> Option<Vec3> {
        Some(self.placement_of(self.picked()?)?.position)
    }

    fn placement_of(&self, picked: Picked) -> Option<Placement> {
        let LaneValue::Vector(position) = self.value_of(picked.lane()?)? else {
            return None;
        };
        let orientation = match picked.owner {
            Owner::Prop(index) => match self.value_of(Lane::PropRotation(index))? {
                LaneValue::Orientation(orientation) => orientation.as_quat().normalize(),
                _ => return None,
            },
            _ => Quat::IDENTITY,
        };
        let placement = Placement {
            position: position.as_vec3(),
            orientation,
        };
        placement.position.is_finite().then_some(placement)
    }

    /// The drag of a thing that is held.
    pub(super) fn thing_drag(&self) -> Option<&Drag> {
        self.things.held.as_ref().map(|held| &held.drag)
    }

    /// Takes a handle of the gizmo on a thing. `None` when nothing is picked.
    pub(super) fn grab_thing(
        &mut self,
        handle: Handle,
        pointer: Pos2,
        viewport: &Viewport,
    ) -> Option<bool> {
        let picked = self.picked()?;
        let taken = self.thing_gizmo().zip(self.placement_of(picked));
        let drag =
            taken.and_then(|(gizmo, start)| Drag::begin(gizmo, handle, start, pointer, viewport));
        let Some(drag) = drag else {
            return Some(false);
        };
        self.things.held = Some(Held {
            drag,
            picked,
            before: self.things.pending.clone(),
        });
        Some(true)
    }

    /// Follows the pointer with a thing that is held. False when none is.
    pub(super) fn drag_thing(
        &mut self,
        pointer: Pos2,
        viewport: &Viewport,
        snap: Option<Snap>,
    ) -> bool {
        let Some(mut held) = self.things.held.take() else {
            return false;
        };
        let before = held.drag.placement();
        let placement = held.drag.update(pointer, viewport, snap);
        if placement != before {
            self.hold_values(values_at(&held, placement));
        }
        self.things.held = Some(held);
        true
    }

    /// Lets a thing go that is held: where it is now is set. False when none is.
    pub(super) fn drop_thing(&mut self) -> bool {
        let Some(held) = self.things.held.take() else {
            return false;
        };
        let values = values_at(&held, held.drag.placement());
        self.things.pending = held.before;
        let verb = if held.drag.handle().turns() {
            "Turn"
        } else {
            "Move"
        };
        let name = self.name_of(held.picked.owner).unwrap_or_default();
        let of = match held.picked.part {
            Part::Body => name.to_lowercase(),
            Part::Target => format!("the target of {}", name.to_lowercase()),
        };
        self.set_values(&format!("{verb} {of}"), &values, None);
        self.surround();
        true
    }

    /// Lets a thing go without effect. True when one was held.
    pub(super) fn cancel_thing(&mut self) -> bool {
        let Some(held) = self.things.held.take() else {
            return false;
        };
        self.things.pending = held.before;
        self.surround();
        true
    }

    // --- Looking through a camera ---

    /// Which camera of the scene the view looks through.
    #[must_use]
    pub fn looks_through(&self) -> Option<usize> {
        let cameras = self.authored()?.scene().cameras.len();
        self.things.looks_through.filter(|index| *index < cameras)
    }

    /// Looks through a camera of the scene; `None` goes back to where the view was.
    pub fn look_through(&mut self, camera: Option<usize>) {
        self.things.looks_through = camera;
    }

    /// Looks through the camera that is picked, else through the first; no longer, when it does.
    pub fn toggle_look_through(&mut self) {
        let picked = match self.picked().map(|picked| picked.owner) {
            Some(Owner::Camera(index)) => Some(index),
            _ => None,
        };
        let first = || self.authored().and(Some(0));
        self.things.looks_through = match self.looks_through() {
            Some(_) => None,
            None => picked.or_else(first),
        };
    }

    /// The view leaves the camera that it looks through, and stays where that is.
    pub fn leave_camera(&mut self) {
        if let Some(camera) = self.scene_camera() {
            let time = self.stage_time_secs();
            self.camera.stand_at(&camera, &self.stage, time);
        }
        self.things.looks_through = None;
    }

    /// The camera of the scene that the view looks through, as it stands now.
    #[must_use]
    pub fn scene_camera(&self) -> Option<Camera> {
        let index = self.looks_through()?;
        let scene = self.scene_shown()?;
        let view = &scene.cameras.get(index)?.view;
        Some(keyed_camera(view, self.scene_secs(), self.stage.stature()))
    }

    /// The scene's camera takes the place of the view: the one that is picked or looked through, else the
    /// first; a new one where there is none. The view then looks through it.
    pub fn camera_to_view(&mut self) {
        let Some(count) = self.authored().map(|it| it.scene().cameras.len()) else {
            return;
        };
        let picked = match self.picked().map(|picked| picked.owner) {
            Some(Owner::Camera(index)) => Some(index),
            _ => None,
        };
        let index = picked.or(self.looks_through()).unwrap_or(0);
        if count == 0 {
            self.add_thing(NewThing::Camera);
        } else {
            let view = self.view_camera();
            let values = [
                (Lane::CameraPosition(index), view.eye),
                (Lane::CameraTarget(index), view.target),
            ]
            .map(|(lane, at)| (lane, LaneValue::Vector(tidy(at))));
            if self.animate().auto_key {
                // Where it stands and what it looks at belong together, changed or not.
                self.put_keys("Camera to view", &values, None);
            } else {
                self.set_values("Camera to view", &values, None);
            }
        }
        self.things.looks_through = Some(index);
    }

    /// The shape of the shot's picture, width over height.
    #[must_use]
    pub fn frame_aspect(&self) -> f32 {
        self.things.frame_aspect
    }

    /// Tells the shape of the shot's picture.
    pub fn set_frame_aspect(&mut self, aspect: f32) {
        if aspect.is_finite() && aspect > 0.0 {
            self.things.frame_aspect = aspect;
        }
    }

    /// Width and height of the frame of the camera that is looked through, as shares of the view's.
    #[must_use]
    pub fn frame_shares(&self) -> (f32, f32) {
        let aspect = self.things.frame_aspect;
        let height = FRAME_SHARE * (self.aspect / aspect).min(1.0);
        (height * aspect / self.aspect, height)
    }

    /// The scene's camera, wide enough that its frame is in the view with a margin.
    pub(super) fn framed_camera(&self) -> Option<Camera> {
        let camera = self.scene_camera()?;
        let (_, share) = self.frame_shares();
        let Projection::Perspective { vertical_fov_rad } = camera.projection else {
            return Some(camera);
        };
        let tan = libm::tanf(vertical_fov_rad / 2.0) / share;
        Some(Camera {
            projection: Projection::Perspective {
                vertical_fov_rad: 2.0 * libm::atanf(tan),
            },
            ..camera
        })
    }
}

/// What can be added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewThing {
    /// A camera.
    Camera,
    /// A light.
    Light,
    /// A box.
    Box,
    /// A ball.
    Sphere,
}

impl NewThing {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Camera, Self::Light, Self::Box, Self::Sphere];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Camera => "Camera",
            Self::Light => "Light",
            Self::Box => "Box",
            Self::Sphere => "Sphere",
        }
    }
}

/// What a placement sets of the thing that is held: only what its handle moves.
fn values_at(held: &Held, placement: Placement) -> Vec<(Lane, LaneValue)> {
    if held.drag.handle().turns() {
        let Owner::Prop(index) = held.picked.owner else {
            return Vec::new();
        };
        let orientation = placement.orientation.as_dquat().normalize();
        return vec![(
            Lane::PropRotation(index),
            LaneValue::Orientation(orientation),
        )];
    }
    let lane = held.picked.lane();
    let at = LaneValue::Vector(tidy(placement.position));
    lane.map(|lane| (lane, at)).into_iter().collect()
}

fn index_at(times_secs: &[f64], time_secs: f64) -> Option<usize> {
    times_secs
        .iter()
        .position(|time| (time - time_secs).abs() <= SAME_TIME_SECS)
}

/// A place on a grid of a hundredth of the figure's height, so that files have short numbers.
fn round(place: Vec3, stature: f32) -> DVec3 {
    let step = f64::from(stature) / 100.0;
    let power = libm::pow(10.0, libm::log10(step).floor());
    (place.as_dvec3() / power).round() * power
}

/// The numbers whose shortest decimals are those of the `f32`: 0.1 and not 0.10000000149.
fn tidy(v: Vec3) -> DVec3 {
    let part = |part: f32| part.to_string().parse().unwrap_or(f64::from(part));
    DVec3::from_array(v.to_array().map(part))
}

fn rounded(degrees: f32) -> f64 {
    (f64::from(degrees) * 10.0).round() / 10.0
}
