//! The background and the ground, row by row.
//!
//! The ground is a plane, so its depth is affine over the screen and its world coordinates are
//! ratios of affine functions: no triangles, no clipping, eight pixels at a time. Grid lines are
//! anti-aliased by their distance in pixels, after Golus (2023), "The Best Darn Grid Shader (Yet)".

use glam::{DMat4, DVec4, Vec3};
use wide::{f32x8, i32x8};

use crate::color::Color;
use crate::scene::{Background, Ground, Lamp, Scene};
use crate::shading::{
    CONTACT_REACH, SHADOW_TINT, ambient_in_shadow, contact_window, ground_factors, ground_light,
};

use super::shadow::ShadowMap;
use super::tile::TILE;

/// An affine function of the pixel position.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Affine2 {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) c: f32,
}

impl Affine2 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "coefficients of pixels on a screen"
    )]
    fn narrowed([x, y, c]: [f64; 3]) -> Self {
        Self {
            x: x as f32,
            y: y as f32,
            c: c as f32,
        }
    }

    pub(super) fn at(&self, x: f32, y: f32) -> f32 {
        self.x * x + (self.y * y + self.c)
    }

    fn at8(&self, x: f32x8, y: f32) -> f32x8 {
        x * f32x8::splat(self.x) + f32x8::splat(self.y * y + self.c)
    }
}

/// The ground plane as the screen sees it.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// Reversed depth at a pixel.
    depth: Affine2,
    /// World X and Z at a pixel, times `w`.
    x: Affine2,
    z: Affine2,
    w: Affine2,
}

/// A round body part near the ground.
#[derive(Clone, Copy, Debug)]
struct Contact {
    center: Vec3,
    radius: f32,
}

/// The background and the ground of one picture.
#[derive(Debug)]
pub(super) struct Floor {
    background: Background,
    top: [f32; 3],
    bottom: [f32; 3],
    height_px: f32,
    plane: Option<Plane>,
    ground: Option<GroundLook>,
    contacts: Vec<Contact>,
    /// Where the ground's light is added up.
    lit: Option<LitGround>,
}

/// What lights the ground where light is added up.
#[derive(Debug)]
struct LitGround {
    lamps: Vec<Lamp>,
    /// What there is without lamps.
    ambient: f32,
    /// How dark the key light's shadow is; `None` where the first lamp casts it.
    key_shadow: Option<f32>,
    exposure: f32,
    /// The brightest part of the ground's own linear colour.
    brightness: f32,
}

impl LitGround {
    /// `None` where the light is as the theme has composed it.
    fn of(scene: &Scene, ground: &Ground) -> Option<Self> {
        let lighting = &scene.lighting;
        let Color { r, g, b } = ground.color;
        scene.is_lit().then(|| Self {
            lamps: scene.drawn_lamps().to_vec(),
            ambient: lighting.ground_ambient,
            key_shadow: match scene.casting_lamp() {
                Some(_) => None,
                None => Some(lighting.shadow_strength),
            },
            exposure: lighting.exposure,
            brightness: r.max(g).max(b),
        })
    }

    /// The factors of red, green and blue of a point, to which a share of the light that casts the shadow
    /// arrives.
    fn factors(&self, at: Vec3, arriving: f32) -> [f32; 3] {
        let light = match self.key_shadow {
            Some(strength) => {
                let ambient = ambient_in_shadow(self.ambient, (1.0 - arriving) * strength);
                ground_light(at, ambient, 1.0, &self.lamps)
            }
            None => ground_light(at, [self.ambient; 3], arriving, &self.lamps),
        };
        ground_factors(light.map(|part| part * self.exposure), self.brightness)
    }
}

#[derive(Clone, Copy, Debug)]
struct GroundLook {
    ground: Ground,
    color: [f32; 3],
    line: [f32; 3],
    axes: [[f32; 3]; 2],
    shadow_strength: f32,
    shadow_softness: f32,
    contact_strength: f32,
}

/// One row of a tile: encoded sRGB and alpha, all in 0..=255, plane by plane so that eight pixels
/// are worked on at a time.
#[derive(Clone, Debug)]
pub(super) struct FloorRow {
    planes: [[f32x8; GROUPS]; 4],
}

