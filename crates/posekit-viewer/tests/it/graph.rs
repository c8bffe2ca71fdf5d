//! The graph editor: dots, handles and boxes are dragged, keys are pressed, numbers typed.

use std::collections::BTreeSet;

use egui::{Key, Modifiers, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::DVec3;
use posekit::keyframe::{Extrapolation, Interpolation, Keyframe, Tangents, Track};
use posekit::rotation::EulerOrder;
use posekit::skeleton::JointId;
use posekit_formats::scene::{Camera, Scene, SkeletonSource};
use posekit_viewer::panels::timeline::Tab;
use posekit_viewer::panels::timeline::graph::GraphPanel;
use posekit_viewer::state::animate::channel::{Dot, Side, TangentKind};
use posekit_viewer::state::animate::graph::{ChannelId, DotId, HandleId};
use posekit_viewer::state::animate::{Authored, Lane, LaneTrack, TrackValue};
use posekit_viewer::state::mode::Mode;

use super::editing::drag;
use super::window::{Window, input, laptop, press, settle, viewer};

fn elbow() -> Lane {
    Lane::Rotation(JointId::new(1))
}

const ORDER: EulerOrder = EulerOrder::ZXY;

/// An arm of which the elbow turns about Z from 0 to 60 degrees and back to 20 in two seconds, and a
/// camera whose place is keyed.
fn scene(window: &Window) -> Authored {
    let clip = viewer(window).session().active_clip().expect("a clip");
    let mut scene = Scene::new(SkeletonSource::inline(clip.skeleton()));
    scene.range_secs = [0.0, 2.0];
    scene.cameras.push(Camera {
        name: "Main".to_owned(),
        view: Default::default(),
    });
    let mut authored = Authored::new(scene, Default::default()).expect("it fits");
    let key = |time: f64, z: f64| {
        let angles = [z.to_radians(), 0.0, 0.0];
        Keyframe::new(time, ORDER.to_quat(angles), Interpolation::Cubic)
    };
    let keys = vec![key(0.0, 0.0), key(1.0, 60.0), key(2.0, 20.0)];
    let turns = Track::new(keys, Extrapolation::Hold).expect("valid");
    let places = [
        (0.0, DVec3::new(0.0, 1.0, 4.0)),
        (2.0, DVec3::new(2.0, 1.0, 4.0)),
    ];
    let places = places.map(|(time, place)| Keyframe::new(time, place, Interpolation::Cubic));
    let place = Track::new(places.to_vec(), Extrapolation::Hold).expect("valid");
    let changes = vec![
        (elbow(), Some(TrackValue::Orientation(turns))),
        (Lane::CameraPosition(0), Some(TrackValue::Vector(place))),
    ];
    authored.set_tracks("Start", None, changes, BTreeSet::new());
    authored
}

/// The graph of that scene, the elbow selected.
pub(super) fn graphing() -> Window {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    let authored = scene(&window);
    let shown = window.state_mut().as_mut().expect("it was shown");
    let id = shown.session().active_id().expect("a clip");
    shown.session_mut().put_authored(id, authored);
    shown.session_mut().set_mode(Mode::Animate);
    shown.session_mut().select(Some(JointId::new(1)));
    shown.timeline_mut().tab = Tab::Graph;
    window.run_steps(3);
    settle(&mut window);
    window
}

fn panel(window: &Window) -> &GraphPanel {
    viewer(window).timeline().graph()
}

pub(super) fn authored(window: &Window) -> &Authored {
    viewer(window).session().authored().expect("it is authored")
}

fn dot(key: usize, channel: usize) -> DotId {
    DotId {
        lane: elbow(),
        dot: Dot { key, channel },
    }
}

fn at(window: &Window, id: DotId) -> Pos2 {
    panel(window).dot_on_screen(id).expect("it is shown")
}

/// The angles of the elbow's key, degrees, in the order Z, X, Y.
pub(super) fn angles(window: &Window, key: usize) -> [f64; 3] {
    let Some(LaneTrack::Orientation(track)) = authored(window).track(elbow()) else {
        panic!("the elbow is keyed");
    };
    let angles = ORDER.from_quat(track.keys()[key].value);
    angles.angles_rad.map(f64::to_degrees)
}

pub(super) fn times(window: &Window) -> Vec<f64> {
    let track = authored(window).track(elbow()).expect("the elbow is keyed");
    track.times_secs().to_vec()
}

/// Degrees of a point on the screen, by two keys whose values are known.
fn degrees_per_point(window: &Window) -> f64 {
    let apart = at(window, dot(0, 0)).y - at(window, dot(1, 0)).y;
    60.0 / f64::from(apart)
}

fn click(window: &mut Window, at: Pos2) {
    window.hover_at(at);
    window.step();
    window.drag_at(at);
    window.drop_at(at);
    window.run_steps(2);
}

fn drag_and_drop(window: &mut Window, from: Pos2, by: Vec2) {
    drag(window, from, from + by);
    window.drop_at(from + by);
    window.run_steps(2);
}

#[test]
fn a_dot_is_dragged_in_value_and_one_step_undoes_it() {
    let mut window = graphing();
    let per_point = degrees_per_point(&window);
    let steps = authored(&window).undo_count();
    let from = at(&window, dot(1, 0));
    drag(&mut window, from, from + vec2(0.0, 30.0));
    let half_way = angles(&window, 1)[0];
    assert!(
        half_way < 55.0,
        "it is seen while it is dragged: {half_way}"
    );
    let bone = viewer(&window).session().active_clip().expect("a clip");
    let frame = bone.frame_at(1.0);
    let in_motion = bone.motion.rotation(frame, JointId::new(1));
    assert!(
        (f64::from(in_motion.to_axis_angle().1).to_degrees() - half_way).abs() < 0.1,
        "so is the figure"
    );
    window.drop_at(from + vec2(0.0, 30.0));
    window.run_steps(2);
    let [z, x, y] = angles(&window, 1);
    assert!((z - (60.0 - 30.0 * per_point)).abs() < 0.5, "{z}");
    assert!(x.abs() < 1e-9 && y.abs() < 1e-9);
    assert_eq!(times(&window), [0.0, 1.0, 2.0], "it snaps to its frame");
    assert_eq!(authored(&window).undo_count(), steps + 1);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert!((angles(&window, 1)[0] - 60.0).abs() < 1e-9);
    assert_eq!(authored(&window).undo_count(), steps);
}

#[test]
fn escape_gives_a_drag_up() {
    let mut window = graphing();
    let steps = authored(&window).undo_count();
    let from = at(&window, dot(1, 0));
    drag(&mut window, from, from + vec2(40.0, 30.0));
    assert!(angles(&window, 1)[0] < 55.0);
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!((angles(&window, 1)[0] - 60.0).abs() < 1e-9);
    assert_eq!(times(&window), [0.0, 1.0, 2.0]);
    window.drop_at(from + vec2(40.0, 30.0));
    window.run_steps(2);
    assert!(
        (angles(&window, 1)[0] - 60.0).abs() < 1e-9,
        "nor when the button is let go"
    );
    assert_eq!(authored(&window).undo_count(), steps);
    assert_eq!(viewer(&window).session().selected(), Some(JointId::new(1)));
}

#[test]
fn dots_go_from_frame_to_frame_and_freely_with_ctrl() {
    let mut window = graphing();
    let from = at(&window, dot(1, 0));
    drag_and_drop(&mut window, from, vec2(61.0, 0.0));
    let frame = times(&window)[1] * 30.0;
    assert!(
        (frame - frame.round()).abs() < 1e-6 && frame > 31.0,
        "{frame}"
    );
    assert!((angles(&window, 1)[0] - 60.0).abs() < 0.5);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    let before = times(&window)[1];
    let per_point = {
        let apart = at(&window, dot(2, 0)).x - at(&window, dot(0, 0)).x;
        2.0 / f64::from(apart)
    };
    window.event(egui::Event::ModifiersChanged(Modifiers::COMMAND));
    drag_and_drop(&mut window, from, vec2(61.0, 0.0));
    window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    window.run_steps(2);
    let moved = times(&window)[1] - before;
    assert!((moved - 61.0 * per_point).abs() < 0.004, "{moved}");
}

#[test]
fn a_handle_that_is_dragged_is_aligned_and_lies_under_the_pointer() {
    let mut window = graphing();
    let from = at(&window, dot(1, 0));
    click(&mut window, from);
    assert_eq!(
        panel(&window).graph().selected(),
        BTreeSet::from([dot(1, 0)]),
        "a click selects one channel of the key"
    );
    let handle = HandleId {
        at: dot(1, 0),
        side: Side::Outgoing,
    };
    let place = panel(&window)
        .handle_on_screen(handle)
        .expect("it is shown");
    let by = vec2(0.0, -25.0);
    drag_and_drop(&mut window, place, by);
    let after = panel(&window)
        .handle_on_screen(handle)
        .expect("it is shown");
    assert!(after.distance(place + by) < 1.0, "{after} {place}");
    let curves = &panel(&window).graph().curves()[&elbow()];
    assert_eq!(curves.tangent_kind(1), TangentKind::Aligned);
    let [incoming, outgoing] = curves.slopes(1).expect("no lock");
    assert!((incoming[0] - outgoing[0]).abs() < 1e-6);
    assert!(outgoing[0] > 10.0 && outgoing[1].abs() < 1e-6 && outgoing[2].abs() < 1e-6);
    // The handle on the other side has gone the other way.
    let other = HandleId {
        side: Side::Incoming,
        ..handle
    };
    let other = panel(&window).handle_on_screen(other).expect("it is shown");
    assert!(other.y > from.y + 20.0);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    let curves = &panel(&window).graph().curves()[&elbow()];
    assert_eq!(curves.tangent_kind(1), TangentKind::Auto);
}

#[test]
fn a_box_selects_and_g_moves_with_the_axis_locked() {
    let mut window = graphing();
    let (first, last) = (at(&window, dot(1, 0)), at(&window, dot(2, 0)));
    let corner = first.min(last) - vec2(20.0, 12.0);
    let size = (last - first).abs() + vec2(40.0, 24.0);
    drag_and_drop(&mut window, corner, size);
    assert_eq!(
        panel(&window).graph().selected(),
        BTreeSet::from([dot(1, 0), dot(2, 0)])
    );
    let pointer = first + vec2(0.0, 40.0);
    window.hover_at(pointer);
    window.step();
    press(&mut window, Modifiers::NONE, Key::G);
    press(&mut window, Modifiers::NONE, Key::X);
    window.hover_at(pointer + vec2(80.0, 37.0));
    window.run_steps(2);
    let moved = times(&window);
    assert!(moved[1] > 1.05, "{moved:?}");
    assert!(
        (angles(&window, 1)[0] - 60.0).abs() < 1e-6,
        "its value is locked"
    );
    // The other axis takes its place.
    press(&mut window, Modifiers::NONE, Key::Y);
    window.run_steps(2);
    assert_eq!(times(&window), [0.0, 1.0, 2.0]);
    assert!(angles(&window, 1)[0] < 59.0);
    // A click keeps it, and selects nothing else.
    window.drag_at(pointer + vec2(80.0, 37.0));
    window.step();
    window.drop_at(pointer + vec2(80.0, 37.0));
    window.run_steps(2);
    assert!(!panel(&window).is_busy());
    assert_eq!(panel(&window).graph().selected().len(), 2);
    let kept = angles(&window, 1)[0];
    window.hover_at(pointer);
    window.run_steps(2);
    assert_eq!(angles(&window, 1)[0], kept);
    let difference = |window: &Window| angles(window, 1)[0] - angles(window, 2)[0];
    assert!((difference(&window) - 40.0).abs() < 1e-6, "both have moved");
}

#[test]
fn s_scales_about_the_middle_and_the_right_button_gives_it_up() {
    let mut window = graphing();
    let (first, last) = (at(&window, dot(1, 0)), at(&window, dot(2, 0)));
    let corner = first.min(last) - vec2(20.0, 12.0);
    let size = (last - first).abs() + vec2(40.0, 24.0);
    drag_and_drop(&mut window, corner, size);
    let pivot = first + (last - first) * 0.5;
    let start = pivot + vec2(60.0, 0.0);
    window.hover_at(start);
    window.step();
    press(&mut window, Modifiers::NONE, Key::S);
    press(&mut window, Modifiers::NONE, Key::Y);
    window.hover_at(pivot + vec2(120.0, 0.0));
    window.run_steps(2);
    // 60 and 20 lie 20 from their middle at 40; twice as far is 80 and 0.
    let scaled = [angles(&window, 1)[0], angles(&window, 2)[0]];
    assert!(
        (scaled[0] - 80.0).abs() < 0.7 && scaled[1].abs() < 0.7,
        "{scaled:?}"
    );
    assert_eq!(times(&window), [0.0, 1.0, 2.0]);
    let place = pivot + vec2(120.0, 0.0);
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton {
            pos: place,
            button: PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    window.run_steps(2);
    assert!((angles(&window, 1)[0] - 60.0).abs() < 1e-6);
    assert!(
        window.query_by_label("Delete  (X)").is_none(),
        "it opens no menu"
    );
}

#[test]
fn esc_closes_the_menu_of_the_right_button_and_nothing_else() {
    let mut window = graphing();
    let selected = viewer(&window).session().selection().to_vec();
    assert!(!selected.is_empty());
    let beside = at(&window, dot(1, 0)) + vec2(40.0, 0.0);
    window.hover_at(beside);
    window.step();
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton {
            pos: beside,
            button: PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    window.run_steps(3);
    window.get_by_label("Delete  (X)");
    press(&mut window, Modifiers::NONE, Key::Escape);
    window.run_steps(3);
    assert!(window.query_by_label("Delete  (X)").is_none());
    assert_eq!(viewer(&window).session().selection(), selected);
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(viewer(&window).session().selection().is_empty());
}

#[test]
fn keys_choose_tangents_and_interpolation_in_menus() {
    let mut window = graphing();
    let place = at(&window, dot(1, 0));
    click(&mut window, place);
    window.hover_at(place);
    window.step();
    press(&mut window, Modifiers::NONE, Key::V);
    window.run_steps(2);
    window.get_by_label("Broken").click();
    window.run_steps(2);
    let kind = |window: &Window| panel(window).graph().curves()[&elbow()].tangent_kind(1);
    assert_eq!(kind(&window), TangentKind::Broken);
    window.hover_at(place);
    window.step();
    press(&mut window, Modifiers::NONE, Key::T);
    window.run_steps(2);
    window.get_by_label("step").click();
    window.run_steps(2);
    let Some(LaneTrack::Orientation(track)) = authored(&window).track(elbow()) else {
        panic!("the elbow is keyed");
    };
    assert_eq!(track.keys()[1].interpolation, Interpolation::Step);
    assert!(matches!(track.keys()[1].tangents, Tangents::Broken { .. }));
    assert_eq!(track.keys()[0].interpolation, Interpolation::Cubic);
}

#[test]
fn a_double_click_on_a_curve_puts_a_key_there_and_x_takes_it_away() {
    let mut window = graphing();
    let rect = panel(&window).plot_rect().expect("it is shown");
    let between = at(&window, dot(0, 0)).x * 0.5 + at(&window, dot(1, 0)).x * 0.5;
    let curves = std::sync::Arc::clone(&panel(&window).graph().curves()[&elbow()]);
    let value = curves.at(0.5)[0];
    let zero = at(&window, dot(0, 0)).y;
    let per_point = degrees_per_point(&window);
    let points = (0_u16..400).find(|points| f64::from(*points) * per_point >= value);
    let place = Pos2::new(between, zero - f32::from(points.expect("it is in view")));
    assert!(rect.contains(place));
    // The test's clock goes on by a quarter of a second with every event.
    let options = |options: &mut egui::Options| options.input_options.max_double_click_delay = 2.0;
    window.ctx.options_mut(options);
    window.hover_at(place);
    window.step();
    for _ in 0..2 {
        window.drag_at(place);
        window.event(egui::Event::PointerButton {
            pos: place,
            button: PointerButton::Primary,
            pressed: false,
            modifiers: Modifiers::NONE,
        });
    }
    window.run_steps(3);
    assert_eq!(times(&window).len(), 4);
    assert!((times(&window)[1] - 0.5).abs() < 1e-6);
    assert!(
        (angles(&window, 1)[0] - value).abs() < 1e-6,
        "it is on the curve"
    );
    press(&mut window, Modifiers::NONE, Key::X);
    assert_eq!(times(&window), [0.0, 1.0, 2.0]);
}

#[test]
fn the_wheel_zooms_in_time_and_with_ctrl_in_value() {
    let mut window = graphing();
    let place = at(&window, dot(1, 0));
    let apart = |window: &Window| at(window, dot(2, 0)) - at(window, dot(1, 0));
    let before = apart(&window);
    window.hover_at(place);
    window.step();
    let wheel = |window: &mut Window, modifiers: Modifiers| {
        window.event(egui::Event::ModifiersChanged(modifiers));
        window.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, 60.0),
            phase: egui::TouchPhase::Move,
            modifiers,
            source: egui::MouseWheelSource::Wheel,
        });
        window.run_steps(20);
        window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
        window.step();
    };
    wheel(&mut window, Modifiers::NONE);
    let wider = apart(&window);
    assert!(
        wider.x > before.x * 1.1 && (wider.y - before.y).abs() < 0.5,
        "{wider} {before}"
    );
    assert!(
        (at(&window, dot(1, 0)).x - place.x).abs() < 1.0,
        "about the pointer"
    );
    for modifiers in [Modifiers::COMMAND | Modifiers::CTRL, Modifiers::SHIFT] {
        let before = apart(&window);
        wheel(&mut window, modifiers);
        let taller = apart(&window);
        assert!(
            taller.y > before.y * 1.1,
            "{modifiers:?}: {taller} {before}"
        );
        assert!(
            (taller.x - before.x).abs() < 0.5,
            "{modifiers:?}: {taller} {before}"
        );
        assert!((at(&window, dot(1, 0)).y - place.y).abs() < 1.0);
    }
    press(&mut window, Modifiers::NONE, Key::Home);
    window.run_steps(2);
    assert!((apart(&window).x - before.x).abs() < 3.0);
}

