//! Lights and objects of scenes: light by hand-computed numbers, shadows by geometry, and both back
//! ends alike.

use std::num::NonZeroUsize;

use glam::{DQuat, DVec3, Vec3};

use posekit::keyframe::{
    Extrapolation, Interpolation, KeyedCamera, KeyedLight, KeyedTransform, Keyframe, Property,
    Track,
};
use posekit_render::camera::{Camera, Projection};
use posekit_render::color::{Color, linear_from_srgb};
use posekit_render::cpu::{self, CpuRenderer};
use posekit_render::image::Image;
use posekit_render::scene::{Lamp, MOST_LAMPS, Scene};
use posekit_render::stage::{
    AMBIENT, LIGHT_FULL_AT, Prop, PropShape, Stage, StageOptions, Surroundings, keyed_camera,
};

use crate::figures::{stage_of, waving};

/// A light that does not move.
fn light(position: DVec3, color: DVec3, strength: f64) -> KeyedLight {
    KeyedLight {
        position: Property::Fixed(position),
        color: Property::Fixed(color),
        strength: Property::Fixed(strength),
    }
}

fn prop(shape: &PropShape, translation: DVec3, scale: DVec3) -> Prop {
    let transform = KeyedTransform {
        translation: Property::Fixed(translation),
        rotation: Property::Fixed(DQuat::IDENTITY),
        scale: Property::Fixed(scale),
    };
    Prop::new(shape, transform)
}

fn stage_with(surroundings: Surroundings) -> Stage {
    let mut stage = stage_of(waving(1.0), StageOptions::default());
    stage.set_surroundings(surroundings);
    stage
}

/// Straight down on the origin.
fn from_above() -> Camera {
    Camera {
        eye: Vec3::Y * 12.0,
        target: Vec3::ZERO,
        up: Vec3::NEG_Z,
        projection: Projection::Orthographic { height: 4.0 },
        near: 0.1,
        far: 100.0,
    }
}

fn linear(image: &Image, x: u32, y: u32) -> [f32; 3] {
    let [r, g, b, _] = image.pixel(x, y).unwrap();
    [r, g, b].map(|byte| linear_from_srgb(f32::from(byte) / 255.0))
}

/// Nothing but one board, face up at height 1, and the light that falls on it: all of the room is dark.
fn board_under(lamps: Vec<Lamp>) -> Scene {
    let board = prop(&PropShape::Box, DVec3::Y * 0.95, DVec3::new(4.0, 0.1, 4.0));
    let mut scene = stage_with(Surroundings {
        props: vec![board],
        ..Surroundings::default()
    })
    .scene_from(0.0, from_above());
    let board = scene.models.pop().unwrap();
    scene.models = vec![board];
    let black = Color::default();
    scene.lighting.key = black;
    scene.lighting.fill = black;
    scene.lighting.sky = black;
    scene.lighting.bounce = black;
    scene.ground = None;
    scene.captions.clear();
    scene.lamps = lamps;
    scene
}

#[test]
fn a_flat_board_is_lit_by_lamberts_law_and_the_square_of_the_distance() {
    // Far to the side, so that the eye above sees no highlight.
    let lamp = Lamp {
        position: Vec3::new(3.0, 3.0, 0.0),
        color: Color {
            r: 0.6,
            g: 0.3,
            b: 0.9,
        },
        full_at: 2.0,
    };
    let scene = board_under(vec![lamp]);
    let albedo = scene.models[0].palette[0];
    let size = 200;
    let image = cpu::render(&scene, size, size);
    for (x, y) in [(20, 100), (60, 40), (100, 100), (100, 180)] {
        // Pixels of 0.02 on a board at height 1.
        let at = |pixel: u32| (pixel as f32 + 0.5) * 0.02 - 2.0;
        let way = lamp.position - Vec3::new(at(x), 1.0, at(y));
        let distance = way.length();
        let light = way.y / distance * (2.0 / distance) * (2.0 / distance);
        let wanted = [
            albedo.r * lamp.color.r * light,
            albedo.g * lamp.color.g * light,
            albedo.b * lamp.color.b * light,
        ];
        for (seen, wanted) in linear(&image, x, y).into_iter().zip(wanted) {
            // Two steps of a byte.
            assert!((seen - wanted).abs() < 0.012, "{x} {y}: {seen} {wanted}");
        }
    }
}

