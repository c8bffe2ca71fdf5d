//! A drag: the pointer's way on the screen becomes a movement or a turn in the world.
//!
//! How it is measured is decided once, when the handle is taken, so that nothing jumps on the way.
//! Arrows: the pointer is first brought onto the arrow's line on the screen, and the point of the line
//! in space that is seen there is taken. Squares and the middle: where the pointer's ray meets the
//! plane. Rings seen from above: the angle of that point about the ring's middle. Rings seen from
//! their edge: the pointer's way along the ring, one radian for a radius. The outer ring: the
//! pointer's angle about the middle on the screen.
//!
//! Degenerate views: where the pointer's ray runs along the line or plane, or meets it behind the
//! eye, the last place holds; nothing goes farther than `FARTHEST` times the eye's distance.

use egui::{Pos2, Vec2};
use glam::{Quat, Vec3};

use super::shapes::others;
use super::{Gizmo, Handle, Placement, RADIUS_POINTS, Viewport};

/// Nothing is moved farther at once than this many times its distance from the eye.
pub(super) const FARTHEST: f32 = 4.0;

/// A ring seen from above at least this much (a cosine) is turned by the angle about its middle.
const WHEEL_FACING: f32 = 0.25;

/// Shorter arrows on the screen, points, move nothing.
const SHORTEST_ARROW: f32 = 3.0;

/// Nearer to the middle than this, points, a pointer has no direction from it.
const BLIND_POINTS: f32 = 4.0;

/// Steps that movements and turns are rounded to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// Step of movements, in the world's unit of length.
    pub length: f32,
    /// Step of turns, radians.
    pub angle_rad: f32,
}

/// How much a drag has moved or turned, for people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// Along the gizmo's axes, in the world's unit of length.
    Moved(Vec3),
    /// About `axis` (world space), beginning at `from` (unit length, across the axis), radians; it
    /// may be more than a turn.
    Turned {
        /// The axis.
        axis: Vec3,
        /// Where the turn began.
        from: Vec3,
        /// By how much.
        angle_rad: f32,
    },
}

/// How the pointer's way is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// Along a line: its direction, and how far along it was taken.
    Line { direction: Vec3, taken_at: f32 },
    /// In a plane: its normal, and where it was taken.
    Plane { normal: Vec3, taken_at: Vec3 },
    /// About an axis, by the point where the ray meets the plane across it.
    Wheel { axis: Vec3, from: Vec3 },
    /// About an axis that lies in the picture, by the way in a direction on the screen.
    Lever {
        axis: Vec3,
        from: Vec3,
        direction: Vec2,
    },
    /// About the direction of view, by the angle on the screen.
    Dial { axis: Vec3, from: Vec3 },
}

/// A handle that is being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag {
    handle: Handle,
    gizmo: Gizmo,
    start: Placement,
    taken: Pos2,
    way: Way,
    /// The pointer's angle when it was looked at last, radians.
    last_angle_rad: f32,
    moved: Vec3,
    turned_rad: f32,
    snap: Option<Snap>,
}

impl Drag {
    /// Takes a handle of a gizmo with the pointer, to move what is at `start`. `None` where the
    /// handle cannot be taken in this view.
    #[must_use]
    pub fn begin(
        gizmo: Gizmo,
        handle: Handle,
        start: Placement,
        pointer: Pos2,
        viewport: &Viewport,
    ) -> Option<Self> {
        let eye = viewport.toward_eye(gizmo.position);
        let way = match handle {
            Handle::MoveAlong(axis) => {
                let direction = gizmo.direction(axis);
                let taken_at = along_line(gizmo.position, direction, pointer, viewport)?;
                Way::Line {
                    direction,
                    taken_at,
                }
            }
            Handle::MoveAcross(axis) => in_plane(&gizmo, gizmo.direction(axis), pointer, viewport)?,
            Handle::MoveOnScreen => {
                let (_, _, back) = viewport.camera().axes();
                in_plane(&gizmo, back, pointer, viewport)?
            }
            Handle::TurnAbout(axis) => ring(&gizmo, gizmo.direction(axis), eye, pointer, viewport)?,
            Handle::TurnOnScreen => {
                let (right, up, _) = viewport.camera().axes();
                let (sin, cos) = libm::sincosf(dial_angle(&gizmo, pointer, viewport)?);
                let from = right * cos + up * sin;
                let from = (from - eye * from.dot(eye)).normalize_or(right);
                Way::Dial { axis: eye, from }
            }
        };
        let mut drag = Self {
            handle,
            gizmo,
            start,
            taken: pointer,
            way,
            last_angle_rad: 0.0,
            moved: Vec3::ZERO,
            turned_rad: 0.0,
            snap: None,
        };
        drag.last_angle_rad = drag.angle(pointer, viewport).unwrap_or(0.0);
        Some(drag)
    }

