//! A robot on the bench: what a URDF file says, and what follows from it once.
//!
//! The file's Z up becomes Y up by a turn of its root ([`UpAxis::Y`]); every frame below stays the one
//! that the file says. Metres and radians.

use std::sync::Arc;

use posekit::mechanism::{Freedom, Mechanism, ValueRange};
use posekit::skeleton::JointId;
use posekit_formats::report::ImportReport;
use posekit_formats::urdf::{self, UpAxis, Urdf, UrdfShape};

use super::body::{Body, transforms};
use super::planar::PlanarArm;

/// One of the numbers that say where a robot's joints stand.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueKind {
    /// The joint that it belongs to.
    pub joint: JointId,
    /// Which of the joint's numbers it is; empty for a joint of one.
    pub part: &'static str,
    /// Whether it is an angle in radians; a length in metres otherwise.
    pub is_angle: bool,
    /// Its range.
    pub range: ValueRange,
    /// The range that is offered: its own, or a turn or the robot's reach where it has no ends.
    pub offered: ValueRange,
}

/// A robot, ready to be moved.
#[derive(Clone, Debug)]
pub struct Robot {
    /// The name shown: the file's, or the sample's.
    pub name: String,
    /// The document, as the file has it.
    pub document: Arc<Urdf>,
    /// What the reader noticed.
    pub report: ImportReport,
    /// How its joints move.
    pub mechanism: Arc<Mechanism>,
    /// The range of every value.
    pub ranges: Vec<ValueRange>,
    /// What every value is.
    pub values: Vec<ValueKind>,
    /// Index of the document's joint for each joint of the mechanism; `None` for the root link.
    pub joints_in_file: Vec<Option<usize>>,
    /// The joints that nothing hangs from, those with most moving joints before them first.
    pub tips: Vec<JointId>,
    /// What it looks like.
    pub body: Arc<Body>,
    /// How far a tip may get from the first moving joint, at most: the links laid end to end. Positive.
    pub reach: f64,
    /// Its two links, when it is a planar arm of two.
    pub planar: Option<PlanarArm>,
    /// The values that it is shown with first.
    pub start: Vec<f64>,
    /// Height of the floor that it stands on, in the world.
    pub ground_height: f32,
    /// What was drawn otherwise than the file says, for people.
    pub note: Option<String>,
}

