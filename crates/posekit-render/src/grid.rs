//! The grid's spacing, and how it is said.

/// A grid's spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridSpacing {
    /// Distance between lines: 1, 2 or 5 times a power of ten.
    pub spacing: f32,
    /// Every how many lines one is stronger.
    pub major_every: u32,
}

/// What a length number of the scene means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum LengthUnit {
    /// Nobody knows: numbers are shown bare.
    #[default]
    Unknown,
    /// Metres.
    Metre,
    /// Decimetres.
    Decimetre,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    Millimetre,
    /// Inches.
    Inch,
    /// Feet.
    Foot,
}

impl LengthUnit {
    /// The unit's symbol; empty when it is not known.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Unknown => "",
            Self::Metre => "m",
            Self::Decimetre => "dm",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }
}

/// The spacing for a figure of height `scale`: about a quarter of it. A scale that is not positive
/// and finite counts as 1.
#[must_use]
pub fn spacing_for(scale: f32) -> GridSpacing {
    let wanted = if scale.is_finite() && scale > 0.0 {
        f64::from(scale) * 0.28
    } else {
        0.28
    };
    let power = libm::pow(10.0, libm::floor(libm::log10(wanted)));
    // The thresholds are the geometric means of the neighbours.
    let (digit, major_every) = match wanted / power {
        lead if lead < std::f64::consts::SQRT_2 => (1.0, 5),
        lead if lead < 3.162 => (2.0, 5),
        lead if lead < 7.071 => (5.0, 4),
        _ => (10.0, 5),
    };
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the scale came from single precision"
    )]
    let spacing = (digit * power) as f32;
    GridSpacing {
        spacing,
        major_every,
    }
}

/// The spacing in words: "grid 0.5 m", or "grid 50" when the unit is not known.
#[must_use]
pub fn spacing_text(spacing: f32, unit: LengthUnit) -> String {
    let text = format!("grid {spacing} {}", unit.symbol());
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_person_gets_the_same_grid_in_every_unit() {
        for (height, spacing) in [(1.7, 0.5), (170.0, 50.0), (17.0, 5.0), (1700.0, 500.0)] {
            assert_eq!(spacing_for(height).spacing, spacing, "{height}");
        }
        assert_eq!(spacing_for(67.0).spacing, 20.0);
    }

    #[test]
    fn spacings_are_one_two_or_five_times_a_power_of_ten() {
        for i in 0..400 {
            let height = 1e-6 * 1.09f32.powi(i);
            let spacing = f64::from(spacing_for(height).spacing);
            let power = 10f64.powf((spacing.log10() + 1e-6).floor());
            let lead = spacing / power;
            assert!(
                [1.0, 2.0, 5.0].iter().any(|d| (lead - d).abs() < 1e-4),
                "{height} {spacing}"
            );
            let ratio = spacing / f64::from(height);
            assert!((0.17..0.45).contains(&ratio), "{height} {spacing}");
        }
    }

    #[test]
    fn bad_scales_get_some_grid() {
        for scale in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(spacing_for(scale).spacing > 0.0);
        }
    }

    #[test]
    fn the_spacing_is_said_with_its_unit() {
        assert_eq!(spacing_text(0.5, LengthUnit::Metre), "grid 0.5 m");
        assert_eq!(spacing_text(50.0, LengthUnit::Unknown), "grid 50");
    }
}
