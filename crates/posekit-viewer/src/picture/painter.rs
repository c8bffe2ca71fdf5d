//! The painter: keeps the view's texture up to date without ever making the window wait.
//!
//! With a graphics card the scene is drawn into a texture that the window shows. Without one (a
//! software driver counts as none) pictures are drawn on the CPU by a thread of its own, the newest
//! scene next; what is on the screen is then at most one picture old. A [`Shot`] remembers from
//! where and when the picture on the screen was taken, so that what is drawn over it fits.

use std::num::NonZeroUsize;

use eframe::egui_wgpu::RenderState;
use egui::{Color32, Rect, TextureId, pos2, vec2};
use posekit::pose::GlobalPose;
use posekit_render::camera::Camera;
use posekit_render::cpu::CpuRenderer;
use posekit_render::image::Image;
use posekit_render::render::RendererChoice;
use posekit_render::scene::Scene;

use super::{Texture, to_color_image};
use crate::state::session::{ClipId, Session};
use crate::theme::Palette;

/// More pixels than this are drawn smaller while things move, and sharp when they stand.
const MOVING_PIXELS: f32 = 720_000.0;

/// From where and when a picture was taken.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The camera.
    pub camera: Camera,
    /// The figures as they stood, positions on the stage.
    pub poses: Vec<(ClipId, GlobalPose)>,
    key: Key,
}

/// Which of the window's rooms a picture is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The stage, with the clips.
    Stage,
    /// The bench of the arm lab.
    Bench,
    /// The bodies of the interpolation lab.
    Orientations,
    /// The figures of the interpolation lab.
    FilledClip,
}

/// What a picture is of. The closures are called only when one is to be drawn.
pub struct Subject<'a> {
    /// Where.
    pub place: Place,
    /// A number that changes whenever what is there does.
    pub version: u64,
    /// The time that it is shown at.
    pub time_secs: f64,
    /// From where.
    pub camera: Camera,
    /// Whether it moves by itself.
    pub moves: bool,
    /// What is there.
    pub scene: &'a dyn Fn() -> Scene,
    /// The figures as they stand.
    pub poses: &'a dyn Fn() -> Vec<(ClipId, GlobalPose)>,
}

impl std::fmt::Debug for Subject<'_> {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_struct("Subject")
            .field("place", &self.place)
            .field("version", &self.version)
            .finish_non_exhaustive()
    }
}

/// What a picture depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    place: Place,
    stage_version: u64,
    time_secs: f64,
    camera: Camera,
    size: (u32, u32),
}

/// Keeps the view's texture up to date.
#[derive(Debug)]
pub struct Painter {
    backend: Backend,
    shown: Option<Shot>,
}

/// Who draws.
#[derive(Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "a window has one, for as long as it is open"
)]
enum Backend {
    Cpu {
        worker: worker::Worker,
        texture: Option<Texture>,
        pending: Option<Shot>,
    },
    Gpu(Box<card::Card>),
}

impl Painter {
    /// A painter that wakes `ctx` when a picture is done. `graphics` is the window's device; without
    /// one the CPU draws, whatever is chosen.
    #[must_use]
    pub fn new(
        ctx: &egui::Context,
        graphics: Option<&RenderState>,
        choice: RendererChoice,
    ) -> Self {
        let graphics = graphics.filter(|graphics| match choice {
            RendererChoice::Fastest => card::is_worth_it(graphics),
            RendererChoice::Cpu => false,
            RendererChoice::Gpu => true,
        });
        let backend = match graphics {
            Some(graphics) => Backend::Gpu(Box::new(card::Card::new(graphics))),
            None => {
                let worker = worker::Worker::new(ctx);
                Backend::Cpu {
                    worker,
                    texture: None,
                    pending: None,
                }
            }
        };
        Self {
            backend,
            shown: None,
        }
    }

    /// Takes in what is done, and starts a picture of the session if it has changed. `size` is the
    /// view's in pixels.
    pub fn update(&mut self, ctx: &egui::Context, session: &Session, size: (u32, u32)) {
        let subject = Subject {
            place: Place::Stage,
            version: session.stage_version(),
            time_secs: session.stage_time_secs(),
            camera: session.view_camera(),
            moves: session.transport.is_playing(),
            scene: &|| session.scene(),
            poses: &|| session.poses_on_stage(),
        };
        self.update_with(ctx, &subject, size);
    }

