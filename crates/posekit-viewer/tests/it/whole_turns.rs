//! The interpolation lab with angles that go around more than once.

use egui_kittest::kittest::Queryable as _;
use posekit::inbetween::Method;
use posekit_viewer::state::interpolation::case::LabPreset;
use posekit_viewer::state::interpolation::{InterpolationLab, Kind, Span};
use posekit_viewer::state::mode::Mode;

use super::window::{input, laptop, settle};

fn turns() -> InterpolationLab {
    let mut lab = InterpolationLab::default();
    assert!(!lab.is_shown(Kind::Curves));
    lab.take_preset(LabPreset::WholeTurns);
    lab.measure();
    lab
}

/// Curves go once around, twice back and three quarters on; orientations stand still twice.
#[test]
fn curves_go_around_as_often_as_they_are_told() {
    let lab = turns();
    assert!(lab.is_shown(Kind::Curves));
    assert_eq!(lab.span(), Span::AllKeys);
    let speeds = |kind: Kind| -> Vec<f64> {
        let way = lab.way(kind).expect("it is measured");
        let at = |t: f64| {
            let near = |step: &&posekit::inbetween::PathStep| (step.t - t).abs() < 1e-9;
            way.steps
                .iter()
                .find(near)
                .map_or(f64::NAN, |step| step.speed_deg)
        };
        [0.5, 1.5, 2.5].map(at).to_vec()
    };
    // Degrees from key to key: of a turn about one axis, whatever leans.
    for (speed, asked) in speeds(Kind::Curves).into_iter().zip([360.0, 720.0, 270.0]) {
        assert!((speed - asked).abs() < 1e-3, "{speed} {asked}");
    }
    for (speed, shortest) in speeds(Method::Slerp.into())
        .into_iter()
        .zip([0.0, 0.0, 90.0])
    {
        assert!((speed - shortest).abs() < 1e-3, "{speed} {shortest}");
    }
    assert_eq!(lab.lost_turns().count(), 3);
}

/// The command knows orientations alone.
#[test]
fn the_command_leaves_the_curves_out() {
    let lab = turns();
    assert!(lab.command().contains("slerp"));
    assert!(!lab.command().contains("curves"));
}

#[test]
fn the_window_says_what_orientations_cannot_hold() {
    let mut window = laptop(vec![input("arm.bvh", 5)]);
    let viewer = window.state_mut().as_mut().expect("it is shown");
    viewer.session_mut().set_mode(Mode::Interpolation);
    viewer
        .interpolation_mut()
        .take_preset(LabPreset::WholeTurns);
    settle(&mut window);
    window.get_by_label("curves:YXZ");
    window.get_by_label_contains("Y goes -720\u{b0}, more than half a turn");
}