#[test]
fn lights_add_up() {
    let lamp = |x: f32| Lamp {
        position: Vec3::new(x, 3.0, 1.0),
        color: Color {
            r: 0.3,
            g: 0.3,
            b: 0.3,
        },
        full_at: 2.0,
    };
    let picture = |lamps: &[Lamp]| cpu::render(&board_under(lamps.to_vec()), 100, 100);
    let (left, right) = (lamp(-3.0), lamp(3.0));
    let [one, other, both] = [&[left][..], &[right], &[left, right]].map(picture);
    for (x, y) in [(10, 10), (50, 50), (90, 20)] {
        let sum = linear(&one, x, y)[0] + linear(&other, x, y)[0];
        let seen = linear(&both, x, y)[0];
        assert!((seen - sum).abs() < 0.015, "{x} {y}: {seen} {sum}");
    }
}

/// The shadow of a ball lies where the lines from the light through the ball meet the ground, and is
/// as much larger as it is farther from the light.
#[test]
fn a_shadow_lies_and_grows_as_rays_from_the_light_say() {
    let mut scene = stage_with(Surroundings {
        studio_light: false,
        lights: vec![light(DVec3::new(1.0, 3.0, 0.0), DVec3::ONE, 1.0)],
        props: vec![prop(&PropShape::Sphere, DVec3::Y, DVec3::splat(0.5))],
        ..Surroundings::default()
    })
    .scene_from(0.0, from_above());
    let ball = scene.models.pop().unwrap();
    scene.models = vec![ball];
    scene.captions.clear();
    let ground = scene.ground.as_mut().unwrap();
    ground.height = 0.0;
    let plain = ground.color;
    ground.line_color = plain;
    ground.axis_colors = [plain; 2];
    let size = 400;
    let with = cpu::render(&scene, size, size);
    scene.models.clear();
    let without = cpu::render(&scene, size, size);
    let share = |x: f32, z: f32| {
        let pixel = |v: f32| {
            #[expect(clippy::cast_possible_truncation, reason = "a pixel of the picture")]
            let pixel = ((v + 2.0) * 100.0) as u32;
            pixel
        };
        let (x, y) = (pixel(x), pixel(z));
        linear(&with, x, y)[1] / linear(&without, x, y)[1]
    };
    // From (1, 3) through (0, 1) to the ground: (-0.5, 0). Between light and ball 5^0.5, to the ground
    // half as much again: 0.25 becomes 0.375 across, less the soft edge.
    for z in [0.0, 0.31, -0.31] {
        assert!(share(-0.5, z) < 0.6, "{z}: {}", share(-0.5, z));
    }
    for (x, z) in [(-0.5, 0.46), (-0.5, -0.46), (0.15, 0.0), (-1.15, 0.0)] {
        assert!(share(x, z) > 0.98, "{x} {z}: {}", share(x, z));
    }
}

