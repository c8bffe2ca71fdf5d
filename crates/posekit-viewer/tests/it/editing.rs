//! Editing poses: rings are dragged, edits are undone, reach the frames around, and are saved.

use egui::{Key, Modifiers, Pos2, Rect, Vec2, pos2};
use egui_kittest::kittest::Queryable as _;
use glam::Quat;
use posekit::rotation::Axis;
use posekit::skeleton::JointId;
use posekit_viewer::gizmo::{Gizmo, Handle, Outline, Viewport, pick, shapes};
use posekit_viewer::load::read_clip;
use posekit_viewer::state::edit::{Blend, Reach, Spread};
use posekit_viewer::state::mode::{Mode, Space};
use posekit_viewer::state::session::Session;
use posekit_viewer::work::files::range_parcel;

use super::clips::{arm, walking};
use super::window::{Window, input, laptop, press, settle, viewer};

/// A place on a handle of the gizmo where no other is taken.
pub(super) fn place_on(session: &Session, handle: Handle, rect: Rect) -> Pos2 {
    let gizmo = session.gizmo().expect("there is a gizmo");
    place_on_gizmo(&gizmo, &Viewport::new(session.view_camera(), rect), handle)
}

/// A place on a handle of any gizmo where no other is taken.
pub(super) fn place_on_gizmo(gizmo: &Gizmo, viewport: &Viewport, handle: Handle) -> Pos2 {
    let shapes = shapes(gizmo, viewport);
    let shape = shapes.iter().find(|shape| shape.handle == handle);
    let places: Vec<Pos2> = match &shape.expect("the handle is seen").outline {
        Outline::Ring(corners) => corners.iter().map(|corner| corner.0).collect(),
        Outline::Arrow(foot, tip) => vec![*foot + (*tip - *foot) * 0.8],
        Outline::Disc(middle) => vec![*middle],
        Outline::Square(corners) => vec![corners[0] + (corners[2] - corners[0]) * 0.5],
    };
    let free = places
        .into_iter()
        .find(|place| pick(&shapes, *place) == Some(handle));
    free.expect("the handle can be taken somewhere")
}

pub(super) fn view_rect(window: &Window) -> Rect {
    window.get_by_label_contains("View of the figure").rect()
}

/// Drags from one place to another in some steps. The button is still down.
pub(super) fn drag(window: &mut Window, from: Pos2, to: Pos2) {
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    for step in 1..=4_u8 {
        window.hover_at(from + (to - from) * (f32::from(step) / 4.0));
        window.step();
    }
}

pub(super) fn elbow_rotation(window: &Window) -> Quat {
    let session = viewer(window).session();
    let clip = session.active_clip().expect("a clip is open");
    clip.motion
        .rotation(session.transport.frame(), JointId::new(1))
}

/// The arm, standing at its first frame, its elbow selected, to be posed.
pub(super) fn posing() -> Window {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    press(&mut window, Modifiers::NONE, Key::Home);
    window.get_by_label("Elbow").click();
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::P);
    press(&mut window, Modifiers::NONE, Key::E);
    settle(&mut window);
    window
}

#[test]
fn a_ring_is_dragged_undone_and_redone() {
    let mut window = posing();
    assert_eq!(viewer(&window).session().mode(), Mode::Pose);
    let before = elbow_rotation(&window);
    let handle = Handle::TurnAbout(Axis::Z);
    let from = place_on(viewer(&window).session(), handle, view_rect(&window));
    drag(&mut window, from, from + Vec2::new(0.0, 60.0));
    assert!(viewer(&window).session().is_dragging());
    assert!(
        elbow_rotation(&window) == before,
        "nothing is written while it is dragged"
    );
    window.drop_at(from + Vec2::new(0.0, 60.0));
    window.run_steps(2);
    let after = elbow_rotation(&window);
    assert!(after.angle_between(before) > 0.2);
    let turned = (before.inverse() * after).normalize();
    assert!(
        turned.x.abs() < 1e-3 && turned.y.abs() < 1e-3,
        "about Z alone: {turned}"
    );
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(elbow_rotation(&window) == before);
    press(
        &mut window,
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::Z,
    );
    assert!(elbow_rotation(&window) == after);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    press(&mut window, Modifiers::COMMAND, Key::Y);
    assert!(elbow_rotation(&window) == after);
    assert!(
        viewer(&window).session().selected().is_some(),
        "the joint stays selected"
    );
}

#[test]
fn escape_lets_a_drag_fall_back() {
    let mut window = posing();
    let before = elbow_rotation(&window);
    let handle = Handle::TurnAbout(Axis::Z);
    let from = place_on(viewer(&window).session(), handle, view_rect(&window));
    let camera = viewer(&window).session().view_camera();
    drag(&mut window, from, from + Vec2::new(0.0, 60.0));
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!viewer(&window).session().is_dragging());
    window.drop_at(from + Vec2::new(0.0, 60.0));
    window.run_steps(2);
    let session = viewer(&window).session();
    assert!(elbow_rotation(&window) == before);
    assert!(session.edits().is_none_or(|edits| edits.undo_count() == 0));
    assert_eq!(session.view_camera(), camera, "the view did not turn");
}

