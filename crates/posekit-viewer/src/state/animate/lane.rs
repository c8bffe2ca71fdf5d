//! Lanes: the properties of a scene that can be keyed, each a line of the dope sheet and curves of the
//! graph editor.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::keyframe::{
    ConvertConfig, EulerTrack, Extrapolation, Interpolation, Property, RotationTrack, Track,
    to_euler,
};
use posekit::rotation::EulerOrder;
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::scene::{EulerNotation, JointTrack, JointValues, Scene};

/// A property that can be keyed. Cameras, lights and props are counted as the scene lists them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Lane {
    /// A joint's rotation in its parent's space.
    Rotation(JointId),
    /// A joint's translation in its parent's space.
    Translation(JointId),
    /// Where a camera stands.
    CameraPosition(usize),
    /// What a camera looks at.
    CameraTarget(usize),
    /// A camera's angle of view, degrees.
    CameraFov(usize),
    /// Where a light stands.
    LightPosition(usize),
    /// A light's colour.
    LightColor(usize),
    /// A light's strength.
    LightStrength(usize),
    /// Where a prop stands.
    PropTranslation(usize),
    /// How a prop is turned.
    PropRotation(usize),
    /// How large a prop is.
    PropScale(usize),
}

/// What a lane belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Owner {
    /// A joint.
    Joint(JointId),
    /// A camera.
    Camera(usize),
    /// A light.
    Light(usize),
    /// A prop.
    Prop(usize),
}

impl Owner {
    /// The lanes that it has, keyed or not.
    #[must_use]
    pub fn lanes(self) -> Vec<Lane> {
        match self {
            Self::Joint(joint) => vec![Lane::Rotation(joint), Lane::Translation(joint)],
            Self::Camera(index) => vec![
                Lane::CameraPosition(index),
                Lane::CameraTarget(index),
                Lane::CameraFov(index),
            ],
            Self::Light(index) => vec![
                Lane::LightPosition(index),
                Lane::LightColor(index),
                Lane::LightStrength(index),
            ],
            Self::Prop(index) => vec![
                Lane::PropTranslation(index),
                Lane::PropRotation(index),
                Lane::PropScale(index),
            ],
        }
    }

    /// Its name. What it is stands before it where the name does not say so itself: `Light lamp`, and `key light`.
    #[must_use]
    pub fn name(self, scene: &Scene, skeleton: &Skeleton) -> String {
        let named = |kind: &str, index: usize, name: Option<&String>| match name {
            Some(name) if says_kind(name, kind) => name.clone(),
            Some(name) if !name.is_empty() => format!("{kind} {name}"),
            _ => format!("{kind} {}", index + 1),
        };
        match self {
            Self::Joint(joint) => skeleton.unique_name(joint).to_owned(),
            Self::Camera(i) => named("Camera", i, scene.cameras.get(i).map(|it| &it.name)),
            Self::Light(i) => named("Light", i, scene.lights.get(i).map(|it| &it.name)),
            Self::Prop(i) => named("Prop", i, scene.props.get(i).map(|it| &it.name)),
        }
    }
}

/// Whether one of a name's words is what the thing is.
fn says_kind(name: &str, kind: &str) -> bool {
    let shapes: &[&str] = if kind == "Prop" {
        &["box", "sphere", "ball"]
    } else {
        &[]
    };
    let mut words = name.split(|c: char| !c.is_alphabetic());
    words.any(|word| {
        word.eq_ignore_ascii_case(kind) || shapes.iter().any(|it| word.eq_ignore_ascii_case(it))
    })
}

impl Lane {
    /// What it belongs to.
    #[must_use]
    pub fn owner(self) -> Owner {
        match self {
            Self::Rotation(joint) | Self::Translation(joint) => Owner::Joint(joint),
            Self::CameraPosition(i) | Self::CameraTarget(i) | Self::CameraFov(i) => {
                Owner::Camera(i)
            }
            Self::LightPosition(i) | Self::LightColor(i) | Self::LightStrength(i) => {
                Owner::Light(i)
            }
            Self::PropTranslation(i) | Self::PropRotation(i) | Self::PropScale(i) => Owner::Prop(i),
        }
    }

