//! Forward kinematics: nanoseconds a joint-frame, and ratios to a plain implementation of the same
//! thing measured in the same run.
//!
//! `cargo bench -p posekit --bench forward_kinematics [SECONDS]`

#[path = "../../../benches/harness.rs"]
mod harness;

use std::hint::black_box;
use std::sync::Arc;

use glam::{Mat4, Vec3};
use harness::{Table, Unit, time_asked};
use posekit::motion::{Channel, ChannelLayout, FrameTime, Motion, PositionPolicy};
use posekit::pose::{GlobalPose, LocalPose, forward_kinematics};
use posekit::rotation::Axis;
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};

const FRAMES: usize = 2048;

/// Times between frames at which a motion is sampled, in frames.
const SAMPLE_STEP: f64 = 0.83;

fn main() {
    let skeleton = Arc::new(humanoid());
    let layout = layout(&skeleton);
    let rows = rows(layout.column_count());
    let motion = from_rows(&skeleton, &layout, &rows);
    let moving = motion.rotated_joints().len();
    let joints = skeleton.joint_count();
    let joint_frames = joints * FRAMES;
    let poses: Vec<LocalPose> = (0..FRAMES).map(|frame| motion.pose(frame)).collect();
    let mut pose_global = GlobalPose::default();
    let mut global = motion.to_global();
    let mut refilled = motion.clone();
    let (mut streamed, mut streamed_global) = (motion.clone(), motion.to_global());
    let mut sampled = motion.pose(0);
    let mut between = motion.pose(0);

    let title = format!("{joints} joints ({moving} of them turn), {FRAMES} frames");
    let mut table = Table::new(title, Unit::NanosecondsPer("joint"));
    table.reference("4x4 matrices, pose after pose", joint_frames, || {
        matrices(&skeleton, &poses);
    });
    table.job("one pose at a time", joint_frames, || {
        for pose in poses.iter().take(8).cycle().take(FRAMES) {
            forward_kinematics(&skeleton, black_box(pose), &mut pose_global);
            black_box(&pose_global);
        }
    });
    table.job("whole motion from local rotations", joint_frames, || {
        global.update(black_box(&motion));
        black_box(&global);
    });
    table.job("  into fresh memory", joint_frames, || {
        black_box(black_box(&motion).to_global());
    });
    table.job(
        "Euler channel rows to local rotations",
        joint_frames,
        || {
            refill(&mut refilled, &layout, black_box(&rows));
            black_box(&refilled);
        },
    );
    table.job("  into fresh memory", joint_frames, || {
        black_box(from_rows(&skeleton, &layout, black_box(&rows)));
    });
    table.job(
        "Euler channel rows to global transforms",
        joint_frames,
        || {
            refill(&mut streamed, &layout, black_box(&rows));
            streamed_global.update(&streamed);
            black_box(&streamed_global);
        },
    );
    table.job("  into fresh memory", joint_frames, || {
        black_box(from_rows(&skeleton, &layout, black_box(&rows)).to_global());
    });
    table.job("a pose between two frames", joint_frames, || {
        for frame in 0..FRAMES {
            let place = frame as f64 * SAMPLE_STEP;
            motion.sample_into(place * motion.frame_time_secs(), &mut sampled);
            black_box(&sampled);
        }
    });
    table.job("a pose between two poses", joint_frames, || {
        for pair in poses.windows(2) {
            between.set_interpolated(&pair[0], &pair[1], black_box(0.3));
            black_box(&between);
        }
    });
    table.measure(time_asked());
}

fn refill(motion: &mut Motion, layout: &ChannelLayout, rows: &[f64]) {
    motion
        .set_channel_rows(FrameTime::of_fps(60), layout, rows, PositionPolicy::Replace)
        .expect("values in range");
}

fn from_rows(skeleton: &Arc<Skeleton>, layout: &ChannelLayout, rows: &[f64]) -> Motion {
    let skeleton = Arc::clone(skeleton);
    Motion::from_channel_rows(
        skeleton,
        FrameTime::of_fps(60),
        layout,
        rows,
        PositionPolicy::Replace,
    )
    .expect("values in range")
}

fn matrices(skeleton: &Skeleton, poses: &[LocalPose]) {
    let mut world = vec![Mat4::IDENTITY; skeleton.joint_count()];
    for pose in poses {
        for (index, parent) in skeleton.parents().iter().enumerate() {
            let local =
                Mat4::from_rotation_translation(pose.rotations[index], pose.translations[index]);
            world[index] = parent.map_or(local, |parent| world[parent.index()] * local);
        }
        black_box(&world);
    }
}

/// A figure with as many joints as the course's: five limbs on a root, an End Site on each.
fn humanoid() -> Skeleton {
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("root", None, Vec3::new(0.0, 0.9, 0.0));
    for (limb, length) in [4, 4, 4, 4, 3].into_iter().enumerate() {
        let mut parent = root;
        for link in 0..length {
            parent = builder.joint(
                format!("{limb}.{link}"),
                Some(parent),
                Vec3::new(0.1, 0.2, 0.05),
            );
        }
        builder.end_site(format!("{limb}.end"), parent, Vec3::new(0.0, 0.1, 0.0));
    }
    builder.build().expect("a valid skeleton")
}

fn layout(skeleton: &Skeleton) -> ChannelLayout {
    let root = JointId::new(0);
    let positions = Axis::ALL.map(|axis| (root, Channel::Position(axis)));
    let moving = skeleton
        .joints()
        .filter(|&joint| !skeleton.is_end_site(joint));
    let rotations = moving
        .flat_map(|joint| [Axis::Z, Axis::X, Axis::Y].map(|axis| (joint, Channel::Rotation(axis))));
    ChannelLayout::new(positions.into_iter().chain(rotations))
}

/// Channels as motion has them: slow waves of unrelated phases, a few degrees a frame at most, with
/// the rows of no two frames alike.
fn rows(columns: usize) -> Vec<f64> {
    let value = |(frame, column): (usize, usize)| {
        let phase = (column * 7919 % 360) as f64;
        let turns_a_frame = 0.5 + (column * 31 % 17) as f64 / 8.0;
        60.0 * (phase + turns_a_frame * frame as f64).to_radians().sin() + phase * 0.2
    };
    (0..FRAMES)
        .flat_map(|frame| (0..columns).map(move |column| (frame, column)))
        .map(value)
        .collect()
}
