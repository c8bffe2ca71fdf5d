//! Solvers that linearise: the Jacobian transpose, damped least squares, selectively damped least squares
//! and Levenberg-Marquardt.
//!
//! All of them make the residual `e` (targets less effectors, of all targets at once) less by steps of all
//! joints together, from `e(step) = e - J step` with the Jacobian `J`. They differ in how they take `J`
//! back:
//!
//! - [`JacobianTransposeConfig`]: `a J^T e`, or directions conjugate to each other, with the length `a` that is best along it (Wolovich and
//!   Elliott 1984, "A Computational Technique for Inverse Kinematics"; Buss 2004, "Introduction to Inverse
//!   Kinematics with Jacobian Transpose, Pseudoinverse and Damped Least Squares methods").
//! - [`DampedLeastSquaresConfig`]: `J^T (J J^T + d^2 I)^-1 e` (Wampler 1986; Nakamura and Hanafusa 1986),
//!   with the clamped residuals of Buss (2004) and a damping that grows with the residual (Chan and
//!   Lawrence 1988, "General Inverse Kinematics with the Error Damped Pseudoinverse").
//! - [`SelectivelyDampedConfig`]: each singular direction is damped by itself, by how far it would carry
//!   the effectors (Buss and Kim 2005, "Selectively Damped Least Squares for Inverse Kinematics", J.
//!   Graphics Tools 10(3), doi:10.1080/2151237X.2005.10129202).
//! - [`LevenbergMarquardtConfig`]: minimises `1/2 |f(x) - x'|^2` over all joints with a damping that follows
//!   the residual (Sugihara 2011, "Solvability-Unconcerned Inverse Kinematics by the Levenberg-Marquardt
//!   Method", IEEE Trans. Robotics 27(5), doi:10.1109/TRO.2011.2148230) and how well the linearisation
//!   foretold it (Nielsen 1999); a step that makes the residual grow is taken back. As the residual vanishes
//!   it becomes Gauss-Newton and converges quadratically. The one for several targets; and the one that starts
//!   again from other poses where it comes to rest short of them.
//!
//! **More iterations** never leave more: the best pose on the way is kept.
//!
//! **Units.** Residuals in position are told in lengths of the longest chain, so that dampings mean the same
//! for every figure; a radian counts as much as the configuration says. Weights of targets multiply squares.
//!
//! **Limits.** Hinges and slides are bounded by an active set: a step that would leave a range ends at it,
//! and what it cannot do is asked of the others in the same solve. Ball joints are brought back into cones
//! and Euler ranges after a step, and the direction that was refused is bounded in the steps that follow.
//! **Stiffness** weighs steps (`P` in [`system`]). **Preferred poses and poles** are wishes: steps that are
//! taken as far as no target minds (Liegeois 1977), which for a pull fade from iteration to iteration.
//!
//! **Cost.** A linearisation goes through the tree once and holds entries only for joints and effectors of
//! one path; systems are solved in the space of rows (three or six a target) by Cholesky. No allocation
//! once the workspace has grown.

mod cholesky;
mod descend;
mod elsewhere;
mod figure;
mod levenberg;
mod model;
mod svd;
mod system;

pub use descend::{
    DampedLeastSquaresConfig, DescentDirection, JacobianTransposeConfig, SelectivelyDampedConfig,
};
pub use levenberg::LevenbergMarquardtConfig;

use descend::Way;
pub(crate) use elsewhere::are_limits_in_the_way;
pub(crate) use figure::{Figure, FigureMemory, FigureParts};
pub(crate) use levenberg::{Patience, minimize};
pub(crate) use model::{Model, Taken};
pub(crate) use svd::Svd;
pub(crate) use system::{Degree, System};

use super::problem::IkProblem;
use super::solve::{Progress, Solver};
use super::workspace::IkWorkspace;
use crate::pose::LocalPose;
use crate::skeleton::Skeleton;

/// Memory of these solvers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    system: System,
    svd: Svd,
    way: Way,
    figure: FigureMemory,
}

/// How far iterations went.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Iterations {
    pub(crate) count: u32,
    /// Whether more would change nothing.
    pub(crate) is_settled: bool,
    /// Whether other starts were tried, none of which reached the targets if this one does not.
    pub(crate) has_searched: bool,
}

/// Runs one of these solvers on the linkage of the workspace.
pub(crate) fn run(
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
    solver: &Solver,
    workspace: &mut IkWorkspace,
) -> Progress {
    let Memory {
        system,
        svd,
        way,
        figure,
    } = &mut workspace.least_squares;
    let radian_share = match solver {
        Solver::JacobianTranspose(config) => config.radian_share,
        Solver::DampedLeastSquares(config) => config.radian_share,
        Solver::SelectivelyDamped(config) => config.radian_share,
        Solver::LevenbergMarquardt(config) => config.radian_share,
        _ => return Progress::default(),
    };
    let parts = FigureParts {
        skeleton,
        start: pose,
        problem,
        linkage: &mut workspace.linkage,
        memory: figure,
    };
    let mut model = Figure::new(parts, radian_share);
    let most = problem.stop.max_iterations;
    let made = match solver {
        Solver::JacobianTranspose(config) => {
            descend::transpose(&mut model, system, way, config, most)
        }
        Solver::DampedLeastSquares(config) => descend::damped(&mut model, system, config, most),
        Solver::SelectivelyDamped(config) => {
            descend::selectively_damped(&mut model, system, svd, config, most)
        }
        Solver::LevenbergMarquardt(config) => {
            elsewhere::minimize_anywhere(&mut model, system, config, most)
        }
        _ => Iterations::default(),
    };
    Progress {
        iterations: made.count,
        is_settled: made.is_settled,
        has_searched: made.has_searched,
        trace: model.into_trace(),
    }
}
