//! One tile of the picture: which triangle each of a pixel's four samples shows, and then its
//! colour.
//!
//! A visibility buffer: triangles first only leave their number and depth in the samples, so that
//! every pixel is shaded once for each triangle that is seen in it and never for one that is
//! hidden. Edges are evaluated in a way that gives exactly opposite values from its two sides: no
//! sample on a shared edge is lost or taken twice.

use glam::Vec3;
use wide::{f32x8, u32x8};

use crate::color::encode_linear;
use crate::scene::{Background, Scene, Shadow};
use crate::shading::{BODY_SOFTNESS, lamp_at, lamp_shade, openness_above_ground, shade, tone_map};

use super::floor::{Darkness, Floor, FloorRow};
use super::geometry::{Geometry, ScreenVertex, SurfaceKind, Triangle};
use super::shadow::ShadowMap;

/// Pixels along a tile's side. The samples of a tile fill half a first-level cache.
pub(super) const TILE: usize = 32;
const SAMPLES: usize = 4;
/// No triangle: the floor or the background.
const NOTHING: u32 = u32::MAX;

/// Where the four samples sit in a pixel: the rotated grid that hardware uses, good on edges near
/// the horizontal and the vertical.
pub(super) const SAMPLE_X: [f32; SAMPLES] = [0.375, 0.875, 0.125, 0.625];
pub(super) const SAMPLE_Y: [f32; SAMPLES] = [0.125, 0.375, 0.625, 0.875];

/// What a tile is drawn from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    pub(super) scene: &'a Scene,
    pub(super) geometry: &'a Geometry,
    pub(super) floor: &'a Floor,
    pub(super) shadow: &'a ShadowMap,
    /// Towards the eye, for parallel rays.
    pub(super) back: Vec3,
}

/// Memory for one tile.
#[derive(Debug)]
pub(super) struct TileBuffer {
    depth: Vec<f32x8>,
    id: Vec<u32x8>,
    darkness: Darkness,
    row: FloorRow,
}

