//! `posekit inbetween`: keeps some frames of a motion, fills in the others, and says how well.

mod chart;
mod compare;
mod html;
mod report;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Args;
use posekit::inbetween::{FillMethod, FillPlan, MethodError, fill};
use posekit::motion::Motion;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{Bvh, WriteOptions, write_to};

use crate::args::Global;
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs::{self, Input};
use crate::load;
use crate::output::{Destination, Plan, write_whole};
use crate::positions::PositionsArgs;
use crate::reading::Said;
use crate::select::FrameSelection;
use crate::text::counted;
use compare::Comparison;

/// Keep some frames of a motion, fill in the others by several methods, and compare them with the truth
///
/// Without -o and --report prints how far each method is from the motion over the frames that it filled in.
/// With --report also writes NAME.html, NAME.md and NAME.csv: the same joint by joint, with curves. With
/// -o writes the motion that the first method fills in.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct InbetweenArgs {
    /// The motion: a file, '-' or sample:NAME
    #[arg(value_name = "FILE")]
    file: OsString,
    /// Keep every n-th frame, and the last one
    #[arg(long, value_name = "N", conflicts_with = "at")]
    keep: Option<usize>,
    /// Keep these frames, by number from 0: 0,12,30 or 0..100:8
    #[arg(long, value_name = "FRAMES", allow_hyphen_values = true)]
    at: Option<FrameSelection>,
    /// Put the kept frames so many frames apart: a new timing, which has no truth to compare with
    #[arg(long, value_name = "N", conflicts_with = "report")]
    frames: Option<usize>,
    /// slerp, rawslerp, nlerp, lerp, matrix, rotvec, squad, euler (each joint in the file's own order), euler:ORDER
    #[arg(
        long,
        value_name = "METHODS",
        value_delimiter = ',',
        value_parser = method_arg,
        default_value = "slerp,nlerp,matrix,rotvec,euler,squad"
    )]
    method: Vec<FillMethod>,
    /// Write the comparison to NAME.html, NAME.md and NAME.csv [default NAME: the file's, -inbetween]
    // A path may not be empty for clap, and without a name this is.
    #[arg(long, value_name = "NAME", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    report: Option<OsString>,
    /// Write the motion that the first method fills in
    #[arg(long, short, value_name = "OUT")]
    output: Option<OsString>,
    #[command(flatten)]
    positions: PositionsArgs,
}

const EXAMPLES: &str = "\
Examples:
  posekit inbetween walk.bvh --keep 10
  posekit inbetween walk.bvh --keep 10 --method slerp,euler,squad --report
  posekit inbetween walk.bvh --keep 10 --report=out/walk10
  posekit inbetween walk.bvh --keep 10 --method squad -o filled.bvh
  posekit inbetween walk.bvh --at 0,30,60,90 --frames 60 --method squad -o slow.bvh";

/// A method by its word, or what to say of a word that is none.
fn method_arg(word: &str) -> Result<FillMethod, String> {
    word.parse().map_err(|error| match error {
        MethodError::Unknown { .. } => format!("{error}, or euler for the file's own orders"),
        other => other.to_string(),
    })
}

/// Runs the command.
pub(crate) fn run(args: &InbetweenArgs, global: &Global) -> Result<(), Failure> {
    match args.keep {
        None if args.at.is_none() => {
            let text = "say which frames are kept: --keep N, or --at FRAMES";
            return Err(Failure::usage(text));
        }
        Some(0) => return Err(Failure::usage("--keep takes a number of frames from 1 on")),
        _ => {}
    }
    if let Some(output) = &args.output {
        extension::refuse_other(output, &["bvh"], extension::REDIRECT)?;
    }
    let mut inputs = inputs::expand(std::slice::from_ref(&args.file));
    if let Some((_, failure)) = inputs.failures.pop() {
        return Err(failure);
    }
    let [input] = inputs.list.as_slice() else {
        return Err(Failure::usage("one motion at a time is filled in"));
    };
    let output = args
        .output
        .as_ref()
        .map(|output| Plan::new(output, &inputs, "bvh", &global.guard))
        .transpose()?;
    let report = args
        .report
        .as_ref()
        .map(|stem| report::targets(&report_stem(Path::new(stem), input), &global.guard))
        .transpose()?;
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
    let orders = loaded.bvh.rotation_orders();
    let motion = loaded.motion(args.positions.policies()).map_err(in_file)?;
    let plan = plan(args, &motion, global).map_err(in_file)?;
    let filled = |method: FillMethod| fill(&motion, &plan, |joint| method.of(joint, &orders));
    if let Some(output) = &output {
        let method = args.method[0];
        write_motion(
            output.destination(0),
            &filled(method),
            method,
            args.method.len(),
            global,
        )?;
        if report.is_none() {
            return Ok(());
        }
    }
    if args.frames.is_some() {
        return Err(Failure::usage("--frames makes a motion: say where with -o"));
    }
    if plan.filled().is_empty() {
        let text = "every frame from the first kept one to the last is kept, so there is nothing to fill in or compare";
        return Err(in_file(Failure::usage(text)));
    }
    let comparison = Comparison::new(&motion, &plan, &args.method, name, filled);
    comparison.print()?;
    match &report {
        Some(targets) => report::write(&comparison, targets, global),
        None => Ok(()),
    }
}

fn plan(args: &InbetweenArgs, motion: &Motion, global: &Global) -> Result<FillPlan, Failure> {
    let frames = motion.frame_count();
    if frames == 0 {
        return Err(Failure::new("has no frames"));
    }
    let plan = match (&args.at, args.keep) {
        (Some(at), _) => {
            if let Some(note) = at.past_the_end(frames).filter(|_| !global.quiet) {
                console::note(&note);
            }
            FillPlan::at(at.frames(frames)?, frames)
        }
        (None, Some(n)) => FillPlan::every(n, frames),
        (None, None) => return Err(Failure::usage("no frame is kept")),
    };
    let usage = |error: posekit::inbetween::FillConfigError| Failure::usage(error.to_string());
    let plan = plan.map_err(usage)?;
    match args.frames {
        Some(spacing) => plan.spaced(spacing).map_err(usage),
        None => Ok(plan),
    }
}

fn write_motion(
    destination: &Destination,
    motion: &Motion,
    method: FillMethod,
    method_count: usize,
    global: &Global,
) -> Result<(), Failure> {
    let bvh = Bvh::from_motion(motion, EulerOrder::ZXY);
    let options = WriteOptions::default();
    match destination {
        Destination::Stdout => {
            let mut out = console::binary_stdout();
            write_to(&bvh, options, &mut out)?;
            Ok(std::io::Write::flush(&mut out)?)
        }
        Destination::File(target) => {
            write_whole(target, |file| write_to(&bvh, options, file))?;
            if !global.quiet {
                let frames = counted(bvh.frame_count(), "frame");
                let which = if method_count > 1 {
                    format!(" filled in by {method}, the first method")
                } else {
                    format!(" filled in by {method}")
                };
                console::note(&format!("wrote {}: {frames}{which}", target.display()));
            }
            Ok(())
        }
    }
}

/// The report's name without its extension.
fn report_stem(asked: &Path, input: &Input) -> PathBuf {
    if !asked.as_os_str().is_empty() {
        return asked.to_owned();
    }
    let stem = input
        .relative
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    PathBuf::from(format!("{stem}-inbetween"))
}
