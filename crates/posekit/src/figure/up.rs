//! Which way is up: what a figure's rest pose and motion say about the axis that its file stands on.
//!
//! A rest pose on straight legs points up from the feet to where the arms part. A motion may not: a
//! crawl is no climb. So the rest pose is asked first, and the motion only says how sure the answer is: a
//! figure that stands along the same axis all the time confirms it, one that stands along another
//! contradicts it, as a lying figure does, or one whose root joint turns the whole rest pose. Without
//! a rest pose that stands, the motion alone gives a guess. Without pairs of arms and legs the height of the
//! figure does, first at rest, then in motion.

use std::fmt;
use std::str::FromStr;

use glam::{Quat, Vec3};

use super::rest_pose::{LimbPair, RestPose, RestPoseKind, legs_and_arms};
use super::{body_extent, frames_looked_at};
use crate::motion::Motion;
use crate::pose::{GlobalPose, forward_kinematics};
use crate::rotation::Axis;
use crate::skeleton::{JointId, Skeleton};

/// A figure stands along an axis in a frame when its trunk, from feet to shoulders, is this close to it: the
/// cosine of 37 degrees, which bowing walkers stay within.
const UPRIGHT_COS: f32 = 0.8;

/// A figure stands along an axis when it does so in this share of the frames.
const UPRIGHT_SHARE: f64 = 0.8;

/// How much taller than wide a figure without limbs must be for its up axis to be guessed.
const CLEARLY_TALLER: f32 = 1.15;

/// A direction along a coordinate axis that is up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UpAxis {
    /// The positive X axis.
    X,
    /// The positive Y axis, as in Maya, MotionBuilder, most BVH files and here.
    #[default]
    Y,
    /// The positive Z axis, as in Blender, 3ds Max, MakeHuman and robotics.
    Z,
    /// The negative X axis.
    NegativeX,
    /// The negative Y axis.
    NegativeY,
    /// The negative Z axis.
    NegativeZ,
}

impl UpAxis {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::X,
        Self::Y,
        Self::Z,
        Self::NegativeX,
        Self::NegativeY,
        Self::NegativeZ,
    ];

    /// The direction along an axis.
    pub const fn new(axis: Axis, is_positive: bool) -> Self {
        match (axis, is_positive) {
            (Axis::X, true) => Self::X,
            (Axis::Y, true) => Self::Y,
            (Axis::Z, true) => Self::Z,
            (Axis::X, false) => Self::NegativeX,
            (Axis::Y, false) => Self::NegativeY,
            (Axis::Z, false) => Self::NegativeZ,
        }
    }

    /// The axis, whichever end of it is up.
    pub const fn axis(self) -> Axis {
        match self {
            Self::X | Self::NegativeX => Axis::X,
            Self::Y | Self::NegativeY => Axis::Y,
            Self::Z | Self::NegativeZ => Axis::Z,
        }
    }

    /// Whether the positive end of the axis is up.
    pub const fn is_positive(self) -> bool {
        matches!(self, Self::X | Self::Y | Self::Z)
    }

    /// The unit vector that points up.
    pub fn unit(self) -> Vec3 {
        let unit = self.axis().unit().as_vec3();
        if self.is_positive() { unit } else { -unit }
    }

    /// A motion of a world with this axis up, stood on Y.
    #[must_use]
    pub fn stand(self, motion: Motion) -> Motion {
        match self {
            Self::Y => motion,
            up => motion.turned(up.y_up_from_file()),
        }
    }

    /// The name on the command line: `y`, `-z`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::NegativeX => "-x",
            Self::NegativeY => "-y",
            Self::NegativeZ => "-z",
        }
    }

    /// The turn that stands a world with this axis up on Y: a quarter about the axis that is neither, or a
    /// half about X.
    ///
    /// ```
    /// use glam::Vec3;
    /// use posekit::figure::UpAxis;
    ///
    /// for up in UpAxis::ALL {
    ///     assert!((up.y_up_from_file() * up.unit()).distance(Vec3::Y) < 1e-6);
    /// }
    /// assert!((UpAxis::Z.y_up_from_file() * Vec3::X).distance(Vec3::X) < 1e-6);
    /// ```
    pub fn y_up_from_file(self) -> Quat {
        const HALF: f32 = core::f32::consts::FRAC_1_SQRT_2;
        match self {
            Self::Y => Quat::IDENTITY,
            Self::NegativeY => Quat::from_xyzw(1.0, 0.0, 0.0, 0.0),
            Self::X => Quat::from_xyzw(0.0, 0.0, HALF, HALF),
            Self::NegativeX => Quat::from_xyzw(0.0, 0.0, -HALF, HALF),
            Self::Z => Quat::from_xyzw(-HALF, 0.0, 0.0, HALF),
            Self::NegativeZ => Quat::from_xyzw(HALF, 0.0, 0.0, HALF),
        }
    }
}

