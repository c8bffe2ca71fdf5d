//! Whether steps are as long and as quick as those of people: what a wrong playback speed breaks.
//!
//! People who walk faster take longer and quicker steps, in a ratio that hardly changes: the length
//! of a step over the steps per second is 0.384 metre seconds at any free speed (the walk ratio of
//! 0.0064 m per step a minute; Sekiya, Nagasaki, Ito and Furuna 1996, "The invariant relationship
//! between step length and step rate during free walking", Journal of Human Movement Studies 30).
//! A step's length is in the poses whatever the frame time says; the steps per second are not, so
//! the ratio tells how many times too fast the motion plays. It was 0.9 to 1.2 times that in the
//! walks and runs that this was measured on (docs/check/README.md has the figures).
//!
//! Steps are taken from the poses alone and not from contacts, which hold speeds: a step is between
//! two moments at which the feet pass each other, and is as long as the feet come apart along the
//! way that the hips face, wherever the root goes. So walks on the spot and turns count too.

use super::statistics::median;
use super::timing::{FLIGHT_HEIGHTS, STATURE_METRES};
use super::{CheckConfig, Figure, Finding, FindingCode, FloorContacts, FrameRange, Severity, Unit};
use crate::motion::GlobalMotion;
use crate::skeleton::{JointId, Skeleton};

/// Step length over steps per second of a grown-up, in metre seconds.
const WALK_RATIO: f64 = 0.384;

/// The joints that legs begin with are this far apart at least, as a share of the height.
const HIPS_APART_HEIGHTS: f64 = 0.03;

/// A foot is ahead of the other from this distance on, as a share of the height.
const AHEAD_HEIGHTS: f64 = 0.1;

/// Shorter steps than this say nothing, as a share of the height: shuffling and marking time keep no
/// ratio.
const STEP_HEIGHTS_MIN: f64 = 0.25;

/// How many steps tell a gait.
const STEPS_MIN: usize = 3;

/// How uneven steps may be: the median deviation of their times from the median, as a share of it.
/// Walks have 0.03, dances 0.4.
const UNEVENNESS_MAX: f64 = 0.12;

/// The share of frames without a foot on the floor from which on a gait is a run.
const RUN_FLIGHT_SHARE: f64 = 0.1;

/// Walks with more steps a second are not known: people run instead (Winter 1991, "The Biomechanics
/// and Motor Control of Human Gait": 1.4 to 2.3 at natural to fast cadence).
const WALK_CADENCE_MAX: f64 = 2.6;

/// Runs with more steps a second are not known: sprinters reach 4.8.
const RUN_CADENCE_MAX: f64 = 5.0;

/// Long steps at fewer of them a second are slow motion, in a walk.
const WALK_CADENCE_MIN: f64 = 1.3;

/// ... and in a run, in which gravity keeps the time.
const RUN_CADENCE_MIN: f64 = 1.7;

/// People do creep with long steps at half the usual rate; nobody does at this.
const CREEP_FACTOR: f64 = 0.4;

/// A step in which one foot passes the other.
struct Step {
    /// From the moment when the feet were last beside each other, in frames.
    frames: f64,
    /// How far the feet come apart meanwhile, as a share of the figure's height.
    length: f64,
}

/// What the steps of a motion come to.
struct Gait {
    /// Steps per second.
    cadence: f64,
    /// The median length of a step, as a share of the figure's height.
    length: f64,
    /// How many times too fast the quarter of the steps plays that looks slowest, the median, and the
    /// quarter that looks fastest.
    factors: [f64; 3],
    step_count: usize,
    is_run: bool,
}

