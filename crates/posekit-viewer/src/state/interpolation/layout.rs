//! Where things are in the lab's view: the start and the end at the left, the methods beside them.

use egui::{Pos2, Rect, Vec2, pos2, vec2};
use glam::Vec3;
use posekit_render::camera::{Camera, Projection};

use super::Picture;

/// Around everything, and below the tools at the top, points.
const MARGIN: f32 = 10.0;
const BELOW_TOOLS: f32 = 6.0;

/// Room for what is written under a body, points.
pub const CAPTION: f32 = 34.0;

/// How wide the start and the end are, points, and as a share of the view at most.
const ENDS: f32 = 226.0;
const ENDS_SHARE: f32 = 0.42;

/// Places in the view, points from its top left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    size: Vec2,
    /// The start's place and the end's.
    pub ends: [Rect; 2],
    /// A place for each method side by side; one for all of them in the other pictures.
    pub cells: Vec<Rect>,
}

impl Layout {
    /// The places of so many methods in a view of some size, under tools of some height.
    #[must_use]
    pub fn new(size: Vec2, tools: f32, methods: usize, picture: Picture) -> Self {
        let top = tools + BELOW_TOOLS;
        let room = Rect::from_min_max(
            pos2(MARGIN, top),
            pos2(
                (size.x - MARGIN).max(MARGIN + 2.0),
                (size.y - 2.0).max(top + 2.0),
            ),
        );
        let width = ENDS.min(ENDS_SHARE * room.width());
        let height = room.height() / 2.0;
        let end = |row: f32| {
            Rect::from_min_size(
                pos2(room.left(), room.top() + row * height),
                vec2(width, height),
            )
        };
        let rest = Rect::from_min_max(pos2(room.left() + width + MARGIN, room.top()), room.max);
        Self {
            size,
            ends: [end(0.0), end(1.0)],
            cells: match picture {
                Picture::SideBySide => grid(rest, methods),
                Picture::Overlaid | Picture::Sphere => vec![rest],
            },
        }
    }

    /// World length of a point of the screen.
    #[must_use]
    pub fn length_of_point(&self, camera: &Camera) -> f32 {
        let height = match camera.projection {
            Projection::Orthographic { height } => height,
            Projection::Perspective { vertical_fov_rad } => {
                2.0 * camera.eye.distance(camera.target) * libm::tanf(0.5 * vertical_fov_rad)
            }
        };
        height / self.size.y.max(1.0)
    }

    /// The point of the world that is seen at a place, in the plane through what the camera looks at.
    #[must_use]
    pub fn world(&self, camera: &Camera, place: Pos2) -> Vec3 {
        let (right, up, _) = camera.axes();
        let from_middle = (place - (self.size / 2.0).to_pos2()) * self.length_of_point(camera);
        camera.target + right * from_middle.x - up * from_middle.y
    }

    /// Where the body of a cell is: above what is written under it.
    #[must_use]
    pub fn body_place(cell: Rect) -> Pos2 {
        pos2(
            cell.center().x,
            cell.top() + 0.5 * (cell.height() - CAPTION),
        )
    }

    /// How far a body of a cell may reach from its middle, points.
    #[must_use]
    pub fn body_reach(cell: Rect) -> f32 {
        (0.5 * cell.width().min(cell.height() - CAPTION)).max(4.0)
    }
}

/// Equal places in rows, as large as can be.
fn grid(room: Rect, count: usize) -> Vec<Rect> {
    if count == 0 {
        return Vec::new();
    }
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let side = |columns: usize| {
        let rows = count.div_ceil(columns);
        (room.width() / columns as f32).min(room.height() / rows as f32 - CAPTION)
    };
    let columns = (1..=count)
        .max_by(|&a, &b| side(a).total_cmp(&side(b)))
        .unwrap_or(1);
    let rows = count.div_ceil(columns);
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let (width, height) = (room.width() / columns as f32, room.height() / rows as f32);
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let cell = |index: usize| {
        let corner = vec2(
            (index % columns) as f32 * width,
            (index / columns) as f32 * height,
        );
        Rect::from_min_size(room.min + corner, vec2(width, height))
    };
    (0..count).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use posekit_render::camera::{Orbit, Projection};

    use super::*;
    use crate::gizmo::Viewport;

    #[test]
    fn places_are_in_the_view_and_apart() {
        for size in [
            vec2(800.0, 480.0),
            vec2(470.0, 380.0),
            vec2(300.0, 500.0),
            vec2(5.0, 5.0),
        ] {
            for count in 0..=13 {
                let layout = Layout::new(size, 40.0, count, Picture::SideBySide);
                assert_eq!(layout.cells.len(), count);
                if size.x > 100.0 {
                    let view = Rect::from_min_size(Pos2::ZERO, size).expand(0.1);
                    let all: Vec<Rect> = layout.cells.iter().chain(&layout.ends).copied().collect();
                    for (index, a) in all.iter().enumerate() {
                        assert!(view.contains_rect(*a), "{size} {count} {a}");
                        for b in &all[index + 1..] {
                            assert!(!a.shrink(0.5).intersects(b.shrink(0.5)), "{size} {count}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn the_world_under_a_place_is_seen_at_it() {
        let orbit = Orbit {
            target: Vec3::new(0.1, 0.7, -0.2),
            yaw_rad: 0.6,
            pitch_rad: 0.4,
            distance: 5.0,
            projection: Projection::Orthographic { height: 2.5 },
        };
        let layout = Layout::new(vec2(800.0, 480.0), 40.0, 8, Picture::SideBySide);
        let camera = orbit.camera();
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(800.0, 480.0));
        let viewport = Viewport::new(camera, rect);
        for cell in &layout.cells {
            let place = viewport.project(layout.world(&camera, cell.center()));
            assert!(place.is_some_and(|place| place.distance(cell.center()) < 0.01));
        }
    }
}
