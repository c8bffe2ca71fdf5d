//! `posekit fk`: forward kinematics of whole files, as arrays or as a summary.

mod export;
mod statistics;
mod summary;

use std::ffi::OsString;
use std::io::Write;
use std::sync::Arc;

use clap::Args;
use posekit::motion::{GlobalMotion, Motion};
use posekit::skeleton::JointId;
use posekit_formats::arrays::{AttachedPoint, MotionArrays};

use crate::args::Global;
use crate::batch::{self, Done};
use crate::console;
use crate::failure::Failure;
use crate::inputs::{self, Input, Inputs};
use crate::load;
use crate::output::Plan;
use crate::positions::PositionsArgs;
use crate::reading::Said;
use crate::sample::Sample;
use crate::scene_file::{Asked, Part};
use crate::select::{self, FrameSelection, PointArg};
use crate::text::counted;
use export::Format;

/// Where every joint is in every frame, as arrays or as a readable summary
///
/// With -o writes the joints' global positions and orientations; the output's extension chooses
/// NumPy's .npz, .csv or .json. Without -o prints a summary. Positions are in the file's own length
/// unit, orientations unit quaternions as x, y, z, w; End Sites are joints.
///
/// An .npz holds positions (F, J, 3), orientations (F, J, 4), joint_names (J,), parents (J,) with -1
/// at a root, frame_time () in seconds and frames (F,), and with --point also points (F, P, 3),
/// point_joints (P,) and point_offsets (P, 3).
#[allow(
    clippy::doc_markdown,
    reason = "this is the help text, in which backticks would show"
)]
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FkArgs {
    /// Files, folders, patterns, '-' or sample:NAME [default: sample:walk]
    #[arg(value_name = "FILE")]
    files: Vec<OsString>,
    /// Write arrays here: a file, a folder for many inputs, a pattern with {stem} and {dir}, or '-'
    #[arg(long, short, value_name = "OUT")]
    output: Option<OsString>,
    /// Format of the arrays [default: by the output's extension, else npz]
    #[arg(long, value_name = "FORMAT", requires = "output")]
    format: Option<Format>,
    /// Compress the .npz: smaller, and several times slower to write
    #[arg(long, requires = "output")]
    compress: bool,
    /// Frames by number from 0: 7, 0..100 (without the last), 0..200:5, 50.., or a list of these
    #[arg(long, value_name = "FRAMES", allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
    /// Joints by name or pattern, such as Hips,'*Hand'; a joint's parent is then its closest ancestor among them
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    joints: Vec<String>,
    /// The rest pose, which the OFFSETs alone make, instead of the motion
    #[arg(long, conflicts_with = "frames")]
    rest: bool,
    #[command(flatten)]
    positions: PositionsArgs,
    /// Also follow a point fixed to a joint, given in the joint's own space; may be repeated
    #[arg(long, value_name = "JOINT,X,Y,Z", allow_hyphen_values = true)]
    point: Vec<PointArg>,
}

const EXAMPLES: &str = "\
Examples:
  posekit fk walk.bvh                                a summary
  posekit fk walk.bvh -o walk.npz                    NumPy arrays
  posekit fk walk.bvh -o hands.csv --joints '*Hand'  a table of two joints
  posekit fk walk.bvh -o - --format json --frames 0  the first frame, for another program
  posekit fk takes/ -o arrays/                       a folder, its sub-folders mirrored
  posekit fk walk.bvh --point RightHand,0,-0.1,0     where the finger tips go

In Python:
  clip = numpy.load('walk.npz'); clip['positions'][:, 0]";

/// The result for one input.
enum Report {
    /// Arrays were written.
    Written(export::Written),
    /// A summary to print.
    Summary(Box<summary::Summary>),
}

/// Runs the command.
pub(crate) fn run(args: &FkArgs, global: &Global) -> Result<(), Failure> {
    let inputs = named_or_sample(&args.files, global);
    match &args.output {
        Some(output) => run_export(args, output, inputs, global),
        None => run_summary(args, inputs, global),
    }
}

fn named_or_sample(files: &[OsString], global: &Global) -> Inputs {
    if !files.is_empty() {
        return inputs::expand(files);
    }
    if !global.quiet {
        console::note("no file given, so this is sample:walk, a clip that posekit makes itself");
    }
    Inputs {
        list: vec![Input::sample(Sample::Walk)],
        ..Inputs::default()
    }
}

