//! The inspector's and the curves' numbers, against values worked out by hand.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::Vec3;
use posekit::skeleton::JointId;
use posekit_viewer::state::curves::{Quantity, curves};
use posekit_viewer::state::readout::{readout, readout_of_pose};

use super::clips::{arm, walking};
use super::window::{input, laptop, press, viewer};

fn shoulder() -> JointId {
    JointId::new(0)
}
fn elbow() -> JointId {
    JointId::new(1)
}

#[test]
fn angles_are_those_of_the_file() {
    let clip = arm(30);
    // 250 degrees at frame 25: the angle itself, not the -110 that means the same.
    let numbers = readout(&clip, shoulder(), 12.5, 0.0);
    assert_eq!(numbers.order, "ZXY");
    assert!(
        (numbers.local.euler_deg[0] - 250.0).abs() < 1e-3,
        "{:?}",
        numbers.local.euler_deg
    );
    assert_eq!(numbers.channels.len(), 6);
    assert!((numbers.channels[3].1 - 250.0).abs() < 1e-9);
}

#[test]
fn global_rotation_position_and_height_follow_the_parent() {
    let clip = arm(10);
    let numbers = readout(&clip, elbow(), 4.5, -1.0);
    // At frame 9 the shoulder has turned by 90 degrees about Z: the elbow is 2 to the left of it.
    assert!(
        numbers.position.distance(Vec3::new(7.0, 0.0, 0.0)) < 1e-5,
        "{}",
        numbers.position
    );
    assert!((numbers.height - 1.0).abs() < 1e-5);
    assert!(numbers.local.vector_deg.length() < 1e-4);
    assert!((numbers.global.vector_deg.z - 90.0).abs() < 1e-3);
    assert_eq!(numbers.translation, Vec3::Y * 2.0);
}

#[test]
fn speeds_are_central_differences_over_time() {
    let clip = arm(10);
    let numbers = readout(&clip, shoulder(), 2.0, 0.0);
    // 1 a frame of half a second, 10 degrees a frame.
    assert!((numbers.speed.expect("time runs") - 2.0).abs() < 1e-5);
    assert!((numbers.turn_deg_per_sec.expect("time runs") - 20.0).abs() < 1e-2);
}

#[test]
fn a_single_frame_has_no_speed() {
    assert_eq!(readout(&arm(1), shoulder(), 0.0, 0.0).speed, None);
    assert_eq!(readout(&arm(0), shoulder(), 0.0, 0.0).speed, None);
}

#[test]
fn channel_curves_are_the_columns_of_the_file() {
    let clip = arm(10);
    let curves = curves(&clip, &[shoulder()], Quantity::Rotation, 0.0);
    let names: Vec<&str> = curves.iter().map(|curve| curve.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "Shoulder Zrotation",
            "Shoulder Xrotation",
            "Shoulder Yrotation"
        ]
    );
    assert_eq!(curves[0].points[7], [3.5, 70.0]);
    assert_eq!(curves[0].color, 2, "Z is blue wherever it stands");
}

#[test]
fn quantities_of_several_joints_are_curves_of_their_own() {
    let clip = arm(10);
    let joints = [shoulder(), elbow()];
    assert_eq!(curves(&clip, &joints, Quantity::Position, 0.0).len(), 6);
    let speeds = curves(&clip, &joints, Quantity::Speed, 0.0);
    assert_eq!(speeds.len(), 2);
    assert_ne!(speeds[0].color, speeds[1].color);
    assert!((speeds[0].points[5][1] - 2.0).abs() < 1e-5);
    assert!(curves(&clip, &[elbow()], Quantity::Translation, 0.0).is_empty());
    assert!(curves(&clip, &[JointId::new(99)], Quantity::Speed, 0.0).is_empty());
}

#[test]
fn a_sample_has_curves_as_a_file_has() {
    let clip = walking();
    for quantity in Quantity::ALL {
        // The root is the one joint with all kinds of channels.
        let curves = curves(&clip, &[shoulder()], quantity, 0.0);
        assert!(!curves.is_empty(), "{quantity:?}");
        assert!(
            curves
                .iter()
                .all(|curve| curve.points.len() == clip.frame_count())
        );
    }
}

#[test]
fn the_numbers_of_the_rest_pose_are_those_of_the_figure_that_is_seen() {
    let mut window = laptop(vec![input("arm.bvh", 21)]);
    let session = window.state_mut().as_mut().expect("shown").session_mut();
    session.transport.pause();
    session.transport.go_to_frame(13);
    session.select(Some(JointId::new(1)));
    window.run_steps(2);
    let speed = window.query_all_by_label_contains("/s").count();
    assert!(speed > 0, "a frame of the motion has a speed");
    press(&mut window, Modifiers::SHIFT, Key::R);
    window.get_by_label("in the rest pose");
    // The elbow is two units above the shoulder, unturned, whatever the frame.
    let session = viewer(&window).session();
    let rest = session.rest_pose_shown().expect("it is shown");
    let clip = session.active_clip().expect("open");
    let numbers = readout_of_pose(clip, JointId::new(1), &rest, 0.0);
    assert!(
        numbers
            .local
            .euler_deg
            .iter()
            .all(|angle| angle.abs() < 1e-4),
        "{numbers:?}"
    );
    assert!(numbers.global.vector_deg.length() < 1e-4);
    assert_eq!(numbers.translation, Vec3::new(0.0, 2.0, 0.0));
    assert_eq!((numbers.speed, numbers.channels.len()), (None, 0));
    assert!(window.query_by_label("Channels in the file").is_none());
    press(&mut window, Modifiers::SHIFT, Key::R);
    assert!(window.query_by_label("in the rest pose").is_none());
    window.get_by_label("Channels in the file");
}
