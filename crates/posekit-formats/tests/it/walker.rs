//! A walking figure made by a procedure, so that checks can be tested without any file: the feet follow
//! given paths, stand still while they are planted, and the legs are solved by the law of cosines.

use posekit::motion::Channel;
use posekit::rotation::Axis;
use posekit_formats::bvh::{Bvh, BvhJoint, BvhMotion, EndName};

/// Length of thigh and shank.
const BONE: f64 = 0.45;
/// Height of the ankle over the floor.
const ANKLE: f64 = 0.08;
/// Height of the hips.
const HIPS: f64 = 0.9;
/// Forward way of a step of both feet.
const STRIDE: f64 = 1.2;
/// Frames of a step of both feet, at 60 a second.
pub(crate) const CYCLE: usize = 66;
/// The share of the cycle in which a foot is planted.
const STANCE: f64 = 0.62;

const POSITIONS: [Channel; 3] = [
    Channel::Position(Axis::X),
    Channel::Position(Axis::Y),
    Channel::Position(Axis::Z),
];
const ROTATIONS: [Channel; 3] = [
    Channel::Rotation(Axis::Z),
    Channel::Rotation(Axis::X),
    Channel::Rotation(Axis::Y),
];

/// What the figure's bones are written with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channels {
    /// Rotations, and positions at the root.
    Three,
    /// Positions and rotations of every joint.
    Six,
}

/// Seven cycles of a walk along Z at 60 frames a second, 1.7 units tall.
pub(crate) fn walk(channels: Channels) -> Bvh {
    let mut bvh = Bvh {
        joints: figure(channels),
        motion: None,
    };
    let frame_count = 7 * CYCLE;
    let mut values = Vec::new();
    for frame in 0..frame_count {
        let phase = frame as f64 / CYCLE as f64;
        for (index, joint) in bvh.joints.iter().enumerate() {
            let (position, rotation) = pose(index, joint, phase);
            for channel in &joint.channels {
                values.push(match *channel {
                    Channel::Position(axis) => position[axis.index()],
                    Channel::Rotation(axis) => rotation[axis.index()],
                });
            }
        }
    }
    bvh.motion = Some(BvhMotion {
        frame_time_secs: 1.0 / 60.0,
        frame_count,
        values,
    });
    bvh.validate().unwrap();
    bvh
}

fn figure(channels: Channels) -> Vec<BvhJoint> {
    let mut joints = vec![joint("Hips", None, [0.0, HIPS, 0.0], Channels::Six)];
    joints.push(joint("Chest", Some(0), [0.0, 0.4, 0.0], channels));
    joints.push(joint("Head", Some(1), [0.0, 0.3, 0.0], channels));
    joints.push(end("Head", 2, [0.0, 0.15, 0.0]));
    for (side, x) in [("Left", 0.1), ("Right", -0.1)] {
        let thigh = joints.len();
        joints.push(joint(
            &format!("{side}Thigh"),
            Some(0),
            [x, 0.0, 0.0],
            channels,
        ));
        joints.push(joint(
            &format!("{side}Shank"),
            Some(thigh),
            [0.0, -BONE, 0.0],
            channels,
        ));
        joints.push(joint(
            &format!("{side}Foot"),
            Some(thigh + 1),
            [0.0, -BONE, 0.0],
            channels,
        ));
        joints.push(end("Foot", thigh + 2, [0.0, -ANKLE, 0.12]));
    }
    for (side, x) in [("Left", 0.2), ("Right", -0.2)] {
        let arm = joints.len();
        joints.push(joint(
            &format!("{side}Arm"),
            Some(1),
            [x, 0.2, 0.0],
            channels,
        ));
        joints.push(joint(
            &format!("{side}Hand"),
            Some(arm),
            [x, 0.0, 0.0],
            channels,
        ));
        joints.push(end("Hand", arm + 1, [x, 0.0, 0.0]));
    }
    joints
}

fn joint(name: &str, parent: Option<usize>, offset: [f64; 3], channels: Channels) -> BvhJoint {
    let positions = if channels == Channels::Six {
        &POSITIONS[..]
    } else {
        &[]
    };
    BvhJoint {
        name: name.as_bytes().to_vec(),
        parent,
        offset,
        channels: positions.iter().chain(&ROTATIONS).copied().collect(),
        is_end_site: false,
        end_name: EndName::Implied,
    }
}

fn end(name: &str, parent: usize, offset: [f64; 3]) -> BvhJoint {
    BvhJoint {
        name: format!("{name}_end").into_bytes(),
        parent: Some(parent),
        offset,
        channels: Vec::new(),
        is_end_site: true,
        end_name: EndName::Implied,
    }
}

/// The local position and the rotation about X, Y, Z in degrees.
fn pose(index: usize, joint: &BvhJoint, phase: f64) -> ([f64; 3], [f64; 3]) {
    let swing = (std::f64::consts::TAU * phase).sin();
    let left_leg = leg(phase);
    let right_leg = leg(phase + 0.5);
    let pitch = match index {
        4 => left_leg[0],
        5 => left_leg[1],
        6 => left_leg[2],
        8 => right_leg[0],
        9 => right_leg[1],
        10 => right_leg[2],
        1 => 2.0 * swing,
        2 => -1.5 * swing,
        _ => 0.0,
    };
    // Arms hang from the T-pose and swing about their own side.
    let (yaw, roll) = match index {
        12 => (20.0 * swing, -70.0),
        15 => (20.0 * swing, 70.0),
        13 => (0.0, -10.0 + 8.0 * swing),
        16 => (0.0, 10.0 + 8.0 * swing),
        _ => (0.0, 0.0),
    };
    let position = if index == 0 {
        [0.0, HIPS, STRIDE * phase]
    } else {
        joint.offset
    };
    (position, [pitch, yaw, roll])
}

/// The pitch of thigh, shank and foot that puts the ankle where it should be, in degrees.
fn leg(phase: f64) -> [f64; 3] {
    let (ahead, height) = ankle(phase);
    let down = HIPS - height;
    let reach = ahead.hypot(down).min(2.0 * BONE);
    let half_knee = (reach / (2.0 * BONE)).acos();
    let thigh = -ahead.atan2(down) - half_knee;
    let shank = 2.0 * half_knee;
    [thigh, shank, -thigh - shank].map(f64::to_degrees)
}

/// Where the ankle is ahead of the hips, and how high: planted, it falls back as fast as the hips go on.
fn ankle(phase: f64) -> (f64, f64) {
    let place = phase.rem_euclid(1.0);
    if place < STANCE {
        return (STRIDE * (0.5 * STANCE - place), ANKLE);
    }
    let swing = (place - STANCE) / (1.0 - STANCE);
    let smooth = swing * swing * swing * (10.0 - 15.0 * swing + 6.0 * swing * swing);
    let from = STRIDE * -0.5 * STANCE;
    // The foot leaves and lands at rest over the floor: the hips' way is taken off again.
    let on_floor = from + (STRIDE * smooth) - STRIDE * (place - STANCE);
    let lift = 0.14 * (std::f64::consts::PI * swing).sin().powi(2);
    (on_floor, ANKLE + lift)
}
