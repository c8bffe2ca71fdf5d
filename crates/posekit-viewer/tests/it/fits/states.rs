//! The states of the window, one after another: every mode with its sides open and closed, with nothing and with
//! something in it, and what lies over it.

use std::sync::Arc;

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use posekit::skeleton::JointId;
use posekit_viewer::load::Input;
use posekit_viewer::panels::sides::{Room, Sides};
use posekit_viewer::state::interpolation::{Kind, Page, Picture};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::{NewThing, Session};

use super::super::clips::{arm_text, walking};
use super::super::window::{Window, press, until, viewer};
use super::Tour;

/// A clip, another with a long name, and one with something to be said about it.
pub(super) fn inputs() -> Vec<Input> {
    let named = |name: &str, text: String| Input::Bytes {
        name: name.to_owned(),
        bytes: Arc::from(text.as_bytes()),
    };
    let broken = arm_text(30).replace("Frames: 30", "Frames: 31");
    vec![
        named("arm.bvh", arm_text(400)),
        named(
            "a walk of many steps, recorded on a long day, take 12.bvh",
            arm_text(70),
        ),
        named("cut short.bvh", broken),
    ]
}

fn session(window: &mut Window) -> &mut Session {
    let viewer = window.state_mut().as_mut().expect("the window was shown");
    viewer.session_mut()
}

/// Presses the control that is called so, wherever it is: in a list that opens where there is little room.
fn use_control(window: &mut Window, name: &str) {
    if !press_named(window, name) {
        let lists = window.query_all_by_role(egui::Role::ComboBox).count();
        for index in 0..lists {
            let list = window.query_all_by_role(egui::Role::ComboBox).nth(index);
            list.expect("it was counted").click_accesskit();
            window.run_steps(3);
            if press_named(window, name) {
                return;
            }
            press(window, Modifiers::NONE, Key::Escape);
        }
        panic!("there is no '{name}'");
    }
}

fn press_named(window: &mut Window, name: &str) -> bool {
    let exact = window.query_all_by_label(name).next();
    // Lines of menus have their keys, or a sign that there is more, behind their names.
    let begins = || {
        let mut nodes = window.query_all_by_label_contains(name);
        nodes.find(|node| {
            let label = node.accesskit_node().label().unwrap_or_default();
            label.starts_with(name)
        })
    };
    let Some(node) = exact.or_else(begins) else {
        return false;
    };
    node.click_accesskit();
    window.run_steps(3);
    true
}

fn has_control(window: &Window, name: &str) -> bool {
    window.query_all_by_label_contains(name).next().is_some()
}

/// Opens and closes the sides; false where there is no room for that.
pub(super) fn set_sides(window: &mut Window, (left, right): (bool, bool)) -> bool {
    let size = window.ctx.content_rect().size();
    if left && right && Room::of(size) != Room::Wide {
        return false;
    }
    let shown = |window: &Window| {
        let sides = Sides::of(viewer(window).layout(), size);
        (sides.left, sides.right)
    };
    // Where one goes when the other comes, what is closed is closed first.
    for _ in 0..2 {
        let (is_left, is_right) = shown(window);
        if is_left != left && (!left || !is_right || right) {
            press(window, Modifiers::NONE, Key::T);
        }
        let (_, is_right) = shown(window);
        if is_right != right {
            press(window, Modifiers::NONE, Key::N);
        }
    }
    assert_eq!(shown(window), (left, right));
    true
}

const SIDES: [(bool, bool); 4] = [(false, false), (true, false), (false, true), (true, true)];

fn name_of((left, right): (bool, bool)) -> &'static str {
    match (left, right) {
        (false, false) => "",
        (true, false) => ", left",
        (false, true) => ", right",
        (true, true) => ", both sides",
    }
}

/// Looks at a state with every arrangement of the sides.
fn with_sides(tour: &mut Tour, name: &str) {
    for sides in SIDES {
        if set_sides(&mut tour.watched.window, sides) {
            tour.look(&format!("{name}{}", name_of(sides)));
        }
    }
    set_sides(&mut tour.watched.window, (false, false));
}

