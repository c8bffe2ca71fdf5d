//! What a check reports: a code, how serious it is, where, how much, and a sentence.

use std::fmt;

use crate::skeleton::JointId;

/// How much a finding means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Worth knowing and often meant so: nothing has to be done.
    Info,
    /// Something that a viewer sees or a program trips over, most likely not meant.
    Warning,
    /// The motion cannot be used as it is.
    Error,
}

impl Severity {
    /// The name that reports use: `info`, `warning` or `error`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

macro_rules! finding_codes {
    ($($(#[doc = $doc:literal])+ $variant:ident, $code:literal;)+) => {
        /// What kind of thing a check found. The code's name never changes once released.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum FindingCode {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl FindingCode {
            /// Every code, in the order of their declaration.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The stable name, in kebab case, such as `euler-flip`.
            pub const fn code(self) -> &'static str {
                match self { $(Self::$variant => $code),+ }
            }

            /// What it means in a sentence, as the documentation of the variant says.
            pub const fn summary(self) -> &'static str {
                match self { $(Self::$variant => concat!($($doc),+).trim_ascii()),+ }
            }
        }
    };
}

finding_codes! {
    /// The frame time is zero, or so long or short that no motion is recorded like that.
    FrameTimeImplausible, "frame-time-implausible";
    /// The motion obeys gravity or the laws of walking only if it is played faster or slower.
    PlaybackSpeedImplausible, "playback-speed-implausible";
    /// Values of the file are not numbers: `nan`, `inf` or beyond what a number can be.
    NotFinite, "not-finite";
    /// The first frame is a reference pose that the motion does not continue.
    ReferenceFirstFrame, "reference-first-frame";
    /// Rotation channels jump although the rotation that they make is continuous.
    EulerFlip, "euler-flip";
    /// Rotation channels race against each other near gimbal lock although the joint hardly turns.
    GimbalLock, "gimbal-lock";
    /// A joint's rotation leaves its course for a few frames and comes back.
    RotationSpike, "rotation-spike";
    /// A joint's rotation changes from one frame to the next, far beyond its speed around, and stays.
    RotationJump, "rotation-jump";
    /// The whole figure leaves its path for a few frames and comes back.
    PositionSpike, "position-spike";
    /// The whole figure is somewhere else from one frame to the next, and stays.
    Teleport, "teleport";
    /// Frames in the middle of the motion repeat each other exactly.
    FrozenFrames, "frozen-frames";
    /// Single frames repeat their predecessor here and there, as after a conversion of the frame rate.
    DuplicateFrames, "duplicate-frames";
    /// No channel ever changes: the file holds a pose, not a motion.
    StaticMotion, "static-motion";
    /// Channels that never change.
    ConstantChannels, "constant-channels";
    /// The figure stands well above or below the height zero.
    FloorNotAtZero, "floor-not-at-zero";
    /// A foot goes through the floor that the feet stand on elsewhere.
    FootBelowFloor, "foot-below-floor";
    /// A foot slides over the floor while it carries the figure.
    FootSliding, "foot-sliding";
    /// The distance between a joint and its parent changes during the motion.
    BoneLengthChanges, "bone-length-changes";
    /// Position channels put a joint somewhere else than its OFFSET all the time.
    OffsetUnlikeMotion, "offset-unlike-motion";
    /// Position channels are relative to the OFFSET, or zero where they should hold a place.
    PositionsRelativeToOffset, "positions-relative-to-offset";
    /// The rest pose that the OFFSETs make does not look like the figure that moves.
    RestPoseUnlikeMotion, "rest-pose-unlike-motion";
}

impl fmt::Display for FindingCode {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.code())
    }
}

/// What a measured number counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Unit {
    /// Angles.
    Degrees,
    /// Lengths in the unit of the file.
    FileUnits,
    /// Numbers of frames.
    Frames,
    /// Times.
    Seconds,
    /// Numbers of occurrences.
    Occurrences,
    /// Numbers of channels.
    Channels,
    /// Shares of a whole, 1 for all of it.
    Fraction,
    /// How many times too fast the motion plays; under 1 for too slow.
    TimesTooFast,
}

impl Unit {
    /// The name that reports use, such as `degrees` or `file-units`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Degrees => "degrees",
            Self::FileUnits => "file-units",
            Self::Frames => "frames",
            Self::Seconds => "seconds",
            Self::Occurrences => "occurrences",
            Self::Channels => "channels",
            Self::Fraction => "fraction",
            Self::TimesTooFast => "times-too-fast",
        }
    }
}

/// A run of frames, counted from 0, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FrameRange {
    /// The first frame.
    pub first: usize,
    /// The last frame; not before the first.
    pub last: usize,
}

impl FrameRange {
    /// A single frame.
    pub const fn single(frame: usize) -> Self {
        Self {
            first: frame,
            last: frame,
        }
    }
}

impl fmt::Display for FrameRange {
    /// `frame 12` or `frames 12 to 20`.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.first == self.last {
            write!(out, "frame {}", self.first)
        } else {
            write!(out, "frames {} to {}", self.first, self.last)
        }
    }
}

/// Something suspicious in a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What kind of thing it is; stable across versions.
    pub code: FindingCode,
    /// How much it means here.
    pub severity: Severity,
    /// The joints it is about, in topological order; empty when it is about the whole motion.
    pub joints: Vec<JointId>,
    /// The frames it is about; `None` when it is about all of them.
    pub frames: Option<FrameRange>,
    /// How much was measured, in `unit`.
    pub value: f64,
    /// What `value` counts.
    pub unit: Unit,
    /// The same length as a share of the figure's height, where `value` is a length.
    pub share_of_height: Option<f64>,
    /// What was found, in a sentence without a capital and a full stop.
    pub message: String,
}

/// Puts findings in the order of reports: by frame (those of the whole motion first), then by code,
/// joints and value. Findings that a caller gathered from several checks come out the same however
/// they were gathered.
pub fn sort_findings(findings: &mut [Finding]) {
    findings.sort_by(|a, b| {
        a.frames
            .cmp(&b.frames)
            .then_with(|| a.code.cmp(&b.code))
            .then_with(|| a.joints.cmp(&b.joints))
            .then_with(|| a.value.total_cmp(&b.value))
    });
}
