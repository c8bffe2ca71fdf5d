//! Ways between orientations against what theory and other programs say of them, and filled-in motions.

use std::f64::consts::PI;

use glam::{DMat3, DQuat, DVec3};
use posekit::inbetween::{
    Between, Ends, FillConfigError, FillError, FillPlan, Method, Preset, fill, path,
};
use posekit::rotation::{EulerOrder, angle_between, exp, slerp};
use posekit::sample;
use proptest::prelude::*;

fn orientation() -> impl Strategy<Value = DQuat> {
    ([-1.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0]).prop_filter_map("zero", |v| {
        let q = DQuat::from_array(v);
        (q.length() > 0.1).then(|| q.normalize())
    })
}

proptest! {
    #[test]
    fn all_ways_meet_their_ends(a in orientation(), b in orientation()) {
        for method in Method::ALL {
            let way = Between::new(method, &Ends::new(a, b));
            prop_assert!(angle_between(way.rotation_at(0.0), a) < 1e-7, "{method}");
            prop_assert!(angle_between(way.rotation_at(1.0), b) < 1e-7, "{method}");
        }
    }

    #[test]
    fn slerp_keeps_its_speed_and_the_chord_its_path(a in orientation(), b in orientation()) {
        let ends = Ends::new(a, b);
        let angle = angle_between(a, b).to_degrees();
        prop_assume!(angle > 1.0 && angle < 179.0);
        for step in path(Method::Slerp, &ends, 10) {
            prop_assert!((step.speed_deg - angle).abs() < 1e-6 * angle.max(1.0) + 1e-5);
            prop_assert!((step.blend.determinant() - 1.0).abs() < 1e-9 && step.blend.shear_deg() < 1e-6);
        }
        // Only methods that do not depend on the choice of axes have the middle for their middle.
        for method in [Method::Nlerp, Method::RawLerp, Method::Matrix] {
            let middle = Between::new(method, &ends).rotation_at(0.5);
            prop_assert!(angle_between(middle, slerp(a, b, 0.5)) < 1e-6, "{method}");
        }
    }

    /// On the way between two matrices a half turn's share apart, the plane of turning shrinks by the
    /// length of the chord: det = 1 - 2 t (1 - t) (1 - cos angle).
    #[test]
    fn a_matrix_in_between_is_no_rotation(a in orientation(), axis in orientation(), angle in 0.1_f64..3.1, t in 0.0_f64..1.0) {
        let turn = exp((axis * DVec3::X) * angle);
        let blend = Between::new(Method::Matrix, &Ends::new(a, a * turn)).at(t);
        let expected = 1.0 - 2.0 * t * (1.0 - t) * (1.0 - angle.cos());
        prop_assert!((blend.determinant() - expected).abs() < 1e-9);
        let chord = Between::new(Method::RawLerp, &Ends::new(a, a * turn)).at(t);
        let square = 1.0 - 2.0 * t * (1.0 - t) * (1.0 - (angle / 2.0).cos());
        prop_assert!((chord.determinant() - square.powi(3)).abs() < 1e-9);
        prop_assert!(chord.shear_deg() < 1e-6);
    }
}

#[test]
fn shear_shows_where_axes_are_not_at_right_angles() {
    let ends = Ends::new(DQuat::IDENTITY, exp(DVec3::new(1.0, 1.0, 0.3)));
    let blend = Between::new(Method::Matrix, &ends).at(0.5);
    // NumPy: the largest |90 - angle| between columns of (I + expm(K)) / 2 with SciPy's Rotation
    // .from_rotvec([1, 1, 0.3]).
    let m: DMat3 = blend.matrix;
    let angle = |a: DVec3, b: DVec3| (90.0 - a.angle_between(b).to_degrees()).abs();
    let expected = angle(m.x_axis, m.y_axis)
        .max(angle(m.y_axis, m.z_axis))
        .max(angle(m.z_axis, m.x_axis));
    assert!(expected > 5.0 && (blend.shear_deg() - expected).abs() < 1e-9);
}

