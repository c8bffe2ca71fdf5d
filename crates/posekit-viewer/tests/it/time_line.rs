//! What of time the timeline of the animation mode shows: all of the range, and the playhead, always.

use egui::{Key, Modifiers, Pos2, pos2, vec2};

use super::animate::{authored, blank};
use super::editing::view_rect;
use super::window::{Window, input, press, viewer};

fn seen(window: &Window) -> [f64; 2] {
    let axis = viewer(window).timeline().axis();
    axis.expect("the dope sheet is shown").seen_secs()
}

fn over_time_line(window: &Window) -> Pos2 {
    let rect = viewer(window).timeline().rect().expect("it is shown");
    pos2(rect.right() - 60.0, rect.bottom() - 20.0)
}

fn point_at(window: &mut Window, at: Pos2) {
    window.hover_at(at);
    window.run_steps(2);
}

/// The one key of a scene that was begun blank is no reason to show a few frames around it.
#[test]
fn home_over_the_timeline_shows_all_of_the_range_whatever_is_keyed() {
    let mut window = blank(input("arm.bvh", 40));
    let [start, end] = authored(&window).scene().range_secs;
    for frame in [0, 30] {
        let session = window
            .state_mut()
            .as_mut()
            .expect("it is shown")
            .session_mut();
        session.transport.go_to_frame(frame);
        let at = over_time_line(&window);
        point_at(&mut window, at);
        press(&mut window, Modifiers::NONE, Key::Home);
        window.run_steps(2);
        let [left, right] = seen(&window);
        assert!(left <= start && right >= end, "{left} to {right}");
        assert!(right - left < 1.3 * (end - start), "{left} to {right}");
        assert_eq!(viewer(&window).session().transport.frame(), frame);
    }
}

/// The playhead is brought into view when a key has sent it out.
#[test]
fn the_playhead_is_never_lost() {
    let mut window = blank(input("arm.bvh", 40));
    let at = over_time_line(&window);
    point_at(&mut window, at);
    window.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 900.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
        source: egui::MouseWheelSource::Wheel,
    });
    window.run_steps(60);
    let width = |[left, right]: [f64; 2]| right - left;
    let zoomed = width(seen(&window));
    assert!(seen(&window)[0] > 1.0, "the first frame is out of view");
    let over_view = view_rect(&window).center();
    point_at(&mut window, over_view);
    for (key, frame) in [
        (Key::End, 39),
        (Key::Home, 0),
        (Key::End, 39),
        (Key::ArrowUp, 39),
    ] {
        press(&mut window, Modifiers::NONE, key);
        window.run_steps(2);
        let session = viewer(&window).session();
        assert_eq!(session.transport.frame(), frame, "{key:?}");
        let [left, right] = seen(&window);
        let now = session.scene_secs();
        assert!(
            left < now && now < right,
            "{key:?}: {now} in {left} to {right}"
        );
        assert!(
            (width([left, right]) - zoomed).abs() < 1e-6,
            "the zoom stays"
        );
    }
}
