//! In-betweens: the ways of getting from one orientation to another, side by side, and what each makes of
//! a real motion of which only some frames are kept.
//!
//! [`Between`] prepares one way between two orientations and gives a [`Blend`] at any share of it, with
//! what is wrong with it (scale, shear); [`path`] tells how fast it turns and how far it strays from
//! slerp. [`fill`] fills in the frames between kept ones of a motion, and [`FillError`] says how far the
//! result is from the truth, joint by joint.
//!
//! **Space and units.** Orientations in any one space, in the parent's for motions; degrees where a name
//! ends in `_deg`.
//!
//! **Method.** Slerp is written as `R1 exp(t log(R1^T R2))` (Shoemake 1985); the others are what people
//! use in its place. Element-wise interpolation of matrices leaves the rotations: its determinant sinks
//! below 1 and its columns are not at right angles. The raw quaternion lerp turns along the same arc as
//! slerp at an uneven pace, and scales. Rotation vectors and Euler angles are interpolated number by
//! number, from the representative of the end that is nearest to the start, as a graph editor's curves
//! are.

mod between;
mod error;
mod fill;
mod fill_method;
mod method;
mod path;
mod preset;

pub use between::{Between, Blend, Ends};
pub use error::{FillError, JointError};
pub use fill::{FillConfigError, FillPlan, fill};
pub use fill_method::FillMethod;
pub use method::{Method, MethodError};
pub use path::{PathStep, path};
pub use preset::Preset;
