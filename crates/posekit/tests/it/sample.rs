//! The clips that the library makes: whether people and robots could move like that.

use glam::{Quat, Vec3};
use posekit::motion::{GlobalMotion, Motion};
use posekit::sample::{
    ArmConfig, RunConfig, SampleError, WalkConfig, WaveConfig, WavingHand, arm, by_name, run, walk,
    wave,
};
use posekit::skeleton::JointId;

fn joint(motion: &Motion, name: &str) -> JointId {
    motion.skeleton().find(name).expect("a joint of the sample")
}

fn walks() -> Vec<(Motion, WalkConfig)> {
    [(1.3, 110.0), (0.8, 90.0), (1.0, 105.0), (1.8, 128.0)]
        .map(|(speed_m_per_s, steps_per_minute)| {
            let config = WalkConfig {
                speed_m_per_s,
                steps_per_minute,
                cycles: 2,
            };
            (walk(&config).expect("in range"), config)
        })
        .into()
}

fn runs() -> Vec<(Motion, RunConfig)> {
    [(3.0, 168.0), (2.4, 160.0), (3.8, 180.0)]
        .map(|(speed_m_per_s, steps_per_minute)| {
            let config = RunConfig {
                speed_m_per_s,
                steps_per_minute,
                cycles: 2,
            };
            (run(&config).expect("in range"), config)
        })
        .into()
}

fn everything() -> Vec<Motion> {
    let mut all: Vec<Motion> = walks().into_iter().map(|(motion, _)| motion).collect();
    all.extend(runs().into_iter().map(|(motion, _)| motion));
    all.extend(["wave", "arm"].map(|name| by_name(name).expect("a sample")));
    all
}

/// Points of the sole in the space of foot and toes: heel, under the ball, tip.
const SOLE: [(&str, Vec3); 3] = [
    ("Foot", Vec3::new(0.0, -0.075, -0.055)),
    ("Toes", Vec3::new(0.0, -0.02, 0.0)),
    ("Toes", Vec3::new(0.0, -0.02, 0.065)),
];

/// Where a foot's sole points are in each frame.
fn sole(global: &GlobalMotion, side: &str) -> Vec<[Vec3; 3]> {
    let joints = SOLE.map(|(name, point)| {
        let joint = global.skeleton().find(&format!("{side}{name}"));
        (joint.expect("a foot"), point)
    });
    (0..global.frame_count())
        .map(|frame| joints.map(|(joint, point)| global.transform_point(frame, joint, point)))
        .collect()
}

/// The knee's or the elbow's bend in degrees.
fn bend_deg(motion: &Motion, name: &str) -> Vec<f32> {
    let joint = joint(motion, name);
    (0..motion.frame_count())
        .map(|frame| {
            let turn = motion.rotation(frame, joint);
            2.0 * turn.xyz().length().atan2(turn.w.abs()).to_degrees()
        })
        .collect()
}

fn bounds(values: &[f32]) -> (f32, f32) {
    let low = values.iter().copied().fold(f32::INFINITY, f32::min);
    (
        low,
        values.iter().copied().fold(f32::NEG_INFINITY, f32::max),
    )
}

#[test]
fn feet_neither_sink_into_the_floor_nor_slide_on_it() {
    let gaits = walks().into_iter().map(|(motion, _)| motion);
    let gaits = gaits.chain(runs().into_iter().map(|(motion, _)| motion));
    for motion in gaits.chain(by_name("wave")) {
        let global = motion.to_global();
        for side in ["Left", "Right"] {
            let sole = sole(&global, side);
            let lowest = sole.iter().flatten().map(|point| point.y);
            let (lowest, _) = bounds(&lowest.collect::<Vec<_>>());
            assert!(lowest > -0.002, "{side} foot {lowest} under the floor");
            let mut planted = 0;
            for pair in sole.windows(2) {
                for (before, after) in pair[0].iter().zip(&pair[1]) {
                    if before.y.max(after.y) < 1e-4 {
                        planted += 1;
                        let slide = (after - before).length();
                        assert!(slide < 1e-3, "{side} foot slides {slide} m in a frame");
                    }
                }
            }
            assert!(
                planted * 4 > sole.len(),
                "{side} foot hardly touches the floor"
            );
        }
    }
}

