//! Solids of machines: boxes and flat rings. Drums are with the other turned shapes.

use glam::Vec3;

use super::Shape;

/// An edge is not cut off by more than this share of the thinnest side's half.
const DEEPEST_BEVEL: f32 = 0.45;

/// A side of no length is drawn this thin, as a share of the longest.
const THINNEST: f32 = 1e-4;

impl Shape {
    /// A box around the origin with half sides `half`, its edges cut off by `bevel` and shaded as if
    /// they were round. A negative or zero bevel leaves them sharp.
    #[must_use]
    pub fn cuboid(half: Vec3, bevel: f32) -> Self {
        let half = half.abs();
        let half = half.max(Vec3::splat(THINNEST * half.max_element()));
        let bevel = bevel.clamp(0.0, DEEPEST_BEVEL * half.min_element());
        let mut shape = Self::default();
        for corner in 0..8_usize {
            for axis in 0..3 {
                let mut position = Vec3::ZERO;
                for along in 0..3 {
                    let cut = if along == axis { 0.0 } else { bevel };
                    position[along] = sign(corner, along) * (half[along] - cut);
                }
                shape.positions.push(position);
                shape.normals.push(Vec3::AXES[axis] * sign(corner, axis));
            }
        }
        for axis in 0..3 {
            let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
            let corner =
                |a: usize, at_b: usize, at_c: usize| (a << axis) | (at_b << b) | (at_c << c);
            for side in 0..2 {
                let ring = [(0, 0), (1, 0), (1, 1), (0, 1)];
                shape.outward_quad(ring.map(|(at_b, at_c)| 3 * corner(side, at_b, at_c) + axis));
            }
            if bevel <= 0.0 {
                continue;
            }
            for (at_b, at_c) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let [near, far] = [corner(0, at_b, at_c), corner(1, at_b, at_c)];
                shape.outward_quad([3 * near + b, 3 * far + b, 3 * far + c, 3 * near + c]);
            }
        }
        if bevel > 0.0 {
            for corner in 0..8 {
                shape.outward_triangle([3 * corner, 3 * corner + 1, 3 * corner + 2]);
            }
        }
        shape
    }

    /// A flat ring around the origin, across Z, of a certain thickness, with two faces and no rims:
    /// for areas that are marked. An inner radius of zero gives a disc.
    #[must_use]
    pub fn annulus(inner: f32, outer: f32, thickness: f32, segments: usize) -> Self {
        let segments = segments.max(6);
        let mut shape = Self::default();
        for side in [1.0, -1.0] {
            let first = shape.positions.len();
            for step in 0..segments {
                let turn = std::f32::consts::TAU * step as f32 / segments as f32;
                let (sin, cos) = libm::sincosf(turn);
                for radius in [inner, outer] {
                    let at = Vec3::new(cos * radius, sin * radius, 0.5 * thickness * side);
                    shape.positions.push(at);
                    shape.normals.push(Vec3::Z * side);
                }
            }
            for step in 0..segments {
                let (a, b) = (first + 2 * step, first + 2 * ((step + 1) % segments));
                let quad = if side > 0.0 {
                    [a, a + 1, b + 1, b]
                } else {
                    [a, b, b + 1, a + 1]
                };
                shape.push([quad[0], quad[1], quad[2]]);
                shape.push([quad[0], quad[2], quad[3]]);
            }
        }
        shape
    }

    fn outward_quad(&mut self, [a, b, c, d]: [usize; 4]) {
        self.outward_triangle([a, b, c]);
        self.outward_triangle([a, c, d]);
    }

    /// A triangle of a convex shape around the origin, turned so that it is seen from outside.
    fn outward_triangle(&mut self, [a, b, c]: [usize; 3]) {
        let [p, q, r] = [a, b, c].map(|index| self.positions[index]);
        let faces_out = (q - p).cross(r - p).dot(p + q + r) >= 0.0;
        self.push(if faces_out { [a, b, c] } else { [a, c, b] });
    }

    fn push(&mut self, corners: [usize; 3]) {
        let index = |corner: usize| u32::try_from(corner).unwrap_or(u32::MAX);
        self.triangles.push(corners.map(index));
    }
}

/// On which side of an axis a corner of a box is.
fn sign(corner: usize, axis: usize) -> f32 {
    if (corner >> axis) & 1 == 1 { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(shape: &Shape) -> f32 {
        let corner = |index: u32| shape.positions[index as usize];
        let six = shape
            .triangles
            .iter()
            .map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))));
        six.sum::<f32>() / 6.0
    }

    #[test]
    fn a_box_has_its_volume_and_is_closed() {
        let half = Vec3::new(0.5, 0.2, 0.1);
        assert!((volume(&Shape::cuboid(half, 0.0)) - 0.08).abs() < 1e-6);
        let round = Shape::cuboid(half, 0.02);
        // Twelve cut edges of half a square each, less what they share at the corners.
        let cut = volume(&Shape::cuboid(half, 0.0)) - volume(&round);
        assert!(
            cut > 0.0 && cut < 4.0 * (1.0 + 0.4 + 0.2) * 0.5 * 0.02 * 0.02,
            "{cut}"
        );
        let mut edges = std::collections::BTreeMap::new();
        let key = |index: u32| round.positions[index as usize].to_array().map(f32::to_bits);
        for t in &round.triangles {
            for i in 0..3 {
                *edges.entry((key(t[i]), key(t[(i + 1) % 3]))).or_insert(0) += 1;
            }
        }
        for (&(a, b), &count) in &edges {
            assert_eq!(edges.get(&(b, a)), Some(&count), "every edge has two sides");
        }
    }

    #[test]
    fn a_flat_box_is_still_a_box() {
        let flat = Shape::cuboid(Vec3::new(1.0, 0.0, 1.0), 0.1);
        assert!(flat.positions.iter().all(|p| p.is_finite()));
        assert!(volume(&flat) > 0.0);
    }

    #[test]
    fn both_faces_of_a_ring_face_outwards() {
        let ring = Shape::annulus(0.5, 1.0, 0.01, 24);
        let corner = |index: u32| ring.positions[index as usize];
        for &[a, b, c] in &ring.triangles {
            let normal = (corner(b) - corner(a)).cross(corner(c) - corner(a));
            assert!(normal.dot(ring.normals[a as usize]) > 0.0);
        }
    }
}
