//! The animation mode: poses are blocked with keys, and keys are edited in the dope sheet.

use std::path::{Path, PathBuf};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::kittest::Queryable as _;
use glam::Quat;
use posekit::keyframe::edit::SAME_TIME_SECS;
use posekit::keyframe::{Extrapolation, Interpolation};
use posekit::skeleton::JointId;
use posekit_formats::scene;
use posekit_viewer::load::Input;
use posekit_viewer::state::animate::{Authored, KeyId, Lane, place};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::Session;

use super::editing::{drag, place_on, view_rect};
use super::window::{Window, laptop, press, settle, viewer};

fn course() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data/course/motion_walking.bvh");
    if path.is_file() {
        return Some(path);
    }
    eprintln!("skipped: {} is missing", path.display());
    None
}

pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("posekit-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    folder
}

pub(crate) fn authored(window: &Window) -> &Authored {
    viewer(window)
        .session()
        .authored()
        .expect("a scene is open")
}

pub(crate) fn session(window: &mut Window) -> &mut Session {
    let viewer = window.state_mut().as_mut().expect("the window was shown");
    viewer.session_mut()
}

/// The window with a clip that is animated from a blank sheet, standing at its first frame.
pub(crate) fn blank(input: Input) -> Window {
    let mut window = laptop(vec![input]);
    press(&mut window, Modifiers::NONE, Key::Space);
    press(&mut window, Modifiers::NONE, Key::Home);
    press(&mut window, Modifiers::NONE, Key::A);
    assert_eq!(viewer(&window).session().mode(), Mode::Animate);
    window.get_by_label("Blank, from this pose").click();
    settle(&mut window);
    window
}

fn go_to(window: &mut Window, frame: usize) {
    session(window).transport.go_to_frame(frame);
    window.run_steps(2);
}

/// Turns a joint with the ring that faces the viewer, in the window.
fn turn(window: &mut Window, joint: JointId) {
    session(window).select(Some(joint));
    window.hover_at(Pos2::new(683.0, 60.0));
    press(window, Modifiers::NONE, Key::E);
    settle(window);
    let rect = view_rect(window);
    let handle = posekit_viewer::gizmo::Handle::TurnOnScreen;
    let from = place_on(viewer(window).session(), handle, rect);
    drag(window, from, from + Vec2::new(24.0, 30.0));
    window.drop_at(from + Vec2::new(24.0, 30.0));
    settle(window);
}

/// A joint with a name that has this in it.
fn joint(window: &Window, part: &str) -> JointId {
    let skeleton = authored(window).skeleton();
    let mut joints = skeleton.joints();
    joints
        .find(|joint| skeleton.name(*joint).contains(part) && !skeleton.is_end_site(*joint))
        .expect("the skeleton has such a joint")
}

fn times(authored: &Authored, lane: Lane) -> Vec<f64> {
    let track = authored.track(lane);
    track.map_or_else(Vec::new, |track| track.times_secs().to_vec())
}

/// The middle of the dope sheet's row of all keys, at a time.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a share of a width on the screen"
)]
fn summary_at(window: &Window, secs: f64) -> Pos2 {
    let sheet = window.get_by_label_contains("Dope sheet:").rect();
    // All of the range is in view at first, with 18 points at both ends; the scroll bar is beside it.
    let [start, end] = authored(window).scene().range_secs;
    let share = ((secs - start) / (end - start)) as f32;
    let left = sheet.left() + 18.0;
    let width = sheet.width() + 9.0 - 36.0;
    Pos2::new(left + share * width, sheet.top() + 10.0)
}

pub(crate) fn block_three_poses(window: &mut Window, names: [&str; 2]) -> [JointId; 2] {
    let joints = names.map(|name| joint(window, name));
    for (frame, joint) in [(20, joints[0]), (40, joints[1])] {
        go_to(window, frame);
        turn(window, joint);
        assert!(
            viewer(window).session().has_pending_pose(),
            "without auto-key a pose is held"
        );
        press(window, Modifiers::SHIFT, Key::I);
        window.run_steps(2);
    }
    joints
}

