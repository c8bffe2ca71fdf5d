//! The GPU back end: the same scenes through wgpu, into a texture or a picture.
//!
//! One shader for Vulkan, Metal, Direct3D 12, OpenGL, WebGPU and WebGL2: nothing beyond wgpu's
//! limits for WebGL2 is asked for. Four samples a pixel and the shadow map are drawn off screen in
//! [`GpuRenderer::prepare`]; a window only has to show the texture. On the web, where nothing may
//! block, there is no headless device: the page hands its own to [`GpuRenderer::new`].

mod globals;
#[cfg(not(target_arch = "wasm32"))]
mod headless;
mod pipelines;
mod upload;

use std::sync::Arc;

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferDescriptor,
    BufferUsages, Color as ClearColor, CommandEncoder, CommandEncoderDescriptor, CompareFunction,
    Device, Extent3d, FilterMode, IndexFormat, LoadOp, Operations, Origin3d, Queue, RenderPass,
    RenderPassColorAttachment, RenderPassDepthStencilAttachment, RenderPassDescriptor, Sampler,
    SamplerDescriptor, StoreOp, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture,
    TextureAspect, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor,
};

use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::shadow_frame::{MAP_SIZE, ShadowFrame};

use globals::{Globals, visible_ground};
#[cfg(not(target_arch = "wasm32"))]
pub use headless::{GpuError, GpuHeadless};
use pipelines::{DEPTH_FORMAT, Pipelines, SAMPLES};
use upload::{Batch, PALETTE_WIDTH, Upload, pack_texts, vertex_words};

/// A mesh that was not drawn for this many pictures is forgotten.
const MESH_LIFE: u64 = 240;

/// Draws scenes into a texture of its own.
#[derive(Debug)]
pub struct GpuRenderer {
    device: Device,
    queue: Queue,
    format: TextureFormat,
    pipelines: Pipelines,
    globals: Buffer,
    shadow_map: TextureView,
    shadow_sampler: Sampler,
    meshes: Vec<MeshBuffers>,
    instances: Option<Buffer>,
    balls: Option<Buffer>,
    lines: Option<Buffer>,
    texts: Option<Buffer>,
    palette: Texture,
    text_atlas: Texture,
    target: Option<Target>,
    pictures: u64,
}

/// A mesh on the GPU.
#[derive(Debug)]
struct MeshBuffers {
    /// Kept, so that its address is not given to another mesh.
    mesh: Arc<Mesh>,
    vertices: Buffer,
    indices: Buffer,
    index_count: u32,
    last_drawn: u64,
}

/// Textures of the picture's size.
#[derive(Debug)]
struct Target {
    size: (u32, u32),
    texture: Texture,
    view: TextureView,
    samples: TextureView,
    depth: TextureView,
}

