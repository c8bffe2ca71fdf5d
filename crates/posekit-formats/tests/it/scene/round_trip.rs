//! What is written reads back the same, to the bit and to the byte.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::keyframe::edit::{KeyPoseConfig, KeyedJoints, key_pose};
use posekit::keyframe::{
    Animation, EulerTrack, Extrapolation, Handle, HandlePair, Interpolation, KeyValue, KeyedCamera,
    Keyframe, Property, Tangents, Track,
};
use posekit::range::{LONGEST_LENGTH, LONGEST_SECS};
use posekit::rotation::{EulerOrder, angle_between};
use posekit_formats::scene::{
    self, Camera, JointTrack, JointValues, MotionLayer, Scene, SkeletonSource,
};
use proptest::collection::vec;
use proptest::prelude::*;

use super::{NOD, nod};

fn assert_same_again(scene: &Scene) {
    let bytes = scene::write(scene).unwrap();
    let again = scene::read(&bytes).unwrap_or_else(|error| {
        panic!("{error}\n{}", String::from_utf8_lossy(&bytes));
    });
    assert_eq!(&again, scene);
    assert_eq!(
        scene::write(&again).unwrap(),
        bytes,
        "signs of zeros are kept"
    );
}

#[test]
fn a_persons_file_is_written_as_the_same_scene() {
    let scene = nod();
    assert_same_again(&scene);
    let text = String::from_utf8(scene::write(&scene).unwrap()).unwrap();
    assert!(
        text.contains("  { at = 0.5, value = [0, 35, 370], slope = \"flat\" },\n"),
        "{text}"
    );
    assert!(text.contains("after = \"cycle with offset\"\n"));
    assert_ne!(text, NOD, "comments are not kept");
}

#[test]
fn a_changed_key_changes_one_line() {
    let scene = nod();
    let mut later = scene.clone();
    let JointValues::Rotation { track, .. } = &mut later.tracks[1].values else {
        panic!("a rotation");
    };
    let mut keys = track.keys().to_vec();
    keys[1].value = EulerOrder::ZXY.to_quat([0.0, 0.5, 0.0]);
    *track = Track::with_ends(keys, track.before(), track.after())
        .unwrap()
        .into();
    let [before, after] =
        [&scene, &later].map(|s| String::from_utf8(scene::write(s).unwrap()).unwrap());
    let lines = before.lines().zip(after.lines());
    let changed: Vec<_> = lines.filter(|(a, b)| a != b).collect();
    assert_eq!(changed.len(), 1);
    assert_eq!(
        changed[0].1,
        "  { at = 0.5, value = [0, 28.647889757, 0], slope = \"flat\" },"
    );
}

#[test]
fn an_edited_animation_keeps_the_order_and_notation_of_its_tracks() {
    let scene = nod();
    let skeleton = Arc::new(scene.skeleton.inline_skeleton().unwrap().unwrap());
    let animation = scene.animation(&skeleton).unwrap();
    let mut same = scene.clone();
    same.set_animation(&animation, None);
    assert_eq!(same, scene);
    let pose = animation.sample(0.3);
    let config = KeyPoseConfig {
        time_secs: 0.3,
        what: KeyedJoints::RotationAndPlace,
        interpolation: Interpolation::Cubic,
        beyond: Extrapolation::Hold,
    };
    let edited = key_pose(&animation, skeleton.joints(), &pose, &config).unwrap();
    let mut saved = scene.clone();
    saved.set_animation(&edited, Some(EulerOrder::XYZ));
    let kinds: Vec<_> = saved
        .tracks
        .iter()
        .map(|track| track.joint.as_str())
        .collect();
    assert_eq!(kinds, ["Body", "Head", "Body"]);
    let text = String::from_utf8(scene::write(&saved).unwrap()).unwrap();
    assert!(
        text.contains("{ at = 0.5, value = [0, 35, 370], slope = \"flat\" }"),
        "{text}"
    );
    let again = scene::read(text.as_bytes()).unwrap();
    let reread = again.animation(&skeleton).unwrap();
    for joint in skeleton.joints() {
        for step in 0..30 {
            let time = 0.1 * f64::from(step);
            let turned = |animation: &Animation| {
                animation
                    .rotation(joint)
                    .map_or(DQuat::IDENTITY, |track| track.sample(time))
            };
            assert!(angle_between(turned(&edited), turned(&reread)) < 1e-9);
        }
    }
    saved.set_animation(&Animation::new(skeleton), None);
    assert!(saved.tracks.is_empty());
}

#[test]
fn an_inline_skeleton_is_the_one_it_was_made_from() {
    let humanoid = posekit::sample::humanoid();
    let source = SkeletonSource::inline(&humanoid);
    assert_eq!(
        &source.inline_skeleton().unwrap().unwrap(),
        humanoid.as_ref()
    );
    assert_same_again(&Scene::new(source));
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -10.0_f64..10.0,
        prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
        Just(LONGEST_LENGTH),
    ]
    .prop_map(|number: f64| {
        // Of every size, and none beyond the range.
        if number.abs() <= LONGEST_LENGTH {
            number
        } else {
            LONGEST_LENGTH / number
        }
    })
}

