//! The default solver against a search: it finds what a search finds, from any start.
//!
//! Chains of 2 to 7 joints with limits of all kinds. Half of the targets are where a random pose within the limits
//! puts the end, so that they can be reached for certain; the others lie anywhere, and a search from many starts,
//! coordinate by coordinate, says how near the end can come. It shares nothing with the solvers but the limits'
//! meaning: it goes through angles, not through poses.

use core::f64::consts::PI;
use std::sync::Arc;

use glam::{DQuat, DVec3, Vec3};
use posekit::ik::{
    CcdConfig, FabrikConfig, IkOutcome, IkProblem, Interval, JointLimit, JointLimits,
    LevenbergMarquardtConfig, Solver,
};
use posekit::pose::LocalPose;
use posekit::rotation::EulerOrder;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};

use super::figures::{body, joint};
use super::suite::{place, solve_checked};

/// Numbers that are the same everywhere (Lehmer 1951, with the multiplier of Park, Miller and Stockmeyer 1993).
struct Dice(u64);

impl Dice {
    fn roll(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        low + (high - low) * self.0 as f64 / 2_147_483_647.0
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(
                self.roll(-1.0, 1.0),
                self.roll(-1.0, 1.0),
                self.roll(-1.0, 1.0),
            );
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// A number below `count`.
    #[expect(clippy::cast_possible_truncation, reason = "below a small number")]
    fn pick(&mut self, count: u32) -> u32 {
        self.roll(0.0, f64::from(count)) as u32
    }

    /// A range: to both sides, to one side of the rest angle, or across half a turn.
    fn range(&mut self) -> Interval {
        let width = self.roll(0.3, 2.6);
        match self.pick(4) {
            0 => Interval::new(-0.5 * width, 0.5 * width),
            1 => Interval::new(0.0, width),
            2 => Interval::new(-width, 0.0),
            _ => {
                let middle = self.roll(2.0, 4.2);
                Interval::new(middle - width, middle + width)
            }
        }
    }

    fn limit(&mut self) -> JointLimit {
        match self.pick(7) {
            0..3 => JointLimit::Hinge {
                axis: self.direction(),
                angle_rad: self.range(),
            },
            3 => JointLimit::Free,
            4 => JointLimit::Cone {
                axis: self.direction(),
                swing_max_rad: self.roll(0.2, 2.0),
                twist_rad: Interval::symmetric(self.roll(0.1, 1.5)),
            },
            _ => JointLimit::Euler {
                order: EulerOrder::ZXY,
                angles_rad: [
                    self.range(),
                    Interval::symmetric(self.roll(0.1, 1.4)),
                    Interval::symmetric(self.roll(0.1, 1.5)),
                ],
            },
        }
    }
}

/// A chain with limits: a held root, then `count` joints that turn, then an end.
struct Case {
    skeleton: Skeleton,
    joints: Vec<JointId>,
    offsets: Vec<DVec3>,
    limits: JointLimits,
}

/// The coordinates of one joint: what the search goes through, and the range of each.
fn ranges(limit: &JointLimit) -> Vec<Interval> {
    let whole = Interval::symmetric(PI);
    match *limit {
        JointLimit::Hinge { angle_rad, .. } => vec![angle_rad],
        JointLimit::Euler { angles_rad, .. } => angles_rad.to_vec(),
        // The direction and the size of the swing, and the twist.
        JointLimit::Cone {
            swing_max_rad,
            twist_rad,
            ..
        } => {
            vec![whole, Interval::new(0.0, swing_max_rad), twist_rad]
        }
        _ => vec![whole, Interval::new(0.0, PI), whole],
    }
}

fn motion(limit: &JointLimit, values: &[f64]) -> DQuat {
    let swing_twist = |axis: DVec3| {
        let side = axis.any_orthonormal_vector();
        let swing_axis = DQuat::from_axis_angle(axis, values[0]) * side;
        DQuat::from_axis_angle(swing_axis, values[1]) * DQuat::from_axis_angle(axis, values[2])
    };
    match *limit {
        JointLimit::Hinge { axis, .. } => DQuat::from_axis_angle(axis, values[0]),
        JointLimit::Euler { order, .. } => order.to_quat([values[0], values[1], values[2]]),
        JointLimit::Cone { axis, .. } => swing_twist(axis),
        _ => swing_twist(DVec3::Y),
    }
}

impl Case {
    fn new(dice: &mut Dice, count: usize, is_straight: bool) -> Self {
        let line = dice.direction();
        let mut builder = SkeletonBuilder::new();
        let mut joints = vec![builder.joint("Root", None, Vec3::ZERO)];
        let mut offsets = vec![DVec3::ZERO];
        for index in 0..=count {
            let along = if is_straight { line } else { dice.direction() };
            let offset = (along * dice.roll(0.2, 1.0)).as_vec3();
            // The first joint lies at the root.
            let offset = if index == 0 { Vec3::ZERO } else { offset };
            let parent = joints[index];
            joints.push(if index == count {
                builder.end_site("End", parent, offset)
            } else {
                builder.joint(format!("Joint {}", index + 1), Some(parent), offset)
            });
            offsets.push(offset.as_dvec3());
        }
        let mut limits = JointLimits::default();
        for &joint in &joints[1..=count] {
            limits.set_limit(joint, dice.limit()).unwrap();
        }
        Self {
            skeleton: builder.build().unwrap(),
            joints,
            offsets,
            limits,
        }
    }

