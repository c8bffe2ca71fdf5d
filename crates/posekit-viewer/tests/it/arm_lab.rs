//! The arm lab: joints set, tips dragged, files opened, and what is said about it.

use std::sync::Arc;

use egui::{Key, Modifiers, Pos2, Rect, Vec2, pos2};
use egui_kittest::kittest::Queryable as _;
use glam::{DQuat, DVec3};
use posekit::ik::robot::WaysMethod;
use posekit::rotation::Axis;
use posekit_viewer::gizmo::{Handle, Viewport};
use posekit_viewer::load::Input;
use posekit_viewer::state::arm::bench::Target;
use posekit_viewer::state::arm::mobility::Singularity;
use posekit_viewer::state::arm::{ArmLab, Bench, Robot};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::notices::NoticeKind;

use super::editing::place_on_gizmo;
use super::window::{Window, input, laptop, press, settle, until, viewer};

/// A bench with one of posekit's own robots.
fn bench(name: &str) -> Bench {
    Bench::new(Arc::new(Robot::sample(name).expect("one of ours")))
}

/// A window with the lab, and a sample on its bench.
fn lab_with(name: &str) -> Window {
    let mut window = laptop(vec![input("arm.bvh", 5)]);
    press(&mut window, Modifiers::NONE, Key::B);
    work(&mut window, |lab| lab.open_sample(name));
    settle(&mut window);
    window
}

fn work(window: &mut Window, work: impl FnOnce(&mut ArmLab)) {
    let viewer = window.state_mut().as_mut().expect("the window was shown");
    work(viewer.lab_mut());
    window.run_steps(3);
}

fn bench_of(window: &Window) -> &Bench {
    viewer(window).lab().bench().expect("there is a robot")
}

fn view_rect(window: &Window) -> Rect {
    window.get_by_label_contains("View of the robot").rect()
}

fn file(name: &str, text: &str) -> Input {
    Input::Bytes {
        name: name.to_owned(),
        bytes: Arc::from(text.as_bytes()),
    }
}

/// Drags from one place to another in some steps, and lets go.
fn drag(window: &mut Window, from: Pos2, to: Pos2) {
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    for step in 1..=6_u8 {
        window.hover_at(from + (to - from) * (f32::from(step) / 6.0));
        window.step();
    }
    window.drop_at(to);
    window.run_steps(3);
}

/// A place on a handle of the tip's gizmo where no other is taken.
fn place_on(lab: &ArmLab, handle: Handle, rect: Rect) -> Pos2 {
    let gizmo = lab.bench().expect("there is a robot").gizmo();
    place_on_gizmo(&gizmo, &Viewport::new(lab.view_camera(), rect), handle)
}

#[test]
fn a_slider_moves_the_arm_by_forward_kinematics() {
    let mut window = lab_with("arm6");
    let before = bench_of(&window).tip_frame();
    let old = bench_of(&window).values()[0];
    let slider = window
        .get_by_role_and_label(egui::Role::Slider, "t1")
        .rect();
    let at = |share: f32| pos2(slider.left() + share * slider.width(), slider.center().y);
    drag(&mut window, at(0.5), at(0.75));
    let new = bench_of(&window).values()[0];
    let range = bench_of(&window).robot().ranges[0];
    let three_quarters = range.lower + 0.75 * (range.upper - range.lower);
    assert!((new - three_quarters).abs() < 0.2, "{new} {three_quarters}");
    // The waist turns about the world's Y: nothing else may happen to the tip.
    let turn = DQuat::from_rotation_y(new - old);
    let after = bench_of(&window).tip_frame();
    let expected = turn * before.position;
    assert!(
        after.position.distance(expected) < 1e-9,
        "{}",
        after.position
    );
    assert!(after.orientation.angle_between(turn * before.orientation) < 1e-6);
    // One drag is one step back.
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert!((bench_of(&window).values()[0] - old).abs() < 1e-15);
    assert!(
        bench_of(&window)
            .tip_frame()
            .position
            .distance(before.position)
            < 1e-12
    );
}

