//! Keys that were copied, pasted elsewhere, or mirrored.

use std::collections::BTreeSet;

use posekit::keyframe::edit::{PasteValues, copy_keys, mirror_animation, mirror_axis, paste_keys};
use posekit::keyframe::{
    Animation, ConvertConfig, EulerTrack, Extrapolation, Keyframe, RotationTrack, Track, to_euler,
    to_quaternion,
};
use posekit::rotation::EulerOrder;

use glam::{DQuat, DVec3};

use super::super::{Authored, KeyId, Lane, LaneTrack, Owner, TrackValue};
use super::Edit;
use super::keys::{by_lane, keys_at};

/// Keys of one lane, their times counted from the first key that was copied.
#[derive(Clone, Debug, PartialEq)]
enum Copied {
    Number(Vec<Keyframe<f64>>),
    Vector(Vec<Keyframe<DVec3>>),
    Orientation(Vec<Keyframe<DQuat>>),
    Euler(EulerOrder, Vec<Keyframe<DVec3>>),
}

/// Keys that were copied. Joints are known by name, so that they can be pasted on another skeleton.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clipboard {
    lanes: Vec<(Lane, String, Copied)>,
}

impl Clipboard {
    /// The selected keys.
    #[must_use]
    pub fn of(authored: &Authored, selection: &BTreeSet<KeyId>) -> Self {
        let times = selection.iter().filter_map(|key| authored.time_of(*key));
        let Some(origin) = times.reduce(f64::min) else {
            return Self::default();
        };
        let lanes = by_lane(selection)
            .into_iter()
            .filter_map(|(lane, indices)| {
                let copied = match authored.track(lane)? {
                    LaneTrack::Number(track) => Copied::Number(copy_keys(track, &indices, origin)),
                    LaneTrack::Vector(track) => Copied::Vector(copy_keys(track, &indices, origin)),
                    LaneTrack::Orientation(track) => {
                        Copied::Orientation(copy_keys(track, &indices, origin))
                    }
                    LaneTrack::Euler(track) => {
                        let keys = copy_keys(track.angles_deg(), &indices, origin);
                        Copied::Euler(track.order(), keys)
                    }
                };
                let name = lane.owner().name(authored.scene(), authored.skeleton());
                Some((lane, name, copied))
            });
        Self {
            lanes: lanes.collect(),
        }
    }

    /// How many keys there are.
    #[must_use]
    pub fn len(&self) -> usize {
        let count = |(_, _, copied): &(Lane, String, Copied)| match copied {
            Copied::Number(keys) => keys.len(),
            Copied::Vector(keys) => keys.len(),
            Copied::Orientation(keys) => keys.len(),
            Copied::Euler(_, keys) => keys.len(),
        };
        self.lanes.iter().map(count).sum()
    }

    /// Whether nothing was copied.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lanes.is_empty()
    }

    /// The keys put into a scene, the first of them at a time, in place of those that lie between the
    /// first and the last of each lane. What the scene does not have is left out; `None` where nothing
    /// is left, or the numbers are no key's.
    #[must_use]
    pub fn paste(&self, authored: &Authored, at_secs: f64, left_for_right: bool) -> Option<Edit> {
        let here = self.here(authored);
        let lanes = if left_for_right {
            mirrored_lanes(authored, here)?
        } else {
            here
        };
        let mut edit = Edit::default();
        for (lane, copied) in lanes {
            let value = pasted(authored.track(lane), &copied, at_secs)?;
            let times: Vec<f64> = copied.times().map(|time| time + at_secs).collect();
            edit.selection
                .extend(keys_at(lane, &value.as_track(), &times));
            edit.changes.push((lane, Some(value)));
        }
        (!edit.is_empty()).then_some(edit)
    }

    /// The lanes as a scene has them.
    fn here(&self, authored: &Authored) -> Vec<(Lane, Copied)> {
        let skeleton = authored.skeleton();
        let lanes = self.lanes.iter().filter_map(|(lane, name, copied)| {
            let here = match lane {
                Lane::Rotation(_) => {
                    Lane::Rotation(skeleton.find(name).filter(|j| !skeleton.is_end_site(*j))?)
                }
                Lane::Translation(_) => Lane::Translation(skeleton.find(name)?),
                around => {
                    authored.value_at(*around, 0.0)?;
                    *around
                }
            };
            Some((here, copied.clone()))
        });
        lanes.collect()
    }
}