#[test]
fn every_gait_in_range_keeps_to_the_floor_and_its_knees() {
    let mut tried = 0;
    for step in 0..=6 {
        for beat in 0..=6 {
            let part = |low: f64, high: f64, at: i32| low + (high - low) * f64::from(at) / 6.0;
            let walk_config = WalkConfig {
                speed_m_per_s: part(0.6, 2.0, step),
                steps_per_minute: part(70.0, 140.0, beat),
                cycles: 1,
            };
            let run_config = RunConfig {
                speed_m_per_s: part(2.2, 4.0, step),
                steps_per_minute: part(150.0, 190.0, beat),
                cycles: 1,
            };
            for motion in [walk(&walk_config), run(&run_config)].into_iter().flatten() {
                tried += 1;
                let global = motion.to_global();
                for side in ["Left", "Right"] {
                    let lowest = sole(&global, side)
                        .iter()
                        .flatten()
                        .map(|at| at.y)
                        .fold(1.0, f32::min);
                    assert!(lowest > -0.002, "{lowest}: {walk_config:?} {run_config:?}");
                }
                let (least, most) = bounds(&bend_deg(&motion, "LeftLowerLeg"));
                assert!(
                    least > 3.0 && most < 120.0,
                    "{least} {most}: {walk_config:?}"
                );
            }
        }
    }
    assert!(tried > 40, "{tried} gaits");
}

#[test]
fn a_walker_has_a_foot_on_the_floor_and_a_runner_flies() {
    let airborne = |motion: &Motion| {
        let global = motion.to_global();
        let (left, right) = (sole(&global, "Left"), sole(&global, "Right"));
        let high = |sole: &[Vec3; 3]| sole.iter().all(|point| point.y > 5e-4);
        let flying = left.iter().zip(&right).filter(|(l, r)| high(l) && high(r));
        let both = left
            .iter()
            .zip(&right)
            .filter(|(l, r)| !high(l) && !high(r));
        let frames = motion.frame_count() as f64;
        (flying.count() as f64 / frames, both.count() as f64 / frames)
    };
    for (motion, _) in walks() {
        let (flying, both) = airborne(&motion);
        assert_eq!(flying, 0.0);
        // Perry 1992: two periods of 10 to 12 % of the cycle.
        assert!(
            (0.16..0.32).contains(&both),
            "double support {both} of {}",
            motion.frame_count()
        );
    }
    for (motion, _) in runs() {
        let (flying, both) = airborne(&motion);
        assert!((0.15..0.45).contains(&flying), "flight {flying}");
        assert_eq!(both, 0.0);
    }
}

#[test]
fn speed_and_cadence_are_those_asked_for() {
    let gaits = walks().into_iter();
    let gaits = gaits.map(|(motion, c)| (motion, c.speed_m_per_s, c.steps_per_minute, c.cycles));
    let more = runs().into_iter();
    let more = more.map(|(motion, c)| (motion, c.speed_m_per_s, c.steps_per_minute, c.cycles));
    for (motion, speed, cadence, cycles) in gaits.chain(more) {
        let hips = joint(&motion, "Hips");
        let last = motion.frame_count() - 1;
        let way = motion.translation(last, hips) - motion.translation(0, hips);
        let secs = motion.duration_secs();
        assert!((f64::from(way.z) / secs - speed).abs() < 1e-4);
        assert!(way.x.abs() < 1e-5 && way.y.abs() < 1e-5);
        let steps_per_minute = 2.0 * f64::from(cycles) / secs * 60.0;
        assert!((steps_per_minute / cadence - 1.0).abs() < 0.02);
    }
}

#[test]
fn the_end_joins_the_start_in_place_and_in_velocity() {
    for motion in everything() {
        let global = motion.to_global();
        let last = motion.frame_count() - 1;
        let root = JointId::new(0);
        let shift = global.position(last, root) - global.position(0, root);
        for joint in motion.skeleton().joints() {
            let at = |frame| global.position(frame, joint);
            assert!((at(last) - at(0) - shift).length() < 1e-4);
            let inside = (1..last).map(|at_frame| {
                (at(at_frame - 1) - 2.0 * at(at_frame) + at(at_frame + 1)).length()
            });
            let (_, usual) = bounds(&inside.collect::<Vec<_>>());
            let kick = ((at(1) - at(0)) - (at(last) - at(last - 1))).length();
            assert!(
                kick <= usual + 1e-5,
                "{kick} m at the seam, {usual} elsewhere"
            );
            let name = motion.skeleton().name(joint);
            let turned = motion
                .rotation(0, joint)
                .angle_between(motion.rotation(last, joint));
            assert!(turned < 1e-3, "{name} ends turned by {turned}");
        }
    }
}

