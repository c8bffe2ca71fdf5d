//! Keys that follow the pointer: dragged, moved and scaled by key, duplicated; and selecting in a box.

use std::collections::BTreeSet;

use egui::{Pos2, Rect};

use super::super::axis::Axis;
use super::super::counted;
use crate::state::animate::edit::keys::{duplicated, moved, scaled};
use crate::state::animate::{Authored, KeyId};
use crate::state::edit::Gesture;
use crate::state::session::Session;

/// What happens to the keys that follow the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verb {
    /// They move in time.
    Move,
    /// Copies of them do.
    Duplicate,
    /// Their times are scaled about a time.
    Scale {
        /// That time, in seconds of the scene.
        pivot_secs: f64,
    },
}

/// How it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Until {
    /// When the button is let go.
    Release,
    /// With a click, or Enter.
    Click,
}

/// Keys that follow the pointer.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// What happens to them.
    pub(super) verb: Verb,
    /// How it ends.
    pub(super) until: Until,
    gesture: Gesture,
    keys: BTreeSet<KeyId>,
    /// The time under the pointer when it began.
    from_secs: f64,
    /// The time of the key that lands on a frame.
    anchor_secs: f64,
    /// What was done last: by how much, and whether between frames.
    done: Option<(f64, bool)>,
}

impl Held {
    /// Takes the selected keys at a place; `anchor` is the key that lands on frames, otherwise the first
    /// is. `None` when none is selected.
    pub(super) fn take(
        session: &mut Session,
        (verb, until): (Verb, Until),
        axis: &Axis,
        (at, anchor): (Pos2, Option<f64>),
    ) -> Option<Self> {
        let authored = session.authored()?;
        let keys = authored.selection().clone();
        let first = keys.iter().filter_map(|key| authored.time_of(*key));
        let first = first.reduce(f64::min)?;
        let gesture = session.author(Authored::gesture)?;
        Some(Self {
            verb,
            until,
            gesture,
            keys,
            from_secs: axis.secs_at(at.x),
            anchor_secs: anchor.unwrap_or(first),
            done: None,
        })
    }

    /// Brings the keys to where the pointer is. On frames, unless `is_free`.
    pub(super) fn follow(&mut self, session: &mut Session, axis: &Axis, at: Pos2, is_free: bool) {
        let now = axis.secs_at(at.x);
        let amount = match self.verb {
            Verb::Move | Verb::Duplicate => self.shift(axis, now, is_free),
            Verb::Scale { pivot_secs } => self.factor(axis, pivot_secs, now),
        };
        // A pointer that rests changes nothing.
        if self.done == Some((amount, is_free)) {
            return;
        }
        self.done = Some((amount, is_free));
        let count = counted(self.keys.len());
        let (gesture, keys, verb) = (self.gesture, &self.keys, self.verb);
        session.author(|authored| {
            // From where the keys were: steps of a drag do not add up.
            authored.give_up(gesture);
            let (name, edit) = match verb {
                Verb::Move => (format!("Move {count}"), moved(authored, keys, amount)),
                Verb::Duplicate => (
                    format!("Duplicate {count}"),
                    duplicated(authored, keys, amount),
                ),
                Verb::Scale { .. } if (amount - 1.0).abs() < 1e-9 => return,
                Verb::Scale { pivot_secs } => (
                    format!("Scale {count}"),
                    scaled(authored, keys, (pivot_secs, amount), !is_free),
                ),
            };
            if let Some(edit) = edit {
                authored.set_tracks(&name, Some(gesture), edit.changes, edit.selection);
            }
        });
    }

    fn shift(&self, axis: &Axis, now: f64, is_free: bool) -> f64 {
        let by = now - self.from_secs;
        if is_free {
            by
        } else {
            axis.snapped(self.anchor_secs + by) - self.anchor_secs
        }
    }

    /// By how much times are scaled. A pointer that began near the pivot counts as a little away from
    /// it: the keys would fly off otherwise. Keys are not turned round, but come as near to the pivot as
    /// can be told apart.
    fn factor(&self, axis: &Axis, pivot_secs: f64, now: f64) -> f64 {
        const LEAST_POINTS: f32 = 24.0;
        let away = self.from_secs - pivot_secs;
        let arm = away.abs().max(axis.secs_of(LEAST_POINTS)).copysign(away);
        (1.0 + (now - self.from_secs) / arm).max(1e-3)
    }

    /// Gives it up: the keys are where they were.
    pub(super) fn cancel(self, session: &mut Session) {
        session.author(|authored| {
            authored.give_up(self.gesture);
            authored.select(self.keys);
        });
    }
}

/// A box that is drawn to select what is in it.
#[derive(Clone, Debug)]
pub(super) struct BoxSelect {
    /// Where it starts.
    pub(super) from: Pos2,
    /// What was selected and stays so.
    pub(super) kept: BTreeSet<KeyId>,
}

impl BoxSelect {
    /// The box to where the pointer is.
    #[must_use]
    pub(super) fn rect(&self, to: Pos2) -> Rect {
        Rect::from_two_pos(self.from, to)
    }
}
