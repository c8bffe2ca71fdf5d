//! Frame after frame: the problem, its solution, and what is carried to the next frame.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use posekit::ik::{
    Base, IkProblem, IkReport, IkTarget, IkWorkspace, Movable, MovedJoint, Pole, PreferredPose,
    RestPull, Solver, StartJoint, TraceDetail, TwoBoneConfig, solve,
};
use posekit::pose::{GlobalPose, LocalPose, forward_kinematics};
use posekit::rotation::angle_between;
use posekit::skeleton::{Chain, JointId, Skeleton};

use super::IkArgs;
use super::figure::Figure;
use super::goals::Goal;
use super::limits;
use super::numbers::Orientation;
use super::solver::SolverName;
use crate::args::Global;
use crate::failure::Failure;
use crate::progress::Progress;

/// What is done to every frame.
#[derive(Debug)]
pub(super) struct Task {
    /// The targets.
    pub(super) goals: Vec<Goal>,
    /// The solver's name.
    pub(super) solver_name: SolverName,
    solver: Solver,
    /// The problem but for its targets.
    problem: IkProblem,
    frames: Vec<usize>,
    is_cold: bool,
}

/// What came of a frame.
#[derive(Debug)]
pub(super) struct FrameResult {
    /// The frame.
    pub(super) frame: usize,
    /// The targets, as they were in this frame.
    pub(super) targets: Vec<IkTarget>,
    /// The solver's report.
    pub(super) report: IkReport,
    /// The joint that turned most against its pose before, and by how much.
    pub(super) largest_turn: Option<(JointId, f64)>,
}

/// What came of all frames.
#[derive(Debug)]
pub(super) struct Results {
    /// The frames, in order.
    pub(super) frames: Vec<FrameResult>,
    /// The largest turn of a joint of the chains from one frame to the next, in the new motion and in the
    /// old; over neighbouring frames only.
    pub(super) largest_step_rad: Option<[f64; 2]>,
}

impl Task {
    /// Reads the options.
    pub(super) fn new(
        args: &IkArgs,
        figure: &Figure,
        goals: Vec<Goal>,
        notes: &mut Vec<String>,
        global: &Global,
    ) -> Result<Self, Failure> {
        let skeleton = &*figure.skeleton;
        let solver_name = args.solver.solver;
        let solver = args.solver.solver(skeleton)?;
        let mut setup = Setup::new(args.free_root);
        for goal in &goals {
            setup.add(figure, goal, solver_name)?;
            check_bent_joints(skeleton, goal, solver_name, &solver)?;
        }
        let mut problem = IkProblem::new(setup.base, setup.movable(), Vec::new(), setup.reach);
        problem.stop = args.solver.stop_rule(setup.reach)?;
        problem.limits = Arc::new(limits::limits(args, figure, global)?);
        if let Some(strength) = args.pull {
            if !(0.0..=1.0).contains(&strength) {
                return Err(Failure::usage("--pull must be from 0 to 1"));
            }
            let toward = PreferredPose::Start;
            problem.rest_pull = Some(RestPull { strength, toward });
        }
        for pole in &args.pole {
            let point = pole.attach(skeleton)?;
            problem.poles.push(Pole {
                joint: point.joint,
                point_in_world: point.point_in_joint.as_dvec3(),
                weight: 1.0,
            });
        }
        if args.trace.is_some() {
            problem.trace = TraceDetail::Updates;
        }
        let frame_count = figure.motion.frame_count();
        let mut frames = match &args.frames {
            Some(selection) => {
                notes.extend(selection.past_the_end(frame_count));
                selection.frames(frame_count)?
            }
            None => (0..frame_count).collect(),
        };
        frames.sort_unstable();
        frames.dedup();
        Ok(Self {
            goals,
            solver_name,
            solver,
            problem,
            frames,
            is_cold: args.cold_start,
        })
    }

