//! The moving part of a figure as a solver sees it: pivots from the base outward, in double precision.
//!
//! Every pivot is the local rotation (or slide) of one joint. What lies between two pivots is rigid, so a
//! joint that may not move costs nothing. Where the way from the base climbs from a joint to its parent,
//! the parent's side is the one that moves, and the joint's local rotation is the inverse of the turn.
//!
//! **State.** `turns[k]` is the rotation, in the world, that pivot `k`'s outer link has made since the start;
//! so all of it starts as the identity, and vectors between points of a link are kept as they were at the
//! start. Rigid motion is exact by construction: bones cannot change their lengths.

mod build;
mod goal;
mod motion;
mod state;

use glam::{DQuat, DVec3};

use super::limit::JointLimit;
use crate::skeleton::JointId;

pub(crate) use build::build;
pub(crate) use goal::Goal;
pub(crate) use state::State;

/// No pivot: a link that does not move.
pub(crate) const NONE: u32 = u32::MAX;

/// A joint that moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pivot {
    /// The joint whose local transform this is.
    pub(crate) joint: JointId,
    /// The next pivot towards the base; [`NONE`] where the base itself comes next.
    pub(crate) parent: u32,
    /// Whether the way from the base climbs over this joint, from it to its parent.
    pub(crate) climbs: bool,
    /// Whether the pivot is a root that may be carried anywhere.
    pub(crate) is_afloat: bool,
    /// Whether the joint is an End Site, which only a chain that starts there may turn about.
    pub(crate) is_end_site: bool,
    /// Whether the joint turns; otherwise it slides, or only floats.
    pub(crate) turns: bool,
    /// What the joint can do.
    pub(crate) limit: JointLimit,
    /// How much of its motion it gives, from 0 to 1: one less its stiffness.
    pub(crate) give: f64,
    /// Orientation, at the start, of the inner link (towards the base): for a climbing pivot the
    /// joint's own, otherwise its parent's.
    pub(crate) inner_start: DQuat,
    /// Orientation, at the start, of the outer link.
    pub(crate) outer_start: DQuat,
    /// The joint's local rotation at rest.
    pub(crate) rest: DQuat,
    /// Where it was at the start.
    pub(crate) position_start: DVec3,
    /// From the pivot before it to this one, at the start, in the world. From the origin where there is
    /// none before it.
    pub(crate) offset: DVec3,
    /// The direction in which the outer link slides, at the start, in the world; zero if it does not.
    pub(crate) slide_axis: DVec3,
    /// How far the joint had slid from its rest at the start.
    pub(crate) slid_at_start: f64,
}

/// The point that is to reach a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effector {
    /// The pivot whose outer link it is attached to; [`NONE`] if it does not move.
    pub(crate) pivot: u32,
    /// From that pivot to the point, at the start, in the world; from the origin if there is none.
    pub(crate) offset: DVec3,
    /// The effector's orientation at the start.
    pub(crate) orientation_start: DQuat,
    /// Whether the pivot is the effector's own joint, so that it can be oriented without regard to the
    /// rest of the chain.
    pub(crate) is_own_pivot: bool,
    /// Where the pivots on the way from the base lie in [`Linkage::paths`].
    pub(crate) path_start: usize,
    /// Where they end.
    pub(crate) path_end: usize,
}

/// The moving part of a figure.
#[derive(Clone, Debug, Default)]
pub(crate) struct Linkage {
    /// A pivot comes after its parent.
    pub(crate) pivots: Vec<Pivot>,
    /// One for each target.
    pub(crate) effectors: Vec<Effector>,
    /// Pivots from the base to each effector, one way after another.
    pub(crate) paths: Vec<u32>,
    /// By pivot: how its outer link has turned since the start, in the world.
    pub(crate) turns: Vec<DQuat>,
    /// By pivot: where it is.
    pub(crate) positions: Vec<DVec3>,
    /// By pivot: how far it has slid since the start.
    pub(crate) slides: Vec<f64>,
    /// By pivot: how far a floating root has been carried since the start.
    pub(crate) shifts: Vec<DVec3>,
    /// The pivot whose outer link holds the root of a figure that has its base elsewhere.
    pub(crate) root_pivot: u32,
    /// Scratch of [`build`].
    builder: build::Builder,
}
