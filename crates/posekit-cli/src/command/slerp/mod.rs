//! `posekit slerp`: the ways from one orientation to another, side by side.

mod orientation;
mod tables;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use posekit::inbetween::{Ends, Method, Preset};
use posekit::rotation::EulerOrder;

use crate::failure::Failure;

/// Compare the ways from one orientation to another: slerp, matrices, quaternions, Euler angles
///
/// An orientation is three Euler angles in degrees in the order of --order, or a quaternion of four numbers
/// x,y,z,w. The tables show, over the way from t = 0 to 1, how far each method strays from slerp, how
/// fast it turns, and where it is not a rotation at all: a determinant that is not 1, axes that are not at
/// right angles.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct SlerpArgs {
    /// Where it starts: X,Y,Z in degrees, or x,y,z,w
    #[arg(
        value_name = "START",
        allow_hyphen_values = true,
        required_unless_present = "preset"
    )]
    start: Option<String>,
    /// Where it ends
    #[arg(
        value_name = "END",
        allow_hyphen_values = true,
        required_unless_present = "preset"
    )]
    end: Option<String>,
    /// Two orientations chosen to show something
    #[arg(long, value_name = "NAME", conflicts_with_all = ["start", "end"], value_parser = preset_arg())]
    preset: Option<Preset>,
    /// The order of the angles that are given
    #[arg(long, value_name = "ORDER", default_value = "XYZ")]
    order: EulerOrder,
    /// The key before the start, for squad
    #[arg(long, value_name = "ORIENTATION", allow_hyphen_values = true)]
    before: Option<String>,
    /// The key after the end, for squad
    #[arg(long, value_name = "ORIENTATION", allow_hyphen_values = true)]
    after: Option<String>,
    /// The methods: slerp, rawslerp, nlerp, lerp, matrix, rotvec, squad, euler:ORDER [default: all]
    #[arg(long, value_name = "METHODS", value_delimiter = ',')]
    method: Vec<Method>,
    /// How many steps the tables have
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    steps: u16,
    /// Everything as comma-separated values, one row for each method and step
    #[arg(long)]
    csv: bool,
}

const EXAMPLES: &str = "\
Examples:
  posekit slerp 0,0,0 90,45,0                     all methods between two orientations
  posekit slerp --preset gimbal                   where Euler angles jerk
  posekit slerp --preset half-turn --method slerp,matrix
  posekit slerp 0,0,0,1 0,0.7071,0,0.7071 --steps 100 --csv
  posekit slerp 0,0,0 0,90,0 --before 0,-90,0 --after 90,90,0 --method slerp,squad";

/// The presets by their names, each with what it is.
fn preset_arg() -> impl TypedValueParser<Value = Preset> {
    let values = Preset::ALL.map(|preset| PossibleValue::new(preset.name()).help(preset.title()));
    PossibleValuesParser::new(values)
        .try_map(|name| Preset::by_name(&name).ok_or("no preset has this name"))
}

/// Runs the command.
pub(crate) fn run(args: &SlerpArgs) -> Result<(), Failure> {
    let ends = ends(args)?;
    let methods = if args.method.is_empty() {
        Method::ALL.to_vec()
    } else {
        args.method.clone()
    };
    if args.csv {
        tables::csv(&ends, &methods, args.steps.into())
    } else {
        tables::print(&ends, &methods, args.steps.into())
    }
}

fn ends(args: &SlerpArgs) -> Result<Ends, Failure> {
    if !args.order.is_complete() {
        return Err(Failure::usage("--order takes three axes, such as ZXY"));
    }
    let read = |text: &String| orientation::read(text, args.order);
    let mut ends = match (args.preset, &args.start, &args.end) {
        (Some(preset), ..) => preset.ends(),
        (None, Some(start), Some(end)) => Ends::new(read(start)?, read(end)?),
        _ => {
            return Err(Failure::usage("expected two orientations or a --preset"));
        }
    };
    if let Some(before) = &args.before {
        ends.before = Some(read(before)?);
    }
    if let Some(after) = &args.after {
        ends.after = Some(read(after)?);
    }
    Ok(ends)
}
