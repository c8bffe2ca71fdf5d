//! From the scene to triangles on the screen.
//!
//! Vertices are moved to the screen once, triangles that cross the near plane are cut, faces that
//! look away are dropped, and lines become quads that face the camera. The arithmetic is plain
//! `f32` in a fixed order: the same on every machine.

use glam::{Mat3, Mat4, Vec3};

use crate::color::Color;
use crate::lines::triangulate;
use crate::mesh::MATERIAL_COUNT;
use crate::scene::{Model, Polyline, Scene, Shadow, opacity_quarters};

/// A vertex on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScreenVertex {
    /// Pixels from the left.
    pub(super) x: f32,
    /// Pixels from the top.
    pub(super) y: f32,
    /// Reversed depth.
    pub(super) z: f32,
    /// One over the clip-space w.
    pub(super) inv_w: f32,
    /// Where it is in the world.
    pub(super) world: Vec3,
    /// World normal of a lit surface; the linear colour of an unlit one.
    pub(super) normal: Vec3,
}

/// A triangle on the screen, wound so that its area is positive with y down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) vertices: [u32; 3],
    pub(super) surface: u32,
}

/// What a triangle looks like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub(super) kind: SurfaceKind,
    /// Which of a pixel's four samples it may cover: opacity in quarters.
    pub(super) sample_mask: u8,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SurfaceKind {
    /// Shaded with the scene's lights.
    Lit { albedo: Color, shadowed: Shadow },
    /// Of the colour stored in its vertices.
    Unlit,
}

/// Everything to be rasterised, kept between frames for its memory.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub(super) vertices: Vec<ScreenVertex>,
    pub(super) triangles: Vec<Triangle>,
    pub(super) surfaces: Vec<Surface>,
    clip: Vec<ClipVertex>,
    /// What the normals of each joint of a model are mapped by.
    normals: Vec<Mat3>,
}

#[derive(Clone, Copy, Debug)]
struct ClipVertex {
    clip: [f32; 4],
    world: Vec3,
    normal: Vec3,
}

impl ClipVertex {
    /// How far inside the near plane: positive is visible.
    fn inside(&self) -> f32 {
        self.clip[3] - self.clip[2]
    }

    fn lerp(&self, other: &Self, t: f32) -> Self {
        let mix = |i: usize| self.clip[i] + (other.clip[i] - self.clip[i]) * t;
        Self {
            clip: [mix(0), mix(1), mix(2), mix(3)],
            world: self.world + (other.world - self.world) * t,
            normal: self.normal + (other.normal - self.normal) * t,
        }
    }
}

/// The clip-space transform with a fixed order of operations, and the viewport.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewport {
    columns: [[f32; 4]; 4],
    pub(super) width: f32,
    pub(super) height: f32,
}

impl Viewport {
    pub(super) fn new(clip_from_world: Mat4, width: u32, height: u32) -> Self {
        Self {
            columns: clip_from_world.to_cols_array_2d(),
            width: width as f32,
            height: height as f32,
        }
    }

    fn clip(&self, p: Vec3) -> [f32; 4] {
        let [a, b, c, d] = &self.columns;
        [0, 1, 2, 3].map(|i| a[i] * p.x + b[i] * p.y + c[i] * p.z + d[i])
    }

    fn to_screen(self, vertex: &ClipVertex) -> ScreenVertex {
        let [x, y, z, w] = vertex.clip;
        let inv_w = 1.0 / w;
        ScreenVertex {
            x: (x * inv_w * 0.5 + 0.5) * self.width,
            y: (0.5 - y * inv_w * 0.5) * self.height,
            z: z * inv_w,
            inv_w,
            world: vertex.world,
            normal: vertex.normal,
        }
    }
}

/// Which faces of a surface are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    Front,
    Both,
}

impl Geometry {
    /// Fills itself from the scene.
    pub(super) fn build(&mut self, scene: &Scene, viewport: &Viewport) {
        self.vertices.clear();
        self.triangles.clear();
        self.surfaces.clear();
        for (index, model) in scene.models.iter().enumerate() {
            self.add_model(model, index, viewport);
        }
        for line in &scene.polylines {
            self.add_polyline(line, scene, viewport);
        }
    }

