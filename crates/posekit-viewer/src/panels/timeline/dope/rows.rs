//! The rows of the dope sheet, and which keys each of their marks stands for.

use std::collections::BTreeSet;

use posekit::keyframe::Interpolation;
use posekit::keyframe::edit::SAME_TIME_SECS;
use posekit::skeleton::JointId;

use crate::state::animate::{Authored, KeyId, Lane, Owner};

/// What a row is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// All keys.
    Summary,
    /// All keys of a joint, a camera, a light or a prop.
    Owner(Owner),
    /// The keys of one property.
    Lane(Lane),
}

/// A mark: keys at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// When, in seconds of the scene.
    pub secs: f64,
    /// The keys.
    pub keys: Vec<KeyId>,
    /// How all of them go on; `None` where they differ.
    pub interpolation: Option<Interpolation>,
}

/// A row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it is about.
    pub kind: Kind,
    /// Its name.
    pub name: String,
    /// How far it is indented.
    pub depth: usize,
    /// Whether the rows under it are shown; `None` where there are none.
    pub open: Option<bool>,
    /// Its keys, in the order of time.
    pub marks: Vec<Mark>,
}

impl Row {
    /// The lanes that the row is about.
    #[must_use]
    pub fn lanes(&self, authored: &Authored) -> Vec<Lane> {
        match self.kind {
            Kind::Summary => authored.lanes(),
            Kind::Owner(owner) => owner.lanes(),
            Kind::Lane(lane) => vec![lane],
        }
    }
}

/// The rows of a scene: the summary, the joints that are keyed or selected, then cameras, lights and
/// props.
#[must_use]
pub fn rows(authored: &Authored, selected: &[JointId], open: &BTreeSet<Owner>) -> Vec<Row> {
    let mut all = Vec::new();
    let mut below = Vec::new();
    let is_shown = |joint: &JointId| {
        let keyed = Owner::Joint(*joint).lanes();
        selected.contains(joint) || keyed.iter().any(|lane| authored.track(*lane).is_some())
    };
    let joints = authored.skeleton().joints().filter(is_shown);
    let owners: Vec<Owner> = joints
        .map(Owner::Joint)
        .chain(authored.owners_around())
        .collect();
    for owner in owners {
        let is_open = open.contains(&owner);
        let mut of_owner = Vec::new();
        let mut lanes = Vec::new();
        for lane in owner.lanes() {
            let keys = keys_of(authored, lane);
            of_owner.extend_from_slice(&keys);
            let is_joint = matches!(owner, Owner::Joint(_));
            if is_open && !(is_joint && keys.is_empty()) {
                lanes.push(Row {
                    kind: Kind::Lane(lane),
                    name: lane.property().to_owned(),
                    depth: 2,
                    open: None,
                    marks: marks(keys),
                });
            }
        }
        all.extend_from_slice(&of_owner);
        below.push(Row {
            kind: Kind::Owner(owner),
            name: owner.name(authored.scene(), authored.skeleton()),
            depth: 1,
            open: Some(is_open),
            marks: marks(of_owner),
        });
        below.append(&mut lanes);
    }
    let summary = Row {
        kind: Kind::Summary,
        name: "All keys".to_owned(),
        depth: 0,
        open: None,
        marks: marks(all),
    };
    std::iter::once(summary).chain(below).collect()
}

/// A key, when it is, and how it goes on.
type Timed = (f64, KeyId, Interpolation);

fn keys_of(authored: &Authored, lane: Lane) -> Vec<Timed> {
    let Some(track) = authored.track(lane) else {
        return Vec::new();
    };
    let times = track.times_secs().iter().enumerate();
    times
        .map(|(index, &secs)| (secs, KeyId { lane, index }, track.interpolation(index)))
        .collect()
}

/// Keys of any lanes as marks: those at one time are one.
fn marks(mut keys: Vec<Timed>) -> Vec<Mark> {
    keys.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut marks: Vec<Mark> = Vec::new();
    for (secs, key, way) in keys {
        match marks.last_mut() {
            Some(last) if secs - last.secs <= SAME_TIME_SECS => {
                last.keys.push(key);
                last.interpolation = last.interpolation.filter(|other| *other == way);
            }
            _ => marks.push(Mark {
                secs,
                keys: vec![key],
                interpolation: Some(way),
            }),
        }
    }
    marks
}