impl Copied {
    fn times(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Number(keys) => Box::new(keys.iter().map(|key| key.time_secs)),
            Self::Vector(keys) => Box::new(keys.iter().map(|key| key.time_secs)),
            Self::Orientation(keys) => Box::new(keys.iter().map(|key| key.time_secs)),
            Self::Euler(_, keys) => Box::new(keys.iter().map(|key| key.time_secs)),
        }
    }

    /// The same in the mode of a track that they are pasted into, with keys added where that needs some.
    /// Angles begin near those that the track has there.
    fn in_mode_of(self, track: Option<LaneTrack<'_>>, at_secs: f64) -> Option<Self> {
        let config = ConvertConfig::default();
        match (self, track) {
            (Self::Orientation(keys), Some(LaneTrack::Euler(euler))) => {
                let first = keys.first()?.time_secs;
                let near = euler.angles_deg().sample(at_secs + first);
                let track = Track::new(keys, Extrapolation::Hold).ok()?;
                let converted = to_euler(&track, euler.order(), near, &config).ok()?;
                let keys = converted.track.angles_deg().keys().to_vec();
                Some(Self::Euler(euler.order(), keys))
            }
            (Self::Euler(order, keys), Some(LaneTrack::Orientation(_))) => {
                let angles = Track::new(keys, Extrapolation::Hold).ok()?;
                let euler = EulerTrack::new(order, angles).ok()?;
                let converted = to_quaternion(&euler, &config).ok()?;
                Some(Self::Orientation(converted.track.keys().to_vec()))
            }
            (Self::Euler(order, keys), Some(LaneTrack::Euler(there))) if order != there.order() => {
                let angles = Track::new(keys, Extrapolation::Hold).ok()?;
                let euler = EulerTrack::new(order, angles).ok()?;
                let quaternions = to_quaternion(&euler, &config).ok()?.track;
                Self::Orientation(quaternions.keys().to_vec()).in_mode_of(track, at_secs)
            }
            (same, _) => Some(same),
        }
    }
}

/// A lane's track with keys pasted into it; of a lane that is not keyed, a track of them alone.
fn pasted(track: Option<LaneTrack<'_>>, copied: &Copied, at_secs: f64) -> Option<TrackValue> {
    let copied = &copied.clone().in_mode_of(track, at_secs)?;
    macro_rules! paste {
        ($kind:ident, $keys:expr) => {{
            let track = match track {
                Some(LaneTrack::$kind(track)) => {
                    paste_keys(track, $keys, at_secs, PasteValues::AsCopied).ok()
                }
                Some(_) => None,
                None => {
                    let mut keys = $keys.clone();
                    for key in &mut keys {
                        key.time_secs += at_secs;
                    }
                    Track::new(keys, Extrapolation::Hold).ok()
                }
            };
            track.map(TrackValue::$kind)
        }};
    }
    match copied {
        Copied::Number(keys) => paste!(Number, keys),
        Copied::Vector(keys) => paste!(Vector, keys),
        Copied::Orientation(keys) => paste!(Orientation, keys),
        Copied::Euler(order, keys) => {
            let mut keys = keys.clone();
            let angles = match track {
                Some(LaneTrack::Euler(track)) => {
                    paste_keys(track.angles_deg(), &keys, at_secs, PasteValues::AsCopied).ok()
                }
                Some(_) => None,
                None => {
                    for key in &mut keys {
                        key.time_secs += at_secs;
                    }
                    Track::new(keys, Extrapolation::Hold).ok()
                }
            };
            let euler = EulerTrack::new(*order, angles?).ok()?;
            Some(TrackValue::Euler(euler))
        }
    }
}

