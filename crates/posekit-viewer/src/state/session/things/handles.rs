//! The gizmo on a camera, light or prop that is picked.

use egui::Pos2;
use glam::{Quat, Vec3};

use super::super::{Handles, Session};
use super::{Held, tidy};
use crate::gizmo::{Drag, Gizmo, Handle, Placement, Snap, Tool, Viewport};
use crate::state::animate::{Lane, LaneValue, Owner};
use crate::state::mode::Space;
use crate::state::things::{Part, Picked};

impl Session {
    /// The gizmo of what is picked.
    pub(in super::super) fn thing_gizmo(&self) -> Option<Gizmo> {
        let picked = self.picked().filter(|_| self.handles() != Handles::None)?;
        let placement = self.placement_of(picked)?;
        let is_prop = matches!(picked.owner, Owner::Prop(_));
        let is_local = *self.tools().space_with(Handles::Joints) == Space::Local;
        Some(Gizmo {
            position: placement.position,
            axes: if is_prop && is_local {
                placement.orientation
            } else {
                Quat::IDENTITY
            },
            tool: if is_prop {
                Tool::MoveAndTurn
            } else {
                Tool::Move
            },
        })
    }

    /// Where what is picked stands.
    pub(in super::super) fn picked_place(&self) -> Option<Vec3> {
        Some(self.placement_of(self.picked()?)?.position)
    }

    fn placement_of(&self, picked: Picked) -> Option<Placement> {
        let LaneValue::Vector(position) = self.value_of(picked.lane()?)? else {
            return None;
        };
        let orientation = match picked.owner {
            Owner::Prop(index) => match self.value_of(Lane::PropRotation(index))? {
                LaneValue::Orientation(orientation) => orientation.as_quat().normalize(),
                _ => return None,
            },
            _ => Quat::IDENTITY,
        };
        let placement = Placement {
            position: position.as_vec3(),
            orientation,
        };
        placement.position.is_finite().then_some(placement)
    }

    /// The drag of a thing that is held.
    pub(in super::super) fn thing_drag(&self) -> Option<&Drag> {
        self.things.held.as_ref().map(|held| &held.drag)
    }

    /// Takes a handle of the gizmo on a thing. `None` when nothing is picked.
    pub(in super::super) fn grab_thing(
        &mut self,
        handle: Handle,
        pointer: Pos2,
        viewport: &Viewport,
    ) -> Option<bool> {
        let picked = self.picked()?;
        let taken = self.thing_gizmo().zip(self.placement_of(picked));
        let drag =
            taken.and_then(|(gizmo, start)| Drag::begin(gizmo, handle, start, pointer, viewport));
        let Some(drag) = drag else {
            return Some(false);
        };
        self.things.held = Some(Held {
            drag,
            picked,
            before: self.things.pending.clone(),
        });
        Some(true)
    }

    /// Follows the pointer with a thing that is held. False when none is.
    pub(in super::super) fn drag_thing(
        &mut self,
        pointer: Pos2,
        viewport: &Viewport,
        snap: Option<Snap>,
    ) -> bool {
        let Some(mut held) = self.things.held.take() else {
            return false;
        };
        let before = held.drag.placement();
        let placement = held.drag.update(pointer, viewport, snap);
        if placement != before {
            self.hold_values(values_at(&held, placement));
        }
        self.things.held = Some(held);
        true
    }

    /// Lets a thing go that is held: where it is now is set. False when none is.
    pub(in super::super) fn drop_thing(&mut self) -> bool {
        let Some(held) = self.things.held.take() else {
            return false;
        };
        let values = values_at(&held, held.drag.placement());
        self.things.pending = held.before;
        let verb = if held.drag.handle().turns() {
            "Turn"
        } else {
            "Move"
        };
        let name = self.name_of(held.picked.owner).unwrap_or_default();
        let of = match held.picked.part {
            Part::Body => name.to_lowercase(),
            Part::Target => format!("the target of {}", name.to_lowercase()),
        };
        self.set_values(&format!("{verb} {of}"), &values, None);
        self.surround();
        true
    }

    /// Lets a thing go without effect. True when one was held.
    pub(in super::super) fn cancel_thing(&mut self) -> bool {
        let Some(held) = self.things.held.take() else {
            return false;
        };
        self.things.pending = held.before;
        self.surround();
        true
    }
}

/// What a placement sets of the thing that is held: only what its handle moves.
fn values_at(held: &Held, placement: Placement) -> Vec<(Lane, LaneValue)> {
    if held.drag.handle().turns() {
        let Owner::Prop(index) = held.picked.owner else {
            return Vec::new();
        };
        let orientation = placement.orientation.as_dquat().normalize();
        return vec![(
            Lane::PropRotation(index),
            LaneValue::Orientation(orientation),
        )];
    }
    let lane = held.picked.lane();
    let at = LaneValue::Vector(tidy(placement.position));
    lane.map(|lane| (lane, at)).into_iter().collect()
}
