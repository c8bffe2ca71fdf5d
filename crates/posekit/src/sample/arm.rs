//! A robot arm of six axes that picks things up and puts them down.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::SampleError;
use super::curve::{about_x, about_y, about_z, minimum_jerk};
use super::gait::{FRAME_TIME, FRAMES_PER_SEC};
use crate::motion::Motion;
use crate::skeleton::{JointId, Skeleton, SkeletonBuilder};

/// What a pick-and-place motion is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmConfig {
    /// How many things are carried from one place to the other, 1 to 1000.
    pub cycles: u32,
    /// Seconds for one of them, there and back, 3 to 30. Rounded to whole frames of 1/60 s.
    pub cycle_secs: f64,
}

impl Default for ArmConfig {
    fn default() -> Self {
        Self {
            cycles: 2,
            cycle_secs: 6.0,
        }
    }
}

/// Height of the shoulder axis over the floor, metres.
const SHOULDER_HEIGHT: f64 = 0.45;
/// From the waist's axis forward to the shoulder's.
const SHOULDER_FORWARD: f64 = 0.09;
/// From shoulder to elbow.
const UPPER_LENGTH: f64 = 0.48;
/// From elbow to the middle of the wrist, and the part of it before the forearm's roll axis.
const FOREARM_LENGTH: f64 = 0.45;
/// See [`FOREARM_LENGTH`].
const ROLL_AT: f64 = 0.14;
/// From the middle of the wrist to the tip of the tool, and to the flange where it is mounted.
const TOOL_LENGTH: f64 = 0.21;
/// See [`TOOL_LENGTH`].
const FLANGE_AT: f64 = 0.08;

/// The skeleton of [`arm`]: a base and six axes with a tool at the end, in metres, Y up, pointing
/// straight up at rest. Waist, forearm roll and tool roll turn about Y, shoulder, elbow and wrist
/// about X; the last three axes meet in a point, as in most industrial arms.
#[allow(
    clippy::missing_panics_doc,
    reason = "built from constants; a test builds it"
)]
pub fn robot_arm() -> Arc<Skeleton> {
    let mut builder = SkeletonBuilder::new();
    let at = |y: f64, z: f64| DVec3::new(0.0, y, z).as_vec3();
    let base = builder.joint("Base", None, at(0.0, 0.0));
    let waist = builder.joint("Waist", Some(base), at(0.2, 0.0));
    let shoulder_at = at(SHOULDER_HEIGHT - 0.2, SHOULDER_FORWARD);
    let shoulder = builder.joint("Shoulder", Some(waist), shoulder_at);
    let elbow = builder.joint("Elbow", Some(shoulder), at(UPPER_LENGTH, 0.0));
    let roll = builder.joint("ForearmRoll", Some(elbow), at(ROLL_AT, 0.0));
    let wrist = builder.joint("Wrist", Some(roll), at(FOREARM_LENGTH - ROLL_AT, 0.0));
    let flange = builder.joint("ToolRoll", Some(wrist), at(FLANGE_AT, 0.0));
    builder.end_site("ToolRoll_end", flange, at(TOOL_LENGTH - FLANGE_AT, 0.0));
    Arc::new(builder.build().expect("the joints above are a skeleton"))
}

/// [`robot_arm`] carries things from one place to another, at 60 frames a second. The last frame is
/// the first one.
///
/// The tool goes up, across and down in minimum-jerk movements (Flash and Hogan 1985) that overlap,
/// so that nothing stops half-way; it goes around the base, never through it. The joint angles are
/// solved from the tool's pose in closed form: waist, shoulder and elbow from the middle of the
/// wrist, the last three axes as Euler angles (Pieper 1968, "The kinematics of manipulators under
/// computer control").
///
/// # Errors
/// [`SampleError::OutOfRange`] when a value lies outside the range that its field states.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cycle in range has some thousands of frames at most"
)]
pub fn arm(config: &ArmConfig) -> Result<Motion, SampleError> {
    let cycles = super::whole_in_range("cycles", config.cycles, 1, 1000)?;
    let cycle_secs = super::in_range("cycle_secs", config.cycle_secs, 3.0, 30.0)?;
    let frames_per_cycle = libm::round(cycle_secs * FRAMES_PER_SEC) as u32;
    let frame_count = frames_per_cycle * cycles + 1;
    let skeleton = robot_arm();
    let mut motion = Motion::at_rest(
        skeleton,
        frame_count as usize,
        FRAME_TIME,
        [JointId::new(0)],
    );
    for frame in 0..frame_count {
        let phase = f64::from(frame % frames_per_cycle) / f64::from(frames_per_cycle);
        for (axis, rotation) in axis_rotations(&tool_at(phase)).into_iter().enumerate() {
            motion.set_rotation(frame as usize, JointId::new(axis + 1), rotation.as_quat());
        }
    }
    Ok(motion)
}

