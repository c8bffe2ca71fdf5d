//! A motion with its body, and what is known about the room it takes.

use std::sync::Arc;

use glam::{Affine3, Mat3, Vec3};

use posekit::body::{Anatomy, NoAnatomy};
use posekit::motion::Motion;
use posekit::pose::{GlobalPose, LocalPose, forward_kinematics};
use posekit::skeleton::JointId;

use crate::character::{
    MOST_BODY_JOINTS, Proportions, axes_mesh, body_mesh, bone_mesh, octahedron_mesh,
};
use crate::mesh::Mesh;
use crate::theme::CharacterColors;

use super::options::{KeyGhost, SkeletonStyle};

/// How many poses of a motion are looked at to learn the room it takes.
const SAMPLES: usize = 160;

/// The camera follows the mean of the root over this long, seconds to either side: steps and jumps
/// do not shake it.
const STEADY_SECS: f64 = 0.5;
const STEADY_STEPS: i32 = 6;

/// A pose that was looked at.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub(super) time_secs: f64,
    /// Of the joints that belong to the figure, and of the tips of its parts.
    pub(super) positions: Vec<Vec3>,
}

/// A motion with its body.
#[derive(Clone, Debug)]
pub struct Actor {
    motion: Arc<Motion>,
    mesh: Arc<Mesh>,
    axes: Arc<Mesh>,
    loose: Vec<bool>,
    style: SkeletonStyle,
    colors: CharacterColors,
    stature: f32,
    doubt: Option<NoAnatomy>,
    ground_height: f32,
    facing_yaw_rad: f32,
    samples: Arc<[Sample]>,
    held: Option<Arc<GlobalPose>>,
    key_ghosts: Vec<KeyGhost>,
}

impl Actor {
    /// Fits a body of the given style to a motion's skeleton.
    #[must_use]
    pub fn new(motion: Arc<Motion>, style: SkeletonStyle, colors: CharacterColors) -> Self {
        let skeleton = motion.skeleton();
        let proportions = Proportions::of(&motion);
        let stature = proportions.stature;
        let mesh = Arc::new(match style {
            SkeletonStyle::Body => body_mesh(skeleton, &proportions),
            SkeletonStyle::Bones => bone_mesh(skeleton, &proportions),
            SkeletonStyle::Octahedra => octahedron_mesh(skeleton, &proportions),
            SkeletonStyle::Lines => Mesh::default(),
        });
        let axes = Arc::new(axes_mesh(skeleton, &proportions));
        let parts: Vec<JointId> = skeleton
            .joints()
            .filter(|&joint| proportions.is_part(skeleton, joint))
            .collect();
        let tips = tips(&mesh);
        let poses = sampled_poses(&motion);
        let ground_height = ground_height(&poses, &mesh);
        let facing_yaw_rad = facing_yaw(proportions.anatomy.as_ref().ok(), &poses);
        let doubt = proportions.doubt();
        let samples = poses
            .into_iter()
            .map(|(time_secs, pose)| {
                let joints = parts.iter().map(|joint| pose.positions[joint.index()]);
                let tips = tips
                    .iter()
                    .map(|&(joint, tip)| pose.transform_point(joint, tip));
                let positions = joints.chain(tips);
                Sample {
                    time_secs,
                    positions: positions.collect(),
                }
            })
            .collect();
        Self {
            motion,
            mesh,
            axes,
            loose: proportions.loose,
            style,
            colors,
            stature,
            doubt,
            ground_height,
            facing_yaw_rad,
            samples,
            held: None,
            key_ghosts: Vec::new(),
        }
    }

    /// The same figure in an edited version of its motion: body, floor and framing stay, so that
    /// nothing jumps while somebody works on it, and nothing is fitted anew.
    ///
    /// # Panics
    /// If the motion's skeleton has another number of joints.
    #[must_use]
    pub fn with_motion(&self, motion: Arc<Motion>) -> Self {
        assert_eq!(
            motion.skeleton().joint_count(),
            self.motion.skeleton().joint_count(),
            "a motion of the same skeleton"
        );
        Self {
            motion,
            held: None,
            ..self.clone()
        }
    }

    /// Gives it other colours.
    pub fn set_colors(&mut self, colors: CharacterColors) {
        self.colors = colors;
    }

    /// Shows the figure in a pose of the caller's, world space, whatever the time; ghosts and
    /// trails stay those of the motion. `None` shows the motion again.
    ///
    /// # Panics
    /// If the pose has not as many joints as the skeleton.
    pub fn hold(&mut self, pose: Option<Arc<GlobalPose>>) {
        if let Some(pose) = &pose {
            assert_eq!(
                pose.joint_count(),
                self.motion.skeleton().joint_count(),
                "a pose of this skeleton"
            );
        }
        self.held = pose;
    }

