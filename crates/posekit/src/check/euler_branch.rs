//! Which of the many Euler angles of one rotation a channel curve is on, and following it.
//!
//! Angles in degrees make the same rotation when a full turn is added to any of them, and, for three
//! of them, when the first and the last are turned by 180 degrees and the middle one is reflected:
//! `(a, b, c)` and `(a + 180, 180 - b, c + 180)` for three different axes, `(a + 180, -b, c + 180)`
//! when the last axis is the first again (Diebel 2006, "Representing Attitude"). A curve that hops
//! between them flips: each frame is right, what lies between two of them is not.
//!
//! An [`EulerTracker`] follows a joint frame by frame. As long as the angles go on, the branch stays
//! and nothing changes; when they jump, it takes the nearest equivalent angles.

use super::CheckConfig;
use crate::rotation::Axis;

/// Where a curve of Euler angles is among the equivalent ones; the default is what the file says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EulerBranch {
    /// Whether it is the other solution of three angles.
    is_other_solution: bool,
    /// Full turns added to each angle.
    turns: [i32; 3],
}

/// Angles get rounded to this many parts of a degree when they are moved to another branch, so
/// that a value with a few decimals keeps a few decimals. A file's rounding is far coarser.
const PARTS_OF_A_DEGREE: f64 = 1e9;

impl EulerBranch {
    /// True for the branch that changes nothing.
    pub fn is_identity(&self) -> bool {
        *self == Self::default()
    }

    /// Equivalent angles on this branch, in degrees.
    fn apply(&self, kind: OtherSolution, angles: [f64; 3]) -> [f64; 3] {
        if self.is_identity() {
            return angles;
        }
        let mut moved = if self.is_other_solution {
            kind.of(angles)
        } else {
            angles
        };
        for ((angle, turns), given) in moved.iter_mut().zip(self.turns).zip(angles) {
            *angle += 360.0 * f64::from(turns);
            // An angle that stays keeps its value to the bit.
            if angle.to_bits() != given.to_bits() {
                *angle = round_angle(*angle);
            }
        }
        moved
    }
}

fn round_angle(angle: f64) -> f64 {
    let scaled = angle * PARTS_OF_A_DEGREE;
    if scaled.abs() < 9.0e15 {
        scaled.round() / PARTS_OF_A_DEGREE
    } else {
        angle
    }
}

/// What the other solution of a joint's angles is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OtherSolution {
    /// One or two channels, or the same axis twice running.
    None,
    /// Three different axes.
    ThreeAxes,
    /// The last axis is the first.
    TwoAxes,
}

impl OtherSolution {
    fn of_axes(axes: &[Axis]) -> Self {
        match *axes {
            [a, b, c] if a != b && b != c && a != c => Self::ThreeAxes,
            [a, b, c] if a != b && a == c => Self::TwoAxes,
            _ => Self::None,
        }
    }

    fn of(self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::None => [a, b, c],
            Self::ThreeAxes => [a + 180.0, 180.0 - b, c + 180.0],
            Self::TwoAxes => [a + 180.0, -b, c + 180.0],
        }
    }
}

/// How the angles went on from the frame before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EulerStep {
    /// On the same branch.
    Continued,
    /// The file's angles jump, to other angles of nearly the same rotation.
    Flipped {
        /// The largest change of a channel, in degrees.
        jump_deg: f64,
    },
    /// A channel changes a lot and no equivalent angles are much nearer: the joint turns fast, or is
    /// near gimbal lock.
    Raced {
        /// The largest change of a channel, in degrees.
        jump_deg: f64,
    },
}

/// Follows the Euler angles of one joint.
#[derive(Clone, Debug)]
pub struct EulerTracker {
    count: usize,
    other: OtherSolution,
    branch: EulerBranch,
    continuous: Option<[f64; 3]>,
    flip_angle_deg: f64,
    flip_gain: f64,
}

impl EulerTracker {
    /// A tracker of a joint whose rotation channels turn about these axes, in that order. `None`
    /// when they are none or more than three.
    pub fn new(axes: &[Axis], config: &CheckConfig) -> Option<Self> {
        (1..=3).contains(&axes.len()).then(|| Self {
            count: axes.len(),
            other: OtherSolution::of_axes(axes),
            branch: EulerBranch::default(),
            continuous: None,
            flip_angle_deg: config.flip_angle_deg,
            flip_gain: config.flip_gain,
        })
    }

    /// Goes on to the next frame, whose angles are given in degrees; those after the joint's
    /// channels are 0.
    pub fn advance(&mut self, angles_deg: [f64; 3]) -> EulerStep {
        let same_branch = self.branch.apply(self.other, angles_deg);
        let Some(before) = self.continuous else {
            self.continuous = Some(same_branch);
            return EulerStep::Continued;
        };
        let jump_deg = largest_change(before, same_branch);
        if jump_deg <= self.flip_angle_deg {
            self.continuous = Some(same_branch);
            return EulerStep::Continued;
        }
        let (branch, nearest) = self.nearest_branch(before, angles_deg);
        if largest_change(before, nearest) * self.flip_gain < jump_deg {
            self.branch = branch;
            self.continuous = Some(nearest);
            EulerStep::Flipped { jump_deg }
        } else {
            self.continuous = Some(same_branch);
            EulerStep::Raced { jump_deg }
        }
    }

