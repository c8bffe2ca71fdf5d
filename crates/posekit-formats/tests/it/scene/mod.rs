//! Scene files: what is read, what is refused and where, and that writing loses nothing.

mod authored_walk;
mod euler;
mod reading;
mod reduced;
mod refusals;
mod round_trip;
mod shots;

use posekit_formats::scene::{self, Scene, SceneReadError};

/// A file of version 1 that a person wrote.
const NOD: &str = include_str!("../../golden/scene_v1.posekit.toml");

fn nod() -> Scene {
    scene::read(NOD.as_bytes()).expect("a scene")
}

/// The nod with one piece of its text replaced.
fn changed(from: &str, to: &str) -> Result<Scene, SceneReadError> {
    assert_eq!(NOD.matches(from).count(), 1, "{from} stands there once");
    scene::read(NOD.replace(from, to).as_bytes())
}
