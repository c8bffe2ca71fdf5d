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
    /// Jacobian transpose, conjugate directions
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
                step: "From the last joint to the first: each joint turns by the angle between $a$ (joint to end) and $b$ \
                       (joint to target) about $a × b$, and carries everything beyond it along as one rigid piece.",
                source: "Wang and Chen 1991, doi:10.1109/70.86079",
            },
            Self::Fabrik => Facts {
                name: "FABRIK",
                full_name: "forward and backward reaching",
                step: "Points move, not angles: $pᵢ ← pᵢ₊₁ + dᵢ (pᵢ − pᵢ₊₁) / |pᵢ − pᵢ₊₁|$ from the target inward, then \
                       the same from the base outward. Rotations are recovered from the points.",
                source: "Aristidou and Lasenby 2011, doi:10.1016/j.gmod.2011.05.003",
            },
            Self::Transpose => Facts {
                name: "Transpose",
                full_name: "Jacobian transpose, conjugate directions",
                step: "All joints at once along $s$: $Δθ = αs$ with $α = (e · Js) / |Js|²$, the best length. The published \
                       method is steepest descent, $s = g = Jᵀe$. What runs here makes each direction conjugate to the \
                       one before: $s = g + βs′$ with $β = max(0, g · (g − g′) / |g′|²)$ (primes: the iteration \
                       before). It costs the same and needs far fewer iterations.",
                source: "Wolovich and Elliott 1984; Buss 2004; conjugate directions: Polak and Ribière 1969",
            },
            Self::Dls => Facts {
                name: "DLS",
                full_name: "damped least squares",
                step: "$Δθ = Jᵀ (JJᵀ + λ²I)⁻¹ e$ with $e$ clamped to half the length of the chain $L$, and a damping that \
                       grows with it: $λ² = L² (0.01 + |e| / L)$.",
                source: "Wampler 1986; Nakamura and Hanafusa 1986; clamped error: Buss 2004; damping by the error: Chan \
                         and Lawrence 1988",
            },
            Self::Sdls => Facts {
                name: "SDLS",
                full_name: "selectively damped least squares",
                step: "The pseudoinverse $Δθ = Σ vᵢ (uᵢ · e) / σᵢ$, with each singular direction damped on its own, by how \
                       far the joints would turn compared with how far the end would go; $e$ is clamped as in DLS.",
                source: "Buss and Kim 2005, doi:10.1080/2151237X.2005.10129202",
            },
            Self::Lm => Facts {
                name: "LM",
                full_name: "Levenberg-Marquardt",
                step: "Minimises $½ |f(θ) − x′|²$: $Δθ = (JᵀJ + μI)⁻¹ Jᵀe$ with $μ = m|e|²$, lengths in those of the chain. The factor $m$ falls after a step as good as predicted and rises after one that makes the error grow, which is taken back.",
                source: "Sugihara 2011, doi:10.1109/TRO.2011.2148230; Nielsen 1999",
            },
            Self::TwoBone => Facts {
                name: "Two-bone",
                full_name: "two joints in closed form",
                step: "Only the two neighbouring joints with the longest bones turn (shoulder and elbow), by the law of \
                       cosines in one step: $cos γ = (l₁² + l₂² − d²) / (2 l₁l₂)$. All other joints keep their angles, so \
                       it reaches only what these two bones reach.",
                source: "Tolani, Goswami and Badler 2000, doi:10.1006/gmod.2000.0528",
            },
        }
    }

    /// Its short name.
    pub(super) fn name(self) -> &'static str {
        self.facts().name
    }

    /// Whether it turns two joints of the chain and no others.
    pub(super) fn is_two_bone(self) -> bool {
        self == Self::TwoBone
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
