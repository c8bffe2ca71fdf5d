//! Tracks, keys and properties.

use std::ops::Neg;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::keyframe::{
    EulerTrack, Extrapolation, Handle, HandlePair, Interpolation, KeyValue, Keyframe, Property,
    Tangents, Track, lost_turn,
};
use posekit::rotation::EulerOrder;

use super::SceneProblemKind;
use super::fields::{Fields, Node, Problems};
use crate::scene::document::{EulerNotation, JointTrack, JointValues};
use crate::scene::write::{extrapolation_name, interpolation_name};

const CURVES: [Interpolation; 4] = [
    Interpolation::Step,
    Interpolation::Linear,
    Interpolation::Cubic,
    Interpolation::Squad,
];

const WAYS: [Extrapolation; 4] = [
    Extrapolation::Hold,
    Extrapolation::Cycle,
    Extrapolation::CycleWithOffset,
    Extrapolation::PingPong,
];

/// What a value of a kind looks like in the file.
pub(super) struct Kind<V> {
    what: &'static str,
    read: fn(&Node<'_>) -> Option<V>,
    /// What a handle looks like, and how its seconds and its value are read; `None` where there are none.
    handle: Option<(&'static str, ReadHandle<V>)>,
}

/// Reads the seconds and the value of a handle, seen from its key.
type ReadHandle<V> = fn(&Node<'_>) -> Option<(V, V)>;

pub(super) const NUMBER: Kind<f64> = Kind {
    what: "a number",
    read: |node| node.number(),
    handle: Some(("a handle [seconds, value]", one_handle as ReadHandle<f64>)),
};

pub(super) const VECTOR: Kind<DVec3> = Kind {
    what: "three numbers",
    read: |node| node.numbers().map(DVec3::from_array),
    handle: Some((
        "three handles [seconds, value]",
        three_handles as ReadHandle<DVec3>,
    )),
};

/// Slopes of Euler angles.
const RATES: Kind<DVec3> = Kind {
    what: "three slopes in degrees per second",
    ..VECTOR
};

pub(super) const QUATERNION: Kind<DQuat> = Kind {
    what: "a quaternion of four numbers x, y, z, w",
    read: |node| node.numbers().map(DQuat::from_array),
    handle: None,
};

fn one_handle(node: &Node<'_>) -> Option<(f64, f64)> {
    node.numbers().map(|[secs, value]: [f64; 2]| (secs, value))
}

fn three_handles(node: &Node<'_>) -> Option<(DVec3, DVec3)> {
    let items = node.items().filter(|items| items.len() == 3)?;
    let (mut secs, mut values) = (DVec3::ZERO, DVec3::ZERO);
    for (axis, item) in items.iter().enumerate() {
        [secs[axis], values[axis]] = item.numbers()?;
    }
    Some((secs, values))
}

impl<V> Kind<V> {
    fn or_problem(&self, node: &Node<'_>, problems: &mut Problems) -> Option<V> {
        let value = (self.read)(node);
        if value.is_none() {
            problems.expected(node, self.what);
        }
        value
    }
}

/// One `[[track]]`.
pub(super) fn joint_track(
    fields: &mut Fields<'_>,
    version: u32,
    problems: &mut Problems,
) -> Option<JointTrack> {
    let joint = fields.take("joint", "the name of a joint", problems, |node| {
        node.text().map(str::to_owned)
    });
    let words = "\"rotation\" or \"translation\"";
    let property = fields.take("property", words, problems, |node| {
        node.text()
            .filter(|text| matches!(*text, "rotation" | "translation"))
    });
    let order = fields.optional("euler_deg");
    let mode = fields.optional("mode");
    let values = match property? {
        "rotation" => rotation(fields, (order, mode, version), problems),
        _ => {
            if let Some(order) = order {
                problems.expected(&order, "no order of axes for a translation");
            }
            if let Some(mode) = mode {
                problems.expected(&mode, "no mode of rotation for a translation");
            }
            track(fields, problems, &VECTOR, |key, problems| {
                VECTOR.or_problem(key, problems)
            })
            .map(|track| JointValues::Translation(Arc::new(track)))
        }
    };
    fields.finish(problems);
    Some(JointTrack {
        joint: joint?,
        values: values?,
    })
}

/// How a file says that a rotation's keys are filled in.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    Euler,
    Quaternion,
}

fn rotation(
    fields: &mut Fields<'_>,
    (order, mode, version): (Option<Node<'_>>, Option<Node<'_>>, u32),
    problems: &mut Problems,
) -> Option<JointValues> {
    let mode = mode.and_then(|node| {
        let mode = match node.text() {
            Some("euler") => Some(Mode::Euler),
            Some("quaternion") => Some(Mode::Quaternion),
            _ => None,
        };
        if mode.is_none() {
            problems.expected(&node, "\"euler\" or \"quaternion\"");
        } else if mode == Some(Mode::Euler) && order.is_none() {
            let message = "Euler curves need `euler_deg`, the order of their axes".to_owned();
            problems.at(&node, SceneProblemKind::Inconsistent, message);
        }
        mode
    });
    let Some(order_node) = order else {
        let track = track(fields, problems, &QUATERNION, |key, problems| {
            QUATERNION.or_problem(key, problems)
        })?;
        let track = Arc::new(track);
        return Some(JointValues::Rotation { track, euler: None });
    };
    let order: Option<EulerOrder> = order_node
        .text()
        .and_then(|text| text.parse().ok())
        .filter(|order: &EulerOrder| order.is_complete());
    let Some(order) = order else {
        problems.expected(&order_node, "an order of three axes such as \"ZXY\"");
        return None;
    };
    let chosen = mode.unwrap_or_else(|| {
        if version < 2 && has_quaternion_slopes(fields) {
            Mode::Quaternion
        } else {
            Mode::Euler
        }
    });
    if chosen == Mode::Euler {
        let angles = track(fields, problems, &RATES, |key, problems| {
            let angles = key.numbers().map(DVec3::from_array);
            if angles.is_none() {
                problems.expected(key, "three angles in degrees");
            }
            angles
        })?;
        let curves = EulerTrack::new(order, angles).ok()?;
        return Some(JointValues::EulerRotation(Arc::new(curves)));
    }
    let mut angles_deg: Vec<[f64; 3]> = Vec::new();
    let track = track(fields, problems, &QUATERNION, |key, problems| {
        let Some(angles) = key.numbers::<3>() else {
            problems.expected(key, "three angles in degrees");
            return None;
        };
        if let Some(before) = angles_deg.last()
            && let Some(turn) = lost_turn(order, (*before).into(), angles.into())
        {
            let message = format!(
                "quaternions go {:.1} degrees the short way from the key before, whatever the angles say \
                 (one goes {:.1}); mode = \"euler\" turns as they say",
                turn.short_deg, turn.widest_deg
            );
            problems.warn(key, SceneProblemKind::LostTurn, message);
        }
        angles_deg.push(angles);
        Some(order.to_quat(angles.map(f64::to_radians)))
    })?;
    let euler = Some(EulerNotation { order, angles_deg });
    let track = Arc::new(track);
    Some(JointValues::Rotation { track, euler })
}

/// Whether some key has a slope of four numbers: that of a quaternion.
fn has_quaternion_slopes(fields: &mut Fields<'_>) -> bool {
    let keys = fields.optional("keys").and_then(|list| list.items());
    keys.unwrap_or_default().iter().any(|key| {
        let Some(mut key) = key.fields() else {
            return false;
        };
        ["slope", "slope_in", "slope_out"].into_iter().any(|name| {
            let slope = key.optional(name).and_then(|node| node.items());
            slope.is_some_and(|numbers| numbers.len() == 4)
        })
    })
}

/// A property: its value, or a table of keys.
pub(super) fn property<V: KeyValue + Neg<Output = V>>(
    fields: &mut Fields<'_>,
    name: &'static str,
    kind: &Kind<V>,
    default: V,
    problems: &mut Problems,
) -> Property<V> {
    let fixed = Property::Fixed(default);
    let Some(node) = fields.optional(name) else {
        return fixed;
    };
    if let Some(mut keyed) = node.fields() {
        let track = track(&mut keyed, problems, kind, |key, problems| {
            kind.or_problem(key, problems)
        });
        keyed.finish(problems);
        return track.map_or(fixed, Property::Keyed);
    }
    match (kind.read)(&node) {
        // A track of one key has the rules of a value: finite, of unit length.
        Some(value) => match Track::constant(value) {
            Ok(_) => Property::Fixed(value),
            Err(error) => {
                problems.at(&node, SceneProblemKind::Inconsistent, error.to_string());
                fixed
            }
        },
        None => {
            problems.expected(&node, &format!("{} or a table of keys", kind.what));
            fixed
        }
    }
}

/// The fields of a track: `before`, `after` and `keys`.
fn track<V: KeyValue + Neg<Output = V>>(
    fields: &mut Fields<'_>,
    problems: &mut Problems,
    slopes: &Kind<V>,
    mut value: impl FnMut(&Node<'_>, &mut Problems) -> Option<V>,
) -> Option<Track<V>> {
    let words = "\"hold\", \"cycle\", \"cycle with offset\" or \"ping-pong\"";
    let [before, after] = ["before", "after"].map(|name| {
        fields.take_or(name, Extrapolation::Hold, words, problems, |node| {
            let text = node.text()?;
            WAYS.into_iter()
                .find(|&way| extrapolation_name(way) == text)
        })
    });
    let list = fields.required("keys", problems)?;
    let Some(items) = list.items() else {
        problems.expected(&list, "a list of keys");
        return None;
    };
    let count = items.len();
    let mut keys = Vec::with_capacity(count);
    for item in items {
        let Some(mut one) = item.fields() else {
            problems.expected(&item, "a key such as { at = 0, value = 1 }");
            continue;
        };
        keys.extend(key(&mut one, problems, slopes, &mut value));
        one.finish(problems);
    }
    if keys.len() < count {
        return None;
    }
    match Track::with_ends(keys, before, after) {
        Ok(track) => Some(track),
        Err(error) => {
            let items = list.items().unwrap_or_default();
            let key = error.key().and_then(|key| items.get(key));
            let at = key.unwrap_or(&list);
            problems.at(at, SceneProblemKind::Inconsistent, error.to_string());
            None
        }
    }
}

fn key<V: KeyValue + Neg<Output = V>>(
    fields: &mut Fields<'_>,
    problems: &mut Problems,
    slopes: &Kind<V>,
    value: &mut impl FnMut(&Node<'_>, &mut Problems) -> Option<V>,
) -> Option<Keyframe<V>> {
    let time_secs = fields.take("at", "a time in seconds", problems, Node::number);
    let value = fields
        .required("value", problems)
        .and_then(|node| value(&node, problems));
    let words = "\"step\", \"linear\", \"cubic\" or \"squad\"";
    let interpolation = fields.take_or("curve", Interpolation::Cubic, words, problems, |node| {
        let text = node.text()?;
        CURVES
            .into_iter()
            .find(|&way| interpolation_name(way) == text)
    });
    let tangents = tangents(fields, problems, slopes);
    Some(Keyframe {
        time_secs: time_secs?,
        value: value?,
        interpolation,
        tangents,
    })
}

fn handles<V: KeyValue + Neg<Output = V>>(
    fields: &Fields<'_>,
    (ends, pair): ([Option<Node<'_>>; 2], Option<Node<'_>>),
    slopes: &Kind<V>,
    problems: &mut Problems,
) -> Tangents<V> {
    let pair = match pair.as_ref().map(|node| (node, node.text())) {
        None | Some((_, Some("aligned"))) => HandlePair::Aligned,
        Some((_, Some("broken"))) => HandlePair::Broken,
        Some((node, _)) => {
            problems.expected(node, "\"aligned\" or \"broken\"");
            return Tangents::Auto;
        }
    };
    let [Some(before), Some(after)] = ends else {
        let message = "expected both of `handle_in` and `handle_out`".to_owned();
        fields.problem(problems, SceneProblemKind::Inconsistent, message);
        return Tangents::Auto;
    };
    let Some((what, read)) = slopes.handle else {
        problems.expected(
            &before,
            "slopes: quaternions have no handles that are free in time",
        );
        return Tangents::Auto;
    };
    let mut one = |node: &Node<'_>| {
        let read = read(node);
        if read.is_none() {
            problems.expected(node, what);
        }
        read
    };
    match [one(&before), one(&after)] {
        [Some((secs, value)), Some((secs_after, value_after))] => Tangents::Handles {
            // Before the key is less than its time; the track refuses what is after it.
            incoming: Handle { secs: -secs, value },
            outgoing: Handle {
                secs: secs_after,
                value: value_after,
            },
            pair,
        },
        _ => Tangents::Auto,
    }
}

fn tangents<V: KeyValue + Neg<Output = V>>(
    fields: &mut Fields<'_>,
    problems: &mut Problems,
    slopes: &Kind<V>,
) -> Tangents<V> {
    let both = fields.optional("slope");
    let [incoming, outgoing] = ["slope_in", "slope_out"].map(|name| fields.optional(name));
    let ends = ["handle_in", "handle_out"].map(|name| fields.optional(name));
    let pair = fields.optional("handles");
    if ends.iter().chain([&pair]).any(Option::is_some) {
        if both.is_some() || incoming.is_some() || outgoing.is_some() {
            let message = "expected slopes or handles, not both";
            fields.problem(problems, SceneProblemKind::Inconsistent, message.to_owned());
            return Tangents::Auto;
        }
        return handles(fields, (ends, pair), slopes, problems);
    }
    match (both, incoming, outgoing) {
        (None, None, None) => Tangents::Auto,
        (Some(both), None, None) => match both.text() {
            Some("auto") => Tangents::Auto,
            Some("smooth") => Tangents::Smooth,
            Some("flat") => Tangents::Flat,
            _ => match (slopes.read)(&both) {
                Some(slope) => Tangents::Aligned(slope),
                None => {
                    let what = format!("\"auto\", \"smooth\", \"flat\" or {}", slopes.what);
                    problems.expected(&both, &what);
                    Tangents::Auto
                }
            },
        },
        (None, Some(incoming), Some(outgoing)) => {
            let sides = [incoming, outgoing].map(|node| slopes.or_problem(&node, problems));
            match sides {
                [Some(incoming), Some(outgoing)] => Tangents::Broken { incoming, outgoing },
                _ => Tangents::Auto,
            }
        }
        _ => {
            let message = "expected `slope`, or both of `slope_in` and `slope_out`";
            fields.problem(problems, SceneProblemKind::Inconsistent, message.to_owned());
            Tangents::Auto
        }
    }
}