#[test]
fn dragging_the_tip_moves_the_joints() {
    let mut window = lab_with("arm6");
    let before = bench_of(&window).tip_frame();
    let values = bench_of(&window).values().to_vec();
    let rect = view_rect(&window);
    let handle = Handle::MoveAlong(Axis::Y);
    let from = place_on(viewer(&window).lab(), handle, rect);
    drag(&mut window, from, from + Vec2::new(0.0, -50.0));
    let bench = bench_of(&window);
    let target = bench.target().expect("it was dragged somewhere");
    let way = target.position - before.position;
    assert!(
        way.y > 0.03 && way.x.abs() < 1e-5 && way.z.abs() < 1e-5,
        "{way}"
    );
    let miss = bench.miss().expect("there is a target");
    assert!(bench.is_reached(miss), "{miss:?}");
    // By forward kinematics from the values alone.
    let frame = bench.robot().mechanism.global_frames(bench.values())[bench.tip().index()];
    assert!(frame.position.distance(target.position) < 1e-5);
    assert!(
        frame.orientation.angle_between(before.orientation) < 1e-4,
        "it is not turned"
    );
    window.get_by_label("reached");
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(bench_of(&window).values(), values);
}

#[test]
fn dragging_a_ring_turns_the_tip_on_the_spot() {
    let mut window = lab_with("arm6");
    let before = bench_of(&window).tip_frame();
    let rect = view_rect(&window);
    let handle = Handle::TurnOnScreen;
    let from = place_on(viewer(&window).lab(), handle, rect);
    drag(&mut window, from, from + Vec2::new(20.0, 25.0));
    let bench = bench_of(&window);
    let after = bench.tip_frame();
    assert!(after.orientation.angle_between(before.orientation) > 0.1);
    assert!(after.position.distance(before.position) < 1e-5);
    assert!(bench.is_reached(bench.miss().expect("there is a target")));
}

#[test]
fn escape_lets_a_drag_fall_back() {
    let mut window = lab_with("planar2");
    let values = bench_of(&window).values().to_vec();
    let from = place_on(
        viewer(&window).lab(),
        Handle::MoveOnScreen,
        view_rect(&window),
    );
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    window.hover_at(from + Vec2::new(-40.0, 30.0));
    window.run_steps(2);
    assert!(bench_of(&window).is_dragging() && bench_of(&window).values() != values);
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!bench_of(&window).is_dragging());
    assert_eq!(bench_of(&window).values(), values);
    window.drop_at(from);
    window.run_steps(2);
}

#[test]
fn limits_hold_wherever_the_tip_is_dragged() {
    for name in ["planar2", "arm6", "arm7"] {
        let mut bench = bench(name);
        let mut missed = 0;
        for step in 0..60_u32 {
            let turn = f64::from(step) * 0.7;
            let place = DVec3::new(turn.cos(), (turn * 0.37).sin(), (turn * 1.3).sin()) * 1.4;
            bench.aim(Target {
                position: place,
                orientation: (step % 2 == 0).then(|| DQuat::from_rotation_x(turn)),
            });
            for (value, range) in bench.values().iter().zip(&bench.robot().ranges) {
                assert!(range.contains(*value), "{name} {step}: {value} {range:?}");
            }
            let miss = bench.miss().expect("there is a target");
            assert!(miss.distance.is_finite() && miss.angle_rad.is_finite());
            missed += u32::from(!bench.is_reached(miss));
        }
        assert!(missed > 10, "{name}: some were out of reach");
    }
    let mut bench = bench("arm6");
    bench.set_value(0, 99.0);
    assert!((bench.values()[0] - bench.robot().ranges[0].upper).abs() < 1e-15);
    assert_eq!(bench.joints_at_end().len(), 1);
    bench.set_value(0, f64::NAN);
    assert!(bench.values()[0].is_finite());
}

#[test]
fn a_tip_that_moves_steadily_moves_the_joints_steadily() {
    let mut bench = bench("arm6");
    let start = bench.tip_frame();
    let mut before = bench.values().to_vec();
    for step in 1..=100_u32 {
        let along = DVec3::new(0.05, 0.1, -0.1) * (f64::from(step) / 100.0);
        bench.aim(Target {
            position: start.position + along,
            orientation: Some(start.orientation),
        });
        assert!(bench.is_reached(bench.miss().expect("asked")), "{step}");
        for (a, b) in before.iter().zip(bench.values()) {
            assert!((a - b).abs() < 0.06, "{step}: {a} {b}");
        }
        before = bench.values().to_vec();
    }
}

