//! Dots and handles that are held with the pointer: moved, scaled, let go or given up.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::{ChannelId, DotId, Graph, HandleId};
use crate::state::animate::Lane;
use crate::state::animate::channel::{
    Channels, Dot, Edited, Scaling, drag_handle_to, move_dots, scale_dots,
};
use crate::state::animate::edit::mode::LOST_TURN;
use crate::state::edit::Gesture;
use crate::state::session::Session;

/// A factor of times below this would put keys onto each other.
const LEAST_TIME_FACTOR: f64 = 0.01;

/// What is done with what is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HoldKind {
    /// Dots are moved.
    Move,
    /// Dots are scaled about a place: seconds and value.
    Scale {
        /// The place that stays.
        pivot: [f64; 2],
    },
    /// A handle is dragged.
    Handle(HandleId),
}

/// What is held. All that becomes of it is made from what was there when it was taken.
#[derive(Clone, Debug)]
pub struct Held {
    kind: HoldKind,
    gesture: Gesture,
    curves: BTreeMap<Lane, Arc<Channels>>,
    dots: BTreeSet<DotId>,
}

impl Held {
    /// What is done with it.
    #[must_use]
    pub const fn kind(&self) -> HoldKind {
        self.kind
    }
}

impl Graph {
    /// What is held, if anything is.
    #[must_use]
    pub fn held(&self) -> Option<&Held> {
        self.held.as_ref()
    }

    /// Takes the selected dots to move them. False when there is none.
    pub fn take_dots(&mut self, session: &mut Session) -> bool {
        self.hold(session, HoldKind::Move)
    }

    /// Takes the selected dots to scale them about the middle of the box that they lie in.
    pub fn take_to_scale(&mut self, session: &mut Session) -> bool {
        let Some([times, values]) = self.extent(self.selected()) else {
            return false;
        };
        let pivot = [times, values].map(|[low, high]| (low + high) * 0.5);
        self.hold(session, HoldKind::Scale { pivot })
    }

    /// Takes a handle.
    pub fn take_handle(&mut self, session: &mut Session, id: HandleId) -> bool {
        self.handle_place(id).is_some() && self.hold(session, HoldKind::Handle(id))
    }

    fn hold(&mut self, session: &mut Session, kind: HoldKind) -> bool {
        self.let_go();
        self.update(session);
        let dots = self.selected();
        if dots.is_empty() {
            return false;
        }
        let Some(gesture) = session.author(|authored| authored.gesture()) else {
            return false;
        };
        self.held = Some(Held {
            kind,
            gesture,
            curves: self.curves.clone(),
            dots,
        });
        true
    }

    /// Moves the dots that are held by seconds and a value, counted from where they were taken.
    pub fn move_held(&mut self, session: &mut Session, [by_secs, by_value]: [f64; 2]) {
        let loses = self.held.as_ref().is_some_and(|held| {
            held.dots.iter().any(|id| {
                let channels = held.curves.get(&id.lane);
                let here = |channels: &Arc<Channels>| channels.at_key(id.dot.key)[id.dot.channel];
                // Neighbours that go along keep their distance.
                let mut along = held.dots.iter().filter(|it| it.channel() == id.channel());
                let is_alone = along.nth(1).is_none();
                let lost = |it: &Arc<Channels>| it.loses_turn(id.dot, here(it) + by_value);
                is_alone && channels.is_some_and(lost)
            })
        });
        if loses {
            session.tell(LOST_TURN);
        }
        self.change_held(session, "Move keys", |channels, dots| {
            move_dots(channels, dots, by_secs, by_value).ok()
        });
    }

    /// Scales the dots that are held by a factor in time and one in value.
    pub fn scale_held(&mut self, session: &mut Session, [time, value]: [f64; 2]) {
        let Some(HoldKind::Scale { pivot }) = self.held.as_ref().map(Held::kind) else {
            return;
        };
        let time = time.max(LEAST_TIME_FACTOR);
        self.change_held(session, "Scale keys", |channels, dots| {
            scale_dots(channels, dots, Scaling { pivot, time, value }).ok()
        });
    }

    /// Brings the handle that is held to a place: seconds and value.
    pub fn drag_held_handle(&mut self, session: &mut Session, place: [f64; 2]) {
        let Some(HoldKind::Handle(HandleId { at, side })) = self.held.as_ref().map(Held::kind)
        else {
            return;
        };
        self.change_held(session, "Move handle", |channels, dots| {
            if !dots.contains(&at.dot) {
                return None;
            }
            drag_handle_to(channels, at.dot, side, place).ok()
        });
    }

    fn change_held(
        &mut self,
        session: &mut Session,
        name: &str,
        change: impl Fn(&Channels, &[Dot]) -> Option<Edited>,
    ) {
        let Some(held) = self.held.take() else {
            return;
        };
        let only = match held.kind {
            HoldKind::Handle(HandleId { at, .. }) => Some(at.channel()),
            HoldKind::Move | HoldKind::Scale { .. } => None,
        };
        let edited = held.curves.iter().filter_map(|(&lane, channels)| {
            let of_lane = held.dots.iter().filter(|dot| dot.lane == lane);
            let meant = |id: &&DotId| {
                only.is_none_or(|ChannelId { lane, channel }| {
                    id.lane == lane && id.dot.channel == channel
                })
            };
            let dots: Vec<Dot> = of_lane.filter(meant).map(|id| id.dot).collect();
            if dots.is_empty() {
                return None;
            }
            Some((lane, change(channels, &dots)?))
        });
        let edited: Vec<(Lane, Edited)> = edited.collect();
        self.put(session, (name, Some(held.gesture)), edited, &held.dots);
        self.held = Some(held);
    }

    /// Lets go of what is held: what was done is one step.
    pub fn let_go(&mut self) {
        self.held = None;
    }

    /// Gives up what is held: everything is as it was. True when something was held.
    pub fn give_up(&mut self, session: &mut Session) -> bool {
        let Some(held) = self.held.take() else {
            return false;
        };
        session.author(|authored| authored.give_up(held.gesture));
        self.dots = held.dots;
        self.update(session);
        true
    }
}