    fn reach(&self) -> f64 {
        self.offsets.iter().map(|offset| offset.length()).sum()
    }

    fn moving(&self) -> &[JointId] {
        &self.joints[1..self.joints.len() - 1]
    }

    fn ranges(&self) -> Vec<Interval> {
        let limits = self.moving().iter().map(|&joint| self.limits.limit(joint));
        limits.flat_map(|limit| ranges(&limit)).collect()
    }

    fn motions(&self, values: &[f64]) -> Vec<DQuat> {
        let mut at = 0;
        let limits = self.moving().iter().map(|&joint| self.limits.limit(joint));
        limits
            .map(|limit| {
                let count = ranges(&limit).len();
                at += count;
                motion(&limit, &values[at - count..at])
            })
            .collect()
    }

    fn end(&self, values: &[f64]) -> DVec3 {
        let mut at = DVec3::ZERO;
        let mut turn = DQuat::IDENTITY;
        for (motion, offset) in self.motions(values).iter().zip(&self.offsets[2..]) {
            turn *= *motion;
            at += turn * *offset;
        }
        at
    }

    fn any_values(&self, dice: &mut Dice) -> Vec<f64> {
        let ranges = self.ranges();
        ranges
            .iter()
            .map(|range| dice.roll(range.min, range.max))
            .collect()
    }

    fn pose(&self, values: &[f64]) -> LocalPose {
        let mut pose = LocalPose::rest(&self.skeleton);
        for (&joint, motion) in self.moving().iter().zip(self.motions(values)) {
            pose.rotations[joint.index()] = motion.as_quat().normalize();
        }
        pose
    }

    /// The least distance that a search finds: from many starts, one coordinate after another by ever smaller
    /// steps, the best of a grid first.
    fn search(&self, dice: &mut Dice, target: DVec3, starts: u32) -> f64 {
        let ranges = self.ranges();
        let miss = |values: &[f64]| self.end(values).distance(target);
        let mut best = f64::INFINITY;
        for _ in 0..starts {
            let mut values = self.any_values(dice);
            let mut now = miss(&values);
            let mut step = 0.5;
            while step > 1e-5 && now > 1e-5 {
                let mut has_moved = false;
                for k in 0..values.len() {
                    for by in [step, -step] {
                        let before = values[k];
                        values[k] = ranges[k].clamp(before + by);
                        let then = miss(&values);
                        if then < now {
                            now = then;
                            has_moved = true;
                            break;
                        }
                        values[k] = before;
                    }
                }
                if !has_moved {
                    step *= 0.5;
                }
            }
            best = best.min(now);
        }
        best
    }

    fn problem(&self, target: DVec3) -> IkProblem {
        let chain = self
            .skeleton
            .chain(self.joints[1], self.joints[self.joints.len() - 1]);
        let mut problem = IkProblem::for_chain(&self.skeleton, &chain.unwrap(), target);
        problem.limits = Arc::new(self.limits.clone());
        problem
    }
}

fn levenberg() -> Solver {
    Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default())
}

