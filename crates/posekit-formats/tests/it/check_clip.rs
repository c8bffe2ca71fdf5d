//! A clip to corrupt, and what a check of the corrupted clip must say.

use posekit::check::{CheckConfig, figure};
use posekit::motion::{Channel, PositionPolicy};
use posekit::skeleton::JointId;
use posekit_formats::bvh::{self, Bvh, CheckEntry};
use posekit_formats::report::ImportReport;

use crate::bvh_real_files::files;
use crate::walker::{self, Channels};

/// Clips shorter than this have no middle to corrupt.
const FRAMES_MIN: usize = 60;

/// A clip and what the corruptions need to know of it.
pub(crate) struct Clip {
    pub(crate) name: String,
    pub(crate) bvh: Bvh,
    /// The joint that carries the figure, and its first position column by axis.
    pub(crate) root: usize,
    pub(crate) root_columns: [usize; 3],
    pub(crate) height: f64,
    /// A joint that carries no foot: an arm, a neck or a head.
    pub(crate) free_joint: usize,
    pub(crate) found: Vec<CheckEntry>,
}

impl Clip {
    pub(crate) fn new(name: &str, bvh: Bvh) -> Self {
        let motion = bvh.to_motion(PositionPolicy::default()).unwrap();
        let skeleton = motion.skeleton();
        let figure = figure(&motion, &motion.to_global());
        let feet: Vec<JointId> = figure.feet.iter().map(|foot| foot.base()).collect();
        assert_eq!(feet.len(), 2, "{name} has two feet");
        let carries_foot = |joint| skeleton.subtree(joint).any(|below| feet.contains(&below));
        let is_in_foot = |joint| skeleton.ancestors(joint).any(|above| feet.contains(&above));
        let rotations = |joint: usize| {
            let channels = bvh.joints[joint].channels.iter();
            channels
                .filter(|channel| matches!(channel, Channel::Rotation(_)))
                .count()
        };
        let flipping: Vec<String> = check(&bvh)
            .iter()
            .filter(|entry| ["euler-flip", "gimbal-lock", "rotation-jump"].contains(&entry.code))
            .flat_map(|entry| entry.joints.clone())
            .collect();
        let free_joint = skeleton.joints().rev().find(|&joint| {
            !carries_foot(joint)
                && !is_in_foot(joint)
                && rotations(joint.index()) == 3
                && !flipping
                    .iter()
                    .any(|name| name == skeleton.unique_name(joint))
        });
        let root = figure.root.index();
        Self {
            name: name.to_owned(),
            root,
            root_columns: position_columns(&bvh, root).expect("the figure moves"),
            height: figure.height,
            free_joint: free_joint.expect("a joint that carries no foot").index(),
            found: check(&bvh),
            bvh,
        }
    }

    /// Whether the name says that it is a run.
    pub(crate) fn is_run(&self) -> bool {
        self.name.contains("run") || self.name.contains("dash")
    }

    /// Whether the name says that it is a walk.
    pub(crate) fn is_walk(&self) -> bool {
        self.name.contains("walk")
    }

    pub(crate) fn frame_count(&self) -> usize {
        self.bvh.frame_count()
    }

    pub(crate) fn middle(&self) -> usize {
        self.frame_count() / 2
    }

    pub(crate) fn frame_time_secs(&self) -> f64 {
        self.bvh.motion.as_ref().unwrap().frame_time_secs
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "a few seconds of frames fit"
    )]
    pub(crate) fn frames_in(&self, secs: f64) -> usize {
        (secs / self.frame_time_secs()).ceil() as usize
    }

    /// The document with each row changed.
    pub(crate) fn changed(&self, change: impl Fn(usize, &mut [f64])) -> Bvh {
        let mut bvh = self.bvh.clone();
        let columns = bvh.channel_count();
        let values = &mut bvh.motion.as_mut().unwrap().values;
        for (frame, row) in values.chunks_exact_mut(columns).enumerate() {
            change(frame, row);
        }
        bvh
    }

    /// Requires that a corrupted document has findings of this code that the clip has not, one of
    /// them about the joint and the frame where given, and no new ones of any other code.
    pub(crate) fn expect(
        &self,
        corrupted: &Bvh,
        code: &str,
        joint: Option<usize>,
        frame: Option<usize>,
    ) -> Result<(), String> {
        let known = |entry: &CheckEntry| {
            // Which channels are constant may change with any corruption, and a drifting root is
            // elsewhere than its OFFSET.
            ["constant-channels", "offset-unlike-motion"].contains(&entry.code)
                || self
                    .found
                    .iter()
                    .any(|old| old.code == entry.code && old.joints == entry.joints)
        };
        let found = check(corrupted);
        let joint = joint.map(|joint| self.bvh.joints[joint].name().into_owned());
        let is_hit = |entry: &&CheckEntry| {
            entry.code == code
                && !self.found.contains(entry)
                && joint
                    .as_ref()
                    .is_none_or(|joint| entry.joints.contains(joint))
                && frame.is_none_or(|frame| {
                    entry
                        .frames
                        .is_some_and(|range| range.first <= frame && frame <= range.last)
                })
        };
        let others: Vec<String> = found
            .iter()
            .filter(|entry| entry.code != code && !known(entry))
            .map(|entry| format!("{} {:?}: {}", entry.code, entry.frames, entry.message))
            .collect();
        match (found.iter().any(|entry| is_hit(&entry)), others.is_empty()) {
            (true, true) => Ok(()),
            (false, _) => Err(format!(
                "{code} of {joint:?} at {frame:?} missed, {others:?}"
            )),
            (true, false) => Err(format!("{code} also looks like {others:?}")),
        }
    }
}

pub(crate) fn check(bvh: &Bvh) -> Vec<CheckEntry> {
    let config = CheckConfig::default();
    bvh::check(
        bvh,
        &ImportReport::default(),
        PositionPolicy::default(),
        &config,
    )
    .unwrap()
}

pub(crate) fn position_columns(bvh: &Bvh, joint: usize) -> Option<[usize; 3]> {
    let start = bvh.joint_columns(joint).start;
    let mut columns = [None; 3];
    for (column, channel) in (start..).zip(&bvh.joints[joint].channels) {
        if let Channel::Position(axis) = channel {
            columns[axis.index()] = Some(column);
        }
    }
    Some([columns[0]?, columns[1]?, columns[2]?])
}

pub(crate) fn rotation_columns(bvh: &Bvh, joint: usize) -> Vec<usize> {
    let columns = bvh.joint_columns(joint).zip(&bvh.joints[joint].channels);
    columns
        .filter(|(_, channel)| matches!(channel, Channel::Rotation(_)))
        .map(|(column, _)| column)
        .collect()
}

/// The procedure's walks and all real clips that are long enough.
pub(crate) fn clips() -> Vec<Clip> {
    let mut clips = vec![
        Clip::new("a walk with three channels", walker::walk(Channels::Three)),
        Clip::new("a walk with six channels", walker::walk(Channels::Six)),
    ];
    clips.extend(real_clips());
    clips
}

/// All real clips that are long enough.
pub(crate) fn real_clips() -> Vec<Clip> {
    let mut clips = Vec::new();
    for path in files() {
        let bvh = bvh::read(&std::fs::read(&path).unwrap()).unwrap().document;
        if bvh.frame_count() >= FRAMES_MIN {
            clips.push(Clip::new(&path.file_name().unwrap().to_string_lossy(), bvh));
        }
    }
    clips
}
