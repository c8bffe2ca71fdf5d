//! What a scene file says.

use std::sync::Arc;

use glam::{DQuat, DVec3, Vec3};
use posekit::keyframe::{
    Animation, EulerTrack, KeyValue, KeyedCamera, KeyedLight, KeyedTransform, Property,
    RotationTrack, Track,
};
use posekit::motion::FrameTime;
use posekit::range::{LONGEST_LENGTH, LONGEST_SECS, are_lengths};
use posekit::rotation::EulerOrder;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder, SkeletonError};

/// Authored work: a skeleton, what plays on it, and what stands around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// What it is called; may be empty.
    pub title: String,
    /// From when to when it plays, in seconds.
    pub range_secs: [f64; 2],
    /// The rate that it is played and baked at.
    pub frames_per_sec: f64,
    /// The skeleton that moves.
    pub skeleton: SkeletonSource,
    /// Motions of files, in the order of their start.
    pub motions: Vec<MotionLayer>,
    /// The keyed joints. A keyed rotation or translation takes the place of what motions say of it.
    pub tracks: Vec<JointTrack>,
    /// The cameras; pictures are taken by the first one, or by the viewer's own where there is none.
    pub cameras: Vec<Camera>,
    /// Whether the studio light is on, the light that pictures have without any lights. A file that says
    /// nothing of it has it where it has no lights.
    pub studio_light: bool,
    /// The lights.
    pub lights: Vec<Light>,
    /// Objects that stand around.
    pub props: Vec<Prop>,
}

/// Where the skeleton comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum SkeletonSource {
    /// A motion or glTF file, its path relative to the scene's folder, or a clip of our own such as
    /// `sample:walk`.
    File(String),
    /// The joints themselves, a parent before its children.
    Inline(Vec<InlineJoint>),
}

/// What a scene takes from a file that it names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileRole {
    /// The skeleton alone.
    Skeleton,
    /// What it plays.
    Motion,
}

/// A joint of a skeleton that stands in the scene itself.
#[derive(Clone, Debug, PartialEq)]
pub struct InlineJoint {
    /// Its name.
    pub name: String,
    /// The index of its parent among the joints before it; `None` for a root.
    pub parent: Option<usize>,
    /// Its place in its parent's space at rest.
    pub translation: DVec3,
    /// Its rotation in its parent's space at rest.
    pub rotation: DQuat,
    /// Whether it only marks where its parent's link ends.
    pub is_end_site: bool,
}

/// A motion that plays on the skeleton, joints matched by name.
///
/// The layer whose start is the last one at or before a time is the one that plays. Before its start the
/// first one shows its first frame; past its end a layer keeps its last one.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionLayer {
    /// The file, its path relative to the scene's folder, or a clip of our own. `knight.glb#Walk` is an
    /// animation of a glTF file.
    pub file: String,
    /// When it starts in the scene, in seconds.
    pub start_secs: f64,
    /// From when to when of the file it plays, by the file's own clock; from its first frame or key to its last when
    /// not given.
    pub clip_secs: Option<[f64; 2]>,
}

/// A keyed joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointTrack {
    /// The joint's unique name (see [`Skeleton::unique_name`]).
    pub joint: String,
    /// What of it is keyed.
    pub values: JointValues,
}

/// What of a joint is keyed. Tracks are shared, so that a history can keep every state of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum JointValues {
    /// Its rotation in the parent's space as quaternions, which take the short way from key to key.
    Rotation {
        /// The keys.
        track: Arc<Track<DQuat>>,
        /// How the file writes them, if not as quaternions.
        euler: Option<EulerNotation>,
    },
    /// Its rotation in the parent's space as Euler curves: three angles that turn as far as they say.
    EulerRotation(Arc<EulerTrack>),
    /// Its translation in the parent's space, in place of the rest translation.
    Translation(Arc<Track<DVec3>>),
}

/// How the quaternions of a track are written: as Euler angles. These are not curves ([`JointValues::EulerRotation`]
/// is): a key stands for an orientation, whole turns and all.
#[derive(Clone, Debug, PartialEq)]
pub struct EulerNotation {
    /// The order of the axes.
    pub order: EulerOrder,
    /// The angles of each key as the file has them, in degrees. A key whose orientation is no longer
    /// that of its angles is written with new ones.
    pub angles_deg: Vec<[f64; 3]>,
}

