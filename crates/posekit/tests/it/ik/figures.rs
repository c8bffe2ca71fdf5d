//! Figures for the solvers: a limb, a chain of many joints, a body, and random ones.

use glam::Vec3;
use posekit::ik::{
    CcdConfig, DampedLeastSquaresConfig, FabrikConfig, JacobianTransposeConfig,
    LevenbergMarquardtConfig, SelectivelyDampedConfig, Solver, SweepOrder,
};
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};

/// A solver under its name.
pub(super) struct Named {
    pub(super) name: &'static str,
    pub(super) solver: Solver,
}

/// Every solver that takes chains of any length and any number of targets.
pub(super) fn solvers() -> Vec<Named> {
    let named = |name, solver| Named { name, solver };
    let backwards = CcdConfig {
        order: SweepOrder::BaseToTip,
        ..CcdConfig::default()
    };
    let bounded = CcdConfig {
        max_step_rad: 0.2,
        ..CcdConfig::default()
    };
    vec![
        named("ccd", Solver::Ccd(CcdConfig::default())),
        named("ccd from the base", Solver::Ccd(backwards)),
        named("ccd in small steps", Solver::Ccd(bounded)),
        named("fabrik", Solver::Fabrik(FabrikConfig::default())),
        named(
            "transpose",
            Solver::JacobianTranspose(JacobianTransposeConfig::default()),
        ),
        named(
            "damped",
            Solver::DampedLeastSquares(DampedLeastSquaresConfig::default()),
        ),
        named(
            "selectively damped",
            Solver::SelectivelyDamped(SelectivelyDampedConfig::default()),
        ),
        named(
            "levenberg",
            Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default()),
        ),
    ]
}

/// A straight chain of `count` bones of length 1 along X; its joints, the last of them an End Site.
pub(super) fn straight_chain(count: usize) -> (Skeleton, Vec<JointId>) {
    let mut builder = SkeletonBuilder::new();
    let mut joints = vec![builder.joint("Base", None, Vec3::ZERO)];
    // A second joint at the same place turns, so that the root may be held.
    joints.push(builder.joint("Joint 1", Some(joints[0]), Vec3::ZERO));
    for index in 1..count {
        let name = format!("Joint {}", index + 1);
        joints.push(builder.joint(name, Some(joints[index]), Vec3::X));
    }
    let last = *joints.last().unwrap();
    joints.push(builder.end_site("End", last, Vec3::X));
    (builder.build().unwrap(), joints)
}

/// A body with a spine, two arms and two legs, about 1.7 high, arms out to the sides:
/// `hips, spine, chest, head`, then per side `shoulder, elbow, wrist, hand end`, `hip, knee, ankle, toe
/// end`.
pub(super) fn body() -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    let hips = builder.joint("Hips", None, Vec3::new(0.0, 0.95, 0.0));
    let spine = builder.joint("Spine", Some(hips), Vec3::new(0.0, 0.12, 0.0));
    let chest = builder.joint("Chest", Some(spine), Vec3::new(0.0, 0.18, 0.0));
    let head = builder.joint("Head", Some(chest), Vec3::new(0.0, 0.28, 0.0));
    builder.end_site("HeadEnd", head, Vec3::new(0.0, 0.18, 0.0));
    for (side, sign) in [("Left", 1.0_f32), ("Right", -1.0)] {
        let name = |part: &str| format!("{side}{part}");
        let across = |x: f32, y: f32| Vec3::new(sign * x, y, 0.0);
        let shoulder = builder.joint(name("Shoulder"), Some(chest), across(0.17, 0.2));
        let elbow = builder.joint(name("Elbow"), Some(shoulder), across(0.28, 0.0));
        let wrist = builder.joint(name("Wrist"), Some(elbow), across(0.25, 0.0));
        builder.end_site(name("Hand"), wrist, across(0.15, 0.0));
        let hip = builder.joint(name("Hip"), Some(hips), across(0.1, -0.06));
        let knee = builder.joint(name("Knee"), Some(hip), across(0.0, -0.42));
        let ankle = builder.joint(name("Ankle"), Some(knee), across(0.0, -0.40));
        builder.end_site(name("Toe"), ankle, Vec3::new(0.0, -0.06, 0.16));
    }
    builder.build().unwrap()
}

/// The joint of that name.
pub(super) fn joint(skeleton: &Skeleton, name: &str) -> JointId {
    skeleton.find(name).unwrap()
}
