//! The pose library, used in the window; and ghosts of neighbouring keys.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use posekit::skeleton::JointId;
use posekit_render::stage::GhostSide;
use posekit_viewer::load::Input;
use posekit_viewer::state::animate::pose_library::PoseLibrary;

use super::graph::{angles, authored, graphing, times};
use super::window::{Window, press, until, viewer};

/// How far the elbow is turned as it is shown, degrees.
fn elbow_deg(window: &Window) -> f64 {
    let pose = viewer(window).session().shown_local_pose();
    let rotation = pose.expect("a clip is open").rotations[1];
    f64::from(rotation.to_axis_angle().1).to_degrees()
}

fn go_to(window: &mut Window, secs: f64) {
    let shown = window.state_mut().as_mut().expect("it was shown");
    shown.session_mut().go_to_scene_secs(secs);
    window.run_steps(3);
}

/// The elbow is keyed at 0, 60 and 20 degrees; the pose of the second key is saved as a whole.
fn with_a_saved_pose() -> Window {
    let mut window = graphing();
    let shown = window.state_mut().as_mut().expect("it was shown");
    shown.session_mut().select(None);
    window.run_steps(2);
    window.get_by_label("Poses").click();
    window.run_steps(2);
    go_to(&mut window, 1.0);
    assert!((elbow_deg(&window) - 60.0).abs() < 0.1);
    window.get_by_label("Save pose").click();
    window.run_steps(3);
    assert_eq!(viewer(&window).poses().entries().len(), 1);
    window
}

fn set_auto_key(window: &mut Window, auto_key: bool) {
    let shown = window.state_mut().as_mut().expect("it was shown");
    let mut settings = shown.session().animate();
    settings.auto_key = auto_key;
    shown.session_mut().set_animate(settings);
    window.run_steps(2);
}

#[test]
fn a_saved_pose_is_applied_as_keys_of_what_it_changes() {
    let mut window = with_a_saved_pose();
    set_auto_key(&mut window, true);
    go_to(&mut window, 0.5);
    assert!(elbow_deg(&window) < 50.0);
    let steps = authored(&window).undo_count();
    window.get_by_label("Apply").click();
    window.run_steps(3);
    assert!((elbow_deg(&window) - 60.0).abs() < 0.1);
    assert_eq!(times(&window), [0.0, 0.5, 1.0, 2.0]);
    assert!((angles(&window, 1)[0] - 60.0).abs() < 0.1);
    assert_eq!(authored(&window).undo_count(), steps + 1);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(times(&window), [0.0, 1.0, 2.0]);
}

#[test]
fn without_auto_key_it_is_held_until_it_is_keyed() {
    let mut window = with_a_saved_pose();
    set_auto_key(&mut window, false);
    go_to(&mut window, 0.5);
    window.get_by_label("Apply").click();
    window.run_steps(3);
    assert!((elbow_deg(&window) - 60.0).abs() < 0.1);
    assert_eq!(times(&window).len(), 3);
    assert!(viewer(&window).session().has_pending_pose());
    press(&mut window, Modifiers::NONE, Key::I);
    assert_eq!(times(&window), [0.0, 0.5, 1.0, 2.0]);
}

/// Presses on the blend slider and drags it so far, in shares of its length. The button is still down.
fn drag_blend(window: &mut Window, share: f32) -> egui::Pos2 {
    let blend = {
        let mut sliders = window.get_all_by_role(egui::accesskit::Role::Slider);
        let slider = sliders.rfind(|slider| slider.rect().right() < 250.0);
        slider.expect("the slider is shown").rect()
    };
    let from = blend.left_center() + egui::vec2(6.0, 0.0);
    let to = from + egui::vec2((blend.width() - 12.0) * share, 0.0);
    super::editing::drag(window, from, to);
    to
}

#[test]
fn blending_is_seen_while_it_goes_on_and_one_step_when_it_is_over() {
    let mut window = with_a_saved_pose();
    set_auto_key(&mut window, true);
    go_to(&mut window, 0.0);
    let steps = authored(&window).undo_count();
    let at = drag_blend(&mut window, 0.5);
    let half_way = elbow_deg(&window);
    assert!((half_way - 30.0).abs() < 6.0, "{half_way}");
    assert_eq!(
        authored(&window).undo_count(),
        steps,
        "nothing is written yet"
    );
    window.drop_at(at);
    window.run_steps(3);
    assert!((elbow_deg(&window) - half_way).abs() < 1.0);
    assert!((angles(&window, 0)[0] - half_way).abs() < 1.0);
    assert_eq!(authored(&window).undo_count(), steps + 1);
    assert_eq!(
        times(&window),
        [0.0, 1.0, 2.0],
        "the key there was replaced"
    );
}