/// Groups of eight pixels in a tile's row.
const GROUPS: usize = TILE / 8;

impl FloorRow {
    pub(super) fn new() -> Self {
        Self {
            planes: [[f32x8::splat(0.0); GROUPS]; 4],
        }
    }

    /// Writes the row's first pixels as bytes.
    pub(super) fn write(&self, out: &mut [u8]) {
        let half = f32x8::splat(0.5);
        for (group, pixels) in out.chunks_mut(32).enumerate() {
            // All values are in 0..=255, so that the bytes do not run into one another.
            let [r, g, b, a] = self
                .planes
                .map(|plane| (plane[group] + half).fast_trunc_int());
            let packed: i32x8 = r | (g << 8) | (b << 16) | (a << 24);
            let bytes = packed.to_array().map(i32::to_le_bytes);
            let length = pixels.len();
            pixels.copy_from_slice(&bytes.as_flattened()[..length]);
        }
    }
}

/// What can darken the ground in a tile.
#[derive(Debug, Default)]
pub(super) struct Darkness {
    contacts: Vec<usize>,
    shadowed: bool,
}

impl Darkness {
    fn is_none(&self) -> bool {
        self.contacts.is_empty() && !self.shadowed
    }
}

impl Floor {
    pub(super) fn new(scene: &Scene, width: u32, height: u32) -> Self {
        let (top, bottom) = match scene.background {
            Background::Gradient { top, bottom } => (top.to_srgb(), bottom.to_srgb()),
            Background::Transparent => ([0.0; 3], [0.0; 3]),
        };
        // From below, the floor would hide what stands on it.
        let ground = scene.ground.filter(|g| scene.camera.eye.y > g.height);
        let plane = ground.and_then(|g| Plane::new(scene, g.height, width, height));
        let lighting = &scene.lighting;
        // Under lamps the ground is lit as bodies are, and a shadow is where light is missing.
        let is_solid = matches!(scene.background, Background::Gradient { .. });
        let lit = ground.filter(|_| is_solid);
        let lit = lit.and_then(|ground| LitGround::of(scene, &ground));
        let look = ground.map(|ground| GroundLook {
            ground,
            color: ground.color.to_srgb(),
            line: ground.line_color.to_srgb(),
            axes: ground.axis_colors.map(crate::color::Color::to_srgb),
            shadow_strength: if lit.is_some() {
                0.0
            } else {
                lighting.shadow_strength
            },
            shadow_softness: lighting.shadow_softness,
            contact_strength: lighting.contact_strength,
        });
        let contacts = ground
            .map(|g| contacts(scene, g.height))
            .unwrap_or_default();
        Self {
            background: scene.background,
            top,
            bottom,
            height_px: height as f32,
            plane,
            ground: look,
            contacts,
            lit,
        }
    }

    /// Reversed depth of the ground over the screen; all zero without one.
    pub(super) fn depth(&self) -> Affine2 {
        self.plane.map(|p| p.depth).unwrap_or_default()
    }

    /// What can darken the tile whose corner is at `x`, `y`.
    pub(super) fn darkness(&self, x: f32, y: f32, shadow: &ShadowMap, found: &mut Darkness) {
        found.contacts.clear();
        found.shadowed = false;
        let (Some(plane), Some(look)) = (&self.plane, &self.ground) else {
            return;
        };
        let Some((low, high)) = plane.bounds(x, y, look.ground.height) else {
            // The tile reaches over the horizon: its far end is nowhere.
            found.contacts.extend(0..self.contacts.len());
            found.shadowed = true;
            return;
        };
        found.shadowed = shadow.may_darken(low, high, look.shadow_softness);
        for (index, contact) in self.contacts.iter().enumerate() {
            let reach = contact.radius * CONTACT_REACH;
            let (cx, cz) = (contact.center.x, contact.center.z);
            let apart = cx + reach < low.x
                || cx - reach > high.x
                || cz + reach < low.z
                || cz - reach > high.z;
            if !apart {
                found.contacts.push(index);
            }
        }
    }

