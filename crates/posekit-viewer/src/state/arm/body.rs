//! What a robot looks like: the shapes of its links as meshes that ride on its joints.
//!
//! Boxes, cylinders and balls are drawn as the file says. Links whose meshes are in files of their own,
//! and robots without visuals, get simple shapes: a tapered limb to each joint that hangs from the link,
//! a drum about each axis of a hinge, a block along each slide.

use std::sync::Arc;

use glam::{Affine3, DVec3, Mat3, Quat, Vec3};
use posekit::mechanism::{Frame, Freedom, Mechanism};
use posekit::skeleton::JointId;
use posekit_formats::urdf::{Urdf, UrdfShape, UrdfVisual};
use posekit_render::color::Color;
use posekit_render::mesh::{MaterialId, Mesh, Shape};

use super::single;

/// How round cylinders and balls are.
const SEGMENTS: usize = 32;

/// A robot of more colours than this gets the last of them for all others.
const MOST_COLORS: usize = 64;

/// Colours of shapes whose file gives none: limbs, and joints.
const LIMB: u32 = 0xDF_E2_E7;
const JOINT: u32 = 0x3E_6A_A8;
const TIP: u32 = 0xE8_8E_2C;

/// Thickness of simple limbs, as a share of the robot's reach.
const LIMB_RADIUS: f32 = 0.035;

/// Everything of one colour.
#[derive(Clone, Debug)]
pub struct Part {
    /// The mesh; its joints are the mechanism's.
    pub mesh: Arc<Mesh>,
    /// Its colour.
    pub color: Color,
    /// Its opacity, 0 to 1.
    pub opacity: f32,
}

/// What a robot looks like.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// The parts, one a colour.
    pub parts: Vec<Part>,
}

/// Parts that are being put together.
#[derive(Default)]
struct Builder {
    parts: Vec<(Mesh, [u8; 4])>,
}

impl Builder {
    fn add(&mut self, shape: &Shape, joint: JointId, rgba: [u8; 4]) {
        if shape.positions.iter().any(|p| !p.is_finite()) {
            return;
        }
        let known = self.parts.iter().position(|(_, color)| *color == rgba);
        let index = known.unwrap_or_else(|| {
            if self.parts.len() < MOST_COLORS {
                self.parts.push((Mesh::default(), rgba));
            }
            self.parts.len() - 1
        });
        self.parts[index]
            .0
            .add(shape, joint.index(), MaterialId::Base);
    }

    fn build(self) -> Body {
        let part = |(mesh, [r, g, b, alpha]): (Mesh, [u8; 4])| Part {
            mesh: Arc::new(mesh),
            color: Color::from_srgb_bytes([r, g, b]),
            opacity: f32::from(alpha) / 255.0,
        };
        Body {
            parts: self.parts.into_iter().map(part).collect(),
        }
    }
}

fn opaque(hex: u32) -> [u8; 4] {
    let [_, r, g, b] = hex.to_be_bytes();
    [r, g, b, 255]
}

