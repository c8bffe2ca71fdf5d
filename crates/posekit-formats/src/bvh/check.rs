//! Everything worth knowing about a BVH file in one list: what the reader noticed, what is wrong with
//! the channels, and what is suspicious in the motion.

use posekit::check::{
    CheckConfig, Finding, FindingCode, FrameRange, RelativePositions, Severity, Unit,
    check_channels, check_motion, relative_positions,
};
use posekit::figure::{UpAxis, UpTaken, take_up};
use posekit::motion::{Motion, PositionPolicies};
use posekit::range::{LONGEST_LENGTH, are_lengths};
use posekit::skeleton::{JointId, Skeleton};

use super::bridge::in_words;
use super::{Bvh, BvhJoint, Gap, JointGaps, MotionError, bridge_gaps, gaps_by_joint};
use crate::report::{self, ImportReport, Place, Warning, WarningCode};

/// One entry of a file's check, ready to be shown: a [`Finding`] or a reader's [`Warning`].
#[derive(Clone, Debug, PartialEq)]
pub struct CheckEntry {
    /// The stable code, that of a [`FindingCode`](posekit::check::FindingCode) or of a
    /// [`WarningCode`](crate::report::WarningCode); the guide has a page for each.
    pub code: &'static str,
    /// How much it means. A reader's note is an [`Severity::Info`].
    pub severity: Severity,
    /// The unique names of the joints that it is about; empty when it is about the whole file.
    pub joints: Vec<String>,
    /// The frames that it is about, counted from 0; `None` when it is about all or none.
    pub frames: Option<FrameRange>,
    /// The file that it is about, where that is one that the checked one names.
    pub file: Option<String>,
    /// Where it is in the file, for what the reader noticed.
    pub place: Option<Place>,
    /// How much was measured, in `unit`.
    pub value: f64,
    /// What `value` counts.
    pub unit: Unit,
    /// The same length as a share of the figure's height, where `value` is a length.
    pub share_of_height: Option<f64>,
    /// What was found, in a sentence without a capital and a full stop.
    pub message: String,
}

/// How the numbers of a document are taken when it is checked.
#[derive(Clone, Copy, Debug, Default)]
pub struct CheckAs {
    /// What position channels mean.
    pub positions: PositionPolicies,
    /// The axis that points up; `None` takes the one that [`take_up`] finds.
    pub up: Option<UpAxis>,
}

impl<P: Into<PositionPolicies>> From<P> for CheckAs {
    fn from(positions: P) -> Self {
        Self {
            positions: positions.into(),
            up: None,
        }
    }
}

/// What a check found, and how it took the document.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The entries, as [`check`] gives them.
    pub entries: Vec<CheckEntry>,
    /// The axis along which floor and feet were looked for.
    pub up: UpTaken,
}

/// Checks a document: first what the reader noticed, one entry a code (its place is that of the first
/// occurrence, `value` counts all of them), in the order of the file, then the findings in
/// channels and motion, sorted as [`posekit::check::sort_findings`] does.
///
/// `import_report` is what [`read`](super::read()) returned with the document; `how` is what its
/// position channels mean, and which axis is up. Where channels turn out to mean something else
/// ([`relative_positions`]), that is a finding, and the motion is checked as it is meant: otherwise a figure that
/// nobody recorded is blamed. So it is with a figure that stands along another axis than Y: it is stood up.
///
/// # Errors
/// When the document has no joints, or a parent does not come before its child.
pub fn check(
    bvh: &Bvh,
    import_report: &ImportReport,
    how: impl Into<CheckAs>,
    config: &CheckConfig,
) -> Result<Vec<CheckEntry>, MotionError> {
    Ok(check_with_gaps(bvh, &[], import_report, how, config)?.entries)
}

/// As [`check`], of a document that [`read_with_gaps`](super::read_with_gaps) gave: values that are no
/// numbers are findings, one a joint, and everything else is checked with bridges over them. So it is of values
/// that are too large to make a motion of.
///
/// # Errors
/// As [`check`].
pub fn check_with_gaps(
    bvh: &Bvh,
    gaps: &[Gap],
    import_report: &ImportReport,
    how: impl Into<CheckAs>,
    config: &CheckConfig,
) -> Result<Checked, MotionError> {
    let how = how.into();
    let mut entries = reader_entries(import_report);
    let beyond = OutOfRange::of(bvh);
    if gaps.is_empty() && beyond.is_none() {
        return check_whole(bvh, entries, how, config, Vec::new());
    }
    let found = gaps_by_joint(bvh, gaps)
        .iter()
        .map(gap_finding(bvh))
        .collect();
    let mut whole = bvh.clone();
    let mut bridged = [gaps, &beyond.values].concat();
    bridged.sort_unstable();
    beyond.remove_from(&mut whole);
    // What cannot be bridged at all stays 0.
    let _ = bridge_gaps(&mut whole, &bridged, usize::MAX);
    if !beyond.is_none() {
        beyond.add_to(&mut entries, bvh);
    }
    check_whole(&whole, entries, how, config, found)
}