#[test]
fn a_half_turn_of_matrices_has_no_middle() {
    let half = DQuat::from_rotation_y(PI);
    let way = Between::new(Method::Matrix, &Ends::new(DQuat::IDENTITY, half));
    assert!(way.at(0.5).determinant().abs() < 1e-12);
    assert!(way.at(0.5).rotation().is_none());
    assert!((way.rotation_at(0.5).length() - 1.0).abs() < 1e-9);
}

#[test]
fn euler_angles_leave_the_way_near_gimbal_lock() {
    let order = EulerOrder::ZXY;
    // At the lock Z and Y turn about one axis; this is a turn about the one that is lost.
    let start = order.to_quat([0.0, 89_f64.to_radians(), 0.0]);
    let ends = Ends::new(start, exp(DVec3::Y * 40_f64.to_radians()) * start);
    let worst = |method| {
        path(method, &ends, 50)
            .iter()
            .map(|step| step.deviation_deg)
            .fold(0.0, f64::max)
    };
    assert!(worst(Method::Slerp) < 1e-9);
    assert!(worst(Method::Euler(order)) > 3.0 * worst(Method::Nlerp));
    assert!(worst(Method::Euler(order)) > 10.0);
}

#[test]
fn words_of_methods_read_back() {
    for method in Method::ALL {
        assert_eq!(method.to_string().parse(), Ok(method));
    }
    for wrong in [
        "",
        "Slerp",
        "euler:",
        "euler:ZX",
        "euler:XXY",
        "euler:ABC",
        "euler",
    ] {
        assert!(wrong.parse::<Method>().is_err(), "{wrong}");
    }
}

#[test]
fn kept_frames_stay_and_others_are_filled() {
    let walk = sample::by_name("walk").unwrap();
    let plan = FillPlan::every(10, walk.frame_count()).unwrap();
    assert_eq!(plan.kept().last(), Some(&(walk.frame_count() - 1)));
    // The signs of a motion's quaternions mean nothing: slerp that looks at them goes anywhere.
    for method in Method::ALL
        .into_iter()
        .filter(|method| *method != Method::RawSlerp)
    {
        let filled = fill(&walk, &plan, |_| method);
        assert_eq!(filled.frame_count(), walk.frame_count());
        let kept = FillError::between(&walk, &filled, plan.kept());
        assert!(
            kept.max_deg < 1e-3 && kept.max_distance < 1e-5,
            "{method}: {}",
            kept.max_deg
        );
        let between = FillError::between(&walk, &filled, &plan.filled());
        assert!(between.max_deg > 0.5 && between.max_deg < 40.0, "{method}");
        assert!(between.mean_deg < between.max_deg);
        let worst = between
            .joints
            .iter()
            .max_by(|a, b| a.max_deg.total_cmp(&b.max_deg))
            .unwrap();
        assert!(!plan.kept().contains(&worst.worst_frame));
    }
    let error = |method| {
        let filled = fill(&walk, &plan, |_| method);
        FillError::between(&walk, &filled, &plan.filled()).mean_deg
    };
    // A walk is smooth: a curve through the keys comes nearer than straight ways.
    assert!(error(Method::Squad) < 0.8 * error(Method::Slerp));
}

