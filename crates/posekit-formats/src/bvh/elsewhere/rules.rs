//! What each program does with each peculiarity: the one place where that stands.

use super::{Peculiarity, Program};

/// How far a program's reading is from posekit's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Effect {
    /// Only names come out different.
    Renamed,
    /// It may refuse or misread it; that depends on what exactly it is.
    Unsure,
    /// The motion or the skeleton comes out different, often without a word.
    Misread,
    /// It does not read the file.
    Refused,
}

impl Effect {
    /// The name that reports use: `renamed`, `unsure`, `misread` or `refused`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Renamed => "renamed",
            Self::Unsure => "unsure",
            Self::Misread => "misread",
            Self::Refused => "refused",
        }
    }
}

/// What a program does with a peculiarity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// The program.
    pub program: Program,
    /// What the file has.
    pub peculiarity: Peculiarity,
    /// How far its reading is from posekit's.
    pub effect: Effect,
    /// What it does, a sentence without its subject, capital and full stop.
    pub what: &'static str,
}

const fn rule(
    peculiarity: Peculiarity,
    program: Program,
    effect: Effect,
    what: &'static str,
) -> Rule {
    Rule {
        program,
        peculiarity,
        effect,
        what,
    }
}

use Effect::{Misread, Refused, Renamed, Unsure};
use Peculiarity as P;
use Program::{Assimp, Blender, Bvhio, Pybvh, Three};