impl GpuRenderer {
    /// A renderer whose texture has `format`: four 8-bit channels. In a format that is not sRGB the
    /// texture holds sRGB-encoded values all the same, as most toolkits want them.
    #[must_use]
    pub fn new(device: &Device, queue: &Queue, format: TextureFormat) -> Self {
        let shadow_map = texture(
            device,
            (to_u32(MAP_SIZE), to_u32(MAP_SIZE)),
            DEPTH_FORMAT,
            1,
            TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        );
        let shadow_sampler = device.create_sampler(&SamplerDescriptor {
            label: Some("posekit shadow"),
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            compare: Some(CompareFunction::GreaterEqual),
            ..SamplerDescriptor::default()
        });
        let globals = device.create_buffer(&BufferDescriptor {
            label: Some("posekit globals"),
            size: size_of::<Globals>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            pipelines: Pipelines::new(device, format),
            globals,
            shadow_map: shadow_map.create_view(&TextureViewDescriptor::default()),
            shadow_sampler,
            meshes: Vec::new(),
            instances: None,
            balls: None,
            lines: None,
            texts: None,
            palette: data_texture(device, PALETTE_WIDTH, 1, TextureFormat::Rgba32Float),
            text_atlas: data_texture(device, 1, 1, TextureFormat::Rgba8Unorm),
            target: None,
            device: device.clone(),
            queue: queue.clone(),
            format,
            pictures: 0,
        }
    }

    /// Draws a scene in the given size (sides of 0 count as 1) and gives the texture's view. It
    /// stays the same view until the size changes.
    ///
    /// A transparent background is drawn black: pictures with alpha are the CPU back end's.
    pub fn prepare(&mut self, scene: &Scene, width: u32, height: u32) -> &TextureView {
        let size = (width.max(1), height.max(1));
        self.pictures += 1;
        let mut target = match self.target.take() {
            Some(target) if target.size == size => target,
            _ => self.new_target(size),
        };
        let upload = self.upload(scene, size);
        let mut encoder = self
            .device
            .create_command_encoder(&CommandEncoderDescriptor {
                label: Some("posekit"),
            });
        let scene_group = self.scene_group();
        self.draw_shadows(&mut encoder, &upload, &scene_group);
        self.draw_picture(&mut encoder, scene, &upload, &scene_group, &mut target);
        self.queue.submit([encoder.finish()]);
        self.forget_old_meshes();
        &self.target.insert(target).view
    }

    /// The texture of the last picture.
    #[must_use]
    pub fn texture(&self) -> Option<&Texture> {
        self.target.as_ref().map(|target| &target.texture)
    }

    fn new_target(&self, size: (u32, u32)) -> Target {
        let usage = TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC;
        let attachment = TextureUsages::RENDER_ATTACHMENT;
        let view = |t: &Texture| t.create_view(&TextureViewDescriptor::default());
        let picture = texture(&self.device, size, self.format, 1, usage);
        let samples = texture(&self.device, size, self.format, SAMPLES, attachment);
        let depth = texture(&self.device, size, DEPTH_FORMAT, SAMPLES, attachment);
        Target {
            size,
            view: view(&picture),
            samples: view(&samples),
            depth: view(&depth),
            texture: picture,
        }
    }

    /// Sends everything about a scene to the GPU.
    fn upload(&mut self, scene: &Scene, size: (u32, u32)) -> Drawn {
        let frame = ShadowFrame::around(scene);
        let encodes = self.format.is_srgb();
        let globals = Globals::new(scene, size, frame.as_ref(), encodes);
        self.queue
            .write_buffer(&self.globals, 0, bytemuck::bytes_of(&globals));
        let upload = Upload::new(scene, size.1);
        let vertex = BufferUsages::VERTEX;
        let (device, queue) = (&self.device, &self.queue);
        write(
            device,
            queue,
            &mut self.instances,
            bytemuck::cast_slice(&upload.instances),
            vertex,
        );
        write(
            device,
            queue,
            &mut self.balls,
            bytemuck::cast_slice(&upload.balls),
            vertex,
        );
        write(
            device,
            queue,
            &mut self.lines,
            bytemuck::cast_slice(&upload.lines),
            vertex,
        );
        self.write_palette(&upload.palette);
        let limit = self.device.limits().max_texture_dimension_2d;
        let texts = pack_texts(&crate::text::layout(scene, size.0, size.1), size, limit);
        let (device, queue) = (&self.device, &self.queue);
        write(
            device,
            queue,
            &mut self.texts,
            bytemuck::cast_slice(&texts.vertices),
            vertex,
        );
        if texts.height > 0 {
            ensure_texture(device, &mut self.text_atlas, texts.width, texts.height);
            write_texture(
                queue,
                &self.text_atlas,
                (texts.width, texts.height),
                &texts.pixels,
                4,
            );
        }
        for batch in &upload.batches {
            self.ensure_mesh(&batch.mesh);
        }
        Drawn {
            batches: upload.batches,
            ball_count: to_u32(upload.balls.len()),
            line_vertices: to_u32(upload.lines.len() / 7),
            text_vertices: to_u32(texts.vertices.len()),
            has_shadows: frame.is_some(),
        }
    }

    fn write_palette(&mut self, texels: &[[f32; 4]]) {
        let rows = to_u32(texels.len()).div_ceil(PALETTE_WIDTH).max(1);
        let limit = self.device.limits().max_texture_dimension_2d;
        let rows = rows.min(limit);
        ensure_texture(&self.device, &mut self.palette, PALETTE_WIDTH, rows);
        let mut padded = texels.to_vec();
        padded.resize(PALETTE_WIDTH as usize * rows as usize, [0.0; 4]);
        let bytes = bytemuck::cast_slice(&padded);
        write_texture(&self.queue, &self.palette, (PALETTE_WIDTH, rows), bytes, 16);
    }

    fn ensure_mesh(&mut self, mesh: &Arc<Mesh>) {
        let pictures = self.pictures;
        if let Some(known) = self.meshes.iter_mut().find(|m| Arc::ptr_eq(&m.mesh, mesh)) {
            known.last_drawn = pictures;
            return;
        }
        let words = vertex_words(mesh);
        let (mut vertices, mut indices) = (None, None);
        let (device, queue) = (&self.device, &self.queue);
        write(
            device,
            queue,
            &mut vertices,
            bytemuck::cast_slice(&words),
            BufferUsages::VERTEX,
        );
        let triangles = bytemuck::cast_slice(&mesh.triangles);
        write(device, queue, &mut indices, triangles, BufferUsages::INDEX);
        if let (Some(vertices), Some(indices)) = (vertices, indices) {
            self.meshes.push(MeshBuffers {
                mesh: Arc::clone(mesh),
                vertices,
                indices,
                index_count: to_u32(mesh.triangles.len() * 3),
                last_drawn: pictures,
            });
        }
    }

    fn forget_old_meshes(&mut self) {
        let pictures = self.pictures;
        self.meshes
            .retain(|mesh| mesh.last_drawn + MESH_LIFE > pictures);
    }

    fn scene_group(&self) -> BindGroup {
        let palette = self.palette.create_view(&TextureViewDescriptor::default());
        self.device.create_bind_group(&BindGroupDescriptor {
            label: Some("posekit scene"),
            layout: &self.pipelines.scene_layout,
            entries: &[
                BindGroupEntry {
                    binding: 0,
                    resource: self.globals.as_entire_binding(),
                },
                BindGroupEntry {
                    binding: 1,
                    resource: BindingResource::TextureView(&palette),
                },
            ],
        })
    }

    fn maps_group(&self) -> BindGroup {
        let atlas = self
            .text_atlas
            .create_view(&TextureViewDescriptor::default());
        let view = |binding, view| BindGroupEntry {
            binding,
            resource: BindingResource::TextureView(view),
        };
        self.device.create_bind_group(&BindGroupDescriptor {
            label: Some("posekit maps"),
            layout: &self.pipelines.maps_layout,
            entries: &[
                view(0, &self.shadow_map),
                BindGroupEntry {
                    binding: 1,
                    resource: BindingResource::Sampler(&self.shadow_sampler),
                },
                view(2, &atlas),
            ],
        })
    }

    fn draw_shadows(&self, encoder: &mut CommandEncoder, drawn: &Drawn, scene_group: &BindGroup) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("posekit shadow"),
            color_attachments: &[],
            depth_stencil_attachment: Some(cleared_depth(&self.shadow_map, StoreOp::Store)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        if drawn.has_shadows {
            pass.set_pipeline(&self.pipelines.shadow);
            pass.set_bind_group(0, scene_group, &[]);
            self.draw_batches(&mut pass, drawn.batches.iter().filter(|b| b.casts));
        }
    }

    fn draw_picture(
        &self,
        encoder: &mut CommandEncoder,
        scene: &Scene,
        drawn: &Drawn,
        scene_group: &BindGroup,
        target: &mut Target,
    ) {
        let maps_group = self.maps_group();
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("posekit picture"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &target.samples,
                depth_slice: None,
                resolve_target: Some(&target.view),
                ops: Operations {
                    load: LoadOp::Clear(ClearColor::BLACK),
                    store: StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(cleared_depth(&target.depth, StoreOp::Discard)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_bind_group(0, scene_group, &[]);
        pass.set_bind_group(1, &maps_group, &[]);
        pass.set_pipeline(&self.pipelines.background);
        pass.draw(0..3, 0..1);
        if visible_ground(scene).is_some() {
            pass.set_pipeline(&self.pipelines.ground);
            pass.draw(0..4, 0..1);
            if let Some(balls) = self.balls.as_ref().filter(|_| drawn.ball_count > 0) {
                pass.set_pipeline(&self.pipelines.contact);
                pass.set_vertex_buffer(0, balls.slice(..));
                pass.draw(0..4, 0..drawn.ball_count);
            }
        }
        pass.set_pipeline(&self.pipelines.model);
        self.draw_batches(&mut pass, drawn.batches.iter().filter(|b| !b.is_ghost));
        pass.set_pipeline(&self.pipelines.ghost);
        self.draw_batches(&mut pass, drawn.batches.iter().filter(|b| b.is_ghost));
        let plain = [
            (&self.pipelines.line, &self.lines, drawn.line_vertices),
            (&self.pipelines.text, &self.texts, drawn.text_vertices),
        ];
        for (pipeline, buffer, count) in plain {
            if let Some(buffer) = buffer.as_ref().filter(|_| count > 0) {
                pass.set_pipeline(pipeline);
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..count, 0..1);
            }
        }
    }

    fn draw_batches<'b>(
        &self,
        pass: &mut RenderPass<'_>,
        batches: impl Iterator<Item = &'b Batch>,
    ) {
        let Some(instances) = &self.instances else {
            return;
        };
        for batch in batches {
            let found = self
                .meshes
                .iter()
                .find(|m| Arc::ptr_eq(&m.mesh, &batch.mesh));
            let Some(mesh) = found else { continue };
            pass.set_vertex_buffer(0, mesh.vertices.slice(..));
            // An offset instead of a first instance, which WebGL2 does not have.
            let offset = u64::from(batch.instances.start) * pipelines::INSTANCE_BYTES;
            pass.set_vertex_buffer(1, instances.slice(offset..));
            pass.set_index_buffer(mesh.indices.slice(..), IndexFormat::Uint32);
            let count = batch.instances.end - batch.instances.start;
            pass.draw_indexed(0..mesh.index_count, 0, 0..count);
        }
    }
}

/// What an upload left to be drawn.
struct Drawn {
    batches: Vec<Batch>,
    ball_count: u32,
    line_vertices: u32,
    text_vertices: u32,
    has_shadows: bool,
}

fn cleared_depth(view: &TextureView, store: StoreOp) -> RenderPassDepthStencilAttachment<'_> {
    // Depth is reversed: 0 is the farthest.
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations {
            load: LoadOp::Clear(0.0),
            store,
        }),
        stencil_ops: None,
    }
}

