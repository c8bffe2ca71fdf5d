//! Inverse kinematics in the window: effectors are dragged, pinned, stepped, undone.

use egui::{Key, Modifiers, Pos2, Rect, Vec2, pos2};
use egui_kittest::kittest::Queryable as _;
use glam::Vec3;
use posekit::ik::IkOutcome;
use posekit::pose::GlobalPose;
use posekit::rotation::Axis;
use posekit::skeleton::JointId;
use posekit_viewer::gizmo::{Handle, Viewport};
use posekit_viewer::panels::view::project;
use posekit_viewer::state::edit::{Reach, Spread};
use posekit_viewer::state::ik::{IkSettings, SolverChoice, Start, choices};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::{Hold, Session};

use super::clips::{arm, walking};
use super::editing::{drag, place_on, view_rect};
use super::window::{Window, input, laptop, press, settle, viewer};

const RECT: Rect = Rect {
    min: pos2(0.0, 0.0),
    max: pos2(900.0, 700.0),
};

/// The walk at frame 30, with a joint as the effector.
fn walk_with(name: &str) -> Session {
    let mut session = Session::default();
    session.open(walking());
    session.set_aspect(RECT.aspect_ratio());
    session.transport.go_to_frame(30);
    session.set_mode(Mode::Ik);
    let joint = named(&session, name);
    session.select(Some(joint));
    session
}

fn named(session: &Session, name: &str) -> JointId {
    let clip = session.active_clip().expect("open");
    clip.skeleton().find(name).expect("the walk has it")
}

fn shown(session: &Session) -> GlobalPose {
    let clip = session.active_clip().expect("open");
    let pose = session.shown_local_pose().expect("open");
    pose.to_global(clip.skeleton())
}

/// Takes the target by its middle and brings it by so much across the picture; the handle is held.
fn pull(session: &mut Session, by: Vec2, steps: u8) -> Viewport {
    let viewport = Viewport::new(session.view_camera(), RECT);
    let from = place_on(session, Handle::MoveOnScreen, RECT);
    assert!(session.grab(Handle::MoveOnScreen, from, &viewport));
    for step in 1..=steps {
        let place: Pos2 = from + by * (f32::from(step) / f32::from(steps));
        session.drag_to(place, &viewport, None);
    }
    viewport
}

fn settings(solver: SolverChoice) -> IkSettings {
    IkSettings {
        solver,
        iterations: 100,
        // It is about solvers, not about what walkers do.
        within_motion: Some(false),
        ..IkSettings::default()
    }
}

#[test]
fn the_limb_follows_its_target_with_every_solver() {
    for solver in choices() {
        let name = solver.name();
        let mut session = walk_with("LeftHand");
        session.set_ik(settings(solver));
        let before = shown(&session);
        pull(&mut session, Vec2::new(40.0, -60.0), 10);
        let target = session.target().expect("it is dragged");
        let effector = session.effector().expect("selected");
        let after = shown(&session);
        let gap = after.positions[effector.index()].distance(target.position);
        let solved = session.solved().expect("it was solved").clone();
        let residual = solved.report.residuals[0].distance;
        // What is said is what forward kinematics finds.
        assert!(
            (f64::from(gap) - residual).abs() < 1e-4,
            "{name}: {gap} {residual}"
        );
        if solved.report.outcome.is_reached() && name != "Aim" {
            assert!(gap < 1e-2, "{name}: {gap}");
        }
        if name == "CCD" || name == "FABRIK" || name == "Automatic" {
            assert!(
                solved.report.outcome.is_reached(),
                "{name}: {:?}",
                solved.report
            );
        }
        // What hangs from elsewhere keeps still.
        for joint in ["LeftFoot", "Hips", "RightHand", "Head"] {
            let joint = named(&session, joint).index();
            assert_eq!(before.positions[joint], after.positions[joint], "{name}");
        }
    }
}

