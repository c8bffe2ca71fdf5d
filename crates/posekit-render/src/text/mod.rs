//! Text over the picture: laid out and rasterised once, for both back ends.
//!
//! The result is a list of small bitmaps with premultiplied sRGB bytes, each with its place in the
//! picture. Glyphs come from the Ubuntu Light font (Ubuntu font licence 1.0), what it lacks from
//! Hack (MIT), both out of the `epaint_default_fonts` crate.

mod placing;

use std::sync::LazyLock;

use ab_glyph::{Font as _, FontRef, GlyphId, PxScale, ScaleFont as _, point};

use crate::color::Color;
use crate::image::Image;
use crate::scene::{Background, Caption, Corner, REFERENCE_HEIGHT_PX, Scene};

use placing::Unplaced;

static FONTS: LazyLock<Vec<FontRef<'static>>> = LazyLock::new(|| {
    [
        epaint_default_fonts::UBUNTU_LIGHT,
        epaint_default_fonts::HACK_REGULAR,
    ]
    .into_iter()
    .filter_map(|bytes| FontRef::try_from_slice(bytes).ok())
    .collect()
});

/// A piece of text ready to be laid over a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TextBitmap {
    /// Left edge in the picture, pixels; may be outside.
    pub(crate) x: i32,
    /// Top edge.
    pub(crate) y: i32,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Premultiplied sRGB bytes and alpha.
    pub(crate) rgba: Vec<u8>,
}

/// Longer texts are cut: nothing useful is that long, and a file may name a joint anything.
const MAX_CHARS: usize = 120;

/// More labels would hide the picture, and finding places for them would take longer than drawing it.
const MAX_LABELS: usize = 256;

/// All texts of a scene, for a picture of the given size.
pub(crate) fn layout(scene: &Scene, width: u32, height: u32) -> Vec<TextBitmap> {
    let scale = height as f32 / REFERENCE_HEIGHT_PX;
    let halo = halo_color(scene);
    let backing = halo.map_or(Backing::None, Backing::Halo);
    let mut bitmaps = Vec::new();
    let mut corners = [0i32; 5];
    for caption in &scene.captions {
        let mut bitmap = rasterise(&caption.text, caption.size * scale, caption.color, backing);
        place_caption(&mut bitmap, caption, &mut corners, (width, height), scale);
        bitmaps.push(bitmap);
    }
    let paper = |ink: Color| halo.unwrap_or_else(|| opposite(ink));
    let labels = scene
        .labels
        .iter()
        .filter_map(|label| {
            let at = scene.camera.project(label.position, (width, height))?;
            let inside =
                at.x >= 0.0 && at.y >= 0.0 && at.x <= width as f32 && at.y <= height as f32;
            inside.then(|| Unplaced {
                bitmap: rasterise(
                    &label.text,
                    label.size * scale,
                    label.color,
                    Backing::Plate(paper(label.color)),
                ),
                at: (at.x, at.y),
                color: label.color,
            })
        })
        .take(MAX_LABELS)
        .collect();
    placing::place(labels, (width, height), scale, &mut bitmaps);
    bitmaps
}

/// Lays the bitmaps over a picture with straight alpha.
pub(crate) fn blend(bitmaps: &[TextBitmap], image: &mut Image) {
    let (width, height) = (image.width(), image.height());
    let pixels = image.as_rgba_mut();
    for bitmap in bitmaps {
        for row in 0..bitmap.height {
            let Some(y) = inside(bitmap.y, row, height) else {
                continue;
            };
            for column in 0..bitmap.width {
                let Some(x) = inside(bitmap.x, column, width) else {
                    continue;
                };
                let from = (row as usize * bitmap.width as usize + column as usize) * 4;
                let to = (y * width as usize + x) * 4;
                let source = &bitmap.rgba[from..from + 4];
                if source[3] > 0 {
                    over(source, &mut pixels[to..to + 4]);
                }
            }
        }
    }
}

fn inside(origin: i32, offset: u32, limit: u32) -> Option<usize> {
    let position = i64::from(origin) + i64::from(offset);
    usize::try_from(position)
        .ok()
        .filter(|&p| p < limit as usize)
}

