//! Bringing limbs to targets: the effector is what is selected, its target is dragged, the body follows.

use std::sync::Arc;

use glam::{Quat, Vec3};
use posekit::ik::{IkProblem, IkWorkspace, JointLimits, solve};
use posekit::pose::{GlobalPose, LocalPose};
use posekit::skeleton::JointId;

use super::{ClipId, Handles, Session};
use crate::gizmo::{Gizmo, Placement, Tool};
use crate::state::ik::{
    Goals, IkSettings, Pin, ProblemParts, Solved, Stepper, Target, chain_joints, channel_limits,
    feet_and_hands, problem, ranges_within, solver_name,
};
use crate::state::mode::Space;

/// The part of a session that deals with limbs.
#[derive(Debug, Default)]
pub(super) struct Limbs {
    settings: IkSettings,
    workspace: IkWorkspace,
    /// The result of the last problem, with the clip and the target that it was for.
    solved: Option<(ClipId, Target, Solved)>,
    stepping: Option<Stepping>,
    /// The ranges of the joints in a clip's motion, as they were when first needed.
    ranges: Option<(ClipId, Arc<JointLimits>)>,
    /// Where the target is dragged at the moment.
    pub(super) dragged: Option<Target>,
}

/// A solver run that is shown step by step, and the joint and frame it is for.
#[derive(Debug)]
struct Stepping {
    stepper: Stepper,
    joint: JointId,
    frame: usize,
}

/// Which joints to pin or release.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// The effector.
    Effector,
    /// Both feet.
    Feet,
    /// Both hands.
    Hands,
}

impl Session {
    /// How problems are solved.
    #[must_use]
    pub fn ik(&self) -> &IkSettings {
        &self.limbs.settings
    }

    /// Changes how problems are solved.
    pub fn set_ik(&mut self, settings: IkSettings) {
        if settings != self.limbs.settings {
            if settings.within_motion != self.limbs.settings.within_motion {
                self.limbs.ranges = None;
            }
            self.limbs.settings = settings;
            self.stop_stepping();
        }
    }

    /// The result of the last problem, while its clip and target are still the ones shown; `None` once it is undone.
    #[must_use]
    pub fn solved(&self) -> Option<&Solved> {
        let (id, target, solved) = self.limbs.solved.as_ref()?;
        (self.active_id() == Some(*id) && self.target() == Some(*target)).then_some(solved)
    }

    /// The joint that IK moves to the target.
    #[must_use]
    pub fn effector(&self) -> Option<JointId> {
        let clip = self.active_clip()?;
        let joint = self.selected()?;
        (self.handles() == Handles::Targets && joint.index() < clip.skeleton().joint_count())
            .then_some(joint)
    }

    /// The joints from the chain's start to the effector; empty where the whole figure moves.
    #[must_use]
    pub fn ik_chain(&self) -> Vec<JointId> {
        match (self.effector(), self.active_clip()) {
            (Some(effector), Some(clip)) => {
                chain_joints(clip.skeleton(), effector, self.limbs.settings.start)
            }
            _ => Vec::new(),
        }
    }

    /// The target and the pins.
    #[must_use]
    pub fn goals(&self) -> Goals {
        if let Some(authored) = self.authored() {
            return authored.goals().clone();
        }
        self.edits()
            .map_or_else(Goals::default, |edits| edits.state().goals.clone())
    }

    /// Whether the target has an orientation, too.
    #[must_use]
    pub fn is_oriented(&self) -> bool {
        self.tools().ik_tool == Tool::MoveAndTurn
    }

    /// The target at the frame shown: where it is being dragged, where it was left, or else where the effector is.
    #[must_use]
    pub fn target(&self) -> Option<Target> {
        if let Some(dragged) = self.limbs.dragged {
            return Some(dragged);
        }
        let joint = self.effector()?;
        let frame = self.clip_frame();
        let asked = self.goals().target;
        asked
            .filter(|target| target.joint == joint && target.frame == frame)
            .or_else(|| {
                let clip = self.active_clip()?;
                let pose = clip.global_pose(self.transport.time_secs());
                Some(Target {
                    joint,
                    frame,
                    position: pose.positions[joint.index()],
                    orientation: pose.orientations[joint.index()],
                })
            })
    }

