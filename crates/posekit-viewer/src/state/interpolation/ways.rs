//! What the methods make of the keys: where they are at a share of the way, and their numbers over all of it.

use glam::DVec3;
use posekit::inbetween::{Between, Blend, Method, PathStep, path};
use posekit::rotation::{angle_between, matrix_from_quat};

use super::case::Case;
use super::kind::{self, Kind, path_of_curves};

/// Steps of the way between two keys: the numbers are those of `posekit slerp --steps 100`.
pub const STEPS: usize = 100;

/// Steps between two of many keys.
const STEPS_OF_MANY: usize = 40;

/// How much of the keys is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Span {
    /// From the start to the end.
    #[default]
    Pair,
    /// Through all keys, a way to each gap.
    AllKeys,
}

impl Span {
    /// How many ways it is long.
    #[must_use]
    pub fn length(self, case: &Case) -> f64 {
        match self {
            Self::Pair => 1.0,
            #[expect(clippy::cast_precision_loss, reason = "a small number")]
            Self::AllKeys => case.gap_count() as f64,
        }
    }

    /// The gap that a share of the whole is in, and the share of that gap.
    #[must_use]
    pub fn place(self, case: &Case, share: f64) -> (usize, f64) {
        match self {
            Self::Pair => (case.gap(), share.clamp(0.0, 1.0)),
            Self::AllKeys => {
                let share = share.clamp(0.0, self.length(case));
                let last = case.gap_count() - 1;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "within the small number of gaps"
                )]
                let gap = (share.floor() as usize).min(last);
                #[expect(clippy::cast_precision_loss, reason = "a small number")]
                let start = gap as f64;
                (gap, share - start)
            }
        }
    }

    fn gaps(self, case: &Case) -> std::ops::Range<usize> {
        match self {
            Self::Pair => case.gap()..case.gap() + 1,
            Self::AllKeys => 0..case.gap_count(),
        }
    }
}

/// Where a method is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Now {
    /// What it is.
    pub kind: Kind,
    /// What it makes there.
    pub blend: Blend,
    /// The (nearest) rotation.
    pub rotation: glam::DQuat,
    /// How far that is from slerp, degrees.
    pub deviation_deg: f64,
}

/// Where something is at a share of a gap.
#[must_use]
pub fn now(kind: Kind, case: &Case, (gap, t): (usize, f64)) -> Now {
    let Kind::Between(method) = kind else {
        let (rotation, deviation_deg) = kind::now(case, (gap, t));
        return Now {
            kind,
            blend: Blend {
                matrix: matrix_from_quat(rotation),
            },
            rotation,
            deviation_deg,
        };
    };
    let ends = &case.ends(gap);
    let way = Between::new(method, ends);
    let rotation = way.rotation_at(t);
    let slerp = Between::new(Method::Slerp, ends).rotation_at(t);
    Now {
        kind,
        blend: way.at(t),
        rotation,
        deviation_deg: angle_between(rotation, slerp).to_degrees(),
    }
}

/// A method's way, and its extremes.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// What it is.
    pub kind: Kind,
    /// The steps; `t` counts ways from the first key looked at.
    pub steps: Vec<PathStep>,
    /// The farthest from slerp, degrees.
    pub most_deviation_deg: f64,
    /// The fastest, degrees for a way.
    pub most_speed_deg: f64,
    /// The slowest.
    pub least_speed_deg: f64,
    /// The least determinant.
    pub least_determinant: f64,
    /// The greatest shear, degrees; NaN where an axis has no length.
    pub most_shear_deg: f64,
}

impl Way {
    /// The way of a method, or of curves.
    #[must_use]
    pub fn new(kind: impl Into<Kind>, case: &Case, span: Span) -> Self {
        let kind = kind.into();
        let gaps = span.gaps(case);
        let count = if gaps.len() == 1 {
            STEPS
        } else {
            STEPS_OF_MANY
        };
        let steps: Vec<PathStep> = gaps
            .enumerate()
            .flat_map(|(passed, gap)| {
                #[expect(clippy::cast_precision_loss, reason = "a small number")]
                let before = passed as f64;
                let steps = match kind {
                    Kind::Between(method) => path(method, &case.ends(gap), count),
                    Kind::Curves => path_of_curves(case, gap, count),
                };
                steps.into_iter().map(move |step| PathStep {
                    t: before + step.t,
                    ..step
                })
            })
            .collect();
        let most = |value: fn(&PathStep) -> f64| steps.iter().map(value).fold(0.0, f64::max);
        let least =
            |value: fn(&PathStep) -> f64| steps.iter().map(value).fold(f64::INFINITY, f64::min);
        Self {
            kind,
            most_deviation_deg: most(|step| step.deviation_deg),
            most_speed_deg: most(|step| step.speed_deg),
            least_speed_deg: least(|step| step.speed_deg),
            least_determinant: least(|step| step.blend.determinant()),
            most_shear_deg: steps.iter().map(|step| step.blend.shear_deg()).fold(
                0.0,
                |a: f64, b| {
                    if a.is_nan() || b.is_nan() {
                        f64::NAN
                    } else {
                        a.max(b)
                    }
                },
            ),
            steps,
        }
    }

