//! Files are asked for where the system has no dialogs: by the window itself.

use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use posekit_viewer::state::settings::Settings;
use posekit_viewer::work::dialog::{Answer, SystemDialogs, Wanted};
use posekit_viewer::{Viewer, ViewerOptions};

use super::clips::arm_text;
use super::window::{Window, input, press, until, viewer};

/// A folder for one test, removed afterwards.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let name = format!("posekit dialogs {name} {}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        drop(std::fs::remove_dir_all(&folder));
        std::fs::create_dir_all(folder.join("two words")).expect("a temporary folder");
        for file in ["one.bvh", "other.bvh", "two words/three.bvh"] {
            std::fs::write(folder.join(file), arm_text(4)).expect("written");
        }
        Self(folder)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        drop(std::fs::remove_dir_all(&self.0));
    }
}

fn no_dialog(_: &Wanted, _: Option<&Path>) -> Answer {
    Answer::NoDialog
}

fn window_with(dialogs: SystemDialogs, place: &Place) -> Window {
    let mut options = Some(ViewerOptions {
        inputs: vec![input("arm.bvh", 20)],
        dialogs,
        ..ViewerOptions::default()
    });
    let settings = Settings {
        files_in: Some(place.0.clone()),
        ..Settings::default()
    };
    let show = move |ui: &mut egui::Ui, viewer: &mut Option<Viewer>| {
        let viewer = viewer.get_or_insert_with(|| {
            let options = options.take().unwrap_or_default();
            Viewer::new(ui.ctx(), None, &settings, options)
        });
        viewer.show(ui);
    };
    let mut window = Harness::builder()
        .with_size(Vec2::new(1000.0, 700.0))
        .build_ui_state(show, None);
    until(&mut window, |viewer| !viewer.is_working());
    press(&mut window, Modifiers::NONE, Key::Space);
    window
}

fn window(place: &Place) -> Window {
    window_with(SystemDialogs::of(no_dialog), place)
}

/// Presses keys that ask for a file, and waits for the window to ask.
fn asks(window: &mut Window, modifiers: Modifiers, key: Key) {
    press(window, modifiers, key);
    until(window, |viewer| viewer.chooser().is_some());
    window.run_steps(3);
}

fn types(window: &mut Window, text: &str) {
    window.event(egui::Event::Text(text.to_owned()));
    window.run_steps(2);
}

fn clears(window: &mut Window) {
    press(window, Modifiers::COMMAND, Key::A);
    press(window, Modifiers::NONE, Key::Backspace);
}

fn is_told(window: &Window, what: &str) -> bool {
    let notices = viewer(window).notices().shown();
    notices.iter().any(|notice| notice.text.contains(what))
}

#[test]
fn a_range_is_saved_where_the_system_has_no_dialogs() {
    let place = Place::new("saves");
    let mut window = window(&place);
    asks(&mut window, Modifiers::COMMAND, Key::S);
    window.get_by_label_contains("offers no file dialog");
    let field = window.get_by_role_and_label(Role::TextInput, "Save as");
    assert_eq!(field.value().as_deref(), Some("arm.bvh"));
    // The proposed name is selected but for its ending: typing replaces it.
    types(&mut window, "my range");
    press(&mut window, Modifiers::NONE, Key::Enter);
    until(&mut window, |viewer| viewer.notices().last().is_some());
    let path = place.0.join("my range.bvh");
    assert!(is_told(&window, &format!("Saved {}", path.display())));
    let written = std::fs::read(&path).expect("it is there");
    let clip = posekit_viewer::load::read_clip("again", &written).expect("it is whole");
    assert_eq!(clip.frame_count(), 20);
    assert!(viewer(&window).chooser().is_none());
    let remembered = viewer(&window).settings().files_in;
    assert_eq!(remembered.as_deref(), Some(&*place.0));
}

/// Presses and lets go a key in the frame that is to come, whatever else is in it.
fn in_the_same_frame(window: &mut Window, modifiers: Modifiers, key: Key) {
    for pressed in [true, false] {
        window.event(egui::Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers,
        });
    }
}

