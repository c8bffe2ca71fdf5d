//! Lines of constant width on the screen, as triangles that face the camera.

use glam::Vec3;

use crate::camera::{Camera, Projection};
use crate::color::Color;
use crate::scene::{Polyline, REFERENCE_HEIGHT_PX};

/// Passes on the triangles of a polyline, world space, of either winding: a quad a segment, and a
/// little disc at each point, which makes round joins and ends without mitres.
pub(crate) fn triangulate(
    line: &Polyline,
    camera: &Camera,
    picture_height_px: f32,
    mut emit: impl FnMut([(Vec3, Color); 3]),
) {
    // Thinner than this and a line falls between the samples.
    let half_px = (line.width * picture_height_px / REFERENCE_HEIGHT_PX).max(1.25) * 0.5;
    let (right, up, back) = camera.axes();
    let half_at = |p: Vec3| camera.pixel_size_at(p, picture_height_px) * half_px;
    for pair in line.points.windows(2) {
        let ((a, color_a), (b, color_b)) = (pair[0], pair[1]);
        let view = match camera.projection {
            Projection::Perspective { .. } => a - camera.eye,
            Projection::Orthographic { .. } => -back,
        };
        let side = (b - a).cross(view).normalize_or_zero();
        if side == Vec3::ZERO {
            continue;
        }
        let (wide_a, wide_b) = (side * half_at(a), side * half_at(b));
        let corners = [
            (a - wide_a, color_a),
            (a + wide_a, color_a),
            (b + wide_b, color_b),
            (b - wide_b, color_b),
        ];
        emit([corners[0], corners[1], corners[2]]);
        emit([corners[0], corners[2], corners[3]]);
    }
    // On a hairline nobody sees the joins.
    if half_px < 1.0 {
        return;
    }
    for &(p, color) in &line.points {
        let half = half_at(p);
        let rim = DISC.map(|(x, y)| (p + (right * x + up * y) * half, color));
        for k in 1..7 {
            emit([rim[0], rim[k], rim[k + 1]]);
        }
    }
}

/// The corners of a regular octagon: at these widths no one sees the difference to a circle.
const DISC: [(f32, f32); 8] = {
    const D: f32 = std::f32::consts::FRAC_1_SQRT_2;
    [
        (1.0, 0.0),
        (D, D),
        (0.0, 1.0),
        (-D, D),
        (-1.0, 0.0),
        (-D, -D),
        (0.0, -1.0),
        (D, -D),
    ]
};
