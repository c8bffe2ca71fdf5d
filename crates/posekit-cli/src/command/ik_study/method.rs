//! The solvers that are compared: what they are called, what they do, and who published them.

use clap::ValueEnum;
use posekit::ik::{
    CcdConfig, DampedLeastSquaresConfig, FabrikConfig, JacobianTransposeConfig,
    LevenbergMarquardtConfig, SelectivelyDampedConfig, Solver, TwoBoneConfig,
};

use super::linkage::StudiedChain;

/// A solver by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    /// Cyclic coordinate descent
    Ccd,
    /// Forward and backward reaching
    Fabrik,
    /// Jacobian transpose
    Transpose,
    /// Damped least squares
    Dls,
    /// Selectively damped least squares
    Sdls,
    /// Levenberg-Marquardt
    Lm,
    /// Two joints in closed form
    TwoBone,
}

/// What a report says about a solver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facts {
    /// Its short name, as in tables.
    pub(super) name: &'static str,
    /// Its full name.
    pub(super) full_name: &'static str,
    /// What it does in one iteration.
    pub(super) step: &'static str,
    /// Who published it.
    pub(super) source: &'static str,
}

impl Method {
    /// All of them, in the order of the report.
    pub(super) const ALL: [Self; 7] = [
        Self::Ccd,
        Self::Fabrik,
        Self::Transpose,
        Self::Dls,
        Self::Sdls,
        Self::Lm,
        Self::TwoBone,
    ];

    /// The solver for a chain, set as it is by default.
    pub(super) fn solver(self, chain: &StudiedChain) -> Solver {
        match self {
            Self::Ccd => Solver::Ccd(CcdConfig::default()),
            Self::Fabrik => Solver::Fabrik(FabrikConfig::default()),
            Self::Transpose => Solver::JacobianTranspose(JacobianTransposeConfig::default()),
            Self::Dls => Solver::DampedLeastSquares(DampedLeastSquaresConfig::default()),
            Self::Sdls => Solver::SelectivelyDamped(SelectivelyDampedConfig::default()),
            Self::Lm => Solver::LevenbergMarquardt(LevenbergMarquardtConfig::default()),
            Self::TwoBone => Solver::TwoBone(TwoBoneConfig {
                joints: chain.two_bones(),
                softness: 0.0,
            }),
        }
    }

    /// Its place in [`ALL`](Self::ALL), which its colour and mark in curves follow.
    pub(super) fn index(self) -> usize {
        Self::ALL
            .iter()
            .position(|&method| method == self)
            .unwrap_or(0)
    }

    /// What the report says about it.
    pub(super) fn facts(self) -> Facts {
        match self {
            Self::Ccd => Facts {
                name: "CCD",
                full_name: "cyclic coordinate descent",
                step: "From the last joint to the first, each turns by the angle between $a$ (joint to effector) \
                       and $b$ (joint to target) about $a × b$, and carries all beyond it along.",
                source: "Wang and Chen 1991, doi:10.1109/70.86079",
            },
            Self::Fabrik => Facts {
                name: "FABRIK",
                full_name: "forward and backward reaching",
                step: "Points are moved, not angles: $pᵢ ← pᵢ₊₁ + dᵢ (pᵢ − pᵢ₊₁) / |pᵢ − pᵢ₊₁|$ from the target \
                       inward, then the like from the base outward; rotations are recovered from the points.",
                source: "Aristidou and Lasenby 2011, doi:10.1016/j.gmod.2011.05.003",
            },
            Self::Transpose => Facts {
                name: "Transpose",
                full_name: "Jacobian transpose",
                step: "All joints at once: $Δθ = α Jᵀe$ with $α = (e · JJᵀe) / |JJᵀe|²$.",
                source: "Wolovich and Elliott 1984; Buss 2004",
            },
            Self::Dls => Facts {
                name: "DLS",
                full_name: "damped least squares",
                step: "$Δθ = Jᵀ (JJᵀ + λ²I)⁻¹ e$ with a constant damping $λ$ and a clamped error $e$.",
                source: "Wampler 1986; Nakamura and Hanafusa 1986; Buss 2004",
            },
            Self::Sdls => Facts {
                name: "SDLS",
                full_name: "selectively damped least squares",
                step: "As the pseudoinverse, $Δθ = Σ vᵢ (uᵢ · e) / σᵢ$, each singular direction damped by how far it \
                       would carry the effector.",
                source: "Buss and Kim 2005, doi:10.1080/2151237X.2005.10129202",
            },
            Self::Lm => Facts {
                name: "LM",
                full_name: "Levenberg-Marquardt",
                step: "Minimises $½ |f(θ) − x′|²$: $Δθ = (JᵀJ + μI)⁻¹ Jᵀe$, with a $μ$ that falls as the error does \
                       and rises when a step makes it worse.",
                source: "Sugihara 2011, doi:10.1109/TRO.2011.2148230; Nielsen 1999",
            },
            Self::TwoBone => Facts {
                name: "Two-bone",
                full_name: "two joints in closed form",
                step: "The two joints only between which the bones are longest (shoulder and elbow), by the law of \
                       cosines, in one step: $cos γ = (l₁² + l₂² − d²) / (2 l₁l₂)$. All others keep their angles.",
                source: "Tolani, Goswami and Badler 2000, doi:10.1006/gmod.2000.0528",
            },
        }
    }

    /// Its short name.
    pub(super) fn name(self) -> &'static str {
        self.facts().name
    }

    /// Its name on the command line.
    pub(super) fn option(self) -> &'static str {
        match self {
            Self::Ccd => "ccd",
            Self::Fabrik => "fabrik",
            Self::Transpose => "transpose",
            Self::Dls => "dls",
            Self::Sdls => "sdls",
            Self::Lm => "lm",
            Self::TwoBone => "two-bone",
        }
    }
}
