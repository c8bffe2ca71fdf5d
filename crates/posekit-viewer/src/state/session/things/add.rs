//! Adding cameras, lights and props, taking them out, naming them.

use std::collections::BTreeSet;

use glam::{DVec3, Vec3};
use posekit::keyframe::{KeyedLight, Property};
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

/// A light of the three that portraits are lit with, seen from what is lit.
struct PointOfThree {
    name: &'static str,
    /// About the vertical from the viewer, to the viewer's right.
    yaw_deg: f32,
    pitch_deg: f32,
    color: DVec3,
    strength: f64,
}

/// Strengths are shares of the key light's: the fill about a third, the rim nearly as bright.
const THREE_POINTS: [PointOfThree; 3] = [
    PointOfThree {
        name: "key light",
        yaw_deg: -45.0,
        pitch_deg: 40.0,
        color: DVec3::new(1.0, 0.93, 0.82),
        strength: 0.9,
    },
    PointOfThree {
        name: "fill light",
        yaw_deg: 50.0,
        pitch_deg: 15.0,
        color: DVec3::new(0.82, 0.9, 1.0),
        strength: 0.3,
    },
    PointOfThree {
        name: "rim light",
        yaw_deg: 155.0,
        pitch_deg: 45.0,
        color: DVec3::ONE,
        strength: 0.8,
    },
];

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

    /// Adds three lights around what the view looks at, as portraits are lit, in place of the studio light:
    /// a key light from the viewer's left and above, a fill light from the right, a rim light from behind.
    pub fn add_three_point_lights(&mut self) {
        self.transport.pause();
        let view = self.view_camera();
        let away = view.eye - view.target;
        let yaw = libm::atan2f(away.x, away.z);
        let stature = self.stage.stature();
        let added = self.author(|authored| {
            let mut key = None;
            let _ = authored.edit_scene("Add three lights", None, |scene| {
                scene.studio_light = false;
                for light in &THREE_POINTS {
                    let (sin, cos) = libm::sincosf(yaw + light.yaw_deg.to_radians());
                    let (up, level) = libm::sincosf(light.pitch_deg.to_radians());
                    let way = Vec3::new(sin * level, up, cos * level);
                    let position = round(view.target + way * (LIGHT_FULL_AT * stature), stature);
                    let shine = KeyedLight {
                        position: Property::Fixed(position),
                        color: Property::Fixed(light.color),
                        strength: Property::Fixed(light.strength),
                    };
                    let owner = things::add_light(scene, light.name, shine);
                    key.get_or_insert(owner);
                }
            });
            key
        });
        if let Some(key) = added.flatten() {
            self.pick(Some(Picked::body(key)));
        }
    }

    /// Whether the scene's pictures have their own light beside its lights; `None` without a scene.
    #[must_use]
    pub fn studio_light(&self) -> Option<bool> {
        Some(self.authored()?.scene().studio_light)
    }

    /// Switches the studio light.
    pub fn set_studio_light(&mut self, on: bool) {
        if self.studio_light() == Some(on) {
            return;
        }
        let name = if on {
            "Switch the studio light on"
        } else {
            "Switch the studio light off"
        };
        self.author(|authored| {
            let _ = authored.edit_scene(name, None, |scene| scene.studio_light = on);
        });
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
        self.things.left = None;
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