/// An ellipsoid made by scaling a ball is shaded as one whose normals were worked out for it.
#[test]
fn a_stretched_ball_is_shaded_as_an_ellipsoid() {
    let scale = DVec3::new(0.3, 1.2, 0.6);
    let mut ellipsoid = posekit_render::mesh::Shape::ball(Vec3::ZERO, 0.5, 48);
    for (position, normal) in ellipsoid.positions.iter_mut().zip(&mut ellipsoid.normals) {
        let scale = scale.as_vec3();
        *normal = (*position / (scale * scale) * scale).normalize();
        *position *= scale;
    }
    let picture = |shape: &PropShape, scale: DVec3| {
        let mut scene = stage_with(Surroundings {
            studio_light: false,
            lights: vec![light(DVec3::new(2.0, 3.0, 2.0), DVec3::ONE, 1.0)],
            props: vec![prop(shape, DVec3::new(0.6, 0.7, 0.6), scale)],
            ..Surroundings::default()
        })
        .scene(0.0, 1.0);
        scene.labels.clear();
        cpu::render(&scene, 200, 200)
    };
    let stretched = picture(&PropShape::Sphere, scale);
    let made = picture(&PropShape::Mesh(ellipsoid), DVec3::ONE);
    let pairs = stretched.as_rgba().iter().zip(made.as_rgba());
    let far = pairs.filter(|(a, b)| a.abs_diff(**b) > 3).count();
    assert!(far < 40, "{far}");
}

/// Two coloured lights, a box and a ball that move, and a figure.
fn full(time_secs: f64) -> Scene {
    let key = |time: f64, value: DVec3| Keyframe::new(time, value, Interpolation::Linear);
    let ends = vec![
        key(0.0, DVec3::new(1.2, 0.25, 0.2)),
        key(1.0, DVec3::new(0.9, 0.25, 0.8)),
    ];
    let moving = Track::new(ends, Extrapolation::Hold).unwrap();
    let crate_box = Prop::new(
        &PropShape::Box,
        KeyedTransform {
            translation: Property::Keyed(moving),
            rotation: Property::Fixed(DQuat::from_rotation_y(0.5)),
            scale: Property::Fixed(DVec3::new(0.4, 0.5, 0.8)),
        },
    );
    let ball = prop(
        &PropShape::Sphere,
        DVec3::new(-0.9, 0.3, 0.5),
        DVec3::splat(0.6),
    );
    let warm = light(DVec3::new(2.0, 3.0, 3.0), DVec3::new(1.0, 0.7, 0.4), 1.0);
    let cold = light(DVec3::new(-3.0, 2.0, 1.0), DVec3::new(0.2, 0.4, 1.0), 0.8);
    stage_with(Surroundings {
        studio_light: false,
        lights: vec![warm, cold],
        props: vec![crate_box, ball],
        start_secs: 0.0,
    })
    .scene(time_secs, 1.5)
}

#[test]
fn any_number_of_threads_draws_lights_and_objects_to_the_same_bytes() {
    let scene = full(0.4);
    let draw = |threads: usize| {
        let threads = NonZeroUsize::new(threads).unwrap();
        CpuRenderer::new(threads).render(&scene, 301, 199)
    };
    let one = draw(1);
    assert!(one == draw(3));
    if let Ok(path) = std::env::var("POSEKIT_WRITE_LIT") {
        let image = cpu::render(&scene, 960, 640);
        posekit_render::output::write_png(&image, std::fs::File::create(path).unwrap()).unwrap();
    }
    assert!(one != CpuRenderer::new(NonZeroUsize::MIN).render(&full(0.9), 301, 199));
}

#[cfg(feature = "gpu")]
#[test]
fn both_back_ends_draw_lights_and_objects_alike() {
    let mut near = full(0.4);
    // A light between its casters, which no lens sees all of.
    near.lamps[0].position = Vec3::new(0.2, 0.6, 0.5);
    let mut many = full(0.4);
    many.lamps = (0..MOST_LAMPS + 4)
        .map(|i| Lamp {
            position: Vec3::new(i as f32 * 0.4 - 4.0, 2.0, 1.5),
            color: Color {
                r: 0.1,
                g: 0.02 * i as f32,
                b: 0.1,
            },
            full_at: 4.0,
        })
        .collect();
    for (name, scene) in [
        ("two", full(0.4)),
        ("near", near),
        ("many", many),
        ("studio", strong(2, 3.0, true)),
        ("strong", strong(8, 6.0, false)),
        ("dim", strong(0, 1.0, false)),
    ] {
        let Some((mean, far)) = crate::gpu_pictures::difference_of_back_ends(&scene, 600, 400)
        else {
            return;
        };
        println!("{name}: mean {mean:.3}, far {:.4}%", far * 100.0);
        assert!(mean < 1.0 && far < 0.01, "{name}: mean {mean}, far {far}");
    }
}