/// Steps that nobody takes at that speed, if the motion walks or runs.
pub(super) fn finding(
    global: &GlobalMotion,
    figure: &Figure,
    contacts: &FloorContacts,
    config: &CheckConfig,
) -> Option<Finding> {
    let gait = gait(global, figure, contacts)?;
    let [low, factor, high] = gait.factors;
    let (fastest, slowest) = if gait.is_run {
        (RUN_CADENCE_MAX, RUN_CADENCE_MIN)
    } else {
        (WALK_CADENCE_MAX, WALK_CADENCE_MIN)
    };
    let is_fast = low > config.playback_factor && gait.cadence > fastest;
    let is_slow = high < 1.0 / config.playback_factor && gait.cadence < slowest;
    if !is_fast && !is_slow {
        return None;
    }
    let may_be_meant = is_slow && !gait.is_run && factor > CREEP_FACTOR;
    Some(Finding {
        code: FindingCode::PlaybackSpeedImplausible,
        severity: if may_be_meant {
            Severity::Info
        } else {
            Severity::Warning
        },
        joints: Vec::new(),
        frames: Some(FrameRange {
            first: 0,
            last: global.frame_count() - 1,
        }),
        value: factor,
        unit: Unit::TimesTooFast,
        share_of_height: None,
        message: message(&gait, global.frame_time_secs()),
    })
}

fn message(gait: &Gait, frame_time_secs: f64) -> String {
    let factor = gait.factors[1];
    let length_metres = gait.length * STATURE_METRES;
    let what = if gait.is_run { "runs" } else { "walks" };
    let how = if factor > 1.0 { "fast" } else { "slow" };
    format!(
        "the motion plays about {:.1} times too {how}: it {what} with {:.1} steps a second that are \
         {length_metres:.2} m long if it stands {STATURE_METRES} m tall ({} steps measured), and people \
         take {:.1} such steps a second; {:.0} frames a second may be meant",
        factor.max(1.0 / factor),
        gait.cadence,
        gait.step_count,
        length_metres / WALK_RATIO,
        1.0 / (frame_time_secs * factor)
    )
}

/// Measures the gait of a figure with two legs; `None` when it takes no even, long steps.
fn gait(global: &GlobalMotion, figure: &Figure, contacts: &FloorContacts) -> Option<Gait> {
    let steps = steps(&feet_apart(global, figure)?);
    let mut times: Vec<f64> = steps.iter().map(|step| step.frames).collect();
    let time = median(&mut times);
    let mut lengths: Vec<f64> = steps.iter().map(|step| step.length).collect();
    let length = median(&mut lengths);
    for value in &mut times {
        *value = (*value - time).abs();
    }
    let is_even = median(&mut times) <= UNEVENNESS_MAX * time;
    if steps.len() < STEPS_MIN || !is_even || length < STEP_HEIGHTS_MIN {
        return None;
    }
    let mut factors: Vec<f64> = steps
        .iter()
        .map(|step| {
            let secs = step.frames * global.frame_time_secs();
            WALK_RATIO / (step.length * STATURE_METRES * secs)
        })
        .collect();
    factors.sort_unstable_by(f64::total_cmp);
    let at = |quarter: usize| factors[quarter * (factors.len() - 1) / 4];
    Some(Gait {
        cadence: 1.0 / (time * global.frame_time_secs()),
        length,
        factors: [at(1), at(2), at(3)],
        step_count: steps.len(),
        is_run: flight_share(figure, contacts) >= RUN_FLIGHT_SHARE,
    })
}

/// How far the first foot is ahead of the second along the way that the hips face, in each frame, as
/// a share of the figure's height. `None` unless the figure has two feet below two hips.
fn feet_apart(global: &GlobalMotion, figure: &Figure) -> Option<Vec<f64>> {
    let [first, second] = figure.feet.as_slice() else {
        return None;
    };
    let (first, second) = (first.base(), second.base());
    let hips = hips(global, figure, first, second)?;
    let apart = (0..global.frame_count()).map(|frame| {
        let at = |joint| global.position(frame, joint).as_dvec3();
        let across = at(hips.0) - at(hips.1);
        let across_length = libm::hypot(across.x, across.z);
        let between = at(first) - at(second);
        if across_length > 0.0 {
            (between.x * across.z - between.z * across.x) / (across_length * figure.height)
        } else {
            0.0
        }
    });
    Some(apart.collect())
}

