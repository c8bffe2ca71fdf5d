//! Repairs that need no guess: the same motion, written better.
//!
//! A repair changes how a motion is written down and never where a joint is: Euler angles get
//! other values of the very same rotations, so that their curves are continuous; what the reader had
//! to put right is written right; blanks in names become underscores when that is asked for. Values that
//! no repair touches stay the same to the bit.
//!
//! What would need a guess is left alone: spikes, teleports, freezes, sliding feet. A frame time is set
//! when it is said.

use std::collections::HashSet;
use std::fmt;

use posekit::check::{CheckConfig, EulerStep, EulerTracker, FrameRange};
use posekit::motion::Channel;
use posekit::range::LONGEST_LENGTH;
use posekit::rotation::Axis;

use super::edit::{EditError, set_frame_time};
use super::{Bvh, EndName};
use crate::report::{Import, Location, Severity, WarningCode};

/// What to do with blanks in the names of joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NameRepair {
    /// Leave them: other files may refer to the names.
    #[default]
    Keep,
    /// Write each run of blanks as one underscore, as most programs can read it.
    BlanksToUnderscores,
}

/// What to repair, and what counts as broken.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FixConfig {
    /// What to do with blanks in names.
    pub names: NameRepair,
    /// The frame time to write, in seconds; `None` leaves the file's.
    pub frame_time_secs: Option<f64>,
    /// The thresholds by which flips are found.
    pub check: CheckConfig,
}

/// What kind of repair was made. The code's name never changes once released.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum ChangeCode {
    /// Something that the reader had to put right is written right.
    WrittenRight,
    /// Line ends are LF throughout.
    LineEnds,
    /// A joint's Euler angles are continuous.
    FlipsUnwrapped,
    /// The frame time is another one, as asked for.
    FrameTimeSet,
    /// A frame time that cannot be right right was left, because nobody said the right one.
    FrameTimeKept,
    /// Values of which no motion can be made were left.
    ValueKept,
    /// Values that were not numbers were filled from the frames beside them.
    GapBridged,
    /// Blanks in a name became underscores.
    NameBlanks,
    /// Blanks in a name were left, because without them it would be another joint's name.
    NameKept,
}

impl ChangeCode {
    /// The stable name, in kebab case.
    pub const fn code(self) -> &'static str {
        match self {
            Self::WrittenRight => "written-right",
            Self::LineEnds => "line-ends",
            Self::FlipsUnwrapped => "flips-unwrapped",
            Self::FrameTimeSet => "frame-time-set",
            Self::FrameTimeKept => "frame-time-kept",
            Self::ValueKept => "value-kept",
            Self::GapBridged => "gap-bridged",
            Self::NameBlanks => "name-blanks",
            Self::NameKept => "name-kept",
        }
    }
}

impl fmt::Display for ChangeCode {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.code())
    }
}

/// One repair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// What kind of repair it is.
    pub code: ChangeCode,
    /// The joint that was changed, by its name in the file; `None` when it is about the whole file.
    pub joint: Option<String>,
    /// The frames in which values changed, counted from 0.
    pub frames: Option<FrameRange>,
    /// Where in the file what was repaired is, when it is in the text.
    pub location: Option<Location>,
    /// How many values, lines or occurrences changed.
    pub count: usize,
    /// What was changed, in a sentence without a capital and a full stop.
    pub message: String,
}

/// A repaired document and everything that was changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixed {
    /// The document to write.
    pub document: Bvh,
    /// The changes: the file's text first, then its joints in their order. Empty when there was
    /// nothing to repair.
    pub changes: Vec<Change>,
}

/// Repairs what can be repaired without guessing.
///
/// `bytes` is the file that `import` was read from; only its line ends are looked at.
///
/// # Errors
/// When [`FixConfig::frame_time_secs`] is no time, or the document has no motion to give it to.
pub fn fix(bytes: &[u8], import: &Import<Bvh>, config: &FixConfig) -> Result<Fixed, EditError> {
    let mut document = import.document.clone();
    let mut changes = written_right(import);
    changes.extend(values_kept(import));
    changes.extend(line_ends(bytes));
    changes.extend(frame_time(&mut document, config)?);
    if config.names == NameRepair::BlanksToUnderscores {
        changes.extend(rename_blanks(&mut document));
    }
    changes.extend(unwrap_flips(&mut document, &config.check));
    Ok(Fixed { document, changes })
}