/// Premultiplied `source` over straight `target`.
fn over(source: &[u8], target: &mut [u8]) {
    let source_alpha = u32::from(source[3]);
    let rest = u32::from(target[3]) * (255 - source_alpha) / 255;
    let alpha = source_alpha + rest;
    for c in 0..3 {
        let value = u32::from(source[c]) * 255 + u32::from(target[c]) * rest;
        target[c] = u8::try_from((value + alpha / 2) / alpha.max(1)).unwrap_or(u8::MAX);
    }
    target[3] = u8::try_from(alpha).unwrap_or(u8::MAX);
}

/// The colour behind text: the background's.
fn halo_color(scene: &Scene) -> Option<Color> {
    match scene.background {
        Background::Gradient { top, bottom } => Some(top.mix(bottom, 0.5)),
        Background::Transparent => None,
    }
}

fn place_caption(
    bitmap: &mut TextBitmap,
    caption: &Caption,
    corners: &mut [i32; 5],
    (width, height): (u32, u32),
    scale: f32,
) {
    let margin = round(14.0 * scale);
    let (w, h) = (signed(bitmap.width), signed(bitmap.height));
    let used = &mut corners[caption.corner as usize];
    let (left, right) = (margin, signed(width) - w - margin);
    let (top, bottom) = (margin + *used, signed(height) - h - margin - *used);
    *used += h;
    (bitmap.x, bitmap.y) = match caption.corner {
        Corner::TopLeft => (left, top),
        Corner::TopRight => (right, top),
        Corner::BottomLeft => (left, bottom),
        Corner::BottomRight => (right, bottom),
        Corner::BottomMiddle => ((signed(width) - w) / 2, bottom),
    };
}

/// What is drawn behind the letters.
#[derive(Clone, Copy, Debug)]
enum Backing {
    None,
    /// A soft rim around them.
    Halo(Color),
    /// A plate with round corners.
    Plate(Color),
}

/// White for dark ink, nearly black for light ink.
fn opposite(ink: Color) -> Color {
    let [r, g, b] = ink.to_array();
    if 0.21 * r + 0.72 * g + 0.07 * b < 0.2 {
        Color::from_hex(0xFF_FF_FF)
    } else {
        Color::from_hex(0x18_1C_22)
    }
}

/// One line of text before its backing.
fn rasterise(text: &str, size: f32, color: Color, backing: Backing) -> TextBitmap {
    let size = size.clamp(4.0, 400.0);
    let border = match backing {
        Backing::None => 0.0,
        Backing::Halo(_) => (size / 9.0).clamp(1.0, 6.0).ceil(),
        Backing::Plate(_) => (size / 5.0).clamp(2.0, 8.0).ceil(),
    };
    let above = match backing {
        Backing::Plate(_) => 0.0,
        Backing::None | Backing::Halo(_) => border,
    };
    let glyphs = glyphs(text, size, (border, above));
    let height = line_height(size) + 2.0 * above;
    let mut mask = Mask::new(pixels(glyphs.width + 2.0 * border + 1.0), pixels(height));
    for (font, glyph) in glyphs.list {
        if let Some(outline) = FONTS[font].outline_glyph(glyph) {
            let bounds = outline.px_bounds();
            let (left, top) = (round(bounds.min.x), round(bounds.min.y));
            outline.draw(|x, y, coverage| mask.add(left, top, x, y, coverage));
        }
    }
    let behind = match backing {
        Backing::None => None,
        Backing::Halo(color) => Some((mask.grown(round(border)), color)),
        Backing::Plate(color) => Some((mask.plate(border * 1.2), color)),
    };
    let behind = behind.map(|(cover, color)| (cover, color.to_srgb_bytes()));
    compose(&mask, color.to_srgb_bytes(), behind.as_ref())
}

struct Glyphs {
    /// Font and glyph.
    list: Vec<(usize, ab_glyph::Glyph)>,
    width: f32,
}

fn line_height(size: f32) -> f32 {
    size * 1.25
}

fn glyphs(text: &str, size: f32, (border, above): (f32, f32)) -> Glyphs {
    let mut list = Vec::new();
    let mut pen = 0.0f32;
    let mut last: Option<(usize, GlyphId)> = None;
    for character in text.chars().filter(|c| !c.is_control()).take(MAX_CHARS) {
        let with_glyph = FONTS.iter().position(|f| f.glyph_id(character).0 != 0);
        let font_index = with_glyph.unwrap_or(0);
        let Some(font) = FONTS.get(font_index) else {
            break;
        };
        let scaled = font.as_scaled(PxScale::from(size));
        let id = font.glyph_id(character);
        if let Some((last_font, last_id)) = last
            && last_font == font_index
        {
            pen += scaled.kern(last_id, id);
        }
        let baseline = above + scaled.ascent() + (line_height(size) - scaled.height()) * 0.5;
        let position = point(border + pen, baseline);
        list.push((font_index, id.with_scale_and_position(size, position)));
        pen += scaled.h_advance(id);
        last = Some((font_index, id));
    }
    Glyphs { list, width: pen }
}

