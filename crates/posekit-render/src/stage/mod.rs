//! The stage: motions with their bodies, and the scene that they make at a time.
//!
//! A [`Stage`] knows its actors and the space they need in the whole course of their motions. It
//! makes a [`Scene`] for any time, without memory of the last one: the same time gives the same
//! scene, in any order.

mod actor;
mod company;
mod options;
mod room;
mod show;
mod surroundings;

use glam::Vec3;

use crate::camera::{Camera, DEFAULT_VERTICAL_FOV_RAD, Orbit, Projection};
use crate::framing::{Framing, frame_points};
use crate::scene::{Background, Scene};

pub use actor::Actor;
pub use company::scale_beside;
pub use options::{
    Arrangement, AxesShown, CameraChoice, Follow, GhostSide, Ghosts, KeyGhost, Labels,
    SkeletonStyle, StageOptions, Trails,
};
pub use room::Room;
pub use surroundings::{
    AMBIENT, FULL_EXPOSURE, LIGHT_FULL_AT, Prop, PropShape, Surroundings, keyed_camera,
};

/// Motions with their bodies, ready to be drawn at any time.
#[derive(Clone, Debug)]
pub struct Stage {
    actors: Vec<Actor>,
    options: StageOptions,
    /// Where each actor is moved to, world space.
    places: Vec<Vec3>,
    stature: f32,
    ground_height: f32,
    facing_yaw_rad: f32,
    follows: bool,
    /// What must be in the picture: points of the world, or around the followed point.
    points: Vec<Vec3>,
    surroundings: Surroundings,
}

impl Stage {
    /// Sets the stage. Without actors it is an empty room.
    #[must_use]
    pub fn new(actors: Vec<Actor>, options: StageOptions) -> Self {
        let stature = actors.iter().map(Actor::stature).fold(0.0, f32::max);
        let stature = if stature > 0.0 { stature } else { 1.0 };
        let facing_yaw_rad = actors.first().map_or(0.0, Actor::facing_yaw_rad);
        let ground_height = actors
            .iter()
            .map(Actor::ground_height)
            .fold(f32::INFINITY, f32::min);
        let ground_height = if ground_height.is_finite() {
            ground_height
        } else {
            0.0
        };
        let places = places(&actors, &options, facing_yaw_rad, stature);
        let travel = actors.iter().map(Actor::travel).fold(0.0, f32::max);
        let follows = match options.follow {
            Follow::Never => false,
            Follow::Root => true,
            // Farther than this and the figure gets small in a picture of the whole way. Ghosts
            // need the whole way.
            Follow::Far => travel > stature && options.ghosts.is_none(),
        };
        let mut stage = Self {
            actors,
            options,
            places,
            stature,
            ground_height,
            facing_yaw_rad,
            follows,
            points: Vec::new(),
            surroundings: Surroundings::default(),
        };
        stage.points = stage.framed_points();
        stage
    }

    /// The actors.
    #[must_use]
    pub fn actors(&self) -> &[Actor] {
        &self.actors
    }

    /// Changes an actor in place, leaving where the actors stand and what the camera takes in as it
    /// is: for poses and motions that are edited. Does nothing when there is no such actor.
    pub fn edit_actor(&mut self, index: usize, edit: impl FnOnce(&mut Actor)) {
        if let Some(actor) = self.actors.get_mut(index) {
            edit(actor);
        }
    }

