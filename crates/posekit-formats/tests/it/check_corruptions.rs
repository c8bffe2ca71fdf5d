//! Every corruption that is put into a clip is found, and nothing else: on a walk that a procedure
//! makes, and on every real clip that is there.

use posekit::check::Severity;
use posekit_formats::bvh::{self, CheckEntry};

use crate::bvh_real_files::files;
use crate::check_clip::{Clip, check, clips, rotation_columns};
use crate::check_damage as damage;
use crate::walker::{self, Channels};

/// Tries something on all clips and says on which ones it failed.
fn on_all_clips(attempt: impl Fn(&Clip) -> Result<(), String>) {
    let failures: Vec<String> = clips()
        .iter()
        .filter_map(|clip| {
            attempt(clip)
                .err()
                .map(|error| format!("{}: {error}", clip.name))
        })
        .collect();
    assert!(
        failures.is_empty(),
        "{} failed:\n{}",
        failures.len(),
        failures.join("\n")
    );
}

#[test]
fn the_procedural_walk_is_clean() {
    for channels in [Channels::Three, Channels::Six] {
        let found = check(&walker::walk(channels));
        let codes: Vec<&str> = found.iter().map(|entry| entry.code).collect();
        assert_eq!(codes, ["constant-channels"], "{found:#?}");
    }
}

#[test]
fn an_added_full_turn_is_a_flip() {
    on_all_clips(|clip| {
        let column = rotation_columns(&clip.bvh, clip.free_joint)[0];
        let frames = clip.middle()..clip.middle() + 9;
        let flipped = clip.changed(|frame, row| {
            if frames.contains(&frame) {
                row[column] += 360.0;
            }
        });
        clip.expect(
            &flipped,
            "euler-flip",
            Some(clip.free_joint),
            Some(frames.start),
        )
    });
}

#[test]
fn the_other_euler_solution_is_a_flip() {
    on_all_clips(|clip| {
        let columns = rotation_columns(&clip.bvh, clip.free_joint);
        let frames = clip.middle()..clip.middle() + 9;
        let flipped = clip.changed(|frame, row| {
            if frames.contains(&frame) {
                row[columns[0]] += 180.0;
                row[columns[1]] = 180.0 - row[columns[1]];
                row[columns[2]] -= 180.0;
            }
        });
        clip.expect(
            &flipped,
            "euler-flip",
            Some(clip.free_joint),
            Some(frames.start),
        )
    });
}

#[test]
fn poses_held_on_purpose_are_worth_knowing_and_no_warning() {
    // A figure without feet, and one that slows down into the hold and speeds up out of it.
    let mut arm = String::from(
        "HIERARCHY ROOT base { OFFSET 0 0 0 CHANNELS 1 Zrotation JOINT elbow { OFFSET 1 0 0 \
         CHANNELS 1 Zrotation End Site { OFFSET 1 0 0 } } } MOTION Frames: 90 Frame Time: 0.02\n",
    );
    for frame in 0..90_i32 {
        let angle = (frame % 30).min(15) + 15 * (frame / 30);
        arm += &format!("{angle} {}\n", -angle);
    }
    let arm = bvh::read(arm.as_bytes()).unwrap().document;
    let walk = Clip::new("a walk", walker::walk(Channels::Three));
    let held = eased_hold(&walk);
    for (bvh, times) in [(&arm, "2 times"), (&held, "once")] {
        let found = check(bvh);
        let holds: Vec<&CheckEntry> = found
            .iter()
            .filter(|entry| entry.code == "frozen-frames")
            .collect();
        assert_eq!(holds.len(), 1, "{found:#?}");
        assert_eq!(holds[0].severity, Severity::Info);
        assert!(holds[0].message.contains(times), "{}", holds[0].message);
    }
}

