//! Spikes, jumps and teleports, and a first frame that does not belong to the motion.

use glam::{Quat, Vec3};

use super::breaks::{Break, BreakKind, BreakLimits, find_breaks};
use super::{CheckConfig, Figure, Finding, FindingCode, FrameRange, Severity, Unit};
use crate::motion::{GlobalMotion, Motion};
use crate::skeleton::JointId;

/// The first frame is a reference pose when this many joints jump away from it.
const REFERENCE_JOINTS_MIN: usize = 3;

/// ... and the rest of the motion is this many times slower, in the median over its first steps.
const REFERENCE_CONTRAST: f64 = 8.0;

/// How many steps on either side of one tell the figure's usual way.
const WAY_STEPS: usize = 4;

/// How many steps after the first tell how fast the motion begins.
const BEGINNING_STEPS: usize = 8;

/// Twice the chord between two rotations as quaternions: their angle in radians, 1 per cent less at
/// 60 degrees, without an arc function.
fn chordal_angle(a: Quat, b: Quat) -> f64 {
    let (a, b) = (a.as_dquat(), b.as_dquat());
    2.0 * (a - b).length().min((a + b).length())
}

/// The angle in degrees that a [`chordal_angle`] stands for.
fn degrees_of_chordal(chordal: f64) -> f64 {
    (4.0 * libm::asin((0.25 * chordal).min(1.0))).to_degrees()
}

/// The [`chordal_angle`] of an angle in degrees.
fn chordal_of_degrees(angle_deg: f64) -> f64 {
    4.0 * libm::sin(0.25 * angle_deg.to_radians())
}

/// The steps of every joint and of the figure.
struct Steps {
    /// Chordal angles of each rotated joint.
    turns: Vec<(JointId, Vec<f64>)>,
    /// How far the joint that carries the figure moves in each step beyond its usual way, in file units.
    travel: Vec<f64>,
    /// Its usual way in each step.
    usual_way: Vec<Vec3>,
}

pub(super) fn check(
    motion: &Motion,
    global: &GlobalMotion,
    figure: &Figure,
    config: &CheckConfig,
    findings: &mut Vec<Finding>,
) {
    let mut steps = steps_of(motion, global, figure);
    if let Some(finding) = reference_first_frame(motion, figure, &steps, config) {
        findings.push(finding);
        for (_, turns) in &mut steps.turns {
            forget_first_step(turns);
        }
        forget_first_step(&mut steps.travel);
    }
    let limits = rotation_limits(motion.frame_time_secs(), config);
    for (joint, turns) in &steps.turns {
        let turn = |a, b| chordal_angle(motion.rotation(a, *joint), motion.rotation(b, *joint));
        let breaks = find_breaks(turns, turn, &limits);
        findings.extend(
            breaks
                .iter()
                .map(|found| rotation_finding(motion, *joint, found)),
        );
    }
    if figure.height > 0.0 {
        let limits = travel_limits(figure, config);
        let way = |a: usize, b: usize| {
            let way = global.position(b, figure.root) - global.position(a, figure.root);
            f64::from((way - (b - a) as f32 * steps.usual_way[a]).length())
        };
        let breaks = find_breaks(&steps.travel, way, &limits);
        findings.extend(breaks.iter().map(|found| travel_finding(figure, found)));
    }
}

fn steps_of(motion: &Motion, global: &GlobalMotion, figure: &Figure) -> Steps {
    let step_count = motion.frame_count().saturating_sub(1);
    let turns = motion.rotated_joints().iter().map(|&joint| {
        let mut turns = Vec::with_capacity(step_count);
        let mut before = motion.rotation(0, joint);
        for frame in 1..=step_count {
            let now = motion.rotation(frame, joint);
            turns.push(chordal_angle(before, now));
            before = now;
        }
        (joint, turns)
    });
    let ways: Vec<Vec3> = (0..step_count)
        .map(|step| global.position(step + 1, figure.root) - global.position(step, figure.root))
        .collect();
    let usual_way: Vec<Vec3> = (0..step_count)
        .map(|step| median_way(&ways, step))
        .collect();
    let travel = ways
        .iter()
        .zip(&usual_way)
        .map(|(way, usual)| f64::from(way.distance(*usual)));
    Steps {
        turns: turns.collect(),
        travel: travel.collect(),
        usual_way,
    }
}

/// The median of the ways around a step, axis by axis: what the figure does but for a break. Against
/// it a break of a walking figure is as large as one of a standing figure.
fn median_way(ways: &[Vec3], step: usize) -> Vec3 {
    let first = step.saturating_sub(WAY_STEPS);
    let around = &ways[first..(step + WAY_STEPS + 1).min(ways.len())];
    let along = |axis: usize| {
        let mut values = [0.0_f32; 2 * WAY_STEPS + 1];
        for (value, way) in values.iter_mut().zip(around) {
            *value = way[axis];
        }
        let values = &mut values[..around.len()];
        values.sort_unstable_by(f32::total_cmp);
        values[values.len() / 2]
    };
    Vec3::new(along(0), along(1), along(2))
}

