//! A colour for each method, the same in the view, the plots and the lists.

use posekit::inbetween::{FillMethod, Method};
use posekit_render::color::Color;
use posekit_render::theme::CharacterColors;

use super::kind::Kind;

/// The colours of the six Euler orders, in the order of [`Method::ALL`].
const EULER: [(&str, u32); 6] = [
    ("XYZ", 0xE0_7B_1F),
    ("XZY", 0xB9_8A_12),
    ("YXZ", 0xE8_9A_C0),
    ("YZX", 0xC4_48_8C),
    ("ZXY", 0x8E_5B_3A),
    ("ZYX", 0xA5_A1_4A),
];

/// What is in no list.
const OTHER: u32 = 0x80_88_94;

/// The truth that filled-in motions are compared with.
pub const TRUTH: u32 = 0xD8_D6_D0;

/// Curves of angles.
const CURVES: u32 = 0xF2_5C_9A;

/// A colour as `RRGGBB`.
#[must_use]
pub fn hex_of(kind: impl Into<Kind>) -> u32 {
    match kind.into() {
        Kind::Between(method) => hex_of_method(method),
        Kind::Curves => CURVES,
    }
}

fn hex_of_method(method: Method) -> u32 {
    match method {
        Method::Slerp => 0x25_6F_D8,
        Method::RawSlerp => 0x7F_B2_F2,
        Method::Nlerp => 0x2B_9A_62,
        Method::RawLerp => 0x86_BF_3C,
        Method::Matrix => 0xD2_3C_34,
        Method::RotationVector => 0x94_67_CC,
        Method::Squad => 0x20_A5_A8,
        Method::Euler(order) => {
            let word = order.to_string();
            let known = EULER.iter().find(|(name, _)| *name == word);
            known.map_or(OTHER, |(_, hex)| *hex)
        }
        _ => OTHER,
    }
}

/// The colour of a method for whole figures.
#[must_use]
pub fn hex_of_fill(method: FillMethod) -> u32 {
    match method {
        FillMethod::Same(method) => hex_of(method),
        FillMethod::OwnEuler => 0xE0_7B_1F,
    }
}

/// A colour for the scene.
#[must_use]
pub fn color_of(kind: impl Into<Kind>) -> Color {
    Color::from_hex(hex_of(kind))
}

/// The colours of a figure, all near one.
#[must_use]
pub fn figure_of(hex: u32) -> CharacterColors {
    let base = Color::from_hex(hex);
    CharacterColors {
        base,
        accent: base.mix(Color::from_hex(0x20_24_2B), 0.6),
        left: base.mix(Color::from_hex(0xFF_FF_FF), 0.3),
        right: base.mix(Color::from_hex(0x20_24_2B), 0.2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_has_a_colour_of_its_own() {
        let mut colors: Vec<u32> = Kind::all().map(hex_of).collect();
        colors.sort_unstable();
        colors.dedup();
        assert_eq!(colors.len(), Method::ALL.len() + 1);
        assert!(!colors.contains(&OTHER));
    }
}
