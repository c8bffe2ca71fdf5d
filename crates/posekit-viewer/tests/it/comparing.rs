//! Several clips: what is active, what is on the stage, what stays when one goes.

use posekit::skeleton::JointId;
use posekit_render::camera::View;
use posekit_render::theme::CharacterColors;
use posekit_viewer::command::{self, Command};
use posekit_viewer::state::display::{Compare, FollowMode, PoseShown, Style};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::{Hold, Session};

use super::clips::{arm, session, walking};

#[test]
fn an_opened_clip_is_alone_on_the_stage_and_plays() {
    let mut session = session();
    let walk = session.open(walking());
    assert_eq!(session.active_id(), Some(walk));
    assert_eq!(session.shown().count(), 1);
    assert!(session.transport.is_playing());
    assert_eq!(session.stage().actors().len(), 1);
}

#[test]
fn a_clip_beside_keeps_the_active_one() {
    let mut session = session();
    let first = session.active_id();
    let second = session.open_beside(arm(5));
    assert_eq!(session.active_id(), first);
    assert_eq!(session.shown().count(), 2);
    session.set_shown(second, false);
    assert_eq!(session.shown().count(), 1);
    session.set_shown(first.expect("the arm is open"), false);
    assert_eq!(
        session.shown().count(),
        1,
        "the active clip stays on the stage"
    );
}

#[test]
fn figures_stand_apart_side_by_side_and_together_overlaid() {
    let mut session = session();
    session.open_beside(arm(10));
    let apart = session.poses_on_stage();
    assert!(apart[0].1.positions[0].distance(apart[1].1.positions[0]) > 0.5);
    let mut display = session.display().clone();
    display.compare = Compare::Overlaid;
    session.set_display(display);
    let together = session.poses_on_stage();
    assert!(together[0].1.positions[0].distance(together[1].1.positions[0]) < 1e-6);
}

#[test]
fn closing_goes_back_to_the_clip_before() {
    let mut session = session();
    let first = session.active_id().expect("the arm is open");
    let second = session.open(walking());
    session.close(second);
    assert_eq!(session.active_id(), Some(first));
    assert_eq!(session.transport.frame_count(), 10);
    session.close(first);
    assert_eq!(session.active_id(), None);
    assert_eq!(session.transport.frame_count(), 0);
    assert!(session.scene().models.is_empty());
}

/// As those of the command's pictures do.
#[test]
fn figures_take_their_colours_in_the_order_in_which_they_stand() {
    let mut session = session();
    let first = session.active_id().expect("the arm is open");
    let second = session.open_beside(arm(3));
    let third = session.open_beside(arm(4));
    let colors = |session: &Session| -> Vec<CharacterColors> {
        let actors = session.stage().actors().iter();
        actors.map(|actor| *actor.colors()).collect()
    };
    let in_order = [0, 1, 2].map(CharacterColors::of);
    assert_eq!(colors(&session), in_order);
    session.set_shown(second, false);
    assert_eq!(colors(&session), in_order[..2]);
    // The bar beside a clip's name in the list has the colour of its figure.
    let of_third = session.clips().iter().find(|open| open.id == third);
    assert_eq!(of_third.map(|open| open.color), Some(1));
    session.activate(third);
    assert_eq!(colors(&session), in_order[..1]);
    session.set_shown(first, true);
    assert_eq!(colors(&session), in_order[..2]);
}

#[test]
fn a_newer_version_keeps_time_and_selection() {
    let mut session = session();
    let id = session.active_id().expect("the arm is open");
    session.select(Some(JointId::new(1)));
    session.transport.pause();
    session.transport.go_to_frame(7);
    session.replace(id, arm(20));
    assert_eq!(session.transport.frame(), 7);
    assert_eq!(session.transport.frame_count(), 20);
    assert_eq!(session.selected(), Some(JointId::new(1)));
}

#[test]
fn selection_walks_the_tree_and_stops_at_its_ends() {
    let mut session = session();
    for (command, expected) in [
        (Command::SelectChild, Some(0)),
        (Command::SelectChild, Some(1)),
        (Command::SelectChild, Some(2)),
        (Command::SelectChild, Some(2)),
        (Command::SelectParent, Some(1)),
        (Command::SelectParent, Some(0)),
        (Command::SelectParent, Some(0)),
        (Command::Deselect, None),
    ] {
        assert!(command::apply(command, &mut session));
        assert_eq!(
            session.selected().map(JointId::index),
            expected,
            "{command:?}"
        );
    }
}

#[test]
fn several_joints_are_selected_and_the_last_is_shown() {
    let mut session = session();
    session.toggle_selected(JointId::new(0));
    session.toggle_selected(JointId::new(1));
    assert_eq!(session.selected(), Some(JointId::new(1)));
    session.toggle_selected(JointId::new(1));
    assert_eq!(session.selection(), [JointId::new(0)]);
}

#[test]
fn the_rest_pose_stands_where_the_motion_is() {
    let mut session = session();
    session.transport.pause();
    session.transport.go_to_frame(6);
    command::apply(Command::ToggleRest, &mut session);
    assert_eq!(session.pose_shown(), PoseShown::Rest);
    let (_, pose) = &session.poses_on_stage()[0];
    assert!((pose.positions[0].x - 6.0).abs() < 1e-5);
    assert!((pose.positions[1] - pose.positions[0]).distance(glam::Vec3::Y * 2.0) < 1e-5);
    command::apply(Command::ToggleRest, &mut session);
    let (_, pose) = &session.poses_on_stage()[0];
    assert!(
        (pose.positions[1] - pose.positions[0]).x < -1.0,
        "60 degrees to the left"
    );
}

