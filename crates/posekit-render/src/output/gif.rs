//! GIF films: 255 colours chosen once for the whole film, and only what changes from frame to frame.

use std::io::Write;

use color_quant::NeuQuant;

use crate::image::Image;
use crate::render::Renderer;

use super::film::{Film, FilmError, Progress, SceneAt, draw_frames};

/// Frames that the palette is chosen from.
const PALETTE_FRAMES: usize = 6;
/// At most this many of their pixels are looked at.
const PALETTE_PIXELS: usize = 400_000;
/// The palette entry that leaves a pixel as it was.
const KEEP: u8 = 255;
const COLORS: usize = 255;

/// Draws a film and writes it as an endless GIF. The frame rate is rounded to what GIF can say:
/// hundredths of a second between frames, at least two.
///
/// # Errors
/// See [`FilmError`]. When it fails, what `output` got is not a film.
pub fn write_gif(
    film: &Film,
    scene_at: &SceneAt<'_>,
    renderer: &mut Renderer,
    output: impl Write,
    progress: &mut Progress<'_>,
) -> Result<(), FilmError> {
    validate(film)?;
    let mut samples = PaletteSamples::of(film);
    let mut image = Image::default();
    for time in samples.times_secs(film) {
        renderer.render_into(&scene_at(time), film.width, film.height, &mut image)?;
        samples.look_at(&image);
    }
    let palette = samples.palette();
    let mut gif = GifFilm::start(film, &palette, output)?;
    let convert = |image: &Image| palette.indices(image);
    let take = |_index: usize, indices: Vec<u8>| gif.add(indices);
    draw_frames(film, scene_at, renderer, convert, take, progress)
}

/// Whether a film can be a GIF.
pub(super) fn validate(film: &Film) -> Result<(), FilmError> {
    film.validate()?;
    if film.frames_per_sec > 50.0 {
        return Err(FilmError::FrameRate {
            frames_per_sec: film.frames_per_sec,
        });
    }
    Ok(())
}

/// A GIF that is being written.
pub(super) struct GifFilm<W: Write> {
    encoder: gif::Encoder<W>,
    size: (u16, u16),
    frames_per_sec: f64,
    last: Vec<u8>,
    added: usize,
}

impl<W: Write> GifFilm<W> {
    pub(super) fn start(film: &Film, palette: &Palette, output: W) -> Result<Self, FilmError> {
        let (Ok(width), Ok(height)) = (u16::try_from(film.width), u16::try_from(film.height))
        else {
            let expected = "GIF sides go up to 65535 pixels";
            return Err(FilmError::Size {
                width: film.width,
                height: film.height,
                expected,
            });
        };
        let mut encoder =
            gif::Encoder::new(output, width, height, &palette.bytes()).map_err(gif_error)?;
        encoder
            .set_repeat(gif::Repeat::Infinite)
            .map_err(gif_error)?;
        Ok(Self {
            encoder,
            size: (width, height),
            frames_per_sec: film.frames_per_sec,
            last: Vec::new(),
            added: 0,
        })
    }

    /// Adds a frame: the palette's entry of every pixel.
    pub(super) fn add(&mut self, indices: Vec<u8>) -> Result<(), FilmError> {
        let mut frame = changed(&indices, &self.last, self.size);
        frame.delay = delay(self.added, self.frames_per_sec);
        self.encoder.write_frame(&frame).map_err(gif_error)?;
        self.last = indices;
        self.added += 1;
        Ok(())
    }
}

/// Hundredths of a second that a frame stays, so that the frames' times do not drift.
fn delay(index: usize, frames_per_sec: f64) -> u16 {
    let at = |i: usize| (i as f64 * 100.0 / frames_per_sec).round();
    #[expect(clippy::cast_possible_truncation, reason = "clamped")]
    let delay = (at(index + 1) - at(index)).clamp(2.0, 65535.0) as u16;
    delay
}