/// A camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// What it is called.
    pub name: String,
    /// Where it is and what it sees.
    pub view: KeyedCamera,
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// What it is called.
    pub name: String,
    /// Where it is and how it shines.
    pub shine: KeyedLight,
}

/// An object.
#[derive(Clone, Debug, PartialEq)]
pub struct Prop {
    /// What it is called.
    pub name: String,
    /// What it looks like: `box`, `sphere`, or the path of a mesh file relative to the scene's folder.
    pub shape: String,
    /// Where it is.
    pub transform: KeyedTransform,
}

/// Why a scene does not fit its skeleton.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The skeleton has no joint of this name.
    #[error("the skeleton has no joint `{joint}`, which is keyed")]
    NoSuchJoint {
        /// The name.
        joint: String,
        /// The names of the joints that it has.
        joints: Vec<String>,
    },
    /// An End Site does not turn.
    #[error("joint `{joint}` is an End Site: its rotation cannot be keyed")]
    EndSiteTurns {
        /// The joint's name.
        joint: String,
    },
    /// The joints of the scene are no skeleton.
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
}

/// The most frames that a scene's range may have at its rate: more than a day at 60 a second, and few
/// enough that a slip of the pen does not ask for all memory there is.
pub(super) const MOST_FRAMES: f64 = 1e7;

/// The fastest rate, frames a second.
pub(super) const FASTEST: f64 = 10_000.0;

/// The time between two frames at a rate that a scene may have.
pub(super) fn frame_time(frames_per_sec: f64) -> Option<FrameTime> {
    let time = FrameTime::of_rate(frames_per_sec).ok();
    time.filter(|_| frames_per_sec <= FASTEST)
}

/// Why a scene cannot be written: its file would not be read.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneWriteError {
    /// The range is not within [`LONGEST_SECS`] of 0, or ends before it starts.
    #[error("a scene cannot play from {start_secs:?} s to {end_secs:?} s")]
    Range {
        /// Its start.
        start_secs: f64,
        /// Its end.
        end_secs: f64,
    },
    /// The rate is not one that a scene may have.
    #[error(
        "a scene plays at a rate from {:e} to {FASTEST} frames a second, not at {frames_per_sec:?}",
        1.0 / LONGEST_SECS
    )]
    Rate {
        /// Frames a second.
        frames_per_sec: f64,
    },
    /// The range is too long for its rate.
    #[error("a scene has at most {MOST_FRAMES:e} frames, not {frames:e}")]
    TooLong {
        /// How many it has.
        frames: f64,
    },
    /// A number of something that stands in the scene is beyond the range of what a scene holds, or not a number.
    #[error(
        "{of} has a number that is not within {LONGEST_LENGTH:e}, or a time not within {LONGEST_SECS:e} s"
    )]
    OutOfRange {
        /// What has it.
        of: &'static str,
    },
}

/// Whether a scene's file will be read again. Tracks are: what they hold was checked when they were made.
///
/// # Errors
/// [`SceneWriteError`] with the first thing that no reader takes.
pub fn check(scene: &Scene) -> Result<(), SceneWriteError> {
    let [start_secs, end_secs] = scene.range_secs;
    let is_time = |secs: f64| secs.abs() <= LONGEST_SECS;
    if !(is_time(start_secs) && is_time(end_secs) && start_secs <= end_secs) {
        return Err(SceneWriteError::Range {
            start_secs,
            end_secs,
        });
    }
    let frames_per_sec = scene.frames_per_sec;
    if frame_time(frames_per_sec).is_none() {
        return Err(SceneWriteError::Rate { frames_per_sec });
    }
    let frames = (end_secs - start_secs) * frames_per_sec;
    if frames > MOST_FRAMES {
        return Err(SceneWriteError::TooLong { frames });
    }
    if let SkeletonSource::Inline(joints) = &scene.skeleton {
        let is_in_range = |joint: &InlineJoint| {
            are_lengths(joint.translation.to_array()) && are_lengths(joint.rotation.to_array())
        };
        if !joints.iter().all(is_in_range) {
            return Err(SceneWriteError::OutOfRange {
                of: "a joint at rest",
            });
        }
    }
    let layers = scene.motions.iter().flat_map(|layer| {
        let clip = layer.clip_secs.unwrap_or_default();
        [layer.start_secs, clip[0], clip[1]]
    });
    if !layers.into_iter().all(is_time) {
        return Err(SceneWriteError::OutOfRange {
            of: "a motion's time",
        });
    }
    let surroundings = [
        ("a camera", scene.cameras.iter().all(Camera::is_in_range)),
        ("a light", scene.lights.iter().all(Light::is_in_range)),
        ("a prop", scene.props.iter().all(Prop::is_in_range)),
    ];
    match surroundings.into_iter().find(|(_, in_range)| !in_range) {
        Some((of, _)) => Err(SceneWriteError::OutOfRange { of }),
        None => Ok(()),
    }
}

