//! Sampling a whole keyed skeleton fast.
//!
//! [`Track::sample`](super::Track::sample) searches its keys and evaluates in `f64`, with the
//! trigonometry that slerp and squad need. A [`PoseSampler`] is made once from an
//! [`Animation`] and gives the same poses from tables.
//!
//! **Method.** Every segment becomes cubic polynomials in the components of the quaternion, which are
//! evaluated in `f32` and normalised: cubic segments are that already, slerp and squad are cut in as many
//! cubic Hermite pieces as bring them within `3e-7` rad. Tracks that share a clock (start, end and
//! extrapolation) share an index of equal time buckets, whose rows say for all tracks at once which piece
//! a bucket starts in; then a time at random costs what the next time in order costs. (The usual
//! alternatives, a cursor for each track or a search in each, cost several times as much at random.)
//!
//! Euler curves, and translations with handles that are free in time, are evaluated as
//! [`Animation::sample`] does it: no cubic follows them.
//!
//! **Guarantees.** Within `2e-6` rad of [`Animation::sample`] for orientations; translations to `f32`
//! rounding. No state: a sampler can be shared between threads.
//!
//! **Cost.** Some nanoseconds a track, some ten times that for Euler curves, see `docs/performance.md`; memory about 96 bytes a piece and 4 bytes
//! for each bucket of a track.

mod group;
mod piece;

use std::sync::Arc;

use glam::{DQuat, DVec3, Mat4, Quat, Vec4, Vec4Swizzles};
use wide::f32x4;

use super::animation::Animation;
use super::euler::EulerTrack;
use super::extrapolation::Extrapolation;
use super::track::Track;
use crate::pose::LocalPose;
use crate::rotation::{exp, log};
use crate::skeleton::{JointId, Skeleton};
use group::{Clock, Group};
use piece::{Compiled, Piece, pieces};

/// A keyed skeleton made ready to be sampled at any time.
///
/// ```
/// use std::sync::Arc;
/// use glam::DQuat;
/// use posekit::keyframe::{Animation, Extrapolation, Interpolation, Keyframe, PoseSampler, Track};
/// use posekit::pose::LocalPose;
/// use posekit::skeleton::JointId;
///
/// let skeleton = posekit::sample::humanoid();
/// let keys = [0.0, 1.0].map(|t| Keyframe::new(t, DQuat::from_rotation_x(t), Interpolation::Linear));
/// let nod = Track::new(keys.to_vec(), Extrapolation::PingPong)?;
/// let head = skeleton.find("Head").expect("a humanoid has one");
/// let sampler = PoseSampler::new(&Animation::new(skeleton).with_rotation(head, Some(nod)));
/// let mut pose = LocalPose::rest(sampler.skeleton());
/// sampler.sample_into(1.25, &mut pose);
/// assert!((pose.rotations[head.index()].x - 0.375_f32.sin()).abs() < 1e-6);
/// # Ok::<(), posekit::keyframe::TrackError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PoseSampler {
    skeleton: Arc<Skeleton>,
    /// The joints whose rotation has no track.
    still: Vec<JointId>,
    /// Euler curves: whole turns, and as many of them as there are, do not fit in cubic pieces.
    eulers: Vec<(JointId, Arc<EulerTrack>)>,
    /// Translations with handles that are free in time: such a curve may be as steep as it likes.
    steep: Vec<(JointId, Arc<Track<DVec3>>)>,
    rotations: Vec<Shifting>,
    translations: Vec<Shifting>,
}

/// A group, and what its tracks are moved by from one cycle to the next.
#[derive(Clone, Debug)]
struct Shifting {
    group: Group,
    /// The joints that are moved at all, and how: a rotation vector or a translation.
    shifts: Vec<(JointId, DVec3)>,
}

impl PoseSampler {
    /// Makes an animation ready.
    ///
    /// # Panics
    /// If the animation has more than four thousand million pieces.
    pub fn new(animation: &Animation) -> Self {
        let rotations: Vec<JointTrack<'_, DQuat>> = animation
            .rotations()
            .filter_map(|(joint, track)| Some((joint, track.as_quaternion()?.as_ref())))
            .collect();
        let eulers = animation
            .rotations()
            .filter_map(|(joint, track)| Some((joint, Arc::clone(track.as_euler()?))));
        let translations: Vec<JointTrack<'_, DVec3>> = animation
            .translations()
            .filter(|(_, track)| !track.has_handles())
            .map(|(joint, track)| (joint, track.as_ref()))
            .collect();
        let steep = animation
            .translations()
            .filter(|(_, track)| track.has_handles())
            .map(|(joint, track)| (joint, Arc::clone(track)));
        Self {
            skeleton: Arc::clone(animation.skeleton()),
            still: animation
                .skeleton()
                .joints()
                .filter(|&joint| animation.rotation(joint).is_none())
                .collect(),
            eulers: eulers.collect(),
            steep: steep.collect(),
            rotations: groups(&rotations, |[first, last]| log(last * first.conjugate())),
            translations: groups(&translations, |[first, last]| last - first),
        }
    }

