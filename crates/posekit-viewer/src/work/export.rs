//! Exporting a video: options, and the work on a thread with progress.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use posekit::keyframe::KeyedCamera;
use posekit_render::output::{Film, even_size};
use posekit_render::scene::Scene;
use posekit_render::stage::{Stage, keyed_camera};

use crate::state::animate::Authored;
use crate::state::camera::ViewCamera;
use crate::state::session::Session;

/// What kind of video.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VideoFormat {
    /// H.264 in MP4.
    #[cfg(feature = "h264")]
    Mp4,
    /// An endless GIF.
    Gif,
    /// An animated PNG.
    Apng,
}

impl VideoFormat {
    /// The formats that this program can write.
    pub const AVAILABLE: &'static [Self] = &[
        #[cfg(feature = "h264")]
        Self::Mp4,
        Self::Gif,
        Self::Apng,
    ];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            #[cfg(feature = "h264")]
            Self::Mp4 => "MP4",
            Self::Gif => "GIF",
            Self::Apng => "Animated PNG",
        }
    }

    /// The extension, without the dot.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            #[cfg(feature = "h264")]
            Self::Mp4 => "mp4",
            Self::Gif => "gif",
            Self::Apng => "png",
        }
    }
}

/// How large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportSize {
    /// 1280 x 720.
    Hd,
    /// 1920 x 1080.
    FullHd,
    /// 1080 x 1080.
    Square,
    /// 640 x 360.
    Small,
}

impl ExportSize {
    /// All sizes, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Small, Self::Hd, Self::FullHd, Self::Square];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Small => "360p",
            Self::Hd => "720p",
            Self::FullHd => "1080p",
            Self::Square => "Square",
        }
    }

    /// Width and height in pixels.
    #[must_use]
    pub const fn pixels(self) -> (u32, u32) {
        match self {
            Self::Small => (640, 360),
            Self::Hd => (1280, 720),
            Self::FullHd => (1920, 1080),
            Self::Square => (1080, 1080),
        }
    }
}

/// From where a video is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportCamera {
    /// From where the view looks.
    View,
    /// By a camera of the active clip's scene.
    Scene(usize),
}

/// What video is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExportOptions {
    /// What kind.
    pub format: VideoFormat,
    /// How large.
    pub size: ExportSize,
    /// Frames a second.
    pub fps: u32,
    /// From where.
    pub camera: ExportCamera,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self {
            format: VideoFormat::AVAILABLE[0],
            // A page draws a video on one thread.
            size: if cfg!(target_arch = "wasm32") {
                ExportSize::Small
            } else {
                ExportSize::Hd
            },
            fps: 30,
            camera: ExportCamera::View,
        }
    }
}

/// Everything that the video needs of the session, so that it can go on meanwhile.
#[derive(Clone, Debug)]
pub struct Take {
    stage: Stage,
    camera: TakeCamera,
    film: Film,
}

/// What a take is taken with.
#[derive(Clone, Debug)]
enum TakeCamera {
    View(ViewCamera),
    Scene(Box<KeyedCamera>),
}

impl Take {
    /// The range of the session, seen by its camera, at the transport's speed.
    #[must_use]
    pub fn of(session: &Session, options: &ExportOptions) -> Self {
        let (width, height) = options.size.pixels();
        let size = even_size(width, height);
        let fps = f64::from(options.fps);
        let (first, last) = session.transport.range();
        let start = session.transport.secs_of(first);
        let end = session.transport.secs_of(last);
        let speed = session.transport.speed();
        let mut film = Film::of_range(size, fps, 0.0, (end - start) / speed);
        for time in &mut film.times_secs {
            *time = start + *time * speed;
        }
        let scene = session.authored().map(Authored::scene);
        let of_scene = match options.camera {
            ExportCamera::View => None,
            ExportCamera::Scene(index) => scene.and_then(|scene| scene.cameras.get(index)),
        };
        match of_scene {
            // A shot is drawn as its file is: nothing is left of how it was worked on.
            Some(camera) => Self {
                stage: session.shot_stage(),
                camera: TakeCamera::Scene(Box::new(camera.view.clone())),
                film,
            },
            None => {
                let stage = session.film_stage();
                let camera = TakeCamera::View(session.film_camera(&stage));
                Self {
                    stage,
                    camera,
                    film,
                }
            }
        }
    }