fn key(tour: &mut Tour, modifiers: Modifiers, key: Key) {
    press(&mut tour.watched.window, modifiers, key);
}

fn mode(tour: &mut Tour, mode: Mode) {
    let (modifiers, pressed) = match mode {
        Mode::View => (Modifiers::NONE, Key::Q),
        Mode::Pose => (Modifiers::NONE, Key::P),
        Mode::Ik => (Modifiers::NONE, Key::U),
        Mode::Animate => (Modifiers::NONE, Key::A),
        Mode::Lab => (Modifiers::NONE, Key::B),
        Mode::Interpolation => (Modifiers::SHIFT, Key::B),
    };
    key(tour, modifiers, pressed);
    assert_eq!(viewer(&tour.watched.window).session().mode(), mode);
}

/// Goes through all of them.
pub(super) fn all(tour: &mut Tour) {
    key(tour, Modifiers::NONE, Key::Space);
    key(tour, Modifiers::NONE, Key::Home);
    viewing(tour);
    posing(tour);
    limbs(tour);
    animating(tour);
    lab(tour);
    interpolation(tour);
    over_everything(tour);
    menus(tour);
    messages(tour);
    empty(tour);
}

fn viewing(tour: &mut Tour) {
    mode(tour, Mode::View);
    with_sides(tour, "view");
    session(&mut tour.watched.window).select(Some(JointId::new(1)));
    with_sides(tour, "view, a joint");
    key(tour, Modifiers::NONE, Key::K);
    with_sides(tour, "view, curves");
    key(tour, Modifiers::SHIFT, Key::K);
    until(&mut tour.watched.window, |viewer| !viewer.is_working());
    with_sides(tour, "view, curves and text");
    key(tour, Modifiers::NONE, Key::K);
    with_sides(tour, "view, text");
    key(tour, Modifiers::SHIFT, Key::K);
    key(tour, Modifiers::SHIFT, Key::R);
    tour.look("view, rest pose");
    key(tour, Modifiers::SHIFT, Key::R);
    key(tour, Modifiers::NONE, Key::I);
    let transport = &mut session(&mut tour.watched.window).transport;
    transport.set_range(20, 340);
    transport.set_speed(0.25);
    tour.look("view, a range");
    let transport = &mut session(&mut tour.watched.window).transport;
    transport.clear_range();
    transport.set_speed(1.0);
}

fn posing(tour: &mut Tour) {
    session(&mut tour.watched.window).select(None);
    mode(tour, Mode::Pose);
    with_sides(tour, "pose");
    session(&mut tour.watched.window).select(Some(JointId::new(0)));
    with_sides(tour, "pose, the root");
    if set_sides(&mut tour.watched.window, (true, false)) {
        use_control(&mut tour.watched.window, "Poses");
        tour.look("poses");
        use_control(&mut tour.watched.window, "Save pose of 1 joint");
        tour.look("poses, one");
        use_control(&mut tour.watched.window, "Clips");
    }
}

fn limbs(tour: &mut Tour) {
    session(&mut tour.watched.window).select(None);
    mode(tour, Mode::Ik);
    with_sides(tour, "IK");
    session(&mut tour.watched.window).select(Some(JointId::new(2)));
    with_sides(tour, "IK, an effector");
    key(tour, Modifiers::NONE, Key::H);
    key(tour, Modifiers::NONE, Key::PageDown);
    with_sides(tour, "IK, a pin, step by step");
    key(tour, Modifiers::NONE, Key::Escape);
    key(tour, Modifiers::NONE, Key::H);
}

