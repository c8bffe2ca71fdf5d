//! Editing keys: functions that make new tracks of old ones, for [`Authored::set_tracks`].
//!
//! [`pose`]: keys of whole poses. [`keys`]: what a dope sheet does to selected keys. [`clipboard`]: keys
//! copied, pasted, mirrored. [`mode`]: rotations as quaternions or Euler curves.
//!
//! [`Authored::set_tracks`]: super::Authored::set_tracks

pub mod clipboard;
pub mod keys;
pub mod mode;
pub mod pose;
pub mod tangents;

use std::collections::BTreeSet;

use super::{KeyId, Lane, TrackValue};

/// New tracks for some lanes, and the keys that are selected afterwards.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edit {
    /// The lanes that change.
    pub changes: Vec<(Lane, Option<TrackValue>)>,
    /// What is selected afterwards.
    pub selection: BTreeSet<KeyId>,
}

impl Edit {
    /// Whether it changes nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.changes.is_empty()
    }
}
