//! Cameras: where the picture is taken from, and the projection to the screen.
//!
//! World space is right-handed with Y up. Pixels count from the top left corner; the middle of the
//! first pixel is (0.5, 0.5). Depth is reversed: 1 at the near plane and 0 infinitely far away (or
//! at the far plane of an orthographic camera), which keeps its precision where it is needed and
//! is affine over the screen for a plane.

use glam::{Mat4, Vec3, Vec4};

/// How a camera flattens space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A lens; `vertical_fov_rad` is the angle between the picture's top and bottom edge.
    Perspective {
        /// Full vertical field of view, radians, between 0 and pi.
        vertical_fov_rad: f32,
    },
    /// Parallel rays; `height` is the length that fills the picture from top to bottom.
    Orthographic {
        /// World length from the top edge to the bottom edge.
        height: f32,
    },
}

/// A camera in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, in world space.
    pub eye: Vec3,
    /// The point in the middle of the picture.
    pub target: Vec3,
    /// Which way is up in the picture; need not be perpendicular to the view.
    pub up: Vec3,
    /// Lens or parallel rays.
    pub projection: Projection,
    /// Nothing nearer than this to the eye's plane is drawn. Must be positive.
    pub near: f32,
    /// The farthest distance that an orthographic camera tells apart.
    pub far: f32,
}

/// A named direction to look from. The figure is taken to face +Z unless a facing is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum View {
    /// Facing the figure.
    Front,
    /// Behind the figure.
    Back,
    /// From the figure's left.
    Left,
    /// From the figure's right.
    Right,
    /// From straight above, the figure's front towards the bottom of the picture.
    Top,
    /// From the front, its left and somewhat above: the default.
    ThreeQuarter,
}

/// A camera that turns about a target: what a mouse drags.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// The point turned about and looked at, in world space.
    pub target: Vec3,
    /// Turn about Y, radians: 0 looks from +Z, a quarter turn from +X.
    pub yaw_rad: f32,
    /// Height of the eye over the horizon, radians, -pi/2 to pi/2.
    pub pitch_rad: f32,
    /// From the target to the eye.
    pub distance: f32,
    /// Lens or parallel rays. An orthographic height is kept as it is.
    pub projection: Projection,
}

/// The default lens: about 50 mm on a small-format camera, which flatters figures.
pub const DEFAULT_VERTICAL_FOV_RAD: f32 = 0.5;

impl View {
    /// Yaw and pitch to look from, radians, for a figure that faces `facing_yaw_rad` (0 is +Z).
    #[must_use]
    pub fn yaw_pitch_rad(self, facing_yaw_rad: f32) -> (f32, f32) {
        use std::f32::consts::{FRAC_PI_2, PI};
        let (yaw, pitch) = match self {
            Self::Front => (0.0, 0.06),
            Self::Back => (PI, 0.06),
            Self::Left => (FRAC_PI_2, 0.06),
            Self::Right => (-FRAC_PI_2, 0.06),
            Self::Top => (0.0, FRAC_PI_2),
            Self::ThreeQuarter => (0.65, 0.26),
        };
        (facing_yaw_rad + yaw, pitch)
    }
}

impl Orbit {
    /// The direction from the target to the eye, unit length.
    #[must_use]
    pub fn direction(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = libm::sincosf(self.yaw_rad);
        let (sin_pitch, cos_pitch) = libm::sincosf(self.pitch_rad);
        Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch)
    }

    /// The camera. Its up direction turns with the yaw, so that looking straight down is no
    /// special case.
    #[must_use]
    pub fn camera(&self) -> Camera {
        let (sin_yaw, cos_yaw) = libm::sincosf(self.yaw_rad);
        let (sin_pitch, cos_pitch) = libm::sincosf(self.pitch_rad);
        let up = Vec3::new(-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch);
        let distance = self.distance.max(f32::MIN_POSITIVE);
        Camera {
            eye: self.target + self.direction() * distance,
            target: self.target,
            up,
            projection: self.projection,
            near: distance * 0.01,
            far: distance * 100.0,
        }
    }

    /// Moves the target in the picture's plane by fractions of the picture's height: what dragging
    /// with the middle mouse button does.
    #[must_use]
    pub fn panned(&self, right: f32, up: f32) -> Self {
        let camera = self.camera();
        let (right_axis, up_axis, _) = camera.axes();
        let height = match self.projection {
            Projection::Perspective { vertical_fov_rad } => {
                2.0 * self.distance * libm::tanf(vertical_fov_rad / 2.0)
            }
            Projection::Orthographic { height } => height,
        };
        Self {
            target: self.target + (right_axis * right + up_axis * up) * height,
            ..*self
        }
    }

    /// Goes nearer (`factor` under 1) or farther; an orthographic height scales along.
    #[must_use]
    pub fn zoomed(&self, factor: f32) -> Self {
        let projection = match self.projection {
            Projection::Orthographic { height } => Projection::Orthographic {
                height: height * factor,
            },
            lens @ Projection::Perspective { .. } => lens,
        };
        Self {
            distance: self.distance * factor,
            projection,
            ..*self
        }
    }
}

