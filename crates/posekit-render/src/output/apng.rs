//! Animated PNG: films without loss, with alpha, that browsers play.

use std::io::Write;

use crate::image::Image;
use crate::render::Renderer;

use super::film::{Film, FilmError, Progress, SceneAt, draw_frames};

/// Draws a film and writes it as an endless animated PNG.
///
/// # Errors
/// See [`FilmError`]. When it fails, what `output` got is not a film.
pub fn write_apng(
    film: &Film,
    scene_at: &SceneAt<'_>,
    renderer: &mut Renderer,
    output: impl Write,
    progress: &mut Progress<'_>,
) -> Result<(), FilmError> {
    let mut writer = start(film, output)?;
    let take =
        |_index: usize, image: Image| writer.write_image_data(image.as_rgba()).map_err(png_error);
    draw_frames(film, scene_at, renderer, Image::clone, take, progress)?;
    writer.finish().map_err(png_error)
}

/// Begins an animated PNG.
pub(super) fn start<W: Write>(film: &Film, output: W) -> Result<png::Writer<W>, FilmError> {
    film.validate()?;
    let frames = u32::try_from(film.times_secs.len()).map_err(|_too_many| FilmError::NoFrames)?;
    let mut encoder = png::Encoder::new(output, film.width, film.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_animated(frames, 0).map_err(png_error)?;
    // The frame rate as a fraction of two 16-bit numbers.
    #[expect(clippy::cast_possible_truncation, reason = "clamped")]
    let per_sec = (film.frames_per_sec * 30.0).round().clamp(1.0, 65535.0) as u16;
    encoder.set_frame_delay(30, per_sec).map_err(png_error)?;
    encoder.write_header().map_err(png_error)
}

pub(super) fn png_error(error: png::EncodingError) -> FilmError {
    match error {
        png::EncodingError::IoError(error) => FilmError::Output(error),
        other => FilmError::Encoder(other.to_string()),
    }
}
