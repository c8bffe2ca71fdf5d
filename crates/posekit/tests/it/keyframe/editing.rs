//! Editing keys: what an animator's commands do to a track.

use glam::{DQuat, DVec3};
use posekit::keyframe::edit::{
    EditError, PasteValues, copy_keys, delete_keys, insert_key, key_on_curve, move_keys,
    paste_keys, scale_keys,
};
use posekit::keyframe::{Extrapolation, Interpolation, Keyframe, Tangents, Track};
use posekit::rotation::angle_between;

use super::track;

fn ramp() -> Track<f64> {
    track(
        &[0.0, 1.0, 2.0, 3.0],
        &[0.0, 10.0, 20.0, 30.0],
        Interpolation::Linear,
    )
}

fn pairs(track: &Track<f64>) -> Vec<(f64, f64)> {
    track
        .keys()
        .iter()
        .map(|key| (key.time_secs, key.value))
        .collect()
}

#[test]
fn a_key_is_put_between_others_or_in_place_of_one() {
    let between = insert_key(&ramp(), Keyframe::new(1.5, 7.0, Interpolation::Step)).unwrap();
    assert_eq!(pairs(&between)[2], (1.5, 7.0));
    let replaced = insert_key(&ramp(), Keyframe::new(1.00005, 7.0, Interpolation::Step)).unwrap();
    assert_eq!(replaced.keys().len(), 4);
    assert_eq!(pairs(&replaced)[1], (1.00005, 7.0));
}

#[test]
fn moved_keys_may_pass_others_and_replace_what_they_land_on() {
    let moved = move_keys(&ramp(), &[0, 1], 1.0).unwrap();
    assert_eq!(pairs(&moved), [(1.0, 0.0), (2.0, 10.0), (3.0, 30.0)]);
    let passed = move_keys(&ramp(), &[1], 1.5).unwrap();
    assert_eq!(pairs(&passed)[2], (2.5, 10.0));
    assert_eq!(move_keys(&ramp(), &[99], 1.0).unwrap(), ramp());
    assert!(matches!(
        move_keys(&ramp(), &[0], f64::NAN),
        Err(EditError::Track(_))
    ));
}

#[test]
fn scaling_keeps_the_shape_of_the_curve() {
    let keys = [(0.0, 1.0, 3.0), (1.0, 4.0, -2.0), (2.5, 0.0, 1.0)];
    let keys = keys.map(|(t, v, slope)| Keyframe {
        tangents: Tangents::Aligned(slope),
        ..Keyframe::new(t, v, Interpolation::Cubic)
    });
    let track = Track::new(keys.to_vec(), Extrapolation::Hold).unwrap();
    let scaled = scale_keys(&track, &[0, 1, 2], 1.0, 2.0).unwrap();
    assert_eq!(scaled.times_secs(), [-1.0, 1.0, 4.0]);
    for step in 0..=20 {
        let time = 2.5 * f64::from(step) / 20.0;
        let after = 1.0 + (time - 1.0) * 2.0;
        assert!((track.sample(time) - scaled.sample(after)).abs() < 1e-12);
    }
    for factor in [0.0, -1.0, f64::NAN] {
        let refused = scale_keys(&track, &[0], 0.0, factor);
        assert!(matches!(refused, Err(EditError::BadFactor { .. })));
    }
}

#[test]
fn deleting_leaves_the_others_and_nothing_of_the_last() {
    assert_eq!(
        pairs(&delete_keys(&ramp(), &[1, 2]).unwrap()),
        [(0.0, 0.0), (3.0, 30.0)]
    );
    assert_eq!(delete_keys(&ramp(), &[0, 1, 2, 3]), None);
}

#[test]
fn pasted_keys_replace_their_range_and_can_continue_the_curve() {
    let copied = copy_keys(&ramp(), &[0, 1], 0.0);
    let pasted = paste_keys(&ramp(), &copied, 1.8, PasteValues::AsCopied).unwrap();
    assert_eq!(
        pairs(&pasted),
        [
            (0.0, 0.0),
            (1.0, 10.0),
            (1.8, 0.0),
            (2.8, 10.0),
            (3.0, 30.0)
        ]
    );
    let onto = paste_keys(&ramp(), &copied, 5.0, PasteValues::OntoCurve).unwrap();
    assert_eq!(pairs(&onto)[4..], [(5.0, 30.0), (6.0, 40.0)]);
    assert_eq!(
        paste_keys(&ramp(), &[], 5.0, PasteValues::AsCopied).unwrap(),
        ramp()
    );
}

#[test]
fn a_turn_pasted_onto_a_curve_goes_on_from_there() {
    let turn = |angle: f64| DQuat::from_rotation_y(angle);
    let steps = track(&[0.0, 1.0], &[turn(0.2), turn(0.7)], Interpolation::Linear);
    let copied = copy_keys(&steps, &[0, 1], 0.0);
    let onto = paste_keys(&steps, &copied, 1.0, PasteValues::OntoCurve).unwrap();
    assert_eq!(onto.keys().len(), 3);
    assert!(angle_between(onto.sample(2.0), turn(1.2)) < 1e-12);
    assert!(angle_between(onto.sample(1.5), turn(0.95)) < 1e-12);
}

#[test]
fn a_key_on_a_cubic_with_set_slopes_changes_nothing() {
    let keys = [(0.0, DVec3::ZERO, DVec3::X), (2.0, DVec3::ONE, DVec3::Y)];
    let keys = keys.map(|(t, v, slope)| Keyframe {
        tangents: Tangents::Aligned(slope),
        ..Keyframe::new(t, v, Interpolation::Cubic)
    });
    let track = Track::new(keys.to_vec(), Extrapolation::Hold).unwrap();
    let more = insert_key(&track, key_on_curve(&track, 0.7)).unwrap();
    assert_eq!(more.keys().len(), 3);
    for step in 0..=20 {
        let time = 0.1 * f64::from(step);
        assert!((track.sample(time) - more.sample(time)).length() < 1e-8);
    }
}