    /// The pixels from column `x` on, in row `y`, without anything that stands on the ground.
    pub(super) fn row(
        &self,
        x: f32,
        y: f32,
        shadow: &ShadowMap,
        darkness: &Darkness,
        row: &mut FloorRow,
    ) {
        let t = (y + 0.5) / self.height_px;
        let is_solid = matches!(self.background, Background::Gradient { .. });
        for c in 0..3 {
            let mix = (self.top[c] + (self.bottom[c] - self.top[c]) * t) * 255.0;
            row.planes[c] = [f32x8::splat(mix); GROUPS];
        }
        row.planes[3] = [f32x8::splat(if is_solid { 255.0 } else { 0.0 }); GROUPS];
        let (Some(plane), Some(look)) = (&self.plane, &self.ground) else {
            return;
        };
        let ends = [x + 0.5, x + TILE as f32 - 0.5];
        if ends.iter().all(|&end| plane.depth.at(end, y + 0.5) <= 0.0) {
            return;
        }
        for group in 0..GROUPS {
            let point = plane.points(x + (group * 8) as f32, y + 0.5);
            let fade = look.fade(&point);
            if !fade.simd_gt(f32x8::splat(0.0)).any() {
                continue;
            }
            if is_solid {
                let light = self.lamp_light(look, &point, fade, (shadow, darkness));
                look.paint(&point, fade, light, group, row);
            }
            if !darkness.is_none() {
                self.darken_group(look, &point, fade, (shadow, darkness), group, row);
            }
        }
    }

    /// The factors of red, green and blue that the lamps make of eight pixels of ground; `None`
    /// without lamps.
    fn lamp_light(
        &self,
        look: &GroundLook,
        point: &Points,
        fade: f32x8,
        (shadow, darkness): (&ShadowMap, &Darkness),
    ) -> Option<[f32x8; 3]> {
        let lit = self.lit.as_ref()?;
        let (xs, zs, fades) = (point.x.to_array(), point.z.to_array(), fade.to_array());
        let mut planes = [[1.0f32; 8]; 3];
        for k in (0..8).filter(|&k| fades[k] > 0.0) {
            let at = Vec3::new(xs[k], look.ground.height, zs[k]);
            let softness = look.shadow_softness;
            let first_light = if darkness.shadowed {
                shadow.light_at(at, softness, softness * 0.1)
            } else {
                1.0
            };
            for (plane, factor) in planes.iter_mut().zip(lit.factors(at, first_light)) {
                plane[k] = factor;
            }
        }
        Some(planes.map(f32x8::from))
    }

    /// Applies shadow and contact to eight pixels.
    fn darken_group(
        &self,
        look: &GroundLook,
        point: &Points,
        fade: f32x8,
        (shadow, darkness): (&ShadowMap, &Darkness),
        group: usize,
        row: &mut FloorRow,
    ) {
        let (xs, zs, fades) = (point.x.to_array(), point.z.to_array(), fade.to_array());
        let mut planes = [0, 1, 2, 3].map(|c| row.planes[c][group].to_array());
        for k in 0..8 {
            if fades[k] > 0.0 {
                let at = Vec3::new(xs[k], look.ground.height, zs[k]);
                let mut pixel = [planes[0][k], planes[1][k], planes[2][k], planes[3][k]];
                self.darken(look, at, fades[k], (shadow, darkness), &mut pixel);
                for (plane, value) in planes.iter_mut().zip(pixel) {
                    plane[k] = value;
                }
            }
        }
        for (to, plane) in row.planes.iter_mut().zip(planes) {
            to[group] = f32x8::from(plane);
        }
    }