fn run_export(
    args: &FkArgs,
    output: &OsString,
    inputs: Inputs,
    global: &Global,
) -> Result<(), Failure> {
    let format = export::format(output, args.format, args.compress)?;
    let plan = Plan::new(output, &inputs, format.extension(), &global.guard)?;
    let is_set = inputs.is_set;
    let mut written_count = 0;
    let result = batch::run(
        inputs,
        global,
        |index, input| {
            let (selection, warnings, notes) = select_from(args, input, global)?;
            let written = export::write(&selection.arrays(), format, plan.destination(index))?;
            Ok(Done {
                value: Report::Written(written),
                warnings,
                notes,
            })
        },
        |_, report| {
            if let Report::Written(written) = report {
                written_count += 1;
                if !is_set && !global.quiet {
                    written.announce();
                }
            }
            Ok(())
        },
    );
    if is_set && written_count > 0 && !global.quiet {
        let files = counted(written_count, "file");
        console::note(&format!("wrote {files} to {}", output.display()));
    }
    result
}

fn run_summary(args: &FkArgs, inputs: Inputs, global: &Global) -> Result<(), Failure> {
    let mut layout = inputs.is_set.then(|| summary::FileTable::new(&inputs));
    let mut out = console::stdout();
    let flush_each = console::stdout_is_terminal();
    batch::run(
        inputs,
        global,
        |_, input| {
            let (selection, warnings, notes) = select_from(args, input, global)?;
            let summary = summary::Summary::of(&selection.arrays(), input.name());
            Ok(Done {
                value: Report::Summary(Box::new(summary)),
                warnings,
                notes,
            })
        },
        |_, report| {
            if let Report::Summary(summary) = report {
                match &mut layout {
                    Some(table) => table.write(&summary, &mut out)?,
                    None => summary.write(&mut out)?,
                }
            }
            if flush_each {
                out.flush()?;
            }
            Ok(())
        },
    )
    .and_then(|()| Ok(out.flush()?))
}

/// A motion in world space and what of it was asked for.
struct Selection {
    motion: GlobalMotion,
    joints: Vec<JointId>,
    frames: Vec<usize>,
    /// The frames' numbers in the scene that these are a part of.
    numbers: Option<Vec<usize>>,
    points: Vec<AttachedPoint>,
}

impl Selection {
    fn arrays(&self) -> MotionArrays<'_> {
        MotionArrays {
            motion: &self.motion,
            joints: &self.joints,
            frames: &self.frames,
            numbers: self.numbers.as_deref(),
            points: &self.points,
        }
    }
}

/// What was asked for of an input, with warnings and notes to show.
fn select_from(
    args: &FkArgs,
    input: &Input,
    global: &Global,
) -> Result<(Selection, Vec<String>, Vec<String>), Failure> {
    let name = input.name();
    let asked = match args.rest {
        true => Asked::Nothing,
        false => args.frames.as_ref().map_or(Asked::All, Asked::Frames),
    };
    Said::of(args.positions).refuse_scene(input)?;
    let (loaded, part) = load::load_part(input, asked, global)?;
    let warnings = loaded.repairs(input);
    let motion = loaded
        .motion(args.positions.policies())
        .map_err(|failure| failure.in_file(&name))?;
    // A long file's channel values would double the memory that forward kinematics takes.
    drop(loaded);
    let frame_count = part
        .as_ref()
        .map_or(motion.frame_count(), |part| part.frame_count);
    let past_the_end = args
        .frames
        .as_ref()
        .and_then(|frames| frames.past_the_end(frame_count));
    let notes = past_the_end.map(|note| format!("{name}: {note}"));
    let selection = select(args, motion, part).map_err(|failure| failure.in_file(&name))?;
    Ok((selection, warnings, notes.into_iter().collect()))
}

fn select(args: &FkArgs, motion: Motion, part: Option<Part>) -> Result<Selection, Failure> {
    let skeleton = Arc::clone(motion.skeleton());
    let joints = select::joints(&skeleton, &args.joints)?;
    let points: Vec<AttachedPoint> = args
        .point
        .iter()
        .map(|point| point.attach(&skeleton))
        .collect::<Result<_, _>>()?;
    let motion = if args.rest {
        Motion::at_rest(skeleton, 1, motion.frame_time(), [])
    } else {
        motion
    };
    if motion.frame_count() == 0 {
        return Err(Failure::new("has no frames").try_next("--rest gives its rest pose"));
    }
    let numbers = part.map(|part| part.numbers).filter(|_| !args.rest);
    let frames = match &args.frames {
        _ if numbers.is_some() => (0..motion.frame_count()).collect(),
        Some(selection) => selection.frames(motion.frame_count())?,
        None => (0..motion.frame_count()).collect(),
    };
    Ok(Selection {
        motion: motion.to_global(),
        joints,
        frames,
        numbers,
        points,
    })
}
