//! One joint's curve as few keys.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::ReduceConfig;
use crate::keyframe::animation::index_to_f64;
use crate::keyframe::extrapolation::Extrapolation;
use crate::keyframe::key::{Interpolation, Keyframe, Tangents};
use crate::keyframe::track::Track;
use crate::keyframe::track_error::TrackError;
use crate::keyframe::value::{KeyValue, Meeting};
use crate::motion::Motion;
use crate::skeleton::{JointId, Skeleton};

/// How much less than the tolerance a segment is fitted to, so that rounding to `f32` afterwards does not
/// lift it over.
const MARGIN: f64 = 0.999;

/// A motion, ready to be fitted. Only one joint's curve is there in `f64` at a time.
pub(super) struct Curves<'a> {
    motion: &'a Motion,
    /// For each joint, how far its farthest descendant can be from it, in the file's unit.
    reaches: Vec<f64>,
    height: f64,
}

/// The frames that have a key, for each joint that is not at rest throughout.
#[derive(Clone, Debug, Default)]
pub(super) struct FrameKeys {
    rotations: Vec<(JointId, Vec<u32>)>,
    translations: Vec<(JointId, Vec<u32>)>,
}

impl FrameKeys {
    pub(super) fn count(&self) -> usize {
        let all = self.rotations.iter().chain(&self.translations);
        all.map(|(_, frames)| frames.len()).sum()
    }
}

/// The values and slopes of one property at every frame; slopes are changes over one frame.
struct Curve<V> {
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
    if !single.is_finite() {
        return value;
    }
    single.to_string().parse().unwrap_or(value)
}

impl<'a> Curves<'a> {
    pub(super) fn of(motion: &'a Motion) -> Self {
        let height = f64::from(motion.skeleton().height());
        Self {
            motion,
            reaches: reaches(motion),
            height: if height > 0.0 { height } else { 1.0 },
        }
    }

    /// A joint's rotation; `None` where it is at rest throughout.
    fn rotation(&self, joint: JointId) -> Option<Curve<DQuat>> {
        let motion = self.motion;
        let rest = motion.skeleton().rest_rotation(joint);
        let values = (0..motion.frame_count()).map(|frame| motion.rotation(frame, joint));
        if values.clone().all(|value| value == rest) {
            return None;
        }
        let values = values.map(|value| value.as_dquat().normalize());
        Some(Curve::new(values.collect()))
    }

    /// A joint's translation; `None` where it is at rest throughout.
    fn translation(&self, joint: JointId) -> Option<Curve<DVec3>> {
        let motion = self.motion;
        let rest = motion.skeleton().rest_translation(joint);
        let values = (0..motion.frame_count()).map(|frame| motion.translation(frame, joint));
        if values.clone().all(|value| value == rest) {
            return None;
        }
        Some(Curve::new(values.map(|value| value.as_dvec3()).collect()))
    }

    /// Keys within a share of the distance that is allowed, and within the angle; `baked`, a motion of the same
    /// frames, becomes what they make.
    pub(super) fn fitted(
        &self,
        config: &ReduceConfig,
        share: f64,
        baked: &mut Motion,
    ) -> Result<FrameKeys, TrackError> {
        let distance = share * config.distance_heights * self.height * MARGIN;
        let angle_rad = config.angle_deg.to_radians() * MARGIN;
        let way = config.interpolation;
        let mut keys = FrameKeys::default();
        for &joint in self.motion.rotated_joints() {
            let Some(curve) = self.rotation(joint) else {
                continue;
            };
            let reach = self.reaches[joint.index()];
            let tolerance = if reach > 0.0 {
                angle_rad.min(distance / reach)
            } else {
                angle_rad
            };
            let frames = curve.key_frames(tolerance, way);
            let track = curve.track(&frames, self.motion.frame_time_secs(), way)?;
            bake_rotation(baked, joint, &track);
            keys.rotations.push((joint, frames));
        }
        for &joint in self.motion.translated_joints() {
            let Some(curve) = self.translation(joint) else {
                continue;
            };
            let frames = curve.key_frames(distance, way);
            let track = curve.track(&frames, self.motion.frame_time_secs(), way)?;
            bake_translation(baked, joint, &track);
            keys.translations.push((joint, frames));
        }
        Ok(keys)
    }