    /// The handle.
    #[must_use]
    pub fn handle(&self) -> Handle {
        self.handle
    }

    /// The gizmo as it was when the handle was taken.
    #[must_use]
    pub fn gizmo(&self) -> &Gizmo {
        &self.gizmo
    }

    /// Where what is moved was when the handle was taken.
    #[must_use]
    pub fn start(&self) -> Placement {
        self.start
    }

    /// Follows the pointer. Returns where what is moved is now.
    pub fn update(&mut self, pointer: Pos2, viewport: &Viewport, snap: Option<Snap>) -> Placement {
        self.snap = snap;
        let middle = self.gizmo.position;
        let farthest = FARTHEST * viewport.distance_to(middle);
        match self.way {
            Way::Line {
                direction,
                taken_at,
            } => {
                if let Some(at) = along_line(middle, direction, pointer, viewport) {
                    self.moved = direction * (at - taken_at).clamp(-farthest, farthest);
                }
            }
            Way::Plane { normal, taken_at } => {
                if let Some(at) = viewport.ray(pointer).meets_plane(taken_at, normal) {
                    self.moved = (at - taken_at).clamp_length_max(farthest);
                }
            }
            Way::Lever { direction, .. } => {
                self.turned_rad = (pointer - self.taken).dot(direction) / RADIUS_POINTS;
            }
            Way::Wheel { .. } | Way::Dial { .. } => {
                if let Some(angle) = self.angle(pointer, viewport) {
                    self.turned_rad += wrapped(angle - self.last_angle_rad);
                    self.last_angle_rad = angle;
                }
            }
        }
        self.placement()
    }

    /// Where what is moved is now.
    #[must_use]
    pub fn placement(&self) -> Placement {
        match self.amount() {
            Amount::Moved(along) => Placement {
                position: self.start.position + self.gizmo.axes * along,
                ..self.start
            },
            Amount::Turned {
                axis, angle_rad, ..
            } => {
                let (sin, cos) = libm::sincosf(angle_rad / 2.0);
                let (x, y, z) = (axis * sin).into();
                let turn = Quat::from_xyzw(x, y, z, cos);
                // Turned about the gizmo's middle, which need not be where the thing itself is.
                let arm = self.start.position - self.gizmo.position;
                Placement {
                    position: self.gizmo.position + turn * arm,
                    orientation: (turn * self.start.orientation).normalize(),
                }
            }
        }
    }

    /// How much it has moved or turned, rounded to the steps.
    #[must_use]
    pub fn amount(&self) -> Amount {
        match self.way {
            Way::Line { .. } | Way::Plane { .. } => {
                let along = self.gizmo.axes.inverse() * self.moved;
                Amount::Moved(match self.snap {
                    Some(snap) => along.map(|value| rounded(value, snap.length)),
                    None => along,
                })
            }
            Way::Wheel { axis, from }
            | Way::Lever { axis, from, .. }
            | Way::Dial { axis, from } => {
                let angle_rad = match self.snap {
                    Some(snap) => rounded(self.turned_rad, snap.angle_rad),
                    None => self.turned_rad,
                };
                Amount::Turned {
                    axis,
                    from,
                    angle_rad,
                }
            }
        }
    }

