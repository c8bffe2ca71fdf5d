//! The solvers that can be chosen.

use posekit::ik::{
    CcdConfig, DampedLeastSquaresConfig, FabrikConfig, IkProblem, JacobianTransposeConfig,
    LevenbergMarquardtConfig, SelectivelyDampedConfig, Solver, SweepOrder, TwoBoneConfig,
};

/// Which solver solves problems.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SolverChoice {
    /// CCD for one target, Levenberg-Marquardt for several.
    #[default]
    Automatic,
    /// This one.
    One(Solver),
}

impl SolverChoice {
    /// The solver of a problem.
    #[must_use]
    pub fn solver_of(&self, problem: &IkProblem) -> Solver {
        match self {
            Self::One(solver) => solver.clone(),
            Self::Automatic if problem.targets.len() > 1 => {
                Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default())
            }
            Self::Automatic => Solver::Ccd(CcdConfig::default()),
        }
    }

    /// The name shown.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Automatic => "Automatic".to_owned(),
            Self::One(solver) => solver_name(solver),
        }
    }
}

/// All that can be chosen, solvers as they are set at first.
#[must_use]
pub fn choices() -> Vec<SolverChoice> {
    let from_base = CcdConfig {
        order: SweepOrder::BaseToTip,
        ..CcdConfig::default()
    };
    let solvers = [
        Solver::Ccd(CcdConfig::default()),
        Solver::Ccd(from_base),
        Solver::Fabrik(FabrikConfig::default()),
        Solver::JacobianTranspose(JacobianTransposeConfig::default()),
        Solver::DampedLeastSquares(DampedLeastSquaresConfig::default()),
        Solver::SelectivelyDamped(SelectivelyDampedConfig::default()),
        Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default()),
        Solver::TwoBone(TwoBoneConfig::default()),
        Solver::Aim,
    ];
    let one = solvers.into_iter().map(SolverChoice::One);
    std::iter::once(SolverChoice::Automatic)
        .chain(one)
        .collect()
}

/// A solver's name.
#[must_use]
pub fn solver_name(solver: &Solver) -> String {
    match solver {
        Solver::Ccd(config) if config.order == SweepOrder::BaseToTip => "CCD, from the base",
        Solver::Ccd(_) => "CCD",
        Solver::Fabrik(_) => "FABRIK",
        Solver::TwoBone(_) => "Two bones",
        Solver::Aim => "Aim",
        Solver::JacobianTranspose(_) => "Jacobian transpose",
        Solver::DampedLeastSquares(_) => "Damped least squares",
        Solver::SelectivelyDamped(_) => "Selectively damped",
        Solver::LevenbergMarquardt(_) => "Levenberg\u{2013}Marquardt",
        _ => "Another solver",
    }
    .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_choices_apart() {
        let names: std::collections::BTreeSet<_> =
            choices().iter().map(SolverChoice::name).collect();
        assert_eq!(names.len(), choices().len());
        assert!(!names.contains("Another solver"));
    }
}
