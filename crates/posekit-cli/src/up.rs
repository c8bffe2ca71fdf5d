//! Which axis is up: what is known of it in words, and the option `--up` of commands that draw or check.

use clap::Args;
use posekit::figure::{UpAxis, UpEvidence, UpGuess, UpTaken, take_up};
use posekit::motion::Motion;

use crate::failure::one_line;

/// The axis that is taken as up.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct UpArgs {
    /// The axis of the file that points up: x, y, z, or -x, -y, -z [default: the one along which the rest pose
    /// stands, if that is clear, else y]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true)]
    up: Option<UpAxis>,
}

impl UpArgs {
    /// The axis that was said.
    pub(crate) fn said(self) -> Option<UpAxis> {
        self.up
    }

    /// The motion of a file stood on Y, and what is to be said about it.
    pub(crate) fn stand(self, name: &str, motion: Motion) -> (Motion, Option<String>) {
        let taken = take_up(&motion, self.up);
        let remark = remark(taken).map(|text| one_line(&format!("{name}: {text}")));
        (taken.up.stand(motion), remark)
    }
}

/// What is to be said of a file of which another axis than Y was taken as up, or perhaps should have been.
pub(crate) fn remark(taken: UpTaken) -> Option<String> {
    let guess = taken.guess.filter(|guess| guess.up != UpAxis::Y)?;
    let (up, because) = (guess.up, because(guess));
    Some(if guess.is_known() {
        format!(
            "{up} is up, {because}, so the figure is turned to stand on it; --up chooses another axis"
        )
    } else {
        format!("{up} may be up, {because}; Y is taken as up, and --up chooses another axis")
    })
}

/// What a guess rests on, as the end of a sentence.
pub(crate) fn because(guess: UpGuess) -> String {
    match guess.evidence {
        UpEvidence::RestPoseAndMotion | UpEvidence::RestPose => {
            "because the rest pose stands along it".to_owned()
        }
        UpEvidence::RestPoseAgainstMotion(other) => {
            format!(
                "because the rest pose stands along it, though in the motion the trunk points along {other}"
            )
        }
        UpEvidence::Motion => "because the figure stands along it in the motion".to_owned(),
        _ => "because the figure is tallest along it".to_owned(),
    }
}

/// The up axis and how sure it is.
pub(crate) fn in_words(guess: Option<UpGuess>) -> String {
    let Some(guess) = guess else {
        return "unknown: neither the rest pose nor the motion stands".to_owned();
    };
    let how = match guess.evidence {
        UpEvidence::RestPoseAndMotion => {
            "sure: the rest pose stands along it, and so does the motion"
        }
        UpEvidence::RestPose => "likely: the rest pose stands along it",
        UpEvidence::RestPoseAgainstMotion(other) => {
            return format!(
                "{}, likely: the rest pose stands along it, though in the motion the trunk points along \
                 {other}, as in a crawl",
                guess.up
            );
        }
        UpEvidence::Motion => {
            "a guess: the motion stands along it, and the rest pose does not stand"
        }
        _ => "a guess: the figure is tallest along it",
    };
    format!("{}, {how}", guess.up)
}

/// How sure a guess is, in a word for programs.
pub(crate) fn sureness(guess: UpGuess) -> &'static str {
    match guess.evidence {
        UpEvidence::RestPoseAndMotion => "sure",
        UpEvidence::RestPose | UpEvidence::RestPoseAgainstMotion(_) => "likely",
        _ => "guess",
    }
}

/// How sure the axis is that was taken, in a word for programs: it was said, or no guess was good enough and it is Y.
pub(crate) fn taken_sureness(taken: UpTaken) -> &'static str {
    match taken.guess {
        _ if taken.is_said => "said",
        Some(guess) if guess.is_known() || guess.up == taken.up => sureness(guess),
        _ => "default",
    }
}