/// `Y`, `-Z`.
impl fmt::Display for UpAxis {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.is_positive() { "" } else { "-" };
        write!(out, "{sign}{}", self.axis().letter())
    }
}

/// A text that is no axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("an axis is x, y or z, with - before it where its negative end is up")]
pub struct NotAnAxis;

impl FromStr for UpAxis {
    type Err = NotAnAxis;

    fn from_str(text: &str) -> Result<Self, NotAnAxis> {
        let text = text.strip_prefix('+').unwrap_or(text);
        let named = |up: &Self| up.name().eq_ignore_ascii_case(text);
        Self::ALL.into_iter().find(named).ok_or(NotAnAxis)
    }
}

/// What a guess of the up axis rests on, from the best to the least.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum UpEvidence {
    /// The rest pose stands along it, and so does the motion, where there is one.
    RestPoseAndMotion,
    /// The rest pose stands along it, and the motion along no axis in particular.
    RestPose,
    /// The rest pose stands along it, and the motion along this other axis: either the figure lies or
    /// crawls, or its root turns the rest pose.
    RestPoseAgainstMotion(UpAxis),
    /// The motion stands along it, and the rest pose is no figure that stands.
    Motion,
    /// The figure, which has no limbs to tell, is clearly taller than wide along it.
    Extent,
}

/// A guess of the up axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct UpGuess {
    /// The axis.
    pub up: UpAxis,
    /// What it rests on.
    pub evidence: UpEvidence,
}

impl UpGuess {
    /// Whether the axis is as good as known, so that a picture may be turned by it: the rest pose says it and
    /// the motion does not speak against it.
    pub fn is_known(self) -> bool {
        matches!(
            self.evidence,
            UpEvidence::RestPoseAndMotion | UpEvidence::RestPose
        )
    }
}

/// The axis that is taken as up, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct UpTaken {
    /// The axis.
    pub up: UpAxis,
    /// Whether somebody said so.
    pub is_said: bool,
    /// What the figure makes probable; not asked where somebody said it.
    pub guess: Option<UpGuess>,
}

/// The axis of a motion that is taken as up, by everything that draws or measures: what somebody said, or else
/// the guessed axis where that is [as good as known](UpGuess::is_known), or else Y.
pub fn take_up(motion: &Motion, said: Option<UpAxis>) -> UpTaken {
    if let Some(up) = said {
        return UpTaken {
            up,
            is_said: true,
            guess: None,
        };
    }
    let guess = guess_up(motion);
    let known = guess.filter(|guess| guess.is_known());
    UpTaken {
        up: known.map_or(UpAxis::Y, |guess| guess.up),
        is_said: false,
        guess,
    }
}

