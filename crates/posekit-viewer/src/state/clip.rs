//! A clip: one opened motion with everything that is derived from it once.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use posekit::check::{CheckConfig, Finding, check_channels, check_motion};
use posekit::figure::{UpAxis, take_up};
use posekit::motion::{FrameTime, GlobalMotion, Motion, PositionPolicies};
use posekit::pose::{GlobalPose, LocalPose, forward_kinematics};
use posekit::rotation::EulerOrder;
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::bvh::{self, Bvh, MotionError};
use posekit_formats::report::{Import, ImportReport};

/// Where a clip came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A file on this machine; it can be read again.
    File(PathBuf),
    /// Bytes that came without a place: dropped on a page, or fetched.
    Bytes,
    /// Made by posekit itself, under the name that scenes have for it after `sample:`.
    Sample(String),
    /// Made in memory.
    Made,
    /// A scene, and where its file is, if it has one.
    Scene(Option<PathBuf>),
}

/// What a file does not say about itself: how its numbers are to be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// What position channels do with OFFSETs.
    pub positions: PositionPolicies,
    /// The axis that points up in the file; the motion is stood on Y.
    pub up: UpAxis,
}

/// What the user said of all files that are opened, in place of what is seen in them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadingSaid {
    /// What position channels do with OFFSETs.
    pub positions: Option<PositionPolicies>,
    /// The axis that points up.
    pub up: Option<UpAxis>,
}

impl ReadingSaid {
    /// A clip of a file, read as was said. Other clips, and those that cannot be read so, stay.
    #[must_use]
    pub fn apply(self, clip: Clip) -> Clip {
        let reading = Reading {
            positions: self.positions.unwrap_or(clip.reading.positions),
            up: self.up.unwrap_or(clip.reading.up),
        };
        let is_file = matches!(clip.source, Source::File(_) | Source::Bytes);
        if !is_file || reading == clip.reading {
            return clip;
        }
        clip.read_as(reading).unwrap_or(clip)
    }
}

impl Reading {
    /// As files are read when nobody says otherwise: positions are places, and up is the axis that the rest
    /// pose says, where that is clear.
    #[must_use]
    pub fn seen_in(motion: &Motion) -> Self {
        Self {
            positions: PositionPolicies::default(),
            up: take_up(motion, None).up,
        }
    }

    /// The motion of a document, stood on Y.
    ///
    /// # Errors
    /// If the document makes no skeleton or no motion.
    pub fn motion_of(self, document: &Bvh) -> Result<Motion, MotionError> {
        Ok(self.up.stand(document.to_motion(self.positions)?))
    }
}

/// One opened motion.
#[derive(Clone, Debug)]
pub struct Clip {
    /// The name shown: the file's, without its folder.
    pub name: String,
    /// Where it came from.
    pub source: Source,
    /// The document, as the file has it, or as a file of the sample would.
    pub document: Arc<Bvh>,
    /// The bytes of its file, as they were read; none where there is no such file, or too large a one.
    pub text: Option<Arc<Vec<u8>>>,
    /// What the reader noticed and repaired.
    pub report: ImportReport,
    /// How its numbers are read.
    pub reading: Reading,
    /// The motion, stood on Y.
    pub motion: Arc<Motion>,
    /// Its forward kinematics.
    pub global: Arc<GlobalMotion>,
    /// What the checks found; empty until [`check`] was run.
    pub findings: Vec<Finding>,
}

impl Clip {
    /// A clip of a BVH document.
    ///
    /// # Errors
    /// If the document makes no skeleton or no motion.
    pub fn from_bvh(
        name: impl Into<String>,
        source: Source,
        import: Import<Bvh>,
    ) -> Result<Self, MotionError> {
        let motion = import.document.to_motion(PositionPolicies::default())?;
        let reading = Reading::seen_in(&motion);
        let motion = reading.up.stand(motion);
        let clip = Self::new(name.into(), source, import.document, import.report, motion);
        Ok(Self { reading, ..clip })
    }

    /// The same clip, its numbers read in another way. Edits stay; findings are to be looked for anew.
    ///
    /// # Errors
    /// If the document makes no skeleton or no motion.
    pub fn read_as(&self, reading: Reading) -> Result<Self, MotionError> {
        let motion = reading.motion_of(&self.document)?;
        Ok(Self {
            reading,
            global: Arc::new(motion.to_global()),
            motion: Arc::new(motion),
            findings: Vec::new(),
            ..self.clone()
        })
    }

    /// The order of a joint's angles in the file; `None` where its channels cannot say every orientation.
    #[must_use]
    pub fn rotation_order(&self, joint: JointId) -> Option<EulerOrder> {
        let axes = self.rotation_axes(joint)?;
        EulerOrder::new(&axes)
            .ok()
            .filter(|order| order.is_complete())
    }

    /// The order of each joint's angles in the file, by unique names.
    #[must_use]
    pub fn orders(&self) -> BTreeMap<String, EulerOrder> {
        let skeleton = self.skeleton();
        let told = skeleton
            .joints()
            .filter(|joint| joint.index() < self.document.joints.len());
        let named = told.filter_map(|joint| {
            let order = self.rotation_order(joint)?;
            Some((skeleton.unique_name(joint).to_owned(), order))
        });
        named.collect()
    }

    /// A clip of a motion that no file holds.
    #[must_use]
    pub fn from_motion(name: impl Into<String>, motion: Motion) -> Self {
        let document = Bvh::from_motion(&motion, EulerOrder::ZXY);
        Self::new(
            name.into(),
            Source::Made,
            document,
            ImportReport::default(),
            motion,
        )
    }