/// The measure of strength: three times the figure's height away a light of strength 1 is full.
#[test]
fn strength_goes_by_the_figures_height_whatever_the_unit() {
    let lamp = |unit: f32| {
        let mut stage = stage_of(waving(unit), StageOptions::default());
        stage.set_surroundings(Surroundings {
            studio_light: false,
            lights: vec![light(DVec3::ONE, DVec3::new(0.5, 1.0, 0.0), 2.0)],
            ..Surroundings::default()
        });
        let scene = stage.scene(0.0, 1.0);
        let ambient = scene.lighting.ground_ambient * scene.lighting.exposure;
        assert!((ambient - AMBIENT).abs() < 1e-6);
        (scene.lamps[0], stage.stature())
    };
    for unit in [1.0, 0.01] {
        let (lamp, stature) = lamp(unit);
        assert!((lamp.full_at - LIGHT_FULL_AT * stature).abs() < 1e-4 * stature);
        assert_eq!(lamp.color.to_array(), [1.0, 2.0, 0.0]);
    }
}

#[test]
fn a_stage_without_lights_keeps_the_rooms_own() {
    let plain = stage_of(waving(1.0), StageOptions::default()).scene(0.3, 1.0);
    let with_box = stage_with(Surroundings {
        props: vec![prop(&PropShape::Box, DVec3::X, DVec3::splat(0.3))],
        ..Surroundings::default()
    })
    .scene(0.3, 1.0);
    assert_eq!(plain.lighting, with_box.lighting);
    assert_eq!(plain.background, with_box.background);
    assert!(with_box.lamps.is_empty());
    assert_eq!(with_box.models.len(), plain.models.len() + 1);
}

/// Keys can overshoot, and files can say anything: no strength below nothing, no size of nothing.
#[test]
fn odd_lights_and_objects_are_drawn_without_trouble() {
    let odd = |scale: DVec3| prop(&PropShape::Box, DVec3::new(0.0, 0.2, 1.0), scale);
    let scene = stage_with(Surroundings {
        studio_light: false,
        lights: vec![
            light(DVec3::new(0.0, 0.2, 1.0), DVec3::ONE, -1.0),
            light(DVec3::splat(f64::NAN), DVec3::splat(-4.0), 1.0),
        ],
        props: vec![
            odd(DVec3::ZERO),
            odd(DVec3::new(1.0, 0.0, 1.0)),
            odd(DVec3::new(-0.5, 0.5, 0.5)),
            odd(DVec3::splat(f64::NAN)),
        ],
        start_secs: 0.0,
    })
    .scene(0.0, 1.0);
    assert_eq!(scene.lamps[0].color, Color::default());
    assert_eq!(scene.lamps[1].color, Color::default());
    // The figure, the flat box and the mirrored one.
    assert_eq!(scene.models.len(), 3);
    let image = cpu::render(&scene, 64, 64);
    assert_eq!(image.pixel(0, 0).map(|p| p[3]), Some(255));
}

#[test]
fn a_camera_that_looks_down_or_nowhere_still_has_a_picture() {
    let camera = |eye: DVec3, target: DVec3, fov: f64| {
        let view = KeyedCamera {
            position: Property::Fixed(eye),
            target: Property::Fixed(target),
            vertical_fov_deg: Property::Fixed(fov),
        };
        keyed_camera(&view, 0.0, 1.7)
    };
    for (eye, target, fov) in [
        (DVec3::Y * 5.0, DVec3::ZERO, 40.0),
        (DVec3::ONE, DVec3::ONE, 40.0),
        (DVec3::Z, DVec3::ZERO, -10.0),
        (DVec3::Z, DVec3::ZERO, 500.0),
    ] {
        let matrix = camera(eye, target, fov).clip_from_world(1.5);
        assert!(matrix.is_finite() && matrix.determinant().abs() > 0.0);
    }
}

