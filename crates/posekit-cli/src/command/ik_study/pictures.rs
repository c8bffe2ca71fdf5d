//! Pictures of poses: the figure, pale; the chain, strong; where it started, thin; the target, red, with a
//! line to it from the end that missed it.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{Affine3, Vec3};
use posekit::pose::{GlobalPose, LocalPose};
use posekit_render::camera::{Camera, DEFAULT_VERTICAL_FOV_RAD, Projection, View};
use posekit_render::color::Color;
use posekit_render::cpu::CpuRenderer;
use posekit_render::framing::{Framing, frame_points};
use posekit_render::mesh::{MATERIAL_COUNT, MaterialId, Mesh, Shape};
use posekit_render::output::write_png;
use posekit_render::scene::{Label, Model, Polyline, Scene, Shadow};
use posekit_render::stage::{Follow, Stage, StageOptions};
use posekit_render::theme::CharacterColors;

use super::document::Shot;
use super::experiment::{Cell, pose_of};
use super::linkage::StudiedChain;
use super::setup::Study;
use super::targets::{Kind, Target};
use crate::failure::Failure;
use crate::jobs;
use crate::progress::Progress;

/// Of a picture in a table, in pixels.
const SMALL: [u32; 2] = [264, 300];
/// Of the picture of the start.
const LARGE: [u32; 2] = [760, 560];

/// What is left free around points, in statures: half a limb; and so much more from near that an elbow which bends
/// out stays in the picture, and so does what the chain hangs on.
const WIDE_PADDING: f32 = 0.06;
const NEAR_PADDING: f32 = 0.11;

/// The chain.
const CHAIN: u32 = 0x1F_5F_A8;
/// Its joints.
const JOINT: u32 = 0x0F_2E_52;
/// The target and what is missing to it.
const TARGET: u32 = 0xD4_2A_1E;
/// Where the chain started.
const BEFORE: u32 = 0x8A_93_9F;

/// Takes all pictures, as PNG files.
pub(super) fn take(
    study: &Study,
    shots: &[Shot],
    workers: NonZeroUsize,
    quiet: bool,
) -> Result<Vec<Vec<u8>>, Failure> {
    let photographer = Photographer::new(study);
    let progress = Progress::steps(shots.len(), "pictures", quiet);
    let mut pictures = Vec::with_capacity(shots.len());
    let mut problem = None;
    jobs::in_order(
        shots.len(),
        workers,
        |index| photographer.take(&shots[index]),
        |_, worked| {
            progress.advance("");
            match worked {
                Ok(Ok(picture)) => {
                    pictures.push(picture);
                    ControlFlow::Continue(())
                }
                Ok(Err(error)) => {
                    problem = Some(error);
                    ControlFlow::Break(())
                }
                Err(_panic) => {
                    problem = Some("an internal error, which is a bug in posekit".to_owned());
                    ControlFlow::Break(())
                }
            }
        },
    );
    match problem {
        Some(error) => Err(Failure::new(format!("cannot draw a picture: {error}"))),
        None => Ok(pictures),
    }
}

/// What all pictures share.
struct Photographer<'a> {
    study: &'a Study,
    stage: Stage,
    /// For each chain the camera of the pictures of its named targets, so that they can be compared.
    near: Vec<Camera>,
    /// As that for the pictures of the grid.
    wide: Vec<Camera>,
    /// As that for the picture of the start.
    large: Vec<Camera>,
    stature: f32,
}

impl<'a> Photographer<'a> {
    fn new(study: &'a Study) -> Self {
        let actor = study.actor.clone();
        let stature = actor.stature();
        let options = StageOptions {
            follow: Follow::Never,
            ..StageOptions::default()
        };
        let stage = Stage::new(vec![actor], options);
        let wide = |[width, height]: [u32; 2]| {
            let aspect = width as f32 / height as f32;
            let chains = 0..study.chains.len();
            chains
                .map(|chain| wide_camera(study, chain, aspect, stature))
                .collect()
        };
        let chains = 0..study.chains.len();
        Self {
            study,
            near: chains
                .map(|chain| near_camera(study, chain, &[], stature))
                .collect(),
            wide: wide(SMALL),
            large: wide(LARGE),
            stage,
            stature,
        }
    }

