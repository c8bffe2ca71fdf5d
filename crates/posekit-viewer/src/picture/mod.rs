//! Pictures: what the renderer draws, on its way into the window.

pub mod painter;
pub mod thumbnail;

use egui::{ColorImage, TextureHandle, TextureId, TextureOptions};
use posekit_render::image::Image;

/// A picture as egui takes it.
#[must_use]
pub fn to_color_image(image: &Image) -> ColorImage {
    let size = [image.width() as usize, image.height() as usize];
    ColorImage::from_rgba_unmultiplied(size, image.as_rgba())
}

/// A picture on the window's device.
#[derive(Clone)]
pub struct Texture(TextureHandle);

impl Texture {
    /// Brings a picture onto the device.
    #[must_use]
    pub fn new(ctx: &egui::Context, picture: ColorImage) -> Self {
        Self(ctx.load_texture("picture", picture, TextureOptions::LINEAR))
    }

    /// Shows another picture.
    pub fn set(&mut self, picture: ColorImage) {
        self.0.set(picture, TextureOptions::LINEAR);
    }

    /// What egui calls it.
    #[must_use]
    pub fn id(&self) -> TextureId {
        self.0.id()
    }
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_tuple("Texture").field(&self.id()).finish()
    }
}
