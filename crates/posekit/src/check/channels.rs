//! Checks on the rows of channel values that a file holds: what is lost once they are rotations.

use glam::DQuat;

use super::{
    CheckConfig, EulerStep, EulerTracker, Finding, FindingCode, FrameRange, Severity, Unit,
    sort_findings,
};
use crate::motion::{Channel, ChannelLayout};
use crate::rotation::Axis;
use crate::skeleton::{JointId, Skeleton};

/// How many frame numbers a message lists.
const FRAMES_LISTED: usize = 4;

/// Everything suspicious in rows of channel values, sorted as [`sort_findings`] does: Euler flips,
/// channels that race near gimbal lock, and channels that never change.
///
/// `rows` holds one row after the other, angles in degrees, as for
/// [`Motion::from_channel_rows`](crate::motion::Motion::from_channel_rows); values after the last
/// whole row are not looked at.
///
/// # Panics
/// If the layout names a joint that the skeleton does not have.
pub fn check_channels(
    skeleton: &Skeleton,
    layout: &ChannelLayout,
    rows: &[f64],
    config: &CheckConfig,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let column_count = layout.column_count();
    if column_count == 0 || rows.len() < 2 * column_count {
        return findings;
    }
    for mut watch in flip_watches(layout, config) {
        for (frame, row) in rows.chunks_exact(column_count).enumerate() {
            watch.advance(frame, row, config);
        }
        findings.extend(
            watch
                .flips
                .finding(skeleton, watch.joint, FindingCode::EulerFlip),
        );
        findings.extend(
            watch
                .races
                .finding(skeleton, watch.joint, FindingCode::GimbalLock),
        );
    }
    findings.extend(constant_channels(layout, rows));
    sort_findings(&mut findings);
    findings
}

/// Follows the rotation channels of one joint.
struct FlipWatch {
    joint: JointId,
    columns: Vec<usize>,
    axes: Vec<Axis>,
    tracker: EulerTracker,
    before: [f64; 3],
    flips: Events,
    races: Events,
}

/// Where something happened, and how far channels jumped at most.
#[derive(Default)]
struct Events {
    frames: Vec<usize>,
    jump_deg: f64,
}

/// The joints with one to three rotation channels, in topological order.
fn flip_watches(layout: &ChannelLayout, config: &CheckConfig) -> Vec<FlipWatch> {
    let mut rotations: Vec<(JointId, usize, Axis)> = Vec::new();
    for (column, &(joint, channel)) in layout.columns().iter().enumerate() {
        if let Channel::Rotation(axis) = channel {
            rotations.push((joint, column, axis));
        }
    }
    rotations.sort_by_key(|&(joint, column, _)| (joint, column));
    let by_joint = rotations.chunk_by(|a, b| a.0 == b.0);
    by_joint
        .filter_map(|channels| {
            let axes: Vec<Axis> = channels.iter().map(|channel| channel.2).collect();
            let tracker = EulerTracker::new(&axes, config)?;
            Some(FlipWatch {
                joint: channels[0].0,
                columns: channels.iter().map(|channel| channel.1).collect(),
                axes,
                tracker,
                before: [0.0; 3],
                flips: Events::default(),
                races: Events::default(),
            })
        })
        .collect()
}

impl FlipWatch {
    fn advance(&mut self, frame: usize, row: &[f64], config: &CheckConfig) {
        let mut angles = [0.0; 3];
        for (angle, &column) in angles.iter_mut().zip(&self.columns) {
            *angle = row[column];
        }
        match self.tracker.advance(angles) {
            EulerStep::Continued => {}
            EulerStep::Flipped { jump_deg } => self.flips.add(frame, jump_deg),
            EulerStep::Raced { jump_deg } => {
                let turned_deg = angle_between_deg(&self.axes, self.before, angles);
                if turned_deg * config.gimbal_factor < jump_deg {
                    self.races.add(frame, jump_deg);
                }
            }
        }
        self.before = angles;
    }
}

impl Events {
    fn add(&mut self, frame: usize, jump_deg: f64) {
        self.frames.push(frame);
        self.jump_deg = self.jump_deg.max(jump_deg);
    }

    fn finding(&self, skeleton: &Skeleton, joint: JointId, code: FindingCode) -> Option<Finding> {
        let (&first, &last) = (self.frames.first()?, self.frames.last()?);
        let name = skeleton.unique_name(joint);
        let count = self.frames.len();
        let jump_deg = self.jump_deg;
        let at = self.list();
        let message = match code {
            FindingCode::EulerFlip => format!(
                "{name}: channels jump by up to {jump_deg:.0} degrees and the joint does not, at {at}"
            ),
            _ => format!(
                "{name} passes near gimbal lock: channels race by up to {jump_deg:.0} degrees a \
                 frame while it hardly turns, at {at}"
            ),
        };
        Some(Finding {
            code,
            // The rotations are right: only what is computed from the numbers between frames is not.
            severity: Severity::Info,
            joints: vec![joint],
            frames: Some(FrameRange { first, last }),
            value: count as f64,
            unit: Unit::Occurrences,
            share_of_height: None,
            message,
        })
    }

    /// `frame 7`, `frames 7, 9` or `frames 7, 9, 12, 20 and 31 more`.
    fn list(&self) -> String {
        let listed: Vec<String> = self
            .frames
            .iter()
            .take(FRAMES_LISTED)
            .map(usize::to_string)
            .collect();
        let word = if self.frames.len() == 1 {
            "frame"
        } else {
            "frames"
        };
        let more = self.frames.len() - listed.len();
        let rest = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        format!("{word} {}{rest}", listed.join(", "))
    }
}

fn angle_between_deg(axes: &[Axis], a: [f64; 3], b: [f64; 3]) -> f64 {
    let rotation = |angles: [f64; 3]| {
        axes.iter()
            .zip(angles)
            .fold(DQuat::IDENTITY, |q, (axis, angle)| {
                q * DQuat::from_axis_angle(axis.unit(), angle.to_radians())
            })
    };
    let (a, b) = (rotation(a), rotation(b));
    let chord = (a - b).length().min((a + b).length());
    (4.0 * libm::asin((0.5 * chord).min(1.0))).to_degrees()
}

/// Channels that hold one value in all frames, unless all of them do: that is a pose, and
/// [`FindingCode::StaticMotion`] says so.
fn constant_channels(layout: &ChannelLayout, rows: &[f64]) -> Option<Finding> {
    let column_count = layout.column_count();
    let mut constant: Vec<usize> = (0..column_count).collect();
    for row in rows.chunks_exact(column_count).skip(1) {
        constant.retain(|&column| row[column].to_bits() == rows[column].to_bits());
        if constant.is_empty() {
            return None;
        }
    }
    if constant.len() == column_count {
        return None;
    }
    let mut joints: Vec<JointId> = constant
        .iter()
        .map(|&column| layout.columns()[column].0)
        .collect();
    joints.sort_unstable();
    joints.dedup();
    Some(Finding {
        code: FindingCode::ConstantChannels,
        severity: Severity::Info,
        joints,
        frames: None,
        value: constant.len() as f64,
        unit: Unit::Channels,
        share_of_height: None,
        message: format!("{} of {column_count} channels never change", constant.len()),
    })
}
