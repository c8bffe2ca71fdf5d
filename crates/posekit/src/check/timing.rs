//! Frame times that cannot be, and motions that obey gravity or gait at another speed only.
//!
//! Gravity: while no foot is near the floor, the middle of the body falls freely, and a parabola
//! fitted to its height has the acceleration of gravity. A figure that stands as tall as a grown-up
//! ([`STATURE_METRES`]) tells how long a metre is. Where nothing flies, the gait is asked: see [`gait`].
//! Both tell a factor of two; neither tells less, and neither is reported for less than
//! [`PLAYBACK_FACTOR`](super::config::PLAYBACK_FACTOR).

use super::statistics::median;
use super::{
    CheckConfig, Figure, Finding, FindingCode, FloorContacts, FrameRange, Severity, Unit, gait,
};
use crate::motion::{GlobalMotion, Motion};

/// How tall a figure is taken to be, in metres.
pub(super) const STATURE_METRES: f64 = 1.7;

/// Standard gravity, in metres per second squared.
const GRAVITY: f64 = 9.80665;

/// All feet must be this far above the floor in a flight, as a share of the figure's height.
pub(super) const FLIGHT_HEIGHTS: f64 = 0.04;

/// A flight needs this many frames for a parabola that means something.
const FLIGHT_FRAMES_MIN: usize = 7;

/// How far the body may be from the parabola, as a share of the parabola's own sag: more is no free
/// flight.
const FLIGHT_MISFIT: f64 = 0.08;

/// The parabola's sag must be at least this share of the height: flatter ones drown in noise.
const FLIGHT_SAG_HEIGHTS: f64 = 0.01;

/// Frame times of at least this look like a number of frames per second, in seconds.
const FPS_LIKE_SECS: f64 = 10.0;

pub(super) fn check_frame_time(motion: &Motion, config: &CheckConfig, findings: &mut Vec<Finding>) {
    let secs = motion.frame_time_secs();
    let (shortest, longest) = config.frame_time_range_secs;
    if motion.frame_count() < 2 || (shortest..=longest).contains(&secs) {
        return;
    }
    let (severity, message) = if secs <= 0.0 {
        let message = "the frame time is 0: all frames happen at once".to_owned();
        (Severity::Error, message)
    } else if secs >= FPS_LIKE_SECS {
        let message = format!(
            "the frame time is {secs} seconds; {secs} frames per second, a frame time of {:.6}, may be \
             meant",
            1.0 / secs
        );
        (Severity::Warning, message)
    } else {
        let message = format!(
            "the frame time is {secs} seconds: {} frames a second",
            (1e6 / secs).round() / 1e6
        );
        (Severity::Warning, message)
    };
    findings.push(Finding {
        code: FindingCode::FrameTimeImplausible,
        severity,
        joints: Vec::new(),
        frames: None,
        value: secs,
        unit: Unit::Seconds,
        share_of_height: None,
        message,
    });
}

pub(super) fn check_playback(
    global: &GlobalMotion,
    figure: &Figure,
    contacts: &FloorContacts,
    config: &CheckConfig,
    findings: &mut Vec<Finding>,
) {
    let (shortest, longest) = config.frame_time_range_secs;
    if !(shortest..=longest).contains(&global.frame_time_secs()) {
        return;
    }
    if let Some(finding) = flight_finding(global, figure, contacts, config) {
        findings.push(finding);
    } else {
        findings.extend(gait::finding(global, figure, contacts, config));
    }
}

