//! How far a filled motion is from the truth.

use crate::motion::Motion;
use crate::rotation::angle_between;
use crate::skeleton::JointId;

/// How far one joint is from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointError {
    /// The joint.
    pub joint: JointId,
    /// The mean angle between its local rotations, in degrees.
    pub mean_deg: f64,
    /// The largest one.
    pub max_deg: f64,
    /// The frame of the largest one.
    pub worst_frame: usize,
    /// The mean distance between its global positions, in the file's unit.
    pub mean_distance: f64,
    /// The largest one.
    pub max_distance: f64,
}

/// How far a motion is from the truth, over chosen frames.
#[derive(Clone, Debug, PartialEq)]
pub struct FillError {
    /// Joint by joint, those that turn, in topological order.
    pub joints: Vec<JointError>,
    /// The mean over the joints of the angle between local rotations at each of the frames, in degrees.
    pub by_frame_deg: Vec<f64>,
    /// The mean over frames and joints, in degrees.
    pub mean_deg: f64,
    /// The largest of all, in degrees.
    pub max_deg: f64,
    /// The mean distance over frames and joints between global positions, in the file's unit.
    pub mean_distance: f64,
    /// The largest of all.
    pub max_distance: f64,
}

impl FillError {
    /// The joint that strays the farthest at any frame, the first of several; `None` where nothing turns.
    #[must_use]
    pub fn worst(&self) -> Option<&JointError> {
        self.joints
            .iter()
            .reduce(|a, b| if b.max_deg > a.max_deg { b } else { a })
    }

    /// Compares two motions of one skeleton at these frames. Without frames or joints that turn, all
    /// errors are 0.
    ///
    /// # Panics
    /// If the skeletons differ in their number of joints, or a motion does not have one of the frames.
    pub fn between(truth: &Motion, filled: &Motion, frames: &[usize]) -> Self {
        assert_eq!(
            truth.skeleton().joint_count(),
            filled.skeleton().joint_count(),
            "motions of one skeleton"
        );
        let globals = [truth, filled].map(Motion::to_global);
        let mut by_frame_deg = vec![0.0; frames.len()];
        let joints: Vec<JointError> = truth
            .rotated_joints()
            .iter()
            .map(|&joint| {
                let mut error = JointError {
                    joint,
                    mean_deg: 0.0,
                    max_deg: 0.0,
                    worst_frame: frames.first().copied().unwrap_or(0),
                    mean_distance: 0.0,
                    max_distance: 0.0,
                };
                for (&frame, sum) in frames.iter().zip(&mut by_frame_deg) {
                    let [a, b] = [truth, filled]
                        .map(|motion| motion.rotation(frame, joint).as_dquat().normalize());
                    let angle = angle_between(a, b).to_degrees();
                    *sum += angle;
                    error.mean_deg += angle;
                    if angle > error.max_deg {
                        (error.max_deg, error.worst_frame) = (angle, frame);
                    }
                    let [a, b] = [&globals[0], &globals[1]]
                        .map(|global| global.position(frame, joint).as_dvec3());
                    let distance = a.distance(b);
                    error.mean_distance += distance;
                    error.max_distance = error.max_distance.max(distance);
                }
                error.mean_deg /= count(frames.len());
                error.mean_distance /= count(frames.len());
                error
            })
            .collect();
        let mean = |value: fn(&JointError) -> f64| {
            joints.iter().map(value).sum::<f64>() / count(joints.len())
        };
        let most = |value: fn(&JointError) -> f64| joints.iter().map(value).fold(0.0, f64::max);
        Self {
            mean_deg: mean(|joint| joint.mean_deg),
            max_deg: most(|joint| joint.max_deg),
            mean_distance: mean(|joint| joint.mean_distance),
            max_distance: most(|joint| joint.max_distance),
            by_frame_deg: by_frame_deg
                .iter()
                .map(|sum| sum / count(joints.len()))
                .collect(),
            joints,
        }
    }
}

/// How many things a sum is divided by: at least one.
#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
fn count(things: usize) -> f64 {
    things.max(1) as f64
}