    /// Solves all frames and writes what moved into the figure's document.
    pub(super) fn run(&self, figure: &mut Figure, global: &Global) -> Result<Results, Failure> {
        let bar = Progress::frames(self.frames.len(), global.quiet);
        let skeleton = Arc::clone(&figure.skeleton);
        let mut workspace = IkWorkspace::new();
        let mut problem = self.problem.clone();
        let mut last: Option<Solved> = None;
        let mut results = Results {
            frames: Vec::with_capacity(self.frames.len()),
            largest_step_rad: None,
        };
        let mut was = LocalPose::rest(&skeleton);
        for &frame in &self.frames {
            figure.motion.pose_into(frame, &mut was);
            let global_pose = was.to_global(&skeleton);
            problem.targets = self.targets(figure, frame, &global_pose);
            if let Some(pull) = &mut problem.rest_pull {
                pull.toward = PreferredPose::Pose(Arc::new(was.clone()));
            }
            let before = last.as_ref().filter(|last| last.frame + 1 == frame);
            let mut pose = was.clone();
            if let Some(last) = before.filter(|_| !self.is_cold) {
                correct(&skeleton, &mut pose, last);
                hold_base(&skeleton, &mut pose, &global_pose, problem.base);
            }
            let report = solve(&skeleton, &mut pose, &problem, &self.solver, &mut workspace);
            let moved = all_moved(&workspace, before, &pose);
            let near_frame = before.map_or(frame, |last| last.frame);
            figure.write(frame, near_frame, &was, &moved)?;
            if let Some(last) = before {
                let step = results.largest_step_rad.get_or_insert([0.0; 2]);
                for joint in &moved {
                    let index = joint.joint.index();
                    let turn = |a: &LocalPose, b: &LocalPose| {
                        let rotation = |pose: &LocalPose| pose.rotations[index].as_dquat();
                        angle_between(rotation(a), rotation(b))
                    };
                    step[0] = step[0].max(turn(&last.pose, &pose));
                    step[1] = step[1].max(turn(&last.was, &was));
                }
            }
            results.frames.push(FrameResult {
                frame,
                targets: problem.targets.clone(),
                largest_turn: largest_turn(&was, &moved),
                report,
            });
            last = Some(Solved {
                frame,
                was: was.clone(),
                pose,
                moved: moved.iter().map(|joint| joint.joint).collect(),
            });
            bar.advance("");
        }
        Ok(results)
    }

    fn targets(&self, figure: &Figure, frame: usize, global: &GlobalPose) -> Vec<IkTarget> {
        let frame_time_secs = figure.frame_time_secs();
        let goals = self.goals.iter().map(|goal| {
            let (position, orientation) = effector(&figure.skeleton, global, goal);
            let at = goal.place.at(frame, frame_time_secs, position);
            let mut target = IkTarget::position(goal.end, at)
                .with_point(goal.point)
                .with_weight(goal.weight);
            target.orientation_in_world = match goal.orientation {
                None => None,
                Some(Orientation::Hold) => Some(orientation),
                Some(Orientation::Fixed(rotation)) => Some(rotation),
                Some(Orientation::Follow) => goal.place.orientation(frame, frame_time_secs),
            };
            target
        });
        goals.collect()
    }
}

/// Where an effector's point is and how its link is turned.
fn effector(skeleton: &Skeleton, global: &GlobalPose, goal: &Goal) -> (DVec3, DQuat) {
    let index = goal.end.index();
    let orientation = global.orientations[index].as_dquat().normalize();
    let position = global.positions[index].as_dvec3() + orientation * goal.point;
    let body = match skeleton.parent(goal.end) {
        Some(parent) if skeleton.is_end_site(goal.end) => parent,
        _ => goal.end,
    };
    (
        position,
        global.orientations[body.index()].as_dquat().normalize(),
    )
}

/// The chains of all goals put together.
struct Setup {
    base: Base,
    is_free: bool,
    joints: Vec<JointId>,
    reach: f64,
}

impl Setup {
    fn new(is_free: bool) -> Self {
        Self {
            base: if is_free { Base::Free } else { Base::Root },
            is_free,
            joints: Vec::new(),
            reach: 0.0,
        }
    }

    fn add(&mut self, figure: &Figure, goal: &Goal, solver: SolverName) -> Result<(), Failure> {
        let skeleton = &*figure.skeleton;
        let chain = chain(skeleton, goal, solver)?;
        let is_short = matches!(solver, SolverName::TwoBone | SolverName::Aim);
        let start = if is_short && goal.start.is_none() {
            StartJoint::Turns
        } else {
            StartJoint::suited_to(skeleton, &chain)
        };
        let mut target = IkTarget::position(goal.end, DVec3::ZERO).with_point(goal.point);
        if goal.orientation.is_some() {
            target = target.with_orientation(DQuat::IDENTITY);
        }
        let problem = IkProblem::for_target(skeleton, &chain, start, target);
        if let (Base::Joint(base), false) = (problem.base, self.is_free) {
            if !matches!(self.base, Base::Root) && self.base != problem.base {
                return Err(Failure::usage(
                    "two chains that climb cannot start at different joints",
                ));
            }
            self.base = Base::Joint(base);
        }
        if let Movable::Joints(joints) = problem.movable {
            self.joints.extend(joints);
        }
        // A tolerance is a share of this: where the OFFSETs are zero, the channels hold the bones.
        let length = match chain.rest_length(skeleton) {
            length if length > 0.0 => length,
            _ => chain.length_in(&figure.motion.pose(0)),
        };
        self.reach = self.reach.max(f64::from(length));
        Ok(())
    }

    fn movable(&mut self) -> Movable {
        if self.is_free {
            return Movable::Paths;
        }
        self.joints.sort_unstable();
        self.joints.dedup();
        Movable::Joints(std::mem::take(&mut self.joints))
    }
}