    fn add_model(&mut self, model: &Model, index: usize, viewport: &Viewport) {
        let sample_mask = sample_mask(model.opacity, index);
        if sample_mask == 0 || model.joints.len() < model.mesh.joint_count() {
            return;
        }
        let first_surface = index_u32(self.surfaces.len());
        for material in 0..MATERIAL_COUNT {
            let kind = SurfaceKind::Lit {
                albedo: model.palette[material],
                shadowed: model.shadow,
            };
            self.surfaces.push(Surface { kind, sample_mask });
        }
        self.clip.clear();
        self.clip.reserve(model.mesh.vertices.len());
        self.normals.clear();
        self.normals
            .extend(model.joints.iter().map(|joint| normals_map(&joint.matrix3)));
        for vertex in &model.mesh.vertices {
            let joint = &model.joints[vertex.joint as usize];
            let world = transform(&joint.matrix3, vertex.position) + joint.translation;
            let normal = transform(&self.normals[vertex.joint as usize], vertex.normal);
            self.clip.push(ClipVertex {
                clip: viewport.clip(world),
                world,
                normal,
            });
        }
        let base = index_u32(self.vertices.len());
        self.vertices
            .extend(self.clip.iter().map(|v| viewport.to_screen(v)));
        for corners in &model.mesh.triangles {
            let material = model.mesh.vertices[corners[0] as usize].material as u32;
            let surface = first_surface + material;
            if corners
                .iter()
                .all(|&i| self.clip[i as usize].inside() >= 0.0)
            {
                self.push(corners.map(|i| base + i), surface, Sides::Front, viewport);
            } else {
                let corners = corners.map(|i| self.clip[i as usize]);
                self.push_clipped(&corners, surface, Sides::Front, viewport);
            }
        }
    }

    fn add_polyline(&mut self, line: &Polyline, scene: &Scene, viewport: &Viewport) {
        let sample_mask = sample_mask(line.opacity, 0);
        if sample_mask == 0 {
            return;
        }
        let surface = index_u32(self.surfaces.len());
        self.surfaces.push(Surface {
            kind: SurfaceKind::Unlit,
            sample_mask,
        });
        triangulate(line, &scene.camera, viewport.height, |corners| {
            let corners = corners.map(|(world, color)| ClipVertex {
                clip: viewport.clip(world),
                world,
                normal: Vec3::from_array(color.to_array()),
            });
            self.push_clipped(&corners, surface, Sides::Both, viewport);
        });
    }

    /// Cuts a triangle at the near plane and keeps what is in front of it.
    fn push_clipped(
        &mut self,
        corners: &[ClipVertex; 3],
        surface: u32,
        sides: Sides,
        viewport: &Viewport,
    ) {
        let mut kept = [corners[0]; 4];
        let mut count = 0;
        for k in 0..3 {
            let (a, b) = (&corners[k], &corners[(k + 1) % 3]);
            let (inside_a, inside_b) = (a.inside(), b.inside());
            if inside_a >= 0.0 {
                kept[count] = *a;
                count += 1;
            }
            if (inside_a >= 0.0) != (inside_b >= 0.0) {
                kept[count] = a.lerp(b, inside_a / (inside_a - inside_b));
                count += 1;
            }
        }
        if count < 3 {
            return;
        }
        let base = index_u32(self.vertices.len());
        self.vertices
            .extend(kept[..count].iter().map(|v| viewport.to_screen(v)));
        self.push([base, base + 1, base + 2], surface, sides, viewport);
        if count == 4 {
            self.push([base, base + 2, base + 3], surface, sides, viewport);
        }
    }

    /// Keeps a triangle if it faces the right way and touches the picture.
    fn push(&mut self, vertices: [u32; 3], surface: u32, sides: Sides, viewport: &Viewport) {
        let [a, b, c] = vertices.map(|i| &self.vertices[i as usize]);
        let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        let min = |p: f32, q: f32, r: f32| p.min(q).min(r);
        let max = |p: f32, q: f32, r: f32| p.max(q).max(r);
        let outside = max(a.x, b.x, c.x) < 0.0
            || min(a.x, b.x, c.x) > viewport.width
            || max(a.y, b.y, c.y) < 0.0
            || min(a.y, b.y, c.y) > viewport.height;
        if outside || area.is_nan() || area.abs() <= 1e-7 {
            return;
        }
        // Counter-clockwise in the world is clockwise on a screen whose y runs down.
        if area < 0.0 {
            let [p, q, r] = vertices;
            self.triangles.push(Triangle {
                vertices: [p, r, q],
                surface,
            });
        } else if sides == Sides::Both {
            self.triangles.push(Triangle { vertices, surface });
        }
    }
}

/// The map of normals that belongs to a map of points: its cofactors (the inverse transposed, times
/// the determinant). A rotation's are the rotation itself, to the bit.
fn normals_map(m: &Mat3) -> Mat3 {
    let length2 = [m.x_axis, m.y_axis, m.z_axis].map(Vec3::length_squared);
    if length2
        .iter()
        .all(|l| (l - length2[0]).abs() <= 1e-4 * length2[0])
    {
        return *m;
    }
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

/// Matrix times vector in a fixed order.
fn transform(m: &Mat3, v: Vec3) -> Vec3 {
    m.x_axis * v.x + m.y_axis * v.y + m.z_axis * v.z
}

/// `opacity` as a choice of samples; the choice turns with `index` so that two half-transparent
/// models do not hide each other's samples. Thin veils all take the same sample: many of them
/// shall hide no more than one.
fn sample_mask(opacity: f32, index: usize) -> u8 {
    let turn = index % 4;
    let mask: u8 = match opacity_quarters(opacity) {
        0 => 0,
        1 => return 0b0001,
        2 => 0b1001,
        3 => 0b0111,
        _ => return 0b1111,
    };
    (mask << turn | mask >> (4 - turn)) & 0b1111
}

fn index_u32(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}
