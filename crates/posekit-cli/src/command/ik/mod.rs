//! `posekit ik`: a motion whose effectors reach what they are told to.

mod figure;
mod goals;
mod limits;
mod numbers;
mod place;
mod solver;
mod steps;
mod summary;
mod trace;

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use posekit_formats::bvh::{WriteOptions, write_to};

use crate::args::Global;
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs::{self, Input};
use crate::load;
use crate::output::{Destination, Plan, Target, write_whole};
use crate::positions::PositionsArgs;
use crate::reading::Said;
use crate::select::{FrameSelection, PointArg};
use crate::text::counted;
use figure::Figure;
use goals::Goals;
use limits::Stiffness;
use numbers::Vector;
use solver::SolverArgs;

/// Move joints so that hands, feet or any joint reach a target
///
/// Each --end names a joint and starts a new target; what follows it up to the next --end is about that one:
/// where it should be (--target, --offset, --path or --follow; without any of them it stays where it is), how
/// it should be turned (--orient), and where its chain starts (--start). A chain may climb from a foot and go
/// down an arm: its start stays where it is and the root moves.
///
/// The output differs from the input only where the chains moved; every other number keeps its digits.
/// Missing a target is not an error: the summary says by how much and why. Lengths are in the file's unit,
/// angles in degrees.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct IkArgs {
    /// A file, '-' or sample:NAME
    #[arg(value_name = "FILE")]
    file: OsString,
    /// The new BVH, or '-'; without it only the summary is made
    #[arg(long, short, value_name = "OUT")]
    output: Option<OsString>,
    #[command(flatten)]
    goals: Goals,
    #[command(flatten)]
    solver: SolverArgs,
    /// Frames by number from 0: 7, 0..100 (without the last), 0..200:5, 50.., or a list of these
    #[arg(long, value_name = "FRAMES", allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
    /// Work on the rest pose, which the OFFSETs alone make, as a motion of one frame
    #[arg(long, conflicts_with = "frames")]
    rest: bool,
    /// With --rest: where the first root stands, in the world [default: where its OFFSET has it]
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        requires = "rest"
    )]
    root: Option<Vector>,
    /// Let the roots go anywhere: the whole body moves
    #[arg(long)]
    free_root: bool,
    /// Which way a chain bends: pull a joint such as an elbow to the side where the point lies
    #[arg(long, value_name = "JOINT,X,Y,Z", allow_hyphen_values = true)]
    pole: Vec<PointArg>,
    /// Joint limits and stiffness, from a JSON file
    #[arg(long, value_name = "FILE.json")]
    limits: Option<PathBuf>,
    /// Keep every joint within the angles that its channels have in the motion, and this many degrees
    /// beyond: knees bend as knees do [default: 30]
    #[arg(long, value_name = "DEGREES", num_args = 0..=1, require_equals = true, default_missing_value = "30")]
    within_motion: Option<f64>,
    /// How stiff a joint is, from 0 (free) to 1 (does not move), such as Spine=0.8; the name may be a pattern
    #[arg(long, value_name = "JOINT=SHARE")]
    stiffness: Vec<Stiffness>,
    /// How strongly joints are drawn back to where they were, from 0 to 1
    #[arg(long, value_name = "SHARE")]
    pull: Option<f64>,
    /// Start each frame from its own pose rather than from the correction of the frame before
    #[arg(long)]
    cold_start: bool,
    #[command(flatten)]
    positions: PositionsArgs,
    /// Record every joint's update in every iteration here: .json or .csv
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Print the summary as one JSON object, with every frame's residuals
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  posekit ik walk.bvh --end LeftHand --offset 0,0.2,0 -o out.bvh   the hand 0.2 higher throughout
  posekit ik walk.bvh --end LeftHand --start LeftUpperArm --target 0.4,1.2,0.3 -o out.bvh
  posekit ik walk.bvh --start LeftToes --end LeftHand --target 0.5,1,0.6 -o out.bvh
                                                                   the foot stays, the root moves
  posekit ik walk.bvh --end RightHand --follow other.bvh:RightHand -o out.bvh
  posekit ik walk.bvh --end LeftHand --path way.csv --orient hold -o out.bvh
  posekit ik walk.bvh --free-root --within-motion --end LeftFoot --orient hold \\
      --end RightFoot --orient hold --end Hips --offset 0,-0.1,0 -o low.bvh
                                                                   crouch: feet stay, hips lower
  posekit ik walk.bvh --rest --end LeftHand --target 0.5,0.8,0.5 --solver ccd --trace way.json
  posekit ik walk.bvh --end Head --offset 0.1,0,0 --json | jq .worst";

