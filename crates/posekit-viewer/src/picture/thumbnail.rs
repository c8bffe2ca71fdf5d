//! The little preview picture of a clip.

use std::sync::Arc;

use posekit_render::cpu::CpuRenderer;
use posekit_render::image::Image;
use posekit_render::scene::Background;
use posekit_render::stage::{Actor, Follow, SkeletonStyle, Stage, StageOptions};
use posekit_render::theme::CharacterColors;

use crate::state::clip::Clip;

/// Size of a preview picture, pixels: twice what it takes on a screen of ordinary density.
pub const THUMBNAIL_SIZE: (u32, u32) = (112, 112);

/// Draws the figure a third into the clip, where most motions have begun and not yet ended. The
/// background is transparent, so that it stands in light and dark windows alike.
#[must_use]
pub fn thumbnail(clip: &Clip) -> Image {
    let colors = CharacterColors::of(0);
    let actor = Actor::new(Arc::clone(&clip.motion), SkeletonStyle::Body, colors);
    let options = StageOptions {
        background: Some(Background::Transparent),
        follow: Follow::Root,
        ..StageOptions::default()
    };
    let stage = Stage::new(vec![actor], options);
    let (width, height) = THUMBNAIL_SIZE;
    let time = clip.motion.duration_secs() / 3.0;
    let mut scene = stage.scene(time, width as f32 / height as f32);
    scene.captions.clear();
    scene.ground = None;
    CpuRenderer::new(std::num::NonZeroUsize::MIN).render(&scene, width, height)
}