    /// How many frames it has.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.film.times_secs.len()
    }

    /// The film.
    #[must_use]
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// The scene at a time.
    #[must_use]
    pub fn scene(&self, time_secs: f64) -> Scene {
        let stage = &self.stage;
        let camera = match &self.camera {
            TakeCamera::View(view) => view.orbit(stage, time_secs).camera(),
            TakeCamera::Scene(camera) => {
                let at = stage.surroundings().start_secs + time_secs;
                keyed_camera(camera, at, stage.stature())
            }
        };
        stage.scene_from(time_secs, camera)
    }
}

/// A video that is being made.
#[derive(Clone, Debug)]
pub struct Running {
    shared: Arc<Shared>,
    total: usize,
    started: Clock,
}

#[derive(Debug, Default)]
struct Shared {
    done: AtomicUsize,
    cancelled: AtomicBool,
    finished: AtomicBool,
}

#[cfg(not(target_arch = "wasm32"))]
type Clock = std::time::Instant;
#[cfg(target_arch = "wasm32")]
type Clock = web_time::Instant;

impl Running {
    /// How many frames are done, of how many.
    #[must_use]
    pub fn frames(&self) -> (usize, usize) {
        (self.shared.done.load(Ordering::Relaxed), self.total)
    }

    /// How much is done, 0 to 1.
    #[must_use]
    pub fn fraction(&self) -> f32 {
        let (done, total) = self.frames();
        done as f32 / total.max(1) as f32
    }

    /// How long it will take still, once that can be said.
    #[must_use]
    pub fn secs_left(&self) -> Option<f64> {
        let (done, total) = self.frames();
        let passed = self.started.elapsed().as_secs_f64();
        let a_frame = passed / f64::from(u32::try_from(done).ok().filter(|&done| done > 4)?);
        let left = f64::from(u32::try_from(total.saturating_sub(done)).ok()?);
        Some(a_frame * left)
    }

    /// Stops it.
    pub fn cancel(&self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether it is over, one way or another.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.shared.finished.load(Ordering::Relaxed)
    }
}

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::start;
#[cfg(target_arch = "wasm32")]
pub use page::start;

#[cfg(not(target_arch = "wasm32"))]
mod desktop {
    //! The work, on a thread.

    use std::ops::ControlFlow;
    use std::path::{Path, PathBuf};

    use posekit_formats::system::in_words;
    use posekit_render::output::{FilmError, write_apng, write_gif};
    use posekit_render::render::{Renderer, RendererChoice};

    use super::{Arc, Clock, Ordering, Running, Shared, Take, VideoFormat};
    use crate::load::{Event, Outbox};
    use crate::work::files::write_beside;

    /// Starts making a video.
    #[must_use]
    pub fn start(take: Take, format: VideoFormat, path: PathBuf, outbox: &Outbox) -> Running {
        let shared = Arc::new(Shared::default());
        let total = take.frame_count();
        let running = Running {
            shared: Arc::clone(&shared),
            total,
            started: Clock::now(),
        };
        let outbox = outbox.clone();
        let work = move || {
            let outcome = make(&take, format, &path, &shared, &outbox);
            shared.finished.store(true, Ordering::Relaxed);
            match outcome {
                Ok(()) => {
                    outbox.send(Event::Written {
                        message: format!("Saved {}", path.display()),
                    });
                }
                Err(FilmError::Cancelled) => outbox.wake(),
                Err(error) => {
                    let message = format!("{}: not saved: {}", path.display(), why_not(&error));
                    outbox.send(Event::Failed { message });
                }
            }
        };
        let thread = std::thread::Builder::new()
            .name("export".into())
            .spawn(work);
        if thread.is_err() {
            running.shared.finished.store(true, Ordering::Relaxed);
        }
        running
    }

