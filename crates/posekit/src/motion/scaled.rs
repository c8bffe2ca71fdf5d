//! A motion in another unit of length.

use std::sync::Arc;

use super::Motion;

impl Motion {
    /// The same motion with every length times `factor`: the rest pose, and the translations of every frame.
    /// Rotations stay.
    ///
    /// `factor` is a number above zero. Lengths may come out too large to compute with:
    /// [`first_out_of_range`](Self::first_out_of_range) finds those of the frames.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        let mut scaled = Self {
            skeleton: Arc::new(self.skeleton.scaled(factor)),
            ..self.clone()
        };
        for lanes in &mut scaled.translations {
            for part in [&mut lanes.x, &mut lanes.y, &mut lanes.z] {
                part.0 = part.0.map(|length| length * factor);
            }
        }
        scaled
    }
}

#[cfg(test)]
mod tests {
    use crate::pose::GlobalPose;

    #[test]
    fn every_place_of_every_frame_is_so_much_farther_out() {
        let walk = crate::sample::by_name("walk").expect("a sample");
        let scaled = walk.scaled(100.0);
        let (before, after) = (walk.to_global(), scaled.to_global());
        for frame in (0..walk.frame_count()).step_by(17) {
            for joint in walk.skeleton().joints() {
                let gap = after
                    .position(frame, joint)
                    .distance(100.0 * before.position(frame, joint));
                assert!(gap < 1e-3, "{gap}");
                let (was, is) = (
                    before.orientation(frame, joint),
                    after.orientation(frame, joint),
                );
                assert!(is.abs_diff_eq(was, 1e-5), "{was} {is}");
            }
        }
        let (before, after) = (
            GlobalPose::rest(walk.skeleton()),
            GlobalPose::rest(scaled.skeleton()),
        );
        for (before, after) in before.positions.iter().zip(&after.positions) {
            assert!(after.distance(100.0 * *before) < 1e-3);
        }
        assert_eq!(scaled.frame_count(), walk.frame_count());
        assert_eq!(scaled.frame_time(), walk.frame_time());
    }
}