/// The part of a frame that differs from the last one; what is the same in it is left transparent.
fn changed(indices: &[u8], last: &[u8], (width, height): (u16, u16)) -> gif::Frame<'static> {
    let columns = usize::from(width);
    let full = (0, 0, columns, usize::from(height));
    let (left, top, right, bottom) = if last.len() == indices.len() {
        changed_box(indices, last, columns).unwrap_or((0, 0, 1, 1))
    } else {
        full
    };
    let mut buffer = Vec::with_capacity((right - left) * (bottom - top));
    for row in top..bottom {
        let span = row * columns + left..row * columns + right;
        for (at, &index) in span.clone().zip(&indices[span]) {
            let same = last.get(at) == Some(&index);
            buffer.push(if same { KEEP } else { index });
        }
    }
    let narrow = |v: usize| u16::try_from(v).unwrap_or(u16::MAX);
    gif::Frame {
        left: narrow(left),
        top: narrow(top),
        width: narrow(right - left),
        height: narrow(bottom - top),
        transparent: Some(KEEP),
        dispose: gif::DisposalMethod::Keep,
        buffer: buffer.into(),
        ..gif::Frame::default()
    }
}

/// Left, top, right, bottom of what differs, the last two exclusive.
fn changed_box(a: &[u8], b: &[u8], columns: usize) -> Option<(usize, usize, usize, usize)> {
    let mut found: Option<(usize, usize, usize, usize)> = None;
    for (row, (a, b)) in a
        .chunks_exact(columns)
        .zip(b.chunks_exact(columns))
        .enumerate()
    {
        let Some(first) = a.iter().zip(b).position(|(p, q)| p != q) else {
            continue;
        };
        let end = a
            .iter()
            .zip(b)
            .rposition(|(p, q)| p != q)
            .map_or(first, |i| i)
            + 1;
        found = Some(match found {
            None => (first, row, end, row + 1),
            Some((l, t, r, _)) => (l.min(first), t, r.max(end), row + 1),
        });
    }
    found
}

/// Pixels of some of the film's frames, to choose its colours from.
pub(super) struct PaletteSamples {
    rgba: Vec<u8>,
    frames: usize,
}

impl PaletteSamples {
    pub(super) fn of(film: &Film) -> Self {
        Self {
            rgba: Vec::new(),
            frames: film.times_secs.len().min(PALETTE_FRAMES),
        }
    }

    /// The times of the frames to look at, spread over the film.
    pub(super) fn times_secs(&self, film: &Film) -> Vec<f64> {
        let (count, frames) = (film.times_secs.len(), self.frames);
        let index = |k: usize| (2 * k + 1) * count / (2 * frames);
        (0..frames).map(|k| film.times_secs[index(k)]).collect()
    }

    pub(super) fn look_at(&mut self, image: &Image) {
        let pixels = image.as_rgba().len() / 4 * self.frames;
        let step = pixels.div_ceil(PALETTE_PIXELS) | 1;
        for pixel in image.as_rgba().chunks_exact(4).step_by(step) {
            self.rgba.extend_from_slice(&pixel[..3]);
            self.rgba.push(u8::MAX);
        }
    }

    pub(super) fn palette(&self) -> Palette {
        Palette {
            quantiser: NeuQuant::new(4, COLORS, &self.rgba),
        }
    }
}

/// The film's colours.
pub(super) struct Palette {
    quantiser: NeuQuant,
}

impl Palette {
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.quantiser.color_map_rgb();
        bytes.resize(COLORS * 3, 0);
        bytes.extend([0; 3]);
        bytes
    }

    /// The nearest palette entry of every pixel. Neighbours often share a colour, and a film its
    /// colours with itself, so found entries are remembered.
    pub(super) fn indices(&self, image: &Image) -> Vec<u8> {
        const SLOTS: usize = 1 << 14;
        let mut memory: Vec<Option<([u8; 3], u8)>> = vec![None; SLOTS];
        image
            .as_rgba()
            .chunks_exact(4)
            .map(|pixel| {
                let rgb = [pixel[0], pixel[1], pixel[2]];
                let key = u32::from_be_bytes([0, rgb[0], rgb[1], rgb[2]]);
                let slot = (key.wrapping_mul(0x9E37_79B1) >> 18) as usize;
                match memory[slot] {
                    Some((known, index)) if known == rgb => index,
                    _ => {
                        let nearest = self.quantiser.index_of(&[rgb[0], rgb[1], rgb[2], 255]);
                        let index = u8::try_from(nearest).unwrap_or(0).min(KEEP - 1);
                        memory[slot] = Some((rgb, index));
                        index
                    }
                }
            })
            .collect()
    }
}

fn gif_error(error: gif::EncodingError) -> FilmError {
    match error {
        gif::EncodingError::Io(error) => FilmError::Output(error),
        other => FilmError::Encoder(other.to_string()),
    }
}
