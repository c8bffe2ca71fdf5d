//! The text of a file beside the figure.

use std::sync::Arc;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2};
use egui_kittest::kittest::Queryable as _;
use posekit_viewer::load::Input;

use super::window::{Window, laptop, press, until, viewer};

/// Lines before the first row.
const HEAD_LINES: usize = 21;

/// A file as nobody would write it back: CR LF, a comment, odd spelling of numbers.
fn odd_text(frames: usize) -> String {
    let mut text = "HIERARCHY\nROOT Shoulder\n{\n\tOFFSET 0 0.0 -0\n\tCHANNELS 6 Xposition Yposition Zposition \
                    Zrotation Xrotation Yrotation\n\tJOINT Elbow\n\t{\n\t\tOFFSET 0 2e0 0\n\t\tCHANNELS 3 Zrotation \
                    Xrotation Yrotation\n\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 1 0\n\t\t}\n\t}\n}\n# by hand\nMOTION\n"
        .to_owned();
    text += &format!("Frames: {frames}\nFrame Time: 0.0333333\n# rows\n# more\n");
    for frame in 0..frames {
        text += &format!("{frame}.000 0 +0 {} 0 0 1.50 0 0\n", frame % 360);
    }
    text.replace('\n', "\r\n")
}

fn opened(text: &str) -> Window {
    let bytes = Arc::from(text.as_bytes());
    let name = "odd.bvh".to_owned();
    let mut window = laptop(vec![Input::Bytes { name, bytes }]);
    press(&mut window, Modifiers::NONE, Key::Space);
    press(&mut window, Modifiers::NONE, Key::Home);
    press(&mut window, Modifiers::SHIFT, Key::K);
    until(&mut window, |viewer| !viewer.is_working());
    window.run_steps(4);
    window
}

fn says(window: &Window, name: &str) -> String {
    let status = viewer(window).status(&window.ctx);
    status.get(name).expect("there is such a name").to_owned()
}

/// Left, top, right and bottom of a part of the panel.
fn place(window: &Window, name: &str) -> [f32; 4] {
    let said = says(window, name);
    let numbers: Vec<f32> = said
        .split(' ')
        .filter_map(|number| number.parse().ok())
        .collect();
    numbers
        .try_into()
        .unwrap_or_else(|_| panic!("{name} is {said:?}"))
}

fn click(window: &mut Window, at: Pos2) {
    window.event(Event::PointerMoved(at));
    for pressed in [true, false] {
        window.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.run_steps(1);
    }
    window.run_steps(3);
}

fn frame(window: &Window) -> usize {
    viewer(window).session().transport.frame()
}

#[test]
fn the_text_is_the_files_own_to_the_byte() {
    let text = odd_text(3);
    let window = opened(&text);
    let clip = viewer(&window).session().active_clip().unwrap();
    assert_eq!(clip.text.as_ref().unwrap().as_slice(), text.as_bytes());
    let lines = text.matches('\n').count() + 1;
    assert_eq!(
        says(&window, "text"),
        format!("{} of {lines}", HEAD_LINES + 1)
    );
}

#[test]
fn the_marked_row_follows_the_frame() {
    let mut window = opened(&odd_text(3000));
    for (key, line) in [
        (Key::ArrowRight, HEAD_LINES + 2),
        (Key::End, HEAD_LINES + 3000),
        (Key::Home, HEAD_LINES + 1),
    ] {
        press(&mut window, Modifiers::NONE, key);
        window.run_steps(30);
        assert_eq!(
            says(&window, "text"),
            format!("{line} of {}", HEAD_LINES + 3001)
        );
        let [_, top, _, bottom] = place(&window, "text-place");
        let [_, row_top, _, row_bottom] = place(&window, "text-row-place");
        assert!(top <= row_top && row_bottom <= bottom, "it is seen");
    }
    // While it plays, too.
    press(&mut window, Modifiers::NONE, Key::Space);
    for _ in 0..20 {
        window.run_steps(1);
        place(&window, "text-row-place");
    }
    assert!(frame(&window) > 0);
}

