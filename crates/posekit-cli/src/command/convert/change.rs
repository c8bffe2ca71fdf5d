//! The options of `posekit convert` as edits of a document.

use std::ops::Range;
use std::str::FromStr;

use posekit::motion::FrameTime;
use posekit_formats::bvh::edit::{self, ChannelSet, EditError};
use posekit_formats::bvh::elsewhere;
use posekit_formats::bvh::{Bvh, BvhJoint};

use super::{Channels, ConvertArgs};
use crate::failure::Failure;
use crate::program::ProgramArg;
use crate::text::{counted, decimals_to_show, trimmed};
use crate::{select, similar, up};

/// What to tell the user of a change that was made.
#[derive(Debug, Default)]
pub(super) struct Remarks {
    /// What could not be done in full.
    pub(super) warnings: Vec<String>,
    /// What is worth knowing and needs no action.
    pub(super) notes: Vec<String>,
}

/// Applies the options and says what there is to say about it.
pub(super) fn apply(
    args: &ConvertArgs,
    model: Option<&Bvh>,
    bvh: &mut Bvh,
) -> Result<Remarks, Failure> {
    let mut remarks = Remarks::default();
    edit::settle_positions(bvh, args.positions.policies());
    for Rename { from, to } in &args.rename {
        edit::rename(bvh, from, to).map_err(|error| unknown_joint(error, from, bvh))?;
    }
    if let Some(model) = model {
        edit::reorder_like(bvh, model).map_err(refused)?;
    }
    if let Some(secs) = args.frame_time {
        edit::set_frame_time(bvh, secs).map_err(refused)?;
    }
    if let Some(trim) = &args.trim {
        let range = trim.frames(bvh)?;
        let (frame_count, start, end) = (bvh.frame_count(), range.start, range.end);
        edit::trim(bvh, range).map_err(refused)?;
        if trim.end.is_some() && end > frame_count {
            remarks
                .notes
                .push(select::range_past_the_end(start, end, frame_count));
        }
    }
    if let Some(fps) = args.fps {
        edit::resample(bvh, fps).map_err(refused)?;
    }
    if let Some(factor) = args.scale {
        edit::scale(bvh, factor).map_err(refused)?;
    }
    if let Some(to) = args.up {
        let from = match args.from_up {
            Some(from) => from,
            None => {
                let guess = edit::guess_up_axis(bvh).ok_or_else(|| {
                    Failure::new("cannot tell which axis points up now")
                        .try_next("name it with --from-up")
                })?;
                if !guess.is_known() {
                    remarks.notes.push(format!(
                        "took {} as the axis that points up now, {}; --from-up names another",
                        guess.up,
                        up::because(guess)
                    ));
                }
                guess.up
            }
        };
        edit::turn_up(bvh, from, to);
    }
    match args.channels {
        Some(Channels::Three) => {
            let kept = edit::set_channels(bvh, ChannelSet::RotationsAndMovingRoots);
            remarks.warnings.extend(kept_remark(bvh, &kept));
        }
        Some(Channels::Six) => {
            edit::set_channels(bvh, ChannelSet::PositionsAndRotations);
        }
        None => {}
    }
    if let Some(order) = args.order {
        edit::set_rotation_order(bvh, order).map_err(refused)?;
    }
    if let Some(ProgramArg(program)) = args.program {
        let changes = elsewhere::adapt(bvh, program)
            .map_err(|obstacle| Failure::new(obstacle.to_string()))?;
        let title = program.title();
        let notes = changes
            .into_iter()
            .map(|change| format!("for {title}: {change}"));
        remarks.notes.extend(notes);
    }
    Ok(remarks)
}

fn kept_remark(bvh: &Bvh, kept: &[edit::KeptTranslation]) -> Option<String> {
    let widest = kept.iter().max_by(|a, b| a.range.total_cmp(&b.range))?;
    let joints = counted(kept.len(), "joint");
    let name = bvh.joints[widest.joint].name();
    let range = trimmed(widest.range, decimals_to_show(widest.range));
    Some(format!(
        "{joints} kept position channels because they move, '{name}' by up to {range}"
    ))
}