/// A number of strong white lights around the figure.
fn strong(count: u8, strength: f64, studio_light: bool) -> Scene {
    let lights = (0..count).map(|i| {
        let (sin, cos) = (f64::from(i) * 2.4 + 0.5).sin_cos();
        light(DVec3::new(3.0 * sin, 2.5, 3.0 * cos), DVec3::ONE, strength)
    });
    let stage = stage_with(Surroundings {
        studio_light,
        lights: lights.collect(),
        ..Surroundings::default()
    });
    let mut scene = stage.scene(0.4, 1.0);
    scene.captions.clear();
    scene
}

/// The share of pixels that are white, and the mean of all, encoded, 0 to 1.
fn white_and_mean(image: &Image) -> (f32, f32) {
    let pixels = image.as_rgba().chunks_exact(4);
    let count = pixels.len() as f32;
    let (mut white, mut sum) = (0.0, 0.0);
    for pixel in pixels {
        let least = pixel[..3].iter().copied().min().unwrap_or(0);
        white += f32::from(u8::from(least == 255));
        sum += f32::from(least) / 255.0;
    }
    (white / count, sum / count)
}

/// However many strong lights there are, the picture keeps its shades: it neither burns out nor goes to fog,
/// nor into the dark.
#[test]
fn many_strong_lights_burn_nothing_out() {
    for studio_light in [true, false] {
        for count in [1, 2, 3, 8] {
            let image = cpu::render(&strong(count, 6.0, studio_light), 200, 200);
            let (white, mean) = white_and_mean(&image);
            println!("{studio_light} {count}: white {white:.4}, mean {mean:.3}");
            assert!(white < 0.01, "{count}: {white}");
            assert!((0.3..0.85).contains(&mean), "{count}: {mean}");
            // The figure has light and dark still.
            let levels: Vec<u8> = image.as_rgba().chunks_exact(4).map(|p| p[1]).collect();
            let (least, most) = (levels.iter().min(), levels.iter().max());
            let span = most.copied().unwrap_or(0) - least.copied().unwrap_or(0);
            assert!(span > 100, "{count}: {span}");
        }
    }
}

/// A light that is off, in the studio light, changes next to nothing; the studio light keeps its shadow.
#[test]
fn the_first_light_keeps_the_studio_light() {
    let plain = cpu::render(&strong(0, 1.0, true), 200, 200);
    let off = cpu::render(&strong(1, 0.0, true), 200, 200);
    let pairs = plain.as_rgba().iter().zip(off.as_rgba());
    let most = pairs.map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most.is_some_and(|most| most <= 12), "{most:?}");
    let weak = cpu::render(&strong(1, 0.3, true), 200, 200);
    assert!(white_and_mean(&weak).1 > white_and_mean(&off).1);
}

/// Without studio light and lights there is what is left of sky and walls, and no shadow.
#[test]
fn a_room_without_any_light_is_dim_and_has_no_shadow() {
    let dim = strong(0, 1.0, false);
    assert!(dim.is_lit() && dim.casting_lamp().is_none());
    let mean = white_and_mean(&cpu::render(&dim, 200, 200)).1;
    let lit = white_and_mean(&cpu::render(&strong(0, 1.0, true), 200, 200)).1;
    assert!(mean < 0.75 * lit && mean > 0.2 * lit, "{mean} {lit}");
}

/// What lights there are without the studio light casts its shadow as before.
#[test]
fn the_first_light_casts_the_shadow_where_the_studio_light_is_off() {
    assert!(strong(2, 1.0, false).casting_lamp().is_some());
    assert!(strong(2, 1.0, true).casting_lamp().is_none());
}
