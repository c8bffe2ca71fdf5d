//! What is compared: a method between two orientations, or curves of the angles that were set.
//!
//! Methods know orientations alone, and those know no whole turns: 0 and 360 degrees are one. Curves go from
//! number to number as a graph editor's do, an [`EulerTrack`] with straight pieces in the order in which the
//! angles are told, and turn as often as the numbers say.

use glam::DVec3;
use posekit::inbetween::{Between, Blend, Method, PathStep};
use posekit::keyframe::{EulerTrack, Extrapolation, Interpolation, Keyframe, Track};
use posekit::rotation::{EulerOrder, angle_between, matrix_from_quat};

use super::case::Case;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A method between orientations.
    Between(Method),
    /// Straight curves of the angles, in the order in which they are told.
    Curves,
}

impl From<Method> for Kind {
    fn from(method: Method) -> Self {
        Self::Between(method)
    }
}

impl Kind {
    /// All of them, in the order of the list.
    pub fn all() -> impl Iterator<Item = Self> {
        Method::ALL
            .into_iter()
            .map(Self::Between)
            .chain([Self::Curves])
    }

    /// Its name where angles are told in an order.
    #[must_use]
    pub fn name(self, order: EulerOrder) -> String {
        match self {
            Self::Between(method) => method.to_string(),
            Self::Curves => format!("curves:{order}"),
        }
    }

    /// Whether all that it makes are rotations.
    #[must_use]
    pub fn makes_rotations(self) -> bool {
        match self {
            Self::Between(method) => method.makes_rotations(),
            Self::Curves => true,
        }
    }

    /// The method between orientations, if it is one.
    #[must_use]
    pub const fn method(self) -> Option<Method> {
        match self {
            Self::Between(method) => Some(method),
            Self::Curves => None,
        }
    }
}

/// The curves of a case's angles: time counts keys.
#[must_use]
pub fn curves(case: &Case) -> Option<EulerTrack> {
    let keys = case.keys_deg().iter().enumerate().map(|(index, angles)| {
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let time = index as f64;
        Keyframe::new(time, DVec3::from_array(*angles), Interpolation::Linear)
    });
    let track = Track::new(keys.collect(), Extrapolation::Hold).ok()?;
    EulerTrack::new(case.order(), track).ok()
}

/// Where the curves are at a share of a gap, and how far that is from slerp, degrees.
pub(super) fn now(case: &Case, (gap, t): (usize, f64)) -> (glam::DQuat, f64) {
    let slerp = Between::new(Method::Slerp, &case.ends(gap)).rotation_at(t);
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let time = gap as f64 + t;
    let rotation = curves(case).map_or(slerp, |curves| curves.sample(time));
    (rotation, angle_between(rotation, slerp).to_degrees())
}

/// The curves' way through a gap, as [`path`](posekit::inbetween::path) tells those of methods.
pub(super) fn path_of_curves(case: &Case, gap: usize, steps: usize) -> Vec<PathStep> {
    /// Half the span over which a speed is measured.
    const NEAR: f64 = 1e-4;
    let Some(curves) = curves(case) else {
        return Vec::new();
    };
    let slerp = Between::new(Method::Slerp, &case.ends(gap));
    let count = u32::try_from(steps).unwrap_or(u32::MAX).max(1);
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let start = gap as f64;
    let at = |step: u32| {
        let t = f64::from(step) / f64::from(count);
        let [from, to] = [(t - NEAR).max(0.0), (t + NEAR).min(1.0)];
        let [before, rotation, after] = [from, t, to].map(|t| curves.sample(start + t));
        PathStep {
            t,
            blend: Blend {
                matrix: matrix_from_quat(rotation),
            },
            rotation,
            deviation_deg: angle_between(rotation, slerp.rotation_at(t)).to_degrees(),
            speed_deg: angle_between(before, after).to_degrees() / (to - from),
        }
    };
    (0..=count).map(at).collect()
}

