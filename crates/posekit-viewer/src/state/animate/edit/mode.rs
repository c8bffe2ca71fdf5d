//! How rotations are keyed: as quaternions or as Euler curves; tracks changed from one to the other.

use glam::DVec3;
use posekit::keyframe::{
    ConvertConfig, EulerTrack, Interpolation, lost_turn, to_euler, to_quaternion,
};
use posekit::rotation::{Axis, EulerOrder};
use posekit_formats::scene::{JointValues, Scene};

use super::super::{Authored, Lane, LaneTrack, TrackValue};
use super::Edit;

/// How a rotation is keyed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotationMode {
    /// Quaternions: the short way from key to key.
    Quaternion,
    /// Three curves of angles, in an order of axes.
    Euler(EulerOrder),
}

impl RotationMode {
    /// All thirteen, in the order in which they are offered.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::Quaternion];
        for first in Axis::ALL {
            for second in Axis::ALL {
                for third in Axis::ALL {
                    let order = EulerOrder::new(&[first, second, third]);
                    let order = order.ok().filter(|order| order.is_complete());
                    all.extend(order.map(Self::Euler));
                }
            }
        }
        // Those of three different axes, which people know, come first.
        all.sort_by_key(|mode| match mode {
            Self::Quaternion => 0,
            Self::Euler(order) if order.axes()[0] != order.axes()[2] => 1,
            Self::Euler(_) => 2,
        });
        all
    }

    /// The name shown.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Quaternion => "Quaternion".to_owned(),
            Self::Euler(order) => format!("Euler {order}"),
        }
    }

    /// That of a track; `None` where it is of something else than a rotation.
    #[must_use]
    pub fn of(track: LaneTrack<'_>) -> Option<Self> {
        match track {
            LaneTrack::Orientation(_) => Some(Self::Quaternion),
            LaneTrack::Euler(track) => Some(Self::Euler(track.order())),
            LaneTrack::Number(_) | LaneTrack::Vector(_) => None,
        }
    }
}

/// Tracks in another mode, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Changed {
    /// The edit.
    pub edit: Edit,
    /// What is to be said about it.
    pub says: String,
}

/// The joints' rotations of some lanes in another mode, within a tenth of a degree of what they were between
/// their keys. `None` where none of them changes.
#[must_use]
pub fn with_mode(
    authored: &Authored,
    lanes: impl IntoIterator<Item = Lane>,
    mode: RotationMode,
) -> Option<Changed> {
    let config = ConvertConfig::default();
    let mut edit = Edit::default();
    let (mut added, mut worst_rad) = (0, 0.0_f64);
    let mut turns = false;
    for lane in lanes {
        let Lane::Rotation(_) = lane else { continue };
        let Some(track) = authored.track(lane) else {
            continue;
        };
        if RotationMode::of(track) == Some(mode) {
            continue;
        }
        let quaternions = match track {
            LaneTrack::Orientation(track) => track.clone(),
            LaneTrack::Euler(euler) => {
                let converted = to_quaternion(euler, &config).ok()?;
                worst_rad = worst_rad.max(converted.greatest_error_rad);
                turns |= has_wide_turn(euler);
                converted.track
            }
            LaneTrack::Number(_) | LaneTrack::Vector(_) => continue,
        };
        let value = match mode {
            RotationMode::Quaternion => TrackValue::Orientation(quaternions),
            RotationMode::Euler(order) => {
                let converted = to_euler(&quaternions, order, DVec3::ZERO, &config).ok()?;
                worst_rad = worst_rad.max(converted.greatest_error_rad);
                TrackValue::Euler(converted.track)
            }
        };
        added += value
            .as_track()
            .key_count()
            .saturating_sub(track.key_count());
        edit.changes.push((lane, Some(value)));
    }
    if edit.is_empty() {
        return None;
    }
    let tracks = match edit.changes.len() {
        1 => "1 rotation is".to_owned(),
        count => format!("{count} rotations are"),
    };
    let keys = match added {
        0 => "no key was added".to_owned(),
        1 => "1 key was added".to_owned(),
        count => format!("{count} keys were added"),
    };
    let mut says = format!(
        "{tracks} {} now; {keys}, and the motion stays within {:.2}\u{b0}",
        match mode {
            RotationMode::Quaternion => "keyed as quaternions".to_owned(),
            RotationMode::Euler(order) => format!("keyed as Euler curves {order}"),
        },
        // Rounded up: it is a bound.
        (worst_rad.to_degrees() * 100.0).ceil() / 100.0
    );
    if mode == RotationMode::Quaternion && turns {
        says += ". Quaternions turn by 180\u{b0} at most between two keys: keys stand where the curves \
                 turned further";
    }
    Some(Changed { edit, says })
}

