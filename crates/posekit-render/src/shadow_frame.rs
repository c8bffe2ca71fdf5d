//! What the shadow map covers, seen along the key light or, where that is off, from the first lamp: the
//! same for both back ends.

use glam::Vec3;

use crate::mesh::frame_along;
use crate::scene::{Lamp, Model, Scene, Shadow};

/// Texels along a side of the shadow map.
pub(crate) const MAP_SIZE: usize = 1024;

/// The filter may reach this many texels and no farther: the neighbourhood of the CPU's coarse map
/// covers a cell to all sides, no more.
pub(crate) const MAX_SPREAD: f32 = 30.0;

/// A lamp so near to a caster that the map would have to open wider than this (the tangent of half
/// its angle) gets parallel rays instead.
const WIDEST: f32 = 3.0;

/// Scales within this of 1 are rounding.
const ROUNDING: f32 = 1e-4;

/// Which part of the world the map covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowFrame {
    /// Light-space axes in the world: across, along the map's rows, towards the light.
    pub(crate) axes: [Vec3; 3],
    /// World position of the map's corner with the smallest coordinates, in light space. With a lens,
    /// the world position of the light.
    pub(crate) origin: Vec3,
    /// World length of the map's side; with a lens, at distance 1 from the light.
    pub(crate) side: f32,
    /// World length of its depth; with a lens, the distance at which depth is 1.
    pub(crate) depth: f32,
    /// Whether rays are parallel or come from a place.
    pub(crate) rays: Rays,
}

/// How the map sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rays {
    /// All rays have one direction: depth is affine.
    Parallel,
    /// All come from the lamp: depth is reversed, `depth` over the distance along the axis.
    FromLamp,
}

/// A point that may be in shadow, in texels and depth of the map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receiver {
    /// Texels along and across.
    pub(crate) x: f32,
    pub(crate) y: f32,
    /// Depth, moved towards the light by the bias.
    pub(crate) depth: f32,
    /// Texels that the filter's radius spans.
    pub(crate) spread: f32,
}

impl ShadowFrame {
    /// A frame around all shadow casters; `None` when there are none.
    pub(crate) fn around(scene: &Scene) -> Option<Self> {
        match scene.casting_lamp() {
            Some(lamp) => Self::from_lamp(scene, lamp).or_else(|| {
                let middle = middle(scene)?;
                Self::along(scene, (lamp.position - middle).normalize_or(Vec3::Y))
            }),
            None if scene.is_key_off() => None,
            None => Self::along(scene, scene.lighting.key_direction.normalize_or(Vec3::Y)),
        }
    }

    /// Parallel rays towards a light far away.
    fn along(scene: &Scene, to_light: Vec3) -> Option<Self> {
        let axes = axes_along(to_light);
        let mut low = Vec3::INFINITY;
        let mut high = Vec3::NEG_INFINITY;
        for (place, reach) in balls(scene) {
            let p = in_axes(&axes, place);
            low = low.min(p - reach);
            high = high.max(p + reach);
        }
        if !(low.is_finite() && high.is_finite()) || low.x >= high.x {
            return None;
        }
        let margin = scene.lighting.shadow_softness * 2.0;
        // Sizes go up in steps and the corner sits on whole texels, so that the shadow of
        // something at rest does not crawl while something else moves.
        let side = step_up((high.x - low.x).max(high.y - low.y) + 2.0 * margin);
        let texel = side / MAP_SIZE as f32;
        let middle = (low + high) * 0.5;
        let snap = |v: f32| (v / texel).floor() * texel;
        let corner = |v: f32| snap(v - side * 0.5);
        Some(Self {
            axes,
            origin: Vec3::new(corner(middle.x), corner(middle.y), low.z - margin),
            side,
            depth: high.z - low.z + 2.0 * margin,
            rays: Rays::Parallel,
        })
    }

    /// A lens at a lamp that sees all casters; `None` when no lens does.
    fn from_lamp(scene: &Scene, lamp: &Lamp) -> Option<Self> {
        let to_light = (lamp.position - middle(scene)?).try_normalize()?;
        let axes = axes_along(to_light);
        let margin = scene.lighting.shadow_softness * 2.0;
        let (mut widest, mut nearest) = (0.0f32, f32::INFINITY);
        for (place, reach) in balls(scene) {
            let p = in_axes(&axes, place - lamp.position);
            let reach = reach + margin;
            let distance = -p.z - reach;
            if distance.is_nan() || distance <= 0.0 {
                return None;
            }
            nearest = nearest.min(distance);
            widest = widest.max((p.x.abs().max(p.y.abs()) + reach) / distance);
        }
        (nearest.is_finite() && widest <= WIDEST).then(|| Self {
            axes,
            origin: lamp.position,
            side: step_up(2.0 * widest),
            depth: nearest,
            rays: Rays::FromLamp,
        })
    }

