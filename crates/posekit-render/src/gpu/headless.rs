//! A GPU without a window: finding one, and pictures from it.

use wgpu::{
    Adapter, Backends, BufferDescriptor, BufferUsages, CommandEncoderDescriptor, Device,
    DeviceDescriptor, DeviceType, Extent3d, Instance, InstanceDescriptor, Limits, MapMode,
    Origin3d, PollType, PowerPreference, Queue, RequestAdapterOptions, TexelCopyBufferInfo,
    TexelCopyBufferLayout, TexelCopyTextureInfo, TextureAspect, TextureFormat,
};

use crate::image::Image;
use crate::scene::Scene;

use super::GpuRenderer;

/// Why the GPU back end cannot draw.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no driver that wgpu can use.
    #[error("no graphics driver was found ({0})")]
    NoAdapter(String),
    /// The driver gave no device.
    #[error("the graphics driver refused: {0}")]
    NoDevice(String),
    /// The picture could not be read back.
    #[error("the picture could not be read back from the graphics card: {0}")]
    ReadBack(String),
    /// The picture is larger than the device can draw.
    #[error("{width}x{height} pixels are more than this graphics driver can draw ({limit} a side)")]
    TooLarge {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
        /// The longest side.
        limit: u32,
    },
}

/// The GPU back end with a device of its own, drawing into pictures in memory.
#[derive(Debug)]
pub struct GpuHeadless {
    device: Device,
    queue: Queue,
    renderer: GpuRenderer,
    adapter_name: String,
    is_software: bool,
}

async fn adapter(backends: Backends) -> Result<Adapter, GpuError> {
    let descriptor = InstanceDescriptor {
        backends,
        ..InstanceDescriptor::new_without_display_handle()
    };
    Instance::new(descriptor.with_env())
        .request_adapter(&RequestAdapterOptions {
            power_preference: PowerPreference::HighPerformance,
            ..RequestAdapterOptions::default()
        })
        .await
        .map_err(|error| GpuError::NoAdapter(error.to_string()))
}

impl GpuHeadless {
    /// Opens the most powerful adapter there is, be it a software one.
    ///
    /// The environment variables that wgpu knows (`WGPU_BACKEND` and others) choose among them.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] when there is no driver, [`GpuError::NoDevice`] when it refuses.
    pub fn open() -> Result<Self, GpuError> {
        pollster::block_on(Self::open_async())
    }

    async fn open_async() -> Result<Self, GpuError> {
        // OpenGL only when there is nothing better: merely looking for it makes some drivers write
        // to the terminal.
        let adapter = match adapter(Backends::PRIMARY).await {
            Ok(adapter) => adapter,
            Err(_nothing_better) => adapter(Backends::all()).await?,
        };
        let info = adapter.get_info();
        let limits = Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits());
        let (device, queue) = adapter
            .request_device(&DeviceDescriptor {
                label: Some("posekit"),
                required_limits: limits,
                ..DeviceDescriptor::default()
            })
            .await
            .map_err(|error| GpuError::NoDevice(error.to_string()))?;
        let renderer = GpuRenderer::new(&device, &queue, TextureFormat::Rgba8Unorm);
        Ok(Self {
            renderer,
            device,
            queue,
            adapter_name: format!("{}, {:?}", info.name, info.backend),
            is_software: info.device_type == DeviceType::Cpu,
        })
    }

    /// The adapter's name and the API it is driven by.
    #[must_use]
    pub fn adapter_name(&self) -> &str {
        &self.adapter_name
    }

    /// Whether the adapter is a program instead of a graphics card.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.is_software
    }

    /// Draws a scene into `image`, which gets the size asked for and full alpha.
    ///
    /// # Errors
    /// When the size is too large for the device or the device is lost.
    pub fn render_into(
        &mut self,
        scene: &Scene,
        width: u32,
        height: u32,
        image: &mut Image,
    ) -> Result<(), GpuError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        if width > limit || height > limit {
            return Err(GpuError::TooLarge {
                width,
                height,
                limit,
            });
        }
        image.resize(width, height);
        if width == 0 || height == 0 {
            return Ok(());
        }
        self.renderer.prepare(scene, width, height);
        self.read_back(image)
    }

    fn read_back(&self, image: &mut Image) -> Result<(), GpuError> {
        let lost = |error: &dyn std::fmt::Display| GpuError::ReadBack(error.to_string());
        let (width, height) = (image.width(), image.height());
        let row_bytes = width * 4;
        let padded = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let Some(texture) = self.renderer.texture() else {
            return Ok(());
        };
        let buffer = self.device.create_buffer(&BufferDescriptor {
            label: Some("posekit read back"),
            size: u64::from(padded) * u64::from(height),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self
            .device
            .create_command_encoder(&CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: Origin3d::ZERO,
                aspect: TextureAspect::All,
            },
            TexelCopyBufferInfo {
                buffer: &buffer,
                layout: TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded),
                    rows_per_image: Some(height),
                },
            },
            Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
        );
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.slice(..).map_async(MapMode::Read, move |result| {
            // The other side only goes away after an error of its own.
            let _ = sender.send(result);
        });
        self.device
            .poll(PollType::wait_indefinitely())
            .map_err(|e| lost(&e))?;
        receiver
            .recv()
            .map_err(|e| lost(&e))?
            .map_err(|e| lost(&e))?;
        let mapped = buffer.slice(..).get_mapped_range().map_err(|e| lost(&e))?;
        let rows = mapped.chunks_exact(padded as usize);
        for (to, from) in image
            .as_rgba_mut()
            .chunks_exact_mut(row_bytes as usize)
            .zip(rows)
        {
            to.copy_from_slice(&from[..row_bytes as usize]);
            // Coverage leaves traces in the alpha channel that mean nothing here.
            for pixel in to.chunks_exact_mut(4) {
                pixel[3] = u8::MAX;
            }
        }
        drop(mapped);
        buffer.unmap();
        Ok(())
    }
}