#[test]
fn a_name_and_the_enter_after_it_may_come_in_one_frame() {
    // As they do where somebody types fast and pictures are slow.
    let place = Place::new("fast");
    let mut window = window(&place);
    press(&mut window, Modifiers::COMMAND, Key::S);
    until(&mut window, |viewer| viewer.chooser().is_some());
    // The proposed name is typed over from the first frame on.
    window.event(egui::Event::Text("first".to_owned()));
    in_the_same_frame(&mut window, Modifiers::NONE, Key::Enter);
    until(&mut window, |viewer| viewer.chooser().is_none());
    until(&mut window, |viewer| viewer.notices().last().is_some());
    assert!(place.0.join("first.bvh").exists());
    // A key, and what was typed after it: first the folder that Tab completes, then the name in it.
    std::fs::create_dir(place.0.join("deep")).expect("a folder");
    asks(&mut window, Modifiers::COMMAND, Key::S);
    clears(&mut window);
    window.event(egui::Event::Text("dee".to_owned()));
    in_the_same_frame(&mut window, Modifiers::NONE, Key::Tab);
    window.event(egui::Event::Text("tw".to_owned()));
    window.event(egui::Event::Text("o".to_owned()));
    in_the_same_frame(&mut window, Modifiers::NONE, Key::Enter);
    let path = place.0.join("deep/two.bvh");
    until(&mut window, |viewer| viewer.chooser().is_none());
    until(&mut window, |_| path.exists());
}

#[test]
fn alt_up_goes_to_the_folder_above() {
    let place = Place::new("above");
    let mut window = window(&place);
    asks(&mut window, Modifiers::COMMAND, Key::O);
    let folder = |window: &Window| viewer(window).chooser().map(|it| it.folder().to_owned());
    let before = folder(&window).expect("open");
    press(&mut window, Modifiers::ALT, Key::ArrowUp);
    window.run_steps(2);
    assert_eq!(folder(&window).as_deref(), before.parent());
}

/// Whoever has seen a button and goes to it with the pointer finds it there: neither a question nor an empty
/// folder moves the window that asks.
#[test]
fn the_chooser_stays_where_it_is_whatever_it_says() {
    let place = Place::new("stays");
    std::fs::create_dir(place.0.join("empty")).expect("a folder");
    let mut window = window(&place);
    asks(&mut window, Modifiers::COMMAND, Key::S);
    let cancel = |window: &Window| window.get_by_label("Cancel").rect();
    let before = cancel(&window);
    let stays = |window: &Window| before.center().distance(cancel(window).center()) < 1.0;
    clears(&mut window);
    types(&mut window, "empty/one");
    until(&mut window, |viewer| {
        viewer.chooser().is_some_and(|it| it.row_count() == 0)
    });
    window.run_steps(4);
    window.get_by_label("Nothing here");
    assert!(stays(&window), "in an empty folder");
    clears(&mut window);
    types(&mut window, "nowhere/one");
    press(&mut window, Modifiers::NONE, Key::Enter);
    window.run_steps(4);
    window.get_by_label("Make the folder");
    assert!(stays(&window), "with a question");
}

#[test]
fn what_is_there_is_not_replaced_without_a_yes() {
    let place = Place::new("replaces");
    let path = place.0.join("one.bvh");
    let mut window = window(&place);
    asks(&mut window, Modifiers::COMMAND, Key::S);
    clears(&mut window);
    types(&mut window, "one.bvh");
    press(&mut window, Modifiers::NONE, Key::Enter);
    window.get_by_label_contains("one.bvh is there already");
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(viewer(&window).chooser().is_none());
    assert_eq!(std::fs::read_to_string(&path).expect("read"), arm_text(4));
    asks(&mut window, Modifiers::COMMAND, Key::S);
    clears(&mut window);
    types(&mut window, "one.bvh");
    press(&mut window, Modifiers::NONE, Key::Enter);
    window.get_by_label("Replace").click();
    window.run_steps(2);
    until(&mut window, |viewer| viewer.notices().last().is_some());
    let clip = std::fs::read(&path).expect("read");
    let clip = posekit_viewer::load::read_clip("again", &clip).expect("whole");
    assert_eq!(clip.frame_count(), 20);
}