/// The axis along which the figure of a motion stands; `None` where nothing tells.
///
/// Cost: forward kinematics of at most 64 frames.
pub fn guess_up(motion: &Motion) -> Option<UpGuess> {
    let skeleton = motion.skeleton();
    let guess = |up, evidence| Some(UpGuess { up, evidence });
    let rest_pose = RestPose::of(skeleton);
    let limbs = legs_and_arms(skeleton, &GlobalPose::rest(skeleton));
    let in_motion = limbs.and_then(|(legs, arms)| upright_in_motion(motion, &legs, &arms));
    let at_rest = match (rest_pose.kind, rest_pose.up) {
        (RestPoseKind::Standing(_), Some((axis, is_positive))) => {
            Some(UpAxis::new(axis, is_positive))
        }
        _ => None,
    };
    // Without arms the legs alone say where up is at rest.
    let at_rest = at_rest.or_else(|| match limbs {
        Some(_) => None,
        None => legs_alone(skeleton),
    });
    match (at_rest, in_motion) {
        (Some(up), Some(same)) if up == same => guess(up, UpEvidence::RestPoseAndMotion),
        (Some(up), None) if motion.frame_count() == 0 => guess(up, UpEvidence::RestPoseAndMotion),
        (Some(up), None) => guess(up, UpEvidence::RestPose),
        (Some(up), Some(other)) => guess(up, UpEvidence::RestPoseAgainstMotion(other)),
        (None, Some(up)) => guess(up, UpEvidence::Motion),
        (None, None) if limbs.is_some() => None,
        (None, None) => {
            let (low, high) = GlobalPose::rest(skeleton).bounds();
            let in_motion = body_extent(motion).and_then(taller_of_y_and_z);
            match (taller_of_y_and_z(high - low), in_motion) {
                (Some(up), Some(other)) if up != other => {
                    guess(up, UpEvidence::RestPoseAgainstMotion(other))
                }
                (Some(up), _) | (None, Some(up)) => guess(up, UpEvidence::Extent),
                (None, None) => None,
            }
        }
    }
}

/// How far a pair of free ends must be from where their limbs part, all of it along one axis, as a share of
/// the limbs: hands of a T-pose are on both sides of it and say nothing.
const STRAIGHT_SHARE: f32 = 0.8;

/// The axis against which the longest pair of limbs that mirror each other hangs straight at rest, for a figure
/// of which no arms were found.
fn legs_alone(skeleton: &Skeleton) -> Option<UpAxis> {
    let rest = GlobalPose::rest(skeleton);
    let at = |joint: JointId| rest.positions[joint.index()];
    let mut longest: Option<(f32, Vec3)> = None;
    for pair in skeleton.symmetric_pairs() {
        let is_free = |joint: JointId| skeleton.children(joint).is_empty();
        if !is_free(pair.left) || !is_free(pair.right) {
            continue;
        }
        let Some(chain) = skeleton.chain(pair.left, pair.right) else {
            continue;
        };
        let ends = 0.5 * (at(pair.left) + at(pair.right));
        let length = 0.5 * chain.rest_length(skeleton);
        if longest.is_none_or(|(so_far, _)| length > so_far) {
            longest = Some((length, at(chain.top()) - ends));
        }
    }
    let (length, rise) = longest?;
    UpAxis::ALL
        .into_iter()
        .find(|up| length > 0.0 && rise.dot(up.unit()) >= STRAIGHT_SHARE * length)
}

/// The axis along which the trunk stands in most frames.
fn upright_in_motion(motion: &Motion, legs: &LimbPair, arms: &LimbPair) -> Option<UpAxis> {
    let mut local = motion.sample(0.0);
    let mut global = GlobalPose::default();
    let mut counts = [0_usize; UpAxis::ALL.len()];
    let mut frame_count = 0;
    for frame in frames_looked_at(motion) {
        motion.pose_into(frame, &mut local);
        forward_kinematics(motion.skeleton(), &local, &mut global);
        let at = |joint: JointId| global.positions[joint.index()];
        let feet = 0.5 * (at(legs.ends[0]) + at(legs.ends[1]));
        let trunk = (at(arms.parting_joint) - feet).normalize_or_zero();
        frame_count += 1;
        for (count, up) in counts.iter_mut().zip(UpAxis::ALL) {
            *count += usize::from(trunk.dot(up.unit()) >= UPRIGHT_COS);
        }
    }
    let enough = UPRIGHT_SHARE * f64::from(u32::try_from(frame_count).unwrap_or(u32::MAX));
    let most = counts.iter().zip(UpAxis::ALL);
    most.filter(|(count, _)| **count > 0 && **count as f64 >= enough)
        .max_by_key(|(count, _)| **count)
        .map(|(_, up)| up)
}

