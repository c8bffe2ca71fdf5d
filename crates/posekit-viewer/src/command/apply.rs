//! What commands do to a session.

use std::cmp::Ordering;

use super::Command;
use crate::gizmo::Tool;
use crate::state::camera::ViewCamera;
use crate::state::display::{FollowMode, Look, PoseShown};
use crate::state::session::{Handles, KeyWhat, Session};
use crate::state::transport::AtEnd;

/// One step of turning the view with the keys, radians: fifteen degrees, as in Blender.
const KEY_TURN: f32 = 0.0818;

/// One step of zooming with the keys.
const KEY_ZOOM: f32 = 1.2;

/// Does what a command asks of the session. False for a command that is about windows or files.
pub fn apply(command: Command, session: &mut Session) -> bool {
    apply_to_time(command, session)
        || apply_to_view(command, session)
        || apply_to_edits(command, session)
        || apply_to_figure(command, session)
}

fn apply_to_edits(command: Command, session: &mut Session) -> bool {
    let mut tools = session.tools();
    match command {
        Command::Mode(mode) => session.set_mode(mode),
        Command::Tool(tool) if session.handles() == Handles::Targets => {
            tools.ik_tool = if tool.turns() {
                Tool::MoveAndTurn
            } else {
                Tool::Move
            };
        }
        Command::Tool(tool) => tools.tool = tool,
        Command::TakeInHand(act) => {
            session.take_in_hand(act);
            return true;
        }
        Command::TogglePin(what) => session.toggle_pins(what),
        Command::Solve => session.solve_again(),
        Command::ForgetTarget => session.forget_target(),
        Command::StepSolver => match session.stepper() {
            None => session.start_stepping(),
            Some(_) => session.step_solver(|stepper| stepper.step(1)),
        },
        Command::StepSolverBack => session.step_solver(|stepper| stepper.step(-1)),
        Command::NextSpace => {
            let space = tools.space_with(session.handles());
            *space = space.next();
        }
        Command::ToggleSnap => tools.snaps = !tools.snaps,
        Command::Undo => drop(session.undo()),
        Command::Redo => drop(session.redo()),
        Command::InsertKeys => {
            session.insert_keys(KeyWhat::Selected);
        }
        Command::KeyWholePose => {
            session.insert_keys(KeyWhat::Whole);
        }
        Command::LookThrough => session.toggle_look_through(),
        Command::CameraToView => session.camera_to_view(),
        Command::DeleteThing => {
            if let Some(picked) = session.picked() {
                session.remove_thing(picked.owner);
            }
        }
        Command::ToggleAutoKey | Command::ToggleUseIk => {
            let mut settings = session.animate();
            match command {
                Command::ToggleAutoKey => settings.auto_key = !settings.auto_key,
                _ => settings.uses_ik = !settings.uses_ik,
            }
            session.set_animate(settings);
        }
        Command::KeepPose => session.keep_draft(),
        Command::ResetPose => session.reset_draft(),
        _ => return false,
    }
    session.set_tools(tools);
    true
}

fn apply_to_time(command: Command, session: &mut Session) -> bool {
    let transport = &mut session.transport;
    match command {
        Command::TogglePlay => transport.toggle_play(),
        Command::NextFrame => transport.step(1),
        Command::PreviousFrame => transport.step(-1),
        Command::TenFramesOn => transport.step(10),
        Command::TenFramesBack => transport.step(-10),
        Command::GoToStart => transport.go_to_frame(transport.range().0),
        Command::GoToEnd => {
            transport.pause();
            transport.go_to_frame(transport.range().1);
        }
        Command::RangeStart => transport.set_range_start_here(),
        Command::RangeEnd => transport.set_range_end_here(),
        Command::ClearRange => transport.clear_range(),
        Command::ToggleLoop => {
            transport.at_end = match transport.at_end {
                AtEnd::Loop => AtEnd::Stop,
                AtEnd::Stop => AtEnd::Loop,
            }
        }
        Command::Faster => transport.faster(),
        Command::Slower => transport.slower(),
        Command::NextFinding => session.go_to_finding(Ordering::Greater),
        Command::PreviousFinding => session.go_to_finding(Ordering::Less),
        _ => return false,
    }
    true
}

/// Does what a command asks of a camera alone, which looks at something of a certain size. False for
/// a command about anything else.
pub fn apply_to_camera(command: Command, camera: &mut ViewCamera, size: f32) -> bool {
    match command {
        Command::LookBehind => camera.turn_around(),
        Command::ToggleProjection => camera.toggle_projection(),
        Command::TurnLeft => camera.turn(-KEY_TURN, 0.0),
        Command::TurnRight => camera.turn(KEY_TURN, 0.0),
        Command::TurnUp => camera.turn(0.0, KEY_TURN),
        Command::TurnDown => camera.turn(0.0, -KEY_TURN),
        Command::ZoomIn => camera.zoom(1.0 / KEY_ZOOM, size),
        Command::ZoomOut => camera.zoom(KEY_ZOOM, size),
        _ => return false,
    }
    true
}

fn apply_to_view(command: Command, session: &mut Session) -> bool {
    let stature = session.stage().stature();
    let before = session.camera.clone();
    if session.looks_through().is_some() && apply_to_camera(command, &mut session.camera, stature) {
        // The view turns away from the camera, from where that stands.
        session.camera = before;
        session.leave_camera();
    }
    if matches!(
        command,
        Command::Look(_) | Command::FrameSelected | Command::FrameAll
    ) {
        session.look_through(None);
    }
    match command {
        Command::Look(view) => session.look_from(view),
        Command::FrameSelected => session.frame_selected(),
        Command::FrameAll => session.reframe(),
        _ => return apply_to_camera(command, &mut session.camera, stature),
    }
    true
}

fn apply_to_figure(command: Command, session: &mut Session) -> bool {
    let mut display = session.display().clone();
    match command {
        Command::NextStyle => display.style = display.style.next(),
        Command::ToggleLabels => display.labels = !display.labels,
        Command::ToggleAxes => display.axes = !display.axes,
        Command::ToggleTrails => display.trails = !display.trails,
        Command::ToggleGhosts => display.ghosts = !display.ghosts,
        Command::ToggleCompare => {
            use crate::state::display::Compare::{Overlaid, SideBySide};
            display.compare = match display.compare {
                SideBySide => Overlaid,
                Overlaid => SideBySide,
            };
        }
        Command::ToggleFollow => {
            let follows = match display.follow {
                FollowMode::On => true,
                FollowMode::Off => false,
                FollowMode::Auto => session.stage().follows(),
            };
            display.follow = if follows {
                FollowMode::Off
            } else {
                FollowMode::On
            };
        }
        Command::ToggleRest => {
            session.set_pose_shown(match session.pose_shown() {
                PoseShown::Motion => PoseShown::Rest,
                PoseShown::Rest => PoseShown::Motion,
            });
        }
        Command::SelectParent => session.select_parent(),
        Command::SelectChild => session.select_child(),
        Command::Deselect => session.select(None),
        Command::ToggleLook => session.set_look(match session.look() {
            Look::Light => Look::Dark,
            Look::Dark => Look::Light,
        }),
        _ => return false,
    }
    session.set_display(display);
    true
}
