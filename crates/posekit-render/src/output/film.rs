//! Drawing the frames of a film, many at a time and in order.

use std::ops::ControlFlow;

use crate::image::Image;
use crate::render::Renderer;
use crate::scene::Scene;

/// What a film is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Frames a second of the film.
    pub frames_per_sec: f64,
    /// The time of the motion, seconds, that each frame shows.
    pub times_secs: Vec<f64>,
}

/// Why there is no film.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The progress callback asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// There is nothing to show.
    #[error("a film needs at least one frame")]
    NoFrames,
    /// The format cannot have this size.
    #[error("{width}x{height} is not a size that this format can have: {expected}")]
    Size {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
        /// What would do.
        expected: &'static str,
    },
    /// The frame rate is not positive and finite, or the format cannot have it.
    #[error("{frames_per_sec} frames a second is not a frame rate that this format can have")]
    FrameRate {
        /// Frames a second asked for.
        frames_per_sec: f64,
    },
    /// The output could not be written.
    #[error(transparent)]
    Output(#[from] std::io::Error),
    /// The encoder failed.
    #[error("the encoder failed: {0}")]
    Encoder(String),
    /// The renderer failed.
    #[error(transparent)]
    Render(#[from] crate::render::RenderError),
}

/// Told after every frame how many are done; [`ControlFlow::Break`] stops the work.
pub type Progress<'a> = dyn FnMut(usize) -> ControlFlow<()> + 'a;

/// The scene at a time, seconds.
pub type SceneAt<'a> = dyn Fn(f64) -> Scene + Sync + 'a;

impl Film {
    /// A film of a stretch of time at an even pace, ends included.
    #[must_use]
    pub fn of_range(
        (width, height): (u32, u32),
        frames_per_sec: f64,
        start_secs: f64,
        end_secs: f64,
    ) -> Self {
        let span = (end_secs - start_secs).max(0.0) * frames_per_sec;
        // The last frame may miss its time by a hair of rounding.
        #[expect(clippy::cast_possible_truncation, reason = "bounded below")]
        let count = (span + 1e-6).floor().clamp(0.0, 1e7) as usize + 1;
        let times = (0..count).map(|i| start_secs + i as f64 / frames_per_sec);
        Self {
            width,
            height,
            frames_per_sec,
            times_secs: times.collect(),
        }
    }

    pub(super) fn validate(&self) -> Result<(), FilmError> {
        let Self {
            width,
            height,
            frames_per_sec,
            ..
        } = *self;
        if self.times_secs.is_empty() {
            return Err(FilmError::NoFrames);
        }
        if width == 0 || height == 0 || width > 16384 || height > 16384 {
            let expected = "both sides must be from 1 to 16384 pixels";
            return Err(FilmError::Size {
                width,
                height,
                expected,
            });
        }
        if !(frames_per_sec > 0.0 && frames_per_sec <= 1000.0) {
            return Err(FilmError::FrameRate { frames_per_sec });
        }
        Ok(())
    }
}

/// The next even size that is not smaller: H.264 films have even sides.
#[must_use]
pub const fn even_size(width: u32, height: u32) -> (u32, u32) {
    (width.next_multiple_of(2), height.next_multiple_of(2))
}

/// Draws all frames, passes each through `convert` where it was drawn and then, in order, to
/// `take` on this thread.
///
/// On the CPU every thread draws whole frames of its own, which scales better than sharing one.
pub(super) fn draw_frames<T: Send>(
    film: &Film,
    scene_at: &SceneAt<'_>,
    renderer: &mut Renderer,
    convert: impl Fn(&Image) -> T + Sync,
    mut take: impl FnMut(usize, T) -> Result<(), FilmError>,
    progress: &mut Progress<'_>,
) -> Result<(), FilmError> {
    let mut finish = |index: usize, frame: T| {
        take(index, frame)?;
        match progress(index + 1) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(FilmError::Cancelled),
        }
    };
    let threads = renderer.frame_threads().min(film.times_secs.len());
    if threads <= 1 {
        let mut image = Image::default();
        for (index, &time) in film.times_secs.iter().enumerate() {
            renderer.render_into(&scene_at(time), film.width, film.height, &mut image)?;
            finish(index, convert(&image))?;
        }
        return Ok(());
    }
    std::thread::scope(|scope| {
        let convert = &convert;
        // Frame i comes from thread i modulo their number, each with a short queue: bounded memory
        // and no reordering.
        let queues: Vec<_> = (0..threads)
            .map(|first| {
                let (sender, receiver) = std::sync::mpsc::sync_channel(2);
                scope.spawn(move || {
                    let mut renderer = Renderer::single_threaded_cpu();
                    let mut image = Image::default();
                    for &time in film.times_secs.iter().skip(first).step_by(threads) {
                        let scene = scene_at(time);
                        let drawn =
                            renderer.render_into(&scene, film.width, film.height, &mut image);
                        let frame = drawn.map(|()| convert(&image));
                        // The other side is gone when the film was cancelled.
                        if sender.send(frame).is_err() {
                            return;
                        }
                    }
                });
                receiver
            })
            .collect();
        for index in 0..film.times_secs.len() {
            let Ok(frame) = queues[index % threads].recv() else {
                break;
            };
            finish(index, frame?)?;
        }
        Ok(())
    })
}
