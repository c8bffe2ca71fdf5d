//! Draws a standing figure to a PNG file, on the CPU.
//!
//! `cargo run -p posekit-render --example figure -- figure.png`

use std::fs::File;
use std::sync::Arc;

use glam::Vec3;

use posekit::motion::{FrameTime, Motion};
use posekit::skeleton::{Skeleton, SkeletonBuilder, SkeletonError};
use posekit_render::cpu;
use posekit_render::output::write_png;
use posekit_render::stage::{Actor, SkeletonStyle, Stage, StageOptions};
use posekit_render::theme::CharacterColors;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "figure.png".to_owned());
    let motion = Motion::at_rest(Arc::new(skeleton()?), 1, FrameTime::of_fps(30), []);
    let actor = Actor::new(
        Arc::new(motion),
        SkeletonStyle::Body,
        CharacterColors::of(0),
    );
    let stage = Stage::new(vec![actor], StageOptions::default());
    let scene = stage.scene(0.0, 16.0 / 9.0);
    write_png(&cpu::render(&scene, 1280, 720), File::create(path)?)?;
    Ok(())
}

/// Somebody 1.7 metres tall, arms hanging.
fn skeleton() -> Result<Skeleton, SkeletonError> {
    let mut b = SkeletonBuilder::new();
    let hips = b.joint("hips", None, Vec3::new(0.0, 0.95, 0.0));
    for (side, x) in [("left", 1.0), ("right", -1.0)] {
        let hip = b.joint(
            format!("{side} hip"),
            Some(hips),
            Vec3::new(0.1 * x, -0.05, 0.0),
        );
        let knee = b.joint(
            format!("{side} knee"),
            Some(hip),
            Vec3::new(0.0, -0.41, 0.02),
        );
        let ankle = b.joint(
            format!("{side} ankle"),
            Some(knee),
            Vec3::new(0.0, -0.39, -0.02),
        );
        let toe = b.joint(
            format!("{side} toe"),
            Some(ankle),
            Vec3::new(0.0, -0.05, 0.13),
        );
        b.end_site(format!("{side} toe end"), toe, Vec3::new(0.0, 0.0, 0.06));
    }
    let chest = b.joint("chest", Some(hips), Vec3::new(0.0, 0.25, 0.0));
    let head = b.joint("head", Some(chest), Vec3::new(0.0, 0.27, 0.0));
    b.end_site("head end", head, Vec3::new(0.0, 0.2, 0.0));
    for (side, x) in [("left", 1.0), ("right", -1.0)] {
        let shoulder = b.joint(
            format!("{side} shoulder"),
            Some(chest),
            Vec3::new(0.16 * x, 0.18, 0.0),
        );
        let elbow = b.joint(
            format!("{side} elbow"),
            Some(shoulder),
            Vec3::new(0.08 * x, -0.24, 0.0),
        );
        let wrist = b.joint(
            format!("{side} wrist"),
            Some(elbow),
            Vec3::new(0.03 * x, -0.23, 0.06),
        );
        b.end_site(
            format!("{side} hand end"),
            wrist,
            Vec3::new(0.0, -0.1, 0.02),
        );
    }
    b.build()
}
