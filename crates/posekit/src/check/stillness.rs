//! Frames that repeat each other: freezes, dropped frames, and motions that do not move.
//!
//! A capture that stalls is torn out of a motion and falls back into it. A pose that is held on
//! purpose is reached slowly and left slowly, and machines and figures without feet hold still to the
//! digit whenever they have nothing to do: that is worth knowing and no fault.

use super::statistics::median;
use super::{CheckConfig, Figure, Finding, FindingCode, FrameRange, Severity, Unit, whole_up};
use crate::motion::Motion;

/// A motion shorter than this says nothing about how often it repeats frames.
const FRAMES_MIN: usize = 20;

/// A hold is reached and left in steps that are at most this share of the usual step.
const EASED_SHARE: f64 = 0.1;

/// A run of frames that repeat each other.
#[derive(Clone, Copy)]
struct Freeze {
    first: usize,
    steps: usize,
}

impl Freeze {
    fn frames(self) -> FrameRange {
        FrameRange {
            first: self.first,
            last: self.first + self.steps,
        }
    }
}

pub(super) fn check(
    motion: &Motion,
    figure: &Figure,
    config: &CheckConfig,
    findings: &mut Vec<Finding>,
) {
    let frame_count = motion.frame_count();
    if frame_count < 2 {
        return;
    }
    let still: Vec<bool> = (1..frame_count)
        .map(|frame| repeats(motion, frame))
        .collect();
    if still.iter().all(|&is_still| is_still) {
        findings.push(static_motion(frame_count));
        return;
    }
    let freeze_steps =
        whole_up(config.freeze_secs / motion.frame_time_secs()).max(config.freeze_steps_min);
    let usual_step = usual_step(motion, &still);
    let mut repeated = Vec::new();
    let mut holds: Vec<Freeze> = Vec::new();
    for (first, steps) in runs(&still) {
        let in_the_middle = first > 0 && first + steps < still.len();
        if in_the_middle && steps >= freeze_steps {
            let freeze = Freeze { first, steps };
            if figure.feet.is_empty() || is_eased(motion, freeze, usual_step) {
                holds.push(freeze);
            } else {
                findings.push(stall(motion, freeze));
            }
        } else if in_the_middle {
            repeated.extend(first + 1..=first + steps);
        }
    }
    findings.extend(held(motion, &holds));
    findings.extend(duplicates(motion, &repeated, config));
}

/// Whether a frame is the same as the one before, to the bit.
fn repeats(motion: &Motion, frame: usize) -> bool {
    let translated = motion.translated_joints().iter();
    let rotated = motion.rotated_joints().iter();
    translated
        .copied()
        .all(|joint| motion.translation(frame, joint) == motion.translation(frame - 1, joint))
        && rotated
            .copied()
            .all(|joint| motion.rotation(frame, joint) == motion.rotation(frame - 1, joint))
}

/// Runs of `true`: where each starts and how long it is.
fn runs(still: &[bool]) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for (step, _) in still.iter().enumerate().filter(|(_, is_still)| **is_still) {
        match runs.last_mut() {
            Some((first, length)) if *first + *length == step => *length += 1,
            _ => runs.push((step, 1)),
        }
    }
    runs
}

fn static_motion(frame_count: usize) -> Finding {
    Finding {
        code: FindingCode::StaticMotion,
        severity: Severity::Info,
        joints: Vec::new(),
        frames: None,
        value: frame_count as f64,
        unit: Unit::Frames,
        share_of_height: None,
        message: format!("all {frame_count} frames are the same: a pose, not a motion"),
    }
}

/// How far the joint turns that turns farthest from a frame to the next, in radians.
fn turn(motion: &Motion, frame: usize) -> f64 {
    let turns = motion.rotated_joints().iter().map(|&joint| {
        let before = motion.rotation(frame, joint);
        f64::from(before.angle_between(motion.rotation(frame + 1, joint)))
    });
    turns.fold(0.0, f64::max)
}

/// The median turn of the steps that are not still, in radians.
fn usual_step(motion: &Motion, still: &[bool]) -> f64 {
    let moving = (0..still.len()).filter(|&step| !still[step]);
    median(&mut moving.map(|step| turn(motion, step)).collect::<Vec<_>>())
}

/// Whether a freeze in the middle of a motion is reached slowly and left slowly.
fn is_eased(motion: &Motion, freeze: Freeze, usual_step: f64) -> bool {
    let limit = EASED_SHARE * usual_step;
    turn(motion, freeze.first - 1) <= limit && turn(motion, freeze.first + freeze.steps) <= limit
}

fn stall(motion: &Motion, freeze: Freeze) -> Finding {
    let secs = freeze.steps as f64 * motion.frame_time_secs();
    Finding {
        code: FindingCode::FrozenFrames,
        severity: Severity::Warning,
        joints: Vec::new(),
        frames: Some(freeze.frames()),
        value: secs,
        unit: Unit::Seconds,
        share_of_height: None,
        message: format!(
            "nothing moves for {secs:.2} seconds: {} frames are the same to the digit, with motion \
             before and after",
            freeze.steps + 1
        ),
    }
}

/// All holds of a motion in one finding: they are meant, and one is like the other.
fn held(motion: &Motion, holds: &[Freeze]) -> Option<Finding> {
    let (first, last) = (holds.first()?, holds.last()?);
    let steps: usize = holds.iter().map(|hold| hold.steps).sum();
    let secs = steps as f64 * motion.frame_time_secs();
    let how_often = match holds.len() {
        1 => "once".to_owned(),
        count => format!("{count} times"),
    };
    Some(Finding {
        code: FindingCode::FrozenFrames,
        severity: Severity::Info,
        joints: Vec::new(),
        frames: Some(FrameRange {
            first: first.first,
            last: last.frames().last,
        }),
        value: secs,
        unit: Unit::Seconds,
        share_of_height: None,
        message: format!(
            "the pose is held {how_often}, for {secs:.2} seconds in all, as motion made by hand or by a \
             machine does"
        ),
    })
}

fn duplicates(motion: &Motion, repeated: &[usize], config: &CheckConfig) -> Option<Finding> {
    let frame_count = motion.frame_count();
    let share = repeated.len() as f64 / frame_count as f64;
    if frame_count < FRAMES_MIN || repeated.len() < 2 || share < config.duplicate_share {
        return None;
    }
    let period = even_spacing(repeated);
    let rhythm = period.map_or(String::new(), |period| {
        let fps = 1.0 / motion.frame_time_secs();
        let source_fps = fps * (period - 1) as f64 / period as f64;
        format!(
            ", one in every {period}: as after a conversion from {source_fps:.0} to {fps:.0} frames \
             a second"
        )
    });
    Some(Finding {
        code: FindingCode::DuplicateFrames,
        severity: Severity::Warning,
        joints: Vec::new(),
        frames: Some(FrameRange {
            first: repeated[0],
            last: repeated[repeated.len() - 1],
        }),
        value: repeated.len() as f64,
        unit: Unit::Frames,
        share_of_height: None,
        message: format!(
            "{} of {frame_count} frames repeat the one before{rhythm}",
            repeated.len()
        ),
    })
}

/// The distance between repeated frames when nearly all are the same distance apart.
fn even_spacing(repeated: &[usize]) -> Option<usize> {
    let mut gaps: Vec<usize> = repeated.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = gaps.len() / 2;
    let period = *gaps.select_nth_unstable(middle).1;
    let even = gaps.iter().filter(|&&gap| gap == period).count();
    (period >= 2 && 10 * even >= 9 * gaps.len()).then_some(period)
}
