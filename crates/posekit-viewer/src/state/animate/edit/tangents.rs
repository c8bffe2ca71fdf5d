//! How the tangents of keys are chosen.

use std::collections::BTreeSet;

use super::super::channel::{TangentKind, set_tangents};
use super::super::{Authored, KeyId};
use super::Edit;
use super::keys::by_lane;

/// The keys with tangents of a kind. `None` when a track is not valid any more.
#[must_use]
pub fn with_tangents(
    authored: &Authored,
    selection: &BTreeSet<KeyId>,
    kind: TangentKind,
) -> Option<Edit> {
    let mut edit = Edit {
        selection: selection.clone(),
        ..Edit::default()
    };
    for (lane, keys) in by_lane(selection) {
        let Some(track) = authored.track(lane) else {
            continue;
        };
        let keys = keys.into_iter().collect();
        let edited = set_tangents(&track.to_value(), &keys, kind).ok()?;
        edit.changes.push((lane, Some(edited.track)));
    }
    Some(edit)
}
