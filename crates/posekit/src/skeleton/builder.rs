//! Building a [`Skeleton`] and checking what it is built from.

use std::collections::HashSet;

use glam::{Quat, Vec3};

use super::symmetry::KnownPairs;
use super::{JointId, Link, Skeleton};
use crate::range::{LONGEST_LENGTH, are_lengths};

/// Why a skeleton could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SkeletonError {
    /// A skeleton has at least one joint.
    #[error("a skeleton needs at least one joint")]
    Empty,
    /// A joint names a parent that does not come before it.
    #[error(
        "joint {joint} `{name}` names joint {parent} as its parent, which does not come before it"
    )]
    ParentNotBefore {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
        /// Index of the parent that it names.
        parent: usize,
    },
    /// An End Site has a child: it would not be an end.
    #[error("joint {joint} `{name}` is an End Site, and joint {child} names it as its parent")]
    EndSiteWithChild {
        /// Index of the End Site.
        joint: usize,
        /// Its name.
        name: String,
        /// Index of the first joint that names it as its parent.
        child: usize,
    },
    /// A rest transform holds a number that is not finite.
    #[error("the rest transform of joint {joint} `{name}` is not finite")]
    NotFinite {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
    },
    /// A joint is farther from its parent than posekit works with.
    #[error(
        "joint {joint} `{name}` has an offset of {value:e}, which is not within {LONGEST_LENGTH:e}"
    )]
    TooFar {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
        /// The coordinate that is too large.
        value: f64,
    },
    /// A rest rotation is not of unit length.
    #[error(
        "the rest rotation of joint {joint} `{name}` is not a unit quaternion (length {length})"
    )]
    NotUnit {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
        /// The quaternion's length.
        length: f32,
    },
}

#[derive(Clone, Debug)]
struct Joint {
    name: String,
    parent: Option<usize>,
    rest_translation: Vec3,
    rest_rotation: Quat,
    is_end_site: bool,
}

/// Collects joints, parents before children, and makes a [`Skeleton`] of them.
///
/// ```
/// use glam::Vec3;
/// use posekit::skeleton::SkeletonBuilder;
///
/// let mut builder = SkeletonBuilder::new();
/// let shoulder = builder.joint("Shoulder", None, Vec3::ZERO);
/// let elbow = builder.joint("Elbow", Some(shoulder), Vec3::new(0.3, 0.0, 0.0));
/// builder.end_site("Hand", elbow, Vec3::new(0.25, 0.0, 0.0));
/// let skeleton = builder.build()?;
/// assert_eq!(skeleton.joint_count(), 3);
/// assert_eq!(skeleton.name(skeleton.children(shoulder)[0]), "Elbow");
/// # Ok::<(), posekit::skeleton::SkeletonError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SkeletonBuilder {
    joints: Vec<Joint>,
}

impl SkeletonBuilder {
    /// A builder without joints.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a joint whose rest rotation is the identity.
    pub fn joint(
        &mut self,
        name: impl Into<String>,
        parent: Option<JointId>,
        rest_translation: Vec3,
    ) -> JointId {
        self.push(name.into(), parent, rest_translation, Quat::IDENTITY, false)
    }

    /// Adds a joint with a rest rotation, as glTF and URDF have them.
    pub fn oriented_joint(
        &mut self,
        name: impl Into<String>,
        parent: Option<JointId>,
        rest_translation: Vec3,
        rest_rotation: Quat,
    ) -> JointId {
        self.push(name.into(), parent, rest_translation, rest_rotation, false)
    }

    /// Adds the free end of a link: a joint that never turns.
    pub fn end_site(
        &mut self,
        name: impl Into<String>,
        parent: JointId,
        rest_translation: Vec3,
    ) -> JointId {
        self.push(
            name.into(),
            Some(parent),
            rest_translation,
            Quat::IDENTITY,
            true,
        )
    }

    fn push(
        &mut self,
        name: String,
        parent: Option<JointId>,
        rest_translation: Vec3,
        rest_rotation: Quat,
        is_end_site: bool,
    ) -> JointId {
        let id = JointId::new(self.joints.len());
        let parent = parent.map(JointId::index);
        self.joints.push(Joint {
            name,
            parent,
            rest_translation,
            rest_rotation,
            is_end_site,
        });
        id
    }