impl Camera {
    /// The picture's right, its up, and the direction towards the viewer: unit and perpendicular.
    /// A camera on its target, or one that looks along its up direction, gets some valid frame.
    #[must_use]
    pub fn axes(&self) -> (Vec3, Vec3, Vec3) {
        let back = (self.eye - self.target).normalize_or(Vec3::Z);
        let side = self.up.cross(back);
        let right = if side.length_squared() > 1e-12 * self.up.length_squared() {
            side.normalize_or(Vec3::X)
        } else {
            back.any_orthonormal_vector()
        };
        (right, back.cross(right), back)
    }

    /// The clip-space matrix for a picture of `aspect` = width / height.
    ///
    /// Clip coordinates divide to x and y in -1..=1 (y up) and reversed depth in 0..=1; for a lens
    /// `w` is the distance from the eye's plane.
    #[must_use]
    pub fn clip_from_world(&self, aspect: f32) -> Mat4 {
        let (right, up, back) = self.axes();
        let row = |axis: Vec3, scale: f32| (axis * scale).extend(-axis.dot(self.eye) * scale);
        let (x, y, z, w) = match self.projection {
            Projection::Perspective { vertical_fov_rad } => {
                let scale = 1.0 / libm::tanf(vertical_fov_rad / 2.0);
                (
                    row(right, scale / aspect),
                    row(up, scale),
                    Vec4::new(0.0, 0.0, 0.0, self.near),
                    row(-back, 1.0),
                )
            }
            Projection::Orthographic { height } => {
                let scale = 2.0 / height;
                let depth = 1.0 / (self.far - self.near);
                let z = row(back, depth) + Vec4::W * (self.far * depth);
                (row(right, scale / aspect), row(up, scale), z, Vec4::W)
            }
        };
        Mat4::from_cols(x, y, z, w).transpose()
    }

    /// World length of one pixel at `point`, in a picture `height_px` pixels high.
    #[must_use]
    pub fn pixel_size_at(&self, point: Vec3, height_px: f32) -> f32 {
        match self.projection {
            Projection::Perspective { vertical_fov_rad } => {
                let (_, _, back) = self.axes();
                let depth = (self.eye - point).dot(back).max(self.near);
                2.0 * depth * libm::tanf(vertical_fov_rad / 2.0) / height_px
            }
            Projection::Orthographic { height } => height / height_px,
        }
    }

    /// Where a world point is in a picture of `size` pixels: x, y from the top left corner, and
    /// the distance from the eye's plane. `None` behind the near plane.
    #[must_use]
    pub fn project(&self, point: Vec3, size: (u32, u32)) -> Option<Vec3> {
        let (width, height) = (size.0 as f32, size.1 as f32);
        let clip = self.clip_from_world(width / height) * point.extend(1.0);
        let (_, _, back) = self.axes();
        let depth = (self.eye - point).dot(back);
        (depth >= self.near).then(|| {
            Vec3::new(
                (clip.x / clip.w * 0.5 + 0.5) * width,
                (0.5 - clip.y / clip.w * 0.5) * height,
                depth,
            )
        })
    }

