//! Where an effector should be, frame by frame.

use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use posekit::motion::GlobalMotion;
use posekit::rotation::slerp;
use posekit::skeleton::JointId;

use super::figure::Figure;
use super::goals::find;
use super::numbers::list;
use crate::args::Global;
use crate::bytes;
use crate::failure::Failure;
use crate::inputs;
use crate::load;
use crate::output::Guard;

/// A place as it was given.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PlaceArg {
    /// A point in the world.
    World(DVec3),
    /// From where the effector was.
    Offset(DVec3),
    /// A file of points.
    Path(PathBuf),
    /// A joint of another motion, or, without a file, of this one.
    Follow { file: Option<String>, joint: String },
}

impl PlaceArg {
    /// Reads `FILE:JOINT`.
    pub(super) fn follow(text: &str) -> Result<Self, String> {
        match text.rsplit_once(':') {
            Some((file, joint)) if !joint.is_empty() => Ok(Self::Follow {
                file: Some(file.to_owned()).filter(|file| !file.is_empty()),
                joint: joint.to_owned(),
            }),
            _ => Err("expected a file and a joint, such as other.bvh:LeftHand".to_owned()),
        }
    }
}

/// Where an effector should be.
#[derive(Debug)]
pub(super) enum Place {
    /// A point in the world.
    World(DVec3),
    /// From where the effector was in the frame.
    Offset(DVec3),
    /// Points by frame, in order of frame; straight between them, and as the first and last beyond.
    Path(Vec<(f64, DVec3)>),
    /// A joint of a motion, at the same time.
    Follow(Box<GlobalMotion>, JointId),
}

impl Place {
    /// Reads what the place needs; none given is to stay.
    pub(super) fn new(
        given: Option<&PlaceArg>,
        figure: &Figure,
        global: &Global,
    ) -> Result<Self, Failure> {
        match given {
            None => Ok(Self::Offset(DVec3::ZERO)),
            Some(PlaceArg::World(at)) => Ok(Self::World(*at)),
            Some(PlaceArg::Offset(by)) => Ok(Self::Offset(*by)),
            Some(PlaceArg::Path(path)) => read_path(path, &global.guard).map(Self::Path),
            Some(PlaceArg::Follow { file: None, joint }) => {
                let joint = find(&figure.skeleton, joint)?;
                Ok(Self::Follow(Box::new(figure.motion.to_global()), joint))
            }
            Some(PlaceArg::Follow {
                file: Some(file),
                joint,
            }) => {
                let inputs = inputs::expand(&[file.into()]);
                let Some(input) = inputs.list.first().filter(|_| !inputs.is_set) else {
                    return Err(Failure::usage(format!(
                        "'{file}' is not a single file to follow"
                    )));
                };
                let motion = load::load(input, global)?.motion(figure.policies)?;
                let joint =
                    find(motion.skeleton(), joint).map_err(|failure| failure.in_file(file))?;
                if motion.frame_count() == 0 {
                    return Err(Failure::new("has no frames to follow").in_file(file));
                }
                Ok(Self::Follow(Box::new(motion.to_global()), joint))
            }
        }
    }

    /// The place in a frame, given where the effector's point was.
    pub(super) fn at(&self, frame: usize, frame_time_secs: f64, was: DVec3) -> DVec3 {
        match self {
            Self::World(at) => *at,
            Self::Offset(by) => was + *by,
            Self::Path(points) => along(points, frame_number(frame)),
            Self::Follow(motion, joint) => {
                let (before, after, share) = between(motion, frame, frame_time_secs);
                let at = |frame| motion.position(frame, *joint).as_dvec3();
                at(before).lerp(at(after), share)
            }
        }
    }

    /// The orientation of what is followed, in a frame.
    pub(super) fn orientation(&self, frame: usize, frame_time_secs: f64) -> Option<DQuat> {
        let Self::Follow(motion, joint) = self else {
            return None;
        };
        let (before, after, share) = between(motion, frame, frame_time_secs);
        let at = |frame| motion.orientation(frame, *joint).as_dquat().normalize();
        Some(slerp(at(before), at(after), share))
    }
}

