//! How well the tip can move from where it stands: singular values, manipulability, and what a
//! singularity takes away.
//!
//! Yoshikawa 1985, "Manipulability of Robotic Mechanisms". A planar arm is measured in its plane; an arm
//! whose tip is moved by six values or more by all six ways of moving and turning, where a radian counts
//! as [`Mobility::radian_length`]; one of fewer by where its tip may go. What an arm of few values could
//! never do is not held against it: there are as many singular values as the smaller number says.

use glam::DVec3;
use posekit::ik::robot::{Dexterity, Task, TipJacobian, jacobian};
use posekit::mechanism::{Frame, Freedom};
use posekit::skeleton::JointId;

use super::robot::Robot;

/// A radian counts as this share of the robot's reach: about a hand's length of an arm.
const RADIAN_SHARE: f64 = 0.25;

/// Under these ratios of the least singular value to the largest an arm is near a singularity, and at
/// one. A planar arm of two equal links is near when its elbow is within some ten degrees of straight.
const NEAR: f64 = 0.04;
const AT: f64 = 0.004;

/// Axes are in line when their directions differ by less than this sine, and when they pass each other
/// within this share of the reach.
const IN_LINE_SINE: f64 = 0.03;
const IN_LINE_SHARE: f64 = 0.01;

/// How near to a singularity an arm is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Singularity {
    /// Not near to one.
    Far,
    /// Near to one: some ways of moving need fast joints.
    Near,
    /// At one: some way of moving is lost.
    At,
}

/// The way of moving that is hardest, or lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hardest {
    /// Along a direction, world space, unit length.
    Move(DVec3),
    /// About an axis, world space, unit length.
    Turn(DVec3),
}

/// How well the tip can move.
#[derive(Clone, Debug, PartialEq)]
pub struct Mobility {
    /// The Jacobian: the tip's velocity and angular velocity for each value.
    pub jacobian: TipJacobian,
    /// The singular values that count, largest first.
    pub singular_values: Vec<f64>,
    /// The least of them over the largest, 0 to 1.
    pub isotropy: f64,
    /// Their product.
    pub manipulability: f64,
    /// The half axes of the ellipsoid of the tip's velocities when all values go at unit speed, world
    /// space; those of length zero included.
    pub ellipsoid: [DVec3; 3],
    /// The length that a radian counts as, where turns are measured too.
    pub radian_length: Option<f64>,
    /// How near to a singularity it is.
    pub singularity: Singularity,
    /// What is hardest.
    pub hardest: Option<Hardest>,
    /// Two hinges whose axes are in line, so that one undoes what the other does.
    pub in_line: Option<[JointId; 2]>,
}

/// Measures a robot where it stands.
#[must_use]
pub fn mobility(robot: &Robot, values: &[f64], frames: &[Frame], tip: JointId) -> Mobility {
    let jacobian = jacobian(&robot.mechanism, values, tip, DVec3::ZERO);
    let moving = robot.values_moving(tip).len();
    let radian_length = RADIAN_SHARE * robot.reach;
    let (task, ways, turns) = match &robot.planar {
        Some(arm) => {
            let normal = arm.normal();
            (Task::PositionInPlane { normal }, 2, false)
        }
        None if moving >= 6 => (Task::Pose { radian_length }, 6, true),
        None => (Task::Position, 3, false),
    };
    let all = Dexterity::of(&jacobian, task);
    let count = ways.min(moving).min(all.singular_values.len());
    let singular_values = all.singular_values[..count].to_vec();
    let isotropy = match (singular_values.first(), singular_values.last()) {
        (Some(&largest), Some(&least)) if largest > 0.0 => least / largest,
        _ => 0.0,
    };
    let singularity = match isotropy {
        _ if count == 0 => Singularity::Far,
        isotropy if isotropy < AT => Singularity::At,
        isotropy if isotropy < NEAR => Singularity::Near,
        _ => Singularity::Far,
    };
    let hardest = count
        .checked_sub(1)
        .and_then(|last| hardest(&all.axes[last], task));
    Mobility {
        ellipsoid: ellipsoid(&jacobian),
        manipulability: singular_values.iter().product(),
        in_line: in_line(robot, frames, tip),
        radian_length: turns.then_some(radian_length),
        jacobian,
        singular_values,
        isotropy,
        singularity,
        hardest,
    }
}

/// What an axis of the task's ellipsoid is in the world.
fn hardest(axis: &[f64], task: Task) -> Option<Hardest> {
    match (task, axis) {
        (Task::PositionInPlane { normal }, &[a, b]) => {
            let (side, other) = normal.any_orthonormal_pair();
            Some(Hardest::Move((side * a + other * b).try_normalize()?))
        }
        (Task::Position, &[x, y, z]) => Some(Hardest::Move(DVec3::new(x, y, z).try_normalize()?)),
        (Task::Pose { .. }, &[x, y, z, rx, ry, rz]) => {
            let (moved, turned) = (DVec3::new(x, y, z), DVec3::new(rx, ry, rz));
            if moved.length() >= turned.length() {
                Some(Hardest::Move(moved.try_normalize()?))
            } else {
                Some(Hardest::Turn(turned.try_normalize()?))
            }
        }
        _ => None,
    }
}

