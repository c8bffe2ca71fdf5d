//! Channels against the curves that they are made of, and edits against what was asked.

mod euler;

use std::collections::BTreeSet;

use glam::{DQuat, DVec3};
use posekit::keyframe::{EulerTrack, Extrapolation, Interpolation, Keyframe, Tangents, Track};
use posekit::rotation::{EulerOrder, angle_between, exp};
use proptest::prelude::*;

use super::*;

const ORDERS: [EulerOrder; 4] = [
    EulerOrder::ZXY,
    EulerOrder::XYZ,
    EulerOrder::YXZ,
    EulerOrder::ZYX,
];

fn interpolation() -> impl Strategy<Value = Interpolation> {
    prop::sample::select(vec![
        Interpolation::Step,
        Interpolation::Linear,
        Interpolation::Cubic,
        Interpolation::Cubic,
        Interpolation::Squad,
    ])
}

fn extrapolation() -> impl Strategy<Value = Extrapolation> {
    prop::sample::select(vec![
        Extrapolation::Hold,
        Extrapolation::Cycle,
        Extrapolation::CycleWithOffset,
        Extrapolation::PingPong,
    ])
}

fn vector() -> impl Strategy<Value = DVec3> {
    [-2.0..2.0, -2.0..2.0, -2.0..2.0f64].prop_map(DVec3::from_array)
}

/// Orientations whose angles lie well within what an order tells apart.
fn angles(most_deg: f64) -> impl Strategy<Value = [f64; 3]> {
    [
        -most_deg..most_deg,
        -most_deg..most_deg,
        -most_deg..most_deg,
    ]
}

/// What kind of tangents, and two angular velocities for those set by hand.
type Slopes = (u8, DVec3, DVec3);

fn slopes() -> impl Strategy<Value = Slopes> {
    (0..5u8, vector(), vector())
}

fn tangents<V: Copy>((kind, _, _): Slopes, [incoming, outgoing]: [V; 2]) -> Tangents<V> {
    match kind {
        0 => Tangents::Auto,
        1 => Tangents::Smooth,
        2 => Tangents::Flat,
        3 => Tangents::Aligned(outgoing),
        _ => Tangents::Broken { incoming, outgoing },
    }
}

type Key<T> = (f64, T, Interpolation, Slopes);

fn keys<T: std::fmt::Debug>(value: impl Strategy<Value = T>) -> impl Strategy<Value = Vec<Key<T>>> {
    prop::collection::vec((0.1..1.0f64, value, interpolation(), slopes()), 2..6)
}

fn track_of<T: Copy, V: posekit::keyframe::KeyValue>(
    keys: &[Key<T>],
    ends: [Extrapolation; 2],
    value: impl Fn(T) -> V,
    slope: impl Fn(V, DVec3) -> V,
) -> Track<V> {
    let mut time_secs = -0.5;
    let keys = keys.iter().map(|&(gap, given, interpolation, slopes)| {
        time_secs += gap;
        let value = value(given);
        Keyframe {
            time_secs,
            value,
            interpolation,
            tangents: tangents(slopes, [slopes.1, slopes.2].map(|s| slope(value, s))),
        }
    });
    Track::with_ends(keys.collect(), ends[0], ends[1]).expect("the keys are valid")
}

fn orientation_track(
    keys: &[Key<[f64; 3]>],
    order: EulerOrder,
    ends: [Extrapolation; 2],
) -> Channels {
    let value = |angles: [f64; 3]| order.to_quat(angles.map(f64::to_radians));
    let track = track_of(keys, ends, value, |value, slope| {
        posekit::keyframe::tangent_of_angular_velocity(value, slope)
    });
    Channels::of(track.into(), order, [0.0; 3])
}

fn vector_track(keys: &[Key<DVec3>], ends: [Extrapolation; 2]) -> Channels {
    let track = track_of(keys, ends, |v| v, |_, slope| slope);
    Channels::of(track.into(), EulerOrder::ZXY, [0.0; 3])
}

