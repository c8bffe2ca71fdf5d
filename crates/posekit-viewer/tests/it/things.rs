//! Cameras, lights and props: added, moved, keyed, looked through, and taken into a video.

use egui::{Key, Modifiers, Vec2, pos2};
use egui_kittest::kittest::Queryable as _;
use glam::{DQuat, DVec3, Vec3};
use posekit::rotation::Axis;
use posekit_formats::scene::{self, Scene};
use posekit_viewer::command::{Command, apply};
use posekit_viewer::gizmo::Handle;
use posekit_viewer::panels::view::project;
use posekit_viewer::state::animate::{Lane, LaneValue, Owner, Start, start};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::{KeyState, NewThing, Session};
use posekit_viewer::state::things::{Part, Picked, camera_corners};
use posekit_viewer::work::export::{ExportCamera, ExportOptions, Take};

use super::clips::walking;
use super::editing::{drag, place_on, view_rect};
use super::window::{Window, input, laptop, press, settle, viewer};

/// The walk as an authored clip in animation mode, standing at its start.
fn author(session: &mut Session) {
    let id = session.active_id().expect("a clip is open");
    let clip = session.active_clip().expect("a clip is open");
    let authored = start(clip, Start::Pose, 0.0, false).expect("any clip has a pose");
    session.put_authored(id, authored);
    session.set_mode(Mode::Animate);
    session.transport.pause();
    session.transport.go_to_frame(0);
}

fn session() -> Session {
    let mut session = Session::default();
    session.open(walking());
    author(&mut session);
    session
}

fn scene_of(session: &Session) -> &Scene {
    session.authored().expect("it is authored").scene()
}

fn vector(session: &Session, lane: Lane) -> DVec3 {
    match session.value_of(lane) {
        Some(LaneValue::Vector(vector)) => vector,
        other => panic!("no vector: {other:?}"),
    }
}

const LIGHT: Owner = Owner::Light(0);
const AT: Lane = Lane::LightPosition(0);

#[test]
fn things_are_added_named_taken_out_and_brought_back() {
    let mut session = session();
    for what in [
        NewThing::Light,
        NewThing::Light,
        NewThing::Box,
        NewThing::Camera,
    ] {
        session.add_thing(what);
    }
    assert_eq!(session.picked(), Some(Picked::body(Owner::Camera(0))));
    let names = |session: &Session| -> Vec<String> {
        let lights = &scene_of(session).lights;
        lights.iter().map(|light| light.name.clone()).collect()
    };
    assert_eq!(names(&session), ["light", "light 2"]);
    session.rename_thing(Owner::Light(1), "rim");
    session.remove_thing(LIGHT);
    assert_eq!(names(&session), ["rim"]);
    // On the stage there is what is in the scene.
    let drawn = session.scene();
    assert_eq!((drawn.lamps.len(), drawn.models.len()), (1, 2));
    session.undo();
    assert_eq!(names(&session), ["light", "rim"]);
    assert_eq!(session.scene().lamps.len(), 2);
    for _ in 0..5 {
        session.undo();
    }
    assert!(scene_of(&session).lights.is_empty() && scene_of(&session).cameras.is_empty());
    assert!(session.scene().lamps.is_empty());
    assert_eq!(session.picked(), None, "what is gone is not picked");
}

#[test]
fn a_value_that_is_not_keyed_is_set_for_good() {
    let mut session = session();
    session.add_thing(NewThing::Light);
    let to = DVec3::new(1.0, 2.0, 3.0);
    session.set_values("Move", &[(AT, LaneValue::Vector(to))], None);
    assert_eq!(session.key_state(AT), KeyState::Unkeyed);
    session.transport.go_to_frame(20);
    session.follow_changes();
    assert_eq!(vector(&session, AT), to);
    assert_eq!(session.scene().lamps[0].position, to.as_vec3());
}