/// The first second of a walk, slowed down to a hold of 20 frames at its end, and on again.
fn eased_hold(walk: &Clip) -> bvh::Bvh {
    let mut held = walk.bvh.clone();
    let motion = held.motion.as_mut().unwrap();
    motion.values.clear();
    // The place in the walk that is shown: its speed goes to 0 and comes back.
    let place = |frame: i32| match frame {
        ..60 => f64::from(frame),
        60..100 => 60.0 + 20.0 * ease(f64::from(frame - 60) / 40.0),
        100..120 => 80.0,
        120..160 => 80.0 + 20.0 * (1.0 - ease(1.0 - f64::from(frame - 120) / 40.0)),
        _ => 100.0 + f64::from(frame - 160),
    };
    motion.frame_count = 240;
    for frame in 0..240 {
        let at = place(frame);
        let before = at.floor();
        let share = at - before;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a frame of the walk"
        )]
        let row = before as usize;
        let pairs = walk.bvh.row(row).iter().zip(walk.bvh.row(row + 1));
        motion
            .values
            .extend(pairs.map(|(a, b)| a + share * (b - a)));
    }
    held
}

/// From 0 to 1 with speed 2 at the beginning and 0 at the end.
fn ease(t: f64) -> f64 {
    1.0 - (1.0 - t) * (1.0 - t)
}

#[test]
fn every_fifth_frame_twice_is_a_frame_rate_conversion() {
    on_all_clips(|clip| {
        let mut repeated = clip.bvh.clone();
        let motion = repeated.motion.as_mut().unwrap();
        motion.values.clear();
        motion.frame_count = 0;
        for frame in 0..clip.frame_count() {
            let copies = if frame % 4 == 3 { 2 } else { 1 };
            motion.values.extend(clip.bvh.row(frame).repeat(copies));
            motion.frame_count += copies;
        }
        let found = check(&repeated);
        let entry = found
            .iter()
            .find(|entry| entry.code == "duplicate-frames")
            .ok_or("missed")?;
        let is_understood = entry.message.contains("one in every 5");
        if is_understood {
            Ok(())
        } else {
            Err(entry.message.clone())
        }
    });
}

#[test]
fn a_rotation_spike_of_one_to_three_frames_is_found() {
    on_all_clips(|clip| {
        for width in 1..=3 {
            let spiked = damage::rotation_spike(clip, 85.0, width);
            let joint = Some(clip.free_joint);
            clip.expect(&spiked, "rotation-spike", joint, Some(clip.middle()))?;
        }
        Ok(())
    });
}

#[test]
fn a_rotation_that_jumps_and_stays_is_found() {
    on_all_clips(|clip| {
        let jumped = damage::rotation_jump(clip, 80.0);
        let joint = Some(clip.free_joint);
        clip.expect(&jumped, "rotation-jump", joint, Some(clip.middle()))
    });
}

#[test]
fn a_teleport_is_found() {
    on_all_clips(|clip| {
        let teleported = damage::teleport(clip, 0.5);
        clip.expect(
            &teleported,
            "teleport",
            Some(clip.root),
            Some(clip.middle()),
        )
    });
}

#[test]
fn a_position_spike_is_found() {
    on_all_clips(|clip| {
        let spiked = damage::position_spike(clip, 0.4, 1);
        clip.expect(
            &spiked,
            "position-spike",
            Some(clip.root),
            Some(clip.middle()),
        )
    });
}

#[test]
fn a_freeze_is_found() {
    on_all_clips(|clip| {
        let frozen = damage::freeze(clip, 0.25);
        clip.expect(&frozen, "frozen-frames", None, Some(clip.middle()))?;
        let found = check(&frozen);
        let entry = found.iter().find(|entry| entry.code == "frozen-frames");
        // At the bottom of a bow a figure is nearly still: nobody sees that it is held there.
        let severity = entry.unwrap().severity;
        let moves = clip.is_walk() || clip.is_run();
        assert!(!moves || severity == Severity::Warning, "{}", clip.name);
        Ok(())
    });
}

#[test]
fn drifting_over_the_floor_is_foot_sliding() {
    on_all_clips(|clip| {
        // A runner's foot is on the floor too briefly for a slow drift to come to a hand's breadth.
        let slowest = if clip.is_run() { 4 } else { 2 };
        for tenths in slowest..=6 {
            let slid = damage::drift(clip, 0, 0.1 * f64::from(tenths));
            clip.expect(&slid, "foot-sliding", None, None)?;
        }
        Ok(())
    });
}

