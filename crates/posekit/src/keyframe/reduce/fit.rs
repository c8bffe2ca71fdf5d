//! One joint's curve as few keys.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::ReduceConfig;
use crate::keyframe::animation::{Animation, index_to_f64};
use crate::keyframe::extrapolation::Extrapolation;
use crate::keyframe::key::{Interpolation, Keyframe, Tangents};
use crate::keyframe::track::Track;
use crate::keyframe::value::{KeyValue, Meeting};
use crate::motion::Motion;
use crate::skeleton::{JointId, Skeleton};

/// How much less than the tolerance a segment is fitted to, so that rounding to `f32` afterwards does not
/// lift it over.
const MARGIN: f64 = 0.999;

/// The curves of a motion, ready to be fitted.
pub(super) struct Curves {
    frame_time_secs: f64,
    rotations: Vec<Curve<DQuat>>,
    translations: Vec<Curve<DVec3>>,
    /// For each joint, how far its farthest descendant can be from it, in the file's unit.
    reaches: Vec<f64>,
    height: f64,
}

/// The values and slopes of one property at every frame; slopes are changes over one frame.
struct Curve<V> {
    joint: JointId,
    is_at_rest: bool,
    values: Vec<V>,
    slopes: Vec<V>,
}

/// Values whose distance can be told.
trait Fitted: KeyValue {
    /// Whether two values are within a tolerance: radians, or the file's unit.
    fn is_near(self, other: Self, tolerance: f64) -> bool;

    /// Its components with as many digits as `f32` has, so that a file of them is short.
    fn rounded(self) -> Self;
}

impl Fitted for DVec3 {
    fn is_near(self, other: Self, tolerance: f64) -> bool {
        self.distance_squared(other) <= tolerance * tolerance
    }

    fn rounded(self) -> Self {
        Self::from_array(self.to_array().map(rounded))
    }
}

impl Fitted for DQuat {
    fn is_near(self, other: Self, tolerance: f64) -> bool {
        // The vector part of the way between them is as long as the sine of half its angle.
        let sin_half = libm::sin(0.5 * tolerance.min(std::f64::consts::PI));
        (self.conjugate() * other).xyz().length_squared() <= sin_half * sin_half
    }

    fn rounded(self) -> Self {
        Self::from_array(self.to_array().map(rounded))
    }
}

/// The number of the fewest digits that the same `f32` stands for, which a motion holds to begin with; the
/// error is measured afterwards. What `f32` cannot hold stays as it is.
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding is what is wanted"
)]
fn rounded(value: f64) -> f64 {
    let single = value as f32;
    let shortest = single.to_string().parse().ok();
    shortest
        .filter(|shortest: &f64| shortest.is_finite())
        .unwrap_or(value)
}

impl Curves {
    pub(super) fn of(motion: &Motion) -> Self {
        let skeleton = motion.skeleton();
        let frames = motion.frame_count();
        let rotations = motion.rotated_joints().iter().map(|&joint| {
            let rest = skeleton.rest_rotation(joint);
            let values = (0..frames).map(|frame| motion.rotation(frame, joint));
            let is_at_rest = values.clone().all(|value| value == rest);
            let values = values.map(|value| value.as_dquat().normalize()).collect();
            Curve::new(joint, is_at_rest, values)
        });
        let translations = motion.translated_joints().iter().map(|&joint| {
            let rest = skeleton.rest_translation(joint);
            let values = (0..frames).map(|frame| motion.translation(frame, joint));
            let is_at_rest = values.clone().all(|value| value == rest);
            Curve::new(
                joint,
                is_at_rest,
                values.map(|value| value.as_dvec3()).collect(),
            )
        });
        let height = f64::from(skeleton.height());
        Self {
            frame_time_secs: motion.frame_time_secs(),
            rotations: rotations.collect(),
            translations: translations.collect(),
            reaches: reaches(motion),
            height: if height > 0.0 { height } else { 1.0 },
        }
    }

    /// Keys within a share of the distance that is allowed, and within the angle.
    pub(super) fn fitted(
        &self,
        skeleton: &Arc<Skeleton>,
        config: &ReduceConfig,
        share: f64,
    ) -> Animation {
        let distance = share * config.distance_heights * self.height * MARGIN;
        let angle_rad = config.angle_deg.to_radians() * MARGIN;
        let mut animation = Animation::new(Arc::clone(skeleton));
        for curve in self.rotations.iter().filter(|curve| !curve.is_at_rest) {
            let reach = self.reaches[curve.joint.index()];
            let tolerance = if reach > 0.0 {
                angle_rad.min(distance / reach)
            } else {
                angle_rad
            };
            let frames = curve.key_frames(tolerance, config.interpolation);
            let track = curve.track(&frames, self.frame_time_secs, config.interpolation);
            animation = animation.with_rotation(curve.joint, track);
        }
        for curve in self.translations.iter().filter(|curve| !curve.is_at_rest) {
            let frames = curve.key_frames(distance, config.interpolation);
            let track = curve.track(&frames, self.frame_time_secs, config.interpolation);
            animation = animation.with_translation(curve.joint, track);
        }
        animation
    }