    /// Applies shadow and contact to one pixel of ground.
    #[inline]
    fn darken(
        &self,
        look: &GroundLook,
        at: Vec3,
        fade: f32,
        (shadow, darkness): (&ShadowMap, &Darkness),
        pixel: &mut [f32; 4],
    ) {
        let light = if darkness.shadowed && look.shadow_strength > 0.0 {
            shadow.light_at(at, look.shadow_softness, look.shadow_softness * 0.1)
        } else {
            1.0
        };
        let mut open = 1.0;
        for &index in &darkness.contacts {
            let contact = &self.contacts[index];
            let occluded = contact_window(at - contact.center, contact.radius);
            open *= 1.0 - occluded * look.contact_strength;
        }
        if light >= 1.0 && open >= 1.0 {
            return;
        }
        let shade = (1.0 - light) * look.shadow_strength * fade;
        let open = 1.0 - (1.0 - open) * fade;
        match self.background {
            Background::Gradient { .. } => {
                for c in 0..3 {
                    pixel[c] *= (1.0 - shade * SHADOW_TINT[c]) * open;
                }
            }
            Background::Transparent => pixel[3] = 255.0 * (1.0 - (1.0 - shade) * open),
        }
    }
}

/// Eight points of the ground.
struct Points {
    x: f32x8,
    z: f32x8,
    /// One over the world length along X and along Z that a pixel spans.
    per_span_x: f32x8,
    per_span_z: f32x8,
    /// 1 where the ray meets the ground, 0 over the horizon.
    visible: f32x8,
}

impl Plane {
    fn new(scene: &Scene, ground_height: f32, width: u32, height: u32) -> Option<Self> {
        let aspect = width as f32 / height as f32;
        let (width, height) = (f64::from(width), f64::from(height));
        let m = scene.camera.clip_from_world(aspect).as_dmat4();
        let inverse = m.inverse();
        if !inverse.is_finite() {
            return None;
        }
        // The plane y = h in clip space: a X + b Y + c Z + d = 0 after the division by W.
        let plane_in_world = DVec4::new(0.0, 1.0, 0.0, -f64::from(ground_height));
        let plane = inverse.transpose() * plane_in_world;
        if plane.z.abs() < 1e-9 * (plane.x.abs() + plane.y.abs() + plane.w.abs()) {
            return None;
        }
        // X = 2 px / width - 1, Y = 1 - 2 py / height.
        let ndc = |x: f64, y: f64, c: f64| [2.0 * x / width, -2.0 * y / height, c - x + y];
        let depth = ndc(-plane.x / plane.z, -plane.y / plane.z, -plane.w / plane.z);
        let row = |i: usize| {
            let r = inverse_row(&inverse, i);
            let base = ndc(r.x, r.y, r.w);
            Affine2::narrowed([0, 1, 2].map(|k| base[k] + r.z * depth[k]))
        };
        Some(Self {
            depth: Affine2::narrowed(depth),
            x: row(0),
            z: row(2),
            w: row(3),
        })
    }

    /// World bounds of the ground seen in a tile; `None` if its horizon is in it.
    fn bounds(&self, x: f32, y: f32, height: f32) -> Option<(Vec3, Vec3)> {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let (px, py) = (x + dx * TILE as f32, y + dy * TILE as f32);
            if self.depth.at(px, py) <= 0.0 {
                return None;
            }
            let w = self.w.at(px, py);
            let p = Vec3::new(self.x.at(px, py) / w, height, self.z.at(px, py) / w);
            low = low.min(p);
            high = high.max(p);
        }
        Some((low, high))
    }

    fn points(&self, first_x: f32, y: f32) -> Points {
        let x = f32x8::from([0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5]) + f32x8::splat(first_x);
        let w = self.w.at8(x, y);
        let visible = {
            let one = f32x8::splat(1.0);
            self.depth.at8(x, y).simd_gt(f32x8::splat(0.0)) & one
        };
        let inv_w = f32x8::splat(1.0) / w;
        let (px, pz) = (self.x.at8(x, y) * inv_w, self.z.at8(x, y) * inv_w);
        // The derivative of a ratio n / w is (n' - (n / w) w') / w.
        let per_span = |n: &Affine2, value: f32x8| {
            let dx = (f32x8::splat(n.x) - value * f32x8::splat(self.w.x)) * inv_w;
            let dy = (f32x8::splat(n.y) - value * f32x8::splat(self.w.y)) * inv_w;
            f32x8::splat(1.0) / (dx * dx + dy * dy).sqrt()
        };
        Points {
            x: px,
            z: pz,
            per_span_x: per_span(&self.x, px),
            per_span_z: per_span(&self.z, pz),
            visible,
        }
    }
}

