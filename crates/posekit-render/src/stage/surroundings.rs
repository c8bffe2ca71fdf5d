//! What stands around the actors and moves by keys: lights, objects, and the cameras that see them.
//!
//! World space, seconds of the scene that they belong to. The room's own light, the studio light, stays
//! until it is switched off; then its key and fill light are gone, what is left of sky and walls is
//! [`AMBIENT`] of it, and all else comes from the lights.
//!
//! A picture with lights is exposed by what arrives at the figure: up to [`FULL_EXPOSURE`] times a key light
//! nothing changes; above, exposure goes down, by less than the light goes up, as a camera's is set. So
//! more and stronger lights make a brighter picture, and not a white one.

use std::sync::{Arc, LazyLock};

use glam::{Affine3, DVec3, Mat3, Vec3};

use posekit::keyframe::{KeyedCamera, KeyedLight, KeyedTransform};

use crate::camera::{Camera, Projection};
use crate::color::Color;
use crate::mesh::{MATERIAL_COUNT, MaterialId, Mesh, Shape};
use crate::scene::{Background, Lamp, Model, Scene, Shadow};
use crate::shading::lamp_at;

/// A light of strength 1 lights with its full colour at this many times the figure's height. A person's
/// key light stands about so far away.
pub const LIGHT_FULL_AT: f32 = 3.0;

/// The share of the room's own light that is left where a scene has lights: a shadow is no hole.
pub const AMBIENT: f32 = 0.3;

/// As much light at the figure, in key lights, is exposed in full.
pub const FULL_EXPOSURE: f32 = 1.5;

/// Exposure goes with this power of the light above that: 1 would make all pictures equally bright.
const ADAPTION: f32 = 0.85;

/// Backdrop and floor go with this power of the exposure: bright rooms stay bright around bright lights.
const BACKDROP: f32 = 0.3;

/// No light is stronger: numbers stay finite.
const STRONGEST: f64 = 1e6;

/// Segments around a round object.
const SPHERE_SEGMENTS: usize = 48;

/// An object flatter than this share of its longest side is drawn this thin.
const THINNEST: f32 = 1e-4;

/// The colour of objects.
const PROP_COLOR: u32 = 0xC9_C4_BC;

/// One for all boxes: a back end draws what shares a mesh at once.
static BOX: LazyLock<Arc<Mesh>> = LazyLock::new(|| mesh_of(&Shape::cuboid(Vec3::splat(0.5), 0.0)));

/// One for all balls.
static SPHERE: LazyLock<Arc<Mesh>> =
    LazyLock::new(|| mesh_of(&Shape::ball(Vec3::ZERO, 0.5, SPHERE_SEGMENTS)));

fn mesh_of(shape: &Shape) -> Arc<Mesh> {
    let mut mesh = Mesh::default();
    mesh.add(shape, 0, MaterialId::Base);
    Arc::new(mesh)
}

/// An object that stands around.
#[derive(Clone, Debug)]
pub struct Prop {
    mesh: Arc<Mesh>,
    transform: KeyedTransform,
}

/// What an object looks like under the identity.
#[derive(Clone, Debug, PartialEq)]
pub enum PropShape {
    /// A cube of side 1 around the origin.
    Box,
    /// A ball of diameter 1 around the origin.
    Sphere,
    /// Any closed shape, counter-clockwise from outside.
    Mesh(Shape),
}

impl PropShape {
    /// The shape that a scene file calls by this name; `None` for other names, which are those of
    /// files.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "box" => Some(Self::Box),
            "sphere" => Some(Self::Sphere),
            _ => None,
        }
    }
}

impl Prop {
    /// An object of a shape that goes by a transform.
    #[must_use]
    pub fn new(shape: &PropShape, transform: KeyedTransform) -> Self {
        Self {
            mesh: match shape {
                PropShape::Box => Arc::clone(&BOX),
                PropShape::Sphere => Arc::clone(&SPHERE),
                PropShape::Mesh(shape) => mesh_of(shape),
            },
            transform,
        }
    }

    /// Where it is and how it is turned.
    #[must_use]
    pub fn transform(&self) -> &KeyedTransform {
        &self.transform
    }

    /// World from the object's own space at a time; `None` when it has no size or no finite place.
    #[must_use]
    pub fn placed(&self, time_secs: f64) -> Option<Affine3> {
        let scale = self.transform.scale.at(time_secs).as_vec3().abs();
        let scale = scale.max(Vec3::splat(THINNEST * scale.max_element()));
        let rotation = self.transform.rotation.at(time_secs).as_quat();
        let placed = Affine3 {
            matrix3: Mat3::from_quat(rotation.normalize()) * Mat3::from_diagonal(scale),
            translation: self.transform.translation.at(time_secs).as_vec3(),
        };
        let is_sound = placed.is_finite() && scale.max_element() > 0.0;
        is_sound.then_some(placed)
    }

