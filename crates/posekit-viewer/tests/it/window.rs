//! The window, used as a person uses it: clicks, keys, drops, silly things.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Key, Modifiers, Vec2, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use posekit_viewer::load::Input;
use posekit_viewer::state::display::Look;
use posekit_viewer::state::settings::Settings;
use posekit_viewer::{Viewer, ViewerOptions};

use super::clips::arm_text;

const PATIENCE: Duration = Duration::from_secs(60);

/// A file as the system drops it.
#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

pub(super) type Window = Harness<'static, Option<Viewer>>;

pub(super) fn input(name: &str, frames: usize) -> Input {
    let bytes = Arc::from(arm_text(frames).as_bytes());
    Input::Bytes {
        name: name.to_owned(),
        bytes,
    }
}

/// What shows a viewer of these clips in a window of egui.
pub(super) fn show(
    inputs: Vec<Input>,
    look: Look,
) -> impl FnMut(&mut egui::Ui, &mut Option<Viewer>) {
    let mut options = Some(ViewerOptions {
        inputs,
        ..ViewerOptions::default()
    });
    let settings = Settings {
        look,
        ..Settings::default()
    };
    move |ui, viewer| {
        let viewer = viewer.get_or_insert_with(|| {
            let options = options.take().unwrap_or_default();
            Viewer::new(ui.ctx(), None, &settings, options)
        });
        viewer.show(ui);
    }
}

pub(super) fn window(inputs: Vec<Input>, size: Vec2) -> Window {
    let mut window = Harness::builder()
        .with_size(size)
        .build_ui_state(show(inputs, Look::default()), None);
    until(&mut window, |viewer| !viewer.is_working());
    window
}

pub(super) fn laptop(inputs: Vec<Input>) -> Window {
    window(inputs, Vec2::new(1366.0, 768.0))
}

pub(super) fn viewer(window: &Window) -> &Viewer {
    window.state().as_ref().expect("the window was shown")
}

pub(super) fn until(window: &mut Window, done: impl Fn(&Viewer) -> bool) {
    let start = Instant::now();
    loop {
        window.step();
        if done(viewer(window)) {
            break;
        }
        assert!(start.elapsed() < PATIENCE, "it does not come");
        std::thread::sleep(Duration::from_millis(5));
    }
    window.run_steps(2);
}

/// Waits until the picture stands still: the quick one while things moved, then the sharp one.
pub(super) fn settle(window: &mut Window) {
    for _ in 0..4 {
        until(window, Viewer::is_drawn);
    }
}

pub(super) fn press(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(2);
}

#[test]
fn the_first_start_shows_the_sample_moving() {
    let mut window = laptop(Vec::new());
    let before = viewer(&window).session().transport.time_secs();
    assert!(viewer(&window).session().transport.is_playing());
    window.run_steps(5);
    assert!(viewer(&window).session().transport.time_secs() > before);
    window.get_by_label("Sample walk");
}

/// Files are read at the same time; the small one is there long before the large one.
#[test]
fn clips_stand_in_the_order_in_which_they_were_given() {
    let frames = [60_000, 3, 20_000, 5];
    let inputs = frames.map(|frames| input(&format!("{frames}.bvh"), frames));
    let window = laptop(inputs.to_vec());
    let session = viewer(&window).session();
    let names: Vec<&str> = session
        .clips()
        .iter()
        .map(|open| open.clip.name.as_str())
        .collect();
    assert_eq!(names, ["60000.bvh", "3.bvh", "20000.bvh", "5.bvh"]);
    let active = session.active_clip().expect("they are open");
    assert_eq!(active.name, "60000.bvh", "the first that was given");
    assert_eq!(session.shown().count(), 4);
    assert_eq!(session.transport.frame_count(), 60_000);
}

#[test]
fn space_pauses_and_arrows_step() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    assert!(!viewer(&window).session().transport.is_playing());
    press(&mut window, Modifiers::NONE, Key::Home);
    for (key, frame) in [
        (Key::ArrowRight, 1),
        (Key::ArrowRight, 2),
        (Key::ArrowLeft, 1),
    ] {
        press(&mut window, Modifiers::NONE, key);
        assert_eq!(viewer(&window).session().transport.frame(), frame);
    }
    press(&mut window, Modifiers::NONE, Key::End);
    assert_eq!(viewer(&window).session().transport.frame(), 19);
}

#[test]
fn buttons_do_what_keys_do() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    window.get_by_label_contains("Pause").click();
    window.run_steps(2);
    assert!(!viewer(&window).session().transport.is_playing());
    window.get_by_label_contains("To the end").click();
    window.run_steps(2);
    assert_eq!(viewer(&window).session().transport.frame(), 19);
}

