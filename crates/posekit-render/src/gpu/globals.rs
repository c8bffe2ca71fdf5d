//! The uniform buffer: everything about a picture but its meshes.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};

use crate::camera::Projection;
use crate::color::Color;
use crate::scene::{Background, Ground, Scene};
use crate::shading::shadow_disc;
use crate::shadow_frame::{MAP_SIZE, ShadowFrame};

/// As `Globals` in the shader, which says what the fields mean.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Globals {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 4],
    back: [f32; 4],
    shadow_rows: [[f32; 4]; 3],
    shadow: [f32; 4],
    key_direction: [f32; 4],
    key: [f32; 4],
    fill_direction: [f32; 4],
    fill: [f32; 4],
    sky: [f32; 4],
    bounce: [f32; 4],
    top: [f32; 4],
    bottom: [f32; 4],
    ground: [f32; 4],
    line: [f32; 4],
    axis_x: [f32; 4],
    axis_z: [f32; 4],
    focus: [f32; 4],
    disc: [[f32; 4]; 16],
}

/// The ground as it is drawn: not from below.
pub(super) fn visible_ground(scene: &Scene) -> Option<&Ground> {
    scene
        .ground
        .as_ref()
        .filter(|g| scene.camera.eye.y > g.height)
}

impl Globals {
    pub(super) fn new(
        scene: &Scene,
        (width, height): (u32, u32),
        frame: Option<&ShadowFrame>,
        target_encodes: bool,
    ) -> Self {
        let camera = &scene.camera;
        let lighting = &scene.lighting;
        let (_, _, back) = camera.axes();
        let clip: Mat4 = camera.clip_from_world(width as f32 / height as f32);
        let is_lens = matches!(camera.projection, Projection::Perspective { .. });
        let (top, bottom) = match scene.background {
            Background::Gradient { top, bottom } => (top, bottom),
            Background::Transparent => (Color::default(), Color::default()),
        };
        let flag = |on: bool| if on { 1.0 } else { 0.0 };
        let encodes = flag(target_encodes);
        let mut globals = Self {
            clip_from_world: clip.to_cols_array_2d(),
            eye: with(camera.eye, flag(is_lens)),
            back: with(back, 0.0),
            key_direction: with(lighting.key_direction, lighting.shadow_strength),
            key: linear(lighting.key, lighting.contact_strength),
            fill_direction: with(lighting.fill_direction, 0.0),
            fill: linear(lighting.fill, 0.0),
            sky: linear(lighting.sky, 0.0),
            bounce: linear(lighting.bounce, 0.0),
            top: encoded(top, height as f32),
            bottom: encoded(bottom, encodes),
            ..Self::zeroed()
        };
        if let Some(ground) = &scene.ground {
            globals.set_ground(ground);
        }
        globals.set_shadow(frame, lighting.shadow_softness);
        globals
    }

    fn set_ground(&mut self, ground: &Ground) {
        let spacing = ground.grid_spacing;
        self.ground = encoded(ground.color, ground.radius);
        self.line = encoded(ground.line_color, spacing);
        self.axis_x = encoded(ground.axis_colors[0], spacing * ground.major_every as f32);
        self.axis_z = encoded(ground.axis_colors[1], 1.0);
        self.focus = [ground.focus.x, ground.height, ground.focus.z, 0.0];
    }

    fn set_shadow(&mut self, frame: Option<&ShadowFrame>, softness: f32) {
        self.shadow = [0.0, 0.0, 0.0, softness];
        if let Some(frame) = frame {
            let scales = [frame.side, frame.side, frame.depth];
            for (row, axis) in frame.axes.iter().enumerate() {
                let scale = 1.0 / scales[row];
                self.shadow_rows[row] = with(*axis * scale, -frame.origin[row] * scale);
            }
            self.shadow = [
                MAP_SIZE as f32 / frame.side,
                1.0 / frame.depth,
                1.0,
                softness,
            ];
        }
        for (pair, taps) in self.disc.iter_mut().zip(shadow_disc().chunks_exact(2)) {
            *pair = [taps[0].0, taps[0].1, taps[1].0, taps[1].1];
        }
    }
}

fn with(v: Vec3, w: f32) -> [f32; 4] {
    [v.x, v.y, v.z, w]
}

fn linear(color: Color, w: f32) -> [f32; 4] {
    [color.r, color.g, color.b, w]
}

fn encoded(color: Color, w: f32) -> [f32; 4] {
    let [r, g, b] = color.to_srgb();
    [r, g, b, w]
}
