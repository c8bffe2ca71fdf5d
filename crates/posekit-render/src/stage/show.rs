//! An actor in a scene: the body, its ghosts, trails, labels.

use std::sync::Arc;

use glam::{Affine3, Vec3};

use posekit::body::{Side, side_of_joint};
use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton};

use crate::camera::{Camera, Projection};
use crate::color::Color;
use crate::scene::{Label, Model, Polyline, Scene, Shadow};
use crate::theme::CharacterColors;

use super::actor::transforms;
use super::options::{AxesShown, Ghosts, Labels, SkeletonStyle, Trails};
use super::{Actor, Stage};

/// A trail is drawn with at most this many points.
const TRAIL_POINTS: usize = 160;

/// Width of plain skeleton lines, pixels at the reference height.
const LINE_WIDTH: f32 = 3.0;
const TRAIL_WIDTH: f32 = 2.6;

/// How far ghosts are set back, in statures.
const SET_BACK: f32 = 0.006;

pub(super) fn add_actor(
    scene: &mut Scene,
    stage: &Stage,
    actor: &Actor,
    place: Vec3,
    time_secs: f64,
) {
    let options = stage.options();
    let pose = actor.shown_pose(time_secs);
    if !pose.positions.iter().all(|p| p.is_finite()) {
        return;
    }
    let joints = transforms(&pose, place);
    add_body(scene, actor, &pose, (joints, place), *actor.colors(), 1.0);
    if options.axes == AxesShown::Joints {
        scene.models.push(Model {
            mesh: Arc::clone(actor.axes()),
            joints: transforms(&pose, place),
            palette: actor.colors().palette(),
            opacity: 1.0,
            shadow: Shadow::None,
        });
    }
    if let Some(ghosts) = &options.ghosts {
        add_ghosts(scene, stage, actor, (&pose, place), time_secs, ghosts);
    }
    for ghost in actor.key_ghosts() {
        let look = (actor.colors().of_key_ghost(ghost.side), ghost.distance);
        add_ghost(scene, stage, actor, (&pose, place), ghost.time_secs, look);
    }
    if let Some(trails) = &options.trails {
        add_trails(scene, stage, actor, place, time_secs, trails);
    }
    add_labels(scene, stage, actor, &pose, place);
}

fn add_body(
    scene: &mut Scene,
    actor: &Actor,
    pose: &GlobalPose,
    (joints, place): (Vec<Affine3>, Vec3),
    colors: CharacterColors,
    opacity: f32,
) {
    if actor.style() == SkeletonStyle::Lines {
        add_lines(scene, actor, pose, place, &colors, opacity);
        return;
    }
    scene.models.push(Model {
        mesh: Arc::clone(actor.mesh()),
        joints,
        palette: colors.palette(),
        opacity,
        shadow: if opacity < 1.0 {
            Shadow::None
        } else {
            Shadow::Cast
        },
    });
}

fn add_lines(
    scene: &mut Scene,
    actor: &Actor,
    pose: &GlobalPose,
    place: Vec3,
    colors: &CharacterColors,
    opacity: f32,
) {
    let skeleton = actor.motion().skeleton();
    for joint in skeleton.joints().filter(|&joint| !actor.is_loose(joint)) {
        let Some(parent) = skeleton.parent(joint) else {
            continue;
        };
        let color = match side_of_joint(skeleton, joint) {
            Some(Side::Left) => colors.left.mix(colors.accent, 0.35),
            Some(Side::Right) => colors.right.mix(colors.accent, 0.35),
            None => colors.accent,
        };
        let point = |j: JointId| (pose.positions[j.index()] + place, color);
        scene.polylines.push(Polyline {
            points: vec![point(parent), point(joint)],
            width: LINE_WIDTH,
            opacity,
        });
    }
}

fn add_ghosts(
    scene: &mut Scene,
    stage: &Stage,
    actor: &Actor,
    (pose, place): (&GlobalPose, Vec3),
    time_secs: f64,
    ghosts: &Ghosts,
) {
    let motion = actor.motion();
    let step = motion.frame_time_secs() * ghosts.every_frames.max(1) as f64;
    let duration = motion.duration_secs();
    // Ghosts stand on whole multiples of the step, so that they stay where they are while the
    // figure moves through them.
    let now = time_secs / step;
    if !now.is_finite() {
        return;
    }
    let behind = (1..=ghosts.before).map(|k| (now.ceil() - k as f64, k, ghosts.before));
    let ahead = (1..=ghosts.after).map(|k| (now.floor() + k as f64, k, ghosts.after));
    for (index, rank, count) in behind.chain(ahead) {
        let time = index * step;
        if time < 0.0 || time > duration || (time - time_secs).abs() < 0.25 * step {
            continue;
        }
        let distance = (rank as f32 - 1.0) / count as f32;
        let look = (*actor.colors(), distance);
        add_ghost(scene, stage, actor, (pose, place), time, look);
    }
}

