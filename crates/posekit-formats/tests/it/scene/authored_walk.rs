//! The walk that is authored in the scene format: few keys, and a walk all the same.

use std::convert::Infallible;
use std::sync::Arc;

use posekit::motion::Motion;
use posekit_formats::scene::{self, AUTHORED_WALK, Scene, Shot};

/// Frames of one cycle of 1 s at 60 frames a second.
const CYCLE: usize = 60;

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
        assert!((step.z - 1.2).abs() < 1e-3 && step.x.abs() < 1e-4 && step.y.abs() < 1e-4);
    }
}

/// What a hand sets is a round number.
#[test]
fn its_angles_are_whole_degrees() {
    let mut angles = 0;
    let mut turns = false;
    for line in AUTHORED_WALK.lines() {
        if line.starts_with("property") {
            turns = line.contains("rotation");
        }
        if line.starts_with("[camera") {
            break;
        }
        let Some((_, value)) = line.split_once("value = [").filter(|_| turns) else {
            continue;
        };
        let (value, _) = value.split_once(']').expect("it ends");
        for number in value.split(',') {
            let whole: Result<i32, _> = number.trim().parse();
            assert!(whole.is_ok(), "{line}");
            angles += 1;
        }
    }
    assert!(angles > 500, "{angles}");
}

#[test]
fn its_right_side_is_the_left_one_half_a_cycle_later() {
    let (_, motion) = authored();
    let global = motion.to_global();
    let skeleton = motion.skeleton();
    for joint in skeleton.joints() {
        let name = skeleton.name(joint).to_owned();
        let other = match name.strip_prefix("Left") {
            Some(rest) => format!("Right{rest}"),
            None => name
                .strip_prefix("Right")
                .map_or(name.clone(), |rest| format!("Left{rest}")),
        };
        let other = skeleton.find(&other).expect("it has two sides");
        for frame in 0..2 * CYCLE {
            let mut here = global.position(frame, joint);
            here.x = -here.x;
            here.z += 0.6;
            let there = global.position(frame + CYCLE / 2, other);
            assert!((here - there).length() < 2e-4, "{name} at {frame}");
        }
    }
}

#[test]
fn its_poses_are_contact_down_passing_and_up() {
    let (_, motion) = authored();
    let global = motion.to_global();
    let at = |frame: usize, name: &str| {
        let joint = motion.skeleton().find(name).expect("a joint");
        global.position(CYCLE + frame, joint)
    };
    let [contact, down, passing, up] = [0, 6, 15, 24];
    let apart = |frame| (at(frame, "LeftFoot").z - at(frame, "RightFoot").z).abs();
    assert!(
        apart(contact) > 0.5 && apart(passing) < 0.15,
        "{} {}",
        apart(contact),
        apart(passing)
    );
    let height = |frame| at(frame, "Hips").y;
    assert!(height(down) < height(contact) && height(passing) > height(up));
    assert!(height(up) > height(contact));
    // The other foot is off the floor as it passes, and arms go against legs.
    assert!(at(passing, "RightFoot").y > at(passing, "LeftFoot").y + 0.1);
    assert!(at(contact, "LeftHand").z < at(contact, "RightHand").z - 0.2);
    // The toes of the foot in front are up when its heel comes down.
    assert!(at(contact, "LeftToes").y > 0.06);
}

#[test]
fn feet_stay_where_they_stand_and_over_the_floor() {
    let (_, motion) = authored();
    let global = motion.to_global();
    for (side, lands) in [("Left", 6), ("Right", 36)] {
        let joint = |part: &str| {
            motion
                .skeleton()
                .find(&format!("{side}{part}"))
                .expect("a joint")
        };
        let (toes, tip, ankle) = (joint("Toes"), joint("Toes_end"), joint("Foot"));
        for frame in 0..4 * CYCLE {
            let low = global.position(frame, tip).y;
            assert!(
                low > 0.0,
                "{side} toes are under the floor at {frame}: {low}"
            );
            assert!(
                global.position(frame, toes).y > 0.01 && global.position(frame, ankle).y > 0.06
            );
        }
        for cycle in 0..3 {
            let from = cycle * CYCLE + lands;
            // From flat to the toes' leaving; the sole itself until the heel leaves.
            for (part, frames) in [(toes, 28), (ankle, 13)] {
                let stood = global.position(from, part);
                for frame in from..from + frames {
                    let slid = (global.position(frame, part) - stood).length();
                    assert!(slid < 0.015, "{side} slid {slid} m at {frame}");
                }
            }
        }
    }
}
