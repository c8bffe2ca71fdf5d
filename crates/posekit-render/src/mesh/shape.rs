//! Closed rounded shapes: balls, tapered capsules, lofts, octahedral bones.
//!
//! All are built as rings of vertices along an axis (a loft), which gives even triangles, shared
//! vertices and smooth normals. Trigonometry is by `libm`, so a shape is the same on every machine.

use glam::{Mat3, Vec3};

/// A closed triangle mesh without joints or materials.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Unit normals, one a vertex.
    pub normals: Vec<Vec3>,
    /// Counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// One cross-section of a loft: a superellipse in a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoftRing {
    /// The middle of the cross-section.
    pub center: Vec3,
    /// Half extent along the loft's side direction.
    pub half_side: f32,
    /// Half extent along the loft's front direction.
    pub half_front: f32,
}

const TAU: f32 = std::f32::consts::TAU;
const HALF_PI: f32 = std::f32::consts::FRAC_PI_2;

impl Shape {
    /// A ball of `radius` around `center` in `segments` slices (at least 6).
    #[must_use]
    pub fn ball(center: Vec3, radius: f32, segments: usize) -> Self {
        Self::ellipsoid(center, Mat3::from_diagonal(Vec3::splat(radius)), segments)
    }

    /// The unit ball under the linear map `axes` (its columns are the half axes), around `center`.
    #[must_use]
    pub fn ellipsoid(center: Vec3, axes: Mat3, segments: usize) -> Self {
        let stacks = (segments / 2).max(4);
        let profile: Vec<_> = (0..=stacks)
            .map(|i| {
                let (sin, cos) = libm::sincosf(TAU * 0.5 * i as f32 / stacks as f32);
                ProfilePoint {
                    along: -cos,
                    radius: sin,
                    normal_along: -cos,
                    normal_out: sin,
                }
            })
            .collect();
        let unit = Self::revolve(&profile, segments);
        unit.mapped(axes, center)
    }

    /// The convex hull of two balls: a capsule whose radius goes from `start_radius` at `start` to
    /// `end_radius` at `end`. One ball inside the other gives the larger ball.
    #[must_use]
    pub fn tapered_capsule(
        start: Vec3,
        start_radius: f32,
        end: Vec3,
        end_radius: f32,
        segments: usize,
    ) -> Self {
        let axis = end - start;
        let length = axis.length();
        if length.is_nan() || length <= (start_radius - end_radius).abs() * 1.001 {
            return if start_radius >= end_radius {
                Self::ball(start, start_radius, segments)
            } else {
                Self::ball(end, end_radius, segments)
            };
        }
        // The cone touches both balls where the normal leans by this much along the axis.
        let lean = (start_radius - end_radius) / length;
        let lean_angle = libm::asinf(lean);
        let cap_stacks = (segments / 4).max(3);
        let mut profile = Vec::with_capacity(2 * cap_stacks + 2);
        for i in 0..=cap_stacks {
            let angle = -HALF_PI + (lean_angle + HALF_PI) * i as f32 / cap_stacks as f32;
            profile.push(ProfilePoint::on_ball(0.0, start_radius, angle));
        }
        for i in 0..=cap_stacks {
            let angle = lean_angle + (HALF_PI - lean_angle) * i as f32 / cap_stacks as f32;
            profile.push(ProfilePoint::on_ball(length, end_radius, angle));
        }
        let axes = frame_along(axis / length);
        Self::revolve(&profile, segments).mapped(axes, start)
    }