#[test]
fn a_keyed_value_waits_for_its_key_unless_keys_are_automatic() {
    let mut session = session();
    session.add_thing(NewThing::Light);
    let before = vector(&session, AT);
    session.toggle_key(AT);
    assert_eq!(session.key_state(AT), KeyState::KeyHere);
    // Without auto-key another value is shown, and gone at another time.
    let to = before + DVec3::X;
    session.transport.go_to_frame(10);
    session.set_values("Move", &[(AT, LaneValue::Vector(to))], None);
    assert_eq!(session.key_state(AT), KeyState::Changed);
    assert!(session.has_pending_pose());
    assert_eq!(session.scene().lamps[0].position, to.as_vec3());
    session.transport.go_to_frame(11);
    session.follow_changes();
    assert_eq!(vector(&session, AT), before);
    // Keyed, it stays.
    session.transport.go_to_frame(10);
    session.set_values("Move", &[(AT, LaneValue::Vector(to))], None);
    session.insert_keys(posekit_viewer::state::session::KeyWhat::Selected);
    assert_eq!(session.key_state(AT), KeyState::KeyHere);
    let track = |session: &Session| {
        let authored = session.authored().expect("it is authored");
        authored.track(AT).map_or(0, |track| track.key_count())
    };
    assert_eq!(track(&session), 2);
    // With auto-key nothing waits, and what was not keyed gets its first key.
    let mut settings = session.animate();
    settings.auto_key = true;
    session.set_animate(settings);
    session.transport.go_to_frame(20);
    let strength = Lane::LightStrength(0);
    let values = [
        (AT, LaneValue::Vector(before)),
        (strength, LaneValue::Number(0.25)),
    ];
    session.set_values("Set", &values, None);
    assert_eq!(track(&session), 3);
    assert_eq!(session.key_state(strength), KeyState::KeyHere);
    // The key button takes the key away again.
    session.toggle_key(AT);
    assert_eq!(
        (track(&session), session.key_state(AT)),
        (2, KeyState::Keyed)
    );
    session.undo();
    assert_eq!(track(&session), 3);
}

#[test]
fn what_is_in_the_scene_is_what_is_drawn_at_every_time() {
    let mut session = session();
    let mut settings = session.animate();
    settings.auto_key = true;
    session.set_animate(settings);
    session.add_thing(NewThing::Box);
    let [at, turn, size] = [
        Lane::PropTranslation(0),
        Lane::PropRotation(0),
        Lane::PropScale(0),
    ];
    for (frame, x) in [(0, 0.0), (10, 1.0)] {
        session.transport.go_to_frame(frame);
        let values = [
            (at, LaneValue::Vector(DVec3::X * x)),
            (turn, LaneValue::Orientation(DQuat::from_rotation_y(x))),
            (size, LaneValue::Vector(DVec3::splat(1.0 + x))),
        ];
        session.set_values("Set", &values, None);
    }
    session.transport.go_to_frame(10);
    let drawn = session.scene();
    let model = drawn.models.last().expect("the box");
    let joint = model.joints[0];
    assert!(joint.translation.abs_diff_eq(Vec3::X, 1e-6));
    // Twice as large, and turned by a radian about Y.
    let x = joint.matrix3 * Vec3::X;
    let expected = 2.0 * Vec3::new(1.0_f32.cos(), 0.0, -1.0_f32.sin());
    assert!(x.abs_diff_eq(expected, 1e-5), "{x}");
}

#[test]
fn deleting_a_camera_moves_the_others_up_and_the_view_with_them() {
    let mut session = session();
    session.add_thing(NewThing::Camera);
    session.add_thing(NewThing::Camera);
    session.rename_thing(Owner::Camera(1), "second");
    session.look_through(Some(1));
    session.remove_thing(Owner::Camera(0));
    assert_eq!(session.looks_through(), Some(0));
    assert_eq!(scene_of(&session).cameras[0].name, "second");
    session.remove_thing(Owner::Camera(0));
    assert_eq!(session.looks_through(), None);
}