/// A block of pixels of the picture that a tile is written to.
#[derive(Debug)]
pub(super) struct Target<'a> {
    /// The picture's rows from the tile's first row on.
    pub(super) band: &'a mut [u8],
    pub(super) picture_width: usize,
    /// The tile's first column and row.
    pub(super) x: usize,
    pub(super) y: usize,
    /// How many of the tile's columns and rows are in the picture.
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl TileBuffer {
    pub(super) fn new() -> Self {
        let groups = TILE * TILE * SAMPLES / 8;
        Self {
            depth: vec![f32x8::splat(0.0); groups],
            id: vec![u32x8::splat(NOTHING); groups],
            darkness: Darkness::default(),
            row: FloorRow::new(),
        }
    }

    /// Draws a tile.
    pub(super) fn draw(&mut self, source: &Source<'_>, triangles: &[u32], target: &mut Target<'_>) {
        let (x, y) = (target.x as f32, target.y as f32);
        source
            .floor
            .darkness(x, y, source.shadow, &mut self.darkness);
        if !triangles.is_empty() {
            self.clear(source.floor, x, y);
            for &id in triangles {
                let triangle = &source.geometry.triangles[id as usize];
                self.rasterise(source.geometry, triangle, id, x, y);
            }
        }
        for row in 0..target.rows {
            let fy = y + row as f32;
            source
                .floor
                .row(x, fy, source.shadow, &self.darkness, &mut self.row);
            let start = (row * target.picture_width + target.x) * 4;
            let out = &mut target.band[start..start + target.columns * 4];
            self.row.write(out);
            if !triangles.is_empty() {
                self.resolve_row(source, row, (x, fy), out);
            }
        }
    }

    fn clear(&mut self, floor: &Floor, x: f32, y: f32) {
        let plane = floor.depth();
        let (offset_x, offset_y) = sample_lanes();
        self.id.fill(u32x8::splat(NOTHING));
        let zero = f32x8::splat(0.0);
        for (group, depth) in self.depth.iter_mut().enumerate() {
            let (row, column) = (group / (TILE / 2), group % (TILE / 2) * 2);
            let px = offset_x + f32x8::splat(x + column as f32);
            let py = offset_y + f32x8::splat(y + row as f32);
            *depth = (px * f32x8::splat(plane.x)
                + (py * f32x8::splat(plane.y) + f32x8::splat(plane.c)))
            .max(zero);
        }
    }

    fn rasterise(&mut self, g: &Geometry, triangle: &Triangle, id: u32, x: f32, y: f32) {
        let corners = triangle.vertices.map(|i| &g.vertices[i as usize]);
        let Some(setup) = Setup::new(corners, x, y) else {
            return;
        };
        let mask = g.surfaces[triangle.surface as usize].sample_mask;
        let lanes: [u32; 8] = std::array::from_fn(|lane| {
            if mask >> (lane % SAMPLES) & 1 == 1 {
                !0
            } else {
                0
            }
        });
        let sample_mask = u32x8::from(lanes);
        let id = u32x8::splat(id);
        let (offset_x, offset_y) = sample_lanes();
        for row in setup.first_row..=setup.last_row {
            let py = offset_y + f32x8::splat(row as f32);
            let terms = setup
                .edges
                .map(|e| py * f32x8::splat(e.b) + f32x8::splat(e.c));
            let z_term = py * f32x8::splat(setup.z.y) + f32x8::splat(setup.z.c);
            for pair in setup.first_pair..=setup.last_pair {
                let px = offset_x + f32x8::splat((pair * 2) as f32);
                let [e0, e1, e2] = &setup.edges;
                let inside = (px * f32x8::splat(e0.a) + terms[0]).simd_ge(f32x8::splat(e0.least))
                    & (px * f32x8::splat(e1.a) + terms[1]).simd_ge(f32x8::splat(e1.least))
                    & (px * f32x8::splat(e2.a) + terms[2]).simd_ge(f32x8::splat(e2.least));
                let z = px * f32x8::splat(setup.z.x) + z_term;
                let group = row * (TILE / 2) + pair;
                let seen = inside & z.simd_gt(self.depth[group]);
                let seen = bytemuck::cast::<f32x8, u32x8>(seen) & sample_mask;
                if seen != u32x8::splat(0) {
                    let choose = bytemuck::cast::<u32x8, f32x8>(seen);
                    self.depth[group] = choose.bitselect(z, self.depth[group]);
                    self.id[group] = (seen & id) | (!seen & self.id[group]);
                }
            }
        }
    }

    /// Shades the pixels of a row in which triangles are seen.
    fn resolve_row(&self, source: &Source<'_>, row: usize, at: (f32, f32), out: &mut [u8]) {
        let solid = matches!(source.scene.background, Background::Gradient { .. });
        for (column, pixel) in out.chunks_exact_mut(4).enumerate() {
            let group = row * (TILE / 2) + column / 2;
            let ids = &self.id[group].to_array()[column % 2 * SAMPLES..][..SAMPLES];
            if ids.iter().all(|&id| id == NOTHING) {
                continue;
            }
            let floor = [pixel[0], pixel[1], pixel[2], pixel[3]];
            let mut sum = [0u32; 3];
            let mut alpha = 0u32;
            let mut last = (NOTHING, floor);
            for &id in ids {
                if id != last.0 {
                    last = if id == NOTHING {
                        (id, floor)
                    } else {
                        let [r, g, b] =
                            shade_pixel(source, id, at.0 + column as f32 + 0.5, at.1 + 0.5);
                        (id, [r, g, b, 255])
                    };
                }
                let [r, g, b, a] = last.1.map(u32::from);
                let weight = if solid { 255 } else { a };
                sum = [
                    sum[0] + r * weight,
                    sum[1] + g * weight,
                    sum[2] + b * weight,
                ];
                alpha += weight;
            }
            // Alpha is not multiplied in, so colours are weighted by it.
            let average = |s: u32| narrow((s + alpha / 2) / alpha.max(1));
            let [r, g, b] = sum.map(average);
            pixel.copy_from_slice(&[r, g, b, narrow((alpha + 2) / 4)]);
        }
    }
}

fn narrow(value: u32) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}

/// The sample positions of two neighbouring pixels.
fn sample_lanes() -> (f32x8, f32x8) {
    let [a, b, c, d] = SAMPLE_X;
    let x = [a, b, c, d, a + 1.0, b + 1.0, c + 1.0, d + 1.0];
    let [a, b, c, d] = SAMPLE_Y;
    (f32x8::from(x), f32x8::from([a, b, c, d, a, b, c, d]))
}

/// An edge function a x + b y + c in tile coordinates; a sample is inside from `least` on.
#[derive(Clone, Copy, Debug)]
struct Edge {
    a: f32,
    b: f32,
    c: f32,
    least: f32,
}

impl Edge {
    fn new(from: &ScreenVertex, to: &ScreenVertex, x: f32, y: f32) -> Self {
        let a = from.y - to.y;
        let b = to.x - from.x;
        // The same end of the edge from either side, so that the sums are exact opposites.
        let anchor = if (from.y, from.x) < (to.y, to.x) {
            from
        } else {
            to
        };
        let c = -(a * (anchor.x - x) + b * (anchor.y - y));
        // A sample right on an edge belongs to the triangle below or to the right of it.
        let takes_edge = a > 0.0 || (a == 0.0 && b > 0.0);
        let least = if takes_edge { 0.0 } else { f32::MIN_POSITIVE };
        Self { a, b, c, least }
    }
}