#[test]
fn following_or_not_does_not_make_the_picture_jump() {
    let mut session = session();
    session.open(walking());
    session.transport.pause();
    session.transport.go_to_frame(100);
    let mut display = session.display().clone();
    display.follow = FollowMode::On;
    session.set_display(display.clone());
    let before = session.view_camera();
    display.follow = FollowMode::Off;
    session.set_display(display);
    let after = session.view_camera();
    assert!(
        before.eye.distance(after.eye) < 1e-3,
        "{before:?} {after:?}"
    );
}

#[test]
fn styles_change_the_stage_and_only_then() {
    let mut session = session();
    let version = session.stage_version();
    session.set_display(session.display().clone());
    assert_eq!(session.stage_version(), version);
    command::apply(Command::NextStyle, &mut session);
    assert_eq!(session.display().style, Style::Bones);
    assert_ne!(session.stage_version(), version);
}

#[test]
fn the_selected_joint_comes_into_the_middle_of_the_picture() {
    let mut session = session();
    session.transport.pause();
    session.select(Some(JointId::new(1)));
    command::apply(Command::FrameSelected, &mut session);
    let joint = session
        .joint_position(JointId::new(1))
        .expect("the arm is on the stage");
    let place = session
        .view_camera()
        .project(joint, (400, 200))
        .expect("it is in front");
    assert!(
        (place.x - 200.0).abs() < 0.5 && (place.y - 100.0).abs() < 0.5,
        "{place}"
    );
}

#[test]
fn figures_in_different_units_are_made_equally_tall() {
    let mut session = session();
    let text = super::clips::arm_text(10).replace("OFFSET 0 2 0", "OFFSET 0 200 0");
    let text = text.replace("OFFSET 0 1 0", "OFFSET 0 100 0");
    let clip = posekit_viewer::load::read_clip("cm.bvh", text.as_bytes()).expect("a valid file");
    session.open_beside(clip);
    let statures: Vec<f32> = session
        .stage()
        .actors()
        .iter()
        .map(|a| a.stature())
        .collect();
    assert!(
        (statures[0] - statures[1]).abs() < 0.01 * statures[0],
        "{statures:?}"
    );
    let scales: Vec<f32> = session.shown().map(|open| open.scale()).collect();
    assert!(
        (scales[0] - 1.0).abs() < 1e-6 && (scales[1] - 0.01).abs() < 1e-4,
        "{scales:?}"
    );
}

/// In the view figures of other units are as tall as the active one, in a film as the first, as the command has it:
/// which of them is worked on changes nothing in the film, nor does it where the view was turned by hand.
#[test]
fn a_film_of_figures_in_different_units_is_the_same_whichever_is_active() {
    use posekit_viewer::work::export::{ExportOptions, Take};
    let mut session = session();
    let in_cm = super::clips::arm_text(10).replace("OFFSET 0 2 0", "OFFSET 0 200 0");
    let in_cm = in_cm.replace("OFFSET 0 1 0", "OFFSET 0 100 0");
    let tall = super::clips::arm_text(10).replace("OFFSET 0 2 0", "OFFSET 0 5 0");
    for (name, text) in [("cm.bvh", in_cm), ("tall.bvh", tall)] {
        let clip = posekit_viewer::load::read_clip(name, text.as_bytes()).expect("a valid file");
        session.open_beside(clip);
    }
    session.transport.pause();
    let ids: Vec<_> = session.clips().iter().map(|open| open.id).collect();
    let films = |session: &mut Session, turn: f32| {
        let film = |id: &_| {
            session.activate_among(*id);
            session.look_from(View::ThreeQuarter);
            if turn != 0.0 {
                session.camera.turn(turn, 0.0);
            }
            let scene = Take::of(session, &ExportOptions::default()).scene(0.1);
            let joints = scene.models.iter().map(|model| model.joints.clone());
            (scene.camera, joints.collect::<Vec<_>>())
        };
        ids.iter().map(film).collect::<Vec<_>>()
    };
    for film in films(&mut session, 0.0).windows(2) {
        assert!(film[0] == film[1], "framed");
    }
    // What was turned by hand keeps its distance in statures.
    let [first, in_cm, _] = &films(&mut session, 0.3)[..] else {
        panic!("three films");
    };
    assert!(first.1 == in_cm.1);
    let size = first.0.eye.length();
    assert!(first.0.eye.distance(in_cm.0.eye) < 0.02 * size);
}

/// The time line of several clips is as long as the longest, whichever is the active one; those that are over
/// stand in their last frame.
#[test]
fn the_longest_clip_on_the_stage_makes_the_time_line() {
    let mut session = session();
    let long = session.open_beside(arm(25));
    assert_eq!(session.transport.frame_count(), 25);
    assert_eq!(session.transport.range(), (0, 24));
    session.transport.pause();
    session.transport.go_to_frame(20);
    assert_eq!(session.clip_frame(), 9);
    let poses = session.poses_on_stage();
    let own_end = session.active_clip().expect("the arm").global_pose(4.5);
    assert!(poses[0].1.orientations[1].angle_between(own_end.orientations[1]) < 1e-2);
    // What is edited there is the last frame that the clip has.
    session.set_mode(Mode::Pose);
    session.select(Some(JointId::new(1)));
    session.set_mode(Mode::Ik);
    session.toggle_pins(Hold::Effector);
    session.solve_again();
    session.set_shown(long, false);
    assert_eq!(session.transport.frame_count(), 10);
    assert_eq!(session.transport.frame(), 9);
    session.set_shown(long, true);
    session.close(long);
    assert_eq!(session.transport.frame_count(), 10);
}
