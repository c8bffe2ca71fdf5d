//! Scale, framing, following.

use glam::Vec3;

use posekit::motion::{FrameTime, Motion};
use posekit::skeleton::JointId;
use posekit_render::camera::View;
use posekit_render::cpu;
use posekit_render::stage::{
    Actor, Arrangement, CameraChoice, Follow, GhostSide, Ghosts, KeyGhost, SkeletonStyle, Stage,
    StageOptions,
};
use posekit_render::theme::CharacterColors;

use crate::figures::{person, stage_of, waving};

/// Metres, centimetres and inches make the same picture but for the grid's spacing and its caption.
#[test]
fn units_do_not_change_the_picture() {
    let picture = |unit: f32| {
        let mut scene = stage_of(waving(unit), StageOptions::default()).scene(0.3, 1.5);
        scene.captions.clear();
        // The grid is round in each unit and so differs.
        if let Some(ground) = &mut scene.ground {
            ground.grid_spacing = 0.5 / unit;
            ground.major_every = 4;
        }
        cpu::render(&scene, 300, 200)
    };
    let metres = picture(1.0);
    for unit in [0.01, 0.0254, 1000.0] {
        let other = picture(unit);
        let pixels = metres.as_rgba().iter().zip(other.as_rgba());
        let far = pixels.filter(|(a, b)| a.abs_diff(**b) > 12).count();
        // Rounding moves an edge here and there.
        assert!(far < 300, "{unit}: {far}");
    }
}

/// Every joint of the whole motion is in the picture, and not much smaller than it could be.
#[test]
fn the_whole_motion_is_framed() {
    for view in [
        View::Front,
        View::Back,
        View::Left,
        View::Right,
        View::Top,
        View::ThreeQuarter,
    ] {
        for (width, height) in [(1280u32, 720u32), (400, 800)] {
            let options = StageOptions {
                camera: CameraChoice::View(view),
                follow: Follow::Never,
                ..StageOptions::default()
            };
            let stage = stage_of(waving(1.0), options);
            let camera = stage.camera(0.0, width as f32 / height as f32);
            let mut largest = 0.0f32;
            for time in [0.0, 0.25, 0.5, 0.75] {
                for &p in &stage.actors()[0].pose(time).positions {
                    let at = camera.project(p, (width, height)).unwrap();
                    let x = (at.x / width as f32 * 2.0 - 1.0).abs();
                    let y = (at.y / height as f32 * 2.0 - 1.0).abs();
                    largest = largest.max(x.max(y));
                }
            }
            assert!((0.6..0.93).contains(&largest), "{view:?} {width} {largest}");
        }
    }
}

/// A person gliding along Z for twenty metres.
fn gliding() -> std::sync::Arc<Motion> {
    let skeleton = std::sync::Arc::new(person(1.0));
    let mut motion = Motion::at_rest(skeleton, 200, FrameTime::of_fps(20), [JointId::new(0)]);
    for frame in 0..200 {
        let p = Vec3::new(0.0, 0.95, frame as f32 * 0.1);
        motion.set_translation(frame, JointId::new(0), p);
    }
    std::sync::Arc::new(motion)
}

#[test]
fn the_camera_follows_somebody_who_goes_far() {
    let stage = stage_of(gliding(), StageOptions::default());
    let place = |time: f64| {
        let camera = stage.camera(time, 1.5);
        let root = stage.actors()[0].pose(time).positions[0];
        camera.project(root, (1500, 1000)).unwrap()
    };
    let (early, late) = (place(2.0), place(8.0));
    assert!((early - late).truncate().length() < 3.0, "{early} {late}");
    let fixed = StageOptions {
        follow: Follow::Never,
        ..StageOptions::default()
    };
    let stage = stage_of(gliding(), fixed);
    assert_eq!(stage.camera(2.0, 1.5), stage.camera(8.0, 1.5));
}

#[test]
fn side_by_side_keeps_everybody_apart_on_one_floor() {
    let actors = (0..3)
        .map(|i| Actor::new(waving(1.0), SkeletonStyle::Body, CharacterColors::of(i)))
        .collect();
    let options = StageOptions {
        arrangement: Arrangement::SideBySide,
        ..StageOptions::default()
    };
    let scene = Stage::new(actors, options).scene(0.0, 2.0);
    let roots: Vec<Vec3> = scene
        .models
        .iter()
        .map(|m| m.joints[0].translation)
        .collect();
    assert_eq!(roots.len(), 3);
    for pair in roots.windows(2) {
        // Further apart than two outstretched arms.
        assert!((pair[1] - pair[0]).length() > 1.5, "{roots:?}");
        assert!((pair[1].y - pair[0].y).abs() < 1e-5);
    }
}

