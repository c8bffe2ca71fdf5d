//! Which frames, joints and points of a motion the user asked for.

use std::ops::Range;
use std::str::FromStr;

use glam::Vec3;
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::arrays::AttachedPoint;

use crate::failure::Failure;
use crate::similar;

/// How many joint names an error lists before it refers to the tree.
const NAMES_LISTED: usize = 12;

/// Frames by number, from 0: `7`, `0..100` (without the last), `0..200:5`, `50..`, and lists of these.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FrameSelection {
    parts: Vec<FramePart>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FramePart {
    One(usize),
    Range {
        start: usize,
        end: Option<usize>,
        step: usize,
    },
}

impl FromStr for FrameSelection {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text
            .split(',')
            .map(|part| part.trim().parse())
            .collect::<Result<_, _>>()?;
        Ok(Self { parts })
    }
}

impl FromStr for FramePart {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |digits: &str| -> Result<usize, String> {
            digits.trim().parse().map_err(|_not_a_number| {
                format!("'{digits}' is not a frame number; write 7, 0..100 or 0..200:5")
            })
        };
        let Some((start, rest)) = text.split_once("..") else {
            return Ok(Self::One(number(text)?));
        };
        let (end, step) = rest.split_once(':').unwrap_or((rest, "1"));
        let start = if start.is_empty() { 0 } else { number(start)? };
        let end = if end.is_empty() {
            None
        } else {
            Some(number(end)?)
        };
        let step = number(step)?;
        if step == 0 {
            return Err("a step of 0 never ends".to_owned());
        }
        if end.is_some_and(|end| end <= start) {
            return Err(format!(
                "'{text}' is empty: its end must come after its start"
            ));
        }
        Ok(Self::Range { start, end, step })
    }
}

impl FrameSelection {
    /// What to say of ranges that reach past the end of a motion of `frame_count` frames, if any does.
    pub(crate) fn past_the_end(&self, frame_count: usize) -> Option<String> {
        let reaches_past = |part: &&FramePart| match **part {
            FramePart::Range { start, end, .. } => {
                start < frame_count && end.is_some_and(|end| end > frame_count)
            }
            FramePart::One(_) => false,
        };
        match self.parts.iter().find(reaches_past)? {
            FramePart::Range { start, end, .. } => {
                Some(range_past_the_end(*start, (*end)?, frame_count))
            }
            FramePart::One(_) => None,
        }
    }

    /// How many [`frames`](Self::frames) are selected, at least where they exist.
    pub(crate) fn count(&self, frame_count: usize) -> usize {
        let counts = self.parts.iter().map(|part| match *part {
            FramePart::One(_) => 1,
            FramePart::Range { start, end, step } => {
                let end = end.unwrap_or(frame_count).min(frame_count);
                end.saturating_sub(start).div_ceil(step.max(1))
            }
        });
        counts.fold(0, usize::saturating_add)
    }

    /// From the first to the last of the selected frames of a motion of `frame_count` frames.
    pub(crate) fn span(&self, frame_count: usize) -> Result<Range<usize>, Failure> {
        let mut span: Option<Range<usize>> = None;
        for part in &self.parts {
            // A frame that does not exist is a failure, as it is of all frames.
            let ends = match *part {
                FramePart::Range { start, end, .. } if start < frame_count => {
                    start..end.unwrap_or(frame_count).min(frame_count)
                }
                FramePart::One(frame) if frame < frame_count => frame..frame + 1,
                FramePart::Range { start: frame, .. } | FramePart::One(frame) => {
                    return Err(frame_past_the_end(frame, frame_count));
                }
            };
            span = Some(match span {
                Some(span) => span.start.min(ends.start)..span.end.max(ends.end),
                None => ends,
            });
        }
        Ok(span.unwrap_or(0..0))
    }

    /// The selected frames of a motion of `frame_count` frames, in the order they were asked for.
    /// A range stops where the motion does; a single frame that does not exist is a failure, and so
    /// is a selection of nothing.
    pub(crate) fn frames(&self, frame_count: usize) -> Result<Vec<usize>, Failure> {
        let mut frames = Vec::new();
        for part in &self.parts {
            match *part {
                FramePart::One(frame) if frame >= frame_count => {
                    return Err(frame_past_the_end(frame, frame_count));
                }
                FramePart::One(frame) => frames.push(frame),
                FramePart::Range { start, .. } if start >= frame_count => {
                    return Err(frame_past_the_end(start, frame_count));
                }
                FramePart::Range { start, end, step } => {
                    let end = end.unwrap_or(frame_count).min(frame_count);
                    frames.extend((start..end).step_by(step));
                }
            }
        }
        Ok(frames)
    }
}

