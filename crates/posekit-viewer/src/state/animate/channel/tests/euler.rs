//! Euler curves: handles that are free in time, and turns that stay whole.

use super::*;

/// Euler curves of these keys, in an order.
fn euler_track(keys: &[Key<DVec3>], order: EulerOrder, ends: [Extrapolation; 2]) -> Channels {
    let angles = track_of(keys, ends, |v| v * 100.0, |_, slope| slope * 50.0);
    let curves = EulerTrack::new(order, angles).expect("a whole order");
    Channels::of(TrackValue::Euler(curves), EulerOrder::XYZ, [0.0; 3])
}

proptest! {
    /// A handle that is free in time lies where it was dragged, as far as time goes on; the other channels'
    /// curves stay, and the other side of an aligned key lies on the same line.
    #[test]
    fn a_handle_of_a_curve_goes_where_it_is_dragged(
        keys in keys(vector()),
        order in prop::sample::select(ORDERS.to_vec()),
        key in 0..6usize,
        channel in 0..3usize,
        is_incoming in any::<bool>(),
        share in -0.5..1.5f64,
        value in -300.0..300.0f64,
    ) {
        let channels = euler_track(&keys, order, [Extrapolation::Hold; 2]);
        let key = key % keys.len();
        let side = if is_incoming { Side::Incoming } else { Side::Outgoing };
        let Some(secs) = channels.cubic_secs(key, side) else { return Ok(()) };
        let at = channels.times_secs()[key];
        let dot = Dot { key, channel };
        let place = [at + side.sign() * share * secs, value];
        let edited = drag_handle_to(&channels, dot, side, place).expect("valid");
        prop_assert!(matches!(edited.track, TrackValue::Euler(_)));
        let after = Channels::of(edited.track, order, [0.0; 3]);
        let kind = channels.tangent_kind(key);
        let least = if kind == TangentKind::Broken { 0.0 } else { 0.01 };
        let found = after.handle(key, channel, side).expect("it is a cubic");
        let expected = at + side.sign() * share.clamp(least, 1.0) * secs;
        prop_assert!((found[0] - expected).abs() < 1e-9, "{found:?} {expected}");
        prop_assert!((found[1] - value).abs() < 1e-9);
        let wanted = if kind == TangentKind::Broken { kind } else { TangentKind::Aligned };
        prop_assert_eq!(after.tangent_kind(key), wanted);
        let other = if is_incoming { Side::Outgoing } else { Side::Incoming };
        if let Some(opposite) = after.handle(key, channel, other)
            && kind != TangentKind::Broken
        {
            let from = [at, after.at_key(key)[channel]];
            let slope = |to: [f64; 2]| (to[1] - from[1]) / (to[0] - from[0]);
            let [a, b] = [slope(found), slope(opposite)];
            prop_assert!((a - b).abs() <= 1e-6 * (1.0 + a.abs()), "{a} {b}");
            let before = channels.handle(key, channel, other).expect("it was one before");
            prop_assert!((before[0] - opposite[0]).abs() < 1e-9, "it keeps its length in time");
        }
        let others = |channels: &Channels| -> Vec<[f64; 3]> {
            let mut all = curve(channels);
            all.iter_mut().for_each(|values| values[channel] = 0.0);
            all
        };
        // What was chosen from the neighbours is the same slope set by hand; broken sides stay.
        if matches!(kind, TangentKind::Aligned | TangentKind::Broken | TangentKind::Auto | TangentKind::Flat) {
            prop_assert!(is_near(&others(&channels), &others(&after), 1e-6));
        }
    }

    /// Moving and scaling dots of curves with free handles moves and scales the whole curve.
    #[test]
    fn curves_with_free_handles_are_scaled_as_they_look(
        keys in keys(vector()),
        share in 0.05..0.95f64,
        value in -300.0..300.0f64,
        time_factor in 0.3..3.0f64,
        value_factor in -2.0..2.0f64,
    ) {
        let keys: Vec<_> = keys.into_iter().map(|(t, v, _, s)| (t, v, Interpolation::Cubic, (3 + s.0 % 2, s.1, s.2))).collect();
        let channels = euler_track(&keys, EulerOrder::ZXY, [Extrapolation::Hold; 2]);
        let secs = channels.cubic_secs(0, Side::Outgoing).expect("cubic");
        let place = [channels.times_secs()[0] + share * secs, value];
        let dragged = drag_handle_to(&channels, Dot { key: 0, channel: 1 }, Side::Outgoing, place).expect("valid");
        let before = Channels::of(dragged.track, EulerOrder::ZXY, [0.0; 3]);
        let dots: Vec<Dot> = (0..keys.len()).map(|key| Dot { key, channel: 1 }).collect();
        let pivot = [channels.times_secs()[0], 0.0];
        let scaling = Scaling { pivot, time: time_factor, value: value_factor };
        let scaled = scale_dots(&before, &dots, scaling).expect("valid");
        let after = Channels::of(scaled.track, EulerOrder::ZXY, [0.0; 3]);
        let moved = move_dots(&before, &dots, 0.25, 30.0).expect("valid");
        let moved = Channels::of(moved.track, EulerOrder::ZXY, [0.0; 3]);
        let end = channels.times_secs()[keys.len() - 1];
        for step in 0..=40 {
            let time = pivot[0] + (end - pivot[0]) * f64::from(step) / 40.0;
            let expected = before.at(time)[1];
            let there = after.at(pivot[0] + (time - pivot[0]) * time_factor)[1];
            prop_assert!((there - expected * value_factor).abs() < 1e-4 * (1.0 + expected.abs()));
            prop_assert!((moved.at(time + 0.25)[1] - expected - 30.0).abs() < 1e-4 * (1.0 + expected.abs()));
        }
    }
}

#[test]
fn euler_curves_are_shown_in_their_own_order_with_all_their_turns() {
    let values = [DVec3::ZERO, DVec3::new(0.0, 0.0, 720.0)];
    let keys = values
        .iter()
        .zip([0.0, 4.0])
        .map(|(&value, time)| Keyframe::new(time, value, Interpolation::Linear));
    let track = Track::new(keys.collect(), Extrapolation::Hold).expect("valid");
    let curves = EulerTrack::new(EulerOrder::XYZ, track).expect("a whole order");
    let channels = Channels::of(TrackValue::Euler(curves), EulerOrder::ZXY, [0.0; 3]);
    assert!(channels.are_angles() && channels.are_curves());
    assert_eq!(channels.axis(2), Some(Axis::Z));
    assert_eq!(channels.at(1.0), [0.0, 0.0, 180.0]);
    assert_eq!(channels.at_key(1), [0.0, 0.0, 720.0]);
    assert!(channels.is_of(channels.track().as_track(), EulerOrder::YZX));
}