#[test]
fn another_way_reaches_the_same_place() {
    for name in ["planar2", "arm6", "arm7"] {
        let mut bench = bench(name);
        let before = (bench.tip_frame(), bench.values().to_vec());
        assert!(bench.take_next_way(), "{name}");
        let (frame, values) = before;
        assert!(bench.tip_frame().position.distance(frame.position) < 1e-5);
        if name != "planar2" {
            assert!(
                bench
                    .tip_frame()
                    .orientation
                    .angle_between(frame.orientation)
                    < 1e-4
            );
        }
        let gap = bench
            .values()
            .iter()
            .zip(&values)
            .map(|(a, b)| (a - b).abs());
        assert!(gap.fold(0.0, f64::max) > 1e-2, "{name}");
        bench.undo();
        assert_eq!(bench.values(), values);
    }
}

/// Two legs under a pelvis at the origin, as the file of a humanoid has it; with a floating base, or none.
fn humanoid(base: &str) -> String {
    let leg = |side: &str, y: f64| {
        format!(
            "<link name='{side}'><visual><origin xyz='0 0 -0.4'/><geometry><box size='0.1 0.1 0.8'/></geometry></visual></link>
             <joint name='{side}_hip' type='continuous'><parent link='pelvis'/><child link='{side}'/><origin xyz='0 {y} 0'/>
             <axis xyz='0 1 0'/></joint>"
        )
    };
    format!(
        "<robot name='h'>{base}<link name='pelvis'><visual><geometry><box size='0.2 0.3 0.2'/></geometry></visual></link>{}{}</robot>",
        leg("left", 0.1),
        leg("right", -0.1)
    )
}

#[test]
fn a_humanoid_stands_on_the_floor_and_an_arm_on_its_base() {
    let floating = "<link name='world'/><joint name='free' type='floating'><parent link='world'/><child link='pelvis'/></joint>";
    for base in ["", floating] {
        let robot = Robot::read("h.urdf", humanoid(base).as_bytes()).expect("a robot");
        let floor = robot.ground_height;
        assert!((floor + 0.8).abs() < 1e-3, "{floor}");
    }
    for name in ["arm6", "arm7", "planar2"] {
        let robot = Robot::sample(name).expect("one of ours");
        assert!(robot.ground_height.abs() < 1e-3, "{name}");
    }
}

#[test]
fn the_ways_are_listed_and_stepped_through() {
    let mut window = lab_with("arm6");
    for _ in 0..3 {
        window.get_by_label("Another way").click();
        settle(&mut window);
    }
    let bench = bench_of(&window);
    let ways = bench.ways().expect("they were looked for");
    assert_eq!(ways.method, WaysMethod::SphericalWrist);
    assert!(ways.ways.len() > 1);
    // The first step leaves the first way, which is where the arm stood.
    assert_eq!(bench.way_taken(), Some(3 % ways.ways.len()));
    assert!(bench.is_reached(bench.miss().expect("asked")));
    let count = ways.ways.len();
    assert!(
        window
            .query_by_label(&format!("There are {count} ways:"))
            .is_some()
    );
    window.get_by_label("Way 1").click();
    settle(&mut window);
    assert_eq!(bench_of(&window).way_taken(), Some(0));
}

#[test]
fn a_stretched_arm_is_warned_of() {
    let mut window = lab_with("planar2");
    assert!(
        window
            .query_by_label_contains("Singular: it cannot")
            .is_none()
    );
    work(&mut window, |lab| {
        lab.work(|bench| bench.set_values(&[0.4, 0.1]));
    });
    window.get_by_label_contains("Near a singularity");
    work(&mut window, |lab| {
        lab.work(|bench| bench.set_values(&[0.4, 0.0]));
    });
    window.get_by_label_contains("Singular: it cannot move along the red line");
    assert_eq!(bench_of(&window).mobility().singularity, Singularity::At);
    window.get_by_label("Stretched or folded:  t1 = 22.9\u{b0}  t2 = 0.0\u{b0}");
}

#[test]
fn the_formula_on_the_screen_is_forward_kinematics() {
    let mut window = lab_with("planar2");
    work(&mut window, |lab| {
        lab.work(|bench| bench.set_values(&[0.7, -1.9]));
    });
    let bench = bench_of(&window);
    let arm = bench.planar().expect("it is planar");
    let frame = bench.robot().mechanism.global_frames(bench.values())[bench.tip().index()];
    let place = arm.in_plane(frame.position);
    let read = bench.two_link().expect("it is planar");
    for (lines, value) in [(&read.x, place.x), (&read.y, place.y)] {
        for line in lines {
            let mut shown = window.query_all_by_label_contains(line.trim());
            assert!(shown.next().is_some(), "{line}");
        }
        let shown: f64 = lines[3].trim_start_matches("= ").parse().expect("a number");
        assert!((shown - value).abs() < 0.000_51, "{shown} {value}");
    }
    // The other elbow is a button.
    let other = read
        .elbows
        .iter()
        .find(|elbow| !elbow.is_taken)
        .expect("two");
    let [t1, t2] = other.angles.map(f64::to_degrees);
    let name = format!("t1 = {t1:.1}\u{b0}  t2 = {t2:.1}\u{b0}");
    window.get_by_label_contains(&name).click();
    window.run_steps(3);
    let bench = bench_of(&window);
    assert!((bench.values()[1].to_degrees() - t2).abs() < 1e-9);
    assert!(bench.tip_frame().position.distance(frame.position) < 1e-9);
}