    /// The path of an axis' tip, of the nearest rotations: on the unit sphere.
    #[must_use]
    pub fn tips(&self, axis: DVec3) -> Vec<DVec3> {
        let tips = self.steps.iter().map(|step| step.rotation * axis);
        tips.collect()
    }

    /// The path of the tip as the method's own matrices have it, off the sphere where they are no rotations.
    #[must_use]
    pub fn raw_tips(&self, axis: DVec3) -> Vec<DVec3> {
        let tips = self.steps.iter().map(|step| step.blend.matrix * axis);
        tips.collect()
    }
}

#[cfg(test)]
mod tests {
    use posekit::inbetween::Preset;

    use super::*;

    #[test]
    fn the_lecture_is_right() {
        let case = Case::of_preset(Preset::Lecture);
        let matrix = Way::new(Method::Matrix, &case, Span::Pair);
        assert!((matrix.least_determinant - 0.5).abs() < 1e-12);
        assert!(matrix.most_shear_deg < 1e-6, "it only shrinks");
        let slerp = Way::new(Method::Slerp, &case, Span::Pair);
        assert!(slerp.most_deviation_deg < 1e-9);
        assert!((slerp.most_speed_deg - 90.0).abs() < 1e-4);
        assert!((slerp.least_speed_deg - 90.0).abs() < 1e-4);
    }

    #[test]
    fn presets_show_what_they_say() {
        let way = |preset, word: &str, span| {
            let case = Case::of_preset(preset);
            let method: Method = word.parse().expect("a method");
            Way::new(method, &case, span)
        };
        let zxy = way(Preset::Zxy, "euler:ZXY", Span::Pair);
        let slerp = way(Preset::Zxy, "slerp", Span::Pair);
        assert!(zxy.most_speed_deg > 1.9 * zxy.least_speed_deg);
        assert!(
            (slerp.most_speed_deg - 30.4).abs() < 0.1,
            "{}",
            slerp.most_speed_deg
        );
        let gimbal = way(Preset::Gimbal, "euler:XYZ", Span::Pair);
        assert!((gimbal.most_deviation_deg - 14.75).abs() < 0.01);
        assert!(gimbal.most_speed_deg > 1.7 * 40.0);
        let turned = way(Preset::LongWay, "rawslerp", Span::Pair);
        assert!((turned.most_speed_deg - 300.0).abs() < 1e-3);
        assert!(
            way(Preset::Flip, "matrix", Span::Pair)
                .least_determinant
                .abs()
                < 1e-12
        );
        assert!(way(Preset::HalfTurn, "matrix", Span::Pair).most_speed_deg > 5_000.0);
        for method in Method::ALL {
            let near = Way::new(method, &Case::of_preset(Preset::Near), Span::Pair);
            assert!(near.most_deviation_deg < 0.01, "{method}");
        }
        // Slerp's speed steps at keys, where one way ends and the next begins; squad's does not.
        let jump = |way: &Way| {
            let keys = way.steps.windows(2).filter(|two| two[0].t >= two[1].t);
            let jumps = keys.map(|two| (two[1].speed_deg - two[0].speed_deg).abs());
            jumps.fold(0.0, f64::max)
        };
        let slerp = way(Preset::Keys, "slerp", Span::AllKeys);
        let squad = way(Preset::Keys, "squad", Span::AllKeys);
        assert!(
            jump(&slerp) > 5.0 && jump(&squad) < 0.1,
            "{} {}",
            jump(&slerp),
            jump(&squad)
        );
        let swing = way(Preset::Swing, "euler:ZXY", Span::AllKeys);
        assert!(swing.most_deviation_deg > 5.0);
        assert!(way(Preset::Swing, "squad", Span::AllKeys).most_deviation_deg < 1e-6);
    }

    #[test]
    fn a_share_of_all_keys_is_in_a_gap() {
        let case = Case::of_preset(Preset::Keys);
        assert_eq!(Span::Pair.place(&case, 0.25), (1, 0.25));
        assert_eq!(Span::AllKeys.place(&case, 2.25), (2, 0.25));
        assert_eq!(Span::AllKeys.place(&case, 4.0), (3, 1.0));
        assert_eq!(Span::AllKeys.place(&case, 99.0), (3, 1.0));
    }
}
