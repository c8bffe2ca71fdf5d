//! `posekit keys`: keys from motions, motions from keys, and what keys there are.

mod bake;
mod print;
mod reduce;

use clap::{Args, Subcommand};

use crate::args::Global;
use crate::failure::Failure;

/// Keyframes: reduce a motion to few keys, bake keys to a motion, list them
///
/// Keys live in scene files, NAME.posekit.toml, which a person can read and edit.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct KeysArgs {
    #[command(subcommand)]
    what: What,
}

const EXAMPLES: &str = "\
Examples:
  posekit keys reduce walk.bvh -o walk.posekit.toml      within 1 degree and 1 % of the height
  posekit keys reduce walk.bvh -o walk.posekit.toml --angle 0.2 --distance 0.002
  posekit keys print walk.posekit.toml
  posekit keys bake walk.posekit.toml -o again.bvh --fps 60";

#[derive(Debug, Subcommand)]
enum What {
    Reduce(reduce::ReduceArgs),
    Bake(bake::BakeArgs),
    Print(print::PrintArgs),
}

/// Runs the command.
pub(crate) fn run(args: &KeysArgs, global: &Global) -> Result<(), Failure> {
    match &args.what {
        What::Reduce(args) => reduce::run(args, global),
        What::Bake(args) => bake::run(args, global),
        What::Print(args) => print::run(args, global),
    }
}
