//! `posekit fix`: repairs that need no guess.

use std::ffi::OsString;
use std::io::Write;

use clap::Args;
use posekit::motion::FrameTime;
use posekit_formats::bvh::{
    self, Bvh, Change, FixConfig, Gap, GapError, NameRepair, WriteOptions, write_to,
};
use serde_json::{Value, json};

use crate::args::Global;
use crate::batch::{self, Done, Outcome};
use crate::console::{self, DIM, HEADING, styled};
use crate::extension;
use crate::failure::{Failure, one_line};
use crate::inputs;
use crate::load::{self, ImportWithGaps};
use crate::output::{Destination, Plan, write_whole};
use crate::text::counted;

/// Repair what needs no guess, say each change, and write a new file
///
/// Euler flips are unwrapped: other angles of the very same rotations, so that curves are continuous.
/// What the reader had to put right (a frame count, glued numbers, a damaged row) is written right, and
/// line ends are LF. Values that no repair touches stay the same. The input is never written to.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FixArgs {
    /// Files, folders, patterns, '-' or sample:NAME
    #[arg(value_name = "FILE", required = true)]
    files: Vec<OsString>,
    /// The new file; a folder for many inputs, a pattern with {stem} and {dir}, or '-'
    #[arg(long, short, value_name = "OUT", required_unless_present = "dry_run")]
    output: Option<OsString>,
    /// Write blanks in joint names as underscores
    #[arg(long)]
    names: bool,
    /// Fill values that are not numbers (nan, inf) from the frames beside them: rotations by slerp,
    /// positions in a straight line; at the beginning and the end the nearest frame is held
    #[arg(long)]
    bridge_gaps: bool,
    /// The longest gap that is filled; a file with a longer one is not written
    #[arg(
        long,
        value_name = "SECS",
        default_value_t = 0.5,
        requires = "bridge_gaps"
    )]
    max_gap: f64,
    /// Set the seconds from one frame to the next
    #[arg(long, value_name = "SECS")]
    frame_time: Option<f64>,
    /// Only report what would be changed, and write nothing
    #[arg(long, conflicts_with = "output")]
    dry_run: bool,
    /// Report the changes on standard output, one JSON object per file, each on its own line
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  posekit fix walk.bvh -o fixed.bvh
  posekit fix --dry-run takes/
  posekit fix lost.bvh -o whole.bvh --bridge-gaps --max-gap 0.25
  posekit fix --names takes/ -o fixed/
  posekit fix slow.bvh -o right.bvh --frame-time 0.01
  posekit fix --json --dry-run takes/ | jq -r 'select(.changes != []) | .file'";

/// Runs the command.
pub(crate) fn run(args: &FixArgs, global: &Global) -> Result<(), Failure> {
    let inputs = inputs::expand(&args.files);
    let output = args.output.as_ref();
    if let Some(output) = output {
        extension::refuse_other(output, &["bvh"], extension::REDIRECT)?;
    }
    let plan = output
        .map(|output| Plan::new(output, &inputs, "bvh", &global.guard))
        .transpose()?;
    let writes_stdout = output.is_some_and(|output| output == "-");
    if args.json && writes_stdout {
        return Err(Failure::usage(
            "the repaired file and --json cannot both go to standard output",
        ));
    }
    let names = if args.names {
        NameRepair::BlanksToUnderscores
    } else {
        NameRepair::Keep
    };
    let config = FixConfig {
        names,
        frame_time_secs: args.frame_time,
        ..FixConfig::default()
    };
    batch::run_telling(
        inputs,
        global,
        |index, input| {
            let in_file = |failure: Failure| failure.in_file(&input.name());
            let ImportWithGaps {
                mut import,
                bytes,
                gaps,
            } = load::load_import_with_gaps(input, global)?;
            let mut bridged = bridge(args, &mut import.document, &gaps, &bytes, &input.name())?;
            let mut fixed = bvh::fix(&bytes, &import, &config)
                .map_err(|error| in_file(Failure::new(error.to_string())))?;
            bridged.append(&mut fixed.changes);
            fixed.changes = bridged;
            let destination = plan.as_ref().map(|plan| plan.destination(index));
            let mut written = None;
            match destination {
                Some(Destination::File(target)) => {
                    let options = WriteOptions::default();
                    write_whole(target, |file| write_to(&fixed.document, options, file))?;
                    written = Some(target.display().to_string());
                }
                Some(Destination::Stdout) => {
                    let mut out = console::binary_stdout();
                    write_to(&fixed.document, WriteOptions::default(), &mut out)?;
                    out.flush()?;
                }
                None => {}
            }
            let value = if args.json {
                json_line(&input.name(), &fixed.changes, written.as_deref())
            } else {
                readable(&input.name(), &fixed.changes, written.as_deref())
            };
            Ok(Done {
                value,
                warnings: Vec::new(),
                notes: Vec::new(),
            })
        },
        |outcome: Outcome<'_, String>| {
            let text = match outcome {
                Outcome::Done(_, text) => text,
                Outcome::Failed { name, failure } if args.json => failure.json_line(name),
                Outcome::Failed { .. } => return Ok(()),
            };
            if args.json {
                let mut out = console::binary_stdout();
                out.write_all(text.as_bytes())?;
                out.flush()?;
            } else if !global.quiet {
                // The report is about the output, so it does not stand in it.
                let _ = anstream::stderr().lock().write_all(text.as_bytes());
            }
            Ok(())
        },
    )
}