/// A colour of the file, which is meant as it is seen: sRGB.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of 0 to 1 as a byte"
)]
fn rgba(color: [f64; 4]) -> [u8; 4] {
    color.map(|share| (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
}

impl Body {
    /// The body of a robot that reaches as far as `reach`.
    #[must_use]
    pub fn of(document: &Urdf, mechanism: &Mechanism, reach: f64) -> Self {
        let links = document.links_from_root();
        let is_drawn = |visual: &UrdfVisual| !matches!(visual.shape, UrdfShape::Mesh { .. });
        let has_drawn = |link: usize| document.links[link].visuals.iter().any(is_drawn);
        let any_drawn = links.iter().any(|&link| has_drawn(link));
        let mut builder = Builder::default();
        for (joint, &link) in mechanism.skeleton().joints().zip(&links) {
            let visuals = &document.links[link].visuals;
            for visual in visuals.iter().filter(|visual| is_drawn(visual)) {
                let color = visual.color.map_or(opaque(LIMB), rgba);
                if let Some(shape) = shape_of(visual) {
                    builder.add(&shape, joint, color);
                }
            }
            // A link without visuals among others with some is a frame that the file only names.
            let has_none = !has_drawn(link) && (!visuals.is_empty() || !any_drawn);
            if has_none {
                add_simple(&mut builder, mechanism, joint, single(reach));
            }
        }
        builder.build()
    }

    /// The least and the largest height of the vertices that ride on certain joints, where those stand; `None` without
    /// any.
    #[must_use]
    pub fn heights(&self, joints: &[Affine3], counts: impl Fn(usize) -> bool) -> Option<[f32; 2]> {
        let vertices = self.parts.iter().flat_map(|part| &part.mesh.vertices);
        vertices
            .filter(|vertex| counts(vertex.joint as usize))
            .filter_map(|vertex| {
                let joint = joints.get(vertex.joint as usize)?;
                let height = joint.transform_point3(vertex.position).y;
                Some([height; 2])
            })
            .reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
    }
}

/// Frames as the transforms that vertices ride on.
pub(super) fn transforms(frames: &[Frame]) -> Vec<Affine3> {
    frames
        .iter()
        .map(|frame| {
            let turn = Mat3::from_quat(frame.orientation.as_quat());
            Affine3 {
                matrix3: turn,
                translation: frame.position.as_vec3(),
            }
        })
        .collect()
}

/// A shape of the file in its link's frame. `None` for one that is not drawn.
fn shape_of(visual: &UrdfVisual) -> Option<Shape> {
    let shape = match &visual.shape {
        UrdfShape::Box { size } => {
            let half = DVec3::from_array(*size).as_vec3() * 0.5;
            Shape::cuboid(half, 0.06 * half.min_element())
        }
        UrdfShape::Cylinder { radius, length } => {
            let (radius, half) = (single(*radius), single(0.5 * length));
            let bevel = 0.06 * radius.min(half);
            Shape::drum(Vec3::Z * -half, Vec3::Z * half, radius, bevel, SEGMENTS)
        }
        UrdfShape::Sphere { radius } => Shape::ball(Vec3::ZERO, single(*radius), SEGMENTS),
        UrdfShape::Mesh { .. } => return None,
    };
    let turn = Mat3::from_quat(visual.origin.rotation().as_quat());
    Some(shape.mapped(turn, visual.origin.translation().as_vec3()))
}

/// Simple shapes for the link that a joint carries.
fn add_simple(builder: &mut Builder, mechanism: &Mechanism, joint: JointId, reach: f32) {
    let skeleton = mechanism.skeleton();
    // Limbs get thinner from joint to joint.
    let depth = skeleton.ancestors(joint).count();
    #[expect(clippy::cast_precision_loss, reason = "a robot has few joints")]
    let thin = |depth: usize| LIMB_RADIUS * reach * (0.55 + 0.45 / (1.0 + 0.35 * depth as f32));
    let radius = thin(depth);
    for &child in skeleton.children(joint) {
        let end = mechanism.joint(child).rest_translation.as_vec3();
        if end.length() > 1e-4 * reach {
            let thick = radius.min(0.45 * end.length());
            let limb = Shape::tapered_capsule(
                Vec3::ZERO,
                thick,
                end,
                thin(depth + 1).min(0.4 * end.length()),
                SEGMENTS,
            );
            builder.add(&limb, joint, opaque(LIMB));
        }
    }
    match mechanism.joint(joint).freedom {
        Freedom::Hinge { axis } => {
            let half = axis.as_vec3() * (1.5 * radius);
            let drum = Shape::drum(-half, half, 1.3 * radius, 0.2 * radius, SEGMENTS);
            builder.add(&drum, joint, opaque(JOINT));
        }
        Freedom::Slide { axis } => {
            let block = Shape::cuboid(Vec3::new(1.2, 1.2, 2.2) * radius, 0.2 * radius);
            let along = Mat3::from_quat(Quat::from_rotation_arc(Vec3::Z, axis.as_vec3()));
            builder.add(&block.mapped(along, Vec3::ZERO), joint, opaque(JOINT));
        }
        Freedom::Planar { .. } | Freedom::Ball | Freedom::Free => {
            let ball = Shape::ball(Vec3::ZERO, 1.4 * radius, SEGMENTS);
            builder.add(&ball, joint, opaque(JOINT));
        }
        Freedom::Fixed if skeleton.parent(joint).is_none() => {
            let plate = Shape::ball(Vec3::ZERO, 1.3 * radius, SEGMENTS);
            builder.add(&plate, joint, opaque(JOINT));
        }
        Freedom::Fixed => {}
    }
    if skeleton.children(joint).is_empty() {
        let tip = Shape::ball(Vec3::ZERO, 0.9 * radius, SEGMENTS);
        builder.add(&tip, joint, opaque(TIP));
    }
}
