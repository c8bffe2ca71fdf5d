//! A motion in a world that was turned.

use std::sync::Arc;

use glam::Quat;

use super::Motion;

impl Motion {
    /// The same motion in a world turned by `turn` about the origin: the rest pose and every frame. Only the
    /// roots' transforms change.
    /// `turn` is a unit quaternion.
    #[must_use]
    pub fn turned(&self, turn: Quat) -> Self {
        let mut turned = Self {
            skeleton: Arc::new(self.skeleton.turned(turn)),
            ..self.clone()
        };
        let roots: Vec<_> = self.skeleton.roots().collect();
        for root in roots {
            let moves = self.translated.slot(root).is_some();
            for frame in 0..self.frame_count {
                turned.set_rotation(frame, root, turn * self.rotation(frame, root));
                if moves {
                    turned.set_translation(frame, root, turn * self.translation(frame, root));
                }
            }
        }
        turned
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::GlobalPose;

    #[test]
    fn every_joint_of_every_frame_is_turned() {
        let walk = crate::sample::by_name("walk").expect("a sample");
        let turn = Quat::from_rotation_x(-0.7) * Quat::from_rotation_y(0.4);
        let turned = walk.turned(turn);
        let (before, after) = (walk.to_global(), turned.to_global());
        for frame in (0..walk.frame_count()).step_by(17) {
            for joint in walk.skeleton().joints() {
                let expected = turn * before.position(frame, joint);
                let gap = after.position(frame, joint).distance(expected);
                assert!(gap < 1e-5, "{gap}");
            }
        }
        let (before, after) = (
            GlobalPose::rest(walk.skeleton()),
            GlobalPose::rest(turned.skeleton()),
        );
        for (before, after) in before.positions.iter().zip(&after.positions) {
            assert!(after.distance(turn * *before) < 1e-6);
        }
    }
}