    /// The pointer's angle about the middle, for ways that have one.
    fn angle(&self, pointer: Pos2, viewport: &Viewport) -> Option<f32> {
        match self.way {
            Way::Wheel { axis, from } => {
                let middle = self.gizmo.position;
                let at = viewport.ray(pointer).meets_plane(middle, axis)? - middle;
                let blind = viewport.length_of(BLIND_POINTS, middle);
                (at.length() > blind).then(|| libm::atan2f(at.dot(axis.cross(from)), at.dot(from)))
            }
            Way::Dial { .. } => dial_angle(&self.gizmo, pointer, viewport),
            Way::Line { .. } | Way::Plane { .. } | Way::Lever { .. } => None,
        }
    }
}

/// How far along a line the pointer is: it need not be on it.
fn along_line(point: Vec3, direction: Vec3, pointer: Pos2, viewport: &Viewport) -> Option<f32> {
    let step = viewport.length_of(RADIUS_POINTS, point);
    let foot = viewport.project(point)?;
    let on_screen = viewport.project(point + direction * step)? - foot;
    if on_screen.length() < SHORTEST_ARROW {
        return None;
    }
    let line = on_screen.normalized();
    let nearest = foot + line * (pointer - foot).dot(line);
    viewport.ray(nearest).nearest_on_line(point, direction)
}

fn in_plane(gizmo: &Gizmo, normal: Vec3, pointer: Pos2, viewport: &Viewport) -> Option<Way> {
    let taken_at = viewport.ray(pointer).meets_plane(gizmo.position, normal)?;
    Some(Way::Plane { normal, taken_at })
}

fn ring(gizmo: &Gizmo, axis: Vec3, eye: Vec3, pointer: Pos2, viewport: &Viewport) -> Option<Way> {
    let middle = gizmo.position;
    let facing = axis.dot(eye);
    if facing.abs() >= WHEEL_FACING {
        let at = viewport.ray(pointer).meets_plane(middle, axis)?;
        let from = (at - middle).normalize_or(others_of(axis));
        return Some(Way::Wheel { axis, from });
    }
    // The ring's nearest point, which moves across the view when the ring turns.
    let from = (eye - axis * facing).normalize_or(others_of(axis));
    let onward = axis.cross(from) * viewport.length_of(RADIUS_POINTS, middle);
    let direction = (viewport.project(middle + onward)? - viewport.project(middle)?).normalized();
    Some(Way::Lever {
        axis,
        from,
        direction,
    })
}

/// Some direction across an axis.
fn others_of(axis: Vec3) -> Vec3 {
    axis.any_orthonormal_vector()
}

/// The pointer's angle about the middle on the screen, counterclockwise from the right.
fn dial_angle(gizmo: &Gizmo, pointer: Pos2, viewport: &Viewport) -> Option<f32> {
    let out = pointer - viewport.project(gizmo.position)?;
    (out.length() > BLIND_POINTS).then(|| libm::atan2f(-out.y, out.x))
}

/// The same angle within half a turn of zero.
fn wrapped(angle_rad: f32) -> f32 {
    use std::f32::consts::{PI, TAU};
    let turned = (angle_rad + PI).rem_euclid(TAU) - PI;
    if turned.is_finite() { turned } else { 0.0 }
}

/// The multiple of a step that is nearest.
fn rounded(value: f32, step: f32) -> f32 {
    if step > 0.0 {
        (value / step).round() * step
    } else {
        value
    }
}