    fn take(&self, shot: &Shot) -> Result<Vec<u8>, String> {
        let (scene, [width, height]) = match shot {
            Shot::Start(chain) => (self.start(*chain), LARGE),
            Shot::Run(cell) => (self.run(*cell), SMALL),
        };
        let image = CpuRenderer::new(NonZeroUsize::MIN).render(&scene, width, height);
        let mut png = Vec::new();
        write_png(&image, &mut png).map_err(|error| error.to_string())?;
        Ok(png)
    }

    fn start(&self, index: usize) -> Scene {
        let chain = &self.study.chains[index];
        let (mut scene, pose) = self.scene(&self.study.start, self.large[index]);
        self.add_chain(&mut scene, chain, &pose);
        let targets = &self.study.targets[index];
        for target in targets.iter().filter(|target| target.kind == Kind::Named) {
            self.add_target(&mut scene, target, 1.0);
            self.label(&mut scene, &target.name, target.place.as_vec3(), TARGET);
        }
        for target in targets
            .iter()
            .filter(|target| matches!(target.kind, Kind::Grid { .. }))
        {
            self.add_target(&mut scene, target, 0.45);
        }
        for joint in [chain.chain.start(), chain.chain.end()] {
            let name = self.study.skeleton.unique_name(joint);
            self.label(&mut scene, name, pose.positions[joint.index()], JOINT);
        }
        scene
    }

    fn run(&self, cell: Cell) -> Scene {
        let chain = &self.study.chains[cell.chain];
        let target = &self.study.targets[cell.chain][cell.target];
        let pose = pose_of(self.study, cell);
        let camera = match target.kind {
            Kind::Named => self.near[cell.chain],
            Kind::Grid { .. } => self.wide[cell.chain],
            Kind::Reachable | Kind::Unreachable => {
                let global = pose.to_global(&self.study.skeleton);
                let joints = chain.chain.joints().iter();
                let mut points: Vec<Vec3> = joints
                    .map(|joint| global.positions[joint.index()])
                    .collect();
                points.push(target.place.as_vec3());
                near_camera(self.study, cell.chain, &points, self.stature)
            }
        };
        let (mut scene, pose) = self.scene(&pose, camera);
        let before = self.study.start.to_global(&self.study.skeleton);
        let points = chain.chain.joints().iter();
        let points = points.map(|joint| (before.positions[joint.index()], Color::from_hex(BEFORE)));
        scene.polylines.push(Polyline {
            points: points.collect(),
            width: 4.0,
            opacity: 1.0,
        });
        self.add_chain(&mut scene, chain, &pose);
        self.add_target(&mut scene, target, 1.0);
        let red = Color::from_hex(TARGET);
        scene.polylines.push(Polyline {
            points: vec![
                (chain.end_in(&pose).as_vec3(), red),
                (target.place.as_vec3(), red),
            ],
            width: 6.0,
            opacity: 1.0,
        });
        scene
    }

    /// The figure in a pose, without captions.
    fn scene(&self, pose: &LocalPose, camera: Camera) -> (Scene, GlobalPose) {
        let global = pose.to_global(&self.study.skeleton);
        let mut stage = self.stage.clone();
        stage.edit_actor(0, |actor| actor.hold(Some(Arc::new(global.clone()))));
        let mut scene = stage.scene_from(0.0, camera);
        scene.captions.clear();
        let palette = CharacterColors::of(0)
            .mixed(Color::from_hex(0xE4_E8_ED), 0.55)
            .palette();
        for model in &mut scene.models {
            model.palette = palette;
        }
        (scene, global)
    }

