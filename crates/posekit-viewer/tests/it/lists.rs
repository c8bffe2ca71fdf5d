//! The list of clips and its filter.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, Rect, Vec2};
use egui_kittest::kittest::Queryable as _;

use super::window::{Window, input, press, until, viewer, window};

/// Where the filter of the clips is: above that of the joints, both without a label.
fn filter_place(window: &Window) -> Rect {
    let fields = window.get_all_by_role(Role::TextInput);
    let highest = fields.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
    highest.expect("the filter of the clips").rect()
}

#[test]
fn escape_clears_a_filter_and_the_cross_lets_another_be_typed() {
    let mut window = window(vec![input("arm.bvh", 5)], Vec2::new(1366.0, 768.0));
    let field = filter_place(&window);
    let click = |window: &mut Window| {
        window.drag_at(field.center());
        window.run_steps(2);
        window.drop_at(field.center());
        window.run_steps(2);
    };
    click(&mut window);
    window.event(Event::Text("leg".to_owned()));
    window.run_steps(2);
    assert!(window.query_by_label("arm.bvh").is_none(), "it is filtered");
    press(&mut window, Modifiers::NONE, Key::Escape);
    window.get_by_label("arm.bvh");
    // The cross: what is typed next is a filter again, and no keys of the window.
    click(&mut window);
    window.event(Event::Text("leg".to_owned()));
    window.run_steps(2);
    window.get_by_label("Show all").click();
    window.run_steps(3);
    window.get_by_label("arm.bvh");
    assert!(window.ctx.text_edit_focused());
    window.event(Event::Text("u".to_owned()));
    window.run_steps(2);
    assert!(window.query_by_label("arm.bvh").is_none(), "it is filtered");
}

#[test]
fn what_is_opened_is_brought_into_sight_in_the_list() {
    let clips = (0..14).map(|index| input(&format!("clip {index:02}.bvh"), 3));
    let mut window = window(clips.collect(), Vec2::new(1000.0, 640.0));
    // The list glides there.
    window.run_steps(40);
    let is_in_sight = |window: &Window, name: &str| {
        let row = window.get_by_label(name).rect();
        let list = filter_place(window).bottom()..=window.get_by_label("Joints").rect().top();
        let is_seen = list.contains(&row.top()) && list.contains(&row.bottom());
        (is_seen, format!("{name}: {row} in {list:?}"))
    };
    let active = |window: &Window| {
        let clip = viewer(window).session().active_clip();
        clip.expect("one is active").name.clone()
    };
    let (is_seen, where_it_is) = is_in_sight(&window, &active(&window));
    assert!(is_seen, "{where_it_is}");
    let viewer_of = window.state_mut().as_mut().expect("the window was shown");
    viewer_of.open_inputs(vec![input("the new one.bvh", 4)]);
    until(&mut window, |viewer| {
        let active = viewer.session().active_clip();
        active.is_some_and(|clip| clip.name == "the new one.bvh") && !viewer.is_working()
    });
    // The list glides there.
    window.run_steps(40);
    let (is_seen, where_it_is) = is_in_sight(&window, "the new one.bvh");
    assert!(is_seen, "{where_it_is}");
    // The wheel is the user's: it stays where it was turned to.
    let list = window.get_by_label("the new one.bvh").rect().center();
    window.hover_at(list);
    window.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 2000.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
        source: egui::MouseWheelSource::Wheel,
    });
    window.run_steps(40);
    let (is_seen, where_it_is) = is_in_sight(&window, "clip 00.bvh");
    assert!(is_seen, "{where_it_is}");
    assert_eq!(viewer(&window).session().clips().len(), 15);
}
