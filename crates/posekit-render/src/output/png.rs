//! PNG pictures.

use std::io::{self, Write};

use crate::image::Image;

/// Writes a picture as PNG. A picture with no transparent pixel is written without alpha.
///
/// # Errors
/// What `output` reports, as it is; a picture with no pixels.
pub fn write_png(image: &Image, output: impl Write) -> io::Result<()> {
    write(image, output).map_err(|error| match error {
        // The crate's own conversion keeps the text alone: nobody could tell a full disk from a lost one.
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    })
}

fn write(image: &Image, output: impl Write) -> Result<(), png::EncodingError> {
    let opaque = image
        .as_rgba()
        .chunks_exact(4)
        .all(|pixel| pixel[3] == u8::MAX);
    let mut encoder = png::Encoder::new(output, image.width(), image.height());
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Balanced);
    if opaque {
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header()?;
        let rgb: Vec<u8> = image
            .as_rgba()
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect();
        writer.write_image_data(&rgb)?;
        writer.finish()
    } else {
        encoder.set_color(png::ColorType::Rgba);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(image.as_rgba())?;
        writer.finish()
    }
}
