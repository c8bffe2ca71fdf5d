//! The gizmo: handles in the picture that move and turn something by dragging.
//!
//! It knows nothing of what it moves: it is given a [`Placement`] in the world and gives back another.
//! [`shapes`] lays the handles out on the screen, [`pick`] finds the one under the pointer, a [`Drag`]
//! turns the pointer's way into a placement, [`draw()`] paints. Only the last needs a window.
//!
//! Space and units: world space as everywhere, the screen in egui's points. The gizmo has the same
//! size on the screen however far away it is ([`Gizmo::radius`]).

mod drag;
mod draw;
mod shapes;
mod viewport;

use glam::{Quat, Vec3};
use posekit::rotation::Axis;

pub use drag::{Amount, Drag, Snap};
pub use draw::{Sector, axis_color, draw};
pub use shapes::{Outline, Shape, pick, shapes};
pub use viewport::{Ray, Viewport};

/// Radius of the rings on the screen, points.
pub const RADIUS_POINTS: f32 = 86.0;

/// Where something is and how it is turned, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where it is, world space.
    pub position: Vec3,
    /// How it is turned, world from its own space.
    pub orientation: Quat,
}

impl Placement {
    /// At the origin, not turned.
    pub const ORIGIN: Self = Self {
        position: Vec3::ZERO,
        orientation: Quat::IDENTITY,
    };
}

/// Which handles a gizmo has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Three arrows, three planes, and the middle, which moves in the picture's plane.
    Move,
    /// Three rings, and one about the direction of view.
    #[default]
    Turn,
    /// Arrows, planes and rings.
    MoveAndTurn,
}

impl Tool {
    /// Whether it moves things.
    #[must_use]
    pub const fn moves(self) -> bool {
        matches!(self, Self::Move | Self::MoveAndTurn)
    }

    /// Whether it turns things.
    #[must_use]
    pub const fn turns(self) -> bool {
        matches!(self, Self::Turn | Self::MoveAndTurn)
    }
}

/// A handle of the gizmo.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Handle {
    /// The middle: moves in the picture's plane.
    MoveOnScreen,
    /// A square: moves in the plane across an axis.
    MoveAcross(Axis),
    /// An arrow: moves along an axis.
    MoveAlong(Axis),
    /// A ring: turns about an axis.
    TurnAbout(Axis),
    /// The outer ring: turns about the direction of view.
    TurnOnScreen,
}

impl Handle {
    /// The axis it is about, if it is about one.
    #[must_use]
    pub const fn axis(self) -> Option<Axis> {
        match self {
            Self::MoveAcross(axis) | Self::MoveAlong(axis) | Self::TurnAbout(axis) => Some(axis),
            Self::MoveOnScreen | Self::TurnOnScreen => None,
        }
    }

    /// Whether it turns.
    #[must_use]
    pub const fn turns(self) -> bool {
        matches!(self, Self::TurnAbout(_) | Self::TurnOnScreen)
    }
}

/// A gizmo: where it stands, how its axes lie, which handles it has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gizmo {
    /// Where it stands, world space.
    pub position: Vec3,
    /// The axes of its handles, world from gizmo.
    pub axes: Quat,
    /// Which handles it has.
    pub tool: Tool,
}

impl Gizmo {
    /// The length in the world that [`RADIUS_POINTS`] are at the gizmo.
    #[must_use]
    pub fn radius(&self, viewport: &Viewport) -> f32 {
        viewport.length_of(RADIUS_POINTS, self.position)
    }

    /// The direction of an axis, world space, unit length.
    #[must_use]
    pub fn direction(&self, axis: Axis) -> Vec3 {
        self.axes * axis.unit().as_vec3()
    }
}