#[test]
fn the_last_matrix_on_the_screen_is_the_tip() {
    let mut window = lab_with("arm6");
    window.get_by_label("Matrices").click();
    window.run_steps(3);
    let frame = bench_of(&window).tip_frame();
    let x = frame.orientation * DVec3::X;
    let first = format!("{:>9}", format!("{:.3}", x.x));
    let cards: Vec<String> = window
        .query_all_by_label_contains("0        0        0        1")
        .filter_map(|node| node.value())
        .collect();
    // Each of the eight factors, the product after each, and the whole map once more beside them.
    assert_eq!(cards.len(), 17);
    let last = cards.last().expect("seventeen");
    assert_eq!(last, &cards[15]);
    assert!(last.starts_with(&first), "{last:?} {first:?}");
}

#[test]
fn robots_are_opened_from_files_and_clips_stay() {
    let text = posekit_formats::urdf::sample::by_name("arm7").expect("ours");
    let mut window = laptop(vec![input("arm.bvh", 5), file("seven.urdf", text)]);
    until(&mut window, |viewer| viewer.lab().bench().is_some());
    assert_eq!(viewer(&window).session().mode(), Mode::Lab);
    assert_eq!(viewer(&window).session().clips().len(), 1);
    assert_eq!(bench_of(&window).robot().name, "seven.urdf");
    assert_eq!(bench_of(&window).values().len(), 7);
    press(&mut window, Modifiers::NONE, Key::Q);
    assert_eq!(viewer(&window).session().mode(), Mode::View);
    window.get_by_label_contains("View of the figure");
}

#[test]
fn files_that_are_no_robots_are_told_of_with_their_place() {
    let cyclic = "<robot name=\"r\">\n<link name=\"a\"/><link name=\"b\"/>\n\
        <joint name=\"x\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n\
        <joint name=\"y\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>\n</robot>";
    for (name, text) in [
        ("cyclic.urdf", cyclic),
        ("torn.urdf", "<robot name=\"r\"><link"),
        ("empty.urdf", ""),
        (
            "page.html",
            "<!doctype html><html><body>hello</body></html>",
        ),
    ] {
        let mut window = laptop(vec![input("arm.bvh", 5), file(name, text)]);
        window.run_steps(2);
        let viewer = viewer(&window);
        let notice = viewer
            .notices()
            .shown()
            .iter()
            .find(|notice| notice.kind == NoticeKind::Failure)
            .unwrap_or_else(|| panic!("{name} is told of"));
        assert!(
            notice.text.starts_with(name) && notice.text.contains("line"),
            "{}",
            notice.text
        );
        assert_eq!(viewer.session().clips().len(), 1, "nothing else closes");
        assert_eq!(viewer.session().mode(), Mode::View);
    }
}

#[test]
fn links_with_meshes_are_drawn_simply_and_that_is_said() {
    let text = "<robot name=\"r\"><link name=\"base\"/><link name=\"arm\"><visual><geometry>\
        <mesh filename=\"package://r/arm.stl\"/></geometry></visual></link>\
        <joint name=\"j\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/>\
        <origin xyz=\"0 0 0.5\"/><axis xyz=\"0 0 1\"/></joint></robot>";
    let window = laptop(vec![file("mesh.urdf", text)]);
    let told = viewer(&window).notices().shown().iter();
    assert!(
        told.clone()
            .any(|notice| notice.text.contains("simple shapes")),
        "{:?}",
        told.collect::<Vec<_>>()
    );
    let bench = bench_of(&window);
    assert!(!bench.robot().body.parts.is_empty());
    assert_eq!(bench.robot().values[0].range.upper, f64::INFINITY);
}