/// Straight, or in any pose within the limits.
fn any_start(dice: &mut Dice, case: u32, chain: &Case) -> LocalPose {
    if case % 4 < 2 {
        LocalPose::rest(&chain.skeleton)
    } else {
        let values = chain.any_values(dice);
        chain.pose(&values)
    }
}

/// Every target that can be reached is; `docs/ik.md` has the share that this prints (`cargo test -p posekit
/// --test it the_default_solver -- --nocapture`).
#[test]
fn the_default_solver_reaches_what_can_be_reached() {
    let mut dice = Dice(20_261_130);
    let cases = 50;
    for count in 2..=7 {
        let mut reached = 0;
        for case in 0..cases {
            let chain = Case::new(&mut dice, count, case % 2 == 0);
            let mut pose = any_start(&mut dice, case, &chain);
            let within = chain.any_values(&mut dice);
            let problem = chain.problem(chain.end(&within));
            let report = solve_checked(&chain.skeleton, &mut pose, &problem, "lm", &levenberg());
            reached += u32::from(report.outcome.is_reached());
        }
        println!("{count} joints: {reached} of {cases} reached");
        assert_eq!(reached, cases, "{count} joints");
    }
}

/// Where the end cannot get to its target it comes as near as a search brings it, give or take a two-hundredth of
/// the reach; and limits are blamed for nothing that the search reaches.
#[test]
fn the_default_solver_comes_as_near_as_a_search() {
    let mut dice = Dice(11_302_026);
    let cases = 8;
    for count in 2..=7 {
        let (mut near, mut worst) = (0, 0.0_f64);
        for case in 0..cases {
            let chain = Case::new(&mut dice, count, case % 2 == 0);
            let mut pose = any_start(&mut dice, case, &chain);
            let target = dice.direction() * dice.roll(0.1, 1.2) * chain.reach();
            let problem = chain.problem(target);
            let report = solve_checked(&chain.skeleton, &mut pose, &problem, "lm", &levenberg());
            let best = chain.search(&mut dice, target, 5);
            let more = (report.largest_distance() - best) / chain.reach();
            worst = worst.max(more);
            near += u32::from(more <= 0.005);
            let is_blamed = report.outcome == IkOutcome::LimitsInTheWay;
            assert!(
                !is_blamed || best > problem.stop.position_tolerance,
                "{count}: limits in the way, but {best}"
            );
        }
        println!(
            "{count} joints: {near} of {cases} as near as a search (at most {worst:.4} of the reach more)"
        );
        assert_eq!(near, cases, "{count} joints: {worst}");
    }
}

/// The leg of the issue that led to this: straight, a knee that bends one way, a target straight up the leg.
#[test]
fn a_straight_leg_with_a_knee_folds() {
    let skeleton = body();
    let ends = [joint(&skeleton, "LeftHip"), joint(&skeleton, "LeftAnkle")];
    let chain = skeleton.chain(ends[0], ends[1]).unwrap();
    let rest = LocalPose::rest(&skeleton);
    let foot = place(&skeleton, &rest, ends[1]).0;
    for range in [Interval::new(0.0, 2.6), Interval::new(-2.6, 0.0)] {
        let mut limits = JointLimits::default();
        let knee = JointLimit::Hinge {
            axis: DVec3::X,
            angle_rad: range,
        };
        limits
            .set_limit(joint(&skeleton, "LeftKnee"), knee)
            .unwrap();
        for offset in [
            DVec3::new(0.0, 0.25, 0.01),
            DVec3::new(0.0, 0.25, 0.0),
            DVec3::new(0.0, 0.25, -0.1),
        ] {
            let mut problem = IkProblem::for_chain(&skeleton, &chain, foot + offset);
            problem.limits = Arc::new(limits.clone());
            problem.stop.max_iterations = 200;
            for (name, solver) in [
                ("lm", levenberg()),
                ("ccd", Solver::Ccd(CcdConfig::default())),
                ("fabrik", Solver::Fabrik(FabrikConfig::default())),
            ] {
                // FABRIK does not get out of a leg that points at its target exactly.
                if name == "fabrik" && offset.z == 0.0 {
                    continue;
                }
                let mut pose = rest.clone();
                let report = solve_checked(&skeleton, &mut pose, &problem, name, &solver);
                assert_eq!(
                    report.outcome,
                    IkOutcome::Reached,
                    "{name} {range:?} {offset} {report:?}"
                );
            }
        }
    }
}
