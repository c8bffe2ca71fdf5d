//! Whatever motion is reduced to keys, the file of the keys is read again, and holds what was written.

use std::sync::Arc;

use glam::{Quat, Vec3};
use posekit::keyframe::{Interpolation, KeyedFrames, ReduceConfig, reduce};
use posekit::motion::{FrameTime, Motion};
use posekit::range::{LONGEST_LENGTH, LONGEST_SECS, SHORTEST_SECS};
use posekit::rotation::EulerOrder;
use posekit::skeleton::{JointId, SkeletonBuilder};
use posekit_formats::scene::{
    self, EulerNotation, JointTrack, JointValues, Scene, SkeletonSource, check,
};
use proptest::collection::vec;
use proptest::prelude::*;

/// Numbers of all sizes, the ends of what `f32` and posekit hold among them.
fn coordinate() -> impl Strategy<Value = f32> {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the nearest f32 is what is meant"
    )]
    let longest = LONGEST_LENGTH as f32;
    prop_oneof![
        4 => -100.0_f32..100.0,
        2 => any::<f32>(),
        2 => -longest..longest,
        1 => prop::sample::select(vec![
            0.0, -0.0, f32::MIN_POSITIVE, 1e-45, f32::MAX, f32::MIN, 3e38, -3e38, 1e20, longest,
            -longest, longest.next_up(), f32::INFINITY, f32::NAN,
        ]),
    ]
}

/// The same, all of which a motion may hold.
fn length() -> impl Strategy<Value = f32> {
    coordinate().prop_filter("a length", |c| f64::from(c.abs()) <= LONGEST_LENGTH)
}

fn frame_time() -> impl Strategy<Value = FrameTime> {
    prop_oneof![
        3 => Just(1.0 / 30.0),
        2 => (-8.9_f64..8.9).prop_map(|power| 10_f64.powf(power)),
        1 => prop::sample::select(vec![SHORTEST_SECS, LONGEST_SECS, 1e-4]),
    ]
    .prop_map(|secs| FrameTime::new(secs).unwrap())
}

fn vec3() -> impl Strategy<Value = Vec3> {
    [length(), length(), length()].prop_map(Vec3::from_array)
}

proptest! {
    #[test]
    fn what_is_reduced_is_read_again(
        offsets in vec(vec3(), 3),
        places in vec([coordinate(), coordinate(), coordinate()], 1..20),
        turns in vec([-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0], 20),
        frame_time in frame_time(),
        linear in prop::bool::ANY,
        euler in prop::bool::ANY,
    ) {
        let mut builder = SkeletonBuilder::new();
        let root = builder.joint("root", None, offsets[0]);
        let middle = builder.joint("middle", Some(root), offsets[1]);
        builder.end_site("end", middle, offsets[2]);
        let skeleton = Arc::new(builder.build().unwrap());
        let mut motion = Motion::at_rest(Arc::clone(&skeleton), places.len(), frame_time, [root]);
        for (frame, (place, turn)) in places.iter().zip(&turns).enumerate() {
            motion.set_translation(frame, root, Vec3::from_array(*place));
            let turn = Quat::from_array(*turn);
            if turn.length() > 0.1 {
                motion.set_rotation(frame, middle, turn.normalize());
            }
        }
        let interpolation = if linear { Interpolation::Linear } else { Interpolation::Cubic };
        let config = ReduceConfig { interpolation, ..ReduceConfig::default() };
        let mut scene = Scene::new(SkeletonSource::inline(&skeleton));
        scene.range_secs = [0.0, motion.duration_secs()];
        scene.frames_per_sec = frame_time.frames_per_sec().unwrap();
        let Ok(keys) = KeyedFrames::of(&motion, &config) else {
            // Only what is beyond the range is refused.
            prop_assert!(motion.first_out_of_range().is_some() || motion.duration_secs() > LONGEST_SECS);
            return Ok(());
        };
        prop_assert!(motion.first_out_of_range().is_none());
        prop_assert!(keys.error().distance_heights.is_finite() && keys.error().angle_deg.is_finite());
        let notation = euler.then(|| EulerNotation { order: EulerOrder::ZXY, angles_deg: Vec::new() });
        let tracks = skeleton.joints().flat_map(|joint| {
            let translation = keys.translation(joint).map(|track| JointValues::Translation(track.unwrap().into()));
            let rotation = keys.rotation(joint).map(|track| JointValues::Rotation {
                track: track.unwrap().into(),
                euler: notation.clone(),
            });
            let name = skeleton.unique_name(joint).to_owned();
            let both = translation.into_iter().chain(rotation);
            both.map(move |values| Ok(JointTrack { joint: name.clone(), values }))
        });
        let mut bytes = Vec::new();
        let written = scene::write_with_tracks(&scene, tracks, &mut bytes);
        prop_assert_eq!(written.is_ok(), check(&scene).is_ok());
        if written.is_err() {
            prop_assert!(bytes.is_empty(), "nothing is written of what is not read");
            return Ok(());
        }
        let again = scene::read(&bytes).unwrap();
        // All at once it is the same file, and what is read is what was written.
        scene.set_animation(&reduce(&motion, &config).unwrap().animation, euler.then_some(EulerOrder::ZXY));
        prop_assert_eq!(String::from_utf8(scene::write(&scene).unwrap()), String::from_utf8(bytes));
        if !euler {
            prop_assert_eq!(&again.tracks, &scene.tracks);
        }
        prop_assert_eq!(again.tracks.len(), scene.tracks.len());
    }
}

/// Values at the very ends of what `f32` holds: refused by the frame, where they gave files with `inf` in them.
#[test]
fn values_at_the_ends_of_single_precision_are_refused() {
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("root", None, Vec3::ZERO);
    builder.end_site("end", root, Vec3::Y);
    let skeleton = Arc::new(builder.build().unwrap());
    let mut motion = Motion::at_rest(skeleton, 3, FrameTime::of_fps(30), [JointId::new(0)]);
    motion.set_translation(1, root, Vec3::X * f32::MAX);
    let error = KeyedFrames::of(&motion, &ReduceConfig::default()).unwrap_err();
    assert!(error.to_string().contains("at frame 1"), "{error}");
}
