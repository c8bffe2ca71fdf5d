//! Forward kinematics as plain arrays: what `npz`, `csv` and `json` files of joint positions hold.
//!
//! The arrays are not made whole: the writers go over the motion and hand on a few frames at a time,
//! so that a file of any length is written in little memory.
//!
//! Space and units: world space, the file's length unit, seconds, unit quaternions as x, y, z, w.

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
