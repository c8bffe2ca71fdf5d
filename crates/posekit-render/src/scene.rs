//! The scene: everything in a picture, said without a renderer.
//!
//! World space, right-handed, Y up, in the file's length unit. A scene is cheap to make: meshes are
//! shared by `Arc`, and only transforms change from frame to frame. Both back ends draw the same
//! scene with the same shading (see `shading`).

use std::sync::Arc;

use glam::{Affine3, Vec3};

use crate::camera::Camera;
use crate::color::Color;
use crate::mesh::{MATERIAL_COUNT, MaterialId, Mesh};

/// Everything in a picture.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// What is behind everything.
    pub background: Background,
    /// The floor; `None` draws none and catches no shadow.
    pub ground: Option<Ground>,
    /// Sun, fill and sky.
    pub lighting: Lighting,
    /// Lights at places; [`MOST_LAMPS`] of them are drawn. The ground takes their light. Where the key
    /// light is off, the first one casts the shadow.
    pub lamps: Vec<Lamp>,
    /// Bodies and bones.
    pub models: Vec<Model>,
    /// Lines of constant width on the screen.
    pub polylines: Vec<Polyline>,
    /// Text at points of the scene.
    pub labels: Vec<Label>,
    /// Text at the picture's edges.
    pub captions: Vec<Caption>,
}

/// What is behind everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// A vertical gradient.
    Gradient {
        /// At the picture's top edge.
        top: Color,
        /// At its bottom edge.
        bottom: Color,
    },
    /// Nothing: the picture has an alpha channel, and of the ground only the shadow is drawn.
    Transparent,
}

/// A horizontal floor with a grid that fades out around a focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Y of the floor.
    pub height: f32,
    /// The floor is strongest around this point (its Y is ignored).
    pub focus: Vec3,
    /// Distance from the focus at which the floor has become the background.
    pub radius: f32,
    /// Distance between grid lines.
    pub grid_spacing: f32,
    /// Every how many lines one is drawn stronger.
    pub major_every: u32,
    /// The floor itself.
    pub color: Color,
    /// Grid lines.
    pub line_color: Color,
    /// The lines through the origin: along X, along Z.
    pub axis_colors: [Color; 2],
}

/// The lights. All directions are unit vectors towards the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// Towards the key light.
    pub key_direction: Vec3,
    /// The key light, linear light.
    pub key: Color,
    /// Towards the fill light, which casts no shadow.
    pub fill_direction: Vec3,
    /// The fill light.
    pub fill: Color,
    /// Light from straight above.
    pub sky: Color,
    /// Light bounced from below.
    pub bounce: Color,
    /// How dark the key light's shadow is on the ground, 0..=1.
    pub shadow_strength: f32,
    /// Where light is added up: what the ground has without any lamp, 1 for its own colour.
    pub ground_ambient: f32,
    /// Radius of the shadow's soft edge, world length.
    pub shadow_softness: f32,
    /// How dark the ground is right under a body part that touches it, 0..=1.
    pub contact_strength: f32,
    /// Factor of all light where light is added up ([`Scene::is_lit`]), as a camera's exposure.
    pub exposure: f32,
}

/// A light at a place, which shines to all sides.
///
/// It lights a surface at distance d by `color` * cosine * (`full_at` / d)^2, where the cosine is that
/// of the angle between the surface's normal and the way to the light: Lambert's law and the inverse
/// square of the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Where it is, in world space.
    pub position: Vec3,
    /// Its colour times its strength, linear light.
    pub color: Color,
    /// The distance at which it shines with its strength, world length. Must be positive.
    pub full_at: f32,
}

/// More lamps than this are not drawn.
pub const MOST_LAMPS: usize = 16;

/// A posed mesh.
#[derive(Clone, Debug)]
pub struct Model {
    /// The mesh, shared.
    pub mesh: Arc<Mesh>,
    /// World from joint, one for every joint the mesh uses.
    pub joints: Vec<Affine3>,
    /// Colour of each material, indexed by [`MaterialId`].
    pub palette: [Color; MATERIAL_COUNT],
    /// 1 is solid; less lets what is behind through evenly, in steps of a quarter.
    pub opacity: f32,
    /// Whether it takes part in shadows.
    pub shadow: Shadow,
}

/// Whether a model takes part in shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shadow {
    /// It casts shadows and receives them.
    Cast,
    /// It does neither: ghosts, axes.
    None,
}

impl Scene {
    /// The lamps that are drawn.
    #[must_use]
    pub fn drawn_lamps(&self) -> &[Lamp] {
        &self.lamps[..self.lamps.len().min(MOST_LAMPS)]
    }

    /// Whether the light of this picture is added up from its lamps: there are some, or the key light is
    /// off. Then it is exposed and tone-mapped; otherwise it is as the theme has composed it.
    #[must_use]
    pub fn is_lit(&self) -> bool {
        !self.lamps.is_empty() || self.is_key_off()
    }

    /// The lamp that casts the shadow; `None` where the key light does, or nothing.
    #[must_use]
    pub fn casting_lamp(&self) -> Option<&Lamp> {
        self.lamps.first().filter(|_| self.is_key_off())
    }

    /// Whether there is no key light.
    #[must_use]
    pub fn is_key_off(&self) -> bool {
        self.lighting.key == Color::default()
    }
}

impl Model {
    /// The colour of a material.
    #[must_use]
    pub fn color(&self, material: MaterialId) -> Color {
        self.palette[material as usize]
    }
}

/// A line through points of the scene, of constant width on the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// The points, world space, each with its colour.
    pub points: Vec<(Vec3, Color)>,
    /// Width in pixels of a picture 720 pixels high; it grows with the picture.
    pub width: f32,
    /// 1 is solid; less lets what is behind through, in steps of a quarter.
    pub opacity: f32,
}

/// Text at a point of the scene, drawn over everything on a plate beside its point. Where many crowd,
/// they move away along a line, and the last ones are left out rather than drawn over others.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The point, world space.
    pub position: Vec3,
    /// One line of text.
    pub text: String,
    /// The text's colour; the plate has the background's.
    pub color: Color,
    /// Size in pixels of a picture 720 pixels high; it grows with the picture.
    pub size: f32,
}

/// Where a caption stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Corner {
    /// Top left.
    TopLeft,
    /// Top right.
    TopRight,
    /// Bottom left.
    BottomLeft,
    /// Bottom right.
    BottomRight,
    /// Bottom, in the middle.
    BottomMiddle,
}

/// Text at a corner of the picture. Several at one corner are stacked.
#[derive(Clone, Debug, PartialEq)]
pub struct Caption {
    /// Where it stands.
    pub corner: Corner,
    /// One line of text.
    pub text: String,
    /// The text's colour.
    pub color: Color,
    /// Size in pixels of a picture 720 pixels high; it grows with the picture.
    pub size: f32,
}

/// Sizes in a scene are given for a picture this high and grow with it.
pub const REFERENCE_HEIGHT_PX: f32 = 720.0;

/// Opacity in quarters, 0 to 4: how many of a pixel's four samples a model covers.
#[must_use]
pub fn opacity_quarters(opacity: f32) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to 0..=4 before the cast"
    )]
    let quarters = (opacity.clamp(0.0, 1.0) * 4.0 + 0.5) as u32;
    quarters
}
