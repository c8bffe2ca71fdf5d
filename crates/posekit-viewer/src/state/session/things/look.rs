//! Looking through a camera of the scene, and bringing it to where the view is.

use posekit_render::camera::{Camera, Projection};
use posekit_render::stage::keyed_camera;

use super::super::Session;
use super::{NewThing, tidy};
use crate::state::animate::{Lane, LaneValue, Owner};

/// How much of the view the frame of a camera fills.
const FRAME_SHARE: f32 = 0.92;

impl Session {
    /// Which camera of the scene the view looks through.
    #[must_use]
    pub fn looks_through(&self) -> Option<usize> {
        let cameras = self.authored()?.scene().cameras.len();
        self.things.looks_through.filter(|index| *index < cameras)
    }

    /// Looks through a camera of the scene; `None` goes back to where the view was.
    pub fn look_through(&mut self, camera: Option<usize>) {
        self.things.looks_through = camera;
    }

    /// Looks through the camera that is picked, else through the one that the view left last, else through the first;
    /// no longer, when it does.
    pub fn toggle_look_through(&mut self) {
        let first = || self.authored().and(Some(0));
        self.things.looks_through = match self.looks_through() {
            Some(_) => None,
            None => self.camera_meant().or_else(first),
        };
    }

    /// The view leaves the camera that it looks through, and stays where that is.
    pub fn leave_camera(&mut self) {
        if let Some(camera) = self.scene_camera() {
            let time = self.stage_time_secs();
            self.camera.stand_at(&camera, &self.stage, time);
        }
        self.things.left = self.things.looks_through.take();
    }

    /// The camera that commands are about where they name none: the one that is picked, that is looked through, or that
    /// the view has just turned away from.
    fn camera_meant(&self) -> Option<usize> {
        let picked = match self.picked().map(|picked| picked.owner) {
            Some(Owner::Camera(index)) => Some(index),
            _ => None,
        };
        let count = self.authored()?.scene().cameras.len();
        let left = self.things.left.filter(|index| *index < count);
        picked.or(self.looks_through()).or(left)
    }

    /// The camera of the scene that the view looks through, as it stands now.
    #[must_use]
    pub fn scene_camera(&self) -> Option<Camera> {
        let index = self.looks_through()?;
        let scene = self.scene_shown()?;
        let view = &scene.cameras.get(index)?.view;
        Some(keyed_camera(view, self.scene_secs(), self.stage.stature()))
    }

    /// The scene's camera takes the place of the view: the one that is picked or looked through, or was until the
    /// view turned away from it, else the first; a new one where there is none. The view then looks through it.
    pub fn camera_to_view(&mut self) {
        let Some(count) = self.authored().map(|it| it.scene().cameras.len()) else {
            return;
        };
        let index = self.camera_meant().unwrap_or(0);
        let view = self.view_camera();
        let values = [
            (Lane::CameraPosition(index), view.eye),
            (Lane::CameraTarget(index), view.target),
        ]
        .map(|(lane, at)| (lane, LaneValue::Vector(tidy(at))));
        self.transport.pause();
        if count == 0 {
            self.add_thing(NewThing::Camera);
        }
        if self.animate().auto_key {
            // A view that is taken is a key, changed or not: without one at the first, the next would
            // hold for all of the shot.
            self.put_keys("Camera to view", &values, None);
        } else if count > 0 {
            self.set_values("Camera to view", &values, None);
        }
        self.things.looks_through = Some(index);
    }

    /// The aspect ratio of the shot's picture, width over height.
    #[must_use]
    pub fn frame_aspect(&self) -> f32 {
        self.things.frame_aspect
    }

    /// Sets the aspect ratio of the shot's picture.
    pub fn set_frame_aspect(&mut self, aspect: f32) {
        if aspect.is_finite() && aspect > 0.0 {
            self.things.frame_aspect = aspect;
        }
    }

    /// Width and height of the frame of the camera that is looked through, as shares of the view's.
    #[must_use]
    pub fn frame_shares(&self) -> (f32, f32) {
        let aspect = self.things.frame_aspect;
        let height = FRAME_SHARE * (self.aspect / aspect).min(1.0);
        (height * aspect / self.aspect, height)
    }

    /// The scene's camera, wide enough that its frame is in the view with a margin.
    pub(in super::super) fn framed_camera(&self) -> Option<Camera> {
        let camera = self.scene_camera()?;
        let (_, share) = self.frame_shares();
        let Projection::Perspective { vertical_fov_rad } = camera.projection else {
            return Some(camera);
        };
        let tan = libm::tanf(vertical_fov_rad / 2.0) / share;
        Some(Camera {
            projection: Projection::Perspective {
                vertical_fov_rad: 2.0 * libm::atanf(tan),
            },
            ..camera
        })
    }
}
