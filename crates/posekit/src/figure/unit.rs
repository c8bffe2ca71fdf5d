//! The length unit of a file, guessed from how tall the figure is.

/// The statures that a guess takes for a person's, in metres: children of seven to very tall adults.
///
/// Narrow enough that the units below do not overlap: no figure is a person in two of them.
pub const STATURE_RANGE_METRES: (f64, f64) = (1.25, 2.15);

/// A length unit that motion files are found in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LengthUnit {
    /// Metres.
    Metre,
    /// Feet.
    Foot,
    /// Decimetres, as MakeHuman uses.
    Decimetre,
    /// The unit of the CMU motion capture database: an inch over 0.45, 5.644 cm.
    CmuUnit,
    /// Inches.
    Inch,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    Millimetre,
}

impl LengthUnit {
    /// All of them, from the fewest to the most that make a person.
    pub const ALL: [Self; 7] = [
        Self::Metre,
        Self::Foot,
        Self::Decimetre,
        Self::CmuUnit,
        Self::Inch,
        Self::Centimetre,
        Self::Millimetre,
    ];

    /// How many metres one of it is.
    pub const fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Foot => 0.3048,
            Self::Decimetre => 0.1,
            Self::CmuUnit => 0.0254 / 0.45,
            Self::Inch => 0.0254,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
        }
    }

    /// Its name in the plural, as `centimetres`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Metre => "metres",
            Self::Foot => "feet",
            Self::Decimetre => "decimetres",
            Self::CmuUnit => "CMU units (5.64 cm)",
            Self::Inch => "inches",
            Self::Centimetre => "centimetres",
            Self::Millimetre => "millimetres",
        }
    }
}

/// The unit in which a figure of this height is as tall as a person, if there is one.
///
/// ```
/// use posekit::figure::{LengthUnit, guess_unit};
///
/// assert_eq!(guess_unit(1.75), Some(LengthUnit::Metre));
/// assert_eq!(guess_unit(175.0), Some(LengthUnit::Centimetre));
/// assert_eq!(guess_unit(0.4), None);
/// ```
pub fn guess_unit(height: f64) -> Option<LengthUnit> {
    let (low, high) = STATURE_RANGE_METRES;
    LengthUnit::ALL
        .into_iter()
        .find(|unit| (low..=high).contains(&(height * unit.metres())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_found_for_a_person_and_no_height_is_a_person_in_two() {
        for unit in LengthUnit::ALL {
            assert_eq!(guess_unit(1.7 / unit.metres()), Some(unit));
        }
        let (low, high) = STATURE_RANGE_METRES;
        for pair in LengthUnit::ALL.windows(2) {
            assert!(high / pair[0].metres() < low / pair[1].metres(), "{pair:?}");
        }
        assert_eq!(guess_unit(f64::NAN), None);
        assert_eq!(guess_unit(0.0), None);
    }
}
