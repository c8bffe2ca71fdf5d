//! What holds for every track: keys are met, curves are smooth, automatic tangents do not overshoot,
//! and what happens beyond the ends.

use glam::{DQuat, DVec3};
use posekit::keyframe::{
    Extrapolation, Interpolation, Keyframe, Tangents, Track, TrackError,
    angular_velocity_of_tangent, tangent_of_angular_velocity,
};
use posekit::rotation::{angle_between, angular_velocity_in_body, exp};
use proptest::collection::vec;
use proptest::prelude::*;

use super::track;

const WAYS: [Interpolation; 4] = [
    Interpolation::Step,
    Interpolation::Linear,
    Interpolation::Cubic,
    Interpolation::Squad,
];

fn times() -> impl Strategy<Value = Vec<f64>> {
    vec(0.02_f64..2.0, 1..12).prop_map(|gaps| {
        let mut now = -3.0;
        let rising = gaps.into_iter().map(|gap| {
            now += gap;
            now
        });
        rising.collect()
    })
}

fn orientation() -> impl Strategy<Value = DQuat> {
    (vec(-1.0_f64..1.0, 4), prop::bool::ANY).prop_filter_map("near zero", |(parts, flip)| {
        let raw = DQuat::from_xyzw(parts[0], parts[1], parts[2], parts[3]);
        let unit = (raw.length() > 0.1).then(|| raw.normalize())?;
        Some(if flip { -unit } else { unit })
    })
}

/// Keys of orientations, each within a turn of 2 rad of the one before, signs at random.
fn orientation_keys() -> impl Strategy<Value = (Vec<f64>, Vec<DQuat>)> {
    times().prop_flat_map(|times| {
        let turns = vec((vec(-1.1_f64..1.1, 3), prop::bool::ANY), times.len());
        (Just(times), orientation(), turns).prop_map(|(times, first, turns)| {
            let mut now = first;
            let values = turns.into_iter().map(|(turn, flip)| {
                now *= exp(DVec3::new(turn[0], turn[1], turn[2]));
                now = now.normalize();
                if flip { -now } else { now }
            });
            let values = values.collect();
            (times, values)
        })
    })
}