    /// The branch that the curve is on now.
    pub fn branch(&self) -> EulerBranch {
        self.branch
    }

    /// The angles of the last frame on the branch that continues the frames before it, in degrees:
    /// the file's to the bit where the branch is the file's.
    pub fn continuous_deg(&self) -> [f64; 3] {
        self.continuous.unwrap_or_default()
    }

    fn nearest_branch(&self, before: [f64; 3], angles_deg: [f64; 3]) -> (EulerBranch, [f64; 3]) {
        let same = self.with_nearest_turns(false, before, angles_deg);
        if self.other == OtherSolution::None {
            return same;
        }
        let other = self.with_nearest_turns(true, before, angles_deg);
        if largest_change(before, other.1) < largest_change(before, same.1) {
            other
        } else {
            same
        }
    }

    fn with_nearest_turns(
        &self,
        is_other_solution: bool,
        before: [f64; 3],
        angles_deg: [f64; 3],
    ) -> (EulerBranch, [f64; 3]) {
        let solution = if is_other_solution {
            self.other.of(angles_deg)
        } else {
            angles_deg
        };
        let mut turns = [0; 3];
        for index in 0..self.count {
            turns[index] = nearest_turns(before[index] - solution[index]);
        }
        let branch = EulerBranch {
            is_other_solution,
            turns,
        };
        (branch, branch.apply(self.other, angles_deg))
    }
}

/// How many full turns bring an angle nearest to another; 0 where it would be absurdly many.
#[allow(
    clippy::cast_possible_truncation,
    reason = "a cast from float to integer saturates"
)]
fn nearest_turns(difference_deg: f64) -> i32 {
    (difference_deg / 360.0).round() as i32
}

fn largest_change(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    const ZXY: [Axis; 3] = [Axis::Z, Axis::X, Axis::Y];

    fn tracker(axes: &[Axis]) -> EulerTracker {
        EulerTracker::new(axes, &CheckConfig::default()).expect("one to three axes")
    }

    fn rotation(axes: &[Axis], angles_deg: [f64; 3]) -> DQuat {
        axes.iter()
            .zip(angles_deg)
            .fold(DQuat::IDENTITY, |q, (axis, angle)| {
                q * DQuat::from_axis_angle(axis.unit(), angle.to_radians())
            })
    }

    fn assert_same_rotation(axes: &[Axis], a: [f64; 3], b: [f64; 3]) {
        let (a, b) = (rotation(axes, a), rotation(axes, b));
        assert!(a.dot(b).abs() > 1.0 - 1e-12, "{a} is not {b}");
    }

    #[test]
    fn both_solutions_are_the_same_rotation() {
        let angles = [12.0, -77.0, 140.0];
        for axes in [
            ZXY,
            [Axis::X, Axis::Y, Axis::X],
            [Axis::Y, Axis::X, Axis::Z],
        ] {
            let other = OtherSolution::of_axes(&axes).of(angles);
            assert_same_rotation(&axes, angles, other);
        }
    }

    #[test]
    fn a_wrap_is_followed_and_taken_back() {
        let mut tracker = tracker(&ZXY);
        assert_eq!(tracker.advance([179.5, 0.0, 0.0]), EulerStep::Continued);
        assert_eq!(
            tracker.advance([-179.5, 0.0, 0.0]),
            EulerStep::Flipped { jump_deg: 359.0 }
        );
        assert_eq!(tracker.continuous_deg(), [180.5, 0.0, 0.0]);
        assert_eq!(tracker.advance([-178.25, 0.0, 0.0]), EulerStep::Continued);
        assert_eq!(tracker.continuous_deg(), [181.75, 0.0, 0.0]);
        assert!(matches!(
            tracker.advance([178.0, 0.0, 0.0]),
            EulerStep::Flipped { .. }
        ));
        assert!(tracker.branch().is_identity());
    }

    #[test]
    fn the_other_solution_is_followed() {
        let mut tracker = tracker(&ZXY);
        tracker.advance([10.0, 80.0, 20.0]);
        let flipped = OtherSolution::ThreeAxes.of([11.0, 82.0, 21.0]);
        assert!(matches!(
            tracker.advance(flipped),
            EulerStep::Flipped { .. }
        ));
        assert_eq!(tracker.continuous_deg(), [11.0, 82.0, 21.0]);
    }

    #[test]
    fn a_fast_turn_is_no_flip() {
        let mut tracker = tracker(&ZXY);
        tracker.advance([0.0; 3]);
        assert_eq!(
            tracker.advance([100.0, 0.0, 0.0]),
            EulerStep::Raced { jump_deg: 100.0 }
        );
        assert!(tracker.branch().is_identity());
    }

    #[test]
    fn decimals_stay_short_on_another_branch() {
        let mut tracker = tracker(&[Axis::X]);
        tracker.advance([179.9, 0.0, 0.0]);
        tracker.advance([-179.873, 0.0, 0.0]);
        assert_eq!(tracker.continuous_deg()[0].to_string(), "180.127");
    }
}
