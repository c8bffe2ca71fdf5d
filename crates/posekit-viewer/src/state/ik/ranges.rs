//! Limits of joints that are measured from a motion: what it does, and something more, but no limb bends
//! to the side that it never bends to.
//!
//! **Method.** The rotations of a joint in all frames are told as Euler angles in the order that keeps them
//! in the smallest ranges, away from gimbal lock; the ranges are widened by [`WIDER_DEG`] on both sides. A
//! knee or an elbow is widened by less: its other angles by [`ASIDE_DEG`], the one that bends it until it is
//! bent by [`MOST_BEND_DEG`], and by [`STRAIGHT_DEG`] towards straight.

use core::f64::consts::TAU;

use glam::DQuat;
use posekit::body::Anatomy;
use posekit::ik::{Interval, JointLimit, JointLimits};
use posekit::motion::{GlobalMotion, Motion};
use posekit::rotation::EulerOrder;
use posekit::skeleton::JointId;

/// How much farther than in the motion joints may turn.
const WIDER_DEG: f64 = 90.0;

/// How far knees and elbows may bend, whatever they do in the motion: a person's go about so far.
const MOST_BEND_DEG: f64 = 150.0;

/// The same, of a knee or an elbow about the axes that do not bend it.
const ASIDE_DEG: f64 = 20.0;

/// The same, towards a straight limb.
const STRAIGHT_DEG: f64 = 3.0;

/// A limb that bends less than this in all of a motion does not tell to which side it bends.
const LEAST_BEND_DEG: f64 = 8.0;

/// A middle angle farther out than this is near gimbal lock.
const MOST_MIDDLE_DEG: f64 = 80.0;

/// Joints that are no knee and no elbow are looked at in so many frames.
const LOOKED_AT: usize = 400;

const ORDERS: [EulerOrder; 6] = [
    EulerOrder::XYZ,
    EulerOrder::XZY,
    EulerOrder::YXZ,
    EulerOrder::YZX,
    EulerOrder::ZXY,
    EulerOrder::ZYX,
];

/// Angles of a joint over frames, in an order that suits them.
struct Measured {
    order: EulerOrder,
    angles_rad: Vec<[f64; 3]>,
    ranges: [Interval; 3],
}

/// The limits within a motion: those given, and where they leave a joint free, what the motion does.
#[must_use]
pub fn ranges_within(motion: &Motion, global: &GlobalMotion, given: &JointLimits) -> JointLimits {
    let mut limits = given.clone();
    let skeleton = motion.skeleton();
    let anatomy = Anatomy::of_motion(motion).ok();
    for joint in skeleton.joints() {
        let is_free = matches!(given.limit(joint), JointLimit::Free);
        if !is_free || skeleton.parent(joint).is_none() || skeleton.is_end_site(joint) {
            continue;
        }
        let limb = anatomy
            .iter()
            .flat_map(Anatomy::limbs)
            .find(|limb| limb.middle == joint);
        let step = match limb {
            Some(_) => 1,
            None => motion.frame_count().div_ceil(LOOKED_AT).max(1),
        };
        let frames: Vec<usize> = (0..motion.frame_count()).step_by(step).collect();
        let Some(measured) = measured(motion, joint, &frames) else {
            continue;
        };
        let ranges = match limb {
            Some(limb) => {
                let ends = [limb.upper, limb.lower];
                let bends: Vec<f64> = frames
                    .iter()
                    .map(|&frame| bend(global, frame, joint, ends))
                    .collect();
                one_sided(&measured, &bends)
            }
            None => None,
        };
        let wider = WIDER_DEG.to_radians();
        let ranges = ranges.unwrap_or(measured.ranges.map(|range| widened(range, [wider; 2])));
        let limit = JointLimit::Euler {
            order: measured.order,
            angles_rad: ranges,
        };
        // Ranges of finite angles are never empty.
        limits.set_limit(joint, limit).ok();
    }
    limits
}

fn measured(motion: &Motion, joint: JointId, frames: &[usize]) -> Option<Measured> {
    let rest = motion.skeleton().rest_rotation(joint).as_dquat();
    let rotations: Vec<DQuat> = frames
        .iter()
        .map(|&frame| rest.inverse() * motion.rotation(frame, joint).as_dquat())
        .filter(|rotation| rotation.is_finite())
        .collect();
    if rotations.is_empty() {
        return None;
    }
    let in_order = |order: EulerOrder| {
        let mut before = [0.0; 3];
        let angles: Vec<[f64; 3]> = rotations
            .iter()
            .map(|&rotation| {
                before = order.from_quat_near(rotation, before).angles_rad;
                before
            })
            .collect();
        let ranges = [0, 1, 2].map(|k| {
            let of = angles.iter().map(|angles| angles[k]);
            Interval::new(
                of.clone().fold(f64::INFINITY, f64::min),
                of.fold(f64::NEG_INFINITY, f64::max),
            )
        });
        Measured {
            order,
            angles_rad: angles,
            ranges,
        }
    };
    let most = MOST_MIDDLE_DEG.to_radians();
    let is_sound = |it: &Measured| it.ranges[1].min > -most && it.ranges[1].max < most;
    ORDERS
        .into_iter()
        .map(in_order)
        .filter(is_sound)
        .min_by(|a, b| width(a).total_cmp(&width(b)))
}

fn width(measured: &Measured) -> f64 {
    measured
        .ranges
        .iter()
        .map(|range| range.max - range.min)
        .sum()
}

/// How far a limb is from straight at its middle joint, radians.
fn bend(global: &GlobalMotion, frame: usize, middle: JointId, [upper, lower]: [JointId; 2]) -> f64 {
    let at = |joint: JointId| global.position(frame, joint);
    let (above, below) = (at(middle) - at(upper), at(lower) - at(middle));
    f64::from(above.angle_between(below))
}

/// The ranges of a knee or an elbow; `None` where it does not tell to which side it bends.
fn one_sided(measured: &Measured, bends: &[f64]) -> Option<[Interval; 3]> {
    let most = bends.iter().copied().fold(0.0, f64::max);
    let least = bends.iter().copied().fold(f64::INFINITY, f64::min);
    if bends.len() != measured.angles_rad.len() || most - least < LEAST_BEND_DEG.to_radians() {
        return None;
    }
    let mean = bends.iter().sum::<f64>() / bends.len() as f64;
    // The angle that goes with the bend, and whether it grows or falls with it.
    let goes_with = |k: usize| {
        let pairs = measured.angles_rad.iter().zip(bends);
        pairs
            .map(|(angles, bend)| angles[k] * (bend - mean))
            .sum::<f64>()
    };
    let shares = [0, 1, 2].map(goes_with);
    let main = (0..3).max_by(|&a, &b| shares[a].abs().total_cmp(&shares[b].abs()))?;
    let [most_bend, aside, straight] =
        [MOST_BEND_DEG, ASIDE_DEG, STRAIGHT_DEG].map(f64::to_radians);
    let wider = (most_bend - most).max(straight);
    Some([0, 1, 2].map(|k| {
        let margins = match (k == main, shares[k] > 0.0) {
            (false, _) => [aside; 2],
            (true, true) => [straight, wider],
            (true, false) => [wider, straight],
        };
        widened(measured.ranges[k], margins)
    }))
}

fn widened(range: Interval, [below, above]: [f64; 2]) -> Interval {
    let wide = Interval::new(range.min - below, range.max + above);
    if wide.max - wide.min < TAU {
        wide
    } else {
        Interval::ALL
    }
}