    /// A surface of revolution from `start` to `end` with rounded ends, whose radius follows
    /// `radii` at even steps along the way (at least two values, all positive).
    #[must_use]
    pub fn turned(start: Vec3, end: Vec3, radii: &[f32], segments: usize) -> Self {
        let axis = end - start;
        let length = axis.length();
        let (Some(&first), Some(&last)) = (radii.first(), radii.last()) else {
            return Self::default();
        };
        if length.is_nan() || length <= 1e-6 * first.max(last) || radii.len() < 2 {
            return Self::ball(start, first.max(last), segments);
        }
        let spans = radii.len() - 1;
        let step = length / spans as f32;
        let slope = |i: usize| {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(spans));
            (radii[b] - radii[a]) / ((b - a) as f32 * step)
        };
        let lean_start = -libm::atanf(slope(0));
        let lean_end = -libm::atanf(slope(spans));
        let cap_stacks = (segments / 4).max(3);
        let mut profile = Vec::new();
        for i in 0..cap_stacks {
            let angle = -HALF_PI + (lean_start + HALF_PI) * i as f32 / cap_stacks as f32;
            profile.push(ProfilePoint::on_ball(0.0, first, angle));
        }
        for (i, &radius) in radii.iter().enumerate() {
            let (sin, cos) = libm::sincosf(-libm::atanf(slope(i)));
            // The rounded ends lean with the profile, so the first and last ring are moved to
            // where the ball's surface has the profile's normal.
            profile.push(ProfilePoint {
                along: i as f32 * step + sin * radius * end_weight(i, spans),
                radius: if i == 0 || i == spans {
                    cos * radius
                } else {
                    radius
                },
                normal_along: sin,
                normal_out: cos,
            });
        }
        for i in 1..=cap_stacks {
            let angle = lean_end + (HALF_PI - lean_end) * i as f32 / cap_stacks as f32;
            profile.push(ProfilePoint::on_ball(length, last, angle));
        }
        let axes = frame_along(axis / length);
        Self::revolve(&profile, segments).mapped(axes, start)
    }

    /// A round drum with flat ends and bevelled edges.
    #[must_use]
    pub fn drum(start: Vec3, end: Vec3, radius: f32, bevel: f32, segments: usize) -> Self {
        const BEVEL_STEPS: usize = 3;
        let axis = end - start;
        let length = axis.length();
        if length.is_nan() || length <= 1e-6 * radius {
            return Self::ball(start, radius, segments);
        }
        let bevel = bevel.min(0.5 * length).min(0.9 * radius);
        let flat = |along: f32, radius: f32, normal_along: f32| ProfilePoint {
            along,
            radius,
            normal_along,
            normal_out: 0.0,
        };
        let corner = |middle: f32, first: f32, step: usize| {
            let angle = first + HALF_PI * step as f32 / BEVEL_STEPS as f32;
            let point = ProfilePoint::on_ball(middle, bevel, angle);
            ProfilePoint {
                radius: point.radius + radius - bevel,
                ..point
            }
        };
        let mut profile = vec![flat(0.0, 0.0, -1.0)];
        profile.extend((0..=BEVEL_STEPS).map(|i| corner(bevel, -HALF_PI, i)));
        profile.extend((0..=BEVEL_STEPS).map(|i| corner(length - bevel, 0.0, i)));
        profile.push(flat(length, 0.0, 1.0));
        Self::revolve(&profile, segments).mapped(frame_along(axis / length), start)
    }

    /// A skin over superelliptic cross-sections, closed by a point at either end.
    ///
    /// `side` and `front` are unit, perpendicular directions of every cross-section's plane;
    /// `side x front` must point along the loft, from the first ring to the last.
    /// `squareness` is the superellipse's exponent: 2 is an ellipse, 4 nearly a rounded box.
    #[must_use]
    pub fn loft(
        rings: &[LoftRing],
        side: Vec3,
        front: Vec3,
        squareness: f32,
        segments: usize,
    ) -> Self {
        let (Some(first), Some(last)) = (rings.first(), rings.last()) else {
            return Self::default();
        };
        let mut shape = Self::default();
        shape.positions.push(first.center);
        for ring in rings {
            for s in 0..segments {
                let (sin, cos) = libm::sincosf(TAU * s as f32 / segments as f32);
                let (x, y) = (superellipse(cos, squareness), superellipse(sin, squareness));
                shape.positions.push(
                    ring.center + side * (x * ring.half_side) + front * (y * ring.half_front),
                );
            }
        }
        shape.positions.push(last.center);
        shape.stitch(rings.len(), segments);
        shape.smooth_normals();
        shape
    }

    /// The octahedral bone of animation packages: from `start` to `end`, widest at a fifth of the
    /// way, with flat faces.
    #[must_use]
    pub fn octahedron(start: Vec3, end: Vec3, half_width: f32) -> Self {
        let axis = end - start;
        let length = axis.length();
        if length.is_nan() || length <= 0.0 {
            return Self::ball(start, half_width, 8);
        }
        let axes = frame_along(axis / length);
        let waist = start + axis * 0.2;
        let corners = [axes.x_axis, axes.y_axis, -axes.x_axis, -axes.y_axis]
            .map(|direction| waist + direction * half_width);
        let mut shape = Self::default();
        for i in 0..4 {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            shape.flat_triangle([a, b, end]);
            shape.flat_triangle([b, a, start]);
        }
        shape
    }

    /// The shape under `linear` (which may scale unevenly but not mirror), then moved by `offset`.
    #[must_use]
    pub fn mapped(mut self, linear: Mat3, offset: Vec3) -> Self {
        // Normals go by the cofactor matrix, which is the inverse transpose up to a factor.
        let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
        let cofactor = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        for position in &mut self.positions {
            *position = linear * *position + offset;
        }
        for normal in &mut self.normals {
            *normal = (cofactor * *normal).normalize_or(Vec3::Y);
        }
        self
    }

    fn flat_triangle(&mut self, corners: [Vec3; 3]) {
        let normal = (corners[1] - corners[0])
            .cross(corners[2] - corners[0])
            .normalize_or(Vec3::Y);
        let base = u32::try_from(self.positions.len()).unwrap_or(0);
        self.positions.extend(corners);
        self.normals.extend([normal; 3]);
        self.triangles.push([base, base + 1, base + 2]);
    }

    /// Turns a profile about the Z axis. The first and last profile points are the poles.
    fn revolve(profile: &[ProfilePoint], segments: usize) -> Self {
        let segments = segments.max(6);
        let mut shape = Self::default();
        let (Some(first), Some(last)) = (profile.first(), profile.last()) else {
            return shape;
        };
        shape.positions.push(Vec3::Z * first.along);
        shape.normals.push(-Vec3::Z);
        let rings = &profile[1..profile.len() - 1];
        for point in rings {
            for s in 0..segments {
                let (sin, cos) = libm::sincosf(TAU * s as f32 / segments as f32);
                shape.positions.push(Vec3::new(
                    cos * point.radius,
                    sin * point.radius,
                    point.along,
                ));
                shape.normals.push(Vec3::new(
                    cos * point.normal_out,
                    sin * point.normal_out,
                    point.normal_along,
                ));
            }
        }
        shape.positions.push(Vec3::Z * last.along);
        shape.normals.push(Vec3::Z);
        shape.stitch(rings.len(), segments);
        shape
    }

    /// Triangles over vertices laid out as a pole, rings of `segments`, a pole. Rings run
    /// counter-clockwise about the direction from the first pole to the last.
    fn stitch(&mut self, rings: usize, segments: usize) {
        let n = u32::try_from(segments).unwrap_or(0);
        let rings = u32::try_from(rings).unwrap_or(0);
        if rings == 0 {
            return;
        }
        let at = |ring: u32, s: u32| 1 + ring * n + s % n;
        let end = 1 + rings * n;
        for s in 0..n {
            self.triangles.push([0, at(0, s + 1), at(0, s)]);
            self.triangles
                .push([end, at(rings - 1, s), at(rings - 1, s + 1)]);
        }
        for ring in 0..rings - 1 {
            for s in 0..n {
                let (a, b) = (at(ring, s), at(ring, s + 1));
                let (c, d) = (at(ring + 1, s), at(ring + 1, s + 1));
                self.triangles.push([a, b, d]);
                self.triangles.push([a, d, c]);
            }
        }
    }

    /// Area-weighted vertex normals.
    fn smooth_normals(&mut self) {
        self.normals = vec![Vec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
            let normal = (b - a).cross(c - a);
            for &i in triangle {
                self.normals[i as usize] += normal;
            }
        }
        for normal in &mut self.normals {
            *normal = normal.normalize_or(Vec3::Y);
        }
    }
}

