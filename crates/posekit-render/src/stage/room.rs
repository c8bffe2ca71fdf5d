//! The room that things stand in: background, floor, grid, lights.

use glam::Vec3;

use crate::camera::Camera;
use crate::grid::{LengthUnit, spacing_for, spacing_text};
use crate::scene::{Caption, Corner, Ground, Scene};
use crate::theme::Theme;

/// A room around something, of its size. World space, the thing's own unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Colours and lights.
    pub theme: Theme,
    /// The height of what stands in it, positive: grid, lights and shadows go by it.
    pub size: f32,
    /// Y of the floor.
    pub ground_height: f32,
    /// The floor is strongest around this point.
    pub focus: Vec3,
    /// Distance from the focus at which the floor has become the background.
    pub radius: f32,
    /// What lengths mean, for the grid's caption.
    pub unit: LengthUnit,
    /// The lights stand at the viewer's left shoulder; seen from straight above, as for a viewer who
    /// looks from this yaw, radians.
    pub yaw_from_above_rad: f32,
}

impl Room {
    /// The empty room seen by a camera: no models, and one caption, the grid's.
    #[must_use]
    pub fn scene(&self, camera: Camera) -> Scene {
        let theme = &self.theme;
        let grid = spacing_for(self.size);
        let (_, _, back) = camera.axes();
        let from_above = back.x * back.x + back.z * back.z < 1e-6;
        let yaw = if from_above {
            self.yaw_from_above_rad
        } else {
            libm::atan2f(back.x, back.z)
        };
        let caption = Caption {
            corner: Corner::BottomLeft,
            text: spacing_text(grid.spacing, self.unit),
            color: theme.text.mix(theme.background_bottom, 0.35),
            size: 15.0,
        };
        Scene {
            camera,
            background: theme.background(),
            ground: Some(Ground {
                height: self.ground_height,
                focus: self.focus,
                radius: self.radius,
                grid_spacing: grid.spacing,
                major_every: grid.major_every,
                color: theme.ground,
                line_color: theme.grid_line,
                axis_colors: theme.axis_lines,
            }),
            lighting: theme.lighting(self.size, yaw),
            lamps: Vec::new(),
            models: Vec::new(),
            polylines: Vec::new(),
            labels: Vec::new(),
            captions: vec![caption],
        }
    }
}
