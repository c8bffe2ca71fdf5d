//! The map from the tip to the world as a product of simple matrices: `T = B A1 A2 ...`.
//!
//! `B` stands the robot upright (the file's Z up becomes Y up). Each joint on the way to the tip then
//! gives one matrix: where it is mounted in its parent's frame (`Trans`, and turns about the fixed axes X,
//! then Y, then Z, written right to left as they apply), times how far it has moved (`Rot` by its angle or
//! `Trans` by its length). Homogeneous 4 x 4 matrices, column vectors, metres and radians; angles are
//! written in degrees.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use posekit::mechanism::{Frame, Freedom};
use posekit::skeleton::JointId;

use super::robot::Robot;
use crate::state::readout::fixed;

/// Numbers smaller than this are left out of the formulas: they are rounding.
const NOTHING: f64 = 1e-9;

/// How finely the product is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// One factor for each joint.
    #[default]
    Joints,
    /// One factor for each translation and each turn about an axis.
    Steps,
}

/// A factor of the product.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Its letter and number: `B`, `A1`, `A2` and so on.
    pub symbol: String,
    /// The joint that it belongs to.
    pub joint: JointId,
    /// What it is made of: `Trans(0.432, 0, 0.149) Rz(30.0°)`.
    pub formula: String,
    /// The factor.
    pub matrix: DMat4,
    /// The product of all factors up to this one.
    pub product: DMat4,
}

/// A step of a joint's matrix.
struct Step {
    formula: String,
    matrix: DMat4,
}

/// The factors on the way from the world to a joint, in the order in which they are multiplied.
#[must_use]
pub fn factors(robot: &Robot, values: &[f64], tip: JointId, detail: Detail) -> Vec<Factor> {
    let frames = robot.mechanism.global_frames(values);
    let mut list: Vec<Factor> = Vec::new();
    let mut product = DMat4::IDENTITY;
    let mut push = |symbol: String, joint: JointId, step: Step| {
        product *= step.matrix;
        list.push(Factor {
            symbol,
            joint,
            formula: step.formula,
            matrix: step.matrix,
            product,
        });
    };
    for (number, joint) in robot.path_to(tip).into_iter().enumerate() {
        let symbol = match number {
            0 => "B".to_owned(),
            number => format!("A{number}"),
        };
        let steps = steps(robot, values, &frames, joint);
        match detail {
            Detail::Joints => push(symbol, joint, joined(steps)),
            Detail::Steps => {
                for step in steps {
                    push(symbol.clone(), joint, step);
                }
            }
        }
    }
    list
}

/// Several steps as one.
fn joined(steps: Vec<Step>) -> Step {
    let formulas: Vec<&str> = steps.iter().map(|step| step.formula.as_str()).collect();
    Step {
        formula: formulas.join(" "),
        matrix: steps
            .iter()
            .fold(DMat4::IDENTITY, |product, step| product * step.matrix),
    }
}

fn steps(robot: &Robot, values: &[f64], frames: &[Frame], joint: JointId) -> Vec<Step> {
    let described = robot.mechanism.joint(joint);
    let in_file = robot.joints_in_file[joint.index()];
    let mut steps = Vec::new();
    match in_file {
        None => steps.push(Step {
            formula: "Z up to Y up".to_owned(),
            matrix: DMat4::from_quat(described.rest_rotation),
        }),
        Some(index) => {
            let origin = &robot.document.joints[index].origin;
            let [roll, pitch, yaw] = origin.rpy;
            steps.extend(translation(origin.translation()));
            steps.extend(turn(DVec3::Z, yaw));
            steps.extend(turn(DVec3::Y, pitch));
            steps.extend(turn(DVec3::X, roll));
        }
    }
    let value = robot.value_of(joint, values);
    match (described.freedom, value) {
        (Freedom::Hinge { axis }, Some(angle)) => steps.push(hinge(axis, angle)),
        (Freedom::Slide { axis }, Some(length)) => steps.push(slide(axis * length)),
        (Freedom::Fixed, _) => {}
        _ => steps.push(moved(robot, frames, joint)),
    }
    if steps.is_empty() {
        steps.push(Step {
            formula: "1".to_owned(),
            matrix: DMat4::IDENTITY,
        });
    }
    steps
}

/// A translation that is not nothing.
fn translation(by: DVec3) -> Option<Step> {
    (by.length() > NOTHING).then(|| slide(by))
}

fn slide(by: DVec3) -> Step {
    Step {
        formula: format!("Trans({}, {}, {})", short(by.x), short(by.y), short(by.z)),
        matrix: DMat4::from_translation(by),
    }
}

/// A turn that is not nothing.
fn turn(axis: DVec3, angle_rad: f64) -> Option<Step> {
    (angle_rad.abs() > NOTHING).then(|| hinge(axis, angle_rad))
}

