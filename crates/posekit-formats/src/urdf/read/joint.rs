//! Joints: what they connect, how they move, how far, and which other joint they follow.

use super::Names;
use super::value::{number, numbers, origin, required, required_child};
use super::xml::Element;
use posekit::range::{LONGEST_LENGTH, are_lengths};

use crate::report::{ReadError, ReadErrorKind, Reporter, WarningCode, quote};
use crate::urdf::{UrdfJoint, UrdfJointKind, UrdfLimit, UrdfMimic};

/// How far from 1 an axis' length may be without a word about it: numbers with four digits pass.
const AXIS_LENGTH_TOLERANCE: f64 = 1e-3;

/// Below this length an axis says no direction.
const ZERO_AXIS: f64 = 1e-9;

/// A `<joint>`, its mimic apart, which [`read_mimic`] reads when all joints are known.
pub(super) fn read(
    element: Element<'_, '_>,
    links: &Names,
    reporter: &mut Reporter<'_>,
) -> Result<UrdfJoint, ReadError> {
    let (name, _) = required(element, "name", reporter)?;
    let kind = read_kind(element, reporter)?;
    let parent = read_link(element, "parent", links, reporter)?;
    let child = read_link(element, "child", links, reporter)?;
    Ok(UrdfJoint {
        name: name.into_owned(),
        kind,
        parent,
        child,
        origin: origin(element, reporter)?,
        axis: read_axis(element, kind, reporter)?,
        limit: read_limit(element, kind, reporter)?,
        mimic: None,
    })
}

fn read_kind(
    element: Element<'_, '_>,
    reporter: &mut Reporter<'_>,
) -> Result<UrdfJointKind, ReadError> {
    let (word, at) = required(element, "type", reporter)?;
    let kind = UrdfJointKind::ALL
        .into_iter()
        .find(|kind| kind.name() == word);
    kind.ok_or_else(|| {
        let expected = "revolute, continuous, prismatic, fixed, floating or planar";
        reporter.unexpected(at, expected, quote(word.as_bytes()))
    })
}

/// The link that `<parent>` or `<child>` names.
fn read_link(
    element: Element<'_, '_>,
    side: &str,
    links: &Names,
    reporter: &mut Reporter<'_>,
) -> Result<usize, ReadError> {
    let (name, at) = required(required_child(element, side, reporter)?, "link", reporter)?;
    links.get(&name).ok_or_else(|| {
        let found = format!("{}, which is no link of it", quote(name.as_bytes()));
        reporter.error(ReadErrorKind::UnknownName, at, "a link of this file", found)
    })
}

/// The unit axis; X where the file gives none, as the format says.
fn read_axis(
    element: Element<'_, '_>,
    kind: UrdfJointKind,
    reporter: &mut Reporter<'_>,
) -> Result<[f64; 3], ReadError> {
    const DEFAULT: [f64; 3] = [1.0, 0.0, 0.0];
    let Some(axis) = element.child("axis") else {
        return Ok(DEFAULT);
    };
    let given: [f64; 3] = numbers(axis, "xyz", reporter)?.unwrap_or(DEFAULT);
    // Scaled first, so that squares neither vanish nor overflow.
    let size = given
        .iter()
        .fold(0.0, |size: f64, part| size.max(part.abs()));
    let uses_axis = !matches!(kind, UrdfJointKind::Fixed | UrdfJointKind::Floating);
    if size < ZERO_AXIS {
        if uses_axis {
            let found = "one without a length";
            return Err(reporter.unexpected(axis.at(), "an axis with a direction", found));
        }
        return Ok(DEFAULT);
    }
    let scaled = given.map(|part| part / size);
    let length = scaled.iter().map(|part| part * part).sum::<f64>().sqrt();
    if uses_axis && (length * size - 1.0).abs() > AXIS_LENGTH_TOLERANCE {
        reporter.warn(WarningCode::AxisNotUnit, axis.at(), || {
            let long = length * size;
            format!("an axis is {long} long instead of 1; its direction is used")
        });
    }
    Ok(scaled.map(|part| part / length))
}