proptest! {
    #[test]
    fn keys_are_met_and_everything_is_a_rotation((times, values) in orientation_keys()) {
        for way in WAYS {
            let track = track(&times, &values, way);
            for (&time, &value) in times.iter().zip(&values) {
                prop_assert!(angle_between(track.sample(time), value) < 1e-9);
            }
            let (start, end) = (track.start_secs(), track.end_secs());
            for step in -5..=55 {
                let time = start + (end - start) * f64::from(step) / 50.0;
                prop_assert!((track.sample(time).length() - 1.0).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn signs_of_quaternions_mean_nothing((times, values) in orientation_keys(), flips in vec(prop::bool::ANY, 12)) {
        let flipped: Vec<DQuat> = values.iter().zip(flips)
            .map(|(&value, flip)| if flip { -value } else { value }).collect();
        for way in WAYS {
            let (a, b) = (track(&times, &values, way), track(&times, &flipped, way));
            for step in 0..=40 {
                let time = a.start_secs() + (a.end_secs() - a.start_secs()) * f64::from(step) / 40.0;
                prop_assert!(angle_between(a.sample(time), b.sample(time)) < 1e-9);
            }
        }
    }

    /// The angular velocity just before and just after each inner key is the same, however the keys
    /// are spaced.
    #[test]
    fn cubic_and_squad_are_c1((times, values) in orientation_keys(), tangent_kind in 0..2_usize) {
        let tangents = [Tangents::Auto, Tangents::Smooth][tangent_kind];
        for way in [Interpolation::Cubic, Interpolation::Squad] {
            let keys = times.iter().zip(&values).map(|(&time, &value)| Keyframe {
                tangents, ..Keyframe::new(time, value, way)
            });
            let track = Track::new(keys.collect(), Extrapolation::Hold).unwrap();
            for &time in &times[1..times.len().max(2) - 1] {
                let h = 1e-6;
                let [a, b, c] = [-h, 0.0, h].map(|step| track.sample(time + step));
                let before = angular_velocity_in_body(a, b, h);
                let after = angular_velocity_in_body(b, c, h);
                prop_assert!((before - after).length() < 1e-2 * (1.0 + before.length()),
                    "{way:?}: {before} before, {after} after {time} s of {times:?}");
            }
        }
    }

    #[test]
    fn automatic_tangents_do_not_overshoot(times in times(), seed in vec(-5.0_f64..5.0, 12)) {
        let values = &seed[..times.len()];
        let track = track(&times, values, Interpolation::Cubic);
        for (pair, ends) in times.windows(2).zip(values.windows(2)) {
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let mut previous = ends[0];
            for step in 0..=30 {
                let value = track.sample(pair[0] + (pair[1] - pair[0]) * f64::from(step) / 30.0);
                prop_assert!(value >= low - 1e-12 && value <= high + 1e-12);
                // It rises or falls all the way.
                prop_assert!((value - previous) * (ends[1] - ends[0]) >= -1e-12);
                previous = value;
            }
        }
    }

    #[test]
    fn tangents_and_angular_velocities_are_two_views(q in orientation(), w in vec(-9.0_f64..9.0, 3)) {
        let w = DVec3::new(w[0], w[1], w[2]);
        let tangent = tangent_of_angular_velocity(q, w);
        prop_assert!((angular_velocity_of_tangent(q, tangent) - w).length() < 1e-12);
        prop_assert!((angular_velocity_of_tangent(-q, -tangent) - w).length() < 1e-12);
    }

    #[test]
    fn cycles_repeat_and_move_on((times, values) in orientation_keys(), rounds in -3..4_i32) {
        prop_assume!(times.len() > 1);
        let keys: Vec<_> = times.iter().zip(&values)
            .map(|(&time, &value)| Keyframe::new(time, value, Interpolation::Cubic)).collect();
        let track = |beyond| Track::new(keys.clone(), beyond).unwrap();
        let (start, end) = (times[0], times[times.len() - 1]);
        let span = end - start;
        let step = values[values.len() - 1] * values[0].conjugate();
        for part in 1..10 {
            let inside = start + span * f64::from(part) / 10.0;
            let outside = inside + f64::from(rounds) * span;
            let cycled = track(Extrapolation::Cycle);
            prop_assert!(angle_between(cycled.sample(outside), cycled.sample(inside)) < 1e-6);
            let moved = track(Extrapolation::CycleWithOffset);
            let mut expected = moved.sample(inside);
            for _ in 0..rounds.abs() {
                let way = if rounds > 0 { step } else { step.conjugate() };
                expected = way * expected;
            }
            prop_assert!(angle_between(moved.sample(outside), expected) < 1e-6);
            let bounced = track(Extrapolation::PingPong);
            let mirrored = if rounds % 2 == 0 { inside } else { start + end - inside };
            prop_assert!(angle_between(bounced.sample(outside), bounced.sample(mirrored)) < 1e-6);
        }
    }
}

#[test]
fn a_cycle_with_offset_is_smooth_over_its_seam() {
    let keys = [(0.0, 0.0), (0.3, 1.0), (1.0, 1.5), (1.7, 4.0)];
    let keys = keys.map(|(t, v)| Keyframe {
        tangents: Tangents::Smooth,
        ..Keyframe::new(t, v, Interpolation::Cubic)
    });
    let track = Track::new(keys.to_vec(), Extrapolation::CycleWithOffset).unwrap();
    let h = 1e-6;
    for seam in [0.0, 1.7, 3.4] {
        let [before, at, after] = [seam - h, seam, seam + h].map(|t| track.sample(t));
        assert!((before + after - 2.0 * at).abs() / h < 1e-4, "at {seam}");
    }
    assert!((track.sample(1.7 + 0.3) - 5.0).abs() < 1e-12);
    assert!((track.sample(0.3 - 1.7) - -3.0).abs() < 1e-12);
}

#[test]
fn beyond_the_ends_values_hold_and_odd_times_do_no_harm() {
    let values = [DVec3::X, DVec3::Y * 2.0];
    for way in WAYS {
        for beyond in [
            Extrapolation::Hold,
            Extrapolation::Cycle,
            Extrapolation::CycleWithOffset,
            Extrapolation::PingPong,
        ] {
            let keys = [1.0, 2.0].iter().zip(values);
            let keys = keys.map(|(&t, v)| Keyframe::new(t, v, way));
            let track = Track::new(keys.collect(), beyond).unwrap();
            for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
                assert!(track.sample(odd).is_finite());
            }
            assert_eq!(track.sample(1.0), values[0]);
            assert_eq!(track.sample(2.0), values[1]);
        }
        let held = track(&[1.0, 2.0], &values, way);
        assert_eq!(held.sample(-9.0), values[0]);
        assert_eq!(held.sample(9.0), values[1]);
    }
    assert_eq!(Track::constant(3.0).unwrap().sample(f64::NAN), 3.0);
}

#[test]
fn what_is_no_track_is_refused_with_its_key() {
    let key = |time, value| Keyframe::new(time, value, Interpolation::Linear);
    let refused = |keys: Vec<Keyframe<DQuat>>| Track::new(keys, Extrapolation::Hold).unwrap_err();
    assert_eq!(refused(vec![]), TrackError::Empty);
    let one = DQuat::IDENTITY;
    assert!(matches!(
        refused(vec![key(1.0, one), key(1.0, one)]),
        TrackError::NotAscending { index: 1, .. }
    ));
    assert_eq!(
        refused(vec![key(f64::NAN, one)]),
        TrackError::TimeOutOfRange { index: 0 }
    );
    assert!(matches!(
        refused(vec![key(0.0, one), key(1.0, one * 1.1)]),
        TrackError::NotUnit { index: 1, .. }
    ));
    assert_eq!(
        refused(vec![key(0.0, one * f64::NAN)]),
        TrackError::ValueOutOfRange { index: 0 }
    );
    let bent = Keyframe {
        tangents: Tangents::Aligned(one * f64::INFINITY),
        ..key(0.0, one)
    };
    assert_eq!(
        refused(vec![bent]),
        TrackError::TangentOutOfRange { index: 0 }
    );
}
