//! Targets that move: does the pose follow as smoothly as they go?

use glam::{DQuat, DVec3};
use posekit::ik::{IkWorkspace, solve};
use posekit::rotation::log;

use super::linkage::StudiedChain;
use super::method::Method;
use super::setup::Study;

/// The frames of a path.
pub(super) const FRAMES: u32 = 120;

/// A way on which a target goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Path {
    /// Round and back to where it started, within reach.
    Circle,
    /// Straight away from the base until it is out of reach, and back.
    OutAndBack,
}

impl Path {
    /// Both.
    pub(super) const ALL: [Self; 2] = [Self::Circle, Self::OutAndBack];

    /// What it is called.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Circle => "circle",
            Self::OutAndBack => "out and back",
        }
    }

    /// Where the target is in a frame.
    fn place(self, chain: &StudiedChain, toward: DVec3, frame: u32) -> DVec3 {
        let turn_rad = core::f64::consts::TAU * f64::from(frame) / f64::from(FRAMES);
        let (sin, cos) = libm::sincos(turn_rad);
        match self {
            Self::Circle => {
                let side = toward.any_orthonormal_vector();
                let up = toward.cross(side);
                let middle = chain.base() + toward * (0.75 * chain.reach);
                middle + (side * cos + up * sin) * (0.15 * chain.reach)
            }
            Self::OutAndBack => {
                let share = 0.875 - 0.275 * cos;
                chain.base() + toward * (share * chain.reach)
            }
        }
    }
}

/// How a solver followed a path.
#[derive(Clone, Debug)]
pub(super) struct Following {
    /// The way.
    pub(super) path: Path,
    /// Index of the solver.
    pub(super) method: usize,
    /// By frame: how much farther from the target than it has to be.
    pub(super) misses: Vec<f64>,
    /// By frame from the second on: the most that one joint turned since the frame before, in radians.
    pub(super) steps_rad: Vec<f64>,
    /// How much all joints turned in the whole course, in radians.
    pub(super) motion_rad: f64,
    /// `sqrt(sum |w(t+1) - w(t)|^2 / sum |w(t)|^2)` with the rotation vectors w of all joints from frame to
    /// frame: 0 for an even motion, 2 for one that goes back and forth from frame to frame.
    pub(super) roughness: f64,
}

impl Following {
    /// Whether the target stays within reach all the way.
    pub(super) fn is_within_reach(&self) -> bool {
        self.path == Path::Circle
    }

    /// The most that one joint turned from one frame to the next, in radians.
    pub(super) fn largest_step_rad(&self) -> f64 {
        self.steps_rad.iter().copied().fold(0.0, f64::max)
    }
}

/// Lets every solver follow every path with the first chain, each frame from the pose of the one before.
pub(super) fn run(study: &Study) -> Vec<Following> {
    let chain = &study.chains[0];
    let toward = (study.targets[0][0].place - chain.base()).normalize_or(DVec3::Z);
    let mut all = Vec::new();
    for path in Path::ALL {
        for (method, &name) in study.methods.iter().enumerate() {
            all.push(follow(study, (path, toward), method, name));
        }
    }
    all
}

fn follow(study: &Study, (path, toward): (Path, DVec3), method: usize, name: Method) -> Following {
    let chain = &study.chains[0];
    let solver = name.solver(chain);
    let mut workspace = IkWorkspace::new();
    let mut pose = study.start.clone();
    let mut followed = Following {
        path,
        method,
        misses: Vec::new(),
        steps_rad: Vec::new(),
        motion_rad: 0.0,
        roughness: 0.0,
    };
    // The first frame is solved as well as can be: how it was come by is not what is measured here.
    let first = chain.problem(path.place(chain, toward, 0), 1000);
    solve(&study.skeleton, &mut pose, &first, &solver, &mut workspace);
    let mut before: Vec<DQuat> = Vec::new();
    let mut last_turns: Vec<DVec3> = Vec::new();
    let (mut changed_sq, mut turned_sq) = (0.0, 0.0);
    for frame in 0..=FRAMES {
        let place = path.place(chain, toward, frame);
        let problem = chain.problem(place, study.shown_count());
        let report = solve(
            &study.skeleton,
            &mut pose,
            &problem,
            &solver,
            &mut workspace,
        );
        let miss = report.largest_distance() - chain.beyond(place);
        followed.misses.push(miss.max(0.0));
        let now: Vec<DQuat> = workspace
            .moved()
            .iter()
            .map(|moved| moved.rotation)
            .collect();
        let turns: Vec<DVec3> = before
            .iter()
            .zip(&now)
            .map(|(&before, &now)| log(before.conjugate() * now))
            .collect();
        if frame > 0 {
            let sizes = turns.iter().map(|turn| turn.length());
            followed.motion_rad += sizes.clone().sum::<f64>();
            followed.steps_rad.push(sizes.fold(0.0, f64::max));
            turned_sq += turns.iter().map(|turn| turn.length_squared()).sum::<f64>();
        }
        let pairs = turns.iter().zip(&last_turns);
        changed_sq += pairs
            .map(|(now, last)| now.distance_squared(*last))
            .sum::<f64>();
        (before, last_turns) = (now, turns);
    }
    if turned_sq > 0.0 {
        followed.roughness = (changed_sq / turned_sq).sqrt();
    }
    followed
}
