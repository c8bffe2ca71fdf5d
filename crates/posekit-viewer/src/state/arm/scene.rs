//! The bench as a scene: the robot, the other elbow, what it reaches, the ellipsoid, frames and names.

use std::sync::Arc;

use glam::{Affine3, DVec2, Mat3, Vec3};
use posekit_render::camera::Camera;
use posekit_render::color::Color;
use posekit_render::grid::LengthUnit;
use posekit_render::mesh::{MATERIAL_COUNT, MaterialId, Mesh, Shape};
use posekit_render::scene::{Label, Model, Polyline, Scene, Shadow};
use posekit_render::stage::Room;
use posekit_render::theme::Theme;

use super::bench::Bench;
use super::body::transforms;
use super::planar::PlanarArm;
use super::single;
use crate::state::display::Look;

/// What is shown beside the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// The ellipsoid of the tip's velocities.
    pub ellipsoid: bool,
    /// The frames of the joints on the way to the tip.
    pub frames: bool,
    /// The names of the joints.
    pub names: bool,
    /// What a planar arm's tip can reach.
    pub reach: bool,
    /// A planar arm's other solution.
    pub other_elbow: bool,
}

impl Default for Shown {
    fn default() -> Self {
        Self {
            ellipsoid: true,
            frames: true,
            names: false,
            reach: true,
            other_elbow: true,
        }
    }
}

/// The ellipsoid is where the tip would be after so long, with every joint's share of unit speed;
/// seconds.
pub const ELLIPSOID_SECS: f64 = 0.2;

/// The ellipsoid is never thinner, nor larger, than these shares of the reach.
const ELLIPSOID_THINNEST: f32 = 0.004;
const ELLIPSOID_LARGEST: f32 = 0.45;

/// Length of a frame's axes as a share of the reach.
const AXIS_LENGTH: f32 = 0.13;

/// Corners of circles.
const CORNERS: usize = 96;

const RED: u32 = 0xD9_58_4F;
const GREEN: u32 = 0x4E_A2_5A;
const BLUE: u32 = 0x4B_86_DB;
const VIOLET: u32 = 0x9A_6F_C9;

/// The scene of a bench seen by a camera.
#[must_use]
pub fn scene(bench: Option<&Bench>, shown: Shown, look: Look, camera: Camera) -> Scene {
    let theme = match look {
        Look::Light => Theme::light(),
        Look::Dark => Theme::dark(),
    };
    let size = bench.map_or(1.0, |bench| single(bench.robot().reach));
    let room = Room {
        theme,
        size: 1.2 * size,
        ground_height: bench.map_or(0.0, |bench| bench.robot().ground_height),
        focus: Vec3::ZERO,
        radius: 4.0 * size,
        unit: LengthUnit::Metre,
        yaw_from_above_rad: 0.0,
    };
    let mut scene = room.scene(camera);
    let Some(bench) = bench else { return scene };
    let joints = transforms(bench.frames());
    let body = &bench.robot().body;
    for part in &body.parts {
        scene.models.push(Model {
            mesh: Arc::clone(&part.mesh),
            joints: joints.clone(),
            palette: [part.color; MATERIAL_COUNT],
            opacity: part.opacity,
            shadow: if part.opacity < 1.0 {
                Shadow::None
            } else {
                Shadow::Cast
            },
        });
    }
    if let Some(arm) = bench.planar() {
        if shown.reach {
            add_reach(&mut scene, bench, arm, &theme);
        }
        if shown.other_elbow {
            add_other_elbow(&mut scene, bench, arm, &theme);
        }
    }
    if shown.ellipsoid {
        add_ellipsoid(&mut scene, bench, size);
    }
    if shown.frames {
        add_frames(&mut scene, bench, size);
    }
    if shown.names {
        add_names(&mut scene, bench, &theme);
    }
    scene
}

/// The area between the two circles that the tip can reach, and what the elbow's range leaves of it.
fn add_reach(scene: &mut Scene, bench: &Bench, arm: &PlanarArm, theme: &Theme) {
    let (farthest, nearest) = (
        arm.links.upper + arm.links.fore,
        (arm.links.upper - arm.links.fore).abs(),
    );
    let size = single(farthest);
    let ring = Shape::annulus(single(nearest), size, 0.002 * size, CORNERS);
    let mut mesh = Mesh::default();
    mesh.add(&ring, 0, MaterialId::Base);
    let blue = Color::from_hex(BLUE);
    scene.models.push(Model {
        mesh: Arc::new(mesh),
        joints: vec![Affine3 {
            matrix3: Mat3::from_quat(arm.axes.as_quat()),
            translation: arm.origin.as_vec3(),
        }],
        palette: [blue.mix(theme.ground, 0.55); MATERIAL_COUNT],
        opacity: 0.25,
        shadow: Shadow::None,
    });
    for radius in [farthest, nearest] {
        add_circle(scene, arm, radius, blue, 2.2);
    }
    let elbow = bench.robot().ranges[arm.values[1]];
    let bend = elbow.lower.abs().max(elbow.upper.abs());
    let inner = arm.inner_radius(bend);
    if inner > nearest + 0.01 * farthest {
        let color = Color::from_hex(0xD6_9A_2D);
        add_circle(scene, arm, inner, color, 1.6);
    }
}