#[test]
fn walking_on_the_spot_is_one_finding_of_foot_sliding() {
    on_all_clips(|clip| {
        let Some(odd) = damage::on_the_spot(clip).filter(|_| clip.is_walk()) else {
            return Ok(());
        };
        clip.expect(&odd, "foot-sliding", None, None)
    });
    let walk = Clip::new("a walk", walker::walk(Channels::Three));
    let found = check(&damage::on_the_spot(&walk).unwrap());
    let slides: Vec<&CheckEntry> = found
        .iter()
        .filter(|entry| entry.code == "foot-sliding")
        .collect();
    assert_eq!(slides.len(), 1, "{slides:#?}");
    assert_eq!(slides[0].joints, ["LeftFoot", "RightFoot"]);
}

#[test]
fn feet_of_real_walks_and_runs_do_not_slide() {
    on_all_clips(|clip| {
        let slides = clip.found.iter().any(|entry| entry.code == "foot-sliding");
        if slides && (clip.is_walk() || clip.is_run()) {
            return Err(format!("{:#?}", clip.found));
        }
        Ok(())
    });
}

#[test]
fn sinking_into_the_floor_is_found() {
    on_all_clips(|clip| clip.expect(&damage::sink(clip, 0.15), "foot-below-floor", None, None));
}

#[test]
fn a_bone_that_stretches_is_found() {
    on_all_clips(|clip| {
        let Some(stretched) = damage::stretch(clip, 1.1) else {
            return Ok(());
        };
        let joint = Some(clip.free_joint);
        clip.expect(
            &stretched,
            "bone-length-changes",
            joint,
            Some(clip.middle()),
        )
    });
}

#[test]
fn steps_tell_a_wrong_playback_speed() {
    for channels in [Channels::Three, Channels::Six] {
        let walk = Clip::new("a walk", walker::walk(channels));
        for (times_too_fast, severity) in [
            (0.25, Severity::Warning),
            (0.5, Severity::Info),
            (2.0, Severity::Warning),
            (4.0, Severity::Warning),
        ] {
            let found = check(&damage::played(&walk, times_too_fast));
            let entry = found
                .iter()
                .find(|entry| entry.code == "playback-speed-implausible")
                .unwrap_or_else(|| panic!("{times_too_fast} missed"));
            let measured = entry.value / times_too_fast;
            assert!(
                (0.75..1.35).contains(&measured),
                "{times_too_fast}: {measured}"
            );
            assert_eq!(entry.severity, severity, "{}", entry.message);
            assert!(
                entry.message.contains("steps a second"),
                "{}",
                entry.message
            );
        }
    }
}

#[test]
fn no_real_clip_plays_at_a_wrong_speed() {
    on_all_clips(|clip| {
        let code = "playback-speed-implausible";
        match clip.found.iter().find(|entry| entry.code == code) {
            Some(entry) => Err(entry.message.clone()),
            None => Ok(()),
        }
    });
}

#[test]
fn frame_times_that_cannot_be_are_found() {
    on_all_clips(|clip| {
        for (secs, severity) in [
            (0.0, "error"),
            (60.0, "warning"),
            (1.0, "warning"),
            (0.00001, "warning"),
        ] {
            let mut odd = clip.bvh.clone();
            odd.motion.as_mut().unwrap().frame_time_secs = secs;
            let found = check(&odd);
            let entry = found
                .iter()
                .find(|entry| entry.code == "frame-time-implausible");
            let entry = entry.ok_or_else(|| format!("{secs} missed"))?;
            assert_eq!((entry.severity.name(), entry.value), (severity, secs));
        }
        Ok(())
    });
}

#[test]
fn jumps_tell_a_wrong_playback_speed() {
    for path in files()
        .iter()
        .filter(|path| path.ends_with("cmu/01_01.bvh"))
    {
        let bvh = bvh::read(&std::fs::read(path).unwrap()).unwrap().document;
        for times_too_fast in [0.25, 0.5, 2.0, 4.0] {
            let mut odd = bvh.clone();
            odd.motion.as_mut().unwrap().frame_time_secs /= times_too_fast;
            let found = check(&odd);
            let entry = found
                .iter()
                .find(|entry| entry.code == "playback-speed-implausible");
            let measured = entry.unwrap().value / times_too_fast;
            assert!(
                (measured - 1.0).abs() < 0.25,
                "{times_too_fast}: {measured}"
            );
        }
    }
}
