//! What the key light's shadow map covers: the same for both back ends.

use glam::Vec3;

use crate::mesh::frame_along;
use crate::scene::{Scene, Shadow};

/// Texels along a side of the shadow map.
pub(crate) const MAP_SIZE: usize = 1024;

/// The filter may reach this many texels and no farther.
pub(crate) const MAX_SPREAD: f32 = 30.0;

/// Which part of the world the map covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowFrame {
    /// Light-space axes in the world: across, along the map's rows, towards the light.
    pub(crate) axes: [Vec3; 3],
    /// World position of the map's corner with the smallest coordinates, in light space.
    pub(crate) origin: Vec3,
    /// World length of the map's side.
    pub(crate) side: f32,
    /// World length of its depth.
    pub(crate) depth: f32,
}

impl ShadowFrame {
    /// A frame around all shadow casters; `None` when there are none.
    pub(crate) fn around(scene: &Scene) -> Option<Self> {
        let basis = frame_along(scene.lighting.key_direction.normalize_or(Vec3::Y));
        let axes = [basis.x_axis, basis.y_axis, basis.z_axis];
        let mut low = Vec3::INFINITY;
        let mut high = Vec3::NEG_INFINITY;
        for model in scene.models.iter().filter(|m| m.shadow == Shadow::Cast) {
            let reach = model.mesh.reach();
            for joint in &model.joints {
                let p = in_axes(&axes, joint.translation);
                low = low.min(p - reach);
                high = high.max(p + reach);
            }
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
        })
    }

    /// Map coordinates in 0..=1 and depth in 0..=1, larger nearer to the light.
    #[inline]
    pub(crate) fn project(&self, p: Vec3) -> Vec3 {
        let local = in_axes(&self.axes, p) - self.origin;
        Vec3::new(
            local.x / self.side,
            local.y / self.side,
            local.z / self.depth,
        )
    }
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
