//! The pipelines of the one shader.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BlendComponent,
    BlendFactor, BlendOperation, BlendState, BufferBindingType, ColorTargetState, ColorWrites,
    CompareFunction, DepthBiasState, DepthStencilState, Device, FragmentState, MultisampleState,
    PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, PrimitiveState,
    PrimitiveTopology, RenderPipeline, RenderPipelineDescriptor, SamplerBindingType, ShaderModule,
    ShaderModuleDescriptor, ShaderSource, ShaderStages, StencilState, TextureFormat,
    TextureSampleType, TextureViewDimension, VertexAttribute, VertexBufferLayout, VertexFormat,
    VertexState, VertexStepMode,
};

pub(super) const SHADER: &str = include_str!("shader.wgsl");
pub(super) const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;
pub(super) const SAMPLES: u32 = 4;

/// Bytes of a vertex of a mesh: position, normal, joint and material.
pub(super) const VERTEX_BYTES: u64 = 28;
/// Bytes of an instance: palette start, opacity, shadow.
pub(super) const INSTANCE_BYTES: u64 = 12;
/// Bytes of a contact ball.
pub(super) const BALL_BYTES: u64 = 16;
/// Bytes of a line's vertex: position, colour with opacity.
pub(super) const LINE_BYTES: u64 = 28;
/// Bytes of a text's vertex: clip position, texel.
pub(super) const TEXT_BYTES: u64 = 16;

/// Everything made once a device and target format.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub(super) scene_layout: BindGroupLayout,
    pub(super) maps_layout: BindGroupLayout,
    pub(super) shadow: RenderPipeline,
    pub(super) background: RenderPipeline,
    pub(super) ground: RenderPipeline,
    pub(super) contact: RenderPipeline,
    pub(super) model: RenderPipeline,
    /// Opacity by coverage: see-through without sorting.
    pub(super) ghost: RenderPipeline,
    pub(super) line: RenderPipeline,
    pub(super) text: RenderPipeline,
}

impl Pipelines {
    pub(super) fn new(device: &Device, format: TextureFormat) -> Self {
        let shader = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("posekit"),
            source: ShaderSource::Wgsl(SHADER.into()),
        });
        let scene_layout = scene_layout(device);
        let maps_layout = maps_layout(device);
        let layout = |groups: &[Option<&BindGroupLayout>]| {
            device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label: Some("posekit"),
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let shadow_layout = layout(&[Some(&scene_layout)]);
        let picture_layout = layout(&[Some(&scene_layout), Some(&maps_layout)]);
        let maker = Maker {
            device,
            shader: &shader,
            format,
        };
        let picture = |entries: (&'static str, &'static str), look: Look<'_>| {
            maker.picture(&picture_layout, entries, look)
        };
        let model = |ghost: bool| Look {
            buffers: &MODEL_BUFFERS,
            depth: Depth::TestAndWrite,
            alpha_to_coverage: ghost,
            writes: if ghost {
                ColorWrites::COLOR
            } else {
                ColorWrites::ALL
            },
            ..Look::default()
        };
        Self {
            shadow: maker.shadow(&shadow_layout),
            background: picture(
                ("background_vertex", "background_fragment"),
                Look::default(),
            ),
            ground: picture(
                ("ground_vertex", "ground_fragment"),
                Look {
                    depth: Depth::TestAndWrite,
                    strip: true,
                    ..Look::default()
                },
            ),
            contact: picture(
                ("contact_vertex", "contact_fragment"),
                Look {
                    buffers: &CONTACT_BUFFERS,
                    strip: true,
                    blend: Some(MULTIPLY),
                    ..Look::default()
                },
            ),
            model: picture(("model_vertex", "model_fragment"), model(false)),
            ghost: picture(("model_vertex", "model_fragment"), model(true)),
            line: picture(
                ("line_vertex", "line_fragment"),
                Look {
                    buffers: &LINE_BUFFERS,
                    depth: Depth::TestAndWrite,
                    alpha_to_coverage: true,
                    writes: ColorWrites::COLOR,
                    ..Look::default()
                },
            ),
            text: picture(
                ("text_vertex", "text_fragment"),
                Look {
                    buffers: &TEXT_BUFFERS,
                    blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    ..Look::default()
                },
            ),
            scene_layout,
            maps_layout,
        }
    }
}

/// The uniform buffer and the palette.
fn scene_layout(device: &Device) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("posekit scene"),
        entries: &[
            BindGroupLayoutEntry {
                binding: 0,
                visibility: ShaderStages::VERTEX_FRAGMENT,
                ty: BindingType::Buffer {
                    ty: BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            },
            texture_entry(
                1,
                TextureSampleType::Float { filterable: false },
                ShaderStages::VERTEX,
            ),
        ],
    })
}

/// What is only read when the picture itself is drawn.
fn maps_layout(device: &Device) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("posekit maps"),
        entries: &[
            texture_entry(0, TextureSampleType::Depth, ShaderStages::FRAGMENT),
            BindGroupLayoutEntry {
                binding: 1,
                visibility: ShaderStages::FRAGMENT,
                ty: BindingType::Sampler(SamplerBindingType::Comparison),
                count: None,
            },
            texture_entry(
                2,
                TextureSampleType::Float { filterable: false },
                ShaderStages::FRAGMENT,
            ),
        ],
    })
}

