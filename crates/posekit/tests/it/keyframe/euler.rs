//! Euler curves against SciPy's rotations and Blender's way with handles (`make_keyframe.py`), whole turns,
//! conversion, and what editing does to them.

use glam::{DQuat, DVec3};
use posekit::keyframe::edit::{
    KeyPoseConfig, KeyedJoints, insert_on_curve, key_pose, mirror_animation, scale_keys,
};
use posekit::keyframe::{
    Animation, BakeConfig, ConvertConfig, EulerTrack, Extrapolation, Handle, HandlePair,
    Interpolation, Keyframe, PoseSampler, RotationTrack, Tangents, Track, TrackError, to_euler,
    to_quaternion,
};
use posekit::motion::FrameTime;
use posekit::pose::LocalPose;
use posekit::rotation::{Axis, EulerOrder, angle_between};
use posekit::skeleton::{JointId, SkeletonBuilder};
use proptest::prelude::*;
use serde::Deserialize;
use std::sync::Arc;

use super::golden_curves::golden;
use super::track;

#[derive(Deserialize)]
struct Case {
    order: String,
    times: Vec<f64>,
    values: Vec<[f64; 3]>,
    /// Of each key and angle: left time and value, right time and value.
    handles: Vec<[[f64; 4]; 3]>,
    at: Vec<f64>,
    angles: Vec<[f64; 3]>,
    expected: Vec<[f64; 4]>,
    linear: Vec<[f64; 4]>,
}

impl Case {
    fn order(&self) -> EulerOrder {
        self.order.parse().expect("an order")
    }

    fn curves(&self) -> EulerTrack {
        let part = |handles: &[[f64; 4]; 3], index: usize, sign: f64| {
            DVec3::from_array(std::array::from_fn(|axis| handles[axis][index] * sign))
        };
        let keys = (0..self.times.len()).map(|k| Keyframe {
            time_secs: self.times[k],
            value: DVec3::from_array(self.values[k]),
            interpolation: Interpolation::Cubic,
            tangents: Tangents::Handles {
                incoming: Handle {
                    secs: part(&self.handles[k], 0, -1.0),
                    value: part(&self.handles[k], 1, 1.0),
                },
                outgoing: Handle {
                    secs: part(&self.handles[k], 2, 1.0),
                    value: part(&self.handles[k], 3, 1.0),
                },
                pair: HandlePair::Broken,
            },
        });
        let track = Track::new(keys.collect(), Extrapolation::Hold).unwrap();
        EulerTrack::new(self.order(), track).unwrap()
    }
}

#[test]
fn curves_with_handles_are_blenders_in_all_twelve_orders() {
    let mut orders = Vec::new();
    for case in golden::<Case>("euler") {
        orders.push(case.order.clone());
        let curves = case.curves();
        for (index, &time) in case.at.iter().enumerate() {
            let angles = curves.angles_deg().sample(time);
            let off = (angles - DVec3::from_array(case.angles[index]))
                .abs()
                .max_element();
            // `numpy.roots` is good to some 1e-10 of a segment where the time's cubic is flat.
            assert!(off < 1e-5, "{off:e} degrees at {time} s in {}", case.order);
            let expected = DQuat::from_array(case.expected[index]);
            assert!(angle_between(curves.sample(time), expected) < 1e-6);
        }
    }
    orders.sort();
    orders.dedup();
    assert_eq!(orders.len(), 12);
}

#[test]
fn straight_curves_are_scipys_rotations_of_straight_angles() {
    for case in golden::<Case>("euler") {
        let values: Vec<DVec3> = case.values.iter().copied().map(DVec3::from_array).collect();
        let straight = track(&case.times, &values, Interpolation::Linear);
        let curves = EulerTrack::new(case.order(), straight).unwrap();
        for (&time, &expected) in case.at.iter().zip(&case.linear) {
            let angle = angle_between(curves.sample(time), DQuat::from_array(expected));
            assert!(angle < 1e-11, "{angle:e} rad at {time} s in {}", case.order);
        }
    }
}

