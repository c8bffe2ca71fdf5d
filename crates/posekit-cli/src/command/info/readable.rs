//! The facts, for people.

use posekit::body::{Certainty, Limb};
use posekit::figure::{ArmPosture, RestPose, RestPoseKind, STATURE_RANGE_METRES};
use posekit::motion::Channel;
use posekit::rotation::Axis;
use posekit_formats::report::Warning;

use super::facts::Facts;
use super::tree;
use crate::console::{DIM, HEADING, styled};
use crate::failure::one_line;
use crate::load::{Loaded, is_repair};
use crate::text::{counted, decimals_for, duration, fixed, trimmed};
use crate::up;

/// How many pairs are named before the rest are counted.
const PAIRS_NAMED: usize = 4;
/// Names of joints beyond this many are counted.
const JOINTS_NAMED: usize = 4;

/// Everything about a file, as lines with a label each.
pub(super) fn block(name: &str, facts: &Facts, loaded: &Loaded, with_tree: bool) -> String {
    let mut text = format!("{}\n", styled(HEADING, &one_line(name)));
    line(&mut text, "joints", &joints(facts));
    line(&mut text, "frames", &frames(facts));
    for (index, group) in channels(facts, loaded).into_iter().enumerate() {
        line(&mut text, if index == 0 { "channels" } else { "" }, &group);
    }
    if let Some(relative) = &facts.relative_positions {
        line(&mut text, "positions", &one_line(&relative.advice()));
    }
    line(&mut text, "height", &height(facts));
    line(&mut text, "unit", &unit(facts));
    line(&mut text, "up", &up::in_words(facts.up));
    line(&mut text, "rest pose", &rest_pose(&facts.rest_pose));
    line(&mut text, "left/right", &pairs(facts));
    for (index, value) in landmarks(facts).into_iter().enumerate() {
        line(&mut text, if index == 0 { "landmarks" } else { "" }, &value);
    }
    for (index, notice) in loaded.notices.iter().enumerate() {
        line(
            &mut text,
            if index == 0 { "noticed" } else { "" },
            &notice_text(notice),
        );
    }
    if with_tree {
        text.push('\n');
        text.push_str(&tree::draw(&facts.skeleton, loaded));
    }
    text
}

/// Adds a line with a label.
pub(super) fn line(text: &mut String, label: &str, value: &str) {
    text.push_str(&styled(DIM, &format!("  {label:<12}")));
    text.push_str(value);
    text.push('\n');
}

fn joints(facts: &Facts) -> String {
    let mut ends = counted(facts.end_site_count, "end site");
    if !facts.end_site_names.is_empty() {
        let mut names: Vec<String> = facts
            .end_site_names
            .iter()
            .take(JOINTS_NAMED)
            .map(|name| one_line(name))
            .collect();
        if facts.end_site_names.len() > JOINTS_NAMED {
            names.push("...".to_owned());
        }
        ends = format!("{ends} (named {})", names.join(", "));
    }
    let levels = counted(facts.level_count, "level");
    let roots: Vec<String> = facts
        .roots
        .iter()
        .take(JOINTS_NAMED)
        .map(|r| one_line(r))
        .collect();
    let more = if facts.roots.len() > JOINTS_NAMED {
        ", ..."
    } else {
        ""
    };
    let noun = if facts.roots.len() == 1 {
        "root"
    } else {
        "roots"
    };
    format!(
        "{} with {ends}, {levels}, {noun} {}{more}",
        facts.joint_count,
        roots.join(", ")
    )
}

fn frames(facts: &Facts) -> String {
    if !facts.has_motion {
        return "none: the file is a skeleton without motion".to_owned();
    }
    let count = crate::text::grouped(facts.frame_count);
    match facts.fps() {
        Some(fps) => {
            let length = duration(facts.duration_secs());
            format!("{count} at {} fps, {length} long", trimmed(fps, 2))
        }
        None => format!("{count} with a frame time of {:?} s", facts.frame_time_secs),
    }
}

fn channels(facts: &Facts, loaded: &Loaded) -> Vec<String> {
    let mut lines = vec![format!("{} a frame", facts.channel_count)];
    for group in &facts.channel_groups {
        let mut names: Vec<String> = group
            .joints
            .iter()
            .take(JOINTS_NAMED)
            .map(|&joint| one_line(&loaded.bvh.joints[joint].name()))
            .collect();
        if group.joints.len() > JOINTS_NAMED {
            names.truncate(2);
            names.push("...".to_owned());
        }
        let joints = counted(group.joints.len(), "joint");
        let channels = channel_text(&group.channels);
        let channels = if channels.is_empty() {
            "none".to_owned()
        } else {
            channels
        };
        lines.push(format!("{channels}: {joints} ({})", names.join(", ")));
    }
    lines
}

