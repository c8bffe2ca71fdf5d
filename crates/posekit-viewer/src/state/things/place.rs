//! Where things are on the stage: what is drawn of them, and what the pointer can take.

use glam::{Affine3, Vec3};
use posekit_formats::scene::Scene;
use posekit_render::camera::{Camera, Projection};
use posekit_render::stage::{Prop, PropShape, keyed_camera};

use super::{Part, Picked};
use crate::state::animate::Owner;

/// A thing as it stands at a time, world space.
#[derive(Clone, Debug)]
pub enum Symbol {
    /// A camera.
    Camera {
        /// Which one.
        index: usize,
        /// Where it stands and what it sees.
        camera: Camera,
    },
    /// A light.
    Light {
        /// Which one.
        index: usize,
        /// Where it stands.
        position: Vec3,
        /// Its linear colour, not its strength.
        color: Vec3,
        /// Its strength.
        strength: f32,
    },
    /// A prop.
    Prop {
        /// Which one.
        index: usize,
        /// World from its own space, in which it reaches half a unit to each side.
        placed: Affine3,
    },
}

impl Symbol {
    /// Which thing it is.
    #[must_use]
    pub fn owner(&self) -> Owner {
        match self {
            Self::Camera { index, .. } => Owner::Camera(*index),
            Self::Light { index, .. } => Owner::Light(*index),
            Self::Prop { index, .. } => Owner::Prop(*index),
        }
    }

    /// The points by which it can be taken.
    #[must_use]
    pub fn points(&self) -> Vec<(Picked, Vec3)> {
        let body = Picked::body(self.owner());
        match self {
            Self::Camera { camera, .. } => {
                let target = Picked {
                    part: Part::Target,
                    ..body
                };
                vec![(body, camera.eye), (target, camera.target)]
            }
            Self::Light { position, .. } => vec![(body, *position)],
            Self::Prop { placed, .. } => vec![(body, placed.translation)],
        }
    }

    /// How far along a ray a prop's box is met; `None` for other things, and where it is missed.
    #[must_use]
    pub fn met_by(&self, origin: Vec3, direction: Vec3) -> Option<f32> {
        let Self::Prop { placed, .. } = self else {
            return None;
        };
        let inverse = placed.inverse();
        if !inverse.is_finite() {
            return None;
        }
        let (o, d) = (
            inverse.transform_point3(origin),
            inverse.transform_vector3(direction),
        );
        let (mut near, mut far) = (0.0f32, f32::INFINITY);
        for axis in 0..3 {
            let (a, b) = ((-0.5 - o[axis]) / d[axis], (0.5 - o[axis]) / d[axis]);
            // Along a face's plane both are infinite, or not a number on it: that never counts.
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far).then_some(near)
    }
}

/// All things of a scene at a time, around figures of a height.
#[must_use]
pub fn symbols(scene: &Scene, time_secs: f64, stature: f32) -> Vec<Symbol> {
    let cameras = scene.cameras.iter().enumerate().map(|(index, it)| {
        let camera = keyed_camera(&it.view, time_secs, stature);
        Symbol::Camera { index, camera }
    });
    let lights = scene.lights.iter().enumerate().map(|(index, it)| {
        #[expect(clippy::cast_possible_truncation, reason = "what is drawn is in f32")]
        let strength = it.shine.strength.at(time_secs) as f32;
        Symbol::Light {
            index,
            position: it.shine.position.at(time_secs).as_vec3(),
            color: it.shine.color.at(time_secs).as_vec3(),
            strength,
        }
    });
    let props = scene.props.iter().enumerate().filter_map(|(index, it)| {
        let shape = PropShape::named(&it.shape).unwrap_or(PropShape::Box);
        let placed = Prop::new(&shape, it.transform.clone()).placed(time_secs)?;
        Some(Symbol::Prop { index, placed })
    });
    cameras.chain(lights).chain(props).collect()
}

/// The corners of what a camera sees in a picture of `aspect`, a distance away from it: top left, top
/// right, bottom right, bottom left.
#[must_use]
pub fn camera_corners(camera: &Camera, aspect: f32, distance: f32) -> [Vec3; 4] {
    let (right, up, back) = camera.axes();
    let half = match camera.projection {
        Projection::Perspective { vertical_fov_rad } => {
            distance * libm::tanf(vertical_fov_rad / 2.0)
        }
        Projection::Orthographic { height } => height / 2.0,
    };
    let middle = camera.eye - back * distance;
    [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
        .map(|(x, y)| middle + right * (x * half * aspect) + up * (y * half))
}