    /// The pins at the frame shown.
    #[must_use]
    pub fn pins(&self) -> Vec<Pin> {
        let goals = self.goals();
        if goals.pins.is_empty() {
            return Vec::new();
        }
        let pose = self.shown_global_pose();
        pose.map_or_else(Vec::new, |pose| goals.pins_at(self.clip_frame(), &pose))
    }

    /// The gizmo at the target.
    pub(super) fn target_gizmo(&self) -> Option<Gizmo> {
        let target = self.target().filter(|_| self.can_edit())?;
        if self.limbs.stepping.is_some() {
            return None;
        }
        let axes = match self.tools().ik_space {
            Space::Local => target.orientation,
            Space::Parent | Space::World => self.axes_of(target.joint, &self.shown_global_pose()?),
        };
        Some(Gizmo {
            position: target.position + self.active_place(),
            axes,
            tool: self.tools().ik_tool,
        })
    }

    /// Moves the target to a place on the stage. If the figure is to follow, returns the new pose, solved from
    /// the present one.
    pub(super) fn follow(&mut self, pose: &LocalPose, placement: Placement) -> Option<LocalPose> {
        let target = Target {
            position: placement.position - self.active_place(),
            orientation: placement.orientation,
            ..self.target()?
        };
        self.limbs.dragged = Some(target);
        if !self.limbs.settings.is_live {
            return None;
        }
        self.solve_for(pose, &target)
    }

    /// Whether joints stay within the ranges of the motion: as the user chose, or else for captured clips.
    #[must_use]
    pub fn keeps_within_motion(&self) -> bool {
        let chosen = self.limbs.settings.within_motion;
        chosen.unwrap_or_else(|| self.is_captured())
    }

    /// The joint limits: those of the channels and, if wanted, the ranges of the motion.
    fn limits(&mut self) -> Option<Arc<JointLimits>> {
        let (id, clip) = (self.active?, self.active_clip()?);
        if !self.keeps_within_motion() {
            return Some(Arc::new(channel_limits(&clip.document)));
        }
        if let Some((of, ranges)) = &self.limbs.ranges
            && *of == id
        {
            return Some(Arc::clone(ranges));
        }
        let given = channel_limits(&clip.document);
        let ranges = Arc::new(ranges_within(&clip.motion, &clip.global, &given));
        self.limbs.ranges = Some((id, Arc::clone(&ranges)));
        Some(ranges)
    }

    /// Forgets the ranges of a clip's joints; they are worked out again when needed.
    pub(super) fn forget_ranges(&mut self, id: ClipId) {
        if self.limbs.ranges.as_ref().is_some_and(|(of, _)| *of == id) {
            self.limbs.ranges = None;
        }
    }

    fn problem_of(&mut self, target: &Target) -> Option<(IkProblem, f32)> {
        let limits = self.limits()?;
        let clip = self.active_clip()?;
        let goals = self.goals();
        let pins = if goals.pins.is_empty() {
            Vec::new()
        } else {
            // Pins of other frames hold what they hold where the motion has it, not where a drag does.
            let pose = clip.global_pose(self.transport.time_secs());
            goals.pins_at(target.frame, &pose)
        };
        Some(problem(&ProblemParts {
            skeleton: clip.skeleton(),
            document: &clip.document,
            target,
            is_oriented: self.is_oriented(),
            pins: &pins,
            settings: &self.limbs.settings,
            limits: &limits,
        }))
    }

    fn solve_for(&mut self, start: &LocalPose, target: &Target) -> Option<LocalPose> {
        let (id, clip) = (self.active_id()?, Arc::clone(self.active_clip()?));
        let (problem, reach) = self.problem_of(target)?;
        let mut pose = start.clone();
        let limbs = &mut self.limbs;
        let clock = Clock::start();
        let solver = limbs.settings.solver.solver_of(&problem);
        let workspace = &mut limbs.workspace;
        let report = solve(clip.skeleton(), &mut pose, &problem, &solver, workspace);
        let secs = clock.secs();
        let solved = Solved {
            report,
            reach,
            secs,
            solver: solver_name(&solver),
        };
        limbs.solved = Some((id, *target, solved));
        Some(pose)
    }

