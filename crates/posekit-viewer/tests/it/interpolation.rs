//! The interpolation lab: angles set, rings dragged, keys added, presets taken, clips filled in.

use egui::{Key, Modifiers, Pos2, Rect, Vec2, pos2};
use egui_kittest::kittest::Queryable as _;
use glam::DQuat;
use posekit::inbetween::{Ends, FillError, FillMethod, FillPlan, Method, Preset, fill, path};
use posekit::rotation::{Axis, EulerOrder, angle_between};
use posekit_viewer::gizmo::{Handle, Viewport};
use posekit_viewer::state::interpolation::ways::STEPS;
use posekit_viewer::state::interpolation::{InterpolationLab, Kind, Page, Picture, Span};
use posekit_viewer::state::mode::Mode;

use super::editing::place_on_gizmo;
use super::window::{Window, input, laptop, press, settle, until, viewer, window};

fn lab() -> Window {
    let mut window = laptop(vec![input("arm.bvh", 45)]);
    press(&mut window, Modifiers::SHIFT, Key::B);
    settle(&mut window);
    window
}

fn lab_of(window: &Window) -> &InterpolationLab {
    viewer(window).interpolation()
}

fn work(window: &mut Window, work: impl FnOnce(&mut InterpolationLab)) {
    let viewer = window.state_mut().as_mut().expect("the window was shown");
    work(viewer.interpolation_mut());
    window.run_steps(3);
}

fn view_rect(window: &Window) -> Rect {
    window
        .get_by_label_contains("View of the orientations")
        .rect()
}

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

fn angles(window: &Window) -> Vec<[f64; 3]> {
    lab_of(window).case().keys_deg().to_vec()
}

#[test]
fn its_key_and_its_button_open_it() {
    let mut window = lab();
    assert_eq!(viewer(&window).session().mode(), Mode::Interpolation);
    press(&mut window, Modifiers::NONE, Key::Q);
    assert_eq!(viewer(&window).session().mode(), Mode::View);
    window.get_by_label("Interpolation lab").click();
    window.run_steps(2);
    assert_eq!(viewer(&window).session().mode(), Mode::Interpolation);
}

#[test]
fn a_slider_turns_an_end_and_one_drag_is_one_step() {
    let mut window = lab();
    work(&mut window, |lab| lab.take_preset(Preset::Lecture));
    let before = angles(&window);
    let slider = window
        .get_by_role_and_label(egui::Role::Slider, "End Z 3")
        .rect();
    let at = |share: f32| pos2(slider.left() + share * slider.width(), slider.center().y);
    drag(&mut window, at(0.62), at(0.75));
    let after = angles(&window);
    assert_eq!(after[0], before[0], "the start stays");
    assert_eq!(after[1][..2], before[1][..2]);
    // Three quarters of the way from -360 to 360 degrees.
    assert!((after[1][2] - 180.0).abs() < 30.0, "{after:?}");
    assert_eq!(lab_of(&window).case().preset(), None);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(angles(&window), before);
    press(&mut window, Modifiers::COMMAND, Key::Y);
    assert_eq!(angles(&window), after);
}

