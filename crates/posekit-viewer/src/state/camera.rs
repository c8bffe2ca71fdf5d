//! The camera of the view: an orbit around what it follows.

use glam::Vec3;
use posekit_render::camera::{Camera, DEFAULT_VERTICAL_FOV_RAD, Orbit, Projection, View};
use posekit_render::framing::{Framing, frame_points};
use posekit_render::stage::Stage;

/// How far the eye may go up and down: a hair short of straight, so that up stays up.
const PITCH_LIMIT_RAD: f32 = std::f32::consts::FRAC_PI_2;

/// Turn of the view by dragging across its height, radians.
const TURN_PER_HEIGHT_RAD: f32 = 3.2;

/// The camera of the view.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewCamera {
    /// The orbit; its target counts from what the stage's camera follows.
    orbit: Orbit,
    /// Whether it stands where it was framed last, so that it may be framed anew when the window
    /// changes its shape.
    framed: bool,
    /// The named side that it looks from, as long as it was not turned since.
    side: Option<View>,
}

impl Default for ViewCamera {
    fn default() -> Self {
        let (yaw_rad, pitch_rad) = View::ThreeQuarter.yaw_pitch_rad(0.0);
        Self {
            orbit: Orbit {
                target: Vec3::Y,
                yaw_rad,
                pitch_rad,
                distance: 5.0,
                projection: Projection::Perspective {
                    vertical_fov_rad: DEFAULT_VERTICAL_FOV_RAD,
                },
            },
            framed: true,
            side: None,
        }
    }
}

impl ViewCamera {
    /// The orbit at a time.
    #[must_use]
    pub fn orbit(&self, stage: &Stage, time_secs: f64) -> Orbit {
        Orbit {
            target: self.orbit.target + stage.followed(time_secs),
            ..self.orbit
        }
    }

    /// Whether it stands as it was framed last.
    #[must_use]
    pub fn is_framed(&self) -> bool {
        self.framed
    }

    /// Whether the rays are parallel.
    #[must_use]
    pub fn is_orthographic(&self) -> bool {
        matches!(self.orbit.projection, Projection::Orthographic { .. })
    }

    /// Takes the whole motion into a picture of `aspect`, seen from where it looks now.
    pub fn frame_all(&mut self, stage: &Stage, aspect: f32) {
        self.adopt(stage, aspect, self.orbit.yaw_rad, self.orbit.pitch_rad);
    }

    /// Takes the whole motion into a picture of `aspect`, seen from a named side.
    pub fn look_from(&mut self, view: View, stage: &Stage, aspect: f32) {
        let (yaw_rad, pitch_rad) = view.yaw_pitch_rad(stage.facing_yaw_rad());
        self.adopt(stage, aspect, yaw_rad, pitch_rad);
        self.side = Some(view);
    }

    /// Takes the whole of another stage with the same figures into a picture, from the same side of them.
    pub fn frame_again(&mut self, stage: &Stage, aspect: f32) {
        match self.side {
            Some(view) => self.look_from(view, stage, aspect),
            None => self.frame_all(stage, aspect),
        }
    }

    /// Goes to a point and near to it: `radius` fills most of the picture.
    pub fn frame_point(&mut self, point: Vec3, radius: f32, stage: &Stage, time_secs: f64) {
        self.orbit.target = point - stage.followed(time_secs);
        let distance = radius / libm::sinf(DEFAULT_VERTICAL_FOV_RAD / 2.0);
        let factor = distance / self.orbit.distance;
        self.orbit = self.orbit.zoomed(factor);
        self.framed = false;
    }

    /// The same view of a world in which every length is `factor` times as large.
    pub fn scale(&mut self, factor: f32) {
        self.orbit.target *= factor;
        self.orbit.distance *= factor;
        if let Projection::Orthographic { height } = &mut self.orbit.projection {
            *height *= factor;
        }
    }

