//! Editing: functions from tracks to tracks, as an editor's commands are made of.
//!
//! Nothing is changed in place, so that the state before an edit is there to go back to. Keys are
//! selected by index; an index that does not exist selects nothing. Two keys within
//! [`SAME_TIME_SECS`] of each other are at one time: the one that is put there replaces the other.
//!
//! [`keys`](self) of one track: [`insert_key`], [`insert_on_curve`], [`move_keys`], [`scale_keys`], [`delete_keys`],
//! [`copy_keys`], [`paste_keys`], [`replace_keys`]. Of a whole pose: [`key_pose`], [`breakdown_pose`], [`mirror_pose`],
//! [`mirror_animation`].

mod mirror;
mod pose_keys;
mod time;

pub use mirror::{MirrorAxis, mirror_animation, mirror_axis, mirror_pose};
pub use pose_keys::{
    KeyPoseConfig, KeyedJoints, blend_poses, breakdown_pose, breakdown_value, key_pose,
};
pub use time::{
    EditError, PasteValues, SAME_TIME_SECS, copy_keys, delete_keys, insert_key, insert_on_curve,
    key_on_curve, move_keys, paste_keys, replace_keys, scale_keys,
};