    /// Keeps the target where it was dragged, and the pose with it.
    pub(super) fn put_target(&mut self, pose: Option<LocalPose>) {
        let (Some(target), Some(clip)) = (self.limbs.dragged.take(), self.active_clip()) else {
            return;
        };
        let name = clip.skeleton().unique_name(target.joint).to_owned();
        let goals = Goals {
            target: Some(target),
            ..self.goals()
        };
        match pose {
            Some(pose) => {
                let name = format!("Bring {name} to its target");
                self.put_pose_and_goals(&name, pose, goals);
            }
            None => {
                let name = format!("Set the target of {name}");
                self.put_goals(&name, goals);
            }
        }
    }

    /// Brings the target to a place in the clip's own space. While it is held there, as by a number that is dragged, nothing
    /// is a step yet.
    pub fn set_target_position(&mut self, position: Vec3, is_held: bool) {
        if self.limbs.dragged.is_none() {
            self.stop_editing();
            self.transport.pause();
        }
        let (Some(target), Some(start)) = (self.target(), self.shown_local_pose()) else {
            return;
        };
        if !self.can_edit() {
            return;
        }
        let target = Target { position, ..target };
        self.limbs.dragged = Some(target);
        let is_live = self.limbs.settings.is_live;
        let pose = is_live.then(|| self.solve_for(&start, &target)).flatten();
        if is_held {
            self.hold(pose.map(Arc::new));
        } else {
            self.put_target(pose);
        }
    }

    /// Solves once more, from the pose that is shown to the target as it is set.
    pub fn solve_again(&mut self) {
        self.stop_editing();
        if !self.can_edit() {
            return;
        }
        let (Some(target), Some(start)) = (self.target(), self.shown_local_pose()) else {
            return;
        };
        if let Some(pose) = self.solve_for(&start, &target) {
            self.put_pose("Solve", pose);
        }
    }

    /// Brings the target back to where the effector is.
    pub fn forget_target(&mut self) {
        self.stop_editing();
        let goals = Goals {
            target: None,
            ..self.goals()
        };
        self.limbs.solved = None;
        self.put_goals("Forget the target", goals);
    }

    /// The joints that a [`Hold`] stands for; empty if the figure has none.
    #[must_use]
    pub fn joints_to_hold(&self, what: Hold) -> Vec<JointId> {
        if what == Hold::Effector {
            return self.effector().into_iter().collect();
        }
        let ends = self.active_clip().and_then(|clip| {
            let pose = self.shown_global_pose()?;
            feet_and_hands(clip.skeleton(), &pose)
        });
        match (what, ends) {
            (Hold::Feet, Some((feet, _))) => feet.to_vec(),
            (Hold::Hands, Some((_, Some(hands)))) => hands.to_vec(),
            _ => Vec::new(),
        }
    }

    /// Pins joints where they are, or releases them if all are pinned already.
    pub fn toggle_pins(&mut self, what: Hold) {
        self.stop_editing();
        let joints = self.joints_to_hold(what);
        let Some(pose) = self.shown_global_pose().filter(|_| self.can_edit()) else {
            return;
        };
        if joints.is_empty() {
            return;
        }
        let mut goals = self.goals();
        let all_held = joints.iter().all(|&joint| goals.is_pinned(joint));
        goals.pins.retain(|pin| !joints.contains(&pin.joint));
        if !all_held {
            let frame = self.clip_frame();
            goals.pins.extend(joints.iter().map(|&joint| Pin {
                joint,
                frame,
                position: pose.positions[joint.index()],
                orientation: Some(pose.orientations[joint.index()]),
            }));
        }
        let name = if all_held { "Unpin" } else { "Pin" };
        self.put_goals(name, goals);
    }

    /// Releases one joint.
    pub fn unpin(&mut self, joint: JointId) {
        let mut goals = self.goals();
        goals.pins.retain(|pin| pin.joint != joint);
        self.put_goals("Unpin", goals);
    }