#[test]
fn channels_are_hidden_and_other_lanes_shown() {
    let mut window = graphing();
    let graph = |window: &Window| panel(window).graph().clone();
    let channel = ChannelId {
        lane: elbow(),
        channel: 1,
    };
    assert!(graph(&window).is_seen(channel));
    window.get_by_label("X").click();
    window.run_steps(2);
    assert!(!graph(&window).is_seen(channel));
    assert!(graph(&window).dots().all(|dot| dot.dot.channel != 1));
    let camera = Lane::CameraPosition(0);
    assert!(!graph(&window).curves().contains_key(&camera));
    window
        .get_by_label("Show Camera Main \u{b7} position")
        .click();
    window.run_steps(2);
    assert!(graph(&window).curves().contains_key(&camera));
    let id = DotId {
        lane: camera,
        dot: Dot { key: 1, channel: 0 },
    };
    let from = at(&window, id);
    drag_and_drop(&mut window, from, vec2(0.0, -20.0));
    let Some(LaneTrack::Vector(track)) = authored(&window).track(camera) else {
        panic!("the camera is keyed");
    };
    let place = track.keys()[1].value;
    assert!(
        place.x > 2.05 && place.y == 1.0 && place.z == 4.0,
        "{place}"
    );
}

#[test]
fn what_is_picked_of_the_scene_shows_its_curves() {
    let mut window = graphing();
    let camera = Lane::CameraPosition(0);
    let is_shown = |window: &Window| panel(window).graph().curves().contains_key(&camera);
    assert!(!is_shown(&window));
    window.get_by_label("Camera Main").click();
    window.run_steps(2);
    assert!(is_shown(&window));
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!is_shown(&window), "it goes with what was picked");
}

#[test]
fn numbers_of_the_selected_key_can_be_typed() {
    let mut window = graphing();
    let place = at(&window, dot(1, 0));
    click(&mut window, place);
    let steps = authored(&window).undo_count();
    let set = |window: &mut Window, holds: &str, text: &str| {
        let field = window
            .get_all_by_role(egui::accesskit::Role::SpinButton)
            .find(|field| field.value().is_some_and(|value| value.contains(holds)));
        field.expect("the number is shown").click();
        window.run_steps(2);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.step();
        window.event(egui::Event::Text(text.to_owned()));
        window.step();
        window.key_press(Key::Enter);
        window.run_steps(3);
    };
    set(&mut window, "60", "45");
    assert!(
        (angles(&window, 1)[0] - 45.0).abs() < 1e-6,
        "{:?}",
        angles(&window, 1)
    );
    set(&mut window, "30", "36");
    assert!(
        (times(&window)[1] - 1.2).abs() < 1e-6,
        "{:?}",
        times(&window)
    );
    assert_eq!(authored(&window).undo_count(), steps + 2);
}