/// A turn about Z from 0 to so many degrees in four seconds.
fn spin(degrees: f64) -> EulerTrack {
    let values = [DVec3::ZERO, DVec3::new(0.0, 0.0, degrees)];
    let track = track(&[0.0, 4.0], &values, Interpolation::Linear);
    EulerTrack::new(EulerOrder::XYZ, track).unwrap()
}

#[test]
fn whole_turns_are_turned_and_go_on_beyond_the_keys() {
    for degrees in [90.0, 270.0, 360.0, -360.0, 720.0, 3600.0] {
        let curves = spin(degrees);
        for step in 0..=16_u32 {
            let time = 0.25 * f64::from(step);
            let expected = DQuat::from_rotation_z((degrees * time / 4.0).to_radians());
            assert!(angle_between(curves.sample(time), expected) < 1e-11);
        }
        let angles = curves.angles_deg();
        let beyond = Extrapolation::CycleWithOffset;
        let on = Track::new(angles.keys().to_vec(), beyond).unwrap();
        let on = curves.with_angles_deg(on);
        let expected = DQuat::from_rotation_z((degrees * 9.0 / 4.0).to_radians());
        assert!(angle_between(on.sample(9.0), expected) < 1e-11);
    }
}

#[test]
fn incomplete_orders_and_handles_that_go_backwards_are_refused() {
    let angles = spin(90.0).angles_deg().clone();
    for order in ["XY", "XXY", "Z"] {
        assert!(EulerTrack::new(order.parse().unwrap(), angles.clone()).is_err());
    }
    let handle = |secs, value| Handle { secs, value };
    let with = |incoming| Keyframe {
        tangents: Tangents::Handles {
            incoming,
            outgoing: handle(0.0, 1.0),
            pair: HandlePair::Aligned,
        },
        ..Keyframe::new(0.0, 1.0, Interpolation::Cubic)
    };
    let track = |key| Track::new(vec![key], Extrapolation::Hold);
    assert!(track(with(handle(0.5, 1.0))).is_ok());
    let backwards = TrackError::HandleBackwards { index: 0 };
    assert_eq!(track(with(handle(-0.5, 1.0))), Err(backwards));
    let endless = TrackError::TangentOutOfRange { index: 0 };
    assert_eq!(track(with(handle(f64::NAN, 1.0))), Err(endless));
    assert_eq!(track(with(handle(f64::INFINITY, 1.0))), Err(endless));
    let none = Handle {
        secs: DQuat::IDENTITY,
        value: DQuat::IDENTITY,
    };
    let turned = Keyframe {
        tangents: Tangents::Handles {
            incoming: none,
            outgoing: none,
            pair: HandlePair::Aligned,
        },
        ..Keyframe::new(0.0, DQuat::IDENTITY, Interpolation::Cubic)
    };
    let refused = Track::new(vec![turned], Extrapolation::Hold).unwrap_err();
    assert_eq!(refused, TrackError::HandlesOfQuaternion { index: 0 });
}

/// The time, worked by hand: handles straight up and straight down make time `3 t^2 - 2 t^3`, so that half
/// the time is half the way, and a quarter of the way is at 5/32 of the time.
#[test]
fn handles_straight_up_are_worked_by_hand() {
    let key = |time: f64, value: f64, up: f64| Keyframe {
        tangents: Tangents::Handles {
            incoming: Handle {
                secs: 0.0,
                value: -up,
            },
            outgoing: Handle {
                secs: 0.0,
                value: up,
            },
            pair: HandlePair::Aligned,
        },
        ..Keyframe::new(time, value, Interpolation::Cubic)
    };
    let keys = vec![key(0.0, 0.0, 3.0), key(1.0, 6.0, 0.0)];
    let track = Track::new(keys, Extrapolation::Hold).unwrap();
    assert!((track.sample(0.5) - (3.0 / 8.0 * 3.0 + 3.0 / 8.0 * 6.0 + 6.0 / 8.0)).abs() < 1e-12);
    // t = 1/4: Bernstein weights 27, 27, 9 and 1 of 64.
    let expected = (27.0 * 3.0 + 9.0 * 6.0 + 6.0) / 64.0;
    assert!((track.sample(5.0 / 32.0) - expected).abs() < 1e-12);
    assert!(track.tangents_at(0)[1].is_finite());
    let [before, after] = track.handles_at(0);
    assert_eq!(
        (before, after),
        (
            None,
            Some(Handle {
                secs: 0.0,
                value: 3.0
            })
        )
    );
}

