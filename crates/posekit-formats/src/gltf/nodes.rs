//! Nodes to a skeleton: which of them are joints, and where they are without the scales.

use std::sync::Arc;

use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::json::Root;
use gltf::json::scene::Node;
use posekit::skeleton::{Skeleton, SkeletonBuilder, SkeletonError};

use super::Notes;
use super::json_path::Step;
use crate::report::{ReadError, ReadErrorKind, WarningCode};

/// Scales that differ from each other or from one by less than this do so by rounding.
const SCALE_TOLERANCE: f64 = 1e-3;

/// How far from 1 the length of a rotation's quaternion may be without a word.
const UNIT_TOLERANCE: f64 = 1e-3;

/// The skeleton, and how what the file says of its nodes becomes what is true of its joints.
pub(super) struct Rig {
    pub(super) skeleton: Arc<Skeleton>,
    /// For each node the joint that it is.
    pub(super) joint_of_node: Vec<Option<usize>>,
    /// For each joint the space that its node's transform is given in.
    pub(super) spaces: Vec<Space>,
    /// For each joint its node's scale.
    pub(super) scales: Vec<DVec3>,
}

/// The space in which a node's transform is given, seen from its joint's parent, which has no scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Space {
    origin: DVec3,
    /// Scale, and at a root what stands above it.
    linear: DMat3,
    turn: DQuat,
}

impl Space {
    pub(super) fn translation(&self, of_node: DVec3) -> DVec3 {
        self.origin + self.linear * of_node
    }

    /// As a translation's, of a change of it.
    pub(super) fn translation_slope(&self, of_node: DVec3) -> DVec3 {
        self.linear * of_node
    }

    pub(super) fn rotation(&self, of_node: DQuat) -> DQuat {
        self.turn * of_node
    }
}

/// A node's own transform.
#[derive(Clone, Copy, Debug)]
struct Transform {
    translation: DVec3,
    rotation: DQuat,
    scale: DVec3,
}

/// Where a node is in the world.
#[derive(Clone, Copy, Debug)]
struct Placed {
    position: DVec3,
    /// With all scales.
    linear: DMat3,
    /// Without.
    orientation: DQuat,
}

/// Makes the skeleton.
pub(super) fn rig(root: &Root, notes: &mut Notes) -> Result<Rig, ReadError> {
    let order = walk(root, notes)?;
    let is_joint = choose(root, &order, notes)?;
    let mut builder = SkeletonBuilder::new();
    let mut joint_of_node = vec![None; root.nodes.len()];
    let mut placed: Vec<Option<Placed>> = vec![None; root.nodes.len()];
    let (mut spaces, mut scales) = (Vec::new(), Vec::new());
    let mut root_count = 0;
    for &(node, parent) in &order {
        let own = transform(&root.nodes[node], node, is_joint[node], notes);
        let above = parent.and_then(|parent| placed[parent]).unwrap_or(Placed {
            position: DVec3::ZERO,
            linear: DMat3::IDENTITY,
            orientation: DQuat::IDENTITY,
        });
        placed[node] = Some(Placed {
            position: above.position + above.linear * own.translation,
            linear: above.linear * DMat3::from_quat(own.rotation) * DMat3::from_diagonal(own.scale),
            orientation: (above.orientation * own.rotation).normalize(),
        });
        if !is_joint[node] {
            continue;
        }
        let parent_joint = parent.and_then(|parent| joint_of_node[parent]);
        let space = if parent_joint.is_some() {
            Space {
                origin: DVec3::ZERO,
                linear: DMat3::from_quat(above.orientation.inverse()) * above.linear,
                turn: DQuat::IDENTITY,
            }
        } else {
            root_count += 1;
            Space {
                origin: above.position,
                linear: above.linear,
                turn: above.orientation,
            }
        };
        let id = builder.oriented_joint(
            name(&root.nodes[node], node, notes),
            parent_joint.map(posekit::skeleton::JointId::new),
            space.translation(own.translation).as_vec3(),
            space.rotation(own.rotation).normalize().as_quat(),
        );
        joint_of_node[node] = Some(id.index());
        spaces.push(space);
        scales.push(own.scale);
    }
    if root_count > 1 {
        notes.warn(WarningCode::SeveralRoots, &[Step::Key("nodes")], || {
            format!("the skeleton has {root_count} roots")
        });
    }
    let skeleton = builder.build().map_err(|error| {
        let kind = match error {
            SkeletonError::NotFinite { .. } => ReadErrorKind::NotFinite,
            SkeletonError::TooFar { .. } => ReadErrorKind::OutOfRange,
            _ => ReadErrorKind::Unexpected,
        };
        let node = match error {
            SkeletonError::NotFinite { joint, .. }
            | SkeletonError::TooFar { joint, .. }
            | SkeletonError::NotUnit { joint, .. } => {
                joint_of_node.iter().position(|&it| it == Some(joint))
            }
            _ => None,
        };
        let path = [Step::Key("nodes"), Step::Index(node.unwrap_or_default())];
        let path = if node.is_some() {
            &path[..]
        } else {
            &path[..1]
        };
        // It has a name in it, which may be long.
        let found: String = error.to_string().chars().take(200).collect();
        notes.error(kind, path, "nodes that make a skeleton", found)
    })?;
    Ok(Rig {
        skeleton: Arc::new(skeleton),
        joint_of_node,
        spaces,
        scales,
    })
}