/// A frame time from here on is frames a second in the wrong place, and no motion.
const SLOWEST_FRAME_TIME_SECS: f64 = 1.0;

/// Sets the frame time that was asked for, or says that the file's cannot be right.
fn frame_time(document: &mut Bvh, config: &FixConfig) -> Result<Option<Change>, EditError> {
    let old = document.motion.as_ref().map(|it| it.frame_time_secs);
    let change = |code, message| Change {
        code,
        joint: None,
        frames: None,
        location: None,
        count: 1,
        message,
    };
    let Some(secs) = config.frame_time_secs else {
        let is_possible = |secs: f64| secs > 0.0 && secs < SLOWEST_FRAME_TIME_SECS;
        let kept = old.filter(|&secs| !is_possible(secs)).map(|secs| {
            let message = format!("a frame time of {secs:?} s kept: --frame-time sets another");
            change(ChangeCode::FrameTimeKept, message)
        });
        return Ok(kept);
    };
    set_frame_time(document, secs)?;
    let differs = old.filter(|old| old.to_bits() != secs.to_bits());
    Ok(differs.map(|old| {
        let message = format!("a frame time of {old:?} s set to {secs} s");
        change(ChangeCode::FrameTimeSet, message)
    }))
}

/// Makes the Euler angles of every joint with one to three rotation channels continuous, and says what
/// changed. Each frame keeps its rotations: full turns are added, or the other solution of three
/// angles is taken.
pub fn unwrap_flips(document: &mut Bvh, config: &CheckConfig) -> Vec<Change> {
    let starts = document.column_starts();
    let channel_count = document.channel_count();
    let Bvh { joints, motion } = document;
    let Some(motion) = motion.as_mut().filter(|_| channel_count > 0) else {
        return Vec::new();
    };
    let mut changes = Vec::new();
    for (joint, start) in joints.iter().zip(starts) {
        let rotations: Vec<(usize, Axis)> = (start..)
            .zip(&joint.channels)
            .filter_map(|(column, channel)| match channel {
                Channel::Rotation(axis) => Some((column, *axis)),
                Channel::Position(_) => None,
            })
            .collect();
        let rows = motion.values.chunks_exact_mut(channel_count);
        if let Some(unwrapped) = unwrap_joint(rows, &rotations, config) {
            changes.push(unwrapped.change(&joint.name()));
        }
    }
    changes
}

/// What was done to one joint's curves.
struct Unwrapped {
    flips: usize,
    frames_changed: usize,
    values_changed: usize,
    frames: FrameRange,
}

impl Unwrapped {
    fn change(&self, name: &str) -> Change {
        let flips = if self.flips == 1 { "flip" } else { "flips" };
        Change {
            code: ChangeCode::FlipsUnwrapped,
            joint: Some(name.to_owned()),
            frames: Some(self.frames),
            location: None,
            count: self.values_changed,
            message: format!(
                "{} {flips} of {name} unwrapped: other angles of the same rotations in {} frames",
                self.flips, self.frames_changed
            ),
        }
    }
}

fn unwrap_joint<'a>(
    rows: impl Iterator<Item = &'a mut [f64]>,
    rotations: &[(usize, Axis)],
    config: &CheckConfig,
) -> Option<Unwrapped> {
    let axes: Vec<Axis> = rotations.iter().map(|rotation| rotation.1).collect();
    let mut tracker = EulerTracker::new(&axes, config)?;
    let mut flips = 0;
    let mut frames_changed = 0;
    let mut values_changed = 0;
    let mut frames: Option<FrameRange> = None;
    for (frame, row) in rows.enumerate() {
        let mut angles = [0.0; 3];
        for (angle, &(column, _)) in angles.iter_mut().zip(rotations) {
            *angle = row[column];
        }
        let step = tracker.advance(angles);
        flips += usize::from(matches!(step, EulerStep::Flipped { .. }));
        if tracker.branch().is_identity() {
            continue;
        }
        for (angle, &(column, _)) in tracker.continuous_deg().iter().zip(rotations) {
            values_changed += usize::from(row[column].to_bits() != angle.to_bits());
            row[column] = *angle;
        }
        frames_changed += 1;
        let first = frames.map_or(frame, |frames| frames.first);
        frames = Some(FrameRange { first, last: frame });
    }
    frames.map(|frames| Unwrapped {
        flips,
        frames_changed,
        values_changed,
        frames,
    })
}

