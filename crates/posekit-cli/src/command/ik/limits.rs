//! Joint limits: from the file's channels and what they do in its motion, from a JSON file, from the command
//! line.
//!
//! ```json
//! {
//!   "LeftElbow":  {"hinge": {"axis": [0, 1, 0], "range": [0, 150]}},
//!   "*Shoulder":  {"cone": {"axis": [1, 0, 0], "swing": 100, "twist": [-90, 90]}, "stiffness": 0.1},
//!   "Spine*":     {"euler": {"order": "ZXY", "ranges": [[-20, 20], [-30, 45], [-30, 30]]}},
//!   "Hips":       {"fixed": true},
//!   "Rail":       {"slide": {"axis": [0, 0, 1], "range": [0, 0.5]}}
//! }
//! ```
//!
//! Angles are degrees, distances in the motion's unit; an end of a range that is `null` means no limit. Names may
//! be patterns; an entry for a name counts over one for a pattern.

use std::str::FromStr;

use glam::DVec3;
use posekit::ik::{Interval, JointLimit, JointLimits};
use posekit::motion::Channel;
use posekit::rotation::EulerOrder;
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::bvh::Bvh;
use posekit_formats::bvh::edit::joint_limit;
use serde_json::{Map, Value};

use super::IkArgs;
use super::figure::Figure;
use crate::args::Global;
use crate::bytes;
use crate::failure::Failure;
use crate::select;

/// A joint's stiffness, as `Spine=0.8`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stiffness {
    joints: String,
    share: f64,
}

impl FromStr for Stiffness {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.rsplit_once('=');
        let share = parts.and_then(|(_, share)| share.trim().parse().ok());
        match (parts, share) {
            (Some((joints, _)), Some(share)) if (0.0..=1.0).contains(&share) => Ok(Self {
                joints: joints.to_owned(),
                share,
            }),
            _ => Err("expected a joint and a number from 0 to 1, such as Spine=0.8".to_owned()),
        }
    }
}

/// The limits of a figure: what its channels cannot do, then what the user says.
pub(super) fn limits(
    args: &IkArgs,
    figure: &Figure,
    global: &Global,
) -> Result<JointLimits, Failure> {
    let mut limits = JointLimits::default();
    for (index, joint) in figure.bvh.joints.iter().enumerate() {
        if !joint.is_end_site {
            set_limit(&mut limits, JointId::new(index), joint_limit(joint))?;
        }
    }
    if let Some(beyond_deg) = args.within_motion {
        if !(beyond_deg >= 0.0 && beyond_deg.is_finite()) {
            return Err(Failure::usage(
                "--within-motion must be an angle of zero or more",
            ));
        }
        keep_within_motion(&figure.bvh, beyond_deg, &mut limits)?;
    }
    if let Some(path) = &args.limits {
        let name = path.display().to_string();
        let bytes = bytes::of_file(path, &global.guard)?;
        read(&bytes, &figure.skeleton, &mut limits).map_err(|failure| failure.in_file(&name))?;
    }
    for stiffness in &args.stiffness {
        let wanted = [stiffness.joints.clone()];
        for joint in select::joints(&figure.skeleton, &wanted)? {
            set_stiffness(&mut limits, joint, stiffness.share)?;
        }
    }
    Ok(limits)
}

/// Limits each joint but the roots to the range that each of its rotation channels has in the motion, and so
/// much beyond.
fn keep_within_motion(bvh: &Bvh, beyond_deg: f64, limits: &mut JointLimits) -> Result<(), Failure> {
    let starts = bvh.column_starts();
    for (index, joint) in bvh.joints.iter().enumerate() {
        let mut axes = Vec::new();
        let mut angles_rad = Vec::new();
        for (place, channel) in joint.channels.iter().enumerate() {
            let Channel::Rotation(axis) = channel else {
                continue;
            };
            let values = bvh.rows().map(|row| row[starts[index] + place]);
            let (least, most) = values
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(value), high.max(value))
                });
            axes.push(*axis);
            angles_rad.push(Interval::new(
                (least - beyond_deg).to_radians(),
                (most + beyond_deg).to_radians(),
            ));
        }
        let order = EulerOrder::new(&axes)
            .ok()
            .filter(|order| order.is_complete());
        if let (Some(order), &[first, second, third], Some(_)) =
            (order, angles_rad.as_slice(), joint.parent)
        {
            let angles_rad = [first, second, third];
            set_limit(
                limits,
                JointId::new(index),
                JointLimit::Euler { order, angles_rad },
            )?;
        }
    }
    Ok(())
}

fn set_limit(limits: &mut JointLimits, joint: JointId, limit: JointLimit) -> Result<(), Failure> {
    limits
        .set_limit(joint, limit)
        .map_err(|error| Failure::new(error.to_string()))
}

fn set_stiffness(limits: &mut JointLimits, joint: JointId, share: f64) -> Result<(), Failure> {
    limits
        .set_stiffness(joint, share)
        .map_err(|error| Failure::new(error.to_string()))
}