#[test]
fn the_feet_stand_on_the_floor() {
    let stage = stage_of(waving(1.0), StageOptions::default());
    let actor = &stage.actors()[0];
    let pose = actor.pose(0.0);
    let lowest = actor
        .mesh()
        .vertices
        .iter()
        .map(|v| {
            pose.transform_point(JointId::new(v.joint as usize), v.position)
                .y
        })
        .fold(f32::INFINITY, f32::min);
    assert!(
        (lowest - stage.ground_height()).abs() < 0.01,
        "{lowest} {}",
        stage.ground_height()
    );
}

/// Ghosts of keys stand at their times, on either side in a colour of its own.
#[test]
fn ghosts_of_keys_stand_at_their_times_in_two_colours() {
    let skeleton = std::sync::Arc::new(person(1.0));
    let root = JointId::new(0);
    let mut motion = Motion::at_rest(skeleton, 21, FrameTime::of_fps(10), [root]);
    for frame in 0..21 {
        motion.set_translation(frame, root, Vec3::new(0.0, 0.95, 0.1 * frame as f32));
    }
    let options = StageOptions {
        camera: CameraChoice::View(View::Left),
        ..StageOptions::default()
    };
    let mut stage = stage_of(std::sync::Arc::new(motion), options);
    let ghost = |time_secs: f64, side: GhostSide| KeyGhost {
        time_secs,
        side,
        distance: 0.0,
    };
    let ghosts = vec![ghost(0.3, GhostSide::Before), ghost(1.7, GhostSide::After)];
    stage.edit_actor(0, |actor| actor.set_key_ghosts(ghosts));
    let scene = stage.scene(1.0, 1.5);
    let (figure, ghosts) = scene.models.split_first().unwrap();
    assert_eq!(ghosts.len(), 2);
    let camera = scene.camera;
    for (ghost, time) in ghosts.iter().zip([0.3, 1.7]) {
        // Moved from the eye by a hair, which is not seen.
        let there = Vec3::new(0.0, 0.95, time);
        let [seen, expected] = [ghost.joints[0].translation, there]
            .map(|point| camera.project(point, (800, 600)).unwrap().truncate());
        assert!(seen.distance(expected) < 1.0, "{seen} {expected}");
        assert_ne!(ghost.palette, figure.palette);
    }
    assert_ne!(ghosts[0].palette, ghosts[1].palette);
}

#[test]
fn an_empty_stage_is_an_empty_room() {
    let stage = Stage::new(Vec::new(), StageOptions::default());
    let image = cpu::render(&stage.scene(0.0, 1.0), 64, 64);
    assert_eq!(image.pixel(3, 3).map(|p| p[3]), Some(255));
}

/// Ghosts that stand between the eye and the figure let it through; those behind it are denser.
#[test]
fn ghosts_before_the_figure_are_thin_veils() {
    let skeleton = std::sync::Arc::new(person(1.0));
    let root = JointId::new(0);
    let mut motion = Motion::at_rest(skeleton, 21, FrameTime::of_fps(10), [root]);
    for frame in 0..21 {
        motion.set_translation(frame, root, Vec3::new(0.0, 0.95, 0.1 * frame as f32));
    }
    let options = StageOptions {
        camera: CameraChoice::View(View::Front),
        ghosts: Some(Ghosts {
            every_frames: 5,
            before: 2,
            after: 2,
        }),
        ..StageOptions::default()
    };
    let scene = stage_of(std::sync::Arc::new(motion), options).scene(1.0, 1.5);
    let (figure, ghosts) = scene.models.split_first().unwrap();
    assert!(figure.opacity >= 1.0);
    assert_eq!(ghosts.len(), 4);
    for ghost in ghosts {
        let ahead = ghost.joints[0].translation.z - figure.joints[0].translation.z;
        let expected = if ahead > 0.0 { 0.25 } else { 0.5 };
        assert!((ghost.opacity - expected).abs() < 1e-6, "{ahead}");
    }
}