fn animating(tour: &mut Tour) {
    session(&mut tour.watched.window).open(walking());
    session(&mut tour.watched.window).select(None);
    mode(tour, Mode::Animate);
    with_sides(tour, "animate, how it begins");
    use_control(&mut tour.watched.window, "Over the motion");
    let window = &mut tour.watched.window;
    session(window).select(Some(JointId::new(3)));
    press(window, Modifiers::NONE, Key::I);
    session(window).transport.go_to_frame(9);
    press(window, Modifiers::NONE, Key::I);
    with_sides(tour, "animate, dope sheet");
    use_control(&mut tour.watched.window, "Graph");
    with_sides(tour, "animate, graph");
    let window = &mut tour.watched.window;
    session(window).author(|authored| {
        let lanes = authored.lanes();
        let first = lanes.first().copied();
        let keys = first.map(|lane| posekit_viewer::state::animate::KeyId { lane, index: 0 });
        authored.select(keys.into_iter().collect());
    });
    with_sides(tour, "animate, graph, a key");
    session(&mut tour.watched.window).select(None);
    tour.look("animate, graph, nothing");
    use_control(&mut tour.watched.window, "Dope sheet");
    for what in [NewThing::Camera, NewThing::Light, NewThing::Box] {
        session(&mut tour.watched.window).add_thing(what);
        with_sides(tour, &format!("animate, {what:?}"));
    }
}

fn lab(tour: &mut Tour) {
    mode(tour, Mode::Lab);
    for robot in ["planar2", "arm6"] {
        let window = &mut tour.watched.window;
        let viewer = window.state_mut().as_mut().expect("the window was shown");
        viewer.lab_mut().open_sample(robot);
        with_sides(tour, &format!("arm lab, {robot}"));
        let window = &mut tour.watched.window;
        let viewer = window.state_mut().as_mut().expect("the window was shown");
        viewer
            .lab_mut()
            .work(posekit_viewer::state::arm::Bench::go_to_zero);
        with_sides(tour, &format!("arm lab, {robot} at zero"));
        for table in ["Matrices", "Jacobian"] {
            use_control(&mut tour.watched.window, table);
            with_sides(tour, &format!("arm lab, {robot}, {table}"));
        }
        use_control(
            &mut tour.watched.window,
            "Hide the numbers: more room for the view",
        );
        tour.look(&format!("arm lab, {robot}, no table"));
        use_control(&mut tour.watched.window, "Show the numbers");
    }
}

fn interpolation(tour: &mut Tour) {
    fn work(
        tour: &mut Tour,
        work: impl FnOnce(&mut posekit_viewer::state::interpolation::InterpolationLab),
    ) {
        let window = &mut tour.watched.window;
        let viewer = window.state_mut().as_mut().expect("the window was shown");
        work(viewer.interpolation_mut());
        window.run_steps(2);
    }
    mode(tour, Mode::Interpolation);
    for picture in Picture::ALL {
        work(tour, |lab| lab.set_picture(picture));
        with_sides(tour, &format!("interpolation, {}", picture.name()));
    }
    work(tour, |lab| {
        lab.set_picture(Picture::SideBySide);
        for kind in Kind::all() {
            lab.set_shown(kind, true);
        }
        lab.change(posekit_viewer::state::interpolation::Case::add_key);
    });
    with_sides(tour, "interpolation, all methods, three keys");
    key(tour, Modifiers::NONE, Key::K);
    tour.look("interpolation, no curves");
    key(tour, Modifiers::NONE, Key::K);
    work(tour, |lab| lab.set_page(Page::Clip));
    until(&mut tour.watched.window, |viewer| !viewer.is_working());
    until(&mut tour.watched.window, |viewer| {
        viewer.interpolation().clip.progress().is_none()
    });
    with_sides(tour, "interpolation on a clip");
    work(tour, |lab| lab.set_page(Page::Orientations));
}

/// What lies over the window.
fn over_everything(tour: &mut Tour) {
    mode(tour, Mode::View);
    key(tour, Modifiers::SHIFT, Key::Questionmark);
    tour.look("list of keys");
    tour.watched
        .window
        .event(egui::Event::Text("frame".to_owned()));
    tour.look("list of keys, searched");
    key(tour, Modifiers::NONE, Key::Escape);
    key(tour, Modifiers::NONE, Key::Escape);
    key(tour, Modifiers::COMMAND, Key::E);
    tour.look("export");
    key(tour, Modifiers::NONE, Key::Escape);
    key(tour, Modifiers::COMMAND, Key::O);
    until(&mut tour.watched.window, |viewer| {
        viewer.chooser().is_some()
    });
    tour.look("chooser");
    key(tour, Modifiers::NONE, Key::Escape);
    key(tour, Modifiers::COMMAND, Key::S);
    until(&mut tour.watched.window, |viewer| {
        viewer.chooser().is_some()
    });
    tour.look("chooser, to save");
    let window = &mut tour.watched.window;
    window.event(egui::Event::Text("no such folder/name".to_owned()));
    window.run_steps(2);
    press(window, Modifiers::NONE, Key::Enter);
    tour.look("chooser, a question");
    key(tour, Modifiers::NONE, Key::Escape);
    key(tour, Modifiers::NONE, Key::Escape);
    tour.watched.window.run_steps(2);
    assert!(viewer(&tour.watched.window).chooser().is_none());
}