#[test]
fn a_target_is_typed_as_numbers() {
    let mut session = walk_with("LeftHand");
    session.set_ik(settings(SolverChoice::default()));
    let joint = named(&session, "LeftHand").index();
    let before = session.target().expect("the effector's own place");
    let place = before.position + Vec3::new(0.05, 0.1, 0.05);
    // Dragged sideways it is shown, and a step only when it is let go.
    session.set_target_position(before.position + Vec3::Y * 0.02, true);
    session.set_target_position(place, true);
    assert!(session.edits().is_none_or(|edits| edits.undo_count() == 0));
    assert!(shown(&session).positions[joint].distance(place) < 1e-3);
    session.set_target_position(place, false);
    assert_eq!(session.edits().expect("edited").undo_count(), 1);
    assert_eq!(session.target().expect("set").position, place);
    assert!(shown(&session).positions[joint].distance(place) < 1e-3);
    assert!(
        session
            .solved()
            .expect("solved")
            .report
            .outcome
            .is_reached()
    );
    session.undo();
    assert_eq!(session.target().expect("its own place"), before);
    // Without following, the target alone is set.
    session.set_ik(IkSettings {
        is_live: false,
        ..settings(SolverChoice::default())
    });
    let stood = shown(&session).positions[joint];
    session.set_target_position(place, false);
    assert_eq!(shown(&session).positions[joint], stood);
    assert_eq!(session.target().expect("set").position, place);
    // In the window.
    let mut window = laptop(vec![input("arm.bvh", 20)]);
    let open = |window: &mut Window| {
        let session = window.state_mut().as_mut().expect("shown").session_mut();
        session.transport.pause();
        session.set_mode(Mode::Ik);
        let last = session
            .active_clip()
            .expect("a clip")
            .skeleton()
            .joint_count()
            - 1;
        session.select(Some(JointId::new(last)));
    };
    open(&mut window);
    window.run_steps(3);
    let now = viewer(&window)
        .session()
        .target()
        .expect("an effector")
        .position;
    window.get_by_label("Target x").click();
    window.run_steps(2);
    press(&mut window, Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text(format!("{}", now.x - 0.1)));
    press(&mut window, Modifiers::NONE, Key::Enter);
    window.run_steps(2);
    let then = viewer(&window).session().target().expect("set").position;
    assert!(
        (then.x - now.x + 0.1).abs() < 1e-3 && then.y == now.y,
        "{now} {then}"
    );
    let edits = viewer(&window)
        .session()
        .edits()
        .expect("edited")
        .undo_count();
    assert_eq!(edits, 1);
}

#[test]
fn letting_go_is_one_step_and_undo_brings_target_and_pose_back() {
    let mut session = walk_with("LeftHand");
    let before = session.active_clip().expect("open").document.clone();
    let target_before = session.target();
    pull(&mut session, Vec2::new(40.0, -60.0), 10);
    assert_eq!(session.active_clip().expect("open").document, before);
    session.drop_handle();
    let after = session.active_clip().expect("open").document.clone();
    let target_after = session.target();
    assert!(after != before && target_after != target_before);
    assert_eq!(session.edits().expect("edited").undo_count(), 1);
    session.undo();
    assert_eq!(session.active_clip().expect("open").document, before);
    assert_eq!(session.target(), target_before);
    session.redo();
    assert!(session.active_clip().expect("open").document == after);
    assert_eq!(session.target(), target_after);
    // Given up, it leaves nothing.
    pull(&mut session, Vec2::new(-30.0, 20.0), 5);
    assert!(session.cancel_drag());
    assert!(session.active_clip().expect("open").document == after);
    assert_eq!(session.target(), target_after);
}

#[test]
fn a_target_out_of_reach_is_told_and_the_limb_points_to_it() {
    let mut session = walk_with("LeftHand");
    pull(&mut session, Vec2::new(300.0, -200.0), 10);
    let solved = session.solved().expect("it was solved");
    let IkOutcome::OutOfReach { by } = solved.report.outcome else {
        panic!("{:?}", solved.report.outcome);
    };
    assert!(by > 0.0 && solved.report.residuals[0].distance >= by - 1e-6);
}

