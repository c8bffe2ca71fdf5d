//! Forward kinematics as plain arrays: what `npz`, `csv` and `json` files of joint positions hold.
//!
//! The arrays are not made whole: the writers go over the motion and hand on a few frames at a time,
//! so that a file of any length is written in little memory.
//!
//! A number that is not finite, which no motion from a file makes, is an error of the kind `InvalidData`, and is never
//! written.
//!
//! Space and units: world space, the file's length unit, seconds, unit quaternions as x, y, z, w.

use std::io;

use glam::Vec3;
use posekit::motion::GlobalMotion;
use posekit::skeleton::JointId;

/// A point attached to a joint's link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttachedPoint {
    /// The joint whose link carries the point.
    pub joint: JointId,
    /// Where the point is in the joint's space, in the file's unit.
    pub point_in_joint: Vec3,
}

/// Which joints, frames and points of a motion are written.
///
/// The joints and frames may be any selection in any order; every id and frame must be one of the
/// motion's, or the writers panic.
#[derive(Clone, Copy, Debug)]
pub struct MotionArrays<'a> {
    /// The motion in world space.
    pub motion: &'a GlobalMotion,
    /// The joints that are written, in this order.
    pub joints: &'a [JointId],
    /// The frames of the motion that are written, in this order.
    pub frames: &'a [usize],
    /// The numbers of these frames in a longer motion that this one is taken from; `None` where it is whole.
    pub numbers: Option<&'a [usize]>,
    /// Points that are written beside the joints.
    pub points: &'a [AttachedPoint],
}

impl MotionArrays<'_> {
    /// The written joints' names, told apart where the file gives two the same.
    pub fn joint_names(&self) -> Vec<&str> {
        let skeleton = self.motion.skeleton();
        self.joints
            .iter()
            .map(|&joint| skeleton.unique_name(joint))
            .collect()
    }

    /// Each written joint's parent as a place among the written joints: its closest ancestor that
    /// is written too, or `None` when there is none.
    pub fn parents(&self) -> Vec<Option<usize>> {
        let skeleton = self.motion.skeleton();
        let mut place = vec![None; skeleton.joint_count()];
        for (index, joint) in self.joints.iter().enumerate() {
            place[joint.index()].get_or_insert(index);
        }
        let written_ancestor = |joint: JointId| {
            skeleton
                .ancestors(joint)
                .find_map(|ancestor| place[ancestor.index()])
        };
        self.joints
            .iter()
            .map(|&joint| written_ancestor(joint))
            .collect()
    }

    /// The numbers of the written frames in the whole motion.
    pub fn numbers(&self) -> &[usize] {
        self.numbers.unwrap_or(self.frames)
    }

    /// The time in seconds of the frame of this number, counted from frame 0 of the whole motion.
    pub fn time_secs(&self, number: usize) -> f64 {
        frame_number(number) * self.motion.frame_time_secs()
    }

    pub(crate) fn position(&self, frame: usize, joint: JointId) -> io::Result<[f32; 3]> {
        let place = self.motion.position(frame, joint).to_array();
        self.finite(place, frame, joint)
    }

    pub(crate) fn orientation(&self, frame: usize, joint: JointId) -> io::Result<[f32; 4]> {
        let orientation = self.motion.orientation(frame, joint).to_array();
        self.finite(orientation, frame, joint)
    }

    /// Where a point is in the world.
    pub(crate) fn point(&self, frame: usize, point: &AttachedPoint) -> io::Result<[f32; 3]> {
        let AttachedPoint {
            joint,
            point_in_joint,
        } = *point;
        let place = self.motion.transform_point(frame, joint, point_in_joint);
        self.finite(place.to_array(), frame, joint)
    }

    fn finite<const N: usize>(
        &self,
        numbers: [f32; N],
        frame: usize,
        joint: JointId,
    ) -> io::Result<[f32; N]> {
        if numbers.iter().all(|number| number.is_finite()) {
            return Ok(numbers);
        }
        let name = self.motion.skeleton().unique_name(joint);
        let why =
            format!("joint `{name}` is not at a place that is a finite number at frame {frame}");
        Err(io::Error::new(io::ErrorKind::InvalidData, why))
    }

    /// What a point is called: its joint's unique name and its number, as `Hand#0`.
    pub(crate) fn point_name(&self, index: usize) -> String {
        format!(
            "{}#{index}",
            self.motion.skeleton().unique_name(self.points[index].joint)
        )
    }
}

#[allow(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
fn frame_number(frame: usize) -> f64 {
    frame as f64
}
