//! The handles as shapes on the screen: what is drawn is what is picked.

use egui::{Pos2, Vec2};
use glam::Vec3;
use posekit::rotation::Axis;

use super::{Gizmo, Handle, Viewport};
use crate::state::pick::distance_to_segment;

/// How near to a handle's line the pointer must be, points.
const REACH: f32 = 7.0;

/// Radius of the middle, points.
pub(super) const MIDDLE_POINTS: f32 = 8.0;

/// Radius of the outer ring, in radii of the gizmo.
const OUTER: f32 = 1.16;

/// Where an arrow begins and where its head ends, in radii of the gizmo.
const ARROW: (f32, f32) = (0.17, 1.0);
/// As [`ARROW`], inside rings.
const ARROW_IN_RINGS: (f32, f32) = (0.17, 0.82);

/// Middle and half width of a plane's square, in radii of the gizmo.
const SQUARE: (f32, f32) = (0.42, 0.11);

/// Corners of a ring.
const RING_CORNERS: usize = 96;

/// An arrow whose direction makes a smaller angle with the view (a sine) is not there; from the
/// second on it is whole.
const ARROW_SHOWS: (f32, f32) = (0.10, 0.26);

/// As [`ARROW_SHOWS`], for planes: the cosine between their normal and the view.
const SQUARE_SHOWS: (f32, f32) = (0.14, 0.30);

/// A ring seen this much from above (a cosine) has no far half.
const RING_FACES: f32 = 0.985;

/// What a handle looks like on the screen.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// A disc.
    Disc(Pos2),
    /// A square in space.
    Square([Pos2; 4]),
    /// An arrow from its foot to its tip.
    Arrow(Pos2, Pos2),
    /// A ring: its corners, and whether each is on the near side.
    Ring(Vec<(Pos2, bool)>),
}

/// A handle laid out on the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The handle.
    pub handle: Handle,
    /// Its outline.
    pub outline: Outline,
    /// How much of it is there, 0 to 1: handles seen from an end fade.
    pub opacity: f32,
}

/// The handles that can be seen, those behind first.
#[must_use]
pub fn shapes(gizmo: &Gizmo, viewport: &Viewport) -> Vec<Shape> {
    let Some(middle) = viewport.project(gizmo.position) else {
        return Vec::new();
    };
    let mut shapes = Vec::with_capacity(11);
    if gizmo.tool.turns() {
        for axis in Axis::ALL {
            shapes.extend(ring(gizmo, viewport, axis));
        }
        shapes.extend(outer_ring(gizmo, viewport));
    }
    if gizmo.tool.moves() {
        let mut across: Vec<Shape> = Axis::ALL
            .into_iter()
            .filter_map(|axis| square(gizmo, viewport, axis))
            .collect();
        shapes.append(&mut across);
        let eye = viewport.toward_eye(gizmo.position);
        let mut axes = Axis::ALL;
        // Arrows that come towards the viewer lie over those that go away.
        axes.sort_by(|a, b| {
            let nearness = |axis: &Axis| gizmo.direction(*axis).dot(eye);
            nearness(a).total_cmp(&nearness(b))
        });
        shapes.extend(
            axes.into_iter()
                .filter_map(|axis| arrow(gizmo, viewport, axis)),
        );
        shapes.push(Shape {
            handle: Handle::MoveOnScreen,
            outline: Outline::Disc(middle),
            opacity: 1.0,
        });
    }
    shapes
}

/// The handle under a place of the screen.
///
/// The middle is taken before squares, squares before arrows and rings, and of those the nearest.
/// Far halves of rings and handles that are hardly there are not taken.
#[must_use]
pub fn pick(shapes: &[Shape], place: Pos2) -> Option<Handle> {
    let ranked = shapes.iter().filter(|shape| shape.opacity > 0.3);
    let ranked = ranked.filter_map(|shape| {
        let distance = distance_to(&shape.outline, place);
        let rank = match shape.outline {
            Outline::Disc(_) => 0,
            Outline::Square(_) => 1,
            Outline::Arrow(..) | Outline::Ring(_) => 2,
        };
        (distance <= REACH).then_some((rank, distance, shape.handle))
    });
    ranked
        .min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)))
        .map(|(_, _, handle)| handle)
}

/// Distance from a place to what can be taken of an outline; 0 inside of it.
fn distance_to(outline: &Outline, place: Pos2) -> f32 {
    let segment = |a: Pos2, b: Pos2| {
        let glam = |p: Pos2| glam::Vec2::new(p.x, p.y);
        distance_to_segment(glam(place), glam(a), glam(b))
    };
    match outline {
        Outline::Disc(middle) => (middle.distance(place) - MIDDLE_POINTS + REACH).max(0.0),
        Outline::Arrow(foot, tip) => segment(*foot, *tip),
        Outline::Square(corners) => {
            if is_inside(corners, place) {
                0.0
            } else {
                f32::INFINITY
            }
        }
        Outline::Ring(corners) => {
            let near = corners.windows(2).filter(|pair| pair[0].1 && pair[1].1);
            near.map(|pair| segment(pair[0].0, pair[1].0))
                .fold(f32::INFINITY, f32::min)
        }
    }
}

