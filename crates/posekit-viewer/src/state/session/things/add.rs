//! Adding cameras, lights and props, taking them out, naming them.

use std::collections::BTreeSet;

use glam::{DVec3, Vec3};
use posekit_render::camera::Projection;
use posekit_render::stage::LIGHT_FULL_AT;

use super::super::Session;
use super::tidy;
use crate::state::animate::Owner;
use crate::state::things::{self, Kind, Picked, exists};

/// The side of a new prop, in statures.
const PROP_SIDE: f32 = 0.3;

/// Where in the view a new light is, in thousandths from the left and from the top.
const LIGHT_IN_VIEW: (f32, f32) = (250.0, 220.0);

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

impl Session {
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
}

/// A place on a grid of a hundredth of the figure's height, so that files have short numbers.
fn round(place: Vec3, stature: f32) -> DVec3 {
    let step = f64::from(stature) / 100.0;
    let power = libm::pow(10.0, libm::log10(step).floor());
    (place.as_dvec3() / power).round() * power
}

fn rounded(degrees: f32) -> f64 {
    (f64::from(degrees) * 10.0).round() / 10.0
}
