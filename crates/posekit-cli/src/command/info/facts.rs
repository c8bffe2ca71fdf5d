//! The facts about a file, before anybody words them.

use std::sync::Arc;

use posekit::body::{Anatomy, NoAnatomy};
use posekit::check::RelativePositions;
use posekit::figure::{LengthUnit, RestPose, UpAxis, UpGuess, guess_unit, guess_up};
use posekit::motion::{Channel, FrameTime, Motion, PositionPolicies};
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::bvh::{Bvh, BvhJoint, EndName};

use crate::failure::Failure;
use crate::load::Loaded;

/// A list of channels and the joints that have it.
#[derive(Debug)]
pub(super) struct ChannelGroup {
    /// The channels in the file's order.
    pub(super) channels: Vec<Channel>,
    /// The joints' indices.
    pub(super) joints: Vec<usize>,
}

/// What is known of a file.
#[derive(Debug)]
pub(super) struct Facts {
    /// All joints, End Sites included.
    pub(super) joint_count: usize,
    /// The End Sites among them.
    pub(super) end_site_count: usize,
    /// The unique names of those that have one of their own in the file.
    pub(super) end_site_names: Vec<String>,
    /// Levels of the hierarchy.
    pub(super) level_count: usize,
    /// Names of the roots.
    pub(super) roots: Vec<String>,
    /// Whether there is a MOTION section.
    pub(super) has_motion: bool,
    /// Frames.
    pub(super) frame_count: usize,
    /// What the file says.
    pub(super) frame_time_secs: f64,
    /// Values in a frame.
    pub(super) channel_count: usize,
    /// The channel lists that occur, by their first joint.
    pub(super) channel_groups: Vec<ChannelGroup>,
    /// What position channels mean where they are not positions; the height in motion is of the figure that they
    /// make then.
    pub(super) relative_positions: Option<RelativePositions>,
    /// The rest pose's height; see [`Skeleton::height`].
    pub(super) rest_height: f64,
    /// The middle one of the vertical extents over the frames.
    pub(super) motion_height: Option<f64>,
    /// The unit in which that height is a person's.
    pub(super) unit: Option<LengthUnit>,
    /// The axis along which the figure stands.
    pub(super) up: Option<UpGuess>,
    /// What the rest pose looks like.
    pub(super) rest_pose: RestPose,
    /// Which joints are a person's landmarks, or why that is not known.
    pub(super) anatomy: Result<Anatomy, NoAnatomy>,
    /// Left and right joints that mirror each other, by unique name.
    pub(super) pairs: Vec<(String, String)>,
    /// The skeleton, for the tree.
    pub(super) skeleton: Arc<Skeleton>,
}

impl Facts {
    /// Finds them.
    pub(super) fn of(loaded: &Loaded, policies: PositionPolicies) -> Result<Self, Failure> {
        let bvh = &loaded.bvh;
        let mut motion = loaded.motion(policies)?;
        let relative_positions = bvh.relative_positions(&motion, policies);
        if let Some(relative) = &relative_positions {
            motion = loaded.motion(relative.policies)?;
        }
        // The same one: what it knows of its left and right is not looked for again.
        let skeleton = Arc::clone(motion.skeleton());
        let up = guess_up(&motion);
        let motion_height = middle_height(&motion, up.map_or(UpAxis::Y, |guess| guess.up));
        let rest_height = f64::from(skeleton.height());
        let name = |joint: JointId| skeleton.unique_name(joint).to_owned();
        let pairs = skeleton.symmetric_pairs();
        Ok(Self {
            joint_count: skeleton.joint_count(),
            end_site_count: skeleton
                .joints()
                .filter(|&joint| skeleton.is_end_site(joint))
                .count(),
            end_site_names: skeleton
                .joints()
                .filter(|&joint| has_own_end_name(&bvh.joints[joint.index()]))
                .map(name)
                .collect(),
            level_count: level_count(&skeleton),
            roots: skeleton.roots().map(name).collect(),
            has_motion: bvh.motion.is_some(),
            frame_count: bvh.frame_count(),
            frame_time_secs: bvh
                .motion
                .as_ref()
                .map_or(0.0, |motion| motion.frame_time_secs),
            channel_count: bvh.channel_count(),
            channel_groups: channel_groups(bvh),
            relative_positions,
            rest_height,
            motion_height,
            unit: guess_unit(motion_height.unwrap_or(rest_height)),
            up,
            rest_pose: RestPose::of(&skeleton),
            anatomy: Anatomy::of_motion(&motion),
            pairs: pairs
                .iter()
                .map(|pair| (name(pair.left), name(pair.right)))
                .collect(),
            skeleton,
        })
    }

    /// Frames a second, where the file's frame time gives them.
    pub(super) fn fps(&self) -> Option<f64> {
        self.frame_time().frames_per_sec()
    }

    fn frame_time(&self) -> FrameTime {
        FrameTime::or_none(self.frame_time_secs)
    }

    /// From the first frame to the last, in seconds.
    pub(super) fn duration_secs(&self) -> f64 {
        let intervals = u32::try_from(self.frame_count.saturating_sub(1)).unwrap_or(u32::MAX);
        f64::from(intervals) * self.frame_time().secs()
    }
}

/// Whether a joint is an End Site with a name in the file.
pub(super) fn has_own_end_name(joint: &BvhJoint) -> bool {
    joint.is_end_site && joint.end_name != EndName::Implied
}

fn level_count(skeleton: &Skeleton) -> usize {
    let mut levels: Vec<usize> = Vec::with_capacity(skeleton.joint_count());
    for parent in skeleton.parents() {
        levels.push(parent.map_or(1, |parent| levels[parent.index()] + 1));
    }
    levels.into_iter().max().unwrap_or(0)
}

fn channel_groups(bvh: &Bvh) -> Vec<ChannelGroup> {
    let mut groups: Vec<ChannelGroup> = Vec::new();
    for (index, joint) in bvh
        .joints
        .iter()
        .enumerate()
        .filter(|(_, joint)| !joint.is_end_site)
    {
        match groups
            .iter_mut()
            .find(|group| group.channels == joint.channels)
        {
            Some(group) => group.joints.push(index),
            None => groups.push(ChannelGroup {
                channels: joint.channels.clone(),
                joints: vec![index],
            }),
        }
    }
    groups
}

fn middle_height(motion: &Motion, up: UpAxis) -> Option<f64> {
    let extent = posekit::figure::body_extent(motion)?;
    Some(f64::from(extent[up.axis().index()]))
}
