//! The options of `posekit ik-study`.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use glam::DVec3;

use super::method::Method;
use crate::positions::PositionsArgs;

/// Compare solvers of inverse kinematics on a figure, and write a report about it
///
/// Every solver brings the end of every chain to every target, with every number of iterations. The
/// report is one HTML file with its curves, tables and pictures in it, made to be read and printed; beside it
/// lie all numbers as CSV, the text as Markdown, and the poses as a BVH file.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct IkStudyArgs {
    /// The motion whose skeleton is studied: a file, '-' or sample:NAME
    #[arg(value_name = "FILE")]
    pub(super) file: OsString,
    /// The report; .csv, .md and .bvh go beside it
    #[arg(
        long,
        short,
        value_name = "REPORT.html",
        default_value = "ik-study.html"
    )]
    pub(super) output: PathBuf,
    /// A chain of joints; may be repeated [default: three that end at the left hand]
    #[arg(long = "chain", value_name = "START:END")]
    pub(super) chains: Vec<String>,
    /// A target in the world; may be repeated
    #[arg(
        long = "target",
        value_name = "[NAME=]X,Y,Z",
        allow_hyphen_values = true
    )]
    pub(super) targets: Vec<NamedPlace>,
    /// N by N targets on an upright plane in front of the figure
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(0..=9))]
    pub(super) grid: u32,
    /// Random targets within reach, for each chain
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub(super) random: u32,
    /// Random targets out of reach, for each chain
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub(super) unreachable: u32,
    /// The seed for the random targets
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// The solvers, separated by commas [default: all]
    #[arg(long = "solver", value_name = "SOLVERS", value_delimiter = ',')]
    pub(super) methods: Vec<Method>,
    /// The numbers of iterations, separated by commas
    #[arg(
        long,
        value_name = "COUNTS",
        value_delimiter = ',',
        default_value = "1,2,5,10,20,50,100",
        value_parser = clap::value_parser!(u32).range(1..=10_000)
    )]
    pub(super) iterations: Vec<u32>,
    /// How near counts as reached, in the file's unit [default: a thousandth of each chain's reach]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub(super) tolerance: Option<f64>,
    /// Start from this frame of the motion [default: the rest pose]
    #[arg(long, value_name = "N")]
    pub(super) frame: Option<usize>,
    /// Where the root stands in the rest pose [default: where the file has it; on the course's figure where the
    /// course's viewer has it, 0,0.931395,0]
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        conflicts_with = "frame"
    )]
    pub(super) root: Option<Place>,
    /// Leave out all times, which differ from run to run
    #[arg(long)]
    pub(super) no_times: bool,
    #[command(flatten)]
    pub(super) positions: PositionsArgs,
}

const EXAMPLES: &str = "\
Examples:
  posekit ik-study sample:walk
  posekit ik-study walk.bvh -o study.html --chain Hips:LeftHand --chain LeftToes:LeftHand
  posekit ik-study walk.bvh --target shelf=0.4,1.6,0.3 --target floor=0.3,0.1,0.4 --grid 5
  posekit ik-study walk.bvh --solver ccd,fabrik --iterations 1,5,20 --random 1000
  posekit ik-study walk.bvh --no-times            the same bytes whenever it is run";

/// A target as it was given.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct NamedPlace {
    /// What it is called, if it is.
    pub(super) name: Option<String>,
    /// Where it is, in the world.
    pub(super) place: DVec3,
}

/// A place in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place(pub(super) DVec3);

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            Ok(NamedPlace { name: None, place }) => Ok(Self(place)),
            _ => Err("expected three numbers, such as 0,0.93,0".to_owned()),
        }
    }
}

impl FromStr for NamedPlace {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, numbers) = match text.rsplit_once('=') {
            Some((name, numbers)) => (Some(name.trim().to_owned()), numbers),
            None => (None, text),
        };
        let parsed: Option<Vec<f64>> = numbers
            .split(',')
            .map(|number| number.trim().parse().ok().filter(|n: &f64| n.is_finite()))
            .collect();
        match (parsed.as_deref(), name) {
            (Some(&[x, y, z]), name) if name.as_deref() != Some("") => Ok(Self {
                name,
                place: DVec3::new(x, y, z),
            }),
            _ => Err(
                "expected three numbers, with a name if you like, such as shelf=0.4,1.6,0.3"
                    .to_owned(),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_is_three_numbers_with_or_without_a_name() {
        let place = DVec3::new(0.5, -1.0, 2e-1);
        let parsed = |text: &str| text.parse::<NamedPlace>();
        assert_eq!(parsed("0.5,-1,2e-1"), Ok(NamedPlace { name: None, place }));
        let name = Some("a=b".to_owned());
        assert_eq!(parsed("a=b=0.5, -1,0.2"), Ok(NamedPlace { name, place }));
        for text in [
            "", "1,2", "1,2,3,4", "x=1,2", "=1,2,3", "1,2,inf", "1,2,nan",
        ] {
            assert!(parsed(text).is_err(), "{text}");
            assert!(text.parse::<Place>().is_err(), "{text}");
        }
    }
}
