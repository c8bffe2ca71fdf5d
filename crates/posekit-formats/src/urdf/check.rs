//! What is worth knowing about a robot's file: what its reader noticed, and what other programs will miss in it.

use posekit::check::{Severity, Unit};

use super::{Urdf, UrdfJointKind};
use crate::bvh::{CheckEntry, reader_entries};
use crate::report::{ImportReport, WarningCode, quote};

/// How many links a message names.
const NAMED: usize = 3;

/// Checks a robot: what the reader noticed, one entry a code, then whether everything that moves has a mass.
pub fn check(robot: &Urdf, import_report: &ImportReport) -> Vec<CheckEntry> {
    let mut entries = reader_entries(import_report);
    let without = moving_without_mass(robot);
    if let [first, ..] = without.as_slice() {
        let named = without.iter().take(NAMED);
        let named: Vec<String> = named
            .map(|&link| quote(robot.links[link].name.as_bytes()))
            .collect();
        let more = if without.len() > NAMED { ", ..." } else { "" };
        let moving = moving_pieces(robot).len();
        entries.push(CheckEntry {
            code: WarningCode::MissingInertia.code(),
            severity: Severity::Info,
            joints: carrier(robot, *first).into_iter().collect(),
            frames: None,
            file: None,
            place: None,
            value: without.len() as f64,
            unit: Unit::Occurrences,
            share_of_height: None,
            message: format!(
                "{} of {moving} moving pieces have no mass ({}{more}): simulators such as MuJoCo refuse the robot",
                without.len(),
                named.join(", ")
            ),
        });
    }
    entries
}

/// The name of the joint that carries a link.
fn carrier(robot: &Urdf, link: usize) -> Option<String> {
    let joint = robot.joints.iter().find(|joint| joint.child == link);
    joint.map(|joint| joint.name.clone())
}

/// The links that joints move, those that are fixed to them apart: pieces that are rigid in themselves.
fn moving_pieces(robot: &Urdf) -> Vec<usize> {
    let joints = robot.joints_from_root().into_iter();
    let moving = joints.filter(|&joint| robot.joints[joint].kind != UrdfJointKind::Fixed);
    moving.map(|joint| robot.joints[joint].child).collect()
}

/// Those of them without a mass, that of what is fixed to them included.
fn moving_without_mass(robot: &Urdf) -> Vec<usize> {
    let mut piece_of: Vec<usize> = (0..robot.links.len()).collect();
    for index in robot.joints_from_root() {
        let joint = &robot.joints[index];
        if joint.kind == UrdfJointKind::Fixed {
            piece_of[joint.child] = piece_of[joint.parent];
        }
    }
    let mut has_mass = vec![false; robot.links.len()];
    for (link, &piece) in robot.links.iter().zip(&piece_of) {
        has_mass[piece] |= link.mass_kg.is_some_and(|mass| mass > 0.0);
    }
    let pieces = moving_pieces(robot).into_iter();
    pieces.filter(|&link| !has_mass[link]).collect()
}