    /// A key at every frame, straight ways between them; `baked` becomes what they make.
    pub(super) fn every_frame(&self, baked: &mut Motion) -> Result<FrameKeys, TrackError> {
        let every = || (0..self.motion.frame_count()).filter_map(|frame| u32::try_from(frame).ok());
        let (secs, way) = (self.motion.frame_time_secs(), Interpolation::Linear);
        let mut keys = FrameKeys::default();
        for &joint in self.motion.rotated_joints() {
            if let Some(curve) = self.rotation(joint) {
                let frames: Vec<u32> = every().collect();
                bake_rotation(baked, joint, &curve.track(&frames, secs, way)?);
                keys.rotations.push((joint, frames));
            }
        }
        for &joint in self.motion.translated_joints() {
            if let Some(curve) = self.translation(joint) {
                let frames: Vec<u32> = every().collect();
                bake_translation(baked, joint, &curve.track(&frames, secs, way)?);
                keys.translations.push((joint, frames));
            }
        }
        Ok(keys)
    }

    /// The track of a joint's rotation; `None` where it has no keys.
    pub(super) fn rotation_track(
        &self,
        keys: &FrameKeys,
        joint: JointId,
        way: Interpolation,
    ) -> Option<Result<Track<DQuat>, TrackError>> {
        let frames = frames_of(&keys.rotations, joint)?;
        let curve = self.rotation(joint)?;
        Some(curve.track(frames, self.motion.frame_time_secs(), way))
    }

    /// The track of a joint's translation; `None` where it has no keys.
    pub(super) fn translation_track(
        &self,
        keys: &FrameKeys,
        joint: JointId,
        way: Interpolation,
    ) -> Option<Result<Track<DVec3>, TrackError>> {
        let frames = frames_of(&keys.translations, joint)?;
        let curve = self.translation(joint)?;
        Some(curve.track(frames, self.motion.frame_time_secs(), way))
    }

    /// The skeleton that moves.
    pub(super) fn skeleton(&self) -> &Arc<Skeleton> {
        self.motion.skeleton()
    }
}

/// Keys stand in the order of the joints.
fn frames_of(keys: &[(JointId, Vec<u32>)], joint: JointId) -> Option<&[u32]> {
    let at = keys
        .binary_search_by_key(&joint, |&(joint, _)| joint)
        .ok()?;
    Some(&keys[at].1)
}

fn bake_rotation(motion: &mut Motion, joint: JointId, track: &Track<DQuat>) {
    let secs = motion.frame_time_secs();
    for frame in 0..motion.frame_count() {
        let value = track.sample(index_to_f64(frame) * secs);
        motion.set_rotation(frame, joint, value.as_quat());
    }
}

fn bake_translation(motion: &mut Motion, joint: JointId, track: &Track<DVec3>) {
    let secs = motion.frame_time_secs();
    for frame in 0..motion.frame_count() {
        let value = track.sample(index_to_f64(frame) * secs);
        motion.set_translation(frame, joint, value.as_vec3());
    }
}

impl<V: Fitted> Curve<V> {
    /// Signs of orientations are put on the short way first.
    fn new(mut values: Vec<V>) -> Self {
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
            slopes: slopes.collect(),
            values,
        }
    }

    /// The frames that need a key, from the first to the last; the first alone where that is enough.
    fn key_frames(&self, tolerance: f64, way: Interpolation) -> Vec<u32> {
        let last = self.values.len() - 1;
        let first_value = self.values[0];
        if self
            .values
            .iter()
            .all(|value| value.is_near(first_value, tolerance))
        {
            return vec![0];
        }
        let mut frames: Vec<u32> = vec![0];
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
            frames.extend(u32::try_from(from));
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

    fn track(&self, frames: &[u32], secs: f64, way: Interpolation) -> Result<Track<V>, TrackError> {
        let keys = frames.iter().map(|&frame| Keyframe {
            time_secs: f64::from(frame) * secs,
            value: self.values[frame as usize].rounded(),
            interpolation: way,
            tangents: match way {
                Interpolation::Cubic if frames.len() > 1 => {
                    Tangents::Aligned(self.slopes[frame as usize].scaled(1.0 / secs).rounded())
                }
                _ => Tangents::Auto,
            },
        });
        Track::new(keys.collect(), Extrapolation::Hold)
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