#[test]
fn an_angle_is_typed() {
    let mut window = lab();
    work(&mut window, |lab| lab.take_preset(Preset::Lecture));
    let field = |window: &Window| {
        window
            .get_by_role_and_label(egui::Role::SpinButton, "Start Y 2")
            .rect()
    };
    let place = field(&window).center();
    window.hover_at(place);
    window.step();
    window.drag_at(place);
    window.step();
    window.drop_at(place);
    window.run_steps(3);
    window.event(egui::Event::Text("-32.5".to_owned()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert_eq!(angles(&window)[0], [0.0, -32.5, 0.0]);
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(angles(&window)[0], [0.0, 0.0, 0.0]);
}

#[test]
fn rings_turn_both_ends() {
    let mut window = lab();
    for (end, handle) in [
        (0, Handle::TurnAbout(Axis::Y)),
        (1, Handle::TurnAbout(Axis::X)),
        (1, Handle::TurnOnScreen),
    ] {
        let before = lab_of(&window).case().clone();
        let lab = lab_of(&window);
        let viewport = Viewport::new(lab.view_camera(), view_rect(&window));
        let gizmo = lab.gizmo(end);
        let from = place_on_gizmo(&gizmo, &viewport, handle);
        drag(&mut window, from, from + Vec2::new(24.0, 18.0));
        let lab = lab_of(&window);
        let (key, other) = (lab.ends()[end], lab.ends()[1 - end]);
        let turn = lab.case().rotation(key) * before.rotation(key).conjugate();
        assert!(turn.to_axis_angle().1.abs() > 0.02, "{end} {handle:?}");
        if let Handle::TurnAbout(axis) = handle {
            let along = turn.to_axis_angle().0.dot(axis.unit()).abs();
            assert!(along > 1.0 - 1e-6, "about the world's axis: {along}");
        }
        assert_eq!(lab.case().keys_deg()[other], before.keys_deg()[other]);
        press(&mut window, Modifiers::COMMAND, Key::Z);
        assert_eq!(angles(&window), before.keys_deg());
    }
}

#[test]
fn escape_lets_a_ring_fall_back_and_other_drags_turn_the_view() {
    let mut window = lab();
    let before = lab_of(&window).case().clone();
    let viewport = Viewport::new(lab_of(&window).view_camera(), view_rect(&window));
    let from = place_on_gizmo(&lab_of(&window).gizmo(0), &viewport, Handle::TurnOnScreen);
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    window.hover_at(from + Vec2::new(30.0, 30.0));
    window.run_steps(2);
    assert!(lab_of(&window).is_dragging() && *lab_of(&window).case() != before);
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(*lab_of(&window).case(), before);
    window.drop_at(from);
    window.run_steps(2);
    let yaw = lab_of(&window).camera.still().yaw_rad;
    let middle = view_rect(&window).right_center() - Vec2::new(40.0, 0.0);
    drag(&mut window, middle, middle - Vec2::new(80.0, 0.0));
    assert!((lab_of(&window).camera.still().yaw_rad - yaw).abs() > 0.1);
    assert_eq!(*lab_of(&window).case(), before);
}

#[test]
fn a_preset_is_chosen_and_taken_back() {
    let mut window = lab();
    let before = angles(&window);
    window.get_by_value(Preset::Quarter.title()).click();
    window.run_steps(3);
    window.get_by_label(Preset::Zxy.title()).click();
    window.run_steps(3);
    let lab = lab_of(&window);
    assert_eq!(lab.case().preset(), Some(Preset::Zxy.into()));
    assert_eq!(lab.case().order(), EulerOrder::ZXY);
    assert_eq!(
        lab.case().keys_deg(),
        [[0.0, 85.0, 0.0], [90.0, 60.0, -90.0]]
    );
    window.get_by_label_contains("the speed of euler:ZXY doubles");
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(angles(&window), before);
}

#[test]
fn keys_are_added_chosen_and_taken_away() {
    let mut window = lab();
    window.get_by_label("Add a key").click();
    window.run_steps(3);
    assert_eq!(lab_of(&window).case().gap_count(), 2);
    assert_eq!(lab_of(&window).span(), Span::AllKeys);
    assert!((lab_of(&window).playback.length() - 2.0).abs() < 1e-12);
    window.get_by_label("End  \u{b7}  key 2").click();
    window.run_steps(3);
    assert_eq!(lab_of(&window).ends(), [1, 2]);
    window.get_by_label("Start to end").click();
    window.run_steps(3);
    assert_eq!(lab_of(&window).span(), Span::Pair);
    window.get_by_label("Take key 1 away").click();
    window.run_steps(3);
    assert_eq!(lab_of(&window).case().gap_count(), 1);
    for _ in 0..2 {
        press(&mut window, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(lab_of(&window).case().gap_count(), 1, "as it was first");
}

#[test]
fn the_clock_runs_and_keys_move_it() {
    let mut window = lab();
    press(&mut window, Modifiers::NONE, Key::Home);
    assert!(lab_of(&window).playback.share() == 0.0);
    press(&mut window, Modifiers::NONE, Key::ArrowRight);
    press(&mut window, Modifiers::COMMAND, Key::ArrowRight);
    assert!((lab_of(&window).playback.share() - 0.11).abs() < 1e-9);
    press(&mut window, Modifiers::NONE, Key::Space);
    window.run_steps(5);
    assert!(lab_of(&window).playback.is_playing() && lab_of(&window).playback.share() > 0.11);
    press(&mut window, Modifiers::NONE, Key::End);
    assert!(lab_of(&window).playback.share() == 1.0 && !lab_of(&window).playback.is_playing());
    let slider = window.get_by_role_and_label(egui::Role::Slider, "t").rect();
    drag(
        &mut window,
        slider.right_center() - Vec2::new(10.0, 0.0),
        slider.center(),
    );
    assert!((lab_of(&window).playback.share() - 0.5).abs() < 0.02);
}

/// What the command that is copied would make of its words: the tables of `posekit slerp` are of the
/// library's `path`, read from the words here as the command reads them.
fn path_by_words(words: &str) -> Vec<(Method, Vec<posekit::inbetween::PathStep>)> {
    let words: Vec<&str> = words.split(' ').collect();
    assert_eq!(words[..2], ["posekit", "slerp"]);
    let after = |name: &str| {
        let at = words.iter().position(|word| *word == name)?;
        Some(words[at + 1])
    };
    let order: EulerOrder = after("--order")
        .expect("an order")
        .parse()
        .expect("it is one");
    let read = |text: &str| -> DQuat {
        let angles: Vec<f64> = text
            .split(',')
            .map(|part| part.parse().expect("a number"))
            .collect();
        order.to_quat([angles[0], angles[1], angles[2]].map(f64::to_radians))
    };
    let ends = Ends {
        before: after("--before").map(read),
        after: after("--after").map(read),
        ..Ends::new(read(words[2]), read(words[3]))
    };
    let steps: usize = after("--steps").expect("steps").parse().expect("a number");
    let methods = after("--method").expect("methods").split(',');
    methods
        .map(|word| {
            let method = word.parse().expect("a method");
            (method, path(method, &ends, steps))
        })
        .collect()
}

#[test]
fn the_numbers_are_those_of_the_command() {
    let mut window = lab();
    for preset in Preset::ALL {
        work(&mut window, |lab| {
            lab.take_preset(preset);
            lab.set_span(Span::Pair);
            Method::ALL
                .into_iter()
                .for_each(|method| lab.set_shown(method, true));
        });
        let lab = lab_of(&window);
        let paths = path_by_words(&lab.command());
        assert_eq!(paths.len(), Method::ALL.len());
        for (method, steps) in paths {
            let way = lab.way(method).expect("it was measured");
            assert_eq!(way.steps, steps, "{preset} {method}");
            let most = steps
                .iter()
                .map(|step| step.deviation_deg)
                .fold(0.0, f64::max);
            assert_eq!(way.most_deviation_deg, most);
            let least = steps.iter().map(|step| step.blend.determinant());
            assert_eq!(way.least_determinant, least.fold(f64::INFINITY, f64::min));
        }
        let csv = lab.numbers();
        assert_eq!(csv.lines().count(), 1 + Method::ALL.len() * (STEPS + 1));
    }
}

#[test]
fn what_is_copied_is_the_command() {
    let mut window = lab();
    window.get_by_label("Copy command").click();
    window.step();
    let copied =
        window
            .output()
            .platform_output
            .commands
            .iter()
            .find_map(|command| match command {
                egui::OutputCommand::CopyText(text) => Some(text.clone()),
                _ => None,
            });
    assert_eq!(copied, Some(lab_of(&window).command()));
}

#[test]
fn methods_and_pictures_are_switched() {
    let mut window = lab();
    assert!(!lab_of(&window).is_shown(Method::RawSlerp));
    window.get_by_label("rawslerp").click();
    window.run_steps(2);
    assert!(lab_of(&window).is_shown(Method::RawSlerp));
    window.get_by_label("All").click();
    window.run_steps(2);
    assert_eq!(lab_of(&window).shown().count(), Kind::all().count());
    assert_eq!(lab_of(&window).layout().cells.len(), Kind::all().count());
    for picture in [Picture::Overlaid, Picture::Sphere, Picture::SideBySide] {
        press(&mut window, Modifiers::NONE, Key::V);
        assert_eq!(lab_of(&window).picture(), picture);
        settle(&mut window);
    }
    window.get_by_label("None").click();
    window.run_steps(2);
    assert_eq!(
        lab_of(&window).shown().collect::<Vec<_>>(),
        [Method::Slerp.into()]
    );
}

#[test]
fn any_view_is_drawn_without_a_figure_out_of_place() {
    // Every preset in every picture, at several shares: nothing is not a number, nothing panics.
    let mut lab = InterpolationLab::default();
    Method::ALL
        .into_iter()
        .for_each(|method| lab.set_shown(method, true));
    for preset in Preset::ALL {
        lab.take_preset(preset);
        lab.measure();
        for picture in Picture::ALL {
            lab.set_picture(picture);
            for share in [0.0, 0.5, 1.0] {
                lab.playback.set_share(share);
                let scene = lab.scene(posekit_viewer::state::display::Look::Dark);
                let points = scene.polylines.iter().flat_map(|line| &line.points);
                assert!(
                    points.into_iter().all(|(point, _)| point.is_finite()),
                    "{preset}"
                );
                for model in &scene.models {
                    let vertices = &model.mesh.vertices;
                    assert!(
                        vertices
                            .iter()
                            .all(|v| v.position.is_finite() && v.normal.is_finite())
                    );
                    assert!(model.joints.iter().all(|joint| joint.is_finite()));
                }
            }
        }
    }
}

fn on_a_clip() -> Window {
    // With nothing to open, the sample walk is there.
    let mut window = laptop(Vec::new());
    press(&mut window, Modifiers::SHIFT, Key::B);
    window.get_by_label("On a clip").click();
    window.run_steps(2);
    until(&mut window, |viewer| {
        viewer.interpolation().clip.progress().is_none()
    });
    settle(&mut window);
    window
}

#[test]
fn a_clip_is_filled_in_as_the_library_does_it() {
    let window = on_a_clip();
    let lab = &lab_of(&window).clip;
    let clip = lab.clip().expect("a clip is open");
    let plan = FillPlan::every(10, clip.frame_count()).expect("it has frames");
    let orders = clip.document.rotation_orders();
    let results = lab.results();
    assert_eq!(results.len(), FillMethod::USUAL.len());
    for filled in results {
        let made = fill(&clip.motion, &plan, |joint| {
            filled.method.of(joint, &orders)
        });
        let error = FillError::between(&clip.motion, &made, &plan.filled());
        assert_eq!(filled.error, error, "{}", filled.method);
        assert!(error.max_deg > 1.0, "it does move");
    }
    assert_eq!(lab.stage().actors().len(), 3, "the truth and two methods");
}

#[test]
fn the_worst_frame_is_gone_to() {
    let mut window = on_a_clip();
    let worst = *lab_of(&window).clip.results()[0]
        .error
        .worst()
        .expect("it turns");
    window.get_by_label("worst of slerp").click();
    window.run_steps(2);
    let lab = &lab_of(&window).clip;
    assert_eq!(lab.transport.frame(), worst.worst_frame);
    assert_eq!(lab.marked(), Some(worst.joint));
    press(&mut window, Modifiers::NONE, Key::Home);
    let name = {
        let lab = &lab_of(&window).clip;
        let skeleton = lab.clip().expect("a clip is open").skeleton();
        format!("{}, squad", skeleton.unique_name(worst.joint))
    };
    window.get_by_label(&name).click();
    window.run_steps(2);
    assert!(lab_of(&window).clip.transport.frame() > 0);
}

#[test]
fn other_kept_frames_are_worked_out_anew_and_can_be_given_up() {
    let mut window = on_a_clip();
    let before = lab_of(&window).clip.results()[0].error.clone();
    work(&mut window, |lab| lab.clip.set_every(5));
    until(&mut window, |viewer| {
        viewer.interpolation().clip.progress().is_none()
    });
    let lab = &lab_of(&window).clip;
    assert!(lab.results().iter().all(|filled| !lab.is_stale(filled)));
    assert!(
        lab.results()[0].error.mean_deg < before.mean_deg,
        "more is kept"
    );
    work(&mut window, |lab| {
        lab.clip.set_every(7);
        lab.clip.cancel();
    });
    for _ in 0..20 {
        window.step();
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(lab_of(&window).clip.is_given_up());
    assert!(
        lab_of(&window)
            .clip
            .results()
            .iter()
            .all(|filled| lab_of(&window).clip.is_stale(filled))
    );
    window.get_by_label("Go on").click();
    until(&mut window, |viewer| {
        viewer.interpolation().clip.progress().is_none()
    });
    assert!(
        lab_of(&window)
            .clip
            .results()
            .iter()
            .all(|filled| !lab_of(&window).clip.is_stale(filled))
    );
}

#[test]
fn figures_come_and_go_and_move() {
    let mut window = on_a_clip();
    window.get_by_label("Show the figure: squad").click();
    window.run_steps(3);
    assert_eq!(lab_of(&window).clip.stage().actors().len(), 4);
    window.get_by_label("Hide the figure: truth").click();
    window.run_steps(3);
    assert_eq!(lab_of(&window).clip.stage().actors().len(), 3);
    // Unticking a method takes its figure and its numbers away.
    let ticks: Vec<Rect> = window
        .get_all_by_label("squad")
        .map(|node| node.rect())
        .collect();
    let place = ticks.first().expect("it is listed").center();
    window.hover_at(place);
    window.step();
    window.drag_at(place);
    window.step();
    window.drop_at(place);
    window.run_steps(3);
    assert_eq!(lab_of(&window).clip.stage().actors().len(), 2);
    press(&mut window, Modifiers::NONE, Key::Space);
    window.run_steps(4);
    assert!(lab_of(&window).clip.transport.time_secs() > 0.0);
    press(&mut window, Modifiers::NONE, Key::V);
    assert_eq!(
        lab_of(&window)
            .clip
            .stage()
            .places()
            .iter()
            .filter(|p| p.length() > 0.0)
            .count(),
        0,
        "overlaid"
    );
}

#[test]
fn nothing_open_is_nothing_to_compare() {
    let mut window = lab();
    let id = viewer(&window)
        .session()
        .active_id()
        .expect("a clip is open");
    let open = window.state_mut().as_mut().expect("the window was shown");
    open.session_mut().close(id);
    work(&mut window, |lab| lab.set_page(Page::Clip));
    assert!(
        window
            .get_all_by_label_contains("Open a clip to compare")
            .count()
            > 0
    );
    press(&mut window, Modifiers::NONE, Key::Space);
    settle(&mut window);
}

#[test]
fn nothing_is_cut_off_in_a_small_window() {
    for (width, height) in [(1100.0, 700.0), (1366.0, 768.0), (1920.0, 1080.0)] {
        let mut window = window(vec![input("arm.bvh", 45)], Vec2::new(width, height));
        press(&mut window, Modifiers::SHIFT, Key::B);
        work(&mut window, |lab| lab.take_preset(Preset::Keys));
        let screen = Rect::from_min_size(Pos2::ZERO, Vec2::new(width, height)).expand(0.5);
        for label in [
            "Interpolation lab",
            "Orientations",
            "On a clip",
            "Side by side",
            "Overlaid",
            "Sphere",
            "All keys",
            "Start to end",
            "Swap",
        ] {
            for node in window.get_all_by_label(label) {
                let rect = node.rect();
                assert!(screen.contains_rect(rect), "{label} {rect} at {width}");
            }
        }
        let view = view_rect(&window);
        for label in ["Side by side", "Sphere"] {
            for node in window.get_all_by_label(label) {
                assert!(
                    view.expand(1.0).contains_rect(node.rect()),
                    "{label} is over the view"
                );
            }
        }
        let layout = lab_of(&window).layout();
        let most = layout
            .cells
            .iter()
            .map(|cell| cell.width())
            .fold(0.0, f32::max);
        assert!(most >= 76.0, "{width}: bodies are {most} points wide");
    }
}

#[test]
fn ends_stay_where_they_are_in_another_order() {
    let mut window = lab();
    work(&mut window, |lab| lab.take_preset(Preset::Gimbal));
    let before = lab_of(&window).case().clone();
    work(&mut window, |lab| {
        lab.begin_step();
        lab.change(|case| case.set_order("ZYX".parse().expect("an order")));
    });
    let after = lab_of(&window).case();
    assert_ne!(after.keys_deg(), before.keys_deg());
    for key in 0..2 {
        assert!(angle_between(after.rotation(key), before.rotation(key)) < 1e-8);
    }
}