/// All nodes, each with its parent, a parent before its children, as the file lists them.
fn walk(root: &Root, notes: &mut Notes) -> Result<Vec<(usize, Option<usize>)>, ReadError> {
    let count = root.nodes.len();
    let mut parents: Vec<Option<usize>> = vec![None; count];
    for (node, child, place) in children(root) {
        let path = [
            Step::Key("nodes"),
            Step::Index(node),
            Step::Key("children"),
            Step::Index(place),
        ];
        if child >= count {
            let (wanted, found) = (format!("one of {count} nodes"), format!("node {child}"));
            return Err(notes.error(ReadErrorKind::UnknownName, &path, wanted, found));
        }
        if let Some(other) = parents[child].replace(node) {
            let found = format!("node {child}, which is a child of node {other} already");
            return Err(notes.error(
                ReadErrorKind::NotATree,
                &path,
                "a node without a parent",
                found,
            ));
        }
    }
    let mut order = Vec::with_capacity(count);
    let mut waiting: Vec<usize> = (0..count).rev().filter(|&n| parents[n].is_none()).collect();
    while let Some(node) = waiting.pop() {
        order.push((node, parents[node]));
        let children = root.nodes[node].children.iter().flatten();
        waiting.extend(children.rev().map(|child| child.value()));
    }
    // Every node has one parent at most, so that those which no root leads to go round in circles.
    if order.len() < count {
        let mut is_met = vec![false; count];
        for &(node, _) in &order {
            is_met[node] = true;
        }
        let circling = is_met.iter().position(|met| !met).unwrap_or_default();
        let path = [Step::Key("nodes"), Step::Index(circling)];
        let found = format!("node {circling}, which is below itself");
        return Err(notes.error(
            ReadErrorKind::NotATree,
            &path,
            "nodes that make a tree",
            found,
        ));
    }
    Ok(order)
}

/// Parent, child, and the child's place among its siblings.
fn children(root: &Root) -> impl Iterator<Item = (usize, usize, usize)> {
    root.nodes.iter().enumerate().flat_map(|(node, said)| {
        let children = said.children.iter().flatten().enumerate();
        children.map(move |(place, child)| (node, child.value(), place))
    })
}

/// Which nodes are joints.
fn choose(
    root: &Root,
    order: &[(usize, Option<usize>)],
    notes: &mut Notes,
) -> Result<Vec<bool>, ReadError> {
    let skinned = root.skins.first().filter(|skin| !skin.joints.is_empty());
    let Some(skin) = skinned else {
        return in_scene(root, order, notes);
    };
    let mut is_joint = vec![false; root.nodes.len()];
    for (place, joint) in skin.joints.iter().enumerate() {
        let known = is_joint.get_mut(joint.value());
        *known.ok_or_else(|| {
            let path = [
                Step::Key("skins"),
                Step::Index(0),
                Step::Key("joints"),
                Step::Index(place),
            ];
            let wanted = format!("one of {} nodes", root.nodes.len());
            let found = format!("node {}", joint.value());
            notes.error(ReadErrorKind::UnknownName, &path, wanted, found)
        })? = true;
    }
    let is_left = |joint: usize| !is_joint.get(joint).copied().unwrap_or(true);
    let others = root.skins.iter().enumerate().skip(1);
    let other = others
        .filter(|(_, skin)| skin.joints.iter().any(|joint| is_left(joint.value())))
        .map(|(index, _)| index);
    for index in other.collect::<Vec<_>>() {
        let path = [Step::Key("skins"), Step::Index(index)];
        notes.warn(WarningCode::OtherSkin, &path, || {
            format!("skin {index} has joints that the first one lacks; they were left out")
        });
    }
    // Nodes between two joints carry the lower one.
    let mut is_below_joint = vec![false; root.nodes.len()];
    for &(node, parent) in order {
        is_below_joint[node] = parent.is_some_and(|p| is_joint[p] || is_below_joint[p]);
    }
    let mut has_joint_below = vec![false; root.nodes.len()];
    for &(node, parent) in order.iter().rev() {
        if let Some(parent) = parent {
            has_joint_below[parent] |= is_joint[node] || has_joint_below[node];
        }
    }
    for node in 0..root.nodes.len() {
        is_joint[node] |= is_below_joint[node] && has_joint_below[node];
    }
    Ok(is_joint)
}