/// The whole curve, finely.
fn curve(channels: &Channels) -> Vec<[f64; 3]> {
    let times = channels.times_secs();
    let span = [times[0] - 0.4, times[times.len() - 1] + 0.4];
    channels.sampled(span, 0.01).values
}

fn is_near(a: &[[f64; 3]], b: &[[f64; 3]], tolerance: f64) -> bool {
    let flat = |values: &[[f64; 3]]| values.concat();
    let pairs = flat(a).into_iter().zip(flat(b));
    a.len() == b.len() && pairs.into_iter().all(|(a, b)| (a - b).abs() <= tolerance)
}

proptest! {
    /// The angles that are shown make the orientation that is sampled.
    #[test]
    fn angles_are_those_of_the_curve(
        keys in keys(angles(170.0)),
        order in prop::sample::select(ORDERS.to_vec()),
        ends in [extrapolation(), extrapolation()],
        time in -3.0..6.0f64,
    ) {
        let channels = orientation_track(&keys, order, ends);
        let TrackValue::Orientation(track) = channels.track() else { unreachable!() };
        let shown = order.to_quat(channels.at(time).map(f64::to_radians));
        prop_assert!(angle_between(shown, track.sample(time)) < 1e-6);
    }

    /// Where the curve moves smoothly, the angles do: no jump of a turn, whatever the cycle.
    #[test]
    fn angles_do_not_jump_where_nothing_does(
        turns in prop::collection::vec(0.3..2.6f64, 2..8),
        sign in prop::sample::select(vec![-1.0, 1.0]),
        axis in 0..3usize,
        after in prop::sample::select(vec![Extrapolation::Hold, Extrapolation::CycleWithOffset]),
    ) {
        // About one axis on and on: the angle of that axis is the sum of all turns.
        let order = EulerOrder::ZXY;
        let about = order.axes()[axis].unit();
        let mut angle = 0.0;
        let mut track_keys = vec![Keyframe::new(0.0, DQuat::IDENTITY, Interpolation::Linear)];
        for (index, turn) in turns.iter().enumerate() {
            angle += sign * turn;
            let time = crate::state::clip::index_to_f64(index + 1);
            track_keys.push(Keyframe::new(time, exp(about * angle), Interpolation::Linear));
        }
        let last = track_keys.len() - 1;
        let end = track_keys[last].time_secs;
        let track = Track::new(track_keys, after).expect("valid");
        let channels = Channels::of(track.into(), order, [0.0; 3]);
        prop_assert!((channels.at_key(last)[axis] - angle.to_degrees()).abs() < 1e-6);
        if after == Extrapolation::CycleWithOffset {
            let beyond = channels.at(end * 3.0)[axis];
            prop_assert!((beyond - 3.0 * angle.to_degrees()).abs() < 1e-6, "{beyond}");
        }
    }

    /// Slopes are those of the curve beside the key, by differences of what is drawn.
    #[test]
    fn slopes_are_those_of_what_is_drawn(
        keys in keys(angles(70.0)),
        order in prop::sample::select(ORDERS.to_vec()),
    ) {
        let channels = orientation_track(&keys, order, [Extrapolation::Hold; 2]);
        slopes_agree(&channels, 2e-2)?;
    }

    #[test]
    fn slopes_of_vectors_are_those_of_what_is_drawn(keys in keys(vector())) {
        slopes_agree(&vector_track(&keys, [Extrapolation::Hold; 2]), 1e-3)?;
    }

    /// A dragged dot stands where it was put, and the key's other channels where they were.
    #[test]
    fn a_moved_dot_is_where_it_was_put(
        keys in keys(angles(60.0)),
        order in prop::sample::select(ORDERS.to_vec()),
        key in 0..6usize,
        channel in 0..3usize,
        by in -25.0..25.0f64,
    ) {
        let channels = orientation_track(&keys, order, [Extrapolation::Hold; 2]);
        let key = key % keys.len();
        let dot = Dot { key, channel };
        let edited = move_dots(&channels, &[dot], 0.0, by).expect("valid");
        let after = Channels::of(edited.track, order, [0.0; 3]);
        let mut asked = channels.at_key(key);
        asked[channel] += by;
        // The same angles, or if the way there went round the other side, the same orientation.
        let [shown, wanted] = [after.at_key(key), asked].map(|a| order.to_quat(a.map(f64::to_radians)));
        prop_assert!(angle_between(shown, wanted) < 1e-6);
        let near = order.closest_equivalent_deg(after.at_key(key), asked);
        prop_assert!(is_near(&[near], &[asked], 1e-5), "{near:?} {asked:?}");
        for other in (0..keys.len()).filter(|other| *other != key) {
            let [was, is] = [&channels, &after].map(|c| order.to_quat(c.at_key(other).map(f64::to_radians)));
            prop_assert!(angle_between(was, is) < 1e-6);
        }
    }

    /// Within the range in which angles are told apart they are literally what was asked.
    #[test]
    fn small_angles_are_what_was_asked(
        keys in keys(angles(25.0)),
        key in 0..6usize,
        channel in 0..3usize,
        by in -15.0..15.0f64,
    ) {
        let keys: Vec<_> = keys.into_iter().map(|(t, v, _, s)| (t, v, Interpolation::Linear, s)).collect();
        let order = EulerOrder::ZXY;
        let channels = orientation_track(&keys, order, [Extrapolation::Hold; 2]);
        let key = key % keys.len();
        let edited = move_dots(&channels, &[Dot { key, channel }], 0.0, by).expect("valid");
        let after = Channels::of(edited.track, order, [0.0; 3]);
        let mut asked = channels.at_key(key);
        asked[channel] += by;
        prop_assert!(is_near(&[after.at_key(key)], &[asked], 1e-6));
    }

    /// The slopes of a moved key that were set by hand stay what they are.
    #[test]
    fn moving_a_dot_keeps_slopes_set_by_hand(
        keys in keys(angles(40.0)),
        key in 0..6usize,
        channel in 0..3usize,
        by in -15.0..15.0f64,
    ) {
        let keys: Vec<_> = keys.into_iter().map(|(t, v, i, s)| (t, v, i, (3 + s.0 % 2, s.1, s.2))).collect();
        let order = EulerOrder::YXZ;
        let channels = orientation_track(&keys, order, [Extrapolation::Hold; 2]);
        let key = key % keys.len();
        let edited = move_dots(&channels, &[Dot { key, channel }], 0.0, by).expect("valid");
        let after = Channels::of(edited.track, order, [0.0; 3]);
        let mut asked = channels.at_key(key);
        asked[channel] += by;
        // A curve that swings out between its keys may come back in the other angles of the same orientation, in which
        // the middle one runs the other way.
        let turned = (after.at_key(key)[0] - asked[0]).rem_euclid(360.0);
        let is_other = (90.0..270.0).contains(&turned);
        let (before, after) = (channels.slopes(key), after.slopes(key));
        let (Some(mut before), Some(after)) = (before, after) else { return Ok(()) };
        if is_other {
            before.iter_mut().for_each(|slopes| slopes[1] = -slopes[1]);
        }
        prop_assert!(is_near(&before, &after, 1e-5 * (1.0 + before.concat().iter().fold(0.0f64, |m, s| m.max(s.abs())))), "{before:?} {after:?}");
    }

    /// There and back again: the same curve.
    #[test]
    fn a_dot_that_is_moved_back_gives_the_same_curve(
        keys in keys(angles(60.0)),
        key in 0..6usize,
        channel in 0..3usize,
        by in -20.0..20.0f64,
        secs in -0.05..0.05f64,
    ) {
        let order = EulerOrder::ZXY;
        let channels = orientation_track(&keys, order, [Extrapolation::PingPong; 2]);
        let key = key % keys.len();
        let dot = Dot { key, channel };
        let there = move_dots(&channels, &[dot], secs, by).expect("valid");
        let key = there.keys[&key];
        let there = Channels::of(there.track, order, [0.0; 3]);
        // The way to the key may go round the other side there: then its angles are others.
        let mut asked = channels.at_key(dot.key);
        asked[channel] += by;
        prop_assume!(is_near(&[there.at_key(key)], &[asked], 1e-5));
        let back = move_dots(&there, &[Dot { key, channel }], -secs, -by).expect("valid");
        let back = Channels::of(back.track, order, [0.0; 3]);
        let rotations = |channels: &Channels| -> Vec<DQuat> {
            curve(channels).iter().map(|a| order.to_quat(a.map(f64::to_radians))).collect()
        };
        let apart = rotations(&channels).into_iter().zip(rotations(&back)).map(|(a, b)| angle_between(a, b));
        prop_assert!(apart.fold(0.0f64, f64::max) < 1e-5);
    }

    /// A dragged handle lies where it was dragged; the other channels' handles stay.
    #[test]
    fn a_dragged_handle_is_where_it_was_put(
        keys in keys(angles(60.0)),
        order in prop::sample::select(ORDERS.to_vec()),
        key in 0..6usize,
        channel in 0..3usize,
        is_incoming in any::<bool>(),
        slope in -200.0..200.0f64,
    ) {
        let channels = orientation_track(&keys, order, [Extrapolation::Hold; 2]);
        let key = key % keys.len();
        let side = if is_incoming { Side::Incoming } else { Side::Outgoing };
        let Some(before) = channels.slopes(key) else { return Ok(()) };
        // A handle of quaternions, a third of its segment long, holds less than half a turn.
        let times = channels.times_secs();
        let around = &times[key.saturating_sub(1)..times.len().min(key + 2)];
        let longest_secs = around.windows(2).map(|span| span[1] - span[0]).fold(0.0, f64::max);
        let fastest = before.concat().iter().map(|slope| slope.abs()).sum::<f64>() + slope.abs();
        prop_assume!(fastest * longest_secs / 3.0 < 170.0);
        let kind = channels.tangent_kind(key);
        let edited = drag_handle(&channels, Dot { key, channel }, side, slope).expect("valid");
        let after_channels = Channels::of(edited.track, order, [0.0; 3]);
        let Some(after) = after_channels.slopes(key) else { return Ok(()) };
        let mut asked = before;
        if kind == TangentKind::Broken {
            asked[side.index()][channel] = slope;
        } else {
            asked = [before[side.index()]; 2];
            asked[0][channel] = slope;
            asked[1][channel] = slope;
            prop_assert_eq!(after_channels.tangent_kind(key), TangentKind::Aligned);
        }
        prop_assert!(is_near(&after, &asked, 1e-5 * (1.0 + slope.abs() + before.concat().iter().fold(0.0f64, |m, s| m.max(s.abs())))), "{after:?} {asked:?}");
        if let Some([secs, value]) = after_channels.handle(key, channel, side) {
            let from = [after_channels.times_secs()[key], after_channels.at_key(key)[channel]];
            let back = (value - from[1]) / (secs - from[0]);
            prop_assert!((back - slope).abs() < 1e-4 * (1.0 + slope.abs()));
        }
    }

    /// A handle that is dragged there and back gives the same curve, for tangents set by hand.
    #[test]
    fn a_handle_that_is_dragged_back_gives_the_same_curve(
        keys in keys(angles(60.0)),
        key in 0..6usize,
        channel in 0..3usize,
        slope in -200.0..200.0f64,
    ) {
        let keys: Vec<_> = keys.into_iter().map(|(t, v, i, s)| (t, v, i, (3 + s.0 % 2, s.1, s.2))).collect();
        let order = EulerOrder::ZXY;
        let channels = orientation_track(&keys, order, [Extrapolation::Cycle; 2]);
        let dot = Dot { key: key % keys.len(), channel };
        let Some(slopes) = channels.slopes(dot.key) else { return Ok(()) };
        let there = drag_handle(&channels, dot, Side::Outgoing, slope).expect("valid");
        let there = Channels::of(there.track, order, [0.0; 3]);
        prop_assume!(is_near(&[there.at_key(dot.key)], &[channels.at_key(dot.key)], 1e-5));
        let back = drag_handle(&there, dot, Side::Outgoing, slopes[1][channel]).expect("valid");
        let back = Channels::of(back.track, order, [0.0; 3]);
        prop_assert!(is_near(&curve(&channels), &curve(&back), 1e-4));
    }

    /// A curve that is scaled by hand-set slopes keeps its shape; the scaled values are those asked for.
    #[test]
    fn a_scaled_curve_keeps_its_shape(
        keys in keys(vector()),
        pivot in [-1.0..1.0f64, -1.0..1.0f64],
        time in 0.2..3.0f64,
        value in -2.0..2.0f64,
    ) {
        let keys: Vec<_> = keys.into_iter().map(|(t, v, i, s)| (t, v, i, (3 + s.0 % 2, s.1, s.2))).collect();
        let channels = vector_track(&keys, [Extrapolation::Hold; 2]);
        let every = |channel| (0..keys.len()).map(move |key| Dot { key, channel });
        let dots: Vec<Dot> = every(1).collect();
        let scaling = Scaling { pivot, time, value };
        let edited = scale_dots(&channels, &dots, scaling).expect("valid");
        let after = Channels::of(edited.track, EulerOrder::ZXY, [0.0; 3]);
        let times = channels.times_secs();
        let [start, end] = [times[0], times[times.len() - 1]];
        for step in 0..=50u8 {
            // Squad's slopes come from the neighbours and scale with them.
            let at = start + (end - start) * f64::from(step) / 50.0;
            let before = channels.at(at);
            let scaled = after.at(pivot[0] + (at - pivot[0]) * time);
            let near_key = times.iter().any(|key| (key - at).abs() < 1e-9);
            if near_key { continue }
            prop_assert!((scaled[1] - (pivot[1] + (before[1] - pivot[1]) * value)).abs() < 1e-6);
            prop_assert!((scaled[0] - before[0]).abs() < 1e-6);
        }
    }

    /// Where keys pass each other, the map of indices says where each has gone.
    #[test]
    fn moved_keys_are_found_again(keys in keys(vector()), key in 0..6usize, by in -2.0..2.0f64) {
        let channels = vector_track(&keys, [Extrapolation::Hold; 2]);
        let key = key % keys.len();
        let edited = move_dots(&channels, &[Dot { key, channel: 0 }], by, 0.0).expect("valid");
        let after = Channels::of(edited.track, EulerOrder::ZXY, [0.0; 3]);
        for (old, new) in &edited.keys {
            let by = if *old == key { by } else { 0.0 };
            prop_assert!((after.times_secs()[*new] - channels.times_secs()[*old] - by).abs() < 1e-12);
            prop_assert_eq!(after.at_key(*new), channels.at_key(*old));
        }
        prop_assert_eq!(edited.keys.len(), after.times_secs().len());
    }

    /// Choosing tangents does not move keys, and those set by hand begin as they were.
    #[test]
    fn tangents_set_by_hand_begin_as_they_were(keys in keys(angles(60.0)), kind in 3..5usize) {
        let order = EulerOrder::ZXY;
        let channels = orientation_track(&keys, order, [Extrapolation::Hold; 2]);
        let all: BTreeSet<usize> = (0..keys.len()).collect();
        let kind = TangentKind::ALL[kind];
        let edited = set_tangents(channels.track(), &all, kind).expect("valid");
        let after = Channels::of(edited.track, order, [0.0; 3]);
        for key in all {
            prop_assert_eq!(after.tangent_kind(key), kind);
            let (Some(before), Some(after)) = (channels.slopes(key), after.slopes(key)) else { continue };
            let aligned = before[0] == before[1];
            if aligned || kind == TangentKind::Broken {
                prop_assert!(is_near(&before, &after, 1e-6), "{before:?} {after:?}");
            }
        }
    }
}