    /// Shows poses of its motion beside the figure, in place of those before.
    pub fn set_key_ghosts(&mut self, ghosts: Vec<KeyGhost>) {
        self.key_ghosts = ghosts;
    }

    /// The poses of its motion that are shown beside the figure.
    #[must_use]
    pub fn key_ghosts(&self) -> &[KeyGhost] {
        &self.key_ghosts
    }

    /// The world pose that the figure shows at a time: the one it is held in, or its motion's.
    #[must_use]
    pub fn shown_pose(&self, time_secs: f64) -> GlobalPose {
        match &self.held {
            Some(pose) => GlobalPose::clone(pose),
            None => self.pose(time_secs),
        }
    }

    /// The motion.
    #[must_use]
    pub fn motion(&self) -> &Arc<Motion> {
        &self.motion
    }

    /// The body's mesh, in the space of the joints; empty for [`SkeletonStyle::Lines`].
    #[must_use]
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// The style it was made in.
    #[must_use]
    pub fn style(&self) -> SkeletonStyle {
        self.style
    }

    /// Why its joints are drawn as bones although a body was asked for: the skeleton may be a person's,
    /// but which joint is what is in doubt. `None` in other styles and for everything else.
    #[must_use]
    pub fn doubt(&self) -> Option<NoAnatomy> {
        self.doubt.filter(|_| self.style == SkeletonStyle::Body)
    }

    /// Whether its joints are drawn as bones, although a body was asked for, because there are more than
    /// [`MOST_BODY_JOINTS`].
    #[must_use]
    pub fn has_too_many_joints(&self) -> bool {
        let joints = self.motion.skeleton().joint_count();
        self.style == SkeletonStyle::Body && joints > MOST_BODY_JOINTS
    }

    /// Its colours.
    #[must_use]
    pub fn colors(&self) -> &CharacterColors {
        &self.colors
    }

    /// Its height, in the file's unit.
    #[must_use]
    pub fn stature(&self) -> f32 {
        self.stature
    }

    /// Y of the floor it stands on: where its lowest part is in all but the lowest few frames.
    #[must_use]
    pub fn ground_height(&self) -> f32 {
        self.ground_height
    }

    /// Where it faces in the mean, as a turn about Y from +Z, radians.
    #[must_use]
    pub fn facing_yaw_rad(&self) -> f32 {
        self.facing_yaw_rad
    }

    /// The world pose at a time.
    #[must_use]
    pub fn pose(&self, time_secs: f64) -> GlobalPose {
        let skeleton = self.motion.skeleton();
        if self.motion.frame_count() == 0 {
            return GlobalPose::rest(skeleton);
        }
        let last = self.motion.duration_secs();
        self.motion
            .sample(time_secs.clamp(0.0, last))
            .to_global(skeleton)
    }

    /// Whether there is no bone between a joint and its parent.
    pub(super) fn is_loose(&self, joint: JointId) -> bool {
        self.loose[joint.index()]
    }

    pub(super) fn axes(&self) -> &Arc<Mesh> {
        &self.axes
    }

    pub(super) fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The greatest horizontal distance of the root from where it starts.
    pub(super) fn travel(&self) -> f32 {
        let start = self.start();
        let level = |p: Vec3| Vec3::new(p.x - start.x, 0.0, p.z - start.z).length();
        self.samples
            .iter()
            .map(|s| level(anchor(s)))
            .fold(0.0, f32::max)
    }

    /// Where the root starts.
    pub(super) fn start(&self) -> Vec3 {
        self.samples.first().map(anchor).unwrap_or_default()
    }

    /// How wide the whole motion is along a direction.
    pub(super) fn width_along(&self, direction: Vec3) -> f32 {
        let values = self
            .samples
            .iter()
            .flat_map(|s| &s.positions)
            .map(|p| p.dot(direction));
        let (low, high) = values.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        if high > low { high - low } else { 0.0 }
    }

