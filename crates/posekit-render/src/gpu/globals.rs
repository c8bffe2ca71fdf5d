//! The uniform buffer: everything about a picture but its meshes.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};

use crate::camera::Projection;
use crate::color::Color;
use crate::scene::{Background, Ground, MOST_LAMPS, Scene};
use crate::shading::shadow_disc;
use crate::shadow_frame::{MAP_SIZE, Rays, ShadowFrame};

/// As `Globals` in the shader, which says what the fields mean.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Globals {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 4],
    back: [f32; 4],
    shadow_rows: [[f32; 4]; 4],
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
    lamps: [[f32; 4]; 2 * MOST_LAMPS],
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
        let lamps = scene.drawn_lamps();
        let flag = |on: bool| if on { 1.0 } else { 0.0 };
        let encodes = flag(target_encodes);
        let summing = match (scene.is_lit(), scene.casting_lamp()) {
            (false, _) => 0.0,
            (true, None) => 1.0,
            (true, Some(_)) => 2.0,
        };
        let mut globals = Self {
            clip_from_world: clip.to_cols_array_2d(),
            eye: with(camera.eye, flag(is_lens)),
            back: with(back, 0.0),
            key_direction: with(lighting.key_direction, lighting.shadow_strength),
            key: linear(lighting.key, lighting.contact_strength),
            fill_direction: with(lighting.fill_direction, lamps.len() as f32),
            fill: linear(lighting.fill, lighting.ground_ambient),
            sky: linear(lighting.sky, lighting.exposure),
            bounce: linear(lighting.bounce, summing),
            top: encoded(top, height as f32),
            bottom: encoded(bottom, encodes),
            ..Self::zeroed()
        };
        if let Some(ground) = &scene.ground {
            globals.set_ground(ground);
        }
        globals.set_shadow(frame, lighting.shadow_softness);
        for (pair, lamp) in globals.lamps.chunks_exact_mut(2).zip(lamps) {
            pair[0] = with(lamp.position, lamp.full_at * lamp.full_at);
            pair[1] = linear(lamp.color, 0.0);
        }
        globals
    }

    fn set_ground(&mut self, ground: &Ground) {
        let spacing = ground.grid_spacing;
        self.ground = encoded(ground.color, ground.radius);
        self.line = encoded(ground.line_color, spacing);
        self.axis_x = encoded(ground.axis_colors[0], spacing * ground.major_every as f32);
        self.axis_z = encoded(ground.axis_colors[1], 1.0);
        let Color { r, g, b } = ground.color;
        let brightness = r.max(g).max(b);
        self.focus = [ground.focus.x, ground.height, ground.focus.z, brightness];
    }

    fn set_shadow(&mut self, frame: Option<&ShadowFrame>, softness: f32) {
        self.shadow = [0.0, 0.0, 0.0, softness];
        if let Some(frame) = frame {
            self.shadow_rows = match frame.rays {
                Rays::Parallel => parallel_rows(frame),
                Rays::FromLamp => lens_rows(frame),
            };
            let is_lens = frame.rays == Rays::FromLamp;
            self.back[3] = if is_lens { 1.0 } else { 0.0 };
            let depth_per_length = if is_lens { 0.0 } else { 1.0 / frame.depth };
            let texels_per_length = MAP_SIZE as f32 / frame.side;
            self.shadow = [texels_per_length, depth_per_length, 1.0, softness];
        }
        for (pair, taps) in self.disc.iter_mut().zip(shadow_disc().chunks_exact(2)) {
            *pair = [taps[0].0, taps[0].1, taps[1].0, taps[1].1];
        }
    }
}

/// Map coordinates and depth of a world point; the last row gives 1.
fn parallel_rows(frame: &ShadowFrame) -> [[f32; 4]; 4] {
    let scales = [frame.side, frame.side, frame.depth];
    let row = |i: usize| {
        let scale = 1.0 / scales[i];
        with(frame.axes[i] * scale, -frame.origin[i] * scale)
    };
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}

/// The same, to be divided by the last row: the distance in front of the lens.
fn lens_rows(frame: &ShadowFrame) -> [[f32; 4]; 4] {
    let row = |axis: Vec3, scale: f32| with(axis * scale, -axis.dot(frame.origin) * scale);
    let [across, along, back] = frame.axes;
    let distance = row(back, -1.0);
    let half_a_map = |axis: Vec3| {
        let row = row(axis, 1.0 / frame.side);
        std::array::from_fn(|k| row[k] + 0.5 * distance[k])
    };
    let depth = [0.0, 0.0, 0.0, frame.depth];
    [half_a_map(across), half_a_map(along), depth, distance]
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
