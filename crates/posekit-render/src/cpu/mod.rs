//! The CPU back end: a picture on any machine.
//!
//! A tiled rasteriser with four samples a pixel, a shadow map, and shading once per pixel and
//! visible triangle. The same scene gives the same bytes on every machine and with any number of
//! threads: arithmetic is plain IEEE `f32` in a fixed order (no fused multiply-add, no platform
//! trigonometry), and threads share out rows of tiles whose contents do not depend on one another.

mod floor;
mod geometry;
mod shadow;
mod tile;

use std::num::NonZeroUsize;
use std::sync::Mutex;

use crate::image::Image;
use crate::scene::Scene;

use floor::Floor;
use geometry::{Geometry, Viewport};
use shadow::ShadowMap;
use tile::{Source, TILE, Target, TileBuffer};

/// Draws scenes on the CPU. It keeps its memory from picture to picture.
#[derive(Debug)]
pub struct CpuRenderer {
    threads: NonZeroUsize,
    geometry: Geometry,
    shadow: ShadowMap,
    bins: Vec<Vec<u32>>,
    tiles: Vec<TileBuffer>,
}

impl CpuRenderer {
    /// A renderer that draws each picture on `threads` threads. Where threads cannot be had (the
    /// web), ask for one.
    #[must_use]
    pub fn new(threads: NonZeroUsize) -> Self {
        Self {
            threads,
            geometry: Geometry::default(),
            shadow: ShadowMap::new(),
            bins: Vec::new(),
            tiles: (0..threads.get()).map(|_| TileBuffer::new()).collect(),
        }
    }

    /// The number of threads it was made for.
    #[must_use]
    pub fn threads(&self) -> NonZeroUsize {
        self.threads
    }

    /// Draws `scene` into a new picture of `width` x `height` pixels.
    pub fn render(&mut self, scene: &Scene, width: u32, height: u32) -> Image {
        let mut image = Image::default();
        self.render_into(scene, width, height, &mut image);
        image
    }

    /// Draws `scene` into `image`, which gets the size asked for and keeps its memory.
    pub fn render_into(&mut self, scene: &Scene, width: u32, height: u32, image: &mut Image) {
        image.resize(width, height);
        if width == 0 || height == 0 {
            return;
        }
        let aspect = width as f32 / height as f32;
        let viewport = Viewport::new(scene.camera.clip_from_world(aspect), width, height);
        self.geometry.build(scene, &viewport);
        self.shadow.build(scene);
        let floor = Floor::new(scene, width, height);
        let (columns, rows) = (tiles_in(width), tiles_in(height));
        self.bin(columns, rows);
        let (_, _, back) = scene.camera.axes();
        let source = Source {
            scene,
            geometry: &self.geometry,
            floor: &floor,
            shadow: &self.shadow,
            back,
        };
        let bins = &self.bins;
        let picture_width = width as usize;
        let bands = image
            .as_rgba_mut()
            .chunks_mut(picture_width * 4 * TILE)
            .enumerate();
        let bands = Mutex::new(bands);
        let next = || bands.lock().ok().and_then(|mut bands| bands.next());
        let draw_bands = |buffer: &mut TileBuffer| {
            while let Some((band_index, band)) = next() {
                for column in 0..columns {
                    let x = column * TILE;
                    let mut target = Target {
                        rows: band.len() / (picture_width * 4),
                        band,
                        picture_width,
                        x,
                        y: band_index * TILE,
                        columns: TILE.min(picture_width - x),
                    };
                    let triangles = &bins[band_index * columns + column];
                    buffer.draw(&source, triangles, &mut target);
                }
            }
        };
        let texts = crate::text::layout(scene, width, height);
        let Some((own, others)) = self.tiles.split_first_mut() else {
            return;
        };
        let helpers = others
            .len()
            .min(rows.saturating_sub(1))
            .min(self.threads.get() - 1);
        if helpers == 0 {
            draw_bands(own);
        } else {
            std::thread::scope(|scope| {
                for buffer in &mut others[..helpers] {
                    let draw_bands = &draw_bands;
                    scope.spawn(move || draw_bands(buffer));
                }
                draw_bands(own);
            });
        }
        crate::text::blend(&texts, image);
    }

    /// Sorts the triangles into the tiles that their bounding boxes touch.
    fn bin(&mut self, columns: usize, rows: usize) {
        self.bins.resize_with(columns * rows, Vec::new);
        for bin in &mut self.bins {
            bin.clear();
        }
        for (id, triangle) in self.geometry.triangles.iter().enumerate() {
            let id = u32::try_from(id).unwrap_or(u32::MAX);
            let [a, b, c] = triangle
                .vertices
                .map(|i| &self.geometry.vertices[i as usize]);
            let across = tile_range(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), columns);
            let down = tile_range(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), rows);
            for row in down {
                for column in across.clone() {
                    self.bins[row * columns + column].push(id);
                }
            }
        }
    }
}

/// Draws one picture on as many threads as the machine has cores.
#[must_use]
pub fn render(scene: &Scene, width: u32, height: u32) -> Image {
    CpuRenderer::new(available_threads()).render(scene, width, height)
}

/// The number of threads that can run at once; one where there are none to be had.
#[must_use]
pub fn available_threads() -> NonZeroUsize {
    if cfg!(target_arch = "wasm32") {
        NonZeroUsize::MIN
    } else {
        std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
    }
}

fn tiles_in(pixels: u32) -> usize {
    (pixels as usize).div_ceil(TILE)
}

fn tile_range(low: f32, high: f32, tiles: usize) -> std::ops::Range<usize> {
    let last = (tiles - 1) as f32;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to the number of tiles"
    )]
    let index = |v: f32| (v / TILE as f32).max(0.0).min(last) as usize;
    index(low)..index(high) + 1
}