/// Where the tool is: its tip in cylinder coordinates about the waist's axis, and its direction.
#[derive(Clone, Copy, Debug)]
struct Tool {
    /// Radians about Y from +Z.
    around: f64,
    radius: f64,
    height: f64,
    /// Radians that the tool leans from pointing straight down, to the side it came from.
    tilt: f64,
    /// Radians about the tool's own axis.
    spin: f64,
}

/// Where things are picked up, and where they are put down: on a slanted rack, turned.
const PICK: Tool = Tool {
    around: -0.75,
    radius: 0.72,
    height: 0.10,
    tilt: 0.0,
    spin: 0.3,
};
/// See [`PICK`].
const PLACE: Tool = Tool {
    around: 1.05,
    radius: 0.62,
    height: 0.28,
    tilt: 0.42,
    spin: -0.9,
};
/// How high things are lifted over the place that they stand on.
const LIFT: f64 = 0.24;

/// The tool at a phase of the cycle: it rests at the pick, carries, rests at the place, returns.
fn tool_at(phase: f64) -> Tool {
    let carry = Carry::new(0.06, 0.47);
    let back = Carry::new(0.55, 0.97);
    let part = |window: fn(&Carry) -> (f64, f64)| {
        let ((a, b), (c, d)) = (window(&carry), window(&back));
        minimum_jerk(a, b, phase) - minimum_jerk(c, d, phase)
    };
    let across = part(|carry| carry.across);
    let mix = |from: f64, to: f64| from + (to - from) * across;
    let lifted = [&carry, &back].map(|way| {
        minimum_jerk(way.up.0, way.up.1, phase) - minimum_jerk(way.down.0, way.down.1, phase)
    });
    Tool {
        around: mix(PICK.around, PLACE.around),
        radius: mix(PICK.radius, PLACE.radius),
        height: mix(PICK.height, PLACE.height) + LIFT * (lifted[0] + lifted[1]),
        tilt: mix(PICK.tilt, PLACE.tilt),
        spin: mix(PICK.spin, PLACE.spin),
    }
}

/// The parts of a way from one place to the other, as phases: lifting, going across, lowering.
struct Carry {
    up: (f64, f64),
    across: (f64, f64),
    down: (f64, f64),
}

impl Carry {
    fn new(from: f64, to: f64) -> Self {
        let at = |part: f64| from + (to - from) * part;
        Self {
            up: (from, at(0.45)),
            across: (at(0.18), at(0.82)),
            down: (at(0.55), to),
        }
    }
}

/// The local rotations of the six axes that bring the tool there, elbow up.
fn axis_rotations(tool: &Tool) -> [DQuat; 6] {
    let waist = about_y(tool.around);
    let orientation = waist * about_z(tool.tilt) * about_x(PI) * about_y(tool.spin);
    let tip = waist * DVec3::new(0.0, tool.height, tool.radius);
    let wrist = tip - orientation * DVec3::new(0.0, TOOL_LENGTH, 0.0);
    // A tilted tool takes the wrist out of the tip's plane: the waist turns to the wrist.
    let waist = about_y(libm::atan2(wrist.x, wrist.z));
    let wrist = waist.inverse() * wrist;
    let (forward, up) = (wrist.z - SHOULDER_FORWARD, wrist.y - SHOULDER_HEIGHT);
    let square = forward * forward + up * up;
    let (upper, fore) = (UPPER_LENGTH, FOREARM_LENGTH);
    let cos_elbow = (square - upper * upper - fore * fore) / (2.0 * upper * fore);
    let elbow = libm::acos(cos_elbow.clamp(-1.0, 1.0));
    let (sin_elbow, cos_elbow) = libm::sincos(elbow);
    let inner = libm::atan2(fore * sin_elbow, upper + fore * cos_elbow);
    let shoulder = libm::atan2(forward, up) - inner;
    let forearm = waist * about_x(shoulder + elbow);
    let [roll, bend, spin] = y_x_y_angles(forearm.inverse() * orientation);
    [
        waist,
        about_x(shoulder),
        about_x(elbow),
        about_y(roll),
        about_x(bend),
        about_y(spin),
    ]
}

/// The angles of `about_y(a) * about_x(b) * about_y(c)`, `b` from 0 to pi.
fn y_x_y_angles(rotation: DQuat) -> [f64; 3] {
    let y = rotation * DVec3::Y;
    let a = libm::atan2(y.x, y.z);
    let b = libm::acos(y.y.clamp(-1.0, 1.0));
    let rest = (about_y(a) * about_x(b)).inverse() * rotation;
    [a, b, 2.0 * libm::atan2(rest.y, rest.w)]
}
