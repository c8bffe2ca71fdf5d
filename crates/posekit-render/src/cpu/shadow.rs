//! The key light's shadow map and its soft lookup.
//!
//! The map is a depth picture of the shadow casters, in parallel projection along the key light or
//! through a lens at the first lamp.
//! Lookup is percentage-closer filtering (Reeves, Salesin and Cook 1987) over a disc of Vogel's
//! spiral (Vogel 1979), each tap blended between four texels.

use glam::Vec3;
use wide::{f32x8, i32x8};

use crate::scene::{Scene, Shadow};
use crate::shading::{SHADOW_TAPS, shadow_disc};
use crate::shadow_frame::{MAP_SIZE, Rays, ShadowFrame};

/// Texels along a side of a cell of the coarse map.
const CELL: usize = 32;
const CELLS: usize = MAP_SIZE / CELL;

/// [`MAP_SIZE`] as the lanes count.
const SIDE_I32: i32 = 1024;

/// Groups of eight taps.
const TAP_GROUPS: usize = SHADOW_TAPS / 8;

/// Eight taps of the filter.
#[derive(Clone, Copy, Debug)]
struct Taps {
    x: f32x8,
    y: f32x8,
}

/// The taps in groups of eight, each of which is spread all over the disc.
fn interleaved_taps() -> [Taps; TAP_GROUPS] {
    let disc = shadow_disc();
    std::array::from_fn(|first| Taps {
        x: f32x8::from(std::array::from_fn::<f32, 8, _>(|k| {
            disc[TAP_GROUPS * k + first].0
        })),
        y: f32x8::from(std::array::from_fn::<f32, 8, _>(|k| {
            disc[TAP_GROUPS * k + first].1
        })),
    })
}

/// Farther from the light than anything: receivers lie below the casters, outside of 0..=1.
const NO_CASTER: f32 = f32::NEG_INFINITY;

/// The shadow map of a scene, kept between frames for its memory.
#[derive(Debug)]
pub(super) struct ShadowMap {
    frame: Option<ShadowFrame>,
    /// Depth of the caster nearest to the light, [`NO_CASTER`] where there is none.
    depths: Vec<f32>,
    /// The largest depth in a cell and its eight neighbours.
    coarse: Vec<f32>,
    disc: [Taps; TAP_GROUPS],
    points: Vec<Vec3>,
}

impl ShadowMap {
    pub(super) fn new() -> Self {
        Self {
            frame: None,
            depths: Vec::new(),
            coarse: Vec::new(),
            disc: interleaved_taps(),
            points: Vec::new(),
        }
    }

    /// Draws the casters into the map.
    pub(super) fn build(&mut self, scene: &Scene) {
        self.frame = ShadowFrame::around(scene);
        let Some(frame) = self.frame else { return };
        self.depths.clear();
        self.depths.resize(MAP_SIZE * MAP_SIZE, NO_CASTER);
        for model in scene.models.iter().filter(|m| m.shadow == Shadow::Cast) {
            if model.joints.len() < model.mesh.joint_count() {
                continue;
            }
            self.points.clear();
            self.points.extend(model.mesh.vertices.iter().map(|vertex| {
                let joint = &model.joints[vertex.joint as usize];
                let m = &joint.matrix3;
                let v = vertex.position;
                let world = m.x_axis * v.x + m.y_axis * v.y + m.z_axis * v.z + joint.translation;
                let p = frame.project(world);
                Vec3::new(p.x * MAP_SIZE as f32, p.y * MAP_SIZE as f32, p.z)
            }));
            for triangle in &model.mesh.triangles {
                let corners = triangle.map(|i| self.points[i as usize]);
                fill(&mut self.depths, corners);
            }
        }
        self.build_coarse();
    }

    fn build_coarse(&mut self) {
        let mut cells = [NO_CASTER; CELLS * CELLS];
        for (y, row) in self.depths.chunks_exact(MAP_SIZE).enumerate() {
            for (x, texels) in row.chunks_exact(CELL).enumerate() {
                let cell = &mut cells[y / CELL * CELLS + x];
                *cell = texels.iter().fold(*cell, |a, &b| a.max(b));
            }
        }
        self.coarse.clear();
        for y in 0..CELLS {
            for x in 0..CELLS {
                let mut largest = NO_CASTER;
                for ny in y.saturating_sub(1)..(y + 2).min(CELLS) {
                    for nx in x.saturating_sub(1)..(x + 2).min(CELLS) {
                        largest = largest.max(cells[ny * CELLS + nx]);
                    }
                }
                self.coarse.push(largest);
            }
        }
    }

    /// Whether any point of the ground between two corners, all of one height, may be in shadow.
    pub(super) fn may_darken(&self, low: Vec3, high: Vec3, radius: f32) -> bool {
        let Some(frame) = &self.frame else {
            return false;
        };
        let (mut first, mut last) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut nearest = f32::INFINITY;
        for (x, z) in [
            (low.x, low.z),
            (high.x, low.z),
            (low.x, high.z),
            (high.x, high.z),
        ] {
            let corner = Vec3::new(x, low.y, z);
            let distance = frame.distance(corner);
            if distance < frame.depth && frame.rays == Rays::FromLamp {
                // Beside the lamp or behind it there is no place on the map to look at.
                return true;
            }
            nearest = nearest.min(distance);
            let p = frame.project(corner);
            first = first.min(p);
            last = last.max(p);
        }
        let reach = radius / frame.side / nearest;
        let cell = |v: f32| index((v * CELLS as f32).max(0.0).min((CELLS - 1) as f32));
        if last.x < -reach || last.y < -reach || first.x > 1.0 + reach || first.y > 1.0 + reach {
            return false;
        }
        // The coarse map's cells already hold their neighbours' depths.
        (cell(first.y)..=cell(last.y)).any(|row| {
            let cells = &self.coarse[row * CELLS + cell(first.x)..=row * CELLS + cell(last.x)];
            cells.iter().any(|&depth| depth > first.z)
        })
    }