/// What the camera sees fills the frame that is drawn for it, in views of any shape.
#[test]
fn the_frame_in_the_view_is_what_the_camera_sees() {
    let mut session = session();
    session.add_thing(NewThing::Camera);
    session.look_through(Some(0));
    for (width, height, aspect) in [
        (1600, 900, 16.0 / 9.0),
        (900, 900, 16.0 / 9.0),
        (1600, 500, 1.0),
    ] {
        session.set_aspect(width as f32 / height as f32);
        session.set_frame_aspect(aspect);
        let camera = session.scene_camera().expect("it is looked through");
        let view = session.view_camera();
        assert_eq!((view.eye, view.target), (camera.eye, camera.target));
        let (share_x, share_y) = session.frame_shares();
        assert!(share_x < 1.0 && share_y < 1.0);
        let corners = camera_corners(&camera, aspect, 3.0);
        let place = |corner: Vec3| view.project(corner, (width, height)).expect("it is ahead");
        let (top_left, low_right) = (place(corners[0]), place(corners[2]));
        let (w, h) = (width as f32, height as f32);
        assert!(((low_right.x - top_left.x) / w - share_x).abs() < 1e-3);
        assert!(((low_right.y - top_left.y) / h - share_y).abs() < 1e-3);
        assert!((top_left.x + low_right.x - w).abs() < 0.5, "in the middle");
    }
}

#[test]
fn the_camera_takes_the_views_place_and_is_keyed_with_auto_key() {
    let mut session = session();
    session.camera_to_view();
    assert_eq!(scene_of(&session).cameras.len(), 1, "there was none");
    assert_eq!(session.looks_through(), Some(0));
    let near = |a: Vec3, b: Vec3| a.distance(b) < 1e-4;
    // From the side the camera is left where it is; then it is called for.
    let was = session.view_camera();
    session.look_through(None);
    session.camera.turn(0.4, 0.1);
    let view = session.view_camera();
    assert!(!near(was.eye, view.eye));
    let mut settings = session.animate();
    settings.auto_key = true;
    session.set_animate(settings);
    session.transport.go_to_frame(12);
    let view_then = session.view_camera();
    session.camera_to_view();
    let camera = session.scene_camera().expect("it is looked through");
    assert!(near(camera.eye, view_then.eye) && near(camera.target, view_then.target));
    assert_eq!(
        session.key_state(Lane::CameraPosition(0)),
        KeyState::KeyHere
    );
    assert_eq!(session.key_state(Lane::CameraTarget(0)), KeyState::KeyHere);
    // Leaving the camera stays where it is.
    session.leave_camera();
    let left = session.view_camera();
    assert!(near(left.eye, camera.eye), "{} {}", left.eye, camera.eye);
    assert_eq!(session.looks_through(), None);
}

/// How many keys a lane has.
fn key_count(session: &Session, lane: Lane) -> usize {
    let authored = session.authored().expect("it is authored");
    authored.track(lane).map_or(0, |track| track.key_count())
}

/// A shot is blocked by two views: the camera is at each at its time and moves between, whether the first
/// view made the camera, or found it where it is already.
#[test]
fn two_views_that_are_taken_make_a_camera_move() {
    for is_added_before in [false, true] {
        let mut session = session();
        session.transport.go_to_frame(3);
        if is_added_before {
            session.add_thing(NewThing::Camera);
        }
        apply(Command::ToggleAutoKey, &mut session);
        apply(Command::GoToStart, &mut session);
        let first = session.view_camera();
        apply(Command::CameraToView, &mut session);
        for lane in [Lane::CameraPosition(0), Lane::CameraTarget(0)] {
            assert_eq!(session.key_state(lane), KeyState::KeyHere, "{lane:?}");
        }
        session.transport.go_to_frame(12);
        session.follow_changes();
        apply(Command::TurnLeft, &mut session);
        apply(Command::TurnLeft, &mut session);
        let last = session.view_camera();
        assert!(first.eye.distance(last.eye) > 0.2);
        apply(Command::CameraToView, &mut session);
        assert_eq!(key_count(&session, Lane::CameraPosition(0)), 2);
        assert_eq!(key_count(&session, Lane::CameraTarget(0)), 2);
        let eye_at = |session: &mut Session, frame: usize| {
            session.transport.go_to_frame(frame);
            session.scene_camera().expect("it is looked through").eye
        };
        assert!(eye_at(&mut session, 0).distance(first.eye) < 1e-4);
        assert!(eye_at(&mut session, 12).distance(last.eye) < 1e-4);
        // Played, it goes from one to the other without a stop.
        let way: Vec<Vec3> = (0..=12).map(|frame| eye_at(&mut session, frame)).collect();
        for pair in way.windows(2) {
            assert!(pair[0].distance(pair[1]) > 1e-4, "{pair:?}");
        }
    }
}