/// Of Y and Z the one along which a figure of this extent is clearly larger.
fn taller_of_y_and_z(extent: Vec3) -> Option<UpAxis> {
    if extent.y > CLEARLY_TALLER * extent.z {
        Some(UpAxis::Y)
    } else if extent.z > CLEARLY_TALLER * extent.y {
        Some(UpAxis::Z)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::motion::{FrameTime, Motion};

    fn walk(up: UpAxis) -> Motion {
        let walk = crate::sample::by_name("walk").expect("a sample");
        walk.turned(up.y_up_from_file().inverse())
    }

    #[test]
    fn a_walk_stands_along_whichever_axis_its_file_does() {
        for up in UpAxis::ALL {
            let guess = guess_up(&walk(up)).expect("a figure");
            assert_eq!(guess.up, up);
            assert_eq!(guess.evidence, UpEvidence::RestPoseAndMotion);
            assert!(guess.is_known());
        }
    }

    /// A crawl: the rest pose stands along Y and the trunk lies along Z all the time.
    #[test]
    fn a_figure_that_crawls_does_not_climb() {
        let mut motion = walk(UpAxis::Y);
        for frame in 0..motion.frame_count() {
            let root = motion.skeleton().roots().next().expect("a root");
            motion.set_rotation(frame, root, Quat::from_rotation_x(1.5));
        }
        let guess = guess_up(&motion).expect("a figure");
        assert_eq!(guess.up, UpAxis::Y);
        assert_eq!(guess.evidence, UpEvidence::RestPoseAgainstMotion(UpAxis::Z));
        assert!(!guess.is_known());
    }

    /// A figure without arms: legs of 90 along -Y say that Y is up, however its trunk lies in the motion.
    #[test]
    fn legs_alone_say_where_up_is() {
        use crate::skeleton::SkeletonBuilder;
        let mut builder = SkeletonBuilder::new();
        let hips = builder.joint("Hips", None, Vec3::ZERO);
        let head = builder.joint("Head", Some(hips), Vec3::Y * 60.0);
        builder.end_site("Head_end", head, Vec3::Y * 19.0);
        for (side, x) in [("Left", 9.0), ("Right", -9.0)] {
            let hip = builder.joint(format!("{side}UpLeg"), Some(hips), Vec3::X * x);
            let foot = builder.joint(format!("{side}Foot"), Some(hip), Vec3::Y * -82.0);
            builder.end_site(format!("{side}Foot_end"), foot, Vec3::new(0.0, -8.0, 14.0));
        }
        let skeleton = Arc::new(builder.build().expect("a skeleton"));
        let mut crawl = Motion::at_rest(skeleton, 4, FrameTime::of_fps(10), [hips]);
        for frame in 0..4 {
            crawl.set_rotation(frame, hips, Quat::from_rotation_x(1.4));
        }
        let guess = guess_up(&crawl).expect("legs");
        assert_eq!(
            (guess.up, guess.evidence),
            (UpAxis::Y, UpEvidence::RestPose)
        );
    }

    #[test]
    fn a_rest_pose_alone_is_enough() {
        let skeleton = Arc::clone(walk(UpAxis::Z).skeleton());
        let guess =
            guess_up(&Motion::at_rest(skeleton, 0, FrameTime::of_fps(10), [])).expect("a figure");
        assert_eq!((guess.up, guess.is_known()), (UpAxis::Z, true));
    }

    #[test]
    fn axes_have_names() {
        for up in UpAxis::ALL {
            assert_eq!(up.name().parse(), Ok(up));
            assert_eq!(up.to_string().parse(), Ok(up));
            assert_eq!(UpAxis::new(up.axis(), up.is_positive()), up);
        }
        assert_eq!("w".parse::<UpAxis>(), Err(NotAnAxis));
        assert_eq!("".parse::<UpAxis>(), Err(NotAnAxis));
    }
}