/// A triangle prepared for a tile.
struct Setup {
    edges: [Edge; 3],
    z: super::floor::Affine2,
    first_row: usize,
    last_row: usize,
    first_pair: usize,
    last_pair: usize,
}

impl Setup {
    fn new([a, b, c]: [&ScreenVertex; 3], x: f32, y: f32) -> Option<Self> {
        let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        let inv_area = 1.0 / area;
        let z_x = ((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) * inv_area;
        let z_y = ((c.z - a.z) * (b.x - a.x) - (b.z - a.z) * (c.x - a.x)) * inv_area;
        let z_c = a.z - z_x * (a.x - x) - z_y * (a.y - y);
        let limit = TILE as f32 - 1.0;
        let first = |p: f32, q: f32, r: f32| p.min(q).min(r).floor().max(0.0);
        let last = |p: f32, q: f32, r: f32| p.max(q).max(r).floor().min(limit);
        let (top, low) = (
            first(a.y - y, b.y - y, c.y - y),
            last(a.y - y, b.y - y, c.y - y),
        );
        let (left, right) = (
            first(a.x - x, b.x - x, c.x - x),
            last(a.x - x, b.x - x, c.x - x),
        );
        if !(top <= low && left <= right) {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "clamped to the tile")]
        let index = |v: f32| v as usize;
        Some(Self {
            edges: [
                Edge::new(a, b, x, y),
                Edge::new(b, c, x, y),
                Edge::new(c, a, x, y),
            ],
            z: super::floor::Affine2 {
                x: z_x,
                y: z_y,
                c: z_c,
            },
            first_row: index(top),
            last_row: index(low),
            first_pair: index(left) / 2,
            last_pair: index(right) / 2,
        })
    }
}

/// The encoded colour of a triangle at a pixel's middle.
fn shade_pixel(source: &Source<'_>, id: u32, x: f32, y: f32) -> [u8; 3] {
    let triangle = &source.geometry.triangles[id as usize];
    let [a, b, c] = triangle
        .vertices
        .map(|i| &source.geometry.vertices[i as usize]);
    // Perspective-correct weights; a middle outside the triangle takes the nearest edge's.
    let weight = |p: &ScreenVertex, q: &ScreenVertex| {
        ((q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x)).max(0.0)
    };
    let (wa, wb, wc) = (
        weight(b, c) * a.inv_w,
        weight(c, a) * b.inv_w,
        weight(a, b) * c.inv_w,
    );
    let sum = wa + wb + wc;
    let scale = if sum > 0.0 { 1.0 / sum } else { 0.0 };
    let (wa, wb, wc) = if sum > 0.0 {
        (wa * scale, wb * scale, wc * scale)
    } else {
        (1.0, 0.0, 0.0)
    };
    let normal = a.normal * wa + b.normal * wb + c.normal * wc;
    let (albedo, shadowed) = match source.geometry.surfaces[triangle.surface as usize].kind {
        SurfaceKind::Unlit => return encode_linear(normal.to_array()),
        SurfaceKind::Lit { albedo, shadowed } => (albedo, shadowed),
    };
    let world = a.world * wa + b.world * wb + c.world * wc;
    let normal = normal * (1.0 / normal.length_squared().max(1e-12).sqrt());
    let lighting = &source.scene.lighting;
    let to_eye = match source.scene.camera.projection {
        crate::camera::Projection::Perspective { .. } => {
            let v = source.scene.camera.eye - world;
            v * (1.0 / v.length_squared().max(1e-12).sqrt())
        }
        crate::camera::Projection::Orthographic { .. } => source.back,
    };
    let radius = lighting.shadow_softness * BODY_SOFTNESS;
    let lamps = source.scene.drawn_lamps();
    let casting = source.scene.casting_lamp();
    let to_light = match casting {
        Some(lamp) => lamp_at(lamp, world).0,
        None => lighting.key_direction,
    };
    let key_light = if shadowed == Shadow::None || normal.dot(to_light) < -0.2 {
        // What faces away gets no key light, so nothing is looked up; ghosts get all of it.
        1.0
    } else {
        source
            .shadow
            .light_at(world + normal * (radius * 1.5), radius, radius * 0.5)
    };
    let openness = source.scene.ground.map_or(1.0, |ground| {
        openness_above_ground(
            world.y - ground.height,
            normal.y,
            lighting.shadow_softness * 16.0,
        )
    });
    let mut linear = shade(albedo, normal, to_eye, key_light, openness, lighting);
    if !source.scene.is_lit() {
        return encode_linear(linear);
    }
    let first_light = if casting.is_some() { key_light } else { 1.0 };
    let added = lamp_shade(albedo, (world, normal), to_eye, first_light, lamps);
    for (sum, added) in linear.iter_mut().zip(added) {
        *sum = (*sum + added) * lighting.exposure;
    }
    encode_linear(tone_map(linear))
}