/// With several cameras the view that turns away from one and is taken is that one's, though nothing is picked.
#[test]
fn a_view_that_is_taken_goes_to_the_camera_that_was_looked_through() {
    let mut session = session();
    for _ in 0..2 {
        session.add_thing(NewThing::Camera);
    }
    session.pick(None);
    session.look_through(Some(1));
    let place = |session: &Session, index| vector(session, Lane::CameraPosition(index));
    let first = place(&session, 0);
    // The arrows of the view turn it away from the camera.
    for _ in 0..3 {
        apply(Command::TurnLeft, &mut session);
    }
    assert_eq!(session.looks_through(), None);
    let view = session.view_camera();
    session.camera_to_view();
    assert_eq!(session.looks_through(), Some(1));
    assert_eq!(place(&session, 0), first, "the first stays where it is");
    assert!(place(&session, 1).as_vec3().distance(view.eye) < 1e-4);
    // And it is looked through again.
    apply(Command::TurnLeft, &mut session);
    apply(Command::LookThrough, &mut session);
    assert_eq!(session.looks_through(), Some(1));
}

/// Without auto-key a view is set as everything else is: for good while nothing is keyed, else until
/// another time is shown.
#[test]
fn a_view_that_is_taken_without_auto_key_is_set_as_other_values_are() {
    let mut session = session();
    session.camera_to_view();
    assert_eq!(key_count(&session, Lane::CameraPosition(0)), 0);
    apply(Command::TurnLeft, &mut session);
    let eye = session.view_camera().eye;
    session.camera_to_view();
    session.transport.go_to_frame(9);
    session.follow_changes();
    assert!(
        vector(&session, Lane::CameraPosition(0))
            .as_vec3()
            .distance(eye)
            < 1e-4
    );
    session.toggle_key(Lane::CameraPosition(0));
    session.transport.go_to_frame(2);
    session.follow_changes();
    apply(Command::TurnLeft, &mut session);
    session.camera_to_view();
    assert_eq!(
        session.key_state(Lane::CameraPosition(0)),
        KeyState::Changed
    );
    session.transport.go_to_frame(3);
    session.follow_changes();
    assert_eq!(session.key_state(Lane::CameraPosition(0)), KeyState::Keyed);
}

/// The first light keeps the studio light; the switch is a step, saved with the scene; the last light that goes
/// brings it back.
#[test]
fn the_studio_light_stays_until_it_is_switched_off() {
    let mut session = session();
    session.add_thing(NewThing::Light);
    assert_eq!(session.studio_light(), Some(true));
    let lit = session.scene();
    assert!(lit.casting_lamp().is_none() && lit.is_lit());
    session.set_studio_light(false);
    assert!(session.scene().casting_lamp().is_some());
    let read = |session: &Session| {
        scene::read(&scene::write(scene_of(session)).expect("it can be written")).expect("written")
    };
    assert!(!read(&session).studio_light);
    session.undo();
    assert_eq!(session.studio_light(), Some(true));
    assert!(read(&session).studio_light);
    session.redo();
    session.remove_thing(LIGHT);
    assert_eq!(
        session.studio_light(),
        Some(true),
        "no room is without any light"
    );
}

#[test]
fn three_point_lights_are_one_click_and_one_step() {
    let mut window = animating();
    add(&mut window, "Three-point lights");
    let session = viewer(&window).session();
    let lights = &scene_of(session).lights;
    let names: Vec<&str> = lights.iter().map(|light| light.name.as_str()).collect();
    assert_eq!(names, ["key light", "fill light", "rim light"]);
    assert_eq!(session.studio_light(), Some(false));
    // From the viewer: the key light to the left and before, the rim light behind.
    let view = session.view_camera();
    let (right, _, back) = view.axes();
    let side = |index: usize, axis: Vec3| {
        let at = lights[index].shine.position.at(0.0).as_vec3();
        (at - view.target).dot(axis)
    };
    assert!(side(0, right) < 0.0 && side(0, back) > 0.0);
    assert!(side(1, right) > 0.0 && side(1, back) > 0.0);
    assert!(side(2, back) < 0.0);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    let session = viewer(&window).session();
    assert!(scene_of(session).lights.is_empty() && session.studio_light() == Some(true));
}