impl Robot {
    /// Reads a URDF file.
    ///
    /// # Errors
    /// What is wrong, with its place in the file, for people.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, String> {
        let import = urdf::read(bytes).map_err(|error| error.to_string())?;
        let mut robot = Self::new(name.to_owned(), import.document, import.report)?;
        let mut ours = urdf::sample::names().filter_map(|(name, _)| urdf::sample::by_name(name));
        if ours.any(|text| text.as_bytes() == bytes) {
            robot.start_bent();
        }
        Ok(robot)
    }

    /// One of posekit's own, by its name; see [`urdf::sample`].
    #[must_use]
    pub fn sample(name: &str) -> Option<Self> {
        let text = urdf::sample::by_name(name)?;
        Self::read(name, text.as_bytes()).ok()
    }

    fn new(name: String, document: Urdf, report: ImportReport) -> Result<Self, String> {
        let mechanism = document
            .to_robot(UpAxis::Y)
            .map_err(|error| error.to_string())?;
        let mut joints_in_file = vec![None];
        joints_in_file.extend(document.joints_from_root().into_iter().map(Some));
        let ranges = mechanism.value_ranges();
        let start: Vec<f64> = ranges.iter().map(|range| range.clamp(0.0)).collect();
        let tips = tips(&mechanism);
        let reach = reach(&mechanism, &tips);
        let body = Body::of(&document, &mechanism, reach);
        let planar = tips
            .first()
            .and_then(|&tip| PlanarArm::find(&mechanism, tip));
        Ok(Self {
            note: note(&name, &document),
            values: kinds(&mechanism, &ranges, reach),
            name,
            ranges,
            joints_in_file,
            tips,
            ground_height: ground_height(&mechanism, &body, &start),
            body: Arc::new(body),
            reach,
            planar,
            start,
            report,
            mechanism: Arc::new(mechanism),
            document: Arc::new(document),
        })
    }

    /// Starts with bent joints: our own arms are shown away from the singularities that they have
    /// when all values are zero.
    fn start_bent(&mut self) {
        /// Degrees, joint by joint: a raised upper arm, a bent elbow, the tool pointing down.
        const SIX: [f64; 6] = [-65.0, -60.0, 180.0, 0.0, 60.0, 0.0];
        const SEVEN: [f64; 7] = [-50.0, 35.0, 0.0, -75.0, 0.0, 60.0, 0.0];
        const TWO: [f64; 2] = [30.0, 45.0];
        let bent: &[f64] = match self.start.len() {
            2 => &TWO,
            6 => &SIX,
            7 => &SEVEN,
            _ => return,
        };
        for ((value, range), degrees) in self.start.iter_mut().zip(&self.ranges).zip(bent) {
            *value = range.clamp(degrees.to_radians());
        }
    }

    /// What a joint of the mechanism is called: the joint's name, or for the root its link's.
    #[must_use]
    pub fn joint_name(&self, joint: JointId) -> &str {
        self.mechanism.skeleton().unique_name(joint)
    }

    /// The name of the link that a joint of the mechanism carries.
    #[must_use]
    pub fn link_name(&self, joint: JointId) -> &str {
        let link = match self.joints_in_file.get(joint.index()) {
            Some(Some(index)) => self.document.joints[*index].child,
            _ => self.document.root,
        };
        &self.document.links[link].name
    }

    /// The joints from the root to a joint, both included.
    #[must_use]
    pub fn path_to(&self, joint: JointId) -> Vec<JointId> {
        let skeleton = self.mechanism.skeleton();
        let mut path: Vec<JointId> = std::iter::once(joint)
            .chain(skeleton.ancestors(joint))
            .collect();
        path.reverse();
        path
    }

    /// The values that move a joint's link: its own and its ancestors', those that are followed too.
    #[must_use]
    pub fn values_moving(&self, joint: JointId) -> Vec<usize> {
        let mut values: Vec<usize> = self
            .path_to(joint)
            .into_iter()
            .flat_map(|joint| self.mechanism.values_of_joint(self.leader(joint)))
            .collect();
        values.sort_unstable();
        values.dedup();
        values
    }

    /// The joint whose value a joint goes by: its own, or the one that it follows in the end.
    fn leader(&self, joint: JointId) -> JointId {
        let mut at = joint;
        // The mechanism was built: nobody follows himself.
        while let Some(follow) = self.mechanism.joint(at).follows {
            at = follow.joint;
        }
        at
    }

    /// The value of a hinge or slide, whether it is its own or follows another's.
    #[must_use]
    pub fn value_of(&self, joint: JointId, values: &[f64]) -> Option<f64> {
        let mechanism = &self.mechanism;
        if mechanism.joint(joint).freedom.value_count() != 1 {
            return None;
        }
        let mut way = Vec::new();
        let mut at = joint;
        while let Some(follow) = mechanism.joint(at).follows {
            way.push(follow);
            at = follow.joint;
        }
        let own = *values.get(mechanism.values_of_joint(at).start)?;
        let along = way.into_iter().rev();
        Some(along.fold(own, |value, follow| {
            follow.multiplier * value + follow.offset
        }))
    }
}

/// What every value is.
fn kinds(mechanism: &Mechanism, ranges: &[ValueRange], reach: f64) -> Vec<ValueKind> {
    const PLANAR: [(&str, bool); 3] = [("x", false), ("y", false), ("turn", true)];
    const BALL: [(&str, bool); 3] = [("rx", true), ("ry", true), ("rz", true)];
    const FREE: [(&str, bool); 6] = [
        ("x", false),
        ("y", false),
        ("z", false),
        ("rx", true),
        ("ry", true),
        ("rz", true),
    ];
    let mut kinds = Vec::with_capacity(ranges.len());
    for joint in mechanism.moving_joints() {
        let parts: &[(&str, bool)] = match mechanism.joint(joint).freedom {
            Freedom::Fixed => &[],
            Freedom::Hinge { .. } => &[("", true)],
            Freedom::Slide { .. } => &[("", false)],
            Freedom::Planar { .. } => &PLANAR,
            Freedom::Ball => &BALL,
            Freedom::Free => &FREE,
        };
        for (&(part, is_angle), index) in parts.iter().zip(mechanism.values_of_joint(joint)) {
            let range = ranges[index];
            let end = if is_angle {
                core::f64::consts::PI
            } else {
                reach
            };
            let bound = |own: f64, other: f64| if own.is_finite() { own } else { other };
            kinds.push(ValueKind {
                joint,
                part,
                is_angle,
                range,
                offered: ValueRange {
                    lower: bound(range.lower, (-end).min(range.upper - end)),
                    upper: bound(range.upper, end.max(range.lower + end)),
                },
            });
        }
    }
    kinds
}