fn add_circle(scene: &mut Scene, arm: &PlanarArm, radius: f64, color: Color, width: f32) {
    let point = |corner: usize| {
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let turn = std::f64::consts::TAU * (corner % CORNERS) as f64 / CORNERS as f64;
        let (sin, cos) = libm::sincos(turn);
        (arm.in_world(DVec2::new(cos, sin) * radius).as_vec3(), color)
    };
    scene.polylines.push(Polyline {
        points: (0..=CORNERS).map(point).collect(),
        width,
        opacity: 1.0,
    });
}

/// The other way to reach where the tip should be, as a ghost.
fn add_other_elbow(scene: &mut Scene, bench: &Bench, arm: &PlanarArm, theme: &Theme) {
    let Some(read) = bench.two_link() else { return };
    for elbow in read.elbows.iter().filter(|elbow| !elbow.is_taken) {
        let mut values = bench.values().to_vec();
        for (index, angle) in arm.values.into_iter().zip(elbow.angles) {
            values[index] = angle;
        }
        let joints = transforms(&bench.robot().mechanism.global_frames(&values));
        for part in &bench.robot().body.parts {
            scene.models.push(Model {
                mesh: Arc::clone(&part.mesh),
                joints: joints.clone(),
                palette: [part.color.mix(theme.ground, 0.35); MATERIAL_COUNT],
                opacity: 0.5 * part.opacity,
                shadow: Shadow::None,
            });
        }
        let ends = [arm.elbow, arm.tip].map(|joint| joints[joint.index()].translation);
        let color = Color::from_hex(VIOLET);
        let points = [arm.origin.as_vec3(), ends[0], ends[1]];
        scene.polylines.push(Polyline {
            points: points.map(|point| (point, color)).to_vec(),
            width: 2.4,
            opacity: 1.0,
        });
    }
}

fn add_ellipsoid(scene: &mut Scene, bench: &Bench, size: f32) {
    let mobility = bench.mobility();
    if mobility.singular_values.is_empty() {
        return;
    }
    let mut axes = mobility
        .ellipsoid
        .map(|axis| (axis * ELLIPSOID_SECS).as_vec3());
    let longest = axes.iter().map(|axis| axis.length()).fold(0.0, f32::max);
    if longest <= 0.0 || !longest.is_finite() {
        return;
    }
    let shrink = (ELLIPSOID_LARGEST * size / longest).min(1.0);
    let thinnest = ELLIPSOID_THINNEST * size;
    let first = axes[0].normalize_or(Vec3::X);
    let second =
        (axes[1] - first * axes[1].dot(first)).normalize_or(first.any_orthonormal_vector());
    let directions = [first, second, first.cross(second)];
    for (axis, direction) in axes.iter_mut().zip(directions) {
        *axis = direction * (axis.length() * shrink).max(thinnest);
    }
    let middle = bench.tip_frame().position.as_vec3();
    let shape = Shape::ellipsoid(middle, Mat3::from_cols(axes[0], axes[1], axes[2]), 40);
    let mut mesh = Mesh::default();
    mesh.add(&shape, 0, MaterialId::Base);
    let color = Color::from_hex(VIOLET);
    scene.models.push(Model {
        mesh: Arc::new(mesh),
        joints: vec![Affine3::IDENTITY],
        palette: [color; MATERIAL_COUNT],
        opacity: 0.25,
        shadow: Shadow::None,
    });
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let point = |corner: usize| {
            #[expect(clippy::cast_precision_loss, reason = "a small number")]
            let turn = std::f32::consts::TAU * corner as f32 / 64.0;
            let (sin, cos) = libm::sincosf(turn);
            (middle + axes[a] * cos + axes[b] * sin, color)
        };
        scene.polylines.push(Polyline {
            points: (0..=64).map(point).collect(),
            width: 1.3,
            opacity: 1.0,
        });
    }
}

fn add_frames(scene: &mut Scene, bench: &Bench, size: f32) {
    let colors = [RED, GREEN, BLUE].map(Color::from_hex);
    for joint in bench.robot().path_to(bench.tip()) {
        let frame = bench.frames()[joint.index()];
        let is_tip = joint == bench.tip();
        let length = AXIS_LENGTH * size * if is_tip { 1.3 } else { 1.0 };
        let middle = frame.position.as_vec3();
        for (axis, color) in Vec3::AXES.into_iter().zip(colors) {
            let end = middle + frame.orientation.as_quat() * axis * length;
            scene.polylines.push(Polyline {
                points: vec![(middle, color), (end, color)],
                width: if is_tip { 3.2 } else { 2.2 },
                opacity: 1.0,
            });
        }
    }
}

fn add_names(scene: &mut Scene, bench: &Bench, theme: &Theme) {
    let robot = bench.robot();
    let skeleton = robot.mechanism.skeleton();
    for joint in skeleton.joints() {
        let is_mounted = skeleton.parent(joint).is_some();
        if is_mounted {
            scene.labels.push(Label {
                position: bench.frames()[joint.index()].position.as_vec3(),
                text: robot.joint_name(joint).to_owned(),
                color: theme.text,
                size: 15.0,
            });
        }
    }
}
