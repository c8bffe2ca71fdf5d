//! Inverse kinematics as the window has it: what is asked of limbs, how it is solved, and the solver's
//! way step by step. The solvers themselves are the library's.

mod problem;
mod ranges;
mod solvers;
mod step;

use glam::{Quat, Vec3};
use posekit::ik::{IkOutcome, IkReport};
use posekit::skeleton::JointId;

pub use problem::{
    ProblemParts, auto_start, chain_joints, channel_limits, feet_and_hands, problem,
};
pub use ranges::ranges_within;
pub use solvers::{SolverChoice, choices, solver_name};
pub use step::Stepper;

/// Where an effector should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The joint that should be there.
    pub joint: JointId,
    /// The frame for which that holds.
    pub frame: usize,
    /// Where, in the motion's space.
    pub position: Vec3,
    /// How it should be turned, if that is asked for, in the motion's space.
    pub orientation: Quat,
}

/// A joint that is held where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// The joint.
    pub joint: JointId,
    /// The frame at which its place was taken; at another frame it is held where it is there.
    pub frame: usize,
    /// Where it is held, in the motion's space.
    pub position: Vec3,
    /// How it is turned while it is held, in the motion's space; `None` leaves that open.
    pub orientation: Option<Quat>,
}

/// The target and the pins: undone and redone with the poses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Goals {
    /// Where the effector should be; `None` while it is where it is.
    pub target: Option<Target>,
    /// What is held.
    pub pins: Vec<Pin>,
}

impl Goals {
    /// Whether a joint is held.
    #[must_use]
    pub fn is_pinned(&self, joint: JointId) -> bool {
        self.pins.iter().any(|pin| pin.joint == joint)
    }
}

/// Where the chain to the effector starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Where the limb does: at the first joint below a fork.
    #[default]
    Limb,
    /// At this joint, which keeps its place.
    Joint(JointId),
    /// Nowhere: the whole figure moves, its root too.
    Body,
}

/// How problems are solved.
#[derive(Clone, Debug, PartialEq)]
pub struct IkSettings {
    /// Where the chain starts.
    pub start: Start,
    /// The solver.
    pub solver: SolverChoice,
    /// The most iterations.
    pub iterations: u32,
    /// When a target counts as reached, as a share of the chain's length.
    pub tolerance: f64,
    /// Whether the figure follows while the target is dragged.
    pub is_live: bool,
    /// Whether joints keep within what they do in the clip's motion; `None` for captured clips only.
    pub within_motion: Option<bool>,
}

/// The iterations that can be chosen.
pub const ITERATIONS: std::ops::RangeInclusive<u32> = 1..=200;

/// The tolerances that can be chosen, shares of the chain's length.
pub const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-6..=1e-1;

impl Default for IkSettings {
    fn default() -> Self {
        Self {
            start: Start::Limb,
            solver: SolverChoice::Automatic,
            iterations: 20,
            tolerance: 1e-4,
            is_live: true,
            within_motion: None,
        }
    }
}

/// The result of the last problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// Its report.
    pub report: IkReport,
    /// The length of the chain, in the file's unit, that residuals are shares of.
    pub reach: f32,
    /// How long solving took.
    pub secs: f64,
    /// The name of what solved it.
    pub solver: String,
}

/// An outcome in words.
#[must_use]
pub fn outcome_text(outcome: IkOutcome, length: impl Fn(f64) -> String) -> String {
    match outcome {
        IkOutcome::Reached => "Reached".to_owned(),
        IkOutcome::OutOfReach { by } => format!("Out of reach by {}", length(by)),
        IkOutcome::IterationLimit => "Not there yet: more iterations may help".to_owned(),
        IkOutcome::LimitsInTheWay => "Limits of joints are in the way: see Limits above".to_owned(),
        IkOutcome::Stalled => "At rest short of the target".to_owned(),
        IkOutcome::InvalidTarget { .. } => "The target is no place".to_owned(),
        _ => "Not reached".to_owned(),
    }
}
