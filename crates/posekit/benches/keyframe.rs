//! What a pose of a keyed skeleton costs, times in order and at random, beside a bare array of the same
//! poses that is looked up and interpolated.
//!
//! `cargo bench -p posekit --bench keyframe [SECONDS]`

#![allow(
    clippy::cast_possible_truncation,
    reason = "frame numbers of a clip of seconds"
)]

#[path = "../../../benches/harness.rs"]
mod harness;

use std::hint::black_box;

use glam::{DQuat, Quat};
use harness::{Table, Unit, time_asked};
use posekit::keyframe::{Animation, Extrapolation, Interpolation, Keyframe, PoseSampler, Track};
use posekit::pose::LocalPose;
use posekit::rotation::{nlerp_f32, slerp_f32};
use posekit::sample;
use posekit::skeleton::JointId;

/// Times a run.
const TIMES: usize = 256;

/// Rate of the bare array.
const FRAMES_PER_SEC: f64 = 60.0;

fn main() {
    for (title, gap_frames, way) in [
        (
            "cubic keys, each joint at times of its own, 4 a second",
            15,
            Interpolation::Cubic,
        ),
        ("slerp between keys, 4 a second", 15, Interpolation::Linear),
        ("squad through keys, 4 a second", 15, Interpolation::Squad),
        ("slerp between keys, 30 a second", 2, Interpolation::Linear),
    ] {
        measure(title, gap_frames, way);
    }
}

fn measure(title: &str, gap_frames: usize, way: Interpolation) {
    let animation = walk(gap_frames, way);
    let sampler = PoseSampler::new(&animation);
    let joints = animation.rotations().count();
    let [start, end] = animation.range_secs().expect("keys");
    let ordered: Vec<f64> = (0..TIMES)
        .map(|i| start + (end - start) * i as f64 / TIMES as f64)
        .collect();
    // A permutation that no predictor learns: multiplication by an odd number.
    let random: Vec<f64> = (0..TIMES)
        .map(|i| ordered[i * 2_654_435_761 % TIMES])
        .collect();
    let dense = &Dense::new(&animation);
    let (sampler, animation) = (&sampler, &animation);
    let mut table = Table::new(
        format!("{title}: {joints} joints, {} keys", animation.key_count()),
        Unit::NanosecondsPer("joint"),
    );
    let amount = TIMES * joints;
    for (order, times) in [("in order", &ordered), ("at random", &random)] {
        let mut pose = vec![Quat::IDENTITY; joints];
        table.reference(format!("array and nlerp, {order}"), amount, move || {
            for &time in black_box(times) {
                dense.sample_into(time, &mut pose, nlerp_f32);
                black_box(pose.as_ptr());
            }
        });
        let mut pose = vec![Quat::IDENTITY; joints];
        table.job(format!("array and slerp, {order}"), amount, move || {
            for &time in black_box(times) {
                dense.sample_into(time, &mut pose, slerp_f32);
                black_box(pose.as_ptr());
            }
        });
        let mut pose = LocalPose::rest(animation.skeleton());
        table.job(format!("PoseSampler, {order}"), amount, move || {
            for &time in black_box(times) {
                sampler.sample_into(time, &mut pose);
                black_box(pose.rotations.as_ptr());
            }
        });
        let mut pose = LocalPose::rest(animation.skeleton());
        table.job(
            format!("tracks one by one, f64, {order}"),
            amount,
            move || {
                for &time in black_box(times) {
                    animation.sample_into(time, &mut pose);
                    black_box(pose.rotations.as_ptr());
                }
            },
        );
    }
    table.measure(time_asked());
}

/// The sample walk with every joint keyed, the joints' keys at frames of their own.
fn walk(gap_frames: usize, way: Interpolation) -> Animation {
    let motion = sample::by_name("walk").expect("a sample");
    let last = motion.frame_count() - 1;
    let mut animation = Animation::new(motion.skeleton().clone());
    for (number, &joint) in motion.rotated_joints().iter().enumerate() {
        let offset = 1 + number * 7 % gap_frames;
        let inner = (offset..last).step_by(gap_frames);
        let frames = [0].into_iter().chain(inner).chain([last]);
        let keys = frames.map(|frame| {
            let value: DQuat = motion.rotation(frame, joint).as_dquat().normalize();
            Keyframe::new(frame as f64 / FRAMES_PER_SEC, value, way)
        });
        let track = Track::new(keys.collect(), Extrapolation::Hold).expect("keys of a track");
        animation = animation.with_rotation(joint, Some(track));
    }
    animation
}

/// The same poses at every frame.
struct Dense {
    joints: usize,
    rotations: Vec<Quat>,
}

impl Dense {
    fn new(animation: &Animation) -> Self {
        let joints: Vec<JointId> = animation.rotations().map(|(joint, _)| joint).collect();
        let [start, end] = animation.range_secs().expect("keys");
        let frames = ((end - start) * FRAMES_PER_SEC).round() as usize + 1;
        let poses =
            (0..frames).map(|frame| animation.sample(start + frame as f64 / FRAMES_PER_SEC));
        Self {
            joints: joints.len(),
            rotations: poses
                .flat_map(|pose| {
                    joints
                        .iter()
                        .map(move |joint| pose.rotations[joint.index()])
                        .collect::<Vec<_>>()
                })
                .collect(),
        }
    }

    fn sample_into(&self, time: f64, pose: &mut [Quat], between: impl Fn(Quat, Quat, f32) -> Quat) {
        let place = time * FRAMES_PER_SEC;
        let frame = (place as usize).min(self.rotations.len() / self.joints - 2);
        let t = (place - frame as f64) as f32;
        let (from, rest) = self.rotations[frame * self.joints..].split_at(self.joints);
        for ((rotation, &from), &to) in pose.iter_mut().zip(from).zip(rest) {
            *rotation = between(from, to, t);
        }
    }
}
