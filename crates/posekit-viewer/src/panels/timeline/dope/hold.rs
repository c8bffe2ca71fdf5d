//! Keys that follow the pointer: dragged, moved and scaled by key, duplicated; and selecting in a box.

use std::collections::BTreeSet;

use egui::{Pos2, Rect};

use super::super::axis::Axis;
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
        })
    }

    /// Brings the keys to where the pointer is. On frames, unless `is_free`.
    pub(super) fn follow(&self, session: &mut Session, axis: &Axis, at: Pos2, is_free: bool) {
        let now = axis.secs_at(at.x);
        let by = self.shift(axis, now, is_free);
        let count = match self.keys.len() {
            1 => "a key".to_owned(),
            count => format!("{count} keys"),
        };
        session.author(|authored| {
            // From where the keys were: steps of a drag do not add up.
            authored.give_up(self.gesture);
            let (name, edit) = match self.verb {
                Verb::Move if by == 0.0 => return,
                Verb::Move => (format!("Move {count}"), moved(authored, &self.keys, by)),
                Verb::Duplicate => (
                    format!("Duplicate {count}"),
                    duplicated(authored, &self.keys, by),
                ),
                Verb::Scale { pivot_secs } => {
                    let Some(factor) = self.factor(pivot_secs, now).filter(|f| *f != 1.0) else {
                        return;
                    };
                    let about = (pivot_secs, factor);
                    (
                        format!("Scale {count}"),
                        scaled(authored, &self.keys, about, !is_free),
                    )
                }
            };
            if let Some(edit) = edit {
                authored.set_tracks(&name, Some(self.gesture), edit.changes, edit.selection);
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

    fn factor(&self, pivot_secs: f64, now: f64) -> Option<f64> {
        let factor = (now - pivot_secs) / (self.from_secs - pivot_secs);
        // Keys are not turned round: at the pivot they are as near as can be told apart.
        (factor.is_finite()).then_some(factor.max(1e-3))
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