/// The menus of the bar, opened.
fn menus(tour: &mut Tour) {
    for mode_now in [Mode::View, Mode::Animate, Mode::Lab] {
        mode(tour, mode_now);
        let window = &mut tour.watched.window;
        if window.query_all_by_label("Menu").next().is_some() {
            for name in ["File", "Camera"] {
                use_control(window_of(tour), "Menu");
                tour.look(&format!("the menu in {mode_now:?}"));
                use_control(window_of(tour), name);
                tour.look(&format!("the menu {name} in {mode_now:?}"));
                for _ in 0..4 {
                    if has_control(window_of(tour), "Camera") {
                        key(tour, Modifiers::NONE, Key::Escape);
                        window_of(tour).run_steps(2);
                    }
                }
            }
        } else {
            for name in ["File", "Camera", "Show"] {
                if window_of(tour).query_all_by_label(name).next().is_some() {
                    use_control(window_of(tour), name);
                    tour.look(&format!("the menu {name} in {mode_now:?}"));
                    key(tour, Modifiers::NONE, Key::Escape);
                }
            }
        }
    }
    mode(tour, Mode::View);
    let name = Mode::View.name();
    let is_menu = |window: &Window| {
        let modes: Vec<_> = window.query_all_by_label(Mode::Lab.name()).collect();
        modes.is_empty()
    };
    if is_menu(window_of(tour)) {
        use_control(window_of(tour), name);
        tour.look("the menu of modes");
        for mode in Mode::ALL {
            assert!(has_control(window_of(tour), mode.name()), "{mode:?}");
        }
        key(tour, Modifiers::NONE, Key::Escape);
    }
}

fn window_of(tour: &mut Tour) -> &mut Window {
    &mut tour.watched.window
}

/// Messages come over the view of every mode.
fn messages(tour: &mut Tour) {
    for mode_now in Mode::ALL {
        mode(tour, mode_now);
        for sides in SIDES {
            if !set_sides(&mut tour.watched.window, sides) {
                continue;
            }
            let window = window_of(tour);
            for text in [
                "The first of some messages",
                "Another message that says rather much about a file with a long name, and about what \
                 became of it when it was read, so that it needs more than a line",
                "The third of them",
                "The last one, saved as a picture.png",
            ] {
                session(window).tell(text);
            }
            window.run_steps(4);
            assert!(!viewer(window).notices().shown().is_empty());
            tour.look_now(&format!("messages in {mode_now:?}{}", name_of(sides)));
        }
        set_sides(&mut tour.watched.window, (false, false));
    }
    mode(tour, Mode::View);
    let window = window_of(tour);
    for _ in 0..60 {
        window.run_steps(10);
        if viewer(window).notices().shown().is_empty() {
            break;
        }
    }
}

/// Nothing is open.
fn empty(tour: &mut Tour) {
    let window = window_of(tour);
    let ids: Vec<_> = session(window).clips().iter().map(|open| open.id).collect();
    for id in ids {
        session(window).close(id);
    }
    for mode_now in Mode::ALL {
        mode(tour, mode_now);
        with_sides(tour, &format!("nothing open, {mode_now:?}"));
    }
    let window = window_of(tour);
    let viewer = window.state_mut().as_mut().expect("the window was shown");
    viewer.interpolation_mut().set_page(Page::Clip);
    mode(tour, Mode::Interpolation);
    with_sides(tour, "nothing open, on a clip");
}