#[test]
fn a_click_on_a_row_goes_to_its_frame() {
    let mut window = opened(&odd_text(3000));
    viewer_mut(&mut window)
        .session_mut()
        .transport
        .go_to_frame(1500);
    window.run_steps(30);
    let [left, top, right, bottom] = place(&window, "text-row-place");
    let height = bottom - top;
    let at = pos2((left + right) / 2.0, (top + bottom) / 2.0);
    click(&mut window, at + egui::vec2(0.0, 2.0 * height));
    assert_eq!(frame(&window), 1502);
    // On the number of a line, too.
    let [left, top, ..] = place(&window, "text-row-place");
    click(&mut window, pos2(left + 3.0, top - height / 2.0));
    assert_eq!(frame(&window), 1501);
    assert!(!viewer(&window).session().transport.is_playing());
}

#[test]
fn the_hierarchy_is_no_frame() {
    let mut window = opened(&odd_text(10));
    press(&mut window, Modifiers::NONE, Key::ArrowRight);
    window.run_steps(10);
    let [left, top, right, _] = place(&window, "text-place");
    click(&mut window, pos2((left + right) / 2.0, top + 30.0));
    assert_eq!(frame(&window), 1);
}

#[test]
fn it_is_closed_and_says_where_there_is_none() {
    let mut window = opened(&odd_text(3));
    window.get_by_label_contains("Close the text").click();
    window.run_steps(3);
    assert_eq!(says(&window, "text"), "closed");
    assert_eq!(says(&window, "text-place"), "");
    let mut window = laptop(vec![Input::Sample("keyed-walk".to_owned())]);
    press(&mut window, Modifiers::SHIFT, Key::K);
    window.run_steps(3);
    window.get_by_label_contains("A scene has no frames in its file");
}

#[test]
fn a_listed_file_is_opened_with_its_text() {
    let folder = std::env::temp_dir().join(format!("posekit-text-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("odd.bvh"), odd_text(5)).unwrap();
    std::fs::write(folder.join("zero.bvh"), odd_text(7)).unwrap();
    let mut options = Some(posekit_viewer::ViewerOptions {
        paths: vec![folder.clone()],
        ..Default::default()
    });
    let mut window = egui_kittest::Harness::builder()
        .with_size(egui::Vec2::new(1366.0, 768.0))
        .build_ui_state(
            move |ui: &mut egui::Ui, viewer: &mut Option<posekit_viewer::Viewer>| {
                let viewer = viewer.get_or_insert_with(|| {
                    posekit_viewer::Viewer::new(
                        ui.ctx(),
                        None,
                        &Default::default(),
                        options.take().unwrap_or_default(),
                    )
                });
                viewer.show(ui);
            },
            None,
        );
    until(&mut window, |viewer| !viewer.is_working());
    assert_eq!(says(&window, "clip"), "odd.bvh");
    let listed = window.get_by_label("zero.bvh").rect();
    window.event(Event::PointerMoved(listed.center()));
    window.run_steps(3);
    window.get_by_label("Show the text of the file").click();
    until(&mut window, |viewer| {
        viewer
            .session()
            .active_clip()
            .is_some_and(|clip| clip.name == "zero.bvh")
    });
    until(&mut window, |viewer| !viewer.is_working());
    window.run_steps(4);
    // It plays, so that the row may be any of the seven.
    let (line, count) = window_line(&window);
    assert!((HEAD_LINES + 1..HEAD_LINES + 8).contains(&line), "{line}");
    assert_eq!(count, HEAD_LINES + 8);
    std::fs::remove_dir_all(folder).unwrap();
}

fn viewer_mut(window: &mut Window) -> &mut posekit_viewer::Viewer {
    window.state_mut().as_mut().expect("the window was shown")
}

/// The line of the frame's row, and how many there are.
fn window_line(window: &Window) -> (usize, usize) {
    let said = says(window, "text");
    let numbers = said.split_once(" of ");
    let numbers = numbers.and_then(|(line, count)| Some((line.parse().ok()?, count.parse().ok()?)));
    numbers.unwrap_or_else(|| panic!("{said}"))
}
