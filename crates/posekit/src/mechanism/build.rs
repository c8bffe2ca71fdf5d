//! Building a [`Mechanism`] and checking what it is built from.

use std::sync::Arc;

use super::{Follow, FollowedValue, Freedom, Mechanism, MechanismJoint, ValueRange};
use crate::range::are_lengths;
use crate::skeleton::{JointId, Skeleton};

/// Why a mechanism could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MechanismError {
    /// There must be one description for every joint of the skeleton.
    #[error("{given} joints are described, and the skeleton has {expected}")]
    JointCount {
        /// How many joints the skeleton has.
        expected: usize,
        /// How many are described.
        given: usize,
    },
    /// A number is not finite, an axis or quaternion not of unit length, or a range empty.
    #[error("the {what} of joint {joint} `{name}` is not valid")]
    Value {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
        /// What makes no sense.
        what: &'static str,
    },
    /// A joint that follows another, and the followed one, are hinges or slides; none follows itself.
    #[error("joint {joint} `{name}` cannot follow joint {followed}")]
    Follow {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
        /// Index of the joint that it names.
        followed: usize,
    },
}

/// How far an axis' or quaternion's length may be from 1.
const UNIT_TOLERANCE: f64 = 1e-6;

impl Mechanism {
    /// A mechanism of a skeleton whose joints move as `joints` says, one for each in topological order.
    ///
    /// # Errors
    /// If the numbers of joints differ, a joint's numbers make no sense, or a joint follows itself or
    /// one without exactly one value.
    pub fn new(
        skeleton: impl Into<Arc<Skeleton>>,
        joints: Vec<MechanismJoint>,
    ) -> Result<Self, MechanismError> {
        let skeleton = skeleton.into();
        if joints.len() != skeleton.joint_count() {
            return Err(MechanismError::JointCount {
                expected: skeleton.joint_count(),
                given: joints.len(),
            });
        }
        for (index, joint) in joints.iter().enumerate() {
            if let Some(what) = nonsense(joint) {
                return Err(MechanismError::Value {
                    joint: index,
                    name: skeleton.name(JointId::new(index)).to_owned(),
                    what,
                });
            }
        }
        let mut first_values = vec![0];
        let mut count = 0;
        for joint in &joints {
            let own = match joint.follows {
                Some(_) => 0,
                None => joint.freedom.value_count(),
            };
            // At most six for each joint, whose ids fit in 32 bits; no skeleton comes near.
            count += u32::try_from(own).unwrap_or(0);
            first_values.push(count);
        }
        let followed_values = followed_values(&skeleton, &joints, &first_values)?;
        Ok(Self {
            skeleton,
            joints,
            first_values,
            followed_values,
        })
    }

    /// A mechanism whose joints rest as the skeleton says and move freely in the ways given, one for
    /// each joint in topological order; joints beyond the end of the list are fixed.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of(
        skeleton: impl Into<Arc<Skeleton>>,
        freedoms: impl IntoIterator<Item = Freedom>,
    ) -> Result<Self, MechanismError> {
        let skeleton = skeleton.into();
        let mut freedoms = freedoms.into_iter();
        let joints = skeleton.joints().map(|joint| MechanismJoint {
            rest_rotation: skeleton.rest_rotation(joint).as_dquat().normalize(),
            rest_translation: skeleton.rest_translation(joint).as_dvec3(),
            freedom: freedoms.next().unwrap_or_default(),
            range: ValueRange::FREE,
            follows: None,
        });
        let joints = joints.collect();
        Self::new(skeleton, joints)
    }

    /// A figure as motion capture knows it: roots move freely, every other joint turns freely, End Sites
    /// do neither.
    #[allow(
        clippy::missing_panics_doc,
        reason = "rest transforms of a skeleton were checked when it was built"
    )]
    pub fn of_figure(skeleton: impl Into<Arc<Skeleton>>) -> Self {
        let skeleton = skeleton.into();
        let freedoms: Vec<Freedom> = skeleton
            .joints()
            .map(|joint| match skeleton.parent(joint) {
                None => Freedom::Free,
                Some(_) if skeleton.is_end_site(joint) => Freedom::Fixed,
                Some(_) => Freedom::Ball,
            })
            .collect();
        Self::of(skeleton, freedoms).expect("a skeleton's rest transforms are finite rotations")
    }
}

/// What about a joint makes no sense, if anything does not.
fn nonsense(joint: &MechanismJoint) -> Option<&'static str> {
    if !joint.rest_translation.is_finite() {
        return Some("rest translation");
    }
    let length = joint.rest_rotation.length();
    if (length - 1.0).abs() > UNIT_TOLERANCE || !length.is_finite() {
        return Some("rest rotation");
    }
    if let Freedom::Hinge { axis } | Freedom::Slide { axis } | Freedom::Planar { normal: axis } =
        joint.freedom
    {
        let length = axis.length();
        if (length - 1.0).abs() > UNIT_TOLERANCE || !length.is_finite() {
            return Some("axis");
        }
    }
    let is_range = joint.range.lower <= joint.range.upper;
    if !is_range {
        return Some("range");
    }
    match joint.follows {
        Some(follow) if !(follow.multiplier.is_finite() && follow.offset.is_finite()) => {
            Some("way of following another")
        }
        _ => None,
    }
}

/// Follows followers of followers to the joint that has a value of its own. Linear in the number of
/// joints.
fn followed_values(
    skeleton: &Skeleton,
    joints: &[MechanismJoint],
    first_values: &[u32],
) -> Result<Vec<Option<FollowedValue>>, MechanismError> {
    let mut found: Vec<Option<FollowedValue>> = vec![None; joints.len()];
    for start in 0..joints.len() {
        let mut way: Vec<(usize, Follow)> = Vec::new();
        let mut at = start;
        let end = loop {
            let error = |followed: usize| MechanismError::Follow {
                joint: start,
                name: skeleton.name(JointId::new(start)).to_owned(),
                followed,
            };
            let Some(follow) = joints[at].follows else {
                break FollowedValue {
                    index: first_values[at] as usize,
                    multiplier: 1.0,
                    offset: 0.0,
                };
            };
            if let Some(known) = found[at] {
                break known;
            }
            let next = follow.joint.index();
            let both_have_one = next < joints.len()
                && [at, next].map(|joint| joints[joint].freedom.value_count()) == [1, 1];
            if !both_have_one || way.len() > joints.len() {
                return Err(error(next));
            }
            way.push((at, follow));
            at = next;
        };
        let mut value = end;
        for (joint, follow) in way.into_iter().rev() {
            value = FollowedValue {
                index: value.index,
                multiplier: follow.multiplier * value.multiplier,
                offset: follow.multiplier * value.offset + follow.offset,
            };
            if !are_lengths([value.multiplier, value.offset]) {
                return Err(MechanismError::Follow {
                    joint,
                    name: skeleton.name(JointId::new(joint)).to_owned(),
                    followed: follow.joint.index(),
                });
            }
            found[joint] = Some(value);
        }
    }
    Ok(found)
}