    fn model(&self, time_secs: f64) -> Option<Model> {
        Some(Model {
            mesh: Arc::clone(&self.mesh),
            joints: vec![self.placed(time_secs)?],
            palette: [Color::from_hex(PROP_COLOR); MATERIAL_COUNT],
            opacity: 1.0,
            shadow: Shadow::Cast,
        })
    }
}

/// Lights and objects of a scene.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Whether the room's own light is on, which casts the shadow.
    pub studio_light: bool,
    /// The lights; the first casts the shadow where the studio light is off.
    pub lights: Vec<KeyedLight>,
    /// The objects.
    pub props: Vec<Prop>,
    /// The scene's time at the stage's time 0.
    pub start_secs: f64,
}

impl Default for Surroundings {
    /// An empty room with its own light.
    fn default() -> Self {
        Self {
            studio_light: true,
            lights: Vec::new(),
            props: Vec::new(),
            start_secs: 0.0,
        }
    }
}

impl Surroundings {
    /// Puts them into a scene at a time of the stage. Its actors are `stature` high, and the middle of the
    /// first is at `subject`.
    pub(super) fn add_to(&self, scene: &mut Scene, stature: f32, subject: Vec3, time_secs: f64) {
        let time_secs = self.start_secs + time_secs;
        let models = self.props.iter().filter_map(|prop| prop.model(time_secs));
        scene.models.extend(models);
        if self.lights.is_empty() && self.studio_light {
            return;
        }
        let lamps = self
            .lights
            .iter()
            .map(|light| lamp(light, stature, time_secs));
        scene.lamps = lamps.collect();
        let lighting = &mut scene.lighting;
        let room = if self.studio_light { 1.0 } else { AMBIENT };
        if !self.studio_light {
            lighting.key = Color::default();
            lighting.fill = Color::default();
            lighting.sky = lighting.sky.scaled(AMBIENT);
            lighting.bounce = lighting.bounce.scaled(AMBIENT);
        }
        let arriving: f32 = scene
            .drawn_lamps()
            .iter()
            .map(|lamp| brightness_at(lamp, subject))
            .sum();
        let exposure = exposure_for(room + arriving);
        scene.lighting.exposure = exposure;
        // Backdrop and floor run into each other; they follow some of the way, and do not get black.
        let seen = (room * libm::powf(exposure, BACKDROP)).max(AMBIENT);
        scene.lighting.ground_ambient = seen / exposure;
        if let Background::Gradient { top, bottom } = &mut scene.background {
            (*top, *bottom) = (top.scaled(seen), bottom.scaled(seen));
        }
    }
}

/// How bright a lamp is at a place, whatever faces it there, in key lights.
fn brightness_at(lamp: &Lamp, place: Vec3) -> f32 {
    let Color { r, g, b } = lamp.color;
    lamp_at(lamp, place).1 * r.max(g).max(b)
}

/// The factor that all light gets where so much arrives at the figure.
fn exposure_for(key_lights: f32) -> f32 {
    libm::powf((FULL_EXPOSURE / key_lights).min(1.0), ADAPTION)
}

/// A keyed light at a time.
fn lamp(light: &KeyedLight, stature: f32, time_secs: f64) -> Lamp {
    // Cubic keys can overshoot below nothing.
    let strength = light.strength.at(time_secs).max(0.0);
    let color = light.color.at(time_secs).max(DVec3::ZERO) * strength;
    let color = color.min(DVec3::splat(STRONGEST)).as_vec3();
    let finite = |v: Vec3| if v.is_finite() { v } else { Vec3::ZERO };
    let [r, g, b] = finite(color).to_array();
    Lamp {
        position: finite(light.position.at(time_secs).as_vec3()),
        color: Color { r, g, b },
        full_at: LIGHT_FULL_AT * stature,
    }
}

/// A keyed camera at a time of its scene, around actors of a height.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "pictures are drawn in f32")]
pub fn keyed_camera(camera: &KeyedCamera, time_secs: f64, stature: f32) -> Camera {
    /// Lenses have angles between these; keys can overshoot.
    const FOV_DEG: [f64; 2] = [1.0, 170.0];
    let [least, most] = FOV_DEG;
    let fov_deg = camera.vertical_fov_deg.at(time_secs).clamp(least, most);
    let eye = camera.position.at(time_secs).as_vec3();
    let target = camera.target.at(time_secs).as_vec3();
    // A camera that is where it looks to, or looks straight down, still has to look somewhere.
    let target = if eye == target { eye - Vec3::Z } else { target };
    let level = Vec3::new(target.x - eye.x, 0.0, target.z - eye.z);
    let is_steep = level.length() < 1e-4 * eye.distance(target);
    Camera {
        eye,
        target,
        up: if is_steep { Vec3::NEG_Z } else { Vec3::Y },
        projection: Projection::Perspective {
            vertical_fov_rad: fov_deg.to_radians() as f32,
        },
        near: 0.01 * stature,
        far: 100.0 * stature,
    }
}