/// Handles against differences of the drawn curve, on cubic segments.
fn slopes_agree(channels: &Channels, tolerance: f64) -> Result<(), TestCaseError> {
    const STEP: f64 = 1e-5;
    for key in 0..channels.times_secs().len() {
        for side in Side::BOTH {
            let Some(secs) = channels.cubic_secs(key, side) else {
                continue;
            };
            let Some(slopes) = channels.slopes(key) else {
                continue;
            };
            let time = channels.times_secs()[key];
            // Just before a key its own value counts, not that after a jump.
            let here = match side {
                Side::Incoming => channels.at(time.next_down()),
                Side::Outgoing => channels.at(time),
            };
            let [near, far] =
                [1.0, 2.0].map(|steps| channels.at(time + side.sign() * steps * STEP));
            for channel in 0..channels.count() {
                // The difference that is exact for parabolas.
                let change = 4.0 * near[channel] - 3.0 * here[channel] - far[channel];
                let drawn = change / (2.0 * side.sign() * STEP);
                let slope = slopes[side.index()][channel];
                prop_assert!(
                    (drawn - slope).abs() < tolerance * (1.0 + slope.abs()),
                    "key {key}, channel {channel}, {side:?}: {drawn} drawn, {slope} said"
                );
                let handle = channels.handle(key, channel, side);
                let [at, value] = handle.expect("a cubic segment has a handle");
                prop_assert!(((at - time).abs() - secs / 3.0).abs() < 1e-12);
                let reach = at - time;
                prop_assert!((value - channels.at_key(key)[channel] - slope * reach).abs() < 1e-9);
            }
        }
    }
    Ok(())
}