#[test]
fn a_take_by_the_scenes_camera_has_its_lights_and_no_trace_of_the_work() {
    let mut session = session();
    session.add_thing(NewThing::Camera);
    session.add_thing(NewThing::Light);
    session.add_thing(NewThing::Box);
    session.camera.turn(1.0, 0.2);
    let options = ExportOptions {
        camera: ExportCamera::Scene(0),
        ..ExportOptions::default()
    };
    let take = Take::of(&session, &options);
    let drawn = take.scene(0.0);
    let LaneValue::Vector(eye) = session.value_of(Lane::CameraPosition(0)).expect("a camera")
    else {
        panic!("a place is a vector");
    };
    assert!(drawn.camera.eye.distance(eye.as_vec3()) < 1e-5);
    assert_eq!((drawn.lamps.len(), drawn.models.len()), (1, 2));
    let by_view = Take::of(&session, &ExportOptions::default()).scene(0.0);
    assert!(by_view.camera.eye.distance(drawn.camera.eye) > 0.1);
    // What is saved reads back as the same scene.
    let saved = scene::write(scene_of(&session)).unwrap();
    assert_eq!(
        &scene::read(&saved).expect("what is written"),
        scene_of(&session)
    );
}

// --- The window ---

/// The walk in the window, authored, with nothing around yet.
fn animating() -> Window {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    author(
        window
            .state_mut()
            .as_mut()
            .expect("it is shown")
            .session_mut(),
    );
    window.run_steps(2);
    window
}

fn add(window: &mut Window, what: &str) {
    window.get_by_label("Add").click();
    window.run_steps(2);
    window.get_by_label(what).click();
    window.run_steps(2);
    settle(window);
}

#[test]
fn names_that_say_what_a_thing_is_are_not_told_twice() {
    let mut window = animating();
    let session = window.state_mut().as_mut().expect("shown").session_mut();
    session.add_thing(NewThing::Camera);
    for what in ["Box", "Three-point lights"] {
        add(&mut window, what);
    }
    for name in ["camera", "box", "key light", "fill light", "rim light"] {
        window.get_by_label(name);
    }
    let mut named = |name: &str| {
        let session = window.state_mut().as_mut().expect("shown").session_mut();
        session.author(|authored| {
            let _ = authored.edit_scene("Name", None, |scene| {
                scene.lights[0].name = name.to_owned();
                scene.props[0].name = name.to_owned();
            });
            let (scene, skeleton) = (authored.scene(), authored.skeleton());
            [Owner::Light(0), Owner::Prop(0)].map(|owner| owner.name(scene, skeleton))
        })
    };
    assert_eq!(named("lamp").expect("a scene"), ["Light lamp", "Prop lamp"]);
    assert_eq!(
        named("Lighthouse").expect("a scene"),
        ["Light Lighthouse", "Prop Lighthouse"]
    );
    assert_eq!(named("").expect("a scene"), ["Light 1", "Prop 1"]);
}

#[test]
fn a_light_is_added_from_the_panel_set_and_keyed_by_its_diamond() {
    let mut window = animating();
    add(&mut window, "Light");
    window.get_by_label("light");
    let strength = Lane::LightStrength(0);
    let before = viewer(&window).session().value_of(strength);
    window.get_by_label("Strength").click();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.get_by_label("Strength").type_text("2.5");
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::Enter);
    let session = viewer(&window).session();
    assert_eq!(session.value_of(strength), Some(LaneValue::Number(2.5)));
    window.get_by_label("Key strength").click();
    window.run_steps(2);
    let session = viewer(&window).session();
    assert_eq!(session.key_state(strength), KeyState::KeyHere);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    let session = viewer(&window).session();
    assert_eq!(session.value_of(strength), before);
}