fn blocks_edits_saves_and_reopens(input: Input, names: [&str; 2]) {
    let mut window = blank(input);
    let first = authored(&window).scene().clone();
    let joints = block_three_poses(&mut window, names);
    let lane = Lane::Rotation(joints[0]);
    let rate = authored(&window).scene().frames_per_sec;
    let frame = |n: f64| n / rate;
    assert_eq!(times(authored(&window), lane).len(), 3, "three poses");
    // What is between keys is between poses: the figure follows.
    let motion = viewer(&window)
        .session()
        .active_clip()
        .expect("open")
        .motion
        .clone();
    let turned = |frame: usize| motion.rotation(frame, joints[0]);
    assert!(turned(0).angle_between(turned(20)) > 0.05);
    let half = turned(0).angle_between(turned(10));
    assert!(half > 0.01 && half < turned(0).angle_between(turned(20)));

    // The middle pose is dragged ten frames on, in the dope sheet.
    let from = summary_at(&window, frame(20.0));
    let to = summary_at(&window, frame(30.0));
    drag(&mut window, from, to);
    window.drop_at(to);
    window.run_steps(3);
    let moved = times(authored(&window), lane);
    assert!((moved[1] - frame(30.0)).abs() < 1e-9, "{moved:?}");

    // Everything is scaled about the first frame by the keys.
    go_to(&mut window, 0);
    window.hover_at(to);
    window.step();
    press(&mut window, Modifiers::NONE, Key::A);
    assert_eq!(
        authored(&window).selection().len(),
        authored(&window).key_count()
    );
    press(&mut window, Modifiers::NONE, Key::S);
    window.hover_at(summary_at(&window, frame(15.0)));
    window.step();
    press(&mut window, Modifiers::NONE, Key::Enter);
    let scaled = times(authored(&window), lane);
    assert!((scaled[1] - frame(15.0)).abs() < 1e-9, "{scaled:?}");
    assert!((scaled[2] - frame(20.0)).abs() < 1e-9, "{scaled:?}");

    // The first pose is copied and pasted left for right at frame 60.
    let first_key = summary_at(&window, 0.0);
    click(&mut window, first_key);
    window.event(Event::Copy);
    window.run_steps(2);
    go_to(&mut window, 60);
    window.event(Event::Paste("posekit".into()));
    window.run_steps(2);
    assert_eq!(times(authored(&window), lane).len(), 4);
    let at = |window: &Window, secs: f64| authored(window).pose_at(secs);
    let (start_pose, pasted) = (at(&window, 0.0), at(&window, frame(60.0)));
    let same = |a: Quat, b: Quat| (a.dot(b).abs() - 1.0).abs() < 1e-5;
    for (a, b) in start_pose.rotations.iter().zip(&pasted.rotations) {
        assert!(same(*a, *b), "a pose that was pasted is that pose");
    }
    // The same keys change sides.
    press(&mut window, Modifiers::COMMAND, Key::M);
    let mirrored = at(&window, frame(60.0));
    let skeleton = authored(&window).skeleton().clone();
    let axis = posekit::keyframe::edit::mirror_axis(&skeleton);
    let expected = posekit::keyframe::edit::mirror_pose(&skeleton, axis, &pasted);
    for joint in skeleton.joints().filter(|j| !skeleton.is_end_site(*j)) {
        let (a, b) = (
            mirrored.rotations[joint.index()],
            expected.rotations[joint.index()],
        );
        assert!(same(a, b), "{}", skeleton.name(joint));
    }

    // Saved, it reads as the same scene, and opens as that.
    let place_of_file = folder("animate").join(format!("{}.posekit.toml", names[0]));
    save_to(&mut window, &place_of_file);
    let bytes = std::fs::read(&place_of_file).expect("it is written");
    let read = scene::read(&bytes).expect("what we write we read");
    let folder_of_it = place_of_file.parent().expect("a folder");
    assert_eq!(
        read,
        place::written(authored(&window).scene(), folder_of_it)
    );
    assert_eq!(
        scene::write(&read).expect("it can be written"),
        bytes,
        "to the byte"
    );
    assert!(!authored(&window).is_dirty());
    let again = laptop(vec![Input::Path(place_of_file.clone())]);
    assert_eq!(authored(&again).scene(), authored(&window).scene());

    // All is undone, to the start, and done again.
    let last = authored(&window).scene().clone();
    let steps = authored(&window).undo_count();
    assert_eq!(
        steps, 6,
        "two poses, a move, a scaling, a paste, a mirroring"
    );
    for _ in 0..steps {
        press(&mut window, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(authored(&window).scene(), &first);
    assert!(authored(&window).is_dirty(), "the file has more");
    for _ in 0..steps {
        press(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }
    assert_eq!(authored(&window).scene(), &last);
    assert!(!authored(&window).is_dirty());
    std::fs::remove_file(&place_of_file).expect("removed");
}

fn click(window: &mut Window, at: Pos2) {
    window.hover_at(at);
    window.step();
    for pressed in [true, false] {
        window.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    window.run_steps(2);
}

pub(crate) fn save_to(window: &mut Window, path: &Path) {
    let ctx = window.ctx.clone();
    let viewer = window.state_mut().as_mut().expect("shown");
    let id = viewer.session().active_id().expect("open");
    viewer.save_scene_to(&ctx, id, path.to_owned());
    window.run_steps(2);
}

#[test]
fn three_poses_on_the_sample_are_blocked_edited_saved_and_reopened() {
    let input = Input::Sample("walk".into());
    blocks_edits_saves_and_reopens(input, ["LeftUpperArm", "RightUpperLeg"]);
}

#[test]
fn three_poses_on_the_course_skeleton_are_blocked_edited_saved_and_reopened() {
    if let Some(path) = course() {
        blocks_edits_saves_and_reopens(Input::Path(path), ["lShoulder", "rHip"]);
    }
}

#[test]
fn auto_key_keys_what_was_turned_and_nothing_else() {
    let mut window = blank(Input::Sample("walk".into()));
    window.get_by_label("Auto-key").click();
    window.run_steps(2);
    let arm = joint(&window, "LeftUpperArm");
    let leg = joint(&window, "RightUpperLeg");
    go_to(&mut window, 12);
    turn(&mut window, arm);
    assert!(!viewer(&window).session().has_pending_pose());
    let rate = authored(&window).scene().frames_per_sec;
    let keyed = times(authored(&window), Lane::Rotation(arm));
    assert!((keyed[1] - 12.0 / rate).abs() < SAME_TIME_SECS);
    assert_eq!(times(authored(&window), Lane::Rotation(leg)).len(), 1);
    assert_eq!(authored(&window).undo_count(), 1);
}

#[test]
fn a_pose_that_is_not_keyed_is_gone_at_another_time() {
    let mut window = blank(Input::Sample("walk".into()));
    let arm = joint(&window, "LeftUpperArm");
    turn(&mut window, arm);
    assert!(viewer(&window).session().has_pending_pose());
    go_to(&mut window, 3);
    assert!(!viewer(&window).session().has_pending_pose());
    assert_eq!(authored(&window).undo_count(), 0);
}

#[test]
fn ways_between_and_beyond_are_set_from_the_menus() {
    let mut window = blank(Input::Sample("walk".into()));
    let joints = block_three_poses(&mut window, ["LeftUpperArm", "RightUpperLeg"]);
    let over = summary_at(&window, 0.3);
    window.hover_at(over);
    window.step();
    press(&mut window, Modifiers::NONE, Key::A);
    press(&mut window, Modifiers::NONE, Key::T);
    window.run_steps(2);
    window.get_by_label("linear").click();
    window.run_steps(2);
    let lane = Lane::Rotation(joints[0]);
    let track = authored(&window).track(lane).expect("keyed");
    assert_eq!(track.interpolation(0), Interpolation::Linear);
    window.hover_at(over);
    window.step();
    press(&mut window, Modifiers::SHIFT, Key::E);
    window.run_steps(2);
    window.get_by_label("cycle both").click();
    window.run_steps(2);
    let track = authored(&window).track(lane).expect("keyed");
    assert_eq!(track.beyond(), [Extrapolation::Cycle; 2]);
}

#[test]
fn keys_are_selected_in_a_box_deleted_and_added() {
    let mut window = blank(Input::Sample("walk".into()));
    let joints = block_three_poses(&mut window, ["LeftUpperArm", "RightUpperLeg"]);
    let count = authored(&window).key_count();
    let rate = authored(&window).scene().frames_per_sec;
    let from = summary_at(&window, 35.0 / rate) - Vec2::new(0.0, 8.0);
    let to = summary_at(&window, 45.0 / rate) + Vec2::new(0.0, 9.0);
    drag(&mut window, from, to);
    window.drop_at(to);
    window.run_steps(2);
    let selected = authored(&window).selection().clone();
    assert!(!selected.is_empty());
    let at = |key: &KeyId| authored(&window).time_of(*key);
    assert!(
        selected
            .iter()
            .all(|key| at(key).is_some_and(|t| (t - 40.0 / rate).abs() < 1e-6))
    );
    window.hover_at(to);
    window.step();
    press(&mut window, Modifiers::NONE, Key::X);
    assert_eq!(authored(&window).key_count(), count - selected.len());
    assert_eq!(times(authored(&window), Lane::Rotation(joints[0])).len(), 2);
    let place = summary_at(&window, 50.0 / rate);
    window
        .ctx
        .options_mut(|options| options.input_options.max_double_click_delay = 5.0);
    window.hover_at(place);
    window.step();
    for _ in 0..2 {
        click_once(&mut window, place);
    }
    window.run_steps(2);
    let keyed = times(authored(&window), Lane::Rotation(joints[0]));
    assert!(
        keyed.iter().any(|t| (t - 50.0 / rate).abs() < 1e-6),
        "{keyed:?}"
    );
}

/// A click. Steps of the clock are long here: two of them are a double click all the same.
fn click_once(window: &mut Window, at: Pos2) {
    for pressed in [true, false] {
        window.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    window.step();
}

#[test]
fn escape_gives_a_move_up() {
    let mut window = blank(Input::Sample("walk".into()));
    block_three_poses(&mut window, ["LeftUpperArm", "RightUpperLeg"]);
    let before = authored(&window).scene().clone();
    let steps = authored(&window).undo_count();
    window.hover_at(summary_at(&window, 0.2));
    window.step();
    press(&mut window, Modifiers::NONE, Key::A);
    press(&mut window, Modifiers::NONE, Key::G);
    window.hover_at(summary_at(&window, 0.6));
    window.run_steps(2);
    assert_ne!(
        authored(&window).scene(),
        &before,
        "keys follow the pointer"
    );
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(authored(&window).scene(), &before);
    assert_eq!(authored(&window).undo_count(), steps);
}