/// The two axes that a square's movement is told in.
#[must_use]
pub(super) fn axes_told(handle: Handle) -> Vec<posekit::rotation::Axis> {
    match handle {
        Handle::MoveAlong(axis) => vec![axis],
        Handle::MoveAcross(axis) => others(axis).to_vec(),
        _ => posekit::rotation::Axis::ALL.to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use egui::vec2;
    use posekit::rotation::Axis;

    use super::super::Tool;
    use super::super::viewport::tests::viewport;
    use super::*;

    const START: Placement = Placement {
        position: Vec3::new(0.2, 0.1, -0.1),
        orientation: Quat::IDENTITY,
    };

    fn gizmo() -> Gizmo {
        Gizmo {
            position: START.position,
            axes: Quat::from_xyzw(0.1, 0.3, -0.2, 0.927_361_85).normalize(),
            tool: Tool::MoveAndTurn,
        }
    }

    /// Takes the handle at one point of the world and brings the pointer over another.
    fn dragged(handle: Handle, from: Vec3, to: Vec3, view: &Viewport) -> Drag {
        let pointer = |point| view.project(point).expect("in front of the eye");
        let mut drag =
            Drag::begin(gizmo(), handle, START, pointer(from), view).expect("it can be taken");
        drag.update(pointer(to), view, None);
        drag
    }

    #[test]
    fn what_is_dragged_stays_under_the_pointer() {
        let view = viewport(0.5, 0.4);
        let gizmo = gizmo();
        for axis in Axis::ALL {
            let direction = gizmo.direction(axis);
            let from = START.position + direction * 0.2;
            let by = direction * 0.45;
            let drag = dragged(Handle::MoveAlong(axis), from, from + by, &view);
            let away = drag.placement().position - (START.position + by);
            assert!(away.length() < 1e-4, "{axis:?}: {away}");
            let [u, v] = others(axis).map(|other| gizmo.direction(other));
            let by = u * 0.3 - v * 0.2;
            let drag = dragged(Handle::MoveAcross(axis), from, from + by, &view);
            // The square is taken where it is seen: the point need not lie in its plane.
            let moved = drag.placement().position - START.position;
            assert!(moved.dot(direction).abs() < 1e-4, "it stays in its plane");
            let on_plane = START.position + u * 0.1;
            let drag = dragged(Handle::MoveAcross(axis), on_plane, on_plane + by, &view);
            let away = drag.placement().position - (START.position + by);
            assert!(away.length() < 1e-4, "{axis:?}: {away}");
        }
    }

    #[test]
    fn a_ring_turns_by_the_angle_that_the_pointer_goes_about_it() {
        let view = viewport(0.5, 0.4);
        let gizmo = gizmo();
        let angle = 0.8_f32;
        for axis in Axis::ALL {
            let normal = gizmo.direction(axis);
            let eye = view.toward_eye(START.position);
            if normal.dot(eye).abs() < WHEEL_FACING {
                continue;
            }
            let arm = gizmo.direction(others(axis)[0]) * gizmo.radius(&view);
            let turned = Quat::from_axis_angle(normal, angle) * arm;
            let (from, to) = (START.position + arm, START.position + turned);
            let drag = dragged(Handle::TurnAbout(axis), from, to, &view);
            let wanted = Quat::from_axis_angle(normal, angle);
            let gap = drag.placement().orientation.angle_between(wanted);
            assert!(gap < 2e-3, "{axis:?}: {gap}");
            assert_eq!(drag.placement().position, START.position);
        }
    }

    #[test]
    fn a_ring_seen_from_its_edge_turns_like_a_lever() {
        let view = viewport(0.0, 0.0);
        let gizmo = Gizmo {
            position: Vec3::ZERO,
            axes: Quat::IDENTITY,
            tool: Tool::Turn,
        };
        let middle = view.project(Vec3::ZERO).expect("in front");
        let start = Placement::ORIGIN;
        // About Y, seen from +Z: the near side goes to the right when it turns counterclockwise.
        let handle = Handle::TurnAbout(Axis::Y);
        let mut drag = Drag::begin(gizmo, handle, start, middle, &view).expect("it can be taken");
        for step in 1..=20_u8 {
            drag.update(middle + vec2(f32::from(step) * 4.3, 11.0), &view, None);
        }
        let Amount::Turned { angle_rad, .. } = drag.amount() else {
            panic!("it turns");
        };
        assert!((angle_rad - 1.0).abs() < 1e-4, "{angle_rad}");
        let front = drag.placement().orientation * Vec3::Z;
        assert!(front.x > 0.8, "{front}");
    }

    #[test]
    fn the_outer_ring_counts_whole_turns() {
        let view = viewport(0.3, -0.2);
        let gizmo = gizmo();
        let middle = view.project(START.position).expect("in front");
        let at = |angle: f32| {
            let (sin, cos) = angle.sin_cos();
            middle + vec2(cos, -sin) * 100.0
        };
        let handle = Handle::TurnOnScreen;
        let mut drag = Drag::begin(gizmo, handle, START, at(0.0), &view).expect("it can be taken");
        for step in 1..=80_u8 {
            drag.update(at(f32::from(step) * 0.1), &view, None);
        }
        let Amount::Turned {
            angle_rad, axis, ..
        } = drag.amount()
        else {
            panic!("it turns");
        };
        assert!((angle_rad - 8.0).abs() < 1e-3, "{angle_rad}");
        assert!(axis.dot(view.toward_eye(START.position)) > 0.999);
    }

    #[test]
    fn steps_are_kept() {
        let view = viewport(0.5, 0.4);
        let snap = Some(Snap {
            length: 0.25,
            angle_rad: 15.0_f32.to_radians(),
        });
        let gizmo = gizmo();
        let direction = gizmo.direction(Axis::X);
        let pointer = |point| view.project(point).expect("in front of the eye");
        let from = pointer(START.position);
        let mut drag = Drag::begin(gizmo, Handle::MoveAlong(Axis::X), START, from, &view)
            .expect("it can be taken");
        drag.update(pointer(START.position + direction * 0.6), &view, snap);
        let Amount::Moved(moved) = drag.amount() else {
            panic!("it moves");
        };
        assert!(
            (moved - Vec3::new(0.5, 0.0, 0.0)).length() < 1e-6,
            "{moved}"
        );
        assert_eq!(rounded(0.31, 0.0), 0.31);
    }

    #[test]
    fn nothing_flies_away_at_grazing_angles() {
        for (yaw, pitch) in [
            (0.0, 0.0),
            (1.57, 0.0),
            (0.02, 0.01),
            (0.3, 1.57),
            (3.1, -0.6),
        ] {
            let view = viewport(yaw, pitch);
            let gizmo = Gizmo {
                position: Vec3::ZERO,
                axes: Quat::IDENTITY,
                tool: Tool::MoveAndTurn,
            };
            let handles = Axis::ALL.into_iter().flat_map(|axis| {
                [
                    Handle::MoveAlong(axis),
                    Handle::MoveAcross(axis),
                    Handle::TurnAbout(axis),
                ]
            });
            for handle in handles.chain([Handle::MoveOnScreen, Handle::TurnOnScreen]) {
                let pointer = view.project(Vec3::ZERO).expect("in front") + vec2(20.0, 9.0);
                let start = Placement::ORIGIN;
                let Some(mut drag) = Drag::begin(gizmo, handle, start, pointer, &view) else {
                    continue;
                };
                for (x, y) in [
                    (1e5, 3.0),
                    (-1e5, 2.0),
                    (0.0, 1e5),
                    (7.0, -1e5),
                    (-20.0, -9.0),
                ] {
                    let now = drag.update(pointer + vec2(x, y), &view, None);
                    assert!(now.position.is_finite() && now.orientation.is_normalized());
                    let most = FARTHEST * view.distance_to(Vec3::ZERO) * 1.001;
                    assert!(now.position.length() <= most, "{handle:?}: {now:?}");
                }
            }
        }
    }

    #[test]
    fn coming_back_ends_where_it_began() {
        let view = viewport(0.5, 0.4);
        for handle in [
            Handle::MoveAlong(Axis::Z),
            Handle::MoveAcross(Axis::Y),
            Handle::MoveOnScreen,
            Handle::TurnAbout(Axis::Y),
            Handle::TurnOnScreen,
        ] {
            let taken = view.project(START.position).expect("in front") + vec2(40.0, 25.0);
            let mut drag =
                Drag::begin(gizmo(), handle, START, taken, &view).expect("it can be taken");
            for (x, y) in [(30.0, 5.0), (60.0, 40.0), (10.0, 60.0), (0.0, 0.0)] {
                drag.update(taken + vec2(x, y), &view, None);
            }
            let end = drag.placement();
            assert!(end.position.distance(START.position) < 1e-5, "{handle:?}");
            assert!(end.orientation.angle_between(START.orientation) < 1e-3);
        }
    }
}