    /// As [`update`](Self::update), for whatever is to be seen.
    pub fn update_with(&mut self, ctx: &egui::Context, subject: &Subject<'_>, size: (u32, u32)) {
        self.take_done(ctx);
        let camera = subject.camera;
        let key = Key {
            place: subject.place,
            stage_version: subject.version,
            time_secs: subject.time_secs,
            camera,
            size,
        };
        let is_shown = |key: &Key| self.shown.as_ref().is_some_and(|shot| shot.key == *key);
        if size.0 == 0 || size.1 == 0 || is_shown(&key) {
            return;
        }
        let shot = |key| Shot {
            camera,
            poses: (subject.poses)(),
            key,
        };
        match &mut self.backend {
            Backend::Gpu(card) => {
                card.draw(&(subject.scene)(), size);
                self.shown = Some(shot(key));
            }
            Backend::Cpu {
                worker, pending, ..
            } => {
                let moves = subject.moves || ctx.input(|i| i.pointer.any_down());
                let is_first = self.shown.is_none();
                let quick = Key {
                    size: smaller(size),
                    ..key
                };
                let key = if moves || is_first { quick } else { key };
                if pending.is_some() || is_shown(&key) {
                    return;
                }
                *pending = Some(shot(key));
                worker.start((subject.scene)(), key.size);
                self.take_done(ctx);
            }
        }
    }

    fn take_done(&mut self, ctx: &egui::Context) {
        let Backend::Cpu {
            worker,
            texture,
            pending,
        } = &mut self.backend
        else {
            return;
        };
        let Some(image) = worker.take() else { return };
        let picture = to_color_image(&image);
        match texture {
            Some(texture) => texture.set(picture),
            None => *texture = Some(Texture::new(ctx, picture)),
        }
        self.shown = pending.take();
    }

    /// The texture, once there is one.
    #[must_use]
    pub fn texture(&self) -> Option<TextureId> {
        match &self.backend {
            Backend::Cpu { texture, .. } => texture.as_ref().map(Texture::id),
            Backend::Gpu(card) => card.texture(),
        }
    }

    /// Draws the picture of a place into its room; until there is one the room is empty.
    pub fn draw(&self, ui: &egui::Ui, rect: Rect, place: Place) {
        let canvas = ui.painter().with_clip_rect(rect);
        let shot = self.shown.as_ref().filter(|shot| shot.key.place == place);
        let room = shot.map(|shot| room_of(shot.key.size, rect));
        if room != Some(rect) {
            canvas.rect_filled(rect, 0.0, Palette::in_ui(ui).sunken);
        }
        if let (Some(texture), Some(room)) = (self.texture(), room) {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            canvas.image(texture, room, whole, Color32::WHITE);
        }
    }

    /// Whether the picture on the screen is of that room.
    #[must_use]
    pub fn shows(&self, place: Place) -> bool {
        self.shown
            .as_ref()
            .is_some_and(|shot| shot.key.place == place)
    }

    /// Whether the picture on the screen is of the session as it is now, in whatever size.
    #[must_use]
    pub fn shows_now(&self, session: &Session) -> bool {
        self.shown.as_ref().is_some_and(|shot| {
            shot.key.place == Place::Stage
                && shot.key.stage_version == session.stage_version()
                && shot.key.time_secs == session.stage_time_secs()
                && shot.key.camera == session.view_camera()
        })
    }

    /// From where and when the picture on the screen was taken.
    #[must_use]
    pub fn shot(&self) -> Option<&Shot> {
        self.shown.as_ref()
    }

    /// Whether a picture is being drawn; the window is woken when it is done.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        matches!(
            &self.backend,
            Backend::Cpu {
                pending: Some(_),
                ..
            }
        )
    }

    /// What draws, for people.
    #[must_use]
    pub fn renderer_name(&self) -> String {
        match &self.backend {
            Backend::Cpu { .. } => "CPU".to_owned(),
            Backend::Gpu(card) => card.name().to_owned(),
        }
    }
}

/// Where a picture of some pixels stands in a room. While one of the room's new shape is being drawn, the last one keeps
/// its proportions: it is as high as the room, as the angle of view is, and its middle is in the middle.
fn room_of((width, height): (u32, u32), room: Rect) -> Rect {
    /// A picture has whole pixels, and fewer of them while things move.
    const ROUNDING: f32 = 0.01;
    let wanted = room.height() * width as f32 / height.max(1) as f32;
    if (wanted - room.width()).abs() <= ROUNDING * room.width() {
        return room;
    }
    Rect::from_center_size(room.center(), vec2(wanted, room.height()))
}

/// A size of the same shape with at most [`MOVING_PIXELS`].
fn smaller(size: (u32, u32)) -> (u32, u32) {
    let pixels = size.0 as f32 * size.1 as f32;
    if pixels <= MOVING_PIXELS {
        return size;
    }
    let factor = (MOVING_PIXELS / pixels).sqrt();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "smaller than what it is made of"
    )]
    let scaled = |length: u32| ((length as f32 * factor) as u32).max(1);
    (scaled(size.0), scaled(size.1))
}

/// How many threads draw a picture.
#[must_use]
pub fn thread_count() -> NonZeroUsize {
    #[cfg(not(target_arch = "wasm32"))]
    return std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    #[cfg(target_arch = "wasm32")]
    NonZeroUsize::MIN
}

mod card {
    //! A graphics card that draws into a texture of the window's device.

