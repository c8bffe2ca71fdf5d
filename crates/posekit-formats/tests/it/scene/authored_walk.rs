//! The walk that is authored in the scene format: few keys, and a walk all the same.

use std::convert::Infallible;
use std::sync::Arc;

use posekit::motion::Motion;
use posekit::sample::{WalkConfig, walk};
use posekit_formats::scene::{self, AUTHORED_WALK, Scene, Shot};

/// Frames of one cycle of 1.1 s at 60 frames a second.
const CYCLE: usize = 66;

fn authored() -> (Scene, Motion) {
    let scene = scene::read(AUTHORED_WALK.as_bytes()).expect("a scene");
    let none = |_: &str| -> Result<Arc<Motion>, Infallible> { unreachable!("it names no file") };
    let shot = Shot::new(&scene, none).expect("a shot");
    let motion = shot.bake(None);
    (scene, motion)
}

#[test]
fn it_has_few_keys_and_goes_on() {
    let (scene, motion) = authored();
    let skeleton = Arc::clone(motion.skeleton());
    assert_eq!(skeleton, posekit::sample::humanoid());
    let animation = scene.animation(&skeleton).unwrap();
    assert!(
        animation.key_count() < 260,
        "{} keys",
        animation.key_count()
    );
    assert_eq!(motion.frame_count(), 4 * CYCLE + 1);
    let global = motion.to_global();
    for joint in skeleton.joints() {
        let step = global.position(CYCLE, joint) - global.position(0, joint);
        let next = global.position(3 * CYCLE, joint) - global.position(2 * CYCLE, joint);
        assert!(
            (step - next).length() < 1e-4,
            "each cycle goes as far as the others"
        );
        assert!((step.z - 1.408).abs() < 1e-3 && step.x.abs() < 1e-4 && step.y.abs() < 1e-4);
    }
}

/// The gait that the library computes from published curves, a cycle of 65 frames for 66.
#[test]
fn it_is_the_walk_of_the_gait_curves() {
    let (_, motion) = authored();
    let curves = walk(&WalkConfig::default()).unwrap();
    let (keyed, computed) = (motion.to_global(), curves.to_global());
    for frame in 0..motion.frame_count() {
        let (before, rest) = (frame * 65 / CYCLE, frame * 65 % CYCLE);
        let t = rest as f32 / CYCLE as f32;
        let after = (before + 1).min(curves.frame_count() - 1);
        for joint in motion.skeleton().joints() {
            let [a, b] = [before, after].map(|frame| computed.position(frame, joint));
            let apart = (keyed.position(frame, joint) - a.lerp(b, t)).length();
            let name = motion.skeleton().name(joint);
            assert!(apart < 0.03, "{name} is {apart} m off at frame {frame}");
        }
    }
}

#[test]
fn feet_stay_where_they_stand_and_over_the_floor() {
    let (_, motion) = authored();
    let curves = walk(&WalkConfig::default()).unwrap();
    let (keyed, computed) = (motion.to_global(), curves.to_global());
    for name in ["LeftToes", "RightToes"] {
        let joint = motion.skeleton().find(name).unwrap();
        let tip = motion.skeleton().find(&format!("{name}_end")).unwrap();
        let mut stood: Option<glam::Vec3> = None;
        let mut stances = 0;
        for frame in 0..4 * CYCLE {
            assert!(keyed.position(frame, tip).y > 0.0 && keyed.position(frame, joint).y > 0.01);
            let place = (frame * 65 / CYCLE).min(curves.frame_count() - 2);
            let moved = computed.position(place + 1, joint) - computed.position(place, joint);
            if moved.length() * 60.0 > 0.02 {
                stood = None;
                continue;
            }
            let here = keyed.position(frame, joint);
            let first = *stood.get_or_insert_with(|| {
                stances += 1;
                here
            });
            assert!(
                (here - first).length() < 0.02,
                "{name} slid to {here} from {first}"
            );
        }
        assert!(stances >= 4, "{stances} stances");
    }
}