/// The lengths and angles of a document of which no motion can be made.
struct OutOfRange {
    values: Vec<Gap>,
    /// The joints whose OFFSETs have such a coordinate.
    offsets: Vec<usize>,
}

impl OutOfRange {
    fn of(bvh: &Bvh) -> Self {
        let is_beyond = |joint: &BvhJoint| !are_lengths(joint.offset);
        let joints = bvh.joints.iter().enumerate();
        Self {
            values: bvh.values_out_of_range(),
            offsets: joints
                .filter(|(_, joint)| is_beyond(joint))
                .map(|(index, _)| index)
                .collect(),
        }
    }

    fn is_none(&self) -> bool {
        self.values.is_empty() && self.offsets.is_empty()
    }

    /// Puts 0 in their place.
    fn remove_from(&self, bvh: &mut Bvh) {
        for &joint in &self.offsets {
            let offset = &mut bvh.joints[joint].offset;
            *offset = offset.map(|value| if are_lengths([value]) { value } else { 0.0 });
        }
        let width = bvh.channel_count();
        if let Some(motion) = &mut bvh.motion {
            for gap in &self.values {
                motion.values[gap.frame * width + gap.column] = 0.0;
            }
        }
    }

    /// Says whose they are, in the entry that has the place of the first where the document came from a text.
    fn add_to(&self, entries: &mut Vec<CheckEntry>, bvh: &Bvh) {
        let code = WarningCode::ValueOutOfRange.code();
        let by_joint = gaps_by_joint(bvh, &self.values);
        let mut joints: Vec<usize> = by_joint.iter().map(|it| it.joint).collect();
        joints.extend(&self.offsets);
        joints.sort_unstable();
        joints.dedup();
        let names = joints
            .iter()
            .map(|&joint| bvh.joints[joint].name().into_owned());
        let names: Vec<String> = names.collect();
        let ends = self.values.first().zip(self.values.last());
        let frames = ends.map(|(first, last)| FrameRange {
            first: first.frame,
            last: last.frame,
        });
        let count = self.values.len() + self.offsets.len();
        let whose = names.join(", ");
        let at = frames.map_or_else(String::new, |frames| format!(" in {frames}"));
        let is_there = |entry: &&mut CheckEntry| entry.code == code && entry.file.is_none();
        if let Some(entry) = entries.iter_mut().find(is_there) {
            entry.message = format!("{}; of {whose}{at}", entry.message);
            (entry.joints, entry.frames) = (names, frames);
            return;
        }
        entries.push(CheckEntry {
            code,
            severity: Severity::Error,
            joints: names,
            frames,
            file: None,
            place: None,
            value: count as f64,
            unit: Unit::Occurrences,
            share_of_height: None,
            message: format!(
                "{count} values of {whose}{at} are not within {LONGEST_LENGTH:e}, too large for a motion"
            ),
        });
    }
}

/// What is said of a joint with values that are not numbers.
fn gap_finding(bvh: &Bvh) -> impl Fn(&JointGaps) -> Finding {
    |gaps| {
        let name = bvh.joints[gaps.joint].name();
        let (is, number) = match gaps.count {
            1 => ("value", "is not a number"),
            _ => ("values", "are not numbers"),
        };
        Finding {
            code: FindingCode::NotFinite,
            severity: Severity::Error,
            joints: vec![JointId::new(gaps.joint)],
            frames: gaps
                .runs
                .first()
                .zip(gaps.runs.last())
                .map(|(first, last)| FrameRange {
                    first: first.first,
                    last: last.last,
                }),
            value: gaps.count as f64,
            unit: Unit::Occurrences,
            share_of_height: None,
            message: format!(
                "{} {is} of {name} {number} (nan, inf or the like), in {}: posekit fix --bridge-gaps fills \
                 short gaps",
                gaps.count,
                in_words(&gaps.runs)
            ),
        }
    }
}

fn check_whole(
    bvh: &Bvh,
    mut entries: Vec<CheckEntry>,
    how: CheckAs,
    config: &CheckConfig,
    more: Vec<Finding>,
) -> Result<Checked, MotionError> {
    let policies = how.positions;
    let mut motion = bvh.to_motion(policies)?;
    let relative = bvh.relative_positions(&motion, policies);
    if let Some(relative) = &relative {
        motion = bvh.to_motion(relative.policies)?;
    }
    let up = take_up(&motion, how.up);
    let motion = up.up.stand(motion);
    let skeleton = motion.skeleton();
    let mut findings = check_motion(&motion, &motion.to_global(), config);
    if let Some(rows) = &bvh.motion {
        let layout = bvh.channel_layout();
        findings.extend(check_channels(skeleton, &layout, &rows.values, config));
    }
    findings.extend(more);
    let concerns_root = relative.as_ref().is_some_and(|it| it.concerns_root);
    findings.extend(relative.map(|relative| relative.finding));
    posekit::check::sort_findings(&mut findings);
    if concerns_root {
        // The finding says what the reader could only wonder about.
        entries.retain(|entry| entry.code != WarningCode::NonzeroRootOffset.code());
    }
    for entry in &mut entries {
        if entry.code == WarningCode::ZeroLengthEndSite.code() {
            name_open_ends(entry, bvh, skeleton);
        }
    }
    entries.extend(
        findings
            .into_iter()
            .map(|finding| finding_entry(finding, skeleton)),
    );
    Ok(Checked { entries, up })
}

