//! The fast sampler against tracks sampled one by one.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::keyframe::{
    Animation, Extrapolation, Interpolation, Keyframe, PoseSampler, Tangents, Track,
};
use posekit::pose::LocalPose;
use posekit::rotation::{angle_between, exp};
use posekit::sample;
use posekit::skeleton::JointId;
use proptest::collection::vec;
use proptest::prelude::*;

#[track_caller]
fn assert_agrees(animation: &Animation, times: impl IntoIterator<Item = f64>) {
    let sampler = PoseSampler::new(animation);
    let mut pose = LocalPose::rest(animation.skeleton());
    for time in times {
        sampler.sample_into(time, &mut pose);
        let expected = animation.sample(time);
        for joint in 0..pose.joint_count() {
            let [found, wanted] =
                [&pose, &expected].map(|pose| pose.rotations[joint].as_dquat().normalize());
            let apart = angle_between(found, wanted);
            assert!(
                apart < 2e-6,
                "joint {joint} is {apart:e} rad off at {time} s"
            );
            let wanted = expected.translations[joint];
            let apart = (pose.translations[joint] - wanted).length();
            assert!(
                apart < 2e-6 * (1.0 + wanted.length()),
                "joint {joint}: {apart:e} at {time} s"
            );
        }
    }
}

fn any_way() -> impl Strategy<Value = Interpolation> + Clone {
    prop::sample::select(vec![
        Interpolation::Step,
        Interpolation::Linear,
        Interpolation::Cubic,
        Interpolation::Squad,
    ])
}

fn any_beyond() -> impl Strategy<Value = Extrapolation> {
    prop::sample::select(vec![
        Extrapolation::Hold,
        Extrapolation::Cycle,
        Extrapolation::CycleWithOffset,
        Extrapolation::PingPong,
    ])
}

type Key = (f64, [f64; 3], Interpolation, bool);

fn rotations(first: f64, keys: &[Key], ends: [Extrapolation; 2]) -> Track<DQuat> {
    let (mut now, mut turn) = (first, DQuat::IDENTITY);
    let keys = keys.iter().map(|&(gap, by, interpolation, smooth)| {
        now += gap;
        turn = (turn * exp(DVec3::from_array(by))).normalize();
        Keyframe {
            tangents: if smooth {
                Tangents::Smooth
            } else {
                Tangents::Auto
            },
            ..Keyframe::new(now, turn, interpolation)
        }
    });
    Track::with_ends(keys.collect(), ends[0], ends[1]).expect("keys")
}

fn translations(first: f64, keys: &[Key], ends: [Extrapolation; 2]) -> Track<DVec3> {
    let mut now = first;
    let keys = keys.iter().map(|&(gap, at, interpolation, _)| {
        now += gap;
        Keyframe::new(now, DVec3::from_array(at), interpolation)
    });
    Track::with_ends(keys.collect(), ends[0], ends[1]).expect("keys")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    #[test]
    fn poses_are_those_of_the_tracks(
        tracks in vec((
            -1.0_f64..1.0,
            vec((0.01_f64..1.0, [-1.7_f64..1.7, -1.7_f64..1.7, -1.7_f64..1.7], any_way(), prop::bool::ANY), 1..9),
            any_beyond(),
            any_beyond(),
        ), 1..12),
        times in vec(-6.0_f64..12.0, 60),
    ) {
        let mut animation = Animation::new(sample::humanoid());
        let mut keys_and_ends = Vec::new();
        for (index, (first, keys, before, after)) in tracks.iter().enumerate() {
            let ends = [*before, *after];
            let joint = JointId::new(index);
            let track = rotations(*first, keys, ends);
            keys_and_ends.extend_from_slice(track.times_secs());
            animation = animation
                .with_rotation(joint, Some(track))
                .with_translation(joint, Some(translations(*first, keys, ends)));
        }
        assert_agrees(&animation, times.into_iter());
        // At the keys themselves a step may round to either side of them; just beside them it may not.
        assert_agrees(&animation, keys_and_ends.iter().flat_map(|&t| [t - 1e-5, t + 1e-5]));
    }
}

#[test]
fn keys_in_a_clump_are_found_too() {
    let skeleton = sample::humanoid();
    // A thousand keys in a millisecond, and one an hour later: no bucket holds few.
    let clump = (0..1000).map(|i| f64::from(i) * 1e-6).chain([3600.0]);
    let keys = clump.enumerate().map(|(i, t)| {
        Keyframe::new(
            t,
            DQuat::from_rotation_y((i % 7) as f64 * 0.1),
            Interpolation::Linear,
        )
    });
    let track = Track::new(keys.collect(), Extrapolation::Hold).unwrap();
    let spread = [0.0, 1800.0, 3700.0]
        .map(|t| Keyframe::new(t, DQuat::from_rotation_x(t * 1e-4), Interpolation::Linear));
    let spread = Track::new(spread.to_vec(), Extrapolation::Hold).unwrap();
    let animation = Animation::new(skeleton)
        .with_rotation(JointId::new(3), Some(track))
        .with_rotation(JointId::new(4), Some(spread));
    let inside = (0..999).map(|i| (f64::from(i) + 0.5) * 1e-6);
    assert_agrees(
        &animation,
        inside.chain([-5.0, 0.5, 1799.0, 3599.0, 3650.0, 4000.0]),
    );
}

#[test]
fn an_animation_without_tracks_is_at_rest() {
    let skeleton = sample::humanoid();
    assert_agrees(&Animation::new(Arc::clone(&skeleton)), [0.0, f64::NAN]);
    let still = Track::constant(DQuat::from_rotation_z(0.5)).unwrap();
    let animation = Animation::new(skeleton).with_rotation(JointId::new(1), Some(still));
    assert_agrees(&animation, [-1.0, 0.0, 1.0, f64::INFINITY, f64::NAN]);
}
