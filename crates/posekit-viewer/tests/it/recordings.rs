//! Recordings: many frames and no keys. Edits fade, limbs keep to what they do, angles are those of the file.

use egui::{Pos2, Rect, Vec2, pos2};
use glam::Quat;
use posekit::body::Anatomy;
use posekit::rotation::EulerOrder;
use posekit::skeleton::JointId;
use posekit_formats::scene;
use posekit_viewer::gizmo::{Handle, Viewport};
use posekit_viewer::load::read_clip;
use posekit_viewer::load::scene::read_scene;
use posekit_viewer::state::animate::{Start, start};
use posekit_viewer::state::clip::Clip;
use posekit_viewer::state::ik::{channel_limits, ranges_within};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::Session;

use super::clips::{arm, arm_text, walking};

fn recorded() -> Session {
    let mut session = Session::default();
    session.open(walking());
    session.transport.pause();
    session
}

fn knees(clip: &Clip) -> Vec<(JointId, JointId, JointId)> {
    let anatomy = Anatomy::of_motion(&clip.motion).expect("a person walks");
    let legs = anatomy.limbs().take(2);
    legs.map(|leg| (leg.upper, leg.middle, leg.lower)).collect()
}

/// A clip's motion is within its own ranges in every frame, and knees bend farther the way they bend, and not
/// the other.
#[test]
fn ranges_hold_the_motion_and_keep_knees_from_bending_backwards() {
    let clip = walking();
    let limits = ranges_within(&clip.motion, &clip.global, &channel_limits(&clip.document));
    let skeleton = clip.skeleton();
    for joint in skeleton.joints() {
        for frame in 0..clip.frame_count() {
            let rotation = clip.motion.rotation(frame, joint).as_dquat();
            assert!(
                limits.limit(joint).allows(rotation, 1e-3),
                "{} at {frame}",
                skeleton.unique_name(joint)
            );
        }
    }
    for (hip, knee, ankle) in knees(&clip) {
        // Measured by the angle between thigh and shin, not by the joint's own angles.
        let bend = |frame: usize| {
            let at = |joint| clip.global.position(frame, joint);
            (at(knee) - at(hip)).angle_between(at(ankle) - at(knee))
        };
        let frames = 0..clip.frame_count();
        let straight = frames.clone().min_by(|&a, &b| bend(a).total_cmp(&bend(b)));
        let bent = frames.max_by(|&a, &b| bend(a).total_cmp(&bend(b)));
        let [straight, bent] = [straight, bent].map(|frame| {
            let frame = frame.expect("there are frames");
            clip.motion.rotation(frame, knee)
        });
        let (axis, angle) = (straight.inverse() * bent).to_axis_angle();
        assert!(angle > 0.3, "the walk bends its knees");
        let turned = |by: f32| (straight * Quat::from_axis_angle(axis, by)).as_dquat();
        let limit = limits.limit(knee);
        assert!(limit.allows(turned(angle + 0.4), 1e-3), "more bend");
        assert!(!limit.allows(turned(-0.15), 1e-2), "backwards");
    }
}

/// The switch is on for recordings and off for a few frames until somebody switches it; solvers keep to it.
#[test]
fn a_dragged_foot_does_not_bend_its_knee_backwards() {
    let mut few = Session::default();
    few.open(arm(10));
    assert!(!few.keeps_within_motion() && few.spread().falloff_frames == 0);
    let mut session = recorded();
    assert!(session.keeps_within_motion());
    let clip = session.active_clip().expect("it is open").clone();
    let limits = ranges_within(&clip.motion, &clip.global, &channel_limits(&clip.document));
    let (_, knee, ankle) = knees(&clip)[0];
    session.set_mode(Mode::Ik);
    session.select(Some(ankle));
    let rect = Rect::from_min_size(Pos2::ZERO, Vec2::new(800.0, 600.0));
    session.set_aspect(800.0 / 600.0);
    let drag_all_ways = |session: &mut Session| -> f64 {
        let mut farthest = 0.0_f64;
        for way in [(0.0, -150.0), (120.0, -60.0), (-120.0, -60.0), (0.0, 80.0)] {
            let viewport = Viewport::new(session.view_camera(), rect);
            let gizmo = session.gizmo().expect("the ankle has a target");
            let from = viewport.project(gizmo.position).expect("it is seen");
            assert!(session.grab(Handle::MoveOnScreen, from, &viewport));
            for step in 1..=8_u8 {
                let share = f32::from(step) / 8.0;
                let to = from + Vec2::new(way.0, way.1) * share;
                session.drag_to(to, &viewport, None);
                let pose = session.live_pose().expect("the leg follows");
                let turn = pose.rotations[knee.index()].as_dquat();
                let kept = limits.limit(knee).project(turn);
                farthest = farthest.max(posekit::rotation::angle_between(turn, kept));
            }
            session.cancel_drag();
        }
        farthest
    };
    let kept = drag_all_ways(&mut session);
    assert!(kept < 0.02, "{kept}");
    let mut settings = session.ik().clone();
    settings.within_motion = Some(false);
    session.set_ik(settings);
    let free = drag_all_ways(&mut session);
    assert!(free > 0.05, "the limits were in the way: {free}");
}

