//! The scene as the bytes that go to the GPU.

use std::sync::Arc;

use glam::Vec3;

use crate::lines::triangulate;
use crate::mesh::{MATERIAL_COUNT, Mesh};
use crate::scene::{Model, Scene, Shadow, opacity_quarters};
use crate::shading::CONTACT_REACH;
use crate::text::TextBitmap;

use super::globals::visible_ground;

/// Texels in a row of the palette texture; the shader knows the number too.
pub(super) const PALETTE_WIDTH: u32 = 1024;

/// Models that share a mesh and a pipeline, drawn at once.
#[derive(Debug)]
pub(super) struct Batch {
    pub(super) mesh: Arc<Mesh>,
    pub(super) is_ghost: bool,
    pub(super) casts: bool,
    pub(super) instances: std::ops::Range<u32>,
}

/// All that changes from picture to picture, but the globals.
#[derive(Debug, Default)]
pub(super) struct Upload {
    pub(super) batches: Vec<Batch>,
    /// Palette start, opacity, shadow flag of each instance.
    pub(super) instances: Vec<u32>,
    /// Texels of four numbers: per model its colours, then three rows a joint.
    pub(super) palette: Vec<[f32; 4]>,
    /// Middle and radius.
    pub(super) balls: Vec<[f32; 4]>,
    /// Position, colour and opacity of each vertex.
    pub(super) lines: Vec<f32>,
}

impl Upload {
    pub(super) fn new(scene: &Scene, height: u32) -> Self {
        let mut upload = Self::default();
        upload.add_models(scene);
        upload.add_lines(scene, height);
        if let Some(ground) = visible_ground(scene) {
            for model in scene.models.iter().filter(|m| m.shadow == Shadow::Cast) {
                upload.add_balls(model, ground.height);
            }
        }
        upload
    }

    fn add_models(&mut self, scene: &Scene) {
        let drawn = |m: &&Model| {
            m.joints.len() >= m.mesh.joint_count()
                && !m.mesh.triangles.is_empty()
                && opacity_quarters(m.opacity) > 0
        };
        let key = |m: &Model| {
            (
                is_ghost(m),
                m.shadow == Shadow::None,
                Arc::as_ptr(&m.mesh).cast::<u8>() as usize,
            )
        };
        let mut models: Vec<&Model> = scene.models.iter().filter(drawn).collect();
        // Stable: within a batch the scene's order stays.
        models.sort_by_key(|m| key(m));
        for group in models.chunk_by(|a, b| key(a) == key(b)) {
            let first = self.instance_count();
            for model in group {
                self.add_instance(model);
            }
            self.batches.push(Batch {
                mesh: Arc::clone(&group[0].mesh),
                is_ghost: is_ghost(group[0]),
                casts: group[0].shadow == Shadow::Cast,
                instances: first..self.instance_count(),
            });
        }
    }

    fn instance_count(&self) -> u32 {
        u32::try_from(self.instances.len() / 3).unwrap_or(u32::MAX)
    }

    fn add_instance(&mut self, model: &Model) {
        let start = u32::try_from(self.palette.len()).unwrap_or(u32::MAX);
        let opacity = opacity_quarters(model.opacity) as f32 * 0.25;
        let shadowed = if model.shadow == Shadow::Cast {
            1.0f32
        } else {
            0.0
        };
        self.instances
            .extend([start, opacity.to_bits(), shadowed.to_bits()]);
        debug_assert_eq!(model.palette.len(), MATERIAL_COUNT);
        self.palette
            .extend(model.palette.iter().map(|c| [c.r, c.g, c.b, 0.0]));
        for joint in &model.joints {
            let m = &joint.matrix3;
            for row in 0..3 {
                let translation = joint.translation[row];
                self.palette
                    .push([m.x_axis[row], m.y_axis[row], m.z_axis[row], translation]);
            }
        }
    }

    fn add_balls(&mut self, model: &Model, ground_height: f32) {
        for ball in &model.mesh.contact_balls {
            let Some(joint) = model.joints.get(ball.joint as usize) else {
                continue;
            };
            let center: Vec3 = joint.transform_point3(ball.center);
            if center.y - ground_height < ball.radius * CONTACT_REACH {
                self.balls.push([center.x, center.y, center.z, ball.radius]);
            }
        }
    }

    fn add_lines(&mut self, scene: &Scene, height: u32) {
        for line in &scene.polylines {
            let opacity = opacity_quarters(line.opacity) as f32 * 0.25;
            triangulate(line, &scene.camera, height as f32, |corners| {
                for (p, color) in corners {
                    self.lines
                        .extend([p.x, p.y, p.z, color.r, color.g, color.b, opacity]);
                }
            });
        }
    }
}

fn is_ghost(model: &Model) -> bool {
    opacity_quarters(model.opacity) < 4
}

/// A mesh's vertices as the shader reads them.
pub(super) fn vertex_words(mesh: &Mesh) -> Vec<u32> {
    let mut words = Vec::with_capacity(mesh.vertices.len() * 7);
    for vertex in &mesh.vertices {
        let floats = [vertex.position.to_array(), vertex.normal.to_array()];
        words.extend(floats.iter().flatten().map(|f| f.to_bits()));
        words.push(vertex.joint << 8 | vertex.material as u32);
    }
    words
}

/// Texts packed into one texture.
#[derive(Debug, Default)]
pub(super) struct TextAtlas {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Premultiplied bytes.
    pub(super) pixels: Vec<u8>,
    /// Clip position and texel of each vertex.
    pub(super) vertices: Vec<[f32; 4]>,
}

/// Stacks the texts on shelves; what does not fit into `limit` x `limit` is left out.
pub(super) fn pack_texts(
    texts: &[TextBitmap],
    (width, height): (u32, u32),
    limit: u32,
) -> TextAtlas {
    let mut atlas = TextAtlas {
        width: limit.min(1024),
        ..TextAtlas::default()
    };
    let mut places = Vec::new();
    let (mut x, mut y, mut shelf) = (0, 0, 0);
    for text in texts {
        if x + text.width > atlas.width {
            (x, y, shelf) = (0, y + shelf, 0);
        }
        if text.width > atlas.width || y + text.height > limit {
            continue;
        }
        places.push((text, x, y));
        x += text.width;
        shelf = shelf.max(text.height);
        atlas.height = atlas.height.max(y + text.height);
    }
    atlas.pixels = vec![0; atlas.width as usize * atlas.height as usize * 4];
    for (text, x, y) in places {
        let row_bytes = text.width as usize * 4;
        for row in 0..text.height {
            let to = ((y + row) as usize * atlas.width as usize + x as usize) * 4;
            let from = row as usize * row_bytes;
            atlas.pixels[to..to + row_bytes].copy_from_slice(&text.rgba[from..from + row_bytes]);
        }
        let corner = |dx: u32, dy: u32| {
            let px = text.x as f32 + dx as f32;
            let py = text.y as f32 + dy as f32;
            let clip = [
                px / width as f32 * 2.0 - 1.0,
                1.0 - py / height as f32 * 2.0,
            ];
            [clip[0], clip[1], (x + dx) as f32, (y + dy) as f32]
        };
        let (w, h) = (text.width, text.height);
        let [a, b, c, d] = [corner(0, 0), corner(w, 0), corner(0, h), corner(w, h)];
        atlas.vertices.extend([a, c, b, b, c, d]);
    }
    atlas
}