/// Whether a place is inside a convex quadrilateral.
fn is_inside(corners: &[Pos2; 4], place: Pos2) -> bool {
    let turn = |a: Pos2, b: Pos2| {
        let (edge, to): (Vec2, Vec2) = (b - a, place - a);
        edge.x * to.y - edge.y * to.x
    };
    let turns = [0, 1, 2, 3].map(|i| turn(corners[i], corners[(i + 1) % 4]));
    turns.iter().all(|&t| t >= 0.0) || turns.iter().all(|&t| t <= 0.0)
}

fn fade(value: f32, (none, whole): (f32, f32)) -> f32 {
    ((value - none) / (whole - none)).clamp(0.0, 1.0)
}

fn arrow(gizmo: &Gizmo, viewport: &Viewport, axis: Axis) -> Option<Shape> {
    let direction = gizmo.direction(axis);
    let eye = viewport.toward_eye(gizmo.position);
    let sine = direction.cross(eye).length();
    let radius = gizmo.radius(viewport);
    let (from, to) = if gizmo.tool.turns() {
        ARROW_IN_RINGS
    } else {
        ARROW
    };
    let foot = viewport.project(gizmo.position + direction * (from * radius))?;
    let tip = viewport.project(gizmo.position + direction * (to * radius))?;
    Some(Shape {
        handle: Handle::MoveAlong(axis),
        outline: Outline::Arrow(foot, tip),
        opacity: fade(sine, ARROW_SHOWS),
    })
    .filter(|shape| shape.opacity > 0.0)
}

/// The other two axes.
pub(super) fn others(axis: Axis) -> [Axis; 2] {
    match axis {
        Axis::X => [Axis::Y, Axis::Z],
        Axis::Y => [Axis::Z, Axis::X],
        Axis::Z => [Axis::X, Axis::Y],
    }
}

/// The square stands in the quarter of its plane that is turned to the viewer.
fn square(gizmo: &Gizmo, viewport: &Viewport, axis: Axis) -> Option<Shape> {
    let eye = viewport.toward_eye(gizmo.position);
    let radius = gizmo.radius(viewport);
    let [u, v] = others(axis).map(|other| {
        let direction = gizmo.direction(other);
        // A hair of preference for the positive side, so that it does not flicker.
        let side = if direction.dot(eye) < -0.05 {
            -1.0
        } else {
            1.0
        };
        direction * (side * radius)
    });
    let (middle, half) = SQUARE;
    let corner = |a: f32, b: f32| {
        let at = |side: f32| middle + side * half;
        viewport.project(gizmo.position + u * at(a) + v * at(b))
    };
    let corners = [
        corner(-1.0, -1.0)?,
        corner(1.0, -1.0)?,
        corner(1.0, 1.0)?,
        corner(-1.0, 1.0)?,
    ];
    let facing = gizmo.direction(axis).dot(eye).abs();
    Some(Shape {
        handle: Handle::MoveAcross(axis),
        outline: Outline::Square(corners),
        opacity: fade(facing, SQUARE_SHOWS),
    })
    .filter(|shape| shape.opacity > 0.0)
}

fn ring(gizmo: &Gizmo, viewport: &Viewport, axis: Axis) -> Option<Shape> {
    let normal = gizmo.direction(axis);
    let [u, v] = others(axis).map(|other| gizmo.direction(other));
    let eye = viewport.toward_eye(gizmo.position);
    let faces = normal.dot(eye).abs() > RING_FACES;
    let corners = circle(gizmo, viewport, (u, v), 1.0, |out| {
        faces || out.dot(eye) >= -0.02
    })?;
    Some(Shape {
        handle: Handle::TurnAbout(axis),
        outline: Outline::Ring(corners),
        opacity: 1.0,
    })
}

fn outer_ring(gizmo: &Gizmo, viewport: &Viewport) -> Option<Shape> {
    let eye = viewport.toward_eye(gizmo.position);
    let (right, up, _) = viewport.camera().axes();
    let u = (right - eye * right.dot(eye)).normalize_or(right);
    let v = (up - eye * up.dot(eye)).normalize_or(up);
    let corners = circle(gizmo, viewport, (u, v), OUTER, |_| true)?;
    Some(Shape {
        handle: Handle::TurnOnScreen,
        outline: Outline::Ring(corners),
        opacity: 0.85,
    })
}