    /// The middle of the body's joints, smoothed over time.
    pub(super) fn steady_root(&self, time_secs: f64) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut weights = 0.0;
        for step in -STEADY_STEPS..=STEADY_STEPS {
            let weight = (STEADY_STEPS + 1 - step.abs()) as f32;
            let time = time_secs + STEADY_SECS * f64::from(step) / f64::from(STEADY_STEPS);
            sum += self.root_at(time) * weight;
            weights += weight;
        }
        sum / weights
    }

    /// The root's position between the samples. Samples are dense enough for a camera.
    fn root_at(&self, time_secs: f64) -> Vec3 {
        let samples = &self.samples;
        let after = samples.partition_point(|s| s.time_secs <= time_secs);
        if after == 0 || after == samples.len() {
            let end = if after == 0 {
                samples.first()
            } else {
                samples.last()
            };
            return end.map(anchor).unwrap_or_default();
        }
        let (a, b) = (&samples[after - 1], &samples[after]);
        #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
        let t = ((time_secs - a.time_secs) / (b.time_secs - a.time_secs)) as f32;
        anchor(a).lerp(anchor(b), t)
    }
}

/// What stands for where a body is: the mean of its joints, which unlike the root is never a
/// reference point left lying on the floor.
fn anchor(sample: &Sample) -> Vec3 {
    sample.positions.iter().sum::<Vec3>() / sample.positions.len().max(1) as f32
}

/// World from joint for every joint of a pose, moved by `place`.
pub(super) fn transforms(pose: &GlobalPose, place: Vec3) -> Vec<Affine3> {
    pose.positions
        .iter()
        .zip(&pose.orientations)
        .map(|(&position, &orientation)| Affine3 {
            matrix3: Mat3::from_quat(orientation),
            translation: position + place,
        })
        .collect()
}

/// The vertex of each joint's part that is farthest from the joint: the crown, the finger tips.
fn tips(mesh: &Mesh) -> Vec<(JointId, Vec3)> {
    let mut tips = vec![Vec3::ZERO; mesh.joint_count()];
    for vertex in &mesh.vertices {
        let tip = &mut tips[vertex.joint as usize];
        if vertex.position.length_squared() > tip.length_squared() {
            *tip = vertex.position;
        }
    }
    let found = tips
        .into_iter()
        .enumerate()
        .filter(|(_, tip)| *tip != Vec3::ZERO);
    found
        .map(|(joint, tip)| (JointId::new(joint), tip))
        .collect()
}

fn sampled_poses(motion: &Motion) -> Vec<(f64, GlobalPose)> {
    let skeleton = motion.skeleton();
    let frames = motion.frame_count();
    if frames == 0 {
        return vec![(0.0, GlobalPose::rest(skeleton))];
    }
    let count = frames.min(SAMPLES);
    let mut local = LocalPose::rest(skeleton);
    (0..count)
        .map(|i| {
            let frame = if count == 1 {
                0
            } else {
                i * (frames - 1) / (count - 1)
            };
            motion.pose_into(frame, &mut local);
            let mut pose = GlobalPose::rest(skeleton);
            forward_kinematics(skeleton, &local, &mut pose);
            (frame as f64 * motion.frame_time_secs(), pose)
        })
        .filter(|(_, pose)| pose.positions.iter().all(|p| p.is_finite()))
        .collect()
}

/// Low enough for all but a twentieth of the frames: a noisy dip of a foot does not lift the whole
/// figure off the floor.
fn ground_height(poses: &[(f64, GlobalPose)], mesh: &Mesh) -> f32 {
    let lowest = |pose: &GlobalPose| {
        let joints = pose.positions.iter().map(|p| p.y);
        let balls = mesh.contact_balls.iter().map(|ball| {
            let joint = JointId::new(ball.joint as usize);
            pose.transform_point(joint, ball.center).y - ball.radius
        });
        if mesh.contact_balls.is_empty() {
            joints.fold(f32::INFINITY, f32::min)
        } else {
            balls.fold(f32::INFINITY, f32::min)
        }
    };
    let mut heights: Vec<f32> = poses.iter().map(|(_, pose)| lowest(pose)).collect();
    heights.sort_by(f32::total_cmp);
    heights
        .get(heights.len() / 20)
        .copied()
        .filter(|h| h.is_finite())
        .unwrap_or(0.0)
}

/// The mean of where a humanoid faces; where it turns all around, where it faces first. 0 for
/// others.
fn facing_yaw(anatomy: Option<&Anatomy>, poses: &[(f64, GlobalPose)]) -> f32 {
    let forwards: Vec<Vec3> = poses
        .iter()
        .filter_map(|(_, pose)| anatomy?.axes(pose))
        .map(|axes| Vec3::new(axes.forward.x, 0.0, axes.forward.z))
        .filter_map(Vec3::try_normalize)
        .collect();
    let sum: Vec3 = forwards.iter().sum();
    let decided = sum.length() > 0.4 * forwards.len() as f32;
    let direction = if decided {
        Some(sum)
    } else {
        forwards.first().copied()
    };
    direction.map_or(0.0, |d| libm::atan2f(d.x, d.z))
}
