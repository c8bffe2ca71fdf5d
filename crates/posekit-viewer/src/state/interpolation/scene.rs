//! The lab's view as a scene: start, end, and what the methods make of the way between them.

use glam::{DVec3, Vec3};
use posekit::inbetween::Method;
use posekit::rotation::matrix_from_quat;
use posekit_render::camera::Camera;
use posekit_render::color::Color;
use posekit_render::grid::LengthUnit;
use posekit_render::scene::{Polyline, Scene};
use posekit_render::stage::Room;
use posekit_render::theme::Theme;

use super::body::{self, Look as BodyLook};
use super::colors::color_of;
use super::{InterpolationLab, Layout, Picture, Way};
use crate::state::display::Look;

/// Start and end are in no method's colour.
const END_COLOR: u32 = 0xD9_D5_CC;

/// A body fills so much of the reach of its place.
const FILLS: f32 = 0.94;

/// Lines of a globe: circles of latitude, and meridians.
const LATITUDES: [f32; 5] = [-60.0, -30.0, 0.0, 30.0, 60.0];
const MERIDIANS: u8 = 6;

/// Paths lie a little over the sphere.
const OVER: f32 = 1.006;

/// The scene now.
#[must_use]
pub(super) fn scene(lab: &InterpolationLab, look: Look) -> Scene {
    let theme = match look {
        Look::Light => Theme::light(),
        Look::Dark => Theme::dark(),
    };
    let camera = lab.view_camera();
    let layout = lab.layout();
    let point = layout.length_of_point(&camera);
    let room = Room {
        theme,
        size: 200.0 * point,
        ground_height: 0.0,
        focus: Vec3::ZERO,
        radius: 1.0,
        unit: LengthUnit::Metre,
        yaw_from_above_rad: lab.camera.still().yaw_rad,
    };
    let mut scene = room.scene(camera);
    scene.ground = None;
    scene.captions.clear();
    let mut stage = Stage {
        scene: &mut scene,
        layout: &layout,
        camera,
        theme,
        point,
    };
    stage.add_ends(lab);
    match lab.picture() {
        Picture::SideBySide => stage.add_grid(lab),
        Picture::Overlaid => stage.add_overlaid(lab),
        Picture::Sphere => stage.add_sphere(lab),
    }
    scene
}

/// Where the tip of an end's axis is on the sphere.
#[must_use]
pub(super) fn tip_on_sphere(lab: &InterpolationLab, end: usize) -> Vec3 {
    let (camera, layout) = (lab.view_camera(), lab.layout());
    let cell = layout.cells.first().copied();
    let cell = cell.unwrap_or(layout.ends[0]);
    let middle = layout.world(&camera, Layout::body_place(cell));
    let radius = FILLS * Layout::body_reach(cell) * layout.length_of_point(&camera);
    let turned = lab.case().rotation(lab.ends()[end]) * lab.tip_in_body();
    middle + turned.as_vec3() * (radius * OVER)
}

/// A scene that is being set.
struct Stage<'a> {
    scene: &'a mut Scene,
    layout: &'a Layout,
    camera: Camera,
    theme: Theme,
    /// World length of a point of the screen.
    point: f32,
}