#[test]
fn nothing_jerks() {
    // Largest accelerations of marker data: feet of walkers about 5 g, of runners 10 g and more.
    for (motions, limit) in [
        (
            walks()
                .into_iter()
                .map(|(motion, _)| motion)
                .collect::<Vec<_>>(),
            80.0,
        ),
        (
            runs().into_iter().map(|(motion, _)| motion).collect(),
            170.0,
        ),
        (by_name("wave").into_iter().collect(), 45.0),
        (by_name("arm").into_iter().collect(), 12.0),
    ] {
        for motion in motions {
            let global = motion.to_global();
            for joint in motion.skeleton().joints() {
                for frame in 1..motion.frame_count() - 1 {
                    let [a, b, c] =
                        [frame - 1, frame, frame + 1].map(|frame| global.position(frame, joint));
                    let acceleration = (a - 2.0 * b + c).length() * 3600.0;
                    let name = motion.skeleton().name(joint);
                    assert!(
                        acceleration < limit,
                        "{name} {acceleration} m/s2 at {frame} of {}",
                        motion.frame_count()
                    );
                }
            }
        }
    }
}

#[test]
fn walking_joint_angles_are_a_persons() {
    let (motion, _) = &walks()[0];
    // Winter 1991, natural cadence: 2 to 8 degrees at least, 60 to 70 at most.
    let (least, most) = bounds(&bend_deg(motion, "LeftLowerLeg"));
    assert!(
        (2.0..9.0).contains(&least) && (58.0..70.0).contains(&most),
        "{least} {most}"
    );
    let (least, most) = bounds(&bend_deg(motion, "RightLowerArm"));
    assert!(least > 5.0 && most < 50.0, "{least} {most}");
    let flexion = |name: &str| -> Vec<f32> {
        let joint = joint(motion, name);
        let angle = |q: Quat| 2.0 * (-q.x).atan2(q.w).to_degrees();
        (0..motion.frame_count())
            .map(|frame| angle(motion.rotation(frame, joint)))
            .collect()
    };
    let (extension, hip) = bounds(&flexion("LeftUpperLeg"));
    assert!((-20.0..-8.0).contains(&extension) && (20.0..35.0).contains(&hip));
    let (plantar, dorsal) = bounds(&flexion("LeftFoot"));
    assert!((-26.0..-15.0).contains(&plantar) && (8.0..22.0).contains(&dorsal));
    let hips = joint(motion, "Hips");
    let rise: Vec<f32> = (0..motion.frame_count())
        .map(|frame| motion.translation(frame, hips).y)
        .collect();
    let (low, high) = bounds(&rise);
    assert!(
        (0.025..0.055).contains(&(high - low)),
        "the pelvis rises by {}",
        high - low
    );
}

#[test]
fn no_knee_or_elbow_bends_the_wrong_way_or_locks() {
    for motion in everything() {
        let skeleton = motion.skeleton();
        for joint in motion.rotated_joints() {
            let name = skeleton.name(*joint);
            for frame in 0..motion.frame_count() {
                let turn = motion.rotation(frame, *joint);
                let turn = if turn.w < 0.0 { -turn } else { turn };
                if name.ends_with("LowerLeg") {
                    assert!(turn.x > 0.017, "{name} at {frame}");
                    assert!(turn.y.abs() < 1e-4 && turn.z.abs() < 1e-4);
                } else if name == "LeftLowerArm" {
                    assert!(turn.y < -0.04);
                } else if name == "RightLowerArm" {
                    assert!(turn.y > 0.04);
                }
            }
        }
    }
}

#[test]
fn a_runner_leans_and_keeps_the_elbows_bent() {
    let motion = by_name("run").expect("a sample");
    let (least, most) = bounds(&bend_deg(&motion, "LeftLowerArm"));
    assert!(least > 70.0 && most < 120.0);
    let (least, most) = bounds(&bend_deg(&motion, "LeftLowerLeg"));
    assert!(
        (10.0..25.0).contains(&least) && (80.0..115.0).contains(&most),
        "{least} {most}"
    );
    let global = motion.to_global();
    let head = joint(&motion, "Head");
    for frame in 0..motion.frame_count() {
        let trunk = global.position(frame, head) - global.position(frame, JointId::new(0));
        let lean = trunk.z.atan2(trunk.y).to_degrees();
        assert!((3.0..20.0).contains(&lean), "leans by {lean}");
    }
}

