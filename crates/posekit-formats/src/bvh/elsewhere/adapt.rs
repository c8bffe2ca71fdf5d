//! A document changed so that a program reads it correctly.

use posekit::motion::Channel;
use posekit::rotation::{Axis, EulerOrder};

use super::peculiarity::{self, ChannelCount};
use super::{Program, names};
use crate::bvh::document::implied_end_name;
use crate::bvh::edit::columns::lay_out;
use crate::bvh::edit::rotation_order::set_rotation_order_of;
use crate::bvh::edit::{ChannelSet, set_channels};
use crate::bvh::{Bvh, BvhJoint, BvhMotion, EndName};

/// How many names a sentence about changes lists.
const NAMES_LISTED: usize = 4;
/// Seconds between frames where a skeleton without motion gets a frame.
const STILL_FRAME_TIME_SECS: f64 = 1.0 / 30.0;

/// Why no change makes a program read a document right.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Obstacle {
    /// The program has no position channels below the root, and a joint moves in its parent's space.
    #[error(
        "{program} has no position channels below the root, and '{joint}' moves in its parent's space, by up to {range:.3}"
    )]
    MovesBelowRoot {
        /// What the program is called.
        program: &'static str,
        /// The joint that moves most.
        joint: String,
        /// How far it goes from its place in the first frame, along one axis, in the file's unit.
        range: f64,
    },
    /// The program reads one root, and the roots move on their own.
    #[error(
        "{program} reads one root and has no position channels below it, and the file has {count} roots"
    )]
    SeveralRoots {
        /// What the program is called.
        program: &'static str,
        /// How many roots there are.
        count: usize,
    },
    /// The frame time is not above zero, and what it should be is not known.
    #[error("the frame time is not above zero, which {program} cannot play")]
    NoFrameTime {
        /// What the program is called.
        program: &'static str,
    },
}

/// Changes a document so that `program` reads the same motion from it as posekit, once it is written anew, and says
/// what was changed, a sentence each. What no rule of [`RULES`](super::RULES) asks for stays as it is, to the bit.
///
/// Joints keep their places and orientations in every frame. The rest pose may change: where three.js would add an
/// OFFSET to position channels that move, the OFFSET becomes zero.
///
/// # Errors
/// Where the program cannot hold the motion at all; the document is then as it was.
pub fn adapt(bvh: &mut Bvh, program: Program) -> Result<Vec<String>, Obstacle> {
    let mut adapted = bvh.clone();
    let mut changes = Vec::new();
    check_frame_time(&adapted, program)?;
    changes.extend(join_roots(&mut adapted, program)?);
    changes.extend(add_frame(&mut adapted));
    let renamed = names::make_plain(&mut adapted, program == Program::Three);
    changes.extend(rename_sentence(&renamed));
    if matches!(program, Program::Three | Program::Pybvh) {
        changes.extend(fold_positions(&mut adapted, program)?);
    }
    changes.extend(resolve_rotations(&mut adapted, program));
    changes.extend(complete_channels(&mut adapted, program));
    if program == Program::Three {
        changes.extend(clear_offsets(&mut adapted));
    }
    if program == Program::Assimp {
        changes.extend(drop_end_names(&mut adapted));
    }
    *bvh = adapted;
    Ok(changes)
}

/// Leaves out the names of End Sites, which are written again otherwise.
fn drop_end_names(bvh: &mut Bvh) -> Option<String> {
    let mut count = 0;
    for index in 0..bvh.joints.len() {
        let joint = &bvh.joints[index];
        if let Some(parent) = joint.parent.filter(|_| joint.end_name != EndName::Implied) {
            bvh.joints[index].name = implied_end_name(&bvh.joints[parent].name);
            bvh.joints[index].end_name = EndName::Implied;
            count += 1;
        }
    }
    let sites = if count == 1 { "End Site" } else { "End Sites" };
    (count > 0).then(|| format!("leaves out the names of {count} {sites}"))
}

fn check_frame_time(bvh: &Bvh, program: Program) -> Result<(), Obstacle> {
    let is_played = matches!(program, Program::Three | Program::Pybvh | Program::Assimp);
    match &bvh.motion {
        Some(motion) if is_played && motion.frame_time().is_none() => Err(Obstacle::NoFrameTime {
            program: program.title(),
        }),
        _ => Ok(()),
    }
}