/// What came of a problem is shown while its target is, and not beside another one, or after it was undone.
#[test]
fn what_came_of_a_problem_is_told_of_its_own_target_alone() {
    let mut session = walk_with("LeftHand");
    pull(&mut session, Vec2::new(300.0, -200.0), 10);
    session.drop_handle();
    assert!(session.solved().is_some());
    session.undo();
    assert!(session.solved().is_none());
    session.redo();
    assert!(session.solved().is_some());
    session.select(Some(named(&session, "RightFoot")));
    assert!(session.solved().is_none());
    session.select(Some(named(&session, "LeftHand")));
    assert!(session.solved().is_some());
    session.open(arm(2));
    assert!(session.solved().is_none());
}

#[test]
fn without_following_the_target_waits_for_the_solver() {
    let mut session = walk_with("LeftHand");
    session.set_ik(IkSettings {
        is_live: false,
        within_motion: Some(false),
        ..IkSettings::default()
    });
    let before = shown(&session);
    pull(&mut session, Vec2::new(40.0, -60.0), 4);
    session.drop_handle();
    assert_eq!(shown(&session), before);
    let effector = session.effector().expect("selected").index();
    let target = session.target().expect("set").position;
    assert!(before.positions[effector].distance(target) > 0.05);
    session.solve_again();
    let gap = shown(&session).positions[effector].distance(target);
    assert!(gap < 1e-2, "{gap}");
    session.forget_target();
    let there = shown(&session).positions[effector];
    assert!(
        session
            .target()
            .expect("where it is")
            .position
            .distance(there)
            < 1e-6
    );
}

#[test]
fn every_step_shows_the_update_before_it_is_made() {
    let mut session = walk_with("LeftHand");
    session.set_ik(settings(SolverChoice::Automatic));
    pull(&mut session, Vec2::new(60.0, -90.0), 4);
    session.drop_handle();
    let kept = shown(&session);
    session.start_stepping();
    let effector = session.effector().expect("selected").index();
    let (_, count) = session.stepper().expect("stepping").progress();
    assert!(count >= 4, "{count}");
    for made in 0..count {
        let next = *session
            .stepper()
            .expect("stepping")
            .next()
            .expect("not the end");
        let pose = shown(&session);
        let here = pose.positions[next.joint.index()];
        assert!(
            here.distance(next.pivot_in_world.as_vec3()) < 1e-4,
            "{made}"
        );
        let tip = (next.pivot_in_world + next.to_effector).as_vec3();
        assert!(pose.positions[effector].distance(tip) < 1e-4, "{made}");
        // The angle is the one from a to b, about their cross product.
        let between = next.to_effector.angle_between(next.to_target);
        assert!((between - next.amount).abs() < 1e-6);
        session.step_solver(|stepper| stepper.step(1));
    }
    let stepper = session.stepper().expect("stepping");
    assert!(stepper.next().is_none());
    let residual = stepper.report().residuals[0].distance;
    let target = session.target().expect("set").position;
    let gap = shown(&session).positions[effector].distance(target);
    assert!((f64::from(gap) - residual).abs() < 1e-4);
    session.step_solver(|stepper| stepper.step_iteration(std::cmp::Ordering::Less));
    assert!(session.stepper().expect("stepping").next().is_some());
    // Ended, the figure is as it was; kept, it stays as it is.
    assert!(session.stop_stepping());
    assert_eq!(shown(&session), kept);
    session.start_stepping();
    session.step_solver(|stepper| stepper.go_to(2));
    let second = shown(&session);
    session.keep_step();
    let gap = shown(&session).positions[effector].distance(second.positions[effector]);
    assert!(gap < 1e-5 && session.stepper().is_none());
}

#[test]
fn stepping_ends_when_time_or_joint_change() {
    let mut session = walk_with("LeftHand");
    session.start_stepping();
    session.follow_changes();
    assert!(session.stepper().is_some());
    session.transport.go_to_frame(31);
    session.follow_changes();
    assert!(session.stepper().is_none() && session.live_pose().is_none());
}

