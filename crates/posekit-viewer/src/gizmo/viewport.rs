//! Between the screen and the world: a camera, and the piece of the screen that its picture fills.

use egui::{Pos2, Rect, pos2};
use glam::{Mat4, Vec3};
use posekit_render::camera::Camera;

/// A half line in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes, unit length.
    pub direction: Vec3,
}

/// Nearly parallel to a plane or a line is nearer than this to it, as a sine.
const PARALLEL: f32 = 1e-4;

impl Ray {
    /// Where it meets a plane: `None` when it runs along it or meets it behind its start.
    #[must_use]
    pub fn meets_plane(&self, point: Vec3, normal: Vec3) -> Option<Vec3> {
        let approach = self.direction.dot(normal);
        if approach.abs() < PARALLEL {
            return None;
        }
        let along = (point - self.origin).dot(normal) / approach;
        (along > 0.0 && along.is_finite()).then(|| self.origin + self.direction * along)
    }

    /// How far along a line (`direction` of unit length) its point nearest to the ray is, from
    /// `point`: `None` when they are parallel or come nearest behind the ray's start.
    #[must_use]
    pub fn nearest_on_line(&self, point: Vec3, direction: Vec3) -> Option<f32> {
        let across = self.direction.dot(direction);
        let sine_squared = 1.0 - across * across;
        if sine_squared < PARALLEL * PARALLEL {
            return None;
        }
        let between = self.origin - point;
        let (on_ray, on_line) = (between.dot(self.direction), between.dot(direction));
        let along_ray = (across * on_line - on_ray) / sine_squared;
        let along_line = (on_line - across * on_ray) / sine_squared;
        (along_ray > 0.0 && along_line.is_finite()).then_some(along_line)
    }
}

/// A camera, and the piece of the screen that its picture fills, in points.
#[derive(Clone, Copy, Debug)]
pub struct Viewport {
    camera: Camera,
    rect: Rect,
    clip_from_world: Mat4,
    back: Vec3,
}

impl Viewport {
    /// The view of a camera in a piece of the screen that is not empty.
    #[must_use]
    pub fn new(camera: Camera, rect: Rect) -> Self {
        let aspect = rect.width().max(1.0) / rect.height().max(1.0);
        Self {
            camera,
            rect,
            clip_from_world: camera.clip_from_world(aspect),
            back: camera.axes().2,
        }
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The piece of the screen.
    #[must_use]
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// Where a point of the world is on the screen; `None` behind the eye.
    #[must_use]
    pub fn project(&self, point: Vec3) -> Option<Pos2> {
        if (self.camera.eye - point).dot(self.back) < self.camera.near {
            return None;
        }
        let clip = self.clip_from_world * point.extend(1.0);
        let (x, y) = (clip.x / clip.w, clip.y / clip.w);
        let place = pos2(
            self.rect.left() + (x * 0.5 + 0.5) * self.rect.width(),
            self.rect.top() + (0.5 - y * 0.5) * self.rect.height(),
        );
        (place.x.is_finite() && place.y.is_finite()).then_some(place)
    }

    /// What is seen at a place of the screen.
    #[must_use]
    pub fn ray(&self, place: Pos2) -> Ray {
        /// `Camera::ray` counts in whole pixels: fine enough to be as good as points.
        const FINE: f32 = 64.0;
        let from_corner = (place - self.rect.min) * FINE;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a window's size is small and positive"
        )]
        let fine = |length: f32| ((length * FINE).round() as u32).max(1);
        let size = (fine(self.rect.width()), fine(self.rect.height()));
        let (origin, direction) = self.camera.ray((from_corner.x, from_corner.y), size);
        Ray { origin, direction }
    }

    /// From a point of the world towards the eye, unit length.
    #[must_use]
    pub fn toward_eye(&self, point: Vec3) -> Vec3 {
        use posekit_render::camera::Projection;
        match self.camera.projection {
            Projection::Perspective { .. } => (self.camera.eye - point).normalize_or(self.back),
            Projection::Orthographic { .. } => self.back,
        }
    }

    /// The length in the world that so many points of the screen are at a point.
    #[must_use]
    pub fn length_of(&self, points: f32, at: Vec3) -> f32 {
        points * self.camera.pixel_size_at(at, self.rect.height().max(1.0))
    }

    /// How far away a point is from the eye.
    #[must_use]
    pub fn distance_to(&self, point: Vec3) -> f32 {
        self.camera.eye.distance(point)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use egui::vec2;
    use posekit_render::camera::{Orbit, Projection};

    use super::*;

    /// A view of the origin from +Z, turned by yaw and pitch.
    pub(in super::super) fn viewport(yaw_rad: f32, pitch_rad: f32) -> Viewport {
        let orbit = Orbit {
            target: Vec3::ZERO,
            yaw_rad,
            pitch_rad,
            distance: 5.0,
            projection: Projection::Perspective {
                vertical_fov_rad: 0.6,
            },
        };
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(800.0, 600.0));
        Viewport::new(orbit.camera(), rect)
    }

    #[test]
    fn a_ray_through_a_projected_point_meets_it() {
        let view = viewport(0.7, 0.3);
        for point in [
            Vec3::ZERO,
            Vec3::new(0.5, -0.3, 0.8),
            Vec3::new(-0.9, 0.4, -0.2),
        ] {
            let ray = view.ray(view.project(point).expect("it is in front"));
            let away = (point - ray.origin).cross(ray.direction).length();
            assert!(away < 1e-4, "{point}: {away}");
        }
        assert_eq!(view.project(view.camera().eye * 2.0), None);
    }

    #[test]
    fn lengths_on_the_screen_are_those_of_the_projection() {
        let view = viewport(0.0, 0.0);
        let length = view.length_of(100.0, Vec3::ZERO);
        let across = view.project(Vec3::X * length).expect("in front").x
            - view.project(Vec3::ZERO).expect("in front").x;
        assert!((across - 100.0).abs() < 0.01, "{across}");
    }

    #[test]
    fn a_ray_and_a_line_come_nearest_where_they_cross() {
        let ray = Ray {
            origin: Vec3::new(3.0, 4.0, 9.0),
            direction: -Vec3::Z,
        };
        assert_eq!(ray.nearest_on_line(Vec3::ZERO, Vec3::X), Some(3.0));
        assert_eq!(ray.nearest_on_line(Vec3::ZERO, Vec3::Z), None, "parallel");
        assert_eq!(ray.meets_plane(Vec3::ZERO, Vec3::X), None, "along it");
        assert_eq!(
            ray.meets_plane(Vec3::Z * 10.0, Vec3::Z),
            None,
            "behind the eye"
        );
        assert_eq!(
            ray.meets_plane(Vec3::Z, Vec3::Z),
            Some(Vec3::new(3.0, 4.0, 1.0))
        );
    }
}