/// With the near name, where an option names a joint that is not there.
fn unknown_joint(error: EditError, typed: &str, bvh: &Bvh) -> Failure {
    let names: Vec<_> = bvh.joints.iter().map(BvhJoint::name).collect();
    match (
        &error,
        similar::nearest(typed, names.iter().map(AsRef::as_ref)),
    ) {
        (EditError::NoSuchJoint { .. }, Some(meant)) => {
            Failure::new(error.to_string()).try_next(format!("did you mean '{meant}'"))
        }
        _ => refused(error),
    }
}

/// What is wrong with the file against what is wrong with the option.
fn refused(error: EditError) -> Failure {
    let text = error.to_string();
    match error {
        EditError::BadScale { .. }
        | EditError::FrameTime(_)
        | EditError::IncompleteOrder
        | EditError::BadName { .. }
        | EditError::TooManyStars { .. } => Failure::usage(text),
        EditError::NoSuchJoint { .. } => {
            Failure::new(text).try_next("posekit info --tree lists the joints")
        }
        _ => Failure::new(text),
    }
}

/// A joint's name and its new one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Rename {
    from: String,
    to: String,
}

impl FromStr for Rename {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((from, to)) if !from.is_empty() && !to.is_empty() => Ok(Self {
                from: from.to_owned(),
                to: to.to_owned(),
            }),
            _ => Err("write the old and the new name, such as Hips=pelvis".to_owned()),
        }
    }
}

/// A part of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trim {
    start: Moment,
    end: Option<Moment>,
}

/// A frame number, or a time.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Moment {
    Frame(usize),
    Secs(f64),
}

impl FromStr for Trim {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (start, end) = text
            .split_once("..")
            .ok_or("write a range, such as 10..50 (frames) or 0.5s..2s (time)")?;
        let start = if start.is_empty() {
            Moment::Frame(0)
        } else {
            start.parse()?
        };
        let end = if end.is_empty() {
            None
        } else {
            Some(end.parse()?)
        };
        Ok(Self { start, end })
    }
}

impl FromStr for Moment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is neither a frame number nor a time such as 1.5s");
        match text.trim().strip_suffix('s') {
            Some(secs) => {
                let secs = secs.parse().map_err(|_not_a_number| wrong())?;
                if (0.0..=f64::MAX).contains(&secs) {
                    Ok(Self::Secs(secs))
                } else {
                    Err(wrong())
                }
            }
            None => text
                .trim()
                .parse()
                .map(Self::Frame)
                .map_err(|_not_a_number| wrong()),
        }
    }
}

impl Trim {
    fn frames(self, bvh: &Bvh) -> Result<Range<usize>, Failure> {
        let frame_time = bvh.frame_time();
        let start = self.start.first_frame(frame_time)?;
        let end = self
            .end
            .map_or(Ok(usize::MAX), |end| end.first_frame(frame_time))?;
        Ok(start..end)
    }
}

/// A time this close before a frame, in frames, is at that frame.
const AT_FRAME: f64 = 1e-3;

impl Moment {
    /// The first frame at or after the moment.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number that is not negative; one beyond any frame saturates"
    )]
    fn first_frame(self, frame_time: FrameTime) -> Result<usize, Failure> {
        match self {
            Self::Frame(frame) => Ok(frame),
            Self::Secs(_) if frame_time.is_none() => {
                Err(refused(EditError::NoFrameTime).try_next("trim by frame number"))
            }
            Self::Secs(secs) => Ok((secs / frame_time.secs() - AT_FRAME).ceil().max(0.0) as usize),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_of_frames_or_of_time() {
        let trim: Trim = "10..50".parse().unwrap();
        assert_eq!(
            trim,
            Trim {
                start: Moment::Frame(10),
                end: Some(Moment::Frame(50))
            }
        );
        let trim: Trim = "..1.5s".parse().unwrap();
        assert_eq!(
            trim,
            Trim {
                start: Moment::Frame(0),
                end: Some(Moment::Secs(1.5))
            }
        );
        for text in ["10", "a..b", "-1s..2s", "1..2..3", "nans..1s"] {
            assert!(text.parse::<Trim>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_time_is_the_frame_at_or_after_it() {
        let sixtieth = FrameTime::new(0.016_666_7).unwrap();
        assert_eq!(Moment::Secs(0.5).first_frame(sixtieth).unwrap(), 30);
        assert_eq!(Moment::Secs(0.51).first_frame(sixtieth).unwrap(), 31);
        assert!(Moment::Secs(0.5).first_frame(FrameTime::NONE).is_err());
    }
}
