//! sRGB pixels to the planes that video is coded in.

use crate::image::Image;

/// A picture in luma and chroma, 4:2:0, BT.709, limited range: what players take a high-definition film for
/// even when they do not read its tags.
#[derive(Clone, Debug)]
pub(super) struct YuvImage {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) luma: Vec<u8>,
    pub(super) blue: Vec<u8>,
    pub(super) red: Vec<u8>,
}

impl YuvImage {
    /// Converts a picture of even width and height; the last column and row of an odd one are left
    /// out.
    pub(super) fn of(image: &Image) -> Self {
        let (width, height) = (image.width() as usize & !1, image.height() as usize & !1);
        let stride = image.width() as usize * 4;
        let mut luma = vec![0; width * height];
        let mut blue = vec![0; width * height / 4];
        let mut red = vec![0; width * height / 4];
        let rows = image.as_rgba().chunks_exact((stride * 2).max(1));
        let planes = luma
            .chunks_exact_mut((width * 2).max(1))
            .zip(blue.chunks_exact_mut((width / 2).max(1)))
            .zip(red.chunks_exact_mut((width / 2).max(1)));
        for (pair, ((luma, blue), red)) in rows.zip(planes) {
            let (upper, lower) = pair.split_at(stride);
            let (luma_upper, luma_lower) = luma.split_at_mut(width);
            convert_luma(upper, luma_upper);
            convert_luma(lower, luma_lower);
            convert_chroma(upper, lower, blue, red);
        }
        Self {
            width,
            height,
            luma,
            blue,
            red,
        }
    }
}

fn convert_luma(pixels: &[u8], luma: &mut [u8]) {
    for (pixel, y) in pixels.chunks_exact(4).zip(luma) {
        let [r, g, b] = [pixel[0], pixel[1], pixel[2]].map(u32::from);
        *y = narrow((47 * r + 157 * g + 16 * b + 16 * 256 + 128) >> 8);
    }
}

/// One chroma sample for each block of two by two pixels.
fn convert_chroma(upper: &[u8], lower: &[u8], blue: &mut [u8], red: &mut [u8]) {
    let blocks = upper.chunks_exact(8).zip(lower.chunks_exact(8));
    for ((top, bottom), (cb, cr)) in blocks.zip(blue.iter_mut().zip(red)) {
        let sum = |c: usize| {
            u32::from(top[c])
                + u32::from(top[c + 4])
                + u32::from(bottom[c])
                + u32::from(bottom[c + 4])
        };
        let (r, g, b) = (sum(0), sum(1), sum(2));
        // The offset of 128 keeps everything positive: the sums are four times a byte.
        let offset = 4 * 128 * 256 + 512;
        *cb = narrow((offset + 112 * b - 26 * r - 86 * g) >> 10);
        *cr = narrow((offset + 112 * r - 102 * g - 10 * b) >> 10);
    }
}

fn narrow(value: u32) -> u8 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the coefficients keep it in 16..=240"
    )]
    let byte = value as u8;
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_color(rgb: [u8; 3]) -> [u8; 3] {
        let pixels = [rgb[0], rgb[1], rgb[2], 255].repeat(4);
        let image = Image::from_rgba(2, 2, pixels).unwrap();
        let yuv = YuvImage::of(&image);
        assert_eq!((yuv.luma.len(), yuv.blue.len(), yuv.red.len()), (4, 1, 1));
        [yuv.luma[0], yuv.blue[0], yuv.red[0]]
    }

    /// Rec. ITU-R BT.709-6, 3.4 and 4.6: the 8-bit codes of white, black and the primaries, as
    /// computed from its coefficients in floating point.
    #[test]
    fn primaries_have_their_codes() {
        let expected = |r: f64, g: f64, b: f64| {
            let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            let (cb, cr) = ((b - y) / 1.8556, (r - y) / 1.5748);
            [16.0 + 219.0 * y, 128.0 + 224.0 * cb, 128.0 + 224.0 * cr]
        };
        for bits in 0..8u8 {
            let on = |k: u8| f64::from(bits >> k & 1);
            let rgb = [on(0), on(1), on(2)];
            let got = of_color(rgb.map(|v| if v > 0.5 { 255 } else { 0 }));
            let want = expected(rgb[0], rgb[1], rgb[2]);
            for (g, w) in got.iter().zip(want) {
                assert!((f64::from(*g) - w).abs() <= 1.5, "{rgb:?} {got:?} {want:?}");
            }
        }
    }
}