fn ellipsoid(jacobian: &TipJacobian) -> [DVec3; 3] {
    let place = Dexterity::of(jacobian, Task::Position);
    let mut axes = [DVec3::ZERO; 3];
    for ((axis, value), direction) in axes.iter_mut().zip(&place.singular_values).zip(&place.axes) {
        *axis = DVec3::from_slice(direction) * *value;
    }
    axes
}

/// The first two hinges on the way to the tip, with others between them, whose axes are in line.
fn in_line(robot: &Robot, frames: &[Frame], tip: JointId) -> Option<[JointId; 2]> {
    let hinge = |joint: JointId| match robot.mechanism.joint(joint).freedom {
        Freedom::Hinge { axis } => {
            let frame = &frames[joint.index()];
            Some((joint, frame.position, frame.orientation * axis))
        }
        _ => None,
    };
    let hinges: Vec<_> = robot.path_to(tip).into_iter().filter_map(hinge).collect();
    for (index, &(first, at, axis)) in hinges.iter().enumerate() {
        for &(second, other_at, other_axis) in hinges.iter().skip(index + 2) {
            let is_parallel = axis.cross(other_axis).length() < IN_LINE_SINE;
            let passes = (other_at - at).cross(axis).length() < IN_LINE_SHARE * robot.reach;
            if is_parallel && passes {
                return Some([first, second]);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, values: &[f64]) -> Mobility {
        let robot = Robot::sample(name).expect("one of ours");
        let frames = robot.mechanism.global_frames(values);
        mobility(&robot, values, &frames, robot.tips[0])
    }

    #[test]
    fn the_planar_arm_loses_the_way_along_itself_when_it_is_stretched() {
        let bent = of("planar2", &[0.3, 1.2]);
        assert_eq!(bent.singularity, Singularity::Far);
        // Yoshikawa: l1 l2 |sin t2|.
        assert!((bent.manipulability - 0.2 * 1.2f64.sin()).abs() < 1e-12);
        let nearly = of("planar2", &[0.3, 0.15]);
        assert_eq!(nearly.singularity, Singularity::Near);
        let straight = of("planar2", &[0.3, 0.0]);
        assert_eq!(straight.singularity, Singularity::At);
        let robot = Robot::sample("planar2").expect("ours");
        let arm = robot.planar.expect("planar");
        let along = arm.axes * DVec3::new(0.3f64.cos(), 0.3f64.sin(), 0.0);
        let Some(Hardest::Move(lost)) = straight.hardest else {
            panic!("a way to move is lost");
        };
        assert!((lost.dot(along).abs() - 1.0).abs() < 1e-9, "{lost}");
    }

    #[test]
    fn the_wrist_of_six_axes_is_singular_when_two_of_its_axes_are_in_line() {
        let bent = of("arm6", &[0.4, -0.8, 0.3, 0.2, 0.9, 0.1]);
        assert_eq!(bent.singularity, Singularity::Far, "{}", bent.isotropy);
        assert_eq!(bent.in_line, None);
        assert_eq!(bent.singular_values.len(), 6);
        let straight = of("arm6", &[0.4, -0.8, 0.3, 0.2, 0.0, 0.1]);
        assert_eq!(straight.singularity, Singularity::At);
        let robot = Robot::sample("arm6").expect("ours");
        let names = straight
            .in_line
            .expect("in line")
            .map(|j| robot.joint_name(j).to_owned());
        assert_eq!(names, ["wrist_roll_joint", "flange_joint"]);
    }

    #[test]
    fn seven_axes_have_six_singular_values() {
        let mobility = of("arm7", &[0.2, 0.5, 0.1, -1.2, 0.3, 0.9, 0.0]);
        assert_eq!(mobility.singular_values.len(), 6);
        assert_eq!(
            mobility.singularity,
            Singularity::Far,
            "{}",
            mobility.isotropy
        );
    }

    #[test]
    fn a_robot_that_cannot_move_is_not_singular() {
        let text = br#"<robot name="post"><link name="a"/><link name="b"/>
          <joint name="j" type="fixed"><parent link="a"/><child link="b"/>
          <origin xyz="0 0 1"/></joint></robot>"#;
        let robot = Robot::read("post", text).expect("valid");
        let frames = robot.mechanism.global_frames(&[]);
        let mobility = mobility(&robot, &[], &frames, robot.tips[0]);
        assert_eq!(mobility.singularity, Singularity::Far);
        assert!(mobility.singular_values.is_empty());
    }
}