#[test]
fn pinned_feet_stay_while_the_hips_are_dragged() {
    let mut session = walk_with("Hips");
    session.toggle_pins(Hold::Feet);
    assert_eq!(session.goals().pins.len(), 2);
    let id = session.active_id().expect("open");
    assert!(!session.is_edited(id), "pins change no motion");
    let before = shown(&session);
    pull(&mut session, Vec2::new(6.0, 30.0), 12);
    let after = shown(&session);
    let hips = named(&session, "Hips").index();
    assert!(
        before.positions[hips].y - after.positions[hips].y > 0.05,
        "they sink"
    );
    let facing = before.orientations[hips].angle_between(after.orientations[hips]);
    assert!(facing < 0.02, "they keep facing where they did: {facing}");
    for pin in session.pins() {
        let away = after.positions[pin.joint.index()].distance(pin.position);
        assert!(away < 0.01, "{away}");
        let turned =
            after.orientations[pin.joint.index()].angle_between(pin.orientation.expect("held"));
        assert!(turned < 0.05, "{turned}");
    }
    session.drop_handle();
    session.toggle_pins(Hold::Feet);
    assert!(session.goals().pins.is_empty());
    session.undo();
    assert_eq!(session.goals().pins.len(), 2, "pins are undone, too");
}

#[test]
fn from_a_foot_to_a_hand_the_root_moves_and_the_foot_stays() {
    let mut session = walk_with("LeftHand");
    let foot = named(&session, "RightFoot");
    session.set_ik(IkSettings {
        start: Start::Joint(foot),
        ..IkSettings::default()
    });
    let before = shown(&session);
    pull(&mut session, Vec2::new(30.0, -20.0), 6);
    session.drop_handle();
    let after = shown(&session);
    let moved =
        |joint: JointId| before.positions[joint.index()].distance(after.positions[joint.index()]);
    assert!(moved(foot) < 1e-4, "{}", moved(foot));
    assert!(moved(named(&session, "Hips")) > 1e-3);
}

#[test]
fn a_limb_that_was_brought_somewhere_comes_back_over_the_fall_off() {
    let mut session = walk_with("LeftHand");
    let gesture = session.new_gesture().expect("open");
    let spread = Spread {
        reach: Reach::Stretch(25, 35),
        falloff_frames: 10,
        ..Spread::default()
    };
    session.set_spread(spread, gesture);
    pull(&mut session, Vec2::new(40.0, -60.0), 6);
    session.drop_handle();
    let hand = named(&session, "LeftHand");
    let clip = session.active_clip().expect("open");
    let untouched = walking();
    let moved = |frame: usize| {
        clip.global
            .position(frame, hand)
            .distance(untouched.global.position(frame, hand))
    };
    assert!(moved(30) > 0.1);
    for frame in (0..=15).chain(45..clip.frame_count()) {
        assert!(moved(frame) < 1e-6, "{frame}: {}", moved(frame));
    }
    // It fades without a jump.
    for frame in 0..clip.frame_count() - 1 {
        let jump = (moved(frame + 1) - moved(frame)).abs();
        assert!(jump < 0.35 * moved(30), "{frame}: {jump}");
    }
}

#[test]
fn clips_and_joints_that_cannot_are_left_alone() {
    let mut session = Session::default();
    session.open(arm(0));
    session.set_mode(Mode::Ik);
    session.select(Some(JointId::new(2)));
    assert!(session.gizmo().is_none());
    session.solve_again();
    session.start_stepping();
    session.toggle_pins(Hold::Effector);
    session.toggle_pins(Hold::Feet);
    assert!(session.stepper().is_none() && session.goals().pins.is_empty());
    let mut session = Session::default();
    session.open(arm(10));
    session.set_mode(Mode::Ik);
    // The root: no limb leads to it, so the figure goes where it is dragged.
    session.select(Some(JointId::new(0)));
    session.set_aspect(RECT.aspect_ratio());
    let before = shown(&session).positions[0];
    pull(&mut session, Vec2::new(50.0, 0.0), 3);
    let after = shown(&session).positions[0];
    let target = session.target().expect("dragged").position;
    assert!(after.distance(before) > 0.1 && after.distance(target) < 1e-2);
}

