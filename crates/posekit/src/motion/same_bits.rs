//! Proof that the batch paths give the same bits on registers of every width, and the bits of
//! forward kinematics of one pose, which uses none of their code and runs on every machine.

use std::path::Path;
use std::sync::Arc;

use glam::{EulerRot, Quat, Vec3};

use super::{
    Channel, ChannelLayout, FrameTime, GlobalMotion, Motion, PositionPolicies, PositionPolicy,
};
use crate::lanes::{Lanes, run_portable};
use crate::pose::{GlobalPose, forward_kinematics};
use crate::rotation::Axis;
use crate::skeleton::{JointId, Skeleton, SkeletonBuilder};

/// A channel table, and rows for it.
struct Clip {
    skeleton: Arc<Skeleton>,
    layout: ChannelLayout,
    rows: Vec<f64>,
}

fn motions(clip: &Clip, policy: PositionPolicies) -> [Motion; 2] {
    let skeleton = || Arc::clone(&clip.skeleton);
    let widest = Motion::from_channel_rows(
        skeleton(),
        FrameTime::of_fps(100),
        &clip.layout,
        &clip.rows,
        policy,
    )
    .expect("values in range");
    let mut portable = Motion::at_rest(skeleton(), 0, FrameTime::NONE, []);
    portable.set_channel_rows_by(
        FrameTime::of_fps(100),
        &clip.layout,
        &clip.rows,
        policy,
        |kernel| {
            run_portable(kernel);
        },
    );
    [widest, portable]
}

fn bits<'a>(lanes: impl Iterator<Item = &'a Lanes>) -> Vec<u32> {
    lanes.flat_map(|lanes| lanes.0.map(f32::to_bits)).collect()
}

fn motion_bits(motion: &Motion) -> [Vec<u32>; 2] {
    [
        bits(
            motion
                .rotations
                .iter()
                .flat_map(|q| [&q.x, &q.y, &q.z, &q.w]),
        ),
        bits(motion.translations.iter().flat_map(|v| [&v.x, &v.y, &v.z])),
    ]
}

fn assert_same_bits(clip: &Clip, what: &str) {
    let add_at_root = PositionPolicies {
        root: PositionPolicy::Add,
        ..PositionPolicies::default()
    };
    let ignore = PositionPolicy::Ignore.into();
    for policy in [PositionPolicy::Replace.into(), add_at_root, ignore] {
        let [widest, portable] = motions(clip, policy);
        assert_eq!(motion_bits(&widest), motion_bits(&portable), "{what}: rows");
        assert_same_global_bits(&widest, what);
    }
}

fn assert_same_global_bits(motion: &Motion, what: &str) {
    let widest = motion.to_global();
    let mut portable =
        Motion::at_rest(Arc::clone(motion.skeleton()), 3, FrameTime::NONE, []).to_global();
    portable.update_by(motion, |kernel| run_portable(kernel));
    assert_eq!(portable.frame_count(), motion.frame_count());
    let mut one_pose = GlobalPose::default();
    for frame in 0..motion.frame_count() {
        let pose = widest.pose(frame);
        assert_eq!(
            pose_bits(&pose),
            pose_bits(&portable.pose(frame)),
            "{what}: {frame}"
        );
        forward_kinematics(motion.skeleton(), &motion.pose(frame), &mut one_pose);
        // Zeros may differ in sign.
        assert_eq!(pose, one_pose, "{what}: one pose, {frame}");
    }
}

fn pose_bits(pose: &GlobalPose) -> Vec<u32> {
    let positions = pose.positions.iter().flat_map(|p| p.to_array());
    let orientations = pose.orientations.iter().flat_map(|q| q.to_array());
    positions.chain(orientations).map(f32::to_bits).collect()
}

/// Numbers from -1 to 1, the same in every run.
struct Numbers(u32);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 8) / f64::from(1 << 23) - 1.0
    }

    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as usize % bound
    }

    fn vec3(&mut self) -> Vec3 {
        glam::DVec3::new(self.next(), self.next(), self.next()).as_vec3() * 30.0
    }

    fn quat(&mut self) -> Quat {
        let [x, y, z] = self.vec3().to_array();
        Quat::from_euler(EulerRot::XYZ, x, y, z)
    }
}

/// A forest of joints with any rest transforms, and channels of any kinds in any order.
fn random_clip(numbers: &mut Numbers) -> Clip {
    let mut builder = SkeletonBuilder::new();
    let mut joints: Vec<JointId> = Vec::new();
    for index in 0..1 + numbers.below(12) {
        let parent = joints
            .get(numbers.below(joints.len() + 1))
            .copied()
            .or_else(|| joints.last().copied().filter(|_| index % 7 != 0));
        let (offset, rotation) = (numbers.vec3(), numbers.quat());
        let name = index.to_string();
        joints.push(match (numbers.below(5), parent) {
            (0, _) => builder.oriented_joint(name, parent, offset, rotation),
            (1, _) => builder.joint(name, parent, Vec3::ZERO),
            _ => builder.joint(name, parent, offset),
        });
    }
    let skeleton = Arc::new(builder.build().expect("a valid skeleton"));
    let mut columns = Vec::new();
    for &joint in &joints {
        for _ in 0..numbers.below(7) {
            let axis = Axis::ALL[numbers.below(3)];
            columns.push(match numbers.below(3) {
                0 => (joint, Channel::Position(axis)),
                _ => (joint, Channel::Rotation(axis)),
            });
        }
    }
    let frames = numbers.below(20);
    let rows = (0..columns.len() * frames).map(|_| numbers.next() * 1000.0);
    Clip {
        rows: rows.collect(),
        skeleton,
        layout: ChannelLayout::new(columns),
    }
}