fn texture_entry(
    binding: u32,
    sample_type: TextureSampleType,
    visibility: ShaderStages,
) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility,
        ty: BindingType::Texture {
            sample_type,
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

const fn attribute(shader_location: u32, offset: u64, format: VertexFormat) -> VertexAttribute {
    VertexAttribute {
        format,
        offset,
        shader_location,
    }
}

const MODEL_BUFFERS: [Option<VertexBufferLayout<'static>>; 2] = [
    Some(VertexBufferLayout {
        array_stride: VERTEX_BYTES,
        step_mode: VertexStepMode::Vertex,
        attributes: &[
            attribute(0, 0, VertexFormat::Float32x3),
            attribute(1, 12, VertexFormat::Float32x3),
            attribute(2, 24, VertexFormat::Uint32),
        ],
    }),
    Some(VertexBufferLayout {
        array_stride: INSTANCE_BYTES,
        step_mode: VertexStepMode::Instance,
        attributes: &[
            attribute(3, 0, VertexFormat::Uint32),
            attribute(4, 4, VertexFormat::Float32x2),
        ],
    }),
];

const CONTACT_BUFFERS: [Option<VertexBufferLayout<'static>>; 1] = [Some(VertexBufferLayout {
    array_stride: BALL_BYTES,
    step_mode: VertexStepMode::Instance,
    attributes: &[attribute(0, 0, VertexFormat::Float32x4)],
})];

const LINE_BUFFERS: [Option<VertexBufferLayout<'static>>; 1] = [Some(VertexBufferLayout {
    array_stride: LINE_BYTES,
    step_mode: VertexStepMode::Vertex,
    attributes: &[
        attribute(0, 0, VertexFormat::Float32x3),
        attribute(1, 12, VertexFormat::Float32x4),
    ],
})];

const TEXT_BUFFERS: [Option<VertexBufferLayout<'static>>; 1] = [Some(VertexBufferLayout {
    array_stride: TEXT_BYTES,
    step_mode: VertexStepMode::Vertex,
    attributes: &[
        attribute(0, 0, VertexFormat::Float32x2),
        attribute(1, 8, VertexFormat::Float32x2),
    ],
})];

/// Target times source.
const MULTIPLY: BlendState = BlendState {
    color: BlendComponent {
        src_factor: BlendFactor::Dst,
        dst_factor: BlendFactor::Zero,
        operation: BlendOperation::Add,
    },
    alpha: BlendComponent {
        src_factor: BlendFactor::Zero,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    },
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Depth {
    Ignore,
    TestAndWrite,
}

/// How a pipeline differs from the plainest one.
struct Look<'a> {
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    depth: Depth,
    blend: Option<BlendState>,
    alpha_to_coverage: bool,
    writes: ColorWrites,
    strip: bool,
}

impl Default for Look<'_> {
    fn default() -> Self {
        Self {
            buffers: &[],
            depth: Depth::Ignore,
            blend: None,
            alpha_to_coverage: false,
            writes: ColorWrites::ALL,
            strip: false,
        }
    }
}

struct Maker<'a> {
    device: &'a Device,
    shader: &'a ShaderModule,
    format: TextureFormat,
}

impl Maker<'_> {
    fn picture(
        &self,
        layout: &PipelineLayout,
        (vertex, fragment): (&'static str, &'static str),
        look: Look<'_>,
    ) -> RenderPipeline {
        let tests = look.depth == Depth::TestAndWrite;
        let topology = if look.strip {
            PrimitiveTopology::TriangleStrip
        } else {
            PrimitiveTopology::TriangleList
        };
        let compare = if tests {
            CompareFunction::Greater
        } else {
            CompareFunction::Always
        };
        self.device
            .create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(vertex),
                layout: Some(layout),
                vertex: VertexState {
                    module: self.shader,
                    entry_point: Some(vertex),
                    compilation_options: PipelineCompilationOptions::default(),
                    buffers: look.buffers,
                },
                primitive: PrimitiveState {
                    topology,
                    ..PrimitiveState::default()
                },
                depth_stencil: Some(depth_state(tests, compare)),
                multisample: MultisampleState {
                    count: SAMPLES,
                    mask: !0,
                    alpha_to_coverage_enabled: look.alpha_to_coverage,
                },
                fragment: Some(FragmentState {
                    module: self.shader,
                    entry_point: Some(fragment),
                    compilation_options: PipelineCompilationOptions::default(),
                    targets: &[Some(ColorTargetState {
                        format: self.format,
                        blend: look.blend,
                        write_mask: look.writes,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
    }

    /// Depth only, seen along the light.
    fn shadow(&self, layout: &PipelineLayout) -> RenderPipeline {
        self.device
            .create_render_pipeline(&RenderPipelineDescriptor {
                label: Some("shadow_vertex"),
                layout: Some(layout),
                vertex: VertexState {
                    module: self.shader,
                    entry_point: Some("shadow_vertex"),
                    compilation_options: PipelineCompilationOptions::default(),
                    buffers: &MODEL_BUFFERS,
                },
                primitive: PrimitiveState::default(),
                depth_stencil: Some(depth_state(true, CompareFunction::Greater)),
                multisample: MultisampleState::default(),
                fragment: None,
                multiview_mask: None,
                cache: None,
            })
    }
}

fn depth_state(writes: bool, compare: CompareFunction) -> DepthStencilState {
    DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(writes),
        depth_compare: Some(compare),
        stencil: StencilState::default(),
        bias: DepthBiasState::default(),
    }
}