fn secs() -> impl Strategy<Value = f64> {
    number().prop_map(|secs| secs.clamp(-LONGEST_SECS, LONGEST_SECS))
}

fn vector() -> impl Strategy<Value = DVec3> {
    [number(), number(), number()].prop_map(DVec3::from_array)
}

fn quaternion() -> impl Strategy<Value = DQuat> {
    vec(-1.0_f64..1.0, 4).prop_filter_map("near zero", |v| {
        let q = DQuat::from_xyzw(v[0], v[1], v[2], v[3]);
        (q.length() > 0.1).then(|| q.normalize())
    })
}

fn four() -> impl Strategy<Value = DQuat> {
    [number(), number(), number(), number()].prop_map(DQuat::from_array)
}

fn track_of<V: KeyValue>(
    value: impl Strategy<Value = V> + 'static,
    slope: impl Strategy<Value = V> + Clone + 'static,
) -> impl Strategy<Value = Track<V>> {
    let way = prop::sample::select(vec![
        Interpolation::Step,
        Interpolation::Linear,
        Interpolation::Cubic,
        Interpolation::Squad,
    ]);
    let beyond = prop::sample::select(vec![
        Extrapolation::Hold,
        Extrapolation::Cycle,
        Extrapolation::CycleWithOffset,
        Extrapolation::PingPong,
    ]);
    let tangents = prop_oneof![
        Just(Tangents::Auto),
        Just(Tangents::Smooth),
        Just(Tangents::Flat),
        slope.clone().prop_map(Tangents::Aligned),
        (slope.clone(), slope)
            .prop_map(|(incoming, outgoing)| Tangents::Broken { incoming, outgoing }),
    ];
    let keys = vec((0.001_f64..3.0, value, way, tangents), 1..6);
    (keys, beyond.clone(), beyond).prop_map(|(keys, before, after)| {
        let mut now = -2.0;
        let keys = keys
            .into_iter()
            .map(|(gap, value, interpolation, tangents)| {
                now += gap;
                Keyframe {
                    time_secs: now,
                    value,
                    interpolation,
                    tangents,
                }
            });
        Track::with_ends(keys.collect(), before, after).expect("keys of a track")
    })
}

fn property<V: KeyValue>(
    value: impl Strategy<Value = V> + Clone + 'static,
) -> impl Strategy<Value = Property<V>> {
    prop_oneof![
        value.clone().prop_map(Property::Fixed),
        track_of(value.clone(), value).prop_map(Property::Keyed),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_scene_reads_back_the_same(
        title in any::<String>(),
        start in -5.0_f64..5.0,
        layers in vec(("[a-z]{1,9}\\.bvh", secs(), prop::bool::ANY), 0..3),
        rotation in track_of(quaternion().boxed(), four().boxed()),
        translation in track_of(vector().boxed(), vector().boxed()),
        joint in any::<String>(),
        angles in track_of(vector().boxed(), vector().boxed()),
        handles in vec((vector(), vector(), vector(), vector(), prop::bool::ANY), 6),
        position in property(vector().boxed()),
        fov in property(number().boxed()),
    ) {
        let mut scene = Scene::new(SkeletonSource::File("some \"file\".bvh".into()));
        scene.title = title;
        scene.range_secs = [start, start + 1.25];
        scene.motions = layers.into_iter().map(|(file, start_secs, clipped)| MotionLayer {
            file, start_secs, clip_secs: clipped.then_some([0.125, 2.0]),
        }).collect();
        let keys = angles.keys().iter().zip(handles).map(|(key, (a, b, c, d, is_broken))| Keyframe {
            tangents: if key.tangents == Tangents::Auto {
                Tangents::Handles {
                    incoming: Handle { secs: a.abs().min(DVec3::splat(LONGEST_SECS)), value: b },
                    outgoing: Handle { secs: c.abs().min(DVec3::splat(LONGEST_SECS)), value: d },
                    pair: if is_broken { HandlePair::Broken } else { HandlePair::Aligned },
                }
            } else {
                key.tangents
            },
            ..*key
        });
        let angles = Track::with_ends(keys.collect(), angles.before(), angles.after()).unwrap();
        let curves = EulerTrack::new(EulerOrder::YZX, angles).unwrap();
        scene.tracks = vec![
            JointTrack { joint: "curves".to_owned(), values: JointValues::EulerRotation(Arc::new(curves)) },
            JointTrack { joint: joint.clone(), values: JointValues::Rotation { track: rotation.into(), euler: None } },
            JointTrack { joint, values: JointValues::Translation(translation.into()) },
        ];
        scene.cameras = vec![Camera {
            name: "c".into(),
            view: KeyedCamera { position, vertical_fov_deg: fov, ..KeyedCamera::default() },
        }];
        assert_same_again(&scene);
    }

    #[test]
    fn any_text_is_read_or_refused(text in "(format = \"posekit scene\"\nversion = 1\n)?[\\[\\]{}=\\.,\"a-z0-9\n -]{0,80}") {
        let _ = scene::read(text.as_bytes());
    }
}