/// Without a skin: the nodes of the scene that is shown first, or all where there is no scene.
fn in_scene(
    root: &Root,
    order: &[(usize, Option<usize>)],
    notes: &mut Notes,
) -> Result<Vec<bool>, ReadError> {
    if root.nodes.is_empty() {
        let wanted = "nodes, which make a skeleton";
        return Err(notes.error(ReadErrorKind::Unexpected, &[], wanted, "none"));
    }
    let index = root.scene.as_ref().map_or(0, |scene| scene.value());
    let Some(scene) = root
        .scenes
        .get(index)
        .filter(|scene| !scene.nodes.is_empty())
    else {
        return Ok(vec![true; root.nodes.len()]);
    };
    let mut is_in = vec![false; root.nodes.len()];
    for (place, node) in scene.nodes.iter().enumerate() {
        let Some(known) = is_in.get_mut(node.value()) else {
            let path = [
                Step::Key("scenes"),
                Step::Index(index),
                Step::Key("nodes"),
                Step::Index(place),
            ];
            let wanted = format!("one of {} nodes", root.nodes.len());
            let found = format!("node {}", node.value());
            return Err(notes.error(ReadErrorKind::UnknownName, &path, wanted, found));
        };
        *known = true;
    }
    for &(node, parent) in order {
        is_in[node] |= parent.is_some_and(|parent| is_in[parent]);
    }
    Ok(is_in)
}

fn name(node: &Node, index: usize, notes: &mut Notes) -> String {
    match node.name.as_deref() {
        Some(name) if !name.is_empty() => name.to_owned(),
        _ => {
            let made = format!("node {index}");
            let path = [Step::Key("nodes"), Step::Index(index)];
            notes.warn(WarningCode::UnnamedNode, &path, || {
                format!("node {index} has no name; it is called `{made}`")
            });
            made
        }
    }
}

/// A node's transform; what is wrong with it is said of joints, and repaired in all.
fn transform(node: &Node, index: usize, is_joint: bool, notes: &mut Notes) -> Transform {
    let mut warn = |code, what: &str, message: String| {
        if is_joint {
            let path = [Step::Key("nodes"), Step::Index(index), Step::Key(what)];
            notes.warn(code, &path, || format!("node {index}: {message}"));
        }
    };
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
        let length = rotation.length();
        if scale.is_finite() && length.is_finite() && length > 1e-6 {
            // Of one that shears the axes are not perpendicular, and this is no unit quaternion.
            let rotation = rotation / length;
            let again = DMat4::from_scale_rotation_translation(scale, rotation, translation);
            if !again.abs_diff_eq(matrix, SCALE_TOLERANCE * scale.abs().max_element()) {
                let message = "the matrix shears, which a skeleton cannot".to_owned();
                warn(WarningCode::UnevenScale, "matrix", message);
            } else {
                warn_of_scale(scale, "matrix", &mut warn);
            }
            return Transform {
                translation,
                rotation,
                scale,
            };
        }
        let message = "the matrix is flat; only its translation is used".to_owned();
        warn(WarningCode::UnevenScale, "matrix", message);
        return Transform {
            translation,
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
        };
    }
    let vector =
        |given: Option<[f32; 3]>, default| given.map_or(default, |v| DVec3::from(v.map(f64::from)));
    let given = node
        .rotation
        .map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0);
    let given = DQuat::from_array(given.map(f64::from));
    let length = given.length();
    let rotation = if length.is_finite() && length > 1e-6 {
        given / length
    } else {
        DQuat::IDENTITY
    };
    if !length.is_finite() || (length - 1.0).abs() > UNIT_TOLERANCE {
        let message = match rotation == DQuat::IDENTITY {
            true => "the rotation is not a quaternion; it is ignored".to_owned(),
            false => format!("the rotation is not of unit length ({length:.4}); it is normalised"),
        };
        warn(WarningCode::RotationNotUnit, "rotation", message);
    }
    let scale = vector(node.scale, DVec3::ONE);
    warn_of_scale(scale, "scale", &mut warn);
    Transform {
        translation: vector(node.translation, DVec3::ZERO),
        rotation,
        scale,
    }
}

fn warn_of_scale(scale: DVec3, what: &str, warn: &mut impl FnMut(WarningCode, &str, String)) {
    let even = DVec3::splat(scale.x);
    let [x, y, z] = scale.to_array();
    // A mirroring that is the same along all axes commutes with every rotation.
    if scale.x == 0.0 || !scale.abs_diff_eq(even, SCALE_TOLERANCE * scale.x.abs()) {
        let message = format!(
            "the scale {x} {y} {z} is not the same along all axes: the joints below it are in place at rest only"
        );
        warn(WarningCode::UnevenScale, what, message);
    } else if !scale.abs_diff_eq(DVec3::ONE, SCALE_TOLERANCE) {
        let message = format!("the scale {x} was applied to the translations below it");
        warn(WarningCode::NodeScale, what, message);
    }
}