#[test]
fn steps_are_whole_when_they_are_switched_on() {
    let mut window = posing();
    let before = elbow_rotation(&window);
    let handle = Handle::TurnAbout(Axis::Z);
    let from = place_on(viewer(&window).session(), handle, view_rect(&window));
    drag(&mut window, from, from + Vec2::new(0.0, 47.0));
    window.drop_at(from + Vec2::new(0.0, 47.0));
    window.run_steps(2);
    let free = before.angle_between(elbow_rotation(&window)).to_degrees() / 15.0;
    assert!((free - free.round()).abs() > 0.02, "{free}");
    // Switched on, it goes in steps without a key.
    press(&mut window, Modifiers::COMMAND, Key::Z);
    press(&mut window, Modifiers::NONE, Key::S);
    drag(&mut window, from, from + Vec2::new(0.0, 47.0));
    window.drop_at(from + Vec2::new(0.0, 47.0));
    window.run_steps(2);
    let whole = before.angle_between(elbow_rotation(&window)).to_degrees();
    let steps = whole / 15.0;
    assert!(
        (steps - steps.round()).abs() < 0.02 && steps > 0.5,
        "{whole}"
    );
}

#[test]
fn the_view_still_turns_beside_the_gizmo() {
    let mut window = posing();
    let camera = viewer(&window).session().view_camera();
    let corner = view_rect(&window).right_bottom() - Vec2::new(60.0, 60.0);
    drag(&mut window, corner, corner - Vec2::new(80.0, 0.0));
    window.drop_at(corner - Vec2::new(80.0, 0.0));
    window.run_steps(2);
    assert!(viewer(&window).session().view_camera() != camera);
}

#[test]
fn modes_are_chosen_in_the_bar() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    assert!(viewer(&window).session().transport.is_playing());
    window.get_by_label("Pose").click();
    window.run_steps(3);
    assert_eq!(viewer(&window).session().mode(), Mode::Pose);
    assert!(
        !viewer(&window).session().transport.is_playing(),
        "poses are edited standing still"
    );
    window.get_by_label("View").click();
    window.run_steps(3);
}

/// A session with the walk, in which a joint is turned by half a radian at frame 30.
fn turned(spread: Spread) -> (Session, JointId, Quat) {
    let mut session = Session::default();
    session.open(walking());
    session.set_mode(Mode::Pose);
    session.transport.go_to_frame(30);
    let joint = turning(5);
    let gesture = session.new_gesture().expect("a clip is open");
    session.set_spread(spread, gesture);
    let before = session
        .active_clip()
        .expect("open")
        .motion
        .rotation(30, joint);
    turn(&mut session, joint);
    (session, joint, before)
}

/// A joint of the walk that turns.
fn turning(index: usize) -> JointId {
    walking().motion.rotated_joints()[index]
}

/// Turns a joint with the gizmo, in a view of its own.
fn turn(session: &mut Session, joint: JointId) {
    session.select(Some(joint));
    let rect = Rect::from_min_size(pos2(0.0, 0.0), Vec2::new(900.0, 700.0));
    session.set_aspect(rect.aspect_ratio());
    let viewport = Viewport::new(session.view_camera(), rect);
    let handle = Handle::TurnOnScreen;
    let from = place_on(session, handle, rect);
    assert!(session.grab(handle, from, &viewport));
    let middle = viewport.project(session.gizmo().expect("held").position);
    let out = from - middle.expect("in front");
    let turned = egui::emath::Rot2::from_angle(-0.5) * out;
    session.drag_to(from + (turned - out), &viewport, None);
    session.drop_handle();
}

#[test]
fn an_edit_reaches_the_frames_around_and_fades() {
    let spread = Spread {
        reach: Reach::Frame,
        falloff_frames: 8,
        blend: Blend::Change,
    };
    let (session, joint, before) = turned(spread);
    let clip = session.active_clip().expect("open");
    let untouched = walking();
    let gap = |frame: usize| {
        let (a, b) = (&untouched.motion, &clip.motion);
        a.rotation(frame, joint)
            .angle_between(b.rotation(frame, joint))
    };
    let whole = before.angle_between(clip.motion.rotation(30, joint));
    assert!((whole - 0.5).abs() < 1e-2, "{whole}");
    for frame in 0..clip.frame_count() {
        let away = frame.abs_diff(30);
        let weight = if away >= 8 {
            0.0
        } else {
            0.5 * (1.0 + (std::f32::consts::PI * away as f32 / 8.0).cos())
        };
        assert!(
            (gap(frame) - whole * weight).abs() < 2e-3,
            "{frame}: {}",
            gap(frame)
        );
    }
    // It does not pop: no step is larger than the steepest of the cosine, beside the motion's own.
    for frame in 20..40 {
        let step = |motion: &posekit::motion::Motion| {
            motion
                .rotation(frame, joint)
                .angle_between(motion.rotation(frame + 1, joint))
        };
        let steepest = whole * std::f32::consts::PI / 16.0;
        assert!(step(&clip.motion) <= step(&untouched.motion) + steepest + 1e-3);
    }
}

