//! Films made a picture at a time, for where there is one thread that must not be kept for long: a
//! web page.

use std::io::Write;

use crate::cpu::CpuRenderer;
use crate::image::Image;
use crate::scene::Scene;

use super::film::{Film, FilmError};
use super::gif::{GifFilm, Palette, PaletteSamples};
use super::{apng, gif};

/// What kind of film is made a picture at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepwiseFormat {
    /// An endless GIF, as [`write_gif`](super::write_gif) makes it.
    Gif,
    /// An endless animated PNG, as [`write_apng`](super::write_apng) makes it.
    Apng,
}

/// A film that is made a picture at a time: [`step`](Self::step) until it says that all is done,
/// then [`finish`](Self::finish). The bytes are those that the whole-film functions write.
pub struct StepwiseFilm<W: Write> {
    film: Film,
    renderer: CpuRenderer,
    image: Image,
    added: usize,
    state: State<W>,
}

/// How far it is.
enum State<W: Write> {
    /// The colours of a GIF are looked for; the next of these times is looked at.
    Sampling {
        samples: PaletteSamples,
        times_secs: Vec<f64>,
        looked_at: usize,
        output: W,
    },
    Gif(GifFilm<W>, Palette),
    Apng(png::Writer<W>),
    /// An error ended it.
    Failed,
}

impl<W: Write> StepwiseFilm<W> {
    /// Begins a film.
    ///
    /// # Errors
    /// See [`FilmError`].
    pub fn start(film: Film, format: StepwiseFormat, output: W) -> Result<Self, FilmError> {
        let state = match format {
            StepwiseFormat::Gif => {
                gif::validate(&film)?;
                let samples = PaletteSamples::of(&film);
                State::Sampling {
                    times_secs: samples.times_secs(&film),
                    samples,
                    looked_at: 0,
                    output,
                }
            }
            StepwiseFormat::Apng => State::Apng(apng::start(&film, output)?),
        };
        Ok(Self {
            film,
            renderer: CpuRenderer::new(std::num::NonZeroUsize::MIN),
            image: Image::default(),
            added: 0,
            state,
        })
    }

    /// How many frames it will have.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.film.times_secs.len()
    }

    /// Draws one picture and adds it, or looks at its colours. Gives the number of frames that the
    /// film has by now; it is whole when that is [`frame_count`](Self::frame_count), and further
    /// steps do nothing.
    ///
    /// # Errors
    /// See [`FilmError`]. After one there is no film.
    pub fn step(&mut self, scene_at: impl Fn(f64) -> Scene) -> Result<usize, FilmError> {
        let time = match &self.state {
            State::Sampling {
                times_secs,
                looked_at,
                ..
            } => times_secs.get(*looked_at).copied(),
            _ => self.film.times_secs.get(self.added).copied(),
        };
        let Some(time) = time else {
            return Ok(self.added);
        };
        let (width, height) = (self.film.width, self.film.height);
        self.renderer
            .render_into(&scene_at(time), width, height, &mut self.image);
        self.state = match std::mem::replace(&mut self.state, State::Failed) {
            State::Sampling {
                mut samples,
                times_secs,
                looked_at,
                output,
            } => {
                samples.look_at(&self.image);
                if looked_at + 1 < times_secs.len() {
                    State::Sampling {
                        samples,
                        times_secs,
                        looked_at: looked_at + 1,
                        output,
                    }
                } else {
                    let palette = samples.palette();
                    let gif = GifFilm::start(&self.film, &palette, output)?;
                    State::Gif(gif, palette)
                }
            }
            State::Gif(mut gif, palette) => {
                gif.add(palette.indices(&self.image))?;
                self.added += 1;
                State::Gif(gif, palette)
            }
            State::Apng(mut writer) => {
                writer
                    .write_image_data(self.image.as_rgba())
                    .map_err(apng::png_error)?;
                self.added += 1;
                State::Apng(writer)
            }
            State::Failed => State::Failed,
        };
        Ok(self.added)
    }

    /// Writes what stands at a film's end.
    ///
    /// # Errors
    /// If the output cannot be written, or frames are missing.
    pub fn finish(self) -> Result<(), FilmError> {
        if self.added < self.frame_count() {
            return Err(FilmError::Cancelled);
        }
        match self.state {
            State::Apng(writer) => writer.finish().map_err(apng::png_error),
            // A GIF's end is written when it is let go.
            State::Sampling { .. } | State::Gif(..) | State::Failed => Ok(()),
        }
    }
}

impl<W: Write> std::fmt::Debug for StepwiseFilm<W> {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_struct("StepwiseFilm")
            .field("added", &self.added)
            .field("frames", &self.frame_count())
            .finish_non_exhaustive()
    }
}