/// What was asked for between two keys and no orientation can hold: more than half a turn of an angle. Where
/// the shortest way goes instead, degrees. `None` where all is within half a turn.
#[must_use]
pub fn lost_turn(case: &Case, gap: usize) -> Option<LostTurn> {
    let (from, to) = (case.keys_deg()[gap], case.keys_deg()[gap + 1]);
    let turned = [0, 1, 2].map(|k| to[k] - from[k]);
    let most = (0..3).max_by(|&a, &b| turned[a].abs().total_cmp(&turned[b].abs()))?;
    if turned[most].abs() <= 180.0 {
        return None;
    }
    Some(LostTurn {
        axis: case.order().axes().get(most)?.letter(),
        asked_deg: turned[most],
        shortest_deg: angle_between(case.rotation(gap), case.rotation(gap + 1)).to_degrees(),
    })
}

/// More than half a turn, and what becomes of it between orientations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostTurn {
    /// The axis of the angle.
    pub axis: char,
    /// How far the angle goes, degrees.
    pub asked_deg: f64,
    /// How far the shortest way between the orientations is, degrees.
    pub shortest_deg: f64,
}

impl LostTurn {
    /// In a sentence.
    #[must_use]
    pub fn text(self) -> String {
        let short = |deg: f64| super::super::readout::fixed(deg, 1).replace(".0", "");
        format!(
            "{} goes {}\u{b0}, more than half a turn: orientations cannot hold that. Their ways go {}\u{b0}; \
             curves go all of it.",
            self.axis,
            short(self.asked_deg),
            short(self.shortest_deg)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The length of a way, degrees: the sum of the angles between its steps.
    fn length_deg(steps: &[PathStep]) -> f64 {
        let pairs = steps.windows(2);
        pairs
            .map(|pair| angle_between(pair[0].rotation, pair[1].rotation).to_degrees())
            .sum()
    }

    fn about_y(from: f64, to: f64) -> Case {
        let mut case = Case::default();
        case.set_order(EulerOrder::YXZ);
        for (key, angle) in [(0, from), (1, to)] {
            for axis in 0..3 {
                case.set_angle(key, axis, if axis == 0 { angle } else { 0.0 });
            }
        }
        case
    }

    /// Turns about one axis are as long as the numbers say, and as fast all along.
    #[test]
    fn curves_turn_as_often_as_their_angles_say() {
        for (from, to, shortest) in [
            (0.0, 360.0, 0.0),
            (0.0, 720.0, 0.0),
            (0.0, 270.0, 90.0),
            (90.0, -450.0, 180.0),
        ] {
            let case = about_y(from, to);
            let way = path_of_curves(&case, 0, 100);
            let asked: f64 = to - from;
            assert!((length_deg(&way) - asked.abs()).abs() < 1e-6, "{from} {to}");
            for step in &way {
                assert!((step.speed_deg - asked.abs()).abs() < 1e-4, "{from} {to}");
            }
            // A quarter of the way on, by the angle itself.
            let quarter = glam::DQuat::from_rotation_y((from + 0.25 * asked).to_radians());
            assert!(angle_between(now(&case, (0, 0.25)).0, quarter) < 1e-9);
            let lost = lost_turn(&case, 0).expect("more than half a turn");
            assert_eq!((lost.axis, lost.asked_deg), ('Y', asked));
            assert!((lost.shortest_deg - shortest).abs() < 1e-6);
        }
        assert_eq!(lost_turn(&about_y(0.0, 180.0), 0), None);
        let text = lost_turn(&about_y(0.0, 720.0), 0).expect("lost").text();
        assert!(
            text.starts_with("Y goes 720\u{b0}, more than half a turn"),
            "{text}"
        );
        assert!(text.contains("ways go 0\u{b0};"), "{text}");
    }

    /// Within half a turn, curves are the method `euler` of their order.
    #[test]
    fn curves_within_half_a_turn_are_the_eulers_of_their_order() {
        use posekit::inbetween::{Preset, path};
        let mut case = Case::of_preset(Preset::Lecture);
        case.set_order(EulerOrder::ZXY);
        let ours = path_of_curves(&case, 0, 20);
        let theirs = path(Method::Euler(EulerOrder::ZXY), &case.ends(0), 20);
        for (a, b) in ours.iter().zip(&theirs) {
            assert!(angle_between(a.rotation, b.rotation) < 1e-6, "{}", a.t);
        }
    }
}