fn frame_number(frame: usize) -> f64 {
    f64::from(u32::try_from(frame).unwrap_or(u32::MAX))
}

/// The frames of another motion around the time of a frame, and how far between them it is. A motion
/// without a frame time is followed frame by frame.
fn between(motion: &GlobalMotion, frame: usize, frame_time_secs: f64) -> (usize, usize, f64) {
    let last = motion.frame_count().saturating_sub(1);
    let other_secs = motion.frame_time_secs();
    if !(other_secs > 0.0 && frame_time_secs > 0.0) {
        let same = frame.min(last);
        return (same, same, 0.0);
    }
    let at = frame_number(frame) * frame_time_secs / other_secs;
    // A file's frame time is rounded (0.016667): its frames are the same when they nearly are.
    let at = if (at - at.round()).abs() < 1e-3 {
        at.round()
    } else {
        at
    };
    if at >= frame_number(last) {
        return (last, last, 0.0);
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not negative, and below the number of the last frame"
    )]
    let before = at.floor() as usize;
    (before, before + 1, at - at.floor())
}

/// A point of a path: straight between its points, still before the first and after the last.
fn along(points: &[(f64, DVec3)], frame: f64) -> DVec3 {
    let after = points.partition_point(|(at, _)| *at <= frame);
    match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
        (Some((start, a)), Some(&(end, b))) => a.lerp(b, (frame - start) / (end - start)),
        (Some((_, only)), None) | (None, Some(&(_, only))) => only,
        (None, None) => DVec3::ZERO,
    }
}

/// Reads lines of `x,y,z`, one a frame from 0, or `frame,x,y,z`. A first line of words is a heading;
/// empty lines and those that start with # are skipped.
fn read_path(path: &Path, guard: &Guard) -> Result<Vec<(f64, DVec3)>, Failure> {
    let name = path.display();
    let bytes = bytes::of_file(path, guard)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut points: Vec<(f64, DVec3)> = Vec::new();
    let mut is_first = true;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim().trim_start_matches('\u{feff}');
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let numbers = list(line);
        let is_heading =
            is_first && numbers.is_none() && !line.starts_with(|c: char| c.is_ascii_digit());
        is_first = false;
        if is_heading {
            continue;
        }
        let point = match numbers.as_deref() {
            Some(&[x, y, z]) => (frame_number(points.len()), DVec3::new(x, y, z)),
            Some(&[frame, x, y, z]) => (frame, DVec3::new(x, y, z)),
            _ => {
                let line = index + 1;
                return Err(Failure::new(format!(
                    "{name}:{line}:1: expected x,y,z or frame,x,y,z"
                )));
            }
        };
        points.push(point);
    }
    if points.is_empty() {
        return Err(Failure::new(format!("{name}: has no points")));
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|later, earlier| later.0 == earlier.0);
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_straight_between_its_points_and_still_beyond() {
        let points = [(2.0, DVec3::ZERO), (4.0, DVec3::X), (5.0, DVec3::Y)];
        assert_eq!(along(&points, 0.0), DVec3::ZERO);
        assert_eq!(along(&points, 3.0), DVec3::X * 0.5);
        assert_eq!(along(&points, 5.0), DVec3::Y);
        assert_eq!(along(&points, 50.0), DVec3::Y);
    }

    #[test]
    fn what_is_followed_is_a_file_and_a_joint() {
        assert_eq!(
            PlaceArg::follow("C:\\a.bvh:Hand"),
            Ok(PlaceArg::Follow {
                file: Some("C:\\a.bvh".to_owned()),
                joint: "Hand".to_owned()
            })
        );
        assert_eq!(
            PlaceArg::follow(":Hand"),
            Ok(PlaceArg::Follow {
                file: None,
                joint: "Hand".to_owned()
            })
        );
        assert!(PlaceArg::follow("a.bvh").is_err() && PlaceArg::follow("a.bvh:").is_err());
    }
}