    /// Checks the joints and makes the skeleton.
    ///
    /// # Errors
    /// If there is no joint, a parent does not come before its child or is an End Site, or a rest
    /// transform is not finite, longer than [`LONGEST_LENGTH`] or not a rotation.
    pub fn build(self) -> Result<Skeleton, SkeletonError> {
        if self.joints.is_empty() {
            return Err(SkeletonError::Empty);
        }
        for (index, joint) in self.joints.iter().enumerate() {
            validate(index, joint)?;
            validate_parent(index, joint, &self.joints)?;
        }
        let (child_starts, children) = children_by_parent(&self.joints);
        let unique_names = unique_names(self.joints.iter().map(|joint| joint.name.as_str()));
        let roots = self
            .joints
            .iter()
            .enumerate()
            .filter(|(_, joint)| joint.parent.is_none());
        let mut by_unique_name: Vec<JointId> = (0..self.joints.len()).map(JointId::new).collect();
        by_unique_name.sort_by(|a, b| unique_names[a.index()].cmp(&unique_names[b.index()]));
        let mut skeleton = Skeleton {
            names: Vec::with_capacity(self.joints.len()),
            unique_names,
            by_unique_name,
            parents: self
                .joints
                .iter()
                .map(|joint| joint.parent.map(JointId::new))
                .collect(),
            roots: roots.map(|(index, _)| JointId::new(index)).collect(),
            links_by_depth: links_by_depth(&self.joints),
            child_starts,
            children,
            rest_translations: self
                .joints
                .iter()
                .map(|joint| joint.rest_translation)
                .collect(),
            rest_rotations: self
                .joints
                .iter()
                .map(|joint| joint.rest_rotation)
                .collect(),
            end_sites: self.joints.iter().map(|joint| joint.is_end_site).collect(),
            known_pairs: KnownPairs::default(),
        };
        skeleton
            .names
            .extend(self.joints.into_iter().map(|joint| joint.name));
        Ok(skeleton)
    }
}

/// How far a rest rotation's length may be from 1: f32 files with 6 digits stay well inside.
const UNIT_TOLERANCE: f32 = 1e-3;

fn validate(index: usize, joint: &Joint) -> Result<(), SkeletonError> {
    let name = || joint.name.clone();
    if !joint.rest_translation.is_finite() || !joint.rest_rotation.is_finite() {
        return Err(SkeletonError::NotFinite {
            joint: index,
            name: name(),
        });
    }
    let offset = joint.rest_translation.to_array().map(f64::from);
    if let Some(value) = offset.into_iter().find(|&value| !are_lengths([value])) {
        return Err(SkeletonError::TooFar {
            joint: index,
            name: name(),
            value,
        });
    }
    let length = joint.rest_rotation.length();
    if (length - 1.0).abs() > UNIT_TOLERANCE {
        return Err(SkeletonError::NotUnit {
            joint: index,
            name: name(),
            length,
        });
    }
    Ok(())
}

fn validate_parent(index: usize, joint: &Joint, joints: &[Joint]) -> Result<(), SkeletonError> {
    match joint.parent {
        Some(parent) if parent >= index => Err(SkeletonError::ParentNotBefore {
            joint: index,
            name: joint.name.clone(),
            parent,
        }),
        Some(parent) if joints[parent].is_end_site => Err(SkeletonError::EndSiteWithChild {
            joint: parent,
            name: joints[parent].name.clone(),
            child: index,
        }),
        _ => Ok(()),
    }
}

/// All children lists in one allocation: joint `j`'s are `children[starts[j]..starts[j + 1]]`.
fn children_by_parent(joints: &[Joint]) -> (Vec<u32>, Vec<JointId>) {
    let mut starts = vec![0_u32; joints.len() + 1];
    for parent in joints.iter().filter_map(|joint| joint.parent) {
        starts[parent + 1] += 1;
    }
    for index in 0..joints.len() {
        starts[index + 1] += starts[index];
    }
    let mut next = starts.clone();
    let mut children = vec![JointId::new(0); starts[joints.len()] as usize];
    for (index, joint) in joints.iter().enumerate() {
        if let Some(parent) = joint.parent {
            children[next[parent] as usize] = JointId::new(index);
            next[parent] += 1;
        }
    }
    (starts, children)
}

/// The links level by level, and in topological order within a level.
fn links_by_depth(joints: &[Joint]) -> Vec<Link> {
    let mut depths: Vec<usize> = Vec::with_capacity(joints.len());
    let mut links = Vec::with_capacity(joints.len());
    for (index, joint) in joints.iter().enumerate() {
        depths.push(joint.parent.map_or(0, |parent| depths[parent] + 1));
        if let Some(parent) = joint.parent {
            links.push(Link {
                parent: JointId::new(parent),
                child: JointId::new(index),
            });
        }
    }
    links.sort_by_key(|link| depths[link.child.index()]);
    links
}

/// Names told apart as Blender does it: the second `Spine` becomes `Spine.001`.
fn unique_names<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Vec<String> {
    let given: HashSet<&str> = names.clone().collect();
    let mut taken: HashSet<String> = HashSet::new();
    let mut next_suffix = std::collections::HashMap::<&str, usize>::new();
    names
        .map(|name| {
            if taken.insert(name.to_owned()) {
                return name.to_owned();
            }
            let counter = next_suffix.entry(name).or_insert(1);
            loop {
                let candidate = format!("{name}.{counter:03}");
                *counter += 1;
                if !given.contains(candidate.as_str()) && taken.insert(candidate.clone()) {
                    return candidate;
                }
            }
        })
        .collect()
}