/// Runs the command.
pub(crate) fn run(args: &IkArgs, global: &Global) -> Result<(), Failure> {
    let files = [args.file.clone()];
    let inputs = inputs::expand(&files);
    if inputs.is_set {
        return Err(Failure::usage("ik works on one file at a time"));
    }
    if let Some(output) = &args.output {
        extension::refuse_other(output, &["bvh"], extension::REDIRECT)?;
    }
    let plan = args
        .output
        .as_ref()
        .map(|output| Plan::new(output, &inputs, "bvh", &global.guard))
        .transpose()?;
    if args.json
        && args
            .output
            .as_ref()
            .is_some_and(|output| output == inputs::STDIN)
    {
        return Err(Failure::usage(
            "the new file and --json cannot both go to standard output",
        ));
    }
    let trace = args.trace.as_deref().map(|path| {
        let format = trace::Format::of_path(path)?;
        Ok::<_, Failure>((format, global.guard.target(path, "the trace")?))
    });
    let trace = trace.transpose()?;
    let Some(input) = inputs.list.first() else {
        let mut failures = inputs.failures;
        let (name, failure) = failures.pop().unwrap_or_else(|| {
            let name = args.file.display().to_string();
            (name, Failure::new("there is nothing to read"))
        });
        return tell(args, &name, Err(failure));
    };
    let result = work(args, input, plan.as_ref(), trace.as_ref(), global);
    tell(args, &input.name(), result)
}

/// With `--json` a failure too is an object on standard output.
fn tell(args: &IkArgs, name: &str, result: Result<(), Failure>) -> Result<(), Failure> {
    if let Err(failure @ (Failure::CouldNot(_) | Failure::Usage(_))) = &result
        && args.json
    {
        let mut out = console::binary_stdout();
        out.write_all(failure.json_line(name).as_bytes())?;
        out.flush()?;
    }
    result
}

fn work(
    args: &IkArgs,
    input: &Input,
    plan: Option<&Plan>,
    trace: Option<&(trace::Format, Target)>,
    global: &Global,
) -> Result<(), Failure> {
    let name = input.name();
    let in_file = |failure: Failure| failure.in_file(&name);
    Said::of(args.positions).refuse_scene(input)?;
    let loaded = load::load(input, global)?;
    if !global.quiet {
        loaded
            .repairs(input)
            .iter()
            .for_each(|repair| console::warning(repair));
    }
    let mut figure = Figure::new(args, loaded).map_err(in_file)?;
    let goals = args.goals.attach(&figure, global).map_err(in_file)?;
    let mut notes = Vec::new();
    let task = steps::Task::new(args, &figure, goals, &mut notes, global).map_err(in_file)?;
    if !global.quiet {
        notes.iter().for_each(|note| console::note(note));
    }
    let results = task.run(&mut figure, global).map_err(in_file)?;
    if let Some((format, target)) = trace {
        let names = &figure.skeleton;
        write_whole(target, |file| {
            trace::write(*format, names, &task, &results, file)
        })?;
    }
    let mut announcement = None;
    match plan.map(|plan| plan.destination(0)) {
        Some(Destination::File(target)) => {
            write_whole(target, |file| {
                write_to(&figure.bvh, WriteOptions::default(), file)
            })?;
            let changed = counted(figure.changed_count(), "value");
            announcement = Some(format!("wrote {}: {changed} changed", target.display()));
        }
        Some(Destination::Stdout) => {
            let mut out = console::binary_stdout();
            write_to(&figure.bvh, WriteOptions::default(), &mut out)?;
            out.flush()?;
        }
        None => {}
    }
    let writes_stdout = matches!(
        plan.map(|plan| plan.destination(0)),
        Some(Destination::Stdout)
    );
    if args.json {
        let mut out = console::binary_stdout();
        writeln!(out, "{}", summary::json(&name, &figure, &task, &results))?;
        out.flush()?;
    } else if !writes_stdout && !global.quiet {
        let mut out = console::stdout();
        summary::write(&name, &figure, &task, &results, &mut out)?;
        out.flush()?;
    }
    if let (Some(announcement), false) = (announcement, global.quiet) {
        console::note(&announcement);
    }
    Ok(())
}
