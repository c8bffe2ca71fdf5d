//! What joints would like to do as far as no target minds: preferred poses and poles.

use glam::DVec3;

use super::Figure;
use crate::ik::turn::swivel_angle;
use crate::rotation::log;

/// How much weaker the pull to a preferred pose is in each iteration than in the one before: half after
/// three.
const FADING: f64 = 0.8;

/// A pull of less than this share of the way is over.
const FADED: f64 = 1e-6;

/// Poles are met when no chain has to swivel by more than this to bring its joint to its side.
const MET_RAD: f64 = 0.01;

impl Figure<'_> {
    /// Whether any joint may wish anything.
    pub(super) fn has_wishes(&self) -> bool {
        !self.problem.poles.is_empty() || (self.pull.is_some() && self.pull_share > FADED)
    }

    /// The turn of pivot `k`'s outer link, as a rotation vector in the world, that its joint would like
    /// to make.
    pub(super) fn wish(&self, k: usize) -> DVec3 {
        let mut wish = self.pole_wish(k);
        if let Some(pull) = &self.pull
            && self.pull_share > FADED
        {
            let pivot = &self.linkage.pivots[k];
            let motion = pivot.rest.conjugate() * pull.preferred(pivot.joint);
            let preferred = pivot.turn_of_motion(self.linkage.inner_turn(k), motion);
            wish += log(preferred * self.linkage.turns[k].conjugate()) * self.pull_share;
        }
        wish
    }

    /// The swivel about the line from pivot `k` to an effector whose chain begins with it that brings a
    /// joint to the side of its pole.
    fn pole_wish(&self, k: usize) -> DVec3 {
        let mut wish = DVec3::ZERO;
        let linkage = &*self.linkage;
        for pole in &self.problem.poles {
            for effector in 0..linkage.effectors.len() {
                let path = linkage.path(effector);
                if path.first().is_none_or(|&first| first as usize != k) {
                    continue;
                }
                let is_drawn = |&&k: &&u32| linkage.pivots[k as usize].joint == pole.joint;
                let Some(&drawn) = path.iter().find(is_drawn) else {
                    continue;
                };
                let base = linkage.positions[k];
                let line = linkage.effector_position(effector) - base;
                let drawn = linkage.positions[drawn as usize] - base;
                if let Some(angle) = swivel_angle(line, drawn, pole.point_in_world - base) {
                    let weight = pole.weight.clamp(0.0, 1.0);
                    wish += line.normalize_or_zero() * (angle * weight);
                }
            }
        }
        wish
    }

    /// Whether every joint with a pole is nearly on its side.
    pub(super) fn poles_are_met(&self) -> bool {
        self.problem.poles.is_empty()
            || (0..self.linkage.pivots.len()).all(|k| self.pole_wish(k).length() <= MET_RAD)
    }

    /// Makes the pull to the preferred pose weaker, so that what targets ask for wins in the end.
    pub(super) fn fade_wishes(&mut self) {
        self.pull_share *= FADING;
    }
}