#[test]
fn a_joint_clicked_in_the_tree_is_inspected() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    window.get_by_label("Elbow").click();
    window.run_steps(3);
    let session = viewer(&window).session();
    assert_eq!(session.selected().map(|joint| joint.index()), Some(1));
    window.get_by_label("Local rotation");
    window.get_by_label("Channels in the file");
}

#[test]
fn typing_into_a_filter_is_not_a_command() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    // The filter of the clips stands above that of the joints; both are text fields without a label.
    let fields = window.get_all_by_role(egui::accesskit::Role::TextInput);
    let lowest = fields.max_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
    lowest.expect("the filter of the joints").focus();
    window.run_steps(2);
    let style = viewer(&window).session().display().style;
    for key in [Key::Z, Key::Space, Key::Num7] {
        press(&mut window, Modifiers::NONE, key);
    }
    assert_eq!(viewer(&window).session().display().style, style);
    window.event(egui::Event::Text("elb".to_owned()));
    window.run_steps(3);
    assert!(window.query_by_label("Shoulder").is_none());
    window.get_by_label("Elbow");
}

#[test]
fn a_dropped_file_is_opened_and_a_bad_one_is_told() {
    let mut window = laptop(Vec::new());
    let folder = std::env::temp_dir().join(format!("posekit-drop-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let drop_bytes = |window: &mut Window, name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("written");
        window
            .input_mut()
            .dropped_files
            .push(Arc::new(Dropped(path)));
        window.run_steps(2);
        until(window, |viewer| !viewer.is_working());
    };
    drop_bytes(&mut window, "arm.bvh", &arm_text(7));
    let name = |window: &Window| {
        viewer(window)
            .session()
            .active_clip()
            .map(|clip| clip.name.clone())
            .unwrap_or_default()
    };
    assert_eq!(name(&window), "arm.bvh");
    drop_bytes(&mut window, "photo.jpg", "\u{0}\u{1}");
    assert_eq!(name(&window), "arm.bvh", "what was open stays");
    let notices = viewer(&window).notices().shown();
    assert!(
        notices
            .iter()
            .any(|notice| notice.text.starts_with("photo.jpg")),
        "{notices:?}"
    );
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn a_large_file_is_one_clip_and_stopping_it_takes_its_beginning_away() {
    let frames = 400_000;
    let mut window = laptop(vec![input("long.bvh", frames)]);
    let clips: Vec<usize> = viewer(&window)
        .session()
        .clips()
        .iter()
        .map(|open| open.clip.frame_count())
        .collect();
    assert_eq!(clips, [frames], "the beginning became the whole");
    let range = viewer(&window).session().transport.range();
    assert_eq!(range, (0, frames - 1));
    let longer = vec![input("longer.bvh", 4 * frames)];
    let state = window.state_mut().as_mut();
    state.expect("the window was shown").open_inputs(longer);
    let two = |viewer: &Viewer| viewer.session().clips().len() == 2;
    let start = Instant::now();
    while !two(viewer(&window)) {
        window.step();
        assert!(start.elapsed() < PATIENCE, "its beginning does not come");
    }
    window.get_by_label("Stop reading").click();
    until(&mut window, |viewer| !viewer.is_working());
    let clips = viewer(&window).session().clips();
    let names: Vec<&str> = clips.iter().map(|open| open.clip.name.as_str()).collect();
    assert_eq!(names, ["long.bvh"]);
}

#[test]
fn several_files_are_compared() {
    let window = laptop(vec![
        input("a.bvh", 9),
        input("b.bvh", 9),
        input("c.bvh", 9),
    ]);
    assert_eq!(viewer(&window).session().shown().count(), 3);
}

#[test]
fn the_list_of_keys_opens_and_closes() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::SHIFT, Key::Questionmark);
    window.get_by_label("Keys and mouse");
    press(&mut window, Modifiers::NONE, Key::Space);
    assert!(
        viewer(&window).session().transport.is_playing(),
        "keys wait while it is open"
    );
    press(&mut window, Modifiers::NONE, Key::Escape);
    window.run_steps(3);
    assert!(window.query_by_label("Keys and mouse").is_none());
}

#[test]
fn the_time_line_is_scrubbed_with_the_pointer() {
    let mut window = laptop(vec![input("arm.bvh", 21)]);
    let line = window.get_by_label("Time line").rect();
    let at = |share: f32| {
        pos2(
            line.left() + 10.0 + share * (line.width() - 20.0),
            line.top() + 8.0,
        )
    };
    window.drag_at(at(0.25));
    window.run_steps(2);
    assert_eq!(viewer(&window).session().transport.frame(), 5);
    window.hover_at(at(0.75));
    window.run_steps(2);
    assert_eq!(viewer(&window).session().transport.frame(), 15);
    window.drop_at(at(0.75));
    window.run_steps(2);
    assert!(!viewer(&window).session().transport.is_playing());
}