#[test]
fn keys_can_be_given_another_spacing() {
    let walk = sample::by_name("walk").unwrap();
    let plan = FillPlan::at([40, 0, 20, 20], walk.frame_count()).unwrap();
    assert_eq!(plan.kept(), [0, 20, 40]);
    let slow = plan.clone().spaced(50).unwrap();
    let filled = fill(&walk, &slow, |_| Method::Slerp);
    assert_eq!(filled.frame_count(), 101);
    for (place, frame) in [(0, 0), (50, 20), (100, 40)] {
        for &joint in walk.rotated_joints() {
            let same = filled
                .rotation(place, joint)
                .dot(walk.rotation(frame, joint))
                .abs();
            assert!(same > 0.999_999);
        }
    }
    assert_eq!(FillPlan::every(0, 5), Err(FillConfigError::NoSpacing));
    assert_eq!(FillPlan::every(3, 0), Err(FillConfigError::NoFrames));
    assert!(matches!(
        FillPlan::at([9], 9),
        Err(FillConfigError::NoSuchFrame { .. })
    ));
    assert!(matches!(
        plan.spaced(usize::MAX),
        Err(FillConfigError::TooMany { .. })
    ));
    // Outside of the kept frames the nearest one stays.
    let middle = FillPlan::at([50, 60], walk.frame_count()).unwrap();
    let filled = fill(&walk, &middle, |_| Method::Slerp);
    let joint = walk.rotated_joints()[1];
    assert_eq!(filled.rotation(0, joint), filled.rotation(50, joint));
    assert_eq!(
        filled.rotation(walk.frame_count() - 1, joint),
        filled.rotation(60, joint)
    );
}

#[derive(serde::Deserialize)]
struct Golden {
    times: Vec<f64>,
    cases: Vec<GoldenCase>,
}

#[derive(serde::Deserialize)]
struct GoldenCase {
    start: [f64; 4],
    end: [f64; 4],
    before: Option<[f64; 4]>,
    after: Option<[f64; 4]>,
    /// By the method's word: its matrix at each time, row by row.
    ways: std::collections::BTreeMap<String, Vec<[f64; 9]>>,
}

/// `golden/make_inbetween.py`: every method written anew with NumPy and SciPy.
#[test]
fn every_way_is_that_of_an_independent_implementation() {
    let text = include_str!("../golden/inbetween.json");
    let golden: Golden = serde_json::from_str(text).unwrap();
    let mut compared = std::collections::BTreeMap::new();
    for case in &golden.cases {
        let ends = Ends {
            start: DQuat::from_array(case.start),
            end: DQuat::from_array(case.end),
            before: case.before.map(DQuat::from_array),
            after: case.after.map(DQuat::from_array),
        };
        for (word, matrices) in &case.ways {
            let method: Method = word.parse().unwrap();
            let way = Between::new(method, &ends);
            for (&t, rows) in golden.times.iter().zip(matrices) {
                let expected = DMat3::from_cols_array(rows).transpose();
                let found = way.at(t).matrix;
                let gap = (found - expected).to_cols_array();
                let most = gap
                    .iter()
                    .fold(0.0_f64, |most, entry| most.max(entry.abs()));
                assert!(most < 1e-10, "{word} at {t}: {most:e}");
            }
            *compared.entry(word.clone()).or_insert(0) += 1;
        }
    }
    assert_eq!(compared.len(), Method::ALL.len(), "{compared:?}");
    assert!(compared.values().all(|&count| count >= 15), "{compared:?}");
}

#[test]
fn slerp_that_looks_at_no_sign_goes_as_far_as_was_said() {
    for angle in [10_f64, 170.0, 190.0, 300.0, 359.0, 360.0] {
        let end = EulerOrder::XYZ.to_quat([0.0, angle.to_radians(), 0.0]);
        let ends = Ends::new(DQuat::IDENTITY, end);
        for step in path(Method::RawSlerp, &ends, 8) {
            assert!((step.speed_deg - angle).abs() < 1e-5, "{angle}");
        }
        let short = angle.min(360.0 - angle);
        let slerp = path(Method::Slerp, &ends, 8);
        assert!(
            slerp
                .iter()
                .all(|step| (step.speed_deg - short).abs() < 1e-5)
        );
    }
}

#[test]
fn presets_have_names_and_keys() {
    for preset in Preset::ALL {
        assert_eq!(Preset::by_name(preset.name()), Some(preset));
        let keys = preset.keys();
        assert!(keys.len() >= 2 && preset.gap() + 1 < keys.len());
        assert!(keys.iter().all(|key| (key.length() - 1.0).abs() < 1e-12));
        assert!(!preset.title().is_empty() && preset.says().ends_with('.'));
    }
    assert_eq!(Preset::by_name("none"), None);
}