    /// Map coordinates in 0..=1 and depth in 0..=1, larger nearer to the light. A point that a lens
    /// has at its side or behind it is outside.
    #[inline]
    pub(crate) fn project(&self, p: Vec3) -> Vec3 {
        match self.rays {
            Rays::Parallel => {
                let local = in_axes(&self.axes, p) - self.origin;
                Vec3::new(
                    local.x / self.side,
                    local.y / self.side,
                    local.z / self.depth,
                )
            }
            Rays::FromLamp => {
                let local = in_axes(&self.axes, p - self.origin);
                if -local.z < 0.5 * self.depth {
                    return Vec3::NEG_ONE;
                }
                let across = self.side * -local.z;
                Vec3::new(
                    0.5 + local.x / across,
                    0.5 + local.y / across,
                    self.depth / -local.z,
                )
            }
        }
    }

    /// How far a point is in front of a lens; 1 for parallel rays: what its size on the map is
    /// divided by.
    #[inline]
    pub(crate) fn distance(&self, p: Vec3) -> f32 {
        match self.rays {
            Rays::Parallel => 1.0,
            Rays::FromLamp => self.axes[2].dot(self.origin - p),
        }
    }

    /// A point in the map, with the filter's `radius` and a `bias` towards the light in world length;
    /// `None` outside of the map.
    #[inline]
    pub(crate) fn receiver(&self, point: Vec3, radius: f32, bias: f32) -> Option<Receiver> {
        let p = self.project(point);
        if !(p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0) {
            return None;
        }
        let spread = radius / self.side * MAP_SIZE as f32;
        let (depth, spread) = match self.rays {
            Rays::Parallel => (p.z + bias / self.depth, spread),
            Rays::FromLamp => {
                let distance = self.distance(point);
                (self.depth / (distance - bias), spread / distance)
            }
        };
        Some(Receiver {
            x: p.x * MAP_SIZE as f32,
            y: p.y * MAP_SIZE as f32,
            depth,
            spread: spread.min(MAX_SPREAD),
        })
    }
}

/// Balls around the joints of all casters that hold everything that casts a shadow.
fn balls(scene: &Scene) -> impl Iterator<Item = (Vec3, f32)> {
    let casters = scene.models.iter().filter(|m| m.shadow == Shadow::Cast);
    casters.flat_map(|model: &Model| {
        let reach = model.mesh.reach();
        let joints = model.joints.iter();
        joints.map(move |joint| {
            let m = &joint.matrix3;
            let longest = m.x_axis.length().max(m.y_axis.length());
            let scale = longest.max(m.z_axis.length());
            let is_rotation = (scale - 1.0).abs() <= ROUNDING;
            let reach = if is_rotation { reach } else { reach * scale };
            (joint.translation, reach)
        })
    })
}

/// The middle of all casters.
fn middle(scene: &Scene) -> Option<Vec3> {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for (place, reach) in balls(scene) {
        low = low.min(place - reach);
        high = high.max(place + reach);
    }
    let middle = (low + high) * 0.5;
    (low.is_finite() && high.is_finite()).then_some(middle)
}

fn axes_along(to_light: Vec3) -> [Vec3; 3] {
    let basis = frame_along(to_light);
    [basis.x_axis, basis.y_axis, basis.z_axis]
}

fn in_axes(axes: &[Vec3; 3], p: Vec3) -> Vec3 {
    Vec3::new(axes[0].dot(p), axes[1].dot(p), axes[2].dot(p))
}

/// The next of the numbers 1, 1.25, 1.5, 1.75, 2, 2.5, ... that is not smaller.
fn step_up(value: f32) -> f32 {
    let exponent = libm::floorf(libm::log2f(value));
    let base = libm::exp2f(exponent);
    [1.0, 1.25, 1.5, 1.75]
        .into_iter()
        .map(|m| m * base)
        .find(|&v| v >= value)
        .unwrap_or(2.0 * base)
}