    /// The lights and objects that stand around.
    #[must_use]
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// Puts lights and objects around the actors. What the camera takes in stays as it is.
    pub fn set_surroundings(&mut self, surroundings: Surroundings) {
        self.surroundings = surroundings;
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &StageOptions {
        &self.options
    }

    /// Whether the camera goes along with the actors.
    #[must_use]
    pub fn follows(&self) -> bool {
        self.follows
    }

    /// Where each actor is moved to from where its motion says, world space.
    #[must_use]
    pub fn places(&self) -> &[Vec3] {
        &self.places
    }

    /// The height of the tallest actor, in the files' unit: everything is scaled by it.
    #[must_use]
    pub fn stature(&self) -> f32 {
        self.stature
    }

    /// Where the first actor faces in the mean, as a turn about Y from +Z, radians.
    #[must_use]
    pub fn facing_yaw_rad(&self) -> f32 {
        self.facing_yaw_rad
    }

    /// Y of the floor.
    #[must_use]
    pub fn ground_height(&self) -> f32 {
        self.ground_height
    }

    /// The longest motion's duration, seconds.
    #[must_use]
    pub fn duration_secs(&self) -> f64 {
        self.actors
            .iter()
            .map(|a| a.motion().duration_secs())
            .fold(0.0, f64::max)
    }

    /// How the camera stands at a time, for a picture of `aspect` = width / height. Changing it and
    /// passing it to [`scene_from`](Self::scene_from) is how a viewer orbits, pans and zooms.
    #[must_use]
    pub fn orbit(&self, time_secs: f64, aspect: f32) -> Orbit {
        self.orbit_from(time_secs, aspect, self.direction())
    }

    /// Like [`orbit`](Self::orbit), from a direction of the caller's: yaw and pitch in radians as
    /// in [`Orbit`], and a projection.
    #[must_use]
    pub fn orbit_from(
        &self,
        time_secs: f64,
        aspect: f32,
        (yaw_rad, pitch_rad, projection): (f32, f32, Projection),
    ) -> Orbit {
        let framing = Framing {
            yaw_rad,
            pitch_rad,
            projection,
            aspect,
            margin: 0.10,
            padding: 0.06 * self.stature,
        };
        let around = self.followed(time_secs);
        let framed = frame_points(self.points.iter().map(|&p| p + around), &framing);
        framed.unwrap_or(Orbit {
            target: Vec3::Y * (self.ground_height + 0.5 * self.stature),
            yaw_rad,
            pitch_rad,
            distance: 4.0 * self.stature,
            projection,
        })
    }

    /// The camera at a time.
    #[must_use]
    pub fn camera(&self, time_secs: f64, aspect: f32) -> Camera {
        match self.options.camera {
            CameraChoice::Fixed(camera) => camera,
            CameraChoice::View(_) | CameraChoice::Around { .. } => {
                self.orbit(time_secs, aspect).camera()
            }
        }
    }

    /// The scene at a time, for a picture of `aspect` = width / height. Times outside an actor's
    /// motion show its first or last frame.
    #[must_use]
    pub fn scene(&self, time_secs: f64, aspect: f32) -> Scene {
        self.scene_from(time_secs, self.camera(time_secs, aspect))
    }

    /// The scene at a time seen by a camera of the caller's.
    #[must_use]
    pub fn scene_from(&self, time_secs: f64, camera: Camera) -> Scene {
        let room = Room {
            theme: self.options.theme,
            size: self.stature,
            ground_height: self.ground_height,
            focus: self.focus(time_secs),
            radius: self.ground_radius(),
            unit: self.options.unit,
            yaw_from_above_rad: self.direction().0,
        };
        let mut scene = room.scene(camera);
        let grid_caption = scene.captions.pop();
        if let Some(background) = self.options.background {
            scene.background = background;
        }
        for (actor, &place) in self.actors.iter().zip(&self.places) {
            show::add_actor(&mut scene, self, actor, place, time_secs);
        }
        let figure = self.actors.first().map_or(self.stature, Actor::stature);
        let subject = match self.actors.first().zip(self.places.first()) {
            Some((actor, &place)) => actor.steady_root(time_secs) + place,
            None => self.focus(time_secs),
        };
        self.surroundings
            .add_to(&mut scene, figure, subject, time_secs);
        if !matches!(scene.background, Background::Transparent) {
            scene.captions.extend(grid_caption);
        }
        scene
    }

    fn direction(&self) -> (f32, f32, Projection) {
        let lens = Projection::Perspective {
            vertical_fov_rad: DEFAULT_VERTICAL_FOV_RAD,
        };
        match self.options.camera {
            CameraChoice::View(view) => {
                let (yaw, pitch) = view.yaw_pitch_rad(self.facing_yaw_rad);
                (yaw, pitch, lens)
            }
            CameraChoice::Around {
                yaw_rad,
                pitch_rad,
                projection,
            } => (self.facing_yaw_rad + yaw_rad, pitch_rad, projection),
            CameraChoice::Fixed(_) => (self.facing_yaw_rad, 0.2, lens),
        }
    }

    /// What the camera follows at a time, on the height of zero: zero when it stays.
    #[must_use]
    pub fn followed(&self, time_secs: f64) -> Vec3 {
        if !self.follows || self.actors.is_empty() {
            return Vec3::ZERO;
        }
        let sum: Vec3 = self
            .actors
            .iter()
            .zip(&self.places)
            .map(|(actor, &place)| actor.steady_root(time_secs) + place)
            .sum();
        let mean = sum / self.actors.len() as f32;
        Vec3::new(mean.x, 0.0, mean.z)
    }

    /// Where the floor is strongest.
    fn focus(&self, time_secs: f64) -> Vec3 {
        let middle = |points: &[Vec3]| {
            let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
            let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
            (low + high) * 0.5
        };
        if self.points.is_empty() {
            return Vec3::ZERO;
        }
        middle(&self.points) + self.followed(time_secs)
    }

    fn ground_radius(&self) -> f32 {
        let spread = |f: fn(&Vec3) -> f32| {
            let values = self.points.iter().map(f);
            let (low, high) = values.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            if high > low { high - low } else { 0.0 }
        };
        let extent = spread(|p| p.x).max(spread(|p| p.z));
        3.4 * self.stature + 0.9 * extent
    }

    /// The points of all actors that the camera must see.
    fn framed_points(&self) -> Vec<Vec3> {
        let mut points = Vec::new();
        for (actor, &place) in self.actors.iter().zip(&self.places) {
            for sample in actor.samples() {
                let around = if self.follows {
                    let mean = self.followed(sample.time_secs);
                    place - mean
                } else {
                    place
                };
                points.extend(sample.positions.iter().map(|&p| p + around));
                // Feet that leave the floor shall not drop out of the picture's middle.
                if let Some(&p) = sample.positions.first() {
                    points.push(Vec3::new(p.x, self.ground_height, p.z) + around);
                }
            }
        }
        points
    }
}

/// Where the actors stand.
fn places(
    actors: &[Actor],
    options: &StageOptions,
    facing_yaw_rad: f32,
    stature: f32,
) -> Vec<Vec3> {
    let ground = actors
        .iter()
        .map(Actor::ground_height)
        .fold(f32::INFINITY, f32::min);
    let onto_ground = |actor: &Actor| Vec3::Y * (ground - actor.ground_height());
    match options.arrangement {
        Arrangement::AsRecorded => vec![Vec3::ZERO; actors.len()],
        Arrangement::SideBySide => {
            let (sin, cos) = libm::sincosf(facing_yaw_rad);
            // The first stands to the left in a picture from the front.
            let across = Vec3::new(cos, 0.0, -sin);
            let widest = actors
                .iter()
                .map(|a| a.width_along(across))
                .fold(0.0, f32::max);
            let step = (widest + 0.25 * stature).clamp(0.7 * stature, 4.0 * stature);
            let middle = (actors.len() as f32 - 1.0) * 0.5;
            let slot = |(i, actor): (usize, &Actor)| {
                let start = actor.start();
                across * ((i as f32 - middle) * step) - Vec3::new(start.x, 0.0, start.z)
                    + onto_ground(actor)
            };
            actors.iter().enumerate().map(slot).collect()
        }
    }
}
