//! What is selected, taken in hand by a key: it follows the pointer until a click.

use egui::{Key, Modifiers, Vec2};
use posekit::rotation::Axis;
use posekit::skeleton::JointId;
use posekit_viewer::gizmo::{Handle, Viewport};
use posekit_viewer::state::display::PoseShown;

use super::editing::{elbow_rotation, posing, view_rect};
use super::window::{Window, press, viewer};

/// As Blender's hands expect: the key takes it, the pointer turns it without a button, a click keeps it.
#[test]
fn r_turns_what_is_selected_with_the_pointer_and_a_click_keeps_it() {
    let mut window = posing();
    let before = elbow_rotation(&window);
    let session = viewer(&window).session();
    let gizmo = session.gizmo().expect("the elbow turns");
    let viewport = Viewport::new(session.view_camera(), view_rect(&window));
    let middle = viewport.project(gizmo.position).expect("it is seen");
    let camera = session.view_camera();
    window.hover_at(middle + Vec2::new(120.0, 0.0));
    window.step();
    press(&mut window, Modifiers::NONE, Key::R);
    assert!(viewer(&window).session().is_in_hand());
    window.hover_at(middle + Vec2::new(0.0, -120.0));
    window.run_steps(2);
    assert!(elbow_rotation(&window) == before, "nothing is written yet");
    let place = middle + Vec2::new(0.0, -120.0);
    window.drag_at(place);
    window.step();
    window.drop_at(place);
    window.run_steps(2);
    let session = viewer(&window).session();
    assert!(!session.is_dragging());
    assert_eq!(
        session.selected(),
        Some(JointId::new(1)),
        "the click is no pick"
    );
    assert_eq!(session.view_camera(), camera, "nor does the view turn");
    let after = elbow_rotation(&window);
    // A quarter turn, as the pointer went about the middle.
    assert!((after.angle_between(before) - std::f32::consts::FRAC_PI_2).abs() < 0.02);
    assert_eq!(session.edits().map(|edits| edits.undo_count()), Some(1));
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(elbow_rotation(&window) == before);
}

#[test]
fn what_is_in_hand_keeps_to_an_axis_and_is_given_up_by_escape_and_the_right_button() {
    let mut window = posing();
    let before = elbow_rotation(&window);
    let rect = view_rect(&window);
    let take = |window: &mut Window| {
        window.hover_at(rect.center() + Vec2::new(140.0, 30.0));
        window.step();
        press(window, Modifiers::NONE, Key::R);
    };
    let move_on = |window: &mut Window| {
        window.hover_at(rect.center() + Vec2::new(60.0, -130.0));
        window.run_steps(2);
    };
    take(&mut window);
    press(&mut window, Modifiers::NONE, Key::Z);
    move_on(&mut window);
    let handle = |window: &Window| viewer(window).session().drag().map(|drag| drag.handle());
    assert_eq!(handle(&window), Some(Handle::TurnAbout(Axis::Z)));
    press(&mut window, Modifiers::NONE, Key::Enter);
    let turned = (before.inverse() * elbow_rotation(&window)).normalize();
    assert!(turned.x.abs() < 1e-3 && turned.y.abs() < 1e-3, "{turned}");
    assert!(turned.z.abs() > 0.1, "{turned}");
    press(&mut window, Modifiers::COMMAND, Key::Z);
    // The axis' key again frees it.
    take(&mut window);
    press(&mut window, Modifiers::NONE, Key::X);
    press(&mut window, Modifiers::NONE, Key::X);
    assert_eq!(handle(&window), Some(Handle::TurnOnScreen));
    move_on(&mut window);
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!viewer(&window).session().is_dragging());
    assert!(elbow_rotation(&window) == before);
    // The right button gives up, too, and does not move the view.
    take(&mut window);
    move_on(&mut window);
    let camera = viewer(&window).session().view_camera();
    let at = rect.center() + Vec2::new(60.0, -130.0);
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    window.run_steps(2);
    let session = viewer(&window).session();
    assert!(!session.is_dragging() && session.view_camera() == camera);
    assert!(elbow_rotation(&window) == before);
}

#[test]
fn g_moves_the_root_and_says_of_other_joints_that_they_do_not_move() {
    let mut window = posing();
    press(&mut window, Modifiers::NONE, Key::G);
    assert!(!viewer(&window).session().is_dragging());
    let told = |window: &Window, text: &str| {
        let notices = viewer(window).notices().shown();
        notices.iter().any(|notice| notice.text.contains(text))
    };
    assert!(told(&window, "Elbow has no position channels"));
    press(&mut window, Modifiers::SHIFT, Key::ArrowUp);
    let root = |window: &Window| {
        let session = viewer(window).session();
        let clip = session.active_clip().expect("a clip is open");
        clip.motion.pose(session.transport.frame()).translations[0]
    };
    let before = root(&window);
    let from = view_rect(&window).center();
    window.hover_at(from);
    window.step();
    press(&mut window, Modifiers::NONE, Key::G);
    window.hover_at(from + Vec2::new(0.0, -50.0));
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::Enter);
    assert!(
        root(&window).y > before.y + 1e-3,
        "{before} {}",
        root(&window)
    );
    // Where nothing is edited the keys say what to do.
    press(&mut window, Modifiers::NONE, Key::Q);
    press(&mut window, Modifiers::NONE, Key::R);
    assert!(!viewer(&window).session().is_dragging());
    assert!(told(&window, "Choose Pose (P)"));
    press(&mut window, Modifiers::SHIFT, Key::R);
    assert_eq!(viewer(&window).session().pose_shown(), PoseShown::Rest);
}