    /// What it is of its owner.
    #[must_use]
    pub const fn property(self) -> &'static str {
        match self {
            Self::Rotation(_) | Self::PropRotation(_) => "Rotation",
            Self::Translation(_) | Self::PropTranslation(_) => "Translation",
            Self::CameraPosition(_) | Self::LightPosition(_) => "Position",
            Self::CameraTarget(_) => "Target",
            Self::CameraFov(_) => "View angle",
            Self::LightColor(_) => "Colour",
            Self::LightStrength(_) => "Strength",
            Self::PropScale(_) => "Scale",
        }
    }

    /// Its name in full: the owner's and the property's.
    #[must_use]
    pub fn label(self, scene: &Scene, skeleton: &Skeleton) -> String {
        let owner = self.owner().name(scene, skeleton);
        format!("{owner} \u{b7} {}", self.property().to_lowercase())
    }
}

/// A key: its lane, and its place among the lane's keys, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct KeyId {
    /// The lane.
    pub lane: Lane,
    /// The place among its keys.
    pub index: usize,
}

/// A lane's track, to look at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LaneTrack<'a> {
    /// Of a number.
    Number(&'a Track<f64>),
    /// Of a vector.
    Vector(&'a Track<DVec3>),
    /// Of an orientation, as quaternions.
    Orientation(&'a Track<DQuat>),
    /// Of an orientation, as Euler curves.
    Euler(&'a EulerTrack),
}

/// Does the same with a track of any kind.
macro_rules! of_any_kind {
    ($value:expr, $track:ident => $does:expr) => {
        match $value {
            LaneTrack::Number($track) => $does,
            LaneTrack::Vector($track) => $does,
            LaneTrack::Orientation($track) => $does,
            LaneTrack::Euler(euler) => {
                let $track = euler.angles_deg();
                $does
            }
        }
    };
}

impl LaneTrack<'_> {
    /// How many keys it has: at least one.
    #[must_use]
    pub fn key_count(&self) -> usize {
        self.times_secs().len()
    }

    /// The times of its keys in seconds of the scene, in rising order.
    #[must_use]
    pub fn times_secs(&self) -> &[f64] {
        of_any_kind!(self, track => track.times_secs())
    }

    /// How a key goes on to the next one.
    ///
    /// # Panics
    /// If there is no such key.
    #[must_use]
    pub fn interpolation(&self, index: usize) -> Interpolation {
        of_any_kind!(self, track => track.keys()[index].interpolation)
    }

    /// How it goes on before its first and after its last key.
    #[must_use]
    pub fn beyond(&self) -> [Extrapolation; 2] {
        of_any_kind!(self, track => [track.before(), track.after()])
    }

    /// The same, owned.
    #[must_use]
    pub fn to_value(&self) -> TrackValue {
        match *self {
            LaneTrack::Number(track) => TrackValue::Number(track.clone()),
            LaneTrack::Vector(track) => TrackValue::Vector(track.clone()),
            LaneTrack::Orientation(track) => TrackValue::Orientation(track.clone()),
            LaneTrack::Euler(track) => TrackValue::Euler(track.clone()),
        }
    }
}

/// A lane's track as a value: what an edit makes.
#[derive(Clone, Debug, PartialEq)]
pub enum TrackValue {
    /// Of a number.
    Number(Track<f64>),
    /// Of a vector.
    Vector(Track<DVec3>),
    /// Of an orientation, as quaternions.
    Orientation(Track<DQuat>),
    /// Of an orientation, as Euler curves.
    Euler(EulerTrack),
}

impl From<RotationTrack> for TrackValue {
    fn from(track: RotationTrack) -> Self {
        match track {
            RotationTrack::Quaternion(track) => Self::Orientation(Arc::unwrap_or_clone(track)),
            RotationTrack::Euler(track) => Self::Euler(Arc::unwrap_or_clone(track)),
        }
    }
}

impl<'a> From<&'a RotationTrack> for LaneTrack<'a> {
    fn from(track: &'a RotationTrack) -> Self {
        match track {
            RotationTrack::Quaternion(track) => Self::Orientation(track),
            RotationTrack::Euler(track) => Self::Euler(track),
        }
    }
}

impl TrackValue {
    /// To look at.
    #[must_use]
    pub fn as_track(&self) -> LaneTrack<'_> {
        match self {
            Self::Number(track) => LaneTrack::Number(track),
            Self::Vector(track) => LaneTrack::Vector(track),
            Self::Orientation(track) => LaneTrack::Orientation(track),
            Self::Euler(track) => LaneTrack::Euler(track),
        }
    }
}

