//! Colours: linear light for shading, sRGB bytes for pictures.
//!
//! A [`Color`] holds linear-light red, green and blue in 0..=1. Pictures hold sRGB-encoded bytes
//! (IEC 61966-2-1). The encoding is by table, built with `libm`, so that it is the same on every
//! machine.

use std::sync::LazyLock;

/// A colour in linear light, red, green, blue in 0..=1 (larger values are clamped when encoded).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Color {
    /// Red, linear light.
    pub r: f32,
    /// Green, linear light.
    pub g: f32,
    /// Blue, linear light.
    pub b: f32,
}

/// Entries of the encoding table. 4096 steps keep the error under half a byte step everywhere but
/// in the darkest shades, where it stays under two.
const ENCODE_STEPS: usize = 4096;

static ENCODE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    (0..=ENCODE_STEPS)
        .map(|i| byte(srgb_from_linear(i as f32 / ENCODE_STEPS as f32)))
        .collect()
});

fn byte(unit: f32) -> u8 {
    // The value is in 0..=255.5 and not NaN, so the truncation is the rounding wanted.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to 0..=255 before the cast"
    )]
    let byte = (unit.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    byte
}

/// The sRGB transfer function (IEC 61966-2-1): linear light to encoded value, both in 0..=1.
#[must_use]
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055
    }
}

/// The inverse of [`srgb_from_linear`].
#[must_use]
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        libm::powf((encoded + 0.055) / 1.055, 2.4)
    }
}

impl Color {
    /// A colour from its sRGB bytes, written as `0xRRGGBB`.
    #[must_use]
    pub fn from_hex(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self::from_srgb_bytes([r, g, b])
    }

    /// A colour from sRGB bytes.
    #[must_use]
    pub fn from_srgb_bytes([r, g, b]: [u8; 3]) -> Self {
        let lin = |byte: u8| linear_from_srgb(f32::from(byte) / 255.0);
        Self {
            r: lin(r),
            g: lin(g),
            b: lin(b),
        }
    }

    /// The colour as sRGB bytes, by table.
    #[must_use]
    pub fn to_srgb_bytes(self) -> [u8; 3] {
        encode_linear([self.r, self.g, self.b])
    }

    /// The colour as sRGB-encoded values in 0..=1.
    #[must_use]
    pub fn to_srgb(self) -> [f32; 3] {
        [
            srgb_from_linear(self.r),
            srgb_from_linear(self.g),
            srgb_from_linear(self.b),
        ]
    }

    /// The colour `amount` of the way from `self` to `other`, in linear light.
    #[must_use]
    pub fn mix(self, other: Self, amount: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * amount;
        Self {
            r: mix(self.r, other.r),
            g: mix(self.g, other.g),
            b: mix(self.b, other.b),
        }
    }

    /// Each channel times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            r: self.r * factor,
            g: self.g * factor,
            b: self.b * factor,
        }
    }

    /// Red, green, blue, linear light.
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }
}

/// Linear light to sRGB bytes, by table; values outside 0..=1 are clamped.
#[inline]
#[must_use]
pub fn encode_linear(linear: [f32; 3]) -> [u8; 3] {
    let table: &[u8] = &ENCODE;
    linear.map(|value| {
        let scaled = value.clamp(0.0, 1.0) * ENCODE_STEPS as f32 + 0.5;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "clamped to the table; NaN becomes 0"
        )]
        let index = scaled as usize;
        table[index]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for byte in 0..=255u8 {
            let color = Color::from_srgb_bytes([byte; 3]);
            // Below 10 a table step is wider than a byte step.
            let allowed = u8::from(byte < 10);
            assert!(color.to_srgb_bytes()[0].abs_diff(byte) <= allowed, "{byte}");
        }
    }

    #[test]
    fn encoding_clamps_and_swallows_nan() {
        assert_eq!(encode_linear([-1.0, 2.0, f32::NAN]), [0, 255, 0]);
    }

    /// Middle grey as the standard's own worked values have it: 0.5 linear is 188 encoded.
    #[test]
    fn half_linear_is_188() {
        assert_eq!(encode_linear([0.5; 3]), [188; 3]);
    }
}
