//! A motion in a world that was turned.

use std::sync::Arc;

use glam::Quat;

use super::Motion;
use crate::skeleton::{Skeleton, SkeletonBuilder};

impl Motion {
    /// The same motion in a world turned by `turn` about the origin: the rest pose and every frame. Only the
    /// roots' transforms change.
    ///
    /// # Panics
    /// If `turn` is not a unit quaternion.
    #[must_use]
    pub fn turned(&self, turn: Quat) -> Self {
        let mut turned = Self {
            skeleton: Arc::new(turned_skeleton(&self.skeleton, turn)),
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

fn turned_skeleton(skeleton: &Skeleton, turn: Quat) -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    for joint in skeleton.joints() {
        let name = skeleton.name(joint);
        let (translation, rotation) = (
            skeleton.rest_translation(joint),
            skeleton.rest_rotation(joint),
        );
        match skeleton.parent(joint) {
            None => builder.oriented_joint(name, None, turn * translation, turn * rotation),
            Some(parent) if skeleton.is_end_site(joint) => {
                builder.end_site(name, parent, translation)
            }
            parent => builder.oriented_joint(name, parent, translation, rotation),
        };
    }
    builder
        .build()
        .expect("a turned skeleton is as valid as it was")
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