/// Whether curves turn by more than half a turn between two keys.
fn has_wide_turn(euler: &EulerTrack) -> bool {
    let keys = euler.angles_deg().keys();
    keys.windows(2).any(|pair| {
        let is_lost = || lost_turn(euler.order(), pair[0].value, pair[1].value).is_some();
        pair[0].interpolation != Interpolation::Step && is_lost()
    })
}

/// What is said when a key of quaternions was asked to turn further than they can.
pub const LOST_TURN: &str = "Quaternions go the short way from key to key, 180\u{b0} at most: for more, make the \
                             rotation Euler curves (right button, Rotation mode)";

/// Whether a scene has quaternions that were given as Euler angles and do not turn as these say.
#[must_use]
pub fn loses_turns(scene: &Scene) -> bool {
    scene.tracks.iter().any(|track| match &track.values {
        JointValues::Rotation {
            euler: Some(euler), ..
        } => euler
            .angles_deg
            .windows(2)
            .any(|pair| lost_turn(euler.order, pair[0].into(), pair[1].into()).is_some()),
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use posekit::keyframe::{Extrapolation, Keyframe, Track};
    use posekit::rotation::angle_between;
    use posekit_formats::scene::SkeletonSource;

    use super::super::clipboard::{Clipboard, mirrored};
    use super::*;
    use crate::state::animate::{Files, KeyId, LaneValue};

    /// A person whose left elbow turns twice, about Z, in four seconds.
    fn spinning() -> (Authored, Lane) {
        let skeleton = posekit::sample::humanoid();
        let mut scene = Scene::new(SkeletonSource::inline(&skeleton));
        scene.range_secs = [0.0, 4.0];
        let mut authored = Authored::new(scene, Files::new()).expect("it fits");
        let lane = Lane::Rotation(skeleton.find("LeftLowerArm").expect("a humanoid has one"));
        let keys = [(0.0, 0.0), (4.0, 720.0)].map(|(time, turn)| {
            Keyframe::new(time, DVec3::new(0.0, 0.0, turn), Interpolation::Linear)
        });
        let track = Track::new(keys.to_vec(), Extrapolation::Hold).expect("valid");
        let curves = EulerTrack::new(EulerOrder::XYZ, track).expect("a whole order");
        let changes = vec![(lane, Some(TrackValue::Euler(curves)))];
        authored.set_tracks("Start", None, changes, BTreeSet::new());
        (authored, lane)
    }

    fn turn_at(authored: &Authored, lane: Lane, time_secs: f64) -> glam::DQuat {
        match authored.value_at(lane, time_secs) {
            Some(LaneValue::Orientation(turn)) => turn,
            other => panic!("a rotation: {other:?}"),
        }
    }

    #[test]
    fn modes_change_and_the_motion_stays() {
        let (mut authored, lane) = spinning();
        let before = authored.clone();
        let modes = [
            RotationMode::Quaternion,
            RotationMode::Euler(EulerOrder::ZXY),
            RotationMode::Euler(EulerOrder::YZX),
        ];
        for mode in modes {
            let changed = with_mode(&authored, [lane], mode).expect("another mode");
            assert!(
                changed.says.contains("the motion stays within 0.0"),
                "{}",
                changed.says
            );
            let is_quaternion = mode == RotationMode::Quaternion;
            assert_eq!(
                changed.says.contains("180"),
                is_quaternion,
                "{}",
                changed.says
            );
            authored.set_tracks("Mode", None, changed.edit.changes, BTreeSet::new());
            let track = authored.track(lane).expect("it is keyed");
            assert_eq!(RotationMode::of(track), Some(mode));
            for step in 0..=80 {
                let time = 0.05 * f64::from(step);
                let [a, b] = [&before, &authored].map(|it| turn_at(it, lane, time));
                assert!(angle_between(a, b) < 1e-6, "{mode:?} at {time}");
            }
            assert!(
                with_mode(&authored, [lane], mode).is_none(),
                "it is so already"
            );
        }
        for _ in modes {
            authored.undo();
        }
        assert_eq!(authored.scene(), before.scene());
    }

    #[test]
    fn keys_are_pasted_and_mirrored_in_the_mode_of_where_they_go() {
        let (mut authored, lane) = spinning();
        let keys: BTreeSet<KeyId> = (0..2).map(|index| KeyId { lane, index }).collect();
        let copied = Clipboard::of(&authored, &keys);
        let quaternions = with_mode(&authored, [lane], RotationMode::Quaternion).expect("another");
        authored.set_tracks("Mode", None, quaternions.edit.changes, BTreeSet::new());
        let pasted = copied.paste(&authored, 6.0, false).expect("it is pasted");
        authored.set_tracks("Paste", None, pasted.changes, pasted.selection);
        assert!(matches!(
            authored.track(lane),
            Some(LaneTrack::Orientation(_))
        ));
        let expected = glam::DQuat::from_rotation_z(180_f64.to_radians());
        assert!(angle_between(turn_at(&authored, lane, 7.0), expected) < 1e-6);

        let (mut authored, _) = spinning();
        let image = mirrored(&authored, &keys).expect("it has another side");
        authored.set_tracks("Mirror", None, image.changes, image.selection);
        let other = authored
            .skeleton()
            .find("RightLowerArm")
            .expect("a humanoid has one");
        let Some(LaneTrack::Euler(track)) = authored.track(Lane::Rotation(other)) else {
            panic!("Euler curves");
        };
        assert_eq!(track.order(), EulerOrder::XYZ);
        let last = track.angles_deg().keys()[1].value;
        assert_eq!(last, DVec3::new(0.0, 0.0, -720.0));
    }

    #[test]
    fn the_first_key_of_a_joint_is_in_the_mode_of_the_scenes_first() {
        let (mut authored, _) = spinning();
        let head = authored
            .skeleton()
            .find("Head")
            .expect("a humanoid has one");
        let key = Keyframe::new(1.0, glam::DQuat::from_rotation_x(0.5), Interpolation::Cubic);
        let track = Track::new(vec![key], Extrapolation::Hold).expect("valid");
        let lane = Lane::Rotation(head);
        let changes = vec![(lane, Some(TrackValue::Orientation(track)))];
        authored.set_tracks("Key", None, changes, BTreeSet::new());
        let mode = authored.track(lane).and_then(RotationMode::of);
        assert_eq!(mode, Some(RotationMode::Euler(EulerOrder::XYZ)));
        assert!(angle_between(turn_at(&authored, lane, 1.0), key.value) < 1e-12);
        assert!(!loses_turns(authored.scene()));
    }

    #[test]
    fn thirteen_modes_are_offered_each_once() {
        let all = RotationMode::all();
        assert_eq!(all.len(), 13);
        assert_eq!(all[1].name(), "Euler XYZ");
        let names: BTreeSet<String> = all.iter().map(|mode| mode.name()).collect();
        assert_eq!(names.len(), 13);
    }
}
