//! Cameras, lights and props of a scene: which one is picked, and what of a scene stands on the stage.
//!
//! World space and seconds of the scene, as everywhere in [`animate`](super::animate).

mod edit;
mod place;

use posekit_formats::scene::Scene;
use posekit_render::stage::{Prop, PropShape, Surroundings};

use super::animate::{Lane, LaneValue, Owner};

pub use edit::{Kind, add, add_light, keyed, remove, rename, set_fixed, unkeyed};
pub use place::{Symbol, camera_corners, symbols};

/// A point of a thing that can be taken with the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The thing itself.
    Body,
    /// What a camera looks at.
    Target,
}

/// A camera, light or prop that is picked, and what of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Picked {
    /// The thing.
    pub owner: Owner,
    /// What of it.
    pub part: Part,
}

impl Picked {
    /// The thing itself.
    #[must_use]
    pub const fn body(owner: Owner) -> Self {
        Self {
            owner,
            part: Part::Body,
        }
    }

    /// The lane that says where it is; `None` for a joint.
    #[must_use]
    pub const fn lane(self) -> Option<Lane> {
        Some(match (self.owner, self.part) {
            (Owner::Joint(_), _) => return None,
            (Owner::Camera(index), Part::Body) => Lane::CameraPosition(index),
            (Owner::Camera(index), Part::Target) => Lane::CameraTarget(index),
            (Owner::Light(index), _) => Lane::LightPosition(index),
            (Owner::Prop(index), _) => Lane::PropTranslation(index),
        })
    }
}

/// Whether a scene has such a thing; joints are none.
#[must_use]
pub fn exists(scene: &Scene, owner: Owner) -> bool {
    match owner {
        Owner::Joint(_) => false,
        Owner::Camera(index) => index < scene.cameras.len(),
        Owner::Light(index) => index < scene.lights.len(),
        Owner::Prop(index) => index < scene.props.len(),
    }
}

/// The scene with some of its properties fixed at other values: as it is shown while something is moved
/// that is not keyed yet.
#[must_use]
pub fn with_values(scene: &Scene, values: impl IntoIterator<Item = (Lane, LaneValue)>) -> Scene {
    let mut scene = scene.clone();
    for (lane, value) in values {
        set_fixed(&mut scene, lane, value);
    }
    scene
}

/// The lights and props of a scene, to be put on a stage. A box stands for a mesh file.
#[must_use]
pub fn surroundings(scene: &Scene) -> Surroundings {
    let prop = |prop: &posekit_formats::scene::Prop| {
        let shape = PropShape::named(&prop.shape).unwrap_or(PropShape::Box);
        Prop::new(&shape, prop.transform.clone())
    };
    Surroundings {
        studio_light: scene.studio_light,
        lights: scene.lights.iter().map(|it| it.shine.clone()).collect(),
        props: scene.props.iter().map(prop).collect(),
        start_secs: scene.range_secs[0],
    }
}