fn hinge(axis: DVec3, angle_rad: f64) -> Step {
    Step {
        formula: format!(
            "{}({}\u{b0})",
            axis_name(axis),
            fixed(angle_rad.to_degrees(), 1)
        ),
        matrix: DMat4::from_quat(rotation(axis, angle_rad)),
    }
}

fn rotation(axis: DVec3, angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_vec4((axis * sin).extend(cos))
}

/// `Rx`, `R-z`, or the axis in numbers.
fn axis_name(axis: DVec3) -> String {
    for (unit, name) in DVec3::AXES.into_iter().zip(["x", "y", "z"]) {
        let along = axis.dot(unit);
        if along > 1.0 - NOTHING {
            return format!("R{name}");
        }
        if along < NOTHING - 1.0 {
            return format!("R-{name}");
        }
    }
    format!("R[{} {} {}]", short(axis.x), short(axis.y), short(axis.z))
}

/// What a joint of several values has done: from where it rests to where it is.
fn moved(robot: &Robot, frames: &[Frame], joint: JointId) -> Step {
    let at = |frame: Frame| DAffine3::from_rotation_translation(frame.orientation, frame.position);
    let described = robot.mechanism.joint(joint);
    let parent = robot.mechanism.skeleton().parent(joint);
    let parent = parent.map_or(DAffine3::IDENTITY, |parent| at(frames[parent.index()]));
    let rest =
        DAffine3::from_rotation_translation(described.rest_rotation, described.rest_translation);
    let motion = (parent * rest).inverse() * at(frames[joint.index()]);
    Step {
        formula: "Move".to_owned(),
        matrix: DMat4::from(motion),
    }
}

/// A length as short as it can be told to a tenth of a millimetre.
fn short(length: f64) -> String {
    let text = fixed(length, 4);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "" | "-" => "0".to_owned(),
        text => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_told_shortly() {
        assert_eq!(short(0.431_8), "0.4318");
        assert_eq!(short(0.5), "0.5");
        assert_eq!(short(-0.000_001), "0");
        assert_eq!(short(2.0), "2");
        assert_eq!(short(100.0), "100");
    }

    #[test]
    fn axes_are_named() {
        assert_eq!(axis_name(DVec3::Z), "Rz");
        assert_eq!(axis_name(-DVec3::Y), "R-y");
        assert_eq!(axis_name(DVec3::new(0.6, 0.8, 0.0)), "R[0.6 0.8 0]");
    }

    #[test]
    fn the_product_of_all_factors_is_forward_kinematics() {
        for (name, values) in [
            ("arm6", vec![0.3, -0.7, 1.1, 0.4, -0.9, 2.0]),
            ("arm7", vec![0.3, -0.7, 1.1, 0.4, -0.9, 1.0, 0.2]),
            ("planar2", vec![0.5, -1.2]),
        ] {
            let robot = Robot::sample(name).expect("one of ours");
            let tip = robot.tips[0];
            let frame = robot.mechanism.global_frames(&values)[tip.index()];
            let expected = DMat4::from_rotation_translation(frame.orientation, frame.position);
            for detail in [Detail::Joints, Detail::Steps] {
                let list = factors(&robot, &values, tip, detail);
                let last = list.last().expect("there is the root at least");
                assert!(
                    last.product.abs_diff_eq(expected, 1e-12),
                    "{name} {detail:?}"
                );
            }
        }
    }

    #[test]
    fn followers_and_free_joints_have_their_factors() {
        let text = br#"<robot name="r">
          <link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
          <joint name="float" type="floating"><parent link="a"/><child link="b"/>
            <origin xyz="0 0 1" rpy="0.1 0.2 0.3"/></joint>
          <joint name="lead" type="prismatic"><parent link="b"/><child link="c"/>
            <origin rpy="0 0.4 0"/><axis xyz="1 0 0"/>
            <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
          <joint name="follower" type="continuous"><parent link="c"/><child link="d"/>
            <axis xyz="0 0.6 0.8"/><mimic joint="lead" multiplier="-2" offset="0.5"/></joint>
          <joint name="end" type="planar"><parent link="d"/><child link="e"/>
            <axis xyz="0 1 0"/></joint></robot>"#;
        let robot = Robot::read("r.urdf", text).expect("a valid robot");
        let values = [0.1, 0.2, 0.3, -0.4, 0.5, 0.6, 0.7, 0.8, -0.9, 1.0];
        let tip = robot.tips[0];
        let frame = robot.mechanism.global_frames(&values)[tip.index()];
        let expected = DMat4::from_rotation_translation(frame.orientation, frame.position);
        let list = factors(&robot, &values, tip, Detail::Joints);
        assert!(
            list.last()
                .expect("five")
                .product
                .abs_diff_eq(expected, 1e-12)
        );
        let follower = &list[3];
        assert!(
            follower.formula.contains("R[0 0.6 0.8](-51.6"),
            "{}",
            follower.formula
        );
    }
}
