//! Changing things: adding, naming, taking out, setting, keying.

use glam::{DQuat, DVec3};
use posekit::keyframe::edit::{EditError, SAME_TIME_SECS, delete_keys, insert_key};
use posekit::keyframe::{
    Extrapolation, Interpolation, KeyValue, KeyedCamera, KeyedLight, KeyedTransform, Keyframe,
    Property, Track,
};
use posekit_formats::scene::{Camera, Light, Prop, Scene};

use crate::state::animate::{Lane, LaneTrack, LaneValue, Owner, TrackValue};

/// What can be added to a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A camera: where it stands, what it looks at, its angle of view in degrees.
    Camera {
        /// Where it stands.
        position: DVec3,
        /// What it looks at.
        target: DVec3,
        /// Full vertical angle.
        fov_deg: f64,
    },
    /// A white light.
    Light {
        /// Where it stands.
        position: DVec3,
        /// Factor of its colour.
        strength: f64,
    },
    /// A box of a certain side.
    Box {
        /// Its middle.
        at: DVec3,
        /// Its side.
        side: f64,
    },
    /// A ball.
    Sphere {
        /// Its middle.
        at: DVec3,
        /// Its diameter.
        side: f64,
    },
}

/// Adds a thing under a name that none of its kind has yet.
pub fn add(scene: &mut Scene, kind: Kind) -> Owner {
    match kind {
        Kind::Camera {
            position,
            target,
            fov_deg,
        } => {
            let name = free_name("camera", scene.cameras.iter().map(|it| it.name.as_str()));
            let view = KeyedCamera {
                position: Property::Fixed(position),
                target: Property::Fixed(target),
                vertical_fov_deg: Property::Fixed(fov_deg),
            };
            scene.cameras.push(Camera { name, view });
            Owner::Camera(scene.cameras.len() - 1)
        }
        Kind::Light { position, strength } => {
            let shine = KeyedLight {
                position: Property::Fixed(position),
                strength: Property::Fixed(strength),
                ..KeyedLight::default()
            };
            add_light(scene, "light", shine)
        }
        Kind::Box { at, side } => add_prop(scene, "box", at, side),
        Kind::Sphere { at, side } => add_prop(scene, "sphere", at, side),
    }
}

/// Adds a light of a name, or of one like it that none has yet.
pub fn add_light(scene: &mut Scene, name: &str, shine: KeyedLight) -> Owner {
    let name = free_name(name, scene.lights.iter().map(|it| it.name.as_str()));
    scene.lights.push(Light { name, shine });
    Owner::Light(scene.lights.len() - 1)
}

fn add_prop(scene: &mut Scene, shape: &str, at: DVec3, side: f64) -> Owner {
    let name = free_name(shape, scene.props.iter().map(|it| it.name.as_str()));
    scene.props.push(Prop {
        name,
        shape: shape.to_owned(),
        transform: KeyedTransform {
            translation: Property::Fixed(at),
            rotation: Property::Fixed(DQuat::IDENTITY),
            scale: Property::Fixed(DVec3::splat(side)),
        },
    });
    Owner::Prop(scene.props.len() - 1)
}

/// `kind`, or `kind 2` and so on where that is taken.
fn free_name<'a>(kind: &str, taken: impl Iterator<Item = &'a str>) -> String {
    let taken: Vec<&str> = taken.collect();
    let numbered = (2..).map(|number: usize| format!("{kind} {number}"));
    std::iter::once(kind.to_owned())
        .chain(numbered)
        .find(|name| !taken.contains(&name.as_str()))
        .unwrap_or_default()
}

/// Takes a thing out. Those after it move up.
pub fn remove(scene: &mut Scene, owner: Owner) {
    if !super::exists(scene, owner) {
        return;
    }
    match owner {
        Owner::Joint(_) => {}
        Owner::Camera(index) => drop(scene.cameras.remove(index)),
        Owner::Light(index) => {
            drop(scene.lights.remove(index));
            // Nothing is seen in a room without any light.
            scene.studio_light |= scene.lights.is_empty();
        }
        Owner::Prop(index) => drop(scene.props.remove(index)),
    }
}