/// Whether a value is one that a key may have. What is keyed was held against that already.
fn in_range<V: KeyValue>(property: &Property<V>) -> bool {
    match property {
        Property::Fixed(value) => Track::constant(*value).is_ok(),
        Property::Keyed(_) => true,
    }
}

impl Camera {
    fn is_in_range(&self) -> bool {
        let KeyedCamera {
            position,
            target,
            vertical_fov_deg,
        } = &self.view;
        in_range(position) && in_range(target) && in_range(vertical_fov_deg)
    }
}

impl Light {
    fn is_in_range(&self) -> bool {
        let KeyedLight {
            position,
            color,
            strength,
        } = &self.shine;
        in_range(position) && in_range(color) && in_range(strength)
    }
}

impl Prop {
    fn is_in_range(&self) -> bool {
        let KeyedTransform {
            translation,
            rotation,
            scale,
        } = &self.transform;
        in_range(translation) && in_range(rotation) && in_range(scale)
    }
}

impl Scene {
    /// A scene in which nothing happens for a second.
    pub fn new(skeleton: SkeletonSource) -> Self {
        Self {
            title: String::new(),
            range_secs: [0.0, 1.0],
            frames_per_sec: 30.0,
            skeleton,
            motions: Vec::new(),
            tracks: Vec::new(),
            cameras: Vec::new(),
            studio_light: true,
            lights: Vec::new(),
            props: Vec::new(),
        }
    }

    /// The files that it names, each once: that of the skeleton first, then those of the motions.
    pub fn files(&self) -> Vec<&str> {
        let skeleton = match &self.skeleton {
            SkeletonSource::File(path) => Some(path.as_str()),
            SkeletonSource::Inline(_) => None,
        };
        let motions = self.motions.iter().map(|layer| layer.file.as_str());
        let mut files: Vec<&str> = Vec::new();
        for file in skeleton.into_iter().chain(motions) {
            if !files.contains(&file) {
                files.push(file);
            }
        }
        files
    }

    /// What is taken from a file of this name: its motion, unless no layer plays it.
    pub fn role_of(&self, file: &str) -> FileRole {
        match self.motions.iter().any(|layer| layer.file == file) {
            true => FileRole::Motion,
            false => FileRole::Skeleton,
        }
    }

    /// The tracks as an animation of the skeleton.
    ///
    /// # Errors
    /// [`SceneError`] when the skeleton has no joint of a track's name, or one that cannot turn.
    pub fn animation(&self, skeleton: &Arc<Skeleton>) -> Result<Animation, SceneError> {
        let mut animation = Animation::new(Arc::clone(skeleton));
        for JointTrack { joint, values } in &self.tracks {
            let name = || joint.clone();
            let id = skeleton
                .find(joint)
                .ok_or_else(|| SceneError::NoSuchJoint {
                    joint: name(),
                    joints: skeleton
                        .joints()
                        .map(|joint| skeleton.unique_name(joint).to_owned())
                        .collect(),
                })?;
            animation = match values {
                JointValues::Rotation { .. } | JointValues::EulerRotation(_)
                    if skeleton.is_end_site(id) =>
                {
                    return Err(SceneError::EndSiteTurns { joint: name() });
                }
                JointValues::Rotation { track, .. } => {
                    animation.with_rotation(id, Some(Arc::clone(track)))
                }
                JointValues::EulerRotation(track) => {
                    animation.with_rotation(id, Some(Arc::clone(track)))
                }
                JointValues::Translation(track) => {
                    animation.with_translation(id, Some(Arc::clone(track)))
                }
            };
        }
        Ok(animation)
    }