fn frame_past_the_end(frame: usize, frame_count: usize) -> Failure {
    Failure::new(format!("frame {frame} is past the end"))
        .try_next(format!("the frames are 0..{frame_count}"))
}

/// What to say of a range of frames that reaches past the end.
pub(crate) fn range_past_the_end(start: usize, end: usize, frame_count: usize) -> String {
    format!("{start}..{end} goes past the end, so it stops there: the frames are 0..{frame_count}")
}

/// The joints that a list of names and patterns selects, in the skeleton's order; all of them for
/// an empty list.
pub(crate) fn joints(skeleton: &Skeleton, wanted: &[String]) -> Result<Vec<JointId>, Failure> {
    if wanted.is_empty() {
        return Ok(skeleton.joints().collect());
    }
    let mut is_selected = vec![false; skeleton.joint_count()];
    for text in wanted {
        let matches = matching(skeleton, text)?;
        if matches.is_empty() {
            return Err(no_such_joint(skeleton, text));
        }
        matches
            .iter()
            .for_each(|joint| is_selected[joint.index()] = true);
    }
    Ok(skeleton
        .joints()
        .filter(|joint| is_selected[joint.index()])
        .collect())
}

/// The joints of that unique name, of that name, or matched by that pattern.
fn matching(skeleton: &Skeleton, text: &str) -> Result<Vec<JointId>, Failure> {
    let of_name =
        |joint: &JointId| skeleton.name(*joint) == text || skeleton.unique_name(*joint) == text;
    let exact: Vec<JointId> = skeleton.joints().filter(of_name).collect();
    if !exact.is_empty() || !text.contains(['*', '?', '[']) {
        return Ok(exact);
    }
    let pattern = glob::Pattern::new(text)
        .map_err(|error| Failure::usage(format!("bad joint pattern '{text}': {}", error.msg)))?;
    Ok(skeleton
        .joints()
        .filter(|&joint| pattern.matches(skeleton.name(joint)))
        .collect())
}

fn no_such_joint(skeleton: &Skeleton, text: &str) -> Failure {
    if text.contains(['*', '?', '[']) {
        return Failure::new(format!("no joint's name matches '{text}'"))
            .try_next("posekit info --tree lists the joints");
    }
    let failure = Failure::new(format!("no joint is called '{text}'"));
    let names = skeleton.joints().map(|joint| skeleton.unique_name(joint));
    if let Some(name) = similar::nearest(text, names) {
        return failure.try_next(format!("did you mean '{name}'"));
    }
    let names: Vec<&str> = skeleton
        .joints()
        .take(NAMES_LISTED)
        .map(|joint| skeleton.unique_name(joint))
        .collect();
    let more = if skeleton.joint_count() > NAMES_LISTED {
        ", ..."
    } else {
        ""
    };
    failure.try_next(format!("its joints are {}{more}", names.join(", ")))
}

/// A point attached to a joint's link, as `JOINT,x,y,z`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PointArg {
    joint: String,
    point_in_joint: Vec3,
}

impl FromStr for PointArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // From the back: a joint's name may have commas in it.
        let mut fields = text.rsplitn(4, ',');
        let mut coordinate = || -> Option<f32> {
            fields
                .next()?
                .trim()
                .parse()
                .ok()
                .filter(|value: &f32| value.is_finite())
        };
        let (z, y, x) = (coordinate(), coordinate(), coordinate());
        match (x, y, z, fields.next()) {
            (Some(x), Some(y), Some(z), Some(joint)) if !joint.is_empty() => Ok(Self {
                joint: joint.to_owned(),
                point_in_joint: Vec3::new(x, y, z),
            }),
            _ => Err("a point is a joint and three numbers, such as RightHand,0,0.1,0".to_owned()),
        }
    }
}