impl Bvh {
    /// Looks whether position channels are relative to the OFFSETs or hold nothing although they were read
    /// as places; see [`relative_positions`]. `motion` is what [`to_motion`](Self::to_motion) made of the
    /// document under `policies`.
    pub fn relative_positions(
        &self,
        motion: &Motion,
        policies: impl Into<PositionPolicies>,
    ) -> Option<RelativePositions> {
        let read_again = |policies| {
            // What made a skeleton once makes one again.
            self.to_motion(policies).unwrap_or_else(|_| motion.clone())
        };
        relative_positions(motion, policies.into(), read_again)
    }
}

/// How many of the lines that a folded entry stands for its message lists.
const LINES_LISTED: usize = 8;

/// What the reader of a file of any format noticed: one entry for each code, in the order of the file, since
/// a skeleton with five open ends has one peculiarity and not five.
pub fn reader_entries(import_report: &ImportReport) -> Vec<CheckEntry> {
    let mut sorted: Vec<&Warning> = import_report.warnings.iter().collect();
    // Ways in JSON stay in the order in which the reader walked over them.
    sorted.sort_by_key(|warning| (warning.file.is_some(), warning.place.location()));
    let mut by_code: Vec<Vec<&Warning>> = Vec::new();
    for warning in sorted {
        let is_alike = |same: &&mut Vec<&Warning>| {
            same[0].code == warning.code && same[0].file == warning.file
        };
        match by_code.iter_mut().find(is_alike) {
            Some(same) => same.push(warning),
            None => by_code.push(vec![warning]),
        }
    }
    by_code.iter().map(|same| warning_entry(same)).collect()
}

/// The entry for warnings of one code; not empty.
fn warning_entry(same: &[&Warning]) -> CheckEntry {
    let first = same[0];
    let count: usize = same.iter().map(|warning| warning.count).sum();
    let message = if count > 1 {
        format!(
            "{} (and {} more like it{})",
            first.message,
            count - 1,
            other_lines(&same[1..], count - 1)
        )
    } else {
        first.message.clone()
    };
    CheckEntry {
        code: first.code.code(),
        severity: match first.code.severity() {
            // It was read, and yet there is no motion in it.
            _ if first.code == WarningCode::ValueOutOfRange => Severity::Error,
            report::Severity::Note => Severity::Info,
            report::Severity::Warning => Severity::Warning,
        },
        joints: Vec::new(),
        frames: None,
        file: first.file.clone(),
        place: Some(first.place.clone()),
        value: count as f64,
        unit: Unit::Occurrences,
        share_of_height: None,
        message,
    }
}

/// Says whose End Sites have no length.
fn name_open_ends(entry: &mut CheckEntry, bvh: &Bvh, skeleton: &Skeleton) {
    let is_open =
        |joint: &&BvhJoint| joint.is_end_site && joint.offset.iter().all(|&number| number == 0.0);
    entry.joints = bvh
        .joints
        .iter()
        .filter(is_open)
        .filter_map(|joint| Some(skeleton.unique_name(JointId::new(joint.parent?)).to_owned()))
        .collect();
    let whose = entry.joints.join(", ");
    entry.message = match entry.joints.len() {
        1 => format!("the End Site of {whose} has no length"),
        count => format!("{count} End Sites have no length, those of {whose}"),
    };
}

/// `, lines 12, 40, 88`, each once, with dots where not all places of `count` warnings are listed.
fn other_lines(others: &[&Warning], count: usize) -> String {
    let mut all: Vec<String> = others
        .iter()
        .map(|warning| match &warning.place {
            Place::Text(location) => location.line.to_string(),
            place => place.to_string(),
        })
        .collect();
    all.dedup();
    let are_lines = others
        .iter()
        .all(|warning| matches!(warning.place, Place::Text(_)));
    let is_whole = others.len() == count && all.len() <= LINES_LISTED;
    let more = if is_whole { "" } else { ", ..." };
    all.truncate(LINES_LISTED);
    match all.as_slice() {
        [] => String::new(),
        places if !are_lines => format!(", {}{more}", places.join(", ")),
        [line] => format!(", line {line}{more}"),
        lines => format!(", lines {}{more}", lines.join(", ")),
    }
}

fn finding_entry(finding: Finding, skeleton: &Skeleton) -> CheckEntry {
    let name = |&joint| skeleton.unique_name(joint).to_owned();
    CheckEntry {
        code: finding.code.code(),
        severity: finding.severity,
        joints: finding.joints.iter().map(name).collect(),
        frames: finding.frames,
        file: None,
        place: None,
        value: finding.value,
        unit: finding.unit,
        share_of_height: finding.share_of_height,
        message: finding.message,
    }
}
