//! Which axis is up: what is known of it in words, and the option `--up` of commands that draw.

use clap::Args;
use posekit::figure::{UpAxis, UpEvidence, UpGuess, guess_up};
use posekit::motion::Motion;

use crate::failure::one_line;

/// The axis that is drawn upright.
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
        let (up, remark) = match self.up {
            Some(up) => (up, None),
            None => guessed(&motion),
        };
        let motion = match up {
            UpAxis::Y => motion,
            up => motion.turned(up.y_up_from_file()),
        };
        (
            motion,
            remark.map(|text| one_line(&format!("{name}: {text}"))),
        )
    }
}

/// The axis to draw upright, and a remark where it is not plainly Y.
fn guessed(motion: &Motion) -> (UpAxis, Option<String>) {
    let Some(guess) = guess_up(motion) else {
        return (UpAxis::Y, None);
    };
    let because = because(guess);
    if guess.up == UpAxis::Y {
        (UpAxis::Y, None)
    } else if guess.is_known() {
        let text = format!(
            "{} is up, {because}, so the figure is turned to stand on it; --up chooses another axis",
            guess.up
        );
        (guess.up, Some(text))
    } else {
        let text = format!(
            "{} may be up, {because}; drawn with Y up, and --up chooses another axis",
            guess.up
        );
        (UpAxis::Y, Some(text))
    }
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
