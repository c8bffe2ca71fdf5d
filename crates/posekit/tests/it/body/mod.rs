//! Landmarks of figures laid out as many programs do, and of anything else.

pub(crate) mod conventions;

use std::sync::Arc;

use glam::Vec3;
use posekit::body::{Anatomy, Certainty, NoAnatomy};
use posekit::motion::Motion;
use posekit::pose::GlobalPose;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};
use proptest::prelude::*;

use conventions::figure::STRIDING;
use conventions::{Convention, all_conventions, conventions};

/// The names of the landmarks that were found: pelvis, chest, head, then hip, knee, ankle, shoulder,
/// elbow, wrist of the left, then of the right.
fn found(motion: &Motion, anatomy: &Anatomy) -> Vec<String> {
    let name = |joint: JointId| motion.skeleton().unique_name(joint).to_owned();
    let mut names = vec![
        name(anatomy.pelvis),
        name(anatomy.chest()),
        name(anatomy.head),
    ];
    let arms = anatomy.arms.as_ref().unwrap();
    for (leg, arm) in anatomy.legs.iter().zip(arms) {
        let joints = [
            leg.upper, leg.middle, leg.lower, arm.upper, arm.middle, arm.lower,
        ];
        names.extend(joints.map(name));
    }
    names
}

fn expected(convention: &Convention) -> Vec<String> {
    let trunk = convention.trunk().map(str::to_owned);
    let sides = [0, 1].map(|side| convention.landmarks(side));
    trunk.into_iter().chain(sides.concat()).collect()
}

#[test]
fn every_convention_has_its_landmarks() {
    assert_eq!(conventions().len(), 12);
    for convention in all_conventions() {
        let motion = convention.motion();
        let anatomy = Anatomy::of_motion(&motion);
        let anatomy = anatomy.unwrap_or_else(|why| panic!("{}: {why}", convention.label));
        assert_eq!(
            found(&motion, &anatomy),
            expected(&convention),
            "{}",
            convention.label
        );
    }
}

#[test]
fn landmarks_do_not_depend_on_the_pose() {
    for convention in all_conventions() {
        let motion = convention.motion();
        for frame in 0..motion.frame_count() {
            if convention.label == "ape" && frame > STRIDING {
                // An ape that crouches with its arms forward stands on four legs.
                continue;
            }
            let pose = motion.pose(frame).to_global(motion.skeleton());
            let anatomy = Anatomy::find(motion.skeleton(), &pose)
                .unwrap_or_else(|why| panic!("{} in frame {frame}: {why}", convention.label));
            assert_eq!(
                found(&motion, &anatomy),
                expected(&convention),
                "{} in frame {frame}",
                convention.label
            );
        }
    }
}

#[test]
fn names_that_say_nothing_are_no_hindrance() {
    // The child's bones are cut in two: without names nothing tells a segment from a bone.
    let whole_bones = |convention: &Convention| convention.label != "child";
    for convention in conventions().into_iter().filter(whole_bones) {
        let motion = convention.motion();
        let count = std::cell::Cell::new(0);
        let nameless = convention.motion_named(|_| {
            count.set(count.get() + 1);
            format!("Bone.{:03}", count.get())
        });
        let anatomy = Anatomy::of_motion(&nameless);
        let anatomy = anatomy.unwrap_or_else(|why| panic!("{}: {why}", convention.label));
        assert_eq!(
            found(&motion, &anatomy),
            expected(&convention),
            "{}",
            convention.label
        );
        assert_eq!(anatomy.certainty, Certainty::Likely);
    }
}

proptest! {
    /// Any tree, any lengths, names of bodies and names of nothing: an answer, and one of this skeleton.
    #[test]
    fn any_skeleton_is_answered(
        joints in prop::collection::vec(
            (any::<prop::sample::Index>(), prop::sample::select(NAMES), -3..3_i8, -3..3_i8, -3..3_i8),
            1..40,
        )
    ) {
        let mut builder = SkeletonBuilder::new();
        for (place, (parent, name, x, y, z)) in joints.iter().enumerate() {
            let parent = (place > 0).then(|| JointId::new(parent.index(place)));
            builder.joint(*name, parent, Vec3::new(f32::from(*x), f32::from(*y), f32::from(*z)));
        }
        let skeleton = builder.build().unwrap();
        let count = skeleton.joint_count();
        let pose = GlobalPose::rest(&skeleton);
        if let Ok(anatomy) = Anatomy::find(&skeleton, &pose) {
            for limb in anatomy.limbs() {
                prop_assert!(skeleton.ancestors(limb.lower).any(|j| j == limb.middle));
                prop_assert!(skeleton.ancestors(limb.middle).any(|j| j == limb.upper));
            }
            prop_assert!(anatomy.spine_count <= anatomy.trunk.len());
            prop_assert!(anatomy.head.index() < count);
            let axes = anatomy.axes(&pose);
            prop_assert!(axes.is_none_or(|axes| axes.forward.is_finite()));
        }
    }
}

const NAMES: &[&str] = &[
    "Hips",
    "Spine",
    "Head",
    "LeftUpLeg",
    "LeftLeg",
    "LeftFoot",
    "RightUpLeg",
    "RightLeg",
    "RightFoot",
    "LeftArm",
    "LeftForeArm",
    "LeftHand",
    "RightArm",
    "RightForeArm",
    "RightHand",
    "x",
    "",
    "LeftToe",
    "l",
    "Neck",
    "左足",
];

#[test]
fn a_hundred_thousand_joints_are_answered() {
    for name in ["LeftFoot", "x"] {
        let mut builder = SkeletonBuilder::new();
        let mut last = builder.joint("Hips", None, Vec3::ZERO);
        for _ in 0..100_000 {
            last = builder.joint(name, Some(last), Vec3::new(0.0, 1.0, 0.0));
        }
        let skeleton = builder.build().unwrap();
        assert!(Anatomy::find(&skeleton, &GlobalPose::rest(&skeleton)).is_err());
    }
}

#[test]
fn pieces_under_several_roots_are_a_doubt() {
    let mut builder = SkeletonBuilder::new();
    let hips = builder.joint("Hips", None, Vec3::Y);
    let chest = builder.joint("Chest", None, Vec3::new(0.0, 1.4, 0.0));
    let head = builder.joint("Head", Some(chest), Vec3::new(0.0, 0.3, 0.0));
    builder.end_site("HeadEnd", head, Vec3::new(0.0, 0.2, 0.0));
    for (side, x) in [("Left", 1.0), ("Right", -1.0)] {
        for (parent, names, bone) in [
            (hips, ["UpLeg", "Leg", "Foot"], Vec3::new(0.0, -0.45, 0.0)),
            (
                chest,
                ["Arm", "ForeArm", "Hand"],
                Vec3::new(0.3 * x, 0.0, 0.0),
            ),
        ] {
            let mut last = builder.joint(
                format!("{side}{}", names[0]),
                Some(parent),
                Vec3::new(0.1 * x, 0.0, 0.0),
            );
            for name in &names[1..] {
                last = builder.joint(format!("{side}{name}"), Some(last), bone);
            }
        }
    }
    let skeleton: Arc<Skeleton> = Arc::new(builder.build().unwrap());
    let found = Anatomy::find(&skeleton, &GlobalPose::rest(&skeleton));
    assert_eq!(found, Err(NoAnatomy::InPieces));
    assert!(NoAnatomy::InPieces.is_doubt());
}