impl PointArg {
    /// The point on a skeleton that has such a joint.
    pub(crate) fn attach(&self, skeleton: &Skeleton) -> Result<AttachedPoint, Failure> {
        let joint = skeleton
            .find(&self.joint)
            .ok_or_else(|| no_such_joint(skeleton, &self.joint))?;
        Ok(AttachedPoint {
            joint,
            point_in_joint: self.point_in_joint,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posekit::skeleton::SkeletonBuilder;

    fn frames(text: &str, count: usize) -> Result<Vec<usize>, String> {
        text.parse::<FrameSelection>()?
            .frames(count)
            .map_err(|failure| failure.to_string())
    }

    #[test]
    fn frames_are_numbers_ranges_and_steps() {
        assert_eq!(frames("3", 10).unwrap(), [3]);
        assert_eq!(frames("2..5", 10).unwrap(), [2, 3, 4]);
        assert_eq!(frames("0..200:4", 10).unwrap(), [0, 4, 8]);
        assert_eq!(frames("8.., 1,..2", 10).unwrap(), [8, 9, 1, 0, 1]);
    }

    #[test]
    fn frames_that_make_no_sense_say_why() {
        for text in ["", "x", "1..x", "5..5", "0..4:0", "-1", "1..2..3"] {
            assert!(frames(text, 10).is_err(), "{text}");
        }
        assert_eq!(
            frames("12", 10).unwrap_err(),
            "frame 12 is past the end; the frames are 0..10"
        );
        assert!(frames("0..", 0).is_err());
    }

    #[test]
    fn a_range_past_the_end_is_worth_a_note() {
        let note =
            |text: &str, count: usize| text.parse::<FrameSelection>().unwrap().past_the_end(count);
        assert_eq!(
            note("0..5,100..9999", 200).unwrap(),
            "100..9999 goes past the end, so it stops there: the frames are 0..200"
        );
        for text in ["0..200", "0..", "199", "7,0..200:5"] {
            assert_eq!(note(text, 200), None, "{text}");
        }
    }

    fn skeleton() -> Skeleton {
        let mut builder = SkeletonBuilder::new();
        let hips = builder.joint("Hips", None, Vec3::ZERO);
        builder.joint("LeftLeg", Some(hips), Vec3::X);
        builder.joint("RightLeg", Some(hips), Vec3::NEG_X);
        builder.build().unwrap()
    }

    fn picked(wanted: &[&str]) -> Result<Vec<usize>, String> {
        let wanted: Vec<String> = wanted.iter().map(|&text| text.to_owned()).collect();
        let joints = joints(&skeleton(), &wanted).map_err(|failure| failure.to_string())?;
        Ok(joints.iter().map(|joint| joint.index()).collect())
    }

    #[test]
    fn joints_are_names_and_patterns_in_the_skeletons_order() {
        assert_eq!(picked(&[]).unwrap(), [0, 1, 2]);
        assert_eq!(picked(&["*Leg", "Hips"]).unwrap(), [0, 1, 2]);
        assert_eq!(picked(&["RightLeg"]).unwrap(), [2]);
        assert!(
            picked(&["leftleg"])
                .unwrap_err()
                .contains("did you mean 'LeftLeg'")
        );
        assert!(
            picked(&["RihgtLeg"])
                .unwrap_err()
                .contains("did you mean 'RightLeg'")
        );
        assert!(
            picked(&["Tail"])
                .unwrap_err()
                .contains("Hips, LeftLeg, RightLeg")
        );
    }

    #[test]
    fn a_point_is_a_joint_and_three_numbers() {
        let point: PointArg = "LeftLeg,0,-0.5,1e-1".parse().unwrap();
        let attached = point.attach(&skeleton()).unwrap();
        assert_eq!(
            (attached.joint.index(), attached.point_in_joint),
            (1, Vec3::new(0.0, -0.5, 0.1))
        );
        for text in [
            "LeftLeg",
            "LeftLeg,1,2",
            "LeftLeg,a,b,c",
            ",1,2,3",
            "LeftLeg,1,2,inf",
        ] {
            assert!(text.parse::<PointArg>().is_err(), "{text}");
        }
        let missing: PointArg = "Tail,0,0,0".parse().unwrap();
        assert!(missing.attach(&skeleton()).is_err());
    }
}