#[test]
fn steps_are_drawn_with_both_their_values() {
    let keys = [(0.0, 1.0), (1.0, 5.0)].map(|(t, v)| Keyframe::new(t, v, Interpolation::Step));
    let track = Track::new(keys.to_vec(), Extrapolation::Hold).expect("valid");
    let channels = Channels::of(TrackValue::Number(track), EulerOrder::ZXY, [0.0; 3]);
    let sampled = channels.sampled([-1.0, 2.0], 0.3);
    let at_one: Vec<f64> = sampled
        .times_secs
        .iter()
        .zip(&sampled.values)
        .filter(|(time, _)| (**time - 1.0).abs() < 1e-9)
        .map(|(_, values)| values[0])
        .collect();
    assert_eq!(at_one, [1.0, 5.0]);
    assert_eq!(sampled.extent(0), Some([1.0, 5.0]));
    let within = &sampled.times_secs[sampled.within.clone()];
    assert_eq!((within[0], within[within.len() - 1]), (0.0, 1.0));
}

#[test]
fn there_are_no_handles_next_to_gimbal_lock() {
    let order = EulerOrder::ZXY;
    let key = |time, angles: [f64; 3]| {
        Keyframe::new(
            time,
            order.to_quat(angles.map(f64::to_radians)),
            Interpolation::Cubic,
        )
    };
    let keys = vec![
        key(0.0, [0.0; 3]),
        key(1.0, [10.0, 89.5, 20.0]),
        key(2.0, [20.0, 10.0, 0.0]),
    ];
    let track = Track::new(keys, Extrapolation::Hold).expect("valid");
    let channels = Channels::of(track.into(), order, [0.0; 3]);
    assert!(channels.handle(0, 1, Side::Outgoing).is_some());
    assert_eq!(channels.handle(1, 1, Side::Outgoing), None);
    // Its value can be dragged all the same.
    let edited = move_dots(&channels, &[Dot { key: 1, channel: 1 }], 0.0, -30.0).expect("valid");
    let after = Channels::of(edited.track, order, [0.0; 3]);
    assert!((after.at_key(1)[1] - 59.5).abs() < 1e-6);
}
