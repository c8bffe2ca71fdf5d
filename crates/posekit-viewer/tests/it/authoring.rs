//! The animation mode without a window: what a session makes of a clip, and of keys.

use egui::{Pos2, Vec2};
use glam::Quat;
use posekit::keyframe::{Interpolation, ReduceConfig};
use posekit::skeleton::JointId;
use posekit_formats::scene::{self, Scene};
use posekit_viewer::state::animate::{Authored, KeyId, Lane, Start, start};
use posekit_viewer::state::clip::Clip;
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::Session;

use super::clips::walking;
use super::editing::place_on;

/// A session with the walk, animated in some way.
fn animated(how: Start) -> Session {
    let clip = Clip::of_sample("walk", "walk").expect("a sample");
    let mut session = Session::default();
    let authored = start(&clip, how, 0.5, false).expect("it can be animated");
    let id = session.open(clip);
    session.put_authored(id, authored);
    session.set_mode(Mode::Animate);
    session.transport.pause();
    session
}

#[test]
fn a_clip_is_animated_in_each_way() {
    let walk = walking().motion;
    let over = animated(Start::OverMotion);
    let clip = over.active_clip().expect("open");
    for joint in walk.skeleton().joints() {
        let gap = walk
            .rotation(20, joint)
            .angle_between(clip.motion.rotation(20, joint));
        assert!(gap < 1e-3, "over the motion it is the motion");
    }
    let config = ReduceConfig::default();
    let reduced = animated(Start::Reduced(config));
    let animation = reduced.authored().expect("authored").animation();
    let error = posekit::keyframe::KeyError::between(&walk, animation);
    assert!(error.angle_deg <= config.angle_deg && error.distance_heights <= 0.01);
    let rest = animated(Start::Rest);
    let pose = rest.authored().expect("authored").pose_at(1.0);
    let skeleton = walk.skeleton();
    for joint in skeleton.joints() {
        let gap = pose.rotations[joint.index()].angle_between(skeleton.rest_rotation(joint));
        assert!(gap < 1e-3);
    }
    let posed = animated(Start::Pose);
    let pose = posed.authored().expect("authored").pose_at(1.0);
    let shown = walk.sample(0.5);
    for joint in skeleton.joints().filter(|j| !skeleton.is_end_site(*j)) {
        let gap = pose.rotations[joint.index()].angle_between(shown.rotations[joint.index()]);
        assert!(gap < 1e-3);
    }
}

#[test]
fn an_in_between_is_one_step_and_lies_between() {
    let mut session = animated(Start::Pose);
    let joint = walking().motion.rotated_joints()[5];
    session.select(Some(joint));
    let turn = glam::DQuat::from_rotation_z(1.0);
    key_turned(&mut session, joint, 60, turn);
    session.transport.go_to_frame(30);
    let ends = {
        let authored = session.authored().expect("authored");
        let rate = authored.scene().frames_per_sec;
        [0.0, 60.0].map(|n| authored.pose_at(n / rate).rotations[joint.index()])
    };
    let gesture = session.author(Authored::gesture).expect("authored");
    let before = session.authored().expect("authored").undo_count();
    for share in [0.1, 0.9, 0.25] {
        session.author(|authored| {
            authored.give_up(gesture);
            let at = authored.snapped(authored.now_secs());
            let edit = posekit_viewer::state::animate::edit::pose::breakdown(
                authored,
                &[joint],
                at,
                share,
                Interpolation::Cubic,
            );
            let edit = edit.expect("the joint is keyed");
            authored.set_tracks("In-between", Some(gesture), edit.changes, edit.selection);
        });
    }
    let authored = session.authored().expect("authored");
    assert_eq!(authored.undo_count(), before + 1);
    let now = authored.pose_at(authored.now_secs()).rotations[joint.index()];
    let expected = ends[0].slerp(ends[1], 0.25);
    assert!(now.angle_between(expected) < 1e-3);
}

/// Keys a joint at a frame, turned from where it is.
fn key_turned(session: &mut Session, joint: JointId, frame: usize, turn: glam::DQuat) {
    session.transport.go_to_frame(frame);
    session.author(|authored| {
        let at = authored.snapped(authored.now_secs());
        let mut pose = authored.pose_at(at);
        let rotation = &mut pose.rotations[joint.index()];
        *rotation = (rotation.as_dquat() * turn).as_quat();
        let edit = posekit_viewer::state::animate::edit::pose::keys_of_pose(
            authored,
            &[joint],
            &pose,
            at,
            Interpolation::Cubic,
        );
        let edit = edit.expect("a finite pose");
        authored.set_tracks("Key", None, edit.changes, edit.selection);
    });
}

#[test]
fn the_range_of_the_scene_is_what_plays() {
    let mut session = animated(Start::Pose);
    session.author(|authored| {
        drop(authored.edit_scene("Range", None, |scene| scene.range_secs = [0.5, 1.0]));
    });
    let clip = session.active_clip().expect("open");
    let rate = session.authored().expect("authored").scene().frames_per_sec;
    assert_eq!(session.transport.frame_count(), clip.frame_count());
    let frames = clip.frame_count() as f64 - 1.0;
    assert!((frames / rate - 0.5).abs() < 1.0 / rate);
    session.transport.go_to_frame(0);
    assert!((session.scene_secs() - 0.5).abs() < 1e-9);
    session.undo();
    assert!(session.authored().expect("authored").scene().range_secs[0] == 0.0);
}