#[test]
fn what_is_saved_differs_only_where_it_was_edited() {
    let spread = Spread {
        falloff_frames: 3,
        ..Spread::default()
    };
    let (session, joint, _) = turned(spread);
    let clip = session.active_clip().expect("open");
    let untouched = walking();
    let columns = clip.document.joint_columns(joint.index());
    for frame in 0..clip.frame_count() {
        let (old, new) = (untouched.document.row(frame), clip.document.row(frame));
        for column in 0..old.len() {
            let may_differ = (28..=32).contains(&frame) && columns.contains(&column);
            assert!(may_differ || old[column] == new[column], "{frame} {column}");
        }
    }
    let parcel = range_parcel(clip, (0, clip.frame_count() - 1)).expect("a valid document");
    let again = read_clip("again", &parcel.bytes).expect("what we write we read");
    for frame in 25..35 {
        for joint in clip.skeleton().joints() {
            let (a, b) = (
                clip.global.position(frame, joint),
                again.global.position(frame, joint),
            );
            assert!(a.distance(b) < 1e-4, "{frame}: {a} {b}");
        }
    }
}

#[test]
fn everything_is_undone_to_the_bit_and_done_again() {
    let (mut session, joint, _) = turned(Spread {
        falloff_frames: 5,
        ..Spread::default()
    });
    // Another frame, another joint, the fall-off changed, the first frame again, a reset, a keep.
    session.transport.go_to_frame(10);
    turn(&mut session, turning(8));
    let gesture = session.new_gesture().expect("open");
    for frames in [6, 9, 12] {
        let spread = Spread {
            falloff_frames: frames,
            reach: Reach::Stretch(8, 14),
            blend: Blend::Pose,
        };
        session.set_spread(spread, gesture);
    }
    session.transport.go_to_frame(30);
    turn(&mut session, joint);
    session.reset_draft();
    turn(&mut session, turning(2));
    session.keep_draft();
    let edited = session.active_clip().expect("open").document.clone();
    let count = session.edits().expect("edited").undo_count();
    assert_eq!(
        count, 7,
        "a turn, a turn, a slider, a turn, a reset, a turn, a keep"
    );
    let mut documents = vec![edited];
    while session.undo().is_some() {
        documents.push(session.active_clip().expect("open").document.clone());
    }
    let untouched = walking();
    let clip = session.active_clip().expect("open");
    assert_eq!(clip.document, untouched.document);
    for frame in 0..clip.frame_count() {
        for joint in clip.skeleton().joints() {
            assert!(clip.motion.rotation(frame, joint) == untouched.motion.rotation(frame, joint));
        }
    }
    documents.pop();
    while session.redo().is_some() {
        let expected = documents.pop().expect("as many steps forth as back");
        assert!(session.active_clip().expect("open").document == expected);
    }
    assert!(documents.is_empty());
}

#[test]
fn undo_goes_where_the_edit_is() {
    let (mut session, _, _) = turned(Spread::default());
    session.transport.go_to_frame(3);
    session.undo();
    assert_eq!(session.transport.frame(), 30);
    session.transport.go_to_frame(3);
    session.redo();
    assert_eq!(session.transport.frame(), 30);
}

#[test]
fn the_axes_of_the_gizmo_lie_as_they_are_asked_to() {
    let mut session = Session::default();
    session.open(arm(10));
    session.set_mode(Mode::Pose);
    session.transport.go_to_frame(4);
    session.select(Some(JointId::new(1)));
    let clip = session.active_clip().expect("open").clone();
    let of = |joint| clip.global.orientation(4, JointId::new(joint));
    for (space, expected) in [
        (Space::Local, of(1)),
        (Space::Parent, of(0)),
        (Space::World, Quat::IDENTITY),
    ] {
        let mut tools = session.tools();
        tools.space = space;
        session.set_tools(tools);
        let gizmo = session.gizmo().expect("the elbow turns");
        assert!(gizmo.axes.angle_between(expected) < 1e-3, "{space:?}");
    }
    // The hand is an End Site: it has nothing to turn.
    session.select(Some(JointId::new(2)));
    assert!(session.gizmo().is_none());
}

#[test]
fn clips_without_frames_are_not_edited() {
    let mut session = Session::default();
    session.open(arm(0));
    session.set_mode(Mode::Pose);
    session.select(Some(JointId::new(1)));
    assert!(session.gizmo().is_none());
    assert!(session.undo().is_none() && session.redo().is_none());
    session.keep_draft();
    session.reset_draft();
}

#[test]
fn a_clip_that_is_read_again_has_no_edits() {
    let (mut session, _, _) = turned(Spread::default());
    let id = session.active_id().expect("open");
    assert!(session.is_edited(id));
    session.keep_draft();
    assert!(session.is_edited(id), "what is kept is an edit still");
    session.undo();
    session.undo();
    assert!(!session.is_edited(id), "undone, there is none");
    session.redo();
    session.replace(id, walking());
    assert!(!session.is_edited(id) && session.undo().is_none());
}