#[test]
fn the_picture_follows_the_joints() {
    let mut window = lab_with("arm6");
    let before = viewer(&window).picture();
    assert_eq!(
        before,
        viewer(&window).picture(),
        "the same scene, the same picture"
    );
    work(&mut window, |lab| {
        lab.work(|bench| bench.set_value(1, 0.2));
    });
    assert!(before != viewer(&window).picture());
}

#[test]
fn what_is_clicked_wildly_does_no_harm() {
    let mut window = lab_with("arm6");
    for key in [
        Key::Space,
        Key::ArrowRight,
        Key::K,
        Key::G,
        Key::M,
        Key::R,
        Key::Num7,
        Key::Num5,
        Key::F,
        Key::Enter,
        Key::X,
        Key::J,
        Key::S,
        Key::Y,
        Key::T,
        Key::N,
        Key::T,
        Key::N,
    ] {
        press(&mut window, Modifiers::NONE, key);
    }
    for name in ["Random", "Zero", "Start", "Another way", "Tip"] {
        if let Some(node) = window.query_all_by_label(name).next() {
            node.click();
        }
        window.run_steps(2);
    }
    assert_eq!(viewer(&window).session().mode(), Mode::Lab);
    for (value, range) in bench_of(&window)
        .values()
        .iter()
        .zip(&bench_of(&window).robot().ranges)
    {
        assert!(range.contains(*value));
    }
}

/// A robot of hinges in one line, all about Z: singular as it stands.
fn straight(name: &str, hinges: usize, comments: usize) -> Input {
    use std::fmt::Write as _;
    let mut text = String::from("<robot name='straight'><link name='l0'/>");
    for index in 0..hinges {
        let _ = write!(
            text,
            "<link name='l{child}'/><joint name='hinge_{child}' type='revolute'><parent link='l{index}'/>\
             <child link='l{child}'/><origin xyz='0.3 0 0'/><axis xyz='0 {y} {z}'/>\
             <limit lower='-3' upper='3' effort='1' velocity='1'/></joint>",
            child = index + 1,
            y = index % 2,
            z = 1 - index % 2,
        );
    }
    text += &"<!-- a comment, so that it takes longer to read -->".repeat(comments);
    text += "</robot>";
    file(name, &text)
}

#[test]
fn of_robots_given_together_the_first_is_on_the_bench() {
    let mut window = laptop(vec![input("arm.bvh", 5)]);
    let robots = vec![
        straight("first.urdf", 3, 0),
        straight("second.urdf", 4, 40_000),
        straight("third.urdf", 5, 0),
    ];
    let opens = |window: &mut Window, robots: Vec<Input>| {
        let viewer = window.state_mut().as_mut().expect("the window was shown");
        viewer.open_inputs(robots);
    };
    opens(&mut window, robots);
    let listed = |viewer: &posekit_viewer::Viewer| viewer.lab().opened().len();
    until(&mut window, |viewer| {
        listed(viewer) == 3 && !viewer.is_working()
    });
    assert_eq!(viewer(&window).session().mode(), Mode::Lab);
    assert_eq!(bench_of(&window).robot().name, "first.urdf");
    // One that comes later takes its place.
    opens(&mut window, vec![straight("later.urdf", 2, 0)]);
    until(&mut window, |viewer| {
        listed(viewer) == 4 && !viewer.is_working()
    });
    assert_eq!(bench_of(&window).robot().name, "later.urdf");
}

#[test]
fn a_side_stays_as_wide_as_it_is_whatever_is_written_in_it() {
    let mut window = laptop(vec![input("arm.bvh", 5)]);
    let viewer_of = window.state_mut().as_mut().expect("the window was shown");
    viewer_of.open_inputs(vec![straight("straight.urdf", 6, 0)]);
    until(&mut window, |viewer| viewer.lab().bench().is_some());
    window.run_steps(3);
    // Rounding of any size must not make it wider: what cannot move is 0.
    let measured = bench_of(&window).mobility();
    assert_eq!(measured.singularity, Singularity::At);
    let before = view_rect(&window);
    window.run_steps(30);
    assert_eq!(view_rect(&window), before);
    window.get_by_label_contains("Another way");
}

#[test]
fn buttons_that_are_pressed_again_stay_where_they_are() {
    let mut window = lab_with("arm6");
    let place = |window: &Window| window.get_by_label("Another way").rect();
    let before = place(&window);
    window.get_by_label("Another way").click();
    window.run_steps(3);
    assert!(
        bench_of(&window).target().is_some(),
        "there is more to tell"
    );
    assert_eq!(place(&window), before);
}