    fn add_chain(&self, scene: &mut Scene, chain: &StudiedChain, pose: &GlobalPose) {
        let at = |joint: &posekit::skeleton::JointId| pose.positions[joint.index()];
        let (bone, ball) = (0.017 * self.stature, 0.024 * self.stature);
        let mut mesh = Mesh::default();
        for pair in chain.chain.joints().windows(2) {
            let capsule = Shape::tapered_capsule(at(&pair[0]), bone, at(&pair[1]), bone, 16);
            mesh.add(&capsule, 0, MaterialId::Base);
        }
        for joint in &chain.turning {
            mesh.add(&Shape::ball(at(joint), ball, 20), 0, MaterialId::Accent);
        }
        let end = chain.end_in(pose).as_vec3();
        mesh.add(&Shape::ball(end, 0.75 * ball, 20), 0, MaterialId::Accent);
        add_model(scene, mesh, CHAIN, JOINT);
    }

    fn add_target(&self, scene: &mut Scene, target: &Target, size: f32) {
        let mut mesh = Mesh::default();
        let radius = 0.036 * self.stature * size;
        mesh.add(
            &Shape::ball(target.place.as_vec3(), radius, 24),
            0,
            MaterialId::Base,
        );
        add_model(scene, mesh, TARGET, TARGET);
    }

    fn label(&self, scene: &mut Scene, text: &str, position: Vec3, color: u32) {
        scene.labels.push(Label {
            position,
            text: text.to_owned(),
            color: Color::from_hex(color),
            size: 22.0,
        });
    }
}

fn add_model(scene: &mut Scene, mesh: Mesh, base: u32, accent: u32) {
    let mut palette = [Color::from_hex(base); MATERIAL_COUNT];
    palette[MaterialId::Accent as usize] = Color::from_hex(accent);
    scene.models.push(Model {
        mesh: Arc::new(mesh),
        joints: vec![Affine3::IDENTITY],
        palette,
        opacity: 1.0,
        shadow: Shadow::None,
    });
}

/// A camera that sees the whole figure and, of a chain, the targets with names and those of the grid.
fn wide_camera(study: &Study, chain: usize, aspect: f32, stature: f32) -> Camera {
    let start = study.start.to_global(&study.skeleton);
    let shared = study.targets[chain]
        .iter()
        .filter(|target| matches!(target.kind, Kind::Named | Kind::Grid { .. }));
    let places = shared.map(|target| target.place.as_vec3());
    let points = start.positions.iter().copied().chain(places);
    framed(study, points, aspect, WIDE_PADDING * stature)
}

/// A camera that sees a chain where it starts, the targets with names, and more points.
fn near_camera(study: &Study, chain: usize, more: &[Vec3], stature: f32) -> Camera {
    let start = study.start.to_global(&study.skeleton);
    let joints = study.chains[chain].chain.joints().iter();
    let joints = joints.map(|joint| start.positions[joint.index()]);
    let named = study.targets[chain]
        .iter()
        .filter(|target| target.kind == Kind::Named);
    let named = named.map(|target| target.place.as_vec3());
    let aspect = SMALL[0] as f32 / SMALL[1] as f32;
    let points = joints.chain(named).chain(more.iter().copied());
    framed(study, points, aspect, NEAR_PADDING * stature)
}

fn framed(
    study: &Study,
    points: impl IntoIterator<Item = Vec3>,
    aspect: f32,
    padding: f32,
) -> Camera {
    let (yaw_rad, pitch_rad) = View::ThreeQuarter.yaw_pitch_rad(study.actor.facing_yaw_rad());
    let framing = Framing {
        yaw_rad,
        pitch_rad,
        projection: Projection::Perspective {
            vertical_fov_rad: DEFAULT_VERTICAL_FOV_RAD,
        },
        aspect,
        margin: 0.04,
        padding,
    };
    match frame_points(points, &framing) {
        Some(orbit) => orbit.camera(),
        None => Stage::new(vec![study.actor.clone()], StageOptions::default()).camera(0.0, aspect),
    }
}