/// The value of a lane at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LaneValue {
    /// A number.
    Number(f64),
    /// A vector.
    Vector(DVec3),
    /// An orientation.
    Orientation(DQuat),
}

/// A property of a camera, a light or a prop.
pub(super) enum PropertyRef<'a> {
    Number(&'a Property<f64>),
    Vector(&'a Property<DVec3>),
    Orientation(&'a Property<DQuat>),
}

impl<'a> PropertyRef<'a> {
    /// The one that a lane stands for; `None` for a joint's, and where the scene has no such thing.
    pub(super) fn of(scene: &'a Scene, lane: Lane) -> Option<Self> {
        Some(match lane {
            Lane::Rotation(_) | Lane::Translation(_) => return None,
            Lane::CameraPosition(i) => Self::Vector(&scene.cameras.get(i)?.view.position),
            Lane::CameraTarget(i) => Self::Vector(&scene.cameras.get(i)?.view.target),
            Lane::CameraFov(i) => Self::Number(&scene.cameras.get(i)?.view.vertical_fov_deg),
            Lane::LightPosition(i) => Self::Vector(&scene.lights.get(i)?.shine.position),
            Lane::LightColor(i) => Self::Vector(&scene.lights.get(i)?.shine.color),
            Lane::LightStrength(i) => Self::Number(&scene.lights.get(i)?.shine.strength),
            Lane::PropTranslation(i) => Self::Vector(&scene.props.get(i)?.transform.translation),
            Lane::PropRotation(i) => Self::Orientation(&scene.props.get(i)?.transform.rotation),
            Lane::PropScale(i) => Self::Vector(&scene.props.get(i)?.transform.scale),
        })
    }

    pub(super) fn track(&self) -> Option<LaneTrack<'a>> {
        match self {
            Self::Number(property) => property.track().map(LaneTrack::Number),
            Self::Vector(property) => property.track().map(LaneTrack::Vector),
            Self::Orientation(property) => property.track().map(LaneTrack::Orientation),
        }
    }

    pub(super) fn at(&self, time_secs: f64) -> LaneValue {
        match self {
            Self::Number(property) => LaneValue::Number(property.at(time_secs)),
            Self::Vector(property) => LaneValue::Vector(property.at(time_secs)),
            Self::Orientation(property) => LaneValue::Orientation(property.at(time_secs)),
        }
    }
}

/// Puts a track into a scene, or takes it away: then the property keeps the value that it has at a
/// time. False where the scene has no such property, or one of another kind.
pub(super) fn put_track(
    scene: &mut Scene,
    skeleton: &Skeleton,
    lane: Lane,
    track: Option<TrackValue>,
    now_secs: f64,
) -> bool {
    match (lane, track) {
        (Lane::Rotation(joint), Some(TrackValue::Orientation(track))) => {
            put_rotation(scene, skeleton, joint, track.into())
        }
        (Lane::Rotation(joint), Some(TrackValue::Euler(track))) => {
            put_rotation(scene, skeleton, joint, track.into())
        }
        (Lane::Translation(joint), Some(TrackValue::Vector(track))) => {
            put_translation(scene, skeleton, joint, Arc::new(track));
            true
        }
        (Lane::Rotation(_) | Lane::Translation(_), None) => {
            scene
                .tracks
                .retain(|track| lane_of(track, skeleton) != Some(lane));
            true
        }
        (Lane::Rotation(_) | Lane::Translation(_), Some(_)) => false,
        (_, track) => put_property(scene, lane, track, now_secs),
    }
}

/// The lane that a track of a scene is.
fn lane_of(track: &JointTrack, skeleton: &Skeleton) -> Option<Lane> {
    let joint = skeleton.find(&track.joint)?;
    Some(match track.values {
        JointValues::Rotation { .. } | JointValues::EulerRotation(_) => Lane::Rotation(joint),
        JointValues::Translation(_) => Lane::Translation(joint),
    })
}

/// A rotation that is keyed newly, with a first key, is keyed as the scene keys others: in the mode of the
/// first that there is. Quaternions are written in the Euler order of the first that has one.
fn put_rotation(
    scene: &mut Scene,
    skeleton: &Skeleton,
    joint: JointId,
    new: RotationTrack,
) -> bool {
    if joint.index() >= skeleton.joint_count() || skeleton.is_end_site(joint) {
        return false;
    }
    let lane = Some(Lane::Rotation(joint));
    let mut notation = None;
    let mut curves = None;
    for old in &mut scene.tracks {
        let is_it = lane_of(old, skeleton) == lane;
        let (order, is_curves) = match &old.values {
            JointValues::Rotation { euler, .. } => (euler.as_ref().map(|euler| euler.order), false),
            JointValues::EulerRotation(track) => (Some(track.order()), true),
            JointValues::Translation(_) => continue,
        };
        if is_it {
            match (&mut old.values, new) {
                // The angles of keys that stay are kept as the file has them.
                (JointValues::Rotation { track, .. }, RotationTrack::Quaternion(new)) => {
                    *track = new;
                }
                (values, new) => *values = rotation_values(new, order),
            }
            return true;
        }
        notation = notation.or(order);
        curves = curves.or(Some(order.filter(|_| is_curves)));
    }
    let first_key = new.as_quaternion().filter(|track| track.keys().len() == 1);
    let in_curves = first_key.zip(curves.flatten()).and_then(|(track, order)| {
        let converted = to_euler(track, order, DVec3::ZERO, &ConvertConfig::default());
        converted.ok().map(|converted| converted.track.into())
    });
    let new = in_curves.unwrap_or(new);
    scene.tracks.push(JointTrack {
        joint: skeleton.unique_name(joint).to_owned(),
        values: rotation_values(new, notation),
    });
    true
}

/// A rotation's values; quaternions in the notation of an order, if there is one.
fn rotation_values(track: RotationTrack, order: Option<EulerOrder>) -> JointValues {
    match track {
        RotationTrack::Euler(track) => JointValues::EulerRotation(track),
        RotationTrack::Quaternion(track) => JointValues::Rotation {
            track,
            euler: order.map(|order| EulerNotation {
                order,
                angles_deg: Vec::new(),
            }),
        },
    }
}

fn put_translation(scene: &mut Scene, skeleton: &Skeleton, joint: JointId, new: Arc<Track<DVec3>>) {
    let lane = Some(Lane::Translation(joint));
    for old in &mut scene.tracks {
        let is_it = lane_of(old, skeleton) == lane;
        if let (true, JointValues::Translation(track)) = (is_it, &mut old.values) {
            *track = new;
            return;
        }
    }
    scene.tracks.push(JointTrack {
        joint: skeleton.unique_name(joint).to_owned(),
        values: JointValues::Translation(new),
    });
}

fn put_property(scene: &mut Scene, lane: Lane, track: Option<TrackValue>, now_secs: f64) -> bool {
    macro_rules! put {
        ($list:ident, $index:expr, $part:ident . $property:ident, $kind:ident) => {{
            let Some(owner) = scene.$list.get_mut($index) else {
                return false;
            };
            let property = &mut owner.$part.$property;
            *property = match track {
                Some(TrackValue::$kind(track)) => Property::Keyed(track),
                Some(_) => return false,
                None => Property::Fixed(property.at(now_secs)),
            };
            true
        }};
    }
    match lane {
        Lane::Rotation(_) | Lane::Translation(_) => false,
        Lane::CameraPosition(i) => put!(cameras, i, view.position, Vector),
        Lane::CameraTarget(i) => put!(cameras, i, view.target, Vector),
        Lane::CameraFov(i) => put!(cameras, i, view.vertical_fov_deg, Number),
        Lane::LightPosition(i) => put!(lights, i, shine.position, Vector),
        Lane::LightColor(i) => put!(lights, i, shine.color, Vector),
        Lane::LightStrength(i) => put!(lights, i, shine.strength, Number),
        Lane::PropTranslation(i) => put!(props, i, transform.translation, Vector),
        Lane::PropRotation(i) => put!(props, i, transform.rotation, Orientation),
        Lane::PropScale(i) => put!(props, i, transform.scale, Vector),
    }
}