fn forget_first_step(steps: &mut [f64]) {
    if let Some(first) = steps.first_mut() {
        *first = 0.0;
    }
}

fn rotation_limits(frame_time_secs: f64, config: &CheckConfig) -> BreakLimits {
    let by_speed = config.break_speed_deg_per_sec * frame_time_secs;
    let smallest_deg = by_speed
        .min(config.break_angle_max_deg)
        .max(config.break_angle_deg);
    BreakLimits {
        smallest: chordal_of_degrees(smallest_deg),
        smallest_spike: chordal_of_degrees(config.break_angle_deg),
        factor: config.break_factor,
        contrast: config.break_contrast,
        spike_frames_max: config.spike_frames_max,
    }
}

fn travel_limits(figure: &Figure, config: &CheckConfig) -> BreakLimits {
    BreakLimits {
        smallest: config.break_distance_heights * figure.height,
        smallest_spike: config.break_distance_heights * figure.height,
        factor: config.break_factor,
        contrast: config.break_contrast,
        spike_frames_max: config.spike_frames_max,
    }
}

/// A first frame that several joints leave in one step, or the figure by more than a step can be,
/// while the motion after it begins calmly.
fn reference_first_frame(
    motion: &Motion,
    figure: &Figure,
    steps: &Steps,
    config: &CheckConfig,
) -> Option<Finding> {
    if motion.frame_count() < BEGINNING_STEPS {
        return None;
    }
    let smallest = chordal_of_degrees(config.break_angle_deg);
    let leaving: Vec<&(JointId, Vec<f64>)> = steps
        .turns
        .iter()
        .filter(|(_, turns)| leaves_first(turns, smallest))
        .collect();
    if leaving.len() < REFERENCE_JOINTS_MIN {
        return None;
    }
    let largest = leaving
        .iter()
        .map(|(_, turns)| turns[0])
        .fold(0.0, f64::max);
    let angle_deg = degrees_of_chordal(largest);
    let moved = if leaves_first(&steps.travel, config.break_distance_heights * figure.height) {
        " and the figure moves to another place"
    } else {
        ""
    };
    Some(Finding {
        code: FindingCode::ReferenceFirstFrame,
        severity: Severity::Warning,
        joints: leaving.iter().map(|(joint, _)| *joint).collect(),
        frames: Some(FrameRange::single(0)),
        value: angle_deg,
        unit: Unit::Degrees,
        share_of_height: None,
        message: format!(
            "the first frame is a separate pose: after it {} joints turn by up to {angle_deg:.0} \
             degrees at once{moved}; the motion begins at frame 1",
            leaving.len()
        ),
    })
}

fn leaves_first(steps: &[f64], smallest: f64) -> bool {
    let Some((&first, rest)) = steps.split_first() else {
        return false;
    };
    let mut beginning = rest[..rest.len().min(BEGINNING_STEPS)].to_vec();
    first > smallest && first > REFERENCE_CONTRAST * super::statistics::median(&mut beginning)
}

fn rotation_finding(motion: &Motion, joint: JointId, found: &Break) -> Finding {
    let name = motion.skeleton().unique_name(joint);
    let angle_deg = degrees_of_chordal(found.size);
    let usual_deg = degrees_of_chordal(found.usual_step);
    let frames = FrameRange {
        first: found.first,
        last: found.last,
    };
    let (code, message) = match found.kind {
        BreakKind::Spike => (
            FindingCode::RotationSpike,
            format!(
                "{name} leaves its course by {angle_deg:.0} degrees and comes back; near there it turns {usual_deg:.1} degrees a frame"
            ),
        ),
        BreakKind::Jump => (
            FindingCode::RotationJump,
            format!(
                "{name} turns by {angle_deg:.0} degrees in one frame; near there it turns {usual_deg:.1} degrees a frame"
            ),
        ),
    };
    Finding {
        code,
        severity: Severity::Warning,
        joints: vec![joint],
        frames: Some(frames),
        value: angle_deg,
        unit: Unit::Degrees,
        share_of_height: None,
        message,
    }
}

fn travel_finding(figure: &Figure, found: &Break) -> Finding {
    let share = found.size / figure.height;
    let frames = FrameRange {
        first: found.first,
        last: found.last,
    };
    let way = format!("{:.4} file units ({share:.2} of its height)", found.size);
    let usual = format!("{:.4}", found.usual_step);
    let (code, message) = match found.kind {
        BreakKind::Spike => (
            FindingCode::PositionSpike,
            format!(
                "the figure leaves its path by {way} and comes back; near there it strays by {usual} a frame"
            ),
        ),
        BreakKind::Jump => (
            FindingCode::Teleport,
            format!(
                "the figure jumps by {way} in one frame; near there it strays from its path by {usual} a frame"
            ),
        ),
    };
    Finding {
        code,
        severity: Severity::Warning,
        joints: vec![figure.root],
        frames: Some(frames),
        value: found.size,
        unit: Unit::FileUnits,
        share_of_height: Some(share),
        message,
    }
}