#[test]
fn escape_gives_a_blend_up() {
    let mut window = with_a_saved_pose();
    set_auto_key(&mut window, true);
    go_to(&mut window, 0.0);
    let steps = authored(&window).undo_count();
    let at = drag_blend(&mut window, 0.8);
    assert!(elbow_deg(&window) > 20.0);
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(elbow_deg(&window) < 0.1);
    window.drop_at(at);
    window.run_steps(3);
    assert!(elbow_deg(&window) < 0.1);
    assert_eq!(authored(&window).undo_count(), steps);
}

#[test]
fn poses_are_renamed_and_taken_out() {
    let mut window = with_a_saved_pose();
    let field = window
        .get_all_by_role(egui::accesskit::Role::TextInput)
        .last()
        .expect("the name is shown");
    field.click();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text("Bent".to_owned()));
    window.step();
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert_eq!(viewer(&window).poses().entries()[0].pose.name, "Bent");
    window.get_by_label("Delete").click();
    window.run_steps(3);
    assert!(viewer(&window).poses().entries().is_empty());
}

#[test]
fn a_file_of_poses_is_added_and_a_bad_one_told() {
    let mut window = with_a_saved_pose();
    let bytes = viewer(&window).poses().write();
    let mut library = PoseLibrary::read(&bytes).expect("its own file");
    let id = library.entries()[0].id;
    library.rename(id, "From elsewhere");
    let open = |window: &mut Window, bytes: Vec<u8>| {
        let shown = window.state_mut().as_mut().expect("it was shown");
        shown.open_inputs(vec![Input::Bytes {
            name: "arm.poses.toml".to_owned(),
            bytes: bytes.into(),
        }]);
        until(window, |viewer| !viewer.is_working());
    };
    open(&mut window, library.write());
    let names = |window: &Window| -> Vec<String> {
        let entries = viewer(window).poses().entries();
        entries
            .iter()
            .map(|entry| entry.pose.name.clone())
            .collect()
    };
    assert_eq!(names(&window), ["Pose", "From elsewhere"]);
    window.get_by_label_contains("1 pose was added");
    open(
        &mut window,
        b"format = \"posekit poses\"\nversion = 7\n".to_vec(),
    );
    window.get_by_label_contains("a newer posekit can open it");
    assert_eq!(names(&window).len(), 2);
}

#[test]
fn ghosts_stand_at_the_neighbouring_keys_of_what_is_selected() {
    let mut window = graphing();
    go_to(&mut window, 1.5);
    let ghosts = |window: &Window| -> Vec<(f64, GhostSide)> {
        let stage = viewer(window).session().stage();
        let ghosts = stage.actors()[0].key_ghosts().iter();
        ghosts.map(|ghost| (ghost.time_secs, ghost.side)).collect()
    };
    assert!(ghosts(&window).is_empty(), "not before they are asked for");
    let shown = window.state_mut().as_mut().expect("it was shown");
    let mut display = shown.session().display().clone();
    display.ghosts = true;
    shown.session_mut().set_display(display);
    window.run_steps(2);
    let (before, after) = (GhostSide::Before, GhostSide::After);
    assert_eq!(
        ghosts(&window),
        [(1.0, before), (0.0, before), (2.0, after)]
    );
    assert!(viewer(&window).session().stage().options().ghosts.is_none());
    go_to(&mut window, 1.0);
    assert_eq!(
        ghosts(&window),
        [(0.0, before), (2.0, after)],
        "none at the key shown"
    );
    // The other joint has no keys: then those of all are meant.
    let shown = window.state_mut().as_mut().expect("it was shown");
    shown.session_mut().select(Some(JointId::new(0)));
    window.run_steps(2);
    assert_eq!(ghosts(&window).len(), 2);
    // In another mode they are those of before.
    press(&mut window, Modifiers::NONE, Key::V);
    let shown = window.state_mut().as_mut().expect("it was shown");
    shown
        .session_mut()
        .set_mode(posekit_viewer::state::mode::Mode::View);
    window.run_steps(2);
    assert!(ghosts(&window).is_empty());
    assert!(viewer(&window).session().stage().options().ghosts.is_some());
}
