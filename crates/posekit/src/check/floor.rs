//! Feet that go through the floor, and a floor that is not at zero.

use super::statistics::most_frequent;
use super::{CheckConfig, Figure, Finding, FindingCode, FloorContacts, FrameRange, Severity, Unit};
use crate::motion::GlobalMotion;
use crate::skeleton::JointId;

/// Two dips closer than this are one, in seconds.
const SAME_DIP_SECS: f64 = 0.1;

pub(super) fn check(
    contacts: &FloorContacts,
    figure: &Figure,
    global: &GlobalMotion,
    config: &CheckConfig,
    findings: &mut Vec<Finding>,
) {
    findings.extend(floor_offset(contacts, figure, global, config));
    let floor = surface(contacts.floor, figure, config);
    let limit = floor - config.penetration_heights * figure.height;
    let same_dip = super::whole(SAME_DIP_SECS / global.frame_time_secs()) + 1;
    for (foot, lowest) in contacts.lowest.iter().enumerate() {
        for frames in dips(lowest, limit, same_dip) {
            let deepest = (frames.first..=frames.last)
                .min_by(|&a, &b| lowest[a].total_cmp(&lowest[b]))
                .unwrap_or(frames.first);
            let depth = floor - lowest[deepest];
            let joint = figure.feet[foot].lowest(global, deepest);
            let share = depth / figure.height;
            findings.push(Finding {
                code: FindingCode::FootBelowFloor,
                severity: Severity::Warning,
                joints: vec![joint],
                frames: Some(frames),
                value: depth,
                unit: Unit::FileUnits,
                share_of_height: Some(share),
                message: format!(
                    "{} goes {depth:.4} file units ({:.1} per cent of the height) below the floor, \
                     which is at {:.4}",
                    global.skeleton().unique_name(joint),
                    100.0 * share,
                    floor
                ),
            });
        }
    }
}

/// What the feet stand on: 0 when their joints are only a sole's thickness above it.
fn surface(joint_floor: f64, figure: &Figure, config: &CheckConfig) -> f64 {
    if (0.0..=config.sole_heights * figure.height).contains(&joint_floor) {
        0.0
    } else {
        joint_floor
    }
}

fn floor_offset(
    contacts: &FloorContacts,
    figure: &Figure,
    global: &GlobalMotion,
    config: &CheckConfig,
) -> Option<Finding> {
    let share = contacts.floor.abs() / figure.height;
    let is_contact_known = !contacts.contacts.is_empty();
    (is_contact_known && share > config.floor_offset_heights).then(|| Finding {
        code: FindingCode::FloorNotAtZero,
        severity: Severity::Info,
        joints: standing_joints(contacts, figure, global),
        frames: None,
        value: contacts.floor,
        unit: Unit::FileUnits,
        share_of_height: Some(contacts.floor / figure.height),
        message: format!(
            "the feet stand at the height {:.4}, {:.0} per cent of the figure's height from 0",
            contacts.floor,
            100.0 * share
        ),
    })
}

/// Of every foot that ever stands the joint that it mostly stands on: the lowest one.
fn standing_joints(
    contacts: &FloorContacts,
    figure: &Figure,
    global: &GlobalMotion,
) -> Vec<JointId> {
    let of_foot = |foot: usize| {
        let planted = contacts.contacts.iter().filter(|c| c.foot == foot);
        let frames = planted.flat_map(|contact| contact.first..=contact.last);
        most_frequent(frames.map(|frame| figure.feet[foot].lowest(global, frame)))
    };
    (0..figure.feet.len()).filter_map(of_foot).collect()
}

/// Runs of frames below a limit; runs that are nearly next to each other are one.
fn dips(lowest: &[f64], limit: f64, same_dip: usize) -> Vec<FrameRange> {
    let mut dips: Vec<FrameRange> = Vec::new();
    for (frame, _) in lowest
        .iter()
        .enumerate()
        .filter(|(_, height)| **height < limit)
    {
        match dips.last_mut() {
            Some(dip) if frame - dip.last <= same_dip => dip.last = frame,
            _ => dips.push(FrameRange::single(frame)),
        }
    }
    dips
}
