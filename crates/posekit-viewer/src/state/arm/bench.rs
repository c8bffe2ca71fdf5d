//! The robot on the bench: where its joints stand, what its tip is asked to do, and what came of it.
//!
//! Joints are set one by one (forward kinematics), or the tip is dragged and the joints follow
//! (Levenberg-Marquardt from where they stand, so that a tip that moves steadily moves the joints
//! steadily). Values are always within their ranges.

mod ways;

use std::sync::Arc;

use egui::Pos2;
use glam::{DQuat, DVec3};
use posekit::ik::IkTarget;
use posekit::ik::robot::{
    RobotConfig, RobotReport, RobotWorkspace, Ways, range_margins, solve_robot,
};
use posekit::mechanism::Frame;
use posekit::skeleton::JointId;

use super::mobility::{Mobility, mobility};
use super::planar::PlanarArm;
use super::robot::Robot;
use super::two_link::{TwoLinkReadout, two_link};
use crate::gizmo::{Drag, Gizmo, Handle, Placement, Snap, Tool, Viewport};
use crate::state::mode::{Space, TURN_STEP_DEG, move_step};

/// A target counts as reached within this share of the robot's reach, and within this angle.
const REACHED_SHARE: f64 = 1e-6;
const REACHED_RAD: f64 = 1e-6;

/// While the tip is dragged, one attempt of so many iterations: far more than it needs, and still under a
/// tenth of a millisecond.
const DRAG_ITERATIONS: u32 = 120;

/// The joints stand as a way has it while no value differs by more than this, radians or metres.
const SAME: f64 = 1e-6;

/// A value nearer than this to an end of its range is at it, radians or metres.
pub const AT_END: f64 = 1e-9;

/// So many steps can be taken back.
const MOST_STEPS: usize = 1000;

/// What the tip is asked to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Where it should be, world space.
    pub position: DVec3,
    /// How it should be turned, if that is asked for.
    pub orientation: Option<DQuat>,
}

/// How far the tip is from its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// Metres.
    pub distance: f64,
    /// Radians; 0 where no orientation is asked for.
    pub angle_rad: f64,
}

/// A handle that is held with the pointer.
#[derive(Clone, Debug)]
struct Held {
    drag: Drag,
    values: Vec<f64>,
    target: Option<Target>,
}

/// A robot and where its joints stand.
#[derive(Debug)]
pub struct Bench {
    robot: Arc<Robot>,
    values: Vec<f64>,
    frames: Vec<Frame>,
    tip: JointId,
    tool: Tool,
    space: Space,
    target: Option<Target>,
    report: Option<RobotReport>,
    /// The ways to the target, once they were looked for.
    ways: Option<Ways>,
    held: Option<Held>,
    undo: Vec<Vec<f64>>,
    redo: Vec<Vec<f64>>,
    workspace: RobotWorkspace,
    random: u64,
}

impl Bench {
    /// Puts a robot on the bench.
    #[must_use]
    pub fn new(robot: Arc<Robot>) -> Self {
        let values = robot.start.clone();
        let frames = robot.mechanism.global_frames(&values);
        let tip = robot.tips.first().copied().unwrap_or(JointId::new(0));
        // Six values can bring the tip anywhere and turn it any way; fewer cannot do both.
        let tool = if robot.values_moving(tip).len() >= 6 {
            Tool::MoveAndTurn
        } else {
            Tool::Move
        };
        Self {
            values,
            frames,
            tip,
            tool,
            space: Space::World,
            target: None,
            report: None,
            ways: None,
            held: None,
            undo: Vec::new(),
            redo: Vec::new(),
            workspace: RobotWorkspace::new(),
            random: 0x9E37_79B9_7F4A_7C15,
            robot,
        }
    }

    /// The robot.
    #[must_use]
    pub fn robot(&self) -> &Arc<Robot> {
        &self.robot
    }

    /// Where its joints stand: radians and metres.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Where its joints are in the world.
    #[must_use]
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The joint whose frame is the tip.
    #[must_use]
    pub fn tip(&self) -> JointId {
        self.tip
    }

    /// Where the tip is.
    #[must_use]
    pub fn tip_frame(&self) -> Frame {
        self.frames[self.tip.index()]
    }

    /// What is asked of the tip, if it was dragged somewhere.
    #[must_use]
    pub fn target(&self) -> Option<Target> {
        self.target
    }

    /// What the solver said last, while there is a target.
    #[must_use]
    pub fn report(&self) -> Option<&RobotReport> {
        self.report.as_ref()
    }

    /// How far the tip is from its target, by forward kinematics.
    #[must_use]
    pub fn miss(&self) -> Option<Miss> {
        let target = self.target?;
        let frame = self.tip_frame();
        Some(Miss {
            distance: frame.position.distance(target.position),
            angle_rad: target
                .orientation
                .map_or(0.0, |wanted| frame.orientation.angle_between(wanted)),
        })
    }

