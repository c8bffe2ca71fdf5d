//! The body whose orientation is read at a glance: a head with a nose, eyes and coloured axes.
//!
//! It faces +Z with +Y up, and reaches as far as 1 from its middle.

use std::sync::Arc;
use std::sync::LazyLock;

use glam::{Affine3, DMat3, Mat3, Vec3};
use posekit_render::color::Color;
use posekit_render::mesh::{MATERIAL_COUNT, MaterialId, Mesh, Shape};
use posekit_render::scene::{Model, Polyline, Shadow};
use posekit_render::theme::Theme;

/// Half the head's box.
pub const HALF: Vec3 = Vec3::new(0.42, 0.50, 0.45);

const RED: u32 = 0xD9_58_4F;
const GREEN: u32 = 0x4E_A2_5A;
const BLUE: u32 = 0x4B_86_DB;
const DARK: u32 = 0x22_27_30;

/// The parts, each with its material.
static PARTS: LazyLock<Vec<(Shape, MaterialId)>> = LazyLock::new(|| {
    let mut parts = vec![
        (Shape::cuboid(HALF, 0.09), MaterialId::Base),
        (
            Shape::tapered_capsule(
                Vec3::new(0.0, 0.02, HALF.z),
                0.09,
                Vec3::new(0.0, -0.06, HALF.z + 0.16),
                0.07,
                12,
            ),
            MaterialId::Base,
        ),
        (
            Shape::cuboid(Vec3::new(0.17, 0.03, 0.03), 0.01)
                .mapped(Mat3::IDENTITY, Vec3::new(0.0, -0.27, HALF.z)),
            MaterialId::Accent,
        ),
    ];
    for side in [-1.0, 1.0] {
        let eye = Vec3::new(0.18 * side, 0.19, HALF.z);
        parts.push((Shape::ball(eye, 0.075, 12), MaterialId::Accent));
    }
    for (axis, material) in [
        (Vec3::X, MaterialId::AxisX),
        (Vec3::Y, MaterialId::AxisY),
        (Vec3::Z, MaterialId::AxisZ),
    ] {
        let rod = Shape::tapered_capsule(Vec3::ZERO, 0.035, axis * 0.90, 0.035, 10);
        parts.push((rod, material));
        let tip = Shape::turned(axis * 0.80, axis * 1.0, &[0.085, 0.05, 0.0], 12);
        parts.push((tip, material));
    }
    parts
});

static MESH: LazyLock<Arc<Mesh>> = LazyLock::new(|| {
    let mut mesh = Mesh::default();
    for (shape, material) in PARTS.iter() {
        mesh.add(shape, 0, *material);
    }
    Arc::new(mesh)
});

/// How a body is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The colour of its head.
    pub color: Color,
    /// Its opacity, in steps of a quarter.
    pub opacity: f32,
}

fn palette(color: Color) -> [Color; MATERIAL_COUNT] {
    let mut palette = [color; MATERIAL_COUNT];
    palette[MaterialId::Accent as usize] = Color::from_hex(DARK);
    palette[MaterialId::AxisX as usize] = Color::from_hex(RED);
    palette[MaterialId::AxisY as usize] = Color::from_hex(GREEN);
    palette[MaterialId::AxisZ as usize] = Color::from_hex(BLUE);
    palette
}

/// A body under a linear map, which need be no rotation: shears and scales are drawn as they are.
#[must_use]
pub fn model(map: &DMat3, middle: Vec3, size: f32, look: Look) -> Model {
    let linear = map.as_mat3();
    let is_rotation = (map.determinant() - 1.0).abs() < 1e-6
        && (map.transpose() * *map).abs_diff_eq(DMat3::IDENTITY, 1e-6);
    // The renderers turn normals as they turn points, which a shear does not.
    let (mesh, matrix3) = if is_rotation {
        (Arc::clone(&MESH), linear * size)
    } else {
        let mut mesh = Mesh::default();
        for (shape, material) in PARTS.iter() {
            mesh.add(&shape.clone().mapped(linear, Vec3::ZERO), 0, *material);
        }
        (Arc::new(mesh), Mat3::from_diagonal(Vec3::splat(size)))
    };
    Model {
        mesh,
        joints: vec![Affine3 {
            matrix3,
            translation: middle,
        }],
        palette: palette(look.color),
        opacity: look.opacity,
        shadow: Shadow::None,
    }
}

/// The twelve edges of the head's box under a linear map.
#[must_use]
pub fn edges(map: &DMat3, middle: Vec3, size: f32, color: Color, width: f32) -> Vec<Polyline> {
    let linear = map.as_mat3();
    let corner = |signs: [f32; 3]| {
        let grown = HALF * 1.02 * Vec3::from_array(signs);
        (middle + linear * grown * size, color)
    };
    let mut lines = Vec::with_capacity(12);
    for axis in 0..3 {
        for (a, b) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let mut signs = [a; 3];
            signs[(axis + 2) % 3] = b;
            let end = |along: f32| {
                let mut signs = signs;
                signs[axis] = along;
                corner(signs)
            };
            lines.push(Polyline {
                points: vec![end(-1.0), end(1.0)],
                width,
                opacity: 1.0,
            });
        }
    }
    lines
}

/// A ball.
#[must_use]
pub fn ball(middle: Vec3, radius: f32, color: Color, opacity: f32, segments: usize) -> Model {
    let mut mesh = Mesh::default();
    mesh.add(
        &Shape::ball(Vec3::ZERO, radius, segments),
        0,
        MaterialId::Base,
    );
    Model {
        mesh: Arc::new(mesh),
        joints: vec![Affine3::from_translation(middle)],
        palette: [color; MATERIAL_COUNT],
        opacity,
        shadow: Shadow::None,
    }
}

/// Colours that lie between a colour and the room's.
#[must_use]
pub fn faint(color: Color, theme: &Theme, amount: f32) -> Color {
    color.mix(theme.background_bottom, amount)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shear_is_in_the_mesh_and_a_rotation_in_the_transform() {
        let look = Look {
            color: Color::from_hex(0xFF_FF_FF),
            opacity: 1.0,
        };
        let turned = DMat3::from_rotation_y(0.7);
        let rigid = model(&turned, Vec3::ZERO, 2.0, look);
        assert!(Arc::ptr_eq(&rigid.mesh, &MESH));
        let sheared = DMat3::from_cols(
            glam::DVec3::X,
            glam::DVec3::new(0.5, 1.0, 0.0),
            glam::DVec3::Z,
        );
        let bent = model(&sheared, Vec3::ZERO, 2.0, look);
        let expected = sheared.as_mat3() * MESH.vertices[5].position;
        assert!(bent.mesh.vertices[5].position.abs_diff_eq(expected, 1e-6));
        let normals = bent
            .mesh
            .vertices
            .iter()
            .map(|vertex| vertex.normal.length());
        assert!(
            normals
                .into_iter()
                .all(|length| (length - 1.0).abs() < 1e-3)
        );
        assert_eq!(edges(&turned, Vec3::ZERO, 1.0, look.color, 1.0).len(), 12);
    }
}