    /// The ray through a pixel position: its origin and unit direction, in world space. For
    /// picking, and for finding the ground under the pointer.
    #[must_use]
    pub fn ray(&self, pixel: (f32, f32), size: (u32, u32)) -> (Vec3, Vec3) {
        let (right, up, back) = self.axes();
        let (width, height) = (size.0 as f32, size.1 as f32);
        let x = (pixel.0 / width * 2.0 - 1.0) * width / height;
        let y = 1.0 - pixel.1 / height * 2.0;
        match self.projection {
            Projection::Perspective { vertical_fov_rad } => {
                let tan = libm::tanf(vertical_fov_rad / 2.0);
                let direction = right * (x * tan) + up * (y * tan) - back;
                (self.eye, direction.normalize_or(-back))
            }
            Projection::Orthographic { height } => {
                (self.eye + (right * x + up * y) * (height / 2.0), -back)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(projection: Projection) -> Orbit {
        Orbit {
            target: Vec3::new(1.0, 2.0, -3.0),
            yaw_rad: 0.7,
            pitch_rad: 0.4,
            distance: 5.0,
            projection,
        }
    }

    const LENS: Projection = Projection::Perspective {
        vertical_fov_rad: 0.6,
    };
    const PARALLEL: Projection = Projection::Orthographic { height: 4.0 };

    #[test]
    fn the_target_is_in_the_middle_of_the_picture() {
        for projection in [LENS, PARALLEL] {
            let orbit = orbit(projection);
            let p = orbit.camera().project(orbit.target, (640, 360)).unwrap();
            assert!((p - Vec3::new(320.0, 180.0, 5.0)).length() < 1e-2, "{p}");
        }
    }

    #[test]
    fn rays_and_projection_agree() {
        for projection in [LENS, PARALLEL] {
            let camera = orbit(projection).camera();
            let (origin, direction) = camera.ray((100.0, 250.0), (640, 360));
            let p = camera
                .project(origin + direction * 7.0, (640, 360))
                .unwrap();
            assert!(
                (p.x - 100.0).abs() < 1e-2 && (p.y - 250.0).abs() < 1e-2,
                "{p}"
            );
        }
    }

    #[test]
    fn depth_is_one_at_the_near_plane_and_falls_with_distance() {
        for projection in [LENS, PARALLEL] {
            let camera = orbit(projection).camera();
            let m = camera.clip_from_world(1.5);
            let (_, _, back) = camera.axes();
            let depth = |distance: f32| {
                let clip = m * (camera.eye - back * distance).extend(1.0);
                clip.z / clip.w
            };
            assert!((depth(camera.near) - 1.0).abs() < 1e-3);
            assert!(depth(1.0) > depth(2.0) && depth(2.0) > depth(50.0));
            assert!(depth(camera.far * 0.99) > 0.0);
        }
    }

    #[test]
    fn looking_straight_down_has_front_at_the_bottom() {
        let (yaw_rad, pitch_rad) = View::Top.yaw_pitch_rad(0.0);
        let orbit = Orbit {
            yaw_rad,
            pitch_rad,
            target: Vec3::ZERO,
            ..orbit(LENS)
        };
        let front = orbit.camera().project(Vec3::Z * 0.5, (400, 400)).unwrap();
        assert!(front.y > 210.0 && (front.x - 200.0).abs() < 1e-2, "{front}");
    }

    #[test]
    fn front_view_has_the_left_of_the_figure_on_the_right() {
        let (yaw_rad, pitch_rad) = View::Front.yaw_pitch_rad(0.0);
        let orbit = Orbit {
            yaw_rad,
            pitch_rad,
            target: Vec3::ZERO,
            ..orbit(LENS)
        };
        // A figure that faces +Z has its left at +X.
        let left = orbit.camera().project(Vec3::X * 0.5, (400, 400)).unwrap();
        assert!(left.x > 210.0);
    }

    #[test]
    fn panning_moves_the_picture_by_the_fraction() {
        for projection in [LENS, PARALLEL] {
            let before = orbit(projection);
            let after = before.panned(0.25, 0.5);
            let p = after.camera().project(before.target, (300, 300)).unwrap();
            assert!(
                (p.x - 75.0).abs() < 0.05 && (p.y - 300.0).abs() < 0.05,
                "{p}"
            );
        }
    }

    #[test]
    fn a_degenerate_camera_still_has_a_frame() {
        let camera = Camera {
            eye: Vec3::Y,
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: LENS,
            near: 0.1,
            far: 10.0,
        };
        let (right, up, back) = camera.axes();
        assert!((right.cross(up) - back).length() < 1e-5);
        let on_target = Camera {
            target: camera.eye,
            ..camera
        };
        assert!(on_target.clip_from_world(1.0).is_finite());
    }
}
