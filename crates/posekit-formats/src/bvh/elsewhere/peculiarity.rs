//! What a file has that programs read differently.

use std::collections::BTreeSet;

use posekit::motion::Channel;
use posekit::rotation::Axis;

use super::names;
use super::text::{self, Spelling};
use crate::bvh::{Bvh, BvhJoint};
use crate::report::{Import, Severity, WarningCode};

macro_rules! peculiarities {
    ($($(#[doc = $doc:literal])+ $variant:ident;)+) => {
        /// Something about a BVH file that at least one program refuses or takes for something else.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Peculiarity {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Peculiarity {
            /// All of them, in the order of the guide's table.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// What it is, as the documentation of the variant says without its full stop.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$variant => concat!($($doc),+).trim_ascii().trim_end_matches('.'),)+
                }
            }
        }
    };
}

peculiarities! {
    /// A root with position channels and an OFFSET that is not zero.
    RootOffset;
    /// Position channels below the root, on a joint whose OFFSET is not zero.
    JointPositionsAndOffset;
    /// Position channels below the root.
    JointPositions;
    /// One or two position channels where the OFFSET of another axis is not zero.
    SomePositionsAndOffset;
    /// Position channels on a joint that has not exactly three of them and three rotation channels.
    PositionsWithoutSixChannels;
    /// A root without three position channels in the order X, Y, Z.
    RootPositionsNotXyz;
    /// A joint without rotation channels.
    NoRotations;
    /// One or two rotation channels.
    FewRotations;
    /// Four rotation channels or more, or an axis twice.
    OddRotations;
    /// A blank in a name.
    BlankInName;
    /// Two names that are equal up to their first blank.
    SameFirstWord;
    /// Two joints of one name.
    DuplicateName;
    /// A colon or a slash in a name, or `.bones`, `.map`, `.material` at its end.
    PathInName;
    /// A square bracket in a name.
    BracketInName;
    /// A name of more than 63 bytes.
    LongName;
    /// A name that is not UTF-8 text.
    NonUtf8Name;
    /// Several roots.
    SeveralRoots;
    /// No frames.
    NoFrames;
    /// A frame time of zero or less.
    NoFrameTime;
    /// More frames announced than there are.
    TooManyFramesAnnounced;
    /// Fewer frames announced than there are.
    TooFewFramesAnnounced;
    /// Channels in other capitals, as `XPOSITION`.
    ChannelCapitals;
    /// Keywords in other capitals, or `Frames:6` without a blank.
    KeywordSpelling;
    /// Statements that share a line, or OFFSET and CHANNELS missing or in another order.
    Layout;
    /// A name after `End Site`.
    EndSiteName;
    /// A name in place of `Site` after `End`.
    OtherEnd;
    /// A frame over several lines, or several on one.
    WrappedRows;
    /// A byte order mark.
    ByteOrderMark;
    /// Anything else that posekit had to put right, or a comment.
    Repaired;
}

/// A peculiarity and the joints that have it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Found {
    pub(super) peculiarity: Peculiarity,
    /// Empty where it is about the whole file.
    pub(super) joints: Vec<usize>,
}

/// All peculiarities of a file, in the order of [`Peculiarity::ALL`].
pub(super) fn find(bytes: &[u8], import: &Import<Bvh>) -> Vec<Found> {
    let bvh = &import.document;
    let spelling = text::spelling(bytes);
    let mut found = Vec::new();
    for &peculiarity in Peculiarity::ALL {
        let joints = joints_with(peculiarity, bvh);
        if !joints.is_empty() || is_in_file(peculiarity, &spelling, import) {
            found.push(Found {
                peculiarity,
                joints,
            });
        }
    }
    found
}

/// A joint's channels, counted.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChannelCount {
    /// Position channels.
    pub(super) positions: usize,
    /// Rotation channels.
    pub(super) rotations: usize,
    /// Whether there are position channels, but not each axis once.
    pub(super) has_some_positions: bool,
    /// Whether there are four rotation channels or more, or an axis twice.
    pub(super) has_odd_rotations: bool,
}

pub(super) fn count(joint: &BvhJoint) -> ChannelCount {
    let has = |channel: Channel| joint.channels.contains(&channel);
    let positions = joint
        .channels
        .iter()
        .filter(|channel| matches!(channel, Channel::Position(_)))
        .count();
    let rotations = joint.channels.len() - positions;
    let each =
        |of: fn(Axis) -> Channel| Axis::ALL.into_iter().filter(|&axis| has(of(axis))).count();
    ChannelCount {
        positions,
        rotations,
        has_some_positions: positions > 0 && (positions, each(Channel::Position)) != (3, 3),
        has_odd_rotations: rotations != each(Channel::Rotation),
    }
}