#[test]
fn handles_of_slopes_lie_a_third_of_the_way_along() {
    let keys = [(0.0, 1.0), (3.0, 4.0), (5.0, 0.0)].map(|(time, value)| Keyframe {
        tangents: Tangents::Aligned(2.0),
        ..Keyframe::new(time, value, Interpolation::Cubic)
    });
    let track = Track::new(keys.to_vec(), Extrapolation::Hold).unwrap();
    let [before, after] = track.handles_at(1).map(Option::unwrap);
    assert!((before.secs - 1.0).abs() < 1e-12 && (before.value + 2.0).abs() < 1e-12);
    assert!((after.secs - 2.0 / 3.0).abs() < 1e-12 && (after.value - 4.0 / 3.0).abs() < 1e-12);
    // The same handles said in full are the same curve.
    let full = track.keys().iter().enumerate().map(|(index, key)| {
        let [before, after] = track.handles_at(index);
        Keyframe {
            tangents: Tangents::Handles {
                incoming: before.unwrap_or_default(),
                outgoing: after.unwrap_or_default(),
                pair: HandlePair::Aligned,
            },
            ..*key
        }
    });
    let same = Track::new(full.collect(), Extrapolation::Hold).unwrap();
    for step in 0..=50_u32 {
        let time = 0.1 * f64::from(step);
        assert!((same.sample(time) - track.sample(time)).abs() < 1e-12);
    }
    // Stretched in time, the curve is stretched.
    let wide = scale_keys(&same, &[0, 1, 2], 0.0, 2.0).unwrap();
    assert!((wide.sample(3.0) - same.sample(1.5)).abs() < 1e-12);
}

/// The track with handles of half their length, which do not reach past each other: what a cut leaves of handles
/// that do may be longer than the cut piece, and is shortened.
fn with_half_handles(track: &Track<DVec3>) -> Track<DVec3> {
    let half = |handle: Option<Handle<DVec3>>| Handle {
        secs: handle.map_or(DVec3::ZERO, |it| 0.5 * it.secs),
        value: handle.map_or(DVec3::ZERO, |it| 0.5 * it.value),
    };
    let keys = track.keys().iter().enumerate().map(|(index, key)| {
        let [incoming, outgoing] = track.handles_at(index).map(half);
        Keyframe {
            tangents: Tangents::Handles {
                incoming,
                outgoing,
                pair: HandlePair::Broken,
            },
            ..*key
        }
    });
    Track::new(keys.collect(), Extrapolation::Hold).unwrap()
}

#[test]
fn a_key_put_onto_a_curve_with_handles_does_not_move_it() {
    for case in golden::<Case>("euler") {
        let before = with_half_handles(case.curves().angles_deg());
        let [start, end] = [before.start_secs(), before.end_secs()];
        let mut after = before.clone();
        for share in [0.13, 0.4, 0.41, 0.77] {
            after = insert_on_curve(&after, start + (end - start) * share).unwrap();
        }
        assert_eq!(after.keys().len(), before.keys().len() + 4);
        for step in 0..=300_u32 {
            let time = start + (end - start) * f64::from(step) / 300.0;
            let off = (after.sample(time) - before.sample(time))
                .abs()
                .max_element();
            // Where a curve stands straight up, the last digits of time show in the value.
            assert!(off < 1e-5, "{off:e} at {time} s in {}", case.order);
        }
    }
}