#[test]
fn random_motions_have_the_same_bits_on_every_path() {
    let mut numbers = Numbers(7);
    for round in 0..500 {
        assert_same_bits(&random_clip(&mut numbers), &format!("round {round}"));
    }
}

#[test]
fn all_sequences_of_axes_have_the_same_bits_on_every_path() {
    let mut builder = SkeletonBuilder::new();
    let joint = builder.joint("joint", None, Vec3::ONE);
    let skeleton = Arc::new(builder.build().expect("a valid skeleton"));
    let mut numbers = Numbers(8);
    for sequence in 0..3_usize.pow(4) {
        for length in 1..=4 {
            let axes = (0..length).map(|i| Axis::ALL[sequence / 3_usize.pow(i) % 3]);
            let layout = ChannelLayout::new(axes.map(|axis| (joint, Channel::Rotation(axis))));
            let rows = (0..layout.column_count() * 11).map(|_| numbers.next() * 800.0);
            let clip = Clip {
                rows: rows.collect(),
                skeleton: Arc::clone(&skeleton),
                layout,
            };
            assert_same_bits(&clip, &format!("{:?}", clip.layout));
        }
    }
}

/// The names of the real files: more may be put beside them.
const REAL_FILES: &str = include_str!("../../../posekit-formats/tests/real_files.txt");

#[test]
fn real_rows_have_the_same_bits_on_every_path() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !folder.is_dir() {
        eprintln!("skipped: {} is missing", folder.display());
        return;
    }
    let files = REAL_FILES.lines().map(|name| folder.join(name));
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a readable file");
        let clip = clip_of_plain_bvh(&text);
        assert!(!clip.rows.is_empty());
        assert_same_bits(&clip, &file.display().to_string());
    }
}

/// Reads a tidy BVH file: the library has no reader, and this needs no other.
fn clip_of_plain_bvh(text: &str) -> Clip {
    let (head, body) = text.split_once("MOTION").expect("a motion");
    let mut builder = SkeletonBuilder::new();
    let (mut open, mut columns) = (Vec::new(), Vec::new());
    let mut named = None;
    let mut words = head.split_whitespace();
    while let Some(word) = words.next() {
        match word {
            "ROOT" | "JOINT" | "End" => named = words.next().map(|name| (word == "End", name)),
            "OFFSET" => {
                let mut coordinate =
                    || words.next().and_then(|w| w.parse().ok()).expect("a number");
                let offset = Vec3::new(coordinate(), coordinate(), coordinate());
                let (is_end, name) = named.take().expect("a joint");
                let parent = open.last().copied();
                open.push(match parent {
                    Some(parent) if is_end => builder.end_site(name, parent, offset),
                    _ => builder.joint(name, parent, offset),
                });
            }
            "}" => drop(open.pop()),
            channel => columns.extend(channel_of(channel).zip(open.last().copied())),
        }
    }
    let rows = body.split_once("Frame Time:").expect("a frame time").1;
    let numbers = rows.split_whitespace().skip(1);
    Clip {
        skeleton: Arc::new(builder.build().expect("a valid skeleton")),
        layout: ChannelLayout::new(columns.into_iter().map(|(channel, joint)| (joint, channel))),
        rows: numbers
            .map(|word| word.parse().expect("a number"))
            .collect(),
    }
}

fn channel_of(word: &str) -> Option<Channel> {
    let axis = Axis::ALL
        .into_iter()
        .find(|axis| word.starts_with(axis.letter()))?;
    match &word[1..] {
        "position" => Some(Channel::Position(axis)),
        "rotation" => Some(Channel::Rotation(axis)),
        _ => None,
    }
}

#[test]
fn refilled_motions_are_what_new_ones_are() {
    let mut numbers = Numbers(9);
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("root", None, Vec3::ONE);
    let child = builder.joint("child", Some(root), Vec3::X);
    let skeleton = Arc::new(builder.build().expect("a valid skeleton"));
    let rotations = [Axis::Z, Axis::X].map(Channel::Rotation);
    let positions = [Axis::Y].map(Channel::Position);
    let both = rotations.into_iter().chain(positions);
    let mut motion = Motion::at_rest(Arc::clone(&skeleton), 40, FrameTime::of_fps(1), [child]);
    let mut global: Option<GlobalMotion> = None;
    for (round, frames) in [30, 3, 0, 17, 64, 64, 9].into_iter().enumerate() {
        let joint = [root, child][round % 2];
        let layout = ChannelLayout::new(both.clone().map(|channel| (joint, channel)));
        let rows: Vec<f64> = (0..3 * frames).map(|_| numbers.next() * 90.0).collect();
        let policy = PositionPolicies::default();
        motion
            .set_channel_rows(FrameTime::of_fps(2), &layout, &rows, policy)
            .expect("values in range");
        let new = Motion::from_channel_rows(
            Arc::clone(&skeleton),
            FrameTime::of_fps(2),
            &layout,
            &rows,
            policy,
        )
        .expect("values in range");
        assert_eq!(motion.frame_count(), frames);
        assert_eq!(motion.translated_joints(), [joint]);
        assert_eq!(motion_bits(&motion), motion_bits(&new), "round {round}");
        let global = global.get_or_insert_with(|| motion.to_global());
        global.update(&motion);
        assert_eq!(global.frame_count(), frames);
        for frame in 0..frames {
            assert_eq!(global.pose(frame), new.to_global().pose(frame));
        }
    }
}