/// An edit of one frame of a recording reaches those around it, less and less, so that nothing jumps.
#[test]
fn an_edit_of_a_recording_fades_on_both_sides() {
    let mut session = recorded();
    let clip = session.active_clip().expect("it is open").clone();
    let frames = (0.3 / clip.motion.frame_time_secs()).round();
    let falloff = session.spread().falloff_frames;
    assert!((falloff as f64 - frames).abs() < 1.0, "{falloff} {frames}");
    let (_, knee, _) = knees(&clip)[0];
    let at = clip.frame_count() / 2;
    session.transport.go_to_frame(at);
    session.set_mode(Mode::Pose);
    session.select(Some(knee));
    let rect = Rect::from_min_size(Pos2::ZERO, Vec2::new(800.0, 600.0));
    let viewport = Viewport::new(session.view_camera(), rect);
    let gizmo = session.gizmo().expect("the knee turns");
    let middle = viewport.project(gizmo.position).expect("it is seen");
    let ring = pos2(middle.x + 86.0, middle.y);
    assert!(session.grab(Handle::TurnOnScreen, ring, &viewport));
    session.drag_to(pos2(middle.x + 70.0, middle.y - 50.0), &viewport, None);
    session.drop_handle();
    let edited = session.active_clip().expect("it is open");
    let change = |frame: usize| {
        let [before, after] = [&clip, edited].map(|clip| clip.motion.rotation(frame, knee));
        before.angle_between(after)
    };
    let whole = change(at);
    assert!(whole > 0.3, "{whole}");
    for step in 1..=falloff + 2 {
        for (near, far) in [(at + step - 1, at + step), (at - step + 1, at - step)] {
            assert!(change(far) <= change(near) + 1e-3, "it fades");
            let jump = change(near) - change(far);
            assert!(jump < 2.0 * whole / falloff as f32, "{step}: {jump}");
        }
    }
    assert!(change(at + falloff) < 1e-3 && change(at - falloff) < 1e-3);
}

// --- The order of angles ---

fn in_yxz() -> String {
    arm_text(80).replace(
        "Zrotation Xrotation Yrotation",
        "Yrotation Xrotation Zrotation",
    )
}

/// Angles stay in the order of the file's channels when a clip gets keys, and when its scene is opened again;
/// a track that has an order of its own is told in that.
#[test]
fn an_animated_clip_keeps_the_order_of_its_files_angles() {
    let text = in_yxz();
    let mut clip = read_clip("arm.bvh", text.as_bytes()).expect("a valid file");
    let elbow = JointId::new(1);
    assert_eq!(clip.rotation_order(elbow), Some(EulerOrder::YXZ));
    let folder = super::animate::folder("orders");
    let path = folder.join("arm.bvh");
    std::fs::write(&path, &text).expect("written");
    clip.source = posekit_viewer::state::clip::Source::File(path.clone());
    let authored = start(&clip, Start::OverMotion, 0.0, false).expect("it has a file");
    assert_eq!(authored.order_of(elbow), EulerOrder::YXZ);
    let text = scene::write(authored.scene()).expect("it can be written");
    let mut session = Session::default();
    let id = session.open(clip);
    session.put_authored(id, authored);
    let shown = session.active_clip().expect("it is open");
    assert_eq!(shown.rotation_order(elbow), Some(EulerOrder::YXZ));
    // The same numbers in the inspector as in the file.
    let values = posekit_viewer::state::readout::channel_values(shown, JointId::new(0), 2.0);
    let first: Vec<f64> = values.iter().skip(3).map(|(_, value)| *value).collect();
    assert!((first[0] - 40.0).abs() < 1e-3, "{first:?}");
    // Again from its file.
    let file = folder.join("arm.posekit.toml");
    std::fs::write(&file, &text).expect("written");
    let bytes_of = |name: &str| std::fs::read(name).map_err(|error| error.to_string());
    let (_, authored) =
        read_scene(("arm.posekit.toml", Some(&file)), &text, bytes_of).expect("what was written");
    assert_eq!(authored.order_of(elbow), EulerOrder::YXZ);
    std::fs::remove_dir_all(&folder).expect("removed");
}
