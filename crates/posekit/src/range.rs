//! The numbers that posekit works with: how long a time, and how long a length.
//!
//! Poses are `f32`, and much of what is made of them is a square or a sum of squares. A length, or a time that
//! something is divided by, that is a finite number may still make results that are none. What comes from files
//! and from people is held against these bounds once, where it enters; inside them, whatever is computed stays
//! finite: a chain of a hundred thousand joints, each as far from its parent as can be, has a squared length of
//! 3e34, and `f32` ends at 3.4e38.

/// The shortest time that something is divided by, in seconds: a nanosecond.
pub const SHORTEST_SECS: f64 = 1e-9;

/// The latest time, and the longest, in seconds: over thirty years.
pub const LONGEST_SECS: f64 = 1e9;

/// The longest length, coordinate by coordinate, in whatever unit: in millimetres, far beyond the Sun.
pub const LONGEST_LENGTH: f64 = 1e12;

/// Whether numbers are places or lengths that posekit can work with; one that is not finite is none.
pub fn are_lengths(coordinates: impl IntoIterator<Item = f64>) -> bool {
    coordinates
        .into_iter()
        .all(|coordinate| coordinate.abs() <= LONGEST_LENGTH)
}