    fn why_not(error: &FilmError) -> String {
        match error {
            FilmError::Output(refused) => in_words(refused),
            other => other.to_string(),
        }
    }

    fn make(
        take: &Take,
        format: VideoFormat,
        path: &Path,
        shared: &Shared,
        outbox: &Outbox,
    ) -> Result<(), FilmError> {
        let mut renderer = Renderer::new(RendererChoice::default())?;
        let mut progress = |done: usize| {
            shared.done.store(done, Ordering::Relaxed);
            outbox.wake();
            if shared.cancelled.load(Ordering::Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let film = take.film();
        let scene_at = |time: f64| take.scene(time);
        write_beside(path, |output| match format {
            #[cfg(feature = "h264")]
            VideoFormat::Mp4 => posekit_render::output::write_mp4(
                film,
                &scene_at,
                &mut renderer,
                output,
                &mut progress,
            ),
            VideoFormat::Gif => write_gif(film, &scene_at, &mut renderer, output, &mut progress),
            VideoFormat::Apng => write_apng(film, &scene_at, &mut renderer, output, &mut progress),
        })
    }
}

#[cfg(target_arch = "wasm32")]
mod page {
    //! The work, a picture at a time between the page's own.

    use std::cell::RefCell;
    use std::io::Write;
    use std::path::PathBuf;
    use std::rc::Rc;

    use posekit_render::output::{FilmError, StepwiseFilm, StepwiseFormat};
    use wasm_bindgen_futures::spawn_local;

    use super::{Arc, Clock, Ordering, Running, Shared, Take, VideoFormat};
    use crate::load::{Event, Outbox};
    use crate::web;
    use crate::work::files::Parcel;

    /// Between two pictures the page has this long for itself.
    const PAUSE_MS: i32 = 4;

    /// Starts making a video, which goes to the browser's downloads under the name `path`.
    #[must_use]
    pub fn start(take: Take, format: VideoFormat, path: PathBuf, outbox: &Outbox) -> Running {
        let name = path.to_string_lossy().into_owned();
        let shared = Arc::new(Shared::default());
        let running = Running {
            shared: Arc::clone(&shared),
            total: take.frame_count(),
            started: Clock::now(),
        };
        let outbox = outbox.clone();
        spawn_local(async move {
            let outcome = make(&take, format, &shared, &outbox).await;
            shared.finished.store(true, Ordering::Relaxed);
            match outcome {
                Ok(bytes) => {
                    let parcel = Parcel {
                        name,
                        kind: "Video",
                        extension: format.extension(),
                        bytes: bytes.into(),
                    };
                    web::hand_over(&outbox, &parcel);
                }
                Err(FilmError::Cancelled) => outbox.wake(),
                Err(error) => {
                    let message = format!("{name}: {error}");
                    outbox.send(Event::Failed { message });
                }
            }
        });
        running
    }

    async fn make(
        take: &Take,
        format: VideoFormat,
        shared: &Shared,
        outbox: &Outbox,
    ) -> Result<Vec<u8>, FilmError> {
        let format = match format {
            #[cfg(feature = "h264")]
            VideoFormat::Mp4 => return Err(FilmError::Encoder("a page has no H.264".to_owned())),
            VideoFormat::Gif => StepwiseFormat::Gif,
            VideoFormat::Apng => StepwiseFormat::Apng,
        };
        let bytes = Collected::default();
        let mut film = StepwiseFilm::start(take.film().clone(), format, bytes.clone())?;
        let total = film.frame_count();
        loop {
            let done = film.step(|time| take.scene(time))?;
            shared.done.store(done, Ordering::Relaxed);
            outbox.wake();
            if done == total {
                film.finish()?;
                return Ok(bytes.0.take());
            }
            web::pause(PAUSE_MS).await;
            if shared.cancelled.load(Ordering::Relaxed) {
                return Err(FilmError::Cancelled);
            }
        }
    }

    /// Bytes that an encoder writes and that are there when it is gone.
    #[derive(Clone, Default)]
    struct Collected(Rc<RefCell<Vec<u8>>>);

    impl Write for Collected {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.borrow_mut().extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
}
