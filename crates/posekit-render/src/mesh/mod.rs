//! Triangle meshes whose vertices ride on joints, and the shapes they are made of.
//!
//! A [`Mesh`] is shared between the back ends and between frames: only the joints' transforms
//! change from frame to frame. Positions and normals are in the space of the vertex's joint, in the
//! skeleton's length unit; triangles are counter-clockwise seen from outside.

mod shape;
mod solids;

pub(crate) use shape::frame_along;

pub use shape::{LoftRing, Shape};

use glam::Vec3;

/// Index of a material in a model's palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum MaterialId {
    /// The trunk, the head and whatever has no side.
    Base = 0,
    /// Joint balls, hands, feet: the darker second tone.
    Accent = 1,
    /// Limbs on the left.
    Left = 2,
    /// Limbs on the right.
    Right = 3,
    /// The X axis of a joint's frame.
    AxisX = 4,
    /// The Y axis.
    AxisY = 5,
    /// The Z axis.
    AxisZ = 6,
}

/// How many materials a palette holds.
pub const MATERIAL_COUNT: usize = 7;

/// A vertex of a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position in the joint's space.
    pub position: Vec3,
    /// Unit normal in the joint's space.
    pub normal: Vec3,
    /// Index into the model's transforms.
    pub joint: u32,
    /// The material; a triangle is drawn in the material of its first vertex.
    pub material: MaterialId,
}

/// A ball inside a mesh, for the soft dark that it makes on the ground it comes near to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactBall {
    /// Index into the model's transforms.
    pub joint: u32,
    /// Middle in the joint's space.
    pub center: Vec3,
    /// Radius.
    pub radius: f32,
}

/// Triangles over vertices that ride on joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// Three vertex indices a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Balls that roughly fill the mesh; may be empty.
    pub contact_balls: Vec<ContactBall>,
}

impl Mesh {
    /// The number of transforms a model of this mesh must have: one more than the largest joint
    /// index, 0 for a mesh with no vertices.
    #[must_use]
    pub fn joint_count(&self) -> usize {
        self.vertices
            .iter()
            .map(|v| v.joint as usize + 1)
            .max()
            .unwrap_or(0)
    }

    /// Appends a shape whose coordinates are in the space of `joint`.
    pub fn add(&mut self, shape: &Shape, joint: usize, material: MaterialId) {
        let base = u32::try_from(self.vertices.len()).unwrap_or(u32::MAX);
        let joint = u32::try_from(joint).unwrap_or(u32::MAX);
        self.vertices
            .extend(
                shape
                    .positions
                    .iter()
                    .zip(&shape.normals)
                    .map(|(&position, &normal)| Vertex {
                        position,
                        normal,
                        joint,
                        material,
                    }),
            );
        self.triangles
            .extend(shape.triangles.iter().map(|t| t.map(|i| i + base)));
    }

    /// The farthest any vertex lies from the origin of its joint: with the joints' positions it
    /// bounds the model in any pose.
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.vertices
            .iter()
            .map(|v| v.position.length())
            .fold(0.0, f32::max)
    }
}
