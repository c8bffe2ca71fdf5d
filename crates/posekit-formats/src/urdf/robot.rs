//! From the document to a mechanism.

use glam::{DQuat, DVec3};
use posekit::mechanism::{Follow, Freedom, Mechanism, MechanismError, MechanismJoint, ValueRange};
use posekit::range::{LONGEST_LENGTH, are_lengths};
use posekit::skeleton::{JointId, SkeletonBuilder, SkeletonError};

use super::{Urdf, UrdfJoint, UrdfJointKind, UrdfOrigin};

/// Which axis of the world points up when a robot is taken out of its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// Y, as everywhere in posekit: the file's X (forward) becomes Z, its Y (left) becomes X, its Z (up)
    /// becomes Y. It is a turn of the root alone: every frame below stays the one that the file says.
    #[default]
    Y,
    /// Z: the world stays the file's own, to compare numbers with other programs.
    Z,
}

impl UpAxis {
    /// The rotation from the file's world to ours.
    pub const fn world_from_file(self) -> DQuat {
        match self {
            // A third of a turn about the diagonal: exact, X -> Z -> Y -> X.
            Self::Y => DQuat::from_xyzw(-0.5, -0.5, -0.5, 0.5),
            Self::Z => DQuat::IDENTITY,
        }
    }
}

/// Why no mechanism could be made of a document; one from [`read`](super::read()) has only
/// origins that are too far away.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RobotError {
    /// The skeleton could not be built.
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
    /// The way its joints move could not be taken over.
    #[error(transparent)]
    Mechanism(#[from] MechanismError),
}

impl UrdfOrigin {
    /// The rotation `Rz(yaw) * Ry(pitch) * Rx(roll)` as a unit quaternion.
    pub fn rotation(&self) -> DQuat {
        let [roll, pitch, yaw] = self.rpy;
        (posekit::rotation::exp(DVec3::Z * yaw)
            * posekit::rotation::exp(DVec3::Y * pitch)
            * posekit::rotation::exp(DVec3::X * roll))
        .normalize()
    }

    /// The translation.
    pub fn translation(&self) -> DVec3 {
        DVec3::from_array(self.xyz)
    }
}

impl Urdf {
    /// The joints in topological order: each comes after the one that carries the link it is mounted on,
    /// and those mounted on one link keep the file's order. Depth first.
    pub fn joints_from_root(&self) -> Vec<usize> {
        let mut mounted: Vec<Vec<usize>> = vec![Vec::new(); self.links.len()];
        for (index, joint) in self.joints.iter().enumerate() {
            mounted[joint.parent].push(index);
        }
        let mut order = Vec::with_capacity(self.joints.len());
        let mut pending: Vec<usize> = mounted[self.root].iter().rev().copied().collect();
        while let Some(joint) = pending.pop() {
            order.push(joint);
            pending.extend(mounted[self.joints[joint].child].iter().rev());
        }
        order
    }

    /// The link whose frame each joint of the skeleton of [`to_robot`](Self::to_robot) is, in
    /// topological order.
    pub fn links_from_root(&self) -> Vec<usize> {
        let carried = self.joints_from_root().into_iter();
        let carried = carried.map(|joint| self.joints[joint].child);
        std::iter::once(self.root).chain(carried).collect()
    }

    /// The joint of the skeleton of [`to_robot`](Self::to_robot) whose frame is that of the link of this name.
    pub fn joint_of_link(&self, name: &str) -> Option<JointId> {
        let links = self.links_from_root();
        let is_it = |&link: &usize| self.links[link].name == name;
        links.iter().position(is_it).map(JointId::new)
    }

    /// The robot as a mechanism. The skeleton's first joint is the frame of the root link and has its
    /// name; then there is one joint for each joint of the document, in the order of
    /// [`joints_from_root`](Self::joints_from_root), whose frame is that of the link it carries.
    ///
    /// # Errors
    /// If an origin is not within [`LONGEST_LENGTH`], or the document breaks the invariants that [`Urdf`]
    /// states.
    pub fn to_robot(&self, up: UpAxis) -> Result<Mechanism, RobotError> {
        let order = self.joints_from_root();
        let mut builder = SkeletonBuilder::new();
        let mut joints = Vec::with_capacity(order.len() + 1);
        let mut joint_of_link = vec![None; self.links.len()];
        let mut id_of_joint = vec![JointId::new(0); self.joints.len()];
        let root_name = self.links[self.root].name.as_str();
        let root_rotation = up.world_from_file();
        let root =
            builder.oriented_joint(root_name, None, glam::Vec3::ZERO, root_rotation.as_quat());
        joint_of_link[self.root] = Some(root);
        joints.push(MechanismJoint {
            rest_rotation: root_rotation,
            rest_translation: DVec3::ZERO,
            freedom: Freedom::Fixed,
            range: ValueRange::FREE,
            follows: None,
        });
        for (place, &index) in (1..).zip(&order) {
            let joint = &self.joints[index];
            let origin = joint.origin.xyz.into_iter();
            if let Some(value) = origin.clone().find(|&value| !are_lengths([value])) {
                // The file's number: `f32` may have none for it.
                return Err(RobotError::Skeleton(SkeletonError::TooFar {
                    joint: place,
                    name: joint.name.clone(),
                    value,
                }));
            }
            let id = builder.oriented_joint(
                joint.name.as_str(),
                joint_of_link[joint.parent],
                joint.origin.translation().as_vec3(),
                joint.origin.rotation().as_quat(),
            );
            joint_of_link[joint.child] = Some(id);
            id_of_joint[index] = id;
            joints.push(described(joint));
        }
        for &index in &order {
            if let Some(mimic) = self.joints[index].mimic {
                joints[id_of_joint[index].index()].follows = Some(Follow {
                    joint: id_of_joint[mimic.joint],
                    multiplier: mimic.multiplier,
                    offset: mimic.offset,
                });
            }
        }
        Ok(Mechanism::new(builder.build()?, joints)?)
    }
}

/// A joint without what it follows.
fn described(joint: &UrdfJoint) -> MechanismJoint {
    let axis = DVec3::from_array(joint.axis);
    let freedom = match joint.kind {
        UrdfJointKind::Revolute | UrdfJointKind::Continuous => Freedom::Hinge { axis },
        UrdfJointKind::Prismatic => Freedom::Slide { axis },
        UrdfJointKind::Planar => Freedom::Planar { normal: axis },
        UrdfJointKind::Floating => Freedom::Free,
        UrdfJointKind::Fixed => Freedom::Fixed,
    };
    let is_limited = matches!(
        joint.kind,
        UrdfJointKind::Revolute | UrdfJointKind::Prismatic
    );
    let range = match joint.limit {
        // Bounds that nothing reaches are the way in which some files say that there is none.
        Some(limit) if is_limited => ValueRange {
            lower: match limit.lower {
                lower if lower < -LONGEST_LENGTH => f64::NEG_INFINITY,
                lower => lower.min(LONGEST_LENGTH),
            },
            upper: match limit.upper {
                upper if upper > LONGEST_LENGTH => f64::INFINITY,
                upper => upper.max(-LONGEST_LENGTH),
            },
        },
        _ => ValueRange::FREE,
    };
    MechanismJoint {
        rest_rotation: joint.origin.rotation(),
        rest_translation: joint.origin.translation(),
        freedom,
        range,
        follows: None,
    }
}
