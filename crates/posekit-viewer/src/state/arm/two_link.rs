//! The planar arm's formula with its numbers filled in, and both of its solutions.

use glam::DVec2;
use posekit::ik::robot::TwoLinkSolutions;

use super::planar::PlanarArm;
use super::robot::Robot;
use crate::state::readout::fixed;

/// One way to reach where the tip is, or should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elbow {
    /// `t1` and `t2`, radians.
    pub angles: [f64; 2],
    /// Whether both are in the ranges of their joints.
    pub is_allowed: bool,
    /// Whether the arm stands so.
    pub is_taken: bool,
}

/// What the formula says of the planar arm where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoLinkReadout {
    /// Where the tip is in the plane.
    pub tip: DVec2,
    /// The line of `x`: the formula, with numbers, its terms, its sum.
    pub x: Vec<String>,
    /// The line of `y`.
    pub y: Vec<String>,
    /// What was asked for: where the target is in the plane, or the tip without one.
    pub target: DVec2,
    /// The cosine law with numbers: how `t2` is found from the target.
    pub bend: Vec<String>,
    /// How `t1` is found, for the first of the solutions.
    pub lift: Vec<String>,
    /// The solutions for the target: two, one at a singularity, none out of reach.
    pub elbows: Vec<Elbow>,
    /// How far the target is out of reach.
    pub beyond: Option<f64>,
}

/// Angles nearer than this are the same, radians.
const SAME_RAD: f64 = 1e-4;