fn inverse_row(m: &DMat4, i: usize) -> DVec4 {
    DVec4::new(m.x_axis[i], m.y_axis[i], m.z_axis[i], m.w_axis[i])
}

impl GroundLook {
    /// How much of the ground is seen: 1 near the focus, 0 from the radius on.
    fn fade(&self, p: &Points) -> f32x8 {
        let dx = p.x - f32x8::splat(self.ground.focus.x);
        let dz = p.z - f32x8::splat(self.ground.focus.z);
        let distance = (dx * dx + dz * dz).sqrt() * f32x8::splat(1.0 / self.ground.radius);
        let t = unit((f32x8::splat(1.0) - distance) * f32x8::splat(1.0 / 0.85));
        t * t * (f32x8::splat(3.0) - t - t) * p.visible
    }

    /// Mixes the ground and its grid over the background of eight pixels.
    fn paint(
        &self,
        p: &Points,
        fade: f32x8,
        light: Option<[f32x8; 3]>,
        group: usize,
        row: &mut FloorRow,
    ) {
        let g = &self.ground;
        let minor = line(p, g.grid_spacing, 0.5) * f32x8::splat(0.55);
        let major = line(p, g.grid_spacing * g.major_every as f32, 0.75);
        let lines = minor.fast_max(major);
        let axis = |across: f32x8, per_span: f32x8| {
            unit(f32x8::splat(1.6) - across.abs() * per_span) * f32x8::splat(0.8)
        };
        let (along_x, along_z) = (axis(p.z, p.per_span_z), axis(p.x, p.per_span_x));
        for c in 0..3 {
            let mut value = f32x8::splat(self.color[c]);
            value += (f32x8::splat(self.line[c]) - value) * lines;
            value += (f32x8::splat(self.axes[0][c]) - value) * along_x;
            value += (f32x8::splat(self.axes[1][c]) - value) * along_z;
            if let Some(light) = light {
                value = (value * light[c]).fast_min(f32x8::splat(1.0));
            }
            let under = row.planes[c][group];
            row.planes[c][group] = under + (value * f32x8::splat(255.0) - under) * fade;
        }
    }
}

/// Clamped to 0..=1; for values that are not NaN.
fn unit(value: f32x8) -> f32x8 {
    value
        .fast_max(f32x8::splat(0.0))
        .fast_min(f32x8::splat(1.0))
}

/// Coverage of grid lines `spacing` apart, `half_width` pixels to either side.
fn line(p: &Points, spacing: f32, half_width: f32) -> f32x8 {
    let one_way = |value: f32x8, per_span: f32x8| {
        let cells = value * f32x8::splat(1.0 / spacing);
        let nearest = (cells - rounded(cells)).abs() * f32x8::splat(spacing);
        let coverage = unit(f32x8::splat(half_width + 0.5) - nearest * per_span);
        // Lines closer than a few pixels turn into a flicker: they fade away before that.
        let room = f32x8::splat(spacing) * per_span;
        let sparse = unit((room - f32x8::splat(4.0)) * f32x8::splat(1.0 / 12.0));
        coverage * sparse
    };
    one_way(p.x, p.per_span_x).fast_max(one_way(p.z, p.per_span_z))
}

/// To the nearest integer, for values under two million: adding 1.5 * 2^23 leaves no room for a
/// fraction. Beyond that the grid has long faded.
fn rounded(value: f32x8) -> f32x8 {
    let magic = f32x8::splat(12_582_912.0);
    (value + magic) - magic
}

/// The balls under the bodies' surface that come near the ground.
fn contacts(scene: &Scene, ground_height: f32) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for model in scene
        .models
        .iter()
        .filter(|m| m.shadow == crate::scene::Shadow::Cast)
    {
        for ball in &model.mesh.contact_balls {
            let Some(joint) = model.joints.get(ball.joint as usize) else {
                continue;
            };
            let center = joint.transform_point3(ball.center);
            if center.y - ground_height < ball.radius * CONTACT_REACH {
                contacts.push(Contact {
                    center,
                    radius: ball.radius,
                });
            }
        }
    }
    contacts
}