/// Two joints that the two-bone solver was told to turn lie on the chain, in its order.
fn check_bent_joints(
    skeleton: &Skeleton,
    goal: &Goal,
    solver_name: SolverName,
    solver: &Solver,
) -> Result<(), Failure> {
    let Solver::TwoBone(TwoBoneConfig {
        joints: Some([upper, middle]),
        ..
    }) = solver
    else {
        return Ok(());
    };
    let chain = chain(skeleton, goal, solver_name)?;
    let place = |joint: &JointId| chain.joints().iter().position(|other| other == joint);
    match (place(upper), place(middle)) {
        (Some(upper), Some(middle)) if upper < middle => Ok(()),
        _ => {
            let name = |joint: &JointId| skeleton.unique_name(*joint);
            Err(Failure::usage(format!(
                "'{}' and '{}' do not follow each other on the chain to '{}'",
                name(upper),
                name(middle),
                name(&goal.end)
            ))
            .try_next("--start says where the chain starts"))
        }
    }
}

/// The chain of a goal.
fn chain(skeleton: &Skeleton, goal: &Goal, solver: SolverName) -> Result<Chain, Failure> {
    let ancestors: Vec<JointId> = skeleton.ancestors(goal.end).collect();
    let root = ancestors.last().copied().unwrap_or(goal.end);
    let start = match (goal.start, solver) {
        (Some(start), _) => start,
        (None, SolverName::TwoBone) => ancestors.get(1).copied().unwrap_or(root),
        (None, SolverName::Aim) if goal.point == DVec3::ZERO => {
            ancestors.first().copied().unwrap_or(root)
        }
        (None, SolverName::Aim) => goal.end,
        (None, _) => root,
    };
    skeleton.chain(start, goal.end).ok_or_else(|| {
        let name = |joint| skeleton.unique_name(joint);
        Failure::usage(format!(
            "'{}' and '{}' hang from different roots",
            name(start),
            name(goal.end)
        ))
    })
}

/// The frame before: as it was and as it was left.
struct Solved {
    frame: usize,
    was: LocalPose,
    pose: LocalPose,
    moved: Vec<JointId>,
}

/// Starts a frame with the correction of the one before: each joint turned from its own pose as it was
/// turned there. What moves in the original moves on, and the solver starts near its goal.
fn correct(skeleton: &Skeleton, pose: &mut LocalPose, last: &Solved) {
    for joint in &last.moved {
        let index = joint.index();
        let was = last.was.rotations[index].as_dquat().normalize();
        let left = last.pose.rotations[index].as_dquat().normalize();
        let now = pose.rotations[index].as_dquat().normalize();
        pose.rotations[index] = (now * was.conjugate() * left).as_quat().normalize();
        if skeleton.parent(*joint).is_none() {
            let carried = last.pose.translations[index] - last.was.translations[index];
            pose.translations[index] += carried;
        }
    }
}

/// Puts the joint that is held back to where it is in the frame's own pose, with the figure.
fn hold_base(skeleton: &Skeleton, pose: &mut LocalPose, was: &GlobalPose, base: Base) {
    let Base::Joint(base) = base else {
        return;
    };
    let Some(root) = skeleton.ancestors(base).last() else {
        return;
    };
    let mut global = GlobalPose::default();
    forward_kinematics(skeleton, pose, &mut global);
    let index = base.index();
    let turn = was.orientations[index].as_dquat().normalize()
        * global.orientations[index]
            .as_dquat()
            .normalize()
            .conjugate();
    let from_base = pose.translations[root.index()].as_dvec3() - global.positions[index].as_dvec3();
    let position = was.positions[index].as_dvec3() + turn * from_base;
    pose.translations[root.index()] = position.as_vec3();
    let rotation = turn * pose.rotations[root.index()].as_dquat().normalize();
    pose.rotations[root.index()] = rotation.as_quat().normalize();
}

/// What the solver moved, and what the correction had moved and the solver left alone.
fn all_moved(
    workspace: &IkWorkspace,
    before: Option<&Solved>,
    pose: &LocalPose,
) -> Vec<MovedJoint> {
    let mut moved = workspace.moved().to_vec();
    for &joint in before.map_or(&[][..], |last| &last.moved) {
        if !moved.iter().any(|other| other.joint == joint) {
            moved.push(MovedJoint {
                joint,
                rotation: pose.rotations[joint.index()].as_dquat().normalize(),
                translation: pose.translations[joint.index()].as_dvec3(),
            });
        }
    }
    moved
}

fn largest_turn(was: &LocalPose, moved: &[MovedJoint]) -> Option<(JointId, f64)> {
    let turns = moved.iter().map(|joint| {
        let before = was.rotations[joint.joint.index()].as_dquat().normalize();
        (joint.joint, angle_between(before, joint.rotation))
    });
    turns.reduce(|most, next| if next.1 > most.1 { next } else { most })
}