#[test]
fn a_bone_in_the_view_is_selected_by_a_click() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    press(&mut window, Modifiers::NONE, Key::Home);
    window.run_steps(3);
    let view = window.get_by_label_contains("View of the figure").rect();
    let session = viewer(&window).session();
    let joints = &session.poses_on_stage()[0].1.positions;
    let middle = joints[1].midpoint(joints[2]);
    let place = posekit_viewer::panels::view::project(&session.view_camera(), middle, view);
    let place = place.expect("the elbow's bone is in front");
    settle(&mut window);
    window.hover_at(place);
    window.run_steps(2);
    window.drag_at(place);
    window.step();
    window.drop_at(place);
    window.run_steps(3);
    let selected = viewer(&window)
        .session()
        .selected()
        .map(|joint| joint.index());
    assert_eq!(selected, Some(1));
}

#[test]
fn dragging_turns_the_view_and_the_wheel_zooms() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    let center = window
        .get_by_label_contains("View of the figure")
        .rect()
        .center();
    let camera = |window: &Window| viewer(window).session().view_camera();
    let before = camera(&window);
    window.drag_at(center);
    window.step();
    window.hover_at(center + Vec2::new(60.0, 0.0));
    window.run_steps(2);
    window.drop_at(center + Vec2::new(60.0, 0.0));
    window.run_steps(2);
    let turned = camera(&window);
    window.hover_at(center);
    window.run_steps(2);
    assert!(before.eye.distance(turned.eye) > 0.1);
    assert!((before.eye.distance(before.target) - turned.eye.distance(turned.target)).abs() < 1e-2);
    window.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: Vec2::new(0.0, 3.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(10);
    let near = camera(&window);
    assert!(near.eye.distance(near.target) < turned.eye.distance(turned.target));
}

#[test]
fn light_and_dark_are_remembered_with_the_rest() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::SHIFT, Key::G);
    for key in [Key::D, Key::K, Key::N] {
        press(&mut window, Modifiers::NONE, key);
    }
    let settings = viewer(&window).settings();
    assert_eq!(settings.look, Look::Dark);
    assert!(settings.display.ghosts && settings.layout.curves && !settings.layout.right);
    let text = serde_json::to_string(&settings).expect("settings are plain data");
    assert_eq!(
        serde_json::from_str::<Settings>(&text).expect("read back"),
        settings
    );
    let older = serde_json::from_str::<Settings>("{}").expect("what is missing is the default");
    assert_eq!(older, Settings::default());
}

#[test]
fn every_key_at_once_breaks_nothing_in_any_size() {
    for size in [Vec2::new(1366.0, 768.0), Vec2::new(300.0, 200.0)] {
        let mut window = window(vec![input("one.bvh", 1), input("none.bvh", 0)], size);
        for binding in posekit_viewer::command::BINDINGS {
            use posekit_viewer::command::Command;
            // Dialogs of the system have no place in a test.
            let asks = [
                Command::Open,
                Command::OpenFolder,
                Command::SaveRange,
                Command::SavePicture,
            ];
            if !asks.contains(&binding.command) {
                press(&mut window, binding.modifiers, binding.key);
                press(&mut window, Modifiers::NONE, Key::Escape);
            }
        }
    }
}

#[test]
fn nothing_is_drawn_again_while_nothing_changes() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    settle(&mut window);
    // The pointer's tooltips and the panels' animations come to rest, too.
    window.run_steps(60);
    settle(&mut window);
    let delay = window
        .output()
        .viewport_output
        .values()
        .map(|viewport| viewport.repaint_delay);
    let soonest = delay.min().expect("there is a window");
    assert!(soonest > Duration::from_secs(1), "{soonest:?}");
}

/// Esc closes the menu that is open, and nothing else: what is selected stays so.
#[test]
fn escape_closes_a_menu_first() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    window.get_by_label("Elbow").click();
    settle(&mut window);
    let selected = viewer(&window).session().selected();
    assert!(selected.is_some());
    window.get_by_label("Camera").click();
    settle(&mut window);
    assert!(window.query_by_label_contains("Three-quarter").is_some());
    press(&mut window, Modifiers::NONE, Key::Escape);
    settle(&mut window);
    assert!(window.query_by_label_contains("Three-quarter").is_none());
    assert_eq!(viewer(&window).session().selected(), selected);
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(viewer(&window).session().selected().is_none());
}
