//! How a pose that was edited at one frame reaches the frames around it, so that it does not pop.
//!
//! Full effect over a stretch of frames, and beyond its ends a raised cosine down to nothing:
//! `w = (1 + cos(pi d / n)) / 2` at `d` frames from the stretch, for `d < n`. Weights act on rotation
//! vectors, not on components: with `D = R(f0)^-1 R'(f0)` the change of a joint's local rotation at
//! the edited frame, frame f gets `R(f) exp(w log D)` ([`Blend::Change`]), or the point of the
//! shortest arc from `R(f)` to `R'(f0)` that `w` says ([`Blend::Pose`]).

use glam::{Quat, Vec3};
use posekit::rotation::slerp_f32;

/// What the frames around the edited one get.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// The same change: what moves goes on moving.
    #[default]
    Change,
    /// The edited pose itself: what moves is held.
    Pose,
}

/// Which frames an edited pose reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reach {
    /// The edited frame, and the fall-off on both sides.
    #[default]
    Frame,
    /// All of a stretch of frames, first and last, and the fall-off beyond.
    Stretch(usize, usize),
}

/// How an edited pose reaches the frames around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spread {
    /// Where it has its full effect.
    pub reach: Reach,
    /// After how many frames beyond that it has none; 0 and 1 end it at once.
    pub falloff_frames: usize,
    /// What the frames get.
    pub blend: Blend,
}

impl Spread {
    /// The frames that get anything, first and last, of a motion of `frame_count` frames that was
    /// edited at `frame`.
    #[must_use]
    pub fn frames(&self, frame: usize, frame_count: usize) -> (usize, usize) {
        let (first, last) = self.full(frame);
        let beyond = self.falloff_frames.saturating_sub(1);
        let end = frame_count.saturating_sub(1);
        (
            first.saturating_sub(beyond).min(end),
            last.saturating_add(beyond).min(end),
        )
    }

    /// How much of the change a frame gets, 0 to 1, when `edited` is the frame that was edited.
    #[must_use]
    pub fn weight(&self, edited: usize, frame: usize) -> f32 {
        let (first, last) = self.full(edited);
        let away = first.saturating_sub(frame).max(frame.saturating_sub(last));
        if away == 0 {
            return 1.0;
        }
        if away >= self.falloff_frames {
            return 0.0;
        }
        let share = away as f32 / self.falloff_frames as f32;
        0.5 * (1.0 + libm::cosf(std::f32::consts::PI * share))
    }

    /// The stretch of full effect; the edited frame is always in it.
    fn full(&self, edited: usize) -> (usize, usize) {
        match self.reach {
            Reach::Frame => (edited, edited),
            Reach::Stretch(a, b) => (a.min(b).min(edited), a.max(b).max(edited)),
        }
    }
}

impl Blend {
    /// A joint's rotation at a frame that gets `weight` of the change from `before` to `after`.
    #[must_use]
    pub fn rotation(self, here: Quat, (before, after): (Quat, Quat), weight: f32) -> Quat {
        let blended = match self {
            Self::Change => {
                let change = before.inverse() * after;
                here * slerp_f32(Quat::IDENTITY, change, weight)
            }
            Self::Pose => slerp_f32(here, after, weight),
        };
        blended.normalize()
    }

    /// As [`rotation`](Self::rotation), of a translation.
    #[must_use]
    pub fn translation(self, here: Vec3, (before, after): (Vec3, Vec3), weight: f32) -> Vec3 {
        match self {
            Self::Change => here + (after - before) * weight,
            Self::Pose => here.lerp(after, weight),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_a_raised_cosine_beyond_the_stretch() {
        let spread = Spread {
            reach: Reach::Stretch(10, 14),
            falloff_frames: 4,
            blend: Blend::Change,
        };
        // NumPy: 0.5 * (1 + np.cos(np.pi * np.arange(1, 5) / 4))
        let beyond = [0.853_553_4, 0.5, 0.146_446_6, 0.0];
        for (d, want) in (1..).zip(beyond) {
            for frame in [10 - d, 14 + d] {
                let weight = spread.weight(12, frame);
                assert!((weight - want).abs() < 1e-6, "{frame}: {weight}");
            }
        }
        for frame in 10..=14 {
            assert_eq!(spread.weight(12, frame), 1.0);
        }
        assert_eq!(spread.frames(12, 100), (7, 17));
        assert_eq!(spread.frames(12, 16), (7, 15));
    }

    #[test]
    fn the_edited_frame_always_gets_it_whole() {
        for reach in [Reach::Frame, Reach::Stretch(20, 30), Reach::Stretch(3, 0)] {
            let spread = Spread {
                reach,
                ..Spread::default()
            };
            assert_eq!(spread.weight(9, 9), 1.0);
            let (first, last) = spread.frames(9, 40);
            assert!((first..=last).contains(&9));
        }
        assert_eq!(Spread::default().frames(9, 40), (9, 9));
        assert_eq!(Spread::default().frames(9, 0), (0, 0));
    }

    #[test]
    fn half_of_a_turn_is_half_its_angle_about_the_same_axis() {
        let axis = Vec3::new(1.0, 2.0, -2.0) / 3.0;
        let here = Quat::from_axis_angle(Vec3::Y, 0.7);
        let before = Quat::from_axis_angle(Vec3::X, 0.4);
        let after = before * Quat::from_axis_angle(axis, 2.0);
        let half = Blend::Change.rotation(here, (before, after), 0.5);
        assert!(half.angle_between(here * Quat::from_axis_angle(axis, 1.0)) < 1e-3);
        let all = Blend::Pose.rotation(here, (before, after), 1.0);
        assert!(all.angle_between(after) < 1e-3);
    }
}