#[test]
fn a_target_asks_for_an_orientation_when_it_has_rings() {
    let mut session = walk_with("LeftHand");
    let mut tools = session.tools();
    tools.ik_tool = posekit_viewer::gizmo::Tool::MoveAndTurn;
    session.set_tools(tools);
    session.set_ik(settings(SolverChoice::Automatic));
    let viewport = Viewport::new(session.view_camera(), RECT);
    let handle = Handle::TurnOnScreen;
    let from = place_on(&session, handle, RECT);
    assert!(session.grab(handle, from, &viewport));
    session.drag_to(from + Vec2::new(12.0, 40.0), &viewport, None);
    let target = session.target().expect("dragged");
    let hand = session.effector().expect("selected").index();
    let pose = shown(&session);
    assert!(pose.orientations[hand].angle_between(target.orientation) < 0.05);
    assert!(pose.positions[hand].distance(target.position) < 0.02);
}

#[test]
fn an_end_is_clicked_dragged_undone_and_stepped_in_the_window() {
    let mut window: Window = laptop(vec![input("arm.bvh", 20)]);
    press(&mut window, Modifiers::NONE, Key::Space);
    press(&mut window, Modifiers::NONE, Key::Home);
    press(&mut window, Modifiers::NONE, Key::U);
    settle(&mut window);
    let hand = hand_on_screen(&window);
    window.hover_at(hand);
    window.run_steps(2);
    window.drag_at(hand);
    window.step();
    window.drop_at(hand);
    window.run_steps(3);
    let selected = viewer(&window).session().selected();
    assert_eq!(selected.map(JointId::index), Some(2), "the End Site itself");
    let before = hand_position(&window);
    let rect = view_rect(&window);
    let from = place_on(viewer(&window).session(), Handle::MoveAlong(Axis::X), rect);
    drag(&mut window, from, from + Vec2::new(90.0, 10.0));
    assert!(viewer(&window).session().is_dragging());
    window.drop_at(from + Vec2::new(90.0, 10.0));
    window.run_steps(3);
    let after = hand_position(&window);
    assert!(after.x - before.x > 0.3, "{before} {after}");
    window.get_by_label_contains(" it., ");
    press(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(hand_position(&window).distance(before) < 1e-6);
    press(&mut window, Modifiers::COMMAND, Key::Y);
    assert!(hand_position(&window).distance(after) < 1e-6);
    press(&mut window, Modifiers::NONE, Key::PageDown);
    press(&mut window, Modifiers::NONE, Key::PageDown);
    let stepper = viewer(&window).session().stepper();
    assert_eq!(stepper.expect("stepping").progress().0, 1);
    window.get_by_label("Keep the solver's pose");
    press(&mut window, Modifiers::NONE, Key::Escape);
    let session = viewer(&window).session();
    assert!(session.stepper().is_none() && session.selected().is_some());
    window.get_by_label("This joint").click();
    window.run_steps(3);
    assert_eq!(viewer(&window).session().goals().pins.len(), 1);
}

fn hand_position(window: &Window) -> Vec3 {
    let session = viewer(window).session();
    session.poses_on_stage()[0].1.positions[2]
}

fn hand_on_screen(window: &Window) -> Pos2 {
    let session = viewer(window).session();
    let place = project(
        &session.view_camera(),
        hand_position(window),
        view_rect(window),
    );
    place.expect("the hand is in front")
}

/// The same way of the pointer gives the same poses to the bit. With `--nocapture` it says what one move
/// costs, solver and figure together.
#[test]
fn the_same_way_of_the_pointer_gives_the_same_pose() {
    for (effector, pinned) in [("LeftHand", false), ("Hips", true)] {
        let way = || {
            let mut session = walk_with(effector);
            if pinned {
                session.toggle_pins(Hold::Feet);
            }
            let viewport = pull(&mut session, Vec2::new(5.0, 5.0), 2);
            let from = place_on(&session, Handle::MoveOnScreen, RECT);
            let start = std::time::Instant::now();
            for step in 0..200_u8 {
                let (sin, cos) = (f32::from(step) * 0.1).sin_cos();
                session.drag_to(from + Vec2::new(cos, sin) * 25.0, &viewport, None);
            }
            let each_us = start.elapsed().as_secs_f64() / 200.0 * 1e6;
            println!("{effector}, feet pinned: {pinned}: {each_us:.0} us a move");
            shown(&session)
        };
        let pose = way();
        assert!(pose.positions.iter().all(|p| p.is_finite()));
        assert_eq!(pose, way());
    }
}