/// The joints that the two legs begin with: the first pair below their common ancestor that is apart.
fn hips(
    global: &GlobalMotion,
    figure: &Figure,
    first: JointId,
    second: JointId,
) -> Option<(JointId, JointId)> {
    let skeleton = global.skeleton();
    let frames: Vec<usize> = super::figure::sample_frames(global.frame_count()).collect();
    let apart = |a, b| {
        let mut distances: Vec<f64> = frames
            .iter()
            .map(|&frame| {
                f64::from(
                    global
                        .position(frame, a)
                        .distance(global.position(frame, b)),
                )
            })
            .collect();
        median(&mut distances)
    };
    from_root(skeleton, first)
        .into_iter()
        .zip(from_root(skeleton, second))
        .filter(|(a, b)| a != b)
        .find(|&(a, b)| apart(a, b) > HIPS_APART_HEIGHTS * figure.height)
}

/// The joints from the root down to a joint.
fn from_root(skeleton: &Skeleton, joint: JointId) -> Vec<JointId> {
    let mut joints = vec![joint];
    joints.extend(skeleton.ancestors(joint));
    joints.reverse();
    joints
}

/// The steps between the moments when the feet pass each other; the parts before the first and
/// after the last of these are not whole.
fn steps(apart: &[f64]) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut ahead = 0.0_f64;
    let mut passed: Option<f64> = None;
    let mut length = 0.0_f64;
    for (frame, &distance) in apart.iter().enumerate() {
        if distance.abs() > AHEAD_HEIGHTS && distance * ahead <= 0.0 {
            if ahead != 0.0 {
                let moment = zero_before(apart, frame);
                if let Some(last) = passed {
                    steps.push(Step {
                        frames: moment - last,
                        length,
                    });
                }
                passed = Some(moment);
            }
            ahead = distance;
            length = 0.0;
        }
        length = length.max(distance.abs());
    }
    steps
}

/// The moment before a frame at which the distance was last 0, in frames and parts of one. There is a
/// frame with another sign before this one.
fn zero_before(apart: &[f64], frame: usize) -> f64 {
    let mut after = frame;
    while after > 1 && apart[after - 1] * apart[frame] > 0.0 {
        after -= 1;
    }
    let (before, here) = (apart[after - 1], apart[after]);
    after as f64 - here / (here - before)
}

/// The share of frames in which all feet are well above the floor.
fn flight_share(figure: &Figure, contacts: &FloorContacts) -> f64 {
    let limit = contacts.floor + FLIGHT_HEIGHTS * figure.height;
    let frame_count = contacts.lowest[0].len();
    let flying = (0..frame_count)
        .filter(|&frame| contacts.lowest.iter().all(|foot| foot[frame] > limit))
        .count();
    flying as f64 / frame_count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_a_step_every_half_period() {
        let apart: Vec<f64> = (0..100)
            .map(|frame| 0.4 * libm::sin(std::f64::consts::TAU * (f64::from(frame) + 3.3) / 30.0))
            .collect();
        let steps = steps(&apart);
        assert_eq!(steps.len(), 5);
        for step in &steps {
            assert!((step.frames - 15.0).abs() < 0.02, "{}", step.frames);
            assert!((step.length - 0.4).abs() < 0.003, "{}", step.length);
        }
    }

    #[test]
    fn trembling_about_the_middle_is_no_step() {
        assert!(steps(&[0.05, -0.05, 0.09, -0.09, 0.0, 0.05]).is_empty());
        assert!(steps(&[]).is_empty());
    }

    #[test]
    fn a_foot_that_rests_beside_the_other_passes_it_once() {
        let steps = steps(&[-0.3, 0.0, 0.3, 0.0, 0.0, -0.3, 0.3]);
        assert_eq!(steps.len(), 2);
        assert!(steps.iter().all(|step| step.frames > 0.0));
    }
}