#[test]
fn the_hand_that_waves_goes_over_the_shoulder_and_the_other_does_not() {
    for (hand, up, down) in [
        (WavingHand::Right, "Right", "Left"),
        (WavingHand::Left, "Left", "Right"),
    ] {
        let config = WaveConfig {
            hand,
            ..WaveConfig::default()
        };
        let motion = wave(&config).expect("in range");
        let global = motion.to_global();
        let height = |side: &str, name: &str| -> Vec<f32> {
            let joint = joint(&motion, &format!("{side}{name}"));
            (0..motion.frame_count())
                .map(|frame| global.position(frame, joint).y)
                .collect()
        };
        let shoulder = bounds(&height(up, "UpperArm")).1;
        assert!(bounds(&height(up, "Hand")).1 > shoulder + 0.15);
        assert!(bounds(&height(down, "Hand")).1 < shoulder - 0.4);
        // How often the hand comes back from outside while it is up.
        let wrist = joint(&motion, &format!("{up}Hand"));
        let across: Vec<f32> = (0..motion.frame_count())
            .map(|frame| global.position(frame, wrist))
            .filter(|hand| hand.y > shoulder + 0.1)
            .map(|hand| hand.x.abs())
            .collect();
        let turns = across
            .windows(3)
            .filter(|w| w[1] > w[0] && w[1] >= w[2])
            .count();
        assert!((3..=5).contains(&turns), "{turns} waves");
    }
}

#[test]
fn the_robot_turns_about_its_axes_and_picks_and_places_where_it_should() {
    let motion = by_name("arm").expect("a sample");
    for (name, across) in [
        ("Waist", [0, 2]),
        ("Shoulder", [1, 2]),
        ("Elbow", [1, 2]),
        ("ForearmRoll", [0, 2]),
        ("Wrist", [1, 2]),
        ("ToolRoll", [0, 2]),
    ] {
        let axis = joint(&motion, name);
        for frame in 0..motion.frame_count() {
            let turn = motion.rotation(frame, axis).to_array();
            assert!(across.iter().all(|&part| turn[part].abs() < 1e-6), "{name}");
        }
    }
    let global = motion.to_global();
    let tip = joint(&motion, "ToolRoll_end");
    let at = |secs: usize| global.position(secs * 60, tip);
    // It rests at the pick from 5.82 s to 6.36 s, at the place from 2.82 s to 3.3 s.
    let pick = Vec3::new(0.72 * (-0.75_f32).sin(), 0.10, 0.72 * 0.75_f32.cos());
    let place = Vec3::new(0.62 * 1.05_f32.sin(), 0.28, 0.62 * 1.05_f32.cos());
    for (secs, expected) in [(0, pick), (3, place), (6, pick), (9, place), (12, pick)] {
        assert!(
            (at(secs) - expected).length() < 1e-4,
            "at {secs} s: {}",
            at(secs)
        );
    }
    // An industrial arm's axes reach 200 to 400 degrees a second.
    for &axis in motion.rotated_joints() {
        for frame in 1..motion.frame_count() {
            let turned = motion
                .rotation(frame - 1, axis)
                .angle_between(motion.rotation(frame, axis));
            assert!(
                turned.to_degrees() * 60.0 < 200.0,
                "axis {} at {frame}",
                axis.index()
            );
        }
    }
    let tool = global.orientation(0, joint(&motion, "ToolRoll")) * Vec3::Y;
    assert!((tool - Vec3::NEG_Y).length() < 1e-5);
    for frame in 0..motion.frame_count() {
        let tip = global.position(frame, tip);
        assert!(tip.y > 0.099 && tip.x.hypot(tip.z) > 0.5);
    }
}

#[test]
fn what_is_out_of_range_is_named() {
    let fast = WalkConfig {
        speed_m_per_s: 9.0,
        ..WalkConfig::default()
    };
    let error = walk(&fast).map(|_| ()).expect_err("too fast for a walk");
    assert_eq!(
        error.to_string(),
        "`speed_m_per_s` is 9; it must be from 0.6 to 2"
    );
    let nan = ArmConfig {
        cycle_secs: f64::NAN,
        ..ArmConfig::default()
    };
    assert!(matches!(
        arm(&nan),
        Err(SampleError::OutOfRange {
            field: "cycle_secs",
            ..
        })
    ));
}

#[test]
fn every_name_has_a_sample() {
    for (name, line) in posekit::sample::NAMES {
        let motion = by_name(name).expect(name);
        assert!(motion.frame_count() > 100 && !line.is_empty());
    }
    let humanoid = posekit::sample::humanoid();
    assert_eq!(humanoid.joint_count(), 25);
    assert_eq!(humanoid.symmetric_pairs().len(), 10);
    assert!(posekit::sample::robot_arm().symmetric_pairs().is_empty());
}

#[test]
fn the_debug_text_of_a_motion_tells_its_size_and_not_every_number() {
    let motion = posekit::sample::walk(&posekit::sample::WalkConfig::default()).unwrap();
    for text in [format!("{motion:?}"), format!("{:?}", motion.to_global())] {
        let frames = format!("frames: {}", motion.frame_count());
        assert!(text.contains(&frames) && text.len() < 200, "{text}");
    }
}
