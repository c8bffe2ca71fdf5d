//! Which solver, and how it is set.

use clap::{Args, ValueEnum};
use posekit::ik::{
    CcdConfig, DampedLeastSquaresConfig, DescentDirection, FabrikConfig, JacobianTransposeConfig,
    LevenbergMarquardtConfig, SelectivelyDampedConfig, Solver, StopRule, SweepOrder, TwoBoneConfig,
};
use posekit::skeleton::{JointId, Skeleton};

use super::goals::find;
use crate::failure::Failure;

/// The options of the solver.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Solver")]
pub(super) struct SolverArgs {
    /// How the joints are found
    #[arg(long, value_name = "SOLVER", default_value = "lm")]
    pub(super) solver: SolverName,
    /// The most iterations in each frame
    #[arg(long, value_name = "N", default_value_t = 100)]
    iterations: u32,
    /// How near counts as reached [default: a ten-thousandth of the longest chain]
    #[arg(long, value_name = "LENGTH")]
    tolerance: Option<f64>,
    /// With --tolerance 0: a solver at rest farther than this from its target is stuck, and tries once more [default: a
    /// ten-thousandth of the longest chain]
    #[arg(long, value_name = "LENGTH")]
    rest_tolerance: Option<f64>,
    /// How near an orientation counts as reached, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 0.1)]
    turn_tolerance: f64,
    /// For ccd: the order in which joints turn
    #[arg(long, value_name = "ORDER", default_value = "tip")]
    order: Order,
    /// For ccd: the most that a joint turns in one step, in degrees
    #[arg(long, value_name = "DEGREES")]
    max_step: Option<f64>,
    /// For two-bone: the share of its length that a chain eases into as it stretches
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    softness: f64,
    /// For two-bone: the two joints that turn [default: the first two of the chain]
    #[arg(long, value_name = "UPPER,MIDDLE", value_delimiter = ',', num_args = 1)]
    two_bone_joints: Vec<String>,
}

/// A solver by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum SolverName {
    /// Levenberg-Marquardt: few iterations, any number of targets
    Lm,
    /// Damped least squares
    Dls,
    /// Selectively damped least squares
    Sdls,
    /// Jacobian transpose along conjugate directions
    Transpose,
    /// Jacobian transpose along the steepest descent, as published: slow in narrow valleys
    Steepest,
    /// Cyclic coordinate descent
    Ccd,
    /// Forward and backward reaching
    Fabrik,
    /// Two joints in closed form: the two before the end, unless --start says where
    TwoBone,
    /// One joint, in closed form, that looks at the target: the end's parent, unless --start says which
    Aim,
}

/// The order of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Order {
    /// From the tip to the base
    Tip,
    /// From the base to the tip
    Base,
}

impl SolverArgs {
    /// The solver.
    pub(super) fn solver(&self, skeleton: &Skeleton) -> Result<Solver, Failure> {
        let max_step_rad = match self.max_step {
            None => f64::INFINITY,
            Some(step) if step > 0.0 => step.to_radians(),
            Some(_) => {
                return Err(Failure::usage(
                    "--max-step must be an angle greater than zero",
                ));
            }
        };
        if !(0.0..=1.0).contains(&self.softness) {
            return Err(Failure::usage("--softness must be from 0 to 1"));
        }
        Ok(match self.solver {
            SolverName::Lm => Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default()),
            SolverName::Dls => Solver::DampedLeastSquares(DampedLeastSquaresConfig::default()),
            SolverName::Sdls => Solver::SelectivelyDamped(SelectivelyDampedConfig::default()),
            SolverName::Transpose => Solver::JacobianTranspose(JacobianTransposeConfig::default()),
            SolverName::Steepest => Solver::JacobianTranspose(JacobianTransposeConfig {
                direction: DescentDirection::Steepest,
                ..JacobianTransposeConfig::default()
            }),
            SolverName::Ccd => Solver::Ccd(CcdConfig {
                order: match self.order {
                    Order::Tip => SweepOrder::TipToBase,
                    Order::Base => SweepOrder::BaseToTip,
                },
                max_step_rad,
            }),
            SolverName::Fabrik => Solver::Fabrik(FabrikConfig::default()),
            SolverName::TwoBone => Solver::TwoBone(TwoBoneConfig {
                joints: self.bent_joints(skeleton)?,
                softness: self.softness,
            }),
            SolverName::Aim => Solver::Aim,
        })
    }

    /// The joints that the two-bone solver turns, if it was told.
    fn bent_joints(&self, skeleton: &Skeleton) -> Result<Option<[JointId; 2]>, Failure> {
        match self.two_bone_joints.as_slice() {
            [] => Ok(None),
            [upper, middle] => Ok(Some([find(skeleton, upper)?, find(skeleton, middle)?])),
            _ => Err(Failure::usage(
                "--two-bone-joints takes two joints separated by a comma",
            )),
        }
    }

    /// When it stops, for chains of which the longest is `reach` long.
    pub(super) fn stop_rule(&self, reach: f64) -> Result<StopRule, Failure> {
        let position_tolerance = self.tolerance.unwrap_or(1e-4 * reach);
        let rest_tolerance = self.rest_tolerance.unwrap_or(1e-4 * reach);
        if !(position_tolerance >= 0.0 && rest_tolerance >= 0.0 && self.turn_tolerance >= 0.0) {
            return Err(Failure::usage("a tolerance must be zero or more"));
        }
        Ok(StopRule {
            position_tolerance,
            rest_tolerance,
            orientation_tolerance_rad: self.turn_tolerance.to_radians(),
            max_iterations: self.iterations,
        })
    }
}
