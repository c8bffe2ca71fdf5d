//! The CPU back end: the same bytes everywhere, and what is on them.

use std::num::NonZeroUsize;

use glam::Vec3;

use posekit_render::camera::{Camera, Projection};
use posekit_render::cpu::CpuRenderer;
use posekit_render::image::Image;
use posekit_render::output::write_png;
use posekit_render::scene::{Background, Scene};
use posekit_render::stage::{AxesShown, Ghosts, Labels, StageOptions, Trails};

use crate::figures::{STYLES, stage_of, waving};

fn draw(scene: &Scene, width: u32, height: u32, threads: usize) -> Image {
    CpuRenderer::new(NonZeroUsize::new(threads).unwrap()).render(scene, width, height)
}

/// A scene with everything in it.
fn full_scene() -> Scene {
    let motion = waving(1.0);
    let hand = motion.skeleton().find("leftWrist").unwrap();
    let options = StageOptions {
        axes: AxesShown::Joints,
        trails: Some(Trails {
            joints: vec![hand],
            seconds: 0.5,
        }),
        ghosts: Some(Ghosts {
            every_frames: 5,
            before: 2,
            after: 1,
        }),
        labels: Labels::All,
        ..StageOptions::default()
    };
    stage_of(motion, options).scene(0.4, 1.5)
}

/// FNV-1a.
fn hash(image: &Image) -> u64 {
    image.as_rgba().iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| {
        (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[test]
fn any_number_of_threads_draws_the_same_bytes() {
    let scene = full_scene();
    let one = draw(&scene, 301, 199, 1);
    for threads in [2, 5] {
        assert!(one == draw(&scene, 301, 199, threads), "{threads} threads");
    }
}

#[test]
fn a_renderer_that_was_used_before_draws_the_same_bytes() {
    let scene = full_scene();
    let fresh = draw(&scene, 160, 120, 2);
    let mut used = CpuRenderer::new(NonZeroUsize::MIN);
    let mut image = Image::default();
    used.render_into(
        &stage_of(waving(0.01), StageOptions::default()).scene(0.0, 1.0),
        97,
        300,
        &mut image,
    );
    used.render_into(&scene, 160, 120, &mut image);
    assert!(fresh == image);
}

/// A picture of the past, to notice changes and platforms that compute differently. After a wanted
/// change of looks, look at the picture (`POSEKIT_WRITE_GOLDEN=FILE`) and put its hash here.
#[test]
fn the_golden_picture_has_not_changed() {
    const GOLDEN: u64 = 0x506c_6105_8218_eb5a;
    let image = draw(&full_scene(), 480, 320, 2);
    if let Ok(path) = std::env::var("POSEKIT_WRITE_GOLDEN") {
        write_png(&image, std::fs::File::create(path).unwrap()).unwrap();
    }
    assert_eq!(hash(&image), GOLDEN, "{:#x}", hash(&image));
}

#[test]
fn every_style_shows_the_figure() {
    for style in STYLES {
        let options = StageOptions {
            style,
            ..StageOptions::default()
        };
        let stage = stage_of(waving(1.0), options);
        let with = draw(&stage.scene(0.0, 1.0), 200, 200, 1);
        let mut empty = stage.scene(0.0, 1.0);
        empty.models.clear();
        empty.polylines.clear();
        let without = draw(&empty, 200, 200, 1);
        let differing = with
            .as_rgba()
            .chunks_exact(4)
            .zip(without.as_rgba().chunks_exact(4))
            .filter(|(a, b)| a != b)
            .count();
        // A figure and its shadow: not a speck, and not the whole picture.
        assert!((400..20_000).contains(&differing), "{style:?} {differing}");
    }
}

#[test]
fn a_transparent_picture_has_a_solid_figure_a_faint_shadow_and_nothing_else() {
    let options = StageOptions {
        background: Some(Background::Transparent),
        ..StageOptions::default()
    };
    let image = draw(&stage_of(waving(1.0), options).scene(0.0, 1.0), 240, 240, 1);
    let alphas: Vec<u8> = image.as_rgba().chunks_exact(4).map(|p| p[3]).collect();
    let solid = alphas.iter().filter(|&&a| a == 255).count();
    let faint = alphas.iter().filter(|&&a| a > 0 && a < 160).count();
    let empty = alphas.iter().filter(|&&a| a == 0).count();
    assert!(
        solid > 1000 && faint > 500 && empty > 20_000,
        "{solid} {faint} {empty}"
    );
    assert_eq!(image.pixel(0, 0), Some([0, 0, 0, 0]));
}

/// With the eye inside the figure, triangles reach behind it: they are cut, not smeared.
#[test]
fn a_camera_inside_the_figure_draws_without_trouble() {
    let mut scene = full_scene();
    for step in 0..12 {
        let angle = step as f32 * 0.5;
        let eye = Vec3::new(0.02, 1.1, 0.01);
        scene.camera = Camera {
            eye,
            target: eye + Vec3::new(libm::sinf(angle), -0.2, libm::cosf(angle)),
            up: Vec3::Y,
            projection: Projection::Perspective {
                vertical_fov_rad: 1.2,
            },
            near: 0.01,
            far: 100.0,
        };
        let image = draw(&scene, 120, 90, 1);
        assert_eq!(image.as_rgba().len(), 120 * 90 * 4);
    }
}

/// Halves of a quad meet on a diagonal: no background may shine through, at any slope.
#[test]
fn shared_edges_leave_no_cracks() {
    let scene = full_scene();
    let mut close = scene.clone();
    // Close to the chest, which fills the picture with small triangles.
    close.camera = Camera {
        eye: Vec3::new(0.0, 1.15, 0.6),
        target: Vec3::new(0.0, 1.12, 0.0),
        up: Vec3::Y,
        projection: Projection::Perspective {
            vertical_fov_rad: 0.12,
        },
        near: 0.01,
        far: 100.0,
    };
    close.background = Background::Transparent;
    close.ground = None;
    close.labels.clear();
    close.captions.clear();
    let image = draw(&close, 400, 400, 1);
    let holes = image
        .as_rgba()
        .chunks_exact(4)
        .filter(|p| p[3] != 255)
        .count();
    assert_eq!(holes, 0);
}

#[test]
fn odd_sizes_and_empty_ones_are_drawn() {
    let scene = full_scene();
    for (width, height) in [(1, 1), (33, 1), (1, 65), (31, 33), (0, 10), (10, 0)] {
        let image = draw(&scene, width, height, 3);
        assert_eq!((image.width(), image.height()), (width, height));
    }
}