fn joints_with(peculiarity: Peculiarity, bvh: &Bvh) -> Vec<usize> {
    let has_offset = |joint: &BvhJoint| joint.offset.iter().any(|&number| number != 0.0);
    let which = |is_meant: &dyn Fn(&BvhJoint, ChannelCount) -> bool| -> Vec<usize> {
        let joints = bvh.joints.iter().enumerate();
        joints
            .filter(|(_, joint)| !joint.is_end_site && is_meant(joint, count(joint)))
            .map(|(index, _)| index)
            .collect()
    };
    let is_root = |joint: &BvhJoint| joint.parent.is_none();
    match peculiarity {
        Peculiarity::RootOffset => {
            which(&|joint, has| is_root(joint) && has.positions > 0 && has_offset(joint))
        }
        Peculiarity::JointPositionsAndOffset => {
            which(&|joint, has| !is_root(joint) && has.positions > 0 && has_offset(joint))
        }
        Peculiarity::JointPositions => which(&|joint, has| !is_root(joint) && has.positions > 0),
        Peculiarity::SomePositionsAndOffset => which(&|joint, has| {
            let is_missing = |axis: Axis| !joint.channels.contains(&Channel::Position(axis));
            has.has_some_positions
                && Axis::ALL
                    .into_iter()
                    .any(|axis| is_missing(axis) && joint.offset[axis.index()] != 0.0)
        }),
        Peculiarity::PositionsWithoutSixChannels => {
            which(&|_, has| has.positions > 0 && (has.has_some_positions || has.rotations != 3))
        }
        Peculiarity::RootPositionsNotXyz => {
            which(&|joint, _| is_root(joint) && !has_positions_xyz(joint))
        }
        Peculiarity::NoRotations => which(&|_, has| has.rotations == 0),
        Peculiarity::FewRotations => {
            which(&|_, has| matches!(has.rotations, 1 | 2) && !has.has_odd_rotations)
        }
        Peculiarity::OddRotations => which(&|_, has| has.has_odd_rotations),
        Peculiarity::BlankInName => which(&|joint, _| names::has_blank(&joint.name)),
        Peculiarity::SameFirstWord => repeated(bvh, names::first_word),
        Peculiarity::DuplicateName => repeated(bvh, |name| name),
        Peculiarity::PathInName => which(&|joint, _| names::is_path_in_three(&joint.name)),
        Peculiarity::BracketInName => which(&|joint, _| names::has_bracket(&joint.name)),
        Peculiarity::LongName => which(&|joint, _| joint.name.len() > names::LONGEST_IN_BLENDER),
        Peculiarity::NonUtf8Name => which(&|joint, _| core::str::from_utf8(&joint.name).is_err()),
        _ => Vec::new(),
    }
}

/// Whether the position channels are X, Y and Z, in this order.
pub(super) fn has_positions_xyz(joint: &BvhJoint) -> bool {
    let axes = joint.channels.iter().filter_map(|channel| match channel {
        Channel::Position(axis) => Some(*axis),
        Channel::Rotation(_) => None,
    });
    axes.eq(Axis::ALL)
}

/// The joints whose name, or what `part` takes of it, an earlier joint has. For a part, equal names do not count.
fn repeated(bvh: &Bvh, part: fn(&[u8]) -> &[u8]) -> Vec<usize> {
    let mut seen: BTreeSet<&[u8]> = BTreeSet::new();
    let mut joints = Vec::new();
    for (index, joint) in bvh.joints.iter().enumerate() {
        if !joint.is_end_site && !seen.insert(part(&joint.name)) {
            joints.push(index);
        }
    }
    joints
}

fn is_in_file(peculiarity: Peculiarity, spelling: &Spelling, import: &Import<Bvh>) -> bool {
    let bvh = &import.document;
    let announced = spelling.announced_frames.filter(|_| bvh.motion.is_some());
    match peculiarity {
        Peculiarity::SeveralRoots => {
            bvh.joints
                .iter()
                .filter(|joint| joint.parent.is_none())
                .count()
                > 1
        }
        Peculiarity::NoFrames => bvh.frame_count() == 0,
        Peculiarity::NoFrameTime => bvh
            .motion
            .as_ref()
            .is_some_and(|motion| motion.frame_time().is_none()),
        Peculiarity::TooManyFramesAnnounced => {
            announced.is_some_and(|announced| announced > bvh.frame_count())
        }
        Peculiarity::TooFewFramesAnnounced => {
            announced.is_some_and(|announced| announced < bvh.frame_count())
        }
        Peculiarity::ChannelCapitals => spelling.has_odd_channels,
        Peculiarity::KeywordSpelling => spelling.has_odd_keywords && bvh.motion.is_some(),
        Peculiarity::Layout => spelling.has_odd_layout,
        Peculiarity::EndSiteName => spelling.has_end_site_names,
        Peculiarity::OtherEnd => spelling.has_other_ends,
        Peculiarity::WrappedRows => import.report.has(WarningCode::WrappedRows),
        Peculiarity::ByteOrderMark => import.report.has(WarningCode::ByteOrderMark),
        Peculiarity::Repaired => import.report.warnings.iter().any(|warning| {
            let is_told_apart = matches!(
                warning.code,
                WarningCode::FrameCountMismatch
                    | WarningCode::BadFrameTime
                    | WarningCode::DuplicateChannel
                    | WarningCode::MissingOffset
            );
            let is_repair = warning.code.severity() == Severity::Warning;
            warning.code == WarningCode::CommentSkipped || is_repair && !is_told_apart
        }),
        _ => false,
    }
}
