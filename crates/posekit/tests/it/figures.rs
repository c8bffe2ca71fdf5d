//! Random skeletons, poses and motions for the property tests, and a small figure drawn by hand.

use std::sync::Arc;

use glam::{Quat, Vec3};
use posekit::motion::{FrameTime, Motion};
use posekit::pose::LocalPose;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};
use proptest::prelude::*;

/// Lengths stay within this, so that tolerances can be stated as a share of the figure's reach.
pub(crate) const LONGEST: f32 = 2.0;

/// A rotation, evenly spread over all of them (Shoemake, "Uniform Random Rotations", Graphics Gems
/// III, 1992).
pub(crate) fn any_rotation() -> impl Strategy<Value = Quat> {
    let turn = 0.0..std::f32::consts::TAU;
    (0.0_f32..1.0, turn.clone(), turn).prop_map(|(share, first, second)| {
        let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
        let (first_sin, first_cos) = first.sin_cos();
        let (second_sin, second_cos) = second.sin_cos();
        Quat::from_xyzw(a * first_sin, a * first_cos, b * second_sin, b * second_cos).normalize()
    })
}

/// A vector with coordinates up to [`LONGEST`].
pub(crate) fn any_vector() -> impl Strategy<Value = Vec3> {
    proptest::array::uniform3(-LONGEST..LONGEST).prop_map(Vec3::from_array)
}

/// What one joint of a random skeleton is made of.
#[derive(Clone, Debug)]
struct Seed {
    /// Picks the parent among the joints before, or none.
    parent: prop::sample::Index,
    is_root: bool,
    is_end_site: bool,
    translation: Vec3,
    rotation: Option<Quat>,
}

fn any_seed() -> impl Strategy<Value = Seed> {
    let flags = (prop::bool::weighted(0.1), prop::bool::weighted(0.2));
    let rotation = prop::option::of(any_rotation());
    (any::<prop::sample::Index>(), flags, any_vector(), rotation).prop_map(
        |(parent, (is_root, is_end_site), translation, rotation)| Seed {
            parent,
            is_root,
            is_end_site,
            translation,
            rotation,
        },
    )
}

/// A skeleton of 1 to 24 joints with any branching, one root or more, End Sites, and rest rotations
/// on about half of its joints.
pub(crate) fn any_skeleton() -> impl Strategy<Value = Arc<Skeleton>> {
    proptest::collection::vec(any_seed(), 1..24).prop_map(|seeds| Arc::new(grow(&seeds)))
}

fn grow(seeds: &[Seed]) -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    // End Sites have no children.
    let mut parents: Vec<JointId> = Vec::new();
    for (index, seed) in seeds.iter().enumerate() {
        let name = format!("joint {index}");
        let parent = (!parents.is_empty() && !seed.is_root).then(|| *seed.parent.get(&parents));
        match (parent, seed.rotation) {
            (Some(parent), _) if seed.is_end_site => {
                builder.end_site(name, parent, seed.translation);
            }
            (parent, None) => parents.push(builder.joint(name, parent, seed.translation)),
            (parent, Some(rotation)) => {
                parents.push(builder.oriented_joint(name, parent, seed.translation, rotation));
            }
        }
    }
    builder.build().unwrap()
}

/// Any local pose of a skeleton: every joint turned, moved too.
pub(crate) fn any_pose(joint_count: usize) -> impl Strategy<Value = LocalPose> {
    let rotations = proptest::collection::vec(any_rotation(), joint_count);
    let translations = proptest::collection::vec(any_vector(), joint_count);
    (rotations, translations).prop_map(|(rotations, translations)| LocalPose {
        rotations,
        translations,
    })
}

/// A skeleton and a pose of it.
pub(crate) fn any_posed_skeleton() -> impl Strategy<Value = (Arc<Skeleton>, LocalPose)> {
    any_skeleton().prop_flat_map(|skeleton| {
        let pose = any_pose(skeleton.joint_count());
        (Just(skeleton), pose)
    })
}

/// A motion of 0 to 20 frames, which ends within a block of eight as a rule, with translation tracks
/// on some joints.
pub(crate) fn any_motion() -> impl Strategy<Value = Motion> {
    any_skeleton().prop_flat_map(|skeleton| {
        let joint_count = skeleton.joint_count();
        let poses = proptest::collection::vec(any_pose(joint_count), 0..20);
        let translated = proptest::collection::vec(any::<bool>(), joint_count);
        (Just(skeleton), poses, translated).prop_map(|(skeleton, poses, translated)| {
            let translated: Vec<JointId> = skeleton
                .joints()
                .filter(|joint| translated[joint.index()])
                .collect();
            Motion::from_poses(skeleton, FrameTime::of_fps(20), translated, &poses)
        })
    })
}

/// The largest distance that `f32` may put between two ways to the same point of these figures: they
/// reach at most 24 links of [`LONGEST`] in each coordinate, about 80 units, and every link rounds a
/// few times.
pub(crate) const POSITION_TOLERANCE: f32 = 2e-4;

/// As [`POSITION_TOLERANCE`] for orientations, in radians.
pub(crate) const ORIENTATION_TOLERANCE_RAD: f64 = 2e-5;

/// The angle between two orientations in radians, without the loss that an arccosine has at zero.
pub(crate) fn angle_rad(a: Quat, b: Quat) -> f64 {
    posekit::rotation::angle_between(a.as_dquat().normalize(), b.as_dquat().normalize())
}

/// Hips with a spine and a head, two legs; and a prop that stands apart with a root of its own:
///
/// ```text
/// 0 Hips
///   1 Spine
///     2 Head
///       3 Head_end
///   4 LeftLeg
///     5 LeftFoot
///   6 RightLeg
///     7 RightFoot
/// 8 Prop
///   9 Tip
/// ```
pub(crate) fn hand_drawn() -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    let hips = builder.joint("Hips", None, Vec3::new(0.0, 1.0, 0.0));
    let spine = builder.joint("Spine", Some(hips), Vec3::new(0.0, 0.3, 0.0));
    let head = builder.joint("Head", Some(spine), Vec3::new(0.0, 0.4, 0.0));
    builder.end_site("Head_end", head, Vec3::new(0.0, 0.2, 0.0));
    let left = builder.joint("LeftLeg", Some(hips), Vec3::new(0.1, 0.0, 0.0));
    builder.joint("LeftFoot", Some(left), Vec3::new(0.0, -0.9, 0.0));
    let right = builder.joint("RightLeg", Some(hips), Vec3::new(-0.1, 0.0, 0.0));
    builder.joint("RightFoot", Some(right), Vec3::new(0.0, -0.9, 0.0));
    let prop = builder.joint("Prop", None, Vec3::new(3.0, 0.0, 0.0));
    builder.joint("Tip", Some(prop), Vec3::new(0.0, 0.0, 0.5));
    builder.build().unwrap()
}
