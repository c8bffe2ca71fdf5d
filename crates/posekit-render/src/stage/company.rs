//! Figures beside each other whose files tell lengths in different units.
//!
//! The one rule for that, of the window, its films and `posekit render`: of two figures of which one is four
//! times as tall as the other, one file is in metres and the other in centimetres, or the like, and the
//! second would be a giant or a dwarf to the first. It is drawn as tall as the first, its way through the
//! world with it. Figures that differ by less stand as their files say.

use std::sync::Arc;

use posekit::motion::Motion;
use posekit::range::are_lengths;

use super::Actor;

/// Statures that differ by this factor are told in different units: there are no people four times as tall
/// as others.
const OTHER_UNIT: f32 = 4.0;

/// By how much a figure of one stature is made larger to stand beside one of another; `None` for one that
/// stands there as its file says.
#[must_use]
pub fn scale_beside(stature: f32, other: f32) -> Option<f32> {
    let factor = other / stature;
    let is_other_unit =
        factor.is_finite() && factor > 0.0 && !(1.0 / OTHER_UNIT..OTHER_UNIT).contains(&factor);
    is_other_unit.then_some(factor)
}

impl Actor {
    /// The figure as it stands beside one of this stature, and by how much it was made larger for that: `None`
    /// where it stands as its file says, or would be so far away that nothing can be computed of it.
    #[must_use]
    pub fn beside(self, stature: f32) -> (Self, Option<f32>) {
        let Some(factor) = scale_beside(self.stature(), stature) else {
            return (self, None);
        };
        let motion = self.motion().scaled(factor);
        if !is_in_range(&motion) {
            return (self, None);
        }
        let scaled = Self::new(Arc::new(motion), self.style(), *self.colors());
        (scaled, Some(factor))
    }
}

fn is_in_range(motion: &Motion) -> bool {
    let rest = motion.skeleton().rest_translations();
    let is_length = |at: &glam::Vec3| are_lengths(at.to_array().map(f64::from));
    motion.first_out_of_range().is_none() && rest.iter().all(is_length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage::SkeletonStyle;
    use crate::theme::CharacterColors;

    #[test]
    fn who_is_four_times_as_tall_or_more_is_told_in_another_unit() {
        for (stature, other, factor) in [
            (1.8, 1.7, None),
            (1.0, 3.9, None),
            (1.0, 0.26, None),
            (1.7, 170.0, Some(100.0)),
            (170.0, 1.7, Some(0.01)),
            (0.0, 1.7, None),
            (1.7, 0.0, None),
            (f32::INFINITY, 1.7, None),
        ] {
            let found = scale_beside(stature, other);
            assert_eq!(
                found.is_some(),
                factor.is_some(),
                "{stature} beside {other}"
            );
            if let (Some(found), Some(factor)) = (found, factor) {
                assert!((found - factor).abs() < 1e-4 * factor, "{found}");
            }
        }
    }

    #[test]
    fn a_figure_in_centimetres_is_as_tall_as_one_in_metres() {
        let walk = posekit::sample::by_name("walk").expect("a sample");
        let actor = |motion| {
            Actor::new(
                Arc::new(motion),
                SkeletonStyle::Bones,
                CharacterColors::of(1),
            )
        };
        let metres = actor(walk.clone());
        let stature = metres.stature();
        let (same, factor) = actor(walk.scaled(1.5)).beside(stature);
        assert_eq!(factor, None);
        assert!((same.stature() - 1.5 * stature).abs() < 1e-3);
        let (scaled, factor) = actor(walk.scaled(100.0)).beside(stature);
        assert!((scaled.stature() - stature).abs() < 1e-4 * stature);
        assert!(factor.is_some_and(|factor| (factor - 0.01).abs() < 1e-6));
    }
}