    /// A clip of our own, by its name; `None` where there is no such sample.
    #[must_use]
    pub fn of_sample(name: impl Into<String>, sample: &str) -> Option<Self> {
        let motion = posekit::sample::by_name(sample)?;
        let clip = Self::from_motion(name, motion);
        Some(Self {
            source: Source::Sample(sample.to_owned()),
            text: Some(Arc::new(bvh::write(&clip.document))),
            ..clip
        })
    }

    /// Gives it another motion, which a document follows from: angles in the order of each joint.
    pub fn set_motion(&mut self, motion: Arc<Motion>, order_of: impl Fn(JointId) -> EulerOrder) {
        self.document = Arc::new(Bvh::from_motion_with(&motion, order_of));
        self.global = Arc::new(motion.to_global());
        self.motion = motion;
        self.reading = Reading::default();
        self.text = None;
        // What was wrong with its own text is gone with it; the files that a scene names are as they were.
        self.report
            .warnings
            .retain(|warning| warning.file.is_some());
    }

    fn new(
        name: String,
        source: Source,
        document: Bvh,
        report: ImportReport,
        motion: Motion,
    ) -> Self {
        let global = motion.to_global();
        Self {
            name,
            source,
            document: Arc::new(document),
            text: None,
            report,
            reading: Reading::default(),
            motion: Arc::new(motion),
            global: Arc::new(global),
            findings: Vec::new(),
        }
    }

    /// The skeleton that moves.
    #[must_use]
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        self.motion.skeleton()
    }

    /// How many frames there are; it may be 0.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.motion.frame_count()
    }

    /// Frames a second; 0 where the file's frame time is not positive.
    #[must_use]
    pub fn fps(&self) -> f64 {
        self.motion.frame_time().frames_per_sec().unwrap_or(0.0)
    }

    /// The local pose at a time.
    #[must_use]
    pub fn local_pose(&self, time_secs: f64) -> LocalPose {
        self.motion.sample(time_secs)
    }

    /// The global pose at a time.
    #[must_use]
    pub fn global_pose(&self, time_secs: f64) -> GlobalPose {
        let mut global = GlobalPose::default();
        forward_kinematics(self.skeleton(), &self.local_pose(time_secs), &mut global);
        global
    }

    /// The nearest frame to a time.
    #[must_use]
    pub fn frame_at(&self, time_secs: f64) -> usize {
        let last = self.frame_count().saturating_sub(1);
        let frame_time = self.motion.frame_time_secs();
        if frame_time <= 0.0 || !time_secs.is_finite() {
            return 0;
        }
        nearest_index(time_secs / frame_time, last)
    }

    /// The rotation order that a joint's channels have in the file, as axes; `None` where it has no
    /// rotation channels.
    #[must_use]
    pub fn rotation_axes(&self, joint: JointId) -> Option<Vec<posekit::rotation::Axis>> {
        use posekit::motion::Channel;
        let axes: Vec<_> = self.document.joints[joint.index()]
            .channels
            .iter()
            .filter_map(|channel| match channel {
                Channel::Rotation(axis) => Some(*axis),
                Channel::Position(_) => None,
            })
            .collect();
        (!axes.is_empty()).then_some(axes)
    }
}

/// A motion of one frame: the rest pose, with the roots where they are in `motion` at a time, so that
/// it stays in the picture, and from there by `place`.
#[must_use]
pub fn rest_motion(motion: &Motion, time_secs: f64, place: Vec3) -> Motion {
    let skeleton = motion.skeleton();
    let mut rest = LocalPose::rest(skeleton);
    let here = motion.sample(time_secs);
    for root in skeleton.roots() {
        rest.translations[root.index()] = here.translations[root.index()] + place;
    }
    still(skeleton, &rest)
}

/// A motion of one frame: a pose.
///
/// # Panics
/// If the pose has not as many joints as the skeleton.
#[must_use]
pub fn still(skeleton: &Arc<Skeleton>, pose: &LocalPose) -> Motion {
    let roots: Vec<_> = skeleton.roots().collect();
    let pose = pose.clone();
    Motion::from_poses(Arc::clone(skeleton), FrameTime::of_fps(30), roots, &[pose])
}

/// Everything suspicious in a clip.
#[must_use]
pub fn check(clip: &Clip) -> Vec<Finding> {
    let config = CheckConfig::default();
    let relative = clip
        .document
        .relative_positions(&clip.motion, clip.reading.positions);
    let meant = relative.as_ref().and_then(|relative| {
        let reading = Reading {
            positions: relative.policies,
            ..clip.reading
        };
        reading.motion_of(&clip.document).ok()
    });
    let mut findings = match &meant {
        Some(motion) => check_motion(motion, &motion.to_global(), &config),
        None => check_motion(&clip.motion, &clip.global, &config),
    };
    findings.extend(relative.map(|relative| relative.finding));
    if let Some(motion) = &clip.document.motion {
        let layout = clip.document.channel_layout();
        findings.extend(check_channels(
            clip.skeleton(),
            &layout,
            &motion.values,
            &config,
        ));
        posekit::check::sort_findings(&mut findings);
    }
    findings
}

/// A frame number as a factor of time.
#[must_use]
#[expect(
    clippy::cast_precision_loss,
    reason = "frame numbers stay far below 2^53"
)]
pub fn index_to_f64(index: usize) -> f64 {
    index as f64
}

/// The whole number nearest to a place, not above `last`.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast from float to integer saturates, and negative places become 0"
)]
pub fn nearest_index(place: f64, last: usize) -> usize {
    (place.round() as usize).min(last)
}
