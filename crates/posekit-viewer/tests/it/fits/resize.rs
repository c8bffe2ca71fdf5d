//! Edges of panels are dragged, as far as they go and back: panels follow, and what is in them has its room.

use egui::{Key, Modifiers, Rect, Role, Vec2, vec2};
use posekit_viewer::state::display::Look;

use super::super::window::{Window, press};
use super::Tour;
use super::seen::Watched;
use super::states;

/// The edges that can be dragged, in the order in which they are told.
fn edges(watched: &Watched) -> Vec<(String, Rect)> {
    let widgets = watched.seen().widgets(&watched.window);
    let edges = widgets
        .into_iter()
        .filter(|widget| widget.role == Role::Splitter);
    edges.map(|edge| (edge.name, edge.spot.rect)).collect()
}

/// Drags what is at a place by some way.
fn drag(window: &mut Window, from: egui::Pos2, by: Vec2) {
    window.hover_at(from);
    window.run_steps(2);
    window.drag_at(from);
    window.step();
    for step in 1..=4_u8 {
        window.hover_at(from + by * (f32::from(step) / 4.0));
        window.step();
    }
    window.drop_at(from + by);
    window.remove_cursor();
    window.run_steps(4);
}

/// Drags every edge as far as it goes, both ways, and looks at the window each time.
fn drag_all(tour: &mut Tour, name: &str) {
    let count = edges(&tour.watched).len();
    assert!(count > 0, "{name}: no edge can be dragged");
    for index in 0..count {
        let (_, before) = edges(&tour.watched)[index].clone();
        let stands = before.height() > before.width();
        let along = if stands {
            vec2(1.0, 0.0)
        } else {
            vec2(0.0, 1.0)
        };
        let place = |rect: Rect| {
            if stands {
                rect.center().x
            } else {
                rect.center().y
            }
        };
        let mut places = Vec::new();
        for far in [-2000.0, 2000.0, -2000.0] {
            // What is beside a panel may take the half of its edge that lies there.
            for inside in [0.0, -3.0, 3.0] {
                let (_, edge) = edges(&tour.watched)[index].clone();
                let from = edge.center() + along * inside;
                drag(&mut tour.watched.window, from, along * far);
                let (_, now) = edges(&tour.watched)[index].clone();
                if (place(now) - place(edge)).abs() > 1.0 {
                    break;
                }
            }
            let (_, edge) = edges(&tour.watched)[index].clone();
            places.push(place(edge));
            tour.look(&format!("{name}, edge {index} at {}", place(edge)));
        }
        assert!(
            (places[1] - places[0]).abs() > 20.0,
            "{name}: edge {index} does not move: {places:?}"
        );
        assert!((places[2] - places[0]).abs() < 1.0, "{name}: {places:?}");
        // Back to where it was.
        let (_, edge) = edges(&tour.watched)[index].clone();
        let back = place(before) - place(edge);
        drag(&mut tour.watched.window, edge.center(), along * back);
    }
}

fn resize(size: Vec2, sides: (bool, bool)) {
    let watched = Watched::new(states::inputs(), size, 1.0, Look::Light);
    let mut tour = Tour::new(watched, size);
    press(&mut tour.watched.window, Modifiers::NONE, Key::Space);
    states::set_sides(&mut tour.watched.window, sides);
    drag_all(&mut tour, "view");
    let faults = std::mem::take(&mut tour.faults);
    assert!(faults.is_empty(), "at {size}:\n{}", faults.join("\n"));
}

#[test]
fn edges_are_dragged_in_a_large_window() {
    resize(vec2(1280.0, 800.0), (true, true));
}

#[test]
fn edges_are_dragged_in_a_small_window() {
    resize(vec2(800.0, 600.0), (true, false));
    resize(vec2(800.0, 600.0), (false, true));
}

/// A panel that is not full, such as the curves of nothing, keeps the height that it is given.
#[test]
fn the_edge_of_an_empty_panel_is_dragged() {
    let mut watched = Watched::new(states::inputs(), vec2(1280.0, 800.0), 1.0, Look::Light);
    press(&mut watched.window, Modifiers::NONE, Key::Space);
    let without = edges(&watched);
    press(&mut watched.window, Modifiers::NONE, Key::K);
    watched.window.run_steps(4);
    let top = |watched: &Watched| {
        let lying = edges(watched)
            .into_iter()
            .map(|(_, rect)| rect)
            .filter(|rect| rect.width() > rect.height());
        lying
            .max_by(|a, b| a.width().total_cmp(&b.width()))
            .expect("an edge above the curves")
    };
    assert_eq!(edges(&watched).len(), without.len() + 1);
    let before = top(&watched);
    drag(
        &mut watched.window,
        before.center() + vec2(0.0, 3.0),
        vec2(0.0, -80.0),
    );
    let after = top(&watched);
    let moved = before.center().y - after.center().y;
    assert!((moved - 80.0).abs() < 8.0, "{moved}");
}