    /// Whether a miss is none.
    #[must_use]
    pub fn is_reached(&self, miss: Miss) -> bool {
        // The angle between two quaternions is blind under a few hundred-millionths.
        miss.distance <= 2.0 * REACHED_SHARE * self.robot.reach && miss.angle_rad <= 1e-5
    }

    /// Which handles the tip's gizmo has; rings ask for an orientation, too.
    #[must_use]
    pub fn tool(&self) -> Tool {
        self.tool
    }

    /// Chooses the handles.
    pub fn set_tool(&mut self, tool: Tool) {
        self.cancel_drag();
        self.tool = tool;
        self.forget_target();
    }

    /// How the gizmo's axes lie: as the world's, or as the tip's.
    #[must_use]
    pub fn space(&self) -> Space {
        self.space
    }

    /// Chooses how the gizmo's axes lie.
    pub fn set_space(&mut self, space: Space) {
        self.space = space;
    }

    /// Chooses the joint whose frame is the tip.
    pub fn set_tip(&mut self, tip: JointId) {
        if tip.index() < self.frames.len() {
            self.cancel_drag();
            self.tip = tip;
            self.forget_target();
        }
    }

    /// The planar arm that it is, while its own tip is looked at.
    #[must_use]
    pub fn planar(&self) -> Option<&PlanarArm> {
        self.robot.planar.as_ref().filter(|arm| arm.tip == self.tip)
    }

    /// The planar arm's formula with numbers.
    #[must_use]
    pub fn two_link(&self) -> Option<TwoLinkReadout> {
        let arm = self.planar()?;
        let asked = self
            .target
            .map_or(self.tip_frame().position, |target| target.position);
        let target = arm.in_plane(asked);
        Some(two_link(&self.robot, arm, &self.values, target))
    }

    /// How well the tip can move.
    #[must_use]
    pub fn mobility(&self) -> Mobility {
        mobility(&self.robot, &self.values, &self.frames, self.tip)
    }

    /// The joints that stand at an end of their ranges.
    #[must_use]
    pub fn joints_at_end(&self) -> Vec<JointId> {
        range_margins(&self.robot.mechanism, &self.values)
            .into_iter()
            .filter(|margin| margin.to_lower.min(margin.to_upper) <= AT_END)
            .map(|margin| margin.joint)
            .collect()
    }

