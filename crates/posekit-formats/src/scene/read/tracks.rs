//! Tracks, keys and properties.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::keyframe::{
    Extrapolation, Interpolation, KeyValue, Keyframe, Property, Tangents, Track,
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
}

pub(super) const NUMBER: Kind<f64> = Kind {
    what: "a number",
    read: |node| node.number(),
};

pub(super) const VECTOR: Kind<DVec3> = Kind {
    what: "three numbers",
    read: |node| node.numbers().map(DVec3::from_array),
};

pub(super) const QUATERNION: Kind<DQuat> = Kind {
    what: "a quaternion of four numbers x, y, z, w",
    read: |node| node.numbers().map(DQuat::from_array),
};

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
pub(super) fn joint_track(fields: &mut Fields<'_>, problems: &mut Problems) -> Option<JointTrack> {
    let joint = fields.take("joint", "the name of a joint", problems, |node| {
        node.text().map(str::to_owned)
    });
    let words = "\"rotation\" or \"translation\"";
    let property = fields.take("property", words, problems, |node| {
        node.text()
            .filter(|text| matches!(*text, "rotation" | "translation"))
    });
    let order = fields.optional("euler_deg");
    let values = match property? {
        "rotation" => rotation(fields, order, problems),
        _ => {
            if let Some(order) = order {
                problems.expected(&order, "no order of axes for a translation");
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

fn rotation(
    fields: &mut Fields<'_>,
    order: Option<Node<'_>>,
    problems: &mut Problems,
) -> Option<JointValues> {
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
    let mut angles_deg = Vec::new();
    let track = track(fields, problems, &QUATERNION, |key, problems| {
        let Some(angles) = key.numbers::<3>() else {
            problems.expected(key, "three angles in degrees");
            return None;
        };
        angles_deg.push(angles);
        Some(order.to_quat(angles.map(f64::to_radians)))
    })?;
    let euler = Some(EulerNotation { order, angles_deg });
    let track = Arc::new(track);
    Some(JointValues::Rotation { track, euler })
}

/// A property: its value, or a table of keys.
pub(super) fn property<V: KeyValue>(
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
fn track<V: KeyValue>(
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
            problems.at(&list, SceneProblemKind::Inconsistent, error.to_string());
            None
        }
    }
}

fn key<V: KeyValue>(
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

fn tangents<V: KeyValue>(
    fields: &mut Fields<'_>,
    problems: &mut Problems,
    slopes: &Kind<V>,
) -> Tangents<V> {
    let both = fields.optional("slope");
    let [incoming, outgoing] = ["slope_in", "slope_out"].map(|name| fields.optional(name));
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
