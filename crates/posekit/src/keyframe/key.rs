//! A key: time, value, and how the value goes on from there.

use super::value::KeyValue;

/// How a property gets from a key to the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Interpolation {
    /// It keeps its value and jumps at the next key.
    Step,
    /// The straight way at an even pace: [`slerp`](crate::rotation::slerp) for orientations.
    Linear,
    /// A cubic with the [`Tangents`] of both keys, C1 where they are not broken. Orientations run in
    /// the components of the quaternion and are normalised, as `CUBICSPLINE` in glTF 2.0 does.
    #[default]
    Cubic,
    /// A curve through the keys that needs no tangents, C1: Shoemake's (1987) squad for orientations,
    /// Catmull and Rom's (1974) cubic for numbers and vectors.
    Squad,
}

/// The slopes of a cubic at a key, per second. Of an orientation they are derivatives of the key's
/// quaternion (see [`tangent_of_angular_velocity`](super::tangent_of_angular_velocity)).
///
/// A Bezier handle of a graph editor lies a third of the way to the neighbouring key, on the slope:
/// at `value + tangent * secs / 3`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Tangents<V> {
    /// Chosen from the neighbours so that the curve is smooth and does not leave the range of its
    /// keys: flat at extrema and at the ends of a track that does not cycle.
    #[default]
    Auto,
    /// Chosen from the neighbours without that limit: on the parabola through the three keys, at the
    /// ends straight towards the neighbour.
    Smooth,
    /// No change.
    Flat,
    /// One slope for both sides.
    Aligned(V),
    /// A slope of its own for each side.
    Broken {
        /// On the segment that ends at the key.
        incoming: V,
        /// On the segment that starts at the key.
        outgoing: V,
    },
}

/// A time, a value, and how the value goes on to the next key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe<V: KeyValue> {
    /// When, in seconds.
    pub time_secs: f64,
    /// What: in the unit of the property; an orientation as a unit quaternion of either sign.
    pub value: V,
    /// How the segment that starts here is filled.
    pub interpolation: Interpolation,
    /// The slopes of cubic segments at this key.
    pub tangents: Tangents<V>,
}

impl<V: KeyValue> Keyframe<V> {
    /// A key with automatic tangents.
    pub fn new(time_secs: f64, value: V, interpolation: Interpolation) -> Self {
        Self {
            time_secs,
            value,
            interpolation,
            tangents: Tangents::Auto,
        }
    }
}
