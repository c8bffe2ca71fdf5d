//! The arm lab: robots of few joints, moved joint by joint or by their tips, and the numbers behind it.
//!
//! It has a bench with one robot on it, a camera of its own, and a list of the robots that were opened.
//! It knows no widget and no window. Metres and radians, Y up: a file's Z up is turned on the way in.

pub mod bench;
pub mod body;
pub mod factors;
pub mod mobility;
pub mod planar;
pub mod robot;
pub mod scene;
pub mod two_link;

use std::sync::Arc;

use glam::Vec3;
use posekit::mechanism::Freedom;
use posekit_formats::urdf;
use posekit_render::camera::{Camera, View};
use posekit_render::scene::Scene;

use crate::state::camera::ViewCamera;
use crate::state::display::Look;

pub use bench::Bench;
pub use robot::Robot;
pub use scene::Shown;

/// The sample that is put on the bench when nothing else is.
const FIRST: &str = "arm6";

/// More opened robots than this are not kept; the oldest go.
const MOST_OPENED: usize = 16;

/// A number of a file for the screen.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "a length or an angle for the screen; out of range becomes infinite"
)]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}

/// The lab.
#[derive(Debug)]
pub struct ArmLab {
    opened: Vec<Arc<Robot>>,
    bench: Option<Bench>,
    /// What is shown beside the robot.
    shown: Shown,
    /// The camera of the view.
    pub camera: ViewCamera,
    aspect: f32,
    snaps: bool,
    version: u64,
}

impl Default for ArmLab {
    fn default() -> Self {
        Self {
            opened: Vec::new(),
            bench: None,
            shown: Shown::default(),
            camera: ViewCamera::default(),
            aspect: 1.5,
            snaps: false,
            version: 0,
        }
    }
}

impl ArmLab {
    /// Puts a robot on the bench that was read from a file. One of the same name makes room for it.
    pub fn open(&mut self, robot: Robot) {
        let robot = self.keep(robot);
        self.put(robot);
    }

    /// Lists a robot that was read from a file, and leaves the one on the bench there.
    pub fn keep(&mut self, robot: Robot) -> Arc<Robot> {
        let robot = Arc::new(robot);
        self.opened.retain(|other| other.name != robot.name);
        self.opened.push(Arc::clone(&robot));
        if self.opened.len() > MOST_OPENED {
            self.opened.remove(0);
        }
        robot
    }

    /// Puts one of posekit's own robots on the bench. Does nothing for a name that is none.
    pub fn open_sample(&mut self, name: &str) {
        if let Some(robot) = Robot::sample(name) {
            self.put(Arc::new(robot));
        }
    }

    /// Puts a robot on the bench that was opened before.
    pub fn open_again(&mut self, name: &str) {
        let known = self.opened.iter().find(|robot| robot.name == name);
        if let Some(robot) = known.map(Arc::clone) {
            self.put(robot);
        }
    }

    /// Puts something on the bench if it is empty.
    pub fn fill(&mut self) {
        if self.bench.is_none() {
            self.open_sample(FIRST);
        }
    }

    fn put(&mut self, robot: Arc<Robot>) {
        self.bench = Some(Bench::new(robot));
        self.version += 1;
        self.look_from(View::ThreeQuarter);
    }

    /// The robots that come with posekit: names, and what they are.
    pub fn samples() -> impl Iterator<Item = (&'static str, &'static str)> {
        urdf::sample::names()
    }

    /// The robots that were opened from files, oldest first.
    #[must_use]
    pub fn opened(&self) -> &[Arc<Robot>] {
        &self.opened
    }

    /// The bench with the robot on it.
    #[must_use]
    pub fn bench(&self) -> Option<&Bench> {
        self.bench.as_ref()
    }

    /// Does something on the bench; it is shown anew.
    pub fn work<T>(&mut self, work: impl FnOnce(&mut Bench) -> T) -> Option<T> {
        self.version += 1;
        self.bench.as_mut().map(work)
    }

    /// Does something on the bench, which says whether there is something new to see.
    pub fn work_if(&mut self, work: impl FnOnce(&mut Bench) -> bool) {
        let is_new = self.bench.as_mut().is_some_and(work);
        self.version += u64::from(is_new);
    }

    /// What is shown beside the robot.
    #[must_use]
    pub fn shown(&self) -> Shown {
        self.shown
    }