fn read_limit(
    element: Element<'_, '_>,
    kind: UrdfJointKind,
    reporter: &mut Reporter<'_>,
) -> Result<Option<UrdfLimit>, ReadError> {
    let is_limited = matches!(kind, UrdfJointKind::Revolute | UrdfJointKind::Prismatic);
    let Some(limit) = element.child("limit") else {
        if is_limited {
            reporter.warn(WarningCode::MissingJointLimit, element.at(), || {
                format!("a {} joint has no limit; it moves freely", kind.name())
            });
        }
        return Ok(None);
    };
    // A bound that is not given is zero, as the format says.
    let mut lower = number(limit, "lower", reporter)?.unwrap_or(0.0);
    let mut upper = number(limit, "upper", reporter)?.unwrap_or(0.0);
    if lower > upper {
        if is_limited {
            reporter.warn(WarningCode::ReversedJointLimit, limit.at(), || {
                format!("the lower limit {lower} is above the upper one {upper}; they are swapped")
            });
        }
        (lower, upper) = (upper, lower);
    }
    Ok(Some(UrdfLimit {
        lower,
        upper,
        effort: number(limit, "effort", reporter)?,
        velocity: number(limit, "velocity", reporter)?,
    }))
}

/// The `<mimic>` of a joint, when all joints are known. One that makes no sense is warned of: the joint keeps a value
/// of its own.
pub(super) fn read_mimic(
    element: Element<'_, '_>,
    joint: &UrdfJoint,
    joints: &[UrdfJoint],
    names: &Names,
    reporter: &mut Reporter<'_>,
) -> Option<UrdfMimic> {
    let mimic = element.child("mimic")?;
    if joint.kind == UrdfJointKind::Fixed {
        return None;
    }
    let read = sound_mimic(mimic, joint.kind, joints, names, reporter);
    read.map_err(|(at, why)| warn_of_mimic(&joint.name, at, &why, reporter))
        .ok()
}

/// Says why a joint does not follow another.
pub(super) fn warn_of_mimic(name: &str, at: usize, why: &str, reporter: &mut Reporter<'_>) {
    reporter.warn(WarningCode::BrokenMimic, at, || {
        let name = quote(name.as_bytes());
        format!("joint {name} mimics {why}; it keeps its own value")
    });
}

/// A mimic that makes sense, or where and why it does not.
fn sound_mimic(
    mimic: Element<'_, '_>,
    kind: UrdfJointKind,
    joints: &[UrdfJoint],
    names: &Names,
    reporter: &mut Reporter<'_>,
) -> Result<UrdfMimic, (usize, String)> {
    let nothing = (mimic.at(), "no joint by name".to_owned());
    let name = mimic.attribute("joint", reporter).ok().flatten();
    let (name, at) = name.ok_or(nothing)?;
    let quoted = quote(name.as_bytes());
    let followed = names.get(&name);
    let followed = followed.ok_or_else(|| (at, format!("{quoted}, which is not a joint")))?;
    if kind.value_count() != 1 {
        return Err((at, format!("{quoted}, and {} joints cannot", kind.name())));
    }
    let other = joints[followed].kind;
    if other.value_count() != 1 {
        return Err((at, format!("{quoted}, which is {}", other.name())));
    }
    let mut factor = |name: &str, default| match number(mimic, name, reporter) {
        Ok(Some(given)) if !are_lengths([given]) => Err((
            at,
            format!("{quoted} with {name} {given:?}, which is not within {LONGEST_LENGTH:e}"),
        )),
        Ok(given) => Ok(given.unwrap_or(default)),
        Err(error) => Err((at, format!("{quoted} with {name} {}", error.found))),
    };
    Ok(UrdfMimic {
        joint: followed,
        multiplier: factor("multiplier", 1.0)?,
        offset: factor("offset", 0.0)?,
    })
}