fn bone() -> Arc<posekit::skeleton::Skeleton> {
    let mut builder = SkeletonBuilder::new();
    let mast = builder.joint("Mast", None, glam::Vec3::ZERO);
    let sails = builder.joint("Sails", Some(mast), glam::Vec3::Y);
    builder.end_site("Tip", sails, glam::Vec3::X);
    Arc::new(builder.build().expect("a skeleton"))
}

#[test]
fn animations_bake_and_sample_euler_curves() {
    let skeleton = bone();
    let joint = JointId::new(1);
    let animation = Animation::new(skeleton).with_rotation(joint, Some(spin(360.0)));
    assert_eq!(
        (animation.key_count(), animation.range_secs()),
        (2, Some([0.0, 4.0]))
    );
    let motion = animation.bake(&BakeConfig::of_range([0.0, 4.0], FrameTime::of_fps(30)));
    let sampler = PoseSampler::new(&animation);
    let mut pose = LocalPose::rest(animation.skeleton());
    for frame in 0..motion.frame_count() {
        let expected = DQuat::from_rotation_z((3.0 * frame as f64).to_radians());
        let baked = motion.rotation(frame, joint).as_dquat().normalize();
        assert!(angle_between(baked, expected) < 1e-6);
        sampler.sample_into(frame as f64 / 30.0, &mut pose);
        let sampled = pose.rotations[1].as_dquat().normalize();
        assert!(angle_between(sampled, expected) < 2e-6);
    }
    let quarter = animation.sample(1.0).to_global(animation.skeleton());
    assert!((quarter.positions[2] - glam::Vec3::new(0.0, 2.0, 0.0)).length() < 1e-6);
}

#[test]
fn a_key_of_a_pose_goes_on_from_the_angles_that_are_there() {
    let joint = JointId::new(1);
    let animation = Animation::new(bone()).with_rotation(joint, Some(spin(720.0)));
    let mut pose = animation.sample(3.0);
    pose.rotations[1] = glam::Quat::from_rotation_z(550_f32.to_radians());
    let config = KeyPoseConfig {
        time_secs: 3.0,
        what: KeyedJoints::Rotation,
        interpolation: Interpolation::Linear,
        beyond: Extrapolation::Hold,
    };
    let keyed = key_pose(&animation, [joint], &pose, &config).unwrap();
    let Some(RotationTrack::Euler(track)) = keyed.rotation(joint) else {
        panic!("Euler curves");
    };
    let key = track.angles_deg().keys()[1];
    assert!(
        (key.value - DVec3::new(0.0, 0.0, 550.0))
            .abs()
            .max_element()
            < 1e-4
    );
}

#[test]
fn the_mirror_image_of_euler_curves_keeps_order_and_turns() {
    let skeleton = posekit::sample::humanoid();
    let left = skeleton.find("LeftUpperArm").unwrap();
    let right = skeleton.find("RightUpperArm").unwrap();
    let values = [DVec3::ZERO, DVec3::new(30.0, 400.0, -75.0)];
    let curves = track(&[0.0, 1.0], &values, Interpolation::Cubic);
    let curves = EulerTrack::new(EulerOrder::ZXY, curves).unwrap();
    let animation = Animation::new(skeleton).with_rotation(left, Some(curves.clone()));
    let image = mirror_animation(&animation, Axis::X, 0.5).unwrap();
    let track = image.rotation(right).unwrap().as_euler().unwrap();
    assert_eq!(track.order(), EulerOrder::ZXY);
    // The order lists Z, X, Y: X is the mirror's own axis.
    assert_eq!(
        track.angles_deg().keys()[1].value,
        DVec3::new(-30.0, 400.0, 75.0)
    );
    for step in 0..=10_u32 {
        let time = 0.1 * f64::from(step);
        let turn = curves.sample(time);
        let expected = DQuat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w);
        assert!(angle_between(track.sample(time + 0.5), expected) < 1e-12);
    }
}