#[test]
fn a_light_is_dragged_by_its_arrow_along_one_axis_in_one_step() {
    let mut window = animating();
    add(&mut window, "Light");
    let before = vector(viewer(&window).session(), AT);
    let rect = view_rect(&window);
    let from = place_on(viewer(&window).session(), Handle::MoveAlong(Axis::X), rect);
    let steps = viewer(&window)
        .session()
        .authored()
        .map(|it| it.undo_count());
    drag(&mut window, from, from + Vec2::new(40.0, 0.0));
    assert!(viewer(&window).session().is_dragging());
    assert_eq!(
        viewer(&window)
            .session()
            .authored()
            .map(|it| it.undo_count()),
        steps
    );
    window.drop_at(from + Vec2::new(40.0, 0.0));
    window.run_steps(2);
    let after = vector(viewer(&window).session(), AT);
    let moved = after - before;
    assert!(moved.x.abs() > 0.05 && moved.length() - moved.x.abs() < 1e-5);
    let lamp = viewer(&window).session().scene().lamps[0];
    assert!(lamp.position.distance(after.as_vec3()) < 1e-5);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(vector(viewer(&window).session(), AT), before);
    // Esc on the way leaves it where it was.
    let from = place_on(viewer(&window).session(), Handle::MoveAlong(Axis::X), rect);
    drag(&mut window, from, from + Vec2::new(40.0, 0.0));
    press(&mut window, Modifiers::NONE, Key::Escape);
    window.drop_at(from);
    window.run_steps(2);
    assert_eq!(vector(viewer(&window).session(), AT), before);
}

#[test]
fn a_click_on_a_symbol_picks_it_and_a_click_on_a_bone_the_joint() {
    let mut window = animating();
    add(&mut window, "Light");
    let session = viewer(&window).session();
    let rect = view_rect(&window);
    let at = vector(session, AT).as_vec3();
    let place = project(&session.view_camera(), at, rect).expect("it is seen");
    window.get_by_label("Elbow").click();
    window.run_steps(2);
    assert_eq!(
        viewer(&window).session().picked(),
        None,
        "a joint is selected"
    );
    window.hover_at(place);
    window.run_steps(2);
    window.drag_at(place);
    window.step();
    window.drop_at(place);
    window.run_steps(2);
    let session = viewer(&window).session();
    assert_eq!(session.picked(), Some(Picked::body(LIGHT)));
    assert_eq!(session.selected(), None);
}

#[test]
fn zero_looks_through_the_camera_and_turning_the_view_leaves_it() {
    let mut window = animating();
    press(
        &mut window,
        Modifiers::COMMAND.plus(Modifiers::ALT),
        Key::Num0,
    );
    assert_eq!(viewer(&window).session().looks_through(), Some(0));
    press(&mut window, Modifiers::NONE, Key::Num0);
    assert_eq!(viewer(&window).session().looks_through(), None);
    press(&mut window, Modifiers::NONE, Key::Num0);
    assert_eq!(viewer(&window).session().looks_through(), Some(0));
    settle(&mut window);
    let eye = viewer(&window).session().view_camera().eye;
    let rect = view_rect(&window);
    let from = rect.min + Vec2::new(60.0, 200.0);
    drag(&mut window, from, from + Vec2::new(30.0, 0.0));
    window.drop_at(from + Vec2::new(30.0, 0.0));
    window.run_steps(2);
    let session = viewer(&window).session();
    assert_eq!(session.looks_through(), None);
    let now = session.view_camera().eye;
    assert!(
        now != eye && now.distance(eye) < 1.5,
        "from where the camera stands"
    );
    assert!(rect.contains(pos2(from.x, from.y)));
}

#[test]
fn the_cameras_target_is_a_handle_of_its_own() {
    let mut session = session();
    session.add_thing(NewThing::Camera);
    let [eye, target] =
        [Lane::CameraPosition(0), Lane::CameraTarget(0)].map(|lane| vector(&session, lane));
    let camera = Owner::Camera(0);
    let gizmo = session.gizmo().expect("the camera is picked");
    assert!(gizmo.position.distance(eye.as_vec3()) < 1e-4);
    session.pick(Some(Picked {
        owner: camera,
        part: Part::Target,
    }));
    let gizmo = session.gizmo().expect("the target is picked");
    assert!(gizmo.position.distance(target.as_vec3()) < 1e-4);
}
