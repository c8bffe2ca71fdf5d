//! Where the targets are: named, on a grid, and at random.

use fastrand::Rng;
use glam::{DQuat, DVec3};

use super::linkage::StudiedChain;

/// Random poses turn every joint by at most this.
const LARGEST_TURN_RAD: f64 = core::f64::consts::FRAC_PI_2;

/// How far out of reach random targets are, in reaches: clearly, and not absurdly.
const BEYOND: [f64; 2] = [1.05, 1.5];

/// How a target came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The user's, or the default one.
    Named,
    /// On the grid.
    Grid {
        /// From the top.
        row: usize,
        /// From the left of the picture.
        column: usize,
    },
    /// Where the effector was in a random pose.
    Reachable,
    /// In a random direction, too far away.
    Unreachable,
}

impl Kind {
    /// Its name in files.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Grid { .. } => "grid",
            Self::Reachable => "random reachable",
            Self::Unreachable => "random unreachable",
        }
    }
}

/// A target.
#[derive(Clone, Debug)]
pub(super) struct Target {
    /// What it is called.
    pub(super) name: String,
    /// How it came about.
    pub(super) kind: Kind,
    /// Where it is, in the world.
    pub(super) place: DVec3,
    /// How far it is out of the chain's reach; 0 within.
    pub(super) beyond: f64,
}

/// A target that is out of reach by no more than this share of the reach is within it: what rounding makes of
/// a chain that is stretched straight.
const AT_REACH: f64 = 1e-9;

impl Target {
    /// A target of a chain.
    pub(super) fn new(chain: &StudiedChain, kind: Kind, name: String, place: DVec3) -> Self {
        let beyond = chain.beyond(place);
        Self {
            name,
            kind,
            place,
            beyond: if beyond > AT_REACH * chain.reach {
                beyond
            } else {
                0.0
            },
        }
    }

    /// Whether no pose brings the chain's end to it.
    pub(super) fn is_out_of_reach(&self) -> bool {
        self.beyond > 0.0
    }
}

/// Targets where a chain's end was in random poses: each of its joints turned by up to a right angle about
/// an axis in any direction.
pub(super) fn reachable(chain: &StudiedChain, count: u32, random: &mut Rng) -> Vec<Target> {
    let one = |index: u32| {
        let mut points = chain.points.clone();
        for pivot in (0..points.len() - 1).rev() {
            let angle_rad = random.f64() * LARGEST_TURN_RAD;
            let turn = posekit::rotation::exp(direction(random) * angle_rad);
            turn_beyond(&mut points, pivot, turn);
        }
        let place = points[points.len() - 1];
        Target::new(
            chain,
            Kind::Reachable,
            format!("reachable {}", index + 1),
            place,
        )
    };
    (0..count).map(one).collect()
}

/// Turns all points after a pivot about it.
fn turn_beyond(points: &mut [DVec3], pivot: usize, turn: DQuat) {
    let center = points[pivot];
    for point in &mut points[pivot + 1..] {
        *point = center + turn * (*point - center);
    }
}

/// Targets in random directions from a chain's base, beyond its reach.
pub(super) fn unreachable(chain: &StudiedChain, count: u32, random: &mut Rng) -> Vec<Target> {
    let one = |index: u32| {
        let share = BEYOND[0] + (BEYOND[1] - BEYOND[0]) * random.f64();
        let place = chain.base() + direction(random) * (share * chain.reach);
        Target::new(
            chain,
            Kind::Unreachable,
            format!("unreachable {}", index + 1),
            place,
        )
    };
    (0..count).map(one).collect()
}

/// A direction, each as likely as any other, by rejection.
fn direction(random: &mut Rng) -> DVec3 {
    loop {
        let v = DVec3::from_array(core::array::from_fn(|_| random.f64() * 2.0 - 1.0));
        let length_sq = v.length_squared();
        if length_sq > 1e-4 && length_sq <= 1.0 {
            return v / length_sq.sqrt();
        }
    }
}

/// A square of `n` by `n` places on an upright plane, row by row from the top left as somebody sees it who
/// faces the figure: `center` is its middle, `across` the direction to that viewer's right.
pub(super) fn grid(n: u32, center: DVec3, across: DVec3, half_side: f64) -> Vec<(Kind, DVec3)> {
    let step = |index: u32| match n {
        1 => 0.0,
        _ => half_side * (2.0 * f64::from(index) / f64::from(n - 1) - 1.0),
    };
    let mut places = Vec::new();
    for row in 0..n {
        for column in 0..n {
            let place = center + across * step(column) - DVec3::Y * step(row);
            let kind = Kind::Grid {
                row: row as usize,
                column: column as usize,
            };
            places.push((kind, place));
        }
    }
    places
}