    /// Changes what is shown.
    pub fn set_shown(&mut self, shown: Shown) {
        if self.shown != shown {
            self.shown = shown;
            self.version += 1;
        }
    }

    /// Whether the gizmo goes in steps without Ctrl.
    #[must_use]
    pub fn snaps(&self) -> bool {
        self.snaps
    }

    /// Sets whether the gizmo goes in steps.
    pub fn set_snaps(&mut self, snaps: bool) {
        self.snaps = snaps;
    }

    /// A number that changes whenever what is seen does.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.version
    }

    /// The look was changed: everything is drawn anew.
    pub fn redraw(&mut self) {
        self.version += 1;
    }

    /// How large what is on the bench is, for zooming.
    #[must_use]
    pub fn size(&self) -> f32 {
        self.bench
            .as_ref()
            .map_or(1.0, |bench| single(bench.robot().reach))
    }

    /// The camera now.
    #[must_use]
    pub fn view_camera(&self) -> Camera {
        self.camera.still().camera()
    }

    /// The scene now.
    #[must_use]
    pub fn scene(&self, look: Look) -> Scene {
        scene::scene(self.bench.as_ref(), self.shown, look, self.view_camera())
    }

    /// Tells the shape of the view, width over height.
    pub fn set_aspect(&mut self, aspect: f32) {
        let valid = aspect.is_finite() && aspect > 0.0;
        if valid && (aspect - self.aspect).abs() > 1e-3 {
            self.aspect = aspect;
            if self.camera.is_framed() {
                self.reframe();
            }
        }
    }

    /// Takes all that the robot can reach into the picture, from where the camera looks now.
    pub fn reframe(&mut self) {
        let orbit = self.camera.still();
        self.frame(orbit.yaw_rad, orbit.pitch_rad);
    }

    /// Looks from a named side. A planar arm is looked at from before its plane first.
    pub fn look_from(&mut self, view: View) {
        let facing = match self.bench.as_ref().and_then(Bench::planar) {
            Some(arm) => {
                let normal = arm.normal().as_vec3();
                let view = match view {
                    View::ThreeQuarter => View::Front,
                    view => view,
                };
                let yaw = libm::atan2f(normal.x, normal.z);
                let (yaw_rad, pitch_rad) = view.yaw_pitch_rad(yaw);
                self.frame(yaw_rad, pitch_rad);
                return;
            }
            None => 0.0,
        };
        let (yaw_rad, pitch_rad) = view.yaw_pitch_rad(facing);
        self.frame(yaw_rad, pitch_rad);
    }

    fn frame(&mut self, yaw_rad: f32, pitch_rad: f32) {
        let points = self.bench.as_ref().map_or_else(Vec::new, points_to_see);
        let padding = 0.04 * self.size();
        self.camera
            .frame_points(&points, (yaw_rad, pitch_rad), padding, self.aspect);
    }
}

/// What must be in the picture: the robot's foot, where it stands, and most of what it can reach.
fn points_to_see(bench: &Bench) -> Vec<Vec3> {
    let robot = bench.robot();
    let frames = bench.frames();
    let mut points: Vec<Vec3> = frames
        .iter()
        .map(|frame| frame.position.as_vec3())
        .collect();
    let ring = |turn: usize| {
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let angle = std::f64::consts::TAU * turn as f64 / 12.0;
        libm::sincos(angle)
    };
    if let Some(arm) = bench.planar() {
        let reach = arm.links.upper + arm.links.fore;
        points.extend((0..12).map(|turn| {
            let (sin, cos) = ring(turn);
            arm.in_world(glam::DVec2::new(cos, sin) * reach).as_vec3()
        }));
        return points;
    }
    let skeleton = robot.mechanism.skeleton();
    let shoulder = skeleton
        .joints()
        .find(|&joint| robot.mechanism.joint(joint).freedom != Freedom::Fixed);
    let middle = shoulder.map_or(Vec3::ZERO, |joint| frames[joint.index()].position.as_vec3());
    let reach = 0.8 * single(robot.reach);
    points.extend((0..12).map(|turn| {
        let (sin, cos) = ring(turn);
        middle + Vec3::new(single(sin), 0.0, single(cos)) * reach
    }));
    points.push(middle + Vec3::Y * reach);
    points
}
