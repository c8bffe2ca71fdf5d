//! What is animated beside a skeleton: cameras, lights and objects, each property fixed or keyed.

use glam::{DQuat, DVec3};

use super::track::Track;
use super::value::KeyValue;

/// A property that may be animated.
#[derive(Clone, Debug, PartialEq)]
pub enum Property<V: KeyValue> {
    /// It never changes.
    Fixed(V),
    /// It follows a track.
    Keyed(Track<V>),
}

impl<V: KeyValue> Property<V> {
    /// The value at a time in seconds.
    pub fn at(&self, time_secs: f64) -> V {
        match self {
            Self::Fixed(value) => *value,
            Self::Keyed(track) => track.sample(time_secs),
        }
    }

    /// The track, if it follows one.
    pub fn track(&self) -> Option<&Track<V>> {
        match self {
            Self::Fixed(_) => None,
            Self::Keyed(track) => Some(track),
        }
    }

    /// The times of its first and last key, if it is keyed.
    pub fn range_secs(&self) -> Option<[f64; 2]> {
        self.track()
            .map(|track| [track.start_secs(), track.end_secs()])
    }
}

/// A camera. Places are in world space and the file's unit; up is +Y.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyedCamera {
    /// Where it stands.
    pub position: Property<DVec3>,
    /// What it looks at.
    pub target: Property<DVec3>,
    /// The full vertical angle of view, in degrees (as lenses and editors state it), in (0, 180).
    pub vertical_fov_deg: Property<f64>,
}

/// A light that shines from a place.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyedLight {
    /// Where it stands, in world space and the file's unit.
    pub position: Property<DVec3>,
    /// Linear red, green and blue, 1 for full.
    pub color: Property<DVec3>,
    /// Factor of the colour, 0 for off.
    pub strength: Property<f64>,
}

/// An object's transform in world space: scaled, then turned, then moved.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyedTransform {
    /// Where it stands, in the file's unit.
    pub translation: Property<DVec3>,
    /// How it is turned.
    pub rotation: Property<DQuat>,
    /// Factor of its size along its own axes.
    pub scale: Property<DVec3>,
}

impl Default for KeyedCamera {
    /// From three units ahead and a little above towards the middle of a person, 40 degrees high.
    fn default() -> Self {
        Self {
            position: Property::Fixed(DVec3::new(0.0, 1.4, 4.0)),
            target: Property::Fixed(DVec3::new(0.0, 0.9, 0.0)),
            vertical_fov_deg: Property::Fixed(40.0),
        }
    }
}

impl Default for KeyedLight {
    /// White, above.
    fn default() -> Self {
        Self {
            position: Property::Fixed(DVec3::new(2.0, 4.0, 3.0)),
            color: Property::Fixed(DVec3::ONE),
            strength: Property::Fixed(1.0),
        }
    }
}

impl Default for KeyedTransform {
    /// The identity.
    fn default() -> Self {
        Self {
            translation: Property::Fixed(DVec3::ZERO),
            rotation: Property::Fixed(DQuat::IDENTITY),
            scale: Property::Fixed(DVec3::ONE),
        }
    }
}