    /// A key at every frame.
    pub(super) fn every_frame(&self, skeleton: Arc<Skeleton>) -> Animation {
        let mut animation = Animation::new(skeleton);
        let (secs, way) = (self.frame_time_secs, Interpolation::Linear);
        for curve in self.rotations.iter().filter(|curve| !curve.is_at_rest) {
            let frames: Vec<usize> = (0..curve.values.len()).collect();
            animation = animation.with_rotation(curve.joint, curve.track(&frames, secs, way));
        }
        for curve in self.translations.iter().filter(|curve| !curve.is_at_rest) {
            let frames: Vec<usize> = (0..curve.values.len()).collect();
            animation = animation.with_translation(curve.joint, curve.track(&frames, secs, way));
        }
        animation
    }
}

impl<V: Fitted> Curve<V> {
    /// Signs of orientations are put on the short way first.
    fn new(joint: JointId, is_at_rest: bool, mut values: Vec<V>) -> Self {
        for at in 1..values.len() {
            if values[at].is_far_side(values[at - 1]) {
                values[at] = values[at].scaled(-1.0);
            }
        }
        let slopes = (0..values.len()).map(|at| {
            let velocity = |from: usize| V::velocity(values[from], values[from + 1], 1.0);
            let velocity = match at {
                _ if values.len() == 1 => V::Velocity::default(),
                0 => velocity(0),
                at if at + 1 == values.len() => velocity(at - 1),
                at => V::smooth_velocity(Meeting {
                    before: velocity(at - 1),
                    secs_before: 1.0,
                    after: velocity(at),
                    secs_after: 1.0,
                }),
            };
            values[at].tangent(velocity)
        });
        Self {
            joint,
            is_at_rest,
            slopes: slopes.collect(),
            values,
        }
    }

    /// The frames that need a key, from the first to the last; the first alone where that is enough.
    fn key_frames(&self, tolerance: f64, way: Interpolation) -> Vec<usize> {
        let last = self.values.len() - 1;
        let first_value = self.values[0];
        if self
            .values
            .iter()
            .all(|value| value.is_near(first_value, tolerance))
        {
            return vec![0];
        }
        let mut frames = vec![0];
        let mut from = 0;
        let mut stride = 1;
        while from < last {
            // Doubling from half the last stride, then halving: what holds is tried last and kept.
            let (mut holds, mut step) = (1, stride);
            while from + step <= last && self.holds(from, from + step, tolerance, way) {
                holds = step;
                step *= 2;
            }
            let mut fails = step.min(last - from + 1);
            while fails - holds > 1 {
                let middle = holds + (fails - holds) / 2;
                if self.holds(from, from + middle, tolerance, way) {
                    holds = middle;
                } else {
                    fails = middle;
                }
            }
            from += holds;
            stride = (holds / 2).max(1);
            frames.push(from);
        }
        frames
    }

    /// Whether one segment is near the curve at every frame in between.
    fn holds(&self, from: usize, to: usize, tolerance: f64, way: Interpolation) -> bool {
        let span = index_to_f64(to - from);
        let ends = [from, to].map(|at| (self.values[at], self.slopes[at].scaled(span)));
        let [(start, start_slope), (end, end_slope)] = ends;
        (from + 1..to).all(|at| {
            let t = index_to_f64(at - from) / span;
            let found = match way {
                Interpolation::Cubic => V::hermite(start, start_slope, end, end_slope, t),
                _ => V::straight(start, end, t),
            };
            found.is_near(self.values[at], tolerance)
        })
    }

    fn track(&self, frames: &[usize], secs: f64, way: Interpolation) -> Option<Track<V>> {
        let keys = frames.iter().map(|&frame| Keyframe {
            time_secs: index_to_f64(frame) * secs,
            value: self.values[frame].rounded(),
            interpolation: way,
            tangents: match way {
                Interpolation::Cubic if frames.len() > 1 => {
                    Tangents::Aligned(self.slopes[frame].scaled(1.0 / secs).rounded())
                }
                _ => Tangents::Auto,
            },
        });
        // Values were checked to be finite; a frame time so small that times coincide leaves none.
        Track::new(keys.collect(), Extrapolation::Hold).ok()
    }
}

/// How far each joint's farthest descendant is from it at most, the joints in between stretched out; where
/// joints move in their parent's space, as far as they do.
fn reaches(motion: &Motion) -> Vec<f64> {
    let skeleton = motion.skeleton();
    let rest = skeleton.rest_translations().iter();
    let mut lengths: Vec<f64> = rest.map(|at| f64::from(at.length())).collect();
    for &joint in motion.translated_joints() {
        let frames = 0..motion.frame_count();
        let farthest = frames.map(|frame| motion.translation(frame, joint).length());
        lengths[joint.index()] = f64::from(farthest.fold(0.0, f32::max));
    }
    let mut reaches = vec![0.0_f64; skeleton.joint_count()];
    for joint in skeleton.joints().rev() {
        if let Some(parent) = skeleton.parent(joint) {
            let reach = lengths[joint.index()] + reaches[joint.index()];
            reaches[parent.index()] = reaches[parent.index()].max(reach);
        }
    }
    reaches
}