fn flight_finding(
    global: &GlobalMotion,
    figure: &Figure,
    contacts: &FloorContacts,
    config: &CheckConfig,
) -> Option<Finding> {
    let gravity = GRAVITY / STATURE_METRES * figure.height;
    let flights = flights(global, figure, contacts);
    let mut fits: Vec<(FrameRange, f64)> = Vec::new();
    for frames in flights {
        let heights: Vec<f64> = (frames.first..=frames.last)
            .map(|frame| body_height(global, figure, frame))
            .collect();
        let acceleration = free_fall(&heights, global.frame_time_secs(), figure.height);
        fits.extend(acceleration.map(|fall| (frames, libm::sqrt(fall / gravity))));
    }
    let mut factors: Vec<f64> = fits.iter().map(|fit| fit.1).collect();
    let factor = median(&mut factors);
    let doubted =
        |factor: f64| factor > config.playback_factor || factor < 1.0 / config.playback_factor;
    if fits.is_empty() || !fits.iter().all(|fit| doubted(fit.1)) {
        return None;
    }
    let faster_or_slower = if factor > 1.0 { "fast" } else { "slow" };
    let times = factor.max(1.0 / factor);
    Some(Finding {
        code: FindingCode::PlaybackSpeedImplausible,
        severity: Severity::Warning,
        joints: Vec::new(),
        frames: Some(FrameRange {
            first: fits[0].0.first,
            last: fits[fits.len() - 1].0.last,
        }),
        value: factor,
        unit: Unit::TimesTooFast,
        share_of_height: None,
        message: format!(
            "the motion plays about {times:.1} times too {faster_or_slower}: in {} jumps or strides the \
             body falls with {:.1} m/s2 instead of 9.8, if it stands {STATURE_METRES} m tall; \
             {:.0} frames a second may be meant",
            fits.len(),
            GRAVITY * factor * factor,
            1.0 / (global.frame_time_secs() * factor)
        ),
    })
}

/// Runs of frames in which all feet are well above the floor.
fn flights(global: &GlobalMotion, figure: &Figure, contacts: &FloorContacts) -> Vec<FrameRange> {
    let limit = contacts.floor + FLIGHT_HEIGHTS * figure.height;
    let flies = |frame: usize| contacts.lowest.iter().all(|foot| foot[frame] > limit);
    let mut flights = Vec::new();
    let mut frame = 0;
    while frame < global.frame_count() {
        let first = frame;
        while frame < global.frame_count() && flies(frame) {
            frame += 1;
        }
        let is_whole = first > 0 && frame < global.frame_count();
        if is_whole && frame - first >= FLIGHT_FRAMES_MIN {
            flights.push(FrameRange {
                first,
                last: frame - 1,
            });
        }
        frame = frame.max(first + 1);
    }
    flights
}

/// The mean height of the figure's joints: near enough to its centre of mass.
fn body_height(global: &GlobalMotion, figure: &Figure, frame: usize) -> f64 {
    let mut sum = 0.0;
    let mut count = 0.0;
    for joint in global.skeleton().subtree(figure.root) {
        sum += f64::from(global.position(frame, joint).y);
        count += 1.0;
    }
    sum / count
}

/// The downward acceleration of a parabola fitted to heights by least squares; `None` when they are
/// none, or it is too flat.
fn free_fall(heights: &[f64], frame_time_secs: f64, figure_height: f64) -> Option<f64> {
    let count = heights.len() as f64;
    let half = 0.5 * (count - 1.0);
    let times = |index: usize| (index as f64 - half) / half;
    let mean = |value: &dyn Fn(f64, f64) -> f64| {
        let sum: f64 = heights
            .iter()
            .enumerate()
            .map(|(i, &y)| value(times(i), y))
            .sum();
        sum / count
    };
    // With times symmetric about 0 the odd moments vanish and the fit needs no elimination.
    let (t2, t4) = (mean(&|t, _| t * t), mean(&|t, _| t * t * t * t));
    let (y0, y1, y2) = (
        mean(&|_, y| y),
        mean(&|t, y| t * y),
        mean(&|t, y| t * t * y),
    );
    let curvature = (y2 - t2 * y0) / (t4 - t2 * t2);
    let slope = y1 / t2;
    let base = y0 - curvature * t2;
    let misfit = mean(&|t, y| {
        let error = y - (base + slope * t + curvature * t * t);
        error * error
    });
    let sag = -curvature;
    let is_flight =
        sag > FLIGHT_SAG_HEIGHTS * figure_height && libm::sqrt(misfit) < FLIGHT_MISFIT * sag;
    let half_secs = half * frame_time_secs;
    is_flight.then(|| 2.0 * sag / (half_secs * half_secs))
}
