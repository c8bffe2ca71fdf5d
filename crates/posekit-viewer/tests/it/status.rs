//! What the viewer says of itself, held against the session and against where things are.

use egui::{Key, Modifiers, pos2};
use egui_kittest::kittest::Queryable as _;

use super::window::{Window, input, laptop, press, settle, until, viewer};

fn says(window: &Window, name: &str) -> String {
    let status = viewer(window).status(&window.ctx);
    let value = status.get(name);
    value.expect("there is such a name").to_owned()
}

#[test]
fn it_says_what_keys_have_done() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    let all = [("clip", "arm.bvh"), ("shown", "1"), ("mode", "View")];
    for (name, value) in all {
        assert_eq!(says(&window, name), value, "{name}");
    }
    assert_eq!(says(&window, "playing"), "true");
    for key in [Key::Space, Key::Home, Key::ArrowRight, Key::O, Key::Num1] {
        press(&mut window, Modifiers::NONE, key);
    }
    let all = [
        ("playing", "false"),
        ("frame", "1"),
        ("last-frame", "19"),
        ("range", "0 1"),
        ("camera", "0 3"),
        ("export", "closed"),
    ];
    for (name, value) in all {
        assert_eq!(says(&window, name), value, "{name}");
    }
    press(&mut window, Modifiers::COMMAND, Key::E);
    assert_eq!(says(&window, "export"), "choosing");
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(says(&window, "export"), "closed");
}

#[test]
fn windows_over_the_view_have_the_keys() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::COMMAND, Key::E);
    // Enter and Space have other meanings under the window.
    window.get_by_label("Cancel").focus();
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!(says(&window, "export"), "closed");
    assert_eq!(says(&window, "playing"), "true");
}

#[test]
fn it_says_that_a_key_is_shown_only_when_it_is() {
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    settle(&mut window);
    assert_eq!(says(&window, "drawn"), "true");
    window.key_press(Key::ArrowRight);
    // The window is drawn before it is done what the key asks for.
    window.step();
    let before = says(&window, "drawn");
    assert_eq!(before, "false");
    let pictures = says(&window, "pictures");
    until(&mut window, |viewer| viewer.is_drawn());
    assert_ne!(says(&window, "pictures"), pictures);
    let shot = viewer(&window).session().stage_time_secs();
    assert!(shot > 0.0);
}

#[test]
fn a_message_is_said_when_it_came_and_when_it_has_gone() {
    let mut window = laptop(vec![input("photo.jpg", 0)]);
    assert_eq!(says(&window, "notices"), "0");
    press(&mut window, Modifiers::COMMAND, Key::C);
    assert_eq!(says(&window, "notice"), "The picture was copied");
    assert_eq!(says(&window, "notice-kind"), "done");
    assert_eq!(says(&window, "notices"), "1");
    window.input_mut().time = Some(1e6);
    window.run_steps(2);
    assert_eq!(says(&window, "notices"), "0");
    assert_eq!(says(&window, "notice"), "The picture was copied");
}

#[test]
fn places_are_where_the_pointer_finds_them() {
    let mut window = laptop(vec![input("arm.bvh", 21)]);
    let numbers = |window: &Window, name: &str| -> Vec<f32> {
        let text = says(window, name);
        text.split(' ')
            .map(|n| n.parse().expect("a number"))
            .collect()
    };
    let line = numbers(&window, "time-line-place");
    let x = line[0] + (line[2] - line[0]) * 15.0 / 20.0;
    window.drag_at(pos2(x, (line[1] + line[3]) / 2.0));
    window.run_steps(2);
    assert_eq!(says(&window, "frame"), "15");
    let view = numbers(&window, "view-place");
    let shown = window.get_by_label_contains("View of the figure").rect();
    let off = [shown.min.x, shown.min.y, shown.max.x, shown.max.y];
    for (said, is) in view.iter().zip(off) {
        assert!((said - is).abs() <= 0.5, "{view:?} {shown}");
    }
}
