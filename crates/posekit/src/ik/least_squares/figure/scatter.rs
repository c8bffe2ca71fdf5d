//! Other poses to start from.

use glam::DQuat;

use super::Figure;
use crate::ik::limit::{JointLimit, clamp_angle};
use crate::ik::random::Random;
use crate::rotation::{slerp, swing_twist};

impl Figure<'_> {
    /// Takes every joint `share` of the way to a random motion within its limits: near where it is for a
    /// small share, anywhere for 1. Stiff joints go less far; slides without bounds stay.
    pub(in crate::ik::least_squares) fn scatter(&mut self, random: &mut Random, share: f64) {
        let count = self.linkage.pivots.len();
        self.memory.moves.clear();
        for k in 0..count {
            let motion = self.linkage.motion(k);
            self.memory.moves.push(motion);
        }
        for k in 0..count {
            let inner = self.linkage.inner_turn(k);
            let pivot = self.linkage.pivots[k];
            let share = share * pivot.give;
            if let JointLimit::Slide { distance, .. } = pivot.limit
                && pivot.give > 0.0
                && (distance.max - distance.min).is_finite()
            {
                let goal = random.between(distance.min, distance.max) - pivot.slid_at_start;
                self.linkage.slides[k] += share * (goal - self.linkage.slides[k]);
            }
            self.linkage.turns[k] = if pivot.turns {
                let motion = between(
                    &pivot.limit,
                    self.memory.moves[k],
                    pivot.limit.sample(random),
                    share,
                );
                pivot.turn_of_motion(inner, motion).normalize()
            } else {
                inner
            };
        }
        self.linkage.place();
        self.begin_anew();
    }

    /// Forgets what the iterations before learnt of limits and wishes.
    pub(super) fn begin_anew(&mut self) {
        self.memory.normals.fill(glam::DVec3::ZERO);
        self.memory.moves.fill(DQuat::IDENTITY);
        let strength = self.problem.rest_pull.as_ref().map(|pull| pull.strength);
        self.pull_share = strength.unwrap_or(0.0).clamp(0.0, 1.0);
        self.measure();
    }
}

/// The part `share` of the way between two motions, within the limits. A hinge goes the way that its range
/// leaves it, which may be the long one.
fn between(limit: &JointLimit, from: DQuat, to: DQuat, share: f64) -> DQuat {
    if let JointLimit::Hinge { axis, angle_rad } = *limit {
        let angle = |motion| clamp_angle(swing_twist(motion, axis).twist_angle_rad, angle_rad);
        let (from, to) = (angle(from), angle(to));
        return crate::rotation::exp(axis * (from + share * (to - from)));
    }
    limit.project(slerp(from.normalize(), to.normalize(), share))
}
