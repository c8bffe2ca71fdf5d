//! Moving and turning what is selected with the pointer alone: it is taken in hand by a key, follows the
//! pointer without a button, and is let go with a click.
//!
//! It is a drag of the gizmo's handle that moves in the picture's plane, or turns about the direction of
//! view; held to an axis, of the arrow or the ring of that axis. The pointer's way counts from where the
//! key was pressed.

use egui::{Pos2, Vec2};
use posekit::rotation::Axis;

use super::{Handles, Session};
use crate::gizmo::{Handle, RADIUS_POINTS, Tool, Viewport};
use crate::state::animate::Owner;
use crate::state::edit::freedom;

/// What is done with what is taken in hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Act {
    /// It is moved.
    Move,
    /// It is turned.
    Turn,
}

impl Act {
    /// The handle that it is taken by.
    const fn handle(self, axis: Option<Axis>) -> Handle {
        match (self, axis) {
            (Self::Move, None) => Handle::MoveOnScreen,
            (Self::Move, Some(axis)) => Handle::MoveAlong(axis),
            (Self::Turn, None) => Handle::TurnOnScreen,
            (Self::Turn, Some(axis)) => Handle::TurnAbout(axis),
        }
    }

    const fn verb(self) -> &'static str {
        match self {
            Self::Move => "move",
            Self::Turn => "turn",
        }
    }
}

/// The part of a session that deals with what follows the pointer.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hand {
    /// What was asked for and waits for the pointer.
    wanted: Option<Act>,
    held: Option<InHand>,
}

#[derive(Clone, Copy, Debug)]
struct InHand {
    act: Act,
    axis: Option<Axis>,
    /// Where the pointer was when it was taken.
    from: Pos2,
    /// The axis to hold it to, once the view is asked.
    wanted_axis: Option<Option<Axis>>,
}

impl Session {
    /// Asks for what is selected to follow the pointer. Says why where it cannot.
    pub fn take_in_hand(&mut self, act: Act) {
        self.stop_editing();
        match self.refusal(act) {
            Some(why) => self.tell(why),
            None => self.editing.hand.wanted = Some(act),
        }
    }

    /// Why nothing can be moved, or turned, now.
    fn refusal(&self, act: Act) -> Option<String> {
        let verb = act.verb();
        if let Some(picked) = self.picked() {
            let turns = matches!(picked.owner, Owner::Prop(_));
            return (act == Act::Turn && !turns).then(|| match picked.owner {
                Owner::Camera(_) => "A camera turns by moving its target (G)".to_owned(),
                _ => "A light shines to all sides: there is nothing to turn".to_owned(),
            });
        }
        if self.handles() == Handles::None {
            return Some(format!(
                "Choose Pose (P), IK (U) or Animate (A) to {verb} joints"
            ));
        }
        if !self.can_edit() {
            return Some("Only the motion can be edited, not the rest pose".to_owned());
        }
        let (Some(joint), Some(clip)) = (self.selected(), self.active_clip()) else {
            return Some(format!("Select something to {verb}: click it in the view"));
        };
        if self.handles() == Handles::Targets {
            return None;
        }
        let can = (joint.index() < clip.document.joints.len()).then(|| {
            let freedom = freedom(&clip.document, joint);
            match act {
                Act::Move => freedom.moves,
                Act::Turn => freedom.turns.is_some(),
            }
        });
        (can != Some(true)).then(|| {
            let name = clip.skeleton().unique_name(joint);
            let channels = match act {
                Act::Move => "position channels; IK (U) moves hands and feet",
                Act::Turn => "rotation channels",
            };
            format!("{name} has no {channels}")
        })
    }

    /// Takes what was asked for in hand, if anything was. `pointer` is where the pointer is, if it is
    /// anywhere.
    pub fn begin_in_hand(&mut self, pointer: Option<Pos2>, viewport: &Viewport) {
        let Some(act) = self.editing.hand.wanted.take() else {
            return;
        };
        self.show_handles_of(act);
        let Some(gizmo) = self.gizmo() else { return };
        let beside = viewport.project(gizmo.position);
        let beside = beside.map(|middle| middle + Vec2::new(RADIUS_POINTS, 0.0));
        // In the middle of what is turned, the pointer has no direction from it.
        for from in [pointer, beside].into_iter().flatten() {
            if self.grab(act.handle(None), from, viewport) {
                self.editing.hand.held = Some(InHand {
                    act,
                    axis: None,
                    from,
                    wanted_axis: None,
                });
                return;
            }
        }
    }

    /// The gizmo has the handles of what is done.
    fn show_handles_of(&mut self, act: Act) {
        if self.picked().is_some() {
            return;
        }
        let mut tools = self.tools();
        match (self.handles(), act) {
            (Handles::Targets, Act::Turn) => tools.ik_tool = Tool::MoveAndTurn,
            (Handles::Targets, Act::Move) => {}
            (_, Act::Turn) => tools.tool = Tool::Turn,
            (_, Act::Move) => tools.tool = Tool::Move,
        }
        self.set_tools(tools);
    }

    /// Whether something follows the pointer without a button.
    #[must_use]
    pub fn is_in_hand(&self) -> bool {
        self.editing.hand.held.is_some()
    }

    /// Holds what is in hand to an axis of the gizmo; asked for again, frees it.
    pub fn hold_to_axis(&mut self, axis: Axis) {
        if let Some(held) = &mut self.editing.hand.held {
            held.wanted_axis = Some((held.axis != Some(axis)).then_some(axis));
        }
    }

    /// Does what [`hold_to_axis`](Self::hold_to_axis) asked for: the drag begins anew from where it began,
    /// by the axis' own handle.
    pub fn follow_axis(&mut self, viewport: &Viewport) {
        let Some(mut held) = self.editing.hand.held else {
            return;
        };
        let Some(axis) = held.wanted_axis.take() else {
            return;
        };
        self.cancel_drag();
        let free = held.act.handle(held.axis);
        if self.grab(held.act.handle(axis), held.from, viewport) {
            held.axis = axis;
        } else if !self.grab(free, held.from, viewport) {
            return;
        }
        self.editing.hand.held = Some(held);
    }

    /// Stops following the pointer.
    pub(super) fn empty_hand(&mut self) {
        self.editing.hand = Hand::default();
    }
}