/// Lanes of joints changed for those of their partners on the other side, values mirrored; others stay
/// what they are.
fn mirrored_lanes(authored: &Authored, lanes: Vec<(Lane, Copied)>) -> Option<Vec<(Lane, Copied)>> {
    let skeleton = authored.skeleton();
    let mut animation = Animation::new(skeleton.clone());
    let mut others = Vec::new();
    for (lane, copied) in lanes {
        match (lane, copied) {
            (Lane::Rotation(joint), Copied::Orientation(keys)) => {
                let track = Track::new(keys, Extrapolation::Hold).ok()?;
                animation = animation.with_rotation(joint, Some(track));
            }
            (Lane::Rotation(joint), Copied::Euler(order, keys)) => {
                let angles = Track::new(keys, Extrapolation::Hold).ok()?;
                let track = EulerTrack::new(order, angles).ok()?;
                animation = animation.with_rotation(joint, Some(track));
            }
            (Lane::Translation(joint), Copied::Vector(keys)) => {
                let track = Track::new(keys, Extrapolation::Hold).ok()?;
                animation = animation.with_translation(joint, Some(track));
            }
            other => others.push(other),
        }
    }
    let image = mirror_animation(&animation, mirror_axis(skeleton), 0.0).ok()?;
    let turned = image.rotations().map(|(joint, track)| {
        let keys = match track {
            RotationTrack::Quaternion(track) => Copied::Orientation(track.keys().to_vec()),
            RotationTrack::Euler(track) => {
                Copied::Euler(track.order(), track.angles_deg().keys().to_vec())
            }
        };
        (Lane::Rotation(joint), keys)
    });
    let moved = image.translations().map(|(joint, track)| {
        let keys = Copied::Vector(track.keys().to_vec());
        (Lane::Translation(joint), keys)
    });
    Some(turned.chain(moved).chain(others).collect())
}

/// The mirror images of the selected keys on the other side, at the same times: selected on both sides
/// they change places, selected on one the other side gets a copy; joints in the middle are mirrored
/// themselves.
#[must_use]
pub fn mirrored(authored: &Authored, selection: &BTreeSet<KeyId>) -> Option<Edit> {
    let joints: BTreeSet<KeyId> = selection
        .iter()
        .copied()
        .filter(|key| matches!(key.lane.owner(), Owner::Joint(_)))
        .collect();
    let first = joints.iter().filter_map(|key| authored.time_of(*key));
    let origin = first.reduce(f64::min)?;
    let copied = Clipboard::of(authored, &joints);
    let lanes = mirrored_lanes(authored, copied.here(authored))?;
    let mut edit = Edit::default();
    for (lane, copied) in lanes {
        // Key by key: what lies between the images and is not selected stays.
        let copied = copied.in_mode_of(authored.track(lane), origin)?;
        let value = match (copied, authored.track(lane)) {
            (Copied::Euler(_, keys), Some(LaneTrack::Euler(track))) => {
                let angles = put_each(track.angles_deg(), &keys, origin);
                angles.map(|angles| TrackValue::Euler(track.with_angles_deg(angles)))
            }
            (Copied::Orientation(keys), Some(LaneTrack::Orientation(track))) => {
                put_each(track, &keys, origin).map(TrackValue::Orientation)
            }
            (Copied::Vector(keys), Some(LaneTrack::Vector(track))) => {
                put_each(track, &keys, origin).map(TrackValue::Vector)
            }
            (copied, track) => pasted(track, &copied, origin),
        }?;
        let times: Vec<f64> = joints
            .iter()
            .filter_map(|key| authored.time_of(*key))
            .collect();
        edit.selection
            .extend(keys_at(lane, &value.as_track(), &times));
        edit.changes.push((lane, Some(value)));
    }
    Some(edit)
}

fn put_each<V: posekit::keyframe::KeyValue>(
    track: &Track<V>,
    keys: &[Keyframe<V>],
    at_secs: f64,
) -> Option<Track<V>> {
    let mut track = track.clone();
    for key in keys {
        let key = Keyframe {
            time_secs: key.time_secs + at_secs,
            ..*key
        };
        track = posekit::keyframe::edit::insert_key(&track, key).ok()?;
    }
    Some(track)
}
