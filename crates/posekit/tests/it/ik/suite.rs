//! What has to be true of every solver's result, whatever the problem.

use glam::{DQuat, DVec3};
use posekit::ik::{Base, IkOutcome, IkProblem, IkReport, IkWorkspace, JointLimit, Solver, solve};
use posekit::pose::LocalPose;
use posekit::rotation::angle_between;
use posekit::skeleton::{JointId, Skeleton};

/// How far two computations of one place may be apart through single precision, as a share of the
/// figure's size.
const ROUNDING: f64 = 2e-6;

/// A joint's place in the world by forward kinematics in double precision, straight from the definition.
pub(super) fn place(skeleton: &Skeleton, pose: &LocalPose, joint: JointId) -> (DVec3, DQuat) {
    let index = joint.index();
    let rotation = pose.rotations[index].as_dquat().normalize();
    let translation = pose.translations[index].as_dvec3();
    match skeleton.parent(joint) {
        None => (translation, rotation),
        Some(parent) => {
            let (position, orientation) = place(skeleton, pose, parent);
            (
                position + orientation * translation,
                (orientation * rotation).normalize(),
            )
        }
    }
}

/// Sum of all bones and of how far the roots are from the origin: what rounding is a share of.
fn size(skeleton: &Skeleton, pose: &LocalPose) -> f64 {
    let all = skeleton.joints();
    all.map(|joint| f64::from(pose.translations[joint.index()].length()))
        .sum::<f64>()
        .max(1.0)
}

/// Solves, and checks all that every solver promises. The report.
pub(super) fn solve_checked(
    skeleton: &Skeleton,
    pose: &mut LocalPose,
    problem: &IkProblem,
    name: &str,
    solver: &Solver,
) -> IkReport {
    let before = pose.clone();
    let mut workspace = IkWorkspace::new();
    let report = solve(skeleton, pose, problem, solver, &mut workspace);
    assert_finite(pose, name);
    assert_residuals(skeleton, pose, problem, &report, name);
    assert_only_the_chain_moved(skeleton, [&before, pose], problem, &workspace, name);
    assert_limits(skeleton, pose, problem, &workspace, name);
    assert_base_held(skeleton, [&before, pose], problem, name);
    // The same again, with memory that was used, to the bit.
    let mut again = before;
    let second = solve(skeleton, &mut again, problem, solver, &mut workspace);
    assert_eq!(*pose, again, "{name}: deterministic");
    assert_eq!(report, second, "{name}: deterministic");
    report
}

fn assert_finite(pose: &LocalPose, name: &str) {
    assert!(
        pose.rotations
            .iter()
            .all(|r| r.is_finite() && r.is_normalized()),
        "{name}: finite"
    );
    assert!(
        pose.translations.iter().all(|t| t.is_finite()),
        "{name}: finite"
    );
}

fn assert_residuals(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    report: &IkReport,
    name: &str,
) {
    if matches!(report.outcome, IkOutcome::InvalidTarget { .. }) {
        return;
    }
    assert_eq!(report.residuals.len(), problem.targets.len());
    let rounding = ROUNDING * size(skeleton, pose);
    for (target, residual) in problem.targets.iter().zip(&report.residuals) {
        let (position, orientation) = place(skeleton, pose, target.effector);
        let point = position + orientation * target.point_in_effector;
        let distance = point.distance(target.position_in_world);
        let apart = (distance - residual.distance).abs();
        assert!(
            apart < rounding,
            "{name}: {distance} rebuilt, {} reported",
            residual.distance
        );
        if let Some(wanted) = target.orientation_in_world {
            let body = if skeleton.is_end_site(target.effector) {
                place(skeleton, pose, skeleton.parent(target.effector).unwrap()).1
            } else {
                orientation
            };
            let angle_rad = angle_between(body, wanted.normalize());
            let apart = (angle_rad - residual.angle_rad).abs();
            assert!(
                apart < 1e-5,
                "{name}: {angle_rad} rebuilt, {} reported",
                residual.angle_rad
            );
        }
    }
    if report.outcome == IkOutcome::Reached && !name.starts_with("aim") {
        assert!(report.largest_distance() <= problem.stop.position_tolerance);
        assert!(report.largest_angle_rad() <= problem.stop.orientation_tolerance_rad);
    }
}

/// Joints that were not the problem's to move are as they were, to the bit; bones keep their lengths, but
/// for joints that slide.
fn assert_only_the_chain_moved(
    skeleton: &Skeleton,
    [before, after]: [&LocalPose; 2],
    problem: &IkProblem,
    workspace: &IkWorkspace,
    name: &str,
) {
    for joint in skeleton.joints() {
        let index = joint.index();
        if !workspace.moved().iter().any(|moved| moved.joint == joint) {
            assert_eq!(
                before.rotations[index], after.rotations[index],
                "{name}: off the chain"
            );
        }
        let slides = matches!(problem.limits.limit(joint), JointLimit::Slide { .. });
        let is_root = skeleton.parent(joint).is_none();
        if !slides && (!is_root || problem.base == Base::Root) {
            assert_eq!(
                before.translations[index], after.translations[index],
                "{name}: a bone"
            );
        }
    }
}

fn assert_limits(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    workspace: &IkWorkspace,
    name: &str,
) {
    for moved in workspace.moved() {
        let joint = moved.joint;
        let limit = problem.limits.limit(joint);
        // A root that is carried along is no joint that turns, nor is one that only floats.
        let is_carried = skeleton.parent(joint).is_none() && problem.base != Base::Root;
        let is_stiff = problem.limits.stiffness(joint) == 1.0;
        let slides = matches!(limit, JointLimit::Slide { .. });
        let turns = limit != JointLimit::Fixed && !slides && !is_stiff;
        if skeleton.is_end_site(joint) {
            continue;
        }
        if is_carried && (!turns || matches!(problem.base, Base::Joint(_))) {
            continue;
        }
        let rest = skeleton.rest_rotation(joint).as_dquat().normalize();
        // In double precision: near gimbal lock the angles of a rotation in single precision say little.
        let motion = rest.conjugate() * moved.rotation;
        let written = pose.rotations[joint.index()].as_dquat().normalize();
        assert!(
            angle_between(written, moved.rotation) < 1e-6,
            "{name}: what was written"
        );
        match limit {
            JointLimit::Slide { axis, distance } => {
                let from_rest = pose.translations[joint.index()] - skeleton.rest_translation(joint);
                let slid = from_rest.as_dvec3().dot(rest * axis);
                assert!(
                    distance.min - 1e-5 <= slid && slid <= distance.max + 1e-5,
                    "{name}: {slid}"
                );
            }
            JointLimit::Fixed => panic!("{name}: a fixed joint moved"),
            limit => assert!(
                limit.allows(motion, 2e-6),
                "{name}: {limit:?} broken by {motion}"
            ),
        }
    }
}

fn assert_base_held(
    skeleton: &Skeleton,
    [before, after]: [&LocalPose; 2],
    problem: &IkProblem,
    name: &str,
) {
    let Base::Joint(base) = problem.base else {
        return;
    };
    let (was, is) = (
        place(skeleton, before, base).0,
        place(skeleton, after, base).0,
    );
    let rounding = ROUNDING * size(skeleton, after);
    assert!(
        was.distance(is) < rounding,
        "{name}: the base moved by {}",
        was.distance(is)
    );
}