    /// The skeleton that moves.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// Fills `pose` with the pose at a time in seconds, without allocating when it fits already.
    pub fn sample_into(&self, time_secs: f64, pose: &mut LocalPose) {
        if pose.rotations.len() != self.skeleton.joint_count() {
            pose.rotations.clear();
            pose.rotations
                .extend_from_slice(self.skeleton.rest_rotations());
        }
        for &joint in &self.still {
            pose.rotations[joint.index()] = self.skeleton.rest_rotation(joint);
        }
        pose.translations.clear();
        pose.translations
            .extend_from_slice(self.skeleton.rest_translations());
        for Shifting { group, shifts } in &self.rotations {
            let rotations = &mut pose.rotations[..];
            let place = group.each(time_secs, |joints, components| {
                let four = normalized(components);
                for (joint, rotation) in joints.into_iter().zip(four) {
                    rotations[joint.index()] = Quat::from_vec4(rotation);
                }
            });
            if place.shifts != 0.0 {
                for &(joint, shift) in shifts {
                    let rotation = &mut rotations[joint.index()];
                    *rotation = (exp(shift * place.shifts) * rotation.as_dquat()).as_quat();
                }
            }
        }
        for Shifting { group, shifts } in &self.translations {
            let translations = &mut pose.translations[..];
            let place = group.each(time_secs, |joints, components| {
                for (joint, translation) in joints.into_iter().zip(components) {
                    translations[joint.index()] = translation.truncate();
                }
            });
            if place.shifts != 0.0 {
                for &(joint, shift) in shifts {
                    translations[joint.index()] += (shift * place.shifts).as_vec3();
                }
            }
        }
        for (joint, track) in &self.eulers {
            pose.rotations[joint.index()] = track.sample(time_secs).as_quat();
        }
        for (joint, track) in &self.steep {
            pose.translations[joint.index()] = track.sample(time_secs).as_vec3();
        }
    }
}

/// Four quaternions at unit length: with their components side by side, one root and one division do.
#[inline(always)]
fn normalized(four: [Vec4; 4]) -> [Vec4; 4] {
    let [a, b, c, d] = four;
    let by_component = Mat4::from_cols(a, b, c, d).transpose();
    let [x, y, z, w] = [
        by_component.x_axis,
        by_component.y_axis,
        by_component.z_axis,
        by_component.w_axis,
    ];
    let squares = x * x + y * y + (z * z + w * w);
    let lengths = f32x4::from(squares.to_array()).sqrt();
    let inverse = Vec4::from_array((f32x4::ONE / lengths).to_array());
    [
        a * inverse.xxxx(),
        b * inverse.yyyy(),
        c * inverse.zzzz(),
        d * inverse.wwww(),
    ]
}

/// A joint and the track of one of its properties.
type JointTrack<'a, V> = (JointId, &'a Track<V>);

/// Tracks by clock, in the order of their first joints.
fn groups<V: Compiled>(
    tracks: &[JointTrack<'_, V>],
    shift: impl Fn([V; 2]) -> DVec3,
) -> Vec<Shifting> {
    let held = tracks.iter().filter(|(_, track)| clock(track).holds());
    let held_range = held.map(|(_, track)| clock(track).range_secs);
    let held_range = held_range.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
    let mut by_clock: Vec<(Clock, Vec<JointTrack<'_, V>>)> = Vec::new();
    for &(joint, track) in tracks {
        let mut clock = clock(track);
        if let (true, Some(range_secs)) = (clock.holds(), held_range) {
            // What holds beyond its ends can share the longest range.
            clock.range_secs = range_secs;
        }
        match by_clock.iter_mut().find(|(other, _)| *other == clock) {
            Some((_, same)) => same.push((joint, track)),
            None => by_clock.push((clock, vec![(joint, track)])),
        }
    }
    let grouped = by_clock.into_iter().map(|(clock, tracks)| Shifting {
        shifts: tracks
            .iter()
            .map(|(joint, track)| (*joint, shift(track.ends())))
            .filter(|(_, shift)| clock.moves_on() && *shift != DVec3::ZERO)
            .collect(),
        group: Group::new(
            clock,
            tracks
                .iter()
                .map(|(joint, track)| (*joint, padded(clock, track)))
                .collect(),
        ),
    });
    grouped.collect()
}

/// The pieces of a track from the start of its clock's range on.
fn padded<V: Compiled>(clock: Clock, track: &Track<V>) -> Vec<Piece> {
    let mut all = pieces(track);
    let start_secs = clock.range_secs[0];
    if start_secs < track.start_secs() {
        all.insert(0, Piece::constant(start_secs, track.ends()[0].components()));
    }
    all
}

fn clock<V: Compiled>(track: &Track<V>) -> Clock {
    Clock {
        range_secs: [track.start_secs(), track.end_secs()],
        ways: [track.before(), track.after()],
    }
}

impl Clock {
    fn holds(self) -> bool {
        self.ways == [Extrapolation::Hold; 2]
    }

    fn moves_on(self) -> bool {
        self.ways.contains(&Extrapolation::CycleWithOffset)
    }
}
