//! Inverse kinematics: joint rotations that bring end effectors to their targets.
//!
//! One problem ([`IkProblem`]: targets, what is held, what may move, limits), several solvers
//! ([`Solver`]), one report ([`IkReport`]). A problem may be a [`Chain`](crate::skeleton::Chain) between any
//! two joints, including one that climbs from a foot to the hips and goes down to a hand, with the foot
//! in place and the root moving; or a whole figure with any number of targets.
//!
//! **Space and units.** Targets are in the world, lengths in the file's unit, angles in radians. Poses are
//! `f32`, solvers are `f64` inside.
//!
//! **What every solver guarantees** (the tests run all of them through one suite): the residuals of the
//! report are those that forward kinematics finds in the pose that was left; bones keep their lengths;
//! joints keep their limits; joints that the problem does not move keep their local transforms to the bit;
//! output is finite and deterministic for targets out of reach, chains of no length, joints that coincide,
//! targets straight along a chain or right behind it; and a target that moves a little moves the pose a
//! little.
//!
//! ```
//! use glam::{DVec3, Vec3};
//! use posekit::ik::{CcdConfig, IkProblem, IkWorkspace, Solver, solve};
//! use posekit::pose::LocalPose;
//! use posekit::skeleton::SkeletonBuilder;
//!
//! let mut builder = SkeletonBuilder::new();
//! let body = builder.joint("Body", None, Vec3::ZERO);
//! let shoulder = builder.joint("Shoulder", Some(body), Vec3::new(0.0, 1.4, 0.0));
//! let elbow = builder.joint("Elbow", Some(shoulder), Vec3::new(0.3, 0.0, 0.0));
//! let hand = builder.end_site("Hand", elbow, Vec3::new(0.25, 0.0, 0.0));
//! let skeleton = builder.build()?;
//!
//! let arm = skeleton.chain(shoulder, hand).expect("one figure");
//! let problem = IkProblem::for_chain(&skeleton, &arm, DVec3::new(0.2, 1.6, 0.3));
//! let mut pose = LocalPose::rest(&skeleton);
//! let solver = Solver::Ccd(CcdConfig::default());
//! let report = solve(&skeleton, &mut pose, &problem, &solver, &mut IkWorkspace::new());
//!
//! assert!(report.outcome.is_reached());
//! let hand_in_world = pose.to_global(&skeleton).positions[hand.index()];
//! assert!(hand_in_world.distance(Vec3::new(0.2, 1.6, 0.3)) < 1e-3);
//! # Ok::<(), posekit::skeleton::SkeletonError>(())
//! ```

mod aim;
mod ccd;
mod fabrik;
mod least_squares;
mod limit;
mod linkage;
mod problem;
mod pull;
mod random;
mod report;
pub mod robot;
mod solve;
mod target;
mod trace;
mod turn;
mod two_bone;
mod workspace;

pub use aim::{Aim, aim};
pub use ccd::{CcdConfig, SweepOrder};
pub use fabrik::{FabrikConfig, fabrik_points};
pub use least_squares::{
    DampedLeastSquaresConfig, DescentDirection, JacobianTransposeConfig, LevenbergMarquardtConfig,
    SelectivelyDampedConfig,
};
pub use limit::{Interval, JointLimit, JointLimitError, JointLimits};
pub use problem::{
    Base, IkProblem, Movable, PreferredPose, RestPull, StartJoint, StopRule, TraceDetail,
};
pub use report::{IkOutcome, IkReport, IkResidual};
pub use solve::{Solver, solve};
pub use target::{IkTarget, Pole};
pub use trace::{IkTrace, MovedJoint, TraceIteration, TraceUpdate};
pub use two_bone::{TwoBone, TwoBoneConfig, TwoBoneTurns, two_bone};
pub use workspace::IkWorkspace;