/// Hangs several roots from a new one that stands still at the origin.
fn join_roots(bvh: &mut Bvh, program: Program) -> Result<Option<String>, Obstacle> {
    let count = bvh
        .joints
        .iter()
        .filter(|joint| joint.parent.is_none())
        .count();
    if count < 2 || program == Program::Blender {
        return Ok(None);
    }
    if program == Program::Pybvh {
        return Err(Obstacle::SeveralRoots {
            program: program.title(),
            count,
        });
    }
    for joint in &mut bvh.joints {
        joint.parent = Some(joint.parent.map_or(0, |parent| parent + 1));
    }
    let is_taken = |name: &str| bvh.joints.iter().any(|joint| joint.name == name.as_bytes());
    let mut name = "Root".to_owned();
    while is_taken(&name) {
        name.push('_');
    }
    let root = BvhJoint {
        name: name.clone().into_bytes(),
        parent: None,
        offset: [0.0; 3],
        channels: six_channels(),
        is_end_site: false,
        end_name: EndName::Implied,
    };
    let still = root.channels.len();
    let rows: Vec<f64> = bvh
        .rows()
        .flat_map(|row| core::iter::repeat_n(0.0, still).chain(row.iter().copied()))
        .collect();
    bvh.joints.insert(0, root);
    if let Some(motion) = &mut bvh.motion {
        motion.values = rows;
    }
    Ok(Some(format!(
        "hangs its {count} roots from a new one, '{name}'"
    )))
}

fn six_channels() -> Vec<Channel> {
    let positions = Axis::ALL.map(Channel::Position);
    let rotations = EulerOrder::ZXY
        .axes()
        .iter()
        .copied()
        .map(Channel::Rotation);
    positions.into_iter().chain(rotations).collect()
}

/// Gives a document without frames one of its rest pose.
fn add_frame(bvh: &mut Bvh) -> Option<String> {
    if bvh.frame_count() > 0 {
        return None;
    }
    let values = bvh.joints.iter().flat_map(|joint| {
        joint.channels.iter().map(|channel| match channel {
            Channel::Position(axis) => joint.offset[axis.index()],
            Channel::Rotation(_) => 0.0,
        })
    });
    let frame_time_secs = bvh
        .motion
        .as_ref()
        .map_or(STILL_FRAME_TIME_SECS, |motion| motion.frame_time_secs);
    bvh.motion = Some(BvhMotion {
        frame_time_secs,
        frame_count: 1,
        values: values.collect(),
    });
    Some("has one frame, the rest pose".to_owned())
}

fn rename_sentence(renamed: &[(String, String)]) -> Option<String> {
    let (first, rest) = renamed.split_first()?;
    let more = match rest.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some(format!("calls '{}' '{}'{more}", first.0, first.1))
}

/// Puts what position channels below the root hold all the time into the OFFSET.
fn fold_positions(bvh: &mut Bvh, program: Program) -> Result<Option<String>, Obstacle> {
    let has_positions =
        |joint: &BvhJoint| joint.parent.is_some() && peculiarity::count(joint).positions > 0;
    let before: Vec<usize> = indices(bvh, has_positions);
    let kept = set_channels(bvh, ChannelSet::RotationsAndMovingRoots);
    let most = kept.iter().max_by(|a, b| a.range.total_cmp(&b.range));
    if let Some(most) = most.filter(|_| program == Program::Pybvh) {
        return Err(Obstacle::MovesBelowRoot {
            program: program.title(),
            joint: bvh.joints[most.joint].name().into_owned(),
            range: most.range,
        });
    }
    let folded: Vec<usize> = before
        .into_iter()
        .filter(|&index| peculiarity::count(&bvh.joints[index]).positions == 0)
        .collect();
    Ok(sentence(
        bvh,
        &folded,
        "has the place of",
        "in the OFFSET instead of position channels",
    ))
}

/// Brings four rotation channels and more, or an axis twice, to three.
fn resolve_rotations(bvh: &mut Bvh, program: Program) -> Option<String> {
    let is_odd = |joint: &BvhJoint| {
        let has = peculiarity::count(joint);
        let matters = match program {
            Program::Three => false,
            Program::Assimp => has.positions > 0 && has.rotations != 3,
            Program::Blender | Program::Pybvh | Program::Bvhio => true,
        };
        matters && has.has_odd_rotations
    };
    let odd = indices(bvh, is_odd);
    set_rotation_order_of(bvh, EulerOrder::ZXY, is_odd);
    sentence(
        bvh,
        &odd,
        "turns",
        "by three rotation channels in the order ZXY",
    )
}