#[test]
fn with_ik_a_limb_is_keyed_as_one_step() {
    let mut session = animated(Start::OverMotion);
    let skeleton = walking().motion.skeleton().clone();
    let hand = skeleton.find("LeftHand").expect("the sample has hands");
    let mut settings = session.animate();
    settings.uses_ik = true;
    settings.auto_key = true;
    session.set_animate(settings);
    session.transport.go_to_frame(30);
    session.select(Some(hand));
    let rect = egui::Rect::from_min_size(Pos2::ZERO, Vec2::new(900.0, 700.0));
    session.set_aspect(rect.aspect_ratio());
    let viewport = posekit_viewer::gizmo::Viewport::new(session.view_camera(), rect);
    let handle = posekit_viewer::gizmo::Handle::MoveOnScreen;
    let from = place_on(&session, handle, rect);
    assert!(session.grab(handle, from, &viewport));
    session.drag_to(from + Vec2::new(-20.0, -60.0), &viewport, None);
    let target = session.target().expect("it is dragged").position;
    session.drop_handle();
    let authored = session.authored().expect("a scene");
    assert_eq!(authored.undo_count(), 1);
    let keyed: Vec<_> = authored
        .animation()
        .rotations()
        .map(|(joint, _)| joint)
        .collect();
    let arm = ["LeftUpperArm", "LeftLowerArm"].map(|name| skeleton.find(name).expect("an arm"));
    assert!(arm.iter().all(|joint| keyed.contains(joint)), "{keyed:?}");
    let leg = skeleton.find("RightUpperLeg").expect("a leg");
    assert!(!keyed.contains(&leg), "the rest follows the motion");
    let clip = session.active_clip().expect("open");
    let there = clip.global.position(30, hand);
    assert!(there.distance(target) < 0.02, "{there} {target}");
    session.undo();
    let authored = session.authored().expect("a scene");
    assert_eq!(authored.key_count(), 0);
}

#[test]
fn copied_keys_find_their_joints_by_name_elsewhere() {
    use posekit_viewer::state::animate::edit::clipboard::{Clipboard, mirrored};
    let mut session = animated(Start::Pose);
    let skeleton = walking().motion.skeleton().clone();
    let [left, right] = ["LeftUpperArm", "RightUpperArm"].map(|name| skeleton.find(name));
    let (left, right) = (left.expect("an arm"), right.expect("an arm"));
    key_turned(&mut session, left, 20, glam::DQuat::from_rotation_z(0.7));
    let authored = session.authored().expect("a scene");
    let keys = authored.selection().clone();
    assert_eq!(keys.len(), 1);
    let copied = Clipboard::of(authored, &keys);

    // A figure of fewer joints in another order.
    let mut scene = Scene::new(scene::SkeletonSource::inline(&skeleton));
    let scene::SkeletonSource::Inline(joints) = &mut scene.skeleton else {
        panic!("it was made so");
    };
    joints.retain(|joint| ["Hips", "LeftUpperArm"].contains(&joint.name.as_str()));
    joints[1].parent = Some(0);
    let other = Authored::new(scene, Default::default()).expect("two joints");
    let edit = copied
        .paste(&other, 0.25, false)
        .expect("one of them is there");
    let arm = other.skeleton().find("LeftUpperArm").expect("kept");
    let pasted: Vec<KeyId> = edit.selection.into_iter().collect();
    assert_eq!(
        pasted,
        [KeyId {
            lane: Lane::Rotation(arm),
            index: 0
        }]
    );
    let none = Authored::new(
        Scene::new(scene::SkeletonSource::File("sample:arm".into())),
        {
            let arm = posekit::sample::by_name("arm").expect("a sample");
            [("sample:arm".to_owned(), std::sync::Arc::new(arm).into())].into()
        },
    );
    let none = none.expect("an arm of steel");
    assert_eq!(copied.paste(&none, 0.0, false), None);

    // Selected on one side, the other side gets the image, and the first keeps its own.
    let before = authored.pose_at(20.0 / 60.0);
    let edit = mirrored(authored, &keys).expect("arms have partners");
    session.author(|authored| authored.set_tracks("Mirror", None, edit.changes, edit.selection));
    let authored = session.authored().expect("a scene");
    let after = authored.pose_at(20.0 / 60.0);
    let axis = posekit::keyframe::edit::mirror_axis(&skeleton);
    let image = posekit::keyframe::edit::mirror_pose(&skeleton, axis, &before);
    let gap = |a: Quat, b: Quat| a.angle_between(b);
    assert!(
        gap(
            after.rotations[right.index()],
            image.rotations[right.index()]
        ) < 1e-3
    );
    assert!(
        gap(
            after.rotations[left.index()],
            before.rotations[left.index()]
        ) < 1e-3
    );
}