struct Mask {
    width: u32,
    height: u32,
    coverage: Vec<f32>,
}

impl Mask {
    fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            coverage: vec![0.0; width as usize * height as usize],
        }
    }

    fn add(&mut self, left: i32, top: i32, x: u32, y: u32, coverage: f32) {
        if let (Some(x), Some(y)) = (inside(left, x, self.width), inside(top, y, self.height)) {
            let value = &mut self.coverage[y * self.width as usize + x];
            // A light font on a picture wants a little more weight than its outline has.
            *value = (*value + coverage * 1.25).min(1.0);
        }
    }

    /// The mask spread by `radius` pixels in a disc, softly.
    fn grown(&self, radius: i32) -> Vec<f32> {
        let (width, height) = (signed(self.width), signed(self.height));
        let mut grown = vec![0.0f32; self.coverage.len()];
        for y in 0..height {
            for x in 0..width {
                let value = self.coverage[index(y * width + x)];
                if value <= 0.05 {
                    continue;
                }
                for dy in -radius..=radius {
                    for dx in -radius..=radius {
                        let (nx, ny) = (x + dx, y + dy);
                        if nx < 0 || ny < 0 || nx >= width || ny >= height {
                            continue;
                        }
                        let distance = ((dx * dx + dy * dy) as f32).sqrt();
                        let weight = (1.0 - distance / (radius as f32 + 1.0)).max(0.0);
                        let target = &mut grown[index(ny * width + nx)];
                        *target = target.max(value * weight * 1.3);
                    }
                }
            }
        }
        grown
    }

    /// A rectangle with round corners over the whole mask.
    fn plate(&self, corner: f32) -> Vec<f32> {
        let (width, height) = (self.width as f32, self.height as f32);
        let corner = corner.min(0.5 * height).min(0.5 * width);
        let beyond = |at: f32, size: f32| (corner - at).max(at - (size - corner)).max(0.0);
        let cover = |(x, y): (u32, u32)| {
            let (dx, dy) = (
                beyond(x as f32 + 0.5, width),
                beyond(y as f32 + 0.5, height),
            );
            (corner + 0.5 - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0)
        };
        (0..self.height)
            .flat_map(|y| (0..self.width).map(move |x| (x, y)))
            .map(cover)
            .collect()
    }
}

fn compose(mask: &Mask, ink: [u8; 3], behind: Option<&(Vec<f32>, [u8; 3])>) -> TextBitmap {
    let mut rgba = Vec::with_capacity(mask.coverage.len() * 4);
    for (i, &coverage) in mask.coverage.iter().enumerate() {
        let (around, paper) = behind.map_or((0.0, [0; 3]), |(cover, color)| {
            (cover[i].min(1.0) * 0.8 * (1.0 - coverage), *color)
        });
        for c in 0..3 {
            rgba.push(byte(
                f32::from(ink[c]) * coverage + f32::from(paper[c]) * around,
            ));
        }
        rgba.push(byte(255.0 * (coverage + around)));
    }
    TextBitmap {
        x: 0,
        y: 0,
        width: mask.width,
        height: mask.height,
        rgba,
    }
}

fn byte(value: f32) -> u8 {
    #[expect(clippy::cast_possible_truncation, reason = "float casts saturate")]
    let byte = (value + 0.5) as u8;
    byte
}

fn round(value: f32) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "float casts saturate")]
    let rounded = value.round() as i32;
    rounded
}

fn pixels(value: f32) -> u32 {
    #[expect(clippy::cast_possible_truncation, reason = "float casts saturate")]
    let pixels = value.ceil() as u32;
    pixels.clamp(1, 8192)
}

fn signed(value: u32) -> i32 {
    i32::try_from(value).unwrap_or(i32::MAX)
}

fn index(value: i32) -> usize {
    usize::try_from(value).unwrap_or(0)
}