/// Adds the channels that a program wants and a joint has not.
fn complete_channels(bvh: &mut Bvh, program: Program) -> Option<String> {
    let starts = bvh.column_starts();
    let mut sources = Vec::new();
    let mut channels = Vec::with_capacity(bvh.joints.len());
    let mut completed = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        let wanted = wanted_channels(joint, program);
        if wanted != joint.channels {
            completed.push(index);
        }
        sources.extend(wanted.iter().map(|&channel| {
            let place = joint.channels.iter().position(|&known| known == channel);
            match (place, channel) {
                (Some(place), _) => Source::Column(starts[index] + place),
                (None, Channel::Position(axis)) => Source::Constant(joint.offset[axis.index()]),
                (None, Channel::Rotation(_)) => Source::Constant(0.0),
            }
        }));
        channels.push(wanted);
    }
    if completed.is_empty() {
        return None;
    }
    lay_out(bvh, channels, |old, new| {
        for (value, source) in new.iter_mut().zip(&sources) {
            *value = match *source {
                Source::Column(column) => old[column],
                Source::Constant(number) => number,
            };
        }
    });
    sentence(
        bvh,
        &completed,
        "gives",
        "all the channels that it looks for",
    )
}

/// Where a column's numbers come from.
enum Source {
    Column(usize),
    Constant(f64),
}

/// The channels that a joint has for a program. A channel is never listed twice unless the joint stays as it is.
fn wanted_channels(joint: &BvhJoint, program: Program) -> Vec<Channel> {
    let has = peculiarity::count(joint);
    let is_root = joint.parent.is_none();
    let has_offset = joint.offset.iter().any(|&number| number != 0.0);
    let (all_positions, all_rotations) = match program {
        _ if joint.is_end_site => (false, false),
        // An OFFSET on an axis without a channel would be lost when the OFFSET becomes zero.
        Program::Three => (has.has_some_positions && has_offset, false),
        Program::Blender => (has.has_some_positions, matches!(has.rotations, 1 | 2)),
        Program::Pybvh => (
            is_root && !peculiarity::has_positions_xyz(joint),
            has.rotations < 3,
        ),
        Program::Bvhio => (false, false),
        Program::Assimp => (
            has.has_some_positions,
            has.positions > 0 && has.rotations < 3,
        ),
    };
    let mut channels = Vec::with_capacity(6);
    if all_positions {
        channels.extend(Axis::ALL.map(Channel::Position));
    }
    let is_kept = |channel: &Channel| !(all_positions && matches!(channel, Channel::Position(_)));
    channels.extend(joint.channels.iter().copied().filter(is_kept));
    if all_rotations {
        let missing = EulerOrder::ZXY
            .axes()
            .iter()
            .copied()
            .map(Channel::Rotation);
        channels.extend(missing.filter(|channel| !joint.channels.contains(channel)));
    }
    channels
}

/// Makes the OFFSET zero where position channels hold the whole place.
fn clear_offsets(bvh: &mut Bvh) -> Option<String> {
    let adds_up = |joint: &BvhJoint| {
        let ChannelCount { positions, .. } = peculiarity::count(joint);
        positions > 0 && joint.offset.iter().any(|&number| number != 0.0)
    };
    let cleared = indices(bvh, adds_up);
    for &index in &cleared {
        bvh.joints[index].offset = [0.0; 3];
    }
    sentence(
        bvh,
        &cleared,
        "sets the OFFSET of",
        "to zero: its position channels say where it is",
    )
}

fn indices(bvh: &Bvh, is_meant: impl Fn(&BvhJoint) -> bool) -> Vec<usize> {
    let joints = bvh.joints.iter().enumerate();
    joints
        .filter(|(_, joint)| is_meant(joint))
        .map(|(index, _)| index)
        .collect()
}

/// `turns Hips, Spine and 3 more ...`; nothing where there are no joints.
fn sentence(bvh: &Bvh, joints: &[usize], verb: &str, rest: &str) -> Option<String> {
    let listed: Vec<_> = joints
        .iter()
        .take(NAMES_LISTED)
        .map(|&joint| bvh.joints[joint].name())
        .collect();
    let more = match joints.len() - listed.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!joints.is_empty()).then(|| format!("{verb} {}{more} {rest}", listed.join(", ")))
}