    /// Takes an animation's tracks in place of its own. Tracks of joints that are still keyed keep
    /// their place in the file and the notation of their quaternions; new ones follow, joint by joint,
    /// quaternions written in Euler angles of `notation` or as such.
    pub fn set_animation(&mut self, animation: &Animation, notation: Option<EulerOrder>) {
        let skeleton = animation.skeleton();
        let mut tracks: Vec<JointTrack> = Vec::new();
        let mut done = vec![[false; 2]; skeleton.joint_count()];
        for old in std::mem::take(&mut self.tracks) {
            let Some(joint) = skeleton.find(&old.joint) else {
                continue;
            };
            let (kind, values) = match old.values {
                JointValues::Rotation { euler, .. } => {
                    let track = animation.rotation(joint);
                    (0, track.map(|track| rotation(track, euler)))
                }
                JointValues::EulerRotation(old) => {
                    let order = old.order();
                    let euler = EulerNotation {
                        order,
                        angles_deg: Vec::new(),
                    };
                    let track = animation.rotation(joint);
                    (0, track.map(|track| rotation(track, Some(euler))))
                }
                JointValues::Translation(_) => (1, animation.translation(joint).map(translation)),
            };
            if let (false, Some(values)) = (done[joint.index()][kind], values) {
                done[joint.index()][kind] = true;
                tracks.push(JointTrack {
                    joint: old.joint,
                    values,
                });
            }
        }
        let euler = notation.map(|order| EulerNotation {
            order,
            angles_deg: Vec::new(),
        });
        for joint in skeleton.joints() {
            let name = || skeleton.unique_name(joint).to_owned();
            let new = |kind: usize| !done[joint.index()][kind];
            if let Some(track) = animation.translation(joint).filter(|_| new(1)) {
                tracks.push(JointTrack {
                    joint: name(),
                    values: translation(track),
                });
            }
            if let Some(track) = animation.rotation(joint).filter(|_| new(0)) {
                tracks.push(JointTrack {
                    joint: name(),
                    values: rotation(track, euler.clone()),
                });
            }
        }
        self.tracks = tracks;
    }
}

/// A rotation's values; quaternions in a notation.
fn rotation(track: &RotationTrack, euler: Option<EulerNotation>) -> JointValues {
    match track {
        RotationTrack::Euler(track) => JointValues::EulerRotation(Arc::clone(track)),
        RotationTrack::Quaternion(track) => JointValues::Rotation {
            track: Arc::clone(track),
            euler,
        },
    }
}

fn translation(track: &Arc<Track<DVec3>>) -> JointValues {
    JointValues::Translation(Arc::clone(track))
}

impl SkeletonSource {
    /// The joints of a skeleton, to stand in the scene itself. `f32` values are written as the shortest
    /// decimals that give them back.
    pub fn inline(skeleton: &Skeleton) -> Self {
        let joint = |id: JointId| InlineJoint {
            name: skeleton.name(id).to_owned(),
            parent: skeleton.parent(id).map(JointId::index),
            translation: shortest(skeleton.rest_translation(id)),
            rotation: skeleton.rest_rotation(id).as_dquat(),
            is_end_site: skeleton.is_end_site(id),
        };
        Self::Inline(skeleton.joints().map(joint).collect())
    }

    /// The skeleton of joints that stand in the scene; `None` when it comes from a file.
    ///
    /// # Errors
    /// [`SkeletonError`] when the joints are no skeleton.
    pub fn inline_skeleton(&self) -> Option<Result<Skeleton, SkeletonError>> {
        let Self::Inline(joints) = self else {
            return None;
        };
        let mut builder = SkeletonBuilder::new();
        for joint in joints {
            let name = joint.name.clone();
            let at = joint.translation.as_vec3();
            match joint.parent.map(JointId::new) {
                Some(parent) if joint.is_end_site => builder.end_site(name, parent, at),
                parent => builder.oriented_joint(name, parent, at, joint.rotation.as_quat()),
            };
        }
        Some(builder.build())
    }
}

/// The `f64` whose shortest decimal is that of the `f32`: 0.1 and not 0.10000000149.
fn shortest(v: Vec3) -> DVec3 {
    let mut text = crate::number_text::NumberText::default();
    let parts = v
        .to_array()
        .map(|part| text.of(part).parse().unwrap_or(f64::from(part)));
    DVec3::from_array(parts)
}