/// 1 with the sign of the end at the first and last ring, 0 between.
fn end_weight(index: usize, last: usize) -> f32 {
    if index == 0 || index == last {
        1.0
    } else {
        0.0
    }
}

fn superellipse(unit: f32, exponent: f32) -> f32 {
    let size = libm::powf(unit.abs(), 2.0 / exponent);
    if unit < 0.0 { -size } else { size }
}

#[derive(Clone, Copy, Debug)]
struct ProfilePoint {
    along: f32,
    radius: f32,
    normal_along: f32,
    normal_out: f32,
}

impl ProfilePoint {
    /// A point of a ball's profile, `angle` from the equator towards +along.
    fn on_ball(middle: f32, ball_radius: f32, angle: f32) -> Self {
        let (sin, cos) = libm::sincosf(angle);
        Self {
            along: middle + ball_radius * sin,
            radius: ball_radius * cos,
            normal_along: sin,
            normal_out: cos,
        }
    }
}

/// A rotation that takes Z to `direction` (unit length). Deterministic, with no preferred twist
/// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
#[must_use]
pub(crate) fn frame_along(direction: Vec3) -> Mat3 {
    let n = direction;
    let sign = if n.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    Mat3::from_cols(
        Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        Vec3::new(b, sign + n.y * n.y * a, -n.y),
        n,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the signed volume, by the divergence theorem: positive when the faces wind
    /// outwards.
    fn volume(shape: &Shape) -> f32 {
        shape
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| shape.positions[i as usize]);
                a.dot(b.cross(c))
            })
            .sum::<f32>()
            / 6.0
    }

    fn assert_closed_and_outward(shape: &Shape) {
        let mut edges = std::collections::BTreeMap::new();
        for t in &shape.triangles {
            for k in 0..3 {
                *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
            }
            let [a, b, c] = t.map(|i| shape.positions[i as usize]);
            let face = (b - a).cross(c - a);
            if face.length() > 1e-7 {
                for &i in t {
                    assert!(
                        face.normalize().dot(shape.normals[i as usize]) > -0.2,
                        "{t:?}"
                    );
                }
            }
        }
        for (&(a, b), &count) in &edges {
            assert_eq!((count, edges.get(&(b, a))), (1, Some(&1)), "edge {a} {b}");
        }
        assert!(volume(shape) > 0.0);
    }

    #[test]
    fn a_ball_has_nearly_the_volume_of_a_ball() {
        let ball = Shape::ball(Vec3::new(1.0, 2.0, 3.0), 2.0, 48);
        assert_closed_and_outward(&ball);
        let exact = 4.0 / 3.0 * std::f32::consts::PI * 8.0;
        assert!((volume(&ball) / exact - 1.0).abs() < 0.02);
    }

    #[test]
    fn a_drum_has_nearly_the_volume_of_a_cylinder() {
        let drum = Shape::drum(Vec3::ZERO, Vec3::new(0.0, 3.0, 0.0), 1.0, 0.01, 96);
        let exact = 3.0 * std::f32::consts::PI;
        assert!((volume(&drum) / exact - 1.0).abs() < 0.01);
    }

    #[test]
    fn shapes_are_closed_and_face_outwards() {
        let (a, b) = (Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.4, -0.7, 0.1));
        assert_closed_and_outward(&Shape::tapered_capsule(a, 0.1, b, 0.05, 12));
        assert_closed_and_outward(&Shape::tapered_capsule(a, 0.05, b, 0.2, 12));
        assert_closed_and_outward(&Shape::turned(a, b, &[0.08, 0.1, 0.07, 0.05], 12));
        assert_closed_and_outward(&Shape::drum(a, b, 0.2, 0.05, 12));
        let rings = [0.0, 0.5, 1.0].map(|t| LoftRing {
            center: Vec3::Z * t,
            half_side: 0.4 - 0.1 * t,
            half_front: 0.2,
        });
        assert_closed_and_outward(&Shape::loft(&rings, Vec3::X, Vec3::Y, 2.5, 16));
    }

    #[test]
    fn every_point_of_a_tapered_capsule_is_on_its_hull() {
        let (a, b) = (Vec3::ZERO, Vec3::new(0.0, 1.0, 0.0));
        let capsule = Shape::tapered_capsule(a, 0.3, b, 0.1, 16);
        for &p in &capsule.positions {
            let nearest = (0..=1000)
                .map(|i| {
                    let t = i as f32 / 1000.0;
                    (p - a.lerp(b, t)).length() - (0.3 + (0.1 - 0.3) * t)
                })
                .fold(f32::INFINITY, f32::min);
            assert!(nearest.abs() < 2e-3, "{p} {nearest}");
        }
    }

    #[test]
    fn degenerate_shapes_are_balls() {
        let p = Vec3::ONE;
        assert_eq!(
            Shape::tapered_capsule(p, 0.1, p, 0.2, 8),
            Shape::ball(p, 0.2, 8)
        );
        assert_eq!(Shape::turned(p, p, &[0.1, 0.2], 8), Shape::ball(p, 0.2, 8));
    }
}