/// Gives a thing another name.
pub fn rename(scene: &mut Scene, owner: Owner, name: &str) {
    let old = match owner {
        Owner::Joint(_) => None,
        Owner::Camera(index) => scene.cameras.get_mut(index).map(|it| &mut it.name),
        Owner::Light(index) => scene.lights.get_mut(index).map(|it| &mut it.name),
        Owner::Prop(index) => scene.props.get_mut(index).map(|it| &mut it.name),
    };
    if let Some(old) = old {
        name.clone_into(old);
    }
}

/// Gives a property a value that never changes. False where the scene has no such property, or one of
/// another kind; then nothing has changed.
pub fn set_fixed(scene: &mut Scene, lane: Lane, value: LaneValue) -> bool {
    macro_rules! set {
        ($list:ident, $index:expr, $part:ident . $property:ident, $kind:ident) => {
            match (scene.$list.get_mut($index), value) {
                (Some(owner), LaneValue::$kind(value)) => {
                    owner.$part.$property = Property::Fixed(value);
                    true
                }
                _ => false,
            }
        };
    }
    match lane {
        Lane::Rotation(_) | Lane::Translation(_) => false,
        Lane::CameraPosition(i) => set!(cameras, i, view.position, Vector),
        Lane::CameraTarget(i) => set!(cameras, i, view.target, Vector),
        Lane::CameraFov(i) => set!(cameras, i, view.vertical_fov_deg, Number),
        Lane::LightPosition(i) => set!(lights, i, shine.position, Vector),
        Lane::LightColor(i) => set!(lights, i, shine.color, Vector),
        Lane::LightStrength(i) => set!(lights, i, shine.strength, Number),
        Lane::PropTranslation(i) => set!(props, i, transform.translation, Vector),
        Lane::PropRotation(i) => set!(props, i, transform.rotation, Orientation),
        Lane::PropScale(i) => set!(props, i, transform.scale, Vector),
    }
}

/// A track with a key of a value at a time, in place of the one that is there; a new track where there
/// is none. `None` for a value of another kind, or one that is not finite.
#[must_use]
pub fn keyed(
    track: Option<LaneTrack<'_>>,
    value: LaneValue,
    time_secs: f64,
    interpolation: Interpolation,
) -> Option<TrackValue> {
    fn with<V: KeyValue>(
        track: Option<&Track<V>>,
        value: V,
        time_secs: f64,
        interpolation: Interpolation,
    ) -> Option<Track<V>> {
        let at = |key: &&Keyframe<V>| (key.time_secs - time_secs).abs() <= SAME_TIME_SECS;
        let there = track.and_then(|track| track.keys().iter().find(at));
        let key = match there {
            // A key that is there keeps its curve.
            Some(there) => Keyframe { value, ..*there },
            None => Keyframe::new(time_secs, value, interpolation),
        };
        let made: Result<Track<V>, EditError> = match track {
            Some(track) => insert_key(track, key),
            None => Track::new(vec![key], Extrapolation::Hold).map_err(EditError::from),
        };
        made.ok()
    }
    macro_rules! of_kind {
        ($($kind:ident),*) => {
            match (track, value) {
                $(
                    (None, LaneValue::$kind(value)) => {
                        with(None, value, time_secs, interpolation).map(TrackValue::$kind)
                    }
                    (Some(LaneTrack::$kind(track)), LaneValue::$kind(value)) => {
                        with(Some(track), value, time_secs, interpolation).map(TrackValue::$kind)
                    }
                )*
                (Some(LaneTrack::Euler(track)), LaneValue::Orientation(value)) => {
                    let angles = track.angles_near_deg(value, time_secs);
                    let made = with(Some(track.angles_deg()), angles, time_secs, interpolation);
                    made.map(|angles| TrackValue::Euler(track.with_angles_deg(angles)))
                }
                _ => None,
            }
        };
    }
    of_kind!(Number, Vector, Orientation)
}

/// A track without one of its keys; `None` when none is left.
#[must_use]
pub fn unkeyed(track: LaneTrack<'_>, index: usize) -> Option<TrackValue> {
    match track {
        LaneTrack::Number(track) => delete_keys(track, &[index]).map(TrackValue::Number),
        LaneTrack::Vector(track) => delete_keys(track, &[index]).map(TrackValue::Vector),
        LaneTrack::Orientation(track) => delete_keys(track, &[index]).map(TrackValue::Orientation),
        LaneTrack::Euler(track) => delete_keys(track.angles_deg(), &[index])
            .map(|angles| TrackValue::Euler(track.with_angles_deg(angles))),
    }
}