#[test]
fn a_mirror_of_crooked_axes_is_sampled_within_its_bound() {
    let mut builder = SkeletonBuilder::new();
    let hips = builder.joint("Hips", None, glam::Vec3::Y);
    let rest = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.4, -0.9, 1.3);
    for (side, x) in [("Left", 1.0), ("Right", -1.0)] {
        let at = glam::Vec3::new(0.3 * x, 0.0, 0.0);
        // The same turn on both sides: no image of each other.
        let arm = builder.oriented_joint(format!("{side}Arm"), Some(hips), at, rest);
        builder.joint(
            format!("{side}Hand"),
            Some(arm),
            glam::Vec3::new(0.3 * x, 0.0, 0.0),
        );
    }
    let skeleton = Arc::new(builder.build().unwrap());
    let [left, right] = ["LeftHand", "RightHand"].map(|name| skeleton.find(name).unwrap());
    let values = [DVec3::ZERO, DVec3::new(50.0, 30.0, -200.0)];
    let curves = track(&[0.0, 1.0], &values, Interpolation::Linear);
    let curves = EulerTrack::new(EulerOrder::XYZ, curves).unwrap();
    let euler = Animation::new(skeleton.clone()).with_rotation(left, Some(curves.clone()));
    let image = mirror_animation(&euler, Axis::X, 0.0).unwrap();
    let image = image.rotation(right).unwrap();
    for step in 0..=40_u32 {
        let time = f64::from(step) / 40.0;
        let mut pose = LocalPose::rest(&skeleton);
        pose.rotations[left.index()] = curves.sample(time).as_quat();
        let mirrored = posekit::keyframe::edit::mirror_pose(&skeleton, Axis::X, &pose);
        let expected = mirrored.rotations[right.index()].as_dquat().normalize();
        assert!(angle_between(image.sample(time), expected) < 0.1_f64.to_radians() + 1e-6);
    }
}

#[test]
fn turns_about_one_axis_convert_without_loss() {
    let converted = to_quaternion(&spin(720.0), &ConvertConfig::default()).unwrap();
    assert!(converted.greatest_error_rad < 1e-9);
    assert!(
        converted.added_keys >= 4,
        "quaternions turn by at most 180 degrees"
    );
    for step in 0..=64_u32 {
        let time = f64::from(step) / 16.0;
        let expected = DQuat::from_rotation_z((180.0 * time).to_radians());
        assert!(angle_between(converted.track.sample(time), expected) < 1e-9);
    }
    let back = to_euler(
        &converted.track,
        EulerOrder::XYZ,
        DVec3::ZERO,
        &ConvertConfig::default(),
    );
    let back = back.unwrap();
    assert_eq!(back.added_keys, 0);
    let last = back.track.angles_deg().keys().last().unwrap().value;
    assert!((last - DVec3::new(0.0, 0.0, 720.0)).abs().max_element() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn conversion_stays_within_what_it_says(
        values in proptest::collection::vec([-170.0_f64..170.0, -60.0_f64..60.0, -170.0_f64..170.0], 2..5),
        way in proptest::sample::select(vec![
            Interpolation::Step, Interpolation::Linear, Interpolation::Cubic, Interpolation::Squad,
        ]),
    ) {
        let values: Vec<DVec3> = values.into_iter().map(DVec3::from_array).collect();
        let times: Vec<f64> = (0..values.len()).map(|index| 0.7 * index as f64).collect();
        let curves = EulerTrack::new(EulerOrder::ZXY, track(&times, &values, way)).unwrap();
        let config = ConvertConfig::default();
        let there = to_quaternion(&curves, &config).unwrap();
        prop_assert!(there.greatest_error_rad <= config.tolerance_rad);
        let back = to_euler(&there.track, EulerOrder::ZXY, values[0], &config).unwrap();
        for step in 0..200 {
            let time = times[times.len() - 1] * f64::from(step) / 199.0;
            let [a, b, c] = [curves.sample(time), there.track.sample(time), back.track.sample(time)];
            // Measured at places: between them it may be a little more.
            prop_assert!(angle_between(a, b) <= 1.2 * config.tolerance_rad);
            let limit = back.greatest_error_rad.max(config.tolerance_rad);
            prop_assert!(angle_between(b, c) <= 1.2 * limit);
        }
    }
}