    /// How much of the key light reaches a world point, 0..=1: the share of a disc of world
    /// `radius` around it, square to the light, that sees the light.
    #[inline]
    pub(super) fn light_at(&self, point: Vec3, radius: f32, bias: f32) -> f32 {
        let Some(frame) = &self.frame else { return 1.0 };
        let Some(at) = frame.receiver(point, radius, bias) else {
            return 1.0;
        };
        let (x, y, receiver, spread) = (at.x, at.y, at.depth, at.spread);
        let cell = index(y) / CELL * CELLS + index(x) / CELL;
        if self.coarse[cell] <= receiver {
            return 1.0;
        }
        // A part of the taps, from all over the disc. Where they agree the others nearly always do.
        let (first, others) = (&self.disc[0], &self.disc[1..]);
        let probed = self.compare(x, y, spread, first, receiver);
        if probed <= 0.0 || probed >= 8.0 {
            return probed * 0.125;
        }
        let rest = others
            .iter()
            .map(|taps| self.compare(x, y, spread, taps, receiver));
        let lit = probed + rest.sum::<f32>();
        lit * (1.0 / SHADOW_TAPS as f32)
    }

    /// The sum of the lit shares at eight taps around a position, each blended between the four
    /// texels around it.
    #[inline]
    fn compare(&self, x: f32, y: f32, spread: f32, taps: &Taps, receiver: f32) -> f32 {
        let (zero, limit) = (f32x8::splat(0.0), f32x8::splat((MAP_SIZE - 2) as f32));
        let place = |middle: f32, offsets: f32x8| {
            let at = offsets * f32x8::splat(spread) + f32x8::splat(middle - 0.5);
            at.fast_max(zero).fast_min(limit)
        };
        let (x, y) = (place(x, taps.x), place(y, taps.y));
        let (column, row) = (x.fast_trunc_int(), y.fast_trunc_int());
        let (fx, fy) = (x - f32x8::from_i32x8(column), y - f32x8::from_i32x8(row));
        let starts = (row * i32x8::splat(SIDE_I32) + column).to_array();
        let mut texels = [[0.0f32; 8]; 4];
        for (k, &start) in starts.iter().enumerate() {
            let start = usize::try_from(start).unwrap_or(0);
            let found = &self.depths[start..start + MAP_SIZE + 2];
            texels[0][k] = found[0];
            texels[1][k] = found[1];
            texels[2][k] = found[MAP_SIZE];
            texels[3][k] = found[MAP_SIZE + 1];
        }
        let one = f32x8::splat(1.0);
        let [a, b, c, d] =
            texels.map(|depths| f32x8::from(depths).simd_le(f32x8::splat(receiver)) & one);
        let upper = a + (b - a) * fx;
        let lower = c + (d - c) * fx;
        let lit = (upper + (lower - upper) * fy).to_array();
        // Added up in a fixed order.
        ((lit[0] + lit[1]) + (lit[2] + lit[3])) + ((lit[4] + lit[5]) + (lit[6] + lit[7]))
    }
}

/// A non-negative coordinate as an index.
fn index(v: f32) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "coordinates are clamped to the map"
    )]
    let index = v as usize;
    index
}

/// Fills a triangle of either winding with its depth, keeping the larger depth.
fn fill(depths: &mut [f32], [a, b, c]: [Vec3; 3]) {
    let limit = MAP_SIZE as f32 - 1.0;
    let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    // Only faces towards the light: they alone decide the depth of a closed mesh.
    if area.is_nan() || area <= 1e-9 {
        return;
    }
    let low_y = (a.y.min(b.y).min(c.y) - 0.5).ceil().max(0.0);
    let high_y = (a.y.max(b.y).max(c.y) - 0.5).floor().min(limit);
    let inv_area = 1.0 / area;
    let dz_dx = ((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) * inv_area;
    let dz_dy = ((c.z - a.z) * (b.x - a.x) - (b.z - a.z) * (c.x - a.x)) * inv_area;
    let mut row = low_y;
    while row <= high_y {
        let y = row + 0.5;
        let (mut left, mut right) = (f32::INFINITY, f32::NEG_INFINITY);
        for (p, q) in [(a, b), (b, c), (c, a)] {
            if (p.y <= y) != (q.y <= y) {
                let x = p.x + (q.x - p.x) * ((y - p.y) / (q.y - p.y));
                left = left.min(x);
                right = right.max(x);
            }
        }
        let first = (left - 0.5).ceil().max(0.0);
        let last = (right - 0.5).floor().min(limit);
        if first <= last {
            let z_row = a.z + (y - a.y) * dz_dy + (0.5 - a.x) * dz_dx;
            let start = index(row) * MAP_SIZE;
            for column in index(first)..=index(last) {
                let z = z_row + column as f32 * dz_dx;
                let texel = &mut depths[start + column];
                if z > *texel {
                    *texel = z;
                }
            }
        }
        row += 1.0;
    }
}