/// The joints that nothing hangs from, those with most moving joints before them first.
fn tips(mechanism: &Mechanism) -> Vec<JointId> {
    let skeleton = mechanism.skeleton();
    let moving = |joint: JointId| {
        std::iter::once(joint)
            .chain(skeleton.ancestors(joint))
            .filter(|&joint| mechanism.joint(joint).freedom != Freedom::Fixed)
            .count()
    };
    let ends = skeleton
        .joints()
        .filter(|&joint| skeleton.children(joint).is_empty());
    let mut tips: Vec<(usize, JointId)> = ends.map(|joint| (moving(joint), joint)).collect();
    tips.sort_by_key(|&(count, joint)| (std::cmp::Reverse(count), joint.index()));
    tips.into_iter().map(|(_, joint)| joint).collect()
}

/// The longest way from the first moving joint of a chain to its tip, links laid end to end and slides
/// drawn out.
fn reach(mechanism: &Mechanism, tips: &[JointId]) -> f64 {
    let skeleton = mechanism.skeleton();
    let of = |&tip: &JointId| {
        let mut path: Vec<JointId> = std::iter::once(tip)
            .chain(skeleton.ancestors(tip))
            .collect();
        path.reverse();
        let is_moving = |joint: &JointId| mechanism.joint(*joint).freedom != Freedom::Fixed;
        let first = path.iter().position(is_moving).unwrap_or(0);
        let links = path.iter().skip(first + 1);
        let lengths = links.map(|&joint| {
            let described = mechanism.joint(joint);
            let slide = match described.freedom {
                Freedom::Slide { .. } if described.range.is_bounded() => {
                    described.range.lower.abs().max(described.range.upper.abs())
                }
                _ => 0.0,
            };
            described.rest_translation.length() + slide
        });
        lengths.sum::<f64>()
    };
    let longest = tips.iter().map(of).fold(0.0, f64::max);
    let whole: f64 = mechanism
        .joints()
        .iter()
        .map(|joint| joint.rest_translation.length())
        .fold(0.0, f64::max);
    [longest, whole]
        .into_iter()
        .find(|length| *length > 1e-6 && length.is_finite())
        .unwrap_or(1.0)
}

/// Where the floor is: under what stands still. A robot of which so much hangs below that, or nothing stands still, is
/// not mounted there but stands on its feet, as a humanoid does whose root is its pelvis: the floor is under the lowest
/// point of its pose at rest.
fn ground_height(mechanism: &Mechanism, body: &Body, at_rest: &[f64]) -> f32 {
    /// Of the height of all.
    const HANGS: f32 = 0.2;
    let skeleton = mechanism.skeleton();
    let mut is_still = Vec::with_capacity(skeleton.joint_count());
    for joint in skeleton.joints() {
        let carried = skeleton
            .parent(joint)
            .is_none_or(|parent| is_still[parent.index()]);
        is_still.push(carried && mechanism.joint(joint).freedom == Freedom::Fixed);
    }
    let joints = transforms(&mechanism.global_frames(at_rest));
    let Some([lowest, highest]) = body.heights(&joints, |_| true) else {
        return 0.0;
    };
    match body.heights(&joints, |joint| is_still.get(joint) == Some(&true)) {
        Some([still, _]) if still - lowest <= HANGS * (highest - lowest) => still.min(0.0),
        _ => lowest.min(0.0),
    }
}

/// What is drawn otherwise than the file says.
fn note(name: &str, document: &Urdf) -> Option<String> {
    let is_mesh = |shape: &UrdfShape| matches!(shape, UrdfShape::Mesh { .. });
    let with_meshes = document
        .links
        .iter()
        .filter(|link| link.visuals.iter().any(|visual| is_mesh(&visual.shape)));
    let names: Vec<&str> = with_meshes.map(|link| link.name.as_str()).collect();
    let links = match names.as_slice() {
        [] => return None,
        [one] => format!("link {one} has its mesh in a file of its own"),
        [first, ..] => format!(
            "{} links, {first} the first, have their meshes in files of their own",
            names.len()
        ),
    };
    Some(format!("{name}: {links}; simple shapes are drawn instead"))
}