    /// Stands where a camera stands and looks at what it looks at.
    pub fn stand_at(&mut self, camera: &Camera, stage: &Stage, time_secs: f64) {
        let away = camera.eye - camera.target;
        let distance = away.length();
        if !distance.is_finite() || distance <= 0.0 {
            return;
        }
        let level = libm::hypotf(away.x, away.z);
        self.orbit.target = camera.target - stage.followed(time_secs);
        self.side = None;
        self.orbit.yaw_rad = libm::atan2f(away.x, away.z);
        self.orbit.pitch_rad = libm::atan2f(away.y, level);
        self.orbit.distance = distance;
        self.framed = false;
    }

    /// Turns by a drag, given as fractions of the view's height, right and down.
    pub fn turn(&mut self, right: f32, down: f32) {
        let turned = self.orbit.yaw_rad - right * TURN_PER_HEIGHT_RAD;
        self.side = None;
        self.orbit.yaw_rad = turned % std::f32::consts::TAU;
        let pitch = self.orbit.pitch_rad + down * TURN_PER_HEIGHT_RAD;
        self.orbit.pitch_rad = pitch.clamp(-PITCH_LIMIT_RAD, PITCH_LIMIT_RAD);
        self.framed = false;
    }

    /// Moves the picture's content by fractions of the view's height, right and down.
    pub fn pan(&mut self, right: f32, down: f32) {
        self.orbit = self.orbit.panned(-right, down);
        self.framed = false;
    }

    /// Goes nearer (`factor` under 1) or farther, within reason for a figure of height `stature`.
    pub fn zoom(&mut self, factor: f32, stature: f32) {
        if !factor.is_finite() || factor <= 0.0 {
            return;
        }
        let distance = (self.orbit.distance * factor).clamp(0.05 * stature, 400.0 * stature);
        self.orbit = self.orbit.zoomed(distance / self.orbit.distance);
        self.framed = false;
    }

    /// Looks from the other side.
    pub fn turn_around(&mut self) {
        self.side = None;
        self.orbit.yaw_rad += std::f32::consts::PI;
    }

    /// Changes between a lens and parallel rays; what is at the target keeps its size.
    pub fn toggle_projection(&mut self) {
        let lens_height = 2.0 * self.orbit.distance * libm::tanf(DEFAULT_VERTICAL_FOV_RAD / 2.0);
        let (projection, factor) = match self.orbit.projection {
            Projection::Perspective { .. } => (
                Projection::Orthographic {
                    height: lens_height,
                },
                1.0,
            ),
            Projection::Orthographic { height } => (
                Projection::Perspective {
                    vertical_fov_rad: DEFAULT_VERTICAL_FOV_RAD,
                },
                height / lens_height,
            ),
        };
        let distance = self.orbit.distance * factor;
        self.orbit = Orbit {
            projection,
            distance,
            ..self.orbit
        };
    }

    /// Keeps the picture as it is while what the stage follows changes.
    pub fn rebase(&mut self, before: Vec3, after: Vec3) {
        self.orbit.target += before - after;
    }

    /// The orbit, for a room in which nothing is followed.
    #[must_use]
    pub fn still(&self) -> Orbit {
        self.orbit
    }

    /// Takes points into a picture of `aspect`, seen from a yaw and a pitch, radians, with `padding`
    /// around each. Without points it stays where it is.
    pub fn frame_points(
        &mut self,
        points: &[Vec3],
        (yaw_rad, pitch_rad): (f32, f32),
        padding: f32,
        aspect: f32,
    ) {
        let framing = Framing {
            yaw_rad,
            pitch_rad,
            projection: self.orbit.projection,
            aspect,
            margin: 0.08,
            padding,
        };
        if let Some(orbit) = frame_points(points.iter().copied(), &framing) {
            self.orbit = orbit;
            self.framed = true;
        }
    }

    fn adopt(&mut self, stage: &Stage, aspect: f32, yaw_rad: f32, pitch_rad: f32) {
        let projection = self.orbit.projection;
        let framed = stage.orbit_from(0.0, aspect, (yaw_rad, pitch_rad, projection));
        self.orbit = Orbit {
            target: framed.target - stage.followed(0.0),
            ..framed
        };
        self.framed = true;
    }
}