/// Every difference that is known. A program and a peculiarity without a rule are read as posekit reads them.
pub const RULES: &[Rule] = &[
    rule(
        P::RootOffset,
        Three,
        Misread,
        "adds the OFFSET to the position channels",
    ),
    rule(
        P::JointPositionsAndOffset,
        Three,
        Misread,
        "adds the OFFSET to the position channels",
    ),
    rule(
        P::JointPositions,
        Pybvh,
        Refused,
        "refuses position channels below the root (ValueError)",
    ),
    rule(
        P::SomePositionsAndOffset,
        Blender,
        Misread,
        "takes 0 for the axes without a channel",
    ),
    rule(
        P::PositionsWithoutSixChannels,
        Assimp,
        Misread,
        "drops the position channels, or refuses the file where six channels are not three and three",
    ),
    rule(
        P::RootPositionsNotXyz,
        Pybvh,
        Refused,
        "wants Xposition, Yposition and Zposition on the root, in this order (ValueError)",
    ),
    rule(
        P::NoRotations,
        Pybvh,
        Refused,
        "wants three rotation channels on every joint (ValueError)",
    ),
    rule(P::FewRotations, Blender, Refused, "fails (KeyError)"),
    rule(
        P::FewRotations,
        Pybvh,
        Refused,
        "wants three rotation channels on every joint (ValueError)",
    ),
    rule(
        P::OddRotations,
        Blender,
        Refused,
        "fails (IndexError or KeyError)",
    ),
    rule(
        P::OddRotations,
        Pybvh,
        Refused,
        "wants each axis once (ValueError)",
    ),
    rule(
        P::OddRotations,
        Bvhio,
        Misread,
        "takes the last value of an axis for each of its channels",
    ),
    rule(P::BlankInName, Three, Renamed, "ends the name at the blank"),
    rule(
        P::BlankInName,
        Blender,
        Renamed,
        "writes underscores for the blanks",
    ),
    rule(P::BlankInName, Pybvh, Renamed, "ends the name at the blank"),
    rule(P::BlankInName, Bvhio, Renamed, "ends the name at the blank"),
    rule(P::BlankInName, Assimp, Refused, "refuses the file"),
    rule(
        P::SameFirstWord,
        Three,
        Misread,
        "lets both tracks drive the first bone of the name",
    ),
    rule(
        P::DuplicateName,
        Blender,
        Renamed,
        "calls the second `NAME.001`",
    ),
    rule(
        P::DuplicateName,
        Assimp,
        Misread,
        "has two tracks of one name, which does not say which bone moves",
    ),
    rule(
        P::PathInName,
        Three,
        Misread,
        "finds no bone of the name: it stands still",
    ),
    rule(
        P::BracketInName,
        Three,
        Refused,
        "fails when the clip is played (cannot parse trackName)",
    ),
    rule(P::LongName, Blender, Renamed, "cuts the name to 63 bytes"),
    rule(
        P::NonUtf8Name,
        Three,
        Renamed,
        "shows replacement characters",
    ),
    rule(
        P::NonUtf8Name,
        Blender,
        Refused,
        "fails (UnicodeDecodeError)",
    ),
    rule(P::NonUtf8Name, Pybvh, Refused, "fails (UnicodeDecodeError)"),
    rule(P::NonUtf8Name, Bvhio, Refused, "fails (UnicodeDecodeError)"),
    rule(
        P::SeveralRoots,
        Three,
        Refused,
        "fails (no keyframes in track)",
    ),
    rule(
        P::SeveralRoots,
        Pybvh,
        Refused,
        "refuses a second ROOT (ValueError)",
    ),
    rule(
        P::SeveralRoots,
        Bvhio,
        Refused,
        "refuses a second ROOT (SyntaxError)",
    ),
    rule(P::SeveralRoots, Assimp, Refused, "refuses a second ROOT"),
    rule(P::NoFrames, Three, Refused, "fails (no keyframes in track)"),
    rule(P::NoFrames, Blender, Refused, "fails"),
    rule(P::NoFrames, Pybvh, Refused, "refuses the file (ValueError)"),
    rule(P::NoFrames, Bvhio, Refused, "does not read it"),
    rule(
        P::NoFrames,
        Assimp,
        Refused,
        "refuses the file where MOTION is missing, else has one frame",
    ),
    rule(
        P::NoFrameTime,
        Three,
        Misread,
        "puts all frames at the same time",
    ),
    rule(
        P::NoFrameTime,
        Pybvh,
        Refused,
        "refuses the file (ValueError)",
    ),
    rule(P::NoFrameTime, Assimp, Misread, "has an infinite rate"),
    rule(
        P::TooManyFramesAnnounced,
        Three,
        Refused,
        "fails (TypeError)",
    ),
    rule(
        P::TooManyFramesAnnounced,
        Pybvh,
        Refused,
        "refuses the file (ValueError)",
    ),
    rule(
        P::TooManyFramesAnnounced,
        Bvhio,
        Refused,
        "does not read it",
    ),
    rule(
        P::TooManyFramesAnnounced,
        Assimp,
        Refused,
        "refuses the file",
    ),
    rule(
        P::TooFewFramesAnnounced,
        Three,
        Misread,
        "leaves out the frames beyond",
    ),
    rule(
        P::TooFewFramesAnnounced,
        Pybvh,
        Refused,
        "refuses the file (ValueError)",
    ),
    rule(
        P::TooFewFramesAnnounced,
        Bvhio,
        Misread,
        "leaves out the frames beyond",
    ),
    rule(
        P::TooFewFramesAnnounced,
        Assimp,
        Misread,
        "leaves out the frames beyond",
    ),
    rule(
        P::ChannelCapitals,
        Three,
        Misread,
        "skips the channel: all later numbers of a row shift",
    ),
    rule(
        P::ChannelCapitals,
        Bvhio,
        Misread,
        "skips the channel: all later numbers of a row shift",
    ),
    rule(P::ChannelCapitals, Assimp, Refused, "refuses the channel"),
    rule(
        P::KeywordSpelling,
        Three,
        Unsure,
        "takes other capitals, and no frames where a blank is missing",
    ),
    rule(
        P::KeywordSpelling,
        Pybvh,
        Refused,
        "refuses the file (ValueError)",
    ),
    rule(
        P::KeywordSpelling,
        Bvhio,
        Refused,
        "refuses the file (SyntaxError)",
    ),
    rule(P::KeywordSpelling, Assimp, Refused, "refuses the file"),
    rule(
        P::Layout,
        Three,
        Refused,
        "fails, or has no numbers where OFFSET is not first",
    ),
    rule(P::Layout, Blender, Refused, "fails, or loses joints"),
    rule(
        P::Layout,
        Pybvh,
        Unsure,
        "takes braces anywhere and any order, but only whole lines",
    ),
    rule(P::Layout, Bvhio, Refused, "refuses the file (SyntaxError)"),
    rule(P::EndSiteName, Assimp, Refused, "refuses the file"),
    rule(P::OtherEnd, Three, Refused, "fails (TypeError)"),
    rule(
        P::OtherEnd,
        Blender,
        Misread,
        "hangs later joints from the wrong parents",
    ),
    rule(P::OtherEnd, Assimp, Refused, "refuses the file"),
    rule(P::WrappedRows, Three, Refused, "fails (TypeError)"),
    rule(P::WrappedRows, Blender, Refused, "fails (IndexError)"),
    rule(
        P::WrappedRows,
        Pybvh,
        Refused,
        "refuses the file (ValueError)",
    ),
    rule(P::WrappedRows, Bvhio, Refused, "fails (IndexError)"),
    rule(P::ByteOrderMark, Blender, Refused, "does not know the file"),
    rule(
        P::ByteOrderMark,
        Bvhio,
        Refused,
        "refuses the file (SyntaxError)",
    ),
    rule(P::ByteOrderMark, Assimp, Refused, "refuses the file"),
    rule(P::Repaired, Three, Unsure, UNKNOWN),
    rule(P::Repaired, Blender, Unsure, UNKNOWN),
    rule(P::Repaired, Pybvh, Unsure, UNKNOWN),
    rule(P::Repaired, Bvhio, Unsure, UNKNOWN),
    rule(P::Repaired, Assimp, Unsure, UNKNOWN),
];

/// Of what was not tried one by one.
const UNKNOWN: &str = "may refuse or misread it";
