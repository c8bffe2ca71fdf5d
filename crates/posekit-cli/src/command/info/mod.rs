//! `posekit info`: what is in a file.

mod facts;
mod json;
mod readable;
mod robot;
mod tree;

use std::ffi::OsString;
use std::io::Write;

use clap::Args;

use crate::args::Global;
use crate::batch::{self, Done, Outcome};
use crate::console::{self, Reader};
use crate::failure::Failure;
use crate::inputs;
use crate::load::{self, Loaded, Subject};
use crate::positions::PositionsArgs;
use crate::reading::Said;
use facts::Facts;

/// What is in a file: joints, frames, channels, height and unit, rest pose, what the reader noticed
///
/// Of a robot (URDF): links, joints, degrees of freedom and their ranges, shapes.
///
/// The unit is a guess: the one in which the figure is as tall as a person, 1.25 m to 2.15 m. The
/// height is the middle of the figure's vertical extents over the frames, or the rest pose's where
/// there is no motion.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct InfoArgs {
    /// Files, folders, patterns, '-' or sample:NAME
    #[arg(value_name = "FILE", required = true)]
    files: Vec<OsString>,
    #[command(flatten)]
    positions: PositionsArgs,
    /// Draw the hierarchy too
    #[arg(long)]
    tree: bool,
    /// One JSON object per file, each on its own line
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  posekit info walk.bvh
  posekit info arm.urdf
  posekit info --tree walk.bvh | less -R
  posekit info --json takes/ | jq -r 'select(.fps < 60) | .file'";

/// Runs the command.
pub(crate) fn run(args: &InfoArgs, global: &Global) -> Result<(), Failure> {
    let mut out = console::stdout_for(Reader::of_json(args.json));
    let flush_each = console::stdout_is_terminal();
    let mut is_first = true;
    batch::run_telling(
        inputs::expand(&args.files),
        global,
        |_, input| {
            let said = Said::of(args.positions);
            said.refuse_scene(input)?;
            let loaded = match load::load_subject(input, global)? {
                Subject::Clip(import) => Loaded {
                    bvh: import.document,
                    notices: import.report.warnings,
                },
                Subject::Robot(import) => {
                    said.refuse_robot(&input.name())?;
                    let how = if args.json {
                        robot::object
                    } else {
                        robot::block
                    };
                    return Ok(Done {
                        value: how(&input.name(), &import, args.tree),
                        warnings: Vec::new(),
                        notes: Vec::new(),
                    });
                }
            };
            let facts = Facts::of(&loaded, args.positions.policies())
                .map_err(|failure| failure.in_file(&input.name()))?;
            // The reader's remarks are part of the answer here, not warnings beside it.
            let text = if args.json {
                json::object(&input.name(), &facts, &loaded)
            } else {
                readable::block(&input.name(), &facts, &loaded, args.tree)
            };
            Ok(Done {
                value: text,
                warnings: Vec::new(),
                notes: Vec::new(),
            })
        },
        |outcome| {
            let text = match outcome {
                Outcome::Done(_, text) => text,
                Outcome::Failed { name, failure } if args.json => failure.json_line(name),
                Outcome::Failed { .. } => return Ok(()),
            };
            if !is_first && !args.json {
                writeln!(out)?;
            }
            is_first = false;
            out.write_all(text.as_bytes())?;
            if flush_each {
                out.flush()?;
            }
            Ok(())
        },
    )
    .and_then(|()| Ok(out.flush()?))
}