/// Fills the gaps of a document where that was asked for; without it they are the error of the reader.
fn bridge(
    args: &FixArgs,
    document: &mut Bvh,
    gaps: &[Gap],
    bytes: &[u8],
    name: &str,
) -> Result<Vec<Change>, Failure> {
    if gaps.is_empty() && !args.bridge_gaps {
        return Ok(Vec::new());
    }
    if !args.bridge_gaps {
        return Err(match bvh::read(bytes) {
            Err(error) => load::refused(name, bytes, &error),
            Ok(_) => Failure::new("has values that are not numbers").in_file(name),
        });
    }
    let most_frames = frames_in(args.max_gap, document.frame_time())?;
    let mut gaps = [gaps, &document.values_out_of_range()].concat();
    gaps.sort_unstable();
    bvh::bridge_gaps(document, &gaps, most_frames).map_err(|error| {
        let failure = Failure::new(error.to_string()).in_file(name);
        match error {
            GapError::TooLong { .. } => failure.try_next("--max-gap allows longer ones"),
            _ => failure,
        }
    })
}

/// How many whole frames a time has; at a frame time that is none, a frame each thirtieth of a second.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast from float to integer saturates, and the number is not negative"
)]
fn frames_in(secs: f64, frame_time: FrameTime) -> Result<usize, Failure> {
    const USUAL: FrameTime = FrameTime::of_fps(30);
    /// A gap of 0.5 s at a frame time of 0.0166667 s has 30 frames.
    const ROUNDING: f64 = 1e-3;
    if !(secs >= 0.0 && secs.is_finite()) {
        return Err(Failure::usage(
            "--max-gap must be a number of seconds, zero or more",
        ));
    }
    let frame_time = match frame_time.is_none() {
        true => USUAL,
        false => frame_time,
    };
    Ok((secs / frame_time.secs() + ROUNDING).floor() as usize)
}

fn json_line(name: &str, changes: &[Change], written: Option<&str>) -> String {
    let changes: Vec<Value> = changes
        .iter()
        .map(|change| {
            json!({
                "code": change.code.code(),
                "joint": change.joint,
                "frames": change.frames.map(|frames| json!({
                    "first": frames.first,
                    "last": frames.last,
                })),
                "line": change.location.map(|location| location.line),
                "column": change.location.map(|location| location.column),
                "count": change.count,
                "message": change.message,
            })
        })
        .collect();
    let line = json!({ "file": name, "written": written, "changes": changes });
    format!("{line}\n")
}

fn readable(name: &str, changes: &[Change], written: Option<&str>) -> String {
    let written = written.map_or(String::new(), |path| {
        format!(", written to {}", one_line(path))
    });
    let count = match changes.len() {
        0 => "nothing to repair".to_owned(),
        count => counted(count, "change"),
    };
    let mut text = format!("{}: {count}{written}\n", styled(HEADING, &one_line(name)));
    for change in changes {
        let place = match (change.location, change.frames) {
            (Some(location), _) => format!("{location}: "),
            (None, Some(frames)) => format!("{frames}: "),
            (None, None) => String::new(),
        };
        let code = styled(DIM, &format!("[{}]", change.code));
        text += &format!("  {place}{} {code}\n", one_line(&change.message));
    }
    text
}
