//! Choosing a back end, and one way to draw with whichever it is.

use std::num::NonZeroUsize;

use crate::cpu::{CpuRenderer, available_threads};
use crate::image::Image;
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
use crate::scene::Background;
use crate::scene::Scene;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The picture is larger than the renderer can draw.
    #[error("a picture of {width}x{height} pixels is too large")]
    TooLarge {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// The GPU back end was asked for and is not in this build.
    #[error("this build has no GPU back end (cargo feature `gpu`)")]
    BuiltWithoutGpu,
    /// The GPU back end failed.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    #[error(transparent)]
    Gpu(#[from] crate::gpu::GpuError),
}

/// Which back end to draw with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum RendererChoice {
    /// The fastest one there is.
    #[default]
    Fastest,
    /// The CPU back end, whose pictures are the same on every machine.
    Cpu,
    /// The GPU back end, on whatever driver there is, be it a software one.
    Gpu,
}

/// A back end that draws scenes into pictures.
#[derive(Debug)]
pub struct Renderer {
    backend: Backend,
    note: String,
}

#[derive(Debug)]
enum Backend {
    Cpu(Box<CpuRenderer>),
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    Gpu {
        gpu: Box<crate::gpu::GpuHeadless>,
        /// For pictures with a transparent background.
        cpu: Box<CpuRenderer>,
    },
}

/// Sides longer than this are refused.
const MAX_SIDE: u32 = 16384;

impl Renderer {
    /// The CPU back end on a number of threads.
    #[must_use]
    pub fn cpu(threads: NonZeroUsize) -> Self {
        let plural = if threads.get() == 1 { "" } else { "s" };
        let note = format!("renderer: CPU, {threads} thread{plural}");
        Self {
            backend: Backend::Cpu(Box::new(CpuRenderer::new(threads))),
            note,
        }
    }

    /// The back end that the choice and the machine give.
    ///
    /// The fastest is a graphics card where there is one, else the CPU back end: a software driver
    /// is slower than that. [`note`](Self::note) says what it became and why.
    ///
    /// # Errors
    /// Only when the GPU back end was asked for and there is none.
    pub fn new(choice: RendererChoice) -> Result<Self, RenderError> {
        match choice {
            RendererChoice::Cpu => Ok(Self::cpu(available_threads())),
            RendererChoice::Gpu => Self::gpu(),
            RendererChoice::Fastest => Ok(Self::fastest()),
        }
    }

    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    fn gpu() -> Result<Self, RenderError> {
        Ok(Self::with_gpu(crate::gpu::GpuHeadless::open()?))
    }

    #[cfg(not(all(feature = "gpu", not(target_arch = "wasm32"))))]
    fn gpu() -> Result<Self, RenderError> {
        Err(RenderError::BuiltWithoutGpu)
    }

    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    fn with_gpu(gpu: crate::gpu::GpuHeadless) -> Self {
        let note = format!("renderer: GPU ({})", gpu.adapter_name());
        let cpu = Box::new(CpuRenderer::new(available_threads()));
        Self {
            backend: Backend::Gpu {
                gpu: Box::new(gpu),
                cpu,
            },
            note,
        }
    }

    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    fn fastest() -> Self {
        let because = |why: &str| {
            let mut renderer = Self::cpu(available_threads());
            renderer.note = format!("{}; {why}", renderer.note);
            renderer
        };
        match crate::gpu::GpuHeadless::open() {
            Ok(gpu) if gpu.is_software() => because(&format!(
                "the only graphics driver is a software one ({}), which is slower; \
                 a graphics card with its driver is faster",
                gpu.adapter_name()
            )),
            Ok(gpu) => Self::with_gpu(gpu),
            Err(error) => because(&format!(
                "{error}; a graphics card with a Vulkan, Metal, Direct3D 12 or OpenGL driver is \
                 faster"
            )),
        }
    }

    #[cfg(not(all(feature = "gpu", not(target_arch = "wasm32"))))]
    fn fastest() -> Self {
        let mut renderer = Self::cpu(available_threads());
        renderer
            .note
            .push_str("; this build has no GPU back end (cargo feature gpu)");
        renderer
    }

    /// One line that says which renderer this is and, where there could be a faster one, how to
    /// get it.
    #[must_use]
    pub fn note(&self) -> &str {
        &self.note
    }

    /// Draws a scene into `image`, which gets the size asked for.
    ///
    /// # Errors
    /// When the size is too large, or the device fails.
    pub fn render_into(
        &mut self,
        scene: &Scene,
        width: u32,
        height: u32,
        image: &mut Image,
    ) -> Result<(), RenderError> {
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(RenderError::TooLarge { width, height });
        }
        match &mut self.backend {
            Backend::Cpu(renderer) => renderer.render_into(scene, width, height, image),
            #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
            Backend::Gpu { gpu, cpu } => match scene.background {
                Background::Transparent => cpu.render_into(scene, width, height, image),
                Background::Gradient { .. } => gpu.render_into(scene, width, height, image)?,
            },
        }
        Ok(())
    }

    /// Draws a scene into a new picture.
    ///
    /// # Errors
    /// As [`render_into`](Self::render_into).
    pub fn render(&mut self, scene: &Scene, width: u32, height: u32) -> Result<Image, RenderError> {
        let mut image = Image::default();
        self.render_into(scene, width, height, &mut image)?;
        Ok(image)
    }

    pub(crate) fn single_threaded_cpu() -> Self {
        Self::cpu(NonZeroUsize::MIN)
    }

    /// On how many threads whole frames can be drawn side by side.
    pub(crate) fn frame_threads(&self) -> usize {
        match &self.backend {
            Backend::Cpu(renderer) => renderer.threads().get(),
            #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
            Backend::Gpu { .. } => 1,
        }
    }
}