/// `position XYZ, rotation ZXY`: runs of one kind together.
pub(super) fn channel_text(channels: &[Channel]) -> String {
    let mut runs: Vec<(&str, String)> = Vec::new();
    for channel in channels {
        let (kind, axis) = match channel {
            Channel::Position(axis) => ("position", axis),
            Channel::Rotation(axis) => ("rotation", axis),
        };
        match runs.last_mut().filter(|(last, _)| *last == kind) {
            Some((_, axes)) => axes.push(axis.letter()),
            None => runs.push((kind, axis.letter().to_string())),
        }
    }
    let runs: Vec<String> = runs
        .into_iter()
        .map(|(kind, axes)| format!("{kind} {axes}"))
        .collect();
    runs.join(", ")
}

fn height(facts: &Facts) -> String {
    let decimals = decimals_for(facts.rest_height);
    let rest = fixed(facts.rest_height, decimals);
    match facts.motion_height {
        Some(height) => format!("{} in motion, {rest} at rest", fixed(height, decimals)),
        None => format!("{rest} at rest"),
    }
}

fn unit(facts: &Facts) -> String {
    let height = facts.motion_height.unwrap_or(facts.rest_height);
    let (low, high) = STATURE_RANGE_METRES;
    match facts.unit {
        Some(unit) => {
            let metres = fixed(height * unit.metres(), 2);
            format!(
                "probably {}: the figure is then {metres} m tall",
                unit.name()
            )
        }
        None => format!(
            "unknown: in no common unit is {} within a person's {low} m to {high} m",
            trimmed(height, decimals_for(height))
        ),
    }
}

/// The rest pose in words.
pub(super) fn rest_pose(rest: &RestPose) -> String {
    let posture = match rest.kind {
        RestPoseKind::Collapsed => return "all joints in one place".to_owned(),
        RestPoseKind::NoLimbPairs => return "no pairs of arms and legs to tell from".to_owned(),
        RestPoseKind::Standing(ArmPosture::Sideways) => "T-pose",
        RestPoseKind::Standing(ArmPosture::SidewaysDown) => "A-pose",
        RestPoseKind::Standing(ArmPosture::Hanging) => "standing, arms down",
        RestPoseKind::Standing(ArmPosture::Up) => "standing, arms up",
        RestPoseKind::Standing(ArmPosture::Forward) => "standing, arms forward",
        _ => {
            let along = rest.up.map_or(String::new(), |axis| {
                format!(" (spine along {})", end(axis))
            });
            return format!(
                "not a posture: nobody stands as the OFFSETs do{along}; the posture is in the motion"
            );
        }
    };
    let mut text = posture.to_owned();
    if let Some(up) = rest.up {
        text.push_str(&format!(", {} up", end(up)));
    }
    if let Some(facing) = rest.facing {
        text.push_str(&format!(", facing {}", end(facing)));
    }
    text
}

fn end((axis, is_positive): (Axis, bool)) -> String {
    format!("{}{}", if is_positive { '+' } else { '-' }, axis.letter())
}

/// How sure the landmarks are, in words.
fn certainty(certainty: Certainty) -> &'static str {
    match certainty {
        Certainty::Sure => "sure: names, lengths and angles agree",
        Certainty::Likely => "likely: not all of names, lengths and angles say so",
    }
}

/// The joints of the trunk and the limbs, and how sure that is.
fn landmarks(facts: &Facts) -> Vec<String> {
    let anatomy = match &facts.anatomy {
        Ok(anatomy) => anatomy,
        Err(why) if why.is_doubt() => return vec![format!("unsure, drawn as bones: {why}")],
        Err(why) => return vec![format!("not a person's: {why}")],
    };
    let name = |joint| one_line(facts.skeleton.unique_name(joint));
    let limb = |limb: &Limb| {
        [limb.upper, limb.middle, limb.lower]
            .map(name)
            .join(" \u{b7} ")
    };
    let trunk = [
        anatomy.pelvis,
        anatomy.chest(),
        anatomy.neck(),
        anatomy.head,
    ];
    let [pelvis, chest, neck, head] = trunk.map(name);
    let mut lines = vec![
        certainty(anatomy.certainty).to_owned(),
        format!("pelvis {pelvis}, chest {chest}, neck {neck}, head {head}"),
    ];
    for [left, right] in std::iter::once(&anatomy.legs).chain(&anatomy.arms) {
        lines.push(format!("{} | {}", limb(left), limb(right)));
    }
    lines
}

fn pairs(facts: &Facts) -> String {
    if facts.pairs.is_empty() {
        return "no pairs".to_owned();
    }
    let named = facts.pairs.iter().take(PAIRS_NAMED);
    let named: Vec<String> = named
        .map(|(left, right)| format!("{} | {}", one_line(left), one_line(right)))
        .collect();
    let more = if facts.pairs.len() > PAIRS_NAMED {
        ", ..."
    } else {
        ""
    };
    format!(
        "{}: {}{more}",
        counted(facts.pairs.len(), "pair"),
        named.join(", ")
    )
}

/// What the reader noticed, and where.
pub(super) fn notice_text(notice: &Warning) -> String {
    let weight = if is_repair(notice) { "warning" } else { "note" };
    one_line(&format!("{weight}, {notice}"))
}