/// A circle around the gizmo, closed: its first corner comes again at the end.
fn circle(
    gizmo: &Gizmo,
    viewport: &Viewport,
    (u, v): (Vec3, Vec3),
    size: f32,
    is_near: impl Fn(Vec3) -> bool,
) -> Option<Vec<(Pos2, bool)>> {
    let radius = size * gizmo.radius(viewport);
    let corner = |i: usize| {
        let angle = std::f32::consts::TAU * i as f32 / RING_CORNERS as f32;
        let (sin, cos) = libm::sincosf(angle);
        let out = u * cos + v * sin;
        let place = viewport.project(gizmo.position + out * radius)?;
        Some((place, is_near(out)))
    };
    (0..=RING_CORNERS).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::super::Tool;
    use super::super::viewport::tests::viewport;
    use super::*;

    fn gizmo(tool: Tool) -> Gizmo {
        Gizmo {
            position: Vec3::new(0.2, 0.1, -0.3),
            axes: Quat::IDENTITY,
            tool,
        }
    }

    #[test]
    fn every_handle_is_found_where_it_is_drawn() {
        let view = viewport(0.6, 0.4);
        for tool in [Tool::Move, Tool::Turn, Tool::MoveAndTurn] {
            let shapes = shapes(&gizmo(tool), &view);
            let count = match tool {
                Tool::Move => 7,
                Tool::Turn => 4,
                Tool::MoveAndTurn => 11,
            };
            assert_eq!(shapes.len(), count);
            for shape in &shapes {
                let place = match &shape.outline {
                    Outline::Disc(middle) => *middle,
                    Outline::Arrow(foot, tip) => *foot + (*tip - *foot) * 0.9,
                    Outline::Square(corners) => corners[0] + (corners[2] - corners[0]) * 0.5,
                    Outline::Ring(corners) => {
                        // Where no other ring crosses it.
                        let clear = corners.iter().find(|(place, near)| {
                            *near && {
                                let apart = shapes.iter().filter(|other| *other != shape);
                                apart
                                    .map(|other| distance_to(&other.outline, *place))
                                    .all(|distance| distance > 2.0 * REACH)
                            }
                        });
                        clear.expect("a free piece of the ring").0
                    }
                };
                assert_eq!(pick(&shapes, place), Some(shape.handle), "{tool:?}");
            }
            assert_eq!(pick(&shapes, Pos2::new(110.0, 60.0)), None);
        }
    }

    #[test]
    fn the_size_on_the_screen_does_not_depend_on_the_distance() {
        let view = viewport(0.0, 0.0);
        for z in [-20.0, 0.0, 3.0] {
            let gizmo = Gizmo {
                position: Vec3::Z * z,
                axes: Quat::IDENTITY,
                tool: Tool::Turn,
            };
            let shapes = shapes(&gizmo, &view);
            let about_z = shapes
                .iter()
                .find(|shape| shape.handle == Handle::TurnAbout(Axis::Z));
            let Some(Outline::Ring(corners)) = about_z.map(|shape| &shape.outline) else {
                panic!("there is a ring about Z");
            };
            let width = corners[0].0.distance(corners[RING_CORNERS / 2].0);
            assert!(
                (width - 2.0 * super::super::RADIUS_POINTS).abs() < 1.0,
                "{width}"
            );
        }
    }

    #[test]
    fn what_points_at_the_viewer_cannot_be_taken() {
        let view = viewport(0.0, 0.0);
        let gizmo = Gizmo {
            position: Vec3::ZERO,
            axes: Quat::IDENTITY,
            tool: Tool::Move,
        };
        let shapes = shapes(&gizmo, &view);
        let has = |handle| shapes.iter().any(|shape| shape.handle == handle);
        assert!(!has(Handle::MoveAlong(Axis::Z)) && has(Handle::MoveAlong(Axis::X)));
        assert!(!has(Handle::MoveAcross(Axis::X)) && has(Handle::MoveAcross(Axis::Z)));
    }

    #[test]
    fn a_gizmo_behind_the_eye_has_no_shapes() {
        let view = viewport(0.0, 0.0);
        let gizmo = Gizmo {
            position: Vec3::Z * 30.0,
            axes: Quat::IDENTITY,
            tool: Tool::MoveAndTurn,
        };
        assert!(shapes(&gizmo, &view).is_empty());
    }

    #[test]
    fn the_far_half_of_a_ring_is_not_taken() {
        let view = viewport(0.5, 0.5);
        let gizmo = Gizmo {
            position: Vec3::ZERO,
            axes: Quat::IDENTITY,
            tool: Tool::Turn,
        };
        let shapes = shapes(&gizmo, &view);
        let ring = &shapes[0];
        let Outline::Ring(corners) = &ring.outline else {
            panic!("rings come first");
        };
        let far = corners.iter().filter(|(_, near)| !near).count();
        assert!(
            (RING_CORNERS / 3..RING_CORNERS * 2 / 3).contains(&far),
            "{far}"
        );
        let middle_of_far = corners
            .iter()
            .filter(|(_, near)| !near)
            .nth(far / 2)
            .expect("there is a far half");
        assert_ne!(pick(&shapes[..1], middle_of_far.0), Some(ring.handle));
    }
}