/// A pose of the motion, faintly: the fainter the farther off it is, from 0 to 1.
fn add_ghost(
    scene: &mut Scene,
    stage: &Stage,
    actor: &Actor,
    (pose, place): (&GlobalPose, Vec3),
    time_secs: f64,
    (colors, distance): (CharacterColors, f32),
) {
    let camera = scene.camera;
    let nearness = |pose: &GlobalPose| toward_eye(&camera, middle(actor, pose) + place);
    let paper = stage.options().theme.ground;
    let ghost = actor.pose(time_secs);
    if !ghost.positions.iter().all(|p| p.is_finite()) {
        return;
    }
    let fade = 0.15 + 0.6 * distance;
    // One that stands before the figure must not hide it: a thin veil, and the same samples
    // for all of them, so that many are no thicker than one.
    let is_before = nearness(&ghost) - nearness(pose) > 0.06 * actor.stature();
    let (fade, opacity) = if is_before {
        (0.5 * fade, 0.25)
    } else {
        (fade, 0.5)
    };
    let colors = colors.mixed(paper, fade);
    let mut joints = transforms(&ghost, place);
    set_back(&mut joints, &camera, actor.stature());
    add_body(scene, actor, &ghost, (joints, place), colors, opacity);
}

/// The middle of the figure's joints.
fn middle(actor: &Actor, pose: &GlobalPose) -> Vec3 {
    let skeleton = actor.motion().skeleton();
    let parts = skeleton.joints().filter(|&joint| !actor.is_loose(joint));
    let (sum, count) = parts.fold((Vec3::ZERO, 0.0f32), |(sum, count), joint| {
        (sum + pose.positions[joint.index()], count + 1.0)
    });
    sum / count.max(1.0)
}

/// How near to the eye a point is: larger is nearer.
fn toward_eye(camera: &Camera, point: Vec3) -> f32 {
    match camera.projection {
        Projection::Perspective { .. } => -camera.eye.distance(point),
        Projection::Orthographic { .. } => point.dot(camera.axes().2),
    }
}

/// Moves a ghost away from the eye by a hair, without moving it in the picture: what stands where
/// the figure stands lies under it and does not mix with it.
fn set_back(joints: &mut [Affine3], camera: &Camera, stature: f32) {
    let by = SET_BACK * stature;
    match camera.projection {
        Projection::Perspective { .. } => {
            let Some(first) = joints.first() else { return };
            let distance = camera.eye.distance(first.translation);
            let scale = 1.0 + by / distance.max(by);
            for joint in joints {
                joint.matrix3 *= scale;
                let from_eye = joint.translation - camera.eye;
                joint.translation = camera.eye + from_eye * scale;
            }
        }
        Projection::Orthographic { .. } => {
            let back = camera.axes().2;
            for joint in joints {
                joint.translation -= back * by;
            }
        }
    }
}

fn add_trails(
    scene: &mut Scene,
    stage: &Stage,
    actor: &Actor,
    place: Vec3,
    time_secs: f64,
    trails: &Trails,
) {
    let motion = actor.motion();
    let joint_count = motion.skeleton().joint_count();
    let now = time_secs.clamp(0.0, motion.duration_secs());
    let start = (now - trails.seconds.max(0.0)).max(0.0);
    let frames = (now - start) / motion.frame_time_secs().max(1e-6);
    #[expect(clippy::cast_possible_truncation, reason = "clamped to a small number")]
    let count = frames.ceil().clamp(1.0, TRAIL_POINTS as f64) as usize;
    let poses: Vec<GlobalPose> = (0..=count)
        .map(|i| actor.pose(start + (now - start) * i as f64 / count as f64))
        .collect();
    let paper = stage.options().theme.ground;
    for joint in trails.joints.iter().filter(|j| j.index() < joint_count) {
        let color = trail_color(motion.skeleton(), *joint, actor.colors());
        let points = poses.iter().enumerate().map(|(i, pose)| {
            let age = 1.0 - i as f32 / count as f32;
            (
                pose.positions[joint.index()] + place,
                color.mix(paper, age * age * 0.9),
            )
        });
        scene.polylines.push(Polyline {
            points: points.collect(),
            width: TRAIL_WIDTH,
            opacity: 1.0,
        });
    }
}

/// Left bluish, right reddish, the middle as the accent: stronger than the body's own colours.
fn trail_color(skeleton: &Skeleton, joint: JointId, colors: &CharacterColors) -> Color {
    match side_of_joint(skeleton, joint) {
        Some(Side::Left) => Color::from_hex(0x2F_6F_C4).mix(colors.left, 0.25),
        Some(Side::Right) => Color::from_hex(0xD9_58_2B).mix(colors.right, 0.25),
        None => colors.accent,
    }
}

fn add_labels(scene: &mut Scene, stage: &Stage, actor: &Actor, pose: &GlobalPose, place: Vec3) {
    let skeleton = actor.motion().skeleton();
    let chosen: Vec<JointId> = match &stage.options().labels {
        Labels::None => return,
        Labels::All => skeleton
            .joints()
            .filter(|&j| !skeleton.is_end_site(j))
            .collect(),
        Labels::Of(joints) => joints
            .iter()
            .copied()
            .filter(|j| j.index() < skeleton.joint_count())
            .collect(),
    };
    for joint in chosen {
        scene.labels.push(Label {
            position: pose.positions[joint.index()] + place,
            text: skeleton.name(joint).to_owned(),
            color: stage.options().theme.text,
            size: 14.0,
        });
    }
}