    /// Remembers where the joints stand, as a step that can be taken back.
    pub fn begin_step(&mut self) {
        if self.undo.last() == Some(&self.values) {
            return;
        }
        self.undo.push(self.values.clone());
        if self.undo.len() > MOST_STEPS {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Whether there is a step to take back, and one to take again.
    #[must_use]
    pub fn can_undo_redo(&self) -> (bool, bool) {
        (!self.undo.is_empty(), !self.redo.is_empty())
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        self.cancel_drag();
        if let Some(values) = self.undo.pop() {
            let now = std::mem::replace(&mut self.values, values);
            self.redo.push(now);
            self.moved_by_hand();
        }
    }

    /// Takes a step again that was taken back.
    pub fn redo(&mut self) {
        self.cancel_drag();
        if let Some(values) = self.redo.pop() {
            let now = std::mem::replace(&mut self.values, values);
            self.undo.push(now);
            self.moved_by_hand();
        }
    }

    /// Sets one value, held to its range; what is not a number is not taken.
    pub fn set_value(&mut self, index: usize, value: f64) {
        if index < self.values.len() && value.is_finite() {
            self.cancel_drag();
            self.values[index] = self.robot.ranges[index].clamp(value);
            self.moved_by_hand();
        }
    }

    /// Sets all values, each held to its range, as one step.
    pub fn set_values(&mut self, values: &[f64]) {
        self.cancel_drag();
        self.begin_step();
        for (index, &value) in values.iter().enumerate().take(self.values.len()) {
            self.values[index] = self.robot.ranges[index].clamp(value);
        }
        self.moved_by_hand();
    }

    /// Brings the joints to where they stood first.
    pub fn go_home(&mut self) {
        let start = self.robot.start.clone();
        self.set_values(&start);
    }

    /// Brings all values to zero, or as near as their ranges let them.
    pub fn go_to_zero(&mut self) {
        let zeros = vec![0.0; self.values.len()];
        self.set_values(&zeros);
    }

    /// Brings the joints to random places in their ranges. The same number of times from the start, the
    /// same places.
    pub fn randomize(&mut self) {
        let values = self.random_values();
        self.set_values(&values);
    }

    /// There is nothing to reach any more: the gizmo goes back to the tip.
    pub fn forget_target(&mut self) {
        self.target = None;
        self.report = None;
        self.ways = None;
    }

    fn moved_by_hand(&mut self) {
        self.forget_target();
        self.find_frames();
    }

    fn find_frames(&mut self) {
        self.robot
            .mechanism
            .set_global_frames(&self.values, &mut self.frames);
    }

    /// The tip's gizmo: at the target, or where the tip is.
    #[must_use]
    pub fn gizmo(&self) -> Gizmo {
        if let Some(held) = &self.held {
            return Gizmo {
                position: held.drag.placement().position,
                ..*held.drag.gizmo()
            };
        }
        let frame = self.tip_frame();
        let target = self.target.unwrap_or(Target {
            position: frame.position,
            orientation: None,
        });
        let orientation = target.orientation.unwrap_or(frame.orientation);
        let axes = match (self.space, self.planar()) {
            (Space::Local, _) => orientation,
            // A planar arm's world is its plane.
            (_, Some(arm)) => arm.axes,
            _ => DQuat::IDENTITY,
        };
        Gizmo {
            position: target.position.as_vec3(),
            axes: axes.as_quat(),
            tool: self.tool,
        }
    }

    /// Whether a handle is held.
    #[must_use]
    pub fn is_dragging(&self) -> bool {
        self.held.is_some()
    }

    /// The drag of the handle that is held.
    #[must_use]
    pub fn drag(&self) -> Option<&Drag> {
        self.held.as_ref().map(|held| &held.drag)
    }

    /// The steps that the gizmo goes in.
    #[must_use]
    pub fn snap(&self) -> Snap {
        Snap {
            length: move_step(super::single(self.robot.reach)),
            angle_rad: TURN_STEP_DEG.to_radians(),
        }
    }

    /// Takes a handle of the gizmo. False when it cannot be taken in this view.
    pub fn grab(&mut self, handle: Handle, pointer: Pos2, viewport: &Viewport) -> bool {
        let gizmo = self.gizmo();
        let frame = self.tip_frame();
        let turned = self.target.and_then(|target| target.orientation);
        let start = Placement {
            position: gizmo.position,
            orientation: turned.unwrap_or(frame.orientation).as_quat(),
        };
        let Some(drag) = Drag::begin(gizmo, handle, start, pointer, viewport) else {
            return false;
        };
        self.held = Some(Held {
            drag,
            values: self.values.clone(),
            target: self.target,
        });
        true
    }

    /// Follows the pointer with the handle that is held. True when that moved something.
    pub fn drag_to(&mut self, pointer: Pos2, viewport: &Viewport, snap: Option<Snap>) -> bool {
        let Some(mut held) = self.held.take() else {
            return false;
        };
        let before = held.drag.placement();
        let placement = held.drag.update(pointer, viewport, snap);
        let has_moved = placement != before;
        if has_moved {
            let turns = self.tool.turns();
            self.aim(Target {
                position: placement.position.as_dvec3(),
                orientation: turns.then(|| placement.orientation.as_dquat().normalize()),
            });
        }
        self.held = Some(held);
        has_moved
    }

    /// Lets the handle go: what it did is a step.
    pub fn drop_handle(&mut self) {
        if let Some(held) = self.held.take()
            && held.values != self.values
        {
            let now = std::mem::replace(&mut self.values, held.values);
            self.begin_step();
            self.values = now;
        }
    }

    /// Lets the handle go without effect. True when one was held.
    pub fn cancel_drag(&mut self) -> bool {
        let Some(held) = self.held.take() else {
            return false;
        };
        self.values = held.values;
        self.target = held.target;
        self.report = None;
        self.ways = None;
        self.find_frames();
        true
    }

    /// Brings the tip to a target, as near as it gets from where the joints stand. A planar arm's target
    /// is brought into its plane first.
    pub fn aim(&mut self, target: Target) {
        let target = match self.planar() {
            Some(arm) => Target {
                position: arm.in_world(arm.in_plane(target.position)),
                ..target
            },
            None => target,
        };
        self.target = Some(target);
        self.ways = None;
        let config = self.config(1);
        let mut values = std::mem::take(&mut self.values);
        let report = self.solve(&mut values, target, &config);
        self.values = values;
        self.report = Some(report);
        self.find_frames();
    }

    fn config(&self, max_attempts: u32) -> RobotConfig {
        let mut config = RobotConfig {
            max_attempts,
            ..RobotConfig::default()
        };
        config.stop.position_tolerance = REACHED_SHARE * self.robot.reach;
        config.stop.orientation_tolerance_rad = REACHED_RAD;
        config.stop.max_iterations = DRAG_ITERATIONS;
        config
    }

    fn wanted(&self, target: Target) -> IkTarget {
        let wanted = IkTarget::position(self.tip, target.position);
        match target.orientation {
            Some(orientation) => wanted.with_orientation(orientation),
            None => wanted,
        }
    }

    fn solve(&mut self, values: &mut [f64], target: Target, config: &RobotConfig) -> RobotReport {
        let wanted = self.wanted(target);
        let mechanism = &self.robot.mechanism;
        solve_robot(mechanism, values, &[wanted], config, &mut self.workspace)
    }

    fn random_values(&mut self) -> Vec<f64> {
        let offered: Vec<_> = self.robot.values.iter().map(|kind| kind.offered).collect();
        offered
            .into_iter()
            .map(|range| range.lower + (range.upper - range.lower) * self.random_share())
            .collect()
    }

    /// From 0 to 1: splitmix64 (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number
    /// Generators").
    fn random_share(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.random;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
        let share = (z >> 11) as f64 / (1u64 << 53) as f64;
        share
    }
}
