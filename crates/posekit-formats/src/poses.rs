//! Saved poses in a text file, `NAME.poses.toml`.
//!
//! A pose says how joints are turned, by their names, so that it fits every skeleton that has joints of
//! these names. `docs/pose-library.md` describes the file.
//!
//! **Space and units.** Rotations are quaternions x, y, z, w in the parent's space; translations in the
//! parent's space and the unit of the skeleton that they were saved from, whose height stands beside them.
//!
//! **Guarantees.** What is written reads back as the same poses, to the bit, and writes as the same bytes. One
//! joint is one line. A file of a newer [`VERSION`] is refused by its number; all problems of a file are found
//! at once, each with its place.
//!
//! The file is TOML 1.0 and memory is in proportion to its length.

use std::fmt::Write;

use glam::{DQuat, DVec3};
use posekit::range::{LONGEST_LENGTH, are_lengths};

use crate::number_text::NumberText;
use crate::scene::read::fields::{Fields, Node, Problems};
use crate::scene::read::read_as;
use crate::scene::{SceneProblemKind, SceneReadError, quoted};

/// What the file says of itself in `format`.
pub const FORMAT: &str = "posekit poses";

/// The version of the format that is written, and the newest that is read.
pub const VERSION: u32 = 1;

/// How the name of a file of poses ends.
pub const EXTENSION: &str = "poses.toml";

/// How far from 1 the length of a quaternion may be: that of four decimals, written by hand.
const UNIT_TOLERANCE: f64 = 1e-3;

/// A pose under a name.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedPose {
    /// What it is called.
    pub name: String,
    /// The height of the skeleton that it was saved from, in its unit; greater than 0.
    pub height: f64,
    /// The joints, in the order of their skeleton.
    pub joints: Vec<SavedJoint>,
}

/// How a joint stands in a saved pose.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedJoint {
    /// The joint's name.
    pub name: String,
    /// Its rotation in the parent's space, of unit length.
    pub rotation: DQuat,
    /// Its translation in the parent's space, where it moves.
    pub translation: Option<DVec3>,
}

/// Whether a file of this name holds poses: whether it ends in `.poses.toml`, in any case of letters.
pub fn is_poses_name(name: &str) -> bool {
    let ending = format!(".{EXTENSION}");
    name.len() >= ending.len()
        && name.is_char_boundary(name.len() - ending.len())
        && name[name.len() - ending.len()..].eq_ignore_ascii_case(&ending)
}

/// Reads poses from the bytes of their file.
///
/// # Errors
/// [`SceneReadError`] with every problem: text that is no TOML, a newer version, and fields that are
/// missing, unknown, of another kind or inconsistent.
pub fn read(bytes: &[u8]) -> Result<Vec<SavedPose>, SceneReadError> {
    read_as(bytes, FORMAT, VERSION, |fields, _version, problems| {
        let poses = fields.tables("pose", problems);
        let poses = poses.into_iter().map(|mut pose| {
            let read = self::pose(&mut pose, problems);
            pose.finish(problems);
            read
        });
        // All of them are looked at, so that all their problems are told.
        let poses: Vec<Option<SavedPose>> = poses.collect();
        fields.finish(problems);
        poses.into_iter().collect()
    })
}

fn pose(fields: &mut Fields<'_>, problems: &mut Problems) -> Option<SavedPose> {
    let name = fields.take("name", "a name", problems, |node| node.text());
    let is_height = |height: &f64| *height > 0.0 && are_lengths([*height]);
    let height = fields.take("height", "a number greater than 0", problems, |node| {
        node.number().filter(is_height)
    });
    let joints = fields.tables("joints", problems);
    let joints = joints.into_iter().map(|mut fields| {
        let joint = self::joint(&mut fields, problems);
        fields.finish(problems);
        joint
    });
    let joints: Vec<Option<SavedJoint>> = joints.collect();
    if joints.is_empty() {
        fields.problem(
            problems,
            SceneProblemKind::Inconsistent,
            "a pose needs at least one joint".to_owned(),
        );
    }
    Some(SavedPose {
        name: name?.to_owned(),
        height: height?,
        joints: joints.into_iter().collect::<Option<_>>()?,
    })
}

fn joint(fields: &mut Fields<'_>, problems: &mut Problems) -> Option<SavedJoint> {
    let name = fields.take("name", "a joint's name", problems, |node| node.text());
    let rotation = fields.take(
        "rotation",
        "four numbers, a quaternion of unit length",
        problems,
        unit_quaternion,
    );
    let what = format!("three numbers within {LONGEST_LENGTH:e}");
    let read = |node: &Node<'_>| {
        let place = node.numbers().filter(|&place| are_lengths(place))?;
        Some(Some(DVec3::from_array(place)))
    };
    let translation = fields.take_or("translation", None, &what, problems, read);
    Some(SavedJoint {
        name: name?.to_owned(),
        rotation: rotation?,
        translation,
    })
}

fn unit_quaternion(node: &Node<'_>) -> Option<DQuat> {
    let rotation = DQuat::from_array(node.numbers()?);
    ((rotation.length() - 1.0).abs() <= UNIT_TOLERANCE).then_some(rotation)
}

/// The bytes of the file of some poses: always the same for the same poses.
pub fn write(poses: &[SavedPose]) -> Vec<u8> {
    let mut out = format!("format = \"{FORMAT}\"\nversion = {VERSION}\n");
    let mut numbers = NumberText::default();
    let mut list = |values: &[f64]| {
        let values: Vec<String> = values.iter().map(|&v| numbers.of(v).to_owned()).collect();
        values.join(", ")
    };
    for pose in poses {
        let (name, height) = (quoted(&pose.name), list(&[pose.height]));
        // Writing to a string does not fail.
        let _ = write!(
            out,
            "\n[[pose]]\nname = {name}\nheight = {height}\njoints = [\n"
        );
        for joint in &pose.joints {
            let (name, rotation) = (quoted(&joint.name), list(&joint.rotation.to_array()));
            let _ = write!(out, "  {{ name = {name}, rotation = [{rotation}]");
            if let Some(translation) = joint.translation {
                let _ = write!(out, ", translation = [{}]", list(&translation.to_array()));
            }
            out.push_str(" },\n");
        }
        out.push_str("]\n");
    }
    out.into_bytes()
}