/// What the reader only noticed, and wrote into the document as it is.
const KEPT: [WarningCode; 2] = [WarningCode::BadFrameTime, WarningCode::ValueOutOfRange];

/// What the reader put right is right in a file written from the document.
fn written_right(import: &Import<Bvh>) -> Vec<Change> {
    let warnings = import.report.warnings.iter();
    // What is wrong with a file that this one names is written nowhere.
    let repairs = warnings
        .filter(|warning| warning.code.severity() == Severity::Warning && warning.file.is_none());
    repairs
        .filter(|warning| !KEPT.contains(&warning.code))
        .map(|warning| Change {
            code: ChangeCode::WrittenRight,
            joint: None,
            frames: None,
            location: warning.place.location(),
            count: warning.count,
            message: format!("{} [{}]", warning.message, warning.code),
        })
        .collect()
}

/// Values beyond the range that are still there.
fn values_kept(import: &Import<Bvh>) -> Vec<Change> {
    let document = &import.document;
    let rows = document.values_out_of_range().len();
    let offsets = document.joints.iter().flat_map(|joint| joint.offset);
    let offsets = offsets.filter(|offset| offset.abs() > LONGEST_LENGTH);
    let kept = |count: usize, what: &str, remedy: &str| Change {
        code: ChangeCode::ValueKept,
        joint: None,
        frames: None,
        location: None,
        count,
        message: format!(
            "{count} {what} beyond {LONGEST_LENGTH:e} kept, too large for a motion{remedy}"
        ),
    };
    let bridge = ": --bridge-gaps fills them from the frames beside them";
    let all = [
        kept(rows, "values of rows", bridge),
        kept(offsets.count(), "coordinates of OFFSETs", ""),
    ];
    all.into_iter().filter(|change| change.count > 0).collect()
}

fn line_ends(bytes: &[u8]) -> Option<Change> {
    let returns = memchr::memchr_iter(b'\r', bytes);
    let count = returns.count();
    (count > 0).then(|| Change {
        code: ChangeCode::LineEnds,
        joint: None,
        frames: None,
        location: None,
        count,
        message: format!("{count} line ends with a carriage return written as LF"),
    })
}

fn rename_blanks(document: &mut Bvh) -> Vec<Change> {
    let mut taken: HashSet<Vec<u8>> = document
        .joints
        .iter()
        .map(|joint| joint.name.clone())
        .collect();
    let mut changes = Vec::new();
    for joint in &mut document.joints {
        let renamed = without_blanks(&joint.name);
        if renamed == joint.name {
            continue;
        }
        let old = joint.name().into_owned();
        let new = String::from_utf8_lossy(&renamed).into_owned();
        let is_free = taken.insert(renamed.clone());
        // A name that stands in no file follows its joint's without being a change.
        if joint.is_end_site && joint.end_name == EndName::Implied {
            joint.name = renamed;
            continue;
        }
        let (code, message) = if is_free {
            joint.name = renamed;
            let message = format!("`{old}` renamed to `{new}`");
            (ChangeCode::NameBlanks, message)
        } else {
            let message = format!("`{old}` kept its blanks: another joint is named `{new}`");
            (ChangeCode::NameKept, message)
        };
        changes.push(Change {
            code,
            joint: Some(old),
            frames: None,
            location: None,
            count: 1,
            message,
        });
    }
    changes
}

/// A name with each run of blanks as one underscore.
fn without_blanks(name: &[u8]) -> Vec<u8> {
    let words = name
        .split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join(&b'_')
}
