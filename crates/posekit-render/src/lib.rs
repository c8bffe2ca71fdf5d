//! A posed scene becomes a picture, a texture or a film.
//!
//! The way through the crate: a [`posekit::motion::Motion`] gets a body and becomes a
//! [`stage::Actor`]; actors stand on a [`stage::Stage`], which makes a [`scene::Scene`] for any
//! time; a back end draws the scene. There are two, with one shading model and one look: [`cpu`]
//! on any machine, the same bytes everywhere, and `gpu` through wgpu, into a window's texture or a
//! picture. [`output`] writes pictures and films, [`render`] chooses the back end.
//!
//! Knows no file format of motions, opens no file, and knows no window toolkit. World space is as in
//! [`posekit`]: right-handed, Y up, the file's length unit; all sizes follow the figure's stature,
//! so metres, centimetres and inches look the same.
//!
//! # Cargo features
//! - `gpu` (default): the wgpu back end.
//! - `h264` (default): H.264 films, with `OpenH264` built from its source; not for wasm.
//!
//! # Example
//! ```
//! use std::sync::Arc;
//! use glam::Vec3;
//! use posekit::{motion::{FrameTime, Motion}, skeleton::SkeletonBuilder};
//! use posekit_render::{cpu, output::write_png};
//! use posekit_render::stage::{Actor, SkeletonStyle, Stage, StageOptions};
//! use posekit_render::theme::CharacterColors;
//!
//! let mut arm = SkeletonBuilder::new();
//! let base = arm.joint("base", None, Vec3::ZERO);
//! let elbow = arm.joint("elbow", Some(base), Vec3::Y);
//! arm.end_site("tip", elbow, Vec3::X);
//! let motion = Arc::new(Motion::at_rest(Arc::new(arm.build()?), 1, FrameTime::of_fps(30), []));
//! let actor = Actor::new(motion, SkeletonStyle::Body, CharacterColors::of(0));
//! let stage = Stage::new(vec![actor], StageOptions::default());
//! let image = cpu::render(&stage.scene(0.0, 1.5), 300, 200);
//! let mut png = Vec::new();
//! write_png(&image, &mut png)?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod camera;
pub mod character;
pub mod color;
pub mod cpu;
pub mod framing;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod grid;
pub mod image;
mod lines;
pub mod mesh;
pub mod output;
pub mod render;
pub mod scene;
mod shading;
mod shadow_frame;
pub mod stage;
mod text;
pub mod theme;
