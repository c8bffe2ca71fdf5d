//! Films as a sequence of PNG pictures, for programs that cut and grade.

use std::io::{self, Write};

use crate::image::Image;
use crate::render::Renderer;

use super::film::{Film, FilmError, Progress, SceneAt, draw_frames};
use super::png::write_png;

/// Draws a film and writes every frame as a PNG picture of its own.
///
/// `output` is asked for the place of each frame, from 0, when the frame is whole; frames come in
/// order. The film's frame rate is not written anywhere. Pictures are packed on the threads that draw
/// them.
///
/// # Errors
/// See [`FilmError`]; what `output` reports. Frames written before an error stay.
pub fn write_png_sequence(
    film: &Film,
    scene_at: &SceneAt<'_>,
    renderer: &mut Renderer,
    output: &mut dyn FnMut(usize) -> io::Result<Box<dyn Write>>,
    progress: &mut Progress<'_>,
) -> Result<(), FilmError> {
    film.validate()?;
    let pack = |image: &Image| {
        let mut bytes = Vec::new();
        write_png(image, &mut bytes).map(|()| bytes)
    };
    let take = |index: usize, packed: io::Result<Vec<u8>>| {
        let bytes = packed.map_err(|error| FilmError::Encoder(error.to_string()))?;
        let mut place = output(index)?;
        place.write_all(&bytes)?;
        place.flush()?;
        Ok(())
    };
    draw_frames(film, scene_at, renderer, pack, take, progress)
}