fn read(bytes: &[u8], skeleton: &Skeleton, limits: &mut JointLimits) -> Result<(), Failure> {
    let value: Value = serde_json::from_slice(bytes).map_err(|error| {
        let text = error.to_string();
        let what = text.split(" at line").next().unwrap_or(&text).to_owned();
        let place = format!("{}:{}", error.line(), error.column());
        Failure::new(format!("{place}: expected JSON, as in docs/ik.md: {what}"))
    })?;
    let Value::Object(entries) = value else {
        return Err(Failure::new(
            "expected an object of joints and their limits",
        ));
    };
    let is_pattern = |name: &str| name.contains(['*', '?', '[']);
    let (patterns, names): (Vec<_>, Vec<_>) =
        entries.iter().partition(|(name, _)| is_pattern(name));
    for (name, entry) in patterns.into_iter().chain(names) {
        let at = |failure: Failure| failure.in_file(&format!("\"{name}\""));
        let joints = select::joints(skeleton, std::slice::from_ref(name)).map_err(at)?;
        let Value::Object(entry) = entry else {
            return Err(at(Failure::new(
                "expected an object such as {\"fixed\": true}",
            )));
        };
        apply(entry, &joints, limits).map_err(at)?;
    }
    Ok(())
}

fn apply(
    entry: &Map<String, Value>,
    joints: &[JointId],
    limits: &mut JointLimits,
) -> Result<(), Failure> {
    for (kind, value) in entry {
        let limit =
            match kind.as_str() {
                "stiffness" => {
                    let share = number(value)?;
                    for &joint in joints {
                        set_stiffness(limits, joint, share)?;
                    }
                    continue;
                }
                "hinge" => JointLimit::Hinge {
                    axis: axis(field(value, "axis")?)?,
                    angle_rad: degrees(field(value, "range")?)?,
                },
                "slide" => JointLimit::Slide {
                    axis: axis(field(value, "axis")?)?,
                    distance: range(field(value, "range")?)?,
                },
                "cone" => JointLimit::Cone {
                    axis: axis(field(value, "axis")?)?,
                    swing_max_rad: number(field(value, "swing")?)?.to_radians(),
                    twist_rad: value.get("twist").map_or(Ok(Interval::ALL), degrees)?,
                },
                "euler" => euler(value)?,
                "fixed" if *value == Value::Bool(true) => JointLimit::Fixed,
                "free" if *value == Value::Bool(true) => JointLimit::Free,
                _ => {
                    return Err(Failure::new(format!("'{kind}' is not a kind of limit")).try_next(
                    "the kinds are hinge, cone, euler, slide, fixed and free, and stiffness",
                ));
                }
            };
        for &joint in joints {
            set_limit(limits, joint, limit)?;
        }
    }
    Ok(())
}

fn euler(value: &Value) -> Result<JointLimit, Failure> {
    let order = field(value, "order")?
        .as_str()
        .and_then(|text| text.parse::<EulerOrder>().ok())
        .ok_or_else(|| Failure::new("expected an order of axes, such as \"ZXY\""))?;
    let ranges = field(value, "ranges")?;
    let ranges = ranges
        .as_array()
        .filter(|list| list.len() == order.axes().len());
    let ranges =
        ranges.ok_or_else(|| Failure::new("expected a range for each axis of the order"))?;
    let mut angles_rad = [Interval::ALL; 3];
    for (angle, given) in angles_rad.iter_mut().zip(ranges) {
        *angle = degrees(given)?;
    }
    Ok(JointLimit::Euler { order, angles_rad })
}

fn field<'a>(value: &'a Value, name: &str) -> Result<&'a Value, Failure> {
    value
        .get(name)
        .ok_or_else(|| Failure::new(format!("expected a field '{name}'")))
}

fn number(value: &Value) -> Result<f64, Failure> {
    value
        .as_f64()
        .ok_or_else(|| Failure::new(format!("expected a number, found {value}")))
}

fn axis(value: &Value) -> Result<DVec3, Failure> {
    let numbers: Option<Vec<f64>> = value
        .as_array()
        .and_then(|list| list.iter().map(Value::as_f64).collect());
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err(Failure::new(format!(
            "expected an axis such as [0, 1, 0], found {value}"
        ))),
    }
}

fn range(value: &Value) -> Result<Interval, Failure> {
    let wrong = || Failure::new(format!("expected a range such as [-10, 90], found {value}"));
    let ends = value
        .as_array()
        .filter(|list| list.len() == 2)
        .ok_or_else(wrong)?;
    let end = |value: &Value, without: f64| match value {
        Value::Null => Ok(without),
        value => value.as_f64().ok_or_else(wrong),
    };
    Ok(Interval::new(
        end(&ends[0], f64::NEG_INFINITY)?,
        end(&ends[1], f64::INFINITY)?,
    ))
}

fn degrees(value: &Value) -> Result<Interval, Failure> {
    let Interval { min, max } = range(value)?;
    Ok(Interval::new(min.to_radians(), max.to_radians()))
}
