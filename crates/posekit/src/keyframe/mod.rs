//! Authored motion: keys, tracks, keyed skeletons, and what is done with them.
//!
//! A [`Track`] is one animated property, its [`Keyframe`]s in rising order of time: a number, a vector
//! or an orientation. An [`Animation`] is the tracks of a skeleton; [`Animation::bake`] makes a
//! [`Motion`](crate::motion::Motion) of it. Cameras, lights and objects are animated by the same tracks
//! ([`KeyedCamera`], [`KeyedLight`], [`KeyedTransform`]). [`edit`] holds what an editor does to keys.
//!
//! **Space and units.** Times are `f64` seconds on a line shared by all tracks of a scene. Values are in
//! the property's unit; orientations are unit quaternions in the parent's space. Slopes are per second.
//!
//! **Method.** Between keys: steps, straight lines and slerp (Shoemake 1985), cubic Hermite segments
//! with the tangents that graph editors have and the definition that glTF 2.0 gives for orientations,
//! and squad (Shoemake 1987). A Bezier segment whose handles lie a third of the way along in time is the
//! same curve as the Hermite one; handles of numbers and vectors may lie elsewhere in time, too
//! ([`Tangents::Handles`]).
//!
//! **Rotations** of joints have two modes ([`RotationTrack`]), as in every animation package. *Quaternions* go
//! the short way from key to key: no gimbal lock, and no turn over 180 degrees. *Euler curves*
//! ([`EulerTrack`]) are three curves of angles, in one of twelve orders, that turn as far and as often as they
//! say. [`to_euler`] and [`to_quaternion`] change one into the other within a stated bound.
//!
//! **Guarantees.** A track is valid once it is made: sampling never fails, and gives unit quaternions.
//! Cubic and squad segments join with continuous velocity where tangents are not broken, however the
//! keys are spaced, and over the seam of a cycle. The short way is taken from key to key over the whole
//! track, so that neither a quaternion's sign nor its neighbour's matters.

mod animation;
mod convert;
pub mod edit;
mod euler;
mod extrapolation;
mod key;
mod property;
mod reduce;
mod sampler;
mod track;
mod track_error;
mod value;

pub use animation::{Animation, BakeConfig};
pub use convert::{ConvertConfig, Converted, LostTurn, lost_turn, to_euler, to_quaternion};
pub use euler::{EulerTrack, EulerTrackError, RotationTrack};
pub use extrapolation::{Extrapolation, Place};
pub use key::{Handle, HandlePair, Interpolation, Keyframe, Tangents};
pub use property::{KeyedCamera, KeyedLight, KeyedTransform, Property};
pub use reduce::{
    KeyError, KeyedFrames, LEAST_ANGLE_DEG, LEAST_DISTANCE_HEIGHTS, ReduceConfig, ReduceError,
    Reduction, reduce,
};
pub use sampler::PoseSampler;
pub use track::{Track, angular_velocity_of_tangent, tangent_of_angular_velocity};
pub use track_error::TrackError;
pub use value::KeyValue;
