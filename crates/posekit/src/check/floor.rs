//! Feet that go through the floor, and a floor that is not at zero.

use super::{CheckConfig, Figure, Finding, FindingCode, FloorContacts, FrameRange, Severity, Unit};
use crate::motion::Motion;

/// Two dips closer than this are one, in seconds.
const SAME_DIP_SECS: f64 = 0.1;

pub(super) fn check(
    contacts: &FloorContacts,
    figure: &Figure,
    motion: &Motion,
    config: &CheckConfig,
    findings: &mut Vec<Finding>,
) {
    findings.extend(floor_offset(contacts, figure, config));
    let floor = surface(contacts.floor, figure, config);
    let limit = floor - config.penetration_heights * figure.height;
    let same_dip = super::whole(SAME_DIP_SECS / motion.frame_time_secs()) + 1;
    for (foot, lowest) in contacts.lowest.iter().enumerate() {
        for frames in dips(lowest, limit, same_dip) {
            let deepest = lowest[frames.first..=frames.last]
                .iter()
                .copied()
                .fold(f64::MAX, f64::min);
            let depth = floor - deepest;
            let joint = figure.feet[foot].base();
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
                    motion.skeleton().unique_name(joint),
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
    config: &CheckConfig,
) -> Option<Finding> {
    let share = contacts.floor.abs() / figure.height;
    let is_contact_known = !contacts.contacts.is_empty();
    (is_contact_known && share > config.floor_offset_heights).then(|| Finding {
        code: FindingCode::FloorNotAtZero,
        severity: Severity::Info,
        joints: figure.feet.iter().map(super::Foot::base).collect(),
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