    use eframe::egui_wgpu::RenderState;
    use egui::TextureId;
    use posekit_render::gpu::GpuRenderer;

    use super::Scene;

    /// The window takes encoded values in textures that are not sRGB.
    const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

    /// Whether a window's device draws faster than the CPU does: a program that plays a graphics
    /// card does not. On a page there is nothing better.
    pub(super) fn is_worth_it(graphics: &RenderState) -> bool {
        let is_software = graphics.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        cfg!(target_arch = "wasm32") || !is_software
    }

    pub(super) struct Card {
        renderer: GpuRenderer,
        graphics: RenderState,
        registered: Option<(TextureId, (u32, u32))>,
        name: String,
    }

    impl std::fmt::Debug for Card {
        fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            out.debug_struct("Card")
                .field("name", &self.name)
                .finish_non_exhaustive()
        }
    }

    impl Card {
        pub(super) fn new(graphics: &RenderState) -> Self {
            let info = graphics.adapter.get_info();
            Self {
                renderer: GpuRenderer::new(&graphics.device, &graphics.queue, FORMAT),
                graphics: graphics.clone(),
                registered: None,
                name: format!("{} ({})", info.name, info.backend),
            }
        }

        pub(super) fn draw(&mut self, scene: &Scene, size: (u32, u32)) {
            let most = self.graphics.device.limits().max_texture_dimension_2d;
            let size = (size.0.min(most), size.1.min(most));
            let view = self.renderer.prepare(scene, size.0, size.1);
            let device = &self.graphics.device;
            let filter = wgpu::FilterMode::Linear;
            let mut renderer = self.graphics.renderer.write();
            match self.registered {
                Some((_, before)) if before == size => {}
                Some((id, _)) => {
                    renderer.update_egui_texture_from_wgpu_texture(device, view, filter, id);
                    self.registered = Some((id, size));
                }
                None => {
                    let id = renderer.register_native_texture(device, view, filter);
                    self.registered = Some((id, size));
                }
            }
        }

        pub(super) fn texture(&self) -> Option<TextureId> {
            self.registered.map(|(id, _)| id)
        }

        pub(super) fn name(&self) -> &str {
            &self.name
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod worker {
    //! A thread that draws.

    use std::sync::mpsc::{Receiver, Sender, channel};

    use super::{CpuRenderer, Image, Scene, thread_count};

    #[derive(Debug)]
    pub(super) struct Worker {
        jobs: Option<Sender<(Scene, (u32, u32))>>,
        done: Receiver<Image>,
    }

    impl Worker {
        pub(super) fn new(ctx: &egui::Context) -> Self {
            let (jobs, inbox) = channel::<(Scene, (u32, u32))>();
            let (outbox, done) = channel();
            let ctx = ctx.clone();
            let draw = move || {
                let mut renderer = CpuRenderer::new(thread_count());
                while let Ok((scene, (width, height))) = inbox.recv() {
                    if outbox.send(renderer.render(&scene, width, height)).is_err() {
                        break;
                    }
                    ctx.request_repaint();
                }
            };
            // Without a thread there is no picture, but the window still works.
            let thread = std::thread::Builder::new().name("draw".into()).spawn(draw);
            Self {
                jobs: thread.is_ok().then_some(jobs),
                done,
            }
        }

        pub(super) fn start(&mut self, scene: Scene, size: (u32, u32)) {
            if let Some(jobs) = &self.jobs
                && jobs.send((scene, size)).is_err()
            {
                self.jobs = None;
            }
        }

        pub(super) fn take(&mut self) -> Option<Image> {
            self.done.try_recv().ok()
        }
    }
}

#[cfg(target_arch = "wasm32")]
mod worker {
    //! A page has no thread to spare: the picture is drawn at once.

    use super::{CpuRenderer, Image, Scene, thread_count};

    #[derive(Debug)]
    pub(super) struct Worker {
        renderer: CpuRenderer,
        done: Option<Image>,
    }

    impl Worker {
        pub(super) fn new(_ctx: &egui::Context) -> Self {
            Self {
                renderer: CpuRenderer::new(thread_count()),
                done: None,
            }
        }

        pub(super) fn start(&mut self, scene: Scene, (width, height): (u32, u32)) {
            self.done = Some(self.renderer.render(&scene, width, height));
        }

        pub(super) fn take(&mut self) -> Option<Image> {
            self.done.take()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_another_shape_keeps_its_proportions() {
        let room = Rect::from_min_size(pos2(100.0, 50.0), vec2(300.0, 600.0));
        // Of this room, in whatever size.
        for size in [(300, 600), (600, 1200), (211, 423)] {
            assert_eq!(room_of(size, room), room);
        }
        // From before the room became narrow, or wide.
        for (size, width) in [((1200, 600), 1200.0), ((100, 600), 100.0)] {
            let place = room_of(size, room);
            assert_eq!(place.size(), vec2(width, 600.0));
            assert_eq!(place.center(), room.center());
        }
    }
}