#[test]
fn files_are_opened_by_a_path_with_tab_and_several_by_ticking() {
    let place = Place::new("opens");
    let mut window = window(&place);
    asks(&mut window, Modifiers::COMMAND, Key::O);
    types(&mut window, "two");
    press(&mut window, Modifiers::NONE, Key::Tab);
    types(&mut window, "t");
    press(&mut window, Modifiers::NONE, Key::Tab);
    press(&mut window, Modifiers::NONE, Key::Enter);
    until(&mut window, |viewer| !viewer.is_working());
    let names = |window: &Window| -> Vec<String> {
        let clips = viewer(window).session().clips().iter();
        clips.map(|open| open.clip.name.clone()).collect()
    };
    assert_eq!(names(&window), ["arm.bvh", "three.bvh"]);
    asks(&mut window, Modifiers::COMMAND, Key::O);
    types(&mut window, "../");
    press(&mut window, Modifiers::NONE, Key::ArrowDown);
    for _ in 0..2 {
        press(&mut window, Modifiers::NONE, Key::ArrowDown);
        press(&mut window, Modifiers::COMMAND, Key::Space);
    }
    window.get_by_label("Open 2");
    press(&mut window, Modifiers::NONE, Key::Enter);
    until(&mut window, |viewer| !viewer.is_working());
    assert_eq!(names(&window).len(), 4, "{:?}", names(&window));
}

#[test]
fn what_is_not_there_is_said_and_nothing_happens() {
    let place = Place::new("refuses");
    let mut window = window(&place);
    asks(&mut window, Modifiers::COMMAND, Key::O);
    types(&mut window, "no such file.bvh");
    press(&mut window, Modifiers::NONE, Key::Enter);
    window.get_by_label_contains("There is no file");
    clears(&mut window);
    types(&mut window, "no such folder/a.bvh");
    window.get_by_label_contains("There is no folder");
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(viewer(&window).chooser().is_none());
    assert_eq!(viewer(&window).session().clips().len(), 1);
}

#[test]
fn folders_scenes_pictures_and_films_are_asked_for_as_well() {
    let place = Place::new("kinds");
    let mut window = window(&place);
    let both = Modifiers::COMMAND | Modifiers::SHIFT;
    asks(&mut window, both, Key::O);
    press(&mut window, Modifiers::NONE, Key::Enter);
    until(&mut window, |viewer| !viewer.is_working());
    window.get_by_label("one.bvh");
    asks(&mut window, both, Key::S);
    press(&mut window, Modifiers::NONE, Key::Enter);
    until(&mut window, |viewer| viewer.notices().last().is_some());
    let frame = viewer(&window).session().transport.frame();
    let picture = std::fs::read(place.0.join(format!("arm_{frame}.png"))).expect("written");
    assert!(picture.starts_with(b"\x89PNG"));
    press(&mut window, Modifiers::COMMAND, Key::E);
    window.get_by_label("GIF").click();
    window.run_steps(2);
    window.get_by_label("Export\u{2026}").click();
    until(&mut window, |viewer| viewer.chooser().is_some());
    window.run_steps(2);
    let field = window.get_by_role_and_label(Role::TextInput, "Save as");
    assert_eq!(field.value().as_deref(), Some("arm.gif"));
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(viewer(&window).chooser().is_none());
}

#[test]
fn the_systems_dialog_is_used_where_there_is_one_and_cancelling_it_opens_nothing() {
    fn cancels(_: &Wanted, _: Option<&Path>) -> Answer {
        Answer::Cancelled
    }
    let place = Place::new("cancels");
    let mut window = window_with(SystemDialogs::of(cancels), &place);
    press(&mut window, Modifiers::COMMAND, Key::O);
    for _ in 0..20 {
        window.step();
        std::thread::sleep(std::time::Duration::from_millis(5));
        assert!(viewer(&window).chooser().is_none());
    }
    // The window's own is there for those who want it.
    window.get_by_label("File").click();
    window.run_steps(3);
    window.get_by_label("Choose files in this window").click();
    window.run_steps(3);
    assert!(viewer(&window).settings().asks_in_window);
    press(&mut window, Modifiers::NONE, Key::Escape);
    window.run_steps(3);
    asks(&mut window, Modifiers::COMMAND, Key::O);
    assert!(
        window
            .query_by_label_contains("offers no file dialog")
            .is_none()
    );
}

#[test]
fn an_ending_that_is_added_does_not_replace_a_file_silently() {
    fn names_without_ending(wanted: &Wanted, folder: Option<&Path>) -> Answer {
        assert_eq!(wanted.name(), "arm.bvh");
        let folder = folder.expect("a folder to start in");
        Answer::Chosen(vec![folder.join("one")])
    }
    let place = Place::new("ending");
    let mut window = window_with(SystemDialogs::of(names_without_ending), &place);
    asks(&mut window, Modifiers::COMMAND, Key::S);
    window.get_by_label_contains("one.bvh is there already");
    let kept = std::fs::read_to_string(place.0.join("one.bvh")).expect("read");
    assert_eq!(kept, arm_text(4));
}
