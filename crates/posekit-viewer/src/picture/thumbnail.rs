//! The little preview pictures of clips and poses.

use std::sync::Arc;

use posekit::motion::Motion;
use posekit::pose::LocalPose;
use posekit::skeleton::Skeleton;
use posekit_render::cpu::CpuRenderer;
use posekit_render::image::Image;
use posekit_render::scene::Background;
use posekit_render::stage::{Actor, Follow, SkeletonStyle, Stage, StageOptions};
use posekit_render::theme::CharacterColors;

use crate::state::clip::{Clip, still};

/// Size of a preview picture, pixels: twice what it takes on a screen of ordinary density.
pub const THUMBNAIL_SIZE: (u32, u32) = (112, 112);

/// Draws the figure a third into the clip, where most motions have begun and not yet ended. The
/// background is transparent, so that it stands in light and dark windows alike.
#[must_use]
pub fn thumbnail(clip: &Clip) -> Image {
    let time_secs = clip.motion.duration_secs() / 3.0;
    figure(Arc::clone(&clip.motion), time_secs)
}

/// Draws a figure in a pose. `None` when the pose holds a number that is not finite.
///
/// # Panics
/// If the pose has not as many joints as the skeleton.
#[must_use]
pub fn pose_thumbnail(skeleton: &Arc<Skeleton>, pose: &LocalPose) -> Option<Image> {
    let is_finite = pose.rotations.iter().all(|rotation| rotation.is_finite())
        && pose.translations.iter().all(|place| place.is_finite());
    is_finite.then(|| figure(Arc::new(still(skeleton, pose)), 0.0))
}

fn figure(motion: Arc<Motion>, time_secs: f64) -> Image {
    let colors = CharacterColors::of(0);
    let actor = Actor::new(motion, SkeletonStyle::Body, colors);
    let options = StageOptions {
        background: Some(Background::Transparent),
        follow: Follow::Root,
        ..StageOptions::default()
    };
    let stage = Stage::new(vec![actor], options);
    let (width, height) = THUMBNAIL_SIZE;
    let mut scene = stage.scene(time_secs, width as f32 / height as f32);
    scene.captions.clear();
    scene.ground = None;
    CpuRenderer::new(std::num::NonZeroUsize::MIN).render(&scene, width, height)
}