fn to_u32(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

fn texture(
    device: &Device,
    (width, height): (u32, u32),
    format: TextureFormat,
    sample_count: u32,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some("posekit"),
        size: Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn data_texture(device: &Device, width: u32, height: u32, format: TextureFormat) -> Texture {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    texture(device, (width, height), format, 1, usage)
}

/// Makes a data texture large enough; its height grows in powers of two.
fn ensure_texture(device: &Device, held: &mut Texture, width: u32, height: u32) {
    if held.width() != width || held.height() < height {
        let limit = device.limits().max_texture_dimension_2d;
        let rows = height.next_power_of_two().min(limit);
        *held = data_texture(device, width, rows, held.format());
    }
}

fn write_texture(
    queue: &Queue,
    to: &Texture,
    (width, height): (u32, u32),
    bytes: &[u8],
    texel_bytes: u32,
) {
    let info = TexelCopyTextureInfo {
        texture: to,
        mip_level: 0,
        origin: Origin3d::ZERO,
        aspect: TextureAspect::All,
    };
    let layout = TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(width * texel_bytes),
        rows_per_image: Some(height),
    };
    queue.write_texture(
        info,
        bytes,
        layout,
        Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
    );
}

/// Writes bytes into a buffer that grows when it must; nothing to write leaves it as it is.
fn write(
    device: &Device,
    queue: &Queue,
    held: &mut Option<Buffer>,
    bytes: &[u8],
    usage: BufferUsages,
) {
    if bytes.is_empty() {
        return;
    }
    let needed = bytes.len() as u64;
    let fits = held.as_ref().is_some_and(|buffer| buffer.size() >= needed);
    if !fits {
        *held = Some(device.create_buffer(&BufferDescriptor {
            label: Some("posekit"),
            size: needed.next_power_of_two().max(64),
            usage: usage | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        }));
    }
    if let Some(buffer) = held {
        queue.write_buffer(buffer, 0, bytes);
    }
}