impl Stage<'_> {
    fn middle_and_size(&self, cell: egui::Rect) -> (Vec3, f32) {
        let middle = self.layout.world(&self.camera, Layout::body_place(cell));
        (middle, FILLS * Layout::body_reach(cell) * self.point)
    }

    fn add_ends(&mut self, lab: &InterpolationLab) {
        for (rect, key) in self.layout.ends.into_iter().zip(lab.ends()) {
            let middle = self.layout.world(&self.camera, rect.center());
            let size = 0.62 * (0.5 * rect.width().min(rect.height())) * self.point;
            let turned = matrix_from_quat(lab.case().rotation(key));
            let look = BodyLook {
                color: Color::from_hex(END_COLOR),
                opacity: 1.0,
            };
            self.scene
                .models
                .push(body::model(&turned, middle, size, look));
        }
    }

    fn add_grid(&mut self, lab: &InterpolationLab) {
        for (method, &cell) in lab.shown().zip(&self.layout.cells) {
            let (middle, size) = self.middle_and_size(cell);
            let now = lab.now(method);
            let look = BodyLook {
                color: color_of(method),
                opacity: 1.0,
            };
            let map = now.blend.matrix;
            self.scene
                .models
                .push(body::model(&map, middle, size, look));
            if !method.makes_rotations() {
                // The box that it should be, around the one that it is.
                let rigid = matrix_from_quat(now.rotation);
                let color = body::faint(self.theme.text, &self.theme, 0.35);
                self.scene
                    .polylines
                    .extend(body::edges(&rigid, middle, size, color, 1.3));
                self.scene
                    .polylines
                    .extend(body::edges(&map, middle, size, color_of(method), 2.0));
            }
        }
    }

    fn add_overlaid(&mut self, lab: &InterpolationLab) {
        let Some(&cell) = self.layout.cells.first() else {
            return;
        };
        let (middle, size) = self.middle_and_size(cell);
        // Solid bodies would hide each other: slerp's is half there, the others are boxes of lines.
        let slerp = matrix_from_quat(lab.now(Method::Slerp).rotation);
        let look = BodyLook {
            color: body::faint(color_of(Method::Slerp), &self.theme, 0.45),
            opacity: 0.5,
        };
        self.scene
            .models
            .push(body::model(&slerp, middle, size, look));
        for method in lab.shown() {
            let map = lab.now(method).blend.matrix;
            let color = color_of(method);
            self.scene
                .polylines
                .extend(body::edges(&map, middle, size, color, 1.8));
            // Where it faces, and where its crown is.
            for (axis, width, ball) in [(DVec3::Z, 4.5, 0.05), (DVec3::Y, 2.2, 0.03)] {
                let tip = middle + (map * axis).as_vec3() * size;
                self.line(&[middle, tip], color, width);
                let dot = body::ball(tip, ball * size, color, 1.0, 12);
                self.scene.models.push(dot);
            }
        }
    }

    fn add_sphere(&mut self, lab: &InterpolationLab) {
        let Some(&cell) = self.layout.cells.first() else {
            return;
        };
        let (middle, radius) = self.middle_and_size(cell);
        let ground = self.theme.ground;
        self.scene
            .models
            .push(body::ball(middle, radius, ground, 0.5, 64));
        self.add_globe(middle, radius);
        let tip = lab.tip_in_body();
        for way in lab.ways() {
            self.add_path(way, tip, middle, radius);
        }
        for method in lab.shown() {
            let now = lab.now(method);
            let color = color_of(method);
            let at = middle + (now.rotation * tip).as_vec3() * radius * OVER;
            let dot = body::ball(at, 0.028 * radius, color, 1.0, 14);
            self.scene.models.push(dot);
            if !method.makes_rotations() {
                let own = middle + (now.blend.matrix * tip).as_vec3() * radius;
                let dot = body::ball(own, 0.018 * radius, color, 1.0, 10);
                self.scene.models.push(dot);
                self.line(&[at, own], color, 1.2);
            }
        }
        for key in lab.ends() {
            let turned = lab.case().rotation(key) * tip;
            let at = middle + turned.as_vec3() * radius * OVER;
            let dot = body::ball(at, 0.036 * radius, Color::from_hex(END_COLOR), 1.0, 16);
            self.scene.models.push(dot);
        }
        // The world's axes, for where is up.
        let faint = body::faint(self.theme.text, &self.theme, 0.55);
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let axis = axis.as_vec3();
            self.line(
                &[middle + axis * radius, middle + axis * (1.04 * radius)],
                faint,
                2.0,
            );
        }
    }

    fn add_path(&mut self, way: &Way, tip: DVec3, middle: Vec3, radius: f32) {
        let color = color_of(way.kind);
        let lifted = |tips: Vec<DVec3>, over: f32| -> Vec<Vec3> {
            tips.into_iter()
                .map(|tip| middle + tip.as_vec3() * radius * over)
                .collect()
        };
        self.line(&lifted(way.tips(tip), OVER), color, 3.0);
        if !way.kind.makes_rotations() {
            self.line(&lifted(way.raw_tips(tip), 1.0), color, 1.4);
        }
    }

    fn add_globe(&mut self, middle: Vec3, radius: f32) {
        let color = self.theme.grid_line;
        let circle = |center: Vec3, a: Vec3, b: Vec3| -> Vec<Vec3> {
            (0..=72_u8)
                .map(|step| {
                    let turn = std::f32::consts::TAU * f32::from(step) / 72.0;
                    let (sin, cos) = libm::sincosf(turn);
                    center + a * cos + b * sin
                })
                .collect()
        };
        for latitude in LATITUDES {
            let (sin, cos) = libm::sincosf(latitude.to_radians());
            let ring = circle(
                middle + Vec3::Y * (radius * sin),
                Vec3::X * (radius * cos),
                Vec3::Z * (radius * cos),
            );
            self.line(&ring, color, 1.0);
        }
        for meridian in 0..MERIDIANS {
            let turn = std::f32::consts::PI * f32::from(meridian) / f32::from(MERIDIANS);
            let (sin, cos) = libm::sincosf(turn);
            let across = Vec3::new(cos, 0.0, sin) * radius;
            self.line(&circle(middle, across, Vec3::Y * radius), color, 1.0);
        }
    }

    fn line(&mut self, points: &[Vec3], color: Color, width: f32) {
        self.scene.polylines.push(Polyline {
            points: points.iter().map(|&point| (point, color)).collect(),
            width,
            opacity: 1.0,
        });
    }
}
