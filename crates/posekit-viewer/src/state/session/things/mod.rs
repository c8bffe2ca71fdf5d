//! Cameras, lights and props in the session: which one is picked, setting and keying them, looking
//! through a camera.
//!
//! As with poses: with auto-key a new value becomes a key at once. Without it a property that is not
//! keyed takes the value for good, and one that is keyed shows it until it is keyed or another time is
//! shown.

mod add;
mod handles;
mod look;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec3, Vec3};
use posekit::keyframe::edit::SAME_TIME_SECS;
use posekit_formats::scene::Scene;
use posekit_render::stage::Surroundings;

use super::Session;
use crate::gizmo::Drag;
use crate::state::animate::{KeyId, Lane, LaneValue};
use crate::state::edit::Gesture;
use crate::state::mode::Mode;
use crate::state::things::{self, Picked, Symbol, exists, keyed, set_fixed, unkeyed, with_values};

pub use add::NewThing;

/// The shape of a shot's picture, unless something else is said.
const FRAME_ASPECT: f32 = 16.0 / 9.0;

/// All of a session that is about cameras, lights and props.
#[derive(Debug)]
pub(super) struct Things {
    picked: Option<Picked>,
    pending: Option<PendingValues>,
    held: Option<Held>,
    looks_through: Option<usize>,
    /// The camera that was looked through last, while the view has turned away from it.
    left: Option<usize>,
    frame_aspect: f32,
}

impl Default for Things {
    fn default() -> Self {
        Self {
            picked: None,
            pending: None,
            held: None,
            looks_through: None,
            left: None,
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
}

fn index_at(times_secs: &[f64], time_secs: f64) -> Option<usize> {
    times_secs
        .iter()
        .position(|time| (time - time_secs).abs() <= SAME_TIME_SECS)
}

/// The numbers whose shortest decimals are those of the `f32`: 0.1 and not 0.10000000149.
fn tidy(v: Vec3) -> DVec3 {
    let part = |part: f32| part.to_string().parse().unwrap_or(f64::from(part));
    DVec3::from_array(v.to_array().map(part))
}
