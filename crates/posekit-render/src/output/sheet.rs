//! Contact sheets: several moments of a motion side by side, each with its time.

use crate::image::Image;
use crate::render::{RenderError, Renderer};
use crate::scene::{Caption, Corner, Scene};
use crate::theme::Theme;

/// A contact sheet: a row of pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSheet {
    /// Width of one picture, pixels.
    pub cell_width: u32,
    /// Height of one picture, pixels.
    pub cell_height: u32,
    /// The time of the motion that each picture shows, seconds.
    pub times_secs: Vec<f64>,
}

/// `count` times spread evenly from `start_secs` to `end_secs`, ends included; a single one is the
/// middle.
#[must_use]
pub fn spread_times(count: usize, start_secs: f64, end_secs: f64) -> Vec<f64> {
    if count == 1 {
        return vec![(start_secs + end_secs) * 0.5];
    }
    let step = (end_secs - start_secs) / (count.max(2) - 1) as f64;
    (0..count).map(|i| start_secs + step * i as f64).collect()
}

/// Draws a contact sheet.
///
/// `scene_at` makes the scene of a time for a picture of the cell's size. The grid's caption is
/// kept in the first picture only.
///
/// # Errors
/// What the renderer reports.
pub fn render_contact_sheet(
    sheet: &ContactSheet,
    scene_at: &dyn Fn(f64) -> Scene,
    theme: &Theme,
    renderer: &mut Renderer,
) -> Result<Image, RenderError> {
    let (width, height) = (sheet.cell_width, sheet.cell_height);
    let count = u32::try_from(sheet.times_secs.len()).unwrap_or(u32::MAX);
    let total = u64::from(width) * u64::from(count);
    let total = u32::try_from(total)
        .ok()
        .filter(|&w| u64::from(w) * u64::from(height) <= MAX_AREA);
    let Some(total) = total else {
        return Err(RenderError::TooLarge {
            width: width.saturating_mul(count),
            height,
        });
    };
    let mut whole = Image::new(total, height);
    let mut cell = Image::default();
    for (i, &time) in (0..).zip(&sheet.times_secs) {
        let mut scene = scene_at(time);
        if i > 0 {
            scene.captions.clear();
        }
        scene.captions.push(Caption {
            corner: Corner::BottomMiddle,
            text: format!("{time:.2} s"),
            color: theme.text,
            size: 30.0,
        });
        renderer.render_into(&scene, width, height, &mut cell)?;
        whole.paste(&cell, width * i, 0);
    }
    Ok(whole)
}

/// A gigapixel: more is a mistake.
const MAX_AREA: u64 = 1 << 30;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_even_and_include_the_ends() {
        assert_eq!(spread_times(5, 1.0, 3.0), [1.0, 1.5, 2.0, 2.5, 3.0]);
        assert_eq!(spread_times(1, 1.0, 3.0), [2.0]);
        assert_eq!(spread_times(0, 1.0, 3.0), [0.0; 0]);
    }
}