    /// Switches whether a pinned joint keeps its orientation, too.
    pub fn hold_orientation(&mut self, joint: JointId, is_held: bool) {
        let Some(pose) = self.shown_global_pose() else {
            return;
        };
        let mut goals = self.goals();
        for pin in goals.pins.iter_mut().filter(|pin| pin.joint == joint) {
            let now: Option<Quat> = pose.orientations.get(joint.index()).copied();
            pin.orientation = now.filter(|_| is_held);
        }
        self.put_goals("Change a pin", goals);
    }

    /// The solver run, while it is shown step by step.
    #[must_use]
    pub fn stepper(&self) -> Option<&Stepper> {
        self.limbs.stepping.as_ref().map(|way| &way.stepper)
    }

    /// Starts to show the solver step by step: from the pose before the edit if the figure has followed the
    /// target, otherwise from the pose shown.
    pub fn start_stepping(&mut self) {
        self.stop_editing();
        let Some(clip) = self.active_clip().filter(|_| self.can_edit()) else {
            return;
        };
        let clip = Arc::clone(clip);
        let Some(target) = self.target() else {
            return;
        };
        let frame = self.clip_frame();
        let draft = self.edits().and_then(|edits| edits.draft());
        let draft = draft.filter(|draft| draft.frame == frame && self.limbs.settings.is_live);
        let start = match draft {
            Some(draft) => LocalPose::clone(&draft.before),
            None => clip.motion.pose(frame),
        };
        let Some((problem, _)) = self.problem_of(&target) else {
            return;
        };
        let limbs = &mut self.limbs;
        let solver = limbs.settings.solver.solver_of(&problem);
        let workspace = &mut limbs.workspace;
        let stepper = Stepper::new(clip.skeleton(), start, &problem, &solver, workspace);
        limbs.stepping = Some(Stepping {
            stepper,
            joint: target.joint,
            frame,
        });
        self.show_step();
    }

    /// Moves through the steps of the solver.
    pub fn step_solver(&mut self, go: impl FnOnce(&mut Stepper)) {
        if let Some(way) = &mut self.limbs.stepping {
            go(&mut way.stepper);
            self.show_step();
        }
    }

    /// Holds the figure in the pose of the step.
    fn show_step(&mut self) {
        if let (Some(way), Some(clip)) = (&self.limbs.stepping, self.active_clip()) {
            let pose = way.stepper.pose(clip.skeleton());
            self.hold(Some(Arc::new(pose)));
        }
    }

    /// Puts the pose of the step into the clip, and ends stepping.
    pub fn keep_step(&mut self) {
        if let (Some(way), Some(clip)) = (self.limbs.stepping.take(), self.active_clip()) {
            let pose = way.stepper.pose(clip.skeleton());
            self.put_pose("Keep a step of the solver", pose);
        }
    }

    /// Ends stepping without changing anything. Returns whether there was a solver run to end.
    pub fn stop_stepping(&mut self) -> bool {
        let was_stepping = self.limbs.stepping.take().is_some();
        if was_stepping {
            self.hold(None);
        }
        was_stepping
    }

    /// Ends stepping when something else is shown; whatever depends on the time follows it.
    pub fn follow_changes(&mut self) {
        self.follow_time();
        self.follow_key_ghosts();
        let (frame, joint) = (self.clip_frame(), self.effector());
        let fits = |way: &Stepping| way.frame == frame && Some(way.joint) == joint;
        if self.limbs.stepping.as_ref().is_some_and(|way| !fits(way)) {
            self.stop_stepping();
        }
    }

    /// The pose that is shown, in the motion's space.
    pub(super) fn shown_global_pose(&self) -> Option<GlobalPose> {
        let clip = self.active_clip()?;
        Some(self.shown_local_pose()?.to_global(clip.skeleton()))
    }
}

/// How long something takes, on the desktop and on a page.
#[derive(Debug)]
struct Clock {
    #[cfg(not(target_arch = "wasm32"))]
    started: std::time::Instant,
    #[cfg(target_arch = "wasm32")]
    started: web_time::Instant,
}

impl Clock {
    fn start() -> Self {
        Self {
            #[cfg(not(target_arch = "wasm32"))]
            started: std::time::Instant::now(),
            #[cfg(target_arch = "wasm32")]
            started: web_time::Instant::now(),
        }
    }

    fn secs(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }
}
