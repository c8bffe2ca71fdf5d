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
    /// Handles that are free in time as well as in value, of numbers and vectors: the weighted tangents
    /// of Maya, the handles of an F-curve in Blender. The segment is the Bezier curve through both keys
    /// and the two handles between them, solved for time. A side without such handles has its own a third
    /// of the way along.
    Handles {
        /// On the segment that ends at the key.
        incoming: Handle<V>,
        /// On the segment that starts at the key.
        outgoing: Handle<V>,
        /// Whether an editor turns one with the other. The curve takes both as they are.
        pair: HandlePair,
    },
}

/// A handle of a Bezier curve, seen from its key; of a vector each component has one of its own.
///
/// One that reaches past the neighbouring key is shortened along its direction until it ends there, as
/// Blender does: the curve then never runs back in time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Handle<V> {
    /// How far before or after the key it ends, in seconds: never negative.
    pub secs: V,
    /// How far above the key's value it ends; negative below.
    pub value: V,
}

/// Whether the two handles of a key belong together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum HandlePair {
    /// They lie on one line through the key: the curve is smooth.
    #[default]
    Aligned,
    /// Each goes its own way.
    Broken,
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