/// What the formula says.
#[must_use]
pub fn two_link(robot: &Robot, arm: &PlanarArm, values: &[f64], target: DVec2) -> TwoLinkReadout {
    let [t1, t2] = arm.angles(values);
    let (l1, l2) = (arm.links.upper, arm.links.fore);
    let tip = arm.links.tip(t1, t2);
    let line = |name: &str, function: &str, of: fn(f64) -> f64, sum: f64| {
        let (first, second) = (t1, t1 + t2);
        vec![
            format!("{name} = l1 {function} t1 + l2 {function}(t1 + t2)"),
            format!(
                "= {} {function} {} + {} {function} {}",
                length(l1),
                degrees(first),
                length(l2),
                degrees(second)
            ),
            format!("= {}", added(l1 * of(first), l2 * of(second))),
            format!("= {}", length(sum)),
        ]
    };
    let solutions = arm.links.solve(target);
    let elbows = elbows(robot, arm, [t1, t2], solutions);
    let distance_squared = target.length_squared();
    let cos = (distance_squared - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
    let bend = vec![
        "cos t2 = (x\u{b2} + y\u{b2} - l1\u{b2} - l2\u{b2}) / (2 l1 l2)".to_owned(),
        format!(
            "= ({} - {} - {}) / {}",
            length(distance_squared),
            length(l1 * l1),
            length(l2 * l2),
            length(2.0 * l1 * l2)
        ),
        match solutions {
            TwoLinkSolutions::OutOfReach { .. } => {
                format!("= {}, no angle has that cosine", length(cos))
            }
            _ => format!(
                "= {}, t2 = \u{b1}{}",
                length(cos),
                degrees(libm::acos(cos.clamp(-1.0, 1.0)))
            ),
        },
    ];
    let lift = elbows.first().map_or_else(Vec::new, |elbow| {
        let [up, bent] = elbow.angles;
        let direction = libm::atan2(target.y, target.x);
        let inner = libm::atan2(l2 * libm::sin(bent), l1 + l2 * libm::cos(bent));
        vec![
            "t1 = atan2(y, x) - atan2(l2 sin t2, l1 + l2 cos t2)".to_owned(),
            format!(
                "= {} - {} = {}",
                degrees(direction),
                in_brackets(inner),
                degrees(up)
            ),
        ]
    });
    TwoLinkReadout {
        tip,
        x: line("x", "cos", libm::cos, tip.x),
        y: line("y", "sin", libm::sin, tip.y),
        target,
        bend,
        lift,
        elbows,
        beyond: match solutions {
            TwoLinkSolutions::OutOfReach { by, .. } => Some(by),
            _ => None,
        },
    }
}

fn elbows(
    robot: &Robot,
    arm: &PlanarArm,
    now: [f64; 2],
    solutions: TwoLinkSolutions,
) -> Vec<Elbow> {
    let found: Vec<[f64; 2]> = match solutions {
        TwoLinkSolutions::Two(both) => both.to_vec(),
        TwoLinkSolutions::One(one) => vec![one],
        TwoLinkSolutions::AnyDirection => vec![[now[0], core::f64::consts::PI]],
        TwoLinkSolutions::OutOfReach { .. } => Vec::new(),
    };
    let of = |angles: [f64; 2]| {
        let ranges = arm.values.map(|index| robot.ranges[index]);
        Elbow {
            angles,
            is_allowed: (0..2).all(|i| ranges[i].contains(angles[i])),
            is_taken: (0..2).all(|i| is_same_angle(angles[i], now[i])),
        }
    };
    found.into_iter().map(of).collect()
}

/// Whether two angles differ by whole turns only.
fn is_same_angle(a: f64, b: f64) -> bool {
    use core::f64::consts::TAU;
    let gap = (a - b).rem_euclid(TAU);
    gap.min(TAU - gap) < SAME_RAD
}

fn length(value: f64) -> String {
    fixed(value, 3)
}

fn degrees(angle_rad: f64) -> String {
    format!("{}\u{b0}", fixed(angle_rad.to_degrees(), 1))
}

fn in_brackets(angle_rad: f64) -> String {
    let text = degrees(angle_rad);
    if text.starts_with('-') {
        format!("({text})")
    } else {
        text
    }
}

/// A sum as it is written: `0.433 - 0.104`.
fn added(first: f64, second: f64) -> String {
    let text = length(second);
    match text.strip_prefix('-') {
        Some(size) => format!("{} - {size}", length(first)),
        None => format!("{} + {text}", length(first)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planar() -> (Robot, PlanarArm) {
        let robot = Robot::sample("planar2").expect("one of ours");
        let arm = robot.planar.expect("it is a planar arm of two links");
        (robot, arm)
    }

    #[test]
    fn the_sample_is_recognised_where_it_stands() {
        let (robot, arm) = planar();
        assert!((arm.links.upper - 0.5).abs() < 1e-12 && (arm.links.fore - 0.4).abs() < 1e-12);
        for values in [[0.0, 0.0], [0.4, 0.9], [-2.0, 1.3]] {
            let frame = robot.mechanism.global_frames(&values)[arm.tip.index()];
            let [t1, t2] = arm.angles(&values);
            let there = arm.in_world(arm.links.tip(t1, t2));
            assert!(frame.position.distance(there) < 1e-12, "{values:?}");
        }
        for name in ["arm6", "arm7"] {
            assert!(Robot::sample(name).expect("ours").planar.is_none());
        }
    }

    #[test]
    fn the_formula_is_forward_kinematics_with_numbers() {
        let (robot, arm) = planar();
        let values = [-40f64.to_radians(), 130f64.to_radians()];
        let tip = arm.links.tip(values[0], values[1]);
        let read = two_link(&robot, &arm, &values, tip);
        assert_eq!(read.x[1], "= 0.500 cos -40.0\u{b0} + 0.400 cos 90.0\u{b0}");
        assert_eq!(read.x[2], "= 0.383 + 0.000");
        assert_eq!(read.y[2], "= -0.321 + 0.400");
        let frame = robot.mechanism.global_frames(&values)[arm.tip.index()];
        let in_plane = arm.in_plane(frame.position);
        for (line, value) in [(&read.x, in_plane.x), (&read.y, in_plane.y)] {
            let shown: f64 = line[3].trim_start_matches("= ").parse().expect("a number");
            assert!((shown - value).abs() <= 0.000_5 + 1e-12, "{shown} {value}");
        }
    }

    #[test]
    fn both_elbows_reach_and_one_is_taken() {
        let (robot, arm) = planar();
        let values = [0.4, 0.9];
        let tip = arm.links.tip(0.4, 0.9);
        let read = two_link(&robot, &arm, &values, tip);
        assert_eq!(read.elbows.len(), 2);
        for elbow in &read.elbows {
            let [t1, t2] = elbow.angles;
            assert!(arm.links.tip(t1, t2).distance(tip) < 1e-12);
        }
        let taken: Vec<bool> = read.elbows.iter().map(|elbow| elbow.is_taken).collect();
        assert_eq!(taken, [true, false]);
        let far = two_link(&robot, &arm, &values, DVec2::new(2.0, 0.0));
        assert!(far.elbows.is_empty());
        assert!((far.beyond.expect("out of reach") - 1.1).abs() < 1e-12);
    }

    #[test]
    fn a_bend_beyond_its_range_is_not_allowed() {
        let (robot, arm) = planar();
        // The elbow's range ends at 2.8 rad.
        let tip = arm.links.tip(0.0, 3.0);
        let read = two_link(&robot, &arm, &[0.0, 0.0], tip);
        assert!(read.elbows.iter().all(|elbow| !elbow.is_allowed));
    }
}
